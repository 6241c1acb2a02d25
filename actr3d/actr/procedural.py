"""The ACT-R agent: a production system that chooses by utility."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator, Mapping
from types import MappingProxyType
from typing import Any

from actr3d.actr.events import AGAIN
from actr3d.actr.model import Method, pick
from actr3d.actr.production import Production
from actr3d.actr.production_system import ProductionSystem
from actr3d.actr.traced import traceable
from actr3d.actr.utility import ProceduralSubModule
from actr3d.trace import Trace

LAST = -1000
"""The priority of matching again after firing: everything else that happens at that moment comes first."""


class ACTR(ProductionSystem):
    """An ACT-R agent: the production with the highest utility fires, ties are broken at random, and utilities learn."""

    _weighs = True
    production_time_sd: float | None = None
    """The standard deviation of the firing time [s]; None for no noise."""
    production_threshold: float | Callable[[], float] | None = None
    """The least utility a production needs to fire; a number, a function without arguments, or None for none."""

    @property
    def _indifferent(self) -> bool:
        """Whether utilities are only what productions say of themselves."""
        return not self._adaptors and type(self).get_activation is ACTR.get_activation

    _weighed: Mapping[Production, list[float]] = MappingProxyType({})
    """What each module added to the utilities at the latest choice."""

    def __init__(self, log: Any = None, **attrs: Any) -> None:
        self._adaptors: list[ProceduralSubModule] = []
        super().__init__(log, **attrs)

    def _convert_info(self, objects: dict[str, Any], methods: dict[str, Method]) -> None:
        self.__dict__.setdefault("_adaptors", [])
        super()._convert_info(objects, methods)

    def _process_productions(self) -> Iterator[Any]:
        """Matches, chooses the best, waits, matches again, fires; then lets everything else happen first."""
        self._begin()
        adaptors = self._adaptors
        sch = self.sch
        process = self._process
        matcher = self._matcher
        assert matcher is not None
        while True:
            if self.production_match_delay > 0:
                yield self.production_match_delay
            matching = matcher.matching() if sch.trace is None else self._match()
            choice = self._choose(matching) if matching else None
            if choice is None:
                yield self._top.changes
                continue
            for adaptor in adaptors:
                adaptor.selecting(choice)
            self._select(choice)
            yield self._duration()
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
        """Returns one of those with the highest utility, or None where that is below the threshold."""
        trace = self.sch.trace
        if len(matching) == 1 and self._indifferent and self.production_threshold is None:
            if trace is not None and trace.all:
                only = matching[0]
                trace.emit(self.sch.now_us, self._path, "conflict", {"utilities": {only.name: only.base_utility}})
            return pick(self.random, matching)
        if type(self).get_activation is not ACTR.get_activation:
            utilities: list[float] = [self.get_activation(p) for p in matching]
        elif self._adaptors:
            utilities = self._weigh(matching)
        else:
            utilities = [p.base_utility for p in matching]
        if trace is not None and trace.all:
            self._trace_utilities(matching, utilities)
        best = max(utilities)
        threshold = self.production_threshold
        if callable(threshold):
            threshold = threshold()
        if threshold is not None and best < threshold:
            for adaptor in self._adaptors:
                adaptor.below_threshold()
            return None
        return pick(self.random, [p for p, u in zip(matching, utilities, strict=True) if u == best])

    def _weigh(self, matching: list[Production]) -> list[float]:
        """Returns the utilities of productions, and keeps their parts: noise is drawn only here."""
        weighed = {p: [adaptor.utility(p) for adaptor in self._adaptors] for p in matching}
        self.__dict__["_weighed"] = weighed
        utilities: list[float] = []
        for production, parts in weighed.items():
            utility = production.base_utility
            for part in parts:
                utility += part
            utilities.append(utility)
        return utilities

    def _trace_utilities(self, matching: list[Production], utilities: list[float]) -> None:
        trace = self.sch.trace
        assert trace is not None
        data: dict[str, Any] = {"utilities": {p.name: u for p, u in zip(matching, utilities, strict=True)}}
        if self._weighed:
            names = self._adaptor_names()
            data["parts"] = {p.name: dict(zip(names, parts, strict=True)) for p, parts in self._weighed.items()}
            data["drawn"] = self._drawn_names()
        trace.emit(self.sch.now_us, self._path, "conflict", data)

    def _trace_state(self, trace: Trace) -> None:
        super()._trace_state(trace)
        if trace.all:
            # A modeller's own module might change something when it is asked.
            own = {adaptor.name for adaptor in self._adaptors if not type(adaptor).utility.__module__.startswith("actr3d.actr.")}
            for production in self._productions:
                for name, value in self._utility_parts(production, leave_out=own).items():
                    if value is not None:
                        data = {"production": production.name, "part": name, "value": value}
                        trace.emit(self.sch.now_us, self._path, "utility", data)

    def _drawn_names(self) -> list[str]:
        return [adaptor.name for adaptor in self._adaptors if adaptor.draws]

    def _adaptor_names(self) -> list[str]:
        return [adaptor.name for adaptor in self._adaptors]

    def _utility_parts(self, production: Production, leave_out: Collection[str] = ()) -> dict[str, float | None]:
        drawn = self._weighed.get(production) if self._chosen is not None else None
        parts: dict[str, float | None] = {}
        for number, adaptor in enumerate(self._adaptors):
            if adaptor.name in leave_out:
                parts[adaptor.name] = None
            elif adaptor.draws:
                parts[adaptor.name] = None if drawn is None else drawn[number]
            else:
                parts[adaptor.name] = adaptor.utility(production)
        return parts

    def _duration(self) -> float:
        time = self.production_time
        if callable(time):
            time = time()
        if self.production_time_sd is not None:
            time += self.random.gauss(0, self.production_time_sd)
        return max(0, time - self.production_match_delay)

    def _abandon(self, choice: Production) -> None:
        self.__dict__["_chosen"] = None
        trace = self.sch.trace
        if trace is not None and trace.production:
            trace.emit(self.sch.now_us, self._path, "changed", {"production": choice.name})
        self.log.production = "(changed before firing)"

    # -- utility

    def add_adaptor(self, module: ProceduralSubModule) -> None:
        """Takes in a module that adds to utilities; done by the module itself when it becomes an attribute."""
        self._adaptors.append(module)
        for production in self._productions:
            module.create(production)

    def reward(self, value: float) -> None:
        """Gives a reward to the productions that led here."""
        trace = self.sch.trace
        if trace is not None and trace.production:
            trace.emit(self.sch.now_us, self._path, "reward", {"value": traceable(value)})
        for adaptor in self._adaptors:
            adaptor.reward(value)

    def success(self) -> None:
        """Gives a reward of 1."""
        self.reward(1)

    def failure(self) -> None:
        """Gives a reward of -1."""
        self.reward(-1)

    def get_activation(self, production: Production | str | None = None) -> Any:
        """Returns a production's utility, None for an unknown name; without a name, the utilities of all by name."""
        if isinstance(production, Production):
            utility = production.base_utility
            for adaptor in self._adaptors:
                utility += adaptor.utility(production)
            return utility
        if production is None:
            return {p.name: self.get_activation(p) for p in self._productions}
        return next((self.get_activation(p) for p in self._productions if p.name == production), None)
