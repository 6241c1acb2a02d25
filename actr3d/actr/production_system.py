"""The plain production system: matches, chooses at random, waits and fires."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

from actr3d.actr.checks import check_names, check_rules
from actr3d.actr.choice import Choice
from actr3d.actr.logger import dummy
from actr3d.actr.matcher import Matcher
from actr3d.actr.model import Method, MethodWrapper, Model, pick
from actr3d.actr.parameters import WithParameters
from actr3d.actr.production import Production, defaults_of
from actr3d.actr.profile import find_profile
from actr3d.actr.scheduler import Event
from actr3d.actr.traced import traceable
from actr3d.errors import ProductionException, did_you_mean
from actr3d.trace import Trace

if TYPE_CHECKING:
    from actr3d.actr.explain import Explanation


FUNCTION_PARAMETERS = frozenset({"production_time", "production_threshold"})
"""Parameters that may be functions without arguments, which are no productions then."""


class ProductionSystem(WithParameters, Model):
    """A model whose methods with patterns are productions; it chooses at random among those that match.

    It may be an agent, or stand inside one as a parallel system with a cycle time of its own; it sees its ancestors'
    buffers and modules by name.
    """

    production_time: float | Callable[[], float] = 0.05
    """How long a production takes to fire [s]; a number, or a function without arguments."""
    production_match_delay: float = 0
    """How long matching takes, as a part of that [s]."""
    _auto_run_start = False
    _matcher: Matcher | None = None
    _weighs = False
    """Whether utilities decide among those that match, and so are part of the conflict set."""
    _chosen: Production | None = None
    """The production that is about to fire."""

    _process: Event
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
        own["_productions"] = []
        own["_initializers"] = []
        for name in sorted(FUNCTION_PARAMETERS & methods.keys()):
            if defaults_of(methods[name]) is not None:  # a plain function: it computes the parameter
                objects[name] = methods.pop(name)
        for name, func in methods.items():
            patterns = defaults_of(func)
            if patterns is not None:
                own["_productions" if patterns else "_initializers"].append(Production(self, name, func))
        own["_process"] = self.sch.add(self._process_productions)

    def _settable(self) -> set[str]:
        """Returns the parameters of an agent; all other attributes of agents are the modeller's own."""
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
            choice = pick(self.random, matching)
            self._select(choice)
            yield self._duration()
            self._fire(choice)

    def _begin(self) -> None:
        """Fixes what productions can see by name, and carries out the methods without parameters."""
        self._calc_context()
        unchecked = check_rules(self)
        for production in self._initializers:
            production.bound = {}
            trace = self.sch.trace
            if trace is not None and trace.all:
                trace.emit(self.sch.now_us, self._path, "initialize", {"method": production.name})
            production.fire()
            if self.sch.bound:  # what an initializer assigns, every production can see
                self._context.update(self.sch.bound)
        for production in self._productions:
            production.share_globals()
        if unchecked:
            check_names(self)
        matcher = Matcher(self._context)
        matcher.build(self._productions)
        self.__dict__["_matcher"] = matcher

    def _calc_context(self) -> None:
        context: dict[str, Any] = {}
        above: Model | None = self
        top: Model = self
        while above is not None:
            for name, value in above.__dict__.items():
                if name[0] != "_" and name != "parent" and name not in context and not isinstance(value, MethodWrapper):
                    context[name] = value
            top = above
            above = above.parent
        context["self"] = self
        context["top"] = top
        own = self.__dict__
        own["_top"] = top
        own["_context"] = context
        for production in (*self._initializers, *self._productions):
            production.context = context
            for name in production.keys:
                if name not in context:
                    raise ProductionException(
                        f"production '{production.name}' ({production.place}) matches on '{name}', which neither the agent "
                        f"nor its ancestors have{did_you_mean(name, [*context, 'utility'])}"
                    )

    def _match(self) -> list[Production]:
        """Returns the productions that match now; a trace learns what they looked at beyond buffers and modules."""
        matcher = self._matcher
        assert matcher is not None
        matching = matcher.matching()
        trace = self.sch.trace
        if trace is not None and trace.all:
            if matcher.observed.used:
                self._observe(trace)
            if not matching or not self._weighs:
                utilities = {production.name: production.base_utility for production in matching}
                trace.emit(self.sch.now_us, self._path, "conflict", {"utilities": utilities})
        return matching

    def _observe(self, trace: Trace) -> None:
        """Tells the run's trace what has changed of what productions see, beyond what it knows by itself."""
        seen = self._matcher.observed.news(trace) if self._matcher is not None else {}
        if seen:
            trace.emit(self.sch.now_us, self._path, "observe", seen)

    def _trace_state(self, trace: Trace) -> None:
        super()._trace_state(trace)
        if trace.all:
            matcher, chosen = self._matcher, self._chosen
            data = {
                "productions": [production.name for production in self._productions],
                "initializers": [production.name for production in self._initializers],
                "chosen": None if chosen is None else chosen.name,
                "matched": [] if matcher is None else [production.name for production in matcher.last],
                "drawn": self._drawn_names(),
            }
            choice = self._standing_choice()
            if choice is not None:
                data |= {"utilities": choice.utilities, "parts": choice.parts, "threshold": choice.threshold}
            trace.emit(self.sch.now_us, self._path, "productions", data)
            if trace is self.sch.trace:
                self._observe(trace)
            elif matcher is not None and (seen := matcher.observed.everything()):
                # Who only listens hears everything, and takes no news from the run's own trace.
                trace.emit(self.sch.now_us, self._path, "observe", seen)

    def _drawn_names(self) -> list[str]:
        """Returns the names of the modules whose part of a utility is told only at choices."""
        return []

    def _part_names(self) -> list[str]:
        """Returns the names of what utilities are made of, beyond what productions say of themselves."""
        return []

    def _utility_parts(self, production: Production) -> dict[str, float | None]:
        """Returns what each of these adds now; None for what is told only at a choice."""
        return {}

    def _standing_choice(self) -> Choice | None:
        """Returns the latest choice, until the production fires; one that held all back, until the next."""
        choice = self._latest_choice()
        return choice if choice is not None and (choice.chosen is not None or choice.held_back) else None

    def _latest_choice(self) -> Choice | None:
        """Returns the choice that was made at the latest match; None before that."""
        if self._matcher is None:
            return None
        utilities = {production.name: production.base_utility for production in self._matcher.last}
        chosen = self._chosen.name if self._chosen is not None else None
        return Choice(utilities=utilities, parts={}, threshold=None, weighed=self._weighs, chosen=chosen)

    def _select(self, choice: Production) -> None:
        """Notes which production will fire."""
        self.__dict__["_chosen"] = choice
        trace = self.sch.trace
        if trace is not None and trace.production:
            trace.emit(self.sch.now_us, self._path, "select", {"production": choice.name})
        if self.log is not dummy:
            self.log.production = choice.name

    def _duration(self) -> float:
        time = self.production_time
        return (time() if callable(time) else time) - self.production_match_delay

    def _fire(self, choice: Production) -> None:
        self.__dict__["_chosen"] = None
        trace = self.sch.trace
        if trace is not None and trace.production:
            bound = traceable(choice.bound) if choice.more_bound else dict(choice.bound or {})
            trace.emit(self.sch.now_us, self._path, "fire", {"production": choice.name, "bound": bound})
        if self.log is not dummy:
            self.log.production = None
        choice.fire()

    def _add_production(self, production: Production) -> None:
        """Takes in a production that came while running (compilation)."""
        production.context = self._context
        self._productions.append(production)
        if self._matcher is not None:
            self._matcher.build(self._productions)

    def explain(self, at: float | None = None) -> Explanation:
        """Says why: for each production whether it matches or what fails first, its utility, and why it was chosen or lost;
        for each memory its last request. Asking runs no code of the model's and draws no random number.

        Args:
            at: A past time of a traced run [s]; None for now.

        Raises:
            ParameterError: If it is no time, lies ahead, or the run was not traced (level «all») or the agent not there then.
        """
        from actr3d.actr.explain import explain

        return explain(self, at)
