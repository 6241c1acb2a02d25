"""Saves and restores numpy's global random numbers in a microsecond."""

from __future__ import annotations

from collections.abc import Generator
from contextlib import contextmanager
from typing import Any, NamedTuple

import numpy.random
from numpy.random import BitGenerator

random: Any = numpy.random


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
        return random.MT19937.state.__get__(self)

    @state.setter
    def state(self, value: Any) -> None:
        if not self.apart:
            random.MT19937.state.__set__(self, value)


class Numbers(NamedTuple):
    """The source of numpy's global random numbers."""

    bits: BitGenerator
    rest: Any
    """The state beside the generator; for another kind of generator, all of its state."""


def own_numbers() -> Numbers:
    """Returns new, unshared numbers; the caller seeds them."""
    return Numbers(MT19937(0), {"bit_generator": "MT19937", "state": None, "has_gauss": 0, "gauss": 0.0})


def present_numbers() -> Numbers:
    """Returns the present numbers, to restore them later."""
    bits = random.get_bit_generator()
    if type(bits) is random.MT19937:
        state = random.get_state(legacy=False)
        bits = MT19937(0)
        random.set_bit_generator(bits)
        random.set_state(state)
    with _apart(bits):
        return Numbers(bits, random.get_state(legacy=False))


def put_in_place(numbers: Numbers) -> None:
    """Sets numpy's global random numbers."""
    random.set_bit_generator(numbers.bits)
    with _apart(numbers.bits):
        random.set_state(numbers.rest)


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
