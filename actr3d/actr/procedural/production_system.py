"""The plain production system: matches, chooses at random, waits and fires."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass, field
from typing import Any, cast

from actr3d.actr.kernel.class_members import Method
from actr3d.actr.kernel.log import dummy
from actr3d.actr.kernel.model import MethodWrapper, Model
from actr3d.actr.kernel.noise import pick
from actr3d.actr.kernel.parameters import NotNegative, WithParameters, check_attribute
from actr3d.actr.kernel.profile import find_profile
from actr3d.actr.kernel.source_code import location
from actr3d.actr.kernel.tracing import traceable
from actr3d.actr.kernel.tree import lineage, path_of
from actr3d.actr.procedural.conflict_set import ConflictSet
from actr3d.actr.procedural.matcher import Matcher
from actr3d.actr.procedural.production import Production, defaults_of
from actr3d.actr.procedural.utility import trace_part, utility_modules
from actr3d.actr.reasons import Explanation
from actr3d.errors import ProductionException, did_you_mean
from actr3d.trace import Trace

FUNCTION_PARAMETERS = frozenset({"production_time", "production_threshold"})
"""Parameters that may be functions without arguments; these are not productions then."""

BEFORE_FIRST_CYCLE: list[Callable[[ProductionSystem], Callable[[], object] | None]] = []
"""Called with a system that is about to begin, before its methods without parameters; what they return is called after these.
`actr3d.actr` adds the checks of models here."""
EXPLAINERS: list[Callable[[ProductionSystem, float | None], Explanation]] = []
"""The function behind `ProductionSystem.explain`, given the system and the time; in a list so that `actr3d.actr` can set it."""


@dataclass(eq=False)
class ProceduralState:
    """The productions of a system, and the state of its cycle.

    They are kept apart from the system because productions see every public attribute of a model.
    """

    productions: list[Production] = field(default_factory=list[Production])
    initializers: list[Production] = field(default_factory=list[Production])
    """The methods without parameters, which run once at the start."""
    context: dict[str, Any] = field(default_factory=dict[str, Any])
    """What productions see by name: the attributes of the agent and of its ancestors."""
    matcher: Matcher | None = None
    """Finds the productions that match; None before the first cycle."""
    chosen: Production | None = None
    """The production that is about to fire."""
    by_utility: bool = False
    """Whether utilities decide among those that match, and so are part of the conflict set."""
    forbidden: set[str] = field(default_factory=set[str])
    """The productions that a user has forbidden: each is left out of the next choice for which it matches."""
    wanted: Production | None = None
    """The production that a user makes fire next."""
    by_hand: dict[str, Any] = field(default_factory=dict[str, Any])
    """How a user has changed the latest choice: the productions that were left out as `forbidden`, and the `wanted` one."""

    def add(self, production: Production) -> None:
        """Adds a production during the run."""
        production.context = self.context
        self.productions.append(production)
        if self.matcher is not None:
            self.matcher.build(self.productions)

    def without_forbidden(self, matching: list[Production]) -> list[Production]:
        """Returns the productions among which to choose; those that were forbidden are allowed again from now on."""
        if self.by_hand:
            self.by_hand = {}
        if not self.forbidden and self.wanted is None:
            return matching
        left_out = [production.name for production in matching if production.name in self.forbidden]
        if left_out:
            self.forbidden.difference_update(left_out)
            self.by_hand["forbidden"] = left_out
            matching[:] = [production for production in matching if production.name not in left_out]
        wanted, self.wanted = self.wanted, None
        if wanted in matching:
            self.by_hand["wanted"] = wanted.name
        return matching

    def wanted_of(self, matching: list[Production]) -> Production | None:
        """Returns the production that a user wants among those that match; None if there is none."""
        name = self.by_hand.get("wanted")
        return None if name is None else next(production for production in matching if production.name == name)


class ProductionSystem(WithParameters, Model):
    """A model whose methods with patterns are productions; it chooses at random among those that match.

    It can be an agent, or a parallel system inside an agent with its own cycle time; it sees the buffers and modules of its
    ancestors by name.
    """

    production_time: NotNegative | Callable[[], float] = 0.05
    """How long a production takes to fire [s]; a number, or a function without arguments."""
    production_match_delay: NotNegative = 0
    """The part of `production_time` that matching takes [s]."""
    _auto_run_start = False
    _by_utility = False

    _procedural: ProceduralState
    # Parts of that state under the names that python_actr has, for existing models.
    _productions: list[Production]
    _initializers: list[Production]
    _context: dict[str, Any]
    _top: Model

    def _convert_info(self, objects: dict[str, Any], methods: dict[str, Method]) -> None:
        own = self.__dict__
        wanted = own.get("profile") or objects.get("profile")
        if wanted is not None:
            objects["profile"] = wanted
            own["_profile"] = find_profile(wanted, f"{type(self).__name__}.profile")
            self.sch.round_ms = self.sch.round_ms or own["_profile"].whole_milliseconds
        state = own["_procedural"] = ProceduralState(by_utility=self._by_utility)
        own["_productions"], own["_initializers"] = state.productions, state.initializers
        for name in sorted(FUNCTION_PARAMETERS & methods.keys()):
            if defaults_of(methods[name]) is not None:  # a plain function: it computes the parameter
                objects[name] = methods.pop(name)
        for name in sorted(objects.keys() & self._settable()):
            check_attribute(type(self), name, objects[name])
        for name, func in methods.items():
            patterns = defaults_of(func)
            if patterns is not None:
                (state.productions if patterns else state.initializers).append(Production(self, name, func))
        own["_process"] = self.sch.add(self._process_productions)

    def _settable(self) -> set[str]:
        """Returns the parameters of an agent; all other attributes of agents belong to the modeller."""
        library = [vars(klass) for klass in type(self).__mro__ if klass.__module__.startswith("actr3d.")]
        return {name for names in library for name in names if name.startswith("production_")} | {"profile"}

    # -- the cycle

    def _process_productions(self) -> Iterator[Any]:
        """Matches, chooses at random, waits, fires."""
        self._begin()
        while True:
            if self.production_match_delay > 0:
                yield self.production_match_delay
            matching = self._match()
            if not matching:
                yield self._top.changes
                continue
            choice = self._procedural.wanted_of(matching) or pick(self.random, matching)
            self._select(choice)
            yield self._duration()
            if self._procedural.chosen is choice:  # otherwise a user has withdrawn it
                self._fire(choice)

    def _begin(self) -> None:
        """Determines what productions see by name, runs the methods without parameters, and builds the matcher."""
        _determine_context(self)
        state = self._procedural
        afterwards = [check(self) for check in BEFORE_FIRST_CYCLE]
        for production in state.initializers:
            production.bound = {}
            trace = self.sch.trace
            if trace is not None and trace.all:
                trace.emit(self.sch.now_us, self._path, "initialize", {"method": production.name})
            production.fire()
            if self.sch.bound:  # every production sees what an initializer assigns
                state.context.update(self.sch.bound)
        for production in state.productions:
            production.share_globals()
        for check in afterwards:
            if check is not None:
                check()
        matcher = state.matcher = Matcher(state.context)
        matcher.build(state.productions)

    def _match(self) -> list[Production]:
        """Returns the productions that match now; records in the trace what they read beyond buffers and modules."""
        matcher = self._procedural.matcher
        assert matcher is not None
        matching = self._procedural.without_forbidden(matcher.matching())
        trace = self.sch.trace
        if trace is not None and trace.all:
            if matcher.observed.used:
                self._observe(trace)
            if not matching or not self._by_utility:
                utilities = {production.name: production.base_utility for production in matching}
                trace.emit(self.sch.now_us, self._path, "conflict", {"utilities": utilities, **self._procedural.by_hand})
        return matching

    def _observe(self, trace: Trace) -> None:
        """Records in the run's trace what has changed of what productions see, beyond what the trace records by itself."""
        matcher = self._procedural.matcher
        seen = matcher.observed.news(trace) if matcher is not None else {}
        if seen:
            trace.emit(self.sch.now_us, self._path, "observe", seen)

    def _trace_state(self, trace: Trace) -> None:
        super()._trace_state(trace)
        if trace.all:
            state = self._procedural
            matcher, chosen = state.matcher, state.chosen
            data = {
                "productions": [production.name for production in state.productions],
                "initializers": [production.name for production in state.initializers],
                "chosen": None if chosen is None else chosen.name,
                "matched": [] if matcher is None else [production.name for production in matcher.last],
                "drawn": self._drawn_names(),
            }
            choice = current_choice(self)
            if choice is not None:
                data |= {"utilities": choice.utilities, "parts": choice.parts, "threshold": choice.threshold, **state.by_hand}
            trace.emit(self.sch.now_us, self._path, "productions", data)
            if trace is self.sch.trace:
                self._observe(trace)
            elif matcher is not None and (seen := matcher.observed.everything()):
                # A trace that only listens receives everything, and leaves the news to the run's own trace.
                trace.emit(self.sch.now_us, self._path, "observe", seen)

    def _drawn_names(self) -> list[str]:
        """Returns the names of the utility modules whose part is known only when a choice is made."""
        any_one = self._productions[0] if self._productions else None
        return [] if any_one is None else [name for name, value in self._utility_parts(any_one).items() if value is None]

    def _utility_parts(self, production: Production) -> dict[str, float | None]:
        """Returns what each utility module adds now; None for what is known only when a choice is made."""
        return {}

    def _latest_choice(self) -> ConflictSet | None:
        """Returns the conflict set of the latest match; None before the first."""
        state = self._procedural
        if state.matcher is None:
            return None
        utilities = {production.name: production.base_utility for production in state.matcher.last}
        chosen = state.chosen.name if state.chosen is not None else None
        return ConflictSet(utilities=utilities, parts={}, threshold=None, weighed=self._by_utility, chosen=chosen, **state.by_hand)

    def _select(self, choice: Production) -> None:
        """Records which production will fire."""
        self._procedural.chosen = choice
        trace = self.sch.trace
        if trace is not None and trace.production:
            trace.emit(self.sch.now_us, self._path, "select", {"production": choice.name})
        if self.log is not dummy:
            self.log.production = choice.name

    def _duration(self) -> float:
        time = self.production_time
        return (time() if callable(time) else time) - self.production_match_delay

    def _fire(self, choice: Production) -> None:
        self._procedural.chosen = None
        trace = self.sch.trace
        if trace is not None and trace.production:
            bound = traceable(choice.bound) if choice.more_bound else dict(choice.bound or {})
            trace.emit(self.sch.now_us, self._path, "fire", {"production": choice.name, "bound": bound})
        if self.log is not dummy:
            self.log.production = None
        choice.fire()

    def explain(self, at: float | None = None) -> Explanation:
        """Explains, for each production, whether it matches or what fails first, its utility, and why it was chosen or lost;
        for each memory, its last request. Runs no code of the model and draws no random number.

        Args:
            at: A past time of a traced run [s]; None for now.

        Raises:
            ParameterError: If `at` is not a time or is in the future, or the run was not traced (level «all») or had no such agent then.
        """
        return EXPLAINERS[-1](self, at)


