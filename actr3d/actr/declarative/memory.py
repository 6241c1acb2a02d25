"""Declarative memory: chunks, requests, retrievals and failures."""

from __future__ import annotations

import inspect
import math
from collections.abc import Callable, Iterable, Iterator, Mapping
from typing import Annotated, Any

from annotated_types import Ge

from actr3d.actr.chunks.chunk import Chunk
from actr3d.actr.declarative.activation import BY_PROFILE, ByProfile, MemorySubModule
from actr3d.actr.declarative.chunk_index import ChunkStore
from actr3d.actr.declarative.chunk_query import search_for
from actr3d.actr.declarative.finst import Finst
from actr3d.actr.declarative.partial_matching import Partial
from actr3d.actr.declarative.retrieval_record import Retrieval
from actr3d.actr.kernel.buffer import Buffer, Harvester
from actr3d.actr.kernel.hooks import hook
from actr3d.actr.kernel.log import dummy
from actr3d.actr.kernel.model import Model
from actr3d.actr.kernel.noise import pick, total
from actr3d.actr.kernel.parameters import Count, Extended, NotNegative, WithParameters, named_parameters
from actr3d.actr.kernel.profile import PYTHON_ACTR, Profile, find_profile
from actr3d.actr.kernel.tracing import chunk_text, traceable
from actr3d.actr.kernel.tree import path_of
from actr3d.clock import seconds
from actr3d.errors import ChunkError, did_you_mean
from actr3d.trace import Trace
from actr3d.warnings import warn_modeller
from actr3d.weak_cache import weak_cache

LONGEST = 1e9
"""The duration of a retrieval that never ends [s], such as that of a chunk whose activation is minus infinity."""


