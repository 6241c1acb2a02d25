"""Calls the application through ASGI without a server, also with headers that no client would send."""

from __future__ import annotations

import asyncio
from collections.abc import Awaitable, Callable, Iterable, MutableMapping
from typing import Any

from workbench.auth import ASGIApp, Gate, Token

TOKEN = "a-token-of-24-or-more-bytes-for-tests"
GATE = Gate(token=Token(TOKEN), port=8000)
HOST = ("host", "127.0.0.1:8000")
ORIGIN = ("origin", "http://127.0.0.1:8000")
COOKIE = ("cookie", f"workbench_8000={TOKEN}")
JSON = ("content-type", "application/json")
OURS = ("x-workbench", "1")

Header = tuple[str, str]


def _scope(kind: str, path: str, headers: Iterable[Header], query: str, method: str) -> dict[str, Any]:
    return {
        "type": kind,
        "asgi": {"version": "3.0", "spec_version": "2.4"},
        "http_version": "1.1",
        "scheme": "http" if kind == "http" else "ws",
        "method": method,
        "path": path,
        "raw_path": path.encode(),
        "query_string": query.encode(),
        "root_path": "",
        "headers": [(name.lower().encode(), value.encode("latin-1")) for name, value in headers],
        "client": ("127.0.0.1", 1),
        "server": ("127.0.0.1", 8000),
        "subprotocols": [],
        "state": {},
        "extensions": {},
    }


class Answer:
    """The answer to a request."""

    def __init__(self, messages: list[MutableMapping[str, Any]]) -> None:
        self.messages = messages

    @property
    def status(self) -> int:
        return next(message["status"] for message in self.messages if message["type"] == "http.response.start")

    @property
    def headers(self) -> dict[str, str]:
        start = next(message for message in self.messages if message["type"] == "http.response.start")
        return {name.decode().lower(): value.decode("latin-1") for name, value in start["headers"]}

    @property
    def body(self) -> bytes:
        return b"".join(message.get("body", b"") for message in self.messages if message["type"] == "http.response.body")

    @property
    def accepted(self) -> bool:
        return self.messages[0]["type"] == "websocket.accept"


def ask(
    app: ASGIApp, path: str, *headers: Header, query: str = "", method: str = "GET", body: bytes = b"", parts: Iterable[bytes] | None = None
) -> Answer:
    """Sends a request and returns the answer."""
    return asyncio.run(call(app, path, *headers, query=query, method=method, body=body, parts=parts))


async def call(
    app: ASGIApp,
    path: str,
    *headers: Header,
    query: str = "",
    method: str = "GET",
    body: bytes = b"",
    parts: Iterable[bytes] | None = None,
    leaving: asyncio.Event | None = None,
    first: Callable[[], Awaitable[object]] | None = None,
) -> Answer:
    """Sends a request from a running event loop, and returns the answer.

    Args:
        app: The application.
        path: The path of the request.
        headers: The headers of the request.
        query: The query string.
        method: The HTTP method.
        body: The body, or its last part.
        parts: Parts of the body that are sent before `body`.
        leaving: An event; the client disconnects when it is set.
        first: Called when the answer begins.
    """
    waiting = [{"type": "http.request", "body": part, "more_body": True} for part in parts or ()]
    waiting.append({"type": "http.request", "body": body, "more_body": False})
    return await _call(app, _scope("http", path, headers, query, method), waiting, leaving, first)


def connect(app: ASGIApp, path: str, *headers: Header) -> Answer:
    """Opens a websocket and sends nothing; returns the answer."""
    waiting: list[dict[str, Any]] = [{"type": "websocket.connect"}, {"type": "websocket.disconnect", "code": 1001}]
    return asyncio.run(_call(app, _scope("websocket", path, headers, "", ""), waiting))


async def _call(
    app: ASGIApp,
    scope: dict[str, Any],
    waiting: list[dict[str, Any]],
    leaving: asyncio.Event | None = None,
    first: Callable[[], Awaitable[object]] | None = None,
) -> Answer:
    sent: list[MutableMapping[str, Any]] = []
    answered = leaving or asyncio.Event()

    async def receive() -> MutableMapping[str, Any]:
        if waiting:
            return waiting.pop(0)
        await answered.wait()  # a client stays connected until it has its answer
        return {"type": "http.disconnect"}

    async def send(message: MutableMapping[str, Any]) -> None:
        sent.append(message)
        if message["type"] == "http.response.start" and first is not None:
            await first()
        if message["type"] == "http.response.body" and not message.get("more_body", False):
            answered.set()

    await app(scope, receive, send)
    return Answer(sent)
