"""Means that are shown beside those of an experiment: of people, or of another experiment."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
from scipy.special import stdtrit

from actr3d.experiment.design import Design, factor_name
from actr3d.experiment.human_data import HumanData, HumanFile, Schema, library_human_data, plain_levels
from actr3d.experiment.plain_values import plain_text
from actr3d.experiment.report.analyses import columns_of_people
from actr3d.experiment.report.figures import Look
from actr3d.experiment.report.libraries import pandas
from actr3d.experiment.report.results import Results
from actr3d.experiment.report.statistics import cell_means, rmse_and_r

Cell = Mapping[str, Any]
"""The conditions of a mean: the group and the levels of factors."""


@dataclass(frozen=True, kw_only=True)
class ReferenceMeans:
    """Means by cell from elsewhere."""

    label: str
    """Whose they are."""
    look: Look
    frame: Any
    """A `DataFrame` with `group`, the factors of the design, `measure`, `mean`, `sd`, `low`, `high` and `n`; a group or a level that is
    None (NaN for numbers) is a mean over all."""
    results: Results | None = None
    """The trials of another experiment, as `at_common_levels` returns them; None for people."""
    trials: Any = None
    """The trials of people, a `DataFrame` with the columns of their file that a report uses; None for published means."""
    elsewhere: Mapping[str, Sequence[Cell]] = field(default_factory=dict[str, "Sequence[Cell]"])
    """The conditions of further means of another experiment by measure: those at other levels than this one ran at."""

    def of(self, measure: str) -> Any:
        """Returns the rows of a measure."""
        return self.frame[self.frame["measure"] == measure]


def factors_of(parts: Sequence[Results]) -> dict[str, list[float] | list[str]]:
    """Returns all factors of an experiment, also what its measures are numbered by."""
    return {name: levels for part in parts for name, levels in part.all_factors.items()}


def schema_of(parts: Sequence[Results]) -> Schema:
    """Returns what human data for an experiment may hold."""
    measures, factors = [name for part in parts for name in part.measures], factors_of(parts)
    numbers = [name for name in columns_of_people(parts[0].rows.columns) if name not in (*measures, *factors)]
    return Schema(
        groups=parts[0].groups,
        factors=factors,
        measures=measures,
        absent=parts[0].absent,
        parameters=parts[0].parameters,
        switches=[name for part in parts for name in part.measures if name in part.columns and part.columns[name].type == "boolean"],
        numbers=numbers,
        ignored=[name for name in parts[0].columns if name not in ("participant", "group", *measures, *factors, *numbers)],
    )


def human_data_of(design: Design, parts: Sequence[Results], file: Path | str | None) -> tuple[HumanData | None, str]:
    """Returns the human data of a report, and a text that says why there are none.

    Args:
        design: The design of the experiment.
        parts: The experiment, from `by_number`.
        file: A file, or None for what the design names.

    Raises:
        ExperimentError: If the file does not follow the schema.
    """
    schema = schema_of(parts)
    if file is not None:
        data = HumanFile(file).read(schema)
        return (data, "") if data.rows or data.published else (None, f"{data.name}: {' '.join(data.notes)}")
    name, known = design.human, library_human_data()
    if name is None:
        return None, "The design names no human data, and none were given with --human."
    if name not in known:
        return None, f"The design names the human data '{name}', which the library does not have, and none were given with --human."
    # The words of the file are enough to know whether a measure of the experiment occurs in it.
    if set(schema.measures).isdisjoint(known[name].read_text(encoding="utf-8").replace("\n", ",").split(",")):
        return None, f"The published means '{name}' are of other measures than this experiment has."
    return HumanFile(known[name]).read(schema), ""


def means_of_people(data: HumanData, parts: Sequence[Results]) -> ReferenceMeans:
    """Returns human data as means by cell."""
    pd, factors = pandas(), list(factors_of(parts))
    columns = ["group", *factors, "measure", "mean", "sd", "low", "high", "n"]
    if data.published:
        frame = pd.DataFrame([dict(row) for row in data.rows], columns=["group", *factors, "measure", "mean", "sd", "n"])
        for name in ("mean", "sd", "n"):
            frame[name] = frame[name].astype("float64")
        enough = frame["n"].where(frame["n"] > 1)
        half: Any = stdtrit(enough - 1, 0.975) * frame["sd"] / np.sqrt(enough)
        frame["low"], frame["high"] = frame["mean"] - half, frame["mean"] + half
        return ReferenceMeans(label="people", look="human", frame=frame[columns])
    rows = pd.DataFrame([dict(row) for row in data.rows])
    rows["participant"] = rows["group"] + " " + rows["participant"]
    given = [name for name in ("group", *factors) if rows[name].notna().any()]
    for name in (*data.measures, *data.numbers):
        rows[name] = rows[name].astype("float64")
    there = [measure for measure in data.measures if rows[measure].notna().any()]
    pieces = [cell_means(rows, measure, given).assign(measure=measure) for measure in there]
    frame = pd.concat(pieces, ignore_index=True) if pieces else pd.DataFrame(columns=columns)
    return ReferenceMeans(label="people", look="human", frame=frame.reindex(columns=columns), trials=rows)


def means_of_experiment(others: Sequence[Results], parts: Sequence[Results]) -> ReferenceMeans | None:
    """Returns the means of another experiment, at the levels at which both ran; None if it has no measure in common, or no such trials."""
    pd, pieces, elsewhere = pandas(), list[Any](), dict[str, Sequence[Cell]]()
    for part, other in itertools.product(parts, others):
        if part.numbers.keys() == other.numbers.keys():
            alike = at_common_levels(other, part)
            for measure in part.measures:
                if measure in other.measures and same_unit(part, other, measure):
                    pieces.append(cell_means(alike.rows, measure, ["group", *part.all_factors]).assign(measure=measure))
                    keys = ["group", *other.all_factors]
                    every, common = (
                        dict.fromkeys(of.rows[of.rows[measure].notna()][keys].itertuples(index=False, name=None)) for of in (other, alike)
                    )
                    elsewhere[measure] = [dict(zip(keys, cell, strict=True)) for cell in every if cell not in common]
    if not any(map(len, pieces)):
        return None
    frame = pd.concat([piece for piece in pieces if len(piece)], ignore_index=True)
    columns = ["group", *factors_of(parts), "measure", "mean", "sd", "low", "high", "n"]
    results = at_common_levels(others[0], parts[0])
    return ReferenceMeans(label=results.label, look="other", frame=frame.reindex(columns=columns), results=results, elsewhere=elsewhere)


def at_common_levels(other: Results, results: Results) -> Results:
    """Returns the trials of another experiment at the levels at which an experiment ran, of the factors that only one of them varies.

    The one that does not vary a factor ran at one level in each group: that of its settings, of the group, or the default of the
    parameter. Groups for which it was drawn for each participant or trial, or that have no such parameter, are left out.
    """
    rows, failures = other.rows, other.failures
    for name, (whose, levels) in varied_once(results, other).items():
        of_groups = ran_at(other if whose is results else results, name, levels)
        if whose is results:
            rows, failures = (frame[frame["group"].isin(of_groups)] for frame in (rows, failures))
            rows, failures = (frame.assign(**{name: frame["group"].map(of_groups)}) for frame in (rows, failures))
        else:
            rows, failures = (frame[frame["group"].map(of_groups) == frame[name]] for frame in (rows, failures))
    return replace(other, rows=rows.reset_index(drop=True), failures=failures.reset_index(drop=True))


def varied_once(one: Results, other: Results) -> dict[str, tuple[Results, list[float] | list[str]]]:
    """Returns the factors that only one of two experiments varies: by name, which one, and the levels."""
    pairs = ((one, other), (other, one))
    return {name: (mine, levels) for mine, theirs in pairs for name, levels in mine.all_factors.items() if name not in theirs.all_factors}


def ran_at(results: Results, name: str, levels: Sequence[Any]) -> dict[str, float | str]:
    """Returns the level at which each group of an experiment ran that does not vary a factor; without groups that have no one level.

    Args:
        results: The experiment.
        name: The name of the factor in another experiment.
        levels: Its levels there: numbers, or texts.
    """
    raw = name.removesuffix("_") if factor_name(name.removesuffix("_")) == name else name
    design, column, parameter = results.design, results.columns.get(raw), results.parameters.get(raw)
    known = parameter is not None and parameter.known and not parameter.required
    found: dict[str, float | str] = {}
    for group, rows in results.rows.groupby("group", observed=True):
        values: list[Any] = list(rows[raw]) if raw in rows else []
        given = raw in design.settings or raw in design.groups[str(group)].parameters
        if not given and all(map(missing, values)):
            values = [parameter.default] if parameter is not None and known else []
        elif column is not None and column.type == "boolean":
            values = [bool(value) for value in values]
        plain = {_plain_level(value, levels) for value in values}
        if len(plain) == 1:
            found[str(group)] = plain.pop()
    return found


def _plain_level(value: Any, levels: Sequence[Any]) -> float | str:
    """Returns a value as the levels of a factor are: as a number if they are, and it is one, else as a text; see `plain_levels`."""
    (level,) = plain_levels([value]) if not isinstance(levels[0], str) else [plain_text(value)]
    return level


def same_unit(one: Results, other: Results, measure: str) -> bool:
    """Returns whether a measure has the same unit in two experiments, as far as both have one."""
    units = {one.unit(measure), other.unit(measure)} - {""}
    return len(units) <= 1


def matched(results: Results, reference: ReferenceMeans, measure: str) -> Any:
    """Returns a `DataFrame` of the cells that both have: `model`, `beside` and what makes the cell. Means over all groups or levels are
    compared with the model's means over all.

    Cells in which a trial failed are left out, see `without_failures`.
    """
    keys = ["group", *results.all_factors]
    found = matched_means(results.rows, measure, keys, reference.of(measure))
    return without_failures(found, keys, [results, *([] if reference.results is None else [reference.results])])


def cells_left_out(results: Results, reference: ReferenceMeans, measure: str, cells: Any) -> list[Cell]:
    """Returns the conditions of the means of a measure that are not compared: all but the cells that `matched` returned."""
    keys = ["group", *results.all_factors]
    both, beside = (
        {tuple((key, row[key]) for key in keys if not missing(row[key])): None for row in frame.to_dict("records")}
        for frame in (cells, reference.of(measure))
    )
    return [*(dict(cell) for cell in beside if cell not in both), *reference.elsewhere.get(measure, ())]


def without_failures(cells: Any, keys: Sequence[str], experiments: Sequence[Results]) -> Any:
    """Returns those cells of a `DataFrame` in which no trial of some experiments has failed, as in a fit: the means of the others would be
    those of the easier trials.

    Args:
        cells: The cells; where a key is missing, a cell is of all levels.
        keys: The columns that make a cell, named as in the experiments.
        experiments: The experiments.
    """
    failed: list[dict[str, Any]] = []
    for one in experiments:
        failed += one.failures[[key for key in keys if key in one.failures]].drop_duplicates().to_dict("records")
    whole = [
        not any(all(missing(cell[key]) or cell[key] == level for key, level in one.items()) for one in failed)
        for cell in cells.to_dict("records")
    ]
    return cells[whole].reset_index(drop=True)


def matched_means(trials: Any, measure: str, keys: Sequence[str], means: Any) -> Any:
    """Returns a `DataFrame` as `matched` does.

    Args:
        trials: The trials of the model.
        measure: The column of them whose means are compared.
        keys: The columns that make a cell.
        means: The reference means, with the same columns and `mean`.
    """
    found: list[dict[str, Any]] = []
    for given, rows in _patterns(means, keys):
        model = {tuple(row[name] for name in given): row["mean"] for row in cell_means(trials, measure, given).to_dict("records")}
        for row in rows:
            place = tuple(row[name] for name in given)
            if place in model:
                found.append({**{name: row[name] for name in keys}, "model": model[place], "beside": row["mean"]})
    return pandas().DataFrame(found, columns=[*keys, "model", "beside"])


def fit_to(parts: Sequence[Results], reference: ReferenceMeans) -> Any:
    """Returns a `DataFrame` with a row for each measure: the agreement of the means of all cells that both have, see `matched`, and how
    many of the means beside are left out."""
    found: list[dict[str, Any]] = []
    for results, measure in ((part, measure) for part in parts for measure in part.measures):
        cells = matched(results, reference, measure)
        if len(cells):
            rmse, r = rmse_and_r(cells["model"], cells["beside"])
            difference = float((cells["model"] - cells["beside"]).mean())
            unit = results.unit(measure)
            others = len(cells_left_out(results, reference, measure, cells))
            row = {"measure": measure, "unit": unit, "beside": reference.label, "cells": len(cells), "left_out": others}
            found.append({**row, "mean_difference": difference, "rmse": rmse, "r": r, "r2": r * r})
    return pandas().DataFrame(found, columns=["measure", "unit", "beside", "cells", "left_out", "mean_difference", "rmse", "r", "r2"])


def missing(value: Any) -> bool:
    """Returns whether a group or level is not given: the mean is one over all."""
    return value is None or (isinstance(value, float) and math.isnan(value))


def _patterns(frame: Any, keys: Sequence[str]) -> Iterator[tuple[list[str], list[dict[str, Any]]]]:
    """Yields the rows of a frame by the names of the keys that they give."""
    found: dict[tuple[str, ...], list[dict[str, Any]]] = {}
    for row in frame.to_dict("records"):
        found.setdefault(tuple(name for name in keys if not missing(row[name])), []).append(row)
    yield from ((list(given), rows) for given, rows in found.items())
