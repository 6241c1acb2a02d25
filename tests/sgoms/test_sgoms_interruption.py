"""Interruptions of planning units, immediately and at the end of a unit task; responses; and how an agent resumes."""

from __future__ import annotations

import math
from typing import Any

import pytest

from tests.helpers.sgoms_agents import cooking, fired, level_events
from tests.helpers.small_agents import near

AGENT = "class Agent(Base): pass"
NOW, END = "planning_unit:phone when:now", "planning_unit:phone when:end"
PHONE = ["pick_up", "talk"]


def tasks(module: Any) -> list[str]:
    return [task for _, task in module.said]


def moments(module: Any, name: str) -> list[float]:
    """Returns when a production fired."""
    return [moment for moment, production in fired(module) if production == name]


def test_a_unit_task_ends_before_an_interruption_at_its_end() -> None:
    module = cooking(AGENT, 0.22, END)
    assert tasks(module) == ["boil", *PHONE, "steep", "pour"]
    assert level_events(module, "planning_unit", "unit_task")[:6] == [
        "0 begun tea",
        "0.15 begun tea/boil",
        "0.35 ended tea/boil",
        "0.4 interrupted tea",
        "0.4 begun phone",
        "0.55 begun phone/pick_up",
    ]
    assert "1.25 ended phone" in level_events(module, "planning_unit")
    # One production requests the place, the retrieval follows, one production continues; then the next unit task is requested.
    assert level_events(module, "planning_unit")[-2:] == ["1.4 resumed tea", "2.25 ended tea"]
    assert moments(module, "sgoms_ask_next")[2:3] == near([1.45])
    events = [event.data for event in module.trace if event.kind == "planning_unit"]
    assert [event.get("by") for event in events] == [None, "phone", None, None, None, None]


def test_an_immediate_interruption_cuts_the_unit_task_which_begins_again() -> None:
    module = cooking(AGENT, 0.22, NOW)
    # At 0.22 s a step of work is in progress; it is done at 0.25 s, then the interruption is chosen.
    assert tasks(module) == ["boil", *PHONE, "boil", "steep", "pour"]
    assert level_events(module, "planning_unit", "unit_task", "method")[:8] == [
        "0 begun tea",
        "0.15 begun tea/boil",
        "0.2 begun tea/boil/work",
        "0.3 cut tea/boil/work",
        "0.3 cut tea/boil",
        "0.3 interrupted tea",
        "0.3 begun phone",
        "0.45 begun phone/pick_up",
    ]
    assert "1.3 begun tea/boil" in level_events(module, "unit_task")
    steps = [moment for moment in moments(module, "work") if moment > 1.3]
    assert len(steps) == 3 * 2


def test_a_unit_task_knows_that_it_is_done_again() -> None:
    body = """
class Agent(Base):
    def begin(b_unit_task="unit_task:?task state:start resumed:?again"):
        said.append((self.now(), f"{task} {again}"))
        b_method.set("method:work left:2")
        b_unit_task.modify(state="running")
"""
    assert tasks(cooking(body, 0.22, NOW)) == ["boil no", "pick_up no", "talk no", "boil yes", "steep no", "pour no"]


def test_a_unit_task_may_continue_where_it_was_cut() -> None:
    body = "class Agent(Base):\n    resume_at = 'method'\n    steps = 4"
    module = cooking(body, 0.31, NOW)
    assert tasks(module) == ["boil", *PHONE, "steep", "pour"]
    # Three of four steps are done when it is cut at 0.4 s: 0.25, 0.3 and 0.35.
    at = next(event.time for event in module.trace if event.data.get("what") == "resumed")
    assert [line for line in level_events(module, "planning_unit", "unit_task", "method") if line.startswith(f"{at:.10g} ")] == [
        f"{at:.10g} resumed tea",
        f"{at:.10g} resumed tea/boil",
        f"{at:.10g} resumed tea/boil/work",
    ]
    between = [moment for moment in moments(module, "work") if at < moment < at + 0.12]
    assert between == near([at + 0.05])


def test_a_method_without_slot_names_continues_where_it_was_cut() -> None:
    body = """
class Agent(Base):
    resume_at = "method"
    def begin(b_unit_task="unit_task:?task state:start"):
        said.append((self.now(), task))
        b_method.set("work 4")
        b_unit_task.modify(state="running")
    def work(b_method="work ?left!0"):
        b_method.set({0: "work", 1: int(left) - 1})
    def end(b_unit_task="state:running", b_method="work 0"):
        b_unit_task.modify(state="finished")
"""
    assert tasks(cooking(body, 0.31, NOW)) == ["boil", *PHONE, "steep", "pour"]


