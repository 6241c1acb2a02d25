"""Compares two recordings: their parameters and their events up to the first difference."""

from __future__ import annotations

import difflib
from collections import deque
from collections.abc import Collection, Iterable, Iterator, Sequence
from itertools import islice, zip_longest
from pathlib import Path
from typing import Any

from actr3d.clock import seconds
from actr3d.errors import RecordingError
from actr3d.parameter_schema import Parameter
from actr3d.recording import Recorded
from actr3d.recording.facts import is_of_simulation
from actr3d.trace import TraceEvent
from workbench.live_parameters import value_changed_by
from workbench.loader import listing_of
from workbench.program_time import timed_events, user_commands
from workbench.recording_index import UNREADABLE
from workbench.run_facts import exact_seed, seed_of, source_of

CONTEXT = 8
"""How many events are returned before the first difference, and after it from each recording."""
MAX_COMPARED = 2_000_000
"""Maximum number of events that are compared."""
MAX_TEXT = 200_000
"""Maximum total length of two model texts that are compared line by line [characters]."""
MAX_LINES = 400
"""Maximum number of differing lines that are returned for two texts."""


def compare(first: Path, second: Path, kinds: Collection[str] = ()) -> dict[str, Any]:
    """Compares two recordings and returns their differences.

    The result has these keys. `parameters`: settings and seeds that differ, each with both values. `changed`: for each recording, what
    users changed during the run, by parameter name, as pairs of time [s] and value. `units`: the units of these, by name. `text`: a diff of
    the model texts, if both model files have the same name. `same_events`: how many events agree. `whole`: False if the comparison
    stopped at the maximum number of events. `difference`: the first event that differs, with some events before and after it; None if no
    compared event differs.

    Args:
        first: A recording; its run may still be going on.
        second: The other recording.
        kinds: The kinds of events to compare; empty for all.

    Raises:
        RecordingError: If a recording cannot be read.
    """
    try:
        with Recorded(first) as one, Recorded(second) as other:
            left, right = _settings_of(one.facts), _settings_of(other.facts)
            names = {Path(recorded.facts.get("file", "")).name for recorded in (one, other)}
            different = {name: [left.get(name), right.get(name)] for name in {**left, **right} if left.get(name) != right.get(name)}
            of_one, of_other = (listing_of(source_of(recorded.facts)).parameters for recorded in (one, other))
            agreeing, difference, whole = _first_difference(one, other, frozenset(kinds))
            return {
                "parameters": different,
                "changed": [_changed(one, of_one), _changed(other, of_other)],
                "units": {**_units(other, of_other), **_units(one, of_one)},
                "text": _changes(source_of(one.facts), source_of(other.facts)) if len(names) == 1 else [],
                "same_events": agreeing,
                "whole": whole,
                "difference": difference,
            }
    except RecordingError:
        raise
    except UNREADABLE as error:
        raise RecordingError(f"one of the recordings is damaged: {type(error).__name__}: {error}") from None


def _settings_of(facts: dict[str, Any]) -> dict[str, Any]:
    """Returns the settings and the seed that the user chose for a run."""
    return {**facts.get("parameters", {}), "seed": exact_seed(seed_of(facts))}


def _units(recorded: Recorded, parameters: Iterable[Parameter]) -> dict[str, str]:
    """Returns the units of the model's parameters that have one, and of the widths of apertures, by name."""
    facts = recorded.facts
    worlds = [facts.get("world"), *(fact.get("world") for name, fact in facts.items() if is_of_simulation(name) and fact is not None)]
    units = {aperture: "m" for world in worlds if world is not None for aperture in world.get("apertures", ())}
    return units | {one.name: one.unit for one in parameters if one.unit is not None}


def _changed(recorded: Recorded, parameters: Sequence[Parameter]) -> dict[str, list[list[Any]]]:
    """Returns the parameters and apertures that users changed during the run, as pairs of time [s] and new value."""
    found: dict[str, list[list[Any]]] = {}
    for time, data in user_commands(recorded):
        if (change := value_changed_by(parameters, data)) is not None:
            found.setdefault(change[0], []).append([time, change[1]])
    return found


def _changes(left: str, right: str) -> list[str]:
    """Returns a unified diff of two texts, like `diff -u`."""
    if left == right:
        return []
    if len(left) + len(right) > MAX_TEXT:
        return ["the texts are too long to be compared line by line"]
    lines = difflib.unified_diff(left.splitlines(), right.splitlines(), "first", "second", n=2, lineterm="")
    found = list(islice(lines, MAX_LINES + 1))
    return [*found[:MAX_LINES], "and more"] if len(found) > MAX_LINES else found


# -- events


def _first_difference(one: Recorded, other: Recorded, kinds: frozenset[str]) -> tuple[int, dict[str, Any] | None, bool]:
    """Returns how many events agree, the first difference, and False if the comparison stopped at the maximum number."""
    left, right = _events(one, kinds), _events(other, kinds)
    before: deque[TraceEvent] = deque(maxlen=CONTEXT)
    number = -1
    for number, (mine, its) in enumerate(zip_longest(left, right)):
        if number == MAX_COMPARED:
            return number, None, False
        if mine != its and not (mine is not None and its is not None and _alike(mine, its)):
            after = [[list(event) for event in islice(events, CONTEXT)] for events in (left, right)]
            difference = {
                "time": min(seconds(event[0]) for event in (mine, its) if event is not None),
                "events": [None if event is None else list(event) for event in (mine, its)],
                "before": [list(event) for event in before],
                "after": after,
            }
            return number, difference, True
        before.append(mine or its)
    return number + 1, None, True


def _events(recorded: Recorded, kinds: frozenset[str]) -> Iterator[TraceEvent]:
    return (event for event in timed_events(recorded) if not kinds or event.kind in kinds)


def _alike(mine: TraceEvent, its: TraceEvent) -> bool:
    """Returns whether two events are equal except for memory addresses of objects."""
    return mine[:3] == its[:3] and mine.to_json() == its.to_json()
