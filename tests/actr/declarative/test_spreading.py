"""Spreading activation and salience, against published numbers and closed formulas."""

from __future__ import annotations

import copy
import math
from typing import Any

import pytest

from actr3d.actr import Buffer, Chunk, DMFixed, DMInhibition, DMSalience, DMSpreading, Memory
from actr3d.errors import ChunkError, ModelWarning
from tests.helpers.small_agents import near, started_agent


def test_salience_counts_bits() -> None:
    memory = Memory(Buffer())
    agent = started_agent(memory=memory, salience=DMSalience(memory))
    for text in ["colour:red x:1", "colour:red x:2", "colour:red x:3", "colour:green x:4"]:
        agent.memory.add(text)
    agent.salience.weights(colour=2, size=1)
    agent.salience.context("colour:?")
    assert agent.memory.get_activation("colour:green x:4") == near(2 * 2.0)
    assert agent.memory.get_activation("colour:red x:1") == near(2 * math.log2(4 / 3))
    agent.memory.add("colour:blue")
    with pytest.raises(ChunkError, match="no chunk of the context has 'blue' in slot 'colour'"):
        agent.memory.get_activation("colour:blue")
    with pytest.raises(ChunkError, match="no chunk matches 'colour:pink'"):
        agent.salience.context("colour:pink")


FACTS = """hippie park, hippie church, hippie bank, captain park, captain cave, debutante bank, fireman park, giant beach,
giant castle, giant dungeon, earl castle, earl forest, lawyer store"""
FAN = [tuple(fact.split()) for fact in FACTS.split(",")]


def fan_agent() -> Any:
    memory, goal = Memory(Buffer()), Buffer()
    spreading = DMSpreading(memory, goal)
    spreading.strength = 1.6
    agent = started_agent("act-r-7", memory=memory, goal=goal, spreading=spreading)
    for person, place in FAN:
        agent.memory.add(f"relation:in arg1:{person} arg2:{place}")
    return agent


def test_published_fan_model() -> None:
    agent = fan_agent()
    agent.goal.set("arg1:lawyer arg2:store")
    assert agent.memory.get_activation("relation:in arg1:lawyer arg2:store") == near(0.90685, abs=5e-6)
    agent.goal.set("arg1:hippie arg2:bank")
    assert agent.memory.get_activation("relation:in arg1:hippie arg2:bank") == near(0.35755, abs=5e-6)
    assert agent.memory.get_activation("relation:in arg1:hippie arg2:park") == near(0.10685, abs=5e-6)
    agent.memory.add("relation:in arg1:teller arg2:bank")
    assert agent.memory.get_activation("relation:in arg1:hippie arg2:bank") == near(0.5 * (1.6 - math.log(4)) + 0.5 * (1.6 - math.log(4)))


def test_a_value_in_two_slots_has_half_the_fan() -> None:
    agent = fan_agent()
    agent.memory.add("a:twin b:twin")
    agent.goal.set("who:twin")
    assert agent.memory.get_activation("a:twin b:twin") == near(1.6 - math.log(3 / 2))


def test_only_values_that_can_name_a_chunk_share_the_weight() -> None:
    agent = fan_agent()
    agent.goal.set({"a": "lawyer", "n": 3, "m": "4.5", "nothing": None, "yes": True, "no": "False"})
    assert agent.memory.get_activation("relation:in arg1:lawyer arg2:store") == near(1.6 - math.log(2))
    agent.goal.chunk = Chunk({"a": "lawyer", "b": "nan"})  # `set` would add the former contents to memory
    assert agent.memory.get_activation("relation:in arg1:lawyer arg2:store") == near(0.5 * (1.6 - math.log(2)))
    agent.goal.set({"n": 3})
    assert agent.memory.get_activation("relation:in arg1:lawyer arg2:store") == 0


def test_a_negative_strength_of_association_counts_nothing_and_warns_in_the_models_file() -> None:
    agent = fan_agent()
    agent.spreading.strength = 1.0
    agent.goal.set("a:in")
    with pytest.warns(ModelWarning, match="the fan of 'in' is large enough to inhibit") as caught:
        assert agent.memory.get_activation("relation:in arg1:lawyer arg2:store") == 0
    assert [warning.filename for warning in caught] == [__file__]
    assert agent.memory.get_activation("relation:in arg1:lawyer arg2:store") == 0  # warns once


