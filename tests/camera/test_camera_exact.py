"""The camera against geometry worked out by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest

from actr3d.camera import CameraParameters, GeometricCamera, View
from actr3d.errors import CameraError
from tests.helpers.camera_scenes import compiled, seen

ABOUT = 1e-9


def only_row(view: View) -> dict[int, list[list[float]]]:
    """Returns what is on the only scan line."""
    (row,) = view.as_dict().values()
    return row


def extents_of(camera: GeometricCamera, view: View, geom: str) -> list[list[float]]:
    """Returns the extents of a geom's object on the only scan line."""
    label = camera.label_of(geom)
    return [] if label is None else only_row(view).get(label, [])


def test_a_ball_straight_ahead() -> None:
    half = math.asin(0.5 / 4)
    camera, view = seen('<geom name="ball" type="sphere" size=".5" pos="4 0 1.5"/>', rows=1)
    edge, distance = math.tan(half) / 2, math.sqrt(16 - 0.25)
    expected = [0.5 - edge, 0.5 + edge, distance, distance, math.degrees(half), math.degrees(half)]
    assert extents_of(camera, view, "ball") == [pytest.approx(expected, abs=1e-7)]


@pytest.mark.parametrize("y", [-8, 0.123, 3])
@pytest.mark.parametrize("shape", ['type="box" size=".005 .005 3"', 'type="cylinder" size=".005 3"', 'type="capsule" size=".005 3"'])
def test_a_pole_of_a_centimetre_at_ten_metres_is_never_lost(shape: str, y: float) -> None:
    camera, view = seen(f'<geom name="pole" {shape} pos="10 {y} 2"/>', rows=40, vertical_fov=0.2)
    for row in view.as_dict().values():
        ((x1, x2, d1, *_),) = row[1]
        assert 0.5 - y / 20 == pytest.approx(0.5 * (x1 + x2), abs=1e-5)
        assert 0.00045 < x2 - x1 < 0.001
        assert d1 == pytest.approx(math.hypot(10, y), abs=0.08)
    assert camera.label_of("pole") == 1


def test_a_pole_is_seen_on_the_widest_screen() -> None:
    _, view = seen('<geom type="box" size=".005 .005 1.2" pos="10 0 1.2"/>', rows=1, horizontal_fov=math.radians(178), precision=0.01)
    ((extent,),) = only_row(view).values()
    assert extent[1] - extent[0] == pytest.approx(0.01 / (10 - 0.005) / 2 / math.tan(math.radians(89)), abs=ABOUT)


def test_edges_of_an_opening_and_distances_to_the_millimetre() -> None:
    walls = '<geom name="left" type="box" size=".1 1 2" pos="5.1 1.4 1"/><geom name="right" type="box" size=".1 1 2" pos="5.1 -1.35 1"/>'
    camera, view = seen(walls, rows=1)
    ((x1, x2, d1, d2, *_),) = extents_of(camera, view, "left")
    assert [x1, x2] == pytest.approx([0.5 - 2.4 / 10, 0.5 - 0.4 / 10.4], abs=ABOUT)  # its inner edge is the far one
    assert [d1, d2] == pytest.approx([math.hypot(5, 2.4), math.hypot(5.2, 0.4)], abs=ABOUT)
    ((x1, x2, *_),) = extents_of(camera, view, "right")
    assert [x1, x2] == pytest.approx([0.5 + 0.35 / 10.4, 0.5 + 2.35 / 10], abs=ABOUT)


def test_both_edges_of_an_object_are_exact_where_a_sliver_of_another_part_begins_or_ends_it() -> None:
    far, near = 'size=".1 1.20000012 2" pos="6.1 0 1"', 'size=".1 1 2" pos="5.1 0 1"'
    camera, view = seen(f'<body><geom name="far" type="box" {far}/><geom type="box" {near}/></body>', rows=1)
    ((x1, x2, d1, d2, *_),) = extents_of(camera, view, "far")
    half = 1.20000012 / 6 / 2  # the far part is seen for a hundred-millionth of the screen on each side of the near one
    assert [x1, x2] == pytest.approx([0.5 - half, 0.5 + half], abs=ABOUT)
    assert [d1, d2] == pytest.approx([math.hypot(6, 1.20000012)] * 2, abs=ABOUT)


