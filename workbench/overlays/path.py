"""Shows the paths that bodies have walked."""

from __future__ import annotations

from typing import Any

import numpy as np
from mujoco import MjData

from workbench.overlays.overlay import Drawn, Lines, Observed, Overlay, overlay

HEIGHT = 0.012
"""Height of the line above the floor [m], so that it is visible."""


@overlay("path", "path walked", shown=True)
class Path(Overlay):
    """Shows the path of each body from the start of the run to the present, whether or not anyone watched."""

    def __init__(self, drawn: Drawn) -> None:
        self._lines = Lines(drawn.server, "/overlays/path", (230, 120, 30), 3.0)
        self._lines.show(False)

    @staticmethod
    def data(observed: Observed) -> dict[str, Any]:
        """Returns the positions of each body's root on the floor [m]."""
        return observed.paths()

    def draw(self, data: MjData, drawn: dict[str, Any] | None) -> None:
        """Draws the paths up to the present."""
        if drawn is None:
            return
        pieces = [np.zeros((0, 2, 3), dtype=np.float32)]
        for way in drawn.values():
            if len(way) > 1:
                places = np.full((len(way), 3), HEIGHT, dtype=np.float32)
                places[:, :2] = way
                pieces.append(np.stack((places[:-1], places[1:]), axis=1))
        self._lines.set(np.concatenate(pieces))

    def switch(self) -> None:
        """Shows or hides the paths."""
        self._lines.show(self.visible)
