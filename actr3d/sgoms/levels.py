"""The buffers of SGOMS: one for each level. They tell a trace what begins and ends on their level."""

from __future__ import annotations

from typing import Any

from actr3d.actr import Buffer, Chunk
from actr3d.actr.chunks.chunk import as_text
from actr3d.actr.lint.slot_names import is_slip
from actr3d.errors import PlanError, did_you_mean
from actr3d.sgoms.units import BEFORE, END, START
from actr3d.trace import Trace

LEVELS = ("b_plan_unit", "b_unit_task", "b_method", "b_operator")
"""The buffers of the four levels, from the top."""
STATES = ("begin", "retrieving", "choosing", "running", "finished", "resuming", "lost")
"""The states of a planning unit."""


def _agent_of(buffer: Buffer) -> Any:
    """Returns whose buffer it is.

    Raises:
        PlanError: If its agent does not live yet: until then the buffer is that of the class, which every agent begins with.
    """
    agent = buffer.__dict__.get("parent")
    if agent is None:
        raise PlanError("a buffer of SGOMS is set before its agent lives; do it in the agent's init(), or after its run(0)")
    return agent


class Level(Buffer):
    """Holds what an agent is about on one level: a chunk with a slot named after the level, and `state`.

    It has begun when it is there, and ended when its state is «finished», or it is cleared or replaced. A trace is
    told of both, from what the buffer holds; nothing is kept for that without one.

    Args:
        key: The level: the slot that holds the name, and the kind of the trace's events.
    """

    _dropped = "ended"
    """What has become of something that is cleared or replaced before its state is «finished»."""

    def __init__(self, key: str) -> None:
        super().__init__()
        self._key = key
        self._open: str | None = None
        """What the trace knows to have begun, and not to have ended."""
        self._seen: Chunk | None = None
        """The chunk of which the trace was told."""
        self._beginning = "begun"

    def _agent(self) -> Any:
        return _agent_of(self)

    def set(self, chunk: object) -> None:
        """Puts a chunk in.

        Raises:
            PlanError: If its agent does not live yet.
        """
        self._agent()
        super().set(chunk)

    def _made(self, chunk: object) -> Chunk:
        """Returns the chunk that `set` is to put in."""
        self._agent()
        return Chunk(chunk, self.sch.bound)

    def _put(self, slots: dict[str, Any], beginning: str) -> None:
        """Puts a chunk in, which begins in a way of its own: it is resumed."""
        self._beginning = beginning
        try:
            self.set(slots)
        finally:
            self._beginning = "begun"

    # -- what a trace is told

    def _over(self, chunk: Chunk) -> bool:
        """Tells whether what is there has ended."""
        return chunk.get("state") == END

    def _name(self) -> str | None:
        """Returns what is there and has not ended."""
        chunk = self.chunk
        return None if not chunk or self._key not in chunk or self._over(chunk) else as_text(chunk[self._key])

    def _trace_change(self, trace: Trace, key: str, value: Any) -> None:
        super()._trace_change(trace, key, value)
        if key == "chunk" and trace.production:
            name, chunk = self._name(), self.chunk
            anew = chunk is not None and chunk is not self._seen and chunk.get("state", START) in (START, "begin")
            self._seen = chunk
            if self._open is not None and (name != self._open or anew):
                self._end(trace, "ended" if chunk is not None and self._over(chunk) else self._dropped)
            if name is not None and self._open is None:
                self._open = name
                self._tell(trace, self._beginning)

    def _trace_state(self, trace: Trace) -> None:
        super()._trace_state(trace)
        self._open, self._seen = self._name(), self.chunk
        if self._open is not None and trace.production:
            self._tell(trace, "going on")

    def _end(self, trace: Trace, what: str, **more: str) -> None:
        """Tells that what is open has ended, after all that belongs to it."""
        if self._open is None:
            return
        for below in reversed(self._others(below=True)):
            below._end(trace, "ended" if what == "ended" else "cut")
        self._tell(trace, what, **more)
        self._open = None

    def _tell(self, trace: Trace, what: str, **more: str) -> None:
        above = [name for level in self._others(below=False) if (name := level._open or level._name()) is not None]
        data = {"name": self._open, "what": what, "path": "/".join([*above, self._open or ""]), **more}
        trace.emit(self.sch.now_us, self._path, self._key, data)

    def _others(self, *, below: bool) -> list[Level]:
        """Returns the levels above or below this one, from the top."""
        place = LEVELS.index(self.name)
        names = LEVELS[place + 1 :] if below else LEVELS[:place]
        found = [self._agent().__dict__.get(name) for name in names]
        return [level for level in found if isinstance(level, Level)]


