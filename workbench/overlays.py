"""What can be drawn over the 3D scene, each to be switched on and off: one class an overlay."""

from __future__ import annotations

import math
from typing import Any

import mujoco
import numpy as np
from mujoco import MjData, MjModel

from workbench.worker.messages import State

PATH_STEP = 0.02
"""A path gets a new point when the body has moved so far [m]."""
MOST_POINTS = 4_000
"""A path has no more points than these; then every second one is left out."""


class Overlay:
    """Something drawn over the scene.

    Args:
        server: Viser's server.
        visible: Whether it is shown at first.
    """

    site: int | None = None
    """The eye that it belongs to, if any."""

    def __init__(self, server: Any, visible: bool) -> None:
        self.visible = visible
        self._server = server
        self._handle: Any = None

    def draw(self, data: MjData, state: State) -> None:
        """Draws it as it is now."""

    def show(self, visible: bool) -> None:
        """Shows or hides it."""
        self.visible = visible
        if self._handle is not None:
            self._handle.visible = visible


class Frustum(Overlay):
    """The part of the world that an eye looks at.

    Args:
        server: Viser's server.
        body: The body's name.
        site: The number of its eye.
    """

    def __init__(self, server: Any, body: str, site: int) -> None:
        super().__init__(server, visible=True)
        self.site = site
        # The default field of view of `CameraParameters`: 90 degrees wide, 60 high.
        aspect = math.tan(math.pi / 4) / math.tan(math.pi / 6)
        self._handle = server.scene.add_camera_frustum(
            f"/overlays/{body}/eye", fov=math.pi / 3, aspect=aspect, scale=0.3, color=(30, 110, 200)
        )

    def draw(self, data: MjData, state: State) -> None:
        """Moves it with the eye, whose x points forward and z up; a frustum's z points forward and y down."""
        forward, left, up = data.site_xmat[self.site].reshape(3, 3).T
        quaternion = np.zeros(4)
        mujoco.mju_mat2Quat(quaternion, np.stack((-left, -up, forward), axis=1).flatten())
        self._handle.wxyz, self._handle.position = quaternion, np.array(data.site_xpos[self.site])


class Path(Overlay):
    """The way that a body has come, as far as it was shown.

    Args:
        server: Viser's server.
        body: The body's name.
        root: The number of its MuJoCo body.
    """

    def __init__(self, server: Any, body: str, root: int) -> None:
        super().__init__(server, visible=True)
        self._name = f"/overlays/{body}/path"
        self._root = root
        self._points: list[tuple[float, Any]] = []
        """Times [s] and places."""

    def draw(self, data: MjData, state: State) -> None:
        """Adds where the body is now, and takes back what lies ahead where the run has gone back."""
        place = np.array((data.xpos[self._root][0], data.xpos[self._root][1], 0.01))
        count = len(self._points)
        while self._points and self._points[-1][0] > state.time:
            self._points.pop()
        moved = not self._points or float(np.linalg.norm(place - self._points[-1][1])) > PATH_STEP
        if moved:
            self._points.append((state.time, place))
        if len(self._points) > MOST_POINTS:
            self._points = self._points[::2]
        if (moved or len(self._points) != count) and len(self._points) > 1:
            places = np.array([point for _, point in self._points], dtype=np.float32)
            lines = np.stack((places[:-1], places[1:]), axis=1)
            self._handle = self._server.scene.add_line_segments(
                self._name, points=lines, colors=(230, 120, 30), line_width=3.0, visible=self.visible
            )


def make_overlays(server: Any, model: MjModel, world: dict[str, Any]) -> dict[str, Overlay]:
    """Returns the overlays of a scene by the names under which they are switched."""
    overlays: dict[str, Overlay] = {}
    for name, body in world["bodies"].items():
        site = -1 if body["eye"] is None else mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_SITE, body["eye"])
        if site >= 0:
            overlays[f"eye of {name}"] = Frustum(server, name, site)
        overlays[f"path of {name}"] = Path(server, name, body["root"])
    return overlays
