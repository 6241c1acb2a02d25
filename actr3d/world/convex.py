"""Cuts a closed surface into convex parts, which is what MuJoCo's contacts are made of."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from actr3d.errors import MeshError
from actr3d.world import kept_parts
from actr3d.world.surface import Surface

MAX_TRIANGLES = 20_000
"""The most triangles of a mesh that is cut; at this size it takes about half a minute."""


def convex_parts(surface: Surface, coarseness: float, seed: int) -> list[NDArray[np.float64]]:
    """Returns the corners of convex parts, (n, 3) each [m], that together fill a surface; the same each time.

    They are kept in the user's cache folder: the next time, reading them takes milliseconds.

    Args:
        surface: Closed; every edge between two triangles.
        coarseness: How far the parts may differ from the surface, as a share of its size.
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
    name = kept_parts.key(surface, coarseness, seed)
    parts = kept_parts.kept(name)
    if parts is None:
        parts = _cut(surface, coarseness, seed)
        kept_parts.keep(name, parts)
    return parts


def _cut(surface: Surface, coarseness: float, seed: int) -> list[NDArray[np.float64]]:
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
