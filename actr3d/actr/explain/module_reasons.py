"""Makes reasons from the events of modules: requests to a memory, and searches of a vision module."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from math import isnan
from typing import Any

from actr3d.actr.chunks.chunk import Chunk
from actr3d.actr.declarative.memory import Memory, latest_retrieval
from actr3d.actr.kernel.tree import path_of
from actr3d.actr.modules.port import Searching, latest_searches
from actr3d.actr.reasons import CandidateReason, FeatureReason, RetrievalReason, SearchReason
from actr3d.clock import seconds
from actr3d.trace import TraceEvent


def _retrieval_reason(memory: str, time: float, data: Mapping[str, Any], outcome: str) -> RetrievalReason:
    """Makes a reason from the data of a request's trace event."""
    threshold: float | None = data["threshold"]
    chosen: int | None = data["chosen"]
    rows: Sequence[Sequence[Any]] = data["candidates"]
    best = max((row[3] for row in rows if not isnan(row[3])), default=0.0)
    order = sorted(range(len(rows)), key=lambda i: (i != chosen, isnan(rows[i][3]), -rows[i][3]))
    candidates: list[CandidateReason] = []
    for i in order:
        chunk, parts, partial, activation = rows[i]
        if isnan(activation):
            verdict = "cannot be retrieved: its activation is not a number"
        elif i == chosen:
            verdict = "won" if sum(row[3] == best for row in rows) == 1 else "chosen at random among equals"
        elif chosen is None:
            verdict = f"below the threshold by {threshold - activation:.4g}" if threshold is not None else "lost"
        elif activation == best:
            verdict = "equal, but another was chosen at random"
        else:
            verdict = f"lost by {best - activation:.4g}"
        modules = data["modules"] if len(data["modules"]) == len(parts) else ["get_activation"]
        named = dict(zip(numbered(modules), parts, strict=True))
        if data["partial"]:
            named["partial"] = partial
        candidates.append(CandidateReason(chunk=chunk, activation=activation, parts=named, verdict=verdict))
    return RetrievalReason(
        memory=memory,
        time=time,
        request=data["pattern"],
        asked=data["asked"],
        threshold=threshold,
        require_new=data["require_new"],
        finsts=tuple(data["finsts"]),
        excluded=tuple(data["excluded"]),
        candidates=tuple(candidates),
        outcome=outcome,
        latency=data["latency"],
    )


def numbered(names: Sequence[str]) -> list[str]:
    """Returns the names of the parts of an activation, from the classes of the modules: DMNoise, DMNoise 2."""
    return [name if names[:i].count(name) == 0 else f"{name} {names[:i].count(name) + 1}" for i, name in enumerate(names)]


def live_retrieval(memory: Memory) -> RetrievalReason | None:
    """Returns the reason of a memory's last request; None before the first."""
    record = latest_retrieval(memory)
    if record is None:
        return None
    outcome = "pending" if memory.busy else "retrieved" if record.chosen is not None else "failed"
    return _retrieval_reason(path_of(memory), seconds(record.time), record.to_data(), outcome)


def past_retrieval(memory: str, request: TraceEvent, outcome: str) -> RetrievalReason:
    """Returns the reason of a memory's request in a trace, with its outcome at that time."""
    return _retrieval_reason(memory, request.data.get("made", request.time), request.data, outcome)


def _search_reason(module: str, time: float, data: Mapping[str, Any], outcome: str) -> SearchReason:
    """Makes a reason from the data of a search's trace event."""
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
    """Returns the reasons of a module's last searches, top-down and bottom-up, if there were any."""
    return [_search_reason(path_of(module), seconds(time), data, outcome) for time, data, outcome in latest_searches(module)]


def past_search(module: str, search: TraceEvent, outcome: str) -> SearchReason:
    """Returns the reason of a module's search in a trace, with its outcome at that time."""
    return _search_reason(module, search.time, search.data, outcome)


def outcome_of(sight: Mapping[str, Any]) -> str:
    """Returns the outcome of a search from the data of its «sight» event."""
    if sight["failed"]:
        return "failed"
    return "found, but the buffer was kept" if sight.get("held") else "found"
