"""Limits the speed of a run, and measures its actual speed."""

from __future__ import annotations

from collections import deque
from time import perf_counter

from actr3d.clock import MICROSECONDS

WINDOW = 1.0
"""Interval over which the speed is measured [s]."""
SHORTEST = 1 / 60
"""Minimum interval for a measurement [s]; chosen here as half of the time between two pictures."""
LATE = 0.25
"""A run that is later than this does not catch up [s]."""


class Pacer:
    """Computes how long a run must wait, and measures its recent speed as a multiple of real time.

    Args:
        factor: The maximum speed as a multiple of real time; None for no limit.
    """

    def __init__(self, factor: float | None) -> None:
        self.factor = factor
        self._anchor: tuple[float, int] | None = None
        """A wall-clock time [s] and the corresponding time of the run [us]."""
        self._marks: deque[tuple[float, int]] = deque()
        """Such pairs of recent times."""

    def halt(self) -> None:
        """Restarts pacing and measuring, because the run has waited for something other than its time."""
        self._anchor = None
        self._marks.clear()

    def set(self, factor: float | None) -> None:
        """Sets another speed from now on."""
        self.factor, self._anchor = factor, None

    def early(self, clock: int, goal: int) -> float:
        """Returns how long a run must wait for a moment [s]; 0 or less if it is due.

        Args:
            clock: The current time of the run [us].
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
        """Returns the speed of a run, given its current time [us]; None if it has only just started."""
        now = perf_counter()
        self._marks.append((now, clock))
        while now - self._marks[0][0] > WINDOW:
            self._marks.popleft()
        begin, at = self._marks[0]
        return (clock - at) / MICROSECONDS / (now - begin) if now - begin > SHORTEST else None
