"""Opens the file of a recording, which anybody may have made."""

from __future__ import annotations

import sqlite3
import time
from pathlib import Path

from actr3d.errors import RecordingError

LARGEST_VALUE = 250_000_000
"""No value in a table is larger [bytes]."""
PATIENCE = 1.0
"""So long a rollback journal may lie beside a file that is being made or closed [s]."""
COMPANIONS = ("-wal", "-shm", "-journal")
"""Files with these endings lie beside a recording that is being written."""


def opened(path: Path) -> sqlite3.Connection:
    """Returns a connection to a recording's file: one that makes no file where there is none, follows no links, and reads no huge values.

    Raises:
        RecordingError: If there is no such file, it cannot be opened, or a rollback journal lies beside it.
    """
    try:
        there = path.is_file()
    except ValueError:  # no path at all
        there = False
    if not there:
        raise RecordingError(f"no recording '{path}'")
    if any(path.with_name(path.name + end).is_symlink() for end in COMPANIONS):
        raise RecordingError(f"'{path}' is no recording: a link lies in the place of its journal")
    _wait_for_journal(path)
    try:
        # Where a killed program left its write-ahead log, reading the file takes writing it.
        file = sqlite3.connect(f"{path.absolute().as_uri()}?mode=rw", uri=True, isolation_level=None)
        file.setlimit(sqlite3.SQLITE_LIMIT_LENGTH, LARGEST_VALUE)
        file.execute("PRAGMA trusted_schema=OFF")
    except sqlite3.Error as error:
        raise RecordingError(f"cannot open the recording '{path}': {error}") from None
    return file


def _wait_for_journal(path: Path) -> None:
    """Waits until no rollback journal lies beside a recording; it has one for a moment as it is made, and as it is closed.

    SQLite would roll a journal back that was left, and then delete whatever file it names as the journal of a larger transaction: of a
    recording from elsewhere, any file of the user's.

    Raises:
        RecordingError: If it stays.
    """
    journal = path.with_name(f"{path.name}-journal")
    end = time.monotonic() + PATIENCE
    while journal.exists():
        if time.monotonic() > end:
            raise RecordingError(f"'{path}' is not read: '{journal.name}' lies beside it, and may make SQLite delete other files")
        time.sleep(0.01)
