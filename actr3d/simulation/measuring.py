"""What is measured of a run: its result, which the world tells and not the mind."""

from __future__ import annotations

from typing import Any, Protocol

from actr3d.world import World


class Measure(Protocol):
    """Looks at every physics step of a run, and says in the end what came of it. It changes nothing.

    Where a run goes back, times come again: what was kept of a time is then replaced, and what lies after the present
    does not count.
    """

    def begin(self, world: World) -> None:
        """Gets to know the world, at its start.

        Raises:
            WorldError: If what is to be measured is not there.
        """
        ...

    def look(self) -> None:
        """Looks at the world after a physics step, or a part of one; see `World.watchers`."""
        ...

    def result(self, *, over: bool) -> Any:
        """Returns what has been measured up to now, a frozen dataclass of plain values; `str` of it is for people.

        Args:
            over: Whether the minds have brought the run to its end; otherwise it was cut short, or goes on.
        """
        ...
