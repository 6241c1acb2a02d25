"""An MJCF or URDF file as a part of a scene: a robot, furniture, a whole room."""

from __future__ import annotations

import re
import warnings
from dataclasses import dataclass, field
from functools import lru_cache
from itertools import count
from pathlib import Path
from typing import Annotated, Any

from annotated_types import MinLen
from mujoco import MjSpec, mjtGeom

from actr3d.configuration import Configuration
from actr3d.errors import ConfigurationError, WorldError, did_you_mean
from actr3d.warnings import warn_modeller
from actr3d.world.asset_folder import AssetFolder, Files, digest, resolved
from actr3d.world.mesh import HIDDEN_GROUP, INVISIBLE, Quaternion, orientation
from actr3d.world.mjcf_rewrite import Document, read_imported
from actr3d.world.scene import on_one_line
from actr3d.world.scene_objects import Heading, Name

GEOM_FIELDS = (
    *("type", "pos", "quat", "fromto", "size", "mass", "density", "typeinertia", "meshname", "hfieldname", "fitscale"),
    *("contype", "conaffinity", "condim", "priority", "friction", "solmix", "solref", "solimp", "margin", "gap", "surfacevel", "adhesion"),
    *("fluid_ellipsoid", "fluid_coefs", "material", "rgba", "group", "castshadow", "userdata", "info"),
)
"""The fields of MuJoCo's description of a geom, but for its name, its frame and its plugin."""


@dataclass(frozen=True, kw_only=True)
class Imported(Configuration):
    """The content of an MJCF or URDF file at a place in a scene, with the prefix `<name>_` before all its names.

    The file and the files that it mentions are read once, when the part is made, and only from inside its folder.
    Meshes may have any format that `Mesh` reads, and are repaired as there. Elements about the whole world (`option`, `size`,
    `statistic`, `visual`, `keyframe`) are left out: the scene's own apply, with a warning for `option` and `keyframe`. Skins and
    soft objects (flexes) are drawn, and soft objects have contacts; the Geometric Camera warns that it does not see them. Shapes for
    contacts only are invisible: in MJCF those of the groups 3 to 5, in URDF the `collision` of a link that has a `visual`.
    """

    name: Name
    """Its name in the scene; its bodies, joints, sites and so on are `<name>_<their name>`."""

    path: str | Path | None = None
    """The file; a relative path starts at the working directory."""

    text: Annotated[str, MinLen(1)] | None = None
    """MJCF or URDF itself, instead of a path."""

    folder: str | Path | None = None
    """The folder of all its files, for files that refer to files outside their own folder; `None` is the folder of the file, for
    `package://NAME/…` the folder NAME above it. Without a path, files are read only with a folder."""

    files: Annotated[Files, MinLen(1)] | None = field(default=None, repr=False)
    """Names and contents of the file and of those that it mentions; `None` reads them now. If given, nothing is read from the disk."""

    position: tuple[float, float, float] = (0.0, 0.0, 0.0)
    """Its origin at the start, (x, y, z) [m]."""

    heading: Heading = 0.0
    """Its rotation about the vertical at the start [rad]."""

    quaternion: Quaternion | None = None
    """Its orientation at the start, (w, x, y, z), instead of a heading."""

    free: bool = False
    """Whether its one root body gets a free joint, `<name>_free`; URDF cannot express that a robot is not fixed to the ground."""

    eye: str | None = None
    """The site in the file that is its eye; `None` for none."""

    def __post_init__(self) -> None:
        """Checks the fields, reads the files and compiles their content, alone.

        Raises:
            ConfigurationError: If a field is wrong.
            WorldError: If the file, or one that it mentions, cannot be read or compiled; with file and line.
            ModelWarning: (a warning) If something was repaired or left out.
        """
        super().__post_init__()
        orientation(f"Imported '{self.name}'", self.heading, self.quaternion)
        try:
            if self.files is None:
                object.__setattr__(self, "files", self._read())
            remarks = _checked(self.files or (), self.free, self.eye)
        except WorldError as error:
            raise type(error)(f"Imported '{self.name}': {error}") from error
        if remarks:
            warn_modeller(f"Imported '{self.name}': {'; '.join(remarks)}")

    @property
    def digest(self) -> str:
        """The sha256 of the files, in hexadecimal."""
        return digest(self.files or ())

    @property
    def prefix(self) -> str:
        """The prefix of each name of the file in the scene."""
        return f"{self.name}_"

    def roots(self) -> tuple[str, ...]:
        """Returns the names in the file of the bodies directly in the world; empty for one without a name."""
        return _roots(self.files or (), self.free)

    def add_to(self, mj_spec: MjSpec) -> None:
        """Attaches it at its place and orientation."""
        frame = mj_spec.worldbody.add_frame(pos=self.position, quat=orientation("", self.heading, self.quaternion))
        described = _specification(_document(self.files or ()), self.free)
        _name_unnamed(described)
        _embody(described)
        mj_spec.attach(described, prefix=self.prefix, frame=frame)

    def _read(self) -> Files:
        if (self.path is None) == (self.text is None):
            raise ConfigurationError(f"Imported '{self.name}': give a path, or a text (got {'neither' if self.text is None else 'both'})")
        if self.text is not None:
            name = f"{self.name}.xml"
            folder = AssetFolder(Path(self.folder), WorldError) if self.folder else AssetFolder(Path(), WorldError, ())
            try:
                folder.put(name, self.text.encode())
            except UnicodeEncodeError as error:
                raise WorldError(f"the text cannot be written in UTF-8: {error}") from error
        else:
            path = resolved(Path(str(self.path)), WorldError)
            root = resolved(Path(self.folder), WorldError) if self.folder else _package_folder(path)
            folder = AssetFolder(root, WorldError)
            if not path.is_relative_to(root):
                raise WorldError(f"'{path.name}' does not lie in the folder '{folder.name}'")
            name = path.relative_to(root).as_posix()
        read_imported(folder, name)
        return folder.files


