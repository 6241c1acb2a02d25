"""The compiled function of this package that Python calls: computes everything that an eye sees at one moment."""

from __future__ import annotations

import math
from collections.abc import Callable
from functools import cache

from actr3d.camera.kernel import SOURCES
from actr3d.camera.kernel.active_rows import update_active
from actr3d.camera.kernel.dtypes import BACKGROUND, FAR_SIDE, Array, Record, Records
from actr3d.camera.kernel.extents import finish
from actr3d.camera.kernel.faces import add_face
from actr3d.camera.kernel.nearest import find_nearest
from actr3d.camera.kernel.patches import add_patch
from actr3d.camera.kernel.pieces import bound
from actr3d.camera.kernel.scene import EyeScene, Geoms, Topology, set_scene
from actr3d.camera.kernel.screen import row_tangent, zero
from actr3d.camera.kernel.upper_envelope import Row, trace_row
from actr3d.jit import compile_cached, compiled_on_demand, inner_compiled

MAX_PIECES_OF_A_PATCH = 10
"""Eight cuts leave at most five pieces on each side."""

scene_setter = compiled_on_demand(SOURCES)(set_scene)
"""Returns the first half of `scan`, compiled: it finds what may be in view."""


def _trace_rows(eye: Array, constants: Array, topology: Topology, scene: EyeScene, row: Row, labels: Array, extents: Records) -> int:
    optics = constants[0]
    done, present = zero(), zero()
    row.stretches[0].count = row.stretches[0].open = 0
    for number in range(optics.rows):
        v = row_tangent(number, optics)
        present = update_active(scene.surfaces, number, present)
        pieces, aside = _add_pieces(v, optics, topology, scene, present, row)
        pieces = _add_range(v, optics, row, pieces)
        first = done
        rise = v * eye[1, 2] + eye[2, 2]
        done = trace_row(v, 1.0 + v * v - rise * rise, optics, row, pieces, extents, first)
        _label(number, labels, extents, first, done)
        _order_surfaces(row, pieces, scene, aside)
    find_nearest(row.stretches[0], extents)
    finish(optics, extents, done, row.edges)
    return done


row_tracer = compiled_on_demand(SOURCES)(_trace_rows)
"""Returns the second half of `scan`, compiled: it traces the rows of what may be in view."""


@cache
def scan() -> Callable[[Array, Array, Array, Array, Geoms, Topology, EyeScene, Row, Array, Array], int]:
    """Returns the compiled function; its first call in a new installation takes seconds.

    Its arguments are: the eye's axes and position, the geoms' positions and rotations, an array of one optics, the geoms, the
    topology, work arrays for the scene and for a row, the labels of objects, and the output array of extents. It returns the number
    of extents, or `-1 - geom` if the pose of a geom is not finite.
    """
    scene_setter()
    row_tracer()
    return compile_cached(_scan, SOURCES)


def _scan(
    eye: Array,
    place: Array,
    turn: Array,
    constants: Array,
    geoms: Geoms,
    topology: Topology,
    scene: EyeScene,
    row: Row,
    labels: Array,
    extents: Records,
) -> int:
    failed = set_scene(eye, place, turn, constants, geoms, topology, scene)
    return failed if failed < 0 else _trace_rows(eye, constants, topology, scene, row, labels, extents)


@inner_compiled
def _add_pieces(v: float, optics: Record, topology: Topology, scene: EyeScene, present: int, row: Row) -> tuple[int, int]:
    """Writes the pieces of all surfaces on a row; returns the number of pieces, and the number of surfaces without any."""
    count, aside = zero(), zero()
    for i in range(present):
        surface, before = scene.surfaces.present[i], count
        if surface < len(scene.patches):
            count = add_patch(scene.patches[surface], v, optics, row.curve, row.pieces, count, row.cuts)
        else:
            face = surface - len(scene.patches)
            count = add_face(topology.face_corners[face], scene.corners, v, optics, row.pieces, count)
            if count > before:
                geom = topology.face_geom[face]
                row.pieces[before].geom, row.pieces[before].object = geom, topology.objects[geom]
        for piece in range(before, count):
            row.pieces[piece].surface = surface if piece == before else -1
        if count == before:
            scene.aside[aside] = surface
            aside += 1
    return count, aside


@inner_compiled
def _order_surfaces(row: Row, pieces: int, scene: EyeScene, aside: int) -> None:
    """Sorts the surfaces by their first pieces: on the next row, nearly everything is then already in order."""
    count = zero()
    for i in range(pieces):
        surface = row.pieces[row.order[i]].surface
        if surface >= 0:
            scene.surfaces.present[count] = surface
            count += 1
    for i in range(aside):
        scene.surfaces.present[count] = scene.aside[i]
        count += 1


@inner_compiled
def _add_range(v: float, optics: Record, row: Row, count: int) -> int:
    """Appends the end of the eye's range, a ball seen from inside; returns the new number of pieces."""
    if not math.isfinite(optics.range):
        return count
    piece = row.pieces[count]
    piece.low, piece.high, piece.side = -optics.right, optics.right, FAR_SIDE
    piece.object, piece.geom, piece.surface = BACKGROUND, len(row.places) - 1, -1
    square = optics.range * optics.range
    piece.a, piece.b0, piece.b1 = -1.0, 0.0, 0.0
    piece.c0, piece.c1, piece.c2 = (1.0 + v * v) / square, 0.0, 1.0 / square
    bound(piece, 1.0 / optics.range, math.inf)
    return count + 1


@inner_compiled
def _label(number: int, labels: Array, extents: Records, first: int, done: int) -> None:
    """Writes row and labels; an object that was never seen before gets the next label."""
    for i in range(first, done):
        extent = extents[i]
        if labels[extent.label] == 0:
            labels[0] += 1
            labels[extent.label] = labels[0]
        extent.label = labels[extent.label]
        extent.row = number
