"""What is nearest along a row."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from actr3d.camera.kernel.crossings import add_crossings, may_cover
from actr3d.camera.kernel.extents import end_row, goes_on, without_sliver
from actr3d.camera.kernel.jit import compiled, zero
from actr3d.camera.kernel.layout import BACKGROUND, NEGLIGIBLE, PIECE, SAME_DEPTH, Array, Record, Records
from actr3d.camera.kernel.pieces import nearness, sort_by_start, sort_values

MOST_CUTS = 400
"""How many parts may wait; two pieces cross at most four times, so that only rounding could ever come near."""


class Row(NamedTuple):
    """The pieces of a row, and room to find out which is nearest where."""

    pieces: Records
    order: Array
    """The pieces' numbers, leftmost first."""
    starts: Array
    """Where they begin."""
    active: Array
    """The numbers of those at hand."""
    cuts: Array
    stack: Array
    """Stretches still to be looked at, `(low, high)`, the leftmost last."""
    work: Array
    curve: Array
    """One piece."""
    places: Array
    """Where the geoms' centres are, in the eye's frame."""


def room_for(pieces: int, places: Array) -> Row:
    """Returns room for so many pieces."""
    return Row(
        pieces=np.zeros(pieces, PIECE),
        order=np.zeros(pieces, np.int64),
        starts=np.zeros(pieces),
        active=np.zeros(pieces, np.int64),
        cuts=np.zeros(64),
        stack=np.zeros((MOST_CUTS, 2)),
        work=np.zeros((6, 5)),
        curve=np.zeros(1, PIECE),
        places=places,
    )


@compiled
def trace_row(v: float, optics: Record, row: Row, count: int, extents: Records, first: int) -> int:
    """Appends the extents of one row; returns how many extents there are now.

    Between two neighbouring ends of pieces the same pieces lie behind one another, and one of them wins unless some cross.

    Args:
        v: The row's tangent upwards.
        optics: The eye's.
        row: What lies on the row.
        count: How many pieces there are.
        extents: Where they are written, as far as there is room; `label` holds the object.
        first: How many there are already.
    """
    done, waiting, present, start = first, zero(), zero(), -optics.right
    sort_by_start(row.order, row.starts, row.pieces, count)
    while True:
        waiting, present = _bring_in(start, row, count, waiting, present)
        end: float = row.starts[waiting] if waiting < count else math.inf
        if present == 0:
            if waiting == count:
                return end_row(v, optics, row.pieces, extents, first, done)
            start = end
            continue
        for i in range(present):
            end = min(end, row.pieces[row.active[i]].high)
        done = _trace_stretch(start, end, optics, row, present, extents, first, done)
        start, kept = end, zero()
        for i in range(present):
            if row.pieces[row.active[i]].high > start + NEGLIGIBLE:
                row.active[kept] = row.active[i]
                kept += 1
        present = kept


@compiled
def _bring_in(start: float, row: Row, count: int, waiting: int, present: int) -> tuple[int, int]:
    """Takes up the pieces that begin at a tangent, and passes over those that are hidden wholly by one at hand.

    Returns how many of all pieces were taken up or passed over, and how many are at hand.
    """
    while waiting < count:
        number = row.order[waiting]
        piece = row.pieces[number]
        if not _hidden(piece, row, present):
            if piece.low > start + NEGLIGIBLE:
                break
            row.active[present] = number
            present += 1
        waiting += 1
    return waiting, present


@compiled
def _hidden(piece: Record, row: Row, present: int) -> bool:
    """Tells whether one of the pieces at hand is in front of all of a piece that begins now or later."""
    for i in range(present):
        other = row.pieces[row.active[i]]
        if other.floor > piece.ceiling and other.high >= piece.high:
            return True
    return False


