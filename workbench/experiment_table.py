"""Reads the table of trials of an experiment: its columns and rows. It runs in workers, never in the server.

It reads the SQLite file itself, because `actr3d.experiment.store` loads what only experiments need.
"""

from __future__ import annotations

import json
import sqlite3
from collections.abc import Generator, Mapping, Sequence
from contextlib import closing
from pathlib import Path
from typing import Any

from actr3d.errors import Actr3dError
from actr3d.recording.opening import opened

MAX_COLUMNS = 1_000
MAX_NUMBERS = 400
"""Maximum number of values of a measure in one trial."""
MAX_TEXT = 20_000
"""Maximum length of a value of a row [characters]."""
NUMBERS = ("integer", "real", "boolean")
OUTSIDE = {"wall_s": "real", "worker": "text"}
"""Columns that are not part of the rows themselves, with their types."""
FIRST = ("trial", "participant", "group", "position", "repetition")
"""The columns before the values of a trial; those after its seed are measures."""
LAST = ("end", "error", "wall_s", "worker")


class TableError(Actr3dError):
    """The table of trials cannot be read as requested."""


def counts(*paths: Path) -> list[dict[str, Any]]:
    """Returns the numbers of finished and of failed trials of experiments, and their columns; `problem` says why a table cannot be read."""
    found: list[dict[str, Any]] = []
    for path in paths:
        try:
            with closing(_opened(path)) as file:
                (done,) = file.execute("SELECT count(*) FROM trial").fetchone()
                (failures,) = file.execute('SELECT count(*) FROM trial WHERE data LIKE \'%,"error":"%\'').fetchone()
                columns = [name for (name,) in file.execute("SELECT name FROM column ORDER BY place, name LIMIT ?", (MAX_COLUMNS,))]
                found.append({"done": done, "failures": failures, "problem": None, "columns": columns and [*columns, "wall_s"]})
        except (Actr3dError, sqlite3.Error) as error:
            found.append({"done": 0, "failures": 0, "problem": f"its table cannot be read: {error}", "columns": []})
    return found


def _opened(path: Path) -> sqlite3.Connection:
    """Returns a connection to a table of trials.

    A file from elsewhere may have a view in place of a table, and reading a view may never end; reading a table does.

    Raises:
        Actr3dError: If it cannot be opened, or is no table of trials.
    """
    file = opened(path)
    try:
        (tables,) = file.execute(
            "SELECT count(*) FROM sqlite_schema WHERE name IN ('trial', 'column') AND type = 'table' AND sql LIKE 'CREATE TABLE%'"
        ).fetchone()
        if tables != 2:
            raise TableError("it has other tables than an experiment")
    except BaseException:
        file.close()
        raise
    return file


