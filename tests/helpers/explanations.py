"""Agents for the tests of explanations."""

from __future__ import annotations

from typing import Any

from actr3d.actr.kernel.model import ensure_converted
from actr3d.actr.kernel.run_limits import RunLimits
from actr3d.actr.loading import load_text


def agent_of(source: str, seed: int = 3) -> Any:
    """Returns an agent whose random numbers come from a seed, and that has not run yet."""
    agent = load_text("from actr3d.actr import *\n" + source, "explained.py").Agent()
    with RunLimits(seed=seed):
        ensure_converted(agent)
    return agent


def same_later(agent: Any, steps: int = 40, step: float = 0.0125) -> None:
    """Runs a traced agent, explaining it on the way, and asserts that its past is told later as its present was."""
    now: list[Any] = []
    for _ in range(steps):
        now.append(agent.explain())
        agent.run(step)
    for then in now:
        assert agent.explain(then.time) == then


def told_by(agent: Any, name: str) -> list[str]:
    """Returns a list of the model file's own, in which its functions write that they were called."""
    production = next(iter(agent._productions))
    return production.original_func.__globals__[name]
