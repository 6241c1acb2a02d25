"""MJCF and URDF files are added to a scene unchanged, and do not change it; errors name the file and the line."""

from __future__ import annotations

import math
import struct
import subprocess
import sys
import zlib
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest
import trimesh
from mujoco import MjModel, MjSpec

from actr3d.errors import Actr3dError, ModelWarning, WorldError
from actr3d.world import Body, Floor, Gait, Imported, Mannequin, Scene, SimpleObject, Wall, World
from actr3d.world.imported import GEOM_FIELDS
from actr3d.world.scene import Part
from tests.helpers.small_agents import near

creation: Any = trimesh.creation

ARM = """<mujoco model="arm">
  <compiler angle="degree" eulerseq="ZYX"/>
  <default><geom rgba="1 0 0 1" friction="0.3"/><default class="stiff"><joint damping="3" armature="0.1"/></default></default>
  <worldbody>
    <body name="base" pos="1 0 0.5" euler="90 10 0">
      <geom name="foot" type="box" size="0.1 0.2 0.3"/>
      <site name="eye" pos="0 0 0.4"/>
      <body name="arm" pos="0 0 0.5"><joint name="elbow" class="stiff" axis="0 1 0" range="-30 60"/>
        <geom size="0.05" fromto="0 0 0 0.5 0 0" type="capsule"/></body>
    </body>
  </worldbody>
  <actuator><motor name="pull" joint="elbow" gear="2"/></actuator>
  <sensor><jointpos name="angle" joint="elbow"/></sensor>
</mujoco>
"""

CART = """<robot name="cart">
  <link name="base"><visual><geometry><box size="1 1 1"/></geometry></visual>
    <collision><geometry><sphere radius="0.7"/></geometry></collision>
    <inertial><mass value="5"/><inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial></link>
  <link name="wheel"><collision><geometry><cylinder radius="0.2" length="0.1"/></geometry></collision></link>
  <link name="frame"/>
  <joint name="axle" type="continuous"><parent link="base"/><child link="wheel"/><axis xyz="0 1 0"/></joint>
  <joint name="lift" type="prismatic"><parent link="base"/><child link="frame"/><axis xyz="0 0 1"/>
    <limit lower="-0.2" upper="0.3" effort="1" velocity="1"/></joint>
</robot>
"""


def file(folder: Path, content: str | bytes, name: str = "robot.xml") -> Path:
    path = folder / name
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_bytes(content.encode() if isinstance(content, str) else content)
    return path


def box(folder: Path, name: str, size: float = 1.0) -> Path:
    return file(folder, creation.box((size,) * 3).export(file_type=name.rpartition(".")[2]), name)


def model(*parts: Any) -> MjModel:
    return World(Scene(parts=parts)).mj_model


def names(mj_model: MjModel, kind: str, count: int) -> list[str]:
    return [getattr(mj_model, kind)(n).name for n in range(count)]


def ray(world: World, start: tuple[float, float, float], way: tuple[float, float, float]) -> tuple[float, str]:
    """Returns the length of a ray [m], and the body that it hits."""
    world.refresh()
    geom = np.zeros(1, dtype=np.int32)
    distance = mujoco.mj_ray(world.mj_model, world.mj_data, np.array(start, float), np.array(way, float), None, 1, -1, geom, None)
    return distance, world.mj_model.body(world.mj_model.geom_bodyid[geom[0]]).name if distance >= 0 else ""


def test_an_mjcf_file_is_added_as_mujoco_compiles_it_alone(tmp_path: Path) -> None:
    alone = MjSpec.from_string(ARM).compile()
    inside = model(Floor(), Imported(name="a", path=file(tmp_path, ARM)), SimpleObject(name="box"))
    assert names(inside, "body", inside.nbody) == ["world", "a_base", "a_arm", "box"]
    assert (names(inside, "joint", 1), names(inside, "actuator", 1), names(inside, "sensor", 1)) == (["a_elbow"], ["a_pull"], ["a_angle"])
    for value in ("body_mass", "body_inertia", "body_ipos", "body_pos", "body_quat"):
        assert getattr(inside, value)[1:3] == near(getattr(alone, value)[1:3], abs=1e-12), value
    for value in ("jnt_range", "jnt_limited", "dof_damping", "dof_armature", "actuator_gear"):
        assert getattr(inside, value)[0] == near(getattr(alone, value)[0]), value
    assert inside.geom("a_foot").friction[0] == 0.3
    assert isinstance(Imported(name="a", text=ARM), Part)


