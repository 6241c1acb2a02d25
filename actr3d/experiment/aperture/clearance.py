"""Clearance of a body in a doorway: its distance to the wall on each side."""

from __future__ import annotations

import math
from collections.abc import Sequence

import mujoco
import numpy as np
from mujoco import MjData, MjModel
from numpy.typing import NDArray

from actr3d.experiment.aperture.kernel import least_distances
from actr3d.world.bounding_box import Bounds
from actr3d.world.scene_objects import Gap

PRESSED = 1e-5
"""Differences of distances below this are those of the algorithms that compute them [m]."""


class Clearance:
    """Measures the distances of a body's geoms from the two segments of a wall.

    Args:
        model: The compiled scene.
        data: Its state, whose geometry is up to date in each call.
        geoms: The geoms of the body.
        gap: The place of the aperture.
    """

    def __init__(self, model: MjModel, data: MjData, geoms: NDArray[np.intp], gap: Gap) -> None:
        self._model, self._data, self._geoms, self._gap = model, data, geoms, gap
        self._bounds = Bounds(model, data, geoms)
        c, s = math.cos(gap.heading), math.sin(gap.heading)
        self._axes = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1.0]])
        self._middle = np.array([*gap.position, 0.0])

    def distance_to_wall(self, held: Sequence[int] = ()) -> float:
        """Returns the distance of the body from the space between the planes of the wall's two faces [m]; 0 or less if a part of the body
        is there, also in the doorway.

        Args:
            held: More geoms that count as the body's: held objects.
        """
        half = self._gap.thickness / 2
        box = self._bounds.box(self._middle, self._axes, held)
        return max(box.lower[0] - half, -half - box.upper[0])

    def clearances(self) -> tuple[float, float] | None:
        """Returns the smallest distances to the left and right segment [m]; None if no part of the body is in the doorway."""
        if self.distance_to_wall() > 0:
            return None
        distances = self.to_segments()
        return distances if self.is_inside(distances) else None

    def to_segments(self, held: Sequence[int] = ()) -> tuple[float, float]:
        """Returns the smallest distances to the left and right segment [m]."""
        left, right = (self._nearest(self._all(held), segment) for segment in self._gap.segments)
        return left, right

    def is_inside(self, distances: tuple[float, float], held: Sequence[int] = ()) -> bool:
        """Returns whether a body that is between the planes of the wall's faces is in the doorway.

        A body that leans on the wall penetrates its face a little, because contacts are soft. It is in the doorway only if a part is
        deeper between the planes than it penetrates a segment.

        Args:
            distances: The distances to both segments, from `to_segments`.
            held: More geoms that count as the body's: held objects.
        """
        if min(distances) > 0:
            return True
        half, data = self._gap.thickness / 2, self._data
        for geom in self._all(held).tolist():
            middle = float((data.geom_xpos[geom] - self._middle) @ self._axes[:, 0])
            if abs(middle) - self._model.geom_rbound[geom] >= half:
                continue
            box = Bounds(self._model, data, np.array([geom])).box(self._middle, self._axes)
            pressed = max(0.0, *(-mujoco.mj_geomDistance(self._model, data, geom, segment, 10.0, None) for segment in self._gap.segments))
            if min(half - box.lower[0], half + box.upper[0]) > pressed + PRESSED:
                return True
        return False

    def _all(self, held: Sequence[int]) -> NDArray[np.intp]:
        return np.append(self._geoms, np.array(held, dtype=np.intp)) if held else self._geoms

    def _nearest(self, geoms: NDArray[np.intp], segment: int) -> float:
        """Returns the smallest distance of any of some geoms to a segment [m]."""
        model, data = self._model, self._data
        ordered, bounds = np.empty_like(geoms), np.empty(len(geoms))
        shapes = model.geom_type, model.geom_size, data.geom_xpos, data.geom_xmat, model.geom_rbound
        box = data.geom_xpos[segment], data.geom_xmat[segment], model.geom_size[segment]
        least_distances()(geoms, *shapes, *box, ordered, bounds)
        nearest = math.inf
        for geom, bound in zip(ordered.tolist(), bounds.tolist(), strict=True):
            if bound >= nearest + PRESSED:
                break
            nearest = min(nearest, mujoco.mj_geomDistance(model, data, geom, segment, 10.0, None))
        return nearest
