"""Chunks: slots with values; how they are made from text, and how values are compared as text."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from enum import Enum
from functools import lru_cache
from numbers import Number
from typing import Any, Protocol, Self, cast

from actr3d.errors import ChunkError, did_you_mean

Slot = int | str
PLAIN_TYPES = frozenset({str, float, int, bool})
"""Plain types: a chunk copies such values from an object, and a trace keeps them unchanged."""
IMMUTABLE_TYPES = PLAIN_TYPES | {type(None)}
"""Immutable types: their text never changes."""
_NUMBER = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)(e[+-]?\d+)?", re.IGNORECASE | re.ASCII)
_BEGINS = frozenset("+-.0123456789")
_COLLECTIONS = (tuple, list, set, frozenset)
DEEPEST = 8
"""The maximum depth of nested collections that are examined; a collection may contain itself."""


class ChunkStoreLike(Protocol):
    """A memory's list of chunks, which finds them by their slots."""

    def discard_indexes(self) -> None:
        """Is called when a chunk in the list has changed."""
        ...


class ChunkObserver(Protocol):
    """Something that is notified of every change of a chunk."""

    def changed(self, chunk: Chunk) -> None:
        """Is called after a change."""
        ...


class PlaceName(str):
    """A model's name that comes from its place in the tree and was not set by its author.

    The slot `name` of a chunk made from such a model has the same value as in python_actr 1.9.5, because printed output shows it.

    Args:
        name: The attribute's name.
        slot: The value of the chunk's slot; None for no such slot.
    """

    slot: str | None

    def __new__(cls, name: str, slot: str | None) -> PlaceName:
        made = super().__new__(cls, name)
        made.slot = slot
        return made

    def __reduce__(self) -> Any:
        return PlaceName, (str(self), self.slot)


def as_text(value: object) -> str:
    """Returns a slot's value as patterns compare it: text unchanged, floats as `%g`, numpy's numbers as Python's, others by `repr`."""
    if isinstance(value, str):
        return value
    if isinstance(value, float):
        return f"{value:g}"
    if type(value) not in IMMUTABLE_TYPES and type(value).__module__ == "numpy" and getattr(value, "shape", None) == ():
        return as_text(cast("Any", value).item())
    return repr(value)


def as_number(value: object) -> float | None:
    """Returns a slot's value as a number, also if it is text in plain notation; None if it is no finite number. True and False are none."""
    if isinstance(value, str):
        if value[:1] not in _BEGINS or not _NUMBER.fullmatch(value):
            return None
    elif isinstance(value, bool) or not isinstance(value, (float, int, Number)):
        return None
    try:
        number = float(cast("Any", value))
    except (OverflowError, TypeError, ValueError):
        return None
    return number if math.isfinite(number) else None


def plain_text(value: Any) -> str | None:
    """Returns a value as patterns compare it (`as_text`); None if only the modeller's code can convert it."""
    if type(value) in IMMUTABLE_TYPES:
        return as_text(value)
    if isinstance(value, str):
        return str.__str__(value)
    if isinstance(value, float):
        return as_text(value) if type(value).__format__ is float.__format__ else None
    return as_text(value) if _prints_plainly(value) else None


def _prints_plainly(value: Any, depth: int = 0) -> bool:
    """Returns whether printing a value runs none of the modeller's code."""
    if type(value) in IMMUTABLE_TYPES:
        return True
    if depth > DEEPEST:
        return False
    if isinstance(value, Enum):
        # `value.value` may be a modeller's own property; Python documents `_value_`.
        return type(value).__repr__ is Enum.__repr__ and _prints_plainly(value._value_, depth + 1)
    if type(value) in _COLLECTIONS:
        return all(_prints_plainly(item, depth + 1) for item in cast("Sequence[Any]", value))
    if type(value) is dict:
        items = cast("Mapping[Any, Any]", value).items()
        return all(_prints_plainly(part, depth + 1) for item in items for part in item)
    return False


def parse_slots(text: str) -> tuple[tuple[Slot, str], ...]:
    """Splits a chunk's text into slots and values.

    A word without a colon goes to the slot numbered by its position, `slot:value` to the named slot; only the first colon
    separates.
    """
    slots: list[tuple[Slot, str]] = []
    for place, word in enumerate(text.split()):
        if ":" in word:
            name, value = word.split(":", 1)
            slots.append((name, value))
        else:
            slots.append((place, word))
    return tuple(slots)


@lru_cache(maxsize=4096)
def _contents_of(text: str) -> tuple[dict[Slot, Any], tuple[tuple[Slot, str], ...]]:
    """Returns a chunk's slots with their values as written, and, in order, the slots that contain variables."""
    slots = parse_slots(text)
    variable = {slot for slot, value in slots if value[:1] == "?"}
    return dict(slots), tuple(pair for pair in slots if pair[0] in variable)


