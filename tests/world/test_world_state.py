"""The state of a world is complete: restoring it restores everything in the world that can change."""

from __future__ import annotations

import copy
from typing import Any, cast

import numpy as np
import pytest

import actr3d.camera  # pyright: ignore[reportUnusedImport] # noqa: F401 - it gives bodies the word `view`
from actr3d.errors import WorldError
from actr3d.world import Aperture, Car, Floor, ImportedBody, Mannequin, Scene, SimpleObject, World
from actr3d.world.body import ACTUATORS, SENSORS
from tests.helpers.copies import COPIED
from tests.helpers.object_contents import picture

ARM = """<mujoco>
  <worldbody><body name="stand" pos="0 0 1"><geom size="0.1"/>
    <body name="arm"><joint name="elbow" axis="0 0 1" damping="10" range="-60 60" limited="true"/>
      <geom type="capsule" fromto="0 0 0 0.5 0 0" size="0.05"/></body>
  </body></worldbody>
  <actuator><position name="turn" joint="elbow" kp="50"/></actuator>
</mujoco>"""

DERIVED = {
    ("Physics", "state_number"),  # counts states, so that readings of an earlier one are known to be stale
    ("Physics", "_updated"),  # whether MuJoCo's derived numbers are up to date
    ("Physics", "_scratch"),
    ("Physics", "_numbers"),  # scratch memory
    ("Physics", "renderer"),  # draws pictures of the state
    ("ModelChanges", "_image"),
    ("ModelChanges", "_original"),  # created when first needed, and always the same
    ("Body", "_senses"),  # all sensors that were ever created; those in use are in the state
    ("_Shapes", "_sizes"),
    ("_Shapes", "_formula"),  # computed again where sizes have changed
}
"""Attributes that need not be saved: they follow from the state, or are never read again. A new attribute that changes must
be added to `state()` and `restore()`, or here with a reason."""

COMMANDS: dict[str, list[tuple[str, tuple[Any, ...]]]] = {
    "walk": [("walker", (0.4, 0.2))],
    "heading": [("walker", (0.6,))],
    "turn": [("walker", (-0.5,))],
    "waypoint": [("walker", (1.0, 0.3, 0.8))],
    "stop": [("walker", ())],
    "joint": [("walker", ("torso_yaw", 0.7)), ("car", ("steer", 0.1))],
    "position": [("walker", ("head_yaw", 0.4))],
    "posture": [("walker", ({"left_upper_arm_pitch": -0.9, "torso_yaw": 0.2},))],
    "steering": [("car", (2.0,))],
    "throttle": [("car", (0.6,))],
    "brake": [("car", (0.3,))],
    "teleport": [("walker", (0.2, 0.1, 0.3)), ("car", (-9.0, 3.0, 0.5))],
    "gaze": [("walker", (0.3, 0.1))],
    "saccade": [("walker", (-0.1, 0.2))],
    "grasp": [("walker", ("ball", "right"))],
    "release": [("walker", ("right",))],
    "control": [("arm", ("turn", 0.5))],
}
"""Commands of bodies with their values; any other command gets numbers."""
READINGS: dict[str, list[tuple[str, dict[str, Any]]]] = {
    "view": [("walker", {}), ("walker", {"horizontal_fov": 1.0, "rows": 9}), ("car", {"rows": 5})],
    "contacts": [("walker", {}), ("arm", {})],
    **{word: [("walker", {"noise": 0.01})] for word in ("joints", "gyroscope", "pose", "rangefinder", "accelerometer")},
}
"""Requests with values; each sensor is also read without values. Some of these requests change the body."""
PICTURES = {"image", "depth"}
"""They need EGL, and change nothing but the renderer."""


def numbers_for(command: str) -> tuple[float, ...]:
    return tuple(0.3 for value in ACTUATORS[command].takes.split(", ") if value and "=" not in value)


def world() -> World:
    walker = Mannequin(name="walker", noise=(("velocity", 0.01),))
    ball = SimpleObject(name="ball", size=(0.05, 0.05, 0.2), position=(0.0, -0.24, 0.66), mass=0.2)  # beside the right hand
    parts = (Floor(), walker, Car(position=(-9.0, 3.0)), ImportedBody(name="arm", text=ARM, position=(0.0, 4.0, 0.0)))
    return World(Scene(parts=(*parts, ball, Aperture(width=0.9, position=(2.5, 0.0)))), seed=3)


