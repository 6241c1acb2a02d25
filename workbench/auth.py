"""Controls access to the server: one middleware for HTTP and websockets that denies by default."""

from __future__ import annotations

import asyncio
import hmac
import re
import secrets
from dataclasses import dataclass, field
from urllib.parse import parse_qs, urlencode

from starlette.datastructures import Headers, MutableHeaders
from starlette.responses import PlainTextResponse, RedirectResponse, Response
from starlette.types import ASGIApp, Message, Receive, Scope, Send

LOOPBACK = frozenset({"127.0.0.1", "localhost", "[::1]"})
HEADER = "x-workbench"
"""Every request that changes something must have this header; a form of another site cannot send it."""
SAFE = frozenset({"GET", "HEAD"})
LARGEST = 2_000_000
"""Maximum size of a request's body [bytes]."""
UPLOAD, UPLOAD_TYPE = "/api/recordings/import", "application/vnd.sqlite3"
"""The path of the only request whose body is a file, which the application receives part by part, and the file's media type."""
LARGEST_UPLOAD = 2_000_000_000
"""Maximum size of that file [bytes]."""
BODY_TIME = 30.0
"""Maximum time in which a request's body must arrive [s]."""
LONGEST_PATH = 4_000
"""Maximum total length of path and query."""
REFUSAL = "open the address with the token that the workbench printed when it was started"
"""The answer to a request without the token."""
_LOCAL_ORIGIN = re.compile(r"https?://(localhost|127\.0\.0\.1)(:\d{1,5})?")
_HOST = re.compile(r"(\[[0-9a-fA-F:.]+\]|[A-Za-z0-9.\-]+)(?::(\d{1,5}))?")

HEADERS = {
    "x-content-type-options": "nosniff",
    "referrer-policy": "no-referrer",
    "cross-origin-resource-policy": "same-origin",
    "cross-origin-opener-policy": "same-origin",
    "x-frame-options": "SAMEORIGIN",
    "cache-control": "no-store",
}
POLICY = (
    "default-src 'none'; script-src 'self'; style-src 'self' 'unsafe-inline'; img-src 'self' data: blob:; font-src 'self' data:; "
    "connect-src 'self'; frame-src 'self'; worker-src 'self' blob:; form-action 'none'; base-uri 'none'; frame-ancestors 'self'"
)
"""What the workbench's pages may load and do: nothing from other servers, no inline scripts."""
_ANCESTORS = "frame-ancestors 'self'"


class Token:
    """Holds the secret that gives a user access; its repr does not show it."""

    def __init__(self, text: str | None = None) -> None:
        self._text = secrets.token_urlsafe(32) if text is None else text

    def __repr__(self) -> str:
        return "<Token>"

    def equals(self, other: str) -> bool:
        """Returns whether a text equals the token, in a time that does not depend on where they differ."""
        return hmac.compare_digest(self._text.encode(), other.encode("utf-8", "surrogateescape"))

    def reveal(self) -> str:
        """Returns the token as text, to print it for the user or to put it into the user's cookie."""
        return self._text


