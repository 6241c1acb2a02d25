"""The thread that writes a recording while the run continues."""

from __future__ import annotations

import errno
import json
import os
import sqlite3
from array import array
from collections import deque
from collections.abc import Callable, Sequence
from contextlib import closing, suppress
from copy import deepcopy
from pathlib import Path
from threading import Event, Lock, Thread
from typing import Any, NamedTuple

import msgspec

from actr3d.actr.kernel.run_limits import Contacts
from actr3d.actr.modules.answers import plain_answer
from actr3d.errors import RecordingError, reason_of
from actr3d.recording.checksums import Checksums
from actr3d.recording.facts import LEFT
from actr3d.recording.key import make_key, seal
from actr3d.recording.opening import COMPANIONS
from actr3d.recording.schema import COLUMNS, SCHEMA
from actr3d.replacing import creating
from actr3d.trace import TraceEvent
from actr3d.values import plain_to_json

FULL = "the disk is full"
GONE = "it was deleted, moved or replaced during the run"
INTERVAL = 0.25
"""The interval at which new items are written, besides on request [s of real time]; a killed run loses at most the items of one
interval."""
BLOB = 1_000_000
"""The approximate size of a row of states [bytes]."""
MAX_EVENTS = 10_000
"""The maximum number of events in a row."""
MARK_BYTES = 4 * 8
"""The size of the marks of a state [bytes]."""


class State(NamedTuple):
    """The physics state of a run at its start, or at the end of a tick."""

    run: int
    """The number of the simulation in the trace of its program; 1 if the simulation is recorded alone."""
    tick: int
    data: bytes
    """MuJoCo's `mjSTATE_INTEGRATION`, 8 bytes per number."""
    events: int
    """The number of events until then."""
    contacts: Contacts
    """What touched bodies in any physics step of the tick; contacts with floors are left out."""


class CommandRow(NamedTuple):
    """A user's command, as JSON."""

    run: int
    tick: int
    """The tick after which it was given."""
    text: str


class Answer(NamedTuple):
    """A body's answer."""

    run: int
    tick: int
    body: str
    word: str
    value: Any


class NoWriter:
    """A writer that discards everything, for forked copies of the process."""

    failure = None

    def __init__(self) -> None:
        self.events, self.answers, self.states, self.commands, self.facts = (deque[Any](maxlen=0) for _ in range(5))

    def flush(self) -> None:
        """Does nothing."""

    def cut(self, *_: int) -> None:
        """Does nothing."""

    def copy_to(self, path: Path, _: Sequence[tuple[str, str]] = ()) -> None:
        """Raises an error: a copy of the process does not have the data to be written.

        Raises:
            RecordingError: Always.
        """
        raise RecordingError(f"cannot write the recording '{path}': this is a forked copy of the process that records")

    def close(self) -> None:
        """Does nothing."""


