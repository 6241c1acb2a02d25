"""Patterns: every row of the table is tested twice: by Pattern.match, and by a production of a real agent."""

from __future__ import annotations

import re
import warnings
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from actr3d.actr import ACTR, Buffer, Chunk
from actr3d.actr.chunks.pattern import Pattern
from actr3d.actr.loading import load_text
from actr3d.actr.procedural.matcher import Matcher
from actr3d.actr.procedural.production import Production
from actr3d.errors import ModelWarning, PatternException

with warnings.catch_warnings():
    warnings.simplefilter("ignore")  # python_actr's own source is older than this Python
    import python_actr.pattern  # pyright: ignore

PeerPattern: Any = python_actr.pattern.Pattern  # pyright: ignore


def answers(value: object) -> Any:
    """Makes a function among the patterns that gives this answer."""

    def function(obj: Any, bindings: dict[str, Any]) -> object:
        return value

    return function


def asks_what_is_missing(obj: Any, bindings: dict[str, Any]) -> bool:
    return obj["missing"]


def x_is_2(obj: Any, bindings: dict[str, Any]) -> bool:
    return bindings["x"] == "2"


def binds_more(obj: Any, bindings: dict[str, Any]) -> None:
    bindings["more"] = "m"


No = None
TABLE: list[tuple[Any, Any, dict[str, str] | None]] = [
    ("hello", "hello world", {}),
    ("hello", "world hello", No),
    ("hello ?", "hello", {}),
    ("hello ?x", "hello", No),
    ("?x ?x", "a a", {"x": "a"}),
    ("?x ?x", "a b", No),
    ("?x !?x", "a b", {"x": "a"}),
    ("?x !?x", "a a", No),
    ("!?x ?x", "a b", {"x": "b"}),
    ("?x ? !?x", "1 2 1", No),
    ("?x ? !?x", "1 2 3", {"x": "1"}),
    ("!a", "b", {}),
    ("!a", "a", No),
    ("!a", None, No),
    ("!a!b", "c", {}),
    ("!a!b", "b", No),
    ("?x!None", "k", {"x": "k"}),
    ("?x!None", "None", No),
    ("a:?x!?y b:?y", "a:1 b:2", {"x": "1", "y": "2"}),
    ("a:?x!?y b:?y", "a:1 b:1", No),
    ("count:None?count", "count:None", {"count": "None"}),
    ("count:None?count", {"count": None}, {"count": "None"}),
    ("count:None?count", "count:3", No),
    ("a:1 a:2", "a:1", No),
    ("1:?y", "p q", {"y": "q"}),
    ("s:?s ?s:1", "s:q q:1", {"s": "q"}),
    ("?s:1 s:?s", "s:q q:1", {"s": "q"}),
    ("s:?s ?s:1", "s:q q:2", No),
    ("s:?s ?s:1", "s:q", No),
    ("s:?s ?s:?v w:!?v", "s:q q:1 w:2", {"s": "q", "v": "1"}),
    ("s:?s ?s:!?s", "s:q q:q", No),
    ("?s:1", "s:1", No),
    ("s:?s ?s:b", {"s": "1", 1: "b"}, {"s": "1"}),
    ("", "hello", {}),
    ("", "", {}),
    ("", None, {}),
    (None, None, {}),
    (None, "hello", No),
    (("a:1", "b:?x"), "a:1 b:2", {"x": "2"}),
    (["a:?x", "b:?x"], "a:1 b:1", {"x": "1"}),
    (["a:?x", "b:?x"], "a:1 b:2", No),
    (answers(True), "a", {}),
    (answers(None), "a", {}),
    (answers(False), "a", No),
    (answers(0), "a", No),
    (answers(""), "a", {}),
    (asks_what_is_missing, "a", No),
    ([x_is_2, "b:?x"], "b:2", {"x": "2"}),
    ([binds_more, "b:?x"], "b:2", {"x": "2", "more": "m"}),
    ("n:5", {"n": 5}, {}),
    ("n:5", {"n": 5.0}, {}),
    ("n:0.1", {"n": 0.1}, {}),
    ("n:0.333333", {"n": 1 / 3}, {}),
    ("n:1e-07", {"n": 1e-7}, {}),
    ("n:-3.5", {"n": -3.5}, {}),
    ("n:True", {"n": True}, {}),
    ("n:1", {"n": True}, No),
    ("größe:?g", "größe:klein", {"g": "klein"}),
    ("a ?x!b!?y ?y", "a c d", {"x": "c", "y": "d"}),
    ("a ?x!b!?y ?y", "a b d", No),
    ("a-b a.b a_b", "a-b a.b a_b", {}),
]


