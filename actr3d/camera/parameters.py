"""The parameters of a camera, also in the form that compiled functions use."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cache
from typing import Annotated, Any

import numpy as np
from annotated_types import Ge, Gt, Le, Lt
from numpy.typing import NDArray

from actr3d.camera.kernel.dtypes import OPTICS
from actr3d.configuration import Configuration, InRadians
from actr3d.errors import ConfigurationError

Width = Annotated[float, Gt(0), Le(math.radians(179)), InRadians()]
"""A field of view; a flat screen of 180 degrees would be infinitely wide."""
RIGHT_ANGLE = math.pi / 2
SIXTY_DEGREES = math.pi / 3


@dataclass(frozen=True, kw_only=True)
class CameraParameters(Configuration):
    """The field of view, the scan lines and what is seen."""

    horizontal_fov: Width = RIGHT_ANGLE
    """The angle between the left and the right edge of the screen [rad]."""
    vertical_fov: Width = SIXTY_DEGREES
    """The angle between the top and the bottom of the screen [rad]."""
    rows: Annotated[int, Ge(1), Le(100_000)] = 100
    """The number of scan lines; each is sampled in its middle."""
    precision: Annotated[float, Ge(0), Lt(1)] = 1e-4
    """Gaps in one object that are narrower than this fraction of the screen's width are not reported. Edges are far more exact than
    this, and no object is too narrow to be reported."""
    near: Annotated[float, Ge(0)] = 0.0
    """Surfaces at a smaller depth than this are not seen [m along the line of sight]."""
    range: Annotated[float, Gt(0)] | None = None
    """Objects farther away than this are not seen [m]; None for no limit."""
    retinotopic: bool = False
    """Whether equal parts of the screen are equal parts of the visual cortex: rows and columns by visual angle, finest in the
    middle. Otherwise the screen is flat, like a photograph."""
    e2: Annotated[float, Gt(0)] = math.radians(0.75)
    """The eccentricity at which the retinotopic screen is half as fine as in the middle [rad].

    Source: Horton and Hoyt (1991), Archives of Ophthalmology 109: 17.3 mm / (E + 0.75 deg) of cortex for each degree.
    """
    own_limbs: bool = False
    """Whether the agent sees the parts of its own body, each as an object, or looks through them."""
    background: tuple[str, ...] | None = None
    """Names of geoms that hide others but are not reported; None for all planes."""
    groups: tuple[Annotated[int, Ge(0), Le(5)], ...] | None = None
    """The groups of geoms that are seen, from 0 to 5; None for all."""

    def __post_init__(self) -> None:
        """Checks all values.

        Raises:
            ConfigurationError: If a value is of a wrong type or out of bounds.
        """
        super().__post_init__()
        if self.range is not None and self.range <= self.near:
            raise ConfigurationError(f"CameraParameters.range: must be > near, {self.near:g} m (got {self.range!r})")


NEAREST = 1e-9
"""The minimum depth at which a surface is drawn [m]."""


@cache
def optics_of(parameters: CameraParameters) -> NDArray[Any]:
    """Returns the parameters as the constants of an eye for the compiled functions, an array of length 1."""
    optics = np.zeros(1, OPTICS)
    right, top = math.tan(parameters.horizontal_fov / 2), math.tan(parameters.vertical_fov / 2)
    near = max(parameters.near, NEAREST)
    optics["rows"], optics["right"], optics["top"] = parameters.rows, right, top
    optics["nearest"], optics["corner"] = 1 / near, near * math.sqrt(1 + right**2 + top**2)
    optics["range"] = math.inf if parameters.range is None else parameters.range
    optics["precision"] = parameters.precision
    optics["e2"] = parameters.e2 if parameters.retinotopic else 0
    optics.flags.writeable = False
    return optics
