"""Finds keywords of `memory.add` that nothing takes."""

from __future__ import annotations

import inspect
from collections.abc import Iterable, Mapping
from functools import lru_cache
from typing import TYPE_CHECKING, Any

from actr3d.errors import did_you_mean
from actr3d.saying import warn_modeller

if TYPE_CHECKING:
    from actr3d.actr.activation import MemorySubModule

KNOWN = frozenset({"record", "time", "baselevel", "fixed"})
"""What the library's own modules take; a model may give it though it has no such module."""


def check_keywords(keys: Mapping[str, Any], modules: Iterable[MemorySubModule]) -> None:
    """Warns of keywords that no activation module takes; they have no effect."""
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
        warn_modeller(f"memory.add has no keyword '{name}' that any activation module takes{did_you_mean(name, taken)}")


@lru_cache(maxsize=256)
def _taken(kind: type[MemorySubModule]) -> tuple[frozenset[str], bool]:
    """Returns the keywords that a class of module takes by name, and whether it may look at any other."""
    names: set[str] = set()
    everything = False
    for method in (kind.create, kind.merge):
        parameters = inspect.signature(method).parameters.values()
        names.update(p.name for p in parameters if p.kind in (p.POSITIONAL_OR_KEYWORD, p.KEYWORD_ONLY))
        rest = next((p.name for p in parameters if p.kind is p.VAR_KEYWORD), None)
        if rest is not None and not method.__module__.startswith("actr3d."):
            everything = True
    return frozenset(names - {"self", "chunk"}), everything
