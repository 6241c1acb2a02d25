"""Defines the messages between server and worker: frozen types in MessagePack, each preceded by its length."""

from __future__ import annotations

import hashlib
from typing import Any, Literal

import msgspec

from actr3d.values import escape_surrogates

Status = Literal["loading", "paused", "running", "ended", "failed"]
ENDED = ("ended", "failed")
"""The statuses of a run that is over."""


class Message(msgspec.Struct, frozen=True, kw_only=True, tag=str.lower, tag_field="type"):
    """Base of all messages."""


def shortened(text: str, most: int = 10_000) -> str:
    """Returns a text that can be sent: unpaired surrogates are escaped, and the middle of a long text is removed."""
    kept = str.__str__(text)  # without code of a model's own kind of text
    if len(kept) > most:
        kept = f"{kept[: most // 2]}\n… ({len(kept) - most:,} more characters) …\n{kept[-(most // 2) :]}"
    return escape_surrogates(kept)


def text_digest(text: str) -> str:
    """Returns a hash that identifies a text."""
    return hashlib.sha256(text.encode("utf-8", "surrogatepass")).hexdigest()


# -- to the worker


class Start(Message, frozen=True, kw_only=True):
    """Starts a job; the first message to a worker."""

    job: Literal["run", "check", "replay", "make", "list", "language"] = "run"
    """`check` loads the model and builds what it describes, and runs no more than one tick; `replay` runs a recording again and
    compares; `make` makes a file from recordings; `list` reads summaries of recordings; `language` answers questions about texts.
    """
    path: str = ""
    """The model file, or the recording to replay."""
    source: str = ""
    folder: str = ""
    recordings: tuple[str, ...] = ()
    """The recordings to read."""
    export: str = ""
    """The kind of file to make: one of `workbench.exports`."""
    to: str = ""
    """The path of the file to make."""
    settings: dict[str, Any] = {}
    seed: int | str | None = None
    record: str | None = None
    commands: list[tuple[int, int, dict[str, Any]]] = []
    """The commands of users in an earlier run, to be applied again: the run, the tick (of a program: the time [us]) after
    which each was given, and its data (`Command.to_data`)."""
    recorded: str | None = None
    """The recording of the earlier run that is repeated; None for a new run."""
    helpers: dict[str, tuple[str, str]] = {}
    """The file and text of each helper module of an earlier run, by name; other modules are read from the folder."""
    factor: float | None = None
    real_time: bool = False
    """Whether a run with a body goes in real time regardless of `factor`, as no speed has been chosen yet."""
    breakpoints: tuple[str, ...] = ()
    run: bool = False
    attempt: int = 0
    """The number of this attempt to start a run in its session, from 1."""
    version: str = ""
    """Identifies the model's text; see `ModelFile.version`."""


class CommandMessage(Message, frozen=True, kw_only=True):
    """A command or question from a page."""

    id: int
    command: bytes
    """A pickled `workbench.page_commands.PageCommand`, which the server has validated; for the job `language`, a question as JSON."""


class Leave(Message, frozen=True, kw_only=True):
    """Asks the worker to end normally."""


class SetOverlays(Message, frozen=True, kw_only=True):
    """Sets the kinds of overlays whose data each state contains from now on; see `workbench.overlays`."""

    kinds: tuple[str, ...]


class AskPosition(Message, frozen=True, kw_only=True):
    """Asks which line of the model the worker is at."""


# -- from the worker


class Facts(Message, frozen=True, kw_only=True):
    """The facts of a run once it is built; a program sends them again whenever another of its simulations is shown."""

    kind: Literal["simulation", "program"]
    seed: int | str
    period: float
    """Length of a tick [s]."""
    parameters: bytes
    """JSON: the values of parameters by name."""
    world: bytes
    """JSON: bodies, apertures and objects; null without a world."""
    initial_widths: bytes = b"[]"
    """JSON: the widths of apertures at the start of the simulations of the run [m], each as [number, widths by name]. The number is that
    of the simulation among all runs of a program; simulations that begin with the widths of the one before are left out."""
    changes: bytes = b"[]"
    """JSON: the changes that a user can make by hand; see `worker.change_menu`."""
    live: bytes = b"[]"
    """JSON: the parameters that can be changed during the run: name, unit, and the command that changes it (`Live`)."""
    mj_model: bytes | None
    """The compiled scene in MuJoCo's binary format; None without a world."""


