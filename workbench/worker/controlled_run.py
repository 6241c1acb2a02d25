"""Defines what a controller needs of a run, whether it is a simulation or a program, and what both have in common."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from actr3d.actr.explain.snapshot import snapshot_of
from actr3d.clock import microseconds, seconds
from actr3d.configuration import Live
from actr3d.errors import RecordingError, SimulationError
from actr3d.recording import Recording
from actr3d.trace import Trace, TraceEvent
from workbench.chunk_curves import SUFFIX, ChunkCurves
from workbench.event_curves import EventCurves
from workbench.time_text import time_text
from workbench.worker.known_run import KnownRun
from workbench.worker.names import Names, Top
from workbench.worker.simulation_display import SimulationDisplay
from workbench.worker.stop_conditions import Touches


class LossError(SimulationError):
    """A change is refused because what lies ahead of it would be lost; see `RunChange.drop`."""


class FieldError(SimulationError):
    """A command is refused because of the value of one of its fields; the message begins with the name of the field."""

    def __init__(self, field: str, problem: str) -> None:
        super().__init__(f"{field}: {problem}")
        self.field = field


class ControlledRun(ABC):
    """A run that a controller controls."""

    _recording: Recording | None = None
    _not_begun: RecordingError | None = None
    """Why the recording could not be started. None if it was started, or if the run goes on without one."""
    _event_curves: EventCurves | None = None
    """The curves of the events that have been taken; None until they are needed."""
    _chunk_curves: ChunkCurves | None = None
    """Those of chosen chunks, which follow from these events."""
    _repeated: KnownRun | None = None
    """The recorded run that this run repeats; None if there is none, or this run continues differently."""
    ancestors: Sequence[Sequence[Any]] = ()
    """The recordings from which the run comes, the nearest first, each with the time at which the one before it left it [s]."""

    @property
    @abstractmethod
    def clock(self) -> int:
        """The time since the start of the run; for a program, in all its runs [us]."""

    @property
    @abstractmethod
    def furthest(self) -> int:
        """The furthest time that the run has reached [us]."""

    @property
    def target(self) -> int | None:
        """The time of the seek that is in progress [us]; None if there is none."""
        return None

    @property
    @abstractmethod
    def period(self) -> int:
        """The length of a tick [us]."""

    @property
    @abstractmethod
    def trace(self) -> Trace:
        """The trace up to now."""

    def events(self, first: int, end: int) -> list[TraceEvent]:
        """Returns the events from a number on and before another one, with the times of the whole run."""
        return self.trace.since(first)[: max(0, end - first)]

    def events_ahead(self, first: int, end: int) -> list[tuple[int, str, str, Any]]:
        """Returns events that the run has not reached yet, but that the recorded run has which it repeats, as pages show them.

        Args:
            first: The number of the first, at least the number of events up to now.
            end: The number after the last.
        """
        return [] if self._repeated is None else self._repeated.between(first, end)

    def own_time(self, source: str, time: int) -> int | None:
        """Returns the time of the model of an agent at a time of the run [us]; None if there was no such model yet.

        Args:
            source: The name of the agent in the trace.
            time: The time of the run [us].
        """
        return time

    def whole_time(self, source: str, time: int) -> int:
        """Returns the time of the run at a time of the model of an agent [us]."""
        return time

    @property
    @abstractmethod
    def shown(self) -> SimulationDisplay | None:
        """What is shown of the current simulation; for a program, of the one that has ticked last, if any."""

    @abstractmethod
    def go_to(self, time: int) -> None:
        """Goes to another time of the run [us]; a simulation goes to the nearest tick.

        Raises:
            SimulationError: If the run has not been there, or does not repeat what it did; then it has failed.
            EndOfRun: To leave a program, which is then run again.
        """

    def changed_parameters(self) -> dict[str, Any]:
        """Returns the values of the model's parameters that users have changed during the run, up to the present, by name."""
        return {}

    @abstractmethod
    def live_parameter(self, name: str, value: Any) -> Live:
        """Returns how a parameter is changed during the run, after checking its new value.

        Raises:
            Actr3dError: If there is no such parameter, it cannot change during a run, or it cannot have this value.
        """

    @abstractmethod
    def change(self, word: str, values: tuple[Any, ...], named: Mapping[str, Any], body: str | None, *, drop: bool) -> None:
        """Sends the simulation a command; the future of the run is kept as a branch.

        Args:
            word: The command.
            values: Its arguments.
            named: Its keyword arguments.
            body: The body that it is for, if any.
            drop: Whether what lies ahead may be lost if it cannot be kept.

        Raises:
            SimulationError: If the run is over, or what lies ahead cannot be kept and may not be lost.
            Exception: What the world, a body or an agent raises.
        """

    @abstractmethod
    def undo(self, *, drop: bool) -> None:
        """Goes to the moment of the last change by hand up to now, and forgets it; the future of the run is kept as a branch.

        Args:
            drop: Whether what lies ahead of that moment may be lost if it cannot be kept.

        Raises:
            SimulationError: If there is no such change, what lies ahead cannot be kept and may not be lost, or as `go_to` does.
            EndOfRun: To leave a program, which is then run again.
        """

    @abstractmethod
    def finish_output(self) -> None:
        """Traces an unfinished line, as nothing more will be printed."""

    @abstractmethod
    def forget_ahead(self) -> None:
        """Removes the knowledge of times after the present."""

    @abstractmethod
    def tops(self) -> Sequence[Top]:
        """Returns the latest top models, or the agents of a simulation."""

    @abstractmethod
    def body_curves(self, names: Sequence[str] | None, first: float, last: float | None, most: int) -> dict[str, Any]:
        """Returns curves of the bodies of the known run; see `workbench.page_commands.bodies.Curves`."""

    @abstractmethod
    def names(self) -> Names:
        """Returns the names at which the run can be stopped."""

    # -- curves

    def curves(self, names: Sequence[str] | None, first: float, last: float | None, most: int, seen: int | None = 0) -> dict[str, Any]:
        """Returns curves of the known run; see `workbench.page_commands.bodies.Curves`."""
        bodies = self.body_curves(names, first, last, most)
        if seen is None:
            return {**bodies, "events": {}, "basis": ""}
        events = self.take_events()
        answer = events.added_to(bodies, names, first, last, most, seen=seen)
        of_chunks = [name for name in names or () if name.endswith(SUFFIX)]
        if not of_chunks:
            return answer
        if self._chunk_curves is None or self._chunk_curves.of is not events:
            self._chunk_curves = ChunkCurves(events, self.period)
        end = self.furthest if last is None else min(microseconds(last), self.furthest)
        parts = {name: part for top in self.tops() for name, part in top.parts()}
        chunks = self._chunk_curves.sampled(of_chunks, microseconds(first), end, most, parts, len(self.trace))
        return {**answer, "events": {**answer["events"], **chunks["events"]}, "basis": chunks["basis"]}

    def take_events(self) -> EventCurves:
        """Adds the events up to now to the curves of events, which know them also after the run has gone back; returns these curves."""
        if self._event_curves is None:
            self._event_curves = EventCurves()
        count = len(self.trace)
        if count > self._event_curves.next:
            self._event_curves.take(self.events(self._event_curves.next, count))
        return self._event_curves

    def repeat_recorded(self, known_run: KnownRun) -> None:
        """Stores the events of a recorded run, which this run repeats, and their curves."""
        self._repeated, self._event_curves = known_run, known_run.event_curves

    def cut_events(self, count: int) -> None:
        """Removes what is known of the events from a number on, because the run continues differently."""
        self._repeated = None
        if self._event_curves is not None and self._event_curves.next > count:
            self._event_curves = None  # those up to now are in the trace

    # -- what is shown

    def scene(self) -> tuple[bytes | None, dict[str, float]]:
        """Returns the state of the physics, and the widths of apertures [m]."""
        return (None, {}) if self.shown is None else self.shown.scene()

    def touches(self) -> Touches:
        """Returns the contacts of bodies with anything but the ground in the last tick."""
        return frozenset() if self.shown is None else self.shown.touches()

    def parts(self) -> dict[str, dict[str, Any]]:
        """Returns the current state of all parts."""
        return {top.name(path): part for top in self.tops() for path, part in snapshot_of(top.model).items()}

    # -- the recording

    def flush(self) -> None:
        """Writes buffered data to the recording, so that a paused run's recording is complete up to that moment."""
        if self._recording is not None:
            self._recording.flush()

    def become_branch(self, recording: str, time: float, before: Sequence[Sequence[Any]]) -> None:
        """Records that the run has repeated another recording up to a time [s], and is a branch of it from then on.

        Args:
            recording: The name that the recording was given first.
            time: The time [s].
            before: The recordings from which that one comes; see `ancestors`.
        """
        self.ancestors = [[recording, time], *before]
        if self._recording is not None:
            self._recording.may_fail = False
        self._record(branched=time, origin=recording, ancestors=before)
        self.flush()

    def _record(self, **facts: Any) -> None:
        """Records facts, if the run is recorded."""
        for name, value in facts.items():
            if self._recording is not None:
                self._recording.fact(name, value)

    def _begin_recording(self, begin: Callable[[], Recording], *, may_fail: bool) -> None:
        """Begins the recording.

        Args:
            begin: Begins it.
            may_fail: Whether the run goes on if it cannot be begun or written; see `Recording.may_fail`.

        Raises:
            RecordingError: If it cannot be begun, and is needed.
        """
        try:
            self._recording = begin()
            self._recording.may_fail = may_fail
        except RecordingError as error:
            if not may_fail:
                raise
            self._not_begun = error

    def recording_failure(self) -> RecordingError | None:
        """Returns why what follows cannot be recorded; None if it can, or is not to be."""
        if self._recording is None:
            return self._not_begun
        self._recording.flush()
        return self._recording.failure

    def give_up_recording(self) -> RecordingError | None:
        """Stops recording if the file cannot be written; the run goes on without it. Returns why it cannot be written."""
        failure = self.recording_failure()
        if failure is not None:
            if self._recording is not None:
                self._recording.stop()
            self._recording = self._not_begun = None
        return failure

    def _close_recording(self, *, left: bool) -> None:
        """Closes the recording; `left` says that the user leaves the run, which may not be over."""
        recording = self._recording
        if recording is None:
            return
        if recording.may_fail:
            recording.stop()
            return
        if left:
            recording.leave()
        recording.close()


def nothing_to_undo(time: int) -> SimulationError:
    """Returns the error for `undo` at a time [us] up to which nothing was changed by hand."""
    return SimulationError(f"undo: nothing was changed by hand up to {time_text(seconds(time))}")
