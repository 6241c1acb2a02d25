"""Explanations of the present and of past times, which change nothing."""

from __future__ import annotations

from typing import Any

import pytest

from actr3d.actr.kernel.model import ensure_converted
from actr3d.actr.kernel.run_limits import RunLimits
from actr3d.actr.loading import load_text
from actr3d.actr.reasons import Explanation
from actr3d.errors import ParameterError
from tests.helpers.small_agents import near

NOISY = """
from actr3d.actr import *

class Lamp:
    colour = 'red'

class Eye(ProductionSystem):
    production_time = 0.02
    seen = 'no'
    def look(goal='action:counting', self='seen:no'):
        self.seen = 'yes'

def small(thing, bound):
    return int(bound['now']) < 4

class Agent(ACTR):
    goal = Buffer()
    retrieval = Buffer()
    memory = Memory(retrieval, threshold=-2)
    noise = DMNoise(memory, noise=0.2)
    base = DMBaseLevel(memory)
    similar = Partial(memory)
    learning = PMNew()
    whim = PMNoise(noise=0.1)
    lamp = Lamp()
    eye = Eye()

    def init():
        for i in range(10):
            memory.add(f'count {i} {i + 1}')
        goal.set('action:start from:2 to:5')

    def start(goal='action:start from:?first', utility=2):
        memory.request('count ?first ?next')
        goal.modify(action='counting')

    def count_on(goal='action:counting from:?now to:!?now', retrieval='count ?now ?next', lamp='colour:red'):
        goal.modify(**{'from': next})
        memory.request('count ? ?', require_new=True)
        self.reward(3)
        lamp.colour = 'green'

    def any_way(goal=['action:counting from:?now', small], lamp='colour:green', retrieval='count ?'):
        lamp.colour = 'red'
        memory.request('count ?now ?')

    def stop(goal='action:counting from:?last to:?last'):
        goal.clear()

    def wait(goal=None):
        pass
"""


def agent_of(source: str, seed: int = 3) -> Any:
    """Returns an agent with a seed for its random numbers."""
    agent = load_text(source, "explained.py").Agent()
    with RunLimits(seed=seed):
        ensure_converted(agent)
    return agent


@pytest.mark.parametrize("seed", range(5))
def test_the_past_is_explained_as_the_present_was(seed: int) -> None:
    agent = agent_of(NOISY, seed)
    agent.traced()
    agent.run(0.0)
    now: list[Explanation] = []
    for _ in range(60):
        now.append(agent.explain())
        agent.run(0.0125)
    for then in now:
        # The present cannot know when an answer will have come, only the trace can; all else is the same.
        assert agent.explain(then.time) == then


def test_reading_changes_nothing() -> None:
    runs: list[list[str]] = []
    for asks in (False, True):
        agent = agent_of(NOISY)
        trace = agent.traced()
        for _ in range(200):
            if asks:
                agent.explain()
                agent.explain(agent.now())
            agent.run(0.01)
        runs.append([event.to_json() for event in trace])
    assert runs[0] == runs[1]
    assert len(runs[0]) > 50


SIMPLE = """
from actr3d.actr import *
class Agent(ACTR):
    goal = Buffer()
    retrieval = Buffer()
    memory = Memory(retrieval, threshold=0.5, finst_size=2)
    fixed = DMFixed(memory)
    def init():
        goal.set('colour:red size:3')
        memory.add('kind:fruit name:apple', fixed=2)
        memory.add('kind:fruit name:pear', fixed=1)
        memory.add('kind:fruit name:plum', fixed=0.25)
    def matching(goal='colour:?c size:3', utility=0.5):
        memory.request('kind:fruit')
        goal.set('again red')
    def wrong_value(goal='colour:blue'):
        pass
    def no_such_slot(goal='colour:?c sizes:3'):
        pass
    def other_value(goal='size:?n colour:!red'):
        pass
    def same(goal='colour:?c size:?c'):
        pass
    def empty_buffer(retrieval='?x'):
        pass
    def not_empty(goal=None):
        pass
    def says_no(goal=lambda chunk, bound: False):
        pass
    def new_one(goal='again ?'):
        memory.request('kind:fruit', require_new=True)
        goal.set('failing')
    def hopeless(goal='failing'):
        memory.request('name:plum')
        goal.set('done')
"""


