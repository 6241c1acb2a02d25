"""The list of chunks of a declarative memory, with indexes by slot and value."""

from __future__ import annotations

import copy
from collections.abc import Callable, Iterable
from typing import Any, Protocol, SupportsIndex

from actr3d.actr.chunks.chunk import IMMUTABLE_TYPES, Chunk, Slot, as_text

Postings = dict[str, list[Chunk]]


class ListObserver(Protocol):
    """Records in a trace what is done to a list of chunks by hand."""

    @property
    def listening(self) -> bool:
        """Whether a trace records changes now."""
        ...

    def changed(self, by: str, before: list[Chunk], after: list[Chunk]) -> None:
        """Runs after each change; `by` is the list method that made it."""
        ...


def _mutator(name: str, *, removes: bool = False) -> Callable[..., Any]:
    """Makes a method that does the same as the list's, and then discards the indexes.

    Args:
        name: The name of the method.
        removes: Whether it may remove chunks.
    """
    original = getattr(list, name)

    def method(self: ChunkStore, *args: Any, **keys: Any) -> Any:
        observer = self.observer
        listening = observer is not None and observer.listening
        before = list(self) if removes or listening else []
        try:
            return original(self, *args, **keys)
        finally:
            self.discard_indexes()
            if removes:
                self.release(before)
            if observer is not None and listening:
                observer.changed(name.strip("_"), before, self)

    method.__name__ = name
    method.__doc__ = f"Does the same as `list.{name}`, then discards the indexes."
    return method


class ChunkStore(list[Chunk]):
    """A list of chunks in the order in which they were added, with an index for each slot that was ever searched.

    It can be read and changed like any list; a change other than `keep` discards the indexes, and they are built again when
    next needed.
    """

    observer: ListObserver | None = None
    """Records changes of the list by the model's code; None for no observer."""

    def __init__(self, chunks: Iterable[Chunk] = ()) -> None:
        super().__init__(chunks)
        self.version = 0
        """The number of changes other than `keep`."""
        self._slots: dict[Slot, Postings] = {}
        self._holders: dict[Slot, list[Chunk]] = {}
        self._changeable: set[Slot] = set()
        """The indexed slots in which some chunk has a mutable value, so that chunks are compared one by one."""
        self._equals: dict[frozenset[Any] | None, list[Chunk]] | None = None
        """The chunks by their items; under None those with a mutable value."""

    def discard_indexes(self) -> None:
        """Discards the indexes, because chunks were added, removed or changed."""
        self.version += 1
        self._slots.clear()
        self._holders.clear()
        self._changeable.clear()
        self._equals = None

    extend = _mutator("extend")
    append = _mutator("append")
    insert = _mutator("insert")
    remove = _mutator("remove", removes=True)
    pop = _mutator("pop", removes=True)
    clear = _mutator("clear", removes=True)
    sort = _mutator("sort")
    reverse = _mutator("reverse")
    __setitem__ = _mutator("__setitem__", removes=True)
    __delitem__ = _mutator("__delitem__", removes=True)
    __iadd__ = _mutator("__iadd__")
    __imul__ = _mutator("__imul__", removes=True)

    def __deepcopy__(self, memo: dict[int, Any]) -> ChunkStore:
        copied = memo[id(self)] = ChunkStore()
        copied.extend([copy.deepcopy(chunk, memo) for chunk in self])
        return copied

    def __reduce_ex__(self, protocol: SupportsIndex) -> Any:
        return (ChunkStore, (list(self),))

    def keep(self, chunk: Chunk) -> None:
        """Appends a chunk and adds it to the existing indexes."""
        super().append(chunk)
        self._adopt(chunk)
        for slot, postings in self._slots.items():
            self._post(chunk, slot, postings)
        for slot, holders in self._holders.items():
            if slot in chunk:
                holders.append(chunk)
        if self._equals is not None:
            self._equals.setdefault(_likeness(chunk), []).append(chunk)

    def since(self, number: int) -> list[Chunk]:
        """Returns the chunks from a number on, counted from 0; from now on the list is notified of their changes."""
        chunks = self[number:]
        for chunk in chunks:
            self._adopt(chunk)
        return chunks

    def holds(self, chunk: object) -> bool:
        """Returns whether this very chunk, not only an equal one, is known to be in the list."""
        return isinstance(chunk, Chunk) and any(store is self for store in chunk.stores)

    def equal_to(self, chunk: Chunk) -> Chunk | None:
        """Returns the first chunk with the same slots and equal values."""
        likeness = _likeness(chunk)
        if likeness is None:
            return next((known for known in self if known == chunk), None)
        if self._equals is None:
            self._equals = {}
            for known in self:
                self._adopt(known)
                self._equals.setdefault(_likeness(known), []).append(known)
        alike = self._equals.get(likeness)
        changeable = [known for known in self._equals.get(None, ()) if known == chunk]
        if alike and changeable:
            return next(known for known in self if known == chunk)
        return alike[0] if alike else changeable[0] if changeable else None

    def with_value(self, slot: Slot, text: str) -> list[Chunk]:
        """Returns, in order, all chunks whose value in `slot` has the text `text`, possibly among others that have the slot.

        The caller must not change the list.
        """
        postings = self._slots.get(slot)
        if postings is None:
            postings = self._slots[slot] = {}
            for chunk in self:
                self._adopt(chunk)
                self._post(chunk, slot, postings)
        return self.with_slot(slot) if slot in self._changeable else postings.get(text, [])

    def with_slot(self, slot: Slot) -> list[Chunk]:
        """Returns, in order, the chunks that have the slot; the caller must not change the list."""
        holders = self._holders.get(slot)
        if holders is None:
            holders = self._holders[slot] = []
            for chunk in self:
                self._adopt(chunk)
                if slot in chunk:
                    holders.append(chunk)
        return holders

    def _post(self, chunk: Chunk, slot: Slot, postings: Postings) -> None:
        """Adds a chunk to the index of one slot."""
        if slot in chunk:
            value = chunk[slot]
            if type(value) not in IMMUTABLE_TYPES:
                self._changeable.add(slot)
            postings.setdefault(as_text(value), []).append(chunk)

    def release(self, before: list[Chunk]) -> None:
        """Notes in the chunks that have left the list that it is not notified of their changes any more."""
        here = set(map(id, self))
        for chunk in before:
            if id(chunk) not in here:
                chunk.stores = tuple([store for store in chunk.stores if store is not self])

    def _adopt(self, chunk: Chunk) -> None:
        """Registers the list with a chunk, to be notified of its changes."""
        if not self.holds(chunk):
            chunk.stores = (*chunk.stores, self)


def _likeness(chunk: Chunk) -> frozenset[Any] | None:
    """Returns the items of a chunk as a key that equal chunks share; None if a value is mutable."""
    for value in chunk.values():
        if type(value) not in IMMUTABLE_TYPES:
            return None
    return frozenset(chunk.items())
