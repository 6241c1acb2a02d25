"""Passes the events of a run on while it runs: to its trace, its listeners and its recording."""

from __future__ import annotations

from collections.abc import Generator, Sequence
from contextlib import contextmanager
from typing import Any, Protocol
from weakref import ref

from actr3d.actr.kernel.run_limits import Contacts, Recorder
from actr3d.actr.modules.port import Request
from actr3d.errors import ParameterError
from actr3d.recording import Recording
from actr3d.simulation.commands import Command
from actr3d.simulation.program_run import ProgramRun
from actr3d.simulation.stdout_capture import StdoutCapture
from actr3d.simulation.tick_contacts import TickContacts
from actr3d.trace import Listener, Run, Trace, TraceEvent
from actr3d.trace_kinds import LEVELS
from actr3d.values import plain
from actr3d.world import World


class StateKeeper(Protocol):
    """Stores the states and contacts of a run for its observers, and changes nothing."""

    @property
    def furthest(self) -> int:
        """The last tick that was stored."""
        ...

    def keep(self, tick: int, world: World, contacts: Contacts) -> None:
        """Stores the start of the run (tick 0) or the end of a tick, also of one that runs again, with the contacts in that tick."""
        ...

    def cut(self, tick: int) -> None:
        """Forgets what came after a tick, because the run continues differently from there."""
        ...


