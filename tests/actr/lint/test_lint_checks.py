"""Warnings about probable mistakes in a model, which change nothing."""

from __future__ import annotations

import warnings
from typing import Any

import pytest

from actr3d.actr.kernel.model import ensure_converted
from actr3d.actr.lint.checks import unchecked
from actr3d.actr.loading import load_text
from actr3d.errors import ChunkError, ModelWarning, ProductionException
from tests.helpers.warnings_of_models import HEAD, warned


@pytest.mark.parametrize(
    ("body", "message", "line"),
    [
        ("def p(goal='a:1 a:2'): pass", "production 'p' can never match: goal's slot 'a' must be '1' and '2' at the same time", 10),
        ("def p(goal='a:1!1'): pass", "can never match: goal's slot 'a' must and must not be '1'", 10),
        ("def p(goal='?x!?x'): pass", "can never match: goal's slot '0' must and must not be ?x", 10),
        ("def p(goal=[None, 'a']): pass", "can never match: 'goal' must be empty and contain a chunk at the same time", 10),
        ("def p(goal='a b', retrieval=['a', 'b']): pass", "retrieval's slot '0' must be 'a' and 'b' at the same time", 10),
        ("def p(goal=5): pass", "goal=5 is not a pattern and matches anything; write text, such as goal='5'", 10),
        (
            "def init(): goal.set('count:1')\ndef p(goal='cuont:1'): pass",
            "no chunk is ever given a slot 'cuont'; did you mean 'count'?",
            11,
        ),
        ("def init(): goal.set('word:go')\ndef p(goal='wrod:go'): pass", "given a slot 'wrod'; did you mean 'word'?", 11),
        ("def p(memory='eror:True'): pass", "'memory' has no attribute 'eror'; did you mean 'error'?", 10),
        ("def p(eye='bussy:False'): pass", "'eye' has no attribute 'bussy'; did you mean 'busy'?", 10),
        ("def p(eye='colour.depht:3'): pass", "'eye' has no attribute 'colour.depht'; did you mean 'depth'?", 10),
        ("def p(eye='colur.depth:3'): pass", "'eye' has no attribute 'colur'; did you mean 'colour'?", 10),
        ("def p(goal='a'):\n    goal.clear", "'goal.clear' without brackets does nothing; did you mean 'goal.clear()'?", 11),
        ("def init():\n    goal.clear", "'goal.clear' without brackets does nothing", 11),
        ("def act(self):\n    if self:\n        self.goal.clear", "'self.goal.clear' without brackets does nothing", 12),
        ("def p(goal='a ?x'):\n    goal.set('b ?y')", "production 'p': nothing binds '?y' in 'b ?y'", 11),
        ("def p(goal='a ?xyz'):\n    memory.add('b ?xzy')", "nothing binds '?xzy' in 'b ?xzy'; did you mean 'xyz'?", 11),
        ("def p(goal='a ?x'):\n    imaginal.set('c:?z')", "nothing binds '?z'", 11),
        ("def init(): goal.set('?x')", "nothing binds '?x'", 10),
        ("def p(goal='a ?x'):\n    goal.modify(a='?x')", "a='?x' stores this text literally; the variable's value is a=x", 11),
        ("def p(goal='a'): pass\ndef p(goal='b'): pass", "class Agent has two methods 'p', in lines 10 and 11; only the second counts", 11),
        ("def p(goal='a'):\n    number = 1\n    print(nubmer)", "production 'p': nothing defines 'nubmer'; did you mean 'number'?", 12),
        ("def p(goal='a ?word'):\n    print(wrod, wrod)", "nothing defines 'wrod'; did you mean 'word'?", 11),
        ("production_tme = 0.1", "has an attribute 'production_tme', which is not a parameter; did you mean 'production_time'?", 10),
        ("def init(): memory.treshold = 3", "Memory has no parameter 'treshold'; did you mean 'threshold'?", 10),
    ],
)
def test_probable_mistakes_are_warned_of_at_their_line(body: str, message: str, line: int) -> None:
    if body == "def init(): goal.set('?x')":
        with pytest.raises(ChunkError, match=r"'\?x' is not bound"), pytest.warns(ModelWarning, match="nothing binds"):
            load_text(HEAD + "    " + body, "loud.py").Agent().run(0)
        return
    caught = warned(body)
    assert len(caught) == 1, caught
    assert message in caught[0][0]
    assert caught[0][1] == line