def test_a_state_holds_all_that_any_command_and_any_reading_changes() -> None:
    there = world()
    rng = np.random.default_rng(1)
    acts: list[tuple[str, str, Any]] = [(name, word, values) for word, each in COMMANDS.items() for name, values in each]
    for name, body in there.bodies.items():
        acts += [(name, word, numbers_for(word)) for word in body.actuators if word not in COMMANDS]
    assert {word for _, word, _ in acts} == ACTUATORS.keys()
    acts += [(name, word, options) for word, each in READINGS.items() for name, options in each]
    acts += [(name, word, {}) for name, body in there.bodies.items() for word in body.sensors if word not in PICTURES]
    assert {word for _, word, options in acts if isinstance(options, dict)} == SENSORS.keys() - PICTURES
    start = there.state(), picture(there, DERIVED)
    there.bodies["walker"].set("grasp", "ball", "right")
    assert there.bodies["walker"].hands["right"].held is not None
    kept: list[tuple[Any, dict[str, Any]]] = [start, (there.state(), picture(there, DERIVED))]
    for number, act in enumerate(cast("list[int]", rng.permutation(len(acts)).tolist())):
        name, word, values = acts[act]
        if isinstance(values, dict):
            there.bodies[name].get(word, **cast("dict[str, Any]", values))
        else:
            there.bodies[name].set(word, *values)
        if word == "stop":
            there.set_aperture_width(0.7)
        there.step(2)
        if number % 6 == 0:
            kept.append((there.state(), picture(there, DERIVED)))
    for number in (0, *rng.permutation(len(kept)).tolist()):
        state, before = kept[number]
        there.restore(state)
        assert differences(before, picture(there, DERIVED)) == {}, f"after restoring state {number}"
        assert differences(picture(state, ()), picture(there.state(), ())) == {}


def test_changes_of_the_compiled_scene_by_a_program_are_part_of_the_state() -> None:
    there = world()
    start = there.state()
    model: Any = there.mj_model
    model.opt.gravity[2] = -3.0
    model.opt.density = 1.5
    model.geom_rgba[0] = (1, 0, 0, 1)
    changed = there.state()
    there.restore(start)
    assert model.opt.gravity[2] == pytest.approx(-9.81)
    assert model.opt.density == 0
    assert there.state().compiled == ()
    there.restore(changed)
    assert [name for name, _ in there.state().compiled] == ["geom_rgba", "opt.density", "opt.gravity"]
    assert (model.opt.gravity[2], model.opt.density, model.geom_rgba[0].tolist()) == (-3.0, 1.5, [1, 0, 0, 1])


def test_a_new_attribute_that_no_state_holds_is_found() -> None:
    there = world()
    state, before = there.state(), picture(there, DERIVED)
    there.bodies["walker"].motion.__dict__["patience"] = 3
    there.restore(state)
    assert differences(before, picture(there, DERIVED)) == {"World.bodies.[walker].motion.patience": (None, "3")}


def test_a_state_of_another_scene_is_refused() -> None:
    with pytest.raises(WorldError, match="another scene"):
        world().restore(World(Scene(parts=(Floor(),))).state())


def differences(before: dict[str, Any], after: dict[str, Any]) -> dict[str, Any]:
    return {path: (before.get(path), after.get(path)) for path in before.keys() | after.keys() if before.get(path) != after.get(path)}


def test_states_are_compared_and_hashed_as_the_objects_that_they_are() -> None:
    world = World(Scene(parts=(Floor(), Mannequin(name="walker"))))
    one, other = world.state(), world.state()
    assert one == one
    assert one != other
    assert len({one, other}) == 2


@pytest.mark.parametrize("copied", COPIED)
def test_a_copy_of_a_world_continues_as_the_world_does_and_does_not_move_it(copied: Any) -> None:
    world = World(Scene(parts=(Floor(), Aperture(position=(9, 0), width=0.8), Mannequin(name="walker"))), seed=1)
    world.set_aperture_width(1.1)
    world.bodies["walker"].set("walk", 1.3)
    world.step(500)
    before = world.state_bytes()
    other = copied(world)
    other.step(500)
    assert world.state_bytes() == before
    world.step(500)
    assert other.state_bytes() == world.state_bytes()
    walker, double = world.bodies["walker"], other.bodies["walker"]
    assert double.bounding_box() == walker.bounding_box()
    assert double.get("pose", noise=0.1) == walker.get("pose", noise=0.1)
    assert double.get("view").as_dict() == walker.get("view").as_dict()
    with pytest.raises(TypeError, match="cannot be copied alone; copy the World"):
        copy.deepcopy(walker)
