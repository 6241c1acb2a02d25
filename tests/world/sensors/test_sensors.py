"""Sensors report the present state, and reading them changes nothing."""

from __future__ import annotations

import math
import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from dataclasses import FrozenInstanceError, dataclass, replace
from functools import cache
from typing import Any, NamedTuple

import numpy as np
import pytest
from mujoco import MjSpec, mjtGeom

from actr3d.errors import Actr3dError
from actr3d.world import Aperture, Body, Car, Floor, Mannequin, Scene, SimpleObject, Wall, World
from actr3d.world.anatomy import Anatomy
from actr3d.world.body import SENSORS
from actr3d.world.command_registry import BodyFunction
from actr3d.world.sensor_noise import SensorNoise
from actr3d.world.sensors.render import Picture
from actr3d.world.sensors.touch import present
from tests.helpers.small_agents import near


def walker_in(*parts: Any, seed: int = 0, **of: Any) -> tuple[World, Body]:
    """Returns a world with a floor, a mannequin called `walker` and more, and its body."""
    world = World(Scene(parts=(Floor(), Mannequin(name="walker", **of), *parts)), seed)
    return world, world.bodies["walker"]


def ticks(world: World, count: int) -> None:
    for _ in range(count):
        world.step(5)


WALL = Wall(name="wall", start=(3.0, -10.0), end=(3.0, 10.0), thickness=0.2)


@dataclass(frozen=True)
class Crate:
    """A free box that feels contacts."""

    name: str = "crate"
    height: float = 0.5

    def add_to(self, mj_spec: MjSpec) -> None:
        body = mj_spec.worldbody.add_body(name=self.name, pos=[0, 0, self.height])
        body.add_freejoint()
        body.add_geom(name="crate_box", type=mjtGeom.mjGEOM_BOX, size=[0.2, 0.2, 0.2], mass=7)

    def anatomy(self) -> Anatomy:
        return Anatomy(root=self.name, prefix="crate_")


def test_pose_and_velocity_are_of_this_moment() -> None:
    world, body = walker_in(position=(1.0, 2.0), heading=0.3)
    body.set("walk", 1.2, 0.7)
    body.set("joint", "torso_yaw", 0.5)
    body.set("joint", "torso_pitch", 0.2)
    ticks(world, 50)
    before = body.get("pose", "head")
    moves = body.get("velocity", "head", frame="world")
    world.step(1)
    after = body.get("pose", "head")
    for name, speed in zip(("x", "y", "z"), moves.linear, strict=True):
        assert (getattr(after, name) - getattr(before, name)) / 0.002 == near(speed, abs=5e-3)
    assert body.get("pose").heading == near(0.3 + 0.7 * 0.502, abs=1e-3)
    assert after.heading - before.heading == near(0.002 * 1.2, abs=1e-4)
    assert after.pitch > 0.05
    assert body.get("velocity").linear == near((1.2, 0, 0), abs=0.02)


def test_the_gyroscope_turns_with_the_head() -> None:
    world, body = walker_in()
    body.set("walk", 0.0, 0.8)
    body.set("joint", "head_yaw", -0.3)
    ticks(world, 10)
    assert body.get("gyroscope") == near((0, 0, 0.5), abs=5e-3)
    assert body.get("gyroscope", "legs") == near((0, 0, 0.8), abs=5e-3)


def test_the_accelerometer_feels_rest_a_bend_and_free_fall() -> None:
    world, body = walker_in()
    assert body.get("accelerometer") == near((0, 0, 9.81), abs=1e-9)
    body.set("walk", 1.5, 0.8)
    ticks(world, 50)
    assert body.get("accelerometer", "legs") == near((0, 1.5 * 0.8, 9.81), abs=0.05)
    falling = World(Scene(parts=(Floor(), Crate(height=3.0))))
    falling.step(50)
    assert falling.bodies["crate"].get("accelerometer") == near((0, 0, 0), abs=1e-9)


