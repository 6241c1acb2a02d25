"""Errors of planning units, which suggest the name that was most likely meant."""

from __future__ import annotations

import warnings
from pathlib import Path
from typing import Any, cast

import pytest

from actr3d.actr.loading import load_text, run_text
from actr3d.errors import ModelWarning, PatternException, PlanError
from actr3d.sgoms import SGOMS, Ordered, Situated
from tests.helpers.sgoms_agents import HEAD, cooking


@pytest.mark.parametrize(
    ("declare", "message"),
    [
        (lambda: Ordered(), "a planning unit needs unit tasks"),
        (lambda: Ordered("boil water"), "is one word"),
        (lambda: Ordered("boil", cast("Any", 3)), r"is one word .*\(got 3\)"),
        (lambda: Ordered("boil", "finished"), "cannot be called 'finished'"),
        (lambda: Ordered("a", "b", "a", "b", "c"), "after 'a', 'b' comes 'a' once and 'c' once"),
        (lambda: Ordered("a", "a", "a", "a"), "after 'a', 'a' comes 'a' once and 'finished' once"),
        (lambda: Situated(until="x:1"), "needs unit tasks"),
        (lambda: Situated(wash="dishes:dirty"), "it has no end; .*until="),
        (lambda: Situated(until="x:1", start="x:2"), "cannot be called 'start'"),
        (lambda: Situated(until="x:1", boil=5), r"Situated\(boil=5\): 5 is not a pattern for b_context; write text, such as '5'"),
        (lambda: Situated(until=["x:1", 2.5], boil="x:2"), r"Situated\(until=\['x:1', 2\.5\]\): 2\.5 is not a pattern"),
    ],
)
def test_invalid_planning_units_are_refused(declare: Any, message: str) -> None:
    with pytest.raises(PlanError, match=message):
        declare()


def test_a_situation_that_is_no_pattern() -> None:
    with pytest.raises(PatternException, match=r"Situated\(wash='dishes:'\)"):
        Situated(until="x:1", wash="dishes:")


def test_unit_tasks_may_be_repeated_if_cues_distinguish_them() -> None:
    assert Ordered("a", "b", "a", "c").links()[2] == ("a", "b", "a")


def body(text: str, init: str = "b_plan_unit.set('planning_unit:tea')") -> str:
    return f"""
class Agent(SGOMS):
    tea = Ordered("boil", "pour")
    phone = Situated(talk="call:open", until="call:none")
    def init():
        {init}
    def boil(b_unit_task="unit_task:boil state:start"):
        {text}
    def pour(b_unit_task="unit_task:pour state:start"):
        b_unit_task.modify(state='finished')
    def talk(b_unit_task="unit_task:talk state:start"):
        b_unit_task.modify(state='finished')
"""


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (
            "b_plan_unit.set('planning_unit:phnoe')",
            "b_plan_unit: Agent has no planning unit 'phnoe'; did you mean 'phone'? It has: phone, tea",
        ),
        ("b_plan_unit.modify(planning_unit='te')", "no planning unit 'te'; did you mean 'tea'"),
        ("b_plan_unit.set('tea')", "has no slot planning_unit; write 'planning_unit:…'"),
        ("b_plan_unit.modify(state='finnished')", "no state 'finnished'; did you mean 'finished'"),
        ("b_plan_unit.modify(state='resuming')", "'tea' did not interrupt a planning unit, so there is no saved place to resume at"),
        (
            "b_unit_task.set('unit_task:puor')",
            "no planning unit of Agent has a unit task 'puor'; did you mean 'pour'? There are: talk, boil, pour",
        ),
        ("b_unit_task.modify(unit_task='tlak')", "has a unit task 'tlak'; did you mean 'talk'"),
        ("b_unit_task.set('state:start')", "has no slot unit_task"),
        ("b_unit_task.modify(state='finishd')", "state 'finishd' does not end the unit task; did you mean 'finished'"),
        ("b_unit_task.modify(state='finish')", "state 'finish' does not end the unit task; did you mean 'finished'"),
        ("b_unit_task.modify(state='Finishing')", "state 'Finishing' does not end the unit task; did you mean 'finished'"),
        ("b_unit_task.modify(state='fin')", "state 'fin' does not end the unit task; did you mean 'finished'"),
        ("b_unit_task.set('unit_task:boil state:finish')", "state 'finish' does not end the unit task; did you mean 'finished'"),
        ("b_unit_task.clear()", "'boil' is cleared, and nothing would follow it; end it with b_unit_task.modify"),
        ("b_interrupt.set('planning_unit:phoen when:now')", "b_interrupt: Agent has no planning unit 'phoen'; did you mean 'phone'"),
        ("b_interrupt.set('planning_unit:phone')", "has no valid 'when'; 'when:now' interrupts"),
        ("b_interrupt.set('planning_unit:phone when:ned')", "has no valid 'when'; did you mean 'end'"),
        ("b_interrupt.set('phone when:now')", "b_interrupt: .* has no slot planning_unit"),
    ],
)
def test_misspelt_names_in_productions(text: str, message: str) -> None:
    with pytest.raises(PlanError, match=message.replace("?", r"\?")) as caught:
        cooking(body(text))
    assert any("in production 'boil' (planning.py:" in note for note in caught.value.__notes__)


