"""The times of a program that runs one model after another: everything counts as the clock does, which adds up all runs."""

from __future__ import annotations

import json
import re
from pathlib import Path
from struct import pack

import pytest

from actr3d.errors import RecordingError
from actr3d.recording import Recorded, Recording
from actr3d.trace import TraceEvent
from tests.helpers.sessions import Desk, RefusedError, Talk
from workbench.exports import EXPORTS
from workbench.program_time import RunTimes, timed_events
from workbench.recording_diff import compare

TRIALS = """
from actr3d.actr import *

class Trial(ACTR):
    goal = Buffer()
    retrieval = Buffer()
    memory = Memory(retrieval, latency=0.3, threshold=None)
    noise = DMNoise(memory, noise=0.6)
    def init():
        memory.add("word:red")
    def ask(goal="look"):
        memory.request("word:?what")
        goal.set("wait")
    def say(goal="wait", retrieval="word:?what"):
        print("said", what)
        goal.set("done")
        self.stop()

for n in range(6):
    trial = Trial()
    trial.goal.set("look")
    trial.run()
    print("trial", n)
"""
"""Six runs of different durations; some last longer than the first one."""

TAKING_TURNS = """
from actr3d.actr import *

class Player(ACTR):
    goal = Buffer()
    def init():
        goal.set("move")
    def move(goal="move"):
        print("moves")
        goal.set("move")

one, other = Player(), Player()
for turn in range(3):
    one.run(0.12)
    other.run(0.07)
"""

WORLDS = """
from actr3d.actr import *
from actr3d.simulation import Simulation
from actr3d.world import Aperture, Floor, Scene

class Short(ACTR):
    goal = Buffer()
    def init():
        goal.set("begin")
    def only(goal="begin"):
        print("only")
        goal.set("end")

for seconds in (0.4, 0.2):
    simulation = Simulation(Scene(parts=(Floor(), Aperture())), bodiless={"short": Short})
    simulation.command("aperture", 0.6)
    simulation.run(seconds)
Short().run()
"""
"""After their only production the agents have nothing to do, but time goes on. The program itself changes the width of an aperture."""


def ended(talk: Talk) -> float:
    talk.say("run")
    return talk.until("ended")["time"]


@pytest.mark.parametrize(("asked", "why"), [("blue", "; a retrieval from memory failed, and no production fired after it"), ("red", "")])
def test_a_program_that_ends_after_a_failed_retrieval_says_so(desk: Desk, tmp_path: Path, asked: str, why: str) -> None:
    text = TRIALS.replace("range(6)", "range(1)").replace("word:?what", f"word:{asked}", 1)
    talk = desk.begin(tmp_path, text, run=True, wait="ended")
    assert talk.state["reason"] == f"the program is over{why}"


@pytest.mark.parametrize("source", [TRIALS, TAKING_TURNS])
def test_events_have_the_times_of_the_clock(desk: Desk, tmp_path: Path, source: str) -> None:
    talk = desk.begin(tmp_path, source, seed=3)
    end = ended(talk)
    times = [time for time, *_ in talk.events]
    assert times == sorted(times)
    assert times[-1] == round(end * 1e6)
    assert talk.say("events", most=20_000)["events"] == talk.events
    last = 0
    for number, (time, _, kind, _) in enumerate(talk.events):
        if kind in ("output", "fire") and time != last:
            last = time
            for at, happened in ((time - 1, False), (time, True)):
                talk.say("seek", time=at / 1e6)
                state = talk.wait(lambda at=at: talk.state["time"] == at / 1e6 and talk.state["status"] in ("paused", "ended"))
                assert (state["events"] > number) is happened


def test_events_of_simulations_have_the_times_of_the_clock(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, WORLDS)
    assert ended(talk) == pytest.approx(0.65)
    assert [time for time, _, kind, _ in talk.events if kind == "fire"] == [50_000, 450_000, 650_000]
    assert [time for time, _, kind, _ in talk.events if kind == "output"] == [50_000, 450_000, 650_000]