class PlanUnitLevel(Level):
    """Holds the present planning unit, its place in its chain, and its state.

    `set("planning_unit:tea")` begins one; what is not said is filled in. States: «begin»; «retrieving» or «choosing» the
    next unit task; «running»; «finished»; «resuming» what it has interrupted; «lost», where `lost` says what memory did
    not find: «unit_task» or «place». The state «begin» then lets it ask for the unit task again, «finished» for the place.
    """

    _slots = frozenset({"planning_unit", "type", "cuelag", "cue", "unit_task", "state", "interrupted", "place", "lost", "saved"})
    _dropped = "cut"

    def _over(self, chunk: Chunk) -> bool:
        return chunk.get("state") in (END, "resuming") or chunk.get("lost") == "place"

    def set(self, chunk: object) -> None:
        """Begins a planning unit, or puts it in another state.

        Raises:
            PlanError: If there is no such planning unit or state, or nothing is saved that could be resumed.
        """
        made = self._made(chunk)
        if "planning_unit" not in made:
            raise PlanError(f"b_plan_unit: '{made}' names no planning unit; write 'planning_unit:…'")
        name = as_text(made["planning_unit"])
        made.setdefault("type", self._agent()._unit(name, "b_plan_unit").kind)
        for slot, value in (("cuelag", BEFORE), ("cue", BEFORE), ("unit_task", START), ("state", "begin")):
            made.setdefault(slot, value)
        for slot in ("interrupted", "place", "lost"):
            made.setdefault(slot, "none")
        self._check(made)
        super().set(made)

    def modify(self, **args: Any) -> None:
        """Changes slots of the present planning unit.

        Raises:
            PlanError: As for `set`.
        """
        if self.chunk:
            if "planning_unit" in args:
                self._agent()._unit(as_text(args["planning_unit"]), "b_plan_unit")
            self._check({**self.chunk, **args})
            if args.get("state", "lost") != "lost" and self.chunk["lost"] != "none":
                args["lost"] = "none"
        super().modify(**args)

    def _check(self, slots: Any) -> None:
        name, state = as_text(slots["planning_unit"]), as_text(slots["state"])
        kind = self._agent()._unit(name, "b_plan_unit").kind
        if slots["type"] != kind:
            given = as_text(slots["type"])
            raise PlanError(f"b_plan_unit: '{name}' is of type '{kind}', not '{given}'; begin it with 'planning_unit:{name}'")
        if state not in STATES:
            raise PlanError(f"b_plan_unit: no state '{state}'{did_you_mean(state, STATES)}; there are: {', '.join(STATES)}")
        if state == "resuming" and slots["place"] == "none":
            raise PlanError(f"b_plan_unit: '{slots['planning_unit']}' has interrupted nothing, so no place is saved to resume at")


class UnitTaskLevel(Level):
    """Holds the present unit task: `unit_task planning_unit type state resumed`.

    It begins in the state «start»; its productions give it the state «finished», and others in between as they like.
    """

    _slots = frozenset({"unit_task", "planning_unit", "type", "state", "resumed"})
    _dropped = "cut"

    def set(self, chunk: object) -> None:
        """Begins a unit task, or puts it in another state.

        Raises:
            PlanError: If no planning unit has such a unit task.
        """
        made = self._made(chunk)
        if "unit_task" not in made:
            raise PlanError(f"b_unit_task: '{made}' names no unit task; write 'unit_task:…'")
        agent = self._agent()
        agent._check_unit_task(as_text(made["unit_task"]))
        plan: dict[Any, Any] = agent.b_plan_unit.chunk or {}
        made.setdefault("planning_unit", plan.get("planning_unit", "none"))
        made.setdefault("type", plan.get("type", "none"))
        made.setdefault("state", START)
        made.setdefault("resumed", "no")
        self._check_state(made["state"])
        super().set(made)

    def modify(self, **args: Any) -> None:
        """Changes slots of the present unit task.

        Raises:
            PlanError: If no planning unit has such a unit task, or its state is a slip of «finished».
        """
        if "unit_task" in args:
            self._agent()._check_unit_task(as_text(args["unit_task"]))
        self._check_state(args.get("state", START))
        super().modify(**args)

    def clear(self) -> None:
        """Empties the buffer.

        Raises:
            PlanError: If the planning unit is waiting for the end of the unit task, which would never come.
        """
        plan: dict[Any, Any] = self._agent().b_plan_unit.chunk or {}
        if self.chunk and plan.get("state") == "running":
            raise PlanError(
                f"b_unit_task: '{self.chunk['unit_task']}' is cleared, and nothing would come after it; "
                f"it ends with b_unit_task.modify(state='{END}')"
            )
        super().clear()

    def _check_state(self, state: object) -> None:
        if is_slip(as_text(state), END):
            raise PlanError(f"b_unit_task: state '{as_text(state)}' does not end the unit task; did you mean '{END}'?")


class Interruption(Buffer):
    """Holds what asks for an interruption: `planning_unit:… when:now`, or `when:end`, at the end of the unit task."""

    _slots = frozenset({"planning_unit", "when"})

    def set(self, chunk: object) -> None:
        """Asks for the interruption of the present planning unit by another one, the response.

        Raises:
            PlanError: If there is no such planning unit, it is not said when, or the agent does not live yet.
        """
        _agent_of(self)
        made = Chunk(chunk, self.sch.bound)
        self._check(made)
        super().set(made)

    def modify(self, **args: Any) -> None:
        """Asks for another interruption, or for it at another time.

        Raises:
            PlanError: As for `set`.
        """
        if self.chunk:
            self._check(Chunk({**self.chunk, **args}))
        super().modify(**args)

    def _check(self, made: Chunk) -> None:
        if "planning_unit" not in made:
            raise PlanError(f"b_interrupt: '{made}' names no planning unit; write 'planning_unit:… when:now'")
        _agent_of(self)._unit(as_text(made["planning_unit"]), "b_interrupt")
        when = made.get("when")
        if when not in ("now", "end"):
            hint = "" if when is None else did_you_mean(as_text(when), ("now", "end"), 0.5)
            raise PlanError(
                f"b_interrupt: '{made}' does not say when{hint}; 'when:now' cuts the unit task short, 'when:end' lets it end first"
            )
