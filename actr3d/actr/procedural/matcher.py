"""Finds the productions that match: those that test a slot for a value are indexed by it, and tried only if the slot has it.

Each production is compiled into straight-line code that reads each slot at most once, and only if all tests before it hold.
No reasons are kept: when somebody asks why a production does not match, `actr3d.actr.explain.condition_tests` tests its conditions
again.

What productions read that is not recorded as a change of a model (plain objects, properties, results of modellers' functions) is kept
for the trace and for explanations. These must not read it again, because a property may return another value, or change something,
at each call. After each match, a trace receives the current values that can be read without running any code, and the last known of
the rest.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any, NamedTuple

from actr3d.actr.chunks.chunk import IMMUTABLE_TYPES, as_text, plain_text
from actr3d.actr.chunks.pattern import (
    MISSING,
    Bindings,
    Condition,
    Missing,
    by_variable,
    function_matches,
    get_attribute,
    is_empty,
    look_up,
    slot_named,
)
from actr3d.actr.kernel.buffer import UNKNOWN, Buffer, plain_empty, plain_value, reads_chunk
from actr3d.actr.kernel.model import Model
from actr3d.actr.kernel.tracing import UNWATCHED
from actr3d.actr.procedural.production import Production

MatchedPlace = tuple[str, Any]
"""What is read: the name of an object, and a slot; the slot None means the test whether the object is empty."""


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
        """What productions read that is not recorded as a change of a model."""
        self.last: list[Production] = []
        """The productions that matched when they were last tried."""

    def build(self, productions: Sequence[Production]) -> None:
        """Compiles and indexes all productions of the system, in their order."""
        for production in productions:
            if production not in self._attempts:
                self._attempts[production] = attempt_for(self._remembering(production), self._context, self._reader)
        self._order = {production: number for number, production in enumerate(productions)}
        wanted = {
            p: [((c.name or "self", c.key), c.value) for c in p.conditions if c.op == "is" and not by_variable(c.key)] for p in productions
        }
        spread: dict[MatchedPlace, set[str]] = {}
        for of in wanted.values():
            for reading, value in of:
                spread.setdefault(reading, set()).add(value)
        self._always = []
        indexes: dict[MatchedPlace, dict[Any, list[Production]]] = {}
        for production, of in wanted.items():
            # A value that all these productions test for is useless as an index.
            best = max(of, key=lambda pair: len(spread[pair[0]]), default=None)
            if best is not None and len(spread[best[0]]) > 1:
                indexes.setdefault(best[0], {}).setdefault(best[1], []).append(production)
            else:
                self._always.append(production)
        self._by_value = [(self._reader(name, key), index) for (name, key), index in indexes.items()]

    def _reader(self, name: str, key: Any) -> Callable[[], Any]:
        """Returns a function that reads a slot, and stores the value if the trace would not record it otherwise.

        The trace must not read it again, because a property may return another value, or change something, at each call.
        """
        target = self._context[name]
        read = reader_of(target, key)
        label = self.observed.watch(name, key, target)
        if reads_chunk(target, key) or (records_changes(target, key) and _lasts(target, key)):
            return read
        looked = self.observed.looked

        def remember() -> Any:
            value = read()
            looked[label] = None if value is MISSING else value
            return value

        return remember

    def _remembering(self, production: Production) -> list[Condition]:
        """Returns a production's conditions with the modeller's functions wrapped, so that their results are stored."""
        found: list[Condition] = []
        for number, condition in enumerate(production.conditions):
            if condition.op == "call":
                asking = self._asking(production, number, condition.value)
                condition = Condition(condition.op, condition.name, condition.key, asking)
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
        """Returns whether one production matches now; if so, it keeps what it bound."""
        try:
            bound = self._attempts[production]()
        except Exception as error:
            production.note(error)
            raise
        if bound is None:
            return False
        production.bound = bound
        return True


# -- the code that tries one production

Shape = tuple[str, str, int, Any, Any]
"""A test in the generated code: (operation, where, number, slot, value); «where» is a buffer, a reader or an extra test."""
Attempt = Callable[[], Bindings | None]
"""Tries a production."""
Maker = Callable[[Sequence[Buffer], Sequence[Callable[[], Any]], Sequence[tuple[Condition, Any]]], Attempt]
"""Makes an attempt from a production's buffers, its readers of anything else, and the tests that need a function call."""


