"""Times in whole milliseconds under ACT-R 7, and only there."""

from __future__ import annotations

from typing import Any

import pytest

import actr3d.actr as library
from actr3d.actr import ACTR, Buffer, Chunk, ImaginalModule, Memory, Model, Motor
from tests.helpers.python_actr_reference import model_file
from tests.helpers.small_agents import near, started_agent


def test_only_the_events_of_such_agents_lie_at_whole_milliseconds() -> None:
    class Clock(Model):
        def start(self) -> Any:
            self.seen: list[float] = []
            while self.now() < 0.003:
                yield 0.0006
                self.seen.append(self.now())

    class Agent(ACTR):
        goal = Buffer()
        imaginal = Buffer()
        imagination = ImaginalModule(imaginal, delay=0.0126)
        clock = Clock()

    class Seven(Agent):
        profile = "act-r-7"

    class World(Model):
        python = Agent()
        seven = Seven()
        clock = Clock()

    world: Any = World()
    world.run(0.01)
    assert world.python.clock.seen == world.clock.seen == near([0.0006 * n for n in range(1, 6)])
    assert world.seven.clock.seen == [0.001, 0.002, 0.003]
    for agent in (world.python, world.seven):
        agent.imagination.set("a")
    world.run(0.0127)
    assert world.python.imaginal.chunk == Chunk("a")
    assert world.seven.imaginal.chunk is None
    world.run(0.0004)
    assert world.seven.imaginal.chunk == Chunk("a")


@pytest.mark.parametrize(("profile", "fired"), [("python-actr", [0.0504, 0.1008, 0.1512]), ("act-r-7", [0.05, 0.1, 0.15])])
def test_production_times(profile: str, fired: list[float]) -> None:
    agent = model_file("three_steps").make(library, profile=profile, production_time=0.0504)()
    trace = agent.traced("production")
    agent.run(1)
    assert [event.time for event in trace.select("fire")] == fired


def test_a_memory_of_its_own_profile_leaves_the_agents_time_alone() -> None:
    agent = model_file("three_steps").make(library, production_time=0.0504, memory=Memory(Buffer(), profile="act-r-7"))()
    trace = agent.traced("production")
    agent.run(1)
    assert [event.time for event in trace.select("fire")] == [0.0504, 0.1008, 0.1512]


def test_short_steps_of_a_run_add_up_under_act_r_7() -> None:
    agent = started_agent("act-r-7", motor=Motor())
    for _ in range(10):
        agent.run(0.0004)
    assert agent.now() == 0.004
