"""Runs again what a recording holds, and says whether every byte agrees."""

from __future__ import annotations

import random
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from actr3d.actr.limits import EndOfRun, RunLimits
from actr3d.actr.loading import run_text
from actr3d.clock import MICROSECONDS, seconds
from actr3d.errors import RecordingError
from actr3d.printing import ModelOutput, ToldOutput, printing_to
from actr3d.recording import Recorded
from actr3d.recording.form import versions
from actr3d.running.building import build
from actr3d.running.printed import BuiltOutput, ProgramOutput
from actr3d.simulation import Command, Simulation
from actr3d.trace import Trace, TraceEvent


@dataclass(frozen=True, kw_only=True)
class Comparison:
    """What came of running a recording again."""

    ticks: int
    """How many ticks were compared."""
    events: int
    """How many events were compared."""
    difference: str | None
    """Where it first differs; None where every byte agrees."""
    unfinished: int = 0
    """How many events the recording holds of a tick that never came to its end; they were not compared."""

    def __str__(self) -> str:
        if self.difference is not None:
            return f"differs: {self.difference}"
        ticks = f"{self.ticks:,} ticks, " if self.ticks else ""
        rest = f" ({self.unfinished:,} more events of a tick that did not end)" if self.unfinished else ""
        return f"every byte agrees: {ticks}{self.events:,} events{rest}"


class _Differs(EndOfRun):
    """Ends a run that has gone another way than the recorded one."""


class _Events:
    """Compares events with recorded ones, in order.

    Args:
        recorded: The recording.
        ticks: The last tick whose events count.
    """

    def __init__(self, recorded: Recorded, ticks: int | None = None) -> None:
        self._recorded = recorded.events()
        self._ticks = ticks
        self._over = "ended" in recorded.facts
        self.count = 0
        self.difference: str | None = None

    def take(self, event: TraceEvent) -> None:
        """Takes one event of the new run.

        Raises:
            EndOfRun: If it is another than the recorded one, or the recording was broken off before.
        """
        if self.difference is not None:
            return
        then = next(self._recorded, None)
        line = None if then is None else then.to_json()
        now = event.to_json()
        if line is None and not self._over and self._ticks is None:
            raise _Differs
        self.count += 1
        if line != now:
            self.difference = f"event {self.count} at {event.time:g} s; recorded: {line or 'nothing'}; now: {now}"
            raise _Differs

    def rest(self) -> int:
        """Returns how many recorded events the new run has not come to."""
        return sum(1 for _ in self._recorded)


def replay(recorded: Recorded, make: Callable[[], Simulation] | None = None, *, any_version: bool = False) -> Comparison:
    """Runs again what a recording holds, and compares every event, and every state at the end of a tick.

    What the model prints is not shown.

    Args:
        recorded: The recording.
        make: Makes the simulation; None for what the recorded model file builds, or for a recorded program.
        any_version: Whether to try even though versions of Python, MuJoCo or others are not those of the recording.

    Raises:
        RecordingError: If versions differ, or the recording does not say how the simulation was made.
        Exception: What the model raises in building it.
    """
    if not any_version:
        _check_versions(recorded.facts["versions"])
    with printing_to(ModelOutput(lambda _: None)):  # the lines are among the events
        if recorded.facts["kind"] == "program":
            return _replay_program(recorded)
        if make is None and not recorded.facts.get("built"):
            raise RecordingError(f"'{recorded.path}' was made by a program that is not recorded with it; replay(recorded, make) can run it")
        with RunLimits(seed=recorded.facts.get("program_seed", recorded.facts["seed"])) as limits:
            random.seed(limits.program_seed)
            if make is not None:
                return _replay_simulation(recorded, make())
            with BuiltOutput(limits) as output:
                simulation = _built(recorded.facts)
                output.lead_to(simulation)
                return _replay_simulation(recorded, simulation, output)


def _check_versions(then: dict[str, str]) -> None:
    now = versions()
    different = [f"{name} {then.get(name)} then, {now.get(name)} now" for name in sorted({*then, *now}) if then.get(name) != now.get(name)]
    if different:
        raise RecordingError(f"the recording was made with other versions, and may not agree for that alone: {'; '.join(different)}")


def _built(facts: dict[str, Any]) -> Simulation:
    file = facts["file"]
    simulation, _ = build(facts["sources"][file], file, facts["parameters"], Path(file).parent)
    return simulation


def _replay_program(recorded: Recorded) -> Comparison:
    facts = recorded.facts
    events = _Events(recorded)
    trace = Trace("all", keep=False)
    trace.listen(events.take)
    limits = RunLimits(seed=facts["seed"], until=facts["until"], trace=trace)
    file = facts["file"]
    trouble = ""
    try:
        with ProgramOutput(limits) as output:
            run_text(facts["sources"][file], file, limits=limits, folder=Path(file).parent)
            if "ended" in facts:
                output.finish()
    except _Differs:  # in the last line of a log, when the program itself was over
        pass
    except Exception as error:  # noqa: BLE001 - the recorded run may have ended so, too
        trouble = f" ({type(error).__name__}: {error})"
    left = events.rest()
    difference = events.difference
    if difference is None and left:
        difference = f"the run ended{trouble} after {events.count:,} events; the recording holds {left:,} more"
    return Comparison(ticks=0, events=events.count, difference=difference)


def _replay_simulation(recorded: Recorded, simulation: Simulation, output: ToldOutput | None = None) -> Comparison:
    """Runs a simulation beside its recording, which tells of its output, too, where that is given."""
    ticks = recorded.ticks
    events = _Events(recorded, ticks)
    period = recorded.facts["period_us"]
    if round(simulation.period * MICROSECONDS) != period or simulation.seed != recorded.facts["seed"]:
        was = f"period {seconds(period):g} s, seed {recorded.facts['seed']}"
        return Comparison(ticks=0, events=0, difference=f"recorded: {was}; now: period {simulation.period:g} s, seed {simulation.seed}")
    simulation._journal.raise_level("all")
    simulation._journal.listen(events.take)
    simulation.plan([Command.from_data(tick, data) for tick, data in recorded.commands()])
    difference: str | None = None
    try:
        for tick, state, count in recorded.states():
            if tick:
                simulation.step()
            now = simulation.world.state_bytes()
            where = f"at the end of tick {tick} ({seconds(tick * period):g} s)"
            if now != state:
                difference = f"the physics {where}: {_first_number(state, now)}"
                break
            if tick and count != events.count:
                difference = f"there were {count:,} events {where}, and are {events.count:,} now"
                break
        else:
            simulation._course.repeat_commands()
            if output is not None and "ended" in recorded.facts:
                output.finish()
            simulation._journal.check()
    except _Differs:
        pass
    left = events.rest()
    return Comparison(ticks=simulation.ticks, events=events.count, difference=events.difference or difference, unfinished=left)


def _first_number(then: bytes, now: bytes) -> str:
    """Says which number of a state is the first to differ."""
    if len(then) != len(now):
        return f"a state was {len(then)} bytes, and is {len(now)}: another scene"
    was, is_now = np.frombuffer(then), np.frombuffer(now)
    differ = np.flatnonzero(was.view(np.int64) != is_now.view(np.int64))
    first = int(differ[0])
    return f"number {first} of {was.size} was {was[first]!r}, and is {is_now[first]!r}"
