"""A memory as a table for observers: its chunks, and the parts of their activations. Nothing is changed or drawn."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from itertools import islice
from typing import Any

from actr3d.actr.chunks.chunk import IMMUTABLE_TYPES, Chunk
from actr3d.actr.declarative.activation import DMBaseLevel, DMFixed, MemorySubModule
from actr3d.actr.declarative.association import DMAssociate, DMInhibition
from actr3d.actr.declarative.memory import Memory, own_activation
from actr3d.actr.declarative.spreading import DMSalience, DMSpreading
from actr3d.actr.explain.module_reasons import numbered
from actr3d.actr.kernel.noise import total
from actr3d.actr.kernel.tracing import chunk_text, traceable
from actr3d.errors import ChunkError

_READABLE: frozenset[type[MemorySubModule]] = frozenset({DMBaseLevel, DMFixed, DMSpreading, DMSalience, DMAssociate, DMInhibition})
"""The modules that can be read at any time: they draw no random numbers, and run none of the modeller's code."""


@dataclass(frozen=True, kw_only=True)
class MemoryRow:
    """One chunk of a memory."""

    chunk: str
    slots: Mapping[str, Any]
    activation: float | None
    """The sum of its parts; None if one of them is not known."""
    parts: Mapping[str, float | None]
    """What each activation module adds now, by its class (numbered if there are several); None for a part that is drawn only at
    a retrieval, or computed by the modeller's own code."""


def memory_rows(memory: Memory, words: str = "", most: int | None = None) -> list[MemoryRow]:
    """Returns the chunks of a memory, in the order in which they were added.

    Args:
        memory: The memory.
        words: Selects chunks whose text contains all of these, ignoring case.
        most: The maximum number of rows; None for all.
    """
    wanted = words.lower().split()
    found = (chunk for chunk in memory.dm if all(word in chunk_text(chunk).lower() for word in wanted))
    return [_row(memory, chunk) for chunk in islice(found, most)]


def _row(memory: Memory, chunk: Chunk) -> MemoryRow:
    parts = {name: part_now(module, chunk) for name, module in named_modules(memory)}
    known = [value for value in parts.values() if value is not None]
    own = own_activation(memory) is not None
    return MemoryRow(
        chunk=chunk_text(chunk),
        slots={str(key): traceable(value) for key, value in chunk.items()},
        activation=total(known) if len(known) == len(parts) and not own else None,
        parts={"get_activation": None} if own else parts,
    )


def named_modules(memory: Memory) -> Iterator[tuple[str, MemorySubModule]]:
    """Returns the activation modules of a memory by the names of their parts."""
    return zip(numbered([type(module).__name__ for module in memory.adaptors]), memory.adaptors, strict=True)


def part_now(module: MemorySubModule, chunk: Chunk) -> float | None:
    """Returns what a module adds to a chunk's activation now; None if it is known only at a retrieval."""
    if type(module) not in _READABLE or not IMMUTABLE_TYPES.issuperset(map(type, chunk.values())):
        return None
    try:
        return module.activation_for_observer(chunk) if isinstance(module, DMSpreading) else module.activation(chunk)
    except (ChunkError, ArithmeticError, ValueError):
        return None
