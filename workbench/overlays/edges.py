"""Shows the edges that an eye sees as lines in the world."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np
from mujoco import MjData

from workbench.overlays.contours import contours_of, into_world
from workbench.overlays.overlay import Lines, Observed, Overlay, OverlayCanvas, overlay

if TYPE_CHECKING:
    from actr3d.camera import CameraParameters
    from actr3d.world.body import Body

COLOUR = (46, 110, 180)
NEARER = 0.995
"""Edges are drawn at this fraction of their distance to the eye, so that the surfaces on which they lie do not hide them."""


@overlay("edges", "edges seen")
class Edges(Overlay):
    """Shows the edges in the current view of each eye, at their distances."""

    def __init__(self, canvas: OverlayCanvas) -> None:
        self._lines = Lines(canvas.server, "/overlays/edges", COLOUR, 2.5)
        self.drawn = (self._lines,)
        self.switch()

    @staticmethod
    def data(observed: Observed) -> dict[str, bytes]:
        """Returns lines in the world as 4-byte floats `(n, 2, 3)` [m]."""
        bodies = observed.simulation.world.bodies
        return {name: _edges(body, observed.eyesight(name)) for name, body in bodies.items() if body.eye is not None}

    def draw(self, data: MjData, by_body: dict[str, bytes] | None) -> None:
        """Draws the edges that are seen now."""
        if by_body is not None:
            self._lines.set(np.frombuffer(b"".join(by_body.values()), dtype=np.float32).reshape(-1, 2, 3))


def _edges(body: Body, eyesight: CameraParameters) -> bytes:
    from actr3d.camera import eye_pose_of, view_for_observer

    places = into_world(NEARER * contours_of(view_for_observer(body, eyesight)), eye_pose_of(body, body.physics.mj_data))
    return places.astype(np.float32).tobytes()
