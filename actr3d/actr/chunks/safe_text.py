"""Values as text, as far as Python alone knows how to write them: no code of the modeller's is run."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from enum import Enum
from typing import Any, cast

from actr3d.actr.chunks.chunk import LASTING_TYPES, as_text

_COLLECTIONS = (tuple, list, set, frozenset)
DEEPEST = 8
"""How many levels of collections in collections are looked through; one may contain itself."""


def plain_text(value: Any) -> str | None:
    """Returns a value as patterns compare it (`as_text`); None where only code can tell what it looks like."""
    if type(value) in LASTING_TYPES:
        return as_text(value)
    if isinstance(value, str):
        return str.__str__(value)
    if isinstance(value, float):
        return as_text(value) if type(value).__format__ is float.__format__ else None
    return as_text(value) if _prints_plainly(value) else None


def _prints_plainly(value: Any, depth: int = 0) -> bool:
    """Tells whether no modeller's code takes part in printing a value."""
    if type(value) in LASTING_TYPES:
        return True
    if depth > DEEPEST:
        return False
    if isinstance(value, Enum):
        return type(value).__repr__ is Enum.__repr__ and _prints_plainly(value._value_, depth + 1)
    if type(value) in _COLLECTIONS:
        return all(_prints_plainly(item, depth + 1) for item in cast("Sequence[Any]", value))
    if type(value) is dict:
        items = cast("Mapping[Any, Any]", value).items()
        return all(_prints_plainly(part, depth + 1) for item in items for part in item)
    return False
