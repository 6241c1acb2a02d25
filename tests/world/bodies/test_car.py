"""The car: the circle it drives, how it speeds up and brakes, and what stops it."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from actr3d.errors import Actr3dError
from actr3d.world import Body, Car, Floor, Scene, Wall, World
from tests.helpers.small_agents import near


def driving(*parts: Any, **of: Any) -> tuple[World, Body]:
    """Returns a world with a floor, a car and more, and the car's body."""
    world = World(Scene(parts=(Floor(), Car(**of), *parts)))
    return world, world.bodies["car"]


def ticks(world: World, count: int) -> None:
    for _ in range(count):
        world.step(5)


@pytest.mark.parametrize(("wheel", "speed"), [(1.0, 5.0), (-2.0, 5.0), (6.0, 3.0)])
def test_it_drives_the_circle_of_a_bicycle(wheel: float, speed: float) -> None:
    world, car = driving(heading=0.5, position=(3.0, -1.0))
    car.set("steering", wheel)
    ticks(world, 100)
    car.base.speed = (speed, 0.0, speed * math.tan(wheel / 16) / 2.665)
    car.set("throttle", speed / 50)
    ticks(world, 100)
    path: list[tuple[float, float]] = []
    for _ in range(600):
        world.step(5)
        path.append(car.base.pose[:2])
    points = np.array(path)
    # A circle's points: x^2 + y^2 = 2 a x + 2 b y + c, with the middle (a, b) and c = r^2 - a^2 - b^2.
    least_squares: Any = np.linalg.lstsq
    a, b, c = least_squares(np.c_[2 * points, np.ones(len(points))], (points**2).sum(axis=1), rcond=None)[0]
    assert math.sqrt(c + a * a + b * b) == near(2.665 / abs(math.tan(wheel / 16)), rel=4e-3)
    turn = car.get("velocity").angular[2]
    assert turn == near(car.get("velocity").linear[0] * math.tan(wheel / 16) / 2.665, rel=4e-3)


def test_tyres_lose_their_grip_when_driven_too_fast_round_a_bend() -> None:
    world, car = driving()
    car.base.speed = (20.0, 0.0, 0.0)
    car.set("throttle", 0.4)
    car.set("steering", 8.0)
    ticks(world, 200)
    moves = car.get("velocity")
    assert abs(moves.angular[2] * moves.linear[0]) <= 0.9 * 9.81 * 1.05
    assert abs(moves.angular[2]) < 0.8 * moves.linear[0] * math.tan(0.5) / 2.665


def test_throttle_speeds_up_towards_the_top_speed() -> None:
    world, car = driving()
    car.set("throttle", 0.5)
    ticks(world, 100)
    # Force F and drag proportional to speed: v(t) = F/c (1 - exp(-c t / m)).
    assert car.get("velocity").linear[0] == near(25 * (1 - math.exp(-80 / 1175)), rel=5e-3)
    ticks(world, 20_000)
    assert car.get("velocity").linear[0] == near(25, rel=1e-3)


def test_brakes_stop_it_where_physics_says_and_hold_it() -> None:
    world, car = driving()
    car.base.speed = (15.0, 0.0, 0.0)
    car.set("brake", 0.5)
    ticks(world, 1000)
    there = car.get("pose").x
    without_drag = 15.0**2 / (2 * 4500 / 1175)
    assert 0.8 * without_drag < there < without_drag
    assert car.get("velocity").linear == near((0, 0, 0), abs=1e-6)
    ticks(world, 500)
    assert car.get("pose").x == near(there, abs=1e-6)


def test_brakes_do_the_same_in_one_long_step() -> None:
    there: list[float] = []
    for at_once in (5, 2500):
        world, car = driving()
        car.base.speed = (15.0, 0.0, 0.0)
        car.set("brake", 1.0)
        for _ in range(2500 // at_once):
            world.step(at_once)
        assert car.get("velocity").linear == near((0, 0, 0), abs=1e-6)
        there.append(car.get("pose").x)
    assert there[0] == there[1]


def test_steering_takes_the_time_that_a_driver_needs() -> None:
    world, car = driving()
    car.set("steering", 2 * math.pi)
    ticks(world, 25)
    assert car.joints["steer"].position * 16 == near(math.pi, abs=0.02)
    ticks(world, 25)
    assert car.joints["steer"].position * 16 == near(2 * math.pi, abs=1e-9)
    car.set("steering", 100.0)
    ticks(world, 200)
    assert car.joints["steer"].position == near(math.radians(35), abs=1e-3)


def test_a_wall_stops_it() -> None:
    world, car = driving(Wall(name="wall", start=(10, -5), end=(10, 5), thickness=0.3))
    car.base.speed = (10.0, 0.0, 0.0)
    car.set("throttle", 1.0)
    hardest = 0.0
    for _ in range(300):
        world.step(5)
        hardest = max([hardest, *(touch.force for touch in car.get("contacts"))])
        assert car.bounding_box().upper[0] < 9.85 + 0.1
    assert abs(car.get("velocity").linear[0]) < 0.05
    assert [(touch.part, touch.other) for touch in car.get("contacts")] == [("hull", "wall")]
    assert hardest > 10_000


def test_the_eye_is_at_the_drivers_head() -> None:
    world, car = driving(heading=math.pi / 2, position=(1.0, 2.0))
    world.refresh()
    assert world.mj_data.site(car.eye).xpos == near(np.array([1.0 - 0.35, 2.0 + 1.2, 1.2]))
    assert car.bounding_box("body").width == near(1.7)
    assert car.bounding_box("body").depth == near(4.2)
    assert car.bounding_box().upper[2] == near(1.45)


@pytest.mark.parametrize(
    ("word", "values", "message"),
    [
        ("walk", (1.0,), "car has no actuator 'walk'; it has joint, position, posture, steering, throttle, brake, teleport"),
        ("steer", (1.0,), "car has no actuator 'steer'; did you mean 'steering'"),
        ("throttle", (1.5,), r"throttle: must be <= 1 \(got 1\.5\)"),
        ("brake", (-0.1,), "brake: must be >= 0"),
        ("steering", (math.nan,), "steering: angle: must be a finite number"),
    ],
)
def test_wrong_commands_are_refused_with_a_reason(word: str, values: tuple[Any, ...], message: str) -> None:
    _, car = driving()
    with pytest.raises(Actr3dError, match=message):
        car.set(word, *values)


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"rear": 2.665}, r"Car\.rear: must be < the wheelbase of 2\.665 m \(got 2\.665\)"),
        ({"size": (4.0, 1.7, 0.2)}, r"Car\.size: its height must be > 0\.24 m"),
    ],
)
def test_wrong_cars_are_refused_with_a_reason(wrong: dict[str, Any], message: str) -> None:
    with pytest.raises(Actr3dError, match=message):
        Car(**wrong)
