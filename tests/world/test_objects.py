"""Moving and pushing by hand: bodies, walls, fixed and loose objects; exact after a seek."""

from __future__ import annotations

import math
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from actr3d.errors import Actr3dError, WorldError
from actr3d.recording import Recorded
from actr3d.runner.replay import replay
from actr3d.simulation import Simulation
from actr3d.world import Aperture, Floor, Mannequin, Scene, SimpleObject, Wall, World

PARTS = (
    Floor(),
    Wall(name="wall", start=(3, -1), end=(3, 1)),
    Aperture(),
    SimpleObject(name="pole", shape="cylinder", size=(0.1, 1.0), position=(5, 2, 1), mass=None),
    SimpleObject(name="box", shape="box", size=(0.3, 0.3, 0.3), position=(1, 2, 0.15), mass=5),
    Mannequin(name="walker"),
)


def world() -> World:
    return World(Scene(parts=PARTS), seed=1)


def test_everything_that_does_not_belong_to_an_aperture_can_be_moved() -> None:
    made = world()
    assert made.objects.names == ("walker", "wall", "pole", "box")
    for name in made.objects.names:
        made.move(name, 1.5, -3.0, 0.5)
        assert made.objects.pose(name) == pytest.approx((1.5, -3.0, 0.5))
        made.move(name, 9.0 + made.objects.names.index(name), 5.0)
        assert made.objects.pose(name)[2] == pytest.approx(0.5)  # it keeps its heading


def test_a_moved_wall_is_an_obstacle() -> None:
    def walked(x: float | None) -> float:
        made = world()
        if x is not None:
            made.move("wall", x, 0.0)
        made.bodies["walker"].set("walk", 1.3)
        made.step(1500)
        return made.bodies["walker"].get("pose").x

    assert walked(1.5) < 1.5 < walked(2.5) < 2.5 < walked(None) < 3.0


def test_nothing_is_put_inside_something_else() -> None:
    made = world()
    before = made.state()
    for name, x, y, inside in (("wall", 0, 0, "walker"), ("walker", 3, 0, "wall"), ("box", 3, 0, "wall"), ("pole", 0, 0, "walker")):
        with pytest.raises(WorldError, match=rf"'{name}' cannot be put at \({x}, {y}\) m: it would be inside '{inside}'; leave room"):
            made.move(name, x, y)
    assert made.state().bodies == before.bodies
    assert made.state_bytes() == before.mj_state.tobytes()


def holding(*parts: Wall) -> Simulation:
    """Returns a simulation in which the right hand of `m` holds the box `o`."""
    box = SimpleObject(name="o", size=(0.1, 0.1, 0.1), position=(0.12, -0.16075, 0.773), mass=0.2)
    simulation = Simulation(Scene(parts=(Floor(), Mannequin(name="m"), box, *parts)), seed=1)
    simulation.command("grasp", "o", body="m")
    simulation.run(0.1)
    assert simulation.world.bodies["m"].get("grasp")["right"] == "o"
    return simulation


def test_a_held_object_cannot_be_moved_by_a_user() -> None:
    simulation = holding()
    before = simulation.world.state_bytes()
    with pytest.raises(WorldError, match=r"'o' cannot be moved: it is in the right hand of 'm'; release it first"):
        simulation.command("move", "o", 0.1, -3.0)
    assert simulation.world.state_bytes() == before
    simulation.command("release", body="m")
    simulation.command("move", "o", 0.1, -3.0)
    assert simulation.world.objects.pose("o")[:2] == (0.1, -3.0)


def test_a_body_is_not_moved_to_where_its_held_object_would_be_inside_a_wall() -> None:
    simulation = holding(Wall(name="w", start=(2.4, -1), end=(2.4, 1)))
    before = simulation.world.state_bytes()
    with pytest.raises(WorldError, match=r"'m' cannot be put at \(2.2, 0\) m: it would be inside 'w'; leave room"):
        simulation.command("move", "m", 2.2, 0.0)
    assert simulation.world.state_bytes() == before
    simulation.command("move", "m", 1.5, 0.0)
    assert simulation.world.objects.pose("m")[0] == 1.5