class Memory(WithParameters, Model):
    """Declarative memory: stores chunks, and puts the most active one that matches a request into a buffer.

    Args:
        buffer: The buffer for retrieved chunks.
        latency: F in the retrieval time F exp(-A) [s]; None for the profile's.
        threshold: The minimum activation for retrieval; None for no minimum.
        maximum_time: The maximum duration of a retrieval or its failure [s]; by default the profile's: 10 s, or none in ACT-R 7. Without
            a threshold, a failure takes this time, or 10 s if there is no maximum.
        finst_size: The number of finsts: how many recently retrieved chunks are marked.
        finst_time: The lifetime of these marks [s].
        profile: «python-actr» or «act-r-7»; None for the agent's.

    Raises:
        ParameterError: If there is no such profile.
    """

    latency: NotNegative
    maximum_time: Annotated[Extended, Ge(0)]

    @named_parameters
    def __init__(
        self,
        buffer: Buffer,
        latency: NotNegative | None = None,
        threshold: Extended | None = 0,
        maximum_time: Annotated[Extended, Ge(0)] | ByProfile = BY_PROFILE,
        finst_size: Count = 4,
        finst_time: NotNegative = 3.0,
        profile: str | Profile | None = None,
    ) -> None:
        self._buffer = buffer
        self._profile = None if profile is None else find_profile(profile, "Memory.profile")
        self.dm: ChunkStore = ChunkStore()
        self.error = False
        self.busy = False
        self.adaptors: list[MemorySubModule] = []
        self.latency = self.effective_profile.latency if latency is None else latency
        self._latency_given = latency is not None
        self.threshold = threshold
        self.maximum_time = self.effective_profile.maximum_time if isinstance(maximum_time, ByProfile) else maximum_time
        self._maximum_time_given = not isinstance(maximum_time, ByProfile)
        self.partials: list[Partial] = []
        self.finst = Finst(self, size=finst_size, time=finst_time)
        self.record_all_chunks = False
        self._request_count = 0
        self._pending: Any = None
        self._last: Retrieval | None = None

    @property
    def effective_profile(self) -> Profile:
        """The profile of this memory: its own, or its agent's."""
        return self._profile or PYTHON_ACTR

    def _follow(self, parent: Model | None) -> None:
        """Uses the agent's profile unless one was given, and registers to collect the chunks that leave buffers."""
        super()._follow(parent)
        self._own_chunks(self.dm)
        if not self._latency_given:
            self.__dict__["latency"] = self.effective_profile.latency
        if not self._maximum_time_given:
            self.__dict__["maximum_time"] = self.effective_profile.maximum_time
        if self.effective_profile.harvest and self.parent is not None:
            self.sch.harvests = True
            harvesters: list[Harvester] = self.parent.__dict__.setdefault("_harvesters", [])
            if all(one.memory is not self for one in harvesters):
                harvesters.append(Harvester(self, self._buffer, self._collect))

    def __setattr__(self, key: str, value: Any) -> None:
        if key == "dm":
            if not isinstance(value, ChunkStore):
                value = ChunkStore(value)  # a modeller's own list of chunks
            self._own_chunks(value)
        super().__setattr__(key, value)
        if key in ("latency", "maximum_time"):
            self.__dict__[f"_{key}_given"] = True

    # -- chunks

    def clear(self) -> None:
        """Removes all chunks."""
        self.dm.clear()

    def add(self, chunk: Any, record: bool | None = None, **keys: Any) -> None:
        """Adds a chunk, or strengthens an equal one in the memory.

        Args:
            chunk: The contents of the chunk, or a buffer that holds it.
            record: Whether to log the chunk's activation whenever it is computed.
            keys: For the activation modules: `time` [s ago], `baselevel`, `fixed`.

        Raises:
            ChunkError: If no chunk can be made from the contents, or a variable is not bound.
            ParameterError: If what a module is given is not a number.
        """
        if self.error:
            self.error = False
        if keys:
            check_keywords(keys, self.adaptors)
        if isinstance(chunk, Buffer) and chunk.chunk is None:
            raise ChunkError(f"memory '{self.name}': buffer '{chunk.name}' is empty, so there is no chunk to add")
        new: Any = Chunk(chunk, self._bound())
        self._keep(new, keys)
        new.record = record

    def _keep(self, new: Chunk, keys: Mapping[str, Any]) -> None:
        """Adds a chunk, or strengthens the equal one in the memory."""
        merged = keep_in(self.dm, self.adaptors, new, keys) is not new
        self._trace_add(new, merged, keys)

    def _collect(self, chunk: Chunk) -> None:
        """Adds a chunk that left a buffer (ACT-R 7); unlike `add`, this does not reset `error`."""
        self._keep(Chunk(chunk), {})

    def _bound(self) -> dict[str, Any] | None:
        sch = self.__dict__.get("sch")
        return None if sch is None else sch.bound

    def find_matching_chunks(self, pattern: Any, threshold: float | None = None) -> list[Chunk]:
        """Returns the chunks that match a pattern, in the order in which they were added; those of at least `threshold`, if given.

        Raises:
            PatternException: If the text is not a pattern.
        """
        found = search_for(pattern, self._bound(), None).among(self.dm)
        if threshold is not None:
            found = [chunk for chunk in found if self.get_activation(chunk) >= threshold]
        return found

    # -- requests

    def request(self, pattern: Any, partial: Partial | None = None, require_new: bool = False) -> None:
        """Requests the most active chunk that matches.

        Activations are computed now. The chunk arrives in the buffer after `latency * exp(-A)`, or the buffer is cleared and
        `error` set after `latency * exp(-threshold)`; another request before that cancels this one.

        Args:
            pattern: The pattern of the chunk.
            partial: The similarities to use; by default the memory's first. One without a strength permits no mismatch.
            require_new: Whether to exclude recently retrieved chunks.

        Raises:
            PatternException: If the text is not a pattern.
        """
        partials = self.partials if partial is None else [partial]
        # Only one with a strength finds chunks that are only similar; a modeller's own class need not have one.
        partial = next((one for one in partials if getattr(one, "strength", 1.0) is not None), None)
        number = self._begin_request()
        sch = self.sch
        search = search_for(pattern, sch.bound, partial)
        matches = search.among(self.dm)
        marked = self.finst.obj
        record = Retrieval(sch.now_us, pattern, search, tuple(self.adaptors), self.threshold, require_new, list(marked), [])
        self.__dict__["_last"] = record
        if require_new and marked:
            record.excluded = [chunk for chunk in matches if chunk in marked]
            matches = [chunk for chunk in matches if chunk not in marked]
        for adaptor in self.adaptors:
            adaptor.matched(matches)
        best = self._weigh(matches, record)
        chosen: Any = pick(self.random, best) if best else None
        record.chosen = chosen
        record.latency = self._time(self._strength(record, chosen.activation)) if best else self._time_of_failure()
        trace = sch.trace
        if trace is not None and trace.all:
            trace.emit(sch.now_us, self._path, "request", record.snapshot())
        self._answer(number, chosen, record.latency, matches)

    def _begin_request(self) -> int:
        """Starts a new request and returns its number; the answers to earlier ones will not arrive."""
        self.busy = True
        if self.error:
            self.error = False
        number = self.__dict__["_request_count"] = self._request_count + 1
        profile = self.effective_profile
        if self._pending is not None and not profile.awaits_expiry:
            self.sch.drop([self._pending])
        if profile.clear_at_request:
            self._buffer.clear()
        return number

    def _weigh(self, matches: list[Chunk], record: Retrieval) -> list[Chunk]:
        """Computes every candidate's activation, and returns the best ones, or none if they are below the threshold."""
        own = own_activation(self)
        if own is not None:
            record.modules = ()
            winners = record.weigh(matches, lambda chunk: (own(chunk),), self.name)
        else:
            winners = record.weigh(matches, self._parts if self.adaptors or self.log is not dummy else None, self.name)
        if not winners or (self.threshold is not None and self._strength(record, record.best) < self.threshold):
            return []
        return winners

    def _answer(self, number: int, chosen: Any, latency: float, matches: list[Chunk]) -> None:
        """Schedules the result of a request."""
        sch = self.sch
        pending: Any
        if chosen is None:
            pending = self.fail(number)
        elif type(self).recall is not Memory.recall:
            pending = self.recall(chosen, matches=matches, request_number=number)
        elif sch.idle_now():
            # The same as below, without an event that would do nothing else at this moment.
            self.finst.add_after(chosen)
            pending = sch.call_after(latency, self._arrive, (chosen, number))
        else:
            pending = sch.call_at(sch.now_us, self._begin_recall, (chosen, latency, number))
        self.__dict__["_pending"] = pending

    def _strength(self, record: Retrieval, best: float) -> float:
        """Returns the activation that is compared with the threshold and determines the time."""
        return best

    @hook
    def fail(self, request_number: int) -> Iterator[float]:
        """Waits for the time of a failure, then sets `error` and clears the buffer."""
        self.sch.discard_remainders()
        yield self._time_of_failure()
        if request_number != self._request_count:
            return
        self.error = True
        self._buffer.clear()
        self.busy = False
        self.emit("retrieval", failed=True)

    @hook
    def recall(self, chunk: Any, matches: list[Any], request_number: int) -> Iterator[float]:
        """Waits for the retrieval time, then puts a chunk into the buffer."""
        self.finst.add(chunk)
        self.sch.discard_remainders()
        yield self._time(chunk.activation)
        self._arrive(chunk, request_number)

    def _begin_recall(self, chunk: Chunk, time: float, request_number: int) -> None:
        """Does the same as `recall`, if no subclass overrides that."""
        self.finst.add(chunk)
        self.__dict__["_pending"] = self.sch.call_after(time, self._arrive, (chunk, request_number))

    def _arrive(self, chunk: Chunk, request_number: int) -> None:
        """Puts a retrieved chunk into the buffer, unless there has been another request since."""
        if request_number != self._request_count:
            return
        self._buffer.set(chunk)
        for adaptor in self.adaptors:
            adaptor.recalled(chunk)
        self.busy = False
        trace = self.sch.trace
        if trace is not None and trace.all:
            trace.emit(self.sch.now_us, self._path, "retrieval", {"failed": False, "chunk": chunk_text(chunk)})

    def _time(self, activation: float) -> float:
        """Returns F exp(-A), at most the maximum time [s]."""
        try:
            time = min(self.latency * math.exp(-activation), self.maximum_time, LONGEST) if self.latency else 0.0
        except OverflowError:
            time = min(self.maximum_time, LONGEST)
        return round(time * 1000) / 1000 if self.effective_profile.whole_milliseconds else time

    def _time_of_failure(self) -> float:
        """Returns the time until a request fails [s]."""
        if self.threshold is not None:
            return self._time(self.threshold)
        return PYTHON_ACTR.maximum_time if math.isinf(self.maximum_time) else self.maximum_time

    # -- activation

    def _parts(self, chunk: Chunk) -> tuple[float, ...]:
        """Returns what each activation module adds to a chunk's activation now."""
        parts = tuple([adaptor.activation(chunk) for adaptor in self.adaptors]) if self.adaptors else ()
        if self.record_all_chunks or getattr(chunk, "record", None) is True:
            self.log[str(chunk)] = total(parts)
        return parts

    def get_activation(self, chunk: Any) -> float:
        """Returns a chunk's activation now, with newly drawn noise.

        Raises:
            ChunkError: If the memory does not contain the chunk.
        """
        if not self.dm.holds(chunk):
            wanted = Chunk(chunk, self._bound())
            known = self.dm.equal_to(wanted)
            if known is None:
                raise ChunkError(f"memory '{self.name}' has no chunk '{wanted}'")
            chunk = known
        return total(self._parts(chunk))

    @hook
    def add_adaptor(self, a: MemorySubModule) -> None:
        """Adds an activation module; the module calls this itself."""
        self.adaptors.append(a)

    # -- what a trace receives

    def _own_chunks(self, store: ChunkStore) -> None:
        """Records changes of a list of chunks by the model's code, and that it replaces another."""
        store.observer = observer = _ListObserver(self)
        before = self.__dict__.get("dm", store)
        if before is not store and observer.listening:
            observer.changed("dm", before, store)

    def _trace_add(self, chunk: Chunk, merged: bool, given: Mapping[str, Any]) -> None:
        """Records that a chunk was added, or has strengthened an equal one."""
        trace = _listening_trace(self)
        if trace is not None:
            data = {"chunk": traceable(chunk), "merged": merged, "size": len(self.dm), "given": traceable(dict(given))}
            trace.emit(self.sch.now_us, self._path, "add", data)

    def _trace_change(self, trace: Trace, key: str, value: Any) -> None:
        if key != "dm":  # an event «chunks» records that
            super()._trace_change(trace, key, value)

    def _state(self) -> dict[str, Any]:
        state = super()._state()
        state.pop("dm", None)
        return {**state, "size": len(self.dm)}

    def _trace_state(self, trace: Trace) -> None:
        super()._trace_state(trace)
        last = self._last
        if trace.all and last is not None:
            outcome = "pending" if self.busy else "failed" if last.chosen is None else "retrieved"
            data = {**last.to_data(), "made": seconds(last.time), "outcome": outcome}
            trace.emit(self.sch.now_us, self._path, "request", data)


