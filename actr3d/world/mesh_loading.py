"""Loads mesh files of every format that trimesh reads, as plain triangles."""

from __future__ import annotations

import io
import re
import struct
import zipfile
from dataclasses import dataclass
from pathlib import PurePosixPath
from typing import Any

import numpy as np
from numpy.typing import NDArray

from actr3d.errors import Actr3dError, MeshError, did_you_mean
from actr3d.world.asset_folder import MAX_BYTES, AssetFolder

MAX_TRIANGLES = 500_000
"""Greatest number of triangles of a mesh. At this size MuJoCo takes about two seconds to compile it; people and rooms need far fewer."""

NEEDS = {"3mf": "lxml and networkx", "dae": "pycollada", "zae": "pycollada", "3dxml": "lxml, networkx and pillow", "xaml": "lxml"}
"""The packages without which trimesh does not read a format; the extra `formats` of this library has those of 3MF and DAE."""

_ARCHIVES = {"3mf", "zae", "3dxml"}
_IMAGES = {".png", ".jpg", ".jpeg", ".webp", ".tga", ".bmp", ".tif", ".tiff", ".ktx2"}
_TEXTS = {"obj", "off", "xyz"}
_UNUSUAL = re.compile(rb"^[ \t]*f[ \t](?:[^\n]*[ \t/])?(?:-|0+(?![0-9]))", re.MULTILINE)
"""Faces of an OBJ file with negative indices, or with index 0."""
_Y_UP = {"glb", "gltf"}


@dataclass(frozen=True, kw_only=True)
class Triangles:
    """The content of a mesh file, unchanged."""

    vertices: NDArray[np.float64]
    """(n, 3), in the file's units and frame, turned so that z is up."""

    faces: NDArray[np.int64]
    """(m, 3) indices of vertices, counterclockwise as seen from outside."""

    colour: tuple[float, float, float, float] | None
    """The plain colour of the largest piece, in 0 to 1; `None` if the file gives none."""

    remarks: tuple[str, ...]
    """Defects of the file, and how they were handled."""


def read_triangles(folder: AssetFolder, name: str, up: str | None = None) -> Triangles:
    """Reads a mesh file, with all its pieces at their places in its scene.

    Args:
        folder: The folder of it and of the files that it mentions.
        name: Its name in the folder.
        up: "y" or "z", the file's axis that points up; `None` is y for glTF (Source: glTF 2.0, 3.4), otherwise z.

    Raises:
        MeshError: If it is not a mesh, is truncated, has no triangles, refers to missing vertices, or is too large.
    """
    from trimesh.exchange import load  # takes about a second, and is only needed for meshes

    content = folder.read(name)
    kind, content, remarks = _kind(content, name)
    beside = _Beside(folder, name)
    try:
        scene = load.load_scene(io.BytesIO(content), file_type=kind, resolver=beside, process=False)
        pieces = _pieces(scene, name)
    except Actr3dError:
        raise
    except RecursionError as error:
        raise MeshError(f"'{name}': its pieces are nested without end") from error
    except Exception as error:  # a parser may raise anything for invalid content
        raise MeshError(f"'{name}' cannot be read as {kind}: {beside.why or error}") from error
    if not pieces:
        raise MeshError(f"'{name}' has no triangles: {_what_instead(scene, content)}")
    vertices = np.concatenate([piece.vertices for piece in pieces]).astype(np.float64)
    starts = np.cumsum([0, *(len(piece.vertices) for piece in pieces[:-1])])
    faces = np.concatenate([piece.faces + start for piece, start in zip(pieces, starts, strict=True)]).astype(np.int64)
    _check_numbers(vertices, faces, name)
    if (up or ("y" if kind in _Y_UP else "z")) == "y":
        vertices = vertices[:, [0, 2, 1]] * (1.0, -1.0, 1.0)
    if beside.missed:
        remarks.append(f"its file '{beside.missed}' cannot be read; it is drawn in its plain colour")
    return Triangles(vertices=vertices, faces=faces, colour=_colour(pieces), remarks=tuple(remarks))


