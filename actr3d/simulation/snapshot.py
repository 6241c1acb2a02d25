"""The view of a simulation for observers: copies, which they may change."""

from __future__ import annotations

import mujoco
from mujoco import MjData, MjModel

from actr3d.clock import seconds
from actr3d.world import World, WorldState


class Glimpse:
    """The present of a simulation for an observer. Each value is a copy, made on first use.

    Args:
        world: The world.
        tick: Number of completed ticks.
    """

    __slots__ = ("_data", "_world", "tick")

    def __init__(self, world: World, tick: int) -> None:
        self._world = world
        self.tick = tick
        self._data: MjData | None = None

    @property
    def time(self) -> float:
        """The time since the start [s]."""
        return seconds(self._world.time)

    @property
    def mj_model(self) -> MjModel:
        """The compiled scene itself; read only."""
        return self._world.mj_model

    @property
    def mj_data(self) -> MjData:
        """A copy of the state, with positions, contacts and rays of this moment."""
        if self._data is None:
            self._data = MjData(self._world.mj_model)
            mujoco.mj_copyData(self._data, self._world.mj_model, self._world.mj_data)
            mujoco.mj_fwdPosition(self._world.mj_model, self._data)
        return self._data

    def state(self) -> WorldState:
        """Returns a copy of all that the physics needs to continue from here."""
        return self._world.state()
