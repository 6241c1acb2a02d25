"""Reads the folder of an experiment, which may come from anybody: nothing in it is executed, and no link is followed."""

from __future__ import annotations

import fcntl
import hashlib
import json
from contextlib import suppress
from pathlib import Path
from typing import Any, TypeVar, cast

import msgspec

from actr3d.recording.key import is_sealed, make_key, seal
from actr3d.replacing import replace_file
from workbench.experiment_command import ExperimentFacts, ExperimentRunError
from workbench.files import database_stamp, is_writable
from workbench.retention import begun

SPECIFICATION, FACTS, TABLE, LOCK, NOTES = "experiment.json", "facts.json", "trials.sqlite", "lock", "workbench.json"
"""The files of an experiment's folder; the workbench writes only the last one."""
REPORT, PAGE, REPORTS = "report", "index.html", "reports"
"""The folder of the report in that of the experiment, its page, and the folder beside all experiments for reports of those that cannot be
written."""
REPORT_FILES = {".html": "text/html; charset=utf-8", ".svg": "image/svg+xml", ".png": "image/png", ".csv": "text/csv; charset=utf-8"}
"""The media types of the files of a report."""
LARGEST = 20_000_000
"""Maximum size of a description [bytes]."""
LARGEST_REPORT = 200_000_000
"""Maximum size of a file of a report that is shown [bytes]."""


S = TypeVar("S", bound=msgspec.Struct)


class Notes(msgspec.Struct, frozen=True, kw_only=True):
    """What the workbench keeps of an experiment beside its table."""

    seal: str = ""
    """The seal of this installation, with which it recognizes an experiment that it has made."""
    problem: str | None = None
    """Why its last run ended too early."""
    workers: int | None = None
    """The number of processes of its last run; None for one on each processor."""


class ExperimentFolder:
    """The folder of an experiment."""

    def __init__(self, path: Path) -> None:
        self.path = path

    @property
    def is_experiment(self) -> bool:
        """Whether there is an experiment."""
        return not self.path.is_symlink() and is_plain(self.path / SPECIFICATION)

    @property
    def made(self) -> float:
        """When the experiment was made [s since 1970]."""
        return begun(self.path, self.path / SPECIFICATION)

    @property
    def is_locked(self) -> bool:
        """Whether a process runs the experiment."""
        lock = self.path / LOCK
        if not is_plain(lock):
            return False
        try:
            with lock.open("rb") as file:
                fcntl.flock(file, fcntl.LOCK_SH | fcntl.LOCK_NB)
        except BlockingIOError:
            return True
        except OSError:
            return False
        return False

    @property
    def facts(self) -> ExperimentFacts | None:
        """The facts of the experiment; None if they cannot be read."""
        return self._decoded(FACTS, ExperimentFacts)

    @property
    def table(self) -> Path | None:
        """The file with the table of trials; None if no trial has finished."""
        path = self.path / TABLE
        return path if is_plain(path) else None

    @property
    def table_stamp(self) -> Any:
        """A value that changes whenever the table changes; None if there is none."""
        table = self.table
        return None if table is None else database_stamp(table)

    @property
    def elsewhere(self) -> Path:
        """The folder for its report if its own folder cannot be written, as that of an archive."""
        return self.path.parent.with_name(REPORTS) / self.path.name

    @property
    def report_folder(self) -> Path:
        """The folder in which its report is made."""
        return self.path / REPORT if is_writable(self.path) else self.elsewhere

    @property
    def report_made(self) -> float | None:
        """When the report was made [s since 1970]; None if there is none."""
        page = self.report_file(PAGE)
        return None if page is None else page.stat().st_mtime

    def report_file(self, name: str) -> Path | None:
        """Returns a file of the report; None if there is none.

        Args:
            name: Its page, or a file in one of the folders of the report: `figures/NAME.svg`, `tables/NAME.csv`.
        """
        here = self.report_folder
        if here == self.elsewhere and not is_plain(here / PAGE):
            here = self.path / REPORT  # it was made before the folder became one that cannot be written
        path = here / name
        between = (here, path.parent)
        if path.suffix not in REPORT_FILES or path.parent not in (here, here / "figures", here / "tables"):
            return None
        there = is_plain(path) and not any(folder.is_symlink() for folder in between) and path.stat().st_size <= LARGEST_REPORT
        return path if there else None

    def code(self) -> dict[str, Any]:
        """Returns the code that continuing the experiment runs: the texts of design and model, and of their helper modules.

        Raises:
            ExperimentRunError: If the description cannot be read.
        """
        try:
            given: Any = json.loads(self._read(SPECIFICATION))
            design, model = given["design"], given["model"]
            texts = {str(one["file"]): str(one["text"]) for one in (model, design)}
            texts |= {str(file): str(text) for one in (design, model) for file, text in one.get("helpers", {}).values()}
            file = str(design["file"])
        except (OSError, KeyError, TypeError, ValueError, AttributeError, RecursionError):
            raise ExperimentRunError(f"{SPECIFICATION} is not the description of an experiment") from None
        return {"made_here": self.made_here, "file": file, "source": texts.pop(file), "helpers": texts}

    # -- notes

    @property
    def notes(self) -> Notes:
        """The notes; empty ones if there are none, or they cannot be read."""
        return self._decoded(NOTES, Notes) or Notes()

    def note(self, **changes: Any) -> None:
        """Changes notes; does nothing if the folder is gone or cannot be written, because they are not needed to run an experiment."""
        notes = msgspec.structs.replace(self.notes, **changes)
        with suppress(OSError):
            replace_file(self.path / NOTES, msgspec.json.encode(notes))

    @property
    def made_here(self) -> bool:
        """Whether this installation made the experiment, or its user has trusted it, and its description is still the same."""
        try:
            return is_sealed(self._checksum(), bytes.fromhex(self.notes.seal))
        except (OSError, ValueError):
            return False

    def seal(self) -> None:
        """Marks the experiment as made or trusted by this installation."""
        key = make_key()
        with suppress(OSError, ValueError):
            if key is not None:
                self.note(seal=seal(key, self._checksum()).hex())

    def _checksum(self) -> bytes:
        """Returns the checksum of the description, which differs from that of any recording."""
        return hashlib.sha256(b"experiment\0" + self._read(SPECIFICATION)).digest()

    def _decoded(self, name: str, kind: type[S]) -> S | None:
        """Returns what a file holds; None if it cannot be read."""
        try:
            return msgspec.json.decode(self._read(name), type=kind)
        except (OSError, msgspec.MsgspecError, ValueError, RecursionError):
            return None

    def _read(self, name: str) -> bytes:
        path = self.path / name
        if not is_plain(path) or path.stat().st_size > LARGEST:
            raise ValueError(f"{name} is not a file, or is too large")
        return path.read_bytes()


def is_plain(path: Path) -> bool:
    """Returns whether a path is a file and no link."""
    return path.is_file() and not path.is_symlink()


def as_values(facts: ExperimentFacts | None) -> dict[str, Any]:
    """Returns facts as plain values."""
    found = {} if facts is None else cast("dict[str, Any]", msgspec.to_builtins(facts))
    return {name: value for name, value in found.items() if name != "event"}
