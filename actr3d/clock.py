"""Time as whole microseconds, and the queue of what is to happen when."""

from __future__ import annotations

from heapq import heappop, heappush
from itertools import count, repeat
from math import isfinite
from typing import Generic, TypeVar

from actr3d.errors import SchedulerError

MICROSECONDS = 1_000_000
"""Ticks of the clock in one second."""

T = TypeVar("T")


def microseconds(seconds: float, what: str = "a time") -> int:
    """Converts seconds to the nearest whole microsecond.

    Args:
        seconds: A finite number of seconds [s].
        what: How an error message calls the value.

    Raises:
        SchedulerError: If the value is not a finite number.
    """
    try:
        if isfinite(seconds):
            return round(seconds * MICROSECONDS)
    except (TypeError, OverflowError):
        pass
    raise SchedulerError(f"{what} must be a finite number of seconds (got {seconds!r})")


def seconds(time: int) -> float:
    """Converts whole microseconds to seconds [s]."""
    return time / MICROSECONDS


NO_PART = 1e-15
"""A smaller part of a duration's microseconds is how floating point writes a whole number: 0.07 s are 70000.00000000001 us."""


class Ends:
    """Finds where runs end that follow one another: never more than half a microsecond from the exact end of them all.

    What rounding leaves over of one run, the next takes in, if it begins where that one was to end.
    """

    __slots__ = ("_at", "_duration", "_left", "_length")

    def __init__(self) -> None:
        self._left = 0.0
        self._at = 0
        self._duration = 0.0  # the latest of whole microseconds; most calls ask for the same again
        self._length = 0

    def after(self, now_us: int, duration: float) -> int:
        """Returns when a run that starts now is to end [us].

        Args:
            now_us: The present [us].
            duration: How long the run is to be [s].

        Raises:
            SchedulerError: If the duration is negative or not a finite number.
        """
        if duration == self._duration and not self._left:
            return now_us + self._length
        length = microseconds(duration, "the limit of a run")
        left = float(duration) * MICROSECONDS - length
        if -NO_PART * length <= left <= NO_PART * length:
            left = 0.0
            if length >= 0:
                self._duration, self._length = duration, length
        if self._left and self._at == now_us:
            left += self._left
            more = round(left)
            length += more
            left -= more
        if length < 0:
            raise SchedulerError(f"the limit of a run must not be negative (got {duration!r} s)")
        self._left = left
        self._at = end = now_us + length
        return end


class EventQueue(Generic[T]):
    """Holds events ordered by (time, -priority, serial).

    At one time the event of higher priority comes first, and among equals the one that was put in first:
    simultaneous events have one defined order.

    Args:
        first_come: Whether equals come in the order they were put in. Without it they come as the heap has them, which
            is defined too, though harder to foresee: it is the order that models written for python_actr know. Events
            are compared then, and must say that none is less than another.
    """

    __slots__ = ("_serials", "first_come", "heap")

    def __init__(self, first_come: bool = True) -> None:
        self.heap: list[tuple[int, float, int, T]] = []
        self.first_come = first_come
        self._serials = count(1) if first_come else repeat(0)

    def __len__(self) -> int:
        return len(self.heap)

    def push(self, time: int, event: T, priority: float = 0) -> None:
        """Puts an event in, at `time` [us]."""
        heappush(self.heap, (time, -priority, next(self._serials), event))

    def pop(self) -> T:
        """Takes the next event out."""
        return heappop(self.heap)[3]
