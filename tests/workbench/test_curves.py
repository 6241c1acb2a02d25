"""Curves of a run, live and recorded: they agree with what the run itself measures, and with one another."""

from __future__ import annotations

import math
from pathlib import Path
from typing import Any

import pytest

from actr3d.actr.loading import load_text
from actr3d.recording import Recorded
from actr3d.world.contacts import Touch
from tests.helpers.sessions import Desk, Talk
from tests.helpers.walkers import STRUCK
from tests.workbench.test_recorded_runs import APERTURE, agrees, ended, recording
from workbench.curves import NOTHING
from workbench.exports import curves_of
from workbench.worker.state_history import StateHistory
from workbench.worker.stop_conditions import Contact

PUSHED = """from actr3d.actr import *
from actr3d.motor import Motor
from actr3d.simulation import Simulation
from actr3d.world import Aperture, Floor, Mannequin, Scene

class Walker(ACTR):
    goal = Buffer()
    motor = Motor()
    def init():
        goal.set("walk")
    def walk(goal="walk"):
        motor.walk(1.0)
        goal.set("on")
    def wait(goal="on"):
        goal.set("on")

def build() -> Simulation:
    parts = (Floor(), Mannequin(name="walker"), Aperture(width=0.2, position=(1.0, 0.0)))
    return Simulation(Scene(parts=parts), {"walker": Walker}, seed=1)
"""


def least(values: list[float | None]) -> float:
    return min(value for value in values if value is not None)


def test_contacts_within_ticks_are_the_same_live_recorded_and_opened(desk: Desk, tmp_path: Path) -> None:
    simulation = load_text(STRUCK).build()
    skin = simulation.world.bodies["walker"]
    skin.touched = tuple[Touch, ...]()  # from now on it feels
    felt: dict[int, float] = {}
    begins: dict[int, str] = {}
    before = set[str]()
    for tick in range(1, 401):
        simulation.step()
        if skin.touched:
            felt[tick] = max(touch.force for touch in skin.touched)
        now = {f"{touch.part} of walker touches {touch.other}" for touch in skin.touched}
        if now - before:
            begins[tick] = min(now - before)
        before = now
    assert len(felt) > len(begins) > 2

    def forces(told: dict[str, Any]) -> dict[int, float]:
        curve = told["curves"]["walker contact force"]
        return {round(100 * time): force for time, force in zip(told["times"], curve, strict=True) if force}

    def check(talk: Talk) -> None:
        for most in (5_000, 20):
            assert forces(talk.say("curves", names=["walker contact force"], most=most)) == felt

    def run_until_touched(talk: Talk) -> None:
        for tick, reason in begins.items():
            talk.say("until", contact="walker")
            assert talk.until("paused", tick=tick)["reason"] == reason
        talk.say("until", time=4.0)
        talk.until("paused", tick=400)

    talk = desk.begin(tmp_path, STRUCK, record=True)
    run_until_touched(talk)
    check(talk)
    talk.say("seek", time=2.0)
    talk.until("paused", tick=200)
    check(talk)
    told = [talk.say("curves", most=most) for most in (5_000, 20)]
    path = recording(desk, talk)
    assert [curves_of(path, names=None, first=0.0, most=most) for most in (5_000, 20)] == told

    opened = Talk(desk, desk.do(talk.sessions.reopen(path.stem)), talk.sessions)
    opened.until("paused", tick=0)
    check(opened)
    assert opened.say("curves") == curves_of(path, names=None, first=0.0, most=1_000)
    run_until_touched(opened)
    check(opened)
    past = [*begins][1]
    opened.say("seek", time=past / 100)
    opened.until("paused", tick=past)
    opened.say("command", word="teleport", body="walker", values=[0.0, 0.0, 0.0], drop=True)
    opened.wait(lambda: opened.state["furthest"] == past / 100)
    known = {tick: force for tick, force in felt.items() if tick <= past}
    assert forces(opened.say("curves", names=["walker contact force"])) == known


