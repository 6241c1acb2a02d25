"""Stores the past of a worker's run: the physics states at the ends of ticks, from which curves are computed."""

from __future__ import annotations

from collections.abc import Iterator

from actr3d.world import World
from workbench.curves import stride

MOST_BYTES = 48_000_000
"""Above this size every second state is dropped, so that memory use stays bounded for long runs; a walker's state takes 1.8 kB."""


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
        if len(self._states) * len(state) > MOST_BYTES:
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