def test_a_state_that_resembles_finished_is_one_of_the_agents_own_if_a_production_matches_it() -> None:
    more = "    def stir(b_unit_task='unit_task:boil state:finishing'):\n        b_unit_task.modify(state='finished')\n"
    agent = cooking(body("b_unit_task.modify(state='finishing')") + more).agent
    assert agent.b_plan_unit["state"] == "finished"


def test_a_unit_task_that_no_production_matches() -> None:
    text = body("b_unit_task.modify(state='finished')").replace('"boil", "pour"', '"boil", "puor"')
    with pytest.raises(PlanError, match=r"planning unit 'tea' of Agent: no production matches its unit task 'puor'.*did you mean 'pour'"):
        cooking(text)


def test_a_production_for_a_unit_task_that_no_plan_has() -> None:
    text = body("b_unit_task.modify(state='finished')")
    for more, message in (
        ("b_unit_task='unit_task:stir state:start'", "'more' can never match: no planning unit has a unit task 'stir'"),
        ("b_plan_unit='planning_unit:teaa state:finished'", "there is no planning unit 'teaa'; did you mean 'tea'"),
    ):
        with pytest.warns(ModelWarning, match=message):
            cooking(f"{text}    def more({more}): pass\n")


@pytest.mark.parametrize(
    ("line", "message"),
    [
        (
            "b_plan_unit = Buffer()",
            "Agent.b_plan_unit: must be the buffer that every SGOMS agent has; leave it out, or write b_plan_unit = SGOMS",
        ),
        ("b_interrupt = Buffer()", "Agent.b_interrupt"),
        ("own = Buffer(); DM = Memory(own)", r"Agent.DM: must be a memory with the buffer b_DM: DM = Memory\(SGOMS.b_DM\)"),
        ("resume_at = 'operator'", r"Agent.resume_at: must be 'unit_task' or 'method' \(got 'operator'\)"),
        ("place_kept_in = 'head'", r"Agent.place_kept_in: must be 'memory' or 'buffer' \(got 'head'\)"),
    ],
)
def test_parts_that_do_not_fit(line: str, message: str) -> None:
    with pytest.raises(PlanError, match=message):
        cooking(f"class Agent(Base):\n    {line}\n")


def test_keywords_of_a_planning_unit_that_the_memory_does_not_know_are_warned_of() -> None:
    own = "class Agent(Base):\n    DM = Memory(SGOMS.b_DM)\n    level = DMBaseLevel(DM)\n"
    with pytest.warns(ModelWarning, match="no activation module has a keyword 'basleevel'; did you mean 'baselevel'"):
        cooking(f"{own}    tea = Ordered('boil', 'steep', 'pour', basleevel=2)")


def test_a_misspelt_option_is_warned_of() -> None:
    with pytest.warns(ModelWarning, match="'resum_at', which is not a parameter; did you mean 'resume_at'"):
        cooking("class Agent(Base):\n    resum_at = 'method'\n")


