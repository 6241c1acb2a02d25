"""The change `strengthen`."""

from __future__ import annotations

from dataclasses import dataclass

from actr3d.actr.changes.agent_change import AgentChange, Parts
from actr3d.actr.declarative.activation import DMFixed, MemorySubModule
from actr3d.actr.declarative.memory import Memory, collect
from actr3d.actr.kernel.tracing import chunk_text
from actr3d.change import change
from actr3d.errors import ChunkError

WITHOUT_EFFECT = (MemorySubModule.merge, DMFixed.merge)
"""The activation of a module with one of these methods does not change when a chunk is added again without an amount."""


@change
@dataclass(frozen=True)
class Strengthen(AgentChange):
    """Strengthens a chunk of a memory, as if the model had added it once more."""

    word = "strengthen"
    of = "chunk"
    title = "Strengthen"
    text = "{memory} {chunk}"

    memory: str
    """The path of the memory."""
    chunk: str
    """The chunk as text, as the table of the memory shows it."""

    def carry_out(self, on: Parts) -> None:
        memory = on.part(Memory, self.memory, "memory")
        known = {chunk_text(chunk): chunk for chunk in memory.dm}
        if self.chunk not in known:
            raise ChunkError(f"no chunk '{self.chunk}' in '{self.memory}'; `add_chunk` adds it")
        if all(type(module).merge in WITHOUT_EFFECT for module in memory.adaptors):
            raise ChunkError(f"'{self.memory}' has no base level (DMBaseLevel), so a chunk that is added again is not stronger")
        collect(memory, known[self.chunk])  # a failed retrieval stays one
