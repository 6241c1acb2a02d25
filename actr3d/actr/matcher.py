"""Matches all productions of a system: those that ask for a certain value are found by that value, so that the others
cost nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from actr3d.actr.attempts import attempt_for, has_slots, reader_of
from actr3d.actr.chunk import LASTING_TYPES
from actr3d.actr.model import Model
from actr3d.actr.pattern import MISSING, Bindings
from actr3d.actr.production import Production
from actr3d.actr.traced import UNWATCHED

Reading = tuple[str, Any]
"""What is read: the name of an object, and a slot; a slot of None asks whether the object is empty."""


def is_recorded(target: Any, key: Any) -> bool:
    """Tells whether every change of what a reading reads goes through the trace by itself."""
    if isinstance(key, str) and "." in key:
        return False
    if key is None or has_slots(target, key):
        return hasattr(target, "chunk")
    if not isinstance(target, Model) or type(target).__getitem__ is not Model.__getitem__ or key in UNWATCHED or key[:1] == "_":
        return False
    return type(vars(target).get(key, MISSING)) in LASTING_TYPES


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
        self.looked: dict[str, Any] = {}
        """What productions saw when they last looked, where no model's change records it; None for what was not there."""
        self.last: list[Production] = []
        """The productions that matched when they were last tried."""
        self._told: dict[str, Any] = {}
        self._listener: object = None

    def build(self, productions: Sequence[Production]) -> None:
        """Takes in all productions of the system, in their order."""
        for production in productions:
            if production not in self._attempts:
                self._attempts[production] = attempt_for(production.conditions, self._context, self._reader)
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
        if is_recorded(target, key):
            return read
        label, looked = f"{name}.{key}", self.looked

        def remember() -> Any:
            value = read()
            looked[label] = None if value is MISSING else value
            return value

        return remember

    def observed(self, listener: object) -> dict[str, Any]:
        """Returns what has changed, since the same listener last asked, of what productions saw beyond buffers and modules:
        attributes of plain objects, dotted paths, and properties. None stands for what is not there.
        """
        if listener is not self._listener:
            self._listener, self._told = listener, {}
        changed = {label: value for label, value in self.looked.items() if self._told.get(label, _UNREAD) != value}
        self._told.update(changed)
        return changed

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
            bound = attempts[production]()
            if bound is not None:
                production.bound = bound
                result.append(production)
        self.last = result
        return result

    def matches(self, production: Production) -> bool:
        """Tells whether one production matches now; if so, it keeps what it bound."""
        bound = self._attempts[production]()
        if bound is None:
            return False
        production.bound = bound
        return True


_UNREAD: Any = object()


def _by_variable(key: Any) -> bool:
    return isinstance(key, str) and key[:1] == "?"
