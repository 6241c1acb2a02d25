"""Reads values without running any of the modeller's code."""

from __future__ import annotations

import inspect
from collections.abc import Sequence
from typing import Any, Final, cast

from actr3d.actr.chunks.chunk import Slot
from actr3d.actr.chunks.pattern import MISSING, Missing
from actr3d.actr.kernel.buffer import Buffer
from actr3d.actr.kernel.model import Model

UNKNOWN: Final = Missing()
"""Represents a value that only the modeller's code can compute: a property's, or an item of an object with its own items."""

_ITEMS: tuple[Any, ...] = tuple(vars(kind)["__getitem__"] for kind in (dict, list, tuple))
_WITH_LENGTH = (str, dict, tuple, list, set, frozenset)


def plain_value(target: Any, path: Slot) -> Any:
    """Returns the value of a slot in an object; MISSING if there is none, UNKNOWN if only the modeller's code can compute it."""
    value: Any = target
    for name in path.split(".") if isinstance(path, str) else (path,):
        value = _step(value, name)
        if value is MISSING or value is UNKNOWN:
            break
    return value


def _step(target: Any, name: Slot) -> Any:
    if isinstance(target, Buffer):
        return MISSING if target.chunk is None else target.chunk.get(name, MISSING)
    kind = cast("Any", type(target))
    items = getattr(kind, "__getitem__", None)
    if items in _ITEMS:
        found = _item(target, name)
        if found is not None:
            return found[0]
    elif items is not None and items is not Model.__getitem__:
        return UNKNOWN
    return _attribute(target, kind, name) if isinstance(name, str) else MISSING


def _item(target: Any, name: Slot) -> tuple[Any] | None:
    """Returns an item of a mapping or a sequence, in a tuple; None for a name in a sequence, which has attributes only."""
    if isinstance(target, dict):
        known = cast("dict[Any, Any]", target)
        nothing = UNKNOWN if hasattr(type(known), "__missing__") else MISSING
        return (known.get(name, nothing),)
    if isinstance(name, str):
        return None
    sequence = cast("Sequence[Any]", target)
    return (sequence[name] if name < len(sequence) else MISSING,)


def _attribute(target: Any, kind: Any, name: str) -> Any:
    if kind.__getattribute__ is not object.__getattribute__:
        return UNKNOWN
    member = inspect.getattr_static(kind, name, MISSING)
    if hasattr(cast("object", type(member)), "__get__") and not inspect.isfunction(member):
        return UNKNOWN
    own: dict[str, Any] = getattr(target, "__dict__", {})
    if name in own or member is not MISSING:
        return own.get(name, member)
    return UNKNOWN if hasattr(kind, "__getattr__") else MISSING


def plain_empty(target: Any) -> bool | Missing:
    """Returns whether the pattern None matches an object; UNKNOWN if only the modeller's code can compute it."""
    if target is None:
        return True
    if isinstance(target, Buffer):
        return not target.chunk
    kind = cast("Any", type(target))
    if kind in _WITH_LENGTH:
        return len(target) == 0
    return UNKNOWN if hasattr(kind, "__len__") or kind.__eq__ is not object.__eq__ else False
