"""The trace: the append-only record of everything that happens in one run, or in several runs of one program.

A run has no trace unless one is requested, and then records only up to the requested level. Code that emits an event checks
the trace's level flags first, so that nothing is computed in vain.

An event's source is the dotted path of a part below the top model, such as `agent.goal`, or «top» for that model itself.
If one trace records several runs, for example of a program that makes one model after another, the second top model is
`top#2` and its parts are `top#2.goal` and so on, in the order in which tracing of the runs began. The time of each run
starts at 0.

Every kind of event is described once, in `actr3d.trace_kinds`: its lowest level, its source, and its data.
A trace that begins in the middle of a run begins with the current state: `start`, and then `state`, `buffer`,
`productions`, `observe`, `utility` and the last `request` of each part.
"""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from functools import lru_cache
from typing import Any, NamedTuple, Protocol, cast

from actr3d.clock import seconds
from actr3d.errors import ParameterError, RecordingError, did_you_mean
from actr3d.trace_kinds import LEVELS, rank_of
from actr3d.values import Naming, plain, to_json

Data = dict[str, Any] | Callable[[], dict[str, Any]]
"""The data of an event, or a function that creates the data from stored values when they are first read."""
EventRecord = tuple[int, str, str, Data]


class TraceEvent(NamedTuple):
    """One event."""

    time_us: int
    """The time of the event [us of simulated time]."""
    source: str
    """The source: the dotted path below the top model, or «top» for that model itself; for a later run `top#2` and so on."""
    kind: str
    """The kind: one of `trace_kinds.KINDS`, or a name that a model chose."""
    data: dict[str, Any]
    """The data; plain values, lists and dicts only."""

    @property
    def time(self) -> float:
        """The time of the event [s of simulated time]."""
        return seconds(self.time_us)

    @property
    def run(self) -> int:
        """The number of its run in the trace, counted from 1."""
        return run_of(self.source)

    @property
    def data_text(self) -> str:
        """The data as a readable text: `name=value name=value`."""
        return " ".join(f"{name}={value}" for name, value in self.data.items())

    def to_json(self) -> str:
        """Returns the event as one line of JSON; the same event always gives the same bytes.

        Numbers that JSON does not have become the texts `inf`, `-inf` and `nan`.
        """
        line = to_json({"time": self.time, "source": self.source, "kind": self.kind, "data": self.data})
        # An object's memory address in its text differs from run to run.
        return _ADDRESS.sub("", line) if " at 0x" in line else line


_ADDRESS = re.compile(r" at 0x[0-9a-fA-F]+")

Listener = Callable[[TraceEvent], object]


class Run(Protocol):
    """The interface of a run that a trace records."""

    @property
    def model(self) -> Any:
        """The top model, for reading; None if the run is over and the model deleted."""
        ...

    def now_us(self) -> int | None:
        """The current time [us]; None if the run is over and deleted, or has become part of another run."""
        ...

    def emit_state(self, trace: Trace) -> None:
        """Emits the current state to a trace."""
        ...

    def stop(self) -> None:
        """Stops the run after the current event."""
        ...


