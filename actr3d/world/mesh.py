"""A mesh from a file, as a part of a scene: visible with its true triangles, with contacts of convex shapes."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
from annotated_types import Ge, Le, MinLen
from mujoco import MjSpec, mjtGeom, mjtMeshInertia
from numpy.typing import NDArray

from actr3d.configuration import Configuration
from actr3d.errors import ConfigurationError, MeshError
from actr3d.warnings import warn_modeller
from actr3d.world.asset_folder import AssetFolder, Files, digest
from actr3d.world.convex_decomposition import convex_parts
from actr3d.world.frames import yaw_quaternion
from actr3d.world.mesh_loading import Triangles, read_triangles
from actr3d.world.mesh_repair import Surface, check_extent, surface
from actr3d.world.scene_objects import WALL_SOLREF, Colour, Heading, Name, Positive

Quaternion = tuple[float, float, float, float]

HIDDEN_GROUP = 3
"""First geom group that MuJoCo's viewers do not draw: files use it for geoms with contacts only."""
INVISIBLE = {"rgba": (0.0, 0.0, 0.0, 0.0), "group": HIDDEN_GROUP}
"""Options of an invisible geom for contacts: rays ignore alpha 0, MuJoCo's viewers do not draw the group."""

GREY = (0.6, 0.6, 0.6, 1.0)
"""The default colour of a mesh."""


def orientation(whose: str, heading: float, quaternion: Quaternion | None) -> Quaternion:
    """Returns the unit quaternion (w, x, y, z) of a heading [rad] or of a quaternion; only one may be given.

    Raises:
        ConfigurationError: If both are given, or the quaternion is 0.
    """
    if quaternion is None:
        return yaw_quaternion(heading)
    length = math.hypot(*quaternion)
    if heading != 0 or length == 0:
        raise ConfigurationError(f"{whose}: give a heading, or a quaternion that is not 0 (got {heading!r}, {quaternion!r})")
    w, x, y, z = (value / length for value in quaternion)
    return (w, x, y, z)


