"""The change `clear_buffer`."""

from __future__ import annotations

from dataclasses import dataclass

from actr3d.actr.changes.agent_change import AgentChange, Parts
from actr3d.actr.kernel.buffer import Buffer
from actr3d.change import change


@change
@dataclass(frozen=True)
class ClearBuffer(AgentChange):
    """Empties a buffer."""

    word = "clear_buffer"
    of = "buffer"
    title = "Clear"
    text = "{buffer}"

    buffer: str
    """The path of the buffer."""

    def carry_out(self, on: Parts) -> None:
        on.part(Buffer, self.buffer, "buffer").clear()
