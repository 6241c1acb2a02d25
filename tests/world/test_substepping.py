"""Fast limbs and loads do not pass through walls, and the physics does not diverge."""

from __future__ import annotations

import numpy as np
import pytest

from actr3d.world import Body, Car, Floor, Load, Mannequin, Scene, Wall, World


def random_walker(seed: int, thickness: float) -> tuple[World, Body, list[str], np.random.Generator]:
    """Returns a walker between two walls, with a load or without, some of its joints, and more random numbers."""
    random = np.random.default_rng(seed)
    loads = (None, Load(size=(random.uniform(0.6, 5), random.uniform(0.02, 0.06)), mass=random.uniform(0.5, 10)))
    walls = [Wall(name=f"wall_{x:g}", start=(x, -20), end=(x, 20), thickness=thickness, height=6) for x in (-3.0, 1.2)]
    trunk = "box" if seed % 2 else "ellipsoid"
    world = World(Scene(parts=(Floor(), Mannequin(name="walker", load=loads[seed % 3 != 0], trunk=trunk), *walls)))
    body = world.bodies["walker"]
    names = [name for name in body.joints if not name.startswith("eye")]
    return world, body, list(random.choice(names, size=6, replace=False)), random


@pytest.mark.daily(4)
@pytest.mark.parametrize("thickness", [0.02, 0.05])
@pytest.mark.parametrize("speed", [8.0, 16.0])
@pytest.mark.parametrize("seed", range(3))
def test_no_part_of_a_body_passes_through_a_wall_when_joints_move_to_and_fro(seed: int, speed: float, thickness: float) -> None:
    world, body, names, random = random_walker(seed, thickness)
    body.set("walk", float(random.choice([0.0, 3.0, -3.0])), float(random.choice([0.0, 8.0])))
    for tick in range(100):
        way = speed if (tick // (1, 10)[seed % 2]) % 2 else -speed
        for name in names:
            body.set("joint", name, way)
        world.step(5)
        box = body.bounding_box()
        assert box.upper[0] < 1.2 + 0.01, f"at tick {tick}"
        assert box.lower[0] > -3.0 - 0.01, f"at tick {tick}"
        assert np.abs(world.mj_data.qvel).max() < 100, f"at tick {tick}"


def test_a_bar_turned_with_the_body_stops_at_a_thin_wall() -> None:
    wall = Wall(name="wall", start=(1.5, -20), end=(1.5, 20), thickness=0.02)
    world = World(Scene(parts=(Floor(), Mannequin(name="walker", load=Load(size=(5.0, 0.03))), wall)))
    body = world.bodies["walker"]
    body.set("walk", 0.0, 12.0)
    deepest = 0.0
    for _ in range(60):
        world.step(5)
        deepest = max(deepest, body.bounding_box().upper[0])
    assert 1.48 < deepest < 1.5
    assert world.mj_model.opt.timestep == 0.002


def test_a_fast_car_stops_at_a_thin_wall() -> None:
    wall = Wall(name="wall", start=(40, -20), end=(40, 20), thickness=0.05)
    world = World(Scene(parts=(Floor(), Car(name="car"), wall)))
    body = world.bodies["car"]
    world.mj_data.qvel[0] = 40.0
    for _ in range(200):
        world.step(5)
        assert body.bounding_box().upper[0] < 40.0


def test_finer_steps_depend_on_the_state_alone() -> None:
    world, body, names, _ = random_walker(1, 0.02)
    body.set("walk", 3.0, 8.0)
    states: list[bytes] = []
    start = world.state()
    for watched in (False, True):
        world.restore(start)
        for tick in range(60):
            for name in names:
                body.set("joint", name, 8.0 if tick % 2 else -8.0)
            world.step(5)
            if watched:
                world.solve()
                world.state()
        states.append(world.state_bytes())
    assert states[0] == states[1]
    assert world.time == 600_000
