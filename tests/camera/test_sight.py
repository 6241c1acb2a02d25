"""The word `view`: a body's eye sees its world, once a state, with labels that are part of the body's state."""

from __future__ import annotations

import math
import subprocess
import sys
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest

from actr3d.actr.loading import load_text
from actr3d.camera import CameraParameters, GeometricCamera, View
from actr3d.errors import Actr3dError, ConfigurationError
from actr3d.recording import Recorded
from actr3d.simulation import Simulation
from actr3d.world import Aperture, Floor, Mannequin, Scene, SimpleObject, World
from tests.helpers.small_agents import near
from tests.helpers.walkers import digest


def doorway() -> World:
    return World(
        Scene(
            parts=(
                Floor(),
                Aperture(width=0.8, position=(5.0, 0.0)),
                Mannequin(name="walker"),
                SimpleObject(name="box", position=(3, 1, 1)),
            )
        )
    )


def edges(view: View) -> list[float]:
    """Returns where the two walls of an aperture begin and end in the middle of the screen."""
    return [edge for extents in view.as_dict()[0.5].values() for extent in extents for edge in extent[:2]]


def test_the_eye_sees_the_gap_as_wide_as_it_projects() -> None:
    walker = doorway().bodies["walker"]
    view = walker.get("view", rows=1, horizontal_fov=1.0)
    left, gap, again, right = edges(view)
    eye = walker.physics.mj_data.site(walker.eye).xpos
    depth = 5.0 + 0.05 - eye[0]  # to the far ends of the inner faces, which narrow the gap
    half = 0.4 / (2 * depth * 0.5463024898437905)  # tan(0.5), half the width of the screen at 1 m
    assert (gap, again) == (near(0.5 - half, abs=1e-6), near(0.5 + half, abs=1e-6))
    assert left < gap < again < right


def test_a_view_is_of_the_present_and_looked_at_once() -> None:
    world = doorway()
    walker = world.bodies["walker"]
    first = walker.get("view", rows=1)
    assert walker.get("view", rows=1) is first
    world.set_aperture_width(1.2)
    assert edges(walker.get("view", rows=1)) != edges(first)
    walker.set("walk", 1.0)
    world.step(100)
    second = walker.get("view", rows=1)
    fresh = mujoco.MjData(world.mj_model)
    mujoco.mj_setState(world.mj_model, fresh, world.state().mj_state, mujoco.mjtState.mjSTATE_INTEGRATION)
    mujoco.mj_forward(world.mj_model, fresh)
    camera = GeometricCamera(world.mj_model, site=walker.eye, parameters=CameraParameters(rows=1))
    assert second.extents["x1"].tolist() == camera.look(fresh).extents["x1"].tolist()


def test_labels_are_part_of_the_state() -> None:
    world = doorway()
    walker = world.bodies["walker"]
    start = world.state()
    before = walker.get("view")
    known = world.state()
    world.restore(start)
    walker.set("teleport", 4, 0, 3.0)  # the other way: what is seen first now is another thing
    world.step(5)
    walker.get("view")
    world.restore(known)
    again = walker.get("view")
    assert again.extents.tobytes() == before.extents.tobytes()
    other = doorway()
    other.restore(known)
    assert other.state().bodies == known.bodies


def test_mismatches_are_reported() -> None:
    walker = doorway().bodies["walker"]
    wrong: list[tuple[dict[str, Any], str]] = [
        ({"row": 3}, "CameraParameters has no field 'row'; did you mean 'rows'"),
        ({"rows": 0}, r"CameraParameters\.rows: must be >= 1"),
        ({"background": ("flor",)}, "no geom 'flor'; did you mean 'floor'"),
        ({"noise": 0.1}, "its fields have different units; give them by name: {.d1.: 0.1}; fields: x1"),
        ({"noise": {"d3": 0.1}}, "no field 'd3'"),
        ({"noise": {1: 0.1}}, r"walker: noise of view: a field is named by text \(got 1\)"),
        ({"rows": "ten"}, r"CameraParameters\.rows: must be a whole number \(got 'ten'\)"),
    ]
    for options, message in wrong:
        with pytest.raises(Actr3dError, match=message):
            walker.get("view", **options)


