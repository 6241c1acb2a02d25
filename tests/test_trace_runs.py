"""Several runs under one trace, and traces that begin in the middle of a run."""

from __future__ import annotations

import gc
import json
import weakref
from typing import Any

import pytest

from actr3d.actr import ACTR, Buffer, Memory, Model
from actr3d.actr.kernel.model import ensure_converted
from actr3d.actr.kernel.run_limits import RunLimits
from actr3d.actr.loading import load_text, run_text
from actr3d.actr.reasons import Explanation
from actr3d.errors import ParameterError
from actr3d.trace import Trace, TraceEvent
from actr3d.trace_kinds import KINDS

AGENT = """
from actr3d.actr import *

class Lamp:
    colour = 'red'

def small(chunk, bound):
    return int(bound['n']) < 5

class Eye(ProductionSystem):
    production_time = 0.03
    seen = 0
    def look(goal='count ?n', self='seen:0'):
        self.seen = 1
    def blink(self='seen:1'):
        self.seen = 0

class Agent(ACTR):
    goal, retrieval = Buffer(), Buffer()
    memory = Memory(retrieval, latency=0.07)
    noise = DMNoise(memory, 0.1)
    learning = PMNew()
    whim = PMNoise(noise=0.1)
    lamp = Lamp()
    eye = Eye()
    def init():
        for i in range(10): memory.add(f'next {i} {i + 1}', time=5)
        goal.set('count 0')
    def ask(goal=['count ?n', small], lamp='colour:red'):
        memory.request('next ?n ?')
        goal.set('wait ?n')
    def answer(goal='wait ?n', retrieval='next ?n ?m'):
        self.reward(1)
        goal.set('count ?m')
    def again(goal=['count ?n', small]):
        lamp.colour = 'red'
        memory.request('next ?n ?')
        goal.set('wait ?n')
    def forget(goal='wait ?n', utility=-2):
        lamp.colour = 'green'
        memory.request('no such thing')
"""


def agent_of(seed: int, trace: Trace | None = None) -> Any:
    agent = load_text(AGENT, "late.py").Agent()
    with RunLimits(seed=seed, trace=trace):
        ensure_converted(agent)
    return agent


# -- several runs


def test_runs_of_one_trace_are_distinguished() -> None:
    program = AGENT + "\nfor i in range(3):\n    agent = Agent()\n    agent.run(0.06)\n"
    trace = Trace()
    run_text(program, "three.py", limits=RunLimits(seed=4, trace=trace))
    alone = Trace()
    run_text(program.replace("range(3)", "range(1)"), "three.py", limits=RunLimits(seed=4, trace=alone))
    runs = {number: [event for event in trace if event.run == number] for number in (1, 2, 3)}
    assert sum(map(len, runs.values())) == len(trace)
    assert runs[1] == list(alone)
    assert [event.source for event in trace.select("start")] == ["top", "top#2", "top#3"]
    for number, events in runs.items():
        times = [event.time for event in events]
        assert times == sorted(times)
        paths = {event.source.replace(f"top#{number}.", "").replace(f"top#{number}", "top") for event in events}
        assert paths == {event.source for event in runs[1]}
    assert json.loads(runs[2][-1].to_json())["source"] == "top#2"
    assert trace.select("buffer", "goal") != trace.select("buffer", "top#2.goal") != []


def test_runs_that_take_turns_are_distinguished() -> None:
    with RunLimits(seed=1, trace=Trace()) as limits:
        first, second = load_text(AGENT).Agent(), load_text(AGENT).Agent()
        first.run(0)
        second.run(0.2)
        first.run(0.1)
    assert limits.trace is not None
    assert [event.run for event in limits.trace.select("run")] == [1, 2, 1]
    told = second.explain(0.15)
    assert told.agent == "top#2"
    assert [reason.system for reason in told.productions][-1] == "top#2.eye"
    assert [reason.memory for reason in told.retrievals] == ["top#2.memory"]
    assert first.explain(0.06).retrievals[0].outcome == "pending"  # whatever the other has done since
    limits.trace.command("step", run=1)
    limits.trace.command("step")
    assert [(e.source, e.time) for e in limits.trace.select("command")] == [("top", 0.1), ("top#2", 0.2)]


