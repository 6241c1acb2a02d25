"""The motor module: commands, muscle groups, limits, and refusals."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from actr3d.actr import ACTR, Buffer
from actr3d.actr.loading import load_text
from actr3d.errors import Actr3dError, ModelWarning, ParameterError, SimulationError, WorldError
from actr3d.motor import Motor
from actr3d.simulation import Simulation
from actr3d.world import Car, Floor, ImportedBody, Load, Mannequin, Scene, Wall
from actr3d.world.anatomy import NamedMovement
from tests.helpers.motor_bodies import during, motor_of, mover, moving, until
from tests.helpers.small_agents import near

ARM = """<mujoco><worldbody><body name="base"><geom size="0.1"/>
  <body name="upper" gravcomp="1" pos="0 0 0.2"><joint name="shoulder" axis="0 0 1" range="-60 60"/>
    <geom size="0.05" pos="0.3 0 0"/>
    <body name="fore" gravcomp="1" pos="0.5 0 0"><joint name="elbow" axis="0 1 0"/><joint name="wrist" axis="1 0 0"/>
      <geom size="0.04" pos="0.2 0 0"/>
      <body name="finger" gravcomp="1" pos="0.4 0 0"><joint name="grip" type="slide" axis="1 0 0" range="0 0.05"/><geom size="0.02"/></body>
    </body></body></body></worldbody>
  <actuator><velocity name="a" joint="shoulder" kv="200"/><velocity name="b" joint="elbow" kv="200"/>
    <velocity name="c" joint="grip" kv="200"/></actuator></mujoco>"""
"""An arm on a pedestal, as in a robot's description; no actuator moves its wrist."""


def angle(simulation: Simulation, joint: str, body: str = "walker") -> float:
    """Returns the true position of a joint [degrees]."""
    return math.degrees(simulation.world.bodies[body].joints[joint].position)


def ended(motor: Any, group: str) -> str:
    return motor[f"{group}_end"]


# -- movements


@pytest.mark.parametrize(("to", "speed", "ticks"), [(30, 120, 25), (-45.5, 65, 70), ("12", "240", 5), (90, 100, 90), (0, 50, 1)])
def test_a_movement_to_an_angle_takes_its_time_and_ends_exactly_there(to: Any, speed: Any, ticks: int) -> None:
    simulation, motor = moving()
    motor.rotate_torso(to, speed)
    assert motor.busy
    assert motor.torso_busy
    assert until(simulation, lambda: not motor.torso_busy) == ticks + 1  # an answer is there when the next tick begins
    assert angle(simulation, "torso_yaw") == near(float(to), abs=0.01)
    assert motor.torso_yaw_angle == round(float(to))
    assert ended(motor, "torso") == "done"
    assert not motor.busy


@pytest.mark.parametrize(
    ("command", "given", "joint", "ends"),
    [
        ("rotate_torso", (), "torso_yaw", 90),
        ("rotate_torso", (None, -120), "torso_yaw", -90),
        ("extend_shoulder", ("left",), "left_shoulder_yaw", -20),
        ("extend_shoulder", ("right",), "right_shoulder_yaw", 20),
        ("compress_shoulder", ("left",), "left_shoulder_yaw", 20),
        ("compress_shoulder", ("right",), "right_shoulder_yaw", -20),
        ("rotate", ("head", "pitch"), "head_pitch", 45),
        ("rotate", ("head_pitch", None, None, -30), "head_pitch", -45),
    ],
)
def test_a_movement_without_an_angle_ends_at_the_limit_and_says_so(command: str, given: tuple[Any, ...], joint: str, ends: float) -> None:
    simulation, motor = moving()
    getattr(motor, command)(*given)
    until(simulation, lambda: not motor.busy)
    assert angle(simulation, joint) == near(ends, abs=0.01)
    assert ended(motor, joint.rpartition("_")[0]) == "limit"
    getattr(motor, command)(*given)
    assert until(simulation, lambda: not motor.busy) == 2, "at the limit it ends immediately"


