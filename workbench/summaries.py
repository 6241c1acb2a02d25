"""What a list tells of recordings: read from each file once, and again only when it has changed."""

from __future__ import annotations

import re
import sqlite3
import time
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from threading import Lock
from typing import Any

import msgspec

from actr3d.clock import seconds
from actr3d.errors import RecordingError
from actr3d.recording import Recorded
from workbench.keeping import size_of
from workbench.loader import Parameter, listing_of

UNREADABLE = (RecordingError, OSError, sqlite3.Error, msgspec.MsgspecError, ValueError, KeyError, TypeError, AttributeError, IndexError)
"""What reading a file raises that is no whole recording of this form."""
Event = tuple[int, str, str, msgspec.Raw]
"""When [us], who, what, and the particulars as JSON."""
EVENTS = msgspec.json.Decoder(list[Event])
"""Reads a row of events, but not their particulars."""
_BEGUN = re.compile(r"-(\d{8}-\d{6})-[0-9a-f]{4}")
_Stamp = tuple[int, ...]


@dataclass(frozen=True, kw_only=True)
class Summary:
    """What a list tells of a recording."""

    id: str
    model: str = ""
    kind: str = ""
    seed: Any = None
    parameters: dict[str, Any] = field(default_factory=dict[str, Any])
    different: tuple[str, ...] = ()
    """Which of these are not what the model's text has as defaults."""
    ended: str | None = None
    """How it ended; None where it was broken off, or goes on."""
    failed: str | None = None
    """What the model raised, where it was over for that."""
    result: dict[str, Any] | None = None
    """What was measured of it, if anything was."""
    time: float = 0.0
    """How long it is [s of simulated time]."""
    events: int = 0
    states: int = 0
    """How many there are of MuJoCo; none of a program that makes no simulation."""
    size: int
    """With what is written beside it while a run goes on [bytes]."""
    made: float
    """When it began, as its name tells; else when it was last written [s since 1970]."""
    problem: str | None = None
    """Why it cannot be read, where it cannot."""


class Summaries:
    """Reads summaries, and keeps them for as long as their files stay as they are."""

    def __init__(self) -> None:
        self._known: dict[str, tuple[_Stamp, Summary]] = {}
        self._reading = Lock()

    def of(self, path: Path) -> Summary:
        """Returns the summary of a file, also of one that is no recording."""
        # Many who ask at once would only wait for one another's turns.
        with self._reading:
            stamp = _stamp(path)
            known = self._known.get(path.name)
            if known is None or known[0] != stamp:
                known = self._known[path.name] = stamp, summary_of(path)
            return known[1]

    def forget(self, kept: set[str]) -> None:
        """Forgets all files but those of these names."""
        with self._reading:
            self._known = {name: known for name, known in self._known.items() if name in kept}


def _stamp(path: Path) -> _Stamp:
    """Returns numbers that differ when the file has changed; while a run goes on, what is new lies in a file beside it."""
    numbers: list[int] = []
    for each in (path, path.with_name(f"{path.name}-wal")):
        try:
            told = each.stat()
        except OSError:
            continue
        numbers += told.st_mtime_ns, told.st_size
    return tuple(numbers)


def begun(path: Path) -> float:
    """Returns when a recording began, as its name tells; else when it was last written [s since 1970]."""
    named = _BEGUN.search(path.stem)
    if named is not None:
        try:
            return time.mktime(time.strptime(named[1], "%Y%m%d-%H%M%S"))
        except (ValueError, OverflowError):
            pass
    try:
        return path.stat().st_mtime
    except OSError:
        return 0.0


def summary_of(path: Path) -> Summary:
    """Returns what is known of a file."""
    size = size_of(path)
    try:
        with Recorded(path) as recorded:
            return _read(recorded, size)
    except UNREADABLE as error:
        reason = str(error) if isinstance(error, (RecordingError, OSError)) else f"it is damaged ({type(error).__name__}: {error})"
        return Summary(id=path.stem, size=size, made=begun(path), problem=reason.replace(f"'{path}'", "it").removeprefix("it is "))


def _read(recorded: Recorded, size: int) -> Summary:
    facts, path = recorded.facts, recorded.path
    ended: dict[str, Any] | None = facts.get("ended")
    last = _last_events(recorded)
    parameters = dict(facts.get("parameters", {}))
    file = str(facts.get("file", ""))
    return Summary(
        id=path.stem,
        model=Path(file).name,
        kind=str(facts["kind"]),
        seed=facts.get("program_seed", facts.get("seed")),
        parameters=parameters,
        different=_different(parameters, facts.get("sources", {}).get(file, "")),
        ended=None if ended is None else str(ended["by"]),
        failed=None if facts.get("failed") is None else str(facts["failed"]),
        result=_result(last),
        time=seconds(recorded.ticks * facts["period_us"] if "period_us" in facts else last[-1][0] if last else 0),
        events=recorded.event_count,
        states=recorded.state_count,
        size=size,
        made=begun(path),
    )


def _last_events(recorded: Recorded) -> list[Event]:
    """Returns the last two rows of events: what was measured is told at the very end."""
    rows = recorded._file.execute("SELECT data FROM events ORDER BY first DESC LIMIT 2").fetchall()
    return [event for (text,) in reversed(rows) for event in EVENTS.decode(text)]


def _result(events: list[Event]) -> dict[str, Any] | None:
    told = next((data for _, _, kind, data in reversed(events) if kind == "result"), None)
    return None if told is None else dict(msgspec.json.decode(told))


def _different(parameters: dict[str, Any], source: str) -> tuple[str, ...]:
    """Returns which parameters are not what the text has as defaults; also those whose defaults the text does not tell."""
    known = _parameters(source) if parameters else {}
    return tuple(name for name, value in parameters.items() if name not in known or not known[name].known or known[name].default != value)


@lru_cache(maxsize=64)
def _parameters(source: str) -> dict[str, Parameter]:
    """Returns the parameters of a text; many recordings are of the same."""
    return {parameter.name: parameter for parameter in listing_of(source).parameters}
