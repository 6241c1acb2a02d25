"""The attributes of a modeller's objects that classes of the library read by name."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

_Kind = TypeVar("_Kind", bound=type[Any])
READ: dict[type[Any], frozenset[str]] = {}
"""By class, the attributes that it reads of other objects."""
READ_OF_ITSELF: dict[type[Any], frozenset[str]] = {}
"""By class, the attributes that it reads of its own objects if a subclass defines them."""


def reads(*names: str, of_itself: bool = False) -> Callable[[_Kind], _Kind]:
    """Declares the attributes that a class reads of other objects, such as those of an environment: renaming one would change a model.

    Args:
        names: The attributes.
        of_itself: Whether it reads them of its own objects instead, if a subclass defines them.
    """

    def declared(kind: _Kind) -> _Kind:
        (READ_OF_ITSELF if of_itself else READ)[kind] = frozenset(names)
        return kind

    return declared


def readers_of(name: str) -> tuple[type[Any], ...]:
    """Returns the classes that read an attribute of other objects."""
    return tuple(kind for kind, names in READ.items() if name in names)


def is_read_of_itself(kind: type[Any], name: str) -> bool:
    """Returns whether a class reads an attribute of its own objects if a subclass defines it."""
    return any(name in READ_OF_ITSELF.get(base, ()) for base in kind.__mro__)
