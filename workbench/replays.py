"""Runs recordings again, each in a worker of its own."""

from __future__ import annotations

import tempfile
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import Any

import msgspec

from actr3d.errors import Actr3dError
from workbench.jobs import Job, StuckError, doing
from workbench.worker.messages import Start
from workbench.worker.workers import Workers

MOST = 2
"""Maximum number of recordings run again at once; each takes a processor."""


class BusyError(Actr3dError):
    """Enough recordings are run again already."""

    status = 409


class Reruns:
    """The recordings that are being run again.

    Args:
        workers: Who gives workers.
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
            BusyError: If enough are run again already.
            OSError: If no worker can be started.
        """
        if len(self._going_on) >= MOST:
            raise BusyError(f"{MOST} recordings are run again already; wait for one of them, or cancel it")
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
