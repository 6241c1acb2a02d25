"""What modellers may write by mistake is refused clearly: requests, parameters, saliences, detectors of their own."""

from __future__ import annotations

import math
from collections.abc import Iterator
from random import Random
from typing import Any

import numpy as np
import pytest

from actr3d.actr.loading import run_text
from actr3d.camera import CameraParameters
from actr3d.errors import Actr3dError, ConfigurationError, ParameterError, VisionError
from actr3d.vision import DETECTORS, Emma, Vision
from actr3d.vision.request_parser import read_request
from actr3d.vision.salience import share, weigh
from actr3d.world import Aperture, Floor, Mannequin, Scene, World
from tests.helpers.small_agents import near
from tests.helpers.vision_scenes import AgentWithoutPhysics, agent

HEAD = """
import math
import numpy as np
from dataclasses import dataclass
from typing import Any
from actr3d.actr import *
from actr3d.vision import Feature, Label, Metres, Vision, detector

@dataclass(frozen=True, kw_only=True)
class Thing(Feature):
    width: Metres = 1.0
    flat: bool = True

class Text(Feature):
    side: Metres = 1.0
"""
LOOK = """
class Agent(ACTR):
    goal = Buffer()
    visual = Buffer()
    vision = Vision(visual)
    def init():
        goal.set("look")
    def look(goal="look"):
        goal.set("done")
        """


@pytest.fixture(autouse=True)
def registry() -> Iterator[None]:
    before = dict(DETECTORS)
    yield
    DETECTORS.clear()
    DETECTORS.update(before)


def lives(text: str) -> Any:
    world = World(Scene(parts=(Floor(), Aperture(width=0.6), Mannequin(name="walker"))))
    return AgentWithoutPhysics(world, agent(HEAD + text)).tick(12).agent


def asked(pattern: str = "feature:opening", **slots: Any) -> str:
    return read_request(pattern, slots, DETECTORS, {}, "vision").asked


@pytest.mark.parametrize(
    ("slots", "says"),
    [
        ({"left": [1]}, r"left takes a label, a whole number \(got \[1\]\)"),
        ({"left": None}, "left takes a label"),
        ({"left": "door"}, "left takes a label"),
        ({"left": 1.5}, "left takes a label"),
        ({"cut": "false"}, "cut takes True or False"),
        ({"cut": ">0"}, "cut cannot be compared by size"),
        ({"width": float("nan")}, "width is compared with a number in m"),
        ({"step": -0.1}, r"step: must be >= 0 \(got -0.1\)"),
        ({"step": float("inf")}, "step takes one number"),
    ],
)
def test_a_request_with_what_never_could_be_is_refused(slots: dict[str, Any], says: str) -> None:
    with pytest.raises(Actr3dError, match=says):
        asked(**slots)


def test_what_a_slot_is_asked_twice_is_refused_not_dropped() -> None:
    for pattern in ("feature:opening feature:obstacle", "feature:opening left:1 left:2", "feature:opening width:>1 width:<2"):
        with pytest.raises(VisionError, match="is given twice, in"):
            asked(pattern)
    with pytest.raises(Actr3dError, match=r"bearing: must be >= 0 \(got -5.0\)"):
        asked("feature:obstacle", bearing=-5)


def test_labels_of_numpy_and_infinite_bounds_are_meant_as_they_are() -> None:
    assert asked(left=np.int64(1), right=2.0) == "feature:opening left:1 right:2"
    assert asked(depth=">=inf", width=np.float32(0.5)) == "feature:opening depth:>=inf width:>=0.5"
    assert lives(LOOK + "vision.request('feature:opening', depth='>=inf', left=np.int64(1))").visual.chunk["width"] == 0.6


@pytest.mark.parametrize(
    ("line", "says"),
    [
        ("vision.request('feature:opening', bottom_up='no')", "bottom_up: must be True or False"),
        ("vision.rule = 'luck'", r"Vision\.rule: must be one of 'share', 'sos'"),
        ("vision.error_rate = 'often'", r"Vision\.error_rate: must be a number \(got 'often'\)"),
        ("vision.edge_noise = -1", r"Vision\.edge_noise: must be >= 0"),
        ("vision.gaze('left')", "gaze: left: must be a number"),
        ("vision.gaze(5, None)", "gaze: up: must be a number"),
        ("vision.gaze(10**400)", "gaze: left: must be a finite number"),
    ],
)
def test_mistakes_in_requests_are_reported_at_once(line: str, says: str) -> None:
    with pytest.raises(Actr3dError, match=says):
        lives(LOOK + line)