def reader_of(target: Any, key: Any) -> Callable[[], str | Missing]:
    """Returns a function that reads a slot of an object as text, in the fastest way for that kind of object."""
    if reads_chunk(target, key):

        def read_slot() -> str | Missing:
            chunk = target.chunk
            value = MISSING if chunk is None else chunk.get(key, MISSING)
            return value if type(value) is str or value is MISSING else as_text(value)

        return read_slot

    if isinstance(target, Model) and type(target).__getitem__ is Model.__getitem__ and isinstance(key, str) and "." not in key:

        def read_attribute() -> str | Missing:
            value = get_attribute(target, key)
            return value if type(value) is str or value is MISSING else as_text(value)

        return read_attribute

    def read_anything() -> str | Missing:
        value = look_up(target, key)
        return value if type(value) is str or value is MISSING else as_text(value)

    return read_anything


def attempt_for(conditions: Sequence[Condition], context: Mapping[str, Any], reader: Callable[[str, Any], Callable[[], Any]]) -> Attempt:
    """Returns a function that tries a production: it returns what the patterns bind, or None if they do not match.

    Args:
        conditions: The production's conditions.
        context: The objects that they test, by name.
        reader: Makes a function that reads a slot, given a name and a key, of anything but a buffer's chunk.
    """
    buffers: list[Buffer] = []
    readers: list[Callable[[], Any]] = []
    extra: list[tuple[Condition, Any]] = []
    places: dict[tuple[str, Any], int] = {}
    shapes: list[Shape] = []
    for condition in conditions:
        op, name, key, value = condition
        name = name or "self"
        target = context[name]
        if op in ("call", "empty") or by_variable(key):
            shapes.append((op, "extra", len(extra), None, None))
            extra.append((condition, target))
        elif reads_chunk(target, key):
            number = places.setdefault((name, None), len(buffers))
            if number == len(buffers):
                buffers.append(target)
            shapes.append((op, "buffer", number, key, value))
        else:
            number = places.setdefault((name, key), len(readers))
            if number == len(readers):
                readers.append(reader(name, key))
            shapes.append((op, "reader", number, None, value))
    return _compile(tuple(shapes))(buffers, readers, extra)


@lru_cache(maxsize=4096)
def _compile(tests: tuple[Shape, ...]) -> Maker:
    """Generates and compiles the code for tests of one shape; productions of equal shape share it."""
    lines: list[str] = []
    last: list[str] = []
    bound: dict[str, str] = {}
    names: dict[tuple[str, int, Any], str] = {}
    seen: set[str] = set()
    extra = any(where == "extra" for _, where, _, _, _ in tests)
    for op, where, number, key, value in tests:
        if where == "extra":
            (lines if op == "empty" else last).append(f"if not holds(extra{number}, {'None' if op == 'empty' else 'b'}): return None")
            continue
        if where == "buffer" and f"c{number}" not in seen:
            seen.add(f"c{number}")
            lines += [f"c{number} = buffer{number}.chunk", f"if c{number} is None: return None"]
        text = names.get((where, number, key))
        if text is None:
            text = names[where, number, key] = f"t{len(names)}"
            lines.append(f"{text} = " + (f"c{number}.get({key!r}, MISSING)" if where == "buffer" else f"reader{number}()"))
        if op == "is":
            plain = text in seen or where == "reader"
            other = "" if plain else f" and (type({text}) is str or {text} is MISSING or as_text({text}) != {value!r})"
            lines.append(f"if {text} != {value!r}{other}: return None")
            continue
        if text not in seen:
            seen.add(text)
            lines += [f"if type({text}) is not str:", f"    if {text} is MISSING: return None", f"    {text} = as_text({text})"]
        if op == "bind":
            bound[value] = text
        elif op == "not":
            lines.append(f"if {text} == {value!r}: return None")
        elif value in bound and not extra:
            lines.append(f"if {text} {'!=' if op == 'same' else '=='} {bound[value]}: return None")
        else:  # a modeller's function may have bound the variable, or changed it
            last.append(f"if {value!r} not in b or {text} {'!=' if op == 'same' else '=='} b[{value!r}]: return None")
    lines.append("b = {" + ", ".join(f"{name!r}: {text}" for name, text in bound.items()) + "}")
    return _assemble([*lines, *last, "return b"], tests)


def _assemble(lines: Sequence[str], tests: Sequence[Shape]) -> Maker:
    """Compiles a function of these lines inside one that provides the objects it tests by name."""
    given = {f"{where}{number}": f"{_GIVEN[where]}[{number}]" for _, where, number, _, _ in tests}
    outer = [f"{name} = {place}" for name, place in given.items()]
    code = ["def make(buffers, readers, extras, MISSING, as_text, holds):", *(f"    {line}" for line in outer), "    def attempt():"]
    space: dict[str, Any] = {}
    text = "\n".join([*code, *(f"        {line}" for line in lines), "    return attempt"])
    exec(compile(text, _PLACE, "exec"), space)
    make = space["make"]
    return lambda buffers, readers, extras: make(buffers, readers, extras, MISSING, as_text, _holds)


