"""Learned associations and inhibition, against explicit sums."""

from __future__ import annotations

import math
from typing import Any

import pytest

from actr3d.actr import Buffer, Chunk, DMAssociate, DMInhibition, Memory
from actr3d.errors import ChunkError, ParameterError
from tests.helpers.small_agents import near, started_agent


def associating(profile: str = "python-actr", **options: Any) -> Any:
    buffer, focus = Buffer(), Buffer()
    memory = Memory(buffer, latency=0.05, threshold=None)
    return started_agent(profile, buffer=buffer, focus=focus, memory=memory, links=DMAssociate(memory, focus, **options))


def test_a_given_association() -> None:
    agent = associating(weight=2)
    agent.memory.add("b")
    agent.links.set_association("a", "b", 0.7)
    assert agent.memory.get_activation("b") == 0
    agent.focus.set("a x a2:a")
    assert agent.memory.get_activation("b") == near(2 * 2 * 0.7)
    agent.links.set_association("a", "b", -0.1)
    assert agent.memory.get_activation("b") == near(2 * 2 * -0.1)


def test_retrievals_strengthen_links_which_do_not_decay_in_python_act_r() -> None:
    agent = associating()
    agent.memory.add("b")
    agent.focus.set("a c")
    for n in range(1, 4):
        agent.memory.request("b")
        agent.run(10)
        assert agent.memory.get_activation("b") == near(2 * math.log(n * 0.005**-0.5))


@pytest.mark.parametrize("limit", [0, 1, 2])
def test_a_limit_gives_a_finite_number(limit: int) -> None:
    agent = associating(limit=limit)
    agent.memory.add("b")
    agent.focus.set("a")
    for _ in range(4):
        agent.memory.request("b")
        agent.run(10)
        assert math.isfinite(agent.memory.get_activation("b"))


def test_links_decay_with_time_in_the_act_r_7_profile() -> None:
    agent = associating("act-r-7")
    agent.memory.add("b")
    agent.focus.set("a")
    agent.memory.request("b")
    agent.run(1)
    made = 0.05  # exp(0) * 0.05 s
    assert agent.memory.get_activation("b") == near(math.log(2) - 0.5 * math.log(1 - made))
    agent.memory.request("b")
    agent.run(9)
    assert agent.memory.get_activation("b") == near(math.log(4) - 0.5 * math.log(10 - made))


def test_links_of_values_that_cannot_be_hashed() -> None:
    agent = associating()
    agent.memory.add({"v": [1]})
    agent.focus.set({"w": {"k": 2}})
    agent.memory.request("v:?")
    agent.run(10)
    assert agent.memory.get_activation({"v": [1]}) == near(-0.5 * math.log(0.005))


def test_inhibition() -> None:
    memory = Memory(Buffer())
    agent = started_agent(memory=memory, inhibition=DMInhibition(memory, decayScale=0.8, timeScale=4))
    agent.memory.add("a")
    agent.run(3)
    agent.memory.add("a")
    assert agent.memory.get_activation("a") == near(-math.log(1 + 0.005**-0.8 / 4))
    agent.run(2)
    assert agent.memory.get_activation("a") == near(-math.log(1 + 2**-0.8 / 4))
    agent.memory.dm.append(Chunk("b"))
    with pytest.raises(ChunkError, match="DMInhibition has no data about chunk 'b'"):
        agent.memory.get_activation("b")


def test_the_strength_of_a_link_is_a_number() -> None:
    with pytest.raises(ParameterError, match=r"DMAssociate\.set_association\('a', 'b'\): must be a number \(got '0\.7'\)"):
        associating().links.set_association("a", "b", "0.7")
