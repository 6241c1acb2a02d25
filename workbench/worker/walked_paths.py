"""Records the paths that the bodies of a simulation have walked."""

from __future__ import annotations

from array import array
from typing import Any

import mujoco
import numpy as np
from mujoco import MjData

from actr3d.world import World
from workbench.curves import INTEGRATION

STEP = 50_000
"""Interval between two points of a path [us]."""
MOST_POINTS = 1_000
"""Maximum number of points that are drawn; if there are more, every second one is left out, repeatedly."""


class Walked:
    """Stores the positions of bodies on the floor, including those ahead of the present after the run has gone back.

    Args:
        period: Length of a tick [us].
    """

    def __init__(self, period: int) -> None:
        self._every = max(1, STEP // period)
        """Only every n-th tick has a point."""
        self._points: dict[str, array[float]] = {}
        """By body: x and y of each point [m]."""
        self._count = 0
        self._data: MjData | None = None

    def keep(self, tick: int, world: World) -> None:
        """Stores the positions at the end of a tick, or at the start of the run (tick 0); known ticks are skipped."""
        if tick != self._count * self._every:
            return
        for name, place in self._places(world).items():
            self._points.setdefault(name, array("d")).extend(place)
        self._count += 1

    def cut(self, tick: int) -> None:
        """Removes what came after a tick, because the run continues differently."""
        self._count = min(self._count, tick // self._every + 1)
        for points in self._points.values():
            del points[2 * self._count :]

    def up_to(self, tick: int, world: World) -> dict[str, list[list[float]]]:
        """Returns the paths up to the current tick, by body: positions (x, y) [m]."""
        count = tick // self._every + 1
        stride = 1
        while count > MOST_POINTS * stride:
            stride *= 2
        here = {} if tick % (self._every * stride) == 0 else self._places(world)
        return {name: [*_pairs(points, count, stride), *([here[name]] if here else [])] for name, points in self._points.items()}

    def _places(self, world: World) -> dict[str, list[float]]:
        """Returns the positions of the bodies. They are computed here, as those in the world's data are from before its last step."""
        if self._data is None:
            self._data = MjData(world.mj_model)
        numbers = np.frombuffer(world.state_bytes())
        mujoco.mj_setState(world.mj_model, self._data, numbers, INTEGRATION)
        mujoco.mj_kinematics(world.mj_model, self._data)
        places: Any = self._data.xpos
        return {name: places[body.root, :2].tolist() for name, body in world.bodies.items()}


def _pairs(points: array[float], count: int, stride: int) -> list[list[float]]:
    return [[points[2 * number], points[2 * number + 1]] for number in range(0, count, stride)]
