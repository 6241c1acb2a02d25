"""The compiled function that compares what is felt with what was felt before."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from actr3d.jit import compiled_on_demand

Row = NDArray[np.float64]

UNIT, GRID, PLACE, LOW, HIGH, MINIMUM, MAXIMUM, LEAST, MOST, STEP = range(10)
"""What is kept of each felt value, by row: its unit in commands, the step of the grid in that unit, and its multiple of it; the least and
the greatest value since that multiple last changed, and ever; those in the postures that were stored, and the step that makes a new one."""


@compiled_on_demand(Path(__file__))
def note_felt(values: Row, rows: Any, new: NDArray[np.intp]) -> int:
    """Notes felt values in the rows above.

    Its arguments are the values (n,), the rows (10, n), and room for numbers (n,). It puts there the numbers of the values whose place
    on the grid has changed, or that are at least one step beyond their extremes in all earlier postures; it returns how many they are.

    A value between two others with the same place on the grid has that place too, and is no new extreme.
    """
    count = 0
    for number in range(len(values)):
        at = values[number]
        if rows[LOW, number] <= at <= rows[HIGH, number]:
            continue
        rows[MINIMUM, number] = min(at, rows[MINIMUM, number])
        rows[MAXIMUM, number] = max(at, rows[MAXIMUM, number])
        place = np.rint(at / rows[UNIT, number] / rows[GRID, number])
        changed = place != rows[PLACE, number]
        if changed:
            rows[PLACE, number] = place
            rows[LOW, number] = rows[HIGH, number] = at
        elif at < rows[LOW, number]:
            rows[LOW, number] = at
        else:
            rows[HIGH, number] = at
        step = rows[STEP, number]
        if changed or at >= rows[MOST, number] + step or at <= rows[LEAST, number] - step:
            new[count] = number
            count += 1
    return count
