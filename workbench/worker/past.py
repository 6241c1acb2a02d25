"""What a worker keeps of its run's past: the physics at the ends of ticks, from which curves are made."""

from __future__ import annotations

from collections.abc import Iterator

from actr3d.world import World
from workbench.curves import stride

MOST_BYTES = 48_000_000
"""Of more states every second one is left out, so that a long run needs no more memory than a short one; a walker's are 1.8 kB each."""


class Past:
    """Keeps the states of a run, whoever watches; also those ahead of the present after it has gone back."""

    def __init__(self) -> None:
        self._states: list[bytes] = []
        self._every = 1
        """One of so many ticks is kept."""
        self._last: tuple[int, bytes] = (-1, b"")

    def keep(self, tick: int, world: World) -> None:
        """Takes the end of a tick, or the start of the run (tick 0); what is known already stays."""
        if tick > self._last[0]:
            self.add(tick, world.state_bytes())

    def add(self, tick: int, state: bytes) -> None:
        """Takes the state at the end of a tick; what is known already stays."""
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
        """Forgets what came after a tick: the run goes another way."""
        if tick < self._last[0]:
            del self._states[tick // self._every + 1 :]
            kept = len(self._states) - 1
            self._last = kept * self._every, self._states[kept]

    def within(self, first: int, last: int | None, most: int) -> Iterator[tuple[int, bytes]]:
        """Yields the ticks of a stretch with their states, evenly spread, no more than `most`; the last one is among them.

        Args:
            first: The first tick of the stretch.
            last: The last one; None for the furthest that the run has come.
            most: At least 2.
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
