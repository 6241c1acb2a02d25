"""The part of the REST interface that tells of recordings, and gives and takes them away."""

from __future__ import annotations

import asyncio
from io import FileIO
from pathlib import Path
from typing import Annotated, Any, Literal

import msgspec
from fastapi import APIRouter, Query, Request
from fastapi.responses import Response
from pydantic import Field

from actr3d.values import to_json
from workbench import protocol as say
from workbench.keeping import stands_alone
from workbench.listing import MOST as MOST_LISTED
from workbench.loader import sendable
from workbench.open_file import OpenFile, gone
from workbench.readers import while_wanted
from workbench.routes import Id, sessions_of
from workbench.sessions import SessionError, Sessions

router = APIRouter(prefix="/api")


File = Literal["sqlite", "events.csv", "states.csv", "replay.html"]
KINDS: dict[File, str] = {
    "sqlite": "application/vnd.sqlite3",
    "events.csv": "text/csv",
    "states.csv": "text/csv",
    "replay.html": "text/html",
}
"""What files can be had of a recording, and their media types."""


class Naming(say.Said):
    """A recording's other name."""

    to: Annotated[str, Field(min_length=1, max_length=150)]


class Trusting(say.Said):
    """Whether code may be run."""

    trust: bool = False
    """Whether the code in the recording may be run though this installation did not make it."""


class Opening(Trusting):
    """How a recording is opened."""

    real_time: bool = False
    """Whether a run with a body goes at real time until a speed is chosen."""


class Pair(say.Said):
    """Two recordings."""

    first: Annotated[str, Field(max_length=160)]
    second: Annotated[str, Field(max_length=160)]
    kinds: tuple[say.Name, ...] = Field(default=(), max_length=50)
    """Which kinds of events are compared; nothing for all."""


@router.get("/recordings")
async def recordings(
    request: Request, first: Annotated[int, Query(ge=0, le=1_000_000)] = 0, most: Annotated[int, Query(ge=1, le=MOST_LISTED)] = MOST_LISTED
) -> Response:
    """Lists recordings, the newest first: `total` of them, and what is known of those from `first` on.

    `problem` says why one cannot be read, `session` which session goes on writing it.
    """
    sessions = sessions_of(request)
    total, found = await sessions.listing.some(first, most)
    writing = sessions.writing()
    told = {"total": total, "recordings": [{**vars(summary), "session": writing.get(summary.id)} for summary in found]}
    return Response(await asyncio.to_thread(to_json, told), media_type="application/json")


@router.get("/recordings/{recording}")
async def recording(request: Request, recording: Id) -> Response:
    """Returns what is known of a recording."""
    return Response(to_json(await _recording(sessions_of(request), recording)), media_type="application/json")


@router.get("/recordings/{recording}/file")
async def download(request: Request, recording: Id, form: File = "sqlite") -> Response:
    """Returns a file: the recording as it is, its events or states as CSV, or one HTML file that plays its scene beside its trace.

    Of a run that goes on it is what has been recorded until now. 409 where there is nothing to return, as no states of a program.
    """
    sessions = sessions_of(request)
    path = sessions.recordings.path(recording)
    if form == "sqlite" and stands_alone(path):
        file = sessions.recordings.opened(recording)
    else:
        file = await _made(request, form, path)
    return OpenFile(file, KINDS[form], f"{recording}.{form}")


async def _made(request: Request, form: str, *paths: Path, **options: Any) -> FileIO:
    """Returns an open file that a worker makes of recordings, for as long as the client waits for it."""
    return await while_wanted(sessions_of(request).readers.make(form, *paths, **options), lambda: gone(request.receive))