def test_the_first_failing_condition_is_named_with_what_was_expected_and_found() -> None:
    agent = agent_of(SIMPLE)
    with pytest.warns(UserWarning, match="sizes"):
        agent.run(0)
    why = agent.explain()
    assert why.production("matching").matches
    assert why.production("matching").selected
    assert why.production("matching").bindings == {"c": "red"}
    assert why.production("matching").utility == 0.5
    reasons = {name: (r.condition, r.expected, r.found) for r in why.productions if not r.matches for name in [r.name]}
    assert reasons["wrong_value"] == ("goal: colour:blue", "'blue'", "'red'")
    assert reasons["no_such_slot"] == ("goal: sizes:3", "'3'", "no slot 'sizes'; did you mean 'size'?")
    assert reasons["other_value"] == ("goal: colour:!red", "anything but 'red'", "'red'")
    assert reasons["same"] == ("goal: size:?c", "'red' (?c)", "'3'")
    assert reasons["empty_buffer"] == ("retrieval: 0:?x", "some value for ?x", "retrieval is empty")
    assert reasons["not_empty"] == ("goal: None", "empty", "not empty")
    assert reasons["says_no"][1] == "anything but False"
    text = str(why)
    assert "+ matching: matches  ?c=red  <- selected" in text
    assert "expected 'blue', found 'red'" in text
    with pytest.raises(KeyError, match="did you mean 'matching'"):
        why.production("matchin")


def test_a_comparison_with_an_unbound_variable_names_the_variable() -> None:
    agent = agent_of("""
from actr3d.actr import *
class Agent(ACTR):
    goal = Buffer()
    def stop(goal='number:?n last:!?n'):
        pass
""")
    agent.run(0)
    (why,) = agent.explain().productions
    assert [one.expected for one in why.conditions] == ["some value for ?n", "anything but ?n"]


def test_a_retrieval_is_explained_with_every_candidate_and_why_it_won_or_lost() -> None:
    agent = agent_of(SIMPLE)
    agent.traced()
    with pytest.warns(UserWarning, match="sizes"):
        agent.run(0.051)
    (retrieval,) = agent.explain().retrievals
    assert (retrieval.request, retrieval.asked, retrieval.threshold, retrieval.outcome) == ("kind:fruit", "kind:fruit", 0.5, "pending")
    assert [(c.chunk, c.activation, c.verdict) for c in retrieval.candidates] == [
        ("kind:fruit name:apple", 2, "won"),
        ("kind:fruit name:pear", 1, "lost by 1"),
        ("kind:fruit name:plum", 0.25, "lost by 1.75"),
    ]
    assert retrieval.candidates[1].parts == {"DMFixed": 1}
    agent.run(0.06)
    (retrieval,) = agent.explain().retrievals
    assert retrieval.require_new
    assert retrieval.finsts == ("kind:fruit name:apple",)
    assert retrieval.excluded == ("kind:fruit name:apple",)
    assert retrieval.candidates[0].chunk == "kind:fruit name:pear"
    agent.run(0.3)
    (retrieval,) = agent.explain().retrievals
    assert retrieval.outcome == "failed"
    assert retrieval.candidates[0].verdict == "below the threshold by 0.25"
    assert retrieval.latency == near(0.05 * 2.718281828**-0.5)
    assert [r.outcome for r in agent.explain(0.051).retrievals] == ["pending"]
    assert agent.explain(0.0).retrievals == ()


