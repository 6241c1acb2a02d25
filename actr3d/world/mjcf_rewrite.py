"""Rewrites an MJCF or URDF document for a scene: finds its files, limits its size, fills in missing values."""

from __future__ import annotations

import math
import posixpath
import struct
from dataclasses import dataclass, field

from actr3d.errors import MeshError, WorldError
from actr3d.world.asset_folder import AssetFolder, digest
from actr3d.world.mesh_loading import read_triangles
from actr3d.world.mesh_repair import Surface, surface
from actr3d.world.xml_document import Element, read_document, written

OF_THE_WORLD = ("option", "size", "statistic", "visual", "keyframe")
"""Elements of an MJCF file about the whole world: they are left out, the scene has its own."""

MAX_COPIES = 10_000
"""Greatest number of elements that `<replicate>` may make."""

MAX_COUNTS = {
    "count": 2_500,
    "nrow": 4_096,
    "ncol": 4_096,
    "width": 8_192,
    "height": 8_192,
    "resolution": 8_192,
    "nsample": 10_000,
    "dim": 10_000,
    "actdim": 10_000,
    "num": 1_000,
    "params": 1_000,
}
"""Greatest values of attributes that are counts; for `count`, of the product of its numbers. Without a limit MuJoCo uses all
memory, computes for minutes (a flex of 100 x 100 points: 14 s), or ends the process (a height field of 10^7 x 10^7)."""

TEXTS = frozenset(
    (
        *("name", "class", "childclass", "model", "file", "filename", "mesh", "material", "texture", "hfield", "objname", "refname"),
        *("body", "body1", "body2", "geom", "geom1", "geom2", "joint", "joint1", "joint2", "site", "site1", "site2", "refsite"),
        *("tendon", "tendon1", "tendon2", "cranksite", "slidersite", "sidesite", "actuator", "target", "link", "parent"),
    )
)
"""Attributes that are names, not numbers, whatever they look like."""

MIN_MASS, MIN_INERTIA = 1e-3, 1e-6
"""Default mass and inertia of a moving URDF link [kg, kg m^2]: too little to change how a robot moves."""

_UNSUPPORTED = {"skin": "skins", "model": "models inside models", "attach": "models inside models", "flexcomp": "flexcomp from a file"}
_TEXTURE_FILES = ("file", "fileright", "fileleft", "fileup", "filedown", "filefront", "fileback")
_MOVING = {"revolute", "continuous", "prismatic", "floating", "planar"}


@dataclass
class Document:
    """A description that MuJoCo can read without files."""

    text: str = ""
    """XML, one element per line."""

    origins: list[str] = field(default_factory=list[str])
    """The origin of each line of the text."""

    urdf: bool = False
    """Whether it is URDF, not MJCF."""

    meshes: dict[str, Surface] = field(default_factory=dict[str, Surface])
    """The surfaces, by their file names in the text."""

    assets: dict[str, bytes] = field(default_factory=dict[str, bytes])
    """Textures and height fields, by their file names in the text."""

    remarks: list[str] = field(default_factory=list[str])
    """What was left out or filled in."""


def read_imported(folder: AssetFolder, name: str) -> Document:
    """Reads an MJCF or URDF file and the files that it needs.

    Raises:
        WorldError: If the document or a file cannot be read, or exceeds a limit; with file and line.
    """
    root = read_document(folder, name)
    if root.tag not in ("mujoco", "robot"):
        raise WorldError(f"{root.where}: the root is <{root.tag}>; MJCF has <mujoco>, URDF <robot>")
    document = Document(urdf=root.tag == "robot")
    for element in root.walk():
        if element.tag.startswith("xacro:"):
            raise WorldError(f"{element.where}: <{element.tag}> is a macro of ROS; run xacro on the file first")
        _check_numbers(element)
    if _copies(root) > MAX_COPIES:
        raise WorldError(f"{root.where}: <replicate> makes more than {MAX_COPIES:,} elements")
    if document.urdf:
        _prepare_urdf(root, document)
    else:
        _remove_world_elements(root, document)
    _Assets(root, folder, name, document).load()
    document.text, document.origins = written(root)
    return document


def _check_numbers(element: Element) -> None:
    for attribute, value in element.attributes.items():
        numbers = [] if attribute in TEXTS else _numbers(value)
        says = f'{element.where}: <{element.tag} {attribute}="{value}">'
        if any(map(math.isnan, numbers)):
            raise WorldError(f"{says} is not a number")
        most = MAX_COUNTS.get(attribute, math.inf)
        if any(number > most for number in numbers) or (attribute == "count" and math.prod(numbers) > most):
            raise WorldError(f"{says}: the limit is {most:,}")


