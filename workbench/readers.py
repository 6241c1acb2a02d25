"""Reads recordings in workers: the server itself opens none of them, so that no file can block, fill or crash it."""

from __future__ import annotations

import asyncio
import shutil
import tempfile
from io import FileIO
from pathlib import Path
from typing import Any
from weakref import WeakValueDictionary

from actr3d.errors import Actr3dError
from workbench.jobs import Job, StuckError, doing
from workbench.recordings import NoSuchRecordingError
from workbench.retention import size_of
from workbench.worker.messages import Start
from workbench.worker.workers import Workers

READER_MEMORY = 2_000
"""How much memory reading a recording may take [MB]."""
MAX_READERS = 8
"""Maximum number of files that are made at once; others wait."""
MAX_OF_ONE = 2
"""Maximum number of those for one recording, so that a slow one does not delay others."""


class ReadingError(Actr3dError):
    """A recording cannot be read, or nothing made of it."""


class Readers:
    """Reads recordings in workers, which write the results to files."""

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
        async with doing(self._workers, start, job, memory=READER_MEMORY):
            try:
                async for _ in job.stages(lambda: size_of(Path(start.to))):
                    pass
            except StuckError as error:
                raise ReadingError(str(error)) from None
        if job.result is None:
            raise ReadingError(job.problem)