def test_a_situated_planning_unit_chooses_again_after_an_interruption() -> None:
    body = """
class Agent(Base):
    tidy = Situated(until="dishes:clean", wash="dishes:dirty", wipe="dishes:wet")
    def init():
        b_context.set("dishes:dirty")
        b_plan_unit.set("planning_unit:tidy")
    def dry(b_unit_task="unit_task:pick_up state:running"):
        b_context.set("dishes:wet")
        b_unit_task.modify(state="drying")
    def end(b_unit_task="state:!start!finished!drying", b_method="left:0"):
        b_unit_task.modify(state="finished")
    def dried(b_unit_task="state:drying", b_method="left:0"):
        b_unit_task.modify(state="finished")
    def all_clean(b_unit_task="unit_task:wipe state:finished", b_context="dishes:wet", utility=1):
        b_context.set("dishes:clean")
"""
    module = cooking(body, 0.2, NOW)
    assert tasks(module) == ["wash", *PHONE, "wipe"]
    assert level_events(module, "planning_unit")[-1].endswith("ended tidy")


@pytest.mark.parametrize("when", ["now", "end"])
@pytest.mark.parametrize("ring", [0.345, 0.35, 0.355, 0.395, 0.40, 0.42, 0.45, 0.46])
def test_an_interruption_between_two_unit_tasks_waits_for_neither(ring: float, when: str) -> None:
    module = cooking(AGENT, ring, f"planning_unit:phone when:{when}")
    if ring == 0.46:  # the next unit task has been chosen; it begins, and may be cut
        expected = ["boil", *PHONE, "steep", "pour"] if when == "now" else ["boil", "steep", *PHONE, "pour"]
    else:
        expected = ["boil", *PHONE, "steep", "pour"]
    assert tasks(module) == expected
    assert level_events(module, "planning_unit")[-1].endswith("ended tea")
    assert level_events(module, "unit_task").count("0.35 ended tea/boil") == 1


def test_an_interruption_before_the_first_unit_task() -> None:
    for ring in (0.0, 0.01, 0.06, 0.1):
        assert tasks(cooking(AGENT, ring, NOW)) == [*PHONE, "boil", "steep", "pour"]


def test_a_response_can_be_interrupted_itself() -> None:
    module = cooking(AGENT, 0.22, NOW, 0.6, "planning_unit:alarm when:now")
    assert tasks(module) == ["boil", "pick_up", "run", "pick_up", "talk", "boil", "steep", "pour"]
    assert [line.split(maxsplit=1)[1] for line in level_events(module, "planning_unit")] == [
        "begun tea",
        "interrupted tea",
        "begun phone",
        "interrupted phone",
        "begun alarm",
        "ended alarm",
        "resumed phone",
        "ended phone",
        "resumed tea",
        "ended tea",
    ]


def test_the_same_interruption_twice_has_two_places() -> None:
    module = cooking(AGENT, 0.22, NOW, 1.4, NOW)
    assert tasks(module) == ["boil", *PHONE, "boil", *PHONE, "boil", "steep", "pour"]
    places = [event.data["chunk"]["place"] for event in module.trace.select("add") if "saved" in event.data["chunk"]]
    assert places == ["1", "2"]


def test_an_interruption_by_the_response_that_is_running_waits_for_its_end() -> None:
    module = cooking(AGENT, 0.22, NOW, 0.6, NOW)
    assert tasks(module) == ["boil", *PHONE, *PHONE, "boil", "steep", "pour"]
    assert level_events(module, "planning_unit")[-2].endswith("resumed tea")


def test_a_response_during_the_retrieval_of_the_place_returns_to_it() -> None:
    slow = "class Agent(Base):\n    DM = Memory(SGOMS.b_DM, latency=0.2)"
    asked = moments(cooking(slow, 0.4, NOW), "sgoms_resume")[0]
    module = cooking(slow, 0.4, NOW, asked + 0.05, "planning_unit:alarm when:end")
    assert tasks(module) == ["boil", *PHONE, "run", "boil", "steep", "pour"]
    assert len([event for event in module.trace.select("add") if "saved" in event.data["chunk"]]) == 1
    assert len(moments(module, "sgoms_take_up")) == 1


def test_without_a_planning_unit_the_response_simply_runs() -> None:
    body = "class Agent(Base):\n    def init():\n        pass"
    module = cooking(body, 0.22, NOW)
    assert tasks(module) == PHONE
    assert module.agent.b_plan_unit["interrupted"] == "none"
    assert level_events(module, "planning_unit")[0] == "0.27 begun phone"
    later = cooking(AGENT, 3.0, END)
    assert tasks(later) == ["boil", "steep", "pour", *PHONE]


@pytest.mark.parametrize("bells", [(0.22, NOW), (0.22, NOW, 0.6, "planning_unit:alarm when:now"), (0.4, END, 0.7, NOW)])
def test_a_place_in_a_buffer_takes_one_production_and_no_retrieval(bells: Any) -> None:
    memory, buffer = cooking(AGENT, *bells), cooking("class Agent(Base):\n    place_kept_in = 'buffer'", *bells)
    assert tasks(memory) == tasks(buffer)
    assert buffer.agent.b_place.chunk is None
    ended = [event.time for event in buffer.trace.select("planning_unit") if event.data["what"] == "ended"]
    assert moments(buffer, "sgoms_resume_from_buffer")[-1] == near(ended[-2] + 0.05)
    assert not moments(buffer, "sgoms_resume")


