"""Keeps track of which items are active on each row: every item has a first and a last row."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from actr3d.camera.kernel.dtypes import NUMBER, Array
from actr3d.jit import inner_compiled


class ActiveRows(NamedTuple):
    """Numbered items, indexed by the row they begin on; finds the items of a row without checking all others."""

    starting: Array
    """The first of the items that begin on each row, or -1."""
    following: Array
    """For each item, the next item that begins on the same row, or -1."""
    ending: Array
    """The last row of each item."""
    present: Array
    """The items on the current row."""


def room_for_active_rows(things: int, rows: int) -> ActiveRows:
    """Returns the arrays for a given number of items and rows."""
    return ActiveRows(
        starting=np.full(rows, -1),
        following=np.zeros(things, np.int64),
        ending=np.zeros(things, np.int64),
        present=np.zeros(things, NUMBER),
    )


@inner_compiled
def remove_all(active: ActiveRows) -> None:
    """Removes all items."""
    for row in range(len(active.starting)):
        active.starting[row] = -1


@inner_compiled
def add_item(active: ActiveRows, thing: int, first: int, last: int) -> None:
    """Adds an item from its first to its last row; does nothing if there are no rows."""
    if first <= last:
        active.following[thing] = active.starting[first]
        active.starting[first] = thing
        active.ending[thing] = last


@inner_compiled
def update_active(active: ActiveRows, row: int, present: int) -> int:
    """Updates the active items from the row above to this row; returns their number."""
    kept = 0
    for i in range(present):
        if active.ending[active.present[i]] >= row:
            active.present[kept] = active.present[i]
            kept += 1
    thing = active.starting[row]
    while thing >= 0:
        active.present[kept] = thing
        kept += 1
        thing = active.following[thing]
    return kept
