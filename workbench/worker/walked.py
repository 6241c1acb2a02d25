"""The paths that the bodies of a simulation have walked."""

from __future__ import annotations

from array import array
from typing import Any

import mujoco
import numpy as np
from mujoco import MjData

from actr3d.world import World
from workbench.curves import INTEGRATION

STEP = 50_000
"""A path has a point for each so long a time [us]."""
MOST_POINTS = 1_000
"""Of more points every second one is left out, and so on."""


class Walked:
    """Keeps where bodies were on the floor, also ahead of the present after the run has gone back.

    Args:
        period: A tick [us].
    """

    def __init__(self, period: int) -> None:
        self._every = max(1, STEP // period)
        """One of so many ticks has a point."""
        self._points: dict[str, array[float]] = {}
        """By body: x and y of each [m]."""
        self._count = 0
        self._data: MjData | None = None

    def keep(self, tick: int, world: World, state: bytes | None = None) -> None:
        """Takes the end of a tick, or the start of the run (tick 0); what is known already stays.

        Args:
            tick: The tick.
            world: The world.
            state: Its state at that tick; None for the present one.
        """
        if tick != self._count * self._every:
            return
        for name, place in self._places(world, state).items():
            self._points.setdefault(name, array("d")).extend(place)
        self._count += 1

    def cut(self, tick: int) -> None:
        """Forgets what came after a tick: the run goes another way."""
        self._count = min(self._count, tick // self._every + 1)
        for points in self._points.values():
            del points[2 * self._count :]

    def up_to(self, tick: int, world: World) -> dict[str, list[list[float]]]:
        """Returns the paths up to the present tick, by body: places (x, y) [m]."""
        count = tick // self._every + 1
        stride = 1
        while count > MOST_POINTS * stride:
            stride *= 2
        here = {} if tick % (self._every * stride) == 0 else self._places(world)
        return {name: [*_pairs(points, count, stride), *([here[name]] if here else [])] for name, points in self._points.items()}

    def _places(self, world: World, state: bytes | None = None) -> dict[str, list[float]]:
        """Returns where bodies are. What the world itself has computed is of the positions before its last step."""
        if self._data is None:
            self._data = MjData(world.mj_model)
        numbers = np.frombuffer(world.state_bytes() if state is None else state)
        mujoco.mj_setState(world.mj_model, self._data, numbers, INTEGRATION)
        mujoco.mj_kinematics(world.mj_model, self._data)
        places: Any = self._data.xpos
        return {name: places[body.root, :2].tolist() for name, body in world.bodies.items()}


def _pairs(points: array[float], count: int, stride: int) -> list[list[float]]:
    return [[points[2 * number], points[2 * number + 1]] for number in range(0, count, stride)]
