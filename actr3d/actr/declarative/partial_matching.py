"""Partial matching: similar values may match, at the price of activation."""

from __future__ import annotations

from collections.abc import Collection
from typing import Any, Protocol

from actr3d.actr.chunks.chunk import Slot, as_text
from actr3d.actr.kernel.parameters import WithParameters, named_parameters
from actr3d.actr.kernel.profile import PYTHON_ACTR, Profile
from actr3d.saying import warn_modeller


class PartialMemory(Protocol):
    """The memory that similarities belong to."""

    partials: list[Partial]

    @property
    def rules(self) -> Profile:
        """Its profile."""
        ...

    def request(self, pattern: Any, partial: Partial | None = None) -> None:
        """Asks for the most active chunk that matches."""
        ...


class Partial(WithParameters):
    """Lets a memory retrieve chunks whose values are only similar to those asked for.

    Args:
        memory: The memory; its first `Partial` serves all requests that name no other.
        strength: MP, what a mismatch of -1 costs in activation; None for similarities that only blending uses: then only
            chunks match that have what was asked for.
        limit: The similarity of values that nothing is said about.

    Source: P = sum MP M_l (Anderson & Lebiere 1998, equation 3.7).
    """

    @named_parameters
    def __init__(self, memory: PartialMemory, strength: float | None = 1.0, limit: float = -1.0) -> None:
        self._memory = memory
        self.limit = limit
        self.strength = strength
        self.sims: dict[tuple[Any, Any], float] = {}
        self._texts: dict[tuple[str, str], float] = {}
        memory.partials.append(self)

    def similarity(self, a: Any, b: Any, value: float) -> None:
        """Says how similar two values are, in both directions; 0 is the same, less is less similar."""
        self.sims[a, b] = value
        self.sims[b, a] = value
        self._texts[as_text(a), as_text(b)] = value
        self._texts[as_text(b), as_text(a)] = value

    def request(self, pattern: Any) -> None:
        """Asks the memory with these similarities."""
        self._memory.request(pattern, partial=self)

    def match(self, key: Slot, a: str, b: str) -> float:
        """Returns what finding `b` where `a` was asked for adds to activation (0 or less)."""
        return (self.strength or 0.0) * self.between(a, b)

    def between(self, a: str, b: str) -> float:
        """Returns how similar two different values are, given as patterns compare them."""
        similarity = self.sims.get((a, b))
        if similarity is None and (a, b) in self._texts:
            if self._memory.rules is PYTHON_ACTR:  # patterns compare text, and it looks text up among numbers
                warn_modeller(f"what is said of the similarity of {a} and {b} is not found, for patterns compare text: write '{a}', '{b}'")
            else:
                similarity = self._texts[a, b]
        return self.limit if similarity is None else similarity

    def related(self, texts: Collection[str]) -> list[Any]:
        """Returns the values of which a similarity to one of these texts was said, in the order they were first named."""
        found = {as_text(a): a for a, b in reversed(self.sims) if as_text(b) in texts}
        return [*reversed(found.values())]

    def negated(self, key: Slot, value: str) -> float | None:
        """Returns what finding just what was not wanted adds; None where that rules the chunk out (not in ACT-R 7)."""
        profile = self._memory.rules
        return (self.strength or 0.0) * self.limit if profile.negations_cost else None
