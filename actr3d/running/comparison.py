"""A run beside its recording: does every byte agree, and where does it first differ?"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from actr3d.actr.answers import plain_answer
from actr3d.actr.limits import EndOfRun
from actr3d.recording import Recorded
from actr3d.recording.writer import State
from actr3d.trace import TraceEvent, top_path


@dataclass(frozen=True, kw_only=True)
class Comparison:
    """What came of running a recording again."""

    ticks: int
    """How many ticks were compared."""
    events: int
    """How many events were compared."""
    difference: str | None
    """Where it first differs; None where every byte agrees."""
    unfinished: int = 0
    """How many events the recording holds of a tick that never came to its end; they were not compared."""

    def __str__(self) -> str:
        if self.difference is not None:
            return f"differs: {self.difference}"
        ticks = f"{self.ticks:,} ticks, " if self.ticks else ""
        rest = f" ({self.unfinished:,} more events of a tick that did not end)" if self.unfinished else ""
        return f"every byte agrees: {ticks}{self.events:,} events{rest}"


class Differs(EndOfRun):
    """Ends a run that has gone another way than the recorded one, or farther."""


class Beside:
    """Compares what a program tells with what is recorded of it, each kind of thing in its order.

    Args:
        recorded: The recording.
    """

    def __init__(self, recorded: Recorded) -> None:
        self._over = "ended" in recorded.facts
        self._recorded: dict[str, Iterator[Any]] = {
            "event": recorded.events(),
            "state": recorded.states(),
            "answer": recorded.answers(),
            "command": recorded.commands(),
        }
        self.counts = dict.fromkeys(self._recorded, 0)
        self._last: Any = None
        self.ticks = 0
        """How many ends of ticks were compared."""
        self.broken_off = False
        """Whether the recording was, at the point that the run has come to."""
        self.difference: str | None = None

    def event(self, event: TraceEvent) -> None:
        """Takes one event of the new run.

        Raises:
            Differs: If it is another than the recorded one, or the recording was broken off before.
        """
        self._take("event", event.to_json(), TraceEvent.to_json, f" at {event.time:g} s")

    def state(self, run: int, tick: int, data: bytes) -> None:
        """Takes the physics at the start of a run, or at the end of a tick.

        Raises:
            Differs: As `event` does.
        """
        self._take("state", _moment(State(run, tick, data, 0)), _moment)
        if self.difference is None and self._last is not None:
            where = f"at the end of {_moment(self._last)}"
            if self._last.data != data:
                self._differ(f"the physics {where}: {first_number(self._last.data, data)}")
            if self._last.events != self.counts["event"]:
                self._differ(f"there were {self._last.events:,} events {where}, and are {self.counts['event']:,} now")
            self.ticks += tick > 0

    def answer(self, run: int, tick: int, body: str, word: str, value: Any) -> None:
        """Takes what a body answered.

        Raises:
            Differs: As `event` does.
        """
        self._take("answer", json.dumps(plain_answer((run, tick, body, word, value))), json.dumps)

    def command(self, run: int, tick: int, data: Mapping[str, Any]) -> None:
        """Takes what a user did.

        Raises:
            Differs: As `event` does.
        """
        self._take("command", json.dumps((run, tick, data)), json.dumps)

    def _take(self, kind: str, now: str, text: Any, where: str = "") -> None:
        """Compares one thing with the recorded one, both as text; keeps that in `_last`."""
        if self.difference is not None:
            return
        then = self._last = next(self._recorded[kind], None)
        if then is None and not self._over:
            self.broken_off = True
            raise Differs
        self.counts[kind] += 1
        line = "nothing" if then is None else text(then)
        if line != now:
            self._differ(f"{kind} {self.counts[kind]}{where}; recorded: {line}; now: {now}")

    def _differ(self, how: str) -> None:
        self.difference = how
        raise Differs

    def rest(self) -> dict[str, int]:
        """Returns how many recorded things of each kind the new run has not come to; none of those it has."""
        left = {kind: sum(1 for _ in things) for kind, things in self._recorded.items()}
        return {kind: count for kind, count in left.items() if count}


def _moment(state: State) -> str:
    return f"tick {state.tick} of {top_path(state.run)}"


def first_number(then: bytes, now: bytes) -> str:
    """Says which number of a state is the first to differ."""
    if len(then) != len(now):
        return f"a state was {len(then)} bytes, and is {len(now)}: another scene"
    was, is_now = np.frombuffer(then), np.frombuffer(now)
    differ = np.flatnonzero(was.view(np.int64) != is_now.view(np.int64))
    first = int(differ[0])
    return f"number {first} of {was.size} was {was[first]!r}, and is {is_now[first]!r}"
