"""Openings are as wide as they are: from anywhere, with the head turned, holes and gaps, nested, hidden in part."""

from __future__ import annotations

import math
from collections.abc import Iterator
from itertools import islice, pairwise
from random import Random
from typing import Any

import pytest

from actr3d.vision import Opening
from actr3d.vision.detectors.opening import opening as openings_of
from actr3d.world import Aperture, Floor, Mannequin, Scene, World
from tests.helpers.small_agents import near
from tests.helpers.vision_scenes import doorway, found, pole, wall

CENTIMETRE = 0.01


def eye(x: float = 0.0, y: float = 0.0, yaw: float = 0.0, pitch: float = 0.0, roll: float = 0.0) -> str:
    """Returns an eye 1.5 m above a place, turned by angles [degrees]: to the left, down, to the right."""
    return f'<body pos="{x} {y} 1.5" euler="0 0 {yaw}"><body euler="0 {pitch} 0"><site name="eye" euler="{roll} 0 0"/></body></body>'


def only(openings: tuple[Any, ...]) -> Opening:
    (one,) = openings
    return one


def high(openings: tuple[Any, ...]) -> tuple[Any, ...]:
    """Returns those that are not slits between the ground and the foot of something."""
    return tuple(opening for opening in openings if opening.height > 0.5)


@pytest.mark.parametrize("distance", [7.0, 3.0, 1.44, 0.5])
@pytest.mark.parametrize("width", [0.35, 0.45, 0.7])
def test_the_width_of_a_doorway_is_exact_from_straight_ahead(width: float, distance: float) -> None:
    one = only(found("opening", doorway(distance, width), vertical_fov=1.0))
    assert one.width == near(width, abs=1e-6)
    assert one.distance == near(distance + 0.1, abs=1e-6)  # its sides are seen up to their far ends
    assert one.direction == near(0, abs=1e-9)
    assert one.depth == math.inf
    assert one.left != one.right


@pytest.mark.parametrize("thick", [0.1, 0.3, 0.35])
@pytest.mark.parametrize("aside", [-4.0, -2.0, -0.5, 0.3, 1.0, 3.0])
def test_off_the_axis_too_where_one_edge_is_the_front_and_the_other_the_back(aside: float, thick: float) -> None:
    one = only(found("opening", doorway(5.0, 0.4, thick=thick), eye(0, aside, math.degrees(math.atan2(-aside, 5)))))
    assert one.width == near(0.4, abs=CENTIMETRE)
    assert one.direction == near(0, abs=math.radians(3))


def doorways() -> Iterator[tuple[float, float, float, str]]:
    """Yields doorways made at random (distance, width and thickness) and eyes that see through them."""
    random = Random(1)
    while True:
        distance, width, thick = random.uniform(0.5, 7), random.uniform(0.3, 1.2), random.choice([0.02, 0.1, 0.2, 0.3])
        aside, off = random.uniform(-3, 3), random.uniform(-25, 25)
        tilt = (random.uniform(-12, 12), random.uniform(-8, 8))
        turn = math.atan2(-aside, distance + thick / 2) + math.radians(off)
        low = max((-width / 2 - aside) / deep for deep in (distance, distance + thick))
        high = min((width / 2 - aside) / deep for deep in (distance, distance + thick))
        if high - low > 0.01 and max(abs(math.atan(low) - turn), abs(math.atan(high) - turn)) < math.radians(38):
            yield distance, width, thick, eye(0, aside, math.degrees(turn), *tilt)


@pytest.mark.parametrize(("distance", "width", "thick", "site"), list(islice(doorways(), 50)))
def test_doorways_made_at_random_are_as_wide_as_they_are(distance: float, width: float, thick: float, site: str) -> None:
    openings = found("opening", doorway(distance, width, thick=thick), site)
    assert max(openings, key=lambda o: o.height).width == near(width, abs=CENTIMETRE)


@pytest.mark.parametrize("yaw", [-35, -10, 20, 40])
@pytest.mark.parametrize("distance", [6.0, 1.0])
def test_with_the_head_turned(distance: float, yaw: float) -> None:
    one = only(found("opening", doorway(distance, 0.45), eye(0, 0.05, yaw), horizontal_fov=2.6))
    assert one.width == near(0.45, abs=CENTIMETRE)
    assert one.direction == near(math.radians(-yaw), abs=0.1)  # a bare eye has no other ahead than where it looks


@pytest.mark.parametrize("tilt", [(15, 0), (-15, 0), (0, 20), (10, -10)])
def test_with_the_head_tilted_heights_do_not_count_for_widths(tilt: tuple[float, float]) -> None:
    one = max(found("opening", doorway(2.0, 0.5), eye(0, -1.5, 36, *tilt)), key=lambda o: o.height)
    assert one.width == near(0.5, abs=CENTIMETRE)


@pytest.mark.parametrize("distance", [7.0, 2.5])
@pytest.mark.parametrize(
    "options", [{"horizontal_fov": 2.8}, {"horizontal_fov": 0.9}, {"retinotopic": True}, {"rows": 31}, {"range": 20.0}]
)
def test_with_any_eye(options: dict[str, Any], distance: float) -> None:
    one = max(found("opening", doorway(distance, 0.45), eye(0, 0.2), **options), key=lambda o: o.height)
    assert one.width == near(0.45, abs=CENTIMETRE)