@router.get("/recordings/{recording}/curves")
async def recorded_curves(
    request: Request,
    recording: Id,
    name: Annotated[list[say.Name] | None, Query(max_length=500)] = None,
    first: Annotated[float, Query(ge=0, lt=1e9, allow_inf_nan=False)] = 0.0,
    most: Annotated[int, Query(ge=2, le=20_000)] = 2_000,
    last: Annotated[float | None, Query(ge=0, lt=1e9, allow_inf_nan=False)] = None,
) -> Response:
    """Returns how a recorded run went, also one that goes on, as curves over time, for plots: those that are named, or all.

    `{names: [{name, unit, group}], times: [s], curves: {name: [value or null]}}`, as the question `curves` of a session does.
    """
    path = sessions_of(request).recordings.path(recording)
    return OpenFile(await _made(request, "curves", path, names=name, first=first, most=most, last=last), "application/json")


@router.post("/recordings/{recording}/open", status_code=201)
async def open_recording(request: Request, recording: Id, body: Opening | None = None) -> dict[str, Any]:
    """Begins a session that lives through a recorded run again, or returns the one that does so already.

    All of the recorded run is known at once: it can be sent to any time of it. Opening runs the code that the recording holds:
    403 where this installation did not make it, unless the request says `trust`.
    """
    said = body or Opening()
    return (await sessions_of(request).reopen(recording, trust=said.trust, real_time=said.real_time)).summary()


@router.get("/recordings/{recording}/code")
async def recorded_code(request: Request, recording: Id) -> dict[str, Any]:
    """Returns the code that opening or replaying a recording runs: the model's `source`, and the texts of its `helpers` by name.

    `made_here` says whether this installation made the recording, and nobody has changed it since.
    """
    began = await sessions_of(request).beginning(recording)
    helpers = {sendable(name): sendable(text) for name, (_, text) in began.helpers.items()}
    return {"made_here": began.made_here, "file": sendable(began.file), "source": sendable(began.source), "helpers": helpers}


@router.post("/recordings/{recording}/replay")
async def replay(request: Request, recording: Id, body: Trusting | None = None) -> dict[str, Any]:
    """Runs a recording again, in a process of its own, and says whether every byte agrees; it ends when nobody waits any more.

    403 where this installation did not make the recording, unless the request says `trust`.
    """
    sessions = sessions_of(request)
    await sessions.trusted(recording, body is not None and body.trust)
    return await sessions.reruns.run(sessions.recordings.path(recording), request.is_disconnected)


@router.get("/recordings/{recording}/replay")
async def replaying(request: Request, recording: Id) -> dict[str, Any]:
    """Tells how much of a recording has been run again, from 0 to 1, while that goes on; null where it does not."""
    sessions = sessions_of(request)
    return {"share": sessions.reruns.share(sessions.recordings.path(recording))}


@router.post("/recordings/{recording}/rename")
def rename_recording(request: Request, recording: Id, body: Naming) -> dict[str, Any]:
    """Gives a recording another name; one that a user has named is not removed to make place for others."""
    sessions_of(request).recordings.rename(recording, body.to)
    return {"renamed": body.to}


@router.post("/recordings/{recording}/delete")
def delete_recording(request: Request, recording: Id) -> dict[str, Any]:
    """Deletes a recording; 409 while a run goes on writing it."""
    sessions = sessions_of(request)
    if recording in sessions.writing():
        raise SessionError("a run that is open still writes this recording; begin its model anew, or close its session, and then delete it")
    sessions.recordings.delete(recording)
    return {"deleted": recording}


@router.post("/compare")
async def compare_recordings(request: Request, body: Pair) -> Response:
    """Returns where two recordings differ: parameters, the lines of the model, and the first event that is not the same."""
    sessions = sessions_of(request)
    names = (body.first, body.second)
    first, second = [sessions.recordings.path(name) for name in names]
    with await _made(request, "comparison", first, second, kinds=body.kinds) as file:
        differences = msgspec.json.decode(await asyncio.to_thread(file.read), type=dict[str, msgspec.Raw])
    runs = to_json([await _recording(sessions, name) for name in names]).encode()
    return Response(msgspec.json.encode({"runs": msgspec.Raw(runs), **differences}), media_type="application/json")


async def _recording(sessions: Sessions, name: str) -> dict[str, Any]:
    """Returns what is told of a recording."""
    return {**vars(await sessions.listing.one(name)), "session": sessions.writing().get(name)}
