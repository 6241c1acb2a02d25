"""The shapes of a compiled scene and how they move, as numbers that a page can draw."""

from __future__ import annotations

import base64
from collections.abc import Iterable
from typing import Any

import mujoco
import numpy as np
from mujoco import MjData, MjModel

from actr3d.errors import RecordingError
from workbench.curves import INTEGRATION

MOST_CORNERS = 1_500_000
"""A scene may have no more corners of triangles than these; three 4-byte numbers each, and a colour."""


def packed(numbers: Any, kind: str) -> str:
    """Returns numbers as text: base64 of their bytes, of a NumPy type such as `<f4`."""
    return base64.b64encode(np.ascontiguousarray(numbers, dtype=kind).tobytes()).decode("ascii")


def shapes_of(model: MjModel) -> list[dict[str, Any]]:
    """Returns what is drawn, one shape a MuJoCo body: its number, corners [m] in its frame, colours, triangles; planes are left out.

    Raises:
        RecordingError: If there is too much.
    """
    from mjviser.conversions import merge_geoms

    shapes: list[dict[str, Any]] = []
    plane = int(mujoco.mjtGeom.mjGEOM_PLANE)
    corners = 0
    for body in range(model.nbody):
        own = (model.geom_bodyid == body) & (model.geom_type != plane) & (model.geom_rgba[:, 3] > 0) & (model.geom_group < 3)
        geoms = np.flatnonzero(own).tolist()
        if not geoms:
            continue
        mesh = merge_geoms(model, geoms)
        corners += len(mesh.vertices) + len(mesh.faces)
        if corners > MOST_CORNERS:
            raise RecordingError("the scene has too many triangles for a replay in one file")
        colours = _colours(mesh, model.geom_rgba[geoms[0]])
        shapes.append(
            {
                "body": body,
                "places": packed(mesh.vertices, "<f4"),
                "colours": packed(colours, "u1"),
                "faces": packed(mesh.faces, "<u4"),
                "clear": bool((colours[:, 3] < 250).any()),
            }
        )
    return shapes


def _colours(mesh: Any, usual: Any) -> Any:
    """Returns a colour for each corner (n, 4), 0 to 255; of textures, that of the geom."""
    kind = getattr(mesh.visual, "kind", None)
    if kind in ("vertex", "face"):
        colours = np.asarray(mesh.visual.vertex_colors)
        if colours.shape == (len(mesh.vertices), 4):
            return colours
    return np.tile(np.clip(np.asarray(usual) * 255, 0, 255).astype(np.uint8), (len(mesh.vertices), 1))


def grounds_of(model: MjModel) -> list[float]:
    """Returns how high the level planes of a scene lie [m]."""
    plane = int(mujoco.mjtGeom.mjGEOM_PLANE)
    return sorted(
        {float(model.geom_pos[geom, 2]) for geom in np.flatnonzero(model.geom_type == plane).tolist() if not model.geom_bodyid[geom]}
    )


def poses_of(model: MjModel, bodies: list[int], states: Iterable[bytes]) -> Any:
    """Returns how bodies stand in some states: places [m] and quaternions, `(states, bodies, 7)`."""
    data = MjData(model)
    poses: list[Any] = []
    for state in states:
        mujoco.mj_setState(model, data, np.frombuffer(state), INTEGRATION)
        mujoco.mj_kinematics(model, data)
        poses.append(np.concatenate((data.xpos[bodies], data.xquat[bodies]), axis=1, dtype=np.float32))
    return np.array(poses, dtype=np.float32).reshape(-1, len(bodies), 7)
