"""The mannequin: its sizes, its joints, its walk, and its collisions with walls."""

from __future__ import annotations

import math
from collections.abc import Callable
from itertools import pairwise
from typing import Any

import mujoco
import numpy as np
import pytest

from actr3d.errors import Actr3dError
from actr3d.world import Body, Floor, Gait, Load, Mannequin, Scene, SimpleObject, Wall, World
from tests.helpers.small_agents import near

SEGMENTS = (
    *("pelvis", "torso", "head", "eye"),
    *("left_shoulder", "right_shoulder", "left_upper_arm", "right_upper_arm"),
)


def world_with_walker(*parts: Any, **of: Any) -> tuple[World, Body]:
    """Returns a world with a floor, a mannequin called `walker` and more, and its body."""
    world = World(Scene(parts=(Floor(), Mannequin(name="walker", **of), *parts)))
    return world, world.bodies["walker"]


def ticks(world: World, count: int) -> None:
    for _ in range(count):
        world.step(5)


def felt(world: World, body: Body, count: int) -> set[tuple[str, str]]:
    """Returns which parts feel what within some ticks."""
    touches = set(body.get("contacts"))
    for _ in range(count):
        world.step(5)
        touches |= set(body.get("contacts"))
    return {(touch.part, touch.other) for touch in touches}


@pytest.mark.parametrize("trunk", ["ellipsoid", "box"])
@pytest.mark.parametrize(("shoulder_width", "depth", "height"), [(0.404, 0.22, 1.62), (0.444, 0.25, 1.75), (0.484, 0.3, 1.9)])
def test_it_has_the_size_it_is_given(trunk: str, shoulder_width: float, depth: float, height: float) -> None:
    _, body = world_with_walker(trunk=trunk, shoulder_width=shoulder_width, depth=depth, height=height, heading=0.7)
    box = body.bounding_box("body")
    assert (box.width, box.depth, box.upper[2]) == near((shoulder_width, depth, height), abs=1e-9)
    assert box.lower[2] == near(0.005, abs=1e-9)


@pytest.mark.parametrize(
    ("height", "shoulder_width", "depth", "eye_height"), [(1.75, 0.27, 0.25, None), (1.75, 1.6, 1.7, None), (0.3, 0.1, 0.1, 0.295)]
)
def test_unusual_sizes_are_kept_too(height: float, shoulder_width: float, depth: float, eye_height: float | None) -> None:
    _, body = world_with_walker(height=height, shoulder_width=shoulder_width, depth=depth, eye_height=eye_height)
    box = body.bounding_box("body")
    assert (box.width, box.depth, box.upper[2]) == near((shoulder_width, depth, height), abs=1e-9)


def test_eye_and_hands_are_where_the_sizes_say() -> None:
    world, body = world_with_walker(height=1.8, eye_height=1.7, arm_length=0.8)
    assert world.mj_data.site("walker_eye").xpos[2] == near(1.7)
    hand, way = world.mj_data.geom("walker_left_hand"), world.mj_model.geom("walker_left_hand").size
    assert hand.xpos[2] - way[0] - way[1] == near(0.818 * 1.8 - 0.8)
    assert body.eye == "walker_eye"


def test_it_weighs_what_it_is_given_with_its_load() -> None:
    world, _ = world_with_walker(mass=60, load=Load(mass=4))
    assert world.mj_model.body("walker").subtreemass == near(64, abs=0.5)


def test_it_turns_hips_and_legs_with_the_trunk_and_keeps_its_direction() -> None:
    world, body = world_with_walker(sideways=True)
    before = body.bounding_box("body").width
    body.set("walk", 1.0)
    body.set("position", "stance_yaw", math.radians(80), 2.5)
    ticks(world, 200)
    world.refresh()
    pose = body.get("pose")
    assert (pose.x, pose.y, pose.heading) == near((2.0, 0.0, 0.0), abs=0.02)
    for pair in ("leg", "shoulder_joint"):
        left, right = (world.mj_data.geom(f"walker_{side}_{pair}").xpos for side in ("left", "right"))
        assert math.atan2(right[0] - left[0], left[1] - right[1]) == near(math.radians(80), abs=0.01)
    hips = 0.191 * 1.75
    assert body.bounding_box("body").width < hips - 0.05 < before, "narrower than hips that face ahead"


