"""Bodies carry out commands exactly, until the next command."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest
from mujoco import MjSpec

from actr3d.errors import Actr3dError, WorldError
from actr3d.world import Body, Floor, Imported, Mannequin, Scene, SimpleObject, Wall, World
from actr3d.world.anatomy import Anatomy
from actr3d.world.bodies.planar_base import add_planar_base
from actr3d.world.sensors.touch import present
from actr3d.world.velocity_servo import add_servo
from tests.helpers.small_agents import near


def world_with_walker(*parts: Any, **of: Any) -> tuple[World, Body]:
    """Returns a world with a floor, a mannequin called `walker` and more, and its body."""
    world = World(Scene(parts=(Floor(), Mannequin(name="walker", **of), *parts)))
    return world, world.bodies["walker"]


def ticks(world: World, count: int) -> None:
    for _ in range(count):
        world.step(5)


@pytest.mark.parametrize(("target", "speed", "takes"), [(0.7, 2.0, 35), (-0.33, 1.0, 33), (0.005, 2.0, 1), (0.505, 1.0, 51)])
def test_a_joint_goes_to_a_position_at_its_speed_and_ends_exactly_there(target: float, speed: float, takes: int) -> None:
    world, body = world_with_walker()
    body.set("position", "torso_yaw", target, speed)
    joint = body.joints["torso_yaw"]
    for tick in range(1, takes):
        world.step(5)
        assert joint.position == near(math.copysign(speed * 0.01 * tick, target), abs=1e-3)
    world.step(5)
    assert joint.position == target
    assert not body.motion
    ticks(world, 100)
    assert joint.position == near(target, abs=1e-6)


def test_joints_at_rest_hold_while_others_swing() -> None:
    world, body = world_with_walker()
    for n in range(8):
        body.set("posture", {"torso_yaw": 0.8 * (-1) ** n, "left_shoulder_yaw": 0.3 * (-1) ** n}, speed=4.0)
        ticks(world, 60)
    others = [joint.position for name, joint in body.joints.items() if name not in ("torso_yaw", "left_shoulder_yaw")]
    assert others == near([0] * len(others), abs=math.radians(0.1))


def test_a_joint_turns_at_its_speed_in_one_long_step() -> None:
    world, body = world_with_walker()
    body.set("position", "torso_yaw", 0.7, 2.0)
    world.step(100)
    assert body.joints["torso_yaw"].position == near(0.4, abs=1e-3)
    world.step(1000)
    assert body.joints["torso_yaw"].position == near(0.7, abs=1e-6)
    assert not body.motion


def test_a_posture_moves_several_joints_while_walking() -> None:
    world, body = world_with_walker()
    body.set("walk", 1.4)
    targets = {"torso_yaw": 0.8, "left_shoulder_yaw": 0.2, "head_pitch": -0.3, "right_upper_arm_pitch": -1.0}
    body.set("posture", targets, speed=3.0)
    ticks(world, 40)
    assert {name: body.joints[name].position for name in targets} == near(targets, abs=1e-3)
    assert body.get("pose").x == near(0.56, abs=0.01)


@pytest.mark.parametrize(("by", "speed"), [(1.5, 2.0), (-7.0, 4.0)])
def test_a_turn_while_walking_has_the_commanded_angle(by: float, speed: float) -> None:
    world, body = world_with_walker()
    body.set("walk", 0.5)
    body.set("turn", by, speed)
    ticks(world, math.ceil(abs(by) / speed * 100) - 1)
    assert body.motion
    ticks(world, 1)
    assert body.base.pose[2] == near(by, abs=1e-9)
    assert not body.motion
    assert body.base.speed == near((0.5, 0, 0), abs=1e-3)
    body.set("turn", 3.0, 1.0)
    body.set("heading", 0.0)
    ticks(world, 300)
    assert math.remainder(body.base.pose[2], 2 * math.pi) == near(0, abs=1e-6)


@pytest.mark.parametrize("seed", range(4))
def test_a_posture_of_all_joints_is_reached_by_all_though_some_are_there_first(seed: int) -> None:
    world, body = world_with_walker()
    random = np.random.default_rng(seed)
    targets = {name: random.uniform(joint.lower, joint.upper) for name, joint in body.joints.items() if not name.startswith("pelvis")}
    body.set("posture", targets, speed=3.0)
    ticks(world, 250)
    assert not body.motion
    assert {name: body.joints[name].position for name in targets} == near(targets, abs=2e-3)


def test_a_position_beyond_a_limit_ends_at_the_limit() -> None:
    world, body = world_with_walker()
    body.set("position", "head_yaw", 3.0, 4.0)
    ticks(world, 60)
    assert body.joints["head_yaw"].position == near(body.joints["head_yaw"].upper)
    assert not body.motion


def test_a_new_command_replaces_the_old_one() -> None:
    world, body = world_with_walker()
    body.set("position", "torso_yaw", 1.0, 1.0)
    body.set("waypoint", 3.0, 0.0)
    ticks(world, 10)
    body.set("joint", "torso_yaw", -1.0)
    body.set("walk", 0.0)
    ticks(world, 10)
    assert body.joints["torso_yaw"].position == near(0.0, abs=1e-3)
    assert body.get("pose").x == near(0.13)
    assert not body.motion


@pytest.mark.parametrize("point", [(2.0, 0.0), (1.0, 1.5), (-1.0, 0.3), (0.004, 0.0)])
def test_a_body_reaches_a_waypoint_exactly_and_stops_there(point: tuple[float, float]) -> None:
    world, body = world_with_walker(position=(0.0, 0.0))
    body.set("waypoint", *point, speed=1.5, turn=3.0)
    ticks(world, 300)
    pose = body.get("pose")
    assert (pose.x, pose.y) == near(point, abs=1e-9)
    assert not body.motion
    assert body.get("velocity").linear == near((0, 0, 0), abs=1e-9)


def test_a_heading_is_turned_to_the_shorter_way_round() -> None:
    world, body = world_with_walker(heading=3.0)
    body.set("heading", -3.0, 1.0)
    ticks(world, 10)
    assert body.base.pose[2] == near(3.1, abs=1e-3)
    ticks(world, 30)
    assert body.get("pose").heading == near(-3.0, abs=1e-9)
    assert not body.motion


def test_teleport_keeps_the_posture_and_the_walk_continues_in_the_new_direction() -> None:
    world, body = world_with_walker()
    body.set("walk", 1.0)
    body.set("position", "torso_yaw", 0.2)
    ticks(world, 20)
    body.set("teleport", 5.0, -2.0, math.pi / 2)
    pose = body.get("pose")
    assert (pose.x, pose.y, pose.heading) == near((5.0, -2.0, math.pi / 2))
    assert body.joints["torso_yaw"].position == near(0.2, abs=1e-6)
    ticks(world, 10)
    pose = body.get("pose")
    assert (pose.x, pose.y) == near((5.0, -1.9), abs=1e-6)


@dataclass(frozen=True)
class Cart:
    """A body that walks, with a hinge that no servo moves."""

    name: str = "cart"

    def add_to(self, mj_spec: MjSpec) -> None:
        root = add_planar_base(mj_spec, "cart", (0, 0), 0)
        root.add_site(name="cart_base")
        root.add_geom(size=[0.1, 0, 0], mass=10)
        flag = root.add_body(name="cart_flag", pos=[0, 0, 1])
        flag.add_joint(name="cart_hinge", axis=[0, 1, 0])
        flag.add_geom(size=[0.05, 0, 0], pos=[0.1, 0, 0], mass=0.1, contype=0, conaffinity=0)
        for number, name in ((0, "forward"), (1, "sideways"), (5, "turn")):
            add_servo(mj_spec, f"cart_{name}", "cart_base", 500.0, tuple(float(n == number) for n in range(6)))

    def anatomy(self) -> Anatomy:
        walking = ("cart_forward", "cart_sideways", "cart_turn")
        return Anatomy(root="cart", prefix="cart_", servos=walking, walking_servos=walking)


def test_a_body_with_a_joint_without_a_servo_stops() -> None:
    world = World(Scene(parts=(Cart(),)))
    body = world.bodies["cart"]
    body.set("walk", 1.0)
    ticks(world, 10)
    swings = body.joints["hinge"].velocity
    body.set("stop")
    assert body.base.speed == near((0, 0, 0), abs=1e-9)
    assert body.joints["hinge"].velocity == near(swings) != 0
    with pytest.raises(WorldError, match="joint 'hinge' has no servo that could move it"):
        body.joints["hinge"].control = 1.0


CUP = SimpleObject(name="cup", size=(0.05, 0.05, 0.2), position=(0.0, -0.24, 0.66), mass=0.5)
"""Beside the right hand of a mannequin of the usual size."""


def test_a_grasped_object_moves_with_the_hand_until_released() -> None:
    world, body = world_with_walker(CUP)
    body.set("grasp", "cup")
    assert body.get("grasp") == {"left": None, "right": "cup"}
    body.set("position", "right_upper_arm_pitch", -1.2)
    ticks(world, 100)
    body.set("walk", 1.0)
    ticks(world, 50)
    assert body.get("pose").x == near(0.5, abs=0.01)
    body.set("stop")
    ticks(world, 50)
    world.refresh()
    hand, cup = (world.mj_data.body(name) for name in ("walker_right_upper_arm", "cup"))
    there = hand.xmat.reshape(3, 3).T @ (cup.xpos - hand.xpos)
    assert there == near([0.0, -0.24 + 0.222 - 0.06125, 0.66 - 0.818 * 1.75], abs=5e-3)
    assert body.joints["right_upper_arm_pitch"].position == near(-1.2, abs=0.01)
    body.set("teleport", -3.0, 2.0, 1.0)
    ticks(world, 20)
    world.refresh()
    assert hand.xmat.reshape(3, 3).T @ (cup.xpos - hand.xpos) == near(there, abs=5e-3)
    body.set("release", "right")
    ticks(world, 150)
    world.refresh()
    assert body.get("grasp")["right"] is None
    assert cup.xpos[2] < 0.2


def test_the_name_of_an_object_may_look_like_a_number() -> None:
    _, body = world_with_walker(SimpleObject(name="5", size=CUP.size, position=CUP.position, mass=CUP.mass))
    body.set("grasp", 5)
    assert body.get("grasp")["right"] == "5"


def test_a_hand_carries_the_weight_of_all_parts_of_what_it_holds() -> None:
    parts = '<geom size=".02" mass="0.2"/><body pos="0 0 -.1" gravcomp="{}"><joint/><geom size=".02" mass="2"/></body>'
    for gravcomp, weight in ((0, 2.2), (0.5, 1.2)):
        text = f'<mujoco><worldbody><body name="bag">{parts.format(gravcomp)}</body></worldbody></mujoco>'
        world, body = world_with_walker(Imported(name="a", text=text, free=True, position=(0.0, -0.24, 0.66)))
        body.set("grasp", "a_bag")
        assert world.mj_data.xfrc_applied.sum(axis=0) == near((0, 0, 9.81 * weight, 0, 0, 0))
        ticks(world, 50)
        assert body.joints["right_upper_arm_pitch"].position == near(0, abs=1e-3)
        body.set("release")
        assert not world.mj_data.xfrc_applied.any()


def test_contacts_of_a_held_object_are_felt() -> None:
    stick = SimpleObject(name="stick", size=(0.6, 0.05, 0.05), position=(0.1, -0.24, 0.66), mass=0.5)
    world, body = world_with_walker(Wall(name="wall", start=(0.6, -3.0), end=(0.6, 3.0)), stick)
    body.set("grasp", "stick")
    body.set("walk", 0.3)
    ticks(world, 100)
    assert {(touch.part, touch.other) for touch in body.get("contacts")} >= {("stick", "wall")}
    body.set("release")
    assert "stick" not in {touch.part for touch in present(body)}


def test_an_object_in_both_hands_is_carried_until_both_release_it() -> None:
    world, body = world_with_walker(SimpleObject(name="tray", size=(0.1, 0.5, 0.05), position=(0.132, 0.0, 0.66), mass=1.0))
    body.set("grasp", "tray", "left")
    body.set("grasp", "tray", "right")
    assert body.get("grasp") == {"left": "tray", "right": "tray"}
    body.set("release", "left")
    ticks(world, 100)
    world.refresh()
    assert world.mj_data.body("tray").xpos[2] == near(0.66, abs=0.02)
    body.set("release")
    ticks(world, 100)
    world.refresh()
    assert world.mj_data.body("tray").xpos[2] < 0.2


def test_nothing_out_of_reach_is_grasped() -> None:
    _, body = world_with_walker(SimpleObject(name="far", position=(2.0, 0, 0.15)), CUP)
    body.set("grasp", "far")
    body.set("grasp", "cup", hand="left")
    assert body.get("grasp") == {"left": None, "right": None}


def test_a_grasp_is_part_of_the_state() -> None:
    world, body = world_with_walker(CUP, SimpleObject(name="other", size=(0.05, 0.05, 0.2), position=(0.0, 0.24, 0.66), mass=0.3))
    body.set("grasp", "cup")
    body.set("position", "right_upper_arm_pitch", -1.0)
    ticks(world, 10)
    state = world.state()
    ticks(world, 100)
    first = world.state()
    body.set("release")
    body.set("grasp", "other", "left")
    ticks(world, 10)
    world.restore(state)
    assert body.get("grasp") == {"left": None, "right": "cup"}
    ticks(world, 100)
    assert world.state().mj_state.tobytes() == first.mj_state.tobytes()
    assert world.state().bodies == first.bodies


def test_a_start_against_a_wall_is_only_a_push() -> None:
    """A command sets a speed immediately only without contact; otherwise repeated commands would press the body into a wall."""
    world, body = world_with_walker(Wall(name="wall", start=(0.2, -2.0), end=(0.2, 2.0), thickness=0.1))
    body.set("walk", 0.5)
    ticks(world, 50)
    body.set("walk", 3.0)
    assert abs(world.mj_data.qvel[0]) < 0.1
    body.set("walk", -1.0)
    ticks(world, 60)
    assert body.get("velocity").linear[0] == near(-1.0, abs=1e-2)


@dataclass(frozen=True)
class Arm:
    """A body that is described in MJCF alone: a motor on a hinge."""

    name: str = "arm"

    def add_to(self, mj_spec: MjSpec) -> None:
        text = """<mujoco><worldbody><body name="base"><body name="link"><joint name="elbow" axis="0 0 1" range="-1 1" limited="true"/>
        <geom size="0.1" mass="1"/></body></body></worldbody><actuator><motor name="motor" joint="elbow" gear="2"/></actuator></mujoco>"""
        frame = mj_spec.worldbody.add_frame(pos=[0, 0, 2])
        mj_spec.attach(MjSpec.from_string(text), prefix=f"{self.name}_", frame=frame)

    def anatomy(self) -> Anatomy:
        return Anatomy(root="arm_base", prefix="arm_")


def test_an_imported_body_shows_its_joints_and_takes_controls() -> None:
    world = World(Scene(parts=(Arm(),)))
    body = world.bodies["arm"]
    assert body.parts == ("base", "link")
    assert body.joints["elbow"].limits == near((-math.radians(1), math.radians(1)))
    assert body.actuators == ("control",)
    body.set("control", "motor", 0.5)
    world.step(1)
    assert body.joints["elbow"].velocity > 0
    with pytest.raises(Actr3dError, match="arm has no control 'moter'; did you mean 'motor'"):
        body.set("control", "moter", 1)


@pytest.mark.parametrize(
    ("word", "values", "message"),
    [
        ("wak", (1,), "walker has no actuator 'wak'; did you mean 'walk'"),
        ("steering", (1,), "walker has no actuator 'steering'; it has walk, heading"),
        ("walk", (), r"walker: walk takes \(speed, turn=0\.0, direction=0\.0\): missing a required argument: 'speed'"),
        ("walk", (1, 2, 3, 4), "too many positional arguments"),
        ("walk", ("fast",), "walk: speed: must be a number"),
        ("walk", (math.inf,), "walk: speed: must be a finite number"),
        ("joint", ("torso_yw", 1), "walker has no joint 'torso_yw'; did you mean 'torso_yaw'"),
        ("position", ("torso_yaw", 1, 0), "position: speed: must be >= 1e-06"),
        ("posture", ({"torso_yaw": 1, "tors": 2},), "walker has no joint 'tors'"),
        ("grasp", ("cap",), "no loose object 'cap' in this scene; did you mean 'cup'"),
        ("grasp", ("cup", "middle"), "walker has no hand 'middle'; it has left, right"),
        ("release", ("middle",), "walker has no hand 'middle'"),
        ("teleport", (1, math.nan), "teleport: y: must be a finite number"),
        (["walk"], (1,), r"walker has no actuator \['walk'\]; it has walk"),
        ("walk", (10**400,), "walk: speed: must be a finite number"),
        ("heading", (math.nan,), "heading: angle: must be a finite number"),
        (
            "heading",
            (40,),
            r"heading: angle: must be <= 6\.2832 rad, a full turn \(got 40\); did you mean 40 degrees, math\.radians\(40",
        ),
        ("heading", ("-7",), r"heading: angle: must be >= -6\.2832 rad, a full turn \(got '-7'\); did you mean -7 degrees"),
        ("turn", (20,), r"turn: angle: must be <= 18\.8496 rad, 3 full turns \(got 20\)"),
        ("walk", (1, 0, 90), "walk: direction: must be <= 6.2832 rad"),
        ("gaze", (10,), "gaze: left: must be <= 6.2832 rad"),
        ("saccade", (0, -10), "saccade: up: must be >= -6.2832 rad"),
        ("teleport", (1, 0, 90), "teleport: heading: must be <= 6.2832 rad"),
        ("position", ("torso_yaw", 60), r"position: angle: must be <= 6\.2832 rad, a full turn \(got 60\)"),
        ("posture", ({"torso_yaw": 1, "head_yaw": 45},), r"posture: head_yaw: angle: must be <= 6\.2832 rad, a full turn \(got 45\)"),
        ("waypoint", (1, 2, math.nan), "waypoint: speed: must be a finite number"),
        ("joint", ("torso_yaw", math.nan), "joint: speed: must be a finite number"),
        ("joint", (["torso_yaw"], 1), r"walker has no joint \['torso_yaw'\]"),
        ("position", (5, 1), "walker has no joint 5"),
        ("posture", (5,), r"posture: angles: must be angles by joint \(got 5\)"),
        ("posture", ({"torso_yaw": 1, "head_yaw": math.nan},), "posture: head_yaw: angle: must be a finite number"),
        ("grasp", (5,), "no loose object '5' in this scene"),
        ("grasp", ("cup", ["left"]), r"walker has no hand \['left'\]"),
        ("release", (0,), "walker has no hand 0"),
    ],
)
def test_wrong_commands_are_refused_with_a_reason_and_do_nothing(word: Any, values: tuple[Any, ...], message: str) -> None:
    world, body = world_with_walker(CUP)
    body.set("waypoint", 3.0, 0.0)
    body.set("position", "torso_yaw", 0.5)
    before = world.state()
    with pytest.raises(Actr3dError, match=message):
        body.set(word, *values)
    assert world.state().mj_state.tobytes() == before.mj_state.tobytes()
    assert world.state().bodies == before.bodies