def test_heights_are_exact_to_a_scan_line_and_an_opening_knows_what_it_is_bounded_by() -> None:
    row = 2 * math.tan(math.pi / 6) / 100 * 6.1
    lintel = '<body pos="6.05 0 2.3"><geom type="box" size="0.05 0.4 0.2"/></body>'
    one = only(found("opening", doorway(6.0, 0.8) + lintel))
    assert one.height == near(2.1, abs=row)
    assert one.top == near(0.6, abs=row)
    assert one.bottom == near(-1.5, abs=row)
    assert one.above not in (0, one.left, one.right)
    assert (one.below, one.cut) == (0, False)
    free = only(found("opening", doorway(6.0, 0.8)))
    assert (free.above, free.cut) == (0, False)
    assert free.height == near(2.5, abs=row)
    close = only(found("opening", doorway(1.0, 0.8)))
    assert close.cut
    assert close.at_most("height", close.height) == math.inf


def test_a_window_is_a_hole_in_one_thing() -> None:
    parts = ((1.4, 0.0, 0.9, 1.25), (-1.4, 0.0, 0.9, 1.25), (0, 0.75, 0.5, 0.5), (0, -0.75, 0.5, 0.5))
    frame = "".join(f'<geom type="box" size="0.05 {w} {h}" pos="0 {y} {z}"/>' for y, z, w, h in parts)
    one = only(found("opening", f'<body pos="4 0 1.5">{frame}</body>', eye(0, 1.0, -14)))
    assert one.width == near(1.0, abs=CENTIMETRE)
    assert one.height == near(0.5, abs=0.05)
    assert one.left == one.right == one.above == one.below != 0


@pytest.mark.parametrize("thick", [0.05, 0.2, 0.35])
@pytest.mark.parametrize("width", [0.9, 2.0])
@pytest.mark.parametrize("aside", [-60, -35, 10, 50])
def test_the_height_of_a_doorway_is_exact_to_one_scan_line_from_any_side(aside: float, width: float, thick: float) -> None:
    bearing, distance = math.radians(aside), 3.6
    x, y = 7 - distance * math.cos(bearing), distance * math.sin(bearing)
    person = Mannequin(name="m", position=(x, y), heading=math.atan2(-y, 7 - x))
    world = World(Scene(parts=(Floor(), person, Aperture(width=width, thickness=thick))))
    openings = openings_of(world.bodies["m"].get("view"))
    one = max((one for one in openings if not one.cut), key=lambda one: one.height)
    line = 2 * math.tan(math.pi / 6) / 100 * (distance + width / 2 + thick)  # one scan line where the farther side is
    assert one.height == near(2.5, abs=line)
    assert one.top == near(2.5 - 0.936 * person.height, abs=line)


@pytest.mark.parametrize("pitch", [0.0, 25.0, -25.0])
def test_things_that_are_seen_at_different_heights_have_no_opening_between_them(pitch: float) -> None:
    """A far one may end below where a near one begins to be seen."""
    heights: list[float] = []
    for seed in range(60):
        uniform = Random(seed).uniform
        poles = [pole(f"p{n}", uniform(0.5, 6), uniform(-3, 3), uniform(0.02, 0.2), uniform(0.3, 2.5)) for n in range(8)]
        heights += [one.height for one in found("opening", "".join(poles), eye=eye(pitch=pitch))]
    assert len(heights) > 200
    assert min(heights) > 0


def test_the_height_between_unequal_sides_is_that_of_the_lower_one() -> None:
    for near_one, far_one in ((1.8, 2.6), (2.0, 2.6), (2.2, 1.9)):
        one = only(found("opening", pole("a", 3.0, 0.5, height=near_one) + pole("b", 6.0, -0.5, height=far_one)))
        assert one.top == near(min(near_one, far_one) - 1.5, abs=2 * math.tan(math.pi / 6) / 100 * 6.0)


@pytest.mark.parametrize("distance", [6.0, 2.0, 1.0])
def test_between_two_poles(distance: float) -> None:
    one = only(found("opening", pole("a", distance, 0.4) + pole("b", distance, -0.3)))
    assert one.width == near(0.7 - 2 * 0.02, abs=CENTIMETRE)
    assert one.distance == near(math.hypot(distance, 0.05), abs=0.05)


def test_a_pole_in_a_doorway_makes_two_openings() -> None:
    openings = high(found("opening", doorway(4.0, 1.2) + pole("p", 4.05, 0.1, height=2.5)))
    assert sorted(opening.width for opening in openings) == near([0.48, 0.68], abs=CENTIMETRE)
    assert len({openings[0].left, openings[0].right, openings[1].left, openings[1].right}) == 3
    # Far behind it, the doorway is free as far as the pole.
    widest = max(found("opening", doorway(4.0, 1.2) + pole("p", 5.0, 0.1)), key=lambda o: o.width)
    assert widest.width == near(1.2, abs=CENTIMETRE)
    assert widest.depth == near(5.0 - 0.02 - 4.1, abs=0.03)


