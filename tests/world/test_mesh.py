"""Meshes of every format have the right place, appearance and contacts; broken files are refused with a reason."""

from __future__ import annotations

import hashlib
import io
import json
import os
import struct
import subprocess
import sys
import zipfile
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest
import trimesh
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from actr3d.errors import Actr3dError, MeshError, ModelWarning
from actr3d.world import Floor, Mesh, Scene, SimpleObject, World
from actr3d.world.asset_folder import AssetFolder, digest
from actr3d.world.mesh_repair import surface
from tests.helpers.small_agents import near

creation: Any = trimesh.creation
linalg: Any = np.linalg
FORMATS = ["stl", "stl_ascii", "obj", "ply", "off", "glb", "3mf", "dae"]

TETRAHEDRON = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n"
"""As OBJ; volume 1/6."""


def wedge() -> Any:
    """Returns a tetrahedron without any symmetry, so that every turn, flip and shift shows."""
    return trimesh.Trimesh(
        [[0.1, 0.2, 0.3], [1.1, 0.2, 0.4], [0.2, 2.2, 0.3], [0.3, 0.4, 3.3]], [[0, 2, 1], [0, 1, 3], [0, 3, 2], [1, 2, 3]]
    )


def written(folder: Path, mesh: Any, kind: str) -> Path:
    data = mesh.export(file_type=kind)
    path = folder / f"mesh.{kind.removesuffix('_ascii')}"
    path.write_bytes(data.encode() if isinstance(data, str) else data)
    return path


def file(folder: Path, content: str | bytes, name: str = "mesh.obj") -> Path:
    path = folder / name
    path.write_bytes(content.encode() if isinstance(content, str) else content)
    return path


def rays(world: World, starts: NDArray[Any], ways: NDArray[Any]) -> list[tuple[float, str]]:
    """Returns the length of each ray [m] (-1 is a miss), and the geom that it hits."""
    world.refresh()
    found: list[tuple[float, str]] = []
    for start, way in zip(starts, ways, strict=True):
        geom = np.zeros(1, dtype=np.int32)
        distance = mujoco.mj_ray(world.mj_model, world.mj_data, start, way, None, 1, -1, geom, None)
        found.append((distance, world.mj_model.geom(geom[0]).name if distance >= 0 else ""))
    return found


def random_rays(count: int = 300) -> tuple[NDArray[Any], NDArray[Any]]:
    random = np.random.default_rng(3)
    starts = random.normal(size=(count, 3))
    starts *= 8 / np.linalg.norm(starts, axis=1, keepdims=True)
    ways = random.normal(size=(count, 3)) * 0.8 + (0.5, 0.8, 1.0) - starts
    return starts, ways / np.linalg.norm(ways, axis=1, keepdims=True)


def nearest(mesh: Any, starts: NDArray[Any], ways: NDArray[Any]) -> NDArray[Any]:
    """Returns the length of each ray to the triangles [m], -1 for a miss, in closed form for each triangle (Cramer's rule)."""
    best = np.full(len(starts), np.inf)
    for a, b, c in np.asarray(mesh.triangles):
        system = np.stack([np.broadcast_to(b - a, ways.shape), np.broadcast_to(c - a, ways.shape), -ways], axis=-1)
        solved: Any = linalg.solve(system, (starts - a)[..., None])
        u, v, t = (solved[:, n, 0] for n in range(3))
        hit = (u >= 0) & (v >= 0) & (u + v <= 1) & (t >= 0)
        best = np.where(hit & (t < best), t, best)
    return np.where(np.isfinite(best), best, -1)


@pytest.mark.parametrize("kind", FORMATS)
def test_every_format_is_seen_where_its_triangles_are(kind: str, tmp_path: Path) -> None:
    starts, ways = random_rays()
    world = World(Scene(parts=(Mesh(name="wedge", path=written(tmp_path, wedge(), kind), up="z"),)))
    expected = nearest(wedge(), starts, ways)
    seen = rays(world, starts, ways)
    assert 30 < sum(expected >= 0) < 270
    assert [distance for distance, _ in seen] == near(expected, abs=1e-5)
    assert {name for _, name in seen} == {"wedge", ""}, "rays pass the shapes for contacts"


