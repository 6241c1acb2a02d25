"""The base of all changes of a world."""

from __future__ import annotations

from actr3d.change import Change
from actr3d.world.world import World


class WorldChange(Change):
    """A change of the world: of its state, not of the compiled model, so that a stored state contains its effect."""

    def carry_out(self, on: World) -> None:
        """Makes the change.

        Raises:
            WorldError: If it cannot be made; then nothing has changed.
        """
        raise NotImplementedError
