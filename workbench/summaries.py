"""What a list tells of a recording, as a worker reads it from the file."""

from __future__ import annotations

import sqlite3
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import Any

import msgspec

from actr3d.clock import seconds
from actr3d.errors import RecordingError
from actr3d.recording import Recorded
from actr3d.values import to_json
from workbench.keeping import begun, size_of
from workbench.loader import Parameter, listing_of

_WRONG = (ValueError, KeyError, TypeError, AttributeError, IndexError, RecursionError)
UNREADABLE = (RecordingError, OSError, sqlite3.Error, msgspec.MsgspecError, *_WRONG)
"""What reading a file raises that is no whole recording of this form."""
Event = tuple[int, str, str, msgspec.Raw]
"""When [us], who, what, and the particulars as JSON."""
EVENTS = msgspec.json.Decoder(list[Event])
"""Reads a row of events, but not their particulars."""
MOST_TEXT = 200_000
"""No summary is longer [bytes of JSON]."""


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
    branched: float | None = None
    """Of a branch: where the past of its run was changed [s]."""
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


def summary_json(path: Path) -> bytes:
    """Returns the `Summary` of a file as JSON; of one that is no recording, with the reason.

    Raises:
        RecordingError: If it is too long.
    """
    size = size_of(path)
    try:
        with Recorded(path) as recorded:
            found = _read(recorded, size)
    except UNREADABLE as error:
        reason = str(error) if isinstance(error, (RecordingError, OSError)) else f"it is damaged ({type(error).__name__}: {error})"
        found = unreadable(path, reason.replace(f"'{path}'", "it"))
    told = to_json(vars(found)).encode()
    if len(told) > MOST_TEXT:
        return to_json(vars(unreadable(path, "what it tells of its run is too long to be listed"))).encode()
    return msgspec.json.encode(msgspec.json.decode(told, type=Summary))


def unreadable(path: Path, reason: str) -> Summary:
    """Returns what is told of a file that cannot be read."""
    return Summary(id=path.stem, size=size_of(path), made=begun(path), problem=reason.removeprefix("it is ")[:2_000])


def _read(recorded: Recorded, size: int) -> Summary:
    facts, path = recorded.facts, recorded.path
    ended: dict[str, Any] | None = facts.get("ended")
    last = [event for text in recorded.last_events() for event in EVENTS.decode(text)]  # what was measured is told at the very end
    parameters = dict(facts.get("parameters", {}))
    file = str(facts.get("file", ""))
    return Summary(
        id=path.stem,
        model=Path(file).name,
        kind=str(facts["kind"]),
        seed=facts.get("program_seed", facts.get("seed")),
        parameters=parameters,
        different=_different(parameters, facts.get("sources", {}).get(file, "")),
        branched=facts.get("branched"),
        ended=None if ended is None else str(ended["by"]),
        failed=None if facts.get("failed") is None else str(facts["failed"]),
        result=_result(last),
        time=seconds(recorded.ticks * facts["period_us"] if "period_us" in facts else last[-1][0] if last else 0),
        events=recorded.event_count,
        states=recorded.state_count,
        size=size,
        made=begun(path),
    )


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
