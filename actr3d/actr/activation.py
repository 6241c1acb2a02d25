"""Modules that give a memory's chunks their activation, A = B + S + noise + ...

Each is made with its memory: `dm_n = DMNoise(memory, noise=0.3)`. A chunk's activation is the sum of what all of them
say of it.
"""

from __future__ import annotations

import math
import warnings
from typing import TYPE_CHECKING, Any, Final

from actr3d.actr.chunk import Chunk, as_text
from actr3d.actr.pattern import Pattern
from actr3d.actr.profile import PYTHON_ACTR, Profile
from actr3d.actr.utility import logistic_noise
from actr3d.errors import ChunkError, ModelWarning

if TYPE_CHECKING:
    from actr3d.actr.memory import Memory


class MemorySubModule:
    """The base of all activation modules; each method may be overridden.

    Args:
        parent: The memory.
    """

    def __init__(self, parent: Memory | None) -> None:
        self.parent = parent
        if parent is not None:
            parent.add_adaptor(self)

    def create(self, chunk: Any, **keys: Any) -> None:
        """Takes in a new chunk, before it joins the memory."""

    def merge(self, chunk: Any, **keys: Any) -> None:
        """Is told that a chunk was added again."""

    def matched(self, chunks: list[Any]) -> None:
        """Is told which chunks match a request."""

    def activation(self, chunk: Any) -> float:
        """Returns this module's part of a chunk's activation."""
        return 0

    def recalled(self, chunk: Any) -> None:
        """Is told that a chunk has been retrieved."""

    def now(self) -> float:
        """Returns the present [s]."""
        parent = self.parent
        return 0 if parent is None or not parent._is_converted() else parent.now()

    @property
    def rules(self) -> Profile:
        """The numbers this module goes by."""
        return PYTHON_ACTR if self.parent is None else self.parent.rules


class DMNoise(MemorySubModule):
    """Adds logistic noise: `noise` drawn anew each time, `baseNoise` once for each chunk."""

    def __init__(self, memory: Memory, noise: float = 0.3, baseNoise: float = 0.0) -> None:  # noqa: N803
        MemorySubModule.__init__(self, memory)
        self.noise = noise
        self.baseNoise = baseNoise

    def create(self, chunk: Any, **keys: Any) -> None:
        chunk.baseNoise = self.logisticNoise(self.baseNoise)

    def activation(self, chunk: Any) -> float:
        return chunk.baseNoise + self.logisticNoise(self.noise)

    def logisticNoise(self, s: float) -> float:  # noqa: N802 - Python ACT-R's name
        """Draws logistic noise of scale `s`."""
        memory = self.parent
        assert memory is not None
        memory._ensure_converted()
        return logistic_noise(memory.random, s)


class _ByProfile:
    """Stands for «as the profile has it»."""

    def __repr__(self) -> str:
        return "by profile"

    def __copy__(self) -> _ByProfile:
        return self

    def __deepcopy__(self, memo: dict[int, Any]) -> _ByProfile:
        return self


BY_PROFILE: Final = _ByProfile()


class DMBaseLevel(MemorySubModule):
    """Base-level activation: the more often and the more lately a chunk was added, the more active it is.

    Args:
        memory: The memory.
        decay: d; None for no base level.
        limit: None for the exact form B = ln sum t_j^-d; 0 for the optimized form ln(n / (1 - d)) - d ln L; k for the
            hybrid form, which keeps the k latest times. Unless given, the profile's: exact, or optimized in ACT-R 7.

    Source: Anderson & Lebiere (1998); hybrid form: Petrov (2006).
    """

    def __init__(self, memory: Memory | None, decay: float | None = 0.5, limit: int | None | _ByProfile = BY_PROFILE) -> None:
        MemorySubModule.__init__(self, memory)
        self.decay = decay
        self._limit = limit

    @property
    def limit(self) -> int | None:
        """How many times are kept; None for all."""
        if isinstance(self._limit, _ByProfile):
            return 0 if self.rules.optimized_learning else None
        return self._limit

    @limit.setter
    def limit(self, value: int | None) -> None:
        self._limit = value

    def create(self, chunk: Any, time: float = 0.0, baselevel: Any = None, **keys: Any) -> None:
        now = self.now()
        # Python ACT-R counts a chunk's life from when it was added, even where it is said to be older.
        chunk.creation = now - time if self.rules.optimized_learning else now
        chunk.times = [now - time]
        chunk.count = 1
        if baselevel is not None and baselevel != "calculate":
            chunk.baselevel = baselevel
        if self.rules.optimized_learning:  # Python ACT-R keeps the first time until there is a second
            self._forget_times(chunk)

    def merge(self, chunk: Any, time: float = 0.0, baselevel: Any = None, **keys: Any) -> None:
        chunk.times.append(self.now() - time)
        chunk.count += 1
        self._forget_times(chunk)
        if baselevel == "calculate":
            vars(chunk).pop("baselevel", None)
        elif baselevel is not None:
            chunk.baselevel = baselevel

    def _forget_times(self, chunk: Any) -> None:
        limit = self.limit
        if limit is not None and len(chunk.times) > limit:
            chunk.times = chunk.times[-limit:] if limit else []

    def activation(self, chunk: Any) -> float:
        fixed = getattr(chunk, "baselevel", None)
        if fixed is not None:
            return fixed
        d = self.decay
        if d is None:
            return 0
        youngest = self.rules.youngest_age
        now = self.now()
        ages = [now - time for time in chunk.times]
        total = sum([math.pow(max(age, youngest), -d) for age in ages])
        forgotten = chunk.count - len(ages)
        if forgotten > 0 and self.limit is not None:
            total += _forgotten(forgotten, now - chunk.creation, ages[0] if ages else 0.0, d, youngest)
        return math.log(total)


