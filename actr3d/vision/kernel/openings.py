"""Openings: gaps that continue from scan line to scan line."""

from __future__ import annotations

import math

import numpy as np

from actr3d.camera.kernel.dtypes import Array, Record, Records
from actr3d.jit import inner_compiled
from actr3d.vision.kernel.gaps import THICKEST

OPENING = np.dtype(
    [
        ("width", "f8"),  # [m]
        ("deep", "f8"),  # [m]
        ("top", "f8"),  # above the eye [m]
        ("bottom", "f8"),
        ("ahead", "f8"),  # the middle between its edges [m]
        ("aside", "f8"),
        ("left", "i8"),  # labels of what bounds it; 0 for nothing
        ("right", "i8"),
        ("above", "i8"),
        ("below", "i8"),
        ("cut", "i8"),  # whether it continues above or below the field of view
        ("first", "i8"),  # the numbers of its uppermost and its lowest gap
        ("last", "i8"),
        ("area", "f8"),  # [m^2]
    ],
    align=True,
)


@inner_compiled
def set_openings(extents: Records, points: Array, gaps: Records, count: int, rows: int, openings: Records) -> None:
    """Writes each opening: the largest upright rectangle that fits between the edges of its gaps.

    Args:
        extents: Those of the view, `(n,)`.
        points: Their positions [m], `(n, 3, 4)`; see `set_points`.
        gaps: All gaps.
        count: Number of gaps.
        rows: Number of rows of the view.
        openings: Output, one record each.
    """
    for number in range(len(openings)):
        openings[number].area = -1.0
    for i in range(count):
        opening = openings[gaps[i].number]
        # From each row upwards: where the edges come nearest to each other decides.
        x, y = gaps[i].along[0], gaps[i].along[1]
        low, high = -math.inf, math.inf
        k = i
        while k >= 0:
            left, right = points[gaps[k].left, 1], points[gaps[k].right, 0]
            low, high = max(low, x * left[0] + y * left[1]), min(high, x * right[0] + y * right[1])
            if high <= low and k < i:
                break
            area = max(0.0, high - low) * 0.5 * (gaps[k].highs[0] + gaps[k].highs[1] - gaps[i].lows[0] - gaps[i].lows[1])
            if area > opening.area * (1.0 + 1e-9):
                opening.area, opening.width = area, max(0.0, high - low)
                opening.first, opening.last = k, i
            k = gaps[k].before
    for number in range(len(openings)):
        _finish(extents, points, gaps, rows, openings[number])


@inner_compiled
def _finish(extents: Records, points: Array, gaps: Records, rows: int, opening: Record) -> None:
    """Writes what follows from the first and the last gap of an opening."""
    first, last = gaps[opening.first], gaps[opening.last]
    opening.top = _end(extents, points, first, first.row - 1, first.highs, first.row == 0, 1.0)
    opening.bottom = _end(extents, points, last, last.row + 1, last.lows, last.row == rows - 1, -1.0)
    opening.cut = first.row == 0 or last.row == rows - 1
    opening.deep = math.inf
    middle = k = opening.last
    while True:
        opening.deep = min(opening.deep, gaps[k].deep)
        if 2 * gaps[k].row >= first.row + last.row:
            middle = k
        if k == opening.first:
            break
        k = gaps[k].before
    left, right = points[gaps[middle].left, 1], points[gaps[middle].right, 0]
    opening.ahead, opening.aside = 0.5 * (left[0] + right[0]), 0.5 * (left[1] + right[1])
    opening.left, opening.right = extents[gaps[middle].left].label, extents[gaps[middle].right].label
    opening.above = _bound(extents, first, first.row - 1)
    opening.below = _bound(extents, last, last.row + 1)


@inner_compiled
def _end(extents: Records, points: Array, gap: Record, row: int, levels: Array, cut: bool, sign: float) -> float:
    """Returns the height at which an opening ends above (`sign` 1) or below (-1), above the eye [m].

    Its first or last gap has another height at each of its edges, because they are not equally far. What counts is the edge that
    ends there. Where both end, or neither, what bounds the opening is level (the tops of equal walls, a lintel, the ground), and
    its outer height is that of the edge where it is met first; of one that leaves the field of view, the inner height is free.

    Args:
        extents: Those of the view, `(n,)`.
        points: Their positions [m], `(n, 3, 4)`.
        gap: The first or the last gap.
        row: The next row.
        levels: Where the gap ends at its left and at its right edge, above the eye [m].
        cut: Whether there is no next row.
        sign: 1 for above, -1 for below.
    """
    one, other = sign * levels[0], sign * levels[1]
    if cut:
        return sign * min(one, other)
    left = _goes_on(extents, points, gap.left, 1, row)
    if left == _goes_on(extents, points, gap.right, 0, row):
        return sign * max(one, other)
    return sign * (other if left else one)


@inner_compiled
def _goes_on(extents: Records, points: Array, number: int, side: int, row: int) -> bool:
    """Returns whether an edge of an extent goes on in the next row: of the same thing, within a wall's thickness on the ground."""
    step = -1 if row < extents[number].row else 1
    at = number
    while 0 <= at < len(extents) and (extents[at].row - row) * step <= 0:
        if extents[at].row == row and extents[at].label == extents[number].label:
            x, y = points[at, side, 0] - points[number, side, 0], points[at, side, 1] - points[number, side, 1]
            if math.sqrt(x * x + y * y) <= THICKEST:
                return True
        at += step
    return False


@inner_compiled
def _bound(extents: Records, gap: Record, row: int) -> int:
    """Returns the label of what is seen on another row over most of a gap, within a wall's thickness of its edges; 0 for nothing."""
    low, high = extents[gap.left].x2, extents[gap.right].x1
    most, label = 0.0, 0
    at = gap.left
    if row < gap.row:
        while at > 0 and extents[at].row >= row:
            at -= 1
    while at < len(extents) and extents[at].row <= row:
        extent = extents[at]
        if extent.row == row and min(extent.d1, extent.d2) <= gap.far + THICKEST:
            shared = min(high, extent.x2) - max(low, extent.x1)
            if shared > most:
                most, label = shared, extent.label
        at += 1
    return label
