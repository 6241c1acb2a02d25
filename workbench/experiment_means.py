"""Computes the means of experiments for a figure, from their tables of trials. It runs in workers, never in the server."""

from __future__ import annotations

import json
import math
from collections import defaultdict
from collections.abc import Collection, Generator, Mapping, Sequence
from contextlib import ExitStack, closing
from dataclasses import dataclass
from functools import cache
from itertools import chain, groupby
from operator import itemgetter
from pathlib import Path
from statistics import fmean
from typing import Any, cast

from workbench.experiment_table import OUTSIDE, Table, TableError, json_path

MAX_POINTS = 2_000
"""Maximum number of points of a figure."""
MAX_COMBINATIONS = 200_000
"""Maximum number of combinations of a place and a condition in an experiment that is compared."""
NUMERIC = "typeof(value) IN ('integer', 'real')"
"""The SQL for whether a trial has a value of the measure."""
FAILED = "json_extract(data, '$.error') IS NOT NULL"
"""The SQL for whether a trial has failed."""

ORDER = {"position", "trial"}
"""Columns with the order of trials: at one position, each participant may have another condition."""

Combination = tuple[str, int, str]
"""A place and a condition as a table has them: the columns of the place as JSON, the number of the value, those of the condition."""
Level = tuple[str, Any]
"""A value of a column that can be compared, see `_level`."""
MISSING: Level = "missing", 0
"""The level of a factor that trials have no value of."""


@dataclass(frozen=True, kw_only=True)
class MeansFigure:
    """What a figure shows."""

    place: Sequence[str]
    """The columns whose values make a place: that along the axis, and those whose combinations are the lines."""
    measure: str
    """The column that is averaged; of True and False, the share of True."""
    over: str | None
    """The name of a further column with the number of a value, for a measure that has a column for each number; None for one with one
    value a trial."""
    condition: Sequence[str]
    """The columns whose values, with the number, make a condition."""

    @property
    def by_order(self) -> bool:
        """Whether it shows the order of trials."""
        return not ORDER.isdisjoint(self.place)


def means(
    *paths: Path,
    x: str,
    by: Sequence[str],
    measure: str,
    factors: Sequence[str],
    over: str | None = None,
    defaults: Sequence[Mapping[str, Any]] = (),
) -> dict[str, Any]:
    """Returns the means of an experiment for a figure, and those of another one beside it if there are two tables.

    A condition is a combination of levels of all factors, drawn or not, of a group, and of a number of the measure. At each place of the
    figure, `mean` is the mean of the conditions, all of which weigh the same; that of a condition is the mean of participants' means.
    In a figure `by_order` of trials, it is the mean of the participants' means.

    Two experiments are compared over the conditions that both have and in which no trial failed: the means of both at one place are over
    the same conditions, unless it is a place in the order of trials. Then the result has

    - `failed`: `conditions`, the number of conditions in which a trial of either experiment failed; `trials`, how many trials of each are
      left out because of that (or values, of a measure that has several in a trial);
    - `left_out`: the numbers of conditions, and of trials, that only one of the two has;
    - `apart`: the factors of which the two have no level in common.

    Args:
        paths: The tables.
        x: The column along the axis.
        by: The columns whose combinations are the lines.
        measure: See `MeansFigure`.
        factors: The factors of all the experiments.
        over: See `MeansFigure`.
        defaults: For each table, the values of factors that are only in the other one, for trials in which they are no column.

    Raises:
        Actr3dError: If a table cannot be read as requested, there are too many points, or the measure has another unit in each.
    """
    condition = [name for name in dict.fromkeys([*factors, "group"]) if name != over]
    figure = MeansFigure(place=[x, *by], measure=measure, over=over, condition=condition)
    with ExitStack() as stack:
        tables = [stack.enter_context(closing(Table(path))) for path in paths]
        trials = [_Trials(table, figure, more) for table, more in zip(tables, defaults or [{} for _ in tables], strict=True)]
        points = {"points": trials[0].points()} if len(trials) == 1 else _compared(*trials)
        shown = {"x": x, "by": list(by), "by_order": figure.by_order, "measure": measure, "unit": trials[0].unit}
        return {**shown, "columns": tables[0].columns, **points}


def _compared(mine: _Trials, theirs: _Trials) -> dict[str, Any]:
    """Returns the points of two experiments, and what is left out, see `means`."""
    if mine.unit and theirs.unit and mine.unit != theirs.unit:
        raise TableError(f"'{mine.figure.measure}' must have the same unit in both experiments (got {mine.unit} and {theirs.unit})")
    both = mine.conditions(), theirs.conditions()
    failed = both[0].failed | both[1].failed
    trials = [one.leave_out(failed) for one in both]
    kept = [one.beside(other, by_order=mine.figure.by_order) for one, other in (both, both[::-1])]
    left_out = [one.without(combinations) for one, combinations in zip(both, kept, strict=True)]
    levels = zip(mine.names, both[0].levels, both[1].levels, strict=True)
    return {
        "points": mine.points(kept[0]),
        "left_out": left_out[0],
        "beside": {"points": theirs.points(kept[1]), "left_out": left_out[1]},
        "failed": {"conditions": len(failed), "trials": trials},
        "apart": [name for name, here, there in levels if here.isdisjoint(there)],
    }


