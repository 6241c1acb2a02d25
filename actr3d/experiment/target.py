"""Means that a model is compared with: those of human data, and those of a model's trials in the same conditions."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from statistics import fmean, stdev
from typing import Any

from actr3d.errors import ExperimentError, SettingError, alternatives, did_you_mean, reason_of
from actr3d.experiment.design import DIGITS, OWN_COLUMNS, Design, Measured, factor_name
from actr3d.experiment.human_data import HumanFile, Schema, library_human_data, plain_levels
from actr3d.experiment.plain_values import plain_text
from actr3d.experiment.report.analyses import columns_of_people
from actr3d.experiment.report.statistics import rmse_and_r
from actr3d.experiment.specification import Experiment
from actr3d.experiment.trial_measures import known_measures

Cell = tuple[tuple[str, Any], ...]
"""The conditions of a mean: names of columns and their values."""
ByParticipant = Mapping[str, Sequence[float]]
"""The values of a measure in a cell, by participant."""


@dataclass(frozen=True, kw_only=True)
class TargetMean:
    """A mean that a model is compared with."""

    conditions: Mapping[str, Any]
    """The group and the levels of factors; a missing one means all of them."""
    measure: str
    mean: float


@dataclass(frozen=True, kw_only=True)
class Agreement:
    """How well a model's means agree with a target's."""

    cells: int
    """The number of means that are compared: those of conditions in which no trial failed."""
    missing: int
    """The number of means of the target that are not compared: the model has none there, or a trial failed."""
    rmse: float | None
    """The root mean square difference, in the unit of the measure; None if no mean is compared."""
    r: float | None
    """The correlation; None if there is none. A negative one is that of a model that falls where the target rises."""
    r2: float | None
    """Its square."""
    rows: tuple[dict[str, Any], ...] = ()
    """Each mean: its conditions, `target` and `model`."""
    failed: int = 0
    """The number of trials that failed."""
    trials: int = 0
    """The number of all trials."""
    failure: str | None = None
    """Why no mean is compared; None if some are."""


def load_target(name: str, experiment: Experiment, measure: str | None = None) -> tuple[TargetMean, ...]:
    """Loads the means of human data; those of trials are means of the participants' means.

    Args:
        name: The name of data of the library, or a file.
        experiment: The experiment whose groups and factors the data have.
        measure: The measure to load; None for all.

    Raises:
        ExperimentError: If there are no such data, or they are not valid for the experiment.
    """
    design, known = experiment.design, library_human_data()
    path = known.get(name, Path(name))
    try:
        there = path.exists()
    except OSError as error:
        raise ExperimentError(f"human data '{name}': cannot be read ({reason_of(error)})") from None
    if not there:
        raise ExperimentError(f"human data '{name}': no such file{alternatives(name, known, 'the library has:')}")
    names = {factor_name(name): name for name in (*design.factors, *(one.over for one in design.kept if one.over is not None))}
    levels: Any = {shown: plain_levels(design.factors.get(name, ())) for shown, name in names.items()}
    texts = {(shown, plain_text(level)): in_cell(level) for shown, name in names.items() for level in design.factors.get(name, ())}
    file = HumanFile(path)
    trial_has = measures_of(experiment)
    for_report = {*columns_of_people([*trial_has, *design.known_columns])} - {*trial_has, measure}
    ignored = {*OWN_COLUMNS, *design.known_columns, *for_report} - {"participant", "group", *names.values()}
    if "measure" in file.columns and file.is_published(trial_has):
        measures = file.cells("measure")
    else:
        there = [column for column in file.columns if factor_name(column) not in {"participant", "group", *levels, *ignored}]
        kept = {one.name for one in design.kept}
        # Any other column is an error of the reader. A design that keeps all measures does not say which there are.
        measures = [column for column in there if column == measure or (column in kept if kept else not did_you_mean(column, levels))]
        if measure in measures:  # another one may be a text
            ignored |= {*measures} - {measure}
            measures = [measure]
    if measure is not None and (not trial_has or measure in trial_has):
        measures = [*measures, measure]  # an error of the reader names it, whether or not the data have it
    if trial_has and measure is None and len(set(measures)) <= 1:
        measures = trial_has  # the reader's error names the line of an unknown one, or lists those that are known
    parameters = {factor_name(one.name): one for one in experiment.parameters if one.name in design.factors}
    schema = Schema(
        groups=list(design.groups),
        factors=levels,
        measures=list(dict.fromkeys(measures)),
        parameters=parameters,
        ignored=sorted(ignored),
    )
    data = file.read(schema)
    people: defaultdict[tuple[str, Cell], defaultdict[str, list[float]]] = defaultdict(lambda: defaultdict(list))
    for number, row in enumerate(data.rows):
        given = [(column, row[column]) for column in ("group", *levels) if row.get(column) is not None]
        cell = tuple((names.get(column, column), texts.get((column, level), level)) for column, level in given)
        for one in [row["measure"]] if data.published else data.measures:
            value = row["mean"] if data.published else row[one]
            if value is not None:
                people[one, cell][row.get("participant", str(number))].append(value)
    found = tuple(
        TargetMean(conditions=dict(cell), measure=one, mean=fmean(fmean(values) for values in of.values()))
        for (one, cell), of in people.items()
        if measure in (None, one)
    )
    if not found:
        raise ExperimentError(f"human data '{name}': have no means of '{measure}'; they have: {', '.join(data.measures) or 'none'}")
    if measure is not None:
        check_measure(measure, trial_has or (measure,), experiment)
    return found


def measures_of(experiment: Experiment) -> list[str]:
    """Returns the names of the measures of a trial; none if only a run shows them."""
    return [one.name for one in experiment.design.kept] or list(known_measures(experiment) or ())


def check_measure(name: str, known: Collection[str], experiment: Experiment) -> None:
    """Checks that the measure that is fitted is one of the known ones of a trial of an experiment.

    Raises:
        SettingError: If it is none of them.
    """
    if name not in known:
        of = experiment.specification.name
        raise SettingError(f"--measure: the trials of the design '{of}' have no measure '{name}'{alternatives(name, known, 'they have:')}")


def in_cell(level: Any) -> Any:
    """Returns a level in the form that a `Cell` has: lists and dicts as texts."""
    return plain_text(level) if isinstance(level, (list, tuple, dict)) else level


def _absent_factor(cell: Cell, of: Design) -> str | None:
    """Returns the first factor whose level in a cell does not occur in a design; None if the design has all levels of the cell."""
    levels = ((name, level, of.factors.get(name)) for name, level in cell)
    return next((name for name, level, known in levels if known is not None and level not in map(in_cell, known)), None)


def check_conditions(target: Mapping[Cell, float], of: Design) -> None:
    """Checks that a design has the conditions of a target.

    Raises:
        ExperimentError: If the target has a mean for a level that the design lacks.
    """
    for cell in target:
        if (name := _absent_factor(cell, of)) is not None:
            level, known = dict(cell)[name], ", ".join(map(str, of.factors[name]))
            what = f"{level:g}" if isinstance(level, float) else level
            raise ExperimentError(f"--target: has a mean for {name} {what}, which the design does not have; it has: {known}")


def check_in_common(target: Mapping[Cell, float], of: Design, option: str) -> None:
    """Checks that a design has some conditions of a target; `option` names in errors what gave the design.

    Raises:
        ExperimentError: If it has none.
    """
    absent = {cell: _absent_factor(cell, of) for cell in target}
    if (name := next(iter(absent.values()))) is not None and None not in absent.values():
        there = ", ".join(dict.fromkeys(str(dict(cell)[name]) for cell in target))
        design = ", ".join(map(str, of.factors[name]))
        raise ExperimentError(f"{option}: the target has no mean for {name} {design}; it has: {there}")


def cells_of_target(target: Sequence[TargetMean], option: str = "--target") -> dict[Cell, float]:
    """Returns the means of a target by cell; `option` names in errors what gave them.

    Raises:
        ExperimentError: If there are none, they are of several measures, two are of the same conditions, or some of fewer conditions.
    """
    measures = sorted({one.measure for one in target})
    if len(measures) != 1:
        raise ExperimentError(f"{option}: must have means of one measure; choose it with --measure ({', '.join(measures) or 'none'})")
    found: dict[Cell, float] = {}
    for one in target:
        cell = tuple(sorted((name, in_cell(level)) for name, level in one.conditions.items()))
        if cell in found:
            raise ExperimentError(f"{option}: has two means for {dict(cell)}")
        found[cell] = one.mean
    if len(named := {tuple(name for name, _ in cell) for cell in found}) > 1:
        these = " and ".join(", ".join(names) or "none" for names in sorted(named))
        raise ExperimentError(f"{option}: all means must be of the same conditions (got {these}): is a cell empty?")
    return found


def cells_of_rows(rows: Any, measure: Measured, columns: Sequence[str]) -> dict[Cell, ByParticipant]:
    """Returns the values of a measure by cell and participant; nothing without values.

    Raises:
        ExperimentError: If no row has a column for the measure, or one of the columns.
    """
    found: defaultdict[Cell, defaultdict[str, list[float]]] = defaultdict(lambda: defaultdict(list))
    known: dict[str, Any] = {}
    for row in rows:
        known = row
        for number, value in measure.values(row):
            known = {**row, **number} if measure.over is None else {**row, **number, measure.name: value}
            if isinstance(value, (int, float)) and all(column in known for column in columns):
                found[tuple(sorted((column, in_cell(known[column])) for column in columns))][row["participant"]].append(float(value))
    if not found:
        wrong = next((name for name in (measure.name, *columns) if name not in known), None)
        if wrong is not None:
            raise ExperimentError(f"no trial has a value of '{wrong}'{alternatives(wrong, known, 'the columns are:')}")
    return {cell: dict(participants) for cell, participants in found.items()}


def mean_of(participants: ByParticipant) -> float:
    """Returns the mean of a cell, with participants as the unit: the mean of the participants' means."""
    return fmean(map(fmean, participants.values()))


