"""Who may speak to the workbench: every promise of a local tool that runs code."""

from __future__ import annotations

import asyncio
import hmac
import json
import logging
import re
import webbrowser
from pathlib import Path
from typing import Any

import pytest
import websockets
from starlette.routing import Mount, Route, WebSocketRoute
from starlette.websockets import WebSocket

from tests.helpers.asgi_client import COOKIE, GATE, HOST, JSON, ORIGIN, OURS, TOKEN, Answer, Header, ask, connect
from workbench import cli
from workbench.app import make_app
from workbench.auth import LARGEST, LARGEST_UPLOAD, UPLOAD, Gate, Guard, Message, Receive, Scope, Send, Token
from workbench.files import ModelFolder
from workbench.viser_bridge import Bridge


@pytest.fixture(scope="module")
def app(tmp_path_factory: pytest.TempPathFactory) -> Any:
    return make_app(tmp_path_factory.mktemp("models"), GATE)


async def echo(scope: Scope, receive: Receive, send: Send) -> None:
    """Answers with what it is given."""
    if scope["type"] == "websocket":
        await send({"type": "websocket.accept"})
        return
    body = b""
    while True:
        message: Message = await receive()
        body += message.get("body", b"")
        if not message.get("more_body"):
            break
    given = b"\n".join(name + b": " + value for name, value in scope["headers"])
    await send({"type": "http.response.start", "status": 200, "headers": [(b"x-size", str(len(body)).encode())]})
    await send({"type": "http.response.body", "body": given})


guarded = Guard(echo, GATE)


def routes(app: Any) -> list[Any]:
    """Returns every route, those of included routers too."""
    found: list[Any] = []
    waiting = list(app.routes)
    while waiting:
        route = waiting.pop()
        inner = getattr(getattr(route, "original_router", None), "routes", None)
        if inner:
            waiting += inner
        else:
            found.append(route)
    return found


def test_every_route_is_known_to_these_tests(app: Any) -> None:
    kinds = {type(route).__mro__[-2].__name__ for route in routes(app)}
    assert kinds == {"BaseRoute"}
    paths = {route.path for route in routes(app)}
    assert {
        "/",
        "/static/{version}",
        "/ws",
        "/viser/{session}",
        "/viser/{session}/",
        "/api/models",
        "/api/sessions/{session}/command",
    } <= paths


@pytest.mark.parametrize("headers", [(), (("cookie", "workbench_8000=wrong"),), (("cookie", f"workbench_8001={TOKEN}"),)])
def test_no_route_and_no_websocket_without_the_token(app: Any, headers: tuple[Header, ...]) -> None:
    tried = 0
    for route in routes(app):
        path = re.sub(r"{[^}]*}", "x", route.path) + ("/main.js" if isinstance(route, Mount) else "")
        if isinstance(route, WebSocketRoute):
            assert not connect(app, path, HOST, ORIGIN, *headers).accepted
            tried += 1
        for method in (getattr(route, "methods", None) or {"GET"}) if isinstance(route, (Route, Mount)) else ():
            assert ask(app, path, HOST, ORIGIN, JSON, OURS, *headers, method=method, body=b"{}").status == 401
            tried += 1
    assert tried > 25


def test_a_route_that_is_added_later_is_guarded_too(app: Any) -> None:
    added = make_app(Path("/tmp"), GATE)
    added.add_api_route("/later", lambda: {"open": True})
    assert ask(added, "/later", HOST).status == 401
    assert ask(added, "/later", HOST, COOKIE).status == 200


def test_what_is_neither_http_nor_websocket_is_not_passed_on() -> None:
    assert ask(guarded, "/", HOST, COOKIE).status == 200

    async def odd(scope: Scope, receive: Receive, send: Send) -> None:
        raise AssertionError

    asyncio.run(Guard(odd, GATE)({"type": "webtransport"}, None, None))  # type: ignore[arg-type] # pyright: ignore[reportArgumentType]


def test_a_websocket_is_closed_before_it_is_accepted(app: Any) -> None:
    for path in ("/viser/s1", "/ws"):
        answer = connect(app, path, HOST, ORIGIN)
        assert [message["type"] for message in answer.messages] == ["websocket.close"]
    assert connect(app, "/ws", HOST, ORIGIN, COOKIE).accepted


