"""Activations of a memory's chunks at past moments, computed again from the events of a trace. The memory itself is not touched.

Base level, fixed amount, inhibition and spreading follow from when chunks were added and from what was in the buffers, which a trace
contains. They are computed by modules of the same classes, which are given the same chunks at the same times. What the trace contains of
activations, and the memory as it is now, are compared with the result.
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterator, Mapping, Sequence
from random import Random
from typing import Any

from actr3d.actr.chunks.chunk import IMMUTABLE_TYPES, Chunk
from actr3d.actr.declarative.activation import DMBaseLevel, DMFixed, DMNoise, MemorySubModule
from actr3d.actr.declarative.association import DMInhibition
from actr3d.actr.declarative.chunk_index import ChunkStore
from actr3d.actr.declarative.memory import Memory, keep_in, own_activation
from actr3d.actr.declarative.spreading import DMSpreading
from actr3d.actr.explain.memory_table import named_modules, part_now
from actr3d.actr.explain.module_reasons import numbered
from actr3d.actr.kernel.buffer import Buffer
from actr3d.actr.kernel.tracing import chunk_text, traceable
from actr3d.errors import Actr3dError
from actr3d.trace import TraceEvent

PARAMETERS: Mapping[type[MemorySubModule], tuple[str, ...]] = {
    DMBaseLevel: ("decay", "limit"),
    DMFixed: ("default",),
    DMInhibition: ("decayScale", "timeScale"),
    DMSpreading: (),
}
"""The activation modules whose part can be computed for past moments, each with its parameters; those of `DMSpreading` are set later."""
SAME = 1e-9
"""Relative and absolute difference up to which two activations are the same."""


class NotComputableError(Actr3dError):
    """The past activations of a memory do not follow from the trace; the text is a sentence for the user."""


def computed_parts(memory: Memory) -> tuple[list[str], str, str]:
    """Returns which parts of the activations of a memory's chunks can be computed for past moments.

    Returns:
        The names of the parts, as `MemoryRow.parts` has them; what their sum is: `activation`, `activation without noise`, or nothing if
        there are other parts; and a sentence about what cannot be computed, which may be empty.
    """
    if own_activation(memory) is not None:
        return [], "", "The model computes the activation by its own code, so it is known only at a retrieval."
    kinds = dict(named_modules(memory))
    parts = [name for name, module in kinds.items() if type(module) in PARAMETERS]
    others = [name for name, module in kinds.items() if type(module) not in PARAMETERS and type(module) is not DMNoise]
    if others:
        return parts, "", f"What {' and '.join(others)} {'adds' if len(others) == 1 else 'add'} is known only at a retrieval."
    noisy = any(type(module) is DMNoise for module in kinds.values())
    return parts, ("activation without noise" if noisy else "activation") if parts else "", ""


_BY_HAND = "The model changes parameters of this memory or its chunks by its own code, so past activations cannot be computed."


class _PastBuffer:
    """What was in a buffer."""

    chunk: Chunk | None = None


class PastMemory:
    """A memory as it was at a moment. It begins empty at the start of the run, and takes the events of the memory and of its source
    buffers in their order, with the times of the model.

    Args:
        memory: The memory, for its modules with their parameters.
        buffers: The source buffers of its modules, by their paths in the trace.
        events: All its known events, for the chunks that it had before the first one.
        present: How many of them the memory itself has had.

    Raises:
        NotComputableError: If it is not known how these chunks were used.
    """

    def __init__(self, memory: Memory, buffers: Mapping[str, Buffer], events: Sequence[TraceEvent], present: int) -> None:
        self._converted = True  # its modules read the clock, as those of a memory in a running model
        self._now = 0.0
        self.random = Random(0)  # nothing is drawn from it
        self.effective_profile = memory.effective_profile
        self.dm = ChunkStore()
        self.adaptors: list[MemorySubModule] = []
        self._buffers = {path: _PastBuffer() for path in buffers}
        past: dict[Any, Any] = {buffer: self._buffers[path] for path, buffer in buffers.items()}
        self._chunks: dict[str, Chunk] = {}
        """The chunks by their texts."""
        self._modules = {name: self._copied(module, past) for name, module in named_modules(memory) if type(module) in PARAMETERS}
        for chunk, keys in _before(memory, events, present):
            self._keep(Chunk(dict(chunk)), keys)

    def _copied(self, module: MemorySubModule, buffers: Mapping[Any, Any]) -> MemorySubModule:
        """Returns a module of the same class with the same parameters, without what it has learned, that reads other buffers."""
        if not isinstance(module, DMSpreading):
            kind: Any = type(module)
            return kind(self, **{name: getattr(module, name) for name in PARAMETERS[kind]})
        copied = DMSpreading(self)
        copied.buffers = tuple(buffers[buffer] for buffer in module.buffers)
        copied.weight = {buffers[buffer]: module.weight[buffer] for buffer in module.buffers}
        copied.strength = module.strength
        return copied

    def now(self) -> float:
        """Returns the moment [s]."""
        return self._now

    def add_adaptor(self, a: MemorySubModule) -> None:
        """Adds an activation module."""
        self.adaptors.append(a)

    def _keep(self, chunk: Chunk, keys: Mapping[str, Any]) -> None:
        self._chunks[chunk_text(chunk)] = keep_in(self.dm, self.adaptors, chunk, keys)

    # -- events

    def take(self, event: TraceEvent, time: float) -> None:
        """Processes an event of the memory or of a source buffer.

        Args:
            event: The event; the kinds `add`, `chunks`, `request` and `buffer` count.
            time: The time of the model [s].

        Raises:
            NotComputableError: If its result cannot be known, or the trace contains other activations than those computed here.
        """
        self._now = time
        data = event.data
        if event.kind == "buffer":
            contents = data["chunk"]
            self._buffers[event.source].chunk = None if contents is None else self._chunk(contents)
        elif event.kind == "add":
            self._keep(self._chunk(data["chunk"]), data["given"])
        elif event.kind == "chunks":
            if data["size"] > 0:
                raise NotComputableError(_BY_HAND)
            self.dm.clear()
            self._chunks.clear()
        elif event.kind == "request" and data.get("candidates"):
            text, parts, *_ = data["candidates"][0]
            self.compare(time, text, dict(zip(numbered(data["modules"]), parts, strict=False)))

    def _chunk(self, contents: Mapping[str, Any]) -> Chunk:
        if self._buffers and not IMMUTABLE_TYPES.issuperset(map(type, contents.values())):
            raise NotComputableError("A chunk has a value that is neither text nor a number, so past activations cannot be computed.")
        return Chunk({int(slot) if slot.isdecimal() else slot: value for slot, value in contents.items()})

    # -- activations

    def compare(self, time: float, text: str, known: Mapping[str, Any]) -> None:
        """Compares known parts of the activation of a chunk with those computed here.

        Args:
            time: The time of the model [s].
            text: The chunk's text.
            known: The parts, by the names of the modules; None for one that is not known.

        Raises:
            NotComputableError: If they differ.
        """
        mine = self.parts(time, text)
        for name in self._modules.keys() & known.keys():
            was, computed = known[name], mine.get(name)
            if was is not None and (computed is None or not math.isclose(computed, float(was), rel_tol=SAME, abs_tol=SAME)):
                raise NotComputableError(_BY_HAND)

    def parts(self, time: float, text: str) -> dict[str, float | None]:
        """Returns the parts of the activation of a chunk at a moment up to the next event; nothing if the chunk is not in the memory.

        Args:
            time: The time of the model [s].
            text: The chunk's text.
        """
        self._now = time
        chunk = self._chunks.get(text)
        return {} if chunk is None else {name: part_now(module, chunk) for name, module in self._modules.items()}


def _before(memory: Memory, events: Sequence[TraceEvent], present: int) -> Iterator[tuple[Chunk, dict[str, Any]]]:
    """Yields each use of the chunks that a memory had before its first event: the chunk, and the keywords with which it was added.

    Raises:
        NotComputableError: If these uses are not known.
    """
    first = next((event for event in events if event.kind in ("add", "chunks")), None)
    if first is None:
        count = len(memory.dm)
    elif first.kind == "add":
        count = first.data["size"] - (not first.data["merged"])
    else:
        count = len(first.data["gone"])
    if count == 0:
        return
    uses = Counter(_key(event.data["chunk"]) for event in events[:present] if event.kind == "add")
    for chunk in memory.dm[:count]:
        known: Any = chunk
        later = uses[_key(traceable(chunk))]
        earlier = list(getattr(known, "times", [0.0]))[: getattr(known, "count", later + 1) - later]
        complete = len(getattr(known, "times", [0.0])) == getattr(known, "count", 1) and not (later and hasattr(known, "baselevel"))
        if not complete or not {DMBaseLevel, DMSpreading, DMNoise}.issuperset(map(type, memory.adaptors)):
            raise NotComputableError(_EARLIER)
        yield from ((chunk, {"time": -time, "baselevel": getattr(known, "baselevel", None)}) for time in earlier)
    if len(memory.dm) < count or any(event.kind == "chunks" for event in events[:present]):
        raise NotComputableError(_EARLIER)


_EARLIER = "Chunks were added before the run began, and it is not recorded how, so past activations cannot be computed."


def _key(contents: Mapping[str, Any]) -> frozenset[tuple[str, str]]:
    """Returns a key that equal chunks share, as far as a trace shows it."""
    return frozenset((str(slot), repr(value)) for slot, value in contents.items())
