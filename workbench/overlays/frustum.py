"""What part of the world an eye looks at."""

from __future__ import annotations

import math
from typing import Any

import mujoco
import numpy as np
from mujoco import MjData, MjModel

from workbench.overlays.overlay import Overlay

SCALE = 0.6
"""How long the pyramid is drawn [m]."""


class Frustum(Overlay):
    """The field of view of each eye.

    Args:
        server: Viser's server.
        model: The compiled scene.
        world: What is in it, as `Facts.world` tells it.
    """

    def __init__(self, server: Any, model: MjModel, world: dict[str, Any]) -> None:
        self._server = server
        eyes = {name: body["eye"] for name, body in world["bodies"].items() if body["eye"] is not None}
        self.sites = {name: mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_SITE, eye) for name, eye in eyes.items()}
        """The numbers of the eyes by body."""
        self.fields: dict[str, tuple[float, float]] = {}
        """How wide and how high each eye sees [rad]."""
        self._handles: dict[str, Any] = {}

    def draw(self, data: MjData, drawn: dict[str, Any] | None) -> None:
        """Moves them with the eyes, whose x points forward and z up; a frustum's z points forward and y down."""
        for number, (name, site) in enumerate(self.sites.items()):
            field = (drawn or {}).get(name)
            if field is not None and tuple(field) != self.fields.get(name):
                self.fields[name] = field[0], field[1]
                aspect = math.tan(field[0] / 2) / math.tan(field[1] / 2)
                self._handles[name] = self._server.scene.add_camera_frustum(
                    f"/overlays/frustum/{number}", fov=field[1], aspect=aspect, scale=SCALE, color=(30, 110, 200), visible=self.visible
                )
            if name in self._handles:
                forward, left, up = data.site_xmat[site].reshape(3, 3).T
                quaternion = np.zeros(4)
                mujoco.mju_mat2Quat(quaternion, np.stack((-left, -up, forward), axis=1).flatten())
                self._handles[name].wxyz, self._handles[name].position = quaternion, np.array(data.site_xpos[site])

    def switch(self) -> None:
        """Shows or hides them."""
        for handle in self._handles.values():
            handle.visible = self.visible
