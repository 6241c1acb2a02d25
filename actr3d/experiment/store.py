"""The folder of an experiment: its specification, and an SQLite file with one row for each finished trial."""

from __future__ import annotations

import fcntl
import json
import os
import re
import sqlite3
from collections.abc import Generator, Iterable, Iterator, Mapping, Sequence
from contextlib import AbstractContextManager, closing, contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path
from socket import gethostname
from typing import Any, Self, cast

from actr3d.errors import ExperimentError, reason_of
from actr3d.experiment.specification import Specification
from actr3d.experiment.trial import Row
from actr3d.replacing import UNFINISHED, creating, replace_file
from actr3d.values import to_json

SPECIFICATION, FACTS, TRIALS, LOCK = "experiment.json", "facts.json", "trials.sqlite", "lock"
"""The names of the files in the folder."""
FRAME = ('  File "', "Traceback (most recent call last):")
"""How the lines of a traceback begin that come before its error."""
ROWS_AT_ONCE = 5_000
"""The number of rows that are read at a time."""
COLUMN_TYPES = ("null", "boolean", "integer", "real", "text")
"""The types of columns. A column with values of several types has the last of their types in this list, but `text` if some of the values
are True or False and others are not."""
UNITS = {
    "_m_s": "m/s",
    "_n_s": "N s",
    "_deg": "degrees",
    "_rad": "rad",
    "_cm": "cm",
    "_mm": "mm",
    "_ms": "ms",
    "_kg": "kg",
    "_m": "m",
    "_s": "s",
    "_j": "J",
}
"""The units of columns by the endings of their names; longer endings before their own endings."""
_SCHEMA = """
CREATE TABLE IF NOT EXISTS trial (number INTEGER PRIMARY KEY, data TEXT NOT NULL, versions TEXT NOT NULL, wall_s REAL, worker TEXT);
CREATE TABLE IF NOT EXISTS column (name TEXT PRIMARY KEY, place INTEGER, type TEXT NOT NULL, unit TEXT, meaning TEXT);
"""


@dataclass(frozen=True, kw_only=True)
class Column:
    """A column of the table of trials."""

    name: str
    type: str
    """`null` if it is empty, `boolean`, `integer`, `real` or `text`."""
    unit: str | None = None
    meaning: str = ""


@dataclass(frozen=True, kw_only=True)
class Finished:
    """A finished trial."""

    row: Row
    wall_s: float
    """Its duration [s]."""
    worker: str
    """The name of the worker that ran it."""


MEANINGS = {
    "trial": "The number of the trial, from 0.",
    "participant": "The simulated participant.",
    "group": "The participant's group.",
    "position": "The place of the trial among those of its participant, from 1.",
    "repetition": "The number of the trial among the participant's trials of the same levels, from 1; a random order need not follow it.",
    "seed": "The seed of all random choices in the trial.",
    "end": "What ended the trial.",
    "error": "The error of a trial that failed, with its traceback.",
}
"""The meanings of the columns that every experiment has."""

LAST = (
    Column(name="versions", type="text", meaning="The versions of the packages that ran the trial."),
    Column(name="wall_s", type="real", unit="s", meaning="The duration of the trial in real time; not reproducible."),
    Column(name="worker", type="text", meaning="The worker that ran the trial; not reproducible."),
)
"""The columns that follow those of a row. Source of the last two: the clock and the cluster."""
_LAST_NAMES = tuple(column.name for column in LAST)


