"""The buffers of SGOMS: one for each level. They trace the beginning and the end of their contents."""

from __future__ import annotations

from typing import Any

from actr3d.actr import Buffer, Chunk
from actr3d.actr.chunks.chunk import Slot, as_text
from actr3d.actr.kernel.hooks import hook
from actr3d.actr.lint.slot_names import is_misspelt
from actr3d.errors import PlanError, alternatives, did_you_mean, followed
from actr3d.sgoms.checks import matches_state
from actr3d.sgoms.units import BEFORE, END, START, plans_of
from actr3d.trace import Trace

LEVELS = ("b_plan_unit", "b_unit_task", "b_method", "b_operator")
"""The buffers of the four levels, from the top."""
STATES = ("begin", "retrieving", "choosing", "running", "finished", "resuming", "lost")
"""The states of a planning unit."""
STEM = "finish"
"""A unit-task state that starts with this («finishing»), or that is a prefix of it («fin»), is treated as a misspelt «finished»."""
SHORTEST = 3
"""The minimum length of such a prefix [letters]."""


def _agent_of(buffer: Buffer) -> Any:
    """Returns the agent of a buffer.

    Raises:
        PlanError: If its agent has not started: until then the buffer is that of the class.
    """
    agent = vars(buffer).get("parent")
    if agent is None:
        raise PlanError("a buffer of SGOMS is set before its agent has started; do it in the agent's init(), or after its run(0)")
    return agent


class Level(Buffer):
    """Holds the present activity on one level: a chunk with a slot named after the level, and `state`.

    The activity begins when its chunk is set, and ends when its state is «finished», or the chunk is cleared or replaced. Both are
    traced.

    Args:
        key: The level: the slot of the name, and the kind of trace events.
    """

    _slots = frozenset({"method", "operator", "state"})
    _dropped = "ended"
    """The traced end of an activity that is cleared or replaced before its state is «finished»."""

    def __init__(self, key: str) -> None:
        super().__init__()
        self._key = key
        self._open: str | None = None
        """The traced activity that has not ended."""
        self._seen: Chunk | None = None
        """The traced chunk."""
        self._beginning = "begun"

    def set(self, chunk: object) -> None:
        """Sets the chunk.

        Raises:
            PlanError: If its agent has not started.
        """
        _agent_of(self)
        super().set(chunk)

    def _made(self, chunk: object) -> Chunk:
        """Returns the chunk for `set`."""
        _agent_of(self)
        return Chunk(chunk, self.sch.bound)

    @hook
    def put_back(self, slots: dict[Slot, Any], beginning: str) -> None:
        """Sets a chunk, with another word for its beginning in the trace, such as «resumed»."""
        self._beginning = beginning
        try:
            self.set(slots)
        finally:
            self._beginning = "begun"

    # -- the trace

    def _over(self, chunk: Chunk) -> bool:
        """Returns whether the activity has ended."""
        return chunk.get("state") == END

    @hook
    def current_name(self) -> str | None:
        """Returns the name of the activity that has not ended."""
        chunk = self.chunk
        return None if not chunk or self._key not in chunk or self._over(chunk) else as_text(chunk[self._key])

    def _trace_change(self, trace: Trace, key: str, value: Any) -> None:
        super()._trace_change(trace, key, value)
        if key == "chunk" and trace.production:
            name, chunk = self.current_name(), self.chunk
            new = chunk is not None and chunk is not self._seen and chunk.get("state", START) in (START, "begin")
            self._seen = chunk
            if self._open is not None and (name != self._open or new):
                self.trace_end(trace, "ended" if chunk is not None and self._over(chunk) else self._dropped)
            if name is not None and self._open is None:
                self._open = name
                self._trace_activity(trace, self._beginning)

    def _trace_state(self, trace: Trace) -> None:
        super()._trace_state(trace)
        self._open, self._seen = self.current_name(), self.chunk
        if self._open is not None and trace.production:
            self._trace_activity(trace, "going on")

    @hook
    def trace_end(self, trace: Trace, what: str, **more: str) -> None:
        """Traces the end of the activity, after the ends of all on lower levels."""
        if self._open is None:
            return
        for below in reversed(self._others(below=True)):
            below.trace_end(trace, "ended" if what == "ended" else "cut")
        self._trace_activity(trace, what, **more)
        self._open = None

    @hook
    def traced_name(self) -> str | None:
        """Returns the name of the traced activity, or of the present one."""
        return self._open or self.current_name()

    def _trace_activity(self, trace: Trace, what: str, **more: str) -> None:
        above = [name for level in self._others(below=False) if (name := level.traced_name()) is not None]
        data = {"name": self._open, "what": what, "path": "/".join([*above, self._open or ""]), **more}
        trace.emit(self.sch.now_us, self._path, self._key, data)

    def _others(self, *, below: bool) -> list[Level]:
        """Returns the levels above or below this one, from the top."""
        place = LEVELS.index(self.name)
        names = LEVELS[place + 1 :] if below else LEVELS[:place]
        found = [_agent_of(self).__dict__.get(name) for name in names]  # of this agent, not of its class
        return [level for level in found if isinstance(level, Level)]


