"""The REST interface: models, sessions and recordings. Its description in OpenAPI is at /api/openapi.json."""

from __future__ import annotations

import asyncio
from collections.abc import Callable, Iterator
from dataclasses import asdict
from pathlib import Path
from typing import Annotated, Any, Literal

import msgspec
from fastapi import APIRouter, Query, Request
from fastapi import Path as InPath
from fastapi.responses import FileResponse, Response, StreamingResponse
from pydantic import Field
from starlette.background import BackgroundTask

from actr3d.recording import Recorded
from actr3d.values import to_json
from workbench import protocol as say
from workbench.comparing import compare
from workbench.files import ModelFile
from workbench.loader import listing_of
from workbench.recordings import MOST as MOST_LISTED
from workbench.recordings import curves, events_csv, states_csv
from workbench.replay.aside import replay_of
from workbench.replaying import replay as again
from workbench.sessions import SessionError, Sessions

router = APIRouter(prefix="/api")

FilePath = Annotated[str, Field(min_length=1, max_length=400)]
InFolder = Annotated[str, Query(min_length=1, max_length=400)]
Id = Annotated[str, InPath(min_length=1, max_length=160)]
Version = Annotated[str, Field(max_length=100)]
ANSWER_TIME = 10.0
"""So long a request waits for what comes of a command [s]; the command goes on."""


class Save(say.Said):
    """A model file's new text."""

    path: FilePath
    text: say.Text
    version: Version | None = None
    """The version that it replaces; None for a new file."""


class Rename(say.Said):
    """A model file's other name."""

    path: FilePath
    to: FilePath


class Delete(say.Said):
    """A model file to be put into the trash folder."""

    path: FilePath


class Check(say.Said):
    """A text that may be no model yet."""

    path: FilePath
    text: say.Text
    load: bool = False
    """Whether it is loaded, too, which runs its top level and its `build`, in a worker."""


class Open(say.Said):
    """A model to begin a session with."""

    model: FilePath
    settings: dict[say.Name, say.Plain] = Field(default_factory=dict, max_length=200)
    seed: int | None = Field(default=None, ge=0, lt=2**63)
    record: bool = True
    run: bool = False


class Saying(say.Said):
    """A command or question."""

    say: say.Anything


class Naming(say.Said):
    """A recording's other name."""

    to: Annotated[str, Field(min_length=1, max_length=150)]


class Pair(say.Said):
    """Two recordings."""

    first: Annotated[str, Field(max_length=160)]
    second: Annotated[str, Field(max_length=160)]
    kinds: tuple[say.Name, ...] = Field(default=(), max_length=50)
    """Which kinds of events are compared; nothing for all."""


def _sessions(request: Request) -> Sessions:
    return request.app.state.sessions


# -- models


@router.get("/models")
def models(request: Request) -> dict[str, Any]:
    """Lists the model files; none of them is run."""
    folder = _sessions(request).folder
    files = [{"path": path, **_listed(folder.root / path)} for path in folder.paths()]
    return {"folder": str(folder.root), "models": files}


def _listed(path: Path) -> dict[str, Any]:
    try:
        listing = listing_of(path.read_text(encoding="utf-8"), path.name)
    except (OSError, ValueError):
        return {"title": "", "kind": "program"}
    return {"title": listing.title, "kind": listing.kind}


@router.get("/model")
def model(request: Request, path: InFolder) -> dict[str, Any]:
    """Gives a model file's text, and what it says of itself."""
    sessions = _sessions(request)
    file = sessions.folder.read(path)
    request.app.state.later(sessions.saved, sessions.folder.locate(path))  # who reads it anew may have seen that it has changed
    return _told(file)


@router.get("/model/version")
def version(request: Request, path: InFolder) -> dict[str, Any]:
    """Tells which text a model file has now, without the text; null where there is no such file."""
    folder = _sessions(request).folder
    where = folder.locate(path)
    return {"path": path, "version": folder.version(where) if where.is_file() else None}


