"""What a camera promises beside exactness: labels that tell nothing, live changes, plain errors, no side effects."""

from __future__ import annotations

import copy
import gc
import math
import os
import pickle
import shutil
import subprocess
import sys
import tracemalloc
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from actr3d import jit
from actr3d.camera import CameraParameters, GeometricCamera
from actr3d.camera.kernel import SOURCES
from actr3d.errors import CameraError, ConfigurationError, ModelWarning
from tests.helpers.camera_scenes import compiled, mujoco, seen
from tests.helpers.copies import COPIED

BALL = '<geom name="ball" type="sphere" size=".3" pos="3 0 1.5"/>'
CROWD = [
    '<body name="{0}1" pos="4 1 1.5"><geom type="box" size=".3 .3 .3"/></body>',
    '<body name="{0}2" pos="4 .7 1.5"><geom type="box" size=".3 .3 .2"/><geom type="sphere" size=".2" pos="0 0 .3"/></body>',
    '<body name="{0}3" pos="3 -1 1.7" euler="10 20 30"><geom name="{0}z" type="capsule" size=".2 .3"/></body>',
    '<geom name="{0}4" type="cylinder" size=".3 .5" pos="3.5 -1.2 1.5"/>',
    '<geom name="{0}5" type="ellipsoid" size=".3 .5 .1" pos="5 0 1.5"/>',
]
"""Two of them have faces in one plane."""


def labels(view: Any) -> list[int]:
    return view.as_array()["label"].tolist()


def test_names_and_order_of_the_scene_change_nothing() -> None:
    scenes = [("a", CROWD), ("box", CROWD[::-1]), ("q", CROWD[2:] + CROWD[:2])]
    views = [seen("".join(thing.format(name) for thing in things))[1].as_array() for name, things in scenes]
    assert len(views[0]) > 100
    assert views[0].tobytes() == views[1].tobytes() == views[2].tobytes()


def test_labels_are_given_in_the_order_of_appearance_and_kept() -> None:
    mj_model, mj_data = compiled("".join(thing.format("a") for thing in CROWD))
    camera = GeometricCamera(mj_model, site="eye")
    first = labels(camera.look(mj_data))
    seen_so_far: list[int] = []
    for label in first:
        if label not in seen_so_far:
            seen_so_far.append(label)
    assert seen_so_far == [1, 2, 3, 4, 5]
    kept = camera.label_of("a5")
    mj_model.geom_pos[mj_model.geom("a5").id] = 2, 0, 2.5  # now the topmost
    mujoco.mj_forward(mj_model, mj_data)
    assert labels(camera.look(mj_data))[0] == kept == camera.label_of("a5")


def test_labels_can_be_taken_up_again() -> None:
    mj_model, mj_data = compiled("".join(thing.format("a") for thing in CROWD))
    camera, later = GeometricCamera(mj_model, site="eye"), GeometricCamera(mj_model, site="eye")
    mj_model.geom_rgba[mj_model.geom("a4").id, 3] = 0
    camera.look(mj_data)
    before = camera.state()
    assert pickle.loads(pickle.dumps(before)) == before
    mj_model.geom_rgba[mj_model.geom("a4").id, 3] = 1
    later.restore(before)
    assert labels(later.look(mj_data)) == labels(camera.look(mj_data))
    assert labels(GeometricCamera(mj_model, site="eye").look(mj_data)) != labels(camera.look(mj_data))
    with pytest.raises(CameraError, match=r"restore: the state is of a camera with 2 objects, not 5"):
        camera.restore((1, 1, 0))


def test_a_view_says_the_same_in_both_forms() -> None:
    _, view = seen("".join(thing.format("a") for thing in CROWD), rows=12)
    told = view.as_dict()
    assert list(told) == [(row + 0.5) / 12 for row in range(12)]
    assert {} in told.values()
    array = view.as_array()
    flat = [(y, label, *extent) for y, row in told.items() for label, some in row.items() for extent in some]
    assert sorted(flat) == sorted(array[["y", "label", "x1", "x2", "d1", "d2", "a1", "a2"]].tolist())
    assert (array["y"] == (array["row"] + 0.5) / 12).all()
    with pytest.raises(ValueError, match="read-only"):
        array["x1"] = 0
    told.clear()
    assert view.as_dict() != {}


