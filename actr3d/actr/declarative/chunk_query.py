"""Searches a memory's chunks for a pattern, using the indexes.

Most searches name plain slots; these use the index of the rarest requested value. Everything else in a pattern (functions,
dotted paths, similar values) is tested by `Pattern`.
"""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from functools import lru_cache
from typing import Any, TypeAlias, cast

from actr3d.actr.chunks.chunk import Chunk, Slot, as_text
from actr3d.actr.chunks.pattern import Pattern, by_variable, not_patterns, parse
from actr3d.actr.declarative.chunk_index import ChunkStore
from actr3d.actr.declarative.partial_matching import Partial
from actr3d.warnings import warn_modeller


@lru_cache(maxsize=4096)
def _variables(text: str) -> tuple[str, ...] | None:
    """Returns the variables in a request's text; None if it names slots that only `Pattern` can find."""
    tests = parse(text)
    if not all(_is_plain(slot) for slot, _, _ in tests):
        return None
    return tuple(dict.fromkeys(word for _, sign, word in tests if sign in ("?", "!?")))


class _Plan:
    """The tests of a request, as far as they follow from its text and the names of the bound variables.

    Args:
        tests: The tests as (slot, sign, word); see `pattern.parse`.
        known: The bound variables.
    """

    __slots__ = ("differ", "equal", "more", "present", "same", "unequal", "unknown")

    def __init__(self, tests: Sequence[tuple[Slot, str, str]], known: Collection[str]) -> None:
        self.equal: list[tuple[Slot, str, bool]] = []
        """Slots and the texts that they must have; True if the text is the name of a bound variable."""
        self.unequal: list[tuple[Slot, str, bool]] = []
        self.unknown: dict[str, Slot] = {}
        """The first slot of each unbound variable."""
        self.same: list[tuple[Slot, str]] = []
        self.differ: list[tuple[Slot, str]] = []
        for slot, sign, word in tests:
            if sign in ("is", "not"):
                (self.equal if sign == "is" else self.unequal).append((slot, word, False))
            elif word in known:
                (self.equal if sign == "?" else self.unequal).append((slot, word, True))
            elif sign == "!?":
                self.differ.append((slot, word))
            elif word in self.unknown:
                self.same.append((slot, word))
            else:
                self.unknown[word] = slot
        self.present = tuple(self.unknown.values())
        self.more = bool(self.unequal or self.same or self.differ)
        """Whether there are tests other than for equal texts and for the presence of slots."""


@lru_cache(maxsize=4096)
def _plan(text: str, known: tuple[str, ...]) -> _Plan:
    return _Plan(parse(text), known)


class PlainSearch:
    """A search that names plain slots only.

    Args:
        plan: The tests.
        bound: The values of the bound variables.
    """

    __slots__ = ("_plan", "equal", "partial", "unequal")

    def __init__(self, plan: _Plan, bound: Mapping[str, Any]) -> None:
        self.partial = None
        self._plan = plan
        self.equal = _with_values(plan.equal, bound)
        self.unequal = _with_values(plan.unequal, bound) if plan.more else ()

    def __str__(self) -> str:
        plan = self._plan
        words = [f"{slot}:{text}" for slot, text in self.equal]
        words += [f"{slot}:?{name}" for name, slot in plan.unknown.items()]
        words += [f"{slot}:!{text}" for slot, text in self.unequal]
        words += [f"{slot}:?{name}" for slot, name in plan.same]
        words += [f"{slot}:!?{name}" for slot, name in plan.differ]
        return " ".join(words)

    def among(self, store: ChunkStore) -> list[Chunk]:
        """Returns the chunks that match, in the order in which they were added."""
        found: list[Chunk] | None = None
        for slot, text in self.equal:
            chunks = store.with_value(slot, text)
            if found is None or len(chunks) < len(found):
                found = chunks
                if not chunks:
                    return []
        if found is None:
            found = store
            for slot in [*self._plan.present, *(slot for slot, _ in self.unequal)]:
                holders = store.with_slot(slot)
                if len(holders) < len(found):
                    found = holders
        fits = self._fits
        return [chunk for chunk in found if fits(chunk)]

    def _fits(self, chunk: Chunk) -> bool:
        for slot, text in self.equal:
            value = chunk.get(slot, _NOTHING)
            if value != text and (type(value) is str or value is _NOTHING or as_text(value) != text):
                return False
        plan = self._plan
        for slot in plan.present:
            if slot not in chunk:
                return False
        return not plan.more or self._fits_rest(chunk)

    def _fits_rest(self, chunk: Chunk) -> bool:
        for slot, text in self.unequal:
            if slot not in chunk or as_text(chunk[slot]) == text:
                return False
        plan = self._plan
        for slot, name in (*plan.same, *plan.differ):
            if slot not in chunk or name not in plan.unknown:
                return False
        if any(as_text(chunk[slot]) != as_text(chunk[plan.unknown[name]]) for slot, name in plan.same):
            return False
        return all(as_text(chunk[slot]) != as_text(chunk[plan.unknown[name]]) for slot, name in plan.differ)


