"""Polygons: the faces of boxes, meshes and height fields, and the pieces that rows cut from them."""

from __future__ import annotations

import math

from actr3d.camera.kernel.dtypes import LINE, NEGLIGIBLE, Array, Record, Records
from actr3d.camera.kernel.screen import first_row, last_row
from actr3d.jit import inner_compiled


@inner_compiled
def face_rows(face: Array, corners: Array, one_sided: bool, optics: Record) -> tuple[int, int]:
    """Returns the first and last row that may meet a polygon; if there is none, the last is before the first.

    Args:
        face: The numbers of its corners; the fourth is negative for a triangle.
        corners: All corners in the eye's frame [m].
        one_sided: Whether it cannot be seen from behind; its corners are then anticlockwise seen from the front.
        optics: The constants of the eye.
    """
    sides = 3 if face[3] < 0 else 4
    nearest, farthest, leftmost, rightmost = math.inf, -math.inf, math.inf, math.inf
    highest, lowest, behind = -math.inf, math.inf, False
    for i in range(sides):
        x, y, z = corners[face[i], 0], corners[face[i], 1], corners[face[i], 2]
        nearest, farthest = min(nearest, z), max(farthest, z)
        leftmost, rightmost = min(leftmost, -x - optics.right * z), min(rightmost, x - optics.right * z)
        if z > 0.0:
            highest, lowest = max(highest, y / z), min(lowest, y / z)
        else:
            behind = True
    if farthest * optics.nearest <= 1.0 or leftmost > 0.0 or rightmost > 0.0 or (one_sided and _turned_away(face, corners)):
        return 0, -1
    if behind:
        return 0, optics.rows - 1
    if lowest > optics.top or highest < -optics.top:
        return 0, -1
    return max(0, first_row(highest, optics)), min(optics.rows - 1, last_row(lowest, optics))


@inner_compiled
def _turned_away(face: Array, corners: Array) -> bool:
    """Checks whether a polygon is seen from behind; right, up, forward is a left-handed frame, hence the sign."""
    a, b, c = corners[face[0]], corners[face[1]], corners[face[2]]
    x1, y1, z1 = b[0] - a[0], b[1] - a[1], b[2] - a[2]
    x2, y2, z2 = c[0] - a[0], c[1] - a[1], c[2] - a[2]
    return (y1 * z2 - z1 * y2) * a[0] + (z1 * x2 - x1 * z2) * a[1] + (x1 * y2 - y1 * x2) * a[2] <= 0.0


@inner_compiled
def add_face(face: Array, corners: Array, v: float, optics: Record, pieces: Records, count: int) -> int:
    """Appends the piece that the row at the tangent v cuts from a polygon, if any; returns the new number of pieces.

    An edge shared by two polygons is cut at exactly the same point for both, so that no gap opens between them.
    """
    sides = 3 if face[3] < 0 else 4
    found, x1, z1, x2, z2 = 0, 0.0, 0.0, 0.0, 0.0
    last = face[sides - 1]
    above_last = corners[last, 1] - v * corners[last, 2]
    for i in range(sides):
        one = face[i]
        above = corners[one, 1] - v * corners[one, 2]
        if (above > 0.0) != (above_last > 0.0):
            upper, lower = (one, last) if above > 0.0 else (last, one)
            part = max(above, above_last) / abs(above - above_last)
            x1, z1 = x2, z2
            x2 = corners[upper, 0] + part * (corners[lower, 0] - corners[upper, 0])
            z2 = corners[upper, 2] + part * (corners[lower, 2] - corners[upper, 2])
            found += 1
        last, above_last = one, above
    if found != 2:
        return count
    return _add_segment(x1, z1, x2, z2, optics, pieces, count)


@inner_compiled
def _add_segment(x1: float, z1: float, x2: float, z2: float, optics: Record, pieces: Records, count: int) -> int:
    """Appends the part of a segment in the row's plane that is in the field of view and beyond the near limit."""
    start, end = 0.0, 1.0
    for i in range(3):  # the left edge, the right edge, the near limit: inside where above 0
        if i == 2:
            first, last = z1 - 1.0 / optics.nearest, z2 - 1.0 / optics.nearest
        else:
            sign = 1.0 - 2.0 * i
            first, last = optics.right * z1 + sign * x1, optics.right * z2 + sign * x2
        if first < 0.0 and last < 0.0:
            return count
        if first < 0.0:
            start = max(start, first / (first - last))
        elif last < 0.0:
            end = min(end, first / (first - last))
    if not start < end:
        return count
    piece = pieces[count]
    x, z = x1 + start * (x2 - x1), z1 + start * (z2 - z1)
    low, near = x / z, 1.0 / z
    x, z = (x2, z2) if end == 1.0 else (x1 + end * (x2 - x1), z1 + end * (z2 - z1))
    high, far = x / z, 1.0 / z
    if high < low:
        low, high, near, far = high, low, far, near
    piece.low, piece.high = max(low, -optics.right), min(high, optics.right)
    if not piece.high - piece.low > NEGLIGIBLE:
        return count
    piece.side, piece.b0, piece.c0, piece.c1 = LINE, low, near, (far - near) / (high - low)
    piece.floor, piece.ceiling = min(near, far), max(near, far)
    return count + 1
