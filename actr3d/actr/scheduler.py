"""Runs what is to happen: plain calls, generators that wait, and triggers that wake them."""

from __future__ import annotations

import copy
import warnings
from collections import deque
from collections.abc import Callable, Generator, Iterator, Mapping, Sequence
from inspect import CO_GENERATOR
from numbers import Real
from types import GeneratorType
from typing import Any, cast

from actr3d.actr.limits import RunLimits
from actr3d.actr.logger import LOG
from actr3d.clock import MICROSECONDS, EventQueue, microseconds, seconds
from actr3d.errors import ModelWarning, SchedulerError, did_you_mean
from actr3d.trace import Trace

NEVER = 1 << 62
"""A time that does not come [us]."""
STANDSTILL = 1_000_000
"""So many events without any time passing are an endless loop, not a model."""


END = -9999999
"""The priority of a run's end: everything else of that moment comes before it."""
FAR = 1e12
"""Delays up to here [s] need no further look."""


class Trigger:
    """Something that generators can wait for (`yield trigger`)."""

    __slots__ = ("_most", "name", "waiting")

    def __init__(self, name: str = "") -> None:
        self.name = name
        self.waiting: list[Event] = []
        self._most = 8

    def __repr__(self) -> str:
        return f"<Trigger '{self.name}'>"

    def add_one_of_several(self, event: Event) -> None:
        """Takes in an event that also waits elsewhere, and now and then lets those go that were woken from there."""
        if len(self.waiting) >= self._most:
            self.waiting = [other for other in self.waiting if not other.cancelled]
            self._most = max(8, 2 * len(self.waiting))
        self.waiting.append(event)

    def __deepcopy__(self, memo: dict[int, Any]) -> Trigger:
        return Trigger(self.name)


class Event:
    """A call that will be made, or a generator that goes on, at a time or when a trigger says so."""

    __slots__ = ("args", "call", "cancelled", "done", "generator", "group", "keys", "origin", "parents", "priority")

    def __init__(
        self,
        call: Callable[..., Any],
        args: Sequence[Any] = (),
        keys: Mapping[str, Any] | None = None,
        priority: float = 0,
        generator: Generator[Any, Any, Any] | None = None,
    ) -> None:
        self.call = call
        self.args = args
        self.keys: Mapping[str, Any] = keys or {}
        self.priority = priority
        self.group: Sequence[Event] = ()
        self.origin = self
        """The event as its caller knows it; another one where this waits in its place for one of several things."""
        self.cancelled = False
        self.done = False
        self.parents: list[Event] = []
        self.generator = generator

    def __repr__(self) -> str:
        return f"<Event {self.describe()}>"

    def __lt__(self, other: Event) -> bool:
        return False  # events of one time and priority are equals; the queue alone puts them in order

    def in_milliseconds(self) -> bool:
        """Tells whether the model whose method this is goes by whole milliseconds."""
        owner = getattr(self.call, "__self__", self.call)
        profile = getattr(owner, "_profile", None)
        return profile is not None and profile.whole_milliseconds

    def describe(self) -> str:
        """Names the call, and for a generator the line it stands at."""
        name = getattr(self.call, "__qualname__", None) or getattr(self.call, "__name__", repr(self.call))
        if self.generator is None:
            return str(name)
        generator = self.innermost
        assert generator is not None
        code = generator.gi_code
        frame = generator.gi_frame
        return f"{code.co_qualname} ({code.co_filename}:{frame.f_lineno if frame else code.co_firstlineno})"

    @property
    def innermost(self) -> GeneratorType[Any, Any, Any] | None:
        """The modeller's own generator: the one that `yield from` leads to."""
        generator = cast("GeneratorType[Any, Any, Any] | None", self.generator)
        while generator is not None and isinstance(inner := generator.gi_yieldfrom, GeneratorType):
            generator = cast("GeneratorType[Any, Any, Any]", inner)
        return generator


