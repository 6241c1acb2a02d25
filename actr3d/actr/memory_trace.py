"""What a declarative memory tells a trace: the chunks it takes in and loses, and the request that is under way."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from actr3d.actr.chunk import Chunk
from actr3d.actr.model import Model
from actr3d.actr.requests import Retrieval
from actr3d.actr.store import ChunkStore
from actr3d.actr.traced import chunk_text, traceable
from actr3d.clock import seconds
from actr3d.trace import Trace


class TracedMemory(Model):
    """A memory that tells a trace of its chunks."""

    dm: ChunkStore
    busy: bool
    _last: Retrieval | None

    def _listening(self) -> Trace | None:
        """Returns the trace that wants to know what becomes of the chunks, if any."""
        sch = self.__dict__.get("sch")
        trace = None if sch is None else sch.trace
        return trace if trace is not None and trace.all else None

    def _own_chunks(self, store: ChunkStore) -> None:
        """Lets a list of chunks tell of what is done to it by hand, and tells what it replaces."""
        store.owner = self
        before = self.__dict__.get("dm", store)
        if before is not store and self._listening() is not None:
            self._trace_chunks("dm", before, store)

    def _trace_add(self, chunk: Chunk, merged: bool, given: Mapping[str, Any]) -> None:
        """Records that a chunk was taken in, or has strengthened an equal one."""
        trace = self._listening()
        if trace is not None:
            data = {"chunk": traceable(chunk), "merged": merged, "size": len(self.dm), "given": traceable(dict(given))}
            trace.emit(self.sch.now_us, self._path, "add", data)

    def _trace_chunks(self, by: str, before: list[Chunk], after: list[Chunk]) -> None:
        """Records that the list of chunks was changed by hand."""
        trace = self._listening()
        if trace is not None:
            were, are = set(map(id, before)), set(map(id, after))
            gone = [chunk_text(chunk) for chunk in before if id(chunk) not in are]
            new = [chunk_text(chunk) for chunk in after if id(chunk) not in were]
            trace.emit(self.sch.now_us, self._path, "chunks", {"by": by, "size": len(after), "gone": gone, "new": new})

    def _trace_change(self, trace: Trace, key: str, value: Any) -> None:
        if key != "dm":  # that is told as a change of the chunks
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
