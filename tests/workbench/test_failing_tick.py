"""A run that fails within a tick: its time is that of the failure, also after it went back."""

from __future__ import annotations

from pathlib import Path

import pytest

from tests.helpers.sessions import Desk, RefusedError, Talk

FAILS = """
from actr3d.actr import *
from actr3d.simulation import BodyPort, Simulation
from actr3d.world import Floor, Mannequin, Scene

class Walker(ACTR):
    goal = Buffer()
    production_time = TIME
    skin = BodyPort()
    def init():
        goal.set("one")
    def one(goal="one"):
        goal.set("two")
    def two(goal="two"):
        goal.set("three")
    def three(goal="three"):
        print("says")
        skin.set("walk_to", 3, 1.5)
        DOES
        goal.set("four")

"""
MADE = "Simulation(Scene(parts=(Floor(), Mannequin(name='walker'))), {'walker': Walker}, seed=1)\n"
BUILT = f"{FAILS}def build() -> Simulation:\n    return {MADE}"
PROGRAM = f"{FAILS}made = {MADE}made.run(1)\n"


def failed(talk: Talk, time: float) -> None:
    """Waits until the run has failed at a time, after which nothing has happened."""
    state = talk.until("failed", time=time, furthest=time)
    talk.wait(lambda: talk.session.log.next == state["events"])
    assert 0 <= time - talk.events[-1][0] / 1e6 < 0.01
    assert [data["text"] for _, _, kind, data in talk.events if kind == "output"] == ["says"]


@pytest.mark.daily(3)
@pytest.mark.parametrize("source", [BUILT, PROGRAM], ids=["built", "program"])
@pytest.mark.parametrize(("does", "production_time", "time"), [("pass", 0.05, 0.15), ("1 / 0", 0.05, 0.15), ("1 / 0", 0.047, 0.141)])
def test_a_run_that_fails_in_a_tick_shows_the_moment_of_the_failure(
    desk: Desk, tmp_path: Path, source: str, does: str, production_time: float, time: float
) -> None:
    talk = desk.begin(tmp_path, source.replace("DOES", does).replace("TIME", str(production_time)), record=True)
    talk.say("run")
    failed(talk, time)
    reason = talk.state["reason"]
    talk.say("back")
    talk.until("paused", time=0.14, furthest=time)
    talk.say("seek", time=0.05)
    talk.until("paused", time=0.05, furthest=time)
    talk.say("seek", time=time)
    failed(talk, time)
    talk.say("seek", time=0.1)
    talk.until("paused", time=0.1, furthest=time)
    talk.say("run")
    failed(talk, time)
    assert talk.state["reason"] == reason

    desk.do(talk.session.stop())
    again = Talk(desk, desk.do(talk.sessions.reopen(talk.facts["recording"])), talk.sessions)
    again.until("paused", time=0, furthest=time)
    again.say("seek", time=time)
    failed(again, time)


def test_a_run_that_goes_another_way_before_its_failure_forgets_it(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, BUILT.replace("DOES", "pass").replace("TIME", "0.05"), record=True)
    talk.say("run")
    failed(talk, 0.15)
    talk.say("seek", time=0.12)
    talk.until("paused", time=0.12, furthest=0.15)
    talk.say("command", word="set_buffer", named={"buffer": "walker.goal", "chunk": "four"})
    talk.until("paused", time=0.12, furthest=0.12)
    with pytest.raises(RefusedError, match="has only reached"):
        talk.say("seek", time=0.15)
    talk.say("run")
    state = talk.until("ended")
    assert state["furthest"] == state["time"]


@pytest.mark.parametrize("source", [BUILT, PROGRAM], ids=["built", "program"])
def test_a_run_that_has_failed_cannot_be_changed_or_continued(desk: Desk, tmp_path: Path, source: str) -> None:
    talk = desk.begin(tmp_path, source.replace("DOES", "1 / 0").replace("TIME", "0.05"))
    talk.say("run")
    failed(talk, 0.15)
    with pytest.raises(RefusedError, match="the run is over: go back to an earlier time, or restart it"):
        talk.say("command", word="set_buffer", named={"buffer": "walker.goal", "chunk": "four"})
    with pytest.raises(RefusedError, match="the run is over: go back to an earlier time, or restart it"):
        talk.say("run")
    failed(talk, 0.15)
