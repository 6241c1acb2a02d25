"""Who listens to a trace: several at once, each at a level, coming and going; and none may harm the run."""

from __future__ import annotations

from typing import Any

import pytest

from actr3d.actr.kernel.model import ensure_converted
from actr3d.actr.kernel.run_limits import RunLimits
from actr3d.actr.loading import load_text
from actr3d.errors import ParameterError, RecordingError
from actr3d.trace import Trace, TraceEvent
from actr3d.trace_kinds import KINDS, LEVELS

COUNTING = """
from IMPORT import *
class Agent(ACTR):
    goal, retrieval = Buffer(), Buffer()
    memory = Memory(retrieval, threshold=-10)
    noise = DMNoise(memory, 0.1)
    def init():
        for i in range(20): memory.add(f'count {i} {i + 1}')
        goal.set('count 0')
        memory.request('count 0 ?')
    def count(goal='count ?n', retrieval='count ?n ?next'):
        memory.request('count ?next ?')
        goal.set('count ?next')
"""


def agent_of(trace: Trace | None = None, module: str = "actr3d.actr") -> Any:
    with RunLimits(seed=2, trace=trace):
        agent = load_text(COUNTING.replace("IMPORT", module), "counting.py").Agent()
        ensure_converted(agent)
    return agent


def ranks(events: list[TraceEvent]) -> set[str]:
    return {KINDS[event.kind].level for event in events}


def test_listeners_hear_up_to_their_own_level() -> None:
    trace = Trace("all", keep=False)
    heard: dict[str, list[TraceEvent]] = {level: [] for level in LEVELS}
    for level, events in heard.items():
        trace.listen(events.append, level)
    agent_of(trace).run(1)
    assert [ranks(heard[level]) for level in LEVELS] == [set(), {"production"}, {"production", "buffer"}, {"production", "buffer", "all"}]
    assert [e for e in heard["all"] if KINDS[e.kind].level != "all"] == heard["buffer"]


def test_a_listener_may_not_ask_for_more_than_there_is() -> None:
    with pytest.raises(ParameterError, match="a trace of level 'buffer' has no events of level 'all'"):
        Trace("buffer").listen(print, "all")
    with pytest.raises(ParameterError, match=r"no level 'bufer'.*did you mean 'buffer'"):
        Trace().listen(print, "bufer")
    with pytest.raises(ParameterError, match="<print> does not listen"):
        Trace().ignore(print)


def asked(trace: Trace) -> list[bool]:
    return [trace.production, trace.buffer, trace.all]


def test_without_keeping_and_without_listeners_nothing_is_asked_for() -> None:
    trace = Trace("all", keep=False)
    assert asked(trace) == [False, False, False]
    trace.listen(print, "buffer")
    assert asked(trace) == [True, True, False]
    trace.ignore(print)
    assert asked(trace) == [False, False, False]
    assert asked(Trace("buffer")) == [True, True, False]


def test_a_model_can_be_traced_without_keeping() -> None:
    agent = agent_of()
    trace = agent.traced(keep=False)
    heard: list[TraceEvent] = []
    trace.listen(heard.append)
    agent.run(0.3)
    assert len(trace) == 0
    assert "fire" in {event.kind for event in heard}
    with pytest.raises(ParameterError, match="only a run traced"):
        agent.explain(0.1)


def test_a_listener_added_late_receives_the_present_state_first() -> None:
    agent, other = agent_of(), agent_of()
    trace = agent.traced("all", keep=False)
    agent.run(0.33)
    other.run(0.33)
    heard: list[TraceEvent] = []
    trace.listen(heard.append)
    assert heard == list(other.traced())
    agent.run(0.2)
    assert heard[-1].kind == "stop"


def test_listeners_come_and_go_during_a_run() -> None:
    trace = Trace("production", keep=False)
    first: list[float] = []
    later: list[float] = []

    def hear(event: TraceEvent) -> None:
        first.append(event.time)
        if event.time > 0.5:
            trace.ignore(hear)
            trace.listen(lambda event: later.append(event.time))

    trace.listen(hear)
    agent_of(trace).run(1)
    assert max(first) <= min(later)
    assert len(first) > 5 < len(later)


