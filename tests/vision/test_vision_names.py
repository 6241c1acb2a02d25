"""Misspelt features and slots in patterns are warned of when the agent begins."""

from __future__ import annotations

import warnings
from typing import Any

import pytest

from actr3d.actr.loading import load_text
from actr3d.errors import ModelWarning
from actr3d.vision import DETECTORS

HEAD = """from actr3d.actr import *
from actr3d.vision import Feature, Metres, Vision, detector
class Agent(ACTR):
    goal, visual = Buffer(), Buffer()
    vision = Vision(visual)
"""
POLE = """from dataclasses import dataclass
from actr3d.vision import Feature, Metres, detector
@dataclass(frozen=True, kw_only=True)
class Pole(Feature):
    thickness: Metres
@detector(Pole)
def pole(view): return ()
"""


def warned(body: str, head: str = HEAD) -> list[tuple[str, int]]:
    """Returns the warnings about an agent with these methods, with the line (the first line of the body is 6)."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        agent: Any = load_text(head + "\n".join("    " + line for line in body.splitlines()), "seeing.py").Agent()
        agent.run(0.0)
    assert all(one.category is ModelWarning and one.filename == "seeing.py" for one in caught)
    return [(str(one.message), one.lineno) for one in caught]


@pytest.mark.parametrize(
    ("pattern", "message"),
    [
        ("feature:obstacle leftmos:?left", "no chunk of the feature 'obstacle' has a slot 'leftmos'; did you mean 'leftmost'?"),
        ("feature:opening leftmost:?side", "no chunk of the feature 'opening' has a slot 'leftmost'; did you mean 'left'?"),
        ("feature:obstacle distanse:!3", "no chunk of the feature 'obstacle' has a slot 'distanse'; did you mean 'distance'?"),
        ("feature:?what distanse:?far", "no chunk of a feature has a slot 'distanse'; did you mean 'distance'?"),
        ("feature:!opening leftmos:!?far", "no chunk of a feature has a slot 'leftmos'; did you mean 'leftmost'?"),
        ("feature:obstacel", "nothing finds a feature 'obstacel'; did you mean 'obstacle'?"),
        ("feature:!obstacel", "nothing finds a feature 'obstacel'; did you mean 'obstacle'?"),
    ],
)
def test_a_misspelt_name_in_the_pattern_of_a_feature_is_warned_of_at_its_line(pattern: str, message: str) -> None:
    body = f"def aside(goal='?far',\n          visual='{pattern}'): goal.clear()"
    assert warned(body) == [(f"production 'aside': {message}", 7)]


def test_a_variable_of_a_misspelt_slots_own_name_does_not_hide_it() -> None:
    message = "no chunk of the feature 'obstacle' has a slot 'distanse'; did you mean 'distance'?"
    body = "def near(visual='feature:obstacle distanse:?distanse'): print(distanse)"
    assert warned(body) == [(f"production 'near': {message}", 6)]
    assert len(warned(f'def init():\n    """Sees the distanse."""\n{body}')) == 1
    assert len(warned(f"def look(goal='look'):\n    vision.request('feature:obstacle', distanse='>1')\n{body}")) == 1


@pytest.mark.parametrize(
    "body",
    [
        "def p(visual='feature:obstacle leftmost:?l rightmost:!?l aside:!1 motion:?m'): pass",
        "def p(visual='feature:opening left:?l right:?r depth:?d'): pass",
        "def p(visual='feature:!obstacle feature:?what leftmost:?l'): pass",
        "def p(goal='leftmos:?l'): pass",
        "def p(visual='feature:obstacle ?slot:?l', goal='slot:?slot'): pass",
        "def p(visual=None): pass",
        "def p(visual='obstacel leftmos'): pass",
        "def p(visual='feature:obstacle colour:?c'): pass",
        "def init():\n    visual.set('feature:obstacel leftmos:3')\ndef p(visual='feature:obstacel leftmos:?l'): pass",
        "def p(goal='mark'):\n    visual.modify(leftmos=3)\ndef q(visual='feature:obstacle leftmos:?l'): pass",
        "def p(goal='mark'):\n    visual.modify(**{'leftmos': 3})\ndef q(visual='feature:obstacle leftmos:?l'): pass",
        "def mark(self, kind='obstacel'):\n    self.visual.set(f'feature:{kind}')\ndef q(visual='feature:obstacel'): pass",
    ],
)
def test_names_that_a_chunk_may_have_give_no_warning(body: str) -> None:
    assert [found for found in warned(body) if "feature" in found[0] or "finds" in found[0]] == []


def test_the_slots_of_a_detector_in_the_model_file_are_known() -> None:
    head = POLE + HEAD
    try:
        body = "def p(visual='feature:pole thickness:?t distance:?d'): pass\ndef q(visual='feature:pole thicknes:?t'): pass"
        message = "production 'q': no chunk of the feature 'pole' has a slot 'thicknes'; did you mean 'thickness'?"
        assert warned(body, head) == [(message, 14)]
    finally:
        del DETECTORS["pole"]


def test_a_buffer_that_other_modules_fill_too_may_have_other_slots() -> None:
    head = HEAD.replace("    vision", "    memory = Memory(visual)\n    vision")
    assert warned("def p(visual='feature:obstacle leftmos:?l'): pass", head) == []


def test_a_buffer_of_the_agent_is_checked_in_the_productions_of_its_parts() -> None:
    head = HEAD.replace("class Agent", "class Part(ProductionSystem):\n    def p(visual='feature:obstacle leftmos:?l'): pass\nclass Agent")
    assert [line for _, line in warned("part = Part()", head)] == [4]
