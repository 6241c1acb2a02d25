"""The thread that writes a recording while the run goes on."""

from __future__ import annotations

import json
import sqlite3
from array import array
from collections import deque
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path
from threading import Event, Lock, Thread
from typing import Any, NamedTuple

from actr3d.actr.answers import plain_answer
from actr3d.errors import RecordingError
from actr3d.recording.form import SCHEMA
from actr3d.trace import TraceEvent
from actr3d.values import plain_to_json

INTERVAL = 0.25
"""How often what has come is written [s on the wall]; a run that is killed loses no more than what came since."""
BLOB = 1_000_000
"""About how many bytes of states are written as one row."""
MOST_EVENTS = 10_000
"""How many events are written as one row, at most."""

MARKS = 4 * 8
"""How many bytes of marks a state has."""


class State(NamedTuple):
    """The physics of a run at its start, or at the end of a tick."""

    run: int
    """Which simulation of a program, as its trace counts them; 1 of one that is recorded alone."""
    tick: int
    data: bytes
    """MuJoCo's `mjSTATE_INTEGRATION`, 8 bytes a number."""
    events: int
    """How many events there were until then."""


class Command(NamedTuple):
    """What a user did, as JSON."""

    run: int
    tick: int
    """After which tick."""
    text: str


class Answer(NamedTuple):
    """What a body answered."""

    run: int
    tick: int
    body: str
    word: str
    value: Any


