"""Reads the table of trials of an experiment: columns, rows and means. It runs in workers, never in the server.

It reads the SQLite file itself, because `actr3d.experiment.store` loads what only experiments need.
"""

from __future__ import annotations

import json
import math
import sqlite3
from collections import defaultdict
from collections.abc import Mapping, Sequence
from contextlib import closing
from pathlib import Path
from statistics import fmean
from typing import Any

from actr3d.errors import Actr3dError
from actr3d.recording.opening import opened

MAX_COLUMNS = 1_000
MAX_CELLS = 50_000
"""Maximum number of means of participants."""
MAX_POINTS = 2_000
"""Maximum number of points of a figure."""
MAX_NUMBERS = 400
"""Maximum number of values of a measure in one trial."""
MAX_TEXT = 20_000
"""Maximum length of a value of a row [characters]."""
NUMBERS = ("integer", "real", "boolean")
NUMERIC = "typeof(value) IN ('integer', 'real')"
"""The SQL for whether a trial has a value of the measure."""
OUTSIDE = {"wall_s": "real", "worker": "text"}
"""Columns that are not part of the rows themselves, with their types."""
FIRST = ("trial", "participant", "group", "position", "repetition")
"""The columns before the values of a trial; those after its seed are measures."""
LAST = ("end", "error", "wall_s", "worker")


class TableError(Actr3dError):
    """The table of trials cannot be read as requested."""


