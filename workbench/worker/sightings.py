"""What a mind's vision has found last, as it is drawn in the world: each feature's outline, and what was measured of it."""

from __future__ import annotations

import math
from itertools import groupby, islice
from typing import Any

import numpy as np

from actr3d.actr.model import Model
from actr3d.camera import View
from actr3d.vision import Feature, Opening, Sighting, sightings
from actr3d.world.body import Body
from workbench.worker.contours import Places, into_world, points_of

MOST = 24
"""So many features of one search are told of."""
LEAST = 0.01
"""What has no height is drawn as high as this [m]."""


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

    Of an opening: across it, and its sides. Where its edges are not found, it is drawn square to the line of sight. Of all else:
    upright, at its nearest point.

    Args:
        sighting: What was noticed.
        points: Those of its view.
    """
    upper_left, upper_right, lower_right, lower_left = np.array(sighting.corners)
    if not isinstance(sighting.feature, Opening):
        lower, upper = (lower_left + lower_right) / 2, (upper_left + upper_right) / 2
        upper[2] = max(upper[2], lower[2] + LEAST)
        return np.array([[lower, upper]])
    sides = np.array([[lower_left, upper_left], [lower_right, upper_right]])
    edges = _edges(sighting.feature, sighting.view, points)
    if edges is not None:
        sides[..., :2] = into_world(edges, sighting.stood)[:, None, :2]
    return np.array([sides.mean(axis=1), *sides])


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
