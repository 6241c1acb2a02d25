"""Replays a recording: runs it again, and compares both runs byte by byte."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import AbstractContextManager
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

from actr3d.actr.kernel.run_limits import RunLimits
from actr3d.actr.loading.global_seed import shared_random
from actr3d.actr.loading.helper_modules import HelperTexts
from actr3d.actr.loading.sealed import sealed
from actr3d.clock import seconds
from actr3d.errors import Actr3dError, RecordingError
from actr3d.output import printing_nothing
from actr3d.recording import Recorded
from actr3d.recording.facts import FACTS, OF_END, is_of_simulation
from actr3d.runner.facts import built_facts, first_difference, program_facts
from actr3d.runner.model_stdout import BuiltOutput, ProgramOutput
from actr3d.runner.program_changes import ProgramChanges, of_user
from actr3d.runner.replay_diff import Comparator, Comparison, Differs
from actr3d.runner.replayable import check_replayable
from actr3d.runner.run import play_program, recorded_failure
from actr3d.runner.traceback_report import failure
from actr3d.trace import Trace

if TYPE_CHECKING:
    from actr3d.simulation import Simulation

Progress = Callable[[float], object]
"""Receives the share of a recording that has been run again, from 0 to 1."""


def replay(
    recorded: Recorded,
    make: Callable[[], Simulation] | None = None,
    *,
    trust: bool = False,
    any_version: bool = False,
    progress: Progress = lambda _: None,
    within: Path | None = None,
) -> Comparison:
    """Runs a recording again, and compares its facts, events, states at the ends of ticks, contacts, answers and commands.

    What the model prints is not shown. Unless `make` is given, the code that the recording holds is run, as any program that
    you start: with your files and your rights. Of modules, it gets those that are recorded, the standard library and
    installed packages, none from the folder where its file was or is.

    Args:
        recorded: The recording.
        make: Makes the simulation; None for what the recorded model file builds, or for a recorded program.
        trust: Whether code may be run of a recording that this installation did not make; see `Recorded.made_here`.
        any_version: Whether to try even though versions of Python, MuJoCo or others are not those of the recording.
        progress: Called repeatedly with the share that has been run: of the ticks, or of a program's events.
        within: The folder for the files of the recorded modules while they run; a program that ends the process leaves them there.
            None for the system's folder for temporary files.

    Raises:
        UntrustedError: If the recording was made elsewhere, and is not to be trusted.
        RecordingError: If the file is damaged, versions differ, or the recording does not say how the simulation was made, or
            it cannot be made so any more.
        Exception: What `make` raises.
    """
    check_replayable(recorded, trust=trust or make is not None, any_version=any_version)
    with printing_nothing():  # the lines are among the events
        if recorded.facts["kind"] == "program":
            with _sealed(recorded, within) as helpers:
                return _replay_program(recorded, helpers, progress)
        if make is None and not recorded.facts.get("built"):
            raise RecordingError(f"'{recorded.path}' was made by a program that is not recorded with it; replay(recorded, make) can run it")
        facts = recorded.facts
        if make is not None:
            seed = facts.get("program_seed", facts["seed"])
            with RunLimits(seed=seed), shared_random(seed):
                simulation = make()
                return _replay_simulation(recorded, simulation, Comparator(recorded), simulation.facts(), progress)
        seed = facts["program_seed"]
        with RunLimits(seed=seed, until=facts["until"]), shared_random(seed), _sealed(recorded, within) as helpers, BuiltOutput() as output:
            simulation, parameters = _built(recorded, helpers)
            output.attach_to(simulation)
            comparator = Comparator(recorded)
            helpers.on_load = partial(comparator.fact, "helpers")
            file = facts["file"]
            own = built_facts(file, facts["sources"][file], parameters, seed, facts["until"], helpers.loaded)
            return _replay_simulation(recorded, simulation, comparator, simulation.facts(**own), progress)


def _built(recorded: Recorded, helpers: HelperTexts) -> tuple[Simulation, dict[str, Any]]:
    from actr3d.runner.model_factory import Blueprint  # a program does without the world that this loads

    facts = recorded.facts
    file = facts["file"]
    try:
        return Blueprint(facts["sources"][file], file, Path(file).parent, helpers).build(facts["parameters"])
    except (Actr3dError, KeyboardInterrupt):
        raise
    except BaseException as error:  # it did build something when it was recorded
        raise RecordingError(f"what '{recorded.path}' holds cannot be built here: {failure(error)}") from error


def _sealed(recorded: Recorded, within: Path | None) -> AbstractContextManager[HelperTexts]:
    """Restricts imports to the modules in the recording, the standard library and installed packages."""
    facts = recorded.facts
    return sealed(facts["file"], facts["sources"][facts["file"]], facts.get("helpers", {}), within)


def _replay_program(recorded: Recorded, helpers: HelperTexts, progress: Progress) -> Comparison:
    """Replays a program until it ends. If the recorded run did not end by itself, the replay ends when it does more than was recorded."""
    facts = recorded.facts
    file, source = facts["file"], facts["sources"][facts["file"]]
    comparator = Comparator(recorded, open_end=not recorded.finished)
    comparator.facts |= program_facts(file, source, facts["seed"], facts["until"])
    trace = Trace("all", keep=False)
    count = max(1, recorded.event_count)
    trace.listen(lambda _: progress(min(1.0, comparator.events / count)))
    trace.listen(comparator.event_alone)
    limits = RunLimits(seed=facts["seed"], until=facts["until"], trace=trace)
    changes = ProgramChanges(limits, of_user(recorded.commands()))
    if changes.known:
        limits.passing, limits.ticked = changes.repeat, changes.ticked
    trouble = ""
    try:
        with ProgramOutput(limits) as output:
            left = play_program(file, source, limits, comparator, helpers, output)
        trouble = "" if left is None else f" ({failure(left)})"
    except Differs:
        pass
    except KeyboardInterrupt:
        raise
    except BaseException as error:  # noqa: BLE001 - the recorded run may have ended so, too
        trouble = f" ({failure(error)})"
    return _compared(recorded, comparator, f"the run ended{trouble}")


def _replay_simulation(
    recorded: Recorded, simulation: Simulation, comparator: Comparator, facts: dict[str, Any], progress: Progress
) -> Comparison:
    """Replays a simulation for as many ticks as are recorded; one that a model file builds not beyond its end.

    Args:
        recorded: The recording.
        simulation: The simulation, at its start.
        comparator: Compares what it does.
        facts: The facts that its recording would begin with.
        progress: Called with the share of the ticks that are done.
    """
    from actr3d.simulation import Command

    log = simulation.event_log
    comparator.facts |= facts
    log.record(cast("Any", comparator))
    commands = [Command.from_data(command.tick, command.data) for command in recorded.commands()]
    simulation.plan(commands)
    ticks, ended, built = recorded.ticks, None, bool(recorded.facts.get("built"))
    try:
        while simulation.ticks < ticks and not (built and simulation.ticks and _ended_by(simulation)):
            simulation.step()
            progress(simulation.ticks / ticks)
        ended = _ended_by(simulation)
        try:
            with recorded_failure(comparator):
                _end(recorded, simulation, ended)
        except (Differs, KeyboardInterrupt):
            raise
        except BaseException:  # noqa: BLE001 - the fact 'failed' is compared
            ended = None
        if ended is not None:
            comparator.fact("ended", {"by": ended})
        if recorded.finished or recorded.facts.get("whole"):
            log.end_recording(whole=simulation.timeline.begun and not simulation.timeline.lockstep.broken)
        log.check()
        for command in commands[: simulation.timeline.lockstep.commands]:
            comparator.command(1, command.tick, command.to_data())
    except Differs:
        pass
    except KeyboardInterrupt:
        raise
    except BaseException as error:  # noqa: BLE001 - what is recorded went on beyond that
        comparator.difference = f"the run failed after {seconds(simulation.ticks * recorded.facts['period_us']):g} s ({failure(error)})"
    return _compared(recorded, comparator, "the run ended")


def _ended_by(simulation: Simulation) -> str | None:
    """Returns why a simulation ends at its current time; None if it can continue."""
    return simulation.over or (None if simulation.timeline.lockstep.may_tick() else "limits")


def _end(recorded: Recorded, simulation: Simulation, ended: str | None) -> None:
    """Repeats what the recorded run did after its last whole tick.

    Raises:
        BaseException: What the model raises.
    """
    if recorded.failed and ended is None:
        simulation.step()
        return
    simulation.timeline.repeat_commands()
    if recorded.finished:
        simulation.conclude()


def _compared(recorded: Recorded, comparator: Comparator, trouble: str) -> Comparison:
    """Returns the result of a comparison whose run is over; further recorded events differ, unless the recorded run was interrupted.

    Args:
        recorded: The recording.
        comparator: What was compared.
        trouble: Says that the run has ended, where the recorded one went on.
    """
    left, difference, unfinished = comparator.rest(), comparator.difference, 0
    after: list[str] = []
    if comparator.went_on:
        raise RecordingError(
            f"the recording '{recorded.path}' cannot be compared: its program went on after the user interrupted it, and what it did then "
            "cannot be repeated"
        )
    if comparator.interrupted:
        after = [f"not checked: {_counted(left)} after that"] if left else []
        left = {}
    elif not (recorded.closed or recorded.failed):
        unfinished = left.pop("event", 0)
        left = {kind: count for kind, count in left.items() if kind == "state"}  # the rest may be of the tick that did not end
    if difference is None and left:
        difference = f"{trouble} after {comparator.events:,} events; the recording holds {_counted(left)} more"
    end = _recorded_end(recorded)
    ignored, notes = _unchecked(recorded, comparator)
    differs = first_difference(recorded.facts, comparator.facts, ignored)
    if difference is None:
        difference = differs
    elif difference.startswith("the physics") and recorded.facts.get("scene") != comparator.facts.get("scene"):
        difference += "; it compiles to another scene than then"
    return Comparison(
        ticks=comparator.ticks,
        events=comparator.events,
        difference=difference,
        to_its_end=end is None,
        notes=(*([] if end is None else [end]), *after, *notes),
        unfinished=unfinished,
    )


def _counted(left: dict[str, int]) -> str:
    return ", ".join(f"{count:,} {kind}{'s' * (count > 1)}" for kind, count in left.items())


def _unchecked(recorded: Recorded, comparator: Comparator) -> tuple[set[str], list[str]]:
    """Returns the names of the facts that are not compared, and a note that lists those of the recording that cannot be checked."""
    then, now = recorded.facts, comparator.facts
    from_code = then["kind"] == "program" or bool(now.get("built"))
    named, silent = ({name for name, fact in FACTS.items() if fact.replay == does} for does in ("notes", "ignores"))
    simulations = {name for name in {*then, *now} if is_of_simulation(name)}
    if not simulations & then.keys():  # earlier versions have not recorded them
        silent |= simulations
    if not from_code:  # `make` has other code, and what its program has recorded is unknown
        named |= {"sources"} | (then.keys() - now.keys() - {*OF_END, *silent})
    said: dict[str, Any] = then.get("ended") or {}
    if not recorded.finished:
        # The recorded run did not end by itself, so an end of the replay is a difference.
        goes_on = then["kind"] == "program" or now.get("ended") is None or (recorded.ticks == 0 and now["ended"] != {"by": "limits"})
        silent |= {"failed", "whole"} | ({"ended"} if goes_on or not from_code else set())
        silent |= simulations - (then.keys() & now.keys())  # it may end where one of them begins
    elif not from_code and said.get("by") not in ("stop", "done", None):
        named.add("ended")  # it was not run to its end by this library, but by a program that says so
    helpers, used = then.get("helpers", {}), now.get("helpers", {})
    early = comparator.commands > 0 or not recorded.finished
    if early and {name: helpers[name] for name in used if name in helpers} == used:
        # A run that went back and continued differently, or was interrupted, may have loaded more than its recording needs.
        (named if len(used) < len(helpers) else silent).add("helpers")
    names = [f"'{name}'" for name in sorted(named) if then.get(name) is not None]
    return named | silent, [f"not checked: {', '.join(names)}"] if names else []


def _recorded_end(recorded: Recorded) -> str | None:
    """Returns up to where a run is recorded that was left, stopped or interrupted, or goes on; None if it ended by itself."""
    facts = recorded.facts
    if recorded.over:
        return None
    period = facts.get("period_us")
    last = 0
    if period is None:
        for event in recorded.events():
            last = event.time_us
    at = facts.get("reached", seconds(last)) if period is None else seconds(recorded.ticks * period)
    if recorded.failed:
        return f"the run failed after {at:g} s ({facts['failed']})"
    if facts.get("ended") is None and facts.get("whole") and not facts.get("built"):
        return None  # the end of a run that a program makes is not recorded
    how = "left" if facts.get("ended") is not None else "stopped" if facts.get("whole") else "not over"
    return f"the recording says that the run was {how} at {at:g} s, which cannot be checked"