class SimilarSearch(PlainSearch):
    """A search that names plain slots only, without negations, in which similar values may match.

    Args:
        plan: The tests.
        bound: The values of the bound variables.
        partial: Computes the penalties of mismatches.
    """

    __slots__ = ()

    def __init__(self, plan: _Plan, bound: Mapping[str, Any], partial: Partial) -> None:
        super().__init__(plan, bound)
        self.partial = partial

    def among(self, store: ChunkStore) -> list[Chunk]:
        """Returns the chunks that match, in the order in which they were added; sets their `penalty`."""
        found: list[Chunk] = store
        for slot in [*(slot for slot, _ in self.equal), *self._plan.present]:
            holders = store.with_slot(slot)
            if len(holders) < len(found):
                found = holders
        return [chunk for chunk in found if self._fits(chunk)]

    def _fits(self, chunk: Chunk) -> bool:
        if any(slot not in chunk for slot in self._plan.present):
            return False
        penalty = 0.0
        match = self.partial.match
        for slot, text in self.equal:
            value = chunk.get(slot, _NOTHING)
            if value is _NOTHING:
                return False
            held = value if type(value) is str else as_text(value)
            if held != text:
                try:
                    penalty += match(slot, text, held)
                except (AttributeError, TypeError, KeyError):  # a modeller's own `match` may not know the values
                    return False
        chunk.penalty = penalty
        return True


def _with_values(tests: Sequence[tuple[Slot, str, bool]], bound: Mapping[str, Any]) -> list[tuple[Slot, str]]:
    """Returns slots and texts, with variables replaced by their values."""
    found: list[tuple[Slot, str]] = []
    for slot, word, is_variable in tests:
        if is_variable:
            value = bound[word]
            word = value if type(value) is str else as_text(value)
        found.append((slot, word))
    return found


_NOTHING = object()


class PatternSearch:
    """Any other search.

    Args:
        pattern: The pattern; a mapping means its slots and values.
        bound: The values of the bound variables.
        partial: Computes the penalties of mismatches, if similar values may match.

    Raises:
        PatternException: If a text is not a pattern.
    """

    def __init__(self, pattern: object, bound: Mapping[str, Any] | None, partial: Partial | None) -> None:
        self.partial = partial
        self._pattern = Pattern([cast("object", pattern)] if isinstance(pattern, Mapping) else pattern, bound, partial)

    def __str__(self) -> str:
        return " ".join(map(str, self._pattern.conditions))

    @property
    def equal(self) -> list[tuple[Slot, str]]:
        """The required slots and the texts of their values."""
        return [(slot, value) for op, _, slot, value in self._pattern.conditions if op == "is" and _is_plain(slot)]

    def among(self, store: ChunkStore) -> list[Chunk]:
        """Returns the chunks that match, in the order in which they were added."""
        chunks: list[Chunk] = store
        for op, _, slot, value in self._pattern.conditions:
            if op in ("call", "empty") or not _is_plain(slot):
                continue
            fewer = store.with_value(slot, value) if op == "is" and self.partial is None else store.with_slot(slot)
            if len(fewer) < len(chunks):
                chunks = fewer
        match = self._pattern.match
        return [chunk for chunk in chunks if match(chunk) is not None]


ChunkSearch: TypeAlias = PlainSearch | PatternSearch


def _is_plain(slot: Slot) -> bool:
    """Returns whether a slot is given by its name, not by a variable or a path."""
    return not (by_variable(slot) or (isinstance(slot, str) and "." in slot))


def search_for(pattern: object, bound: Mapping[str, Any] | None, partial: Partial | None) -> ChunkSearch:
    """Returns the fastest search for a pattern.

    Raises:
        PatternException: If a text is not a pattern.
    """
    if type(pattern) is str:
        variables = _variables(pattern)
        if variables is not None:
            known = tuple([name for name in variables if name in bound]) if bound else ()
            plan = _plan(pattern, known)
            if partial is None:
                return PlainSearch(plan, bound or {})
            if not plan.more:
                return SimilarSearch(plan, bound or {}, partial)
    for part in not_patterns(pattern):
        warn_modeller(f"the request {part!r} is not a pattern and matches anything; write text, such as '{part}'")
    return PatternSearch(pattern, bound, partial)
