"""What is drawn over the 3D view: computed only when it is shown to somebody, true to the world, and switched for all at once."""

from __future__ import annotations

import math
import re
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import msgspec
import numpy as np
import pytest

from actr3d.camera import CameraParameters
from actr3d.simulation import Simulation
from actr3d.world import Car, Floor, Mannequin, Scene, Wall, World
from tests.helpers.sessions import Desk, Talk
from tests.simulation.test_observers import sensing
from tests.workbench.test_recorded_runs import APERTURE, agrees, ended, recording
from tests.workbench.test_reopened import reopened
from workbench.overlays import OVERLAYS, Observed, Overlay, OverlayCanvas, ViewSettings
from workbench.overlays.frustum import Frustum
from workbench.overlays.overlay import overlay
from workbench.page_commands import Question
from workbench.protocol import COMMAND
from workbench.worker.simulation_display import SimulationDisplay
from workbench.worker.state_history import NEAR, PathHistory

LOOKING = """from actr3d.actr import *
from actr3d.motor import Motor
from actr3d.simulation import Simulation
from actr3d.vision import Vision
from actr3d.world import Aperture, Floor, Mannequin, Scene

class Walker(ACTR):
    goal = Buffer()
    b_visual = Buffer()
    vision = Vision(b_visual, horizontal_fov=1.2, vertical_fov=0.9)
    motor = Motor()
    def init():
        goal.set("look")
    def look(goal="look"):
        vision.request("feature:opening height:>1")
        motor.rotate_torso(40, 60)
        motor.walk(0.5)
        goal.set("wait")
    def wait(goal="wait"):
        goal.set("wait")

def build() -> Simulation:
    parts = (Floor(), Mannequin(name="walker"), Aperture(width=0.6, position=(3.0, 0.2), heading=0.3))
    return Simulation(Scene(parts=parts), {"walker": Walker}, seed=1)
"""
ALL = tuple(name for name in OVERLAYS if name != "contacts")
MIDDLE, ACROSS = np.array((3.0, 0.2)), np.array((-math.sin(0.3), math.cos(0.3)))


def drawn(talk: Talk, tick: int, kinds: tuple[str, ...] = ALL) -> dict[str, Any]:
    """Returns what overlays are told of a tick."""
    talk.desk.do(draw(talk, kinds))

    def there() -> bool:
        state = talk.session.state
        return state is not None and state.tick == tick and set(state.overlay_data) == set(kinds)

    talk.wait(there)
    assert talk.session.state is not None
    return talk.session.state.overlay_data


async def draw(talk: Talk, kinds: tuple[str, ...]) -> None:
    """Asks for overlays in place of the 3D view, which asks for none where no browser shows it."""
    talk.sessions._views[talk.session.name]._task.cancel()
    talk.session.draw(kinds)


def after(desk: Desk, folder: Path, ticks: int) -> Talk:
    talk = desk.begin(folder, LOOKING)
    talk.say("step", ticks=ticks)
    talk.until("paused", tick=ticks)
    return talk


def test_an_overlay_and_a_question_read_noisy_senses_and_the_agent_senses_the_same(monkeypatch: pytest.MonkeyPatch) -> None:
    class Near(Overlay):
        @staticmethod
        def data(observed: Observed) -> dict[str, Any]:
            return {name: body.get("rangefinder", noise=0.05) for name, body in observed.simulation.world.bodies.items()}

    class HowFar(Question):
        def answer(self, run: Any) -> Any:
            return run.shown.simulation.world.bodies["walker"].get("rangefinder", noise=0.05)

    monkeypatch.setitem(OVERLAYS, "near", Near)
    alone, shown = sensing(), SimulationDisplay(sensing())
    controller: Any = SimpleNamespace(run=SimpleNamespace(shown=shown))
    for _ in range(200):
        alone.advance(1)
        shown.simulation.advance(1)
        assert isinstance(shown.overlay_data(("near",))["near"]["walker"], float)
        assert isinstance(HowFar().carry_out(controller), float)
    once, again = ([event.to_json() for event in run.trace or ()] for run in (alone, shown.simulation))
    assert again == once


def test_only_requested_overlays_are_sent(desk: Desk, tmp_path: Path) -> None:
    talk = after(desk, tmp_path, 5)
    assert talk.session.state is not None
    assert talk.session.state.overlay_data == {}
    assert set(drawn(talk, 5, ("path",))) == {"path"}
    assert drawn(talk, 5, ()) == {}


