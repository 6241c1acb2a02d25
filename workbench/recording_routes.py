"""The part of the REST interface that tells of recordings, and gives and takes them away."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Annotated, Any, Literal

from fastapi import APIRouter, Query, Request
from fastapi.responses import FileResponse, Response, StreamingResponse
from pydantic import Field
from starlette.background import BackgroundTask

from actr3d.errors import RecordingError
from actr3d.recording import Recorded
from actr3d.values import to_json
from workbench import protocol as say
from workbench.comparing import compare
from workbench.copying import copy_of
from workbench.html_replay.aside import replay_of
from workbench.keeping import stands_alone
from workbench.recordings import MOST as MOST_LISTED
from workbench.recordings import curves, events_csv, states_csv
from workbench.routes import Id, sessions_of
from workbench.sessions import SessionError, Sessions

router = APIRouter(prefix="/api")


class Naming(say.Said):
    """A recording's other name."""

    to: Annotated[str, Field(min_length=1, max_length=150)]


class Pair(say.Said):
    """Two recordings."""

    first: Annotated[str, Field(max_length=160)]
    second: Annotated[str, Field(max_length=160)]
    kinds: tuple[say.Name, ...] = Field(default=(), max_length=50)
    """Which kinds of events are compared; nothing for all."""


@router.get("/recordings")
def recordings(
    request: Request, first: Annotated[int, Query(ge=0, le=1_000_000)] = 0, most: Annotated[int, Query(ge=1, le=MOST_LISTED)] = MOST_LISTED
) -> Response:
    """Lists recordings, the newest first: `total` of them, and what is known of those from `first` on.

    `problem` says why one cannot be read, `session` which session goes on writing it.
    """
    sessions = sessions_of(request)
    total, found = sessions.recordings.list(first, most)
    writing = sessions.writing()
    listed = [{**vars(summary), "session": writing.get(summary.id)} for summary in found]
    return Response(to_json({"total": total, "recordings": listed}).encode(errors="replace"), media_type="application/json")


@router.get("/recordings/{recording}")
def recording(request: Request, recording: Id) -> Response:
    """Tells of a recording."""
    return Response(to_json(_recording(sessions_of(request), recording)).encode(errors="replace"), media_type="application/json")


@router.get("/recordings/{recording}/file")
async def download(
    request: Request, recording: Id, form: Literal["sqlite", "events.csv", "states.csv", "replay.html"] = "sqlite"
) -> Response:
    """Gives a recording: as it is, its events or states as CSV, or one HTML file that plays its scene beside its trace.

    Of a run that goes on it is what has been recorded until now. 409 where there is nothing to give, as no states of a program.
    """
    path = sessions_of(request).recordings.path(recording)
    name = f"{recording}.{form}"
    if form == "replay.html":
        return _once(await replay_of(sessions_of(request).workers, path), "text/html", name)
    if form == "sqlite":
        kind = "application/vnd.sqlite3"
        return FileResponse(path, media_type=kind, filename=name) if stands_alone(path) else _once(await copy_of(path), kind, name)
    make: Callable[[Path], Iterator[str]] = events_csv if form == "events.csv" else states_csv
    await asyncio.to_thread(_check_there, path, form)  # once the answer has begun, it is too late to say that there is nothing
    headers = {"content-disposition": f'attachment; filename="{name}"'}
    return StreamingResponse(make(path), media_type="text/csv; charset=utf-8", headers=headers)


def _once(made: Path, kind: str, name: str) -> FileResponse:
    """Gives a file that has been made to be given, and deletes it then."""
    return FileResponse(made, media_type=kind, filename=name, background=BackgroundTask(made.unlink, missing_ok=True))


def _check_there(path: Path, form: str) -> None:
    """Raises `RecordingError` where a file is no recording, or has nothing of what is asked for."""
    with Recorded(path) as recorded:
        if form == "states.csv" and recorded.state_count == 0:
            raise RecordingError("the recording has no states: no simulation has run in it")


@router.get("/recordings/{recording}/curves")
def recorded_curves(
    request: Request,
    recording: Id,
    name: Annotated[list[say.Name] | None, Query(max_length=500)] = None,
    first: Annotated[float, Query(ge=0, lt=1e9, allow_inf_nan=False)] = 0.0,
    most: Annotated[int, Query(ge=2, le=20_000)] = 2_000,
) -> dict[str, Any]:
    """Gives how a recorded run went, also one that goes on, as curves over time, for plots: those that are named, or all.

    `{names: [{name, unit, group}], times: [s], curves: {name: [value or null]}}`, as the question `curves` of a session does.
    """
    return curves(sessions_of(request).recordings.path(recording), name, first, most)


@router.post("/recordings/{recording}/open", status_code=201)
async def open_recording(request: Request, recording: Id) -> dict[str, Any]:
    """Begins a session that lives through a recorded run again."""
    return (await sessions_of(request).reopen(recording)).summary()


@router.post("/recordings/{recording}/replay")
async def replay(request: Request, recording: Id) -> dict[str, Any]:
    """Runs a recording again, in a process of its own, and says whether every byte agrees; it ends when nobody waits any more."""
    sessions = sessions_of(request)
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
def compare_recordings(request: Request, body: Pair) -> Response:
    """Says where two recordings differ: parameters, the lines of the model, and the first event that is not the same."""
    sessions = sessions_of(request)
    names = (body.first, body.second)
    first, second = [sessions.recordings.path(name) for name in names]
    told = {"runs": [_recording(sessions, name) for name in names], **compare(first, second, body.kinds)}
    return Response(to_json(told).encode(errors="replace"), media_type="application/json")


def _recording(sessions: Sessions, name: str) -> dict[str, Any]:
    """Returns what is told of a recording."""
    return {**vars(sessions.recordings.summary(name)), "session": sessions.writing().get(name)}
