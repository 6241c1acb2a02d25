"""Repairs triangles: reports what it repaired, and raises errors for other defects."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from actr3d.errors import MeshError

MIN_EXTENT, MAX_EXTENT = 1e-4, 1e4
"""The smallest and the largest length of a mesh [m]. Outside this range the file's unit is most likely not the metre."""

_SAME = 1e-7
"""Vertices nearer than this fraction of the length are one. Source: 32-bit numbers, as in binary STL, hold 7 digits."""

_FLAT = 1e-6
"""Fraction of its length below which the thickness of a mesh counts as flat: MuJoCo finds no hull around it."""

Vertices = NDArray[np.float64]
Faces = NDArray[np.int64]


@dataclass(frozen=True, kw_only=True)
class Surface:
    """Repaired triangles: no vertex twice, no triangle twice or without extent, all facing outward if the surface is closed."""

    vertices: Vertices
    """(n, 3) [m]"""

    faces: Faces
    """(m, 3), counterclockwise as seen from outside."""

    closed: bool
    """Whether it encloses a volume: triangles pass every edge equally often in both directions."""

    manifold: bool
    """Whether, in addition, every edge belongs to exactly two triangles."""

    flat: bool
    """Whether all of it lies in one plane."""

    repairs: tuple[str, ...]
    """The repairs, in words."""

    def mass_properties(self, mass: float) -> tuple[Vertices, Vertices]:
        """Returns the centre of mass (3,) [m] and the inertia about it (3, 3) [kg m^2], of a solid of even density.

        If the surface is not closed, the solid is its convex hull.

        Raises:
            MeshError: If it is flat, so that there is no solid.
        """
        import trimesh  # slow to load, and only for meshes

        if self.flat:
            raise MeshError("it is flat: it has no volume to hold a mass")
        whole = trimesh.Trimesh(self.vertices, self.faces, process=False)
        solid = whole if self.closed else whole.convex_hull
        found = trimesh.triangles.mass_properties(solid.triangles, skip_inertia=False)
        return np.asarray(found.center_mass), np.asarray(found.inertia) * (mass / found.mass)


def check_extent(vertices: Vertices, faces: Faces, name: str) -> None:
    """Checks that the length of a mesh is one of objects or rooms.

    Raises:
        MeshError: If it is too small or too large; suggests another unit.
    """
    extent = float(np.ptp(vertices[faces.ravel()], axis=0).max())
    if extent and not MIN_EXTENT <= extent <= MAX_EXTENT:
        large = extent > MAX_EXTENT
        raise MeshError(
            f"'{name}' is {extent:.3g} m long; the {'maximum' if large else 'minimum'} is {MAX_EXTENT if large else MIN_EXTENT:g} m. "
            f"Is its unit the metre? Give scale=…, {'0.001 for millimetres' if large else '1000 for kilometres'}"
        )


def surface(vertices: Vertices, faces: Faces, name: str) -> Surface:
    """Returns repaired triangles.

    Args:
        vertices: (n, 3) [m], finite.
        faces: (m, 3) indices of vertices.
        name: The name of the mesh, for messages.

    Raises:
        MeshError: If no triangle is left, or all of it is a point or a line.
    """
    repairs: list[str] = []
    if float(np.ptp(vertices[faces.ravel()], axis=0).max()) == 0:
        raise MeshError(f"'{name}': all its vertices are one point")
    vertices, faces = _merged(vertices, faces)
    faces = _without_repeats(faces, repairs)
    if not len(faces):
        raise MeshError(f"'{name}': none of its triangles has an area")
    faces = _turned(faces, repairs)
    counts, balanced = _edges(faces)
    closed = bool(balanced.all())
    if not closed:
        faces = _without_slivers(vertices, faces, name, repairs)
    elif _volume(vertices, faces) < 0:
        faces = np.ascontiguousarray(faces[:, ::-1])
        repairs.append("all its triangles faced inwards and are reversed")
    flat = _is_flat(vertices, name)
    used, faces = np.unique(faces, return_inverse=True)
    return Surface(
        vertices=vertices[used],
        faces=faces.reshape(-1, 3),
        closed=closed and not flat,
        manifold=closed and not flat and bool((counts == 2).all()),
        flat=flat,
        repairs=tuple(repairs),
    )


def _merged(vertices: Vertices, faces: Faces) -> tuple[Vertices, Faces]:
    """Merges vertices at one place: STL, among others, repeats each corner for each triangle."""
    used, faces = np.unique(faces, return_inverse=True)
    vertices, faces = vertices[used], faces.reshape(-1, 3)
    step = float(np.ptp(vertices, axis=0).max()) * _SAME
    cells: Faces = np.rint((vertices - vertices.min(axis=0)) / step).astype(np.int64)
    order = np.lexsort(cells.T)
    new = np.ones(len(order), dtype=bool)
    new[1:] = (cells[order[1:]] != cells[order[:-1]]).any(axis=1)
    group = np.empty(len(order), dtype=np.int64)
    group[order] = np.cumsum(new) - 1
    # In the order of the file, so that a mesh without defects stays unchanged.
    first = np.full(int(group.max()) + 1, len(order), dtype=np.int64)
    np.minimum.at(first, group, np.arange(len(order)))
    rank = np.empty_like(first)
    rank[np.argsort(first)] = np.arange(len(first))
    return vertices[np.sort(first)], rank[group][faces]


