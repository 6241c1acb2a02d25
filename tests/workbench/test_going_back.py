"""Going back shows what was: every answer at a past moment is the one that was given when that moment was the present."""

from __future__ import annotations

import asyncio
import json
import random
from collections.abc import Generator
from contextlib import contextmanager
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import pytest

from actr3d.actr.declarative.memory import Memory
from actr3d.actr.explain.snapshot import snapshot_of
from actr3d.actr.kernel.run_limits import RunLimits
from actr3d.actr.kernel.tree import path_of, subtree
from actr3d.actr.loading.global_seed import shared_random
from actr3d.output import printing_nothing
from actr3d.runner.model_factory import Blueprint
from actr3d.simulation import Simulation
from actr3d.trace import TraceEvent
from actr3d.values import to_json
from tests.helpers.paths import MODELS
from tests.helpers.sessions import SLOW_PROGRAM, Desk, RefusedError, Talk
from tests.simulation.test_seek import COUNTED
from workbench.overlays import OVERLAYS
from workbench.page_commands import COMMANDS, Question
from workbench.page_commands.agents import Events, Explain, MemoryRows
from workbench.page_commands.bodies import BodyState, Curves, Present, ViewQuestion
from workbench.protocol import COMMAND
from workbench.worker.names import Top
from workbench.worker.simulation_display import SimulationDisplay

KINDS = tuple(OVERLAYS)

LOOKING = """from actr3d.actr import *
from actr3d.simulation import BodyPort, Simulation
from actr3d.world import Aperture, Floor, SimpleObject, Mannequin, Scene

class Walker(ACTR):
    goal = Buffer()
    retrieval = Buffer()
    memory = Memory(retrieval)
    base, noise = DMBaseLevel(memory), DMNoise(memory, noise=0.3)
    felt = Buffer()
    body = BodyPort(felt)
    def init():
        goal.set("go 0")
        body.set("walk", 0.7, 0.1)
    def look(goal="go ?n"):
        body.request("view", rows=9 + int(n) % 3, horizontal_fov=0.5 + 0.2 * (int(n) % 5), own_limbs=int(n) > 4)
        goal.set("next ?n")
    def feel(goal="go ?n"):
        body.request("contacts")
        body.request("joints", noise=0.1)
        memory.add("felt number:?n")
        goal.set("next ?n")
    def hold(goal="next 3"):
        body.set("grasp", "cup")
        memory.request("felt")
        goal.set("go 4")
    def release(goal="next 9"):
        body.set("release")
        body.set("posture", {"torso_yaw": 0.6, "left_upper_arm_pitch": -1.0})
        goal.set("go 10")
    def on(goal="next ?n"):
        goal.set("go %d" % (int(n) + 1))

def build() -> Simulation:
    cup = SimpleObject(name="cup", size=(0.05, 0.05, 0.2), position=(0.05, -0.24, 0.66), mass=0.5)
    parts = (Floor(), Mannequin(name="walker", noise=(("pose", 0.01),)), cup, Aperture(width=1.2, position=(1.5, 0.2)))
    return Simulation(Scene(parts=parts), {"walker": Walker})
"""
"""Looks in other and other ways, feels, holds something and lets go of it."""


def asked(shown: SimulationDisplay) -> Any:
    """Returns the part of a run that questions use."""
    simulation = shown.simulation
    tops = [Top(agent) for agent in simulation.agents.values()]
    trace, clock = simulation.trace, simulation.ticks * shown.period
    assert trace is not None

    def events(first: int, end: int) -> list[TraceEvent]:
        return trace.since(first)[: end - first]

    def same(_: str, time: int) -> int:
        return time

    times = {"clock": clock, "events": events, "own_time": same, "whole_time": same}
    return SimpleNamespace(trace=trace, tops=lambda: tops, shown=shown, curves=shown.curves, **times)


def questions(shown: SimulationDisplay) -> list[Any]:
    """Returns every question that a page can ask of a moment; a new kind of question is to be added here."""
    agents = shown.simulation.agents.values()
    memories = [path_of(part) for mind in agents for part in subtree(mind) if isinstance(part, Memory)]
    bodies = [*shown.simulation.world.bodies]
    wanted: list[Any] = [Explain(), *(Explain(at=share * shown.simulation.time) for share in (0.3, 0.9)), Events(most=20_000)]
    wanted += [MemoryRows(memory=memory) for memory in memories]
    wanted += [kind(body=body) for body in bodies for kind in (ViewQuestion, BodyState)]
    wanted += [Present(word="move", named={"object": name}) for name in shown.simulation.world.objects.names]
    known = {kind for kind in COMMANDS.values() if issubclass(kind, Question)}
    assert {type(one) for one in wanted} | {MemoryRows, ViewQuestion, BodyState, Curves, Present} == known
    return wanted


