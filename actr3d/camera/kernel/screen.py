"""Converts between tangents in the eye's frame and the screen, and computes which part of the screen a ball may touch."""

from __future__ import annotations

import math

from actr3d.camera.kernel.dtypes import Array, Record
from actr3d.jit import inner_compiled


@inner_compiled
def screen_part(tangent: float, most: float, e2: float) -> float:
    """Returns a tangent as a part of half the screen, from -1 to 1.

    On a retina (`e2` above 0) equal parts of the screen are equal lengths of cortex: the width of a degree at eccentricity E is
    proportional to 1 / (E + e2).
    """
    if e2 == 0.0:
        return tangent / most
    return math.copysign(math.log1p(math.atan(abs(tangent)) / e2) / math.log1p(math.atan(most) / e2), tangent)


@inner_compiled
def tangent_at(part: float, most: float, e2: float) -> float:
    """Returns the tangent at a part of half the screen; the inverse of `screen_part`."""
    if e2 == 0.0:
        return part * most
    span = math.log1p(math.atan(most) / e2)
    return math.copysign(math.tan(e2 * math.expm1(abs(part) * span)), part)


@inner_compiled
def row_tangent(row: float, optics: Record) -> float:
    """Returns the upward tangent of the middle of a scan line."""
    return tangent_at(1.0 - (2.0 * row + 1.0) / optics.rows, optics.top, optics.e2)


@inner_compiled
def row_at(v: float, optics: Record) -> float:
    """Returns the row coordinate of an upward tangent: 0 at the middle of the topmost scan line."""
    return 0.5 * (optics.rows * (1.0 - screen_part(v, optics.top, optics.e2)) - 1.0)


@inner_compiled
def first_row(v: float, optics: Record) -> int:
    """Returns the topmost row that may be at or below the tangent v."""
    return math.ceil(row_at(min(v, optics.top), optics) - 1e-6)


@inner_compiled
def last_row(v: float, optics: Record) -> int:
    """Returns the lowest row that may be at or above the tangent v."""
    return math.floor(row_at(max(v, -optics.top), optics) + 1e-6)


@inner_compiled
def in_view(place: Array, reach: float, optics: Record) -> bool:
    """Checks whether a ball, given in the eye's frame, may be in the field of view and in range."""
    x, y, z = abs(place[0]), abs(place[1]), place[2]
    if z + reach <= 0.0 or math.sqrt(x * x + y * y + z * z) - reach > optics.range:
        return False
    right, top = optics.right, optics.top
    return x - right * z <= reach * math.sqrt(1.0 + right * right) and y - top * z <= reach * math.sqrt(1.0 + top * top)


@inner_compiled
def set_rows(patch: Record, place: Array, yy: float, yz: float, zz: float, optics: Record, joined: bool) -> None:
    """Sets the rows on which an ellipsoid is seen, and bounds of its nearness; exact if it is completely in front of the eye.

    A row meets it where a plane through the eye does: (y - v z)^2 <= yy - 2 v yz + v^2 zz.

    Args:
        patch: The patch whose rows and bounds are set.
        place: The centre in the eye's frame [m].
        yy: An entry of the matrix of its squared half axes, rotated into the eye's frame [m^2]; the ellipsoid may be flat.
        yz: Another entry of this matrix.
        zz: Another entry of this matrix.
        optics: The constants of the eye.
        joined: Whether to extend the rows and bounds already set, to cover the space between this and another ellipsoid.
    """
    y, z, deep = place[1], place[2], math.sqrt(zz)
    first, last = 0, optics.rows - 1
    floor, ceiling = 1.0 / max(z + deep, 0.0), math.inf
    if z > deep:
        ceiling = 1.0 / (z - deep)
        a, b = z * z - zz, y * z - yz
        root = math.sqrt(max(b * b - a * (y * y - yy), 0.0))
        first, last = max(first, first_row((b + root) / a, optics)), min(last, last_row((b - root) / a, optics))
    if joined:
        patch.first_row, patch.last_row = min(patch.first_row, first), max(patch.last_row, last)
        patch.floor, patch.ceiling = min(patch.floor, floor), max(patch.ceiling, ceiling)
    else:
        patch.first_row, patch.last_row, patch.floor, patch.ceiling = first, last, floor, ceiling


@inner_compiled
def zero() -> int:
    """Returns 0 as a variable: a constant argument would make numba compile every called function once more."""
    return int(0.0)
