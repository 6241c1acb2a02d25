"""The edges that an eye sees, as lines in the world."""

from __future__ import annotations

from typing import Any

import numpy as np
from mujoco import MjData

from workbench.overlays.overlay import Lines, Overlay


class Edges(Overlay):
    """The edges of the present view of each eye, at their distances.

    Args:
        server: Viser's server.
    """

    def __init__(self, server: Any) -> None:
        self._lines = Lines(server, "/overlays/edges", (200, 30, 90), 2.0)
        self._lines.show(False)

    def draw(self, data: MjData, drawn: dict[str, bytes] | None) -> None:
        """Draws what is seen now."""
        if drawn is not None:
            self._lines.set(np.frombuffer(b"".join(drawn.values()), dtype=np.float32).reshape(-1, 2, 3))

    def switch(self) -> None:
        """Shows or hides them."""
        self._lines.show(self.visible)
