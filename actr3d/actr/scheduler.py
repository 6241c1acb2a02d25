"""Runs what is to happen: plain calls, generators that wait, and triggers that wake them."""

from __future__ import annotations

import copy
import warnings
from collections import deque
from collections.abc import Callable, Mapping, Sequence
from inspect import isgeneratorfunction
from types import GeneratorType
from typing import Any, cast

from actr3d.actr import logger
from actr3d.actr.limits import RunLimits
from actr3d.clock import MICROSECONDS, EventQueue, microseconds, seconds
from actr3d.errors import ModelWarning, SchedulerError
from actr3d.trace import Trace

NEVER = 1 << 62
"""A time that does not come [us]."""
STANDSTILL = 1_000_000
"""So many events without any time passing are an endless loop, not a model."""


FAR = 1e12
"""Delays up to here [s] need no further look."""


class Trigger:
    """Something that generators can wait for (`yield trigger`)."""

    __slots__ = ("name", "waiting")

    def __init__(self, name: str = "") -> None:
        self.name = name
        self.waiting: list[Event] = []

    def __repr__(self) -> str:
        return f"<Trigger '{self.name}'>"

    def __deepcopy__(self, memo: dict[int, Any]) -> Trigger:
        return Trigger(self.name)


class Event:
    """A call that will be made, or a generator that goes on, at a time or when a trigger says so."""

    __slots__ = ("args", "call", "cancelled", "done", "generator", "group", "keys", "parents", "priority")

    def __init__(
        self,
        call: Callable[..., Any],
        args: Sequence[Any] = (),
        keys: Mapping[str, Any] | None = None,
        priority: float = 0,
    ) -> None:
        self.call = call
        self.args = args
        self.keys: Mapping[str, Any] = keys or {}
        self.priority = priority
        self.group: Sequence[Event] = ()
        self.cancelled = False
        self.done = False
        self.parents: list[Event] = []
        self.generator: GeneratorType[Any, Any, Any] | None = None
        if isgeneratorfunction(call) or isgeneratorfunction(getattr(type(call), "__call__", None)):
            self.generator = call(*args, **self.keys)

    def __repr__(self) -> str:
        return f"<Event {self.describe()}>"

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
        code = self.generator.gi_code
        frame = self.generator.gi_frame
        return f"{code.co_qualname} ({code.co_filename}:{frame.f_lineno if frame else code.co_firstlineno})"


class Scheduler:
    """The clock and the event queue of one run; all models below one top model share it."""

    def __init__(self) -> None:
        self.queue: EventQueue[Event] = EventQueue()
        self.now_us = 0
        self.bound: dict[str, Any] | None = None
        """What the production that fired last had bound; `?name` in a chunk's text means these."""
        self.trace: Trace | None = None
        self.seed: int | str | None = None
        """What the run's random numbers were made from; None where the modeller gave a generator of their own."""
        self.stop_flag = False
        self.round_ms = False
        """Whether there are models whose events happen at whole milliseconds, as in ACT-R 7."""
        self.harvests = False
        """Whether there are memories that take in what leaves buffers, as in ACT-R 7."""
        self.limits: RunLimits | None = RunLimits.current()
        if self.limits is not None:
            self.limits.clock = lambda: self.now_us
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
        event = Event(func, args, keys, priority)
        self.queue.push(self.after(delay, event), event, priority)
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

    def stop(self) -> None:
        """Ends the run once the present event is over."""
        self.stop_flag = True

    def run(self, duration: float | None = None) -> None:
        """Runs until nothing is left to do, `stop` is called, or `duration` seconds have passed.

        Events at exactly the end belong to this run. After a run that was not stopped the clock stands at its end.

        Raises:
            SchedulerError: If time stands still for a million events, or something cannot be waited for.
        """
        until = None if duration is None else self.after(duration)
        bound = self.limits.clip(self.now_us) if self.limits is not None else None
        if bound is not None:
            until = bound if until is None else min(until, bound)
        self.stop_flag = False
        heap = self.queue.heap
        if until is not None and (not heap or heap[0][0] > until) and not self._incoming:
            self._advance(until)
            return
        self._run_events(until)
        if until is not None and not self.stop_flag and until > self.now_us:
            self._advance(until)

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
                    )
            event = queue.pop()
            if event.cancelled:
                continue
            if event.group:
                for other in event.group:
                    other.cancelled = other is not event
                event.group = ()
            generator = event.generator
            if generator is None:
                self._wait(event, event.call(*event.args, **event.keys))
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
        return not (heap and heap[0][0] <= self.now_us) and not self.stop_flag and not self._incoming

    def _advance(self, time: int) -> None:
        self.now_us = time
        logger.LOG.time = time / MICROSECONDS

    def _finish(self, event: Event) -> None:
        event.done = True
        for parent in event.parents:
            self.queue.push(self.now_us, parent, parent.priority)
        event.parents = []

    def _wait(self, event: Event, result: Any) -> None:
        """Puts an event where what it yielded says: later, on a trigger, behind another event, or on the first of several."""
        if isinstance(result, (int, float)):
            self.queue.push(self.after(result, event), event, event.priority)
        elif isinstance(result, dict):
            how = cast("dict[str, float]", result)
            event.priority = how.get("priority", event.priority)
            self.queue.push(self.after(how.get("delay", 0), event), event, event.priority)
        elif isinstance(result, Trigger):
            result.waiting.append(event)
        elif isinstance(result, str):
            self._named.setdefault(result, Trigger(result)).waiting.append(event)
        elif isinstance(result, (list, tuple)):
            choices = cast("Sequence[Any]", result)
            events = [copy.copy(event) for _ in choices]
            for choice, alternative in zip(choices, events, strict=True):
                alternative.group = events
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
        else:
            raise SchedulerError(
                f"{event.describe()}: cannot wait for {result!r}; yield a number of seconds, a trigger or its name, a method, "
                "the event of a called generator method, or a tuple of these"
            )

    def _warn_of_none(self, event: Event) -> None:
        generator = event.generator
        frame = generator.gi_frame if generator is not None else None
        if frame is not None:
            warnings.warn_explicit(
                f"{frame.f_code.co_qualname} yields None, which ends it here: what it calls may not be a generator, "
                "or a number of seconds is missing",
                ModelWarning,
                frame.f_code.co_filename,
                frame.f_lineno,
            )
