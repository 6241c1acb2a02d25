"""numpy's global random numbers, as something that can be put aside and into its place again in a microsecond."""

from __future__ import annotations

from collections.abc import Generator
from contextlib import contextmanager
from typing import Any, NamedTuple

import numpy.random
from numpy.random import BitGenerator

random: Any = numpy.random


class MT19937(numpy.random.MT19937):
    """numpy's own generator of bits, whose state may stay where it is while another one takes its place.

    numpy keeps half a pair of normal numbers beside the generator, and gives it out with the generator's whole state only,
    copied number by number, which takes 25 us. Its name is that of numpy's, by which numpy knows whose state it has.
    """

    apart = False
    """Whether its state is left out of what numpy gives out and takes."""

    @property
    def state(self) -> Any:
        """The state as numpy has it."""
        if self.apart:
            return {"bit_generator": "MT19937", "state": None}
        return random.MT19937.state.__get__(self)

    @state.setter
    def state(self, value: Any) -> None:
        if not self.apart:
            random.MT19937.state.__set__(self, value)


class Numbers(NamedTuple):
    """What numpy's global numbers come from."""

    bits: BitGenerator
    rest: Any
    """What there is beside the generator; all of the state, of a generator that somebody else chose."""


def own_numbers() -> Numbers:
    """Returns new ones, that nobody shares; to be seeded by who uses them."""
    return Numbers(MT19937(0), {"bit_generator": "MT19937", "state": None, "has_gauss": 0, "gauss": 0.0})


def present_numbers() -> Numbers:
    """Returns those in place, to be put back later."""
    bits = random.get_bit_generator()
    if type(bits) is random.MT19937:
        state = random.get_state(legacy=False)
        bits = MT19937(0)
        random.set_bit_generator(bits)
        random.set_state(state)
    with _apart(bits):
        return Numbers(bits, random.get_state(legacy=False))


def put_in_place(numbers: Numbers) -> None:
    """Lets numpy's global numbers be these."""
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