@pytest.mark.parametrize(
    "origin",
    [
        "null",
        "http://127.0.0.1",
        "http://127.0.0.1:8001",
        "http://127.0.0.1:80000",
        "http://127.0.0.1:8000.evil.com",
        "http://127.0.0.1:8000@evil.com",
        "http://evil.com",
        "http://evil127.0.0.1:8000",
        "https://127.0.0.1:8000",
        "http://localhost:8000",
        "http://127.0.0.1:8000/",
        "127.0.0.1:8000",
        "",
        "http://",
        "file://",
        "http://127.0.0.1:8000 http://evil.com",
    ],
)
def test_the_origin_must_be_our_own(origin: str) -> None:
    wrong = ("origin", origin)
    assert not connect(guarded, "/ws", HOST, wrong, COOKIE).accepted
    assert ask(guarded, "/x", HOST, wrong, COOKIE, JSON, OURS, method="POST").status == 403
    assert ask(guarded, "/x", HOST, wrong, COOKIE).status == 403


def test_a_missing_origin_is_refused_where_it_matters() -> None:
    assert not connect(guarded, "/ws", HOST, COOKIE).accepted
    assert ask(guarded, "/x", HOST, COOKIE, JSON, OURS, method="POST").status == 403
    assert ask(guarded, "/x", HOST, COOKIE).status == 200
    assert connect(guarded, "/ws", HOST, ORIGIN, COOKIE).accepted
    assert ask(guarded, "/x", HOST, ORIGIN, COOKIE, JSON, OURS, method="POST").status == 200


def test_two_origins_are_none() -> None:
    assert not connect(guarded, "/ws", HOST, ORIGIN, ORIGIN, COOKIE).accepted


@pytest.mark.parametrize("site", ["cross-site", "same-site"])
def test_what_another_page_embeds_is_refused(site: str) -> None:
    fetched = ("sec-fetch-site", site)
    assert ask(guarded, "/static/main.js", HOST, COOKIE, fetched, ("sec-fetch-mode", "no-cors")).status == 403
    assert ask(guarded, "/", HOST, COOKIE, fetched, ("sec-fetch-mode", "navigate")).status == 200
    assert ask(guarded, "/", HOST, COOKIE, ("sec-fetch-site", "same-origin"), ("sec-fetch-mode", "cors")).status == 200


@pytest.mark.parametrize(
    "host",
    [
        "evil.com",
        "evil.com:8000",
        "127.0.0.1.evil.com:8000",
        "127.0.0.1:8001",
        "127.0.0.1",
        "localhost:8000:8000",
        "localhost:8000@evil.com",
        "[::1]x:8000",
        "[::2]:8000",
        "0.0.0.0:8000",
        "",
        " 127.0.0.1:8000",
    ],
)
def test_the_host_must_be_loopback(host: str) -> None:
    assert ask(guarded, "/", ("host", host), COOKIE).status == 421
    assert not connect(guarded, "/ws", ("host", host), ("origin", f"http://{host}"), COOKIE).accepted


def test_these_hosts_are_loopback() -> None:
    for host in ("127.0.0.1:8000", "[::1]:8000", "localhost:8000", "LOCALHOST:8000"):
        assert ask(guarded, "/", ("host", host), COOKIE).status == 200
        assert connect(guarded, "/ws", ("host", host), ("origin", f"http://{host}".lower()), COOKIE).accepted
    assert ask(guarded, "/", COOKIE).status == 421
    assert ask(guarded, "/", HOST, HOST, COOKIE).status == 421


def test_another_name_is_known_only_where_it_is_configured() -> None:
    named = Guard(echo, Gate(token=Token(TOKEN), port=8000, hosts=frozenset({"lab.example"})))
    assert ask(named, "/", ("host", "lab.example:8000"), COOKIE).status == 200
    assert ask(named, "/", HOST, COOKIE).status == 421


def post(*headers: Header, **more: Any) -> Answer:
    return ask(guarded, "/x", HOST, ORIGIN, COOKIE, *headers, method="POST", **more)


@pytest.mark.parametrize("kind", ["application/x-www-form-urlencoded", "multipart/form-data; boundary=x", "text/plain", ""])
def test_a_form_is_refused(kind: str) -> None:
    assert post(("content-type", kind), OURS).status == 415
    assert post(OURS).status == 415


def test_what_changes_something_has_our_header() -> None:
    assert post(JSON).status == 403
    assert post(JSON, OURS).status == 200
    for method in ("PUT", "PATCH", "DELETE", "OPTIONS", "TRACE", "post"):
        assert ask(guarded, "/x", HOST, ORIGIN, COOKIE, method=method).status in (403, 415)


FILE = ("content-type", "application/vnd.sqlite3")


