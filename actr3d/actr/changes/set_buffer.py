"""The change `set_buffer`."""

from __future__ import annotations

from dataclasses import dataclass

from actr3d.actr.changes.agent_change import AgentChange, Parts, chunk_of
from actr3d.actr.kernel.buffer import Buffer
from actr3d.change import change


@change
@dataclass(frozen=True)
class SetBuffer(AgentChange):
    """Sets a buffer to a chunk."""

    word = "set_buffer"
    of = "buffer"
    title = "Set"
    text = "{buffer} {chunk}"

    buffer: str
    """The path of the buffer."""
    chunk: str
    """The chunk, as a model writes it: `count 3`, `item:cup size:2`."""

    def carry_out(self, on: Parts) -> None:
        on.part(Buffer, self.buffer, "buffer").set(chunk_of(self.chunk, self.buffer))
