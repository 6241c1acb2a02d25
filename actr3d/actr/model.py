"""Model: the part everything is made of; it has a place in a tree, a clock, and methods that can be waited for."""

from __future__ import annotations

import copy
import inspect
import random
import sys
from collections.abc import Callable, Generator, Iterator
from types import ModuleType
from typing import Any, TypeVar, cast

from actr3d.actr import logger as logs
from actr3d.actr.chunk import Chunk, PlaceName
from actr3d.actr.limits import RunLimits
from actr3d.actr.profile import PYTHON_ACTR, Profile
from actr3d.actr.saying import warn_modeller
from actr3d.actr.scheduler import Event, Scheduler, Trigger
from actr3d.actr.sources import for_python_actr
from actr3d.errors import SchedulerError
from actr3d.trace import Trace

UNWATCHED = frozenset({"parent", "sch", "changes", "log", "random", "name"})
"""Attributes that hold the tree together; setting them is not a change that productions could see."""

Method = Callable[..., Any]
Option = TypeVar("Option")


def pick(numbers: random.Random, options: list[Option]) -> Option:
    """Draws one of several; where there is only one, it uses up random numbers just as a choice among one does."""
    if len(options) > 1:
        return numbers.choice(options)
    while numbers.getrandbits(1):
        pass
    return options[0]


class MethodWrapper:
    """A method of one model; `yield model.method` waits for the end of its next call."""

    def __init__(self, obj: Model, func: Method, name: str) -> None:
        self.obj = obj
        self.func = func
        self.__name__ = name
        self.begins = Trigger(f"{name} begin")
        self.ends = Trigger(f"{name} end")

    @property
    def default_trigger(self) -> Trigger:
        """What `yield` on the method itself waits for."""
        return self.ends

    @property
    def _profile(self) -> Profile | None:
        return self.obj._profile

    def __call__(self, *args: Any, **keys: Any) -> Any:
        if self.begins.waiting:
            self.obj.sch.trigger(self.begins)
        value = self.func(self.obj, *args, **keys)
        if self.ends.waiting:
            self.obj.sch.trigger(self.ends)
        return value

    def __repr__(self) -> str:
        return f"<method {self.func.__qualname__}>"


class GeneratorWrapper(MethodWrapper):
    """A generator method of one model: a call schedules it and returns the event, which can be waited for."""

    def __call__(self, *args: Any, **keys: Any) -> Event:
        return self.obj.sch.begin(self._steps(args, keys), self)

    def _steps(self, args: tuple[Any, ...], keys: dict[str, Any]) -> Generator[Any, Any, None]:
        """Runs the method, waking whoever waits for its begin or end."""
        if self.begins.waiting:
            self.obj.sch.trigger(self.begins)
        yield from self.func(self.obj, *args, **keys)
        if self.ends.waiting:
            self.obj.sch.trigger(self.ends)


