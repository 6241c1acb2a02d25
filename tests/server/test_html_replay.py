"""The replay of a recording as one HTML file: what is in it, how large it gets, and that nothing in it can run or load anything."""

from __future__ import annotations

import base64
import json
import re
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from actr3d.errors import RecordingError
from actr3d.recording import Recorded
from tests.server.desk import Desk
from tests.server.test_overlays import LOOKING
from tests.server.test_recorded_runs import recording
from workbench.html_replay import make, shapes
from workbench.html_replay.aside import ReplayError, replay_of
from workbench.html_replay.make import write_replay

EVIL = "</script><img src=x onerror=alert(1)><!--"
PRINTS = f"from actr3d.actr import *\nprint('''{EVIL}''')\n"


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
    scene = told["scene"]
    times, poses = numbers(scene["times"]), numbers(scene["poses"]).reshape(-1, len(scene["shapes"]), 7)
    assert (times[0], times[-1]) == (0, 1)
    assert 25 <= len(times) <= 40
    assert len(poses) == len(times)
    root = poses[:, scene["follow"], :2]
    assert root[-1, 0] - root[0, 0] == pytest.approx(0.5 * 0.95, abs=0.03)
    assert scene["grounds"] == [0]


def test_nothing_is_loaded_and_nothing_a_model_says_is_run(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, PRINTS, name="x.py", record=True)
    talk.say("run")
    talk.until("ended")
    write_replay(recording(desk, talk), tmp_path / "replay.html")
    page = (tmp_path / "replay.html").read_text(encoding="utf-8")
    assert EVIL not in page
    assert [row[3] for row in inside(page)["events"]["rows"] if row[2] == "output"] == [EVIL]
    assert inside(page)["scene"] is None
    assert "default-src 'none'" in page
    data = re.search(r'<script type="application/json".*?</script>', page, re.DOTALL)
    assert data is not None
    assert not re.search(r"src=|href=|url\(|@import|https?:|import\(|fetch\(", page.replace(data[0], ""))


def test_long_runs_and_large_scenes_have_bounds(walked: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(make, "MOST_FRAMES", 10)
    monkeypatch.setattr(make, "MOST_EVENTS", 5)
    write_replay(walked, tmp_path / "replay.html")
    told = inside((tmp_path / "replay.html").read_text(encoding="utf-8"))
    assert len(numbers(told["scene"]["times"])) <= 10
    assert numbers(told["scene"]["times"])[-1] == 1
    assert len(told["events"]["rows"]) == 5
    assert told["events"]["more"] > 50
    monkeypatch.setattr(shapes, "MOST_CORNERS", 100)
    with pytest.raises(RecordingError, match="too many triangles"):
        write_replay(walked, tmp_path / "replay.html")


def test_it_is_made_aside_and_what_goes_wrong_is_told(desk: Desk, walked: Path, tmp_path: Path) -> None:
    made = desk.do(replay_of(desk.workers, walked))
    assert inside(made.read_text(encoding="utf-8"))["model"] == "model.py"
    made.unlink()
    broken = tmp_path / "broken.sqlite"
    broken.write_bytes(b"nothing")
    with pytest.raises(ReplayError, match="is no recording"):
        desk.do(replay_of(desk.workers, broken))