def test_a_held_object_is_carried_on_after_a_push() -> None:
    simulation = holding()
    carried = simulation.world.mj_data.body("o").xfrc_applied.copy()
    assert carried[2] > 0
    simulation.command("push", "o", 1.0, 0.0, 0.105)
    simulation.command("push", "o", 0.0, 1.0, 0.05)
    simulation.run(0.07)
    state = simulation.world.state_bytes()
    simulation.run(0.13)
    end = simulation.world.state_bytes()
    assert simulation.world.mj_data.body("o").xfrc_applied.tolist() == carried.tolist()
    simulation.seek(0.17)
    assert simulation.world.state_bytes() == state
    simulation.run(0.13)
    assert simulation.world.state_bytes() == end


def test_a_push_has_its_impulse_and_the_legs_withstand_a_weak_one() -> None:
    made = world()
    made.mj_model.opt.gravity[:] = 0  # without weight there is no friction
    made.push("box", 3.0, -4.0, 0.123)
    made.step(5)
    made.step(100)
    assert made.mj_data.joint("box").qvel[:2] == pytest.approx((3 * 0.124 / 5, -4 * 0.124 / 5), rel=1e-3)  # whole physics steps of 2 ms
    ways: list[float] = []
    for force in (100.0, 450.0, 600.0):
        made = world()
        made.push("walker", 0.0, force, 0.3)
        made.step(500)
        ways.append(made.objects.pose("walker")[1])
    assert ways[0] == pytest.approx(0.0, abs=0.002)
    assert 0.01 < ways[1] < ways[2] < 0.5


def test_pushes_in_progress_are_part_of_the_state() -> None:
    made = world()
    made.push("walker", 0.0, 500.0, 0.3)
    made.step(40)
    state = made.state()
    made.step(500)
    end = made.state_bytes()
    made.restore(state)
    made.step(500)
    assert made.state_bytes() == end


@pytest.mark.parametrize(
    ("command", "problem"),
    [
        (("move", "wal", 0, 0), r"no object 'wal' to move; did you mean 'wall'\? There are: walker, wall, pole, box"),
        (("move", "aperture_left", 0, 0), r"no object 'aperture_left' to move"),
        (("move", "wall", math.nan, 0), r"move.x: must be a finite number \(got nan\)"),
        (("move", "wall", 1e9, 0), r"move.x: must be <= 10000.0 \(got 1000000000.0\)"),
        (("move", "box", 1, -1e300), r"move.y: must be >= -10000.0 \(got -1e\+300\)"),
        (("move", "walker", 5, 1, 1e300), r"move.heading: must be <= 6.28\d* \(got 1e\+300\)"),
        (("push", "wall", 10), r"'wall' is fixed; there are: walker, box"),
        (("push", "box", 1e9), r"push.x: must be <= 100000.0 \(got 1000000000.0\)"),
        (("push", "box", 10, 0, 0), r"push.time: must be > 0 \(got 0.0\)"),
        (("push", "box", 0, 0), r"push.x: must not be 0 if y is 0 too"),
        (("push", "box"), r"command 'push': missing a required argument: 'x'; it takes \(object, x, y=0.0, time=0.1\)"),
    ],
)
def test_a_wrong_change_names_what_is_wrong(command: tuple[str, ...], problem: str) -> None:
    simulation = Simulation(Scene(parts=PARTS), seed=1)
    with pytest.raises(Actr3dError, match=problem):
        simulation.command(*command)


