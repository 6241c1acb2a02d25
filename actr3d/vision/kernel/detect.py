"""The compiled functions that are called from outside."""

from __future__ import annotations

import math
from pathlib import Path

from actr3d.camera.kernel import SOURCES
from actr3d.camera.kernel.dtypes import Array, Record, Records
from actr3d.camera.kernel.screen import row_tangent, tangent_at
from actr3d.jit import compiled_on_demand, inner_compiled
from actr3d.vision.kernel.gaps import find_gaps, link_gaps
from actr3d.vision.kernel.openings import set_openings
from actr3d.vision.kernel.surfaces import set_surfaces


@compiled_on_demand(SOURCES, Path(__file__).parent)
def gaps(
    extents: Records, optics: Array, axes: Array, step: float, apart: float, points: Array, found: Records, openings: Records
) -> tuple[int, int]:
    """Finds openings; the first call of it in a new installation takes seconds.

    It takes: the extents, an array of one optics, the eye's axes, the step behind a gap, the greatest distance between the edges of one
    opening from row to row, and room for points, gaps and openings. It returns the numbers of gaps and openings:
    `(gaps, 0)` if gaps lack room; if openings do, none is written.
    """
    set_points(extents, optics[0], axes, points)
    count = find_gaps(extents, points, optics[0], axes[1, 2], step, found)
    if count > len(found):
        return count, 0
    there = link_gaps(extents, points, found, count, apart)
    if there <= len(openings):
        set_openings(extents, points, found, count, optics[0].rows, openings[:there])
    return count, there


@compiled_on_demand(SOURCES, Path(__file__).parent)
def surfaces(extents: Records, optics: Array, axes: Array, bearing: float, points: Array, found: Records) -> int:
    """Finds surfaces; it takes: the extents, an array of one optics, the eye's axes, a bearing,
    and room for points and surfaces. It returns the highest label; if there is no room for it, nothing is written.
    """
    set_points(extents, optics[0], axes, points)
    return set_surfaces(extents, points, bearing, found)


@inner_compiled
def set_points(extents: Records, optics: Record, axes: Array, points: Array) -> None:
    """Writes the positions of each extent's edges and nearest point: ahead, left, up and deep along the line of sight [m], `(n, 3, 4)`.

    Ahead, left and up are those of the upright frame that `View.axes` are given in, with the eye as origin.
    """
    for i in range(len(extents)):
        extent = extents[i]
        v = row_tangent(extent.row, optics)
        for side in range(3):
            x, distance = (extent.x1, extent.d1) if side == 0 else (extent.x2, extent.d2) if side == 1 else (extent.xn, extent.dn)
            u = tangent_at(2.0 * x - 1.0, optics.right, optics.e2)
            deep = distance / math.sqrt(1.0 + u * u + v * v)
            for k in range(3):
                points[i, side, k] = deep * (u * axes[0, k] + v * axes[1, k] + axes[2, k])
            points[i, side, 3] = deep
