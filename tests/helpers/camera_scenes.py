"""Scenes for tests of the camera, and an oracle that knows only MuJoCo's rays."""

from __future__ import annotations

import importlib
import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from actr3d.camera import CameraParameters, GeometricCamera, View

mujoco: Any = importlib.import_module("mujoco")

Floats = NDArray[np.float64]

JUST = 2e-6
"""Distance from an edge at which the oracle casts rays, as a fraction of the screen: a fiftieth of the promised accuracy."""


def compiled(world: str, assets: str = "", eye: str = "") -> tuple[Any, Any]:
    """Returns model and data of a scene; the site 'eye' looks along x from 1.5 m above the origin by default."""
    eye = eye or '<site name="eye" pos="0 0 1.5"/>'
    mj_model = mujoco.MjModel.from_xml_string(f"<mujoco><asset>{assets}</asset><worldbody>{eye}{world}</worldbody></mujoco>")
    mj_data = mujoco.MjData(mj_model)
    mujoco.mj_forward(mj_model, mj_data)
    return mj_model, mj_data


def seen(world: str, assets: str = "", eye: str = "", **parameters: Any) -> tuple[GeometricCamera, View]:
    """Returns a camera at the site 'eye', and its view."""
    mj_model, mj_data = compiled(world, assets, eye)
    camera = GeometricCamera(mj_model, site="eye", parameters=CameraParameters(**parameters))
    return camera, camera.look(mj_data)


class Oracle:
    """Casts MuJoCo's rays, for flat screens and eyes at the site 'eye'."""

    def __init__(self, mj_model: Any, mj_data: Any, parameters: CameraParameters) -> None:
        self._model, self._data, self._parameters = mj_model, mj_data, parameters

    def look(self, xs: Floats, y: float) -> tuple[list[int], Floats]:
        """Returns the objects hit at places of a scan line, and their distances [m].

        Objects are numbered by a geom's body's root, or below 0 by the geom in the world itself; 0 is nothing.
        """
        p = self._parameters
        u = (2 * xs - 1) * math.tan(p.horizontal_fov / 2)
        v = (1 - 2 * y) * math.tan(p.vertical_fov / 2)
        site = mujoco.mj_name2id(self._model, mujoco.mjtObj.mjOBJ_SITE, "eye")
        forward, left, up = self._data.site_xmat[site].reshape(3, 3).T
        directions = forward + v * up - u[:, None] * left
        directions /= np.linalg.norm(directions, axis=1)[:, None]
        hit, distance = np.full(len(xs), -1, np.int32), np.zeros(len(xs))
        place = self._data.site_xpos[site]
        mujoco.mj_multiRay(self._model, self._data, place, directions.ravel(), None, True, -1, hit, distance, None, len(xs), 1e10)
        hit[distance > (p.range or math.inf)] = -1
        return [self._object(int(geom)) for geom in hit], distance

    def _object(self, geom: int) -> int:
        if geom < 0 or self._model.geom_type[geom] == mujoco.mjtGeom.mjGEOM_PLANE:
            return 0
        root = int(self._model.body_rootid[self._model.geom_bodyid[geom]])
        return root or -1 - geom


def disagreements(mj_model: Any, mj_data: Any, parameters: CameraParameters, samples: int = 1000) -> list[str]:
    """Compares a view with rays: each edge from both sides, the distances there, and every row at many places."""
    camera = GeometricCamera(mj_model, site="eye", parameters=parameters)
    view = camera.look(mj_data).as_dict()
    oracle = Oracle(mj_model, mj_data, parameters)
    known: dict[int, int] = {}
    wrong: list[str] = []
    for y, row in view.items():
        extents = sorted((extent, label) for label, some in row.items() for extent in some)
        wrong += _wrong_edges(oracle, y, extents, known)
        xs = np.linspace(0, 1, samples, endpoint=False) + 1e-7
        objects, _ = oracle.look(xs, y)
        for x, found in zip(xs, objects, strict=True):
            labels = [label for (x1, x2, *_), label in extents if x1 <= x <= x2]
            close = any(min(abs(x - x1), abs(x - x2)) < JUST for (x1, x2, *_), _ in extents)
            if not close and [known.get(label) for label in labels] != ([found] if found else []):
                wrong.append(f"y={y} x={x}: {labels} {[known.get(label) for label in labels]}, but rays hit {found}")
    return wrong


def _wrong_edges(oracle: Oracle, y: float, extents: list[tuple[list[float], int]], known: dict[int, int]) -> list[str]:
    """Compares the edges of one row's extents with rays beside them; records which label belongs to which object."""
    wrong: list[str] = []
    for (x1, x2, d1, d2, *_), label in extents:
        step = min(JUST, (x2 - x1) / 4)
        hits, _ = oracle.look(np.array([x1 - step, x1 + step, 0.5 * (x1 + x2), x2 - step, x2 + step]), y)
        thing = known.setdefault(label, hits[2])
        if hits[1] != thing or hits[2] != thing or hits[3] != thing or thing == 0:
            wrong.append(f"y={y} label {label} [{x1}, {x2}]: rays hit {hits}, not {thing}")
        if (hits[0] == thing and x1 > JUST) or (hits[4] == thing and x2 < 1 - JUST):
            wrong.append(f"y={y} label {label} [{x1}, {x2}]: continues beyond its edges: {hits}")
        for seen_distance, hit, distance in zip((d1, d2), *oracle.look(np.array([x1 + 1e-9, x2 - 1e-9]), y), strict=True):
            if hit == thing and abs(seen_distance - distance) > 1e-3 * max(1.0, seen_distance / 5):
                wrong.append(f"y={y} label {label} [{x1}, {x2}]: distance {seen_distance}, but rays say {distance}")
    return wrong
