"""Measures of a run: results that are computed from the world, not from the agents."""

from __future__ import annotations

from typing import Any, Protocol, TypeVar

from actr3d.registry import Registry
from actr3d.world import World


class Measure(Protocol):
    """Reads the world after every physics step of a run, and computes a result.

    Its methods are called as observers: they can read the sensors of bodies, which changes nothing that agents sense, and change nothing.
    Sensors have the noise of the body's description unless it is left out: `body.get("pose", noise=0)`. `look` must not draw from
    `random` or `numpy.random`: these numbers are the agents'.

    When a run goes back, times occur again: new values of a time replace former ones, and values after the present
    do not count.
    """

    def begin(self, world: World) -> None:
        """Prepares for a world, at its start.

        Raises:
            WorldError: If the world lacks what it measures.
        """
        ...

    def look(self) -> None:
        """Reads the world after a physics step, or a part of one; see `World.watchers`."""
        ...

    def result(self, *, over: bool) -> Any:
        """Returns the result up to now: an object of a frozen dataclass of plain values, whose `str` is for people; None for none yet.

        Args:
            over: Whether the agents have ended the run; otherwise it was cut short, or continues.
        """
        ...


M = TypeVar("M", bound="type[Measure]")

MEASURES: Registry[type[Measure]] = Registry("measure")
"""The measures of the library by the name of their class."""


def measure(kind: M) -> M:
    """Registers a measure under the name of its class.

    Raises:
        ValueError: If there is a measure of this name already.
    """
    MEASURES.add(kind.__name__, kind)
    return kind
