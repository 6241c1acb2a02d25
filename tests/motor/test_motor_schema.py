"""The body schema: felt positions of the body, and remembered postures."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import pytest

from actr3d.actr import DMBaseLevel
from actr3d.actr.loading import load_text
from actr3d.errors import WorldError
from actr3d.motor import BodyPart
from actr3d.simulation import Simulation
from actr3d.world import Floor, Gait, Load, Mannequin, Scene, SimpleObject
from tests.helpers.motor_bodies import motor_of, moving, until
from tests.helpers.small_agents import near

NAMED = ("torso_yaw", "left_shoulder_yaw", "right_shoulder_yaw")


def postures(motor: Any, pattern: str = "posture:?") -> list[dict[str, Any]]:
    return [dict(chunk) for chunk in motor.parent.memory.find_matching_chunks(pattern)]


def swing(simulation: Simulation, motor: Any, to: float) -> None:
    """Turns torso and both shoulders to one side, until all have arrived."""
    forward, backward = ("right", "left") if to > 0 else ("left", "right")
    motor.rotate_torso(to)
    motor.extend_shoulder(forward)
    motor.compress_shoulder(backward)
    until(simulation, lambda: not motor.busy)


# -- knowledge of the body


def test_the_parts_are_those_of_the_body_in_its_order() -> None:
    _, motor = moving()
    body: BodyPart = motor.body
    assert body.name == "legs"
    assert [part.name for part in body.parts] == ["pelvis"]
    assert [part.name for part in body.part("torso").parts] == ["left_shoulder", "right_shoulder", "head"]
    assert [part.name for part in body.subtree()][:4] == ["legs", "pelvis", "torso", "left_shoulder"]
    assert [joint.axis for joint in body.part("torso").joints] == ["yaw", "pitch", "roll"]
    assert body.part("left_shoulder").joints[0].lower == near(math.radians(-20))
    with pytest.raises(WorldError, match="legs has no part 'tors'; did you mean 'torso'"):
        body.part("tors")
    with pytest.raises(WorldError, match="has no joint 'torso'"):
        motor.joint("torso")


def test_extremes_are_those_of_the_true_angles_up_to_the_last_tick() -> None:
    simulation, motor = moving()
    body = simulation.world.bodies["walker"]
    seen: dict[str, list[float]] = {name: [joint.position] for name, joint in body.joints.items()}

    def watch() -> bool:
        for name, joint in body.joints.items():
            seen[name].append(joint.position)
        return not motor.busy

    for to in (35, -20.4, 10):
        motor.rotate_torso(to)
        motor.rotate("head", "yaw", angle=-to)
        until(simulation, watch)
    for name, angles in seen.items():
        joint = motor.joint(name)
        # Joints without a command give way a little and return, also while nothing is felt.
        exact = 1e-8 if name in ("torso_yaw", "head_yaw") else 1e-4
        assert (joint.minimum, joint.maximum, joint.angle) == near((min(angles), max(angles), angles[-1]), abs=exact, rel=0)


def test_the_felt_size_is_that_of_the_body_in_its_posture() -> None:
    simulation, motor = moving(body=Mannequin(name="walker", load=Load(shape="bar", size=(1.2, 0.03))))
    assert (motor.width, motor.height) == (1.2, 1.745)
    swing(simulation, motor, 60)
    box = simulation.world.bodies["walker"].bounding_box("body")
    assert (motor.width, motor.depth, motor.height) == near((box.width, box.depth, box.height), abs=0.0005)
    assert motor.width < 1.0 < motor.depth


def test_turning_the_whole_body_does_not_change_the_felt_size() -> None:
    simulation, motor = moving()
    motor.turn(90)
    until(simulation, lambda: not motor.busy)
    assert motor.width == 0.444


def test_a_changed_size_is_felt_although_no_joint_has_moved() -> None:
    simulation, motor = moving(size_noise=0.01)
    reading = simulation.world.bodies["walker"].get("proprioception")
    motor._feel(reading)
    width = motor.width
    motor._feel(reading)
    assert motor.width == width, "the noise is the same as long as nothing changes"
    motor._feel(replace(reading, width=0.9))
    assert motor.width == near(0.9, abs=0.05)


# -- postures


def test_a_posture_is_stored_at_the_start_and_where_movements_end() -> None:
    simulation, motor = moving(extreme_step=None)
    start = {"posture": "start", "end": "felt", "extreme": "none", "width": 0.444, "depth": 0.25, "height": 1.745, "middle": 0}
    assert postures(motor) == [{**dict.fromkeys(NAMED, 0), **start}]
    motor.rotate_torso(30)
    until(simulation, lambda: not motor.busy)
    (ended,) = postures(motor, "posture:rotate_torso end:done")
    assert (ended["torso_yaw"], ended["extreme"], ended["width"] < 0.444) == (30, "maximum", True)
    assert motor.parent.posture.chunk == ended
    motor.rotate_torso(10)
    until(simulation, lambda: not motor.busy)
    assert postures(motor, "torso_yaw:10")[0]["extreme"] == "none"
    motor.extend_shoulder("left")
    until(simulation, lambda: not motor.busy)
    (ended,) = postures(motor, "posture:extend_shoulder_left end:limit")
    assert (ended["left_shoulder_yaw"], ended["extreme"], ended["torso_yaw"]) == (-20, "minimum", 10)


def test_a_posture_includes_other_joints_that_have_left_their_start() -> None:
    simulation, motor = moving()
    motor.rotate("pelvis", "yaw", angle=6)
    until(simulation, lambda: not motor.busy)
    assert postures(motor, "posture:pelvis_yaw")[0]["pelvis_yaw"] == 6
    motor.rotate("pelvis", "yaw", angle=0)
    until(simulation, lambda: not motor.busy)
    assert "pelvis_yaw" not in motor.parent.posture.chunk


def test_new_extremes_are_stored_on_the_way_once() -> None:
    simulation, motor = moving(extreme_step=10)
    for to, stored in ((45, [11, 22, 32, 43]), (-45, [-10, -21, -31, -42]), (45, []), (-45, []), (66, [56])):
        known = len(postures(motor, "end:passing"))
        motor.rotate_torso(to)
        until(simulation, lambda: not motor.busy)
        new = postures(motor, "end:passing")[known:]
        assert [chunk["torso_yaw"] for chunk in new] == near(stored, abs=1.5)
        assert {chunk["extreme"] for chunk in new} <= {"maximum" if to > 0 else "minimum"}
        widths = [chunk["width"] for chunk in new]
        assert widths == sorted(widths, reverse=True)


def test_a_joint_that_a_user_moves_meanwhile_does_not_hide_the_extremes_of_another() -> None:
    simulation, motor = moving(extreme_step=10)
    simulation.command("position", "pelvis_yaw", math.radians(35), math.radians(120), body="walker")
    motor.rotate_torso(45, 120)
    until(simulation, lambda: not motor.busy)
    passing = postures(motor, "end:passing")
    assert [chunk["torso_yaw"] for chunk in passing] == near([11, 22, 32, 43], abs=2)
    assert all(chunk["posture"] == "rotate_torso" for chunk in passing)
    assert "pelvis_yaw" in passing[0]


def test_postures_felt_again_merge_and_gain_activation() -> None:
    simulation, motor = moving()
    memory = motor.parent.memory
    memory.base_level = DMBaseLevel(memory)
    for to in (45, -45) * 2:
        motor.rotate_torso(to, 60)
        until(simulation, lambda: not motor.busy)
    count = len(memory.dm)
    before = memory.get_activation(postures(motor, "posture:rotate_torso end:done extreme:maximum")[0])
    for to in (45, -45) * 4:
        motor.rotate_torso(to, 60)
        until(simulation, lambda: not motor.busy)
    assert len(memory.dm) == count
    assert memory.get_activation(postures(motor, "posture:rotate_torso end:done extreme:maximum")[0]) > before + 0.3


def test_a_posture_that_is_narrow_enough_is_asked_for_by_a_function() -> None:
    simulation, motor = moving()
    swing(simulation, motor, 70)
    memory = motor.parent.memory

    def narrow(chunk: dict[str, Any], _: Any) -> bool:
        return chunk["width"] <= 0.35

    memory.request(["end:passing", narrow])
    simulation.step(10)
    found = motor.parent.retrieval.chunk
    assert found["width"] <= 0.35
    assert found["posture"] == "rotate_torso"


def test_turns_to_the_left_and_right_are_mirrored() -> None:
    simulation, motor = moving()
    swing(simulation, motor, 60)
    left = motor.parent.posture.chunk.copy()
    swing(simulation, motor, -60)
    right = motor.parent.posture.chunk
    assert (left["width"], left["depth"], left["height"]) == (right["width"], right["depth"], right["height"])
    assert left["torso_yaw"] == -right["torso_yaw"]
    assert left["left_shoulder_yaw"] == -right["right_shoulder_yaw"] == 20


def test_a_posture_is_stored_on_request_under_a_name() -> None:
    simulation, motor = moving()
    motor.rotate_torso(50)
    simulation.step(10)
    motor.feel("halfway")
    simulation.step(2)
    (felt,) = postures(motor, "posture:halfway")
    assert felt["end"] == "felt"
    assert felt["torso_yaw"] == near(13, abs=1)


def test_storing_a_posture_does_not_clear_a_failed_request() -> None:
    simulation, motor = moving()
    memory = motor.parent.memory
    memory.request("posture:unheard")
    simulation.step(20)
    assert memory.error
    motor.feel()
    simulation.step(2)
    assert memory.error
    assert postures(motor, "posture:felt")


@pytest.mark.parametrize(("angle_grid", "size_grid"), [(5.0, 0.05), (0.5, 0.001)])
def test_numbers_are_on_the_grid(angle_grid: float, size_grid: float) -> None:
    simulation, motor = moving(angle_grid=angle_grid, size_grid=size_grid)
    motor.rotate_torso(33.3)
    until(simulation, lambda: not motor.busy)
    chunk = motor.parent.posture.chunk
    assert chunk["torso_yaw"] == near(33.3, abs=angle_grid / 2 + 1e-9)
    for value, grid in ((chunk["torso_yaw"], angle_grid), (chunk["width"], size_grid)):
        assert value / grid == near(round(value / grid))
    box = simulation.world.bodies["walker"].bounding_box("body")
    assert chunk["width"] == near(box.width, abs=size_grid / 2 + 1e-9)


def test_noise_is_of_the_given_spread_and_from_the_seed() -> None:
    def felt(seed: int) -> tuple[list[float], list[float]]:
        simulation, motor = moving(seed=seed, angle_noise=3.0, size_noise=0.02, angle_grid=0.01, size_grid=1e-4)
        angles: list[float] = []
        widths: list[float] = []
        for n in range(60):
            to = 30 + n % 2
            motor.rotate_torso(to)
            until(simulation, lambda: not motor.busy)
            angles.append(motor.torso_yaw_angle - to)
            widths.append(motor.width - simulation.world.bodies["walker"].bounding_box("body").width)
            assert motor.torso_end == "done"
        return angles, widths

    angles, widths = felt(1)
    for values, sd in ((angles, 3.0), (widths, 0.02)):
        assert abs(sum(values) / len(values)) < 4 * sd / math.sqrt(60)
        assert 0.7 * sd < math.sqrt(sum(value**2 for value in values) / len(values)) < 1.3 * sd
    assert felt(1) == (angles, widths)
    assert felt(2) != (angles, widths)


FINDER = """
from actr3d.actr import *
from actr3d.motor import Motor

