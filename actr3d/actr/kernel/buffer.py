"""Buffers: each holds one chunk or none; and what a buffer or another object holds, read without running the modeller's code."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Sequence
from functools import partial
from typing import Any, Final, NamedTuple, cast

from actr3d.actr.chunks.chunk import IMMUTABLE_TYPES, Chunk, Slot, plain_text
from actr3d.actr.chunks.pattern import MISSING, Missing
from actr3d.actr.kernel.model import Model, chosen_profile
from actr3d.actr.kernel.parameters import named_parameters
from actr3d.actr.kernel.tracing import lasting_slots, traceable
from actr3d.errors import ChunkError, did_you_mean, followed
from actr3d.trace import Data, Trace


class Buffer(Model):
    """Holds at most one chunk; its slots are read by `buffer[slot]` and matched by productions."""

    chunk: Chunk | None
    """The chunk that it holds; None if it is empty."""

    @named_parameters
    def __init__(self) -> None:
        self.chunk = None

    def set(self, chunk: object) -> None:
        """Stores a new chunk; the variables of the firing production replace `?name` in a text.

        Raises:
            ChunkError: If no chunk can be made from the contents, or a variable is not bound.
        """
        sch = self.__dict__.get("sch")
        new = Chunk(chunk, sch.bound if sch is not None else None)
        if sch is not None and sch.harvests:
            self._harvest()
        self.chunk = new

    def modify(self, **args: Any) -> None:
        """Changes slots of the chunk: `modify(count=3)`, and `modify(_1='b')` for the slot numbered 1.

        Raises:
            ChunkError: If the buffer is empty, or its chunk has no such slot.
        """
        for name, value in args.items():
            chunk = self.chunk
            if chunk is None:
                raise ChunkError(f"buffer '{self.name}' is empty: there is no slot '{name}' to modify; use set")
            slot = int(name[1:]) if name[0] == "_" and name[1:].isdecimal() else name
            if slot not in chunk:
                says = followed(did_you_mean(str(slot), chunk), f"the chunk is '{chunk}'")
                raise ChunkError(f"buffer '{self.name}': no slot '{slot}' to modify to {value!r}{says}")
            chunk[slot] = value
            self.chunk = chunk

    def clear(self) -> None:
        """Empties the buffer."""
        sch = self.__dict__.get("sch")
        if sch is not None and sch.harvests:
            self._harvest()
        self.chunk = None

    def __chunk__(self) -> Chunk:
        """Returns the chunk, to make another from it; called by `Chunk`.

        Raises:
            ChunkError: If the buffer is empty.
        """
        if self.chunk is None:
            raise ChunkError(f"buffer '{self.name}' is empty: there is no chunk to take from it")
        return self.chunk

    def isEmpty(self) -> bool:  # noqa: N802 - Python ACT-R's name
        """Returns whether there is no chunk, or one without slots."""
        return len(self) == 0

    def _harvest(self) -> None:
        """Adds a chunk that is about to leave to the nearest declarative memory that collects such chunks (ACT-R 7).

        A retrieved chunk is added to the memory that it came from; any other to every such memory of the agent.
        """
        chunk = self.chunk
        if not chunk:
            return
        above: Model | None = self.__dict__.get("parent")  # None for a class's own buffer that is filled before an agent runs
        while above is not None:
            harvesters: list[Harvester] = [one for one in above.__dict__.get("_harvesters", ()) if one.memory.parent is above]
            if harvesters:
                for harvester in [one for one in harvesters if one.buffer is self] or harvesters:
                    harvester.collect(chunk)
                return
            profile = chosen_profile(above)
            if profile is not None and not profile.harvest:
                return
            above = above.parent

    def _trace_change(self, trace: Trace, key: str, value: Any) -> None:
        if key != "chunk":
            super()._trace_change(trace, key, value)
        elif trace.buffer:
            watch: ChunkWatch | None = self.__dict__.get("_watch")
            if watch is not None and watch.recorded is not None:
                recorded, watch.recorded = watch.recorded, None
                if recorded is value:  # `modify` changes a chunk and sets it again
                    return
            self._trace_chunk(trace, value)

    def _trace_state(self, trace: Trace) -> None:
        if trace.buffer:
            self._trace_chunk(trace, self.chunk)

    def _trace_chunk(self, trace: Trace, chunk: Chunk | None) -> None:
        """Records the buffer's chunk, and observes changes of the chunk itself."""
        own = self.__dict__
        data: Data
        if type(chunk) is Chunk and IMMUTABLE_TYPES.issuperset(map(type, chunk.values())):
            data = partial(_chunk_data, dict(chunk))
        else:
            data = {"chunk": traceable(chunk), **(_texts(chunk) if chunk and trace.all else {})}
        trace.emit(own["sch"].now_us, self._path, "buffer", data)
        if isinstance(chunk, Chunk):
            watch = own.get("_watch") or own.setdefault("_watch", ChunkWatch(self, self._trace_chunk))
            if watch not in chunk.watches:
                chunk.watches = (*chunk.watches, watch) if chunk.watches else watch.alone

    def __getitem__(self, key: Any) -> Any:
        chunk = self.chunk
        if chunk is None:
            raise TypeError(f"buffer '{self.name}' is empty: it has no slot '{key}'")
        return chunk[key]

    def __eq__(self, other: object) -> bool:
        return self.chunk == other

    def __hash__(self) -> int:
        return id(self)

    def __len__(self) -> int:
        return 0 if self.chunk is None else len(self.chunk)