def test_slots_that_the_library_gives_may_be_matched_without_a_warning() -> None:
    program = """
from actr3d.actr import *
from actr3d.sgoms import SGOMS, Ordered
class Agent(SGOMS):
    tea = Ordered("boil")
    def init():
        b_plan_unit.set("planning_unit:tea")
    def boil(b_unit_task="unit_task:boil state:start resumed:no type:ordered planning_unit:tea"):
        b_unit_task.modify(state="finished")
    def over(b_plan_unit="planning_unit:tea state:finished interrupted:none place:none lost:none cuelag:none cue:start unit_task:boil"):
        print("over")
    def back(b_plan_unit="state:resuming", b_DM="saved:tea"):
        print("back")
Agent().run(1)
"""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        run_text(program, "program.py")


def test_planning_units_are_inherited_and_each_agent_has_its_own_buffers() -> None:
    module: Any = load_text(HEAD + "class One(Base): pass\nclass Two(One):\n    steps = 1\n", str(Path("inherited.py")))
    world = module.World()
    world.one, world.two = module.One(), module.Two()
    world.run(0.32)
    assert world.one.b_unit_task["state"] == "running"
    assert world.two.b_unit_task["state"] == "finished"
    assert len(world.one.DM.dm) == 4 + 3 + 2


@pytest.mark.parametrize(
    ("buffer", "chunk"),
    [("b_plan_unit", "planning_unit:tea"), ("b_method", "method:pour"), ("b_interrupt", "planning_unit:phone when:now")],
)
def test_an_agent_that_has_not_started_has_no_buffer_of_its_own(buffer: str, chunk: str) -> None:
    """Setting it would change the buffer of all agents of any class, and the planning unit would never begin."""
    agent = load_text(HEAD + body("b_unit_task.modify(state='finished')"), "agent.py").Agent()
    with pytest.raises(PlanError, match=r"before its agent has started; do it in the agent's init\(\), or after its run\(0\)"):
        getattr(agent, buffer).set(chunk)
    assert not SGOMS.__dict__[buffer].chunk
    agent.run(0)
    getattr(agent, buffer).set(chunk)


@pytest.mark.parametrize(
    ("buffer", "changes", "message"),
    [
        ("b_plan_unit", {"type": "situated"}, "'tea' is of type 'ordered', not 'situated'; begin it with 'planning_unit:tea'"),
        ("b_plan_unit", {"planning_unit": "phone"}, "'phone' is of type 'situated', not 'ordered'"),
        ("b_interrupt", {"planning_unit": "phon"}, "no planning unit 'phon'; did you mean 'phone'"),
        ("b_interrupt", {"when": "nwo"}, "has no valid 'when'; did you mean 'now'"),
    ],
)
def test_modified_buffers_are_checked_like_buffers_that_are_set(buffer: str, changes: dict[str, str], message: str) -> None:
    agent = load_text(HEAD + body("b_unit_task.modify(state='finished')"), "agent.py").Agent()
    agent.run(0.06)
    agent.b_interrupt.set("planning_unit:phone when:end")
    with pytest.raises(PlanError, match=message):
        getattr(agent, buffer).modify(**changes)


@pytest.mark.parametrize(
    ("units", "message"),
    [
        (
            "ask = Situated(next='call:open', until='call:none')",
            r"Agent\.ask: production name 'sgoms_ask_next' is used twice: by this planning unit",
        ),
        (
            "check = Situated(door_open='call:open', until='call:none')\n    check_door = Situated(open='call:open', until='call:none')",
            r"Agent\.check_door: production name 'sgoms_check_door_open' is used twice: by this planning unit, and by SGOMS, another",
        ),
    ],
)
def test_two_productions_of_one_name_are_refused(units: str, message: str) -> None:
    text = body("b_unit_task.modify(state='finished')").replace("class Agent(SGOMS):", f"class Agent(SGOMS):\n    {units}")
    with pytest.raises(PlanError, match=message):
        load_text(HEAD + text, "agent.py").Agent().run(0)