def test_only_an_upload_may_be_larger_and_it_is_not_read_before_the_application_does() -> None:
    def upload(path: str, *headers: Header, **more: Any) -> Answer:
        return ask(guarded, path, HOST, ORIGIN, COOKIE, *headers, method="POST", **more)

    assert upload(UPLOAD, FILE, OURS, parts=[b"x" * 600_000] * 4).status == 200
    assert upload(UPLOAD, FILE, OURS, ("content-length", str(LARGEST_UPLOAD + 1))).status == 413
    assert upload(UPLOAD, JSON, OURS, parts=[b"x" * 600_000] * 4).status == 413
    assert upload("/x", FILE, OURS).status == 415
    assert upload(UPLOAD, FILE).status == 403


def test_no_request_is_too_large() -> None:
    assert post(JSON, OURS, ("content-length", str(LARGEST + 1))).status == 413
    assert post(JSON, OURS, ("content-length", "many")).status == 400
    assert post(JSON, OURS, parts=[b"x" * 600_000] * 4).status == 413
    assert post(JSON, OURS, parts=[b"x" * 600_000] * 3).headers["x-size"] == "1800000"
    assert ask(guarded, "/" + "x" * 5000, HOST, COOKIE).status == 414


def test_the_token_is_long_and_random() -> None:
    first, second = Token(), Token()
    assert len(first.reveal()) >= 32
    assert first.reveal() != second.reveal()


def test_the_token_shows_itself_nowhere(app: Any, caplog: pytest.LogCaptureFixture) -> None:
    caplog.set_level(logging.DEBUG)
    gate = Gate(token=Token(TOKEN), port=8000)
    assert TOKEN not in repr(gate) + str(gate) + repr(gate.token) + repr(Guard(echo, gate))
    ask(app, "/", HOST, query=f"token={TOKEN}")
    ask(app, "/", HOST, COOKIE)
    assert TOKEN not in caplog.text


def test_the_token_is_compared_in_constant_time(monkeypatch: pytest.MonkeyPatch) -> None:
    compared: list[tuple[bytes, bytes]] = []

    def compare(one: bytes, other: bytes) -> bool:
        compared.append((one, other))
        return one == other

    monkeypatch.setattr(hmac, "compare_digest", compare)
    for headers, query in (((COOKIE,), ""), ((("authorization", f"Bearer {TOKEN}"),), ""), ((), f"token={TOKEN}")):
        assert ask(guarded, "/", HOST, *headers, query=query).status in (200, 303)
        assert compared.pop() == (TOKEN.encode(), TOKEN.encode())


def test_the_browser_is_led_here_by_a_file_that_only_its_user_can_read(monkeypatch: pytest.MonkeyPatch) -> None:
    opened: list[str] = []

    def browse(url: str) -> None:
        page = Path(url.removeprefix("file://"))
        assert TOKEN in page.read_text(encoding="utf-8")
        assert page.parent.stat().st_mode & 0o077 == 0
        opened.append(url)

    monkeypatch.setattr(webbrowser, "open", browse)
    monkeypatch.setattr(cli, "READ_TIME", 0.0)
    cli._browse(f"http://127.0.0.1:8000/?token={TOKEN}")
    (url,) = opened
    assert TOKEN not in url  # which lists of processes show
    assert not Path(url.removeprefix("file://")).exists()


class _View:
    """A 3D view whose server tells what it is asked with."""

    over = False

    def __init__(self, port: int) -> None:
        self._port = port

    async def wait(self) -> bool:
        return True

    def address(self, *, shadows: bool) -> tuple[int, dict[str, str]]:
        return self._port, {"x-workbench-bridge": "secret"}


def test_the_bridge_sends_viser_nothing_about_the_client() -> None:
    asked: list[dict[str, str]] = []

    async def viser(socket: Any) -> None:
        asked.append(dict(socket.request.headers.raw_items()))

    async def carry() -> None:
        async with websockets.serve(viser, "127.0.0.1", 0) as server:
            waiting: list[dict[str, Any]] = [{"type": "websocket.connect"}]
            scope: dict[str, Any] = {"type": "websocket", "path": "/viser/s1", "query_string": b"", "subprotocols": [], "headers": []}
            scope["headers"] = [(name.encode(), value.encode()) for name, value in (HOST, ORIGIN, COOKIE, ("authorization", TOKEN))]

            async def receive() -> Message:
                return waiting.pop() if waiting else await asyncio.Future()

            async def send(_: Message) -> None: ...

            view: Any = _View(server.sockets[0].getsockname()[1])
            await Bridge().carry(WebSocket(scope, receive, send), view)

    asyncio.run(carry())
    (headers,) = asked
    assert headers["x-workbench-bridge"] == "secret"
    assert not {"cookie", "authorization", "origin"} & {name.lower() for name in headers}
    assert TOKEN not in str(headers)