@pytest.mark.parametrize("side", ["left", "right"])
def test_extending_moves_a_shoulder_forward_and_compressing_backward(side: str) -> None:
    simulation, motor = moving()
    body = simulation.world.bodies["walker"]
    ahead: dict[str, float] = {}
    for command in ("extend_shoulder", "compress_shoulder"):
        getattr(motor, command)(side, 15)
        until(simulation, lambda: not motor.busy)
        ahead[command] = body.get("pose", f"{side}_upper_arm").x
    assert ahead["extend_shoulder"] == near(-ahead["compress_shoulder"], abs=1e-4)
    assert ahead["extend_shoulder"] > 0.03


def test_a_stopped_movement_stays_where_it_was() -> None:
    simulation, motor = moving()
    motor.rotate_torso()
    simulation.step(20)
    motor.stop("torso")
    assert not motor.torso_busy
    assert ended(motor, "torso") == "stopped"
    stood = angle(simulation, "torso_yaw")
    assert stood == near(0.2 * 120, abs=0.3)
    simulation.step(20)
    assert angle(simulation, "torso_yaw") == near(stood, abs=1e-3)
    assert motor.parent.posture.chunk["torso_yaw"] == round(stood)


def test_several_muscle_groups_move_while_it_walks_and_turns() -> None:
    simulation, motor = moving()
    motor.walk(1.2)
    motor.turn(30, speed=60)
    motor.rotate_torso(60)
    motor.extend_shoulder("right", 10)
    motor.rotate("left_upper_arm", "pitch", angle=-40, speed=80)
    simulation.step(3)
    groups = ("legs", "torso", "left_shoulder", "right_shoulder", "left_upper_arm")
    assert [motor[f"{group}_busy"] for group in groups] == [True, True, False, True, True]
    assert motor.walking
    assert motor.turning
    assert until(simulation, lambda: not motor.turning) == 49
    assert ended(motor, "legs") == "done"
    assert motor.legs_busy
    until(simulation, lambda: not motor.torso_busy and not motor.left_upper_arm_busy)
    assert motor.walking
    pose = simulation.world.bodies["walker"].get("pose")
    assert math.degrees(pose.heading) == near(30, abs=0.05)
    speed = simulation.world.bodies["walker"].get("velocity").linear
    assert speed == near((1.2, 0, 0), abs=0.01)
    motor.stop()
    simulation.step(2)
    assert not motor.busy
    assert simulation.world.bodies["walker"].get("velocity").linear == near((0, 0, 0), abs=1e-3)


@pytest.mark.parametrize(("by", "speed"), [(90, 120), (-200, 240), (360, 180)])
def test_it_turns_by_the_commanded_angle(by: float, speed: float) -> None:
    simulation, motor = moving()
    motor.turn(by, speed)
    assert until(simulation, lambda: not motor.turning) == near(abs(by) / speed * 100 + 1, abs=1)
    assert math.degrees(simulation.world.bodies["walker"].base.pose[2]) == near(by, abs=0.02)
    assert ended(motor, "legs") == "done"


def test_walking_faster_or_stopping_the_legs_leaves_a_turn_and_limbs_alone() -> None:
    simulation, motor = moving()
    motor.turn(90, 90)
    motor.rotate_torso(80, 80)
    simulation.step(10)
    during(simulation, lambda: motor.walk(0.5))
    simulation.step(9)
    during(simulation, lambda: motor.walk(1.5))
    simulation.step(9)
    assert simulation.world.bodies["walker"].base.speed[0] == near(1.5, abs=0.01)
    during(simulation, lambda: motor.walk(0))
    assert not motor.walking
    assert ended(motor, "legs") == "stopped"
    assert until(simulation, lambda: not motor.turning) + 31 == 101
    assert math.degrees(simulation.world.bodies["walker"].base.pose[2]) == near(90, abs=0.05)
    assert motor.torso_busy is False
    assert angle(simulation, "torso_yaw") == near(80, abs=0.05)


