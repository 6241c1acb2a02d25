"""What a page, or a program, may say to the workbench: frozen types, one a command or question, each with its bounds.

The same types serve the websocket, the REST interface and its OpenAPI description, and the worker in which a model runs.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import BaseModel, ConfigDict, Field, TypeAdapter

Name = Annotated[str, Field(min_length=1, max_length=200)]
Text = Annotated[str, Field(max_length=1_000_000)]
Seconds = Annotated[float, Field(ge=0, lt=1e9, allow_inf_nan=False)]
Plain = bool | int | float | Annotated[str, Field(max_length=10_000)] | None
"""A value that can be recorded."""

OverlayName = Literal["frustum", "edges", "features", "path", "posture", "contacts"]
"""What can be drawn over the 3D view: what the eye can see, the edges that it sees, what vision has found last with its width, the
path walked, the posture that the body is commanded to, where it touches something."""
"""From where the 3D view is seen: from where each user likes, with the body, through its eye, from above."""


class Said(BaseModel):
    """The base of all that is said."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


# -- commands to a run


class Run(Said):
    """Lets the run go on."""

    type: Literal["run"] = "run"


class Pause(Said):
    """Holds the run at the end of the present tick."""

    type: Literal["pause"] = "pause"


class Step(Said):
    """Goes on by some ticks."""

    type: Literal["step"] = "step"
    ticks: int = Field(default=1, ge=1, le=100_000)


class Cycle(Said):
    """Goes on until the next production fires: of one system where it is named, else of any."""

    type: Literal["cycle"] = "cycle"
    system: Name | None = None


class Back(Said):
    """Goes back by some ticks."""

    type: Literal["back"] = "back"
    ticks: int = Field(default=1, ge=1, le=100_000)


class Seek(Said):
    """Goes to a time that the run has been at [s]; going on from there gives what was."""

    type: Literal["seek"] = "seek"
    time: Seconds


class Until(Said):
    """Goes on until one of what is named comes true."""

    type: Literal["until"] = "until"
    time: Seconds | None = None
    """[s]"""
    production: Name | None = None
    """One of this name fires."""
    buffer: Name | None = None
    """The buffer at this path matches `pattern`."""
    pattern: Annotated[str, Field(max_length=2000)] | None = None
    contact: Annotated[str, Field(max_length=200)] | None = None
    """This body touches something other than the ground; an empty text for any body."""


class Breakpoints(Said):
    """Names the productions after which the run pauses whenever they fire."""

    type: Literal["breakpoints"] = "breakpoints"
    productions: tuple[Name, ...] = Field(default=(), max_length=200)


class Speed(Said):
    """Sets how many times as fast as real time the run goes at most; None for as fast as possible."""

    type: Literal["speed"] = "speed"
    factor: float | None = Field(default=None, ge=0.05, le=10_000)


class Change(Said):
    """The base of what changes the run itself.

    Where the run has gone back, it goes another way from here. What lies ahead is kept as a recording of its own, a branch; where the
    run is not recorded, the change is refused unless `drop` allows to lose it.
    """

    drop: bool = False
    """Whether what lies ahead may be lost where it cannot be kept."""


class Aperture(Change):
    """Sets the free width of an aperture [m]."""

    type: Literal["aperture"] = "aperture"
    width: float = Field(ge=0, le=100)
    name: Name = "aperture"


class Set(Change):
    """Changes a live parameter of the model in the running simulation."""

    type: Literal["set"] = "set"
    name: Name
    value: Plain


class Say(Change):
    """Says any word to the world, the minds or a body, as `Simulation.command` takes it."""

    type: Literal["say"] = "say"
    word: Name
    values: tuple[Plain, ...] = Field(default=(), max_length=100)
    named: dict[Name, Plain] = Field(default_factory=dict, max_length=100)
    body: Name | None = None


# -- commands to a session


class Restart(Said):
    """Begins again: with other parameters, where some are given; with a new seed, or the same."""

    type: Literal["restart"] = "restart"
    settings: dict[Name, Plain] | None = Field(default=None, max_length=200)
    """Values of parameters that are not the model's defaults; None for those of the present run."""
    seed: int | None = Field(default=None, ge=0, lt=2**63)
    new_seed: bool = False
    record: bool = True
    run: bool = False
    """Whether it runs at once; otherwise it waits at its start."""


class Overlay(Said):
    """Shows or hides something over the 3D view, for all who watch the session."""

    type: Literal["overlay"] = "overlay"
    name: OverlayName
    shown: bool


