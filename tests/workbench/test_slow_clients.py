"""Who opens connections and does not say what is wanted does not keep others out."""

from __future__ import annotations

import asyncio
import socket
import time

import pytest
import uvicorn
import websockets

from tests.helpers.asgi_client import GATE, TOKEN
from workbench import auth
from workbench import server as workbench_server
from workbench.auth import Guard, Receive, Scope, Send
from workbench.server import config_of

SHORT = 0.3
LATE = 5 * SHORT
HOST = b"Host: 127.0.0.1:8000\r\n"
LET_IN = HOST + f"Authorization: Bearer {TOKEN}\r\n".encode()
POST = b"POST /x HTTP/1.1\r\n" + LET_IN + b"X-Workbench: 1\r\nContent-Type: application/json\r\nContent-Length: 100\r\n\r\n"


async def app(scope: Scope, receive: Receive, send: Send) -> None:
    """Takes its time, longer than a request may."""
    if scope["type"] == "websocket":
        await receive()
        await send({"type": "websocket.accept"})
        while (await receive())["type"] == "websocket.receive":
            await send({"type": "websocket.send", "text": "still there"})
    elif scope["type"] == "http":
        await asyncio.sleep(LATE)
        await send({"type": "http.response.start", "status": 200, "headers": []})
        await send({"type": "http.response.body", "body": b"late"})


HALVES = [
    b"",
    b"GET / HT",
    b"GET / HTTP/1.1\r\n" + HOST,
    b"GET / HTTP/1.1\r\n" + HOST + b"\r\nGET / HTTP/1.1\r\nHo",  # after one that is answered: 401
    b"POST / HTTP/1.1\r\n" + HOST + b"Content-Length: 100\r\n\r\nx",  # answered before it has come
    POST,
    POST + b"x" * 99,
]


async def drip(port: int, begin: bytes) -> bytes:
    """Says something, and then a little now and then; returns what it hears until it is sent away."""
    reader, writer = await asyncio.open_connection("127.0.0.1", port)
    writer.write(begin)
    heard = b""
    try:
        async with asyncio.timeout(60):
            while True:
                try:
                    async with asyncio.timeout(SHORT / 2):
                        part = await reader.read(1000)
                except TimeoutError:
                    writer.write(b"x" if begin.endswith(b"x") and len(begin) < len(POST) else b"")
                    continue
                if not part:
                    return heard
                heard += part
    except ConnectionError:
        return heard
    finally:
        writer.close()


async def ask(port: int) -> bytes:
    """Asks for something that takes long."""
    reader, writer = await asyncio.open_connection("127.0.0.1", port)
    writer.write(b"GET / HTTP/1.1\r\n" + LET_IN + b"Connection: close\r\n\r\n")
    heard = await reader.read()
    writer.close()
    return heard


async def talk(listening: socket.socket) -> list[bytes]:
    config = config_of(Guard(app, GATE))
    config.lifespan = "off"
    server = uvicorn.Server(config)
    serving_task = asyncio.create_task(server.serve(sockets=[listening]))
    port = listening.getsockname()[1]
    bearer = {"authorization": f"Bearer {TOKEN}"}
    while not server.started:
        await asyncio.sleep(0.01)
    raw = socket.create_connection(("127.0.0.1", port))
    async with websockets.connect("ws://127.0.0.1:8000/ws", sock=raw, additional_headers=bearer) as page:
        waiting = asyncio.create_task(ask(port))
        heard = await asyncio.gather(*(drip(port, half) for half in HALVES for _ in range(3)))
        assert (await waiting).endswith(b"\r\nlate\r\n0\r\n\r\n")
        end = time.monotonic() + LATE
        while time.monotonic() < end:
            await page.send("are you?")
            assert await page.recv() == "still there"
            await asyncio.sleep(SHORT)
    server.should_exit = True
    await serving_task
    return heard[::3]


@pytest.mark.slow
def test_only_connections_without_a_request_are_closed(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(workbench_server, "REQUEST_TIME", SHORT)
    monkeypatch.setattr(auth, "BODY_TIME", SHORT)
    with socket.create_server(("127.0.0.1", 0)) as listening:
        heard = asyncio.run(talk(listening))
    assert [one.partition(b"\r\n")[0].partition(b" ")[2][:3] for one in heard] == [b"", b"", b"", b"401", b"401", b"408", b"408"]
