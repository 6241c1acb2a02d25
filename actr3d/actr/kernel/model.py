"""Model: the class of everything in a simulation; it has a place in a tree, a clock, and methods that others can wait for."""

from __future__ import annotations

import inspect
import random
import sys
from collections.abc import Callable, Generator, Iterable
from types import CodeType, MethodType
from typing import Any, Protocol
from weakref import ref

from actr3d.actr.chunks.chunk import IMMUTABLE_TYPES, PLAIN_TYPES, PlaceName
from actr3d.actr.kernel import log as logs
from actr3d.actr.kernel.class_members import (
    Method,
    check_methods,
    check_names,
    class_members,
    copy_objects,
    has_setter,
    with_property_setters,
)
from actr3d.actr.kernel.events import Event, Trigger
from actr3d.actr.kernel.hooks import hook
from actr3d.actr.kernel.profile import PROFILES, PYTHON_ACTR, Profile
from actr3d.actr.kernel.run_limits import EndOfRun, RunLimits, fresh_seed
from actr3d.actr.kernel.scheduler import Scheduler
from actr3d.actr.kernel.source_code import written_for_python_actr
from actr3d.actr.kernel.tracing import UNWATCHED, traceable
from actr3d.actr.kernel.tree import TreeNode, forget_place, keep_path, lineage, note_move, path_of, subtree, top_of
from actr3d.clock import seconds
from actr3d.errors import SchedulerError, did_you_mean, hint_for
from actr3d.trace import Trace, TraceEvent, run_of, top_path, with_number
from actr3d.values import COLLECTIONS
from actr3d.warnings import locate, warn_modeller

BEFORE_FIRST_RUN: list[Callable[[Model], object]] = []
"""Called with a top model that is about to run for the first time; `actr3d.actr` adds the checks of models here."""


