"""Stores the past of a simulation: the physics states at the ends of ticks, from which curves are computed, the contacts of bodies
within ticks, and their paths."""

from __future__ import annotations

import math
from array import array
from collections.abc import Iterator, Sequence
from itertools import groupby

import mujoco
import numpy as np
from mujoco import MjData

from actr3d.actr.kernel.run_limits import Contacts
from actr3d.clock import seconds
from actr3d.recording.writer import State as RecordedState
from actr3d.world import World
from workbench.curves import INTEGRATION, Moment, harder, place_and_speed

MAX_BYTES = 48_000_000
"""Above this size every second state is dropped, so that memory use stays bounded for long runs; a walker's state takes 1.8 kB."""
MAX_SIMULATIONS = 4
"""How many simulations of a program keep their past."""
STEP = 50_000
"""Interval between two points of a path [us]."""
CONTACTS = 500
"""The memory that the contacts of a tick take, approximately [bytes]."""
NEAR = 0.05
"""How much farther than its speed allows a body may have moved between two points that are joined [m]."""
NUMBERS = 4
"""The number of values that are stored of a point."""
MAX_POINTS = 1_000
"""Maximum number of points that are drawn; if there are more, every second one is left out, repeatedly."""


class SimulationHistory:
    """Stores the past of a simulation. It can also serve the same simulation when it is run again.

    Args:
        period: Length of a tick [us].
    """

    def __init__(self, period: int) -> None:
        self.states = StateHistory()
        self.walked = PathHistory(period)

    @property
    def furthest(self) -> int:
        """The last tick that was stored."""
        return self.states.furthest

    def keep(self, tick: int, world: World, contacts: Contacts) -> None:
        """Stores the end of a tick, or the start of the run (tick 0); ticks that are known for sure are skipped."""
        if tick > self.furthest or self.states.recorded:
            self.states.add(tick, world.state_bytes(), contacts)
        self.walked.keep(tick, world)

    def cut(self, tick: int) -> None:
        """Removes what came after a tick, because the run continues differently."""
        self.states.cut(tick)
        self.walked.cut(tick)


