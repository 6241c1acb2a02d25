"""Runs again what a recording holds, and says whether every byte agrees."""

from __future__ import annotations

import json
from collections.abc import Callable
from contextlib import AbstractContextManager
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

from actr3d.actr.kernel.run_limits import RunLimits
from actr3d.actr.loading import run_text
from actr3d.actr.loading.global_seed import shared_random
from actr3d.actr.loading.helper_modules import HelperTexts
from actr3d.actr.loading.sealed import sealed
from actr3d.clock import MICROSECONDS, seconds
from actr3d.errors import Actr3dError, RecordingError
from actr3d.printing import ModelOutput, printing_to
from actr3d.recording import Recorded
from actr3d.running.comparison import Beside, Comparison, Differs
from actr3d.running.complaint import failure
from actr3d.running.printed import BuiltOutput, ProgramOutput
from actr3d.running.replayable import check_replayable
from actr3d.trace import Trace

if TYPE_CHECKING:
    from actr3d.simulation import Simulation

Progress = Callable[[float], object]
"""Is told which share of a recording has been run again, from 0 to 1."""


def replay(
    recorded: Recorded,
    make: Callable[[], Simulation] | None = None,
    *,
    trust: bool = False,
    any_version: bool = False,
    progress: Progress = lambda _: None,
    within: Path | None = None,
) -> Comparison:
    """Runs again what a recording holds, and compares every event, and every state at the end of a tick.

    What the model prints is not shown. Unless `make` is given, the code that the recording holds is run, as any program that
    you start: with your files and your rights. Of modules, it gets those that are recorded, the standard library and
    installed packages, none from the folder where its file was or is.

    Args:
        recorded: The recording.
        make: Makes the simulation; None for what the recorded model file builds, or for a recorded program.
        trust: Whether code may be run of a recording that this installation did not make; see `Recorded.made_here`.
        any_version: Whether to try even though versions of Python, MuJoCo or others are not those of the recording.
        progress: Is told again and again which share has been run: of the ticks, or of a program's events.
        within: A folder for what is laid out as files meanwhile, which a program that ends the process leaves there; None for
            where the system has temporary ones.

    Raises:
        UntrustedError: If the recording was made elsewhere, and is not to be trusted.
        RecordingError: If the file is damaged, versions differ, or the recording does not say how the simulation was made, or
            it cannot be made so any more.
        Exception: What `make` raises.
    """
    check_replayable(recorded, trust=trust or make is not None, any_version=any_version)
    with printing_to(ModelOutput(lambda _: None)):  # the lines are among the events
        if recorded.facts["kind"] == "program":
            with _sealed(recorded, within) as helpers:
                return _replay_program(recorded, helpers, progress)
        if make is None and not recorded.facts.get("built"):
            raise RecordingError(f"'{recorded.path}' was made by a program that is not recorded with it; replay(recorded, make) can run it")
        seed = recorded.facts.get("program_seed", recorded.facts["seed"])
        with RunLimits(seed=seed), shared_random(seed):
            if make is not None:
                return _replay_simulation(recorded, make(), progress)
            with _sealed(recorded, within) as helpers, BuiltOutput() as output:
                simulation = _built(recorded, helpers)
                output.lead_to(simulation)
                return _replay_simulation(recorded, simulation, progress)


def _built(recorded: Recorded, helpers: HelperTexts) -> Simulation:
    from actr3d.running.building import build  # a program does without the world that this loads

    facts = recorded.facts
    file = facts["file"]
    try:
        simulation, _ = build(facts["sources"][file], file, facts["parameters"], Path(file).parent, helpers)
    except Actr3dError:
        raise
    except KeyboardInterrupt:
        raise
    except BaseException as error:  # it did build something when it was recorded
        raise RecordingError(f"what '{recorded.path}' holds cannot be built here: {failure(error)}") from error
    return simulation


def _sealed(recorded: Recorded, within: Path | None) -> AbstractContextManager[HelperTexts]:
    """Lets nothing be imported but what the recording holds, the standard library and installed packages."""
    facts = recorded.facts
    return sealed(facts["file"], facts["sources"][facts["file"]], facts.get("helpers", {}), within)


def _replay_program(recorded: Recorded, helpers: HelperTexts, progress: Progress) -> Comparison:
    facts = recorded.facts
    file = facts["file"]
    beside = Beside(recorded, open_end=not (recorded.over or _failed(recorded)))
    trace = Trace("all", keep=False)
    trace.listen(beside.event)
    whole = max(1, recorded.event_count)
    trace.listen(lambda _: progress(min(1.0, beside.events / whole)))
    limits = RunLimits(seed=facts["seed"], until=facts["until"], trace=trace, recorder=beside)
    trouble, ended, failed = "", "end", None
    try:
        with ProgramOutput(limits) as output:
            try:
                run_text(facts["sources"][file], file, limits=limits, folder=Path(file).parent, helpers=helpers)
            except SystemExit as error:
                trouble, ended = f" ({failure(error)})", "exit"
            if recorded.over:
                output.finish()
    except Differs:  # in the last line of a log, when the program itself was over
        pass
    except KeyboardInterrupt:
        raise
    except BaseException as error:  # noqa: BLE001 - the recorded run may have ended so, too
        failed = failure(error)
        trouble, ended = f" ({failed})", None
    return _compared(recorded, beside, f"the run ended{trouble}", ended, failed)


