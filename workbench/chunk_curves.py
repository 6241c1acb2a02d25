"""Computes the curves of the activations of chosen chunks: at each tick of the known run, from its events.

Nothing is recorded for them, and nothing is computed for a chunk that no page plots.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from actr3d.actr.declarative.memory import Memory
from actr3d.actr.declarative.spreading import DMSpreading
from actr3d.actr.explain.memory_table import named_modules, part_now
from actr3d.actr.explain.past_activation import PARAMETERS, NotComputableError, PastMemory, computed_parts
from actr3d.actr.kernel.buffer import Buffer
from actr3d.actr.kernel.tracing import chunk_text
from actr3d.clock import seconds
from actr3d.trace import run_of
from workbench.curves import stride
from workbench.event_curves import EventCurves, LoggedEvent, part_name

SUFFIX = " over time"
"""The end of the names of these curves: `memory: item:cup base level over time`. Other curves of activations have values at retrievals."""
MOST = 1_000
"""Maximum number of values of a curve in an answer: computing more would delay commands."""
CURSORS = 2
"""How many moments up to which the events have been taken are kept: the newest one, and one before it."""


def offered(memory: Memory) -> dict[str, Any]:
    """Returns which curves there are of each chunk of a memory: `curves`, the ends of their names, the activation first; and `why`, a
    sentence about what cannot be computed, which may be empty."""
    parts, whole, why = computed_parts(memory)
    return {"curves": [f"{name}{SUFFIX}" for name in [*([whole] if whole else []), *map(part_name, parts)]], "why": why}


@dataclass
class _Cursor:
    """A memory at a past moment.

    Attributes:
        past: The memory, after the first `taken` events.
        time: The time of the run up to which events were taken [us].
    """

    past: PastMemory
    taken: int = 0
    time: int = -1


@dataclass
class _Known:
    """The settings, the buffers and the events of a memory.

    Attributes:
        settings: The parameters of its modules.
        buffers: Its source buffers, by source.
        events: Its events and those of its buffers, in order.
        read: By source, how many of its events are among them.
        why: Why its past activations cannot be computed; empty if they can.
    """

    memory: Memory
    settings: str
    buffers: dict[str, Buffer]
    events: list[LoggedEvent] = field(default_factory=list[LoggedEvent])
    read: dict[str, int] = field(default_factory=dict[str, int])
    cursors: list[_Cursor] = field(default_factory=list[_Cursor])
    why: str = ""


class ChunkCurves:
    """The curves of the chunks of a run.

    Args:
        events: The events of the run.
        period: Length of a tick [us].
    """

    def __init__(self, events: EventCurves, period: int) -> None:
        self.of = events
        self._period = period
        self._known: dict[str, _Known] = {}
        """By the name of the memory."""

    def sampled(self, names: Sequence[str], first: int, last: int, most: int, parts: Mapping[str, Any], present: int) -> dict[str, Any]:
        """Returns the curves among `names` as `EventCurves.sampled` does, `events`, and their `basis`: if this text differs from that of
        an earlier answer, the values of that answer are no longer valid.

        Args:
            names: The names of the curves, which end with `SUFFIX`.
            first: Start of the interval [us].
            last: Its end, included [us].
            most: Maximum number of values of a curve.
            parts: The present parts of the run, by name.
            present: How many events the run has had up to the present.
        """
        self._look(parts)
        found: dict[str, Any] = {}
        basis: list[str] = []
        for source, known in self._known.items():
            chosen = _chosen(known.memory, source, names)
            if not chosen:
                continue
            try:
                if known.why:
                    raise NotComputableError(known.why)
                found |= self._of(source, known, chosen, (first, last, most), present)
            except NotComputableError as error:
                known.why = str(error)
            except (KeyError, TypeError, ValueError, AttributeError, OverflowError):  # a recording may have any events
                known.why = "The events of this memory are not as this version writes them, so its activations cannot be computed."
            if known.why:
                nothing: dict[str, Any] = {"times": [], "values": [], "slope": None, "whole": True, "why": known.why}
                found |= dict.fromkeys(chosen, nothing)
            basis += [source, known.settings, known.why]
        return {"events": found, "basis": "\n".join(basis)}

    def _look(self, parts: Mapping[str, Any]) -> None:
        """Notes the memories that there are, and their parameters."""
        names = {id(part): name for name, part in parts.items()}
        for name, memory in parts.items():
            if not isinstance(memory, Memory):
                continue
            settings = _settings(memory)
            sources = {buffer for _, module in named_modules(memory) if type(module) is DMSpreading for buffer in module.buffers}
            buffers = {names[id(buffer)]: buffer for buffer in sources if id(buffer) in names}
            known = self._known.get(name)
            if known is None or known.settings != settings:
                self._known[name] = known = _Known(memory, settings, buffers)
            known.memory, known.buffers = memory, buffers  # after going back, they are others
            if len(buffers) < len(sources):
                known.why = "A source buffer of the spreading activation does not belong to the agent, so it cannot be computed."

    def _of(
        self, source: str, known: _Known, chosen: Mapping[str, tuple[str, str]], asked: tuple[int, int, int], present: int
    ) -> dict[str, Any]:
        """Returns the chosen curves of a memory.

        Args:
            source: The name of the memory.
            known: Its settings, buffers and events.
            chosen: By the name of the curve: the text of the chunk, and the name of the part.
            asked: The interval and the maximum number of values, as for `sampled`.
            present: How many events the run has had up to the present.

        Raises:
            NotComputableError: If its activations do not follow from the events.
        """
        self._read(source, known)
        first, last, most = asked
        begin, end = -(-first // self._period), last // self._period
        step = stride(max(0, end - begin + 1), min(most, MOST) - 1)
        ticks = [*range(begin, end + 1, step)]
        if ticks and ticks[-1] != end:
            ticks.append(end)
        cursor = self._cursor(source, known, self._period * begin, present)
        times: list[float] = []
        values: dict[str, list[float | None]] = {name: [] for name in chosen}
        for time in (self._period * tick for tick in ticks):
            self._advance(known, cursor, time)
            own = self._own(source, time)
            times.append(seconds(time))
            parts = {text: {} if own is None else cursor.past.parts(own, text) for text in {text for text, _ in chosen.values()}}
            for name, (text, part) in chosen.items():
                values[name].append(_value(parts[text], part))
        if cursor.taken == len(known.events) and all(event.number < present for event in known.events[-1:]):
            for text in {text for text, _ in chosen.values()}:
                _compare_now(cursor.past, known.memory, text)
        return {name: {"times": times, "values": values[name], "slope": None, "whole": step == 1} for name in chosen}

    def _read(self, source: str, known: _Known) -> None:
        """Adds the new events of a memory and its source buffers."""
        news: list[LoggedEvent] = []
        for one in (source, *known.buffers):
            logged = self.of.logged.get(one, [])
            news += logged[known.read.get(one, 0) :]
            known.read[one] = len(logged)
        known.events += sorted(news)

    def _cursor(self, source: str, known: _Known, first: int, present: int) -> _Cursor:
        """Returns the latest cursor up to a time, or a new one at the start of the run."""
        cursor = max((one for one in known.cursors if one.time <= first), key=lambda one: one.time, default=None)
        if cursor is None:
            own = [one for one in known.events if one.event.source == source]
            cursor = _Cursor(PastMemory(known.memory, known.buffers, [one.event for one in own], sum(one.number < present for one in own)))
        known.cursors = [cursor, *(one for one in known.cursors if one is not cursor)][:CURSORS]
        return cursor

    def _advance(self, known: _Known, cursor: _Cursor, time: int) -> None:
        """Adds the events up to a time."""
        events = known.events
        while cursor.taken < len(events) and events[cursor.taken].event.time_us <= time:
            _, own, event = events[cursor.taken]
            cursor.taken += 1
            cursor.past.take(event, seconds(own))
        cursor.time = max(cursor.time, time)

    def _own(self, source: str, time: int) -> float | None:
        """Returns the time of a memory's model at a time of the run [s]; None if it did not run then."""
        number = run_of(source)
        times = self.of.times[number]
        found = times.own_at(time)
        if found is None:
            return None
        own, since = found
        goes_on = not since or (number == self.of.latest and time > times.program)
        return seconds(own + since) if goes_on else None


