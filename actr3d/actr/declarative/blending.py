"""Blending: a retrieval that mixes the numbers of all matching chunks."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Annotated, Any

from annotated_types import Gt

from actr3d.actr.chunks.chunk import Chunk, as_number, as_text
from actr3d.actr.declarative.activation import DMNoise
from actr3d.actr.declarative.memory import Memory
from actr3d.actr.declarative.partial_matching import Partial
from actr3d.actr.declarative.retrieval_record import Retrieval
from actr3d.actr.declarative.spreading import names_a_chunk


class BlendingMemory(Memory):
    """A memory whose retrievals are blends of all matching chunks, each weighted by p = exp(A / t) / sum exp(A / t).

    In Python ACT-R each numeric slot holds the mean over all matching chunks with the same slots, the other slots are the most
    active chunk's, t is 1, and the time is the most active chunk's.

    In ACT-R 7 the requested slots have the requested values, and each other slot a compromise:

    - If all values are numbers, the sum of p times the value; chunks without the slot add nothing, and their weight is not
      redistributed.
    - Otherwise the value V with the smallest sum of p times the squared similarity of V to the chunk's value. The candidates are
      the values of the matching chunks, and, if all of these are words, every value declared similar to one of them, even if no
      chunk has it. The first of equally good candidates wins: in the order in which chunks were added to the memory, then
      values in the order in which similarities were declared.
    - A missing value (none, or None) is ignored.

    There t is sqrt(2) times the activation noise, and the time comes from ln sum exp A. Similarities are those of the `Partial`
    used for the request, or of the memory's first one (`Partial(memory, strength=None)` for blending only); without one,
    the similarity of different values is -1.

    ACT-R 7 finds further candidates among the chunks in memory that have the same slots as the chunks that the values name. Here
    values are words, so the declared similarities name the further candidates; words without any could not win.

    Source: Lebiere (1999), Kognitionswissenschaft 8; ACT-R 7, extras/blending/blending-read-me.txt, methods a to c.
    """

    temperature: Annotated[float, Gt(0)] | None
    """t; the profile's if it is None or was never set."""

    def recall(self, chunk: Any, matches: list[Any], request_number: int) -> Iterator[float]:
        matches = [match for match in matches if not math.isnan(match.activation)]
        if self.effective_profile.blend_every_slot:
            chunk = self._compromise(matches)
        else:
            numeric = [slot for slot in sorted(chunk, key=str) if as_number(chunk[slot]) is not None]
            if numeric:
                blend: Any = Chunk(chunk)
                blend.activation = chunk.activation
                slots = set(chunk)
                self._mix(blend, numeric, [match for match in matches if set(match) == slots])
                chunk = blend
        yield from Memory.recall(self, chunk, matches, request_number)

    # -- as in ACT-R 7

    def _compromise(self, matches: Sequence[Any]) -> Chunk:
        """Returns the blend of all matching chunks."""
        search = self._last.search if self._last is not None else None
        fixed = {slot: text for slot, text in search.equal if text != "None"} if search is not None else {}
        partial = search.partial if search is not None and search.partial is not None else next(iter(self.partials), None)
        weights = self._weights(matches)
        blend: Any = Chunk({})
        for slot in dict.fromkeys([*fixed, *(slot for match in matches for slot in match)]):
            held = [(match[slot], weight) for match, weight in zip(matches, weights, strict=True) if as_text(match.get(slot)) != "None"]
            if slot in fixed:
                blend[slot] = next((value for value, _ in held if as_text(value) == fixed[slot]), fixed[slot])
            elif held:
                blend[slot] = _blended(held, partial, math.fsum(weights))
        blend.activation = self._match_score(matches)
        return blend

    def _weights(self, matches: Sequence[Any]) -> list[float]:
        """Returns the weight of each chunk, relative to the most active one."""
        t = self._temperature()
        largest = max(match.activation for match in matches)
        return [1.0 if m.activation == largest else math.exp((m.activation - largest) / t) for m in matches]

    # -- as in Python ACT-R

    def _mix(self, blend: Chunk, numeric: Sequence[Any], matches: Sequence[Any]) -> None:
        """Sets the numeric slots of a blend."""
        t = self._temperature()
        # exp is relative to the largest only where it would overflow, so that sums round as in python_actr 1.9.5.
        largest = max(match.activation for match in matches) / t
        shift = largest if abs(largest) > 600 and math.isfinite(largest) else 0.0
        sums = dict.fromkeys(numeric, 0.0)
        total = 0.0
        for match in matches:
            values = [as_number(match[slot]) for slot in numeric]
            weight = math.exp(match.activation / t - shift)
            present = [value for value in values if value is not None]
            if len(present) < len(values):
                continue
            for slot, value in zip(numeric, present, strict=True):
                sums[slot] += value * weight
            total += weight
        for slot in numeric:
            if total > 0:  # otherwise no chunk has any activation, and the most active one's values stay
                blend[slot] = sums[slot] / total

    # -- in both

    def _temperature(self) -> float:
        temperature: float | None = getattr(self, "temperature", None)
        if temperature is not None:
            return temperature
        if self.effective_profile.blend_every_slot:
            noise = next((a.noise for a in self.adaptors if isinstance(a, DMNoise)), 0.0)
            if noise > 0:
                return math.sqrt(2) * noise
        return 1.0

    def _strength(self, record: Retrieval, best: float) -> float:
        if not self.effective_profile.blend_every_slot:
            return best
        return self._match_score([chunk for chunk, _, _, activation in record.rows if not math.isnan(activation)])

    def _match_score(self, matches: Sequence[Any]) -> float:
        """Returns ln sum exp A."""
        largest: float = max((match.activation for match in matches), default=-math.inf)
        if math.isinf(largest):
            return largest
        return largest + math.log(math.fsum(math.exp(match.activation - largest) for match in matches))


def _blended(held: Sequence[tuple[Any, float]], partial: Partial | None, total: float) -> Any:
    """Returns the compromise of the values of one slot, as in ACT-R 7.

    Args:
        held: The values of matching chunks, and the weights of these chunks.
        partial: The similarities of values.
        total: The total weight of all matching chunks.
    """
    numbers = [None if names_a_chunk(value) else as_number(value) for value, _ in held]
    if None not in numbers:
        return math.fsum(number * weight for number, (_, weight) in zip(numbers, held, strict=True) if number is not None) / total
    weights: dict[str, float] = {}
    candidates: dict[str, Any] = {}
    for value, weight in held:
        text = as_text(value)
        weights[text] = weights.get(text, 0.0) + weight
        candidates.setdefault(text, value)
    if partial is not None and all(names_a_chunk(value) for value, _ in held):
        for value in partial.related(weights):
            if names_a_chunk(value):
                candidates.setdefault(as_text(value), value)

    def misfit(candidate: str) -> float:
        return math.fsum(weight * _similarity(partial, candidate, text) ** 2 for text, weight in weights.items())

    return candidates[min(candidates, key=misfit)]


def _similarity(partial: Partial | None, a: str, b: str) -> float:
    """Returns the similarity of two values: 0 if they are equal, and -1 by default."""
    return 0.0 if a == b else -1.0 if partial is None else partial.between(a, b)
