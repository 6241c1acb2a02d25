"""Who may speak to the server: one middleware, which denies by default, over http and websockets alike."""

from __future__ import annotations

import asyncio
import hmac
import re
import secrets
from collections.abc import Awaitable, Callable, MutableMapping
from dataclasses import dataclass, field
from http.cookies import CookieError, SimpleCookie
from typing import Any
from urllib.parse import parse_qs, urlencode

Scope = MutableMapping[str, Any]
Receive = Callable[[], Awaitable[MutableMapping[str, Any]]]
Send = Callable[[MutableMapping[str, Any]], Awaitable[None]]
App = Callable[[Scope, Receive, Send], Awaitable[None]]

LOOPBACK = frozenset({"127.0.0.1", "localhost", "[::1]"})
HEADER = b"x-workbench"
"""Every request that changes something has it; a form of another page cannot send it."""
SAFE = frozenset({"GET", "HEAD"})
LARGEST = 2_000_000
"""No request has a larger body [bytes]."""
BODY_TIME = 30.0
"""So long a request's body may take to come [s]."""
LONGEST_PATH = 4_000
"""Nor a longer path and query."""
_HOST = re.compile(r"(\[[0-9a-fA-F:.]+\]|[A-Za-z0-9.\-]+)(?::(\d{1,5}))?")

HEADERS = (
    (b"x-content-type-options", b"nosniff"),
    (b"referrer-policy", b"no-referrer"),
    (b"cross-origin-resource-policy", b"same-origin"),
    (b"cross-origin-opener-policy", b"same-origin"),
    (b"x-frame-options", b"SAMEORIGIN"),
    (b"cache-control", b"no-store"),
)
POLICY = (
    b"default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; font-src 'self' data:; "
    b"connect-src 'self'; frame-src 'self'; worker-src 'self' blob:; form-action 'none'; base-uri 'none'; frame-ancestors 'self'"
)
"""What our own pages may load and do: nothing from anywhere else, no scripts in the text."""


class Token:
    """The secret that lets a user in; it shows itself to nobody."""

    def __init__(self, text: str | None = None) -> None:
        self._text = secrets.token_urlsafe(32) if text is None else text

    def __repr__(self) -> str:
        return "<Token>"

    def equals(self, other: str) -> bool:
        """Tells whether it is this one, in a time that tells nothing more."""
        return hmac.compare_digest(self._text.encode(), other.encode("utf-8", "surrogateescape"))

    def reveal(self) -> str:
        """Returns it, to be told to the user, or to be put into the user's own cookie."""
        return self._text


@dataclass(frozen=True, kw_only=True)
class Gate:
    """Where the server is, and whom it lets in."""

    token: Token
    port: int
    hosts: frozenset[str] = LOOPBACK
    """By which names it may be spoken to; others are a sign of a name that was led here from elsewhere (DNS rebinding)."""
    scheme: str = "http"
    cookie: str = field(init=False)
    """The name of the cookie: one a port, as cookies do not tell ports apart."""

    def __post_init__(self) -> None:
        """Names the cookie."""
        object.__setattr__(self, "cookie", f"workbench_{self.port}")

    def knows_host(self, host: str) -> bool:
        """Tells whether a `Host` header names this server."""
        match = _HOST.fullmatch(host)
        return match is not None and match[1].lower() in self.hosts and int(match[2] or 80) == self.port

    def is_own_origin(self, origin: str, host: str) -> bool:
        """Tells whether an `Origin` header is that of our own pages, as they were asked for by this `Host`."""
        return origin.lower() == f"{self.scheme}://{host.lower()}" and self.knows_host(host)


class Guard:
    """Lets through who has the token and comes from our own page, and keeps everybody else out; adds headers to all answers.

    Args:
        app: What is guarded.
        gate: Whom it lets in.
    """

    def __init__(self, app: App, gate: Gate) -> None:
        self._app = app
        self._gate = gate

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Handles one request, websocket or event of the server's life."""
        if scope["type"] == "lifespan":
            await self._app(scope, receive, send)
            return
        if scope["type"] not in ("http", "websocket"):
            return
        status, reason = self._judge(scope)
        if scope["type"] == "websocket":
            if status != 200:
                await receive()
                await send({"type": "websocket.close", "code": 1008, "reason": reason})
            else:
                await self._app(_without_secrets(scope), receive, send)
            return
        if status == 303:
            await _redirect(scope, send, self._gate)
        elif status != 200:
            await _refuse(send, status, reason)
        else:
            body, status, reason = await _body(receive)
            if status == 200:
                await self._app(_without_secrets(scope), _given(body, receive), _with_headers(send))
            else:
                await _refuse(send, status, reason)

    def _judge(self, scope: Scope) -> tuple[int, str]:
        """Returns 200 for who may pass, 303 for who has brought the token in the address, and else why not."""
        gate, headers = self._gate, _Headers(scope)
        host, origin = headers.one("host"), headers.one("origin")
        if host is None or not gate.knows_host(host):
            return 421, "this server does not go by that name"
        socket = scope["type"] == "websocket"
        method = "GET" if socket else scope["method"]
        if len(scope.get("raw_path") or b"") + len(scope["query_string"]) > LONGEST_PATH:
            return 414, "the address is too long"
        brought = parse_qs(scope["query_string"].decode("latin-1")).get("token", []) if not socket and method == "GET" else []
        if brought and scope["path"] == "/":
            return (303, "") if len(brought) == 1 and gate.token.equals(brought[0]) else (401, "that is not the token of this server")
        bearer = headers.one("authorization") or ""
        by_header = bearer.startswith("Bearer ") and gate.token.equals(bearer.removeprefix("Bearer "))
        if not by_header and not any(gate.token.equals(value) for value in headers.cookies(gate.cookie)):
            return 401, "open the address with the token that the workbench printed when it was started"
        if origin is not None and not gate.is_own_origin(origin, host):
            return 403, "another page asks"
        if origin is None and not by_header and (socket or method not in SAFE):
            return 403, "it is not told which page asks"
        if headers.one("sec-fetch-site") in ("cross-site", "same-site") and headers.one("sec-fetch-mode") != "navigate":
            return 403, "another page asks"
        if not socket and method not in SAFE:
            return _judge_change(headers)
        return 200, ""


