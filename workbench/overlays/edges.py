"""Shows the edges that an eye sees as lines in the world, in the colours of the retina."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from mujoco import MjData

from workbench.overlays.contours import contours_of, into_world
from workbench.overlays.overlay import Drawn, Lines, Observed, Overlay, overlay
from workbench.palette import label_colours

if TYPE_CHECKING:
    from actr3d.camera import CameraParameters
    from actr3d.world.body import Body

NEARER = 0.995
"""Edges are drawn at this fraction of their distance to the eye, so that the surfaces on which they lie do not hide them."""


@overlay("edges", "edges seen")
class Edges(Overlay):
    """Shows the edges in the current view of each eye, at their distances."""

    def __init__(self, drawn: Drawn) -> None:
        self._lines = Lines(drawn.server, "/overlays/edges", (0, 0, 0), 2.5)
        self._lines.show(False)

    @staticmethod
    def data(observed: Observed) -> dict[str, Any]:
        """Returns `lines` in the world as 4-byte floats `(n, 2, 3)` [m], and the `labels` of their objects as 8-byte integers."""
        bodies = observed.simulation.world.bodies
        return {name: _edges(body, observed.eyesight(name)) for name, body in bodies.items() if body.eye is not None}

    def draw(self, data: MjData, drawn: dict[str, dict[str, bytes]] | None) -> None:
        """Draws the edges that are seen now."""
        if drawn is not None:
            lines, labels = (b"".join(eye[part] for eye in drawn.values()) for part in ("lines", "labels"))
            colours = label_colours(np.frombuffer(labels, dtype=np.int64))
            self._lines.set(np.frombuffer(lines, dtype=np.float32).reshape(-1, 2, 3), np.repeat(colours[:, None], 2, axis=1))

    def switch(self) -> None:
        """Shows or hides the edges."""
        self._lines.show(self.visible)


def _edges(body: Body, eyesight: CameraParameters) -> dict[str, bytes]:
    from actr3d.camera import glance, stand_of

    lines, labels = contours_of(glance(body, eyesight))
    places = into_world(NEARER * lines, stand_of(body, body.physics.mj_data))
    return {"lines": places.astype(np.float32).tobytes(), "labels": np.array(labels, dtype=np.int64).tobytes()}