class _Beside:
    """Provides trimesh with the files that a mesh mentions, from its folder; notes a missing one. No image is read."""

    def __init__(self, folder: AssetFolder, name: str) -> None:
        self._folder, self._name = folder, name
        self.missed = ""
        self.why = ""

    def get(self, key: str) -> bytes:
        if PurePosixPath(key).suffix.lower() in _IMAGES:
            raise KeyError(f"'{key}': textures are not used")
        try:
            return self._folder.read(str(PurePosixPath(self._name).parent / key), self._name)
        except MeshError as error:
            self.missed, self.why = key, str(error).removeprefix(f"{self._name}: ")
            raise KeyError(key) from error

    __getitem__ = get


def _kind(content: bytes, name: str) -> tuple[str, bytes, list[str]]:
    """Returns trimesh's name of the format, the content for its reader, and remarks."""
    if not content:
        raise MeshError(f"'{name}' is empty")
    kind = PurePosixPath(name).suffix.lower().removeprefix(".")
    seen = _by_content(content)
    remarks: list[str] = []
    if seen and seen != kind and kind not in _ARCHIVES:
        remarks.append(f"its content is {seen.upper()}, not what its name says: read as {seen.upper()}")
        kind = seen
    _check_readable(kind, name)
    if kind == "stl":
        content, kind = _stl(content, name, remarks)
    elif kind in _ARCHIVES:
        _check_archive(content, name)
    elif kind in _TEXTS:
        content = _as_text(content)
        if kind == "obj" and _UNUSUAL.search(content):
            content = _counted_forwards(content, name)
    return kind, content, remarks


def _by_content(content: bytes) -> str:
    """Returns the format that the content itself names, or an empty string."""
    for start, kind in ((b"glTF", "glb"), (b"ply\n", "ply"), (b"ply\r", "ply"), (b"OFF", "off"), (b"PK\x03\x04", "zip")):
        if content.startswith(start):
            return kind
    return "stl" if len(content) > 84 and len(content) == _stl_size(content) else ""


def _check_readable(kind: str, name: str) -> None:
    from trimesh.exchange import load

    formats: set[str] = load.mesh_formats() - {"stl_ascii"}
    if kind == "zip":
        raise MeshError(f"'{name}' is an archive, not a mesh: unpack it")
    if kind in NEEDS and kind not in formats:
        raise MeshError(f"'{name}': trimesh reads {kind.upper()} only with {NEEDS[kind]}; install actr3d[formats]")
    if kind not in formats:
        raise MeshError(f"'{name}': '.{kind}' is not a mesh format; known are {', '.join(sorted(formats))}{did_you_mean(kind, formats)}")


def _stl_size(content: bytes) -> int:
    return 84 + 50 * int(struct.unpack("<I", content[80:84])[0])


def _stl(content: bytes, name: str, remarks: list[str]) -> tuple[bytes, str]:
    """Returns the content and its format, binary or text: trimesh tries both, and its message may be about the wrong one."""
    size = _stl_size(content) if len(content) >= 84 else 0
    if content.lstrip()[:5].lower() == b"solid" and size != len(content):
        if b"endsolid" not in content[-1000:].lower():
            raise MeshError(f"'{name}' is cut short: there is no 'endsolid' at its end")
        return _as_text(content), "stl_ascii"
    if not size or b"\0" not in content[:200]:
        raise MeshError(f"'{name}' is not STL: neither 'solid' at its start nor a binary header")
    triangles = (size - 84) // 50
    if len(content) < size:
        raise MeshError(f"'{name}' is cut short: {triangles:,} triangles take {size:,} bytes, it has {len(content):,}")
    if len(content) > size:
        remarks.append(f"{len(content) - size} bytes after its last triangle are left out")
    return content[:size], "stl"


def _as_text(content: bytes) -> bytes:
    """Returns text in UTF-8; older programs write names of pieces in Latin-1."""
    try:
        content.decode()
    except UnicodeDecodeError:
        return content.decode("latin-1").encode()
    return content