def test_it_is_turned_and_placed_exactly() -> None:
    arm = Imported(name="a", text=ARM, position=(1, 2, 3), heading=0.5)
    world = World(Scene(parts=(arm,)))
    assert world.mj_data.body("a_base").xpos == near([1 + np.cos(0.5), 2 + np.sin(0.5), 3.5], abs=1e-12)
    lying = World(Scene(parts=(Imported(name="a", text=ARM, quaternion=(2, 2, 0, 0)),)))
    assert lying.mj_data.body("a_base").xpos == near([1, -0.5, 0], abs=1e-12)


def test_nothing_leaks_out_of_the_file_or_into_it() -> None:
    loud = ARM.replace(
        "<default>",
        '<option timestep="0.01" integrator="RK4" gravity="0 0 -1" cone="elliptic"><flag contact="disable"/></option>'
        '<size nuserdata="7"/><statistic extent="55"/><visual><map znear="0.3"/></visual><default>',
        1,
    ).replace("</mujoco>", '<keyframe><key name="k" qpos="0.3"/></keyframe></mujoco>')
    with pytest.warns(ModelWarning, match=r"contact, gravity, integrator, timestep\).*; its <keyframe> \(k\) is left out: it starts"):
        arm = Imported(name="a", text=loud)
    scene = (Floor(), SimpleObject(name="box"))
    plain, inside = model(*scene), model(*scene, arm)
    for value in ("timestep", "integrator", "cone", "disableflags"):
        assert getattr(inside.opt, value) == getattr(plain.opt, value), value
    assert list(inside.opt.gravity) == list(plain.opt.gravity)
    assert (inside.nuserdata, inside.nkey, inside.vis.map.znear) == (0, 0, plain.vis.map.znear)
    assert list(inside.geom("box").rgba) == list(plain.geom("box").rgba)
    assert list(inside.geom("box").friction) == list(plain.geom("box").friction)
    alone = MjSpec.from_string(ARM).compile()
    assert inside.jnt_range[-1] == near(alone.jnt_range[0]), "degrees in the file, radians in the scene"


def test_one_file_several_times_and_a_scene_several_times() -> None:
    scene = Scene(parts=tuple(Imported(name=f"arm{n}", text=ARM, position=(0, n, 0)) for n in range(3)))
    first, second = World(scene), World(scene)
    assert first.mj_model.nu == second.mj_model.nu == 3
    first.step(100)
    second.step(100)
    assert first.state().mj_state.tobytes() == second.state().mj_state.tobytes()


def test_a_urdf_file_is_added_with_names_limits_and_visuals() -> None:
    with pytest.warns(ModelWarning, match="links that move without a mass are given 1 g: 'frame'"):
        cart = Imported(name="c", text=CART, position=(0, 0, 2), free=True)
    world = World(Scene(parts=(cart,)))
    mj_model = world.mj_model
    assert names(mj_model, "body", mj_model.nbody) == ["world", "c_base", "c_wheel", "c_frame"]
    assert names(mj_model, "joint", mj_model.njnt) == ["c_free", "c_axle", "c_lift"]
    assert list(mj_model.jnt_limited) == [0, 0, 1]
    assert mj_model.joint("c_lift").range == near([-0.2, 0.3])
    assert mj_model.body("c_base").mass[0] == near(5)
    assert mj_model.body("c_frame").mass[0] == near(1e-3)
    assert ray(world, (-5, 0.0, 2), (1, 0, 0)) == (near(4.5), "c_base"), "the box that is seen, not the sphere around it"
    world.step(100)
    assert world.mj_data.body("c_base").xpos[2] < 2


def test_shapes_of_hidden_groups_collide_and_are_not_seen() -> None:
    text = (
        '<mujoco><asset><material name="m" rgba="1 1 1 1"/></asset><worldbody><body name="b"><geom size="0.2" contype="0" conaffinity="0"/>'
    )
    text += '<geom type="box" size="0.5 0.5 0.5" group="3" material="m"/></body></worldbody></mujoco>'
    world = World(
        Scene(parts=(Imported(name="i", text=text), SimpleObject(name="ball", shape="sphere", size=(0.1,), position=(0, 0, 0.8))))
    )
    assert ray(world, (-5, 0, 0), (1, 0, 0)) == (near(4.8), "i_b")
    world.step(500)
    world.refresh()
    assert world.mj_data.body("ball").xpos[2] == near(0.6, abs=5e-3)


