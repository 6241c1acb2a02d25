"""Curves of what agents do: the same live, recorded and opened, however long the run is."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest

from actr3d.actr.explain.past_activation import PARAMETERS
from actr3d.trace import TraceEvent
from tests.helpers.sessions import Desk, Talk
from tests.workbench.test_recorded_runs import recording
from workbench.chunk_curves import SUFFIX
from workbench.event_curves import EventCurves, part_name
from workbench.exports import curves_of
from workbench.page_files import static

COUNTS = """
from actr3d.actr import *
from actr3d.simulation import Simulation
from actr3d.world import Floor, Scene

class Counting(ACTR):
    goal = Buffer()
    retrieval = Buffer()
    memory = Memory(retrieval, latency=0.1)
    base = DMBaseLevel(memory)
    learning = PMNew(alpha=0.2)
    def init():
        for number in range(9):
            memory.add(f"from:{number} to:{number + 1}")
        goal.set("count at:0")
    def ask(goal="count at:?at", retrieval=None, memory="busy:False"):
        memory.request(f"from:{at} to:?")
    def step(goal="count at:?at", retrieval="from:?at to:?to"):
        retrieval.clear()
        goal.modify(at=to)
        self.reward(1)
"""
BUILT = f"""{COUNTS}
def build() -> Simulation:
    return Simulation(Scene(parts=(Floor(),)), bodiless={{"counter": Counting}}, seed=1)
