"""The REST interface: models, sessions and recordings. Its description in OpenAPI is at /api/openapi.json."""

from __future__ import annotations

import asyncio
import os
import sys
from collections.abc import Callable, Iterator
from dataclasses import asdict
from pathlib import Path
from typing import Annotated, Any, Literal

import msgspec
from fastapi import APIRouter, Query, Request
from fastapi import Path as InPath
from fastapi.responses import FileResponse, Response, StreamingResponse
from pydantic import Field

from workbench import protocol as say
from workbench.files import ModelFile
from workbench.loader import listing_of
from workbench.recordings import compare, curves, events_csv, states_csv
from workbench.sessions import Sessions

router = APIRouter(prefix="/api")

FilePath = Annotated[str, Field(min_length=1, max_length=400)]
InFolder = Annotated[str, Query(min_length=1, max_length=400)]
Id = Annotated[str, InPath(min_length=1, max_length=160)]
Version = Annotated[str, Field(max_length=100)]
ANSWER_TIME = 10.0
"""So long a request waits for what comes of a command [s]; the command goes on."""
REPLAY_TIME = 120.0
"""So long a recording is run again for a comparison [s]."""


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
    return _told(_sessions(request).folder.read(path))


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
    return _told(_sessions(request).folder.rename(body.path, body.to))


@router.post("/model/delete")
def delete(request: Request, body: Delete) -> dict[str, Any]:
    """Puts a model file into the trash folder."""
    return {"trash": _sessions(request).folder.delete(body.path)}


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
    """Lists the sessions."""
    return {"sessions": [session.summary() for session in _sessions(request).all()]}


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
def recordings(request: Request) -> dict[str, Any]:
    """Lists the recordings, the newest first."""
    return {"recordings": [asdict(summary) for summary in _sessions(request).recordings.list()]}


@router.get("/recordings/{recording}")
def recording(request: Request, recording: Id) -> dict[str, Any]:
    """Tells of a recording."""
    return asdict(_sessions(request).recordings.summary(recording))


@router.get("/recordings/{recording}/file")
def download(request: Request, recording: Id, form: Literal["sqlite", "events.csv", "states.csv"] = "sqlite") -> Response:
    """Gives a recording: as it is, or its events or states as CSV."""
    path = _sessions(request).recordings.path(recording)
    name = f"{recording}.{form}"
    if form == "sqlite":
        return FileResponse(path, media_type="application/vnd.sqlite3", filename=name)
    make: Callable[[Path], Iterator[str]] = events_csv if form == "events.csv" else states_csv
    headers = {"content-disposition": f'attachment; filename="{name}"'}
    return StreamingResponse(make(path), media_type="text/csv; charset=utf-8", headers=headers)


@router.get("/recordings/{recording}/curves")
def recorded_curves(
    request: Request,
    recording: Id,
    name: Annotated[list[say.Name] | None, Query(max_length=100)] = None,
    most: Annotated[int, Query(ge=10, le=20_000)] = 2_000,
) -> dict[str, Any]:
    """Gives how joints moved in a recorded run, also one that goes on: their names, and the curves that are named."""
    return curves(_sessions(request).recordings.path(recording), name or [], most)


@router.post("/recordings/{recording}/open", status_code=201)
async def open_recording(request: Request, recording: Id) -> dict[str, Any]:
    """Begins a session that lives through a recorded run again."""
    return (await _sessions(request).reopen(recording)).summary()


@router.post("/recordings/{recording}/replay")
async def replay(request: Request, recording: Id) -> dict[str, Any]:
    """Runs a recording again, in a process of its own, and says whether every byte agrees."""
    path = _sessions(request).recordings.path(recording)
    command = [sys.executable, "-m", "actr3d.cli", "replay", str(path)]
    environment = {**os.environ, "PYTHONHASHSEED": "0"}
    process = await asyncio.create_subprocess_exec(
        *command, stdin=asyncio.subprocess.DEVNULL, stdout=asyncio.subprocess.PIPE, stderr=asyncio.subprocess.STDOUT, env=environment
    )
    try:
        async with asyncio.timeout(REPLAY_TIME):
            output, _ = await process.communicate()
    except TimeoutError:
        return {"agrees": None, "text": f"it takes longer than {REPLAY_TIME:g} s"}
    finally:
        if process.returncode is None:
            process.kill()
            await asyncio.shield(process.wait())
    return {"agrees": {0: True, 1: False}.get(process.returncode or 0), "text": output.decode(errors="replace").strip()}


@router.post("/recordings/{recording}/rename")
def rename_recording(request: Request, recording: Id, body: Naming) -> dict[str, Any]:
    """Gives a recording another name; one that a user has named is not removed to make place for others."""
    _sessions(request).recordings.rename(recording, body.to)
    return {"renamed": body.to}


@router.post("/recordings/{recording}/delete")
def delete_recording(request: Request, recording: Id) -> dict[str, Any]:
    """Deletes a recording."""
    _sessions(request).recordings.delete(recording)
    return {"deleted": recording}


@router.post("/compare")
def compare_recordings(request: Request, body: Pair) -> dict[str, Any]:
    """Says where two recordings differ: parameters, and the first event that is not the same."""
    recordings = _sessions(request).recordings
    return compare(recordings.path(body.first), recordings.path(body.second))
