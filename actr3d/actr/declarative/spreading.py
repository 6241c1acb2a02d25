"""Spreading activation from the chunks in buffers, and activation of chunks with rare values."""

from __future__ import annotations

import math
import warnings
from collections.abc import Hashable
from typing import Any

from actr3d.actr.chunks.chunk import Chunk, as_text
from actr3d.actr.chunks.pattern import Pattern
from actr3d.actr.declarative.activation import ActivatedMemory, MemorySubModule
from actr3d.actr.declarative.activation_parts import activation_part
from actr3d.actr.declarative.chunk_index import ChunkStore
from actr3d.actr.kernel.buffer import Buffer
from actr3d.actr.kernel.hooks import hook
from actr3d.actr.kernel.parameters import named_parameters
from actr3d.errors import ChunkError
from actr3d.warnings import warn_modeller


@activation_part("spreading")
class DMSpreading(MemorySubModule):
    """Spreading activation: the chunks in buffers make related chunks more active.

    In Python ACT-R, each slot value of a buffer's chunk that is also a value of the chunk adds
    `weight[buffer] * (strength - ln(occurrences in memory + 1))`. In ACT-R 7 the weight is divided among the values that
    can name a chunk, and S_ji = strength - ln((1 + slots_j) / slots_ji), which is replaced by 0 if it is negative.

    Args:
        memory: The memory.
        buffers: The source buffers.

    Attributes:
        strength: S, the maximum associative strength; 1 by default.
        weight: W of each source buffer, 1 by default: `spreading.weight[goal] = 0.5`.

    Source: Anderson & Lebiere (1998), equation 3.5; ACT-R 7 reference manual, spreading activation.
    """

    @named_parameters
    def __init__(self, memory: ActivatedMemory, *buffers: Buffer) -> None:
        MemorySubModule.__init__(self, memory)
        self.strength: float = 1
        self.buffers = buffers
        self.weight: dict[Any, float] = dict.fromkeys(buffers, 1)
        self.slots: dict[Any, int] = {}
        self._counted: set[_Same] = set()
        self._store: ChunkStore | None = None
        self._version = self._size = 0
        """The version of the list of chunks that is counted, and how many of them are."""
        self._warned: set[Any] = set()
        for chunk in memory.dm:
            self.create(chunk)

    def create(self, chunk: Any, **keys: Any) -> None:
        """Counts a new chunk's values, once for each chunk.

        In python_actr 1.9.5 a module that is made when the memory already has chunks must be given each of them by the model;
        here it counts them by itself, with the same result.
        """
        if self.effective_profile.spread_by_slots:
            return  # see `_count`
        same = _Same(chunk)
        if same in self._counted:
            return
        self._counted.add(same)
        self._add(chunk)

    def _add(self, chunk: Any) -> None:
        for value in map(countable, chunk.values()):
            self.slots[value] = self.slots.get(value, 0) + 1

    def _count(self) -> None:
        """Counts the values of the chunks that are in the memory now (ACT-R 7); Python ACT-R still counts chunks that have left it."""
        assert self.parent is not None
        store = self.parent.dm
        if store is not self._store or store.version != self._version:
            self._store, self._version, self._size = store, store.version, 0
            self.slots.clear()
            self._counted.clear()
        if len(store) > self._size:
            for chunk in store.since(self._size):
                self._add(chunk)
            self._size = len(store)

    def activation(self, chunk: Any) -> float:
        total = 0.0
        values: list[Any] = list(chunk.values())
        by_slots = self.effective_profile.spread_by_slots
        if by_slots:
            self._count()
        for buffer in self.buffers:
            source: Chunk | None = buffer.chunk
            if source is None:
                continue
            weight = self.weight[buffer]
            if by_slots:
                total += self._divided(source, values, weight)
                continue
            for value in source.values():
                if value in values:
                    total += weight * (self.strength - math.log(self._occurrences(value) + 1))
        return total

    @hook
    def activation_for_observer(self, chunk: Any) -> float:
        """Returns the same as `activation`, without a warning: a later retrieval warns.

        Raises:
            ChunkError: As `activation` does.
        """
        warned = self._warned.copy()
        try:
            with warnings.catch_warnings():
                warnings.simplefilter("ignore")
                return self.activation(chunk)
        finally:
            self._warned = warned

    def _divided(self, source: Chunk, values: list[Any], weight: float) -> float:
        """Returns the activation from a buffer's chunk if its weight is divided among its chunk-valued slots."""
        sources = [value for value in source.values() if names_a_chunk(value)]
        total = 0.0
        for value in sources:
            if value in values:
                total += weight / len(sources) * self._association(value, values)
        return total

    def _association(self, value: Any, values: list[Any]) -> float:
        """Returns S_ji."""
        strength = self.strength - math.log((1 + self._occurrences(value)) / values.count(value))
        if strength >= 0:
            return strength
        if countable(value) not in self._warned:
            self._warned.add(countable(value))
            warn_modeller(
                f"the fan of '{value}' is large enough to inhibit: S_ji = {strength:.3f} counts as 0; "
                f"raise DMSpreading.strength (now {self.strength:g})"
            )
        return 0.0

    def _occurrences(self, value: Any) -> int:
        """Returns the number of slots of the memory's chunks that have a value; in Python ACT-R, of all that it ever had."""
        return self.slots.get(countable(value), 0)


