"""Things that wait for the row they begin on, and stay until the row they end on."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from actr3d.camera.kernel.jit import compiled
from actr3d.camera.kernel.layout import NUMBER, Array


class Waiting(NamedTuple):
    """Numbered things by their rows; those on a row are found without a look at all others."""

    starting: Array
    """The first of the things that begin on a row, or -1."""
    following: Array
    """The next of the things that begin on the same row as a thing, or -1."""
    ending: Array
    """The last row of a thing."""
    present: Array
    """The things on the row at hand."""


def room_for_waiting(things: int, rows: int) -> Waiting:
    """Returns room for so many things and rows."""
    return Waiting(
        starting=np.zeros(rows, np.int64),
        following=np.zeros(things, np.int64),
        ending=np.zeros(things, np.int64),
        present=np.zeros(things, NUMBER),
    )


@compiled
def send_away(waiting: Waiting) -> None:
    """Forgets all things."""
    for row in range(len(waiting.starting)):
        waiting.starting[row] = -1


@compiled
def enter(waiting: Waiting, thing: int, first: int, last: int) -> None:
    """Enters a thing from its first to its last row; not at all if there is none."""
    if first <= last:
        waiting.following[thing] = waiting.starting[first]
        waiting.starting[first] = thing
        waiting.ending[thing] = last


@compiled
def bring_up(waiting: Waiting, row: int, present: int) -> int:
    """Brings the things at hand up to date from the row above; returns how many there are."""
    kept = 0
    for i in range(present):
        if waiting.ending[waiting.present[i]] >= row:
            waiting.present[kept] = waiting.present[i]
            kept += 1
    thing = waiting.starting[row]
    while thing >= 0:
        waiting.present[kept] = thing
        kept += 1
        thing = waiting.following[thing]
    return kept
