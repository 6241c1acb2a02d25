"""The fast check for a steady state is used where nothing deviates, detects deviations, and changes nothing."""

from __future__ import annotations

import math

import numpy as np
import pytest

from actr3d.world import Body, Car, Floor, Mannequin, Scene, Wall, World
from actr3d.world.posture_hold import SteadyState
from actr3d.world.substepping import Substepping
from tests.helpers.small_agents import near


def course(heading: float) -> tuple[list[bytes], list[bool]]:
    """Returns the states of a walk with commands, up to a wall, and whether each check found the steady state."""
    wall = Wall(name="wall", start=(1.5, -9), end=(1.5, 9))
    world = World(Scene(parts=(Floor(), Mannequin(name="walker", heading=heading), Mannequin(name="other", position=(-1, 1)), wall)))
    body = world.bodies["walker"]
    states: list[bytes] = []
    checks: list[bool] = []
    is_reached = SteadyState.is_reached

    def checked(self: SteadyState) -> bool:
        checks.append(is_reached(self))
        return checks[-1]

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(SteadyState, "is_reached", checked)
        for tick in range(300):
            if tick in (10, 120, 200):
                body.set("walk", 1.0, (0.0, 0.7)[tick == 120], 0.3)
            if tick in (60, 150):
                body.set("posture", {"torso_yaw": 0.3, "left_upper_arm_pitch": -0.5 * (tick == 60)}, 2.0)
            world.step(5)
            states.append(world.state_bytes())
    return states, checks


def never(_: SteadyState) -> bool:
    return False


@pytest.mark.parametrize("heading", [0.0, 0.8])
def test_the_fast_check_is_used_and_changes_nothing(heading: float, monkeypatch: pytest.MonkeyPatch) -> None:
    quick, checks = course(heading)
    assert sum(checks) > 300  # of 600 checks of two bodies, one of which never moves
    monkeypatch.setattr(SteadyState, "is_reached", never)
    thorough, _ = course(heading)
    assert quick == thorough


def standing() -> tuple[World, Body]:
    world = World(Scene(parts=(Floor(), Mannequin(name="walker", heading=0.8))))
    body = world.bodies["walker"]
    body.set("walk", 1.0)
    world.step(50)
    return world, body


@pytest.mark.parametrize("which", ["place", "speed", "control"])
def test_deviations_are_found(which: str) -> None:
    world, body = standing()
    joint, data = body.joints["torso_yaw"], world.mj_data
    control = body.control("torso_yaw").start
    where, at = {"place": (data.qpos, joint.q), "speed": (data.qvel, joint.v), "control": (data.ctrl, control)}[which]
    assert body.hold.before_step(0.01) < math.inf
    where[at] += 0.1
    assert body.hold.before_step(0.01) == math.inf


def test_its_commanded_speed_bounds_all_its_points() -> None:
    world, body = standing()
    fastest = body.hold.before_step(0.01)
    assert 1.0 <= fastest < 1.001
    assert fastest >= Substepping(world.physics, [body], world._pushes)._fastest(0.0)  # pyright: ignore[reportPrivateUsage]
    body.set("walk", 1.0, 2.0)
    world.step(10)
    assert body.hold.before_step(0.01) > 1.0 + 2.0 * 0.2


def test_a_car_with_freely_rolling_wheels_has_no_such_bound() -> None:
    world = World(Scene(parts=(Floor(), Car(name="car"))))
    car = world.bodies["car"]
    world.step(50)
    assert {car.hold.before_step(0.01) for _ in range(3)} == {math.inf}
    assert np.isfinite(world.mj_data.qpos).all()
    assert car.get("pose").x == near(0, abs=1e-6)