FORGETFUL = """
class Agent(Base):
    tea = Ordered("boil", "steep", "pour", baselevel=0)
    phone = Ordered("pick_up", "talk", baselevel=0)
    DM = Memory(SGOMS.b_DM, threshold={threshold})
    level = DMBaseLevel(DM)
    def notice(b_plan_unit="state:lost lost:place interrupted:?unit"):
        said.append((self.now(), "forgot " + unit))
        b_plan_unit.set("planning_unit:?unit")
"""


def test_finding_back_takes_as_long_as_the_activation_of_the_place_says() -> None:
    module = cooking(FORGETFUL.format(threshold=-3), 0.22, NOW)
    left, asked, back = (moments(module, f"sgoms_{name}")[0] for name in ("interrupt_now", "resume", "take_up"))
    assert back - asked - 0.05 == near(0.05 * math.sqrt(asked - left), abs=2e-6)
    assert tasks(module) == ["boil", *PHONE, "boil", "steep", "pour"]


def test_a_forgotten_place_is_a_state_that_productions_match() -> None:
    # After about 0.8 s the activation ln(0.8 ^ -0.5) = 0.11 lies below the threshold.
    module = cooking(FORGETFUL.format(threshold=0.5).replace("baselevel=0", "baselevel=1"), 0.22, NOW)
    asked = moments(module, "sgoms_resume")[0]
    assert tasks(module) == ["boil", *PHONE, "forgot tea", "boil", "steep", "pour"]
    failed = asked + 0.05 * math.exp(-0.5)
    assert moments(module, "sgoms_forget_place") == near([failed + 0.05], abs=2e-6)
    assert module.said[3][0] == near(failed + 0.1, abs=2e-6)
    assert [line.split(maxsplit=1)[1] for line in level_events(module, "planning_unit")] == [
        "begun tea",
        "interrupted tea",
        "begun phone",
        "ended phone",
        "begun tea",
        "ended tea",
    ]


def test_a_forgotten_unit_task_is_a_state_that_productions_match() -> None:
    body = """
class Agent(Base):
    DM = Memory(SGOMS.b_DM, threshold=0)
    level = DMBaseLevel(DM)
    steps = 20
    def notice(b_plan_unit="planning_unit:?unit state:lost lost:unit_task"):
        said.append((self.now(), "forgot " + unit))
        DM.add("planning_unit:tea cuelag:start cue:boil unit_task:steep")  # looks it up
        b_plan_unit.modify(state="begin")
"""
    module = cooking(body, seconds=2)
    assert tasks(module) == ["boil", "forgot tea", "steep"]
    assert [line.split(maxsplit=1)[1] for line in level_events(module, "planning_unit")] == ["begun tea"]
    none = body.replace("threshold=0", "threshold=9").replace("DM.add(", "DM.threshold = -9; DM.add(")
    module = cooking(none, seconds=2)
    assert tasks(module) == ["forgot tea", "boil", "steep"]
    assert module.agent.b_plan_unit["lost"] == "none"


def test_a_forgotten_place_may_be_asked_for_again() -> None:
    body = FORGETFUL.format(threshold=0.5).replace("baselevel=0", "baselevel=1").replace('b_plan_unit.set("planning_unit:?unit")', "")
    body = body.replace("said.append", "DM.threshold = -9; b_plan_unit.modify(state='finished'); said.append")
    assert tasks(cooking(body, 0.22, NOW)) == ["boil", *PHONE, "forgot tea", "boil", "steep", "pour"]


def test_interruptions_by_a_quick_parallel_system_are_answered_within_one_cycle() -> None:
    module = cooking(
        """
class Ears(ProductionSystem):
    production_time = 0.01
    heard = False
    def hear(b_unit_task="unit_task:steep state:running", self="heard:False"):
        self.heard = True
        b_interrupt.set("planning_unit:phone when:now")
class Agent(Base):
    ears = Ears()
"""
    )
    heard = moments(module, "hear")[0]
    assert heard == near(0.55 + 0.01)
    assert moments(module, "sgoms_interrupt_now") == near([0.65])
    assert tasks(module) == ["boil", "steep", *PHONE, "steep", "pour"]


def test_a_unit_task_of_another_planning_unit_that_partial_matching_brings_can_be_noticed() -> None:
    body = """
class Agent(Base):
    DM = Memory(SGOMS.b_DM, threshold=-3)
    level = DMBaseLevel(DM)
    partial = Partial(DM)
    alarm = Ordered("run", baselevel=5)
    def notice(b_plan_unit="planning_unit:?unit state:retrieving", b_DM="planning_unit:!?unit unit_task:?other", DM="busy:False"):
        said.append((self.now(), f"{other} instead of {unit}"))
        b_DM.clear()
        partial.strength = 9
"""
    module = cooking(body, seconds=2)
    assert tasks(module) == ["run instead of tea", "boil", "steep", "pour"]
    assert moments(module, "sgoms_ask_again")
