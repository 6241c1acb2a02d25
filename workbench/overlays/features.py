"""Shows the obstacles and openings that vision has found last, with the measured values."""

from __future__ import annotations

import math
from itertools import groupby, islice
from typing import TYPE_CHECKING, Any

import numpy as np
from mujoco import MjData

from workbench.overlays.contours import Places, into_world, points_of
from workbench.overlays.overlay import Lines, Observed, Overlay, OverlayCanvas, overlay
from workbench.time_text import time_text

if TYPE_CHECKING:
    from actr3d.actr.kernel.model import Model
    from actr3d.camera import View
    from actr3d.vision import Feature, Opening, Sighting
    from actr3d.world.body import Body

MAX_LABELS = 24
MAX_DRAWN = 24
"""Maximum number of features of one search that are drawn."""
DIAMOND = 0.08
"""Half the height of the mark of a feature without a size [m]."""
OLD = 1.0
"""Age from which a label says when its feature was seen [s]: the agent may have moved on since, and the world have changed."""
MIN_HEIGHT = 0.01
"""Minimum height at which an obstacle without a height is drawn [m]."""


@overlay("features", "obstacles and openings", shown=True)
class Features(Overlay):
    """Shows the features of each agent's last searches: lines across a gap and at its sides, and a label with the measured value.

    Features that received attention have thick lines, other noticed features thin ones.
    """

    def __init__(self, canvas: OverlayCanvas) -> None:
        server = canvas.server
        self._chosen = Lines(server, "/overlays/features/chosen", (217, 138, 31), 4.0)
        self._noticed = Lines(server, "/overlays/features/noticed", (150, 120, 60), 2.0)
        self.drawn = (self._chosen, self._noticed)
        self.switch()

    @staticmethod
    def data(observed: Observed) -> dict[str, Any]:
        """Returns the features that each agent's last searches have found, see `drawn_features`."""
        agents, bodies = observed.simulation.agents, observed.simulation.world.bodies
        return {name: drawn_features(agents[name], body) if name in agents else [] for name, body in bodies.items()}

    def draw(self, data: MjData, by_body: dict[str, Any] | None) -> None:
        """Draws the features found last, at the positions where they were found."""
        if by_body is None:
            return
        found = [feature for features in by_body.values() for feature in features]
        for lines, chosen in ((self._chosen, True), (self._noticed, False)):
            parts = [line for feature in found if feature["chosen"] is chosen for line in feature["lines"]]
            lines.set(np.array(parts, dtype=np.float32).reshape(-1, 2, 3))
        # If there are too many, features that received attention come first.
        first = sorted(found, key=lambda feature: not feature["chosen"])[:MAX_LABELS]
        labels = [
            {"text": one["text"], "place": [float(x) for x in one["place"]], "line": one["lines"][0], "chosen": one["chosen"]}
            for one in first
        ]
        self.labels = [label for label in labels if np.isfinite(label["place"]).all()]


def drawn_features(agent: Model, body: Body) -> list[dict[str, Any]]:
    """Returns the features found in an agent's last searches: `text`, `place`, `lines`, and whether the agent has `chosen` it."""
    from actr3d.vision import sightings

    drawn: list[dict[str, Any]] = []
    for _, search in groupby(sightings(agent, body), key=lambda one: (one.module, one.bottom_up)):
        found = list(islice(search, MAX_DRAWN))
        points = points_of(found[0].view)
        for sighting in found:
            lines = _outline(sighting, points)
            place = lines[0].mean(axis=0).tolist()
            ago = f", seen at {time_text(sighting.time, 2)}" if agent.now() - sighting.time > OLD else ""
            drawn.append({"text": _text(sighting.feature) + ago, "place": place, "lines": lines.tolist(), "chosen": sighting.chosen})
    return drawn


def _text(feature: Feature) -> str:
    """Returns a label with the measured values; sizes below one metre are in centimetres."""
    from actr3d.vision import Opening

    width, distance = getattr(feature, "width", None), f"{feature.distance:.1f} m away"
    if not isinstance(width, (int, float)) or not math.isfinite(width):
        return f"{feature.called()} {distance}"
    size = f"{100 * width:.0f} cm" if width < 1 else f"{width:.2f} m"
    return f"{feature.called()} {size}" if isinstance(feature, Opening) else f"{feature.called()} {size}, {distance}"


def _outline(sighting: Sighting, points: Places) -> Places:
    """Returns the lines that show a feature, `(n, 2, 3)`; the first is the measured one.

    An opening has a line across it and its two sides. If its edges are not found, it is drawn perpendicular to the line of sight. An
    obstacle has an upright line at its nearest point. For the features of a model's own detectors, see `_frame`. `points` are those of the
    view, from `points_of`.
    """
    from actr3d.vision import Obstacle, Opening

    upper_left, upper_right, lower_right, lower_left = np.array(sighting.corners)
    if isinstance(sighting.feature, Obstacle):
        lower, upper = (lower_left + lower_right) / 2, (upper_left + upper_right) / 2
        upper[2] = max(upper[2], lower[2] + MIN_HEIGHT)
        return np.array([[lower, upper]])
    if not isinstance(sighting.feature, Opening):
        return _frame(sighting)
    sides = np.array([[lower_left, upper_left], [lower_right, upper_right]])
    edges = _edges(sighting.feature, sighting.view, points)
    if edges is not None:
        sides[..., :2] = into_world(edges, sighting.eye_pose)[:, None, :2]
    return np.array([sides.mean(axis=1), *sides])


def _frame(sighting: Sighting) -> Places:
    """Returns a rectangle with the width and height of a feature; a line if only one of them is known, a small diamond if neither is."""
    corners = np.array(sighting.corners)
    wide, high = bool((corners[0] != corners[1]).any()), bool(corners[0, 2] > corners[2, 2])
    if wide != high:
        return np.array([[corners[0], corners[2]]])
    if not wide:
        way = sighting.eye_pose.heading + sighting.feature.direction
        up, aside = np.array((0.0, 0.0, DIAMOND)), DIAMOND * np.array((-math.sin(way), math.cos(way), 0.0))
        corners = corners.mean(axis=0) + np.array((up, aside, -up, -aside))
    return np.stack((corners, np.roll(corners, -1, axis=0)), axis=1)


def _edges(opening: Opening, view: View, points: Places) -> Places | None:
    """Returns the left and right edge points between which an opening's middle was measured, relative to the eye, `(2, 3)`."""
    labels, rows = view.extents["label"], view.extents["row"]
    lefts, rights = np.flatnonzero(labels == opening.left), np.flatnonzero(labels == opening.right)
    one, other = (index.ravel() for index in np.meshgrid(lefts, rights))
    same = rows[one] == rows[other]
    one, other = one[same], other[same]
    if not len(one):
        return None
    middle = opening.distance * np.array((math.cos(opening.direction), math.sin(opening.direction)))
    off = (points[one, 1, :2] + points[other, 0, :2]) / 2 - middle
    best = int(np.argmin(np.einsum("ij,ij->i", off, off)))
    return np.stack((points[one[best], 1], points[other[best], 0]))
