"""Separate global random numbers (`random` and `numpy.random`) for each simulation."""

from __future__ import annotations

import random
from collections.abc import Generator
from contextlib import contextmanager
from types import TracebackType
from typing import Any

from actr3d.simulation.numpy_random import Numbers, own_numbers, present_numbers, put_in_place


class GlobalRandom:
    """Sets `random` and `numpy.random` to a simulation's own state in a `with` block, and restores the former state after it.

    Agents that draw from them act the same whatever else the program, another simulation or an observer draws. Blocks may be
    nested; only the outermost takes time, about 20 us. Simulations in two threads at once still share them.
    """

    __slots__ = ("_depth", "_others", "_own")

    def __init__(self) -> None:
        self._own: tuple[Any, Numbers] = (None, own_numbers())
        self._others: tuple[Any, Numbers] | None = None
        self._depth = 0

    def __enter__(self) -> None:
        if not self._depth:
            self._put_in_place()
        self._depth += 1

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None) -> None:
        self._depth -= 1
        if not self._depth:
            self._put_back()

    @contextmanager
    def aside(self) -> Generator[None]:
        """Restores the former state inside the block, also within a block of the simulation."""
        if not self._depth:
            yield
            return
        depth, self._depth = self._depth, 0
        self._put_back()
        try:
            yield
        finally:
            self._put_in_place()
            self._depth = depth

    def _put_in_place(self) -> None:
        self._others = _present()
        _put(self._own)

    def _put_back(self) -> None:
        self._own = _present()
        assert self._others is not None
        _put(self._others)


def _present() -> tuple[Any, Numbers]:
    return random.getstate(), present_numbers()


def _put(numbers: tuple[Any, Numbers]) -> None:
    state, of_numpy = numbers
    if state is not None:  # a run seeds its own at its start
        random.setstate(state)
    put_in_place(of_numpy)
