"""The productions that lead from unit task to unit task, into a response, and back.

They are ordinary productions of the agent, and take its `production_time` each. From the end of an ordered unit task to
the next: `sgoms_ask_next`, the retrieval, `sgoms_take`; of a situated one: `sgoms_look`, then the choice. An interruption
takes one production; going on after a response `sgoms_resume`, the retrieval of the place, `sgoms_take_up`.
"""
# pyright: reportSelfClsParameterName=false
# ruff: noqa: N803, N805, N816, ARG001 - productions are written in Python ACT-R's own idiom

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from actr3d.actr import ACTR
from actr3d.sgoms.units import END, PlanningUnit, Situated

if TYPE_CHECKING:  # what bodies of productions see of their agent
    from actr3d.actr import Buffer, Memory

    b_unit_task = Buffer()
    b_DM = Buffer()
    DM = Memory(b_DM)
    self: Any = None

URGENT = 10
"""The utility of productions that interrupt; those that match in a unit task have 0, unless they say or learn otherwise."""
ELSE = -10
"""The utility of asking memory again, where what it brought is of no use to the productions that wait for it."""
FIRST = 1
"""The utility of ending a situated planning unit, before its unit tasks."""


class Control(ACTR):
    """The productions of an SGOMS agent that are the same for all."""

    def sgoms_plans():
        """Puts the chains of the ordered planning units into memory."""
        self._remember_plans()

    # -- ordered planning units

    def sgoms_begin(b_plan_unit: Any = "planning_unit:?unit type:ordered cue:?cue unit_task:?task state:begin", DM: Any = "busy:False"):
        """Asks memory for the first unit task, or again for the one after the present."""
        DM.request("planning_unit:?unit cuelag:?cue cue:?task")
        self._clear_below()
        b_plan_unit.modify(state="retrieving")

    def sgoms_ask_next(
        b_plan_unit: Any = "planning_unit:?unit type:ordered cue:?cue unit_task:?task state:running",
        b_unit_task: Any = "state:finished",
        DM: Any = "busy:False",
    ):
        """Asks memory for the next unit task; the last one and the present one are the cues."""
        DM.request("planning_unit:?unit cuelag:?cue cue:?task")
        b_plan_unit.modify(state="retrieving")

    def sgoms_ask_again(
        b_plan_unit: Any = "planning_unit:?unit cue:?cue unit_task:?task state:retrieving",
        DM: Any = "busy:False error:False",
        utility: Any = ELSE,
    ):
        """Asks anew where another request has taken the place of this one."""
        DM.request("planning_unit:?unit cuelag:?cue cue:?task")

    def sgoms_take(
        b_plan_unit: Any = "planning_unit:?unit state:retrieving",
        b_DM: Any = "planning_unit:?unit unit_task:?next!finished",
        DM: Any = "busy:False",
    ):
        """Begins the unit task that memory has brought."""
        self._clear_below()
        b_plan_unit.modify(cuelag=b_DM["cuelag"], cue=b_DM["cue"], unit_task=b_DM["unit_task"], state="running")
        b_unit_task.set("unit_task:?next")
        b_DM.clear()

    def sgoms_end(
        b_plan_unit: Any = "planning_unit:?unit state:retrieving",
        b_DM: Any = "planning_unit:?unit unit_task:finished",
        DM: Any = "busy:False",
    ):
        """Ends the planning unit, as there is no further unit task."""
        b_plan_unit.modify(state="finished")
        self._clear_below()
        b_DM.clear()

    def sgoms_forget_unit_task(b_plan_unit: Any = "state:retrieving", DM: Any = "error:True"):
        """Notes that memory did not find what comes next."""
        b_plan_unit.modify(lost="unit_task", state="lost")

    # -- situated planning units

    def sgoms_begin_situated(b_plan_unit: Any = "type:situated state:begin"):
        """Looks at the situation."""
        self._clear_below()
        b_plan_unit.modify(state="choosing")

    def sgoms_look(b_plan_unit: Any = "type:situated state:running", b_unit_task: Any = "state:finished"):
        """Looks at the situation that the unit task has led to."""
        b_plan_unit.modify(state="choosing")

    # -- interruption

    def sgoms_interrupt_now(
        b_interrupt: Any = "planning_unit:?response when:now",
        b_plan_unit: Any = "planning_unit:?unit!?response state:running",
        b_unit_task: Any = "state:!finished",
        utility: Any = URGENT,
    ):
        """Cuts the unit task short."""
        self._interrupt(b_interrupt["planning_unit"])

    def sgoms_interrupt_at_end(
        b_interrupt: Any = "planning_unit:?response",
        b_plan_unit: Any = "planning_unit:?unit!?response state:running",
        b_unit_task: Any = "state:finished",
        utility: Any = URGENT,
    ):
        """Interrupts between two unit tasks."""
        self._interrupt(b_interrupt["planning_unit"])

    def sgoms_interrupt_between(
        b_interrupt: Any = "planning_unit:?response",
        b_plan_unit: Any = "planning_unit:?unit!?response state:!running!finished!resuming",
        utility: Any = URGENT,
    ):
        """Interrupts while the next unit task is being asked for or chosen, or when it is lost."""
        self._interrupt(b_interrupt["planning_unit"])

    def sgoms_answer(
        b_interrupt: Any = "planning_unit:?response",
        b_plan_unit: Any = "state:!begin!retrieving!choosing!running!lost",
        utility: Any = URGENT,
    ):
        """Answers after a planning unit, or while the place of another is being remembered."""
        self._interrupt(b_interrupt["planning_unit"])

    def sgoms_answer_idle(b_interrupt: Any = "planning_unit:?response", b_plan_unit: Any = None, utility: Any = URGENT):
        """Answers where there is nothing to interrupt."""
        self._interrupt(b_interrupt["planning_unit"])

    # -- resumption

    def sgoms_resume(b_plan_unit: Any = "interrupted:?unit!none place:?place state:finished", DM: Any = "busy:False"):
        """Asks memory for the place where the interrupted planning unit was left."""
        DM.request("saved:?unit place:?place")
        b_plan_unit.modify(state="resuming")

    def sgoms_resume_again(
        b_plan_unit: Any = "interrupted:?unit place:?place state:resuming", DM: Any = "busy:False error:False", utility: Any = ELSE
    ):
        """Asks anew where another request has taken the place of this one."""
        DM.request("saved:?unit place:?place")

    def sgoms_take_up(b_plan_unit: Any = "interrupted:?unit state:resuming", b_DM: Any = "saved:?unit", DM: Any = "busy:False"):
        """Goes on at the place that memory has brought."""
        self._take_up(b_DM.chunk)
        b_DM.clear()

    def sgoms_forget_place(b_plan_unit: Any = "state:resuming", DM: Any = "error:True"):
        """Notes that memory did not find the place."""
        b_plan_unit.modify(lost="place", state="lost")

    def sgoms_resume_from_buffer(b_plan_unit: Any = "interrupted:?unit!none state:finished", b_place: Any = "saved:?unit"):
        """Goes on at the place in the buffer."""
        self._take_up(b_place.chunk)

    def sgoms_lose_place(b_plan_unit: Any = "interrupted:?unit!none state:finished", utility: Any = ELSE):
        """Notes that the buffer does not hold the place."""
        b_plan_unit.modify(lost="place", state="lost")


