"""Surfaces: the distance and the extent of each object."""

from __future__ import annotations

import math

import numpy as np

from actr3d.camera.kernel.dtypes import Array, Records
from actr3d.jit import inner_compiled

SURFACE = np.dtype(
    [
        ("label", "i8"),
        ("distance", "f8"),  # of the nearest point, on the ground [m]
        ("ahead", "f8"),  # the nearest point [m]
        ("aside", "f8"),
        ("lefts", "f8", (3,)),  # the leftmost point: ahead, left [m], direction [rad]
        ("rights", "f8", (3,)),
        ("top", "f8"),  # above the eye [m]
        ("bottom", "f8"),
    ],
    align=True,
)
"""The visible part of an object."""


@inner_compiled
def set_surfaces(extents: Records, points: Array, bearing: float, surfaces: Records) -> int:
    """Writes the visible part of each object at the index of its label; a distance is infinite outside the bearing.

    Returns the highest label; if there is no room for that, nothing is written.

    Between an edge and the nearest point of a row, the object is assumed to follow the straight line between them.

    Args:
        extents: The view's.
        points: Where their edges are.
        bearing: Greatest angle from straight ahead, to the left and right, at which nearest points are searched [rad].
        surfaces: One for each label and one for none.
    """
    most = 0
    for i in range(len(extents)):
        most = max(most, extents[i].label)
    if most >= len(surfaces):
        return most
    for i in range(len(surfaces)):
        surfaces[i].label, surfaces[i].distance = 0, math.inf
    for i in range(len(extents)):
        surface = surfaces[extents[i].label]
        if surface.label == 0:
            surface.label = extents[i].label
            surface.top, surface.bottom = -math.inf, math.inf
            surface.lefts[2], surface.rights[2] = -math.inf, math.inf
        for side in range(2):
            point = points[i, side]
            surface.top, surface.bottom = max(surface.top, point[2]), min(surface.bottom, point[2])
            direction = math.atan2(point[1], point[0])
            if direction > surface.lefts[2]:
                surface.lefts[0], surface.lefts[1], surface.lefts[2] = point[0], point[1], direction
            if direction < surface.rights[2]:
                surface.rights[0], surface.rights[1], surface.rights[2] = point[0], point[1], direction
        for side in range(2):
            ahead, aside = _nearest(points[i, side], points[i, 2], bearing)
            distance = math.sqrt(ahead * ahead + aside * aside)
            if distance < surface.distance:
                surface.distance, surface.ahead, surface.aside = distance, ahead, aside
    return most


@inner_compiled
def _nearest(one: Array, other: Array, bearing: float) -> tuple[float, float]:
    """Returns the point of a line on the ground that is nearest to the eye, within a bearing; infinity where none is."""
    x, y = other[0] - one[0], other[1] - one[1]
    low, high = 0.0, 1.0
    if bearing < 0.5 * math.pi:
        for sign in (1.0, -1.0):  # to the right of its left limit, to the left of its right limit
            a = one[0] * math.sin(bearing) - sign * one[1] * math.cos(bearing)
            b = x * math.sin(bearing) - sign * y * math.cos(bearing)
            if b > 0.0:
                low = max(low, -a / b)
            elif b < 0.0:
                high = min(high, -a / b)
            elif a < 0.0:
                high = -1.0
    if low > high:
        return math.inf, math.inf
    square = x * x + y * y
    part = min(high, max(low, -(one[0] * x + one[1] * y) / square)) if square > 0.0 else low
    ahead, aside = one[0] + part * x, one[1] + part * y
    if bearing >= 0.5 * math.pi and abs(math.atan2(aside, ahead)) > bearing:
        return math.inf, math.inf
    return ahead, aside
