"""Positions of a view's edges in space."""

from __future__ import annotations

import math

from actr3d.camera.kernel.jit import compiled
from actr3d.camera.kernel.layout import Array, Record, Records
from actr3d.camera.kernel.screen import row_tangent, tangent_at


@compiled
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
