"""Controls a run: continues, pauses, steps and paces it as users command, and sends its state to the server."""

from __future__ import annotations

import pickle
import threading
from collections import deque
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from time import perf_counter
from typing import Any

import msgspec

from actr3d.actr.kernel.run_limits import EndOfRun
from actr3d.clock import seconds
from actr3d.errors import Actr3dError
from actr3d.output import ModelOutput
from actr3d.trace import Trace
from actr3d.values import plain_to_json, to_json
from workbench.worker.channel import Channel
from workbench.worker.controlled_run import ControlledRun, FieldError, LossError
from workbench.worker.error_report import describe_error, notice_of
from workbench.worker.known_run import KnownRun, difference_notice
from workbench.worker.messages import (
    ENDED,
    Branched,
    CommandMessage,
    EventsRemoved,
    Leave,
    Reply,
    SetOverlays,
    State,
    Status,
    Unrecorded,
    shortened,
)
from workbench.worker.names import lost_breakpoints
from workbench.worker.pacer import Pacer
from workbench.worker.stop_conditions import StopConditions
from workbench.worker.truncation import bounded_json, event_json

SHOWN = 1 / 30
"""Interval at which the state of a running run is sent [s]. Chosen here: pages can easily draw at this rate."""
HURRIED = 1 / 10
"""The same interval for a run without a speed limit, which sending slows down [s]. Chosen here."""


class Leaving(EndOfRun):
    """Ends a run because the worker must end; a model's `except Exception` does not catch it."""


