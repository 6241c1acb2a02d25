"""What a model file says of itself, read from its text alone."""

from __future__ import annotations

import json
from dataclasses import asdict, replace

import pytest

from actr3d import world
from actr3d.actr.kernel.run_limits import RunLimits
from actr3d.configuration import Live
from actr3d.errors import ConfigurationError
from actr3d.runner.model_factory import Blueprint
from tests.helpers.paths import MODELS
from workbench.loader import listing_of, misplaced_in, misspelt_in, problems_of, undefined_in

MODEL = '''"""Walks.

More of it."""
from dataclasses import dataclass
from typing import Annotated, Literal, Optional
import annotated_types as at
from annotated_types import Gt, Le
from actr3d.actr import *
from actr3d.configuration import Configuration, Live
from actr3d.simulation import Simulation

raise SystemExit("this runs nothing")
WIDEST = 3
START = (1.0, 2.0)

@dataclass(frozen=True, kw_only=True)
class Parameters(Configuration):
    """What may be set."""

    width: Annotated[float, Gt(0), Le(WIDEST), Live("aperture")] = 0.5
    """The free width of the doorway [m]."""
    speed: Annotated[float | None, at.Ge(0.1), Live("parameter", "walker.speed", body=None)] = None
    """How fast [m/s];
    None for standing."""
    side: Literal["left", "right"] = "left"
    steps: "int" = 3
    loud: bool = False
    name: str = "x"
    start: tuple[float, float] = START
    made: float = 2 * 3
    must: float
    maybe: Optional[int] = 1

class Walker(ACTR):
    goal = Buffer()
    def init(): ...
    def go(goal="go"): ...
    def helper(self): ...

def build(parameters: Parameters) -> Simulation: ...
'''


def test_the_parameters_of_what_a_file_builds() -> None:
    listing = listing_of(MODEL)
    assert (listing.title, listing.kind, listing.problems) == ("Walks.", "simulation", ())
    assert listing.text.endswith("More of it.")
    assert listing.productions == ("Walker.go",)
    width = listing.parameter("width")
    assert (width.takes, width.default, width.above, width.most, width.unit) == ("number", 0.5, 0, 3, "m")
    assert (width.help, width.line) == ("The free width of the doorway [m].", 20)
    assert width.live == Live("aperture")
    speed = listing.parameter("speed")
    assert (speed.takes, speed.default, speed.optional, speed.least, speed.unit) == ("number", None, True, 0.1, "m/s")
    assert speed.help == "How fast [m/s]; None for standing."
    assert speed.live == Live("parameter", "walker.speed")
    assert listing.parameter("side").choices == ("left", "right")
    takes = {parameter.name: parameter.takes for parameter in listing.parameters}
    assert takes == {
        "width": "number",
        "speed": "number",
        "side": "choice",
        "steps": "whole number",
        "loud": "switch",
        "name": "text",
        "start": "tuple[float, float]",
        "made": "number",
        "must": "number",
        "maybe": "whole number",
    }
    assert listing.parameter("start").default == (1.0, 2.0)
    assert (listing.parameter("made").default, listing.parameter("made").known) == ("2 * 3", False)
    assert not listing.parameter("must").known
    assert listing.parameter("maybe").optional


def test_the_parameters_of_a_program_are_its_first_lines() -> None:
    listing = listing_of((MODELS / "tutorial" / "counting.py").read_text(encoding="utf-8"))
    assert listing.kind == "program"
    assert {parameter.name: parameter.default for parameter in listing.parameters} == {"first": 2, "last": 6, "latency_factor": 0.05}
    assert "Counting.count_on" in listing.productions
    (counting,) = listing.agents
    assert [(part.name, part.made_by) for part in counting.parts] == [("goal", "Buffer"), ("retrieval", "Buffer"), ("memory", "Memory")]


def test_every_model_is_listed_without_complaint() -> None:
    for path in sorted(MODELS.rglob("*.py")):
        text = path.read_text(encoding="utf-8")
        listing = listing_of(text, path.name)
        assert (listing.problems, [*undefined_in(text), *misplaced_in(text), *misspelt_in(text)]) == ((), [])
        assert listing.title


@pytest.mark.parametrize(
    ("text", "line", "message"),
    [
        ("x = 1\ny = (\n", 2, "was never closed"),
        ("print 'so'", 1, "Python 2"),
        ("a\0b", 1, "NUL"),
        ("x = '\ud800'", None, "not Python source"),
        (
            "\ndef build():\n    return 3\n",
            2,
            "build must be declared to return a Simulation (got `def build()`, without a return type); write `def build(",
        ),
        ("async def build() -> Simulation: ...", 1, "build is an async function"),
    ],
)
def test_errors_are_reported_with_their_line(text: str, line: int | None, message: str) -> None:
    (problem,) = listing_of(text).problems
    assert (problem.level, problem.line) == ("error", line)
    assert message in problem.message


def test_warnings_of_compiling_are_reported() -> None:
    (problem,) = listing_of("def f():\n    return 1 is 1\n").problems
    assert (problem.level, problem.line) == ("warning", 2)


