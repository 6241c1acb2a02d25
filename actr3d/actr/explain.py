"""Says why: which productions match and what keeps the others from it, and who won a retrieval and why.

An explanation of the present reads the model; one of a past time reads the trace, and needs nothing else.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

from actr3d.actr.buffer import Buffer
from actr3d.actr.chunk import Slot, as_text
from actr3d.actr.memory import Memory
from actr3d.actr.model import Model
from actr3d.actr.pattern import MISSING, Bindings, Condition, Missing, holds_empty
from actr3d.actr.plain import UNKNOWN, plain_value
from actr3d.actr.retrievals import RetrievalReason, live_retrieval, past_retrieval
from actr3d.clock import microseconds
from actr3d.errors import ParameterError, did_you_mean
from actr3d.trace import TraceEvent

if TYPE_CHECKING:
    from actr3d.actr.procedural import ProductionSystem
    from actr3d.actr.production import Production


@dataclass(frozen=True, kw_only=True)
class ProductionReason:
    """Why one production matches or does not."""

    name: str
    system: str
    """The production system it belongs to, as a dotted path."""
    matches: bool
    condition: str | None = None
    """The first condition that fails; None where all hold."""
    expected: str | None = None
    found: str | None = None
    bindings: Mapping[str, str]
    """What the conditions before the failing one bound."""
    utility: float | None
    """The sum of the parts that are known; None where a part cannot be told."""
    parts: Mapping[str, float | None]
    """The production's own utility as «base», and what each utility module adds, by its name; None where it is not known:
    noise is drawn only when there is a choice to make."""
    selected: bool
    """Whether it has been chosen and is about to fire."""

    def __str__(self) -> str:
        parts = "  ".join(f"{name} {'not drawn' if value is None else format(value, '.4g')}" for name, value in self.parts.items())
        bound = "".join(f"  ?{name}={value}" for name, value in self.bindings.items())
        if self.matches:
            chosen = "  <- selected" if self.selected else ""
            return f"  + {self.name}: matches{bound}{chosen}\n      utility {_number(self.utility)}  ({parts})"
        return f"  - {self.name}: {self.condition}\n      expected {self.expected}, found {self.found}{bound}\n      ({parts})"


@dataclass(frozen=True, kw_only=True)
class Explanation:
    """Why an agent does what it does at one time."""

    time: float
    """[s]"""
    agent: str
    productions: tuple[ProductionReason, ...]
    retrievals: tuple[RetrievalReason, ...]

    def production(self, name: str) -> ProductionReason:
        """Returns the reason of one production.

        Raises:
            KeyError: If there is none of that name.
        """
        for reason in self.productions:
            if reason.name == name:
                return reason
        raise KeyError(f"no production '{name}'{did_you_mean(name, [reason.name for reason in self.productions])}")

    def __str__(self) -> str:
        lines = [f"{self.agent} at {self.time:.3f} s", *map(str, self.productions), *map(str, self.retrievals)]
        return "\n".join(lines)


def _number(value: float | None) -> str:
    return "unknown" if value is None else f"{value:.4g}"


class State(Protocol):
    """What is asked of the present, or of a past, to tell why."""

    time: float

    def slot(self, system: ProductionSystem, name: str, key: Slot) -> str | Missing:
        """Returns a slot's value as text."""
        ...

    def empty(self, system: ProductionSystem, name: str) -> bool:
        """Tells whether a buffer or object holds nothing."""
        ...

    def slots(self, system: ProductionSystem, name: str) -> list[str]:
        """Returns the slots there are, for the sake of a better message."""
        ...

    def call(self, production: Production, condition: Condition, bindings: Bindings) -> bool:
        """Tells what a modeller's function says, or said."""
        ...

    def parts(self, production: Production) -> dict[str, float | None]:
        """Returns the parts of a production's utility."""
        ...

    def selected(self, system: ProductionSystem) -> str | None:
        """Returns the production that has been chosen and has not fired yet."""
        ...

    def exists(self, production: Production) -> bool:
        """Tells whether a compiled production had been learned."""
        ...


class Present:
    """The model as it is now. Asking changes nothing: random numbers that were drawn on the way are put back."""

    def __init__(self, agent: ProductionSystem) -> None:
        self.time = agent.now()

    def slot(self, system: ProductionSystem, name: str, key: Slot) -> str | Missing:
        target = system._context[name]
        value = plain_value(target, key)
        if value is not UNKNOWN:
            return MISSING if value is MISSING else as_text(value)
        looked = system._matcher.looked.get(f"{name}.{key}") if system._matcher is not None else None
        return MISSING if looked is None else looked

    def empty(self, system: ProductionSystem, name: str) -> bool:
        return holds_empty(system._context[name], name)

    def slots(self, system: ProductionSystem, name: str) -> list[str]:
        target = system._context[name]
        if isinstance(target, Buffer):
            return [str(key) for key in target.chunk or ()]
        return [key for key in getattr(target, "__dict__", ()) if key[0] != "_"]

    def call(self, production: Production, condition: Condition, bindings: Bindings) -> bool:
        # Asking a modeller's function might change something. Where all else holds, its answer decided whether the
        # production was among those that matched.
        matcher = production.system._matcher
        return matcher is not None and production in matcher.last

    def parts(self, production: Production) -> dict[str, float | None]:
        return production.system._utility_parts(production)

    def selected(self, system: ProductionSystem) -> str | None:
        return system._chosen.name if system._chosen is not None else None

    def exists(self, production: Production) -> bool:
        return True


