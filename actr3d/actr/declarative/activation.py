"""Activation modules: compute the activation of a memory's chunks, A = B + S + noise + ...

Each is made with its memory: `dm_n = DMNoise(memory, noise=0.3)`. A chunk's activation is the sum of the parts of all modules.
"""

from __future__ import annotations

import math
from random import Random
from typing import Any, Final, Protocol, cast

from actr3d.actr.declarative.activation_parts import activation_part
from actr3d.actr.declarative.chunk_index import ChunkStore
from actr3d.actr.kernel.hooks import hook
from actr3d.actr.kernel.model import Model, ensure_converted, is_converted
from actr3d.actr.kernel.noise import logistic_noise
from actr3d.actr.kernel.parameters import Count, NotNegative, WithParameters, check_number, named_parameters
from actr3d.actr.kernel.profile import PYTHON_ACTR, Profile
from actr3d.errors import ChunkError, ParameterError


class ActivatedMemory(Protocol):
    """The memory that an activation module belongs to."""

    random: Random

    @property
    def dm(self) -> ChunkStore:
        """The chunks of the memory."""
        ...

    @property
    def effective_profile(self) -> Profile:
        """Its profile."""
        ...

    def now(self) -> float:
        """Returns the current time [s]."""
        ...

    def add_adaptor(self, a: MemorySubModule) -> None:
        """Adds an activation module."""
        ...


class MemorySubModule(WithParameters):
    """The base of all activation modules; each method may be overridden.

    Args:
        parent: The memory.

    Raises:
        ParameterError: If `parent` is not a memory.
    """

    def __init__(self, parent: ActivatedMemory | None) -> None:
        if parent is not None and not hasattr(type(parent), "add_adaptor"):
            raise ParameterError(f"{type(self).__name__}.memory: must be a Memory (got {parent!r})")
        self.parent = parent
        if parent is not None:
            parent.add_adaptor(self)

    @hook
    def create(self, chunk: Any, **keys: Any) -> None:
        """Handles a new chunk, before it is added to the memory."""

    @hook
    def merge(self, chunk: Any, **keys: Any) -> None:
        """Handles a chunk that is added again."""

    @hook
    def matched(self, chunks: list[Any]) -> None:
        """Handles the chunks that match a request."""

    @hook
    def activation(self, chunk: Any) -> float:
        """Returns this module's part of a chunk's activation.

        Raises:
            ChunkError: If the module needs information about the chunk that only `memory.add` provides.
        """
        return 0

    @hook
    def recalled(self, chunk: Any) -> None:
        """Handles a chunk that has been retrieved."""

    def now(self) -> float:
        """Returns the current time [s]."""
        parent = self.parent
        return 0 if parent is None or not is_converted(parent) else parent.now()

    @property
    def effective_profile(self) -> Profile:
        """The profile of this module."""
        return PYTHON_ACTR if self.parent is None else self.parent.effective_profile


@activation_part("noise")
class DMNoise(MemorySubModule):
    """Adds logistic noise to activations.

    Args:
        memory: The memory.
        noise: The scale s of the logistic noise drawn at each request.
        baseNoise: The scale s of the logistic noise drawn once for each chunk.
    """

    @named_parameters
    def __init__(self, memory: ActivatedMemory, noise: NotNegative = 0.3, baseNoise: NotNegative = 0.0) -> None:  # noqa: N803
        MemorySubModule.__init__(self, memory)
        self.noise = noise
        self.baseNoise = baseNoise

    def create(self, chunk: Any, **keys: Any) -> None:
        # A chunk added before there is a model (in a class's body) gets its base noise when its activation is first computed,
        # from that model's random numbers.
        if self.parent is not None and is_converted(self.parent):
            chunk.baseNoise = self.logisticNoise(self.baseNoise)

    def activation(self, chunk: Any) -> float:
        base: float | None = getattr(chunk, "baseNoise", None)
        if base is None:
            base = chunk.baseNoise = self.logisticNoise(self.baseNoise)
        return base + self.logisticNoise(self.noise)

    def logisticNoise(self, s: float) -> float:  # noqa: N802 - Python ACT-R's name
        """Draws logistic noise of scale `s`."""
        memory = self.parent
        assert memory is not None
        ensure_converted(cast("Model", memory))
        return logistic_noise(memory.random, s)


class ByProfile:
    """The type of a value that means «as in the profile»."""

    def __repr__(self) -> str:
        return "by profile"

    def __copy__(self) -> ByProfile:
        return self

    def __deepcopy__(self, memo: dict[int, Any]) -> ByProfile:
        return self


BY_PROFILE: Final = ByProfile()