@pytest.mark.parametrize(("pattern", "contents", "expected"), TABLE)
def test_by_pattern(pattern: Any, contents: Any, expected: dict[str, str] | None) -> None:
    chunk = None if contents is None else Chunk(contents)
    if not (pattern == "" and contents is None):
        assert Pattern(pattern).match(chunk) == expected
    assert Pattern({"goal": pattern}).match({"goal": chunk if chunk is not None else Buffer()}) == expected


@pytest.mark.parametrize(("pattern", "contents", "expected"), TABLE)
def test_by_production(pattern: Any, contents: Any, expected: dict[str, str] | None) -> None:
    module: Any = load_text(
        """
from actr3d.actr import *
contents = None
class Agent(ACTR):
    goal = Buffer()
    seen = None
    def init():
        if contents is not None:
            goal.set(contents)
    def act(goal=None):
        self.seen = dict(self._productions[0].bound)
        self.stop()
"""
    )
    module.contents = contents
    module.Agent.act.__defaults__ = (pattern,)
    agent = module.Agent()
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", ModelWarning)  # some of these patterns can never match, which gives a warning
        agent.run(0.05)
    assert agent.seen == expected


def test_one_variable_across_buffers() -> None:
    pattern = Pattern({"goal": "a ?x", "retrieval": "?x b !?x"})
    assert pattern.match({"goal": Chunk("a k"), "retrieval": Chunk("k b c")}) == {"x": "k"}
    assert pattern.match({"goal": Chunk("a k"), "retrieval": Chunk("j b c")}) is None
    assert pattern.match({"goal": Chunk("a k")}) is None


def test_attributes_and_paths_of_objects() -> None:
    class Cell:
        wall = False
        depth = 2.0

        @property
        def broken(self) -> int:
            raise KeyError("not now")

    class Body:
        ahead_cell = Cell()
        name = "bob"

    assert Pattern("ahead_cell.wall:False ahead_cell.depth:2 name:?n").match(Body()) == {"n": "bob"}
    assert Pattern("ahead_cell.wall:True").match(Body()) is None
    assert Pattern("ahead_cell.door:False").match(Body()) is None
    assert Pattern("behind.wall:False").match(Body()) is None
    assert Pattern("ahead_cell.broken:!3").match(Body()) is None


def test_variables_that_are_already_bound_are_compared_by_value() -> None:
    bound = {"x": 3, "y": 0.5, "slot": "a", "place": 1}
    assert Pattern("a:?x b:?y", bound).match(Chunk({"a": 3, "b": "0.5"})) == {}
    assert Pattern("a:!?x", bound).match(Chunk("a:3")) is None
    assert Pattern("?slot:?x", bound).match(Chunk("a:3")) == {}
    assert Pattern("?slot:?x", bound).match(Chunk("a:4")) is None
    assert Pattern("?place:b", bound).match(Chunk("a b")) == {}


@pytest.mark.parametrize(
    ("pattern", "message"),
    [
        ("a:1 2", "'2' without a slot's name after the named slot 'a' in pattern 'a:1 2'"),
        ("a:1 ?", "'?' without a slot's name after the named slot 'a' in pattern 'a:1 ?'"),
        ("a:", "no value for slot 'a' in pattern 'a:'"),
        ("a:b/c", "cannot read '/c' in slot 'a' of pattern 'a:b/c'; a value is letters, digits"),
        ("a:b:c", "cannot read ':c' in slot 'a'"),
        ("!", "cannot read '!' in slot '0' of pattern '!'"),
        ("a:'x'", "cannot read ''x'' in slot 'a'"),
        ("?!x", "cannot read '?!x' in slot '0'"),
        ("a:=b", "cannot read '=b' in slot 'a'"),
        ("x ?y?", "cannot read '?' in slot '1'"),
    ],
)
def test_unreadable_patterns_are_named(pattern: str, message: str) -> None:
    with pytest.raises(PatternException, match=re.escape(message)):
        Pattern(pattern)
    with pytest.raises(Exception, match=r"[Ss]lot|Unknown text|unnamed"):
        PeerPattern(pattern)


