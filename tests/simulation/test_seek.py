"""Seek: any past time is restored exactly, and the run continues from there as the first time."""

from __future__ import annotations

import random
import tracemalloc
from pathlib import Path
from typing import Any, cast

import pytest

from actr3d.actr.loading import load_text
from actr3d.errors import SimulationError
from actr3d.recording import Recorded
from actr3d.simulation import Simulation, timeline
from actr3d.world import Body
from tests.helpers.walkers import Driver, digest, driving, scene_of

COMMANDS = {
    30: ("aperture", 0.5, None),
    77: ("stop", None, "walker"),
    78: ("parameter", "walker.looks", None),
    110: ("posture", {"torso_yaw": 0.2}, "walker"),
    120: ("aperture", 0.6, None),
}
"""By tick: the command after it, its value, and the body."""


def command(simulation: Simulation, tick: int) -> None:
    if tick in COMMANDS:
        word, value, body = COMMANDS[tick]
        values = [] if value is None else [value, 50] if word == "parameter" else [value]
        simulation.command(word, *values, body=body)


def first_run(ticks: int = 200, simulation: Simulation | None = None) -> tuple[Simulation, list[str]]:
    """Returns a simulation that was run with commands, and the digest at the end of each tick, before its commands."""
    simulation = simulation or driving("all")
    digests = [digest(simulation)]
    for tick in range(ticks):
        command(simulation, tick)
        simulation.step()
        digests.append(digest(simulation))
    return simulation, digests


COUNTED = """
from actr3d.actr import *
from actr3d.simulation import Simulation
from actr3d.world import Floor, Mannequin, Scene

count = 0
seen = []

class Counter(ACTR):
    goal = Buffer()

    def init():
        goal.set("go 0")

    def go(goal="go ?n"):
        global count
        count += 1
        seen.append(n)
        Counter.seen.append(n)
        goal.set(f"go {KEPT}")

Counter.seen = []

def build() -> Simulation:
    return Simulation(Scene(parts=(Floor(), Mannequin(name="counter"))), {"counter": Counter}, seed=1, trace="all")
"""


@pytest.mark.parametrize("kept", ["count", "len(seen)", "len(Counter.seen)"])
def test_a_run_with_state_that_seek_cannot_restore_reports_it_and_stops(kept: str) -> None:
    simulation = load_text(COUNTED.replace("KEPT", kept)).build()
    simulation.run(1)
    for _ in range(2):
        with pytest.raises(SimulationError, match=r"act differently than the first time from 0\.0[05]0 s on .* such as a global variable"):
            simulation.seek(0.5)
        with pytest.raises(SimulationError, match="cannot go on; seek an earlier time"):
            simulation.step()


