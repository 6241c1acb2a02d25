"""Reads the facts of a recorded run, whose names depend on its kind."""

from __future__ import annotations

from typing import Any

MAX_EXACT = 2**53
"""The first whole number from which on JavaScript rounds."""


def seed_of(facts: dict[str, Any]) -> int | str | None:
    """Returns the seed that was chosen for a run; None if its recording has none."""
    return facts.get("program_seed", facts.get("seed"))


def exact_seed(seed: Any) -> Any:
    """Returns a seed in a form that a page can read without loss: a number that JavaScript would round is a text."""
    return str(seed) if isinstance(seed, int) and abs(seed) >= MAX_EXACT else seed


def source_of(facts: dict[str, Any]) -> str:
    """Returns the text of a run's model file; an empty text if its recording does not have it."""
    return facts.get("sources", {}).get(str(facts.get("file", "")), "")