def test_it_is_scaled_turned_and_placed_exactly(tmp_path: Path) -> None:
    path, starts_ways = written(tmp_path, wedge(), "stl"), random_rays()
    quaternion = np.array([0.5, -0.1, 0.7, 0.3])
    placed = Mesh(name="w", path=path, scale=(0.5, 2, 1.5), position=(0.4, -0.3, 0.2), quaternion=tuple(quaternion * 3))
    turn: Any = trimesh.transformations.quaternion_matrix(quaternion)
    expected = wedge().apply_transform(np.diag([0.5, 2, 1.5, 1])).apply_transform(turn).apply_translation((0.4, -0.3, 0.2))
    seen = [distance for distance, _ in rays(World(Scene(parts=(placed,))), *starts_ways)]
    assert seen == near(nearest(expected, *starts_ways), abs=1e-5)
    headed = Mesh(name="w", path=path, heading=0.7)
    turn = trimesh.transformations.rotation_matrix(0.7, (0, 0, 1))
    seen = [distance for distance, _ in rays(World(Scene(parts=(headed,))), *starts_ways)]
    assert seen == near(nearest(wedge().apply_transform(turn), *starts_ways), abs=1e-5)


def test_gltf_stands_upright_and_its_scene_is_put_together(tmp_path: Path) -> None:
    scene: Any = trimesh.Scene()
    box = creation.box((1, 1, 1))
    for number, height in enumerate((0.5, 2.5)):
        scene.add_geometry(
            box, geom_name="box", node_name=f"n{number}", transform=trimesh.transformations.translation_matrix((0, height, 0))
        )
    for name, data in scene.export(file_type="gltf").items():
        (tmp_path / name).write_bytes(data)
    for path in (written(tmp_path, scene, "glb"), tmp_path / "model.gltf"):
        mesh = Mesh(name="tower", path=path)
        world = World(Scene(parts=(mesh,)))
        down = rays(world, np.array([[0.1, 0.2, 9.0], [0.1, 9.0, 0.5], [0.1, 9, 1.5]]), np.array([[0, 0, -1.0], [0, -1, 0], [0, -1, 0]]))
        assert [distance for distance, _ in down] == near([6, 8.5, -1], abs=1e-6)
    assert len(mesh.files or ()) > 1, "the buffers beside it are part of its files"


@pytest.mark.parametrize("kind", FORMATS)
def test_mass_and_inertia_are_those_of_the_solid(kind: str, tmp_path: Path) -> None:
    box = creation.box((0.2, 0.4, 0.6)).apply_translation((0.3, 0, 0))
    world = World(Scene(parts=(Mesh(name="b", path=written(tmp_path, box, kind), mass=3.0, up="z"),)))
    body = world.mj_model.body("b")
    assert body.mass[0] == near(3.0)
    assert body.ipos == near([0.3, 0, 0], abs=1e-6)
    assert sorted(body.inertia) == near(sorted([3 / 12 * (0.16 + 0.36), 3 / 12 * (0.04 + 0.36), 3 / 12 * (0.04 + 0.16)]), rel=1e-5)


def rest(tmp_path: Path, collision: str) -> float:
    """Returns the height at which a ball rests that fell into a ring of 0.3 m inner radius and 0.4 m height [m]."""
    path = written(tmp_path, creation.annulus(0.3, 0.5, 0.4).apply_translation((0, 0, 0.2)), "stl")
    ring = Mesh.from_mapping({"name": "ring", "path": path, "collision": collision})
    ball = SimpleObject(name="ball", shape="sphere", size=(0.1,), position=(0.01, 0, 0.7))
    world = World(Scene(parts=(Floor(), ring, ball)))
    world.step(1500)
    world.refresh()
    return world.mj_data.body("ball").xpos[2]


@pytest.mark.slow
def test_a_ball_falls_into_a_ring_of_parts_lies_on_its_hull_and_passes_no_collision(tmp_path: Path) -> None:
    assert rest(tmp_path, "parts") == near(0.1, abs=5e-3)
    assert rest(tmp_path, "hull") == near(0.5, abs=5e-3)
    assert rest(tmp_path, "none") == near(0.1, abs=5e-3)


