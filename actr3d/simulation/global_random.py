"""Separate global random numbers (`random` and `numpy.random`) for each simulation."""

from __future__ import annotations

import random
from collections.abc import Generator
from contextlib import contextmanager
from types import TracebackType
from typing import Any, NamedTuple

import numpy.random
from numpy.random import BitGenerator

NUMPY: Any = numpy.random


class MT19937(numpy.random.MT19937):
    """numpy's bit generator, whose state can stay in place while another one is active.

    numpy stores half a pair of normal numbers beside the generator, and returns it only with the generator's whole state,
    copied number by number, which takes 25 us. The class has the name of numpy's, by which numpy identifies a state.
    """

    apart = False
    """Whether its state is left out when numpy gets and sets states."""

    @property
    def state(self) -> Any:
        """The state in numpy's format."""
        if self.apart:
            return {"bit_generator": "MT19937", "state": None}
        return NUMPY.MT19937.state.__get__(self)

    @state.setter
    def state(self, value: Any) -> None:
        if not self.apart:
            NUMPY.MT19937.state.__set__(self, value)


class Numbers(NamedTuple):
    """The state of all global random numbers."""

    pythons: Any
    """The state of `random`; None before the start of a run, which seeds it."""
    bits: BitGenerator
    """The source of numpy's."""
    rest: Any
    """The state beside the generator; for another kind of generator, all of its state."""


class GlobalRandom:
    """Sets `random` and `numpy.random` to a simulation's own state in a `with` block, and restores the former state after it.

    Agents that draw from them act the same whatever else the program, another simulation or an observer draws. Blocks may be
    nested; only the outermost takes time, about 20 us. Simulations in two threads at once still share them.
    """

    __slots__ = ("_depth", "_kept")

    def __init__(self) -> None:
        self._kept = Numbers(None, MT19937(0), {"bit_generator": "MT19937", "state": None, "has_gauss": 0, "gauss": 0.0})
        """Those that are not in place: outside the block the simulation's own, inside it the others."""
        self._depth = 0

    def __enter__(self) -> None:
        if not self._depth:
            self._exchange()
        self._depth += 1

    def __exit__(self, kind: type[BaseException] | None, error: BaseException | None, traceback: TracebackType | None) -> None:
        self._depth -= 1
        if not self._depth:
            self._exchange()

    @contextmanager
    def aside(self) -> Generator[None]:
        """Restores the former state inside the block, also within a block of the simulation."""
        if not self._depth:
            yield
            return
        depth, self._depth = self._depth, 0
        self._exchange()
        try:
            yield
        finally:
            self._exchange()
            self._depth = depth

    def _exchange(self) -> None:
        """Puts the simulation's own numbers in the place of the others, or the others back."""
        numbers, self._kept = self._kept, _present()
        if numbers.pythons is not None:
            random.setstate(numbers.pythons)
        NUMPY.set_bit_generator(numbers.bits)
        with _apart(numbers.bits):
            NUMPY.set_state(numbers.rest)


def _present() -> Numbers:
    """Returns the present numbers, to restore them later."""
    bits = NUMPY.get_bit_generator()
    if type(bits) is NUMPY.MT19937:
        state = NUMPY.get_state(legacy=False)
        bits = MT19937(0)
        NUMPY.set_bit_generator(bits)
        NUMPY.set_state(state)
    with _apart(bits):
        return Numbers(random.getstate(), bits, NUMPY.get_state(legacy=False))


@contextmanager
def _apart(bits: BitGenerator) -> Generator[None]:
    if not isinstance(bits, MT19937):
        yield
        return
    bits.apart = True
    try:
        yield
    finally:
        bits.apart = False
