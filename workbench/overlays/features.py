"""Obstacles and openings that vision has found last, with what it measured."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from mujoco import MjData

from workbench.overlays.overlay import Lines, Overlay

MOST_LABELS = 24
"""So many labels there are at once."""
CLOSE = 0.8
"""Labels that are nearer to each other than this [m] stand one above the other."""
ABOVE = 0.3
"""So far above [m]."""


class Features(Overlay):
    """The features of each mind's last searches: lines across a gap and at its sides, and a label with the measure.

    What attention was given to is drawn strong, what else was noticed thin.

    Args:
        server: Viser's server.
    """

    def __init__(self, server: Any) -> None:
        self._server = server
        self._chosen = Lines(server, "/overlays/features/chosen", (240, 140, 0), 5.0)
        self._noticed = Lines(server, "/overlays/features/noticed", (150, 120, 60), 2.0)
        self._labels: list[Any] = []
        self._used = 0
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
        labelled = sorted(found, key=lambda feature: not feature["chosen"])[:MOST_LABELS]
        while len(self._labels) < len(labelled):
            name = f"/overlays/features/label_{len(self._labels)}"
            self._labels.append(self._server.scene.add_label(name, "", anchor="bottom-center", visible=False))
        self._used = len(labelled)
        for label, feature, place in zip(self._labels, labelled, apart([feature["place"] for feature in labelled]), strict=False):
            if label.text != feature["text"]:
                label.text = feature["text"]
            if tuple(label.position) != place:
                label.position = place
        self._show_labels()

    def switch(self) -> None:
        """Shows or hides them."""
        self._chosen.show(self.visible)
        self._noticed.show(self.visible)
        self._show_labels()

    def _show_labels(self) -> None:
        for number, label in enumerate(self._labels):
            visible = self.visible and number < self._used
            if label.visible != visible:
                label.visible = visible


def apart(places: list[Any]) -> list[tuple[float, ...]]:
    """Returns places of labels at or above the given ones [m], so that none hides another."""
    found: list[tuple[float, ...]] = []
    for x, y, z in places:
        height = float(z)
        near = [other for other in found if math.dist((x, y), other[:2]) < CLOSE]
        while any(abs(other[2] - height) < ABOVE - 1e-9 for other in near):
            height += ABOVE
        found.append((float(x), float(y), height))
    return found