@pytest.mark.parametrize(
    ("call", "values", "problem"),
    [
        (World.move, ("walker", math.nan, 0), r"move: x: must be a finite number \(got nan\)"),
        (World.move, ("wall", 0, 1e300), r"move: y: must be <= 10000 \(got 1e\+300\)"),
        (World.move, ("box", 1, 2, -1e300), r"move: heading: must be >= -6.2832 rad, a full turn \(got -1e\+300\)"),
        (World.move, ("box", "here", 2), r"move: x: must be a number \(got 'here'\)"),
        (World.move, ("box", True, 2), r"move: x: must be a number \(got True\)"),
        (World.move, (["box"], 1, 2), r"no object '\['box'\]' to move; there are: walker, wall, pole, box"),
        (World.push, ("box", 10**400), r"push: x: must be a finite number"),
        (World.push, ("box", 0, -1e6), r"push: y: must be >= -100000 \(got -1000000.0\)"),
        (World.push, ("box", 1, 0, -1), r"push: time: must be >= 1e-06 \(got -1\)"),
        (World.push, ("box", 1, 0, None), r"push: time: must be a number \(got None\)"),
        (World.restore, (None,), r"World.restore: must be a WorldState, as state\(\) returns it \(got None\)"),
    ],
)
def test_a_wrong_argument_is_refused_where_it_is_given(call: Callable[..., None], values: tuple[Any, ...], problem: str) -> None:
    made = world()
    before = made.state_bytes()
    with pytest.raises(WorldError, match=problem):
        call(made, *values)
    assert made.state_bytes() == before
    made.step(1)


def test_a_body_is_not_teleported_farther_than_scenes_reach() -> None:
    body = world().bodies["walker"]
    for values, problem in (
        ((1e300, 0), "x: must be <= 10000"),
        ((0, -1e5), "y: must be >= -10000"),
        ((0, 0, 1e4), "heading: must be <= 6.2832 rad, a full turn"),
    ):
        with pytest.raises(WorldError, match=f"teleport: {problem} "):
            body.set("teleport", *values)


def test_a_state_with_numbers_that_are_not_finite_is_not_restored() -> None:
    made = world()
    state = made.state()
    state.mj_state[3] = math.nan
    with pytest.raises(WorldError, match=r"World.restore: the numbers of the state must be finite \(got nan\)"):
        made.restore(state)


def test_changes_of_the_world_are_exact_after_going_back_and_in_a_replay(tmp_path: Path) -> None:
    def made() -> Simulation:
        return Simulation(Scene(parts=PARTS), seed=1)

    simulation = made()
    ends: list[bytes] = []
    with simulation.record(tmp_path / "run.sqlite"):
        simulation.command("walk", 1.0, body="walker")
        simulation.run(0.3)
        simulation.command("push", "walker", 0.0, 600.0, 0.25)
        simulation.command("move", "wall", 1.5, 0.0, 1.2)
        simulation.run(0.1)
        simulation.command("push", "box", x=300.0, time=0.05)
        simulation.command("move", "pole", 0.5, -2.0)
        simulation.run(1.1)
        ends.append(simulation.world.state_bytes())
        for time in (0.35, 0.3, 0.0, 0.41):
            simulation.seek(time)
            simulation.run(1.5 - time)
            ends.append(simulation.world.state_bytes())
    assert set(ends) == {ends[0]}
    with Recorded(tmp_path / "run.sqlite") as recorded:
        assert replay(recorded, made).difference is None


def test_a_turned_body_is_shown_with_a_heading_that_it_can_be_given() -> None:
    made = world()
    walker = made.bodies["walker"]
    walker.set("turn", 7.5, 5.0)
    made.step(1000)
    x, y, heading = made.objects.pose("walker")
    assert walker.base.heading == pytest.approx(7.5)
    assert heading == pytest.approx(7.5 - 2 * math.pi)
    made.move("walker", x, y, heading)


def test_a_body_that_is_moved_while_it_turns_turns_by_the_rest_of_the_angle() -> None:
    made = world()
    walker = made.bodies["walker"]
    walker.set("turn", 1.5)
    made.step(5)
    turned = walker.base.heading
    made.move("walker", 0, 0, 3.0)
    made.step(1000)
    assert turned > 0
    assert walker.base.heading == pytest.approx(3.0 + 1.5 - turned)
