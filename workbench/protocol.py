"""Defines what a page or a program may send to the workbench: one frozen type for each command or question, with its bounds.

The websocket, the REST interface with its OpenAPI description, and the worker in which a model runs share these types.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import AfterValidator, BaseModel, ConfigDict, Field, TypeAdapter

from workbench.overlays import OVERLAYS

Name = Annotated[str, Field(min_length=1, max_length=200)]
Text = Annotated[str, Field(max_length=1_000_000)]
Seconds = Annotated[float, Field(ge=0, lt=1e9, allow_inf_nan=False)]
Plain = bool | int | float | Annotated[str, Field(max_length=10_000)] | None
"""A value that can be recorded."""


def _overlay(name: str) -> str:
    if name not in OVERLAYS:
        raise ValueError(f"there is no overlay of this name; there are: {', '.join(OVERLAYS)}")
    return name


OverlayName = Annotated[Name, AfterValidator(_overlay), Field(json_schema_extra={"enum": [*OVERLAYS]})]
"""What can be drawn over the 3D view: the name of one of `OVERLAYS`."""


class Said(BaseModel):
    """Base of all commands and questions."""

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=False)


# -- commands to a run


class Run(Said):
    """Continues the run."""

    type: Literal["run"] = "run"


class Pause(Said):
    """Pauses the run at the end of the current tick."""

    type: Literal["pause"] = "pause"


class Step(Said):
    """Runs a number of ticks."""

    type: Literal["step"] = "step"
    ticks: int = Field(default=1, ge=1, le=100_000)


class Cycle(Said):
    """Runs until the next production fires; of one production system if `system` is given."""

    type: Literal["cycle"] = "cycle"
    system: Name | None = None


class Back(Said):
    """Goes back by a number of ticks."""

    type: Literal["back"] = "back"
    ticks: int = Field(default=1, ge=1, le=100_000)


class Seek(Said):
    """Goes to an earlier time of the run [s]; running on from there repeats what was recorded."""

    type: Literal["seek"] = "seek"
    time: Seconds


class Until(Said):
    """Runs until one of the given conditions is true."""

    type: Literal["until"] = "until"
    time: Seconds | None = None
    """This time is reached [s]."""
    production: Name | None = None
    """A production of this name fires."""
    buffer: Name | None = None
    """The buffer at this path matches `pattern`."""
    pattern: Annotated[str, Field(max_length=2000)] | None = None
    contact: Annotated[str, Field(max_length=200)] | None = None
    """This body touches something other than the ground; an empty text means any body."""


class Breakpoints(Said):
    """Sets the productions after which the run pauses whenever they fire."""

    type: Literal["breakpoints"] = "breakpoints"
    productions: tuple[Name, ...] = Field(default=(), max_length=200)


class Speed(Said):
    """Sets the maximum speed of the run as a multiple of real time; None for as fast as possible."""

    type: Literal["speed"] = "speed"
    factor: float | None = Field(default=None, ge=0.05, le=10_000)


class Change(Said):
    """Base of the commands that change the run itself.

    If the run has gone back, it continues differently from here. The part that lies ahead is kept as a recording of its own, a
    branch. If the run is not recorded, the change is refused unless `drop` is true.
    """

    drop: bool = False
    """Whether the part that lies ahead may be lost if it cannot be kept."""


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
    """Sends any command to the world, the agents or a body, as `Simulation.command` does."""

    type: Literal["say"] = "say"
    word: Name
    values: tuple[Plain, ...] = Field(default=(), max_length=100)
    named: dict[Name, Plain] = Field(default_factory=dict, max_length=100)
    body: Name | None = None


# -- commands to a session


class Restart(Said):
    """Starts the model again, optionally with other parameters or a new seed."""

    type: Literal["restart"] = "restart"
    settings: dict[Name, Plain] | None = Field(default=None, max_length=200)
    """Values of parameters that differ from the model's defaults; None for those of the current run."""
    seed: int | None = Field(default=None, ge=0, lt=2**63)
    new_seed: bool = False
    record: bool = True
    run: bool = False
    """Whether the run starts at once; otherwise it is paused at its start."""