def test_nested_gaps_are_each_found() -> None:
    openings = high(found("opening", doorway(3.0, 1.6) + doorway(6.0, 0.6).replace('"a"', '"c"').replace('"b"', '"d"')))
    assert sorted((o.width, o.depth) for o in openings) == [(near(0.6), math.inf), (near(1.6), near(6.0 - 3.1, abs=1e-3))]


def test_the_depth_of_a_niche_is_exact() -> None:
    for aside in (0.0, 0.8):
        one = max(found("opening", doorway(3.0, 1.0) + wall("c", 3.5, 2, -2), eye(0, aside)), key=lambda o: o.height)
        assert one.depth == near(3.45 - 3.1, abs=CENTIMETRE)


def test_gaps_in_a_crowd() -> None:
    people = [(4.0, 1.2), (4.2, 0.3), (3.9, -0.5), (4.1, -1.7)]
    crowd = "".join(pole(f"p{n}", x, y, radius=0.2, height=1.7) for n, (x, y) in enumerate(people))
    openings = tuple(opening for opening in high(found("opening", crowd)) if opening.depth > 0.5)
    assert len(openings) == 3
    gaps = [math.dist(one, other) - 0.4 for one, other in pairwise(people)]
    assert [o.width for o in sorted(openings, key=lambda o: -o.direction)] == near(gaps, abs=0.03)  # round things hide their nearest points


def test_an_opening_hidden_in_part_is_found_as_far_as_it_is_visible() -> None:
    box = '<body pos="2 0.4 0.6"><geom type="box" size="0.1 0.5 0.6"/></body>'
    openings = sorted(found("opening", doorway(5.0, 0.6) + box), key=lambda o: -o.height)
    assert openings[0].width == near(0.6, abs=CENTIMETRE)
    assert openings[0].bottom == near(-0.3 / 1.9 * 5, abs=0.1)  # the box hides what is lower
    assert openings[0].below not in (0, openings[0].left, openings[0].right)


def test_what_is_no_rectangle_is_as_large_as_the_largest_rectangle_in_it() -> None:
    steps = "".join(
        f'<body pos="4 {side * (half + 1)} {z}"><geom type="box" size="0.05 1 {tall}"/><geom type="box" size="0.05 1 {rest}" '
        f'pos="0 {side * out} {-z + rest}"/></body>'
        for side in (1, -1)
        for half, z, tall, rest, out in ((0.5, 1.7, 0.8, 0.45, -0.3),)
    )
    one = max(found("opening", steps), key=lambda o: o.height)
    assert (one.width, one.height) == (near(1.0, abs=CENTIMETRE), near(1.6, abs=0.08))  # the lower part is 0.4 m wide
    leaning = "".join(f'<body pos="4 {y} 1" euler="10 0 0"><geom type="box" size="0.02 0.02 1"/></body>' for y in (0.5, -0.5))
    one = max(found("opening", leaning), key=lambda o: o.height)
    assert one.width + math.tan(math.radians(10)) * one.height == near(0.96 + 2 * 0.02 * (1 - 1 / math.cos(math.radians(10))), abs=0.03)


def test_what_leaves_the_field_of_view_at_a_side_is_no_opening() -> None:
    assert found("opening", wall("a", 3.0, 3.0, 0.2)) == ()
    assert found("opening", doorway(0.1, 0.9)) == ()  # both sides lie outside a right angle
    assert only(found("opening", doorway(0.1, 0.9), horizontal_fov=2.7)).width == near(0.9, abs=CENTIMETRE)


def test_edges_that_touch_or_lie_in_one_another_leave_no_gap() -> None:
    assert found("opening", wall("a", 3.0, 2.0, 0.0) + wall("b", 3.0, 0.0, -2.0)) == ()
    assert found("opening", wall("a", 3.0, 2.0, -0.1) + wall("b", 3.0, 0.1, -2.0)) == ()
    assert found("opening", "") == ()


def test_a_walker_sees_the_width_of_the_aperture_from_everywhere() -> None:
    world = World(Scene(parts=(Floor(), Aperture(width=0.5), Mannequin(name="walker"))))
    walker = world.bodies["walker"]
    for x, y, heading, torso in ((0, 0, 0, 0), (3, 1.5, -0.3, 0.5), (6.3, 0.0, 0, 0.6), (6.0, -0.4, 0.2, -0.5)):
        walker.set("teleport", x, y, heading)
        walker.joints["torso_yaw"].put(torso)
        walker.joints["head_yaw"].put(-0.5 * torso)
        world.changed()
        widest: Opening = max(openings_of(walker.get("view")), key=lambda o: o.height)
        assert widest.width == near(0.5, abs=CENTIMETRE)
        at = walker.physics.mj_data.site(walker.eye).xpos
        expected = math.atan2(-at[1], 7.0 - at[0]) - heading
        assert widest.direction == near(expected, abs=0.06)  # from where the legs point, wherever the head looks
