"""The clock and the event queue of a run: makes plain calls and resumes generators at their time."""

from __future__ import annotations

import copy
from collections import deque
from collections.abc import Callable, Collection, Generator, Iterator, Mapping, Sequence
from heapq import heapify, heappop
from numbers import Real
from types import CodeType
from typing import Any, ClassVar, Literal, cast

from actr3d.actr.kernel.events import AGAIN, NO_REMAINDERS, Call, Event, Trigger, makes_generator
from actr3d.actr.kernel.log import LOG
from actr3d.actr.kernel.profile import PYTHON_ACTR, Profile
from actr3d.actr.kernel.run_limits import RunLimits
from actr3d.clock import MICROSECONDS, Ends, EventQueue, microseconds, seconds
from actr3d.errors import SchedulerError, did_you_mean
from actr3d.trace import Trace
from actr3d.warnings import warn_at_frame, warn_modeller

NEVER = 1 << 62
"""A time that never comes [us]."""
STANDSTILL = 200_000
"""The number of events without any time passing that counts as an endless loop."""
END = -9999999
"""The priority of a run's end: all other events of that moment come first."""
FAR = 1e12
"""Delays up to this one [s] need no further check."""
NO_PART = 1e-9
"""A smaller fraction of a microsecond is a floating-point rounding error: 0.07 s are 70000.00000000001 us."""
MAX_REMAINDERS = 32
"""The maximum number of different delays whose rounding errors an event carries one by one; beyond it, the oldest error is included
in the current delay, so that no error is lost. A single sum of all rounding errors would be simpler, but would shift the times of
random delays by a microsecond: printed with few digits, some would then differ from python_actr's."""


