"""Lockstep: agents and bodies share exactly the same time, independent of the wall clock and of observers."""

from __future__ import annotations

import gc
import random
import threading
import time
import tracemalloc
from collections import Counter
from collections.abc import Callable
from dataclasses import asdict, dataclass
from datetime import date
from functools import partial
from pathlib import Path
from typing import Any, cast

import numpy as np
import pytest

from actr3d.actr import ACTR, Buffer, Model
from actr3d.actr.kernel.model import ensure_converted
from actr3d.actr.kernel.run_limits import RunLimits
from actr3d.actr.loading import load_text
from actr3d.errors import Actr3dError, SchedulerError, SimulationError, WorldError
from actr3d.recording import Recorded
from actr3d.simulation import Glimpse, Simulation, agents, timeline
from actr3d.simulation.agents import Environment
from actr3d.trace import Trace, TraceEvent
from actr3d.world import Body, Floor, Mannequin, Scene, Wall, World
from actr3d.world.body import SENSORS, sensor
from tests.helpers.small_agents import near
from tests.helpers.walkers import Driver, digest, driving, scene_of

AGENTS: Any = load_text(
    """
from actr3d.actr import *

class Asker(ACTR):
    goal = Buffer()
    felt = Buffer()
    body = BodyPort(felt)
    def init():
        goal.set("ask")
    def ask(goal="ask"):
        self.times = [("asked", self.now())]
        self.story()
        goal.set("wait")
    def story(self):
        reading = self.body.get("pose")
        self.times.append(("busy", self.body.busy))
        yield reading
        self.times.append(("answered", self.now(), reading.value, self.body.busy))
        self.body.set("waypoint", 0.2, 0, speed=1.0)
        yield 0.3
        first, second = self.body.get("pose"), self.body.get("pose", "head")
        yield first
        yield second
        self.times.append(("arrived", first.value, second.value))
        self.body.request("gyroscope")

    def feel(goal="wait", felt="gyroscope ?x ? ?z", body="error:False"):
        self.times.append(("felt", self.now(), x))
        body.request("rangefinder", reach=20)
        goal.set("fail")
    def nothing(goal="fail", felt=None, body="error:True"):
        self.times.append(("nothing", self.now()))
        goal.clear()

class Edge(Model):
    done = ()
    def start(self):
        yield 0.01
        self.done += ("exactly at the end",)
        yield 0.000001
        self.done += ("just after",)

class Stopper(Model):
    ticks = 0
    def start(self):
        yield 0.025
        self.stop()
        yield 0.005
        self.ticks = "to the end of its tick"

class First(Model):
    def start(self):
        for _ in range(3):
            yield 0.01
            self.parent.said.append((self.name, self.now()))

class Idle(ACTR):
    pass

class Wrong(Model):
    def start(self):
        yield 0.02
        self.body.set("wlk", 1)

class Early(Model):
    def start(self):
        yield 0.01
        self.body.get("pose").value
""",
    "agents.py",
)
BodyPort = AGENTS.BodyPort


def with_port(kind: Any) -> Any:
    return type(kind.__name__, (kind,), {"body": BodyPort()})


@pytest.fixture(name="asked")
def asked_(monkeypatch: pytest.MonkeyPatch) -> Counter[str]:
    """Counts the requests to bodies, by name."""
    counts: Counter[str] = Counter()
    get = Body.get

    def counting(self: Body, word: str, *values: Any, **options: Any) -> Any:
        counts[self.name] += 1
        return get(self, word, *values, **options)

    monkeypatch.setattr(Body, "get", counting)
    return counts


