"""The numbers of Python's module `random`, which all of a program shares, as one simulation's own."""

from __future__ import annotations

import random
from collections.abc import Generator
from contextlib import contextmanager
from types import TracebackType
from typing import Any


class GlobalRandom:
    """Lets the module `random` be a simulation's own in a `with` block; everybody else finds it as they left it.

    So minds that draw from it do the same whatever else the program, another simulation or an observer draws. Blocks may
    stand in one another; only the outermost costs time, about 20 us. Simulations in two threads at once still share it.
    """

    __slots__ = ("_depth", "_others", "_own")

    def __init__(self) -> None:
        self._own: Any = None
        self._others: Any = None
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
        """Lets it be everybody else's inside the block, also where that stands inside one of the simulation's own."""
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
        self._others = random.getstate()
        if self._own is not None:
            random.setstate(self._own)

    def _put_back(self) -> None:
        self._own = random.getstate()
        random.setstate(self._others)
