"""Partial matching: similar values may match, with a penalty on activation."""

from __future__ import annotations

from collections.abc import Collection
from typing import Any, Protocol

from actr3d.actr.chunks.chunk import Slot, as_text
from actr3d.actr.declarative.activation_parts import activation_part
from actr3d.actr.kernel.parameters import Extended, WithParameters, check_number, named_parameters
from actr3d.actr.kernel.profile import PYTHON_ACTR, Profile
from actr3d.errors import ParameterError
from actr3d.warnings import warn_modeller


class PartialMemory(Protocol):
    """The memory that similarities belong to."""

    partials: list[Partial]

    @property
    def effective_profile(self) -> Profile:
        """Its profile."""
        ...

    def request(self, pattern: Any, partial: Partial | None = None) -> None:
        """Requests the most active chunk that matches."""
        ...


@activation_part("partial match", "partial")
class Partial(WithParameters):
    """Permits a memory to retrieve chunks whose values are only similar to those requested.

    Args:
        memory: The memory; its first `Partial` is the default of all requests.
        strength: MP, the penalty of a mismatch of -1; None for similarities that only blending uses: then only chunks with the
            requested values match.
        limit: The similarity of values for which none was declared.

    Raises:
        ParameterError: If the memory is something else.

    Source: P = sum MP M_l (Anderson & Lebiere 1998, equation 3.7).
    """

    @named_parameters
    def __init__(self, memory: PartialMemory, strength: float | None = 1.0, limit: Extended = -1.0) -> None:
        if not hasattr(memory, "partials"):
            raise ParameterError(f"Partial.memory: must be a Memory (got {memory!r})")
        self._memory = memory
        self.limit = limit
        self.strength = strength
        self.sims: dict[tuple[Any, Any], float] = {}
        self._texts: dict[tuple[str, str], float] = {}
        memory.partials.append(self)

    def similarity(self, a: Any, b: Any, value: float) -> None:
        """Declares the similarity of two values, in both directions; 0 means equal, negative numbers mean less similar.

        Raises:
            ParameterError: If it is not a number.
        """
        check_number(value, f"{type(self).__name__}.similarity({a!r}, {b!r})", infinite=True, nan=True)
        self.sims[a, b] = value
        self.sims[b, a] = value
        self._texts[as_text(a), as_text(b)] = value
        self._texts[as_text(b), as_text(a)] = value

    def request(self, pattern: Any) -> None:
        """Requests a chunk from the memory, with these similarities."""
        self._memory.request(pattern, partial=self)

    def match(self, key: Slot, a: str, b: str) -> float:
        """Returns the penalty for finding `b` where `a` was requested (0 or less)."""
        return (self.strength or 0.0) * self.between(a, b)

    def between(self, a: str, b: str) -> float:
        """Returns the similarity of two different values, given as patterns compare them."""
        similarity = self.sims.get((a, b))
        if similarity is None and (a, b) in self._texts:
            if self._memory.effective_profile is PYTHON_ACTR:  # patterns compare text, and it looks text up among numbers
                warn_modeller(f"the similarity of {a} and {b} is not found, because patterns compare text: write '{a}', '{b}'")
            else:
                similarity = self._texts[a, b]
        return self.limit if similarity is None else similarity

    def related(self, texts: Collection[str]) -> list[Any]:
        """Returns the values that were declared similar to one of these texts, in the order in which they were first named."""
        found = {as_text(a): a for a, b in reversed(self.sims) if as_text(b) in texts}
        return [*reversed(found.values())]

    def negated(self, key: Slot, value: str) -> float | None:
        """Returns the penalty for a value that the pattern negates; None if it excludes the chunk (not in ACT-R 7)."""
        profile = self._memory.effective_profile
        return (self.strength or 0.0) * self.limit if profile.negations_cost else None
