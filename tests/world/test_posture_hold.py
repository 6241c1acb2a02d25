"""A standing body keeps its place: its own limbs do not move it, and a load does not make it creep."""

from __future__ import annotations

import math
import random
from contextlib import suppress

import numpy as np
import pytest

from actr3d.errors import WorldError
from actr3d.world import Body, Floor, Load, Mannequin, Scene, SimpleObject, Wall, World
from tests.helpers.small_agents import near


def world_with_walker(*parts: object, **of: object) -> tuple[World, Body]:
    """Returns a world with a mannequin called `walker` and more, and its body."""
    world = World(Scene(parts=(Floor(), Mannequin(name="walker", **of), *parts)))  # type: ignore[arg-type]
    return world, world.bodies["walker"]


def flailing(body: Body, tick: int, names: list[str], speed: float) -> None:
    for number, name in enumerate(names):
        if (tick + number) % 7 == 0:
            body.set("joint", name, speed if (tick // 7) % 2 else -speed)


@pytest.mark.parametrize("speed", [4.2, 16.0])
@pytest.mark.parametrize("load", [None, Load(size=(2.0, 0.03), mass=5), Load(shape="box", size=(0.3, 0.3, 0.1), mass=2)])
def test_a_standing_body_is_not_moved_by_its_own_limbs(load: Load | None, speed: float) -> None:
    world, body = world_with_walker(load=load, position=(1.0, 2.0), heading=0.5)
    names = ["pelvis_pitch", "torso_yaw", "torso_roll", "left_upper_arm_pitch", "right_upper_arm_roll", "head_pitch"]
    for tick in range(300):
        flailing(body, tick, names, speed)
        world.step(5)
        pose = body.get("pose")
        assert (pose.x, pose.y, pose.heading) == near((1.0, 2.0, 0.5), abs=0.03), f"at tick {tick}"
    body.set("stop")
    for _ in range(50):
        world.step(5)
    pose = body.get("pose")
    assert (pose.x, pose.y, pose.heading) == near((1.0, 2.0, 0.5), abs=1e-3)


@pytest.mark.parametrize("sideways", [False, True])
def test_extreme_postures_neither_move_it_nor_turn_it_from_its_path(sideways: bool) -> None:
    world, body = world_with_walker(sideways=sideways)
    body.set("walk", 1.0)
    low = {name: joint.lower for name, joint in body.joints.items()}
    for _ in range(3):
        body.set("posture", low, 8.0)
        world.step(500)
        body.set("posture", dict.fromkeys(low, 0.0), 8.0)
        world.step(500)
    pose = body.get("pose")
    assert pose.heading == near(0.0, abs=0.05)
    assert pose.x == near(6.0, abs=0.15 if sideways else 0.05)  # a body that stands sideways moves along its lateral axis
    assert pose.y == near(0.0, abs=0.15)  # a walking body keeps speed and heading, and is not led back to a line


def test_a_joint_without_a_command_bears_a_load() -> None:
    """Six kilograms lie on the box in its hands, which need less than the limit of the servos, 60 N m."""
    lies = SimpleObject(name="weight", shape="box", size=(0.2, 0.2, 0.1), mass=6, position=(0.36, 0.0, 1.2))
    world, body = world_with_walker(lies, load=Load(shape="box", size=(0.4, 0.5, 0.1), mass=2))
    world.step(1000)
    start = {name: joint.position for name, joint in body.joints.items()}
    assert {touch.other for touch in body.get("contacts")} == {"weight"}
    world.step(5000)
    for name, joint in body.joints.items():
        assert joint.position == near(start[name], abs=1e-4), name
        assert joint.position == near(0, abs=1e-3), name


def test_a_push_moves_a_standing_body_and_it_stays_there() -> None:
    other = Mannequin(name="other", position=(0.7, 0.0), leg_force=200)
    world, body = world_with_walker(other, leg_force=400)
    body.set("walk", 0.5)
    world.step(1000)
    pushed = world.bodies["other"].get("pose").x
    assert pushed > 0.9
    body.set("walk", -1.0)
    world.step(1000)
    there = world.bodies["other"].get("pose").x
    world.step(1000)
    assert world.bodies["other"].get("pose").x == near(there, abs=1e-4)
    assert there > pushed - 0.02


def test_a_stronger_body_is_not_pushed_away() -> None:
    world, body = world_with_walker(Mannequin(name="other", position=(0.7, 0.0), heading=math.pi), leg_force=150)
    body.set("walk", 0.5)
    world.step(3000)
    assert world.bodies["other"].get("pose").x == near(0.7, abs=0.02)


def test_people_who_press_on_each_other_feel_no_blows() -> None:
    """With MuJoCo's own tolerance, two trunks that hardly touch are at times found 1 cm deep in each other: 40 kN."""
    world, body = world_with_walker(Mannequin(name="other", position=(1.0, 0.0), heading=math.pi))
    body.set("walk", 1.0)
    body.get("contacts")
    world.step(450)
    for _ in range(150):
        world.step(5)
        assert all(touch.force < 1500 for touch in body.get("contacts"))


def test_a_limb_that_was_pushed_away_comes_back() -> None:
    world, body = world_with_walker(Wall(name="wall", start=(0.0, 0.45), end=(3.0, 0.45)), position=(-0.6, 0.2))
    body.set("walk", 0.5)
    bent = 0.0
    for _ in range(200):
        world.step(5)
        bent = max(bent, max(abs(joint.position) for name, joint in body.joints.items() if name.startswith("left")))
    body.set("walk", -0.5)
    world.step(2000)
    assert bent > 0.05
    assert max(abs(joint.position) for joint in body.joints.values()) < 1e-3


@pytest.mark.parametrize("seed", [10, 12, 15])
def test_how_it_stops_does_not_depend_on_observers(seed: int) -> None:
    def stopped(*, observed: bool) -> list[float]:
        draw = random.Random(seed)
        world = World(Scene(parts=(Floor(), Mannequin(name="m"))))
        body = world.bodies["m"]
        for joint in draw.sample(list(body.joints), 8):
            with suppress(WorldError):  # some joints are too slow for it
                body.set("joint", joint, draw.uniform(-6, 6))
        world.step(draw.randrange(20, 90))
        if observed:
            body.get("pose")
        for joint in draw.sample(list(body.joints), 4):
            body.set("joint", joint, 0.0)
        world.step(10)
        return world.mj_data.qpos.tolist()

    assert stopped(observed=True) == stopped(observed=False)


def test_after_a_limit_it_is_at_rest() -> None:
    world, body = world_with_walker()
    body.set("joint", "pelvis_pitch", 16.0)
    world.step(250)
    assert body.joints["pelvis_pitch"].position == near(body.joints["pelvis_pitch"].upper, abs=1e-3)
    assert np.abs(world.mj_data.qvel).max() < 0.02


@pytest.mark.parametrize(
    ("word", "values", "message"),
    [
        ("walk", (13,), r"walk: speed: must be <= 12\.5 \(got 13\)"),
        ("walk", (1, -13), r"walk: turn: must be >= -12\.5"),
        ("heading", (1, 13), r"heading: speed: must be <= 12\.5"),
        ("waypoint", (1, 2, 13), r"waypoint: speed: must be <= 12\.5"),
        ("joint", ("torso_yaw", 17), r"joint: speed: must be <= 16 \(got 17\)"),
        ("posture", ({"torso_yaw": 1}, 17), r"posture: torso_yaw: speed: must be <= 16 \(got 17\)"),
        ("walk", (True,), r"walk: speed: must be a number \(got True\)"),
    ],
)
def test_commands_beyond_human_limits_are_refused(word: str, values: tuple[object, ...], message: str) -> None:
    _, body = world_with_walker()
    with pytest.raises(WorldError, match=message):
        body.set(word, *values)


def test_numbers_may_come_as_text() -> None:
    world, body = world_with_walker()
    body.set("walk", "1.2")
    world.step(500)
    assert body.get("pose").x == near(1.2)
