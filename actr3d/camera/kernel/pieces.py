"""Pieces: the stretches of surfaces on one row, their nearness and their order."""

from __future__ import annotations

import math

from actr3d.camera.kernel.dtypes import LINE, NEAR_SIDE, NEGLIGIBLE, Array, Record, Records
from actr3d.jit import inner_compiled


@inner_compiled
def root_of(a: float, b: float, c: float, side: float) -> float:
    """Returns a root of `a w^2 - 2 b w + c`: the nearness of the near (1) or far (-1) side, without loss of precision."""
    root = math.sqrt(max(b * b - a * c, 0.0))
    straight = side * b >= 0.0
    return (b + side * root if straight else c) / (a if straight else b - side * root)


@inner_compiled
def nearness(piece: Record, u: float) -> float:
    """Returns 1 / depth of a piece at the tangent u [1/m]."""
    if piece.side == LINE:
        return piece.c0 + piece.c1 * (u - piece.b0)
    return root_of(piece.a, piece.b0 + piece.b1 * u, piece.c0 + u * (piece.c1 + u * piece.c2), piece.side)


@inner_compiled
def bound(piece: Record, floor: float, ceiling: float) -> None:
    """Sets the bounds of a piece's nearness: from its ends where these determine them, otherwise from bounds of the whole surface."""
    first, last = nearness(piece, piece.low), nearness(piece, piece.high)
    piece.floor, piece.ceiling = min(first, last), max(first, last)
    if piece.side == NEAR_SIDE:
        piece.ceiling = min(ceiling, summit(piece))
    elif piece.side != LINE:
        piece.floor = floor


@inner_compiled
def summit(piece: Record) -> float:
    """Returns the nearness [1/m] of the nearest point of a conic on its row. There, both solutions for u are equal."""
    a = piece.a * piece.c2 - piece.b1 * piece.b1
    b = piece.c2 * piece.b0 - 0.5 * piece.b1 * piece.c1
    discriminant = b * b - a * (piece.c2 * piece.c0 - 0.25 * piece.c1 * piece.c1)
    if a <= 0.0 or discriminant < 0.0:
        return math.inf
    return (b + math.sqrt(discriminant)) / a * (1.0 + NEGLIGIBLE)


@inner_compiled
def sort_values(values: Array, count: int) -> None:
    """Sorts the first `count` values by insertion, which is fast for a few dozen values."""
    gap = 1
    while gap < count // 3:
        gap = 3 * gap + 1
    while gap > 0:
        for i in range(gap, count):
            value, j = values[i], i
            while j >= gap and values[j - gap] > value:
                values[j] = values[j - gap]
                j -= gap
            values[j] = value
        gap //= 3


@inner_compiled
def sort_by_start(order: Array, starts: Array, pieces: Records, count: int) -> None:
    """Fills `order` with the numbers of the first `count` pieces, leftmost first, and `starts` with their first tangents.

    Most pieces are already in order, from the row above; otherwise the sort begins with wide gaps.
    """
    descents = 0
    for i in range(count):
        order[i], starts[i] = i, pieces[i].low
        descents += i > 0 and starts[i] < starts[i - 1]
    gap = 1
    while gap < count // 3 and descents * 8 > count:
        gap = 3 * gap + 1
    while gap > 0:
        for i in range(gap, count):
            one, low, j = order[i], starts[i], i
            while j >= gap and starts[j - gap] > low:
                order[j], starts[j] = order[j - gap], starts[j - gap]
                j -= gap
            order[j], starts[j] = one, low
        gap //= 3