# What the rest of the library asks of a production system. These are functions that call private methods, because productions see
# every public name of a model; the private methods are those that `ACTR` extends.


def procedural_state_of(system: ProductionSystem) -> ProceduralState:
    """Returns the productions of a system and the state of its cycle; empty before the system is converted."""
    return system.__dict__.get("_procedural") or ProceduralState()


def system_of(production: Production) -> ProductionSystem:
    """Returns the system that a production belongs to."""
    return cast("ProductionSystem", production.system)


def prepare_context(system: ProductionSystem) -> None:
    """Determines what the productions of a system see by name, if it has not begun to run."""
    if procedural_state_of(system).matcher is None:
        _determine_context(system)


def _determine_context(system: ProductionSystem) -> None:
    """Determines what the productions of a system see by name.

    Raises:
        ProductionException: If a production tests a name that neither the agent nor its ancestors have.
    """
    context: dict[str, Any] = {}
    top: Model = system
    state = procedural_state_of(system)
    for above in lineage(system):
        for name, value in above.__dict__.items():
            if name[0] != "_" and name != "parent" and name not in context and not isinstance(value, MethodWrapper):
                context[name] = value
        top = above
    context["self"] = system
    context["top"] = top
    system.__dict__["_top"] = top
    system.__dict__["_context"] = state.context = context
    for production in (*state.initializers, *state.productions):
        production.context = context
        for name in production.keys:
            if name not in context:
                raise ProductionException(
                    f"production '{production.name}' ({production.place}) matches on '{name}', which neither the agent "
                    f"nor its ancestors have{did_you_mean(name, [*context, 'utility'])}"
                ).at(*location(production.original_func))


