"""The replay of a recording as one HTML file: what is in it, how large it gets, and that nothing in it can run or load anything."""

from __future__ import annotations

import base64
import json
import re
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pytest

from actr3d.actr import ACTR, Buffer
from actr3d.errors import RecordingError
from actr3d.recording import Recorded, Recording
from actr3d.runner.facts import program_facts
from actr3d.simulation import Simulation
from actr3d.trace import Trace
from actr3d.world import Floor, Mannequin, Scene, SimpleObject
from tests.helpers.paths import MODELS
from tests.helpers.sessions import Desk
from tests.workbench.overlays.test_overlays import LOOKING
from tests.workbench.test_recorded_runs import recording
from workbench.html_replay import make, shapes
from workbench.html_replay.make import write_replay
from workbench.readers import Readers, ReadingError
from workbench.worker import state_history

EVIL = "</script><img src=x onerror=alert(1)><!--"
PRINTS = f"from actr3d.actr import *\nprint('''{EVIL}''')\n"


class Waiting(ACTR):
    """An agent that only waits."""

    goal = Buffer()

    def init(self) -> None:
        self.goal.set("wait")

    def wait(self, goal: str = "wait") -> None:
        self.goal.set("wait")


def inside(page: str) -> Any:
    """Returns the data of a replay."""
    found = re.search(r'<script type="application/json" id="data">(.*?)</script>', page, re.DOTALL)
    assert found is not None
    return json.loads(found[1])


def numbers(text: str) -> Any:
    return np.frombuffer(base64.b64decode(text), dtype="<f4")


@pytest.fixture
def walked(desk: Desk, tmp_path: Path) -> Path:
    """A recording of 1 s."""
    talk = desk.begin(tmp_path, LOOKING, record=True)
    talk.say("step", ticks=100)
    talk.until("paused", tick=100)
    return recording(desk, talk)


def test_scene_and_trace_are_those_of_the_recording(walked: Path, tmp_path: Path) -> None:
    write_replay(walked, tmp_path / "replay.html")
    told = inside((tmp_path / "replay.html").read_text(encoding="utf-8"))
    with Recorded(walked) as recorded:
        assert [row[:3] for row in told["events"]["rows"]] == [[event.time, event.source, event.kind] for event in recorded.events()]
    assert [row[3] for row in told["events"]["rows"] if row[2] == "fire"][:2] == ["look", "wait"]
    (scene,) = told["scenes"]
    times, poses = numbers(scene["times"]), numbers(scene["poses"]).reshape(-1, len(scene["shapes"]), 7)
    assert (times[0], times[-1]) == (0, 1)
    assert 25 <= len(times) <= 40
    assert len(poses) == len(times)
    root = poses[:, scene["stage"]["follow"], :2]
    assert root[-1, 0] - root[0, 0] == pytest.approx(0.5 * 0.95, abs=0.03)
    assert scene["grounds"] == [0]
    corners = np.array(scene["stage"]["corners"])
    assert corners.min(axis=0) == pytest.approx(scene["stage"]["low"], abs=1e-3)
    assert corners.max(axis=0) == pytest.approx(scene["stage"]["high"], abs=1e-3)
    assert len(json.dumps(scene["shapes"])) < 10_000  # the page makes the triangles
    told_of = {row[3] for row in told["events"]["rows"] if row[2] == "buffer"}
    assert "empty" in told_of
    assert not any("{" in text for text in told_of)  # chunks stand there as modellers write them


def test_titles_texts_and_the_kinds_that_are_shown_at_first_are_those_of_the_registry(walked: Path, tmp_path: Path) -> None:
    write_replay(walked, tmp_path / "replay.html")
    events = inside((tmp_path / "replay.html").read_text(encoding="utf-8"))["events"]
    assert events["kinds"].keys() == {row[2] for row in events["rows"]}
    assert [events["kinds"][kind] for kind in ("fire", "select", "state")] == [["fires", True], ["chosen", False], ["state", False]]
    assert [row[3] for row in events["rows"] if row[2] == "select"][:2] == ["look", "wait"]