class Model(TreeNode):
    """A part of a simulation: an agent, one of its modules, an object of its environment, or the environment.

    Class attributes become each instance's own: models among them become children, and methods can be waited for.
    A model joins a tree when it is set as an attribute of another model. It is converted (given a clock, its children and its
    methods) when that tree is first run or changed.

    Args:
        log: True for the text log, or another log.
        attrs: Become attributes.
    """

    name = "top"
    _converted = False
    _convert_methods = True
    _auto_run_start = True
    _init_log: Any = None
    _profile: Profile | None = None
    """See `chosen_profile`."""
    _setters: frozenset[str] = frozenset()
    """The attributes that the class's own properties set."""
    _slots: frozenset[str] = frozenset()
    """Slots that a library's class gives to chunks: productions may test them although the model's text never sets them."""

    # Given to every instance when it is converted.
    changes: Trigger
    sch: Scheduler
    log: Any
    random: random.Random
    parent: Model | None

    # Given by the modeller.
    profile: Any
    """The name of the profile for the agent, or for all agents of an environment."""

    def __init__(self, log: Any = None, **attrs: Any) -> None:
        self._init_log = log
        for key, value in attrs.items():
            setattr(self, key, value)

    def __getitem__(self, item: str) -> Any:
        return getattr(self, item)

    def __repr__(self) -> str:
        return f"<{type(self).__name__} {self._path}>"

    # -- conversion

    # Modules of existing models call these two, which python_actr has under the same names.
    def _ensure_converted(self) -> None:
        ensure_converted(self)

    def _is_converted(self) -> bool:
        return self._converted

    def _convert(self, parent: Model | None = None) -> None:
        """Sets the tree's clock for the model, its own copies of its class's attributes, and its methods."""
        own = self.__dict__
        own["_converted"] = True
        own["changes"] = Trigger("changes")
        if "name" not in own:
            _name_part(self, type(self).name)
        parent = own.get("parent") or parent
        methods, objects = class_members(type(self), Model)
        check_names(type(self), {**objects, **methods})
        objects = copy_objects(objects, lambda obj: isinstance(obj, Model) and is_converted(obj))
        if parent is not None:
            ensure_converted(parent)
            own["sch"], own["log"], own["random"], own["parent"] = parent.sch, logs.dummy, parent.random, parent
        else:
            self._become_top()
        self._follow(parent)
        self._convert_info(objects, methods)
        for name, obj in objects.items():
            if isinstance(obj, Model):
                if type(obj) is not Model or "name" not in obj.__dict__:
                    _name_part(obj, name)
                ensure_converted(obj, self)
                self._adopt(name, obj)
            if name in own and name not in UNWATCHED:
                self._warn_of_loss(name, own[name], obj)
            own[name] = obj
        if self._convert_methods:
            for name, func in methods.items():
                if name in own:
                    self._warn_of_replacement(name, own[name])
                wrapper = GeneratorWrapper if inspect.isgeneratorfunction(func) else MethodWrapper
                own[name] = wrapper(self, func, name)
        if self._auto_run_start:
            self.start()
        for key, value in list(own.items()):
            if key[0] != "_" and key != "parent" and isinstance(value, Model) and not is_converted(value):
                self._take_in(key, value, overlooked=not self.sch.queue.first_come)
        limits = RunLimits.current()
        if parent is None and limits is not None and limits.trace is not None:
            attach_trace(self, limits.trace)

    def _warn_of_loss(self, name: str, before: Any, after: Any) -> None:
        """Warns that a value set on the model is lost because its class sets another; defaults of parameters are not reported."""
        if type(before) in PLAIN_TYPES and before == after:
            return
        if not any(name in inspect.signature(kind.__init__).parameters for kind in type(self).__mro__[:-1]):
            warn_modeller(
                f"{type(self).__name__}.{name} was set to {traceable(before)!r}, but becomes {traceable(after)!r}, as its class says, "
                "when the model starts; set it when it has started, or leave it out of the class"
            )

    def _warn_of_replacement(self, name: str, before: Any) -> None:
        """Warns that a value set on the model is lost because its class has a method of that name."""
        warn_modeller(
            f"{type(self).__name__}.{name} was set to {traceable(before)!r}, but becomes the method '{name}' of its class when the model "
            "starts; use another name"
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

    def _follow(self, parent: Model | None) -> None:
        """Uses the parent's profile unless the model has its own; subclasses may extend this."""
        if self._profile is None and parent is not None:
            self.__dict__["_profile"] = chosen_profile(parent)
            if profile_of(parent).whole_milliseconds:
                self.sch.round_ms = True

    def _convert_info(self, objects: dict[str, Any], methods: dict[str, Method]) -> None:
        """Processes the class's attributes before its objects are converted; for subclasses."""
        own = self.__dict__
        wanted = own.get("profile") or objects.get("profile")
        if isinstance(wanted, str):  # an environment's, for all its agents, unless the word means something else to the modeller
            if wanted in PROFILES:
                own["_profile"] = PROFILES[wanted]
            elif hint := did_you_mean(wanted, PROFILES):
                warn_modeller(f"{type(self).__name__}.profile: no profile {wanted!r}{hint}")

    # -- the tree

    def _adopt(self, name: str, child: Model) -> None:
        self.__dict__.setdefault("_children", {})[name] = child

    def _leave(self, parent: Model) -> None:
        """Removes the model from its parent's children; a trace uses its old path until it has a new one."""
        keep_path(self)
        siblings = parent.__dict__.get("_children", {})
        if parent.__dict__.get("_overlooked") is self:
            del parent.__dict__["_overlooked"]
        for name in [name for name, part in siblings.items() if part is self]:
            del siblings[name]
            if is_converted(parent):
                _trace_member(parent, "removed", name, self)

    def _take_in(self, key: str, value: Model, *, overlooked: bool = False) -> bool:
        """Makes a model that was set as an attribute a child, unless it has a parent or is an ancestor; returns whether it did.

        Args:
            key: The attribute's name.
            value: The model.
            overlooked: Whether `get_children` leaves it out, and a chunk made from it does not contain the attribute's name.
        """
        if value.__dict__.get("parent") is not None or any(above is value for above in lineage(self)):
            return False
        separate = is_converted(value) and value.sch is not self.sch
        run = {"was": path_of(value)} if separate and value.sch.trace is self.sch.trace else {}
        replaced = self.__dict__.get("_children", {}).get(key)
        note_move(value, self.sch.traces, self.sch.now_us)
        value.parent = self
        if not overlooked:
            _name_part(value, key, shown=type(value) is Model)
        elif "name" not in value.__dict__:
            _name_part(value, key)
        self._adopt(key, value)
        if overlooked:
            self.__dict__["_overlooked"] = value
        forget_place(value)
        if replaced is not None:
            _trace_member(self, "removed", key, replaced)
        _trace_member(self, "added", key, value, **run)
        if not is_converted(value):
            ensure_converted(value, self)
        else:
            if separate:
                self._merge_run(value)
            for part in subtree(value):
                # Private, as everything that subclasses extend but productions must not see.
                part._follow(part.parent)
        return True

    def _merge_run(self, other: Model) -> None:
        """Moves a tree that was converted on its own (a model that builds its parts in `__init__`) to this model's clock."""
        if other.sch.now_us != 0:
            raise SchedulerError(f"'{other.name}' ran on its own until {other.sch.time:g} s; add it to its environment before it runs")
        sch, trace = self.sch, other.sch.trace
        sch.take_over(other.sch)
        for part in subtree(other):
            part.__dict__["sch"], part.__dict__["random"] = sch, self.random
        if trace is not None and sch.trace is None:
            attach_trace(top_of(other), trace)

    def _line_changes(self) -> tuple[Trigger, ...]:
        """Returns the triggers that fire when this model changes: its own, and those of its ancestors."""
        known = self.__dict__.get("_known_line_changes")
        if known is None:
            known = self.__dict__["_known_line_changes"] = tuple([part.changes for part in lineage(self)])
        return known

    # -- changes

    def __init_subclass__(cls, **options: Any) -> None:
        super().__init_subclass__(**options)
        check_methods(cls)
        setters = {name for name, member in vars(cls).items() if has_setter(member)}
        if setters:
            cls._setters = cls._setters | setters
            if "__setattr__" not in vars(cls) and cls.__setattr__.__name__ != "set_with_properties":
                type.__setattr__(cls, "__setattr__", with_property_setters(cls.__setattr__))

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
                    self._report(key, value)

    def _report(self, key: str, value: Any) -> None:
        """Reports a change to the trace and the log."""
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
                note_move(self, value.sch.traces, value.sch.now_us)
            forget_place(self, keep_path=value is None)
        if isinstance(value, Model) and key != "parent":
            ensure_converted(self)
            joins = self._take_in(key, value)
        if self._converted and key not in UNWATCHED:
            for changes in own.get("_known_line_changes") or self._line_changes():
                if changes.waiting:
                    self.sch.wake(changes, -1)
            trace = self.sch.trace
            if joins and trace is not None and isinstance(value, Model):
                _trace_states(value, trace)
            self._report(key, value)
        if key == "log" and value is not None:
            for name, known in list(own.items()):
                if name[0] != "_" and name not in UNWATCHED and isinstance(known, (int, str, float, type(None))):
                    setattr(value, name, known)

    # -- what a trace receives

    def emit(self, kind: str, **data: Any) -> None:
        """Records an event of this part in the trace, if there is one that records everything.

        Args:
            kind: The kind of event. It need not be registered; `actr3d.trace_kinds.trace_kind` adds its meaning, and its text on pages.
            data: Its data; what is neither a plain value nor a list or dict of these is recorded by its name.
        """
        trace = self.sch.trace
        if trace is not None and trace.all:
            trace.emit(self.sch.now_us, self._path, kind, {key: traceable(value) for key, value in data.items()})

    def _trace_state(self, trace: Trace) -> None:
        """Records the current value of every attribute, so that a trace that starts late is complete from its start."""
        if trace.all:
            trace.emit(self.sch.now_us, self._path, "state", self._state())

    def _state(self) -> dict[str, Any]:
        """Returns the attributes that describe the part; lists and dicts of the library's own modules are internal and left out."""
        own = {key: value for key, value in self.__dict__.items() if key[0] != "_" and key not in UNWATCHED}
        lists = () if type(self).__module__.startswith("actr3d.actr.") else COLLECTIONS
        return {k: traceable(v) for k, v in own.items() if type(v) in IMMUTABLE_TYPES or issubclass(type(v), lists)}

    def _trace_request(self, call: str, **particulars: Any) -> None:
        """Records a request to this module."""
        trace = self.sch.trace
        if trace is not None and trace.all:
            data = {"call": call, **{key: traceable(value) for key, value in particulars.items()}}
            trace.emit(self.sch.now_us, self._path, "request", data)

    def _trace_change(self, trace: Trace, key: str, value: Any) -> None:
        """Records one attribute's new value."""
        if not trace.all:
            return
        if type(value) in IMMUTABLE_TYPES:
            trace.emit(self.sch.now_us, self._path, "state", {key: value})
        elif self.__dict__.get("_children", {}).get(key) is not value:  # an «added» event reports a part that has joined
            trace.emit(self.sch.now_us, self._path, "state", {key: traceable(value)})

    # -- running

    def traced(self, level: str = "all", *, keep: bool = True) -> Trace:
        """Starts a trace of the whole run this model belongs to, and returns it.

        It begins with the current state of everything; it does not know what was before. Traces of the run that have begun before,
        such as that of a recorded program, go on.

        Args:
            level: How much to record; see `actr3d.trace.LEVELS`.
            keep: Whether it keeps its events; otherwise it only passes them to its listeners.

        Raises:
            ParameterError: If the level is unknown.
        """
        ensure_converted(self)
        trace = Trace(level, keep)
        attach_trace(top_of(self), trace)
        return trace

    @hook
    def start(self) -> Any:
        """Is called when the model is converted; a generator here runs from time 0. For subclasses."""

    def run(self, limit: float | None = None, func: Callable[[], Any] | None = None) -> None:
        """Runs the whole tree until nothing is left to do, `stop` is called, or `limit` more seconds have passed.

        Args:
            limit: How long [s from now]. The clock counts whole microseconds, so a run ends at the one nearest to its
                exact end, and the next run continues from there: `run(1/3)` ends at 0.333333, 0.666667 and 1 s. Repeated
                calls therefore never drift.
            func: A function that is scheduled at the current time before the run starts; events of the same priority that are already
                queued for that time come first.

        Raises:
            SchedulerError: If there is an endless loop in which no time passes, or something cannot be waited for; if it is part of a
                simulation, which alone runs its agents.
            Exception: What a listener of the trace has raised.
        """
        if not self._converted:
            ensure_converted(self)
            for prepare in BEFORE_FIRST_RUN:
                prepare(self)
        sch = self.sch
        if sch.in_lockstep:
            raise SchedulerError(
                f"'{self.name}' is part of a simulation, which runs its agents in lockstep with their bodies: call run of the Simulation; "
                "to let time pass in an agent, yield a number of seconds"
            )
        if func is not None:
            sch.add(func)
        if sch.trace is None:
            sch.run(limit)
            if sch.trace is not None and not sch.running:  # the trace began during the run
                sch.trace.raise_failures()
        else:
            self._run_traced(limit)

    def _run_traced(self, limit: float | None) -> None:
        """Runs the tree and records its start, its end and the reason for it; raises what a listener has raised meanwhile."""
        sch = self.sch
        outermost, failed = not sch.running, None
        _trace_top(self, "run", {"limit": traceable(limit)})
        try:
            if outermost and sch.trace is not None:
                sch.trace.raise_failures()
            sch.run(limit)
        except BaseException as error:
            failed = error
            raise
        finally:
            _trace_top(self, "stop", _end_of_run(sch, failed))
        if outermost and sch.trace is not None:
            sch.trace.raise_failures()

    def stop(self) -> None:
        """Ends the run after the current event."""
        ensure_converted(self)
        self.sch.stop()

    def now(self) -> float:
        """Returns the current time [s]."""
        ensure_converted(self)
        return self.sch.now_us / 1_000_000


# What the rest of the library asks of a model. These are functions that call private methods, because productions see every public
# name of a model; the private methods are those that subclasses extend.


def is_converted(model: object) -> bool:
    """Returns whether a model has been converted: it has a clock, and its class's attributes have become its own."""
    return "_converted" in model.__dict__


def ensure_converted(model: Model, parent: Model | None = None) -> None:
    """Converts a model, as a child of `parent` if given, unless it has been converted before."""
    if not is_converted(model):
        model._convert(parent)  # pyright: ignore[reportPrivateUsage] # productions see every public name of a model


def chosen_profile(model: Model) -> Profile | None:
    """Returns the profile that a model, or one above it, has chosen; None if none has."""
    return model._profile  # pyright: ignore[reportPrivateUsage] # productions see every public name of a model


def profile_of(model: Model) -> Profile:
    """Returns the profile of a model."""
    return model._profile or PYTHON_ACTR  # pyright: ignore[reportPrivateUsage] # productions see every public name of a model


def state_of(model: Model) -> dict[str, Any]:
    """Returns the attributes that describe a model, as a trace keeps them."""
    return model._state()  # pyright: ignore[reportPrivateUsage] # productions see every public name of a model


def _name_part(part: Model, name: str, shown: bool = False) -> None:
    """Names a model after its place in the tree.

    Args:
        part: The model.
        name: The attribute's name.
        shown: Whether a chunk made of the model has the name too; python_actr 1.9.5 calls objects of classes derived from
            Model «top» there, and those of Model itself by the name under which they join a running tree.
    """
    slot = name if shown or is_converted(part) else None if type(part) is Model else "top"
    part.__dict__["name"] = PlaceName(name, slot)


# -- methods that others can wait for


class Caller(Protocol):
    """A production that calls a method."""

    name: str

    @property
    def place(self) -> str:
        """Where it is written: `file:line`."""
        ...


class MethodWrapper:
    """A method of one model; `yield model.method` waits for the end of its next call."""

    def __init__(self, obj: Model, func: Method, name: str) -> None:
        self.obj = obj
        self.func = func
        self._method = MethodType(func, obj)
        self.__name__ = name
        self._begins: Trigger | None = None
        self._ends: Trigger | None = None

    @property
    def begins(self) -> Trigger:
        """Wakes what waits for the beginning of a call. Few methods are waited for: triggers are made when they are needed."""
        if self._begins is None:
            self._begins = Trigger(f"{self.__name__} begin")
        return self._begins

    @property
    def ends(self) -> Trigger:
        """Wakes what waits for the end of a call."""
        if self._ends is None:
            self._ends = Trigger(f"{self.__name__} end")
        return self._ends

    @property
    def default_trigger(self) -> Trigger:
        """The trigger that `yield model.method` waits for."""
        return self.ends

    @property
    def _profile(self) -> Profile | None:
        return self.obj.__dict__.get("_profile")

    def __call__(self, *args: Any, **keys: Any) -> Any:
        self._wake(self._begins)
        value = self._method(*args, **keys)
        self._wake(self._ends)
        return value

    def _wake(self, trigger: Trigger | None) -> None:
        if trigger is not None and trigger.waiting:
            self.obj.sch.trigger(trigger)

    def __repr__(self) -> str:
        return f"<method {self.func.__qualname__}>"


class GeneratorWrapper(MethodWrapper):
    """A generator method of one model: a call schedules it and returns the event, which can be waited for."""

    def __call__(self, *args: Any, **keys: Any) -> Event:
        sch = self.obj.sch
        method = self.func(self.obj, *args, **keys)  # wrong arguments are an error of the calling line
        frame = sys._getframe(1)  # pyright: ignore[reportPrivateUsage] # Python documents it
        return sch.begin(self._steps(method, sch.firing, frame.f_code, frame.f_lasti, sch.now_us), self)

    def _steps(
        self, method: Iterable[Any], caller: Caller | None, code: CodeType, instruction: int, called_us: int
    ) -> Generator[Any, Any, None]:
        """Runs the method and fires its triggers; an error in it names its caller, the place of the call, which is an instruction of some
        code, and its time [us]."""
        self._wake(self._begins)
        try:
            yield from method
        except Exception as error:
            if caller is not None:
                line = next(line for start, end, line in code.co_lines() if start <= instruction < end)
                locate(error, code.co_filename, line or code.co_firstlineno)
                error.add_note(
                    f"in '{self.__name__}' at {self.obj.now():g} s, called by production '{caller.name}' ({caller.place}) "
                    f"at {seconds(called_us):g} s{hint_for(error, self.func.__globals__)}"
                )
            raise
        self._wake(self._ends)


# -- the trace of a run


class TracedRun:
    """A run as its trace refers to it, without keeping the model alive.

    Args:
        top: Its top model.
    """

    def __init__(self, top: Model) -> None:
        self._top = ref(top)

    @property
    def model(self) -> Model | None:
        """The top model; None if it no longer exists."""
        return self._top()

    def now_us(self) -> int | None:
        """Returns the current time [us]; None if the model no longer exists, or has become part of another."""
        top = self._top()
        return None if top is None or top.parent is not None else top.sch.now_us

    def emit_state(self, trace: Trace) -> None:
        """Records the current state of everything in a trace."""
        top = self._top()
        if top is not None:
            _trace_opening(top, trace)

    def stop(self) -> None:
        """Ends the run after the current event."""
        top = self._top()
        if top is not None:
            top.sch.stop()


class FollowedRun(TracedRun):
    """A run of another trace, whose events this trace receives, too.

    Args:
        top: Its top model.
        first: The trace that records it first.
        trace: This trace.
    """

    def __init__(self, top: Model, first: Trace, trace: Trace) -> None:
        super().__init__(top)
        self._first = first
        self._trace = trace
        self._number = trace.begin(self)
        self.emit_state(trace)
        first.feed(self._take, trace.level)

    def _take(self, event: TraceEvent) -> None:
        """Passes on an event of the run; not the output of a program, which its own runner traces."""
        top = self.model
        if top is None:
            self._first.ignore(self._take)
        elif event.kind != "output" and event.run == run_of(path_of(top)):
            self._first.pass_on(with_number(event, self._number), self._trace)

    def emit_state(self, trace: Trace) -> None:
        named = Trace(trace.level, keep=False)
        named.feed(lambda event: trace.emit(*with_number(event, self._number)), trace.level)
        super().emit_state(named)


def attach_trace(top: Model, trace: Trace) -> None:
    """Connects the run of a top model to a trace, besides those that record it already."""
    traces = top.sch.traces
    if traces:
        FollowedRun(top, traces[0], trace)
    else:
        forget_place(top)
        top.__dict__["_top_path"] = top_path(trace.begin(TracedRun(top)))
        top.sch.trace = trace
        _trace_opening(top, trace)
    traces.append(trace)


def _trace_opening(top: Model, trace: Trace) -> None:
    if trace.production:
        data = {"model": type(top).__name__, "seed": top.sch.seed, "profile": profile_of(top).name}
        trace.emit(top.sch.now_us, path_of(top), "start", data)
    _trace_states(top, trace)


def _trace_states(top: Model, trace: Trace) -> None:
    """Records the current state of a part and of everything below it."""
    for part in subtree(top):
        part._trace_state(trace)  # private, because productions see every public name of a model


def _trace_top(model: Model, kind: str, data: dict[str, Any]) -> None:
    """Records an event of the whole run."""
    trace = model.sch.trace
    if trace is not None and trace.all:
        trace.emit(model.sch.now_us, path_of(top_of(model)), kind, data)


def _trace_member(model: Model, kind: str, name: str, part: Model, **particulars: Any) -> None:
    """Records that a part joins a model under a name, or leaves it."""
    trace = model.sch.trace
    if trace is not None and trace.all:
        trace.emit(model.sch.now_us, path_of(model), kind, {"part": name, "model": type(part).__name__, **particulars})


def _end_of_run(sch: Scheduler, failed: BaseException | None) -> dict[str, Any]:
    """Returns why a run has ended."""
    if failed is None:
        return {"by": sch.ended_by}
    if not isinstance(failed, EndOfRun):
        return {"by": "error", "error": type(failed).__name__}
    ended = sch.limits is not None and sch.limits.ended
    return {"by": "until" if ended else "stop" if sch.stop_flag else "done"}
