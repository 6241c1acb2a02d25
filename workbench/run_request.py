"""Describes a run that is to be started: the options it starts with, and the worker that is given to it."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from actr3d.actr.kernel.run_limits import fresh_seed
from actr3d.actr.loading.source_text import read_source
from workbench.files import ModelFolder
from workbench.source_versions import SourceVersions
from workbench.worker.messages import Start, digest_of
from workbench.worker.workers import Worker


@dataclass(frozen=True, kw_only=True)
class RepeatedRun:
    """Describes an earlier run that is to be repeated."""

    file: str
    """The path of the model file at that time; it is not read."""
    source: str
    """The model's text at that time."""
    commands: list[tuple[int, int, dict[str, Any]]]
    """The commands of users, which are applied again: the run, the tick after which each was given, and the command."""
    recording: Path
    """The recording of the run."""
    helpers: dict[str, tuple[str, str]]
    """Its helper modules, as `actr3d.actr.loading.helper_modules` keeps them."""


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
    repeated: RepeatedRun | None = None
    """The earlier run to repeat; None for a new run of the current file."""


def start_of(path: Path, options: RunOptions, **more: Any) -> Start:
    """Returns the instructions with which a run of a model starts.

    Args:
        path: The model file.
        options: The options of the run.
        more: Other fields of `Start`, passed on unchanged.

    Raises:
        ModelFileError: If the file cannot be read.
        OSError: If the file has been removed or cannot be read any more.
    """
    repeated = options.repeated
    if repeated is None:
        more |= {"source": read_source(path), "version": ModelFolder.version(path)}
    else:
        path = Path(repeated.file)
        more |= {"source": repeated.source, "version": digest_of(repeated.source)}
        more |= {"commands": repeated.commands, "helpers": repeated.helpers, "recorded": str(repeated.recording)}
    seed = fresh_seed() if options.seed is None else options.seed
    return Start(path=str(path), folder=str(path.parent), settings=options.settings, seed=seed, run=options.run, **more)


@dataclass(eq=False)
class LaunchedRun:
    """Holds a run and its worker, from the moment the run is started."""

    start: Start
    worker: Worker
    versions: SourceVersions = field(init=False)
    """The versions of the texts that the run is made of."""
    over: bool = False
    """Whether the worker has ended."""

    def __post_init__(self) -> None:
        self.versions = SourceVersions(self.start)