def told(shown: SimulationDisplay) -> dict[str, Any]:
    """Returns all that is shown of the present, as JSON by what it is."""
    physics, apertures = shown.scene()
    parts: dict[str, Any] = {}
    for mind in shown.simulation.agents.values():
        parts |= snapshot_of(mind)
    drawn = {kind: _plain(value) for kind, value in shown.overlay_data(KINDS).items()}
    now: dict[str, Any] = {"physics": physics.hex(), "apertures": apertures, "parts": parts, "result": shown.result()}
    now |= {f"drawn {kind}": value for kind, value in drawn.items()}
    now |= {"touches": sorted(shown.touches()), "time": shown.simulation.time}
    now |= {repr(question): question.answer(asked(shown)) for question in questions(shown)}
    return {name: json.loads(to_json(value)) for name, value in now.items()} | {"curves": curves_until(shown, shown.simulation.time)}


def curves_until(shown: SimulationDisplay, time: float) -> dict[float, Any]:
    """Returns the curves up to a time: what lies ahead may be known or not."""
    answer = json.loads(to_json(Curves(most=5_000).answer(asked(shown))))
    names = sorted(answer["curves"])
    return {at: [answer["curves"][name][n] for name in names] for n, at in enumerate(answer["times"]) if at <= time}


def _plain(value: Any) -> Any:
    if isinstance(value, bytes):
        return value.hex()
    return {name: _plain(one) for name, one in cast("dict[str, Any]", value).items()} if isinstance(value, dict) else value


@contextmanager
def shown_of(source: str, seed: int, **settings: Any) -> Generator[SimulationDisplay]:
    """Builds what a text describes, as a worker does."""
    with RunLimits(seed=seed), shared_random(seed), printing_nothing():
        simulation, _ = Blueprint(source, str(MODELS / "model.py"), MODELS).build(settings)
        simulation.traced()
        yield SimulationDisplay(simulation)


def go(simulation: Simulation, tick: int) -> None:
    """Goes on to a tick, if the run comes so far."""
    while simulation.ticks < tick and simulation.run(simulation.period).ended_by != "stop":
        pass


