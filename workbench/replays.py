"""Replays recordings in workers, and compares each replay with its recording."""

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

MAX_REPLAYS = 2
"""Maximum number of recordings that are replayed at once; each takes a processor."""


class BusyError(Actr3dError):
    """Too many recordings are being replayed."""


class Replays:
    """The recordings that are being replayed."""

    def __init__(self, workers: Workers) -> None:
        self._workers = workers
        self._running: list[tuple[Path, Job]] = []

    def share(self, path: Path) -> float | None:
        """Returns the share of a recording that has been replayed, from 0 to 1; None if it is not being replayed."""
        return max((job.share for other, job in self._running if other == path), default=None)

    async def run(self, path: Path, is_disconnected: Callable[[], Awaitable[bool]]) -> dict[str, Any]:
        """Returns the `verdict` and a `text`: what was compared, where it differs, or why there is no verdict.

        The verdict is "agrees" if every byte agrees; "agrees up to its end" if every byte of a recording agrees that does not go to the end
        of its run; "differs"; or None if it is unknown.

        Args:
            path: The recording.
            is_disconnected: Returns whether the client has disconnected; then the replay is ended.

        Raises:
            BusyError: If too many are being replayed.
            OSError: If no worker can be started.
        """
        if len(self._running) >= MAX_REPLAYS:
            raise BusyError(f"{MAX_REPLAYS} recordings are already being replayed; wait for one of them, or cancel it")
        job = Job()
        self._running.append((path, job))
        try:
            with tempfile.TemporaryDirectory(prefix="actr3d-replay-", ignore_cleanup_errors=True) as folder:  # a model may end its worker
                async with doing(self._workers, Start(job="replay", path=str(path), to=folder), job):
                    return await _outcome(job, is_disconnected)
        finally:
            self._running.remove((path, job))


async def _outcome(job: Job, is_disconnected: Callable[[], Awaitable[bool]]) -> dict[str, Any]:
    try:
        async for _ in job.stages(lambda: job.share):
            if not job.over.is_set() and await is_disconnected():
                return {"verdict": None, "text": "cancelled"}
    except StuckError as error:
        return {"verdict": None, "text": str(error)}
    return {"verdict": None, "text": f"no verdict: {job.problem}"} if job.result is None else msgspec.json.decode(job.result)
