"""The record of one request to declarative memory: the pattern, the candidates with their activations, and the result."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import partial
from types import FunctionType
from typing import Any, cast

from actr3d.actr.chunks.chunk import Chunk
from actr3d.actr.declarative.chunk_query import ChunkSearch, PlainSearch
from actr3d.actr.kernel.noise import total
from actr3d.actr.kernel.tracing import chunk_text, traceable
from actr3d.warnings import warn_modeller

Row = tuple[Chunk, tuple[float, ...], float, float]
"""A chunk that matched a request, as a plain tuple, because there may be thousands: the chunk, what each activation module added in the
memory's order, the penalty of mismatches (0 or less), and the activation, which is the sum."""


def written(pattern: Any) -> str:
    """Returns a request as its author wrote it, with functions by their names."""
    if type(pattern) is str:
        return pattern
    if isinstance(pattern, (list, tuple)):
        return ", ".join(map(written, cast("Sequence[Any]", pattern)))
    if isinstance(pattern, FunctionType):
        return f"{pattern.__name__}()"
    return str(traceable(pattern))


@dataclass(slots=True)
class Retrieval:
    """One request and its result."""

    time: int
    """The time of the request [us]."""
    pattern: Any
    """As it was written."""
    search: ChunkSearch
    """With the values of its variables."""
    modules: Sequence[object]
    """The activation modules, in the order of each candidate's parts."""
    threshold: float | None
    require_new: bool
    marked: list[Chunk]
    """The recently retrieved chunks (finsts)."""
    rows: list[Row]
    """The candidates, in the order in which their activations are computed."""
    best: float = -math.inf
    """The highest activation."""
    excluded: Sequence[Chunk] = ()
    """Matching chunks that were excluded because they are marked."""
    chosen: Chunk | None = None
    latency: float | None = None
    """The duration of the retrieval or its failure [s]."""
    _kept: Callable[[], dict[str, Any]] | None = None

    def weigh(self, matches: Sequence[Chunk], parts_of: Callable[[Chunk], tuple[float, ...]] | None, memory: str) -> list[Chunk]:
        """Computes the activation of every chunk that matches, and returns the most active ones.

        Args:
            matches: The chunks; each gets its activation.
            parts_of: Returns the parts of a chunk's activation; None if it is 0 for all.
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
                cost = chunk.penalty
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

    def to_data(self) -> dict[str, Any]:
        """Returns the request as plain values, for the trace and for explanations.

        Chunks are shown as they were at the request in a traced run; otherwise as they are now.
        """
        return (self._kept or self._frozen())()

    def snapshot(self) -> Callable[[], dict[str, Any]]:
        """Returns a function that converts the request to plain values; everything that may change later is stored now."""
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
