"""Reads recordings and runs them again, in workers: the server itself opens none of them, so that no file can block, fill or crash it."""

from __future__ import annotations

import asyncio
import shutil
import tempfile
from collections.abc import Awaitable, Callable
from io import FileIO
from pathlib import Path
from typing import Any
from weakref import WeakValueDictionary

import msgspec

from actr3d.errors import Actr3dError
from workbench.jobs import Job, StuckError, doing
from workbench.recordings import NoSuchRecordingError
from workbench.worker.messages import Start
from workbench.worker.workers import Workers

MEMORY = 2_000
"""How much memory reading a recording may take [MB]."""
MAX_READERS = 8
"""Maximum number of files made at once; others wait."""
MAX_OF_ONE = 2
"""Maximum number of those for one recording, so that a slow one does not delay others."""
MAX_REPLAYS = 2
"""Maximum number of recordings run again at once; each takes a processor."""


class ReadingError(Actr3dError):
    """A recording cannot be read, or nothing made of it."""


class BusyError(Actr3dError):
    """Too many recordings are being replayed."""


class Readers:
    """Reads recordings in workers, which write the results to files.

    Args:
        workers: The pool that starts workers.
    """

    def __init__(self, workers: Workers) -> None:
        self._workers = workers
        self._turns = asyncio.Semaphore(MAX_READERS)
        self._turns_of: WeakValueDictionary[Path, asyncio.Semaphore] = WeakValueDictionary()

    async def make(self, kind: str, *paths: Path, **options: Any) -> FileIO:
        """Returns an open file with the result; its name is deleted already, so that the file is deleted when it is closed.

        Args:
            kind: The kind of file to make, one of `workbench.exports`.
            paths: The recordings.
            options: The options of that kind of file.

        Raises:
            NoSuchRecordingError: If one of them was deleted in the meantime.
            ReadingError: If it cannot be made.
            OSError: If no file can be created, or no worker started.
        """
        turns = self._turns_of.setdefault(paths[0], asyncio.Semaphore(MAX_OF_ONE))
        async with turns, self._turns:
            folder = Path(tempfile.mkdtemp(prefix="actr3d-"))
            try:
                to = folder / "made"
                await self._made(Start(job="make", export=kind, recordings=tuple(map(str, paths)), to=str(to), settings=options))
                return to.open("rb", buffering=0)
            except ReadingError:
                if not all(path.is_file() for path in paths):
                    raise NoSuchRecordingError from None
                raise
            finally:
                shutil.rmtree(folder, ignore_errors=True)

    async def _made(self, start: Start) -> None:
        job = Job()
        async with doing(self._workers, start, job, memory=MEMORY):
            try:
                async for _ in job.stages(lambda: _size(start.to)):
                    pass
            except StuckError as error:
                raise ReadingError(str(error)) from None
        if job.result is None:
            raise ReadingError(job.problem)


def _size(path: str) -> int:
    try:
        return Path(path).stat().st_size
    except OSError:
        return 0


class Reruns:
    """The recordings that are being run again.

    Args:
        workers: The pool that starts workers.
    """

    def __init__(self, workers: Workers) -> None:
        self._workers = workers
        self._going_on: list[tuple[Path, Job]] = []

    def share(self, path: Path) -> float | None:
        """Returns the share of a recording that has been run again, from 0 to 1; None if it is not being run again."""
        return max((job.share for other, job in self._going_on if other == path), default=None)

    async def run(self, path: Path, left: Callable[[], Awaitable[bool]]) -> dict[str, Any]:
        """Returns whether every byte agrees (None if that is unknown), and the text of the comparison.

        Args:
            path: The recording.
            left: Returns whether the client has disconnected; then the replay is ended.

        Raises:
            BusyError: If too many are being replayed.
            OSError: If no worker can be started.
        """
        if len(self._going_on) >= MAX_REPLAYS:
            raise BusyError(f"{MAX_REPLAYS} recordings are already being replayed; wait for one of them, or cancel it")
        job = Job()
        self._going_on.append((path, job))
        try:
            with tempfile.TemporaryDirectory(prefix="actr3d-replay-", ignore_cleanup_errors=True) as folder:  # a model may end its worker
                async with doing(self._workers, Start(job="replay", path=str(path), to=folder), job):
                    return await _outcome(job, left)
        finally:
            self._going_on.remove((path, job))


async def _outcome(job: Job, left: Callable[[], Awaitable[bool]]) -> dict[str, Any]:
    try:
        async for _ in job.stages(lambda: job.share):
            if not job.over.is_set() and await left():
                return {"agrees": None, "text": "cancelled"}
    except StuckError as error:
        return {"agrees": None, "text": str(error)}
    return {"agrees": None, "text": f"no verdict: {job.problem}"} if job.result is None else msgspec.json.decode(job.result)