MESHES = """<mujoco><compiler meshdir="meshes" texturedir="meshes"/><asset><mesh file="{0}" scale="2 2 2"/>
<texture name="t" type="2d" file="t.png"/><material name="m" texture="t"/></asset>
<worldbody><body name="b"><freejoint/><geom type="mesh" mesh="{1}" material="m"/></body></worldbody></mujoco>"""


def png(width: int = 1, height: int = 1) -> bytes:
    def chunk(kind: bytes, data: bytes) -> bytes:
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    head = chunk(b"IHDR", struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0))
    return b"\x89PNG\r\n\x1a\n" + head + chunk(b"IDAT", zlib.compress(b"\0\x40\x80\xff")) + chunk(b"IEND", b"")


@pytest.mark.parametrize("kind", ["stl", "obj", "ply", "off", "dae"])
def test_meshes_of_any_format_weigh_what_mujoco_says_they_weigh(kind: str, tmp_path: Path) -> None:
    box(tmp_path, f"meshes/one.{kind}")
    file(tmp_path, png(), "meshes/t.png")
    part = Imported(name="i", path=file(tmp_path, MESHES.format(f"one.{kind}", "one")))
    inside = model(part)
    assert inside.body("i_b").mass[0] == near(8000, rel=1e-6)
    assert ray(World(Scene(parts=(part,))), (-5, 0.1, 0.2), (1, 0, 0)) == (near(4, abs=1e-6), "i_b")
    if kind in ("stl", "obj"):
        alone = MjSpec.from_file(str(tmp_path / "robot.xml")).compile()
        for value in ("body_mass", "body_inertia", "geom_pos", "geom_aabb"):
            assert np.asarray(getattr(inside, value)).ravel() == near(np.asarray(getattr(alone, value)).ravel(), rel=1e-5, abs=1e-9), value


def test_textures_of_two_files_with_one_name_stay_apart(tmp_path: Path) -> None:
    parts: list[Imported] = []
    for name, pixel in (("red", b"\0\xff\0\0"), ("blue", b"\0\0\0\xff")):
        box(tmp_path, f"{name}/meshes/one.stl")
        file(tmp_path, png().replace(zlib.compress(b"\0\x40\x80\xff"), zlib.compress(pixel)), f"{name}/meshes/t.png")
        whole = (tmp_path / f"{name}/meshes/t.png").read_bytes()
        at = whole.index(b"IDAT")
        size = struct.unpack(">I", whole[at - 4 : at])[0]
        crc = struct.pack(">I", zlib.crc32(whole[at : at + 4 + size]))
        file(tmp_path, whole[: at + 4 + size] + crc + whole[at + 8 + size :], f"{name}/meshes/t.png")
        parts.append(Imported(name=name, path=file(tmp_path / name, MESHES.format("one.stl", "one"))))
    assert bytes(model(*parts).tex_data.astype(np.uint8)) == b"\xff\0\0\0\0\xff"


def test_a_file_is_read_once_and_what_was_read_makes_the_same_world(tmp_path: Path) -> None:
    box(tmp_path, "meshes/one.stl")
    file(tmp_path, png(), "meshes/t.png")
    file(tmp_path, '<mujoco><worldbody><body name="more"><geom size="0.1"/></body></worldbody></mujoco>', "parts/more.xml")
    text = MESHES.format("one.stl", "one").replace("<worldbody>", '<include file="parts/more.xml"/><worldbody>')
    part = Imported(name="i", path=file(tmp_path, text))
    assert [name for name, _ in part.files or ()] == ["robot.xml", "parts/more.xml", "meshes/one.stl", "meshes/t.png"]
    for each in sorted(tmp_path.rglob("*.*")):
        each.unlink()
    again = Imported(name="i", path="elsewhere.xml", files=part.files)
    assert again.digest == part.digest
    one, other = World(Scene(parts=(part,))), World(Scene(parts=(again,)))
    assert names(one.mj_model, "body", 3) == ["world", "i_more", "i_b"]
    one.step(50)
    other.step(50)
    assert one.state().mj_state.tobytes() == other.state().mj_state.tobytes()