def chance_error(participants: ByParticipant, elsewhere: ByParticipant) -> float:
    """Returns the standard error of the mean of a cell that comes from chance in the model.

    All candidates have the same participants and conditions, so what these differ in cancels in the difference from another candidate: of
    the participants' means, or of the trials of a single participant. One trial does not show chance: 0.

    Args:
        participants: The values of the cell, in the order of trials.
        elsewhere: Its values at another candidate, near enough that the model does nearly the same.
    """
    pairs = [(fmean(participants[one]), fmean(elsewhere[one])) for one in participants.keys() & elsewhere.keys()]
    if len(pairs) == 1:
        pairs = [pair for one in participants.keys() & elsewhere.keys() for pair in zip(participants[one], elsewhere[one], strict=False)]
    return stdev(here - there for here, there in pairs) / math.sqrt(2 * len(pairs)) if len(pairs) > 1 else 0.0


def rmse(means: Mapping[Cell, float], target: Mapping[Cell, float]) -> float:
    """Returns the root mean square difference; infinite if a mean is missing."""
    if not target or any(cell not in means for cell in target):
        return math.inf
    return math.dist([means[cell] for cell in target], list(target.values())) / math.sqrt(len(target))


def agreement(means: Mapping[Cell, float], target: Mapping[Cell, float]) -> Agreement:
    """Returns how well means agree with those of a target, in the conditions that both have.

    Raises:
        ExperimentError: If they have no conditions in common.
    """
    both = {cell: (mean, means[cell]) for cell, mean in target.items() if cell in means}
    if not both:
        raise ExperimentError("the design and the target have no conditions in common")
    error, r = rmse_and_r(*zip(*both.values(), strict=True))
    return Agreement(
        cells=len(both),
        missing=len(target) - len(both),
        rmse=error,
        r=None if math.isnan(r) else r,
        r2=None if math.isnan(r) else r * r,
        rows=tuple({**dict(cell), "target": mean, "model": round(found, DIGITS)} for cell, (mean, found) in both.items()),
    )
