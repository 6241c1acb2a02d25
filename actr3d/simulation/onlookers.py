"""Who looks on at a simulation."""

from __future__ import annotations

from collections.abc import Callable, Generator
from contextlib import contextmanager

from actr3d.simulation.glimpse import Glimpse
from actr3d.simulation.global_random import GlobalRandom

Observer = Callable[[Glimpse], object]


class Onlookers:
    """Shows the present to all observers, who cannot change anything meanwhile.

    Args:
        random: The random numbers as the minds have them, which observers are to leave as they are.
    """

    def __init__(self, random: GlobalRandom) -> None:
        self._random = random
        self._observers: list[Observer] = []
        self.looking = False
        """Whether one of them, or somebody else who only looks, is looking now."""

    def add(self, observer: Observer) -> None:
        """Calls an observer from now on."""
        self._observers.append(observer)

    def show(self, make: Callable[[], Glimpse]) -> None:
        """Shows what `make` returns; nothing is made where nobody looks.

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
        """Lets somebody look inside the block who cannot change anything, the minds' random numbers included."""
        before, self.looking = self.looking, True
        try:
            with self._random.aside():
                yield
        finally:
            self.looking = before
