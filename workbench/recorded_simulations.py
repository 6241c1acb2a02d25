"""Reads the simulations of a recording: the scene of each, and its states."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

from mujoco import MjModel

from actr3d.recording import Recorded
from actr3d.recording.facts import SIMULATION
from actr3d.recording.writer import State
from actr3d.world.compiled import from_bytes, from_text
from workbench.program_time import timed
from workbench.worker.state_history import MAX_SIMULATIONS, StateHistory


@dataclass(kw_only=True)
class RecordedSimulation:
    """A simulation of a recording."""

    number: int
    """Its number among the runs of its program; 1 for a simulation that was recorded alone."""
    begin: int
    """The time at which it began, as the workbench counts it [us]."""
    facts: dict[str, Any]
    """What is recorded of it: `compiled`, `world` and `period_us`."""
    past: StateHistory = field(default_factory=StateHistory)
    """Its states."""

    @property
    def period(self) -> int:
        """Length of a tick [us]."""
        return self.facts["period_us"]

    @cached_property
    def mj_model(self) -> MjModel:
        """The compiled scene at its start."""
        return from_bytes(from_text(self.facts["compiled"]))


def simulations_of(recorded: Recorded) -> list[RecordedSimulation]:
    """Returns the simulations of a recording whose scenes it has; of a program, as many of the latest as a run in the workbench shows.

    A simulation that never ticked counts only if it is the last one, which is about to tick.

    Raises:
        RecordingError: If the recording is damaged.
    """
    if recorded.facts["kind"] == "simulation":
        facts = facts_of_simulation(recorded, 1)
        if facts is None:
            return []
        alone = RecordedSimulation(number=1, begin=0, facts=facts)
        for state in recorded.states():
            alone.past.add_recorded(state)
        return [alone]
    found: dict[int, RecordedSimulation] = {}
    for state, time in timed(recorded):
        if not isinstance(state, State):
            continue
        if state.run not in found:
            facts = facts_of_simulation(recorded, state.run)
            if state.tick > 0 or facts is None:
                continue
            ticked = [number for number, one in found.items() if one.past.furthest > 0]
            if len(ticked) > MAX_SIMULATIONS:
                del found[ticked[0]]
            found[state.run] = RecordedSimulation(number=state.run, begin=time, facts=facts)
        found[state.run].past.add_recorded(state)
    last = max(found, default=0)
    return [one for number, one in sorted(found.items()) if one.past.furthest > 0 or number == last][-MAX_SIMULATIONS:]


def facts_of_simulation(recorded: Recorded, number: int) -> dict[str, Any] | None:
    """Returns what is recorded of a simulation: `compiled`, `world` and `period_us`; None if its scene is unknown."""
    facts = recorded.facts if recorded.facts["kind"] == "simulation" else recorded.facts.get(SIMULATION.format(number))
    return None if facts is None or "compiled" not in facts else facts
