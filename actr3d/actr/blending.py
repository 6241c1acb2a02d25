"""Blending: a retrieval that mixes the numbers of all matching chunks."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Any

from actr3d.actr.activation import DMNoise
from actr3d.actr.chunk import Chunk
from actr3d.actr.memory import Memory, Retrieval


class BlendingMemory(Memory):
    """A memory whose retrievals are blends: each numeric slot holds the mean over all matching chunks with the same slots,
    weighted by exp(A / t); the other slots are the most active chunk's.

    In Python ACT-R t is 1 and the time is the most active chunk's; in ACT-R 7 t is sqrt(2) times the activation noise, and
    the time comes from ln sum exp A.

    Source: Lebiere (1999), Kognitionswissenschaft 8; ACT-R 7 blending module.
    """

    temperature: float | None
    """t; the profile's where it is None or was never set."""

    def recall(self, chunk: Any, matches: list[Any], request_number: int) -> Iterator[float]:
        matches = [match for match in matches if not math.isnan(match.activation)]
        numeric = [slot for slot in sorted(chunk, key=str) if _number(chunk[slot]) is not None]
        if numeric or self.rules.blend_by_noise:
            blend: Any = Chunk(chunk)
            blend.activation = self._match_score(matches) if self.rules.blend_by_noise else chunk.activation
            slots = set(chunk)
            self._mix(blend, numeric, [match for match in matches if set(match) == slots])
            chunk = blend
        yield from Memory.recall(self, chunk, matches, request_number)

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

    def _temperature(self) -> float:
        temperature: float | None = getattr(self, "temperature", None)
        if temperature is not None:
            return temperature
        if self.rules.blend_by_noise:
            noise = next((a.noise for a in self.adaptors if isinstance(a, DMNoise)), 0.0)
            if noise > 0:
                return math.sqrt(2) * noise
        return 1.0

    def _strength(self, record: Retrieval, best: float) -> float:
        if not self.rules.blend_by_noise:
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