_PLACE = str(Path(__file__).with_name("<attempt>"))
"""The file name of generated code in tracebacks: a place in the library, so that it does not look like the modeller's code."""
_GIVEN = {"buffer": "buffers", "reader": "readers", "extra": "extras"}


def _holds(extra: tuple[Condition, Any], bound: Bindings) -> bool:
    """Tests what needs a function call: emptiness, a modeller's function, a slot named by a variable (`?s:1`)."""
    condition, target = extra
    if condition.op == "empty":
        return is_empty(target)
    if condition.op == "call":
        return function_matches(condition.value, target, bound)
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


# -- what productions read that is not recorded as a change of a model


class Asked(NamedTuple):
    """The last result of a modeller's function in a pattern."""

    given: Bindings
    """The variables before the call."""
    agrees: bool
    bound: Bindings
    """The variables after it, and after the functions that followed."""
    time: int
    """The time of the call [us]."""

    def plain(self) -> list[Any]:
        """Returns the result as plain values, for the trace and for explanations."""
        return [_plain(self.given), self.agrees, _plain(self.bound)]


def _plain(bound: Bindings) -> dict[str, Any]:
    """Returns variables as a trace keeps them: plain values unchanged, others as text."""
    found: dict[str, Any] = {}
    for name, value in bound.items():
        found[name] = value if type(value) in IMMUTABLE_TYPES else plain_text(value) or f"<{type(value).__name__}>"
    return found


def result_label(production: str, number: int) -> str:
    """Returns the label under which a trace has the result of the function in a production's condition."""
    return f"{production}()[{number}]"


def records_changes(target: Any, key: Any) -> bool:
    """Returns whether a trace records every change of an attribute, as long as its value is plain."""
    if not isinstance(target, Model) or not isinstance(key, str) or "." in key:
        return False
    return type(target).__getitem__ is Model.__getitem__ and key not in UNWATCHED and key[:1] != "_"


def _lasts(target: Any, key: str) -> bool:
    """Returns whether an attribute's current value is immutable."""
    own: dict[str, Any] = target.__dict__
    return type(own.get(key, MISSING)) in IMMUTABLE_TYPES


class Observed:
    """What the productions of one system read beyond what the trace records anyway."""

    def __init__(self) -> None:
        self.looked: dict[str, Any] = {}
        """What productions read last, as text; None for what was missing."""
        self.asked: dict[tuple[str, int], Asked] = {}
        """The last results of functions, by the production's name and the condition's number."""
        self.used = False
        """Whether productions read anything of that kind."""
        self._watched: dict[str, tuple[Any, Any, bool]] = {}
        """By label: an object, a slot, and whether the trace records changes of this slot while its value is immutable."""
        self._reported: dict[str, Any] = {}
        self._listener: object = None

    def watch(self, name: str, key: Any, target: Any) -> str:
        """Adds one reading, and returns its label; a key of None means whether the target is empty."""
        label = f"{name}.{key}"
        if not (hasattr(target, "chunk") if key is None else reads_chunk(target, key)):
            self._watched[label] = target, key, records_changes(target, key)
            self.used = True
        return label

    def news(self, listener: object) -> dict[str, Any]:
        """Returns what has changed since the last call by the same listener, or everything for a new one.

        Values are text, None for what is missing; emptiness is True or False; a function's result is a list of the variables
        before, whether it agreed, and the variables after.
        """
        if listener is not self._listener:
            self._listener, self._reported = listener, {}
        known = self.everything()
        news = {label: value for label, value in known.items() if self._reported.get(label, UNKNOWN) != value}
        # Other events of the trace report what is missing here. If it is here again in a later call, it counts as changed.
        self._reported = known
        return news

    def everything(self) -> dict[str, Any]:
        """Returns everything that productions read, now or last, in the form of `news`."""
        known: dict[str, Any] = {}
        for label, (target, key, recorded) in self._watched.items():
            if not (recorded and _lasts(target, key)):
                value = self._reading(label, target, key)
                if value is not UNKNOWN:
                    known[label] = value
        for (name, number), asked in self.asked.items():
            known[result_label(name, number)] = asked.plain()
        return known

    def _reading(self, label: str, target: Any, key: Any) -> Any:
        if key is None:
            return plain_empty(target)
        value = plain_value(target, key)
        if value is MISSING:
            return None
        text = None if value is UNKNOWN else plain_text(value)
        return self.looked.get(label, UNKNOWN) if text is None else text