def test_noise_of_a_view_is_seeded_and_leaves_the_view_alone() -> None:
    first, second = doorway().bodies["walker"], doorway().bodies["walker"]
    plain = first.get("view")
    noisy = first.get("view", noise={"d1": 0.05})
    assert noisy.extents["x1"].tolist() == plain.extents["x1"].tolist()
    assert noisy.extents["d1"].tolist() != plain.extents["d1"].tolist()
    assert noisy.extents.tobytes() == second.get("view", noise={"d1": 0.05}).extents.tobytes()
    assert first.get("view") is plain
    for sd in ("0.1", -0.1, math.nan, None):
        with pytest.raises(ConfigurationError, match=r"noise of view: d1: must be .* \(got "):
            plain.with_noise({"d1": sd}, np.random.default_rng(0))


@pytest.mark.slow
def test_importing_the_camera_registers_the_sensor_before_or_after_the_world_is_made() -> None:
    made = "from actr3d.world import Mannequin, Scene, World; body = World(Scene(parts=(Mannequin(),))).bodies['mannequin']"
    refused = "try:\n    body.get('view')\nexcept Exception as error:\n    print(error)"
    before, after = (f"import actr3d.simulation\n{made}", f"{made}\n{refused}\nimport actr3d.camera")
    for program, said in ((before, ""), (after, "mannequin has no sensor 'view'")):
        done = subprocess.run([sys.executable, "-c", f"{program}\nbody.get('view')"], check=True, capture_output=True, text=True)
        assert done.stdout.startswith(said)
        assert (done.stdout == "", done.stderr) == (said == "", "")


def test_numbers_may_come_as_text() -> None:
    first, second = doorway().bodies["walker"], doorway().bodies["walker"]
    plain = first.get("view", rows=7, range=5.5, noise={"d1": 0.05})
    noise: Any = {"d1": "0.05"}
    assert second.get("view", rows="7", range="5.5", noise=noise).extents.tobytes() == plain.extents.tobytes()
    assert second.get("view", rows=7, range=5.5) is second.get("view", rows="7", range="5.5")


SEEING: Any = load_text(
    """
from actr3d.actr import *
from actr3d.simulation import BodyPort

class Seeing(ACTR):
    goal = Buffer()
    seen = Buffer()
    body = BodyPort(seen)
    def init():
        self.widest = []
        body.set("walk", 1.0)
        goal.set("look")
    def look(goal="look"):
        body.request("view", rows=10)
        goal.set("see")
    def see(goal="see", seen="view"):
        view = self.seen.chunk["seen"]
        self.widest.append(len(view.extents))
        goal.set("look")
""",
    "seeing.py",
)


def seeing() -> Simulation:
    return Simulation(doorway().scene, {"walker": SEEING.Seeing}, seed=3, trace="all")


def test_an_agent_sees_through_its_port_also_after_going_back() -> None:
    simulation = seeing()
    simulation.step(150)
    first, seen = digest(simulation), list(simulation.agents["walker"].widest)
    assert len(seen) > 10
    assert min(seen) > 0
    simulation.seek(0.7)
    simulation.step(80)
    assert digest(simulation) == first
    assert simulation.agents["walker"].widest == seen


def test_a_recording_keeps_what_a_view_was_in_short(tmp_path: Path) -> None:
    simulation = seeing()
    recording = simulation.record(tmp_path / "run")
    simulation.step(60)
    recording.close()
    with Recorded(tmp_path / "run") as recorded:
        answers = [event for event in recorded.events() if event.kind == "answer"]
    assert answers
    assert all(set(event.data["value"]) == {"rows", "extents", "crc32"} for event in answers)


def test_a_change_of_the_compiled_model_is_seen_after_it_was_told() -> None:
    world = doorway()
    walker = world.bodies["walker"]
    seen = len(walker.get("view").as_array())
    world.mj_model.geom_rgba[:, 3] = 0
    world.changed()
    assert len(walker.get("view").as_array()) == 0 < seen


def test_noise_of_a_view_can_be_on_the_nearest_point_too() -> None:
    walker = doorway().bodies["walker"]
    exact = walker.get("view", rows=1).as_array()
    noisy = walker.get("view", rows=1, noise={"dn": 0.1, "xn": 0.01}).as_array()
    for name in exact.dtype.names or ():
        assert bool((exact[name] != noisy[name]).all()) == (name in ("dn", "xn"))
    assert [len(extent) for extents in walker.get("view", rows=1).as_dict()[0.5].values() for extent in extents] == [6] * len(exact)
