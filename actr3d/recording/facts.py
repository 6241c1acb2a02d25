"""The facts of a recording: what each of them is, which runs have it, and what a replay does with it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Literal, cast

from actr3d.errors import RecordingError
from actr3d.values import shortened

LEFT = "left"
"""The value of the fact `ended` if the user left the run before its end. All other values mean that the run ended by itself: `end` and
`exit` (`SystemExit`) of programs; `stop`, `done` and `limits` of a simulation that a file builds, see `RunReport`. A run that raised
anything else has the fact `failed` instead; a run that was interrupted has neither."""

SIMULATION = "simulation {}"
"""The name of the fact of each simulation of a program, by its number: its compiled scene (`compiled`) and its `world` at its start, and
its `period_us`, as in a recording of that simulation alone; or only `same_as`, the name of such a fact with the same values."""
SAME_AS = "same_as"

LARGEST = 2**63
"""All numbers of a recording are smaller."""


RunKind = Literal["program", "simulation", "built"]
"""What is recorded: a program, a simulation, or a simulation that a model file builds, which is of the last two kinds."""


@dataclass(frozen=True)
class RecordedFact:
    """A fact that this library or the workbench reads."""

    words: str
    """What its value must be."""
    fits: Callable[[Any], bool]
    """Returns whether a value is so."""
    always: bool = False
    """Whether every recording has it."""
    needed_by: tuple[RunKind, ...] = ()
    """The runs that cannot be run again without it."""
    only: RunKind | None = None
    """The only runs that can have it, if they run the text of a file; None if all can."""
    of_simulation: bool = False
    """Whether the fact of each simulation of a program holds it, too."""
    of_end: bool = False
    """Whether it describes how the run ended."""
    replay: Literal["compares", "notes", "ignores"] = "compares"
    """Whether a replay compares it, notes that it cannot check it, or ignores it."""


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


_Values = tuple[str, Callable[[Any], bool]]
_TEXT: _Values = ("a text", lambda value: isinstance(value, str))
_TEXTS: _Values = ("texts by their names, without NUL characters", _texts)
_SEED: _Values = ("a whole number or a text", lambda value: isinstance(value, str) or type(value) is int)
_PERIOD: _Values = ("a whole number > 0", lambda value: type(value) is int and 0 < value < LARGEST)
_DICT: _Values = ("values by their names", lambda value: isinstance(value, dict))
FACTS = {
    # A file of another format is not opened; other versions are refused or allowed before a replay.
    "form": RecordedFact(*_TEXT, always=True, replay="ignores"),
    "kind": RecordedFact("'simulation' or 'program'", lambda value: value in ("simulation", "program"), always=True),
    "versions": RecordedFact(*_TEXTS, always=True, replay="ignores"),
    "file": RecordedFact("a text without NUL characters", _plain, needed_by=("program", "built")),
    "sources": RecordedFact(*_TEXTS, needed_by=("program", "built")),
    "helpers": RecordedFact("a file and a text by the names of modules, without NUL characters", _modules),
    "parameters": RecordedFact(*_DICT, needed_by=("built",), only="built"),
    "built": RecordedFact("true or false", lambda value: isinstance(value, bool), only="built"),
    "seed": RecordedFact(*_SEED, needed_by=("program", "simulation")),
    "program_seed": RecordedFact(*_SEED, needed_by=("built",), only="built"),
    "until": RecordedFact(
        "a number > 0, or null", lambda value: value is None or (_number(value) and value > 0), needed_by=("program", "built")
    ),
    "period_us": RecordedFact(*_PERIOD, needed_by=("simulation",), only="simulation", of_simulation=True),
    "timestep_us": RecordedFact(*_PERIOD, needed_by=("simulation",), only="simulation"),
    "scene": RecordedFact(*_TEXT, needed_by=("simulation",), only="simulation"),
    "compiled": RecordedFact(*_TEXT, only="simulation", of_simulation=True),
    "world": RecordedFact(*_DICT, only="simulation", of_simulation=True),
    "failed": RecordedFact("a text, or null", lambda value: value is None or isinstance(value, str), of_end=True),
    "ended": RecordedFact('{"by": a text}, or null', _ended, of_end=True),
    "whole": RecordedFact("true, or null", lambda value: value is True or value is None, only="simulation", of_end=True),
    # Of a run of the workbench, which a replay by the command does not have.
    "branched": RecordedFact("a number >= 0, or null", lambda value: value is None or _number(value), replay="notes"),
    "origin": RecordedFact(*_TEXT, replay="notes"),
    "ancestors": RecordedFact("pairs of a text and a number >= 0", _ancestors, replay="notes"),
    "named": RecordedFact(*_TEXT, replay="ignores"),
    "reached": RecordedFact("a number >= 0", _number, replay="ignores"),
}
"""The facts that this library or the workbench reads, besides those of the simulations of a program; other facts may have any values.

A recording itself writes those that it always has, and those of its end. A run of the workbench may have: the time at which a
branch begins (`branched`), the recording from which it branches by its first name (`origin`), the recordings from which that one branches,
each with its time (`ancestors`), the name that the workbench gave the file, by which branches know it after it was renamed (`named`), and
the time that the runs of a program have reached together [s], which shows nowhere else after the last event (`reached`)."""
OF_END = [name for name, fact in FACTS.items() if fact.of_end]
"""The facts of how a run ended, in the order in which they are compared."""
_OF_SIMULATION = [name for name, fact in FACTS.items() if fact.of_simulation]


def _simulation(value: Any) -> bool:
    if value is None:
        return True
    return isinstance(value, dict) and all(FACTS[name].fits(cast("dict[str, Any]", value).get(name)) for name in _OF_SIMULATION)


_SIMULATION = RecordedFact(f"values of {', '.join(_OF_SIMULATION)}, or null", _simulation, only="program")
_SHOWN = 60
"""No more of a wrong value is quoted [characters]."""


def is_of_simulation(name: str) -> bool:
    """Returns whether a fact is that of a simulation of a program."""
    return name.startswith(SIMULATION.format(""))


def fact_of(name: str) -> RecordedFact | None:
    """Returns the description of a fact; None if this library does not read it."""
    return _SIMULATION if is_of_simulation(name) else FACTS.get(name)


def check_fact(name: str, value: Any) -> None:
    """Checks a fact that this library reads; other facts may have any value.

    Raises:
        RecordingError: If it is another value.
    """
    fact = fact_of(name)
    if fact is not None and not fact.fits(value):
        raise RecordingError(f"the fact '{name}' of a recording must be {fact.words} (got {shortened(repr(value), _SHOWN)})")


def check_facts(facts: Mapping[str, Any]) -> None:
    """Checks all facts, and raises an error if one that every recording has is missing.

    Raises:
        RecordingError: If one is missing or has a wrong value.
    """
    missing = [f"the fact '{name}'" for name, fact in FACTS.items() if fact.always and name not in facts]
    if missing:
        raise RecordingError(f"it lacks {' and '.join(missing)}")
    for name, value in facts.items():
        check_fact(name, value)
