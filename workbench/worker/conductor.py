"""Conducts a run: on, hold, a step, a speed; and shows the server how it goes."""

from __future__ import annotations

import threading
from contextlib import suppress
from time import perf_counter
from typing import Any

import msgspec

from actr3d.actr.kernel.run_limits import EndOfRun
from actr3d.clock import MICROSECONDS, seconds
from actr3d.errors import Actr3dError
from actr3d.trace import Trace
from actr3d.values import to_json
from workbench import protocol as say
from workbench.worker.bounds import bounded_json, event_json
from workbench.worker.conducted import Conducted
from workbench.worker.foreknown import Foreknown, difference_notice
from workbench.worker.link import Link
from workbench.worker.messages import Cut, Do, Draw, Leave, Reply, State, Status, whole
from workbench.worker.names import check_until, lost_breakpoints
from workbench.worker.pacer import Pacer
from workbench.worker.trouble import told_of
from workbench.worker.watch import Watch

SHOWN = 1 / 30
"""How often a run that goes on is shown [s]; ours, as often as a page can be drawn with ease."""
HURRIED = 1 / 15
"""The same of a run that is to go as fast as it can: what is shown takes time from it. Ours."""


class Leaving(EndOfRun):
    """Ends a run because the worker is to leave; no model catches it by `except Exception`."""


