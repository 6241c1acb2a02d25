"""Fits parameters of a model to data, and says how well they are determined.

Candidates are proposed by Optuna's TPE sampler. Each candidate is an experiment of its own, with the same seeds as all others, so
that the misfit is a function of the parameters alone. The candidates and their rows stay in the folder: a fit that was killed
continues where it was, and gives the same result.

Around the best candidate, the sum of squared differences is described by a quadratic surface. It gives every second candidate (its
minimum), the intervals of the parameters and the estimates of parameter recovery. An interval has the values of a parameter at which the
least sum of squares over all other parameters, relative to that over all of them, is at most 1 + F / (n - p), with the 95 % quantile of
the F distribution with 1 and n - p degrees of freedom: n means with normal errors of one unknown variance, and p parameters.
Source: Bates and Watts (1988), Nonlinear Regression Analysis and Its Applications, section 6.1 (profile t); Raue et al. (2009),
Bioinformatics 25(15), for profile likelihoods.
"""

from __future__ import annotations

import csv
import io
import itertools
import json
import math
import random
import warnings
from collections import defaultdict
from collections.abc import Callable, Collection, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import asdict, dataclass, field
from hashlib import sha256
from pathlib import Path
from statistics import fmean
from typing import Any

import numpy as np
import optuna
from numpy.typing import NDArray
from scipy.special import stdtrit

from actr3d.configuration import Configuration
from actr3d.errors import ConfigurationError, DesignError, ExperimentError, SettingError, alternatives, did_you_mean
from actr3d.experiment.cluster import Progress, run_experiment
from actr3d.experiment.design import DIGITS, OWN_COLUMNS, OWN_NUMBERS, Design, Measured
from actr3d.experiment.human_data import Schema, factor_name, library_human_data, plain_levels, plain_text, read_human_data, read_human_text
from actr3d.experiment.measures import known_measures
from actr3d.experiment.specification import Experiment, specify
from actr3d.experiment.store import SPECIFICATION, Store, summary

Shown = Callable[[str, int], AbstractContextManager[Callable[[Progress], object]]]
"""Shows the progress of an experiment inside a block: called with what it is for, and its number of trials."""

NARROWEST = 1e-4
"""The least width of a range."""
STARTING = 10
"""The number of candidates that are drawn evenly before any are proposed."""
DRAWS = 20
"""The maximum number of values that are drawn for a simulated data set, until the model has all means."""
GRID = 201
"""The number of values of each parameter at which the surface of one or two parameters is evaluated; fewer for more parameters."""

Cell = tuple[tuple[str, Any], ...]
"""The conditions of a mean: names of columns and their values."""


@dataclass(frozen=True, kw_only=True)
class TargetMean:
    """A mean that a model is compared with."""

    conditions: Mapping[str, Any]
    """The group and the levels of factors; a missing one means all of them."""
    measure: str
    mean: float


@dataclass(frozen=True, kw_only=True)
class Range(Configuration):
    """The range in which a parameter is fitted."""

    name: str
    low: float
    high: float

    def __post_init__(self) -> None:
        """Checks the range.

        Raises:
            ConfigurationError: If a bound is not a number.
            SettingError: If the range is empty.
        """
        super().__post_init__()
        if self.low >= self.high:
            raise SettingError(f"--parameter {self.name}: must be a range LOW..HIGH with LOW < HIGH (got {self.low:g}..{self.high:g})")
        if self.high - self.low < NARROWEST:
            raise SettingError(
                f"--parameter {self.name}: must be at least {NARROWEST:g} wide: values have {DIGITS} decimals "
                f"(got {self.low:g}..{self.high:g}); use a smaller unit"
            )
        if self.name in OWN_NUMBERS:
            raise SettingError(f"--parameter {self.name}: is a number of the design, not a parameter of the model")

    @classmethod
    def from_text(cls, text: str) -> Range:
        """Returns the range that `NAME=LOW..HIGH` describes.

        Raises:
            SettingError: If the text has another form, or the range is empty or infinite.
        """
        name, equals, bounds = text.partition("=")
        low, dots, high = bounds.partition("..")
        try:
            if not equals or not dots:
                raise ValueError
            return cls(name=name.strip(), low=float(low), high=float(high))
        except ValueError:
            raise SettingError(f"--parameter: must be NAME=LOW..HIGH (got {text!r})") from None
        except ConfigurationError as error:
            raise error if isinstance(error, SettingError) else SettingError(f"--parameter {name.strip()}: {error}") from None