def test_a_ros_package_is_found_above_the_file_and_with_a_folder_given(tmp_path: Path) -> None:
    text = '<robot name="r"><link name="b"><visual><geometry><mesh filename="{}"/></geometry></visual></link></robot>'
    box(tmp_path, "my_robot/meshes/one.stl")
    inside = file(tmp_path, text.format("package://my_robot/meshes/one.stl"), "my_robot/urdf/robot.urdf")
    beside = file(tmp_path, text.format("package://my_robot/meshes/one.stl"), "other/robot.urdf")
    relative = file(tmp_path, text.format("../meshes/one.stl"), "my_robot/urdf/relative.urdf")
    for path, folder in ((inside, None), (beside, tmp_path), (inside, tmp_path / "my_robot"), (relative, tmp_path / "my_robot")):
        part = Imported(name="i", path=path, folder=folder)
        assert ray(World(Scene(parts=(part,))), (-5, 0.1, 0.2), (1, 0, 0))[0] == near(4.5, abs=1e-6)
        assert model(Imported(name="i", files=part.files)).nmesh == 1
    with pytest.raises(WorldError, match=r"robot\.urdf, line 1: no file 'my_robot/meshes/one\.stl' in the folder 'other'"):
        Imported(name="i", path=beside)
    with pytest.raises(WorldError, match=r"relative\.urdf, line 1: '\.\./meshes/one\.stl' lies outside the folder 'urdf'"):
        Imported(name="i", path=relative)


def test_gaps_are_filled_with_a_warning(tmp_path: Path) -> None:
    turned = creation.box()
    turned.invert()
    file(tmp_path, turned.export(file_type="stl"), "meshes/one.stl")
    path = file(tmp_path, MESHES.format("one.stl", "one"))
    message = r"Imported 'i': one\.stl: all its triangles faced inwards and are reversed; "
    with pytest.warns(ModelWarning, match=message + r"there is no texture 'meshes/t\.png' \(robot\.xml, line 2\): plain grey") as caught:
        part = Imported(name="i", path=path)
    assert [warning.filename for warning in caught] == [__file__], "the warning names the modeller's line"
    assert model(part).body("i_b").mass[0] == near(8000, rel=1e-6)


def test_warnings_of_mujoco_are_given_at_the_modellers_line() -> None:
    text = mjcf('<body name="b"><flexcomp name="f" type="grid" count="3 3 1" spacing="1 1 1" dim="2"/></body>')
    with pytest.warns(
        ModelWarning, match="Imported 'i': flex 'f' is not rigid and has no equality constraints .*; Element name 'f'"
    ) as caught:
        Imported(name="i", text=text)
    assert [warning.filename for warning in caught] == [__file__]


def test_the_eye_is_a_site_of_the_file() -> None:
    arm = Imported(name="a", text=ARM, eye="eye")
    assert model(arm).site(arm.prefix + "eye").name == "a_eye"
    with pytest.raises(WorldError, match="Imported 'a': no site 'eyes' to be the eye; there are eye; did you mean 'eye'"):
        Imported(name="a", text=ARM, eye="eyes")


def mjcf(inside: str) -> str:
    return f"<mujoco>\n<worldbody>\n{inside}\n</worldbody>\n</mujoco>"


def asset(inside: str) -> str:
    return f"<mujoco>\n<asset>\n{inside}\n</asset>\n</mujoco>"


def urdf(*links: str) -> str:
    return '<robot name="r">\n' + "\n".join(links) + "\n</robot>"


LAUGHS = '<!DOCTYPE m [<!ENTITY a "ha"><!ENTITY b "&a;&a;&a;&a;">]>\n<mujoco model="&b;"/>'
REPLICAS = '<replicate count="500"><replicate count="500"><body><geom size="1"/></body></replicate></replicate>'
JOINT = '<joint name="j" type="{}"><parent link="{}"/><child link="b"/></joint>'

