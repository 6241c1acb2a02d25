"""Observers of a run read its trace, memories, eye and sensors, and do not change the run."""

from __future__ import annotations

from collections.abc import Callable
from contextlib import suppress
from dataclasses import dataclass
from typing import Annotated, Any

import pytest

from actr3d.actr import ACTR, Buffer, DMBaseLevel, DMNoise, DMSpreading, Memory, Model
from actr3d.actr.declarative.activation import MemorySubModule
from actr3d.actr.explain.memory_table import memory_rows
from actr3d.actr.kernel.run_limits import EndOfRun, RunLimits
from actr3d.actr.kernel.scheduler import Scheduler
from actr3d.actr.loading import run_text
from actr3d.camera import CameraParameters, view_for_observer
from actr3d.configuration import Live
from actr3d.errors import CameraError, ParameterError, SimulationError, WorldError
from actr3d.runner.model_factory import Blueprint
from actr3d.runner.traceback_report import traceback_report
from actr3d.simulation import BodyPort, Command, Simulation
from actr3d.trace import Trace
from actr3d.world import Floor, ImportedBody, Mannequin, Scene, Wall, World
from tests.helpers.paths import MODELS
from tests.helpers.walkers import digest, driving

DOORWAY = MODELS / "doorway.py"
CLOCK = "from actr3d.actr import *\nclass Clock(Model):\n    def start(self):\n        while True:\n            yield 0.25\n"


def doorway(**settings: Any) -> Simulation:
    with RunLimits(seed=1):
        return Blueprint(DOORWAY.read_text(encoding="utf-8"), str(DOORWAY)).build({"width": 0.5, **settings})[0]


class Own(MemorySubModule):
    def activation(self, chunk: Any) -> float:
        raise AssertionError("a modeller's code is not run for observers")


class Knowing(ACTR):
    goal = Buffer()
    retrieval = Buffer()
    memory = Memory(retrieval)
    base = DMBaseLevel(memory)

    def init() -> None:  # type: ignore[misc]
        memory.add("animal dog", baselevel=1)  # type: ignore[name-defined] # noqa: F821
        memory.add("animal cat", baselevel=2)  # type: ignore[name-defined] # noqa: F821


class Senses(Model):
    """Walks to a wall and reads noisy sensors, and after a while also the skin."""

    def start(self) -> Any:
        agent: Any = self.parent
        body = agent.body
        body.set("walk", 1.2)
        yield 1.4
        for _ in range(12):
            yield body.get("rangefinder", noise=0.05)
            yield 0.02
            yield body.get("contacts")
            yield 0.02


class Sensing(ACTR):
    body = BodyPort()
    senses = Senses()


def sensing() -> Simulation:
    scene = Scene(parts=(Floor(), Wall(name="wall", start=(2, -1), end=(2, 1)), Mannequin(name="walker")))
    return Simulation(scene, {"walker": Sensing}, seed=1, trace="all")


def test_an_observer_may_read_every_sense_of_a_body_and_the_agent_senses_the_same() -> None:
    alone, observed = sensing(), sensing()
    alone.run(2)
    body = observed.world.bodies["walker"]
    seen: list[Any] = []

    def look(_: object) -> None:
        for word in set(body.sensors) - {"image", "depth"}:  # these have no state, and are slow
            with suppress(WorldError):  # some need options
                seen.append(body.get(word, noise=0.1 if word == "rangefinder" else None))

    observed.observe(look)
    observed.run(2, until=lambda _: bool(body.get("contacts")) and observed.time > 1.9)
    assert [value for value in seen if value == body.touched and value]
    once, again = ([event.to_json() for event in run.trace or () if event.time < observed.time] for run in (alone, observed))
    assert len(once) > 30
    assert again == once


@dataclass(frozen=True)
class Distances:
    """The minimum distance to the wall by a noisy sensor, and whether the skin has felt anything."""

    least: float
    touched: bool


class Reads:
    """A measure that reads noisy sensors, and the skin, which has a state."""

    def begin(self, world: World) -> None:
        self.body = world.bodies["walker"]
        self.least, self.touched = self.body.get("rangefinder", noise=0.05), False

    def look(self) -> None:
        self.least = min(self.least, self.body.get("rangefinder", noise=0.05))
        self.touched |= bool(self.body.get("contacts"))

    def result(self, *, over: bool) -> Distances:
        return Distances(self.body.get("rangefinder", noise=0.05), self.touched)