class Writer:
    """Writes the items put into its queues to a new file, several times per second until closed; runs its own thread.

    Args:
        path: The new file.
        facts: The first rows of `facts`.

    Raises:
        RecordingError: If the file exists already, or cannot be created.
    """

    def __init__(self, path: Path, facts: Sequence[tuple[str, str]]) -> None:
        self.path = path
        self._absolute = path.absolute()  # the program may change its working directory
        self.failure: RecordingError | None = None
        """Why writing stopped; None while it works."""
        # One thread appends, another removes, and neither waits for the other.
        self.events: deque[TraceEvent] = deque()
        self.answers: deque[Answer] = deque()
        self.states: deque[State] = deque()
        self.commands: deque[CommandRow] = deque()
        self.facts: deque[tuple[str, str]] = deque()
        self._written = {"events": 0, "answers": 0, "states": 0, "ticks": 0, "commands": 0}
        """The number of items of each sort in the file, including those of the current transaction."""
        self._committed = dict(self._written)
        """The number of items of each sort that are committed."""
        self._created = False
        self._checksums = Checksums()
        self._key = make_key()
        self._writing = Lock()
        self._closing = Event()
        self._attempt(self._create, facts)
        if self.failure is not None:
            raise self.failure
        self._thread = Thread(target=self._run, name=f"recording {path.name}", daemon=True)
        self._thread.start()

    def flush(self) -> None:
        """Writes all items that it has received."""
        self._attempt(self._write)

    def cut(self, ticks: int, events: int, answers: int, commands: int) -> None:
        """Removes all but the first items of each sort: the run goes back to that point."""
        self.flush()
        self._attempt(self._transact, self._delete_all, {"states": ticks + 1, "events": events, "answers": answers, "commands": commands})

    def copy_to(self, path: Path, facts: Sequence[tuple[str, str]] = ()) -> None:
        """Writes all items that it has received, and a closed copy of everything to a new file.

        Args:
            path: The new file.
            facts: Facts of the copy alone.

        Raises:
            RecordingError: If that file exists, or either file cannot be written.
        """
        self.flush()
        with self._writing:
            if self.failure is not None:
                raise self.failure
            try:
                with creating(path) as part:
                    self._file.execute("VACUUM INTO ?", (str(part.absolute()),))
                    with closing(sqlite3.connect(part.absolute())) as copy, copy:
                        copy.execute("PRAGMA journal_mode=MEMORY")  # no other file beside an unfinished one
                        self._add_facts(copy, facts)
            except (sqlite3.Error, OSError, ValueError, MemoryError) as error:
                raise _unwritable(path, _reason(error)) from None

    def close(self) -> None:
        """Writes the remaining items and closes the file, which is then a single file without companions.

        Raises:
            RecordingError: If the file cannot be written.
        """
        self._closing.set()
        self._thread.join()
        if self.failure is not None:
            raise self.failure

    def _run(self) -> None:
        while not self._closing.wait(INTERVAL):
            self.flush()
        self.flush()
        self._attempt(self._finish)
        with suppress(sqlite3.Error):  # if the disk is full, SQLite leaves its journal, and reads it next time
            self._file.close()

    def _attempt(self, work: Callable[..., None], *args: Any) -> None:
        """Calls a function that works with the file; after a failure, only empties the queues."""
        with self._writing:
            if self.failure is not None:
                for queue in (self.events, self.answers, self.states, self.commands, self.facts):
                    queue.clear()
                return
            try:
                work(*args)
            except BaseException as error:
                # Items may be lost, whatever was raised: nothing may be written after a gap.
                reason = _reason(error)
                if self._created and not self._is_in_place():
                    self.failure = _unwritable(self.path, GONE, "; if you moved it, its new place holds the run up to now")
                else:
                    advice = "; make room on the disk, then run it again" if reason == FULL else ""
                    self.failure = _unwritable(self.path, reason, f"{self._kept_text()}{advice}")
                if not isinstance(error, Exception):
                    raise

    def _is_in_place(self) -> bool:
        """Returns whether the path still is that of the file that this writer has created."""
        try:
            status = self._absolute.stat()
        except (FileNotFoundError, NotADirectoryError):
            return False
        except OSError:  # the reason why the file cannot be written
            return True
        return (status.st_dev, status.st_ino) == self._identity

    def _kept_text(self) -> str:
        """Returns how much is kept of a recording that can no longer be written; removes the file if it has nothing of the run."""
        if not self._created:
            return ""
        if any(self._committed.values()):
            ticks, events = self._committed["ticks"], self._committed["events"]
            some = f"{ticks:,} ticks and {events:,} events" if ticks else f"{events:,} events"
            return f"; the first {some} of the run are kept, nothing of what came after"
        with suppress(sqlite3.Error, AttributeError):  # it may not have been opened
            self._file.close()
        _remove(self._absolute)
        return "; nothing was written"

    # -- the file

    def _create(self, facts: Sequence[tuple[str, str]]) -> None:
        with self.path.open("xb") as new:
            status = os.fstat(new.fileno())
        self._identity = status.st_dev, status.st_ino
        self._created = True
        # The absolute path, because SQLite gives names such as `:memory:` a special meaning.
        self._file = sqlite3.connect(self._absolute, isolation_level=None, check_same_thread=False)
        # The beginning and the end of a run do not wait for the disk, only for the system; the thread waits in between.
        self._file.execute("PRAGMA synchronous=OFF")
        # Others can read the file during the run, and what is committed survives if the program is killed.
        self._file.execute("PRAGMA journal_mode=WAL")
        self._transact(self._begin, facts)
        self._file.execute("PRAGMA synchronous=NORMAL")

    def _begin(self, facts: Sequence[tuple[str, str]]) -> None:
        for table in SCHEMA:
            self._file.execute(table)
        self._seal(self._file, self._checksums, facts)

    def _write(self) -> None:
        """Writes all items that it has received in one transaction."""
        # States first: all events up to them are then in the queue already.
        states, facts, commands = _all_of(self.states), _all_of(self.facts), _all_of(self.commands)
        answers, events = _all_of(self.answers), _all_of(self.events)
        if not (states or facts or commands or answers or events):
            return
        rows = [(part, _to_json(part, _event_to_json)) for part in _parts(events, MAX_EVENTS)]
        self._transact(self._insert_all, rows, states, facts, commands, answers)

    def _insert_all(
        self,
        events: list[tuple[list[TraceEvent], str]],
        states: list[State],
        facts: list[tuple[str, str]],
        commands: list[CommandRow],
        answers: list[Answer],
    ) -> None:
        for part, text in events:
            self._insert("events", len(part), len(part), text)
        for some in _parts(answers, MAX_EVENTS):
            self._insert("answers", len(some), len(some), _to_json([plain_answer(answer) for answer in some], json.dumps))
        for row in _parts(states, max(1, BLOB // len(states[0].data)) if states else 1):
            data = b"".join([state.data for state in row])
            marks = array("q", [mark for state in row for mark in (state.run, state.tick, state.events, len(state.data))]).tobytes()
            contacts = [(number, *contact, force) for number, state in enumerate(row) for contact, force in state.contacts.items()]
            self._insert("states", len(row), len(row), data, marks, json.dumps(contacts))
            self._written["ticks"] += sum(1 for state in row if state.tick)
        for command in commands:
            self._insert("commands", 1, *command)
        self._seal(self._file, self._checksums, facts)

    def _insert(self, table: str, count: int, *values: int | str | bytes) -> None:
        """Writes the next row of a table, with `count` items."""
        first = self._written[table]
        checksum = self._checksums.row(table, first, *values)
        self._file.execute(f"INSERT INTO {table} VALUES (?{', ?' * len(COLUMNS[table])})", (first, *values, checksum))
        self._written[table] = first + count

    def _seal(self, file: sqlite3.Connection, checksums: Checksums, facts: Sequence[tuple[str, str]] = ()) -> None:
        """Writes facts; then the checksum of everything, and the seal of this installation."""
        for name, value in facts:
            file.execute("INSERT OR REPLACE INTO facts VALUES (?, ?)", (name, value))
            checksums.fact(name, value)
        checksum = checksums.whole()
        file.execute("INSERT OR REPLACE INTO seal VALUES (0, ?, ?)", (checksum, b"" if self._key is None else seal(self._key, checksum)))

    def _transact(self, work: Callable[..., None], *args: Any) -> None:
        self._file.execute("BEGIN")
        try:
            work(*args)
            self._file.execute("COMMIT")
            self._committed = dict(self._written)
        except BaseException:
            if self._file.in_transaction:
                self._file.execute("ROLLBACK")
            raise

    def _delete_all(self, kept: dict[str, int]) -> None:
        for table in ("events", "answers"):
            last = self._delete(table, kept[table])
            if last is not None:
                things = json.loads(last[2])[: kept[table] - last[0]]
                self._insert(table, len(things), len(things), _to_json(things, json.dumps))
        last = self._delete("states", kept["states"])
        if last is not None:
            first, _, data, marks, contacts, _ = last
            left = kept["states"] - first
            marks = marks[: MARK_BYTES * left]
            contacts = [contact for contact in json.loads(contacts) if contact[0] < left]
            self._insert("states", left, left, data[: sum(array("q", marks)[3::4])], marks, json.dumps(contacts))
        self._written["ticks"] = max(0, kept["states"] - 1)
        self._delete("commands", kept["commands"])
        self._seal(self._file, self._checksums)

    def _delete(self, table: str, kept: int) -> Any:
        """Deletes the rows after the first `kept` items; returns a deleted row whose first items must be written again, if any."""
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

    def _add_facts(self, copy: sqlite3.Connection, facts: Sequence[tuple[str, str]]) -> None:
        """Adds facts to a copy. If the run has not ended by then, adds the fact `ended` with `by: left`."""
        over = copy.execute("SELECT 1 FROM facts WHERE name IN ('ended', 'failed') AND value != 'null'").fetchone()
        added = [*facts, *([] if over else [("ended", json.dumps({"by": LEFT}))])]
        self._seal(copy, deepcopy(self._checksums), added)

    def _finish(self) -> None:
        # With a rollback journal (DELETE mode), a closed file stands alone, and can be read in a read-only folder.
        self._file.execute("PRAGMA synchronous=OFF")
        try:
            self._file.execute("PRAGMA journal_mode=DELETE")
        except sqlite3.OperationalError as error:
            # Another program is reading the file: it is complete anyway, and the last one to close it removes its companions.
            if error.sqlite_errorcode != sqlite3.SQLITE_BUSY:
                raise


def _remove(path: Path) -> None:
    """Removes a file and the companion files of SQLite."""
    for suffix in ("", *COMPANIONS):
        with suppress(OSError, ValueError):
            path.with_name(f"{path.name}{suffix}").unlink(missing_ok=True)


def _unwritable(path: Path, reason: str, more: str = "") -> RecordingError:
    error = RecordingError(f"cannot write the recording '{path}': {reason}{more}")
    error.reason = reason
    return error


def _reason(error: BaseException) -> str:
    """Returns why a file cannot be written."""
    if isinstance(error, FileExistsError):
        return "it exists already, and a recording does not replace what is there"
    if isinstance(error, OSError):
        return FULL if error.errno == errno.ENOSPC else reason_of(error)
    if isinstance(error, (sqlite3.Error, ValueError)):
        return FULL if "full" in str(error) else str(error)
    return f"{type(error).__name__}: {error}".removesuffix(": ")


def _all_of(queue: deque[Any]) -> list[Any]:
    """Removes and returns all current items of a queue."""
    return [queue.popleft() for _ in range(len(queue))]


def _parts(things: list[Any], most: int) -> list[list[Any]]:
    return [things[start : start + most] for start in range(0, len(things), most)]


def _to_json(items: Sequence[Any], otherwise: Callable[[Any], str]) -> str:
    """Returns plain items as one JSON list; `otherwise` converts those that JSON cannot represent."""
    # The encoder also writes null for the numbers that JSON does not have.
    pairs = zip(items, _lines_of(items), strict=True)
    return f"[{','.join([otherwise(item) if line is None or 'null' in line else line for item, line in pairs])}]"


def _lines_of(items: Sequence[Any]) -> Sequence[str | None]:
    """Returns each item as JSON; None for those that the encoder cannot represent."""
    try:
        return _ENCODE_LINES(items).decode().split("\n")[:-1]
    except (TypeError, ValueError, RecursionError):
        return [None] if len(items) == 1 else [line for item in items for line in _lines_of([item])]


def _encoded_text(value: Any) -> str:
    """Returns the text of an object of a class derived from `str`."""
    return str.__str__(value)  # raises a TypeError for any other object


_ENCODE_LINES = msgspec.json.Encoder(enc_hook=_encoded_text).encode_lines
"""Ten times faster than Python's own encoder, but writes some numbers in another way: only for what is read back, not compared as text."""


def _event_to_json(event: TraceEvent) -> str:
    return plain_to_json(event, _converted)


def _converted(event: TraceEvent) -> str:
    """Returns an event as JSON; values that JSON cannot represent are converted as in `TraceEvent.to_json`."""
    return plain_to_json([event.time_us, event.source, event.kind, json.loads(event.to_json())["data"]])
