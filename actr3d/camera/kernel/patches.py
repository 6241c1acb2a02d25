"""Computes the pieces of a patch (a plane or a round surface) on one row."""

from __future__ import annotations

import math

from actr3d.camera.kernel.dtypes import FAR_SIDE, LINE, NEAR_SIDE, NEGLIGIBLE, Array, Record, Records
from actr3d.camera.kernel.pieces import bound, nearness, sort_values, summit
from actr3d.camera.kernel.roots import add_roots
from actr3d.camera.kernel.screen import zero
from actr3d.jit import inner_compiled

SEEN, NO_PIECE, TO_CUT = 1, 0, -1
"""The states of a patch on a row: one whole piece, no piece, or to be cut."""


@inner_compiled
def add_patch(patch: Record, v: float, optics: Record, room: Records, pieces: Records, count: int, cuts: Array) -> int:
    """Appends the pieces of a patch on the row at the tangent v; returns the new number of pieces.

    The whole curve is cut wherever its visibility may change; each part between two cuts is either seen or not.
    """
    curve = pieces[count]
    curve.object, curve.geom = patch.object, patch.geom
    if patch.flat:
        curve.side, curve.b0, curve.c0, curve.c1 = LINE, 0.0, (patch.q[1] * v + patch.q[2]) / patch.k, patch.q[0] / patch.k
        whole = _whole_line(patch, v, optics, curve, cuts)
    else:
        form = patch.form
        curve.side, curve.a = NEAR_SIDE, patch.a
        curve.b0, curve.b1 = patch.q[1] * v + patch.q[2], patch.q[0]
        curve.c0 = v * (form[1, 1] * v + 2.0 * form[1, 2]) + form[2, 2]
        curve.c1, curve.c2 = 2.0 * (form[0, 1] * v + form[0, 2]), form[0, 0]
        whole = _whole_conic(patch, v, optics, curve, cuts)
    if whole == SEEN:
        return count + 1
    if whole == NO_PIECE:
        return count
    room[0] = curve
    return _add_parts(patch, v, optics, room[0], pieces, count, cuts)


@inner_compiled
def _whole_line(patch: Record, v: float, optics: Record, line: Record, cuts: Array) -> int:
    """Checks whether a whole line or disc is seen, cut only by the ends of a disc and of the field of view."""
    low, high = -optics.right, optics.right
    if patch.slabs > 0 or (patch.radius > 0.0 and patch.ceiling > optics.nearest):
        return TO_CUT
    if patch.radius > 0.0:
        if _cut_disc(patch, v, line, cuts, zero()) < 2:
            return NO_PIECE
        low, high = max(low, min(cuts[0], cuts[1])), min(high, max(cuts[0], cuts[1]))
    return _seen_between(low, high, optics, line)


@inner_compiled
def _seen_between(low: float, high: float, optics: Record, line: Record) -> int:
    """Checks whether a line is seen between two tangents, and sets its ends and bounds."""
    if not high - low > NEGLIGIBLE:
        return NO_PIECE
    first, last = nearness(line, low), nearness(line, high)
    floor, ceiling = min(first, last), max(first, last)
    if ceiling <= 0.0 or floor > optics.nearest:
        return NO_PIECE
    if floor <= 0.0 or ceiling > optics.nearest:
        return TO_CUT
    line.low, line.high, line.floor, line.ceiling = low, high, floor, ceiling
    return SEEN


@inner_compiled
def _whole_conic(patch: Record, v: float, optics: Record, conic: Record, cuts: Array) -> int:
    """Checks whether the whole near side of a round surface is seen without a cut, and sets its ends and bounds.

    This holds for nearly everything completely in front of the eye; the curve must be cut only where an end of a tube lies within
    its silhouette.
    """
    if patch.both or patch.ceiling > optics.nearest or not conic.a > 0.0 or not conic.b1 * conic.b1 < conic.a * conic.c2:
        return TO_CUT
    if _cut_silhouette(conic, cuts, zero()) < 2:
        return NO_PIECE
    low, high = min(cuts[0], cuts[1]), max(cuts[0], cuts[1])
    least = min(conic.b0 + conic.b1 * low, conic.b0 + conic.b1 * high)
    if not least > 0.0:
        return TO_CUT
    low, high = max(low, -optics.right), min(high, optics.right)
    if not high - low > NEGLIGIBLE:
        return NO_PIECE
    conic.low, conic.high, conic.floor, conic.ceiling = low, high, least / conic.a, min(patch.ceiling, summit(conic))
    return _within_slabs(patch, v, conic)


@inner_compiled
def _within_slabs(patch: Record, v: float, conic: Record) -> int:
    """Checks from its bounds whether a whole piece lies within the slabs of its patch."""
    whole = SEEN
    for i in range(patch.slabs):
        axis, low, high = patch.axes[i], patch.lows[i], patch.highs[i]
        along = axis[1] * v + axis[2]
        first, last = along + axis[0] * conic.low, along + axis[0] * conic.high
        least, most = min(first, last), max(first, last)
        if most < min(low * conic.floor, low * conic.ceiling) or least > max(high * conic.floor, high * conic.ceiling):
            return NO_PIECE
        if least < max(low * conic.floor, low * conic.ceiling) or most > min(high * conic.floor, high * conic.ceiling):
            whole = TO_CUT
    return whole