def test_a_measure_reads_noisy_senses_and_the_agent_senses_the_same() -> None:
    alone, measured = sensing(), sensing()
    measured.measure(Reads())
    alone.run(1.7)
    measured.run(1.7)
    assert measured.result().touched
    for simulation in (alone, measured):
        simulation.run(0.3)
    once, again = ([event.to_json() for event in run.trace or ()] for run in (alone, measured))
    assert again == once


def test_a_measure_cannot_change_the_world() -> None:
    class Pushes(Reads):
        def look(self) -> None:
            self.body.set("walk", 0.0)

    simulation = sensing()
    simulation.measure(Pushes())
    with pytest.raises(WorldError, match="walker: an observer cannot give commands"):
        simulation.run(0.1)
    simulation.world.bodies["walker"].set("walk", 0.0)


def test_an_observer_cannot_give_a_body_commands() -> None:
    simulation = sensing()
    simulation.observe(lambda _: simulation.world.bodies["walker"].set("walk", 0.0))
    with pytest.raises(WorldError, match="walker: an observer cannot give commands"):
        simulation.run(0.1)
    simulation.world.bodies["walker"].set("walk", 0.0)


def test_an_observer_cannot_change_the_world() -> None:
    simulation = sensing()
    world = simulation.world
    changes: list[Callable[[], None]] = [
        world.step,
        lambda: world.move("walker", 5.0, 5.0),
        lambda: world.push("walker", 10.0),
        lambda: world.set_aperture_width(1.0),
        lambda: world.restore(world.state()),
    ]
    refused: list[str] = []

    def look(_: object) -> None:
        for change in changes:
            with pytest.raises(WorldError, match=r"an observer cannot change the world; call simulation.command after the run") as error:
                change()
            refused.append(str(error.value).partition(":")[0])

    simulation.observe(look)
    simulation.step()
    assert refused == ["World.step", "World.move", "World.push", "World.set_aperture_width", "World.restore"]


def test_events_are_read_from_a_number_on() -> None:
    model: Any = Knowing()
    trace = model.traced()
    model.run(0)
    events = list(trace)
    assert trace.since(0) == events
    assert trace.since(len(events) - 2) == events[-2:]
    assert trace.since(len(events)) == []
    assert trace.runs[-1].model is model


def test_a_memory_is_a_table() -> None:
    model: Any = Knowing()
    model.run(0)
    rows = memory_rows(model.memory)
    assert [(row.chunk, row.activation, dict(row.parts)) for row in rows] == [
        ("animal dog", 1, {"DMBaseLevel": 1}),
        ("animal cat", 2, {"DMBaseLevel": 2}),
    ]
    assert dict(rows[0].slots) == {"0": "animal", "1": "dog"}
    assert [row.chunk for row in memory_rows(model.memory, "CAT")] == ["animal cat"]
    assert [row.chunk for row in memory_rows(model.memory, most=1)] == ["animal dog"]


def test_noise_and_a_modellers_own_terms_are_not_computed_for_the_table() -> None:
    model: Any = Knowing()
    model.run(0)
    DMNoise(model.memory, noise=1)
    Own(model.memory)
    before = model.random.getstate()
    (row, _) = memory_rows(model.memory)
    assert dict(row.parts) == {"DMBaseLevel": 1, "DMNoise": None, "Own": None}
    assert row.activation is None
    assert model.random.getstate() == before


def test_an_observer_does_not_consume_warnings() -> None:
    model: Any = Knowing()
    model.run(0)
    spreading: Any = DMSpreading(model.memory, model.goal)
    spreading._warned = {"known"}
    memory_rows(model.memory)
    assert spreading._warned == {"known"}


def test_a_glance_changes_no_labels() -> None:
    seen, unseen = doorway(), doorway()
    for simulation, looks in ((seen, True), (unseen, False)):
        simulation.traced()
        for _ in range(30):
            simulation.step(5)
            if looks:
                body = simulation.world.bodies["walker"]
                view = view_for_observer(body)
                assert view.rows == 100
                assert len(view.extents) > 0
                view_for_observer(body, CameraParameters(rows=7))
    assert digest(seen) == digest(unseen)


def test_a_glance_is_what_the_agent_sees() -> None:
    simulation = doorway()
    simulation.step(10)
    body = simulation.world.bodies["walker"]
    assert (view_for_observer(body).as_array() == body.get("view").as_array()).all()


