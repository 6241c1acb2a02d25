"""Changes by hand of agents: buffers, memories, productions; each is explained, traced, and exact after a seek."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from actr3d.actr.changes import Parts
from actr3d.actr.loading import load_text
from actr3d.change import CHANGES
from actr3d.errors import Actr3dError
from actr3d.recording import Recorded
from actr3d.runner.replay import replay
from actr3d.simulation import Simulation
from actr3d.world import Floor, Scene
from tests.helpers.counters import counter_text

SCENE = Scene(parts=(Floor(),))
Counter: Any = load_text(counter_text("PMNew(alpha=0.2)"), "counter.py").Counter


def made() -> Simulation:
    simulation = Simulation(SCENE, bodiless={"mind": Counter}, seed=7)
    simulation.traced()
    return simulation


def events(simulation: Simulation, *kinds: str) -> list[tuple[float, dict[str, object]]]:
    assert simulation.trace is not None
    return [(event.time, dict(event.data)) for event in simulation.trace if event.kind in kinds]


def chosen(simulation: Simulation) -> str:
    """Returns the production that is about to fire."""
    return next(reason.name for reason in simulation.agents["mind"].explain().productions if reason.selected)


def other(simulation: Simulation) -> str:
    """Returns the production that matches too."""
    reasons = simulation.agents["mind"].explain().productions
    return next(reason.name for reason in reasons if reason.matches and not reason.selected)


def in_use(simulation: Simulation) -> None:
    """Makes every change once."""
    simulation.run(0.12)
    simulation.command("forbid_once", "mind", chosen(simulation))
    simulation.run(0.13)
    simulation.command("set_buffer", "mind.goal", "rest 5")
    simulation.command("add_chunk", "mind.memory", "next 6 7")
    simulation.command("strengthen", "mind.memory", "next 0 1")
    simulation.run(0.2)
    simulation.command("fire_next", "mind", other(simulation))
    simulation.run(0.11)
    simulation.command("clear_buffer", buffer="mind.retrieval")
    simulation.command("parameter", "mind.production_time", 0.07)
    simulation.run(0.3)


def test_changes_by_hand_are_exact_after_going_back_and_in_a_replay(tmp_path: Path) -> None:
    simulation = made()
    with simulation.record(tmp_path / "run.sqlite"):
        in_use(simulation)
        first = [event.to_json() for event in simulation.trace or ()]
        for time in (0.11, 0.25, 0.0, 0.5):
            simulation.seek(time)
            simulation.run(0.86 - time)
            assert [event.to_json() for event in simulation.trace or ()] == first
    with Recorded(tmp_path / "run.sqlite") as recorded:
        assert len(list(recorded.commands())) == 7
        assert replay(recorded, made).difference is None


def test_a_change_is_undone_by_going_back_and_changing_something_else() -> None:
    simulation = made()
    simulation.run(0.12)
    simulation.command("set_buffer", "mind.goal", "rest 5")
    simulation.run(0.1)
    simulation.seek(0.12)
    assert simulation.agents["mind"].goal.chunk[0] == "count"
    simulation.command("clear_buffer", "mind.goal")
    simulation.run(0.1)
    assert [data["command"] for _, data in events(simulation, "command")] == ["clear_buffer"]
    assert simulation.agents["mind"].goal.chunk is None


def test_a_forbidden_production_is_left_out_of_one_choice_and_the_explanation_says_so() -> None:
    simulation = made()
    simulation.run(0.12)
    name = chosen(simulation)
    simulation.command("forbid_once", "mind", name)
    simulation.run(0.01)
    ((when, withdrawn),) = events(simulation, "withdrawn")
    assert (when, withdrawn) == (0.12, {"production": name})
    for at in (None, 0.12):
        reason = simulation.agents["mind"].explain(at).production(name)
        assert (reason.matches, reason.selected, reason.verdict) == (True, False, "left out: the user had forbidden it once")
    simulation.run(0.5)
    fired = [data["production"] for time, data in events(simulation, "fire") if time > 0.12]
    assert fired[0] != name  # it would have fired at 0.15 s
    assert name in fired[1:]
    assert len([1 for _, data in events(simulation, "conflict") if "forbidden" in data]) == 1


def test_a_production_that_does_not_match_yet_is_left_out_when_it_does() -> None:
    simulation = made()
    simulation.run(0.1)
    simulation.command("forbid_once", "mind", "rest")
    with pytest.raises(Actr3dError, match=r"'rest' is forbidden already, and has not been left out of a choice yet"):
        simulation.command("forbid_once", "mind", "rest")
    simulation.run(0.1)
    assert not events(simulation, "withdrawn")
    simulation.command("set_buffer", "mind.goal", "rest 1")
    simulation.run(0.3)
    agent = simulation.agents["mind"]
    assert agent.goal.chunk[0] == "rest"  # nothing else matches, so nothing fires
    assert agent.explain().production("rest").verdict == "left out: the user had forbidden it once"
    simulation.command("set_buffer", "mind.goal", "rest 2")
    simulation.run(0.1)
    assert "rest" in [data["production"] for _, data in events(simulation, "fire")]


def test_a_production_fires_next_in_place_of_the_chosen_one_whatever_its_utility() -> None:
    simulation = made()
    simulation.run(0.12)
    loser, name = chosen(simulation), other(simulation)
    simulation.command("fire_next", "mind", name)
    simulation.run(0.01)
    with pytest.raises(Actr3dError, match=f"'{name}' is about to fire already"):
        simulation.command("fire_next", "mind", name)
    for at in (None, 0.125):
        explained = simulation.agents["mind"].explain(at)
        assert explained.production(name).verdict == "selected: the user made it fire next"
        assert explained.production(loser).verdict == f"not selected: the user made {name} fire next"
    simulation.run(0.05)
    when, data = next((time, data) for time, data in events(simulation, "fire") if time > 0.12)
    assert (when, data["production"]) == (0.17, name)  # it takes its own 50 ms from the change on


@pytest.mark.parametrize(
    ("command", "problem"),
    [
        (("set_buffer", "mind.gaol", "a"), r"no buffer 'mind.gaol'; did you mean 'mind.goal'\? There are: mind.goal, mind.retrieval"),
        (("set_buffer", "mind.memory", "a"), r"no buffer 'mind.memory'.*[Tt]here are: mind.goal, mind.retrieval"),
        (("set_buffer", "mind.goal", "  "), r"'mind.goal': a chunk has at least one slot, such as 'count 3' or 'item:cup' \(got '  '\)"),
        (("set_buffer", "mind.goal", "a ?x"), r"'mind.goal': chunk 'a \?x': '\?x' is not bound .*; write a value"),
        (("set_buffer", "mind.goal", 3), r"set_buffer.chunk: must be text \(got 3\)"),
        (("set_buffer", "mind.goal"), r"command 'set_buffer': missing a required argument: 'chunk'; it takes \(buffer, chunk\)"),
        (("clear_buffer", "mind.goal", "b"), r"command 'clear_buffer': too many positional arguments; it takes \(buffer\)"),
        (("add_chunk", "mind", "a"), r"no memory 'mind'.*there are: mind.memory"),
        (("strengthen", "mind.memory", "b"), r"no chunk 'b' in 'mind.memory'; `add_chunk` adds it"),
        (
            ("fire_next", "mind", "rest"),
            r"'rest' cannot fire next, because it does not match: goal: 0:rest, expected 'rest', found 'count'",
        ),
        (("fire_next", "mind", "upp"), r"no production 'upp' in 'mind'; did you mean 'up'\? There are: recall, rest, up"),
        (("forbid_once", "mnd", "up"), r"no production system 'mnd'; did you mean 'mind'\? There are: mind"),
        (("parameter", "mind.memory.latency", "abc"), r"parameter 'mind.memory.latency': must be a number \(got 'abc'\)"),
        (("parameter", "mind.memory.latency", None), r"parameter 'mind.memory.latency': must be a number \(got None\)"),
        (("parameter", "mind.memory.latency", -0.5), r"parameter 'mind.memory.latency': must be >= 0 \(got -0.5\)"),
        (("parameter", "mind.memory.threshold", True), r"parameter 'mind.memory.threshold': must be a number \(got True\)"),
        (("parameter", "mind.memory.busy", 3), r"parameter 'mind.memory.busy': must be True or False \(got 3\)"),
        (("parameter", "mind.production_time", -1), r"parameter 'mind.production_time': must be >= 0 \(got -1.0\)"),
        (("parameter", "mind.production_time", None), r"parameter 'mind.production_time': must be a number \(got None\)"),
        (("parameter", "mind.utility.alpha", False), r"parameter 'mind.utility.alpha': must be a number \(got False\)"),
        (("parameter", "mind.production_tim", 1), r"no parameter 'mind.production_tim': 'mind' has no 'production_tim'"),
        (("set_bufer", "mind.goal", "a"), r"no command 'set_bufer'; did you mean 'set_buffer'\?"),
    ],
)
def test_a_wrong_change_names_what_is_wrong_and_changes_nothing(command: tuple[str, ...], problem: str) -> None:
    simulation = made()
    simulation.run(0.1)
    before = [event.to_json() for event in simulation.trace or ()]
    with pytest.raises(Actr3dError, match=problem):
        simulation.command(*command)
    assert [event.to_json() for event in simulation.trace or ()] == before


@pytest.mark.parametrize("text", ["a " * 10_000, "x:" + "y" * 500_000, "\ud800 ‮ <script>", "__class__:1 _name:2 0:z", "a:b:c :: :"])
def test_huge_and_hostile_chunks_are_only_text(text: str) -> None:
    def run() -> list[str]:
        simulation.run(0.1)
        return [event.to_json() for event in simulation.trace or ()]

    simulation = made()
    simulation.run(0.1)
    simulation.command("set_buffer", "mind.goal", text)
    simulation.command("add_chunk", "mind.memory", text)
    first = run()
    simulation.seek(0.05)
    simulation.run(0.05)
    assert run() == first


def test_a_chunk_is_not_strengthened_where_that_has_no_effect() -> None:
    for module, problem in (
        ("", "has no base level"),
        ("fixed = DMFixed(memory)", "has no base level"),
        ("recent = DMInhibition(memory)", None),
    ):
        agent: Any = load_text(counter_text("PMNew(alpha=0.2)").replace("strength = DMBaseLevel(memory)", module), "counter.py").Counter
        simulation = Simulation(SCENE, bodiless={"mind": agent}, seed=7)
        simulation.run(0.1)
        if problem is None:
            simulation.command("strengthen", "mind.memory", "next 0 1")
        else:
            with pytest.raises(Actr3dError, match=problem):
                simulation.command("strengthen", "mind.memory", "next 0 1")


def test_an_acted_change_waits_for_no_other_agent() -> None:
    def story(simulation: Simulation, act: Callable[[Simulation], None]) -> list[str]:
        simulation.traced()
        simulation.run(0.12)
        act(simulation)
        simulation.run(0.3)
        return [event.to_json() for event in simulation.trace or () if event.source.startswith("second")]

    def two() -> Simulation:
        return Simulation(SCENE, bodiless={"first": Counter, "second": Counter}, seed=7)

    changed = story(two(), lambda simulation: simulation.command("forbid_once", "first", "up"))
    assert changed == story(two(), lambda _: None)


@pytest.mark.parametrize("word", ["strengthen", "add_chunk"])
def test_a_chunk_given_by_hand_does_not_hide_a_failed_retrieval(word: str) -> None:
    text = """
