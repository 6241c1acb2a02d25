"""What a worker keeps of its run's past: the physics at the ends of ticks, from which curves and the path walked are made."""

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
        if tick <= self._last[0]:
            return
        state = world.state_bytes()
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

    def since(self, first: int, most: int) -> Iterator[tuple[int, bytes]]:
        """Yields ticks from one on with their states, evenly spread, no more than so many; the last that is known is among them."""
        begin = -(-first // self._every)
        count = max(0, len(self._states) - begin)
        every = stride(count, most - 1)
        for number in range(-(-begin // every) * every, len(self._states), every):
            if number * self._every != self._last[0]:
                yield number * self._every, self._states[number]
        if self._last[0] >= first:
            yield self._last

    def at(self, tick: int) -> bytes | None:
        """Returns the state at the end of a tick, or the nearest one before that is kept; None where it has not been there."""
        if tick == self._last[0]:
            return self._last[1]
        return self._states[tick // self._every] if 0 <= tick < self._last[0] else None

    def up_to(self, first: int, last: int, spacing: int) -> Iterator[tuple[int, bytes]]:
        """Yields one tick in so many between two, and the last one, with their states."""
        for tick in (*range(-(-first // spacing) * spacing, last, spacing), last):
            state = self.at(tick)
            if state is not None and tick >= first:
                yield tick, state
