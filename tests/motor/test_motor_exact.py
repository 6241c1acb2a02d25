"""The motor module is exact: with seek, observers and recordings, and under any commands."""

from __future__ import annotations

import math
import random
from pathlib import Path
from typing import Any

import pytest

from actr3d.actr.loading import load_text
from actr3d.recording import Recorded
from actr3d.simulation import Simulation
from actr3d.world import Aperture, Floor, Mannequin, Scene
from tests.helpers.commands import run_command
from tests.helpers.motor_bodies import during, moving, until
from tests.helpers.small_agents import near
from tests.helpers.walkers import digest

RESTLESS = """
from actr3d.actr import *
from actr3d.motor import Motor

class Restless(ACTR):
    goal = Buffer()
    retrieval = Buffer()
    posture = Buffer()
    memory = Memory(retrieval)
    base = DMBaseLevel(memory)
    noise = DMNoise(memory, noise=0.2)
    motor = Motor(posture, memory=memory, angle_noise=2, size_noise=0.02, angle_grid=5, size_grid=0.05, initiation=0.02)

    def init():
        goal.set("go")
        motor.walk(0.4)

    def left(goal="go", motor="torso_busy:False"):
        motor.rotate_torso(self.random.randint(-90, 90), self.random.choice([60, 120, 240]))

    def shoulder(goal="go", motor="left_shoulder_busy:False right_shoulder_busy:False"):
        motor.extend_shoulder(self.random.choice(["left", "right"]))

    def steer(goal="go", motor="turning:False"):
        motor.turn(self.random.randint(-20, 20), 90)

    def hurry(goal="go", motor="torso_busy:True"):
        motor.walk(0.2 + 0.4 * self.random.random())

    def recall(goal="go", memory="busy:False", motor="busy:True"):
        memory.request("torso_yaw:?yaw end:done")

    def halt(goal="go", motor="left_shoulder_busy:True"):
        motor.stop(*self.random.choice([("torso",), ("left_shoulder", "legs"), ()]))
"""
Restless: Any = load_text(RESTLESS, "restless.py").Restless


def restless(trace: str = "all") -> Simulation:
    """Returns two walkers who move at random, one behind the other."""
    bodies = (Mannequin(name="walker"), Mannequin(name="other", position=(-1.0, 0.0)))
    scene = Scene(parts=(Floor(), Aperture(position=(1.0, 0.0), width=0.6), *bodies))
    return Simulation(scene, {"walker": Restless, "other": Restless}, seed=3, trace=trace)


@pytest.mark.slow
def test_any_past_time_is_restored_exactly() -> None:
    simulation = restless()
    digests = [digest(simulation)]
    for _ in range(150):
        simulation.step()
        digests.append(digest(simulation))
    for tick in (100, 150, 0, 37, 149):
        simulation.seek(tick / 100)
        assert digest(simulation) == digests[tick]
        for later in range(tick + 1, min(tick + 20, 150) + 1):
            simulation.step()
            assert digest(simulation) == digests[later]


@pytest.mark.slow
def test_observers_and_tracing_change_nothing() -> None:
    def end(trace: str, observed: bool) -> Any:
        simulation = restless(trace)
        if observed:
            simulation.observe(lambda glimpse: glimpse.mj_data.qpos.sum())
        simulation.run(1.5)
        return simulation.world.state().mj_state.tobytes()

    assert end("none", False) == end("all", True) == end("production", False)


def test_a_recording_holds_what_it_felt(tmp_path: Path) -> None:
    simulation = restless("none")
    with simulation.record(tmp_path / "run.actr3d"):
        simulation.run(0.5)
    with Recorded(tmp_path / "run.actr3d") as recorded:
        kinds = {event.kind for event in recorded.events()}
    assert {"move", "moved", "answer", "add"} <= kinds


@pytest.mark.slow
def test_a_recorded_run_of_a_model_file_is_replayed_byte_for_byte(tmp_path: Path) -> None:
    file, recording = tmp_path / "restless.py", tmp_path / "run.actr3d"
    building = """
from actr3d.configuration import Configuration
from actr3d.simulation import Simulation
from actr3d.world import Floor, Mannequin, Scene
from dataclasses import dataclass

@dataclass(frozen=True, kw_only=True)
class Parameters(Configuration):
    height: float = 1.7

def build(parameters: Parameters) -> Simulation:
    return Simulation(Scene(parts=(Floor(), Mannequin(name="walker", height=parameters.height))), {"walker": Restless})
"""
    file.write_text(RESTLESS + building, encoding="utf-8")
    for command in (["run", str(file), "--seed", "2", "--until", "0.5", "--record", str(recording)], ["replay", str(recording)]):
        done = run_command(*command)
        assert done.returncode == 0, done.stdout + done.stderr
    assert "agrees" in done.stdout or "every byte" in done.stdout, done.stdout


