"""The REST interface for models and sessions; `recording_routes` has recordings. Its OpenAPI description is at /api/openapi.json."""

from __future__ import annotations

import asyncio
from collections.abc import Mapping
from dataclasses import asdict
from io import FileIO
from pathlib import Path
from typing import Annotated, Any

import msgspec
from fastapi import APIRouter, Query, Request
from fastapi import Path as InPath
from fastapi.responses import Response
from pydantic import Field

from actr3d.values import escape_surrogates, to_json
from workbench.about import about_of
from workbench.built_manual import manual, manual_page, no_manual
from workbench.disconnects import while_connected
from workbench.files import ModelFile
from workbench.loader import ModelListing, Problem, listing_of, misplaced_in, misspelt_in, outline_of, undefined_in
from workbench.page_commands import Name, PlainValue, Text
from workbench.page_message import FilePath, PageMessage
from workbench.protocol import AnyCommand
from workbench.sessions import Sessions
from workbench.trash import restore_from_trash

router = APIRouter(prefix="/api")

InFolder = Annotated[str, Query(min_length=1, max_length=400)]
Id = Annotated[str, InPath(min_length=1, max_length=160)]
Version = Annotated[str, Field(max_length=100)]
ANSWER_TIME = 10.0
"""How long a request waits for the result of a command [s]; the command itself continues."""


class Save(PageMessage):
    """A model file with its new text."""

    path: FilePath
    text: Text
    version: Version | None = None
    """The version that is replaced; None for a new file."""


class Rename(PageMessage):
    """A model file and its new name."""

    path: FilePath
    to: FilePath


class Delete(PageMessage):
    """A model file to move to the trash folder."""

    path: FilePath


class Restore(PageMessage):
    """A deleted model, recording or experiment."""

    trash: Annotated[str, Field(max_length=400)]
    """Its path in the trash folder, as deleting it has returned it."""


class Check(PageMessage):
    """A text to check, which may not be a valid model yet."""

    path: FilePath
    text: Text
    load: bool = False
    """Whether it is also loaded in a worker, which runs its top level and its `build`."""


class Open(PageMessage):
    """A model with which to start a session."""

    model: FilePath
    settings: dict[Name, PlainValue] = Field(default_factory=dict, max_length=200)
    seed: int | None = Field(default=None, ge=0, lt=2**63)
    record: bool = True
    run: bool = False
    real_time: bool = False
    """Whether the session is for somebody who watches it; see `Sessions.open`. Otherwise every run goes as fast as possible."""


class CommandRequest(PageMessage):
    """A command or question."""

    command: AnyCommand


def sessions_of(request: Request) -> Sessions:
    """Returns the sessions of the server that handles the request."""
    return request.app.state.sessions


def json_response(content: str | bytes, status: int = 200) -> Response:
    """Returns a response whose content is JSON already."""
    return Response(content, status, media_type="application/json")


async def made(request: Request, kind: str, *paths: Path, **options: Any) -> FileIO:
    """Returns an open file that a worker makes from recordings or tables; the work is cancelled if the client disconnects."""
    return await while_connected(sessions_of(request).readers.make(kind, *paths, **options), request.receive)


def code_json(made_here: bool, file: str, source: str, helpers: Mapping[str, str]) -> dict[str, Any]:
    """Returns code that a request would run, as values that JSON can encode whatever the texts contain."""
    texts = {escape_surrogates(name): escape_surrogates(text) for name, text in helpers.items()}
    return {"made_here": made_here, "file": escape_surrogates(file), "source": escape_surrogates(source), "helpers": texts}


# -- models


@router.get("/models")
def models(request: Request) -> dict[str, Any]:
    """Lists the model files; none of them is executed.

    `problem` says why a file cannot be opened, null if it can; `manual` whether the manual is there, `no_manual` how to get it if not.
    """
    folder = sessions_of(request).folder
    files = [
        {"path": escape_surrogates(path), **vars(outline_of(folder.root / path)), "problem": folder.problem_of(path)}
        for path in folder.paths()
    ]
    missing = no_manual() if manual() is None else None
    return {"folder": escape_surrogates(str(folder.root)), "models": files, "manual": missing is None, "no_manual": missing}


@router.get("/model")
def model(request: Request, path: InFolder) -> dict[str, Any]:
    """Returns a model file's text and the description read from it."""
    sessions = sessions_of(request)
    file = sessions.folder.read(path)
    request.app.state.later(sessions.saved, sessions.folder.locate(path))  # the client may reload because the file has changed
    return _file_and_listing(file)


@router.get("/model/version")
def version(request: Request, path: InFolder) -> dict[str, Any]:
    """Returns the version of a model file's current text, without the text; null if the file does not exist."""
    folder = sessions_of(request).folder
    where = folder.locate(path)
    return {"path": path, "version": folder.version(where) if where.is_file() else None}


@router.put("/model")
def save(request: Request, body: Save) -> dict[str, Any]:
    """Writes a model file if its version is still the given one; otherwise 409."""
    sessions = sessions_of(request)
    file = sessions.folder.save(body.path, body.text, body.version)
    request.app.state.later(sessions.saved, sessions.folder.locate(file.path))
    return _file_and_listing(file)


