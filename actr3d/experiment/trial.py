"""Runs single trials of an experiment, each independently of all others, and returns their rows."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping
from contextlib import suppress
from dataclasses import asdict
from pathlib import Path
from typing import Any, cast

from actr3d.actr.kernel.run_limits import EndOfRun, RunLimits
from actr3d.actr.lint.checks import unchecked
from actr3d.actr.loading import run_text
from actr3d.actr.loading.global_seed import shared_random
from actr3d.actr.loading.helper_modules import HelperTexts
from actr3d.actr.loading.sweep import with_values
from actr3d.errors import DesignError, ExperimentError, did_you_mean, followed
from actr3d.experiment.design import OWN_COLUMNS, Measured, Trial
from actr3d.experiment.plain_values import HUGE, as_python, why_unstorable
from actr3d.experiment.specification import Experiment, load_blueprint, naming_the_line
from actr3d.output import printing_nothing
from actr3d.parameter_schema import parameters_of
from actr3d.runner.run import run_source
from actr3d.runner.traceback_report import traceback_report
from actr3d.values import escape_surrogates

PLAIN = (str, int, float, bool, type(None))
"""The types of measures."""
NO_MEASURE, WRONG_MEASURE = "no measure", "wrong measure"
"""What the column `end` says of a trial that lacks a measure of the design, or has one that cannot be a measure."""

Row = dict[str, Any]
"""A row of the table of trials, or a part of one: values by column."""


class MissingMeasureError(DesignError):
    """A trial lacks a measure that its design names."""


def run_trial(experiment: Experiment, trial: Trial, helpers: HelperTexts) -> Row:
    """Runs a trial and returns its measures, with `end` and `error`; a trial that fails has its traceback instead of measures.

    The files are loaded again for each trial, so that no trial can change a variable that another one reads. The helper modules are those
    of `Specification.sealed`.
    """
    try:
        with printing_nothing(), unchecked():
            end, measures = _run(experiment, trial, helpers)
        return {**_checked(measures, experiment, trial), "end": end, "error": None}
    except KeyboardInterrupt:
        raise
    except BaseException as error:  # noqa: BLE001 - every error of a model belongs in its row
        return failed_row(error)


def failed_row(error: BaseException) -> Row:
    """Returns `end` and `error` of a trial that failed."""
    end = NO_MEASURE if isinstance(error, MissingMeasureError) else WRONG_MEASURE if isinstance(error, DesignError) else "error"
    return {"end": end, "error": escape_surrogates(traceback_report(error).text.strip())}


def record_trial(experiment: Experiment, trial: Trial, file: Path | str, helpers: HelperTexts) -> Any:
    """Runs a trial again and records it in a new file; what the model prints goes to the standard output.

    Returns:
        The result of the simulation; None for a program.

    Raises:
        RecordingError: If the recording cannot be written.
        Exception: Any error that the model raises.
    """
    model, built = experiment.specification.model, experiment.blueprint is not None
    text = model.text if built else with_values(model.text, parameters_for(experiment, trial))
    settings = parameters_for(experiment, trial) if built else None
    with unchecked():
        return run_source(text, model.file, limits_of(experiment, trial), settings=settings, record=file, helpers=helpers)


def parameters_for(experiment: Experiment, trial: Trial) -> dict[str, Any]:
    """Returns the values of a trial that are parameters of the model."""
    known = {parameter.name for parameter in experiment.parameters}
    return {name: value for name, value in trial.values.items() if name in known}


def check_name(name: str, known: Collection[str]) -> None:
    """Checks that a measure is one of the known ones of a trial.

    Raises:
        MissingMeasureError: If it is none of them.
    """
    if name not in known:
        has = f"it has: {', '.join(known)}" if known else "it has none; Design.results computes them from the simulation"
        raise MissingMeasureError(f"Design.measures: the trial has no measure '{name}'{followed(did_you_mean(name, known), has)}", name)


def limits_of(experiment: Experiment, trial: Trial) -> RunLimits:
    """Returns the seed of a trial, and its end."""
    return RunLimits(seed=trial.seed, until=experiment.design.until)


def _run(experiment: Experiment, trial: Trial, helpers: HelperTexts) -> tuple[str, Mapping[str, Any]]:
    """Runs a trial; returns what ended it, and all its measures."""
    design, model = experiment.design, experiment.specification.model
    limits, values = limits_of(experiment, trial), parameters_for(experiment, trial)
    if experiment.blueprint is None:
        module = run_text(with_values(model.text, values), model.file, limits=limits, folder=Path(model.file).parent, helpers=helpers)
        end = "limits" if limits.ended else "end"
        if design.results is not None:
            return end, design.results(module)
        if limits.ended:
            raise ExperimentError(
                f"the program was stopped at its limit of {design.until:g} simulated seconds, and its variables may be unfinished: give "
                "the design more time (until), or a function `results` that knows what they are then"
            )
        return end, vars(module)
    with limits, shared_random(limits.program_seed):
        end = "limits"
        simulation, _ = load_blueprint(model, helpers).build(values)
        with suppress(EndOfRun):
            end = simulation.run().ended_by
        if design.results is not None:
            return end, design.results(simulation)
        result = simulation.result()
        if result is None:
            return end, {}
        measures = asdict(result)
        if not measures.keys() <= experiment.about.keys():
            experiment.describe(parameters_of(cast("type[Any]", type(result))))
        return end, measures


def _checked(measures: Any, experiment: Experiment, trial: Trial) -> Row:
    """Returns the measures to keep, as plain values.

    Raises:
        DesignError: If one is missing, has another type, or has the name of another column; names the file and the line.
        ExperimentError: If a value cannot be stored.
    """
    design, source = experiment.design, experiment.specification.design
    kept: Row = {}
    with naming_the_line(source, experiment.specification.name):
        if not isinstance(measures, Mapping):
            raise DesignError(f"Design.results: must return measures by name (returned {measures!r})", "results")
        given = cast("Mapping[str, Any]", measures)
        if not design.kept:
            design.check_shown(given)
        for measure in design.kept or [Measured(name=name) for name in given]:
            if measure.name not in given:
                check_name(measure.name, [name for name, value in given.items() if not name.startswith("_") and _is_value(value)])
            for name, value in measure.columns(given[measure.name]).items():
                if name in trial.columns or name in OWN_COLUMNS or name in kept:
                    raise DesignError(f"measure '{name}': is already a column of the trials; rename it", measure.name)
                kept[name] = _plain(name, value, measure)
                experiment.describe_column(name, measure)
    return kept


def _is_value(value: Any) -> bool:
    """Returns whether a value can be a measure, or the list of one."""
    return isinstance(as_python(value), (*PLAIN, list, tuple))


def _plain(name: str, value: Any, measure: Measured) -> Any:
    """Returns a value of a column of a measure as a plain one; None if it is not finite.

    Raises:
        DesignError: If it has another type.
        ExperimentError: If it cannot be stored.
    """
    value = as_python(value)
    if isinstance(value, float) and HUGE < abs(value) < math.inf:
        raise ExperimentError(f"measure '{name}': must be from {-HUGE:g} to {HUGE:g} (got {value!r})")
    if (wrong := why_unstorable(value)) is not None:
        raise ExperimentError(f"measure '{name}': {wrong}")
    if type(value) not in PLAIN:
        lists = "; of a list, give Design.measures a Measured with over=" if isinstance(value, (list, tuple)) else ""
        raise DesignError(f"measure '{name}': must be a number, text, True, False or None (got {value!r}){lists}", measure.name)
    return None if isinstance(value, float) and not math.isfinite(value) else value
