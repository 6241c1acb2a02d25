"""Openings: doors, holes in walls, gaps between things; which of these, nobody tells."""

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
"""How many of the numbers of an opening are told; the others are the kernel's own."""

APART = 0.1
"""How far the edges of one opening may be apart from one row to the next [m]: an edge that leans by 45 degrees, seen from 8 m
on the default screen. Ours."""


@dataclass(frozen=True, kw_only=True)
class Opening(Feature):
    """A gap between two edges, over one or more scan lines, with nothing between them that is as near as they are.

    It is as large as the largest upright rectangle in it (by area). `distance` and `direction` are those of the middle between its
    two edges, of which one may be at the front of a wall and the other at its back.
    """

    salience: ClassVar[str] = "size"
    bare: ClassVar[Mapping[str, str]] = {"distance": "<=", "width": ">=", "height": ">=", "depth": ">="}

    width: Metres
    """Free width on the ground, along what bounds it where that is in one line (a wall), else straight from edge to edge."""
    height: Metres
    """As many scan lines as it spans; exact to one of them. Where it is open above, as high as what bounds it at the sides."""
    depth: Metres
    """How far it is free behind, square to its width, up to the nearest edge that is seen through it; infinite where nothing is."""
    top: Metres
    """Its upper end, above the eye."""
    bottom: Metres
    """Its lower end, above the eye, mostly below 0."""
    left: Label
    """What bounds it at the left."""
    right: Label
    """What bounds it at the right; in a hole, the same."""
    above: Label = 0
    """What bounds it above; 0 where it is open, or leaves the field of view."""
    below: Label = 0
    """What bounds it below, likewise; the ground is not told."""
    cut: bool = False
    """Whether it leaves the field of view above or below: then it is at least as high as `height`."""

    @property
    def key(self) -> tuple[int, int]:
        """What tells it apart from others, from look to look: what bounds it at the sides."""
        return self.left, self.right

    def at_most(self, slot: str, value: Any) -> Any:
        """Returns infinity for the height of one that leaves the field of view: no bound was seen."""
        return math.inf if slot == "height" and self.cut else value


@detector(Opening)
def opening(view: View, *, step: Annotated[Metres, Ge(0)] = 0.02) -> tuple[Opening, ...]:
    """Finds openings: gaps on scan lines, joined over rows.

    A gap is bounded at its left and right by edges that are nearer than all that is seen between them. What leaves the field of
    view at the left or right is none: from inside a doorway, when its sides are no longer seen, there is nothing to find.

    Args:
        view: What is seen.
        step: How much farther than the edges of a gap everything between them must be.
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
            return tuple(_opening(*numbers[:SHOWN]) for numbers in openings[:there].tolist())


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
