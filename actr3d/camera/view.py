"""What a camera returns."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from numpy.typing import NDArray

Extent = list[float]
"""`[x1, x2, d1, d2, a1, a2]`, see `View`."""


@dataclass(frozen=True, eq=False)
class View:
    """What is visible at one moment: for each scan line, from where to where which object is seen.

    An extent runs from `x1` to `x2` on the screen (0 left, 1 right), on the scan line at `y` (0 top, 1 bottom); `d1` and
    `d2` are the distances from the eye to the object at its two edges [m], `a1` and `a2` the angles between the line of
    sight and the directions to them [degrees]. Labels tell objects apart, and nothing else. An object that is cut in two by
    a nearer one has two extents.
    """

    rows: int
    """How many scan lines there are, with or without anything to see."""
    extents: NDArray[Any]
    """See `as_array`."""

    def as_array(self) -> NDArray[Any]:
        """Returns all extents as one array that cannot be written to, by rows from the top, in each from left to right.

        Its fields are `row`, `label`, `y`, `x1`, `x2`, `d1`, `d2`, `a1` and `a2`.
        """
        return self.extents

    def as_dict(self) -> dict[float, dict[int, list[Extent]]]:
        """Returns `{y: {label: [[x1, x2, d1, d2, a1, a2], ...]}}`, made anew at each call; empty rows are there as well."""
        ys = [(row + 0.5) / self.rows for row in range(self.rows)]
        view: dict[float, dict[int, list[Extent]]] = {y: {} for y in ys}
        for row, label, _, *extent in self.extents.tolist():
            view[ys[row]].setdefault(label, []).append(extent)
        return view