@pytest.mark.slow
def test_a_passage_is_measured_and_replayed_and_its_curves_agree_with_its_result_live_and_recorded(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, APERTURE, record=True, settings={"aperture": 0.45})
    assert talk.state["result"] is None
    result = ended(talk)["result"]
    assert (result["outcome"], result["contacts"]) == ("passed", 0)
    assert 20 < result["peak_angle_deg"] < 80
    assert [data for _, _, kind, data in talk.events if kind == "result"] == [result]
    told = talk.say("curves", most=5000)
    groups = {(one["name"], one["unit"], one["group"]) for one in told["names"]}
    assert groups >= {
        ("walker x", "m", "place"),
        ("walker speed", "m/s", "speed"),
        ("walker clearance left", "m", "clearance"),
        ("walker contact force", "N", "contact"),
        ("walker_torso_yaw", "deg", "joint"),
        ("walker_torso_yaw speed", "deg/s", "joint speed"),
    }
    of_bodies = [one["name"] for one in told["names"] if one["name"] not in told["events"]]
    assert of_bodies == list(told["curves"])
    assert told["times"] == pytest.approx([0.01 * n for n in range(len(told["times"]))])
    of = told["curves"]
    for side in ("left", "right"):  # the result looks at every physics step, the curves at each fifth
        assert least(of[f"walker clearance {side}"]) == pytest.approx(result[f"clearance_{side}_m"], abs=0.005)
    assert of["walker clearance left"][0] is of["walker clearance right"][-1] is None
    assert max(of["walker speed"]) == pytest.approx(1.29, abs=0.02)
    way = math.dist((of["walker x"][0], of["walker y"][0]), (of["walker x"][-1], of["walker y"][-1]))
    assert way == pytest.approx(0.01 * sum(of["walker speed"]), rel=0.02)
    assert set(of["walker contact force"]) == {0.0}
    path = recording(desk, talk)
    assert agrees(path)
    assert curves_of(path, names=None, first=0.0, most=5000) == told
    part = curves_of(path, names=["walker speed"], first=0.995, most=5000, last=1.234)
    assert part["times"] == told["times"][100:124]
    assert part["curves"]["walker speed"] == of["walker speed"][100:124]
    assert curves_of(path, names=None, first=1.0, most=3, last=0.5)["times"] == []


def test_the_force_of_a_wall_is_a_curve_and_that_of_the_ground_is_not(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, PUSHED)
    talk.say("until", contact="walker")
    touched = talk.wait(lambda: "of walker touches" in talk.state["reason"])["time"]
    talk.say("step", ticks=20)
    talk.until("paused", time=round(touched + 0.2, 6))
    told = talk.say("curves", names=["walker contact force"])
    force = dict(zip(told["times"], told["curves"]["walker contact force"], strict=True))
    assert not any(value for time, value in force.items() if time < touched - 0.005)
    assert max(force.values()) > 10


def test_only_requested_curves_are_returned_from_a_time_on_evenly_spaced(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, PUSHED)
    talk.say("step", ticks=50)
    talk.until("paused", tick=50)
    told = talk.say("curves", names=["walker x", "no"], first=0.4)
    assert list(told["curves"]) == ["walker x"]
    assert told["times"] == pytest.approx([0.40 + 0.01 * n for n in range(11)])
    told = talk.say("curves", names=["walker x"], most=7)
    assert told["times"] == [0.0, 0.09, 0.18, 0.27, 0.36, 0.45, 0.5]
    told = talk.say("curves", names=["walker x"], first=0.105, last=0.151)
    assert told["times"] == [0.11, 0.12, 0.13, 0.14, 0.15]
    told = talk.say("curves", names=["walker x"], first=0.1, last=0.3, most=4)
    assert told["times"] == [0.14, 0.21, 0.28, 0.3]
    assert talk.say("curves", names=["walker x"], first=0.3, last=0.1)["times"] == []
    assert talk.say("curves", names=["walker x"], first=2.0, last=3.0)["times"] == []
    assert talk.say("curves", names=["walker x"], last=9.0, most=5000)["times"][-1] == 0.5
    assert talk.say("curves", names=[], most=7)["times"] == []


