"""The SGOMS agent: an ACT-R agent that works by planning units, and can be interrupted and resume."""

# ruff: noqa: N815 - as buffers are called in models of this kind

from __future__ import annotations

from typing import Any

from actr3d.actr import Buffer, Chunk, Memory
from actr3d.actr.kernel.class_members import Method
from actr3d.errors import PlanError, did_you_mean
from actr3d.sgoms.checks import check_plans
from actr3d.sgoms.control import IN_BUFFER, IN_MEMORY, Control, choices
from actr3d.sgoms.levels import LEVELS, Interruption, Level, PlanUnitLevel, UnitTaskLevel
from actr3d.sgoms.places import place_of, put_back
from actr3d.sgoms.units import Ordered, PlanningUnit, Situated


class SGOMS(Control):
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
    """Where the place is kept at which a planning unit was interrupted: «memory», or «buffer», where it costs and fails nothing."""
    resume_at = "unit_task"
    """Where a unit task that was cut short goes on: at the start of the «unit_task» (a situated planning unit looks at the
    situation anew), or at the «method»: with the state, the method and the operator as they were."""

    _units: dict[str, PlanningUnit]
    _interruptions = 0
    """How many places have been saved."""

    def _convert_info(self, objects: dict[str, Any], methods: dict[str, Method]) -> None:
        units = {name: thing for name, thing in objects.items() if isinstance(thing, (Ordered, Situated))}
        self.__dict__["_units"] = units
        if "DM" not in objects:  # not in the class, where what a modeller adds to it would be every agent's
            objects["DM"] = Memory(objects["b_DM"])
        self._check_members(objects)
        options = {**objects, **self.__dict__}
        for name in IN_BUFFER if options["place_kept_in"] == "memory" else IN_MEMORY:
            methods.pop(name, None)
        for name, unit in units.items():
            methods.update(choices(name, unit))
        super()._convert_info(objects, methods)

    def _check_members(self, objects: dict[str, Any]) -> None:
        kind = type(self).__name__
        options = {**objects, **self.__dict__}
        for name, known in (("place_kept_in", ("memory", "buffer")), ("resume_at", ("unit_task", "method"))):
            if options[name] not in known:
                raise PlanError(f"{kind}.{name}: must be {' or '.join(map(repr, known))} (got {options[name]!r})")
        for name in (*LEVELS, "b_interrupt"):
            if not isinstance(objects[name], (Level, Interruption)):
                raise PlanError(
                    f"{kind}.{name}: must be the buffer that every SGOMS agent has; leave it out, or write {name} = SGOMS.{name} "
                    "where a module is made with it"
                )
        if not isinstance(objects["DM"], Memory) or objects["DM"]._buffer is not objects["b_DM"]:
            raise PlanError(f"{kind}.DM: must be a memory with the buffer b_DM: DM = Memory(SGOMS.b_DM)")

    def _settable(self) -> set[str]:
        return super()._settable() | {"place_kept_in", "resume_at"}

    def _begin(self) -> None:
        check_plans(self, self._units)
        super()._begin()

    # -- names

    def _unit(self, name: str, where: str) -> PlanningUnit:
        """Returns a planning unit by its name.

        Raises:
            PlanError: If there is none.
        """
        if name not in self._units:
            known = ", ".join(self._units) or "none"
            raise PlanError(
                f"{where}: {type(self).__name__} has no planning unit '{name}'{did_you_mean(name, self._units)}; it has: {known}"
            )
        return self._units[name]

    def _check_unit_task(self, name: str) -> None:
        known = [task for unit in self._units.values() for task in unit.unit_tasks]
        if name not in known:
            raise PlanError(
                f"b_unit_task: no planning unit of {type(self).__name__} has a unit task '{name}'{did_you_mean(name, known)}; "
                f"there are: {', '.join(dict.fromkeys(known)) or 'none'}"
            )

    # -- what the productions of `Control` do

    def _remember_plans(self) -> None:
        for name, unit in self._units.items():
            unit.remember(name, self.DM)

    def _clear_below(self) -> None:
        """Clears what the planning unit is about."""
        for buffer in (self.b_operator, self.b_method, self.b_unit_task):
            if buffer.chunk is not None:
                Buffer.clear(buffer)

    def _interrupt(self, response: str) -> None:
        """Saves the place, where there is one to go back to, and begins the response."""
        plan = self.b_plan_unit.chunk
        back = {"interrupted": "none", "place": "none"}
        if plan is not None and plan["state"] in ("finished", "resuming"):
            back = {slot: plan[slot] for slot in back}  # this response is over; the next one goes back to the same place
        elif plan is not None:
            back = {"interrupted": plan["planning_unit"], "place": self._save(plan)}
            trace = self.sch.trace
            if trace is not None and trace.production:
                self.b_plan_unit._end(trace, "interrupted", by=response)
        self._clear_below()
        self.b_interrupt.clear()
        self.b_plan_unit.set({"planning_unit": response, **back})

    def _save(self, plan: Chunk) -> str:
        """Saves the present place, and returns the number it has."""
        self._interruptions += 1
        number = str(self._interruptions)
        place = place_of(self, plan, number, whole=self.resume_at == "method")
        if self.place_kept_in == "memory":
            self.DM.add(place)
        else:
            self.b_place.set({**place, "before": self.b_place.chunk})
        return number

    def _take_up(self, place: Chunk) -> None:
        """Puts everything back as it was at a saved place."""
        if self.place_kept_in == "buffer":
            before = place["before"]
            if before is None:
                self.b_place.clear()
            else:
                self.b_place.set(before)
        self._clear_below()
        put_back(self, place)
