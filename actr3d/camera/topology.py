"""Reads the shapes of a model's geoms: kinds, objects, corners and faces."""

from __future__ import annotations

import numpy as np
from mujoco import MjModel
from numpy.typing import NDArray

from actr3d.camera.eye import names_of
from actr3d.camera.kernel.dtypes import BACKGROUND, BOX, HFIELD, MESH, PLANE, SDF, UNSEEN
from actr3d.camera.kernel.polyhedra import HFIELD_EXTRA_CORNERS
from actr3d.camera.kernel.scene import Geoms, Topology
from actr3d.camera.parameters import CameraParameters
from actr3d.errors import CameraError, did_you_mean

Faces = NDArray[np.int64]

BOX_FACES: Faces = np.array([(1, 3, 7, 5), (0, 4, 6, 2), (2, 6, 7, 3), (0, 1, 5, 4), (4, 5, 7, 6), (0, 2, 3, 1)])
"""The corners of a box's faces, anticlockwise seen from outside; bit 0 of a corner is the sign of x, bit 1 of y, bit 2 of z."""


def geoms_of(mj_model: MjModel) -> Geoms:
    """Returns the arrays of a model that describe the appearance of its geoms."""
    return Geoms(
        size=mj_model.geom_size,
        group=mj_model.geom_group,
        rgba=mj_model.geom_rgba,
        matid=mj_model.geom_matid,
        mat_rgba=mj_model.mat_rgba,
        rbound=mj_model.geom_rbound,
        mesh_vert=mj_model.mesh_vert,
        hfield_size=mj_model.hfield_size,
        hfield_data=mj_model.hfield_data,
    )


def topology_of(mj_model: MjModel, objects: NDArray[np.int64], groups: tuple[int, ...] | None) -> Topology:
    """Returns the kinds, objects and faces of a model's geoms. A signed distance field is seen as the mesh that MuJoCo draws for it."""
    count = mj_model.ngeom
    source = np.zeros((count, 4), np.int64)
    corners, faces = np.zeros(count + 1, np.int64), np.zeros(count + 1, np.int64)
    all_faces: list[Faces] = [np.zeros((0, 4), np.int64)]
    for geom in range(count):
        number, its_faces = _faces_of(mj_model, geom, source[geom])
        all_faces.append(np.where(its_faces < 0, -1, its_faces + corners[geom]))
        corners[geom + 1], faces[geom + 1] = corners[geom] + number, faces[geom] + len(its_faces)
    return Topology(
        kind=np.where(mj_model.geom_type == SDF, MESH, mj_model.geom_type).astype(np.int64),
        objects=objects,
        groups=np.array([groups is None or group in groups for group in range(6)]),
        source=source,
        corners=corners,
        faces=faces,
        face_corners=np.concatenate(all_faces),
        face_geom=np.repeat(np.arange(len(faces) - 1), faces[1:] - faces[:-1]),
    )


def _faces_of(mj_model: MjModel, geom: int, source: NDArray[np.int64]) -> tuple[int, Faces]:
    """Returns the number of corners of a geom, and its faces; writes the address of its data into `source`."""
    kind, data = int(mj_model.geom_type[geom]), int(mj_model.geom_dataid[geom])
    if kind == BOX:
        return 8, BOX_FACES
    if kind in (MESH, SDF):
        source[0] = mj_model.mesh_vertadr[data]
        start, number = int(mj_model.mesh_faceadr[data]), int(mj_model.mesh_facenum[data])
        return int(mj_model.mesh_vertnum[data]), _triangles(mj_model.mesh_face[start : start + number])
    if kind == HFIELD:
        rows, columns = int(mj_model.hfield_nrow[data]), int(mj_model.hfield_ncol[data])
        source[:] = mj_model.hfield_adr[data], data, rows, columns
        return 2 * rows * columns + HFIELD_EXTRA_CORNERS, _hfield_faces(rows, columns)
    return 0, np.zeros((0, 4), np.int64)


def _triangles(corners: NDArray[np.integer]) -> Faces:
    return np.column_stack((corners, np.full(len(corners), -1))).astype(np.int64)


def _hfield_faces(rows: int, columns: int) -> Faces:
    """Returns the faces of a height field: two triangles per cell, its sides, and all six faces of its base.

    The top of the base lies under the surface and is seen only from inside, as with MuJoCo's rays.
    """
    grid = np.arange(rows * columns).reshape(rows, columns)
    a, b, c, d = grid[:-1, :-1].ravel(), grid[:-1, 1:].ravel(), grid[1:, :-1].ravel(), grid[1:, 1:].ravel()
    surface = _triangles(np.concatenate((np.column_stack((a, b, d)), np.column_stack((a, d, c)))))
    ring = np.concatenate((grid[0, :-1], grid[:-1, -1], grid[-1, :0:-1], grid[:0:-1, 0]))
    after = np.roll(ring, -1)
    sides = np.column_stack((ring, after, after + grid.size, ring + grid.size))
    border = grid[[0, 0, -1, -1], [0, -1, 0, -1]] + grid.size
    base = np.concatenate((2 * grid.size + np.arange(HFIELD_EXTRA_CORNERS), border))
    return np.concatenate((surface, sides, base[BOX_FACES]))


def objects_of(mj_model: MjModel, own_body: int, parameters: CameraParameters) -> NDArray[np.int64]:
    """Returns the object number of each geom, counted from 1, or `UNSEEN` or `BACKGROUND`, `(n,)`.

    An object is a top-level body of the world with all its descendants, or one geom that belongs to the world itself.
    The eye's own body is left out, or each of its parts is an object.

    Args:
        mj_model: The MuJoCo model.
        own_body: The id of the body that the eye belongs to, 0 for the world.
        parameters: The camera's parameters.

    Raises:
        CameraError: If `background` names a geom that does not exist.
    """
    background = _background(mj_model, parameters)
    own_root = int(mj_model.body_rootid[own_body])
    numbers: dict[tuple[str, int], int] = {}
    objects = np.zeros(mj_model.ngeom, np.int64)
    for geom in range(mj_model.ngeom):
        body = int(mj_model.geom_bodyid[geom])
        root = int(mj_model.body_rootid[body])
        own = own_root != 0 and root == own_root
        if own and not parameters.own_limbs:
            objects[geom] = UNSEEN
        elif geom in background:
            objects[geom] = BACKGROUND
        else:
            thing = ("body", body if own else root) if body else ("geom", geom)
            objects[geom] = numbers.setdefault(thing, len(numbers) + 1)
    return objects


def _background(mj_model: MjModel, parameters: CameraParameters) -> set[int]:
    """Returns the ids of the geoms that hide others but are not reported."""
    if parameters.background is None:
        return {geom for geom in range(mj_model.ngeom) if mj_model.geom_type[geom] == PLANE}
    names = names_of(mj_model, "geom")
    for name in parameters.background:
        if name not in names or not name:
            known = [known for known in names if known]
            raise CameraError(f"CameraParameters.background: no geom {name!r}{did_you_mean(name, known)}")
    return {names.index(name) for name in parameters.background}