class _Trials:
    """The trials of an experiment by place and condition; the defaults are those of `means` for its table.

    Raises:
        TableError: If there is no such column, or the measure has no numbers.
    """

    def __init__(self, table: Table, figure: MeansFigure, defaults: Mapping[str, Any]) -> None:
        self.figure = figure
        self.names = [*figure.condition, *([] if figure.over is None else [figure.over])]
        """The names of what makes a condition."""
        self._table, self._defaults = table, defaults
        self._columns = table.numbered(figure.measure, figure.over)
        self._of_condition = [name for name in figure.condition if name in table]
        self._often_default = [name for name in self._of_condition if name in defaults]
        for name in figure.place:
            if name != figure.over and (name not in table or name in OUTSIDE):
                raise TableError(f"there is no column '{name}' in the trials themselves")

    @property
    def unit(self) -> str | None:
        """The unit of the measure."""
        return self._table.unit(self._columns[0][1])

    def points(self, kept: Collection[Combination] | None = None) -> list[dict[str, Any]]:
        """Returns the points, sorted by place: the values of its columns, `at`, and the mean of the conditions there, see `_mean`.

        Args:
            kept: The combinations that are averaged; None for all.

        Raises:
            TableError: If there are too many points.
        """
        what = "json_extract(data, '$.participant'), count(*), avg(value)"
        points: list[dict[str, Any]] = []
        with closing(self._select(what, f"WHERE {NUMERIC} GROUP BY 1, 2, 3, 4 ORDER BY 1, 2, 3")) as cells:
            for (place, number), of_place in groupby(cells, self._place_of):  # in order, so that only one place is in memory
                of_conditions = groupby(of_place, itemgetter(0, 1, 2))
                conditions = [[cell[3:] for cell in of] for combination, of in of_conditions if kept is None or combination in kept]
                if conditions:
                    averaged = [_pooled(conditions)] if self.figure.by_order else conditions
                    points.append({"at": self._at(place, number), **_mean(averaged)})
                if len(points) > MAX_POINTS:
                    raise TableError(f"{' and '.join(self.figure.place)} have too many different values for a figure")
        return sorted(points, key=lambda point: [*map(_level, point["at"])])

    def conditions(self) -> _Conditions:
        """Returns the conditions with a value or a failed trial, and at which places they are.

        Raises:
            TableError: If there are too many.
        """
        values, failed = f"sum({NUMERIC})", f"sum({FAILED})"
        levels_of, found = cache(self._levels), _Conditions(len(self.figure.condition), len(self.names))
        with closing(self._select(f"{values}, {failed}", f"GROUP BY 1, 2, 3 HAVING {values} OR {failed}")) as combinations:
            for read, (place, number, condition, trials, failures) in enumerate(combinations):
                if read == MAX_COMBINATIONS:
                    raise TableError(f"{' and '.join(self.names)} have too many different values for a comparison")
                levels = levels_of(condition) if self.figure.over is None else (*levels_of(condition), _level(number))
                at = tuple(map(_level, self._at(*self._place_of((place, number)))))
                found.add((place, number, condition), at, levels, trials, failures)
        return found

    def _select(self, what: str, more: str) -> Generator[Any]:
        """Yields combinations, with more columns."""
        condition = _as_json(self._of_condition)
        for name in self._often_default:
            condition = f"(json_type(data, {json_path(name)}) IS NULL) || {condition}"
        parts = [f"SELECT data, {number} AS number, {self._table.value(name)} AS value FROM trial" for number, name in self._columns]
        place = _as_json([name for name in self.figure.place if name != self.figure.over])
        return self._table.select(f"SELECT {place}, number, {condition}, {what} FROM ({' UNION ALL '.join(parts)}) {more}")

    def _place_of(self, cell: Sequence[Any]) -> tuple[str, int]:
        """Returns the place of a combination: its columns, and its number if the number is part of it."""
        return cell[0], cell[1] if self.figure.over in self.figure.place else 0

    def _at(self, place: str, number: int) -> list[Any]:
        """Returns the values of a place; a list is a text, as in the rows."""
        values = iter(json.loads(place))
        found = [number if name == self.figure.over else next(values) for name in self.figure.place]
        return [json.dumps(value, separators=(",", ":")) if isinstance(value, (list, dict)) else value for value in found]

    def _levels(self, condition: str) -> tuple[Level, ...]:
        """Returns the levels of a condition, with defaults; those of columns that the trials do not have are `MISSING`."""
        count = len(self._often_default)
        given = dict(zip(self._of_condition, json.loads(condition[count:]), strict=False))
        absent = {name for name, flag in zip(reversed(self._often_default), condition, strict=False) if flag == "1"}
        values = {**self._defaults, **{name: value for name, value in given.items() if name not in absent}}
        return tuple(_level(values[name]) if name in values else MISSING for name in self.figure.condition)


