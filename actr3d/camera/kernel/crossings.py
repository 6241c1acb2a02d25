"""Computes where two pieces are equally near."""

from __future__ import annotations

from actr3d.camera.kernel.dtypes import FAR_SIDE, LINE, NEAR_SIDE, SAME_DEPTH, Array, Record
from actr3d.camera.kernel.pieces import nearness
from actr3d.camera.kernel.roots import add_quartic_roots, add_roots
from actr3d.jit import inner_compiled


@inner_compiled
def may_cover(other: Record, winner: Record, low: float, high: float) -> bool:
    """Checks whether a piece may be in front of another one somewhere between two tangents.

    Compares a line above the first piece with a line below the second at both ends.
    """
    if other.ceiling <= winner.floor:
        return False
    above_low, above_high = _straight(other, low, high, other.side == NEAR_SIDE)
    below_low, below_high = _straight(winner, low, high, winner.side == FAR_SIDE)
    return above_low > below_low * (1.0 + SAME_DEPTH) or above_high > below_high * (1.0 + SAME_DEPTH)


@inner_compiled
def _straight(piece: Record, low: float, high: float, touching: bool) -> tuple[float, float]:
    """Returns the ends of a piece's chord, or of its tangent line in the middle: near sides curve down, far sides up."""
    if not touching:
        return nearness(piece, low), nearness(piece, high)
    middle = 0.5 * (low + high)
    w = nearness(piece, middle)
    slope = piece.b1 * w - 0.5 * piece.c1 - piece.c2 * middle
    slope /= piece.a * w - piece.b0 - piece.b1 * middle
    return w - slope * (middle - low), w + slope * (high - middle)


@inner_compiled
def add_crossings(one: Record, other: Record, low: float, high: float, work: Array, cuts: Array, count: int) -> int:
    """Appends the tangents between `low` and `high` at which two pieces cross, and possibly some at which they do not.

    Returns the new number of cuts.
    """
    start, middle = count, 0.5 * (low + high)
    if one.side == LINE and other.side == LINE:
        first, last = nearness(one, low) - nearness(other, low), nearness(one, high) - nearness(other, high)
        if (first > 0.0) != (last > 0.0):
            cuts[count] = low + (high - low) * (first / (first - last))
            count += 1
        return count
    if one.side == LINE:
        count = _line_and_conic(one, other, middle, cuts, count)
    elif other.side == LINE:
        count = _line_and_conic(other, one, middle, cuts, count)
    else:
        count = _two_conics(one, other, middle, 0.5 * (high - low), work, cuts, count)
    kept = start
    for i in range(start, count):
        if low < cuts[i] < high:
            cuts[kept] = cuts[i]
            kept += 1
    return kept


@inner_compiled
def _line_and_conic(line: Record, conic: Record, middle: float, cuts: Array, count: int) -> int:
    """Inserts the line into the conic's equation, both expanded about the middle, which keeps precision."""
    w, w1 = nearness(line, middle), line.c1
    a, b, b1 = conic.a, conic.b0 + conic.b1 * middle, conic.b1
    c, c1 = conic.c0 + middle * (conic.c1 + middle * conic.c2), conic.c1 + 2.0 * middle * conic.c2
    second = (a * w1 - 2.0 * b1) * w1 + conic.c2
    first = a * w * w1 - b * w1 - b1 * w + 0.5 * c1
    after = add_roots(second, first, (a * w - 2.0 * b) * w + c, cuts, count)
    for i in range(count, after):
        cuts[i] += middle
    return after


@inner_compiled
def _two_conics(one: Record, other: Record, middle: float, half: float, work: Array, cuts: Array, count: int) -> int:
    """Eliminates w from both equations: where they cross, w = n / m, and a n^2 - 2 b n m + c m^2 = 0, a quartic."""
    # Expanded about the middle, in units of half the stretch, and with w in units of its value on `one` there.
    unit = nearness(one, middle)
    a, e = one.a * unit * unit, other.a * unit * unit
    b0, b1 = (one.b0 + one.b1 * middle) * unit, one.b1 * half * unit
    f0, f1 = (other.b0 + other.b1 * middle) * unit, other.b1 * half * unit
    c0, c1, c2 = one.c0 + middle * (one.c1 + middle * one.c2), (one.c1 + 2.0 * middle * one.c2) * half, one.c2 * half * half
    g0, g1 = other.c0 + middle * (other.c1 + middle * other.c2), (other.c1 + 2.0 * middle * other.c2) * half
    g2 = other.c2 * half * half
    n0, n1, n2 = e * c0 - a * g0, e * c1 - a * g1, e * c2 - a * g2
    m0, m1 = 2.0 * (e * b0 - a * f0), 2.0 * (e * b1 - a * f1)
    mm0, mm1, mm2 = m0 * m0, 2.0 * m0 * m1, m1 * m1
    quartic = work[5]
    quartic[0] = a * n0 * n0 - 2.0 * b0 * n0 * m0 + c0 * mm0
    quartic[1] = 2.0 * a * n0 * n1 - 2.0 * (b0 * (n0 * m1 + n1 * m0) + b1 * n0 * m0) + c0 * mm1 + c1 * mm0
    quartic[2] = a * (n1 * n1 + 2.0 * n0 * n2) - 2.0 * (b0 * (n1 * m1 + n2 * m0) + b1 * (n0 * m1 + n1 * m0))
    quartic[2] += c0 * mm2 + c1 * mm1 + c2 * mm0
    quartic[3] = 2.0 * a * n1 * n2 - 2.0 * (b0 * n2 * m1 + b1 * (n1 * m1 + n2 * m0)) + c1 * mm2 + c2 * mm1
    quartic[4] = a * n2 * n2 - 2.0 * b1 * n2 * m1 + c2 * mm2
    after = add_quartic_roots(quartic, work, cuts, count)
    for i in range(count, after):
        cuts[i] = middle + half * cuts[i]
    return after
