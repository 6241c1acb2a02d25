"""The time of a program: that of all its runs, one after the other. In recordings, the time of each run starts at 0."""

from __future__ import annotations

from array import array
from bisect import bisect_left, bisect_right
from collections import defaultdict
from collections.abc import Iterator
from itertools import chain, repeat
from struct import error as StructError  # noqa: N812 - it is a class
from struct import unpack_from
from typing import Any

from actr3d.clock import MICROSECONDS, seconds
from actr3d.errors import RecordingError
from actr3d.recording import Recorded
from actr3d.recording.writer import State
from actr3d.runner.program_changes import USER, of_user
from actr3d.trace import TraceEvent


def timed_events(recorded: Recorded) -> Iterator[TraceEvent]:
    """Yields the events of a recording; those of a program with their times since its start, as a run in the workbench shows them.

    Raises:
        RecordingError: If the recording is damaged.
    """
    return (timed for _, timed in events_both_ways(recorded))


def events_both_ways(recorded: Recorded) -> Iterator[tuple[TraceEvent, TraceEvent]]:
    """Yields each event with its recorded time, and with the time that `timed_events` gives it.

    Raises:
        RecordingError: If the recording is damaged.
    """
    if recorded.facts.get("kind") != "program":
        yield from ((event, event) for event in recorded.events())
        return
    for thing, time in timed(recorded):
        if isinstance(thing, TraceEvent):
            yield thing, TraceEvent(time, *thing[1:])


def user_commands(recorded: Recorded) -> Iterator[tuple[float, dict[str, Any]]]:
    """Yields the time [s] and the data of each command of a user; those that a program gives its simulations itself are left out.

    Raises:
        RecordingError: If the recording is damaged.
    """
    if recorded.facts["kind"] != "program":
        period = recorded.facts.get("period_us", 0)
        yield from ((seconds(tick * period), data) for _, tick, data in recorded.commands())
    elif of_user(recorded.commands()):
        yield from (
            (event.time, event.data) for event in timed_events(recorded) if event.kind == "command" and event.data.get("by") == USER
        )


def timed(recorded: Recorded) -> Iterator[tuple[TraceEvent | State, int]]:
    """Yields the events and the states of a program in their order, each with the time since the start of the program [us].

    Raises:
        RecordingError: If the recording is damaged.
    """
    clock = _Clock()
    states = chain(recorded.states(), repeat(None))
    state = next(states)
    for number, event in enumerate(chain(recorded.events(), repeat(None))):
        while state is not None and (event is None or state.events <= number):
            yield state, clock.advance(state.run, _time_of(state.data))
            state = next(states)
        if event is None:
            return
        yield event, clock.at(event)


def _time_of(state: bytes) -> int:
    """Returns the time at the start of a physics state [us]."""
    try:
        (time,) = unpack_from("d", state)
        return round(time * MICROSECONDS)
    except (StructError, ValueError, OverflowError):  # too short, or no finite number
        raise RecordingError("a state has no time") from None


class _Clock:
    """Adds up the times of a program's runs."""

    def __init__(self) -> None:
        self._now = 0
        self._reached: defaultdict[int, int] = defaultdict(int)
        """The time of each run, by number [us]."""
        self._latest = 1
        """The number of the run that has begun last; its time is that of output."""

    def advance(self, run: int, time: int) -> int:
        """Advances a run to its own time [us]; returns the time of the program."""
        passed = max(0, time - self._reached[run])
        self._reached[run] += passed
        self._now += passed
        return self._now

    def at(self, event: TraceEvent) -> int:
        """Returns the time of the program at an event [us]."""
        if event.kind == "start":
            self._latest = event.run
        return self.advance(self._latest if event.kind == "output" else event.run, event.time_us)


class RunTimes:
    """Converts between the time of one run, which starts at 0, and the time of its program. While another run goes on, only the time of
    the program passes."""

    def __init__(self) -> None:
        self.own = 0
        """The time of the run at its last event [us]."""
        self.program = 0
        """The time of the program at this event [us]."""
        self._own = array("q")
        """When the run began, and when it went on after other runs: the time of the run [us]."""
        self._program = array("q")
        """The same moments: the time of the program [us]."""

    def add(self, own: int, program: int) -> None:
        """Adds the two times of the next event of the run [us]."""
        if not self._own or program - own != self._program[-1] - self._own[-1]:
            self._own.append(self.own)
            self._program.append(self.own + program - own)
        self.own, self.program = own, program

    def own_at(self, program: int) -> tuple[int, int] | None:
        """Returns the time of the run at a time of the program; None if the run had not begun.

        Returns:
            The time that the run had reached, at most that of its last event, and how much of the program's time has passed since [us].
        """
        place = bisect_right(self._program, program)
        if place == 0:
            return None
        own = self._own[place - 1] + program - self._program[place - 1]
        reached = min(own, self.own if place == len(self._own) else self._own[place])
        return reached, own - reached

    def program_at(self, own: int) -> int:
        """Returns the time of the program at a time of the run [us]; the run has had an event."""
        place = max(1, bisect_left(self._own, own))
        return self._program[place - 1] + own - self._own[place - 1]