@pytest.mark.parametrize(
    ("name", "value", "message"),
    [
        ("width", 0, "must be > 0"),
        ("width", 3.1, "must be <= 3"),
        ("width", "wide", "must be a number"),
        ("width", True, "must be a number"),
        ("width", None, "must be a number"),
        ("width", float("nan"), "must be a number"),
        ("speed", 0.01, "must be >= 0.1"),
        ("side", "up", "one of 'left', 'right'"),
    ],
)
def test_values_are_held_to_the_bounds(name: str, value: object, message: str) -> None:
    with pytest.raises(ConfigurationError, match=message):
        listing_of(MODEL).parameter(name).check(value)


def test_good_values_pass() -> None:
    listing = listing_of(MODEL)
    for name, value in (("width", 3), ("speed", None), ("speed", 0.1), ("side", "right")):
        listing.parameter(name).check(value)
    with pytest.raises(ConfigurationError, match="did you mean 'width'"):
        listing.parameter("widht")


@pytest.mark.parametrize(
    "field",
    [
        "x: Annotated[()] = 1",
        "x: Optional[()] = 1",
        "x: None | None = 1",
        "x: 'float | (' = 1",
        "x: Annotated['float | (', Gt(0)] = 1",
        "x: '' = 1",
        "x: Literal[None, unknown] = 1",
        "x: float = 1e999",
        "x: Annotated[float, Le(1e999)] = 1",
        "x: tuple = (1, [2j])",
        "x: tuple = [...]",
        "x: dict = {(1, 2): 3}",
        "x: str = '\\ud800'",
        "x: List['\\ud800'] = 1",
        "x: int = 1\n    '\\ud800'",
    ],
)
def test_an_unfinished_text_is_always_described(field: str) -> None:
    text = f"'\\ud800'\nLIMIT = 1e999\nclass P:\n    {field}\ndef build(p: P) -> Simulation: ...\n"
    for source in (text, text.partition("class")[0]):
        told = listing_of(source)
        json.dumps(asdict(told), allow_nan=False, ensure_ascii=False).encode()
        assert told.title == r"\ud800"
    assert [one.name for one in listing_of(text).parameters] == ["x"]


@pytest.mark.parametrize("name", ["doorway.py", "aperture_passage.py"])
def test_parameters_read_from_a_text_are_those_of_the_loaded_model(name: str) -> None:
    source = (MODELS / name).read_text(encoding="utf-8")
    with RunLimits(seed=1):
        fields = Blueprint(source, name, MODELS).fields
    told = listing_of(source, name).parameters
    assert [replace(one, line=0) for one in told] == list(fields)
    assert [one.name for one in told if one.live == Live("aperture")] == [told[0].name if name == "doorway.py" else "aperture"]


@pytest.mark.parametrize(
    ("text", "found"),
    [
        ("from actr3d.actr import *\nclass A(ACTR):\n    memory = Mem\n", [(3, "nothing defines 'Mem'; did you mean 'Memory'?")]),
        (
            "class A:\n    x = 1\n    y: 'Later' = x\n    def f(self, z=x): return whatever\nprint([n for n in range(A.y)])\n",
            [],
        ),
        ("from actr3d.world import Floor, Walls\n", [(1, "actr3d.world has no 'Walls'; did you mean 'Wall'?")]),
        ("from actr3d.world import Block\n", [(1, f"actr3d.world has no 'Block'; it has: {', '.join(vars(world)['__all__'])}")]),
        ("try:\n    from actr3d.world import Block\nexcept ImportError:\n    Block = None\n", []),
        ("@qqq\ndef f(a=zzz): pass\nf(lambda: nothing)\n", [(1, "nothing defines 'qqq'"), (2, "nothing defines 'zzz'")]),
        ("from elsewhere import *\nAgent().run()\n", []),
        ("exec('x = 1')\nprint(x)\n", []),
        ("class A:\n", None),
    ],
)
def test_names_that_nothing_defines_are_found_where_a_text_is_executed_first(text: str, found: list[tuple[int, str]] | None) -> None:
    problems = [(problem.line, problem.message) for problem in (*problems_of(text), *undefined_in(text))]
    if found is None:
        assert not any("nothing defines" in message for _, message in problems)
    else:
        assert problems == found


def test_a_production_inside_another_method_is_found_while_its_text_is_written() -> None:
    head = "class Agent(ACTR):\n    goal = Buffer()\n    def first(goal='a'):\n        goal.set('b')\n"
    text = f"{head}        def second(goal='b'):\n            goal.clear()\n"
    message = "production 'first': 'second' is inside it, and therefore no production; it needs the indentation of 'first'"
    assert [(problem.line, problem.message) for problem in misplaced_in(text)] == [(5, message)]
    beside = "    def second(goal='b'):\n        goal.clear()\n"
    for other in ("        def second(goal): pass\n", "        def second(much='b'): pass\n", beside):
        assert list(misplaced_in(head + other)) == []
    assert list(misplaced_in("class A:\n")) == []


