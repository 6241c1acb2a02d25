"""Compares a replay with its recording, and finds the first difference."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from threading import RLock
from typing import Any, TypeVar

from actr3d.actr.kernel.run_limits import Contacts, EndOfRun
from actr3d.actr.modules.answers import plain_answer
from actr3d.clock import seconds
from actr3d.forks import detach_in_copies
from actr3d.recording import Recorded
from actr3d.trace import TraceEvent, top_path

Thing = TypeVar("Thing")
INTERRUPTED = {"by": "error", "error": KeyboardInterrupt.__name__}
"""The data of the event `stop` of a run that the user interrupted (Ctrl-C)."""


@dataclass(frozen=True, kw_only=True)
class Comparison:
    """Where a replay first differs from its recording."""

    ticks: int
    """How many ticks were compared."""
    events: int
    """How many events were compared."""
    difference: str | None
    """Where it first differs; None where every byte agrees, as far as the recording goes."""
    to_its_end: bool = True
    """Whether the run was compared to its end; False where the recording says that it was left, interrupted or failed before."""
    notes: tuple[str, ...] = ()
    """How the recorded run ended before its end, and what cannot be checked by running it again."""
    unfinished: int = 0
    """The number of recorded events after the last complete tick; they were not compared."""

    def __str__(self) -> str:
        if self.difference is not None:
            return f"differs: {self.difference}"
        counts = f"{self.ticks:,} ticks, {self.events:,} events" if self.ticks else f"{self.events:,} events"
        rest = f" ({self.unfinished:,} more events of a tick that did not end)" if self.unfinished else ""
        head = "every byte agrees" if self.to_its_end else "agrees up to the end of the recording"
        return "; ".join((f"{head}: {counts}{rest}", *self.notes))


class Differs(EndOfRun):
    """Ends a replay that differs from the recorded run, or goes further."""


class Comparator:
    """Compares a run with a recording, in place of the run's recorder: facts, events, states, answers and commands, each in order.

    A program may use it in several threads.

    Args:
        recorded: The recording.
        open_end: Whether the run may do more than is recorded, because it was interrupted.
    """

    def __init__(self, recorded: Recorded, *, open_end: bool = False) -> None:
        self._open_end = open_end
        self._period: int | None = recorded.facts.get("period_us")
        self._events, self._states = recorded.events(), recorded.states()
        self._answers, self._commands = recorded.answers(), recorded.commands()
        self.events = self.states = self.answers = self.commands = 0
        """How many of each it has taken."""
        self.ticks = 0
        """How many ends of ticks were compared."""
        self.ended_first = False
        """Whether the recording ended before the replay did, which is allowed for an interrupted run (`open_end`)."""
        self.interrupted = False
        """Whether the recording ended where the user interrupted the program (`open_end`): what it did after that cannot be repeated."""
        self.went_on = False
        """Whether the program went on with another run after that."""
        self.difference: str | None = None
        self._unreadable: Exception | None = None
        """Why the recording can no longer be read."""
        self._comparing = RLock()
        self.facts: dict[str, Any] = {}
        """The facts of the new run; compared when it is over."""
        self._detached = False
        detach_in_copies(self)

    def detach(self) -> None:
        """Stops comparing: this is a forked copy of the process, whose events were not recorded."""
        self._detached = True

    def fact(self, name: str, value: Any) -> None:
        """Compares a fact of the new run."""
        self.facts[name] = value

    def event(self, event: TraceEvent) -> None:
        """Compares an event of the new run.

        Raises:
            Differs: If it is another than the recorded one, or the recording ends before.
        """
        if self._detached:
            return
        with self._comparing:
            self._event(event)

    def _event(self, event: TraceEvent) -> None:
        then = self._next(self._events)
        if self._open_end and then is not None and then.kind == "stop" and then.data == INTERRUPTED:
            self.ended_first = self.interrupted = True
            raise Differs
        self.events += 1
        self._compare(f"event {self.events} at {event.time:g} s", None if then is None else then.to_json(), event.to_json())

    event_alone = event
    """For a program that may record only events."""

    def state(self, run: int, tick: int, data: bytes, contacts: Contacts) -> None:
        """Compares the physics at the start of a run, or at the end of a tick, and the contacts in that tick.

        Raises:
            Differs: As `event` does.
        """
        if self._detached:
            return
        with self._comparing:
            self._state(run, tick, data, contacts)

    def _state(self, run: int, tick: int, data: bytes, contacts: Contacts) -> None:
        then = self._next(self._states)
        self.states += 1
        recorded = None if then is None else self._moment(then.run, then.tick)
        moment = self._moment(run, tick)
        self._compare(f"state {self.states}", recorded, moment)
        if then is None:
            return
        if then.data != data:
            self._differ(f"the physics at the end of {moment}: {first_number(then.data, data)}")
        self._compare(f"contacts in {moment}", _listed(then.contacts), _listed(contacts))
        if then.events != self.events:
            self._differ(f"events up to the end of {moment}; recorded: {then.events:,}; now: {self.events:,}")
        self.ticks += tick > 0

    def answer(self, run: int, tick: int, body: str, word: str, value: Any) -> None:
        """Compares the answer of a body.

        Raises:
            Differs: As `event` does.
        """
        if self._detached:
            return
        with self._comparing:
            then = self._next(self._answers)
            self.answers += 1
            now = json.dumps(plain_answer((run, tick, body, word, value)))
            self._compare(f"answer {self.answers}", None if then is None else json.dumps(then), now)

    def command(self, run: int, tick: int, data: Mapping[str, Any]) -> None:
        """Compares a command of a user.

        Raises:
            Differs: As `event` does.
        """
        if self._detached:
            return
        with self._comparing:
            then = self._next(self._commands)
            self.commands += 1
            self._compare(f"command {self.commands}", None if then is None else json.dumps(then), json.dumps((run, tick, data)))

    def _next(self, things: Iterator[Thing]) -> Thing | None:
        """Returns the next recorded thing of a kind; None where there is none.

        Raises:
            Differs: If there is none, and need not be; or if the run differed before.
        """
        if self.difference is not None or self.ended_first:
            raise Differs
        try:
            then = next(things, None)
        except Exception as error:
            self._unreadable = error  # the program may catch it
            raise
        if then is None and self._open_end:
            self.ended_first = True
            raise Differs
        return then

    def _compare(self, what: str, then: str | None, now: str) -> None:
        if then != now:
            self._differ(f"{what}; recorded: {then or 'nothing'}; now: {now}")

    def _differ(self, how: str) -> None:
        self.difference = how
        raise Differs

    def _moment(self, run: int, tick: int) -> str:
        where = top_path(run)
        if self._period is None:
            return f"tick {tick} of {where}"
        return f"tick {tick} ({seconds(tick * self._period):g} s)" + (f" of {where}" if run != 1 else "")

    def rest(self) -> dict[str, int]:
        """Returns how many recorded items of each kind the replay has not reached; kinds that are complete are left out.

        Raises:
            RecordingError: If the recording could not be read further at some point, so that not everything was compared.
        """
        if self._unreadable is not None:
            raise self._unreadable
        things = {"event": self._events, "state": self._states, "answer": self._answers, "command": self._commands}
        left = dict.fromkeys(things, 0)
        for kind, more in things.items():
            for thing in more:
                left[kind] += 1
                self.went_on |= self.interrupted and isinstance(thing, TraceEvent) and thing.kind == "start"
        return {kind: count for kind, count in left.items() if count}


def _listed(contacts: Contacts) -> str:
    return json.dumps([(*contact, force) for contact, force in contacts.items()])


def first_number(then: bytes, now: bytes) -> str:
    """Returns a text that names the first number of a state that differs."""
    if len(then) != len(now):
        return f"the size of a state, so that of the scene; recorded: {len(then)} bytes; now: {len(now)}"
    import numpy as np  # a program without a world does without it

    was, is_now = np.frombuffer(then), np.frombuffer(now)
    differ = np.flatnonzero(was.view(np.int64) != is_now.view(np.int64))
    first = int(differ[0])
    return f"number {first} of {was.size}; recorded: {was[first]!r}; now: {is_now[first]!r}"
