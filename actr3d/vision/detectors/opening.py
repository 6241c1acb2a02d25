"""Openings: doors, holes in walls and gaps between objects, without distinction."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar

import numpy as np
from annotated_types import Ge

from actr3d.camera import View
from actr3d.vision.detectors.registry import detector
from actr3d.vision.feature import Feature
from actr3d.vision.kernel import detect
from actr3d.vision.kernel.gaps import GAP
from actr3d.vision.kernel.openings import OPENING
from actr3d.vision.units import Label, Metres

SHOWN = 11
"""The number of fields of an `OPENING` record that an `Opening` is made from; only the kernel uses the others."""

APART = 0.1
"""Greatest distance of an opening's edges from one row to the next [m]: an edge that leans by 45 degrees, seen from 8 m
on the default screen. Source: chosen."""


@dataclass(frozen=True, kw_only=True)
class Opening(Feature):
    """A gap between two edges on the same scan lines; everything visible between them is farther away than both.

    Its size is that of the largest upright rectangle in it (by area). `distance` and `direction` are those of the middle between its
    two edges, of which one may be at the front of a wall and the other at its back.
    """

    salience: ClassVar[str] = "size"
    default_comparisons: ClassVar[Mapping[str, str]] = {"distance": "<=", "width": ">=", "height": ">=", "depth": ">="}

    width: Metres
    """Free width on the ground, along its boundary if that is one line (a wall), otherwise straight from edge to edge."""
    height: Metres
    """Height that its scan lines cover, accurate to one scan line. If it is open above, the height of its sides."""
    depth: Metres
    """Free depth behind it, perpendicular to its width, up to the nearest edge that is visible through it; infinite without one."""
    top: Metres
    """Its upper end, above the eye."""
    bottom: Metres
    """Its lower end, above the eye, mostly below 0."""
    left: Label
    """The object at its left side."""
    right: Label
    """The object at its right side; for a hole, the same."""
    above: Label = 0
    """The object above it; 0 if it is open, or leaves the field of view."""
    below: Label = 0
    """The object below it; 0 also for the ground."""
    cut: bool = False
    """Whether it leaves the field of view above or below: then `height` is a lower bound."""

    @property
    def key(self) -> tuple[int, int]:
        """The labels of the objects at its sides, by which it is found again in the next view."""
        return self.left, self.right

    def at_most(self, slot: str, value: Any) -> Any:
        """Returns infinity for the height of an opening that leaves the field of view: its end is not visible."""
        return math.inf if slot == "height" and self.cut else value


@detector(Opening)
def opening(view: View, *, step: Annotated[Metres, Ge(0)] = 0.02) -> tuple[Opening, ...]:
    """Finds openings: gaps on scan lines, joined over rows.

    The left and right edges of a gap are nearer than everything visible between them. A gap that leaves the field of view at the
    left or right does not count: inside a doorway, when its sides are no longer visible, there is no opening.

    Args:
        view: The view.
        step: Minimum distance behind both edges of what is seen between them.
    """
    extents = view.extents
    count = len(extents)
    if count < 2:
        return ()
    points = np.empty((count, 3, 4))
    gaps, openings = np.empty(2 * count, GAP), np.empty(64, OPENING)
    find = detect.gaps()
    while True:
        found, there = find(extents, view.optics, view.axes, step, APART, points, gaps, openings)
        if found > len(gaps):
            gaps = np.empty(found, GAP)
        elif there > len(openings):
            openings = np.empty(there, OPENING)
        else:
            known = [_opening(*numbers[:SHOWN]) for numbers in openings[:there].tolist()]
            return tuple([one for one in known if one.height > 0])


def _opening(
    width: float,
    deep: float,
    top: float,
    bottom: float,
    ahead: float,
    aside: float,
    left: int,
    right: int,
    above: int,
    below: int,
    cut: int,
) -> Opening:
    return Opening(
        distance=math.hypot(ahead, aside),
        direction=math.atan2(aside, ahead),
        width=width,
        height=top - bottom,
        depth=deep,
        top=top,
        bottom=bottom,
        left=left,
        right=right,
        above=above,
        below=below,
        cut=bool(cut),
    )
