"""Matches all productions of a system at once: everything they look at is read at most once a cycle, and productions
that ask for a certain value are found by that value, so that the others cost nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import Any

from actr3d.actr.buffer import Buffer
from actr3d.actr.chunk import as_text
from actr3d.actr.model import Model
from actr3d.actr.pattern import MISSING, Bindings, Condition, Missing, calls, get_attribute, is_empty, look_up, slot_named
from actr3d.actr.production import Production

Value = str | Missing | bool | None
Test = tuple[int, int, Any, Any]
"""(operation, which reading, what it is compared with, the object itself)"""

IS, NOT, BIND, SAME, DIFFERS, EMPTY, CALL, DYNAMIC = range(8)
_OPS = {"is": IS, "not": NOT, "bind": BIND, "same": SAME, "differs": DIFFERS, "empty": EMPTY, "call": CALL}
_UNREAD: Any = object()


def reader_of(target: Any, key: Any) -> Callable[[], str | Missing]:
    """Returns a function that reads a slot of an object as text, in the quickest way for that kind of object."""
    if isinstance(target, Buffer) and type(target).__getitem__ is Buffer.__getitem__ and not (isinstance(key, str) and "." in key):

        def read_slot() -> str | Missing:
            chunk = target.chunk
            if chunk is None:
                return MISSING
            value = chunk.get(key, MISSING)
            return value if type(value) is str or value is MISSING else as_text(value)

        return read_slot
    if isinstance(target, Model) and type(target).__getitem__ is Model.__getitem__ and isinstance(key, str) and "." not in key:

        def read_attribute() -> str | Missing:
            value = get_attribute(target, key)
            return value if type(value) is str or value is MISSING else as_text(value)

        return read_attribute

    def read_anything() -> str | Missing:
        value = look_up(target, key)
        return MISSING if value is MISSING else as_text(value)

    return read_anything


class Matcher:
    """The productions of one system, compiled against the objects they look at.

    Args:
        context: The objects by name.
    """

    def __init__(self, context: Mapping[str, Any]) -> None:
        self._context = context
        self._places: dict[tuple[str, Any], int] = {}
        self._readers: list[Callable[[], Any]] = []
        self._tests: dict[Production, tuple[Test, ...]] = {}
        self._order: dict[Production, int] = {}
        self._always: list[Production] = []
        self._by_value: dict[int, dict[str, list[Production]]] = {}

    def build(self, productions: Sequence[Production]) -> None:
        """Takes in all productions of the system, in their order."""
        self._tests = {p: tuple(self._test(c) for c in p.conditions) for p in productions}
        self._order = {p: i for i, p in enumerate(productions)}
        spread: dict[int, set[str]] = {}
        for tests in self._tests.values():
            for op, place, value, _ in tests:
                if op == IS:
                    spread.setdefault(place, set()).add(value)
        self._always = []
        self._by_value = {}
        for production, tests in self._tests.items():
            keys = [(len(spread[place]), -place, place, value) for op, place, value, _ in tests if op == IS]
            # A value that every such production shares finds nobody faster than trying does.
            if keys and max(keys)[0] > 1:
                _, _, place, value = max(keys)
                self._by_value.setdefault(place, {}).setdefault(value, []).append(production)
            else:
                self._always.append(production)

    def _test(self, condition: Condition) -> Test:
        op, name, key, value = condition
        target = self._context[name or "self"]
        if op == "call":
            return CALL, -1, value, target
        if isinstance(key, str) and key[:1] == "?":
            return DYNAMIC, -1, condition, target
        return _OPS[op], self._place(name or "self", None if op == "empty" else key, target), value, target

    def _place(self, name: str, key: Any, target: Any) -> int:
        """Returns the number of a reading; a key of None asks whether the object is empty."""
        place = self._places.get((name, key))
        if place is None:
            place = self._places[name, key] = len(self._readers)
            self._readers.append((lambda: is_empty(target)) if key is None else reader_of(target, key))
        return place

    def matching(self) -> list[Production]:
        """Returns the productions that match now, in order; each keeps what it bound."""
        values: list[Any] = [_UNREAD] * len(self._readers)
        candidates = self._always
        if self._by_value:
            readers = self._readers
            found: list[Production] = []
            for place, productions in self._by_value.items():
                value = values[place] = readers[place]()
                if value in productions:
                    found += productions[value]
            if self._always or len(self._by_value) > 1:
                found = sorted(self._always + found, key=self._order.__getitem__) if found else self._always
            candidates = found
        result: list[Production] = []
        for production in candidates:
            bound = self._try(self._tests[production], values)
            if bound is not None:
                production.bound = bound
                result.append(production)
        return result

    def matches(self, production: Production) -> bool:
        """Tells whether one production matches now; if so, it keeps what it bound."""
        bound = self._try(self._tests[production], [_UNREAD] * len(self._readers))
        if bound is None:
            return False
        production.bound = bound
        return True

    def _try(self, tests: tuple[Test, ...], values: list[Any]) -> Bindings | None:
        bound: Bindings = {}
        for op, place, value, target in tests:
            if op < CALL:
                text = values[place]
                if text is _UNREAD:
                    text = values[place] = self._readers[place]()
                if op == IS:
                    if text != value:
                        return None
                elif text is MISSING:
                    return None
                elif op == BIND:
                    bound[value] = text
                elif op == NOT:
                    if text == value:
                        return None
                elif op == EMPTY:
                    if not text:
                        return None
                elif value not in bound or (text == bound[value]) != (op == SAME):
                    return None
            elif op == CALL:
                if not calls(value, target, bound):
                    return None
            elif not _dynamic(value, target, bound):
                return None
        return bound


def _dynamic(condition: Condition, target: Any, bound: Bindings) -> bool:
    """Tests a slot whose name is itself in a variable (`?s:1`)."""
    key = bound.get(str(condition.key)[1:], MISSING)
    found = MISSING if key is MISSING else look_up(target, slot_named(key))
    if found is MISSING:
        return False
    text = as_text(found)
    if condition.op == "bind":
        bound[condition.value] = text
        return True
    wanted = bound.get(condition.value, MISSING) if condition.op in ("same", "differs") else condition.value
    if wanted is MISSING:
        return False
    return (text == wanted) == (condition.op in ("is", "same"))

