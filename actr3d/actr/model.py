"""Model: the part everything is made of; it has a place in a tree, a clock, and methods that can be waited for."""

from __future__ import annotations

import inspect
import random
import sys
from collections.abc import Callable
from typing import Any, TypeVar

from actr3d.actr import logger as logs
from actr3d.actr.chunk import PLAIN_TYPES, PlaceName
from actr3d.actr.events import Trigger
from actr3d.actr.joining import Joining
from actr3d.actr.limits import RunLimits, fresh_seed
from actr3d.actr.members import check_names, class_members, copy_objects, has_setter, minding_properties
from actr3d.actr.methods import GeneratorWrapper, Method, MethodWrapper
from actr3d.actr.profile import PROFILES, Profile
from actr3d.actr.scheduler import Scheduler
from actr3d.actr.sources import for_python_actr
from actr3d.actr.traced import UNWATCHED, traceable
from actr3d.saying import warn_modeller
from actr3d.trace import Trace

Option = TypeVar("Option")


def pick(numbers: random.Random, options: list[Option]) -> Option:
    """Draws one of several; where there is only one, it uses up random numbers just as a choice among one does."""
    if len(options) > 1:
        return numbers.choice(options)
    while numbers.getrandbits(1):
        pass
    return options[0]


class Model(Joining):
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

    def _convert(self, parent: Model | None = None) -> None:
        """Brings the model to life: gives it the tree's clock, its own copies of its class's attributes, its methods."""
        own = self.__dict__
        own["_converted"] = True
        own["changes"] = Trigger("changes")
        if "name" not in own:
            self._call(type(self).name)
        parent = own.get("parent") or parent
        methods, objects = class_members(type(self), Model)
        check_names(type(self), {**objects, **methods})
        objects = copy_objects(objects, lambda obj: isinstance(obj, Model) and obj._converted)
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
                self._take_in(key, value, overlooked=not self.sch.queue.first_come)
        limits = RunLimits.current()
        if parent is None and limits is not None and limits.trace is not None:
            self._attach_trace(limits.trace)

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
        seed = sch.seed = fresh_seed() if limits is None else limits.next_seed()
        own["random"] = random.Random(seed)
        own["parent"] = None

    def _follow(self, profile: Profile | None) -> None:
        """Goes by the numbers of its parent, unless it has been given its own; for subclasses to act upon."""
        if self._profile is None:
            self.__dict__["_profile"] = profile
            if profile is not None and profile.whole_milliseconds:
                self.sch.round_ms = True

    def _convert_info(self, objects: dict[str, Any], methods: dict[str, Method]) -> None:
        """Looks at what the class brings, before its objects come to life; for subclasses."""
        own = self.__dict__
        wanted = own.get("profile") or objects.get("profile")
        if isinstance(wanted, str) and wanted in PROFILES:  # an environment's, for all its agents
            own["_profile"] = PROFILES[wanted]

    def _call(self, name: str, shown: bool = False) -> None:
        """Names the model after its place in the tree.

        Args:
            name: The attribute's name.
            shown: Whether a chunk made of the model has the name too; python_actr 1.9.5 calls objects of classes of
                their own «top» there, and those of Model itself by the name under which they join a running tree.
        """
        slot = name if shown or self._converted else None if type(self) is Model else "top"
        self.__dict__["name"] = PlaceName(name, slot)

    def _call_joined(self, name: str) -> None:
        """Names a model that joins a tree by being set as an attribute."""
        self._call(name, shown=type(self) is Model)

    # -- changes

    def __init_subclass__(cls, **options: Any) -> None:
        super().__init_subclass__(**options)
        setters = {name for name, member in vars(cls).items() if has_setter(member)}
        if setters:
            cls._setters = cls._setters | setters
            if "__setattr__" not in vars(cls) and cls.__setattr__.__name__ != "set_with_properties":
                type.__setattr__(cls, "__setattr__", minding_properties(cls.__setattr__))

    def __setattr__(self, key: str, value: Any) -> None:
        own = self.__dict__
        if key[0] == "_":
            own[key] = value
        elif key in UNWATCHED or isinstance(value, Model):
            self._set_in_tree(key, value)
        else:
            own[key] = value
            if "_converted" in own:
                for changes in own.get("_known_line_changes") or self._line_changes():
                    if changes.waiting:
                        own["sch"].wake(changes, -1)
                if own["sch"].trace is not None or own["log"] is not logs.dummy:
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
            self._leave(own["parent"])
        own[key] = value
        joins = False
        if key == "parent":
            if isinstance(value, Model) and "sch" in value.__dict__:
                self._note_move(value.sch)
            self._forget_place(keep_path=value is None)
        if isinstance(value, Model) and key != "parent":
            self._ensure_converted()
            joins = self._take_in(key, value)
        if self._converted and key not in UNWATCHED:
            for changes in own.get("_known_line_changes") or self._line_changes():
                if changes.waiting:
                    self.sch.wake(changes, -1)
            trace = self.sch.trace
            if joins and trace is not None and isinstance(value, Model):
                value._trace_states(trace)
            self._record(key, value)
        if key == "log" and value is not None:
            for name, known in list(own.items()):
                if name[0] != "_" and name not in UNWATCHED and isinstance(known, (int, str, float, type(None))):
                    setattr(value, name, known)

    # -- running

    def traced(self, level: str = "all", *, keep: bool = True) -> Trace:
        """Starts a trace of the whole run this model belongs to, and returns it.

        It begins with what everything is like at present; what was before, it cannot tell.

        Args:
            level: How much to record; see `actr3d.trace.LEVELS`.
            keep: Whether it keeps its events; otherwise it only hands them to its listeners.

        Raises:
            ParameterError: If the level is unknown.
        """
        self._ensure_converted()
        *_, top = self._line()
        trace = Trace(level, keep)
        top._attach_trace(trace)
        return trace

    def start(self) -> Any:
        """Is called when the model comes to life; a generator here runs from time 0. For subclasses."""

    def run(self, limit: float | None = None, func: Callable[[], Any] | None = None) -> None:
        """Runs the whole tree until nothing is left to do, `stop` is called, or `limit` seconds more have passed.

        Args:
            limit: How long [s from now]. The clock knows whole microseconds, so a run ends at the one nearest to its
                exact end, and the next run goes on from there: `run(1/3)` ends at 0.333333, 0.666667 and 1 s. So calls
                can follow one another for ever without drift.
            func: Called first.

        Raises:
            SchedulerError: If time stands still, or something cannot be waited for.
            Exception: What a listener of the trace has raised.
        """
        if not self._converted:
            from actr3d.actr.checks import check_classes

            self._convert()
            check_classes(self)
        sch = self.sch
        if func is not None:
            sch.add(func)
        if sch.trace is None:
            sch.run(limit)
            if sch.trace is not None and not sch._running:  # it began in the midst of the run
                sch.trace.raise_failures()
        else:
            self._trace_run(limit)

    def stop(self) -> None:
        """Ends the run once the present event is over."""
        self._ensure_converted()
        self.sch.stop()

    def now(self) -> float:
        """Returns the present [s]."""
        self._ensure_converted()
        return self.sch.now_us / 1_000_000


def written_for_python_actr(kind: type) -> bool:
    """Tells whether a class is part of a program that imports python_actr or ccm by name."""
    files = [sys.modules.get(klass.__module__) for klass in kind.__mro__]
    return logs.LOG.announce or any(for_python_actr(vars(file)) for file in files if file is not None)
