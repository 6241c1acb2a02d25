"""Reads values without running any code of the modeller's."""

from __future__ import annotations

import inspect
from typing import Any, Final, cast

from actr3d.actr.buffer import Buffer
from actr3d.actr.chunk import Slot
from actr3d.actr.pattern import MISSING, Missing

UNKNOWN: Final = Missing()
"""Stands for a value that only code could tell: a property's, or that of an object with items of its own."""


def plain_value(target: Any, path: Slot) -> Any:
    """Follows a slot's name from an object; returns MISSING where it leads nowhere, UNKNOWN where only code can tell."""
    value: Any = target
    for name in path.split(".") if isinstance(path, str) else (path,):
        value = _step(value, name)
        if value is MISSING or value is UNKNOWN:
            break
    return value


def _step(target: Any, name: Slot) -> Any:
    if isinstance(target, Buffer):
        return MISSING if target.chunk is None else target.chunk.get(name, MISSING)
    if isinstance(target, dict):
        return cast("dict[Any, Any]", target).get(name, MISSING)
    if not isinstance(name, str):
        return UNKNOWN
    kind = cast("Any", type(target))
    member = inspect.getattr_static(kind, name, MISSING)
    if hasattr(cast("object", type(member)), "__get__") and not inspect.isfunction(member):
        return UNKNOWN
    own: dict[str, Any] = getattr(target, "__dict__", {})
    if name in own or member is not MISSING:
        return own.get(name, member)
    return UNKNOWN if hasattr(kind, "__getattr__") else MISSING