@dataclass(frozen=True, kw_only=True)
class Agreement:
    """How well a model's means agree with a target's."""

    cells: int
    """The number of means that are compared."""
    rmse: float
    """The root mean square difference, in the unit of the measure."""
    r2: float | None
    """The square of the correlation; None if there is none."""
    rows: tuple[dict[str, Any], ...] = ()
    """Each mean: its conditions, `target` and `model`."""


@dataclass(frozen=True, kw_only=True)
class Fitted:
    """A fitted parameter."""

    name: str
    value: float
    """The value of the best candidate."""
    low: float | None
    """The lower bound of its interval; None if the data do not determine it within the range that was searched."""
    high: float | None
    """The upper bound."""


@dataclass(frozen=True, kw_only=True)
class FitResult:
    """The result of a fit."""

    design: str
    measure: str
    parameters: tuple[Fitted, ...]
    fit: Agreement
    """The agreement with the target that the parameters were fitted to."""
    candidates: int
    held_out: dict[str, Agreement] = field(default_factory=dict[str, Agreement])
    """The agreement with targets that the parameters were not fitted to, by design."""
    ablated: dict[str, Agreement] = field(default_factory=dict[str, Agreement])
    """The agreement with the target if one part of the model is changed, by `NAME=VALUE`."""
    recovered: tuple[dict[str, float], ...] = ()
    """For each simulated data set, the true value of each parameter (`true NAME`) and its estimate (`NAME`)."""