class Store:
    """The folder of an experiment. Its table of trials is opened to read and write, or only to read if it cannot be written.

    Raises:
        ExperimentError: If the folder holds no experiment.
    """

    def __init__(self, folder: Path | str) -> None:
        self.folder = Path(folder)
        path = self.folder / SPECIFICATION
        try:
            for file in (path, self.folder / TRIALS, self.folder / LOCK):
                if file.is_fifo():  # opening it would wait for a program that writes to it
                    raise ExperimentError(f"'{self.folder}' holds no experiment: {file.name} is a pipe, not a file")
            text = path.read_text(encoding="utf-8")
        except (OSError, UnicodeDecodeError) as error:
            raise ExperimentError(f"'{self.folder}' holds no experiment: cannot read {SPECIFICATION} ({reason_of(error)})") from None
        self.specification = Specification.from_json(text, str(path))
        try:
            self._database = self._opened()
        except sqlite3.Error as error:
            raise ExperimentError(f"{self.folder / TRIALS}: cannot be opened ({error})") from None

    def _opened(self) -> sqlite3.Connection:
        """Opens the table of trials to write, or only to read where nothing can be written."""
        path = self.folder / TRIALS
        self._check_host()
        try:
            return _connected(path, f"PRAGMA journal_mode=WAL; PRAGMA synchronous=FULL; {_SCHEMA}")
        except sqlite3.OperationalError as error:
            if not path.is_file() or error.sqlite_errorcode & 0xFF not in (sqlite3.SQLITE_CANTOPEN, sqlite3.SQLITE_READONLY):
                raise
            # SQLite would make its log for every reader. Without a log, nobody writes the file.
            log = path.with_name(f"{path.name}-wal")
            options = "mode=ro" if log.exists() else "mode=ro&immutable=1"
            return _connected(f"{path.absolute().as_uri()}?{options}", "SELECT 1 FROM trial, column LIMIT 0")

    def _check_host(self) -> None:
        """Checks that no process on another computer writes: SQLite's log must not be shared by several.

        Raises:
            ExperimentError: If one does.
        """
        process = host = ""
        try:
            with (self.folder / LOCK).open(encoding="utf-8") as file:
                process, _, host = file.read().partition("\n")
                if host and host != gethostname():
                    fcntl.flock(file, fcntl.LOCK_SH | fcntl.LOCK_NB)
        except BlockingIOError:
            where = f"process {process} on the computer '{host}' writes it now"
            raise ExperimentError(f"'{self.folder}': {where}; use it there, or wait until that has ended") from None
        except OSError:  # there is no lock, or none that can be read: then nothing is known of another computer
            return

    @classmethod
    def create(cls, folder: Path | str, specification: Specification) -> Store:
        """Creates the folder of a new experiment.

        Raises:
            ExperimentError: If the folder is not empty, or cannot be made.
        """
        path, text = Path(folder), specification.to_json()
        try:
            if path.exists() and not path.is_dir():
                raise ExperimentError(f"--out: '{path}' is a file; name a new folder")
            path.mkdir(parents=True, exist_ok=True)
            if not all(UNFINISHED.fullmatch(file.name) for file in path.iterdir()):
                there = (path / SPECIFICATION).exists()
                what = "holds an experiment already; continue it with --resume, or" if there else "is not empty;"
                raise ExperimentError(f"--out: '{path}' {what} name a new folder")
            with creating(path / SPECIFICATION) as part:
                part.write_text(text, encoding="utf-8")
            _sync(path)
        except FileExistsError:
            raise ExperimentError(f"--out: '{path}' holds an experiment already; continue it with --resume, or name a new folder") from None
        except OSError as error:
            raise ExperimentError(f"--out: cannot make '{path}' ({reason_of(error)})") from None
        return cls(path)

    def close(self) -> None:
        """Closes the file."""
        self._database.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, *_: object) -> None:
        self.close()

    # -- writing

    def write_facts(self, facts: Mapping[str, Any]) -> None:
        """Writes what other programs show of the experiment without loading its code.

        Raises:
            ExperimentError: If the file cannot be written.
        """
        write_whole(self.folder / FACTS, to_json(facts))

    def only_writer(self) -> AbstractContextManager[None]:
        """Makes this process the only one that adds rows, inside the block.

        Raises:
            ExperimentError: If another process runs this experiment, or the folder cannot be written.
        """
        return only_process(self.folder, "this experiment")

    def add(self, finished: Iterable[Finished], versions: str, about: dict[str, dict[str, str | None]] | None = None) -> int:
        """Adds rows in one transaction; a trial that has a row keeps it. Returns the number of new rows.

        Args:
            finished: The trials.
            versions: The versions of the packages that ran them.
            about: Units and meanings of columns; see `Experiment.about`. A column that is given no unit has that of its name's ending.

        Raises:
            ExperimentError: If the file cannot be written.
        """
        rows: list[tuple[int, str, str, float, str]] = []
        columns: dict[str, tuple[int, str]] = {}
        for one in finished:
            for place, (name, value) in enumerate(one.row.items()):
                before = columns.get(name, (place, "null"))
                columns[name] = min(before[0], place), _joined(before[1], _type_of(value))
            data = json.dumps(one.row, ensure_ascii=True, allow_nan=False, separators=(",", ":"))
            rows.append((one.row["trial"], data, versions, one.wall_s, one.worker))
        database = self._database
        try:
            database.execute("BEGIN IMMEDIATE")
            try:
                count = database.executemany("INSERT OR IGNORE INTO trial VALUES (?, ?, ?, ?, ?)", rows).rowcount
                self._describe(columns, about or {})
                database.execute("COMMIT")
            except BaseException:
                if database.in_transaction:
                    database.execute("ROLLBACK")
                raise
        except sqlite3.Error as error:
            raise ExperimentError(f"{self.folder / TRIALS}: cannot write ({error}); the rows before are kept") from None
        return count

    def _describe(self, columns: dict[str, tuple[int, str]], about: dict[str, dict[str, str | None]]) -> None:
        """Stores new columns, and new types of columns; the result does not depend on the order of the rows."""
        stored = self._database.execute("SELECT name, place, type, unit FROM column")
        known = {name: (place, kind, unit) for name, place, kind, unit in stored}
        for name, (place, kind) in columns.items():
            was = known.get(name, (place, "null", None))
            says = about.get(name, {})
            unit = says.get("unit") or was[2] or _unit_of(name)
            entry = min(was[0], place), _joined(was[1], kind), unit
            if name not in known or entry != was:
                self._database.execute("INSERT OR REPLACE INTO column VALUES (?, ?, ?, ?, ?)", (name, *entry, says.get("meaning") or ""))

    # -- reading

    @property
    def count(self) -> int:
        """The number of finished trials."""
        return self._database.execute("SELECT count(*) FROM trial").fetchone()[0]

    @property
    def failures(self) -> int:
        """The number of finished trials that failed."""
        # A row that is no JSON is found by those who read it.
        failed = "CASE WHEN json_valid(data) THEN json_extract(data, '$.error') END"
        return self._database.execute(f"SELECT count({failed}) FROM trial").fetchone()[0]

    def missing(self, total: int) -> Iterator[int]:
        """Yields the numbers of those trials of a design with `total` trials that have no row, in order."""
        done = bytearray(total)
        for (number,) in self._database.execute("SELECT number FROM trial"):
            if isinstance(number, int) and 0 <= number < total:
                done[number] = 1
        return (number for number in range(total) if not done[number])

    @property
    def columns(self) -> tuple[Column, ...]:
        """The columns of the table of trials, in order."""
        found = self._database.execute("SELECT name, type, unit, meaning FROM column ORDER BY name = 'end' OR name = 'error', place, name")
        return (*(Column(name=n, type=t, unit=u, meaning=m or MEANINGS.get(n, "")) for n, t, u, m in found), *LAST)

    def rows(self, after: int = -1) -> Iterator[Row]:
        """Yields the rows of all trials after a number, in order, also those that are added meanwhile."""
        names = self._names
        while found := self._read("number > ? ORDER BY number LIMIT ?", (after, ROWS_AT_ONCE)):
            yield from (self._row(one, names) for one in found)
            after = found[-1][0]

    def row(self, number: int) -> Row | None:
        """Returns the row of a trial; None if it has not finished."""
        return next((self._row(one, self._names) for one in self._read("number = ?", (number,))), None)

    @property
    def _names(self) -> list[str]:
        """The names of the columns before `LAST`."""
        return [column.name for column in self.columns[: -len(LAST)]]

    def _read(self, where: str, values: Sequence[Any]) -> list[Any]:
        columns = ", ".join(("number", "data", *_LAST_NAMES))
        try:
            with closing(self._database.execute(f"SELECT {columns} FROM trial WHERE {where}", values)) as cursor:
                return cursor.fetchall()
        except sqlite3.Error as error:
            raise ExperimentError(f"{self.folder / TRIALS}: is damaged ({error})") from None

    def _row(self, found: Sequence[Any], names: Sequence[str]) -> Row:
        """Returns a row of the table of trials.

        Args:
            found: The trial's number, its row as JSON, and the columns `LAST`.
            names: The names of the columns before `LAST`.

        Raises:
            ExperimentError: If it is no JSON object.
        """
        number, data, *others = found
        try:
            row = json.loads(data)
        except (ValueError, TypeError, RecursionError):
            row = None
        if not isinstance(row, dict):
            raise ExperimentError(f"{self.folder / TRIALS}: is damaged (the row of trial {number!r} is no JSON object)")
        known = cast("Row", row)
        return {**{name: known.get(name) for name in names}, **dict(zip(_LAST_NAMES, others, strict=True))}


