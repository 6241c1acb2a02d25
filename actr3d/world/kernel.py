"""Compiled functions for what is computed of a body in every tick, or in every physics step."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any, TypeAlias

from mujoco import mjtGeom
from numpy.typing import NDArray

from actr3d.jit import compiled_on_demand, inner_compiled

Array: TypeAlias = NDArray[Any]

SPHERE, CAPSULE, ELLIPSOID = int(mjtGeom.mjGEOM_SPHERE), int(mjtGeom.mjGEOM_CAPSULE), int(mjtGeom.mjGEOM_ELLIPSOID)
CYLINDER, BOX = int(mjtGeom.mjGEOM_CYLINDER), int(mjtGeom.mjGEOM_BOX)


@inner_compiled
def extent(geom: Any, types: Array, sizes: Array, rotations: Array, u: float, v: float, w: float) -> float:
    """Returns the extent of a geom from its centre along a direction (u, v, w) [m], given the types, sizes and rotations of all geoms."""
    kind, x, y, z = types[geom], sizes[geom, 0], sizes[geom, 1], sizes[geom, 2]
    # The direction in the geom's frame.
    a = abs(rotations[geom, 0] * u + rotations[geom, 3] * v + rotations[geom, 6] * w)
    b = abs(rotations[geom, 1] * u + rotations[geom, 4] * v + rotations[geom, 7] * w)
    c = abs(rotations[geom, 2] * u + rotations[geom, 5] * v + rotations[geom, 8] * w)
    if kind == SPHERE:
        return x
    if kind == CAPSULE:
        return x + y * c
    if kind == ELLIPSOID:
        return math.sqrt((x * a) ** 2 + (y * b) ** 2 + (z * c) ** 2)
    if kind == CYLINDER:
        return x * math.sqrt(a * a + b * b) + y * c
    return x * a + y * b + z * c


@compiled_on_demand(Path(__file__))
def extend_box(
    geoms: Array, types: Array, sizes: Array, positions: Array, rotations: Array, origin: Array, axes: Array, box: Array
) -> None:
    """Widens a box until it encloses some geoms.

    Its arguments are: the geoms (n,), the types (ngeom,), sizes, positions and rotations of all geoms as in MuJoCo, the frame's origin
    (3,) and axes (3, 3) as columns, and the box (2, 3), least and greatest coordinates in that frame [m].
    """
    for geom in geoms:
        for axis in range(3):
            u, v, w = axes[0, axis], axes[1, axis], axes[2, axis]
            far = extent(geom, types, sizes, rotations, u, v, w)
            at = (positions[geom, 0] - origin[0]) * u + (positions[geom, 1] - origin[1]) * v + (positions[geom, 2] - origin[2]) * w
            box[0, axis] = min(box[0, axis], at - far)
            box[1, axis] = max(box[1, axis], at + far)


@compiled_on_demand(Path(__file__))
def any_within_distance(geoms: Array, boxes: Array, positions: Array, rotations: Array, point: Array, distance: float) -> bool:
    """Checks whether the box of any of some geoms is within a distance of a point.

    Its arguments are: the geoms (n,), the boxes of all geoms as in MuJoCo (`geom_aabb`), their positions and rotations, the point (3,),
    and the distance [m].
    """
    for geom in geoms:
        x, y, z = point[0] - positions[geom, 0], point[1] - positions[geom, 1], point[2] - positions[geom, 2]
        gap = 0.0
        for axis in range(3):
            at = rotations[geom, axis] * x + rotations[geom, 3 + axis] * y + rotations[geom, 6 + axis] * z
            beyond = abs(at - boxes[geom, axis]) - boxes[geom, 3 + axis]
            if beyond > 0:
                gap += beyond * beyond
        if gap < distance * distance:
            return True
    return False


@compiled_on_demand(Path(__file__))
def fastest(reaches: Array, speeds: Array, together: Array, held: float) -> float:
    """Computes an upper bound of the speed of any point of some bodies [m/s].

    Its arguments are: by moving part and degree of freedom (n, nv) the greatest way of its farthest point per unit [m]; the speeds (nv,);
    by degree of freedom (nv,), how many consecutive ones, from it on, form one velocity vector: 1 for a single one, 0 for later members;
    and the extent of held objects beyond the hands [m].
    """
    most = 0.0
    for part in range(reaches.shape[0]):
        farthest = 0.0
        for v in range(reaches.shape[1]):
            if together[v] == 1:
                farthest += (reaches[part, v] + held) * abs(speeds[v])
            elif together[v] > 1:
                squares = 0.0
                for other in range(v, v + together[v]):
                    squares += speeds[other] * speeds[other]
                farthest += (reaches[part, v] + held) * math.sqrt(squares)
        if not farthest <= most:  # NaN is not
            most = farthest
    return most


@compiled_on_demand(Path(__file__))
def compute_deviations(
    q: Array,
    v: Array,
    c: Array,
    qpos: Array,
    qvel: Array,
    ctrl: Array,
    base: int,
    cosine: float,
    sine: float,
    held: Array,
    commanded: Array,
    lower: Array,
    upper: Array,
    duration: float,
    slight_way: float,
    slight_speed: float,
    results: Array,
) -> bool:
    """Compares degrees of freedom (n,) with what is commanded, and returns whether any needs a correction.

    Its arguments are: their indices in `qpos`, `qvel` and `ctrl`; these three; the number of rows of the base, and cosine and sine of
    its heading; the places to hold, NaN for what moves; the commanded speeds; the lower and upper limits; the duration of a tick, or 0 if
    no joint moves [s]; the slight deviations of place and speed; and an array (3, n) for the results, see `ActuatedDofs.deviations`.
    """
    ways, off, wanted = results[0], results[1], results[2]
    found = False
    for row in range(len(q)):
        speed, keep = qvel[v[row]], commanded[row]
        if base and row == 0:
            speed = cosine * speed + sine * qvel[v[1]]
        elif base and row == 1:
            speed = cosine * speed - sine * qvel[v[0]]
        if duration > 0:
            keep = min(max(keep, (lower[row] - qpos[q[row]]) / duration), (upper[row] - qpos[q[row]]) / duration)
        ways[row] = held[row] - qpos[q[row]]
        off[row] = speed - ctrl[c[row]]
        wanted[row] = keep
        if keep != commanded[row] or abs(ways[row]) > slight_way or abs(off[row]) > slight_speed:  # NaN is no deviation
            found = True
    return found


@compiled_on_demand(Path(__file__))
def apply_corrections(
    v: Array,
    c: Array,
    qvel: Array,
    ctrl: Array,
    base: int,
    cosine: float,
    sine: float,
    ways: Array,
    wanted: Array,
    time: float,
    most: float,
    slight_speed: float,
    servos_only: Array,
) -> None:
    """Sets speeds and controls of degrees of freedom (n,) so that they return to what is commanded.

    Its arguments are: their indices in `qvel` and `ctrl`; these two; the number of rows of the base, and cosine and sine of its heading;
    the ways back, along the world's axes, NaN for what moves; the speeds to keep of what moves; the time constant [s] and the greatest
    speed of corrections; the difference from which a speed is set at once; and those which only their servos change.
    """
    n = len(v)
    for row in range(n):
        if not math.isnan(ways[row]):
            ways[row] = min(max(ways[row] / time, -most), most)
    if base:
        x, y = ways[0], ways[1]
        ways[0], ways[1] = cosine * x + sine * y, cosine * y - sine * x
    for row in range(n):
        if math.isfinite(ways[row]):
            wanted[row] = ways[row]
        ctrl[c[row]] = wanted[row]
    together = False
    if base:
        x, y = qvel[v[0]], qvel[v[1]]
        forward, left = cosine * x + sine * y, cosine * y - sine * x
        together = abs(wanted[0] - forward) > slight_speed or abs(wanted[1] - left) > slight_speed
        for row in range(2, base):
            together = together or abs(wanted[row] - qvel[v[row]]) > slight_speed
    for row in range(n):
        wrong = together if row < base else abs(wanted[row] - qvel[v[row]]) > slight_speed
        if wrong and not servos_only[row]:
            if base and row == 0:
                qvel[v[0]] = cosine * wanted[0] - sine * wanted[1]
            elif base and row == 1:
                qvel[v[1]] = cosine * wanted[1] + sine * wanted[0]
            else:
                qvel[v[row]] = wanted[row]


ROLES = {"thigh_yaw": 1, "thigh_pitch": 2, "thigh_roll": 3, "upper_arm_pitch": 4, "stance_sway": 5}
"""How the pattern of a stride becomes the movement of a joint; the pattern itself for all others, role 0."""


@compiled_on_demand(Path(__file__))
def stride_changes(
    pattern: Array,
    phase: float,
    wander: float,
    size: float,
    turn: float,
    aside: float,
    arms: float,
    columns: Array,
    roles: Array,
    rows: Array,
    held: Array,
    fastest: Array,
    duration: float,
    added: Array,
    changes: Array,
) -> float:
    """Computes by how much gait moves its joints in a tick.

    Its arguments are: the pattern of a stride (phases, columns) [rad] [m] and its phase, from 0 to 1; how far the body is to the left [m];
    the size of the movements, 0 to 1; the angle by which the thighs turn towards the walking direction, and the angle of their swing
    relative to that [rad]; the factor of the arms' swing, 0 to 1; (n,) the joints' columns; the role of each column; (n,) the joints' rows;
    the places held in each row, NaN where another command moves it; (n,) the greatest speed of each joint, and the duration of the tick
    [s]; (n,) what was added to each joint's place before, which becomes 0 where another command moves it; and room for the changes (n,). It
    returns the greatest wanted change.
    """
    phases = len(pattern)
    at = phase * phases
    first, part = int(at) % phases, at - math.floor(at)
    following = (first + 1) % phases
    cosine, sine = math.cos(aside), math.sin(aside)
    greatest = 0.0
    for number, column in enumerate(columns):
        role = roles[column]
        source = column - 1 if role == 3 else column
        wanted = (1 - part) * pattern[first, source] + part * pattern[following, source]
        if role == 5:
            wanted += wander
        wanted *= size
        if role == 1:
            wanted = turn
        elif role == 2:
            wanted = -wanted * cosine
        elif role == 3:
            wanted *= sine
        elif role == 4:
            wanted *= arms
        if math.isnan(held[rows[number]]):
            added[number] = changes[number] = 0.0
        else:
            change = wanted - added[number]
            greatest = max(greatest, abs(change))
            most = fastest[number] * duration
            changes[number] = min(max(change, -most), most)
    return greatest


@compiled_on_demand(Path(__file__))
def shift_held(
    rows: Array,
    changes: Array,
    moves: bool,
    q: Array,
    c: Array,
    qpos: Array,
    ctrl: Array,
    held: Array,
    commanded: Array,
    loose: Array,
    duration: float,
) -> bool:
    """Shifts held places, and commands the speeds that reach them; see `ActuatedDofs.shift_held`."""
    changed = moves
    for number, row in enumerate(rows):
        if math.isnan(held[row]):
            continue
        if moves:
            held[row] += changes[number]
            commanded[row] = (held[row] - qpos[q[row]]) / duration
            loose[row] = math.nan
        elif commanded[row] != 0:
            commanded[row] = 0.0
            changed = True
    if changed:
        for row in rows:
            if not math.isnan(held[row]):
                ctrl[c[row]] = commanded[row]
    return changed