@pytest.mark.parametrize(
    ("pushed", "part", "force"), [(Car(name="it"), None, 5000), (Mannequin(name="it"), "legs", 2000)], ids=["car", "m"]
)
def test_the_accelerometer_feels_a_push(pushed: Any, part: str | None, force: float) -> None:
    world = World(Scene(parts=(Floor(), pushed)))
    body = world.bodies["it"]
    world.step(50)
    world.push("it", force)
    for steps in (0, 5):
        world.step(steps)
        felt, before, state = body.get("accelerometer", part), body.get("velocity", part, frame="world"), world.state()
        world.step()
        gained = (body.get("velocity", part, frame="world").linear[0] - before.linear[0]) / world.scene.timestep
        world.restore(state)
        assert gained > 4
        assert felt[0] == near(gained, rel=0.1)  # commands of the legs, which correct their speed, are not in it
    world.step(50)
    assert abs(body.get("accelerometer", part)[0]) < 1


def test_the_accelerometer_is_of_the_present_and_not_of_the_step_before() -> None:
    world = World(Scene(parts=(Floor(), Crate(height=3.0))))
    crate = world.bodies["crate"]
    world.step(5)
    world.mj_data.xfrc_applied[crate.root, 1] = 21.0
    world.changed()
    assert crate.get("accelerometer") == near((0, 3.0, 0), abs=1e-9)
    world.step(1)
    world.mj_data.xfrc_applied[crate.root, 1] = 0.0
    world.changed()
    assert crate.get("accelerometer") == near((0, 0, 0), abs=1e-9)


def test_joints_report_their_positions() -> None:
    world, body = walker_in()
    body.set("position", "torso_yaw", 0.5, 2.0)
    body.set("joint", "head_yaw", -10.0)
    ticks(world, 60)
    joints = body.get("joints")
    assert joints["torso_yaw"].position == near(0.5)
    assert joints["torso_yaw"].limit is None
    assert joints["head_yaw"].limit == "lower"
    assert set(joints) == set(body.joints)


def test_contacts_add_up_to_the_weight() -> None:
    world = World(Scene(parts=(Floor(), Crate())))
    crate = world.bodies["crate"]
    assert crate.get("contacts") == ()
    ticks(world, 150)
    (touch,) = crate.get("contacts")
    assert (touch.part, touch.other) == ("box", "floor")
    assert touch.force == near(7 * 9.81, rel=1e-3)


def test_a_blow_that_is_over_before_the_tick_is_felt() -> None:
    ball = SimpleObject(name="ball", shape="sphere", size=(0.1,), mass=0.5, position=(0.5, 0.0, 1.0))
    world, body = walker_in(ball)
    body.get("contacts")
    free = world.mj_model.joint("ball").dofadr[0]
    world.mj_data.qvel[free] = -8.0
    felt: list[Any] = []
    for _ in range(20):
        world.step(5)
        felt += [*body.get("contacts")]
        if felt:
            break
    assert [touch.other for touch in felt] == ["ball"]
    assert felt[0].force > 100
    assert world.mj_data.qvel[free] > -8.0


def test_observers_feel_without_starting_a_watch() -> None:
    world, body = walker_in(Wall(name="wall", start=(0.3, -2.0), end=(0.3, 2.0), thickness=0.1))
    body.set("walk", 1.0)
    ticks(world, 50)
    assert {touch.other for touch in present(body)} == {"wall"}
    assert body.state().touched is None
    (touch,) = body.get("contacts")
    assert (touch,) == present(body)


@pytest.mark.parametrize(("angle", "elevation"), [(0.0, 0.0), (0.5, 0.0), (-1.0, 0.1)])
def test_the_rangefinder_measures_from_the_eye(angle: float, elevation: float) -> None:
    world, body = walker_in(WALL)
    world.refresh()
    eye = world.mj_data.site("walker_eye").xpos[0]
    expected = (2.9 - eye) / (math.cos(angle) * math.cos(elevation))
    assert body.get("rangefinder", angle, elevation) == near(expected, abs=1e-9)
    assert body.get("rangefinder", angle, elevation, reach=expected - 1e-6) is None


def test_its_own_body_and_what_it_holds_do_not_hide_the_world() -> None:
    cup = SimpleObject(name="cup", size=(0.06, 0.06, 0.3), position=(0.05, -0.2, 0.68), mass=0.2)
    _, body = walker_in(WALL, cup)
    assert body.get("rangefinder", at="torso") == near(2.9)
    assert body.get("rangefinder", at="left_upper_arm", angle=-math.pi / 2) is None
    assert body.get("rangefinder", at="left_upper_arm") == near(2.9)
    body.set("grasp", "cup")
    assert body.get("grasp") == {"left": None, "right": "cup"}
    assert body.get("rangefinder", at="right_upper_arm", elevation=-1.2, reach=20) == near(1.4315 / math.sin(1.2), abs=1e-3)