@router.post("/model/duplicate")
def duplicate(request: Request, body: Rename) -> dict[str, Any]:
    """Copies a model file."""
    return _file_and_listing(sessions_of(request).folder.copy(body.path, body.to))


@router.post("/model/rename")
def rename(request: Request, body: Rename) -> dict[str, Any]:
    """Renames a model file."""
    sessions = sessions_of(request)
    before = sessions.folder.locate(body.path)
    file = sessions.folder.rename(body.path, body.to)
    request.app.state.later(sessions.renamed, before, sessions.folder.locate(file.path), file.path)
    return _file_and_listing(file)


@router.post("/model/delete")
def delete(request: Request, body: Delete) -> dict[str, Any]:
    """Moves a model file to the trash folder."""
    sessions = sessions_of(request)
    trash = sessions.folder.delete(body.path)
    request.app.state.later(sessions.saved, sessions.folder.locate(body.path))
    return {"trash": trash}


@router.post("/restore")
async def restore(request: Request, body: Restore) -> dict[str, Any]:
    """Moves a deleted model, recording or experiment back from the trash folder; 409 if there is one of its name by now."""
    sessions = sessions_of(request)
    deleted = await asyncio.to_thread(restore_from_trash, sessions.folder.root, body.trash)
    path = sessions.folder.root / deleted.path
    if deleted.label:
        await asyncio.to_thread(sessions.recordings.labels.change, path.stem, msgspec.structs.asdict(deleted.label))
    sessions.saved(path)
    sessions.announce_recordings()
    return {"restored": deleted.path}


@router.post("/check")
async def check(request: Request, body: Check) -> dict[str, Any]:
    """Checks a text and returns its problems with line numbers: those of compiling it and, with `load`, of loading it."""
    sessions = sessions_of(request)
    path = sessions.folder.locate(body.path)
    listing, misplaced, others = await asyncio.to_thread(_read, body.text, body.path)
    problems = [asdict(problem) for problem in listing.problems]
    if body.load and not any(problem["level"] == "error" for problem in problems):
        problems = await sessions.check(path, body.text)
    else:
        problems += map(asdict, misplaced)
    problems += [problem for problem in map(asdict, others) if problem not in problems]  # loading warns of patterns, too
    return {"problems": problems, "listing": asdict(listing)}


def _read(text: str, path: str) -> tuple[ModelListing, list[Problem], list[Problem]]:
    """Returns what a text says of its model; the productions in wrong places, which loading finds as well; and its other problems."""
    return listing_of(text, path), [*misplaced_in(text)], [*undefined_in(text), *misspelt_in(text)]


def _file_and_listing(file: ModelFile) -> dict[str, Any]:
    return {**asdict(file), "listing": asdict(listing_of(file.text, file.path))}


# -- sessions


@router.get("/sessions")
async def sessions(request: Request) -> dict[str, Any]:
    """Lists the sessions; `ready` says whether a run can start at once, or the workbench is still loading what models need."""
    known = sessions_of(request)
    return {"sessions": [session.summary() for session in known.all()], "ready": known.workers.ready}


@router.post("/sessions", status_code=201)
async def open_session(request: Request, body: Open) -> dict[str, Any]:
    """Starts a session with a model file; the run is paused at its start unless `run` is true."""
    wanted = body.model_dump(exclude={"model", "settings"})
    session = await sessions_of(request).open(body.model, dict(body.settings), **wanted)
    return session.summary()


@router.get("/sessions/{session}")
async def session(request: Request, session: Id) -> Response:
    """Returns the facts of a session and the newest state of its run."""
    found = sessions_of(request).get(session)
    found_json = {"session": msgspec.Raw(found.facts_json()), "state": msgspec.Raw(found.state_json())}
    return json_response(msgspec.json.encode(found_json))


@router.get("/sessions/{session}/about")
def about(request: Request, session: Id) -> dict[str, Any]:
    """Returns the description of the model on screen: its docstring as a tree of elements, with values to try.

    `manual` is the address of its page in the manual; null if it has none.
    """
    found = sessions_of(request).get(session)
    source = found.source
    if source is None:  # no run could be started
        source = sessions_of(request).folder.read(found.model).text
    return {**about_of(source, found.model), "manual": manual_page(found.model)}


@router.post("/sessions/{session}/command")
async def command(request: Request, session: Id, body: CommandRequest) -> Response:
    """Carries out a command or answers a question, and waits a limited time for the result.

    409 if it fails; 202 if it is not done yet, for example because the model is busy.
    """
    work = asyncio.create_task(body.command.submit(sessions_of(request).get(session), "API"))
    done, _ = await asyncio.wait([work], timeout=ANSWER_TIME)
    if not done:
        return json_response(to_json({"result": None, "error": "not done yet: the model is busy"}), 202)
    reply = work.result()
    found_json = msgspec.json.encode({"result": msgspec.Raw(reply.result), "error": reply.error})
    return json_response(found_json, 200 if reply.error is None else 409)


@router.post("/sessions/{session}/close")
async def close_session(request: Request, session: Id) -> dict[str, Any]:
    """Ends a session and its worker."""
    await sessions_of(request).close(session)
    return {"closed": session}