def test_a_turn_without_an_end_changes_its_speed_while_it_walks() -> None:
    simulation, motor = moving()
    motor.walk(1.0)
    motor.turn(speed=20)
    simulation.step(50)
    motor.turn(speed=-40)
    simulation.step(50)
    assert motor.refusal is None
    assert motor.walking
    assert motor.turning
    heading = math.degrees(simulation.world.bodies["walker"].base.pose[2])
    assert heading == near(10 - 20, abs=0.7)
    motor.turn(30)
    assert motor.refusal == "busy", "one by an angle waits for its end"
    motor.turn(speed=0)
    simulation.step(5)
    assert motor.walking
    assert not motor.turning
    assert motor.legs_end == "stopped"


def test_it_turns_until_the_command_to_stop() -> None:
    simulation, motor = moving()
    motor.turn(speed=-50)
    simulation.step(100)
    assert motor.turning
    motor.stop("legs")
    simulation.step(5)
    assert math.degrees(simulation.world.bodies["walker"].base.pose[2]) == near(-50, abs=0.5)


def test_lowering_the_arms_moves_both_to_where_they_hang() -> None:
    simulation, motor = moving()
    motor.rotate("left_upper_arm", "pitch", angle=-50)
    motor.rotate("right_upper_arm", "roll", angle=-40)
    until(simulation, lambda: not motor.busy)
    motor.lower_arms(speed=100)
    assert motor.left_upper_arm_busy
    assert motor.right_upper_arm_busy
    assert until(simulation, lambda: not motor.busy) == near(51, abs=1)
    assert motor.left_upper_arm_pitch_angle == motor.right_upper_arm_roll_angle == 0


def test_stopping_several_groups_leaves_the_others_moving() -> None:
    simulation, motor = moving()
    motor.walk(1.0)
    motor.rotate_torso()
    motor.extend_shoulder("left", speed=30)
    simulation.step(10)
    motor.stop("torso", "left_shoulder")
    assert (motor.torso_end, motor.left_shoulder_end, motor.walking) == ("stopped", "stopped", True)
    simulation.step(10)
    assert angle(simulation, "torso_yaw") == near(12, abs=0.3)
    assert simulation.world.bodies["walker"].get("pose").x == near(0.2, abs=0.01)


@pytest.mark.parametrize("given", ["chunk", "buffer", "text"])
def test_a_posture_is_assumed_again(given: str) -> None:
    simulation, motor = moving()
    motor.rotate_torso(50)
    motor.extend_shoulder("left", 15)
    until(simulation, lambda: not motor.busy)
    posture = motor.parent.posture
    known: Any = {"chunk": posture.chunk.copy(), "buffer": posture, "text": "posture:any torso_yaw:50 left_shoulder_yaw:-15 width:9"}[given]
    motor.rotate_torso(-10)
    motor.compress_shoulder("left")
    until(simulation, lambda: not motor.busy)
    if given == "buffer":
        posture.set({"torso_yaw": 50, "left_shoulder_yaw": -15})
    motor.assume(known, "60")
    assert until(simulation, lambda: not motor.torso_busy) == 101
    assert (motor.torso_yaw_angle, motor.left_shoulder_yaw_angle) == (50, -15)
    assert motor.torso_end == "done"
    motor.assume("torso_yaw:91")
    assert motor.refusal == "limit"
    with pytest.raises(WorldError, match="'width:1' names no joint of walker; it has pelvis_yaw"):
        motor.assume("width:1")
    with pytest.raises(WorldError, match="assume: torso_yaw: must be a number"):
        motor.assume("torso_yaw:left")


def test_a_movement_is_prepared_for_as_long_as_a_parameter_says_and_can_be_stopped_meanwhile() -> None:
    simulation, motor = moving(preparation=0.25, initiation=0.05)
    motor.rotate_torso(12)
    simulation.step(30)
    assert motor.torso_busy
    assert angle(simulation, "torso_yaw") < 2
    assert 30 + until(simulation, lambda: not motor.torso_busy) == near(41, abs=1)
    motor.rotate_torso(-12)
    simulation.step(10)
    motor.stop("torso")
    simulation.step(50)
    assert angle(simulation, "torso_yaw") == near(12, abs=0.01)


