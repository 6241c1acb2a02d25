"""Buffers: setting, changing, emptying, comparing, and errors."""

from __future__ import annotations

from typing import Any

import pytest

from actr3d.actr import ACTR, Buffer, Chunk, Model
from actr3d.errors import ChunkError


def goal_of(contents: object = None) -> Any:
    agent: Any = Model()
    agent.goal = Buffer()
    if contents is not None:
        agent.goal.set(contents)
    return agent.goal


def test_set_and_read() -> None:
    goal = goal_of("hello color:red")
    assert goal[0] == "hello"
    assert goal["color"] == "red"
    assert len(goal) == 2
    assert not goal.isEmpty()
    assert goal.chunk == {0: "hello", "color": "red"}
    assert goal == Chunk("hello color:red")
    assert goal == goal_of("hello color:red")
    assert goal != Chunk("hello")


def test_a_buffer_as_contents_is_its_chunk() -> None:
    goal, other = goal_of("hello color:red"), goal_of("old")
    other.set(goal)
    goal.modify(color="blue")
    assert other.chunk == {0: "hello", "color": "red"}


def test_an_empty_buffer() -> None:
    goal = goal_of()
    assert goal.isEmpty()
    assert len(goal) == 0
    assert goal.chunk is None
    goal.clear()
    equal_to_none: Any = goal.__eq__(None)
    assert equal_to_none is True
    with pytest.raises(TypeError, match="buffer 'goal' is empty: it has no slot 'color'"):
        goal["color"]
    with pytest.raises(ChunkError, match="buffer 'goal' is empty: there is no slot 'color' to modify; use set"):
        goal.modify(color="red")


def test_modify() -> None:
    goal = goal_of("hello world color:red")
    goal.modify(color=3, _1="there")
    assert goal.chunk == {0: "hello", 1: "there", "color": 3}


def test_a_misspelt_slot_is_named() -> None:
    message = r"buffer 'goal': no slot 'colour' to modify to 'red'; did you mean 'color'\? The chunk is 'hello color:blue'"
    with pytest.raises(ChunkError, match=message):
        goal_of("hello color:blue").modify(colour="red")
    with pytest.raises(ChunkError, match="no slot '1' to modify"):
        goal_of("hello").modify(_1="x")


def test_a_slot_name_may_begin_with_an_underscore() -> None:
    goal = goal_of({"_a": 1, "_1": 2})
    goal.modify(_a=5)
    assert goal["_a"] == 5


def test_an_unknown_key_is_a_key_error() -> None:
    with pytest.raises(KeyError, match="x"):
        goal_of("a")["x"]


def test_a_buffer_keeps_its_own_copy() -> None:
    chunk = Chunk("a:1")
    goal = goal_of(chunk)
    chunk["a"] = "2"
    assert goal["a"] == "1"


def test_set_to_a_buffer_a_model_and_a_dict() -> None:
    assert goal_of(goal_of("a b")).chunk == {0: "a", 1: "b"}
    assert goal_of({"n": 1}).chunk == {"n": 1}
    environment: Any = Model()
    environment.ball = Model(color="red", x=1.5, _secret=2, parts=[1])
    assert goal_of(environment.ball).chunk["color"] == "red"
    assert "parts" not in goal_of(environment.ball).chunk


def test_a_buffer_without_an_agent_can_be_used() -> None:
    buffer = Buffer()
    buffer.set("a")
    buffer.modify(_0="b")
    assert buffer.chunk == {0: "b"}


def test_buffers_can_be_keys() -> None:
    first, second = goal_of("a"), goal_of("a")
    assert first == second
    assert len({first: 1, second: 2}) == 2


def test_a_buffer_of_a_subclass_is_matched_by_what_it_gives() -> None:
    class Loud(Buffer):
        def __getitem__(self, key: Any) -> Any:
            return str(super().__getitem__(key)).upper()

    class Agent(ACTR):
        goal = Loud()

        def act(goal="A"):  # pyright: ignore
            goal.clear()  # pyright: ignore

    agent: Any = Agent()
    agent.run(0)
    agent.goal.set("a")
    agent.run(0.1)
    assert agent.goal.isEmpty()