@pytest.mark.slow
def test_parts_hold_a_ball_inside_a_bowl(tmp_path: Path) -> None:
    outer, inner = creation.cylinder(0.5, 0.4, sections=16), creation.cylinder(0.4, 0.4, sections=16)
    # A bowl of triangles: walls outside and inside, a rim between the two, a bottom for each.
    outer_top, inner_top = 0.2, 0.2
    angles = np.arange(16) * np.pi / 8
    circle = np.stack([np.cos(angles), np.sin(angles)], axis=1)
    rings = [(0.5, -0.2), (0.5, outer_top), (0.4, inner_top), (0.4, -0.1)]
    vertices = [(*(xy * radius), z) for radius, z in rings for xy in circle] + [(0, 0, -0.2), (0, 0, -0.1)]
    faces = [
        triangle
        for ring in range(3)
        for n in range(16)
        for a, b in [(ring * 16 + n, ring * 16 + (n + 1) % 16)]
        for triangle in ((a, b, b + 16), (a, b + 16, a + 16))
    ]
    faces += [(64, (n + 1) % 16, n) for n in range(16)] + [(65, 48 + n, 48 + (n + 1) % 16) for n in range(16)]
    bowl: Any = trimesh.Trimesh(vertices, faces)
    assert bowl.is_volume
    assert bowl.volume < outer.volume - 0.6 * inner.volume
    mesh = Mesh(name="bowl", path=written(tmp_path, bowl, "ply"), collision="parts", position=(0, 0, 1))
    ball = SimpleObject(name="ball", shape="sphere", size=(0.1,), position=(0.2, 0, 1.6))
    world = World(Scene(parts=(mesh, ball)))
    world.step(3000)
    world.refresh()
    assert world.mj_data.body("ball").xpos[2] == near(1.0, abs=0.03), "on the bottom inside, 0.1 below the origin of the bowl"


@pytest.mark.slow
def test_parts_are_the_same_in_every_process(tmp_path: Path) -> None:
    path = written(tmp_path, creation.annulus(0.3, 0.5, 0.4, sections=8), "stl")
    code = (
        "import hashlib, sys; from actr3d.world import *\n"
        "world = World(Scene(parts=(Mesh(name='m', path=sys.argv[1], collision='parts', seed=4),)))\n"
        "print(world.mj_model.ngeom, hashlib.sha256(world.mj_model.mesh_vert.tobytes()).hexdigest())"
    )
    run = [sys.executable, "-c", code, str(path)]
    caches = [{**os.environ, "XDG_CACHE_HOME": str(tmp_path / name)} for name in ("one", "other", "other")]
    first, second, kept = (subprocess.run(run, capture_output=True, text=True, check=True, env=env).stdout for env in caches)
    assert first == second == kept
    assert int(first.split()[0]) > 2


def test_a_file_is_read_once_and_what_was_read_makes_the_same_world(tmp_path: Path) -> None:
    path = written(tmp_path, wedge(), "stl")
    content = path.read_bytes()
    mesh = Mesh(name="m", path=path, mass=1)
    path.unlink()
    again = Mesh(name="m", path="elsewhere/mesh.stl", files=mesh.files, mass=1)
    assert mesh.files == (("mesh.stl", content),)
    assert mesh.digest == again.digest == digest((("mesh.stl", content),)) != digest((("mesh.stl", content + b"x"),))
    assert replace(mesh, scale=2.0).digest == mesh.digest
    assert hashlib.sha256(b"8:mesh.stl" + f"{len(content)}:".encode() + content).hexdigest() == mesh.digest
    one, other = (World(Scene(parts=(part, Floor()))) for part in (mesh, again))
    one.step(200)
    other.step(200)
    assert one.state().mj_state.tobytes() == other.state().mj_state.tobytes()


def test_the_colour_is_the_file_s_own(tmp_path: Path) -> None:
    file(tmp_path, "newmtl red\nKd 1 0 0\n", "m.mtl")
    path = file(tmp_path, "mtllib m.mtl\nusemtl red\n" + TETRAHEDRON)
    colours = [World(Scene(parts=(Mesh(name="m", path=path, colour=colour),))).mj_model.geom("m").rgba for colour in (None, (0, 1, 0, 1))]
    assert colours == [near([1, 0, 0, 1]), near([0, 1, 0, 1])]