def test_agents_run_in_a_tick_and_bodies_move_and_answer_in_a_tock() -> None:
    simulation = Simulation(scene_of("walker"), {"walker": AGENTS.Asker}, seed=1, trace="all")
    simulation.run(1.0)
    agent: Any = simulation.agents["walker"]
    asked, busy, answered, arrived, felt, nothing = agent.times
    assert (asked, busy) == (("asked", 0.05), ("busy", True))
    assert answered[:2] == ("answered", 0.05)  # requested at the very end of a tick, answered when the next begins
    assert (answered[2].x, answered[2].y, answered[2].heading) == near((0, 0, 0), abs=1e-6)
    assert answered[3] is False
    assert arrived[1].x == near(0.2, abs=1e-3)
    assert arrived[2].z > arrived[1].z + 0.5
    assert float(felt[2]) == near(0, abs=1e-2)
    assert nothing[0] == "nothing"
    assert simulation.trace is not None
    kinds = [(event.kind, event.data.get("call"), event.data.get("word")) for event in simulation.trace.select("request", "walker.body")]
    assert kinds == [("request", call, word) for call, word in REQUESTS]
    answers = simulation.trace.select("answer", "walker.body")
    assert [event.data["word"] for event in answers] == ["pose", "pose", "pose", "gyroscope", "rangefinder"]
    assert answers[0].data["value"] == asdict(answered[2])
    assert (answers[3].data["value"][2], answers[4].data["value"]) == (near(0, abs=1e-2), None)


REQUESTS = [("get", "pose"), ("set", "waypoint"), ("get", "pose"), ("get", "pose"), ("request", "gyroscope"), ("request", "rangefinder")]


def test_events_at_the_very_end_of_a_tick_belong_to_it() -> None:
    simulation = Simulation(Scene(), bodiless={"edge": AGENTS.Edge})
    edge: Any = simulation.agents["edge"]
    simulation.tick()
    assert edge.done == ("exactly at the end",)
    simulation.tock()
    simulation.step()
    assert edge.done == ("exactly at the end", "just after")


@pytest.mark.parametrize(("period", "timestep"), [(0.01, 0.002), (0.001, 0.001), (0.05, 0.0025)])
def test_both_clocks_agree_exactly(period: float, timestep: float) -> None:
    simulation = Simulation(scene_of("walker", timestep=timestep), {"walker": Driver}, period=period, seed=3)
    for _ in range(200):
        simulation.step()
        assert simulation.agents["walker"].sch.now_us == simulation.world.time == round(simulation.ticks * period * 1e6)
    assert simulation.time == near(200 * period)


@pytest.mark.parametrize("period", [0.003, 0.0, -0.01, 0.0101, float("nan")])
def test_the_period_must_be_a_whole_multiple_of_the_physics_step(period: float) -> None:
    with pytest.raises(Actr3dError, match=r"Simulation\.period"):
        Simulation(Scene(parts=(Floor(),)), period=period)


def test_one_seed_gives_the_same_bytes_in_one_run_or_in_steps_with_pauses_and_at_any_speed() -> None:
    long, single, paced, other = (driving("all") for _ in range(4))
    long.run(1.5)
    for _ in range(150):
        single.tick()
        single.tock()
    paced.run(0.5, real_time=20)
    time.sleep(0.05)
    paced.run(until=lambda seen: seen.time >= 1.5)
    other = driving("all", seed=2)
    other.run(1.5)
    assert digest(long) == digest(single) == digest(paced) != digest(other)


def test_observers_see_everything_and_change_nothing() -> None:
    alone, watched = driving("all"), driving("all")
    seen: list[tuple[int, float, int]] = []
    events: list[Any] = []

    def look(glimpse: Glimpse) -> None:
        glimpse.mj_data.qpos[:] = 0  # its own copy
        seen.append((glimpse.tick, glimpse.time, glimpse.mj_data.ncon))
        glimpse.state().mj_state[:] = 0
        for mj_model in (glimpse.mj_model, glimpse.mj_data.model):
            mj_model.opt.gravity[:] = 0
            mj_model.body_mass[:] = 1

    watched.observe(look)
    watched.listen(events.append)
    alone.run(1)
    watched.run(1)
    assert digest(alone) == digest(watched)
    assert [tick for tick, _, _ in seen] == list(range(1, 101))
    assert seen[-1][1] == 1.0
    assert watched.trace is not None
    assert events == list(watched.trace)


def test_a_failing_listener_ends_the_run_after_its_tick_and_the_run_can_continue() -> None:
    simulation, other = driving("all"), driving("all")

    def listener(event: Any) -> None:
        if event.kind == "fire" and event.time == 0.05:
            raise OSError("nobody hears")

    simulation.listen(listener)
    with pytest.raises(OSError, match="nobody hears"):
        simulation.run(0.5)
    assert simulation.time == 0.05
    simulation.run(0.45)
    other.run(0.5)
    assert digest(simulation) == digest(other)