def _without_repeats(faces: Faces, repairs: list[str]) -> Faces:
    corners = np.sort(faces, axis=1)
    whole = (corners[:, 0] != corners[:, 1]) & (corners[:, 1] != corners[:, 2])
    if not whole.all():
        repairs.append(f"{_count(int((~whole).sum()))} without area left out")
        faces, corners = faces[whole], corners[whole]
    if not len(faces):
        return faces
    _, first = np.unique(corners, axis=0, return_index=True)
    if len(first) < len(faces):
        repairs.append(f"{_count(len(faces) - len(first))} removed as duplicates")
        faces = faces[np.sort(first)]
    return faces


def _count(number: int) -> str:
    return "1 triangle" if number == 1 else f"{number:,} triangles"


def _turned(faces: Faces, repairs: list[str]) -> Faces:
    """Reverses triangles so that neighbours agree; in each connected piece it reverses the smaller part.

    Each triangle is two nodes, unchanged and reversed; an edge of two triangles connects the nodes that agree. A connected
    component is then one consistent choice. A piece whose two choices are connected (a Moebius strip) has none.
    """
    from scipy.sparse import coo_array  # slow to load, and only for meshes
    from scipy.sparse.csgraph import connected_components

    count = len(faces)
    start, end, owner = _directed(faces)
    key = np.minimum(start, end) * (int(faces.max()) + 1) + np.maximum(start, end)
    order = np.argsort(key, kind="stable")
    key, owner, forward = key[order], owner[order], (start < end)[order]
    changes = np.flatnonzero(np.diff(key, prepend=-1, append=-1))
    pairs = changes[:-1][np.diff(changes) == 2]
    one, other = owner[pairs], owner[pairs + 1]
    agree = forward[pairs] != forward[pairs + 1]
    rows = np.concatenate([one, one + count])
    columns = np.concatenate([np.where(agree, other, other + count), np.where(agree, other + count, other)])
    graph = coo_array((np.ones(len(rows), dtype=np.int8), (rows, columns)), shape=(2 * count, 2 * count))
    labels: Faces = connected_components(graph, directed=False)[1]
    kept = np.bincount(labels[:count], minlength=int(labels.max()) + 1)
    as_is, over = labels[:count], labels[count:]
    turn = (kept[as_is] < kept[over]) | ((kept[as_is] == kept[over]) & (as_is > over))
    if turn.any():
        faces = faces.copy()
        faces[turn] = faces[turn][:, ::-1]
        repairs.append(f"{_count(int(turn.sum()))} that faced opposite to their neighbours reversed")
    return faces


def _directed(faces: Faces) -> tuple[Faces, Faces, Faces]:
    """Returns the edges of the triangles: start, end and triangle, (3 m,) each."""
    return faces.ravel(), faces[:, [1, 2, 0]].ravel(), np.repeat(np.arange(len(faces)), 3)


def _edges(faces: Faces) -> tuple[Faces, NDArray[np.bool_]]:
    """Returns for each edge its number of triangles, and whether they pass it equally often in both directions."""
    start, end, _ = _directed(faces)
    key = np.minimum(start, end) * (int(faces.max()) + 1) + np.maximum(start, end)
    _, which, counts = np.unique(key, return_inverse=True, return_counts=True)
    return counts, np.bincount(which, weights=np.where(start < end, 1, -1)) == 0


def _without_slivers(vertices: Vertices, faces: Faces, name: str, repairs: list[str]) -> Faces:
    """Removes triangles whose corners lie in a line. In a closed surface they stay: it would have holes without them."""
    a, b, c = (vertices[faces[:, n]] for n in range(3))
    extent = np.ptp(vertices, axis=0).max()
    wide = np.linalg.norm(np.cross(b - a, c - a), axis=1) > (extent * _SAME) ** 2
    if not wide.any():
        raise MeshError(f"'{name}': none of its triangles has an area")
    if not wide.all():
        repairs.append(f"{_count(int((~wide).sum()))} without area left out")
    return faces[wide]


def _volume(vertices: Vertices, faces: Faces) -> float:
    a, b, c = (vertices[faces[:, n]] - vertices[0] for n in range(3))
    return float(np.einsum("ij,ij->", a, np.cross(b, c))) / 6


def _is_flat(vertices: Vertices, name: str) -> bool:
    """Returns whether all vertices lie in a plane.

    Raises:
        MeshError: If they lie in a line.
    """
    _, widths, _ = np.linalg.svd(vertices - vertices.mean(axis=0), full_matrices=False)
    if widths[1] <= _FLAT * widths[0]:
        raise MeshError(f"'{name}': all its vertices lie in a line")
    return bool(len(widths) < 3 or widths[2] <= _FLAT * widths[0])
