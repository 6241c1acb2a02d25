"""What a mind's vision has found last, put into the world: where each feature is, what is measured of it, and its outline."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np

from actr3d.camera import View
from actr3d.vision import Feature, Obstacle, Opening, Vision
from workbench.worker.contours import Places, into_world, points_of

MOST = 24
"""So many features of one search are told of."""
DIAMOND = 0.08
"""Half the height of the mark of a feature that has no size [m]."""
UP = np.array((0.0, 0.0, 1.0))


class Stand(NamedTuple):
    """How an eye stood."""

    heading: float
    """Where ahead was for its body [rad]."""
    place: Any
    """Where the eye was [m]."""


class Sightings:
    """Tells the features of each module's last searches in the world, where the eye was when it saw them.

    Args:
        stand: Returns how the eye of a body stood at a time [us]; None where that is not known any more.
    """

    def __init__(self, stand: Callable[[str, int], Stand | None]) -> None:
        self._stand = stand
        self._gaps: dict[Any, Places | None] = {}
        """The edges of openings by when and where they were seen: their views are gone soon."""

    def told(self, body: str, vision: Vision) -> list[dict[str, Any]]:
        """Returns the features that one module has noticed last: `text`, `place`, `lines`, and whether it `chosen` it."""
        told: list[dict[str, Any]] = []
        fresh: dict[Any, Places | None] = {}
        for search in vision._last.values():
            stand = self._stand(body, search.seen)
            if stand is None:
                continue
            for number, feature in enumerate(search.noticed[:MOST]):
                key = body, search.seen, feature.called(), feature.key, feature.direction
                if isinstance(feature, Opening):
                    fresh[key] = self._gaps[key] if key in self._gaps else _edges(feature, _view(vision, search.seen))
                lines = into_world(_outline(feature, fresh.get(key)), *stand)
                told.append(
                    {
                        "text": _text(feature),
                        "place": lines[0].mean(axis=0).tolist(),
                        "lines": lines.tolist(),
                        "chosen": number == search.chosen,
                    }
                )
        self._gaps = {key: value for key, value in self._gaps.items() if key[0] != body} | fresh
        return told


def _text(feature: Feature) -> str:
    """Returns what was measured, for people: centimetres up to a metre."""
    width, distance = getattr(feature, "width", None), f"{feature.distance:.1f} m away"
    if not isinstance(width, (int, float)) or not math.isfinite(width):
        return f"{feature.called()} {distance}"
    size = f"{100 * width:.0f} cm" if width < 1 else f"{width:.2f} m"
    return f"{feature.called()} {size}" if isinstance(feature, Opening) else f"{feature.called()} {size}, {distance}"


def _view(vision: Vision, seen: int) -> View | None:
    """Returns what a module saw at a time [us], as it was misjudged, where it has that still."""
    looks = vision._looks
    return next((look.view for look in (looks._now, looks._before) if look is not None and look.time == seen), None)


def _edges(opening: Opening, view: View | None) -> Places | None:
    """Returns the places of the left and the right edge between which an opening's middle was measured, `(2, 3)`."""
    if view is None:
        return None
    points, labels, rows = points_of(view), view.extents["label"], view.extents["row"]
    lefts, rights = np.flatnonzero(labels == opening.left), np.flatnonzero(labels == opening.right)
    one, other = (index.ravel() for index in np.meshgrid(lefts, rights))
    same = rows[one] == rows[other]
    one, other = one[same], other[same]
    if not len(one):
        return None
    off = (points[one, 1, :2] + points[other, 0, :2]) / 2 - _at(opening)[:2]
    best = int(np.argmin(np.einsum("ij,ij->i", off, off)))
    return np.stack((points[one[best], 1], points[other[best], 0]))


def _at(feature: Feature) -> Places:
    return np.array((feature.distance * math.cos(feature.direction), feature.distance * math.sin(feature.direction), 0.0))


def _outline(feature: Feature, edges: Places | None) -> Places:
    """Returns the lines that show a feature, `(n, 2, 3)`, from the eye; the first is the one that is measured.

    Of an opening: across it, and its sides. Where its edges are not known any more, it is drawn square to the line of sight. Of an
    obstacle: upright, at its nearest point. Of what a model's own detectors find: see `_frame`.
    """
    middle = _at(feature)
    top, bottom = (_finite(getattr(feature, name, 0.0)) for name in ("top", "bottom"))
    if isinstance(feature, Obstacle):
        return np.array([[middle + bottom * UP, middle + max(top, bottom + 0.01) * UP]])
    if not isinstance(feature, Opening):
        return _frame(feature)
    half = feature.width / 2 * np.array((-math.sin(feature.direction), math.cos(feature.direction), 0.0))
    left, right = (middle + half, middle - half) if edges is None else edges * (1, 1, 0)
    level = (top + bottom) / 2 * UP
    sides = [[edge + bottom * UP, edge + top * UP] for edge in (left, right)]
    return np.array([[left + level, right + level], *sides])


def _frame(feature: Feature) -> Places:
    """Returns a frame as wide and as high as a feature says that it is, square to the line of sight; of one that says neither, a
    small diamond where it is."""
    middle, aside = _at(feature), np.array((-math.sin(feature.direction), math.cos(feature.direction), 0.0))
    half = _finite(getattr(feature, "width", 0.0)) / 2
    height = _finite(getattr(feature, "height", 0.0)) / 2
    top = _finite(getattr(feature, "top", height))
    bottom = _finite(getattr(feature, "bottom", -height))
    if half <= 0 and top <= bottom:
        corners = [middle + DIAMOND * way for way in (UP, aside, -UP, -aside)]
    elif half <= 0 or top <= bottom:
        return np.array([[middle + half * aside + top * UP, middle - half * aside + bottom * UP]])
    else:
        corners = [middle + side * half * aside + level * UP for side, level in ((1, top), (-1, top), (-1, bottom), (1, bottom))]
    return np.array(list(zip(corners, [*corners[1:], corners[0]], strict=True)))


def _finite(value: Any) -> float:
    return float(value) if isinstance(value, (int, float)) and math.isfinite(value) else 0.0
