"""Warnings about patterns that can never match."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from typing import Any

import pytest

from actr3d.actr.chunks.pattern import Pattern
from actr3d.actr.loading import run_text
from actr3d.errors import ModelWarning
from tests.helpers.warnings_of_models import warned


@pytest.mark.parametrize(
    ("body", "message"),
    [
        ("def p(goal='a:?x b:?x a:1 b:2'): pass", "can never match: ?x must be '1' and '2' at the same time"),
        ("def p(goal='a:?x', retrieval='a:?x!1', imaginal=None, eye='busy:?x!?x'): pass", "eye's slot 'busy' must and must not be ?x"),
        ("def p(goal='a:?x!?y b:?y c:?y c:?x'): pass", "goal's slot 'a' must and must not be the same as ?y"),
        ("def p(goal='a:?x!1', retrieval='b:?x b:1'): pass", "goal's slot 'a' must not be '1', but it must equal another slot that is"),
        ("def p(goal='a:?x a:1', retrieval='b:?y!?x b:1'): pass", "retrieval's slot 'b' must not be ?x, but both must be '1'"),
        ("def p(goal='a:!?number b:?numbre'): pass", "nothing binds '?number' before goal's 'a:!?number' needs it; did you mean 'numbre'?"),
        ("def p(goal='?s:1'): pass", "nothing binds '?s' before goal's '?s:1' needs it"),
        (
            "def p(memory='busy:true'): pass",
            "can never match: 'memory' has True or False in 'busy', with capital letters, and never 'true'",
        ),
        ("def p(eye='busy:!FALSE'): pass", "and never 'FALSE'; did you mean 'busy:!False'?"),
        ("def p(memory='error:Ture'): pass", "and never 'Ture'; did you mean 'error:True'?"),
    ],
)
def test_patterns_that_can_never_match_are_warned_of(body: str, message: str) -> None:
    caught = warned(body)
    assert len(caught) == 1, caught
    assert message in caught[0][0]
    assert caught[0][1] == 10


@pytest.mark.parametrize(
    "body",
    [
        "def p(goal='?x!?y ?y!?x'): pass",
        "def p(goal='a:?x!1 b:?y!?x', retrieval='a:?x b:?y'): pass",
        "def p(goal='a:?x b:?x a:1 b:!2'): pass",
        "def p(goal='a:!?x', retrieval='a:?x'): pass",
        "def p(goal='s:?s ?s:1'): pass",
        "def p(goal=['a:!?x ?s:1', lambda chunk, bound: bound.update(x='1', s='b')]): pass",
        "def p(memory='busy:True error:!False'): pass",
        "def init(): goal.set('done:true')\ndef p(goal='done:true'): pass",
        "def init():\n    self.eye.busy = 'true'\ndef p(eye='busy:true'): pass",
        "def init():\n    self.eye.busy = 'tree'\ndef p(eye='busy:tree'): pass",
        "def p(eye='busy:tired'): pass",
    ],
)
def test_patterns_that_can_match_give_no_warning(body: str) -> None:
    assert warned(body) == []


@pytest.mark.parametrize(
    ("pattern", "objects", "matches"),
    [
        ("?x!?y ?y!?x", {0: "a", 1: "b"}, True),
        ("a:?x!?y b:?y c:?y c:?x", {"a": "1", "b": "1", "c": "1"}, False),
        ("a:!?x", {"a": "1"}, False),
        ("?s:1", {"s": "1", "?s": "1"}, False),
    ],
)
def test_warnings_about_a_pattern_are_true(pattern: str, objects: Mapping[Any, str], matches: bool) -> None:
    assert (Pattern(pattern).match(dict(objects)) is not None) is matches


PROGRAM = """from python_actr import *
import random
class Own(Memory): pass
class Agent(ACTR):
    goal = Buffer()
    retrieval = Buffer()
    memory = Memory(retrieval)
    def init():
        goal.set('count from:1')
        memory.add('next 1 2')
    def p(goal='count from:?x'):
        memory.request('next ?x ?y')
        goal.modify(from_='2')
    def q(goal='{pattern}', memory='busy:False'):
        pass
{more}
Agent().run(0)
"""


def warnings_about(pattern: str, more: str = "") -> list[tuple[str, int]]:
    """Returns the warnings about a complete program, run as such, in which a production matches the goal with `pattern`."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        run_text(PROGRAM.replace("from_", "from_" if "from_" in more else "count").format(pattern=pattern, more=more), "whole.py")
    assert all(w.category is ModelWarning and w.filename == "whole.py" for w in caught)
    return [(str(w.message), w.lineno) for w in caught]


@pytest.mark.parametrize("pattern", ["weather:rainy", "count ? ?x ?y", "from:1 weather:!wet"])
def test_a_slot_that_no_chunk_of_the_program_can_have_is_warned_of(pattern: str) -> None:
    slot = "3" if "?y" in pattern else "weather"
    assert warnings_about(pattern) == [(f"production 'q' can never match: no chunk is ever given a slot '{slot}'", 14)]


@pytest.mark.parametrize("pattern", ["count ?x ?y", "from:!2", "1:2 2:?z"])
def test_a_slot_that_some_chunk_has_gives_no_warning(pattern: str) -> None:
    assert warnings_about(pattern) == []


@pytest.mark.parametrize(
    "more",
    [
        "    def later(self): self.goal.set(self.text)",
        "    def later(self): self.goal.set(f'{self.text}')",
        "    def later(self): self.goal.set('%s:1' % self.text)",
        "    def later(self): self.goal.set({'a': 1})",
        "    def later(self): self.goal.chunk['a'] = 1",
        "    def later(self): put(self.goal)\ndef put(buffer):\n    fill = buffer.set\n    fill(random.choice('ab'))",
        "    def later(self): setattr(self.goal, 'chunk', None)",
        "    def later(self): self.goal.set(Chunk('a b c d e f'))",
        "    visual = Buffer()\n    vision = SOSVision(visual)",
        "    def later(self):\n        import actr_helpers",
        "    other = type('Own', (Buffer,), {})()",
        "    other = Own(goal)",
    ],
)
def test_no_warning_is_given_where_chunks_may_have_other_slots(more: str) -> None:
    assert warnings_about("weather:rainy", more) == []


def test_no_warning_is_given_about_a_module_that_others_may_use() -> None:
    assert warned("def init(): goal.set('a:1')\ndef p(goal='weather:1'): pass") == []