def why(production: Production, state: State) -> ProductionReason:
    """Returns the reason of one production in a state."""
    bindings: Bindings = {}
    failing: tuple[str, str, str] | None = None
    for condition in production.conditions:
        failing = _fails(production, condition, state, bindings)
        if failing is not None:
            break
    parts: dict[str, float | None] = {"base": production.base_utility, **state.parts(production)}
    known = [value for value in parts.values() if value is not None]
    text, expected, found = failing or (None, None, None)
    return ProductionReason(
        name=production.name,
        system=production.system._path,
        matches=failing is None,
        condition=text,
        expected=expected,
        found=found,
        bindings=dict(bindings),
        utility=sum(known) if len(known) == len(parts) else None,
        parts=parts,
        selected=failing is None and state.selected(production.system) == production.name,
    )


def _fails(production: Production, condition: Condition, state: State, bindings: Bindings) -> tuple[str, str, str] | None:
    """Tests a condition; returns None where it holds, else the condition, what it expects, and what is found."""
    op, name, key, value = condition
    system, name = production.system, name or "self"
    text = f"{name}: {condition}"
    if op == "empty":
        return None if state.empty(system, name) else (f"{name}: None", "nothing in it", "something")
    if op == "call":
        agrees = state.call(production, condition, bindings)
        return None if agrees else (text, "anything but False", "False, or an error for want of a slot")
    if isinstance(key, str) and key[:1] == "?":
        key = bindings.get(key[1:], key)
        key = int(key) if isinstance(key, str) and key.isdecimal() else key
    found = state.slot(system, name, key)
    if found is UNKNOWN:
        # Only the object's own code can tell its text, and did so when the productions were matched.
        agrees = state.call(production, condition, bindings)
        return None if agrees else (text, f"'{value}'", "an object whose text only its own code can tell")
    if op == "bind" and not isinstance(found, Missing):
        bindings[value] = found
        return None
    wanted = bindings.get(value) if op in ("same", "differs") else value
    named = f" (?{value})" if op in ("same", "differs") else ""
    if isinstance(found, Missing):
        known = state.slots(system, name)
        expected = f"some value for ?{value}" if op == "bind" else f"{'not ' if op in ('not', 'differs') else ''}'{wanted}'{named}"
        nothing = f"no slot '{key}'{did_you_mean(str(key), known)}" if known else f"{name} is empty"
        return text, expected, nothing
    if op in ("is", "same"):
        return None if found == wanted else (text, f"'{wanted}'{named}", f"'{found}'")
    return None if found != wanted else (text, f"anything but '{wanted}'{named}", f"'{found}'")


def _systems(agent: ProductionSystem) -> Iterator[ProductionSystem]:
    from actr3d.actr.procedural import ProductionSystem

    for part in agent._tree():
        if isinstance(part, ProductionSystem):
            yield part


def explain(agent: ProductionSystem, at: float | None = None) -> Explanation:
    """Explains an agent, the parallel systems inside it, and its memories; see `ProductionSystem.explain`.

    Args:
        agent: The agent.
        at: A past time of a traced run [s]; None for now.

    Raises:
        ParameterError: If the run was not traced (level «all») at that time, or it lies in the future.
    """
    agent._ensure_converted()
    if at is None:
        numbers = agent.random.getstate()
        try:
            return _explanation(agent, Present(agent), [live_retrieval(memory) for memory in _memories(agent)])
        finally:
            agent.random.setstate(numbers)
    from actr3d.actr.past import Past

    time = microseconds(at, "explain(at)")
    trace = agent.sch.trace
    if trace is None or not trace.all or not trace.keep:
        raise ParameterError("explain(at): only a run traced from before that time can tell its past; call traced() before the run")
    if time > agent.sch.now_us:
        raise ParameterError(f"explain(at): {at:g} s lies ahead; it is {agent.now():g} s now")
    *_, top = agent._line()
    run = TraceEvent(0, top._path, "", {}).run
    events = [event for event in trace if event.run == run]
    if not events or time < events[0].time_us:
        begin = events[0].time if events else agent.now()
        raise ParameterError(f"explain(at): the trace begins at {begin:g} s; what was before the trace is not known (got {at:g} s)")
    state = Past(events, time)
    return _explanation(agent, state, [past_retrieval(memory._path, events, time) for memory in _memories(agent)])


def _memories(agent: Model) -> list[Memory]:
    return [part for part in agent._tree() if isinstance(part, Memory)]


def _explanation(agent: ProductionSystem, state: State, retrievals: list[RetrievalReason | None]) -> Explanation:
    productions = [
        why(production, state)
        for system in _systems(agent)
        for production in system._productions
        if system._matcher is not None and state.exists(production)
    ]
    return Explanation(
        time=state.time,
        agent=agent._path,
        productions=tuple(productions),
        retrievals=tuple(reason for reason in retrievals if reason is not None),
    )