@inner_compiled
def _add_parts(patch: Record, v: float, optics: Record, curve: Record, pieces: Records, count: int, cuts: Array) -> int:
    """Appends the visible parts of a curve between cuts; returns the new number of pieces."""
    if curve.side == LINE:
        number = _cut_line(patch, v, optics, curve, cuts)
    else:
        number = _cut_conic(patch, v, optics, curve, cuts)
        if number == 0 and curve.b1 * curve.b1 < curve.a * curve.c2:
            return count  # the row misses it
    cuts[number], cuts[number + 1] = -optics.right, optics.right
    sort_values(cuts, number + 2)
    count = _add_side(patch, v, optics, curve, pieces, count, cuts, number + 2)
    if patch.both:
        curve.side = FAR_SIDE
        count = _add_side(patch, v, optics, curve, pieces, count, cuts, number + 2)
    return count


@inner_compiled
def _cut_line(patch: Record, v: float, optics: Record, line: Record, cuts: Array) -> int:
    """Finds where a line crosses the horizon, the near limit, its slabs and its ball; returns the number of cuts."""
    c0, c1 = line.c0, line.c1
    number = add_roots(0.0, 0.5 * c1, c0, cuts, zero())
    number = add_roots(0.0, 0.5 * c1, c0 - optics.nearest, cuts, number)
    for i in range(patch.slabs):
        axis = patch.axes[i]
        for limit in (patch.lows[i], patch.highs[i]):
            number = add_roots(0.0, 0.5 * (axis[0] - limit * c1), axis[1] * v + axis[2] - limit * c0, cuts, number)
    if patch.radius > 0.0:
        number = _cut_disc(patch, v, line, cuts, number)
    return number


@inner_compiled
def _cut_disc(patch: Record, v: float, line: Record, cuts: Array, number: int) -> int:
    """Finds where a line enters and leaves the ball of its patch; returns the new number of cuts."""
    x, y, z, c0, c1 = patch.centre[0], patch.centre[1], patch.centre[2], line.c0, line.c1
    square = patch.radius * patch.radius
    x0, y0, z0 = -x * c0, v - y * c0, 1.0 - z * c0
    x1, y1, z1 = 1.0 - x * c1, -y * c1, -z * c1
    a = x1 * x1 + y1 * y1 + z1 * z1 - square * c1 * c1
    b = x0 * x1 + y0 * y1 + z0 * z1 - square * c0 * c1
    return add_roots(a, b, x0 * x0 + y0 * y0 + z0 * z0 - square * c0 * c0, cuts, number)


@inner_compiled
def _cut_silhouette(conic: Record, cuts: Array, number: int) -> int:
    """Finds the silhouette points of a conic, where near and far side meet; returns the new number of cuts."""
    a, b0, b1, c0, c1, c2 = conic.a, conic.b0, conic.b1, conic.c0, conic.c1, conic.c2
    return add_roots(b1 * b1 - a * c2, b0 * b1 - 0.5 * a * c1, b0 * b0 - a * c0, cuts, number)


@inner_compiled
def _cut_conic(patch: Record, v: float, optics: Record, conic: Record, cuts: Array) -> int:
    """Finds the silhouette points of a conic, and where it crosses the near limit and its slab; returns the number of cuts."""
    a, b0, b1, c0, c1, c2 = conic.a, conic.b0, conic.b1, conic.c0, conic.c1, conic.c2
    number = _cut_silhouette(conic, cuts, zero())
    if number == 0 and b1 * b1 < a * c2:
        return 0
    if patch.ceiling > optics.nearest:
        w = optics.nearest
        number = add_roots(c2, 0.5 * c1 - b1 * w, (a * w - 2.0 * b0) * w + c0, cuts, number)
    for i in range(patch.slabs):
        axis = patch.axes[i]
        l0, l1 = axis[1] * v + axis[2], axis[0]
        for limit in (patch.lows[i], patch.highs[i]):
            if math.isfinite(limit):
                second = (a * l1 - 2.0 * limit * b1) * l1 + limit * limit * c2
                first = a * l0 * l1 - limit * (b0 * l1 + b1 * l0) + 0.5 * limit * limit * c1
                number = add_roots(second, first, (a * l0 - 2.0 * limit * b0) * l0 + limit * limit * c0, cuts, number)
    return number


@inner_compiled
def _add_side(patch: Record, v: float, optics: Record, curve: Record, pieces: Records, count: int, cuts: Array, number: int) -> int:
    """Appends the visible parts of one side of a curve between its cuts; returns the new number of pieces."""
    going_on = False
    for i in range(number - 1):
        low, high = cuts[i], cuts[i + 1]
        if low < -optics.right or high > optics.right or not high - low > NEGLIGIBLE:
            continue
        if not _there(patch, v, optics, curve, 0.5 * (low + high)):
            going_on = False
            continue
        if going_on:
            pieces[count - 1].high = high
        else:
            pieces[count] = curve
            pieces[count].low, pieces[count].high = low, high
            count, going_on = count + 1, True
        bound(pieces[count - 1], patch.floor, patch.ceiling)
    return count


@inner_compiled
def _there(patch: Record, v: float, optics: Record, curve: Record, u: float) -> bool:
    """Checks whether the curve's point at u is on the patch and in front of the eye."""
    if curve.side != LINE:
        b = curve.b0 + curve.b1 * u
        if b * b < curve.a * (curve.c0 + u * (curve.c1 + u * curve.c2)):
            return False
        if patch.slabs == 0 and not patch.both and curve.a > 0.0:
            return b > 0.0
    w = nearness(curve, u)
    if not 0.0 < w <= optics.nearest:
        return False
    for i in range(patch.slabs):
        axis = patch.axes[i]
        along = axis[0] * u + axis[1] * v + axis[2]
        if along < patch.lows[i] * w or along > patch.highs[i] * w:
            return False
    if patch.radius > 0.0:
        x, y, z = u - patch.centre[0] * w, v - patch.centre[1] * w, 1.0 - patch.centre[2] * w
        return x * x + y * y + z * z <= patch.radius * patch.radius * w * w
    return True
