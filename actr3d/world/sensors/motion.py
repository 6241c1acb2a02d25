"""Pose and motion of a body: pose, velocity, accelerometer, gyroscope, joints, and what its hands hold.

Readings are of the present state: positions and speeds are those after the last physics step. Accelerations are those of the
coming physics step, contacts included; MuJoCo's own accelerometer would still report those of the step before.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, Literal

import mujoco
import numpy as np
from mujoco import mjtObj
from numpy.typing import NDArray

from actr3d.errors import WorldError
from actr3d.world.body import Body, sensor
from actr3d.world.frames import heading_of
from actr3d.world.joints import AT_LIMIT

Vector = tuple[float, float, float]


@dataclass(frozen=True, kw_only=True)
class Pose:
    """Position and orientation of a part in the world's frame: rotated first by heading, then pitch, then roll."""

    x: float
    """[m]"""
    y: float
    """[m]"""
    z: float
    """[m]"""
    heading: float
    """About the vertical [rad], 0 along x, left is positive."""
    pitch: float
    """[rad], forward and down is positive."""
    roll: float
    """[rad], to the right is positive."""


@dataclass(frozen=True, kw_only=True)
class Velocity:
    """Velocity of a part."""

    linear: Vector
    """Along x, y, z [m/s]."""
    angular: Vector
    """About x, y, z [rad/s]."""


@dataclass(frozen=True, kw_only=True)
class JointReading:
    """State of a joint."""

    position: float
    """[rad], of a slide [m]"""
    velocity: float
    """[rad/s], of a slide [m/s]"""
    limit: Literal["lower", "upper"] | None
    """The limit that it has reached."""


@sensor
def pose(body: Body, part: str | None = None) -> Pose:
    """Senses position [m] and orientation [rad] of a part; the base by default.

    Raises:
        WorldError: If it has no such part.
    """
    body.physics.refresh_positions()
    number = body.part_number(part)
    data: Any = body.physics.mj_data
    x, y, z = data.xpos[number].tolist()
    turn = data.xmat[number].reshape(3, 3)
    pitch = math.asin(max(-1.0, min(1.0, 0.0 - float(turn[2, 0]))))
    roll = math.atan2(turn[2, 1], turn[2, 2])
    return Pose(x=x, y=y, z=z, heading=heading_of(data.xmat[number]), pitch=pitch, roll=roll)


@sensor
def velocity(body: Body, part: str | None = None, frame: Literal["part", "world"] = "part") -> Velocity:
    """Senses the velocity of a part, by default the base, along its own axes or the world's [m/s] [rad/s].

    Raises:
        WorldError: If it has no such part, or the frame is neither.
    """
    if frame not in ("part", "world"):
        raise WorldError(f"velocity: frame must be 'part' or 'world' (got {frame!r})")
    body.physics.refresh_velocities()
    angular, linear = _velocity(body, body.part_number(part), local=frame == "part")
    return Velocity(linear=linear, angular=angular)


@sensor
def gyroscope(body: Body, part: str | None = None) -> Vector:
    """Senses the angular velocity of a part about its own axes [rad/s]: by default the head, or the base without a head.

    Raises:
        WorldError: If it has no such part.
    """
    body.physics.refresh_velocities()
    return _velocity(body, _head(body, part), local=True)[0]


@sensor
def accelerometer(body: Body, part: str | None = None) -> Vector:
    """Senses the proper acceleration of a part's origin (relative to free fall), along its own axes [m/s^2].

    The part is by default the head, or the base without a head. At rest the reading is about 9.81 upwards.

    Raises:
        WorldError: If it has no such part.
    """
    physics = body.physics
    physics.solve()
    mj_data = physics.mj_data
    solved = mj_data.qacc.copy()
    mj_data.qacc[:] = physics.accelerations()
    mujoco.mj_rnePostConstraint(physics.mj_model, mj_data)
    mj_data.qacc[:] = solved
    felt: NDArray[np.float64] = np.zeros(6)
    mujoco.mj_objectAcceleration(physics.mj_model, mj_data, mjtObj.mjOBJ_XBODY, _head(body, part), felt, 1)
    x, y, z = felt[3:].tolist()
    return (x, y, z)


@sensor
def joints(body: Body) -> dict[str, JointReading]:
    """Senses positions and velocities of all joints ([rad] [rad/s], of slides [m] [m/s]), and the limits that they have reached."""
    data = body.physics.mj_data
    positions, velocities = data.qpos.tolist(), data.qvel.tolist()
    readings: dict[str, JointReading] = {}
    for name, joint in body.joints.items():
        at = positions[joint.q]
        limit = "lower" if at <= joint.lower + AT_LIMIT else "upper" if at >= joint.upper - AT_LIMIT else None
        readings[name] = JointReading(position=at, velocity=velocities[joint.v], limit=limit)
    return readings


@sensor.if_body(lambda body: bool(body.hands))
def grasp(body: Body) -> dict[str, str | None]:
    """Senses what each hand holds: an object's name, or None."""
    model = body.physics.mj_model
    return {side: None if hand.held is None else str(model.body(hand.held.object).name) for side, hand in body.hands.items()}


def _velocity(body: Body, number: int, local: bool) -> tuple[Vector, Vector]:
    """Returns angular and linear velocity of a MuJoCo body; velocities must be up to date."""
    model, data = body.physics.mj_model, body.physics.mj_data
    moves: NDArray[np.float64] = np.zeros(6)
    mujoco.mj_objectVelocity(model, data, mjtObj.mjOBJ_XBODY, number, moves, int(local))
    a, b, c, x, y, z = moves.tolist()
    return (a, b, c), (x, y, z)


def _head(body: Body, part: str | None) -> int:
    return body.part_number("head" if part is None and "head" in body.parts else part)
