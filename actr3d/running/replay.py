"""Runs again what a recording holds, and says whether every byte agrees."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from actr3d.actr.helper_texts import HelperTexts
from actr3d.actr.limits import RunLimits
from actr3d.actr.loading import run_text
from actr3d.actr.shared_random import shared_random
from actr3d.clock import MICROSECONDS, seconds
from actr3d.errors import Actr3dError, RecordingError
from actr3d.printing import ModelOutput, printing_to
from actr3d.recording import Recorded
from actr3d.recording.form import versions
from actr3d.running.building import build
from actr3d.running.comparison import Beside, Comparison, Differs, first_number
from actr3d.running.printed import BuiltOutput, ProgramOutput
from actr3d.simulation import Command, Simulation
from actr3d.trace import Trace, TraceEvent


class _Events:
    """Compares a simulation's events with recorded ones, in order.

    Args:
        recorded: The recording.
    """

    def __init__(self, recorded: Recorded) -> None:
        self._recorded = recorded.events()
        self.count = 0
        self.difference: str | None = None

    def take(self, event: TraceEvent) -> None:
        """Takes one event of the new run.

        Raises:
            Differs: If it is another than the recorded one.
        """
        if self.difference is not None:
            return
        then = next(self._recorded, None)
        line = None if then is None else then.to_json()
        now = event.to_json()
        self.count += 1
        if line != now:
            self.difference = f"event {self.count} at {event.time:g} s; recorded: {line or 'nothing'}; now: {now}"
            raise Differs

    def rest(self) -> int:
        """Returns how many recorded events the new run has not come to."""
        return sum(1 for _ in self._recorded)


Progress = Callable[[float], object]
"""Is told which share of a recording has been run again, from 0 to 1."""


def replay(
    recorded: Recorded,
    make: Callable[[], Simulation] | None = None,
    *,
    any_version: bool = False,
    progress: Progress = lambda _: None,
) -> Comparison:
    """Runs again what a recording holds, and compares every event, and every state at the end of a tick.

    What the model prints is not shown.

    Args:
        recorded: The recording.
        make: Makes the simulation; None for what the recorded model file builds, or for a recorded program.
        any_version: Whether to try even though versions of Python, MuJoCo or others are not those of the recording.
        progress: Is told again and again which share has been run: of the ticks, or of a program's events.

    Raises:
        RecordingError: If the file is damaged, versions differ, or the recording does not say how the simulation was made, or
            it cannot be made so any more.
        Exception: What `make` raises.
    """
    recorded.check()
    if not any_version:
        _check_versions(recorded.facts["versions"])
    with printing_to(ModelOutput(lambda _: None)):  # the lines are among the events
        if recorded.facts["kind"] == "program":
            return _replay_program(recorded, progress)
        if make is None and not recorded.facts.get("built"):
            raise RecordingError(f"'{recorded.path}' was made by a program that is not recorded with it; replay(recorded, make) can run it")
        seed = recorded.facts.get("program_seed", recorded.facts["seed"])
        with RunLimits(seed=seed), shared_random(seed):
            if make is not None:
                return _replay_simulation(recorded, make(), progress)
            with BuiltOutput() as output:
                simulation = _built(recorded)
                output.lead_to(simulation)
                return _replay_simulation(recorded, simulation, progress)


def _check_versions(then: dict[str, str]) -> None:
    now = versions()
    different = [f"{name} {then.get(name)} then, {now.get(name)} now" for name in sorted({*then, *now}) if then.get(name) != now.get(name)]
    if different:
        raise RecordingError(f"the recording was made with other versions, and may not agree for that alone: {'; '.join(different)}")


def _built(recorded: Recorded) -> Simulation:
    facts = recorded.facts
    file = facts["file"]
    try:
        simulation, _ = build(facts["sources"][file], file, facts["parameters"], Path(file).parent, _helpers(facts))
    except Actr3dError:
        raise
    except (Exception, SystemExit) as error:  # it did build something when it was recorded
        raise RecordingError(f"what '{recorded.path}' holds cannot be built here: {_told(error)}") from error
    return simulation


def _helpers(facts: Mapping[str, Any]) -> HelperTexts:
    """Returns the helper modules as they were, wherever their files are now."""
    return HelperTexts(facts.get("helpers"))


def _replay_program(recorded: Recorded, progress: Progress) -> Comparison:
    facts = recorded.facts
    beside = Beside(recorded)
    trace = Trace("all", keep=False)
    trace.listen(beside.event)
    whole = max(1, recorded.event_count)
    trace.listen(lambda _: progress(min(1.0, beside.counts["event"] / whole)))
    limits = RunLimits(seed=facts["seed"], until=facts["until"], trace=trace, recorder=beside)
    file = facts["file"]
    trouble = ""
    try:
        with ProgramOutput(limits) as output:
            try:
                run_text(facts["sources"][file], file, limits=limits, folder=Path(file).parent, helpers=_helpers(facts))
            except SystemExit as error:
                trouble = f" ({_told(error)})"
            if "ended" in facts:
                output.finish()
    except Differs:  # in the last line of a log, when the program itself was over
        pass
    except Exception as error:  # noqa: BLE001 - the recorded run may have ended so, too
        trouble = f" ({_told(error)})"
    left, difference, unfinished = beside.rest(), beside.difference, 0
    if beside.broken_off:
        unfinished = left.pop("event", 0)
    if difference is None and left:
        more = ", ".join(f"{count:,} {kind}{'s' * (count > 1)}" for kind, count in left.items())
        difference = f"the run ended{trouble} after {beside.counts['event']:,} events; the recording holds {more} more"
    return Comparison(ticks=beside.ticks, events=beside.counts["event"], difference=difference, unfinished=unfinished)


def _replay_simulation(recorded: Recorded, simulation: Simulation, progress: Progress) -> Comparison:
    """Runs a simulation beside its recording."""
    events = _Events(recorded)
    period = recorded.facts["period_us"]
    if round(simulation.period * MICROSECONDS) != period or simulation.seed != recorded.facts["seed"]:
        was = f"period {seconds(period):g} s, seed {recorded.facts['seed']}"
        return Comparison(ticks=0, events=0, difference=f"recorded: {was}; now: period {simulation.period:g} s, seed {simulation.seed}")
    simulation._journal.raise_level("all")
    simulation._journal.listen(events.take)
    simulation.plan([Command.from_data(command.tick, command.data) for command in recorded.commands()])
    scene = "" if recorded.facts["scene"] == simulation.world.fingerprint else "; it compiles to another scene than then"
    difference: str | None = None
    begun = False
    whole = max(1, recorded.ticks)
    try:
        for _, tick, state, count in recorded.states():
            begun = True
            if tick:
                simulation.step()
                progress(tick / whole)
            now = simulation.world.state_bytes()
            where = f"at the end of tick {tick} ({seconds(tick * period):g} s)"
            if now != state:
                difference = f"the physics {where}: {first_number(state, now)}{scene}"
                break
            if tick and count != events.count:
                difference = f"there were {count:,} events {where}, and are {events.count:,} now"
                break
        else:
            if begun:
                simulation._course.repeat_commands()
            if recorded.facts.get("ended") is not None:  # it may have gone another way from before its end
                simulation.conclude()
            if "whole" in recorded.facts:
                simulation._journal.voice.finish()
            simulation._journal.check()
    except Differs:
        pass
    except (Exception, SystemExit) as error:  # noqa: BLE001 - what is recorded went on beyond that
        difference = f"the run failed after {seconds(simulation.ticks * period):g} s ({_told(error)})"
    left = events.rest()
    return Comparison(ticks=simulation.ticks, events=events.count, difference=events.difference or difference, unfinished=left)


def _told(error: BaseException) -> str:
    return f"{type(error).__name__}: {error}"
