"""Sends a session's news to browsers, each at its own speed: a slow or frozen browser delays no other."""

from __future__ import annotations

import asyncio
from abc import ABC, abstractmethod
from collections import deque
from typing import Any

import msgspec

from workbench.event_log import LatestEvents

MAX_NOTICES = 500
MAX_REPLIES = 1_000
"""How many replies may wait for a browser; one that keeps asking without reading is disconnected."""
Raw = msgspec.Raw


class Broadcast(ABC):
    """What is sent to all browsers that watch: events and notices with numbers, state and facts with versions. It is what `Feed` knows of
    a session, whose module imports this one.
    """

    def __init__(self, name: str) -> None:
        self.name = name
        self.feeds: list[Feed] = []
        self.run: int = 0
        """The number of the run on screen."""
        self.epoch: int = 0
        """Counts how often the run has been replaced, or cut and continued differently."""
        self.log = LatestEvents()
        """The events of the run."""
        self.notices: deque[tuple[int, bytes]] = deque(maxlen=MAX_NOTICES)
        """The notices to the user, numbered, as JSON."""
        self.state_version: int = 0
        self.facts_version: int = 0

    @abstractmethod
    def state_json(self) -> bytes:
        """Returns the newest state as JSON."""

    @abstractmethod
    def facts_json(self) -> bytes:
        """Returns the facts about the session and its run as JSON."""

    def changed(self, *, facts: bool = False) -> None:
        """Signals all browsers that there is something new to send, such as other facts."""
        self.facts_version += facts
        for feed in self.feeds:
            feed.wake()


class Feed:
    """Tracks what one browser has been sent of a session, and composes its next message.

    Args:
        shown: The session.
        name: The browser's name, as other users see it.
    """

    def __init__(self, shown: Broadcast, name: str) -> None:
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
        """Continues from the events that a browser already knows, if they belong to the run on screen."""
        if (run, epoch) == (self._shown.run, self._shown.epoch) and events <= self._shown.log.next:
            self._run, self._epoch, self._next = run, epoch, events

    def wake(self) -> None:
        """Signals that there is something new to send."""
        self._changed.set()

    def cut(self, number: int) -> None:
        """Records that the events from a number on no longer exist."""
        if self._next > number:
            self._next = number
            self._cut = number if self._cut is None else min(self._cut, number)
        self._epoch = self._shown.epoch

    def reply(self, reply: bytes) -> None:
        """Queues the reply to a command or question of this browser."""
        self._replies.append(reply)
        self.wake()

    @property
    def choked(self) -> bool:
        """Whether the browser keeps asking without reading its replies."""
        return len(self._replies) > MAX_REPLIES

    async def next(self) -> bytes:
        """Waits until there is something to send, and returns the next message."""
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
        if events or first > self._next or self._cut is not None:
            update: dict[str, Any] = {"first": first, "list": [Raw(event) for event in events]}
            if self._cut is not None:
                update["cut"], self._cut = self._cut, None
            if first > self._next:
                update["missing"] = first - self._next
            message["events"] = update
            self._next = first + len(events)
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
