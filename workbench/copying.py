"""Copies of recordings that are being written: what lies in the files beside them is in the copy, which stands alone."""

from __future__ import annotations

import asyncio
import os
import sqlite3
import tempfile
from contextlib import closing
from pathlib import Path

from actr3d.errors import RecordingError
from workbench.keeping import erase

MOST = 2
"""So many copies are made at once; others wait for their turn."""

_turns = asyncio.Semaphore(MOST)


async def copy_of(path: Path) -> Path:
    """Returns a new file with what a recording holds now, for the caller to delete; the event loop does not wait for it.

    Raises:
        RecordingError: If it cannot be read, or the copy cannot be written, as on a full disk.
        OSError: If no file can be had.
    """
    async with _turns:
        descriptor, name = tempfile.mkstemp(prefix="recording-", suffix=".sqlite")
        os.close(descriptor)
        made = Path(name)
        copying = asyncio.ensure_future(asyncio.to_thread(_copy, path, made))
        try:
            await asyncio.shield(copying)
        except BaseException:
            copying.add_done_callback(lambda _: erase(made))  # the thread goes on, whoever has given up waiting for it
            raise
        return made


def _copy(path: Path, to: Path) -> None:
    """Copies a recording page by page, damage and all; the run that writes it does not wait."""
    try:
        # Where a killed program left a journal, reading the file takes writing it; but one that is gone is not made anew.
        there = f"{path.absolute().as_uri()}?mode=rw"
        with closing(sqlite3.connect(there, uri=True)) as source, closing(sqlite3.connect(to, isolation_level=None)) as target:
            target.execute("PRAGMA synchronous=OFF")
            source.backup(target)  # in one step: of several, each write in between would begin it anew
            target.execute("PRAGMA journal_mode=DELETE")  # as a run that has ended leaves its own: one file, without companions
    except sqlite3.Error as error:
        reason = "the disk is full" if "full" in str(error) else str(error)
        raise RecordingError(f"the recording cannot be copied: {reason}") from None