def test_an_unreadable_pattern_names_its_production() -> None:
    module: Any = load_text("from actr3d.actr import *\nclass A(ACTR):\n    goal = Buffer()\n    def p(goal='a:'):\n        pass\n", "m.py")
    with pytest.raises(PatternException, match=r"production 'p' \(m\.py:4\): no value for slot 'a' in pattern 'a:'"):
        module.A().run(1)


# -- against python_actr's own patterns, and the matcher against single patterns

SLOTS = st.sampled_from(["a", "b", "0", "1", "2"])
VALUES = st.sampled_from(["1", "2", "x", "None"])
PIECES = st.one_of(
    VALUES,
    VALUES.map("!{}".format),
    st.sampled_from(["?v", "?w", "!?v", "!?w", "?"]),
    st.tuples(st.sampled_from(["1", "!1", "!x"]), st.sampled_from(["?v", "!?v", "!2"])).map("".join),
)
PATTERNS = st.tuples(st.lists(PIECES, max_size=3), st.lists(st.tuples(SLOTS, PIECES).map(":".join), max_size=3)).map(
    lambda parts: " ".join([*parts[0], *parts[1]])
)
CHUNKS = st.dictionaries(st.sampled_from(["a", "b", 0, 1, 2]), st.one_of(VALUES, st.sampled_from([1, 2, None, 1.0, True])), max_size=4)
CONTENTS = st.one_of(st.none(), CHUNKS)


@settings(max_examples=200, deadline=None)
@given(PATTERNS, CHUNKS)
def test_as_python_actr_does(pattern: str, contents: dict[Any, Any]) -> None:
    assert Pattern(pattern).match(Chunk(contents)) == PeerPattern(pattern).match(Chunk(contents))


RULES = st.lists(st.tuples(PATTERNS, PATTERNS), min_size=1, max_size=8)
STATES = st.lists(st.tuples(CONTENTS, CONTENTS), min_size=1, max_size=4)


@settings(max_examples=60, deadline=None)
@given(RULES, STATES)
def test_the_matcher_finds_what_single_patterns_find(rules: list[tuple[str, str]], states: list[tuple[Any, Any]]) -> None:
    compare_with_single_patterns(rules, states)


@pytest.mark.slow
@settings(max_examples=400, deadline=None)
@given(RULES, STATES)
def test_the_matcher_finds_in_many_more_cases_what_single_patterns_find(
    rules: list[tuple[str, str]], states: list[tuple[Any, Any]]
) -> None:
    compare_with_single_patterns(rules, states)


def compare_with_single_patterns(rules: list[tuple[str, str]], states: list[tuple[Any, Any]]) -> None:
    agent: Any = ACTR()
    agent.goal, agent.other = Buffer(), Buffer()
    context: dict[str, Any] = {"goal": agent.goal, "other": agent.other, "self": agent}
    productions: list[Production] = []
    patterns: list[tuple[Pattern, Any]] = []
    for number, (goal, other) in enumerate(rules):

        def rule() -> None: ...

        production = Production(agent, f"p{number}", rule)
        spec = {"goal": goal, "other": other}
        production.conditions = Pattern(spec).conditions
        productions.append(production)
        patterns.append((Pattern(spec), PeerPattern(spec)))
    matcher = Matcher(context)
    matcher.build(productions)
    for state in states:
        for buffer, contents in zip((agent.goal, agent.other), state, strict=True):
            if contents is None:
                buffer.clear()
            else:
                buffer.set(dict(contents))
        found = {p.name: p.bound for p in matcher.matching()}
        expected = {p.name: b for p, (own, _) in zip(productions, patterns, strict=True) if (b := own.match(context)) is not None}
        peers = {p.name: b for p, (_, peer) in zip(productions, patterns, strict=True) if (b := peer.match(context)) is not None}
        assert found == expected == peers
        assert list(found) == list(expected)
        assert {p.name for p in productions if matcher.matches(p)} == set(found)