class PlanUnitLevel(Level):
    """Holds the present planning unit, its place in its chain, and its state.

    `set("planning_unit:tea")` begins one; other slots have defaults. States: «begin»; «retrieving» or «choosing» the
    next unit task; «running»; «finished»; «resuming» the unit that it interrupted; «lost»: the slot `lost` contains what memory
    did not find, «unit_task» or «place». To repeat the request, set the state to «begin» for a lost unit task, to «finished» for a lost
    place.
    """

    _slots = frozenset({"planning_unit", "type", "cuelag", "cue", "unit_task", "state", "interrupted", "place", "lost", "saved"})
    _dropped = "cut"

    def _over(self, chunk: Chunk) -> bool:
        return chunk.get("state") in (END, "resuming") or chunk.get("lost") == "place"

    def set(self, chunk: object) -> None:
        """Begins a planning unit, or sets its state.

        Raises:
            PlanError: If there is no such planning unit or state, or there is no saved place to resume.
        """
        made = self._made(chunk)
        if "planning_unit" not in made:
            raise PlanError(f"b_plan_unit: '{made}' has no slot planning_unit; write 'planning_unit:…'")
        name = as_text(made["planning_unit"])
        made.setdefault("type", plans_of(_agent_of(self)).unit(name, "b_plan_unit").kind)
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
                plans_of(_agent_of(self)).unit(as_text(args["planning_unit"]), "b_plan_unit")
            self._check({**self.chunk, **args})
            if args.get("state", "lost") != "lost" and self.chunk["lost"] != "none":
                args["lost"] = "none"
        super().modify(**args)

    def _check(self, slots: Any) -> None:
        name, state = as_text(slots["planning_unit"]), as_text(slots["state"])
        kind = plans_of(_agent_of(self)).unit(name, "b_plan_unit").kind
        if slots["type"] != kind:
            given = as_text(slots["type"])
            raise PlanError(f"b_plan_unit: '{name}' is of type '{kind}', not '{given}'; begin it with 'planning_unit:{name}'")
        if state not in STATES:
            raise PlanError(f"b_plan_unit: no state '{state}'{alternatives(state, STATES)}")
        if state == "resuming" and slots["place"] == "none":
            raise PlanError(
                f"b_plan_unit: '{slots['planning_unit']}' did not interrupt a planning unit, so there is no saved place to resume at"
            )


class UnitTaskLevel(Level):
    """Holds the present unit task: `unit_task planning_unit type state resumed`.

    It begins in the state «start»; its productions set the state «finished» at its end, and may set any other state before.
    """

    _slots = frozenset({"unit_task", "planning_unit", "type", "state", "resumed"})
    _dropped = "cut"

    def set(self, chunk: object) -> None:
        """Begins a unit task, or sets its state.

        Raises:
            PlanError: As for `modify`.
        """
        made = self._made(chunk)
        if "unit_task" not in made:
            raise PlanError(f"b_unit_task: '{made}' has no slot unit_task; write 'unit_task:…'")
        agent = _agent_of(self)
        plans_of(agent).check_unit_task(as_text(made["unit_task"]))
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
            PlanError: If no planning unit has such a unit task, or its state is a misspelt «finished» or another form of that
                word, and no production matches it by its name.
        """
        if "unit_task" in args:
            plans_of(_agent_of(self)).check_unit_task(as_text(args["unit_task"]))
        self._check_state(args.get("state", START))
        super().modify(**args)

    def clear(self) -> None:
        """Empties the buffer.

        Raises:
            PlanError: If the planning unit waits for the end of the unit task.
        """
        plan: dict[Any, Any] = _agent_of(self).b_plan_unit.chunk or {}
        if self.chunk and plan.get("state") == "running":
            raise PlanError(
                f"b_unit_task: '{self.chunk['unit_task']}' is cleared, and nothing would follow it; "
                f"end it with b_unit_task.modify(state='{END}')"
            )
        super().clear()

    def _check_state(self, state: object) -> None:
        name = as_text(state)
        word = name.casefold()
        form = name != END and (word.startswith(STEM) or (len(word) >= SHORTEST and STEM.startswith(word)))
        if (form or is_misspelt(name, END)) and not matches_state(_agent_of(self), name):
            raise PlanError(
                f"b_unit_task: state '{name}' does not end the unit task; did you mean '{END}'? No production matches the state '{name}'"
            )


class Interruption(Buffer):
    """Holds a request for an interruption: `planning_unit:… when:now`, or `when:end`, at the end of the unit task."""

    _slots = frozenset({"planning_unit", "when"})

    def set(self, chunk: object) -> None:
        """Requests that another planning unit, the response, interrupts the present one.

        Raises:
            PlanError: If there is no such planning unit, `when` is missing, or the agent has not started.
        """
        _agent_of(self)
        made = Chunk(chunk, self.sch.bound)
        self._check(made)
        super().set(made)

    def modify(self, **args: Any) -> None:
        """Changes the requested response or its time.

        Raises:
            PlanError: As for `set`.
        """
        if self.chunk:
            self._check(Chunk({**self.chunk, **args}))
        super().modify(**args)

    def _check(self, made: Chunk) -> None:
        if "planning_unit" not in made:
            raise PlanError(f"b_interrupt: '{made}' has no slot planning_unit; write 'planning_unit:… when:now'")
        plans_of(_agent_of(self)).unit(as_text(made["planning_unit"]), "b_interrupt")
        when = made.get("when")
        if when not in ("now", "end"):
            hint = "" if when is None else did_you_mean(as_text(when), ("now", "end"), 0.5)
            says = followed(hint, "'when:now' interrupts the unit task, 'when:end' waits for its end")
            raise PlanError(f"b_interrupt: '{made}' has no valid 'when'{says}")
