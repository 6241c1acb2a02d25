"""The worker's end of its wire to the server: one thread reads, one writes, and the run waits for neither."""

from __future__ import annotations

import os
import queue
import socket
import sys
import threading
import traceback
from collections import deque
from collections.abc import Sequence
from time import perf_counter
from types import FrameType

from workbench.worker.messages import LENGTH, TO_WORKER, At, Do, Draw, Leave, Message, News, Start, State, Where, framed, whole

MOST_EVENTS = 50_000
"""So many events may wait to be sent; beyond that the oldest are left out, and the numbers tell so."""
AT_ONCE = 2_000
"""So many events go in one message."""


class Link:
    """Carries messages to the server and commands from it. Only the newest state is sent; everything else in order.

    Args:
        wire: The socket to the server.
    """

    def __init__(self, wire: socket.socket) -> None:
        self._wire = wire
        self.inbox: queue.SimpleQueue[Do | Draw | Leave] = queue.SimpleQueue()
        self._messages: deque[Message] = deque()
        self._events: deque[bytes] = deque()
        self._first = 0
        """The number of the first event that waits."""
        self._state: State | None = None
        self._something = threading.Condition()
        self._sending = False
        self._main = threading.main_thread().ident
        self.start: Start = self._read_start()
        threading.Thread(target=self._read, name="reader", daemon=True).start()
        threading.Thread(target=self._write, name="writer", daemon=True).start()

    # -- what comes

    def receive(self, timeout: float | None = None) -> Do | Draw | Leave | None:
        """Returns the next command; waits for it for so long [s], or for ever. None where there is none by then."""
        try:
            return self.inbox.get(timeout=timeout) if timeout is None or timeout > 0 else self.inbox.get_nowait()
        except queue.Empty:
            return None

    def _read_start(self) -> Start:
        message = self._next()
        assert isinstance(message, Start)
        return message

    def _next(self) -> Start | Do | Draw | Leave | Where | None:
        head = self._exactly(LENGTH)
        data = None if head is None else self._exactly(int.from_bytes(head, "big"))
        return None if data is None else TO_WORKER.decode(data)

    def _exactly(self, size: int) -> bytes | None:
        data = bytearray()
        while len(data) < size:
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
                os._exit(0)  # the server is gone; nobody is left to be told anything
            if isinstance(message, Where):
                self.post(self._where())
            elif isinstance(message, (Do, Draw, Leave)):
                self.inbox.put(message)

    def _where(self) -> At:
        """Returns where the main thread is, in the modeller's own lines."""
        frame: FrameType | None = sys._current_frames().get(self._main or 0)
        lines: list[traceback.FrameSummary] = [] if frame is None else list(traceback.extract_stack(frame))
        folder = self.start.folder + os.sep
        own = [line for line in lines if line.filename == self.start.path or line.filename.startswith(folder)]
        return At(file=whole(own[-1].filename), line=own[-1].lineno, function=whole(own[-1].name)) if own else At(file=None, line=None)

    # -- what goes

    def post(self, message: Message) -> None:
        """Sends a message, after all that came before it."""
        with self._something:
            self._messages.append(message)
            self._something.notify()

    def show(self, state: State, first: int, events: Sequence[bytes]) -> None:
        """Sends new events, whose first has this number, and the newest state, which takes the place of one that still waits."""
        with self._something:
            if not self._events:
                self._first = first
            self._events.extend(events)
            while len(self._events) > MOST_EVENTS:
                self._events.popleft()
                self._first += 1
            self._state = state
            self._something.notify()

    def cut(self, message: Message, events: int) -> None:
        """Takes back events from a number on, as the message tells."""
        with self._something:
            while self._events and self._first + len(self._events) > events:
                self._events.pop()
            self._flush_events()
            self._messages.append(message)
            self._something.notify()

    @property
    def idle(self) -> bool:
        """Whether the latest state has been sent, so that a new one is worth making."""
        return self._state is None and not self._sending

    def flush(self, timeout: float = 2.0) -> None:
        """Waits until everything is sent, but not for ever."""
        end = perf_counter() + timeout
        with self._something:
            while (self._messages or self._events or self._state is not None or self._sending) and perf_counter() < end:
                self._something.wait(0.05)

    def _flush_events(self) -> None:
        """Puts waiting events among the messages."""
        while self._events:
            some = [self._events.popleft() for _ in range(min(AT_ONCE, len(self._events)))]
            self._messages.append(News(first=self._first, events=some))
            self._first += len(some)

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
                    self._wire.sendall(framed(message))
            except OSError:
                os._exit(0)
