"""Stores when the events of a program happened: by its clock, which counts all its runs, and by that of each run, which starts at 0."""

from __future__ import annotations

from array import array
from bisect import bisect_right
from collections.abc import Sequence

from actr3d.trace import TraceEvent


class _RunTimes:
    """The times of one run, each at one of its events [us], ascending."""

    def __init__(self) -> None:
        self.own = array("q")
        self.whole = array("q")
        """The times of the program at these."""


class ProgramTimes:
    """Stores the times of a program's events, in both ways of counting."""

    def __init__(self) -> None:
        self._events = array("q")
        self._runs: dict[int, _RunTimes] = {}

    def add(self, event: TraceEvent, time: int) -> None:
        """Adds an event that happens at a time of the program [us]."""
        self._events.append(time)
        if event.kind == "output":  # of the program, and of no run
            return
        known = self._runs.setdefault(event.run, _RunTimes())
        if not known.own or event.time_us > known.own[-1]:
            known.own.append(event.time_us)
            known.whole.append(time)

    def between(self, first: int, end: int) -> Sequence[int]:
        """Returns the times of the program at its events from a number on and before another one [us]."""
        return self._events[first:end]

    @property
    def last(self) -> int:
        """The time of the program at its last event [us]."""
        return self._events[-1] if self._events else 0

    def own(self, run: int, time: int) -> int | None:
        """Returns the time of a run at its last event up to a time of the program [us]; None if it had not begun."""
        known = self._runs.get(run, _RunTimes())
        place = bisect_right(known.whole, time)
        return known.own[place - 1] if place else None

    def whole(self, run: int, time: int) -> int:
        """Returns the time of the program at a time of a run [us]."""
        known = self._runs[run]
        place = max(1, bisect_right(known.own, time))
        return known.whole[place - 1] + time - known.own[place - 1]
