"""Converts geoms to what may be in view: patches and polygons, by the row they begin on."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from actr3d.camera.kernel.active_rows import ActiveRows, add_item, remove_all, room_for_active_rows
from actr3d.camera.kernel.dtypes import BOX, HFIELD, MESH, NUMBER, OCCLUDER, PATCH, PLANE, UNSEEN, Array, Record, Records
from actr3d.camera.kernel.faces import face_rows
from actr3d.camera.kernel.occluders import LARGE, MAX_OCCLUDERS, hidden, offer
from actr3d.camera.kernel.polyhedra import box_distance, hfield_reach, place_corners, set_box, set_hfield
from actr3d.camera.kernel.screen import in_view, zero
from actr3d.camera.kernel.solids import add_patches, reach_of
from actr3d.jit import inner_compiled


class Geoms(NamedTuple):
    """A model's description of its geoms: views of MuJoCo's own memory, so that changes take effect at once."""

    size: Array
    group: Array
    rgba: Array
    matid: Array
    mat_rgba: Array
    rbound: Array
    mesh_vert: Array
    hfield_size: Array
    hfield_data: Array


class Topology(NamedTuple):
    """The constant part of a model: which geom belongs to which object, and which corners make a face."""

    kind: Array
    """The type of each geom, `(n,)`."""
    objects: Array
    """The object of each geom, `(n,)`."""
    groups: Array
    """Whether each group of geoms is seen, `(6,)`."""
    source: Array
    """The address of a mesh's or height field's data, and the height field's id, rows and columns, `(n, 4)`."""
    corners: Array
    """The first corner of each geom, and at the end the total number of corners, `(n + 1,)`."""
    faces: Array
    """The first face of each geom, and at the end the total number of faces, `(n + 1,)`."""
    face_corners: Array
    """The corners of each face, `(m, 4)`; -1 after those of a triangle."""
    face_geom: Array
    """The geom of each face, `(m,)`."""


class EyeScene(NamedTuple):
    """Work arrays for what is in view at one moment."""

    places: Array
    """The geoms' centres in the eye's frame, and the eye itself, `(n + 1, 3)` [m]."""
    reaches: Array
    """The radii of the bounding balls of the geoms about these centres, `(n + 1,)` [m]."""
    turn: Array
    """The axes of the current geom, as columns."""
    occluders: Records
    patches: Records
    local: Array
    """The corners of one geom in its frame [m]."""
    corners: Array
    """All corners in the eye's frame [m]."""
    surfaces: ActiveRows
    """The patches, then the faces, by their rows; the active ones are ordered from left to right as on the row above.

    A face's number here is its own number plus the length of `patches`.
    """
    aside: Array
    """Active surfaces that have no piece on the row."""


def room_for_scene(topology: Topology, rows: int) -> EyeScene:
    """Returns work arrays large enough for all geoms of a model."""
    geoms, corners, faces = len(topology.kind), int(topology.corners[-1]), int(topology.faces[-1])
    patches = 3 * geoms + 1  # a cylinder or capsule has three
    return EyeScene(
        places=np.zeros((geoms + 1, 3)),
        reaches=np.full(geoms + 1, np.inf),
        turn=np.zeros((3, 3)),
        occluders=np.zeros(MAX_OCCLUDERS, OCCLUDER),
        patches=np.zeros(patches, PATCH),
        local=np.zeros((max(8, corners), 3)),
        corners=np.zeros((corners, 3)),
        surfaces=room_for_active_rows(patches + faces, rows),
        aside=np.zeros(patches + faces, NUMBER),
    )


def set_scene(eye: Array, place: Array, turn: Array, constants: Array, geoms: Geoms, topology: Topology, scene: EyeScene) -> int:
    """Finds what may be in view; returns 0, or `-1 - geom` if the pose of a geom is not finite.

    Args:
        eye: The eye's right, up and forward axes, and its position, as rows in the world frame.
        place: The geoms' positions in the world frame.
        turn: The geoms' rotations, `(n, 9)`.
        constants: An array of the constants of one eye.
        geoms: The geoms of the model.
        topology: The topology of the model.
        scene: The work arrays to fill.
    """
    optics = constants[0]
    count, occluders = zero(), zero()
    remove_all(scene.surfaces)
    for turn_of in range(2):  # first those that may hide others
        for geom in range(len(topology.kind)):
            first = topology.kind[geom] == BOX and _is_large(geoms.size[geom], place[geom], eye)
            if first != (turn_of == 0) or not _visible(geom, geoms, topology):
                continue
            if not _set_pose(eye, place[geom], turn[geom], scene.places[geom], scene.turn):
                return -1 - geom
            reach = _reach(geom, geoms, topology)
            scene.reaches[geom] = reach
            if not in_view(scene.places[geom], reach, optics) or hidden(scene.places[geom], reach, scene.occluders, occluders):
                continue
            if topology.kind[geom] in (BOX, MESH, HFIELD):
                occluders = _add_polyhedron(geom, geoms, topology, optics, scene, occluders)
            else:
                count = _add_round(geom, reach, geoms, topology, optics, scene, count)
    return 0


