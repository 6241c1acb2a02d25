"""The worker's end of its wire to the server: one thread reads, one writes, and the run waits for neither.

It is not a `multiprocessing.connection.Connection`: before each part of a message, it checks that the model has not replaced the socket.
"""

from __future__ import annotations

import os
import queue
import socket
import sys
import threading
import traceback
from collections import deque
from collections.abc import Callable, Sequence
from contextlib import suppress
from time import perf_counter
from types import FrameType
from typing import NoReturn

import msgspec

from actr3d.runner.before_exit import end_at_once
from workbench.event_log import LatestEvents
from workbench.worker.messages import (
    LENGTH,
    LONGEST,
    LONGEST_ANSWER,
    TO_WORKER,
    AskPosition,
    CommandMessage,
    Facts,
    Leave,
    Message,
    NewEvents,
    Notice,
    Position,
    Reply,
    SetOverlays,
    Start,
    State,
    framed,
    shortened,
)

WIRE_LOST = 88
"""The exit code of a worker whose model has closed the connection to the server, or has replaced it."""
MAX_MESSAGES = 1_000
"""The maximum number of messages that wait to be sent; beyond it warnings are left out."""


class Channel:
    """Carries messages to the server and commands from it.

    Only the newest state is sent; everything else is sent in order. A reply is sent after the state that was waiting before it, so
    that a page that learns of the end of a command has its effect already.

    Args:
        wire: The socket to the server.
        arrived: Called by the thread that reads, after a command has arrived.
        end: Called when the server is gone, with an exit code for the process; usually ends it. The threads of the channel end anyway.
    """

    def __init__(
        self, wire: socket.socket, *, arrived: Callable[[], object] | None = None, end: Callable[[int], object] = end_at_once
    ) -> None:
        self._wire = wire
        self._arrived = arrived
        self._end = end
        self.inbox: queue.SimpleQueue[CommandMessage | SetOverlays | Leave] = queue.SimpleQueue()
        self._messages: deque[Message] = deque()
        self._events = LatestEvents()
        """The events that wait; if there are too many, the oldest are left out, which the numbers show."""
        self._state: State | None = None
        self._something = threading.Condition()
        self._sending = False
        self._main = threading.main_thread().ident
        self.events: Callable[[], int] | None = None
        """Returns the number of events of the run, which notices carry as their place among them."""
        self.busy: Callable[[], None] | None = None
        """Sends the events of a run that sends none itself, because it is busy."""
        self.left = False
        """Whether this is a forked copy of the process, which sends the server nothing."""
        self._identity = _identity(wire)
        start = self._next()
        assert isinstance(start, Start)
        self.start = start
        threading.Thread(target=self._read, name="reader", daemon=True).start()
        threading.Thread(target=self._write, name="writer", daemon=True).start()

    # -- receiving

    def receive(self, timeout: float | None = None) -> CommandMessage | SetOverlays | Leave | None:
        """Returns the next command; None if none arrives within the timeout [s]. Without a timeout, it waits."""
        if self.left:
            _end_copy()
        try:
            return self.inbox.get(timeout=timeout) if timeout is None or timeout > 0 else self.inbox.get_nowait()
        except queue.Empty:
            return None

    def _next(self) -> Start | CommandMessage | SetOverlays | Leave | AskPosition | None:
        head = self._exactly(LENGTH)
        data = None if head is None else self._exactly(int.from_bytes(head, "big"))
        return None if data is None else TO_WORKER.decode(data)

    def _exactly(self, size: int) -> bytes | None:
        data = bytearray()
        while len(data) < size:
            self._check_wire()
            part = self._wire.recv(size - len(data))
            if not part:
                return None
            data += part
        return bytes(data)

    def _read(self) -> None:
        while True:
            try:
                message = self._next()
            except OSError:
                message = None
            if message is None:
                self._end(0)  # the server is gone
                return
            if isinstance(message, AskPosition):
                if self.busy is not None:
                    self.busy()
                self.post(self._where())
            elif isinstance(message, (CommandMessage, SetOverlays, Leave)):
                self.inbox.put(message)
                if self._arrived is not None:
                    self._arrived()

    def _where(self) -> Position:
        """Returns the position of the main thread in the modeller's own files."""
        frame: FrameType | None = sys._current_frames().get(self._main or 0)  # pyright: ignore[reportPrivateUsage] # Python documents it
        lines: list[traceback.FrameSummary] = [] if frame is None else list(traceback.extract_stack(frame))
        folder = self.start.folder + os.sep
        own = [line for line in lines if line.filename == self.start.path or line.filename.startswith(folder)]
        return (
            Position(file=shortened(own[-1].filename), line=own[-1].lineno, function=shortened(own[-1].name))
            if own
            else Position(file=None, line=None)
        )

    def _check_wire(self) -> None:
        """Ends the process if the model has closed the connection: its number may belong to another file of the model by now."""
        if _identity(self._wire) != self._identity:
            self._end(WIRE_LOST)
            raise OSError(WIRE_LOST, "the connection to the server was closed")

    # -- sending

    def post(self, message: Message) -> None:
        """Sends a message after all earlier ones; a notice is left out if very many messages wait."""
        if isinstance(message, Notice) and self.events is not None:
            message = msgspec.structs.replace(message, events=0 if message.unwritten else self.events())
        with self._something:
            if isinstance(message, Notice) and len(self._messages) >= MAX_MESSAGES and message.level != "error":
                return
            if isinstance(message, (Reply, Position, Facts)) and self._state is not None:
                self._flush_events()
                self._messages.append(self._state)
                self._state = None
            self._messages.append(message)
            self._something.notify()

    def show(self, state: State, first: int, events: Sequence[bytes]) -> None:
        """Sends new events, the first of which has this number, and the newest state, which replaces one that still waits."""
        with self._something:
            self._events.add(first, events)
            self._state = state
            self._something.notify()

    def send_events(self, first: int, events: Sequence[bytes]) -> None:
        """Sends new events, the first of which has this number, without a state."""
        with self._something:
            self._events.add(first, events)
            self._something.notify()

    def cut(self, message: Message, events: int) -> None:
        """Withdraws events from a number on, and sends the message that says so."""
        with self._something:
            self._events.cut(events)
            self._flush_events()
            self._messages.append(message)
            self._something.notify()

    @property
    def idle(self) -> bool:
        """Whether the latest state has been sent, so that a new one is worth making."""
        return self._state is None and not self._messages and not self._sending

    def leave(self) -> None:
        """Closes the connection in a copy of the process that the model has forked."""
        if not self.left:  # else it is a copy of a copy
            self.left = True
            self._something = threading.Condition()  # another thread of the model's process may have held it
            is_same = _identity(self._wire) == self._identity
            number = self._wire.detach()
            if is_same:
                os.close(number)

    def flush(self, timeout: float = 2.0) -> None:
        """Waits until everything is sent, at most for the timeout [s]."""
        if self.left:
            _end_copy()
        end = perf_counter() + timeout
        with self._something:
            while (self._messages or self._events or self._state is not None or self._sending) and perf_counter() < end:
                self._something.wait(0.05)

    def _flush_events(self) -> None:
        """Puts waiting events among the messages."""
        while self._events:
            first, some = self._events.since(self._events.first)
            self._messages.append(NewEvents(first=first, events=some))
            self._events.drop(first + len(some))

    def _write(self) -> None:
        while True:
            with self._something:
                self._sending = False
                self._something.notify_all()
                while not (self._messages or self._events or self._state is not None):
                    self._something.wait()
                self._flush_events()
                messages = list(self._messages)
                self._messages.clear()
                if self._state is not None:
                    messages.append(self._state)
                    self._state = None
                self._sending = True
            try:
                for message in messages:
                    self._check_wire()
                    self._wire.sendall(_bounded(message))
            except OSError:
                self._end(0)
                return


def _end_copy() -> NoReturn:
    """Ends a copy of the process that the model has forked: the run continues in one process only."""
    with suppress(OSError, ValueError):
        sys.stdout.flush()
    end_at_once(0)


def _identity(wire: socket.socket) -> tuple[int, int] | None:
    """Returns what identifies an open file; None if it is closed."""
    try:
        status = os.fstat(wire.fileno())
    except OSError:
        return None
    return status.st_dev, status.st_ino


def _bounded(message: Message) -> bytes:
    """Returns a message in the form in which it is sent; a message that is too long is replaced by one that says so."""
    if isinstance(message, Reply) and len(message.result) > LONGEST_ANSWER:
        return framed(Reply(id=message.id, error=f"the answer is too long ({len(message.result):,} bytes); ask for less"))
    data = framed(message)
    if len(data) > LONGEST:
        return framed(Notice(level="error", text=f"a message about this run is too long ({len(data):,} bytes)"))
    return data
