"""Convex parts are computed once and kept in the user's cache folder, also if the cache is damaged or read-only."""

from __future__ import annotations

import os
import sys
from concurrent.futures import ThreadPoolExecutor
from contextlib import ExitStack
from pathlib import Path
from subprocess import PIPE, Popen

import numpy as np
import pytest
from numpy.typing import NDArray
from trimesh import creation

from actr3d.world import convex_decomposition
from actr3d.world.convex_decomposition import convex_parts
from actr3d.world.mesh_repair import Surface, surface


@pytest.fixture
def cache(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Path:
    monkeypatch.setenv("XDG_CACHE_HOME", str(tmp_path))
    return tmp_path / "actr3d" / "convex"


def ring() -> Surface:
    mesh = creation.annulus(0.3, 0.5, 0.4, sections=8)
    return surface(np.asarray(mesh.vertices), np.asarray(mesh.faces), "ring")


def box() -> Surface:
    """Returns a box, which is convex and therefore decomposed fast."""
    mesh = creation.box((0.3, 0.5, 0.4))
    return surface(np.asarray(mesh.vertices), np.asarray(mesh.faces), "box")


def same(one: list[NDArray[np.float64]], other: list[NDArray[np.float64]]) -> bool:
    return len(one) == len(other) and all(a.tobytes() == b.tobytes() for a, b in zip(one, other, strict=True))


def never(*_: object) -> list[NDArray[np.float64]]:
    raise AssertionError("made again")


def test_parts_are_computed_once(cache: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    made = convex_parts(box(), 0.2, 1)
    assert len(list(cache.iterdir())) == 1
    monkeypatch.setattr(convex_decomposition, "_cut", never)
    assert same(convex_parts(box(), 0.2, 1), made)
    for coarseness, seed in ((0.3, 1), (0.2, 2)):
        with pytest.raises(AssertionError, match="made again"):
            convex_parts(box(), coarseness, seed)


def test_a_cache_that_can_only_be_read_is_used(cache: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    made = convex_parts(box(), 0.2, 1)

    def refuse(*_: object) -> None:
        raise PermissionError

    monkeypatch.setattr(convex_decomposition.os, "utime", refuse)
    monkeypatch.setattr(convex_decomposition, "_cut", never)
    assert cache.exists()
    assert same(convex_parts(box(), 0.2, 1), made)


def test_a_broken_file_is_made_again(cache: Path) -> None:
    made = convex_parts(box(), 0.2, 1)
    (file,) = cache.iterdir()
    whole = file.read_bytes()
    for content in (b"", b"short", b"\0" * 400, whole[:-8], whole[:50] + b"x" + whole[51:]):
        file.write_bytes(content)
        assert same(convex_parts(box(), 0.2, 1), made)
        assert file.read_bytes() == whole


def test_parts_are_computed_where_nothing_can_be_written(cache: Path) -> None:
    cache.parent.mkdir()
    cache.write_bytes(b"a file where the folder would be")
    assert len(convex_parts(ring(), 0.2, 1)) > 2


def test_threads_that_write_concurrently_leave_one_complete_file(cache: Path) -> None:
    parts = [np.full((1000, 3), 1.5) for _ in range(20)]
    with ThreadPoolExecutor(8) as pool:
        list(pool.map(convex_decomposition.write_cached, ["name"] * 40, [parts] * 40))
    assert [path.name for path in cache.iterdir()] == ["name"]
    found = convex_decomposition.read_cached("name")
    assert found is not None
    assert same(found, parts)


WRITER = """
import sys
import numpy as np
from actr3d.world import convex_decomposition
mine, other = ([np.full((100_000, 3), value)] for value in map(float, sys.argv[1:]))
print("ready", flush=True)
sys.stdin.readline()
for _ in range(120):
    convex_decomposition.write_cached("name", mine)
    found = convex_decomposition.read_cached("name")
    assert found is not None, "an incomplete file was read"
    assert len(found) == 1 and found[0].tobytes() in (mine[0].tobytes(), other[0].tobytes())
"""


@pytest.mark.slow
def test_processes_that_write_concurrently_never_read_an_incomplete_file(cache: Path) -> None:
    with ExitStack() as stack:
        commands = [[sys.executable, "-c", WRITER, mine, other] for mine, other in (("1", "2"), ("2", "1"))]
        running = [stack.enter_context(Popen(command, stdin=PIPE, stdout=PIPE, stderr=PIPE, text=True)) for command in commands]
        for process in running:
            assert process.stdout is not None
            assert process.stdout.readline() == "ready\n"
        for process in running:  # both are loaded, and begin together
            assert process.stdin is not None
            process.stdin.write("\n")
            process.stdin.flush()
        assert [process.communicate()[1] for process in running] == ["", ""]
    assert [path.name for path in cache.iterdir()] == ["name"]


def test_the_least_recently_used_file_is_removed(cache: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    part = [np.zeros((100, 3))]
    monkeypatch.setattr(convex_decomposition, "MAX_CACHE_BYTES", 8000)
    for number, name in enumerate(("a", "b", "c")):
        convex_decomposition.write_cached(name, part)
        os.utime(cache / name, (number, number))
    assert convex_decomposition.read_cached("a") is not None
    convex_decomposition.write_cached("d", part)
    assert {path.name for path in cache.iterdir()} == {"a", "c", "d"}
    convex_decomposition.write_cached("large", [np.zeros((1000, 3))])
    assert convex_decomposition.read_cached("large") is None
