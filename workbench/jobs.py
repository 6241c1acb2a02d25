"""Runs jobs in workers: a job, such as writing a CSV file of a recording, is a worker's only task."""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import AsyncGenerator, Callable
from contextlib import asynccontextmanager, suppress

from actr3d.errors import Actr3dError
from workbench.client_feed import MAX_NOTICES
from workbench.worker.messages import FromWorker, Notice, Reply, Share, Start
from workbench.worker.workers import Worker, Workers
from workbench.worker_monitor import Receiver, WorkerMonitor, subject_of

PATIENCE = 120.0
"""Maximum time without progress before a worker is ended [s]."""
LOOK = 0.25
"""The interval at which progress is checked [s]."""


class StuckError(Actr3dError):
    """A worker makes no progress."""


class Job(Receiver):
    """Tracks the progress and the result of one job."""

    def __init__(self) -> None:
        self.share = 0.0
        """The share that is done, from 0 to 1."""
        self.result: bytes | None = None
        """The result as JSON; None if there is none, or none yet."""
        self.notices: deque[Notice] = deque(maxlen=MAX_NOTICES)
        """The warnings and errors that the worker has sent."""
        self.subject = "the worker"
        """The name of the worker in error messages."""
        self.ending = ""
        """Why the worker ended, if it did not end normally."""
        self.over = asyncio.Event()

    async def stages(self, stage: Callable[[], float]) -> AsyncGenerator[float]:
        """Yields the progress of the worker repeatedly until the job is over.

        Raises:
            StuckError: If there is no progress for `PATIENCE`.
        """
        loop = asyncio.get_running_loop()
        furthest, since = stage(), loop.time()
        while not self.over.is_set():
            with suppress(TimeoutError):
                await asyncio.wait_for(self.over.wait(), LOOK)
            now = stage()
            if now > furthest:
                furthest, since = now, loop.time()
            elif loop.time() - since > PATIENCE:
                raise StuckError(f"no progress for {PATIENCE:g} s")
            yield furthest

    @property
    def problem(self) -> str:
        """Why the job failed."""
        errors = [notice.text for notice in self.notices if notice.level == "error"]
        return errors[-1] if errors else self.ending or f"{self.subject} has ended"

    def take(self, worker: Worker, start: Start, message: FromWorker) -> None:
        if isinstance(message, Share):
            self.share = message.done
        elif isinstance(message, Reply):
            self.reply(message)
        elif isinstance(message, Notice):
            self.add_notice(message)

    def reply(self, message: Reply) -> None:
        """Stores the result, or the error."""
        if message.error is None:
            self.result = message.result
        else:
            self.notices.append(Notice(level="error", text=message.error))

    def take_end(self, worker: Worker, ending: str) -> None:
        """Stores why the worker ended, and marks the job as over."""
        self.ending = ending
        self.over.set()

    def add_notice(self, notice: Notice) -> None:
        """Stores a warning or an error; what is printed is ignored."""
        if notice.level != "info":
            self.notices.append(notice)

    def halt(self, worker: Worker, name: str) -> None:
        """Kills a worker that was stopped by a signal: nothing would continue it."""
        if name:
            self.add_notice(Notice(level="error", text=f"{self.subject} was stopped by {name}, and ended"))
            worker.kill()


@asynccontextmanager
async def doing(workers: Workers, start: Start, job: Job | None = None, memory: int | None = None) -> AsyncGenerator[Job]:
    """Runs a job in a worker inside the block; kills the worker at the end of the block if it is not done.

    Args:
        workers: The pool that starts workers.
        start: The first message to the worker.
        job: The job that tracks the progress; None for a new one.
        memory: The maximum memory of the worker [MB]; None for that of a model.

    Raises:
        OSError: If no worker can be started.
    """
    noted = job or Job()
    noted.subject = subject_of(start)
    worker = await workers.launch(memory)
    serving = asyncio.create_task(WorkerMonitor(worker, start, noted).serve())
    try:
        yield noted
    finally:
        if not noted.over.is_set():
            worker.kill()
        await serving