from actr3d.actr import *
class Agent(ACTR):
    goal, retrieval = Buffer(), Buffer()
    memory = Memory(retrieval)
    base = DMBaseLevel(memory)
    def init():
        memory.add("a b")
        goal.set("begin")
    def ask(goal="begin"):
        memory.request("c ?")
        goal.set("wait")
    def failed(goal="wait", memory="error:True"): goal.set("failed")
"""
    agent = load_text(text, "failing.py").Agent()
    agent.run(0.12)
    assert agent.memory.error
    CHANGES[word]("memory", "a b").carry_out(Parts([agent]))  # pyright: ignore[reportCallIssue] # a dataclass
    agent.run(0.1)
    assert str(agent.goal.chunk) == "failed"


@pytest.mark.parametrize("module", ["PMNew(alpha=0.5)", "PMPGC()"])
def test_a_production_that_was_withdrawn_is_not_rewarded(module: str) -> None:
    text = f"""
from actr3d.actr import *
class Agent(ACTR):
    goal = Buffer()
    learning = {module}
    def init(): goal.set("begin")
    def left(goal="begin", utility=1): goal.set("end")
    def right(goal="begin"): goal.set("end")
"""
    agent = load_text(text, "choosing.py").Agent()
    agent.run(0.01)
    before = agent.get_activation("left")
    CHANGES["forbid_once"]("top", "left").carry_out(Parts([agent]))  # pyright: ignore[reportCallIssue] # a dataclass
    agent.run(0.06)
    agent.reward(10)
    assert str(agent.goal.chunk) == "end"
    assert agent.get_activation("left") == before


def test_a_body_sees_a_changed_parameter_by_its_bare_name() -> None:
    text = """
from actr3d.actr import *
class Agent(ACTR):
    goal = Buffer()
    speed = 1.2
    seen = []
    def init(): goal.set("go")
    def go(goal="go"):
        self.seen.append((speed, self.speed))
        goal.set("go")
"""
    agent = load_text(text, "speeding.py").Agent()
    agent.run(0.06)
    CHANGES["parameter"]("speed", 2.0).carry_out(Parts([agent]))  # pyright: ignore[reportCallIssue] # a dataclass
    agent.run(0.05)
    assert agent.seen == [(1.2, 1.2), (2.0, 2.0)]


def test_a_wrong_parameter_of_an_agent_without_a_name_is_called_one_of_top() -> None:
    agent = Counter()
    agent.run(0)
    with pytest.raises(Actr3dError, match="no parameter 'speed': 'top' has no 'speed'"):
        CHANGES["parameter"].of_arguments(["speed", 3], {}).carry_out(Parts([agent]))
