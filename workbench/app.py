"""Builds the application: all routes of the server behind one access check."""

from __future__ import annotations

import asyncio
import logging
import os
from collections.abc import AsyncGenerator, Callable, Mapping
from contextlib import asynccontextmanager, suppress
from functools import cache
from pathlib import Path
from typing import Any

from fastapi import FastAPI, Request
from fastapi.exceptions import RequestValidationError
from fastapi.responses import JSONResponse, PlainTextResponse
from pydantic import BaseModel
from starlette.exceptions import HTTPException
from starlette.staticfiles import StaticFiles
from starlette.types import Receive, Scope, Send

from actr3d.errors import Actr3dError, reason_of
from actr3d.values import escape_surrogates
from workbench import experiment_routes, language_routes, recording_routes, routes, sockets
from workbench.auth import Gate, Guard
from workbench.built_manual import manual, no_manual
from workbench.experiments import Experiments
from workbench.files import ModelFolder
from workbench.language.language_server import LanguageServer
from workbench.page_files import ROUTE, PageFiles
from workbench.protocol import problem_of
from workbench.recordings import Recordings
from workbench.retention import RetentionLimits, is_complete
from workbench.sessions import Sessions
from workbench.trash import empty_trash
from workbench.viser_bridge import Bridge
from workbench.worker.memory import MODEL_MEMORY
from workbench.worker.spawn import ForkServer
from workbench.worker.workers import Workers

DAY = 86_400.0
"""How often old deleted files are removed from the trash folder [s]."""


class Refusal(BaseModel):
    """The answer to a request that is not carried out."""

    error: str
    """Why."""


def make_app(
    models: Path, gate: Gate, *, memory: int = MODEL_MEMORY, limits: RetentionLimits | None = None, fork_server: ForkServer | None = None
) -> FastAPI:
    """Returns the application; its `state.leave` ends all runs and experiments.

    Args:
        models: The models folder.
        gate: Checks access to the server.
        memory: Maximum memory of a model [MB]; 0 for no limit.
        limits: How many recordings are kept; None for the default.
        fork_server: The process from which workers are forked, if it has been started already.
    """
    folder = ModelFolder(models)
    workers = Workers(memory, fork_server)
    sessions = Sessions(folder, Recordings(folder.root), workers)
    experiments = Experiments(sessions)
    language = LanguageServer(workers, folder.root)

    async def leave() -> None:
        await asyncio.gather(sessions.close_all(), experiments.close(), language.close())
        await workers.close()

    @asynccontextmanager
    async def life(app: FastAPI) -> AsyncGenerator[None]:
        loop = asyncio.get_running_loop()

        def later(call: Callable[..., object], *args: Any) -> None:
            loop.call_soon_threadsafe(call, *args)

        app.state.later = later
        workers.begin()
        closing = asyncio.Event()
        tidying = asyncio.create_task(keep_tidy(sessions, limits or RetentionLimits(), closing))
        yield
        closing.set()
        await leave()
        await asyncio.wait([tidying])

    app = FastAPI(
        title="ACT-R 3D workbench",
        docs_url=None,
        redoc_url=None,
        openapi_url="/api/openapi.json",
        lifespan=life,
        responses={"default": {"model": Refusal, "description": "It is refused."}},
    )
    app.state.leave = leave
    app.state.sessions = sessions
    app.state.experiments = experiments
    app.state.language = language
    app.state.bridge = Bridge()
    app.state.files = PageFiles()
    app.state.pages = 0
    app.include_router(routes.router)
    app.include_router(recording_routes.router)
    app.include_router(experiment_routes.router)
    app.include_router(language_routes.router)
    app.include_router(sockets.router)
    app.mount(ROUTE, app.state.files, name="static")
    app.mount("/manual", _manual, name="manual")
    app.add_exception_handler(Actr3dError, _refused)
    app.add_exception_handler(OSError, _refused)
    app.add_exception_handler(RequestValidationError, _misunderstood)
    app.add_exception_handler(HTTPException, _no_answer)
    app.add_exception_handler(Exception, _unexpected)
    app.add_middleware(Guard, gate=gate)
    return app


async def keep_tidy(sessions: Sessions, limits: RetentionLimits, closing: asyncio.Event) -> None:
    """Tidies the folder of the workbench at its start, and deletes old deleted files each day, until it is closing."""
    await tidy(sessions, limits)
    while True:
        await asyncio.to_thread(empty_trash, sessions.folder.root)
        with suppress(TimeoutError):
            await asyncio.wait_for(closing.wait(), DAY)
            return


async def tidy(sessions: Sessions, limits: RetentionLimits) -> None:
    """Deletes recordings beyond the limits, and unfinished files."""
    recordings = sessions.recordings
    for path in await asyncio.to_thread(recordings.all):
        if not is_complete(path):  # a killed process may have left it so, and then reading it completes the file
            with suppress(Actr3dError, OSError):
                await sessions.listing.one(path.stem)
    await asyncio.to_thread(recordings.tidy, limits)


async def _manual(scope: Scope, receive: Receive, send: Send) -> None:
    """Serves the manual; if there is none, says why."""
    folder = manual()
    if folder is None:
        await PlainTextResponse(no_manual(), status_code=404)(scope, receive, send)
    else:
        await _files_of(folder)(scope, receive, send)


@cache
def _files_of(folder: Path) -> StaticFiles:
    return StaticFiles(directory=folder, html=True)


def _error_response(problem: str, status: int, headers: Mapping[str, str] | None = None) -> JSONResponse:
    """Returns a response that describes a problem; unpaired surrogate characters are written as escapes."""
    return JSONResponse({"error": escape_surrogates(problem)}, status_code=status, headers=headers)


async def _refused(_: Request, error: Exception) -> JSONResponse:
    file = getattr(error, "filename", None)
    where = "" if file is None else f"'{Path(os.fsdecode(file)).name}': "
    return _error_response(where + reason_of(error), getattr(error, "status", 409))


async def _misunderstood(_: Request, error: Exception) -> JSONResponse:
    """Reports what in a request does not match the API description."""
    assert isinstance(error, RequestValidationError)
    first = error.errors()[0]
    if first["type"] == "json_invalid":
        return _error_response(f"the body is not JSON: {first['ctx']['error']} at character {first['loc'][-1]}", 400)
    return _error_response(problem_of(first), 422)


async def _no_answer(_: Request, error: Exception) -> JSONResponse:
    """Reports that the address does not exist or does not accept the request."""
    assert isinstance(error, HTTPException)
    return _error_response(error.detail, error.status_code, error.headers)


async def _unexpected(_: Request, error: Exception) -> JSONResponse:
    logging.getLogger("workbench").error("an error of the workbench itself", exc_info=error)
    return _error_response(f"an error of the workbench itself: {type(error).__name__}", 500)
