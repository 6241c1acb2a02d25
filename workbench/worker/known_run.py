"""Holds what a recorded run did, for a run that repeats it: its events and their curves, its duration, and its physics."""

from __future__ import annotations

import zlib
from array import array
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import msgspec

from actr3d.clock import microseconds, seconds
from actr3d.recording import Recorded
from actr3d.recording.writer import State as RecordedState
from actr3d.trace import TraceEvent
from workbench.event_curves import EventCurves
from workbench.event_log import MAX_EVENTS
from workbench.program_time import events_both_ways
from workbench.time_text import time_text
from workbench.worker.messages import Notice, notice
from workbench.worker.truncation import event_json

BLOCK = 5_000
"""The number of events that are compressed together."""
_EVENT = msgspec.json.Decoder(tuple[int, str, str, Any])


class KnownRun:
    """Reads a recording and compares events with it.

    Args:
        path: The recording.
        keep: Called with the physics state at the end of each tick.

    Raises:
        RecordingError: If the recording cannot be read.
    """

    def __init__(self, path: Path, keep: Callable[[RecordedState], object] | None = None) -> None:
        self._digests = array("q")
        """A hash of each event."""
        self.events: list[bytes] = []
        """The last events, as JSON for pages."""
        self._blocks: list[bytes] = []
        """All events as JSON for pages, a compressed text for every `BLOCK` of them."""
        block: list[bytes] = []
        self.event_curves = EventCurves()
        """The curves of all its events."""
        with Recorded(path) as recorded:
            self.facts: dict[str, Any] = recorded.facts
            self.ticks: int = recorded.ticks
            time = 0
            for event, timed in events_both_ways(recorded):
                time = max(time, timed.time_us)
                self._take(event, timed, block)
            self._blocks.append(_compressed(block))
            if keep is not None:
                for state in recorded.states():
                    keep(state)
        self.time = max(time, microseconds(self.facts.get("reached", 0)), self.ticks * self.facts.get("period_us", 0))
        """The duration of the recording, summed over all its runs [us]."""

    @property
    def count(self) -> int:
        """The number of events in the recording."""
        return len(self._digests)

    @property
    def first(self) -> int:
        """The number of the first event in `events`."""
        return self.count - len(self.events)

    def _take(self, event: TraceEvent, timed: TraceEvent, block: list[bytes]) -> None:
        self.event_curves.take([timed])
        text = event_json(event)
        self._digests.append(hash(text))
        self.events.append(text if timed == event else event_json(timed))
        block.append(self.events[-1])
        if len(block) == BLOCK:
            self._blocks.append(_compressed(block))
            block.clear()
        if len(self.events) > 2 * MAX_EVENTS:
            del self.events[:-MAX_EVENTS]

    def between(self, first: int, end: int) -> list[tuple[int, str, str, Any]]:
        """Returns the events from a number on and before another one, as pages show them: time [us], source, kind, data."""
        blocks = self._blocks[first // BLOCK : -(-end // BLOCK)]
        lines = [line for block in blocks for line in zlib.decompress(block).splitlines()]
        before = first // BLOCK * BLOCK
        return [_EVENT.decode(line) for line in lines[first - before : end - before]]

    def difference(self, number: int, events: Sequence[TraceEvent]) -> int | None:
        """Returns the number of the first event, of those from this number on, that differs from the recorded one; None if all agree."""
        known = zip(self._digests[number : number + len(events)], events, strict=False)
        return next((n for n, (digest, event) in enumerate(known, number) if hash(event_json(event)) != digest), None)


def _compressed(events: Sequence[bytes]) -> bytes:
    return zlib.compress(b"\n".join(events), level=1)


def difference_notice(now: float, event: TraceEvent | None) -> Notice:
    """Returns the notice that a run differs from its recording.

    Args:
        now: The current time of the run [s].
        event: The event that differs, with the time of the run; None if the run has ended before its recording.
    """
    when = now if event is None else seconds(event.time_us)
    does = (
        "it ends, but the recording continues"
        if event is None
        else f"it has the event '{event.kind}' of '{event.source}', which the recording does not have"
    )
    text = (
        f"from {time_text(when)} on this run differs from its recording, perhaps because versions or files differ: {does}. "
        "What is shown from there on is what happens now; «Replay» in the tab Runs compares everything."
    )
    return notice("error", text)