@pytest.mark.daily(1)
@pytest.mark.parametrize("source", [TRIALS, TAKING_TURNS, WORLDS])
def test_a_recording_of_a_program_counts_its_time_in_the_same_way(desk: Desk, tmp_path: Path, source: str) -> None:
    talk = desk.begin(tmp_path, source, seed=3, record=True)
    end, events = ended(talk), talk.events
    desk.do(talk.session.stop())
    path = talk.sessions.recordings.path(talk.facts["recording"])
    with Recorded(path) as recorded:
        assert [event.time_us for event in timed_events(recorded)] == [time for time, *_ in events]
    again = Talk(desk, desk.do(talk.sessions.reopen(path.stem)), talk.sessions)
    again.until("paused", time=0, furthest=end)
    assert again.events == events
    ended(again)
    assert again.events == events
    assert not [notice for notice in again.notices if notice["level"] == "error"]

    EXPORTS["replay.html"](path, tmp_path / "replay.html")
    data = re.search(r'id="data">(.*?)</script>', (tmp_path / "replay.html").read_text(encoding="utf-8"), re.DOTALL)
    assert data is not None
    assert [round(1e6 * row[0]) for row in json.loads(data[1])["events"]["rows"]] == [time for time, *_ in events]

    other = desk.begin(
        tmp_path, source.replace("range(6)", "range(5)").replace("0.2)", "0.1)").replace("0.07", "0.06"), seed=3, record=True
    )
    ended(other)
    desk.do(other.session.stop())
    compared = compare(path, other.sessions.recordings.path(other.facts["recording"]))
    assert compared["changed"] == [{}, {}]  # by users
    difference = compared["difference"]
    assert difference["time"] >= 0.1
    assert difference["events"][0][0] == events[compared["same_events"]][0]


@pytest.mark.parametrize("state", [b"short", pack("d", float("nan")), pack("d", float("inf"))])
def test_a_forged_state_without_a_time_is_refused(tmp_path: Path, state: bytes) -> None:
    with Recording(tmp_path / "forged", {"kind": "program"}) as recording:
        recording.state(1, 0, state, {})
        recording.event_alone(TraceEvent(0, "top", "run", {}))
    with Recorded(tmp_path / "forged") as recorded, pytest.raises(RecordingError, match="a state has no time"):
        list(timed_events(recorded))


def test_the_times_of_a_run_that_pauses_while_another_one_goes_on_convert_both_ways() -> None:
    times = RunTimes()
    assert times.own_at(70) is None
    for own, program in [(0, 70), (10, 80), (10, 130), (30, 150)]:
        times.add(own, program)
    assert (times.own, times.program) == (30, 150)
    assert [times.own_at(program) for program in (69, 70, 75, 80, 100, 130, 140, 150, 160)] == [
        None,
        (0, 0),
        (5, 0),
        (10, 0),
        (10, 20),
        (10, 0),
        (20, 0),
        (30, 0),
        (30, 10),
    ]
    assert [times.program_at(own) for own in (0, 5, 10, 20, 30)] == [70, 75, 80, 140, 150]


def test_explanations_have_the_times_of_the_clock(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, TRIALS, seed=3)
    end = ended(talk)
    said = [time / 1e6 for time, _, kind, data in talk.events if kind == "fire" and data["production"] == "say"]
    asked = [time / 1e6 for time, _, kind, data in talk.events if kind == "fire" and data["production"] == "ask"]
    assert {one["time"] for one in talk.say("explain")} == {end}
    talk.say("seek", time=said[3])
    talk.until("paused", time=said[3])
    now = talk.say("explain")
    assert {one["time"] for one in now} == {said[3]}
    # All fired one after the other: what the first ones did is known of then.
    assert [one["retrievals"][0]["time"] for one in now[:4]] == [pytest.approx(time) for time in asked[:4]]
    for number in (1, 3):
        began = asked[number]
        then = {one["agent"]: one for one in talk.say("explain", at=began - 1e-6)}
        agent = f"top#{number + 1}"
        assert [*then] == ["top", *(f"top#{n}" for n in range(2, number + 2))]
        assert then[agent]["time"] == pytest.approx(began - 1e-6)
        assert then[agent]["retrievals"] == []
        assert [one["selected"] for one in then[agent]["productions"] if one["name"] == "ask"] == [True]
        (one,) = talk.say("explain", at=began + 0.01, agent=agent)
        assert one["retrievals"][0]["time"] == pytest.approx(began)
        assert f"at {began:.3f} s" in one["retrievals"][0]["text"]
    with pytest.raises(RefusedError, match="lies ahead"):
        talk.say("explain", at=said[3] + 0.1)
    with pytest.raises(RefusedError, match=r"'top#4' did not exist at 0\.1 s"):
        talk.say("explain", at=0.1, agent="top#4")