class _Same:
    """A set element that identifies one chunk among equal ones, also after the set has been copied with its chunks."""

    __slots__ = ("chunk",)

    def __init__(self, chunk: Any) -> None:
        self.chunk = chunk

    def __eq__(self, other: object) -> bool:
        return isinstance(other, _Same) and other.chunk is self.chunk

    def __hash__(self) -> int:
        return id(self.chunk)


def countable(value: Any) -> Hashable:
    """Returns a slot's value as a key for counting: the value, or its text if it cannot be hashed."""
    try:
        hash(value)
    except TypeError:
        return type(value).__name__, as_text(value)
    return value


def names_a_chunk(value: Any) -> bool:
    """Returns whether a slot's value can name a chunk: text that is neither a number nor None, True or False."""
    text = as_text(value)
    if text in ("None", "True", "False"):
        return False
    try:
        float(text)
    except ValueError:
        return True
    return text.lower().lstrip("+-") in ("nan", "inf", "infinity") and isinstance(value, str)


@activation_part("salience")
class DMSalience(MemorySubModule):
    """Makes chunks with rare values active: a value adds its weight times its information in bits, among the chunks of a context."""

    @named_parameters
    def __init__(self, memory: ActivatedMemory) -> None:
        MemorySubModule.__init__(self, memory)
        self.histogram: dict[Any, dict[Any, float]] = {}
        self.weight: dict[Any, float] = {}
        self.memory = memory

    def weights(self, **weights: float) -> None:
        """Sets the weight of each slot; `_1=2` is the slot numbered 1."""
        named = {int(k[1:]) if k[0] == "_" else k: float(w) for k, w in weights.items()}
        self.weight = dict(named)
        self.histogram = {slot: {} for slot in named}

    def context(self, pattern: Any) -> None:
        """Counts values among the chunks that match a pattern.

        Raises:
            ChunkError: If none does.
        """
        compiled = Pattern(pattern)
        chunks = [chunk for chunk in self.memory.dm if compiled.match(chunk) is not None]
        if not chunks:
            raise ChunkError(f"DMSalience.context: no chunk matches '{pattern}'")
        share = 1.0 / len(chunks)
        for slot, counts in self.histogram.items():
            counts.clear()
            for chunk in chunks:
                value = countable(chunk.get(slot))
                counts[value] = counts.get(value, 0) + share

    def activation(self, chunk: Any) -> float:
        total = 0.0
        for slot, counts in self.histogram.items():
            value = countable(chunk.get(slot))
            if value not in counts:
                raise ChunkError(
                    f"DMSalience: no chunk of the context has '{chunk.get(slot)}' in slot '{slot}'; "
                    f"give a context that '{chunk}' belongs to"
                )
            total += math.log(1.0 / counts[value], 2) * self.weight[slot]
        return total