def check_going_back(shown: SimulationDisplay, ticks: int, moments: int, random_seed: int) -> None:
    """Runs a simulation, asks everything at random moments, and again after going there in a random order, by every way there is."""
    chance, simulation = random.Random(random_seed), shown.simulation
    chosen = sorted({0, 1, ticks, *chance.sample(range(ticks), moments)})
    first: dict[int, dict[str, Any]] = {}
    for tick in chosen:
        go(simulation, tick)
        first[simulation.ticks] = told(shown)
    seek(shown, first, chance)
    # A command in the past makes the run go another way; what lies before is still as it was.
    middle = sorted(first)[len(first) // 2]
    simulation.seek(middle * simulation.period)
    body, word, values = command_of(simulation)
    before = {tick: answers for tick, answers in first.items() if tick <= middle}
    simulation.command(word, *values, body=body)
    after: dict[int, dict[str, Any]] = {}
    for more in (7, 60):
        go(simulation, middle + more)
        after[simulation.ticks] = told(shown)
    assert all(after[tick] != first[tick] for tick in after.keys() & first.keys() if tick > middle)
    seek(shown, before | after, chance)


def seek(shown: SimulationDisplay, known: dict[int, dict[str, Any]], chance: random.Random) -> None:
    simulation = shown.simulation
    order = [*known]
    for tick in chance.sample(order, len(order)):
        way = chance.choice(("seek", "step"))
        simulation.seek((tick if way == "seek" or tick == 0 else tick - 1) * simulation.period)
        go(simulation, tick)
        now = told(shown)
        wrong = [name for name in known[tick].keys() | now.keys() if known[tick].get(name) != now.get(name)]
        assert wrong == [], f"after going to tick {tick} by {way}: {wrong}"


def command_of(simulation: Simulation) -> tuple[str | None, str, tuple[Any, ...]]:
    if not simulation.world.bodies:
        return None, "parameter", (f"{next(iter(simulation.agents))}.production_time", 0.06)
    return next(iter(simulation.world.bodies)), "teleport", (-0.3, 0.2, 0.1)


@pytest.mark.slow
def test_every_answer_is_that_of_its_moment_for_a_model_that_looks_in_many_ways() -> None:
    with shown_of(LOOKING, 3) as shown:
        check_going_back(shown, 160, 5, random_seed=1)


def test_the_eye_sees_what_its_field_of_view_shows_from_the_start_on(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, (MODELS / "aperture_passage.py").read_text(encoding="utf-8"), settings={"aperture": 0.45})
    seen = {time: at(talk, time, "until") for time in (0.0, 4.0, 6.0)}
    assert {time: at(talk, time, "seek") for time in (4.0, 0.0)} == {time: seen[time] for time in (4.0, 0.0)}


def test_a_run_that_cannot_be_repeated_because_of_a_global_variable_fails_and_says_why(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, COUNTED.replace("KEPT", "count"))
    talk.say("until", time=2)
    talk.until("paused", time=2)
    with pytest.raises(RefusedError, match="act differently than the first time"):
        talk.say("seek", time=1)
    assert "such as a global variable" in talk.until("failed")["reason"]
    with pytest.raises(RefusedError, match="the run is over"):
        talk.say("run")
    talk.say("restart")
    talk.until("paused", time=0)


def at(talk: Talk, time: float, way: str) -> Any:
    if talk.state["time"] != time:
        talk.say(way, time=time)
        talk.until("paused", time=time)
    return talk.say("view")


def told_of_program(talk: Talk) -> dict[str, Any]:
    """Returns all that is shown of the present of a program."""
    state = talk.state
    memories = [name for name, part in state["parts"].items() if part["is"] == "memory"]
    now: dict[str, Any] = {name: state[name] for name in ("tick", "time", "events", "parts", "result", "apertures")}
    now |= {"explain": talk.say("explain"), "at first": talk.say("explain", at=0), "log": talk.say("events", most=20_000)}
    return now | {memory: talk.say("memory", memory=memory) for memory in memories}


def check_program(talk: Talk, moments: int) -> None:
    """Runs a program to random times, and again after going there in a random order."""
    chance = random.Random(moments)
    talk.say("run")
    end = talk.until("ended")["time"]
    seen: dict[float, dict[str, Any]] = {}
    talk.say("restart")
    talk.until("paused", time=0)
    for time in sorted({0.0, *(round(chance.uniform(0, end), 3) for _ in range(moments))}):
        if time:
            talk.say("until", time=time)
            talk.until("paused", time=time)
        seen[time] = told_of_program(talk)
    order = [*seen]
    for time in chance.sample(order, len(order)):
        talk.say("seek", time=time)
        talk.until("paused", time=time)
        now = told_of_program(talk)
        assert [name for name in now if now[name] != seen[time][name]] == [], f"at {time} s"


DAILY = ("compilation", "sgoms", "two_agents")
TUTORIAL = [
    pytest.param(path, marks=() if path.stem in DAILY else pytest.mark.slow, id=path.stem)
    for path in sorted((MODELS / "tutorial").glob("*.py"))
]


@pytest.mark.parametrize("path", TUTORIAL)
def test_every_answer_is_that_of_its_moment_for_tutorial_models(desk: Desk, tmp_path: Path, path: Path) -> None:
    check_program(desk.begin(tmp_path, path.read_text(encoding="utf-8")), 3)


@pytest.mark.slow
def test_every_answer_is_that_of_its_moment_in_a_whole_run() -> None:
    source = (MODELS / "aperture_passage.py").read_text(encoding="utf-8")
    with shown_of(source, 1, aperture=0.4) as shown:
        check_going_back(shown, 1_300, 6, random_seed=1)


@pytest.mark.slow
def test_a_program_shows_how_far_it_has_come_on_its_way_to_an_earlier_time(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, SLOW_PROGRAM, run=True, wait="ended")
    events = talk.state["events"]
    talk.say("seek", time=6.0)
    on_the_way = talk.wait(lambda: talk.state["status"] == "running" and 0 < talk.state["time"] < 5)
    assert on_the_way["reason"] == "going to 6 s"
    assert on_the_way["furthest"] == pytest.approx(6.02)
    there = talk.until("paused", time=6.0)
    assert there["reason"] == "went to this time"
    talk.say("run")
    assert talk.until("ended")["events"] == events


@pytest.mark.slow
def test_a_program_can_be_paused_on_its_way_to_another_time(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, SLOW_PROGRAM, run=True, wait="ended")
    events = talk.state["events"]
    talk.say("seek", time=6.0)
    talk.wait(lambda: talk.state["status"] == "running" and 0 < talk.state["time"] < 5)
    talk.say("pause")
    paused = talk.until("paused")
    assert (paused["reason"], 0 < paused["time"] < 6.0) == ("by the user", True)
    assert talk.say("explain", production="count")
    talk.say("run")
    assert talk.until("ended")["events"] == events


@pytest.mark.slow
def test_a_program_on_its_way_to_a_time_goes_to_another_at_once_and_does_the_rest_when_it_is_there(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, SLOW_PROGRAM, run=True, wait="ended")
    talk.say("seek", time=6.0)
    talk.wait(lambda: talk.state["status"] == "running" and 1 < talk.state["time"] < 5)
    talk.say("seek", time=0.5)
    talk.until("paused", time=0.5)
    talk.say("seek", time=3.0)
    talk.say("step")
    talk.until("paused", time=3.01)


def on_the_way(talk: Talk, to: float) -> dict[str, Any]:
    """Goes to a time of a slow program that has ended; returns a state on the way."""
    talk.say("seek", time=to)
    return talk.wait(lambda: talk.state["status"] == "running" and 0.5 < talk.state["time"] < to - 1)


def test_a_program_that_is_stopped_on_its_way_stays_there_says_where_it_went_and_can_go_on(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, SLOW_PROGRAM, run=True, wait="ended")
    events = talk.state["events"]
    talk.say("seek", time=0)
    talk.until("paused", time=0)
    talk.say("breakpoints", productions=["count"])
    talk.say("run")
    talk.wait(lambda: talk.state["breakpoint"] == "count")
    talk.say("breakpoints", productions=[])
    assert on_the_way(talk, 6.0)["target"] == 6.0
    talk.say("stop")
    stopped = talk.until("paused")
    assert (stopped["reason"], stopped["target"], stopped["breakpoint"]) == ("stopped while going to 6 s", None, None)
    assert 0 < stopped["time"] < 6.0 < stopped["furthest"]
    talk.say("run")
    assert talk.until("ended")["events"] == events
    talk.say("stop")
    talk.wait(lambda: not talk.session.alive)


@pytest.mark.slow
def test_a_program_that_does_not_answer_on_its_way_is_ended_by_stop(desk: Desk, tmp_path: Path) -> None:
    again = tmp_path / "again"
    talk = desk.begin(
        tmp_path,
        SLOW_PROGRAM.replace("0.01", f"60 if n == '40' and os.path.exists({str(again)!r}) else 0.01").replace("time\n", "time, os\n", 1),
    )
    talk.say("until", time=4.0)
    talk.until("paused", time=4.0)
    again.touch()
    talk.say("seek", time=3.0)
    talk.wait(lambda: talk.facts["stuck"])
    assert talk.state["target"] == 3.0
    talk.say("stop")
    talk.wait(lambda: not talk.session.alive)


@pytest.mark.slow
def test_steps_back_on_the_way_are_counted_from_where_the_user_goes(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, SLOW_PROGRAM, run=True, wait="ended")
    on_the_way(talk, 4.0)
    talk.say("back")
    talk.say("back", ticks=2)
    assert talk.until("paused")["time"] == 3.97


def test_the_answer_to_going_elsewhere_comes_with_a_state_that_shows_where(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, SLOW_PROGRAM, run=True, wait="ended")
    talk.say("seek", time=6.0)
    assert talk.state["target"] == 6.0
    talk.say("seek", time=0.02)
    assert 0.02 in (talk.state["target"], talk.state["time"])


def test_what_a_user_wants_while_a_change_is_undone_happens_after_it(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, SLOW_PROGRAM)
    talk.say("until", time=4.0)
    talk.until("paused", time=4.0)
    talk.say("command", word="set_buffer", named={"buffer": "goal", "chunk": "count 7"})
    talk.say("until", time=4.5)
    talk.until("paused", time=4.5)
    talk.say("undo", drop=True)
    assert talk.state["target"] == 4.0
    seek, pause = (COMMAND.validate_python(one) for one in ({"type": "seek", "time": 2.0}, {"type": "pause"}))

    async def both() -> None:
        await asyncio.gather(seek.submit(talk.session, "test"), pause.submit(talk.session, "test"))

    desk.do(both())
    assert talk.until("paused")["time"] == 2.0