def test_an_observer_cannot_step_what_it_observes() -> None:
    simulation = driving()
    simulation.observe(lambda seen: simulation.step())
    with pytest.raises(SimulationError, match="observers, listeners and `until` cannot"):
        simulation.step()


@pytest.mark.parametrize("look", ["listen", "until"])
def test_listeners_and_conditions_are_observers_too(look: str) -> None:
    simulation, errors = driving("all"), list[str]()

    def meddle(_: object) -> bool:
        for change in (simulation.step, simulation.tock, lambda: simulation.seek(0), lambda: simulation.command("aperture", 1.0)):
            with pytest.raises(SimulationError, match="observers, listeners and `until` cannot") as caught:
                change()
            errors.append(str(caught.value))
        return False

    if look == "listen":
        simulation.listen(meddle)
        simulation.step(5)
    else:
        simulation.run(0.05, until=meddle)
    assert len(errors) >= 20
    plain = driving("all")
    plain.step(5)
    assert digest(simulation) == digest(plain)


RUNNERS: Any = load_text(
    """
from actr3d.actr import *

class Runner(ACTR):
    goal = Buffer()

    def init():
        goal.set("run")

    def begin(goal="run"):
        act[0](self)
        goal.clear()
""",
    "runners.py",
)


def running(act: Callable[[Any], object]) -> Simulation:
    """Returns a simulation whose agent does something with itself in a production."""

    def agent() -> Any:
        runner = RUNNERS.Runner()
        runner.act = [act]
        return runner

    return Simulation(scene_of("walker"), {"walker": agent}, seed=1)


@pytest.mark.parametrize("method", ["run(0.1)", "step()", "tick()", "tock()", "seek(0)", "undo()", "command('walk', 1.0, body='walker')"])
def test_an_agent_cannot_run_or_change_the_simulation_that_runs_it(method: str) -> None:
    simulation = running(lambda agent: eval(f"simulation.{method}", {"simulation": simulation}))
    simulation.command("walk", 0.5, body="walker")
    with pytest.raises(SimulationError, match="an agent or a body cannot run or change the simulation that runs it"):
        simulation.run(0.1)


@pytest.mark.parametrize("use", ["agents", "run(1)"])
def test_what_makes_an_agent_cannot_use_the_agents(use: str) -> None:
    simulation = Simulation(scene_of("walker"), {"walker": lambda: eval(f"simulation.{use}", {"simulation": simulation})}, seed=1)
    with pytest.raises(SimulationError, match="a function that makes an agent cannot use the agents"):
        simulation.run(0.1)


def test_an_agent_of_a_simulation_cannot_run_by_itself_and_lose_lockstep() -> None:
    def run_alone(agent: Any) -> None:
        agent.run(1)

    simulation = running(run_alone)
    with pytest.raises(SchedulerError, match="'walker' is part of a simulation, which runs its agents in lockstep"):
        run_alone(simulation.agents["walker"])
    assert simulation.agents["walker"].now() == simulation.time == 0
    with pytest.raises(SchedulerError, match="yield a number of seconds"):
        simulation.run(0.1)


def test_a_glimpse_shows_positions_of_its_own_moment() -> None:
    simulation = Simulation(scene_of("walker"))
    simulation.command("walk", 1.0)
    places: list[tuple[float, float]] = []
    simulation.observe(lambda seen: places.append((float(seen.mj_data.body("walker").xpos[0]), float(seen.mj_data.qpos[0]))))
    simulation.step(3)
    assert all(shown == near(state, abs=1e-12) for shown, state in places)
    assert places[-1][0] > places[0][0] > 0


def test_a_body_without_an_agent_and_an_agent_without_a_body(asked: Counter[str]) -> None:
    simulation = Simulation(scene_of("walker", "empty"), {"walker": Driver}, bodiless={"watcher": AGENTS.First}, seed=1)
    environment: Any = simulation.agents["watcher"].parent
    said: list[tuple[str, float]] = []
    environment.said = said
    simulation.run(0.5)
    assert asked["walker"] > 0
    assert asked["empty"] == 0
    assert simulation.world.bodies["empty"].get("pose").x == near(0, abs=1e-6)
    assert said == [("watcher", 0.01), ("watcher", 0.02), ("watcher", 0.03)]


