"""The SGOMS agent: an ACT-R agent that works by planning units, and can be interrupted and resume.

Its productions move from unit task to unit task, into a response, and back. They are ordinary productions of the agent, and
take its `production_time` each. Between two ordered unit tasks: `sgoms_ask_next`, a retrieval, `sgoms_take`. Between two
situated unit tasks: `sgoms_look`, then the production of the chosen unit task. An interruption takes one production. A
resumption takes `sgoms_resume`, the retrieval of the saved place, and `sgoms_take_up`; if places are stored in a buffer, only
`sgoms_resume_from_buffer`.
"""
# pyright: reportSelfClsParameterName=false
# ruff: noqa: N803, N805, N815, N816, ARG001 - buffers and productions follow Python ACT-R's own idiom

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING, Any

from actr3d.actr import ACTR, Buffer, Chunk, Memory
from actr3d.actr.chunks.pattern import slot_named
from actr3d.actr.declarative.memory import buffer_of
from actr3d.actr.kernel.class_members import Method
from actr3d.errors import PlanError
from actr3d.sgoms.checks import check_plans
from actr3d.sgoms.levels import LEVELS, Interruption, Level, PlanUnitLevel, UnitTaskLevel
from actr3d.sgoms.units import END, START, Ordered, PlanningUnit, Plans, Situated

if TYPE_CHECKING:  # names that bodies of productions use
    b_unit_task = Buffer()
    b_DM = Buffer()
    DM = Memory(b_DM)
    self: Any = None

URGENT = 10
"""The utility of productions that interrupt; those that match in a unit task have 0 by default, before learning."""
FALLBACK = -10
"""The utility of the productions that repeat a request, or give up, when no other production matches."""
END_PRIORITY = 1
"""The utility of ending a situated planning unit, higher than that of its unit tasks."""

IN_MEMORY = ("sgoms_resume", "sgoms_resume_again", "sgoms_take_up", "sgoms_forget_place")
"""The productions that resume if places are stored in memory."""
IN_BUFFER = ("sgoms_resume_from_buffer", "sgoms_lose_place")
"""The productions that resume if places are stored in a buffer."""

PREFIXES = dict(zip(("plan", "task", "method", "operator"), LEVELS, strict=True))
"""Prefixes of the slots of each level's chunk in a place, whose names would clash otherwise."""