@inner_compiled
def _is_large(size: Array, place: Array, eye: Array) -> bool:
    """Checks whether a box looks large from the eye."""
    x, y, z = place[0] - eye[3, 0], place[1] - eye[3, 1], place[2] - eye[3, 2]
    return _square(size) > LARGE * (x * x + y * y + z * z)


@inner_compiled
def _reach(geom: int, geoms: Geoms, topology: Topology) -> float:
    """Returns the radius of the bounding ball of a geom about its centre [m]."""
    kind, size = topology.kind[geom], geoms.size[geom]
    if kind == BOX:
        return math.sqrt(_square(size))
    if kind == MESH:
        return geoms.rbound[geom]
    if kind == HFIELD:
        return hfield_reach(geoms.hfield_size[topology.source[geom][1]])
    return reach_of(kind, size)


@inner_compiled
def _add_round(geom: int, reach: float, geoms: Geoms, topology: Topology, optics: Record, scene: EyeScene, count: int) -> int:
    """Appends the patches of a geom that is round or a plane; returns the new number of patches."""
    kind, place, before = topology.kind[geom], scene.places[geom], count
    both = kind != PLANE and math.sqrt(_square(place)) - reach <= optics.corner
    count = add_patches(kind, geoms.size[geom], place, scene.turn, both, optics, scene.patches, count)
    for i in range(before, count):
        patch = scene.patches[i]
        patch.object, patch.geom = topology.objects[geom], geom
        add_item(scene.surfaces, i, patch.first_row, patch.last_row)
    return count


@inner_compiled
def _visible(geom: int, geoms: Geoms, topology: Topology) -> bool:
    """Checks whether a geom can be seen at all: as with MuJoCo's rays, fully transparent geoms cannot."""
    if topology.objects[geom] == UNSEEN or not topology.groups[min(max(geoms.group[geom], 0), 5)]:
        return False
    material = geoms.matid[geom]
    alpha = geoms.rgba[geom, 3] if material < 0 else geoms.mat_rgba[material, 3]
    return alpha != 0.0


@inner_compiled
def _set_pose(eye: Array, place: Array, turn: Array, its_place: Array, its_turn: Array) -> bool:
    """Transforms a pose to the eye's frame; returns whether it is finite."""
    total = 0.0
    for i in range(3):
        its_place[i] = 0.0
        for j in range(3):
            its_place[i] += eye[i, j] * (place[j] - eye[3, j])
            its_turn[i, j] = eye[i, 0] * turn[j] + eye[i, 1] * turn[3 + j] + eye[i, 2] * turn[6 + j]
            total += its_turn[i, j]
        total += its_place[i]
    return math.isfinite(total)


@inner_compiled
def _square(vector: Array) -> float:
    return vector[0] * vector[0] + vector[1] * vector[1] + vector[2] * vector[2]


@inner_compiled
def _add_polyhedron(geom: int, geoms: Geoms, topology: Topology, optics: Record, scene: EyeScene, occluders: int) -> int:
    """Transforms the corners of a geom, and adds its faces at the rows they begin on; returns the new number of occluders."""
    kind, source, size = topology.kind[geom], topology.source[geom], geoms.size[geom]
    place, turn = scene.places[geom], scene.turn
    corners = scene.corners[topology.corners[geom] : topology.corners[geom + 1]]
    if kind == MESH:
        place_corners(geoms.mesh_vert[source[0] :], place, turn, corners)
    elif kind == BOX:
        set_box(size, scene.local)
        place_corners(scene.local, place, turn, corners)
    else:
        set_hfield(geoms.hfield_size[source[1]], geoms.hfield_data[source[0] :], source[2], source[3], scene.local)
        place_corners(scene.local, place, turn, corners)
    one_sided = kind == BOX and box_distance(size, place, turn) > optics.corner
    for face in range(topology.faces[geom], topology.faces[geom + 1]):
        first, last = face_rows(topology.face_corners[face], scene.corners, one_sided, optics)
        add_item(scene.surfaces, len(scene.patches) + face, first, last)
        if one_sided and first <= last:
            occluders = offer(topology.face_corners[face], scene.corners, optics, scene.occluders, occluders)
    return occluders