class Model:
    """A part of a simulation: an agent, one of its modules, an object of its environment, or the environment.

    What a class names among its attributes becomes each instance's own: models there become children, and their
    methods can be waited for. A model joins a tree when it is set as another's attribute, and comes to life when that
    tree is first run or changed.

    Args:
        log: True for the text log, or a log of one's own.
        attrs: Become attributes.
    """

    name = "top"
    _converted = False
    _convert_methods = True
    _auto_run_start = True
    _init_log: Any = None
    _profile: Profile | None = None
    _setters: frozenset[str] = frozenset()
    """The attributes that a class's own properties take care of."""

    # Given to every instance when it comes to life.
    changes: Trigger
    sch: Scheduler
    log: Any
    random: random.Random
    parent: Model | None
    _children: dict[str, Model]

    def __init__(self, log: Any = None, **attrs: Any) -> None:
        self._init_log = log
        for key, value in attrs.items():
            setattr(self, key, value)

    def __getitem__(self, item: str) -> Any:
        return getattr(self, item)

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self._path}>"

    # -- coming to life

    def _ensure_converted(self) -> None:
        if not self._converted:
            self._convert()

    def _is_converted(self) -> bool:
        return self._converted

    def _get_scheduler(self) -> Scheduler:
        self._ensure_converted()
        return self.sch

    def _convert(self, parent: Model | None = None) -> None:
        """Brings the model to life: gives it the tree's clock, its own copies of its class's attributes, its methods."""
        own = self.__dict__
        own["_converted"] = True
        own["changes"] = Trigger("changes")
        if "name" not in own:
            self._call(type(self).name)
        parent = own.get("parent") or parent
        methods, objects = class_members(type(self))
        self._check_names({**objects, **methods})
        objects = copy_objects(objects)
        if parent is not None:
            parent._ensure_converted()
            own["sch"], own["log"], own["random"], own["parent"] = parent.sch, logs.dummy, parent.random, parent
            self._follow(parent._profile)
        else:
            self._become_top()
            self._follow(None)
        self._convert_info(objects, methods)
        for name, obj in objects.items():
            if isinstance(obj, Model):
                if type(obj) is not Model or "name" not in obj.__dict__:
                    obj._call(name)
                if not obj._converted:
                    obj._convert(self)
                self._adopted(name, obj)
            if name in own and name not in UNWATCHED:
                self._warn_of_loss(name, own[name], obj)
            own[name] = obj
        if self._convert_methods:
            for name, func in methods.items():
                wrapper = GeneratorWrapper if inspect.isgeneratorfunction(func) else MethodWrapper
                own[name] = wrapper(self, func, name)
        if self._auto_run_start:
            self.start()
        for key, value in list(own.items()):
            if key[0] != "_" and key != "parent" and isinstance(value, Model) and not value._converted:
                self._take_in(key, value)
        limits = RunLimits.current()
        if parent is None and limits is not None and limits.trace is not None:
            self._attach_trace(limits.trace)

    def _check_names(self, members: dict[str, Any]) -> None:
        """Raises an error where a class gives one of the names that hold the tree together to something else."""
        for name in ("changes", "log", "parent", "random", "sch"):
            if name not in members:
                continue
            value = members[name]
            usable = hasattr(value, "choice") if name == "random" else name == "log" and type(value) not in PLAIN_TYPES
            if not usable:
                raise SchedulerError(f"{type(self).__name__}.{name}: the name '{name}' is taken by every model; use another")

    def _warn_of_loss(self, name: str, before: Any, after: Any) -> None:
        """Warns where what was set on the model is lost, because its class says otherwise.

        A class may well say otherwise than the default of a parameter.
        """
        if type(before) in PLAIN_TYPES and before == after:
            return
        if not any(name in inspect.signature(kind.__init__).parameters for kind in type(self).__mro__[:-1]):
            warn_modeller(
                f"{type(self).__name__}.{name} was set to {traceable(before)!r}, but becomes {traceable(after)!r}, as its class says, "
                "when the model comes to life; set it after the first run(0), or leave it out of the class"
            )

    def _become_top(self) -> None:
        own = self.__dict__
        limits = RunLimits.current()
        sch = own["sch"] = Scheduler(first_come=not written_for_python_actr(type(self)))
        wanted = self._init_log
        own["log"] = logs.log() if wanted is True else logs.dummy if wanted is None else wanted
        seed = limits.next_seed() if limits is not None else None
        if seed is None:
            seed = random.SystemRandom().getrandbits(64)
        sch.seed = seed
        own["random"] = random.Random(seed)
        own["parent"] = None

    def _follow(self, profile: Profile | None) -> None:
        """Goes by the numbers of its parent, unless it has been given its own; for subclasses to act upon."""
        if self._profile is None:
            self.__dict__["_profile"] = profile

    def _convert_info(self, objects: dict[str, Any], methods: dict[str, Method]) -> None:
        """Looks at what the class brings, before its objects come to life; for subclasses."""

    def _call(self, name: str, shown: bool = False) -> None:
        """Names the model after its place in the tree.

        Args:
            name: The attribute's name.
            shown: Whether a chunk made of the model has the name too; python_actr 1.9.5 calls objects of classes of
                their own «top» there, and those of Model itself by the name under which they join a running tree.
        """
        slot = name if shown or self._converted else None if type(self) is Model else "top"
        self.__dict__["name"] = PlaceName(name, slot)

    def _adopted(self, name: str, child: Model) -> None:
        self.__dict__.setdefault("_children", {})[name] = child

    # -- changes

    def __init_subclass__(cls, **options: Any) -> None:
        super().__init_subclass__(**options)
        setters = {name for name, member in vars(cls).items() if has_setter(member)}
        if setters:
            cls._setters = cls._setters | setters
            if "__setattr__" not in vars(cls):
                type.__setattr__(cls, "__setattr__", set_with_properties)

    def __setattr__(self, key: str, value: Any) -> None:
        own = self.__dict__
        if key[0] == "_":
            own[key] = value
        elif key in UNWATCHED or isinstance(value, Model):
            self._set_in_tree(key, value)
        else:
            own[key] = value
            if "_converted" in own:
                # Wakes whoever waits for a change here or further up.
                part = own
                while True:
                    changes: Trigger = part["changes"]
                    if changes.waiting:
                        own["sch"].trigger(changes, -1)
                    above: Model | None = part["parent"]
                    if above is None or above is self:
                        break
                    part = above.__dict__
                trace = own["sch"].trace
                if own["log"] is not logs.dummy or (trace is not None and trace.buffer):
                    self._record(key, value)

    def _record(self, key: str, value: Any) -> None:
        """Lets trace and log know of a change."""
        own = self.__dict__
        trace = own["sch"].trace
        if trace is not None:
            self._trace_change(trace, key, value)
        log = own["log"]
        if log is not logs.dummy and log:
            setattr(log, key, value)

    def _set_in_tree(self, key: str, value: Any) -> None:
        """Sets an attribute that is a model, or one that holds the tree together."""
        own = self.__dict__
        if key == "parent" and value is None and own.get("parent") is not None:
            siblings = own["parent"].__dict__.get("_children", {})
            for known in [name for name, part in siblings.items() if part is self]:
                del siblings[known]
            self._forget_path()
        own[key] = value
        if isinstance(value, Model) and key != "parent":
            self._ensure_converted()
            self._take_in(key, value)
        if self._converted and key not in UNWATCHED:
            for part in self._line():
                if part.changes.waiting:
                    self.sch.trigger(part.changes, priority=-1)
            self._record(key, value)
        if key == "log" and value is not None:
            for name, known in list(own.items()):
                if name[0] != "_" and name not in UNWATCHED and isinstance(known, (int, str, float, type(None))):
                    setattr(value, name, known)

    def _take_in(self, key: str, value: Model) -> None:
        """Makes a model that was set as an attribute a child, unless it has a parent or is an ancestor."""
        above: Model | None = self
        while above is not None:
            if above is value:
                return
            above = above.__dict__.get("parent")
        if value.__dict__.get("parent") is not None:
            return
        value.parent = self
        value._call(key, shown=type(value) is Model)
        self._adopted(key, value)
        value._forget_path()
        if not value._converted:
            value._convert(self)
        else:
            if value.sch is not self.sch:
                value._join(self.sch, self.random)
            for part in value._tree():
                part._follow(part.parent._profile if part.parent is not None else None)

    def _join(self, sch: Scheduler, numbers: random.Random) -> None:
        """Moves a tree that came to life by itself (a model that builds its parts in `__init__`) to another clock."""
        if self.sch.now_us != 0:
            raise SchedulerError(f"'{self.name}' has run by itself until {self.sch.time:g} s; put it into its environment before that")
        while self.sch.queue.heap:
            time, priority, _, event = self.sch.queue.heap[0]
            self.sch.queue.pop()
            sch.queue.push(max(time, sch.now_us), event, -priority)
        sch.round_ms = sch.round_ms or self.sch.round_ms
        sch.take_waiting(self.sch)
        sch.harvests = sch.harvests or self.sch.harvests
        for part in self._tree():
            part.__dict__["sch"], part.__dict__["random"] = sch, numbers

    def _line(self) -> Iterator[Model]:
        """Yields the model and its ancestors."""
        part: Model | None = self
        while part is not None:
            yield part
            part = part.__dict__.get("parent")
            if part is self:
                break

    def _tree(self) -> Iterator[Model]:
        """Yields the model and everything below it."""
        yield self
        for child in self.get_children():
            yield from child._tree()

    # -- the trace

    @property
    def _path(self) -> str:
        """The dotted names from below the top model down to this one; «top» for that model itself."""
        known = self.__dict__.get("_known_path")
        if known is None:
            known = self.__dict__["_known_path"] = self._make_path()
        return known

    def _forget_path(self) -> None:
        for part in self._tree():
            part.__dict__.pop("_known_path", None)

    def _make_path(self) -> str:
        names: list[str] = []
        part: Model = self
        while (above := part.__dict__.get("parent")) is not None and len(names) < 64:
            names.append(part.name)
            part = above
        return ".".join(reversed(names)) or "top"

    def traced(self, level: str = "all") -> Trace:
        """Starts a trace of the whole run this model belongs to, and returns it.

        Args:
            level: How much to record; see `actr3d.trace.LEVELS`.

        Raises:
            ParameterError: If the level is unknown.
        """
        self._ensure_converted()
        top: Model = self
        while top.parent is not None:
            top = top.parent
        trace = Trace(level)
        top._attach_trace(trace)
        return trace

    def _attach_trace(self, trace: Trace) -> None:
        self.sch.trace = trace
        if trace.production:
            data = {"model": type(self).__name__, "seed": self.sch.seed, "profile": (self._profile or PYTHON_ACTR).name}
            trace.emit(self.sch.now_us, "top", "start", data)
        if trace.buffer:
            for part in self._tree():
                part._trace_state(trace)

    def _trace_state(self, trace: Trace) -> None:
        """Records the present value of every attribute, so that a trace which starts late can be read from its start."""
        if trace.all:
            state = {key: value for key, value in self.__dict__.items() if key[0] != "_" and key not in UNWATCHED}
            plain = {key: value for key, value in state.items() if value is None or type(value) in PLAIN_TYPES}
            trace.emit(self.sch.now_us, self._path, "state", plain)

    def _trace_change(self, trace: Trace, key: str, value: Any) -> None:
        """Records one attribute's new value."""
        if not trace.all:
            return
        if type(value) in PLAIN_TYPES:
            trace.emit(self.sch.now_us, self._path, "state", {key: value})
        elif isinstance(value, Model) and value.__dict__.get("parent") is self:
            for part in value._tree():
                part._trace_state(trace)
        else:
            trace.emit(self.sch.now_us, self._path, "state", {key: traceable(value)})

    # -- running

    def start(self) -> Any:
        """Is called when the model comes to life; a generator here runs from time 0. For subclasses."""

    def run(self, limit: float | None = None, func: Callable[[], Any] | None = None) -> None:
        """Runs the whole tree until nothing is left to do, `stop` is called, or `limit` seconds more have passed.

        Args:
            limit: How long [s from now]; calls can follow one another for ever without drift.
            func: Called first.

        Raises:
            SchedulerError: If time stands still, or something cannot be waited for.
        """
        if not self._converted:
            self._convert()
        if func is not None:
            self.sch.add(func)
        self.sch.run(limit)

    def stop(self) -> None:
        """Ends the run once the present event is over."""
        self._ensure_converted()
        self.sch.stop()

    def now(self) -> float:
        """Returns the present [s]."""
        self._ensure_converted()
        return self.sch.now_us / 1_000_000

    def get_children(self) -> list[Model]:
        """Returns the models that are this one's parts, in the order they came."""
        return list(self.__dict__.get("_children", {}).values())