def add_production(system: ProductionSystem, production: Production) -> None:
    """Adds a production during the run (compilation)."""
    procedural_state_of(system).add(production)
    trace = system.sch.trace
    if trace is not None and trace.all:
        trace_utility_parts(system, production, trace)


def trace_utility_parts(system: ProductionSystem, production: Production, trace: Trace) -> None:
    """Records what is known now of what each utility module adds to a production's utility."""
    for name, value in utility_parts(system, production).items():
        if value is not None:
            trace_part(trace, system, production, name, value)


def refresh_attribute(system: ProductionSystem, part: Model, name: str) -> None:
    """Updates the value of a part's attribute in the bodies of a system's productions, if they use it by its plain name."""
    state = procedural_state_of(system)
    if name in state.context and next(above for above in lineage(system) if name in above.__dict__) is part:
        state.context[name] = part.__dict__[name]
        for production in (*state.initializers, *state.productions):
            production.forget_body()


def choose_next(system: ProductionSystem, production: Production) -> None:
    """Makes a production the choice of the next match, if it matches then; withdraws the one that is about to fire."""
    procedural_state_of(system).wanted = production
    procedural_state_of(system).forbidden.discard(production.name)
    _withdraw(system)


def leave_out_once(system: ProductionSystem, production: Production) -> None:
    """Leaves a production out of the next choice for which it matches; if it is about to fire, that choice is made again now."""
    state = procedural_state_of(system)
    state.forbidden.add(production.name)
    if state.chosen is production:
        _withdraw(system)


