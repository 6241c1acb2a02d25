"""What observers get to see of a simulation: copies, which they may do with as they like."""

from __future__ import annotations

import mujoco
from mujoco import MjData, MjModel

from actr3d.clock import seconds
from actr3d.world import World, WorldState


class Glimpse:
    """The present of a simulation as an observer sees it. All of it is made when it is asked for, and is a copy.

    Args:
        world: What is seen.
        tick: How many ticks the run has gone.
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
        """The compiled scene; the live one, to be read only."""
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
        """Returns a copy of all that the physics needs to go on from here."""
        return self._world.state()
