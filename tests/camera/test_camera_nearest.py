"""The nearest point of each extent lies on what is seen, and no ray between the edges hits anything nearer on the ground."""

from __future__ import annotations

import math
from random import Random

import numpy as np
import pytest

from actr3d.camera import CameraParameters, GeometricCamera
from tests.helpers.camera_scenes import JUST, Floats, Oracle, compiled, seen

SIZES = {"box": 3, "sphere": 1, "capsule": 2, "cylinder": 2, "ellipsoid": 3}
SAMPLES = 400
NEARLY = 0.004
"""How much nearer than what is told a ray may hit, as a part of the distance: round things that lie aslant are met nearly."""


def things(random: Random) -> str:
    """Returns things of all kinds, turned anyhow, of which some are bodies of two geoms that lie in one another."""
    parts: list[str] = []
    for number in range(8):
        kind = random.choice(list(SIZES))
        sizes = " ".join(f"{random.uniform(0.08, 0.4):.3f}" for _ in range(SIZES[kind]))
        turns = " ".join(f"{random.uniform(0, 90):.1f}" for _ in range(3))
        more = f'<geom type="sphere" size="0.2" pos="0 {random.uniform(-0.2, 0.2):.3f} 0.1"/>' if number % 3 == 0 else ""
        place = f"{random.uniform(1.2, 5):.3f} {random.uniform(-2, 2):.3f} {random.uniform(0.4, 2.2):.3f}"
        parts.append(f'<body pos="{place}" euler="{turns}"><geom type="{kind}" size="{sizes}"/>{more}</body>')
    return "".join(parts)


def rounder_extents(things: str, tilt: float, least: int) -> int:
    """Compares the nearest point of each extent with rays; returns in how many extents it is not an edge."""
    eye = f'<site name="eye" pos="0 0 1.5" euler="0 {tilt} 0"/>'
    mj_model, mj_data = compiled(things, eye=eye)
    parameters = CameraParameters(rows=60)
    oracle = Oracle(mj_model, mj_data, parameters)
    extents = GeometricCamera(mj_model, site="eye", parameters=parameters).look(mj_data).as_array()
    assert len(extents) >= least
    pitch = math.radians(tilt)
    rounder = 0
    for one in extents:
        if one["x2"] - one["x1"] < 1e-4:
            continue
        x1, x2 = float(one["x1"]), float(one["x2"])
        inside: Floats = np.arange(1, SAMPLES + 1) / (SAMPLES + 1) * (x2 - x1) + x1
        beside = np.clip((one["xn"] - JUST, one["xn"], one["xn"] + JUST), one["x1"] + JUST, one["x2"] - JUST)
        places = np.append(inside, beside)
        _, distances = oracle.look(places, one["y"])
        u, v = 2 * places - 1, (1 - 2 * one["y"]) * math.tan(math.pi / 6)
        rise = (v * math.cos(pitch) - math.sin(pitch)) / np.sqrt(1 + u * u + v * v)
        ground = np.where(distances < 0, np.inf, distances) * np.sqrt(1 - rise * rise)
        told = one["dn"] * math.sqrt(1 - rise[-2] ** 2)
        assert np.abs(ground[-3:] - told).min() < 0.01, "it lies on what is seen"
        assert told <= ground.min() * (1 + NEARLY) + 1e-4
        rounder += told < 0.99 * min(ground[0], ground[-4])
    return rounder


@pytest.mark.parametrize("tilt", [0, 25])
@pytest.mark.parametrize("seed", range(6))
def test_nothing_between_two_edges_is_nearer_than_the_nearest_point_returned(seed: int, tilt: int) -> None:
    assert rounder_extents(things(Random(seed)), tilt, 20) > 10, "in many extents it is not an edge"


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("kind", SIZES)
def test_nor_on_the_inner_side_of_what_surrounds_the_eye(kind: str, seed: int) -> None:
    random = Random(seed)
    sizes = " ".join(f"{random.uniform(2, 5):.3f}" for _ in range(SIZES[kind]))
    place = " ".join(f"{random.uniform(-1, 1):.3f}" for _ in range(2))
    turns = " ".join(f"{random.uniform(0, 90):.1f}" for _ in range(3))
    rounder_extents(f'<geom type="{kind}" size="{sizes}" pos="{place} 1.5" euler="{turns}"/>', 0, 50)


FACE = '<geom type="box" size="1 .00000001 .5" pos="3 0 1.5"/>'
"""So thin that less than a ten-millionth of the screen shows it."""
EDGE = 0.3 / math.sqrt(4.0**2 - 0.3**2) - 2e-8
"""A tangent just within the right edge of a ball of 0.3 m that is 4 m away."""
PEEPING = f'<geom type="box" size=".1 .5 .5" pos="2.1 {0.5 - 2 * EDGE} 1.5"/><geom type="sphere" size=".3" pos="4 0 1.5"/>'
"""A box, and a ball behind it that stands out by as little."""


@pytest.mark.parametrize(("sliver", "before"), [(FACE, 0), (PEEPING, 1)], ids=["flat", "round"])
def test_a_sliver_that_is_left_out_lends_its_nearest_point_to_nothing(sliver: str, before: int) -> None:
    ball = '<geom type="sphere" size=".5" pos="8 -2 1.5"/>'
    alone = seen(ball, rows=1)[1].as_array()
    view = seen(sliver + ball, rows=1)[1].as_array()
    assert len(view) == before + 1, "the sliver is left out"
    for field in ("x1", "x2", "d1", "d2", "xn", "dn"):
        assert view[field][-1] == alone[field][0]
