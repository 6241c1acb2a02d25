"""A recording that is read."""

from __future__ import annotations

import json
import sqlite3
from array import array
from collections.abc import Iterator
from itertools import chain
from pathlib import Path
from types import TracebackType
from typing import Any, NamedTuple, Self

from actr3d.errors import RecordingError
from actr3d.recording.form import FORM
from actr3d.recording.writer import Answer, State
from actr3d.trace import TraceEvent


class RecordedCommand(NamedTuple):
    """What a user did."""

    run: int
    """To which simulation; 1 of one that is recorded alone."""
    tick: int
    """After which tick."""
    data: dict[str, Any]


class Recorded:
    """Reads a recording, also one whose program was killed, or that is still being made.

    Args:
        path: The file.

    Raises:
        RecordingError: If there is no such file, or it is no recording.
    """

    def __init__(self, path: Path | str) -> None:
        self.path = Path(path)
        if not self.path.is_file():
            raise RecordingError(f"no recording '{path}'")
        try:
            # Where a killed program left a journal, reading the file takes writing it.
            self._file = sqlite3.connect(self.path.absolute(), isolation_level=None)
        except sqlite3.Error as error:
            raise RecordingError(f"cannot open the recording '{path}': {error}") from None
        try:
            self.facts: dict[str, Any] = {name: json.loads(value) for name, value in self._file.execute("SELECT name, value FROM facts")}
        except (sqlite3.Error, ValueError, TypeError) as error:
            self._file.close()
            raise RecordingError(f"'{path}' is no recording: {error}") from None
        if self.facts.get("form") != FORM:
            self._file.close()
            raise RecordingError(f"'{path}' is no recording of this form: it says {self.facts.get('form')!r}, this version reads {FORM!r}")

        missing = {"kind", "versions"} - self.facts.keys()
        if missing:
            self._file.close()
            raise RecordingError(f"'{path}' is no whole recording: it does not say its {' and '.join(sorted(missing))}")

    def check(self) -> None:
        """Looks through the whole file for damage, which would otherwise look like a difference.

        Raises:
            RecordingError: If there is any.
        """
        try:
            (found,) = self._file.execute("PRAGMA integrity_check(1)").fetchone()
            for _ in chain(self.events(), self.states(), self.answers(), self.commands()):
                pass
        except (sqlite3.Error, ValueError, TypeError) as error:
            found = str(error)
        if found != "ok":
            raise RecordingError(f"the recording '{self.path}' is damaged: {' '.join(found.split())}")

    @property
    def ticks(self) -> int:
        """How many whole ticks it holds, of all runs together."""
        if self.facts["kind"] == "simulation":
            return max(0, self._count("states") - 1)  # one run, and its start: no state need be read
        rows = self._file.execute("SELECT marks FROM states")
        return sum(1 for (marks,) in rows for tick in array("q", marks)[1::4] if tick)

    @property
    def event_count(self) -> int:
        """How many events it holds."""
        return self._count("events")

    @property
    def state_count(self) -> int:
        """How many states it holds, of all runs together; 0 of a program that makes no simulation."""
        return self._count("states")

    def _count(self, table: str) -> int:
        (count,) = self._file.execute(f"SELECT max(first + count) FROM {table}").fetchone()
        return count or 0

    def events(self) -> Iterator[TraceEvent]:
        """Yields every event."""
        for (text,) in self._file.execute("SELECT data FROM events ORDER BY first"):
            yield from (TraceEvent(*event) for event in json.loads(text))

    def states(self) -> Iterator[State]:
        """Yields the physics of each run at the start (tick 0), and at the end of each tick."""
        for data, marks in self._file.execute("SELECT data, marks FROM states ORDER BY first"):
            numbers, begin = iter(array("q", marks)), 0
            for run, tick, events, size in zip(numbers, numbers, numbers, numbers, strict=True):
                yield State(run, tick, data[begin : begin + size], events)
                begin += size

    def commands(self) -> Iterator[RecordedCommand]:
        """Yields what users did."""
        for run, tick, data in self._file.execute("SELECT run, tick, data FROM commands ORDER BY number"):
            yield RecordedCommand(run, tick, json.loads(data))

    def answers(self) -> Iterator[Answer]:
        """Yields what the bodies answered; the values are plain."""
        for (text,) in self._file.execute("SELECT data FROM answers ORDER BY first"):
            yield from (Answer(*answer) for answer in json.loads(text))

    def close(self) -> None:
        """Closes the file."""
        self._file.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None) -> None:
        self.close()
