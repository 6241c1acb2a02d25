"""The thread that writes a recording while the run goes on."""

from __future__ import annotations

import sqlite3
from collections import deque
from collections.abc import Callable
from contextlib import suppress
from itertools import groupby
from pathlib import Path
from threading import Event, Thread
from typing import Any, NamedTuple

from actr3d.errors import RecordingError
from actr3d.recording.form import SCHEMA

INTERVAL = 0.25
"""How often what has come is written [s on the wall]; a run that is killed loses no more than what came since."""
MOST_WAITING = 200_000
"""So many entries may wait; then the run waits for the disk."""
BLOB = 1_000_000
"""About how many bytes of states are written as one."""

INSERT = {
    "events": "INSERT INTO events (number, tick, time_us, source, kind, line) VALUES (?, ?, ?, ?, ?, ?)",
    "commands": "INSERT INTO commands (number, tick, data) VALUES (?, ?, ?)",
    "answers": "INSERT INTO answers (number, tick, body, word, value) VALUES (?, ?, ?, ?, ?)",
    "facts": "INSERT OR REPLACE INTO facts (name, value) VALUES (?, ?)",
}


class State(NamedTuple):
    """The state at the end of a tick."""

    tick: int
    data: bytes


class Cut(NamedTuple):
    """From here on the run went another way: what was written beyond these numbers is to go."""

    tick: int
    events: int
    commands: int
    answers: int


Entry = tuple[str, tuple[Any, ...]]
"""A table and a row of it; `states` has a `State`, `cut` a `Cut`."""


class Writer(Thread):
    """Writes entries to a new file, a few times a second, until it is closed; what fails is raised where entries are put in.

    Args:
        path: Where the file is to be.
        facts: The first rows of `facts`.

    Raises:
        RecordingError: If the file exists already, or cannot be made.
    """

    def __init__(self, path: Path, facts: list[tuple[str, str]]) -> None:
        super().__init__(name=f"recording {path.name}", daemon=True)
        self.path = path
        self.failure: RecordingError | None = None
        """Why nothing is written any more."""
        self.waiting: deque[Entry] = deque()
        self._over = Event()
        if path.exists():
            raise RecordingError(f"'{path}' exists already; a recording does not replace what is there")
        self._attempt(self._create, facts)
        if self.failure is not None:
            raise self.failure
        self.start()

    def put(self, table: str, row: tuple[Any, ...]) -> None:
        """Takes one entry.

        Raises:
            RecordingError: If the file cannot be written any more.
        """
        self.waiting.append((table, row))
        if len(self.waiting) > MOST_WAITING:
            while len(self.waiting) > MOST_WAITING // 2 and self.failure is None:
                self._over.wait(INTERVAL / 10)
        if self.failure is not None:
            raise self.failure

    def close(self) -> None:
        """Writes what is left and closes the file: one file then, without companions.

        Raises:
            RecordingError: If the file cannot be written.
        """
        self._over.set()
        self.join()
        if self.failure is not None:
            raise self.failure

    def run(self) -> None:
        """Is the thread."""
        while not self._over.wait(INTERVAL):
            self._attempt(self._write_waiting)
        self._attempt(self._write_waiting)
        self._attempt(self._finish)
        with suppress(sqlite3.Error):  # where the disk is full, SQLite leaves its journal beside the file, and reads it next time
            self._file.close()

    def _attempt(self, work: Callable[..., None], *args: Any) -> None:
        """Does a piece of work with the file; once one has failed, nothing more."""
        if self.failure is not None:
            self.waiting.clear()
            return
        try:
            work(*args)
        except (sqlite3.Error, OSError) as error:
            reason = "the disk is full" if "full" in str(error) else str(error)
            self.failure = RecordingError(f"cannot write the recording '{self.path}': {reason}; what was written before is kept")

    # -- the file

    def _create(self, facts: list[tuple[str, str]]) -> None:
        self._file = sqlite3.connect(self.path, isolation_level=None, check_same_thread=False)
        try:
            # A reader may look while the run goes on, and what is committed outlives a killed program.
            self._file.execute("PRAGMA journal_mode=WAL")
            self._file.execute("PRAGMA synchronous=NORMAL")
            self._file.executescript(f"BEGIN; {SCHEMA}")
            self._file.executemany(INSERT["facts"], facts)
            self._file.execute("COMMIT")
        except sqlite3.Error:
            self._file.close()
            raise

    def _write_waiting(self) -> None:
        """Writes what has come, as one transaction."""
        entries: list[Entry] = []
        while self.waiting:
            entries.append(self.waiting.popleft())
        if not entries:
            return
        self._file.execute("BEGIN")
        try:
            for table, group in groupby(sorted_by_table(entries), key=lambda entry: entry[0]):
                rows = [row for _, row in group]
                if table == "cut":
                    self._cut(*rows[-1])
                elif table == "states":
                    self._write_states(rows)
                else:
                    self._file.executemany(INSERT[table], rows)
            self._file.execute("COMMIT")
        except sqlite3.Error:
            if self._file.in_transaction:
                self._file.execute("ROLLBACK")
            raise

    def _write_states(self, states: list[Any]) -> None:
        most = max(1, BLOB // max(1, len(states[0].data)))
        for start in range(0, len(states), most):
            part = states[start : start + most]
            row = (part[0].tick, len(part), b"".join(state.data for state in part))
            self._file.execute("INSERT INTO states (first, ticks, data) VALUES (?, ?, ?)", row)

    def _cut(self, tick: int, events: int, commands: int, answers: int) -> None:
        for table, last in (("events", events), ("commands", commands), ("answers", answers)):
            self._file.execute(f"DELETE FROM {table} WHERE number > ?", (last,))
        self._file.execute("DELETE FROM states WHERE first > ?", (tick,))
        (last,) = self._file.execute("SELECT max(first) FROM states").fetchone()
        if last is not None:
            self._file.execute(
                "UPDATE states SET data = substr(data, 1, length(data) / ticks * ?1), ticks = ?1 WHERE first = ?2 AND ticks > ?1",
                (tick - last + 1, last),
            )

    def _finish(self) -> None:
        # In the old way of keeping a journal a closed file stands alone, and can be read in a folder that is read-only.
        self._file.execute("PRAGMA journal_mode=DELETE")


def sorted_by_table(entries: list[Entry]) -> list[Entry]:
    """Returns entries grouped by table as far as they may be: across a cut, nothing changes its place."""
    cuts = [place for place, entry in enumerate(entries) if entry[0] == "cut"]
    ordered: list[Entry] = []
    start = 0
    for end in (*cuts, len(entries)):
        ordered += sorted(entries[start:end], key=lambda entry: entry[0])
        ordered += entries[end : end + 1]
        start = end + 1
    return ordered