class StateHistory:
    """Stores the states of a run, and the contacts of bodies between them, whether or not anyone watches, including those ahead of the
    present after it has gone back."""

    def __init__(self) -> None:
        self.recorded = False
        """Whether those that the run has not reached come from a recording, from which it may differ."""
        self._states: list[bytes] = []
        self._contacts: dict[int, Contacts] = {}
        """By the number of a state, and of the one to come: the contacts since the state before."""
        self.every = 1
        """Only every n-th tick is stored, and the last one."""
        self._last: Moment = (-1, b"", {})

    @property
    def furthest(self) -> int:
        """The last tick that was stored."""
        return self._last[0]

    def add(self, tick: int, state: bytes, contacts: Contacts) -> None:
        """Stores the state at the end of a tick, or at the start of the run (tick 0), and the contacts in it; known ticks are skipped.
        What a recording has from a different state on is removed."""
        if tick <= self.furthest:
            if not self.recorded or tick % self.every or self._states[tick // self.every] == state:
                return
            self.recorded = False
            self.cut(tick - self.every)
        self._last = tick, state, contacts
        self._add_contacts(-(-tick // self.every), contacts)
        if tick % self.every:
            return
        self._states.append(state)
        if len(self._states) * len(state) + len(self._contacts) * CONTACTS > MAX_BYTES:
            del self._states[1::2]
            self.every *= 2
            known, self._contacts = self._contacts, {}
            for number, contacts in known.items():
                self._add_contacts(-(-number // 2), contacts)

    def add_recorded(self, state: RecordedState) -> None:
        """Stores a state of a recording that the run repeats, and may differ from."""
        self.add(state.tick, state.data, state.contacts)
        self.recorded = True

    def _add_contacts(self, number: int, contacts: Contacts) -> None:
        if contacts:
            self._contacts[number] = harder(self._contacts.get(number, {}), contacts)

    def cut(self, tick: int) -> None:
        """Removes what came after a tick, because the run continues differently."""
        if tick < self.furthest:
            del self._states[tick // self.every + 1 :]
            kept = len(self._states) - 1
            self._contacts = {number: contacts for number, contacts in self._contacts.items() if number <= kept}
            self._last = self._stored(kept) if self._states else (-1, b"", {})

    def contacts(self, tick: int) -> Contacts:
        """Returns the contacts in a tick; if not every tick is stored, those since the state before."""
        return self._last[2] if tick == self.furthest else self._contacts.get(-(-tick // self.every), {})

    def between(self, first: int, last: int | None) -> Iterator[Moment]:
        """Yields the stored moments of an interval of ticks; if `last` is None, up to the furthest that the run has reached."""
        end = self.furthest if last is None else min(last, self.furthest)
        for number in range(-(-first // self.every), end // self.every + 1):
            yield self._stored(number)
        if end == self.furthest >= first and end % self.every:
            yield end, self._last[1], self._contacts.get(len(self._states), {})

    def _stored(self, number: int) -> Moment:
        return number * self.every, self._states[number], self._contacts.get(number, {})


class PathHistory:
    """Stores the positions of bodies on the floor, including those ahead of the present after the run has gone back.

    Where a body was put somewhere else at once, its path has a gap: it moved farther than its speed allows.

    Args:
        period: Length of a tick [us].
    """

    def __init__(self, period: int) -> None:
        self._every = max(1, STEP // period)
        """Only every n-th tick has a point."""
        self._interval = seconds(self._every * period)
        """The time between two points [s]."""
        self._points: dict[str, array[float]] = {}
        """By body: x and y of each point [m], its speed [m/s], and the number of the piece of the path."""
        self._count = 0
        self._data: MjData | None = None

    def keep(self, tick: int, world: World) -> None:
        """Stores the positions at the end of a tick, or at the start of the run (tick 0); known ticks are skipped."""
        if tick != self._count * self._every:
            return
        for name, point in self._present(world, self._count).items():
            self._points.setdefault(name, array("d")).extend(point)
        self._count += 1

    def cut(self, tick: int) -> None:
        """Removes what came after a tick, because the run continues differently."""
        self._count = min(self._count, tick // self._every + 1)
        for points in self._points.values():
            del points[NUMBERS * self._count :]

    def up_to(self, tick: int, world: World) -> dict[str, list[list[list[float]]]]:
        """Returns the paths up to the current tick, by body: pieces of positions (x, y) [m]."""
        count = tick // self._every + 1
        stride = 1
        while count > MAX_POINTS * stride:
            stride *= 2
        here = {} if tick % (self._every * stride) == 0 else self._present(world, count)
        return {name: _pieces([*_points(points, count, stride), *([here[name]] if here else [])]) for name, points in self._points.items()}

    def _present(self, world: World, count: int) -> dict[str, list[float]]:
        """Returns the points of the bodies now, after `count` points. They are computed here, as the positions in the world's data are
        from before its last step."""
        if self._data is None:
            self._data = MjData(world.mj_model)
        numbers = np.frombuffer(world.state_bytes())
        mujoco.mj_setState(world.mj_model, self._data, numbers, INTEGRATION)
        for compute in (mujoco.mj_kinematics, mujoco.mj_comPos, mujoco.mj_comVel):
            compute(world.mj_model, self._data)
        now = {name: place_and_speed(world.mj_model, self._data, body.root) for name, body in world.bodies.items()}
        return {name: self._point(name, count, *values) for name, values in now.items()}

    def _point(self, name: str, count: int, x: float, y: float, speed: float) -> list[float]:
        if count == 0:
            return [x, y, speed, 0]
        x_before, y_before, speed_before, piece = self._points[name][NUMBERS * (count - 1) : NUMBERS * count]
        is_joined = math.hypot(x - x_before, y - y_before) <= max(speed, speed_before) * self._interval + NEAR
        return [x, y, speed, piece if is_joined else piece + 1]


def _points(points: array[float], count: int, stride: int) -> Iterator[Sequence[float]]:
    return (points[NUMBERS * number : NUMBERS * (number + 1)] for number in range(0, count, stride))


def _pieces(points: Sequence[Sequence[float]]) -> list[list[list[float]]]:
    return [[[x, y] for x, y, *_ in piece] for _, piece in groupby(points, lambda point: point[-1])]