@pytest.mark.slow
@pytest.mark.parametrize("answers", [7, 0], ids=["first answers", "no answers"])
def test_any_past_time_is_restored_and_continued_exactly(answers: int, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(timeline, "MAX_ANSWERS", answers)
    monkeypatch.setattr(timeline, "SPACING", 10)
    simulation, digests = first_run()
    choose = random.Random(1)
    for tick in [100, 200, 0, 199, 3, *(choose.randrange(201) for _ in range(3))]:
        simulation.seek(tick / 100)
        assert simulation.ticks == tick
        assert simulation.furthest == 2.0
        assert digest(simulation) == digests[tick]
        for later in range(tick + 1, min(tick + 8, 200) + 1):
            simulation.step()
            assert digest(simulation) == digests[later], f"{later} after {tick}"
    simulation.seek(0)
    simulation.run(2.0)
    assert digest(simulation) == digests[200]
    simulation.run(0.5)
    assert digest(simulation) == first_run(250)[1][250]


def test_known_answers_are_not_requested_again(monkeypatch: pytest.MonkeyPatch) -> None:
    simulation, digests = first_run()
    monkeypatch.setattr(Body, "get", None)
    simulation.seek(1.5)
    assert digest(simulation) == digests[150]


def test_thinned_out_states_still_lead_to_any_time(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(timeline, "SPACING", 2)
    monkeypatch.setattr(timeline, "MAX_STATES", 5)
    simulation, digests = first_run()
    assert len(simulation.timeline._history._states) <= 6
    for tick in (7, 163, 50, 199):
        simulation.seek(tick / 100)
        assert digest(simulation) == digests[tick]


def test_a_new_command_in_the_past_makes_another_future() -> None:
    simulation, digests = first_run()
    simulation.seek(0.5)
    simulation.command("aperture", 0.9)
    assert simulation.furthest == 0.5
    simulation.run(1.5)
    assert digest(simulation) != digests[200]
    other = driving("all")
    for tick in range(50):
        command(other, tick)
        other.step()
    other.command("aperture", 0.9)
    other.run(1.5)
    assert digest(simulation) == digest(other)
    with pytest.raises(SimulationError, match=r"seek\(2\.5\): the run has only reached 2 s"):
        simulation.seek(2.5)


def test_a_command_that_fails_in_the_past_changes_nothing() -> None:
    simulation, digests = first_run()
    simulation.seek(0.5)
    with pytest.raises(SimulationError):
        simulation.command("parameter", "walker.look", 1)
    simulation.run(1.5)
    assert digest(simulation) == digests[200]


def test_commands_that_were_not_repeated_yet_are_dropped_with_the_future() -> None:
    simulation, digests = first_run(79)  # the last command came after tick 78
    simulation.seek(0.78)
    assert digest(simulation) == digests[78]
    simulation.command("aperture", 0.8)
    simulation.run(0.01)
    assert simulation.trace is not None
    assert [event.data["command"] for event in simulation.trace.select("command")] == ["aperture", "stop", "aperture"]


def test_listeners_receive_nothing_during_a_seek() -> None:
    simulation, _ = first_run()
    heard: list[Any] = []
    ticks: list[int] = []
    simulation.listen(heard.append)
    simulation.observe(lambda seen: ticks.append(seen.tick))
    simulation.seek(1.0)
    assert (heard, ticks) == ([], [100])
    simulation.run(0.1)
    assert heard
    assert min(event.time for event in heard) >= 1.0
    assert ticks[1:] == list(range(101, 111))


def test_a_time_between_ticks_is_refused() -> None:
    simulation, _ = first_run(10)
    with pytest.raises(SimulationError, match=r"seek: must be a whole number of ticks of 0\.01 s, >= 0 \(got 0\.055\)"):
        simulation.seek(0.055)
    with pytest.raises(SimulationError, match=">= 0"):
        simulation.seek(-0.01)


def test_an_agent_that_depends_on_more_than_the_seed_is_detected() -> None:
    text = """
from actr3d.actr import *
from actr3d.simulation import BodyPort
lives = []
class Moody(Model):
    body = BodyPort()
    def start(self):
        lives.append(self)
        while True:
            yield 0.01
            if len(lives) == 1:
                self.body.get("pose")
"""
    moody: Any = load_text(text, "moody.py").Moody
    simulation = Simulation(scene_of("walker"), {"walker": moody}, seed=1)
    simulation.run(1)
    with pytest.raises(SimulationError, match="asked 0 questions where they had asked 1 the first time, in the tick from 0 s on"):
        simulation.seek(0.9)


def lines(path: Path) -> tuple[list[str], list[bytes], list[Any], list[Any]]:
    with Recorded(path) as recorded:
        states = [state.data for state in recorded.states()]
        return [event.to_json() for event in recorded.events()], states, list(recorded.commands()), list(recorded.answers())


def test_a_recording_holds_each_event_once_after_any_number_of_seeks(tmp_path: Path) -> None:
    straight, wandering = driving("all"), driving("all")
    with straight.record(tmp_path / "straight"):
        first_run(200, straight)
    with wandering.record(tmp_path / "wandering"):
        first_run(120, wandering)
        for tick in (0, 60, 119, 5):
            wandering.seek(tick / 100)
            wandering.run(0.01)
        wandering.seek(1.2)
        for tick in range(120, 200):
            command(wandering, tick)
            wandering.step()
    assert lines(tmp_path / "straight") == lines(tmp_path / "wandering")


@pytest.mark.daily(2)
@pytest.mark.parametrize("tick", [0, 50, 78])
def test_a_new_future_replaces_the_recorded_one(tick: int, tmp_path: Path) -> None:
    changed, direct = driving(), driving()
    with changed.record(tmp_path / "changed"):
        first_run(150, changed)
        changed.seek(tick / 100)
        changed.command("aperture", 0.9)
        changed.run(0.6)
    with direct.record(tmp_path / "direct"):
        for number in range(tick):
            command(direct, number)
            direct.step()
        direct.command("aperture", 0.9)
        direct.run(0.6)
    one, other = lines(tmp_path / "changed"), lines(tmp_path / "direct")
    assert one == other
    assert len(one[1]) == tick + 61


def test_seek_before_the_first_step() -> None:
    simulation = Simulation(scene_of("walker"), {"walker": Driver}, seed=1)
    simulation.seek(0)
    simulation.step()
    assert simulation.ticks == 1


def test_an_agent_cannot_change_a_stored_answer() -> None:
    text = """
from actr3d.actr import *
from actr3d.simulation import BodyPort
class Taker(Model):
    body = BodyPort()
    seen = 0
    def start(self):
        answer = self.body.get("joints")
        yield answer
        self.seen = len(answer.value)
        answer.value.clear()
"""
    simulation = Simulation(scene_of("walker"), {"walker": load_text(text, "taker.py").Taker}, seed=1)
    simulation.step(60)
    seen = simulation.agents["walker"].seen
    simulation.seek(0.5)
    assert simulation.agents["walker"].seen == seen > 0


@pytest.mark.parametrize("trace", ["production", "all"])
def test_agents_that_do_less_than_the_first_time_are_an_error(trace: str) -> None:
    text = """
from actr3d.actr import *
lives = []
class Once(ACTR):
    goal = Buffer()
    def init():
        if not lives:
            goal.set("begin")
        lives.append(1)
    def go(goal="begin"): goal.set("end")
"""
    simulation = Simulation(scene_of("walker"), {"walker": load_text(text, "once.py").Once}, seed=1, trace=trace)
    simulation.step(60)
    with pytest.raises(SimulationError, match="act differently than the first time from 0"):
        simulation.seek(0.2)
    with pytest.raises(SimulationError, match="cannot go on; seek an earlier time"):
        simulation.step()


def test_an_undone_command_is_not_repeated_and_those_before_it_are(tmp_path: Path) -> None:
    simulation = driving("all")
    with simulation.record(tmp_path / "undone.sqlite"):
        simulation.run(0.2)
        simulation.command("aperture", 0.5)
        simulation.command("aperture", 0.6)
        simulation.run(0.3)
        simulation.undo()
        assert (simulation.time, simulation.furthest) == (0.2, 0.2)
        assert [command.values for command in simulation.timeline.commands] == [(0.5,)]
        simulation.run(0.3)
        undone = digest(simulation)
    once = driving("all")
    once.run(0.2)
    once.command("aperture", 0.5)
    once.run(0.3)
    assert undone == digest(once)
    with Recorded(tmp_path / "undone.sqlite") as recorded:
        assert [command.data["data"]["values"] for command in recorded.commands()] == [[0.5]]
        assert recorded.ticks == 50


def test_undo_at_the_start_and_of_a_command_that_is_not_yet_repeated() -> None:
    simulation = driving("all")
    fresh = digest(simulation)
    simulation.command("aperture", 0.5)
    simulation.undo()
    assert (simulation.time, digest(simulation)) == (0.0, fresh)
    with pytest.raises(SimulationError, match="undo: there is no command up to 0 s"):
        simulation.undo()
    simulation.run(0.2)
    simulation.command("aperture", 0.5)
    simulation.run(0.2)
    simulation.seek(0.1)
    with pytest.raises(SimulationError, match=r"undo: there is no command up to 0\.1 s"):
        simulation.undo()
    simulation.seek(0.2)
    simulation.undo()
    assert (simulation.time, simulation.furthest) == (0.2, 0.2)


def test_an_untraced_run_needs_no_memory_for_each_tick() -> None:
    history = timeline.History(cast("Any", None))
    tracemalloc.start()
    try:
        for tick in range(1, 50_001):
            history.add_tick(tick, (), None)
        assert tracemalloc.get_traced_memory()[0] < 20_000
    finally:
        tracemalloc.stop()
