"""Asks the process that answers questions about texts, one question at a time; replaces it if it is stuck or has ended."""

from __future__ import annotations

import asyncio
from contextlib import suppress
from pathlib import Path

from workbench.language.answers import LanguageError
from workbench.worker.messages import CommandMessage, FromWorker, Notice, Reply, Start
from workbench.worker.workers import Worker, Workers
from workbench.worker_monitor import Receiver, WorkerMonitor

ANSWER_TIME = 10.0
"""Maximum time for an answer [s]; then the process is ended."""
START_TIME = 30.0
"""Maximum time for the first answer of a process, which loads what it needs [s]."""
LANGUAGE_MEMORY = 1_500
"""Maximum memory of the process [MB], if that of a model is not less."""
MAX_WAITING = 20
"""Maximum number of questions that wait for their turn."""


class TooManyQuestionsError(LanguageError):
    """Too many questions wait already."""


class LanguageServer(Receiver):
    """Answers questions about texts, by a process of its own with limits of time and memory."""

    def __init__(self, workers: Workers, folder: Path) -> None:
        self._workers = workers
        self._start = Start(job="language", folder=str(folder))
        self._turn = asyncio.Lock()
        self._waiting = 0
        self._worker: Worker | None = None
        self._serving: asyncio.Task[None] | None = None
        self._number = 0
        self._reply: asyncio.Future[Reply] | None = None

    async def ask(self, question: bytes) -> bytes:
        """Returns the answer to a `LanguageQuestion`, both as JSON.

        Raises:
            LanguageError: If there is no answer, or not in time.
            OSError: If no process can be started.
        """
        if self._waiting >= MAX_WAITING:
            raise TooManyQuestionsError("too many questions about texts wait already")
        self._waiting += 1
        try:
            async with self._turn:
                reply = await self._ask(question)
        finally:
            self._waiting -= 1
        if reply.error is not None:
            raise LanguageError(reply.error, line=reply.line)
        return reply.result

    async def _ask(self, question: bytes) -> Reply:
        worker, limit = self._worker, ANSWER_TIME
        if worker is None:
            limit = START_TIME
            worker = self._worker = await self._workers.launch(min(LANGUAGE_MEMORY, self._workers.memory or LANGUAGE_MEMORY))
            self._serving = asyncio.create_task(WorkerMonitor(worker, self._start, self).serve())
            await asyncio.sleep(0)  # it sends the start, which comes first
        self._number += 1
        self._reply = asyncio.get_running_loop().create_future()
        worker.send(CommandMessage(id=self._number, command=question))
        try:
            return await asyncio.wait_for(self._reply, limit)
        except TimeoutError:
            self._end(worker)
            raise LanguageError(f"reading this text takes longer than {limit:g} s") from None

    def _end(self, worker: Worker) -> None:
        """Kills the process; the next question starts another."""
        worker.kill()
        if self._worker is worker:
            self._worker = None

    async def close(self) -> None:
        """Ends the process."""
        if self._worker is not None:
            self._end(self._worker)
        if self._serving is not None:
            with suppress(asyncio.CancelledError):
                await self._serving

    # -- what the process sends

    def take(self, worker: Worker, start: Start, message: FromWorker) -> None:
        """Delivers an answer, unless nobody waits for it any more."""
        if isinstance(message, Reply) and message.id == self._number and self._reply is not None and not self._reply.done():
            self._reply.set_result(message)

    def take_end(self, worker: Worker, ending: str) -> None:
        """Answers the present question with an error, as the process has ended."""
        if self._worker is worker:
            self._worker = None
            self.take(worker, self._start, Reply(id=self._number, error=f"this text cannot be read: {ending or 'the process has ended'}"))

    def add_notice(self, notice: Notice) -> None:
        """Ignores what the process prints."""

    def halt(self, worker: Worker, name: str) -> None:
        """Ends a process that was stopped by a signal: nothing would continue it."""
        if name:
            self._end(worker)
