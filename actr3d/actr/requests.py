"""The record of one request to declarative memory: what was asked, who stood for it, what came of it."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import partial
from types import FunctionType
from typing import Any, cast

from actr3d.actr.chunk import Chunk
from actr3d.actr.search import PlainSearch, Search
from actr3d.actr.traced import chunk_text, traceable


@dataclass(slots=True)
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
    if isinstance(pattern, (list, tuple)):
        return ", ".join(map(written, cast("Sequence[Any]", pattern)))
    if isinstance(pattern, FunctionType):
        return f"{pattern.__name__}()"
    return pattern if type(pattern) is str else str(traceable(pattern))


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
    excluded: Sequence[Chunk] = ()
    """Matching chunks that were left out for being marked."""
    candidates: list[Candidate] = field(default_factory=list[Candidate])
    chosen: Chunk | None = None
    latency: float | None = None
    """How long the retrieval or its failure takes [s]."""
    _kept: Callable[[], dict[str, Any]] | None = None

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
        names = [chunk_text(candidate.chunk) for candidate in self.candidates]
        asked = None if type(self.search) is PlainSearch else str(self.search)
        marked, excluded = [chunk_text(c) for c in self.marked], [chunk_text(c) for c in self.excluded]
        return partial(self._data, names, marked, excluded, written(self.pattern), asked)

    def _data(self, names: list[str], marked: list[str], excluded: list[str], pattern: str, asked: str | None) -> dict[str, Any]:
        chosen = next((number for number, candidate in enumerate(self.candidates) if candidate.chunk is self.chosen), None)
        rows = [[name, list(c.parts), c.partial, c.activation] for name, c in zip(names, self.candidates, strict=True)]
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
