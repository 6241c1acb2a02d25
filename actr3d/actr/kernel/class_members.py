"""What a model gets from its class: methods that others can wait for, and its own copies of the class's objects."""

from __future__ import annotations

import copy
import inspect
from collections.abc import Callable, Generator, Mapping
from types import MethodType, ModuleType
from typing import Any, Protocol, cast

from actr3d.actr.chunks.chunk import PLAIN_TYPES
from actr3d.actr.kernel.events import Event, Trigger
from actr3d.actr.kernel.profile import Profile
from actr3d.actr.kernel.scheduler import Scheduler
from actr3d.clock import seconds
from actr3d.errors import SchedulerError, hint_for

Method = Callable[..., Any]


class MethodOwner(Protocol):
    """A model whose methods are wrapped."""

    sch: Scheduler

    def now(self) -> float:
        """Returns the current time [s]."""
        ...


class Caller(Protocol):
    """A production that calls a method."""

    name: str

    @property
    def place(self) -> str:
        """Where it is written: `file:line`."""
        ...


class MethodWrapper:
    """A method of one model; `yield model.method` waits for the end of its next call."""

    def __init__(self, obj: MethodOwner, func: Method, name: str) -> None:
        self.obj = obj
        self.func = func
        self._method = MethodType(func, obj)
        self.__name__ = name
        self.begins = Trigger(f"{name} begin")
        self.ends = Trigger(f"{name} end")

    @property
    def default_trigger(self) -> Trigger:
        """The trigger that `yield model.method` waits for."""
        return self.ends

    @property
    def _profile(self) -> Profile | None:
        return self.obj.__dict__.get("_profile")

    def __call__(self, *args: Any, **keys: Any) -> Any:
        if self.begins.waiting:
            self.obj.sch.trigger(self.begins)
        value = self._method(*args, **keys)
        if self.ends.waiting:
            self.obj.sch.trigger(self.ends)
        return value

    def __repr__(self) -> str:
        return f"<method {self.func.__qualname__}>"


class GeneratorWrapper(MethodWrapper):
    """A generator method of one model: a call schedules it and returns the event, which can be waited for."""

    def __call__(self, *args: Any, **keys: Any) -> Event:
        sch = self.obj.sch
        return sch.begin(self._steps(args, keys, sch.firing, sch.now_us), self)

    def _steps(self, args: tuple[Any, ...], keys: dict[str, Any], caller: Caller | None, called_us: int) -> Generator[Any, Any, None]:
        """Runs the method and fires its triggers; an error in it names its caller and the time of the call [us]."""
        if self.begins.waiting:
            self.obj.sch.trigger(self.begins)
        try:
            yield from self.func(self.obj, *args, **keys)
        except Exception as error:
            if caller is not None:
                error.add_note(
                    f"in '{self.__name__}' at {self.obj.now():g} s, called by production '{caller.name}' ({caller.place}) "
                    f"at {seconds(called_us):g} s{hint_for(error, self.func.__globals__)}"
                )
            raise
        if self.ends.waiting:
            self.obj.sch.trigger(self.ends)


RESERVED = frozenset({"run", "now", "get_children", "traced", "explain"})
"""Names that a subclass may override, but that are neither wrapped nor copied."""


def has_setter(member: object) -> bool:
    """Returns whether a class's attribute has a setter, as properties do."""
    return hasattr(type(member), "__set__")


def minding_properties(inherited: Callable[[Any, str, Any], None]) -> Callable[[Any, str, Any], None]:
    """Returns a `__setattr__` that calls a class's properties for their attributes, and the inherited one for all others."""

    def set_with_properties(self: Any, key: str, value: Any) -> None:
        if key in self._setters:
            object.__setattr__(self, key, value)
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
            raise SchedulerError(f"{kind.__name__}.{name}: the name '{name}' is reserved in every model; use another")
