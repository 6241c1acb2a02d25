"""Plain values: what a record keeps of any value, as it is now and for good.

Nothing that a modeller wrote is run for it, no `__repr__`, property or iterator of theirs: of an object that only such
code could put into words, a record keeps the name of its class.
"""

from __future__ import annotations

import json
import re
from collections import deque
from collections.abc import Callable, Mapping
from datetime import date, datetime, time, timedelta
from decimal import Decimal
from enum import Enum
from fractions import Fraction
from math import isfinite
from types import BuiltinFunctionType, FunctionType, MappingProxyType, MethodType
from typing import Any, cast
from uuid import UUID

BASIC = frozenset({str, float, int, bool, type(None)})
"""The types that are plain already."""
WORDED = frozenset({bytes, bytearray, complex, range, Decimal, Fraction, date, datetime, time, timedelta, UUID})
"""The types whose own text says all there is, and the same in every run."""
COLLECTIONS = (dict, list, tuple, set, frozenset, deque)
"""The types whose items are kept one by one."""
NAMED = (FunctionType, BuiltinFunctionType, MethodType, type)
"""The types of what has a name of its own."""
DEEPEST = 16
"""How many levels of lists in lists a record keeps."""
MOST = 10_000
"""How often a record keeps a list once more that it has kept before; beyond that it is a net in which every way would be gone."""
LONGEST = 14_000
"""How long a whole number may be to be written in decimals [bits]; JSON's readers take no longer ones."""
UNTOLD: Mapping[str, bool] = MappingProxyType({"untold": True})
"""The metadata of a dataclass field that traces and recordings leave out, for they have it in another place."""

_ENCODE = json.JSONEncoder(ensure_ascii=False, allow_nan=False, check_circular=False).encode

Namer = Callable[[object], str | None]


class Opaque(str):
    """Stands for an object whose own text is another one, or known only to its own code."""

    __slots__ = ()


class Naming(str):
    """A text in which parts of a run are named by their paths: `<walker.goal>`."""

    __slots__ = ()

    def renamed(self, name: Callable[[str], str]) -> Naming:
        """Returns the text with other names of the parts; `name` returns a path's."""
        return Naming(_PATH.sub(lambda found: f"<{name(found[1])}>", self))


_PATH = re.compile(r"<([^<>\s]+)>")


def plain(value: Any, name: Namer | None = None) -> Any:
    """Returns what a record keeps of a value: numbers, texts, lists and dicts that nothing else can change.

    A set becomes a sorted list; what contains itself, or lies too deep, becomes «...».

    Args:
        value: Anything.
        name: Names the objects that the caller knows; None from it for all others.
    """
    return value if type(value) in BASIC else _Copy(name).of(value)


class _Copy:
    """One value being made plain.

    Args:
        name: Names the objects that the caller knows.
    """

    def __init__(self, name: Namer | None) -> None:
        self._name = name
        self._above: list[int] = []
        self._seen: set[int] = set()
        self._left = MOST

    def of(self, value: Any) -> Any:
        """Returns the plain form of the value, or of a part of it."""
        # `isinstance` may ask an object for its class, which runs code of its own; its type may not.
        kind = cast("type[Any]", type(value))
        if kind in BASIC:
            return value
        if issubclass(kind, COLLECTIONS):
            return self._collection(value, cast("Any", kind))
        if issubclass(kind, Enum):
            return Opaque(f"{kind.__name__}.{object.__getattribute__(value, '__dict__').get('_name_')}")
        if issubclass(kind, str):  # a text of a class of its own
            return str.__str__(value)
        if issubclass(kind, (int, float)):
            return int.__add__(value, 0) if issubclass(kind, int) else float.__add__(value, 0)
        return self._text(value, kind)

    def _collection(self, value: Any, kind: Any) -> Any:
        self._left -= id(value) in self._seen
        self._seen.add(id(value))
        if self._left < 0 or len(self._above) >= DEEPEST or id(value) in self._above:
            return "..."
        self._above.append(id(value))
        try:
            if issubclass(kind, dict):
                # A key is text in every record; so are the numbers of a chunk's places.
                return {key if type(key) is str else str(self.of(key)): self.of(entry) for key, entry in dict[Any, Any].items(value)}
            own = next(base for base in COLLECTIONS if issubclass(kind, base))
            items = [self.of(entry) for entry in cast("Any", own).__iter__(value)]
            return sorted(items, key=lambda entry: (type(entry).__name__, repr(entry))) if own in (set, frozenset) else items
        finally:
            self._above.pop()

    def _text(self, value: Any, kind: type[Any]) -> str:
        known = self._name(value) if self._name is not None else None
        if known is not None:
            return known
        if kind in WORDED:
            return repr(value)
        if kind in NAMED:
            return f"<{value.__qualname__}>"
        return Opaque(f"<{kind.__name__}>")


def to_json(value: Any) -> str:
    """Returns any value as one line of JSON that every reader takes.

    What JSON has no word for becomes what `plain` makes of it, and the numbers it does not have `"inf"`, `"-inf"` and `"nan"`.
    """
    value = plain(value)
    try:
        line = json.dumps(value, ensure_ascii=False, allow_nan=False)
    except ValueError:
        line = json.dumps(_finite(value), ensure_ascii=False, allow_nan=False)
    return _encodable(line)


def plain_to_json(value: Any, otherwise: Callable[[Any], str] = to_json) -> str:
    """Returns what `to_json` does of a value that is plain already, as the data of events are; several times as quickly.

    Args:
        value: The value.
        otherwise: Makes JSON of it where JSON has no word for some of it.
    """
    try:
        line = _ENCODE(value)
    except (TypeError, ValueError, RecursionError):
        line = otherwise(value)
    return _encodable(line)


def _encodable(line: str) -> str:
    """Returns JSON in which half a character, which no encoding has, is written as JSON's own escape."""
    return line if line.isascii() else line.encode("utf-8", "backslashreplace").decode("utf-8")


def _finite(value: Any) -> Any:
    """Returns a plain value without the numbers that JSON does not have."""
    if isinstance(value, float):
        return value if isfinite(value) else repr(value)
    if isinstance(value, int) and value.bit_length() > LONGEST:
        return hex(value)
    if isinstance(value, list):
        return [_finite(item) for item in cast("list[Any]", value)]
    if isinstance(value, dict):
        return {key: _finite(item) for key, item in cast("dict[str, Any]", value).items()}
    return value
