"""The kinds of events that a trace records: the lowest level, the source, the data and the meaning of each; the registry of kinds."""

from __future__ import annotations

import sys
from typing import NamedTuple

from actr3d.registry import Registry

LEVELS = ("none", "production", "buffer", "all")
"""The levels of a trace: nothing; selections and firings; also buffer changes; everything."""


class KindGroup(NamedTuple):
    """A group of kinds, by which pages filter events."""

    title: str
    shown: bool = False
    """Whether pages show it at first."""


GROUPS = {
    "fire": KindGroup("Firings", shown=True),
    "output": KindGroup("Prints", shown=True),
    "reward": KindGroup("Rewards", shown=True),
    "compile": KindGroup("Compiled productions", shown=True),
    "command": KindGroup("User's commands", shown=True),
    "result": KindGroup("Results", shown=True),
    "plan": KindGroup("Plans (SGOMS)", shown=True),
    "choice": KindGroup("Choices"),
    "buffer": KindGroup("Buffers"),
    "memory": KindGroup("Memory"),
    "request": KindGroup("Requests and answers"),
    "vision": KindGroup("Vision"),
    "motor": KindGroup("Movements"),
    "learning": KindGroup("Learned utilities"),
    "state": KindGroup("Attributes"),
    "run": KindGroup("Beginnings and ends"),
    "other": KindGroup("Other events", shown=True),
}
"""The groups, in the order in which pages list them."""


class Kind(NamedTuple):
    """A kind of event."""

    level: str
    """The lowest level at which it is recorded."""
    rank: int
    """The place of that level among `LEVELS`."""
    source: str
    """The part that emits it."""
    data: str
    """The names of its data; optional ones are in brackets, «...» means names that depend on the source."""
    meaning: str
    group: str
    """The group by which pages filter it: one of `GROUPS`."""
    title: str
    """What pages write before its text."""
    text: str
    """Its text on pages, with data in braces (`{production}`); empty for all data as `name=value`."""


KINDS: Registry[Kind] = Registry("kind of trace event")
"""All kinds of events by name."""


def rank_of(kind: str) -> int:
    """Returns the place among `LEVELS` of the lowest level at which a kind is recorded; a kind that is not registered has «all»."""
    return KINDS[kind].rank if kind in KINDS else len(LEVELS) - 1


def trace_kind(
    name: str, *, level: str = "all", source: str, data: str, meaning: str, group: str = "other", title: str = "", text: str = ""
) -> None:
    """Registers a kind of event; see the fields of `Kind`. Parts emit it with `Model.emit`.

    Args:
        name: The name of the kind.
        level: The lowest level at which it is recorded.
        source: The part that emits it.
        data: The names of its data.
        meaning: What it means, for the manual.
        group: The group by which pages filter it.
        title: What pages write before its text; the name unless given.
        text: Its text on pages.

    Raises:
        ValueError: If there is such a kind already, or no such level or group.
    """
    for what, value, known in (("level", level, LEVELS[1:]), ("group", group, GROUPS)):
        if value not in known:
            raise ValueError(f"trace kind '{name}': {what} must be one of {', '.join(known)} (got {value!r})")
    module: str = sys._getframe(1).f_globals["__name__"]  # pyright: ignore[reportPrivateUsage] # Python documents it
    KINDS.add(name, Kind(level, LEVELS.index(level), source, data, meaning, group, title or name, text), module)


trace_kind(
    "start",
    level="production",
    source="top model",
    data="model seed profile",
    meaning="the trace of a run begins: the model's class, its seed and profile",
    group="run",
)
trace_kind("command", level="production", source="top model", data="command data [by]", meaning="a user changes the run", group="command")
trace_kind(
    "select",
    level="production",
    source="system",
    data="production",
    meaning="a production is chosen",
    group="choice",
    title="chosen",
    text="{production}",
)
trace_kind(
    "fire",
    level="production",
    source="system",
    data="production bound",
    meaning="a production fires, with the variables that it bound",
    group="fire",
    title="fires",
    text="{production}",
)
trace_kind(
    "changed",
    level="production",
    source="system",
    data="production",
    meaning="a chosen production no longer matches, and does not fire",
    group="fire",
    title="no longer",
    text="{production} was chosen, but no longer matches",
)
trace_kind(
    "withdrawn",
    level="production",
    source="system",
    data="production",
    meaning="a chosen production does not fire, because a user has forbidden it or has another one fire",
    group="fire",
    title="withdrawn",
    text="{production}: by the user",
)
trace_kind(
    "compile",
    level="production",
    source="system",
    data="production parents",
    meaning="a production is learned from two others",
    group="compile",
)
trace_kind(
    "reward",
    level="production",
    source="system",
    data="value",
    meaning="an agent receives a reward",
    group="reward",
    title="reward",
    text="{value}",
)
trace_kind(
    "output",
    level="production",
    source="model",
    data="text",
    meaning="an agent prints a line; also a program, in recordings and with `--json`",
    group="output",
    title="prints",
    text="{text}",
)
trace_kind("result", level="production", source="top model", data="...", meaning="a run with a measure is over: its result", group="result")
trace_kind(
    "planning_unit",
    level="production",
    source="SGOMS buffer",
    data="name what path [by]",
    meaning="a planning unit is «begun», «ended», «interrupted» (by another), «resumed», «cut» (abandoned), or «going on» "
    "as a trace begins",
    group="plan",
    title="plan",
    text="{name} {what}",
)
for _level in ("unit_task", "method", "operator"):
    trace_kind(
        _level,
        level="production",
        source="SGOMS buffer",
        data="name what path",
        meaning=f"the same for {'an' if _level == 'operator' else 'a'} {_level.replace('_', ' ')}",
        group="plan",
        title=_level.replace("_", " "),
        text="{name} {what}",
    )