class Fit:
    """A fit of parameters to means.

    Args:
        design: The name or file of the design.
        ranges: The parameters and their ranges.
        target: The means to fit, of one measure.
        folder: Where candidates are kept.
        client: The cluster.
        options: `values`, `participants` and `trials` for `specify`. The values hold for held-out designs too, the numbers do not.
        seed: The seed of the proposals.
        progress: Shows the progress of each experiment.

    Raises:
        ExperimentError: If nothing can be fitted.
        SettingError: If a parameter is given twice, or is a factor of the design.
        DesignError: If the design, or the range of a parameter, does not fit the model.
    """

    def __init__(
        self,
        design: str,
        ranges: Sequence[Range],
        target: Sequence[TargetMean],
        folder: Path,
        client: Any,
        *,
        options: Mapping[str, Any] | None = None,
        seed: int = 1,
        progress: Shown = lambda _what, _total: nullcontext(lambda _: None),
    ) -> None:
        self._design, self._ranges, self._folder, self._client = design, tuple(ranges), folder, client
        self._options: dict[str, Any] = {"values": {}, "participants": None, "trials": None, **(options or {})}
        self._seed, self._progress = seed, progress
        if not ranges:
            raise ExperimentError("--parameter: must be given at least once, as NAME=LOW..HIGH")
        self.target = cells_of_target(target)
        self.measure = target[0].measure
        self._check_ranges()
        for ends in itertools.product(*((one.low, one.high) for one in ranges)):
            experiment = self._experiment(dict(zip(self._names, ends, strict=True)))  # checks the bounds of the model's parameters
            _check_conditions(self.target, experiment.design)
        self._points: list[dict[str, float]] = []
        self._means: list[dict[Cell, float]] = []
        self._failure = ""

    def _check_ranges(self) -> None:
        """Checks that each parameter has one range, and is none of the design's factors.

        Raises:
            SettingError: If one has two ranges, or is a factor with several levels or with texts.
        """
        varied, seen = self._experiment({}).design.factors, dict[str, Range]()
        for one in self._ranges:
            if one.name in seen:
                ranges = f"{seen[one.name].low:g}..{seen[one.name].high:g} and {one.low:g}..{one.high:g}"
                raise SettingError(f"--parameter {one.name}: is given twice ({ranges}); give one range")
            seen[one.name] = one
            levels = varied.get(one.name, ())
            if len(levels) > 1 or any(isinstance(level, str) for level in levels):
                shown = ", ".join(map(str, levels))
                raise SettingError(f"--parameter {one.name}: is a factor of the design ({shown}); name one that does not vary")

    @property
    def _names(self) -> list[str]:
        return [one.name for one in self._ranges]

    def run(
        self,
        candidates: int,
        *,
        hold_out: Mapping[str, Sequence[TargetMean]] | None = None,
        ablate: Sequence[str] = (),
        recover: int = 0,
    ) -> FitResult:
        """Fits the parameters, and returns the result.

        Args:
            candidates: The number of candidates.
            hold_out: Other designs, and what they are compared with.
            ablate: Changes of the model, `NAME=VALUE`, whose effects are shown.
            recover: The number of simulated data sets whose parameters are estimated.

        Raises:
            ExperimentError: If no candidate has all means of the target, or an ablation is not NAME=VALUE.
            DesignError: If a held-out design or an ablated model does not fit the values; before anything runs.
        """
        lowest = {one.name: one.low for one in self._ranges}
        for name, means in (hold_out or {}).items():
            self._other(name, lowest)
            cells_of_target(means)
        for change in ablate:
            self._without(change, lowest)
        for number in range(candidates):
            self._evaluate(number, f"candidate {number + 1} of {candidates}")
        best = min(range(candidates), key=lambda number: rmse(self._means[number], self.target))
        if not math.isfinite(rmse(self._means[best], self.target)):
            raise ExperimentError(f"measure '{self.measure}': no candidate has a mean in all conditions of the target{self._failure}")
        values = self._points[best]
        surface = self._surface(self.target)
        intervals = [surface.interval(axis) for axis in range(len(self._ranges))]
        return FitResult(
            design=self._design,
            measure=self.measure,
            parameters=tuple(_fitted(one, values[one.name], *bounds) for one, bounds in zip(self._ranges, intervals, strict=True)),
            fit=agreement(self._means[best], self.target),
            candidates=candidates,
            held_out={name: self._held_out(name, target, values) for name, target in (hold_out or {}).items()},
            ablated={change: self._compared("ablated", f"changed: {change}", self._without(change, values)) for change in ablate},
            recovered=tuple(self._recover(number, f"simulated data {number + 1} of {recover}") for number in range(recover)),
        )

    # -- candidates

    def _propose(self, number: int) -> dict[str, float]:
        """Returns a candidate; it follows from those before alone."""
        if number < STARTING:
            rng = random.Random(f"{self._seed} {number // STARTING}")
            columns: dict[str, float] = {}
            for one in self._ranges:  # a Latin hypercube: each tenth of each range once
                order = list(range(STARTING))
                rng.shuffle(order)
                columns[one.name] = round(one.low + (order[number] + 0.5) / STARTING * (one.high - one.low), DIGITS)
            return columns
        if number % 2 == 0:
            minimum = self._values_at(self._surface(self.target).minimum())
            if minimum not in self._points:
                return minimum
        distributions: dict[str, Any] = {one.name: optuna.distributions.FloatDistribution(one.low, one.high) for one in self._ranges}
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", optuna.exceptions.ExperimentalWarning)
            sampler = optuna.samplers.TPESampler(seed=self._seed * 100_003 + number, n_startup_trials=0, multivariate=True)
        optuna.logging.set_verbosity(optuna.logging.WARNING)
        study = optuna.create_study(sampler=sampler)
        for point, means in zip(self._points, self._means, strict=True):
            loss = rmse(means, self.target)
            if math.isfinite(loss):
                study.add_trial(optuna.trial.create_trial(params=point, distributions=distributions, value=loss))
        return {name: round(value, DIGITS) for name, value in study.ask(distributions).params.items()}

    def _evaluate(self, number: int, what: str) -> None:
        point = self._propose(number)
        self._points.append(point)
        means, failure = self._simulate("candidate", f"{what}: {_text_of(point)}", self._experiment(point))
        self._means.append(means)
        self._failure = self._failure or failure

    def _experiment(self, values: Mapping[str, Any]) -> Experiment:
        options = self._options
        return specify(self._design, values={**options["values"], **values}, participants=options["participants"], trials=options["trials"])

    def _simulate(
        self, kind: str, what: str, experiment: Experiment, measure: str | None = None, target: Mapping[Cell, float] | None = None
    ) -> tuple[dict[Cell, float], str]:
        """Runs an experiment, or continues it; returns its means by cell, none if all trials failed, and the first failure, "" for none.

        Its folder is named by all that determines its rows: what has run before is used again, and nothing else.

        Args:
            kind: What it is for, as in the name of its folder.
            what: The same in full, for the progress.
            experiment: The experiment.
            measure: The measure; None for that of the fit.
            target: The means with which it is compared; None for those of the fit.
        """
        text = json.dumps(experiment.specification.content(), sort_keys=True)
        folder = self._folder / f"{kind} {sha256(text.encode()).hexdigest()[:12]}"
        store = Store(folder) if (folder / SPECIFICATION).exists() else Store.create(folder, experiment.specification)
        with store:
            with self._progress(what, len(experiment.design)) as show:
                run_experiment(experiment, store, self._client, show=show)
            columns = [name for name, _ in next(iter(self.target if target is None else target))]
            failure = ""
            if store.failures:
                row = next(row for row in store.rows() if row["error"] is not None)
                failure = f"; trial {row['trial']} in '{folder}' failed: {summary(row['error'])}"
            if store.failures == store.count:
                return {}, failure
            finished = (row for row in store.rows() if row["error"] is None)
            return cells_of_rows(finished, experiment.design.measure(measure or self.measure), columns), failure

    def _compared(
        self, kind: str, what: str, experiment: Experiment, measure: str | None = None, target: Mapping[Cell, float] | None = None
    ) -> Agreement:
        """Runs an experiment, or continues it, and compares its means with a target; for the arguments, see `_simulate`.

        Raises:
            ExperimentError: If they have no conditions in common.
        """
        means, failure = self._simulate(kind, what, experiment, measure, target)
        if not means:
            raise ExperimentError(f"{kind}: no trial has a value of '{measure or self.measure}'{failure}")
        return agreement(means, self.target if target is None else target)

    def _surface(self, target: Mapping[Cell, float]) -> QuadraticSurface:
        """Returns the surface of the sums of squares of all candidates until now."""
        points = [[(point[one.name] - one.low) / (one.high - one.low) for one in self._ranges] for point in self._points]
        squares = [len(target) * (loss := rmse(means, target)) * loss for means in self._means]  # infinite, where ** would be an error
        return QuadraticSurface(np.array(points), squares, len(target))

    def _values_at(self, point: NDArray[np.float64]) -> dict[str, float]:
        parts = zip(self._ranges, point.tolist(), strict=True)
        return {one.name: round(one.low + part * (one.high - one.low), DIGITS) for one, part in parts}

    # -- other designs, other models, other data

    def _other(self, design: str, values: Mapping[str, Any]) -> Experiment:
        """Returns a held-out design with the model of the fit; its participants, trials and factors are its own.

        Raises:
            DesignError: If it has a factor whose levels would be replaced, or does not fit the values.
        """
        values = {**self._options["values"], **values}
        varied = specify(design).design.factors
        for name in values:
            if name in varied:
                option = "--parameter" if name in self._names else "--set"
                levels = ", ".join(map(str, varied[name]))
                raise DesignError(
                    f"--hold-out {design}: varies {name} ({levels}), which {option} {name} would replace; leave out one", name
                )
        try:
            return specify(design, values=values)
        except DesignError as error:
            raise DesignError(f"--hold-out {design}: {error}", error.name) from None

    def _held_out(self, name: str, target: Sequence[TargetMean], values: Mapping[str, float]) -> Agreement:
        cells = cells_of_target(target)
        return self._compared("hold-out", f"held out: {name}", self._other(name, values), target[0].measure, cells)

    def _without(self, change: str, values: Mapping[str, float]) -> Experiment:
        """Returns the experiment of the fit with an ablated model.

        Raises:
            ExperimentError: If the change has another form than NAME=VALUE.
            DesignError: If it does not fit the model.
        """
        name, equals, text = change.partition("=")
        if not equals:
            raise ExperimentError(f"--ablate: must be NAME=VALUE (got {change!r})")
        try:
            value: Any = json.loads(text)
        except ValueError:
            value = text
        try:
            return self._experiment({**values, name: value})
        except DesignError as error:
            raise DesignError(f"--ablate {change}: {str(error).removeprefix(f'--set {name}: ')}", error.name) from None

    def _recover(self, number: int, what: str) -> dict[str, float]:
        """Simulates data with known parameters, and estimates these from the candidates.

        Raises:
            ExperimentError: If the model has means in all conditions of the target for none of the values that are drawn.
        """
        rng = random.Random(f"{self._seed} recover {number}")
        failure = ""
        for _ in range(DRAWS):  # where the model fails, there are no data
            true = {one.name: round(rng.uniform(one.low, one.high), DIGITS) for one in self._ranges}
            simulated, failure = self._simulate(
                "simulated", f"{what}: {_text_of(true)}", self._experiment({**true, "seed": 1_000_000 + number})
            )
            if math.isfinite(rmse(simulated, self.target)):
                target = {cell: simulated[cell] for cell in self.target}
                return {**{f"true {name}": value for name, value in true.items()}, **self._values_at(self._surface(target).minimum())}
        raise ExperimentError(f"--recover: no mean in all conditions of the target for {DRAWS} drawn values{failure}")


