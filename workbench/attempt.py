"""An attempt to begin a run: what it begins with, and the worker that it is given."""

from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from actr3d.actr.kernel.run_limits import fresh_seed
from actr3d.actr.loading.source_text import read_source
from workbench.files import ModelFolder
from workbench.texts import Texts
from workbench.worker.messages import Start, digest_of
from workbench.worker.workers import Worker


@dataclass(frozen=True, kw_only=True)
class Relived:
    """An earlier run that is to be lived through again."""

    file: str
    """Where the model file was then; nothing is read from there."""
    source: str
    """The model's text then."""
    commands: list[tuple[int, dict[str, Any]]]
    """What users did, to be done again: after which tick, and what."""
    recording: Path
    """Where it was recorded."""
    helpers: dict[str, tuple[str, str]]
    """Its helper modules, as `actr3d.actr.loading.helper_modules` keeps them."""


@dataclass(frozen=True, kw_only=True)
class Wanted:
    """What is wanted of a run; see `Start`."""

    settings: dict[str, Any] = field(default_factory=dict[str, Any])
    """Values of parameters."""
    seed: int | str | None = None
    """None for a fresh one."""
    record: bool = True
    run: bool = False
    """Whether it goes on at once."""
    relived: Relived | None = None
    """The run that it is to be once more; None for a new one of what is in the file now."""


def start_of(path: Path, wanted: Wanted, **more: Any) -> Start:
    """Returns how a run of a model begins.

    Args:
        path: The model file.
        wanted: What is wanted of it.
        more: Other fields of `Start`, as they are.

    Raises:
        ModelFileError: If the file cannot be read.
        OSError: If it cannot be read any more.
    """
    relived = wanted.relived
    if relived is None:
        more |= {"source": read_source(path), "version": ModelFolder.version(path)}
    else:
        path = Path(relived.file)
        more |= {"source": relived.source, "version": digest_of(relived.source)}
        more |= {"commands": relived.commands, "helpers": relived.helpers, "recorded": str(relived.recording)}
    seed = fresh_seed() if wanted.seed is None else wanted.seed
    return Start(path=str(path), folder=str(path.parent), settings=wanted.settings, seed=seed, run=wanted.run, **more)


@dataclass(eq=False)
class Attempt:
    """A run in its worker, from when that is told to begin."""

    start: Start
    worker: Worker
    texts: Texts = field(init=False)
    """What it is made of."""
    over: bool = False
    """Whether the worker has ended."""

    def __post_init__(self) -> None:
        self.texts = Texts(self.start)
