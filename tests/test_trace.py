"""The trace: what is recorded at each level, and that nothing is computed which nobody asked for."""

from __future__ import annotations

import json
from datetime import date
from typing import Any

import pytest

from actr3d.actr import Buffer, Model
from actr3d.actr.kernel.run_limits import RunLimits
from actr3d.actr.loading import load_text
from actr3d.errors import ParameterError
from actr3d.trace import LEVELS, Trace, TraceEvent
from actr3d.trace_kinds import KINDS

TEXT = """
from actr3d.actr import *
class Value:
    shown = 0
    def __repr__(self):
        Value.shown += 1
        return 'value'
class Agent(ACTR):
    goal = Buffer()
    retrieval = Buffer()
    memory = Memory(retrieval, threshold=-10)
    mood = 'calm'
    noise = DMNoise(memory, 0.1)
    def init():
        memory.add('count 1 2')
        goal.set('a')
    def one(goal='a'):
        memory.request('count 1 ?next')
        goal.set({'step': 'b', 'value': Value()})
        self.mood = 'eager'
    def two(goal='step:b', retrieval='count 1 ?next'):
        goal.clear()
"""


def agent_of(text: str = TEXT) -> Any:
    module: Any = load_text(text, "traced.py")
    agent = module.Agent()
    agent.module = module
    return agent


def kinds(trace: Trace) -> set[str]:
    return {event.kind for event in trace}


def test_levels_hold_more_and_more() -> None:
    found: dict[str, set[str]] = {}
    for level in LEVELS:
        agent = agent_of()
        trace = agent.traced(level)
        agent.run(1)
        found[level] = kinds(trace)
    assert found["none"] == set()
    assert {"select", "fire"} <= found["production"]
    assert not found["production"] & {"buffer", "state", "request"}
    assert found["production"] | {"buffer"} <= found["buffer"]
    assert "state" not in found["buffer"]
    assert found["buffer"] | {"state", "conflict", "request", "retrieval"} <= found["all"]


def test_an_unknown_level_is_named() -> None:
    with pytest.raises(
        ParameterError, match=r"Trace\.level: no level 'prodution'; use one of none, production.*did you mean 'production'\?"
    ):
        Model().traced("prodution")


@pytest.mark.parametrize("level", LEVELS)
def test_events_are_emitted_only_if_a_trace_is_requested(level: str, monkeypatch: pytest.MonkeyPatch) -> None:
    emitted: list[str] = []

    def emit(self: Trace, time_us: int, source: str, kind: str, data: dict[str, Any]) -> None:
        emitted.append(kind)

    monkeypatch.setattr(Trace, "emit", emit)
    agent = agent_of()
    if level != "none":
        agent.traced(level)
    agent.run(1)
    assert agent.goal.isEmpty()
    assert bool(emitted) == (level != "none")
    if level in ("none", "production"):
        assert agent.module.Value.shown == 0
        assert {KINDS[kind].level for kind in emitted} <= {"production"}


def test_events_are_json_lines_that_are_the_same_for_one_seed() -> None:
    lines: list[list[str]] = []
    for seed in (1, 1, 2):
        with RunLimits(seed=seed):
            agent = agent_of()
            trace = agent.traced()
            agent.run(1)
        lines.append([event.to_json() for event in trace])
    assert lines[0] == lines[1] != lines[2]
    for line in lines[0]:
        assert "\n" not in line
        assert set(json.loads(line)) == {"time", "source", "kind", "data"}


def test_json_of_odd_values_can_be_read_by_any_reader() -> None:
    data = {"inf": float("inf"), "nan": float("-nan"), 1: "number", ("a", 1): "pair", "object": object(), "set": {3, 1, 2}, "word": "größe"}
    line = TraceEvent(1_500_000, "top", "state", data).to_json()  # pyright: ignore

    def refuse(name: str) -> None:
        raise AssertionError(f"{name} is not JSON")

    read = json.loads(line, parse_constant=refuse)
    assert read["time"] == 1.5
    assert read["data"]["word"] == "größe"
    assert " at 0x" not in line


def test_data_are_what_they_were_then() -> None:
    model: Any = Model()
    model.goal = Buffer()
    trace = model.traced()
    values = [1, [2]]
    model.goal.set({"list": values})
    model.values = values
    values.append(3)
    chunk: Any = model.goal.chunk
    chunk["list"] = "changed"
    told, changed = (event.data["chunk"] for event in trace.select("buffer")[-2:])
    assert told == {"list": [1, [2]]}
    assert changed == {"list": "changed"}  # also of a change behind the buffer's back
    assert trace.select("state", "top")[-1].data == {"values": [1, [2]]}


