"""Clearance of a body in a doorway: its distance to the wall on each side."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any, NamedTuple

import mujoco
import numpy as np
from mujoco import MjData, MjModel
from numpy.typing import NDArray

from actr3d.world.bounding_box import Extent


class Wall(NamedTuple):
    """A wall with an aperture in it."""

    position: tuple[float, float]
    """The middle of the gap on the floor [m]."""
    heading: float
    """The direction of walking through it [rad]."""
    thickness: float
    """[m]"""
    segments: tuple[int, int]
    """The geoms to the left and to the right of the gap."""


class Clearance:
    """Measures the distances of a body's geoms from the two segments of a wall.

    Args:
        model: The compiled scene.
        data: Its state, whose geometry is up to date in each call.
        geoms: The geoms of the body.
        wall: The wall.
    """

    def __init__(self, model: MjModel, data: MjData, geoms: NDArray[np.intp], wall: Wall) -> None:
        self._model, self._data, self._geoms, self._wall = model, data, geoms, wall
        self._extent = Extent(model, data, geoms)
        c, s = math.cos(wall.heading), math.sin(wall.heading)
        self._axes = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1.0]])
        self._middle = np.array([*wall.position, 0.0])
        self._radii = model.geom_rbound

    def rooms(self, held: Sequence[int] = ()) -> tuple[float, float] | None:
        """Returns the smallest distances to the left and right segment [m]; None if no part of the body is between their faces.

        Args:
            held: More geoms that count as the body's: held objects.
        """
        geoms = np.append(self._geoms, np.array(held, dtype=np.intp)) if held else self._geoms
        half = self._wall.thickness / 2
        past = (self._data.geom_xpos[geoms] - self._middle).dot(self._axes[:, 0])
        radii = self._radii[geoms]
        if (past - radii).min() > half or (past + radii).max() < -half:
            return None
        box = self._extent.box(self._middle, self._axes, held)
        if box.upper[0] < -half or box.lower[0] > half:
            return None
        left, right = (self._nearest(geoms, segment) for segment in self._wall.segments)
        return left, right

    def _nearest(self, geoms: NDArray[Any], segment: int) -> float:
        """Returns the smallest distance of any of some geoms to a segment [m]."""
        model, data = self._model, self._data
        turned = (data.geom_xpos[geoms] - data.geom_xpos[segment]) @ data.geom_xmat[segment].reshape(3, 3)
        least = np.linalg.norm(np.maximum(np.abs(turned) - model.geom_size[segment], 0), axis=1) - model.geom_rbound[geoms]
        nearest = math.inf
        for number in np.argsort(least, kind="stable").tolist():
            if least[number] >= nearest:
                break
            nearest = min(nearest, mujoco.mj_geomDistance(model, data, int(geoms[number]), segment, 10.0, None))
        return nearest
