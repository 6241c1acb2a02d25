"""Shows the part of the world that is in an eye's field of view."""

from __future__ import annotations

import math
from typing import Any

import mujoco
import numpy as np
from mujoco import MjData, MjModel

from workbench.overlays.overlay import Observed, Overlay, OverlayCanvas, overlay

SCALE = 0.6
"""Length of the drawn pyramid [m]."""
MIN_HEAD = 0.05
"""Minimum radius of a head [m]; what is smaller is an eyeball or the like."""
COLOUR = (91, 127, 166)


@overlay("frustum", "field of view")
class Frustum(Overlay):
    """Shows the field of view of each eye."""

    def __init__(self, canvas: OverlayCanvas) -> None:
        model = canvas.model
        self._server = canvas.server
        bodies = {name: canvas.world["bodies"][name] for name in (*canvas.world["agents"], *canvas.world["bodies"])}
        eyes = {name: body["eye"] for name, body in bodies.items() if body["eye"] is not None}
        self.sites = {name: mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_SITE, eye) for name, eye in eyes.items()}
        """The site numbers of the eyes, by body; those of agents first."""
        self.fields: dict[str, tuple[float, float]] = {}
        """The horizontal and vertical field of view of each eye [rad]."""
        self._handles: dict[str, Any] = {}
        self._heads = [geom for site in self.sites.values() if (geom := _head(model, site)) is not None]
        self._sizes = model.geom_rbound

    @staticmethod
    def data(observed: Observed) -> dict[str, Any]:
        """Returns the horizontal and vertical field of view [rad] of each body with an eye."""
        seeing = [name for name, body in observed.simulation.world.bodies.items() if body.eye is not None]
        return {name: [observed.eyesight(name).horizontal_fov, observed.eyesight(name).vertical_fov] for name in seeing}

    def draw(self, data: MjData, by_body: dict[str, Any] | None) -> None:
        """Moves the frustums with the eyes. An eye's x axis points forward and z up; a frustum's z axis points forward and y down."""
        for number, (name, site) in enumerate(self.sites.items()):
            field = (by_body or {}).get(name)
            if field is not None and tuple(field) != self.fields.get(name):
                self.fields[name] = field[0], field[1]
                aspect = math.tan(field[0] / 2) / math.tan(field[1] / 2)
                self._handles[name] = self._server.scene.add_camera_frustum(
                    f"/overlays/frustum/{number}",
                    fov=field[1],
                    aspect=aspect,
                    scale=SCALE,
                    thickness=1.2,
                    thickness_units="screen",
                    color=COLOUR,
                    cast_shadow=False,
                    visible=self.visible,
                )
            if name in self._handles:
                forward, left, up = data.site_xmat[site].reshape(3, 3).T
                quaternion = np.zeros(4)
                mujoco.mju_mat2Quat(quaternion, np.stack((-left, -up, forward), axis=1).flatten())
                self._handles[name].wxyz, self._handles[name].position = quaternion, np.array(data.site_xpos[site])

    def eye(self, data: MjData) -> dict[str, Any] | None:
        """Returns the position, direction and vertical field of view [rad] of the first eye; None if there is none."""
        name, site = next(iter(self.sites.items()), ("", -1))
        if site < 0 or name not in self.fields:
            return None
        axes = data.site_xmat[site].reshape(3, 3)
        pose = {"place": data.site_xpos[site], "forward": axes[:, 0], "up": axes[:, 2]}
        return {**{key: value.round(5).tolist() for key, value in pose.items()}, "fov": self.fields[name][1]}

    def heads(self, data: MjData) -> list[list[float]]:
        """Returns the spheres around the heads that carry eyes, which labels must not cover: x, y, z, radius [m]."""
        return [[*data.geom_xpos[geom].round(3).tolist(), round(float(self._sizes[geom]), 3)] for geom in self._heads]

    def switch(self) -> None:
        """Shows or hides the fields of view."""
        for handle in self._handles.values():
            handle.visible = self.visible


def _head(model: MjModel, site: int) -> int | None:
    """Returns the visible geom nearest to an eye that is large enough for a head, on its body part or a part that carries it.

    Returns None if there is none.
    """
    data = MjData(model)
    mujoco.mj_kinematics(model, data)
    body = int(model.site_bodyid[site]) if site >= 0 else 0
    while body > 0:
        own = np.flatnonzero((model.geom_bodyid == body) & (model.geom_rgba[:, 3] > 0) & (model.geom_rbound >= MIN_HEAD))
        if own.size:
            return int(own[np.argmin(np.linalg.norm(data.geom_xpos[own] - data.site_xpos[site], axis=1))])
        body = int(model.body_parentid[body])
    return None