def test_it_weighs_the_same_with_legs_that_turn() -> None:
    (ahead, _), (sideways, _) = world_with_walker(), world_with_walker(sideways=True)
    assert sideways.mj_model.body("walker").subtreemass == near(ahead.mj_model.body("walker").subtreemass)


@pytest.mark.parametrize("gait", [None, Gait()])
@pytest.mark.parametrize("position", [(0.0, 1.0), (14.0, -3.0)])
def test_wherever_it_starts_it_has_the_same_inertia(gait: Gait | None, position: tuple[float, float]) -> None:
    def inertia(position: tuple[float, float]) -> Any:
        world, _ = world_with_walker(sideways=True, gait=gait, position=position)
        world.solve()
        unit, product = np.zeros(world.mj_model.nv), np.zeros(world.mj_model.nv)
        unit[world.mj_model.joint("walker_heading").dofadr] = 1
        mujoco.mj_mulM(world.mj_model, world.mj_data, product, unit)
        return product

    assert inertia(position) == near(inertia((0.0, 0.0)), abs=1e-9)


@pytest.mark.parametrize("sideways", [False, True])
def test_every_joint_is_three_hinges_that_stop_at_their_limits(sideways: bool) -> None:
    world, body = world_with_walker(sideways=sideways)
    stance = {"stance_yaw"} if sideways else set[str]()
    assert set(body.joints) == {f"{segment}_{hinge}" for segment in SEGMENTS for hinge in ("yaw", "pitch", "roll")} | stance
    start = world.state()
    for name, joint in body.joints.items():
        for speed, limit, which in ((10, joint.upper, "upper"), (-10, joint.lower, "lower")):
            body.set("joint", name, speed)
            ticks(world, 50)
            assert joint.position == near(limit, abs=2e-3), name
            assert body.get("joints")[name].limit == which
            world.restore(start)


def test_right_limits_mirror_left_ones() -> None:
    _, body = world_with_walker()
    for part in ("shoulder", "upper_arm"):
        for hinge, mirrored in (("yaw", True), ("pitch", False), ("roll", True)):
            left, right = (body.joints[f"{side}_{part}_{hinge}"].limits for side in ("left", "right"))
            assert right == ((-left[1], -left[0]) if mirrored else left)


def test_joints_turn_at_a_constant_speed() -> None:
    world, body = world_with_walker()
    body.set("walk", 1.3)
    body.set("joint", "torso_yaw", 2.0)
    body.set("joint", "left_shoulder_yaw", -0.5)
    for tick in range(1, 21):
        world.step(5)
        assert body.joints["torso_yaw"].velocity == near(2.0, abs=0.01)
        assert body.joints["torso_yaw"].position == near(0.02 * tick, abs=1e-3)
        assert body.joints["left_shoulder_yaw"].position == near(-0.005 * tick, abs=1e-3)


@pytest.mark.parametrize("heading", [0.0, 1.0, -2.5])
def test_it_walks_at_its_speed_and_stops_immediately(heading: float) -> None:
    world, body = world_with_walker(position=(0.5, -0.5), heading=heading)
    body.set("walk", 1.4)
    ticks(world, 100)
    there = body.get("pose")
    assert (there.x, there.y) == near((0.5 + 1.4 * math.cos(heading), -0.5 + 1.4 * math.sin(heading)), abs=1e-9)
    assert there.heading == near(heading)
    body.set("stop")
    ticks(world, 1)
    assert body.get("velocity").linear == near((0, 0, 0), abs=1e-12)
    ticks(world, 100)
    stood = body.get("pose")
    assert (stood.x, stood.y) == near((there.x, there.y), abs=1e-12)


def test_walking_and_turning_is_a_circle() -> None:
    world, body = world_with_walker()
    body.set("walk", 1.2, 0.8)
    path: list[tuple[float, float]] = []
    for _ in range(round(2 * math.pi / 0.8 / 0.01)):
        world.step(5)
        path.append(body.base.pose[:2])
    middle = np.mean(path, axis=0)
    assert np.linalg.norm(np.array(path) - middle, axis=1) == near(np.full(len(path), 1.5), rel=0.01)
    assert path[-1] == near((0, 0), abs=0.02)


