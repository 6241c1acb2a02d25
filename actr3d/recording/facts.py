"""What the facts of a recording are, as far as this library reads them itself."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, cast

from actr3d.errors import RecordingError
from actr3d.recording.schema import is_of_simulation
from actr3d.values import shortened

LARGEST = 2**63
"""All numbers of a recording are smaller."""


@dataclass(frozen=True)
class _Kind:
    words: str
    fits: Callable[[Any], bool]


def _number(value: Any) -> bool:
    return type(value) in (int, float) and 0 <= value < LARGEST


def _plain(*values: Any) -> bool:
    """Returns whether values are texts that may name a file or be the source of a program: without NUL characters."""
    return all(isinstance(value, str) and "\0" not in value for value in values)


def _texts(value: Any) -> bool:
    return isinstance(value, dict) and all(_plain(*entry) for entry in cast("dict[str, Any]", value).items())


def _pair(value: Any) -> bool:
    return isinstance(value, (list, tuple)) and len(cast("list[Any]", value)) == 2 and _plain(*cast("list[Any]", value))


def _modules(value: Any) -> bool:
    return isinstance(value, dict) and all(_plain(name) and _pair(texts) for name, texts in cast("dict[str, Any]", value).items())


def _ended(value: Any) -> bool:
    return value is None or (isinstance(value, dict) and isinstance(cast("dict[str, Any]", value).get("by"), str))


def _ancestors(value: Any) -> bool:
    return isinstance(value, (list, tuple)) and all(
        isinstance(one, (list, tuple)) and len(cast("list[Any]", one)) == 2 and isinstance(one[0], str) and _number(one[1])
        for one in cast("list[Any]", value)
    )


def _simulation(value: Any) -> bool:
    if value is None:
        return True
    return isinstance(value, dict) and all(_KINDS[name].fits(cast("dict[str, Any]", value).get(name)) for name in IN_SIMULATION)


IN_SIMULATION = ("period_us", "compiled", "world")
"""What the fact of a simulation of a program holds."""
_SIMULATION = _Kind(f"values of {', '.join(IN_SIMULATION)}, or null", _simulation)
_TEXT = _Kind("a text", lambda value: isinstance(value, str))
_TEXTS = _Kind("texts by their names, without NUL characters", _texts)
_SEED = _Kind("a whole number or a text", lambda value: isinstance(value, str) or type(value) is int)
_PERIOD = _Kind("a whole number > 0", lambda value: type(value) is int and 0 < value < LARGEST)
_DICT = _Kind("values by their names", lambda value: isinstance(value, dict))
_KINDS = {
    "form": _TEXT,
    "versions": _TEXTS,
    "kind": _Kind("'simulation' or 'program'", lambda value: value in ("simulation", "program")),
    "file": _Kind("a text without NUL characters", _plain),
    "sources": _TEXTS,
    "helpers": _Kind("a file and a text by the names of modules, without NUL characters", _modules),
    "parameters": _DICT,
    "built": _Kind("true or false", lambda value: isinstance(value, bool)),
    "seed": _SEED,
    "program_seed": _SEED,
    "until": _Kind("a number > 0, or null", lambda value: value is None or (_number(value) and value > 0)),
    "period_us": _PERIOD,
    "timestep_us": _PERIOD,
    "scene": _TEXT,
    "compiled": _TEXT,
    "world": _DICT,
    "ended": _Kind('{"by": a text}, or null', _ended),
    "failed": _Kind("a text, or null", lambda value: value is None or isinstance(value, str)),
    "whole": _Kind("true, or null", lambda value: value is True or value is None),
    "branched": _Kind("a number >= 0, or null", lambda value: value is None or _number(value)),
    "named": _TEXT,
    "origin": _TEXT,
    "ancestors": _Kind("pairs of a text and a number >= 0", _ancestors),
    "reached": _Kind("a number >= 0", _number),
}
"""The facts that this library or the workbench reads; other facts may have any values."""
_SHOWN = 60
"""No more of a wrong value is quoted [characters]."""


def check_fact(name: str, value: Any) -> None:
    """Checks a fact that this library reads; other facts may have any value.

    Raises:
        RecordingError: If it is another value.
    """
    kind = _SIMULATION if is_of_simulation(name) else _KINDS.get(name)
    if kind is not None and not kind.fits(value):
        raise RecordingError(f"the fact '{name}' of a recording must be {kind.words} (got {shortened(repr(value), _SHOWN)})")


def check_facts(facts: Mapping[str, Any]) -> None:
    """Checks all facts, and raises an error if one that every recording has is missing.

    Raises:
        RecordingError: If one is missing or has a wrong value.
    """
    missing = [f"the fact '{name}'" for name in ("kind", "versions") if name not in facts]
    if missing:
        raise RecordingError(f"it lacks {' and '.join(missing)}")
    for name, value in facts.items():
        check_fact(name, value)
