"""What the workbench records of runs that are measured, that go another way after their end, and that have helper modules."""

from __future__ import annotations

from pathlib import Path
from typing import Any

import pytest

from actr3d.recording import Recorded
from actr3d.runner.replay import replay
from tests.helpers.paths import MODELS
from tests.helpers.sessions import Desk, RefusedError, Talk
from workbench.csv_files import write_states_csv

COUNTING = (MODELS / "tutorial" / "counting.py").read_text(encoding="utf-8")
APERTURE = (MODELS / "aperture_passage.py").read_text(encoding="utf-8")
HELPED = """from helper import WORD
from actr3d.actr import *
from actr3d.simulation import Simulation
from actr3d.world import Floor, Mannequin, Scene

class Walker(ACTR):
    goal = Buffer()
    def init():
        goal.set(WORD)
    def say(goal="?word"):
        print(word)
        self.stop()

def build() -> Simulation:
    return Simulation(Scene(parts=(Floor(), Mannequin(name="walker"))), {"walker": Walker}, seed=1)
"""
PROGRAM = HELPED.replace("def build() -> Simulation:\n    return ", "made = ") + "made.run(0.2)\n"


def ended(talk: Talk) -> dict[str, Any]:
    talk.say("run")
    state = talk.until("ended")
    talk.wait(lambda: talk.session.log.next == state["events"])
    return state


def recording(desk: Desk, talk: Talk) -> Path:
    """Ends a session's run, and returns its recording."""
    name = talk.facts["recording"]
    desk.do(talk.session.stop())
    return talk.sessions.recordings.path(name)


def agrees(path: Path) -> bool:
    with Recorded(path) as recorded:
        return replay(recorded).difference is None


def test_the_aperture_of_the_model_changes_while_it_runs(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, APERTURE, record=True, settings={"aperture": 0.8})
    talk.say("step", ticks=100)
    talk.until("paused", tick=100)
    talk.say("set", name="aperture", value=0.2)
    assert talk.wait(lambda: talk.state["apertures"]["aperture"] == pytest.approx(0.2))
    ended(talk)
    assert talk.state["result"]["outcome"] == "declined"
    assert agrees(recording(desk, talk))


@pytest.mark.slow
def test_a_run_that_has_ended_is_over_there_whenever_one_comes_back(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, APERTURE, record=True, settings={"aperture": 0.3})
    ended(talk)
    end, result, events = talk.state["time"], talk.state["result"], talk.events
    with pytest.raises(RefusedError, match="the run is over"):
        talk.say("command", word="aperture", values=[0.9])
    talk.say("seek", time=0.1)
    talk.until("paused", time=0.1)
    assert talk.state["result"] is None
    talk.say("seek", time=end)
    assert talk.until("ended", time=end)["result"] == result
    assert talk.events == events
    assert agrees(recording(desk, talk))


@pytest.mark.slow
def test_a_run_that_goes_another_way_after_its_end_has_not_ended(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, APERTURE, record=True, settings={"aperture": 0.3})
    ended(talk)
    end = talk.state["time"]
    talk.say("seek", time=0.1)
    talk.until("paused", time=0.1)
    talk.say("command", word="aperture", values=[0.9])
    talk.say("step", ticks=20)
    talk.until("paused", tick=30)
    path = recording(desk, talk)
    summary = talk.summary(path.stem)
    assert summary.ended == "left"  # by who closed it, and not by itself as before
    assert summary.time == 0.3 != end
    assert agrees(path)


@pytest.mark.parametrize("source", [HELPED, PROGRAM], ids=["built", "program"])
def test_helper_modules_are_recorded_with_the_run(desk: Desk, tmp_path: Path, source: str) -> None:
    (tmp_path / "helper.py").write_text('WORD = "before"\n', encoding="utf-8")
    talk = desk.begin(tmp_path, source, record=True)
    ended(talk)
    path = recording(desk, talk)
    (tmp_path / "helper.py").write_text('WORD = "after"\n', encoding="utf-8")
    assert agrees(path)
    again = Talk(desk, desk.do(talk.sessions.reopen(path.stem)), talk.sessions)
    again.until("paused")
    ended(again)
    assert [data["text"] for _, _, kind, data in again.events if kind == "output"] == ["before"]


def test_simulations_of_a_program_are_recorded_once_however_often_it_goes_back(desk: Desk, tmp_path: Path) -> None:
    (tmp_path / "helper.py").write_text('WORD = "before"\n', encoding="utf-8")
    talk = desk.begin(tmp_path, PROGRAM, record=True)
    ended(talk)
    talk.say("seek", time=0.01)
    talk.until("paused", time=0.01)
    (tmp_path / "helper.py").write_text('WORD = "after"\n', encoding="utf-8")
    talk.say("seek", time=0)
    talk.until("paused", time=0)
    ended(talk)
    path = recording(desk, talk)
    with Recorded(path) as recorded:
        moments = [state[:2] for state in recorded.states()]
    assert moments == [(1, tick) for tick in range(len(moments))]
    assert len(moments) > 2
    assert agrees(path)
    write_states_csv(path, tmp_path / "states.csv")
    table = (tmp_path / "states.csv").read_text(encoding="utf-8").splitlines()
    assert table[0].startswith("run,tick,mujoco time [s],")
    assert [line.split(",")[:2] for line in table[1:]] == [["1", str(tick)] for tick in range(len(moments))]


@pytest.mark.parametrize("stopped", [False, True])
def test_a_recording_that_is_opened_leaves_no_other_recording_when_a_new_run_begins(desk: Desk, tmp_path: Path, stopped: bool) -> None:
    talk = desk.begin(tmp_path, COUNTING, record=True)
    ended(talk)
    path = recording(desk, talk)
    opened = Talk(desk, desk.do(talk.sessions.reopen(path.stem)), talk.sessions)
    opened.until("paused")
    if stopped:
        desk.do(opened.session.stop())
    desk.do(opened.session.restart(None, None))
    opened.wait(lambda: opened.session.run == 2)
    began = opened.facts["recording"]
    opened.wait(lambda: {file.stem for file in path.parent.glob("*.sqlite")} == {path.stem, began})
