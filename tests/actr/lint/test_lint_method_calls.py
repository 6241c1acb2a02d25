"""Warnings about probable mistakes in the actions of productions."""

from __future__ import annotations

from typing import Any

import pytest

from actr3d.actr import Model
from actr3d.actr.kernel.model import ensure_converted
from actr3d.actr.lint.slot_names import is_misspelt
from actr3d.actr.loading import load_text
from actr3d.errors import ModelWarning
from tests.helpers.warnings_of_models import HEAD, warned

COUNTING = (
    "def init():\n    goal.set('count:1 last:5')\n    memory.add('number:1 next:2')\n"
    "def p(goal='count:?x last:!?x', retrieval='next:?n'):\n"
)


@pytest.mark.parametrize(
    ("body", "message"),
    [
        ("    goal.set('cuont:1 last:5')", "production 'p': no production and no request reads a slot 'cuont'; did you mean 'count'?"),
        ("    goal.set(f'Count:{x} last:5')", "no production and no request reads a slot 'Count'; did you mean 'count'?"),
        ("    imaginal.set('cuont:1')", "no production and no request reads a slot 'cuont'; did you mean 'count'?"),
        ("    memory.add('nuber:1 nxet:2')", "no production and no request reads a slot 'nxet'; did you mean 'next'?"),
        ("    memory.request('numbr:?x')", "production 'p': no chunk is ever given a slot 'numbr'; did you mean 'number'?"),
        ("    memory.request('nubmer:1 next:?y', require_new=True)", "no chunk is ever given a slot 'nubmer'; did you mean 'number'?"),
        ("    goal.modify(cuont=2)", "no chunk is ever given a slot 'cuont'; did you mean 'count'?"),
        (
            "    pass\ndef act(self):\n    self.goal.set('cuont:1')",
            "Agent.act: no production and no request reads a slot 'cuont'; did you mean 'count'?",
        ),
    ],
)
def test_a_misspelt_slot_is_warned_of(body: str, message: str) -> None:
    caught = warned(COUNTING + body)
    assert len(caught) == 1, caught
    assert message in caught[0][0]
    assert caught[0][1] == 13 + len(body.splitlines())


@pytest.mark.parametrize(
    "body",
    [
        "    goal.set('count:2 last:5 note:x')",
        "    goal.set('counts:2 last:5')",
        "    goal.set('court:2 count:3')",
        "    goal.modify(count=2, last='6', _1=3)",
        "    memory.request('number:?x next:?y')\n    memory.request('next:?y')",
        "    goal.set('cuont:1')\ndef q(goal='cuont:1'): pass",
        "    goal.set('cuont:1')\n    print(goal['cuont'])",
        "    memory.request('colour:red')",
        "    memory.request('%s:1' % x)",
        "    memory.request(f'{x}umbr:1')",
        "    goal.set('num1:1 num2:2')\ndef q(goal='num1:?x'): pass",
        "    self.eye.set('cuont:1')\ndef show(self): pass",
    ],
)
def test_other_slots_give_no_warning(body: str) -> None:
    if "eye.set" in body:
        body = body.replace("self.eye.set", "print")
    assert warned(COUNTING + body) == []


def test_slots_that_the_memory_holds_give_no_warning() -> None:
    text = HEAD + "    def init():\n        memory.request('numbr:?x')\n        memory.add('number:1')\n"
    agent: Any = load_text(text, "loud.py").Agent()
    ensure_converted(agent)
    agent.memory.add({"numbr": 3})
    agent.run(0)


@pytest.mark.parametrize(
    ("one", "other", "misspelt"),
    [
        ("cuont", "count", True),
        ("cont", "count", True),
        ("coount", "count", True),
        ("numbar", "number", True),
        ("numbex", "number", False),
        ("nunber", "number", True),
        ("Count", "count", True),
        ("start", "state", False),
        ("num1", "num2", False),
        ("item1a", "item2a", False),
        ("left_x", "left_y", False),
        ("a_left", "b_left", False),
        ("pos_x_start", "pos_y_start", False),
        ("word", "words", False),
        ("height", "weight", False),
        ("size", "side", False),
        ("x", "X", False),
        ("count", "count", False),
    ],
)
def test_misspellings_are_recognized(one: str, other: str, misspelt: bool) -> None:
    assert is_misspelt(one, other) is misspelt
    assert is_misspelt(other, one) is misspelt


@pytest.mark.parametrize(
    ("body", "message"),
    [
        ("def p(goal='a ?number'):\n    memory.request('a ?numbr')", "'?numbr' in 'a ?numbr' matches anything; did you mean '?number'?"),
        (
            "def p(goal='a ?number'):\n    memory.request('b:!?nubmer')",
            "'?nubmer' in 'b:!?nubmer' matches anything; did you mean '?number'?",
        ),
        (
            "def p(goal='a ?y'):\n    goal.modify(a='2 ?y')",
            "a='2 ?y' stores this text literally; with the variable's value it is a=f'2 {y}'",
        ),
        (
            "def p(goal='state:start'):\n    goal.modify(state='next step')",
            "state='next step' stores this text literally; no pattern can match it, because it contains a space; write one word",
        ),
        ("def p(goal='a'):\n    self.stop", "'self.stop' without brackets does nothing; did you mean 'self.stop()'?"),
    ],
)
def test_probable_mistakes_in_actions_are_warned_of(body: str, message: str) -> None:
    caught = [(text, line) for text, line in warned(body) if "slot" not in text]
    assert len(caught) == 1, caught
    assert message in caught[0][0]
    assert caught[0][1] == 11


