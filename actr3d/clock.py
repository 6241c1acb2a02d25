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

    def next_time(self) -> int | None:
        """Returns the time of the next event [us], or None where nothing waits."""
        return self.heap[0][0] if self.heap else None