SEEING = """from actr3d.actr import *
from actr3d.vision import Feature, Vision, detector

class Pole(Feature):
    thickness: float

class Walker(ACTR):
    goal = Buffer()
    visual = Buffer()
    vision = Vision(visual)
    body = BodyPort()
"""
FAR = "no chunk of the feature 'obstacle' has a slot 'distanse'; did you mean 'distance'?"
SIDE = "no chunk of the feature 'obstacle' has a slot 'leftmos'; did you mean 'leftmost'?"
THICK = "no chunk of the feature 'pole' has a slot 'thicknes'; did you mean 'thickness'?"
FOUND = "nothing finds a feature 'obstacel'; did you mean 'obstacle'?"
TURN = "no body has a command 'trun'; did you mean 'turn'?"
POSE = "no body has a sense 'poze'; did you mean 'pose'?"
NEAR = "no request for the feature 'obstacle' takes 'distnce'; did you mean 'distance'?"
WHERE = "no request for the feature 'obstacle' takes 'bearng'; did you mean 'bearing'?"


@pytest.mark.parametrize(
    ("method", "found"),
    [
        ("def p(visual='feature:obstacle leftmos:?left'): pass", [(12, f"production 'p': {SIDE}")]),
        (
            "def p(goal='a',\n        visual=['feature:obstacle', 'leftmos:?x distanse:!3']): pass",
            [(13, f"production 'p': {SIDE}"), (13, f"production 'p': {FAR}")],
        ),
        ("def p(visual='feature:pole thicknes:?t'): pass", [(12, f"production 'p': {THICK}")]),
        ("def p(visual='feature:obstacel'): pass", [(12, f"production 'p': {FOUND}")]),
        ("def p(goal='a'):\n        vision.request('feature:obstacel width:>2', distance='<3')", [(13, FOUND)]),
        ("def look(self):\n        self.vision.request('feature:obstacel')", [(13, FOUND)]),
        ("def p(goal='a'):\n        body.set('trun', 30)", [(13, TURN)]),
        ("def p(goal='a'):\n        body.request('poze')\n        body.get('poze')", [(13, POSE), (14, POSE)]),
        ("def p(goal='a'):\n        vision.request('feature:obstacle distnce:<2')", [(13, NEAR)]),
        ("def p(goal='a'):\n        vision.request('feature:obstacle',\n            bearng=30)", [(14, WHERE)]),
        (
            "eyes = Eyes()\nclass Eyes(ProductionSystem):\n    def p(visual='feature:obstacle leftmos:?l'): pass",
            [(14, f"production 'p': {SIDE}")],
        ),
    ],
)
def test_misspelt_words_of_the_library_are_found_while_a_text_is_written(method: str, found: list[tuple[int, str]]) -> None:
    assert [(problem.line, problem.message) for problem in misspelt_in(f"{SEEING}    {method}\n")] == found


@pytest.mark.parametrize(
    "method",
    [
        "def p(visual='feature:pole thickness:?t distance:?d motion:!?t'): pass",
        "def p(visual='feature:!obstacle leftmost:?l ?l:1'): pass",
        "def p(visual='feature:', goal='leftmos:?l'): pass",
        "def p(visual=f'feature:obstacel{1}'): pass",
        "def p(visual=None, vision='busy:False'): pass",
        "def p(visual='obstacel leftmos'): pass",
        "def p(goal='a'):\n        visual.set('feature:obstacel leftmos:1')\n    def q(visual='feature:obstacel leftmos:?l'): pass",
        "def p(goal='a'):\n        body.set('turn', 30)\n        body.set(trun)\n        goal.set('trun')",
        "reading = BodyPort(visual)\n    def p(visual='feature:obstacle leftmos:?l'): pass",
        "def p(goal='a'):\n        body.set('trun', 30)\n@actuator\ndef trun(body, angle): pass",
        "def p(goal='a'):\n        vision.request('feature:obstacle distance:<2', bearing=30, bottom_up=True)",
        "def p(goal='a'):\n        body.request('pose')",
        "def p(goal='a'):\n        body.request('poze')\n@sensor\ndef poze(body): pass",
        "def p(goal='a'):\n        vision.request('feature:pole bearng:30')\n@detector\ndef poles(view, bearng=1): pass",
        "def helper(self, visual): visual.request('feature:obstacel')\n    def p(",
    ],
)
def test_words_that_may_be_meant_are_not_called_misspelt(method: str) -> None:
    assert list(misspelt_in(f"{SEEING}    {method}\n")) == []


def test_only_the_vision_of_embodied_agents_finds_features() -> None:
    text = f"{SEEING}    def p(visual='feature:obstacle leftmos:?left'): pass\n"
    assert len([*misspelt_in(text)]) == 1
    assert list(misspelt_in(text.replace("Feature, Vision, detector", "Feature"))) == []


def test_a_text_with_very_many_classes_is_not_searched_for_misspelt_words() -> None:
    text = f"{SEEING}    def p(visual='feature:obstacle leftmos:?left'): pass\n"
    assert len([*misspelt_in(text + "class Other: pass\n" * 50)]) == 1
    assert list(misspelt_in(text + "class Other: pass\n" * 5000)) == []
