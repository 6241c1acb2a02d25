"""Computes curves from the events of a run: numbers in slots of buffers, attributes of modules, utilities, activations, latencies, and
how long modules were busy and buffers full."""

from __future__ import annotations

import math
import re
from array import array
from bisect import bisect_left, bisect_right
from collections import defaultdict
from collections.abc import Callable, Iterable, Mapping, Sequence
from contextlib import suppress
from dataclasses import asdict
from types import MappingProxyType
from typing import Any, ClassVar, NamedTuple

import numpy as np

from actr3d.actr.chunks.chunk import as_number
from actr3d.actr.declarative.activation_parts import ACTIVATION_PARTS
from actr3d.clock import microseconds, seconds
from actr3d.trace import TraceEvent, run_of
from workbench.curves import Curve, Shape
from workbench.program_time import RunTimes
from workbench.time_text import time_text

LOGGED = frozenset({"add", "chunks", "buffer", "request"})
"""The kinds of the events from which activations follow."""
MAX_CURVES = 5_000
"""Maximum number of curves of a run; others are left out."""


class _EventCurve:
    """The values of one curve, each with its time."""

    __slots__ = ("about", "slope", "times", "total", "value", "values")

    def __init__(self, about: Curve) -> None:
        self.about = about
        self.times = array("q")
        """[us]"""
        self.values = array("d")
        """NaN where it has no value from then on."""
        self.value: float | None = None
        """The last value."""
        self.slope: int | None = None
        """By how much the last value changes in a second; None if it does not last."""
        self.total = 0
        """The last value of a sum [us]."""

    def add(self, time: int, value: float | None) -> None:
        """Adds a value; of several at one moment, the last one counts."""
        self.value = value
        stored = math.nan if value is None else value
        times = self.times
        if times and times[-1] == time:
            self.values[-1] = stored
        else:
            times.append(time)
            self.values.append(stored)


class LoggedEvent(NamedTuple):
    """An event from which activations follow."""

    number: int
    """Its number in the run."""
    own: int
    """The time of its model [us]; that of the event is the time of the run."""
    event: TraceEvent


