"""Agents with planning units, for the tests of SGOMS."""

from __future__ import annotations

from typing import Any

from actr3d.actr.kernel.run_limits import RunLimits
from actr3d.actr.loading import load_text

HEAD = """
from actr3d.actr import *
from actr3d.sgoms import SGOMS, Ordered, Situated

said = []

class Base(SGOMS):
    'Every unit task is a method of `steps` productions.'
    steps = 2
    tea = Ordered("boil", "steep", "pour")
    phone = Ordered("pick_up", "talk")
    alarm = Ordered("run")

    def init():
        b_plan_unit.set("planning_unit:tea")
    def begin(b_unit_task="unit_task:?task state:start"):
        said.append((self.now(), task))
        b_method.set(f"method:work left:{self.steps}")
        b_unit_task.modify(state="running")
    def work(b_method="method:work left:?left!0"):
        b_method.modify(left=int(left) - 1)
    def end(b_unit_task="state:running", b_method="left:0"):
        b_unit_task.modify(state="finished")

def later(time, *asked):
    class Bell(Model):
        def start(self):
            for moment, text in zip((time,) + asked[1::2], asked[::2]):
                yield moment - self.now()
                self.parent.agent.b_interrupt.set(text)
    return Bell()

class World(Model):
    pass
"""
"""A unit task of `Base` takes 0.05 s to begin, 0.05 s for each step, 0.05 s to end; 0.15 s pass until the next begins."""


def cooking(body: str = "class Agent(Base): pass", *bells: Any, seconds: float = 10, seed: int = 1, traced: bool = True) -> Any:
    """Runs the class Agent of a text; `bells` interrupt it: time, request, time, request. Returns the text's module.

    The module has the `agent`, the `trace`, and in `said` the time and name of each unit task that began.
    """
    module: Any = load_text(HEAD + body, "planning.py")
    with RunLimits(seed=seed):
        world = module.World()
        world.agent = module.agent = module.Agent()
        if bells:
            world.bell = module.later(*bells)
        module.trace = world.traced() if traced else None
        world.run(seconds)
    return module


def level_events(module: Any, *kinds: str) -> list[str]:
    """Returns the events of some levels as texts: `0.15 begun tea/boil`."""
    return [f"{event.time:.10g} {event.data['what']} {event.data['path']}" for event in module.trace if event.kind in kinds]


def fired(module: Any) -> list[tuple[float, str]]:
    """Returns the productions that fired, and when [s]."""
    return [(event.time, event.data["production"]) for event in module.trace.select("fire")]