def test_simultaneous_events_of_several_agents_have_one_order() -> None:
    simulation = Simulation(Scene(), bodiless={"b": AGENTS.First, "a": AGENTS.First, "c": AGENTS.First})
    environment: Any = simulation.agents["a"].parent
    said: list[tuple[str, float]] = []
    environment.said = said
    simulation.run(0.03)
    assert said == [(name, tick / 100) for tick in (1, 2, 3) for name in "bac"]


def test_an_agent_that_calls_stop_ends_the_run_with_its_tick() -> None:
    simulation = Simulation(scene_of("walker"), {"walker": AGENTS.Stopper})
    report = simulation.run(1)
    agent: Any = simulation.agents["walker"]
    assert (report.ended_by, report.ticks, simulation.time, agent.ticks) == ("stop", 3, 0.03, "to the end of its tick")
    assert agent.now() == simulation.time
    assert simulation.run(0.02).ended_by == "seconds"


def test_advance_runs_up_to_a_number_of_ticks_and_ends_with_the_run() -> None:
    simulation = Simulation(scene_of("walker"), {"walker": AGENTS.Stopper})
    assert (simulation.advance(2), simulation.ticks) == (None, 2)
    assert (simulation.advance(5), simulation.ticks) == ("stop", 3)
    assert (simulation.advance(5), simulation.ticks) == ("done", 4)  # nothing prevents one more
    with pytest.raises(SimulationError, match=r"advance\(most\)"):
        simulation.advance(-1)


def test_advance_gives_the_same_bytes_as_single_steps() -> None:
    some, single = driving("all"), driving("all")
    for most in (1, 40, 59):
        some.advance(most)
    for _ in range(100):
        single.step()
    assert digest(some) == digest(single)


def test_a_run_without_limits_ends_when_no_agent_has_anything_left_to_do() -> None:
    simulation = Simulation(scene_of("walker"), {"walker": AGENTS.Asker})
    report = simulation.run()
    assert report.ended_by == "done"
    assert simulation.agents["walker"].times[-1][0] == "nothing"
    assert Simulation(Scene(), bodiless={"idle": AGENTS.Idle}).run(0.05).ticks == 5


def test_a_run_without_limits_continues_until_bodies_have_reached_their_targets() -> None:
    simulation = Simulation(scene_of("walker", "other"))
    walker, other = simulation.world.bodies.values()
    simulation.command("waypoint", 0.2, 0, speed=1.0, body="walker")
    simulation.command("position", "head_yaw", 0.5, body="other")
    assert simulation.advance(2) is None
    assert (simulation.run().ended_by, simulation.ticks) == ("done", 25)
    assert (*walker.base.pose[:2], other.joints["head_yaw"].position) == near((0.2, 0, 0.5))
    simulation.command("walk", 0.5, body="walker")  # has no end
    assert simulation.run().ticks == 0


def test_a_movement_that_something_blocks_does_not_keep_a_run_going() -> None:
    wall = Wall(name="wall", start=(0.6, -1), end=(0.6, 1), height=1.5)
    simulation = Simulation(Scene(parts=(Floor(), wall, Mannequin(name="walker"))))
    walker = simulation.world.bodies["walker"]
    simulation.command("waypoint", 2, 0.1)
    assert simulation.run().ended_by == "done"
    assert 0.1 < walker.base.pose[0] < 0.6
    simulation.command("waypoint", 0, 0)  # it is still at rest, but it can go there
    assert simulation.run().ended_by == "done"
    assert walker.base.pose[:2] == near((0, 0))


def test_until_is_checked_after_each_tock() -> None:
    simulation = driving()
    report = simulation.run(until=lambda seen: seen.tick == 7)
    assert (report.ended_by, report.ticks, report.simulated) == ("until", 7, 0.07)


def test_real_time_is_kept_and_measured_and_lateness_reported() -> None:
    simulation = Simulation(Scene(), bodiless={"idle": AGENTS.Idle})
    report = simulation.run(0.2, real_time=2)
    assert report.wall >= 0.1  # never faster than requested
    assert report.factor == near(report.simulated / report.wall)
    simulation.observe(lambda seen: time.sleep(0.005))
    late = simulation.run(0.05, real_time=100)
    assert (late.ticks, late.late_ticks) == (5, 5)  # none is skipped
    assert late.latest > 0.02
    with pytest.raises(SimulationError, match=r"real_time\): must be a finite number > 0"):
        simulation.run(1, real_time=0)