def test_five_centimetres_from_a_wall() -> None:
    _, view = seen('<geom type="box" size=".1 3 2" pos=".15 2.98 1"/>', rows=1)
    ((extent,),) = only_row(view).values()
    edge = 0.5 + 0.02 / 0.05 / 2
    assert extent == pytest.approx([0, edge, 0.05 * math.sqrt(2), math.hypot(0.05, 0.02), 45, math.degrees(math.atan(0.4))], abs=ABOUT)


def test_in_a_doorway() -> None:
    walls = '<geom name="left" type="box" size=".1 1 2" pos=".05 1.3 1"/><geom name="right" type="box" size=".1 1 2" pos=".05 -1.3 1"/>'
    camera, view = seen(walls, rows=1, horizontal_fov=math.radians(150))
    left, right = extents_of(camera, view, "left"), extents_of(camera, view, "right")
    assert left == [pytest.approx([0, 0.5 - 0.3 / 0.15 / 2 / math.tan(math.radians(75)), *left[0][2:]], abs=ABOUT)]
    assert left[0][3] == pytest.approx(math.hypot(0.3, 0.15), abs=ABOUT)
    assert [right[0][0], right[0][1]] == pytest.approx([1 - left[0][1], 1], abs=ABOUT)


def test_what_is_cut_in_two_has_two_extents() -> None:
    camera, view = seen('<geom name="wall" type="box" size=".1 1 2" pos="4.1 0 1"/><geom type="box" size=".1 .1 2" pos="2.1 0 1"/>', rows=1)
    extents = extents_of(camera, view, "wall")
    assert [extent[:4] for extent in extents] == [
        pytest.approx([0.5 - 1 / 8, 0.475, math.hypot(4, 1), math.hypot(4, 0.2)], abs=ABOUT),
        pytest.approx([0.525, 0.5 + 1 / 8, math.hypot(4, 0.2), math.hypot(4, 1)], abs=ABOUT),
    ]


def test_a_ball_half_in_a_wall_is_seen_where_it_stands_out() -> None:
    wall = '<geom name="wall" type="box" size=".1 1 2" pos="4.1 0 1"/>'
    camera, view = seen(wall + '<geom name="ball" type="sphere" size=".5" pos="4.3 0 1.5"/>', rows=1)
    edge = math.sqrt(0.25 - 0.09) / 8
    assert [extent[:2] for extent in extents_of(camera, view, "ball")] == [pytest.approx([0.5 - edge, 0.5 + edge], abs=ABOUT)]
    assert len(extents_of(camera, view, "wall")) == 2


def test_two_balls_in_one_another_meet_in_the_plane_between_them() -> None:
    balls = '<geom name="a" type="sphere" size=".5" pos="4 .2 1.5"/><geom name="b" type="sphere" size=".5" pos="4 -.2 1.5"/>'
    camera, view = seen(balls, rows=1)
    ((_, a2, _, d2, *_),) = extents_of(camera, view, "a")
    ((b1, *_),) = extents_of(camera, view, "b")
    assert [a2, b1] == pytest.approx([0.5, 0.5], abs=ABOUT)
    assert d2 == pytest.approx(4 - math.sqrt(0.25 - 0.04), abs=ABOUT)


def test_parts_of_one_object_are_one_extent() -> None:
    parts = '<body><geom type="sphere" size=".5" pos="4 .2 1.5"/><body><geom type="box" size=".5 .5 .5" pos="4 -.2 1.5"/></body></body>'
    _, view = seen(parts, rows=1)
    assert [len(extents) for extents in only_row(view).values()] == [1]


