"""Compiled functions for what is measured in every physics step."""

from __future__ import annotations

import math
from pathlib import Path

import actr3d.world.kernel
from actr3d.jit import compiled_on_demand
from actr3d.world.kernel import BOX, SPHERE, Array, extent

END, DURATION, BEFORE, ANGLE, LOGGED, TURNED, ENTERED, LEFT, RIGHT = range(9)
"""The columns of a table of samples, see `Passage`."""
COLUMNS = RIGHT + 1
NOT_YET, AGAIN, FAR, NEAR = range(4)
"""What `take_sample` returns: the body has not set out yet; the table has a sample of this time or later, because the run has gone back; or
it has written a sample of a body that is far from the wall, or near it."""

SET_OUT = 0.05
"""Distance from the start after which a body has set out [m]. Source: chosen for this library."""
STANDS = 0.01
"""Speed below which a body stands [m/s]. Source: chosen for this library; less than any walk."""
TINY = 1e-9
"""Less than any physics step [s]."""


@compiled_on_demand(Path(__file__))
def take_sample(
    table: Array,
    row: int,
    end: float,
    ago: float,
    start: Array,
    slide: int,
    reach: float,
    axis: Array,
    left: Array,
    right: Array,
    qpos: Array,
    qvel: Array,
    joints: Array,
    shares: Array,
    gait: Array,
    gait_shares: Array,
    wall_x: float,
    wall_y: float,
    ahead_x: float,
    ahead_y: float,
) -> int:
    """Measures a body before a wall, once it has set out, and writes a row of samples, with NaN as LEFT and RIGHT.

    Its arguments:

    - table (n, COLUMNS), row: the samples, and the number of the one that is written;
    - end, ago: the time of the joints, and by how much they are ahead of the positions [s];
    - start (2,), slide: where the body starts [m], changed if it was put elsewhere and stands; the index of its base's speed in qvel;
    - reach: the distance of the axis from the wall within which the body is near [m];
    - axis, left, right (3,): the positions of the body's axis and of its shoulders [m];
    - qpos, qvel: the positions and speeds of all joints;
    - joints (k, 2), shares (k,): the indices in these of the joints that turn the shoulders, and by how much each of them turns them;
    - gait (m,), gait_shares (m,): what gait adds to joints, and by how much each of these turns the shoulders;
    - wall_x, wall_y, ahead_x, ahead_y: the middle of the wall [m], and the direction through it.

    It returns one of `NOT_YET`, `AGAIN`, `FAR` and `NEAR`.
    """
    if row and end <= table[row - 1, END] + TINY:
        return AGAIN
    if math.hypot(axis[0] - start[0], axis[1] - start[1]) < SET_OUT:
        return NOT_YET
    if not row and math.hypot(qvel[slide], qvel[slide + 1]) < STANDS:
        start[0], start[1] = axis[0], axis[1]
        return NOT_YET
    before = (wall_x - axis[0]) * ahead_x + (wall_y - axis[1]) * ahead_y
    dx, dy = left[0] - right[0], left[1] - right[1]
    angle = 0.0
    for joint in range(len(shares)):
        # The integrator has moved the joints on from the positions, with these speeds.
        angle += shares[joint] * (qpos[joints[joint, 0]] - ago * qvel[joints[joint, 1]])
    turned = angle
    for joint in range(len(gait)):
        turned -= gait_shares[joint] * gait[joint]
    table[row, END], table[row, DURATION], table[row, BEFORE] = end, ago, before
    table[row, ANGLE] = math.atan2(abs(dx * ahead_x + dy * ahead_y), abs(dy * ahead_x - dx * ahead_y))
    table[row, LOGGED], table[row, TURNED] = angle, turned
    table[row, ENTERED] = table[row - 1, ENTERED] if row else 0.0
    table[row, LEFT] = table[row, RIGHT] = math.nan
    return NEAR if abs(before) < reach else FAR


@compiled_on_demand(Path(__file__), Path(actr3d.world.kernel.__file__))
def least_distances(
    geoms: Array,
    types: Array,
    sizes: Array,
    positions: Array,
    rotations: Array,
    radii: Array,
    at: Array,
    rotation: Array,
    size: Array,
    ordered: Array,
    bounds: Array,
) -> None:
    """Computes lower bounds of the distances of some geoms from a box [m], and puts the geoms in their order.

    Its arguments are: the geoms (n,); the types, sizes, positions and rotations of all geoms as in MuJoCo, and the radii of the balls
    around them; the position (3,), rotation (9,) and size (3,) of the box; and room for the ordered geoms (n,) and their bounds (n,).
    """
    for number, geom in enumerate(geoms):
        x, y, z = positions[geom, 0] - at[0], positions[geom, 1] - at[1], positions[geom, 2] - at[2]
        squares, bound = 0.0, -math.inf
        for axis in range(3):
            u, v, w = rotation[axis], rotation[3 + axis], rotation[6 + axis]
            beyond = abs(x * u + y * v + z * w) - size[axis]
            if beyond > 0:
                squares += beyond * beyond
            if SPHERE <= types[geom] <= BOX:  # these have an extent along the axis
                bound = max(bound, beyond - extent(geom, types, sizes, rotations, u, v, w))
        bound = max(bound, math.sqrt(squares) - radii[geom])
        place = number
        while place > 0 and bounds[place - 1] > bound:
            bounds[place], ordered[place] = bounds[place - 1], ordered[place - 1]
            place -= 1
        bounds[place], ordered[place] = bound, geom