IN_MEMORY = ("sgoms_resume", "sgoms_resume_again", "sgoms_take_up", "sgoms_forget_place")
"""The productions that resume where places are kept in memory."""
IN_BUFFER = ("sgoms_resume_from_buffer", "sgoms_lose_place")
"""The productions that resume where places are kept in a buffer."""


def choices(name: str, unit: PlanningUnit) -> dict[str, Callable[..., None]]:
    """Returns the productions by which a planning unit chooses what comes next in a situation; an ordered one has none."""
    if not isinstance(unit, Situated):
        return {}
    made = {f"sgoms_{name}_{task}": _choice(name, task, situation) for task, situation in unit.situations.items()}
    return {**made, f"sgoms_{name}_{END}": _end(name, unit.until)}


def _choice(unit: str, task: str, situation: Any) -> Callable[..., None]:
    def choose(
        b_plan_unit: Any = f"planning_unit:{unit} state:choosing",
        b_context: Any = situation,
    ) -> None:
        self._clear_below()
        b_plan_unit.modify(cuelag=b_plan_unit["cue"], cue=b_plan_unit["unit_task"], unit_task=task, state="running")
        b_unit_task.set({"unit_task": task})

    return choose


def _end(unit: str, situation: Any) -> Callable[..., None]:
    def end(
        b_plan_unit: Any = f"planning_unit:{unit} state:choosing",
        b_context: Any = situation,
        utility: Any = FIRST,
    ) -> None:
        b_plan_unit.modify(state="finished")
        self._clear_below()

    return end