@dataclass(frozen=True, kw_only=True)
class Gate:
    """The addresses at which the server listens, and the access rules."""

    token: Token
    port: int
    hosts: frozenset[str] = LOOPBACK
    """Host names by which the server may be called; any other name suggests DNS rebinding."""
    tickets: set[str] = field(default_factory=set[str], repr=False)
    """Secrets each of which admits one browser, once. What a notebook stores of an address is worthless after its first use."""
    embedders: set[str] = field(default_factory=set[str])
    """The origins of other pages that may show this server in a frame."""

    @property
    def cookie(self) -> str:
        """The name of the cookie: one for each port, as cookies do not distinguish ports."""
        return f"workbench_{self.port}"

    def knows_host(self, host: str) -> bool:
        """Returns whether a `Host` header names this server."""
        match = _HOST.fullmatch(host)
        return match is not None and match[1].lower() in self.hosts and int(match[2] or 80) == self.port

    def issue_ticket(self) -> str:
        """Returns a ticket, with which one browser can show this server in a frame of another page."""
        ticket = secrets.token_urlsafe(32)
        self.tickets.add(ticket)
        return ticket

    def use_ticket(self, ticket: str, embedder: str) -> bool:
        """Uses up a ticket: from now on, pages of the origin `embedder` may show this server in a frame. Returns whether it was valid."""
        known = [one for one in self.tickets if hmac.compare_digest(one.encode(), ticket.encode("utf-8", "surrogateescape"))]
        if not known or _LOCAL_ORIGIN.fullmatch(embedder) is None:
            return False
        self.tickets.discard(ticket)
        self.embedders.add(embedder)
        return True

    def is_own_origin(self, origin: str, host: str) -> bool:
        """Returns whether an `Origin` header is that of the workbench's own pages, which were loaded from this `Host`."""
        return origin.lower() == f"http://{host.lower()}" and self.knows_host(host)


class Guard:
    """Admits requests that have the token and come from the workbench's own page, refuses all others, and adds headers to all responses."""

    def __init__(self, app: ASGIApp, gate: Gate) -> None:
        self._app = app
        self._gate = gate

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Handles one request, websocket, or lifespan event."""
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
        if status == 200 and not _is_upload(scope):
            body, status, reason = await _body(receive)
            receive = _given(body, receive)
        if status == 200:
            await self._app(_without_secrets(scope), receive, _with_headers(send, self._gate))
        else:
            response = _redirect(scope, self._gate) if status == 303 else _refusal(status, reason)
            await response(scope, receive, send)

    def _judge(self, scope: Scope) -> tuple[int, str]:
        """Returns 200 to admit a request, 303 if the address contains the token, or else the status and reason of the refusal."""
        gate, headers = self._gate, Headers(scope=scope)
        host, origin = _one(headers, "host"), _one(headers, "origin")
        if host is None or not gate.knows_host(host):
            return 421, "Host: must be a name of this server; add other names with --name"
        socket = scope["type"] == "websocket"
        method = "GET" if socket else scope["method"]
        if len(scope.get("raw_path") or b"") + len(scope["query_string"]) > LONGEST_PATH:
            return 414, "the address is too long"
        query = parse_qs(scope["query_string"].decode("latin-1")) if not socket and method == "GET" and scope["path"] == "/" else {}
        brought = query.get("token", [])
        if brought:
            return (303, "") if len(brought) == 1 and gate.token.equals(brought[0]) else (401, "token: must be that of this server")
        known = any(gate.token.equals(value) for value in _cookies(headers, gate.cookie))
        if "ticket" in query:
            admitted = gate.use_ticket(query["ticket"][0], query.get("embedder", [""])[0]) or known
            return (303, "") if admitted else (401, "ticket: must not have been used before")
        bearer = _one(headers, "authorization") or ""
        by_header = bearer.startswith("Bearer ") and gate.token.equals(bearer.removeprefix("Bearer "))
        if not by_header and not known:
            return 401, REFUSAL
        if origin is not None and not gate.is_own_origin(origin, host):
            return 403, "Origin: must be that of the workbench's own page"
        if origin is None and not by_header and (socket or method not in SAFE):
            return 403, "Origin: this header is missing, so it is not known which page sent the request"
        if _one(headers, "sec-fetch-site") in ("cross-site", "same-site") and _one(headers, "sec-fetch-mode") != "navigate":
            return 403, "Origin: must be that of the workbench's own page"
        if not socket and method not in SAFE:
            return _judge_change(headers, upload=_is_upload(scope))
        return 200, ""


def _is_upload(scope: Scope) -> bool:
    """Returns whether the body of a request is a file that the application receives part by part."""
    return scope["path"] == UPLOAD and _type(Headers(scope=scope)) == UPLOAD_TYPE


def _type(headers: Headers) -> str:
    """Returns the media type of a request's body."""
    return (_one(headers, "content-type") or "").partition(";")[0].strip().lower()


