"""What a model gets from its class: methods, and its own copies of the class's objects."""

from __future__ import annotations

import copy
import inspect
from collections.abc import Callable, Mapping
from types import ModuleType
from typing import Any, cast

from actr3d.actr.chunks.chunk import PLAIN_TYPES
from actr3d.errors import SchedulerError

Method = Callable[..., Any]


RESERVED = frozenset({"run", "now", "get_children", "traced", "explain"})
"""Names that a subclass may override, but that are neither wrapped nor copied."""


def is_modellers(kind: type) -> bool:
    """Returns whether a class is a modeller's own."""
    return kind is not object and not kind.__module__.startswith("actr3d.")


def has_setter(member: object) -> bool:
    """Returns whether a class's attribute has a setter, as properties do."""
    return hasattr(type(member), "__set__")


def with_property_setters(inherited: Callable[[Any, str, Any], None]) -> Callable[[Any, str, Any], None]:
    """Returns a `__setattr__` that calls a class's properties for their attributes, and the inherited one for all others."""

    def set_with_properties(self: Any, key: str, value: Any) -> None:
        if key in self._setters:
            object.__setattr__(self, key, value)
        elif key[0] == "_":  # as `Model` does, and fast
            self.__dict__[key] = value
        else:
            inherited(self, key, value)

    return set_with_properties


def class_members(kind: type, root: type) -> tuple[dict[str, Method], dict[str, Any]]:
    """Returns the attributes of a class and its ancestors below `root`, in alphabetical order: methods, and other objects.

    Names that begin with `_` and properties are left out. A class derived from `root` is replaced by an instance.
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
    """Copies a class's objects for one instance; objects that cannot be copied (an open file) or are `living` are shared."""
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


def check_methods(kind: type) -> None:
    """Checks that a class has no values, and no productions, under the names of methods that every model needs.

    Raises:
        SchedulerError: If it has one.
    """
    for klass in filter(is_modellers, kind.__mro__):
        for name in sorted(RESERVED & vars(klass).keys()):
            member: object = vars(klass)[name]
            if _is_production(member) or (not callable(member) and not hasattr(type(member), "__get__")):
                raise _reserved(klass, name)


def _is_production(member: object) -> bool:
    """Returns whether a class's attribute is a function that needs no arguments, and so no method: a production, or one like `init`."""
    return inspect.isfunction(member) and all(p.default is not p.empty for p in inspect.signature(member).parameters.values())


def _reserved(kind: type, name: str) -> SchedulerError:
    return SchedulerError(f"{kind.__name__}.{name}: the name '{name}' is reserved in every model; use another")


def check_names(kind: type, members: Mapping[str, Any]) -> None:
    """Checks that a class does not use the names that hold the tree together.

    Raises:
        SchedulerError: If it uses one of them.
    """
    for name in ("changes", "log", "parent", "random", "sch"):
        if name not in members:
            continue
        value = members[name]
        usable = hasattr(value, "choice") if name == "random" else name == "log" and type(value) not in PLAIN_TYPES
        if not usable:
            raise _reserved(kind, name)
