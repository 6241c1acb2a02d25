"""What a mind's vision has found last, as it is drawn in the world: each feature's outline, and what was measured of it."""

from __future__ import annotations

import math
from itertools import groupby, islice
from typing import Any

import numpy as np

from actr3d.actr.kernel.model import Model
from actr3d.camera import View
from actr3d.vision import Feature, Obstacle, Opening, Sighting, sightings
from actr3d.world.body import Body
from workbench.worker.contours import Places, into_world, points_of

MOST = 24
"""So many features of one search are told of."""
DIAMOND = 0.08
"""Half the height of the mark of a feature that has no size [m]."""
LEAST = 0.01
"""An obstacle that has no height is drawn as high as this [m]."""


def told_sightings(mind: Model, body: Body) -> list[dict[str, Any]]:
    """Returns the features that a mind's last searches have noticed: `text`, `place`, `lines`, and whether it has `chosen` it."""
    told: list[dict[str, Any]] = []
    for _, search in groupby(sightings(mind, body), key=lambda one: (one.module, one.bottom_up)):
        found = list(islice(search, MOST))
        points = points_of(found[0].view)
        for sighting in found:
            lines = _outline(sighting, points)
            place = lines[0].mean(axis=0).tolist()
            told.append({"text": _text(sighting.feature), "place": place, "lines": lines.tolist(), "chosen": sighting.chosen})
    return told


def _text(feature: Feature) -> str:
    """Returns what was measured, for people: centimetres up to a metre."""
    width, distance = getattr(feature, "width", None), f"{feature.distance:.1f} m away"
    if not isinstance(width, (int, float)) or not math.isfinite(width):
        return f"{feature.called()} {distance}"
    size = f"{100 * width:.0f} cm" if width < 1 else f"{width:.2f} m"
    return f"{feature.called()} {size}" if isinstance(feature, Opening) else f"{feature.called()} {size}, {distance}"


def _outline(sighting: Sighting, points: Places) -> Places:
    """Returns the lines that show a feature, `(n, 2, 3)`; the first is the one that is measured.

    Of an opening: across it, and its sides. Where its edges are not found, it is drawn square to the line of sight. Of an obstacle:
    upright, at its nearest point. Of what a model's own detectors find: see `_frame`.

    Args:
        sighting: What was noticed.
        points: Those of its view.
    """
    upper_left, upper_right, lower_right, lower_left = np.array(sighting.corners)
    if isinstance(sighting.feature, Obstacle):
        lower, upper = (lower_left + lower_right) / 2, (upper_left + upper_right) / 2
        upper[2] = max(upper[2], lower[2] + LEAST)
        return np.array([[lower, upper]])
    if not isinstance(sighting.feature, Opening):
        return _frame(sighting)
    sides = np.array([[lower_left, upper_left], [lower_right, upper_right]])
    edges = _edges(sighting.feature, sighting.view, points)
    if edges is not None:
        sides[..., :2] = into_world(edges, sighting.stood)[:, None, :2]
    return np.array([sides.mean(axis=1), *sides])


def _frame(sighting: Sighting) -> Places:
    """Returns a frame as wide and as high as a feature says that it is; a line where it says one of these, a small diamond where none."""
    corners = np.array(sighting.corners)
    wide, high = bool((corners[0] != corners[1]).any()), bool(corners[0, 2] > corners[2, 2])
    if wide != high:
        return np.array([[corners[0], corners[2]]])
    if not wide:
        way = sighting.stood.heading + sighting.feature.direction
        up, aside = np.array((0.0, 0.0, DIAMOND)), DIAMOND * np.array((-math.sin(way), math.cos(way), 0.0))
        corners = corners.mean(axis=0) + np.array((up, aside, -up, -aside))
    return np.stack((corners, np.roll(corners, -1, axis=0)), axis=1)


def _edges(opening: Opening, view: View, points: Places) -> Places | None:
    """Returns the places of the left and the right edge between which an opening's middle was measured, from the eye, `(2, 3)`."""
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
