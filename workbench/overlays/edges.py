"""Shows the edges that an eye sees as lines in the world, in the colours of the retina."""

from __future__ import annotations

from typing import Any

import numpy as np
from mujoco import MjData

from workbench.overlays.overlay import Lines, Overlay
from workbench.palette import label_colours


class Edges(Overlay):
    """Shows the edges in the current view of each eye, at their distances.

    Args:
        server: Viser's server.
    """

    def __init__(self, server: Any) -> None:
        self._lines = Lines(server, "/overlays/edges", (0, 0, 0), 2.5)
        self._lines.show(False)

    def draw(self, data: MjData, drawn: dict[str, dict[str, bytes]] | None) -> None:
        """Draws the edges that are seen now."""
        if drawn is not None:
            lines, labels = (b"".join(eye[part] for eye in drawn.values()) for part in ("lines", "labels"))
            colours = label_colours(np.frombuffer(labels, dtype=np.int64))
            self._lines.set(np.frombuffer(lines, dtype=np.float32).reshape(-1, 2, 3), np.repeat(colours[:, None], 2, axis=1))

    def switch(self) -> None:
        """Shows or hides the edges."""
        self._lines.show(self.visible)
