"""The change `set_buffer`."""

from __future__ import annotations

from dataclasses import dataclass

from actr3d.actr.changes.agent_change import AgentChange
from actr3d.actr.changes.parts import Parts
from actr3d.actr.chunks.chunk import Chunk
from actr3d.actr.kernel.buffer import Buffer
from actr3d.change import change
from actr3d.errors import ChunkError


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


def chunk_of(text: str, where: str) -> Chunk:
    """Returns a chunk from a user's text.

    Raises:
        ChunkError: If the text has no slot, or a variable: no production is firing that could bind it.
    """
    try:
        chunk = Chunk(text)
    except ChunkError as error:
        raise ChunkError(f"'{where}': {error}; write a value") from None
    if not chunk:
        raise ChunkError(f"'{where}': a chunk has at least one slot, such as 'count 3' or 'item:cup' (got {text!r})")
    return chunk