class EventLog:
    """Passes all events to the listeners, and each event once to the recording.

    A run that has gone back to an earlier time repeats what was recorded already. Because the same events happen in the same
    order, counting them shows which are new.

    Args:
        level: What the trace records; one of `actr3d.trace.LEVELS`.
        world: The world of the run.

    Raises:
        ParameterError: If the level is unknown.
    """

    def __init__(self, level: str, world: World) -> None:
        self._level = Trace(level).level
        self._world = world
        self._contacts: TickContacts | None = None
        self._keep = level != "none"
        self._listeners: list[Listener] = []
        self._recording: Recording | None = None
        self._program: ProgramRun | None = None
        self._failure: Exception | None = None
        self.silent = False
        """Whether the run repeats its past on the way to another time; listeners receive no events then."""
        self.trace: Trace | None = None
        """The trace of the run up to now; a new one replaces it when the run goes back."""
        self._keeper: StateKeeper | None = None
        self._events = self._answers = 0
        self._held: list[TraceEvent] | None = None
        self._preface: list[str] = []
        self.stdout = StdoutCapture(self._trace_line)
        """The standard output of the agents."""

    def raise_level(self, level: str, *, keep: bool = False) -> None:
        """Sets the level of the next trace to at least this one; if `keep` is true, the trace keeps its events.

        Raises:
            ParameterError: If the level is unknown.
        """
        self._keep |= keep
        self._level = max(self._level, Trace(level).level, key=LEVELS.index)

    def listen(self, listener: Listener) -> None:
        """Calls a listener with every event from now on.

        Raises:
            ParameterError: If nothing is traced.
        """
        if self._level == "none":
            raise ParameterError("nothing is traced; make the simulation with trace='all', or another level")
        if self.trace is not None and not self._listeners and self._recording is None:
            self.trace.listen(self._hear)
        self._listeners.append(listener)

    def keep_states(self, keeper: StateKeeper) -> None:
        """Passes each state to this keeper from now on; it replaces an earlier one."""
        self._keeper = keeper
        self._watch_contacts()

    def _watch_contacts(self) -> None:
        if self._contacts is None:
            self._contacts = TickContacts(self._world)

    def join_program(self, trace: Trace, recorder: Recorder | None, period: int) -> None:
        """Passes to the trace of the whole program the events of its level, and all other events to its recorder.

        Args:
            trace: The trace.
            recorder: The recorder; None for none.
            period: Length of a tick [us].
        """
        self.raise_level(trace.level)
        if trace.level != "none":
            log = ref(self)  # the program's trace does not keep the simulation alive
            self._program = ProgramRun(trace, recorder, period, lambda: (here := log()) and here.run)
            self.listen(self._program.take)
        if recorder is not None:
            self._watch_contacts()

    @property
    def run(self) -> Run | None:
        """The run in its own trace; None if nothing is traced."""
        return None if self.trace is None or not self.trace.runs else self.trace.runs[-1]

    @property
    def number(self) -> int | None:
        """The number of the simulation among the runs of its program; None outside a program."""
        return None if self._program is None else self._program.number

    @property
    def recorded(self) -> bool:
        """Whether everything is being recorded."""
        return self._recording is not None

    def record(self, recording: Recording) -> None:
        """Records everything from now on."""
        self.raise_level("all")
        self._recording = recording
        self._watch_contacts()

    def end_recording(self, *, whole: bool) -> None:
        """Ends the recording.

        Args:
            whole: Whether the last tick is complete, with its output.
        """
        if self._recording is None:
            return
        if whole:
            self.stdout.finish()
            self._recording.fact("whole", True)
        self._recording = None
        if self.trace is not None and not self._listeners:
            self.trace.ignore(self._hear)

    def begin(self) -> Trace | None:
        """Begins a new trace of a run at its start, and returns it, or None if the level is none."""
        self._events = self._answers = 0
        self._failure = None
        self.stdout.begin()
        self.trace = None if self._level == "none" else Trace(self._level, keep=self._keep)
        if self.trace is not None and (self._listeners or self._recording is not None):
            self.trace.listen(self._hear)
        for text in self._preface:
            self._trace_line(text)
        return self.trace

    def preface(self, text: str) -> None:
        """Adds a line that was printed before the run; it comes first in every trace."""
        self._preface.append(text)

    def _trace_line(self, text: str) -> None:
        if self.trace is not None and self.trace.production:
            run = self.run
            self.trace.emit(0 if run is None else run.now_us() or 0, "model", "output", {"text": text})

    def result(self, time: int, data: dict[str, Any]) -> None:
        """Traces the result of the run, which ended at a time [us]."""
        if self.trace is not None and self.trace.production:
            self.trace.emit(time, "top", "result", plain(data))

    @contextmanager
    def holding(self) -> Generator[None]:
        """Delays events until the end of the block, in which the known future may be cut: only then is it known which events are new."""
        held = self._held = []
        try:
            yield
        finally:
            self._held = None
            for event in held:
                self._hear(event)

    def _hear(self, event: TraceEvent) -> None:
        if self._held is not None:
            self._held.append(event)
            return
        self._events += 1
        recording = self._recording
        if recording is not None and self._events > recording.events:
            recording.event(event)
        if self._listeners and not self.silent:
            self._pass_on(event)

    def _pass_on(self, event: TraceEvent) -> None:
        try:
            with self.stdout.aside():
                for listener in self._listeners:
                    listener(event)
        except Exception as error:  # noqa: BLE001 - raised by `check`, when no event of an agent is half done
            self._failure = self._failure or error

    def check(self) -> None:
        """Raises the first error of a listener since the last check; the run can continue afterwards.

        Raises:
            Exception: That error.
        """
        failure, self._failure = self._failure, None
        if failure is not None:
            raise failure

    def answers(self, tick: int, requests: Sequence[Request], answers: Sequence[Any]) -> None:
        """Records the answers of bodies at the end of a tick."""
        recording, program = self._recording, self._program
        if program is not None and not self.silent:
            for request, answer in zip(requests, answers, strict=True):
                program.answer(tick, request, answer)
        if recording is not None:
            for request, answer in zip(requests, answers, strict=True):
                self._answers += 1
                if self._answers > recording.answers:
                    recording.answer(1, tick, request.body, request.word, answer)

    def state(self, tick: int) -> None:
        """Records the state at the end of a tick, and the contacts since the state before."""
        contacts: Contacts = {} if self._contacts is None else self._contacts.take()
        if self._keeper is not None:
            self._keeper.keep(tick, self._world, contacts)
        if self._recording is not None and tick == self._recording.states:
            self._recording.state(1, tick, self._world.state_bytes(), contacts)
        if self._program is not None and not self.silent:
            self._program.state(tick, self._world, contacts)

    def kept(self, tick: int) -> int:
        """Returns the last tick, at most the given one, whose state the observers have already; without observers, the given one."""
        return tick if self._keeper is None else min(tick, self._keeper.furthest)

    def command(self, command: Command) -> None:
        """Records a new command of a user."""
        if self._recording is not None:
            self._recording.command(1, command.tick, command.to_data())
        if self._program is not None:
            self._program.command(command)

    def cut(self, tick: int, commands: int) -> None:
        """Forgets what came after a tick, because the run continues differently from there."""
        self.stdout.cut()
        if self._keeper is not None:
            self._keeper.cut(tick)
        if self._recording is not None:
            self._recording.cut(tick, self._events, self._answers, commands)
