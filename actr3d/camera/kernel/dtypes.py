"""The record types that the compiled functions pass to each other."""

from __future__ import annotations

from typing import Any, Final, NamedTuple, TypeAlias

import numpy as np
from numpy.typing import NDArray

Array: TypeAlias = NDArray[Any]
Record: TypeAlias = Any
"""One element of an array of records; its fields are those of the array's dtype."""
Records: TypeAlias = Any
"""An array of records."""

LINE: Final = 0
NEAR_SIDE: Final = 1
FAR_SIDE: Final = -1

PLANE, HFIELD, SPHERE, CAPSULE, ELLIPSOID, CYLINDER, BOX, MESH, SDF = range(9)
"""The types of geoms. Source: MuJoCo 4.0, `mjtGeom`."""

UNSEEN: Final = -1
"""The object number of geoms that are invisible to the eye."""
BACKGROUND: Final = 0
"""The object number of geoms that hide others but are not reported."""

NUMBER: Final = np.uint32
"""The type of piece numbers and other indices: unsigned, so that compiled code need not check for negative indices."""

NEGLIGIBLE: Final = 1e-11
"""Pieces and stretches whose tangents differ by less than this are left out."""
SAME_DEPTH: Final = 1e-9
"""Surfaces whose depths differ by less than this fraction count as coincident, and neither cuts the other."""
SLIVER: Final = 1e-7
"""Extents narrower than this part of the screen are rounding errors."""

PIECE = np.dtype(
    [
        ("low", "f8"),  # where it begins and ends [tangent]
        ("high", "f8"),
        ("floor", "f8"),  # bounds of its nearness [1/m]
        ("ceiling", "f8"),
        ("side", "i8"),  # a line, or the near or far side of something round
        ("object", "i8"),
        ("geom", "i8"),
        ("surface", "i8"),  # the number of the patch or face it is cut from, see EyeScene.surfaces, or -1
        ("a", "f8"),  # conic: a w^2 - 2 (b0 + b1 u) w + (c0 + c1 u + c2 u^2) = 0
        ("b0", "f8"),  # line: w = c0 + c1 (u - b0)
        ("b1", "f8"),
        ("c0", "f8"),
        ("c1", "f8"),
        ("c2", "f8"),
    ],
    align=True,
)
"""A stretch of one surface on one row."""

PATCH = np.dtype(
    [
        ("flat", "i8"),  # 1 for a plane: k w = n . d, 0 for a quadric: a w^2 - 2 (q . d) w + d Q d = 0
        ("both", "i8"),  # whether its far side can be seen as well
        ("object", "i8"),
        ("geom", "i8"),
        ("first_row", "i8"),
        ("last_row", "i8"),
        ("ceiling", "f8"),  # bounds of its nearness [1/m]
        ("floor", "f8"),
        ("k", "f8"),
        ("a", "f8"),
        ("q", "f8", (3,)),  # q, or n
        ("form", "f8", (3, 3)),
        ("slabs", "i8"),  # how many: low <= axis . p <= high
        ("axes", "f8", (2, 3)),
        ("lows", "f8", (2,)),
        ("highs", "f8", (2,)),
        ("radius", "f8"),  # of a ball it lies in, or 0
        ("centre", "f8", (3,)),
    ],
    align=True,
)
"""A surface that is not a polygon, in the eye's frame (right, up, forward): its equation and its bounds."""

OCCLUDER = np.dtype(
    [
        ("planes", "f8", (5, 3)),  # unit normals: of the planes through the eye and its edges, inwards; its own, away from the eye
        ("offset", "f8"),  # the distance of its plane from the eye [m]
    ],
    align=True,
)
"""A face that hides what is behind it."""


class ExtentField(NamedTuple):
    """The description of one field of an extent."""

    name: str
    type: str
    title: str
    """The usual name, in a few words."""
    unit: str
    """Its unit; empty for a plain number."""
    about: str


EXTENT_FIELDS: Final = (
    ExtentField("row", "i4", "scan line", "", "which scan line, counted from 0 at the top"),
    ExtentField("label", "i4", "object", "", "a number that distinguishes objects, without meaning"),
    ExtentField("y", "f8", "height", "", "the position of the scan line on the screen: 0 at the top, 1 at the bottom"),
    ExtentField("x1", "f8", "left edge", "", "the position of its left edge on the screen: 0 at the left, 1 at the right"),
    ExtentField("x2", "f8", "right edge", "", "the position of its right edge on the screen: 0 at the left, 1 at the right"),
    ExtentField("d1", "f8", "left distance", "m", "the distance from the eye to its left edge"),
    ExtentField("d2", "f8", "right distance", "m", "the distance from the eye to its right edge"),
    ExtentField("a1", "f8", "left angle", "°", "the angle between the line of sight and the direction to its left edge"),
    ExtentField("a2", "f8", "right angle", "°", "the angle between the line of sight and the direction to its right edge"),
    ExtentField(
        "xn", "f8", "nearest point", "", "the position on the screen of its nearest point, as measured on the ground: 0 left, 1 right"
    ),
    ExtentField("dn", "f8", "nearest distance", "m", "the distance from the eye to that nearest point"),
)
"""The fields of an extent, in order; the page shows these texts with the columns."""

EXTENT = np.dtype([(field.name, field.type) for field in EXTENT_FIELDS], align=True)
"""A stretch of one row in which one object is seen."""

OPTICS = np.dtype(
    [
        ("rows", "i8"),
        ("right", "f8"),  # tangents of half the field of view
        ("top", "f8"),
        ("nearest", "f8"),  # the greatest nearness that is seen [1/m]
        ("corner", "f8"),  # the distance within which the near limit may cut something [m]
        ("range", "f8"),  # [m]
        ("precision", "f8"),
        ("e2", "f8"),  # of a retina [rad], or 0
    ],
    align=True,
)
"""The constants of an eye."""