class Scheduler:
    """The clock and the event queue of one run; all models below one top model share it.

    Args:
        first_come: Whether simultaneous events of one priority happen in the order they were scheduled. Otherwise they
            happen in the order of python_actr 1.9.5, which depends on all queued events; the same events must then be
            queued, including those without effect.
    """

    def __init__(self, first_come: bool = True) -> None:
        self.queue: EventQueue[Call] = EventQueue(first_come)
        self.now_us = 0
        """The current time, in whole microseconds."""
        self.remainders: Mapping[float, float] = NO_REMAINDERS
        """The rounding errors of the delays that led to the current event, by delay [us]. The next equal delay that follows from this event
        includes the error, so that a series of equal delays does not drift: 60 times 1/60 s is 1 s. The times of retrievals, which
        depend on activations, are rounded independently."""
        self.ended_by: Literal["limit", "until", "stop", "done"] = "done"
        """What ended the latest run: its own limit, the limits of the program, `stop`, or that no events were left."""
        self.bound: dict[str, Any] | None = None
        """The bindings of the production that fired last; `?name` in a chunk's text refers to these."""
        self.fired: Any = None
        """The production that fired last, for error messages."""
        self.firing: Any = None
        """The production whose body is running; errors in the events it starts name it."""
        self.trace: Trace | None = None
        """The trace that records the run first, and passes its events on to others."""
        self.traces: list[Trace] = []
        """All traces of the run, that one first."""
        self.seed: int | str | None = None
        """The seed of the run's random numbers; None if the modeller provided a generator."""
        self.stop_flag = False
        self.stop_wanted = False
        """Whether `stop` was called in lockstep."""
        self._run_number = 0
        self.step = 0
        """The number of past events."""
        self.harvests = False
        """Whether a memory collects the chunks that leave buffers, as in ACT-R 7."""
        self.round_ms = False
        """Whether some models use ACT-R 7's timing, with events at whole milliseconds."""
        self.limits: RunLimits | None = RunLimits.current()
        self.in_lockstep = False
        """Whether a simulation advances the time tick by tick, and checks the limits itself."""
        if self.limits is not None:
            self.limits.follow(lambda: self.now_us)
        self._ends = Ends()
        self.running = False
        """Whether a run is in progress."""
        self.incoming: deque[tuple[Callable[..., Any], float, Sequence[Any], Mapping[str, Any] | None, float]] = deque()
        """The calls that other threads have added, until the end of the running event."""
        self._named: dict[str, Trigger] = {}

    @property
    def time(self) -> float:
        """The current time [s]."""
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
            func: The function to call; a generator function runs until it ends, waiting for what it yields.
            delay: The delay [s].
            args: Its arguments.
            keys: Its keyword arguments.
            priority: Among simultaneous events, a higher priority comes first.
            thread_safe: Whether the caller is another thread; the call is then scheduled after the running event.

        Raises:
            SchedulerError: If the delay is negative or not a number.
        """
        if thread_safe:
            self.incoming.append((func, delay, args, keys, priority))
            return None
        generator = func(*args, **(keys or {})) if makes_generator(func) else None
        event = Event(func, args, keys, priority, generator)
        self.put(event, delay, priority)
        return event

    def call_after(self, delay: float, call: Callable[..., Any], args: Sequence[Any] = ()) -> Call:
        """Schedules a plain call of the library itself, which returns None; its delay is rounded independently."""
        event = Call(call, args)
        if delay == 0:
            self.queue.push(self.now_us, event)
            return event
        kept, self.remainders = self.remainders, NO_REMAINDERS
        self.put(event, delay)
        self.remainders = kept
        return event

    def call_at(self, time: int, call: Callable[..., Any], args: Sequence[Any] = ()) -> Call:
        """Schedules such a call at a time [us] returned by `after`."""
        event = Call(call, args)
        if time == self.now_us:
            event.remainders = self.remainders
        self.queue.push(time, event, 0, (time - self.now_us) / MICROSECONDS)
        return event

    def drop(self, events: Collection[Call]) -> None:
        """Removes events that no longer have an effect from the queue, so that no run waits for them."""
        heap = self.queue.heap
        left = [entry for entry in heap if not any(entry[3] is event for event in events)]
        if len(left) < len(heap):
            heap[:] = left
            heapify(heap)

    def begin(self, generator: Generator[Any, Any, Any], call: Callable[..., Any]) -> Event:
        """Starts a generator, created by `call`, at the current time."""
        event = Event(call, generator=generator)
        self.put_now(event)
        return event

    def put(self, event: Call, delay: float, priority: float = 0) -> None:
        """Adds an event to the queue, `delay` seconds from now.

        The rounding error of the delay is included in the next equal delay; see `remainders`. For models with events at whole
        milliseconds, the time is rounded to a millisecond and no error is carried over, as in ACT-R 7.

        Raises:
            SchedulerError: If the delay is negative or not a finite number.
        """
        kind = type(delay)
        if not ((kind is float or kind is int) and 0 <= delay < FAR):
            self._checked(delay, f"{event.describe()}: a delay")
            delay = float(delay)
        exact = delay * MICROSECONDS
        later = round(exact)
        part = exact - later
        carried = event.remainders = self.remainders
        if self.round_ms and later > 0 and _profile_of(event).whole_milliseconds:
            time = max(self.now_us, round((self.now_us + later) / 1000) * 1000)
        elif -NO_PART < part < NO_PART:
            time = self.now_us + later
        else:
            kept = {known: of for known, of in carried.items() if known != delay} if len(carried) > 1 or delay not in carried else {}
            part += carried.get(delay, 0.0)
            if len(kept) >= MAX_REMAINDERS:
                part += kept.pop(next(iter(kept)))
            more = max(round(part), -later)
            time = self.now_us + later + more
            kept[delay] = part - more
            event.remainders = kept
        self.queue.push(time, event, priority, delay)

    def discard_remainders(self) -> None:
        """Discards the carried rounding errors, so that delays that follow from the current event are rounded independently."""
        self.remainders = NO_REMAINDERS

    def put_now(self, event: Event) -> None:
        """Adds an event to the queue at the current time, with its own priority."""
        event.remainders = self.remainders
        self.queue.push(self.now_us, event, event.priority)

    def after(self, delay: float) -> int:
        """Returns the time `delay` seconds from now [us].

        Raises:
            SchedulerError: If the delay is negative or not a finite number.
        """
        return self.now_us + self._checked(delay, "a delay")

    @staticmethod
    def _checked(delay: float, what: str) -> int:
        later = microseconds(delay, what)
        if later < 0:
            raise SchedulerError(f"{what}: must be >= 0 (got {delay!r} s)")
        return later

    def trigger(self, key: Trigger | str, priority: float | None = None) -> None:
        """Wakes all events that wait for a trigger or for a name."""
        self.wake(self.named(key) if isinstance(key, str) else key, priority)

    def wake(self, trigger: Trigger, priority: float | None) -> None:
        """Resumes the events that wait for a trigger at the current time, with a new priority unless it is None."""
        waiting, trigger.waiting = trigger.waiting, []
        for event in waiting:
            if priority is not None:
                event.priority = priority
            self.put_now(event)

    def named(self, name: str) -> Trigger:
        """Returns the trigger of a name."""
        return self._named.setdefault(name, Trigger(name))

    def take_over(self, other: Scheduler) -> None:
        """Moves everything of another scheduler here: its events, its waiting events by name, and the calls added by other threads."""
        while other.queue.heap:
            time, priority, event = other.queue.take()
            if time < self.now_us:
                time = self.now_us
            self.queue.push(time, event, priority, seconds(time - self.now_us))
        named = other._named  # of this class, too
        for name, trigger in named.items():
            self.named(name).waiting += trigger.waiting
        self.incoming += other.incoming
        named.clear()
        other.incoming.clear()
        self.round_ms = self.round_ms or other.round_ms
        self.harvests = self.harvests or other.harvests

    def stop(self) -> None:
        """Ends the run after the current event; in lockstep, the simulation ends it after the tick."""
        if self.in_lockstep:
            self.stop_wanted = True
        else:
            self.stop_flag = True

    def run(self, duration: float | None = None) -> None:
        """Runs until no events are left, `stop` is called, or `duration` seconds have passed.

        Events at exactly the end belong to this run. After a run that was not stopped, the clock is at its end. The
        limits of the program cut a run that needs more time than they allow; they have no other effect.

        Raises:
            SchedulerError: If 200,000 events happen without time passing, or a yielded value cannot be waited for.
            EndOfRun: If the limits of the program leave no time, and the run needs some; or if they cut an earlier run.
        """
        end = None if duration is None else self._ends.after(self.now_us, duration)
        length = float(duration or 0)
        limits = self.limits
        if limits is None:
            self._run_until(end, None, length)
            return
        last = limits.clip()
        none_left = last is not None and last <= self.now_us
        self._run_until(end, self.now_us if none_left else last, length)
        if self.ended_by == "until":
            wanted = self.now_us + 1
            if none_left:
                limits.refuse(wanted)
            limits.cut(wanted)

    def _run_until(self, end: int | None, last: int | None, length: float) -> None:
        """Runs to a time [us], if any, that is `length` [s] from now, but not beyond the last time [us] that limits allow, if any."""
        total = self.queue.sum + length
        self.stop_flag = False
        heap = self.queue.heap
        until = end if last is None or (end is not None and end <= last) else last
        idle = until is not None and (not heap or heap[0][0] > until) and not self.incoming
        if end is not None and not self.queue.first_come and not (idle and until != end):
            self._run_number += 1
            self.queue.push(end, Call(self._end, (self._run_number,)), END, length)
            if idle:
                self.queue.pop()
        if not idle:
            self._run_on(until)
        if end is not None and (self.now_us >= end or (until == end and not self.stop_flag)):
            self.ended_by = "limit"
            if end > self.now_us:
                self._advance(end, total)
        elif self.stop_flag:
            self.ended_by = "stop"
        elif end is None and not heap and not self.incoming:
            self.ended_by = "done"
        else:
            self.ended_by = "until"
            assert until is not None
            if until > self.now_us:
                self._advance(until, seconds(until))

    def _run_on(self, until: int | None) -> None:
        """Runs the queued events, up to a time [us], if any; warns if a run is already active."""
        if self.running:
            warn_modeller(
                f"run was called while the model is running (at {self.time:g} s): "
                "the calling code continues only when the inner run has ended; to let time pass, yield a number of seconds"
            )
        before, self.running = self.running, True
        try:
            self._run_events(until)
        finally:
            self.running = before

    def _end(self, run_number: int) -> None:
        """Ends the run that requested it; has no effect if that run was stopped before."""
        if run_number == self._run_number:
            self.stop_flag = True

    def _run_events(self, until: int | None) -> None:
        """Runs the queued events until none is left up to the given time, or the run is stopped."""
        queue = self.queue
        heap = queue.heap
        end = NEVER if until is None else until
        passing = None if self.limits is None or self.in_lockstep else self.limits.passing
        still = 0
        while not self.stop_flag:
            while self.incoming:
                func, delay, args, keys, priority = self.incoming.popleft()
                self.add(func, delay, args, keys, priority)
            if not heap or (time := heap[0][0]) > end:
                break
            if time > self.now_us:
                if passing is not None and passing(self, time):
                    continue  # a user has changed something, which may have effects before that time
                self.now_us = LOG.time_us = time
                still = 0
            else:
                still += 1
                if still > STANDSTILL:
                    raise self._standstill(heap[0][3])
            self.step += 1
            _, queue.sum, _, event = heappop(heap)
            self.remainders = event.remainders
            if isinstance(event, Event):
                self._happen(event)
            else:
                event.call(*event.args)

    EVENT_LOOP: ClassVar[CodeType] = _run_events.__code__
    """The code that makes all calls of a run; what is below it on the stack did not cause them."""

    def _happen(self, event: Event) -> None:
        """Makes an event's call, or resumes its generator until it yields what it waits for next."""
        if event.group:
            if event.cancelled:
                return
            others = event.cancel_others()
            if self.round_ms and not _profile_of(event).awaits_expiry:
                self.drop(others)
        generator = event.generator
        if generator is None:
            result = event.call(*event.args, **event.keys)
            if result is None:
                self.finish(event)
            else:
                wait(self, event, result)
            return
        try:
            result = next(generator)
        except StopIteration:
            self.finish(event)
            return
        if type(result) is float:
            self.put(event, result, event.priority)
        elif type(result) is Trigger:
            result.waiting.append(event)
        elif result is AGAIN:
            self.put_now(event)
        else:
            if result is None:
                warn_of_none(event)
            wait(self, event, result)

    def _standstill(self, event: Call) -> SchedulerError:
        """Returns the error for an endless loop in which no time passes, with the events in it."""
        last = self.fired
        whose = getattr(getattr(event.call, "__self__", None), "_path", None)
        return SchedulerError(
            f"endless loop at {self.time:g} s: {STANDSTILL:,} events without any time passing; the last was {event.describe()}"
            + (f" of '{whose}'" if whose else "")
            + (f", the production that fired last '{last.name}' ({last.place})" if last is not None else "")
        )

    def idle_now(self) -> bool:
        """Returns whether no other event happens before time passes, so that the last event of the moment may happen at once."""
        heap = self.queue.heap
        if not self.queue.first_come:
            return False
        return not (heap and heap[0][0] <= self.now_us) and not self.stop_flag and not self.incoming

    def _advance(self, time: int, total: float) -> None:
        """Advances the time without events, to a time [us], which is also given as a sum of delays [s]."""
        passing = None if self.limits is None or self.in_lockstep else self.limits.passing
        while passing is not None and time > self.now_us and passing(self, time):
            self._run_on(time)  # what a user has changed may have effects before that time
            if self.stop_flag and self.now_us < time:
                self.ended_by = "stop"
                return
        self.now_us = time
        self.remainders = NO_REMAINDERS
        self.queue.sum = total
        LOG.time_us = time

    def catch_up(self, time: int) -> None:
        """Advances the time to one before the next event [us], because a user changes something then."""
        if time > self.now_us:
            self.queue.sum += seconds(time - self.now_us)
            self.now_us = LOG.time_us = time
            self.discard_remainders()

    def finish(self, event: Event) -> None:
        """Marks an event as finished, and wakes the events that wait for it."""
        event.done = event.origin.done = True
        for parent in event.parents:
            self.put_now(parent)
        event.parents = []