def test_the_former_speed_continues_while_a_change_of_speed_is_prepared() -> None:
    simulation, motor = moving(preparation=0.25, initiation=0.05)
    motor.walk(1.0)
    motor.turn(speed=20)
    simulation.step(50)
    base = simulation.world.bodies["walker"].base
    motor.walk(0.5)
    motor.turn(speed=-40)
    simulation.step(29)
    assert (base.speed[0], math.degrees(base.speed[2])) == (near(1.0, abs=0.02), near(20, abs=0.5))
    simulation.step(15)
    assert (base.speed[0], math.degrees(base.speed[2])) == (near(0.5, abs=0.02), near(-40, abs=0.5))
    motor.walk(1.5)
    motor.walk(0)
    motor.walk(0.8)
    simulation.step(60)
    assert base.speed[0] == near(0.8, abs=0.02), "a change in preparation ends with the walk that it would change"


def test_a_speed_may_change_while_its_movement_is_prepared() -> None:
    simulation, motor = moving(preparation=0.25)
    motor.walk(1.0)
    motor.turn(speed=20)
    simulation.step(10)
    motor.walk(1.5)
    motor.turn(speed=-40)
    assert (motor.error, motor.refusal) == (False, None)
    base = simulation.world.bodies["walker"].base
    simulation.step(20)
    assert (base.speed[0], math.degrees(base.speed[2])) == (near(1.0, abs=0.02), near(20, abs=0.5))
    simulation.step(15)
    assert (base.speed[0], math.degrees(base.speed[2])) == (near(1.5, abs=0.02), near(-40, abs=0.5))


# -- refusals


def test_a_busy_group_refuses_and_others_do_not() -> None:
    simulation, motor = moving(trace="all")
    motor.extend_shoulder("left")
    motor.compress_shoulder("left")
    assert (motor.error, motor.refusal) == (True, "busy")
    motor.rotate_torso(40)
    assert (motor.error, motor.refusal) == (False, None)
    until(simulation, lambda: not motor.busy)
    assert angle(simulation, "left_shoulder_yaw") == near(-20, abs=0.01)

    refused = [event.data for event in simulation.trace or () if event.kind == "refused"]
    assert refused == [{"movement": "compress_shoulder_left", "why": "busy"}]


@pytest.mark.parametrize(
    ("command", "given"),
    [
        ("walk", (0.5,)),
        ("walk", (0,)),
        ("turn", (None, 10)),
        ("turn", (None, 0)),
        ("feel", ("x",)),
        ("stop", ("torso",)),
        ("stop", ()),
        ("rotate_torso", (10,)),
    ],
)
def test_an_accepted_command_clears_an_earlier_refusal(command: str, given: tuple[Any, ...]) -> None:
    simulation, motor = moving()
    motor.walk(1)
    motor.turn(speed=20)
    simulation.step(5)
    motor.rotate_torso(200)
    assert (motor.error, motor.refusal) == (True, "limit")
    getattr(motor, command)(*given)
    assert (motor.error, motor.refusal) == (False, None)


def test_a_command_that_would_also_move_a_busy_group_is_refused() -> None:
    simulation, motor = moving()
    motor.rotate("left_upper_arm", "pitch", angle=-90)
    simulation.step(2)
    motor.lower_arms()
    assert motor.refusal == "busy"
    assert not motor.right_upper_arm_busy


def test_an_angle_beyond_the_limit_is_refused() -> None:
    simulation, motor = moving()
    motor.rotate_torso(90.5)
    assert (motor.error, motor.refusal) == (True, "limit")
    simulation.step(5)
    assert not motor.busy
    assert angle(simulation, "torso_yaw") == near(0)


