"""Holds a run to a speed, and measures the one it has."""

from __future__ import annotations

from collections import deque
from time import perf_counter

from actr3d.clock import MICROSECONDS

WINDOW = 1.0
"""Over how long the speed is measured [s]."""
SHORTEST = 1 / 60
"""Over less than this nothing is measured [s]; ours, half of the time between two pictures."""
LATE = 0.25
"""Who is later than this [s] does not catch up."""


class Pacer:
    """Tells how long a run is to wait, and how many times as fast as real time it has gone lately.

    Args:
        factor: How many times as fast as real time it is to go; None for as fast as it can.
    """

    def __init__(self, factor: float | None) -> None:
        self.factor = factor
        self._anchor: tuple[float, int] | None = None
        """A time of the day [s], and the run's own [us] that belongs to it."""
        self._marks: deque[tuple[float, int]] = deque()
        """Such times of the last while."""

    def halt(self) -> None:
        """Takes note that the run waits for something else than its time: what comes then is held and measured anew."""
        self._anchor = None
        self._marks.clear()

    def set(self, factor: float | None) -> None:
        """Holds the run to another speed from now on."""
        self.factor, self._anchor = factor, None

    def early(self, clock: int, goal: int) -> float:
        """Returns how much too early it is for a moment of a run [s]; at most 0 where it may come.

        Args:
            clock: Where the run is [us].
            goal: The moment [us].
        """
        if self.factor is None:
            return 0.0
        now = perf_counter()
        if self._anchor is None:
            self._anchor = now, clock
        begin, at = self._anchor
        early = begin + (goal - at) / MICROSECONDS / self.factor - now
        if early < -LATE:
            self._anchor = now, goal
        return early

    def measure(self, clock: int) -> float | None:
        """Returns the speed of a run that is at a time [us] now; None where it has only begun."""
        now = perf_counter()
        self._marks.append((now, clock))
        while now - self._marks[0][0] > WINDOW:
            self._marks.popleft()
        begin, at = self._marks[0]
        return (clock - at) / MICROSECONDS / (now - begin) if now - begin > SHORTEST else None