COMMANDS = ("rotate", "free", "stop", "stop all", "walk", "turn", "arms")


def command(motor: Any, choose: random.Random) -> None:
    """Gives a random command, valid or not."""
    joints = [name for name, joint in motor._limbs.joints.items() if joint.driven]
    joint = choose.choice(joints)
    speed = choose.choice([20, 90, 240])
    match choose.choice(COMMANDS):
        case "rotate":
            motor.rotate(joint, angle=choose.uniform(-100, 100), speed=speed)
        case "free":
            motor.rotate(joint, speed=speed * choose.choice([-1, 1]))
        case "stop":
            motor.stop(choose.choice(motor._limbs.groups))
        case "stop all":
            if choose.random() < 0.2:
                motor.stop()
        case "walk":
            motor.walk(choose.uniform(-1, 1.5))
        case "turn":
            motor.turn(choose.uniform(-90, 90), speed)
        case _:
            motor.lower_arms(speed)


@pytest.mark.parametrize("seed", range(6))
def test_limits_hold_and_knowledge_of_the_body_is_true_under_any_commands(seed: int) -> None:
    choose = random.Random(seed)
    simulation, motor = moving(seed=seed)
    body = simulation.world.bodies["walker"]
    seen = {name: [0.0, 0.0] for name in body.joints}
    for _ in range(400):
        if choose.random() < 0.3:
            during(simulation, lambda: command(motor, choose))
        else:
            simulation.step()
        busy = {name for name in motor._limbs.groups if motor[f"{name}_busy"]}
        assert motor.busy == bool(busy)
        for name, joint in body.joints.items():
            assert joint.lower - 2e-3 <= joint.position <= joint.upper + 2e-3
            seen[name] = [min(seen[name][0], joint.position), max(seen[name][1], joint.position)]
            if abs(body.hold.joint_speed(joint)) > 0.01:
                assert name.rpartition("_")[0] in busy, "a moving group is busy"
    motor.stop()
    simulation.step(2)
    for name in body.joints:
        known = motor.joint(name)
        assert (known.minimum, known.maximum) == near(tuple(seen[name]), abs=1e-4)
        assert known.angle == near(body.joints[name].position, abs=1e-4)


@pytest.mark.parametrize("seed", range(8))
def test_a_movement_takes_as_long_as_its_angle_at_its_speed(seed: int) -> None:
    choose = random.Random(seed)
    simulation, motor = moving()
    body = simulation.world.bodies["walker"]
    for _ in range(6):
        name = choose.choice([name for name in body.joints if "yaw" in name])
        joint = body.joints[name]
        to, speed = choose.uniform(math.degrees(joint.lower), math.degrees(joint.upper)), choose.uniform(20, 240)
        way = abs(to - math.degrees(joint.position))
        motor.rotate(name, angle=to, speed=speed)
        took = until(simulation, lambda: not motor.busy) - 1
        assert took == near(way / speed * 100, abs=1.05)
        assert math.degrees(joint.position) == near(to, abs=0.02)


@pytest.mark.parametrize("seed", range(3))
def test_left_and_right_are_mirrored(seed: int) -> None:
    def widths(mirror: int) -> list[tuple[float, ...]]:
        choose = random.Random(seed)
        simulation, motor = moving(angle_grid=0.1, size_grid=0.001)
        found: list[tuple[float, ...]] = []
        for _ in range(5):
            to, speed = choose.uniform(0, 90), choose.uniform(50, 200)
            sides = ("left", "right")[::mirror]
            motor.rotate_torso(mirror * to, speed)
            motor.extend_shoulder(sides[0], choose.uniform(0, 20), speed)
            motor.compress_shoulder(sides[1], choose.uniform(0, 20), speed)
            until(simulation, lambda: not motor.busy)
            found.append((motor.width, motor.depth, mirror * motor.torso_yaw_angle, motor[f"{sides[0]}_shoulder_yaw_angle"] * mirror))
        return found

    assert [near(of, abs=2e-3) for of in widths(1)] == widths(-1)


def test_a_body_moved_by_a_user_is_felt_at_its_next_movement() -> None:
    simulation, motor = moving()
    simulation.command("posture", {"head_yaw": 0.5}, speed=10.0)
    simulation.step(20)
    assert motor.head_yaw_angle == 0
    motor.rotate_torso(2)
    simulation.step(5)
    assert motor.head_yaw_angle == round(math.degrees(0.5))
