"""The change `add_chunk`."""

from __future__ import annotations

from dataclasses import dataclass

from actr3d.actr.changes.agent_change import AgentChange, Parts, chunk_of
from actr3d.actr.declarative.memory import Memory, collect
from actr3d.change import change


@change
@dataclass(frozen=True)
class AddChunk(AgentChange):
    """Adds a chunk to a memory, or strengthens the equal one that is there."""

    word = "add_chunk"
    of = "memory"
    title = "Add"
    text = "{memory} {chunk}"

    memory: str
    """The path of the memory."""
    chunk: str
    """The chunk, as a model writes it: `count 3`, `item:cup size:2`."""

    def carry_out(self, on: Parts) -> None:
        memory = on.part(Memory, self.memory, "memory")
        collect(memory, chunk_of(self.chunk, self.memory))  # a failed retrieval stays one
