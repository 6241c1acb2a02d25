"""Blending: a retrieval that mixes the numbers of all matching chunks."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Any

from actr3d.actr.chunks.chunk import Chunk, as_text
from actr3d.actr.declarative.activation import DMNoise
from actr3d.actr.declarative.memory import Memory
from actr3d.actr.declarative.partial_matching import Partial
from actr3d.actr.declarative.retrieval_record import Retrieval
from actr3d.actr.declarative.spreading import names_a_chunk


class BlendingMemory(Memory):
    """A memory whose retrievals are blends of all matching chunks, each weighted by p = exp(A / t) / sum exp(A / t).

    In Python ACT-R each numeric slot holds the mean over all matching chunks with the same slots, the other slots are the most
    active chunk's, t is 1, and the time is the most active chunk's.

    In ACT-R 7 each slot that was not asked for holds a compromise, and the others what was asked for:

    - Where all values are numbers, the sum of p times the value; chunks without the slot add nothing, and nothing is shared out
      for them.
    - Otherwise the value V with the least sum of p times the squared similarity of V to the chunk's value. The candidates are the
      values of the matching chunks, and, where all of these are words, every value that the model says is similar to one of them,
      even if no chunk has it. Of equally good candidates the first counts: in the order in which chunks came into memory, then
      values in the order in which similarities were said.
    - A missing value (none, or None) counts for nothing.

    There t is sqrt(2) times the activation noise, and the time comes from ln sum exp A. Similarities are those of the `Partial`
    that serves the request, or of the memory's first one (`Partial(memory, strength=None)` for blending alone); without one,
    different values have -1.

    ACT-R 7 looks for further candidates among the chunks in memory that have the same slots as those that the values name. Here
    values are words, so the model's similarities say which others there are. Those it says nothing of could not win.

    Source: Lebiere (1999), Kognitionswissenschaft 8; ACT-R 7, extras/blending/blending-read-me.txt, methods a to c.
    """

    temperature: float | None
    """t; the profile's where it is None or was never set."""

    def recall(self, chunk: Any, matches: list[Any], request_number: int) -> Iterator[float]:
        matches = [match for match in matches if not math.isnan(match.activation)]
        if self.rules.blend_every_slot:
            chunk = self._compromise(matches)
        else:
            numeric = [slot for slot in sorted(chunk, key=str) if _number(chunk[slot]) is not None]
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
        """Returns what each chunk weighs, the most active one 1."""
        t = self._temperature()
        largest = max(match.activation for match in matches)
        return [1.0 if m.activation == largest else math.exp((m.activation - largest) / t) for m in matches]

    # -- as in Python ACT-R

    def _mix(self, blend: Chunk, numeric: Sequence[Any], matches: Sequence[Any]) -> None:
        """Sets the numeric slots of a blend."""
        t = self._temperature()
        # exp is taken relative to the largest only where it would leave the range of numbers, so that sums round as they
        # always did.
        largest = max(match.activation for match in matches) / t
        shift = largest if abs(largest) > 600 and math.isfinite(largest) else 0.0
        sums = dict.fromkeys(numeric, 0.0)
        total = 0.0
        for match in matches:
            values = [_number(match[slot]) for slot in numeric]
            weight = math.exp(match.activation / t - shift)
            present = [value for value in values if value is not None]
            if len(present) < len(values):
                continue
            for slot, value in zip(numeric, present, strict=True):
                sums[slot] += value * weight
            total += weight
        for slot in numeric:
            if total > 0:  # else no chunk has any activation at all, and the most active one's values stay
                blend[slot] = sums[slot] / total

    # -- in both

    def _temperature(self) -> float:
        temperature: float | None = getattr(self, "temperature", None)
        if temperature is not None:
            return temperature
        if self.rules.blend_every_slot:
            noise = next((a.noise for a in self.adaptors if isinstance(a, DMNoise)), 0.0)
            if noise > 0:
                return math.sqrt(2) * noise
        return 1.0

    def _strength(self, record: Retrieval, best: float) -> float:
        if not self.rules.blend_every_slot:
            return best
        return self._match_score([c.chunk for c in record.candidates if not math.isnan(c.activation)])

    def _match_score(self, matches: Sequence[Any]) -> float:
        """Returns ln sum exp A."""
        largest: float = max((match.activation for match in matches), default=-math.inf)
        if math.isinf(largest):
            return largest
        return largest + math.log(math.fsum(math.exp(match.activation - largest) for match in matches))


def _number(value: Any) -> float | None:
    """Returns a slot's value as a number, or None where it is none."""
    try:
        return float(value)
    except (TypeError, ValueError):
        return None


def _blended(held: Sequence[tuple[Any, float]], partial: Partial | None, total: float) -> Any:
    """Returns the compromise of the values of one slot, as ACT-R 7 has it.

    Args:
        held: The values that matching chunks have, and what these chunks weigh.
        partial: What says how similar values are.
        total: What all matching chunks weigh.
    """
    numbers = [None if names_a_chunk(value) or isinstance(value, bool) else _number(value) for value, _ in held]
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
    """Returns how similar two values are: 0 where they are the same, and -1 where nothing says otherwise."""
    return 0.0 if a == b else -1.0 if partial is None else partial.between(a, b)