PLAIN_TYPES = frozenset({int, float, str, bool})


def traceable(value: Any) -> Any:
    """Returns what a trace keeps of a value: plain values as they are, chunks as a copy, others as text without addresses."""
    if value is None or type(value) in PLAIN_TYPES:
        return value
    if isinstance(value, Chunk):
        return {str(key): item if item is None or type(item) in PLAIN_TYPES else traceable(item) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [traceable(item) for item in cast("list[Any]", value)]
    if isinstance(value, Model):
        return f"<{value._path}>"  # pyright: ignore[reportPrivateUsage]
    if callable(value):
        return f"<{getattr(value, '__qualname__', type(value).__name__)}>"
    text = repr(value)
    return f"<{type(value).__name__}>" if " at 0x" in text else text


def set_with_properties(model: Model, key: str, value: Any) -> None:
    """Sets an attribute of a model whose class has properties that can be set."""
    if key in model._setters:  # pyright: ignore[reportPrivateUsage]
        object.__setattr__(model, key, value)
    else:
        Model.__setattr__(model, key, value)


def has_setter(member: object) -> bool:
    """Tells whether a class's attribute takes care of being set, as properties do."""
    return hasattr(type(member), "__set__")


def class_members(kind: type) -> tuple[dict[str, Method], dict[str, Any]]:
    """Returns what a class and its ancestors below Model bring, in alphabetical order: methods, and other objects.

    Names that begin with `_` and properties are left out, and so is what Model itself defines.
    """
    found: dict[str, Any] = {}
    for klass in reversed(kind.__mro__):
        if klass is not object and klass is not Model:
            found.update(vars(klass))
    methods: dict[str, Method] = {}
    objects: dict[str, Any] = {}
    for name in sorted(found):
        member = found[name]
        if name[0] == "_" or name in RESERVED:
            continue
        if inspect.isfunction(member):
            methods[name] = member
        elif isinstance(member, type) and issubclass(member, Model):
            objects[name] = member()
        elif not isinstance(member, (property, staticmethod, classmethod)) and not has_setter(cast("object", member)):
            objects[name] = member
    return methods, objects


def written_for_python_actr(kind: type) -> bool:
    """Tells whether a class is part of a program that imports python_actr or ccm by name."""
    files = [sys.modules.get(klass.__module__) for klass in kind.__mro__]
    return logs.LOG.announce or any(for_python_actr(vars(file)) for file in files if file is not None)


RESERVED = frozenset({"run", "now", "get_children", "traced", "explain"})
"""What a subclass may override, but not turn into something that is waited for or copied."""


def copy_objects(objects: dict[str, Any]) -> dict[str, Any]:
    """Copies a class's objects for one instance; what cannot be copied (an open file, a running model) is shared."""
    memo: dict[int, Any] = {id(obj): obj for obj in objects.values() if isinstance(obj, ModuleType)}
    copies: dict[str, Any] = {}
    for name, obj in objects.items():
        if type(obj) in PLAIN_TYPES or obj is None:
            copies[name] = obj
        elif isinstance(obj, Model) and obj._is_converted():  # pyright: ignore[reportPrivateUsage]
            copies[name] = memo[id(obj)] = obj
        else:
            try:
                copies[name] = copy.deepcopy(obj, memo)
            except TypeError:
                copies[name] = obj
    return copies