def test_looking_writes_nothing() -> None:
    mj_model, mj_data = compiled("".join(thing.format("a") for thing in CROWD))
    camera = GeometricCamera(mj_model, site="eye")
    before = pickle.dumps(mj_data)
    view = camera.look(mj_data).as_array().tobytes()
    assert pickle.dumps(mj_data) == before
    assert camera.look(mj_data).as_array().tobytes() == view


def test_a_view_stays_as_it_was() -> None:
    mj_model, mj_data = compiled(BALL)
    camera = GeometricCamera(mj_model, site="eye", parameters=CameraParameters(rows=9))
    view = camera.look(mj_data)
    before = view.as_array().tobytes()
    mj_model.geom_size[0, 0] = 0.5
    assert camera.look(mj_data).as_array().tobytes() != before
    assert view.as_array().tobytes() == before


def test_live_changes_are_seen() -> None:
    mocap = '<body name="wall" mocap="true" pos="3 0 1.5"><geom type="box" size=".1 .5 1"/></body>'
    mj_model, mj_data = compiled(mocap)
    camera = GeometricCamera(mj_model, site="eye", parameters=CameraParameters(rows=1))

    def edges() -> list[float]:
        mujoco.mj_kinematics(mj_model, mj_data)
        return [edge for row in camera.look(mj_data).as_array() for edge in (row["x1"], row["x2"])]

    assert edges() == pytest.approx([0.5 - 0.25 / 2.9, 0.5 + 0.25 / 2.9])
    mj_data.mocap_pos[0] = 3, 0.5, 1.5
    assert edges() == pytest.approx([0.5 - 0.5 / 2.9, 0.5])
    mj_model.geom_size[0, 1] = 0.25
    assert edges() == pytest.approx([0.5 - 0.375 / 2.9, 0.5 - 0.125 / 3.1])
    mj_model.geom_rgba[0, 3] = 0
    assert edges() == []


def test_heights_are_read_at_each_look() -> None:
    land = '<hfield name="land" nrow="4" ncol="4" size="1 1 1 .1" elevation="0 0 0 0 0 1 1 0 0 1 1 0 0 0 0 0"/>'
    mj_model, mj_data = compiled('<geom type="hfield" hfield="land" pos="4 0 1"/>', land)
    camera = GeometricCamera(mj_model, site="eye", parameters=CameraParameters(rows=1))
    assert len(camera.look(mj_data).as_array()) == 1
    mj_model.hfield_data[:] = 0
    assert len(camera.look(mj_data).as_array()) == 0


@pytest.mark.parametrize("alpha", [0, 1])
def test_a_material_may_be_transparent(alpha: int) -> None:
    material = f'<material name="m" rgba="1 1 1 {alpha}"/>'
    _, view = seen('<geom type="sphere" size=".3" pos="3 0 1.5" material="m"/>', material)
    assert (len(view.as_array()) > 0) == bool(alpha)


def test_groups_of_geoms_can_be_left_out() -> None:
    world = '<body><geom type="sphere" size=".3" pos="3 0 1.5" group="3"/><geom type="sphere" size=".2" pos="3 0 1.5" group="2"/></body>'
    wide, narrow = (seen(world, rows=1, groups=groups)[1].as_array()[0] for groups in (None, (0, 1, 2)))
    assert wide["x1"] < narrow["x1"]


BODY = (
    '<body name="torso" pos="0 0 1"><geom name="trunk" type="box" size=".1 .2 .5"/><site name="eye" pos=".2 0 .5"/>'
    '<body pos=".5 .3 .4"><geom name="left" type="capsule" size=".05 .3"/></body>'
    '<body pos=".5 -.3 .4"><geom name="right" type="capsule" size=".05 .3"/></body></body>'
)


def test_own_limbs_are_looked_through_or_seen_one_by_one() -> None:
    mj_model, mj_data = compiled(BODY + '<body pos="2 0 1.5"><geom name="a" type="sphere" size=".1"/></body>', eye="<light/>")
    blind = GeometricCamera(mj_model, site="eye")
    assert set(labels(blind.look(mj_data))) == {blind.label_of("a")} == {1}
    aware = GeometricCamera(mj_model, site="eye", parameters=CameraParameters(own_limbs=True))
    assert set(labels(aware.look(mj_data))) == {1, 2, 3}
    assert {aware.label_of("a"), aware.label_of("left"), aware.label_of("right"), aware.label_of("trunk")} == {1, 2, 3, None}