@router.put("/model")
def save(request: Request, body: Save) -> dict[str, Any]:
    """Writes a model file, if it still has the text of the version that is named; 409 where not."""
    sessions = _sessions(request)
    file = sessions.folder.save(body.path, body.text, body.version)
    request.app.state.later(sessions.saved, sessions.folder.locate(file.path))
    return _told(file)


@router.post("/model/duplicate")
def duplicate(request: Request, body: Rename) -> dict[str, Any]:
    """Copies a model file."""
    return _told(_sessions(request).folder.copy(body.path, body.to))


@router.post("/model/rename")
def rename(request: Request, body: Rename) -> dict[str, Any]:
    """Gives a model file another name."""
    sessions = _sessions(request)
    before = sessions.folder.locate(body.path)
    file = sessions.folder.rename(body.path, body.to)
    request.app.state.later(sessions.renamed, before, sessions.folder.locate(file.path), file.path)
    return _told(file)


@router.post("/model/delete")
def delete(request: Request, body: Delete) -> dict[str, Any]:
    """Puts a model file into the trash folder."""
    sessions = _sessions(request)
    trash = sessions.folder.delete(body.path)
    request.app.state.later(sessions.saved, sessions.folder.locate(body.path))
    return {"trash": trash}


@router.post("/check")
async def check(request: Request, body: Check) -> dict[str, Any]:
    """Says what is wrong with a text, with line numbers: what compiling tells, or with `load` also what loading it tells."""
    sessions = _sessions(request)
    path = sessions.folder.locate(body.path)
    listing = await asyncio.to_thread(listing_of, body.text, body.path)
    problems = [asdict(problem) for problem in listing.problems]
    if body.load and not any(problem["level"] == "error" for problem in problems):
        problems = await sessions.check(path, body.text)
    return {"problems": problems, "listing": asdict(listing)}


def _told(file: ModelFile) -> dict[str, Any]:
    return {**asdict(file), "listing": asdict(listing_of(file.text, file.path))}


# -- sessions


@router.get("/sessions")
def sessions(request: Request) -> dict[str, Any]:
    """Lists the sessions; `ready` tells whether a run can begin at once, or only when the workbench has loaded what models need."""
    known = _sessions(request)
    return {"sessions": [session.summary() for session in known.all()], "ready": known.workers.ready}


@router.post("/sessions", status_code=201)
async def open_session(request: Request, body: Open) -> dict[str, Any]:
    """Begins a session with a model file; it waits at its start, unless it is to run."""
    session = await _sessions(request).open(body.model, body.settings, seed=body.seed, record=body.record, run=body.run)
    return session.summary()


@router.get("/sessions/{session}")
def session(request: Request, session: Id) -> Response:
    """Tells of a session and of the newest state of its run."""
    found = _sessions(request).get(session)
    told = {"session": msgspec.Raw(found.facts_json()), "state": msgspec.Raw(found.state_json())}
    return Response(msgspec.json.encode(told), media_type="application/json")


@router.post("/sessions/{session}/say")
async def say_to(request: Request, session: Id, body: Saying) -> Response:
    """Says a command or asks a question, and waits a while for what comes of it.

    409 where it cannot be done; 202 where it has not been done yet, as of a model that is busy.
    """
    work = asyncio.create_task(_sessions(request).get(session).carry_out(body.say, "API"))
    done, _ = await asyncio.wait([work], timeout=ANSWER_TIME)
    if not done:
        return Response(
            msgspec.json.encode({"result": None, "error": "not done yet: the model is busy"}), 202, media_type="application/json"
        )
    reply = work.result()
    told = msgspec.json.encode({"result": msgspec.Raw(reply.result), "error": reply.error})
    return Response(told, 200 if reply.error is None else 409, media_type="application/json")


@router.post("/sessions/{session}/close")
async def close_session(request: Request, session: Id) -> dict[str, Any]:
    """Ends a session and its worker."""
    await _sessions(request).close(session)
    return {"closed": session}


# -- recordings


