"""Computes the upper envelope of a row: which piece is nearest where."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from actr3d.camera.kernel.crossings import add_crossings, may_cover
from actr3d.camera.kernel.dtypes import BACKGROUND, NEGLIGIBLE, NUMBER, PIECE, SAME_DEPTH, Array, Record, Records
from actr3d.camera.kernel.extents import EDGES_AT_ONCE, end_row, goes_on, without_sliver
from actr3d.camera.kernel.nearest import STRETCHES, forget, note
from actr3d.camera.kernel.pieces import nearness, sort_by_start, sort_values
from actr3d.camera.kernel.screen import zero
from actr3d.jit import inner_compiled

MAX_CUTS = 400
"""The capacity of the stack of stretches; two pieces cross at most four times, so only rounding errors could come near it."""


class Row(NamedTuple):
    """The pieces of a row, and the work arrays for computing their envelope."""

    pieces: Records
    order: Array
    """The pieces' numbers, leftmost first."""
    starts: Array
    """The tangents at which they begin, in that order."""
    active: Array
    """The numbers of the active pieces."""
    rivals: Array
    """The numbers of the active pieces that may be nearest."""
    cuts: Array
    stack: Array
    """Stretches still to be processed, `(low, high)`, the leftmost last."""
    work: Array
    edges: Array
    """Work array of `finish`."""
    stretches: Array
    """Work record of `find_nearest`, one element."""
    curve: Array
    """Work array for one piece."""
    places: Array
    """The centres of the geoms in the eye's frame; the last row is the eye itself, for the end of its range."""
    reaches: Array
    """The radii of the bounding balls of the geoms about these centres."""


def room_for(pieces: int, places: Array, reaches: Array) -> Row:
    """Returns the work arrays for a given number of pieces."""
    return Row(
        pieces=np.zeros(pieces, PIECE),
        order=np.zeros(pieces, NUMBER),
        starts=np.zeros(pieces),
        active=np.zeros(pieces, NUMBER),
        rivals=np.zeros(pieces, NUMBER),
        cuts=np.zeros(64),
        stack=np.zeros((MAX_CUTS, 2)),
        work=np.zeros((6, 5)),
        edges=np.zeros((3, EDGES_AT_ONCE)),
        stretches=np.zeros(1, STRETCHES),
        curve=np.zeros(1, PIECE),
        places=places,
        reaches=reaches,
    )


@inner_compiled
def trace_row(v: float, level: float, optics: Record, row: Row, count: int, extents: Records, first: int) -> int:
    """Appends the extents of one row; returns the new number of extents.

    Between two neighbouring ends of pieces the depth order is constant, and one piece is nearest unless some cross.

    Args:
        v: The row's tangent upwards.
        level: The square of the ground distance of the point straight ahead on the row, relative to its depth.
        optics: The constants of the eye.
        row: The pieces of the row.
        count: The number of pieces.
        extents: The output array, filled as far as there is room; `label` holds the object.
        first: The number of extents already written.
    """
    done, processed, present, start, floor = first, zero(), zero(), -optics.right, -math.inf
    sort_by_start(row.order, row.starts, row.pieces, count)
    while True:
        processed, present = _activate(start, row, count, processed, present, floor)
        if present == 0:
            if processed == count:
                return end_row(v, optics, row.pieces, extents, first, done)
            start = row.starts[processed]
            continue
        front, rivals, end = _front(row, present)
        floor = row.pieces[front].floor
        processed, present, end = _activate_behind(end, row, count, processed, present, front)
        if rivals == 1:
            done = _append_stretch(front, start, end, level, optics, row, rivals, extents, first, done)
        else:
            done = _trace_stretch(start, end, level, optics, row, rivals, extents, first, done)
        start, kept = end, zero()
        for i in range(present):
            number = row.active[i]
            if row.pieces[number].high > start + NEGLIGIBLE:
                row.active[kept] = number
                kept += 1
        present = kept


