"""The ACT-R agent: a production system that chooses by utility."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any, NamedTuple

from actr3d.actr.kernel.class_members import Method
from actr3d.actr.kernel.events import AGAIN, Event
from actr3d.actr.kernel.hooks import hook
from actr3d.actr.kernel.noise import pick, total
from actr3d.actr.kernel.parameters import Extended, NotNegative, check_number
from actr3d.actr.procedural.conflict_set import ConflictSet
from actr3d.actr.procedural.production import Production
from actr3d.actr.procedural.production_system import ProductionSystem, trace_utility_parts
from actr3d.actr.procedural.utility import ProceduralSubModule, known_part
from actr3d.errors import ProductionException
from actr3d.trace import Trace

LAST = -1000
"""The priority of matching again after firing: everything else that happens at that moment comes first."""


class Weighed(NamedTuple):
    """The latest comparison of utilities."""

    matching: list[Production]
    utilities: list[float]
    parts: list[list[float]]
    """What each module added, for each production; empty without modules."""
    threshold: float | None


class ACTR(ProductionSystem):
    """An ACT-R agent: the production with the highest utility fires, ties are broken at random, and utilities learn."""

    _by_utility = True
    production_time_sd: NotNegative | None = None
    """The standard deviation of the firing time [s]; None for no noise."""
    production_threshold: Extended | Callable[[], float | None] | None = None
    """The minimum utility for firing: a number, a function without arguments, or None for no minimum."""

    _weighed: Weighed | None = None
    _process: Event

    def __init__(self, log: Any = None, **attrs: Any) -> None:
        self._adaptors: list[ProceduralSubModule] = []
        super().__init__(log, **attrs)

    def _convert_info(self, objects: dict[str, Any], methods: dict[str, Method]) -> None:
        self.__dict__.setdefault("_adaptors", [])
        super()._convert_info(objects, methods)

    def _process_productions(self) -> Iterator[Any]:
        """Matches, chooses the best, waits, matches again, fires; then waits for everything else at that moment."""
        self._begin()
        state = self._procedural
        matcher = state.matcher
        assert matcher is not None
        adaptors = self._adaptors
        sch = self.sch
        process = self._process
        while True:
            if self.production_match_delay > 0:
                yield self.production_match_delay
            matching = state.without_forbidden(matcher.matching()) if sch.trace is None else self._match()
            choice = self._choose(matching) if matching else None
            if choice is None:
                yield self._top.changes
                continue
            for adaptor in adaptors:
                adaptor.selecting(choice)
            self._select(choice)
            yield self._duration()
            if state.chosen is not choice:  # a user has withdrawn it
                continue
            if not matcher.matches(choice):
                self._abandon(choice)
                continue
            for adaptor in adaptors:
                adaptor.firing(choice)
            self._fire(choice)
            process.priority = LAST
            if not sch.idle_now():
                yield AGAIN

    def _choose(self, matching: list[Production]) -> Production | None:
        """Returns one of those with the highest utility, or None if that is below the threshold."""
        trace = self.sch.trace
        if len(matching) == 1 and not self._adaptors and not self._own_utility and self.production_threshold is None:
            if trace is not None and trace.all:
                only = matching[0]
                data = {"utilities": {only.name: only.base_utility}, **self._procedural.by_hand}
                trace.emit(self.sch.now_us, self._path, "conflict", data)
            return pick(self.random, matching)
        parts: list[list[float]] = []
        if self._own_utility:
            utilities: list[float] = [self.get_activation(p) for p in matching]
            parts = [[utility] for utility in utilities]
        elif self._adaptors:
            parts = [[adaptor.utility(p) for adaptor in self._adaptors] for p in matching]
            utilities = [total(of, p.base_utility) for p, of in zip(matching, parts, strict=True)]
        else:
            utilities = [p.base_utility for p in matching]
        best = max(utilities)
        threshold = self.production_threshold
        if callable(threshold):
            threshold = threshold()
            if threshold is not None:
                check_number(threshold, f"{type(self).__name__}.production_threshold()", infinite=True)
        weighed = self.__dict__["_weighed"] = Weighed(matching, utilities, parts, threshold)
        if trace is not None and trace.all:
            self._trace_utilities(weighed, trace)
        wanted = self._procedural.wanted_of(matching)
        if wanted is not None:
            return wanted
        if threshold is not None and best < threshold:
            for adaptor in self._adaptors:
                adaptor.below_threshold()
            return None
        equal = [p for p, u in zip(matching, utilities, strict=True) if u == best]
        if not equal:
            unknown = next(p for p, u in zip(matching, utilities, strict=True) if u != u)
            raise ProductionException(f"production '{unknown.name}' ({unknown.place}): its utility is not a number (nan)")
        return pick(self.random, equal)

    # -- what a trace receives about utilities

    @property
    def _own_utility(self) -> bool:
        """Whether the modeller's own `get_activation` computes utilities."""
        return type(self).get_activation is not ACTR.get_activation

    def _trace_utilities(self, weighed: Weighed, trace: Trace) -> None:
        matching, utilities, parts, threshold = weighed
        data: dict[str, Any] = {"utilities": {p.name: u for p, u in zip(matching, utilities, strict=True)}}
        if parts:
            names = self._part_names()
            data["parts"] = {p.name: dict(zip(names, of, strict=True)) for p, of in zip(matching, parts, strict=True)}
            data["drawn"] = self._drawn_names()
        if threshold is not None:
            data["threshold"] = threshold
        data |= self._procedural.by_hand
        trace.emit(self.sch.now_us, self._path, "conflict", data)

    def _trace_state(self, trace: Trace) -> None:
        super()._trace_state(trace)
        if trace.all:
            for production in self._productions:
                trace_utility_parts(self, production, trace)

    def _part_names(self) -> list[str]:
        return ["get_activation"] if self._own_utility else [adaptor.name for adaptor in self._adaptors]

    def _utility_parts(self, production: Production) -> dict[str, float | None]:
        if self._own_utility:
            return {"get_activation": None}
        return {adaptor.name: known_part(adaptor, production) for adaptor in self._adaptors}

    def _latest_choice(self) -> ConflictSet | None:
        weighed, matcher, picked = self._weighed, self._procedural.matcher, self._procedural.chosen
        if weighed is None or matcher is None or weighed.matching is not matcher.last:
            return super()._latest_choice()
        matching, utilities, parts, threshold = weighed
        names = self._part_names()
        return ConflictSet(
            utilities={p.name: u for p, u in zip(matching, utilities, strict=True)},
            parts={p.name: dict(zip(names, of, strict=True)) for p, of in zip(matching, parts, strict=True)} if parts else {},
            threshold=threshold,
            weighed=True,
            chosen=picked.name if picked is not None else None,
            **self._procedural.by_hand,
        )

    def _duration(self) -> float:
        time = self.production_time
        if callable(time):
            time = time()
            check_number(time, f"{type(self).__name__}.production_time()")
        if self.production_time_sd is not None:
            time += self.random.gauss(0, self.production_time_sd)
        return max(0, time - self.production_match_delay)

    def _abandon(self, choice: Production) -> None:
        self._procedural.chosen = None
        trace = self.sch.trace
        if trace is not None and trace.production:
            trace.emit(self.sch.now_us, self._path, "changed", {"production": choice.name})
            if trace.all:
                self._observe(trace)
        self.log.production = "(changed before firing)"

    # -- utility

    @hook
    def add_adaptor(self, module: ProceduralSubModule) -> None:
        """Adds a utility module; the module calls this when it becomes an attribute."""
        self._adaptors.append(module)
        for production in self._productions:
            module.create(production)

    def reward(self, value: float) -> None:
        """Applies a reward.

        `PMNew` and `PMPGC` apply it to all productions chosen since the last reward, `PMTD` to the one that fired last.

        Raises:
            ParameterError: If it is not a finite number.
        """
        check_number(value, f"{type(self).__name__}.reward(value)")
        trace = self.sch.trace
        if trace is not None and trace.production:
            trace.emit(self.sch.now_us, self._path, "reward", {"value": value})
        for adaptor in self._adaptors:
            adaptor.reward(value)

    def success(self) -> None:
        """Applies a reward of 1."""
        self.reward(1)

    def failure(self) -> None:
        """Applies a reward of -1."""
        self.reward(-1)

    def get_activation(self, production: Production | str | None = None) -> Any:
        """Returns a production's utility, None for an unknown name; without a name, the utilities of all by name."""
        if isinstance(production, Production):
            return total((adaptor.utility(production) for adaptor in self._adaptors), production.base_utility)
        if production is None:
            return {p.name: self.get_activation(p) for p in self._productions}
        return next((self.get_activation(p) for p in self._productions if p.name == production), None)
