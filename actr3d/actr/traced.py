"""What the parts of a simulation tell a trace: what they are like when it starts, and every change."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, cast

from actr3d.actr.chunk import PLAIN_TYPES, Chunk
from actr3d.actr.profile import PYTHON_ACTR, Profile
from actr3d.actr.tree import Part
from actr3d.trace import Trace

if TYPE_CHECKING:
    from actr3d.actr.scheduler import Scheduler


UNWATCHED = frozenset({"parent", "sch", "changes", "log", "random", "name"})
"""Attributes that hold the tree together; setting them is not a change that productions could see."""


DEEPEST = 8
"""How many levels of lists in lists a trace keeps; one may contain itself."""


def traceable(value: Any, depth: int = 0) -> Any:
    """Returns what a trace keeps of a value: plain values as they are, chunks as a copy, others as text without addresses."""
    if value is None or type(value) in PLAIN_TYPES:
        return value
    if depth > DEEPEST:
        return "..."
    if isinstance(value, Chunk):
        return {str(key): item if item is None or type(item) in PLAIN_TYPES else traceable(item, depth + 1) for key, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [traceable(item, depth + 1) for item in cast("list[Any]", value)]
    if isinstance(value, Part):
        return f"<{value._path}>"
    if callable(value):
        return f"<{getattr(value, '__qualname__', type(value).__name__)}>"
    text = repr(value)
    return f"<{type(value).__name__}>" if " at 0x" in text else text


class TracedPart(Part):
    """A part of a tree that tells a trace of its attributes."""

    sch: Scheduler
    _profile: Profile | None

    def _attach_trace(self, trace: Trace) -> None:
        self.sch.trace = trace
        if trace.production:
            data = {"model": type(self).__name__, "seed": self.sch.seed, "profile": (self._profile or PYTHON_ACTR).name}
            trace.emit(self.sch.now_us, "top", "start", data)
        if trace.buffer:
            for part in self._tree():
                part._trace_state(trace)

    def _trace_state(self, trace: Trace) -> None:
        """Records the present value of every attribute, so that a trace which starts late can be read from its start."""
        if trace.all:
            state = {key: value for key, value in self.__dict__.items() if key[0] != "_" and key not in UNWATCHED}
            plain = {key: value for key, value in state.items() if value is None or type(value) in PLAIN_TYPES}
            trace.emit(self.sch.now_us, self._path, "state", plain)

    def _trace_request(self, call: str, **particulars: Any) -> None:
        """Records that a module was asked for something."""
        trace = self.sch.trace
        if trace is not None and trace.all:
            data = {"call": call, **{key: traceable(value) for key, value in particulars.items()}}
            trace.emit(self.sch.now_us, self._path, "request", data)

    def _trace_change(self, trace: Trace, key: str, value: Any) -> None:
        """Records one attribute's new value."""
        if not trace.all:
            return
        if type(value) in PLAIN_TYPES:
            trace.emit(self.sch.now_us, self._path, "state", {key: value})
        elif isinstance(value, Part) and value.__dict__.get("parent") is self:
            for part in value._tree():
                part._trace_state(trace)
        else:
            trace.emit(self.sch.now_us, self._path, "state", {key: traceable(value)})
