"""Past states: what a trace knows for certain, what it knows as last seen, and what it does not know."""

from __future__ import annotations

from typing import Any

import pytest

from actr3d.actr import ACTR, Buffer, Memory, Model
from actr3d.errors import ParameterError
from tests.helpers.explanations import agent_of, assert_past_matches, recorded_calls

BINDING = """
calls = []
def measure(chunk, bound):
    calls.append('measure')
    bound['size'] = len(chunk[0])
def is_small(chunk, bound):
    calls.append('is_small')
    return bound['size'] < 4
class Agent(ACTR):
    goal, other = Buffer(), Buffer()
    def init():
        goal.set('ab')
        other.set('size:2')
    def fits(goal=['?word', measure, is_small], other='size:?n'):
        goal.set('abcdef')
    def long(goal=['?word', measure, lambda chunk, bound: bound['size'] > 4]):
        pass
"""


def test_results_of_pattern_functions_are_explained_without_calling_them_again() -> None:
    agent = agent_of(BINDING)
    calls = recorded_calls(agent, "calls")
    agent.traced()
    agent.run(0.01)
    before = list(calls)
    live = agent.explain()
    assert live.production("fits").matches
    assert live.production("fits").bindings == {"word": "ab", "n": "2", "size": "2"}
    long = live.production("long")
    assert (long.matches, long.condition, long.found) == (False, "goal: <lambda>()", "False, or an error such as a missing slot")
    assert long.bindings == {"word": "ab", "size": "2"}
    agent.run(0.05)
    assert agent.explain().production("fits").condition == "goal: is_small()"
    assert agent.explain(0.01) == live
    assert calls == [*before, *calls[len(before) :]]
    calls_before = len(calls)
    agent.explain()
    agent.explain(0.02)
    assert len(calls) == calls_before


def test_the_result_of_a_function_for_other_arguments_is_unknown() -> None:
    agent = agent_of("""
class Agent(ACTR):
    goal, side = Buffer(), Buffer()
    def init():
        goal.set('word one')
        side.set('go')
    def p(side='go'): pass
    def q(goal=['word ?w', lambda chunk, bound: bound['w'] == 'one'], side='stop'): pass
    def r(goal=['word ?w', lambda chunk, bound: bound['w'] == 'one'], utility=-1): pass
""")
    agent.traced()
    agent.sch.add(lambda: agent.goal.set("word two"), 0.02)
    agent.run(0.03)
    why = agent.explain().production("r")
    assert why.matches is None
    assert why.found == "unknown (the function was last called with ?w=one)"
    assert agent.explain(0.03).production("r") == why
    assert agent.explain(0.01).production("r").matches
    assert agent.explain().production("q").condition == "side: 0:stop"
    agent.sch.add(lambda: agent.side.set("stop"), 0)
    agent.run(0.001)
    q = agent.explain().production("q")
    assert q.matches is None
    assert q.found == "unknown (the function has not been called)"
    assert "? q" in str(q)


def test_plain_objects_are_explained_as_last_seen() -> None:
    agent = agent_of("""
class Lamp:
    colour = 'red'
class Agent(ACTR):
    goal = Buffer()
    lamp = Lamp()
    def init(): goal.set('a')
    def p(goal='a'): goal.set('b')
    def see(lamp='colour:red', goal='a', utility=-1): pass
    def nothing(lamp=None): pass
""")
    agent.traced()
    agent.run(0.02)
    assert agent.explain(0.02).production("see").source == "as seen since 0.000 s"
    assert "(as seen since 0.000 s)" in str(agent.explain(0.02))
    assert agent.explain(0.02) == agent.explain()
    assert not agent.explain(0.02).production("nothing").matches
    agent.lamp.colour = "green"  # no event records this until a production reads it
    assert agent.explain().production("see").found == "'green'"
    agent.run(0.01)
    past = agent.explain(0.025).production("see")
    assert past.matches
    assert past.source == "as seen since 0.000 s"