def _numbers(value: str) -> list[float]:
    """Returns the numbers among the words of an attribute."""
    numbers: list[float] = []
    for word in value.split():
        try:
            numbers.append(float(word))
        except ValueError:
            continue
    return numbers


def _copies(element: Element) -> float:
    """Returns the number of elements after each `<replicate>` has made its copies."""
    times = max([1, *_numbers(element.attributes.get("count", "1"))]) if element.tag == "replicate" else 1
    return 1 + times * sum(map(_copies, element.children))


def _remove_world_elements(root: Element, document: Document) -> None:
    """Removes elements about the whole world; adds a remark if they would change how things move."""
    options = sorted({name for child in root.children if child.tag == "option" for one in child.walk() for name in one.attributes})
    if options:
        document.remarks.append(f"its <option> ({', '.join(options)}) is left out: the options of the scene apply")
    keys = [one.attributes.get("name", "without a name") for child in root.children if child.tag == "keyframe" for one in child.children]
    if keys:
        document.remarks.append(f"its <keyframe> ({', '.join(keys)}) is left out: it starts in the pose that its bodies describe")
    root.children = [child for child in root.children if child.tag not in OF_THE_WORLD]


def _prepare_urdf(root: Element, document: Document) -> None:
    """Keeps visual geoms and makes each link a body; gives moving links without mass a small one."""
    compiler = next((c for m in root.children if m.tag == "mujoco" for c in m.children if c.tag == "compiler"), None)
    if compiler is None:
        compiler = Element("compiler", {}, root.where)
        root.children.insert(0, Element("mujoco", {}, root.where, [compiler]))
    compiler.attributes |= {"discardvisual": "false", "fusestatic": "false"}
    moving = {
        child.attributes.get("link")
        for joint in root.children
        if joint.tag == "joint" and joint.attributes.get("type") in _MOVING
        for child in joint.children
        if child.tag == "child"
    }
    light = [link for link in root.children if link.tag == "link" and link.attributes.get("name") in moving and _is_without_mass(link)]
    for link in light:
        link.children = [child for child in link.children if child.tag != "inertial"]
        inertia = {axes: str(MIN_INERTIA if axes[1] == axes[2] else 0) for axes in ("ixx", "iyy", "izz", "ixy", "ixz", "iyz")}
        parts = [Element("mass", {"value": str(MIN_MASS)}, link.where), Element("inertia", inertia, link.where)]
        link.children.append(Element("inertial", {}, link.where, parts))
    if light:
        names = ", ".join(f"'{link.attributes['name']}'" for link in light)
        document.remarks.append(f"links that move without a mass are given {MIN_MASS * 1000:g} g: {names}")


def _is_without_mass(link: Element) -> bool:
    masses = [part for child in link.children if child.tag == "inertial" for part in child.children if part.tag == "mass"]
    if masses:
        return not any(any(_numbers(mass.attributes.get("value", ""))) for mass in masses)
    return not any(child.tag == "collision" for child in link.children)