class Conductor:
    """Says when a run goes on and when it waits, does what users say meanwhile, and shows its state and events.

    Args:
        link: The wire to the server.
    """

    def __init__(self, link: Link) -> None:
        start = link.start
        self.link = link
        self.status: Status = "running" if start.run else "paused"
        self.reason = "" if start.run else "at its start"
        self.watch = Watch(breakpoints=frozenset(start.breakpoints))
        self.pacer = Pacer(start.factor)
        self.leaving = False
        """Whether the worker is to leave."""
        self.run: Conducted
        link.busy = self.show_busy
        self._sent = 0
        """How many events the server has been given."""
        self._last: State | None = None
        """The state that was shown last."""
        self._foreknown: Foreknown | None = None
        """The recorded run that is lived through again."""
        self._compared = 0
        """So many events have been compared with the recorded ones."""
        self._telling = threading.Lock()
        """Held by the thread that gives events to the server."""
        self._seen = 0
        """How many events have been looked at for what is watched."""
        self._shown = 0.0
        self._drawn: tuple[str, ...] = ()
        """The kinds of overlays that are shown where somebody looks."""

    def conduct(self, run: Conducted) -> None:
        """Takes the run that is to be conducted; its names are known by now."""
        self.run = run
        self.link.events = self._count
        if self.watch.breakpoints:  # else the names need not be looked for
            for lost in lost_breakpoints(self.watch.breakpoints, run.names()):
                self.link.post(lost)

    def know(self, foreknown: Foreknown) -> None:
        """Shows all that a recorded run did, before this run, which lives through it again, has come to it."""
        with self._telling:
            self._foreknown = foreknown
            self._sent = foreknown.count
            self.link.tell(foreknown.first, foreknown.events)
            foreknown.events = []

    @property
    def relives(self) -> bool:
        """Whether the run lives through a recorded one again, and nothing has been changed in it."""
        return self._foreknown is not None

    def embodied(self) -> None:
        """Takes note that the run has a body: it goes at real time, unless a speed was chosen."""
        if self.link.start.real_time:
            self.pacer.set(1.0)

    def _count(self) -> int:
        """Returns how many events there are."""
        trace = self.run.trace
        return 0 if trace is None else len(trace)

    # -- what the run asks

    def attend(self) -> None:
        """Does what users have said meanwhile; while the run is held, waits for more. Returns when it may go on.

        Raises:
            Leaving: If the worker is to leave.
        """
        self._check_events()
        if self.watch.goal is not None and self.run.clock >= self.watch.goal and self.status == "running":
            self.pause(self.watch.goal_reason)
        while True:
            held = self.status != "running"
            message = self.link.receive(None if held else 0)
            if message is None:
                return
            self._hear(message)
            if self.status == "running":
                return

    def pace(self, clock: int) -> bool:
        """Waits until it is time for a moment of the run [us]; tells whether nothing has been said meanwhile."""
        while (early := self.pacer.early(self.run.clock, clock)) > 0:
            self.show_if_due()
            message = self.link.receive(min(early, SHOWN))
            if message is not None:
                self._hear(message)
                return False
        return True

    def passed(self) -> None:
        """Takes note that ticks have passed."""
        self._check_events()
        if self.watch.contact is not None and self.status == "running":
            found = self.watch.touched(self.run.touches())
            if found is not None:
                self.pause(found)
        self.show_if_due()

    def pause(self, reason: str) -> None:
        """Holds the run."""
        self.status, self.reason = "paused", whole(reason)
        self._halt()

    def end(self, status: Status, reason: str) -> None:
        """Takes note that the run is over, and tells what it was to go on for and has not come."""
        trace = self.run.trace
        news = trace.since(self._seen) if trace is not None and self.watch.of_events else []
        missed = (self.watch.found(news) or self.watch.missed) if status == "ended" else ""  # it may come with the very end
        self.status, self.reason = status, whole(f"{reason}; {missed}" if missed else reason)
        self._halt()

    def went_back(self) -> None:
        """Takes note that the run stands at another time, whose events were all known."""
        trace = self.run.trace
        self._seen = 0 if trace is None else len(trace)
        self.status, self.reason = "paused", "went to this time"
        self._halt()

    def goes_another_way(self, events: int, changed: str | None) -> None:
        """Tells the server that what was known of the run after the present moment holds no more.

        Args:
            events: How many events there were until this moment.
            changed: What has become of the run beyond this moment; None where it had not been there.
        """
        with self._telling:
            self._foreknown = None
            if changed is not None and self.status == "paused":
                self.reason = changed
            if changed is not None or events < self._sent:
                self._sent = min(self._sent, events)
                self.link.cut(Cut(events=events), events)

    # -- what users say

    def _hear(self, message: Do | Draw | Leave) -> None:
        if isinstance(message, Leave):
            self.leaving = True
            raise Leaving
        if isinstance(message, Draw):
            self._drawn = message.kinds
            self.show()
            return
        try:
            result = self._do(say.ANYTHING.validate_json(message.say))
        except EndOfRun:
            self.link.post(Reply(id=message.id))
            raise
        except Exception as error:  # noqa: BLE001 - whatever it is, who has said it is told
            self.link.post(Reply(id=message.id, error=told_of(error)))
            return
        self.link.post(Reply(id=message.id, result=to_json(result).encode()))

    def _do(self, said: Any) -> Any:
        match said:
            case say.Run():
                self._go()
            case say.Pause():
                if self.status == "running":
                    self.pause("by the user")
            case say.Step():
                # Steps that come faster than they are made add up.
                under_way = self.status == "running" and self.watch.goal is not None
                begin = (self.watch.goal or 0) if under_way else self.run.clock
                self._go(goal=(begin // self.run.period + said.ticks) * self.run.period, goal_reason="after a step")
            case say.Cycle():
                # As steps do, cycles that are asked for before one is over add up.
                if self.status == "running" and self.watch.cycles > 0 and self.watch.system == said.system:
                    self.watch.cycles += 1
                else:
                    self._go(cycles=1, system=said.system)
            case say.Until():
                self._until(said)
            case say.Breakpoints():
                self.run.names().check_new(said.productions, self.watch.breakpoints)
                self.watch.breakpoints = frozenset(said.productions)
            case say.Speed():
                self.pacer.set(said.factor)
                self.show()
            case say.Explain() | say.Rows() | say.Look() | say.Body() | say.Events() | say.Curves():
                return self.run.answer(said)
            case _:
                self.run.do(said)
                self.show()
        return None

    def _until(self, said: say.Until) -> None:
        wanted = said.model_dump(exclude={"type"}, exclude_none=True)
        if not wanted.keys() - {"pattern"}:
            raise Actr3dError("until what? name a time, a production, a buffer with a pattern, or a contact")
        start, names = self.link.start, self.run.names()
        check_until(said, names, (start.source, *(text for _, text in start.helpers.values())), start.folder)
        goal = None if said.time is None else round(said.time * MICROSECONDS)
        if goal is not None and goal <= self.run.clock:
            raise Actr3dError(f"it is {seconds(self.run.clock):g} s already; a click on the timeline goes back")
        touching = self.run.touches() if said.contact is not None else frozenset[tuple[str, str, str]]()
        self._go(
            goal=goal,
            goal_reason=f"at {said.time} s",
            production=said.production,
            buffer=names.buffer(said.buffer) if said.buffer else None,
            called=said.buffer or "",
            pattern=said.pattern or "",
            contact=said.contact,
            touching=touching,
        )
        self.reason = self.watch.pending
        self.show()

    def _go(self, **wanted: Any) -> None:
        if self.status in ("ended", "failed"):
            raise Actr3dError("the run is over: go back to an earlier time, or begin again")
        self.watch.begin(**wanted)
        trace = self.run.trace
        self._seen = 0 if trace is None else len(trace)
        self.status, self.reason = "running", ""
        self.pacer.halt()
        if "goal" not in wanted:
            self.show()

    def _check_events(self) -> None:
        """Pauses where an event says so that has not been looked at yet."""
        trace = self.run.trace
        if trace is not None and self.status == "running" and self.watch.of_events and len(trace) > self._seen:
            found = self.watch.found(trace.since(self._seen))
            self._seen = len(trace)
            if found is not None:
                self.pause(found)

    # -- what is shown

    def show_if_due(self) -> None:
        """Shows the run now and then while it goes on."""
        now = perf_counter()
        due = HURRIED if self.pacer.factor is None else SHOWN
        if now - self._shown >= due and self.status == "running" and self.link.idle:
            self.show()

    def show(self) -> None:
        """Shows the run as it is now, and all that has happened."""
        run = self.run
        self._shown = perf_counter()
        trace = run.trace
        count = 0 if trace is None else len(trace)
        physics, apertures = run.scene()
        state = State(
            status=self.status,
            reason=self.reason,
            tick=run.clock // run.period,
            time=seconds(run.clock),
            furthest=seconds(max(run.clock, run.furthest)),
            wanted=self.pacer.factor,
            measured=self.pacer.measure(run.clock) if self.status == "running" else None,
            events=count,
            parts=bounded_json(run.parts()),
            apertures=apertures,
            result=bounded_json(run.result() if self.status == "ended" else None),
            physics=physics,
            drawn=run.drawn(self._drawn) if self._drawn else {},
        )
        with self._telling:
            self._tell(state, trace)

    def show_busy(self) -> None:
        """Shows what has happened until the model became busy, as in an endless loop; called by the thread that hears the server.

        Only events and the time are told: parts may be changing just now.
        """
        # Whatever is amiss in a model that is in the middle of something, the thread must go on.
        with suppress(Exception), self._telling:
            trace, last = self.run.trace, self._last
            if last is None or trace is None or self.status != "running" or len(trace) <= self._sent:
                return
            clock = self.run.clock
            time, furthest = seconds(clock), seconds(max(clock, self.run.furthest))
            self._tell(msgspec.structs.replace(last, time=time, furthest=furthest, tick=clock // self.run.period, events=len(trace)), trace)

    def say_all(self) -> None:
        """Records and sends what has happened up to now, from whatever thread of the model: it may be about to end its process."""
        if not self.link.left:  # a copy of the process has nothing to send
            with suppress(Exception):  # there may be no run yet
                self.run.flush()
            self.show_busy()
            self.link.flush()

    def _tell(self, state: State, trace: Trace | None) -> None:
        """Gives the server a state and the events up to it that it does not have."""
        count = state.events
        on_its_thread = threading.current_thread() is threading.main_thread()  # else the run may be in the middle of something
        if self._foreknown is not None and trace is not None and on_its_thread:
            state = self._compare(self._foreknown, state, trace)
        news = [] if trace is None or count <= self._sent else trace.since(self._sent)[: count - self._sent]
        self.link.show(state, self._sent, [event_json(event) for event in news])
        self._sent, self._last = max(self._sent, count), state

    def _compare(self, foreknown: Foreknown, state: State, trace: Trace) -> State:
        """Compares what has happened with the recording; returns the state, which tells of nothing ahead where they differ."""
        events = trace.since(self._compared)[: max(0, state.events - self._compared)]
        found = foreknown.difference(self._compared, events)
        is_over = state.status in ("ended", "failed")
        if found is None and not (is_over and state.events < foreknown.count):
            self._compared = max(self._compared, state.events)
            return state
        self._foreknown = None
        self.run.forget_ahead()
        self._sent = state.events if found is None else found
        self.link.cut(Cut(events=self._sent), self._sent)
        self.link.post(difference_notice(state.time, None if found is None else events[found - self._compared]))
        return msgspec.structs.replace(state, furthest=state.time)

    def _halt(self) -> None:
        self.pacer.halt()
        self.watch.begin()
        self.run.flush()
        self.show()
