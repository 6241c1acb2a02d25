"""A cache of results about objects, such as classes, which does not keep them alive: those of a model file are deleted with the model."""

from __future__ import annotations

from collections.abc import Callable
from functools import wraps
from typing import TypeVar
from weakref import WeakKeyDictionary

K = TypeVar("K")
V = TypeVar("V")


def weak_cache(function: Callable[[K], V]) -> Callable[[K], V]:
    """Returns a function that stores each result until its argument is deleted.

    A result must not refer to its argument, which it would keep alive.
    """
    found: WeakKeyDictionary[K, V] = WeakKeyDictionary()

    @wraps(function)
    def of(thing: K) -> V:
        try:
            return found[thing]
        except KeyError:
            result = found[thing] = function(thing)
            return result

    return of
