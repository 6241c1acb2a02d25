"""Observers of a simulation."""

from __future__ import annotations

from collections.abc import Callable, Generator
from contextlib import contextmanager

from actr3d.simulation.global_random import GlobalRandom
from actr3d.simulation.snapshot import Glimpse

Observer = Callable[[Glimpse], object]


class Observers:
    """Shows the present to all observers, which cannot change anything meanwhile.

    Args:
        random: The global random numbers of the agents, which observers must not use up.
    """

    def __init__(self, random: GlobalRandom) -> None:
        self._random = random
        self._observers: list[Observer] = []
        self.looking = False
        """Whether an observer, a listener or a condition is being called now."""

    def add(self, observer: Observer) -> None:
        """Adds an observer."""
        self._observers.append(observer)

    def show(self, make: Callable[[], Glimpse]) -> None:
        """Calls the observers with what `make` returns; without observers it makes nothing.

        Raises:
            Exception: What an observer raises.
        """
        if not self._observers:
            return
        glimpse = make()
        with self.only_looking():
            for observer in self._observers:
                observer(glimpse)

    @contextmanager
    def only_looking(self) -> Generator[None]:
        """Prevents changes to the simulation inside the block, those of the agents' random numbers included."""
        before, self.looking = self.looking, True
        try:
            with self._random.aside():
                yield
        finally:
            self.looking = before