def _judge_change(headers: _Headers) -> tuple[int, str]:
    """Judges a request that changes something: it has JSON, our header, and is not too large."""
    if (headers.one("content-type") or "").partition(";")[0].strip().lower() != "application/json":
        return 415, "what changes something is sent as application/json"
    if headers.one(HEADER.decode()) is None:
        return 403, f"what changes something is sent with the header {HEADER.decode()}"
    length = headers.one("content-length") or "0"
    if not (length.isascii() and length.isdigit()):
        return 400, "the length of the request is no number"
    return (413, f"no request has more than {LARGEST:,} bytes") if int(length) > LARGEST else (200, "")


class _Headers:
    """The headers of a request."""

    def __init__(self, scope: Scope) -> None:
        self._headers: list[tuple[bytes, bytes]] = scope["headers"]

    def one(self, name: str) -> str | None:
        """Returns a header; one that comes twice counts as something that is never right."""
        found = [value for key, value in self._headers if key == name.encode()]
        return None if not found else found[0].decode("latin-1") if len(found) == 1 else "\0twice"

    def cookies(self, name: str) -> list[str]:
        """Returns the values of all cookies of a name."""
        values: list[str] = []
        for key, value in self._headers:
            if key == b"cookie":
                for part in value.decode("latin-1").split(";"):
                    try:
                        cookie = SimpleCookie(part)
                    except CookieError:
                        continue
                    values += [morsel.value for known, morsel in cookie.items() if known == name]
        return values


async def _body(receive: Receive) -> tuple[bytes, int, str]:
    """Returns a request's body and 200; or why it is not taken: it is too large, whatever length it said it has, or too late."""
    body = bytearray()
    try:
        async with asyncio.timeout(BODY_TIME):
            while True:
                message = await receive()
                body += message.get("body", b"")
                if len(body) > LARGEST:
                    return b"", 413, f"no request has more than {LARGEST:,} bytes"
                if message["type"] == "http.disconnect" or not message.get("more_body", False):
                    return bytes(body), 200, ""
    except TimeoutError:
        return b"", 408, f"the request did not come as a whole within {BODY_TIME:g} s"


def _given(body: bytes, receive: Receive) -> Receive:
    """Returns what gives a body that has been received already, and then what comes."""
    waiting = [body]

    async def give() -> MutableMapping[str, Any]:
        if waiting:
            return {"type": "http.request", "body": waiting.pop(), "more_body": False}
        return await receive()

    return give


def _without_secrets(scope: Scope) -> Scope:
    """Returns what is asked without what let it in, so that nothing further inside can pass it on."""
    kept = [(key, value) for key, value in scope["headers"] if key not in (b"cookie", b"authorization")]
    return {**scope, "headers": kept}


def _with_headers(send: Send) -> Send:
    async def send_with_headers(message: MutableMapping[str, Any]) -> None:
        if message["type"] == "http.response.start":
            there = {key for key, _ in message.get("headers", ())}
            more = [header for header in (*HEADERS, (b"content-security-policy", POLICY)) if header[0] not in there]
            message = {**message, "headers": [*message.get("headers", ()), *more]}
        await send(message)

    return send_with_headers


async def _redirect(scope: Scope, send: Send, gate: Gate) -> None:
    """Puts the token into a cookie, and sends the browser to the same page without it in the address."""
    rest = {key: values for key, values in parse_qs(scope["query_string"].decode("latin-1")).items() if key != "token"}
    target = scope["path"] + (f"?{urlencode(rest, doseq=True)}" if rest else "")
    cookie = f"{gate.cookie}={gate.token.reveal()}; Path=/; HttpOnly; SameSite=Strict"
    headers = [(b"location", target.encode("ascii", "replace")), (b"set-cookie", cookie.encode()), *HEADERS]
    await send({"type": "http.response.start", "status": 303, "headers": headers})
    await send({"type": "http.response.body", "body": b""})


async def _refuse(send: Send, status: int, reason: str) -> None:
    headers = [(b"content-type", b"text/plain; charset=utf-8"), *HEADERS, (b"content-security-policy", b"default-src 'none'")]
    await send({"type": "http.response.start", "status": status, "headers": headers})
    await send({"type": "http.response.body", "body": f"{reason}\n".encode()})
