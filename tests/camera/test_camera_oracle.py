"""The camera against MuJoCo's rays, in scenes made at random."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from actr3d.camera import CameraParameters
from tests.helpers.camera_scenes import compiled, disagreements

SIZES = {"sphere": 1, "ellipsoid": 3, "capsule": 2, "cylinder": 2, "box": 3}


def torus(rings: int, sides: int) -> str:
    """Returns a mesh that is not convex, and has a hole to look through."""
    a, b = np.meshgrid(np.arange(rings) * 2 * math.pi / rings, np.arange(sides) * 2 * math.pi / sides, indexing="ij")
    vertices = np.stack(((0.5 + 0.2 * np.cos(b)) * np.cos(a), (0.5 + 0.2 * np.cos(b)) * np.sin(a), 0.2 * np.sin(b)), axis=-1)
    i, j = np.meshgrid(np.arange(rings), np.arange(sides), indexing="ij")
    k, m = (i + 1) % rings, (j + 1) % sides
    corners = (i * sides + j, k * sides + j, k * sides + m, i * sides + m)
    faces = np.concatenate([np.stack([corners[n].ravel() for n in three], axis=-1) for three in ((0, 1, 2), (0, 2, 3))])
    return f'<mesh name="torus" vertex="{numbers(vertices)}" face="{" ".join(map(str, faces.ravel()))}"/>'


def numbers(values: Any) -> str:
    return " ".join(f"{value:.6f}" for value in np.asarray(values).ravel())


def pose(random: np.random.Generator, spread: float) -> str:
    place = random.uniform((0.5, -spread, 0), (6, spread, 2.5))
    return f'pos="{numbers(place)}" quat="{numbers(random.normal(size=4))}"'


def random_scene(seed: int) -> tuple[Any, Any]:
    """Returns model and data of a crowd of things that stand in one another; some eyes are inside one."""
    random = np.random.default_rng(seed)
    elevation = random.uniform(size=(5, 7))
    assets = torus(12, 7) + f'<hfield name="land" nrow="5" ncol="7" size="2 1.5 .6 .2" elevation="{numbers(elevation)}"/>'
    things = ['<geom type="plane" size="0 0 .1"/>']
    if seed % 2:  # a wall that hides some things wholly and others in part
        things.append(f'<geom type="box" size=".1 {random.uniform(0.5, 2)} {random.uniform(0.3, 1.2)}" {pose(random, 1)}/>')
    for _ in range(random.integers(2, 14)):
        kind = random.choice([*SIZES, "mesh", "hfield"])
        if kind == "mesh":
            shape = 'type="mesh" mesh="torus"'
        elif kind == "hfield":
            shape = 'type="hfield" hfield="land"'
        else:
            shape = f'type="{kind}" size="{numbers(random.uniform(0.02, 0.6, SIZES[kind]))}"'
        if kind != "hfield" and random.uniform() < 0.5:
            part = f'<geom type="sphere" size="{random.uniform(0.05, 0.3)}" pos="{numbers(random.uniform(-0.5, 0.5, 3))}"/>'
            things.append(f"<body {pose(random, 2)}><geom {shape}/>{part}</body>")
        else:
            things.append(f"<geom {shape} {pose(random, 3)}/>")
    eye = f'<site name="eye" pos="{numbers(random.uniform((-1, -1, 0.3), (3, 1, 2)))}" euler="{numbers(random.uniform(-15, 15, 3))}"/>'
    return compiled("".join(things), assets, eye)


@pytest.mark.daily(10)
@pytest.mark.parametrize("seed", range(40))
def test_edges_are_where_rays_find_them(seed: int) -> None:
    mj_model, mj_data = random_scene(seed)
    parameters = CameraParameters(rows=23, horizontal_fov=math.radians(70 + seed % 5 * 20), range=5 if seed % 3 == 0 else None)
    assert disagreements(mj_model, mj_data, parameters) == []


@pytest.mark.parametrize("seed", range(4))
def test_a_crowd_on_the_ground_is_seen_as_by_rays(seed: int) -> None:
    random = np.random.default_rng(seed)
    things = ['<geom type="plane" size="0 0 .1"/>']
    for i in range(60):
        kind = list(SIZES)[i % len(SIZES)]
        size = random.uniform(0.1, 0.4, SIZES[kind])
        x, y = random.uniform((1.2, -3), (7, 3))
        turn = random.uniform(0, 90) if i % 3 else random.uniform(-20, 20)
        things.append(f'<geom type="{kind}" size="{numbers(size)}" pos="{x} {y} {size.max()}" euler="{turn * (not i % 3)} 0 {turn}"/>')
    mj_model, mj_data = compiled("".join(things), "", '<site name="eye" pos="0 0 1.5"/>')
    assert disagreements(mj_model, mj_data, CameraParameters(rows=31)) == []
