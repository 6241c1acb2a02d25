"""Shows the paths that bodies have walked."""

from __future__ import annotations

from itertools import chain
from typing import Any

import numpy as np
from mujoco import MjData

from workbench.overlays.overlay import Lines, Observed, Overlay, OverlayCanvas, overlay

HEIGHT = 0.012
"""Height of the line above the floor [m], so that it is visible."""


@overlay("path", "path walked", shown=True)
class WalkedPaths(Overlay):
    """Shows the path of each body from the start of the run to the present, whether or not anyone watched, with a gap where it was moved by
    hand."""

    def __init__(self, canvas: OverlayCanvas) -> None:
        self._lines = Lines(canvas.server, "/overlays/path", (230, 120, 30), 3.0)
        self.drawn = (self._lines,)
        self.switch()

    @staticmethod
    def data(observed: Observed) -> dict[str, Any]:
        """Returns the pieces of each body's path: positions of its root on the floor [m]."""
        return observed.paths()

    def draw(self, data: MjData, by_body: dict[str, Any] | None) -> None:
        """Draws the paths up to the present."""
        if by_body is None:
            return
        pieces = [np.zeros((0, 2, 3), dtype=np.float32)]
        for piece in chain.from_iterable(by_body.values()):
            places = np.full((len(piece), 3), HEIGHT, dtype=np.float32)
            places[:, :2] = piece
            pieces.append(np.stack((places[:-1], places[1:]), axis=1))
        self._lines.set(np.concatenate(pieces))
