"""The pattern language: parses text into conditions, and tests them.

Only the slots that a pattern names are tested, and values are compared as text (`as_text`). Tests against constants
and first uses of a variable come first, in the order in which they are written; second uses, negated variables and
functions come last, so that the order of slots does not matter.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping, Sequence
from functools import lru_cache
from typing import Any, Final, Literal, NamedTuple, TypeGuard, cast

from actr3d.actr.chunks.chunk import Chunk, Slot, as_text
from actr3d.errors import PatternException

Bindings = dict[str, Any]


class Missing:
    """The type of the one value that represents a missing slot; it equals no text."""

    def __repr__(self) -> str:
        return "nothing"


MISSING: Final = Missing()

Op = Literal["is", "not", "bind", "same", "differs", "empty", "call"]


def by_variable(slot: Any) -> TypeGuard[str]:
    """Returns whether a slot is given by a variable, `?slot`."""
    return isinstance(slot, str) and slot[:1] == "?"


class Condition(NamedTuple):
    """One test of a pattern.

    `is` and `not` compare with the text in `value`; `bind` binds the variable named there, `same` and `differs` compare with
    its value; `empty` requires that there is no chunk; `call` calls the function in `value`.
    """

    op: Op
    name: str | None
    """The name of the buffer, module or object in the production; None in a request."""
    key: Slot
    """The slot: a number, a name, a dotted path of names, or `?x` for the slot whose name is the value of x."""
    value: Any

    def __str__(self) -> str:
        """Returns the condition as its author would write it."""
        if self.op == "empty":
            return "empty"
        if self.op == "call":
            return f"{getattr(self.value, '__name__', 'function')}()"
        sign = {"is": "", "not": "!", "bind": "?", "same": "?", "differs": "!?"}[self.op]
        return f"{self.key}:{sign}{self.value}"


_SLOT = re.compile(r"([?]?[\w.]+):")
_PIECES: tuple[tuple[re.Pattern[str], str], ...] = (
    (re.compile(r"([\w.-]+)"), "is"),
    (re.compile(r"!([\w.-]+)"), "not"),
    (re.compile(r"\?(\w+)"), "?"),
    (re.compile(r"!\?(\w+)"), "!?"),
)


@lru_cache(maxsize=8192)
def parse(text: str) -> tuple[tuple[Slot, str, str], ...]:
    """Parses a pattern's text.

    Returns:
        Its tests as (slot, sign, word); the sign is `is`, `not`, `?` or `!?`.

    Raises:
        PatternException: If the text is not a pattern; the message says what cannot be parsed.
    """
    tests: list[tuple[Slot, str, str]] = []
    named: Slot | None = None
    for place, word in enumerate(text.split()):
        slot: Slot = place
        rest = word
        found = _SLOT.match(word)
        if found:
            slot = int(found[1]) if found[1].isdecimal() else found[1]
            rest = word[found.end() :]
            named = slot
            if not rest:
                raise PatternException(f"no value for slot '{slot}' in pattern '{text}'")
        elif named is not None:
            raise PatternException(f"'{word}' without a slot's name after the named slot '{named}' in pattern '{text}'")
        if rest != "?":
            tests += _pieces(slot, rest, text)
    return tuple(tests)


def _pieces(slot: Slot, rest: str, text: str) -> list[tuple[Slot, str, str]]:
    """Parses the value of one slot: a sequence of constants and variables, each with or without `!`."""
    tests: list[tuple[Slot, str, str]] = []
    while rest:
        for piece, sign in _PIECES:
            if found := piece.match(rest):
                tests.append((slot, sign, found[1]))
                rest = rest[found.end() :]
                break
        else:
            raise PatternException(
                f"cannot read '{rest}' in slot '{slot}' of pattern '{text}'; a value is letters, digits, '_', '.' and '-', "
                "or '?name', each with '!' before it for «not»"
            )
    return tests


class _PatternParser:
    """Converts patterns to conditions, and tracks which variables are bound already."""

    def __init__(self, bound: Mapping[str, Any] | None) -> None:
        self.bound: Mapping[str, Any] = bound or {}
        self.seen: set[str] = set()
        self.first: list[Condition] = []
        self.named_by_variable: list[Condition] = []
        """Tests of slots named by variables, which must be bound before."""
        self.last: list[Condition] = []

    def read(self, name: str | None, pattern: object) -> None:
        if pattern is None:
            self.first.append(Condition("empty", name, "", None))
        elif callable(pattern):
            self.last.append(Condition("call", name, "", pattern))
        elif isinstance(pattern, str):
            for slot, sign, word in parse(pattern):
                self._test(name, slot, sign, word)
        elif isinstance(pattern, Mapping):
            for slot, value in cast("Mapping[Slot, Any]", pattern).items():
                self.first.append(Condition("is", name, slot, as_text(value)))

    def _test(self, name: str | None, slot: Slot, sign: str, word: str) -> None:
        first = self.first
        if by_variable(slot):
            if slot[1:] in self.bound:
                slot = slot_named(self.bound[slot[1:]])
            else:
                first = self.named_by_variable
        if sign in ("is", "not"):
            first.append(Condition("is" if sign == "is" else "not", name, slot, word))
        elif word in self.bound:
            first.append(Condition("is" if sign == "?" else "not", name, slot, as_text(self.bound[word])))
        elif sign == "!?":
            self.last.append(Condition("differs", name, slot, word))
        elif word in self.seen:
            self.last.append(Condition("same", name, slot, word))
        else:
            self.seen.add(word)
            first.append(Condition("bind", name, slot, word))


def slot_named(value: object) -> Slot:
    """Returns the slot named by a variable's value: a number for digits, as in a pattern's text."""
    text = as_text(value)
    return int(text) if text.isdecimal() else text


def conditions(patterns: object, bound: Mapping[str, Any] | None = None) -> tuple[Condition, ...]:
    """Parses a production's patterns (a dict of name to pattern), or one pattern for one object.

    Args:
        patterns: Each pattern is text, None (empty), a function `f(object, bindings)`, a mapping of slots to values, or a
            tuple or list of these, all of which must hold.
        bound: The values of variables that are bound already, which replace their names in a pattern.

    Raises:
        PatternException: If a text is not a pattern.
    """
    reader = _PatternParser(bound)
    named: Mapping[Any, object] = (
        cast("Mapping[Any, object]", patterns) if isinstance(patterns, Mapping) and not isinstance(patterns, Chunk) else {None: patterns}
    )
    for name, pattern in named.items():
        for part in cast("Sequence[object]", pattern) if isinstance(pattern, (list, tuple)) else (pattern,):
            reader.read(name, part)
    return (*reader.first, *reader.named_by_variable, *reader.last)


def not_patterns(pattern: object) -> list[object]:
    """Returns the parts of a pattern that are none, such as numbers: they match anything."""
    parts = cast("Sequence[object]", pattern) if isinstance(pattern, (list, tuple)) else (pattern,)
    return [part for part in parts if part is not None and not isinstance(part, (str, Mapping)) and not callable(part)]


def get_item(target: Any, key: Slot) -> Any:
    """Returns `target[key]`, or the attribute of that name if the target has no items; MISSING if there is neither."""
    try:
        return target[key]
    except (KeyError, IndexError):
        return MISSING
    except (AttributeError, TypeError):
        return get_attribute(target, key) if isinstance(key, str) else MISSING


def get_attribute(target: Any, name: str) -> Any:
    """Returns an attribute, or MISSING if there is none or a property fails."""
    try:
        return getattr(target, name)
    except (AttributeError, TypeError, KeyError):
        return MISSING


def look_up(target: Any, key: Slot) -> Any:
    """Returns the value of a slot, whose name may be a dotted path, in `target`; MISSING if there is none."""
    if isinstance(key, str) and "." in key:
        *path, key = key.split(".")
        for name in path:
            target = get_item(target, name)
            if target is MISSING:
                return MISSING
    return get_item(target, key)


def is_empty(target: Any) -> bool:
    """Returns whether an object or buffer is empty: equal to None, or of length 0."""
    try:
        return bool(target == None or len(target) == 0)  # noqa: E711 - buffers define what equals None
    except TypeError:
        return False


def is_empty_in_pattern(target: Any, name: str | None) -> bool:
    """Returns whether the pattern None holds; in a request, only None itself is empty."""
    return bool(target == None) if name is None else is_empty(target)  # noqa: E711


def function_matches(function: Callable[[Any, Bindings], Any], target: Any, bindings: Bindings) -> bool:
    """Calls a modeller's function and returns whether it matches.

    It does not match if its result equals False, or if it raises an AttributeError, TypeError or KeyError, as for a missing slot.
    """
    try:
        return function(target, bindings) != False  # noqa: E712 - None counts as a match
    except (AttributeError, TypeError, KeyError):
        return False


class Pattern:
    """A compiled pattern for one object: a chunk, an object of the environment, or a dict of these by name.

    Args:
        patterns: See `conditions`.
        bound: The values of variables that are bound already.
        partial: Computes the penalty of a mismatch (`Partial`) if similar values may match.

    Raises:
        PatternException: If a text is not a pattern.
    """

    def __init__(self, patterns: object, bound: Mapping[str, Any] | None = None, partial: Any = None) -> None:
        self.conditions = conditions(patterns, bound)
        self.partial = partial

    def __repr__(self) -> str:
        return f"<Pattern {' '.join(str(condition) for condition in self.conditions)}>"

    def match(self, obj: Any) -> Bindings | None:
        """Returns the variables that a match binds (possibly none), or None for no match.

        With `partial` set, the object is a chunk, whose `penalty` is set to the sum of all penalties.
        """
        bindings: Bindings = {}
        if self.partial is not None:
            obj.penalty = 0.0
        for op, name, key, value in self.conditions:
            target = obj if name is None else get_item(obj, name)
            if target is MISSING:
                return None
            if op == "empty":
                if not is_empty_in_pattern(target, name):
                    return None
            elif op == "call":
                if not function_matches(value, target, bindings):
                    return None
            elif not self._holds(op, target, key, value, bindings, obj):
                return None
        return bindings

    def _holds(self, op: Op, target: Any, key: Slot, value: Any, bindings: Bindings, obj: Any) -> bool:
        if isinstance(key, str) and key[:1] == "?":
            if key[1:] not in bindings:
                return False
            key = slot_named(bindings[key[1:]])
        found = look_up(target, key)
        if found is MISSING:
            return False
        text = as_text(found)
        if op == "bind":
            bindings[value] = text
            return True
        if op in ("same", "differs"):
            if value not in bindings:
                return False
            value = bindings[value]
        if op in ("not", "differs"):
            return text != value or (self.partial is not None and self._forgives(obj, key, value, text, negated=True))
        return text == value or (self.partial is not None and self._forgives(obj, key, value, text, negated=False))

    def _forgives(self, obj: Any, key: Slot, wanted: Any, found: str, negated: bool) -> bool:
        """Adds the penalty of a mismatch to `obj.penalty`, and returns whether partial matching allows it.

        A modeller's own `match` may not know the values (a KeyError, or None); then they do not match.
        """
        ask = getattr(self.partial, "negated", None) if negated else self.partial.match
        if ask is None:
            return False
        try:
            obj.penalty += ask(key, wanted) if negated else ask(key, wanted, found)
        except (AttributeError, TypeError, KeyError):
            return False
        return True