def stl(triangles: int, content: int | None = None) -> bytes:
    one = struct.pack("<12fH", 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0)
    return b"binary".ljust(80, b"\0") + struct.pack("<I", triangles) + one * (triangles if content is None else content)


def gltf(**parts: Any) -> str:
    return json.dumps({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}], **parts})


def bomb() -> bytes:
    packed = io.BytesIO()
    with zipfile.ZipFile(packed, "w", zipfile.ZIP_DEFLATED) as archive, archive.open("3D/3dmodel.model", "w") as entry:
        for _ in range(257):
            entry.write(b" " * 1024 * 1024)
    return packed.getvalue()


def ply(vertices: str, faces: str) -> str:
    rows, triangles = vertices.splitlines(), faces.splitlines()
    head = f"ply\nformat ascii 1.0\nelement vertex {len(rows)}\nproperty float x\nproperty float y\nproperty float z\n"
    return (
        head + f"element face {len(triangles)}\nproperty list uchar int vertex_indices\nend_header\n" + "\n".join([*rows, *triangles, ""])
    )


BROKEN: list[tuple[str, Callable[[], str | bytes], str]] = [
    ("mesh.stl", lambda: b"", r"'mesh\.stl' is empty"),
    ("mesh.stl", lambda: stl(12, 7), r"'mesh\.stl' is cut short: 12 triangles take 684 bytes, it has 434"),
    ("mesh.stl", lambda: stl(0), r"'mesh\.stl' has no triangles"),
    ("mesh.stl", lambda: "Dear all,\nthis is not a mesh.\n" * 9, r"'mesh\.stl' is not STL: neither 'solid' at its start nor"),
    (
        "mesh.stl",
        lambda: "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0",
        r"'mesh\.stl' is cut short: there is no 'endsolid'",
    ),
    ("mesh.obj", lambda: "Dear all,\nthis is not a mesh.\n" * 9, r"'mesh\.obj' has no triangles: is it a mesh file at all"),
    ("mesh.obj", lambda: TETRAHEDRON.split("f")[0], r"'mesh\.obj' has no triangles: only 4 points or lines"),
    ("mesh.obj", lambda: TETRAHEDRON.replace("f 2 3 4", "f 2 3 9"), r"'mesh\.obj' cannot be read as obj: index 8 is out of bounds"),
    (
        "mesh.obj",
        lambda: TETRAHEDRON.replace("f 2 3 4", "f 0 1 2"),
        r"'mesh\.obj', line 8: a triangle refers to vertex 0; OBJ files count from 1",
    ),
    ("mesh.obj", lambda: TETRAHEDRON.replace("f 2 3 4", "f 2 3 -5"), r"line 8: a triangle refers to number -5 of 4 before it"),
    ("mesh.ply", lambda: ply("0 0 0\n1 0 0\n0 1 0\n0 0 1", "3 0 1 7\n3 0 1 2"), r"refers to vertex \[0, 1, 7\]; there are 4 vertices"),
    ("mesh.ply", lambda: ply("0 0 0\n1 0 0\n0 1 0\n0 0 1", "3 0 1 -7\n3 0 1 2"), r"triangle 0 refers to vertex \[0, 1, -7\]"),
    ("mesh.obj", lambda: TETRAHEDRON.replace("v 0 0 1", "v 0 0 nan"), r"'mesh\.obj': a vertex is not finite: \[0\.0, 0\.0, nan\]"),
    ("mesh.obj", lambda: TETRAHEDRON.replace("v 0 0 1", "v 0 inf 1"), r"'mesh\.obj': a vertex is not finite: \[0\.0, inf, 1\.0\]"),
    ("mesh.obj", lambda: TETRAHEDRON.replace("v 0 0 1", "v 0 x 1"), r"'mesh\.obj' cannot be read as obj"),
    ("mesh.obj", lambda: "v 1 1 1\n" * 3 + "f 1 2 3\n", r"'mesh\.obj': all its vertices are one point"),
    ("mesh.obj", lambda: "v 0 0 0\nv 1 1 1\nv 3 3 3\nf 1 2 3\n", r"'mesh\.obj': none of its triangles has an area"),
    ("mesh.obj", lambda: "v 0 0 0\nv 1 0 0\nf 1 2 1\nf 2 2 1\n", r"'mesh\.obj': none of its triangles has an area"),
    ("mesh.obj", lambda: TETRAHEDRON.replace("v 0 0 1", "v 0 0 0"), r"is flat: it has no volume; leave it fixed, with collision='none'"),
    ("mesh.obj", lambda: TETRAHEDRON.replace("v 0 0 1", "v 0 0 70000"), r"is 7e\+04 m long; the maximum is 10000 m\. Is its unit"),
    ("mesh.obj", lambda: TETRAHEDRON.replace("v 0 0 1", "v 0 0 1e30"), r"is 1e\+30 m long; the maximum is 10000 m"),
    ("mesh.obj", lambda: TETRAHEDRON.replace("v 1", "v 1e-5").replace("0 1", "0 1e-5").replace("1 0", "1e-5 0"), r"minimum is 0\.0001 m"),
    ("mesh.off", lambda: "OFF\n4 1 0\n0 0 0\n1 0 0\n", r"'mesh\.off' cannot be read as off"),
    ("mesh.ply", lambda: "ply\nformat ascii 1.0\n", r"'mesh\.ply' cannot be read as ply"),
    ("mesh.ply", lambda: wedge().export(file_type="ply")[:-9], r"'mesh\.ply' cannot be read as ply: PLY is unexpected length"),
    (
        "mesh.ply",
        lambda: wedge().export(file_type="ply").replace(b"element vertex 4", b"element vertex 4000000000000"),
        r"'mesh\.ply' cannot be read as ply",
    ),
    ("mesh.glb", lambda: wedge().export(file_type="glb")[:-90], r"'mesh\.glb' cannot be read as glb"),
    ("mesh.glb", lambda: b"{}", r"'mesh\.glb' cannot be read as glb"),
    ("mesh.gltf", lambda: gltf(nodes=[{"children": [1]}, {"children": [0]}]), r"'mesh\.gltf' has no triangles"),
    (
        "mesh.gltf",
        lambda: gltf(
            nodes=[{"mesh": 0}],
            meshes=[{"primitives": [{"attributes": {"POSITION": 0}}]}],
            buffers=[{"uri": "gone.bin", "byteLength": 36}],
            bufferViews=[{"buffer": 0, "byteLength": 36}],
            accessors=[{"bufferView": 0, "count": 3, "type": "VEC3", "componentType": 5126}],
        ),
        r"'mesh\.gltf' cannot be read as gltf: no file 'gone\.bin'",
    ),
    ("mesh.gltf", lambda: gltf(buffers=[{"uri": "../secret.bin", "byteLength": 36}]), r"'\.\./secret\.bin' lies outside the folder"),
    ("mesh.3mf", bomb, r"'mesh\.3mf' unpacks to 269,484,032 bytes; the limit is 268,435,456"),
    ("mesh.3mf", lambda: b"PK\x03\x04 and no more", r"'mesh\.3mf' is not a complete archive"),
    ("mesh.zip", lambda: b"PK\x03\x04", r"'mesh\.zip' is an archive, not a mesh: unpack it"),
    ("mesh.step", lambda: "ISO-10303-21;", r"'\.step' is not a mesh format; known are .*glb"),
    ("mesh.stk", lambda: "solid", r"'\.stk' is not a mesh format; .*did you mean 'stl'\?"),
    ("mesh.dae", lambda: "<COLLADA>", r"'mesh\.dae' cannot be read as dae"),
    ("mesh.xyz", lambda: "0 0 0\n1 0 0\n0 1 0\n", r"'mesh\.xyz' has no triangles: only 3 points or lines"),
]


