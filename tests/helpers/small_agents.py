"""Small agents for the tests of numbers."""

from __future__ import annotations

import importlib
from typing import Any

from actr3d.actr import ACTR

near: Any = importlib.import_module("pytest").approx
"""`pytest.approx`, which has no complete types."""


def started_agent(profile: str | None = None, seed: int = 1, **parts: Any) -> Any:
    """Returns an agent with these parts that has been started, at time 0."""
    if profile is not None:
        parts["profile"] = profile
    agent: Any = type("Agent", (ACTR,), parts)()
    agent.run(0)
    agent.random.seed(seed)
    return agent
