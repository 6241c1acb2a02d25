"""Finds the point of each extent that is nearest to the eye on the ground: for many stretches at once, which is faster.

Heights are ignored: on a row, the square of the distance on the ground is `(u^2 + level) / w^2`.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from actr3d.camera.kernel.dtypes import FAR_SIDE, LINE, Record, Records
from actr3d.camera.kernel.pieces import nearness, root_of
from actr3d.jit import inner_compiled

HALVINGS = 5
"""The number of halvings in the search for the nearest point of a round piece."""
FLAT = 0.03
"""A point counts as nearest if the relative change of distance per unit of tangent is less than this."""

AT_ONCE: Final = 100
AT_MOST: Final = 3
"""The maximum number of stretches that one piece adds."""
MANY: Final = (AT_ONCE,)

STRETCHES = np.dtype(
    [
        ("count", "i8"),  # how many stretches are noted
        ("owner", "i8", MANY),  # the number of the extent
        ("least", "f8", MANY),  # the least |u|
        ("level", "f8", MANY),
        ("ceiling", "f8", MANY),  # the bound of its piece's nearness
        ("u", "f8", MANY),  # where it is nearest, and the nearness there
        ("w", "f8", MANY),
        ("open", "i8"),  # how many of them, all of round pieces, are still to be searched; the fields below are of these
        ("number", "i8", MANY),  # which of the stretches it is
        ("low", "f8", MANY),  # where the nearest point may be, and the guess
        ("high", "f8", MANY),
        ("guess", "f8", MANY),
        ("near", "f8", MANY),  # the nearness there
        ("found", "f8", MANY),  # 1 where the guess is good enough
        ("ground", "f8", MANY),  # the level
        ("side", "f8", MANY),
        ("a", "f8", MANY),  # the piece's equation
        ("b0", "f8", MANY),
        ("b1", "f8", MANY),
        ("c0", "f8", MANY),
        ("c1", "f8", MANY),
        ("c2", "f8", MANY),
    ],
    align=True,
)
"""Stretches of extents whose nearest points are still to be found. They are all in one record: the compiler then knows that the
arrays do not overlap, and can emit SIMD instructions that process four numbers at once."""


@inner_compiled
def note(stretches: Record, owner: int, piece: Record, low: float, high: float, level: float, extents: Records) -> None:
    """Stores that a piece is seen in an extent between two tangents."""
    if stretches.count > AT_ONCE - AT_MOST:
        find_nearest(stretches, extents)
    least = max(low, -high, 0.0)
    if piece.side == LINE:
        start = piece.c0 - piece.c1 * piece.b0
        end = high if piece.c1 > 0.0 else low
        _note_point(stretches, owner, piece, least, min(high, max(low, piece.c1 * level / start)) if start > 0.0 else end, level)
        return
    if piece.side == FAR_SIDE:  # from inside, the nearest point may be an end, and the middle the farthest
        _note_point(stretches, owner, piece, least, low, level)
        _note_point(stretches, owner, piece, least, high, level)
    number = _note_stretch(stretches, owner, piece, least, level)
    i = stretches.open
    stretches.open = i + 1
    # A ball or an upright pole is nearest at its middle; other round pieces are nearest on one side of it.
    x, z = piece.b1 * piece.c0 - 0.5 * piece.c1 * piece.b0, piece.b0 * piece.c2 - 0.5 * piece.c1 * piece.b1
    stretches.guess[i] = min(high, max(low, x / z)) if z != 0.0 else 0.5 * (low + high)
    stretches.number[i], stretches.low[i], stretches.high[i], stretches.ground[i] = number, low, high, level
    stretches.side[i], stretches.a[i], stretches.b0[i], stretches.b1[i] = piece.side, piece.a, piece.b0, piece.b1
    stretches.c0[i], stretches.c1[i], stretches.c2[i] = piece.c0, piece.c1, piece.c2


@inner_compiled
def _note_point(stretches: Record, owner: int, piece: Record, least: float, u: float, level: float) -> None:
    """Stores a stretch whose nearest point is known."""
    number = _note_stretch(stretches, owner, piece, least, level)
    stretches.u[number], stretches.w[number] = u, nearness(piece, u)


@inner_compiled
def _note_stretch(stretches: Record, owner: int, piece: Record, least: float, level: float) -> int:
    """Stores a stretch whose nearest point is not set yet; returns its number."""
    number = stretches.count
    stretches.count = number + 1
    stretches.owner[number], stretches.least[number] = owner, least
    stretches.level[number], stretches.ceiling[number] = level, piece.ceiling
    return number


@inner_compiled
def forget(stretches: Record, extents: int) -> None:
    """Removes the stretches of extents that were dropped: keeps those of the first `extents` extents."""
    while stretches.count > 0 and stretches.owner[stretches.count - 1] >= extents:
        stretches.count -= 1
    while stretches.open > 0 and stretches.number[stretches.open - 1] >= stretches.count:
        stretches.open -= 1


@inner_compiled
def find_nearest(stretches: Record, extents: Records) -> None:
    """Sets `xn` and `dn` of the extents (still a tangent and a nearness) from all stored stretches, and removes these."""
    for _ in range(HALVINGS):
        _try_guesses(stretches, stretches.open)
        stretches.open = _keep_open(stretches)
    for i in range(stretches.open):
        u, number = stretches.guess[i], stretches.number[i]
        b, c = stretches.b0[i] + stretches.b1[i] * u, stretches.c0[i] + u * (stretches.c1[i] + u * stretches.c2[i])
        stretches.u[number], stretches.w[number] = u, root_of(stretches.a[i], b, c, stretches.side[i])
    for i in range(stretches.count):
        extent, u, w = extents[stretches.owner[i]], stretches.u[i], stretches.w[i]
        least, level, ceiling = stretches.least[i], stretches.level[i], stretches.ceiling[i]
        best = np.inf
        if extent.dn > 0.0:
            best = (extent.xn * extent.xn + level) / (extent.dn * extent.dn)
            if least * least + level >= best * ceiling * ceiling:
                continue
        if w > 0.0 and u * u + level < best * w * w:
            extent.xn, extent.dn = u, w
    stretches.count = stretches.open = 0


@inner_compiled
def _try_guesses(stretches: Record, count: int) -> None:
    """Computes the nearness of each guess, whether the guess is good enough, and otherwise which half has the nearest point."""
    for i in range(count):
        u, b1, c1, c2 = stretches.guess[i], stretches.b1[i], stretches.c1[i], stretches.c2[i]
        b, c = stretches.b0[i] + b1 * u, stretches.c0[i] + u * (c1 + u * c2)
        w = root_of(stretches.a[i], b, c, stretches.side[i])
        slope = (b1 * w - 0.5 * c1 - c2 * u) / (stretches.a[i] * w - stretches.b0[i] - b1 * u)
        away = u - (u * u + stretches.ground[i]) * slope / w
        low = stretches.low[i] if away > 0.0 else u
        high = u if away > 0.0 else stretches.high[i]
        stretches.near[i], stretches.low[i], stretches.high[i] = w, low, high
        stretches.found[i] = 1.0 if abs(away) < FLAT or low >= high else 0.0


@inner_compiled
def _keep_open(stretches: Record) -> int:
    """Stores the results found, moves the other stretches to the front with a new guess, and returns their number."""
    kept = 0
    for i in range(stretches.open):
        if stretches.found[i] > 0.0:
            number = stretches.number[i]
            stretches.u[number], stretches.w[number] = stretches.guess[i], stretches.near[i]
            continue
        stretches.guess[kept] = 0.5 * (stretches.low[i] + stretches.high[i])
        stretches.number[kept], stretches.low[kept], stretches.high[kept] = stretches.number[i], stretches.low[i], stretches.high[i]
        stretches.ground[kept], stretches.side[kept], stretches.a[kept] = stretches.ground[i], stretches.side[i], stretches.a[i]
        stretches.b0[kept], stretches.b1[kept] = stretches.b0[i], stretches.b1[i]
        stretches.c0[kept], stretches.c1[kept], stretches.c2[kept] = stretches.c0[i], stretches.c1[i], stretches.c2[i]
        kept += 1
    return kept