@pytest.mark.parametrize(("name", "content", "message"), BROKEN, ids=[f"{n}-{case[0]}" for n, case in enumerate(BROKEN)])
def test_broken_files_are_refused_with_a_reason(name: str, content: Callable[[], str | bytes], message: str, tmp_path: Path) -> None:
    path = file(tmp_path, content(), name)
    with pytest.raises(MeshError, match=message):
        Mesh(name="m", path=path)


def repaired(path: Path, message: str, **options: Any) -> World:
    with pytest.warns(ModelWarning, match=message) as caught:
        mesh = Mesh.from_mapping({"name": "m", "path": path, **options})
    assert [warning.filename for warning in caught] == [__file__], "the warning names the modeller's line"
    return World(Scene(parts=(mesh,)))


REPAIRED: list[tuple[str, Callable[[], str | bytes], str]] = [
    ("mesh.obj", lambda: TETRAHEDRON + "f 1 3 2\nf 3 2 1\n", r"Mesh 'm' \(mesh\.obj\): 2 triangles removed as duplicates"),
    ("mesh.obj", lambda: TETRAHEDRON + "f 1 1 2\n", "1 triangle without area left out"),
    ("mesh.obj", lambda: TETRAHEDRON.replace("f 1 3 2", "f 1 2 3"), "1 triangle that faced opposite to their neighbours reversed"),
    (
        "mesh.obj",
        lambda: (
            TETRAHEDRON.replace("f 1 3 2", "f 2 3 1")
            .replace("f 1 2 4", "f 2 1 4")
            .replace("f 1 4 3", "f 4 1 3")
            .replace("f 2 3 4", "f 3 2 4")
        ),
        "all its triangles faced inwards and are reversed",
    ),
    (
        "mesh.obj",
        lambda: "mtllib gone.mtl\nusemtl red\n" + TETRAHEDRON,
        r"its file 'gone\.mtl' cannot be read; it is drawn in its plain colour",
    ),
    ("mesh.stl", lambda: wedge().export(file_type="stl") + b"\0" * 7, "7 bytes after its last triangle are left out"),
    ("mesh.stl", lambda: wedge().export(file_type="ply"), "its content is PLY, not what its name says: read as PLY"),
    ("mesh.txt", lambda: wedge().export(file_type="glb"), "its content is GLB, not what its name says: read as GLB"),
]


