"""The versions of everything that the rows of an experiment may depend on."""

from __future__ import annotations

from functools import cache
from hashlib import sha256
from importlib.metadata import version
from pathlib import Path

import actr3d
from actr3d.recording.schema import versions

PACKAGES = ("numba", "scipy", "trimesh")
"""Packages with which the camera and the scenes are computed."""
SOURCES = "actr3d sources"
"""The name under which the library's own files are among the versions: a copy of the repository has the same version for a long time."""


@cache
def experiment_versions() -> dict[str, str]:
    """Returns the versions of everything that the rows of an experiment may depend on, by name; see `versions` of recordings."""
    return {**versions(), **{package: version(package) for package in PACKAGES}, SOURCES: folder_digest(Path(actr3d.__file__).parent)}


def folder_digest(folder: Path) -> str:
    """Returns twelve characters that change if a file in the folder of a package does: code or data, not what Python compiles from it."""
    found = sha256()
    for path in sorted(folder.rglob("*")):
        if path.is_file() and "__pycache__" not in path.parts:
            content = path.read_bytes()
            found.update(f"{path.relative_to(folder).as_posix()} {len(content)}\n".encode() + content)
    return found.hexdigest()[:12]
