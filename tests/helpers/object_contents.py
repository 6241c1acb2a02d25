"""Converts an object and all that it refers to into plain values, to compare its contents at two times."""

from __future__ import annotations

from collections.abc import Collection, Mapping
from dataclasses import fields, is_dataclass
from functools import cached_property
from types import BuiltinFunctionType, FunctionType, MethodType, ModuleType
from typing import Any, cast
from weakref import ReferenceType, WeakKeyDictionary

import mujoco
import numpy as np
from numpy.typing import NDArray

PLAIN = (type(None), bool, int, float, complex, str, bytes, slice)
CODE = (type, FunctionType, BuiltinFunctionType, MethodType, ModuleType, ReferenceType, WeakKeyDictionary)


def picture(thing: Any, left_out: Collection[tuple[str, str]]) -> dict[str, Any]:
    """Returns all that can be reached from an object, by the path to it; without cached properties, which follow from the rest.

    Args:
        thing: The object.
        left_out: What is ignored: pairs of the names of a class and of one of its attributes.
    """
    found: dict[str, Any] = {}
    _walk(thing, type(thing).__name__, found, {}, left_out)
    return found


def _walk(thing: Any, path: str, found: dict[str, Any], seen: dict[int, tuple[Any, str]], left_out: Collection[tuple[str, str]]) -> None:
    if isinstance(thing, PLAIN):
        found[path] = repr(cast("object", thing))  # numbers with all their digits; NaN is equal to itself
    elif isinstance(thing, CODE):
        found[path] = getattr(cast("object", thing), "__qualname__", type(cast("object", thing)).__name__)
    elif id(thing) in seen:
        found[path] = f"is {seen[id(thing)][1]}"
    else:
        seen[id(thing)] = thing, path  # while it is kept, no other object has its id
        for name, part in _parts(thing):
            if not any((kind.__name__, name) in left_out for kind in type(thing).__mro__):
                _walk(part, f"{path}.{name}", found, seen, left_out)


def _parts(thing: Any) -> list[tuple[str, Any]]:
    if isinstance(thing, np.ndarray):
        array = cast("NDArray[Any]", thing)
        base: Any = array.base
        if base is not None and not isinstance(base, np.ndarray):
            return []  # an object of MuJoCo
        return [("array", (array.shape, array.dtype.str, array.tobytes()))]
    if isinstance(thing, mujoco.MjModel):
        return [("arrays", {name: array.tobytes() for name in dir(thing) if isinstance(array := getattr(thing, name), np.ndarray)})]
    if isinstance(thing, mujoco.MjData):
        return []  # its state is in what `World.state` returns
    if isinstance(thing, np.random.Generator):
        return [("random", thing.bit_generator.state)]
    if isinstance(thing, Mapping):
        table = cast("Mapping[Any, Any]", thing)
        return [("keys", [str(key) for key in table]), *((f"[{key}]", value) for key, value in table.items())]
    if isinstance(thing, (list, tuple)):
        row = cast("list[Any]", thing)
        return [("length", len(row)), *((f"[{number}]", value) for number, value in enumerate(row))]
    if isinstance(thing, (set, frozenset)):
        return [("members", sorted(map(repr, cast("set[Any]", thing))))]
    named = dict(getattr(thing, "__dict__", {}))
    for kind in type(thing).__mro__:
        slots = kind.__dict__.get("__slots__", ())
        named.update({slot: getattr(thing, slot) for slot in ([slots] if isinstance(slots, str) else slots) if hasattr(thing, slot)})
    if is_dataclass(thing):
        named.update({field.name: getattr(thing, field.name) for field in fields(thing)})
    assert named or type(thing).__module__ != "builtins", f"{type(thing)} is not looked into"
    return [(name, part) for name, part in named.items() if not isinstance(getattr(cast("type", type(thing)), name, None), cached_property)]
