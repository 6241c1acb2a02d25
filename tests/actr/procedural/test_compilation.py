"""Production compilation: the learned productions, and their utilities in both profiles."""

from __future__ import annotations

from typing import Any

import pytest

import actr3d.actr as library
from actr3d.actr.kernel.model import is_converted
from actr3d.actr.loading import load_text
from tests.helpers.python_actr_reference import model_file
from tests.helpers.small_agents import near


def compiling(profile: str, until: float) -> Any:
    agent = model_file("recalling").make(library, library.Buffer(), profile)()
    agent.run(until)
    return agent


def test_pairs_of_productions_that_are_compiled() -> None:
    agent = compiling("python-actr", 0.4)
    assert [p.name for p in agent._productions] == ["answer", "ask", "stop", "ask-answer-1", "ask-answer-2"]
    first = agent._productions[3]
    assert first.pattern_specs == {"goal": "ask one"}
    assert first.pre.name == "ask"
    assert first.post.name == "answer"


def test_a_compiled_rule_does_both_in_one_step_without_memory() -> None:
    agent = compiling("python-actr", 30)
    assert agent.goal.chunk is None
    agent._productions[3].base_utility = 100
    requests = agent.memory._request_count
    agent.goal.set("ask one")
    agent.run(0.05)
    assert agent.goal.chunk == library.Chunk("ask two")
    assert agent.memory._request_count == requests


def test_in_python_act_r_its_utility_stays_0_until_a_reward() -> None:
    agent = compiling("python-actr", 2.0)
    assert len(agent.compiling.compiled) == 2
    assert [agent.get_activation(p) for p in agent.compiling.compiled.values()] == [0, 0]


@pytest.mark.parametrize("times", [1, 2, 3, 4])
def test_act_r_7_moves_it_to_its_first_parents_each_time_it_is_made_again(times: int) -> None:
    agent = model_file("recalling").make(library, library.Buffer(), "act-r-7")()
    expected = 0.0
    made = 0
    while made < times:
        before = len(agent.compiling.compiled) if is_converted(agent) else 0
        agent.run(0.001)
        rule: Any = next(iter(agent.compiling.compiled.values()), None)
        if rule is None:
            continue
        if before == 0:
            made = 1
            assert agent.get_activation(rule) == 0
        elif agent.get_activation(rule) != near(expected):
            made += 1
            expected += 0.2 * (agent.get_activation("ask") - expected)
        assert agent.get_activation(rule) == near(expected)
    assert made == times


def test_a_profile_without_learning_modules() -> None:
    class NoLearning(library.ACTR):
        profile = "act-r-7"
        goal, retrieval = library.Buffer(), library.Buffer()
        memory = library.Memory(retrieval)
        compiling = library.PMCompile(keep="goal", request="memory.request", retrieve="retrieval")

    agent: Any = NoLearning()
    agent.run(0.1)
    assert agent.compiling.compiled == {}


def test_compiled_rules_match_what_only_the_second_production_matches_and_their_first_may_only_request() -> None:
    agent: Any = load_text(
        """
from actr3d.actr import *
class Agent(ACTR):
    goal, context, retrieval = Buffer(), Buffer(), Buffer()
    memory = Memory(retrieval)
    compiling = PMCompile(keep=['goal', 'context'], request='memory.request', retrieve='retrieval')
    def init():
        memory.add('n 0 1')
        goal.set('ask 0')
        context.set('k:1')
    def ask(goal='ask ?n'):
        memory.request('n ?n ?')
    def use(goal='ask ?n', retrieval='n ?n ?m', context='k:?k', utility=1):
        goal.set('done ?m')
""",
        "asking.py",
    ).Agent()
    agent.run(0.3)
    (made,) = agent.compiling.compiled.values()
    assert made.pattern_specs == {"goal": "ask 0", "context": "k:1"}
    made.base_utility = 2
    agent.goal.set("ask 0")
    agent.run(0.05)
    assert agent.goal.chunk == library.Chunk("done 1")


@pytest.mark.parametrize("value", ["ice cream", 1000000.0, "!a", "a:b"])
def test_any_value_may_be_compiled(value: object) -> None:
    agent: Any = load_text(
        """
from actr3d.actr import *
class Agent(ACTR):
    goal, retrieval = Buffer(), Buffer()
    memory = Memory(retrieval)
    compiling = PMCompile(keep=['goal'], request='memory.request', retrieve='retrieval')
    def init(): memory.add('n 0')
    def ask(goal='step:ask what:?what'):
        memory.request('n ?')
        goal.modify(step='use')
    def use(goal='step:use what:?what', retrieval='n ?n'):
        goal.modify(step='done')
""",
        "asking.py",
    ).Agent()
    agent.run(0)
    agent.goal.set({"step": "ask", "what": value})
    agent.run(0.5)
    (made,) = agent.compiling.compiled.values()
    made.base_utility = 2
    for what in (value, "other"):
        agent.run(1)
        agent.goal.set({"step": "ask", "what": what})
        agent.run(0.06)
        assert agent.goal.chunk["step"] == ("done" if what is value else "use")
