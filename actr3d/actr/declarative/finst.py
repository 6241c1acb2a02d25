"""Fingers of instantiation: mark what was retrieved or attended recently."""

from __future__ import annotations

from collections import deque
from typing import Any

from actr3d.actr.kernel.model import Model, profile_of


class Finst:
    """Marks a limited number of things for a limited time.

    Expired marks are removed when the marks are read. In the profile of Python ACT-R one event keeps a run going until the last
    mark has expired; in programs written for python_actr, each mark is removed by its own event, so that simultaneous events
    happen in the same order as in version 1.9.5. In the profile of ACT-R 7 there are no such events.

    Args:
        parent: The module whose clock is used.
        size: The maximum number of marks.
        time: The lifetime of a mark [s].
    """

    def __init__(self, parent: Model, size: int = 4, time: float = 3.0) -> None:
        self.parent = parent
        self.size = size
        self.time = time
        self._marks: list[Any] = []
        self._ends: deque[tuple[int, Any]] = deque()
        self._fresh: list[tuple[Any, int, int]] = []
        self._fresh_step = -1
        self._watched = False

    @property
    def obj(self) -> list[Any]:
        """The marked things, the oldest mark first."""
        if self._ends or self._fresh:
            self._bring_up_to_date()
        return self._marks

    def contains(self, obj: Any) -> bool:
        """Returns whether a thing is marked."""
        return obj in self.obj

    def add(self, obj: Any) -> None:
        """Marks a thing; the oldest mark is removed if there are too many."""
        if self.size == 0:
            return
        sch = self.parent.sch
        if sch.queue.first_come or not self._awaited:
            end = sch.after(self.time)
            self._bring_up_to_date()
            self._mark(obj)
            self._expect(obj, end)
            self._watch(end)
        else:
            self._mark(obj)
            sch.call_after(self.time, self.remove, (obj,))

    def add_after(self, obj: Any) -> None:
        """Marks a thing after the current event: further requests of the same production do not see the mark.

        Only for runs in which simultaneous events happen in the order in which they were scheduled.
        """
        if self.size == 0:
            return
        sch = self.parent.sch
        if self._fresh and self._fresh_step != sch.step:
            self._bring_up_to_date()
        self._fresh_step = sch.step
        end = sch.after(self.time)
        self._fresh.append((obj, sch.now_us, end))
        self._watch(end)

    def remove(self, obj: Any) -> None:
        """Removes the oldest mark of a thing."""
        if obj in self._marks:
            self._marks.remove(obj)

    @property
    def _awaited(self) -> bool:
        """Whether a run continues until all marks have expired."""
        return profile_of(self.parent).awaits_expiry

    def _mark(self, obj: Any) -> None:
        self._marks.append(obj)
        if len(self._marks) > self.size:
            del self._marks[0]

    def _expect(self, obj: Any, end: int) -> None:
        """Records when a mark will expire."""
        if self._ends and self._ends[-1][0] > end:  # the lifetime of marks was shortened
            self._ends = deque(sorted([*self._ends, (end, obj)], key=lambda mark: mark[0]))
        else:
            self._ends.append((end, obj))

    def _bring_up_to_date(self) -> None:
        """Adds the marks of earlier events, and removes expired ones."""
        sch = self.parent.sch
        if self._fresh and self._fresh_step != sch.step:
            fresh, self._fresh = self._fresh, []
            for obj, begin, end in fresh:
                self._expire(begin)
                self._mark(obj)
                self._expect(obj, end)
        self._expire(sch.now_us)

    def _expire(self, now: int) -> None:
        ends = self._ends
        while ends and ends[0][0] <= now:
            self.remove(ends.popleft()[1])

    def _watch(self, end: int) -> None:
        """Keeps the run going until the last mark has expired, if the profile requires it."""
        if not self._watched and self._awaited:
            self._watched = True
            self.parent.sch.call_at(end, self._look)

    def _look(self) -> None:
        self._bring_up_to_date()
        self._watched = bool(self._ends)
        if self._watched:
            sch = self.parent.sch
            sch.call_at(self._ends[-1][0], self._look)