def test_commands_work_between_steps_on_world_bodies_and_agents() -> None:
    simulation = driving("all")
    simulation.step(3)
    simulation.command("aperture", width=0.4)
    simulation.command("posture", {"torso_yaw": 0.1}, body="walker")
    simulation.command("parameter", "walker.looks", 100)
    simulation.command("parameter", "other.body.error", True)
    assert simulation.world.aperture_width() == near(0.4)
    simulation.run(0.5)
    assert simulation.agents["walker"].looks > 100
    assert simulation.trace is not None
    commands = simulation.trace.select("command")
    assert [(e.time, e.data["command"]) for e in commands] == [(0.03, c) for c in ("aperture", "posture", "parameter", "parameter")]


def odd(value: Any) -> Any:
    """Returns a value without its type, to pass it where another type is required."""
    return value


WRONG: list[tuple[Callable[[Any], object], str]] = [
    (lambda s: s.command("apertur", 1), r"no command 'apertur'; did you mean 'aperture'\? Name its body: walker, other"),
    (lambda s: s.command("stop", body="walkr"), r"no body 'walkr'; did you mean 'walker'\?"),
    (lambda s: s.command("stp", body="walker"), r"has no actuator 'stp'; did you mean 'stop'"),
    (lambda s: s.command("aperture", object()), "numbers, texts, and tuples and dicts of these"),
    (lambda s: s.command("aperture", 1, colour=2), r"command 'aperture': .*unexpected keyword argument 'colour'"),
    (lambda s: s.command("aperture", -1), r"aperture\.width: must be >= 0"),
    (lambda s: s.command("parameter", "walkr.looks", 1), r"no part 'walkr'; did you mean 'walker'"),
    (lambda s: s.command("parameter", "walker.look", 1), r"'walker' has no 'look'; did you mean 'looks'"),
    (lambda s: s.command(5), r"command and body must be text \(got 5\)"),
    (lambda s: s.command("stop", body=7), r"must be text \(got 7\)"),
    (lambda s: s.command("parameter", 5, 1), r"parameter.path: must be text \(got 5\)"),
    (lambda s: s.step(-1), r"step\(n\): must be a whole number >= 0 \(got -1\)"),
    (lambda s: s.step(1.5), r"step\(n\): must be a whole number >= 0 \(got 1\.5\)"),
    (lambda s: s.run(1, real_time="2"), r"run\(real_time\): must be a finite number > 0 \(got '2'\)"),
    (lambda s: s.run(1, real_time=float("inf")), r"run\(real_time\): must be a finite number > 0 \(got inf\)"),
    (lambda s: s.observe(5), r"observe\(observer\): must be a function that takes a Glimpse \(got 5\)"),
    (lambda s: s.listen(None), r"listen\(listener\): must be a function that takes a TraceEvent \(got None\)"),
    (lambda s: Simulation(s.world.scene).measure(odd(5)), r"measure\(measure\): must be an object with the methods .* \(got 5\)"),
    (lambda s: Simulation(s.world.scene).measure(odd(Counter)), r"measure\(measure\): must be an object with .*Counter"),
    (lambda s: s.run(until=True), r"run\(until\): must be a function that takes a Glimpse \(got True\)"),
    (lambda s: Simulation(odd(None)), r"got None\); an agent without a body .* plain assignments at the top of the file"),
    (lambda s: Simulation(odd("room")), r"Simulation\.scene: must be a Scene or a World \(got 'room'\)"),
    (lambda s: (s.step(2), Simulation(s.world)), r"the world must be at its start, as the agents are \(got one at 0\.02 s\)"),
    (
        lambda s: Simulation(Scene(), seed=odd(1.5)),
        r"Simulation\.seed: must be a whole number >= 0 or a text .*got 1\.5",
    ),
    (lambda s: Simulation(Scene(), seed="\ud800"), r"Simulation\.seed: must be a whole number >= 0 or a text of printable characters"),
    (lambda s: Simulation(Scene(), seed=-1), r"Simulation\.seed: must be a whole number >= 0 or a text .*got -1"),
    (
        lambda s: Simulation(Scene(), odd(["walker"])),
        r"Simulation\.agents: must be a dict with the class or function that makes each agent, such as",
    ),
    (
        lambda s: Simulation(Scene(), bodiless={"": Driver}),
        r"Simulation\.bodiless: an agent's name must be a text that does",
    ),
    (lambda s: Simulation(Scene(), bodiless={"sch": Driver}).step(), "cannot be named 'sch'"),
    (lambda s: Simulation(Scene(), bodiless={"parent": Driver}).step(), "cannot be named 'parent'"),
    (lambda s: s.tock(), "tock: call tick"),
    (lambda s: (s.tick(), s.tick()), r"call tock\(\) first"),
    (lambda s: (s.tick(), s.command("aperture", 1)), r"call tock\(\) first"),
    (lambda s: s.run(0.015), "must be a whole number of ticks of 0.01 s"),
    (lambda s: s.listen(print), "nothing is traced"),
    (lambda s: Simulation(s.world, {"walkr": Driver}), r"no body 'walkr' in the scene; did you mean 'walker'"),
    (lambda s: Simulation(s.world, bodiless={"walker": Driver}), "'walker' is the name of a body"),
    (lambda s: Simulation(Scene(), {"x": Driver}), "no body 'x' in the scene; there are: none"),
    (lambda s: Simulation(s.world, dict[str, Any](walker=3)).step(), "must be an agent's class"),
    (lambda s: Simulation(s.world, {"walker": dict}).step(), r"must make an agent \(made \{\}\)"),
    (lambda s: Simulation(Scene(), bodiless={"run": Driver}).step(), "cannot be named 'run'"),
    (lambda s: Simulation(Scene(), bodiless={"a": Driver}).run(0.1), "has no body"),
    (lambda s: Simulation(s.world, trace="some"), "no level 'some'"),
    (lambda s: Simulation(s.world, trace=cast("Any", None)), "no level None; use one of none"),
    (lambda s: Simulation(s.world, trace=cast("Any", [])), r"no level \[\]; use one of none"),
    (lambda s: s.command("stop", body=[]), r"command and body must be text \(got \[\]\)"),
    (lambda s: BodyPort().set("walk", 1), "'walk' is sent to a body before the agent runs; send it while its Simulation runs"),
    (lambda s: with_port(AGENTS.Idle)().body.get("pose"), "'pose' is sent to a body before the agent runs"),
    (lambda s: BodyPort(Buffer()).request("pose"), "'pose' is sent to a body before the agent runs"),
    (lambda s: Simulation(s.world, {"walker": with_port(AGENTS.Early)}).run(0.1), "has not answered 'pose' yet"),
]


