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
from tests.server.test_recorded_runs import APERTURE, ended, recording
from workbench.curves import NOTHING
from workbench.exports import curves_of
from workbench.worker.state_history import Past

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

STRUCK = """from actr3d.actr import *
from actr3d.simulation import BodyPort, Simulation
from actr3d.world import Floor, Mannequin, Scene, Wall

class Walker(ACTR):
    goal = Buffer()
    felt = Buffer()
    skin = BodyPort(felt)

    def init():
        goal.set("aside")
        skin.set("waypoint", 3, 1.5, 1.2)

    def ask(goal="aside", felt=None, skin="busy:False"):
        skin.request("pose")

    def look(goal="aside", felt="pose x:?x"):
        felt.clear()
        if float(x) > 2.8:
            goal.set("on")
            skin.set("waypoint", 6, 0, 1.2)

    def go_on(goal="on"):
        goal.set("on")

def build() -> Simulation:
    wall = Wall(name="block", start=(3.0, -1.2), end=(3.0, 1.2), height=1.2)
    return Simulation(Scene(parts=(Floor(), wall, Mannequin(name="walker"))), {"walker": Walker}, seed=1)
"""
"""It grazes the end of a wall: each touch is over before its tick ends."""


def least(values: list[float | None]) -> float:
    return min(value for value in values if value is not None)


def test_a_touch_that_is_over_before_its_tick_ends_is_seen(desk: Desk, tmp_path: Path) -> None:
    simulation = load_text(STRUCK).build()
    skin = simulation.world.bodies["walker"]
    skin.touched = tuple[Touch, ...]()  # from now on it feels
    felt: dict[int, float] = {}
    for tick in range(1, 401):
        simulation.step()
        if skin.touched:
            felt[tick] = max(touch.force for touch in skin.touched)
    assert len(felt) > 3
    talk = desk.begin(tmp_path, STRUCK)
    talk.say("until", contact="walker")
    state = talk.until("paused", tick=min(felt))
    assert state["reason"] == "right_upper_arm of walker touches block"
    talk.say("until", time=4.0)
    talk.until("paused", tick=400)

    def forces(most: int) -> dict[int, float]:
        told = talk.say("curves", names=["walker contact force"], most=most)
        curve = told["curves"]["walker contact force"]
        return {round(100 * time): force for time, force in zip(told["times"], curve, strict=True) if force}

    for most in (5_000, 20):
        assert forces(most) == pytest.approx(felt)
    talk.say("seek", time=2.0)
    talk.until("paused", tick=200)
    assert forces(20) == pytest.approx(felt)
    talk.say("command", word="teleport", body="walker", values=[0.0, 0.0, 0.0], drop=True)
    talk.wait(lambda: talk.state["furthest"] == 2.0)
    assert forces(20) == {}


@pytest.mark.slow
def test_curves_of_a_passage_agree_with_its_result_live_and_recorded(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, APERTURE, record=True, settings={"aperture": 0.45})
    result = ended(talk)["result"]
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
    assert [one["name"] for one in told["names"]] == list(told["curves"])
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
    assert talk.say("curves") == NOTHING
    assert curves_of(recording(desk, talk), names=None, first=0.0, most=100) == NOTHING


class Steady:
    """A world whose states are large."""

    def __init__(self) -> None:
        self.tick = 0

    def state_bytes(self) -> bytes:
        return self.tick.to_bytes(8, "big") * 125_000


def test_of_a_long_past_every_second_state_is_left_out() -> None:
    world: Any = Steady()
    past = Past()
    for world.tick in range(200):
        past.keep(world.tick, world)
    ticks = [tick for tick, state in past.within(0, None, 5000) if state[:8] == tick.to_bytes(8, "big")]
    assert ticks == [*range(0, 200, 8), 199]
    past.cut(100)
    assert [tick for tick, _ in past.within(0, None, 5000)] == [*range(0, 97, 8)]
    for world.tick in range(101, 106):
        past.keep(world.tick, world)
    assert [tick for tick, _ in past.within(90, None, 5000)] == [96, 104, 105]


def test_a_recording_keeps_its_scene(desk: Desk, tmp_path: Path) -> None:
    talk: Talk = desk.begin(tmp_path, PUSHED, record=True)
    talk.say("step", ticks=3)
    talk.until("paused", tick=3)
    with Recorded(recording(desk, talk)) as recorded:
        assert len(recorded.facts["compiled"]) < 20_000
        assert recorded.facts["world"]["walls"]["aperture"]["position"] == [1.0, 0.0]
