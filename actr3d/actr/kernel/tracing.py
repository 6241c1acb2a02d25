"""Converts values to the form in which a trace keeps them."""

from __future__ import annotations

from typing import Any

from actr3d.actr.chunks.chunk import IMMUTABLE_TYPES, Chunk
from actr3d.actr.kernel.tree import TreeNode, path_of
from actr3d.values import Naming, plain

UNWATCHED = frozenset({"parent", "sch", "changes", "log", "random", "name"})
"""Attributes that hold the tree together; setting them is not a change that productions can see."""


def _known_part(value: Any) -> str | None:
    return Naming(f"<{path_of(value)}>") if issubclass(type(value), TreeNode) else None


def traceable(value: Any) -> Any:
    """Returns what a trace keeps of a value: plain values unchanged, chunks, lists and dicts as a copy, parts by their path."""
    if type(value) in IMMUTABLE_TYPES:
        return value
    if type(value) is Chunk and IMMUTABLE_TYPES.issuperset(map(type, value.values())):
        return lasting_slots(value)
    return plain(value, _known_part)


def lasting_slots(chunk: dict[Any, Any]) -> dict[str, Any]:
    """Returns what a trace keeps of a chunk with immutable values."""
    return {key if type(key) is str else str(plain(key)): item for key, item in chunk.items()}


def chunk_text(chunk: Chunk) -> str:
    """Returns a chunk as text, without calling the objects in its slots."""
    text = chunk.cached_text
    if text is not None:
        return text
    if IMMUTABLE_TYPES.issuperset(map(type, chunk.values())):
        return str(chunk)
    kept = {key: traceable(value) for key, value in chunk.items()}
    return (Naming if any(type(value) is Naming for value in kept.values()) else str)(Chunk(kept))