def _settings(memory: Memory) -> str:
    """Returns the parameters on which past activations depend, as text."""
    modules = dict(named_modules(memory))
    kept = [f"{name} {[getattr(module, one) for one in PARAMETERS.get(type(module), ())]}" for name, module in modules.items()]
    kept += [f"{one.strength} {[one.weight.get(buffer) for buffer in one.buffers]}" for one in modules.values() if type(one) is DMSpreading]
    return f"{memory.effective_profile.name} {kept} {computed_parts(memory)}"


def _chosen(memory: Memory, source: str, names: Sequence[str]) -> dict[str, tuple[str, str]]:
    """Returns the curves of a memory among those named: for each the text of the chunk, and the part; empty for the sum of all parts."""
    parts, whole, _ = computed_parts(memory)
    ends = {f" {part_name(part)}{SUFFIX}": part for part in parts} | ({f" {whole}{SUFFIX}": ""} if whole else {})
    start = f"{source}: "
    return {
        name: (name[len(start) : -len(end)], part)
        for name in names
        if name.startswith(start)
        for end, part in ends.items()
        if name.endswith(end)
    }


def _value(parts: Mapping[str, float | None], part: str) -> float | None:
    """Returns a part of an activation, or the sum of all if `part` is empty; None if it is not known, or not finite."""
    known = [parts.get(part)] if part else [*parts.values()]
    numbers = [value for value in known if value is not None]
    value = sum(numbers) if numbers and len(numbers) == len(known) else math.nan
    return value if math.isfinite(value) else None


def _compare_now(past: PastMemory, memory: Memory, text: str) -> None:
    """Compares the computed activation of a chunk with that in the memory itself, now.

    Raises:
        NotComputableError: If they differ.
    """
    chunk = next((chunk for chunk in memory.dm if chunk_text(chunk) == text), None)
    if chunk is not None:
        past.compare(memory.now(), text, {name: part_now(module, chunk) for name, module in named_modules(memory)})