def test_the_field_of_view_is_that_of_the_camera_from_the_start_on(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, LOOKING)
    assert drawn(talk, 0, ("frustum",)) == {"frustum": {"walker": [1.2, 0.9]}}
    talk.say("step", ticks=20)
    talk.until("paused", tick=20)
    assert drawn(talk, 20, ("frustum",)) == {"frustum": {"walker": [1.2, 0.9]}}


def test_edges_lie_on_what_is_seen(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, LOOKING)
    told = drawn(talk, 0, ("edges",))["edges"]["walker"]
    lines = np.frombuffer(told, dtype=np.float32).reshape(-1, 2, 3)
    assert len(lines) > 100
    along = (lines[..., :2] - MIDDLE) @ ACROSS
    before = (lines[..., :2] - MIDDLE) @ np.array((math.cos(0.3), math.sin(0.3)))
    assert np.abs(before).max() < 0.05 + 0.005 * 6  # the wall is 10 cm thick, and they are drawn a little before it
    at_gap = np.abs(np.abs(along) - 0.3) < 0.02
    assert at_gap.mean() > 0.3  # the sides of the gap; what else there is are the ends of the wall, its top and its bottom
    assert not (np.abs(along) < 0.27).any()
    assert lines[..., 2].max() < 2.5
    assert {bool(side) for side in (along > 0).flat} == {False, True}


def test_openings_are_shown_where_they_are_with_their_width(desk: Desk, tmp_path: Path) -> None:
    talk = after(desk, tmp_path, 60)  # it has walked on since it looked
    (found,) = drawn(talk, 60, ("features",))["features"]["walker"]
    assert found["chosen"] is True
    assert found["text"] == "opening 60 cm"
    across = np.array(found["lines"][0])
    for end, side in zip(across, (1, -1), strict=True):
        assert end[:2] @ ACROSS == pytest.approx((MIDDLE + side * 0.3 * ACROSS) @ ACROSS, abs=0.01)
        assert (end[:2] - MIDDLE) @ np.array((math.cos(0.3), math.sin(0.3))) == pytest.approx(-0.05, abs=0.11)
    upright = np.array(found["lines"][1])
    assert upright[0, :2] == pytest.approx(upright[1, :2])
    assert upright[1, 2] - upright[0, 2] > 1
    talk.say("step", ticks=120)
    talk.until("paused", tick=180)
    (old,) = drawn(talk, 180, ("features",))["features"]["walker"]
    assert re.fullmatch(r"opening 60 cm, seen at 0\.\d\d s", old["text"])


def test_the_path_is_sent_to_late_clients_and_after_going_back(desk: Desk, tmp_path: Path) -> None:
    talk = after(desk, tmp_path, 200)
    (way,) = map(np.array, drawn(talk, 200, ("path",))["path"]["walker"])
    assert way[0] == pytest.approx((0, 0))
    assert way[-1, 0] == pytest.approx(0.5 * 1.95, abs=0.03)
    assert (np.diff(way[:, 0]) >= 0).all()
    assert len(way) > 30
    talk.say("seek", time=1.0)
    talk.until("paused", tick=100)
    (back,) = map(np.array, drawn(talk, 100, ("path",))["path"]["walker"])
    assert len(back) < len(way)
    assert back[-1, 0] == pytest.approx(0.5 * 0.95, abs=0.03)
    talk.say("command", word="walk", values=[-0.5], drop=True)
    talk.say("step", ticks=100)
    talk.until("paused", tick=200)
    (other,) = map(np.array, drawn(talk, 200, ("path",))["path"]["walker"])
    assert other[:, 0].max() == pytest.approx(back[-1, 0], abs=0.02)
    assert other[-1, 0] < back[-1, 0] - 0.03


def test_the_path_of_an_opened_recording_is_known_at_its_end_at_once(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, LOOKING, record=True)
    talk.say("step", ticks=100)
    talk.until("paused", tick=100)
    way = drawn(talk, 100, ("path",))["path"]
    again = reopened(talk)
    drawn(again, 0, ("path",))
    again.say("seek", time=1.0)
    again.until("paused", tick=100)
    assert drawn(again, 100, ("path",))["path"] == way