class Table:
    """The table of trials of an experiment.

    Raises:
        Actr3dError: If it cannot be read.
    """

    def __init__(self, path: Path) -> None:
        try:
            self._file = _opened(path)
            listed = self._file.execute(
                "SELECT name, type, unit, meaning FROM column ORDER BY place, name LIMIT ?", (MAX_COLUMNS,)
            ).fetchall()
        except sqlite3.Error as error:
            raise TableError(f"the table of trials cannot be read: {error}") from None
        texts = [tuple("" if value is None else str(value) for value in row) for row in listed]
        self.columns = [{"name": n, "type": t, "unit": u or None, "meaning": m, "role": "value"} for n, t, u, m in texts if '"' not in n]
        names = [column["name"] for column in self.columns]
        seed = names.index("seed") if "seed" in names else -1
        for place, name in enumerate(names):
            self.columns[place]["role"] = "own" if name in (*FIRST, *LAST, "seed") else "measure" if place > seed else "value"
        self.columns += [
            {"name": n, "type": t, "unit": "s" if n == "wall_s" else None, "meaning": "", "role": "own"} for n, t in OUTSIDE.items()
        ]
        self._types = {str(column["name"]): str(column["type"]) for column in self.columns}

    def close(self) -> None:
        """Closes the file."""
        self._file.close()

    def rows(self, first: int, most: int, where: Mapping[str, Any], sort: str | None, *, down: bool, failed: bool) -> dict[str, Any]:
        """Returns rows, and how many there are.

        Args:
            first: How many are left out before.
            most: The maximum number.
            where: Values that the rows must have, by column.
            sort: The column by which they are sorted; None for the trial.
            down: Whether the largest comes first.
            failed: Whether only failed trials are returned.

        Raises:
            TableError: If there is no such column.
        """
        conditions = [f"{self.value(name)} IS ?" for name in where]
        conditions += ["json_extract(data, '$.error') IS NOT NULL"] * failed
        condition = f"WHERE {' AND '.join(conditions)}" if conditions else ""
        key = "number" if sort in (None, "trial") else self.value(str(sort))
        direction = "DESC" if down else "ASC"
        values = list(where.values())
        ((total,),) = self.select(f"SELECT count(*) FROM trial {condition}", values)
        found = self.select(
            f"SELECT number, data, wall_s, worker FROM trial {condition} ORDER BY {key} {direction}, number {direction} LIMIT ? OFFSET ?",
            [*values, most, first],
        )
        rows = [{**_row(data), "trial": number, "wall_s": wall, "worker": worker} for number, data, wall, worker in found]
        return {"total": total, "first": first, "columns": self.columns, "rows": rows}

    def __contains__(self, name: str) -> bool:
        return name in self._types

    def unit(self, name: str) -> str | None:
        """Returns the unit of a column."""
        return next((column["unit"] for column in self.columns if column["name"] == name), None)

    def numbered(self, measure: str, over: str | None) -> list[tuple[int, str]]:
        """Returns the columns of a measure, each with its number.

        Args:
            measure: The measure.
            over: The name of what it has a column for each number of, `measure_1`, `measure_2`, ...; None for one with one value a trial.

        Raises:
            TableError: If there are none, or they have no numbers.
        """
        if over is None:
            found = [(0, measure)]
            if self._types.get(measure) not in NUMBERS:
                raise TableError(f"'{measure}' has no numbers" if measure in self._types else f"there is no column '{measure}'")
            return found
        if over in self._types:
            raise TableError(f"over: must not be the name of a column of the trials (got '{over}')")
        ends = {name: name.removeprefix(f"{measure}_") for name in self._types if name.startswith(f"{measure}_")}
        found = sorted((int(end), name) for name, end in ends.items() if end.isascii() and end.isdigit() and len(end) < 9)
        found = [(number, name) for number, name in found if self._types[name] in NUMBERS][:MAX_NUMBERS]
        if not found:
            raise TableError(f"there are no columns '{measure}_1', '{measure}_2', ... with numbers")
        return found

    def value(self, name: str) -> str:
        """Returns the SQL for the value of a column.

        Raises:
            TableError: If there is no such column.
        """
        if name not in self._types:
            raise TableError(f"there is no column '{name}'")
        return name if name in OUTSIDE else f"json_extract(data, {json_path(name)})"

    def select(self, sql: str, values: Sequence[Any] = ()) -> Generator[Any]:
        """Yields what a query finds.

        Raises:
            TableError: If the file cannot be read.
        """
        try:
            yield from self._file.execute(sql, values)
        except (sqlite3.Error, OverflowError) as error:
            raise TableError(f"the table of trials cannot be read: {error}") from None


def json_path(name: str) -> str:
    """Returns the SQL for the place of a column in the JSON of a row."""
    path = f'$."{name}"'.replace("'", "''")
    return f"'{path}'"


def _row(data: str) -> dict[str, Any]:
    """Returns the values of a row.

    Raises:
        TableError: If they are not JSON.
    """
    try:
        found = json.loads(data)
    except (ValueError, RecursionError):
        found = None
    if not isinstance(found, dict):
        raise TableError("the table of trials is damaged")
    return {str(name): value if not isinstance(value, str) else value[:MAX_TEXT] for name, value in found.items()}  # pyright: ignore[reportUnknownVariableType, reportUnknownArgumentType]
