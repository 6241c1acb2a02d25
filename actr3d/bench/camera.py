"""`actr3d bench camera`: measures the cost of a view, relative to MuJoCo's rays in the same scene."""

from __future__ import annotations

from collections.abc import Callable
from statistics import median
from typing import Any

import mujoco
import numpy as np

from actr3d.benchmark import Measurement, benchmark, little_garbage, ratio, seconds_of
from actr3d.camera import GeometricCamera

RAYS = 10_000
SHAPES = {"box": 3, "sphere": 1, "capsule": 2, "cylinder": 2, "ellipsoid": 3}
"""Types of geoms, and the number of sizes each has."""
APERTURE = '<geom type="box" pos="4 2.5 1.25" size=".1 2 1.25"/><geom type="box" pos="4 -2.5 1.25" size=".1 2 1.25"/>'
SCENES = 5
"""The number of random scenes of each kind; figures are medians over them."""


def _loose(count: int, seed: int) -> str:
    """Returns `count` loose objects of mixed types, placed at random on the floor before and behind the aperture."""
    random = np.random.default_rng(seed)
    things: list[str] = []
    for i in range(count):
        kind = list(SHAPES)[i % len(SHAPES)]
        size = random.uniform(0.1, 0.3, 3)
        height = {"box": size[2], "sphere": size[0], "capsule": size[0] + size[1], "cylinder": size[1], "ellipsoid": size[2]}[kind]
        x, y = random.uniform((1.5, -4), (9, 4))
        sizes = " ".join(f"{value:.3f}" for value in size[: SHAPES[kind]])
        turn = random.uniform(0, 90)
        things.append(f'<body pos="{x} {y} {height}" euler="0 0 {turn}"><freejoint/><geom type="{kind}" size="{sizes}"/></body>')
    return "".join(things)


def _mannequin(seed: int) -> str:
    """Returns a body of twenty parts."""
    random = np.random.default_rng(seed)
    kinds = ["capsule", "box", "ellipsoid", "sphere"]
    parts = [
        f'<geom type="{kinds[i % 4]}" size=".08 .15 .1" pos="{random.uniform(-0.15, 0.15)} {random.uniform(-0.4, 0.4)} {0.1 + 0.09 * i}"/>'
        for i in range(20)
    ]
    return f'<body pos="3 0 0">{"".join(parts)}</body>'


def _ring() -> str:
    """Returns a ring-shaped mesh of 10,000 triangles."""
    rings, sides = 100, 50
    i, j = np.meshgrid(np.arange(rings), np.arange(sides), indexing="ij")
    a, b = i * 2 * np.pi / rings, j * 2 * np.pi / sides
    vertices = np.stack(((0.5 + 0.2 * np.cos(b)) * np.cos(a), (0.5 + 0.2 * np.cos(b)) * np.sin(a), 0.2 * np.sin(b)), axis=-1)
    after, beside = (i + 1) % rings, (j + 1) % sides
    corners = [i * sides + j, after * sides + j, after * sides + beside, i * sides + beside]
    faces = np.stack([corners[n] for n in (0, 1, 2, 0, 2, 3)], axis=-1)
    vertex = " ".join(f"{value:.6f}" for value in vertices.ravel().tolist())
    return f'<mesh name="ring" vertex="{vertex}" face="{" ".join(str(corner) for corner in faces.ravel().tolist())}"/>'


def _scene(things: str, assets: str = "") -> tuple[Any, Any]:
    """Returns the model and data of a scene with a floor and an eye at 1.6 m."""
    floor = '<geom type="plane" size="0 0 .1"/><site name="eye" pos="0 0 1.6"/>'
    mj_model = mujoco.MjModel.from_xml_string(f"<mujoco><asset>{assets}</asset><worldbody>{floor}{things}</worldbody></mujoco>")
    mj_data = mujoco.MjData(mj_model)
    mujoco.mj_forward(mj_model, mj_data)
    return mj_model, mj_data


def _view_cost(mj_model: Any, mj_data: Any) -> Callable[[], float]:
    """Returns a function that measures one default view [s]."""
    camera = GeometricCamera(mj_model, site="eye")
    camera.look(mj_data)

    def look() -> None:
        for _ in range(20):
            camera.look(mj_data)

    return lambda: min(seconds_of(look) for _ in range(3)) / 20


def _ray_cost(mj_model: Any, mj_data: Any) -> Callable[[], float]:
    """Returns a function that measures the cost per ray of many rays cast at once over the default view [s]."""
    random = np.random.default_rng(0)
    tangents = random.uniform((-1, -np.tan(np.pi / 6)), (1, np.tan(np.pi / 6)), (RAYS, 2))
    directions = np.column_stack((np.ones(RAYS), tangents)).ravel()
    geoms, distances = np.zeros(RAYS, np.int32), np.zeros(RAYS)
    eye = mj_data.site_xpos[0]

    def shoot() -> None:
        mujoco.mj_multiRay(mj_model, mj_data, eye, directions, None, True, -1, geoms, distances, None, RAYS, 1e10)

    return lambda: min(seconds_of(shoot) for _ in range(3)) / RAYS


def _in_rays(scenes: list[tuple[Any, Any]]) -> float:
    """Returns the cost of a view, in rays of the same scene."""
    return median(ratio(_view_cost(*scene), _ray_cost(*scene)) for scene in scenes)


def _more(many: list[tuple[Any, Any]], few: list[tuple[Any, Any]]) -> float:
    """Returns the cost of a view of scenes with many objects, relative to scenes with few."""
    return median(ratio(_view_cost(*large), _view_cost(*small)) for large, small in zip(many, few, strict=True))


@benchmark("camera")
def measure() -> list[Measurement]:
    """Measures the cost of a view, relative to MuJoCo's rays in the same scene."""
    few, many = ([_scene(APERTURE + _loose(count, seed)) for seed in range(SCENES)] for count in (10, 100))
    open_few, open_many = ([_scene(_loose(count, seed)) for seed in range(SCENES)] for count in (10, 100))
    body = [_scene(_mannequin(seed)) for seed in range(SCENES)]
    mesh = [_scene('<geom type="mesh" mesh="ring" pos="2 0 1.5" euler="30 50 0"/>', _ring())]
    what, more = "single rays of mj_multiRay for a default view", "times a view of 10"
    with little_garbage():
        return [
            Measurement(name="aperture, 10 objects", value=_in_rays(few), sense="at most", limit=RAYS, what=what),
            Measurement(name="aperture, 100 objects", value=_in_rays(many), sense="at most", limit=RAYS, what=what),
            Measurement(name="crowd without walls, 100 objects", value=_in_rays(open_many), sense="at most", limit=RAYS, what=what),
            Measurement(name="body of 20 parts", value=_in_rays(body), sense="at most", limit=RAYS, what=what),
            Measurement(name="mesh, 10,000 triangles", value=_in_rays(mesh), sense="at most", limit=RAYS, what=what),
            Measurement(name="100 objects", value=_more(many, few), sense="at most", limit=3, what=more),
            Measurement(name="100 objects without walls", value=_more(open_many, open_few), sense="at most", limit=3, what=more),
        ]
