"""Gait: measures of human gait, in the world's frame; its variability, its end, and obstacles."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from numpy.typing import NDArray

from actr3d.world import Floor, Gait, Mannequin, Scene, Wall, World
from actr3d.world.bodies.mannequin import CLEARANCE

REGULAR = Gait(wander=0, timing=0)
"""A gait without variability."""
FEET = [f"p_{side}_foot" for side in ("left", "right")]


def walker(gait: Gait | None = REGULAR, *parts: Any, seed: int = 1, **fields: Any) -> World:
    return World(Scene(parts=(Floor(), *parts, Mannequin(name="p", gait=gait, **fields))), seed=seed)


def walk(world: World, ticks: int, read: Callable[[], Any] = lambda: None) -> NDArray[np.float64]:
    """Advances by ticks of 10 ms, and returns a reading after each."""
    readings: list[Any] = []
    for _ in range(ticks):
        world.step(5)
        world.refresh()
        readings.append(read())
    return np.array(readings, dtype=float)


def lateral(world: World) -> Callable[[], float]:
    """Returns a reading of the torso's place to the left of the base [m]."""
    return lambda: float(world.mj_data.body("p_torso").xpos[1]) - world.bodies["p"].base.pose[1]


@pytest.mark.parametrize(("speed", "excursion"), [(0.7, 0.07), (1.15, 0.055), (1.6, 0.04)])
def test_the_body_sways_less_when_it_walks_faster(speed: float, excursion: float) -> None:
    world = walker()
    world.bodies["p"].set("walk", speed)
    swaying = walk(world, 600, lateral(world))[200:]
    assert np.ptp(swaying) == pytest.approx(excursion, rel=0.01)
    assert swaying.mean() == pytest.approx(0, abs=0.05 * excursion)


@pytest.mark.parametrize("speed", [0.8, 1.29, 1.77])
def test_step_length_and_frequency_have_the_walk_ratio(speed: float) -> None:
    world = walker()
    world.bodies["p"].set("walk", speed)
    left = walk(world, 1000, lateral(world)) > 0
    changes = np.flatnonzero(left[1:] != left[:-1])
    per_minute = 6000 * (len(changes) - 1) / (changes[-1] - changes[0])
    assert speed * 60 / per_minute / per_minute == pytest.approx(0.0065, rel=0.02)


def test_one_foot_is_on_the_ground_and_hardly_slips() -> None:
    world = walker()
    body = world.bodies["p"]
    body.set("walk", 1.3)
    soles = [world.mj_model.geom(foot) for foot in FEET]

    def ends() -> list[list[float]]:
        """Returns height and place along the way of each foot's lower end."""
        found: list[list[float]] = []
        for sole in soles:
            data = world.mj_data.geom(sole.id)
            axis = data.xmat.reshape(3, 3)[:, 2] * sole.size[1]
            low = min((data.xpos + axis, data.xpos - axis), key=lambda end: end[2])
            found.append([low[2] - sole.size[0] - CLEARANCE, low[0]])
        return found

    feet = walk(world, 600, ends)[200:]
    lowest = feet[:, :, 0].min(axis=1)
    assert np.abs(lowest).max() < 0.002
    standing = feet[:, 0, 0] < feet[:, 1, 0] - 0.01
    both = standing[1:] & standing[:-1]
    slip = np.diff(feet[:, 0, 1])[both]
    assert np.abs(slip.mean()) < 0.25 * 0.013, "while it stands, a foot moves by less than a quarter of the body's way"


def test_thorax_and_pelvis_turn_by_a_few_degrees_and_the_eyes_keep_the_direction() -> None:
    world = walker()
    body = world.bodies["p"]
    body.set("walk", 1.3)
    angles = walk(world, 600, lambda: [body.get("pose", part).heading for part in ("pelvis", "torso", "head")])[200:]
    pelvis, thorax, head = np.degrees(np.abs(angles).max(axis=0))
    assert pelvis == pytest.approx(4, abs=0.1)
    assert thorax == pytest.approx(4, abs=0.1)
    assert head < 0.1


def test_steps_vary_as_much_as_they_should() -> None:
    world = walker(Gait(sway=0, wander=0.02, timing=0))
    world.bodies["p"].set("walk", 1.3)
    places = walk(world, 6000, lateral(world))[::54]  # about one a step
    assert places.std() == pytest.approx(0.02, rel=0.25)
    assert abs(np.corrcoef(places[:-1], places[1:])[0, 1]) < 0.5


def test_a_seed_gives_the_same_steps_and_another_one_others() -> None:
    runs: list[bytes] = []
    for seed in (1, 1, 2):
        world = walker(Gait(), seed=seed)
        world.bodies["p"].set("walk", 1.3)
        walk(world, 200)
        runs.append(world.state_bytes())
    assert runs[0] == runs[1]
    assert runs[0] != runs[2]