def test_data_of_a_modellers_event_are_plain_and_what_they_were_then() -> None:
    model: Any = Model()
    trace = model.traced()
    values = [1, {2}]
    model.emit("seen", values=values, since=date(2026, 1, 31), part=model)
    values.append(3)
    assert trace.select("seen")[0].data == {"values": [1, [2]], "since": "datetime.date(2026, 1, 31)", "part": "<top>"}


def test_a_late_trace_is_complete_from_its_start() -> None:
    agent = agent_of()
    agent.run(0.06)
    trace = agent.traced()
    events = list(trace)
    agent.run(1)
    assert events[0].kind == "start"
    assert events[0].time == 0.06
    assert set(events[0].data) >= {"model", "seed"}
    assert {"chunk": {"step": "b", "value": "<Value>"}} in [e.data for e in events if e.source == "goal"]
    assert "eager" in [e.data.get("mood") for e in events if e.source == "top"]
    assert any(e.data.get("busy") is True for e in events if e.source == "memory")


def test_times_never_go_back() -> None:
    agent = agent_of()
    trace = agent.traced()
    agent.run(1)
    times = [event.time_us for event in trace]
    assert times == sorted(times)
    assert len(trace) == len(times)


def test_a_listener_gets_every_event_and_a_trace_need_not_keep_them() -> None:
    trace = Trace("all", keep=False)
    heard: list[TraceEvent] = []
    trace.listen(heard.append)
    with RunLimits(seed=1, trace=trace):
        agent = agent_of()
        agent.run(1)
    assert len(trace) == 0
    assert {"start", "fire", "buffer", "state"} <= {event.kind for event in heard}
    with RunLimits(seed=1):
        other = agent_of()
        kept = other.traced()
        other.run(1)
    assert [e for e in heard if e.kind == "fire"] == kept.select("fire")


@pytest.mark.parametrize("listens", [False, True])
def test_data_that_are_made_when_they_are_read_are_made_once_for_a_listener_and_the_record(listens: bool) -> None:
    made: list[int] = []
    heard: list[TraceEvent] = []

    def data() -> dict[str, Any]:
        made.append(1)
        return {"chunk": {}}

    trace = Trace()
    if listens:
        trace.listen(heard.append)
    trace.emit(0, "agent.goal", "buffer", data)
    assert len(made) == listens
    assert [event.data for event in trace] == [{"chunk": {}}]
    assert len(made) == 1
    assert heard == (list(trace) if listens else [])


def test_tracing_changes_nothing_in_the_run() -> None:
    ends: list[Any] = []
    for level in LEVELS:
        with RunLimits(seed=5):
            agent = agent_of()
            agent.traced(level)
            agent.run(1)
        ends.append((agent.now(), agent.random.random(), agent.mood))
    assert len(set(ends)) == 1


def test_every_module_traces_its_requests() -> None:
    module: Any = load_text(
        """
from actr3d.actr import *
class Room(Model):
    lamp = Model(kind='lamp', salience=1.0, x=1, y=2)
    def key_pressed(self, key): pass
class Agent(ACTR):
    goal, seen, place, image = Buffer(), Buffer(), Buffer(), Buffer()
    eye = SOSVision(seen)
    vision = Vision(seen, place)
    hand = Motor()
    imaginal = ImaginalModule(image)
    def init(): goal.set('go')
    def go(goal='go'):
        eye.request('kind:lamp')
        vision.attendTo('x:1')
        hand.press('a')
        imaginal.set('shape:round')
        goal.clear()
""",
        "asking.py",
    )
    room = module.Room()
    room.agent = module.Agent()
    trace = room.traced()
    room.run(1)
    asked = {event.source: event.data for event in trace.select("request")}
    assert asked == {
        "agent.eye": {"call": "request", "pattern": "kind:lamp", "noticed": ["<lamp>"]},
        "agent.vision": {"call": "attendTo", "pattern": "x:1", "unattended": False, "new": False},
        "agent.hand": {"call": "press", "key": "a"},
        "agent.imaginal": {"call": "set", "chunk": {"shape": "round"}},
    }
    assert {event.kind for event in trace} <= set(KINDS)


def test_no_address_enters_a_line_and_a_list_in_itself_does_no_harm() -> None:
    class Thing:
        pass

    agent = agent_of()
    trace = agent.traced()
    agent.goal.set({"thing": Thing(), "b": 1})
    looped: list[Any] = []
    looped.append(looped)
    agent.looped = looped
    agent.run(0.2)
    lines = [event.to_json() for event in trace]
    assert any("Thing" in line for line in lines)
    assert not any(" at 0x" in line for line in lines)
