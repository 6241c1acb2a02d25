"""Planning units: the order and times of their unit tasks, and the trace of each level."""

from __future__ import annotations

import math
import shutil
from collections import Counter
from itertools import pairwise
from pathlib import Path
from typing import Any

import pytest

from actr3d.actr.loading import load_text
from tests.helpers.commands import run_command
from tests.helpers.paths import ROOT
from tests.helpers.sgoms_agents import HEAD, cooking, fired, level_events
from tests.helpers.small_agents import near

TIDY = """
class Agent(SGOMS):
    tidy = Situated(until="dishes:clean floor:clean", wash="dishes:dirty", sweep="floor:dirty")

    def init():
        b_context.set("dishes:dirty floor:clean")
        b_plan_unit.set("planning_unit:tidy")
    def wash(b_unit_task="unit_task:wash state:start"):
        said.append((self.now(), 'wash'))
        b_context.set("dishes:clean floor:dirty")
        b_unit_task.modify(state="finished")
    def sweep(b_unit_task="unit_task:sweep state:start"):
        said.append((self.now(), 'sweep'))
        b_context.set("dishes:clean floor:clean")
        b_unit_task.modify(state="finished")
"""


def test_an_ordered_planning_unit_takes_two_productions_and_a_retrieval_from_unit_task_to_unit_task() -> None:
    module = cooking()
    # 0.15 s to ask, retrieve and take; each unit task lasts 0.05 (begin) + 2 * 0.05 (steps) + 0.05 s (end).
    assert module.said == [(near(0.2), "boil"), (near(0.2 + 0.3 + 0.05), "steep"), (near(0.2 + 2 * 0.35), "pour")]
    assert [name for _, name in fired(module)][:3] == ["sgoms_begin", "sgoms_take", "begin"]
    assert level_events(module, "planning_unit") == ["0 begun tea", "1.2 ended tea"]
    assert module.agent.b_plan_unit["state"] == "finished"
    assert module.agent.b_unit_task.chunk is None


@pytest.mark.parametrize("activation", [-0.5, 0.0, 1.5])
def test_the_next_unit_task_is_retrieved_with_its_activation(activation: float) -> None:
    module = cooking(
        f"""
class Agent(Base):
    DM = Memory(SGOMS.b_DM, latency=0.1, threshold=-1)
    level = DMBaseLevel(DM)
    tea = Ordered("boil", "steep", "pour", baselevel={activation})
"""
    )
    moments = [moment for moment, _ in module.said]
    assert [b - a for a, b in pairwise(moments)] == near([0.3 + 0.1 * math.exp(-activation)] * 2, abs=2e-6)
    request = module.trace.select("request", "agent.DM")[1]
    assert [candidate[0] for candidate in request.data["candidates"]] == ["cue:boil cuelag:start planning_unit:tea unit_task:steep"]


def test_a_situated_planning_unit_follows_the_situation() -> None:
    module = cooking(TIDY)
    # Begin and choose take 0.05 s each; likewise to look at the new situation and to choose.
    assert module.said == [(near(0.15), "wash"), (near(0.3), "sweep")]
    assert [name for _, name in fired(module)][-2:] == ["sgoms_look", "sgoms_tidy_finished"]
    assert level_events(module, "planning_unit", "unit_task") == [
        "0 begun tidy",
        "0.1 begun tidy/wash",
        "0.15 ended tidy/wash",
        "0.25 begun tidy/sweep",
        "0.3 ended tidy/sweep",
        "0.4 ended tidy",
    ]


def test_a_situated_planning_unit_waits_until_something_fits() -> None:
    module = cooking(TIDY.replace('b_context.set("dishes:dirty floor:clean")', 'b_context.set("dishes:unknown")'))
    assert module.said == []
    module.agent.b_context.set("dishes:dirty")
    module.agent.parent.run(1)
    assert module.said[0] == (near(10.1), "wash")


def test_utility_decides_between_unit_tasks_that_fit_and_chance_between_equals() -> None:
    both = TIDY.replace("dishes:dirty floor:clean", "dishes:dirty floor:dirty")
    firsts = Counter(cooking(both, seconds=0.2, seed=seed, traced=False).said[0][1] for seed in range(64))
    assert abs(firsts["wash"] - 32) < 16  # four standard errors
    assert firsts.total() == 64
    assert firsts.keys() == {"wash", "sweep"}


def test_every_level_is_traced_with_its_path() -> None:
    module = cooking(
        """
class Agent(SGOMS):
    tea = Ordered("boil", "pour")
    def init():
        b_plan_unit.set("planning_unit:tea")
    def boil(b_unit_task="unit_task:boil state:start"):
        b_method.set("method:heat state:start")
        b_unit_task.modify(state="running")
    def press(b_method="method:heat state:start", b_operator=None):
        b_operator.set("operator:press")
    def hot(b_operator="operator:press"):
        b_operator.clear()
        b_method.modify(state="finished")
    def boiled(b_unit_task="unit_task:boil state:running", b_method="state:finished"):
        b_unit_task.modify(state="finished")
    def pour(b_unit_task="unit_task:pour state:start"):
        b_method.set("method:tilt")
        b_unit_task.modify(state="finished")
"""
    )
    assert level_events(module, "planning_unit", "unit_task", "method", "operator") == [
        "0 begun tea",
        "0.15 begun tea/boil",
        "0.2 begun tea/boil/heat",
        "0.25 begun tea/boil/heat/press",
        "0.3 ended tea/boil/heat/press",
        "0.3 ended tea/boil/heat",
        "0.35 ended tea/boil",
        "0.5 begun tea/pour",
        "0.55 begun tea/pour/tilt",
        "0.55 ended tea/pour/tilt",
        "0.55 ended tea/pour",
        "0.7 ended tea",
    ]
    sources = {event.kind: event.source for event in module.trace if event.kind in ("planning_unit", "unit_task", "method", "operator")}
    assert sources == {
        "planning_unit": "agent.b_plan_unit",
        "unit_task": "agent.b_unit_task",
        "method": "agent.b_method",
        "operator": "agent.b_operator",
    }