def test_the_ground_hides_and_is_not_in_the_view() -> None:
    cellar = '<geom name="floor" type="plane" size="0 0 .1"/><geom name="low" type="sphere" size=".3" pos="3 0 -.4"/>'
    _, view = seen(cellar, rows=9)
    assert view.as_dict() == {(row + 0.5) / 9: {} for row in range(9)}
    camera, view = seen(cellar, rows=9, background=())
    assert {label for row in view.as_dict().values() for label in row} == {camera.label_of("floor")}
    wall = '<geom name="wall" type="box" size=".1 9 9" pos="2 0 1"/>'
    _, view = seen(wall + '<geom type="sphere" size=".3" pos="3 0 1.5"/>', background=("wall",))
    assert len(view.as_array()) == 0


def test_a_geom_without_a_name_has_no_label() -> None:
    camera, _ = seen('<geom type="sphere" size=".3" pos="3 0 1.5"/>')
    for name in ("", "ball"):
        with pytest.raises(CameraError, match=f"no geom '{name}'"):
            camera.label_of(name)


def test_a_finite_plane_ends() -> None:
    mat, eye = '<geom name="mat" type="plane" size="1 .5 .1" pos="3 0 1"/>', '<site name="eye" pos="0 0 1.5" euler="0 9 0"/>'
    camera, view = seen(mat, eye=eye, rows=1, background=())
    edge = 0.25 / (0.5 / math.sin(math.radians(9)))
    assert [extent[:2] for extent in extents_of(camera, view, "mat")] == [pytest.approx([0.5 - edge, 0.5 + edge], abs=ABOUT)]


def test_what_is_out_of_range_is_not_seen() -> None:
    world = '<geom name="wall" type="box" size=".1 9 2" pos="3.1 0 1"/><geom name="ball" type="sphere" size=".3" pos="9 0 1.5"/>'
    camera, view = seen(world, rows=1, range=5)
    assert extents_of(camera, view, "wall") == [pytest.approx([0, 1, 3 * math.sqrt(2), 3 * math.sqrt(2), 45, 45], abs=ABOUT)]
    camera, view = seen(world, rows=1, range=4)
    edge = math.sqrt(16 - 9) / 6
    assert [extent[:4] for extent in extents_of(camera, view, "wall")] == [pytest.approx([0.5 - edge, 0.5 + edge, 4, 4], abs=ABOUT)]
    assert camera.label_of("ball") is None


def test_what_is_too_near_is_looked_through() -> None:
    world = '<geom name="pane" type="box" size=".01 1 1" pos=".1 0 1.5"/><geom name="ball" type="sphere" size=".3" pos="1 0 1.5"/>'
    camera, view = seen(world, rows=1, near=0.2)
    assert camera.label_of("pane") is None
    assert len(extents_of(camera, view, "ball")) == 1
    cut = '<geom name="ball" type="sphere" size=".3" pos=".4 0 1.5"/>'
    camera, view = seen(cut, rows=1, near=0.15, horizontal_fov=math.radians(120))
    edge = math.tan(math.asin(0.75)) / 2 / math.tan(math.radians(60))  # where its front is cut away, its inner side is seen
    ((x1, x2, d1, *_),) = extents_of(camera, view, "ball")
    assert [x1, x2, d1] == pytest.approx([0.5 - edge, 0.5 + edge, math.sqrt(0.16 - 0.09)], abs=1e-7)
    inside = '<geom name="ball" type="sphere" size=".3" pos=".1 0 1.5"/>'
    camera, view = seen(inside, rows=1, near=0.15, horizontal_fov=math.radians(20))
    slope = math.tan(math.radians(10))
    depth = (0.1 + math.sqrt(0.01 - (1 + slope**2) * (0.01 - 0.09))) / (1 + slope**2)
    assert extents_of(camera, view, "ball")[0][:3] == pytest.approx([0, 1, depth * math.sqrt(1 + slope**2)], abs=ABOUT)