@inner_compiled
def _activate(start: float, row: Row, count: int, processed: int, present: int, floor: float) -> tuple[int, int]:
    """Activates the pieces that begin at a tangent, and skips those that one active piece hides completely.

    Returns the number of pieces already processed (activated or skipped), and the number of active pieces.

    Args:
        start: The tangent.
        row: The row.
        count: The number of pieces.
        processed: The number of pieces already processed: activated or skipped.
        present: The number of active pieces.
        floor: The greatest floor of the active pieces, or more.
    """
    while processed < count:
        number = row.order[processed]
        piece = row.pieces[number]
        if floor <= piece.ceiling or not _hidden(piece, row, present):
            if row.starts[processed] > start + NEGLIGIBLE:
                break
            row.active[present] = number
            present += 1
            floor = max(floor, piece.floor)
        processed += 1
    return processed, present


@inner_compiled
def _hidden(piece: Record, row: Row, present: int) -> bool:
    """Checks whether an active piece is in front of all of a piece that begins now or later."""
    high, ceiling = piece.high, piece.ceiling
    for i in range(present):
        other = row.pieces[row.active[i]]
        if other.floor > ceiling and other.high >= high:
            return True
    return False


@inner_compiled
def _front(row: Row, present: int) -> tuple[int, int, float]:
    """Finds the piece whose farthest point is nearest, and its rivals: all pieces (itself included) not completely behind it.

    Returns the piece's number, the number of rivals, and the tangent at which the first rival ends.
    """
    front, rivals, end = row.active[0], zero(), math.inf
    floor = row.pieces[front].floor
    for i in range(1, present):
        number = row.active[i]
        if row.pieces[number].floor > floor:
            front, floor = number, row.pieces[number].floor
    for i in range(present):
        number = row.active[i]
        if row.pieces[number].ceiling >= floor:
            row.rivals[rivals] = number
            rivals += 1
            end = min(end, row.pieces[number].high)
    return front, rivals, end


@inner_compiled
def _activate_behind(end: float, row: Row, count: int, processed: int, present: int, front: int) -> tuple[int, int, float]:
    """Processes the pieces that begin before a tangent completely behind the front piece; activates those that end after the front piece.

    Returns the number of pieces already processed, the number of active pieces, and the tangent at which the next piece begins, or
    the given tangent.
    """
    floor, high = row.pieces[front].floor, row.pieces[front].high
    while processed < count and row.starts[processed] < end:
        number = row.order[processed]
        if row.pieces[number].ceiling >= floor:
            return processed, present, row.starts[processed]
        if row.pieces[number].high > high:
            row.active[present] = number
            present += 1
        processed += 1
    return processed, present, end


@inner_compiled
def _trace_stretch(
    low: float, high: float, level: float, optics: Record, row: Row, rivals: int, extents: Records, first: int, done: int
) -> int:
    """Appends the extents of a stretch in which no rival begins or ends; splits it where the nearest piece may change."""
    row.stack[0, 0], row.stack[0, 1] = low, high
    waiting = 1
    divisions = MAX_CUTS if rivals > 2 else 1  # with two rivals, the first cuts are all
    while waiting > 0:
        waiting -= 1
        low, high = row.stack[waiting, 0], row.stack[waiting, 1]
        winner = _winner(0.5 * (low + high), row, rivals)
        number = zero()
        if divisions > 0 and waiting + len(row.cuts) < MAX_CUTS:
            number = _cuts(winner, low, high, row, rivals)
        if number > 0:
            divisions -= number
            sort_values(row.cuts, number)
            for i in range(number, -1, -1):
                row.stack[waiting, 0] = row.cuts[i - 1] if i > 0 else low
                row.stack[waiting, 1] = row.cuts[i] if i < number else high
                waiting += 1
        else:
            done = _append_stretch(winner, low, high, level, optics, row, rivals, extents, first, done)
    return done