class EventCurves:
    """The curves of the events of a run, which are taken in their order, each once."""

    def __init__(self) -> None:
        self.next = 0
        """The number of the next event to take."""
        self._now = 0
        self._since = ""
        """What the names of sums end with: when they begin, if the first event is not at the start of the run."""
        self._curves: dict[str, _EventCurve] = {}
        self._slots: dict[str, set[str]] = {}
        """By buffer: its slots that hold numbers."""
        self._firsts: dict[str, tuple[int, float]] = {}
        """By attribute: when it had its first number, and this number."""
        self.logged: defaultdict[str, list[LoggedEvent]] = defaultdict(list)
        """By source: the events from which activations follow; see `workbench.chunk_curves`."""
        self.times: defaultdict[int, RunTimes] = defaultdict(RunTimes)
        """The times of each run, by its number."""
        self.latest = 1
        """The number of the run of the last event."""

    def take(self, events: Iterable[TraceEvent]) -> None:
        """Adds the next events, with the times of the whole run."""
        for event in events:
            time, source, kind, data = event
            number, self.next = self.next, self.next + 1
            taker = self._TAKERS.get(kind)
            # A module of a model may report other data in an event of this kind, and a recording may have any times.
            with suppress(KeyError, TypeError, ValueError, AttributeError, OverflowError):
                if kind != "output":  # which belongs to the program, and to none of its runs
                    self.latest = run_of(source)
                    times = self.times[self.latest]
                    times.add(times.own + max(0, time - self._now), max(self._now, time))
                    if kind in LOGGED:
                        self.logged[source].append(LoggedEvent(number, times.own, event))
                if time > self._now:
                    if number == 0:
                        self._since = f" since {time_text(seconds(time), 3)}"
                    self._now = time
                if taker is not None:
                    taker(self, source, data)

    # -- the answer

    def names(self, seen: int = 0) -> list[dict[str, str | None]]:
        """Returns all curves with name, unit, group, list and shape, in the order in which they appeared, without the first `seen`."""
        return [asdict(curve.about) for curve in list(self._curves.values())[seen:]]

    def sampled(self, names: Sequence[str] | None, first: float, last: float | None, most: int) -> dict[str, Any]:
        """Returns curves in an interval: for each its `times` [s], `values`, and the `slope` with which its last value goes on.

        Args:
            names: The curves; None for all. Unknown names are ignored.
            first: Start of the interval [s].
            last: Its end, included [s]; None for the last event.
            most: Maximum number of values of a curve; if it has more, the least, the greatest and the last one in equal numbers of
                values are returned.
        """
        begin, end = microseconds(first), None if last is None else microseconds(last)
        found: dict[str, Any] = {}
        for name in self._curves if names is None else names:
            curve = self._curves.get(name)
            if curve is None:
                continue
            low = bisect_left(curve.times, begin)
            high = len(curve.times) if end is None else max(low, bisect_right(curve.times, end))
            values = curve.values[low:high]
            kept = _extremes(values, most)
            found[name] = {
                "times": [seconds(curve.times[low + place]) for place in kept],
                "values": [None if math.isnan(values[place]) else values[place] for place in kept],
                "slope": curve.slope,
                "whole": len(kept) == len(values),
            }
        return found

    def added_to(self, answer: dict[str, Any], *asked: Any, seen: int = 0) -> dict[str, Any]:
        """Returns an answer with curves of bodies, and with the curves of events that `sampled` returns.

        Args:
            answer: As `CurveReader.sampled` returns it.
            asked: The arguments of `sampled`.
            seen: How many of its curves need not be named.
        """
        return {**answer, "names": [*answer["names"], *self.names(seen)], "events": self.sampled(*asked), "basis": ""}

    # -- values

    def _curve(self, name: str, unit: str, group: str, of: str | None, shape: Shape) -> _EventCurve | None:
        """Returns a curve, and makes it if it is new; None if there are too many."""
        curve = self._curves.get(name)
        if curve is None and len(self._curves) < MAX_CURVES:
            curve = self._curves[name] = _EventCurve(Curve(name, unit, group, of, shape))
        return curve

    def _point(self, value: Any, name: str, unit: str, group: str) -> None:
        """Adds a value of a single moment."""
        number = as_number(value)
        if number is None:
            return
        curve = self._curves.get(name) or self._curve(name, unit, group, None, "points")
        if curve is not None:
            curve.add(self._now, number)

    def _hold(self, time: int, value: float | None, name: str, group: str, of: str | None = None) -> None:
        """Adds a value that holds until the next one of its curve; None if there is none from now on."""
        curve = self._curves.get(name) or self._curve(name, "", group, of, "steps")
        if curve is not None and (curve.value != value or not curve.times):
            curve.slope = 0
            curve.add(time, value)

    def _last(self, on: bool, name: str, group: str) -> None:
        """Adds up how long something lasts."""
        curve = self._curve(name + self._since, "s", group, None, "sum")
        if curve is None or curve.slope == on:
            return
        if curve.slope:
            curve.total += self._now - curve.times[-1]
        curve.add(self._now, seconds(curve.total))
        curve.slope = int(on)

    # -- events

    def _buffer(self, source: str, data: Mapping[str, Any]) -> None:
        """Adds the slots of a buffer's chunk that hold numbers; those of another chunk end."""
        chunk: Mapping[str, Any] | None = data["chunk"]
        self._last(chunk is not None, f"{source} full", "time full")
        now = set[str]()
        for slot, text in (chunk or {}).items():
            value = as_number(text)
            if value is not None:
                now.add(slot)
                self._hold(self._now, value, f"{source}.{slot}", slot, source)
        before = self._slots.get(source)
        if before and before != now:
            for slot in sorted(before - now):
                self._hold(self._now, None, f"{source}.{slot}", slot, source)
        self._slots[source] = now

    def _state(self, source: str, data: Mapping[str, Any]) -> None:
        """Adds the attributes that change; most are settings, and stay as they are."""
        for name, value in data.items():
            curve, number = f"{source}.{name}", as_number(value)
            first = self._firsts.get(curve)
            if first is None:
                if number is not None:
                    self._firsts[curve] = self._now, number
            elif first[1] != number or curve in self._curves:
                if curve not in self._curves:
                    self._hold(*first, curve, name, source)
                self._hold(self._now, number, curve, name, source)
        busy = data.get("busy")
        if isinstance(busy, bool):
            self._last(busy, f"{source} busy", "time busy")

    def _conflict(self, source: str, data: Mapping[str, Any]) -> None:
        for production, value in data["utilities"].items():
            self._point(value, f"{_path(source, production)} utility", "", "utility")

    def _utility(self, source: str, data: Mapping[str, Any]) -> None:
        number = as_number(data["value"])
        if number is not None:
            part = data["part"]
            self._hold(self._now, number, f"{_path(source, data['production'])} learned {part}", f"learned {part}")

    def _request(self, source: str, data: Mapping[str, Any]) -> None:
        """Adds what a memory has found: the activations of the candidates with their parts, and how long the retrieval takes."""
        candidates = data.get("candidates")
        if candidates is None:
            return
        modules = [part_name(module) for module in data["modules"]]
        for chunk, parts, _, activation in candidates:
            self._point(activation, f"{source}: {chunk} activation", "", "activation")
            if len(parts) == len(modules):
                for module, part in zip(modules, parts, strict=True):
                    self._point(part, f"{source}: {chunk} {module}", "", module)
        self._point(data["latency"], f"{source} latency", "s", "retrieval latency")

    _TAKERS: ClassVar[Mapping[str, Callable[[EventCurves, str, Mapping[str, Any]], None]]] = MappingProxyType(
        {"buffer": _buffer, "state": _state, "conflict": _conflict, "utility": _utility, "request": _request}
    )
    """By the kind of the event: the method that takes its numbers."""


def part_name(part: str) -> str:
    """Returns the name that users see for a component of an activation; of several modules of one class, each has a number."""
    name = re.sub(r" \d+\Z", "", part)
    return ACTIVATION_PARTS.get(name, name) + part.removeprefix(name)


def _path(system: str, production: str) -> str:
    """Returns the path of a production: like the paths of parts, without the name of the model if it is the first `top`."""
    return production if system == "top" else f"{system}.{production}"


def _extremes(values: Sequence[float], most: int) -> Sequence[int]:
    """Returns the places of at most `most` values: all, or the least, the greatest and the last one of each group of as many values."""
    count = len(values)
    if count <= most:
        return range(count)
    size = -(-3 * count // most)
    padded = np.pad(np.array(values), (0, -count % size), mode="edge").reshape(-1, size)
    starts = np.arange(0, count, size)
    missing = np.isnan(padded)
    least = starts + np.where(missing, math.inf, padded).argmin(axis=1)
    greatest = starts + np.where(missing, -math.inf, padded).argmax(axis=1)
    return np.unique(np.concatenate([least, greatest, np.minimum(starts + size, count) - 1])).tolist()
