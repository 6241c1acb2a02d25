"""Chunks: text, mappings and objects as contents, and how chunks are shown."""

from __future__ import annotations

import copy
import math
import operator
import pickle
from collections.abc import Callable
from decimal import Decimal
from typing import Any

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from actr3d.actr import Buffer, Chunk, Memory, Model
from actr3d.actr.chunks.chunk import as_number, as_text
from actr3d.errors import ChunkError

WORDS = st.text("abcxyz0123456789_-.!", min_size=1, max_size=4)


@pytest.mark.parametrize(
    ("text", "slots"),
    [
        ("a:1 b:2", {"a": "1", "b": "2"}),
        ("hello world", {0: "hello", 1: "world"}),
        ("one two three:3", {0: "one", 1: "two", "three": "3"}),
        ("x:a:b", {"x": "a:b"}),
        ("a:1 b", {"a": "1", 1: "b"}),
        ("", {}),
        ("  a \t b\n", {0: "a", 1: "b"}),
        ("a:", {"a": ""}),
        ("a:1 a:2", {"a": "2"}),
        ("größe:5", {"größe": "5"}),
    ],
)
def test_text_becomes_slots(text: str, slots: dict[Any, str]) -> None:
    assert Chunk(text) == slots


def test_bound_variables_keep_their_types() -> None:
    assert Chunk("?x b:?y c", {"x": 3, "y": None}) == {0: 3, "b": None, 2: "c"}


def test_an_unbound_variable_is_named_with_those_that_are_bound() -> None:
    with pytest.raises(ChunkError, match=r"chunk 'a:\?colr': '\?colr' is not bound; did you mean 'color'\? \(bound here: \?color, \?n\)"):
        Chunk("a:?colr", {"color": 1, "n": 2})
    with pytest.raises(ChunkError, match=r"chunk '\?x': '\?x' is not bound \(no variable is bound here\)"):
        Chunk("?x")


def test_mappings_chunks_buffers_and_objects() -> None:
    class Thing:
        shared = "of the class"

        def __init__(self) -> None:
            self.x, self.color, self.seen, self.size = 1, "red", True, 2.5
            self._hidden, self.parts, self.nothing = "h", [1], None

    assert Chunk({"a": 1, 0: [2], "n": None}) == {"a": 1, 0: [2], "n": None}
    assert Chunk(Thing()) == {"x": 1, "color": "red", "seen": True, "size": 2.5}
    original = Chunk("a b")
    other = Chunk(original)
    other[0] = "c"
    assert original == {0: "a", 1: "b"}
    assert Chunk([("a", 1)]) == {"a": 1}
    buffer = Buffer()
    buffer.set("p q:1")
    assert Chunk(buffer) == {0: "p", "q": "1"}


@pytest.mark.parametrize("contents", [None, 5, 2.5, True, [1, 2], int, ["abc"], len])
def test_invalid_contents_of_a_chunk_are_named(contents: object) -> None:
    with pytest.raises(ChunkError, match=r"a chunk is made of text, a mapping, a chunk or an object \(got "):
        Chunk(contents)


def test_an_empty_buffer_makes_no_chunk() -> None:
    agent: Any = Model()
    agent.goal = Buffer()
    with pytest.raises(ChunkError, match="buffer 'goal' is empty: there is no chunk to take from it"):
        Chunk(agent.goal)


@pytest.mark.parametrize(
    ("contents", "shown"),
    [
        ("b a c:1", "b a c:1"),
        ({"z": 1, "a": None, 1: "second", 0: "first"}, "first second a:None z:1"),
        ({1: "b", "x": 2}, "1:b x:2"),
        ({"_hidden": 1, "shown": 2}, "shown:2"),
        ({2: "c", 0: "a", 11: "l", "b": 1.5}, "a 11:l 2:c b:1.5"),
        ("", ""),
    ],
)
def test_shown_as_places_then_sorted_names(contents: Any, shown: str) -> None:
    assert repr(Chunk(contents)) == str(Chunk(contents)) == f"{Chunk(contents)}" == shown