class State(Message, frozen=True, kw_only=True):
    """The state of the run at a moment; a newer state replaces it."""

    status: Status
    reason: str
    """Why the run is paused, has ended or failed."""
    breakpoint: str | None = None
    """The production at whose breakpoint the run is paused; None if it is not paused at one."""
    tick: int
    time: float
    """Time of the run [s]."""
    furthest: float
    """The furthest time that the run has reached [s]."""
    target: float | None = None
    """The time of the seek that is in progress [s]; None if there is none."""
    wanted: float | None
    measured: float | None
    """Measured speed as a multiple of real time; None if the run is not going on."""
    events: int
    """Number of events up to this moment."""
    parts: bytes
    """JSON: see `actr3d.actr.explain.snapshot`."""
    apertures: dict[str, float]
    """Free widths of apertures by name [m]."""
    result: bytes
    """JSON: the measured result of a run that has ended; null if there is none, or the run has not ended."""
    physics: bytes | None
    """MuJoCo's `mjSTATE_INTEGRATION`; None without a world."""
    parameters: bytes = b"{}"
    """JSON: the values of parameters that users have changed during the run, up to this moment, by name."""
    overlay_data: dict[str, Any] = {}
    """The data of overlays by kind, as requested by a `SetOverlays`."""


class NewEvents(Message, frozen=True, kw_only=True):
    """New events, in order."""

    first: int
    """The number of the first event, counted from 0; there is a gap to the previous message if some events were left out."""
    events: list[bytes]
    """JSON of each event: time [us], source, kind, data."""


class EventsRemoved(Message, frozen=True, kw_only=True):
    """The run continues differently: the events from a number on no longer exist."""

    events: int


class Branched(Message, frozen=True, kw_only=True):
    """The run continues differently from a moment on; its previous continuation is kept as a separate recording."""

    recording: str
    """The name of that recording."""
    at: float
    """The moment from which the run continues differently, or goes further [s]."""
    until: float
    """The furthest time that the run had reached [s]."""


class Unrecorded(Message, frozen=True, kw_only=True):
    """The run goes on without being recorded."""


class Loaded(Message, frozen=True, kw_only=True):
    """The model has loaded a helper module."""

    file: str
    """The path of the module."""
    digest: str
    """Identifies its text; see `text_digest`."""


class Share(Message, frozen=True, kw_only=True):
    """The finished share of a job, from 0 to 1."""

    done: float


MAX_PRINTED = 200
"""How many lines that a worker prints other than by its model's `print` are shown; the rest is dropped."""


class Notice(Message, frozen=True, kw_only=True):
    """A message to the user."""

    level: Literal["info", "warning", "error"]
    text: str
    file: str | None = None
    line: int | None = None
    detail: str = ""
    events: int | None = None
    """Number of events when the notice was made; None if unknown."""
    unwritten: bool = False
    """Whether it says that the recording of the run can no longer be written; this holds at every moment of the run."""


def notice(
    level: Literal["info", "warning", "error"], text: str, file: str | None = None, line: int | None = None, detail: str = ""
) -> Notice:
    """Returns a notice; the texts may be of any length and content, as models make them."""
    return Notice(
        level=level, text=shortened(text), file=None if file is None else shortened(file), line=line, detail=shortened(detail, 100_000)
    )


class Reply(Message, frozen=True, kw_only=True):
    """The reply to a `CommandMessage`."""

    id: int
    result: bytes = b"null"
    """The result as JSON."""
    error: str | None = None
    loses: bool = False
    """Whether it was refused only because something would be lost; see `RunChange.drop`."""
    field: str | None = None
    """The field whose value was refused, as a `FieldError` names it; None for any other error."""
    line: int | None = None
    """The line of a text that was the reason to refuse a question about it."""


class Position(Message, frozen=True, kw_only=True):
    """The position of the worker: the innermost line of the modeller's code."""

    file: str | None
    line: int | None
    function: str = ""


class WorkerEnded(Message, frozen=True, kw_only=True):
    """The worker ends normally."""


ToWorker = Start | CommandMessage | SetOverlays | Leave | AskPosition
FromWorker = Facts | State | NewEvents | EventsRemoved | Branched | Unrecorded | Loaded | Share | Notice | Reply | Position | WorkerEnded

_ENCODER = msgspec.msgpack.Encoder()
TO_WORKER: msgspec.msgpack.Decoder[ToWorker] = msgspec.msgpack.Decoder(ToWorker)
FROM_WORKER: msgspec.msgpack.Decoder[FromWorker] = msgspec.msgpack.Decoder(FromWorker)
LENGTH = 4
"""Number of bytes of a message's length prefix."""
LONGEST = 200_000_000
"""Maximum size of a message [bytes]; a compiled scene with large meshes is the largest."""
LONGEST_ANSWER = 20_000_000
"""Maximum size of an answer to a question [bytes]."""


def framed(message: Message) -> bytes:
    """Returns a message as bytes with its length prefix."""
    data = _ENCODER.encode(message)
    return len(data).to_bytes(LENGTH, "big") + data
