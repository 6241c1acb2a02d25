"""The results of an experiment, as they are analysed."""

from __future__ import annotations

import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from itertools import islice
from pathlib import Path
from typing import Any

from actr3d.errors import ExperimentError
from actr3d.experiment.design import OWN_COLUMNS, Design, factor_name
from actr3d.experiment.human_data import absent_levels, plain_levels
from actr3d.experiment.plain_values import plain_text, text_cell
from actr3d.experiment.report.libraries import pandas
from actr3d.experiment.specification import Experiment, Specification
from actr3d.experiment.store import ROWS_AT_ONCE, UNITS, Column, Store, summary
from actr3d.parameter_schema import Parameter

NUMBERS = ("boolean", "integer", "real")
"""The types of columns that are analysed as numbers."""
ENDINGS = {unit: ending for ending, unit in UNITS.items()}
"""The endings of names of columns by units."""
SHORT = {"r2": "r²", "rmse": "RMSE", "aic": "AIC", "sd": "SD", "chi2": "χ²"}
"""Names of statistics as they are written."""
LEFT_OUT = ("seed", "wall_s", "worker", "position")
"""Columns that no analysis needs."""


@dataclass(frozen=True, kw_only=True)
class Results:
    """The trials of an experiment, with what is known of them."""

    label: str
    """The name of the folder."""
    description: str
    """The docstring of the design."""
    specification: Specification
    design: Design
    changes: Mapping[str, Any]
    """The numbers and values that are not those of the design as its file has it; see `Experiment.changes`."""
    columns: Mapping[str, Column]
    """What is known of each column of `rows`."""
    rows: Any
    """A `pandas.DataFrame` of the trials that did not fail, sorted by group, participant, the factors, and number."""
    failures: Any
    """A `pandas.DataFrame` of the trials that failed: `trial`, `participant`, `group`, the factors, `end` and `error`."""
    versions: Sequence[str]
    """The versions of the packages that ran the trials; more than one if they changed meanwhile."""
    measures: Sequence[str]
    """The measures that are numbers; switches count as 1 and 0, so that their means are proportions."""
    outcomes: Sequence[str]
    """The measures that are texts."""
    parameters: Mapping[str, Parameter] = field(default_factory=dict[str, Parameter])
    """The parameters of the model, by the names of the columns of `rows`."""
    absent: Mapping[str, Sequence[str]] = field(default_factory=dict[str, "Sequence[str]"])
    """The levels of the factors that the file of the design has, and this experiment does not; see `absent_levels`."""
    numbers: Mapping[str, list[float]] = field(default_factory=dict[str, "list[float]"])
    """What the values of a trial are numbered by, such as `block`, and its numbers: a further factor. See `by_number`."""

    @property
    def factors(self) -> dict[str, list[float] | list[str]]:
        """The factors with more than one level, and their levels as they are in `rows`: all of them numbers, or all texts."""
        return {name: levels for name, levels in self.all_factors.items() if len(levels) > 1}

    @property
    def all_factors(self) -> dict[str, list[float] | list[str]]:
        """All factors of the design, also those with one level, with their levels as in `factors`; then `numbers`."""
        return {**{factor_name(name): plain_levels(levels) for name, levels in self.design.factors.items()}, **self.numbers}

    @property
    def groups(self) -> list[str]:
        """The names of the groups."""
        return list(self.design.groups)

    @property
    def by_group(self) -> list[str]:
        """The column of groups, as a key of tables that distinguish them; empty for a single group."""
        return ["group"] if len(self.groups) > 1 else []

    def unit(self, column: str) -> str:
        """Returns the unit of a column; empty if it has none, or none is known."""
        known = self.columns.get(column)
        return (known.unit or "") if known is not None else ""

    def name_with_unit(self, column: str) -> str:
        """Returns a name for axes: words instead of underscores, and the unit."""
        return name_with_unit(column, self.unit(column))


def by_number(results: Results) -> list[Results]:
    """Returns the results such that each measure has one value in a row: those with one value a trial, then each of the others, with a
    row for each number and with the number as a further factor."""
    pd, found, taken = pandas(), list[Results](), set[str]()
    for measure in results.design.kept:
        if measure.over is None:
            continue
        numbered = re.compile(rf"{re.escape(measure.name)}_(\d+)")
        numbers = {column: float(match[1]) for column in results.columns if (match := numbered.fullmatch(column))}
        taken |= numbers.keys()
        there = {column: number for column, number in numbers.items() if column in results.measures}
        if there:
            over, rest = factor_name(measure.over), results.rows.drop(columns=[column for column in numbers if column in results.rows])
            rows = [rest.assign(**{over: number, measure.name: results.rows[column]}) for column, number in there.items()]
            unit = results.columns[next(iter(there))].unit
            about = Column(name=measure.name, type="real", unit=unit, meaning=measure.meaning)
            found.append(
                replace(
                    results,
                    columns={**results.columns, measure.name: about},
                    rows=pd.concat(rows, ignore_index=True),
                    measures=[measure.name],
                    outcomes=[],
                    numbers={over: list(there.values())},
                )
            )
    return [replace(results, measures=[name for name in results.measures if name not in taken]), *found]


