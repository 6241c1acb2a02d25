"""Orientations of frames in the world."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

import mujoco
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


def heading_in(quaternion: Sequence[float]) -> float:
    """Returns the direction of the x axis of an orientation (w, x, y, z) on the floor [rad], in -pi to pi."""
    w, x, y, z = quaternion
    return math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z))


def turn_to(quaternion: NDArray[np.float64], heading: float) -> None:
    """Turns an orientation (4,) about the vertical to a heading [rad], in place; the inclination stays the same."""
    by = np.array(yaw_quaternion(heading - heading_in(quaternion.tolist())))
    mujoco.mju_mulQuat(quaternion, by, quaternion.copy())


def wrapped(angle: float) -> float:
    """Returns the same direction in -pi to pi [rad]."""
    return math.remainder(angle, 2 * math.pi)


def yaw_quaternion(heading: float) -> tuple[float, float, float, float]:
    """Returns the quaternion (w, x, y, z) of a turn by `heading` [rad] about the vertical."""
    return (math.cos(heading / 2), 0.0, 0.0, math.sin(heading / 2))


def yaw_in(quaternion: Sequence[float]) -> float:
    """Returns by how much a quaternion (w, x, y, z) turns about the vertical, if it does nothing else [rad], in -2 pi to 2 pi."""
    w, _, _, z = quaternion
    return 2 * math.atan2(z, w)


def upright_axes(heading: float) -> NDArray[np.float64]:
    """Returns the axes (3, 3), as columns, of a frame rotated about the vertical to a heading [rad]."""
    c, s = math.cos(heading), math.sin(heading)
    return np.array((c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0)).reshape(3, 3)  # twice as fast as from nested lists


def upright_frame(data: Any, body: int) -> Frame:
    """Returns a frame at a MuJoCo body's origin, along its heading, with z up."""
    return (data.xpos[body], upright_axes(heading_of(data.xmat[body])))
