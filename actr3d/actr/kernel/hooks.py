"""Methods that the library calls and a model may override, but does not call."""

from __future__ import annotations

from typing import Any, TypeVar

_Method = TypeVar("_Method")


def hook(method: _Method) -> _Method:
    """Marks a method, and all that override it, as called by the library; the workbench does not offer it for calls."""
    vars(method)["hook"] = True
    return method


def is_hook(kind: type[Any], name: str) -> bool:
    """Returns whether a method of a class, or one that it overrides, is marked as called by the library."""
    return any(getattr(vars(one).get(name), "hook", False) for one in kind.__mro__)