@dataclass(frozen=True, kw_only=True)
class Mesh(Configuration):
    """A mesh from a file of any format that trimesh reads: STL, OBJ, PLY, OFF, GLB, glTF; 3MF and DAE with the extra `formats`.

    The file and the files that it mentions are read once, when the mesh is made. Defects are repaired if possible, with a
    `ModelWarning`; others raise a `MeshError`. Textures are not used: it has one colour.
    """

    name: Name
    """Its name in the scene. The shapes for contacts are `<name>_hull`, or `<name>_part_0`, `<name>_part_1`, …"""

    path: str | Path
    """The file; a relative path starts at the working directory. Files that it mentions are read only from its folder."""

    files: Annotated[Files, MinLen(1)] | None = field(default=None, repr=False)
    """Names and contents of the file and of those that it mentions; `None` reads them now. If given, nothing is read from the disk."""

    scale: Positive | tuple[Positive, Positive, Positive] = 1.0
    """Metres per unit of the file, for all axes or for each (x, y, z): 0.001 for a file in millimetres."""

    up: Literal["y", "z"] | None = None
    """The axis of the file that points up; `None` is y for glTF and GLB, by their standard, and z for all others."""

    position: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Position of the file's origin at the start, (x, y, z) [m]."""

    heading: Heading = 0.0
    """Its rotation about the vertical at the start [rad]."""

    quaternion: Quaternion | None = None
    """Its orientation at the start, (w, x, y, z), instead of a heading."""

    mass: Positive | None = None
    """[kg], spread evenly over its volume (over its convex hull if it is not closed); `None` fixes it in its place."""

    collision: Literal["hull", "parts", "none"] = "hull"
    """Its shape for contacts: its convex hull, convex parts that follow its hollows, or none.
    Parts are slow to make, and then cached in the user's cache folder."""

    coarseness: Annotated[float, Ge(0.01), Le(1)] = 0.05
    """For `parts`: their greatest difference from it, as a fraction of its size. Source of the default: CoACD."""

    seed: Annotated[int, Ge(0)] = 0
    """For `parts`: the seed of the search for good cuts."""

    colour: Colour | None = None
    """Red, green, blue, alpha in 0 to 1; `None` is the colour of its largest piece in the file, grey if that has none."""

    def __post_init__(self) -> None:
        """Checks the fields, reads the files and repairs the triangles.

        Raises:
            ConfigurationError: If a field is wrong.
            MeshError: If the file cannot be read, or is unfit for a world; with the reason.
            ModelWarning: (a warning) If something was repaired.
        """
        super().__post_init__()
        orientation(f"Mesh '{self.name}'", self.heading, self.quaternion)
        if self.files is None:
            path = Path(self.path)
            folder = AssetFolder(path.parent, MeshError)
            read_triangles(folder, path.name, self.up)
            object.__setattr__(self, "files", folder.files)
        triangles, ordered = _read(self._source)
        where = f"Mesh '{self.name}' ({Path(self.path).name})"
        if ordered.flat and (self.collision != "none" or self.mass is not None):
            raise MeshError(f"{where} is flat: it has no volume; leave it fixed, with collision='none', or give it thickness")
        remarks = [*triangles.remarks, *ordered.repairs]
        if not ordered.closed and (self.collision == "hull" or self.mass is not None):
            remarks.append("it is not closed (watertight): contacts and mass are those of its convex hull")
        if self.collision == "parts":
            self._parts()
        if remarks:
            warn_modeller(f"{where}: {'; '.join(remarks)}")

    @property
    def digest(self) -> str:
        """The sha256 of the files, in hexadecimal."""
        return digest(self._source.files)

    def add_to(self, mj_spec: MjSpec) -> None:
        """Adds a body with one visible geom and, unless collision is none, others for contacts."""
        triangles, ordered = _read(self._source)
        turned, fixed = orientation("", self.heading, self.quaternion), self.mass is None
        body = mj_spec.worldbody.add_body(name=self.name, pos=self.position, quat=turned, mocap=fixed)
        if self.mass is not None:
            body.add_freejoint(name=self.name)
            centre, inertia = ordered.mass_properties(self.mass)
            body.mass, body.ipos, body.explicitinertial = self.mass, centre, True
            body.fullinertia = [*np.diag(inertia), inertia[0, 1], inertia[0, 2], inertia[1, 2]]
        _add_geom(
            mj_spec,
            body,
            self.name,
            ordered.vertices,
            ordered.faces,
            rgba=self.colour or triangles.colour or GREY,
            contype=0,
            conaffinity=0,
        )
        hidden = {**INVISIBLE, **({"solref": WALL_SOLREF} if self.mass is None else {})}
        if self.collision == "hull":
            body.add_geom(name=f"{self.name}_hull", type=mjtGeom.mjGEOM_MESH, meshname=self.name, mass=0, **hidden)
        elif self.collision == "parts":
            for number, corners in enumerate(self._parts()):
                _add_geom(mj_spec, body, f"{self.name}_part_{number}", corners, None, **hidden)

    @property
    def _source(self) -> _Source:
        scale = self.scale if isinstance(self.scale, tuple) else (self.scale, self.scale, self.scale)
        return _Source(files=self.files or (), up=self.up, scale=scale)

    def _parts(self) -> list[NDArray[np.float64]]:
        try:
            return _cut(self._source, self.coarseness, self.seed)
        except MeshError as error:
            raise MeshError(f"Mesh '{self.name}' ({Path(self.path).name}): {error}") from error


@dataclass(frozen=True, kw_only=True)
class _Source:
    """All that the triangles depend on: the key of the cache for meshes that occur several times."""

    files: Files
    up: str | None
    scale: tuple[float, float, float]


@lru_cache(maxsize=64)
def _read(source: _Source) -> tuple[Triangles, Surface]:
    name = source.files[0][0]
    triangles = read_triangles(AssetFolder(Path(), MeshError, source.files), name, source.up)
    vertices = triangles.vertices * source.scale
    check_extent(vertices, triangles.faces, name)
    return triangles, surface(vertices, triangles.faces, name)


@lru_cache(maxsize=64)
def _cut(source: _Source, coarseness: float, seed: int) -> list[NDArray[np.float64]]:
    return convex_parts(_read(source)[1], coarseness, seed)


def _add_geom(mj_spec: MjSpec, body: Any, name: str, vertices: Any, faces: Any, **options: Any) -> None:
    mesh = mj_spec.add_mesh(name=name)
    if len(vertices) == 3:  # MuJoCo takes four at least: each triangle becomes three around its middle
        vertices = np.vstack([vertices, vertices.mean(axis=0)])
        faces = np.array([[a, b, 3] for face in faces for a, b in zip(face, np.roll(face, -1), strict=True)])
    mesh.uservert = vertices.ravel()
    if faces is not None:
        mesh.userface = faces.ravel()
    # The body has its mass already; for a shell, MuJoCo needs no volume.
    mesh.inertia = mjtMeshInertia.mjMESH_INERTIA_SHELL
    body.add_geom(name=name, type=mjtGeom.mjGEOM_MESH, meshname=name, mass=0, **options)
