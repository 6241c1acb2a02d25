"""Holds the top models of a run, and the names that their parts have in its trace."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any, NamedTuple

from actr3d.actr.kernel.model import Model
from actr3d.actr.kernel.tree import path_of, subtree

PATHS = frozenset(("agent", "system", "memory", "module"))
"""The keys under which answers contain paths of parts."""


class Top(NamedTuple):
    """Holds a top model, or an agent of a simulation."""

    model: Model
    prefix: str = ""
    """The prefix of its parts' paths in the trace of a program, such as `top#2` for its second run if that is a simulation."""

    def parts(self) -> Iterator[tuple[str, Any]]:
        """Yields all its parts with their names."""
        for part in subtree(self.model):
            yield self.name(path_of(part)), part

    def name(self, path: str) -> str:
        """Returns the name of the part at a path."""
        return path if not self.prefix else self.prefix if path == "top" else f"{self.prefix}.{path}"

    def named(self, answer: Any) -> Any:
        """Returns an answer in plain values in which the paths of parts are replaced by their names."""
        if not self.prefix:
            return answer
        if isinstance(answer, dict):
            entries: list[tuple[str, Any]] = list(answer.items())  # pyright: ignore[reportUnknownArgumentType,reportUnknownVariableType]
            return {key: self.name(value) if key in PATHS and isinstance(value, str) else self.named(value) for key, value in entries}
        if isinstance(answer, (list, tuple)):
            return [self.named(one) for one in answer]  # pyright: ignore[reportUnknownVariableType]
        return answer
