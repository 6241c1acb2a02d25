"""The REST interface: models and sessions; `recording_routes` has the recordings. Its description in OpenAPI is at /api/openapi.json."""

from __future__ import annotations

import asyncio
from dataclasses import asdict
from typing import Annotated, Any

import msgspec
from fastapi import APIRouter, Query, Request
from fastapi import Path as InPath
from fastapi.responses import Response
from pydantic import Field

from workbench import protocol as say
from workbench.about import about_of
from workbench.files import ModelFile
from workbench.loader import listing_of, sendable
from workbench.outlines import outline_of
from workbench.sessions import Sessions

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
    real_time: bool = False
    """Whether a run with a body goes at real time until a speed is chosen; else every run goes as fast as it can."""


class Saying(say.Said):
    """A command or question."""

    say: say.Anything


def sessions_of(request: Request) -> Sessions:
    """Returns the sessions of the server that is asked."""
    return request.app.state.sessions


# -- models


@router.get("/models")
def models(request: Request) -> dict[str, Any]:
    """Lists the model files; none of them is run."""
    folder = sessions_of(request).folder
    files = [{"path": sendable(path), **vars(outline_of(folder.root / path))} for path in folder.paths()]
    return {"folder": sendable(str(folder.root)), "models": files}


@router.get("/model")
def model(request: Request, path: InFolder) -> dict[str, Any]:
    """Gives a model file's text, and what it says of itself."""
    sessions = sessions_of(request)
    file = sessions.folder.read(path)
    request.app.state.later(sessions.saved, sessions.folder.locate(path))  # who reads it anew may have seen that it has changed
    return _told(file)


@router.get("/model/version")
def version(request: Request, path: InFolder) -> dict[str, Any]:
    """Tells which text a model file has now, without the text; null where there is no such file."""
    folder = sessions_of(request).folder
    where = folder.locate(path)
    return {"path": path, "version": folder.version(where) if where.is_file() else None}


@router.put("/model")
def save(request: Request, body: Save) -> dict[str, Any]:
    """Writes a model file, if it still has the text of the version that is named; 409 where not."""
    sessions = sessions_of(request)
    file = sessions.folder.save(body.path, body.text, body.version)
    request.app.state.later(sessions.saved, sessions.folder.locate(file.path))
    return _told(file)


@router.post("/model/duplicate")
def duplicate(request: Request, body: Rename) -> dict[str, Any]:
    """Copies a model file."""
    return _told(sessions_of(request).folder.copy(body.path, body.to))


@router.post("/model/rename")
def rename(request: Request, body: Rename) -> dict[str, Any]:
    """Gives a model file another name."""
    sessions = sessions_of(request)
    before = sessions.folder.locate(body.path)
    file = sessions.folder.rename(body.path, body.to)
    request.app.state.later(sessions.renamed, before, sessions.folder.locate(file.path), file.path)
    return _told(file)


@router.post("/model/delete")
def delete(request: Request, body: Delete) -> dict[str, Any]:
    """Puts a model file into the trash folder."""
    sessions = sessions_of(request)
    trash = sessions.folder.delete(body.path)
    request.app.state.later(sessions.saved, sessions.folder.locate(body.path))
    return {"trash": trash}


@router.post("/check")
async def check(request: Request, body: Check) -> dict[str, Any]:
    """Says what is wrong with a text, with line numbers: what compiling tells, or with `load` also what loading it tells."""
    sessions = sessions_of(request)
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
    known = sessions_of(request)
    return {"sessions": [session.summary() for session in known.all()], "ready": known.workers.ready}


@router.post("/sessions", status_code=201)
async def open_session(request: Request, body: Open) -> dict[str, Any]:
    """Begins a session with a model file; it waits at its start, unless it is to run."""
    wanted = body.model_dump(exclude={"model", "settings"})
    session = await sessions_of(request).open(body.model, dict(body.settings), **wanted)
    return session.summary()


@router.get("/sessions/{session}")
def session(request: Request, session: Id) -> Response:
    """Tells of a session and of the newest state of its run."""
    found = sessions_of(request).get(session)
    told = {"session": msgspec.Raw(found.facts_json()), "state": msgspec.Raw(found.state_json())}
    return Response(msgspec.json.encode(told), media_type="application/json")


@router.get("/sessions/{session}/about")
def about(request: Request, session: Id) -> dict[str, Any]:
    """Gives the description of the model whose run is shown: its docstring as a tree of elements, with values to try."""
    found = sessions_of(request).get(session)
    source = found.source
    if source is None:  # no run of it could be begun
        source = sessions_of(request).folder.read(found.model).text
    return about_of(source, found.model)


@router.post("/sessions/{session}/say")
async def say_to(request: Request, session: Id, body: Saying) -> Response:
    """Says a command or asks a question, and waits a while for what comes of it.

    409 where it cannot be done; 202 where it has not been done yet, as of a model that is busy.
    """
    work = asyncio.create_task(sessions_of(request).get(session).carry_out(body.say, "API"))
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
    await sessions_of(request).close(session)
    return {"closed": session}
