"""The registry of what activations consist of, with the names that users see."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

from actr3d.registry import Registry

T = TypeVar("T", bound=type[Any])

ACTIVATION_PARTS: Registry[str] = Registry("part of an activation")
"""The names that users see for the parts of an activation, by their name in explanations and traces."""


def activation_part(title: str, name: str | None = None) -> Callable[[T], T]:
    """Returns a decorator that registers the name that users see for what a class adds to activations.

    Args:
        title: The name that users see.
        name: The name in explanations and traces; None for that of the class.

    Raises:
        ValueError: If there is a part of this name already.
    """

    def register(kind: T) -> T:
        ACTIVATION_PARTS.add(name or kind.__name__, title, kind.__module__)
        return kind

    return register
