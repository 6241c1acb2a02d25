"""From where browsers see the scene: as their users like, with the body, through its eye, from above."""

from __future__ import annotations

from typing import Any

import numpy as np
from mujoco import MjData, MjModel

from workbench.overlays.frustum import Frustum
from workbench.protocol import CameraView
from workbench.stage import Stage

USUAL_FOV = np.radians(50.0)
"""The vertical field of view of who does not look through the eye [rad]."""
ASIDE = np.radians(10.0)
"""So far from the side it is seen at first: hardly, so that who has passed a doorway is still seen through it."""
RAISED = np.radians(25.0)
"""And from so far above."""


class Cameras:
    """Moves the cameras of all browsers.

    Args:
        server: Viser's server.
        model: The compiled scene.
        eyes: Knows where eyes are, and how wide they see.
    """

    def __init__(self, server: Any, model: MjModel, eyes: Frustum) -> None:
        self._server = server
        self._stage = Stage(model)
        self._eyes = eyes
        self._view: CameraView = "free"
        self._last: Any = None

    def choose(self, view: CameraView, data: MjData) -> None:
        """Sees the scene from elsewhere."""
        before, self._view, self._last = self._view, view, None
        if view == before:
            return
        for client in self._clients():
            if before == "eye":
                client.camera.fov = USUAL_FOV
            if before in ("eye", "top") and view in ("free", "follow"):
                self.place(client, data)
        self.move(data)

    def place(self, client: Any, data: MjData) -> None:
        """Gives a browser that comes a view of the whole stage from behind the body, or the one that is chosen."""
        camera = client.camera
        camera.fov = USUAL_FOV
        camera.up_direction = np.array((0.0, 0.0, 1.0))
        ahead = self._stage.ahead
        level = np.cos(ASIDE) * ahead + np.sin(ASIDE) * np.array((-ahead[1], ahead[0], 0.0))
        self._show_stage(camera, np.array((0.0, 0.0, np.sin(RAISED))) - np.cos(RAISED) * level, data)
        self._move(camera, data, None)

    def move(self, data: MjData) -> None:
        """Moves all cameras with the body, where they are to go with it."""
        base, before = self._stage.base(data), self._last
        self._last = base
        if self._view == "free" or (before is not None and self._view != "eye" and np.array_equal(base, before)):
            return
        for client in self._clients():
            self._move(client.camera, data, before)

    def _move(self, camera: Any, data: MjData, before: Any) -> None:
        if self._view == "follow" and before is not None:
            way = self._stage.base(data) - before
            camera.position, camera.look_at = camera.position + way, camera.look_at + way
        elif self._view == "top":
            # What is ahead is to the right, where windows have most room.
            ahead = self._stage.ahead
            self._show_stage(camera, np.array((0.001 * ahead[1], -0.001 * ahead[0], 1.0)), data)
        elif self._view == "eye":
            self._look_through_eye(camera, data)

    def _look_through_eye(self, camera: Any, data: MjData) -> None:
        """Looks where the eye looks, as high as it sees; how wide a browser sees is up to its window."""
        name, site = next(iter(self._eyes.sites.items()), ("", -1))
        if site < 0:
            return
        place, axes = np.array(data.site_xpos[site]), data.site_xmat[site].reshape(3, 3)
        if name in self._eyes.fields and abs(camera.fov - self._eyes.fields[name][1]) > 1e-6:
            camera.fov = self._eyes.fields[name][1]
        camera.position, camera.look_at, camera.up_direction = place, place + axes[:, 0], axes[:, 2]

    def _show_stage(self, camera: Any, direction: Any, data: MjData) -> None:
        position, look_at = self._stage.seen_from(direction, data, USUAL_FOV, camera.aspect)
        if not (np.allclose(position, camera.position) and np.allclose(look_at, camera.look_at)):
            camera.position, camera.look_at = position, look_at

    def _clients(self) -> list[Any]:
        return list(self._server.get_clients().values())