class Scheduler:
    """The clock and the event queue of one run; all models below one top model share it.

    Args:
        first_come: Whether simultaneous events of one priority happen in the order they were scheduled. Otherwise they
            happen in the order that python_actr 1.9.5 has, which depends on all events that are queued; so there must
            be the same ones, also those that do nothing.
    """

    def __init__(self, first_come: bool = True) -> None:
        self.queue: EventQueue[Event] = EventQueue(first_come)
        self.now_us = 0
        self.bound: dict[str, Any] | None = None
        """What the production that fired last had bound; `?name` in a chunk's text means these."""
        self.fired: Any = None
        """The production that fired last; errors name it."""
        self.trace: Trace | None = None
        self.seed: int | str | None = None
        """What the run's random numbers were made from; None where the modeller gave a generator of their own."""
        self.stop_flag = False
        self._run_number = 0
        self.step = 0
        """How many events have happened."""
        self.harvests = False
        """Whether there is a memory that collects what leaves buffers, as in ACT-R 7."""
        self.round_ms = False
        """Whether there are models whose events happen at whole milliseconds, as in ACT-R 7."""
        self.limits: RunLimits | None = RunLimits.current()
        if self.limits is not None:
            self.limits.clock = lambda: self.now_us
        self._running = False
        self._named: dict[str, Trigger] = {}
        self._incoming: deque[tuple[Callable[..., Any], float, Sequence[Any], Mapping[str, Any] | None, float]] = deque()

    @property
    def time(self) -> float:
        """The present [s]."""
        return seconds(self.now_us)

    def add(
        self,
        func: Callable[..., Any],
        delay: float = 0,
        args: Sequence[Any] = (),
        keys: Mapping[str, Any] | None = None,
        priority: float = 0,
        thread_safe: bool = False,
    ) -> Event | None:
        """Schedules a call, or starts a generator, `delay` seconds from now.

        Args:
            func: What to call; a generator function is run until it ends, waiting for what it yields.
            delay: When [s from now].
            args: Its arguments.
            keys: Its keyword arguments.
            priority: Among simultaneous events the higher comes first.
            thread_safe: Whether the caller is another thread; the call then waits until the running event is over.

        Raises:
            SchedulerError: If the delay is negative or not a number.
        """
        if thread_safe:
            self._incoming.append((func, delay, args, keys, priority))
            return None
        generator = func(*args, **(keys or {})) if _makes_generator(func) else None
        event = Event(func, args, keys, priority, generator)
        self.queue.push(self.after(delay, event), event, priority)
        return event

    def call_after(self, delay: float, call: Callable[..., Any], args: Sequence[Any] = ()) -> None:
        """Schedules a plain call of the library's own, which returns None."""
        event = Event(call, args)
        self.queue.push(self.after(delay, event), event)

    def begin(self, generator: Generator[Any, Any, Any], call: Callable[..., Any]) -> Event:
        """Lets a generator, which `call` has made, run from now on."""
        event = Event(call, generator=generator)
        self.queue.push(self.now_us, event)
        return event

    def after(self, delay: float, event: Event | None = None) -> int:
        """Returns the time `delay` seconds from now [us].

        Raises:
            SchedulerError: If the delay is negative or not a finite number.
        """
        kind = type(delay)
        if (kind is float or kind is int) and 0 <= delay < FAR:
            wait = round(delay * MICROSECONDS)
        else:
            what = "a delay" if event is None else f"{event.describe()}: a delay"
            wait = microseconds(delay, what)
            if wait < 0:
                raise SchedulerError(f"{what} must not be negative (got {delay!r} s)")
        if self.round_ms and wait > 0 and event is not None and event.in_milliseconds():
            return max(self.now_us, round((self.now_us + wait) / 1000) * 1000)
        return self.now_us + wait

    def trigger(self, key: Trigger | str, priority: float | None = None) -> None:
        """Wakes everything that waits for a trigger or for a name."""
        trigger = self._named.setdefault(key, Trigger(key)) if isinstance(key, str) else key
        if not trigger.waiting:
            return
        waiting, trigger.waiting = trigger.waiting, []
        for event in waiting:
            if priority is not None:
                event.priority = priority
            self.queue.push(self.now_us, event, event.priority)

    def take_waiting(self, other: Scheduler) -> None:
        """Takes over from another scheduler whoever waits there for a name, and what other threads have added."""
        for name, trigger in other._named.items():
            self._named.setdefault(name, Trigger(name)).waiting += trigger.waiting
        self._incoming += other._incoming
        other._named.clear()
        other._incoming.clear()

    def stop(self) -> None:
        """Ends the run once the present event is over."""
        self.stop_flag = True

    def run(self, duration: float | None = None) -> None:
        """Runs until nothing is left to do, `stop` is called, or `duration` seconds have passed.

        Events at exactly the end belong to this run. After a run that was not stopped the clock stands at its end.

        Raises:
            SchedulerError: If time stands still for a million events, or something cannot be waited for.
        """
        until = None
        if duration is not None:
            until = self.now_us + microseconds(duration, "the limit of a run")
            if until < self.now_us:
                raise SchedulerError(f"the limit of a run must not be negative (got {duration!r} s)")
        bound = self.limits.clip(self.now_us) if self.limits is not None else None
        if bound is not None:
            until = bound if until is None else min(until, bound)
        self.stop_flag = False
        heap = self.queue.heap
        idle = until is not None and (not heap or heap[0][0] > until) and not self._incoming
        if duration is not None and not self.queue.first_come:
            self._run_number += 1
            self.queue.push(self.now_us + round(duration * MICROSECONDS), Event(self._end, (self._run_number,)), END)
            if idle:
                self.queue.pop()
        if until is not None and idle:
            self._advance(until)
            return
        if self._running:
            warnings.warn(
                f"run was called while the model is running (at {self.time:g} s): what follows waits for its end; "
                "to let time pass, yield a number of seconds",
                ModelWarning,
                stacklevel=3,
            )
        before, self._running = self._running, True
        try:
            self._run_events(until)
        finally:
            self._running = before
        if until is not None and not self.stop_flag and until > self.now_us:
            self._advance(until)

    def _end(self, run_number: int) -> None:
        """Ends the run that asked for it; one that was stopped before leaves this without effect."""
        if run_number == self._run_number:
            self.stop_flag = True

    def _run_events(self, until: int | None) -> None:
        queue = self.queue
        heap = queue.heap
        end = NEVER if until is None else until
        still = 0
        while not self.stop_flag:
            if self._incoming:
                self._take_incoming()
            if not heap:
                break
            time = heap[0][0]
            if time > end:
                break
            if time > self.now_us:
                self._advance(time)
                still = 0
            else:
                still += 1
                if still > STANDSTILL:
                    raise SchedulerError(
                        f"time stands still at {self.time:g} s: {STANDSTILL:,} events happened without any passing; "
                        f"the last was {heap[0][3].describe()}"
                        + (f", the production that fired last '{self.fired.name}' ({self.fired.place})" if self.fired is not None else "")
                    )
            self.step += 1
            event = queue.pop()
            if event.cancelled:
                continue
            if event.group:
                for other in event.group:
                    other.cancelled = other is not event
                event.group = ()
            generator = event.generator
            if generator is None:
                result = event.call(*event.args, **event.keys)
                if result is None:
                    self._finish(event)
                else:
                    self._wait(event, result)
                continue
            try:
                result = next(generator)
            except StopIteration:
                self._finish(event)
                continue
            if type(result) is float:
                queue.push(self.after(result, event), event, event.priority)
            elif type(result) is Trigger:
                result.waiting.append(event)
            else:
                if result is None:
                    self._warn_of_none(event)
                self._wait(event, result)

    def _take_incoming(self) -> None:
        """Schedules what other threads have asked for."""
        while self._incoming:
            func, delay, args, keys, priority = self._incoming.popleft()
            self.add(func, delay, args, keys, priority)

    def idle_now(self) -> bool:
        """Tells whether nothing else is to happen before time passes, so that what comes last may come at once."""
        heap = self.queue.heap
        if not self.queue.first_come:
            return False
        return not (heap and heap[0][0] <= self.now_us) and not self.stop_flag and not self._incoming

    def _advance(self, time: int) -> None:
        self.now_us = time
        LOG.time_us = time

    def _finish(self, event: Event) -> None:
        event.done = event.origin.done = True
        for parent in event.parents:
            self.queue.push(self.now_us, parent, parent.priority)
        event.parents = []

    def _wait(self, event: Event, result: Any) -> None:
        """Puts an event where what it yielded says: later, on a trigger, behind another event, or on the first of several."""
        if isinstance(result, (int, float)):
            self.queue.push(self.after(result, event), event, event.priority)
        elif isinstance(result, dict):
            self._wait_as(event, cast("dict[str, Any]", result))
        elif isinstance(result, (Trigger, str)):
            trigger = self._named.setdefault(result, Trigger(result)) if isinstance(result, str) else result
            if event.group:
                trigger.add_one_of_several(event)
            else:
                trigger.waiting.append(event)
        elif isinstance(result, (list, tuple)):
            choices = list(_each(cast("Sequence[Any]", result)))
            if not choices:
                raise SchedulerError(f"{event.describe()}: cannot wait for {result!r}; nothing is in it")
            events = [copy.copy(event) for _ in choices]
            for alternative in events:
                alternative.group = events
            for choice, alternative in zip(choices, events, strict=True):
                self._wait(alternative, choice)
        elif result is None:
            self._finish(event)
        elif isinstance(result, Event):
            if result.done:
                self.queue.push(self.now_us, event, event.priority)
            else:
                result.parents.append(event)
        elif hasattr(result, "default_trigger"):
            self._wait(event, result.default_trigger)
        elif isinstance(result, Real):  # a number of another kind, such as numpy's
            self.queue.push(self.after(float(result), event), event, event.priority)
        else:
            raise SchedulerError(
                f"{event.describe()}: cannot wait for {result!r}; yield a number of seconds, a trigger or its name, a method, "
                "the event of a called generator method, or a tuple of these"
            )

    def _wait_as(self, event: Event, how: dict[str, Any]) -> None:
        """Puts an event where a dict says: after its `delay`, with its `priority` from now on."""
        for word in how:
            if word not in ("delay", "priority"):
                near = did_you_mean(str(word), ("delay", "priority"))
                raise SchedulerError(f"{event.describe()}: cannot wait for {how!r}: no '{word}'{near or '; use delay and priority'}")
        priority = how.get("priority", event.priority)
        if not isinstance(priority, (int, float)):
            raise SchedulerError(f"{event.describe()}: a priority must be a number (got {priority!r})")
        event.priority = priority
        self.queue.push(self.after(how.get("delay", 0), event), event, priority)

    def _warn_of_none(self, event: Event) -> None:
        generator = event.innermost
        frame = generator.gi_frame if generator is not None else None
        if frame is not None:
            warnings.warn_explicit(
                f"{frame.f_code.co_qualname} yields None, which ends it here: what it calls may not be a generator, "
                "or a number of seconds is missing",
                ModelWarning,
                frame.f_code.co_filename,
                frame.f_lineno,
            )


def _each(choices: Sequence[Any]) -> Iterator[Any]:
    """Yields what is to be waited for, also from sequences inside."""
    for choice in choices:
        if isinstance(choice, (list, tuple)):
            yield from _each(cast("Sequence[Any]", choice))
        else:
            yield choice


def _makes_generator(func: Callable[..., Any]) -> bool:
    """Tells whether a call gives a generator, also of a callable object."""
    code = getattr(func, "__code__", None) or getattr(getattr(type(func), "__call__", None), "__code__", None)  # noqa: B004 - its code is wanted, not whether there is any
    return code is not None and bool(code.co_flags & CO_GENERATOR)