@activation_part("base level")
class DMBaseLevel(MemorySubModule):
    """Base-level activation: the more often and the more recently a chunk was added, the more active it is.

    Args:
        memory: The memory.
        decay: d; None for no base level.
        limit: None for the exact form B = ln sum t_j^-d; 0 for the optimized form ln(n / (1 - d)) - d ln L; k for the
            hybrid form, which keeps the k latest times (in Python ACT-R those added last). By default the profile's: exact, or optimized
            in ACT-R 7.

    Source: Anderson & Lebiere (1998); hybrid form: Petrov (2006).
    """

    @named_parameters
    def __init__(
        self, memory: ActivatedMemory | None, decay: NotNegative | None = 0.5, limit: Count | ByProfile | None = BY_PROFILE
    ) -> None:
        MemorySubModule.__init__(self, memory)
        self.decay = decay
        self._limit = limit

    @property
    def limit(self) -> int | None:
        """The number of times that are kept; None for all."""
        if isinstance(self._limit, ByProfile):
            return 0 if self.effective_profile.optimized_learning else None
        return self._limit

    @limit.setter
    def limit(self, value: int | None) -> None:
        if value is None and self.parent is not None and any(len(getattr(c, "times", ())) < getattr(c, "count", 0) for c in self.parent.dm):
            raise ParameterError(
                f"{type(self).__name__}.limit: must be a number, because times of references have not been kept (got None); set it before "
                "chunks are added again"
            )
        self._limit = value

    def create(self, chunk: Any, time: float = 0.0, baselevel: Any = None, **keys: Any) -> None:
        _check_reference(time, baselevel)
        # `creation` and `first` are both kept, because the profile is not known yet for a chunk that is added in a class's body.
        chunk.creation = self.now()
        chunk.first = self.now() - time
        chunk.times = [chunk.first]
        chunk.count = 1
        if baselevel is not None and baselevel != "calculate":
            chunk.baselevel = baselevel

    def merge(self, chunk: Any, time: float = 0.0, baselevel: Any = None, **keys: Any) -> None:
        _check_reference(time, baselevel)
        at = self.now() - time
        chunk.first = min(chunk.first, at)
        chunk.times.append(at)
        chunk.count += 1
        limit = self.limit
        if limit is not None and len(chunk.times) > limit:
            times = sorted(chunk.times) if self.effective_profile.optimized_learning else chunk.times  # Python ACT-R keeps those added last
            chunk.times = times[-limit:] if limit else []
        if baselevel == "calculate":
            chunk.__dict__.pop("baselevel", None)
        elif baselevel is not None:
            chunk.baselevel = baselevel

    def activation(self, chunk: Any) -> float:
        fixed = getattr(chunk, "baselevel", None)
        if fixed is not None:
            return fixed
        d = self.decay
        if d is None:
            return 0
        profile = self.effective_profile
        now = self.now()
        times: list[float] | None = getattr(chunk, "times", None)
        if times is None:
            raise ChunkError(f"DMBaseLevel has no data about chunk '{chunk}': add it with memory.add, after the module is made")
        limit = self.limit
        if profile.optimized_learning and limit == 0:
            times = []  # Python ACT-R counts the first time exactly until there is a second
        youngest = profile.youngest_age
        total = 0.0
        for time in times:
            total += math.pow(max(now - time, youngest), -d)
        dropped = chunk.count - len(times)
        if dropped > 0 and limit is not None:
            latest = now - times[0] if times else None
            if profile.optimized_learning:
                latest = max(now - min(times), youngest) if times else None
                total += _sum_of_dropped(dropped, max(now - chunk.first, youngest), latest, d, youngest)
            else:  # Python ACT-R also counts a chunk's life from when it was added, even if it is declared to be older
                total += _sum_of_dropped(dropped, now - chunk.creation, latest, d, youngest)
        return math.log(total) if total > 0 else -math.inf


def _check_reference(time: Any, baselevel: Any) -> None:
    """Checks what `memory.add` is given for the base level.

    Raises:
        ParameterError: If the time is not a finite number, or the base level not a number.
    """
    if time != 0:
        check_number(time, "memory.add: time")
    if baselevel is not None and baselevel != "calculate":
        _check_amount(baselevel, "baselevel")


def _check_amount(value: Any, name: str) -> None:
    """Checks what `memory.add` is given for a part of the activation; it may be nan, about which a request warns.

    Raises:
        ParameterError: If it is not a number.
    """
    check_number(value, f"memory.add: {name}", infinite=True, nan=True)


def _sum_of_dropped(count: int, oldest: float, latest: float | None, d: float, youngest: float) -> float:
    """Returns the sum over references whose times are not kept, as if they were spread evenly.

    Args:
        count: Their number, n - k.
        oldest: The age of the first reference, t_n [s].
        latest: The age of the oldest kept one, t_k [s]; None if none are kept: they are then spread up to now.
        d: The decay.
        youngest: The age that is used instead of 0 or a negative age [s].
    """
    if latest is None:
        latest = 0.0 if d < 1 else youngest
        oldest = oldest if oldest > 0 else youngest
    elif min(oldest, latest) < 0 or (d >= 1 and min(oldest, latest) == 0):
        oldest, latest = max(oldest, youngest), max(latest, youngest)
    if oldest == latest:
        return count * math.pow(max(oldest, youngest), -d)
    if d == 1:
        return count * math.log(oldest / latest) / (oldest - latest)
    return count / (1 - d) * (math.pow(oldest, 1 - d) - math.pow(latest, 1 - d)) / (oldest - latest)


@activation_part("fixed")
class DMFixed(MemorySubModule):
    """Adds a fixed amount: `memory.add(chunk, fixed=2)`; adding an equal chunk again adds its amount.

    Args:
        memory: The memory.
        default: The amount of chunks that are added without one.
    """

    @named_parameters
    def __init__(self, memory: ActivatedMemory, default: float = 0) -> None:
        MemorySubModule.__init__(self, memory)
        self.default = default

    def create(self, chunk: Any, fixed: float | None = None, **keys: Any) -> None:
        if fixed is not None:
            _check_amount(fixed, "fixed")
        chunk.fixed = self.default if fixed is None else fixed

    def merge(self, chunk: Any, fixed: float = 0, **keys: Any) -> None:
        _check_amount(fixed, "fixed")
        chunk.fixed += fixed

    def activation(self, chunk: Any) -> float:
        return getattr(chunk, "fixed", self.default)
