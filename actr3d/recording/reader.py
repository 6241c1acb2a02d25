"""Reads a recording."""

from __future__ import annotations

import hmac
import json
import sqlite3
from array import array
from collections import defaultdict
from collections.abc import Generator, Iterator, Mapping
from contextlib import closing, contextmanager
from math import isfinite
from pathlib import Path
from types import TracebackType
from typing import Any, NamedTuple, Self, cast

from actr3d.actr.kernel.run_limits import Contacts
from actr3d.errors import RecordingError
from actr3d.notebook import show_in_notebook
from actr3d.recording.checksums import Checksums
from actr3d.recording.facts import LARGEST, LEFT, SAME_AS, check_facts, is_of_simulation
from actr3d.recording.key import is_sealed
from actr3d.recording.opening import opened
from actr3d.recording.schema import COLUMNS, FORMAT, SCHEMA
from actr3d.recording.writer import Answer, State
from actr3d.trace import TraceEvent
from actr3d.values import shortened

SHOWN = 80
"""The maximum length of a quote from a damaged recording in an error message [characters]."""
OPENING_STEPS = 100_000
"""The maximum number of SQLite steps to open a recording, which usually takes a few thousand; a file that needs more is rejected."""
PAGE_STEPS = 1_000
"""How many more are allowed for each page of the file: a program that makes many simulations records many facts."""


class RecordedCommand(NamedTuple):
    """A user's command."""

    run: int
    """The number of its simulation; 1 if the simulation was recorded alone."""
    tick: int
    """The tick after which it was given."""
    data: dict[str, Any]