@pytest.mark.parametrize("module", ["actr3d.actr", "python_actr"])
@pytest.mark.parametrize("kind", sorted({"request", "fire", "buffer", "conflict", "run", "stop", "initialize", "add"}))
def test_a_listener_that_fails_is_named_and_harms_nothing(kind: str, module: str) -> None:
    whole = agent_of(module=module)
    kept = whole.traced()
    whole.run(2)
    agent = agent_of(module=module)
    trace = agent.traced()
    calls: list[str] = []
    others: list[TraceEvent] = []

    def fail(event: TraceEvent) -> None:
        if event.kind == kind and event.data != {"chunk": None}:
            calls.append(kind)
            raise ValueError("the disk is full")

    trace.listen(fail)
    trace.listen(others.append)
    with pytest.raises(ValueError, match="the disk is full") as raised:
        agent.run(2)
    assert (
        f"raised by a listener of the trace, <test_a_listener_that_fails_is_named_and_harms_nothing.<locals>.fail>, for the event '{kind}'"
        in (raised.value.__notes__[0])
    )
    agent.run(2 - agent.now())
    assert calls == [kind]

    def events(record: Any) -> list[TraceEvent]:
        return [event for event in record if event.kind not in ("run", "stop")]

    assert events(trace) == events(kept)
    assert [event.kind for event in others].count(kind) >= 1


def test_a_listener_that_fails_outside_a_run_is_reported_by_the_next() -> None:
    agent = agent_of()
    trace = agent.traced()
    agent.run(0.1)

    def fail(event: TraceEvent) -> None:
        if event.kind == "buffer" and event.data["chunk"] == {"0": "x"}:
            raise ValueError("no")

    trace.listen(fail)
    agent.goal.set("x")
    with pytest.raises(ValueError, match="no"):
        agent.run(0.1)
    assert agent.now() == 0.1
    agent.run(0.1)
    assert agent.now() == 0.2


def test_a_listener_that_fails_at_once_is_reported_at_once() -> None:
    agent = agent_of()
    trace = agent.traced(keep=False)

    def fail_at_once(event: TraceEvent) -> None:
        raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        trace.listen(fail_at_once)
    assert not trace.all
    agent.run(0.1)

    def fail(event: TraceEvent) -> None:
        if event.kind == "command":
            raise KeyError("width")

    trace.listen(fail)
    with pytest.raises(KeyError, match="width"):
        trace.command("resize")


def test_several_failing_listeners_are_all_reported() -> None:
    agent = agent_of()
    trace = agent.traced()

    def one(event: TraceEvent) -> None:
        if event.kind == "command":
            raise KeyError("one")

    def two(event: TraceEvent) -> None:
        if event.kind == "command":
            raise ValueError("two")

    trace.listen(one)
    trace.listen(two)
    with pytest.raises(KeyError) as raised:
        trace.command("pause")
    assert raised.value.__notes__[-1] == "another listener raised ValueError"
    trace.command("pause")


def test_an_events_data_are_those_of_its_moment() -> None:
    agent = agent_of()
    trace = agent.traced()
    agent.run(0.2)
    before = [event.to_json() for event in trace]
    for chunk in agent.memory.dm:
        chunk["extra"] = "changed"
    agent.goal.chunk["0"] = agent.retrieval.chunk[2] = "changed"
    agent.run(0.2)
    assert [event.to_json() for event in trace][: len(before)] == before


def test_a_recording_that_can_no_longer_be_written_is_reported_in_its_own_words() -> None:
    trace = Trace("all", keep=False)

    def full(_: TraceEvent) -> None:
        raise RecordingError("cannot write the recording")

    trace.listen(full)
    with pytest.raises(RecordingError) as raised:
        agent_of(trace).run(1)
    assert getattr(raised.value, "__notes__", []) == []
