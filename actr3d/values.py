"""Plain values: the immutable form in which a record keeps a copy of any value.

Converting a value runs no code of the modeller, no `__repr__`, property or iterator: if only such code could describe an object,
the record keeps the name of its class.
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
"""The types that are already plain."""
WORDED = frozenset({bytes, bytearray, complex, range, Decimal, Fraction, date, datetime, time, timedelta, UUID})
"""The types whose `str` describes the value completely, and identically in every run."""
COLLECTIONS = (dict, list, tuple, set, frozenset, deque)
"""The types whose items are converted one by one."""
NAMED = (FunctionType, BuiltinFunctionType, MethodType, type)
"""The types of objects that have a name."""
DEEPEST = 16
"""The maximum depth of nested lists in a record."""
MAX_REPEATED = 10_000
"""The maximum number of repeated lists in a record; beyond it, the value is a graph whose copy could grow without limit."""
LONGEST = 14_000
"""The maximum size of a whole number that is written in decimals [bits]; JSON readers do not accept longer ones."""
NOT_TRACED: Mapping[str, bool] = MappingProxyType({"not_traced": True})
"""The metadata of a dataclass field that traces and recordings omit, because they have its value elsewhere."""

_ENCODE = json.JSONEncoder(ensure_ascii=False, allow_nan=False, check_circular=False).encode

Namer = Callable[[object], str | None]


class Opaque(str):
    """The text of an object that has another text of its own, or one that only its own code knows."""

    __slots__ = ()


class Naming(str):
    """A text in which parts of a run are named by their paths: `<walker.goal>`."""

    __slots__ = ()

    def renamed(self, name: Callable[[str], str]) -> Naming:
        """Returns the text with renamed parts; `name` returns the new name of a path."""
        return Naming(_PATH.sub(lambda found: f"<{name(found[1])}>", self))


_PATH = re.compile(r"<([^<>\s]+)>")


def plain(value: Any, name: Namer | None = None) -> Any:
    """Returns the plain form of a value: numbers, texts, and lists and dicts that are copies.

    A set becomes a sorted list; a value that contains itself, or is nested too deeply, becomes «...».

    Args:
        value: Anything.
        name: Returns the names of objects that the caller knows, and None for all others.
    """
    return value if type(value) in BASIC else _Copy(name).of(value)


class _Copy:
    """Converts one value to its plain form.

    Args:
        name: Returns the names of objects that the caller knows.
    """

    def __init__(self, name: Namer | None) -> None:
        self._name = name
        self._above: list[int] = []
        self._seen: set[int] = set()
        self._left = MAX_REPEATED

    def of(self, value: Any) -> Any:
        """Returns the plain form of the value, or of a part of it."""
        # `isinstance` may read an object's `__class__`, which can run the modeller's code; `type` cannot.
        kind = cast("type[Any]", type(value))
        if kind in BASIC:
            return value
        if issubclass(kind, COLLECTIONS):
            return self._collection(value, cast("Any", kind))
        if issubclass(kind, Enum):
            return Opaque(f"{kind.__name__}.{object.__getattribute__(value, '__dict__').get('_name_')}")
        if issubclass(kind, str):  # a subclass of `str`
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
                # Keys are text in every record, including the numbers of a chunk's positions.
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
    """Returns any value as one line of JSON that every reader accepts.

    Values that JSON cannot represent become their `plain` form; the numbers it does not have become `"inf"`, `"-inf"` and `"nan"`.
    """
    value = plain(value)
    try:
        line = json.dumps(value, ensure_ascii=False, allow_nan=False)
    except ValueError:
        line = json.dumps(_finite(value), ensure_ascii=False, allow_nan=False)
    return escape_surrogates(line)


def plain_to_json(value: Any, otherwise: Callable[[Any], str] = to_json) -> str:
    """Returns the same as `to_json`, for a value that is already plain, as the data of events are; several times faster.

    Args:
        value: The value.
        otherwise: Converts the value to JSON if JSON cannot represent all of it.
    """
    try:
        line = _ENCODE(value)
    except (TypeError, ValueError, RecursionError):
        line = otherwise(value)
    return escape_surrogates(line)


def shortened(text: str, most: int) -> str:
    """Returns a text; if it has more than `most` characters, its beginning and `...`."""
    return text if len(text) <= most else f"{text[:most]}..."


def escape_surrogates(text: str) -> str:
    """Returns a text in which lone surrogates, which no encoding has, are written as escapes such as `\\ud800`; JSON has the same ones."""
    return text if text.isascii() else text.encode("utf-8", "backslashreplace").decode("utf-8")


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