@compiled
def _trace_stretch(low: float, high: float, optics: Record, row: Row, present: int, extents: Records, first: int, done: int) -> int:
    """Appends the extents of a stretch in which no piece begins or ends; divides it wherever the winner may change."""
    row.stack[0, 0], row.stack[0, 1] = low, high
    waiting = 1
    divisions = MOST_CUTS
    while waiting > 0:
        waiting -= 1
        low, high = row.stack[waiting, 0], row.stack[waiting, 1]
        winner, alone = _winner(0.5 * (low + high), row, present)
        object = row.pieces[winner].object
        number = zero()
        if not alone and divisions > 0 and waiting + len(row.cuts) < MOST_CUTS:
            number = _cuts(winner, low, high, row, present)
        if number > 0:
            divisions -= number
            sort_values(row.cuts, number)
            for i in range(number, -1, -1):
                row.stack[waiting, 0] = row.cuts[i - 1] if i > 0 else low
                row.stack[waiting, 1] = row.cuts[i] if i < number else high
                waiting += 1
        elif object != BACKGROUND:
            done = without_sliver(optics, extents, first, done)
            if not goes_on(object, low, optics, extents, first, done):
                if done == len(extents):
                    continue
                extents[done].label = object
                extents[done].x1, extents[done].a1 = low, winner if alone else _nearest_of(winner, low, row, present)
                done += 1
            extents[done - 1].x2, extents[done - 1].a2 = high, winner if alone else _nearest_of(winner, high, row, present)
    return done


@compiled
def _winner(u: float, row: Row, present: int) -> tuple[int, bool]:
    """Returns the number of the piece that is nearest at a tangent, and whether no other one comes near it anywhere.

    Of equals, it is that of the nearest geom.
    """
    winner, rivals = row.active[0], 0
    for i in range(1, present):
        if row.pieces[row.active[i]].floor > row.pieces[winner].floor:
            winner = row.active[i]
    floor = row.pieces[winner].floor
    for i in range(present):
        rivals += row.pieces[row.active[i]].ceiling >= floor
    if rivals <= 1 and row.pieces[winner].ceiling >= floor:
        return winner, True
    best = nearness(row.pieces[winner], u)
    for i in range(present):
        number = row.active[i]
        piece = row.pieces[number]
        if piece.ceiling < floor or number == winner:
            continue
        w = nearness(piece, u)
        if w > best * (1.0 + SAME_DEPTH):
            winner, best = number, w
        elif w > best * (1.0 - SAME_DEPTH) and _goes_first(row.places, piece.geom, row.pieces[winner].geom):
            winner, best = number, max(w, best)
    return winner, False


@compiled
def _goes_first(places: Array, one: int, other: int) -> bool:
    """Tells whether a geom's centre is nearer than another's, or else further to the left or down.

    Only of two at one place does the number decide: which of two things that look alike is seen cannot be told from a view,
    but that it is the same one everywhere can.
    """
    a, b = places[one], places[other]
    near, far = a[0] * a[0] + a[1] * a[1] + a[2] * a[2], b[0] * b[0] + b[1] * b[1] + b[2] * b[2]
    if near != far:
        return near < far
    if a[0] != b[0]:
        return a[0] < b[0]
    return a[1] < b[1] or (a[1] == b[1] and one < other)


@compiled
def _cuts(winner: int, low: float, high: float, row: Row, present: int) -> int:
    """Finds where between two tangents others may come to lie in front of the winner; returns how many cuts there are."""
    best, number = row.pieces[winner], zero()
    for i in range(present):
        other = row.pieces[row.active[i]]
        if other.object != best.object and number < 48 and may_cover(other, best, low, high):
            number = add_crossings(best, other, low + NEGLIGIBLE, high - NEGLIGIBLE, row.work, row.cuts, number)
    return number


@compiled
def _nearest_of(winner: int, u: float, row: Row, present: int) -> int:
    """Returns the number of the piece that is nearest at a tangent, of those of the winner's object."""
    best, object = nearness(row.pieces[winner], u), row.pieces[winner].object
    for i in range(present):
        number = row.active[i]
        other = row.pieces[number]
        if other.object == object and other.ceiling > best and nearness(other, u) > best:
            winner, best = number, nearness(other, u)
    return winner