class Trace:
    """Records the events of one program's runs and passes each to the listeners.

    Args:
        level: One of `LEVELS`; events above it are neither computed nor kept.
        keep: Whether the trace keeps its events. A long run that only streams them need not; without listeners, such a trace
            costs nothing.

    Raises:
        ParameterError: If the level is unknown.
    """

    __slots__ = ("_failures", "_listeners", "_rank", "_records", "_runs", "all", "buffer", "keep", "level", "production")

    def __init__(self, level: str = "all", keep: bool = True) -> None:
        self.level = level
        self.keep = keep
        self._records: list[EventRecord] = []
        self._listeners: tuple[tuple[Listener, int], ...] = ()
        self._runs: list[Run] = []
        self._failures: list[Exception] = []
        self._rank = _rank("Trace.level", level)
        self._set_flags()

    def _set_flags(self) -> None:
        """Sets the level flags to what is kept or listened to."""
        wanted = max([rank for _, rank in self._listeners] + [self._rank if self.keep else 0])
        self.production = wanted >= LEVELS.index("production")
        self.buffer = wanted >= LEVELS.index("buffer")
        self.all = wanted >= LEVELS.index("all")

    # -- recording events

    def begin(self, run: Run) -> int:
        """Adds a run that begins to be traced; returns its number, counted from 1."""
        self._runs.append(run)
        return len(self._runs)

    @property
    def runs(self) -> Sequence[Run]:
        """The recorded runs, in the order in which their tracing began."""
        return self._runs

    def emit(self, time_us: int, source: str, kind: str, data: Data) -> None:
        """Appends one event; the caller has checked the level and must not change `data` afterwards."""
        if not self._listeners:
            if self.keep:
                self._records.append((time_us, source, kind, data))
            return
        event = _event((time_us, source, kind, data))
        rank = rank_of(kind)
        if self.keep and rank <= self._rank:
            self._records.append(event)  # in this form: later readers need not create its data again
        for listener, level in self._listeners:
            if level >= rank:
                try:
                    listener(event)
                except Exception as error:  # noqa: BLE001 - it is raised where the run allows it, see `raise_failures`
                    self._fail(listener, event, error)

    def command(self, name: str, data: Mapping[str, Any] | None = None, *, run: int | None = None) -> None:
        """Sends a user's command, such as pause or a new value of a parameter, to a run.

        It is recorded at the run's current time, at every level, and passed to the listeners; one of them executes it. Call this only
        in the thread that runs the model; another thread schedules it between two events:
        `model.sch.add(trace.command, args=("pause",), thread_safe=True)`.

        Args:
            name: The name of the command.
            data: Its data; copied.
            run: The number of the run; None for the latest one.

        Raises:
            ParameterError: If the run does not exist any more.
            Exception: Any error of a listener.
        """
        known = {number: now for number, one in enumerate(self._runs, start=1) if (now := one.now_us()) is not None}
        number = max(known, default=1) if run is None else run
        if number not in known:
            raise ParameterError(f"Trace.command: no run {number} to send {name!r} to; there are: {', '.join(map(str, known)) or 'none'}")
        if self.production:
            self.emit(known[number], top_path(number), "command", {"command": name, "data": plain(dict(data or {}))})
        self.raise_failures()

    # -- listeners

    def listen(self, listener: Listener, level: str | None = None) -> None:
        """Calls `listener` with every event from now on, after sending it the current state of the active runs.

        A listener that raises an error is removed; the run ends after the current event, and `run` raises that error.
        The run can be continued afterwards.

        Args:
            listener: A function of one event.
            level: The highest level of events it receives; None for the trace's own.

        Raises:
            ParameterError: If the level is unknown, or above the trace's own.
            Exception: Any error that the listener raises at once.
        """
        rank = _rank("Trace.listen(level)", self.level if level is None else level)
        if rank > self._rank:
            raise ParameterError(f"Trace.listen(level): a trace of level '{self.level}' has no events of level '{level}'")
        self.feed(listener, LEVELS[rank])
        active = [run for run in self._runs if run.now_us() is not None]
        if not active:
            return
        opening = Trace(LEVELS[rank], keep=False)
        opening.listen(listener)
        for run in active:
            run.emit_state(opening)
        try:
            opening.raise_failures()
        except Exception:
            self.ignore(listener)
            raise

    def pass_on(self, event: TraceEvent, other: Trace) -> None:
        """Emits one of its events in another trace, too; what that one's listeners raise is raised where this one's failures are."""
        other.emit(*event)
        self._failures += other.take_failures()

    def feed(self, listener: Listener, level: str) -> None:
        """Calls a listener with every event up to a level, which may be above the trace's own, from now on, without the current state."""
        self._listeners = (*self._listeners, (listener, LEVELS.index(level)))
        self._set_flags()

    def ignore(self, listener: Listener) -> None:
        """Removes a listener.

        Raises:
            ParameterError: If it is not a listener of this trace.
        """
        others = tuple(pair for pair in self._listeners if pair[0] != listener)
        if len(others) == len(self._listeners):
            raise ParameterError(f"Trace.ignore: {plain(listener)} does not listen")
        self._listeners = others
        self._set_flags()

    def _fail(self, listener: Listener, event: TraceEvent, error: Exception) -> None:
        """Removes a listener that raised an error, and stops the runs so that the error can be raised."""
        if not isinstance(error, RecordingError):  # a user has not made the listener, and its message says all
            what = f"'{event.kind}' of {event.source} at {event.time:g} s"
            error.add_note(f"raised by a listener of the trace, {plain(listener)}, for the event {what}; this listener has been removed")
        self._listeners = tuple(pair for pair in self._listeners if pair[0] != listener)
        self._set_flags()
        self._failures.append(error)
        for run in self._runs:
            run.stop()

    def take_failures(self) -> list[Exception]:
        """Returns the errors of listeners since the last call, for the caller to raise."""
        failures, self._failures = self._failures, []
        return failures

    def raise_failures(self) -> None:
        """Raises the errors of listeners; called between events.

        Raises:
            Exception: The first error, with a note on each other one.
        """
        if self._failures:
            first, *others = self.take_failures()
            for other in others:
                first.add_note(f"another listener raised {type(other).__name__}")
            raise first

    # -- reading events

    def __len__(self) -> int:
        return len(self._records)

    def __iter__(self) -> Iterator[TraceEvent]:
        return map(_event, self._records)

    def since(self, number: int) -> list[TraceEvent]:
        """Returns the events from a number on, counted from 0; its cost depends only on how many these are."""
        return list(map(_event, self._records[number:]))

    def select(self, kind: str, source: str | None = None) -> list[TraceEvent]:
        """Returns the events of one kind, optionally of one source, in order."""
        return [e for e in self if e.kind == kind and (source is None or e.source == source)]


