"""Why a retrieval went as it did: the request, every candidate with the parts of its activation, and the outcome."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from math import isnan
from typing import Any

from actr3d.actr.memory import Memory
from actr3d.clock import seconds
from actr3d.trace import TraceEvent

MOST_SHOWN = 12
"""How many candidates are printed; all are in the reason."""


@dataclass(frozen=True, kw_only=True)
class CandidateReason:
    """How one chunk stood in a request."""

    chunk: str
    activation: float
    parts: Mapping[str, float]
    """What each activation module added, by its class (numbered where there are several), and «partial», what mismatches cost."""
    verdict: str
    """Why it won or lost."""

    def __str__(self) -> str:
        parts = "  ".join(f"{name} {value:.4g}" for name, value in self.parts.items())
        return f"      {self.chunk}: activation {self.activation:.4g}{f'  ({parts})' if parts else ''}, {self.verdict}"


@dataclass(frozen=True, kw_only=True)
class RetrievalReason:
    """The last request to a memory, and what came of it."""

    memory: str
    time: float
    """When it was made [s]."""
    request: str
    """The pattern as it was written."""
    asked: str
    """The pattern with the values its variables had."""
    threshold: float | None
    require_new: bool
    finsts: tuple[str, ...]
    """What counted as retrieved lately."""
    excluded: tuple[str, ...]
    """Matching chunks left out for that reason."""
    candidates: tuple[CandidateReason, ...]
    """The matching chunks, most active first."""
    outcome: str
    """«retrieved», «failed», or «pending»: the answer is still on its way."""
    latency: float | None
    """How long the answer takes [s]; None where it is not known yet."""

    def __str__(self) -> str:
        limit = "no threshold" if self.threshold is None else f"threshold {self.threshold:g}"
        takes = "" if self.latency is None else f" ({self.latency:.6g} s)"
        asked = f"request '{self.request}' at {self.time:.3f} s, asked for '{self.asked}'"
        lines = [f"  {self.memory}: {asked}, {limit}: {self.outcome}{takes}"]
        if self.finsts:
            lines.append(f"      retrieved lately: {'; '.join(self.finsts)}")
        shown = self.candidates if len(self.candidates) <= MOST_SHOWN + 1 else self.candidates[:MOST_SHOWN]
        lines += [f"      {chunk}: left out, for it was retrieved lately" for chunk in self.excluded]
        if not self.candidates:
            lines.append("      no chunk matches" + (" that is new" if self.excluded else ""))
        lines += map(str, shown)
        if len(shown) < len(self.candidates):
            lines.append(f"      and {len(self.candidates) - len(shown):,} more, none of them more active")
        return "\n".join(lines)


def _reason(memory: str, time: float, data: Mapping[str, Any], outcome: str) -> RetrievalReason:
    """Makes a reason of what a request's trace event holds."""
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
            verdict = "won" if sum(row[3] == best for row in rows) == 1 else "won a draw by lot"
        elif chosen is None:
            verdict = f"below the threshold by {threshold - activation:.4g}" if threshold is not None else "lost"
        elif activation == best:
            verdict = "lost a draw by lot"
        else:
            verdict = f"lost by {best - activation:.4g}"
        modules = data["modules"] if len(data["modules"]) == len(parts) else ["get_activation"]
        named = dict(zip(_numbered(modules), parts, strict=True))
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


def _numbered(names: Sequence[str]) -> list[str]:
    """Tells modules of one class apart: DMNoise, DMNoise 2."""
    return [name if names[:i].count(name) == 0 else f"{name} {names[:i].count(name) + 1}" for i, name in enumerate(names)]


def live_retrieval(memory: Memory) -> RetrievalReason | None:
    """Returns the reason of a memory's last request; None where there was none."""
    record = memory._last
    if record is None:
        return None
    outcome = "pending" if memory.busy else "retrieved" if record.chosen is not None else "failed"
    return _reason(memory._path, seconds(record.time), record.to_data(), outcome)


def past_retrieval(memory: str, request: TraceEvent, outcome: str) -> RetrievalReason:
    """Returns the reason of a memory's request, as a trace has it, with what had come of it by then."""
    return _reason(memory, request.data.get("made", request.time), request.data, outcome)
