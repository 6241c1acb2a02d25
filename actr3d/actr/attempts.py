"""Writes straight code that tries one production: each slot is read at most once, and only if all before it holds."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache
from pathlib import Path
from typing import Any

from actr3d.actr.buffer import Buffer
from actr3d.actr.chunk import as_text
from actr3d.actr.model import Model
from actr3d.actr.pattern import MISSING, Bindings, Condition, Missing, calls, get_attribute, is_empty, look_up, slot_named

Shape = tuple[str, str, int, Any, Any]
"""A test as the code sees it: (operation, where, number, slot, value); «where» is a buffer, a reader or an extra test."""
Attempt = Callable[[], Bindings | None]
"""Tries a production."""
Maker = Callable[[Sequence[Buffer], Sequence[Callable[[], Any]], Sequence[tuple[Condition, Any]]], Attempt]
"""Makes an attempt of a production's buffers, its readers of anything else, and what straight code cannot test."""


def has_slots(target: Any, key: Any) -> bool:
    """Tells whether a slot is one of the chunk in a buffer."""
    return isinstance(target, Buffer) and type(target).__getitem__ is Buffer.__getitem__ and not (isinstance(key, str) and "." in key)


def reader_of(target: Any, key: Any) -> Callable[[], str | Missing]:
    """Returns a function that reads a slot of an object as text, in the quickest way for that kind of object."""
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
    """Returns a function that tries a production now: it gives what the patterns bind, or None where they do not match.

    Args:
        conditions: The production's conditions.
        context: The objects they look at, by name.
        reader: Makes what reads a slot, given as a name and a key, that is not one of a buffer's chunk.
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
        if op in ("call", "empty") or (isinstance(key, str) and key[:1] == "?"):
            shapes.append((op, "extra", len(extra), None, None))
            extra.append((condition, target))
        elif has_slots(target, key):
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
    """Writes and compiles the code for tests of one shape; productions of equal shape share it."""
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
        else:  # a modeller's function may have bound the variable, or bound it anew
            last.append(f"if {value!r} not in b or {text} {'!=' if op == 'same' else '=='} b[{value!r}]: return None")
    lines.append("b = {" + ", ".join(f"{name!r}: {text}" for name, text in bound.items()) + "}")
    return _assemble([*lines, *last, "return b"], tests)


def _assemble(lines: Sequence[str], tests: Sequence[Shape]) -> Maker:
    """Compiles a function of these lines, inside one that gives it the objects it looks at by name."""
    given = {f"{where}{number}": f"{_GIVEN[where]}[{number}]" for _, where, number, _, _ in tests}
    outer = [f"{name} = {place}" for name, place in given.items()]
    code = ["def make(buffers, readers, extras, MISSING, as_text, holds):", *(f"    {line}" for line in outer), "    def attempt():"]
    space: dict[str, Any] = {}
    text = "\n".join([*code, *(f"        {line}" for line in lines), "    return attempt"])
    exec(compile(text, _PLACE, "exec"), space)
    make = space["make"]
    return lambda buffers, readers, extras: make(buffers, readers, extras, MISSING, as_text, _holds)


_PLACE = str(Path(__file__).with_name("<attempt>"))
"""What tracebacks call such code: a place in the library, so that it is taken for no line of the modeller's."""
_GIVEN = {"buffer": "buffers", "reader": "readers", "extra": "extras"}


def _holds(extra: tuple[Condition, Any], bound: Bindings) -> bool:
    """Tests what straight code cannot: emptiness, a modeller's function, a slot whose name is itself in a variable (`?s:1`)."""
    condition, target = extra
    if condition.op == "empty":
        return is_empty(target)
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
