"""Forges recordings as an owner of the key could: with correct checksums and a correct seal."""

from __future__ import annotations

import sqlite3
from collections.abc import Callable
from contextlib import closing
from pathlib import Path

from actr3d.recording.checksums import Checksums
from actr3d.recording.key import make_key, seal
from actr3d.recording.schema import COLUMNS

Change = str | Callable[[sqlite3.Connection], object]


def change(path: Path, *changes: Change) -> None:
    """Changes the file of a recording without updating its checksums."""
    with closing(sqlite3.connect(path)) as file, file:
        for each in changes:
            if callable(each):
                each(file)
            else:
                assert file.execute(each).rowcount > 0


def forge(path: Path, *changes: Change, key: bytes | None = None) -> None:
    """Changes the file of a recording, and computes its checksums and its seal again.

    Args:
        path: The recording.
        changes: Statements of SQL, each of which must change something, or functions of the open file.
        key: The key of the seal; by default that of this installation.
    """
    change(path, *changes, _seal_again(key or make_key() or b""))


def _seal_again(key: bytes) -> Change:
    def seal_again(file: sqlite3.Connection) -> None:
        checksums = Checksums()
        for table in COLUMNS:
            for first, *values, _ in file.execute(f"SELECT * FROM {table} ORDER BY first").fetchall():
                checksum = checksums.row(table, first, *values)
                file.execute(f"UPDATE {table} SET checksum = ? WHERE first = ?", (checksum, first))
        for name, value in file.execute("SELECT name, value FROM facts"):
            checksums.fact(name, value)
        whole = checksums.whole()
        file.execute("UPDATE seal SET checksum = ?, seal = ?", (whole, seal(key, whole)))

    return seal_again
