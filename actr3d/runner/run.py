"""Runs a model file, either a program or one that builds a simulation, and optionally records it."""

from __future__ import annotations

from collections.abc import Callable, Generator, Mapping, Sequence
from contextlib import contextmanager, suppress
from functools import partial
from pathlib import Path
from threading import Thread
from typing import TYPE_CHECKING, Any

from actr3d.actr.kernel.run_limits import EndOfRun, Recorder, RunLimits, fresh_seed
from actr3d.actr.loading import run_text
from actr3d.actr.loading.global_seed import shared_random
from actr3d.actr.loading.helper_modules import HelperTexts
from actr3d.actr.loading.source_text import read_source
from actr3d.errors import ParameterError, SettingError
from actr3d.output import TeeOutput
from actr3d.parameter_schema import Parameter
from actr3d.recording import Recording
from actr3d.runner.before_exit import before_the_end
from actr3d.runner.build_check import check_build, has_build
from actr3d.runner.facts import built_facts, program_facts
from actr3d.runner.model_stdout import BuiltOutput, ProgramOutput
from actr3d.runner.traceback_report import failure
from actr3d.trace import Listener, Trace

if TYPE_CHECKING:
    from actr3d.simulation import Simulation
    from actr3d.simulation.real_time import SimulationEnding


PATIENCE = 5.0
"""The maximum time to write a recording before the model ends its process [s]."""
Settings = Callable[[Sequence[Parameter]], Mapping[str, Any]]
"""Returns values of parameters, by name, for the given fields."""


def run_model(
    path: Path | str, limits: RunLimits, *, settings: Settings | Mapping[str, Any] | None = None, record: Path | str | None = None
) -> Any:
    """Runs a model file: the simulation it builds, if it has `build(parameters) -> Simulation`, otherwise the file as a program.

    Args:
        path: The file.
        limits: Its seed, end and trace. A simulation ends after the last whole tick that fits.
        settings: Values of the parameters of its `build`, or a function that returns them.
        record: The new file for a recording of the run; None for no recording.

    Returns:
        The result of the run, if the simulation measures one; None otherwise.

    Raises:
        ModelFileError: If the file does not exist, is not Python 3, or its `build` is not valid.
        SettingError: If parameters are given to a program, or are not valid for the model.
        ParameterError: If a recording is requested with a trace of less than everything.
        RecordingError: If the recording cannot be created or written.
        Exception: Any error that the model raises.
    """
    return run_source(read_source(Path(path)), str(path), limits, settings=settings, record=record)


def run_source(
    source: str,
    file: str,
    limits: RunLimits,
    *,
    settings: Settings | Mapping[str, Any] | None = None,
    record: Path | str | None = None,
    helpers: HelperTexts | None = None,
) -> Any:
    """Runs the text of a model file, as `run_model` runs the file: the other arguments, the result and the errors are the same.

    Args:
        source: The text.
        file: The name of the file; its helper modules are in the same folder.
        helpers: Provides the texts of the helper modules; None to load them from the folder.
    """
    helpers = HelperTexts() if helpers is None else helpers
    check_build(source, file)
    with _restored(limits):
        if limits.seed is None and record is not None:
            limits.seed = fresh_seed()
        if has_build(source):
            return _run_built(file, source, limits, settings or {}, record, helpers)
        if settings(()) if callable(settings) else settings:
            raise SettingError(f"'{file}' has no build(parameters) -> Simulation, so there are no parameters to set")
        if record is None:
            run_text(source, file, limits=limits, folder=Path(file).parent, helpers=helpers)
        else:
            _record_program(file, source, limits, record, helpers)
    return None


@contextmanager
def _restored(limits: RunLimits) -> Generator[None]:
    """Restores the seed, trace and recorder of limits after a run: they may be used for another one."""
    own = limits.seed, limits.trace, limits.recorder
    try:
        yield
    finally:
        limits.seed, limits.trace, limits.recorder = own


