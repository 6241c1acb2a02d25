"""When runs end: under ACT-R 7 with the last event that has an effect, under Python ACT-R as in python_actr."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

from actr3d.actr import ACTR, Buffer, Chunk, DMFixed, Memory, Model
from actr3d.actr.kernel.events import Trigger
from actr3d.actr.loading import load_text
from actr3d.simulation import Simulation
from tests.helpers.small_agents import started_agent
from tests.helpers.walkers import scene_of


def remembering(profile: str, **options: Any) -> Any:
    buffer = Buffer()
    memory = Memory(buffer, **options)
    agent = started_agent(profile, buffer=buffer, memory=memory, fixed=DMFixed(memory))
    agent.memory.add("a 1", fixed=1)
    agent.memory.add("a 2")
    agent.memory.add("b")
    return agent


@pytest.mark.parametrize(("profile", "ends"), [("act-r-7", [0.05, 0.1]), ("python-actr", [3.0, 6.0])])
def test_a_run_ends_with_the_retrieval_or_when_its_mark_expires(profile: str, ends: list[float]) -> None:
    agent = remembering(profile, latency=0.05)
    for end in ends:
        agent.memory.request("b")
        agent.run()
        assert agent.buffer.chunk == Chunk("b")
        assert agent.now() == end


def test_marks_still_expire() -> None:
    agent = remembering("act-r-7", latency=0.05, finst_time=1.0)
    found: list[str] = []
    for pause in (0, 0, 0.99):
        agent.run(pause)
        agent.memory.request("a ?", require_new=True)
        agent.run()
        found.append(str(agent.buffer.chunk))
    assert found == ["a 1", "a 2", "a 1"]
    agent.run(1)
    assert agent.memory.finst.obj == []


PROGRAM = """
from python_actr import *
class Agent(ACTR):
    profile = "act-r-7"
    buffer = Buffer()
    memory = Memory(buffer, latency=0.05)
    memory.add("b")
agent = Agent()
agent.run(0)
agent.memory.request("b")
agent.run()
"""


def test_a_program_written_for_python_actr_may_use_the_profile_of_act_r_7() -> None:
    agent = load_text(PROGRAM, "program.py").agent
    assert agent.now() == 0.05
    assert agent.memory.finst.obj == [Chunk("b")]
    agent.run(3)
    assert agent.memory.finst.obj == []


@pytest.mark.parametrize(("profile", "end"), [("act-r-7", 0.06), ("python-actr", 5.0)])
@pytest.mark.parametrize("first", ["nothing", "c"])
def test_no_run_waits_for_the_answer_to_a_request_that_was_replaced(profile: str, end: float, first: str) -> None:
    buffer = Buffer()
    memory = Memory(buffer, latency=0.05, threshold=-4.60517018599, maximum_time=5.0, finst_time=1.0)
    agent = started_agent(profile, buffer=buffer, memory=memory, fixed=DMFixed(memory))
    agent.memory.add("b")
    agent.memory.add("c", fixed=-4.6051)
    agent.memory.request(first)
    agent.run(0.01)
    agent.memory.request("b")
    agent.run()
    assert agent.now() == pytest.approx(end, abs=0.001)
    assert agent.buffer.chunk == Chunk("b")


@pytest.mark.parametrize(("profile", "end"), [("act-r-7", 0.1), ("python-actr", 5.0)])
def test_no_run_waits_for_a_time_that_something_else_came_before(profile: str, end: float) -> None:
    class Patient(Model):
        def start(self) -> Iterator[Any]:
            self.bell = Trigger("bell")
            self.ring()
            yield self.bell, 5.0

        def ring(self) -> Iterator[Any]:
            yield 0.1
            self.sch.trigger(self.bell)

    agent: Any = type("Agent", (ACTR,), {"profile": profile, "patient": Patient()})()
    agent.run()
    assert agent.now() == end


def test_a_simulation_is_done_with_the_last_event() -> None:
    module: Any = load_text(
        """
from actr3d.actr import *
class Rememberer(ACTR):
    profile = "act-r-7"
    buffer = Buffer()
    memory = Memory(buffer, latency=0.05)
    def init():
        memory.add("b")
        memory.request("b")
""",
        "rememberer.py",
    )
    simulation = Simulation(scene_of("walker"), {"walker": module.Rememberer})
    assert simulation.run().ended_by == "done"
    assert simulation.time == 0.05