def test_the_laser_sweeps_from_left_to_right() -> None:
    world, body = walker_in(Aperture(position=(2.0, 0.0), width=0.8, thickness=0.1))
    world.refresh()
    ahead = 1.95 - world.mj_data.site("walker_eye").xpos[0]
    scan = body.get("laser", rays=181, fov=math.pi, reach=30.0)
    assert len(scan) == 181
    assert scan[0] is None
    assert scan[90] is None
    angles = np.linspace(math.pi / 2, -math.pi / 2, 181)
    for angle, distance in zip(angles, scan, strict=True):
        across = ahead * math.tan(angle)
        if 0.4 < abs(across) < 2.8:
            assert distance == near(ahead / math.cos(angle), abs=1e-9)
    one_sided = walker_in(Wall(name="left", start=(-5, 2), end=(5, 2)))[1].get("laser", rays=3, fov=math.pi)
    assert one_sided[0] == near(1.95)
    assert one_sided[1:] == (None, None)


def test_proximity_is_the_nearest_surface() -> None:
    ball = SimpleObject(name="ball", shape="sphere", size=(0.2,), mass=None, position=(0.0, 0.9, 0.818 * 1.75))
    _, body = walker_in(ball, WALL)
    found = body.get("proximity", 3.0)
    assert (found.part, found.other) == ("left_shoulder_joint", "ball")
    assert found.distance == near(0.9 - 0.2 - 0.222, abs=1e-6)
    assert body.get("proximity", 0.3) is None


@cache
def can_draw() -> bool:
    """Returns whether this machine has EGL, tested in a separate process."""
    code = "import mujoco.egl; mujoco.egl.GLContext(64, 64).make_current()"
    return subprocess.run([sys.executable, "-c", code], capture_output=True, check=False).returncode == 0


def test_pictures_show_what_the_eye_sees_or_say_what_is_missing() -> None:
    world, body = walker_in(WALL)
    if not can_draw():
        with pytest.raises(Actr3dError, match="pictures need EGL"):
            body.get("image")
        return
    image, depth = body.get("image", 80, 60), body.get("depth", 80, 60)
    assert image.as_array().shape == (60, 80, 3)
    assert len(np.unique(image.as_array())) > 3
    distances = depth.as_array()
    assert distances.shape == (60, 80)
    assert distances[30, 40] == near(body.get("rangefinder"), rel=2e-3)
    assert body.get("depth", 80, 60).pixels == depth.pixels
    assert world.state().compiled == (), "the compiled model is that of the start"
    ticks(world, 1)
    body.set("teleport", 1.0, 0.0)
    assert body.get("depth", 80, 60).as_array()[30, 40] == near(distances[30, 40] - 1.0, rel=5e-3)
    noisy = body.get("depth", 80, 60, noise=0.1).as_array() - body.get("depth", 80, 60).as_array()
    assert noisy.std() == near(0.1, rel=0.05)
    assert (noisy.dtype, body.get("image", noise=3.0).as_array().dtype) == (np.float32, np.uint8)


def test_pictures_are_drawn_in_one_thread() -> None:
    if not can_draw():
        pytest.skip("there is no EGL here")
    _, body = walker_in(WALL)
    first = body.get("depth", 8, 6)
    with ThreadPoolExecutor() as others, pytest.raises(Actr3dError, match="draws its pictures in one thread, that of the first picture"):
        others.submit(body.get, "depth", 8, 6).result()
    assert body.get("depth", 8, 6) == first


def test_a_picture_s_noise_is_one_number() -> None:
    picture = Picture(kind="depth", width=1, height=1, pixels=bytes(4))
    with pytest.raises(Actr3dError, match="noise of depth: a picture has no fields; give one number"):
        SensorNoise(0, "walker").added("depth", picture, {"x": 1.0})


def test_without_egl_pictures_are_refused_with_a_reason() -> None:
    code = (
        "from actr3d.world import *\n"
        "from actr3d.errors import WorldError\n"
        "body = World(Scene(parts=(Mannequin(),))).bodies['mannequin']\n"
        "try:\n"
        "    body.get('image')\n"
        "except WorldError as error:\n"
        "    print(error)\n"
    )
    here = {**os.environ, "PYOPENGL_PLATFORM": "none-such", "MUJOCO_GL": ""}
    ran = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, env=here, check=False)
    assert "pictures need EGL, which is not installed here or cannot be used" in ran.stdout


