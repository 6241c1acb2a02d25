"""Runs an agent for the tests of the production cycle."""

from __future__ import annotations

from typing import Any

from actr3d.actr.loading import load_text

HEAD = "from actr3d.actr import *\nout = []\n"


def run(body: str, seconds: float = 1.0) -> Any:
    """Runs the class Agent of a text inside a world, and returns the text's module, with `world` and `trace`."""
    module: Any = load_text(HEAD + body, "cycle.py")
    module.world = module.World() if hasattr(module, "World") else module.Agent()
    module.trace = module.world.traced("production")
    module.world.run(seconds)
    return module


def fired(module: Any, source: str | None = None) -> list[tuple[float, str]]:
    return [(event.time, event.data["production"]) for event in module.trace.select("fire", source)]