def test_a_gaze_may_be_text_as_variables_are() -> None:
    lives(LOOK + "vision.gaze('20', '-5')")


@pytest.mark.parametrize(
    "options",
    [
        {"delay": math.inf},
        {"delay": True},
        {"delay": 10**400},
        {"delay_sd": math.inf},
        {"hold": math.nan},
        {"edge_noise": 1e308},
        {"encoding": math.inf},
        {"encoding": 10**400},
        {"encoding": np.array([1, 2])},
        {"rule": np.array([1, 2])},
        {"saccades": "no"},
    ],
    ids=str,
)
def test_parameters_beyond_all_measure_are_refused(options: dict[str, Any]) -> None:
    with pytest.raises(ParameterError, match=rf"Vision\.{next(iter(options))}: must be"):
        Vision(None, **options)


def test_cameras_refuse_them_too() -> None:
    for options in ({"horizontal_fov": 10**400}, {"groups": np.array(1.0)}):
        with pytest.raises(ConfigurationError, match="must be"):
            CameraParameters(**options)  # type: ignore[arg-type]


def test_emma_stays_within_numbers() -> None:
    assert Emma(exponent=1e300).encoding(0.5) == 1e6
    assert Emma().course(math.radians(80))[0] < 0.5


def test_saliences_of_numpy_and_huge_ones_are_weighed() -> None:
    feature: Any = object()
    half: Any = np.float32(0.5)
    assert weigh([feature], lambda _: half, "it") == [0.5]
    with pytest.raises(VisionError, match="must return a number >= 0"):
        weigh([feature], lambda _: 10**400, "it")
    random = Random(1)
    drawn = [share([1e308] * 4 + [0.0], random) for _ in range(2000)]
    assert [drawn.count(i) / 2000 for i in range(5)] == near([0.25, 0.25, 0.25, 0.25, 0.0], abs=0.04)


# -- a modeller's detector


@pytest.mark.parametrize(
    ("returned", "says"),
    [
        ("None", r"must return the features that it has found, in a tuple \(got None\)"),
        ("(1,)", r"must return features of the class Thing \(got 1\)"),
        ("'abc'", "must return features of the class Thing"),
        ("(Thing(distance=1.0, direction=0.0, width='door'),)", r"width: must be a number \(got 'door'\)"),
        ("(Thing(distance=1.0, direction=0.0, width=view),)", "width: must be a number"),
        ("(Thing(distance=math.nan, direction=0.0),)", "distance: must be a number >= 0"),
        ("(Thing(distance=-1.0, direction=0.0),)", "distance: must be a number >= 0"),
        ("(Thing(distance=1.0, direction=None),)", "direction: must be a number"),
    ],
)
def test_no_text_no_thing_and_no_view_reaches_a_chunk_by_it(returned: str, says: str) -> None:
    text = f"@detector(Thing)\ndef things(view): return {returned}\n{LOOK}vision.request('feature:thing')"
    with pytest.raises(VisionError, match=f"detector 'thing': {says}"):
        lives(text)


@pytest.mark.parametrize("bottom_up", [False, True])
@pytest.mark.parametrize(("code", "kind"), [("(1,)", VisionError), ("1 / 0", ZeroDivisionError), ("things(view, 1)", TypeError)])
def test_an_error_of_it_names_the_production_and_the_line_that_asked(code: str, kind: type[Exception], bottom_up: bool) -> None:
    text = f"@detector(Thing)\ndef things(view): return {code}\n{LOOK}vision.request('feature:thing', bottom_up={bottom_up})\n"
    with pytest.raises(kind) as caught:
        lives(text)
    line = (HEAD + text).split("\n").index('        goal.set("done")') + 2
    assert f"  requested by 'walker.vision' in production 'look' (looking.py:{line})" in caught.value.__notes__
    if isinstance(caught.value, Actr3dError):
        assert caught.value.location == ("looking.py", line)


def test_what_numpy_gives_comes_as_plain_rounded_numbers() -> None:
    text = "@detector(Thing)\ndef things(view): return [Thing(distance=np.float32(1.23456), direction=0, flat=np.bool_(True))]\n"
    chunk = dict(lives(text + LOOK + "vision.request('feature:thing')").visual.chunk)
    assert chunk == {"feature": "thing", "distance": 1.235, "direction": 0.0, "width": 1.0, "flat": True}
    assert {type(value) for value in chunk.values()} == {str, float, bool}


