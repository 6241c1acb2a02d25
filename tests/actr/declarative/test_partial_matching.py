"""Partial matching, against published numbers and explicit sums."""

from __future__ import annotations

from typing import Any

import pytest

from actr3d.actr import Buffer, Chunk, DMFixed, Memory, Partial
from actr3d.errors import ModelWarning, ParameterError
from tests.helpers.small_agents import started_agent


def partial_agent(profile: str = "python-actr", kind: Any = Partial, **options: Any) -> Any:
    buffer = Buffer()
    memory = Memory(buffer, threshold=-50)
    partial = kind(memory, **options)
    partial.similarity("red", "pink", -0.3)
    partial.similarity("blue", "red", -0.8)
    return started_agent(profile, buffer=buffer, memory=memory, partial=partial, fixed=DMFixed(memory))


def costs(agent: Any, pattern: str) -> dict[str, tuple[float, float]]:
    agent.memory.request(pattern)
    return {str(chunk): (partial, activation) for chunk, _, partial, activation in agent.memory._last.rows}


@pytest.mark.parametrize("profile", ["python-actr", "act-r-7"])
def test_published_activations(profile: str) -> None:
    agent = partial_agent(profile, strength=2)
    agent.memory.add("colour:pink")
    agent.memory.add("colour:blue", fixed=0.5)
    agent.memory.add("colour:green")
    assert costs(agent, "colour:red") == {"colour:pink": (-0.6, -0.6), "colour:blue": (-1.6, -1.1), "colour:green": (-2, -2)}
    agent.run(100)
    assert agent.buffer.chunk == Chunk("colour:pink")


def test_mismatches_add_up_and_a_missing_slot_rules_out() -> None:
    agent = partial_agent(strength=1, limit=-5)
    for text in ("a:red b:red", "a:pink b:blue", "a:green b:red", "a:red"):
        agent.memory.add(text)
    assert {chunk: partial for chunk, (partial, _) in costs(agent, "a:red b:red").items()} == {
        "a:red b:red": 0,
        "a:pink b:blue": pytest.approx(-1.1),  # pyright: ignore[reportUnknownMemberType]
        "a:green b:red": -5,
    }


def test_negative_tests() -> None:
    for profile, expected in [("python-actr", {"a:pink": (0, 0)}), ("act-r-7", {"a:pink": (0, 0), "a:red": (-2, -2)})]:
        agent = partial_agent(profile, strength=2)
        agent.memory.add("a:pink")
        agent.memory.add("a:red")
        assert costs(agent, "a:!red") == expected
    agent = partial_agent("act-r-7", strength=2)
    agent.memory.add("a:x b:x")
    assert costs(agent, "a:?v b:!?v") == {"a:x b:x": (-2, -2)}
    assert costs(agent, "a:!x!x b:y") == {"a:x b:x": (-6, -6)}


def test_two_uses_of_one_variable() -> None:
    agent = partial_agent(strength=2)
    agent.memory.add("a:red b:pink")
    agent.memory.add("a:red b:red")
    assert costs(agent, "a:?x b:?x") == {"a:red b:pink": (-0.6, -0.6), "a:red b:red": (0, 0)}


def test_which_partial_serves_a_request() -> None:
    buffer = Buffer()
    memory = Memory(buffer, threshold=None)
    first, second = Partial(memory, strength=1), Partial(memory, strength=3)
    agent = started_agent(buffer=buffer, memory=memory, first=first, second=second)
    agent.memory.add("a:x")
    assert costs(agent, "a:y") == {"a:x": (-1, -1)}
    agent.second.request("a:y")
    assert [partial for _, _, partial, _ in agent.memory._last.rows] == [-3]
    agent.memory.request("a:y", partial=agent.second)
    assert [partial for _, _, partial, _ in agent.memory._last.rows] == [-3]
    assert agent.memory.find_matching_chunks("a:y") == []


def test_a_modellers_own_similarity() -> None:
    class Distance(Partial):
        def match(self, key: Any, a: str, b: str) -> float:
            return -abs(float(a) - float(b))

    agent = partial_agent(kind=Distance)
    for n in (1, 4, 9):
        agent.memory.add({"n": n})
    assert {chunk: cost for chunk, (cost, _) in costs(agent, "n:5").items()} == {"n:1": -4, "n:4": -1, "n:9": -4}


def test_a_modellers_table_that_does_not_know_a_pair_rules_the_chunk_out() -> None:
    class Table(Partial):
        def match(self, key: Any, a: str, b: str) -> float:
            return {("x", "y"): -0.5}[a, b]

    class Silent(Partial):
        def match(self, key: Any, a: str, b: str) -> Any:
            return None

    for kind, expected in [(Table, {"n:x": (0, 0), "n:y": (-0.5, -0.5)}), (Silent, {"n:x": (0, 0)})]:
        agent = partial_agent(kind=kind)
        for word in "xyz":
            agent.memory.add(f"n:{word}")
        assert costs(agent, "n:x") == expected


def test_an_object_that_only_knows_how_to_match() -> None:
    class Plain:
        def match(self, key: Any, a: str, b: str) -> float:
            return -1.0

    agent = started_agent(memory=Memory(Buffer()))
    agent.memory.add("n:x")
    agent.memory.partials.append(Plain())
    assert costs(agent, "n:y") == {"n:x": (-1, -1)}
    assert costs(agent, "n:!x") == {}


def test_similarities_of_numbers() -> None:
    agent = partial_agent("act-r-7")
    agent.partial.similarity(1, 2.5, -0.25)
    agent.memory.add({"n": 2.5})
    assert costs(agent, "n:1") == {"n:2.5": (-0.25, -0.25)}
    agent = partial_agent()
    agent.partial.similarity(1, 2.5, -0.25)
    agent.memory.add({"n": 2.5})
    with pytest.warns(ModelWarning, match=r"the similarity of 1 and 2\.5 is not found, .* write '1', '2\.5'") as caught:
        assert costs(agent, "n:1") == {"n:2.5": (-1, -1)}  # as python_actr has it
    assert [warning.filename for warning in caught] == [__file__]


@pytest.mark.parametrize("value", ["-0.5", None, [0.5]])
def test_a_similarity_is_a_number(value: Any) -> None:
    with pytest.raises(ParameterError, match=r"Partial\.similarity\('red', 'rose'\): must be a number \(got "):
        partial_agent().partial.similarity("red", "rose", value)
