"""Compiled functions for what is measured in every physics step."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache
from pathlib import Path

from actr3d.jit import kept
from actr3d.world.kernel import Array


@cache
def posture() -> Callable[..., tuple[float, float, float]]:
    """Returns the function that measures a body before a wall.

    Its arguments are: the position of the body's axis (3,), of its left and its right shoulder (3,) [m]; the positions and speeds of all
    joints; (n, 2) the indices in these of the joints that turn the shoulders, and (n,) their shares; the middle of the wall x, y [m], and
    the direction through it x, y; and the time by which the joints are ahead of the positions [s]. It returns the distance of the
    axis before the wall [m], the angle between shoulder line and wall [rad], and the angle of the joints [rad].
    """
    return kept(_posture, Path(__file__))


def _posture(
    axis: Array,
    left: Array,
    right: Array,
    qpos: Array,
    qvel: Array,
    joints: Array,
    shares: Array,
    wall_x: float,
    wall_y: float,
    ahead_x: float,
    ahead_y: float,
    ago: float,
) -> tuple[float, float, float]:
    before = (wall_x - axis[0]) * ahead_x + (wall_y - axis[1]) * ahead_y
    dx, dy = left[0] - right[0], left[1] - right[1]
    angle = math.atan2(abs(dx * ahead_x + dy * ahead_y), abs(dy * ahead_x - dx * ahead_y))
    turned = 0.0
    for row in range(len(shares)):
        # The integrator has moved the joints on from the positions, with these speeds.
        turned += shares[row] * (qpos[joints[row, 0]] - ago * qvel[joints[row, 1]])
    return before, angle, turned


@cache
def least_distances() -> Callable[[Array, Array, Array, Array, Array, Array, Array], None]:
    """Returns the function that computes lower bounds of the distances of some geoms from a box [m].

    Its arguments are: the geoms (n,), the positions of all geoms and the radii of the balls around them; the position (3,), rotation (9,)
    and size (3,) of the box; and room for the results (n,).
    """
    return kept(_least_distances, Path(__file__))


def _least_distances(geoms: Array, positions: Array, radii: Array, at: Array, rotation: Array, size: Array, distances: Array) -> None:
    for number, geom in enumerate(geoms):
        x, y, z = positions[geom, 0] - at[0], positions[geom, 1] - at[1], positions[geom, 2] - at[2]
        squares = 0.0
        for axis in range(3):
            beyond = abs(x * rotation[axis] + y * rotation[3 + axis] + z * rotation[6 + axis]) - size[axis]
            if beyond > 0:
                squares += beyond * beyond
        distances[number] = math.sqrt(squares) - radii[geom]
