"""What holds for every detector, those of models included; and obstacles."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import FrozenInstanceError, dataclass, fields, replace
from typing import Any

import numpy as np
import pytest

from actr3d.camera import GeometricCamera, View
from actr3d.errors import VisionError
from actr3d.vision import DETECTORS, Detector, Feature, Obstacle, detector
from actr3d.vision.detectors.obstacle import obstacle
from actr3d.vision.request_parser import read_request
from actr3d.world import Aperture, Floor, Mannequin, Scene, SimpleObject, World
from tests.helpers.camera_scenes import compiled, seen
from tests.helpers.small_agents import near
from tests.helpers.vision_scenes import AgentWithoutPhysics, agent, doorway, found, pole, wall

SCENE = doorway(4.0, 0.8) + pole("post", 2.0, 0.5) + wall("far", 8.0, 4.0, -4.0)
EYES: list[dict[str, Any]] = [
    {},
    {"rows": 1},
    {"rows": 7, "vertical_fov": 0.2},
    {"horizontal_fov": 3.0},
    {"horizontal_fov": 0.05},
    {"retinotopic": True},
    {"retinotopic": True, "e2": 0.1, "rows": 33},
    {"range": 3.0},
    {"near": 3.0},
    {"background": ()},
]


@pytest.fixture(params=list(DETECTORS))
def every(request: pytest.FixtureRequest) -> Detector:
    """Returns each detector in turn."""
    return DETECTORS[request.param]


def told(features: tuple[Feature, ...]) -> list[dict[str, Any]]:
    return [feature.slots() for feature in features]


@pytest.mark.parametrize("options", EYES, ids=str)
def test_a_detector_copes_with_every_eye_and_gives_numbers(every: Detector, options: dict[str, Any]) -> None:
    _, view = seen(SCENE + '<geom type="plane" size="0 0 1"/>', **options)
    for feature in every(view):
        assert isinstance(feature, every.finds)
        for name, value in feature.slots().items():
            assert name == "feature" or isinstance(value, (int, float, bool))
            assert not (isinstance(value, float) and math.isnan(value))
        assert feature.distance >= 0
        assert abs(feature.direction) <= math.pi


def test_a_detector_finds_nothing_in_nothing(every: Detector) -> None:
    assert every(seen("")[1]) == ()


@pytest.mark.daily(1)
def test_a_detector_reads_the_view_only_and_leaves_it_alone(every: Detector) -> None:
    _, view = seen(SCENE)
    copy = View(view.parameters, view.extents.copy(), view.axes.copy())
    before = view.extents.tobytes()
    first = every(view)
    assert view.extents.tobytes() == before
    assert first == every(copy) == every(view)
    assert first
    with pytest.raises(FrozenInstanceError):
        first[0].distance = 0.0  # type: ignore[misc]


def test_names_are_nothing_to_a_detector(every: Detector) -> None:
    renamed = SCENE.replace('"a"', '"zz"').replace('"post"', '"door"').replace('"far"', '"aa"')
    features = told(every(seen(SCENE)[1]))
    assert features
    assert features == told(every(seen(renamed)[1]))


def test_labels_change_nothing_but_themselves(every: Detector) -> None:
    """With other labels, features have those, and all else is the same."""
    _, view = seen(SCENE)
    others = np.array([0, 9, 4, 7, 11, 8, 5])
    extents = view.extents.copy()
    extents["label"] = others[extents["label"]]
    labels = {name for name in (field.name for field in fields(every.finds)) if name in ("left", "right", "above", "below", "object")}

    def relabelled(feature: Feature) -> Feature:
        return replace(feature, **{name: int(others[getattr(feature, name)]) for name in labels})

    expected = {relabelled(feature) for feature in every(view)}
    assert set(every(replace(view, extents=extents))) == expected


def test_whatever_noise_makes_of_a_view_is_no_error(every: Detector) -> None:
    _, view = seen(SCENE, rows=20)
    names: set[str] = set()
    for seed in range(50):
        noise = np.random.default_rng(seed)
        noisy = view.with_noise({"x1": 0.2, "x2": 0.2, "d1": 3.0, "d2": 3.0}, noise)
        names |= {feature.slots()["feature"] for feature in every(noisy)}
    assert names == {every.name}


# -- obstacles


def nearest(features: tuple[Any, ...]) -> Obstacle:
    return min(features, key=lambda feature: feature.distance)


def test_a_wall_is_as_near_as_the_way_to_it() -> None:
    one = nearest(found("obstacle", wall("a", 3.05, 5.0, -5.0)))
    assert (one.distance, one.direction) == (near(3.0), near(0.0))
    assert one.width == near(6.0)  # as far as the eye sees
    assert (one.leftmost, one.rightmost) == (near(math.radians(45)), near(-math.radians(45)))


@pytest.mark.parametrize("height", [0.3, 1.0, 2.4])
def test_distances_are_on_the_ground(height: float) -> None:
    box = f'<body pos="2.1 0 {height}"><geom type="box" size="0.1 0.3 0.1"/></body>'
    one = nearest(found("obstacle", box, vertical_fov=2.0))
    assert one.distance == near(2.0, abs=1e-6)
    assert one.top == near(height + 0.1 - 1.5, abs=0.06)


def test_any_number_of_objects_is_found() -> None:
    posts = "".join(pole(f"p{n}", 5.0, (n - 35) / 8) for n in range(70))
    assert sorted(one.object for one in found("obstacle", posts)) == list(range(1, 71))
    assert len([one for one in found("opening", posts) if one.height > 1]) == 69


@pytest.mark.parametrize("radius", [0.05, 0.4])
def test_what_is_round_is_as_near_as_its_nearest_side(radius: float) -> None:
    for x, y in ((1.5, 0.0), (3.0, -1.2)):
        away = math.hypot(x, y) - radius
        post = nearest(found("obstacle", pole("p", x, y, radius)))
        assert (post.distance, post.direction) == (near(away, abs=1e-3), near(math.atan2(y, x), abs=0.02))
        ball = nearest(found("obstacle", f'<body pos="{x} {y} 1.4"><geom type="sphere" size="{radius}"/></body>'))
        assert ball.distance == near(away, abs=5e-3)


@pytest.mark.parametrize("turned", [10, 45, 80])
def test_a_box_is_as_near_as_its_nearest_corner(turned: float) -> None:
    box = f'<body pos="2 0.1 0.9" euler="0 0 {turned}"><geom type="box" size="0.3 0.3 0.9"/></body>'
    c, s = math.cos(math.radians(turned)), math.sin(math.radians(turned))
    corners = [(2 + 0.3 * (a * c - b * s), 0.1 + 0.3 * (a * s + b * c)) for a in (1, -1) for b in (1, -1)]
    assert nearest(found("obstacle", box)).distance == near(min(math.hypot(*corner) for corner in corners), abs=1e-3)


def test_a_post_that_bulges_into_a_doorway_is_in_the_way() -> None:
    free = found("opening", doorway(3.0, 1.2) + pole("p", 3.9, 0.0, radius=0.45, height=2.5))
    assert max(opening.depth for opening in free if opening.width > 1 and opening.height > 1) == near(3.9 - 0.45 - 3.1, abs=0.01)
    blocked = found("opening", doorway(3.0, 1.2) + pole("p", 3.35, 0.0, radius=0.45, height=2.5))
    assert not [opening for opening in blocked if opening.width > 1]


def test_a_bearing_bounds_where_it_is_looked() -> None:
    _, view = seen(wall("a", 3.05, 5.0, 0.6) + pole("p", 2.0, -1.0))
    for degrees, expected in ((5, []), (20, [1]), (60, [2, 1])):
        some: list[Any] = sorted(obstacle(view, bearing=math.radians(degrees)), key=lambda one: one.distance)
        assert [one.object for one in some] == expected
    (aside,) = obstacle(view, bearing=math.radians(20))
    assert aside.distance == near(math.hypot(3.0, 0.6), abs=1e-3)
    assert aside.aside == near(0.6, abs=1e-3)


def test_an_eye_that_looks_back_over_the_shoulder_knows_where_ahead_is() -> None:
    mj_model, mj_data = compiled(wall("a", 0.0, 3.0, 2.9), eye='<site name="eye" pos="0 0 1.5" euler="0 0 90"/>')
    view = GeometricCamera(mj_model, site="eye").look(mj_data, heading=-math.radians(30))
    (one,) = obstacle(view, bearing=math.radians(130))
    assert one.direction == near(math.radians(120), abs=0.02)
    assert obstacle(view, bearing=math.radians(100)) == ()
    assert obstacle(view, bearing=math.radians(80)) == ()


def test_the_time_to_contact_follows_from_the_speed() -> None:
    one = nearest(found_with(1.5))
    assert one.time_to_contact == near(2.0)
    assert nearest(found_with(None)).time_to_contact is None
    assert nearest(found_with(0.0)).time_to_contact is None


def found_with(speed: float | None) -> tuple[Any, ...]:
    return obstacle(seen(wall("a", 3.05, 5.0, -5.0))[1], speed=speed)


# -- a modeller's own


OWN = """
from dataclasses import dataclass
from actr3d.actr import *
from actr3d.vision import Feature, Label, Metres, Vision, detector

