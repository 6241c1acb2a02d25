"""Time in whole microseconds, and the queue of future events."""

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
        what: The name of the value in an error message.

    Raises:
        SchedulerError: If the value is not a finite number.
    """
    try:
        if isfinite(seconds):
            return round(seconds * MICROSECONDS)
    except (TypeError, OverflowError):
        pass
    raise SchedulerError(f"{what}: must be a finite number of seconds (got {seconds!r})")


def seconds(time: int) -> float:
    """Converts whole microseconds to seconds [s]."""
    return time / MICROSECONDS


NO_FRACTION = 1e-15
"""A smaller fraction of a duration's microseconds is a floating-point rounding error: 0.07 s are 70000.00000000001 us."""


class Ends:
    """Computes the ends of successive runs: each within half a microsecond of the exact sum of all durations.

    The rounding error of one run is added to the next, if that one begins where the first was to end.
    """

    __slots__ = ("_at", "_duration", "_left", "_length")

    def __init__(self) -> None:
        self._left = 0.0
        self._at = 0
        self._duration = 0.0  # the latest one of whole microseconds; most calls repeat it
        self._length = 0

    def after(self, now_us: int, duration: float) -> int:
        """Returns the end of a run that starts now [us].

        Args:
            now_us: The current time [us].
            duration: The duration of the run [s].

        Raises:
            SchedulerError: If the duration is negative or not a finite number.
        """
        if duration == self._duration and not self._left:
            return now_us + self._length
        length = microseconds(duration, "the limit of a run")
        left = float(duration) * MICROSECONDS - length
        if -NO_FRACTION * length <= left <= NO_FRACTION * length:
            left = 0.0
            if length >= 0:
                self._duration, self._length = duration, length
        if self._left and self._at == now_us:
            left += self._left
            more = round(left)
            length += more
            left -= more
        if length < 0:
            raise SchedulerError(f"the limit of a run: must be >= 0 (got {duration!r} s)")
        self._left = left
        self._at = end = now_us + length
        return end


STRAY_US = 100
"""A sum of delays that differs from its event's time by more than this [us] no longer determines the order of two events."""


class EventQueue(Generic[T]):
    """Holds events ordered by (time, -priority, serial).

    At the same time, events of higher priority come first, and events of equal priority in the order of insertion:
    simultaneous events have one defined order.

    Args:
        first_come: Whether events of equal priority come in the order of insertion. Otherwise they come in the order that models
            written for python_actr expect, which is defined too, but harder to predict: its clock adds delays as floating
            point numbers, so that 20 times 0.05 s comes just after 1 s. Events of one microsecond are ordered by these sums,
            then by priority, and then by their position in the heap. This compares the events themselves, which must say that
            none is less than another.
    """

    __slots__ = ("_serials", "first_come", "heap", "sum")

    def __init__(self, first_come: bool = True) -> None:
        self.heap: list[tuple[int, float, float, T]] = []
        """Each event with its time [us], minus its priority and its serial; or with its sum [s] and minus its priority instead."""
        self.first_come = first_come
        self.sum = 0.0
        """The current time as a sum of delays [s]."""
        self._serials = count(1)

    def __len__(self) -> int:
        return len(self.heap)

    def push(self, time: int, event: T, priority: float = 0, delay: float = 0.0) -> None:
        """Adds an event at `time` [us], which is `delay` [s] from now."""
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
        """Removes and returns the next event; its time becomes the current time."""
        _, self.sum, _, event = heappop(self.heap)
        return event

    def take(self) -> tuple[int, float, T]:
        """Removes the next event, and returns its time [us], its priority, and the event."""
        time, first, second, event = heappop(self.heap)
        return time, -(first if self.first_come else second), event