def test_more_extents_than_there_is_room_for_at_first() -> None:
    fence = "".join(f'<geom type="box" size=".01 .01 1" pos="2 {y} 1.5"/>' for y in np.linspace(-1.5, 1.5, 90))
    assert len(seen(fence, rows=5)[1].as_array()) == 5 * 90


@pytest.mark.slow
def test_no_memory_is_lost() -> None:
    mj_model, mj_data = compiled(BALL)
    camera = GeometricCamera(mj_model, site="eye", parameters=CameraParameters(rows=10))

    def growth(looks: int) -> int:
        gc.collect()
        before = tracemalloc.get_traced_memory()[0]
        for _ in range(looks):
            camera.look(mj_data)
        gc.collect()
        return tracemalloc.get_traced_memory()[0] - before

    tracemalloc.start()
    try:
        growth(4_000)  # Python keeps some small objects in store
        # Less than a byte a look, where no other thread has taken some; of fewer looks, what Python keeps by itself would count too much.
        assert any(growth(8_000) < 8_000 for _ in range(3))
    finally:
        tracemalloc.stop()


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({}, r"name one of camera, site or body to look from \(got none\)"),
        ({"site": "eye", "body": "world"}, r"\(got site='eye', body='world'\)"),
        ({"site": "eyes"}, "no site 'eyes'; did you mean 'eye'"),
        ({"site": ""}, "no site ''; there are: eye"),
        ({"camera": "front"}, "no camera 'front'; this model has no named camera"),
        ({"site": "eye", "parameters": CameraParameters(background=("bal",))}, "background: no geom 'bal'; did you mean 'ball'"),
    ],
)
def test_what_does_not_exist_is_named(given: dict[str, Any], message: str) -> None:
    mj_model, _ = compiled(BALL)
    with pytest.raises(CameraError, match=message):
        GeometricCamera(mj_model, **given)


WRONG: dict[str, tuple[Any, ...]] = {
    "horizontal_fov": (0, -1, math.pi, math.nan, "wide", True),
    "vertical_fov": (math.inf,),
    "rows": (0, 1.5, -3, 10**6, None),
    "precision": (-1e-9, 1, math.nan),
    "near": (-1, math.inf, math.nan),
    "range": (0, -1, math.nan),
    "retinotopic": (1,),
    "e2": (0,),
    "own_limbs": ("yes",),
    "background": ("floor", (1,)),
    "groups": ((6,), (-1,), 3, ("a",)),
}


@pytest.mark.parametrize(("field", "value"), [(field, value) for field, values in WRONG.items() for value in values])
def test_wrong_parameters_are_reported(field: str, value: Any) -> None:
    with pytest.raises(ConfigurationError, match=rf"CameraParameters\.{field}.*: must be .* \(got "):
        CameraParameters(**{field: value})


def test_poses_must_be_there_and_be_numbers() -> None:
    mj_model, mj_data = compiled(BALL)
    camera = GeometricCamera(mj_model, site="eye")
    with pytest.raises(CameraError, match=r"the pose of the site 'eye' was not computed; call mujoco\.mj_forward"):
        camera.look(mujoco.MjData(mj_model))
    mj_data.geom_xpos[0, 1] = math.nan
    with pytest.raises(CameraError, match="the pose of geom 'ball' is not a number"):
        camera.look(mj_data)
    mj_data.site_xpos[0, 1] = math.inf
    with pytest.raises(CameraError, match="the pose of the site 'eye' is not a number"):
        camera.look(mj_data)
    _, other = compiled(BALL + '<geom size=".1"/>')
    with pytest.raises(CameraError, match="mj_data belongs to another model: 2 geoms, not 1"):
        camera.look(other)
    with pytest.raises(CameraError, match="label_of: no geom 'bell'"):
        camera.label_of("bell")


def test_an_empty_world_is_seen_as_empty() -> None:
    _, view = seen("", rows=3)
    assert view.as_dict() == {0.5 / 3: {}, 1.5 / 3: {}, 2.5 / 3: {}}