"""
PROGRAM = f"{COUNTS}\nfor trial in range(2):\n    Counting().run(1)\n"


def event(time: float, source: str, kind: str, **data: Any) -> TraceEvent:
    return TraceEvent(round(time * 1e6), source, kind, data)


def taken(*events: TraceEvent) -> EventCurves:
    curves = EventCurves()
    curves.take(events)
    return curves


def values(curves: EventCurves, name: str, **asked: Any) -> list[tuple[float, float | None]]:
    told = curves.sampled([name], asked.get("first", 0), asked.get("last"), asked.get("most", 1000))[name]
    return list(zip(told["times"], told["values"], strict=True))


def test_numbers_hold_until_they_change_and_those_of_another_chunk_end() -> None:
    curves = taken(
        event(0, "goal", "buffer", chunk={"at": "3", "isa": "count", "by": 0.5}),
        event(1, "goal", "buffer", chunk={"at": "3", "by": "-.5e1"}),
        event(2, "goal", "buffer", chunk={"at": "nan", "by": True}),
        event(3, "goal", "buffer", chunk=None),
    )
    assert values(curves, "goal.at") == [(0, 3), (2, None)]
    assert values(curves, "goal.by") == [(0, 0.5), (1, -5), (2, None)]
    assert values(curves, "goal full") == [(0, 0), (3, 3)]
    assert {one["name"]: (one["unit"], one["group"], one["of"], one["shape"]) for one in curves.names()} == {
        "goal full": ("s", "time full", None, "sum"),
        "goal.at": ("", "at", "goal", "steps"),
        "goal.by": ("", "by", "goal", "steps"),
    }


def test_an_attribute_that_returns_to_its_first_value_has_it_again() -> None:
    curves = taken(*(event(time, "memory", "state", size=size, decay=0.5) for time, size in enumerate([1, 1, 2, 1])))
    assert values(curves, "memory.size") == [(0, 1), (2, 2), (3, 1)]
    assert [one["name"] for one in curves.names()] == ["memory.size"]  # what stays as it is is a setting


def test_activations_and_utilities_are_points() -> None:
    found: dict[str, Any] = {
        "candidates": [["fact 1", [0.25, None], "chosen", 0.75]],
        "modules": ["DMBaseLevel", "DMNoise 2"],
        "latency": 0.1,
    }
    curves = taken(
        event(1, "bob.memory", "request", **found),
        event(1, "bob", "conflict", utilities={"go": 2, "stop": "inf"}),
        event(2, "top", "conflict", utilities={"go": 3.5}),
        event(3, "top", "utility", production="go", part="learning", value=1.5),
        event(4, "bob.motor", "request", movement="walk"),
        event(4, "bob.memory", "request", candidates=[3]),  # of a module of the model's own
    )
    shapes = {one["name"]: one["shape"] for one in curves.names()}
    assert shapes == {
        "bob.memory: fact 1 activation": "points",
        "bob.memory: fact 1 base level": "points",
        "bob.memory latency": "points",
        "bob.go utility": "points",
        "go utility": "points",
        "go learned learning": "steps",
    }
    assert values(curves, "bob.memory: fact 1 base level") == [(1, 0.25)]
    assert curves.sampled(["go utility"], 0, None, 10)["go utility"]["slope"] is None
    assert curves.next == 6


def test_a_sum_counts_from_the_first_event_and_says_if_that_is_not_the_start() -> None:
    def busy(first: int) -> EventCurves:
        return taken(*(event(time, "memory", "state", busy=time in (1, 5)) for time in (1, 3, 5, 6) if time >= first))

    whole = taken(event(0, "top", "run"), *(event(time, "memory", "state", busy=time in (1, 5)) for time in (1, 3, 5, 6)))
    assert values(whole, "memory busy") == [(1, 0), (3, 2), (5, 2), (6, 3)]
    assert values(busy(3), "memory busy since 3.000 s") == [(3, 0), (5, 0), (6, 1)]


def test_of_many_values_the_extremes_and_the_last_one_are_returned() -> None:
    many = [0.0] * 10_000
    many[1234], many[7777], many[-1] = 5.0, -5.0, 1.0
    curves = taken(*(event(n / 1000, "top", "conflict", utilities={"go": value}) for n, value in enumerate(many)))
    told = curves.sampled(["go utility", "no"], 0, None, 50)
    assert list(told) == ["go utility"]
    assert len(told["go utility"]["times"]) <= 50
    assert not told["go utility"]["whole"]
    found = values(curves, "go utility", most=50)
    assert {(1.234, 5.0), (7.777, -5.0), (9.999, 1.0)} < set(found)
    assert values(curves, "go utility", first=1.233, last=1.235) == [(1.233, 0), (1.234, 5), (1.235, 0)]
    assert values(curves, "go utility", first=3, last=2) == []


def test_each_event_is_read_once_and_names_are_listed_once() -> None:
    curves = taken(event(0, "goal", "buffer", chunk={"at": "1"}))
    seen = len(curves.names())
    curves.take([event(1, "goal", "buffer", chunk={"to": "2"})])
    assert curves.next == 2
    assert [one["name"] for one in curves.names(seen)] == ["goal.to"]


def ways(talk: Talk) -> Iterator[dict[str, Any]]:
    """Yields the curves of a run of 1.5 s at its end, and after it has gone back and on."""
    yield talk.say("curves", most=5_000)
    for time in (0.3, 1.2):
        talk.say("seek", time=time)
        talk.until("paused", time=time)
        yield talk.say("curves", most=5_000)
    talk.say("until", time=1.4)
    talk.until("paused", time=1.4)
    yield talk.say("curves", most=5_000)


@pytest.mark.parametrize("source", [BUILT, PROGRAM], ids=["built", "program"])
def test_curves_of_events_are_the_same_live_gone_back_recorded_and_opened(desk: Desk, tmp_path: Path, source: str) -> None:
    talk = desk.begin(tmp_path, source, record=True)
    talk.say("until", time=1.5)
    talk.until("paused", time=1.5)
    first, *later = ways(talk)
    assert len(first["events"]) > 10
    assert all(told == first for told in later)
    assert talk.say("curves", names=["no"], seen=None)["events"] == {}
    path = recording(desk, talk)
    told = curves_of(path, names=None, first=0.0, most=5_000)
    assert told == first
    opened = Talk(desk, desk.do(talk.sessions.reopen(path.stem)), talk.sessions)
    opened.until("paused", time=0.0)
    assert opened.say("curves", most=5_000) == first


def test_after_a_change_in_the_past_curves_of_events_are_those_of_the_new_way(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, BUILT, record=True)
    talk.say("until", time=1.5)
    talk.until("paused", time=1.5)
    before = talk.say("curves", names=["counter.goal.at"])["events"]["counter.goal.at"]
    talk.say("seek", time=0.5)
    talk.until("paused", time=0.5)
    talk.say("command", word="set_buffer", values=["counter.goal", "count at:7"], drop=True)
    told = talk.say("curves", names=["counter.goal.at"])["events"]["counter.goal.at"]
    kept = [value for time, value in zip(before["times"], before["values"], strict=True) if time < 0.5]
    assert told["values"] == [*kept, 7]
    talk.say("until", time=1.5)
    talk.until("paused", time=1.5)
    assert talk.say("curves", names=["counter.goal.at"])["events"]["counter.goal.at"] == told  # it waits for another answer
    assert max(before["values"]) > max(kept) + 1


SPREADS = """
from actr3d.actr import *
from actr3d.simulation import Simulation
from actr3d.world import Floor, Scene

