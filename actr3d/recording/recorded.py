"""A recording that is read."""

from __future__ import annotations

import json
import sqlite3
from collections.abc import Iterator
from pathlib import Path
from types import TracebackType
from typing import Any, NamedTuple, Self

from actr3d.errors import RecordingError
from actr3d.recording.form import FORM


class RecordedAnswer(NamedTuple):
    """What a body answered."""

    tick: int
    body: str
    word: str
    value: Any


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
            self._file = sqlite3.connect(self.path, isolation_level=None)
            self.facts: dict[str, Any] = {name: json.loads(value) for name, value in self._file.execute("SELECT name, value FROM facts")}
        except (sqlite3.Error, ValueError) as error:
            raise RecordingError(f"'{path}' is no recording: {error}") from None
        if self.facts.get("form") != FORM:
            raise RecordingError(f"'{path}' is no recording of this form: it says {self.facts.get('form')!r}, this version reads {FORM!r}")

    @property
    def ticks(self) -> int:
        """How many whole ticks it holds."""
        (last,) = self._file.execute("SELECT max(first + ticks - 1) FROM states").fetchone()
        return last or 0

    @property
    def event_count(self) -> int:
        """How many events it holds."""
        (count,) = self._file.execute("SELECT count(*) FROM events").fetchone()
        return count

    def event_lines(self, kind: str | None = None) -> Iterator[tuple[int, str]]:
        """Yields each event, or each of a kind, as a line of JSON, and after how many whole ticks it happened."""
        where, given = ("", ()) if kind is None else ("WHERE kind = ?", (kind,))
        yield from self._file.execute(f"SELECT tick, line FROM events {where} ORDER BY number", given)

    def states(self) -> Iterator[tuple[int, bytes]]:
        """Yields each tick and the bytes of the state at its end (`mjSTATE_INTEGRATION`); first tick 0, the start."""
        for first, ticks, data in self._file.execute("SELECT first, ticks, data FROM states ORDER BY first"):
            size = len(data) // ticks
            for number in range(ticks):
                yield first + number, data[number * size : (number + 1) * size]

    def commands(self) -> Iterator[tuple[int, dict[str, Any]]]:
        """Yields what the user did, and after which tick."""
        for tick, data in self._file.execute("SELECT tick, data FROM commands ORDER BY number"):
            yield tick, json.loads(data)

    def answers(self) -> Iterator[RecordedAnswer]:
        """Yields what the bodies answered."""
        for tick, body, word, value in self._file.execute("SELECT tick, body, word, value FROM answers ORDER BY number"):
            yield RecordedAnswer(tick, body, word, json.loads(value))

    def close(self) -> None:
        """Closes the file."""
        self._file.close()

    def __enter__(self) -> Self:
        return self

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None) -> None:
        self.close()
