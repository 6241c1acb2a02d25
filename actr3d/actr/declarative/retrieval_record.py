"""The record of one request to declarative memory: what was asked, who stood for it, what came of it."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from types import FunctionType
from typing import Any, cast

from actr3d.actr.chunks.chunk import Chunk
from actr3d.actr.declarative.chunk_query import PlainSearch, Search
from actr3d.actr.kernel.noise import total
from actr3d.actr.kernel.tracing import chunk_text, traceable
from actr3d.saying import warn_modeller

Row = tuple[Chunk, tuple[float, ...], float, float]
"""A candidate as it is kept, of which there may be thousands: (chunk, parts, partial, activation)."""


@dataclass(frozen=True, slots=True)
class Candidate:
    """A chunk that matched a request, and how it stood."""

    chunk: Chunk
    parts: tuple[float, ...]
    """What each activation module added, in the memory's order."""
    partial: float
    """What mismatches cost (0 or less)."""
    activation: float
    """The sum."""


def written(pattern: Any) -> str:
    """Returns a request as its author wrote it, a function by its name."""
    if type(pattern) is str:
        return pattern
    if isinstance(pattern, (list, tuple)):
        return ", ".join(map(written, cast("Sequence[Any]", pattern)))
    if isinstance(pattern, FunctionType):
        return f"{pattern.__name__}()"
    return str(traceable(pattern))


@dataclass(slots=True)
class Retrieval:
    """One request and what came of it."""

    time: int
    """When it was made [us]."""
    pattern: Any
    """As it was written."""
    search: Search
    """With the values that its variables had."""
    modules: Sequence[object]
    """The activation modules, in the order of each candidate's parts."""
    threshold: float | None
    require_new: bool
    marked: list[Chunk]
    """What had been retrieved lately (finsts)."""
    rows: list[Row]
    """The candidates, as they are weighed one after another."""
    best: float = -math.inf
    """The highest activation."""
    excluded: Sequence[Chunk] = ()
    """Matching chunks that were left out for being marked."""
    chosen: Chunk | None = None
    latency: float | None = None
    """How long the retrieval or its failure takes [s]."""
    _kept: Callable[[], dict[str, Any]] | None = None

    def weigh(self, matches: Sequence[Chunk], parts_of: Callable[[Chunk], tuple[float, ...]] | None, memory: str) -> list[Chunk]:
        """Weighs every chunk that matches, and returns the most active ones.

        Args:
            matches: The chunks; each gets its activation.
            parts_of: Gives the parts of a chunk's activation; None where it is 0 for all.
            memory: The memory's name, for warnings.
        """
        partial = self.search.partial
        parts: tuple[float, ...] = ()
        add = self.rows.append
        best = -math.inf
        winners: list[Chunk] = []
        for chunk in cast("Sequence[Any]", matches):
            activation: float = 0
            cost = 0.0
            if parts_of is not None:
                parts = parts_of(chunk)
                activation = total(parts)
            if partial is not None:
                cost = chunk._partial
                activation += cost
            chunk.activation = activation
            add((chunk, parts, cost, activation))
            if activation > best:
                best, winners = activation, [chunk]
            elif activation == best:
                winners.append(chunk)
            elif activation != activation:
                warn_modeller(f"memory '{memory}': the activation of '{chunk}' is not a number, so it cannot be retrieved")
        self.best = best
        return winners

    @property
    def candidates(self) -> list[Candidate]:
        """The chunks that stood for the request, in the order they came."""
        return [Candidate(*row) for row in self.rows]

    def to_data(self) -> dict[str, Any]:
        """Returns the request as plain values, for the trace and for explanations.

        Chunks are as they were then in a traced run; otherwise as they are now.
        """
        return (self._kept or self._frozen())()

    def snapshot(self) -> Callable[[], dict[str, Any]]:
        """Returns a function that makes plain values of the request; what may change later is taken down now, for good."""
        self._kept = self._frozen()
        return self._kept

    def _frozen(self) -> Callable[[], dict[str, Any]]:
        names = [chunk_text(row[0]) for row in self.rows]
        asked = None if type(self.search) is PlainSearch else str(self.search)
        marked, excluded = [chunk_text(c) for c in self.marked], [chunk_text(c) for c in self.excluded]
        return partial(self._data, names, marked, excluded, written(self.pattern), asked)

    def _data(self, names: list[str], marked: list[str], excluded: list[str], pattern: str, asked: str | None) -> dict[str, Any]:
        chosen = next((number for number, row in enumerate(self.rows) if row[0] is self.chosen), None)
        rows = [[name, list(parts), cost, activation] for name, (_, parts, cost, activation) in zip(names, self.rows, strict=True)]
        return {
            "pattern": pattern,
            "asked": str(self.search) if asked is None else asked,
            "threshold": self.threshold,
            "require_new": self.require_new,
            "finsts": marked,
            "excluded": excluded,
            "modules": [type(module).__name__ for module in self.modules],
            "partial": self.search.partial is not None,
            "candidates": rows,
            "chosen": chosen,
            "latency": self.latency,
        }
