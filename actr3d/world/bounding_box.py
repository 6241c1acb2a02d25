"""The exact bounding box of a body, from the extent of each shape along three axes."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from mujoco import MjData, MjModel, mjtGeom
from numpy.typing import NDArray

from actr3d.errors import WorldError
from actr3d.world.kernel import extend_box

Point = tuple[float, float, float]


NOTHING = np.array(((math.inf,) * 3, (-math.inf,) * 3))
"""The least and greatest coordinates of a box around nothing."""


class BoundingBox(NamedTuple):
    """The smallest box with sides along a frame's axes."""

    lower: Point
    """Its least x, y and z in that frame [m]."""

    upper: Point
    """Its greatest x, y and z in that frame [m]."""

    @property
    def size(self) -> Point:
        """Its lengths along x (depth), y (width) and z (height) [m]."""
        a, b = self.lower, self.upper
        return (b[0] - a[0], b[1] - a[1], b[2] - a[2])

    @property
    def centre(self) -> Point:
        """Its middle in the frame [m]."""
        a, b = self.lower, self.upper
        return ((a[0] + b[0]) / 2, (a[1] + b[1]) / 2, (a[2] + b[2]) / 2)

    @property
    def depth(self) -> float:
        """Along the frame's x [m]."""
        return self.upper[0] - self.lower[0]

    @property
    def width(self) -> float:
        """Along the frame's y [m]."""
        return self.upper[1] - self.lower[1]

    @property
    def height(self) -> float:
        """Along the frame's z [m]."""
        return self.upper[2] - self.lower[2]


class Bounds:
    """Computes bounding boxes of some geoms.

    The extent of a shape from its centre along a unit vector u, given in its own frame, is its support function:
    sphere r; capsule r + h|uz|; ellipsoid |S u|; cylinder r sqrt(ux^2 + uy^2) + h|uz|; box sx|ux| + sy|uy| + sz|uz|.
    The extent of a mesh or height field is that of its farthest vertex.

    Args:
        model: The compiled scene.
        data: Its state, whose geometry is up to date in each call.
        geoms: The geoms.
    """

    def __init__(self, model: MjModel, data: MjData, geoms: NDArray[np.intp]) -> None:
        self._data = data
        self._types, self._sizes = model.geom_type, model.geom_size
        self._positions, self._rotations = data.geom_xpos, data.geom_xmat
        self._model = model
        self._plain, self._clouds = self._shapes(geoms)

    def box(self, origin: NDArray[np.float64], axes: NDArray[np.float64], also: Sequence[int] = ()) -> BoundingBox:
        """Returns the box around the geoms, and some more, in a frame at `origin` with `axes` (3, 3) as columns.

        Raises:
            WorldError: If no geom is visible or touchable.
        """
        box = NOTHING.copy()
        self._widen(box, self._plain, self._clouds, origin, axes)
        if also:
            self._widen(box, *self._shapes(np.array(also, dtype=np.intp)), origin, axes)
        (x, y, z), upper = box.tolist()
        if not math.isfinite(x + y + z):
            raise WorldError("there is no bounding box: no geom is visible or touchable")
        return BoundingBox(lower=(x, y, z), upper=tuple(upper))

    def _shapes(self, geoms: NDArray[np.intp]) -> tuple[NDArray[np.intp], list[tuple[int, NDArray[np.float64]]]]:
        """Returns those of some geoms that have a support function, and the others with their vertices."""
        there = [geom for geom in geoms.tolist() if _there(self._model, geom)]
        clouds = {int(mjtGeom.mjGEOM_MESH), int(mjtGeom.mjGEOM_HFIELD), int(mjtGeom.mjGEOM_SDF)}
        plain = np.array([geom for geom in there if self._types[geom] not in clouds], dtype=np.intp)
        return plain, [(geom, _vertices(self._model, geom)) for geom in there if self._types[geom] in clouds]

    def _widen(
        self,
        box: NDArray[np.float64],
        plain: NDArray[np.intp],
        clouds: list[tuple[int, NDArray[np.float64]]],
        origin: NDArray[np.float64],
        axes: NDArray[np.float64],
    ) -> None:
        extend_box()(plain, self._types, self._sizes, self._positions, self._rotations, origin, axes, box)
        for geom, vertices in clouds:
            rotation = self._rotations[geom].reshape(3, 3)
            points = vertices @ (rotation.T @ axes) + (self._positions[geom] - origin) @ axes
            np.minimum(box[0], points.min(axis=0), out=box[0])
            np.maximum(box[1], points.max(axis=0), out=box[1])


def _there(model: MjModel, geom: int) -> bool:
    """Returns whether a geom is visible or has contacts, and is not a plane."""
    material = int(model.geom_matid[geom])
    alpha = model.geom_rgba[geom, 3] if material < 0 else model.mat_rgba[material, 3]
    touches = model.geom_contype[geom] or model.geom_conaffinity[geom]
    return bool(model.geom_type[geom] != int(mjtGeom.mjGEOM_PLANE) and (alpha > 0 or touches))


def _vertices(model: MjModel, geom: int) -> NDArray[np.float64]:
    """Returns the points (n, 3) of a mesh or height field, in the geom's frame [m]."""
    number = int(model.geom_dataid[geom])
    if model.geom_type[geom] != int(mjtGeom.mjGEOM_HFIELD):
        start, count = int(model.mesh_vertadr[number]), int(model.mesh_vertnum[number])
        return np.array(model.mesh_vert[start : start + count], dtype=np.float64)
    x, y, top, base = (float(s) for s in model.hfield_size[number])
    rows, columns, start = int(model.hfield_nrow[number]), int(model.hfield_ncol[number]), int(model.hfield_adr[number])
    heights = np.array(model.hfield_data[start : start + rows * columns], dtype=np.float64) * top
    ys, xs = np.meshgrid(np.linspace(-y, y, rows), np.linspace(-x, x, columns), indexing="ij")
    bottom = [[a * x, b * y, -base] for a in (-1, 1) for b in (-1, 1)]
    return np.concatenate([np.stack([xs.ravel(), ys.ravel(), heights], axis=1), np.array(bottom)])