def _profile_of(event: Call) -> Profile:
    """Returns the profile of the model whose method an event calls."""
    owner = getattr(event.call, "__self__", event.call)
    return getattr(owner, "_profile", None) or PYTHON_ACTR


# -- what a generator may wait for


def wait(sch: Scheduler, event: Event, result: Any) -> None:
    """Schedules an event by the value its generator yielded: a delay, a trigger, another event, or a sequence (the first to happen).

    Args:
        sch: The scheduler of the event.
        event: The event that waits.
        result: The value that was yielded.

    Raises:
        SchedulerError: If an event cannot wait for the value: it has another type, is empty, or its delay is not a time.
    """
    if isinstance(result, (int, float)):
        sch.put(event, result, event.priority)
    elif isinstance(result, dict):
        _wait_as(sch, event, cast("dict[str, Any]", result))
    elif isinstance(result, (Trigger, str)):
        trigger = sch.named(result) if isinstance(result, str) else result
        if event.group:
            trigger.add_one_of_several(event)
        else:
            trigger.waiting.append(event)
    elif isinstance(result, (list, tuple)):
        _wait_for_first(sch, event, cast("Sequence[Any]", result))
    elif result is None:
        sch.finish(event)
    elif isinstance(result, Event):
        if result.done:
            sch.put_now(event)
        else:
            result.parents.append(event)
    elif hasattr(result, "default_trigger"):
        wait(sch, event, result.default_trigger)
    elif isinstance(result, Real):  # another number type, such as numpy's
        sch.put(event, float(result), event.priority)
    else:
        raise SchedulerError(
            f"{event.describe()}: cannot wait for {result!r}; yield a number of seconds, a trigger or its name, a method, "
            "the event of a called generator method, or a tuple of these"
        )


