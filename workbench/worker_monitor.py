"""Monitors one worker process: receives its messages and its output, asks for its position when it is silent, and reports how it ended."""

from __future__ import annotations

import asyncio
import logging
import time
from abc import ABC, abstractmethod

import msgspec

from actr3d.runner.before_exit import signal_name
from workbench.worker.channel import WIRE_LOST
from workbench.worker.memory import TOO_MUCH_MEMORY
from workbench.worker.messages import MAX_PRINTED, AskPosition, FromWorker, Notice, Position, Start, WorkerEnded, notice
from workbench.worker.workers import LOST, PRINTED, Worker

SILENT = 1.0
"""A busy worker that sends nothing for this long [s] is asked which line it is at."""
SPEECHLESS = 2.5
"""A worker that does not answer for this long after its last message [s] is busy in compiled code, which blocks its whole process."""
LAST_WORDS = 1.0
"""How long messages of a worker are still read after it has ended [s]."""

_MEANINGS = {
    "SIGKILL": ", sent by itself, by another program, or by the system when memory ran out",
    "SIGSEGV": ": a crash in compiled code",
}
"""Explanations of signals, added to their names."""


class Receiver(ABC):
    """Base of what a monitor reports to: a session, or a job without one (see `workbench.jobs`)."""

    @abstractmethod
    def take(self, worker: Worker, start: Start, message: FromWorker) -> None:
        """Handles a message from a worker."""

    @abstractmethod
    def take_end(self, worker: Worker, ending: str) -> None:
        """Handles the end of a worker; `ending` is empty if it ended normally."""

    @abstractmethod
    def add_notice(self, notice: Notice) -> None:
        """Sends a notice to the user."""

    def busy(self, worker: Worker) -> bool:
        """Returns whether a user waits for messages of a worker, so that silence is reported; False unless a subclass says so."""
        return False

    @abstractmethod
    def halt(self, worker: Worker, name: str) -> None:
        """Records that a signal with this name has stopped (paused) a worker; an empty name means that it runs again."""


class WorkerMonitor:
    """Monitors one worker until it has ended."""

    def __init__(self, worker: Worker, start: Start, receiver: Receiver) -> None:
        self._worker = worker
        self._start = start
        self._receiver = receiver
        self._heard = time.monotonic()
        self._given_up = 0.0
        """The arrival of the last message before the worker did not even answer `AskPosition`; each such silence is reported once."""

    async def serve(self) -> None:
        """Starts the worker's job, passes on its messages, and reports how it ended, or that it was ended because serving it failed."""
        worker, tasks = self._worker, list[asyncio.Task[None]]()
        try:
            worker.send(self._start)
            printing = asyncio.create_task(self._print())
            tasks += (printing, asyncio.create_task(self._watch()))
            over = await self._hear_out()
            if not over:
                await worker.stop()
            status = await asyncio.shield(worker.exit)  # the awaiting task may be cancelled, the worker must not be
            worker.kill()  # and the processes that it has started
            await asyncio.wait([printing], timeout=1)
            ending = "" if over else _why(status, subject_of(self._start))
        except Exception as error:
            logging.getLogger("workbench").exception("a worker could not be served")
            worker.kill()
            ending = f"{subject_of(self._start)} was ended by an error of the workbench itself: {type(error).__name__}: {error}"
        finally:
            for task in tasks:
                task.cancel()
            worker.release()
        self._receiver.take_end(worker, ending)

    async def _hear_out(self) -> bool:
        """Receives messages until the worker has ended, even if other processes hold its connection open.

        Returns:
            Whether it ended normally.
        """
        listening = asyncio.create_task(self._listen())
        try:
            await asyncio.wait([listening, self._worker.exit], return_when=asyncio.FIRST_COMPLETED)
            await asyncio.wait([listening], timeout=LAST_WORDS)
        finally:
            listening.cancel()
        await asyncio.wait([listening])
        return not listening.cancelled() and listening.result()

    async def _listen(self) -> bool:
        """Receives messages until the connection ends; returns whether the worker ended normally."""
        over = False
        try:
            while (message := await self._worker.receive()) is not None:
                self._heard = time.monotonic()
                over |= isinstance(message, WorkerEnded)
                self._receiver.take(self._worker, self._start, message)
        except (ValueError, msgspec.MsgspecError) as error:
            self._receiver.add_notice(notice("error", f"the worker sent a malformed message and was ended ({error})"))
        return over

    async def _print(self) -> None:
        """Shows what the worker prints other than by its model's `print`."""
        output, count = self._worker.output, 0
        while count < MAX_PRINTED:
            try:
                line = await output.readline()
            except ValueError:  # a line longer than the stream's limit
                continue
            if not line:
                return
            count += 1
            text = line.decode(errors="replace").rstrip()
            if text:
                self._receiver.add_notice(notice("info", text))
        if await output.read(PRINTED):
            self._receiver.add_notice(notice("warning", "the model's process prints much more, which is omitted"))
            while await output.read(PRINTED):
                pass

    async def _watch(self) -> None:
        """Asks a busy worker that sends nothing which line it is at."""
        since: float | None = None
        halted = 0
        while True:
            await asyncio.sleep(SILENT / 4)
            if self._worker.halted != halted:
                halted, since = self._worker.halted, None
                self._receiver.halt(self._worker, signal_name(halted) if halted else "")
            if halted:
                self._heard = time.monotonic()
                continue
            now = time.monotonic()
            since = (since or now) if self._receiver.busy(self._worker) else None
            if since is None:
                continue
            silent = now - max(since, self._heard)
            if silent > SILENT:
                self._worker.send(AskPosition())
            if silent > SPEECHLESS and self._given_up != self._heard:
                self._given_up = self._heard
                self._receiver.take(self._worker, self._start, Position(file=None, line=None))


def subject_of(start: Start) -> str:
    """Returns a name for the process that does this job, for messages to users."""
    return "the process that read it" if start.job in ("make", "list", "language") else "the model's process"


def _why(status: int, subject: str) -> str:
    """Returns why a process ended that was not asked to end.

    Args:
        status: Its exit code, or the negative number of a signal.
        subject: The name of the process in the message.
    """
    if status == LOST:
        return "the process that starts all models has ended, and all runs with it; restart them"
    if status == WIRE_LOST:
        return "the model closed the connection of its process to the workbench: it may close only files that it has opened itself"
    if status == TOO_MUCH_MEMORY:
        return f"{subject} was ended: it used more memory than it may"
    if status >= 0:
        return f"{subject} ended with exit code {status}"
    name = signal_name(-status)
    return f"{subject} was ended by {name}{_MEANINGS.get(name, '')}; what it printed or recorded last may be missing"