def test_a_chunk_changed_in_place_is_explained_from_that_moment_on() -> None:
    agent = agent_of("""
class Agent(ACTR):
    goal = Buffer()
    def init(): goal.set('step:a n:1')
    def p(goal='step:a n:1'): pass
    def q(goal='step:z'): pass
""")
    agent.traced()

    def behind_its_back() -> None:
        agent.goal.chunk["step"] = "z"

    agent.sch.add(behind_its_back, 0.02)
    agent.run(0.04)
    assert agent.explain().production("q").matches
    assert agent.explain(0.04) == agent.explain()
    assert agent.explain(0.03).production("q").matches
    assert not agent.explain(0.01).production("q").matches
    agent.goal.modify(n="2", step="y")
    events = [event.data["chunk"] for event in agent.sch.trace.select("buffer")]
    assert events[-2:] == [{"step": "z", "n": "2"}, {"step": "y", "n": "2"}]  # one event for each change, as before


ODD = """
from enum import Enum
class Colour(Enum):
    RED = 1
class Metres(float): pass
class Box(Model):
    pair, shade, width, items, word = (1, 2), Colour.RED, Metres(0.123456789), [1, 2], 'plain'
    _hidden = 'h'
class Agent(ACTR):
    goal = Buffer()
    box = Box()
    tags = ['t']
    def init():
        self._secret = 'x'
        goal.set({'pair': (1, 2), 'shade': Colour.RED, 'n': 3, 'width': Metres(2.5)})
    def a(box='pair:?x shade:?y width:?z items:?i name:?n word:?w'): self.box.pair = (3, 4)
    def b(self='_secret:?s tags:?t name:?n'): self._secret = 'y'
    def c(goal='pair:?p shade:?q n:?n width:?w'): self.tags.append('u')
    def d(box='width:0.123457 items:?i', self='_secret:y'): self.box.items = 'flat'
"""


def test_values_of_any_type_are_explained_alike_at_both_times() -> None:
    agent = agent_of(ODD)
    agent.traced()
    agent.run(0.0)
    first = agent.explain()
    bound = first.production("a").bindings
    assert bound == {"x": "(1, 2)", "y": "<Colour.RED: 1>", "z": "0.123457", "i": "[1, 2]", "n": "box", "w": "plain"}
    assert first.production("b").bindings["s"] == "x"
    assert first.production("c").bindings == {"p": "(1, 2)", "q": "<Colour.RED: 1>", "n": "3", "w": "2.5"}
    assert_past_matches(agent)


def test_an_agent_keeps_its_past_when_it_leaves_or_moves() -> None:
    world: Any = Model()
    world.first, world.second = Model(), Model()
    agent: Any = agent_class()()
    world.first.agent = agent
    world.traced()
    world.run(0.06)
    before = agent.explain()
    assert before.agent == "first.agent"
    agent.parent = None
    world.run(0.06)
    assert agent.explain(0.06) == before
    gone = agent.explain()
    assert gone.production("go").bindings == {"n": "1"}
    world.second.walker = agent
    world.run(0.06)
    assert agent.explain().agent == "second.walker"
    assert agent.explain(0.06) == before
    assert agent.explain(0.12) != before
    assert agent.explain(agent.now()) == agent.explain()


def agent_class() -> Any:
    made: Any = agent_of("""
class Agent(ACTR):
    goal = Buffer()
    def init(): goal.set('step 1')
    def go(goal='step ?n'): self.mark = 'set'
""")
    return made.__class__


def test_nothing_is_explained_from_before_an_agent_was_added() -> None:
    world: Any = Model()
    world.agent = agent_class()()
    world.traced()
    world.run(0.5)
    world.late = agent_class()()
    world.run(0.1)
    assert world.late.explain(0.5).production("go").matches is not None
    assert world.late.explain(0.55).agent == "late"
    with pytest.raises(ParameterError, match=r"'late' did not exist at 0\.3 s; it was added at 0\.5 s"):
        world.late.explain(0.3)
    world.agent = agent_class()()  # another one in its place
    world.run(0.1)
    with pytest.raises(ParameterError, match=r"'agent' did not exist at 0\.2 s"):
        world.agent.explain(0.2)


@pytest.mark.parametrize("at", [float("nan"), float("inf"), "0.1", object()])
def test_an_invalid_time_is_an_error(at: Any) -> None:
    agent = agent_class()()
    agent.traced()
    agent.run(0.1)
    with pytest.raises(ParameterError, match="must be a finite number of seconds"):
        agent.explain(at)
    with pytest.raises(ParameterError, match="the trace begins at 0 s"):
        agent.explain(-1)


