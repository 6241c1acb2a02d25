"""From geoms that are round or planes to patches in the eye's frame."""

from __future__ import annotations

import math

from actr3d.camera.kernel.jit import compiled
from actr3d.camera.kernel.layout import CAPSULE, CYLINDER, ELLIPSOID, PLANE, Array, Record, Records
from actr3d.camera.kernel.screen import set_rows


@compiled
def reach_of(kind: int, size: Array) -> float:
    """Returns the radius of a ball around the centre that holds all of a geom [m], infinite for endless planes.

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


@compiled
def add_patches(kind: int, size: Array, place: Array, turn: Array, both: bool, optics: Record, patches: Records, count: int) -> int:
    """Appends the patches of one geom; returns how many there are now.

    Args:
        kind: The geom's type.
        size: The geom's size, as in MuJoCo [m].
        place: Its centre in the eye's frame [m].
        turn: Its axes in the eye's frame, as columns.
        both: Whether its far sides can be seen.
        optics: The eye's.
        patches: Where they are written; `object` and `geom` are left to the caller.
        count: How many there are already.
    """
    start = count
    if kind == PLANE:
        count = _add_plane(size, place, turn, patches, count)
    elif kind == CYLINDER:
        _set_quadric(patches[count], place, turn, size[0], size[0], math.inf)
        middle = _along(turn, place)
        _add_slab(patches[count], turn, 2, middle - size[1], middle + size[1])
        count = _add_discs(size, place, turn, both, patches, count + 1)
    elif kind == CAPSULE:
        count = _add_capsule(size, place, turn, patches, count)
    else:
        y, z = (size[1], size[2]) if kind == ELLIPSOID else (size[0], size[0])
        _set_quadric(patches[count], place, turn, size[0], y, z)
        count += 1
    reach = reach_of(kind, size)
    for i in range(start, count):
        patches[i].both = both and not patches[i].even
        set_rows(patches[i], place, reach, optics)
    return count


@compiled
def _along(turn: Array, place: Array) -> float:
    """Returns how far a place lies along a geom's third axis [m]."""
    return turn[0, 2] * place[0] + turn[1, 2] * place[1] + turn[2, 2] * place[2]


@compiled
def _set_quadric(patch: Record, place: Array, turn: Array, x: float, y: float, z: float) -> None:
    """Makes a patch an ellipsoid's of the given half axes, infinite for a tube: (p - c) Q (p - c) = 1, c its place."""
    patch.even, patch.slabs, patch.radius = 0, 0, 0.0
    a = -1.0
    for i in range(3):
        row = 0.0
        for j in range(3):
            form = turn[i, 0] * turn[j, 0] / (x * x) + turn[i, 1] * turn[j, 1] / (y * y) + turn[i, 2] * turn[j, 2] / (z * z)
            patch.form[i, j] = form
            row += form * place[j]
        patch.q[i] = row
        a += row * place[i]
    patch.a = a


@compiled
def _set_flat(patch: Record, place: Array, turn: Array) -> None:
    """Makes a patch a plane through a place, across a geom's third axis."""
    patch.even, patch.slabs, patch.radius = 1, 0, 0.0
    for i in range(3):
        patch.q[i] = turn[i, 2]
    patch.k = _along(turn, place)


@compiled
def _add_slab(patch: Record, turn: Array, axis: int, low: float, high: float) -> None:
    """Bounds a patch between two planes across an axis of its geom."""
    number = patch.slabs
    for i in range(3):
        patch.axes[number, i] = turn[i, axis]
    patch.lows[number], patch.highs[number] = low, high
    patch.slabs = number + 1


@compiled
def _add_plane(size: Array, place: Array, turn: Array, patches: Records, count: int) -> int:
    """Appends a plane, which is seen from its front only."""
    patch = patches[count]
    _set_flat(patch, place, turn)
    if not patch.k < 0.0:
        return count
    for i in range(2):
        if size[i] > 0.0:
            middle = turn[0, i] * place[0] + turn[1, i] * place[1] + turn[2, i] * place[2]
            _add_slab(patch, turn, i, middle - size[i], middle + size[i])
    return count + 1


@compiled
def _add_discs(size: Array, place: Array, turn: Array, both: bool, patches: Records, count: int) -> int:
    """Appends the ends of a cylinder that face the eye; all, if their inner sides can be seen too."""
    for sign in (-1.0, 1.0):
        patch = patches[count]
        _set_flat(patch, place, turn)
        patch.k += sign * size[1]
        for i in range(3):
            patch.centre[i] = place[i] + sign * size[1] * turn[i, 2]
        if sign * patch.k < 0.0 or (both and patch.k != 0.0):
            patch.radius = size[0]
            count += 1
    return count


@compiled
def _add_capsule(size: Array, place: Array, turn: Array, patches: Records, count: int) -> int:
    """Appends a tube and the two half balls at its ends."""
    middle = _along(turn, place)
    low, high = middle - size[1], middle + size[1]
    _set_quadric(patches[count], place, turn, size[0], size[0], math.inf)
    _add_slab(patches[count], turn, 2, low, high)
    for sign in (-1.0, 1.0):
        count += 1
        patch = patches[count]
        for i in range(3):
            patch.centre[i] = place[i] + sign * size[1] * turn[i, 2]
        _set_quadric(patch, patch.centre, turn, size[0], size[0], size[0])
        _add_slab(patch, turn, 2, -math.inf if sign < 0.0 else high, low if sign < 0.0 else math.inf)
    return count + 1
