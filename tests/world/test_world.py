"""A world is compiled from a scene, keeps exact time, and continues exactly from a state."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from typing import Any

import mujoco
import numpy as np
import pytest

from actr3d.errors import Actr3dError, ConfigurationError, WorldError
from actr3d.world import Aperture, Car, Floor, Gait, ImportedBody, Mannequin, Scene, SimpleObject, Track, Wall, World
from actr3d.world.scene_objects import SHAPES
from tests.helpers.small_agents import near


def doorway(width: float = 0.7, heading: float = 0.0) -> World:
    return World(Scene(parts=(Floor(), Aperture(width=width, heading=heading, position=(3.0, 1.0)), SimpleObject(name="box"))))


def faces(world: World) -> float:
    """Returns the free width [m], measured between the inner faces of the two segments by a ray each way."""
    world.refresh()
    across = np.array([-np.sin(world.scene.parts[1].heading), np.cos(world.scene.parts[1].heading), 0.0])
    start, geom = np.array([3.0, 1.0, 1.0]), np.zeros(1, dtype=np.int32)
    reach = [mujoco.mj_ray(world.mj_model, world.mj_data, start, way, None, 1, -1, geom, None) for way in (across, -across)]
    return sum(reach)


@pytest.mark.parametrize("heading", [0.0, 0.4, 2.0])
def test_the_aperture_is_as_wide_as_it_says_before_and_during_a_run(heading: float) -> None:
    world = doorway(0.7, heading)
    assert world.aperture_width() == near(0.7, abs=1e-12)
    assert faces(world) == near(0.7, abs=1e-9)
    world.step(10)
    world.set_aperture_width(0.45)
    assert world.aperture_width() == near(0.45, abs=1e-12)
    world.step(10)
    assert faces(world) == near(0.45, abs=1e-9)


def test_continuing_from_a_state_gives_the_same_bytes() -> None:
    world = doorway()
    world.step(100)
    world.set_aperture_width(0.5)
    world.step(13)
    state = world.state()
    world.step(200)
    first = world.state()
    world.set_aperture_width(0.9)
    world.restore(state)
    assert world.aperture_width() == near(0.5, abs=1e-12)
    world.step(200)
    assert world.state().mj_state.tobytes() == first.mj_state.tobytes()
    assert (world.time, first.steps) == (626_000, 313)


def test_a_state_of_another_scene_is_refused_whatever_its_size() -> None:
    world, same, other = doorway(0.7), doorway(0.7), doorway(0.8)
    world.step(3)
    same.restore(world.state())
    assert same.state_bytes() == world.state_bytes()
    with pytest.raises(WorldError, match="the state is of another scene"):
        other.restore(world.state())
    assert other.time == 0


def test_looking_at_positions_changes_nothing() -> None:
    watched, unwatched = doorway(), doorway()
    for _ in range(50):
        watched.refresh()
        watched.step(5)
        unwatched.step(5)
    assert watched.state().mj_state.tobytes() == unwatched.state().mj_state.tobytes()


def test_a_loose_object_falls_and_lies_on_the_floor() -> None:
    world = doorway()
    world.step(1000)
    world.refresh()
    assert world.mj_data.body("box").xpos[2] == near(0.15, abs=2e-3)


@pytest.mark.parametrize("end", [(5.0, 5.0), (5.0, -5.0), (9.0, 3.0), (2.0, 4.0), (9.0, 0.0)])
def test_the_lines_of_a_track_keep_their_distance_at_corners(end: tuple[float, float]) -> None:
    points = ((0.0, 0.0), (5.0, 0.0), end)
    world = World(Scene(parts=(Track(points=points, width=3),)))
    for geom in range(world.mj_model.ngeom):
        along, at = world.mj_data.geom_xmat[geom].reshape(3, 3)[:2, 0], world.mj_data.geom_xpos[geom][:2]
        start, stop = np.array(points[geom % 2]), np.array(points[geom % 2 + 1])
        way = (stop - start) / np.linalg.norm(stop - start)
        side = np.array((-way[1], way[0]))
        for corner in (at - world.mj_model.geom_size[geom, 0] * along, at + world.mj_model.geom_size[geom, 0] * along):
            assert (corner - start) @ side == near(1.5 if geom < 2 else -1.5)


def test_track_lines_lie_half_a_width_beside_the_middle() -> None:
    world = World(Scene(parts=(Track(points=((0, 0), (10, 0)), width=4),)))
    assert sorted(world.mj_model.geom_pos[:, 1]) == [-2, 2]


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        (lambda: Wall(name="w", start=(1, 1), end=(1, 1)), "Wall 'w': start and end are the same point"),
        (
            lambda: SimpleObject(name="b", shape="cylinder", size=(1, 2, 3)),
            r"a cylinder takes radius and height \(got \(1\.0, 2\.0, 3\.0\)\)",
        ),
        (lambda: SimpleObject(name="b", mass=0), r"SimpleObject\.mass: must be > 0"),
        (lambda: Track(points=((0, 0),)), r"Track\.points: must be at least 2 long"),
        (lambda: Scene(parts=(Floor(), Floor())), "two parts are named 'floor'"),
        (lambda: Scene(parts=("floor",)), "'floor' is not a part"),
        (lambda: Scene(timestep=0.0000015), "must be a whole number of microseconds"),
        (lambda: doorway().set_aperture_width(-1), r"Aperture\.width: must be >= 0 \(got -1\.0\)"),
        (lambda: doorway().set_aperture_width(1, "apertur"), "no aperture 'apertur' in this scene; did you mean 'aperture'"),
        (lambda: doorway().restore(World(Scene()).state()), "is it of another scene"),
        (lambda: doorway().step(-1), r"World\.step: must be a whole number of steps, >= 0 \(got -1\)"),
        (lambda: doorway().set_aperture_width(1, 3), "no aperture '3' in this scene"),  # pyright: ignore[reportArgumentType]
        (lambda: Scene(parts=(Floor,)), r"must be a part \(got the class Floor; write Floor\(…\)\)"),
        (lambda: Scene(parts=(Wall(name="a\0", start=(0, 0), end=(1, 0)),)), r"'a\\x00' is no valid name"),
        (lambda: Scene(parts=(Mannequin(name="\ud800"),)), r"'\\ud800' is no valid name"),
        (
            lambda: Track(points=((0, 0), (5, 0), (1, 1))),
            r"Track 'track'\.points: must turn by <= 150 degrees at a point \(got 166 at point 1\)",
        ),
        (lambda: Track(points=((0, 0), (1, 0), (1, 0))), r"Track 'track'\.points: the points 1 and 2 are the same, \(1\.0, 0\.0\)"),
        (lambda: World(Floor()), r"a world is made of a Scene \(got Floor"),  # pyright: ignore[reportArgumentType]
        (lambda: World(Scene(), seed=-1), r"World\.seed: must be a whole number >= 0 \(got -1\)"),
    ],
)
def test_wrong_scenes_are_refused_with_a_reason(wrong: Callable[[], object], message: str) -> None:
    with pytest.raises(Actr3dError, match=message):
        wrong()


def test_divergence_of_the_physics_is_reported() -> None:
    world = doorway()
    world.mj_data.qvel[0] = 1e20
    with pytest.raises(Actr3dError, match="the physics diverged near"):
        world.step()


def test_the_diverged_body_is_named() -> None:
    near_one, far = SimpleObject(name="near"), SimpleObject(name="far", position=(1e12, 0, 0))
    with pytest.raises(Actr3dError, match=r"the physics diverged near 0\.002 s, at 'far'"):
        World(Scene(parts=(Mannequin(), near_one, far))).step()
    world = World(Scene(parts=(Mannequin(), near_one, SimpleObject(name="last", position=(9, 0, 1)))))
    world.mj_data.qvel[world.mj_model.joint("last").dofadr[0] + 2] = 1e20
    with pytest.raises(Actr3dError, match=r"the physics diverged near .*, at 'last'"):
        world.step()


def test_a_world_that_diverged_continues_from_an_earlier_state() -> None:
    world = doorway()
    world.step(10)
    state = world.state()
    world.step(10)
    expected = world.state()
    world.mj_data.qvel[0] = 1e20
    with pytest.raises(Actr3dError, match="the physics diverged near"):
        world.step()
    world.restore(state)
    world.step(10)
    assert world.state().mj_state.tobytes() == expected.mj_state.tobytes()


def test_an_aperture_does_not_close_on_a_body_inside_it() -> None:
    parts = (Floor(), Aperture(position=(0.0, 0.0)), Mannequin(name="walker"), Wall(name="beside", start=(-1, 2.5), end=(1, 2.5)))
    world = World(Scene(parts=parts))
    before = world.state()
    with pytest.raises(Actr3dError, match=r"aperture 'aperture' cannot be 0\.3 m wide now: walker would be inside its walls"):
        world.set_aperture_width(0.3)
    assert world.state().mj_state.tobytes() == before.mj_state.tobytes()
    with pytest.raises(Actr3dError, match=r"cannot be 0\.44 m wide now"):  # 2 mm at each side: it may push the person out
        world.set_aperture_width(0.44)
    world.set_aperture_width(0.443)
    world.step(100)
    assert world.aperture_width() == near(0.443)
    assert np.abs(world.mj_data.qvel).max() < 0.1
    assert world.bodies["walker"].get("pose").x == near(0, abs=0.02)


@pytest.mark.parametrize("rate", [0.001, 0.005, 0.02])
def test_an_aperture_narrowed_bit_by_bit_squeezes_out_or_stops_at_the_body_in_it(rate: float) -> None:
    world = World(Scene(parts=(Floor(), Aperture(position=(0.0, 0.0), width=0.6), Mannequin(name="walker"))))
    for _ in range(round(0.6 / rate) + 100):
        with suppress(Actr3dError):
            world.set_aperture_width(max(0.0, world.aperture_width() - rate))
        world.step(5)
        assert np.abs(world.mj_data.qvel).max() < 100  # it would be 500 rad/s if the walls closed on it in one step
    pose = world.bodies["walker"].get("pose")
    assert abs(pose.x) < 3
    assert abs(pose.y) < 0.5


def test_a_closing_aperture_closes_at_its_speed_the_same_after_a_restore() -> None:
    world = World(Scene(parts=(Floor(), Aperture(width=0.8, closing=0.1))))
    world.step(500)
    assert world.aperture_width() == near(0.7, abs=1e-9)
    before = world.state()
    for _ in range(400):
        world.step(5)
    assert world.aperture_width() == near(0.3, abs=1e-9)
    after = world.state().mj_state.tobytes()
    world.restore(before)
    for _ in range(400):
        world.step(5)
    assert world.state().mj_state.tobytes() == after
    world.step(5000)
    assert world.aperture_width() == near(0, abs=1e-9)


def test_a_closing_aperture_is_held_open_by_what_lies_in_it() -> None:
    box = SimpleObject(name="box", size=(0.3, 0.3, 0.3), position=(0.0, 0.0, 0.15))
    world = World(Scene(parts=(Floor(), Aperture(position=(0.0, 0.0), width=0.4, closing=0.1), box)))
    for _ in range(500):
        world.step(5)
        assert np.abs(world.mj_data.qvel).max() < 10
    assert 0.28 < world.aperture_width() < 0.3


@pytest.mark.parametrize("closing", [0.05, 0.1, 0.5])
@pytest.mark.parametrize("person", [{}, {"gait": Gait()}, {"trunk": "box"}, {"heading": 0.5, "position": (0.0, 0.02)}], ids=str)
def test_a_closing_aperture_stops_at_a_person_in_it(person: dict[str, Any], closing: float) -> None:
    world = World(Scene(parts=(Floor(), Aperture(width=0.47, position=(0.0, 0.0), closing=closing), Mannequin(name="m", **person))))
    for _ in range(150):
        world.step(5)
        assert np.hypot(*world.bodies["m"].base.speed[:2]) < 0.1 + closing / 2, "it was 17 m/s when the body was squeezed"
    assert world.aperture_width() > 0.2
    assert world.bodies["m"].get("pose").x == near(0, abs=0.05)


def test_a_closing_aperture_stops_at_two_people_side_by_side_in_it() -> None:
    people = (Mannequin(name="m", position=(0.0, -0.25)), Mannequin(name="n", position=(0.0, 0.25)))
    world = World(Scene(parts=(Floor(), Aperture(width=1.0, position=(0.0, 0.0), closing=0.1), *people)))
    world.step(1000)
    assert all(np.hypot(*body.base.speed[:2]) < 0.1 for body in world.bodies.values())
    assert world.aperture_width() == near(0.89, abs=0.01)


def test_an_aperture_closes_by_the_time_and_not_by_the_call() -> None:
    def closed(*calls: int) -> World:
        world = World(Scene(parts=(Floor(), Aperture(width=1.0, position=(0.0, 0.0), closing=0.5), Mannequin(name="m"))))
        for steps in calls:
            world.step(steps)
        return world

    one, many = closed(1000), closed(*[5] * 200)
    assert 0.44 < one.aperture_width() < 0.45
    assert one.state_bytes() == many.state_bytes()


def test_no_step_changes_nothing_and_whole_numbers_of_numpy_are_whole() -> None:
    wall = Wall(name="w", start=(0.174, -1), end=(0.174, 1))
    world = World(Scene(parts=(Floor(), Mannequin(name="m"), wall)))
    body = world.bodies["m"]
    body.get("contacts")
    body.set("walk", 0.5)
    world.step(np.int64(5))  # pyright: ignore[reportArgumentType]
    felt, moment = body.get("contacts"), world.physics.state_number
    assert felt
    world.step(0)
    assert (body.get("contacts"), world.physics.state_number) == (felt, moment)
    for steps in (2.5, "5", None, -1, np.float64(5)):
        with pytest.raises(Actr3dError, match=r"World\.step: must be a whole number of steps, >= 0 \(got "):
            world.step(steps)  # pyright: ignore[reportArgumentType]


def test_errors_of_scenes_name_what_is_wrong_on_one_line() -> None:
    with pytest.raises(WorldError, match=r"Scene\.parts: must be a part \(got the class Wall; write Wall\(…\)\)"):
        Scene(parts=(Wall,))
    with pytest.raises(WorldError, match="the scene cannot be compiled: ") as caught:
        World(Scene(parts=(Mannequin(name="a"), SimpleObject(name="a_torso", position=(3, 0, 1)))))
    assert "\n" not in str(caught.value)


def test_a_body_that_stands_inside_something_fixed_is_refused_at_the_start() -> None:
    walls = (Wall(name="w", start=(0, -1), end=(0, 1)), SimpleObject(name="pole", position=(0.2, 0, 0.5), mass=None))
    with pytest.raises(WorldError, match=r"'m' is inside 'w', 'pole' at the start; leave room"):
        World(Scene(parts=(Floor(), Mannequin(name="m"), *walls)))
    with pytest.raises(WorldError, match=r"'m' is inside 'aperture_(left|right)', 'aperture_(left|right)' at the start; leave room"):
        World(Scene(parts=(Floor(), Mannequin(name="m", position=(7.0, 0.0)), Aperture(width=0.3))))


def test_a_body_may_touch_a_wall_and_overlap_a_movable_object_at_the_start() -> None:
    touches, ball = Wall(name="w", start=(0.174, -1), end=(0.174, 1)), SimpleObject(name="ball", position=(-0.2, 0, 0.5))
    World(Scene(parts=(Floor(), Mannequin(name="m"), touches, ball)))
    sunk = ImportedBody(name="r", text='<mujoco><worldbody><body name="b"><geom size="0.1"/></body></worldbody></mujoco>', free=True)
    world = World(Scene(parts=(Floor(), sunk)))
    world.step(1000)
    assert world.bodies["r"].get("pose").z > 0.09


ROBOT = '<mujoco><worldbody><body name="arm"><joint name="elbow"/><geom size="0.1"/></body></worldbody></mujoco>'


@pytest.mark.parametrize(
    ("parts", "problem"),
    [
        (
            (Mannequin(name="a"), SimpleObject(name="a_torso", position=(3, 0, 1))),
            "the parts 'a' and 'a_torso' both have a body of this name",
        ),
        (
            (Aperture(), Wall(name="aperture_left", start=(0, 1), end=(0, 2))),
            "'aperture' and 'aperture_left' both have a body of",
        ),
        ((SimpleObject(name="a_arm"), ImportedBody(name="a", text=ROBOT)), "the parts 'a_arm' and 'a' both have a body of this name"),
        ((Track(points=((0, 0), (1, 0))), SimpleObject(name="track_0")), "the parts 'track' and 'track_0' both have a geom of this name"),
        ((SimpleObject(name="a_elbow"), ImportedBody(name="a", text=ROBOT)), "the parts 'a_elbow' and 'a' both have a joint of this name"),
        ((SimpleObject(name="world"),), "the part 'world' has a body of this name, which is reserved"),
    ],
)
def test_two_parts_with_one_derived_name_are_named(parts: tuple[object, ...], problem: str) -> None:
    with pytest.raises(WorldError, match=rf"repeated name '.*{problem}.*; rename (it|one of them)"):
        World(Scene(parts=parts))


def test_a_loose_object_has_a_least_size_and_mass() -> None:
    for shape, (_, sizes, _) in SHAPES.items():
        with pytest.raises(ConfigurationError, match=r"SimpleObject 'o'.size: must be >= 0.0001 m \(got \(1e-09,"):
            SimpleObject.from_mapping({"name": "o", "shape": shape, "size": (1e-9,) * sizes})
        least = SimpleObject.from_mapping({"name": "o", "shape": shape, "size": (1e-4,) * sizes, "mass": 1e-6})
        World(Scene(parts=(least,)))
    with pytest.raises(ConfigurationError, match=r"SimpleObject 'o'.mass: must be >= 1e-06 kg \(got 1e-16\)"):
        SimpleObject(name="o", mass=1e-16)


@pytest.mark.parametrize("part", [Aperture, Car, SimpleObject, Mannequin])
def test_a_heading_in_degrees_is_refused(part: type[Any]) -> None:
    with pytest.raises(ConfigurationError, match=r"heading: must be <= 6.28\d* \(got 40.0\)"):
        part(name="turned", heading=40)
