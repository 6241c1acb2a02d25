"""Matches all productions of a system at once: everything they look at is read at most once a cycle, and productions
that ask for a certain value are found by that value, so that the others cost nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache
from typing import Any, NamedTuple

from actr3d.actr.buffer import Buffer
from actr3d.actr.chunk import as_text
from actr3d.actr.model import Model
from actr3d.actr.pattern import MISSING, Bindings, Condition, Missing, calls, get_attribute, is_empty, look_up, slot_named
from actr3d.actr.production import Production


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


def is_recorded(target: Any, key: Any) -> bool:
    """Tells whether every change of what a reading reads goes through the trace by itself."""
    if isinstance(key, str) and "." in key:
        return False
    if isinstance(target, Buffer):
        return type(target).__getitem__ is Buffer.__getitem__
    return isinstance(target, Model) and key in vars(target) and type(target).__getitem__ is Model.__getitem__


class Test(NamedTuple):
    """A condition with the number of the reading it looks at; -1 where it looks at the object itself."""

    condition: Condition
    place: int
    target: Any


class Matcher:
    """The productions of one system, compiled against the objects they look at.

    Args:
        context: The objects by name.
    """

    def __init__(self, context: Mapping[str, Any]) -> None:
        self._context = context
        self._places: dict[tuple[str, Any], int] = {}
        self._readers: list[Callable[[], Any]] = []
        self._attempts: dict[Production, tuple[Attempt, list[Any]]] = {}
        self._order: dict[Production, int] = {}
        self._always: list[Production] = []
        self._by_value: dict[int, dict[str, list[Production]]] = {}
        self._unrecorded: dict[str, Callable[[], Any]] = {}
        self._seen: dict[str, Any] = {}

    def build(self, productions: Sequence[Production]) -> None:
        """Takes in all productions of the system, in their order."""
        tests = {p: [self._test(c) for c in p.conditions] for p in productions}
        self._order = {p: i for i, p in enumerate(productions)}
        self._attempts = {
            p: (compile_attempt(tuple(shape(t) for t in of)), [(t.condition, t.target) for t in of])
            for p, of in tests.items()
        }
        spread: dict[int, set[str]] = {}
        keys = {p: [(t.place, t.condition.value) for t in of if t.condition.op == "is" and t.place >= 0] for p, of in tests.items()}
        for of in keys.values():
            for place, value in of:
                spread.setdefault(place, set()).add(value)
        self._always = []
        self._by_value = {}
        for production, of in keys.items():
            # A value that every such production shares finds nobody faster than trying does.
            many, _, place, value = max(((len(spread[place]), -place, place, value) for place, value in of), default=(0, 0, 0, ""))
            if many > 1:
                self._by_value.setdefault(place, {}).setdefault(value, []).append(production)
            else:
                self._always.append(production)

    def _test(self, condition: Condition) -> Test:
        _, name, key, _ = condition
        name = name or "self"
        target = self._context[name]
        if condition.op == "call" or (isinstance(key, str) and key[:1] == "?"):
            return Test(condition, -1, target)
        return Test(condition, self._place(name, None if condition.op == "empty" else key, target), target)

    def _place(self, name: str, key: Any, target: Any) -> int:
        """Returns the number of a reading; a key of None asks whether the object is empty."""
        place = self._places.get((name, key))
        if place is None:
            place = self._places[name, key] = len(self._readers)
            reader = (lambda: is_empty(target)) if key is None else reader_of(target, key)
            self._readers.append(reader)
            if not is_recorded(target, key):
                self._unrecorded[f"{name}=None" if key is None else f"{name}.{key}"] = reader
        return place

    def observed(self) -> dict[str, Any]:
        """Returns what has changed, since it was last asked, of what productions look at and no model's change records:
        attributes of plain objects, dotted paths, and properties. None stands for what is not there.
        """
        changed: dict[str, Any] = {}
        for label, reader in self._unrecorded.items():
            value = reader()
            value = None if value is MISSING else value
            if self._seen.get(label, UNREAD) != value:
                changed[label] = self._seen[label] = value
        return changed

    def matching(self) -> list[Production]:
        """Returns the productions that match now, in order; each keeps what it bound."""
        readers = self._readers
        values: list[Any] = [UNREAD] * len(readers)
        candidates = self._always
        if self._by_value:
            found: list[Production] = []
            for place, productions in self._by_value.items():
                value = values[place] = readers[place]()
                if value in productions:
                    found += productions[value]
            if not found:
                found = candidates
            elif candidates or len(self._by_value) > 1:
                found = sorted(candidates + found, key=self._order.__getitem__)
            candidates = found
        result: list[Production] = []
        for production in candidates:
            attempt, extra = self._attempts[production]
            bound = attempt(values, readers, extra)
            if bound is not None:
                production.bound = bound
                result.append(production)
        return result

    def matches(self, production: Production) -> bool:
        """Tells whether one production matches now; if so, it keeps what it bound."""
        attempt, extra = self._attempts[production]
        bound = attempt([UNREAD] * len(self._readers), self._readers, extra)
        if bound is None:
            return False
        production.bound = bound
        return True


Shape = tuple[str, int, Any]
Attempt = Callable[[list[Any], list[Callable[[], Any]], list[Any]], Bindings | None]
"""Tries one production: takes the values read so far, the readers, and its conditions with their objects."""
UNREAD: Any = object()


def shape(test: Test) -> Shape:
    """Returns what the code for a test depends on; productions of equal shape share their code."""
    op, _, _, value = test.condition
    return op, test.place, None if test.place < 0 or op == "empty" else value


@lru_cache(maxsize=4096)
def compile_attempt(tests: tuple[Shape, ...]) -> Attempt:
    """Writes and compiles the function that tries a production: straight code, each reading done once and only if needed."""
    lines = ["def attempt(v, r, extra):"]
    last = ["    b = {" + ", ".join(f"{value!r}: t{place}" for op, place, value in tests if op == "bind" and place >= 0) + "}"]
    read: set[int] = set()
    for number, (op, place, value) in enumerate(tests):
        if place < 0:
            last.append(f"    if not holds(extra[{number}], b): return None")
            continue
        if place not in read:
            read.add(place)
            lines += [f"    t{place} = v[{place}]", f"    if t{place} is UNREAD: t{place} = v[{place}] = r[{place}]()"]
        if op == "is":
            lines.append(f"    if t{place} != {value!r}: return None")
        elif op == "empty":
            lines.append(f"    if not t{place}: return None")
        else:
            missing = f"t{place} is MISSING"
            if op == "bind":
                lines.append(f"    if {missing}: return None")
            elif op == "not":
                lines.append(f"    if {missing} or t{place} == {value!r}: return None")
            else:
                wrong = "!=" if op == "same" else "=="
                lines.append(f"    if {missing}: return None")
                last.append(f"    if {value!r} not in b or t{place} {wrong} b[{value!r}]: return None")
    space: dict[str, Any] = {"UNREAD": UNREAD, "MISSING": MISSING, "holds": _holds}
    exec("\n".join([*lines, *last, "    return b"]), space)
    return space["attempt"]


def _holds(extra: tuple[Condition, Any], bound: Bindings) -> bool:
    """Tests what straight code cannot: a modeller's function, or a slot whose name is itself in a variable (`?s:1`)."""
    condition, target = extra
    if condition.op == "call":
        return calls(condition.value, target, bound)
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