def _run_built(
    file: str, source: str, limits: RunLimits, settings: Settings | Mapping[str, Any], record: Path | str | None, helpers: HelperTexts
) -> Any:
    from actr3d.runner.model_factory import Blueprint  # a program does not need the world, which this loads

    with limits, suppress(EndOfRun), shared_random(limits.program_seed), BuiltOutput() as output:
        blueprint = Blueprint(source, file, Path(file).parent, helpers)
        simulation, parameters = blueprint.build(settings(blueprint.fields) if callable(settings) else settings)
        output.attach_to(simulation)
        if record is None:
            _run_to_end(simulation)
            return simulation.conclude()
        facts = built_facts(file, source, parameters, limits.program_seed, limits.until, helpers.loaded)
        with simulation.record(record, **facts) as recording:
            helpers.on_load = partial(recording.fact, "helpers")  # an agent may import one later
            with before_the_end(partial(_keep_all, recording, simulation.event_log.stdout)), recorded_failure(recording):
                ended_by = _run_to_end(simulation)
                result = simulation.conclude()
            recording.fact("ended", {"by": ended_by})
            return result
    return None  # every run ended at the program's limits


def _run_to_end(simulation: Simulation) -> SimulationEnding:
    """Runs a simulation until it ends by itself or at its limits; returns what ended it."""
    try:
        return simulation.run().ended_by
    except EndOfRun:  # there is no time for even one tick
        return "limits"


def _record_program(file: str, source: str, limits: RunLimits, record: Path | str, helpers: HelperTexts) -> None:
    if limits.trace is None:
        limits.trace = Trace("all", keep=False)
    elif limits.trace.level != "all":
        raise ParameterError(f"a recording holds every event: trace 'all', or none (got '{limits.trace.level}')")
    with (
        Recording(record, program_facts(file, source, limits.seed, limits.until)) as recording,
        _heard(limits.trace, recording.event_alone),
        ProgramOutput(limits) as output,
        before_the_end(partial(_keep_all, recording, output)),
    ):
        left = play_program(file, source, limits, recording, helpers, output)
        if left is not None:
            raise left


@contextmanager
def _heard(trace: Trace, listener: Listener) -> Generator[None]:
    """Calls a listener with the events of a trace inside the block."""
    trace.listen(listener)
    try:
        yield
    finally:
        with suppress(ParameterError):  # it has failed, and does not listen any more
            trace.ignore(listener)


def play_program(
    file: str, source: str, limits: RunLimits, recording: Recorder, helpers: HelperTexts, output: ProgramOutput
) -> SystemExit | None:
    """Runs a program, and records it to its end; returns the `SystemExit` that ended it, if any. `output` emits what it prints.

    The events reach the recording as a listener of the trace.

    Raises:
        Exception: Any error that the program raises; it is recorded, too.
    """
    helpers.on_load = partial(recording.fact, "helpers")
    limits.recorder = recording
    left: SystemExit | None = None
    with recorded_failure(recording):
        try:
            run_text(source, file, limits=limits, folder=Path(file).parent, helpers=helpers)
        except SystemExit as error:
            left = error
        output.finish()
    recording.fact("ended", {"by": "end" if left is None else "exit"})
    return left


def _keep_all(recording: Recording, output: TeeOutput, ends: bool) -> None:
    """Writes what has been recorded, as the model may be about to end its process; also an unfinished line, if it surely ends."""
    if ends:
        output.finish()
    # In a thread, for which this waits no longer than it must: a signal handler of the model may have interrupted `flush` itself.
    writing = Thread(target=recording.flush, daemon=True)
    writing.start()
    writing.join(PATIENCE)


@contextmanager
def recorded_failure(recording: Recorder) -> Generator[None]:
    """Records the error of a failed run, and raises it."""
    try:
        yield
    except (EndOfRun, KeyboardInterrupt):
        raise
    except BaseException as error:
        recording.fact("failed", failure(error))
        raise