@pytest.mark.parametrize(("name", "content", "message"), REPAIRED, ids=[f"{n}-{case[0]}" for n, case in enumerate(REPAIRED)])
def test_repairs_are_made_with_a_warning(name: str, content: Callable[[], str | bytes], message: str, tmp_path: Path) -> None:
    world = repaired(file(tmp_path, content(), name), message, mass=1)
    assert (world.mj_model.nmeshface, world.mj_model.nmeshvert) == (4, 4)
    assert min(world.mj_model.body("m").inertia) > 0


def test_a_mesh_with_a_hole_has_the_mass_and_contacts_of_its_hull(tmp_path: Path) -> None:
    box = creation.box((1, 1, 1))
    open_box = trimesh.Trimesh(box.vertices, box.faces[:-1])
    path = written(tmp_path, open_box, "ply")
    world = repaired(path, r"it is not closed \(watertight\): contacts and mass are those of its convex hull", mass=6)
    assert world.mj_model.body("m").inertia == near([1, 1, 1], rel=1e-6)
    assert Mesh(name="m", path=path, collision="none").digest, "there is no warning where nothing depends on it"
    with pytest.raises(MeshError, match=r"Mesh 'm' \(mesh\.ply\): only a closed surface, .* can be cut into parts"):
        Mesh(name="m", path=path, collision="parts")


def test_corners_may_be_counted_backwards(tmp_path: Path) -> None:
    far = "v 10 0 0\nv 11 0 0\nv 10 1 0\nv 10 0 1\n"
    forwards = TETRAHEDRON + far + "f 5 7 6\nf 5 6 8\nf 5 8 7\nf 6 7 8\n"
    backwards = TETRAHEDRON + far + "f -4 -2 \\\n -3 # first\nf -4/ -3 -1//\nf -4 -1 -2\n\tf -3 -2 -1\n"
    worlds = [
        World(Scene(parts=(Mesh(name="m", path=file(tmp_path, text, name)),)))
        for name, text in (("one.obj", forwards), ("two.obj", backwards))
    ]
    assert worlds[0].mj_model.nmeshface == 8
    assert worlds[0].fingerprint == worlds[1].fingerprint


@pytest.mark.parametrize("content", ["v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n"])
def test_a_flat_sheet_is_seen_from_both_sides(content: str, tmp_path: Path) -> None:
    path = file(tmp_path, content)
    world = World(Scene(parts=(Mesh(name="m", path=path, collision="none", position=(0, 0, 1)),)))
    seen = rays(world, np.array([[0.3, 0.2, 3.0], [0.3, 0.2, 0.0]]), np.array([[0, 0, -1.0], [0, 0, 1]]))
    assert [distance for distance, _ in seen] == near([2, 1], abs=1e-6)