@pytest.mark.parametrize(
    ("command", "given", "message"),
    [
        ("rotate", ("torso_jaw",), r"walker has no joint 'torso_jaw'; did you mean 'torso_yaw'\?"),
        ("rotate", ("torso",), "'torso' has several joints; give the axis: yaw, pitch, roll"),
        ("rotate", ("torso", "yew"), r"walker: torso has no axis 'yew'; did you mean 'yaw'\?"),
        (
            "rotate",
            ("torso_yaw", 30),
            r"walker: 'torso_yaw' is a joint, and only a part takes an axis \(got 30\); give an angle by name: angle=20",
        ),
        ("rotate", ("tors", "yaw"), r"no jointed part 'tors'; did you mean 'torso'\?"),
        ("rotate", ("torso", "yaw", "far"), r"rotate: angle: must be a number \(got 'far'\)"),
        ("rotate_torso", (10, 0), r"rotate_torso: speed: must be > 0 to go to an angle \(got 0\)"),
        ("rotate_torso", (None, 0), r"rotate_torso: speed: must not be 0"),
        ("extend_shoulder", ("lift",), r"extend_shoulder has no side 'lift'; did you mean 'left'\?"),
        ("extend_shoulder", (None,), "extend_shoulder has no side None; it has left, right"),
        ("rotate_torso", (float("nan"),), "angle: must be a finite number"),
        ("move", ("rotate_trunk",), r"walker has no movement 'rotate_trunk'; did you mean 'rotate_torso'\?"),
        ("move", ("lower_arms", None, 30), "lower_arms always ends in the same posture"),
        ("stop", ("leg",), r"walker has no muscle group 'leg'; did you mean 'legs'\?"),
        ("walk", (50,), r"walk: speed: must be <= [\d.]+ for walker \(got 50\)"),
        ("turn", (90, 1e5), r"turn: speed: must be <= [\d.]+ for walker \(got 100000\)"),
        ("rotate_torso", (30, 1e5), r"rotate_torso: speed: must be <= [\d.]+ for walker \(got 100000\)"),
        ("rotate_torso", (30, 1e-5), r"rotate_torso: speed: must be >= 5\.7e-05 for walker, or 0 \(got 1e-05\)"),
        ("turn", (None, 1e-9), r"turn: speed: must be >= 5\.7e-05 for walker, or 0 \(got 1e-09\)"),
        ("rotate", ([1, 2],), r"walker has no joint \[1, 2\]; it has pelvis_yaw"),
        ("rotate", (np.array([1, 2]), "yaw"), r"walker has no jointed part array\(\[1, 2\]\)"),
        ("feel", (object(),), r"feel: name: must be a name for the posture \(got <object"),
        ("feel", (" ",), r"feel: name: must be a name for the posture \(got ' '\)"),
        ("turn", (2000,), r"turn: angle: must be <= 1080 \(got 2000\)"),
        ("walk", ("fast",), r"walk: speed: must be a number \(got 'fast'\)"),
    ],
)
def test_unknown_names_and_impossible_arguments_are_errors(command: str, given: tuple[Any, ...], message: str) -> None:
    _, motor = moving()
    with pytest.raises(WorldError, match=message):
        getattr(motor, command)(*given)


WRONG = [("angle_grid", 0), ("size_noise", -1), ("patience", 0), ("speed", float("inf")), ("size_noise", 1e308), ("size_grid", 1e-310)]


@pytest.mark.parametrize(("parameter", "value"), [*WRONG, ("buffer", "posture"), ("memory", Buffer())])
def test_parameters_are_checked(parameter: str, value: Any) -> None:
    with pytest.raises(ParameterError, match=rf"Motor\.{parameter}: must be"):
        Motor(**{parameter: value})


@pytest.mark.parametrize(("parameter", "value"), [*WRONG, ("angle_grid", None), ("speed", True), ("busy", 1)])
def test_parameters_are_checked_when_a_user_changes_them(parameter: str, value: Any) -> None:
    simulation, motor = moving()
    with pytest.raises(Actr3dError, match="must be"):
        simulation.command("parameter", f"walker.motor.{parameter}", value)
    simulation.command("parameter", "walker.motor.patience", None)
    assert motor.patience is None


def test_an_agent_without_a_body_gets_an_error() -> None:
    agent: Any = type("Ghost", (ACTR,), {"motor": Motor()})()
    agent.run(0.1)
    with pytest.raises(SimulationError, match="has no body"):
        agent.motor.walk(1)
    with pytest.raises(SimulationError, match="does not know its body yet"):
        _ = agent.motor.body


def test_a_command_that_a_body_cannot_carry_out_is_an_error_at_its_line() -> None:
    simulation, motor = moving(body=Car(name="walker"))
    with pytest.raises(WorldError, match=r"walker cannot walk; its commands are: .*steering"):
        motor.walk(1)
    with pytest.raises(WorldError, match="walker has no movement 'rotate_torso'; it has no movements"):
        motor.rotate_torso()
    motor.rotate("steer", angle=10, speed=20)
    until(simulation, lambda: not motor.busy)
    assert angle(simulation, "steer") == near(10, abs=0.05)