def test_spreading_of_python_act_r_is_not_clipped() -> None:
    memory, goal, imaginal = Memory(Buffer()), Buffer(), Buffer()
    spreading = DMSpreading(memory, goal, imaginal)
    spreading.weight[imaginal] = 0.5
    agent = started_agent(memory=memory, goal=goal, imaginal=imaginal, spreading=spreading)
    for n in range(9):
        agent.memory.add(f"in x{n}")
    agent.goal.set("in x1 in")
    agent.imaginal.set("x1")
    expected = (1 - math.log(10)) * 2 + (1 - math.log(2)) + 0.5 * (1 - math.log(2))
    assert agent.memory.get_activation("in x1") == near(expected)


def test_spreading_takes_any_value_and_knows_what_came_before_it() -> None:
    memory, goal = Memory(Buffer()), Buffer()
    memory.add({"list": [1, 2]})
    agent = started_agent(memory=memory, goal=goal, spreading=DMSpreading(memory, goal))
    agent.memory.add({"list": [1, 2], "b": "x"})
    agent.goal.set({"list": [1, 2]})
    assert agent.memory.get_activation({"list": [1, 2]}) == near(1 - math.log(3))


@pytest.mark.parametrize("copied", [False, True])
def test_a_module_made_late_counts_a_chunk_created_again_once(copied: bool) -> None:
    memory, goal = Memory(Buffer()), Buffer()
    early = DMSpreading(memory, goal)
    for text in ("a b", "a c", "d a"):
        memory.add(text)
    late = DMSpreading(memory, goal)
    if copied:
        memory, early, late = copy.deepcopy((memory, early, late))
    for chunk in memory.dm:
        late.create(chunk)  # as python_actr needs it
        late.create(chunk)
        early.create(chunk)
    assert late.slots == early.slots == {"a": 3, "b": 1, "c": 1, "d": 1}
    memory.add("e a")
    assert late.slots == early.slots == {"a": 4, "b": 1, "c": 1, "d": 1, "e": 1}


def test_equal_chunks_that_are_created_by_hand_count_each() -> None:
    memory = Memory(Buffer())
    spreading = DMSpreading(memory)
    for _ in range(2):
        spreading.create(Chunk("a b"))
    assert spreading.slots == {"a": 2, "b": 2}


@pytest.mark.parametrize("kind", [DMFixed, DMInhibition])
def test_other_memory_modules_accept_the_same_chunk_twice_too(kind: Any) -> None:
    memory = Memory(Buffer())
    agent = started_agent(memory=memory, module=kind(memory))
    agent.memory.add("a")
    agent.run(1)
    (module,) = agent.memory.adaptors
    before = module.activation(agent.memory.dm[0])
    module.create(agent.memory.dm[0])
    assert module.activation(agent.memory.dm[0]) == before


def test_chunks_that_have_left_the_memory_or_changed_do_not_count_in_act_r_7() -> None:
    memory, goal = Memory(Buffer()), Buffer()
    spreading = DMSpreading(memory, goal)
    spreading.strength = 2
    agent = started_agent("act-r-7", memory=memory, goal=goal, spreading=spreading)
    agent.goal.set("x")
    chunks: Any = agent.memory.dm

    def strength(fan: int) -> Any:
        return near(2 - math.log(1 + fan))

    agent.memory.add("x y")
    assert agent.memory.get_activation("x y") == strength(1)
    agent.memory.clear()
    agent.memory.add("x y")
    assert agent.memory.get_activation("x y") == strength(1)
    agent.memory.add("x z")
    assert agent.memory.get_activation("x y") == strength(2)
    chunks[1][0] = "w"
    assert agent.memory.get_activation("x y") == strength(1)
    chunks.append(Chunk("x z"))
    assert agent.memory.get_activation("x y") == strength(2)
    chunks[2][0] = "w"
    assert agent.memory.get_activation("x y") == strength(1)


def test_inhibition_counts_from_the_latest_use_in_act_r_7() -> None:
    memory = Memory(Buffer())
    agent = started_agent("act-r-7", memory=memory, inhibition=DMInhibition(memory))
    agent.run(10)
    agent.memory.add("a", time=3)
    agent.memory.add("b", time=20)
    agent.memory.add("b", time=5)
    agent.memory.add("b", time=9)
    for text, age in (("a", 3), ("b", 5)):
        assert agent.memory.get_activation(text) == near(-math.log(1 + 1 / age / 5))
