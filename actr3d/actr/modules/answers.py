"""Converts answers to the forms that agents, traces, recordings and pages need: those of a body, and those to questions of a page."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import fields, is_dataclass
from typing import Any, cast

from actr3d.actr.chunks.chunk import PLAIN_TYPES
from actr3d.weak_cache import weak_cache


@weak_cache
def _traced_fields(kind: type[Any]) -> tuple[str, ...] | None:
    """Returns the fields of a dataclass that become plain values; None if it is none, or has a summary instead."""
    if hasattr(kind, "summary") or not is_dataclass(kind):
        return None
    return tuple(field.name for field in fields(kind) if "not_traced" not in field.metadata)


def copied_answer(answer: Any) -> Any:
    """Returns an answer that an agent may change: lists and dicts are copies, as the same answer is used when the run goes back."""
    if type(answer) is dict:
        return {key: copied_answer(value) for key, value in cast("dict[Any, Any]", answer).items()}
    return [copied_answer(value) for value in cast("list[Any]", answer)] if type(answer) is list else answer


def plain_answer(answer: Any) -> Any:
    """Returns any answer as plain values, lists and dicts: a reading of a sensor, an explanation, a row of a table.

    A frozen dataclass becomes a dict of its fields except those marked `NOT_TRACED`; an object with a `summary()`, such as a view,
    becomes that.
    """
    kind = cast("type[Any]", type(answer))
    if answer is None or kind in PLAIN_TYPES:
        return answer
    if kind is tuple or kind is list:  # the most frequent, and without the slow tests below
        return _plain_values(answer)
    names = _traced_fields(kind)
    if names is not None:
        values = [(name, getattr(answer, name)) for name in names]
        return {name: value if type(value) in PLAIN_TYPES else plain_answer(value) for name, value in values}
    if hasattr(answer, "summary"):
        return plain_answer(answer.summary())
    if isinstance(answer, Mapping):
        items = cast("Mapping[Any, Any]", answer).items()
        return {key if isinstance(key, str) else str(plain_answer(key)): plain_answer(value) for key, value in items}
    if isinstance(answer, (list, tuple)):
        return _plain_values(cast("Sequence[Any]", answer))
    return answer.tolist() if hasattr(answer, "tolist") else repr(answer)


def _plain_values(values: Sequence[Any]) -> list[Any]:
    return [value if type(value) in PLAIN_TYPES else plain_answer(value) for value in values]


def answer_slots(sensor: str, answer: Any) -> dict[str | int, Any]:
    """Returns the slots of a chunk made from an answer: the sensor's name first, then the sensed values, by name or in order."""
    slots: dict[str | int, Any] = {0: sensor}
    if hasattr(answer, "summary"):  # such an object is too large for slots
        slots["seen"] = answer
    elif is_dataclass(answer):
        slots.update({field.name: getattr(answer, field.name) for field in fields(answer)})
    elif isinstance(answer, Mapping):
        slots.update(cast("Mapping[str, Any]", answer))
    elif isinstance(answer, (list, tuple)):
        slots.update(enumerate(cast("Sequence[Any]", answer), start=1))
    else:
        slots[1] = answer
    return slots