# What the rest of the library asks of a memory. These are functions that use private names, because productions see every public
# name of a model.


def latest_retrieval(memory: Memory) -> Retrieval | None:
    """Returns the record of a memory's last request; None before the first."""
    return memory._last  # pyright: ignore[reportPrivateUsage] # productions see every public name of a model


def buffer_of(memory: Memory) -> Any:
    """Returns the buffer for retrieved chunks."""
    return memory._buffer  # pyright: ignore[reportPrivateUsage] # productions see every public name of a model


def collect(memory: Memory, chunk: Chunk) -> None:
    """Adds a chunk to a memory like `Memory.add`, but without resetting its `error`."""
    memory._collect(chunk)  # pyright: ignore[reportPrivateUsage] # productions see every public name of a model


def keep_in(store: ChunkStore, modules: Iterable[MemorySubModule], new: Chunk, keys: Mapping[str, Any]) -> Chunk:
    """Adds a chunk to a list, or strengthens the equal one in it; returns the one that is in the list.

    Args:
        store: The list.
        modules: The activation modules, which are notified.
        new: The chunk.
        keys: For the modules, as those of `Memory.add`.
    """
    known = store.equal_to(new)
    if known is not None:
        for module in modules:
            module.merge(known, **keys)
        return known
    for module in modules:
        module.create(new, **keys)
    store.keep(new)
    return new