def test_events_ahead_are_known_until_the_run_is_changed(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, PUSHED)
    talk.say("step", ticks=40)
    talk.until("paused", tick=40)
    before = talk.say("curves")
    talk.say("seek", time=0.1)
    talk.until("paused", tick=10)
    assert talk.say("curves") == before
    talk.say("step", ticks=5)
    talk.until("paused", tick=15)
    assert talk.say("curves") == before
    talk.say("command", word="walk", values=[-1.0], drop=True)
    told = talk.say("curves")
    assert told["times"][-1] == 0.15
    talk.say("step", ticks=25)
    talk.until("paused", tick=40)
    after = talk.say("curves")
    assert after["times"] == before["times"]
    assert after["curves"]["walker x"][:16] == before["curves"]["walker x"][:16]
    assert after["curves"]["walker x"][-1] < before["curves"]["walker x"][-1]


def test_a_run_goes_another_way_also_where_no_event_was_ahead(desk: Desk, tmp_path: Path) -> None:
    """A page knows by the number of the way that what it has of the time ahead, as curves, holds no more."""
    still = PUSHED.replace("    motor = Motor()\n", "").replace(
        "        motor.walk(1.0)\n", ""
    )  # who has a motor feels the body at each tick
    talk = desk.begin(tmp_path, still)
    talk.say("step", ticks=44)
    talk.until("paused", tick=44)
    events = talk.state["events"]
    talk.say("seek", time=0.43)
    assert talk.until("paused", tick=43)["events"] == events
    before = talk.session.epoch
    talk.say("command", word="aperture", values=[0.3], drop=True)
    assert talk.session.epoch == before + 1
    assert talk.say("curves", names=["walker x"])["times"][-1] == 0.43
    talk.say("command", word="aperture", values=[0.4])  # now there is nothing ahead that could be lost
    assert talk.session.epoch == before + 1


def test_a_program_has_no_curves(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, "x = 1\n", record=True)
    talk.say("run")
    talk.until("ended")
    nothing: dict[str, Any] = {**NOTHING, "events": {}, "basis": ""}
    assert talk.say("curves") == nothing
    assert curves_of(recording(desk, talk), names=None, first=0.0, most=100) == nothing


def test_of_a_long_past_every_second_state_is_left_out_and_no_contact() -> None:
    def state(tick: int) -> bytes:
        return tick.to_bytes(8, "big") * 125_000

    def known(first: int = 0, last: int | None = None) -> list[tuple[int, dict[Contact, float]]]:
        return [(tick, dict(contacts)) for tick, numbers, contacts in past.between(first, last) if numbers == state(tick)]

    def touching(force: float) -> dict[Contact, float]:
        return {("walker", "hand", "wall"): force}

    past = StateHistory()
    contacts = {17: touching(2.0), 18: touching(3.0), 24: touching(1.0), 97: touching(4.0), 198: touching(5.0)}
    for tick in range(200):
        past.add(tick, state(tick), contacts.get(tick, {}))
    assert [tick for tick, _ in known()] == [*range(0, 200, 8), 199]
    assert [(tick, one) for tick, one in known() if one] == [
        (24, touching(3.0)),
        (104, touching(4.0)),
        (199, touching(5.0)),
    ]
    past.cut(100)
    assert [tick for tick, _ in known()] == [*range(0, 97, 8)]
    for tick in range(101, 106):
        past.add(tick, state(tick), touching(6.0) if tick == 105 else {})
    assert known(90) == [(96, {}), (104, {}), (105, touching(6.0))]
    assert (past.contacts(105), past.contacts(101)) == (touching(6.0), {})


def test_a_recording_keeps_its_scene(desk: Desk, tmp_path: Path) -> None:
    talk: Talk = desk.begin(tmp_path, PUSHED, record=True)
    talk.say("step", ticks=3)
    talk.until("paused", tick=3)
    with Recorded(recording(desk, talk)) as recorded:
        assert len(recorded.facts["compiled"]) < 20_000
        assert recorded.facts["world"]["walls"]["aperture"]["position"] == [1.0, 0.0]