def counts(*paths: Path) -> list[dict[str, Any]]:
    """Returns the numbers of finished and of failed trials of experiments, and their columns; `problem` says why a table cannot be read.

    Args:
        paths: The tables.
    """
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

    Args:
        path: The SQLite file.
        fixed: The values of parameters by name, for those that are no columns, as all trials have the same.

    Raises:
        Actr3dError: If it cannot be read.
    """

    def __init__(self, path: Path, fixed: Mapping[str, Any] | None = None) -> None:
        self.fixed = fixed or {}
        try:
            self._file = _opened(path)
            listed = self._file.execute(
                "SELECT name, type, unit, meaning FROM column ORDER BY place, name LIMIT ?", (MAX_COLUMNS,)
            ).fetchall()
        except sqlite3.Error as error:
            raise TableError(f"the table of trials cannot be read: {error}") from None
        texts = [tuple("" if value is None else str(value) for value in row) for row in listed]
        self.columns = [{"name": n, "type": t, "unit": u or None, "meaning": m, "role": "value"} for n, t, u, m in texts if '"' not in n]
        self._give_roles()
        self._types = {str(column["name"]): str(column["type"]) for column in self.columns}

    def _give_roles(self) -> None:
        """Distinguishes measures from the values of a trial."""
        names = [column["name"] for column in self.columns]
        seed = names.index("seed") if "seed" in names else -1
        for place, column in enumerate(self.columns):
            name = column["name"]
            column["role"] = "own" if name in (*FIRST, *LAST, "seed") else "measure" if place > seed else "value"
        self.columns += [
            {"name": n, "type": t, "unit": "s" if n == "wall_s" else None, "meaning": "", "role": "own"} for n, t in OUTSIDE.items()
        ]

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
        conditions = [f"{self._value(name)} IS ?" for name in where]
        conditions += ["json_extract(data, '$.error') IS NOT NULL"] * failed
        condition = f"WHERE {' AND '.join(conditions)}" if conditions else ""
        key = "number" if sort in (None, "trial") else self._value(str(sort))
        direction = "DESC" if down else "ASC"
        values = list(where.values())
        (total,) = self._read(f"SELECT count(*) FROM trial {condition}", values)[0]
        found = self._read(
            f"SELECT number, data, wall_s, worker FROM trial {condition} ORDER BY {key} {direction}, number {direction} LIMIT ? OFFSET ?",
            [*values, most, first],
        )
        rows = [{**_row(data), "trial": number, "wall_s": wall, "worker": worker} for number, data, wall, worker in found]
        return {"total": total, "first": first, "columns": self.columns, "rows": rows}

    def means(
        self, x: str, by: Sequence[str], measure: str, over: str | None = None, among: tuple[Sequence[str], Sequence[str]] | None = None
    ) -> dict[str, Any]:
        """Returns the mean of a measure for each combination of values: the mean of the participants' means, with its standard error.

        Args:
            x: The column along the axis.
            by: The columns whose combinations are the lines.
            measure: The column that is averaged; of True and False, the share of True.
            over: The name of a further column with the number of a value, for a measure that has a column for each number; None for
                one with one value a trial.
            among: Columns that make a condition, and those combinations of `x`, `by` and them that are averaged, as `combinations`
                returns them; then all conditions weigh the same at each place. None for all trials as they are.

        Raises:
            TableError: If there is no such column, the measure has no numbers, or there are too many points.
        """
        columns = self._numbered(measure, over)
        keys = [x, *by]
        wanted = ", ".join(part for name in keys for part in self._value_and_kind(name, over))
        of_condition, kept = among or ((), ())
        where = "" if among is None else f" AND {self._combination([*keys, *of_condition], over)} IN (SELECT value FROM json_each(?))"
        apart = ", ".join(str(n + 1) for n in range(2 * len(keys) + 2))
        sql = (
            f"SELECT {wanted}, {self._combination(of_condition, over)}, json_extract(data, '$.participant'), count(*), avg(value) "
            f"FROM ({self._values(columns)}) WHERE {NUMERIC}{where} GROUP BY {apart} LIMIT ?"
        )
        found = self._read(sql, [*([] if among is None else [json.dumps(kept)]), MAX_CELLS + 1])
        cells: dict[tuple[Any, ...], list[tuple[Any, Any, int, float]]] = defaultdict(list)
        for row in found:
            key = tuple((row[2 * n], row[2 * n + 1]) for n in range(len(keys)))
            cells[key].append(row[2 * len(keys) :])
        if len(found) > MAX_CELLS or len(cells) > MAX_POINTS:
            raise TableError(f"{' and '.join(keys)} have too many different values for a figure")
        points = [{"at": [_typed(*part) for part in key], **_mean(parts)} for key, parts in cells.items()]
        unit = next((column["unit"] for column in self.columns if column["name"] == columns[0][1]), None)
        return {"x": x, "by": list(by), "measure": measure, "unit": unit, "columns": self.columns, "points": points}

    def combinations(self, names: Sequence[str], measure: str, over: str | None = None) -> dict[str, int]:
        """Returns the numbers of values of a measure by combination of values of columns: a JSON list of the type and value of each.

        Args:
            names: The columns; the type of one that the table does not have is null.
            measure: As for `means`.
            over: As for `means`.

        Raises:
            TableError: If the measure has no numbers, or there are too many combinations.
        """
        values = self._values(self._numbered(measure, over))
        sql = f"SELECT {self._combination(names, over)}, count(*) FROM ({values}) WHERE {NUMERIC} GROUP BY 1 LIMIT ?"
        found = self._read(sql, [MAX_CELLS + 1])
        if len(found) > MAX_CELLS:
            raise TableError(f"{' and '.join(dict.fromkeys(names))} have too many different values for a comparison")
        return dict(found)

    def _values(self, columns: Sequence[tuple[int, str]]) -> str:
        """Returns the SQL for the trials with a value of each of some columns, and its number."""
        parts = [f"SELECT data, wall_s, worker, {number} AS number, {self._value(name)} AS value FROM trial" for number, name in columns]
        return " UNION ALL ".join(parts)

    def _combination(self, names: Sequence[str], over: str | None) -> str:
        """Returns the SQL for the types and values of columns, as a JSON list."""
        known = [self._value_and_kind(name, over) if name in (over, *self._types) else _constant(self.fixed.get(name)) for name in names]
        return f"json_array({', '.join(f'{kind}, {value}' for value, kind in known)})"

    def _value_and_kind(self, name: str, over: str | None) -> tuple[str, str]:
        return ("number", "NULL") if name == over else (self._value(name), self._kind(name))

    def _numbered(self, measure: str, over: str | None) -> list[tuple[int, str]]:
        """Returns the columns of a measure, each with its number.

        Raises:
            TableError: If there are none, or they have no numbers.
        """
        if over is None:
            found = [(0, measure)]
            if self._types.get(measure) not in NUMBERS:
                raise TableError(f"'{measure}' has no numbers" if measure in self._types else f"there is no column '{measure}'")
            return found
        if over in self._types:
            raise TableError(f"'{over}' is a column of the trials")
        ends = {name: name.removeprefix(f"{measure}_") for name in self._types if name.startswith(f"{measure}_")}
        found = sorted((int(end), name) for name, end in ends.items() if end.isascii() and end.isdigit() and len(end) < 9)
        found = [(number, name) for number, name in found if self._types[name] in NUMBERS][:MAX_NUMBERS]
        if not found:
            raise TableError(f"there are no columns '{measure}_1', '{measure}_2', ... with numbers")
        return found

    def _value(self, name: str) -> str:
        """Returns the SQL for the value of a column."""
        if name not in self._types:
            raise TableError(f"there is no column '{name}'")
        if name in OUTSIDE:
            return name
        path = f'$."{name}"'.replace("'", "''")
        return f"json_extract(data, '{path}')"

    def _kind(self, name: str) -> str:
        """Returns the SQL for whether a value is True, False or another."""
        if name in OUTSIDE:
            return "NULL"
        path = f'$."{name}"'.replace("'", "''")
        return f"json_type(data, '{path}')"

    def _read(self, sql: str, values: Sequence[Any]) -> list[Any]:
        try:
            return self._file.execute(sql, values).fetchall()
        except (sqlite3.Error, OverflowError) as error:
            raise TableError(f"the table of trials cannot be read: {error}") from None


def means_of_two(
    path: Path,
    beside: Path,
    *,
    x: str,
    by: Sequence[str],
    measure: str,
    factors: Sequence[str],
    over: str | None = None,
    fixed: Sequence[Mapping[str, Any]] = ({}, {}),
) -> dict[str, Any]:
    """Returns the means of an experiment, and those of another one `beside` it, as `Table.means` does, over the conditions that both have,
    which all weigh the same.

    A condition is a combination of levels of all factors, drawn or not, of a group, and of a number of the measure. The means of both at
    one place of the figure are over the same conditions. `left_out` are the numbers of conditions, and of trials (or of values of a
    measure that has several a trial), that only one of them has; `apart` are the factors of which the two have no level in common.

    Args:
        path: The table of the experiment.
        beside: The table of the other one.
        x: As for `Table.means`.
        by: As for `Table.means`.
        measure: As for `Table.means`.
        factors: The factors of both experiments.
        over: As for `Table.means`.
        fixed: For each of them, as for `Table`.

    Raises:
        Actr3dError: If one of the tables cannot be read as requested, or the measure has another unit in each.
    """
    drawn = [x, *by]
    of_condition: list[str] = [*dict.fromkeys([*factors, "group"] if over is None else [*factors, "group", over])]
    names = drawn + of_condition
    with closing(Table(path, fixed[0])) as one, closing(Table(beside, fixed[1])) as other:
        both = [_Trials(table.combinations(names, measure, over), len(drawn)) for table in (one, other)]
        kept = [both[0].beside(both[1]), both[1].beside(both[0])]
        mine, theirs = (table.means(x, by, measure, over, (of_condition, found)) for table, found in zip((one, other), kept, strict=True))
    if mine["unit"] and theirs["unit"] and mine["unit"] != theirs["unit"]:
        raise TableError(f"its {measure} is in {theirs['unit']}, and here in {mine['unit']}")
    left_out = [trials.without(found) for trials, found in zip(both, kept, strict=True)]
    levels = [[{condition[n] for _, condition in trials.of} for n in range(len(of_condition))] for trials in both]
    apart = [name for name, here, there in zip(of_condition, *levels, strict=True) if here.isdisjoint(there)]
    return {**mine, "left_out": left_out[0], "beside": {"points": theirs["points"], "left_out": left_out[1]}, "apart": apart}


class _Trials:
    """The trials of an experiment by their place in a figure and their condition.

    Args:
        numbers: Their numbers by combination of values, as `Table.combinations` returns them.
        drawn: How many of the values are the place; the others are the condition.
    """

    def __init__(self, numbers: Mapping[str, int], drawn: int) -> None:
        self._numbers = numbers
        self.of: dict[tuple[Any, Any], list[str]] = defaultdict(list)
        """The combinations by place and condition: 1 and 1.0 are two of one condition."""
        for combination in numbers:
            parts = json.loads(combination)
            values = tuple(map(_comparable, parts[::2], parts[1::2]))
            self.of[values[:drawn], values[drawn:]].append(combination)

    def beside(self, other: _Trials) -> list[str]:
        """Returns the combinations that are averaged beside another experiment: both have their conditions, also at each place of both."""
        conditions = {condition for _, condition in self.of} & {condition for _, condition in other.of}
        places = {place for place, _ in self.of} & {place for place, _ in other.of}
        return [
            combination
            for (place, condition), combinations in self.of.items()
            if condition in conditions and (place not in places or (place, condition) in other.of)
            for combination in combinations
        ]

    def without(self, kept: Sequence[str]) -> dict[str, int]:
        """Returns the numbers of conditions and of trials that are not among some combinations."""
        left = set(kept)
        conditions = {condition for (_, condition), combinations in self.of.items() if not left.isdisjoint(combinations)}
        return {
            "conditions": len({condition for _, condition in self.of} - conditions),
            "trials": sum(number for combination, number in self._numbers.items() if combination not in left),
        }


def _constant(value: Any) -> tuple[str, str]:
    """Returns the SQL for a value and its type, as those of a column; that of no column if it is no finite number and no text."""
    if isinstance(value, bool):
        return str(int(value)), "'true'" if value else "'false'"
    if isinstance(value, (int, float)) and math.isfinite(value):
        return repr(value), "'integer'" if isinstance(value, int) else "'real'"
    if not isinstance(value, str):
        return "NULL", "NULL"
    quoted = value.replace("'", "''")
    return f"'{quoted}'", "'text'"


def _comparable(kind: str | None, value: Any) -> tuple[str | None, Any]:
    """Returns a value that is equal for equal levels: 1 and 1.0 are equal, 1, "1" and True are not."""
    kind = "number" if kind in ("integer", "real") else kind
    return kind, json.dumps(value) if isinstance(value, (list, dict)) else value


def _typed(value: Any, kind: str | None) -> Any:
    return bool(value) if kind in ("true", "false") else value


def _mean(parts: Sequence[tuple[Any, Any, int, float]]) -> dict[str, Any]:
    """Returns the mean of the conditions' means, which are those of the participants' means; and its standard error, from how far
    participants are from the means of their conditions.

    Args:
        parts: Condition, participant, number of trials and their mean.
    """
    of_condition: dict[Any, list[float]] = defaultdict(list)
    for condition, _, _, mean in parts:
        of_condition[condition].append(mean)
    means = {condition: fmean(values) for condition, values in of_condition.items()}
    off: dict[Any, list[float]] = defaultdict(list)
    for condition, participant, _, mean in parts:
        off[participant].append(mean - means[condition])
    number = len(off)
    error = math.sqrt(math.fsum(fmean(values) ** 2 for values in off.values()) / (number - 1) / number) if number > 1 else None
    return {"mean": fmean(means.values()), "error": error, "participants": number, "trials": sum(count for _, _, count, _ in parts)}


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