def test_the_token_goes_from_the_address_into_a_cookie() -> None:
    answer = ask(guarded, "/", HOST, query=f"token={TOKEN}&model=a.py")
    assert answer.status == 303
    assert answer.headers["location"] == "/?model=a.py"
    assert answer.headers["set-cookie"] == f"workbench_8000={TOKEN}; Path=/; HttpOnly; SameSite=Strict"
    assert answer.headers["cache-control"] == "no-store"
    assert answer.headers["referrer-policy"] == "no-referrer"


@pytest.mark.parametrize("query", ["token=wrong", "token=", f"token={TOKEN}&token=wrong", f"token={TOKEN}x", "token=%ff%00"])
def test_a_wrong_token_in_the_address_is_refused(query: str) -> None:
    assert ask(guarded, "/", HOST, query=query).status == 401


def test_the_token_counts_in_the_address_of_the_first_page_only() -> None:
    assert ask(guarded, "/api/models", HOST, query=f"token={TOKEN}").status == 401
    assert ask(guarded, "/", HOST, ORIGIN, JSON, OURS, query=f"token={TOKEN}", method="POST").status == 401


def test_a_program_can_send_the_token_in_a_header() -> None:
    bearer = ("authorization", f"Bearer {TOKEN}")
    assert ask(guarded, "/x", HOST, bearer, JSON, OURS, method="POST").status == 200
    assert connect(guarded, "/ws", HOST, bearer).accepted
    assert ask(guarded, "/x", HOST, ("authorization", f"Basic {TOKEN}")).status == 401
    assert not connect(guarded, "/ws", HOST, bearer, ("origin", "http://evil.com")).accepted


def test_nothing_inside_is_given_the_secrets() -> None:
    body = ask(guarded, "/", HOST, COOKIE, ("authorization", f"Bearer {TOKEN}"), ("x-other", "kept")).body.decode()
    assert TOKEN not in body
    assert "x-other: kept" in body


def test_every_answer_has_the_headers_that_keep_others_out(app: Any) -> None:
    for answer in (ask(app, "/", HOST, COOKIE), ask(app, "/api/models", HOST, COOKIE), ask(app, "/nothing", HOST, COOKIE)):
        headers = answer.headers
        assert headers["x-content-type-options"] == "nosniff"
        assert headers["cross-origin-resource-policy"] == "same-origin"
        assert headers["cache-control"] == "no-store"
        assert "default-src 'none'" in headers["content-security-policy"]
        assert "script-src 'self';" in headers["content-security-policy"]
        assert "frame-ancestors 'self'" in headers["content-security-policy"]


def test_strange_cookies_do_no_harm() -> None:
    for cookie in ("", ";;;", "=", "workbench_8000", "a=b; workbench_8000", "\xff=\xfe", 'x="'):
        assert ask(guarded, "/", HOST, ("cookie", cookie)).status == 401
        assert ask(guarded, "/", HOST, ("cookie", f"{cookie}; workbench_8000={TOKEN}")).status == 200


def test_reading_listing_checking_and_saving_models_runs_nothing(tmp_path: Path) -> None:
    mark = tmp_path / "ran"
    bomb = f"open({str(mark)!r}, 'w')\nraise SystemExit\n"
    (tmp_path / "bomb.py").write_text(bomb, encoding="utf-8")
    app = make_app(tmp_path, GATE)
    change = (HOST, ORIGIN, COOKIE, JSON, OURS)

    def send(method: str, where: str, **body: Any) -> int:
        return ask(app, where, *change, method=method, body=json.dumps(body).encode()).status

    def nothing(*_: object) -> None: ...

    app.state.later = nothing
    version = ModelFolder(tmp_path).version(tmp_path / "bomb.py")
    assert ask(app, "/api/models", HOST, COOKIE).status == 200
    assert ask(app, "/api/model", HOST, COOKIE, query="path=bomb.py").status == 200
    assert send("POST", "/api/check", path="bomb.py", text=bomb) == 200
    assert send("PUT", "/api/model", path="bomb.py", text=f"{bomb}#", version=version) == 200
    assert send("POST", "/api/model/duplicate", path="bomb.py", to="other.py") == 200
    assert send("POST", "/api/model/rename", path="other.py", to="third.py") == 200
    assert (tmp_path / "third.py").is_file()
    assert not mark.exists()
