"""The exact bounding box of a body, from the extent of each shape along three axes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from mujoco import MjData, MjModel, mjtGeom
from numpy.typing import NDArray

from actr3d.errors import WorldError

Point = tuple[float, float, float]


@dataclass(frozen=True, kw_only=True)
class BoundingBox:
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


class Extent:
    """Computes bounding boxes of some geoms.

    The extent of a shape from its centre along a unit vector u, given in its own frame, is its support function:
    sphere r; capsule r + h|uz|; ellipsoid |S u|; cylinder r sqrt(ux^2 + uy^2) + h|uz|; box sx|ux| + sy|uy| + sz|uz|.
    One formula covers them: round + |E u| + B.|u|. The extent of a mesh or height field is that of its farthest vertex.

    Args:
        model: The compiled scene.
        data: Its state, whose geometry is up to date in each call.
        geoms: The geoms.
    """

    def __init__(self, model: MjModel, data: MjData, geoms: NDArray[np.intp]) -> None:
        self._model, self._data = model, data
        self._geoms = _Shapes(self._model, geoms)

    def box(self, origin: NDArray[np.float64], axes: NDArray[np.float64], also: Sequence[int] = ()) -> BoundingBox:
        """Returns the box around the geoms, and some more, in a frame at `origin` with `axes` (3, 3) as columns.

        Raises:
            WorldError: If there is no geom.
        """
        lower, upper = self._geoms.reach(self._data, axes)
        if also:
            low, high = _Shapes(self._model, np.array(also, dtype=np.intp)).reach(self._data, axes)
            lower, upper = np.minimum(lower, low), np.maximum(upper, high)
        if not np.isfinite(lower).all():
            raise WorldError("no visible or touchable geom has a bounding box here")
        at = origin @ axes
        return BoundingBox(lower=tuple((lower - at).tolist()), upper=tuple((upper - at).tolist()))


class _Shapes:
    """The numbers of the formula of some geoms, (n, 3) each, and the vertices of meshes and height fields."""

    def __init__(self, model: MjModel, geoms: NDArray[np.intp]) -> None:
        there = [int(geom) for geom in geoms if _there(model, int(geom))]
        clouds = {int(mjtGeom.mjGEOM_MESH), int(mjtGeom.mjGEOM_HFIELD), int(mjtGeom.mjGEOM_SDF)}
        self._model = model
        plain = np.array([geom for geom in there if model.geom_type[geom] not in clouds], dtype=np.intp)
        self._some = len(plain) > 0
        self._plain = together(plain)
        self._clouds = [(geom, _vertices(model, geom)) for geom in there if model.geom_type[geom] in clouds]
        self._sizes: bytes = b""
        self._formula: tuple[Any, Any, Any] = (0, 0, 0)

    def reach(self, data: Any, axes: NDArray[np.float64]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Returns the least and greatest coordinates (3,) along axes, from the world's origin [m]."""
        if self._some:
            rounds, ellipses, boxes = self._numbers()
            turned = data.geom_xmat[self._plain].reshape(-1, 3, 3).transpose(0, 2, 1) @ axes
            far = rounds + np.sqrt(np.einsum("ij,ijk->ik", ellipses, turned * turned))
            if boxes is not None:
                far = far + np.einsum("ij,ijk->ik", boxes, np.abs(turned))
            centres = data.geom_xpos[self._plain] @ axes
            lower, upper = np.minimum.reduce(centres - far), np.maximum.reduce(centres + far)
        else:
            lower, upper = np.full(3, np.inf), np.full(3, -np.inf)
        for geom, vertices in self._clouds:
            points = vertices @ (data.geom_xmat[geom].reshape(3, 3).T @ axes) + data.geom_xpos[geom] @ axes
            lower, upper = np.minimum(lower, points.min(axis=0)), np.maximum(upper, points.max(axis=0))
        return lower, upper

    def _numbers(self) -> tuple[Any, Any, Any]:
        """Returns the numbers of the formula, None for B if all of it is 0; computes them again after a geom was resized."""
        sizes = self._model.geom_size[self._plain]
        if sizes.tobytes() != self._sizes:
            self._sizes = sizes.tobytes()
            rows = [_formula(int(kind), size) for kind, size in zip(self._model.geom_type[self._plain], sizes, strict=True)]
            boxes = np.array([row[2] for row in rows])
            self._formula = (
                np.array([[row[0]] for row in rows]),
                np.array([row[1] for row in rows]) ** 2,
                boxes if boxes.any() else None,
            )
        return self._formula


def together(numbers: NDArray[np.intp]) -> NDArray[np.intp] | slice:
    """Returns numbers that follow one another as a slice, which selects rows without copying them; others as they are."""
    if len(numbers) and (np.diff(numbers) == 1).all():
        return slice(int(numbers[0]), int(numbers[-1]) + 1)
    return numbers


def _there(model: MjModel, geom: int) -> bool:
    """Returns whether a geom is visible or has contacts, and is finite."""
    material = int(model.geom_matid[geom])
    alpha = model.geom_rgba[geom, 3] if material < 0 else model.mat_rgba[material, 3]
    touches = model.geom_contype[geom] or model.geom_conaffinity[geom]
    return bool(model.geom_type[geom] != int(mjtGeom.mjGEOM_PLANE) and (alpha > 0 or touches))


def _formula(kind: int, size: NDArray[np.float64]) -> tuple[float, Point, Point]:
    """Returns the round, E and B of a shape, from MuJoCo's sizes (half lengths)."""
    x, y, z = (float(s) for s in size)
    match kind:
        case mjtGeom.mjGEOM_SPHERE:
            return (x, (0, 0, 0), (0, 0, 0))
        case mjtGeom.mjGEOM_CAPSULE:
            return (x, (0, 0, 0), (0, 0, y))
        case mjtGeom.mjGEOM_ELLIPSOID:
            return (0, (x, y, z), (0, 0, 0))
        case mjtGeom.mjGEOM_CYLINDER:
            return (0, (x, x, 0), (0, 0, y))
        case _:
            return (0, (0, 0, 0), (x, y, z))


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