BROKEN: list[tuple[str, str]] = [
    ("this is no XML", r"Imported 'i': i\.xml, line 1: syntax error"),
    ("<mujoco>\n<worldbody>\n</mujoco>", r"i\.xml, line 3: mismatched tag; <worldbody> of i\.xml, line 2 is still open"),
    ("<mujoco>\n<worldbody>", r"i\.xml, line 2: no element found; <worldbody> of i\.xml, line 2 is still open"),
    ("<html/>", r"i\.xml, line 1: the root is <html>; MJCF has <mujoco>, URDF <robot>"),
    (LAUGHS, r"i\.xml, line 1: <!DOCTYPE> is refused: entities can grow without bounds"),
    (mjcf("<body>" * 300 + "</body>" * 300), r"i\.xml, line 3: elements nested more than 200 deep"),
    (mjcf("<geom/>" * 100_001), r"i\.xml, line 3: more than 100,000 elements"),
    ("<mujoco>\n<worldbdy/>\n</mujoco>", r"Schema violation: unrecognized element; Element 'worldbdy', i\.xml, line 2"),
    (mjcf('<geom siz="1"/>'), r"unrecognized attribute: 'siz'; Element 'geom', i\.xml, line 3"),
    (mjcf('<body name="a"/>\n<body name="a"/>'), r"repeated name 'a' in body; Element 'body', i\.xml, line 4"),
    (
        mjcf('<body name="a"><freejoint/></body>'),
        r"mass and inertia of moving bodies must be larger than mjMINVAL; Element name 'a', .*i\.xml, line 3",
    ),
    (mjcf('<body pos="0 nan 0"><geom size="1"/></body>'), r'i\.xml, line 3: <body pos="0 nan 0"> is not a number'),
    (mjcf('<body><geom size="-1"/></body>'), r"i\.xml, line 3"),
    (mjcf('<geom type="mesh" mesh="nowhere"/>'), r"mesh 'nowhere' not found"),
    (
        mjcf('<body><joint name="j"/><geom size="1"/></body>').replace("</mujoco>", '<actuator><motor joint="k"/></actuator></mujoco>'),
        r"unknown .*'k'",
    ),
    (mjcf(REPLICAS), r"<replicate> makes more than 10,000 elements"),
    (mjcf('<body name="b"><flexcomp name="f" count="100 100 1"/></body>'), r'<flexcomp count="100 100 1">: the limit is 2,500'),
    (asset('<mesh name="m" builtin="plate" params="100000 100000"/>'), r'<mesh params="100000 100000">: the limit is 1,000'),
    (mjcf('<replicate count="100000"><geom size="1"/></replicate>'), r'i\.xml, line 3: <replicate count="100000">: the limit is 2,500'),
    (
        asset('<hfield name="h" nrow="10000000" ncol="10000000" size="1 1 1 1"/>'),
        r'i\.xml, line 3: <hfield nrow="10000000">: the limit is 4,096',
    ),
    (asset('<texture type="2d" builtin="flat" width="100000000" height="9"/>'), r'<texture width="100000000">: the limit is 8,192'),
    (asset('<mesh file="gone.stl"/>'), r"i\.xml, line 3: no file 'gone\.stl' in the folder 'here'"),
    (asset('<mesh file="cut.stl"/>'), r"i\.xml, line 3: 'cut\.stl' is cut short: 12 triangles take 684 bytes, it has 600"),
    (asset('<mesh file="../outside.stl"/>'), r"i\.xml, line 3: '\.\./outside\.stl' lies outside the folder 'here'"),
    (asset('<mesh file="/etc/hostname"/>'), r"i\.xml, line 3: '/etc/hostname' lies outside the folder 'here'"),
    (asset('<mesh file="file:///etc/hostname"/>'), r"'/etc/hostname' lies outside the folder 'here'"),
    (asset('<mesh file="old.msh"/>'), r"'old\.msh': the old format \.msh is not read; save it as OBJ or STL"),
    (asset('<mesh name="m" vertex="0 0 0 1 0 0 0 1 0"/>'), r"at least 4 vertices required"),
    (
        asset('<hfield name="h" file="h.bin" size="1 1 1 1"/>'),
        r"'h\.bin' is neither PNG nor a height field of MuJoCo's own format, or is cut short",
    ),
    (asset('<texture type="2d" file="large.png"/>'), r"'large\.png' is an image of 100000 x 100000; the limit is 8192 each way"),
    (asset('<texture type="2d" file="cut.stl"/>'), r"unsupported content type: 'model/stl'; Element name 'cut', id 0, i\.xml, line 3"),
    (asset('<model name="m" file="i.xml"/>'), r"i\.xml, line 3: models inside models are not supported; export the model as one file"),
    (asset('<skin name="s" file="s.skn"/>'), r"i\.xml, line 3: skins are not supported"),
    ('<mujoco>\n<include file="gone.xml"/>\n</mujoco>', r"i\.xml, line 2: no file 'gone\.xml' in the folder 'here'"),
    ("<mujoco>\n<include/>\n</mujoco>", r'i\.xml, line 2: <include> has no file="…"'),
    ('<mujoco>\n<include file="../outside.xml"/>\n</mujoco>', r"i\.xml, line 2: '\.\./outside\.xml' lies outside the folder 'here'"),
    ('<mujoco>\n<include file="loop.xml"/>\n</mujoco>', r"two\.xml, line 2: loop\.xml includes two\.xml includes loop\.xml, without end"),
    ('<mujoco>\n<include file="wrong.xml"/>\n</mujoco>', r"unrecognized attribute: 'siz'; Element 'geom', wrong\.xml, line 4"),
    ('<mujoco>\n<include file="unclosed.xml"/>\n</mujoco>', r"unclosed\.xml, line 2: no element found"),
    ("<mujoco>\n" + '<include file="x1.xml"/>' * 10 + "\n</mujoco>", r"more than 100,000 elements with all that is included"),
    ('<mujoco><extension><plugin plugin="foo.bar"/></extension></mujoco>', r"plugin foo\.bar not found; Element 'plugin', i\.xml, line 1"),
    (urdf('<link name="a"/>', "<xacro:macro/>"), r"i\.xml, line 3: <xacro:macro> is a macro of ROS; run xacro on the file first"),
    (
        urdf('<link name="a"/>', '<link name="b"/>', JOINT.format("wobbly", "a")),
        r"invalid joint type in URDF joint definition; Element 'joint', i\.xml, line 4",
    ),
    (
        urdf('<link name="a"/>', '<link name="b"/>', JOINT.format("fixed", "z")),
        r"URDF joint parent or child missing; Element 'joint', i\.xml, line 4",
    ),
    (urdf('<link name="a"/>', '<link name="a"/>'), r"repeated URDF name"),
    (
        urdf('<link name="a"><visual><geometry><mesh filename="package://p/gone.dae"/></geometry></visual></link>'),
        r"i\.xml, line 2: no file 'p/gone\.dae' in the folder 'here'",
    ),
    (urdf('<link name="a"><visual><geometry><blob/></geometry></visual></link>'), r"i\.xml, line 2"),
]


