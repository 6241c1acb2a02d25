"""Cuts a closed surface into convex parts, from which MuJoCo computes contacts; caches them, because it takes seconds."""

from __future__ import annotations

import hashlib
import os
import platform
import struct
import tempfile
from contextlib import suppress
from importlib.metadata import version
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from actr3d.errors import MeshError
from actr3d.world.mesh_repair import Surface

MAX_TRIANGLES = 20_000
"""Greatest number of triangles of a mesh that can be cut; at this size it takes about half a minute."""

MAX_CACHE_BYTES = 256 * 1024 * 1024
"""Greatest size of the cache [bytes]; beyond it the least recently used files are removed. Source: chosen, some thousand meshes."""

Parts = list[NDArray[np.float64]]


def convex_parts(surface: Surface, coarseness: float, seed: int) -> Parts:
    """Returns the corners of convex parts, (n, 3) each [m], that together fill a surface; the same each time.

    They are cached in the user's cache folder: reading them the next time takes milliseconds.

    Args:
        surface: Closed; every edge between two triangles.
        coarseness: How far the parts may differ from the surface, as a fraction of its size.
        seed: Of the search for good cuts.

    Raises:
        MeshError: If the surface cannot be cut: it is open, or has too many triangles.

    Source: X. Wei et al. (2022), Approximate convex decomposition for 3D meshes with collision-aware concavity and tree
    search, ACM Transactions on Graphics 41(4).
    """
    # CoACD ends the process on an empty mesh and takes minutes over an open one, so it is given neither.
    if not surface.manifold:
        raise MeshError("only a closed surface, each edge between two triangles, can be cut into parts; close it, or take collision='hull'")
    if len(surface.faces) > MAX_TRIANGLES:
        raise MeshError(f"it has {len(surface.faces):,} triangles; to cut it into parts the limit is {MAX_TRIANGLES:,}: simplify it")
    name = cache_key(surface, coarseness, seed)
    parts = read_cached(name)
    if parts is None:
        parts = _cut(surface, coarseness, seed)
        write_cached(name, parts)
    return parts


def _cut(surface: Surface, coarseness: float, seed: int) -> Parts:
    import coacd  # slow to load, and only for meshes

    coacd.set_log_level("error")
    mesh = coacd.Mesh(surface.vertices, surface.faces)
    pieces = coacd.run_coacd(mesh, threshold=coarseness, preprocess_mode="off", seed=seed)
    parts = [np.asarray(vertices, dtype=np.float64) for vertices, _ in pieces]
    solid = [part for part in parts if _has_volume(part)]
    if not solid:
        raise MeshError("it cannot be cut into parts; take collision='hull'")
    return solid


def _has_volume(part: NDArray[np.float64]) -> bool:
    from scipy.spatial import ConvexHull, QhullError

    try:
        return float(ConvexHull(part).volume) > 1e-12
    except (QhullError, ValueError):
        return False


# -- the cache


def cache_folder() -> Path:
    """Returns the folder of the cache: `actr3d/convex` in `$XDG_CACHE_HOME`, or in `~/.cache`."""
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "actr3d" / "convex"


def cache_key(surface: Surface, coarseness: float, seed: int) -> str:
    """Returns the file name of the parts of a surface: the sha256 of all that they depend on."""
    whole = hashlib.sha256(f"1 {version('coacd')} {platform.machine()} {coarseness!r} {seed} {surface.vertices.shape}".encode())
    whole.update(np.ascontiguousarray(surface.vertices, dtype=np.float64).tobytes())
    whole.update(np.ascontiguousarray(surface.faces, dtype=np.int64).tobytes())
    return whole.hexdigest()


def read_cached(name: str) -> Parts | None:
    """Returns the parts of this name, or None if there are none, or the file is damaged."""
    path = cache_folder() / name
    try:
        content = path.read_bytes()
    except OSError:  # missing or not readable: they can be made again
        return None
    with suppress(OSError):  # it is not writable
        os.utime(path)
    if hashlib.sha256(content[32:]).digest() != content[:32]:
        return None
    (count,) = struct.unpack_from("<q", content, 32)
    sizes = struct.unpack_from(f"<{count}q", content, 40)
    numbers = np.frombuffer(content, dtype="<f8", offset=40 + 8 * count).astype(np.float64).reshape(-1, 3)
    return np.split(numbers, np.cumsum(sizes)[:-1])


def write_cached(name: str, parts: Parts) -> None:
    """Writes parts under a name, atomically, and limits the size of the cache; does nothing if the folder is not writable."""
    payload = struct.pack(f"<{len(parts) + 1}q", len(parts), *map(len, parts)) + np.concatenate(parts).astype("<f8").tobytes()
    if len(payload) > MAX_CACHE_BYTES:
        return
    temporary = ""
    try:
        cache_folder().mkdir(parents=True, exist_ok=True)
        number, temporary = tempfile.mkstemp(dir=cache_folder(), prefix=".new-")
        with os.fdopen(number, "wb") as file:
            file.write(hashlib.sha256(payload).digest() + payload)
        Path(temporary).replace(cache_folder() / name)
        _limit_cache()
    except OSError:  # a read-only or full disk: they are made again next time
        if temporary:
            Path(temporary).unlink(missing_ok=True)


def _limit_cache() -> None:
    """Removes the least recently used files until the rest is small enough."""
    files = sorted(((path.stat().st_mtime_ns, path.stat().st_size, path) for path in cache_folder().iterdir()), reverse=True)
    total = 0
    for _, size, path in files:
        total += size
        if total > MAX_CACHE_BYTES:
            path.unlink(missing_ok=True)
