"""Activation from earlier use: learned associations, and inhibition of recently used chunks."""

from __future__ import annotations

import math
from typing import Any

from actr3d.actr.chunks.chunk import Chunk
from actr3d.actr.declarative.activation import BY_PROFILE, ActivatedMemory, ByProfile, DMBaseLevel, MemorySubModule
from actr3d.actr.declarative.activation_parts import activation_part
from actr3d.actr.declarative.spreading import countable
from actr3d.actr.kernel.buffer import Buffer
from actr3d.actr.kernel.parameters import Count, NotNegative, check_number, named_parameters
from actr3d.actr.kernel.profile import PYTHON_ACTR
from actr3d.errors import ChunkError


class _Link:
    """An association between two slot values; it has a base level as chunks have."""


@activation_part("association")
class DMAssociate(MemorySubModule):
    """Learns which values are retrieved after which: each retrieval strengthens the links from the buffer's values.

    Args:
        memory: The memory.
        buffer: The buffer whose chunk is the context.
        weight: The factor of the sum of the links' base levels.
        decay: The decay of the links' base level.
        limit: As in `DMBaseLevel`.
    """

    @named_parameters
    def __init__(
        self,
        memory: ActivatedMemory,
        buffer: Buffer,
        weight: float = 1,
        decay: NotNegative | None = 0.5,
        limit: Count | ByProfile | None = BY_PROFILE,
    ) -> None:
        MemorySubModule.__init__(self, memory)
        self._buffer = buffer
        self._links: dict[tuple[Any, Any], Any] = {}
        self._base = DMBaseLevel(None, decay=decay, limit=limit)
        self.weight = weight

    def set_association(self, pre: Any, post: Any, baselevel: float) -> None:
        """Sets the strength of the link from one value to another.

        Raises:
            ParameterError: If it is not a number.
        """
        check_number(baselevel, f"{type(self).__name__}.set_association({pre!r}, {post!r})", infinite=True, nan=True)
        self._link(pre, post).baselevel = baselevel

    def _link(self, pre: Any, post: Any) -> Any:
        pair = countable(pre), countable(post)
        link = self._links.get(pair)
        if link is None:
            link = self._links[pair] = _Link()
            self._time().create(link)
        return link

    def _time(self) -> DMBaseLevel:
        """Returns the links' base level, with the memory's clock; in python_actr 1.9.5 without a clock: no time passes for links."""
        self._base.parent = None if self.effective_profile is PYTHON_ACTR else self.parent
        return self._base

    def recalled(self, chunk: Any) -> None:
        context: Chunk | None = self._buffer.chunk
        if context is None:
            return
        base = self._time()
        for pre in context.values():
            for post in chunk.values():
                known = self._links.get((countable(pre), countable(post)))
                if known is not None:
                    base.merge(known)
                else:
                    self._link(pre, post)

    def activation(self, chunk: Any) -> float:
        context: Chunk | None = self._buffer.chunk
        if context is None:
            return 0
        base = self._time()
        total = 0.0
        for pre in context.values():
            for post in chunk.values():
                link = self._links.get((countable(pre), countable(post)))
                if link is not None:
                    total += base.activation(link)
        return total * self.weight


@activation_part("inhibition")
class DMInhibition(MemorySubModule):
    """Inhibits recently used chunks: -ln(1 + t^-decayScale / timeScale), t since the latest use [s].

    In Python ACT-R, the `time` of a chunk's first `memory.add` counts as the clock time of its use, not as an age, and that of later
    ones does not count.

    Args:
        memory: The memory.
        decayScale: The decay rate of the inhibition.
        timeScale: Its duration [s].

    Source: Lebiere & Best (2009), Proceedings of the Cognitive Science Society.
    """

    @named_parameters
    def __init__(self, memory: ActivatedMemory, decayScale: float = 1.0, timeScale: float = 5.0) -> None:  # noqa: N803
        MemorySubModule.__init__(self, memory)
        self.decayScale = decayScale
        self.timeScale = timeScale

    def create(self, chunk: Any, time: float = 0.0, **keys: Any) -> None:
        # Both are kept, because the profile is not known yet for a chunk that is added in a class's body.
        chunk.mostRecentTime = time
        chunk.latestUse = self.now() - time

    def merge(self, chunk: Any, time: float = 0.0, **keys: Any) -> None:
        chunk.mostRecentTime = self.now()
        chunk.latestUse = max(getattr(chunk, "latestUse", -math.inf), self.now() - time)

    def activation(self, chunk: Any) -> float:
        latest: float | None = getattr(chunk, "mostRecentTime" if self.effective_profile is PYTHON_ACTR else "latestUse", None)
        if latest is None:
            raise ChunkError(f"DMInhibition has no data about chunk '{chunk}': add it with memory.add, after the module is made")
        age = self.now() - latest
        try:
            return -math.log(1 + math.pow(age, -self.decayScale) / self.timeScale)
        except ValueError:  # undefined for an age of 0, and for most negative ages
            return -math.log(1 + math.pow(self.effective_profile.youngest_age, -self.decayScale) / self.timeScale)