class Recorded:
    """Reads a recording in its present state, also if its program was killed, or if it is still being written.

    Runs nothing that the recording contains. Does not read what is added later: open the file again for that.

    Args:
        path: The file.

    Raises:
        RecordingError: If there is no such file, or it is not a recording of this format.
    """

    def __init__(self, path: Path | str) -> None:
        self.path = Path(path)
        self._made_here: bool | None = None
        self._closed = False
        self._file = opened(self.path)
        try:
            self._written_facts = self._begin()
            self.facts = _resolved({name: _parsed(value) for name, value in self._written_facts.items()})
            check_facts(self.facts)
        except (sqlite3.Error, ValueError, TypeError, RecursionError, RecordingError) as error:
            self._file.close()
            raise RecordingError(f"'{path}' is not a recording: {_words(error)}") from None

    def _begin(self) -> dict[str, str]:
        """Starts a read transaction on the file, which may be written meanwhile; returns the facts as JSON texts.

        Rejects a file that only looks like a recording, for example with a view in place of a table: whatever it could make
        SQLite do does not happen.

        Raises:
            RecordingError: If it is not a recording of this format.
        """
        self._file.set_progress_handler(lambda: 1, OPENING_STEPS)
        self._file.execute("BEGIN")
        schema = self._file.execute("SELECT sql FROM sqlite_schema").fetchmany(100)
        if (SCHEMA[0],) not in schema:
            raise RecordingError("it has other tables than a recording")
        (pages,) = self._file.execute("PRAGMA page_count").fetchone()
        self._file.set_progress_handler(lambda: 1, OPENING_STEPS + PAGE_STEPS * pages)
        facts: dict[str, str] = {}
        for name, value in self._file.execute("SELECT name, value FROM facts"):
            if type(name) is not str or type(value) is not str or (facts and name <= next(reversed(facts))):
                raise RecordingError("its facts are damaged")
            facts[name] = value
        version = _parsed(facts["form"]) if "form" in facts else None
        if version != FORMAT:
            raise RecordingError(f"it has another format: it says {_short(version)}, this version reads {FORMAT!r}")
        if sorted(schema) != sorted((table,) for table in SCHEMA):
            raise RecordingError("it has other tables than a recording")
        self._file.set_progress_handler(None, 0)
        return facts

    @property
    def made_here(self) -> bool:
        """Whether this installation made the recording, and it was not changed since; its code was then run here before.

        Reads the whole file once to find out; runs nothing.

        Raises:
            RecordingError: If the file is damaged.
        """
        if self._made_here is None:
            self.check()
        return bool(self._made_here)

    def check(self) -> None:
        """Reads the whole file and compares its checksums.

        Raises:
            RecordingError: If it is damaged, or was changed.
        """
        checksums = Checksums()
        for name, value in self._written_facts.items():
            checksums.fact(name, value)
        with self._reading():
            for things in (self.events(), self.states(), self.answers(), self.commands()):
                for _ in things:
                    pass
            for table in COLUMNS:
                last = self._file.execute(f"SELECT checksum FROM {table} ORDER BY first DESC LIMIT 1").fetchone()
                checksums.begin(table, None if last is None else last[0])
            seals = self._file.execute("SELECT * FROM seal LIMIT 2").fetchall()
            if len(seals) != 1 or seals[0][0] != 0 or _types(*seals[0]) != (int, bytes, bytes):
                raise ValueError("it has no checksum")
            _, checksum, seal = seals[0]
            if not hmac.compare_digest(checksums.whole(), checksum):
                raise ValueError("its facts or its last rows are not those that were written (wrong checksum)")
            self._made_here = is_sealed(checksum, seal)

    @property
    def over(self) -> bool:
        """Whether the run ended: the user did not leave it before its end, and it did not fail."""
        ended = self.facts.get("ended")
        return ended is not None and ended["by"] != LEFT

    @property
    def failed(self) -> bool:
        """Whether the run failed; the recording then holds everything until that."""
        return self.facts.get("failed") is not None

    @property
    def finished(self) -> bool:
        """Whether the run ended or failed; False if the user left it before."""
        return self.over or self.failed

    @property
    def closed(self) -> bool:
        """Whether the recording ends with the end of the run or between two ticks; False if the run failed or was killed within a tick."""
        return self.facts.get("ended") is not None or bool(self.facts.get("whole"))

    @property
    def ticks(self) -> int:
        """The number of complete ticks, of all runs together."""
        if self.facts["kind"] == "simulation":
            return max(0, self._count("states") - 1)  # one run, and its start: no state needs to be read
        return sum(1 for state in self.states() if state.tick)

    @property
    def event_count(self) -> int:
        """The number of events."""
        return self._count("events")

    @property
    def state_count(self) -> int:
        """The number of states, of all runs together; 0 for a program that makes no simulation."""
        return self._count("states")

    def _count(self, table: str) -> int:
        with self._reading():
            last = self._file.execute(f"SELECT first, count FROM {table} ORDER BY first DESC LIMIT 1").fetchone()
            return 0 if last is None else int(last[0]) + int(last[1])

    def events(self) -> Iterator[TraceEvent]:
        """Yields every event.

        Raises:
            RecordingError: If the file is damaged; this holds for all methods that read its rows.
        """
        return (TraceEvent(*thing) for thing in self._things("events", 4, (int, str, str, dict)))

    def last_events(self) -> list[str]:
        """Returns the last two rows of events as JSON lists, without parsing them or comparing their checksums."""
        with self._reading():
            rows = self._file.execute("SELECT data FROM events ORDER BY first DESC LIMIT 2").fetchall()
            return [text for (text,) in reversed(rows)]

    def answers(self) -> Iterator[Answer]:
        """Yields the answers of the bodies, as plain values."""
        return (Answer(*thing) for thing in self._things("answers", 5, (int, int, str, str)))

    def states(self) -> Iterator[State]:
        """Yields the physics state of each run at the start (tick 0), and at the end of each tick, with the contacts in that tick."""
        with self._reading():
            for count, data, marks, contacts in self._rows("states"):
                numbers = array("q", marks)
                if len(numbers) != 4 * count or min(numbers) < 0 or sum(numbers[3::4]) != len(data):
                    raise ValueError("the marks of its states do not fit them")
                touching, each, begin = _contacts(contacts, count), iter(numbers), 0
                for number, (run, tick, events, size) in enumerate(zip(each, each, each, each, strict=True)):
                    yield State(run, tick, data[begin : begin + size], events, touching.get(number, {}))
                    begin += size

    def commands(self) -> Iterator[RecordedCommand]:
        """Yields the users' commands."""
        with self._reading():
            for run, tick, text in self._rows("commands"):
                data = _parsed(text)
                if run < 1 or tick < 0 or not _is_command(data):
                    raise ValueError(f"{_short(data)} is not a command")
                yield RecordedCommand(run, tick, data)

    def _things(self, table: str, size: int, kinds: tuple[type, ...]) -> Iterator[list[Any]]:
        """Yields the items in the rows of a table: lists of `size` values, the first of which have the types `kinds`."""
        with self._reading():
            for count, text in self._rows(table):
                things = _parsed(text)
                if len(things) != count:
                    raise ValueError(f"a row of its {table} has {len(things)} where it says {count}")
                for thing in things:
                    if len(thing) != size or _types(*thing[: len(kinds)]) != kinds or abs(thing[0]) >= LARGEST:
                        raise ValueError(f"{_short(thing)} is not one of its {table}")
                    yield thing

    def _rows(self, table: str) -> Iterator[tuple[Any, ...]]:
        """Yields the rows of a table, without item numbers and checksums, after comparing both."""
        checksums, due = Checksums(), 0
        for row in self._file.execute(f"SELECT * FROM {table} ORDER BY first"):
            first, *values, checksum = row
            if _types(first, *values) != COLUMNS[table]:
                raise ValueError(f"a row of its {table} has values of other types")
            count = 1 if table == "commands" else values[0]
            if first != due or count < 1:
                raise ValueError(f"its {table} are not numbered in order")
            if checksums.row(table, first, *values) != checksum:
                raise ValueError(f"its {table} from {first:,} on are not those that were written (wrong checksum)")
            due = first + count
            yield tuple(values)

    @contextmanager
    def _reading(self) -> Generator[None]:
        """Raises every error that occurs in the block while the file is read as a `RecordingError`."""
        try:
            yield
        except (sqlite3.Error, ValueError, TypeError, KeyError, IndexError, OverflowError, RecursionError) as error:
            if self._closed:
                raise RecordingError(f"the recording '{self.path}' is closed; open it again") from None
            raise RecordingError(f"the recording '{self.path}' is damaged: {_words(error)}") from None

    def copy_to(self, path: Path) -> None:
        """Writes a copy to a new file.

        Raises:
            RecordingError: If it cannot be written.
        """
        try:
            with closing(sqlite3.connect(path)) as copy:
                self._file.backup(copy)
        except sqlite3.Error as error:
            raise RecordingError(f"the recording '{self.path}' cannot be copied: {error}") from None

    def show(self, *, trust: bool = False, height: int = 560) -> Any:
        """Returns a widget that shows the recorded run in a notebook: scene, timeline and buffers at any of its times.

        For this, the run is repeated. A recording whose code must not be run, or that does not hold the file of its model, is
        only played: scene and trace.

        Args:
            trust: Whether its code may be run although this installation did not make the recording.
            height: Height of the widget [px].

        Raises:
            NotebookError: If the packages for notebooks are not installed, or this is not a notebook.
        """
        return show_in_notebook(self, trust=trust, height=height)

    def close(self) -> None:
        """Closes the file; nothing more can be read from it."""
        self._closed = True
        self._file.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None) -> None:
        self.close()


