"""Runs a model file, be it a program or one that builds a simulation, and records it."""

from __future__ import annotations

import ast
from collections.abc import Callable, Mapping, Sequence
from contextlib import suppress
from functools import partial
from pathlib import Path
from typing import Any

from actr3d.actr.helper_texts import HelperTexts
from actr3d.actr.limits import EndOfRun, RunLimits, fresh_seed
from actr3d.actr.loading import run_text
from actr3d.actr.reading import read_source
from actr3d.actr.shared_random import shared_random
from actr3d.actr.sources import syntax_tree
from actr3d.clock import microseconds, seconds
from actr3d.errors import ParameterError, SettingError
from actr3d.fields import Field
from actr3d.running.printed import BuiltOutput, ProgramOutput
from actr3d.trace import Trace


def has_build(source: str) -> bool:
    """Tells whether a model's text has a function `build` that says it returns a `Simulation`."""
    return any(
        isinstance(node, ast.FunctionDef)
        and node.name == "build"
        and node.returns is not None
        and ast.unparse(node.returns).strip("'\"").rpartition(".")[2] == "Simulation"
        for node in syntax_tree(source).body
    )


Settings = Callable[[Sequence[Field]], Mapping[str, Any]]
"""Gives values to parameters, by name, of those that there are."""


def run_model(
    path: Path | str, limits: RunLimits, *, settings: Settings | Mapping[str, Any] | None = None, record: Path | str | None = None
) -> Any:
    """Runs a model file: what it builds, where it has `build(parameters) -> Simulation`, or else itself, as a program.

    Args:
        path: The file.
        limits: Its seed, end and trace. What is built ends with the last whole tick before the end.
        settings: Values of the parameters of what it builds, or what gives them.
        record: Where the run is to be recorded, if it is; a new file.

    Returns:
        The result of the run, where what it builds is measured; None otherwise.

    Raises:
        ModelFileError: If there is no such file, or it is no Python 3.
        SettingError: If parameters are given to a program, or are not what the model takes.
        ParameterError: If a trace of less than everything is to be recorded.
        RecordingError: If the recording cannot be made or written.
        Exception: Whatever the model raises.
    """
    path = Path(path)
    source = read_source(path)
    if limits.seed is None and record is not None:
        limits.seed = fresh_seed()
    if has_build(source):
        return _run_built(path, source, limits, settings or {}, record)
    if settings(()) if callable(settings) else settings:
        raise SettingError(f"'{path}' has no build(parameters) -> Simulation, so there are no parameters to set")
    if record is None:
        run_text(source, str(path), limits=limits, folder=path.parent)
    else:
        _record_program(path, source, limits, record)
    return None


def _run_built(path: Path, source: str, limits: RunLimits, settings: Settings | Mapping[str, Any], record: Path | str | None) -> Any:
    from actr3d.running.building import Blueprint  # a program does without the world that this loads

    with limits, suppress(EndOfRun), shared_random(limits.program_seed), BuiltOutput() as output:
        helpers = HelperTexts()
        blueprint = Blueprint(source, str(path), path.parent, helpers)
        simulation, parameters = blueprint.build(settings(blueprint.fields) if callable(settings) else settings)
        output.lead_to(simulation)
        end = None
        if limits.until is not None:  # down to the end of a tick
            period = microseconds(simulation.period)
            end = seconds(microseconds(limits.until) // period * period)
        if record is None:
            simulation.run(end)
            return simulation.conclude()
        facts: dict[str, Any] = {"file": str(path), "sources": {str(path): source}, "parameters": parameters, "built": True}
        facts.update(helpers=helpers.loaded, program_seed=limits.program_seed)
        with simulation.record(record, **facts) as recording:
            helpers.heard = partial(recording.fact, "helpers")  # a mind may import one later
            report = simulation.run(end)
            result = simulation.conclude()
            recording.fact("ended", {"by": report.ended_by})
            return result
    return None  # every run ended with the program's limits


def _record_program(path: Path, source: str, limits: RunLimits, record: Path | str) -> None:
    from actr3d.recording import Recording

    if limits.trace is None:
        limits.trace = Trace("all", keep=False)
    elif limits.trace.level != "all":
        raise ParameterError(f"a recording holds every event: trace 'all', or none (got '{limits.trace.level}')")
    facts = {"kind": "program", "file": str(path), "sources": {str(path): source}, "seed": limits.seed, "until": limits.until}
    with Recording(record, facts) as recording:
        helpers = HelperTexts()
        helpers.heard = partial(recording.fact, "helpers")
        limits.recorder = recording
        limits.trace.listen(recording.event_alone)
        with ProgramOutput(limits) as output:
            try:
                run_text(source, str(path), limits=limits, folder=path.parent, helpers=helpers)
            except SystemExit:
                output.finish()
                recording.fact("ended", {"by": "exit"})
                raise
            output.finish()
        recording.fact("ended", {"by": "end"})
