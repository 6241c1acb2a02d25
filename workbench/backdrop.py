"""Draws the surroundings of a scene: lights, the ground, the outlines of walls, and soft shadows on the ground."""

from __future__ import annotations

from typing import Any

import mujoco
import numpy as np
from mujoco import MjData, MjModel, mjtGeom

from workbench.overlays.overlay import Lines
from workbench.scene_colours import channels, palette

LIGHTS = (((-4.0, -6.0, 10.0), 2.4), ((-6.0, 6.0, 2.0), 2.0), ((6.0, 2.0, 3.0), 1.2))
"""The positions of the directional lights and their intensities: the first casts the shadows, the others brighten the sides.

They light only the picture on the page; the lights of the scene's MuJoCo model are not used here.
"""
HIGHEST = 2.0
"""Shapes higher above the ground than this [m] cast no soft shadow on it."""
DARKEST, FADING = 0.36, 0.45
"""The darkness of the shadow of a shape that touches the ground, and the height [m] at which it falls to about a third (1/e)."""
SOFT, SOFTER = 0.1, 0.4
"""How far a shadow extends beyond its shape [m], and how much farther for each metre above the ground."""
MAX_SHADES = 64
MAX_OUTLINES = 200
MIN_OUTLINED = 0.5
"""Boxes whose longest side is shorter than this [m] have no outline."""
CORNERS = np.array([[x, y, z] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], dtype=float)
EDGES = np.array([(a, b) for a in range(8) for b in range(a) if np.abs(CORNERS[a] - CORNERS[b]).sum() == 2])


def light(client: Any, *, shadows: bool) -> None:
    """Lights the scene of one browser from three sides.

    Args:
        client: Viser's client.
        shadows: Whether shapes cast shadows, which takes half the time of a browser without a graphics card.
    """
    with client.atomic():
        client.scene.configure_default_lights(enabled=False, cast_shadow=False)
        for number, (place, intensity) in enumerate(LIGHTS):
            client.scene.add_light_directional(f"/light/{number}", intensity=intensity, position=place, cast_shadow=shadows and not number)


def lay_grounds(server: Any, model: MjModel) -> list[str]:
    """Replaces the planes of a scene by a soft ground and returns their names in viser's tree.

    Their colours depend on the theme, which each browser sets for itself.
    """
    from mjviser.conversions import get_body_name

    colours = palette()["light"]
    names: list[str] = []
    for geom in np.flatnonzero(model.geom_type == mjtGeom.mjGEOM_PLANE).tolist():
        body = int(model.geom_bodyid[geom])
        if model.body_weldid[body] or model.body_mocapid[body] >= 0:
            continue
        name = f"/fixed_bodies/{get_body_name(model, body)}/{mujoco.mj_id2name(model, mujoco.mjtObj.mjOBJ_GEOM, geom)}"
        names.append(name)
        server.scene.add_grid(
            name,
            infinite_grid=True,
            fade_distance=60.0,
            cell_size=1.0,
            section_size=5.0,
            cell_thickness=0.7,
            section_thickness=0.9,
            cell_color=channels(colours["line"]),
            section_color=channels(colours["line"]),
            plane_color=channels(colours["ground"]),
            plane_opacity=1.0,
            shadow_opacity=0.2,
            position=model.geom_pos[geom],
            wxyz=model.geom_quat[geom],
        )
    return names


class Outlines:
    """Draws the edges of large immovable boxes such as walls, so that they look like parts of a building."""

    def __init__(self, server: Any, model: MjModel) -> None:
        standing = (model.geom_type == mjtGeom.mjGEOM_BOX) & (model.geom_rgba[:, 3] > 0) & (model.geom_group < 3)
        standing &= (model.body_weldid[model.geom_bodyid] == 0) | (model.body_mocapid[model.body_rootid[model.geom_bodyid]] >= 0)
        standing &= model.geom_size.max(axis=1) * 2 > MIN_OUTLINED
        self._geoms = np.flatnonzero(standing)[:MAX_OUTLINES]
        self._corners = CORNERS * model.geom_size[self._geoms][:, None, :]
        self._lines = Lines(server, "/outlines", channels(palette()["outline"]), 1.2)

    def draw(self, data: MjData) -> None:
        """Draws the outlines at the current poses of the boxes."""
        if not len(self._geoms):
            return
        turned = data.geom_xmat[self._geoms].reshape(-1, 3, 3)
        places = np.einsum("nij,nkj->nki", turned, self._corners) + data.geom_xpos[self._geoms][:, None, :]
        self._lines.set(places[:, EDGES].reshape(-1, 2, 3).astype(np.float32))


class Shades:
    """Computes soft shadows on the ground under shapes that are on it or near it.

    Args:
        model: The compiled scene.
        ground: The height of the ground [m].
    """

    def __init__(self, model: MjModel, ground: float) -> None:
        self._ground = ground
        shown = (model.geom_type != mjtGeom.mjGEOM_PLANE) & (model.geom_rgba[:, 3] > 0) & (model.geom_group < 3)
        self._geoms = np.flatnonzero(shown)
        self._boxes = model.geom_aabb[self._geoms]

    def quads(self, data: MjData) -> list[list[float]]:
        """Returns the darkest shadows: x, y, direction of the first side (cosine, sine), two half sides, softness [m], darkness."""
        turned = data.geom_xmat[self._geoms].reshape(-1, 3, 3)
        middle = data.geom_xpos[self._geoms] + np.einsum("nij,nj->ni", turned, self._boxes[:, :3])
        sides = turned * self._boxes[:, None, 3:]  # half sides, as columns
        low = middle[:, 2] - np.abs(sides[:, 2]).sum(axis=1) - self._ground
        under = np.maximum(low, 0)
        dark = DARKEST * np.exp(-under / FADING) * ((low > -HIGHEST) & (low < HIGHEST))
        chosen = np.argsort(-dark, kind="stable")[:MAX_SHADES]
        chosen = chosen[dark[chosen] > 0.01]
        sides, flat = sides[chosen], np.linalg.norm(sides[chosen][:, :2], axis=1)
        longest = sides[np.arange(len(chosen)), :2, flat.argmax(axis=1)]
        length = np.linalg.norm(longest, axis=1, keepdims=True)
        along = np.divide(longest, length, out=np.tile((1.0, 0.0), (len(chosen), 1)), where=length > 1e-9)
        across = np.stack((-along[:, 1], along[:, 0]), axis=1)
        halves = [np.abs(np.einsum("ni,nij->nj", way, sides[:, :2])).sum(axis=1) for way in (along, across)]
        numbers = np.column_stack((middle[chosen, :2], along, *halves, SOFT + SOFTER * under[chosen], dark[chosen]))
        return numbers.round(3).tolist()