@pytest.mark.parametrize(("wrong", "message"), WRONG)
def test_errors_say_what_is_wrong(wrong: Callable[[Simulation], object], message: str) -> None:
    with pytest.raises(Actr3dError, match=message):
        wrong(driving())


def test_a_port_that_joins_another_agent_asks_that_agents_body() -> None:
    simulation = Simulation(scene_of("first", "second"), {name: with_port(AGENTS.Idle) for name in ("first", "second")})
    simulation.run(0.01)
    agents_here = simulation.timeline.lockstep.agents
    first, second = (getattr(agents_here.environment, name) for name in ("first", "second"))
    port = first.body
    port.get("pose")
    port.parent = None
    second.borrowed = port
    port.get("pose")
    assert [request.body for request in agents_here.outbox] == ["first", "second"]


class Returned:
    """A measure that returns a given result."""

    def __init__(self, returned: Any) -> None:
        self.returned = returned

    def begin(self, world: World) -> None:
        pass

    def look(self) -> None:
        pass

    def result(self, *, over: bool) -> Any:
        return self.returned


@pytest.mark.parametrize("returned", [{"a": 1}, 1.5, Returned])
def test_a_result_that_is_not_of_a_dataclass_is_an_error_that_names_the_measure(returned: Any) -> None:
    simulation = Simulation(Scene(parts=(Floor(),)))
    simulation.measure(Returned(returned))
    with pytest.raises(SimulationError, match=r"^Returned\.result: must return an object of a dataclass \(returned "):
        simulation.result()