def variable_value(name: str, bound: Mapping[str, Any] | None, text: str) -> Any:
    """Returns the value of the bound variable `?name`, which occurs in `text`.

    Raises:
        ChunkError: If no production has bound it.
    """
    if bound and name in bound:
        return bound[name]
    known = sorted(str(key) for key in bound) if bound else []
    among = f"bound here: {', '.join('?' + k for k in known)}" if known else "no variable is bound here"
    raise ChunkError(f"chunk '{text}': '?{name}' is not bound{did_you_mean(name, known)} ({among})")


def object_slots(attributes: Mapping[str, Any]) -> dict[str, Any]:
    """Returns the slots of a chunk made from an object: its public attributes that are text or numbers."""
    slots = {key: value for key, value in attributes.items() if type(value) in PLAIN_TYPES and key[0] != "_"}
    name = attributes.get("name")
    if isinstance(name, PlaceName) and name.slot is not None:
        slots["name"] = name.slot
    return slots


_NONE_SUCH = object()
_DICT: type[dict[Any, Any]] = dict
"""Chunks are made and changed too often for `super()`."""


class Chunk(dict[Any, Any]):
    """A set of slots and their values.

    Args:
        contents: Text (`'a:1 b:2'`, `'hello world'`, `'?x ?y'`), a mapping (its values keep their types), another
            chunk, a buffer (its chunk), or any object (its public attributes that are text or numbers).
        bound: The values of variables, which replace `?name` in a text.

    Raises:
        ChunkError: If the contents are of another kind, or a variable is not bound.
    """

    def __init__(self, contents: object, bound: Mapping[str, Any] | None = None) -> None:
        if type(contents) is Chunk:
            _DICT.update(self, contents)
            return
        if isinstance(contents, str):
            slots, variable = _contents_of(contents)
            if variable:
                slots = slots.copy()
                for slot, value in variable:
                    slots[slot] = variable_value(value[1:], bound, contents) if value[:1] == "?" else value
            _DICT.update(self, slots)
            return
        if hasattr(contents, "__chunk__"):
            contents = cast("Any", contents).__chunk__()
        if isinstance(contents, Mapping):
            _DICT.update(self, cast("Mapping[Any, Any]", contents))
        elif hasattr(contents, "__dict__") and not isinstance(contents, type):
            _DICT.update(self, object_slots(vars(contents)))
        else:
            try:
                _DICT.update(self, cast("Any", contents))
            except (TypeError, ValueError):
                raise ChunkError(f"a chunk is made of text, a mapping, a chunk or an object (got {contents!r})") from None

    def __repr__(self) -> str:
        """Returns positional slots in order, then the named ones sorted, without slots that begin with `_`."""
        if self.cached_text is not None:
            return self.cached_text
        words: list[str] = []
        get = self.get
        while (value := get(len(words), _NONE_SUCH)) is not _NONE_SUCH:
            words.append(value if type(value) is str else f"{value}")
        places = len(words)
        if places < len(self):
            rest = [key for key in self if not (type(key) is int and 0 <= key < places)]
            words += [f"{key}:{self[key]}" for key in sorted(rest, key=str) if str(key)[:1] != "_"]
        text = " ".join(words)
        if self.stores and IMMUTABLE_TYPES.issuperset(map(type, self.values())):
            self.cached_text = text  # the text of a chunk in memory is used many times
        return text

    __str__ = __repr__

    def copy(self) -> Chunk:
        """Returns a chunk with the same slots that is in no memory."""
        return Chunk(self)

    stores: tuple[ChunkStoreLike, ...] = ()
    """The memories' lists that contain this chunk, which are notified of changes; a copy is in none."""
    watches: tuple[ChunkObserver, ...] = ()
    """The observers of a buffer in a traced run that contains this chunk."""
    penalty: float = 0.0
    """The sum of the penalties for mismatches in the latest request that permitted them (partial matching)."""
    cached_text: str | None = None
    """The chunk as text, if no value in it can change by itself."""

    def _changed(self) -> None:
        self.cached_text = None
        for store in self.stores:
            store.discard_indexes()
        for watch in self.watches:
            watch.changed(self)

    def __getstate__(self) -> dict[str, Any] | None:
        return {name: value for name, value in vars(self).items() if name not in ("stores", "watches", "cached_text")} or None

    def __ior__(self, other: Any) -> Self:  # pyright: ignore[reportIncompatibleMethodOverride]
        self.update(other)
        return self

    def __setitem__(self, key: Any, value: Any) -> None:
        _DICT.__setitem__(self, key, value)
        self._changed()

    def __delitem__(self, key: Any) -> None:
        _DICT.__delitem__(self, key)
        self._changed()

    def update(self, *args: Any, **keys: Any) -> None:
        _DICT.update(self, *args, **keys)
        self._changed()

    def setdefault(self, key: Any, default: Any = None) -> Any:
        value = _DICT.setdefault(self, key, default)
        self._changed()
        return value

    def pop(self, *args: Any) -> Any:
        value = _DICT.pop(self, *args)
        self._changed()
        return value

    def popitem(self) -> tuple[Any, Any]:
        item = _DICT.popitem(self)
        self._changed()
        return item

    def clear(self) -> None:
        _DICT.clear(self)
        self._changed()
