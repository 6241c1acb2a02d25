"""Gaps on scan lines: between two edges, with nothing between them that is as near."""

from __future__ import annotations

import math

import numpy as np

from actr3d.camera.kernel.dtypes import Array, Record, Records
from actr3d.camera.kernel.screen import row_tangent
from actr3d.jit import inner_compiled

NARROWEST = 1e-6
"""Fraction of the screen's width below which there is no gap: edges that touch."""
THICKEST = 0.35 + 1e-6
"""Maximum thickness of a wall [m], with a margin for rounding: the edges of a gap may lie this far from the line of the wall's front and
still bound one gap in the wall. Source: chosen; walls of buildings are 0.1 to 0.3 m thick."""

GAP = np.dtype(
    [
        ("row", "i8"),
        ("left", "i8"),  # the numbers of the extents that bound it
        ("right", "i8"),
        ("before", "i8"),  # the gap on the row above that it continues, or -1
        ("number", "i8"),  # of the opening it is part of
        ("along", "f8", (2,)),  # unit vector from left to right along which its width is measured (ahead, left)
        ("width", "f8"),  # [m]
        ("deep", "f8"),  # how far it is free behind, square to its width [m]
        ("highs", "f8", (2,)),  # where its row ends above and below at the left and at the right edge, above the eye [m]
        ("lows", "f8", (2,)),
        ("far", "f8"),  # the distance of the farther edge from the eye [m]
    ],
    align=True,
)
"""A gap on one row."""


@inner_compiled
def find_gaps(extents: Records, points: Array, optics: Record, up: float, step: float, gaps: Records) -> int:
    """Writes all gaps, by rows; returns their number, including those without room.

    A gap goes from the right edge of one extent to the left edge of another on the same row, if all between them is farther than both by
    `step` at least [m], or nothing is there. `up` is the cosine of the eye's tilt: 1 for an upright eye.
    """
    count, first, total = 0, 0, len(extents)
    while first < total:
        last = first
        while last < total and extents[last].row == extents[first].row:
            last += 1
        for i in range(first, last - 1):
            behind = math.inf
            for j in range(i + 1, last):
                if j > i + 1:
                    behind = min(behind, extents[j - 1].d1, extents[j - 1].d2, extents[j - 1].dn)
                if behind <= extents[i].d2 + step:
                    break
                if extents[j].x1 - extents[i].x2 > NARROWEST and behind > extents[j].d1 + step:
                    if count < len(gaps):
                        gaps[count].row, gaps[count].left, gaps[count].right = extents[first].row, i, j
                        gaps[count].far = max(extents[i].d2, extents[j].d1)
                        measure(points, gaps, count)
                        _set_levels(points, gaps[count], optics, up)
                    count += 1
        first = last
    return count


@inner_compiled
def measure(points: Array, gaps: Records, number: int) -> None:
    """Sets how wide a gap is, in the line of what bounds it, and how far it is free behind.

    Heights do not count: the two edges of a row are at different heights where one is nearer. In a wall of some thickness one of
    the edges may be its front's and the other its back's; so the width is measured along the wall's front: the line from one
    side of the gap to the other that all visible ends of what bounds it lie on or behind.
    """
    gap = gaps[number]
    left, right = points[gap.left, 1], points[gap.right, 0]
    ahead, aside = right[0] - left[0], right[1] - left[1]
    width = math.sqrt(ahead * ahead + aside * aside)
    for i in range(2):
        for j in range(2):
            start, end = points[gap.left, i], points[gap.right, j]
            if not _is_front(start, end, points[gap.left, 1 - i], points[gap.right, 1 - j]):
                continue
            x, y = end[0] - start[0], end[1] - start[1]
            length = math.sqrt(x * x + y * y)
            along = (x * ahead + y * aside) / length
            off = max(abs(_beyond(left, start, end)), abs(_beyond(right, start, end))) / length
            if off <= THICKEST and 0.0 < along < width:
                ahead, aside, width = x / length * along, y / length * along, along
    if width > 0.0:
        ahead, aside = ahead / width, aside / width
    gap.along[0], gap.along[1], gap.width = ahead, aside, width
    # Square to that, away from the eye.
    x, y = -aside, ahead
    near_left, near_right = x * left[0] + y * left[1], x * right[0] + y * right[1]
    if near_left + near_right < 0.0:
        x, y, near_left, near_right = -x, -y, -near_left, -near_right
    deep = math.inf
    for k in range(gap.left + 1, gap.right):
        for side in range(3):
            deep = min(deep, x * points[k, side, 0] + y * points[k, side, 1])
    gap.deep = max(0.0, deep - max(near_left, near_right))