@given(st.lists(st.one_of(WORDS, st.tuples(WORDS, WORDS).map(":".join)), max_size=6))
def test_showing_and_reading_again_changes_nothing(words: list[str]) -> None:
    places = [w for w in words if ":" not in w]
    names = {f"s{w.split(':')[0]}": w.split(":")[1] for w in words if ":" in w}
    text = " ".join(places + [f"{k}:{v}" for k, v in names.items()])
    chunk = Chunk(text)
    assert Chunk(repr(chunk)) == chunk
    assert repr(Chunk(repr(chunk))) == repr(chunk)


@pytest.mark.parametrize(
    ("value", "text"),
    [
        ("a", "a"),
        (1, "1"),
        (True, "True"),
        (None, "None"),
        (0.5, "0.5"),
        (1.0, "1"),
        (1e-7, "1e-07"),
        (1234567.0, "1.23457e+06"),
        ([1], "[1]"),
    ],
)
def test_values_as_text(value: object, text: str) -> None:
    assert as_text(value) == text


@pytest.mark.parametrize("value", [2, 2.0, "2", "+2.0", "2.", "0.2e1", ".2E+1", np.int64(2), np.float32(2), Decimal(2)])
def test_values_that_are_numbers(value: object) -> None:
    assert as_number(value) == 2.0


@pytest.mark.parametrize(
    "value", ["", "two", "nan", "inf", "1_000", " 2", "٢", True, None, np.True_, b"2", [2], 2j, math.nan, math.inf, 10**400]
)
def test_values_that_are_no_numbers(value: object) -> None:
    assert as_number(value) is None


def test_copies_belong_to_no_memory() -> None:
    agent: Any = Model()
    agent.retrieval = Buffer()
    agent.memory = Memory(agent.retrieval)
    agent.memory.add("a:1")
    chunk: Chunk = agent.memory.dm[0]
    for twin in (chunk.copy(), copy.copy(chunk), copy.deepcopy(chunk), pickle.loads(pickle.dumps(chunk))):
        assert type(twin) is Chunk
        assert twin == chunk
        assert twin.stores == ()


def test_every_way_of_changing_a_chunk_in_memory_is_noticed() -> None:
    changes: list[tuple[Callable[[Any], Any], str, str]] = [
        (lambda c: operator.setitem(c, "a", "2"), "a:2", "a:1"),
        (lambda c: c.update(a="2"), "a:2", "a:1"),
        (lambda c: c.__ior__({"a": "2"}), "a:2", "a:1"),
        (lambda c: c.setdefault("new", "3"), "new:3", "a:2"),
        (lambda c: c.pop("a"), "b:1", "a:1"),
        (lambda c: operator.delitem(c, "a"), "b:1", "a:1"),
        (lambda c: c.popitem(), "a:1", "b:1"),
        (lambda c: c.clear(), "", "a:1"),
    ]
    for change, finds, misses in changes:
        agent: Any = Model()
        agent.retrieval = Buffer()
        agent.memory = Memory(agent.retrieval)
        for i in range(50):
            agent.memory.add(f"other:{i}")
        agent.memory.add("a:1 b:1")
        assert agent.memory.find_matching_chunks("a:1")
        chunk = agent.memory.find_matching_chunks("a:1")[0]
        change(chunk)
        assert any(c is chunk for c in agent.memory.find_matching_chunks(finds))
        assert not any(c is chunk for c in agent.memory.find_matching_chunks(misses))


def test_numbers_of_numpy_are_compared_as_pythons() -> None:
    chunk = Chunk({"count": np.int64(3), "seen": np.bool_(True), "v": np.float32(0.5), "w": np.float64(1e6)})
    for text in ("count:3", "seen:True", "v:0.5", "w:1e+06"):
        slot, word = text.split(":")
        assert as_text(chunk[slot]) == word
    assert as_text(np.array([1])) == "array([1])"
