"""Obstacles and openings that vision has found last, with what it measured."""

from __future__ import annotations

from typing import Any

import numpy as np
from mujoco import MjData

from workbench.overlays.overlay import Lines, Overlay

MOST_LABELS = 24
"""So many labels there are at once."""


class Features(Overlay):
    """The features of each agent's last searches: lines across a gap and at its sides, and a label with the measure.

    What attention was given to is drawn strong, what else was noticed thin.

    Args:
        server: Viser's server.
    """

    def __init__(self, server: Any) -> None:
        self._chosen = Lines(server, "/overlays/features/chosen", (217, 138, 31), 4.0)
        self._noticed = Lines(server, "/overlays/features/noticed", (150, 120, 60), 2.0)
        self.labels: list[dict[str, Any]] = []
        """The labels, each with `text`, `place` [m] and whether attention was given to it (`chosen`); each browser finds room for them."""
        self.switch()

    def draw(self, data: MjData, drawn: dict[str, Any] | None) -> None:
        """Draws what was found last, where it was then."""
        if drawn is None:
            return
        found = [feature for features in drawn.values() for feature in features]
        for lines, chosen in ((self._chosen, True), (self._noticed, False)):
            parts = [line for feature in found if feature["chosen"] is chosen for line in feature["lines"]]
            lines.set(np.array(parts, dtype=np.float32).reshape(-1, 2, 3))
        # Those that attention was given to come first, where there are more than labels.
        first = sorted(found, key=lambda feature: not feature["chosen"])[:MOST_LABELS]
        labels = [{"text": one["text"], "place": [float(x) for x in one["place"]], "chosen": one["chosen"]} for one in first]
        self.labels = [label for label in labels if np.isfinite(label["place"]).all()]

    def switch(self) -> None:
        """Shows or hides them."""
        self._chosen.show(self.visible)
        self._noticed.show(self.visible)
