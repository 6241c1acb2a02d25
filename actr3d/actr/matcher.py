"""Matches all productions of a system: those that ask for a certain value are found by that value, so that the others
cost nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from actr3d.actr.attempts import attempt_for, reader_of
from actr3d.actr.observed import Asked, Observed, is_recorded
from actr3d.actr.pattern import MISSING, Bindings, Condition
from actr3d.actr.production import Production

Reading = tuple[str, Any]
"""What is read: the name of an object, and a slot; a slot of None asks whether the object is empty."""


class Matcher:
    """The productions of one system, compiled against the objects they look at.

    Args:
        context: The objects by name.
    """

    def __init__(self, context: Mapping[str, Any]) -> None:
        self._context = context
        self._attempts: dict[Production, Callable[[], Bindings | None]] = {}
        self._order: dict[Production, int] = {}
        self._always: list[Production] = []
        self._by_value: list[tuple[Callable[[], Any], dict[Any, list[Production]]]] = []
        self.observed = Observed()
        """What productions saw that no model's change records."""
        self.last: list[Production] = []
        """The productions that matched when they were last tried."""

    def build(self, productions: Sequence[Production]) -> None:
        """Takes in all productions of the system, in their order."""
        for production in productions:
            if production not in self._attempts:
                self._attempts[production] = attempt_for(self._remembering(production), self._context, self._reader)
        self._order = {production: number for number, production in enumerate(productions)}
        wanted = {
            p: [((c.name or "self", c.key), c.value) for c in p.conditions if c.op == "is" and not _by_variable(c.key)] for p in productions
        }
        spread: dict[Reading, set[str]] = {}
        for of in wanted.values():
            for reading, value in of:
                spread.setdefault(reading, set()).add(value)
        self._always = []
        indexes: dict[Reading, dict[Any, list[Production]]] = {}
        for production, of in wanted.items():
            # A value that every such production shares finds nobody faster than trying does.
            best = max(of, key=lambda pair: len(spread[pair[0]]), default=None)
            if best is not None and len(spread[best[0]]) > 1:
                indexes.setdefault(best[0], {}).setdefault(best[1], []).append(production)
            else:
                self._always.append(production)
        self._by_value = [(self._reader(name, key), index) for (name, key), index in indexes.items()]

    def _reader(self, name: str, key: Any) -> Callable[[], Any]:
        """Returns a reader that remembers what it read, where the trace would not know otherwise.

        It is not read again for that: a property may answer otherwise, or change something, each time it is asked.
        """
        target = self._context[name]
        read = reader_of(target, key)
        label = self.observed.watch(name, key, target)
        if is_recorded(target, key):
            return read
        looked = self.observed.looked

        def remember() -> Any:
            value = read()
            looked[label] = None if value is MISSING else value
            return value

        return remember

    def _remembering(self, production: Production) -> list[Condition]:
        """Returns a production's conditions, in which the modeller's functions leave word of what they said."""
        found: list[Condition] = []
        for number, condition in enumerate(production.conditions):
            if condition.op == "call":
                condition = condition._replace(value=self._asking(production, number, condition.value))
            elif condition.op == "empty":
                name = condition.name or "self"
                self.observed.watch(name, None, self._context[name])
            found.append(condition)
        return found

    def _asking(self, production: Production, number: int, function: Callable[[Any, Bindings], Any]) -> Callable[[Any, Bindings], Any]:
        self.observed.used = True
        asked, label, sch = self.observed.asked, (production.name, number), production.system.sch

        def ask(target: Any, bound: Bindings) -> Any:
            given = dict(bound)
            asked[label] = Asked(given, False, bound, sch.now_us)
            agrees = function(target, bound) != False  # noqa: E712 - None means yes
            asked[label] = Asked(given, bool(agrees), bound, sch.now_us)
            return agrees

        return ask

    def matching(self) -> list[Production]:
        """Returns the productions that match now, in order; each keeps what it bound."""
        candidates = self._always
        if self._by_value:
            found: list[Production] = []
            for reader, index in self._by_value:
                value = reader()
                if value in index:
                    found += index[value]
            if not found:
                found = candidates
            elif candidates or len(self._by_value) > 1:
                found = sorted(candidates + found, key=self._order.__getitem__)
            candidates = found
        result: list[Production] = []
        attempts = self._attempts
        for production in candidates:
            try:
                bound = attempts[production]()
            except Exception as error:
                production.note(error)
                raise
            if bound is not None:
                production.bound = bound
                result.append(production)
        self.last = result
        return result

    def matches(self, production: Production) -> bool:
        """Tells whether one production matches now; if so, it keeps what it bound."""
        try:
            bound = self._attempts[production]()
        except Exception as error:
            production.note(error)
            raise
        if bound is None:
            return False
        production.bound = bound
        return True


def _by_variable(key: Any) -> bool:
    return isinstance(key, str) and key[:1] == "?"