def test_commands_wait_until_the_body_is_known_and_their_errors_name_the_line() -> None:
    simulation = Simulation(Scene(parts=(Floor(), Mannequin(name="walker"))), {"walker": mover()})
    motor = motor_of(simulation)
    motor.rotate_torso(12)
    assert motor.busy
    motor.rotate("torsoo_yaw")
    simulation.step()
    with pytest.raises(WorldError, match="did you mean 'torso_yaw'") as failed:
        simulation.step()
    assert "test_motor.py" in str(failed.value.__notes__)


# -- obstacles


def test_a_walker_at_a_wall_is_blocked() -> None:
    simulation, motor = moving(Wall(name="wall", start=(1.0, -2.0), end=(1.0, 2.0)))
    motor.walk(1.0)
    ticks = until(simulation, lambda: not motor.walking)
    assert ended(motor, "legs") == "blocked"
    x = simulation.world.bodies["walker"].get("pose").x
    assert 0.7 < x < 0.9
    assert ticks == near(x * 100 + 20, abs=15)


def test_a_limb_that_something_holds_back_is_blocked_and_stops_pushing() -> None:
    simulation, motor = moving(Wall(name="wall", start=(0.5, -1.0), end=(0.5, 1.0)))
    motor.rotate("left_upper_arm", "pitch", angle=-90, speed=60)
    until(simulation, lambda: not motor.busy)
    assert ended(motor, "left_upper_arm") == "blocked"
    assert angle(simulation, "left_upper_arm_pitch") == near(-37, abs=3)
    walker = simulation.world.bodies["walker"]
    assert walker.hold.joint_speed(walker.joints["left_upper_arm_pitch"]) == 0
    assert motor.parent.posture.chunk["end"] == "blocked"


def test_a_body_at_a_wall_can_walk_away_from_it() -> None:
    simulation, motor = moving(Wall(name="wall", start=(1.0, -2.0), end=(1.0, 2.0)))
    motor.walk(1.5)
    until(simulation, lambda: not motor.walking)
    motor.walk(-2.0)
    simulation.step(100)
    assert motor.walking
    assert simulation.world.bodies["walker"].get("pose").x < -0.5


def test_without_a_limit_of_patience_it_keeps_pushing() -> None:
    simulation, motor = moving(Wall(name="wall", start=(1.0, -2.0), end=(1.0, 2.0)), patience=None)
    motor.walk(1.0)
    simulation.step(300)
    assert motor.walking


@pytest.mark.parametrize("legs", [("walk", 1.0), ("turn", 90, 90), ("turn", None, 90)])
def test_a_movement_that_a_user_ends_is_over(legs: tuple[Any, ...]) -> None:
    simulation, motor = moving()
    motor.rotate_torso()
    getattr(motor, legs[0])(*legs[1:])
    simulation.step(10)
    simulation.command("stop")
    simulation.step(2)
    assert not motor.busy
    assert ended(motor, "torso") == ended(motor, "legs") == "stopped"


# -- any body with joints


BODIES = {
    "person": Mannequin(name="walker"),
    "with a bar": Mannequin(name="walker", load=Load(shape="bar", size=(1.0, 0.03)), trunk="box"),
    "car": Car(name="walker"),
    "arm": ImportedBody(name="walker", text=ARM),
    "stone": ImportedBody(name="walker", text="<mujoco><worldbody><body name='stone'><geom size='0.1'/></body></worldbody></mujoco>"),
}


