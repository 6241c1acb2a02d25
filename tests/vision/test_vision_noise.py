"""Noise of seeing: of its size, the same for one side of an object on all rows, and nowhere else."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from actr3d.vision.detectors.opening import opening as openings
from actr3d.vision.noise import blurred
from tests.helpers.camera_scenes import seen
from tests.helpers.small_agents import near
from tests.helpers.vision_scenes import doorway, pole

SCENE = doorway(4.0, 0.8) + pole("post", 2.0, 0.5)


def angles(x: Any, retinotopic: bool) -> Any:
    """Returns the directions of places on the screen, to the right [rad]."""
    part = 2 * np.asarray(x) - 1
    if not retinotopic:
        return np.arctan(part)
    e2 = math.radians(0.75)
    return np.sign(part) * e2 * np.expm1(np.abs(part) * math.log1p(math.radians(45) / e2))


@pytest.mark.parametrize("retinotopic", [False, True])
def test_edges_move_by_angles_each_side_of_an_object_by_one(retinotopic: bool) -> None:
    _, view = seen(SCENE, retinotopic=retinotopic)
    moved: list[float] = []
    for seed in range(200):
        noisy = blurred(view, 0.01, 0.0, seed).extents
        assert noisy["d1"].tolist() == view.extents["d1"].tolist()
        for x in ("x1", "x2"):
            by = angles(noisy[x], retinotopic) - angles(view.extents[x], retinotopic)
            inside = (view.extents[x] > 0) & (view.extents[x] < 1) & (noisy[x] > 0) & (noisy[x] < 1)
            for label in set(view.extents["label"][inside].tolist()):
                of_one = by[inside & (view.extents["label"] == label)]
                assert np.ptp(of_one) < 1e-9
                moved.append(float(of_one[0]))
    assert float(np.std(moved)) == near(0.01, rel=0.1)
    assert float(np.mean(moved)) == near(0.0, abs=0.001)


def test_what_the_border_of_the_screen_cuts_off_has_no_edge_there() -> None:
    _, view = seen(SCENE + pole("wide", 1.0, 0.9, radius=0.3))
    for x, border in (("x1", 0.0), ("x2", 1.0)):
        at_border = view.extents[x] == border
        assert (blurred(view, 0.05, 0.1, 1).extents[x][at_border] == border).all()
    assert (view.extents["x1"] == 0).any()


def test_distances_change_by_a_part_of_them_and_stay_above_0() -> None:
    _, view = seen(SCENE)
    parts = [blurred(view, 0.0, 0.05, seed).extents["d1"][0] / view.extents["d1"][0] for seed in range(400)]
    assert np.std(parts) == near(0.05, rel=0.15)
    assert np.mean(parts) == near(1.0, abs=0.01)
    for seed in range(50):
        noisy = blurred(view, 0.0, 5.0, seed).extents
        assert noisy["d1"].min() > 0
        assert noisy["x1"].tolist() == view.extents["x1"].tolist()
    assert blurred(view, 0.01, 0.1, 7).extents.tobytes() == blurred(view, 0.01, 0.1, 7).extents.tobytes()
    empty = seen("")[1]
    assert blurred(empty, 0.1, 0.1, 1) is empty


@pytest.mark.parametrize(("edges", "distances"), [(0.005, 0.0), (0.0, 0.1)])
@pytest.mark.parametrize("distance", [7.0, 1.5])
def test_the_average_seen_width_of_a_doorway_is_its_width(distance: float, edges: float, distances: float) -> None:
    _, view = seen(doorway(distance, 0.6), rows=5)
    widths = [max(openings(blurred(view, edges, distances, seed)), key=lambda one: one.height).width for seed in range(1000)]
    sd = distance * edges * math.sqrt(2) if edges else 0.6 * distances
    assert np.std(widths) == near(sd, rel=0.15)
    assert np.mean(widths) == near(0.6, abs=4 * sd / math.sqrt(1000))


def test_all_distances_of_a_look_are_misjudged_alike() -> None:
    _, view = seen(SCENE)
    noisy = blurred(view, 0.0, 0.05, 3).extents
    parts = [noisy[d] / view.extents[d] for d in ("d1", "d2", "dn")]
    assert np.ptp(parts) < 1e-9
    assert abs(parts[0][0] - 1) > 1e-3