def name_with_unit(name: str, unit: str) -> str:
    """Returns a name for axes: words instead of underscores, and the unit instead of an ending that is the same: `clearance left [m]`."""
    base = name.removesuffix(ENDINGS.get(unit, f"_{unit.lower()}")) if unit else name
    shown = SHORT.get(base, words(base))
    return f"{shown} [{unit}]" if unit else shown


def words(name: str) -> str:
    """Returns a name with spaces instead of underscores, and without that of `factor_name` at its end."""
    return name.replace("_", " ").strip()


def read_results(folder: Path | str) -> Results:
    """Reads the folder of an experiment.

    Raises:
        ExperimentError: If it holds no experiment, or no trial has finished.
    """
    with Store(folder) as store:
        specification = store.specification
        with specification.sealed() as helpers:
            experiment = Experiment(specification, helpers)
        columns = {column.name: column for column in store.columns}
        design = experiment.design
        texts = [name for name, levels in design.factors.items() if isinstance(plain_levels(levels)[0], str)]
        frame = _frame(store, texts)
    if frame is None:
        raise ExperimentError(f"'{folder}': no trial has finished yet; run it with: actr3d experiment {folder} --resume")
    renamed = {name: factor_name(name) for name in design.factors}
    columns = {renamed.get(name, name): column for name, column in columns.items()}
    frame = _sorted(frame.rename(columns=renamed), design)
    failed = frame["error"].notna()
    rows = frame[~failed].drop(columns=["error", "versions"]).reset_index(drop=True)
    about = [name for name in ("trial", "participant", "group", *renamed.values(), "end", "error") if name in frame]
    failures = frame.loc[failed, about].reset_index(drop=True)
    if not len(rows):
        first = summary(str(failures.sort_values("trial")["error"].iloc[0]))
        raise ExperimentError(f"'{folder}': every finished trial failed ({len(failures):,}); the first one with: {first}")
    of_design = {*design.known_columns, *OWN_COLUMNS, *renamed.values()}
    kinds = {name: columns[name].type for name in rows if name in columns and name not in of_design}
    return Results(
        label=Path(folder).resolve().name,
        description=experiment.description,
        specification=specification,
        changes=experiment.changes,
        design=design,
        columns=columns,
        rows=rows,
        failures=failures,
        versions=sorted(frame["versions"].unique()),
        measures=[name for name, kind in kinds.items() if kind in NUMBERS and rows[name].notna().any()],
        outcomes=[name for name, kind in kinds.items() if kind == "text"],
        parameters={renamed.get(one.name, one.name): one for one in experiment.parameters},
        absent={renamed[name]: absent_levels(levels, design.factors[name]) for name, levels in experiment.written.factors.items()},
    )


def _sorted(frame: Any, design: Design) -> Any:
    """Returns the rows sorted by group, participant and factors, each in the order of the design, and by the number of the trial."""
    orders: dict[str, list[Any]] = {"group": list(design.groups), "participant": [one.name for one in design.participants]}
    orders |= {factor_name(name): list(plain_levels(levels)) for name, levels in design.factors.items()}

    def rank(column: Any) -> Any:
        order = orders.get(column.name)
        return column if order is None else column.map({value: number for number, value in enumerate(order)})

    return frame.sort_values([*orders, "trial"], key=rank, kind="stable", ignore_index=True)


def _frame(store: Store, texts: Sequence[str]) -> Any:
    """Returns all rows as a `pandas.DataFrame`; None if there are none. Numbers are `float64`, also switches among the measures.

    Args:
        store: The folder of the experiment.
        texts: The factors whose levels are texts.
    """
    pd, rows = pandas(), store.rows()
    kinds = {column.name: "float64" if column.type in NUMBERS and column.name not in texts else "object" for column in store.columns}
    of_text = [column.name for column in store.columns if column.type == "text" and column.name not in (*texts, *LEFT_OUT)]
    pieces: list[Any] = []
    while found := list(islice(rows, ROWS_AT_ONCE)):  # in pieces, which need less memory than all rows as dictionaries
        piece = pd.DataFrame.from_records(found, exclude=[name for name in LEFT_OUT if name in found[0]])
        piece = piece.astype({name: kinds[name] for name in piece})
        for name in texts:
            piece[name] = pd.Series(list(map(plain_text, piece[name])), dtype="object")
        for name in of_text:
            piece[name] = pd.Series(list(map(text_cell, piece[name])), dtype="object")
        pieces.append(piece)
    return pd.concat(pieces, ignore_index=True) if pieces else None
