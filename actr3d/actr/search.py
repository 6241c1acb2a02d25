"""Searches a memory for chunks: a pattern with the values its variables have, answered from the indexes.

Most searches name plain slots; those are answered from the index of the rarest value asked for. Whatever else a
pattern may say (functions, dotted paths, similar values) is left to `Pattern`.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import lru_cache
from typing import TYPE_CHECKING, Any, Protocol, cast

from actr3d.actr.chunk import Chunk, Slot, as_text
from actr3d.actr.pattern import Pattern, parse
from actr3d.actr.store import ChunkStore

if TYPE_CHECKING:
    from actr3d.actr.partial import Partial


@lru_cache(maxsize=4096)
def _plan(text: str) -> tuple[tuple[Slot, str, str], ...] | None:
    """Reads a request's text; None where it names slots that only `Pattern` can find."""
    tests = parse(text)
    for slot, _, _ in tests:
        if isinstance(slot, str) and (slot[0] == "?" or "." in slot):
            return None
    return tests


class Search(Protocol):
    """What a memory is asked for."""

    @property
    def partial(self) -> Partial | None:
        """What mismatches cost, where similar values may match."""
        ...

    def among(self, store: ChunkStore) -> list[Chunk]:
        """Returns the chunks that match, in the order they came."""
        ...


class PlainSearch:
    """A search that names plain slots only.

    Args:
        tests: What is asked, as (slot, sign, word); see `pattern.parse`.
        bound: The variables that have a value.
    """

    __slots__ = ("differ", "equal", "partial", "present", "same", "unequal")

    def __init__(self, tests: Sequence[tuple[Slot, str, str]], bound: Mapping[str, Any] | None) -> None:
        self.partial = None
        self.equal: list[tuple[Slot, str]] = []
        self.unequal: list[tuple[Slot, str]] = []
        self.present: dict[str, Slot] = {}
        self.same: list[tuple[Slot, str]] = []
        self.differ: list[tuple[Slot, str]] = []
        for slot, sign, word in tests:
            if sign == "is":
                self.equal.append((slot, word))
            elif sign == "not":
                self.unequal.append((slot, word))
            elif bound is not None and word in bound:
                value = bound[word]
                text = value if type(value) is str else as_text(value)
                (self.equal if sign == "?" else self.unequal).append((slot, text))
            elif sign == "!?":
                self.differ.append((slot, word))
            elif word in self.present:
                self.same.append((slot, word))
            else:
                self.present[word] = slot

    def __str__(self) -> str:
        words = [f"{slot}:{text}" for slot, text in self.equal]
        for name, slot in self.present.items():
            words.append(f"{slot}:?{name}")
        if self.unequal or self.same or self.differ:
            words += [f"{slot}:!{text}" for slot, text in self.unequal]
            words += [f"{slot}:?{name}" for slot, name in self.same]
            words += [f"{slot}:!?{name}" for slot, name in self.differ]
        return " ".join(words)

    def among(self, store: ChunkStore) -> list[Chunk]:
        """Returns the chunks that match, in the order they came."""
        found: list[Chunk] | None = None
        for slot, text in self.equal:
            chunks = store.with_value(slot, text)
            if found is None or len(chunks) < len(found):
                found = chunks
                if not chunks:
                    return []
        if found is None:
            found = store
            for slot in [*self.present.values(), *(slot for slot, _ in self.unequal)]:
                holders = store.with_slot(slot)
                if len(holders) < len(found):
                    found = holders
        return [chunk for chunk in found if self._fits(chunk)]

    def _fits(self, chunk: Chunk) -> bool:
        for slot, text in self.equal:
            value = chunk.get(slot, _NOTHING)
            if value != text and (type(value) is str or value is _NOTHING or as_text(value) != text):
                return False
        for slot in self.present.values():
            if slot not in chunk:
                return False
        return not (self.unequal or self.same or self.differ) or self._fits_rest(chunk)

    def _fits_rest(self, chunk: Chunk) -> bool:
        for slot, text in self.unequal:
            if slot not in chunk or as_text(chunk[slot]) == text:
                return False
        for slot, name in (*self.same, *self.differ):
            if slot not in chunk or name not in self.present:
                return False
        if any(as_text(chunk[slot]) != as_text(chunk[self.present[name]]) for slot, name in self.same):
            return False
        return all(as_text(chunk[slot]) != as_text(chunk[self.present[name]]) for slot, name in self.differ)


_NOTHING = object()


class PatternSearch:
    """Any other search.

    Args:
        pattern: What is asked for; a mapping stands for its slots and values.
        bound: The variables that have a value.
        partial: What mismatches cost, where similar values may match.

    Raises:
        PatternException: If a text is no pattern.
    """

    def __init__(self, pattern: object, bound: Mapping[str, Any] | None, partial: Partial | None) -> None:
        self.partial = partial
        self._pattern = Pattern([cast("object", pattern)] if isinstance(pattern, Mapping) else pattern, bound, partial)

    def __str__(self) -> str:
        return " ".join(map(str, self._pattern.conditions))

    def among(self, store: ChunkStore) -> list[Chunk]:
        """Returns the chunks that match, in the order they came."""
        chunks: list[Chunk] = store
        for op, _, slot, value in self._pattern.conditions:
            if op in ("call", "empty") or (isinstance(slot, str) and (slot[:1] == "?" or "." in slot)):
                continue
            fewer = store.with_value(slot, value) if op == "is" and self.partial is None else store.with_slot(slot)
            if len(fewer) < len(chunks):
                chunks = fewer
        match = self._pattern.match
        return [chunk for chunk in chunks if match(chunk) is not None]


def search_for(pattern: object, bound: Mapping[str, Any] | None, partial: Partial | None) -> Search:
    """Returns the quickest search for a pattern.

    Raises:
        PatternException: If a text is no pattern.
    """
    if partial is None and type(pattern) is str:
        tests = _plan(pattern)
        if tests is not None:
            return PlainSearch(tests, bound)
    return PatternSearch(pattern, bound, partial)
