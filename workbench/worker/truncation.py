"""Limits the size of what is shown: a model may create texts and lists of any length, and pages must still work."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from actr3d.trace import TraceEvent
from actr3d.values import plain_to_json, to_json

LARGEST = 200_000
"""Maximum length of an event, or of all parts together, as JSON [characters]; longer values are cut for display but recorded completely."""
LONGEST_TEXT = 2_000
MAX_ENTRIES = 200


def bounded_json(value: Any, *, whole: Callable[[Any], str] = to_json) -> bytes:
    """Returns a value as JSON; if it is too long, its long texts and collections are cut, or a message takes its place.

    Args:
        value: Any value that can be written as JSON.
        whole: Converts the uncut value to JSON.
    """
    text = whole(value)
    if len(text) > LARGEST:
        size, text = len(text), to_json(cut(value))
        if len(text) > LARGEST:
            text = to_json(_placeholder(value, f"too long to be shown: {size:,} characters"))
    return text.encode()


def event_json(event: TraceEvent) -> bytes:
    """Returns an event as JSON for pages: time [us], source, kind, data."""
    return bounded_json(list(event), whole=plain_to_json)


def cut(value: Any) -> Any:
    """Returns a value in which long texts and collections are cut, with a note of how much is missing."""
    if isinstance(value, str):
        left = len(value) - LONGEST_TEXT
        return value if left <= 0 else f"{value[:LONGEST_TEXT]} … ({left:,} more characters)"
    if isinstance(value, dict):
        entries: list[tuple[Any, Any]] = list(value.items())  # pyright: ignore[reportUnknownArgumentType,reportUnknownVariableType]
        kept = {key if len(str(key)) <= LONGEST_TEXT else str(key)[:LONGEST_TEXT]: cut(entry) for key, entry in entries[:MAX_ENTRIES]}
        return kept if len(entries) <= MAX_ENTRIES else {**kept, "…": f"{len(entries) - MAX_ENTRIES:,} more"}
    if isinstance(value, (list, tuple)):
        items: list[Any] = list(value)  # pyright: ignore[reportUnknownArgumentType]
        some = [cut(entry) for entry in items[:MAX_ENTRIES]]
        return some if len(items) <= MAX_ENTRIES else [*some, f"… ({len(items) - MAX_ENTRIES:,} more)"]
    return value


def _placeholder(value: Any, reason: str) -> Any:
    """Returns a placeholder for a value that is too long even after cutting; for an event, with its time, source and kind."""
    if isinstance(value, list):
        entries: list[Any] = list(value)  # pyright: ignore[reportUnknownArgumentType]
        return [entry if isinstance(entry, (int, float)) else {"…": reason} if isinstance(entry, dict) else cut(entry) for entry in entries]
    return {"…": reason}
