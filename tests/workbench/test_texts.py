"""A run is stale where a file that it was made of has changed: the model, or a helper module that it has loaded."""

from __future__ import annotations

import os
from pathlib import Path

import pytest

from tests.helpers.sessions import Desk, Talk

WALKING = """from helper import COUNT
from actr3d.actr import *
from actr3d.simulation import Simulation
from actr3d.world import Floor, Mannequin, Scene

class Walker(ACTR):
    goal = Buffer()
    def init():
        goal.set("begin")
    def go(goal="begin"):
        from late import WORD
        print(WORD)
        goal.set("done")
    def end(goal="done"):
        self.stop()

def build() -> Simulation:
    return Simulation(Scene(parts=(Floor(), Mannequin(name="walker"))), {"walker": Walker}, seed=1)
"""
PROGRAM = WALKING.replace("from helper import", "import importlib\nimportlib.import_module('helper')\nfrom helper import").replace(
    "def build() -> Simulation:\n    return ", "made = "
)


def changed(talk: Talk, path: Path, text: str) -> bool:
    """Tells whether a run is stale when a file holds something else for a moment."""
    before = path.read_text(encoding="utf-8")
    path.write_text(text, encoding="utf-8")
    stale: bool = talk.facts["stale"]
    path.write_text(before, encoding="utf-8")
    assert not talk.facts["stale"]
    return stale


@pytest.mark.parametrize("source", [WALKING, PROGRAM + "made.run(1)\n"], ids=["built", "program"])
def test_a_run_is_stale_when_a_module_that_it_has_loaded_has_changed(desk: Desk, tmp_path: Path, source: str) -> None:
    files = {"helper.py": "from deep.count import COUNT\n", "other.py": "1\n", "late.py": "WORD = 'late'\n"}
    (tmp_path / "deep").mkdir()
    for name, text in {**files, "deep/__init__.py": "", "deep/count.py": "COUNT = 1\n"}.items():
        (tmp_path / name).write_text(text, encoding="utf-8")
    talk = desk.begin(tmp_path, source)
    # What has not been loaded yet will be loaded as it is then.
    made_of = {name: changed(talk, tmp_path / name, "x = 1\n") for name in (*files, "deep/count.py")}
    assert made_of == {"helper.py": True, "other.py": False, "late.py": False, "deep/count.py": True}
    talk.say("run")
    talk.until("ended")
    made_of = {name: changed(talk, tmp_path / name, "x = 1\n") for name in (*files, "deep/count.py")}
    assert made_of == {"helper.py": True, "other.py": False, "late.py": True, "deep/count.py": True}
    (tmp_path / "late.py").unlink()
    assert talk.facts["stale"]
    (tmp_path / "late.py").write_text("WORD = 'later'\n", encoding="utf-8")
    talk.say("restart", run=True)
    talk.wait(lambda: talk.session.run == 2)
    talk.until("ended")
    assert not talk.facts["stale"]


def test_a_run_is_outdated_only_while_it_waits_at_its_start_and_its_file_has_another_text(desk: Desk, tmp_path: Path) -> None:
    for name in ("helper.py", "late.py"):
        (tmp_path / name).write_text("COUNT = WORD = 1\n", encoding="utf-8")
    talk = desk.begin(tmp_path, WALKING)
    assert not talk.session.is_outdated
    (tmp_path / "model.py").write_text(WALKING + "\n", encoding="utf-8")
    assert talk.session.summary()["outdated"]
    talk.say("step")
    talk.wait(lambda: not talk.session.is_outdated)  # what it has done is kept


def test_pages_are_notified_when_a_loaded_module_is_saved(desk: Desk, tmp_path: Path) -> None:
    for name in ("helper.py", "other.py"):
        (tmp_path / name).write_text("COUNT = 1\n", encoding="utf-8")
    talk = desk.begin(tmp_path, WALKING)
    version = talk.session.facts_version
    talk.sessions.saved(tmp_path / "other.py")
    assert talk.session.facts_version == version
    for name in ("helper.py", "model.py"):
        talk.sessions.saved(tmp_path / name)
        assert talk.session.facts_version > version
        version = talk.session.facts_version


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="the system has no named pipes")
def test_an_endless_file_blocks_no_other_request(desk: Desk, tmp_path: Path) -> None:
    (tmp_path / "helper.py").write_text("COUNT = 1\n", encoding="utf-8")
    talk = desk.begin(tmp_path, WALKING)
    for name in ("helper.py", "model.py"):
        (tmp_path / name).unlink()
        os.mkfifo(tmp_path / name)
        assert talk.facts["stale"]
