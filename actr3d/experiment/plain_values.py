"""Plain values: those that tables, databases, JSON and the text of a model can hold."""

from __future__ import annotations

import json
import math
from collections.abc import Iterable, Mapping, Sequence
from contextlib import suppress
from typing import Any, cast

from actr3d.errors import DesignError
from actr3d.experiment.distributions import Distribution
from actr3d.values import escape_surrogates

LARGEST = 2**63
"""Whole numbers must be below this, which tables and databases can store."""
HUGE = 1e100
"""The maximum size of a number: the squares of larger ones may be infinite."""


def as_python(value: Any) -> Any:
    """Returns a value with the numbers and arrays of numpy in it as numbers and lists of Python, which tables and texts can hold.

    A list that contains itself is left as it is.
    """
    convert: Any = getattr(value, "tolist", None)
    if callable(convert):
        return convert()
    if type(value) in (list, tuple):
        with suppress(RecursionError):
            return type(value)(map(as_python, value))
    return value


def plain_text(value: Any) -> str:
    """Returns a level of a factor as text: `fast`, `True`, `none`, `0.5`, `[1, 2]`; `1.0` as `1`."""
    match value:
        case None | "":
            return "none"
        case float() if math.isnan(value):
            return "none"
        case float():
            return text if float(text := f"{value:g}") == value else repr(float(value))
        case list() | tuple() | dict():
            return json.dumps(value)
        case _:
            return str(value)


def text_cell(value: Any) -> str | None:
    """Returns a value as it is in a column of texts; None for an empty cell, for which pandas has NaN."""
    if value is None or isinstance(value, str):
        return value
    return None if isinstance(value, float) and math.isnan(value) else plain_text(value)


def why_unstorable(value: Any) -> str | None:
    """Returns in words why tables and databases cannot store a whole number or a text, as the end of an error; None if they can."""
    if isinstance(value, int) and not -LARGEST <= value < LARGEST:
        return f"must be a whole number of at most 64 bits, or a float (got one of {value.bit_length()} bits)"
    if isinstance(value, str) and escape_surrogates(value) != value:
        return f"must be a text of characters that can be stored (got {value!r})"
    return None


def _has_no_end(value: Any, within: frozenset[int] = frozenset()) -> bool:
    """Returns whether a list or dict contains itself, or is too deep for Python."""
    if not isinstance(value, (list, tuple, Mapping)):
        return False
    if id(cast("Any", value)) in within:
        return True
    parts = cast("Iterable[Any]", value.values() if isinstance(value, Mapping) else value)
    try:
        return any(_has_no_end(part, within | {id(cast("Any", value))}) for part in parts)
    except RecursionError:
        return True


def check_plain(value: Any, where: str, name: str, *, drawn: bool = False) -> None:
    """Checks that a value, and each value in it, can be written to tables, to JSON and into the text of a model.

    Args:
        value: The value.
        where: What it is the value of, for the error.
        name: The name that leads to its line.
        drawn: Whether it may be a distribution.

    Raises:
        DesignError: If one of them cannot be written.
    """
    if drawn and isinstance(value, Distribution) and not isinstance(value, type):
        return
    if _has_no_end(value):
        raise DesignError(f"{where}: must not contain itself, or too many lists and dicts within each other", name)
    waiting = [value]
    for one in waiting:
        wrong = why_unstorable(one)
        match one:
            case list() | tuple():
                waiting += cast("Sequence[Any]", one)
            case Mapping() if all(isinstance(key, str) for key in cast("Mapping[Any, Any]", one)):
                waiting += (part for pair in cast("Mapping[str, Any]", one).items() for part in pair)
            case float() if not math.isfinite(one):
                wrong = f"must be finite (got {value!r})"
            case int() | float() | str() | None:
                pass
            case Distribution() if not isinstance(one, type):
                own = "Group.parameters, for one value of each participant, or Design.settings, for one of each trial"
                raise DesignError(f"{where}: a distribution belongs to {own} (got {value!r})", name)
            case _:
                wrong = f"must be a number, text, True, False, None, or a list or dict of these (got {value!r})"
        if wrong is not None:
            raise DesignError(f"{where}: {wrong}", name)
