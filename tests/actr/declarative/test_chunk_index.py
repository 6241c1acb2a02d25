"""The chunk store finds exactly the chunks that a search through all of them finds, after any changes."""

from __future__ import annotations

import copy
import pickle
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from actr3d.actr import Buffer, Chunk, Memory
from actr3d.actr.chunks.chunk import as_text
from actr3d.actr.chunks.pattern import Pattern
from actr3d.actr.declarative.chunk_index import ChunkStore
from actr3d.actr.declarative.chunk_query import search_for
from actr3d.errors import ChunkError

VALUES: list[Any] = ["x", "y", "1", 1, 1.0, True, None, 0.1, "0.1", (1, 2), [1], {"k": 1}]
SLOTS: list[Any] = ["a", "b", 0, 1]
slots = st.sampled_from(SLOTS)
values = st.sampled_from(VALUES)
contents = st.dictionaries(slots, values, max_size=4)
changes = st.sampled_from(["keep", "append", "remove", "change", "delete", "slice", "grow", "reverse", "merge"])
steps = st.lists(st.tuples(changes, st.integers(0, 50), contents), max_size=25)


def perform(store: ChunkStore, what: str, place: int, items: dict[Any, Any]) -> None:
    chunk = Chunk(copy.deepcopy(items))
    known = store[place % len(store)] if store else None
    if what == "keep":
        store.keep(chunk)
    elif what == "append":
        store.append(chunk)
    elif known is None:
        return
    elif what == "remove":
        del store[place % len(store)]
    elif what == "change":
        known.update(chunk)
    elif what == "delete":
        for slot in set(known) & set(items):
            del known[slot]
    elif what == "slice":
        store[place % len(store) :] = [chunk]
    elif what == "grow":  # a value that changes by itself, unnoticed
        lists: list[Any] = [value for value in known.values() if isinstance(value, list)]
        for value in lists:
            value.append(place)
    elif what == "reverse":
        store.reverse()
    else:
        known |= chunk


def check(store: ChunkStore, wanted: dict[Any, Any]) -> None:
    query = Chunk(wanted)
    assert store.equal_to(query) is next((chunk for chunk in store if chunk == query), None)
    for slot in SLOTS:
        assert [id(c) for c in store.with_slot(slot)] == [id(c) for c in store if slot in c]
        for text in {as_text(value) for value in VALUES} | {as_text([1, 3])}:
            found = [id(c) for c in store.with_value(slot, text) if slot in c and as_text(c[slot]) == text]
            assert found == [id(c) for c in store if slot in c and as_text(c[slot]) == text]


@settings(max_examples=75, deadline=None)
@given(steps=steps, wanted=contents)
def test_the_indexes_agree_with_a_linear_scan(steps: list[tuple[str, int, dict[Any, Any]]], wanted: dict[Any, Any]) -> None:
    store = ChunkStore()
    for what, place, items in steps:
        perform(store, what, place, items)
        check(store, wanted)


words = st.sampled_from(["p", "q", "r"])
conditions = st.one_of(words, words.map(lambda w: f"!{w}"), st.sampled_from(["?", "?x", "?y", "!?x"]))


@settings(max_examples=100, deadline=None)
@given(
    chunks=st.lists(st.lists(words, min_size=1, max_size=3), max_size=12),
    pattern=st.lists(conditions, min_size=1, max_size=3).map(" ".join),
)
def test_matching_by_index_finds_what_trying_every_chunk_finds(chunks: list[list[str]], pattern: str) -> None:
    memory = Memory(Buffer())
    for chunk in chunks:
        memory.add(" ".join(chunk))
    compiled = Pattern(pattern)
    assert memory.find_matching_chunks(pattern) == [chunk for chunk in memory.dm if compiled.match(chunk) is not None]


def test_a_chunk_in_two_stores_keeps_both_up_to_date() -> None:
    chunk = Chunk("a:1")
    one, other = ChunkStore([chunk]), ChunkStore([chunk])
    assert one.with_value("a", "1") == other.with_value("a", "1") == [chunk]
    chunk["a"] = "2"
    assert one.with_value("a", "2") == other.with_value("a", "2") == [chunk]
    assert one.with_value("a", "1") == other.with_value("a", "1") == []


def test_copies_are_independent() -> None:
    store = ChunkStore()
    for number in range(2000):  # deeper than Python's stack, if copying went from chunk to chunk
        store.keep(Chunk({"n": number}))
    assert store.equal_to(Chunk({"n": 7})) is store[7]
    for twin in (copy.deepcopy(store), pickle.loads(pickle.dumps(store))):
        assert list(twin) == list(store)
        twin[0]["n"] = "changed"
        assert store[0]["n"] == 0
        assert twin.with_value("n", "changed") == [twin[0]]
        assert store.with_value("n", "changed") == []


def test_a_copied_chunk_is_in_no_memory() -> None:
    store = ChunkStore()
    chunk = Chunk("a:1")
    store.keep(chunk)
    for twin in (copy.copy(chunk), chunk.copy(), copy.deepcopy(chunk)):
        assert store.holds(chunk)
        assert not store.holds(twin)


tests_of_a_slot = st.sampled_from(["1", "!1", "x", "!x!y", "None?v", "?v", "!?v", "?w", "?bound", "!?bound", "?", "0.1", "?v!?bound"])


@settings(max_examples=150, deadline=None)
@given(
    chunks=st.lists(contents, max_size=8),
    asked=st.dictionaries(st.sampled_from(["a", "b", "0", "1"]), tests_of_a_slot, min_size=1),
    bound=st.sampled_from([None, {}, {"bound": "x"}, {"bound": 1, "v": "1"}, {"bound": 0.1, "w": None}]),
)
def test_a_search_finds_what_trying_every_chunk_finds(
    chunks: list[dict[Any, Any]], asked: dict[str, str], bound: dict[str, Any] | None
) -> None:
    store = ChunkStore()
    for chunk in chunks:
        store.keep(Chunk(chunk))
    text = " ".join(f"{slot}:{test}" for slot, test in asked.items())
    pattern = Pattern(text, bound)
    expected = [id(chunk) for chunk in store if pattern.match(chunk) is not None]
    assert [id(chunk) for chunk in search_for(text, bound, None).among(store)] == expected
    assert [id(chunk) for chunk in search_for((text,), bound, None).among(store)] == expected


@pytest.mark.parametrize(
    ("method", "values"),
    [("remove", (Chunk("a b"),)), ("pop", (0,)), ("clear", ()), ("__delitem__", (0,)), ("__setitem__", (0, Chunk("c d")))],
)
def test_a_chunk_that_has_left_the_memory_is_not_held(method: str, values: tuple[Any, ...]) -> None:
    memory = Memory(Buffer())
    memory.add("a b")
    chunk = memory.dm[0]
    getattr(memory.dm, method)(*values)
    assert not memory.dm.holds(chunk)
    with pytest.raises(ChunkError, match="has no chunk 'a b'"):
        memory.get_activation(chunk)