class Stop(Said):
    """Ends the worker in which the run is, whatever it does."""

    type: Literal["stop"] = "stop"


# -- questions about a run


class Explain(Said):
    """Why: every production and retrieval of the agents, or of one; now, or at a past time."""

    type: Literal["explain"] = "explain"
    at: Seconds | None = None
    agent: Name | None = None
    production: Name | None = None


class Rows(Said):
    """The chunks of a memory with their activations now."""

    type: Literal["memory"] = "memory"
    memory: Name
    words: Annotated[str, Field(max_length=200)] = ""
    most: int = Field(default=200, ge=1, le=5000)


class Look(Said):
    """What a body's eye sees now, row by row."""

    type: Literal["view"] = "view"
    body: Name | None = None


class Body(Said):
    """What a body is like now: joints with their limits, contacts, bounding box, place."""

    type: Literal["body"] = "body"
    body: Name | None = None


class Events(Said):
    """Events of the run, from a number on."""

    type: Literal["events"] = "events"
    first: int = Field(default=0, ge=0)
    most: int = Field(default=5000, ge=1, le=20_000)
    kinds: tuple[Name, ...] | None = Field(default=None, max_length=50)


class Curves(Said):
    """How the run went up to the furthest that it has come, as curves over time, for plots.

    Answered by `{names: [{name, unit, group}], times: [s], curves: {name: [value or null]}}`: `names` are all that there are, in
    degrees where something turns; `curves` those that are asked for, one value for each time, null where there is none, as of the
    clearance of who is not in the doorway. Groups are `place`, `speed`, `clearance`, `contact`, `joint` and `joint speed`. All
    values are of the ends of ticks: the contact force of that moment. A run that has gone back still tells what lies ahead, until
    it goes another way. The same comes from `/api/recordings/{recording}/curves`.
    """

    type: Literal["curves"] = "curves"
    names: tuple[Name, ...] | None = Field(default=None, max_length=500)
    """Which; None for all."""
    first: Seconds = 0.0
    """From when on [s]: what a page knows already it need not ask for again."""
    last: Seconds | None = None
    """Until when, this moment included [s]; None for as far as the run has come."""
    most: int = Field(default=1_000, ge=2, le=5_000)
    """How many times at most, evenly spread; the last one of the stretch is among them. All of a stretch that has fewer."""


Command = Annotated[
    Run | Pause | Step | Cycle | Back | Seek | Until | Breakpoints | Speed | Aperture | Set | Say | Overlay | Restart | Stop,
    Field(discriminator="type"),
]
Question = Annotated[Explain | Rows | Look | Body | Events | Curves, Field(discriminator="type")]
Anything = Annotated[
    Run
    | Pause
    | Step
    | Cycle
    | Back
    | Seek
    | Until
    | Breakpoints
    | Speed
    | Aperture
    | Set
    | Say
    | Overlay
    | Restart
    | Stop
    | Explain
    | Rows
    | Look
    | Body
    | Events
    | Curves,
    Field(discriminator="type"),
]

LOOKS = (Overlay,)
"""What changes the view only, and nothing of the run."""
QUESTIONS = (Explain, Rows, Look, Body, Events, Curves)
"""What only asks."""
ANYTHING: TypeAdapter[Any] = TypeAdapter(Anything)
"""Reads a command or question."""


class Attach(Said):
    """The first thing that a page says on its websocket: which session it shows, and what it knows of it already."""

    type: Literal["attach"] = "attach"
    session: Name
    run: int = Field(default=0, ge=0)
    """The number of the run of which it knows events."""
    epoch: int = Field(default=0, ge=0)
    events: int = Field(default=0, ge=0)
    """How many it knows."""


class Request(Said):
    """What a page says after that: a command or question with a number, which the reply names."""

    id: int = Field(ge=0, lt=2**53)
    say: Anything


def problem_of(error: Mapping[str, Any]) -> str:
    """Returns in words where something that was said is wrong, and why; never what was said, which may be nothing that JSON has.

    Args:
        error: One of those that pydantic's `ValidationError.errors` returns.
    """
    place = ".".join(str(part)[:100] for part in error["loc"])
    words = str(error["msg"])
    if error["type"] == "union_tag_invalid":  # whose words have what was said among them
        words = f"{error['ctx']['discriminator']} must be one of {error['ctx']['expected_tags']}"
    return f"{place}: {words}" if place else words