def test_a_branch_says_so_and_its_changes_are_in_words(tmp_path: Path) -> None:
    trace = Trace("all")
    with Recording(tmp_path / "run.sqlite", program_facts("door.py", "", 1, None)) as recorded:
        trace.listen(recorded.event_alone)
        named = {"name": "aperture", "width": 1.2}
        trace.emit(0, "top", "command", {"command": "aperture", "data": {"values": [], "named": named, "body": None}})
        trace.emit(0, "top", "command", {"command": "walk", "data": {"values": [0.5], "named": {}, "body": "walker"}})
        trace.emit(0, "top", "command", {"command": "pause", "data": {}})
        trace.emit(0, "walker.b_plan", "planning_unit", {"name": "pass_doorway", "what": "begun", "path": ["pass_doorway"]})
        recorded.fact("branched", 2.0)
    write_replay(tmp_path / "run.sqlite", tmp_path / "replay.html")
    told = inside((tmp_path / "replay.html").read_text(encoding="utf-8"))
    assert (told["title"], told["branched"]) == ("door.py · seed 1 · branch at 2.00 s", 2.0)
    texts = ["aperture 120 cm", "walk walker 0.5", "pause", "pass_doorway begun"]
    assert [row[3] for row in told["events"]["rows"]] == texts


def test_times_from_an_hour_on_have_the_form_that_the_page_gives_them(tmp_path: Path) -> None:
    with Recording(tmp_path / "run.sqlite", program_facts("long.py", "", 1, None)) as recorded:
        recorded.fact("branched", 4512.3)
    write_replay(tmp_path / "run.sqlite", tmp_path / "replay.html")
    assert inside((tmp_path / "replay.html").read_text(encoding="utf-8"))["title"] == "long.py · seed 1 · branch at 1:15:12.30"


def test_changes_by_hand_have_the_words_of_the_timeline(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, (MODELS / "doorway.py").read_text(encoding="utf-8"), record=True)
    talk.say("step", ticks=2)
    talk.until("paused", tick=2)
    for word, values, named in (
        ("aperture", [0.9], {}),
        ("aperture", [], {"width": 0.755}),
        ("move", [], {"object": "walker", "x": 1.0, "y": 0.5}),
        ("set_buffer", [], {"buffer": "walker.goal", "chunk": "task:rest"}),
        ("set_buffer", [], {"buffer": "walker.goal", "chunk": "task:walk"}),
        ("clear_buffer", [], {"buffer": "walker.goal"}),
        ("forbid_once", [], {"system": "walker", "production": "turn"}),
    ):
        talk.say("command", word=word, values=values, named=named)
    talk.say("step", ticks=1)
    talk.until("paused", tick=3)
    write_replay(recording(desk, talk), tmp_path / "replay.html")
    rows = inside((tmp_path / "replay.html").read_text(encoding="utf-8"))["events"]["rows"]
    assert [row[3] for row in rows if row[2] == "command"] == [
        "aperture 50 -> 90 cm",
        "aperture 90 -> 75.5 cm",
        "move walker to (1, 0.5) m",
        "set buffer walker.goal approach -> task:rest",
        "set buffer walker.goal task:rest -> task:walk",
        "clear buffer walker.goal task:walk -> empty",
        "forbid once turn",
    ]


def test_an_event_of_an_unregistered_kind_is_shown_with_its_data(tmp_path: Path) -> None:
    trace = Trace("all")
    with Recording(tmp_path / "run.sqlite", program_facts("honk.py", "", 1, None)) as recorded:
        trace.listen(recorded.event_alone)
        trace.emit(0, "horn", "honk", {"loud": 0.123456, "long": None})
    write_replay(tmp_path / "run.sqlite", tmp_path / "replay.html")
    events = inside((tmp_path / "replay.html").read_text(encoding="utf-8"))["events"]
    assert events["kinds"] == {"honk": ["honk", True]}
    assert events["rows"] == [[0, "horn", "honk", "loud=0.1235  long=none"]]


