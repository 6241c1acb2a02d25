"""The attributes of a modeller's objects that classes of the library read by name."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

_Kind = TypeVar("_Kind", bound=type[Any])
_READ: dict[type[Any], frozenset[str]] = {}
_READ_OF_ITSELF: dict[type[Any], frozenset[str]] = {}


def reads(*names: str) -> Callable[[_Kind], _Kind]:
    """Declares the attributes that a class reads of other objects, such as those of an environment: renaming one would change a model."""

    def declared(kind: _Kind) -> _Kind:
        _READ[kind] = frozenset(names)
        return kind

    return declared


def reads_of_itself(*names: str) -> Callable[[_Kind], _Kind]:
    """Declares the attributes that a class reads of its own objects if a subclass defines them."""

    def declared(kind: _Kind) -> _Kind:
        _READ_OF_ITSELF[kind] = frozenset(names)
        return kind

    return declared


def attributes_read(kind: type[Any]) -> frozenset[str]:
    """Returns the attributes that a class reads of other objects."""
    return frozenset[str]().union(*(_READ.get(base, ()) for base in kind.__mro__))


def attributes_read_of_itself(kind: type[Any]) -> frozenset[str]:
    """Returns the attributes that a class reads of its own objects if a subclass defines them."""
    return frozenset[str]().union(*(_READ_OF_ITSELF.get(base, ()) for base in kind.__mro__))


def readers() -> frozenset[str]:
    """Returns the names of the classes that read attributes of other objects, as far as they are imported."""
    return frozenset(kind.__name__ for kind in _READ)
