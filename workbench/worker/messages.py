"""What the server and a worker say to each other: frozen types in MessagePack, each with its length before it."""

from __future__ import annotations

import hashlib
from typing import Any, Literal

import msgspec

Status = Literal["loading", "paused", "running", "ended", "failed"]


class Message(msgspec.Struct, frozen=True, kw_only=True, tag=str.lower, tag_field="type"):
    """The base of all messages."""


def whole(text: str, most: int = 10_000) -> str:
    """Returns a text that can be sent: half characters, which no encoding has, as escapes, and a long one without its middle."""
    told = str(text)
    if len(told) > most:
        told = f"{told[: most // 2]}\n… ({len(told) - most:,} more characters) …\n{told[-(most // 2) :]}"
    return told.encode("utf-8", "backslashreplace").decode("utf-8")


def digest_of(text: str) -> str:
    """Returns what tells a text from others."""
    return hashlib.sha256(text.encode("utf-8", "surrogatepass")).hexdigest()


# -- to the worker


class Start(Message, frozen=True, kw_only=True):
    """Begins a run; the first message."""

    job: Literal["run", "check", "replay", "make", "list"] = "run"
    """`check` loads the model, builds what it describes and runs nothing; `replay` runs a recording again and compares; `make` writes
    a file that is made of recordings; `list` reads summaries of recordings."""
    path: str = ""
    """The model; or the recording that is run again."""
    source: str = ""
    folder: str = ""
    recordings: tuple[str, ...] = ()
    """The recordings that are read."""
    form: str = ""
    """What is made of them: one of `workbench.forms`."""
    to: str = ""
    """The file that is made."""
    settings: dict[str, Any] = {}
    seed: int | str | None = None
    record: str | None = None
    commands: list[tuple[int, dict[str, Any]]] = []
    """What users did in an earlier run, to be done again: after which tick, and what (`Command.to_data`)."""
    recorded: str | None = None
    """The recording of the earlier run that is lived through again; None for a new run."""
    helpers: dict[str, tuple[str, str]] = {}
    """The file and text of each helper module of an earlier run, by name; others are read from the folder."""
    factor: float | None = None
    real_time: bool = False
    """Whether a run that has a body goes at real time, whatever `factor` is: no speed has been chosen yet."""
    breakpoints: tuple[str, ...] = ()
    run: bool = False
    attempt: int = 0
    """Which of its session's attempts to begin a run this is, from 1."""
    version: str = ""
    """Tells the model's text from others; see `ModelFile.version`."""


class Do(Message, frozen=True, kw_only=True):
    """A command or question of a page."""

    id: int
    say: bytes
    """As JSON; see `protocol`."""


class Leave(Message, frozen=True, kw_only=True):
    """Asks the worker to end in good order."""


class Draw(Message, frozen=True, kw_only=True):
    """Says of which kinds of overlays every state is to tell from now on; see `worker.drawings`."""

    kinds: tuple[str, ...]


class Where(Message, frozen=True, kw_only=True):
    """Asks at which line of the model the worker is."""


# -- from the worker


class Facts(Message, frozen=True, kw_only=True):
    """What is known of a run once it is built; of a program once more whenever another one of its simulations is shown."""

    kind: Literal["simulation", "program"]
    seed: int | str
    period: float
    """A tick [s]."""
    parameters: bytes
    """JSON: their values by name."""
    world: bytes
    """JSON: bodies and apertures; null without a world."""
    mj_model: bytes | None
    """The compiled scene, as MuJoCo saves it."""


class State(Message, frozen=True, kw_only=True):
    """What the run is like at a moment; a newer one replaces it."""

    status: Status
    reason: str
    """Why it is paused, has ended or failed."""
    tick: int
    time: float
    """[s]"""
    furthest: float
    """How far it has come [s]."""
    wanted: float | None
    measured: float | None
    """How many times as fast as real time; None where it stands."""
    events: int
    """How many events there are up to this moment."""
    parts: bytes
    """JSON: see `actr3d.actr.explain.snapshot`."""
    apertures: dict[str, float]
    """Free widths by name [m]."""
    result: bytes
    """JSON: what was measured of a run that has ended; null where nothing was, or it goes on."""
    physics: bytes | None
    """MuJoCo's `mjSTATE_INTEGRATION`; None without a world."""
    drawn: dict[str, Any] = {}
    """What overlays show of it, by kind: what a `Draw` has asked for."""


class News(Message, frozen=True, kw_only=True):
    """Events, in order."""

    first: int
    """The number of the first, counted from 0; more than one after the last before where some were left out."""
    events: list[bytes]
    """JSON of each: time [us], source, kind, data."""


class Cut(Message, frozen=True, kw_only=True):
    """The run goes another way: events from a number on are no more."""

    events: int


class Branched(Message, frozen=True, kw_only=True):
    """The run goes another way from a moment on; how it had gone on is kept as a recording of its own."""

    recording: str
    """Its name."""
    at: float
    """The moment [s]."""
    until: float
    """How far the run had come [s]."""


class Loaded(Message, frozen=True, kw_only=True):
    """The model has loaded a helper module."""

    file: str
    """Where it lies."""
    digest: str
    """Tells its text from others; see `digest_of`."""


class Share(Message, frozen=True, kw_only=True):
    """So much of a job is done, from 0 to 1."""

    done: float


class Notice(Message, frozen=True, kw_only=True):
    """Something to tell the user."""

    level: Literal["info", "warning", "error"]
    text: str
    file: str | None = None
    line: int | None = None
    detail: str = ""
    events: int | None = None
    """How many events there were when it was told; None where that is not known."""


def notice(
    level: Literal["info", "warning", "error"], text: str, file: str | None = None, line: int | None = None, detail: str = ""
) -> Notice:
    """Returns a notice of any texts, such as models make."""
    return Notice(level=level, text=whole(text), file=None if file is None else whole(file), line=line, detail=whole(detail, 100_000))


class Reply(Message, frozen=True, kw_only=True):
    """What came of a `Do`."""

    id: int
    result: bytes = b"null"
    """JSON."""
    error: str | None = None


class At(Message, frozen=True, kw_only=True):
    """Where the worker is: the innermost line that is the modeller's."""

    file: str | None
    line: int | None
    function: str = ""


class Over(Message, frozen=True, kw_only=True):
    """The worker ends in good order."""


ToWorker = Start | Do | Draw | Leave | Where
FromWorker = Facts | State | News | Cut | Branched | Loaded | Share | Notice | Reply | At | Over

_ENCODER = msgspec.msgpack.Encoder()
TO_WORKER: msgspec.msgpack.Decoder[ToWorker] = msgspec.msgpack.Decoder(ToWorker)
FROM_WORKER: msgspec.msgpack.Decoder[FromWorker] = msgspec.msgpack.Decoder(FromWorker)
LENGTH = 4
"""How many bytes tell a message's length."""
LONGEST = 200_000_000
"""No message is longer [bytes]; a compiled scene with large meshes is the largest."""
LONGEST_ANSWER = 20_000_000
"""No answer to a question is longer [bytes]."""


def framed(message: Message) -> bytes:
    """Returns a message as it goes over the wire."""
    data = _ENCODER.encode(message)
    return len(data).to_bytes(LENGTH, "big") + data
