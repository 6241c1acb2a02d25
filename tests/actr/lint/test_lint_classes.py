"""Warnings about methods and attributes in the classes of agents, environments and modules."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from typing import Any

import pytest

from actr3d import actr
from actr3d.actr import ACTR, Buffer, DMBaseLevel, DMNoise, DMSpreading, Memory, Partial, PMNew, SOSVision, display
from actr3d.actr.loading import load_text
from actr3d.errors import ModelWarning
from tests.helpers.warnings_of_models import warned


def warnings_about_world(body: str, agent: bool) -> list[tuple[str, int]]:
    """Returns the warnings about an environment with these methods (the first line of the body is 6), with an agent or without."""
    head = "from actr3d.actr import *\nclass Agent(ACTR):\n    goal = Buffer()\nclass World(Model):\n"
    text = head + f"    part = {'Agent' if agent else 'Buffer'}()\n" + "\n".join("    " + line for line in body.splitlines())
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        load_text(text, "world.py").World().run(1)
    assert all(w.category is ModelWarning and w.filename == "world.py" for w in caught)
    return [(str(w.message), w.lineno) for w in caught]


@pytest.mark.parametrize("agent", [True, False])
@pytest.mark.parametrize(
    ("body", "message", "line"),
    [
        ("def go(self): pass\ndef go(self): return 1", "class World has two methods 'go', in lines 6 and 7; only the second counts", 7),
        ("if True:\n    def go(self): pass\ndef go(self): pass", "in lines 7 and 8", 8),
        ("def go(self): pass\nif True:\n    def go(self): pass", "in lines 6 and 8", 8),
        ("if Agent.name:\n    def go(self): pass\n    def go(self): pass", "in lines 7 and 8", 8),
        ("try:\n    def go(self): pass\nexcept OSError: pass\ndef go(self): pass", "in lines 7 and 9", 9),
        ("def go(self):\n    self.part.{call}", "'self.part.{call}' without brackets does nothing", 7),
        ("def go(self):\n    self.stop", "'self.stop' without brackets does nothing", 7),
    ],
)
def test_methods_of_environments_are_checked(body: str, message: str, line: int, agent: bool) -> None:
    call = "goal.clear" if agent else "clear"
    caught = warnings_about_world(body.replace("{call}", call), agent)
    assert len(caught) == 1, caught
    assert message.replace("{call}", call) in caught[0][0]
    assert caught[0][1] == line


@pytest.mark.parametrize(
    "body",
    [
        "if Agent.name:\n    def go(self): pass\nelse:\n    def go(self): pass",
        "def go(self): pass\nif Agent.name:\n    def go(self): pass",
        "try:\n    def go(self): pass\nexcept OSError:\n    def go(self): pass",
        "@property\ndef go(self): pass\n@go.setter\ndef go(self, v): pass",
        "class Inner:\n    def go(self): pass\ndef go(self): pass",
        "def go(self):\n    def inner(): pass\n    def inner(): pass",
        "def go(self):\n    self.stop()\n    self.part.name\n    self.go()",
    ],
)
def test_legitimate_methods_give_no_warning(body: str) -> None:
    assert warnings_about_world(body, agent=True) == []


@pytest.mark.parametrize(
    ("body", "message", "line"),
    [
        ("def init(): self.production_tim = 0.1", "Agent has no parameter 'production_tim'; did you mean 'production_time'?", 10),
        (
            "production_tresholds = 1\nproduction_treshold = 3",
            "class Agent has an attribute 'production_treshold', which is not a parameter",
            11,
        ),
        (
            "spread = DMSpreading(memory, goal)\nspread.strenght = 2",
            "DMSpreading has no parameter 'strenght'; did you mean 'strength'?",
            11,
        ),
        ("dm = DMBaseLevel(memory)\ndm.decai = 0.4", "DMBaseLevel has no parameter 'decai'; did you mean 'decay'?", 11),
        ("memory.treshold = 3", "Memory has no parameter 'treshold'; did you mean 'threshold'?", 10),
        ("def p(goal=''):\n    self.profil = 1\n    self.stop()", "Agent has no parameter 'profil'; did you mean 'profile'?", 11),
    ],
)
def test_misspelt_parameters_are_warned_of(body: str, message: str, line: int) -> None:
    caught = [one for one in warned(body, 1) if "tresholds" not in one[0]]
    assert len(caught) == 1, caught
    assert message in caught[0][0]
    assert caught[0][1] == line


@pytest.mark.parametrize(
    ("names", "message"),
    [
        (
            "keep='goal', request='memory.request', retrieve='retreival'",
            "retrieve: class Agent has no 'retreival'; did you mean 'retrieval'?",
        ),
        ("keep='goal', request='memroy.request', retrieve='retrieval'", "request: class Agent has no 'memroy'; did you mean 'memory'?"),
        ("keep=['goal', 'gaol'], request='memory', retrieve='retrieval'", "keep: class Agent has no 'gaol'; did you mean 'goal'?"),
        ("keep=['goal'], request='self.memory.request', retrieve='retrieval'", None),
    ],
)
def test_names_given_to_compilation_are_those_that_productions_see(names: str, message: str | None) -> None:
    caught = warned(f"\ncompiling = PMCompile({names})", 1)
    assert caught == ([] if message is None else [(f"PMCompile.{message}", 11)])


def memory() -> Memory:
    return Memory(Buffer())


@pytest.mark.parametrize(
    ("make", "name"),
    [
        (lambda: DMNoise(memory()), "noize"),
        (lambda: DMSpreading(memory()), "wieght"),
        (lambda: DMBaseLevel(memory()), "limt"),
        (lambda: Partial(memory()), "strenth"),
        (lambda: PMNew(), "alpa"),
        (lambda: SOSVision(Buffer()), "dealy"),
        (lambda: actr.ImaginalModule(Buffer()), "dealy_sd"),
        (lambda: actr.Timer(), "startpuls"),
        (lambda: actr.BlendingMemory(Buffer()), "latancy"),
        (lambda: ACTR(), "production_tme"),
    ],
)
def test_every_kind_of_module_warns_and_still_takes_the_value(make: Callable[[], Any], name: str) -> None:
    module = make()
    with pytest.warns(ModelWarning, match=f"{type(module).__name__} has no parameter '{name}'; did you mean") as caught:
        setattr(module, name, 0.5)
    assert caught[0].filename == __file__
    assert getattr(module, name) == 0.5


def test_other_attributes_give_no_warning() -> None:
    for module, name in [(memory(), "note"), (memory(), "threshold"), (memory(), "thresholds"), (DMSpreading(memory()), "strength")]:
        setattr(module, name, 1)
    for name in ("production_times", "production_time_total", "production", "goal", "goal2"):
        setattr(ACTR(), name, 1)

    class Own(DMNoise):
        noises = 1

    Own(memory()).__dict__["noize"] = 1
    module: Any = Own(memory())
    module.noize = 2


def test_display_warns_where_it_is_called() -> None:
    with pytest.warns(ModelWarning, match="display.. opens no window here") as caught:
        display(None)
    assert caught[0].filename == __file__
    with pytest.warns(ModelWarning, match="opens no window") as caught:
        load_text("from actr3d.actr import *\n\ndisplay(Model())\n", "shown.py")
    assert [(w.filename, w.lineno) for w in caught] == [("shown.py", 3)]