@pytest.mark.parametrize(
    "body",
    [
        "def p(goal='a:1!2 b:?x!?y c:?y', memory='error:True busy:False'): pass",
        "def p(goal='a:1 b:1', retrieval=None): goal.set('b:2')",
        "def init(): goal.set('first:1')\ndef p(goal='other:1'): pass",
        "def init(): goal.set({'count': 1})\ndef p(goal='count:1'): goal.modify(count=2)",
        "def p(goal='a ?x'):\n    y = x\n    goal.set('b ?y')",
        "def p(goal='a ?x'):\n    for i in '12':\n        goal.set('b ?i')",
        "def p(goal='a'):\n    goal.chunk\n    self.eye.busy",
        "def p(goal='a ?x'):\n    memory.request('b ?y')",
        "@property\ndef v(self): return 1\n@v.setter\ndef v(self, value): pass",
        "def p(goal='a', utility=0.5): pass",
        "def p(goal=['a ?x', 'a ?y'], retrieval=('b', lambda chunk, bound: True)): pass",
        "def p(goal='a:?x!?y', retrieval='a:?y'): pass",
        "def init():\n    global later\n    later = 1\ndef p(goal='a'):\n    print(later, [n for n in (1, 2)], (lambda m: m)(1))",
        "def init(): self.count = 0\ndef p(goal='a'):\n    print(count, __name__, self, other.there)\ndef q(goal='b'):\n    global other",
        "def p(goal=lambda chunk, bound: True):\n    print(bound_there)",
        "def init(): setattr(self, 'made', 1)\ndef p(goal='a'):\n    print(made)",
        "production_time = 0.1\nproduct = 3\nthreshold = 2",
    ],
)
def test_legitimate_code_gives_no_warning(body: str) -> None:
    assert warned(body) == []


def test_a_class_is_checked_once() -> None:
    text = HEAD + "    def p(goal='a:1 a:2'): pass\n"
    module = load_text(text, "loud.py")
    with pytest.warns(ModelWarning, match="never match"):
        module.Agent().run(0)
    module.Agent().run(0)


def test_a_warning_changes_nothing() -> None:
    text = HEAD + "    def init(): goal.set('count:1')\n    def p(goal='count:1'):\n        goal.clear\n        goal.modify(count='?x')\n"
    traces: list[list[str]] = []
    for action in ("always", "ignore"):
        with warnings.catch_warnings(record=True):
            warnings.simplefilter(action)  # type: ignore[arg-type]
            agent: Any = load_text(text, "loud.py").Agent()
            ensure_converted(agent)
            agent.random.seed(1)
            trace = agent.traced()
            agent.run(1)
        traces.append([event.to_json() for event in trace if event.kind != "start"])
    assert traces[0] == traces[1]


def test_a_misspelt_buffer_is_an_error_that_names_place_and_production() -> None:
    agent: Any = load_text(HEAD + "    def p(gaol='a'): pass\n", "loud.py").Agent()
    with pytest.raises(ProductionException, match=r"production 'p' \(loud.py:10\) matches on 'gaol'.*did you mean 'goal'"):
        agent.run(0)


def test_an_error_in_a_body_names_file_line_production_and_what_may_be_meant() -> None:
    agent: Any = load_text(HEAD + "    def init(): goal.set('a')\n    def p(goal='a'):\n        goal.sett('b')\n", "loud.py").Agent()
    with pytest.raises(AttributeError, match="sett") as caught:
        agent.run(1)
    assert caught.value.__notes__ == ["in production 'p' (loud.py:11) at 0.05 s; did you mean 'set'?"]
    frames = [(f.path if isinstance(f.path, str) else f.path.name, f.lineno + 1) for f in caught.traceback]
    assert ("loud.py", 12) in frames


def test_classes_that_ran_unchecked_are_checked_later() -> None:
    agent: Any = load_text(HEAD + "    def act(self):\n        if self:\n            self.goal.clear", "loud.py").Agent
    with unchecked(), warnings.catch_warnings():
        warnings.simplefilter("error")
        agent().run(0)
    with pytest.warns(ModelWarning, match="without brackets does nothing"):
        agent().run(0)