@pytest.mark.parametrize("kind", BODIES)
def test_anatomy_and_proprioception_have_the_same_order_of_joints(kind: str) -> None:
    simulation, motor = moving(body=BODIES[kind])
    body = simulation.world.bodies["walker"]
    plan, felt = body.get("anatomy"), body.get("proprioception")
    joints = [joint for part in plan.parts for joint in part.joints]
    assert [joint.name for joint in joints] == list(body.joints) == list(motor._limbs.order)
    assert felt.positions == tuple(joint.position for joint in body.joints.values())
    assert [part.name for part in plan.parts] == [part.name for part in motor.body.subtree()] == list(body.parts)
    for joint in joints:
        limits = body.joints[joint.name].limits
        assert limits == (-math.inf if joint.lower is None else joint.lower, math.inf if joint.upper is None else joint.upper)
        assert joint.driven == body.joints[joint.name].driven
    for movement in plan.movements:
        assert {joint for joint, _ in movement.joints} <= {joint.name for joint in joints if joint.driven}
    box = body.bounding_box("body")
    size = body.get("bounding_box")
    assert (size.width, size.depth, size.height) == (box.width, box.depth, box.height) == (felt.width, felt.depth, felt.height)
    assert motor.width == near(box.width, abs=0.0051)


def test_an_imported_arm_is_known_and_moved() -> None:
    simulation, motor = moving(body=ImportedBody(name="arm", text=ARM))
    assert motor._limbs.groups == ("upper", "fore", "finger")
    motor.rotate("shoulder", angle=40, speed=80)
    motor.rotate("fore", "pitch", speed=30)
    motor.rotate("finger", speed=0.1)
    with pytest.raises(WorldError, match="joint 'wrist' has no muscles"):
        motor.rotate("wrist", angle=3)
    simulation.step(52)
    assert angle(simulation, "shoulder", "arm") == near(40, abs=0.5)
    assert (motor.shoulder_angle, motor.upper_end, motor.finger_end) == (40, "done", "limit")
    assert motor.grip_position == near(0.05, abs=0.001)
    assert motor.fore_busy, "a joint without limits turns until a command stops it"
    motor.stop("fore")
    simulation.step(2)
    assert motor.fore_end == "stopped"
    assert motor.elbow_angle == near(15, abs=2)
    assert {"shoulder", "elbow", "wrist", "grip"} <= motor.parent.posture.chunk.keys()


@pytest.mark.parametrize("name", ["width", "posture"])
def test_a_joint_with_the_name_of_another_slot_of_postures_is_refused(name: str) -> None:
    arm = ImportedBody(name="arm", text=ARM.replace('"elbow"', f'"{name}"'))
    with pytest.raises(WorldError, match=f"arm: the joint '{name}' has the name of another slot of postures; rename it"):
        moving(body=arm)


@pytest.mark.parametrize("name", ["left elbow", "left/elbow", "left-elbow", "1"])
def test_joints_that_no_pattern_can_name_are_warned_of(name: str) -> None:
    arm = ImportedBody(name="arm", text=ARM.replace('"elbow"', f'"{name}"'))
    with pytest.warns(ModelWarning, match=f"arm: patterns cannot name the joints '{name}'; to match them, rename them"):
        simulation, motor = moving(body=arm)
    during(simulation, lambda: motor.rotate(name, angle=10))


def test_a_joint_that_slides_needs_a_speed() -> None:
    _, motor = moving(body=ImportedBody(name="arm", text=ARM))
    with pytest.raises(WorldError, match=r"joint 'grip' slides; give its speed \[m/s\]"):
        motor.rotate("grip")


@pytest.mark.parametrize("speed", [None, 0.1])
def test_a_joint_that_slides_without_muscles_is_reported_before_its_speed_is_asked_for(speed: float | None) -> None:
    _, motor = moving(body=ImportedBody(name="arm", text=ARM.replace('<velocity name="c" joint="grip" kv="200"/>', "")))
    with pytest.raises(WorldError, match="joint 'grip' has no muscles"):
        motor.rotate("grip", angle=0.05, speed=speed)


def test_a_weak_limb_that_comes_as_near_as_it_can_is_done_and_one_that_cannot_is_blocked() -> None:
    text = ARM.replace('gravcomp="1"', "")
    simulation, motor = moving(body=ImportedBody(name="arm", text=text))
    motor.rotate("elbow", angle=40)
    until(simulation, lambda: not motor.busy)
    assert motor.fore_end == "done"
    assert angle(simulation, "elbow", "arm") == near(40, abs=1)
    simulation, motor = moving(body=ImportedBody(name="arm", text=text.replace('kv="200"', 'kv="0.2"')))
    motor.rotate("elbow", angle=-60, speed=50)
    until(simulation, lambda: not motor.busy)
    assert motor.fore_end == "blocked"


