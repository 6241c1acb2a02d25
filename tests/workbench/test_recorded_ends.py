"""What a recording of the workbench says of the end of its run, and that a replay finds the same."""

from __future__ import annotations

from pathlib import Path

import pytest

from actr3d.cli import main
from actr3d.recording import Recorded
from actr3d.runner.replay import replay
from tests.helpers.sessions import Desk
from tests.workbench.test_replays import waits

MODEL = """import sys
from actr3d.actr import *
class Counter(ACTR):
    goal = Buffer()
    def init():
        goal.set("count 0")
    def count(goal="count ?n!4"):
        print("count", n)
        goal.set("count %d" % (int(n) + 1))
    def end(goal="count 4"):
        self.stop()
"""
PROGRAM = MODEL + "try:\n    Counter().run()\nfinally:\n    print('finally')\n"
BUILT = (
    MODEL
    + """
from actr3d.simulation import Simulation
from actr3d.world import Floor, Scene
def build() -> Simulation:
    return Simulation(Scene(parts=(Floor(),)), bodiless={"counter": Counter})
"""
)


@pytest.mark.daily(4)
@pytest.mark.parametrize(
    ("text", "status", "facts"),
    [
        (PROGRAM, "ended", {"ended": {"by": "end"}}),
        (PROGRAM + "sys.exit()\n", "ended", {"ended": {"by": "exit"}}),
        (PROGRAM + "print('over', end='')\nsys.exit('bye')\n", "failed", {"ended": {"by": "exit"}}),
        (PROGRAM + "1 / 0\n", "failed", {"failed": "ZeroDivisionError: division by zero"}),
        (BUILT, "ended", {"ended": {"by": "stop"}}),
        (BUILT.replace("self.stop()", "goal.clear()"), "ended", {"ended": {"by": "done"}}),
        (BUILT.replace("self.stop()", "1 / 0"), "failed", {"failed": "ZeroDivisionError: division by zero"}),
        (BUILT.replace("self.stop()", "sys.exit(3)"), "failed", {"failed": "SystemExit: 3"}),
    ],
)
def test_the_workbench_and_the_command_line_say_the_same_of_how_a_run_ended(
    text: str, status: str, facts: dict[str, object], desk: Desk, tmp_path: Path
) -> None:
    talk = desk.begin(tmp_path, text, record=True, run=True, wait=status)
    desk.do(talk.session.stop())
    path = talk.sessions.recordings.path(talk.facts["recording"])
    file = tmp_path / "model.py"
    file.write_text(text, encoding="utf-8")
    try:
        main(["run", str(file), "--record", str(tmp_path / "run")])
    except SystemExit:
        assert "sys.exit" in text
    ticks: list[int] = []
    for each in (path, tmp_path / "run"):
        with Recorded(each) as recorded:
            ticks.append(recorded.ticks)
            assert {name: recorded.facts[name] for name in ("ended", "failed") if name in recorded.facts} == facts
            assert replay(recorded).difference is None
    assert ticks[0] == ticks[1]


@pytest.mark.parametrize("text", [PROGRAM, BUILT], ids=["program", "built"])
def test_a_run_that_is_left_says_so_and_agrees(text: str, desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, text, record=True)
    talk.say("until", time=0.12)
    talk.until("paused", time=0.12)
    talk.say("seek", time=0.03)
    talk.until("paused", time=0.03)
    desk.do(talk.session.stop())
    with Recorded(talk.sessions.recordings.path(talk.facts["recording"])) as recorded:
        assert recorded.facts["ended"] == {"by": "left"}
        assert [event.data["text"] for event in recorded.events() if event.kind == "output"] == ["count 0", "count 1"]
        comparison = replay(recorded)
    assert str(comparison).startswith("agrees up to the end of the recording: ")
    assert "; the recording says that the run was left at 0.1" in str(comparison)
    path = talk.sessions.recordings.path(talk.facts["recording"])
    assert desk.do(talk.sessions.replays.run(path, waits))["verdict"] == "agrees up to its end"
