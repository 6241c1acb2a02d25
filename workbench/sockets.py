"""Serves what a browser loads: the workbench's page, viser's page, and the two websockets."""

from __future__ import annotations

import asyncio
import contextlib
import itertools
import json
import logging
from typing import Any

import msgspec
from fastapi import APIRouter, Request
from fastapi.responses import HTMLResponse, PlainTextResponse, RedirectResponse, Response
from pydantic import ValidationError
from starlette.websockets import WebSocket, WebSocketDisconnect

from actr3d.errors import Actr3dError
from workbench import protocol
from workbench.client_feed import Feed, Raw
from workbench.sessions import Sessions
from workbench.shipped import static
from workbench.viser_bridge import POLICY, Bridge, page

MAX_PAGES = 64
"""Maximum number of connected browsers."""
MAX_AT_ONCE = 32
"""Maximum number of commands of one browser that wait for their replies."""
LONGEST = 100_000
"""Maximum length of a message from a browser [characters]."""

router = APIRouter(include_in_schema=False)
_names = itertools.count(1)


@router.get("/")
def index(request: Request) -> HTMLResponse:
    """Returns the workbench's page."""
    return HTMLResponse(request.app.state.files.with_versions((static() / "index.html").read_text(encoding="utf-8")))


@router.get("/viser/")
def any_scene(request: Request) -> Response:
    """Redirects to the 3D view of the newest session that has one, with the same options."""
    sessions: Sessions = request.app.state.sessions
    shown = [session.name for session in sessions.all() if sessions.view(session.name) is not None]
    if not shown:
        return PlainTextResponse("there is no 3D view yet: run a model that has a world\n", status_code=404)
    return RedirectResponse(request.url.replace(scheme="", netloc="", path=f"/viser/{shown[-1]}/"), status_code=307)


@router.get("/viser/{session}/")
async def scene(session: str, request: Request) -> Response:
    """Returns viser's page for a session. While the browser loads its scripts, the scene is built."""
    sessions: Sessions = request.app.state.sessions
    view = sessions.view(session)
    if view is None:
        return PlainTextResponse("there is no 3D view of that session\n", status_code=404)
    view.prepare()
    return HTMLResponse(request.app.state.files.with_versions(page()), headers={"content-security-policy": POLICY})


@router.websocket("/viser/{session}")
async def scene_socket(websocket: WebSocket, session: str) -> None:
    """Connects a browser to viser's websocket."""
    sessions: Sessions = websocket.app.state.sessions
    bridge: Bridge = websocket.app.state.bridge
    await bridge.carry(websocket, sessions.view(session))


@router.websocket("/ws")
async def socket(websocket: WebSocket) -> None:
    """Sends a browser the updates of one session, and carries out its commands."""
    state: Any = websocket.app.state
    if state.pages >= MAX_PAGES:
        await websocket.close(1013)
        return
    state.pages += 1
    try:
        await websocket.accept()
        with contextlib.suppress(WebSocketDisconnect, RuntimeError):
            await _Page(websocket, state.sessions).serve()
    finally:
        state.pages -= 1


class _Page:
    """Serves one browser on the websocket."""

    def __init__(self, websocket: WebSocket, sessions: Sessions) -> None:
        self._websocket = websocket
        self._sessions = sessions
        self._name = f"page {next(_names)}"
        self._tasks: set[asyncio.Task[None]] = set()

    async def serve(self) -> None:
        """Serves the browser until it disconnects. Its first message is an `Attach`; a later one changes the session."""
        sending: asyncio.Task[None] | None = None
        feed: Feed | None = None
        session: Any = None  # the session of that feed
        try:
            while True:
                message = await self._websocket.receive()
                if message["type"] == "websocket.disconnect":
                    return
                text: str | None = message.get("text")
                if text is not None and len(text) > LONGEST:
                    await self._websocket.close(1009, f"a message has at most {LONGEST:,} characters, not {len(text):,}")
                    return
                if feed is not None and feed.choked:
                    await self._websocket.close(1008, "too many replies were not read")
                    return
                read = _read(text)
                if isinstance(read, protocol.Ping):
                    await self._websocket.send_text('{"type":"pong"}')
                elif isinstance(read, protocol.Attach):
                    if feed is not None:
                        session.leave(feed)
                        feed = None
                    if sending is not None:
                        sending.cancel()
                        await asyncio.gather(sending, return_exceptions=True)
                    try:
                        session = self._sessions.get(read.session, read.born)
                    except Actr3dError as error:
                        await self._refuse(str(error), session=read.session)
                        continue
                    self._name = read.page or self._name
                    joined: Feed = session.join(self._name)
                    joined.resume(read.run, read.epoch, read.events)
                    feed, sending = joined, asyncio.create_task(self._send(joined))
                elif feed is None:
                    problem = read if isinstance(read, str) else "the first message must be an attach, which names a session"
                    await self._refuse(problem, id=_number_of(text))
                elif isinstance(read, str):
                    feed.reply(_reply(_number_of(text), error=read))
                elif len(self._tasks) < MAX_AT_ONCE:
                    task = asyncio.create_task(self._carry_out(session, feed, read))
                    self._tasks.add(task)
                    task.add_done_callback(self._tasks.discard)
                else:
                    feed.reply(_reply(read.id, error="too many requests are waiting for their results"))
        finally:
            if feed is not None:
                session.leave(feed)
            for task in (*self._tasks, *([sending] if sending is not None else ())):
                task.cancel()

    async def _send(self, feed: Feed) -> None:
        with contextlib.suppress(WebSocketDisconnect, RuntimeError):
            while True:
                try:
                    message = await feed.next()
                except Exception:  # the page, which would never get anything again, connects again
                    logging.getLogger("workbench").exception("an update of a page cannot be made")
                    await self._websocket.close(1011, "an error of the workbench itself")
                    return
                await self._websocket.send_text(message.decode())

    async def _carry_out(self, session: Any, feed: Feed, request: protocol.Request) -> None:
        reply = await request.command.submit(session, self._name)
        feed.reply(_reply(request.id, reply.result, reply.error, loses=reply.loses, field=reply.field))

    async def _refuse(self, problem: str, **what: str | int | None) -> None:
        """Says why something is not done: the `id` of a request, or the `session` that cannot be shown."""
        await self._websocket.send_text(msgspec.json.encode({"type": "refused", "error": problem, **what}).decode())


def _reply(
    number: int | None, result: bytes = b"null", error: str | None = None, *, loses: bool = False, field: str | None = None
) -> bytes:
    return msgspec.json.encode({"id": number, "result": Raw(result), "error": error, "loses": loses, "field": field})


def _number_of(text: str | None) -> int | None:
    """Returns the number of a page's message, even if the rest is invalid, so that the sender gets a reply; None if it has none."""
    try:
        number = json.loads(text or "")["id"]
    except (ValueError, TypeError, LookupError, RecursionError):
        return None
    return number if isinstance(number, int) and 0 <= number < 2**53 else None


def _read(text: str | None) -> protocol.Attach | protocol.Ping | protocol.Request | str:
    """Returns a page's message, or the reason why it is none. The text of a binary message is None."""
    if text is None:
        return "a message must be text (JSON), not binary data"
    try:
        return protocol.MESSAGE.validate_json(text)
    except ValidationError as error:
        first = error.errors(include_url=False, include_input=False)[0]
        return protocol.problem_of({**first, "loc": first["loc"][1:]})  # without the kind of message
