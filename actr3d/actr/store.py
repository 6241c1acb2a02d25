"""The chunks of a declarative memory, found by their slots."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from typing import Any, SupportsIndex

from actr3d.actr.chunk import Chunk, Slot, as_text

Postings = dict[str, list[Chunk]]


def _mutator(name: str) -> Callable[..., Any]:
    """Makes a method that does what the list's own does, and then forgets the indexes."""
    original = getattr(list, name)

    def method(self: ChunkStore, *args: Any, **keys: Any) -> Any:
        try:
            return original(self, *args, **keys)
        finally:
            self.forget_order()

    method.__name__ = name
    return method


class ChunkStore(list[Chunk]):
    """A list of chunks in the order they came in, with an index for each slot that was ever asked about.

    It may be read and changed like any list; a change other than `keep` throws the indexes away, and they are made
    anew when next needed.
    """

    def __init__(self, chunks: Iterable[Chunk] = ()) -> None:
        super().__init__(chunks)
        self._slots: dict[Slot, Postings] = {}
        self._holders: dict[Slot, list[Chunk]] = {}
        self._equals: dict[frozenset[Any], list[Chunk]] | None = None

    def forget_order(self) -> None:
        """Throws the indexes away: chunks came, went or changed."""
        self._slots.clear()
        self._holders.clear()
        self._equals = None

    extend = _mutator("extend")
    append = _mutator("append")
    insert = _mutator("insert")
    remove = _mutator("remove")
    pop = _mutator("pop")
    clear = _mutator("clear")
    sort = _mutator("sort")
    reverse = _mutator("reverse")
    __setitem__ = _mutator("__setitem__")
    __delitem__ = _mutator("__delitem__")
    __iadd__ = _mutator("__iadd__")
    __imul__ = _mutator("__imul__")

    def __deepcopy__(self, memo: dict[int, Any]) -> ChunkStore:
        import copy

        return ChunkStore([copy.deepcopy(chunk, memo) for chunk in self])

    def keep(self, chunk: Chunk) -> None:
        """Appends a chunk and enters it in the indexes there are."""
        list.append(self, chunk)
        chunk._store = self  # pyright: ignore[reportPrivateUsage]
        for slot, postings in self._slots.items():
            if slot in chunk:
                postings.setdefault(as_text(chunk[slot]), []).append(chunk)
        for slot, holders in self._holders.items():
            if slot in chunk:
                holders.append(chunk)
        if self._equals is not None:
            self._equals.setdefault(_likeness(chunk), []).append(chunk)

    def equal_to(self, chunk: Chunk) -> Chunk | None:
        """Returns the first chunk with the same slots and equal values."""
        if self._equals is None:
            self._equals = {}
            for known in self:
                self._adopt(known)
                self._equals.setdefault(_likeness(known), []).append(known)
        return next((known for known in self._equals.get(_likeness(chunk), ()) if known == chunk), None)

    def with_value(self, slot: Slot, text: str) -> list[Chunk]:
        """Returns, in order, the chunks whose value in `slot` reads as `text`; not to be changed by the caller."""
        postings = self._slots.get(slot)
        if postings is None:
            postings = self._slots[slot] = {}
            for chunk in self:
                self._adopt(chunk)
                if slot in chunk:
                    postings.setdefault(as_text(chunk[slot]), []).append(chunk)
        return postings.get(text, [])

    def with_slot(self, slot: Slot) -> list[Chunk]:
        """Returns, in order, the chunks that have the slot at all; not to be changed by the caller."""
        holders = self._holders.get(slot)
        if holders is None:
            holders = self._holders[slot] = []
            for chunk in self:
                self._adopt(chunk)
                if slot in chunk:
                    holders.append(chunk)
        return holders

    def _adopt(self, chunk: Chunk) -> None:
        chunk._store = self  # pyright: ignore[reportPrivateUsage]

    def __reduce_ex__(self, protocol: SupportsIndex) -> Any:
        return (ChunkStore, (list(self),))


def _likeness(chunk: Chunk) -> frozenset[Any]:
    """Returns a key that equal chunks share: their items, or only their slots where a value cannot be hashed."""
    try:
        return frozenset(chunk.items())
    except TypeError:
        return frozenset(chunk)
