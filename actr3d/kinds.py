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
    "start": Kind("production", "top model", "model seed profile", "a run begins to be traced: its model's class, seed and numbers"),
    "command": Kind("production", "top model", "command data", "a user changes the run"),
    "select": Kind("production", "system", "production", "a production is chosen"),
    "fire": Kind("production", "system", "production bound", "a production fires, with what it bound"),
    "changed": Kind("production", "system", "production", "a chosen production matches no longer and does not fire"),
    "compile": Kind("production", "system", "production parents", "a production is learned from two others"),
    "reward": Kind("production", "system", "value", "an agent gets a reward"),
    "output": Kind("production", "model", "text", "a mind prints a line; or a program, to a recording and with `--json`"),
    "result": Kind("production", "top model", "...", "a run is over that something was measured of: what was measured"),
    "planning_unit": Kind(
        "production",
        "SGOMS buffer",
        "name what path [by]",
        "a planning unit is «begun», «ended», «interrupted» (by which), «resumed», «cut» (given up) or, where a trace begins, «going on»",
    ),
    "unit_task": Kind("production", "SGOMS buffer", "name what path", "likewise a unit task"),
    "method": Kind("production", "SGOMS buffer", "name what path", "likewise a method"),
    "operator": Kind("production", "SGOMS buffer", "name what path", "likewise an operator"),
    "buffer": Kind(
        "buffer",
        "buffer",
        "chunk [texts]",
        "a buffer holds this chunk now (its slots), or none; `texts` is what patterns compare lists by",
    ),
    "run": Kind("all", "top model", "limit", "a run begins, for this time [s]; None without a limit"),
    "stop": Kind(
        "all", "top model", "by [error]", "that ends: «limit», «until», «stop», «done» (nothing is left to do) or «error», with its class"
    ),
    "added": Kind("all", "parent", "part model [was]", "a model joins the tree; `was` says which run it was before"),
    "removed": Kind("all", "parent", "part model", "a model leaves the tree"),
    "state": Kind("all", "any part", "...", "attributes have these values; `size` counts the chunks of a memory"),
    "productions": Kind(
        "all",
        "system",
        "productions initializers chosen matched drawn [utilities parts threshold]",
        "what a production system has: its productions, methods without parameters, the production about to fire, those that matched "
        "last, the modules that draw noise; as «conflict» has it, the choice that stands",
    ),
    "initialize": Kind("all", "system", "method", "a method without parameters is carried out, before the first cycle"),
    "observe": Kind("all", "system", "...", "what productions see beyond that (`name.slot`) has these values; none where it is missing"),
    "conflict": Kind(
        "all",
        "system",
        "utilities [parts drawn threshold]",
        "which productions match, their utilities, the parts of these, the modules that drew noise, the least utility that may fire",
    ),
    "utility": Kind("all", "system", "production part value", "a part of a production's utility has become this by learning"),
    "request": Kind(
        "all",
        "module",
        "...",
        "a module is asked for something (`call`); a memory's request with all candidates, and if it was made before the trace, `made` "
        "[s] and its `outcome`; `outside_vision` where an agent asks for the raw view",
    ),
    "retrieval": Kind("all", "memory", "failed [chunk]", "a memory's answer arrives, or its failure"),
    "answer": Kind("all", "port, vision, motor", "word value", "a body answers what it was asked for"),
    "search": Kind(
        "all",
        "vision",
        "asked bottom_up noticed refused chosen [why]",
        "a view arrives: the features that are as was asked for, with their saliences, those that are not and why, and which one is "
        "brought; `why` says why none is, though some are noticed",
    ),
    "sight": Kind(
        "all", "vision", "bottom_up failed [chunk held]", "what was found comes to the buffer, or nothing; `held` if the buffer is kept"
    ),
    "move": Kind(
        "all", "motor", "movement group speed [to]", "a movement of a muscle group begins; how fast and where to are in radians or metres"
    ),
    "moved": Kind("all", "motor", "movement group end", "that ends: «done», «stopped», «limit» or «blocked»"),
    "refused": Kind("all", "motor", "movement why", "a movement is not made: the muscle group is «busy», or its «limit» is nearer"),
    "add": Kind("all", "memory", "chunk merged size given", "a memory takes in a chunk, or strengthens (merges with) the equal one it has"),
    "chunks": Kind("all", "memory", "by size gone new", "a memory's chunks are changed otherwise: by which method, and which ones"),
}
"""All kinds of events."""