def test_a_distance_field_is_seen_as_its_mesh() -> None:
    ring = """<mujoco><extension><plugin plugin="mujoco.sdf.torus"><instance name="t"><config key="radius1" value="0.35"/>
      <config key="radius2" value="0.15"/></instance></plugin></extension><asset><mesh name="m"><plugin instance="t"/></mesh></asset>
      <worldbody><site name="eye"/><body pos="2 .3 0" euler="0 90 0"><geom name="ring" type="sdf" mesh="m"><plugin instance="t"/></geom>
      </body><geom name="wall" type="box" pos="4 0 0" size=".1 3 3"/></worldbody></mujoco>"""
    mj_model = mujoco.MjModel.from_xml_string(ring)
    mj_data = mujoco.MjData(mj_model)
    mujoco.mj_forward(mj_model, mj_data)
    camera = GeometricCamera(mj_model, site="eye", parameters=CameraParameters(rows=1))
    ((_, extents),) = camera.look(mj_data).as_dict().items()
    edges: list[float] = []
    for y in (0.3 + 0.35, 0.3 - 0.35):  # the two circles that the row's plane cuts
        half = math.asin(0.15 / math.hypot(2, y))
        edges += [0.5 - math.tan(math.atan2(y, 2) + side * half) / 2 for side in (1, -1)]
    ring_label, wall_label = camera.label_of("ring") or 0, camera.label_of("wall") or 0
    found = extents[ring_label]
    assert [edge for extent in found for edge in extent[:2]] == pytest.approx(edges, abs=1e-4)
    assert len(extents[wall_label]) == 3, "it is seen through the hole and on both sides"


def test_the_library_is_imported_without_the_camera() -> None:
    code = "import sys, actr3d, actr3d.actr, actr3d.cli; print(sorted({'numba', 'numpy', 'mujoco'} & set(sys.modules)))"
    assert subprocess.run([sys.executable, "-c", code], check=True, capture_output=True, text=True).stdout == "[]\n"


@pytest.mark.slow
def test_linear_algebra_is_loaded_for_functions_that_need_it_only() -> None:
    lines = ("import sys, numba, numpy; from actr3d.jit import compile_cached", "loaded = lambda: 'scipy.linalg' in sys.modules")
    lines += ("print(compile_cached(lambda a: a + 1)(1), loaded())", "print(numba.njit(lambda a: a @ a)(numpy.eye(1))[0, 0], loaded())")
    done = subprocess.run([sys.executable, "-c", "\n".join(lines)], check=True, capture_output=True, text=True)
    assert done.stdout == "2 False\n1.0 True\n"


def test_code_that_cannot_be_kept_on_disk_runs_all_the_same(tmp_path: Path) -> None:
    lines = [
        "from actr3d.jit import compile_cached",
        "add = compile_cached(lambda a, b: a + b)",
        "print(add(1, 2), type(add._cache).__name__)",
    ]
    (tmp_path / "adding.py").write_text("\n".join(lines))
    for places, cache in (("InTreeCacheLocator", "FunctionCache"), ("ZipCacheLocator", "NullCache")):
        run = [sys.executable, str(tmp_path / "adding.py")]
        environment = {**os.environ, "NUMBA_CACHE_LOCATOR_CLASSES": places}
        assert subprocess.run(run, check=True, capture_output=True, text=True, env=environment).stdout == f"3 {cache}\n"


@pytest.mark.slow
def test_a_cache_that_cannot_be_read_any_more_is_not_read(tmp_path: Path) -> None:
    lines = ["import sys", "from actr3d import jit"]
    lines += ["jit.sources_digest = lambda *sources: int(sys.argv[2])", "shape = __import__(sys.argv[1])"]
    lines += ["def first(size): return size.width", "print(jit.compile_cached(first)(shape.Size(2)))"]
    (tmp_path / "sizes.py").write_text("\n".join(lines))

    def run(module: str, digest: int) -> str:
        (tmp_path / f"{module}.py").write_text("from typing import NamedTuple\nclass Size(NamedTuple):\n    width: int\n")
        command = [sys.executable, str(tmp_path / "sizes.py"), module, str(digest)]
        output = subprocess.run(command, check=True, capture_output=True, text=True).stdout
        (tmp_path / f"{module}.py").unlink()
        return output

    assert run("old", 1) == "2\n"  # the cache has a type of a module that is gone then
    assert run("new", 2) == "2\n"


def test_old_code_is_not_used_after_any_file_has_changed(tmp_path: Path) -> None:
    copy = Path(shutil.copytree(SOURCES, tmp_path / "kernel"))
    before = jit.sources_digest(copy)
    assert before == jit.sources_digest(SOURCES)
    with (copy / "roots.py").open("a") as file:
        file.write("# changed\n")
    assert jit.sources_digest(copy) != before


