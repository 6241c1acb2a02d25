"""Converts the shapes of a compiled scene and their poses to numbers that a page can draw; `solids.js` makes triangles of them."""

from __future__ import annotations

import base64
from collections.abc import Iterable
from typing import Any

import mujoco
import numpy as np
from mujoco import MjData, MjModel, mjtGeom

from actr3d.errors import RecordingError
from workbench.curves import INTEGRATION
from workbench.geom_colours import colour_of

MAX_CORNERS = 1_500_000
"""Maximum total number of corners and triangles in a scene; each has three 4-byte numbers."""
CORNERS = {"box": 20, "sphere": 1_500, "ellipsoid": 1_500, "capsule": 1_600, "cylinder": 260}
"""Number of corners and triangles that the page creates for each kind of primitive shape."""
KINDS = {
    int(mjtGeom.mjGEOM_SPHERE): ("sphere", 1),
    int(mjtGeom.mjGEOM_CAPSULE): ("capsule", 2),
    int(mjtGeom.mjGEOM_ELLIPSOID): ("ellipsoid", 3),
    int(mjtGeom.mjGEOM_CYLINDER): ("cylinder", 2),
    int(mjtGeom.mjGEOM_BOX): ("box", 3),
}
"""Names of MuJoCo's primitive shapes, with the number of size values [m]: radius, half length; half axes; half edges."""
MESHES = (int(mjtGeom.mjGEOM_MESH), int(mjtGeom.mjGEOM_SDF))


def packed(numbers: Any, kind: str) -> str:
    """Returns numbers as base64 text of their bytes, in a NumPy type such as `<f4`."""
    return base64.b64encode(np.ascontiguousarray(numbers, dtype=kind).tobytes()).decode("ascii")


class Shapes:
    """Collects what is drawn of a scene, one shape for each MuJoCo body, without planes.

    Raises:
        RecordingError: If the scene has too many triangles.
    """

    def __init__(self, model: MjModel) -> None:
        self._model = model
        self._corners = 0
        self._numbers: dict[tuple[int, int], int] = {}
        self.meshes: list[dict[str, str]] = []
        """Corners [m] and triangles of meshes and height fields; each is stored once, even if several shapes use it."""
        self.bodies: list[int] = []
        """The MuJoCo body of each shape."""
        self.parts: list[list[dict[str, Any]]] = []
        """The parts of each shape, in the frame of its body."""
        seen = (model.geom_type != mjtGeom.mjGEOM_PLANE) & (model.geom_rgba[:, 3] > 0) & (model.geom_group < 3)
        for body in range(model.nbody):
            own = np.flatnonzero(seen & (model.geom_bodyid == body)).tolist()
            parts = [part for part in map(self._part, own) if part is not None]
            if parts:
                self.bodies.append(body)
                self.parts.append(parts)

    def _part(self, geom: int) -> dict[str, Any] | None:
        """Returns the data with which a page draws a geom; None for a kind that is never drawn."""
        model, kind = self._model, int(self._model.geom_type[geom])
        if kind in KINDS:
            name, numbers = KINDS[kind]
            shape = {"kind": name, "size": _rounded(model.geom_size[geom, :numbers])}
            self._count(CORNERS[name])
        elif kind in MESHES or kind == mjtGeom.mjGEOM_HFIELD:
            shape = {"kind": "mesh", "mesh": self._mesh(kind, int(model.geom_dataid[geom]))}
        else:
            return None
        place, turn = _rounded(model.geom_pos[geom]), _rounded(model.geom_quat[geom])
        return {**shape, "place": place, "turn": turn, "colour": colour_of(model, geom)}

    def _mesh(self, kind: int, number: int) -> int:
        """Returns the index of a mesh or height field in `meshes`; adds it if necessary."""
        known = self._numbers.get((kind, number))
        if known is None:
            places, faces = _height_field(self._model, number) if kind == mjtGeom.mjGEOM_HFIELD else _triangles(self._model, number)
            self._count(len(places) + len(faces))
            known = self._numbers[kind, number] = len(self.meshes)
            self.meshes.append({"places": packed(places, "<f4"), "faces": packed(faces, "<u4")})
        return known

    def _count(self, corners: int) -> None:
        self._corners += corners
        if self._corners > MAX_CORNERS:
            raise RecordingError("the scene has too many triangles for a replay in one file")


def _rounded(numbers: Any) -> list[float]:
    return [round(float(number), 6) for number in numbers]


def _triangles(model: MjModel, mesh: int) -> tuple[Any, Any]:
    """Returns the corners and triangles of a mesh."""
    corner, face = model.mesh_vertadr[mesh], model.mesh_faceadr[mesh]
    return model.mesh_vert[corner : corner + model.mesh_vertnum[mesh]], model.mesh_face[face : face + model.mesh_facenum[mesh]]


def _height_field(model: MjModel, field: int) -> tuple[Any, Any]:
    """Returns the corners and triangles of a height field, without its base."""
    rows, columns = int(model.hfield_nrow[field]), int(model.hfield_ncol[field])
    first = model.hfield_adr[field]
    heights = model.hfield_data[first : first + rows * columns] * model.hfield_size[field, 2]
    wide, deep = float(model.hfield_size[field, 0]), float(model.hfield_size[field, 1])
    x, y = np.linspace(-wide, wide, columns), np.linspace(-deep, deep, rows)
    places: Any = np.column_stack((np.tile(x, rows), np.repeat(y, columns), heights))
    corner = (np.arange(rows - 1)[:, None] * columns + np.arange(columns - 1)).ravel()
    right, above, across = corner + 1, corner + columns, corner + columns + 1
    return places, np.concatenate((np.column_stack((corner, right, across)), np.column_stack((corner, across, above))))


def poses_of(model: MjModel, bodies: list[int], states: Iterable[bytes]) -> Any:
    """Returns the poses of bodies in some states: positions [m] and quaternions, `(states, bodies, 7)`."""
    data = MjData(model)
    poses: list[Any] = []
    for state in states:
        mujoco.mj_setState(model, data, np.frombuffer(state), INTEGRATION)
        mujoco.mj_kinematics(model, data)
        poses.append(np.concatenate((data.xpos[bodies], data.xquat[bodies]), axis=1, dtype=np.float32))
    return np.array(poses, dtype=np.float32).reshape(len(poses), len(bodies), 7)
