"""What browsers are told of a scene beside its shapes: the stage, where shade lies, outlines; later browsers are told the newest."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import mujoco
import numpy as np
import pytest
from mujoco import MjData

from actr3d.actr import ACTR
from actr3d.simulation import Simulation
from actr3d.world import Aperture, Floor, Mannequin, Scene, SimpleObject, Wall
from actr3d.world.world import World
from workbench.backdrop import Outlines, Shades
from workbench.scene_framing import SceneFraming
from workbench.viser_server import send_scene_data, start_viser
from workbench.worker.simulation_display import SimulationDisplay


class Nothing(ACTR):
    """An agent that does nothing."""


def scene(*parts: Any) -> tuple[Any, MjData]:
    model: Any = World(Scene(parts=(Floor(), *parts))).mj_model
    data = MjData(model)
    mujoco.mj_forward(model, data)
    return model, data


def test_shade_lies_under_the_feet_and_along_a_wall_as_it_stands() -> None:
    model, data = scene(Mannequin(name="walker"), Wall(name="wall", start=(3, -2), end=(5, 0)))
    shades = Shades(model, 0.0).quads(data)
    wall = max(shades, key=lambda shade: max(shade[4:6]))
    assert wall[:2] == pytest.approx([4, -1], abs=1e-3)
    assert abs(wall[2] * math.cos(math.pi / 4) + wall[3] * math.sin(math.pi / 4)) == pytest.approx(1, abs=1e-3)
    assert sorted(wall[4:6]) == pytest.approx([0.05, math.sqrt(2)], abs=2e-3)
    feet = [shade for shade in shades if math.hypot(*shade[:2]) < 0.4 and shade[7] > 0.3]
    assert len(feet) >= 2
    assert all(max(foot[4:6]) < 0.2 for foot in feet)
    assert np.isfinite(shades).all()


def test_what_is_high_above_the_ground_or_below_it_casts_none() -> None:
    low, high = ((SimpleObject(name="box", position=(0, 0, z), mass=None),) for z in (0.15, 6.0))
    assert len(Shades(*_model_and_ground(*low)).quads(scene(*low)[1])) == 1
    assert Shades(*_model_and_ground(*high)).quads(scene(*high)[1]) == []
    bare = World(Scene(parts=(Floor(),))).mj_model
    assert Shades(bare, 0.0).quads(MjData(bare)) == []


def _model_and_ground(*parts: Any) -> tuple[Any, float]:
    return scene(*parts)[0], 0.0


def test_outlines_are_those_of_walls_and_go_with_them() -> None:
    model, data = scene(Mannequin(name="walker"), Aperture(width=0.6), SimpleObject(name="box"))
    lines: list[Any] = []
    outlines = Outlines(SimpleNamespace(), model)
    outlines._lines = SimpleNamespace(set=lines.append)  # pyright: ignore[reportAttributeAccessIssue]
    outlines.draw(data)
    assert lines[-1].shape == (24, 2, 3)  # two walls; neither limbs nor what can be pushed
    assert np.abs(lines[-1][..., 1]).min() == pytest.approx(0.3)
    data.mocap_pos[:, 1] *= 2
    mujoco.mj_forward(model, data)
    outlines.draw(data)
    assert np.abs(lines[-1][..., 1]).min() > 1


def test_the_stage_is_sent_with_the_middle_and_size_of_the_body() -> None:
    model, _ = scene(Mannequin(name="walker"), Aperture(width=0.6))
    told = SceneFraming(model).data(["/floor"])
    assert told["height"] == pytest.approx(1.75, abs=0.1)
    assert np.add(told["start"], told["middle"]) == pytest.approx([0, 0, 0.87], abs=0.1)
    assert told["ahead"] == pytest.approx([1, 0, 0], abs=0.01)
    crowd = [SimpleObject(name=f"box {n}", position=(n % 10 - 5, n // 10 - 5, 0.2)) for n in range(100)]
    assert len(SceneFraming(scene(Mannequin(name="walker"), *crowd)[0]).data([])["corners"]) == 8
    still = SceneFraming(scene(Wall(name="wall", start=(3, -2), end=(3, 2)))[0]).data(
        []
    )  # where nothing moves, the body is all that stands there
    assert still["height"] >= 4
    assert still["middle"] == pytest.approx([3, 0, 1.25], abs=0.1)
    nothing: Any = World(Scene(parts=(Floor(),))).mj_model
    assert np.isfinite(SceneFraming(nothing).data([])["corners"]).all()


def test_the_stage_is_that_of_the_agent_s_body_whatever_else_moves() -> None:
    parts = (Floor(), SimpleObject(name="box", position=(-3, 0, 0.2)), Mannequin(name="other", position=(-2, 0)), Mannequin(name="walker"))
    world = SimulationDisplay(Simulation(Scene(parts=parts), {"walker": Nothing})).world()
    model: Any = World(Scene(parts=parts)).mj_model
    told = SceneFraming(model, [world["bodies"][name]["root"] for name in world["agents"]]).data([])
    assert told["start"][:2] == pytest.approx([0, 0], abs=1e-6)
    assert told["height"] == pytest.approx(1.75, abs=0.1)
    assert not any("box" in name or "other" in name for name in told["own"])
    assert SceneFraming(model).data([])["start"][:2] == pytest.approx([-3, 0], abs=1e-6)  # without an agent, the first that moves


def test_only_the_newest_data_is_kept_for_late_clients() -> None:
    server = start_viser("secret")
    try:
        for number in range(5):
            send_scene_data(server, "now", {"text": f"</script>{number}"})
        send_scene_data(server, "stage", 1)
        buffer = server._websock_server._broadcast_buffer
        sources = [message.source for message in buffer.message_from_id.values() if hasattr(message, "source")]
        assert sources == ['scene.receive("now",{"text": "</script>4"})', 'scene.receive("stage",1)']
    finally:
        server.stop()
