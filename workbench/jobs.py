"""What a worker is needed for that is no run: it does one thing, and ends."""

from __future__ import annotations

import asyncio
from collections import deque
from collections.abc import AsyncGenerator, Callable
from contextlib import asynccontextmanager, suppress

from actr3d.errors import Actr3dError
from workbench.client_feed import MOST_NOTICES
from workbench.worker.messages import FromWorker, Notice, Reply, Share, Start
from workbench.worker.workers import Worker, Workers
from workbench.worker_monitor import WorkerMonitor, subject_of

PATIENCE = 120.0
"""Maximum time without progress before a worker is ended [s]."""
LOOK = 0.25
"""How often it is looked how far it has come [s]."""


class StuckError(Actr3dError):
    """A worker comes no further."""

    status = 409


class Job:
    """One thing that a worker does, as far as it has come."""

    def __init__(self) -> None:
        self.share = 0.0
        """How much is done, from 0 to 1."""
        self.result: bytes | None = None
        """What came of it, as JSON; None where nothing did, or not yet."""
        self.notices: deque[Notice] = deque(maxlen=MOST_NOTICES)
        """What the worker complained of."""
        self.subject = "the worker"
        """What the worker is called."""
        self.ending = ""
        """How the worker ended, where that was not in good order."""
        self.over = asyncio.Event()

    async def stages(self, stage: Callable[[], float]) -> AsyncGenerator[float]:
        """Yields again and again how far the worker has come, until it is over.

        Args:
            stage: Returns how far the worker is.

        Raises:
            StuckError: If it comes no further.
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
                raise StuckError(f"it came no further for {PATIENCE:g} s")
            yield furthest

    @property
    def problem(self) -> str:
        """Why nothing came of it."""
        errors = [notice.text for notice in self.notices if notice.level == "error"]
        return errors[-1] if errors else self.ending or f"{self.subject} has ended"

    def take(self, worker: Worker, start: Start, message: FromWorker) -> None:
        """Takes what the worker says."""
        if isinstance(message, Share):
            self.share = message.done
        elif isinstance(message, Reply):
            self.reply(message)
        elif isinstance(message, Notice):
            self.add_notice(message)

    def reply(self, message: Reply) -> None:
        """Takes what came of it, or why nothing did."""
        if message.error is None:
            self.result = message.result
        else:
            self.notices.append(Notice(level="error", text=message.error))

    def take_end(self, worker: Worker, ending: str) -> None:
        """Takes how the worker ended."""
        self.ending = ending
        self.over.set()

    def add_notice(self, notice: Notice) -> None:
        """Takes what the worker complains of."""
        if notice.level != "info":  # what is printed is of no interest
            self.notices.append(notice)

    def halt(self, worker: Worker, name: str) -> None:
        """Ends a worker that was stopped by a signal: nothing would continue it."""
        if name:
            self.add_notice(Notice(level="error", text=f"{self.subject} was stopped by {name}, and ended"))
            worker.kill()

    def busy(self, worker: Worker) -> bool:
        """Ignores where the worker is: no user watches a job."""
        return False


@asynccontextmanager
async def doing(workers: Workers, start: Start, job: Job | None = None, memory: int | None = None) -> AsyncGenerator[Job]:
    """Has a worker do something inside the block, and kills it at the end of the block if it is not done.

    Args:
        workers: Who gives workers.
        start: The first message to the worker.
        job: Where it is noted how far it has come; None for a new one.
        memory: How much memory it may take [MB]; None for as much as a model may.

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