def _forgotten(count: int, oldest: float, latest: float, d: float, youngest: float) -> float:
    """Returns what references whose times are not kept add up to, if they were spread evenly.

    Args:
        count: How many they are, n - k.
        oldest: The age of the first reference, t_n [s].
        latest: The age of the oldest kept one, t_k [s]; 0 for none kept.
        d: The decay.
        youngest: The least age that counts [s].
    """
    if oldest < youngest and (oldest <= latest or youngest >= 0.05):
        oldest = youngest
    if oldest <= latest:
        return count * math.pow(oldest, -d)
    if d == 1:
        return count * (math.log(oldest / latest) if latest > 0 else 1.0) / (oldest - latest)
    return count / (1 - d) * (math.pow(oldest, 1 - d) - math.pow(latest, 1 - d)) / (oldest - latest)


class DMSpreading(MemorySubModule):
    """Spreading activation: what is in the buffers makes related chunks active.

    In Python ACT-R, each slot value of a buffer's chunk that also stands in the chunk adds
    `weight[buffer] * (strength - ln(occurrences in memory + 1))`. In ACT-R 7 the weight is divided among the values that
    can name a chunk, and S_ji = strength - ln((1 + slots_j) / slots_ji), which counts 0 where it is negative.

    Args:
        memory: The memory.
        buffers: The sources.

    Source: Anderson & Lebiere (1998), equation 3.5; ACT-R 7 reference manual, spreading activation.
    """

    def __init__(self, memory: Memory, *buffers: Any) -> None:
        MemorySubModule.__init__(self, memory)
        self.strength: float = 1
        self.buffers = buffers
        self.weight: dict[Any, float] = dict.fromkeys(buffers, 1)
        self.slots: dict[Any, int] = {}
        self._warned: set[Any] = set()

    def create(self, chunk: Any, **keys: Any) -> None:
        for value in chunk.values():
            self.slots[value] = self.slots.get(value, 0) + 1

    def activation(self, chunk: Any) -> float:
        total = 0.0
        values: list[Any] = list(chunk.values())
        for buffer in self.buffers:
            source: Chunk | None = buffer.chunk
            if source is not None:
                total += self._spread(source, values, self.weight[buffer])
        return total

    def _spread(self, source: Chunk, values: list[Any], weight: float) -> float:
        if not self.rules.spread_by_slots:
            total = 0.0
            for value in source.values():
                if value in values:
                    total += weight * (self.strength - math.log(self.slots.get(value, 0) + 1))
            return total
        sources = [value for value in source.values() if names_a_chunk(value)]
        return sum([weight / len(sources) * self._association(value, values) for value in sources if value in values])

    def _association(self, value: Any, values: list[Any]) -> float:
        strength = self.strength - math.log((1 + self.slots.get(value, 0)) / values.count(value))
        if strength >= 0:
            return strength
        if value not in self._warned:
            self._warned.add(value)
            warnings.warn(
                f"the fan of '{value}' is so large that it would inhibit: S_ji = {strength:.3f} counts as 0; "
                f"raise DMSpreading.strength (now {self.strength:g})",
                ModelWarning,
                stacklevel=2,
            )
        return 0.0


def names_a_chunk(value: Any) -> bool:
    """Tells whether a slot's value can name a chunk: text that is neither a number nor None, True or False."""
    text = as_text(value)
    if text in ("None", "True", "False"):
        return False
    try:
        float(text)
    except ValueError:
        return True
    return False


class DMFixed(MemorySubModule):
    """Adds a fixed amount: `memory.add(chunk, fixed=2)`; adding an equal chunk again adds its amount."""

    def __init__(self, memory: Memory, default: float = 0) -> None:
        MemorySubModule.__init__(self, memory)
        self.default = default

    def create(self, chunk: Any, fixed: float | None = None, **keys: Any) -> None:
        chunk.fixed = self.default if fixed is None else fixed

    def merge(self, chunk: Any, fixed: float = 0, **keys: Any) -> None:
        chunk.fixed += fixed

    def activation(self, chunk: Any) -> float:
        return chunk.fixed


class DMSalience(MemorySubModule):
    """Makes rare values active: a value adds its weight times its information in bits, among the chunks of a context."""

    def __init__(self, memory: Memory) -> None:
        MemorySubModule.__init__(self, memory)
        self.histogram: dict[Any, dict[Any, float]] = {}
        self.weight: dict[Any, float] = {}
        self.memory = memory

    def weights(self, **weights: float) -> None:
        """Says how much each slot counts; `_1=2` is the slot numbered 1."""
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
                value = chunk.get(slot)
                counts[value] = counts.get(value, 0) + share

    def activation(self, chunk: Any) -> float:
        total = 0.0
        for slot, counts in self.histogram.items():
            value = chunk.get(slot)
            if value not in counts:
                raise ChunkError(f"DMSalience: no chunk of the context has '{value}' in slot '{slot}'; give a context that '{chunk}' belongs to")
            total += math.log(1.0 / counts[value], 2) * self.weight[slot]
        return total
