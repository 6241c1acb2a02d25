"""The kinds of events that a trace records: the lowest level, the source, and the data of each."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

LEVELS = ("none", "production", "buffer", "all")
"""The levels of a trace: nothing; selections and firings; also buffer changes; everything."""


class Kind(NamedTuple):
    """A kind of event."""

    level: str
    """The lowest level at which it is recorded."""
    source: str
    """The part that emits it."""
    data: str
    """The names of its data; optional ones are in brackets, «...» means names that depend on the source."""
    meaning: str


KINDS: Mapping[str, Kind] = {
    "start": Kind("production", "top model", "model seed profile", "the trace of a run begins: the model's class, its seed and profile"),
    "command": Kind("production", "top model", "command data", "a user changes the run"),
    "select": Kind("production", "system", "production", "a production is chosen"),
    "fire": Kind("production", "system", "production bound", "a production fires, with the variables that it bound"),
    "changed": Kind("production", "system", "production", "a chosen production no longer matches, and does not fire"),
    "compile": Kind("production", "system", "production parents", "a production is learned from two others"),
    "reward": Kind("production", "system", "value", "an agent receives a reward"),
    "output": Kind("production", "model", "text", "an agent prints a line; also a program, in recordings and with `--json`"),
    "result": Kind("production", "top model", "...", "a run with a measure is over: its result"),
    "planning_unit": Kind(
        "production",
        "SGOMS buffer",
        "name what path [by]",
        "a planning unit is «begun», «ended», «interrupted» (by another), «resumed», «cut» (abandoned), or «going on» as a trace begins",
    ),
    "unit_task": Kind("production", "SGOMS buffer", "name what path", "the same for a unit task"),
    "method": Kind("production", "SGOMS buffer", "name what path", "the same for a method"),
    "operator": Kind("production", "SGOMS buffer", "name what path", "the same for an operator"),
    "buffer": Kind(
        "buffer",
        "buffer",
        "chunk [texts]",
        "the new chunk in a buffer (its slots), or none; `texts`: the text that patterns compare, for values such as lists",
    ),
    "run": Kind("all", "top model", "limit", "a run begins, for this time [s]; None without a limit"),
    "stop": Kind(
        "all", "top model", "by [error]", "a run ends: «limit», «until», «stop», «done» (nothing is left to do) or «error», with its class"
    ),
    "added": Kind("all", "parent", "part model [was]", "a model joins the tree; `was` is its path before, if it was a run of its own"),
    "removed": Kind("all", "parent", "part model", "a model leaves the tree"),
    "state": Kind("all", "any part", "...", "new values of attributes; `size` is the number of chunks in a memory"),
    "productions": Kind(
        "all",
        "system",
        "productions initializers chosen matched drawn [utilities parts threshold]",
        "the contents of a production system: its productions, the methods without parameters, the chosen production, those that "
        "matched last, the modules that draw noise, and the current choice (as in «conflict»)",
    ),
    "initialize": Kind("all", "system", "method", "a method without parameters runs, before the first cycle"),
    "observe": Kind("all", "system", "...", "new values of what else productions see (`name.slot`); None if missing"),
    "conflict": Kind(
        "all",
        "system",
        "utilities [parts drawn threshold]",
        "the productions that match, their utilities and the parts of these, the modules that drew noise, and the utility threshold",
    ),
    "utility": Kind("all", "system", "production part value", "the new value of a part of a production's utility, after learning"),
    "request": Kind(
        "all",
        "module",
        "...",
        "a request to a module (`call`). For a memory, with all candidates; if it was made before the trace, also `made` [s] and "
        "`outcome`. `outside_vision`: the agent asks for the raw view",
    ),
    "retrieval": Kind("all", "memory", "failed [chunk]", "a retrieved chunk arrives, or the retrieval fails"),
    "answer": Kind("all", "port, vision, motor", "word value", "a body answers a request"),
    "search": Kind(
        "all",
        "vision",
        "asked bottom_up noticed refused chosen [why]",
        "a view is searched: the features that match, with their saliences; those that do not, with the reason; and the chosen one. "
        "`why`: the reason if features were noticed but none was chosen",
    ),
    "sight": Kind(
        "all",
        "vision",
        "bottom_up failed [chunk held]",
        "a found feature is put into the buffer, or the search fails; `held`: the buffer keeps its chunk",
    ),
    "move": Kind(
        "all", "motor", "movement group speed [to]", "a movement of a muscle group begins; speed and target are in radians or metres"
    ),
    "moved": Kind("all", "motor", "movement group end", "a movement ends: «done», «stopped», «limit» or «blocked»"),
    "refused": Kind("all", "motor", "movement why", "a movement is refused: the muscle group is «busy», or its «limit» is nearer"),
    "add": Kind("all", "memory", "chunk merged size given", "a chunk is added to a memory, or strengthens the equal one there (`merged`)"),
    "chunks": Kind("all", "memory", "by size gone new", "a memory's chunks change in another way: the method, and the chunks"),
}
"""All kinds of events."""