def _text_of(values: Mapping[str, float]) -> str:
    return ", ".join(f"{name} = {value:g}" for name, value in values.items())


class QuadraticSurface:
    """A quadratic surface through the sums of squares of candidates near the best one.

    Args:
        points: The candidates, (n, p), each parameter from 0 to 1.
        squares: Their sums of squared differences from the data; infinite for candidates without a value.
        data: The number of data.
    """

    def __init__(self, points: NDArray[np.float64], squares: Sequence[float], data: int) -> None:
        values = np.array(squares)
        order = np.argsort(values, kind="stable")
        order = order[np.isfinite(values[order])]
        values = np.maximum(values, 1e-12)
        self._axes, self._data = points.shape[1], data
        terms = (self._axes + 1) * (self._axes + 2) // 2
        near = order[: max(2 * terms, len(order) // 2)]
        self._least = float(values[order[0]]) if len(order) else 1e-12
        design = self._terms(points[near])
        # The best candidates weigh most, as many as a surface needs: it need not be quadratic far from the minimum.
        half = float(values[order[min(terms, len(order)) - 1]]) if len(order) else 1.0
        weighted = design.T * (half / (values[near] + half))
        self._weights = np.linalg.solve(weighted @ design + 1e-9 * np.eye(design.shape[1]), weighted @ values[near])

    def _terms(self, points: NDArray[np.float64]) -> NDArray[np.float64]:
        products = [points[:, a] * points[:, b] for a in range(self._axes) for b in range(a, self._axes)]
        return np.column_stack([np.ones(len(points)), points, *products])

    def _grid(self) -> NDArray[np.float64]:
        """Returns all points at which the surface is evaluated, (count, ..., count, p)."""
        count = GRID if self._axes <= 2 else max(5, int(GRID ** (2 / self._axes)))
        return np.stack(np.meshgrid(*[np.linspace(0.0, 1.0, count)] * self._axes, indexing="ij"), axis=-1)

    def minimum(self) -> NDArray[np.float64]:
        """Returns the point with the least sum of squares, (p,)."""
        points = self._grid().reshape(-1, self._axes)
        return points[int(np.argmin(self._terms(points) @ self._weights))]

    def interval(self, axis: int) -> tuple[float | None, float | None]:
        """Returns the bounds of the 95 % interval of a parameter; None where the range ends first.

        With few more data than parameters, an interval is wide: the data say little of how much they vary. With no more data than
        parameters they say nothing of it, and both bounds are None.
        """
        free = self._data - self._axes
        if free <= 0:
            return None, None
        grid = self._grid()
        squares = np.maximum(self._terms(grid.reshape(-1, self._axes)) @ self._weights, self._least).reshape(grid.shape[:-1])
        profile = squares.min(axis=tuple(other for other in range(self._axes) if other != axis))
        most = 1 + stdtrit(free, 0.975) ** 2 / free  # the square of t has the F distribution with 1 and n - p degrees of freedom
        inside = np.linspace(0, 1, len(profile))[profile <= most * profile.min()]
        low, high = float(inside.min()), float(inside.max())
        return None if low <= 0 else low, None if high >= 1 else high


# -- means


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
    if not path.exists():
        raise ExperimentError(f"human data '{name}': no such file{alternatives(name, known, 'the library has:')}")
    names = {factor_name(name): name for name in (*design.factors, *(one.over for one in design.kept if one.over is not None))}
    levels: Any = {shown: plain_levels(design.factors.get(name, ())) for shown, name in names.items()}
    texts = {(shown, plain_text(level)): _in_cell(level) for shown, name in names.items() for level in design.factors.get(name, ())}
    lines = [row for row in csv.reader(io.StringIO(read_human_text(path))) if row and not row[0].lstrip().startswith("#")]
    head = [cell.strip() for cell in lines[0]] if lines else []
    ignored = {*OWN_COLUMNS, *design.known_columns} - {"participant", "group", *names.values()}
    if "measure" in head:
        place = head.index("measure")
        measures = [row[place].strip() for row in lines[1:] if len(row) > place]
    else:
        there = [column for column in head if factor_name(column) not in {"participant", "group", *levels, *ignored}]
        kept = {one.name for one in design.kept}
        # Any other column is an error of the reader. A design that keeps all measures does not say which there are.
        measures = [column for column in there if column == measure or (column in kept if kept else not did_you_mean(column, levels))]
        if measure in measures:  # another one may be a text
            ignored |= {*measures} - {measure}
            measures = [measure]
    trial_has = [one.name for one in design.kept] or list(known_measures(experiment) or ())
    if trial_has and measure is None and len(set(measures)) == 1:
        measures = trial_has  # the reader names the line with another one
    parameters = {factor_name(one.name): one for one in experiment.parameters if one.name in design.factors}
    schema = Schema(
        groups=list(design.groups),
        factors=levels,
        measures=list(dict.fromkeys(measures)),
        parameters=parameters,
        ignored=sorted(ignored),
    )
    data = read_human_data(path, schema)
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


def check_measure(name: str, known: Collection[str], experiment: Experiment) -> None:
    """Checks that the trials of a design have the measure that is fitted.

    Args:
        name: The measure.
        known: The measures of a trial.
        experiment: The experiment with the design.

    Raises:
        ExperimentError: If it is none of them.
    """
    if name not in known:
        of = experiment.specification.name
        raise ExperimentError(
            f"--measure: the trials of the design '{of}' have no measure '{name}'{alternatives(name, known, 'they have:')}"
        )


def _in_cell(level: Any) -> Any:
    """Returns a level in the form that a `Cell` has: lists and dicts as texts."""
    return plain_text(level) if isinstance(level, (list, tuple, dict)) else level


def _check_conditions(target: Mapping[Cell, float], of: Design) -> None:
    """Checks that a design has the conditions of a target.

    Raises:
        ExperimentError: If the target has a mean for a level that the design lacks.
    """
    for cell in target:
        for name, level in cell:
            levels = of.factors.get(name)
            if levels is not None and level not in map(_in_cell, levels):
                known = ", ".join(map(str, levels))
                what = f"{level:g}" if isinstance(level, float) else level
                raise ExperimentError(f"--target: has a mean for {name} {what}, which the design does not have; it has: {known}")


def cells_of_target(target: Sequence[TargetMean]) -> dict[Cell, float]:
    """Returns the means of a target by cell.

    Raises:
        ExperimentError: If there are none, they are of several measures, two are of the same conditions, or some of fewer conditions.
    """
    measures = sorted({one.measure for one in target})
    if len(measures) != 1:
        raise ExperimentError(f"--target: must have means of one measure; choose it with --measure ({', '.join(measures) or 'none'})")
    found: dict[Cell, float] = {}
    for one in target:
        cell = tuple(sorted((name, _in_cell(level)) for name, level in one.conditions.items()))
        if cell in found:
            raise ExperimentError(f"--target: has two means for {dict(cell)}")
        found[cell] = one.mean
    if len(named := {tuple(name for name, _ in cell) for cell in found}) > 1:
        these = " and ".join(", ".join(names) or "none" for names in sorted(named))
        raise ExperimentError(f"--target: all means must be of the same conditions (got {these}): is a cell empty?")
    return found


def cells_of_rows(rows: Any, measure: Measured, columns: Sequence[str]) -> dict[Cell, float]:
    """Returns the means of a measure by cell, with participants as the unit: means of the participants' means; none without values.

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
                found[tuple(sorted((column, _in_cell(known[column])) for column in columns))][row["participant"]].append(float(value))
    if not found:
        wrong = next((name for name in (measure.name, *columns) if name not in known), None)
        if wrong is not None:
            raise ExperimentError(f"no trial has a value of '{wrong}'{alternatives(wrong, known, 'the columns are:')}")
    return {cell: fmean(fmean(values) for values in people.values()) for cell, people in found.items()}


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
    wanted, got = (np.array(values) for values in zip(*both.values(), strict=True))
    varied = len(both) > 2 and wanted.std() > 0 and got.std() > 0
    return Agreement(
        cells=len(both),
        rmse=float(np.sqrt(np.mean((wanted - got) ** 2))),
        r2=float(np.corrcoef(wanted, got)[0, 1] ** 2) if varied else None,
        rows=tuple({**dict(cell), "target": mean, "model": round(found, DIGITS)} for cell, (mean, found) in both.items()),
    )


def to_json(result: FitResult) -> str:
    """Returns the result as JSON."""
    return json.dumps(asdict(result), indent=1, ensure_ascii=False)


def _fitted(one: Range, value: float, low: float | None, high: float | None) -> Fitted:
    """Returns a fitted parameter with its interval, which contains the best candidate even if the surface has its minimum elsewhere."""
    bounds = [None if part is None else round(one.low + part * (one.high - one.low), DIGITS) for part in (low, high)]
    return Fitted(
        name=one.name,
        value=value,
        low=None if bounds[0] is None else min(bounds[0], value),
        high=None if bounds[1] is None else max(bounds[1], value),
    )
