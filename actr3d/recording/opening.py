"""Opens the file of a recording, which may come from an untrusted source."""

from __future__ import annotations

import sqlite3
import time
from pathlib import Path

from actr3d.errors import RecordingError, reason_of

LARGEST_VALUE = 250_000_000
"""The maximum size of a value in a table [bytes]."""
PATIENCE = 1.0
"""How long to wait for the rollback journal of a file that is being created or closed to disappear [s]."""
COMPANIONS = ("-wal", "-shm", "-journal")
"""The suffixes of files that exist next to a recording while it is written."""


def opened(path: Path) -> sqlite3.Connection:
    """Returns a connection to a recording's file: it never creates a file, and reads no huge values.

    For a symbolic link to a recording, SQLite uses the journal beside the recording itself; so that is what is checked.

    Raises:
        RecordingError: If there is no such file, it cannot be opened, or it has a rollback journal.
    """
    try:
        path = path.resolve(strict=True)
        there = path.is_file()
    except PermissionError as error:
        raise RecordingError(f"cannot open the recording '{path}': {reason_of(error)}") from None
    except (OSError, RuntimeError, ValueError):  # nothing there, a loop of links, or not a valid path
        there = False
    if not there:
        raise RecordingError(f"no recording '{path}'")
    if any(path.with_name(path.name + end).is_symlink() for end in COMPANIONS):
        raise RecordingError(f"'{path}' is not a recording: its journal is a symbolic link")
    _wait_for_journal(path)
    try:
        # If a killed program left its write-ahead log, SQLite must write to the file in order to read it.
        # A program that runs a model in a thread is compared with its recording in that thread.
        file = sqlite3.connect(f"{path.absolute().as_uri()}?mode=rw", uri=True, isolation_level=None, check_same_thread=False)
        file.setlimit(sqlite3.SQLITE_LIMIT_LENGTH, LARGEST_VALUE)
        file.execute("PRAGMA trusted_schema=OFF")
    except sqlite3.Error as error:
        raise RecordingError(f"cannot open the recording '{path}': {error}") from None
    return file


def _wait_for_journal(path: Path) -> None:
    """Waits until a recording has no rollback journal; it has one for a moment while it is created, and while it is closed.

    SQLite would roll back a leftover journal, and then delete whatever file the journal names as that of a larger transaction: with
    a recording from an untrusted source, this could be any of the user's files.

    Raises:
        RecordingError: If the journal remains.
    """
    journal = path.with_name(f"{path.name}-journal")
    end = time.monotonic() + PATIENCE
    while journal.exists():
        if time.monotonic() > end:
            raise RecordingError(f"'{path}' is not read: '{journal.name}' lies beside it, and may make SQLite delete other files")
        time.sleep(0.01)
