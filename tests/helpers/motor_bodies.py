"""Bodies that a test moves through their motor modules."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from actr3d.actr import ACTR, Buffer, Memory
from actr3d.motor import Motor
from actr3d.simulation import Simulation
from actr3d.world import Floor, Mannequin, Scene


def mover(**parameters: Any) -> Callable[[], Any]:
    """Returns a factory of agents that have a motor module and do nothing by themselves."""

    def make() -> Any:
        retrieval, posture = Buffer(), Buffer()
        memory = Memory(retrieval)
        parts = {"retrieval": retrieval, "posture": posture, "memory": memory, "motor": Motor(posture, memory=memory, **parameters)}
        return type("Mover", (ACTR,), parts)()

    return make


def motor_of(simulation: Simulation, name: str = "walker") -> Any:
    """Returns the motor module of an agent."""
    agents: Any = simulation.timeline.lockstep.agents
    return agents.environment[name].motor


def moving(*parts: Any, body: Any = None, trace: str = "none", seed: int = 1, **parameters: Any) -> tuple[Simulation, Any]:
    """Returns a simulation of a mannequin called `walker`, or of another body, and its motor module, which knows its body."""
    body = Mannequin(name="walker") if body is None else body
    simulation = Simulation(Scene(parts=(Floor(), body, *parts)), {body.name: mover(**parameters)}, seed=seed, trace=trace)
    simulation.step(2)
    return simulation, motor_of(simulation, body.name)


def until(simulation: Simulation, condition: Callable[[], bool], max_ticks: int = 1000) -> int:
    """Steps until a condition holds; returns the number of ticks."""
    for ticks in range(max_ticks):
        if condition():
            return ticks
        simulation.step()
    raise AssertionError("the condition never held")


def during(simulation: Simulation, act: Callable[[], None]) -> None:
    """Runs one tick, and calls a function in the middle of it, as an agent would."""
    agents: Any = simulation.timeline.lockstep.agents
    agents.environment.sch.call_after(0.005, act)
    simulation.step()