def _package_folder(path: Path) -> Path:
    """Returns the folder of a file; if the file names a ROS package that contains it, the folder of the package."""
    packages = set(re.findall(rb"(?:package|model)://([^/\"']+)/", path.read_bytes())) if path.is_file() else set[bytes]()
    above = [folder for folder in path.parents if folder.name.encode() in packages]
    return above[0] if above else path.parent


@lru_cache(maxsize=64)
def _document(files: Files) -> Document:
    return read_imported(AssetFolder(Path(), WorldError, files), files[0][0])


@lru_cache(maxsize=64)
def _roots(files: Files, free: bool) -> tuple[str, ...]:
    """Returns the names of the bodies directly in the world; empty for one without a name."""
    return tuple(body.name for body in _specification(_document(files), free).worldbody.bodies)


@lru_cache(maxsize=64)
def _checked(files: Files, free: bool, eye: str | None) -> tuple[str, ...]:
    """Compiles the content of files, alone, so that errors refer to them; returns remarks."""
    document = _document(files)
    mj_spec = _specification(document, free)
    sites = [site.name for site in mj_spec.sites]
    if eye is not None and eye not in sites:
        raise WorldError(f"no site '{eye}' to be the eye; there are {', '.join(filter(None, sites)) or 'none'}{did_you_mean(eye, sites)}")
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        try:
            mj_spec.compile()
        except (ValueError, RuntimeError) as error:
            raise WorldError(_said(error, document)) from error
    return (*document.remarks, *(on_one_line(str(warning.message)) for warning in said))


def _specification(document: Document, free: bool) -> MjSpec:
    """Returns a new specification of a document, its meshes and assets in it."""
    try:
        mj_spec = MjSpec.from_string(document.text, assets=document.assets)
    except (ValueError, RuntimeError) as error:
        raise WorldError(_said(error, document)) from error
    for mesh in mj_spec.meshes:
        if mesh.file in document.meshes:
            found = document.meshes[mesh.file]
            mesh.uservert, mesh.userface, mesh.file = found.vertices.ravel(), found.faces.ravel(), ""
    for body in mj_spec.bodies:
        _hide(body.geoms, document.urdf)
    if free:
        roots = mj_spec.worldbody.bodies
        if len(roots) != 1 or any(roots[0].joints):
            raise WorldError(f"free=True needs one root body without a joint (there are {len(roots)})")
        roots[0].add_freejoint(name="free")
    return mj_spec


def _name_unnamed(mj_spec: MjSpec) -> None:
    """Names unnamed elements directly in the world, so that contacts can name them: `body_0`, `geom_0`, `geom_1`, …"""
    for kind, things, all_things in (("body", mj_spec.worldbody.bodies, mj_spec.bodies), ("geom", mj_spec.worldbody.geoms, mj_spec.geoms)):
        taken = {thing.name for thing in all_things}
        free = (name for name in (f"{kind}_{number}" for number in count()) if name not in taken)
        for thing in things:
            thing.name = thing.name or next(free)


def _embody(mj_spec: MjSpec) -> None:
    """Moves each geom of the world body, except planes and height fields, into a fixed body: the legs of walkers do not touch the world
    body.

    Where the file excludes contacts with the world, they stay in it.
    """
    ground = (mjtGeom.mjGEOM_PLANE, mjtGeom.mjGEOM_HFIELD)
    if any("world" in (exclude.bodyname1, exclude.bodyname2) for exclude in mj_spec.excludes):
        return
    for geom in [geom for geom in mj_spec.worldbody.geoms if geom.type not in ground and not geom.plugin.active]:
        body = mj_spec.worldbody.add_body()
        if geom.frame is not None:
            body.set_frame(geom.frame)
        moved, called = body.add_geom(), geom.name
        for name in GEOM_FIELDS:
            setattr(moved, name, getattr(geom, name))
        for name in ("type", "axisangle", "euler", "xyaxes", "zaxis"):
            setattr(moved.alt, name, getattr(geom.alt, name))
        mj_spec.delete(geom)
        moved.name = called


def _hide(geoms: list[Any], urdf: bool) -> None:
    """Hides geoms for contacts only from rays and viewers."""
    seen = [geom for geom in geoms if geom.contype == 0 and geom.conaffinity == 0]
    for geom in geoms:
        if (urdf and seen and geom not in seen) or (not urdf and geom.group >= HIDDEN_GROUP):
            geom.material = ""
            geom.rgba = INVISIBLE["rgba"]
            geom.group = max(geom.group, HIDDEN_GROUP)


def _said(error: Exception, document: Document) -> str:
    """Returns MuJoCo's message on one line, with the modeller's file and line instead of those of the generated text."""

    def origin(found: re.Match[str]) -> str:
        number = int(found[1])
        return document.origins[number - 1] if 0 < number <= len(document.origins) else found[0]

    text = re.sub(r"(?:L|\bl)ine(?: number=| )(\d+)", origin, str(error))
    return on_one_line(text).removeprefix("XML ").removeprefix("Error: ")
