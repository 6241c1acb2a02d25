"""Describes a run that is to be started: its options, the worker that is given to it, and the texts that it is made from."""

from __future__ import annotations

import asyncio
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import Any

from actr3d.actr.kernel.run_limits import fresh_seed
from actr3d.actr.loading.source_text import read_source
from actr3d.errors import Actr3dError
from workbench.files import ModelFolder, file_stamp
from workbench.recorded_start import RecordedStart
from workbench.worker.messages import Loaded, Start, text_digest
from workbench.worker.workers import Worker

MAX_HELPERS = 100
"""Maximum number of helper modules that are watched."""


@dataclass(frozen=True, kw_only=True)
class RunOptions:
    """Holds the options of a run; see `Start`."""

    settings: dict[str, Any] = field(default_factory=dict[str, Any])
    """Values of parameters."""
    seed: int | str | None = None
    """None for a new random seed."""
    record: bool = True
    run: bool = False
    """Whether the run starts going at once, instead of paused."""
    repeated: RecordedStart | None = None
    """The earlier run to repeat; None for a new run of the current file."""


def start_of(path: Path, options: RunOptions, **more: Any) -> Start:
    """Returns the instructions with which a run of a model starts.

    Args:
        path: The model file.
        options: The options of the run.
        more: Other fields of `Start`, passed on unchanged.

    Raises:
        ModelFileError: If the file cannot be read.
        OSError: If the file has been removed or can no longer be read.
    """
    repeated = options.repeated
    if repeated is None:
        more["source"], more["version"] = ModelFolder.text_and_version(path)
    else:
        path = Path(repeated.file)
        more |= {"source": repeated.source, "version": text_digest(repeated.source)}
        more |= {"commands": repeated.commands, "helpers": repeated.helpers, "recorded": repeated.recording}
    seed = fresh_seed() if options.seed is None else options.seed
    return Start(path=str(path), folder=str(path.parent), settings=options.settings, seed=seed, run=options.run, **more)


def is_there(path: Path) -> bool:
    """Returns whether there is a file that can be looked at; False if its folder cannot be read, or its drive is gone."""
    try:
        return path.is_file()
    except OSError:
        return False


def digest_of_file(path: Path) -> str | None:
    """Returns the digest of the text that a file has now; None if it cannot be read. It is read again only when it has changed."""
    try:
        # Reading something other than a regular file may never end.
        return _digest(path, file_stamp(path)) if path.is_file() else None
    except (Actr3dError, OSError):
        return None


@lru_cache(maxsize=1024)
def _digest(path: Path, _: tuple[int, ...]) -> str:
    return text_digest(read_source(path))


class LaunchedRun:
    """Holds a run and its worker, from the moment the run is started, and the versions of the texts that it is made from.

    Args:
        start: What the run began with. Its helper modules, if any, are those of the earlier run that it repeats.
        worker: Its worker.
    """

    def __init__(self, start: Start, worker: Worker) -> None:
        self.start = start
        self.worker = worker
        self.over = asyncio.Event()
        """Set when the worker has ended and its last messages have been read."""
        self.stuck: dict[str, Any] | None = None
        """Where the model has kept its process busy for a while: `file`, `line`, `function`, and any `signal` that has stopped it."""
        self.unwritten = ""
        """Why its recording can no longer be written; empty if it can."""
        self._digest = text_digest(start.source)
        self._helpers: dict[Path, str] = {}
        for file, text in list(start.helpers.values())[:MAX_HELPERS]:
            self._helpers[(Path(start.folder) / file).resolve()] = text_digest(text)

    def add_helper(self, loaded: Loaded) -> None:
        """Records a helper module that the run has loaded."""
        path = Path(loaded.file).resolve()
        if path in self._helpers or len(self._helpers) < MAX_HELPERS:
            self._helpers[path] = loaded.digest

    def has_helper(self, path: Path) -> bool:
        """Returns whether a file is one of the helper modules."""
        return path.resolve() in self._helpers

    def is_stale(self, digest: str | None) -> bool:
        """Returns whether any of the files has changed, given the digest of the text that the model's file has now."""
        return digest != self._digest or any(digest_of_file(each) != then for each, then in self._helpers.items())