def test_a_method_that_is_set_again_restarts_and_one_that_continues_does_not() -> None:
    module = cooking(
        """
class Agent(SGOMS):
    tea = Ordered("boil")
    def init():
        b_plan_unit.set("planning_unit:tea")
    def boil(b_unit_task="unit_task:boil state:start"):
        b_method.set("method:heat what:water state:start")
        b_unit_task.modify(state="running")
    def go(b_method="method:heat what:?what state:start"):
        b_method.set("method:heat what:?what state:running")
    def again(b_method="method:heat what:water state:running"):
        b_method.set("method:heat what:milk state:start")
    def given_up(b_method="method:heat what:milk state:running", b_plan_unit="state:running"):
        b_plan_unit.set("planning_unit:tea")
""",
        seconds=0.45,
    )
    assert level_events(module, "planning_unit", "method") == [
        "0 begun tea",
        "0.2 begun tea/boil/heat",
        "0.3 ended tea/boil/heat",
        "0.3 begun tea/boil/heat",
        "0.4 cut tea/boil/heat",
        "0.4 cut tea",
        "0.4 begun tea",
    ]


def test_a_trace_that_begins_later_shows_what_is_in_progress() -> None:
    module = cooking(seconds=0.22)
    later = module.agent.traced("production")
    module.agent.parent.run(0.3)
    progress = [(event.kind, event.data["what"], event.data["path"]) for event in later if "path" in event.data]
    assert sorted(progress[:3]) == [
        ("method", "going on", "tea/boil/work"),
        ("planning_unit", "going on", "tea"),
        ("unit_task", "going on", "tea/boil"),
    ]
    assert progress[3:] == [("method", "ended", "tea/boil/work"), ("unit_task", "ended", "tea/boil"), ("unit_task", "begun", "tea/steep")]


def test_explain_includes_the_productions_of_plans() -> None:
    module = cooking(TIDY)
    text = str(module.agent.explain(at=0.07))
    assert "+ sgoms_tidy_wash: matches" in text
    assert "- sgoms_tidy_sweep: b_context: floor:dirty\n      expected 'dirty', found 'clean'" in text
    ordered = cooking()
    assert "+ sgoms_ask_next: matches" in str(ordered.agent.explain(at=0.37))


def test_the_same_seed_gives_the_same_events_and_tracing_changes_nothing() -> None:
    noisy = "class Agent(Base):\n    DM = Memory(SGOMS.b_DM, threshold=-5)\n    noise = DMNoise(DM)"
    first, second, other = cooking(noisy), cooking(noisy), cooking(noisy, seed=2)
    assert [event.to_json() for event in first.trace] == [event.to_json() for event in second.trace]
    assert first.said == cooking(noisy, traced=False).said != other.said


def test_an_agent_without_an_environment_may_continue_with_another_planning_unit() -> None:
    module: Any = load_text(
        HEAD
        + """
class Agent(Base):
    def then(b_plan_unit="planning_unit:tea state:finished"):
        b_plan_unit.set("planning_unit:alarm")
    def over(b_plan_unit="planning_unit:alarm state:finished"):
        self.stop()
""",
        "alone.py",
    )
    agent = module.Agent()
    agent.run()
    assert [task for _, task in module.said] == ["boil", "steep", "pour", "run"]
    assert agent.now() == near(1.2 + 0.05 + 0.15 + 0.2 + 0.15 + 0.05)


def test_a_retrieval_of_the_plan_that_another_request_replaces_is_requested_again() -> None:
    module = cooking(
        """
class Meddler(ProductionSystem):
    production_time = 0.01
    done = False
    def meddle(b_plan_unit="cue:start state:retrieving", self="done:False"):
        DM.request("other:thing")
        self.done = True
class Agent(Base):
    meddler = Meddler()
    def known():
        DM.add("other:thing")
    def begin(b_unit_task="unit_task:?task state:start"):
        said.append((self.now(), task))
        b_unit_task.modify(state="finished")
""",
        seconds=0.45,
    )
    assert "sgoms_ask_again" in [name for _, name in fired(module)]


@pytest.mark.daily(2)
@pytest.mark.parametrize("name", ["planning_units", "sgoms_patrol", "sgoms_rows"])
def test_models_with_buffers_of_their_own_run_without_warnings(name: str, tmp_path: Path) -> None:
    copy = shutil.copy(ROOT / "tests" / "models" / f"{name}.py", tmp_path)
    done = run_command("run", str(copy), "--seed", "1", folder=tmp_path)
    assert (done.returncode, done.stderr) == (0, "")