class Harvester(NamedTuple):
    """A declarative memory that collects the chunks that leave the buffers of its agent (ACT-R 7)."""

    memory: Model
    buffer: Any
    """Where the memory puts retrieved chunks."""
    collect: Callable[[Chunk], None]
    """Adds a chunk to the memory."""


def reads_chunk(target: Any, key: Any) -> bool:
    """Returns whether a slot of an object is one of the chunk in a buffer."""
    return isinstance(target, Buffer) and type(target).__getitem__ is Buffer.__getitem__ and not (isinstance(key, str) and "." in key)


def _chunk_data(slots: dict[Any, Any]) -> dict[str, Any]:
    """Returns what a trace keeps of a chunk with immutable values, given a copy of it."""
    return {"chunk": lasting_slots(slots)}


def _texts(chunk: Chunk) -> dict[str, dict[str, str]]:
    """Returns the text that patterns compare for values that are not plain, such as lists, if it is known."""
    texts = {str(key): plain_text(value) for key, value in chunk.items() if type(value) not in IMMUTABLE_TYPES}
    known = {key: text for key, text in texts.items() if text is not None}
    return {"texts": known} if known else {}


class ChunkWatch:
    """Records in a trace that the chunk in a buffer was changed directly: `goal.chunk['count'] = 3`.

    Args:
        buffer: The buffer.
        record: Records its chunk in a trace.
    """

    def __init__(self, buffer: Buffer, record: Callable[[Trace, Chunk], None]) -> None:
        self.alone = (self,)
        """The watches of a chunk that has only this one."""
        self._buffer = buffer
        self._record = record
        self.recorded: Chunk | None = None
        """The chunk in the buffer, if its latest change has been recorded and it has not been set since."""

    def changed(self, chunk: Chunk) -> None:
        """Records a change of a chunk that is or was in the buffer."""
        buffer = self._buffer
        own = buffer.__dict__
        trace = own["sch"].trace
        if trace is not None and trace.buffer and own["chunk"] is chunk:
            self._record(trace, chunk)
            self.recorded = chunk


# -- reading without running any of the modeller's code

UNKNOWN: Final = Missing()
"""Represents a value that only the modeller's code can compute: a property's, or an item of an object with its own items."""

_ITEMS: tuple[Any, ...] = tuple(vars(kind)["__getitem__"] for kind in (dict, list, tuple))
_WITH_LENGTH = (str, dict, tuple, list, set, frozenset)


def plain_value(target: Any, path: Slot) -> Any:
    """Returns the value of a slot in an object; MISSING if there is none, UNKNOWN if only the modeller's code can compute it."""
    value: Any = target
    for name in path.split(".") if isinstance(path, str) else (path,):
        value = _step(value, name)
        if value is MISSING or value is UNKNOWN:
            break
    return value


def _step(target: Any, name: Slot) -> Any:
    if isinstance(target, Buffer):
        return MISSING if target.chunk is None else target.chunk.get(name, MISSING)
    kind = cast("Any", type(target))
    items = getattr(kind, "__getitem__", None)
    if items in _ITEMS:
        found = _item(target, name)
        if found is not None:
            return found[0]
    elif items is not None and items is not Model.__getitem__:
        return UNKNOWN
    return _attribute(target, kind, name) if isinstance(name, str) else MISSING


def _item(target: Any, name: Slot) -> tuple[Any] | None:
    """Returns an item of a mapping or a sequence, in a tuple; None for a name in a sequence, which has attributes only."""
    if isinstance(target, dict):
        known = cast("dict[Any, Any]", target)
        nothing = UNKNOWN if hasattr(type(known), "__missing__") else MISSING
        return (known.get(name, nothing),)
    if isinstance(name, str):
        return None
    sequence = cast("Sequence[Any]", target)
    return (sequence[name] if name < len(sequence) else MISSING,)


def _attribute(target: Any, kind: Any, name: str) -> Any:
    if kind.__getattribute__ is not object.__getattribute__:
        return UNKNOWN
    member = inspect.getattr_static(kind, name, MISSING)
    if hasattr(cast("object", type(member)), "__get__") and not inspect.isfunction(member):
        return UNKNOWN
    own: dict[str, Any] = getattr(target, "__dict__", {})
    if name in own or member is not MISSING:
        return own.get(name, member)
    return UNKNOWN if hasattr(kind, "__getattr__") else MISSING


def plain_empty(target: Any) -> bool | Missing:
    """Returns whether the pattern None matches an object; UNKNOWN if only the modeller's code can compute it."""
    if target is None:
        return True
    if isinstance(target, Buffer):
        return not target.chunk
    kind = cast("Any", type(target))
    if kind in _WITH_LENGTH:
        return len(target) == 0
    return UNKNOWN if hasattr(kind, "__len__") or kind.__eq__ is not object.__eq__ else False