def test_parameters_need_no_unit() -> None:
    text = "@detector(Thing)\ndef things(view, *, most=0.1): return (Thing(distance=most, direction=0.0),)\n"
    assert lives(text + LOOK + "vision.request('feature:thing', most=2)").visual.chunk["distance"] == 2.0


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("@detector(Text)\ndef texts(view): return ()\n", "'side' is not a field; write @dataclass"),
        ("@detector(Thing)\ndef things(view, *, width: Metres = 1.0): return ()\n", "'width' is reserved in requests"),
        ("@detector(Thing)\ndef things(view, *, bottom_up: Metres = 1.0): return ()\n", "'bottom_up' is reserved in requests"),
    ],
)
def test_words_that_requests_could_not_reach_are_refused(text: str, says: str) -> None:
    with pytest.raises(VisionError, match=says):
        lives(text)


@pytest.mark.parametrize("field", ["size", "key", "elevation", "slots", "shown", "called", "salience", "since", "at_most", "self"])
def test_a_field_cannot_have_the_name_of_something_that_every_feature_has(field: str) -> None:
    text = f"@dataclass(frozen=True, kw_only=True)\nclass Odd(Feature):\n    {field}: Metres\n@detector(Odd)\ndef odd(view): return ()\n"
    with pytest.raises(VisionError, match=f"^detector 'odd': '{field}' is reserved in features; use another name"):
        lives(text)


def test_it_may_stand_below_the_agent() -> None:
    text = "@detector(Thing)\ndef things(view): return (Thing(distance=2.0, direction=0.0, width=0.5),)\n"
    found = lives(f"{LOOK}vision.request('feature:thing', width='>0.3')\n{text}")
    assert found.visual.chunk["width"] == 0.5


def test_a_detector_of_a_known_name_that_is_registered_later_does_not_replace_it() -> None:
    text = "@detector(Thing)\ndef things(view): return (Thing(distance=DISTANCE, direction=0.0),)\n"
    first = agent(HEAD + text.replace("DISTANCE", "1.0") + LOOK + "vision.request('feature:thing')")
    agent(HEAD + text.replace("DISTANCE", "2.0") + LOOK + "vision.request('feature:thing')")
    world = World(Scene(parts=(Floor(), Mannequin(name="walker"))))
    assert AgentWithoutPhysics(world, first).tick(12).agent.visual.chunk["distance"] == 1.0


def agent_of_program(text: str) -> Any:
    return vars(run_text(text))["Agent"]


@pytest.mark.parametrize("load", [agent, agent_of_program])
def test_a_detector_below_the_agent_replaces_one_that_an_earlier_text_has_defined(load: Any) -> None:
    text = LOOK + "vision.request('feature:thing')\n@detector(Thing)\ndef things(view): return (Thing(distance=DISTANCE, direction=0.0),)\n"
    world = World(Scene(parts=(Floor(), Mannequin(name="walker"))))
    for distance in (1.0, 2.0):
        made = load(HEAD + text.replace("DISTANCE", str(distance)))
        assert AgentWithoutPhysics(world, made).tick(12).agent.visual.chunk["distance"] == distance


POLE = """
@dataclass(frozen=True, kw_only=True)
class Pole(Feature):
    w: FIELD
@detector(Pole)
def poles(view, *, most: MOST = 1): return ()
"""


@pytest.mark.parametrize(
    ("field", "most", "place"),
    [("'Meters'", "Metres", "Pole.w"), ("Metres", "'Meters'", r"poles\(most\)"), ("'list[Meters]'", "int", "Pole.w")],
)
def test_an_unknown_type_is_named_with_its_place_in_the_detector(field: str, most: str, place: str) -> None:
    with pytest.raises(VisionError, match=rf"^detector: {place}: name 'Meters' is not defined; did you mean 'Metres'\?"):
        lives(f"{POLE.replace('FIELD', field).replace('MOST', most)}{LOOK}vision.request('feature:pole', most=2)")


def test_salience_and_encoding_set_later_count_and_are_checked() -> None:
    def seven(feature: Any) -> float:
        return 7.0

    vision = Vision(None)
    vision.salience = {"opening": seven}
    vision.encoding = 0.085
    assert vision._saliences["opening"](None) == 7.0
    assert vision._encoding == 0.085
    with pytest.raises(ParameterError, match=r"Vision\.encoding: must be a time"):
        vision.encoding = "em"
    with pytest.raises(ParameterError, match="no feature 'openin'; did you mean 'opening'"):
        vision.salience = {"openin": "size"}
    assert vision.encoding == 0.085


def test_a_camera_that_is_set_later_is_refused() -> None:
    with pytest.raises(ParameterError, match=r"Vision.rows: a camera cannot be changed; set it in Vision\(rows=...\)"):
        Vision(None).rows = 50