def test_utility_is_explained_with_its_parts() -> None:
    agent = agent_of(
        """
from actr3d.actr import *
class Agent(ACTR):
    goal = Buffer()
    learn = PMNew(alpha=0.5)
    more = PMPGC(goal=10)
    noise = PMNoise(noise=0.2)
    def init():
        goal.set('a')
    def first(goal='a', utility=1):
        self.reward(4)
        goal.set('b')
    def second(goal='a'):
        goal.set('b')
"""
    )
    agent.traced()
    agent.run(0)
    first = agent.explain().production("first")
    assert list(first.parts) == ["base", "learn", "more", "noise"]
    assert first.parts["base"] == 1
    assert first.parts["more"] == near(10 - 0.05)
    assert first.parts["noise"] is not None
    assert first.utility == sum(value for value in first.parts.values() if value is not None)
    agent.run(1)
    first = agent.explain().production("first")
    assert first.parts["learn"] == near(0.5 * (4 - 0.05))
    assert first.parts["noise"] is None
    assert first.utility is None
    assert agent.explain(0.0).production("first").parts["learn"] == 0


def test_a_production_learned_later_is_not_there_before() -> None:
    agent = agent_of(
        """
from actr3d.actr import *
class Agent(ACTR):
    goal = Buffer()
    retrieval = Buffer()
    memory = Memory(retrieval)
    compiling = PMCompile(keep='goal', request='memory.request', retrieve='retrieval')
    def init():
        memory.add('capital Canada Ottawa')
        goal.set('ask Canada')
    def ask(goal='ask ?country'):
        memory.request('capital ?country ?')
        goal.set('wait ?country')
    def answer(goal='wait ?country', retrieval='capital ?country ?city'):
        goal.set('ask ?country')
"""
    )
    agent.traced()
    agent.run(0.5)
    assert "ask-answer-1" in [reason.name for reason in agent.explain().productions]
    assert "ask-answer-1" not in [reason.name for reason in agent.explain(0.05).productions]


def test_impossible_explanations_are_errors() -> None:
    agent = agent_of(NOISY)
    agent.run(0.1)
    with pytest.raises(ParameterError, match="only a run traced"):
        agent.explain(0.05)
    agent.traced()
    agent.run(0.1)
    with pytest.raises(ParameterError, match=r"lies ahead; it is 0\.2 s now"):
        agent.explain(5)
    with pytest.raises(ParameterError, match=r"the trace begins at 0\.1 s"):
        agent.explain(0.05)
    assert agent.explain(0.15).time == 0.15


def test_a_trace_of_a_lower_level_cannot_explain_the_past() -> None:
    agent = agent_of(NOISY)
    agent.traced("buffer")
    agent.run(0.1)
    with pytest.raises(ParameterError, match="only a run traced"):
        agent.explain(0.05)


def test_neither_tracing_nor_explaining_reads_a_property_or_calls_a_pattern() -> None:
    source = """
from actr3d.actr import *
calls = []
def third(chunk, bound):
    calls.append(1)
    return len(calls) % 3 == 0
class Coin(Model):
    @property
    def side(self):
        return 'head' if self.random.random() < 0.5 else 'tail'
class Agent(ACTR):
    goal, coin = Buffer(), Coin()
    def init(): goal.set('go')
    def head(goal='go', coin='side:head'): self.what = 'head'
    def other(goal=['go', third]): self.what = 'third'
    def plain(goal='go'): self.what = 'plain'
"""
    runs: list[list[tuple[float, Any]]] = []
    for asks, traced in ((False, False), (False, True), (True, True)):
        agent = agent_of(source)
        if traced:
            agent.traced()
        seen: list[tuple[float, Any]] = []
        for _ in range(150):
            agent.run(0.01)
            if asks:
                agent.explain()
                agent.explain(agent.now())
            seen.append((agent.now(), getattr(agent, "what", None)))
        runs.append(seen)
    assert runs[0] == runs[1] == runs[2]
    assert len({what for _, what in runs[0]}) > 2


def test_a_modellers_own_activation_is_explained() -> None:
    agent = agent_of(
        """
from actr3d.actr import *
class Own(Memory):
    def get_activation(self, chunk): return 2.5
class Agent(ACTR):
    goal, retrieval = Buffer(), Buffer()
    memory = Own(retrieval)
    def init():
        memory.add('a b')
        memory.request('a ?')
"""
    )
    agent.run(0)
    (retrieval,) = agent.explain().retrievals
    assert retrieval.candidates[0].parts == {"get_activation": 2.5}