def own_activation(memory: Memory) -> Callable[[Any], float] | None:
    """Returns a modeller's own `get_activation`; None for the library's."""
    method: Any = memory.__dict__["get_activation"]
    return None if getattr(method, "func", None) is Memory.get_activation else method


class _ListObserver:
    """Records in a memory's trace how the model's code changes its list of chunks."""

    def __init__(self, memory: Memory) -> None:
        self._memory = memory

    @property
    def listening(self) -> bool:
        return _listening_trace(self._memory) is not None

    def changed(self, by: str, before: list[Chunk], after: list[Chunk]) -> None:
        trace = _listening_trace(self._memory)
        if trace is not None:
            were, are = set(map(id, before)), set(map(id, after))
            gone = [chunk_text(chunk) for chunk in before if id(chunk) not in are]
            new = [chunk_text(chunk) for chunk in after if id(chunk) not in were]
            data = {"by": by, "size": len(after), "gone": gone, "new": new}
            trace.emit(self._memory.sch.now_us, path_of(self._memory), "chunks", data)


def _listening_trace(memory: Memory) -> Trace | None:
    """Returns the trace that records changes of a memory's chunks, if any."""
    sch = memory.__dict__.get("sch")
    trace = None if sch is None else sch.trace
    return trace if trace is not None and trace.all else None