class _Assets:
    """Finds the files that a document mentions, and replaces their names in the document by unique ones."""

    def __init__(self, root: Element, folder: AssetFolder, name: str, document: Document) -> None:
        self._root, self._folder, self._document = root, folder, document
        self._base = posixpath.dirname(name)
        self._compiler: dict[str, str] = {}
        for element in root.walk():
            if element.tag == "compiler":
                self._compiler |= element.attributes
                for attribute in ("meshdir", "texturedir", "assetdir", "strippath"):
                    element.attributes.pop(attribute, None)
                element.attributes["strippath"] = "false"
        if self._compiler.get("settotalmass", "-1") != "-1":
            document.remarks.append("its compiler's settotalmass is left out: masses are as given for each body")

    def load(self) -> None:
        for element in self._root.walk():
            attributes = element.attributes
            if element.tag in _UNSUPPORTED and (element.tag == "attach" or "file" in attributes):
                raise WorldError(f"{element.where}: {_UNSUPPORTED[element.tag]} are not supported; export the model as one file")
            if element.tag == "mesh" and ("file" in attributes or "filename" in attributes):
                self._mesh(element, "filename" if self._document.urdf else "file")
            elif element.tag == "hfield" and "file" in attributes:
                self._hfield(element)
            elif element.tag == "texture" and not self._document.urdf:
                self._texture(element)

    def _mesh(self, element: Element, attribute: str) -> None:
        name = self._place(element.attributes[attribute], "meshdir")
        if name.lower().endswith(".msh"):
            raise WorldError(f"{element.where}: '{name}': the old format .msh is not read; save it as OBJ or STL")
        self._folder.read(name, element.where)
        try:
            triangles = read_triangles(self._folder, name)
            found = surface(triangles.vertices, triangles.faces, name)
        except MeshError as error:
            raise MeshError(f"{element.where}: {error}") from error
        self._document.remarks += [f"{posixpath.basename(name)}: {remark}" for remark in (*triangles.remarks, *found.repairs)]
        stem = posixpath.basename(name).rpartition(".")[0]
        if not self._document.urdf:
            element.attributes.setdefault("name", stem)
            element.attributes.pop("content_type", None)
        key = f"{len(self._document.meshes)}/{stem}.obj"
        element.attributes[attribute] = key
        self._document.meshes[key] = found

    def _hfield(self, element: Element) -> None:
        name = self._place(element.attributes["file"], "meshdir")
        content = self._folder.read(name, element.where)
        if not _check_image(content, name, element.where):
            rows, columns = struct.unpack("<ii", content[:8].ljust(8, b"\0"))
            # MuJoCo does not check these two numbers.
            if not (0 < rows <= MAX_COUNTS["nrow"] and 0 < columns <= MAX_COUNTS["ncol"] and len(content) == 8 + 4 * rows * columns):
                raise WorldError(f"{element.where}: '{name}' is neither PNG nor a height field of MuJoCo's own format, or is cut short")
        self._keep(element, "file", name, content)

    def _texture(self, element: Element) -> None:
        names = {attribute: element.attributes[attribute] for attribute in _TEXTURE_FILES if attribute in element.attributes}
        for attribute, given in names.items():
            name = self._place(given, "texturedir")
            if not self._folder.has(name):
                self._make_plain(element, name)
                return
            content = self._folder.read(name, element.where)
            _check_image(content, name, element.where)
            self._keep(element, attribute, name, content)

    def _make_plain(self, element: Element, name: str) -> None:
        kept = {key: value for key, value in element.attributes.items() if key in ("name", "type", "class")}
        element.attributes = {**kept, "builtin": "flat", "width": "1", "height": "1", "rgb1": "0.6 0.6 0.6"}
        if kept.get("type", "cube") != "2d":
            element.attributes["height"] = "6" if kept.get("type") == "skybox" else "1"
        self._document.remarks.append(f"there is no texture '{name}' ({element.where}): plain grey instead")

    def _keep(self, element: Element, attribute: str, name: str, content: bytes) -> None:
        # Assets of all parts of a scene share one namespace.
        key = f"{digest(((name, content),))[:16]}/{posixpath.basename(name)}"
        element.attributes.setdefault("name", posixpath.basename(name).rpartition(".")[0])
        element.attributes[attribute] = key
        self._document.assets[key] = content

    def _place(self, given: str, directory: str) -> str:
        """Returns the name of a file in the folder, from its name in the document."""
        given = given.replace("\\", "/")
        scheme, separator, rest = given.partition("://")
        if separator and scheme in ("package", "model"):
            # The package's folder may be the folder itself, or inside it.
            return next((place for place in (rest, rest.partition("/")[2]) if self._folder.has(place)), rest)
        given = rest if scheme == "file" and separator else given
        if self._compiler.get("strippath") == "true":
            given = posixpath.basename(given)
        inside = self._compiler.get(directory, self._compiler.get("assetdir", ""))
        return posixpath.normpath(posixpath.join(self._base, inside, given))


def _check_image(content: bytes, name: str, where: str) -> bool:
    """Returns whether a content is a PNG image of permitted size.

    Raises:
        WorldError: If the image would unpack to too much.
    """
    if not content.startswith(b"\x89PNG\r\n\x1a\n") or len(content) < 24:
        return False
    width, height = struct.unpack(">II", content[16:24])
    if width > MAX_COUNTS["width"] or height > MAX_COUNTS["height"]:
        raise WorldError(f"{where}: '{name}' is an image of {width} x {height}; the limit is {MAX_COUNTS['width']} each way")
    return True