def _withdraw(system: ProductionSystem) -> None:
    """Withdraws the production that is about to fire, if any, and matches again now."""
    state, sch = procedural_state_of(system), system.sch
    process, changes = system.__dict__["_process"], system.__dict__.get("_top", system).changes
    waits = any(event is process for event in changes.waiting)
    if state.chosen is None and not waits:
        return  # it is about to match anyway
    if state.chosen is not None:
        withdrawn, state.chosen = state.chosen, None
        for module in utility_modules(system):
            module.withdrawn(withdrawn)
        if sch.trace is not None and sch.trace.production:
            sch.trace.emit(sch.now_us, path_of(system), "withdrawn", {"production": withdrawn.name})
    changes.waiting = [event for event in changes.waiting if event is not process]
    sch.drop([process])
    sch.discard_remainders()
    sch.put_now(process)


def current_choice(system: ProductionSystem) -> ConflictSet | None:
    """Returns the latest conflict set until the chosen production fires; one in which none was chosen, until the next."""
    choice = system._latest_choice()  # pyright: ignore[reportPrivateUsage] # productions see every public name of a model
    return choice if choice is not None and choice.is_current else None


def utility_parts(system: ProductionSystem, production: Production) -> dict[str, float | None]:
    """Returns what each utility module adds to a production's utility now; None for what is known only when a choice is made."""
    return system._utility_parts(production)  # pyright: ignore[reportPrivateUsage] # productions see every public name of a model
