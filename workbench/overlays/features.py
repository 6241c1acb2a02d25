"""Shows the obstacles and openings that vision has found last, with the measured values."""

from __future__ import annotations

from typing import Any

import numpy as np
from mujoco import MjData

from workbench.overlays.overlay import Lines, Overlay

MOST_LABELS = 24
"""Maximum number of labels."""


class Features(Overlay):
    """Shows the features of each agent's last searches: lines across a gap and at its sides, and a label with the measured value.

    Features that received attention have thick lines, other noticed features thin ones.

    Args:
        server: Viser's server.
    """

    def __init__(self, server: Any) -> None:
        self._chosen = Lines(server, "/overlays/features/chosen", (217, 138, 31), 4.0)
        self._noticed = Lines(server, "/overlays/features/noticed", (150, 120, 60), 2.0)
        self.labels: list[dict[str, Any]] = []
        """The labels, each with `text`, `place` [m] and whether the feature received attention (`chosen`); each browser places them."""
        self.switch()

    def draw(self, data: MjData, drawn: dict[str, Any] | None) -> None:
        """Draws the features found last, at the positions where they were found."""
        if drawn is None:
            return
        found = [feature for features in drawn.values() for feature in features]
        for lines, chosen in ((self._chosen, True), (self._noticed, False)):
            parts = [line for feature in found if feature["chosen"] is chosen for line in feature["lines"]]
            lines.set(np.array(parts, dtype=np.float32).reshape(-1, 2, 3))
        # If there are too many, features that received attention come first.
        first = sorted(found, key=lambda feature: not feature["chosen"])[:MOST_LABELS]
        labels = [{"text": one["text"], "place": [float(x) for x in one["place"]], "chosen": one["chosen"]} for one in first]
        self.labels = [label for label in labels if np.isfinite(label["place"]).all()]

    def switch(self) -> None:
        """Shows or hides the features."""
        self._chosen.show(self.visible)
        self._noticed.show(self.visible)
