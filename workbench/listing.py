"""Lists summaries of recordings: workers read each file once, and again only when it has changed."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path

import msgspec

from workbench.files import database_stamp
from workbench.jobs import Job, doing
from workbench.readers import READER_MEMORY
from workbench.recording_index import Summary, unreadable
from workbench.recordings import NoSuchRecordingError, Recordings
from workbench.worker.messages import Reply, Start
from workbench.worker.workers import Workers

MAX_LISTED = 1_000
"""Maximum number of recordings in one list."""
LONGEST = 10.0
"""Maximum time to read one summary [s]."""
MAX_READERS = 4
"""Maximum number of workers that read summaries at the same time."""
_Stamp = tuple[int, ...]
"""See `database_stamp`."""


class Listing:
    """Reads summaries of recordings and caches them until their files change."""

    def __init__(self, recordings: Recordings, workers: Workers, models: Path) -> None:
        self._recordings = recordings
        self._workers = workers
        self._models = models
        self._known: dict[str, tuple[_Stamp, Summary]] = {}
        self._coming: dict[tuple[str, _Stamp], asyncio.Future[Summary]] = {}
        """The summaries that are being read; all who ask for one in the same state of its file wait for the same result."""
        self._turns = asyncio.Semaphore(MAX_READERS)
        self._tasks: set[asyncio.Task[None]] = set()

    async def some(self, first: int = 0, most: int = MAX_LISTED) -> tuple[int, list[Summary]]:
        """Returns how many recordings there are, and the summaries of some, newest first, including files that cannot be read.

        Args:
            first: How many of the newest are skipped.
            most: Maximum number of summaries.

        Raises:
            OSError: If no worker can be started.
        """
        paths = await asyncio.to_thread(self._recordings.all)
        names = {path.name for path in paths}
        self._known = {name: known for name, known in self._known.items() if name in names}
        found = await self._of(paths[first : first + most])
        there = [summary for path, summary in found if summary.problem is None or path.is_file()]
        return len(paths) - len(found) + len(there), there

    async def one(self, name: str) -> Summary:
        """Returns the summary of a recording.

        Raises:
            NoSuchRecordingError: If there is no recording of that name.
            OSError: If no worker can be started.
        """
        path = self._recordings.path(name)
        ((_, summary),) = await self._of([path])
        if summary.problem is not None and not path.is_file():
            raise NoSuchRecordingError
        return summary

    async def _of(self, paths: Sequence[Path]) -> list[tuple[Path, Summary]]:
        stamps = await asyncio.to_thread(lambda: {path: database_stamp(path) for path in paths})
        there: dict[Path, Summary] = {}
        fresh: list[Path] = []
        for path, stamp in stamps.items():
            known = self._known.get(path.name)
            if known is not None and known[0] == stamp:
                there[path] = known[1]
            elif (path.name, stamp) not in self._coming:
                self._coming[path.name, stamp] = asyncio.get_running_loop().create_future()
                fresh.append(path)
        waiting = {path: self._coming[path.name, stamps[path]] for path in paths if path not in there}
        if fresh:
            task = asyncio.create_task(self._read(fresh, stamps))
            self._tasks.add(task)
            task.add_done_callback(self._tasks.discard)
        for path, coming in waiting.items():
            there[path] = await asyncio.shield(coming)
        return [(path, there[path]) for path in paths]

    async def _read(self, paths: list[Path], stamps: dict[Path, _Stamp]) -> None:
        """Reads summaries; if a file takes too long or crashes the worker, another worker continues with the next file."""

        def found(path: Path, summary: Summary) -> None:
            self._known[path.name] = stamps[path], summary
            self._coming.pop((path.name, stamps[path])).set_result(summary)

        left = list(paths)
        try:
            async with self._turns:
                while left:
                    reading = _Reading(left, found)
                    start = Start(job="list", folder=str(self._models), recordings=tuple(map(str, left)))
                    async with doing(self._workers, start, reading, memory=READER_MEMORY):
                        await reading.end()
                    left = left[reading.count :]
                    if left:
                        slow = f"it takes longer than {LONGEST:g} s to read"
                        found(left[0], unreadable(left[0], reading.problem if reading.over_by_itself else slow))
                        del left[0]
        except Exception as error:  # noqa: BLE001 - passed on to those who wait
            self._give_up([(path.name, stamps[path]) for path in left], error)
        except asyncio.CancelledError:
            self._give_up([(path.name, stamps[path]) for path in left], OSError("the workbench ends"))
            raise

    def _give_up(self, unread: Sequence[tuple[str, _Stamp]], error: Exception) -> None:
        """Passes an error on to those who wait for these summaries."""
        for key in unread:
            coming = self._coming.pop(key, None)
            if coming is not None:
                coming.set_exception(error)
                coming.exception()  # marks it as retrieved, as nobody may wait for it any more


class _Reading(Job):
    """Collects the summaries that one worker reads."""

    def __init__(self, paths: Sequence[Path], found: Callable[[Path, Summary], None]) -> None:
        super().__init__()
        self.count = 0
        """How many summaries have arrived."""
        self.over_by_itself = False
        self._paths = paths
        self._found = found

    def reply(self, message: Reply) -> None:
        """Stores the summary in a reply."""
        path = self._paths[self.count]
        self.count += 1
        error = message.error
        self._found(path, unreadable(path, error) if error is not None else msgspec.json.decode(message.result, type=Summary))

    async def end(self) -> None:
        """Waits until the worker has ended, or has taken too long for one file."""
        count = -1
        while not self.over_by_itself and count != self.count:
            count = self.count
            with suppress(TimeoutError):
                await asyncio.wait_for(self.over.wait(), LONGEST)
                self.over_by_itself = True