@pytest.mark.parametrize(("text", "message"), BROKEN, ids=[f"{n}" for n in range(len(BROKEN))])
def test_broken_files_are_refused_with_file_and_line(text: str, message: str, tmp_path: Path) -> None:
    here = tmp_path / "here"
    file(here, '<mujoco>\n<include file="two.xml"/></mujoco>', "loop.xml")
    file(here, '<mujoco>\n<include file="loop.xml"/></mujoco>', "two.xml")
    file(here, '<mujoco>\n\n<worldbody>\n<geom siz="1"/></worldbody></mujoco>', "wrong.xml")
    file(here, "<mujoco>\n", "unclosed.xml")
    for n in range(1, 6):
        file(here, "<mujoco>" + (f'<include file="x{n + 1}.xml"/>' if n < 5 else "<custom/>") * 10 + "</mujoco>", f"x{n}.xml")
    file(here, creation.box().export(file_type="stl")[:600], "cut.stl")
    file(here, struct.pack("<ii", 30_000, 30_000), "h.bin")
    file(here, png(100_000, 100_000), "large.png")
    box(tmp_path, "outside.stl")
    file(tmp_path, "<mujoco/>", "outside.xml")
    with pytest.raises(WorldError, match=message):
        Imported(name="i", text=text, folder=here)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({}, r"Imported 'i': give a path, or a text \(got neither\)"),
        ({"path": "a.xml", "text": ARM}, r"Imported 'i': give a path, or a text \(got both\)"),
        ({"path": "/nope.xml"}, "Imported 'i': no file 'nope.xml' in the folder '/'"),
        ({"path": "gone.xml"}, r"no file 'gone\.xml' in the folder 'here'; did you mean 'one\.xml'"),
        ({"path": "one.xml", "folder": "deeper"}, r"'one\.xml' does not lie in the folder 'deeper'"),
        (
            {"text": asset('<mesh file="one.stl"/>')},
            r"'one\.stl' cannot be read: a description given as text has no folder of its own; give folder=",
        ),
        ({"text": "<mujoco \ud800/>"}, r"the text cannot be written in UTF-8"),
        ({"path": "loop.xml"}, r"loop\.xml' is not a readable path: Symlink loop|no file 'loop\.xml'"),
        ({"path": "one.xml", "folder": "loop.xml"}, r"loop\.xml' is not a readable path: Symlink loop|does not lie in"),
        ({"path": "a\0.xml"}, r"is not a readable path: (lstat: )?embedded null|cannot be read: embedded null"),
        ({"text": asset('<mesh file="loop.xml"/>'), "folder": "."}, r"'loop\.xml' cannot be read: Symlink loop|no file 'loop\.xml'"),
        ({"text": asset('<texture type="2d" file="loop.xml"/>').replace("</mujoco>", "<x/></mujoco>"), "folder": "."}, "Element 'x'"),
        ({"path": "klingon.xml"}, r"klingon\.xml, line 1: unknown encoding: klingon; write it in UTF-8"),
        ({"path": "wide.xml"}, r"wide\.xml, line 1: multi-byte encodings are not supported; write it in UTF-8"),
        (
            {"text": ARM.replace("<worldbody>", '<worldbody><body name="two"/>'), "free": True},
            r"free=True needs one root body without a joint \(there are 2\)",
        ),
        ({"text": ARM, "quaternion": (0, 0, 0, 0)}, "Imported 'i': give a heading, or a quaternion that is not 0"),
        ({"text": ARM, "position": (0, 0)}, r"Imported\.position: must have 3 values"),
    ],
)
def test_wrong_descriptions_are_refused(options: dict[str, Any], message: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    file(tmp_path, ARM, "here/one.xml")
    (tmp_path / "here/loop.xml").symlink_to(tmp_path / "here/loop.xml")
    for name, encoding in (("klingon", "klingon"), ("wide", "shift_jis")):
        file(tmp_path, f'<?xml version="1.0" encoding="{encoding}"?>{ARM}', f"here/{name}.xml")
    monkeypatch.chdir(tmp_path / "here")
    with pytest.raises(Actr3dError, match=message):
        Imported.from_mapping({"name": "i", **options})


def test_names_that_clash_in_a_scene_are_refused() -> None:
    with pytest.raises(WorldError, match="repeated name 'a_base'"):
        World(Scene(parts=(Imported(name="a", text=ARM), SimpleObject(name="a_base"))))


ROOM = """<mujoco><worldbody><geom type="box" size=".05 2 1" pos="0.6 0 1"/><geom name="geom_0" pos="9 9 9" size="1"/>
  <body pos="0 -0.6 1"><geom type="box" size="2 .05 1"/></body></worldbody></mujoco>"""
CLOTH = """<mujoco><worldbody><body name="cloth" pos="0.5 0 1.2"><flexcomp name="cloth" type="grid" count="6 6 2" spacing=".1 .1 .1"
  mass="2" dim="3" radius=".01"><contact selfcollide="none"/><edge equality="true"/></flexcomp></body></worldbody></mujoco>"""


@pytest.mark.parametrize(
    ("text", "direction", "feels"),
    [(ROOM, 0.0, "i_geom_1"), (ROOM, -math.pi / 2, "i_body_0"), (CLOTH, 0.0, "i_cloth")],
    ids=["fixed", "body", "soft"],
)
def test_unnamed_and_soft_parts_are_felt_too(text: str, direction: float, feels: str) -> None:
    world = World(Scene(parts=(Imported(name="i", text=text), Mannequin(name="walker"))))
    body = world.bodies["walker"]
    body.set("walk", 1.0, direction=direction)
    touches: set[str] = set()
    for _ in range(60):
        world.step(5)
        touches |= {touch.other for touch in body.get("contacts")}
    assert touches == {feels}


def test_a_restored_world_with_a_soft_object_continues_as_the_first_time() -> None:
    world = World(Scene(parts=(Imported(name="i", text=CLOTH), Mannequin(name="walker"))))

    def walked(ticks: int) -> list[bytes]:
        states: list[bytes] = []
        for _ in range(ticks):
            world.bodies["walker"].set("walk", 1.0)
            world.step(5)
            states.append(world.state_bytes())
        return states

    walked(22)
    state = world.state()
    first = walked(50)
    world.restore(state)
    assert walked(50) == first


STEP = """<mujoco><default><default class="ground"><geom type="plane" size="9 9 1"/></default></default><worldbody><geom class="ground"/>
  <frame pos="1 0 0" euler="0 0 90"><geom {}type="box" size="2 .1 .15" pos="0 0 .15" rgba="1 0 0 1" friction="0.3"/></frame>
  <body name="b" pos="9 9 .1"><geom size=".1"/><joint/></body></worldbody>{}</mujoco>"""


@pytest.mark.parametrize("named", ["", 'name="step" '])
def test_the_feet_of_a_walker_touch_what_lies_directly_in_the_world_of_a_file(named: str) -> None:
    def walked(obstacle: Any) -> Body:
        world = World(Scene(parts=(Floor(), obstacle, Mannequin(name="m", gait=Gait()))))
        world.bodies["m"].set("walk", 1.0)
        world.bodies["m"].get("contacts")
        world.step(750)
        return world.bodies["m"]

    before_file = walked(Imported(name="i", text=STEP.format(named, "")))
    before_wall = walked(Wall(name="w", start=(1, -2), end=(1, 2), thickness=0.2, height=0.3))
    assert before_file.get("pose").x == near(before_wall.get("pose").x, abs=0.01), "it was 1.5 when only the thighs were stopped"
    assert {touch.other for touch in before_file.get("contacts")} == {"i_step" if named else "i_geom_1"}


def test_geoms_directly_in_the_world_of_a_file_keep_their_places_and_properties() -> None:
    inside = World(Scene(parts=(Imported(name="i", text=STEP.format("", "")),)))
    excludes = '<contact><exclude body1="world" body2="b"/></contact>'
    plain = MjModel.from_xml_string(STEP.format("", excludes))
    data = mujoco.MjData(plain)
    mujoco.mj_forward(plain, data)
    mine, box = inside.mj_model.geom("i_geom_1"), plain.geom(1)
    assert inside.mj_data.geom_xpos[mine.id] == near(data.geom_xpos[1])
    assert inside.mj_data.geom_xmat[mine.id] == near(data.geom_xmat[1])
    assert [list(mine.friction), list(mine.rgba), list(mine.size)] == [list(box.friction), list(box.rgba), list(box.size)]
    assert mine.bodyid[0] > 0
    kept = World(Scene(parts=(Imported(name="i", text=STEP.format("", excludes)),))).mj_model
    assert kept.geom("i_geom_1").bodyid[0] == 0, "its exclude would be lost"


def test_names_that_look_like_numbers_are_names() -> None:
    text = '<mujoco><worldbody><body name="nan"><joint name="inf"/><geom size=".1"/></body></worldbody>{}</mujoco>'
    World(Scene(parts=(Imported(name="i", text=text.format('<actuator><motor joint="inf"/></actuator>')),)))
    with pytest.raises(WorldError):
        Imported(name="i", text='<mujoco><worldbody><replicate count=""><geom size="1"/></replicate></worldbody></mujoco>')
    with pytest.raises(Actr3dError, match=r"Imported\.files: must "):
        Imported(name="i", text=text, files=())


def test_every_field_of_a_geom_is_moved() -> None:
    """A later version of MuJoCo may have more."""
    geom = MjSpec().worldbody.add_geom()
    apart = {"name", "frame", "set_frame", "plugin", "alt", "id", "parent", "signature", "classname", "compiler"}
    assert {field for field in dir(geom) if not field.startswith("_")} - apart == set(GEOM_FIELDS)
    assert {field for field in dir(geom.alt) if not field.startswith("_")} == {"type", "axisangle", "euler", "xyaxes", "zaxis"}


def test_no_text_crashes_the_process(tmp_path: Path) -> None:
    """Descriptions with a value replaced by an extreme one either compile or are a `WorldError`; in a separate process."""
    rich = ARM.replace(
        "<worldbody>",
        '<asset><texture name="t" type="2d" builtin="checker" width="8" height="8"/><material name="m" texture="t" texrepeat="1 1"/>'
        '<hfield name="h" nrow="3" ncol="3" size="1 1 1 1"/>'
        '<mesh name="q" vertex="0 0 0 1 0 0 0 1 0 0 0 1" face="0 2 1 0 1 3 0 3 2 1 2 3"/></asset>'
        '<worldbody><replicate count="2" offset="1 0 0"><geom size="0.1"/></replicate><geom type="hfield" hfield="h"/>'
        '<geom type="mesh" mesh="q"/>'
        '<body name="cloth" pos="0 0 5"><flexcomp name="f" type="grid" count="3 3 1" spacing="1 1 1" dim="2" mass="1"/></body>',
    ).replace("</sensor>", '<rangefinder site="eye" cutoff="3"/><user dim="3" objtype="site" objname="eye"/></sensor>')
    code = """
import re, sys, warnings
from pathlib import Path
from actr3d.errors import WorldError
from actr3d.world import Imported, Scene, World
warnings.simplefilter("ignore")
text = Path(sys.argv[1]).read_text()
made = refused = 0
for found in re.finditer(r'="([-0-9. ]+)"', text):
    words = found[1].split()
    for extreme in ("0", "-1", "1e300", "2147483647", "3000000000"):
        value = " ".join([extreme, *words[1:]])
        try:
            World(Scene(parts=(Imported(name="i", text=text[: found.start(1)] + value + text[found.end(1) :]),)))
            made += 1
        except WorldError:
            refused += 1
print(made, refused)
"""
    run = subprocess.run([sys.executable, "-c", code, str(file(tmp_path, rich))], capture_output=True, text=True, cwd=tmp_path)
    assert run.returncode == 0, (run.returncode, run.stderr[-2000:])
    made, refused = map(int, run.stdout.split()[-2:])
    assert made > 50
    assert refused > 50