class Learning(ACTR):
    goal = Buffer()
    retrieval = Buffer()
    memory = Memory(retrieval, latency=0.1, threshold=-5)
    noise = DMNoise(memory, noise=0)
    base = DMBaseLevel(memory)
    spread = DMSpreading(memory, goal)
    memory.add("from:9 to:9")
    memory.add("from:9 to:9")
    goal.set("count at:0")
    def init():
        for number in range(9):
            memory.add(f"from:{number} to:{number + 1}", time=2)
        spread.strength = 3
    def ask(goal="count at:?at", retrieval=None, memory="busy:False"):
        memory.request(f"from:{at} to:?")
    def step(goal="count at:?at", retrieval="from:?at to:?to"):
        retrieval.clear()
        memory.add(f"from:{at} to:{to}")
        goal.modify(at=to)
    def again(goal="count at:9"):
        goal.set("count at:0")
"""
SPREADS_BUILT = f"""{SPREADS}
def build() -> Simulation:
    return Simulation(Scene(parts=(Floor(),)), bodiless={{"learner": Learning}}, seed=1)
"""
SPREADS_PROGRAM = f"{SPREADS}\nfor trial in range(2):\n    Learning().run(1)\n"
PARTS = ("activation without noise", "base level", "spreading")
CHUNKS = ("from:9 to:9", "from:1 to:2", "from:4 to:5")


def chunk_curves(talk: Talk, memory: str, **asked: Any) -> dict[str, Any]:
    plots = talk.say("memory", memory=memory)["plots"]
    assert plots == {"curves": [f"{part} over time" for part in PARTS], "why": ""}
    names = [f"{memory}: {chunk} {end}" for chunk in CHUNKS for end in plots["curves"]]
    told = talk.say("curves", names=names, most=5_000, **asked)
    assert set(names) <= set(told["events"])
    assert not {one["name"] for one in told["names"]} & set(names)
    return {name: told["events"][name] for name in names}


def at(curve: dict[str, Any], time: float) -> Any:
    return dict(zip(curve["times"], curve["values"], strict=True))[time]


def test_the_activation_of_a_chunk_at_a_past_tick_is_what_it_was_in_the_memory(desk: Desk, tmp_path: Path) -> None:
    memory = "learner.memory"
    talk = desk.begin(tmp_path, SPREADS_BUILT, record=True)
    was: dict[float, Any] = {}
    for time in (0.1, 0.25, 0.53, 0.8):
        talk.say("until", time=time)
        talk.until("paused", time=time)
        was[time] = {row["chunk"]: row["parts"] for row in talk.say("memory", memory=memory)["rows"]}
    curves = chunk_curves(talk, memory)
    assert all(curve["times"] == [n / 100 for n in range(81)] and curve["whole"] for curve in curves.values())
    for time, rows in was.items():
        for chunk in CHUNKS:
            activation, base, spreading = (at(curves[f"{memory}: {chunk} {part} over time"], time) for part in PARTS)
            assert [base, spreading] == [rows[chunk]["DMBaseLevel"], rows[chunk]["DMSpreading"]]
            assert activation == base + spreading
    assert len({at(curves[f"{memory}: from:1 to:2 spreading over time"], time) for time in was}) > 1
    talk.say("seek", time=0.3)
    talk.until("paused", time=0.3)
    assert chunk_curves(talk, memory) == curves
    part = chunk_curves(talk, memory, first=0.2, last=0.4)
    assert all(part[name]["values"] == curves[name]["values"][20:41] for name in curves)
    opened = Talk(desk, desk.do(talk.sessions.reopen(recording(desk, talk).stem)), talk.sessions)
    opened.until("paused", time=0.0)
    opened.say("until", time=0.05)
    opened.until("paused", time=0.05)
    assert chunk_curves(opened, memory) == curves


def test_the_activation_of_a_chunk_in_each_run_of_a_program_begins_with_this_run(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, SPREADS_BUILT)
    talk.say("until", time=0.8)
    talk.until("paused", time=0.8)
    built = chunk_curves(talk, "learner.memory")
    program = desk.begin(tmp_path, SPREADS_PROGRAM, name="program.py")
    program.say("until", time=1.9)
    program.until("paused", time=1.9)
    first, second = (chunk_curves(program, memory) for memory in ("memory", "top#2.memory"))
    for name, curve in built.items():
        end = name.removeprefix("learner.memory")
        assert first[f"memory{end}"]["values"][:81] == curve["values"]
        assert first[f"memory{end}"]["values"][101:] == [None] * 90
        assert second[f"top#2.memory{end}"]["values"][:100] == [None] * 100
        assert second[f"top#2.memory{end}"]["values"][101:181] == pytest.approx(curve["values"][1:])


def test_the_page_knows_the_names_of_all_curves_of_chunks() -> None:
    known = re.search(r"const OF_CHUNK = /(.*)/s;", (static() / "timeline" / "curves.js").read_text(encoding="utf-8"))
    assert known is not None
    parts = [part_name(module.__name__) for module in PARAMETERS]
    for part in [*parts, *(f"{part} 2" for part in parts), "activation", "activation without noise"]:
        found = re.fullmatch(known[1], f"memory: item:cup {part}{SUFFIX}", re.DOTALL)
        assert found is not None, part
        assert found[2] == "item:cup"


def test_modules_of_one_class_are_told_apart_over_time(desk: Desk, tmp_path: Path) -> None:
    memory, chunk = "learner.memory", "from:1 to:2"
    two = SPREADS_BUILT.replace("goal.set", "other = DMSpreading(memory, goal)\n    goal.set", 1)
    talk = desk.begin(tmp_path, two.replace("spread.strength = 3", "spread.strength = 3\n        other.strength = 5"))
    talk.say("until", time=0.25)
    talk.until("paused", time=0.25)
    names = [f"{memory}: {chunk} {part} over time" for part in ("spreading", "spreading 2")]
    curves = talk.say("curves", names=names)["events"]
    (parts,) = (row["parts"] for row in talk.say("memory", memory=memory)["rows"] if row["chunk"] == chunk)
    assert [at(curves[name], 0.25) for name in names] == [parts["DMSpreading"], parts["DMSpreading 2"]]
    assert parts["DMSpreading"] != parts["DMSpreading 2"]


def test_an_activation_that_does_not_follow_from_the_events_is_not_drawn_and_the_answer_says_why(desk: Desk, tmp_path: Path) -> None:
    changing = SPREADS_BUILT.replace("retrieval.clear()", "retrieval.clear()\n        base.decay = 0.5 if at == '0' else 0.9")
    talk = desk.begin(tmp_path, changing)
    name = "learner.memory: from:1 to:2 base level over time"

    def told(time: float) -> tuple[Any, str]:
        talk.say("until", time=time)
        talk.until("paused", time=time)
        answer = talk.say("curves", names=[name])
        return answer["events"][name], answer["basis"]

    before, basis = told(0.1)
    after, other = told(0.6)
    assert before["values"]
    assert "why" not in before
    assert after["values"] == []
    assert after["why"].startswith("The model changes parameters of this memory")
    assert basis != other
    associated = desk.begin(
        tmp_path, SPREADS_BUILT.replace("goal.set", "assoc = DMAssociate(memory, goal)\n    goal.set", 1), name="other.py"
    )
    assert associated.say("memory", memory="learner.memory")["plots"] == {
        "curves": ["base level over time", "spreading over time"],
        "why": "What DMAssociate adds is known only at a retrieval.",
    }
