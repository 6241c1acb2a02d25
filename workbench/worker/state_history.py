"""Stores the past of a simulation: the physics states at the ends of ticks, from which curves are computed, the paths of bodies, and what
touched them within ticks."""

from __future__ import annotations

from array import array
from collections.abc import Iterator
from typing import Any

import mujoco
import numpy as np
from mujoco import MjData

from actr3d.simulation.surroundings import ground_names
from actr3d.world import World
from workbench.curves import INTEGRATION, stride
from workbench.worker.stop_conditions import Contact, Touches

MAX_BYTES = 48_000_000
"""Above this size every second state is dropped, so that memory use stays bounded for long runs; a walker's state takes 1.8 kB."""
STEP = 50_000
"""Interval between two points of a path [us]."""
MAX_TOUCHED = 50_000
"""Maximum number of ticks in which something touched that are stored; contacts that last are seen at the ends of ticks as well."""
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
        self.touched = Touched()

    @property
    def furthest(self) -> int:
        """The last tick that was stored."""
        return self.states.furthest

    def keep(self, tick: int, world: World) -> None:
        """Stores the end of a tick, or the start of the run (tick 0); known ticks are skipped."""
        self.states.keep(tick, world)
        self.walked.keep(tick, world)
        self.touched.keep(tick)

    def cut(self, tick: int) -> None:
        """Removes what came after a tick, because the run continues differently."""
        self.states.cut(tick)
        self.walked.cut(tick)
        self.touched.cut(tick)


class Past:
    """Stores the states of a run, whether or not anyone watches, including those ahead of the present after it has gone back."""

    def __init__(self) -> None:
        self._states: list[bytes] = []
        self._every = 1
        """Only every n-th tick is stored."""
        self._last: tuple[int, bytes] = (-1, b"")

    @property
    def furthest(self) -> int:
        """The last tick that was stored."""
        return self._last[0]

    def keep(self, tick: int, world: World) -> None:
        """Stores the state at the end of a tick, or at the start of the run (tick 0); known ticks are skipped."""
        if tick > self.furthest:
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

    def state(self, tick: int) -> bytes | None:
        """Returns the state at the end of a tick; None if it is not stored."""
        if tick == self._last[0]:
            return self._last[1]
        return None if tick % self._every or not 0 <= tick < self._last[0] else self._states[tick // self._every]

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


class Touched:
    """Stores what touched bodies in any physics step of a tick, and how hard: many a touch is over at the end of its tick."""

    def __init__(self) -> None:
        self._ticks: dict[int, dict[Contact, float]] = {}
        """By tick, in their order: the greatest force of each contact in it [N]."""
        self._now: dict[Contact, float] = {}
        self._last = 0

    def watch(self, world: World) -> None:
        """Looks at each physics step of a world from now on."""
        ground, data = ground_names(world), world.mj_data
        floors = np.array([*(owner in ground for owner in world.owners), False])

        def look() -> None:
            for body in world.bodies.values() if data.ncon else ():
                for touch in body.contacts.touches() if body.contacts.any_in_step(floors) else ():
                    if touch.other not in ground:
                        contact = body.name, touch.part, touch.other
                        self._now[contact] = max(touch.force, self._now.get(contact, 0.0))

        world.watchers.append(look)

    def keep(self, tick: int) -> None:
        """Stores what touched in the tick that has just ended; known ticks are skipped."""
        if tick > self._last and self._now and len(self._ticks) < MAX_TOUCHED:
            self._ticks[tick] = self._now
        self._last = max(self._last, tick)
        self._now = {}

    def cut(self, tick: int) -> None:
        """Removes what came after a tick, because the run continues differently."""
        self._last, self._now = min(self._last, tick), {}
        for later in [known for known in self._ticks if known > tick]:
            del self._ticks[later]

    def at(self, tick: int) -> Touches:
        """Returns what touched in a tick."""
        return frozenset(self._ticks.get(tick, ()))

    def forces(self, first: int, last: int | None) -> dict[int, dict[str, float]]:
        """Returns the greatest force of each body that was touched, by tick of an interval and by body [N]."""
        found: dict[int, dict[str, float]] = {}
        for tick, contacts in self._ticks.items():
            if first <= tick and (last is None or tick <= last):
                forces = found[tick] = dict[str, float]()
                for (name, _, _), force in contacts.items():
                    forces[name] = max(force, forces.get(name, 0.0))
        return found


def _pairs(points: array[float], count: int, stride: int) -> list[list[float]]:
    return [[points[2 * number], points[2 * number + 1]] for number in range(0, count, stride)]