@inner_compiled
def _set_levels(points: Array, gap: Record, optics: Record, up: float) -> None:
    """Sets where the row of a gap ends above and below at each of its edges, half way to the next rows."""
    here = row_tangent(gap.row, optics)
    for side in range(2):
        point = points[gap.left, 1] if side == 0 else points[gap.right, 0]
        gap.highs[side] = point[2] + point[3] * up * (row_tangent(gap.row - 0.5, optics) - here)
        gap.lows[side] = point[2] + point[3] * up * (row_tangent(gap.row + 0.5, optics) - here)


@inner_compiled
def _is_front(start: Array, end: Array, one: Array, other: Array) -> bool:
    """Returns whether no part of a gap's boundary lies before the line between two of its points, as seen from the eye."""
    eye = start[0] * end[1] - start[1] * end[0]
    if abs(eye) < 1e-12:
        return False
    least = -1e-9
    return _beyond(one, start, end) * math.copysign(1.0, -eye) >= least and _beyond(other, start, end) * math.copysign(1.0, -eye) >= least


@inner_compiled
def _beyond(point: Array, start: Array, end: Array) -> float:
    """Returns how far a point lies to the left of the line between two others, times the line's length [m²]."""
    return (end[0] - start[0]) * (point[1] - start[1]) - (end[1] - start[1]) * (point[0] - start[0])


@inner_compiled
def link_gaps(extents: Records, points: Array, gaps: Records, count: int, apart: float) -> int:
    """Joins gaps of neighbouring rows whose edges are no farther apart than `apart` [m]; returns how many openings there are.

    A gap continues the nearest one above that no other gap continues. Between the same objects, edges may be `THICKEST` apart:
    at a wall's foot, the visible edge changes from its back to its front.
    """
    openings, above, first = 0, 0, 0
    while first < count:
        last = first
        while last < count and gaps[last].row == gaps[first].row:
            last += 1
        if above < first and gaps[above].row != gaps[first].row - 1:
            above = first
        for i in range(first, last):
            best, before = math.inf, -1
            left, right = gaps[i].left, gaps[i].right
            for k in range(above, first):
                way = max(_apart(points[left, 1], points[gaps[k].left, 1]), _apart(points[right, 0], points[gaps[k].right, 0]))
                same = (
                    extents[left].label == extents[gaps[k].left].label
                    and extents[right].label == extents[gaps[k].right].label
                    and extents[left].x2 < extents[gaps[k].right].x1
                    and extents[right].x1 > extents[gaps[k].left].x2
                )
                if way <= (THICKEST if same else apart) and way < best and not _taken(gaps, first, i, k):
                    best, before = way, k
            gaps[i].before = before
            if before < 0:
                gaps[i].number = openings
                openings += 1
            else:
                gaps[i].number = gaps[before].number
        above, first = first, last
    return openings


@inner_compiled
def _apart(one: Array, other: Array) -> float:
    """Returns how far two points are apart on the ground [m]."""
    x, y = one[0] - other[0], one[1] - other[1]
    return math.sqrt(x * x + y * y)


@inner_compiled
def _taken(gaps: Records, first: int, end: int, before: int) -> bool:
    """Returns whether a gap of the row from `first` to `end` continues one above."""
    for i in range(first, end):  # noqa: SIM110 - compiled
        if gaps[i].before == before:
            return True
    return False
