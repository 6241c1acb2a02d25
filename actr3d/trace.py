"""The trace: the append-only record of everything that happens in one run.

A run has no trace until somebody asks for one, and then records no more than the level asked for. Whoever emits an
event first looks at the trace's level flags, so that nothing is computed which nobody wants.
"""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Iterator, Mapping, Sequence
from math import isfinite
from typing import Any, NamedTuple, cast

from actr3d.clock import seconds
from actr3d.errors import ParameterError, did_you_mean

LEVELS = ("none", "production", "buffer", "all")
"""What a trace may hold: nothing; selections and firings; also buffer changes; everything."""

KINDS = {
    "start": "a run begins to be traced: its model, seed and profile",
    "buffer": "a buffer holds another chunk, or none",
    "state": "attributes of a module or model have these values",
    "observe": "what productions look at beyond that has these values",
    "conflict": "the productions that match, with their utilities and the parts of these",
    "select": "a production is chosen",
    "fire": "a production fires, with what it bound",
    "changed": "a chosen production matches no longer and does not fire",
    "compile": "a production is learned from two others",
    "reward": "an agent gets a reward",
    "utility": "a production's utility has become this by learning",
    "request": "a module is asked for something; a memory's request with all candidates",
    "retrieval": "a memory's answer arrives, or its failure",
    "answer": "a body answers what it was asked for",
    "output": "the model prints a line",
    "command": "a user changes the run",
}
"""What events there are."""

Data = dict[str, Any] | Callable[[], dict[str, Any]]
"""The particulars of an event, or a function that makes them of what it has kept, when somebody reads them."""
Record = tuple[int, str, str, Data]


class TraceEvent(NamedTuple):
    """One thing that happened."""

    time_us: int
    """When [us of simulated time]."""
    source: str
    """Who: the dotted path below the top model, or «top» for that model itself."""
    kind: str
    """What: one of `KINDS`."""
    data: dict[str, Any]
    """The particulars; plain values, lists and dicts only."""

    @property
    def time(self) -> float:
        """When [s of simulated time]."""
        return seconds(self.time_us)

    def to_json(self) -> str:
        """Returns the event as one line of JSON; the same event always gives the same bytes.

        Numbers that JSON does not have become the texts `inf`, `-inf` and `nan`.
        """
        record = {"time": self.time, "source": self.source, "kind": self.kind, "data": self.data}
        try:
            line = json.dumps(record, ensure_ascii=False, allow_nan=False)
        except (TypeError, ValueError):
            line = json.dumps({**record, "data": _plain(self.data)}, ensure_ascii=False, allow_nan=False)
        # Where an object's text tells where it lies in memory, that differs from run to run.
        return _ADDRESS.sub("", line) if " at 0x" in line else line


_ADDRESS = re.compile(r" at 0x[0-9a-fA-F]+")


def _plain(value: Any) -> Any:
    """Returns what JSON can hold of a value: what it has no word for becomes text, without addresses."""
    if value is None or isinstance(value, (bool, int, str)):
        return value
    if isinstance(value, float):
        return value if isfinite(value) else repr(value)
    if isinstance(value, Mapping):
        items = cast("Mapping[Any, Any]", value).items()
        return {key if isinstance(key, str) else str(_plain(key)): _plain(item) for key, item in items}
    if isinstance(value, (list, tuple)):
        return [_plain(item) for item in cast("Sequence[Any]", value)]
    if isinstance(value, (set, frozenset)):
        return sorted((_plain(item) for item in cast("set[Any]", value)), key=repr)
    text = repr(value)
    return f"<{type(value).__name__}>" if " at 0x" in text else text


class Trace:
    """Records the events of one run and hands each to whoever listens.

    Args:
        level: One of `LEVELS`; what is not asked for is neither computed nor kept.
        keep: Whether the trace keeps its events; a run that only streams them need not.

    Raises:
        ParameterError: If the level is unknown.
    """

    __slots__ = ("_listeners", "_records", "all", "buffer", "keep", "level", "production")

    def __init__(self, level: str = "all", keep: bool = True) -> None:
        if level not in LEVELS:
            raise ParameterError(f"Trace.level: no level {level!r}; use one of {', '.join(LEVELS)}{did_you_mean(level, LEVELS)}")
        self.level = level
        self.keep = keep
        self.production = level != "none"
        self.buffer = level in ("buffer", "all")
        self.all = level == "all"
        self._records: list[Record] = []
        self._listeners: list[Callable[[TraceEvent], None]] = []

    def emit(self, time_us: int, source: str, kind: str, data: Data) -> None:
        """Appends one event; the caller has looked at the level and gives `data` away."""
        if self.keep:
            self._records.append((time_us, source, kind, data))
        if self._listeners:
            event = _event((time_us, source, kind, data))
            for listener in self._listeners:
                listener(event)

    def listen(self, listener: Callable[[TraceEvent], None]) -> None:
        """Calls `listener` with every event from now on."""
        self._listeners.append(listener)

    def __len__(self) -> int:
        return len(self._records)

    def __iter__(self) -> Iterator[TraceEvent]:
        return map(_event, self._records)

    def select(self, kind: str, source: str | None = None) -> list[TraceEvent]:
        """Returns the events of one kind, of one source where it is named, in order."""
        return [e for e in self if e.kind == kind and (source is None or e.source == source)]


def _event(record: Record) -> TraceEvent:
    time_us, source, kind, data = record
    return TraceEvent(time_us, source, kind, data() if callable(data) else data)