def test_the_first_explanation_may_come_before_the_first_run() -> None:
    agent = agent_of("""
class Agent(ACTR):
    goal, retrieval = Buffer(), Buffer()
    memory = Memory(retrieval)
    def init(): goal.set('go')
    def go(goal='go'): pass
    def idle(goal=None, memory='busy:False'): pass
""")
    why = agent.explain()
    assert not why.begun
    assert "before its first run" in str(why)
    assert why.production("idle").matches
    assert why.production("go").found == "goal is empty"
    agent.run(0)
    assert agent.explain().begun
    assert agent.explain().production("go").selected


def test_a_parallel_system_explains_the_memory_that_it_sees() -> None:
    agent = agent_of("""
class Eye(ProductionSystem):
    def look(retrieval='a ?x'): pass
class Agent(ACTR):
    goal, retrieval = Buffer(), Buffer()
    memory = Memory(retrieval)
    eye = Eye()
    def init():
        memory.add('a b')
        memory.request('a ?')
""")
    agent.traced()
    agent.run(0.2)
    why = agent.eye.explain()
    assert [retrieval.memory for retrieval in why.retrievals] == ["memory"]
    assert agent.eye.explain(0.2) == why
    assert [reason.system for reason in why.productions] == ["eye"]
    assert "in eye:" in str(agent.explain())


def test_the_candidates_are_explained_as_they_were_at_the_request() -> None:
    class Asking(ACTR):
        goal = Buffer()
        retrieval = Buffer()
        memory = Memory(retrieval)

    agent: Any = Asking()
    trace = agent.traced()
    agent.memory.add("kind:fruit name:apple")
    pattern = {"kind": "fruit"}
    agent.memory.request(pattern)
    before = agent.explain()
    agent.memory.dm[0]["name"] = "pear"
    pattern["kind"] = "tool"
    assert agent.explain() == before
    assert before.retrievals[0].candidates[0].chunk == "kind:fruit name:apple"
    assert before.retrievals[0].request == trace.select("request")[-1].data["pattern"] == "{'kind': 'fruit'}"


def test_a_modellers_own_activation_is_not_taken_for_that_of_a_module() -> None:
    agent = agent_of("""
class Own(Memory):
    def get_activation(self, chunk): return 2.5
class Agent(ACTR):
    retrieval = Buffer()
    memory = Own(retrieval)
    fixed = DMFixed(memory)
    def init():
        memory.add('a b')
        memory.request('a ?')
""")
    agent.run(0)
    assert agent.explain().retrievals[0].candidates[0].parts == {"get_activation": 2.5}


WORLD = """
class Eyes(ACTR):
    goal, seen, place, held = Buffer(), Buffer(), Buffer(), Buffer()
    look = SOSVision(seen, delay=0.03)
    vision = Vision(seen, place)
    imaginal = ImaginalModule(held)
    hand = Motor()
    clock = Timer()
    def init(): goal.set('find')
    def find(goal='find', look='busy:False error:False'):
        look.request('kind:ball')
        goal.set('wait')
    def found(goal='wait', seen='kind:ball colour:?c', imaginal='busy:False'):
        imaginal.set('saw ?c')
        goal.set('hold ?c')
    def missed(goal='wait', look='error:True'): goal.set('find')
    def hold(goal='hold ?c', held='saw ?c', imaginal='busy:False', hand='busy:False'):
        top.ball.colour = 'gone'
        goal.set('find')
    def busy(imaginal='busy:True', utility=-1): pass
    def ball_there(ball='colour:?c', utility=-2): pass
class Ball(Model):
    kind, colour, salience, visible, value = 'ball', 'red', 0.7, True, 1
class Agent(Model):
    def key_pressed(self, key): pass
    ball = Ball()
    one, two = Eyes(), Eyes()
"""


def test_every_module_and_two_agents_are_explained_later_as_they_were() -> None:
    world = agent_of(WORLD)
    world.traced()
    world.run(0.0)
    now: list[Any] = []
    for _ in range(80):
        now += [world.one.explain(), world.two.explain()]
        world.run(0.0125)
    for then in now:
        agent = world.one if then.agent == "one" else world.two
        assert agent.explain(then.time) == then
    states = {(reason.condition, reason.found) for then in now for reason in then.productions if "busy" in str(reason.condition)}
    assert ("imaginal: busy:True", "'False'") in states
    assert ("look: busy:False", "'True'") in states or ("imaginal: busy:False", "'True'") in states
    assert {then.agent for then in now} == {"one", "two"}
