"""Why a search of the eyes went as it did: what was asked for, what was noticed and what not, and the outcome."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

from actr3d.actr.chunk import Chunk
from actr3d.actr.modules.port import Port
from actr3d.clock import seconds
from actr3d.trace import TraceEvent

MOST_SHOWN = 12
"""How many features are printed; all are in the reason."""


class Searching(Port):
    """A module that looks for things, and whose searches are explained."""

    def _latest_searches(self) -> list[tuple[int, Mapping[str, Any], str]]:
        """Returns of the last top-down and the last bottom-up search when the view was taken in [us], what was in it, the outcome."""
        return []


@dataclass(frozen=True, kw_only=True)
class FeatureReason:
    """How one feature stood in a search."""

    feature: str
    salience: float | None
    """None where it is not what was asked for."""
    verdict: str
    """Why it was brought or not."""

    def __str__(self) -> str:
        weight = "" if self.salience is None else f"salience {self.salience:.4g}, "
        return f"      {self.feature}: {weight}{self.verdict}"


@dataclass(frozen=True, kw_only=True)
class SearchReason:
    """The last search of a module in a view, top-down or bottom-up, and what came of it."""

    module: str
    time: float
    """When its view was taken in [s]."""
    asked: str
    """The request with the values of its variables."""
    bottom_up: bool
    features: tuple[FeatureReason, ...]
    """What was noticed, then what was refused."""
    outcome: str
    """«found», «found, but the buffer was kept», «failed», or «pending»: the answer is still on its way."""
    why: str | None
    """Why nothing was brought although something was noticed, or could have been."""

    def __str__(self) -> str:
        way = "bottom-up search" if self.bottom_up else "search"
        why = "" if self.why is None else f": {self.why}"
        lines = [f"  {self.module}: {way} at {self.time:.3f} s for '{self.asked}': {self.outcome}{why}"]
        if not self.features and self.why is None:
            lines.append("      nothing of that kind was seen")
        lines += map(str, self.features[:MOST_SHOWN])
        if len(self.features) > MOST_SHOWN:
            lines.append(f"      and {len(self.features) - MOST_SHOWN} more")
        return "\n".join(lines)


def _reason(module: str, time: float, data: Mapping[str, Any], outcome: str) -> SearchReason:
    """Makes a reason of what a search's trace event holds."""
    features: list[FeatureReason] = []
    for number, (slots, salience) in enumerate(data["noticed"]):
        verdict = "chosen" if number == data["chosen"] else "not drawn"
        features.append(FeatureReason(feature=str(Chunk(slots)), salience=salience, verdict=verdict))
    features.sort(key=lambda feature: feature.verdict != "chosen")
    features += [FeatureReason(feature=str(Chunk(slots)), salience=None, verdict=f"refused: {why}") for slots, why in data["refused"]]
    return SearchReason(
        module=module,
        time=time,
        asked=data["asked"],
        bottom_up=data["bottom_up"],
        features=tuple(features),
        outcome=outcome,
        why=data.get("why"),
    )


def live_searches(module: Searching) -> list[SearchReason]:
    """Returns the reasons of a module's last searches, top-down and bottom-up, as far as there were any."""
    return [_reason(module._path, seconds(time), data, outcome) for time, data, outcome in module._latest_searches()]


def past_search(module: str, search: TraceEvent, outcome: str) -> SearchReason:
    """Returns the reason of a module's search, as a trace has it, with what had come of it by then."""
    return _reason(module, search.time, search.data, outcome)


def outcome_of(sight: Mapping[str, Any]) -> str:
    """Returns the outcome that a trace tells of."""
    if sight["failed"]:
        return "failed"
    return "found, but the buffer was kept" if sight.get("held") else "found"