@pytest.mark.parametrize(
    ("shape", "size"), [("box", "1 2 3"), ("sphere", "2"), ("capsule", "1 1"), ("cylinder", "1 3"), ("ellipsoid", "1 2 3")]
)
def test_from_inside_all_is_filled(shape: str, size: str) -> None:
    _, view = seen(f"<geom type='{shape}' size='{size}' pos='.1 .2 1.4' euler='10 20 30'/>", rows=7)
    assert [row[1][0][:2] for row in view.as_dict().values()] == [pytest.approx([0, 1], abs=1e-12)] * 7


def test_gaps_narrower_than_the_precision_are_closed() -> None:
    fence = "".join(f'<geom type="box" size=".1 .1 1" pos="5 {y} 1.5"/>' for y in (0.101, -0.101))
    parts = f"<body>{fence}</body>"
    gap = 0.002 / 4.9 / 2
    assert len(seen(parts, rows=1, precision=gap / 1.1)[1].as_array()) == 2
    assert len(seen(parts, rows=1, precision=gap * 1.1)[1].as_array()) == 1


def test_angles_are_exact_over_the_whole_of_the_widest_screen() -> None:
    fov = math.radians(170)
    balls = "".join(f'<geom type="sphere" size=".05" pos="1 {y} {1.5 + z}"/>' for y in (0, 0.3, 1, 5, -9) for z in (0, -1, 0.4, 6))
    _, view = seen(balls, rows=200, horizontal_fov=fov, vertical_fov=fov)
    edges, most = view.as_array(), math.tan(fov / 2)
    up = most * (1 - 2 * edges["y"])
    for x, angle in (("x1", "a1"), ("x2", "a2")):
        across = most * (2 * edges[x] - 1)
        assert edges[angle] == pytest.approx(np.degrees(np.arctan(np.hypot(across, up))), rel=1e-12)
    assert max(edges["a1"]) > 75


def test_a_retina_is_fine_in_the_middle() -> None:
    e2 = math.radians(0.75)
    _, view = seen('<geom type="box" size=".1 .5 3" pos="5.1 1.5 1.5"/>', rows=11, retinotopic=True)

    def place(tangent: float) -> float:
        return math.log1p(math.atan(tangent) / e2) / math.log1p(math.radians(45) / e2) / 2

    rows = view.as_array()
    assert rows["x1"] == pytest.approx(0.5 - place(2 / 5), abs=ABOUT)
    assert rows["x2"] == pytest.approx(0.5 - place(1 / 5.2), abs=ABOUT)
    heights = np.sqrt(np.maximum(0, rows["d1"] ** 2 - 25 - 4)) / 5  # of the scan lines, as tangents
    angles = np.degrees(np.arctan(heights))
    span = math.log1p(math.radians(30) / e2)
    expected = [math.degrees(e2 * math.expm1(abs(1 - (2 * row + 1) / 11) * span)) for row in rows["row"]]
    assert angles == pytest.approx(expected, abs=1e-6)
    assert len(rows) == 11
    assert angles[4] < 1 < 9 < angles[0] - angles[1]


@pytest.mark.parametrize("kind", ["camera", "site", "body"])
def test_eyes_look_along_their_own_axes(kind: str) -> None:
    eye = '<camera name="eye" pos="1 2 3" xyaxes="0 -1 0 0 0 1"/><site name="eye" pos="1 2 3"/><body name="eye" pos="1 2 3"/>'
    mj_model, mj_data = compiled('<geom name="ball" type="sphere" size=".1" pos="3 1.5 3.4"/>', eye=eye)
    camera = GeometricCamera(mj_model, **{kind: "eye"}, parameters=CameraParameters(rows=200))
    view = camera.look(mj_data).as_array()
    assert (view["x1"] + view["x2"]).mean() / 2 == pytest.approx(0.5 + 0.25 / 2, abs=1e-3)
    assert view["y"].mean() == pytest.approx(0.5 - 0.2 / 2 / math.tan(math.radians(30)), abs=5e-3)
