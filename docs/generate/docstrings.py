"""Finds public names without a docstring: every name in the `__all__` of a public package, and the public members of its classes."""

from __future__ import annotations

import builtins
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import griffe

ROOT = Path(__file__).parents[2]

PACKAGES = ("actr", "camera", "experiment", "motor", "recording", "sgoms", "simulation", "vision", "world")
"""The packages of `actr3d` that the reference describes."""


def missing() -> Iterator[str]:
    """Yields a sentence for each public class, function, method, property or field without a docstring of its own or inherited."""
    library: Any = griffe.load("actr3d", search_paths=[ROOT], resolve_aliases=True)
    for package in PACKAGES:
        for name in library[package].exports or ():
            thing = library[package].members[str(name)]
            found = [thing, *(member for member in thing.all_members.values() if thing.is_class and not member.name.startswith("_"))]
            yield from (f"{one.path} has no docstring" for one in found if _needs_one(one) and not _inherits(one))


def _needs_one(member: Any) -> bool:
    """Returns whether a member has no docstring and should have one.

    Of attributes, these are properties, and fields of dataclasses that the docstring of the class does not describe as arguments.
    """
    if member.has_docstring or not member.is_attribute or "property" in member.labels:
        return not member.has_docstring
    owner = member.parent
    if owner is None or "dataclass" not in owner.labels or member.annotation is None:
        return False
    return owner.docstring is None or f"{member.name}: " not in owner.docstring.value


def _inherits(member: Any) -> bool:
    """Returns whether a class above the member's own, a built-in one too, describes it."""
    owner = member.parent
    if owner is None or not owner.is_class:
        return False
    above = any(base.members[member.name].has_docstring for base in owner.mro() if member.name in base.members)
    built_in = (getattr(builtins, str(base).rpartition(".")[2].partition("[")[0], None) for base in owner.bases)
    return above or any(hasattr(base, member.name) for base in built_in)