def test_it_walks_sideways_and_backwards() -> None:
    world, body = world_with_walker()
    body.set("walk", 1.0, direction=math.pi / 2)
    ticks(world, 50)
    body.set("walk", -2.0)
    ticks(world, 50)
    pose = body.get("pose")
    assert (pose.x, pose.y, pose.heading) == near((-1.0, 0.5, 0.0), abs=1e-6)


BAR = Load(size=(2.5, 0.02), mass=1.5)
WALLS = [0.05, 0.1, 0.3]


def still(_: Body, __: int) -> None:
    """Does not move its arms."""


def swinging(body: Body, tick: int) -> None:
    """Swings arms and trunk to and fro, at the 240 degrees a second of the original ACT-R 3D."""
    way = 4.2 if (tick // 50) % 2 else -4.2
    for name in ("left_upper_arm_pitch", "right_upper_arm_pitch", "torso_yaw", "left_upper_arm_roll"):
        body.set("joint", name, way)


def hesitating(body: Body, tick: int) -> None:
    """Starts and stops at every tick."""
    body.set("walk", 0.0 if tick % 2 else 3.0)


@pytest.mark.daily(4)
@pytest.mark.parametrize("thickness", WALLS)
@pytest.mark.parametrize("heading", [0.0, 1.3])
@pytest.mark.parametrize(
    ("speed", "load", "acts"),
    [(3.0, None, still), (3.0, None, swinging), (3.0, BAR, still), (3.0, BAR, swinging), (-3.0, None, swinging), (3.0, None, hesitating)],
)
def test_nothing_gets_through_a_wall(
    thickness: float, heading: float, speed: float, load: Load | None, acts: Callable[[Body, int], None]
) -> None:
    walls = Wall(name="wall", start=(1.5, -15.0), end=(1.5, 15.0), thickness=thickness, height=6.0)
    faces = heading if speed > 0 else heading + math.pi
    world, body = world_with_walker(walls, load=load, heading=faces, trunk="box")
    body.set("walk", speed)
    near_face = 1.5 - thickness / 2
    reached = 0.0
    for tick in range(400):
        acts(body, tick)
        world.step(5)
        front = body.bounding_box().upper[0]
        assert front < near_face + 0.03, f"at tick {tick}"
        reached = max(reached, front)
    assert reached > near_face - 0.01


@pytest.mark.parametrize("thickness", [0.02, 0.05])
@pytest.mark.parametrize("mass", [2.0, 30.0])
@pytest.mark.parametrize("heading", [0.68, 0.85])
def test_a_long_bar_does_not_get_through_while_it_stops_and_starts(thickness: float, mass: float, heading: float) -> None:
    """The wall turns bar and trunk back as fast as the legs move on; if only it stopped, the legs would push the bar into the wall."""
    wall = Wall(name="wall", start=(3.0, -20.0), end=(3.0, 20.0), thickness=thickness)
    world, body = world_with_walker(wall, load=Load(size=(5.0, 0.03), mass=mass), heading=heading)
    for tick in range(180):
        body.set("stop")
        body.set("walk", 3.0)
        world.step(5)
        assert body.bounding_box().upper[0] < 3.02, f"at tick {tick}"


def test_an_obstacle_stops_it_and_it_pushes_with_limited_force() -> None:
    world, body = world_with_walker(Wall(name="wall", start=(1.0, -2.0), end=(1.0, 2.0)), leg_force=250)
    body.set("walk", 2.0)
    ticks(world, 200)
    assert body.get("velocity").linear == near((0, 0, 0), abs=1e-3)
    touches = body.get("contacts")
    assert {touch.other for touch in touches} == {"wall"}
    assert sum(touch.force for touch in touches) == near(250, rel=0.01)


def test_an_obstacle_stops_a_joint() -> None:
    world, body = world_with_walker(Wall(name="wall", start=(-2.0, 0.5), end=(2.0, 0.5)))
    body.set("joint", "left_upper_arm_roll", 2.0)
    ticks(world, 150)
    joint = body.joints["left_upper_arm_roll"]
    there = joint.position
    assert 0.1 < there < 0.6
    assert felt(world, body, 100) == {("left_hand", "wall")}
    assert joint.position == near(there, abs=0.1)
    assert body.bounding_box().upper[1] < 0.46


def test_a_light_object_is_pushed_away_and_felt() -> None:
    world, body = world_with_walker(SimpleObject(name="ball", shape="sphere", size=(0.4,), mass=2, position=(0.6, 0, 0.4)))
    body.set("walk", 1.0)
    assert body.get("contacts") == ()
    forces: list[float] = []
    for _ in range(100):
        world.step(5)
        forces += [touch.force for touch in body.get("contacts") if touch.other == "ball"]
    assert max(forces) > 100
    world.refresh()
    assert world.mj_data.body("ball").xpos[0] > 1.2


def test_two_people_feel_each_other() -> None:
    world, body = world_with_walker(Mannequin(name="other", position=(1.0, 0.0), heading=math.pi))
    body.set("walk", 1.0)
    ticks(world, 100)
    mine, theirs = body.get("contacts"), world.bodies["other"].get("contacts")
    assert {touch.other for touch in mine} == {"other"}
    assert {touch.other for touch in theirs} == {"walker"}
    assert sum(touch.force for touch in mine) == near(sum(touch.force for touch in theirs))


@pytest.mark.parametrize("seed", range(5))
def test_its_own_parts_and_the_floor_are_no_obstacles(seed: int) -> None:
    world, body = world_with_walker(load=Load(shape="box", size=(0.3, 0.4, 0.3)) if seed % 2 else None)
    random = np.random.default_rng(seed)
    for name, joint in body.joints.items():
        if not name.startswith("pelvis"):
            body.set("position", name, random.uniform(joint.lower, joint.upper) * 0.3, 16.0)
    body.set("walk", 1.0)
    ticks(world, 100)
    world.refresh()
    assert body.get("contacts") == ()
    assert world.mj_data.ncon == 0


@pytest.mark.parametrize("seed", range(8))
def test_after_a_shove_it_comes_to_rest_without_rattling(seed: int) -> None:
    world, _ = world_with_walker()
    world.mj_data.qvel[:] = np.random.default_rng(seed).normal(0, 3, world.mj_model.nv)
    world.mj_data.qvel[:2] = 0
    world.changed()
    ticks(world, 100)
    assert np.abs(world.mj_data.qvel).max() < 0.02


@pytest.mark.parametrize("size", [(2.0, 0.03), (0.8, 0.03), (0.2, 0.03)])
def test_a_bar_is_held_by_both_hands(size: tuple[float, float]) -> None:
    world, body = world_with_walker(load=Load(size=size))
    assert body.bounding_box("body").width == near(max(size[0], 0.444), abs=1e-4)
    for turn in (0.0, 0.3):
        body.set("posture", {"torso_yaw": turn, "left_shoulder_yaw": turn, "right_shoulder_yaw": turn})
        ticks(world, 100)
        world.refresh()
        bar = world.mj_data.geom("walker_load")
        along = bar.xmat.reshape(3, 3)[:, 2]
        for side in ("left", "right"):
            apart = world.mj_data.geom(f"walker_{side}_hand").xpos - bar.xpos
            assert np.linalg.norm(apart - along * (apart @ along)) < 0.02, side
            assert abs(apart @ along) < size[0] / 2 + 0.02, side
        assert math.atan2(along[1], along[0]) % math.pi == near((math.pi / 2 + 2 * turn) % math.pi, abs=0.02)


def test_the_load_is_felt_and_keeps_it_out_of_a_gap() -> None:
    gap = (Wall(name="left", start=(1.5, 0.4), end=(1.5, 3)), Wall(name="right", start=(1.5, -3), end=(1.5, -0.4)))
    world, body = world_with_walker(*gap, load=BAR)
    body.set("walk", 1.0)
    assert felt(world, body, 200) == {("load", "left"), ("load", "right")}
    assert body.get("pose").x < 1.4


@pytest.mark.parametrize("load", [BAR, Load(shape="box", size=(0.3, 1.2, 0.3), mass=5)])
@pytest.mark.parametrize("speed", [1.0, 3.0])
def test_it_does_not_walk_through_its_own_load(load: Load, speed: float) -> None:
    """Arms give way where the load is stopped; then it lies against the trunk, and the legs push with all they have."""
    gap = (Wall(name="left", start=(1.5, 0.4), end=(1.5, 3)), Wall(name="right", start=(1.5, -3), end=(1.5, -0.4)))
    world, body = world_with_walker(*gap, load=load)
    body.set("walk", speed)
    ticks(world, 400)
    world.refresh()
    assert world.mj_data.body("walker_load").xpos[0] - body.get("pose").x > 0.12
    assert np.abs(world.mj_data.qvel).max() < 0.05
    assert sum(touch.force for touch in body.get("contacts")) == near(300, rel=0.02)


def test_a_box_in_front_makes_it_deeper() -> None:
    _, plain = world_with_walker()
    _, laden = world_with_walker(load=Load(shape="box", size=(0.4, 0.5, 0.3), mass=5))
    box = laden.bounding_box("body")
    assert box.width == near(0.5, abs=1e-3)
    assert box.upper[0] > plain.bounding_box("body").upper[0] + 0.4


def test_only_a_box_gets_wider_when_it_begins_to_turn() -> None:
    widths: dict[str, float] = {}
    for trunk in ("box", "ellipsoid"):
        world, body = world_with_walker(trunk=trunk)
        body.set("position", "torso_yaw", 0.3)
        ticks(world, 20)
        widths[trunk] = body.bounding_box("body").width
    assert widths["ellipsoid"] <= 0.444 < widths["box"]
    assert widths["box"] == near(0.444 * math.cos(0.3) + 0.25 * math.sin(0.3), abs=1e-3)


def test_continuing_from_a_state_gives_the_same_bytes_with_commands_in_progress() -> None:
    world, body = world_with_walker(load=BAR)
    body.set("waypoint", 2.0, 1.0)
    body.set("position", "torso_yaw", 0.8, 0.5)
    ticks(world, 30)
    middle = world.state()
    ticks(world, 200)
    first = world.state()
    body.set("walk", 3.0)
    ticks(world, 10)
    world.restore(middle)
    ticks(world, 200)
    assert world.state().mj_state.tobytes() == first.mj_state.tobytes()
    assert world.state().bodies == first.bodies


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"eye_height": 1.0}, r"Mannequin\.eye_height: must be in the head, here >= 1\.52 and <= 1\.73 m \(got 1\.0\)"),
        ({"shoulder_width": 0.2}, r"Mannequin\.shoulder_width: must be >= 0\.15 of the height"),
        ({"arm_length": 1.5}, r"Mannequin\.arm_length: hands would touch the floor"),
        ({"shoulder_width": 1.8}, r"Mannequin\.shoulder_width: must be <= the height \(got 1\.8\)"),
        ({"depth": 2}, r"Mannequin\.depth: must be <= the height \(got 2\.0\)"),
        ({"load": Load(shape="box", size=(0.3, 0.4, 2.3))}, r"Mannequin\.load: would touch the floor; it can be 2\.21 m high \(got 2\.3\)"),
        ({"trunk": "bx"}, r"must be one of 'ellipsoid', 'box' \(got 'bx'\); did you mean 'box'"),
        ({"mass": -1}, r"Mannequin\.mass: must be > 0"),
        ({"noise": (("poze", 1.0),)}, r"walker has no sensor 'poze'; did you mean 'pose'"),
        ({"noise": (("pose", -1.0),)}, r"walker: noise of pose: must be >= 0 \(got -1\.0\)"),
    ],
)
def test_wrong_mannequins_are_refused_with_a_reason(wrong: dict[str, Any], message: str) -> None:
    with pytest.raises(Actr3dError, match=message):
        world_with_walker(**wrong)


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"size": (1.0, 0.2, 0.1)}, "Load.size: a bar takes length and thickness"),
        ({"size": (0.1, 0.2)}, "the length of a bar must be >= its thickness"),
        ({"shape": "box"}, "a box takes depth, width and height"),
        ({"mass": 0}, "Load.mass: must be > 0"),
    ],
)
def test_wrong_loads_are_refused_with_a_reason(wrong: dict[str, Any], message: str) -> None:
    with pytest.raises(Actr3dError, match=message):
        Load(**wrong)


def test_shirt_trousers_shoes_and_skin_have_colours_of_their_own() -> None:
    model = World(Scene(parts=(Mannequin(name="walker", gait=Gait(), colour=(0.8, 0.4, 0.2, 0.5)),))).mj_model
    shirt, trousers, shoe, head, hand = (
        model.geom(f"walker_{name}").rgba.tolist() for name in ("torso", "left_shank", "left_foot", "head", "right_hand")
    )
    assert shirt == pytest.approx([0.8, 0.4, 0.2, 0.5])
    assert all(dark < bright for dark, bright in pairwise([sum(shoe), sum(trousers), sum(shirt)]))
    assert head == hand != shirt