def test_a_state_in_the_middle_of_a_step_continues_exactly() -> None:
    world = walker(Gait(), sideways=True)
    body = world.bodies["p"]
    body.set("walk", 1.3)
    walk(world, 137)
    state = world.state()
    body.set("position", "stance_yaw", 0.5, 1.0)
    walk(world, 100)
    body.set("stop")
    walk(world, 60)
    first = world.state_bytes()
    world.restore(state)
    body.set("position", "stance_yaw", 0.5, 1.0)
    walk(world, 100)
    body.set("stop")
    walk(world, 60)
    assert world.state_bytes() == first


def test_after_a_walk_it_stands_as_before_and_starts_again_in_any_phase_of_the_stride() -> None:
    world = walker()
    body = world.bodies["p"]
    swayed: list[float] = []
    for _ in range(8):
        body.set("walk", 1.3)
        walk(world, 130)
        swayed.append(walk(world, 1, lateral(world))[-1])
        body.set("stop")
        walk(world, 100)
        assert max(abs(joint.position) for joint in body.joints.values()) < 1e-3
        assert abs(lateral(world)()) < 1e-4
        assert np.abs(world.mj_data.qvel).max() < 0.01
    half = Gait().excursion(1.3) / 2
    assert max(abs(at) for at in swayed) <= half + 1e-3
    assert min(swayed) < -half / 2, "in the same time, it has come over the right foot"
    assert max(swayed) > half / 2, "over the left one"
    assert min(abs(at) for at in swayed) < half / 2, "or between both"


def test_it_walks_as_far_as_without_gait() -> None:
    world = walker(Gait())
    body = world.bodies["p"]
    body.set("walk", 1.3)
    walk(world, 1000)
    x, y, heading = body.base.pose
    assert x == pytest.approx(13, abs=0.005)
    assert y == pytest.approx(0, abs=0.005)
    assert heading == pytest.approx(0, abs=0.002)


def test_a_command_moves_a_joint_of_the_gait_which_continues_around_the_new_position() -> None:
    world = walker()
    body = world.bodies["p"]
    torso = body.joints["torso_yaw"]
    body.set("walk", 1.3)
    walk(world, 150)
    body.set("position", "torso_yaw", 0.8, 2.0)
    way = walk(world, 60, lambda: torso.position)
    assert np.abs(way - 0.8).min() < 1e-3
    about = walk(world, 300, lambda: torso.position)[100:]
    assert about.mean() == pytest.approx(0.8, abs=math.radians(1.5))
    assert np.ptp(about) > math.radians(4)
    body.set("stop")
    walk(world, 100)
    assert torso.position == pytest.approx(0.8, abs=1e-3)


def test_a_body_turned_sideways_steps_along_its_path() -> None:
    world = walker(sideways=True)
    body = world.bodies["p"]
    body.set("position", "stance_yaw", math.pi / 3, 4.0)
    body.set("walk", 1.3)
    walk(world, 200)
    feet = walk(world, 200, lambda: (world.mj_data.body(FEET[0]).xpos - world.mj_data.body("p").xpos)[:2])
    along, across = np.ptp(feet, axis=0)
    assert along > 0.5
    assert across < 0.3 * along


@pytest.mark.parametrize("speed", [0.5, 1.3, 3.0])
def test_a_wall_stops_it_without_hurting_the_physics(speed: float) -> None:
    wall = Wall(name="wall", start=(1.0, -2.0), end=(1.0, 2.0))
    world = walker(Gait(), wall)
    body = world.bodies["p"]
    body.set("walk", speed)
    fastest = walk(world, 500, lambda: np.abs(world.mj_data.qvel).max())
    assert body.base.pose[0] < 0.9
    assert fastest.max() < 40
    deepest = min((contact.dist for contact in world.mj_data.contact), default=0.0)
    assert deepest > -0.02


def test_without_gait_nothing_steps() -> None:
    world = walker(None)
    assert not any("thigh" in world.mj_model.joint(n).name for n in range(world.mj_model.njnt))
    assert "left_thigh_pitch" not in walker().bodies["p"].joints


@pytest.mark.parametrize(
    ("field", "value", "message"),
    [("walk_ratio", 0, "Gait.walk_ratio: must be > 0"), ("sway", -1, "Gait.sway: must be >= 0"), ("wander", "x", "Gait.wander: must be")],
)
def test_wrong_values_are_named(field: str, value: Any, message: str) -> None:
    with pytest.raises(Exception, match=message):
        replace(REGULAR, **{field: value})