def followed(folder: Path, parts: Sequence[Any], *agents: str) -> Any:
    """Returns where the shape is that the view of a replay follows, x and y [m]."""
    simulation = Simulation(Scene(parts=(Floor(), *parts)), dict.fromkeys(agents, Waiting), seed=1)
    simulation.traced()
    with simulation.record(folder / "run.sqlite"):
        simulation.run(0.05)
    write_replay(folder / "run.sqlite", folder / "replay.html")
    (scene,) = inside((folder / "replay.html").read_text(encoding="utf-8"))["scenes"]
    return numbers(scene["poses"]).reshape(-1, len(scene["shapes"]), 7)[0, scene["stage"]["follow"], :2]


def test_the_view_follows_the_agent_s_body_whatever_else_moves(tmp_path: Path) -> None:
    parts = SimpleObject(name="box", position=(-3, 0, 0.2)), Mannequin(name="walker")
    assert followed(tmp_path, parts, "walker") == pytest.approx([0, 0], abs=0.05)


@pytest.mark.parametrize("shown", [0, make.MAX_EVENTS])
def test_the_view_follows_the_first_agent_of_the_model_as_the_live_view_does(
    shown: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(make, "MAX_EVENTS", shown)
    parts = Mannequin(name="first", position=(0, 2)), Mannequin(name="second", position=(0, -2))
    assert followed(tmp_path, parts, "second", "first") == pytest.approx([0, -2], abs=0.05)


@pytest.mark.parametrize(("parts", "scenes"), [((Floor(),), [0]), ((), [])], ids=["floor", "nothing"])
def test_a_world_without_bodies_has_no_shapes(parts: tuple[Any, ...], scenes: list[int], tmp_path: Path) -> None:
    simulation = Simulation(Scene(parts=parts), bodiless={"waiting": Waiting}, seed=1)
    simulation.traced()
    with simulation.record(tmp_path / "run.sqlite"):
        simulation.run(0.05)
    write_replay(tmp_path / "run.sqlite", tmp_path / "replay.html")
    told = inside((tmp_path / "replay.html").read_text(encoding="utf-8"))
    assert [len(scene["shapes"]) for scene in told["scenes"]] == scenes


ZOO = """
<mujoco>
  <asset>
    <texture name="checks" type="2d" builtin="checker" rgb1="1 0 0" rgb2="0 0 1" width="8" height="8"/>
    <material name="checked" texture="checks"/>
    <mesh name="wedge" vertex="0 0 0 1 0 0 0 1 0 0 0 1"/>
    <hfield name="hill" nrow="3" ncol="4" size="1 2 0.5 0.1" elevation="0 0 0 0  0 1 1 0  0 0 0 0"/>
  </asset>
  <worldbody>
    <geom type="plane" size="5 5 0.1"/>
    <geom type="hfield" hfield="hill"/>
    <body pos="0 0 1">
      <freejoint/>
      <geom type="sphere" size="0.3" pos="0.1 0.2 0.3"/>
      <geom type="capsule" size="0.1 0.5" euler="30 40 50"/>
      <geom type="ellipsoid" size="0.1 0.2 0.4" pos="1 0 0" euler="10 20 30"/>
      <geom type="cylinder" size="0.2 0.4" pos="0 1 0" euler="70 0 0"/>
      <geom type="box" size="0.1 0.2 0.3" pos="-1 0 0" euler="0 0 45" material="checked"/>
      <geom type="mesh" mesh="wedge" pos="0 0 1" rgba="1 1 0 0.5"/>
      <geom type="mesh" mesh="wedge" rgba="1 1 0 0"/>
    </body>
    <body><geom type="mesh" mesh="wedge"/></body>
  </worldbody>
</mujoco>
"""
"""One of each kind of shape; the browser's tests draw it, too."""


def test_each_kind_of_shape_is_included_and_a_mesh_once() -> None:
    told = shapes.Shapes(mujoco.MjModel.from_xml_string(ZOO))
    assert told.bodies == [0, 1, 2]
    kinds = [[part["kind"] for part in parts] for parts in told.parts]
    assert kinds == [["mesh"], ["sphere", "capsule", "ellipsoid", "cylinder", "box", "mesh"], ["mesh"]]
    assert [parts[-1]["mesh"] for parts in told.parts] == [0, 1, 1]
    assert len(told.meshes) == 2
    hill = numbers(told.meshes[0]["places"]).reshape(-1, 3)
    assert (hill.min(axis=0).tolist(), hill.max(axis=0).tolist()) == ([-1, -2, 0], [1, 2, 0.5])
    assert [part["size"] for part in told.parts[1][:5]] == [[0.3], [0.1, 0.5], [0.1, 0.2, 0.4], [0.2, 0.4], [0.1, 0.2, 0.3]]
    assert told.parts[1][4]["colour"] == [127, 0, 127, 255]  # of a texture the mean
    assert told.parts[1][5]["colour"] == [255, 255, 0, 127]


def test_nothing_is_loaded_and_nothing_a_model_says_is_run(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, PRINTS, name="x.py", record=True)
    talk.say("run")
    talk.until("ended")
    write_replay(recording(desk, talk), tmp_path / "replay.html")
    page = (tmp_path / "replay.html").read_text(encoding="utf-8")
    assert EVIL not in page
    assert [row[3] for row in inside(page)["events"]["rows"] if row[2] == "output"] == [EVIL]
    assert inside(page)["scenes"] == []
    assert "default-src 'none'" in page
    data = re.search(r'<script type="application/json".*?</script>', page, re.DOTALL)
    assert data is not None
    assert not re.search(r"src=|href=|url\(|@import|https?:|import\(|fetch\(", page.replace(data[0], ""))


def test_texts_that_are_not_unicode_are_shown_as_escapes(tmp_path: Path) -> None:
    trace = Trace("all")
    with Recording(tmp_path / "run.sqlite", program_facts("\udcff.py", "", 1, None)) as recorded:
        trace.listen(recorded.event_alone)
        trace.emit(0, "model", "output", {"text": "\udc80"})
    write_replay(tmp_path / "run.sqlite", tmp_path / "replay.html")
    page = (tmp_path / "replay.html").read_text(encoding="utf-8")
    assert "<title>\\udcff.py · seed 1</title>" in page
    assert [row[3] for row in inside(page)["events"]["rows"]] == ["\udc80"]


def test_long_runs_and_large_scenes_have_bounds(walked: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(make, "MAX_FRAMES", 10)
    monkeypatch.setattr(make, "MAX_EVENTS", 5)
    write_replay(walked, tmp_path / "replay.html")
    told = inside((tmp_path / "replay.html").read_text(encoding="utf-8"))
    assert len(numbers(told["scenes"][0]["times"])) <= 10
    assert numbers(told["scenes"][0]["times"])[-1] == 1
    assert len(told["events"]["rows"]) == 5
    assert told["events"]["more"] > 50
    monkeypatch.setattr(make, "MAX_FRAMES", 36)
    monkeypatch.setattr(state_history, "MAX_BYTES", 60_000)  # so every fourth state is left, and every third would be shown
    write_replay(walked, tmp_path / "replay.html")
    times = numbers(inside((tmp_path / "replay.html").read_text(encoding="utf-8"))["scenes"][0]["times"])
    assert 20 <= len(times) <= 36
    monkeypatch.setattr(shapes, "MAX_CORNERS", 100)
    with pytest.raises(RecordingError, match="too many triangles"):
        write_replay(walked, tmp_path / "replay.html")


def test_it_is_made_in_another_process_and_errors_are_reported(desk: Desk, walked: Path, tmp_path: Path) -> None:
    with desk.do(Readers(desk.workers).make("replay.html", walked, models=str(tmp_path.parent))) as made:
        assert inside(made.read().decode())["title"] == f"{tmp_path.name}/model.py · seed 1"
    broken = tmp_path / "broken.sqlite"
    broken.write_bytes(b"nothing")
    with pytest.raises(ReadingError, match=r"^'broken' is not a recording: it is a file of another kind, or damaged$"):
        desk.do(Readers(desk.workers).make("replay.html", broken))