class _Conditions:
    """The conditions of an experiment, and at which places they are.

    Args:
        names: How many columns make a condition.
        levels: How many levels a condition has: those of the columns, and the number of the value, if there are several a trial.
    """

    def __init__(self, names: int, levels: int) -> None:
        self.levels = [set[Level]() for _ in range(levels)]
        """The levels that occur."""
        self.failed: set[tuple[Level, ...]] = set()
        """The levels of the columns of the conditions in which a trial failed."""
        self._names = names
        self.trials: dict[tuple[Any, Any], dict[Combination, int]] = defaultdict(dict)
        """The numbers of trials with a value: by place and condition, those of each combination."""

    def add(self, combination: Combination, place: tuple[Level, ...], condition: tuple[Level, ...], trials: int, failures: int) -> None:
        """Adds a combination with its numbers of trials that have a value, and that failed."""
        for level, levels in zip(condition, self.levels, strict=True):
            levels.add(level)
        if failures:
            self.failed.add(condition[: self._names])
        if trials:
            self.trials[place, condition][combination] = trials

    def leave_out(self, failed: Collection[tuple[Level, ...]]) -> int:
        """Leaves conditions out, and returns the number of their trials."""
        found = [key for key in self.trials if key[1][: self._names] in failed]
        return sum(sum(self.trials.pop(key).values()) for key in found)

    def beside(self, other: _Conditions, *, by_order: bool) -> set[Combination]:
        """Returns the combinations that are averaged beside another experiment: both have their conditions, also at each place of both,
        unless places are in the order of trials."""
        conditions = {condition for _, condition in self.trials} & {condition for _, condition in other.trials}
        here, there = ({place for place, condition in one.trials if condition in conditions} for one in (self, other))
        both = here & there
        return {
            combination
            for (place, condition), combinations in self.trials.items()
            if condition in conditions and (by_order or place not in both or (place, condition) in other.trials)
            for combination in combinations
        }

    def without(self, kept: Collection[Combination]) -> dict[str, int]:
        """Returns the numbers of conditions and of trials that are not among some combinations."""
        averaged = {condition for (_, condition), combinations in self.trials.items() if any(one in kept for one in combinations)}
        every = {condition for _, condition in self.trials}
        trials = sum(n for combinations in self.trials.values() for one, n in combinations.items() if one not in kept)
        return {"conditions": len(every - averaged), "trials": trials}


def _as_json(names: Sequence[str]) -> str:
    """Returns the SQL for the values of columns as a JSON list, which ends with the first one again: of one path it would be no list."""
    paths = [json_path(name) for name in names]
    return f"json_extract(data, {', '.join([*paths, paths[0]])})" if paths else "'[]'"


def _level(value: Any) -> Level:
    """Returns a value with its type, which can be sorted, and is equal for equal levels: 1 and 1.0 are equal, 1, "1" and True are not."""
    match value:
        case None:
            return "none", 0
        case bool():
            return "switch", value
        case int() | float():
            return "number", value
        case list() | tuple():
            return "list", tuple(map(_level, cast("Sequence[Any]", value)))
        case _:
            return "text", value if isinstance(value, str) else json.dumps(value)


def _pooled(conditions: Sequence[Sequence[tuple[Any, int, float]]]) -> list[tuple[Any, int, float]]:
    """Returns the numbers of trials and means of participants over all conditions, in which each trial weighs the same."""
    numbers, sums = defaultdict[Any, int](int), defaultdict[Any, float](float)
    for participant, number, mean in chain.from_iterable(conditions):
        numbers[participant] += number
        sums[participant] += number * mean
    return [(participant, number, sums[participant] / number) for participant, number in numbers.items()]


def _mean(conditions: Sequence[Sequence[tuple[Any, int, float]]]) -> dict[str, Any]:
    """Returns the mean of the conditions' means with its standard error over participants; None if a condition has only one.

    Participants are independent. A participant's deviations from the means of the conditions have the weights that they have in the mean;
    in a condition of n participants they are multiplied by the root of n / (n - 1), because its mean is one of these n values.

    Args:
        conditions: The participants of each: name, number of trials and their mean.
    """
    off: dict[Any, float] = defaultdict(float)
    means = [fmean(mean for *_, mean in condition) for condition in conditions]
    for condition, of_condition in zip(conditions, means, strict=True):
        n = len(condition)
        weight = 1 / (len(conditions) * math.sqrt(n * (n - 1))) if n > 1 else math.nan
        for participant, _, mean in condition:
            off[participant] += (mean - of_condition) * weight
    error = math.hypot(*off.values())
    trials = sum(count for condition in conditions for _, count, _ in condition)
    return {"mean": fmean(means), "error": None if math.isnan(error) else error, "participants": len(off), "trials": trials}