@pytest.mark.parametrize(
    "body",
    [
        "def p(goal='a ?num1'):\n    memory.request('a ?num2')",
        "def p(goal='a ?number'):\n    memory.request('a ?number ?next')",
        "def p(goal='a ?number'):\n    memory.request('?numbr ?numbr')",
        "def p(goal='a ?number'):\n    memory.request('a ?numbr')\ndef q(retrieval='a ?numbr'): pass",
        "def p(goal='a ?word'):\n    memory.request('a ?words')",
        "def p(goal='a ?x'):\n    memory.request('a ?')",
        "def p(goal=['a ?number', lambda c, b: b.update(numbr=1)]):\n    memory.request('a ?numbr')",
        "def p(goal='note:?text'):\n    goal.modify(note='what now?')",
        "def init(): goal.set('note:x')\ndef p(goal='note:?text'):\n    goal.modify(note='a long text')",
        "def p(goal='a:?y'):\n    goal.modify(a=f'2 {y}')",
        "def p(goal='a'):\n    self.stop()\n    self.eye.busy\n    memory.threshold",
    ],
)
def test_legitimate_actions_give_no_warning(body: str) -> None:
    assert [text for text, _ in warned(body)] == []


def agent_that(body: str) -> Any:
    """Returns an agent whose production `p` calls its method `act`, which begins in line 12."""
    text = HEAD + "    def init(): goal.set('a')\n    def p(goal='a'): self.act()\n" + body
    return load_text(text, "loud.py").Agent()


@pytest.mark.parametrize(
    ("action", "error", "note"),
    [
        ("self.goal.sett('b')", AttributeError, "; did you mean 'set'?"),
        ("Bufer()", NameError, "; did you mean 'Buffer'?"),
        ("1 / 0", ZeroDivisionError, ""),
    ],
)
def test_an_error_in_a_method_that_a_production_started_names_the_production(action: str, error: type[Exception], note: str) -> None:
    agent = agent_that(f"    def act(self):\n        yield 0.2\n        {action}\n")
    with pytest.raises(error) as caught:
        agent.run(1)
    assert caught.value.__notes__ == [f"in 'act' at 0.25 s, called by production 'p' (loud.py:11) at 0.05 s{note}"]
    assert ("loud.py", 14) in [(str(frame.path), frame.lineno + 1) for frame in caught.traceback]


def test_an_error_in_a_generator_that_no_production_called_names_none() -> None:
    class World(Model):
        def start(self) -> Any:
            yield 0.1
            raise ValueError("none")

    with pytest.raises(ValueError, match="none") as caught:
        World().run(1)
    assert not hasattr(caught.value, "__notes__")


def test_a_generator_called_after_a_production_has_failed_is_not_its() -> None:
    agent = agent_that("    def act(self):\n        raise KeyError('first')\n    def other(self):\n        yield 0.1\n        1 / 0\n")
    with pytest.raises(KeyError, match="first"):
        agent.run(1)
    agent.other()
    with pytest.raises(ZeroDivisionError) as caught:
        agent.run(1)
    assert not hasattr(caught.value, "__notes__")


@pytest.mark.parametrize("what", ["(None, 0.2)", "[self.note(), (0.2,)]", "(0.2, (None, 'name'))"])
def test_none_in_a_tuple_of_waits_is_warned_of(what: str) -> None:
    start = f"    def start(self):\n        yield {what}\n        self.seen = self.now()\n"
    text = f"from actr3d.actr import *\nclass World(Model):\n    seen = 0\n{start}    def note(self): pass\n"
    world: Any = load_text(text, "loud.py").World()
    with pytest.warns(ModelWarning, match=r"World\.start yields a tuple with None in it, which ends it for all that wait for it") as caught:
        world.run(1)
    assert [(w.filename, w.lineno) for w in caught] == [("loud.py", 5)]
    assert world.seen == 0.2


@pytest.mark.parametrize("outer", ["p(goal='count:?x')", "init()"])
def test_a_production_inside_another_one_is_warned_of(outer: str) -> None:
    caught = warned(f"def {outer}:\n    goal.set('count:1')\n    def inner(goal='count:1', retrieval=None):\n        goal.clear()")
    name = outer.partition("(")[0]
    (text,) = [(text, line) for text, line in caught if "inner" in text]
    assert text == (f"production '{name}': 'inner' is inside it, and therefore no production; it needs the indentation of '{name}'", 12)


@pytest.mark.parametrize(
    "inner",
    [
        "def inner(goal='count:1'):\n        return goal\n    print(inner())",  # a function that the production calls
        "def inner(much='count:1'):\n        return much",
        "def inner(goal):\n        return goal",
        "def inner():\n        return 1",
    ],
)
def test_other_functions_inside_a_production_give_no_warning(inner: str) -> None:
    assert [text for text, _ in warned(f"def p(goal='count:?x'):\n    {inner}") if "inside" in text] == []
