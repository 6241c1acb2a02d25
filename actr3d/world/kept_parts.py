"""Keeps convex parts, which take seconds to make, in the user's cache folder, by the content that they were made from."""

from __future__ import annotations

import hashlib
import os
import platform
import struct
import tempfile
from importlib.metadata import version
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from actr3d.world.surface import Surface

MAX_BYTES = 256 * 1024 * 1024
"""The most that all that is kept may take [bytes]; then what was not used for longest goes. Ours: some thousand meshes."""

Parts = list[NDArray[np.float64]]


def folder() -> Path:
    """Returns where they are kept: `actr3d/convex` in `$XDG_CACHE_HOME`, or in `~/.cache`."""
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "actr3d" / "convex"


def key(surface: Surface, coarseness: float, seed: int) -> str:
    """Returns the name of the parts of a surface: the sha256 of all that they follow from."""
    whole = hashlib.sha256(f"1 {version('coacd')} {platform.machine()} {coarseness!r} {seed} {surface.vertices.shape}".encode())
    whole.update(np.ascontiguousarray(surface.vertices, dtype=np.float64).tobytes())
    whole.update(np.ascontiguousarray(surface.faces, dtype=np.int64).tobytes())
    return whole.hexdigest()


def kept(name: str) -> Parts | None:
    """Returns the parts of this name, or None where there are none, or the file is not whole."""
    path = folder() / name
    try:
        content = path.read_bytes()
        os.utime(path)
    except OSError:  # not there, or not ours to read: they can be made anew
        return None
    if hashlib.sha256(content[32:]).digest() != content[:32]:
        return None
    (count,) = struct.unpack_from("<q", content, 32)
    sizes = struct.unpack_from(f"<{count}q", content, 40)
    numbers = np.frombuffer(content, dtype="<f8", offset=40 + 8 * count).astype(np.float64).reshape(-1, 3)
    return np.split(numbers, np.cumsum(sizes)[:-1])


def keep(name: str, parts: Parts) -> None:
    """Keeps parts under a name, in one piece whoever else writes, and makes room; where nothing can be written, keeps nothing."""
    payload = struct.pack(f"<{len(parts) + 1}q", len(parts), *map(len, parts)) + np.concatenate(parts).astype("<f8").tobytes()
    if len(payload) > MAX_BYTES:
        return
    temporary = ""
    try:
        folder().mkdir(parents=True, exist_ok=True)
        number, temporary = tempfile.mkstemp(dir=folder(), prefix=".new-")
        with os.fdopen(number, "wb") as file:
            file.write(hashlib.sha256(payload).digest() + payload)
        Path(temporary).replace(folder() / name)
        _make_room()
    except OSError:  # a read-only or full disk: they are only made anew next time
        if temporary:
            Path(temporary).unlink(missing_ok=True)


def _make_room() -> None:
    """Removes what was not used for longest until the rest is small enough."""
    files = sorted(((path.stat().st_mtime_ns, path.stat().st_size, path) for path in folder().iterdir()), reverse=True)
    total = 0
    for _, size, path in files:
        total += size
        if total > MAX_BYTES:
            path.unlink(missing_ok=True)