def test_a_model_that_joins_another_has_its_earlier_name_in_the_trace() -> None:
    with RunLimits(seed=1, trace=Trace()) as limits:
        agent: Any = ACTR()
        agent.goal = Buffer()  # it comes to life by itself
        room: Any = Model()
        room.agent = agent
        agent.goal.set("a")
        room.run(1)
    assert limits.trace is not None
    assert [event.source for event in limits.trace.select("start")] == ["top", "top#2"]
    assert limits.trace.select("added")[-1] == TraceEvent(0, "top#2", "added", {"part": "agent", "model": "ACTR", "was": "top"})
    assert limits.trace.select("buffer")[-1].source == "top#2.agent.goal"


def test_a_trace_goes_with_a_model_that_joins_another() -> None:
    agent: Any = ACTR()
    agent.goal = Buffer()
    trace = agent.traced()
    room: Any = Model()
    room.agent = agent
    agent.goal.set("a")
    assert trace.select("buffer")[-1].data == {"chunk": {"0": "a"}}
    assert room.sch.trace is trace


def test_a_trace_does_not_keep_its_models_alive() -> None:
    trace = Trace()
    with RunLimits(seed=1, trace=trace):
        model: Any = Model()
        model.run(1)
    gone = weakref.ref(model)
    del model
    gc.collect()
    assert gone() is None
    with pytest.raises(ParameterError, match="there are: none"):
        trace.command("pause")


# -- several traces of one run


@pytest.mark.parametrize("level", ["production", "buffer", "all"])
def test_a_trace_of_ones_own_leaves_the_one_of_the_program_as_it_is(level: str) -> None:
    whole: list[list[str]] = []
    for own in (None, "production", "all"):
        heard: list[TraceEvent] = []
        program = Trace(level)
        program.listen(heard.append)
        agent_of(2, program).run(0.1)
        agent = agent_of(1, program)
        if own is not None:
            agent.traced(own)
        agent.run(0.3)
        assert heard == list(program)
        whole.append([event.to_json() for event in heard])
    assert len(whole[0]) > 10
    assert whole == [whole[0]] * 3


def test_a_trace_of_ones_own_is_the_same_in_a_program_that_is_traced() -> None:
    found: list[Any] = []
    for program in (None, Trace("production"), Trace(keep=False)):
        agent_of(2, program).run(0.1)
        agent = agent_of(1, program)
        agent.parts = [agent.eye]
        own = agent.traced()
        agent.run(0.3)
        found.append(
            (
                [event.to_json() for event in own],
                [str(agent.explain(at)).replace("top#2.", "").replace("top#2", "top") for at in (0.02, 0.17)],
            )
        )
    assert found == [found[0]] * 3


def test_a_second_trace_does_not_end_the_first() -> None:
    agent = agent_of(1)
    first = agent.traced()
    second = agent.traced("production")
    agent.run(0.3)
    assert agent.explain(0.2).time == 0.2
    assert [e for e in first if KINDS[e.kind].level == "production"][1:] == list(second)[1:]


def test_what_a_listener_of_any_trace_raises_is_raised_by_the_run() -> None:
    agent = agent_of(1)
    first = agent.traced()
    second = agent.traced()

    def fail(event: TraceEvent) -> None:
        if event.kind == "fire":
            raise ValueError("the disk is full")

    second.listen(fail)
    with pytest.raises(ValueError, match="the disk is full"):
        agent.run(0.3)
    agent.run(0.3)
    assert first.select("fire") == second.select("fire") != []


def test_a_program_does_not_keep_the_traces_of_models_that_are_gone() -> None:
    program = Trace("production")
    own = weakref.ref(agent_of(1, program).traced("production").runs[0])
    gc.collect()
    agent_of(2, program).run(0.1)
    gc.collect()
    assert own() is None


