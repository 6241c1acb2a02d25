"""The thread that writes a recording while the run goes on."""

from __future__ import annotations

import json
import sqlite3
from array import array
from collections import deque
from collections.abc import Callable, Sequence
from contextlib import closing, suppress
from copy import deepcopy
from pathlib import Path
from threading import Event, Lock, Thread
from typing import Any, NamedTuple

from actr3d.actr.modules.answers import plain_answer
from actr3d.errors import RecordingError
from actr3d.recording.checksums import Checksums
from actr3d.recording.form import COLUMNS, LEFT, SCHEMA
from actr3d.recording.key import make_key, seal
from actr3d.trace import TraceEvent
from actr3d.values import plain_to_json

INTERVAL = 0.25
"""How often what has come is written [s on the wall], besides when the run wants it written; a run that is killed loses no more
than what came since."""
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
        self._written = {"events": 0, "answers": 0, "states": 0, "ticks": 0, "commands": 0}
        """How many of each are in the file, with those of the present transaction."""
        self._safe = dict(self._written)
        """How many of each are in the file for good."""
        self._made = False
        self._checksums = Checksums()
        self._key = make_key()
        self._writing = Lock()
        self._over = Event()
        self._attempt(self._create, facts)
        if self.failure is not None:
            raise self.failure
        self._thread = Thread(target=self._run, name=f"recording {path.name}", daemon=True)
        self._thread.start()

    def flush(self) -> None:
        """Writes what has come, now."""
        self._attempt(self._write)

    def cut(self, ticks: int, events: int, answers: int, commands: int) -> None:
        """Drops all but the first few of each: from there the run goes another way."""
        self.flush()
        self._attempt(self._cut, {"states": ticks + 1, "events": events, "answers": answers, "commands": commands})

    def copy_to(self, path: Path) -> None:
        """Writes what has come, and a closed copy of all of it to a new file.

        Raises:
            RecordingError: If that file exists, or either cannot be written.
        """
        self.flush()
        with self._writing:
            if self.failure is not None:
                raise self.failure
            part = path.with_name(f".{path.name}.part")  # nobody finds an unfinished copy under its name
            try:
                if path.exists():
                    raise FileExistsError
                part.unlink(missing_ok=True)
                self._file.execute("VACUUM INTO ?", (str(part.absolute()),))
                with closing(sqlite3.connect(part.absolute())) as copy, copy:
                    self._mark_as_left(copy)
                part.rename(path)
            except (sqlite3.Error, OSError, ValueError) as error:
                _remove(part)
                raise RecordingError(f"cannot write the recording '{path}': {_reason(error)}") from None

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
                self.failure = RecordingError(f"cannot write the recording '{self.path}': {_reason(error)}{self._kept()}")

    def _kept(self) -> str:
        """Returns what is left of a recording that cannot be written any more; removes the file where nothing of the run is in it."""
        if not self._made:
            return ""
        if any(self._safe.values()):
            ticks, events = self._safe["ticks"], self._safe["events"]
            some = f"{ticks:,} ticks and {events:,} events" if ticks else f"{events:,} events"
            return f"; the first {some} of the run are kept, nothing of what came after"
        with suppress(sqlite3.Error, AttributeError):  # it may not have been opened
            self._file.close()
        _remove(self.path)
        return "; nothing of the run is kept"

    # -- the file

    def _create(self, facts: Sequence[tuple[str, str]]) -> None:
        self.path.open("xb").close()
        self._made = True
        # The whole path, because SQLite has a meaning of its own for names such as `:memory:`.
        self._file = sqlite3.connect(self.path.absolute(), isolation_level=None, check_same_thread=False)
        # Neither the beginning nor the end of a run waits for the disk, only for the system; the thread does meanwhile.
        self._file.execute("PRAGMA synchronous=OFF")
        # A reader may look while the run goes on, and what is committed outlives a killed program.
        self._file.execute("PRAGMA journal_mode=WAL")
        self._transact(self._begin, facts)
        self._file.execute("PRAGMA synchronous=NORMAL")

    def _begin(self, facts: Sequence[tuple[str, str]]) -> None:
        for table in SCHEMA:
            self._file.execute(table)
        self._insert_facts(facts)
        self._seal(self._file, self._checksums)

    def _write(self) -> None:
        """Writes what has come, as one transaction."""
        # States first: the events until then have come already.
        states, facts, commands = _all_of(self.states), _all_of(self.facts), _all_of(self.commands)
        answers, events = _all_of(self.answers), _all_of(self.events)
        if not (states or facts or commands or answers or events):
            return
        rows = [(part, _events_text(part)) for part in _parts(events, MOST_EVENTS)]
        self._transact(self._insert_all, rows, states, facts, commands, answers)

    def _insert_all(
        self,
        events: list[tuple[list[TraceEvent], str]],
        states: list[State],
        facts: list[tuple[str, str]],
        commands: list[Command],
        answers: list[Answer],
    ) -> None:
        for part, text in events:
            self._insert("events", len(part), len(part), text)
        for some in _parts(answers, MOST_EVENTS):
            self._insert("answers", len(some), len(some), json.dumps([plain_answer(answer) for answer in some]))
        for row in _parts(states, max(1, BLOB // len(states[0].data)) if states else 1):
            data = b"".join([state.data for state in row])
            marks = array("q", [mark for run, tick, state, events in row for mark in (run, tick, events, len(state))]).tobytes()
            self._insert("states", len(row), len(row), data, marks)
            self._written["ticks"] += sum(1 for state in row if state.tick)
        for command in commands:
            self._insert("commands", 1, *command)
        self._insert_facts(facts)
        self._seal(self._file, self._checksums)

    def _insert(self, table: str, count: int, *values: int | str | bytes) -> None:
        """Writes the next row of a table, in which there are so many things."""
        first = self._written[table]
        checksum = self._checksums.row(table, first, *values)
        self._file.execute(f"INSERT INTO {table} VALUES (?{', ?' * len(COLUMNS[table])})", (first, *values, checksum))
        self._written[table] = first + count

    def _insert_facts(self, facts: Sequence[tuple[str, str]]) -> None:
        for name, value in facts:
            self._file.execute("INSERT OR REPLACE INTO facts VALUES (?, ?)", (name, value))
            self._checksums.fact(name, value)

    def _seal(self, file: sqlite3.Connection, checksums: Checksums) -> None:
        """Writes the checksum of everything, and the seal of this installation."""
        checksum = checksums.whole()
        file.execute("INSERT OR REPLACE INTO seal VALUES (0, ?, ?)", (checksum, b"" if self._key is None else seal(self._key, checksum)))

    def _transact(self, work: Callable[..., None], *args: Any) -> None:
        self._file.execute("BEGIN")
        try:
            work(*args)
            self._file.execute("COMMIT")
            self._safe = dict(self._written)
        except sqlite3.Error:
            if self._file.in_transaction:
                self._file.execute("ROLLBACK")
            raise

    def _cut(self, kept: dict[str, int]) -> None:
        self._transact(self._delete_all, kept)

    def _delete_all(self, kept: dict[str, int]) -> None:
        for table in ("events", "answers"):
            last = self._delete(table, kept[table])
            if last is not None:
                things = json.loads(last[2])[: kept[table] - last[0]]
                self._insert(table, len(things), len(things), json.dumps(things, ensure_ascii=False))
        last = self._delete("states", kept["states"])
        if last is not None:
            first, _, data, marks, _ = last
            left = kept["states"] - first
            marks = marks[: MARKS * left]
            self._insert("states", left, left, data[: sum(array("q", marks)[3::4])], marks)
        self._written["ticks"] = max(0, kept["states"] - 1)
        self._delete("commands", kept["commands"])
        self._seal(self._file, self._checksums)

    def _delete(self, table: str, kept: int) -> Any:
        """Drops the rows beyond the first things of a table; returns the dropped row of which the first part is to be kept, if any."""
        execute = self._file.execute
        execute(f"DELETE FROM {table} WHERE first >= ?", (kept,))
        last = execute(f"SELECT * FROM {table} ORDER BY first DESC LIMIT 1").fetchone()
        if last is not None and table != "commands" and last[0] + last[1] > kept:
            execute(f"DELETE FROM {table} WHERE first = ?", (last[0],))
        else:
            last = None
        self._written[table] = kept if last is None else last[0]
        before = execute(f"SELECT checksum FROM {table} ORDER BY first DESC LIMIT 1").fetchone()
        self._checksums.begin(table, None if before is None else before[0])
        return last

    def _mark_as_left(self, copy: sqlite3.Connection) -> None:
        """Writes into a copy that the run was left where it ends, unless it was over there."""
        facts = dict(copy.execute("SELECT name, value FROM facts WHERE name IN ('ended', 'failed')"))
        if any(value != "null" for value in facts.values()):
            return
        ended = json.dumps({"by": LEFT})
        copy.execute("INSERT OR REPLACE INTO facts VALUES ('ended', ?)", (ended,))
        checksums = deepcopy(self._checksums)
        checksums.fact("ended", ended)
        self._seal(copy, checksums)

    def _finish(self) -> None:
        # In the old way of keeping a journal a closed file stands alone, and can be read in a folder that is read-only.
        self._file.execute("PRAGMA synchronous=OFF")
        try:
            self._file.execute("PRAGMA journal_mode=DELETE")
        except sqlite3.OperationalError as error:
            # Somebody reads it just now: it is whole all the same, and whoever closes it last removes what lies beside it.
            if error.sqlite_errorcode != sqlite3.SQLITE_BUSY:
                raise


def _remove(path: Path) -> None:
    """Removes a file, and those that SQLite keeps beside it."""
    for suffix in ("", "-journal", "-wal", "-shm"):
        with suppress(OSError, ValueError):
            path.with_name(f"{path.name}{suffix}").unlink(missing_ok=True)


def _reason(error: Exception) -> str:
    """Says why a file cannot be written."""
    if isinstance(error, FileExistsError):
        return "it exists already, and a recording does not replace what is there"
    if isinstance(error, OSError):
        return error.strerror or str(error)
    return "the disk is full" if "full" in str(error) else str(error)


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
