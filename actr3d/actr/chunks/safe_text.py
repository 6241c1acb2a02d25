"""Converts values to text without running any of the modeller's code."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from enum import Enum
from typing import Any, cast

from actr3d.actr.chunks.chunk import LASTING_TYPES, as_text

_COLLECTIONS = (tuple, list, set, frozenset)
DEEPEST = 8
"""The maximum depth of nested collections that are examined; a collection may contain itself."""


def plain_text(value: Any) -> str | None:
    """Returns a value as patterns compare it (`as_text`); None if only the modeller's code can convert it."""
    if type(value) in LASTING_TYPES:
        return as_text(value)
    if isinstance(value, str):
        return str.__str__(value)
    if isinstance(value, float):
        return as_text(value) if type(value).__format__ is float.__format__ else None
    return as_text(value) if _prints_plainly(value) else None


def _prints_plainly(value: Any, depth: int = 0) -> bool:
    """Returns whether printing a value runs none of the modeller's code."""
    if type(value) in LASTING_TYPES:
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