def test_a_path_has_a_gap_where_a_body_was_moved_by_hand(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, LOOKING, record=True)
    talk.say("step", ticks=102)
    talk.until("paused", tick=102)
    (before,) = drawn(talk, 102, ("path",))["path"]["walker"]
    talk.say("command", word="move", values=["walker", 0.5, -1.0, 0.0])
    talk.say("step", ticks=58)
    talk.until("paused", tick=160)
    way = drawn(talk, 160, ("path",))["path"]["walker"]
    assert way[0] == before[:-1]  # that at 1.02 s has no point of its own later
    assert way[1][0] == pytest.approx((0.5, -1.0), abs=0.05)
    assert way[1][-1] == pytest.approx((0.5 + 0.5 * 0.58, -1.0), abs=0.05)
    assert len(way) == 2
    talk.say("seek", time=1.0)
    talk.until("paused", tick=100)
    assert drawn(talk, 100, ("path",))["path"]["walker"] == way[:1]
    talk.say("seek", time=1.03)
    talk.until("paused", tick=103)
    first, here = drawn(talk, 103, ("path",))["path"]["walker"]
    assert (first, here) == (way[0], [pytest.approx((0.5, -1.0), abs=0.05)])
    talk.say("seek", time=1.6)
    talk.until("paused", tick=160)
    again = reopened(talk)
    drawn(again, 0, ("path",))
    again.say("seek", time=1.6)
    again.until("paused", tick=160)
    assert drawn(again, 160, ("path",))["path"]["walker"] == way
    again.say("undo")
    again.until("paused", tick=102)
    again.say("step", ticks=58)
    again.until("paused", tick=160)
    (whole,) = drawn(again, 160, ("path",))["path"]["walker"]
    assert whole[: len(way[0])] == way[0]


def test_the_path_of_a_fast_body_has_no_gap_even_where_it_is_stopped() -> None:
    parts = (Floor(), Car(name="car"), Wall(name="wall", start=(40, -5), end=(40, 5)))
    world = World(Scene(parts=parts))
    car, walked, steps = world.bodies["car"], PathHistory(10_000), round(0.01 / world.scene.timestep)
    walked.keep(0, world)
    car.set("throttle", 1.0)
    for tick in range(1, 1001):
        world.step(steps)
        walked.keep(tick, world)
    ((*way,),) = walked.up_to(1000, world)["car"]
    lengths = np.hypot(*np.diff(way, axis=0).T)
    assert lengths.max() > 4 * NEAR
    assert way[-1][0] < 40
    world.move("car", 10.0, 1.0)
    for tick in range(1001, 1011):
        world.step(steps)
        walked.keep(tick, world)
    first, second = walked.up_to(1010, world)["car"]
    assert first == way
    assert second[0] == pytest.approx((10.0, 1.0), abs=1)


def test_the_commanded_posture_is_what_is_commanded_until_it_is_there(desk: Desk, tmp_path: Path) -> None:
    talk = after(desk, tmp_path, 20)
    ((place, target),) = drawn(talk, 20, ("posture",))["posture"]["walker"]
    assert target == pytest.approx(math.radians(40))
    talk.say("step", ticks=80)
    talk.until("paused", tick=100)
    assert drawn(talk, 100, ("posture",))["posture"]["walker"] == []
    told = talk.say("curves", names=["walker_torso_yaw"], first=1.0)
    assert told["curves"]["walker_torso_yaw"][-1] == pytest.approx(40, abs=0.5)
    assert place > 0


PLANNING = LOOKING.replace(
    "    def wait(",
    """    def planned(self):
        angle = 90 * (1 - self.now())
        return Plan(posture={"torso_yaw": angle, "tail": 1}, text=f"turn by {angle:.0f}") if angle > 0 else None if angle > -9 else 1 / 0
    def wait(""",
).replace("import Motor", "import Motor, Plan")


