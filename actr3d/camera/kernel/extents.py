"""Joins stretches to extents, and says where they are on the screen."""

from __future__ import annotations

import math

from actr3d.camera.kernel.jit import compiled
from actr3d.camera.kernel.layout import NEGLIGIBLE, SLIVER, Record, Records
from actr3d.camera.kernel.pieces import nearness
from actr3d.camera.kernel.screen import screen_part

SURELY_WIDE = 1e-4
"""No extent wider than this comes from rounding, on the widest of screens [tangent]."""


@compiled
def goes_on(object: int, low: float, optics: Record, extents: Records, first: int, done: int) -> bool:
    """Tells whether the last extent of a row is one of the given object and reaches to a tangent, or nearly so.

    Until the row ends, the `x` of extents are tangents, and their `a` the numbers of the pieces that are seen there.
    """
    if done == first or extents[done - 1].label != object:
        return False
    reached = extents[done - 1].x2
    return low - reached <= NEGLIGIBLE or _gap(reached, low, optics) <= max(optics.precision, SLIVER)


@compiled
def without_sliver(optics: Record, extents: Records, first: int, done: int) -> int:
    """Returns how many extents there are without the last one if it comes from rounding only."""
    if done > first:
        last = extents[done - 1]
        if last.x2 - last.x1 < SURELY_WIDE and _gap(last.x1, last.x2, optics) < SLIVER:
            return done - 1
    return done


@compiled
def end_row(v: float, optics: Record, pieces: Records, extents: Records, first: int, done: int) -> int:
    """Turns tangents into screen coordinates, distances and angles; returns how many extents there are."""
    done = without_sliver(optics, extents, first, done)
    for i in range(first, done):
        extent = extents[i]
        for side in range(2):
            u, number = (extent.x2, extent.a2) if side else (extent.x1, extent.a1)
            w = nearness(pieces[int(number)], u)
            aside = u * u + v * v
            x = 0.5 + 0.5 * screen_part(u, optics.right, optics.e2)
            distance, angle = math.sqrt(1.0 + aside) / w, math.degrees(math.atan(math.sqrt(aside)))
            if side:
                extent.x2, extent.d2, extent.a2 = x, distance, angle
            else:
                extent.x1, extent.d1, extent.a1 = x, distance, angle
    return done


@compiled
def _gap(low: float, high: float, optics: Record) -> float:
    """Returns how far apart two tangents are on the screen."""
    return 0.5 * (screen_part(high, optics.right, optics.e2) - screen_part(low, optics.right, optics.e2))
