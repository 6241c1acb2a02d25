"""Means that are shown beside those of an experiment: of people, or of another experiment."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from scipy.special import stdtrit

from actr3d.experiment.design import Design
from actr3d.experiment.human_data import HumanData, Schema, library_human_data, read_human_data
from actr3d.experiment.report.analyses import columns_of_people
from actr3d.experiment.report.figures import Look
from actr3d.experiment.report.libraries import pandas
from actr3d.experiment.report.results import Results
from actr3d.experiment.report.statistics import cell_means, rmse_and_r


@dataclass(frozen=True, kw_only=True)
class Beside:
    """Means by cell from elsewhere."""

    label: str
    """Whose they are."""
    look: Look
    frame: Any
    """A `DataFrame` with `group`, the factors of the design, `measure`, `mean`, `sd`, `low`, `high` and `n`; a group or a level that is
    None (NaN for numbers) is a mean over all."""
    results: Results | None = None
    """The trials of another experiment; None for people."""
    trials: Any = None
    """The trials of people, a `DataFrame` with the columns of their file that a report uses; None for published means."""

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
    if file is not None:
        data = read_human_data(file, schema_of(parts))
        return (data, "") if data.rows or data.published else (None, f"{data.name}: {' '.join(data.notes)}")
    name, known = design.human, library_human_data()
    if name is None:
        return None, "The design names no human data, and none were given with --human."
    if name not in known:
        return None, f"The design names the human data '{name}', which the library does not have, and none were given with --human."
    if not set(schema_of(parts).measures) & _measures_in(known[name]):
        return None, f"The published means '{name}' are of other measures than this experiment has."
    return read_human_data(known[name], schema_of(parts)), ""


def _measures_in(path: Path) -> set[str]:
    """Returns the words of a file: enough to know whether a measure of the experiment occurs in it."""
    return set(path.read_text(encoding="utf-8").replace("\n", ",").split(","))


def beside_people(data: HumanData, parts: Sequence[Results]) -> Beside:
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
        return Beside(label="people", look="human", frame=frame[columns])
    rows = pd.DataFrame([dict(row) for row in data.rows])
    rows["participant"] = rows["group"] + " " + rows["participant"]
    given = [name for name in ("group", *factors) if rows[name].notna().any()]
    for name in (*data.measures, *data.numbers):
        rows[name] = rows[name].astype("float64")
    there = [measure for measure in data.measures if rows[measure].notna().any()]
    pieces = [cell_means(rows, measure, given).assign(measure=measure) for measure in there]
    frame = pd.concat(pieces, ignore_index=True) if pieces else pd.DataFrame(columns=columns)
    return Beside(label="people", look="human", frame=frame.reindex(columns=columns), trials=rows)


def beside_experiment(others: Sequence[Results], parts: Sequence[Results]) -> Beside | None:
    """Returns the means of another experiment; None if it has no measure in common."""
    pd, pieces = pandas(), list[Any]()
    for part, other in itertools.product(parts, others):
        if part.numbers.keys() == other.numbers.keys():
            by = ["group", *(name for name in part.all_factors if _is_fixed(other, name))]
            common = [name for name in part.measures if name in other.measures and same_unit(part, other, name)]
            pieces += [cell_means(other.rows, measure, by).assign(measure=measure) for measure in common]
    if not pieces:
        return None
    frame = pd.concat(pieces, ignore_index=True)
    columns = ["group", *factors_of(parts), "measure", "mean", "sd", "low", "high", "n"]
    return Beside(label=others[0].label, look="other", frame=frame.reindex(columns=columns), results=others[0])


def same_unit(one: Results, other: Results, measure: str) -> bool:
    """Returns whether a measure has the same unit in two experiments, as far as both have one."""
    units = {one.unit(measure), other.unit(measure)} - {""}
    return len(units) <= 1


def _is_fixed(results: Results, name: str) -> bool:
    """Returns whether a column is a factor, or has one value in each group: it is not drawn for each participant or trial."""
    rows = results.rows
    return name in results.all_factors or (name in rows and bool((rows.groupby("group")[name].nunique() <= 1).all()))


def matched(results: Results, beside: Beside, measure: str) -> Any:
    """Returns a `DataFrame` of the cells that both have: `model`, `beside` and what makes the cell. Means over all groups or levels are
    compared with the model's means over all.

    Cells in which a trial failed are left out, see `without_failures`.
    """
    keys = ["group", *results.all_factors]
    found = matched_means(results.rows, measure, keys, beside.of(measure))
    return without_failures(found, keys, [results, *([] if beside.results is None else [beside.results])])


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
        means: The means beside, with the same columns and `mean`.
    """
    found: list[dict[str, Any]] = []
    for given, rows in _patterns(means, keys):
        model = {tuple(row[name] for name in given): row["mean"] for row in cell_means(trials, measure, given).to_dict("records")}
        for row in rows:
            place = tuple(row[name] for name in given)
            if place in model:
                found.append({**{name: row[name] for name in keys}, "model": model[place], "beside": row["mean"]})
    return pandas().DataFrame(found, columns=[*keys, "model", "beside"])


def fit_to(parts: Sequence[Results], beside: Beside) -> Any:
    """Returns a `DataFrame` with a row for each measure: the agreement of the means of all cells that both have, see `matched`, and how
    many of the means beside are left out."""
    found: list[dict[str, Any]] = []
    for results, measure in ((part, measure) for part in parts for measure in part.measures):
        cells = matched(results, beside, measure)
        if len(cells):
            rmse, r = rmse_and_r(cells["model"], cells["beside"])
            difference = float((cells["model"] - cells["beside"]).mean())
            unit = results.unit(measure)
            left_out = len(beside.of(measure)) - len(cells)
            row = {"measure": measure, "unit": unit, "beside": beside.label, "cells": len(cells), "left_out": left_out}
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
