"""Joins stretches to extents, and says where they are on the screen."""

from __future__ import annotations

import math

from actr3d.camera.kernel.jit import compiled
from actr3d.camera.kernel.layout import SLIVER, Array, Record
from actr3d.camera.kernel.screen import screen_part


@compiled
def add_extent(object: int, low: float, high: float, near: float, far: float, optics: Record, extents: Array, first: int, done: int) -> int:
    """Appends a stretch of an object, or lets the last extent of the row go on; returns how many there are now.

    Until the row ends, `x` holds tangents, and `d` nearness.

    Args:
        object: The object's number.
        low: Where the stretch begins and ends [tangent].
        high: As above.
        near: Its nearness there [1/m].
        far: As above.
        optics: The eye's.
        extents: Where they are written, as far as there is room.
        first: Where this row begins in them.
        done: How many there are already.
    """
    done = _without_sliver(optics, extents, first, done)
    if done > first:
        last = extents[done - 1]
        if last.label == object and _gap(last.x2, low, optics) <= max(optics.precision, SLIVER):
            last.x2, last.d2 = high, far
            return done
    if done < len(extents):
        extent = extents[done]
        extent.label = object
        extent.x1, extent.x2, extent.d1, extent.d2 = low, high, near, far
        done += 1
    return done


@compiled
def end_row(v: float, optics: Record, extents: Array, first: int, done: int) -> int:
    """Turns tangents into screen coordinates, distances and angles; returns how many extents there are."""
    done = _without_sliver(optics, extents, first, done)
    for i in range(first, done):
        extent = extents[i]
        for side in range(2):
            u, w = (extent.x2, extent.d2) if side else (extent.x1, extent.d1)
            x = 0.5 + 0.5 * screen_part(u, optics.right, optics.e2)
            distance = math.sqrt(1.0 + u * u + v * v) / w
            angle = math.degrees(math.atan(math.hypot(u, v)))
            if side:
                extent.x2, extent.d2, extent.a2 = x, distance, angle
            else:
                extent.x1, extent.d1, extent.a1 = x, distance, angle
    return done


@compiled
def _gap(low: float, high: float, optics: Record) -> float:
    """Returns how far apart two tangents are on the screen."""
    return 0.5 * (screen_part(high, optics.right, optics.e2) - screen_part(low, optics.right, optics.e2))


@compiled
def _without_sliver(optics: Record, extents: Array, first: int, done: int) -> int:
    """Returns how many extents there are without the last one if it comes from rounding only."""
    if done > first and _gap(extents[done - 1].x1, extents[done - 1].x2, optics) < SLIVER:
        return done - 1
    return done
