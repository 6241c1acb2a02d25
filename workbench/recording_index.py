"""Reads the summary of a recording that a list shows; this happens in a worker."""

from __future__ import annotations

import json
import sqlite3
from dataclasses import dataclass, field
from functools import lru_cache
from pathlib import Path
from typing import Any

import msgspec

from actr3d.clock import microseconds, seconds
from actr3d.errors import RecordingError
from actr3d.parameter_schema import Parameter
from actr3d.recording import Recorded
from actr3d.runner.program_changes import of_user
from actr3d.values import to_json
from workbench.files import ModelFolder
from workbench.live_parameters import value_changed_by
from workbench.loader import listing_of
from workbench.program_time import user_commands
from workbench.retention import begun, copied_from, size_of, written
from workbench.run_facts import exact_seed, seed_of, source_of

_WRONG = (ValueError, KeyError, TypeError, AttributeError, IndexError, RecursionError)
UNREADABLE = (RecordingError, OSError, sqlite3.Error, msgspec.MsgspecError, *_WRONG)
"""The exceptions that reading an invalid or incomplete recording may raise."""
Event = tuple[int, str, str, msgspec.Raw]
"""Time [us], source, kind, and data as JSON."""
EVENTS = msgspec.json.Decoder(list[Event])
"""Decodes a row of events, but not their data."""
MAX_TEXT = 200_000
"""Maximum size of a summary [bytes of JSON]."""


@dataclass(frozen=True, kw_only=True)
class Summary:
    """Holds what a list shows of a recording."""

    id: str
    named: str = ""
    """The name that the recording was given first; branches know it by this name."""
    model: str = ""
    """The model file as pages name it; see `ModelFolder.shown`."""
    kind: str = ""
    seed: Any = None
    """A text also if it is a number that JavaScript would round."""
    parameters: dict[str, Any] = field(default_factory=dict[str, Any])
    different: tuple[str, ...] = ()
    """The parameters that differ from the defaults in the model's text."""
    changed: dict[str, Any] = field(default_factory=dict[str, Any])
    """The parameters and apertures that users changed during the run, with their last values."""
    branched: float | None = None
    """For a branch: the time at which the past of its run was changed [s]."""
    origin: str | None = None
    """For a branch: the recording from which it branches, by its first name (`named`); the names in `ancestors` are first names, too."""
    ancestors: tuple[tuple[str, float], ...] = ()
    """For a branch: the recordings from which its origin branches, the nearest first, each with the time at which the recording before
    it (the origin for the first one) branches from it [s]. Any of them may have been deleted since."""
    change: dict[str, Any] | None = None
    """For a branch: the data of the first command of a user from that time on; None if there was none."""
    kept: float | None = None
    """For a copy of what lay ahead of a run when its past was changed: when that was [s since 1970]."""
    copied: tuple[str, float] | None = None
    """For such a copy: the recording of that run, by the name that it was given first, and the time of the change [s]."""
    ended: str | None = None
    """How the run ended; None if it was interrupted, or is still running."""
    failed: str | None = None
    """The error that ended the model, if any."""
    result: dict[str, Any] | None = None
    """The result that was measured, if any."""
    time: float = 0.0
    """Duration of the run [s of simulated time]."""
    events: int = 0
    states: int = 0
    """Number of MuJoCo states; 0 for a program without a simulation."""
    size: int
    """Size including companion files [bytes]."""
    made: float
    """When the run began according to the file name, or else when the file was last written [s since 1970]."""
    problem: str | None = None
    """Why the recording cannot be read; None if it can."""


def summary_json(path: Path, models: ModelFolder) -> bytes:
    """Returns the `Summary` of a file as JSON; if the file is not a recording, the summary gives the reason.

    Raises:
        RecordingError: If the summary is too long.
    """
    size = size_of(path)
    try:
        with Recorded(path) as recorded:
            found = _read(recorded, size, models)
    except UNREADABLE as error:
        reason = str(error) if isinstance(error, (RecordingError, OSError)) else f"it is damaged ({type(error).__name__}: {error})"
        found = unreadable(path, without_path(reason, path))
    summary = to_json(vars(found)).encode()
    if len(summary) > MAX_TEXT:
        return to_json(vars(unreadable(path, "the description of its run is too long to be listed"))).encode()
    return msgspec.json.encode(msgspec.json.decode(_without_surrogates(summary.decode()), type=Summary))


