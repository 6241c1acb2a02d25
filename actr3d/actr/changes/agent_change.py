"""The base of all changes of agents."""

from __future__ import annotations

from actr3d.actr.changes.parts import Parts
from actr3d.change import Change


class AgentChange(Change):
    """A change of a part of an agent."""

    def carry_out(self, on: Parts) -> None:
        """Makes the change.

        Raises:
            Actr3dError: If it cannot be made; then nothing has changed.
        """
        raise NotImplementedError
