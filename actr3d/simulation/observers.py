"""Observers of a simulation, and what they receive: copies, which they may change."""

from __future__ import annotations

from collections.abc import Callable, Generator
from contextlib import contextmanager
from copy import copy

import mujoco
from mujoco import MjData, MjModel

from actr3d.clock import seconds
from actr3d.errors import SimulationError
from actr3d.simulation.global_random import GlobalRandom
from actr3d.world import World, WorldState


class Glimpse:
    """The present of a simulation for an observer. Each value is a copy, made on first use.

    Args:
        world: The world.
        tick: Number of completed ticks.
    """

    __slots__ = ("_data", "_model", "_world", "tick")

    def __init__(self, world: World, tick: int) -> None:
        self._world = world
        self.tick = tick
        self._data: MjData | None = None
        self._model: MjModel | None = None

    @property
    def time(self) -> float:
        """The time since the start [s]."""
        return seconds(self._world.time)

    @property
    def mj_model(self) -> MjModel:
        """A copy of the compiled scene."""
        if self._model is None:
            self._model = copy(self._world.mj_model)
        return self._model

    @property
    def mj_data(self) -> MjData:
        """A copy of the state, with positions, contacts and rays of this moment."""
        if self._data is None:
            self._data = MjData(self.mj_model)  # `mj_data.model` is the model that it is made with
            mujoco.mj_copyData(self._data, self.mj_model, self._world.mj_data)
            mujoco.mj_fwdPosition(self.mj_model, self._data)
        return self._data

    def state(self) -> WorldState:
        """Returns a copy of all that the physics needs to continue from here."""
        return self._world.state()


Observer = Callable[[Glimpse], object]


class Observers:
    """Shows the present to all observers, which cannot change anything meanwhile.

    Args:
        random: The global random numbers of the agents, which observers must not use up.
        world: The world, whose bodies observers may read but not change.
    """

    def __init__(self, random: GlobalRandom, world: World) -> None:
        self._random = random
        self._physics = world.physics
        self._observers: list[Observer] = []
        self._of_calls: list[Observer] = []

    @property
    def looking(self) -> bool:
        """Whether an observer, a listener or a condition is being called now."""
        return self._physics.observed

    def add(self, observer: Observer, *, of_calls: bool = False) -> None:
        """Adds an observer of each moment, or of the end of each call.

        Raises:
            SimulationError: If it is not a function.
        """
        if not callable(observer):
            raise SimulationError(f"observe(observer): must be a function that takes a Glimpse (got {observer!r})")
        (self._of_calls if of_calls else self._observers).append(observer)

    def show(self, make: Callable[[], Glimpse], *, of_calls: bool = False) -> None:
        """Calls the observers with what `make` returns; without observers it makes nothing.

        Raises:
            Exception: What an observer raises.
        """
        observers = self._of_calls if of_calls else self._observers
        if not observers:
            return
        glimpse = make()
        with self.only_looking():
            for observer in observers:
                observer(glimpse)

    @contextmanager
    def only_looking(self) -> Generator[None]:
        """Prevents changes to the simulation inside the block, those of the agents' random numbers included."""
        before, self._physics.observed = self._physics.observed, True
        try:
            with self._random.aside():
                yield
        finally:
            self._physics.observed = before