class Overlay(Said):
    """Shows or hides an overlay of the 3D view, for all who watch the session."""

    type: Literal["overlay"] = "overlay"
    name: OverlayName
    shown: bool


class Stop(Said):
    """Ends the worker process of the run, whatever it is doing."""

    type: Literal["stop"] = "stop"


# -- questions about a run


class Explain(Said):
    """Explains productions and retrievals of all agents or of one, now or at a past time."""

    type: Literal["explain"] = "explain"
    at: Seconds | None = None
    agent: Name | None = None
    production: Name | None = None


class Rows(Said):
    """Returns the chunks of a memory with their current activations."""

    type: Literal["memory"] = "memory"
    memory: Name
    words: Annotated[str, Field(max_length=200)] = ""
    most: int = Field(default=200, ge=1, le=5000)


class Look(Said):
    """Returns what a body's eye sees now, row by row."""

    type: Literal["view"] = "view"
    body: Name | None = None


class Body(Said):
    """Returns the current state of a body: joints with their limits, contacts, bounding box, position."""

    type: Literal["body"] = "body"
    body: Name | None = None


class Events(Said):
    """Returns events of the run from a number on."""

    type: Literal["events"] = "events"
    first: int = Field(default=0, ge=0)
    most: int = Field(default=5000, ge=1, le=20_000)
    kinds: tuple[Name, ...] | None = Field(default=None, max_length=50)


class Curves(Said):
    """Returns curves of the run over time, up to the furthest time that it has reached, for plots.

    The answer is `{names: [{name, unit, group}], times: [s], curves: {name: [value or null]}}`. `names` lists all curves, with
    angles in degrees; `curves` holds the requested ones, with one value for each time, or null if there is no value (for example the
    clearance of a body that is not in the doorway). Groups are `place`, `speed`, `clearance`, `contact`, `joint` and `joint speed`. All
    values are those at the ends of ticks, including the contact force. After going back, a run still returns what lies ahead, until it
    continues differently. `/api/recordings/{recording}/curves` returns the same for a recording.
    """

    type: Literal["curves"] = "curves"
    names: tuple[Name, ...] | None = Field(default=None, max_length=500)
    """The names of the curves; None for all."""
    first: Seconds = 0.0
    """Start of the interval [s]: a page need not ask again for what it has."""
    last: Seconds | None = None
    """End of the interval, included [s]; None for the furthest time of the run."""
    most: int = Field(default=1_000, ge=2, le=5_000)
    """Maximum number of times, evenly spaced; the last moment of the interval is included. A shorter interval is returned completely."""


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
"""Commands that change only the view and not the run."""
QUESTIONS = (Explain, Rows, Look, Body, Events, Curves)
"""The questions, which change nothing."""
ANYTHING: TypeAdapter[Any] = TypeAdapter(Anything)
"""Parses a command or question."""


class Attach(Said):
    """The first message of a page on its websocket: the session to show, and what the page already knows of it."""

    type: Literal["attach"] = "attach"
    session: Name
    run: int = Field(default=0, ge=0)
    """The number of the run whose events the page knows."""
    epoch: int = Field(default=0, ge=0)
    events: int = Field(default=0, ge=0)
    """How many events it knows."""


class Request(Said):
    """Any later message of a page: a command or question with a number, which the reply repeats."""

    id: int = Field(ge=0, lt=2**53)
    say: Anything


def problem_of(error: Mapping[str, Any]) -> str:
    """Returns a text that says where a message is invalid and why; it never quotes the message, which JSON may not be able to hold.

    Args:
        error: An error from pydantic's `ValidationError.errors`.
    """
    place = ".".join(str(part)[:100] for part in error["loc"])
    words = str(error["msg"])
    if error["type"] == "union_tag_invalid":  # pydantic's own text for this error quotes the message
        words = f"{error['ctx']['discriminator']} must be one of {error['ctx']['expected_tags']}"
    return f"{place}: {words}" if place else words