def _replay_simulation(recorded: Recorded, simulation: Simulation, progress: Progress) -> Comparison:
    """Runs a simulation beside its recording."""
    from actr3d.simulation import Command

    facts, world, journal = recorded.facts, simulation.world, simulation.event_log
    then = facts["period_us"], facts["timestep_us"], facts["seed"]
    now = round(simulation.period * MICROSECONDS), world.scene.timestep_us, simulation.seed
    if then != now:
        return Comparison(ticks=0, events=0, difference=f"recorded: {_beginning(*then)}; now: {_beginning(*now)}")
    beside = Beside(recorded)
    journal.record(cast("Any", beside))
    commands = [Command.from_data(command.tick, command.data) for command in recorded.commands()]
    simulation.plan(commands)
    ticks, ended, failed = recorded.ticks, None, None
    try:
        for tick in range(1, ticks + 1):
            simulation.step()
            progress(tick / ticks)
        ended = _ending(recorded, simulation)
        try:
            _end(recorded, simulation, ended)
        except (Differs, KeyboardInterrupt):
            raise
        except BaseException as error:  # noqa: BLE001 - the recorded run may have failed so, too
            failed = failure(error)
        if recorded.closed:
            journal.stdout.finish()
        journal.check()
        for command in commands[: simulation.timeline.lockstep.commands]:
            beside.command(1, command.tick, command.to_data())
    except Differs:
        pass
    except KeyboardInterrupt:
        raise
    except BaseException as error:  # noqa: BLE001 - what is recorded went on beyond that
        beside.difference = f"the run failed after {seconds(simulation.ticks * facts['period_us']):g} s ({failure(error)})"
    if world.fingerprint != facts["scene"]:
        if beside.difference is None:
            beside.difference = "the scene compiles to another than then, though the physics agrees"
        elif beside.difference.startswith("the physics"):
            beside.difference += "; it compiles to another scene than then"
    return _compared(recorded, beside, "the run ended", ended, failed)


def _ending(recorded: Recorded, simulation: Simulation) -> str:
    """Says what has ended a simulation whose recorded ticks are over; `limits` where it could go on."""
    then: dict[str, Any] = recorded.facts.get("ended") or {}
    if then.get("by") in ("seconds", "until") and not recorded.facts.get("built"):
        return str(then["by"])  # it was not run to its end by this library, but by a program that says so
    return simulation.over or "limits"


def _end(recorded: Recorded, simulation: Simulation, ended: str) -> None:
    """Does what the recorded run did after its last whole tick.

    Raises:
        BaseException: What the model raises.
    """
    if _failed(recorded) and ended == "limits":
        simulation.step()
        return
    simulation.timeline.repeat_commands()
    if recorded.over or _failed(recorded):
        simulation.conclude()


def _beginning(period: int, timestep: int, seed: Any) -> str:
    return f"period {seconds(period):g} s, timestep {seconds(timestep):g} s, seed {seed}"


def _compared(recorded: Recorded, beside: Beside, trouble: str, ended: str | None, failed: str | None) -> Comparison:
    """Returns what came of a comparison whose run is over; what is recorded beyond that is a difference, unless it was broken off there.

    Args:
        recorded: The recording.
        beside: What was compared.
        trouble: Says that the run has ended, where the recorded one went on.
        ended: What has ended it.
        failed: What it failed with; None where it did not.
    """
    left, difference, broken_off, unfinished = beside.rest(), beside.difference, None, 0
    if _failed(recorded):
        broken_off = _broken_off(recorded)
    elif not recorded.closed:
        broken_off = _broken_off(recorded)
        unfinished = left.pop("event", 0)
        left = {kind: count for kind, count in left.items() if kind == "state"}  # the rest may be of the tick that did not end
    if difference is None and left:
        more = ", ".join(f"{count:,} {kind}{'s' * (count > 1)}" for kind, count in left.items())
        difference = f"{trouble} after {beside.events:,} events; the recording holds {more} more"
    if difference is None and (recorded.over or _failed(recorded)):
        now = {"failed": failed, "ended": None if failed else {"by": ended}}
        difference = _other_end({name: recorded.facts.get(name) for name in now}, now)
    return Comparison(ticks=beside.ticks, events=beside.events, difference=difference, broken_off=broken_off, unfinished=unfinished)


def _failed(recorded: Recorded) -> bool:
    """Returns whether the recorded run failed: then it holds all until that."""
    return recorded.facts.get("failed") is not None


def _other_end(then: dict[str, Any], now: dict[str, Any]) -> str | None:
    """Says in which fact the end of a run is another than it was; None in none."""
    for name in now:
        if then[name] != now[name]:
            return f"the fact '{name}'; recorded: {json.dumps(then[name])}; now: {json.dumps(now[name])}"
    return None


def _broken_off(recorded: Recorded) -> str:
    """Says how a run ended that did not come to its end, and when."""
    period = recorded.facts.get("period_us")
    last = 0
    if period is None:
        for event in recorded.events():
            last = event.time_us
    at = seconds(last if period is None else recorded.ticks * period)
    failed = recorded.facts.get("failed")
    return f"the run was broken off at {at:g} s" if failed is None else f"the run failed after {at:g} s ({failed})"