trace_kind(
    "buffer",
    level="buffer",
    source="buffer",
    data="chunk [texts]",
    meaning="the new chunk in a buffer (its slots), or none; `texts`: the text that patterns compare, for values such as lists",
    group="buffer",
)
trace_kind("run", source="top model", data="limit", meaning="a run begins, for this time [s]; None without a limit", group="run")
trace_kind(
    "stop",
    source="top model",
    data="by [error]",
    meaning="a run ends: «limit», «until», «stop», «done» (nothing is left to do) or «error», with its class",
    group="run",
)
trace_kind(
    "added",
    source="parent",
    data="part model [was]",
    meaning="a model joins the tree; `was` is its path before, if it was a run of its own",
    group="run",
)
trace_kind("removed", source="parent", data="part model", meaning="a model leaves the tree", group="run")
trace_kind(
    "state",
    source="any part",
    data="...",
    meaning="new values of attributes; `size` is the number of chunks in a memory",
    group="state",
)
trace_kind(
    "productions",
    source="system",
    data="productions initializers chosen matched drawn [utilities parts threshold]",
    meaning="the contents of a production system: its productions, the methods without parameters, the chosen production, "
    "those that matched last, the modules that draw noise, and the current choice (as in «conflict»)",
    group="run",
)
trace_kind(
    "initialize",
    source="system",
    data="method",
    meaning="a method without parameters runs, before the first cycle",
    group="run",
)
trace_kind(
    "observe",
    source="system",
    data="...",
    meaning="new values of what else productions see (`name.slot`); None if missing",
    group="state",
)
trace_kind(
    "conflict",
    source="system",
    data="utilities [parts drawn threshold forbidden wanted]",
    meaning="the productions that match, their utilities and the parts of these, the modules that drew noise, the utility threshold; "
    "the productions that a user had forbidden, and the one that the user made fire next",
    group="choice",
)
trace_kind(
    "utility",
    source="system",
    data="production part value",
    meaning="the new value of a part of a production's utility, after learning",
    group="learning",
    title="utility",
    text="{production} {part} {value}",
)
trace_kind(
    "request",
    source="module",
    data="...",
    meaning="a request to a module (`call`). For a memory, with all candidates; if it was made before the trace, also "
    "`made` [s] and `outcome`. `outside_vision`: the agent asks for the raw view or a picture of it",
    group="request",
)
trace_kind(
    "retrieval",
    source="memory",
    data="failed [chunk]",
    meaning="a retrieved chunk arrives, or the retrieval fails",
    group="memory",
)
trace_kind(
    "answer",
    source="port, vision, motor",
    data="word value",
    meaning="a body answers a request",
    group="request",
    title="answer",
    text="{word}: {value}",
)
trace_kind(
    "search",
    source="vision",
    data="asked bottom_up noticed refused chosen [why]",
    meaning="a view is searched: the features that match, with their saliences; those that do not, with the reason; and the "
    "chosen one. `why`: the reason if features were noticed but none was chosen",
    group="vision",
)
trace_kind(
    "sight",
    source="vision",
    data="bottom_up failed [chunk held]",
    meaning="a found feature is put into the buffer, or the search fails; `held`: the buffer keeps its chunk",
    group="vision",
)
trace_kind(
    "move",
    source="motor",
    data="movement group speed [to]",
    meaning="a movement of a muscle group begins; speed and target are in radians or metres",
    group="motor",
    title="moves",
    text="{movement} ({group})",
)
trace_kind(
    "moved",
    source="motor",
    data="movement group end",
    meaning="a movement ends: «done», «stopped», «limit» or «blocked»",
    group="motor",
    title="moved",
    text="{movement} ({group}): {end}",
)
trace_kind(
    "refused",
    source="motor",
    data="movement why",
    meaning="a movement is refused: the muscle group is «busy», or its «limit» is nearer",
    group="motor",
    title="refused",
    text="{movement}: {why}",
)
trace_kind(
    "add",
    source="memory",
    data="chunk merged size given",
    meaning="a chunk is added to a memory, or strengthens the equal one there (`merged`)",
    group="memory",
)
trace_kind(
    "chunks",
    source="memory",
    data="by size gone new",
    meaning="a memory's chunks change in another way: the method, and the chunks",
    group="memory",
)
