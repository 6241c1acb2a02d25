"""Each row of the table of deviations, at the level of the agent and of the memory, wherever the parts are."""

from __future__ import annotations

import math
from typing import Any

import pytest

from actr3d.actr import ACTR, BlendingMemory, Buffer, Chunk, DMBaseLevel, DMNoise, Memory, Model, Partial, ProductionSystem
from actr3d.actr.kernel.profile import ACT_R_7
from actr3d.actr.loading import load_text
from actr3d.errors import ModelWarning, ParameterError
from tests.helpers.small_agents import near, started_agent

LEVELS = ["agent", "memory", "instance"]


def agent_of(level: str, kind: Any = Memory, memory: dict[str, Any] | None = None, **parts: Any) -> Any:
    """Returns an agent under ACT-R 7's numbers, chosen on its class, its memory, or the instance."""
    buffer = Buffer()
    own = kind(buffer, profile="act-r-7" if level == "memory" else None, **(memory or {}))
    made: dict[str, Any] = {name: part(own) for name, part in parts.items()}
    made |= {"buffer": buffer, "goal": Buffer(), "memory": own}
    if level == "agent":
        made["profile"] = "act-r-7"
    cls: Any = type("Agent", (ACTR,), made)
    agent = cls(profile="act-r-7") if level == "instance" else cls()
    agent.run(0)
    return agent


def exact_base_level(memory: Memory) -> DMBaseLevel:
    return DMBaseLevel(memory, limit=None)


def quarter_noise(memory: Memory) -> DMNoise:
    return DMNoise(memory, noise=0.25)


def double_partial(memory: Memory) -> Partial:
    return Partial(memory, strength=2, limit=-1)


@pytest.mark.parametrize("level", LEVELS)
def test_base_level(level: str) -> None:
    agent = agent_of(level, base=DMBaseLevel)
    agent.memory.add("a")
    assert agent.memory.get_activation("a") == near(math.log(2) - 0.5 * math.log(0.05))
    agent.base.limit = None
    assert agent.memory.get_activation("a") == near(-0.5 * math.log(0.05))


@pytest.mark.parametrize("level", LEVELS)
def test_a_chunk_added_in_a_class_body(level: str) -> None:
    buffer = Buffer()
    memory = Memory(buffer, profile="act-r-7" if level == "memory" else None)
    base = DMBaseLevel(memory)
    memory.add("a")
    memory.add("a", time=3)
    parts: dict[str, Any] = {"buffer": buffer, "memory": memory, "base": base}
    cls: Any = type("Agent", (ACTR,), parts | ({"profile": "act-r-7"} if level == "agent" else {}))
    agent = cls(profile="act-r-7") if level == "instance" else cls()
    agent.run(1)
    assert agent.memory.get_activation("a") == near(math.log(2 / 0.5) - 0.5 * math.log(4))  # the oldest use is 4 s ago


@pytest.mark.parametrize("level", LEVELS)
def test_latency_and_whole_milliseconds(level: str) -> None:
    agent = agent_of(level)
    agent.memory.add("a")
    agent.memory.threshold = 0.2
    agent.memory.request("b")
    agent.run(0.8185)
    assert agent.memory.busy
    agent.run(0.0010)  # exp(-0.2) = 0.81873 s, that is 819 ms
    assert agent.memory.error
    assert agent.memory.latency == 1.0
    assert agent_of(level, memory={"latency": 0.05}).memory.latency == 0.05


@pytest.mark.parametrize("level", LEVELS)
def test_a_negative_test_costs(level: str) -> None:
    agent = agent_of(level, partial=double_partial)
    agent.memory.threshold = -10
    agent.memory.add("a:red b:1")
    agent.memory.request("a:!red b:1")
    assert [(activation, partial) for _, _, partial, activation in agent.memory._last.rows] == [(-2, -2)]
    agent.memory.request("a:!blue b:2")
    assert [partial for _, _, partial, _ in agent.memory._last.rows] == [-2]


@pytest.mark.parametrize("level", LEVELS)
def test_blending(level: str) -> None:
    agent = agent_of(level, BlendingMemory, noise=quarter_noise)
    assert agent.memory._temperature() == near(0.353553, abs=1e-6)
    agent.memory.threshold = None
    agent.memory.add("v:1")
    agent.memory.request("v:?")
    score = agent.memory._last.rows[0][3]
    assert agent.memory._last.latency == near(math.exp(-score), abs=5e-4)


@pytest.mark.parametrize("level", LEVELS)
def test_the_buffer_is_cleared_at_the_request_and_harvested(level: str) -> None:
    agent = agent_of(level, base=exact_base_level)
    agent.memory.add("known")
    agent.buffer.set("seen")
    agent.memory.request("known")
    assert agent.buffer.chunk is None
    assert list(agent.memory.dm) == [Chunk("known"), Chunk("seen")]
    agent.run(2)
    agent.buffer.clear()  # the retrieved chunk goes back: a second reference
    assert [len(chunk.times) for chunk in agent.memory.dm] == [2, 1]
    agent.goal.set("g:1")
    agent.goal.modify(g=2)
    agent.goal.set("g:3")
    assert agent.memory.dm[2:] == [Chunk({"g": 2})]
    agent.goal.set({})
    agent.goal.clear()
    agent.goal.clear()
    assert agent.memory.dm[2:] == [Chunk({"g": 2}), Chunk("g:3")]


def test_python_act_r_does_none_of_this() -> None:
    agent = agent_of("none", base=DMBaseLevel)
    agent.memory.add("known")
    agent.buffer.set("seen")
    agent.goal.set("g:1")
    agent.goal.clear()
    agent.memory.request("known")
    assert agent.buffer.chunk == Chunk("seen")
    assert len(agent.memory.dm) == 1
    assert agent.memory.latency == 0.05