# -- keywords of `add`

KNOWN = frozenset({"record", "time", "baselevel", "fixed"})
"""Keywords of the library's own modules; a model may give them even if it has no such module."""


def check_keywords(keys: Mapping[str, Any], modules: Iterable[MemorySubModule]) -> None:
    """Warns about keywords that no activation module takes; they have no effect."""
    unknown = keys.keys() - KNOWN
    if not unknown:
        return
    taken: set[str] = set(KNOWN)
    for kind in {type(module) for module in modules}:
        names, everything = _taken(kind)
        if everything:
            return
        taken |= names
    for name in sorted(unknown - taken):
        warn_modeller(f"memory.add: no activation module has a keyword '{name}'{did_you_mean(name, taken)}")


@weak_cache
def _taken(kind: type[MemorySubModule]) -> tuple[frozenset[str], bool]:
    """Returns the keywords that a class of modules takes by name, and whether it may use any other."""
    names: set[str] = set()
    everything = False
    for method in (kind.create, kind.merge):
        parameters = inspect.signature(method).parameters.values()
        names.update(p.name for p in parameters if p.kind in (p.POSITIONAL_OR_KEYWORD, p.KEYWORD_ONLY))
        rest = next((p.name for p in parameters if p.kind is p.VAR_KEYWORD), None)
        if rest is not None and not method.__module__.startswith("actr3d."):
            everything = True
    return frozenset(names - {"self", "chunk"}), everything
