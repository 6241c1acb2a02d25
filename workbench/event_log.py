"""The latest events of a run: in the worker those that wait to be sent, in the server those that browsers are sent."""

from __future__ import annotations

from collections import deque
from collections.abc import Sequence
from itertools import islice

MAX_EVENTS = 50_000
"""How many events of a run are kept in memory; older events are in the worker's trace and in the recording."""
MAX_KEPT = 50_000_000
"""Maximum total size of these events [bytes]."""
AT_ONCE = 2_000
"""Maximum number of events in one message."""
MAX_BYTES = 500_000
"""Maximum size of the events in one message [bytes]; a single larger event is sent alone."""


class LatestEvents:
    """Holds the latest events of one run, numbered from 0."""

    def __init__(self) -> None:
        self.first = 0
        self._events: deque[bytes] = deque()
        self._size = 0
        """Total size of the events [bytes]."""

    def __len__(self) -> int:
        return len(self._events)

    @property
    def next(self) -> int:
        """The number of the next event."""
        return self.first + len(self._events)

    def add(self, first: int, events: Sequence[bytes]) -> None:
        """Adds events; known ones are skipped, and after a gap the log starts again."""
        if first > self.next:
            self._events.clear()
            self._size = 0
            self.first = first
        new = events[self.next - first :]
        self._events.extend(new)
        self._size += sum(map(len, new))
        while len(self._events) > MAX_EVENTS or self._size > MAX_KEPT:
            self.drop(self.first + 1)

    def cut(self, number: int) -> None:
        """Removes the events from a number on."""
        while self._events and self.next > number:
            self._size -= len(self._events.pop())
        if not self._events:
            self.first = min(self.first, number)

    def drop(self, number: int) -> None:
        """Removes the events before a number."""
        while self._events and self.first < number:
            self._size -= len(self._events.popleft())
            self.first += 1

    def since(self, number: int, most: int = AT_ONCE) -> tuple[int, list[bytes]]:
        """Returns events from a number on, and the number of the first; it is higher if older events are gone."""
        begin = max(0, number - self.first)
        found: list[bytes] = []
        size = 0
        for event in islice(self._events, begin, begin + most):
            size += len(event)
            if found and size > MAX_BYTES:
                break
            found.append(event)
        return self.first + begin, found