@pytest.mark.parametrize("level", LEVELS)
def test_harvesting_does_not_clear_a_failed_request(level: str) -> None:
    agent = agent_of(level)
    agent.memory.request("a")
    agent.buffer.set("b")
    agent.run(2)
    assert agent.memory.error
    assert list(agent.memory.dm) == [Chunk("b")]
    agent.goal.set("c")
    agent.goal.clear()
    assert agent.memory.error
    agent.memory.add("d")
    assert not agent.memory.error


def test_the_profile_reaches_every_part_however_it_was_added() -> None:
    class Inner(Model):
        buffer = Buffer()
        memory = Memory(buffer)

    class Parallel(ProductionSystem):
        production_time = 0.0204
        own = Buffer()
        store = Memory(own)

    class Derived(Memory):
        def start(self) -> None:
            self.started = True

    class Given(Memory):
        def __init__(self, buffer: Any) -> None:
            Memory.__init__(self, buffer)
            self.latency = 0.3

    class Agent(ACTR):
        profile = "act-r-7"
        inner = Inner()
        parallel = Parallel()
        buffer = Buffer()
        derived = Derived(buffer)
        given = Given(buffer)

    class World(Model):
        agent = Agent()

    world: Any = World()
    world.run(0.1)
    agent = world.agent
    agent.later = Memory(agent.buffer)
    alone = Memory(Buffer())
    alone.add("a")
    assert alone.now() == 0  # it has been started by itself
    world.late = Agent()
    agents = [agent, world.late]
    for one in agents:
        memories = [one.inner.memory, one.parallel.store, one.derived]
        assert [(m.effective_profile.name, m.latency) for m in memories] == [("act-r-7", 1.0)] * 3
        assert (one.given.effective_profile.name, one.given.latency) == ("act-r-7", 0.3)
    assert agent.later.latency == 1.0
    assert world._profile is None


def test_a_memory_that_ran_alone_takes_over_the_profile_of_its_agent() -> None:
    buffer = Buffer()
    memory: Any = Memory(buffer)
    assert memory.now() == 0
    agent = started_agent("act-r-7", buffer=buffer, goal=Buffer())
    agent.memory = memory
    assert memory.latency == 1.0
    agent.goal.set("a")
    agent.goal.clear()
    assert list(memory.dm) == [Chunk("a")]


def test_two_memories_of_one_agent_each_use_their_own_profile() -> None:
    first, second = Buffer(), Buffer()
    one, other = Memory(first, profile="act-r-7"), Memory(second)
    agent = started_agent(first=first, second=second, goal=Buffer(), one=one, other=other, b1=DMBaseLevel(one), b2=DMBaseLevel(other))
    for memory in (agent.one, agent.other):
        memory.add("a")
    assert agent.one.get_activation("a") == near(math.log(2) - 0.5 * math.log(0.05))
    assert agent.other.get_activation("a") == near(-0.5 * math.log(0.005))
    assert (agent.one.latency, agent.other.latency) == (1.0, 0.05)
    agent.goal.set("b")
    agent.goal.clear()
    assert (len(agent.one.dm), len(agent.other.dm)) == (2, 1)
    plain = started_agent("act-r-7", first=Buffer(), goal=Buffer(), one=Memory(Buffer()), other=Memory(Buffer(), profile="python-actr"))
    plain.goal.set("b")
    plain.goal.clear()
    assert (len(plain.one.dm), len(plain.other.dm)) == (1, 0)
    assert plain.other.latency == 0.05


def test_a_retrieved_chunk_goes_back_to_its_own_memory() -> None:
    first, second = Buffer(), Buffer()
    agent = started_agent("act-r-7", first=first, second=second, one=Memory(first), other=Memory(second))
    agent.first.set("a")
    agent.first.clear()
    assert (len(agent.one.dm), len(agent.other.dm)) == (1, 0)


def test_buffers_of_parallel_systems_are_harvested_into_the_agents_memory() -> None:
    class Parallel(ProductionSystem):
        own = Buffer()

    agent = started_agent("act-r-7", parallel=Parallel(), buffer=Buffer(), memory=Memory(Buffer()))
    agent.parallel.own.set("a")
    agent.parallel.own.clear()
    assert list(agent.memory.dm) == [Chunk("a")]


def test_an_unknown_profile() -> None:
    with pytest.raises(ParameterError, match=r"Memory.profile: no profile 'actr-7'; use .*did you mean 'act-r-7'\?"):
        Memory(Buffer(), profile="actr-7")
    with pytest.raises(ParameterError, match=r"Agent.profile: no profile 'lisp'"):
        started_agent("lisp")
    assert Memory(Buffer(), profile=ACT_R_7).latency == 1.0


def test_an_environment_chooses_for_all_its_agents() -> None:
    module: Any = load_text(
        "from actr3d.actr import *\n"
        "class Agent(ACTR):\n    retrieval = Buffer()\n    memory = Memory(retrieval)\n"
        "class World(Model):\n    profile = 'act-r-7'\n    agent = Agent()\n"
        "class Other(Model):\n    agent = Agent()\n"
    )
    for world in (module.World(), module.Other(profile="act-r-7")):
        world.run(0)
        assert world.agent.memory.latency == 1.0
        assert world.sch.round_ms
    plain = module.Other()
    plain.run(0)
    assert plain.agent.memory.latency == 0.05


def test_a_misspelt_profile_of_an_environment_is_reported() -> None:
    with pytest.warns(ModelWarning, match=r"World\.profile: no profile 'act-r7'; did you mean 'act-r-7'"):
        type("World", (Model,), {"profile": "act-r7"})().run(0)
    type("Person", (Model,), {"profile": "tall"})().run(0)
