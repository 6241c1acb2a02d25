"""Says why: which productions match and what keeps the others from it, and who won a retrieval and why.

An explanation of the present reads the model; one of a past time reads the trace, and needs nothing else.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, TypeVar

from actr3d.actr.known import State
from actr3d.actr.memory import Memory
from actr3d.actr.model import Model
from actr3d.actr.past import Past
from actr3d.actr.present import Present
from actr3d.actr.retrievals import RetrievalReason
from actr3d.actr.searches import Searching, SearchReason
from actr3d.actr.trial import ConditionReason, Trial
from actr3d.clock import microseconds, seconds
from actr3d.errors import ParameterError, SchedulerError, did_you_mean
from actr3d.trace import TraceEvent

if TYPE_CHECKING:
    from actr3d.actr.procedural import ProductionSystem
    from actr3d.actr.production import Production


Kind = TypeVar("Kind", bound=Model)


@dataclass(frozen=True, kw_only=True)
class ProductionReason:
    """Why one production matches or does not, and why it was chosen or not."""

    name: str
    system: str
    """The production system it belongs to, as a dotted path."""
    parents: tuple[str, ...] = ()
    """The two productions that a compiled one was made of."""
    matches: bool | None
    """None where it cannot be told: see `condition` and `found`."""
    condition: str | None = None
    """The first condition that fails; None where all hold."""
    expected: str | None = None
    found: str | None = None
    seen: str | None = field(default=None, compare=False)
    """How what was found is known, such as «as seen since 0.050 s»; None where it is certain at that time."""
    bindings: Mapping[str, str]
    """What the conditions before the failing one bound."""
    conditions: tuple[ConditionReason, ...] = field(default=(), compare=False)
    """How each condition stands, in the order in which they are tried; also those after the failing one, as far as can be told."""
    utility: float | None
    """The sum of the parts that are known; None where a part cannot be told."""
    parts: Mapping[str, float | None]
    """The production's own utility as «base», and what each utility module adds, by its name; None where it is not known:
    noise is drawn only when there is a choice to make. Where the agent has its own `get_activation`, only what that said."""
    selected: bool
    """Whether it has been chosen and is about to fire, if it still matches then."""
    verdict: str | None
    """Why it was chosen or lost at the latest choice, with the utilities of that moment; None where no choice stands."""

    def __str__(self) -> str:
        bound = "".join(f"  ?{name}={value}" for name, value in self.bindings.items())
        seen = "" if self.seen is None else f" ({self.seen})"
        origin = f"  (compiled from {' and '.join(self.parents)})" if self.parents else ""
        if self.matches:
            lines = [f"  + {self.name}: matches{bound}{seen}{origin}"]
        else:
            sign = "?" if self.matches is None else "-"
            lines = [f"  {sign} {self.name}: {self.condition}{origin}", f"      expected {self.expected}, found {self.found}{seen}{bound}"]
        if self.selected:
            lines[0] += f"  <- {self.verdict or 'selected'}{'' if self.matches else ', but it matches no longer'}"
        elif self.matches and self.verdict is not None:
            lines.append(f"      {self.verdict}")
        utility = "unknown" if self.utility is None else f"{self.utility:.4g}"
        if list(self.parts) == ["base"]:
            return "\n".join([*lines, f"      utility {utility}"])
        parts = "  ".join(f"{name} {'not drawn' if value is None else format(value, '.4g')}" for name, value in self.parts.items())
        return "\n".join([*lines, f"      utility {utility}  ({parts})"])


@dataclass(frozen=True, kw_only=True)
class Explanation:
    """Why an agent does what it does at one time."""

    time: float
    """[s]"""
    agent: str
    begun: bool
    """Whether the agent had begun to run; before that, its methods without parameters have not set anything up."""
    productions: tuple[ProductionReason, ...]
    retrievals: tuple[RetrievalReason, ...]
    searches: tuple[SearchReason, ...] = ()
    """Of vision: the last top-down and the last bottom-up search of each module."""

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
        lines = [f"{self.agent} at {self.time:.3f} s{'' if self.begun else ', before its first run'}"]
        system = self.agent
        for reason in self.productions:
            if reason.system != system:
                system = reason.system
                lines.append(f"  in {system}:")
            lines.append(str(reason))
        return "\n".join([*lines, *map(str, self.retrievals), *map(str, self.searches)])


def why(production: Production, state: State) -> ProductionReason:
    """Returns the reason of one production in a state."""
    system = production.system
    trial = Trial(production, state)
    failed = trial.failure
    choice = state.choice(system)
    none_drawn: dict[str, float] = {}
    drawn = none_drawn if choice is None else choice.parts.get(production.name, none_drawn)
    parts: dict[str, float | None] = {name: drawn.get(name) if value is None else value for name, value in state.parts(production).items()}
    if "get_activation" not in parts:
        parts = {"base": production.base_utility, **parts}
    known = [value for value in parts.values() if value is not None]
    return ProductionReason(
        name=production.name,
        system=state.path(system),
        parents=production.parents,
        matches=trial.matches,
        condition=failed.condition if failed is not None else None,
        expected=failed.expected if failed is not None else None,
        found=failed.found if failed is not None else None,
        seen=trial.seen,
        bindings=trial.bindings,
        conditions=trial.conditions,
        utility=sum(known) if len(known) == len(parts) else None,
        parts=parts,
        selected=choice is not None and choice.chosen == production.name,
        verdict=None if choice is None else choice.verdict(production.name),
    )


def explain(agent: ProductionSystem, at: float | None = None) -> Explanation:
    """Explains an agent, the parallel systems inside it, and the memories it has or sees; see `ProductionSystem.explain`."""
    agent._ensure_converted()
    systems = list(_systems(agent))
    for system in systems:
        if system._matcher is None:
            system._calc_context()
    memories, eyes = _seen(Memory, agent, systems), _seen(Searching, agent, systems)
    state = Present(agent) if at is None else _past(agent, at, systems, [*memories, *eyes])
    productions = [why(p, state) for system in systems if state.exists(system) for p in system._productions if state.learned(p)]
    retrievals = [state.retrieval(memory) for memory in memories if state.exists(memory)]
    searches = [reason for eye in eyes if state.exists(eye) for reason in state.searches(eye)]
    return Explanation(
        time=state.time,
        agent=state.path(agent),
        begun=agent._matcher is not None,
        productions=tuple(productions),
        retrievals=tuple(reason for reason in retrievals if reason is not None),
        searches=tuple(searches),
    )


def _past(agent: ProductionSystem, at: float, systems: list[ProductionSystem], modules: list[Model]) -> Past:
    """Returns the state at a past time.

    Raises:
        ParameterError: If it cannot be told, or the agent was not there.
    """
    try:
        time = microseconds(at, "explain(at)")
    except SchedulerError as error:
        raise ParameterError(str(error)) from None
    trace = agent.sch.trace
    if trace is None or not trace.all or not trace.keep:
        raise ParameterError("explain(at): only a run traced from before that time can tell its past; call traced() before the run")
    if time > agent.sch.now_us:
        raise ParameterError(f"explain(at): {at:g} s lies ahead; it is {agent.now():g} s now")
    *_, top = agent._line()
    run = TraceEvent(0, top._path, "", {}).run
    begin = next((event.time for event in trace if event.run == run), agent.now())
    if time < microseconds(begin):
        raise ParameterError(f"explain(at): the trace begins at {begin:g} s; what was before the trace is not known (got {at:g} s)")
    seen = [target for system in systems for target in system._context.values() if isinstance(target, Model)]
    state = Past(trace, time, list({id(part): part for part in (agent, *systems, *modules, *seen)}.values()))
    if not state.exists(agent):
        came = next(place.time for place in agent._places_in(trace) if place.path is not None)
        raise ParameterError(f"explain(at): '{agent._path}' was not there at {at:g} s; it came at {seconds(came):g} s")
    return state


def _systems(agent: ProductionSystem) -> Iterator[ProductionSystem]:
    from actr3d.actr.procedural import ProductionSystem

    for part in agent._tree():
        if isinstance(part, ProductionSystem):
            yield part


def _seen(kind: type[Kind], agent: Model, systems: list[ProductionSystem]) -> list[Kind]:
    """Returns an agent's modules of a kind, and those of its ancestors that its productions see by name."""
    found = [part for part in agent._tree() if isinstance(part, kind)]
    for system in systems:
        for target in system._context.values():
            if isinstance(target, kind) and not any(target is known for known in found):
                found.append(target)
    return found