def without_path(text: str, path: Path) -> str:
    """Returns a text about a recording that says «it» instead of naming its place on this machine."""
    return text.replace(f"the recording '{path}'", "it").replace(f"'{path}'", "it")


def _without_surrogates(text: str) -> str:
    """Returns JSON in which unpaired surrogates, which no encoding has, are question marks."""
    if "\\ud" not in text.lower():
        return text
    return json.dumps(json.loads(text), ensure_ascii=False).encode("utf-8", "replace").decode()


def unreadable(path: Path, reason: str) -> Summary:
    """Returns the summary of a file that cannot be read."""
    return Summary(id=path.stem, named=path.stem, size=size_of(path), made=begun(path), problem=reason.removeprefix("it is ")[:2_000])


def _read(recorded: Recorded, size: int, models: ModelFolder) -> Summary:
    facts, path = recorded.facts, recorded.path
    ended: dict[str, Any] | None = facts.get("ended")
    last = [
        event for text in recorded.last_events() for event in EVENTS.decode(_without_surrogates(text))
    ]  # the result is recorded at the very end
    parameters = dict(facts.get("parameters", {}))
    source = source_of(facts)
    named = str(facts.get("named", path.stem))
    copied = copied_from(named)
    return Summary(
        id=path.stem,
        named=named,
        model=models.shown(str(facts.get("file", ""))),
        kind=str(facts["kind"]),
        seed=exact_seed(seed_of(facts)),
        parameters=parameters,
        different=_different(parameters, source),
        changed=_changed(recorded, source),
        branched=facts.get("branched"),
        origin=facts.get("origin"),
        ancestors=tuple((str(name), float(time)) for name, time in facts.get("ancestors", ())),
        change=_change(recorded, facts.get("branched")),
        kept=None if copied is None else written(path),
        copied=copied,
        ended=None if ended is None else str(ended["by"]),
        failed=None if facts.get("failed") is None else str(facts["failed"]),
        result=_result(last),
        time=_duration(recorded, last),
        events=recorded.event_count,
        states=recorded.state_count,
        size=size,
        made=begun(path),
    )


def _change(recorded: Recorded, branched: float | None) -> dict[str, Any] | None:
    """Returns the first command of a user from a time on [s]; None for no time."""
    if branched is None:
        return None
    return next((data for time, data in user_commands(recorded) if microseconds(time) >= microseconds(branched)), None)


def _changed(recorded: Recorded, source: str) -> dict[str, Any]:
    """Returns the last values of the parameters and apertures that users changed during the run."""
    commands = list(recorded.commands() if recorded.facts["kind"] != "program" else of_user(recorded.commands()))
    parameters = _parameters(source).values() if commands else ()
    return dict(filter(None, (value_changed_by(parameters, command.data) for command in commands)))


def _duration(recorded: Recorded, last: list[Event]) -> float:
    """Returns the duration of a run [s]; of a program without the fact `reached`, that of its last run, up to its last event."""
    facts = recorded.facts
    if "period_us" in facts:
        return seconds(recorded.ticks * facts["period_us"])
    return facts.get("reached", seconds(last[-1][0]) if last else 0.0)


def _result(events: list[Event]) -> dict[str, Any] | None:
    result = next((data for _, _, kind, data in reversed(events) if kind == "result"), None)
    return None if result is None else dict(msgspec.json.decode(result))


def _different(parameters: dict[str, Any], source: str) -> tuple[str, ...]:
    """Returns the parameters that differ from the defaults in the text, or whose defaults the text does not show."""
    known = _parameters(source) if parameters else {}
    return tuple(name for name, value in parameters.items() if name not in known or not known[name].known or known[name].default != value)


@lru_cache(maxsize=64)
def _parameters(source: str) -> dict[str, Parameter]:
    """Returns the parameters of a text; cached, as many recordings have the same text."""
    return {parameter.name: parameter for parameter in listing_of(source).parameters}
