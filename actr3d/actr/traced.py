"""What the parts of a simulation tell a trace: what they are like when it starts, and every change."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any
from weakref import ref

from actr3d.actr.chunk import LASTING_TYPES, Chunk
from actr3d.actr.limits import EndOfRun
from actr3d.actr.profile import PYTHON_ACTR, Profile
from actr3d.actr.tree import Part
from actr3d.trace import Trace, top_path
from actr3d.values import COLLECTIONS, Naming, plain

if TYPE_CHECKING:
    from actr3d.actr.scheduler import Scheduler


UNWATCHED = frozenset({"parent", "sch", "changes", "log", "random", "name"})
"""Attributes that hold the tree together; setting them is not a change that productions could see."""


def _known_part(value: object) -> str | None:
    return Naming(f"<{value._path}>") if issubclass(type(value), Part) else None  # type: ignore[attr-defined]


def traceable(value: Any) -> Any:
    """Returns what a trace keeps of a value: plain values as they are, chunks, lists and dicts as a copy, parts by their path."""
    if type(value) in LASTING_TYPES:
        return value
    if type(value) is Chunk and LASTING_TYPES.issuperset(map(type, value.values())):
        return lasting_slots(value)
    return plain(value, _known_part)


def lasting_slots(chunk: dict[Any, Any]) -> dict[str, Any]:
    """Returns what a trace keeps of a chunk whose values never change by themselves."""
    return {key if type(key) is str else str(plain(key)): item for key, item in chunk.items()}


def chunk_text(chunk: Chunk) -> str:
    """Returns a chunk as text, without asking the objects in its slots for theirs."""
    text = chunk._text
    if text is not None:
        return text
    if LASTING_TYPES.issuperset(map(type, chunk.values())):
        return str(chunk)
    kept = {key: traceable(value) for key, value in chunk.items()}
    return (Naming if any(type(value) is Naming for value in kept.values()) else str)(Chunk(kept))


class TracedRun:
    """A run as its trace knows it; the trace does not keep its model alive.

    Args:
        top: Its top model.
    """

    def __init__(self, top: TracedPart) -> None:
        self._top = ref(top)

    @property
    def model(self) -> TracedPart | None:
        """Its top model; None where it is gone."""
        return self._top()

    def now_us(self) -> int | None:
        """Returns its present [us]; None where the model is gone, or part of another now."""
        top = self._top()
        return None if top is None or top.parent is not None else top.sch.now_us

    def tell(self, trace: Trace) -> None:
        """Tells a trace what everything is like at present."""
        top = self._top()
        if top is not None:
            top._trace_opening(trace)

    def stop(self) -> None:
        """Ends it once the present event is over."""
        top = self._top()
        if top is not None:
            top.sch.stop()


class TracedPart(Part):
    """A part of a tree that tells a trace of its attributes."""

    sch: Scheduler
    _profile: Profile | None

    def _attach_trace(self, trace: Trace) -> None:
        """Begins to tell a trace of the run of which this is the top model."""
        self._forget_place()
        self.__dict__["_top_path"] = top_path(trace.begin(TracedRun(self)))
        self.sch.trace = trace
        self._trace_opening(trace)

    def _trace_opening(self, trace: Trace) -> None:
        if trace.production:
            data = {"model": type(self).__name__, "seed": self.sch.seed, "profile": (self._profile or PYTHON_ACTR).name}
            trace.emit(self.sch.now_us, self._path, "start", data)
        self._trace_states(trace)

    def _trace_states(self, trace: Trace) -> None:
        """Tells a trace what this part and all below it are like."""
        for part in self._tree():
            part._trace_state(trace)

    def _trace_state(self, trace: Trace) -> None:
        """Records the present value of every attribute, so that a trace which starts late can be read from its start."""
        if trace.all:
            trace.emit(self.sch.now_us, self._path, "state", self._state())

    def _state(self) -> dict[str, Any]:
        """Returns the attributes that say what the part is like; the library's own modules keep their workings in lists and dicts."""
        own = {key: value for key, value in self.__dict__.items() if key[0] != "_" and key not in UNWATCHED}
        lists = () if type(self).__module__.startswith("actr3d.actr.") else COLLECTIONS
        return {k: traceable(v) for k, v in own.items() if type(v) in LASTING_TYPES or issubclass(type(v), lists)}

    def _trace_run(self, limit: float | None) -> None:
        """Runs the tree, and records when and why that begins and ends; raises what a listener has raised meanwhile."""
        sch = self.sch
        outermost, failed = not sch._running, None
        self._trace_top("run", {"limit": traceable(limit)})
        try:
            if outermost and sch.trace is not None:
                sch.trace.raise_failures()
            sch.run(limit)
        except BaseException as error:
            failed = error
            raise
        finally:
            self._trace_top("stop", _end_of_run(sch, failed))
        if outermost and sch.trace is not None:
            sch.trace.raise_failures()

    def _trace_top(self, kind: str, data: dict[str, Any]) -> None:
        """Records what concerns the whole run."""
        trace = self.sch.trace
        if trace is not None and trace.all:
            *_, top = self._line()
            trace.emit(self.sch.now_us, top._path, kind, data)

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
        if type(value) in LASTING_TYPES:
            trace.emit(self.sch.now_us, self._path, "state", {key: value})
        elif self.__dict__.get("_children", {}).get(key) is not value:  # that a part has joined is told by «added»
            trace.emit(self.sch.now_us, self._path, "state", {key: traceable(value)})

    def _trace_member(self, kind: str, name: str, part: Part, **particulars: Any) -> None:
        """Records that a part joins this one under a name, or leaves it."""
        trace = self.sch.trace
        if trace is not None and trace.all:
            trace.emit(self.sch.now_us, self._path, kind, {"part": name, "model": type(part).__name__, **particulars})


def _end_of_run(sch: Scheduler, failed: BaseException | None) -> dict[str, Any]:
    """Returns why a run has ended."""
    if failed is None:
        return {"by": sch.ended_by}
    if not isinstance(failed, EndOfRun):
        return {"by": "error", "error": type(failed).__name__}
    ended = sch.limits is not None and sch.limits.ended
    return {"by": "until" if ended else "stop" if sch.stop_flag else "done"}
