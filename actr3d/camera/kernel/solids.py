"""Converts planes and round geoms to patches in the eye's frame."""

from __future__ import annotations

import math

from actr3d.camera.kernel.dtypes import CAPSULE, CYLINDER, ELLIPSOID, PLANE, Array, Record, Records
from actr3d.camera.kernel.screen import set_rows
from actr3d.jit import inner_compiled


@inner_compiled
def reach_of(kind: int, size: Array) -> float:
    """Returns the radius of the bounding ball of a geom about its centre [m], infinite for endless planes.

    Args:
        kind: The geom's type: not a mesh, nor a height field.
        size: Its size as in MuJoCo [m].
    """
    if kind == PLANE:
        return math.hypot(size[0], size[1]) if size[0] > 0.0 and size[1] > 0.0 else math.inf
    if kind == CYLINDER:
        return math.hypot(size[0], size[1])
    if kind == CAPSULE:
        return size[0] + size[1]
    if kind == ELLIPSOID:
        return max(size[0], size[1], size[2])
    return size[0]


@inner_compiled
def add_patches(kind: int, size: Array, place: Array, turn: Array, both: bool, optics: Record, patches: Records, count: int) -> int:
    """Appends the patches of one geom; returns the new number of patches.

    Args:
        kind: The geom's type.
        size: The geom's size, as in MuJoCo [m].
        place: Its centre in the eye's frame [m].
        turn: Its axes in the eye's frame, as columns.
        both: Whether its far sides can be seen.
        optics: The constants of the eye.
        patches: The output array; the caller sets `object` and `geom`.
        count: The number of patches already written.
    """
    start = count
    if kind == PLANE:
        count = _add_plane(size, place, turn, optics, patches, count)
    elif kind in (CYLINDER, CAPSULE):
        count = _add_tube(kind, size, place, turn, both, optics, patches, count)
    else:
        x, y, z = (size[0], size[1], size[2]) if kind == ELLIPSOID else (size[0], size[0], size[0])
        _set_quadric(patches[count], place, turn, x, y, z)
        yy, yz, zz = 0.0, 0.0, 0.0
        for i in range(3):
            half = x if i == 0 else y if i == 1 else z
            yy += half * half * turn[1, i] * turn[1, i]
            yz += half * half * turn[1, i] * turn[2, i]
            zz += half * half * turn[2, i] * turn[2, i]
        set_rows(patches[count], place, yy, yz, zz, optics, False)
        count += 1
    for i in range(start, count):
        patches[i].both = both and not patches[i].flat
    return count


@inner_compiled
def _along(turn: Array, place: Array) -> float:
    """Returns the coordinate of a position along a geom's third axis [m]."""
    return turn[0, 2] * place[0] + turn[1, 2] * place[1] + turn[2, 2] * place[2]


@inner_compiled
def _set_quadric(patch: Record, place: Array, turn: Array, x: float, y: float, z: float) -> None:
    """Sets a patch to an ellipsoid with the given half axes (infinite for a tube): (p - c) Q (p - c) = 1, where c is its centre."""
    patch.flat, patch.slabs, patch.radius = 0, 0, 0.0
    a = -1.0
    for i in range(3):
        for j in range(i, 3):
            form = turn[i, 0] * turn[j, 0] / (x * x) + turn[i, 1] * turn[j, 1] / (y * y) + turn[i, 2] * turn[j, 2] / (z * z)
            patch.form[i, j] = patch.form[j, i] = form
    for i in range(3):
        row = 0.0
        for j in range(3):
            row += patch.form[i, j] * place[j]
        patch.q[i] = row
        a += row * place[i]
    patch.a = a


@inner_compiled
def _set_flat(patch: Record, place: Array, turn: Array) -> None:
    """Sets a patch to a plane through a position, normal to a geom's third axis."""
    patch.flat, patch.slabs, patch.radius = 1, 0, 0.0
    for i in range(3):
        patch.q[i] = turn[i, 2]
    patch.k = _along(turn, place)


@inner_compiled
def _add_slab(patch: Record, turn: Array, axis: int, low: float, high: float) -> None:
    """Bounds a patch by two planes normal to an axis of its geom."""
    number = patch.slabs
    for i in range(3):
        patch.axes[number, i] = turn[i, axis]
    patch.lows[number], patch.highs[number] = low, high
    patch.slabs = number + 1


@inner_compiled
def _add_plane(size: Array, place: Array, turn: Array, optics: Record, patches: Records, count: int) -> int:
    """Appends a plane, which is seen from its front only."""
    patch = patches[count]
    _set_flat(patch, place, turn)
    if not patch.k < 0.0:
        return count
    for i in range(2):
        if size[i] > 0.0:
            middle = turn[0, i] * place[0] + turn[1, i] * place[1] + turn[2, i] * place[2]
            _add_slab(patch, turn, i, middle - size[i], middle + size[i])
    reach = reach_of(PLANE, size)
    set_rows(patch, place, reach * reach, 0.0, reach * reach, optics, False)
    return count + 1


@inner_compiled
def _add_tube(kind: int, size: Array, place: Array, turn: Array, both: bool, optics: Record, patches: Records, count: int) -> int:
    """Appends the side of a cylinder or capsule, and its two ends: discs, if they can be seen, or hemispheres."""
    middle, side, radius = _along(turn, place), patches[count], size[0]
    _set_quadric(side, place, turn, radius, radius, math.inf)
    _add_slab(side, turn, 2, middle - size[1], middle + size[1])
    square, y, z = radius * radius, turn[1, 2], turn[2, 2]
    yy, yz, zz = square, 0.0, square
    if kind == CYLINDER:
        yy, yz, zz = square * (1.0 - y * y), -square * y * z, square * (1.0 - z * z)
    count += 1
    for i in range(2):
        sign = 2.0 * i - 1.0
        end, patch = middle + sign * size[1], patches[count]
        for j in range(3):
            patch.centre[j] = place[j] + sign * size[1] * turn[j, 2]
        set_rows(side, patch.centre, yy, yz, zz, optics, i == 1)
        set_rows(patch, patch.centre, yy, yz, zz, optics, False)
        if kind == CAPSULE:
            _set_quadric(patch, patch.centre, turn, radius, radius, radius)
            _add_slab(patch, turn, 2, end if i else -math.inf, math.inf if i else end)
            count += 1
        elif sign * end < 0.0 or (both and end != 0.0):
            _set_flat(patch, place, turn)
            patch.k, patch.radius = end, radius
            count += 1
    return count
