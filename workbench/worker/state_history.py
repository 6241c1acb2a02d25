"""Stores the past of a simulation: the physics states at the ends of ticks, from which curves are computed, and the paths of bodies."""

from __future__ import annotations

from array import array
from collections.abc import Iterator
from typing import Any

import mujoco
import numpy as np
from mujoco import MjData

from actr3d.world import World
from workbench.curves import INTEGRATION, stride

MAX_BYTES = 48_000_000
"""Above this size every second state is dropped, so that memory use stays bounded for long runs; a walker's state takes 1.8 kB."""
STEP = 50_000
"""Interval between two points of a path [us]."""
MAX_POINTS = 1_000
"""Maximum number of points that are drawn; if there are more, every second one is left out, repeatedly."""


class Kept:
    """Stores the past of a simulation. It can also serve the same simulation when it is run again.

    Args:
        period: Length of a tick [us].
    """

    def __init__(self, period: int) -> None:
        self.states = Past()
        self.walked = Walked(period)

    def keep(self, tick: int, world: World) -> None:
        """Stores the end of a tick, or the start of the run (tick 0); known ticks are skipped."""
        self.states.keep(tick, world)
        self.walked.keep(tick, world)

    def cut(self, tick: int) -> None:
        """Removes what came after a tick, because the run continues differently."""
        self.states.cut(tick)
        self.walked.cut(tick)


class Past:
    """Stores the states of a run, whether or not anyone watches, including those ahead of the present after it has gone back."""

    def __init__(self) -> None:
        self._states: list[bytes] = []
        self._every = 1
        """Only every n-th tick is stored."""
        self._last: tuple[int, bytes] = (-1, b"")

    def keep(self, tick: int, world: World) -> None:
        """Stores the state at the end of a tick, or at the start of the run (tick 0); known ticks are skipped."""
        if tick > self._last[0]:
            self.add(tick, world.state_bytes())

    def add(self, tick: int, state: bytes) -> None:
        """Stores a state at the end of a tick; known ticks are skipped."""
        if tick <= self._last[0]:
            return
        self._last = tick, state
        if tick % self._every:
            return
        self._states.append(state)
        if len(self._states) * len(state) > MAX_BYTES:
            del self._states[1::2]
            self._every *= 2

    def cut(self, tick: int) -> None:
        """Removes the states after a tick, because the run continues differently."""
        if tick < self._last[0]:
            del self._states[tick // self._every + 1 :]
            kept = len(self._states) - 1
            self._last = kept * self._every, self._states[kept]

    def within(self, first: int, last: int | None, most: int) -> Iterator[tuple[int, bytes]]:
        """Yields the ticks of an interval with their states, evenly spaced, at most `most`, including the last one.

        Args:
            first: The first tick of the interval.
            last: The last tick; None for the furthest that the run has reached.
            most: Maximum number of states, at least 2.
        """
        end = self._last[0] if last is None else min(last, self._last[0])
        if end < first:
            return
        begin, beyond = -(-first // self._every), min(len(self._states), end // self._every + 1)
        final = self._last if end == self._last[0] else ((beyond - 1) * self._every, self._states[beyond - 1])
        every = stride(max(0, beyond - begin), most - 1)
        for number in range(-(-begin // every) * every, beyond, every):
            if number * self._every != final[0]:
                yield number * self._every, self._states[number]
        if final[0] >= first:
            yield final


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
        while count > MAX_POINTS * stride:
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
