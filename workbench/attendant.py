"""Attends to one worker: takes what it says and prints, asks where it is when it is silent, and tells how it ended."""

from __future__ import annotations

import asyncio
import signal
import time
from typing import Protocol

import msgspec

from workbench.worker.link import WIRE_LOST
from workbench.worker.memory import TOO_MUCH_MEMORY
from workbench.worker.messages import At, FromWorker, Notice, Over, Start, Where, notice
from workbench.worker.workers import LOST, PRINTED, Worker

SILENT = 1.0
"""A worker that is busy and says nothing for so long [s] is asked where it is."""
SPEECHLESS = 2.5
"""One that does not tell so long after it was last heard [s] is busy in compiled code, which lets nothing else happen in its process."""
LAST_WORDS = 1.0
"""So long what a worker has said is still read after its end [s]."""
MOST_PRINTED = 200
"""So many lines that a worker prints past its model's `print` are told of; the rest is left out."""


_MEANINGS = {
    "SIGKILL": ", which it sent itself, or another program did, or the system for want of memory",
    "SIGSEGV": ": a crash in compiled code",
}
"""What is told of signals."""


class Told(Protocol):
    """Who is told of it."""

    def take(self, worker: Worker, start: Start, message: FromWorker) -> None:
        """Takes what a worker says."""
        ...

    def take_end(self, worker: Worker, ending: str) -> None:
        """Takes how a worker ended; nothing where it was in good order."""
        ...

    def tell(self, notice: Notice) -> None:
        """Tells the user something."""
        ...

    def busy(self, worker: Worker) -> bool:
        """Tells whether a worker is to be saying something."""
        ...

    def halt(self, worker: Worker, name: str) -> None:
        """Takes note that a signal of this name has stopped a worker, so that it stands still; no name: that it goes on."""
        ...


class Attendant:
    """Attends to one worker, until it is gone.

    Args:
        worker: The worker.
        start: What it is told to do.
        told: Who is told of it.
    """

    def __init__(self, worker: Worker, start: Start, told: Told) -> None:
        self._worker = worker
        self._start = start
        self._told = told
        self._heard = time.monotonic()
        self._given_up = 0.0
        """When the worker was heard last before it could not even tell where it is."""

    async def serve(self) -> None:
        """Lets the worker begin, takes what it says, and tells how it ended."""
        worker = self._worker
        worker.send(self._start)
        printing = asyncio.create_task(self._print())
        watching = asyncio.create_task(self._watch())
        try:
            over = await self._hear_out()
            if not over:
                await worker.stop()
            status = await asyncio.shield(worker.exit)  # who waits may be cancelled, the worker not
            worker.kill()  # and what it has started
            await asyncio.wait([printing], timeout=1)
            self._told.take_end(worker, "" if over else _why(status, subject_of(self._start)))
        finally:
            printing.cancel()
            watching.cancel()
            worker.release()

    async def _hear_out(self) -> bool:
        """Takes what the worker says, until it is gone, even where others hold its wire; tells whether it ends in good order."""
        listening = asyncio.create_task(self._listen())
        try:
            await asyncio.wait([listening, self._worker.exit], return_when=asyncio.FIRST_COMPLETED)
            await asyncio.wait([listening], timeout=LAST_WORDS)
        finally:
            listening.cancel()
        await asyncio.wait([listening])
        return not listening.cancelled() and listening.result()

    async def _listen(self) -> bool:
        """Takes what the worker says; tells whether it ends in good order."""
        over = False
        try:
            while (message := await self._worker.receive()) is not None:
                self._heard = time.monotonic()
                over |= isinstance(message, Over)
                self._told.take(self._worker, self._start, message)
        except (ValueError, msgspec.MsgspecError) as error:
            self._told.tell(notice("error", f"the worker said what nobody understands, and was ended ({error})"))
        return over

    async def _print(self) -> None:
        """Tells what the worker prints past its model's `print`."""
        output, count = self._worker.output, 0
        while count < MOST_PRINTED:
            try:
                line = await output.readline()
            except ValueError:  # a line that is longer than the stream takes
                continue
            if not line:
                return
            count += 1
            text = line.decode(errors="replace").rstrip()
            if text:
                self._told.tell(notice("info", text))
        if await output.read(PRINTED):
            self._told.tell(notice("warning", "the model's process prints much more; that is left out"))
            while await output.read(PRINTED):
                pass

    async def _watch(self) -> None:
        """Asks the worker where it is when it is busy and says nothing."""
        since: float | None = None
        halted = 0
        while True:
            await asyncio.sleep(SILENT / 4)
            if self._worker.halted != halted:
                halted, since = self._worker.halted, None
                self._told.halt(self._worker, _name_of(halted) if halted else "")
            if halted:
                self._heard = time.monotonic()
                continue
            now = time.monotonic()
            since = (since or now) if self._told.busy(self._worker) else None
            if since is None:
                continue
            silent = now - max(since, self._heard)
            if silent > SILENT:
                self._worker.send(Where())
            if silent > SPEECHLESS and self._given_up != self._heard:
                self._given_up = self._heard
                self._told.take(self._worker, self._start, At(file=None, line=None))


def subject_of(start: Start) -> str:
    """Returns what a process that does this is called."""
    return "the process that read it" if start.job in ("make", "list") else "the model's process"


def _why(status: int, subject: str) -> str:
    """Says how a process ended that nobody has asked to end.

    Args:
        status: Its exit code, or the negative number of a signal.
        subject: What it is called.
    """
    if status == LOST:
        return "the process from which all models' processes come was ended, and all runs with it; begin again"
    if status == WIRE_LOST:
        return "the model closed the connection of its process to the workbench: it may close only files that it has opened itself"
    if status == TOO_MUCH_MEMORY:
        return f"{subject} was ended: it used more memory than it may"
    if status >= 0:
        return f"{subject} ended with exit code {status}"
    name = _name_of(-status)
    return f"{subject} was ended by {name}{_MEANINGS.get(name, '')}"


def _name_of(number: int) -> str:
    """Returns the name of a signal."""
    return signal.Signals(number).name if number in set(signal.Signals) else f"signal {number}"
