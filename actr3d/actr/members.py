"""What the class of a model brings: methods, and objects of which every instance gets its own copy."""

from __future__ import annotations

import copy
import inspect
from collections.abc import Callable, Mapping
from types import ModuleType
from typing import Any, cast

from actr3d.actr.chunk import PLAIN_TYPES
from actr3d.actr.methods import Method
from actr3d.errors import SchedulerError

RESERVED = frozenset({"run", "now", "get_children", "traced", "explain"})
"""What a subclass may override, but not turn into something that is waited for or copied."""


def has_setter(member: object) -> bool:
    """Tells whether a class's attribute takes care of being set, as properties do."""
    return hasattr(type(member), "__set__")


def minding_properties(inherited: Callable[[Any, str, Any], None]) -> Callable[[Any, str, Any], None]:
    """Returns a `__setattr__` that leaves to a class's properties what they take care of, and the rest to the inherited one."""

    def set_with_properties(model: Any, key: str, value: Any) -> None:
        if key in model._setters:
            object.__setattr__(model, key, value)
        else:
            inherited(model, key, value)

    return set_with_properties


def class_members(kind: type, root: type) -> tuple[dict[str, Method], dict[str, Any]]:
    """Returns what a class and its ancestors below `root` bring, in alphabetical order: methods, and other objects.

    Names that begin with `_` and properties are left out. In place of a class derived from `root` stands an instance.
    """
    found: dict[str, Any] = {}
    for klass in reversed(kind.__mro__):
        if klass not in root.__mro__:
            found.update(vars(klass))
    methods: dict[str, Method] = {}
    objects: dict[str, Any] = {}
    for name in sorted(found):
        member = found[name]
        if name[0] == "_" or name in RESERVED:
            continue
        if inspect.isfunction(member):
            methods[name] = member
        elif isinstance(member, type) and issubclass(member, root):
            objects[name] = member()
        elif not isinstance(member, (property, staticmethod, classmethod)) and not has_setter(cast("object", member)):
            objects[name] = member
    return methods, objects


def copy_objects(objects: dict[str, Any], living: Callable[[object], bool]) -> dict[str, Any]:
    """Copies a class's objects for one instance; what cannot be copied (an open file) or is `living` is shared."""
    memo: dict[int, Any] = {id(obj): obj for obj in objects.values() if isinstance(obj, ModuleType)}
    copies: dict[str, Any] = {}
    for name, obj in objects.items():
        if type(obj) in PLAIN_TYPES or obj is None:
            copies[name] = obj
        elif living(obj):
            copies[name] = memo[id(obj)] = obj
        else:
            try:
                copies[name] = copy.deepcopy(obj, memo)
            except TypeError:
                copies[name] = obj
    return copies


def check_names(kind: type, members: Mapping[str, Any]) -> None:
    """Checks that a class leaves alone the names that hold the tree together.

    Raises:
        SchedulerError: If it gives one of them to something else.
    """
    for name in ("changes", "log", "parent", "random", "sch"):
        if name not in members:
            continue
        value = members[name]
        usable = hasattr(value, "choice") if name == "random" else name == "log" and type(value) not in PLAIN_TYPES
        if not usable:
            raise SchedulerError(f"{kind.__name__}.{name}: the name '{name}' is taken by every model; use another")
