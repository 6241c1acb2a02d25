"""Stores what users write about recordings: a name, a note and tags; in one file beside the recordings, which stay unchanged."""

from __future__ import annotations

import json
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path
from threading import Lock

import msgspec

FILE = "labels.json"


class Label(msgspec.Struct, frozen=True, kw_only=True):
    """What a user has written about a recording."""

    name: str = ""
    note: str = ""
    tags: tuple[str, ...] = ()

    def __bool__(self) -> bool:
        return bool(self.name or self.note or self.tags)


class Labels:
    """Reads and writes the labels of the recordings in a folder.

    Args:
        folder: The folder of the recordings.
    """

    def __init__(self, folder: Path) -> None:
        self._file = folder / FILE
        self._lock = Lock()

    def all(self) -> dict[str, Label]:
        """Returns the labels by the names of their files, without the ending; a damaged file counts as empty."""
        try:
            return msgspec.json.decode(self._file.read_bytes(), type=dict[str, Label])
        except (OSError, msgspec.MsgspecError, UnicodeDecodeError):
            return {}

    def set(self, recording: str, label: Label) -> None:
        """Sets the label of a recording; an empty one removes it.

        Raises:
            OSError: If the file cannot be written.
        """
        with self._lock:
            self._write({**self.all(), recording: label})

    def move(self, recording: str, to: str) -> None:
        """Moves a label with its renamed recording."""
        with self._lock:
            labels = self.all()
            if recording in labels:
                labels[to] = labels.pop(recording)
                self._write(labels)

    def forget(self, recordings: Iterable[str]) -> None:
        """Removes the labels of deleted recordings."""
        with self._lock, suppress(OSError):
            labels = self.all()
            gone = [labels.pop(recording) for recording in recordings if recording in labels]
            if gone:
                self._write(labels)

    def _write(self, labels: dict[str, Label]) -> None:
        part = self._file.with_name(f".{FILE}.part")
        kept = {name: msgspec.structs.asdict(label) for name, label in sorted(labels.items()) if label}
        part.write_text(json.dumps(kept, indent=1), encoding="utf-8")
        part.replace(self._file)
