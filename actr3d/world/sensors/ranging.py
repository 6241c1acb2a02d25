"""Distances: rangefinder, laser scan, proximity. Rays pass through the body's own parts and what it holds."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import mujoco
import numpy as np
from mujoco import mjtGeom
from numpy.typing import NDArray

from actr3d.world.body import Body, sensor
from actr3d.world.command_registry import checked_angle, checked_number, checked_whole

BEYOND = 1e-6
"""Distance behind a hit on the body itself at which a ray continues [m]."""


@dataclass(frozen=True, kw_only=True)
class Proximity:
    """The nearest thing."""

    distance: float
    """Between the two surfaces [m]; negative where they press into each other."""
    part: str
    """The part of the body that is nearest to it."""
    other: str
    """The name of the other object."""


@sensor
def rangefinder(body: Body, angle: float = 0.0, elevation: float = 0.0, reach: float = 10.0, at: str | None = None) -> float | None:
    """Senses the distance to the first surface in one direction [m]; None if nothing is within reach.

    Args:
        body: The body.
        angle: Of the direction, to the left of straight ahead [rad].
        elevation: Of the direction, above straight ahead [rad].
        reach: Range [m].
        at: The part, site or frame of the sensor, whose x axis points ahead; by default the eye, or the base without an eye.

    Raises:
        WorldError: If a value is not a number, an angle is more than a full turn, the reach is negative, or there is no such frame.
    """
    angle, elevation = checked_angle(angle, "rangefinder: angle"), checked_angle(elevation, "rangefinder: elevation")
    return _cast(body, at, np.array([angle]), elevation, checked_number(reach, "rangefinder: reach", 0))[0]


@sensor
def laser(
    body: Body, rays: int = 181, fov: float = math.pi, elevation: float = 0.0, reach: float = 10.0, at: str | None = None
) -> tuple[float | None, ...]:
    """Senses distances [m] in a fan of rays from left to right, over the angle `fov` [rad]; None where nothing is within reach.

    The other arguments are those of the rangefinder.

    Raises:
        WorldError: If `rays` is not a whole number in 1 to 100,000, `fov` not in 0 to 2 pi, or as for the rangefinder.
    """
    count = checked_whole(rays, "laser: rays", 1, 100_000)
    half = checked_number(fov, "laser: fov", 0, 2 * math.pi) / 2
    angles = np.linspace(half, -half, count) if count > 1 else np.zeros(1)
    return _cast(body, at, angles, checked_angle(elevation, "laser: elevation"), checked_number(reach, "laser: reach", 0))


@sensor
def proximity(body: Body, reach: float = 1.0) -> Proximity | None:
    """Senses what is nearest to the skin, on any side within reach [m]; the ground does not count.

    Raises:
        WorldError: If the reach is not a number from 0 on.
    """
    reach = checked_number(reach, "proximity: reach", 0)
    body.physics.refresh_positions()
    model, data = body.physics.mj_model, body.physics.mj_data
    nearest, found = reach, None
    for bound, mine, other in _candidates(body, reach):
        if bound > nearest:
            break
        distance = float(mujoco.mj_geomDistance(model, data, mine, other, reach, None))
        if distance < nearest:
            nearest, found = distance, (mine, other)
    if found is None:
        return None
    return Proximity(distance=nearest, part=body.geom_name(found[0]), other=body.physics.owners[found[1]])


def _candidates(body: Body, reach: float) -> list[tuple[float, int, int]]:
    """Returns pairs of own and other geoms, the nearest first: (lower bound of their distance, own, other)."""
    model, data = body.physics.mj_model, body.physics.mj_data
    mine = body.touch_geoms
    ground = (model.geom_type == int(mjtGeom.mjGEOM_PLANE)) | (model.geom_type == int(mjtGeom.mjGEOM_HFIELD))
    others = np.flatnonzero(body.physics.solid & ~ground & ~body.contacts.own_geoms())
    between = np.linalg.norm(data.geom_xpos[mine][:, None] - data.geom_xpos[others][None], axis=2)
    bounds = between - model.geom_rbound[mine][:, None] - model.geom_rbound[others][None]
    near = np.argwhere(bounds < reach)
    return sorted((float(bounds[i, j]), int(mine[i]), int(others[j])) for i, j in near.tolist())


def _cast(body: Body, at: str | None, angles: NDArray[np.float64], elevation: float, reach: float) -> tuple[float | None, ...]:
    """Returns the lengths of rays, None beyond reach."""
    body.physics.refresh_positions()
    name = at if at is not None else body.eye if body.eye is not None else body.anatomy.base
    origin, axes = body.frame(name)
    flat, up = math.cos(elevation), np.full(len(angles), math.sin(elevation))
    ways = np.stack([flat * np.cos(angles), flat * np.sin(angles), up], axis=1) @ axes.T
    model, data = body.physics.mj_model, body.physics.mj_data
    hit: NDArray[np.int32] = np.full(len(ways), -1, dtype=np.int32)
    far: NDArray[np.float64] = np.zeros(len(ways))
    mujoco.mj_multiRay(model, data, origin, ways.ravel(), None, 1, -1, hit, far, None, len(ways), reach)
    own = body.contacts.own_geoms()
    for ray in np.flatnonzero((hit >= 0) & own[hit]).tolist():
        far[ray] = _past(model, data, origin, ways[ray], own, float(far[ray]))
    return tuple(distance if 0 <= distance <= reach else None for distance in far.tolist())


def _past(model: Any, data: Any, origin: NDArray[np.float64], way: NDArray[np.float64], own: NDArray[np.bool_], gone: float) -> float:
    """Returns the length of a ray that has hit the body itself after `gone` [m]; -1 without end."""
    hit: NDArray[np.int32] = np.zeros(1, dtype=np.int32)
    while True:
        gone += BEYOND
        more = mujoco.mj_ray(model, data, origin + gone * way, way, None, 1, -1, hit)
        if more < 0:
            return -1.0
        gone += float(more)
        if not own[hit[0]]:
            return gone