@contextmanager
def only_process(folder: Path, what: str) -> Generator[None]:
    """Makes this process the only one that writes to a folder, inside the block.

    Args:
        folder: The folder.
        what: What runs there, for the error.

    Raises:
        ExperimentError: If another process does, or the folder cannot be written.
    """
    try:
        file = (folder / LOCK).open("a+", encoding="utf-8")
    except OSError as error:
        raise ExperimentError(f"'{folder}': cannot be written ({reason_of(error)})") from None
    with file:
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
        except OSError:
            file.seek(0)
            process, _, host = file.read().partition("\n")
            where = f"{process} on '{host}'" if host and host != gethostname() else process
            raise ExperimentError(f"'{folder}': another process ({where}) runs {what}") from None
        with suppress(OSError):  # only the number of the process and its computer, for errors, are lost if the disk is full
            file.truncate(0)
            os.write(file.fileno(), f"{os.getpid()}\n{gethostname()}".encode())
        yield


def write_whole(path: Path, text: str) -> None:
    """Writes a text file; see `replace_file`.

    Raises:
        ExperimentError: If it cannot be written.
    """
    try:
        replace_file(path, text.encode())
    except OSError as error:
        raise ExperimentError(f"'{path}': cannot be written ({reason_of(error)})") from None


def _unit_of(name: str) -> str | None:
    """Returns the unit that the name of a column ends with, also that of a numbered one, such as `latency_s_1`; None if there is none."""
    bare = re.sub(r"_[0-9]+$", "", name)
    return next((unit for ending, unit in UNITS.items() if bare.endswith(ending)), None)


