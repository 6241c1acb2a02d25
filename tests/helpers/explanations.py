"""Agents for the tests of explanations."""

from __future__ import annotations

from typing import Any

from actr3d.actr.kernel.model import ensure_converted
from actr3d.actr.kernel.run_limits import RunLimits
from actr3d.actr.loading import load_text


def agent_of(source: str, seed: int = 3) -> Any:
    """Returns an agent that has not run yet, with a seed for its random numbers."""
    agent = load_text("from actr3d.actr import *\n" + source, "explained.py").Agent()
    with RunLimits(seed=seed):
        ensure_converted(agent)
    return agent


def assert_past_matches(agent: Any, steps: int = 40, step: float = 0.0125) -> None:
    """Runs a traced agent and explains it at each step; asserts that each explanation is the same when it is past."""
    now: list[Any] = []
    for _ in range(steps):
        now.append(agent.explain())
        agent.run(step)
    for then in now:
        assert agent.explain(then.time) == then


def recorded_calls(agent: Any, name: str) -> list[str]:
    """Returns a global list of the model file, in which its functions record their calls."""
    production = next(iter(agent._productions))
    return production.original_func.__globals__[name]