def _parsed(text: str) -> Any:
    """Returns the value of a JSON text.

    Raises:
        ValueError: If it is not JSON, or is nested too deeply.
    """
    try:
        return json.loads(text)
    except RecursionError:
        raise ValueError("something in it is nested too deeply") from None


def _resolved(facts: dict[str, Any]) -> dict[str, Any]:
    """Returns facts in which each simulation has its own scene, also if another one has the same."""

    def resolved(name: str, value: Any) -> Any:
        if not is_of_simulation(name) or not isinstance(value, dict):
            return value
        return facts.get(cast("dict[str, Any]", value).get(SAME_AS, name), cast("Any", value))

    return {name: resolved(name, value) for name, value in facts.items()}


def _contacts(text: str, count: int) -> Mapping[int, Contacts]:
    """Returns the contacts of the states in a row by the number of the state, which is below `count`.

    Raises:
        ValueError: If something is not a contact.
    """
    found: defaultdict[int, dict[tuple[str, str, str], float]] = defaultdict(dict)
    for contact in _parsed(text):
        if _types(*contact) != (int, str, str, str, float) or not 0 <= contact[0] < count or not isfinite(contact[4]):
            raise ValueError(f"{_short(contact)} is not one of its contacts")
        number, body, part, other, force = contact
        found[number][body, part, other] = force
    return found


def _is_command(data: Any) -> bool:
    """Returns whether a value has the structure that `actr3d.simulation.Command.to_data` returns."""
    if not isinstance(data, dict):
        return False
    command = cast("dict[str, Any]", data)
    given: Any = command.get("data")
    if not isinstance(given, dict):
        return False
    values = cast("dict[str, Any]", given)
    types = _types(command.get("command"), values.get("values"), values.get("named"))
    return types == (str, list, dict) and "body" in values and isinstance(values["body"], (str, type(None)))


def _types(*values: object) -> tuple[type, ...]:
    return tuple(type(value) for value in values)


def _short(value: Any) -> str:
    """Returns a value as a text of limited length."""
    try:
        text = repr(value)
    except RecursionError:
        text = f"a {type(value).__name__}"
    return shortened(text, SHOWN)


def _words(error: Exception) -> str:
    if getattr(error, "sqlite_errorcode", None) == sqlite3.SQLITE_NOTADB:
        return "it is a file of another kind, or damaged"
    return " ".join(str(error).split()) or type(error).__name__
