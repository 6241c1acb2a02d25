"""Stores what users write about recordings: a name, a note and tags; in one file beside the recordings, which stay unchanged."""

from __future__ import annotations

import json
import logging
from collections.abc import Iterable, Mapping
from contextlib import suppress
from pathlib import Path
from threading import Lock
from typing import Any

import msgspec

from actr3d.errors import Actr3dError
from actr3d.replacing import locked, replace_file
from workbench.file_names import unique_suffix

FILE = "labels.json"
ASIDE = "labels-damaged{}.json"
"""The name under which a damaged file is kept."""


class LabelError(Actr3dError):
    """A field of a label was changed by somebody else in the meantime, to what is `there` now."""

    def __init__(self, field: str, there: str | tuple[str, ...]) -> None:
        value = there if isinstance(there, str) else ", ".join(there)
        super().__init__(f"another browser has changed the {field} to '{value}' in the meantime")


class Label(msgspec.Struct, frozen=True, kw_only=True):
    """What a user has written about a recording."""

    name: str = ""
    note: str = ""
    tags: tuple[str, ...] = ()

    def __bool__(self) -> bool:
        return bool(self.name or self.note or self.tags)


class Labels:
    """Reads and writes the labels of the recordings in a folder."""

    def __init__(self, folder: Path) -> None:
        self._file = folder / FILE
        self._lock = Lock()

    def all(self) -> dict[str, Label]:
        """Returns the labels by the names of their files, without the ending; none if the file cannot be read, see `problem`."""
        return self._read()[0]

    def _read(self) -> tuple[dict[str, Label], str | None]:
        """Returns the labels, and why they cannot be read."""
        try:
            return msgspec.json.decode(self._file.read_bytes(), type=dict[str, Label]), None
        except (FileNotFoundError, NotADirectoryError):
            return {}, None
        except OSError as error:
            return {}, error.strerror or type(error).__name__
        except (msgspec.MsgspecError, UnicodeDecodeError, RecursionError) as error:
            return {}, f"it is damaged: {error}"

    @property
    def problem(self) -> str | None:
        """Why labels are missing; None if they are all known. While some are missing, nobody knows which recordings a user has labelled."""
        wrong = self._read()[1]
        if wrong is not None:
            return f"The names, notes and tags of recordings cannot be read from {FILE} ({wrong}). Nothing is deleted automatically."
        aside = sorted(path.name for path in self._file.parent.glob(ASIDE.format("-*")))
        if aside:
            return (
                f"The names, notes and tags of recordings are new: the earlier file was damaged, and is kept as {', '.join(aside)} in "
                f"{self._file.parent}. Nothing is deleted automatically until you repair it or delete it."
            )
        return None

    def change(self, recording: str, changes: Mapping[str, Any], known: Label | None = None) -> Label:
        """Changes fields of the label of a recording, and returns the label; an empty one is removed.

        Args:
            recording: The name of the recording.
            changes: The new values of fields; the others stay as they are.
            known: The label that the changes were made from; None to replace whatever there is.

        Raises:
            LabelError: If a field that changes no longer has the value in `known`.
            OSError: If the file cannot be written, or a damaged one not be kept.
        """
        with self._lock, locked(self._file):
            labels, wrong = self._read()
            if wrong is not None:  # such a file is kept aside
                self._file.rename(self._file.with_name(ASIDE.format(unique_suffix())))
                logging.getLogger("workbench").warning(self.problem)
            now = labels.get(recording, Label())
            for field, new in changes.items():
                there = getattr(now, field)
                if known is not None and there not in (getattr(known, field), new):
                    raise LabelError(field, there)
            labels[recording] = label = msgspec.structs.replace(now, **changes)
            self._write(labels)
            return label

    def forget(self, recordings: Iterable[str]) -> None:
        """Removes the labels of deleted recordings."""
        with suppress(OSError), self._lock, locked(self._file):
            labels = self.all()
            gone = [labels.pop(recording) for recording in recordings if recording in labels]
            if gone:
                self._write(labels)

    def _write(self, labels: dict[str, Label]) -> None:
        kept = {name: msgspec.structs.asdict(label) for name, label in sorted(labels.items()) if label}
        replace_file(self._file, json.dumps(kept, indent=1).encode())