class Finder(ACTR):
    goal = Buffer()
    retrieval = Buffer()
    posture = Buffer()
    memory = Memory(retrieval)
    motor = Motor(posture, memory=memory)

    def init():
        goal.set("learn 60")

    def learn(goal="learn ?to", motor="torso_busy:False"):
        motor.rotate_torso(to, "100")
        goal.set("turn")

    def recall(goal="turn", motor="torso_busy:False torso_end:done", posture="end:done width:?w"):
        memory.request("posture:rotate_torso end:done width:?w torso_yaw:?yaw")
        goal.set("recall")

    def back(goal="recall", retrieval="width:?width torso_yaw:?yaw"):
        motor.rotate("torso", "yaw", yaw)
        goal.set("done ?width")
"""


def test_productions_command_bound_values_and_match_busy_and_postures() -> None:
    simulation = Simulation(Scene(parts=(Floor(), Mannequin(name="walker"))), {"walker": load_text(FINDER, "finder.py").Finder})
    simulation.run()
    motor = motor_of(simulation)
    assert motor.parent.goal[0] == "done"
    assert float(motor.parent.goal[1]) == motor.width < 0.4
    assert motor.torso_yaw_angle == 60


# -- postures that are known without a movement


def known(motor: Any, simulation: Simulation, posture: Any, movement: str = "rotate_torso") -> list[dict[str, Any]]:
    motor.know(movement, posture)
    assert motor.busy
    until(simulation, lambda: not motor.busy)
    return postures(motor, f"posture:{movement} end:done")


@pytest.mark.parametrize("gait", [None, Gait()], ids=["glides", "walks"])
def test_a_known_posture_is_the_one_that_a_movement_leads_to(gait: Gait | None) -> None:
    body = Mannequin(name="walker", sideways=True, gait=gait)
    simulation, motor = moving(body=body, extreme_step=None)
    motor.rotate("stance", "yaw", 36)
    swing(simulation, motor, 44)
    (felt,) = postures(motor, "posture:rotate_torso end:done")
    other, knowing = moving(body=body, extreme_step=None)
    (chunk,) = known(knowing, other, {joint: felt[joint] for joint in ("stance_yaw", *NAMED)})
    sizes = "width", "depth", "height", "middle"
    assert {slot: chunk[slot] for slot in chunk if slot not in sizes} == {slot: felt[slot] for slot in felt if slot not in sizes}
    assert [float(chunk[size]) for size in sizes] == near([float(felt[size]) for size in sizes], abs=0.002)


def test_a_known_posture_moves_nothing_and_is_no_reading_of_the_present() -> None:
    (knowing, motor), (other, plain) = moving(), moving()
    width = motor.width
    known(motor, knowing, {"torso_yaw": 60})
    while other.time < knowing.time:
        other.step()
    assert knowing.world.state_bytes() == other.world.state_bytes()
    assert motor.width == plain.width == width
    assert motor.torso_yaw_angle == 0


def test_known_postures_are_the_range_of_a_joint() -> None:
    simulation, motor = moving()
    known(motor, simulation, {"torso_yaw": 40})
    known(motor, simulation, {"torso_yaw": -40})
    known(motor, simulation, {"torso_yaw": 20})
    extremes = {float(chunk["torso_yaw"]): chunk["extreme"] for chunk in postures(motor, "posture:rotate_torso")}
    assert extremes == {40: "maximum", -40: "minimum", 20: "none"}
    assert math.degrees(motor.joint("torso_yaw").maximum) == near(40)
    motor.rotate_torso(35)
    until(simulation, lambda: not motor.busy)
    assert not postures(motor, "posture:rotate_torso end:passing"), "no extreme is new"


def test_known_sizes_have_the_noise_of_felt_ones() -> None:
    widths: set[float] = set()
    for seed in range(4):
        simulation, motor = moving(size_noise=0.02, seed=seed)
        (chunk,) = known(motor, simulation, {"torso_yaw": 60})
        widths.add(float(chunk["width"]))
    assert len(widths) > 1


def test_a_posture_that_the_body_cannot_have_is_not_known() -> None:
    _, motor = moving()
    for call, message in (
        (lambda: motor.know("turn", {"torso_yaw": 400}), "'torso_yaw' cannot be at 400"),
        (lambda: motor.know("turn", {"torso_yaw": 10, "tors": 5}), "walker has no joint 'tors'"),
        (lambda: motor.know("turn", {}), "names no joint of"),
        (lambda: motor.know("turn", {"torso_yaw": "far"}), "know: torso_yaw: must be a number"),
        (lambda: motor.know("", {"torso_yaw": 4}), "know: movement: must be the name of a movement"),
    ):
        with pytest.raises(WorldError, match=message):
            call()
    assert not motor.busy


def test_a_posture_is_known_as_it_is_standing_also_while_the_body_walks() -> None:
    body = Mannequin(name="walker", sideways=True, gait=Gait())
    widths: set[float] = set()
    for ticks in (0, 120, 145, 170):
        simulation, motor = moving(body=body)
        if ticks:
            motor.walk(1.3)
            simulation.step(ticks)
        motor.know("stance_yaw", {"stance_yaw": 80, "torso_yaw": 0, "pelvis_yaw": 0})
        simulation.step(2)
        widths.add(float(postures(motor, "posture:stance_yaw end:done")[0]["width"]))
    assert max(widths) - min(widths) <= 0.003


def test_the_size_in_a_posture_is_not_known_while_a_hand_holds_an_object() -> None:
    cup = SimpleObject(name="cup", size=(0.06, 0.06, 0.3), position=(0.0, -0.26, 0.7), mass=0.2)
    simulation = Simulation(Scene(parts=(Mannequin(name="walker"), cup)), {})
    body = simulation.world.bodies["walker"]
    body.set("grasp", "cup")
    with pytest.raises(WorldError, match="not known while it holds an object"):
        body.get("size_in", {"torso_yaw": 0.3})
    assert body.get("size_in").width > 0, "as it is"
    body.set("release")
    assert body.get("size_in", {"torso_yaw": 0.3}).width > 0
    with pytest.raises(WorldError, match="size_in: torso_yaw: must be"):
        body.get("size_in", {"torso_yaw": 1e308})


KNOWING = """
from actr3d.actr import *
from actr3d.motor import Motor
from actr3d.simulation import Simulation
from actr3d.world import Floor, Mannequin, Scene


class Knowing(ACTR):
    goal = Buffer()
    memory = Memory(Buffer())
    motor = Motor(memory=memory)

    def init():
        motor.know("rotate_torso", "torso_yaw:60")
        goal.set("task:wait")

    def begin(goal="task:wait", motor="busy:False"):
        motor.rotate_torso(30)
        goal.clear()


simulation = Simulation(Scene(parts=(Floor(), Mannequin(name="walker"))), {"walker": Knowing})
"""


def test_an_agent_knows_a_posture_from_the_start_also_after_going_back() -> None:
    simulation = load_text(KNOWING).simulation
    simulation.step(30)
    before, state = postures(motor_of(simulation)), simulation.world.state_bytes()
    assert {chunk["end"] for chunk in before} == {"felt", "done"}, "the turn by 30 degrees gives no new extreme on its way"
    simulation.seek(0.01)
    simulation.seek(simulation.time + 0.29)
    assert (postures(motor_of(simulation)), simulation.world.state_bytes()) == (before, state)
