"""Manages the recording files of a models folder."""

from __future__ import annotations

import itertools
import os
import re
import secrets
import time
from collections.abc import Callable, Collection, Sequence
from contextlib import suppress
from io import FileIO
from pathlib import Path

from actr3d.errors import Actr3dError, RecordingError
from workbench.branch_numbers import BranchNumbers
from workbench.file_names import NAME, unique_suffix
from workbench.labels import Labels
from workbench.retention import RetentionLimits, begun, companions, erase, is_open_elsewhere, recordings_over_limit, written
from workbench.trash import OWN, move_to_trash, names_in_trash

LEFTOVER = 86_400.0
"""The age from which an unfinished file is that of a process that was killed [s]."""


class NoSuchRecordingError(Actr3dError):
    """There is no recording of that name."""

    status = 404

    def __init__(self) -> None:
        super().__init__("there is no such recording")


class Recordings:
    """Finds and deletes the recordings of a models folder."""

    def __init__(self, root: Path) -> None:
        self._root = root
        self._folder = root / OWN / "recordings"
        self.labels = Labels(self._folder)
        """What users have written about them."""
        self.numbers = BranchNumbers(self._folder, self._names)
        """The numbers of those that are called the same."""
        self.spare: Callable[[], Collection[Path]] = tuple
        """Returns the files of opened recordings whose runs do not differ from them: these are not listed."""

    def new(self, model: str) -> Path:
        """Returns a new file path for a run of a model.

        Raises:
            RecordingError: If the folder cannot be written.
        """
        try:
            self._folder.mkdir(parents=True, exist_ok=True)
            problem = None if os.access(self._folder, os.W_OK) else "it is read-only"
        except OSError as error:
            problem = error.strerror or str(error)
        if problem is not None:
            raise RecordingError(f"the folder '{self._folder}' cannot be written: {problem}")
        stem = re.sub(r"[^A-Za-z0-9_]", "_", model)[:60] or "model"
        return self._folder / f"{stem}{unique_suffix()}.sqlite"

    def path(self, name: str) -> Path:
        """Returns the path of a recording.

        Raises:
            NoSuchRecordingError: If there is no recording of that name.
        """
        path = self._folder / f"{name}.sqlite"
        if NAME.fullmatch(name) is None or not path.is_file() or path.is_symlink():
            raise NoSuchRecordingError
        return path

    def all(self) -> list[Path]:
        """Returns the paths of all recordings, newest first."""
        return sorted(self._files(), key=lambda path: (begun(path), path.name), reverse=True)

    def _files(self) -> Sequence[Path]:
        spare = self.spare()
        files = [path for path in self._folder.glob("*.sqlite") if path not in spare]
        return [path for path in files if NAME.fullmatch(path.stem) and path.is_file() and not path.is_symlink()]

    def _names(self) -> set[str]:
        """Returns the names of all recordings, including those in the trash."""
        there = (*(path.name for path in self._folder.iterdir()), *names_in_trash(self._root))
        return {name.removesuffix(".sqlite") for name in there if name.endswith(".sqlite")}

    def tidy(self, limits: RetentionLimits) -> None:
        """Deletes the oldest recordings that no user has named or labelled, if the limits are exceeded; none while labels are missing.

        A recording that another server may still write is kept. What a killed process has left of unfinished files is deleted, too.
        """
        for path in (*self._folder.glob(".*.part*"), *self._folder.glob(".*.tmp")):
            if written(path) < time.time() - LEFTOVER:
                path.unlink(missing_ok=True)
        if self.labels.problem is not None:
            return
        erased = recordings_over_limit(self._files(), limits, self.labels.all().keys())
        for path in erased:
            erase(path)
        self.labels.forget(path.stem for path in erased)

    def discard(self, path: Path) -> None:
        """Deletes the recording of a run that nobody needs, unless a user has labelled it; none while labels are missing."""
        if self.labels.problem is None and path.stem not in self.labels.all():
            erase(path)

    def unfinished(self) -> Path:
        """Returns a new file path for a recording that is being received; it is not listed."""
        self._folder.mkdir(parents=True, exist_ok=True)
        return self._folder / f".{secrets.token_hex(8)}.part"

    def add(self, file: Path, name: str) -> Path:
        """Moves a received file to the recordings, and returns its path there.

        Args:
            file: The file, in the folder of recordings.
            name: The name that it is to have, of any characters; a number is added if the name is taken.

        Raises:
            OSError: If it cannot be moved.
        """
        stem = re.sub(r"[^A-Za-z0-9_.\-]", "_", name)[:100].lstrip(".-") or "recording"
        for number in itertools.count(1):
            path = self._folder / f"{stem if number == 1 else f'{stem}-{number}'}.sqlite"
            with suppress(FileExistsError):
                os.link(file, path)  # unlike rename, this never replaces an existing file
                file.unlink()
                return path
        raise AssertionError

    def opened(self, name: str) -> FileIO:
        """Returns the file of a recording, opened for reading: it stays readable even if the recording is renamed or deleted.

        Raises:
            NoSuchRecordingError: If there is no recording of that name.
        """
        try:
            descriptor = os.open(self.path(name), os.O_RDONLY | os.O_NOFOLLOW | os.O_NONBLOCK | os.O_CLOEXEC)
        except FileNotFoundError:
            raise NoSuchRecordingError from None
        return FileIO(descriptor, "rb")

    def delete(self, name: str) -> str:
        """Moves a recording to the trash folder, with its label; returns its new path inside the models folder.

        Raises:
            NoSuchRecordingError: If there is no recording of that name.
            RecordingError: If another process may still write it: without its file, it would fail.
            OSError: If it cannot be moved.
        """
        path = self.path(name)
        if is_open_elsewhere(path):
            raise RecordingError("another program still writes this recording, perhaps another workbench: end its run, then delete it")
        trash = move_to_trash(self._root, path, *(each for each in companions(path) if each.exists()), label=self.labels.all().get(name))
        self.labels.forget([name])
        return trash
