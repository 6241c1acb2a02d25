"""Fits parameters of a model to data, and says how well they are determined.

The first ten candidates are a Latin hypercube. From then on, each other candidate is the one that fits best according to an emulator of
the model (`actr3d.experiment.emulator`); between them, candidates at the bounds of the intervals of the parameters, and of Optuna's TPE
sampler, take turns. Each candidate is an experiment of its own, with the same seeds as all others, so that the misfit is a function of the
parameters alone. The candidates and their rows stay in the folder: a fit that was killed continues where it was, and gives the same result.

The emulator also gives the intervals of the parameters and the estimates of parameter recovery.
"""

from __future__ import annotations

import itertools
import json
import math
import random
import warnings
from collections.abc import Callable, Mapping, Sequence
from contextlib import AbstractContextManager, nullcontext
from dataclasses import dataclass, field, replace
from functools import cached_property
from hashlib import sha256
from pathlib import Path
from typing import Annotated, Any

import numpy as np
import optuna
from annotated_types import Ge, Le
from numpy.typing import NDArray

from actr3d.configuration import Configuration
from actr3d.errors import ConfigurationError, DesignError, ExperimentError, SettingError
from actr3d.experiment.cluster import ExperimentProgress, run_experiment
from actr3d.experiment.design import OWN_NUMBERS
from actr3d.experiment.distributions import DIGITS
from actr3d.experiment.emulator import STEPS, Emulator
from actr3d.experiment.plain_values import HUGE, plain_text
from actr3d.experiment.specification import Experiment
from actr3d.experiment.store import SPECIFICATION, Store, summary
from actr3d.experiment.target import (
    Agreement,
    ByParticipant,
    Cell,
    TargetMean,
    agreement,
    cells_of_rows,
    cells_of_target,
    chance_error,
    check_conditions,
    check_in_common,
    in_cell,
    mean_of,
    rmse,
)
from actr3d.runner.cli_options import read_settings

ProgressBar = Callable[[str, int], AbstractContextManager[Callable[[ExperimentProgress], object]]]
"""Shows the progress of an experiment inside a block: called with what it is for, and its number of trials."""

NARROWEST = 1e-4
"""The least width of a range."""
STARTING = 10
"""The number of candidates that are drawn evenly before any are proposed."""
DRAWS = 20
"""The maximum number of values that are drawn for a simulated data set, until the model has all means."""


@dataclass(frozen=True, kw_only=True)
class HeldOut:
    """A design whose means are predicted and not fitted."""

    experiment: Experiment
    target: Sequence[TargetMean]
    """What its means are compared with."""


@dataclass(frozen=True, kw_only=True)
class Range(Configuration):
    """The range in which a parameter is fitted."""

    name: str
    low: Annotated[float, Ge(-HUGE)]
    """Its least value; rounded up to a value that can be tried, with 6 decimals."""
    high: Annotated[float, Le(HUGE)]
    """Its greatest value; rounded down likewise."""

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
        for name, inwards in (("low", 1), ("high", -1)):  # rounded like values, which may lie at a bound
            bound = getattr(self, name)
            rounded = round(bound, DIGITS)
            outside = (rounded - bound) * inwards < 0
            object.__setattr__(self, name, round(rounded + inwards * 10**-DIGITS, DIGITS) if outside else rounded)

    def at(self, part: float) -> float:
        """Returns the value at a part of the range, from 0 to 1."""
        return round(self.low + part * (self.high - self.low), DIGITS)

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
            if not (math.isfinite(float(low)) and math.isfinite(float(high))):
                raise SettingError(f"--parameter {name.strip()}: must be a finite range (got {bounds.strip()})")
            return cls(name=name.strip(), low=float(low), high=float(high))
        except ValueError:
            raise SettingError(f"--parameter: must be NAME=LOW..HIGH (got {text!r})") from None
        except ConfigurationError as error:
            raise error if isinstance(error, SettingError) else SettingError(f"--parameter {name.strip()}: {error}") from None