def test_reading_everything_changes_nothing() -> None:
    box = SimpleObject(name="box", position=(0.9, 0.0, 0.15))
    (read, body), (unread, other) = walker_in(WALL, box), walker_in(WALL, box)
    for each in (body, other):
        each.set("walk", 1.4, 0.1)
        each.set("joint", "torso_yaw", 0.4)
    for _ in range(100):
        for word in body.sensors:
            if word not in ("image", "depth"):
                body.get(word)
        read.step(5)
        unread.step(5)
        assert read.state().mj_state.tobytes() == unread.state().mj_state.tobytes()


def test_readings_stay_as_they_were() -> None:
    world, body = walker_in()
    pose, joints = body.get("pose"), body.get("joints")
    body.set("walk", 2.0)
    ticks(world, 10)
    assert pose.x == 0.0
    assert joints["torso_yaw"].position == 0.0
    assert body.get("pose").x == near(0.2)
    with pytest.raises(FrozenInstanceError):
        pose.x = 3.0


def test_an_array_that_a_sensor_returns_becomes_a_tuple_that_stays(monkeypatch: pytest.MonkeyPatch) -> None:
    def own(body: Any) -> Any:
        body.physics.refresh()
        place = body.physics.mj_data.xpos[body.root]
        return {
            "place": place,
            "rows": [np.array([place[:2]])],
            "x": np.float32(place[0]),
            "none": np.array(3),
            "far": np.ma.masked_less(place, 9),
        }

    world, body = walker_in()
    monkeypatch.setitem(SENSORS, "own", BodyFunction("own", own, lambda _: True))
    reading = body.get("own")
    assert reading == {"place": (0.0, 0.0, 0.0), "rows": [((0.0, 0.0),)], "x": 0.0, "none": 3, "far": (None, None, None)}
    body.set("walk", 2.0)
    ticks(world, 10)
    assert reading["place"] == (0.0, 0.0, 0.0)
    assert body.get("own")["place"][0] == near(0.2)
    assert body.get("own", noise={"place": 0.1})["place"][1] != 0


def test_noise_has_the_size_it_is_given_and_none_by_default() -> None:
    _, body = walker_in(WALL)
    exact = body.get("rangefinder")
    readings = np.array([body.get("rangefinder", noise=0.05) for _ in range(2000)])
    assert readings.mean() == near(exact, abs=0.005)
    assert readings.std() == near(0.05, rel=0.1)
    assert body.get("rangefinder") == exact
    assert None in body.get("laser", noise=0.1)


def test_noise_by_field_leaves_the_others_exact() -> None:
    _, body = walker_in()
    pose = body.get("pose", noise={"x": 0.1})
    assert pose.x != 0
    assert replace(pose, x=0.0) == body.get("pose")


class Spot(NamedTuple):
    """A reading of a user-defined sensor."""

    x: float
    name: str


def test_noise_is_added_to_every_reading_or_refused() -> None:
    noise = SensorNoise(0, "walker")
    by_key = noise.added("own", {"a": 1.0, "b": 2.0}, {"a": 0.5})
    assert by_key["a"] != 1.0
    assert by_key["b"] == 2.0
    spot = noise.added("own", Spot(1.0, "here"), 0.5)
    assert isinstance(spot, Spot)
    assert spot.x != 1.0
    assert noise.added("own", Spot(1.0, "here"), {"x": 0.0}) == Spot(1.0, "here")
    assert noise.added("own", (None, "text", 3, np.int64(3), True), 1.0) == (None, "text", 3, 3, True)
    for reading in ([1.0, 2.0], np.ones(2), np.float32(1), {"a": [1.0]}):
        with pytest.raises(Actr3dError, match=r"noise of own: is not added to a (list|ndarray|float32) \(got "):
            noise.added("own", reading, 0.5)
    with pytest.raises(Actr3dError, match=r"noise of own: its readings have no 'c'; they have a, b"):
        noise.added("own", {"a": 1.0, "b": 2.0}, {"c": 0.5})
    _, body = walker_in()
    joints = body.get("joints", noise={"position": 0.1})
    assert joints["torso_yaw"].position != 0
    assert joints["torso_yaw"].velocity == 0


