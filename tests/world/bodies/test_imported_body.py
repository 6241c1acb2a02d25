"""Bodies from files: agents can control them."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import pytest

from actr3d.errors import WorldError
from actr3d.simulation import Simulation
from actr3d.world import Body, Floor, ImportedBody, Scene, SimpleObject, World
from actr3d.world.anatomy import NamedMovement
from tests.helpers.small_agents import near

ARM = """<mujoco>
  <worldbody><body name="stand" pos="0 0 1"><geom size="0.1"/>
    <body name="arm"><joint name="elbow" axis="0 0 1" damping="10" range="-60 60" limited="true"/>
      <geom type="capsule" fromto="0 0 0 0.5 0 0" size="0.05"/><site name="tip" pos="0.6 0 0"/></body>
  </body></worldbody>
  <actuator><position name="turn" joint="elbow" kp="50"/></actuator>
</mujoco>"""
ROBOT = """<robot name="r"><link name="body"><inertial><mass value="1"/>
  <inertia ixx="1" iyy="1" izz="1" ixy="0" ixz="0" iyz="0"/></inertial>
  <collision><geometry><box size="1 2 3"/></geometry></collision></link></robot>"""


def arm(heading: float = 0.0) -> ImportedBody:
    return ImportedBody(name="arm", text=ARM, eye="tip", heading=heading)


def test_parts_joints_and_eye_of_the_file_are_found() -> None:
    world = World(Scene(parts=(Floor(), arm(), SimpleObject(name="ball", shape="sphere", size=(0.2,)))))
    body = world.bodies["arm"]
    assert body.parts == ("base", "arm")
    assert list(body.joints) == ["elbow"]
    assert (body.joints["elbow"].limits, body.eye) == (near((-math.pi / 3, math.pi / 3)), "arm_tip")
    body.set("control", "turn", 0.5)
    world.step(1000)
    assert body.joints["elbow"].position == near(0.5, abs=0.01)
    assert body.bounding_box().size[2] == near(0.2)


def test_it_sees_along_its_eye() -> None:
    scene = Scene(parts=(Floor(), arm(heading=1.0), SimpleObject(name="ball", shape="sphere", size=(0.2,), position=(0, 3, 1), mass=None)))
    body = World(scene).bodies["arm"]
    view = body.get("view", rows=1)
    assert [len(extents) for extents in view.as_dict()[0.5].values()] == [1]


def test_a_robot_of_urdf_is_a_body_too_and_falls_when_it_is_free() -> None:
    world = World(Scene(parts=(Floor(), ImportedBody(name="r", text=ROBOT, free=True, position=(0, 0, 3)))))
    world.step(1000)
    assert world.bodies["r"].get("pose").z == near(1.5, abs=0.01)


def test_a_simulation_accepts_it() -> None:
    simulation = Simulation(Scene(parts=(Floor(), arm())), seed=1)
    simulation.command("control", "turn", 0.3)
    simulation.run(2)
    assert simulation.world.bodies["arm"].joints["elbow"].position == near(0.3, abs=0.01)


def test_scenery_is_no_body() -> None:
    with pytest.raises(WorldError, match=r"needs one root body, with a name \(there is none\); use Imported for scenery"):
        ImportedBody(name="s", text="<mujoco><worldbody><geom size='1'/></worldbody></mujoco>")
    with pytest.raises(WorldError, match="there is one without a name"):
        ImportedBody(name="s", text="<mujoco><worldbody><body><geom size='1'/></body></worldbody></mujoco>")


def test_each_of_two_has_its_own_controls_though_one_s_name_begins_with_the_other_s() -> None:
    parts = [ImportedBody(name=name, text=ARM, position=(x, 0, 0)) for name, x in (("arm", 0), ("arm_2", 3))]
    one, two = World(Scene(parts=tuple(parts))).bodies.values()
    assert list(one.controls) == list(two.controls) == ["turn"]
    with pytest.raises(WorldError, match="arm has no control '2_turn'"):
        one.set("control", "2_turn", 0.5)


DRIVES = """<mujoco><worldbody><body name="base"><geom size="0.1"/><site name="hand"/>
  <joint name="slide" type="slide" axis="1 0 0"/></body></worldbody>
  <tendon><spatial name="cord"><site site="hook"/><site site="hand"/></spatial>
    <fixed name="sum"><joint joint="slide" coef="1"/></fixed></tendon>
  <actuator><motor name="joint" joint="slide"/><motor name="site" site="hand"/><motor name="cord" tendon="cord"/>
    <motor name="sum" tendon="sum"/><orientation name="turn" site="hand" refsite="hook"/>
    <adhesion name="stick" body="base" ctrlrange="0 1"/></actuator></mujoco>"""


def test_an_actuator_belongs_to_the_body_that_it_moves() -> None:
    text = DRIVES.replace("<worldbody>", '<worldbody><site name="hook" pos="1 0 0"/>')
    body = World(Scene(parts=(ImportedBody(name="r", text=text),))).bodies["r"]
    assert list(body.controls) == ["joint", "site", "cord", "sum", "turn", "stick"]


def test_an_actuator_with_several_controls_takes_them_all() -> None:
    text = DRIVES.replace("<worldbody>", '<worldbody><site name="hook" pos="1 0 0"/>')
    world = World(Scene(parts=(ImportedBody(name="r", text=text),)))
    body = world.bodies["r"]
    body.set("control", "turn", 0.1, 0.2, 0.3)
    assert world.mj_data.ctrl[body.control("turn")].tolist() == [0.1, 0.2, 0.3]
    with pytest.raises(WorldError, match=r"r: control 'turn' takes 3 numbers \(got 0\.5\)"):
        body.set("control", "turn", 0.5)
    with pytest.raises(WorldError, match=r"r: control 'joint' takes one number \(got 1, 2\)"):
        body.set("control", "joint", 1, 2)


def test_a_control_beyond_what_the_physics_takes_is_refused() -> None:
    world = World(Scene(parts=(Floor(), arm())))
    body = world.bodies["arm"]
    for value in (1.1e10, -1e300):
        with pytest.raises(WorldError, match=r"arm: control 'turn': must be (<= |>= -)1e\+10 \(got "):
            body.set("control", "turn", value)
    servo = ARM.replace('<position name="turn" joint="elbow" kp="50"/>', '<velocity name="turn" joint="elbow" kv="50"/>')
    body = World(Scene(parts=(Floor(), ImportedBody(name="arm", text=servo)))).bodies["arm"]
    for word, values in (("joint", ("elbow", 1.1e10)), ("position", ("elbow", 1.0, 1e300))):
        with pytest.raises(WorldError, match=r"speed: must be <= 1e\+10 \(got "):
            body.set(word, *values)
    body.set("control", "turn", 1e10)


def driven_by(actuator: str) -> tuple[World, Body]:
    """Returns a world with a slide that an actuator moves, and its body."""
    slide = '<worldbody><body name="b"><joint name="j" type="slide"/><geom size="0.1"/></body></worldbody>'
    text = f"<mujoco>{slide}<actuator>{actuator}</actuator></mujoco>"
    world = World(Scene(gravity=(0, 0, 0), parts=(ImportedBody(name="r", text=text),)))
    return world, world.bodies["r"]


@pytest.mark.parametrize("gear", [5, -5, 0.5])
def test_a_servo_with_a_gear_keeps_the_commanded_speed(gear: float) -> None:
    world, body = driven_by(f'<velocity joint="j" kv="100" gear="{gear}" ctrlrange="-10 5"/>')
    body.set("joint", "j", 0.9)
    world.step(100)
    assert body.get("joints")["j"].velocity == near(0.9, abs=1e-3)
    assert body.moving() == ("j",)
    body.set("position", "j", 0.5, 0.9)
    world.step(500)
    assert body.get("joints")["j"].position == near(0.5, abs=1e-3)


def test_a_speed_beyond_the_range_of_a_servo_is_refused() -> None:
    _, body = driven_by('<velocity joint="j" kv="10" gear="-2" ctrlrange="-0.5 1"/>')
    with pytest.raises(WorldError, match=r"joint: speed: must be <= 0\.25 \(got 1\.0\)"):
        body.set("joint", "j", 1.0)
    with pytest.raises(WorldError, match=r"position: speed: must be <= 0\.25 \(got 2\.0\)"):
        body.set("position", "j", 1.0)
    body.set("joint", "j", -0.5)


def test_a_damper_is_no_servo() -> None:
    _, body = driven_by('<damper joint="j" kv="10" ctrlrange="0 1"/>')
    assert not body.joints["j"].driven
    assert "joint" not in body.actuators


UNNAMED = """<mujoco><worldbody><body name="r"><joint axis="0 0 1"/><geom size=".1"/>
  <body pos=".5 0 0"><joint/><geom size=".1"/><site name="part_3"/></body>
  <body pos="0 2 0"><joint name="joint_0"/><geom size=".1"/></body></body></worldbody>
  <actuator><motor joint="joint_0"/><motor joint="joint_0" name="own"/><motor joint="joint_0"/></actuator></mujoco>"""


def test_generated_names_do_not_depend_on_the_place_in_a_scene() -> None:
    robot = ImportedBody(name="r", text=UNNAMED)
    for parts in ((robot,), (SimpleObject(name="one"), robot, SimpleObject(name="other"))):
        world = World(Scene(parts=parts))
        body = world.bodies["r"]
        assert list(body.joints) == ["joint_1", "joint_2", "joint_0"]
        assert list(body.controls) == ["control_0", "own", "control_2"]
        assert len({control.start for control in body.controls.values()}) == 3
        body.set("control", "control_2", 1.0)
        assert world.mj_data.ctrl.tolist() == [0.0, 0.0, 1.0]


def test_parts_without_a_name_are_frames() -> None:
    other = SimpleObject(name="part_2", position=(7, 7, 7))
    body = World(Scene(parts=(SimpleObject(name="one"), ImportedBody(name="r", text=UNNAMED), other))).bodies["r"]
    assert body.parts == ("base", "part_1", "part_2")
    for part in body.parts[1:]:
        pose = body.get("pose", part)
        assert body.frame(part)[0] == near((pose.x, pose.y, pose.z))
    assert body.bounding_box("part_2").lower[1] == near(-2.1)
    assert body.get("bounding_box", "part_2") == body.get("bounding_box", "body")
    assert body.get("rangefinder", at="part_2") is None


@pytest.mark.parametrize("lies", [(0.7071067811865476, 0.7071067811865476, 0, 0), (0.9238795325112867, 0, 0.3826834323650898, 0)])
def test_a_free_body_keeps_its_tilt_when_it_is_moved(lies: tuple[float, float, float, float]) -> None:
    world = World(Scene(parts=(ImportedBody(name="r", text=ROBOT, free=True, quaternion=lies),)))
    body = world.bodies["r"]
    before = body.get("pose")
    world.move("r", 1.0, 0.0, 0.5)
    assert body.get("pose") == replace(before, x=near(1.0), heading=near(0.5), pitch=near(before.pitch), roll=near(before.roll))
    body.set("teleport", 2.0, 0.0, -0.5)
    assert body.get("pose") == replace(before, x=near(2.0), heading=near(-0.5), pitch=near(before.pitch), roll=near(before.roll))


def test_a_movement_of_joints_that_do_not_exist_is_refused() -> None:
    movement = NamedMovement(name="wave", joints=(("elbow", 1), ("elbw", -1)))
    with pytest.raises(WorldError, match=r"arm: movement 'wave' has no joint 'elbw'; did you mean 'elbow'\? It has elbow"):
        World(Scene(parts=(Floor(), ImportedBody(name="arm", text=ARM, movements=(movement,)))))


def test_a_changed_file_has_its_new_root(tmp_path: Path) -> None:
    file = tmp_path / "robot.xml"
    for root in ("chassis", "trunk"):
        body = f'<body name="{root}"><geom size="0.1"/></body>'
        file.write_text(f"<mujoco><worldbody>{body}</worldbody></mujoco>", encoding="utf-8")
        assert ImportedBody(name="robot", path=file).anatomy().root == f"robot_{root}"


def test_sensors_of_the_file_are_of_the_present_once_the_physics_is_refreshed_or_solved() -> None:
    text = """<mujoco><worldbody><body name="base"><joint name="slide" type="slide" axis="1 0 0" damping="1"/>
      <geom name="box" type="box" size="0.1 0.1 0.05" mass="1"/><site name="place"/></body></worldbody>
      <actuator><motor name="pull" joint="slide"/></actuator>
      <sensor><jointpos name="at" joint="slide"/><jointvel name="speed" joint="slide"/><accelerometer name="felt" site="place"/>
      </sensor></mujoco>"""
    world, other = (World(Scene(parts=(ImportedBody(name="robot", text=text),), gravity=(0, 0, 0))) for _ in range(2))
    body, data = world.bodies["robot"], world.mj_data
    for each in (world, other):
        each.bodies["robot"].set("control", "pull", 2.0)
        each.step(50)
    slide = body.get("joints")["slide"]
    assert data.sensor("robot_at").data[0] != slide.position
    body.physics.refresh()
    assert data.sensor("robot_at").data[0] == slide.position
    assert data.sensor("robot_speed").data[0] != slide.velocity
    body.physics.solve()
    assert data.sensor("robot_speed").data[0] == slide.velocity
    assert data.sensor("robot_felt").data[0] == near(2 - slide.velocity)
    for each in (world, other):
        each.step(50)
    assert world.state_bytes() == other.state_bytes()
