"""The numbers of `random` and `numpy.random`, which all of a program shares, as one simulation's own."""

from __future__ import annotations

import random
from collections.abc import Generator
from contextlib import contextmanager
from types import TracebackType
from typing import Any

from actr3d.simulation.numpy_random import Numbers, own_numbers, present_numbers, put_in_place


class GlobalRandom:
    """Lets `random` and `numpy.random` be a simulation's own in a `with` block; everybody else finds them as they left them.

    So minds that draw from them do the same whatever else the program, another simulation or an observer draws. Blocks may
    stand in one another; only the outermost costs time, about 20 us. Simulations in two threads at once still share them.
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
        """Lets them be everybody else's inside the block, also where that stands inside one of the simulation's own."""
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
    if state is not None:  # a run that begins seeds its own
        random.setstate(state)
    put_in_place(of_numpy)
