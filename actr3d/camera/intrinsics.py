"""Converts a camera's parameters to the form that compiled functions use."""

from __future__ import annotations

import math
from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from actr3d.camera.kernel.dtypes import OPTICS
from actr3d.camera.parameters import CameraParameters

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