class Writer:
    """Writes to a new file what has been put into its queues, a few times a second, until it is closed; by a thread of its own.

    Args:
        path: Where the file is to be.
        facts: The first rows of `facts`.

    Raises:
        RecordingError: If the file exists already, or cannot be made.
    """

    def __init__(self, path: Path, facts: Sequence[tuple[str, str]]) -> None:
        self.path = path
        self.failure: RecordingError | None = None
        """Why nothing is written any more."""
        # One thread puts in, another takes out, neither waits for the other.
        self.events: deque[TraceEvent] = deque()
        self.answers: deque[Answer] = deque()
        self.states: deque[State] = deque()
        self.commands: deque[Command] = deque()
        self.facts: deque[tuple[str, str]] = deque()
        self._written = {"events": 0, "answers": 0, "states": 0, "commands": 0}
        self._writing = Lock()
        self._over = Event()
        self._attempt(self._create, facts)
        if self.failure is not None:
            raise self.failure
        self._thread = Thread(target=self._run, name=f"recording {path.name}", daemon=True)
        self._thread.start()

    def flush(self) -> None:
        """Writes what has come, now; also for a caller that puts things in faster than they are written."""
        self._attempt(self._write)

    def cut(self, ticks: int, events: int, answers: int, commands: int) -> None:
        """Drops all but the first few of each: from there the run goes another way."""
        self.flush()
        self._attempt(self._cut, {"states": ticks + 1, "events": events, "answers": answers, "commands": commands})

    def close(self) -> None:
        """Writes what is left and closes the file: one file then, without companions.

        Raises:
            RecordingError: If the file cannot be written.
        """
        self._over.set()
        self._thread.join()
        if self.failure is not None:
            raise self.failure

    def _run(self) -> None:
        while not self._over.wait(INTERVAL):
            self.flush()
        self.flush()
        self._attempt(self._finish)
        with suppress(sqlite3.Error):  # where the disk is full, SQLite leaves its journal beside the file, and reads it next time
            self._file.close()

    def _attempt(self, work: Callable[..., None], *args: Any) -> None:
        """Does a piece of work with the file; once one has failed, nothing more."""
        with self._writing:
            if self.failure is not None:
                for queue in (self.events, self.answers, self.states, self.commands, self.facts):
                    queue.clear()
                return
            try:
                work(*args)
            except (sqlite3.Error, OSError, ValueError) as error:
                self.failure = RecordingError(f"cannot write the recording '{self.path}': {_reason(error)}")

    # -- the file

    def _create(self, facts: Sequence[tuple[str, str]]) -> None:
        self.path.open("xb").close()
        # The whole path, because SQLite has a meaning of its own for names such as `:memory:`.
        self._file = sqlite3.connect(self.path.absolute(), isolation_level=None, check_same_thread=False)
        try:
            # Neither the beginning nor the end of a run waits for the disk, only for the system; the thread does meanwhile.
            self._file.execute("PRAGMA synchronous=OFF")
            # A reader may look while the run goes on, and what is committed outlives a killed program.
            self._file.execute("PRAGMA journal_mode=WAL")
            self._file.executescript(f"BEGIN; {SCHEMA}")
            self._file.executemany("INSERT INTO facts VALUES (?, ?)", facts)
            self._file.execute("COMMIT")
            self._file.execute("PRAGMA synchronous=NORMAL")
        except sqlite3.Error:
            self._file.close()
            raise

    def _write(self) -> None:
        """Writes what has come, as one transaction."""
        # States first: the events until then have come already.
        states, facts, commands = _all_of(self.states), _all_of(self.facts), _all_of(self.commands)
        answers, events = _all_of(self.answers), _all_of(self.events)
        if not (states or facts or commands or answers or events):
            return
        rows = [(part, _events_text(part)) for part in _parts(events, MOST_EVENTS)]
        self._transact(self._insert, rows, states, facts, commands, answers)

    def _insert(
        self,
        events: list[tuple[list[TraceEvent], str]],
        states: list[State],
        facts: list[tuple[str, str]],
        commands: list[Command],
        answers: list[Answer],
    ) -> None:
        insert = self._file.execute
        for part, text in events:
            insert("INSERT INTO events VALUES (?, ?, ?)", (self._next("events", len(part)), len(part), text))
        for some in _parts(answers, MOST_EVENTS):
            text = json.dumps([plain_answer(answer) for answer in some])
            insert("INSERT INTO answers VALUES (?, ?, ?)", (self._next("answers", len(some)), len(some), text))
        for row in _parts(states, max(1, BLOB // len(states[0].data)) if states else 1):
            data = b"".join([state.data for state in row])
            marks = array("q", [mark for run, tick, state, events in row for mark in (run, tick, events, len(state))]).tobytes()
            insert("INSERT INTO states VALUES (?, ?, ?, ?)", (self._next("states", len(row)), len(row), data, marks))
        for command in commands:
            insert("INSERT INTO commands VALUES (?, ?, ?, ?)", (self._next("commands", 1), *command))
        for fact in facts:
            insert("INSERT OR REPLACE INTO facts VALUES (?, ?)", fact)

    def _next(self, table: str, count: int) -> int:
        """Returns the number of the next thing in a table, and counts so many."""
        first = self._written[table]
        self._written[table] += count
        return first

    def _transact(self, work: Callable[..., None], *args: Any) -> None:
        self._file.execute("BEGIN")
        try:
            work(*args)
            self._file.execute("COMMIT")
        except sqlite3.Error:
            if self._file.in_transaction:
                self._file.execute("ROLLBACK")
            raise

    def _cut(self, kept: dict[str, int]) -> None:
        self._transact(self._delete, kept)
        self._written.update(kept)

    def _delete(self, kept: dict[str, int]) -> None:
        self._file.execute("DELETE FROM commands WHERE number >= ?", (kept["commands"],))
        for table in ("events", "answers"):
            last = self._delete_rows(table, kept[table])
            if last is not None:
                first, _, data = last
                text = json.dumps(json.loads(data)[: kept[table] - first], ensure_ascii=False)
                self._file.execute(f"UPDATE {table} SET count = ?, data = ? WHERE first = ?", (kept[table] - first, text, first))
        last = self._delete_rows("states", kept["states"])
        if last is not None:
            first, _, data, marks = last
            left = kept["states"] - first
            marks = marks[: MARKS * left]
            row = (left, data[: sum(array("q", marks)[3::4])], marks, first)
            self._file.execute("UPDATE states SET count = ?, data = ?, marks = ? WHERE first = ?", row)

    def _delete_rows(self, table: str, kept: int) -> Any:
        """Drops the rows beyond the first things of a table; returns the row of which only a part is to be kept, if any."""
        self._file.execute(f"DELETE FROM {table} WHERE first >= ?", (kept,))
        return self._file.execute(f"SELECT * FROM {table} WHERE first + count > ?", (kept,)).fetchone()

    def _finish(self) -> None:
        # In the old way of keeping a journal a closed file stands alone, and can be read in a folder that is read-only.
        self._file.execute("PRAGMA synchronous=OFF")
        try:
            self._file.execute("PRAGMA journal_mode=DELETE")
        except sqlite3.OperationalError as error:
            # Somebody reads it just now: it is whole all the same, and whoever closes it last removes what lies beside it.
            if error.sqlite_errorcode != sqlite3.SQLITE_BUSY:
                raise


def _reason(error: Exception) -> str:
    """Says why a file cannot be written."""
    if isinstance(error, FileExistsError):
        return "it exists already, and a recording does not replace what is there"
    if isinstance(error, OSError):
        return error.strerror or str(error)
    reason = "the disk is full" if "full" in str(error) else str(error)
    return f"{reason}; what was written before is kept"


def _all_of(queue: deque[Any]) -> list[Any]:
    """Takes out all that is in a queue now."""
    return [queue.popleft() for _ in range(len(queue))]


def _parts(things: list[Any], most: int) -> list[list[Any]]:
    return [things[start : start + most] for start in range(0, len(things), most)]


def _events_text(events: list[TraceEvent]) -> str:
    """Returns events as one JSON list; what JSON has no word for becomes what `TraceEvent.to_json` makes of it."""
    return plain_to_json(events, _one_by_one)


def _one_by_one(events: list[TraceEvent]) -> str:
    return plain_to_json([[event.time_us, event.source, event.kind, json.loads(event.to_json())["data"]] for event in events])