def test_a_body_without_an_eye_cannot_glance() -> None:
    blind = ImportedBody(name="blind", text="<mujoco><worldbody><body name='b'><freejoint/><geom size='.1'/></body></worldbody></mujoco>")
    with pytest.raises(CameraError, match="'blind' has no eye"):
        view_for_observer(World(Scene(parts=(blind,))).bodies["blind"])


def test_a_program_is_notified_when_its_time_advances() -> None:
    passed: list[tuple[int, int]] = []

    def note(sch: Scheduler, end: int) -> None:
        passed.append((sch.now_us, end))

    limits = RunLimits(seed=1, passing=note)
    run_text(f"{CLOCK}clock = Clock()\nclock.run(0.6)\nclock.run(0.5)\nModel().run(1)", limits=limits)
    ms = [(0, 250), (250, 500), (500, 600), (600, 750), (750, 1000), (1000, 1100), (0, 1000)]
    assert passed == [(start * 1000, end * 1000) for start, end in ms]


def test_a_program_can_be_ended_when_it_is_notified() -> None:
    def end(_: Scheduler, to: int) -> None:
        if to > 500_000:
            raise EndOfRun

    module = run_text(f"{CLOCK}clock = Clock()\nclock.run(0.6)\nover = True", limits=RunLimits(passing=end))
    assert module.__dict__["clock"].now() == 0.5
    assert "over" not in module.__dict__


def test_a_simulation_can_be_traced_after_it_was_made() -> None:
    simulation = driving()
    simulation.traced("buffer")
    simulation.step(10)
    assert simulation.trace is not None
    assert {event.kind for event in simulation.trace} == {"start", "select", "fire", "buffer"}
    with pytest.raises(SimulationError, match=r"traced\(\) must be called before the run starts"):
        simulation.traced()
    with pytest.raises(ParameterError, match="no level"):
        driving().traced("some")


def test_a_simulation_is_traced_although_the_programs_trace_keeps_nothing() -> None:
    with RunLimits(trace=Trace("all", keep=False)):
        simulation = driving()
        simulation.traced()
        simulation.step(5)
    assert simulation.trace is not None
    assert len(simulation.trace) > 10


def test_planned_commands_are_repeated() -> None:
    first, second = driving("all"), driving("all")
    first.step(5)
    first.command("aperture", 0.9)
    first.step(5)
    second.plan([Command(5, "aperture", (0.9,), {})])
    second.step(10)
    assert digest(first) == digest(second)
    with pytest.raises(SimulationError, match=r"plan\(\) must be called before the run starts"):
        second.plan([])


def test_a_simulation_is_done_when_no_agent_has_anything_left_to_do() -> None:
    simulation = doorway(speed=3.0)
    assert not simulation.done
    simulation.run()
    simulation.step(20)
    assert simulation.done
    simulation.seek(0)
    assert not simulation.done


def test_an_error_names_the_modellers_line() -> None:
    with pytest.raises(ZeroDivisionError) as caught:
        run_text(f"{CLOCK}def halve(n):\n    return n / 0\nhalve(1)", "mine.py")
    report = traceback_report(caught.value)
    assert (report.file, report.line) == ("mine.py", 7)
    assert report.message == "ZeroDivisionError: division by zero"
    assert "loading.py" not in report.text


def test_an_error_names_the_modellers_line_where_a_module_of_python_raises() -> None:
    with pytest.raises(ValueError, match="Expecting") as caught:
        run_text("import json\njson.loads('no')", "mine.py")
    report = traceback_report(caught.value)
    assert (report.file, report.line) == ("mine.py", 2)
    assert "decoder.py" in report.text


@pytest.mark.parametrize("text", ["1 +", "x = 3\nprint 'so'\n"])
def test_an_error_names_the_line_that_cannot_be_read(text: str) -> None:
    with pytest.raises(Exception, match="bad") as caught:
        run_text(text, "bad.py")
    report = traceback_report(caught.value)
    assert (report.file, report.line) == ("bad.py", 1 if "+" in text else 2)


def test_a_live_field_shows_its_command_in_its_repr() -> None:
    assert repr(Live("parameter", "walker.speed", body="walker")) == "Live('parameter', 'walker.speed', body='walker')"
    hint: Any = Annotated[float, Live("aperture")]
    assert hint.__metadata__[0].before == ()