def _wait_for_first(sch: Scheduler, event: Event, several: Sequence[Any]) -> None:
    """Schedules an alternative of an event for each of several values; the first that happens cancels the others."""
    choices = list(_each(several))
    if any(choice is None for choice in choices):
        warn_of_none(event, "a tuple with None in it, which ends it for all that wait for it")
    if not choices:
        raise SchedulerError(f"{event.describe()}: cannot wait for {several!r}; nothing is in it")
    events = [copy.copy(event) for _ in choices]
    for alternative in events:
        alternative.group = events
    for choice, alternative in zip(choices, events, strict=True):
        wait(sch, alternative, choice)


def _wait_as(sch: Scheduler, event: Event, how: dict[str, Any]) -> None:
    """Schedules an event after a dict's `delay`, with its `priority` from now on."""
    for word in how:
        if word not in ("delay", "priority"):
            near = did_you_mean(str(word), ("delay", "priority"))
            raise SchedulerError(f"{event.describe()}: cannot wait for {how!r}: no '{word}'{near or '; use delay and priority'}")
    priority = how.get("priority", event.priority)
    if not isinstance(priority, (int, float)):
        raise SchedulerError(f"{event.describe()}: a priority must be a number (got {priority!r})")
    event.priority = priority
    sch.put(event, how.get("delay", 0), priority)


def warn_of_none(event: Event, what: str = "None, which ends it here") -> None:
    """Warns about a generator that yielded None, at the line of the `yield`.

    Args:
        event: The generator's event.
        what: The value that was yielded, and its effect.
    """
    generator = event.innermost
    frame = generator.gi_frame if generator is not None else None
    if frame is not None:
        warn_at_frame(
            f"{frame.f_code.co_qualname} yields {what}: what it calls may not be a generator, or a number of seconds is missing",
            frame,
        )


def _each(choices: Sequence[Any]) -> Iterator[Any]:
    """Yields the alternatives, including those in nested sequences."""
    for choice in choices:
        if isinstance(choice, (list, tuple)):
            yield from _each(cast("Sequence[Any]", choice))
        else:
            yield choice
