"""Simulations that a traced program creates: each is a run of the program's trace."""

from __future__ import annotations

import gc
import weakref
from typing import Any

import pytest

from actr3d.actr import ACTR
from actr3d.actr.kernel.run_limits import RunLimits
from actr3d.actr.loading import load_text
from actr3d.simulation import Simulation
from actr3d.trace import Trace, TraceEvent
from actr3d.world import Scene
from tests.helpers.walkers import Driver, scene_of

Plain: Any = load_text(
    "from actr3d.actr import *\nclass Plain(ACTR):\n    goal = Buffer()\n    def init():\n        goal.set('a')\n    def done(goal='a'):\n"
    "        goal.set('b')\n",
    "plain.py",
).Plain


def walking(trace: str = "none") -> Simulation:
    return Simulation(scene_of("walker"), {"walker": Driver}, trace=trace)


def sources(events: list[TraceEvent]) -> set[str]:
    return {event.source.partition(".walker")[0] for event in events}


def test_each_simulation_and_model_of_a_program_has_its_own_name_in_the_trace() -> None:
    trace = Trace("all")
    with RunLimits(seed=5, trace=trace):
        one, two = walking("all"), walking("all")
        one.run(0.1)
        model: ACTR = Plain()
        model.run()
        for _ in range(10):
            two.step()
            one.step()
        one.command("aperture", 0.5)
        two.command("aperture", 0.5)
    by_run: dict[int, list[TraceEvent]] = {}
    for event in trace:
        by_run.setdefault(event.run, []).append(event)
    assert sorted(by_run) == [1, 2, 3]
    assert one.trace is not None
    assert [event.to_json() for event in by_run[1]] == [event.to_json() for event in one.trace]
    assert {"top#2", "top#2.goal"} <= {event.source for event in by_run[2]}
    assert sources(by_run[3]) == {"top#3"}
    assert two.trace is not None
    own = [event._replace(source="top#3" if event.source == "top" else f"top#3.{event.source}") for event in two.trace]
    assert [event.to_json() for event in by_run[3]] == [event.to_json() for event in own]
    assert [event.source for event in trace.select("command")] == ["top", "top#3"]


def test_an_event_of_an_unregistered_kind_passes_into_the_trace_of_a_program_that_records_everything() -> None:
    honking: Any = load_text(
        "from actr3d.actr import *\nclass Horn(Model):\n    def honk(self):\n        self.emit('honk', loud=1)\n"
        "class Honking(ACTR):\n    goal, horn = Buffer(), Horn()\n    def init():\n        goal.set('a')\n"
        "    def honk(goal='a'):\n        horn.honk()\n        goal.clear()\n",
        "honking.py",
    ).Honking
    found: dict[str, list[str]] = {}
    for level in ("all", "production"):
        trace = Trace(level)
        with RunLimits(seed=5, trace=trace):
            Simulation(scene_of("walker"), {"walker": honking}, trace="all").run(0.1)
        found[level] = [event.source for event in trace.select("honk")]
    assert found == {"all": ["walker.horn"], "production": []}


def test_going_back_makes_no_new_run() -> None:
    trace = Trace("all")
    with RunLimits(seed=5, trace=trace):
        walking().run(0.1)
        simulation = walking()
        simulation.run(0.1)
        simulation.seek(0.05)
        simulation.run(0.1)
    assert {event.run for event in trace} == {1, 2}


def test_a_late_listener_gets_the_present_state_under_that_name() -> None:
    trace = Trace("all")
    heard: list[TraceEvent] = []
    with RunLimits(seed=5, trace=trace):
        kept = [walking(), walking()]
        for simulation in kept:
            simulation.run(0.1)
        trace.listen(heard.append)
        trace.command("pause", run=2)
    assert [(event.source, event.time) for event in heard if event.kind == "start"] == [("top", 0.1), ("top#2", 0.1)]
    assert [(event.source, event.time) for event in heard if event.kind == "command"] == [("top#2", 0.1)]


def test_a_listener_of_the_programs_trace_that_fails_ends_the_simulation() -> None:
    trace = Trace("all", keep=False)
    with RunLimits(seed=5, trace=trace):
        simulation = walking()

        def failing(event: TraceEvent) -> None:
            if event.time >= 0.05:
                raise OSError("full")

        trace.listen(failing)
        with pytest.raises(OSError, match="full"):
            simulation.run(1)
        assert 5 <= simulation.ticks <= 8
        simulation.step()


def test_the_trace_does_not_keep_a_simulation() -> None:
    trace = Trace("all")
    with RunLimits(seed=5, trace=trace):
        simulation = walking()
        simulation.run(0.1)
        gone = weakref.ref(simulation)
        del simulation
        gc.collect()
        assert gone() is None
        trace.listen(lambda _: None)


Naming: Any = load_text(
    """
from actr3d.actr import *
class Naming(ACTR):
    goal = Buffer()
    retrieval = Buffer()
    memory = Memory(retrieval)
    def init():
        memory.add(Chunk({0: "of", "what": self.goal, "all": [self.memory]}))
        goal.set(Chunk({0: "go", "to": self.goal, "says": "<namer.goal>"}))
    def go(goal="go to:?x"):
        memory.request("of")
        goal.clear()
""",
    "naming.py",
).Naming


def test_the_data_name_parts_as_the_programs_trace_does() -> None:
    trace = Trace("all")
    with RunLimits(seed=5, trace=trace):
        kept = [Simulation(Scene(), bodiless={"namer": Naming}, trace="all") for _ in range(2)]
        for simulation in kept:
            simulation.run(0.3)
        model: Any = Naming()
        model.namer = Naming()
        model.run(0.3)
    first, second = ([event for event in trace if event.run == number] for number in (1, 2))
    assert kept[1].trace is not None
    assert [event.data for event in kept[1].trace][1:] == [event.data for event in first][1:]
    lines = "\n".join(event.to_json() for event in second)
    assert lines.count("<top#2.namer.goal>") >= 3
    assert lines.count("<top#2.namer.memory>") >= 2
    assert lines.count("<namer.") == lines.count('"says": "<namer.goal>"') == 1  # the model's own text is unchanged
    (retrieved,) = [event for event in second if event.kind == "retrieval"]
    assert "what:<top#2.namer.goal>" in retrieved.data["chunk"]
    third = "\n".join(event.to_json() for event in trace if event.run == 3)
    assert "<top#3.namer.goal>" in third
