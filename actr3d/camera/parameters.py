"""What may be set of a camera."""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from numbers import Integral, Real
from typing import Any, cast

from actr3d.errors import ParameterError

WIDEST = math.radians(179)
"""A flat screen of 180 degrees would be endless."""
MOST_ROWS = 100_000


@dataclass(frozen=True, kw_only=True)
class CameraParameters:
    """The field of view, the scan lines and what is seen.

    Raises:
        ParameterError: If a value is of a wrong type or out of bounds.
    """

    horizontal_fov: float = math.radians(90)
    """The angle between the left and the right edge of the screen [rad]."""
    vertical_fov: float = math.radians(60)
    """The angle between its top and its bottom [rad]."""
    rows: int = 100
    """How many scan lines; each is looked at in its middle."""
    precision: float = 1e-4
    """Gaps in one object that are narrower than this part of the screen's width are not told. Edges are exact to far less, and
    things are never too narrow to be told."""
    near: float = 0.0
    """Surfaces less deep than this are not seen [m along the line of sight]."""
    range: float = math.inf
    """What is farther away than this is not seen [m]."""
    retinotopic: bool = False
    """Whether equal parts of the screen are equal parts of the visual cortex: rows and columns by visual angle, fine in the
    middle. Otherwise the screen is flat, as a photograph is."""
    e2: float = math.radians(0.75)
    """The eccentricity at which the retinotopic screen is half as fine as in the middle [rad].

    Source: Horton and Hoyt (1991), Archives of Ophthalmology 109: 17.3 mm / (E + 0.75 deg) of cortex for each degree.
    """
    own_limbs: bool = False
    """Whether the agent sees the parts of its own body, each an object, or looks through them."""
    background: tuple[str, ...] | None = None
    """Names of geoms that hide others but are not told themselves; None: all planes."""
    groups: tuple[int, ...] | None = None
    """The groups of geoms that are seen, from 0 to 5; None: all."""

    def __post_init__(self) -> None:
        """Checks all values."""
        for field in fields(self):
            value: Any = getattr(self, field.name)
            if field.type in ("float", "int"):
                self._require(field.name, isinstance(value, Real) and not _truth(value), "a number")
            elif field.type == "bool":
                self._require(field.name, _truth(value), "True or False")
            elif value is not None:
                kind = str if field.name == "background" else int
                right = isinstance(value, tuple) and all(isinstance(one, kind) for one in cast("tuple[Any, ...]", value))
                self._require(field.name, right, f"None or a tuple of {'names of geoms' if kind is str else 'numbers from 0 to 5'}")
        for name in ("horizontal_fov", "vertical_fov"):
            self._require(name, 0 < getattr(self, name) <= WIDEST, f"an angle above 0 and up to {WIDEST:.4f} rad (179 degrees)")
        self._require("rows", isinstance(self.rows, Integral) and 1 <= self.rows <= MOST_ROWS, f"a whole number from 1 to {MOST_ROWS}")
        self._require("precision", 0 <= self.precision < 1, "a part of the screen, at least 0 and below 1")
        self._require("near", 0 <= self.near < math.inf, "a depth in metres, at least 0")
        self._require("range", self.range > self.near, f"a distance in metres above near ({self.near:g})")
        self._require("e2", 0 < self.e2 < math.inf, "an angle above 0 rad")
        self._require("groups", all(0 <= group <= 5 for group in self.groups or ()), "None or a tuple of numbers from 0 to 5")

    def _require(self, name: str, right: bool, what: str) -> None:
        if not right:
            raise ParameterError(f"CameraParameters.{name}: must be {what} (got {getattr(self, name)!r})")


def _truth(value: Any) -> bool:
    return isinstance(value, bool)