def test_a_hollow_keeps_its_inside(tmp_path: Path) -> None:
    outer, inner = creation.box((2, 2, 2)), creation.box((1, 1, 1))
    inner.invert()
    mesh: Any = trimesh.util.concatenate([outer, inner])
    world = World(Scene(parts=(Mesh(name="m", path=written(tmp_path, mesh, "ply"), mass=7),)))
    assert world.mj_model.body("m").inertia == near([(8 * 8 - 1 * 2) / 12] * 3, rel=1e-6)


def test_many_triangles_are_refused_by_number(tmp_path: Path) -> None:
    path = file(tmp_path, stl(500_001), "mesh.stl")
    with pytest.raises(MeshError, match=r"'mesh\.stl' has 500,001 triangles; the limit is 500,000: simplify it"):
        Mesh(name="m", path=path)
    box = creation.icosphere(5)
    with pytest.raises(MeshError, match=r"has 20,480 triangles; to cut it into parts the limit is 20,000"):
        Mesh(name="m", path=written(tmp_path, box, "ply"), collision="parts")


def test_instances_are_counted_before_they_are_made(tmp_path: Path) -> None:
    scene: Any = trimesh.Scene()
    scene.add_geometry(creation.icosphere(4), geom_name="ball")
    glb = scene.export(file_type="glb")
    header = json.loads(glb[20 : 20 + struct.unpack("<I", glb[12:16])[0]])
    mesh_node = next(node for node in header["nodes"] if "mesh" in node)
    header["nodes"] = [{"children": list(range(1, 2001))}, *({"mesh": mesh_node["mesh"], "translation": [n, 0, 0]} for n in range(2000))]
    header["scenes"] = [{"nodes": [0]}]
    text = json.dumps(header).encode()
    text += b" " * (-len(text) % 4)
    binary = glb[20 + struct.unpack("<I", glb[12:16])[0] :]
    whole = b"glTF" + struct.pack("<II", 2, 20 + len(text) + len(binary)) + struct.pack("<I", len(text)) + b"JSON" + text + binary
    with pytest.raises(MeshError, match=r"has 10,240,000 triangles; the limit is 500,000"):
        Mesh(name="m", path=file(tmp_path, whole, "mesh.glb"))


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"path": "gone.stl"}, r"no file 'gone\.stl' in the folder .*; did you mean 'one\.stl'"),
        ({"path": "."}, r"it is a folder|no file"),
        ({"path": "one.stl", "scale": 0}, r"Mesh\.scale: must be > 0"),
        ({"path": "one.stl", "scale": (1, 1, -1)}, r"Mesh\.scale"),
        ({"path": "one.stl", "collision": "part"}, r"must be one of 'hull', 'parts', 'none' \(got 'part'\); did you mean 'parts'"),
        ({"path": "one.stl", "quaternion": (0, 0, 0, 0)}, r"Mesh 'm': give a heading, or a quaternion that is not 0"),
        ({"path": "one.stl", "quaternion": (1, 0, 0, 0), "heading": 1}, r"Mesh 'm': give a heading, or a quaternion"),
        ({"path": "one.stl", "files": (("two.stl", b""),)}, r"'two\.stl' is empty"),
        ({"path": "link.stl"}, r"'link\.stl' lies outside the folder 'here'"),
        ({"path": "loop.stl"}, r"'loop\.stl' cannot be read: Symlink loop|no file 'loop\.stl'"),
        ({"path": "loop.stl/one.stl"}, r"loop\.stl' is not a readable path: Symlink loop|no file 'one\.stl'"),
    ],
)
def test_wrong_descriptions_are_refused(options: dict[str, Any], message: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    here = tmp_path / "here"
    here.mkdir()
    written(tmp_path, wedge(), "stl").rename(here / "one.stl")
    (here / "loop.stl").symlink_to(here / "loop.stl")
    (here / "link.stl").symlink_to(file(tmp_path, stl(1), "outside.stl"))
    monkeypatch.chdir(here)
    with pytest.raises(Actr3dError, match=message):
        Mesh.from_mapping({"name": "m", **options})


def test_files_together_have_a_limit(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("actr3d.world.asset_folder.MAX_BYTES", 100)
    file(tmp_path, b"x" * 60, "a")
    file(tmp_path, b"x" * 60, "b")
    file(tmp_path, b"x" * 101, "c")
    folder = AssetFolder(tmp_path, MeshError)
    folder.read("a")
    with pytest.raises(MeshError, match=r"a: 'c' has 101 bytes; the limit is 100"):
        folder.read("c", "a")
    with pytest.raises(MeshError, match=r"'b': the files have 120 bytes together; the limit is 100"):
        folder.read("b")


@pytest.mark.parametrize("times", [4, pytest.param(30, marks=pytest.mark.slow)])
def test_no_bytes_crash_the_process(tmp_path: Path, times: int) -> None:
    """Files with a few bytes changed, cut or doubled either make a world or a `MeshError`; in a separate process."""
    for kind in ("stl", "obj", "ply", "off", "glb"):
        written(tmp_path, wedge(), kind)
    code = """
import random, sys, warnings
from pathlib import Path
from actr3d.errors import MeshError
from actr3d.world import Mesh, Scene, World
warnings.simplefilter("ignore")
random.seed(5)
made = refused = 0
for path in sorted(Path(sys.argv[1]).iterdir()):
    whole = path.read_bytes()
    for _ in range(int(sys.argv[2])):
        data = bytearray(whole)
        for _ in range(random.choice((1, 2, 8))):
            data[random.randrange(len(data))] = random.choice((0, 45, 48, 57, 127, 255, random.randrange(256)))
        if random.random() < 0.2:
            data = data[: random.randrange(len(data))]
        try:
            World(Scene(parts=(Mesh(name="m", path=path, files=((path.name, bytes(data)),), mass=1),)))
            made += 1
        except MeshError:
            refused += 1
print(made, refused)
"""
    run = subprocess.run([sys.executable, "-c", code, str(tmp_path), str(times)], capture_output=True, text=True)
    assert run.returncode == 0, run.stderr[-2000:]
    made, refused = map(int, run.stdout.split()[-2:])
    assert made + refused == 5 * times
    assert min(made, refused) > 20 * times // 30


@given(st.data())
def test_triangles_in_any_order_and_turned_at_random_come_out_as_one_surface(data: st.DataObject) -> None:
    ball = creation.icosphere(1)
    faces = np.array(data.draw(st.permutations(ball.faces.tolist())))
    turned = np.array(data.draw(st.lists(st.booleans(), min_size=len(faces), max_size=len(faces))))
    faces[turned] = faces[turned][:, ::-1]
    # Each triangle has corners of its own, as in STL.
    found = surface(ball.vertices[faces].reshape(-1, 3), np.arange(faces.size).reshape(-1, 3), "ball")
    assert (found.closed, found.manifold, len(found.vertices)) == (True, True, len(ball.vertices))
    whole: Any = trimesh.Trimesh(found.vertices, found.faces, process=False)
    assert whole.volume == near(ball.volume, rel=1e-9)


def test_a_moebius_strip_has_no_outside_and_is_unchanged() -> None:
    angles = np.linspace(0, 2 * np.pi, 12, endpoint=False)
    vertices = np.array(
        [
            ((1 + side * np.cos(t / 2)) * np.cos(t), (1 + side * np.cos(t / 2)) * np.sin(t), side * np.sin(t / 2))
            for t in angles
            for side in (-0.3, 0.3)
        ]
    )
    faces = [f for n in range(11) for f in ((2 * n, 2 * n + 1, 2 * n + 2), (2 * n + 1, 2 * n + 3, 2 * n + 2))] + [(22, 23, 1), (23, 0, 1)]
    found = surface(vertices, np.array(faces), "strip")
    assert (found.closed, found.flat, found.repairs) == (False, False, ())


def test_a_scene_without_meshes_does_not_wait_for_the_packages_that_read_them() -> None:
    code = (
        "import sys; from actr3d.world import *; World(Scene(parts=(Floor(),))); print({'trimesh', 'scipy', 'coacd'} & sys.modules.keys())"
    )
    assert subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True).stdout == "set()\n"
