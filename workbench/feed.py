"""What browsers are shown of a session, each as fast as it can take it: one that is slow, or frozen, holds up nobody."""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import Sequence
from itertools import islice
from typing import Any, Protocol

import msgspec

MOST_EVENTS = 50_000
"""So many events of a run the server has at hand; older ones are in the worker's trace, and in the recording."""
MOST_KEPT = 50_000_000
"""And so many bytes of them."""
MOST_NOTICES = 500
MOST_REPLIES = 1_000
"""So many replies may wait for a browser; one that goes on asking and reads nothing is sent away."""
AT_ONCE = 2_000
"""So many events go in one message."""

MOST_BYTES = 500_000
"""And no more than so many bytes of them, but for a single event that is larger."""

Raw = msgspec.Raw


class EventLog:
    """The latest events of one run, by number from 0."""

    def __init__(self) -> None:
        self.first = 0
        self._events: deque[bytes] = deque()
        self._size = 0
        """How many bytes they have."""

    @property
    def next(self) -> int:
        """The number that the next event will have."""
        return self.first + len(self._events)

    def add(self, first: int, events: Sequence[bytes]) -> None:
        """Takes in events; those that are known already are left out, and where some are missing it begins anew after the gap."""
        if first > self.next:
            self._events.clear()
            self._size = 0
            self.first = first
        new = events[self.next - first :]
        self._events.extend(new)
        self._size += sum(map(len, new))
        while len(self._events) > MOST_EVENTS or self._size > MOST_KEPT:
            self._size -= len(self._events.popleft())
            self.first += 1

    def cut(self, number: int) -> None:
        """Drops the events from a number on."""
        while self._events and self.next > number:
            self._size -= len(self._events.pop())
        if not self._events:
            self.first = number

    def since(self, number: int, most: int = AT_ONCE) -> tuple[int, list[bytes]]:
        """Returns events from a number on, and the number of the first of them: another where older ones are gone."""
        begin = max(0, number - self.first)
        found: list[bytes] = []
        size = 0
        for event in islice(self._events, begin, begin + most):
            size += len(event)
            if found and size > MOST_BYTES:
                break
            found.append(event)
        return self.first + begin, found


class Shown(Protocol):
    """What is shown of a session."""

    @property
    def name(self) -> str:
        """What the session is called."""
        ...

    @property
    def run(self) -> int:
        """The number of the run that is shown."""
        ...

    @property
    def epoch(self) -> int:
        """How often the run has gone another way."""
        ...

    @property
    def log(self) -> EventLog:
        """The run's events."""
        ...

    @property
    def notices(self) -> deque[tuple[int, bytes]]:
        """What the user was told, numbered, as JSON."""
        ...

    @property
    def state_version(self) -> int:
        """Counts the states."""
        ...

    @property
    def facts_version(self) -> int:
        """Counts what is known of the session and its run."""
        ...

    def state_json(self) -> bytes:
        """Returns the newest state."""
        ...

    def facts_json(self) -> bytes:
        """Returns what is known of the session and its run."""
        ...


class Feed:
    """One browser's view of a session: what it has been sent, and what comes next.

    Args:
        shown: The session.
        name: What the browser is called among others.
    """

    def __init__(self, shown: Shown, name: str) -> None:
        self.name = name
        self._shown = shown
        self._changed = asyncio.Event()
        self._changed.set()
        self._replies: deque[bytes] = deque()
        self._run = self._epoch = -1
        self._next = 0
        self._cut: int | None = None
        self._notice = 0
        self._state = self._facts = -1

    def resume(self, run: int, epoch: int, events: int) -> None:
        """Goes on from what a browser knows of a run already, if it is the one that is shown."""
        if (run, epoch) == (self._shown.run, self._shown.epoch) and events <= self._shown.log.next:
            self._run, self._epoch, self._next = run, epoch, events

    def wake(self) -> None:
        """Lets it know that there is something new."""
        self._changed.set()

    def cut(self, number: int) -> None:
        """Takes note that events from a number on are no more."""
        if self._next > number:
            self._next = number
            self._cut = number if self._cut is None else min(self._cut, number)
        self._epoch = self._shown.epoch

    def reply(self, reply: bytes) -> None:
        """Takes what came of something that this browser has said."""
        self._replies.append(reply)
        self.wake()

    @property
    def choked(self) -> bool:
        """Whether the browser goes on asking and does not read what it is told."""
        return len(self._replies) > MOST_REPLIES

    async def next(self) -> bytes:
        """Returns the next message, as soon as there is anything to tell."""
        while True:
            await self._changed.wait()
            self._changed.clear()
            message = self._compose()
            if message:
                return msgspec.json.encode({"type": "update", "of": self._shown.name, "run": self._run, "epoch": self._epoch, **message})

    def _compose(self) -> dict[str, Any]:
        shown = self._shown
        message: dict[str, Any] = {}
        if self._facts != shown.facts_version:
            self._facts = shown.facts_version
            message["session"] = Raw(shown.facts_json())
            message["you"] = self.name
        if (self._run, self._epoch) != (shown.run, shown.epoch):
            self._run, self._epoch, self._next, self._cut = shown.run, shown.epoch, 0, 0
        if self._state != shown.state_version:
            self._state = shown.state_version
            message["state"] = Raw(shown.state_json())
        first, events = shown.log.since(self._next)
        if events or self._cut is not None:
            told: dict[str, Any] = {"first": first, "list": [Raw(event) for event in events]}
            if self._cut is not None:
                told["cut"], self._cut = self._cut, None
            if events and first > self._next:
                told["missing"] = first - self._next
            message["events"] = told
            self._next = first + len(events) if events else self._next
        notices = [(number, notice) for number, notice in shown.notices if number >= self._notice]
        if notices:
            self._notice = notices[-1][0] + 1
            message["notices"] = [Raw(notice) for _, notice in notices]
        if self._replies:
            message["replies"] = [Raw(reply) for reply in self._replies]
            self._replies.clear()
        if self._next < shown.log.next:
            self._changed.set()
        return message
