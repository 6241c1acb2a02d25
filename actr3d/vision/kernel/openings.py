"""Openings: gaps that go on from scan line to scan line."""

from __future__ import annotations

import math

import numpy as np

from actr3d.camera.kernel.jit import compiled
from actr3d.camera.kernel.layout import Array, Record, Records
from actr3d.camera.kernel.screen import row_tangent

BESIDE = 0.35
"""How much farther than a gap's edges something above or below it may be, to be what bounds it there [m]. Ours: a wall's thickness."""

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
        ("cut", "i8"),  # whether it goes on above or below the field of view
    ],
    align=True,
)


@compiled
def set_openings(extents: Records, points: Array, gaps: Records, count: int, optics: Record, up: float, openings: Records) -> None:
    """Writes each opening: the largest upright rectangle that fits between the edges of its gaps.

    Args:
        extents: The view's.
        points: Where their edges are.
        gaps: All gaps.
        count: How many there are.
        optics: The eye's.
        up: How upright the eye is, the cosine of its tilt.
        openings: Where they are written, as many as there are.
    """
    for number in range(len(openings)):
        most, top, bottom, lowest = -1.0, -1, -1, -1
        low_edge, high_edge = 0.0, 0.0
        for i in range(count - 1, -1, -1):
            if gaps[i].number != number:
                continue
            lowest = max(lowest, i)
            # From each row upwards: where the edges come nearest to each other decides.
            x, y = gaps[i].along[0], gaps[i].along[1]
            low, high = -math.inf, math.inf
            k = i
            while k >= 0:
                left, right = points[gaps[k].left, 1], points[gaps[k].right, 0]
                low, high = max(low, x * left[0] + y * left[1]), min(high, x * right[0] + y * right[1])
                if high <= low:
                    break
                area = (high - low) * (_level(points, gaps[k], optics, up, -0.5) - _level(points, gaps[i], optics, up, 0.5))
                if area > most * (1.0 + 1e-9):
                    most, top, bottom, low_edge, high_edge = area, k, i, low, high
                k = gaps[k].before
        if top < 0:
            top = bottom = lowest
        _set(extents, points, gaps, top, bottom, high_edge - low_edge, optics, up, openings[number])


@compiled
def _set(
    extents: Records, points: Array, gaps: Records, top: int, bottom: int, width: float, optics: Record, up: float, opening: Record
) -> None:
    """Writes the opening between two gaps of it."""
    opening.width = width
    opening.top, opening.bottom = _level(points, gaps[top], optics, up, -0.5), _level(points, gaps[bottom], optics, up, 0.5)
    opening.cut = gaps[top].row == 0 or gaps[bottom].row == optics.rows - 1
    middle, deep, k = bottom, math.inf, bottom
    while True:
        deep = min(deep, gaps[k].deep)
        if 2 * gaps[k].row >= gaps[top].row + gaps[bottom].row:
            middle = k
        if k == top:
            break
        k = gaps[k].before
    opening.deep = deep
    left, right = points[gaps[middle].left, 1], points[gaps[middle].right, 0]
    opening.ahead, opening.aside = 0.5 * (left[0] + right[0]), 0.5 * (left[1] + right[1])
    opening.left, opening.right = extents[gaps[middle].left].label, extents[gaps[middle].right].label
    opening.above = _bound(extents, gaps[top], gaps[top].row - 1)
    opening.below = _bound(extents, gaps[bottom], gaps[bottom].row + 1)


@compiled
def _level(points: Array, gap: Record, optics: Record, up: float, rows: float) -> float:
    """Returns how high above the eye a gap is [m], some rows below the middle of its row."""
    middle = 0.5 * (points[gap.left, 1, 2] + points[gap.right, 0, 2])
    return middle + gap.depth * up * (row_tangent(gap.row + rows, optics) - row_tangent(gap.row, optics))


@compiled
def _bound(extents: Records, gap: Record, row: int) -> int:
    """Returns the label of what is seen on another row over most of a gap, as near as its edges; 0 for nothing."""
    low, high = extents[gap.left].x2, extents[gap.right].x1
    most, label = 0.0, 0
    at = gap.left
    if row < gap.row:
        while at > 0 and extents[at].row >= row:
            at -= 1
    while at < len(extents) and extents[at].row <= row:
        extent = extents[at]
        if extent.row == row and min(extent.d1, extent.d2) <= gap.far + BESIDE:
            shared = min(high, extent.x2) - max(low, extent.x1)
            if shared > most:
                most, label = shared, extent.label
        at += 1
    return label