@dataclass(frozen=True, kw_only=True)
class TriedCandidate:
    """Values of the parameters that were tried."""

    values: Mapping[str, float]
    rmse: float | None
    """The root mean square difference from the target; None if the model has no mean in some condition, or a trial failed there."""
    failed: int
    """The number of trials that failed."""
    trials: int
    """The number of all trials."""


@dataclass(frozen=True, kw_only=True)
class _Simulated:
    """What a model has done."""

    cells: Mapping[Cell, ByParticipant]
    """The values of its trials by cell, without cells in which a trial failed."""
    failed: int
    trials: int
    failure: str
    """The first failure, as text to append to an error message; "" for none."""

    @cached_property
    def means(self) -> dict[Cell, float]:
        """The means by cell."""
        return {cell: mean_of(participants) for cell, participants in self.cells.items()}


@dataclass(frozen=True, kw_only=True)
class Fitted:
    """A fitted parameter."""

    name: str
    value: float
    """The value that fits best according to the emulator; if this is not confirmed or fails, the value that was run and fits best."""
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
    is_confirmed: bool
    """Whether the model does at the fitted values and at all candidates what the emulator predicts; otherwise, there are no intervals."""
    predicted_worst: Mapping[str, float] | None
    """The candidate whose means differ most from what is predicted there; None if the fit is confirmed."""
    tried: tuple[TriedCandidate, ...]
    """All candidates, in order."""
    held_out: dict[str, Agreement] = field(default_factory=dict[str, Agreement])
    """The agreement with targets that the parameters were not fitted to, by design."""
    ablated: dict[str, Agreement] = field(default_factory=dict[str, Agreement])
    """The agreement with the target if one part of the model is changed, by `NAME=VALUE`."""
    recovered: tuple[dict[str, float], ...] = ()
    """For each simulated data set, the true value of each parameter (`true NAME`) and its estimate (`NAME`)."""