@pytest.mark.daily(3)
@pytest.mark.parametrize(("shape", "size"), [("cylinder", 2), ("capsule", 2), ("ellipsoid", 3), ("box", 3), ("sphere", 1)])
def test_of_two_things_that_coincide_the_same_one_is_seen_everywhere(shape: str, size: int) -> None:
    random = np.random.default_rng(1)
    for _ in range(40):
        sizes = " ".join(str(value) for value in random.uniform(0.1, 0.5, size))
        twin = f'<geom type="{shape}" size="{sizes}" pos="3 {random.uniform(-1, 1)} 1.5" euler="{random.uniform(0, 90)} 50 0"/>'
        crowd = [f'<geom type="sphere" size=".4" pos="{random.uniform(3, 5)} {random.uniform(-2, 2)} 1.5"/>' for _ in range(4)]
        _, one = seen(twin + "".join(crowd) + twin, rows=20)
        _, other = seen("".join(reversed(crowd)) + twin + twin, rows=20)
        _, alone = seen(twin + "".join(crowd), rows=20)
        assert one.as_dict() == other.as_dict() == alone.as_dict()


def test_a_skin_is_named_and_its_body_seen() -> None:
    text = """<mujoco><worldbody><site name="eye"/><body name="torso" pos="3 0 0"><geom size=".1"/></body></worldbody>
      <deformable><skin name="cloak" vertex="0 0 0 0 1 0 0 0 1" face="0 1 2">
      <bone body="torso" bindpos="0 0 0" bindquat="1 0 0 0" vertid="0 1 2" vertweight="1 1 1"/></skin></deformable></mujoco>"""
    mj_model = mujoco.MjModel.from_xml_string(text)
    mj_data = mujoco.MjData(mj_model)
    mujoco.mj_forward(mj_model, mj_data)
    with pytest.warns(ModelWarning, match="the Geometric Camera does not see skin 'cloak': add a geom to each object that should be seen"):
        camera = GeometricCamera(mj_model, site="eye", parameters=CameraParameters(rows=3))
    assert {label for row in camera.look(mj_data).as_dict().values() for label in row} == {1}


def test_what_it_cannot_see_is_named() -> None:
    text = """<mujoco><worldbody><site name="eye"/><body name="cloth" pos="3 0 0">
      <flexcomp name="sheet" type="grid" count="3 3 1" spacing="1 1 1" dim="2" mass="1" radius="0.01">
      <edge equality="true"/></flexcomp></body>
      </worldbody></mujoco>"""
    with pytest.warns(ModelWarning, match="the Geometric Camera does not see flex 'sheet': add a geom to each object that should be seen"):
        GeometricCamera(mujoco.MjModel.from_xml_string(text), site="eye")


@pytest.mark.parametrize("copied", COPIED)
def test_a_copy_of_a_camera_sees_the_changes_of_its_own_model(copied: Callable[[Any], Any]) -> None:
    mj_model, mj_data = compiled(BALL)
    camera = GeometricCamera(mj_model, site="eye", parameters=CameraParameters(rows=9))
    before = camera.look(mj_data).as_dict()
    other, model = (copied(camera), mj_model) if copied is copy.copy else copied((camera, mj_model))
    assert other.state() == camera.state()
    model.geom_size[0] *= 0.5
    assert other.look(mj_data).as_dict() != before
    assert (camera.look(mj_data).as_dict() == before) == (model is not mj_model)


def test_arguments_of_another_type_are_refused() -> None:
    mj_model, mj_data = compiled(BALL)
    camera: Any = GeometricCamera
    with pytest.raises(ConfigurationError, match=r"GeometricCamera\.mj_model: must be a MjModel \(got 'scene\.xml'\)"):
        camera("scene.xml", site="eye")
    with pytest.raises(ConfigurationError, match=r"GeometricCamera\.parameters: must be a CameraParameters \(got \{'rows': 3\}\)"):
        camera(mj_model, site="eye", parameters={"rows": 3})
    with pytest.raises(ConfigurationError, match=r"look: mj_data: must be a MjData \(got <mujoco"):
        camera(mj_model, site="eye").look(mj_model)
    for heading in (math.nan, math.inf, "left"):
        with pytest.raises(ConfigurationError, match=r"look: heading: must be a (finite )?number \(got "):
            camera(mj_model, site="eye").look(mj_data, heading)