def _judge_change(headers: Headers, *, upload: bool) -> tuple[int, str]:
    """Checks a request that changes something: it must be JSON or an upload, have the workbench's header, and not be too large."""
    if not upload and _type(headers) != "application/json":
        return 415, "Content-Type: must be application/json for a request that changes something"
    if _one(headers, HEADER) is None:
        return 403, f"{HEADER}: this header is missing from a request that changes something"
    length = _one(headers, "content-length") or "0"
    if not (length.isascii() and length.isdigit()):
        return 400, "Content-Length: must be a number"
    most = LARGEST_UPLOAD if upload else LARGEST
    return (413, too_large(most)) if int(length) > most else (200, "")


def too_large(most: int) -> str:
    """Returns the error for a body with more bytes than permitted."""
    return f"the body of a request: must be <= {most:,} bytes"


def _one(headers: Headers, name: str) -> str | None:
    """Returns the value of a header; a repeated header gives a value that never matches."""
    found = headers.getlist(name)
    return None if not found else found[0] if len(found) == 1 else "\0twice"


def _cookies(headers: Headers, name: str) -> list[str]:
    """Returns the values of all cookies with a name: another server of this computer may have set one of the same name."""
    pairs = [part.strip().partition("=") for value in headers.getlist("cookie") for part in value.split(";")]
    return [value for known, _, value in pairs if known == name]


async def _body(receive: Receive) -> tuple[bytes, int, str]:
    """Returns a request's body and 200, or the status and reason if it is too large (whatever its Content-Length) or too slow."""
    body = bytearray()
    try:
        async with asyncio.timeout(BODY_TIME):
            while True:
                message = await receive()
                body += message.get("body", b"")
                if len(body) > LARGEST:
                    return b"", 413, too_large(LARGEST)
                if message["type"] == "http.disconnect" or not message.get("more_body", False):
                    return bytes(body), 200, ""
    except TimeoutError:
        return b"", 408, f"the body of a request: must arrive within {BODY_TIME:g} s"


def _given(body: bytes, receive: Receive) -> Receive:
    """Returns a `receive` that first returns a body already read, and then the messages that follow."""
    waiting = [body]

    async def give() -> Message:
        if waiting:
            return {"type": "http.request", "body": waiting.pop(), "more_body": False}
        return await receive()

    return give


def _without_secrets(scope: Scope) -> Scope:
    """Returns the scope without the cookie and the token, so that the application cannot leak them."""
    kept = [(key, value) for key, value in scope["headers"] if key not in (b"cookie", b"authorization")]
    return {**scope, "headers": kept}


def _with_headers(send: Send, gate: Gate) -> Send:
    async def send_with_headers(message: Message) -> None:
        if message["type"] == "http.response.start":
            headers = MutableHeaders(scope=message)
            for name, value in {**HEADERS, "content-security-policy": POLICY}.items():
                headers.setdefault(name, value)
            if gate.embedders:  # browsers ignore x-frame-options where the policy names ancestors
                allowed = " ".join([_ANCESTORS, *sorted(gate.embedders)])
                headers["content-security-policy"] = headers["content-security-policy"].replace(_ANCESTORS, allowed)
        await send(message)

    return send_with_headers


def _redirect(scope: Scope, gate: Gate) -> Response:
    """Stores the token in a cookie and redirects the browser to the same page without the token in its address."""
    query = parse_qs(scope["query_string"].decode("latin-1"))
    rest = {key: values for key, values in query.items() if key not in ("token", "ticket", "embedder")}
    target = scope["path"] + (f"?{urlencode(rest, doseq=True)}" if rest else "")
    cookie = f"{gate.cookie}={gate.token.reveal()}; Path=/; HttpOnly; SameSite=Strict"
    return RedirectResponse(target, 303, {**HEADERS, "set-cookie": cookie})


def _refusal(status: int, reason: str) -> Response:
    return PlainTextResponse(f"{reason}\n", status, {**HEADERS, "content-security-policy": "default-src 'none'"})