class SGOMS(ACTR):
    """An ACT-R agent whose work is divided into planning units, these into unit tasks, methods and operators.

    A subclass declares planning units (`Ordered`, `Situated`) as attributes, and has productions that match the buffers:
    `b_context` (the situation), `b_plan_unit`, `b_unit_task`, `b_method`, `b_operator`, and `b_interrupt`, which asks for
    an interruption. `DM` with its buffer `b_DM` is the declarative memory; a subclass may give another one:
    `DM = Memory(SGOMS.b_DM, threshold=-2)`.

    Source: West & Nagy (2007), Using GOMS for modeling routine tasks within complex sociotechnical systems, Journal of
    Cognitive Engineering and Decision Making 1; West & Somers (2011), Scaling up from micro cognition to macro cognition.
    Resumption follows the idea that a suspended goal is a chunk to be remembered: Altmann & Trafton (2002), Cognitive
    Science 26.
    """

    b_context = Buffer()
    b_plan_unit = PlanUnitLevel("planning_unit")
    b_unit_task = UnitTaskLevel("unit_task")
    b_method = Level("method")
    b_operator = Level("operator")
    b_interrupt = Interruption()
    b_place = Buffer()
    b_DM = Buffer()
    DM: Memory
    place_kept_in = "memory"
    """Where the place of an interruption is stored: «memory», or «buffer», where retrieval takes no time and never fails."""
    resume_at = "unit_task"
    """Where an interrupted unit task resumes: at the start of the «unit_task» (a situated planning unit looks at the
    situation again), or at the «method»: with its state, method and operator."""

    _plans: Plans
    _interruptions = 0
    """Number of saved places."""

    def _convert_info(self, objects: dict[str, Any], methods: dict[str, Method]) -> None:
        units = {name: thing for name, thing in objects.items() if isinstance(thing, (Ordered, Situated))}
        vars(self)["_plans"] = Plans(type(self).__name__, units)
        if "DM" not in objects:  # not in the class, where all agents would share what a modeller adds to it
            objects["DM"] = Memory(objects["b_DM"])
        self._check_members(objects)
        options = {**objects, **vars(self)}
        for name in IN_BUFFER if options["place_kept_in"] == "memory" else IN_MEMORY:
            methods.pop(name, None)
        for name, unit in units.items():
            made = choices(name, unit)
            if taken := sorted(made.keys() & methods.keys()):
                raise PlanError(
                    f"{type(self).__name__}.{name}: production name '{taken[0]}' is used twice: by this planning unit, and by "
                    "SGOMS, another planning unit or your own production; rename the planning unit or its unit task"
                )
            methods.update(made)
        super()._convert_info(objects, methods)

    def _check_members(self, objects: dict[str, Any]) -> None:
        kind = type(self).__name__
        options = {**objects, **vars(self)}
        for name, known in (("place_kept_in", ("memory", "buffer")), ("resume_at", ("unit_task", "method"))):
            if options[name] not in known:
                raise PlanError(f"{kind}.{name}: must be {' or '.join(map(repr, known))} (got {options[name]!r})")
        for name in (*LEVELS, "b_interrupt"):
            if not isinstance(objects[name], (Level, Interruption)):
                raise PlanError(
                    f"{kind}.{name}: must be the buffer that every SGOMS agent has; leave it out, or write {name} = SGOMS.{name} "
                    "if a module of this class needs it as an argument"
                )
        if not isinstance(objects["DM"], Memory) or buffer_of(objects["DM"]) is not objects["b_DM"]:
            raise PlanError(f"{kind}.DM: must be a memory with the buffer b_DM: DM = Memory(SGOMS.b_DM)")

    def _settable(self) -> set[str]:
        return super()._settable() | {"place_kept_in", "resume_at"}

    def _begin(self) -> None:
        check_plans(self, self._plans.units)
        super()._begin()

    # -- called by the productions

    def _remember_plans(self) -> None:
        for name, unit in self._plans.units.items():
            unit.remember(name, self.DM)

    def _clear_below(self) -> None:
        """Clears unit task, method and operator."""
        for buffer in (self.b_operator, self.b_method, self.b_unit_task):
            if buffer.chunk is not None:
                Buffer.clear(buffer)

    def _interrupt(self, response: str) -> None:
        """Saves the present place, if there is one, and begins the response."""
        plan = self.b_plan_unit.chunk
        back = {"interrupted": "none", "place": "none"}
        if plan is not None and plan["state"] in ("finished", "resuming"):
            back = {slot: plan[slot] for slot in back}  # this response is over; the next one returns to the same place
        elif plan is not None:
            back = {"interrupted": plan["planning_unit"], "place": self._save(plan)}
            trace = self.sch.trace
            if trace is not None and trace.production:
                self.b_plan_unit.trace_end(trace, "interrupted", by=response)
        self._clear_below()
        self.b_interrupt.clear()
        self.b_plan_unit.set({"planning_unit": response, **back})

    def _save(self, plan: Chunk) -> str:
        """Saves the present place, and returns its number."""
        self._interruptions += 1
        number = str(self._interruptions)
        place = _place_of(self, plan, number, whole=self.resume_at == "method")
        if self.place_kept_in == "memory":
            self.DM.add(place)
        else:
            self.b_place.set({**place, "before": self.b_place.chunk})
        return number

    def _take_up(self, place: Chunk) -> None:
        """Restores a saved place."""
        if self.place_kept_in == "buffer":
            before = place["before"]
            if before is None:
                self.b_place.clear()
            else:
                self.b_place.set(before)
        self._clear_below()
        _put_back(self, place)

    # -- productions: start

    def sgoms_plans():
        """Adds the chains of the ordered planning units to memory."""
        self._remember_plans()

    # -- ordered planning units

    def sgoms_begin(b_plan_unit: Any = "planning_unit:?unit type:ordered cue:?cue unit_task:?task state:begin", DM: Any = "busy:False"):
        """Requests the first unit task from memory; after a resumption or a failed retrieval, the one after the present unit task."""
        DM.request("planning_unit:?unit cuelag:?cue cue:?task")
        self._clear_below()
        b_plan_unit.modify(state="retrieving")

    def sgoms_ask_next(
        b_plan_unit: Any = "planning_unit:?unit type:ordered cue:?cue unit_task:?task state:running",
        b_unit_task: Any = "state:finished",
        DM: Any = "busy:False",
    ):
        """Requests the next unit task from memory; the previous unit task and the present one are the cues."""
        DM.request("planning_unit:?unit cuelag:?cue cue:?task")
        b_plan_unit.modify(state="retrieving")

    def sgoms_ask_again(
        b_plan_unit: Any = "planning_unit:?unit cue:?cue unit_task:?task state:retrieving",
        DM: Any = "busy:False error:False",
        utility: Any = FALLBACK,
    ):
        """Repeats the request for the next unit task, if another request has replaced it."""
        DM.request("planning_unit:?unit cuelag:?cue cue:?task")

    def sgoms_take(
        b_plan_unit: Any = "planning_unit:?unit state:retrieving",
        b_DM: Any = "planning_unit:?unit unit_task:?next!finished",
        DM: Any = "busy:False",
    ):
        """Begins the retrieved unit task."""
        self._clear_below()
        b_plan_unit.modify(cuelag=b_DM["cuelag"], cue=b_DM["cue"], unit_task=b_DM["unit_task"], state="running")
        b_unit_task.set("unit_task:?next")
        b_DM.clear()

    def sgoms_end(
        b_plan_unit: Any = "planning_unit:?unit state:retrieving",
        b_DM: Any = "planning_unit:?unit unit_task:finished",
        DM: Any = "busy:False",
    ):
        """Ends the planning unit after its last unit task."""
        b_plan_unit.modify(state="finished")
        self._clear_below()
        b_DM.clear()

    def sgoms_forget_unit_task(b_plan_unit: Any = "state:retrieving", DM: Any = "error:True"):
        """Notes that memory did not find the next unit task."""
        b_plan_unit.modify(lost="unit_task", state="lost")

    # -- situated planning units

    def sgoms_begin_situated(b_plan_unit: Any = "type:situated state:begin"):
        """Starts the choice of the first unit task by the situation."""
        self._clear_below()
        b_plan_unit.modify(state="choosing")

    def sgoms_look(b_plan_unit: Any = "type:situated state:running", b_unit_task: Any = "state:finished"):
        """Starts the choice of the next unit task by the situation."""
        b_plan_unit.modify(state="choosing")

    # -- interruption

    def sgoms_interrupt_now(
        b_interrupt: Any = "planning_unit:?response when:now",
        b_plan_unit: Any = "planning_unit:?unit!?response state:running",
        b_unit_task: Any = "state:!finished",
        utility: Any = URGENT,
    ):
        """Interrupts within a unit task."""
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
        """Interrupts during retrieval or choice of the next unit task, or when it is lost."""
        self._interrupt(b_interrupt["planning_unit"])

    def sgoms_answer(
        b_interrupt: Any = "planning_unit:?response",
        b_plan_unit: Any = "state:!begin!retrieving!choosing!running!lost",
        utility: Any = URGENT,
    ):
        """Starts the response when the planning unit is finished, or while the place of an interrupted one is being retrieved."""
        self._interrupt(b_interrupt["planning_unit"])

    def sgoms_answer_idle(b_interrupt: Any = "planning_unit:?response", b_plan_unit: Any = None, utility: Any = URGENT):
        """Starts the response when there is nothing to interrupt."""
        self._interrupt(b_interrupt["planning_unit"])

    # -- resumption

    def sgoms_resume(b_plan_unit: Any = "interrupted:?unit!none place:?place state:finished", DM: Any = "busy:False"):
        """Requests the place of the interrupted planning unit from memory."""
        DM.request("saved:?unit place:?place")
        b_plan_unit.modify(state="resuming")

    def sgoms_resume_again(
        b_plan_unit: Any = "interrupted:?unit place:?place state:resuming", DM: Any = "busy:False error:False", utility: Any = FALLBACK
    ):
        """Repeats the request for the place, if another request has replaced it."""
        DM.request("saved:?unit place:?place")

    def sgoms_take_up(b_plan_unit: Any = "interrupted:?unit state:resuming", b_DM: Any = "saved:?unit", DM: Any = "busy:False"):
        """Resumes at the retrieved place."""
        self._take_up(b_DM.chunk)
        b_DM.clear()

    def sgoms_forget_place(b_plan_unit: Any = "state:resuming", DM: Any = "error:True"):
        """Notes that memory did not find the place."""
        b_plan_unit.modify(lost="place", state="lost")

    def sgoms_resume_from_buffer(b_plan_unit: Any = "interrupted:?unit!none state:finished", b_place: Any = "saved:?unit"):
        """Resumes at the place in the buffer."""
        self._take_up(b_place.chunk)

    def sgoms_lose_place(b_plan_unit: Any = "interrupted:?unit!none state:finished", utility: Any = FALLBACK):
        """Notes that the buffer does not hold the place."""
        b_plan_unit.modify(lost="place", state="lost")