@dataclass(frozen=True, kw_only=True)
class Thin(Feature):
    width: Metres
    object: Label

@detector(Thin)
def thin(view, *, most: Metres = 0.1):
    from actr3d.vision import DETECTORS
    return tuple(
        Thin(distance=one.distance, direction=one.direction, width=one.width, object=one.object)
        for one in DETECTORS["obstacle"](view) if one.width <= most
    )

class Agent(ACTR):
    visual = Buffer()
    vision = Vision(visual)
    def look(vision="busy:False", visual=None):
        vision.request("feature:thin", most=0.05, width=">0.01")
"""


@pytest.fixture
def registry() -> Iterator[None]:
    before = dict(DETECTORS)
    yield
    DETECTORS.clear()
    DETECTORS.update(before)


@pytest.mark.usefixtures("registry")
def test_a_model_can_define_a_detector() -> None:
    stick = SimpleObject(name="stick", shape="cylinder", size=(0.015, 1.9), position=(3.0, 0.0, 0.95), mass=None)
    world = World(Scene(parts=(Floor(), Aperture(), stick, Mannequin(name="walker"))))
    kind = agent(OWN)
    seeing = AgentWithoutPhysics(world, kind).tick(12).agent
    assert seeing.visual.chunk["feature"] == "thin"
    assert seeing.visual.chunk["width"] == near(0.03, abs=0.001)
    agent(OWN)  # loaded again, it takes its own place
    assert DETECTORS["thin"].parameters == ("most",)


@pytest.mark.usefixtures("registry")
def test_a_plain_number_is_compared_as_a_number() -> None:
    @dataclass(frozen=True, kw_only=True)
    class Sign(Feature):
        score: float

    @detector(Sign)
    def signs(view: View) -> tuple[Sign, ...]:
        return ()

    sign = Sign(distance=1.0, direction=0.0, score=2.0)
    for wanted, passes in (("2.0", True), ("2", True), ("!2.0", False), ("2.5", False), (2, True), (2.0, True), ("!two", True)):
        query = read_request("feature:sign", {"score": wanted}, DETECTORS, {}, "vision")
        assert (query.failing(sign) is None) == passes, wanted


@pytest.mark.usefixtures("registry")
def test_what_is_no_detector_is_refused() -> None:
    class Opening(Feature):
        """As the library's."""

    class Odd(Feature):
        """Anything."""

    def fits(view: Any) -> tuple[()]:
        return ()

    def nothing() -> tuple[()]:
        return ()

    def needs_more(view: Any, most: float) -> tuple[()]:
        return ()

    def by_place(view: Any, most: float = 1) -> tuple[()]:
        return ()

    with pytest.raises(VisionError, match=r"detector 'opening' is defined twice: .*; rename the class Opening"):
        detector(Opening)(fits)
    fits.__module__ = "actr3d.vision.detectors.second"
    with pytest.raises(VisionError, match="detector 'opening' is defined twice"):
        detector(Opening)(fits)
    with pytest.raises(VisionError, match="must be given the class that it finds"):
        detector("odd")  # type: ignore[arg-type]
    for wrong in (nothing, needs_more, by_place):
        with pytest.raises(VisionError, match=r"must take a view, and after a \* parameters with defaults"):
            detector(Odd)(wrong)