class RunController:
    """Decides when a run continues and when it waits, carries out users' commands in between, and sends its state and events."""

    def __init__(self, channel: Channel) -> None:
        start = channel.start
        self.channel = channel
        self.status: Status = "running" if start.run else "paused"
        self.reason = "" if start.run else "at its start"
        self.watch = StopConditions(breakpoints=frozenset(start.breakpoints))
        self._breakpoint: str | None = None
        """The production at whose breakpoint the run was paused; None for another reason."""
        self.pacer = Pacer(start.factor)
        self.leaving = False
        """Whether the worker must end."""
        self.run: ControlledRun
        self.errors: ModelOutput | None = None
        """The model's standard error."""
        channel.busy = self.show_busy
        self._sent = 0
        """Number of events that the server has been sent."""
        self._last: State | None = None
        """The state that was sent last."""
        self._known_run: KnownRun | None = None
        """The recorded run that this run repeats; None if there is none, or this run differs from it."""
        self._compared = 0
        """Number of events that have been compared with the recorded ones."""
        self._sending = threading.Lock()
        """Held by the thread that sends events to the server."""
        self._reached = 0
        """The time that the run had reached when it went back [us]: until then it repeats itself."""
        self._seen = 0
        """Number of events that have been checked against the stop conditions."""
        self._interrupted = False
        """Whether the run has something to do although it is paused."""
        self._shown = 0.0
        self._later: deque[CommandMessage] = deque()
        """Commands that have arrived during a seek, and wait for its end."""
        self._unanswered: list[int] = []
        """The commands that have begun a seek: the next state answers them."""
        self._overlays: tuple[str, ...] = ()
        """The kinds of overlays to compute; empty if no browser shows the 3D view."""

    def set_run(self, run: ControlledRun) -> None:
        """Sets the run to control; its names are known by now."""
        self.run = run
        self.channel.events = lambda: len(run.trace)
        if self.watch.breakpoints:  # without breakpoints, no names need to be collected
            for lost in lost_breakpoints(self.watch.breakpoints, run.names()):
                self.channel.post(lost)

    def repeat_recorded(self, known_run: KnownRun) -> None:
        """Sends all events of a recorded run, which this run repeats, before this run has reached them."""
        with self._sending:
            self._known_run = known_run
            self.run.repeat_recorded(known_run)
            self._sent = known_run.count
            self.channel.send_events(known_run.first, known_run.events)
            known_run.events = []

    @property
    def repeats_recording(self) -> bool:
        """Whether the run repeats a recorded one and still agrees with it."""
        return self._known_run is not None

    @property
    def catches_up(self) -> bool:
        """Whether the run, after going back, is still before the furthest time that it had reached."""
        return self._reached > 0 and self.run.clock < self._reached

    def use_real_time(self) -> None:
        """Sets real time for a run with a body, unless a user has chosen a speed."""
        if self.channel.start.real_time:
            self.pacer.set(1.0)

    # -- calls from the run

    def attend(self, *, wait: bool = True) -> None:
        """Carries out the commands that have arrived; while the run is paused, waits for more. Returns when it may continue.

        Args:
            wait: Whether it waits; otherwise the run may still be paused when it returns.

        Raises:
            Leaving: If the worker must end.
        """
        self._check_events()
        if self.watch.goal is not None and self.run.clock >= self.watch.goal and self.status == "running":
            self.pause(self.watch.goal_reason)
        while True:
            if self._interrupted:
                self._interrupted = False
                return
            held = wait and self.status != "running"
            message = self._receive(None if held else 0)
            if message is None:
                return
            self._hear(message)
            if self.status == "running" and not self._interrupted:
                return

    def _receive(self, timeout: float | None) -> CommandMessage | SetOverlays | Leave | None:
        """Returns the next command; None if none arrives within the timeout [s]. Without a timeout, it waits."""
        return self._later.popleft() if self._later else self.channel.receive(timeout)

    def begin_seek(self, reason: str) -> None:
        """Begins a seek to another time; a short one is not shown."""
        self.status, self.reason = "running", reason
        self._shown = perf_counter()

    def attend_seek(self, *, cancellable: bool) -> None:
        """Sends at intervals how far a seek has come, and carries out commands that cancel it.

        Other commands wait until the run is there.
        """
        if perf_counter() - self._shown < HURRIED:
            return
        self._seen = len(self.run.trace)  # stop conditions are for what happens after it
        self.show()
        while self.status == "running" and (message := self.channel.receive(0)) is not None:
            if isinstance(message, CommandMessage) and not (cancellable and pickle.loads(message.command).cancels_seek):
                self._later.append(message)
            else:
                self._hear(message)

    def interrupt(self) -> None:
        """Ends the present wait of a paused run, which has something to do at its present moment."""
        self._interrupted = True

    def pace(self, clock: int) -> bool:
        """Waits until a moment of the run [us] is due; returns False if a command arrived in the meantime."""
        while (early := self.pacer.early(self.run.clock, clock)) > 0:
            self.show_if_due()
            message = self._receive(min(early, SHOWN))
            if message is not None:
                self._hear(message)
                return False
        return True

    def after_ticks(self) -> None:
        """Checks the stop conditions after some ticks have been run, and sends the state if due."""
        self._check_events()
        if self.watch.contact is not None and self.status == "running":
            found = self.watch.touched(self.run.touches())
            if found is not None:
                self.pause(found)
        self.show_if_due()

    def pause(self, reason: str, at_breakpoint: str | None = None) -> None:
        """Pauses the run; `at_breakpoint` is the production whose breakpoint it has met, if it has."""
        self.status, self.reason, self._breakpoint = "paused", shortened(reason), at_breakpoint
        self._halt()

    def end(self, status: Status, reason: str) -> None:
        """Records the end of the run; the reason names the stop condition that was not met, if any."""
        self._finish_errors()
        news = self.run.trace.since(self._seen) if self.watch.of_events else []
        missed = (self.watch.found(news) or self.watch.missed) if status == "ended" else ""  # the condition may be met at the very end
        self.status, self.reason = status, shortened(f"{reason}; {missed}" if missed else reason)
        self._halt()

    def _finish_errors(self) -> None:
        """Sends a last line of standard error without a line break."""
        if self.errors is not None and self.run.clock <= self._reached and self._reached > 0:
            self.errors.lines.forget()  # it was sent when the run was here before
        elif self.errors is not None:
            self.errors.finish()

    def went_back(self, reason: str = "went to this time") -> None:
        """Records that the run is now at another time, whose events were all known, and why."""
        self._seen = len(self.run.trace)
        self.status, self.reason, self._breakpoint = "paused", reason, None
        self._halt()

    def continue_differently(self, events: int, changed: str, *, ahead: bool) -> None:
        """Informs the server that the known future after the present moment is no longer valid.

        Args:
            events: Number of events up to this moment.
            changed: What was done, and what happened to the later part of the run.
            ahead: Whether there was a later part.
        """
        with self._sending:
            if self.status == "paused":
                self.reason, self._breakpoint = changed, None
            if ahead:
                self._reached = 0
            if ahead or events < self._sent:
                self._sent = min(self._sent, events)
                self._cut(events)

    def _cut(self, events: int) -> None:
        """Removes what was known of the events from a number on."""
        self.run.cut_events(events)
        self.channel.cut(EventsRemoved(events=events), events)

    def leave_recording(self, at: float, until: float) -> None:
        """Makes the run, which has repeated a recording, a branch of it: what follows is kept in the run's own recording.

        Args:
            at: The moment from which the run differs from the recording, or goes beyond it [s].
            until: The furthest time that was known of it [s].
        """
        facts = {} if self._known_run is None else self._known_run.facts
        self._known_run = None
        recording = Path(self.channel.start.recorded or "").stem
        before = [[facts["origin"], facts["branched"]], *facts.get("ancestors", ())] if facts.get("origin") else []
        self.give_up_recording()
        # First, as pages list recordings again when they hear of the branch.
        self.run.become_branch(facts.get("named", recording), at, before)
        self.channel.post(Branched(recording=recording, at=at, until=until))

    def give_up_recording(self) -> bool:
        """Goes on without a recording if it cannot be written, and says so. Returns whether that is so."""
        failure = self.run.give_up_recording()
        if failure is not None:
            self.channel.post(notice_of(failure))
            self.channel.post(Unrecorded())
        return failure is not None

    # -- commands from users

    def _hear(self, message: CommandMessage | SetOverlays | Leave) -> None:
        if isinstance(message, Leave):
            self.leaving = True
            raise Leaving
        if isinstance(message, SetOverlays):
            self._overlays = message.kinds
            self.show()
            return
        try:
            result = pickle.loads(message.command).carry_out(self)
        except EndOfRun:
            self._unanswered.append(message.id)
            raise
        except Exception as error:  # noqa: BLE001 - any error is reported to the sender
            field = error.field if isinstance(error, FieldError) else None
            self.channel.post(Reply(id=message.id, error=describe_error(error), loses=isinstance(error, LossError), field=field))
            return
        self.channel.post(Reply(id=message.id, result=to_json(result).encode()))

    def go(self, **wanted: Any) -> None:
        """Continues the run.

        Args:
            wanted: The conditions at which it stops; see `StopConditions`.

        Raises:
            Actr3dError: If the run is over.
        """
        self._check_goes_on()
        self.watch = self.watch.renewed(**wanted)
        self._seen = len(self.run.trace)
        self.status, self.reason = "running", ""
        self.pacer.halt()
        if "goal" not in wanted:
            self.show()

    def go_to(self, time: int) -> None:
        """Goes to another time of the run [us].

        Raises:
            Actr3dError: If the run has not been there.
        """
        self._reached = max(self._reached, self.run.clock)
        self.run.take_events()  # the trace ends at the other time
        self.run.go_to(time)
        self.show()

    def change(
        self, word: str, values: tuple[Any, ...], named: Mapping[str, Any] | None = None, body: str | None = None, *, drop: bool = False
    ) -> None:
        """Sends the running simulation a command; see `ControlledRun.change`.

        Raises:
            Actr3dError: If the run is over.
            Exception: If it cannot be carried out.
        """
        self._check_goes_on()
        self._reached = max(self._reached, self.run.clock)
        self.run.change(word, values, named or {}, body, drop=drop)
        self.show()

    def _check_goes_on(self) -> None:
        """Raises an error if the run is over at the present moment."""
        if self.status in ENDED:
            raise Actr3dError("the run is over: go back to an earlier time, or restart it")

    def undo(self, *, drop: bool) -> None:
        """Undoes the last change by hand up to now; see `ControlledRun.undo`.

        Raises:
            Exception: If it cannot be undone.
        """
        self._reached = max(self._reached, self.run.clock)
        self.run.undo(drop=drop)
        self.show()

    def _check_events(self) -> None:
        """Pauses the run if a new event meets a stop condition."""
        trace = self.run.trace
        if self.status == "running" and self.watch.of_events and len(trace) > self._seen:
            found = self.watch.found(trace.since(self._seen))
            self._seen = len(trace)
            if found is not None:
                self.pause(found, self.watch.met)

    # -- what is sent to the server

    def show_if_due(self, *, hurried: bool = False) -> None:
        """Sends the state at regular intervals while the run is going on.

        Args:
            hurried: Whether the run goes as fast as possible, whatever speed is set.
        """
        now = perf_counter()
        due = HURRIED if hurried or self.pacer.factor is None else SHOWN
        if now - self._shown >= due and self.status == "running" and self.channel.idle:
            self.show()

    def show(self) -> None:
        """Sends the current state of the run and all new events."""
        run = self.run
        self._shown = perf_counter()
        trace = run.trace
        count = len(trace)
        physics, apertures = run.scene()
        shown = run.shown
        state = State(
            status=self.status,
            reason=self.reason,
            breakpoint=self._breakpoint if self.status == "paused" else None,
            tick=run.clock // run.period,
            time=seconds(run.clock),
            furthest=seconds(max(run.clock, run.furthest)),
            target=None if run.target is None or self.status != "running" else seconds(run.target),
            wanted=self.pacer.factor,
            measured=self.pacer.measure(run.clock) if self.status == "running" else None,
            events=count,
            parts=bounded_json(run.parts(), whole=plain_to_json),
            apertures=apertures,
            parameters=bounded_json(run.changed_parameters()),
            result=bounded_json(shown.result() if shown is not None and self.status == "ended" else None),
            physics=physics,
            overlay_data=shown.overlay_data(self._overlays) if shown is not None and self._overlays else {},
        )
        with self._sending:
            self._send(state, trace)
        while self._unanswered:
            self.channel.post(Reply(id=self._unanswered.pop()))

    def show_busy(self) -> None:
        """Sends what happened before the model became busy, for example in an endless loop; the thread that listens to the server calls it.

        Only events and the time are sent: the parts may be changing at this moment.
        """
        # The model may be in an inconsistent state, and this thread must go on in any case.
        with suppress(Exception), self._sending:
            trace, last = self.run.trace, self._last
            if last is None or self.status != "running" or len(trace) <= self._sent:
                return
            clock = self.run.clock
            time, furthest = seconds(clock), seconds(max(clock, self.run.furthest))
            self._send(msgspec.structs.replace(last, time=time, furthest=furthest, tick=clock // self.run.period, events=len(trace)), trace)

    def send_all(self, ends: bool) -> None:
        """Records and sends all events until now, from any thread of the model, as it may be about to end its process.

        Args:
            ends: Whether it surely ends: then a line without a line break is sent, too.
        """
        if not self.channel.left:  # a forked copy of the process has nothing to send
            with suppress(Exception):  # there may be no run yet
                if ends:
                    self._finish_errors()
                    self.run.finish_output()
                self.run.flush()
            self.show_busy()
            self.channel.flush()

    def _send(self, state: State, trace: Trace) -> None:
        """Sends the server a state, and the events up to it that it does not have yet."""
        count = state.events
        on_its_thread = threading.current_thread() is threading.main_thread()  # otherwise the run may be in the middle of a tick
        if self._known_run is not None and on_its_thread:
            state = self._compare(self._known_run, state, trace)
        news = self.run.events(self._sent, count)
        self.channel.show(state, self._sent, [event_json(event) for event in news])
        self._sent, self._last = max(self._sent, count), state

    def _compare(self, known_run: KnownRun, state: State, trace: Trace) -> State:
        """Compares new events with the recording; if they differ, returns the state without any time ahead."""
        events = trace.since(self._compared)[: max(0, state.events - self._compared)]
        found = known_run.difference(self._compared, events)
        is_over = state.status in ENDED
        known = seconds(known_run.time)
        if found is None and not (is_over and state.events < known_run.count):
            self._compared = max(self._compared, state.events)
            if self.run.clock > known_run.time and not is_over:
                self.leave_recording(known, known)
            return state
        self.run.forget_ahead()
        self._sent = state.events if found is None else found
        self._cut(self._sent)
        different = None if found is None else self.run.events(found, found + 1)[0]
        self.leave_recording(state.time if different is None else min(known, seconds(different.time_us)), known)
        self.channel.post(difference_notice(state.time, different))
        return msgspec.structs.replace(state, furthest=state.time)

    def _halt(self) -> None:
        self.pacer.halt()
        self.watch = self.watch.renewed()
        self.run.flush()
        self.show()