def test_what_an_agent_plans_is_a_posture_and_a_label_above_its_body(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, PLANNING)
    talk.say("step", ticks=50)
    talk.until("paused", tick=50)
    plan = drawn(talk, 50, ("plan",))["plan"]["walker"]
    ((place, target),) = plan["targets"]
    assert target == pytest.approx(math.radians(45))
    assert plan["text"] == "turn by 45"
    assert plan["place"][2] > 1.7
    assert place > 0
    talk.say("step", ticks=55)
    talk.until("paused", tick=105)
    assert drawn(talk, 105, ("plan",)) == {"plan": {}}
    talk.say("step", ticks=10)
    talk.until("paused", tick=115)
    assert drawn(talk, 115, ("plan",))["plan"]["walker"]["text"] == "planned(): ZeroDivisionError: division by zero"


@pytest.mark.slow
def test_who_looks_changes_nothing(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, APERTURE, record=True, settings={"aperture": 0.45})
    desk.do(draw(talk, ALL))
    ended(talk)
    assert set(drawn(talk, talk.state["tick"])) == set(ALL)
    assert agrees(recording(desk, talk))


def test_a_new_run_sends_the_overlays_that_are_already_shown(desk: Desk, tmp_path: Path) -> None:
    talk = after(desk, tmp_path, 5)
    drawn(talk, 5, ("path",))
    talk.say("restart")
    talk.wait(lambda: talk.session.run == 2 and talk.session.state is not None and "path" in talk.session.state.overlay_data)


def test_who_looks_switches_for_all_and_takes_no_control(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, LOOKING)

    def shown() -> dict[str, bool]:
        return {one["name"]: one["shown"] for one in talk.facts["overlays"]}

    assert set(shown()) == {*ALL, "contacts"}
    before = shown()
    talk.say("overlay", name="edges", shown=True)
    talk.say("overlay", name="path", shown=False)
    assert shown() == {**before, "edges": True, "path": False}
    assert talk.facts["controlled_by"] == ""
    talk.say("restart")
    talk.wait(lambda: talk.session.run == 2)
    assert shown()["edges"] is True
    with pytest.raises(ValueError, match="name"):
        talk.say("overlay", name="sky", shown=True)


@pytest.mark.parametrize("kind", OVERLAYS.values(), ids=list(OVERLAYS))
def test_each_overlay_has_a_title_and_data_of_any_body_in_plain_values(kind: type[Overlay]) -> None:
    assert kind.__doc__
    assert kind.title
    simulation = Simulation(Scene(parts=(Floor(), Car(name="car"))), {}, seed=1)

    def eyesight(body: str) -> CameraParameters:
        assert body == "car"
        return CameraParameters()

    observed = Observed(simulation, eyesight, dict)
    data = kind.data(observed)
    assert data.keys() <= {"car"}
    assert msgspec.msgpack.decode(msgspec.msgpack.encode(data)) == data


def test_a_new_overlay_is_one_class_and_is_known_everywhere() -> None:
    command = {"type": "overlay", "name": "heights", "shown": True}
    with pytest.raises(ValueError, match="there is no overlay of this name; there are: contacts, edges"):
        COMMAND.validate_python(command)
    try:

        @overlay("heights", "heights of bodies", shown=True)
        class _Heights(Overlay):  # pyright: ignore[reportUnusedClass]
            """Shows how high bodies are."""

            def __init__(self, canvas: OverlayCanvas) -> None: ...

            @staticmethod
            def data(observed: Observed) -> dict[str, Any]:
                """Returns the height of each body [m]."""
                return {name: body.get("pose").z for name, body in observed.simulation.world.bodies.items()}

            def draw(self, data: Any, by_body: Any) -> None: ...

            def switch(self) -> None: ...

        assert COMMAND.validate_python(command).model_dump() == command
        assert ViewSettings().as_dict()["overlays"][-1] == {"name": "heights", "title": "heights of bodies", "shown": True}
    finally:
        del OVERLAYS["heights"]


def test_labels_keep_clear_of_the_head_and_not_only_of_the_eye() -> None:
    world = World(Scene(parts=(Floor(), Mannequin(name="walker"))))
    drawn = OverlayCanvas(
        None, None, world.mj_model, {"agents": ["walker"], "bodies": {"walker": {"eye": world.bodies["walker"].eye}}}, print
    )
    ((x, y, z, radius),) = Frustum(drawn).heads(world.mj_data)
    head = world.mj_model.geom("walker_head").id
    assert [x, y, z] == pytest.approx(world.mj_data.geom_xpos[head], abs=1e-3)
    assert radius == pytest.approx(world.mj_model.geom_rbound[head], abs=1e-3)
