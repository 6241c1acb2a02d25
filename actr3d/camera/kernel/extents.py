"""Joins stretches to extents, and computes their position on the screen."""

from __future__ import annotations

import math

from actr3d.camera.kernel.dtypes import NEGLIGIBLE, SLIVER, Array, Record, Records
from actr3d.camera.kernel.pieces import nearness
from actr3d.camera.kernel.screen import screen_part
from actr3d.jit import inner_compiled

EDGES_AT_ONCE = 128

SURELY_WIDE = 1e-4
"""Extents wider than this are never rounding errors, even on the widest screen [tangent]."""


@inner_compiled
def goes_on(object: int, low: float, optics: Record, extents: Records, first: int, done: int) -> bool:
    """Checks whether the last extent of a row belongs to the given object and reaches up to a tangent, within the precision.

    Until `end_row`, `x1` and `x2` of extents are tangents, and `a1` and `a2` the numbers of the pieces at these edges.
    """
    if done == first or extents[done - 1].label != object:
        return False
    reached = extents[done - 1].x2
    return low - reached <= NEGLIGIBLE or _gap(reached, low, optics) <= max(optics.precision, SLIVER)


@inner_compiled
def without_sliver(optics: Record, extents: Records, first: int, done: int) -> int:
    """Returns the number of extents, without the last one if it is only a rounding error."""
    if done > first:
        last = extents[done - 1]
        if last.x2 - last.x1 < SURELY_WIDE and _gap(last.x1, last.x2, optics) < SLIVER:
            return done - 1
    return done


@inner_compiled
def end_row(v: float, optics: Record, pieces: Records, extents: Records, first: int, done: int) -> int:
    """Stores what `finish` needs: the row's tangent as `y`, nearness as distances; returns the number of extents."""
    done = without_sliver(optics, extents, first, done)
    for i in range(first, done):
        extent = extents[i]
        extent.d1, extent.d2 = nearness(pieces[int(extent.a1)], extent.x1), nearness(pieces[int(extent.a2)], extent.x2)
        extent.y = v
    return done


@inner_compiled
def finish(optics: Record, extents: Records, count: int, edges: Array) -> None:
    """Converts tangents to screen coordinates and angles, and nearness to distances: for many edges at once, which is faster."""
    for start in range(0, count, EDGES_AT_ONCE // 2):
        number = min(count - start, EDGES_AT_ONCE // 2)
        for i in range(number):
            extent = extents[start + i]
            edges[0, 2 * i], edges[1, 2 * i], edges[2, 2 * i] = extent.x1, extent.y, extent.d1
            edges[0, 2 * i + 1], edges[1, 2 * i + 1], edges[2, 2 * i + 1] = extent.x2, extent.y, extent.d2
        _measure(edges[0], edges[1], edges[2], 2 * number)
        for i in range(number):
            extent = extents[start + i]
            extent.dn = math.sqrt(1.0 + extent.xn * extent.xn + extent.y * extent.y) / extent.dn
            extent.xn = 0.5 + 0.5 * screen_part(extent.xn, optics.right, optics.e2)
            extent.x1 = 0.5 + 0.5 * screen_part(extent.x1, optics.right, optics.e2)
            extent.x2 = 0.5 + 0.5 * screen_part(extent.x2, optics.right, optics.e2)
            extent.a1, extent.d1 = edges[1, 2 * i], edges[2, 2 * i]
            extent.a2, extent.d2 = edges[1, 2 * i + 1], edges[2, 2 * i + 1]
            extent.y = (extent.row + 0.5) / optics.rows


@inner_compiled
def _measure(across: Array, upwards: Array, near: Array, count: int) -> None:
    """Replaces upward tangents by angles [degrees], and nearness by distances [m]."""
    for i in range(count):
        square = across[i] * across[i] + upwards[i] * upwards[i]
        whole = math.sqrt(1.0 + square)
        near[i] = whole / near[i]
        half = math.sqrt(square) / (1.0 + whole)
        quarter = half / (1.0 + math.sqrt(1.0 + half * half))
        eighth = quarter / (1.0 + math.sqrt(1.0 + quarter * quarter))
        upwards[i] = math.degrees(8.0) * eighth * _arc_tangent_part(eighth * eighth)


@inner_compiled
def _arc_tangent_part(s: float) -> float:
    """Returns `atan(x) / x` for `s = x^2` at full precision for angles up to 11.25 degrees: an unrolled series."""
    part = 1 / 13 - s * (1 / 15 - s * (1 / 17 - s * (1 / 19 - s / 21)))
    return 1.0 - s * (1 / 3 - s * (1 / 5 - s * (1 / 7 - s * (1 / 9 - s * (1 / 11 - s * part)))))


@inner_compiled
def _gap(low: float, high: float, optics: Record) -> float:
    """Returns the distance of two tangents on the screen."""
    return 0.5 * (screen_part(high, optics.right, optics.e2) - screen_part(low, optics.right, optics.e2))
