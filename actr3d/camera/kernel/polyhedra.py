"""Computes the corners of boxes, meshes and height fields in the eye's frame."""

from __future__ import annotations

import math

from actr3d.camera.kernel.dtypes import Array
from actr3d.jit import inner_compiled

HFIELD_EXTRA_CORNERS = 4
"""The number of corners of a height field's base, stored after those of its surface and their projections at height 0."""


@inner_compiled
def set_box(size: Array, local: Array) -> None:
    """Writes the 8 corners of a box: bit 0 of a corner's number is the sign of x, bit 1 of y, bit 2 of z."""
    for i in range(8):
        local[i, 0] = size[0] if i & 1 else -size[0]
        local[i, 1] = size[1] if i & 2 else -size[1]
        local[i, 2] = size[2] if i & 4 else -size[2]


@inner_compiled
def set_hfield(size: Array, heights: Array, rows: int, columns: int, local: Array) -> None:
    """Writes the corners of a height field: those of its surface row by row, the same at height 0, and those of its base.

    Args:
        size: Half its length in x and y, its height, the depth of its base [m].
        heights: From 0 to 1, row by row.
        rows: The number of rows (along y).
        columns: The number of columns (along x).
        local: The output array.
    """
    cells = rows * columns
    for i in range(cells):
        x = size[0] * (2.0 * (i % columns) / (columns - 1) - 1.0)
        y = size[1] * (2.0 * (i // columns) / (rows - 1) - 1.0)
        for level in range(2):
            local[i + level * cells, 0], local[i + level * cells, 1] = x, y
        local[i, 2], local[i + cells, 2] = size[2] * heights[i], 0.0
    for i in range(HFIELD_EXTRA_CORNERS):
        corner = local[2 * cells + i]
        corner[0] = size[0] if i & 1 else -size[0]
        corner[1] = size[1] if i & 2 else -size[1]
        corner[2] = -size[3]


@inner_compiled
def hfield_reach(size: Array) -> float:
    """Returns the radius of the bounding ball of a height field about its centre [m]."""
    return math.hypot(math.hypot(size[0], size[1]), max(size[2], size[3]))


@inner_compiled
def box_distance(size: Array, place: Array, turn: Array) -> float:
    """Returns the distance from the eye to a box [m], 0 inside it."""
    square = 0.0
    for i in range(3):
        along = turn[0, i] * place[0] + turn[1, i] * place[1] + turn[2, i] * place[2]
        beyond = max(abs(along) - size[i], 0.0)
        square += beyond * beyond
    return math.sqrt(square)


@inner_compiled
def place_corners(local: Array, place: Array, turn: Array, corners: Array) -> None:
    """Transforms points from a geom's frame to the eye's frame [m]; as many as fit into the output."""
    for i in range(len(corners)):
        x, y, z = local[i, 0], local[i, 1], local[i, 2]
        for j in range(3):
            corners[i, j] = place[j] + turn[j, 0] * x + turn[j, 1] * y + turn[j, 2] * z