def _counted_forwards(content: bytes, name: str) -> bytes:
    """Returns OBJ text whose faces have positive indices. Negative ones count back from the last vertex before the face, but trimesh
    counts from the last of the file."""
    known = {b"v": 0, b"vt": 0, b"vn": 0}
    lines = content.replace(b"\\\n", b"  ").split(b"\n")
    for number, line in enumerate(lines):
        words = line.partition(b"#")[0].split()
        if words and words[0] in known:
            known[words[0]] += 1
        elif words and words[0] == b"f":
            lines[number] = b" ".join([b"f", *(_corner(word, known, f"'{name}', line {number + 1}") for word in words[1:])])
    return b"\n".join(lines)


def _corner(word: bytes, known: dict[bytes, int], where: str) -> bytes:
    """Returns a corner of a face, `vertex/texture/normal`, with positive indices."""
    parts = word.split(b"/")
    if parts[0].isdigit() and int(parts[0]) == 0:
        raise MeshError(f"{where}: a triangle refers to vertex 0; OBJ files count from 1")
    for n, count in enumerate(list(known.values())[: len(parts)]):
        if parts[n][:1] == b"-" and parts[n][1:].isdigit():
            if int(parts[n]) < -count:
                raise MeshError(f"{where}: a triangle refers to number {int(parts[n])} of {count} before it")
            parts[n] = b"%d" % (count + 1 + int(parts[n]))
    return b"/".join(parts)


def _check_archive(content: bytes, name: str) -> None:
    """Raises an error for an archive that unpacks to too much. A zip file never unpacks to more than its stated sizes."""
    try:
        with zipfile.ZipFile(io.BytesIO(content)) as archive:
            size = sum(entry.file_size for entry in archive.infolist())
    except zipfile.BadZipFile as error:
        raise MeshError(f"'{name}' is not a complete archive: {error}") from error
    if size > MAX_BYTES:
        raise MeshError(f"'{name}' unpacks to {size:,} bytes; the limit is {MAX_BYTES:,}")


def _pieces(scene: Any, name: str) -> list[Any]:
    """Returns the meshes of a scene at their places, largest first."""
    counts = [len(getattr(scene.geometry[scene.graph[node][1]], "faces", ())) for node in scene.graph.nodes_geometry]
    if sum(counts) > MAX_TRIANGLES:
        raise MeshError(f"'{name}' has {sum(counts):,} triangles; the limit is {MAX_TRIANGLES:,}: simplify it")
    for each in scene.geometry.values():
        if hasattr(each, "faces"):
            _check_numbers(np.asarray(each.vertices), np.asarray(each.faces), name)
    pieces = [piece for piece in scene.dump() if len(getattr(piece, "faces", ()))]
    return sorted(pieces, key=lambda piece: len(piece.faces), reverse=True)


def _check_numbers(vertices: NDArray[Any], faces: NDArray[Any], name: str) -> None:
    if len(faces) and (faces.min() < 0 or faces.max() >= len(vertices)):
        wrong = int(np.flatnonzero(((faces < 0) | (faces >= len(vertices))).any(axis=1))[0])
        raise MeshError(f"'{name}': triangle {wrong} refers to vertex {faces[wrong].tolist()}; there are {len(vertices)} vertices")
    used = vertices[np.unique(faces)]
    if not np.isfinite(used).all():
        wrong = int(np.flatnonzero(~np.isfinite(used).all(axis=1))[0])
        raise MeshError(f"'{name}': a vertex is not finite: {used[wrong].tolist()}")


def _what_instead(scene: Any, content: bytes) -> str:
    points = sum(len(getattr(each, "vertices", ())) for each in scene.geometry.values())
    if points:
        return f"only {points:,} points or lines"
    return "is it a mesh file at all?" if b"v " not in content[:10_000] else "only points or lines"


def _colour(pieces: list[Any]) -> tuple[float, float, float, float] | None:
    visual = pieces[0].visual
    if not visual.defined:
        return None
    source = visual.material if visual.kind == "texture" else visual
    red, green, blue, alpha = (float(value) / 255 for value in source.main_color)
    # A wholly transparent mesh would be invisible, and rays would ignore it.
    return (red, green, blue, alpha) if alpha > 0 else None