@dataclass
class Judged:
    """A result that JSON cannot represent."""

    kinds: set[int]
    since: date


def test_a_result_that_json_cannot_represent_is_recorded_as_it_is_traced(tmp_path: Path) -> None:
    simulation = Simulation(Scene(parts=(Floor(),)))
    simulation.measure(Returned(Judged({2, 1}, date(2026, 1, 31))))
    heard: list[TraceEvent] = []
    simulation.traced()
    simulation.listen(heard.append)
    with simulation.record(tmp_path / "run"):
        simulation.run(0.02)
        simulation.conclude()
    with Recorded(tmp_path / "run") as recorded:
        results = [event for event in recorded.events() if event.kind == "result"]
    assert [event.data for event in results] == [event.data for event in heard if event.kind == "result"]
    assert results[0].data == {"kinds": [1, 2], "since": "datetime.date(2026, 1, 31)"}


def test_numbers_of_numpy_are_numbers() -> None:
    simulation, plain = driving(seed=odd(np.int64(3))), driving(seed=3)
    simulation.command("aperture", np.float64(0.75))
    simulation.command("posture", {"torso_yaw": np.float32(0.5)}, body="walker")
    plain.command("aperture", 0.75)
    plain.command("posture", {"torso_yaw": 0.5}, body="walker")
    simulation.step(odd(np.int64(20)))
    plain.step(20)
    assert digest(simulation) == digest(plain)
    assert type(simulation.seed) is int


def test_agents_cannot_use_the_names_of_a_living_environment() -> None:
    environment = Environment()
    before = set(dir(environment))
    ensure_converted(environment)
    assert {name for name in set(dir(environment)) - before if name[0] != "_"} == set(agents._LATER)


def test_an_unknown_command_names_the_modellers_line() -> None:
    simulation = Simulation(scene_of("walker"), {"walker": with_port(AGENTS.Wrong)})
    with pytest.raises(WorldError, match="has no actuator 'wlk'; did you mean 'walk'") as caught:
        simulation.run(0.1)
    line = 1 + AGENTS.__dict__["__actr3d_source__"].split("\n").index('        self.body.set("wlk", 1)')
    assert caught.value.__notes__ == [f"  requested by 'walker.body' in agents.py:{line}"]
    with pytest.raises(SimulationError, match=r"the run has failed at 0\.02 s and cannot go on"):
        simulation.step()
    simulation.seek(0.01)
    assert simulation.time == 0.01


def test_one_object_cannot_be_two_agents() -> None:
    agent: Any = AGENTS.Idle()
    simulation = Simulation(Scene(), bodiless={"a": lambda: agent, "b": lambda: agent})
    with pytest.raises(SimulationError, match=r"agents\['b'\]: must make a new agent each time"):
        simulation.step()


def test_other_threads_can_only_submit_commands() -> None:
    simulation = Simulation(scene_of("walker"))
    errors: list[str] = []

    def other() -> None:
        for call in (simulation.tick, simulation.step, partial(simulation.step, 0), partial(simulation.advance, 0)):
            try:
                call()
            except SimulationError as error:
                errors.append(str(error))

    watched: list[int] = []
    simulation.observe(lambda seen: watched.append(threading.get_ident()), of_calls=True)
    thread = threading.Thread(target=other)
    thread.start()
    thread.join()
    assert errors == ["a simulation belongs to the thread that made it; another one may use submit"] * 4
    assert watched == []
    futures: list[Any] = []
    threads = [threading.Thread(target=lambda: futures.append(simulation.submit("walk", 0.5))) for _ in range(8)]
    threads.append(threading.Thread(target=lambda: futures.append(simulation.submit("apertur", 1.0))))
    for thread in threads:
        thread.start()
    while len(futures) < 9:
        simulation.step()
    simulation.carry_out_submitted()
    assert sum(future.exception(timeout=0) is None for future in futures) == 8
    simulation.submit("walk", 3.0).cancel()
    simulation.step()
    assert simulation.world.bodies["walker"].get("velocity").linear[0] < 1
    (failed,) = [error for future in futures if (error := future.exception()) is not None]
    assert "no actuator 'apertur'" in str(failed)