@inner_compiled
def _append_stretch(
    winner: int, low: float, high: float, level: float, optics: Record, row: Row, rivals: int, extents: Records, first: int, done: int
) -> int:
    """Appends a stretch in which one piece is nearest, or extends the last extent to its end; does nothing for the background."""
    object = row.pieces[winner].object
    if object == BACKGROUND:
        return done
    joined = goes_on(object, low, optics, extents, first, done)
    if not joined:
        done = without_sliver(optics, extents, first, done)
        forget(row.stretches[0], done)
        joined = goes_on(object, low, optics, extents, first, done)
    if not joined:
        if done == len(extents):
            return done
        extents[done].label, extents[done].dn = object, 0.0
        extents[done].x1, extents[done].a1 = low, winner if rivals == 1 else _nearest_of(winner, low, row, rivals)
        done += 1
    extents[done - 1].x2, extents[done - 1].a2 = high, winner if rivals == 1 else _nearest_of(winner, high, row, rivals)
    for i in range(rivals):
        piece = row.pieces[winner if rivals == 1 else row.rivals[i]]
        if piece.object == object:
            note(row.stretches[0], done - 1, piece, low, high, level, extents)
    return done


@inner_compiled
def _winner(u: float, row: Row, rivals: int) -> int:
    """Returns the number of the rival nearest at a tangent; if several are equally near, the one of the nearest geom."""
    winner = row.rivals[0]
    best = nearness(row.pieces[winner], u)
    for i in range(1, rivals):
        number = row.rivals[i]
        piece = row.pieces[number]
        w = nearness(piece, u)
        if w > best * (1.0 + SAME_DEPTH):
            winner, best = number, w
        elif w > best * (1.0 - SAME_DEPTH) and _precedes(row.places, piece.geom, row.pieces[winner].geom):
            winner, best = number, max(w, best)
    return winner


@inner_compiled
def _precedes(places: Array, one: int, other: int) -> bool:
    """Checks whether a geom's centre is nearer than another's, or if equal, further to the left or down.

    The geom number decides only between two geoms at one place: a view cannot show which of two identical objects is seen, but it
    can show that it is the same one everywhere.
    """
    a, b = places[one], places[other]
    near, far = a[0] * a[0] + a[1] * a[1] + a[2] * a[2], b[0] * b[0] + b[1] * b[1] + b[2] * b[2]
    if near != far:
        return near < far
    if a[0] != b[0]:
        return a[0] < b[0]
    return a[1] < b[1] or (a[1] == b[1] and one < other)


@inner_compiled
def _cuts(winner: int, low: float, high: float, row: Row, rivals: int) -> int:
    """Finds where rivals may come in front of the winner between two tangents; returns the number of cuts."""
    best, number = row.pieces[winner], zero()
    for i in range(rivals):
        other = row.pieces[row.rivals[i]]
        if other.object == best.object or other.ceiling <= best.floor or not _may_meet(row, best.geom, other.geom):
            continue
        if number < 48 and may_cover(other, best, low, high):
            number = add_crossings(best, other, low + NEGLIGIBLE, high - NEGLIGIBLE, row.work, row.cuts, number)
    return number


@inner_compiled
def _may_meet(row: Row, one: int, other: int) -> bool:
    """Checks whether the bounding balls of two geoms intersect: pieces of separate geoms never cross."""
    a, b, reach = row.places[one], row.places[other], row.reaches[one] + row.reaches[other]
    x, y, z = a[0] - b[0], a[1] - b[1], a[2] - b[2]
    return x * x + y * y + z * z <= reach * reach * (1.0 + SAME_DEPTH)


@inner_compiled
def _nearest_of(winner: int, u: float, row: Row, rivals: int) -> int:
    """Returns the number of the piece nearest at a tangent, among those of the winner's object."""
    best, object = nearness(row.pieces[winner], u), row.pieces[winner].object
    for i in range(rivals):
        number = row.rivals[i]
        other = row.pieces[number]
        if other.object == object and other.ceiling > best and nearness(other, u) > best:
            winner, best = number, nearness(other, u)
    return winner