@router.get("/recordings")
def recordings(
    request: Request, first: Annotated[int, Query(ge=0, le=1_000_000)] = 0, most: Annotated[int, Query(ge=1, le=MOST_LISTED)] = MOST_LISTED
) -> Response:
    """Lists recordings, the newest first: `total` of them, and what is known of those from `first` on.

    `problem` says why one cannot be read, `session` which session goes on writing it.
    """
    sessions = _sessions(request)
    total, found = sessions.recordings.list(first, most)
    writing = sessions.writing()
    listed = [{**vars(summary), "session": writing.get(summary.id)} for summary in found]
    return Response(to_json({"total": total, "recordings": listed}).encode(errors="replace"), media_type="application/json")


@router.get("/recordings/{recording}")
def recording(request: Request, recording: Id) -> Response:
    """Tells of a recording."""
    return Response(to_json(_recording(_sessions(request), recording)).encode(errors="replace"), media_type="application/json")


@router.get("/recordings/{recording}/file")
async def download(
    request: Request, recording: Id, form: Literal["sqlite", "events.csv", "states.csv", "replay.html"] = "sqlite"
) -> Response:
    """Gives a recording: as it is, its events or states as CSV, or one HTML file that plays its scene beside its trace."""
    path = _sessions(request).recordings.path(recording)
    name = f"{recording}.{form}"
    if form == "replay.html":
        made = await replay_of(path)
        return FileResponse(made, media_type="text/html", filename=name, background=BackgroundTask(made.unlink, missing_ok=True))
    if form == "sqlite":
        return FileResponse(path, media_type="application/vnd.sqlite3", filename=name)
    make: Callable[[Path], Iterator[str]] = events_csv if form == "events.csv" else states_csv
    await asyncio.to_thread(_check_readable, path)  # once the answer has begun, it is too late to say that it cannot be read
    headers = {"content-disposition": f'attachment; filename="{name}"'}
    return StreamingResponse(make(path), media_type="text/csv; charset=utf-8", headers=headers)


def _check_readable(path: Path) -> None:
    """Raises `RecordingError` where a file is no recording."""
    Recorded(path).close()


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
    return curves(_sessions(request).recordings.path(recording), name, first, most)


@router.post("/recordings/{recording}/open", status_code=201)
async def open_recording(request: Request, recording: Id) -> dict[str, Any]:
    """Begins a session that lives through a recorded run again."""
    return (await _sessions(request).reopen(recording)).summary()


@router.post("/recordings/{recording}/replay")
async def replay(request: Request, recording: Id) -> dict[str, Any]:
    """Runs a recording again, in a process of its own, and says whether every byte agrees; it ends when nobody waits any more."""
    return await again(_sessions(request).recordings.path(recording), request.is_disconnected)


@router.post("/recordings/{recording}/rename")
def rename_recording(request: Request, recording: Id, body: Naming) -> dict[str, Any]:
    """Gives a recording another name; one that a user has named is not removed to make place for others."""
    _sessions(request).recordings.rename(recording, body.to)
    return {"renamed": body.to}


@router.post("/recordings/{recording}/delete")
def delete_recording(request: Request, recording: Id) -> dict[str, Any]:
    """Deletes a recording; 409 while a run goes on writing it."""
    sessions = _sessions(request)
    if recording in sessions.writing():
        raise SessionError("the present run is still writing this recording; begin another run, or close the session, and then delete it")
    sessions.recordings.delete(recording)
    return {"deleted": recording}


@router.post("/compare")
def compare_recordings(request: Request, body: Pair) -> Response:
    """Says where two recordings differ: parameters, the lines of the model, and the first event that is not the same."""
    sessions = _sessions(request)
    names = (body.first, body.second)
    first, second = [sessions.recordings.path(name) for name in names]
    told = {"runs": [_recording(sessions, name) for name in names], **compare(first, second, body.kinds)}
    return Response(to_json(told).encode(errors="replace"), media_type="application/json")


def _recording(sessions: Sessions, name: str) -> dict[str, Any]:
    """Returns what is told of a recording."""
    return {**vars(sessions.recordings.summary(name)), "session": sessions.writing().get(name)}
