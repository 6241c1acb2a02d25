"""Time as whole microseconds, and the queue of what is to happen when."""

from __future__ import annotations

from heapq import heappop, heappush
from itertools import count
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


STRAY_US = 100
"""A sum of delays that is farther from its event's time than this [us] no longer says which of two events comes first."""


class EventQueue(Generic[T]):
    """Holds events ordered by (time, -priority, serial).

    At one time the event of higher priority comes first, and among equals the one that was put in first:
    simultaneous events have one defined order.

    Args:
        first_come: Whether equals come in the order they were put in. Without it they come as models written for
            python_actr know it, which is defined too, though harder to foresee: its clock adds delays up as floating
            point numbers, so that 20 times 0.05 s comes just after 1 s. Events of one microsecond are put in order by
            these sums, then by priority, and then as the heap has them. Events are compared for that, and must say that
            none is less than another.
    """

    __slots__ = ("_serials", "first_come", "heap", "sum")

    def __init__(self, first_come: bool = True) -> None:
        self.heap: list[tuple[int, float, float, T]] = []
        """Each event with its time [us], minus its priority and its serial; with its sum [s] and minus its priority instead."""
        self.first_come = first_come
        self.sum = 0.0
        """The present as a sum of delays [s]."""
        self._serials = count(1)

    def __len__(self) -> int:
        return len(self.heap)

    def push(self, time: int, event: T, priority: float = 0, delay: float = 0.0) -> None:
        """Puts an event in, at `time` [us], which is `delay` [s] from now."""
        if self.first_come:
            heappush(self.heap, (time, -priority, next(self._serials), event))
            return
        total = self.sum
        if delay:
            total += delay
            if not -STRAY_US < total * MICROSECONDS - time < STRAY_US:
                total = time / MICROSECONDS
        heappush(self.heap, (time, total, -priority, event))

    def pop(self) -> T:
        """Takes the next event out; its time is the present."""
        _, self.sum, _, event = heappop(self.heap)
        return event

    def take(self) -> tuple[int, float, T]:
        """Takes the next event out, and returns its time [us], its priority, and itself."""
        time, first, second, event = heappop(self.heap)
        return time, -(first if self.first_come else second), event
