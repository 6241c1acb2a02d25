"""Small scenes for tests of vision: agents at bodies without physics, and detectors with a camera alone."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

from actr3d.actr.loading import load_text
from actr3d.simulation import Simulation
from actr3d.simulation.agents import Agents
from actr3d.vision import DETECTORS
from actr3d.world import Aperture, Floor, Mannequin, Scene, World
from tests.helpers.camera_scenes import seen

PERIOD = 10_000


def found(name: str, world: str, eye: str = "", **parameters: Any) -> tuple[Any, ...]:
    """Returns what a detector finds from the site 'eye', 1.5 m above the origin and looking along x by default."""
    _, view = seen(world, eye=eye, **parameters)
    return DETECTORS[name](view)


def wall(name: str, x: float, left: float, right: float, height: float = 2.5, thick: float = 0.1) -> str:
    """Returns a wall across the view, from `left` to `right` (y), its middle line at x, as a separate body."""
    size = f"{thick / 2} {(left - right) / 2} {height / 2}"
    return f'<body name="{name}" pos="{x} {(left + right) / 2} {height / 2}"><geom name="{name}" type="box" size="{size}"/></body>'


def doorway(x: float, width: float, aside: float = 0.0, thick: float = 0.1) -> str:
    """Returns two walls with a gap between them: its front is at x, its middle at y = `aside`."""
    left, right = aside + width / 2, aside - width / 2
    return wall("a", x + thick / 2, left + 2.5, left, thick=thick) + wall("b", x + thick / 2, right, right - 2.5, thick=thick)


def pole(name: str, x: float, y: float, radius: float = 0.02, height: float = 2.0) -> str:
    """Returns a round pole that stands on the ground."""
    return f'<body name="{name}" pos="{x} {y} {height / 2}"><geom type="cylinder" size="{radius} {height / 2}"/></body>'


def agent(text: str, body: str = "walker") -> Any:
    """Returns the class `Agent` of a model's text."""
    return load_text(text, "looking.py").Agent


class AgentWithoutPhysics:
    """An agent whose body is in a world without physics: the ticks of `Simulation` alone.

    Args:
        world: The world.
        kind: The class of the agent.
        seed: The seed of its random choices.
    """

    def __init__(self, world: World, kind: Any, seed: int = 1, trace: Any = None) -> None:
        self._world = world
        self._agents = Agents({"walker": kind}, frozenset({"walker"}), seed, trace, PERIOD)
        self.agent: Any = self._agents.environment["walker"]

    def tick(self, n: int = 1) -> AgentWithoutPhysics:
        """Runs the agent for some ticks, and answers its requests."""
        for _ in range(n):
            self._agents.run(PERIOD / 1e6)
            asked, self._agents.outbox[:] = list(self._agents.outbox), []
            for request in asked:
                word = self._world.bodies["walker"]
                if request.reading is None:
                    word.set(request.word, *request.values, **request.named)
                else:
                    self._agents.take(request, word.get(request.word, *request.values, **request.named))
        return self


def seeing_for(seconds: float) -> Any:
    """Returns the trace of an agent that searches for an opening and finds it."""
    kind = agent(
        """
from actr3d.actr import *
from actr3d.vision import Vision
class Agent(ACTR):
    visual = Buffer()
    vision = Vision(visual, rows=5)
    def look(vision="busy:False", visual=None):
        vision.request("feature:opening")
"""
    )
    simulation = Simulation(Scene(parts=(Floor(), Aperture(), Mannequin(name="walker"))), {"walker": kind}, trace="all")
    simulation.run(seconds)
    return simulation.trace


def events(trace: Any, kind: str, source: str = "walker.vision") -> Iterator[tuple[float, dict[str, Any]]]:
    """Yields the times and data of the events of a kind."""
    for event in trace:
        if event.kind == kind and event.source.endswith(source):
            yield event.time, event.data
