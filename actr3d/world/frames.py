"""Orientations of frames in the world."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

Frame = tuple[NDArray[np.float64], NDArray[np.float64]]
"""The origin (3,) [m] and the axes as columns (3, 3), both in the world's frame: a vector v of the world is `v @ axes` in this frame."""

FULL_TURN = 6.2832
"""A full turn [rad], rounded up. Where angles are limited to it, a greater one is most likely meant in degrees."""

WORLD_FRAME: Frame = (np.zeros(3), np.eye(3))


def heading_of(matrix: NDArray[np.float64]) -> float:
    """Returns the direction of the x axis of a rotation matrix (9,) on the floor [rad], in -pi to pi."""
    return math.atan2(matrix.item(3), matrix.item(0))


def upright_axes(heading: float) -> NDArray[np.float64]:
    """Returns the axes (3, 3), as columns, of a frame rotated about the vertical to a heading [rad]."""
    c, s = math.cos(heading), math.sin(heading)
    return np.array((c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0)).reshape(3, 3)  # twice as fast as from nested lists


def upright_frame(data: Any, body: int) -> Frame:
    """Returns a frame at a MuJoCo body's origin, along its heading, with z up."""
    return (data.xpos[body], upright_axes(heading_of(data.xmat[body])))