def _sync(folder: Path) -> None:
    """Waits until the names in a folder are on the disk."""
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def _connected(path: Path | str, script: str) -> sqlite3.Connection:
    """Returns a connection to a file, or to the file of a URI, in which a script has run."""
    database = sqlite3.connect(path, timeout=30, isolation_level=None, check_same_thread=False, uri=isinstance(path, str))
    try:
        database.executescript(script)
    except BaseException:
        database.close()
        raise
    return database


def _type_of(value: Any) -> str:
    match value:
        case None:
            return "null"
        case bool():
            return "boolean"
        case int():
            return "integer"
        case float():
            return "real"
        case _:
            return "text"


def _joined(one: str, other: str) -> str:
    """Returns the type of a column that holds values of two types."""
    if "boolean" in (one, other) and not {one, other} <= {"null", "boolean"}:
        return "text"
    return max(one, other, key=COLUMN_TYPES.index)


def summary(error: str) -> str:
    """Returns the line of a trial's traceback that names the error; more lines of its message, and notes, may follow it."""
    lines = error.strip().splitlines()
    frames = [number for number, line in enumerate(lines) if line.startswith(FRAME)]
    return next((line for line in lines[frames[-1] + 1 if frames else 0 :] if line and not line[0].isspace()), lines[-1])