def choices(name: str, unit: PlanningUnit) -> dict[str, Callable[..., None]]:
    """Returns the productions of a situated planning unit that choose the next unit task; an ordered one has none."""
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
        utility: Any = END_PRIORITY,
    ) -> None:
        b_plan_unit.modify(state="finished")
        self._clear_below()

    return end


def _place_of(agent: Any, plan: Chunk, number: str, *, whole: bool) -> dict[Any, Any]:
    """Returns the chunk of an agent's present place.

    Its slots: `saved` (the planning unit) and `place` (its number), which identify it, and those of the chunks
    in the agent's buffers, as `plan_cue` or `task_state`.

    Args:
        agent: The agent.
        plan: Its present planning unit.
        number: The number of the interruption.
        whole: Whether an interrupted unit task continues where it was; otherwise it starts again.
    """
    chunks: dict[str, dict[Any, Any]] = {"plan": dict(plan)}
    task = agent.b_unit_task.chunk
    if plan["state"] == "retrieving":
        chunks["plan"]["state"] = "begin"  # the request is repeated on resumption
    if task is not None and task["state"] == END:
        chunks["task"] = dict(task)
    elif task is not None and whole:
        for prefix, buffer in list(PREFIXES.items())[1:]:
            chunk = getattr(agent, buffer).chunk
            if chunk is not None:
                chunks[prefix] = dict(chunk)
        chunks["task"]["resumed"] = "yes"
    elif task is not None and plan["type"] == "situated":
        chunks["plan"]["state"] = "choosing"
    elif task is not None:
        chunks["task"] = {**task, "state": START, "resumed": "yes"}
    saved = {f"{prefix}_{slot}": value for prefix, slots in chunks.items() for slot, value in slots.items()}
    return {"saved": plan["planning_unit"], "place": number, **saved}


def _put_back(agent: Any, place: Chunk) -> None:
    """Restores an agent's buffers from a place."""
    for prefix, buffer in PREFIXES.items():
        start = f"{prefix}_"
        slots = {
            slot_named(slot.removeprefix(start)): value for slot, value in place.items() if isinstance(slot, str) and slot.startswith(start)
        }
        if slots:
            again = prefix == "task" and slots["state"] == START
            getattr(agent, buffer).put_back(slots, "begun" if again else "resumed")
