"""Large flat faces that hide whole objects: what is behind a wall need not be drawn row by row."""

from __future__ import annotations

import math

from actr3d.camera.kernel.dtypes import Array, Record, Records
from actr3d.jit import inner_compiled

MAX_OCCLUDERS = 8
LARGE = 0.02
"""The minimum size of a face used as an occluder [part of the screen]."""


@inner_compiled
def offer(face: Array, corners: Array, optics: Record, occluders: Records, count: int) -> int:
    """Adds a face with four corners to the occluders if it is large and completely in front of the eye; returns their new number."""
    if count == MAX_OCCLUDERS:
        return count
    twice = 0.0
    for i in range(4):
        a, b = corners[face[i]], corners[face[(i + 1) & 3]]
        if a[2] * optics.nearest <= 1.0:
            return count
        twice += (a[0] * b[1] - b[0] * a[1]) / (a[2] * b[2])
    if abs(twice) < 8.0 * LARGE * optics.right * optics.top:
        return count
    occluder, sign = occluders[count], math.copysign(1.0, twice)
    for i in range(4):
        a, b = corners[face[i]], corners[face[(i + 1) & 3]]
        if not _set_plane(occluder.planes[i], a[0], a[1], a[2], b[0], b[1], b[2], sign):
            return count
    a, b, c = corners[face[0]], corners[face[1]], corners[face[2]]
    plane = occluder.planes[4]
    if not _set_plane(plane, b[0] - a[0], b[1] - a[1], b[2] - a[2], c[0] - a[0], c[1] - a[1], c[2] - a[2], 1.0):
        return count
    occluder.offset = plane[0] * a[0] + plane[1] * a[1] + plane[2] * a[2]
    if occluder.offset < 0.0:
        occluder.offset = -occluder.offset
        for j in range(3):
            plane[j] = -plane[j]
    return count + 1


@inner_compiled
def hidden(place: Array, reach: float, occluders: Records, count: int) -> bool:
    """Checks whether a ball, given in the eye's frame, is completely behind one of the faces."""
    for i in range(count):
        inside = True
        for j in range(5):
            plane = occluders[i].planes[j]
            beyond = plane[0] * place[0] + plane[1] * place[1] + plane[2] * place[2]
            if beyond - (occluders[i].offset if j == 4 else 0.0) <= reach:
                inside = False
                break
        if inside:
            return True
    return False


@inner_compiled
def _set_plane(plane: Array, x1: float, y1: float, z1: float, x2: float, y2: float, z2: float, sign: float) -> bool:
    """Sets the unit normal of the plane spanned by two directions; returns False if they span none."""
    plane[0], plane[1], plane[2] = sign * (y1 * z2 - z1 * y2), sign * (z1 * x2 - x1 * z2), sign * (x1 * y2 - y1 * x2)
    length = math.sqrt(plane[0] * plane[0] + plane[1] * plane[1] + plane[2] * plane[2])
    if not length > 0.0:
        return False
    for i in range(3):
        plane[i] /= length
    return True