class Fit:
    """A fit of parameters to means.

    Args:
        name: The name or file of the design, for the result.
        experiment: The experiment without the fitted parameters.
        ranges: The parameters and their ranges.
        target: The means to fit, of one measure.
        folder: Where candidates are kept.
        open_cluster: Opens the folder and the cluster, and yields the cluster; called when all else has been checked.
        seed: The seed of the proposals.
        progress: Shows the progress of each experiment.
        evaluated: Called with the root mean square difference of each candidate; infinite if it has not all means.

    Raises:
        ExperimentError: If nothing can be fitted.
        SettingError: If no parameter is given, or one twice, or one is a factor of the design, or no number.
        DesignError: If the design, or the range of a parameter, does not fit the model.
    """

    def __init__(
        self,
        name: str,
        experiment: Experiment,
        ranges: Sequence[Range],
        target: Sequence[TargetMean],
        folder: Path,
        open_cluster: Callable[[], AbstractContextManager[Any]],
        *,
        seed: int = 1,
        progress: ProgressBar = lambda _what, _total: nullcontext(lambda _: None),
        evaluated: Callable[[float], object] = lambda _rmse: None,
    ) -> None:
        self._name, self._base, self._ranges, self._folder, self._open_cluster = name, experiment, tuple(ranges), folder, open_cluster
        self._seed, self._progress, self._evaluated, self._client = seed, progress, evaluated, None
        if not ranges:
            raise SettingError("--parameter: must be given at least once, as NAME=LOW..HIGH")
        self.target = cells_of_target(target)
        self.measure = target[0].measure
        self._check_ranges()
        for ends in itertools.product(*((one.low, one.high) for one in ranges)):
            at_ends = self._experiment(dict(zip(self._names, ends, strict=True)))  # checks the bounds of the model's parameters
            check_conditions(self.target, at_ends.design)
        self._points: list[dict[str, float]] = []
        self._simulated: list[_Simulated] = []

    def _check_ranges(self) -> None:
        """Checks that each parameter has one range and no other value, is none of the design's factors, and a number in the model.

        Raises:
            SettingError: If one is not.
        """
        varied, seen = self._base.design.factors, dict[str, Range]()
        given, defaults = self._base.specification.values, {one.name: one.default for one in self._base.parameters if one.known}
        for one in self._ranges:
            if one.name in given:
                raise SettingError(f"--parameter {one.name}: has a value by --set, too ({plain_text(given[one.name])}); leave out one")
            if isinstance(default := defaults.get(one.name), (str, bool, list, tuple, dict)):
                raise SettingError(
                    f"--parameter {one.name}: is not a number in the model (its default is {default!r}); only numbers are fitted"
                )
            if one.name in seen:
                ranges = f"{seen[one.name].low:g}..{seen[one.name].high:g} and {one.low:g}..{one.high:g}"
                raise SettingError(f"--parameter {one.name}: is given twice ({ranges}); give one range")
            seen[one.name] = one
            if one.name in varied:  # also of one level, which the seeds name
                shown = ", ".join(map(str, varied[one.name]))
                raise SettingError(f"--parameter {one.name}: is a factor of the design ({shown}); choose a parameter that is not a factor")

    @property
    def _names(self) -> list[str]:
        return [one.name for one in self._ranges]

    def run(
        self,
        candidates: int,
        *,
        held_out: Mapping[str, HeldOut] | None = None,
        ablate: Sequence[str] = (),
        recover: int = 0,
    ) -> FitResult:
        """Fits the parameters, and returns the result.

        Args:
            candidates: The number of candidates.
            held_out: Other designs, by name. The values of the fit's experiment hold for them too, its numbers do not.
            ablate: Changes of the model, `NAME=VALUE`, whose effects are shown.
            recover: The number of simulated data sets whose parameters are estimated.

        Raises:
            ExperimentError: If no candidate has all means of the target. Before anything runs: if a held-out design or ablated model has
                no condition of its target, or held-out means are those of the fit.
            SettingError: If an ablation is not NAME=VALUE; before anything runs.
            DesignError: If a held-out design or an ablated model does not fit the values; before anything runs.
        """
        held_out = held_out or {}
        lowest = {one.name: one.low for one in self._ranges}
        for name, one in held_out.items():
            cells = cells_of_target(one.target, f"--hold-out {name}")
            if one.target[0].measure == self.measure and cells == self.target:
                raise ExperimentError(f"--hold-out {name}: its means are those of the fit; name a design, or data, that are not fitted")
            check_in_common(cells, self._held_out_at(lowest, name, one).design, f"--hold-out {name}")
        for change in ablate:
            check_in_common(self.target, self._ablated(change, lowest).design, f"--ablate {change}")
        with self._open_cluster() as self._client:
            return self._result(candidates, held_out, ablate, recover)

    def _result(self, candidates: int, held_out: Mapping[str, HeldOut], ablate: Sequence[str], recover: int) -> FitResult:
        """Runs all candidates and what else is asked for; see `run`."""
        for number in range(candidates):
            self._evaluate(number, f"candidate {number + 1} of {candidates}")
        tried = self._simulated[:candidates]
        losses = [rmse(one.means, self.target) for one in tried]
        best = losses.index(min(losses))
        if not math.isfinite(losses[best]):
            failure = next((one.failure for one in tried if one.failure), "") or _most_missing([one.means for one in tried], self.target)
            raise ExperimentError(
                f"measure '{self.measure}': no candidate has a mean in all conditions of the target, without failed trials{failure}"
            )
        emulator = self._emulator(self.target)
        intervals = [emulator.interval(axis) for axis in range(len(self._ranges))]
        values = self._values_at(emulator.minimum)
        fitted = self._simulate("candidate", f"fitted values: {_text_of(values)}", self._experiment(values))
        loss = rmse(fitted.means, self.target)
        is_confirmed = emulator.is_confirmed and (not math.isfinite(loss) or self._does_as_predicted(emulator, values, fitted))
        if not is_confirmed:
            intervals = [(None, None)] * len(self._ranges)
        if not math.isfinite(loss) or (losses[best] < loss and not is_confirmed):
            values, fitted = self._points[best], tried[best]
        return FitResult(
            design=self._name,
            measure=self.measure,
            parameters=tuple(_fitted(one, values[one.name], *bounds) for one, bounds in zip(self._ranges, intervals, strict=True)),
            fit=_agreement_of(fitted, self.target),
            candidates=candidates,
            is_confirmed=is_confirmed,
            predicted_worst=None if is_confirmed else self._values_at(emulator.roughest),
            tried=tuple(
                TriedCandidate(values=point, rmse=loss if math.isfinite(loss) else None, failed=one.failed, trials=one.trials)
                for point, loss, one in zip(self._points, losses, tried, strict=False)
            ),
            held_out={name: self._predicted(values, name, one) for name, one in held_out.items()},
            ablated={change: self._compared("ablated", f"changed: {change}", self._ablated(change, values)) for change in ablate},
            recovered=tuple(self._recover(number, f"simulated data {number + 1} of {recover}") for number in range(recover)),
        )

    def _does_as_predicted(self, emulator: Emulator, values: Mapping[str, float], fitted: _Simulated) -> bool:
        """Returns whether the model does as predicted, at the fitted values and all candidates, but for chance; see `Emulator.agrees`."""
        usable = self._usable(self.target)
        places = np.array([self._parts_of(self._points[n]) for n in usable])

        def errors(found: _Simulated, place: Any) -> list[float]:
            # From the differences to the nearest candidate, but none so near that the model may draw the same random numbers.
            distances: NDArray[np.float64] = np.linalg.norm(places - place, axis=1)
            distances[distances <= 1 / STEPS] = np.inf
            nearest = int(np.argmin(distances))
            elsewhere: Mapping[Cell, ByParticipant] = self._simulated[usable[nearest]].cells if np.isfinite(distances[nearest]) else {}
            return [chance_error(found.cells[cell], elsewhere.get(cell, {})) for cell in self.target]

        at_candidates = [errors(self._simulated[n], place) for n, place in zip(usable, places, strict=True)]
        means = np.array([fitted.means[cell] for cell in self.target])
        return emulator.agrees(means, np.array(errors(fitted, self._parts_of(values))), np.array(at_candidates))

    # -- candidates

    def _propose(self, number: int) -> dict[str, float]:
        """Returns the next candidate, which depends only on the earlier candidates and the seed."""
        if number < STARTING:
            rng = random.Random(f"{self._seed} 0")
            columns: dict[str, float] = {}
            for one in self._ranges:  # a Latin hypercube: each tenth of each range once
                order = list(range(STARTING))
                rng.shuffle(order)
                columns[one.name] = one.at((order[number] + 0.5) / STARTING)
            return columns
        for proposed in self._proposed_by_emulator(number - STARTING):
            if proposed not in self._points:
                return proposed
        distributions: dict[str, Any] = {one.name: optuna.distributions.FloatDistribution(one.low, one.high) for one in self._ranges}
        with warnings.catch_warnings():
            warnings.simplefilter("ignore", optuna.exceptions.ExperimentalWarning)
            sampler = optuna.samplers.TPESampler(seed=self._seed * 100_003 + number, n_startup_trials=0, multivariate=True)
        optuna.logging.set_verbosity(optuna.logging.WARNING)
        study = optuna.create_study(sampler=sampler)
        for point, one in zip(self._points, self._simulated, strict=True):
            study.add_trial(optuna.trial.create_trial(params=point, distributions=distributions, value=rmse(one.means, self.target)))
        return {name: round(value, DIGITS) for name, value in study.ask(distributions).params.items()}

    def _proposed_by_emulator(self, number: int) -> list[dict[str, float]]:
        """Returns what the emulator proposes, in turn the values that fit best and a bound of an interval, rounded ever less; nothing where
        it is TPE's turn."""
        turn, is_bound = divmod(number, 2)
        turn %= 2 * len(self._ranges) + 1
        if not self._usable(self.target) or (is_bound and turn == 2 * len(self._ranges)):
            return []
        emulator = self._emulator(self.target)
        point = emulator.bound(turn // 2, upper=turn % 2 == 1) if is_bound else emulator.minimum
        near, nearer = (np.round(point * steps) / steps for steps in (STEPS, 100 * STEPS))
        # A candidate close to an earlier one adds little elsewhere, such as beyond a jump: every second one is proposed by TPE instead.
        return [self._values_at(one) for one in ([near] if is_bound or number // 2 % 2 else [near, nearer, point])]

    def _evaluate(self, number: int, what: str) -> None:
        point = self._propose(number)
        self._points.append(point)
        self._simulated.append(self._simulate("candidate", f"{what}: {_text_of(point)}", self._experiment(point)))
        self._evaluated(rmse(self._simulated[-1].means, self.target))

    def _experiment(self, values: Mapping[str, Any], option: str = "--parameter {}") -> Experiment:
        """Returns the experiment with other values; `option` names in errors what gave them."""
        specification = self._base.specification
        try:
            return Experiment(replace(specification, values={**specification.values, **values}))
        except DesignError as error:
            if error.name not in values:
                raise
            text = str(error).removeprefix(f"--set {error.name}: ").removeprefix("Design: ")
            raise DesignError(f"{option.format(error.name)}: {text}", error.name) from None

    def _simulate(
        self, kind: str, what: str, experiment: Experiment, measure: str | None = None, target: Mapping[Cell, float] | None = None
    ) -> _Simulated:
        """Runs an experiment, or continues it.

        A cell in which a trial failed has no mean: what is left would be the mean of the easier trials.
        The name of its folder has a hash of everything that determines its rows, so that earlier rows are used again only for the same
        experiment.

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
            conditions = [name for name in columns if name == "group" or name in experiment.design.factors]
            cells: dict[Cell, ByParticipant] = {}
            lost, failure = set[Cell](), ""
            if failed := store.failures:
                for row in (row for row in store.rows() if row["error"] is not None):
                    lost.add(tuple((name, in_cell(row[name])) for name in conditions))
                    failure = failure or f"; trial {row['trial']} in '{folder}' failed: {summary(row['error'])}"
            if failed < store.count:
                finished = (row for row in store.rows() if row["error"] is None)
                found = cells_of_rows(finished, experiment.design.measure(measure or self.measure), columns)
                cells = {cell: of for cell, of in found.items() if tuple((name, dict(cell)[name]) for name in conditions) not in lost}
            return _Simulated(cells=cells, failed=failed, trials=store.count, failure=failure)

    def _compared(
        self, kind: str, what: str, experiment: Experiment, measure: str | None = None, target: Mapping[Cell, float] | None = None
    ) -> Agreement:
        """Runs an experiment, or continues it, and compares its means with a target; for the arguments, see `_simulate`."""
        found = self._simulate(kind, what, experiment, measure, target)
        target = self.target if target is None else target
        if found.means.keys() & target.keys():
            return _agreement_of(found, target)
        without = "has a mean without failed trials" if found.failed else f"has a value of '{measure or self.measure}'"
        why = f"no condition of the target {without}{found.failure}"
        return Agreement(cells=0, missing=len(target), rmse=None, r=None, r2=None, failed=found.failed, trials=found.trials, failure=why)

    def _emulator(self, target: Mapping[Cell, float]) -> Emulator:
        """Returns the emulator that all candidates until now give: those with a mean in all conditions of the target, and those without."""
        points, usable = np.array([*map(self._parts_of, self._points)]), self._usable(target)
        means = [[self._simulated[n].means[cell] for cell in target] for n in usable]
        return Emulator(points[usable], np.array(means), np.array([*target.values()]), np.delete(points, usable, axis=0))

    def _usable(self, target: Mapping[Cell, float]) -> list[int]:
        """Returns the numbers of the candidates with a mean in all conditions of a target."""
        return [n for n, one in enumerate(self._simulated) if math.isfinite(rmse(one.means, target))]

    def _parts_of(self, values: Mapping[str, float]) -> list[float]:
        """Returns where values are in the ranges of their parameters, from 0 to 1."""
        return [(values[one.name] - one.low) / (one.high - one.low) for one in self._ranges]

    def _values_at(self, point: NDArray[np.float64]) -> dict[str, float]:
        return {one.name: one.at(part) for one, part in zip(self._ranges, point.tolist(), strict=True)}

    # -- other designs, other models, other data

    def _held_out_at(self, values: Mapping[str, Any], design: str, held_out: HeldOut) -> Experiment:
        """Returns a held-out design with the values of the fit; its participants, trials and factors are its own.

        Raises:
            DesignError: If it has a factor whose levels would be replaced, or does not fit the values.
        """
        values = {**self._base.specification.values, **values}
        varied = held_out.experiment.design.factors
        for name in values:
            if name in varied:
                option = "--parameter" if name in self._names else "--set"
                levels = ", ".join(map(str, varied[name]))
                raise DesignError(
                    f"--hold-out {design}: varies {name} ({levels}), which {option} {name} would replace; leave out one", name
                )
        try:
            return Experiment(replace(held_out.experiment.specification, values=values))
        except DesignError as error:
            raise DesignError(f"--hold-out {design}: {error}", error.name) from None

    def _predicted(self, values: Mapping[str, float], design: str, held_out: HeldOut) -> Agreement:
        experiment, cells = self._held_out_at(values, design, held_out), cells_of_target(held_out.target)
        return self._compared("hold-out", f"held out: {design}", experiment, held_out.target[0].measure, cells)

    def _ablated(self, change: str, values: Mapping[str, float]) -> Experiment:
        """Returns the experiment of the fit with one value of the model changed.

        Raises:
            SettingError: If the change has another form than NAME=VALUE, or its value is a list that is not one of Python.
            DesignError: If it does not fit the model.
        """
        if "=" not in change:
            raise SettingError(f"--ablate: must be NAME=VALUE (got {change!r})")
        option = f"--ablate {change.replace('{', '{{').replace('}', '}}')}"
        return self._experiment({**values, **read_settings([change], (), "--ablate")}, option)

    def _recover(self, number: int, what: str) -> dict[str, float]:
        """Simulates data with known parameters, and estimates these from the candidates.

        Raises:
            ExperimentError: If the model has means in all conditions of the target for none of the values that are drawn.
        """
        rng = random.Random(f"{self._seed} recover {number}")
        failure = ""
        for _ in range(DRAWS):  # where the model fails, there are no data
            true = {one.name: round(rng.uniform(one.low, one.high), DIGITS) for one in self._ranges}
            found = self._simulate("simulated", f"{what}: {_text_of(true)}", self._experiment({**true, "seed": 1_000_000 + number}))
            failure = found.failure
            if math.isfinite(rmse(found.means, self.target)):
                target = {cell: found.means[cell] for cell in self.target}
                return {**{f"true {name}": value for name, value in true.items()}, **self._values_at(self._emulator(target).minimum)}
        raise ExperimentError(f"--recover: no mean in all conditions of the target for {DRAWS} drawn values{failure}")


def _text_of(values: Mapping[str, float]) -> str:
    return ", ".join(f"{name} = {value:g}" for name, value in values.items())


def _most_missing(tried: Sequence[Mapping[Cell, float]], target: Mapping[Cell, float]) -> str:
    """Returns the condition of a target in which most candidates have no mean, as text to append to an error message."""
    counts = {cell: sum(cell not in means for means in tried) for cell in target}
    cell = max(counts, key=lambda one: counts[one])
    where = ", ".join(f"{name} {plain_text(level)}" for name, level in cell)
    return f"; {counts[cell]} of {len(tried)} candidates have no value in: {where or 'all'}"


def _agreement_of(found: _Simulated, target: Mapping[Cell, float]) -> Agreement:
    return replace(agreement(found.means, target), failed=found.failed, trials=found.trials)


def _fitted(one: Range, value: float, low: float | None, high: float | None) -> Fitted:
    """Returns a fitted parameter; its bounds are given as shares of the range."""
    least, greatest = (None if part is None else one.at(part) for part in (low, high))
    return Fitted(name=one.name, value=value, low=least, high=greatest)