def test_a_program_gives_its_simulations_seed_trace_and_end() -> None:
    trace = Trace("all")
    with RunLimits(seed=5, until=0.05, trace=trace):
        simulation = Simulation(scene_of("walker"), {"walker": Driver}, trace="buffer")
        simulation.run(0.05)
    assert simulation.seed == 5
    assert simulation.trace is not None
    assert [event.to_json() for event in trace] == [event.to_json() for event in simulation.trace]
    assert Simulation(scene_of("walker")).seed != Simulation(scene_of("walker")).seed


def test_random_numbers_of_the_module_random_come_from_the_seed_too() -> None:
    text = """
import random
from actr3d.actr import *
class Agent(Model):
    drawn = 0
    def start(self):
        while True:
            yield 0.05
            self.drawn = random.random()
"""
    agent: Any = load_text(text, "dice.py").Agent
    numbers: list[float] = []
    for seed in (1, 1, 2):
        simulation = Simulation(Scene(), bodiless={"agent": agent}, seed=seed)
        simulation.run(0.2)
        numbers.append(simulation.agents["agent"].drawn)
    assert numbers[0] == numbers[1] != numbers[2]


def test_no_sensor_is_read_without_a_request(asked: Counter[str]) -> None:
    simulation = Simulation(scene_of("walker"), {"walker": AGENTS.Idle})
    simulation.run(0.1)
    assert not asked
    assert isinstance(simulation.agents["walker"], (ACTR, Model))


@pytest.mark.slow
def test_many_ticks_neither_drift_nor_grow(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(timeline, "MAX_STATES", 8)
    monkeypatch.setattr(timeline, "MAX_ANSWERS", 100)
    simulation = driving()
    simulation.run(2)
    tracemalloc.start()
    sizes: list[int] = []
    for _ in range(3):
        simulation.run(10)
        gc.collect()
        sizes.append(tracemalloc.get_traced_memory()[0])
    tracemalloc.stop()
    assert simulation.world.time == simulation.agents["walker"].sch.now_us == 32_000_000
    assert sizes[2] - sizes[1] < 200_000  # a state of the two bodies' noise alone is 40,000 bytes


HALT = """
from IMPORT import *
from actr3d.simulation import Simulation
from actr3d.world import Floor, Mannequin, Scene

class Halter(ACTR):
    goal = Buffer()
    production_time = TIME
    def init(): goal.set("start")
    def halt(goal="start"): self.stop()

def build() -> Simulation:
    return Simulation(Scene(parts=(Floor(), Mannequin(name="halter"))), {"halter": Halter}, seed=1)
"""


def test_an_endless_loop_of_stops_is_an_error() -> None:
    simulation = load_text(HALT.replace("IMPORT", "actr3d.actr").replace("TIME", "0"), "halt.py").build()
    with pytest.raises(SchedulerError, match="endless loop at 0 s"):
        simulation.run(0.1)


def test_a_run_with_agents_written_for_python_actr_ends_when_one_stops_and_not_before() -> None:
    simulation = load_text(HALT.replace("IMPORT", "python_actr").replace("TIME", "0.025"), "halt.py").build()
    report = simulation.run(1)
    assert (report.ended_by, report.ticks) == ("stop", 3)


def test_single_ticks_and_tocks_draw_the_same_random_numbers_as_steps() -> None:
    text = """
import random
from actr3d.actr import *
from actr3d.simulation import BodyPort
class Looker(Model):
    body = BodyPort()
    def start(self):
        reading = self.body.get("drawn_numbers")
        yield reading
        self.seen = reading.value
"""

    @sensor
    def drawn_numbers(body: Any) -> float:  # pyright: ignore[reportUnusedFunction]
        return random.random()

    try:
        seen: list[float] = []
        for number in range(3):
            random.seed(number)
            simulation = Simulation(scene_of("walker"), {"walker": load_text(text, "looker.py").Looker}, seed=1)
            if number:
                for _ in range(2):
                    simulation.tick()
                    simulation.tock()
            else:
                simulation.step(2)
            assert random.random() == random.Random(number).random()
            seen.append(simulation.agents["walker"].seen)
    finally:
        SENSORS.pop("drawn_numbers")
    assert seen == [seen[0]] * 3