# -- a trace that begins late


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("ticks", range(1, 30, 3))
def test_a_late_trace_explains_its_first_moment_as_the_present_was(seed: int, ticks: int) -> None:
    agent = agent_of(seed)
    agent.run(ticks * 0.0125)
    agent.traced()
    now: list[Explanation] = []
    for _ in range(12):
        now.append(agent.explain())
        agent.run(0.0125)
    for then in now:
        assert agent.explain(then.time) == then


def test_a_trace_that_begins_late_includes_what_is_under_way() -> None:
    agent = agent_of(1)
    agent.run(0.055)
    trace = agent.traced()
    begin = list(trace)
    assert {event.time for event in begin} == {0.055}
    by = {(event.source, event.kind): event.data for event in begin}
    assert by["goal", "buffer"] == {"chunk": {"0": "wait", "1": "0"}}
    assert by["memory", "state"]["size"] == 10
    assert by["memory", "state"]["busy"] is True
    request = by["memory", "request"]
    assert (request["asked"], request["made"], request["outcome"]) == ("0:next 1:0", 0.05, "pending")
    assert by["top", "productions"]["chosen"] == "forget"
    assert by["eye", "productions"]["chosen"] == "blink"
    assert by["top", "observe"]["lamp.colour"] == "red"


@pytest.mark.parametrize(("steps", "outcome"), [(0.06, "pending"), (0.13, "retrieved"), (0.6, "failed")])
def test_the_outcome_of_an_earlier_request_is_explained(steps: float, outcome: str) -> None:
    agent: Any = ACTR()
    agent.retrieval = Buffer()
    agent.memory = Memory(agent.retrieval, threshold=0)
    agent.run(0.04)
    agent.memory.add("a b")
    agent.memory.request("a ?" if outcome != "failed" else "x ?")
    agent.run(steps - 0.04)
    agent.traced()
    (told,) = agent.explain(agent.now()).retrievals
    assert (told.time, told.outcome) == (0.04, outcome)


def test_what_was_before_the_trace_is_not_made_up() -> None:
    agent = agent_of(1)
    agent.run(0.1)
    agent.traced()
    with pytest.raises(ParameterError, match=r"the trace begins at 0\.1 s; what was before the trace is not known \(got 0\.05 s\)"):
        agent.explain(0.05)


def test_beginning_a_trace_runs_no_code_of_the_models() -> None:
    source = """
from actr3d.actr import *
calls = []
class Own(ProceduralSubModule):
    def utility(self, prod):
        calls.append('utility')
        return self.random.random()
class Thing:
    def __repr__(self):
        calls.append('repr')
        return 'thing'
class Agent(ACTR):
    goal = Buffer()
    own = Own()
    things = [Thing()]
    thing = Thing()
    @property
    def mood(self):
        calls.append('mood')
        return 'calm'
    def init(): goal.set({'thing': self.things[0], 'step': 'a'})
    def one(goal='step:a'): goal.modify(step='b')
"""
    module: Any = load_text(source, "quiet.py")
    agent = module.Agent()
    agent.run(0.06)
    module.calls.clear()
    trace = agent.traced()
    assert module.calls == []
    assert {"thing": "<Thing>", "step": "b"} in [event.data["chunk"] for event in trace.select("buffer")]
    agent.goal.modify(step="c")
    assert trace.select("buffer")[-1].data == {"chunk": {"thing": "<Thing>", "step": "c"}}
    assert module.calls == []


def test_explanations_of_the_past_show_objects_as_matching_did() -> None:
    source = """
from actr3d.actr import *
class Thing:
    def __repr__(self): return 'lamp'
class Agent(ACTR):
    goal = Buffer()
    def init(): goal.set({'thing': Thing()})
    def yes(goal='thing:lamp'): goal.set('done')
    def no(goal='thing:chair'): pass
"""
    agent: Any = load_text(source, "things.py").Agent()
    agent.traced()
    agent.run(1)
    told = agent.explain(0.02)
    assert told.production("yes").matches
    assert told.production("no").found == "unknown (an object that only its own code can convert to text)"
    assert told.production("no").matches is None