def test_noise_of_a_description_is_checked_at_the_start_and_can_be_by_field() -> None:
    for noise, message in (
        (("proprioception", 0.1), "takes no noise"),
        (("pose", (("xx", 0.1),)), "its readings have no 'xx'"),
        (("pose", (("x", -0.1),)), "noise of pose: must be >= 0"),
        (("touch", 0.1), "walker has no sensor 'touch'"),
    ):
        with pytest.raises(Actr3dError, match=message):
            walker_in(noise=(noise,))
    _, body = walker_in(noise=(("pose", (("x", 0.1),)),))
    fresh = body.state()
    assert fresh.noise == ()
    pose = body.get("pose")
    assert pose.x != 0
    assert pose.y == 0


def test_noise_comes_from_the_seed_and_from_its_own_sensor() -> None:
    first, again, other = (walker_in(seed=seed, noise=(("pose", 0.1),))[1] for seed in (1, 1, 2))
    again.get("gyroscope", noise=1.0)
    one, two, three = (body.get("pose") for body in (first, again, other))
    assert one == two
    assert one != three


def test_noise_continues_exactly_from_a_state() -> None:
    world, body = walker_in(noise=(("pose", 0.1),))
    body.get("pose")
    state = world.state()
    first = [body.get("pose") for _ in range(3)]
    world.restore(state)
    assert [body.get("pose") for _ in range(3)] == first


@pytest.mark.parametrize(
    ("word", "options", "message"),
    [
        ("poze", {}, "walker has no sensor 'poze'; did you mean 'pose'? It has anatomy, pose, velocity"),
        (
            "rangefinder angle:1.5",
            {},
            r"did you mean 'rangefinder'? Give its values as arguments of Python .*: \(angle=0\.0, ",
        ),
        ("anatomy all", {}, "walker has no sensor 'anatomy all'; did you mean 'anatomy'? It takes no values"),
        ("pose", {"part": "arm"}, "walker has no part 'arm'"),
        ("pose", {"prt": "arm"}, r"walker: pose takes \(part=None\): got an unexpected keyword argument 'prt'"),
        ("velocity", {"frame": "wrld"}, "velocity: frame must be 'part' or 'world'"),
        ("laser", {"rays": 0}, "laser: rays: must be >= 1 "),
        ("laser", {"rays": 100_001}, "laser: rays: must be <= 100000 "),
        ("laser", {"rays": 2.7}, r"laser: rays: must be a whole number \(got 2\.7\)"),
        ("laser", {"rays": True}, r"laser: rays: must be a number \(got True\)"),
        ("rangefinder", {"at": "nowhere"}, "no frame, part or site 'nowhere'"),
        ("rangefinder", {"reach": -1}, "rangefinder: reach: must be >= 0"),
        ("rangefinder", {"angle": 90}, r"rangefinder: angle: must be <= 6\.2832 rad, a full turn \(got 90\)"),
        ("rangefinder", {"elevation": -45}, r"rangefinder: elevation: must be >= -6\.2832 rad, a full turn \(got -45\)"),
        ("laser", {"elevation": 45}, r"laser: elevation: must be <= 6\.2832 rad, a full turn \(got 45\)"),
        ("pose", {"noise": -1}, "walker: noise of pose: must be >= 0"),
        ("pose", {"noise": {"xx": 1}}, "noise of pose: its readings have no 'xx'"),
        ("rangefinder", {"noise": {"x": 1}, "elevation": -1.0}, "its readings have no fields; give one number"),
        ("image", {"width": 0}, "image: width: must be >= 1 "),
        (["pose"], {}, r"walker has no sensor \['pose'\]; it has anatomy, pose"),
        ("image", {"height": 4097}, "image: height: must be <= 4096 "),
        ("image", {"width": 32.5}, r"image: width: must be a whole number \(got 32\.5\)"),
        ("depth", {"height": -1}, "depth: height: must be >= 1 "),
        ("depth", {"width": "wide"}, "depth: width: must be a number"),
        ("pose", {"part": []}, r"walker has no part \[\]; it has legs"),
        ("rangefinder", {"at": 3}, r"walker: a frame is named by text \(got 3\)"),
    ],
)
def test_wrong_readings_are_refused_with_a_reason(word: Any, options: dict[str, Any], message: str) -> None:
    _, body = walker_in()
    with pytest.raises(Actr3dError, match=message.replace("? ", r"\? ")):
        body.get(word, **options)