@lru_cache
def run_of(source: str) -> int:
    """Returns the number of the run that a source belongs to, counted from 1."""
    return int(source.removeprefix("top#").partition(".")[0]) if source.startswith("top#") else 1


def top_path(number: int) -> str:
    """Returns the source name of a run's top model."""
    return "top" if number == 1 else f"top#{number}"


def renumbered(source: str, number: int) -> str:
    """Returns the name of a source if its run has another number."""
    path = source.partition(".")[2] if source.startswith("top#") else "" if source == "top" else source
    return ".".join(name for name in ("" if path and number == 1 else top_path(number), path) if name)


def with_number(event: TraceEvent, number: int) -> TraceEvent:
    """Returns an event as in a trace in which its run has another number: every part has its name there."""
    if event.run == number:
        return event
    return TraceEvent(event.time_us, renumbered(event.source, number), event.kind, _with_number(event.data, number))


def _with_number(data: Any, number: int) -> Any:
    if type(data) is Naming:
        return data.renamed(lambda source: renumbered(source, number))
    if isinstance(data, dict):
        return {key: _with_number(value, number) for key, value in cast("dict[Any, Any]", data).items()}
    if isinstance(data, (list, tuple)):
        return [_with_number(value, number) for value in cast("list[Any]", data)]
    return data


def _rank(what: str, level: Any) -> int:
    if level not in LEVELS:
        raise ParameterError(f"{what}: no level {level!r}; use one of {', '.join(LEVELS)}{did_you_mean(str(level), LEVELS)}")
    return LEVELS.index(level)


def _event(record: EventRecord) -> TraceEvent:
    if isinstance(record, TraceEvent):
        return record
    time_us, source, kind, data = record
    return TraceEvent(time_us, source, kind, data() if callable(data) else data)