def test_an_imported_body_may_have_names_for_movements() -> None:
    reach = NamedMovement(name="reach", joints=(("shoulder", -1), ("elbow", 1)))
    fold = NamedMovement(name="fold", joints=(("shoulder", 1), ("elbow", 1)), to=math.radians(45))
    simulation, motor = moving(body=ImportedBody(name="arm", text=ARM, movements=(reach, fold)))
    motor.move("reach", angle=20, speed=60)
    assert (motor.upper_busy, motor.fore_busy, motor.finger_busy) == (True, True, False)
    until(simulation, lambda: not motor.busy)
    assert (motor.shoulder_angle, motor.elbow_angle) == near((-20, 20), abs=0.5)
    motor.move("fold")
    until(simulation, lambda: not motor.busy)
    assert (motor.shoulder_angle, motor.elbow_angle) == near((45, 45), abs=0.5)


def test_a_pattern_without_a_muscle_group_is_reported_once_the_body_is_known() -> None:
    text = """
from actr3d.actr import *
from actr3d.motor import Motor

class Slip(ACTR):
    goal = Buffer()
    motor = Motor()
    def go(goal="go", motor="torso_bussy:False legs_busy:False width:?w"):
        pass
"""
    simulation = Simulation(Scene(parts=(Floor(), Mannequin(name="walker"))), {"walker": load_text(text, "slip.py").Slip})
    with pytest.warns(
        ModelWarning, match=r"'go' can never match: 'motor' has no attribute 'torso_bussy'; did you mean 'torso_busy'\?"
    ) as caught:
        simulation.step(3)
    assert len(caught) == 1
    simulation.seek(0)
    simulation.step(3)


def test_each_kind_of_body_is_checked_for_the_muscle_groups_of_an_agent_once() -> None:
    text = """
from actr3d.actr import *
from actr3d.motor import Motor

class Turner(ACTR):
    goal = Buffer()
    motor = Motor()
    def go(goal="go", motor="torso_busy:False"):
        pass
"""
    make = load_text(text, "turner.py").Turner
    Simulation(Scene(parts=(Floor(), Mannequin(name="walker"))), {"walker": make}).step(3)
    with pytest.warns(ModelWarning, match="'motor' has no attribute 'torso_busy'") as caught:
        Simulation(Scene(parts=(Floor(), Car(name="car"))), {"car": make}).step(3)
    assert len(caught) == 1
    Simulation(Scene(parts=(Floor(), Car(name="car"))), {"car": make}).step(3)


def test_proprioception_takes_no_noise() -> None:
    with pytest.raises(WorldError, match="give it to the motor module instead"):
        moving(body=Mannequin(name="walker", noise=(("proprioception", 0.1),)))


def test_two_agents_move_their_own_bodies() -> None:
    bodies = (Mannequin(name="one"), Mannequin(name="other", position=(0, 2)))
    simulation = Simulation(Scene(parts=(Floor(), *bodies)), {"one": mover(), "other": mover()})
    simulation.step(2)
    one, other = motor_of(simulation, "one"), motor_of(simulation, "other")
    one.rotate_torso(30)
    other.rotate_torso(-60)
    until(simulation, lambda: not other.busy)
    assert (one.torso_yaw_angle, other.torso_yaw_angle) == (30, -60)


def test_no_request_is_made_while_nothing_moves() -> None:
    simulation, motor = moving(trace="all")
    simulation.step(50)
    answers = [event for event in simulation.trace or () if event.kind == "answer"]
    assert [event.data["word"] for event in answers] == ["anatomy", "proprioception"]
    # The recorded physics has the positions of all joints; here they would be most of the trace.
    assert answers[1].data["value"].keys() == {"moving", "speed", "walking", "turning", "width", "depth", "height", "middle"}
    motor.rotate_torso(12)
    simulation.step(50)
    answers = [event for event in simulation.trace or () if event.kind == "answer"]
    assert len(answers) == 2 + 10
    assert simulation.run().ended_by == "done"
