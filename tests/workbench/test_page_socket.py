"""The page's websocket under rough use: wrong kinds of messages, too many, too long, and nobody who reads."""

from __future__ import annotations

import asyncio
import json
import time
from typing import Any, cast

import pytest
import websockets

from tests.helpers.workbench_server import Served
from tests.workbench.test_live import attached, heard, opened
from workbench.page_commands import COMMANDS
from workbench.page_commands.session import Restart, Stop
from workbench.sockets import LONGEST, MAX_PAGES, _Page


@pytest.fixture(scope="module")
def session(server: Served) -> str:
    return opened(server, "counting.py")


WRONG: list[Any] = [
    "",
    "{",
    "[]",
    "\0",
    '{"id": 1}',
    '{"id": 1, "command": {"type": "fly"}}',
    '{"id": -1, "command": {"type": "run"}}',
    b"\x00\xff",
    b'{"id": 1, "command": {"type": "run"}}',
    "null",
    "1e400",
    "[" * 50_000,
    '{"id": "1", "command": []}',
    json.dumps({"id": 1, "command": {"type": "step", "ticks": 10**30}}),
    json.dumps({"id": 1, "command": {"type": "step", "ticks": 1.5}}),
    json.dumps({"id": 1, "command": {"type": "seek", "time": "soon"}}),
    '{"id": 1, "command": {"type": "seek", "time": NaN}}',
    json.dumps({"id": 1, "command": {"type": "breakpoints", "productions": ["x"] * 201}}),
    json.dumps({"id": 1, "command": {"type": "explain", "at": -1}}),
    json.dumps({"id": 1, "command": {"type": "command", "word": "x", "named": {"a": {"b": 1}}}}),
    json.dumps({"id": 2**60, "command": {"type": "pause"}}),
    json.dumps({"type": "attach"}),
    json.dumps({"type": "attach", "session": 5}),
    json.dumps({"type": "attach", "session": "s1", "run": -1}),
    json.dumps({"type": "attach", "session": "s1", "more": 1}),
    '{"id": 1, "command": {"type": "\\ud800"}}',
]


@pytest.mark.daily(3)
@pytest.mark.parametrize("text", WRONG, ids=range(len(WRONG)))
def test_errors_are_reported(server: Served, session: str, text: str | bytes) -> None:
    async def talk() -> None:
        socket = await attached(server, session)
        await heard(socket, lambda message: "state" in message)
        await socket.send(text)
        told = await heard(socket, lambda message: "replies" in message or message["type"] == "refused")
        error = told.get("error") or told["replies"][0]["error"]
        assert error
        assert ("not binary data" in error) == isinstance(text, bytes)
        await socket.send(json.dumps({"id": 7, "command": {"type": "events", "most": 1}}))  # and it goes on
        assert (await heard(socket, lambda message: "replies" in message))["replies"][-1]["error"] is None
        await socket.close()

    asyncio.run(talk())


def test_a_page_is_not_shown_the_session_of_the_same_name_of_another_server(server: Served, session: str) -> None:
    async def first(**born: float) -> Any:
        async with await attached(server, session, queue=None, **born) as socket:
            return await heard(socket, lambda _: True)

    async def talk() -> None:
        born = (await first())["session"]["born"]
        assert (await first(born=born))["session"]["born"] == born
        assert await first(born=born - 3600) == {"type": "refused", "error": "there is no such session", "session": session}

    asyncio.run(talk())


def test_a_request_may_speak_of_attach(server: Served, session: str) -> None:
    async def talk() -> None:
        async with await attached(server, session) as socket:
            await socket.send(json.dumps({"id": 7, "command": {"type": "explain", "production": "attach"}}))
            told = await heard(socket, lambda message: "replies" in message)
            problem = "no production 'attach'; there are: none"
            assert told["replies"][0] == {"id": 7, "result": None, "error": problem, "loses": False, "field": None}

    asyncio.run(talk())


def test_a_reply_names_the_field_because_of_which_a_command_was_refused(server: Served, session: str) -> None:
    async def talk() -> None:
        async with await attached(server, session) as socket:
            for wanted, field in (({"time": 0}, "time"), ({"production": "trun"}, "production"), ({"pattern": "x"}, None)):
                await socket.send(json.dumps({"id": 7, "command": {"type": "until", **wanted}}))
                reply = (await heard(socket, lambda message: "replies" in message))["replies"][0]
                assert reply["field"] == field
                assert reply["error"].startswith(f"{field or 'until'}: ")

    asyncio.run(talk())


def test_a_page_can_ask_at_any_time_whether_the_workbench_is_there(server: Served, session: str) -> None:
    async def talk() -> None:
        address = f"ws://127.0.0.1:{server.port}/ws"
        headers = {"authorization": f"Bearer {server.token}", "origin": server.url}
        async with websockets.connect(address, additional_headers=headers) as socket:
            await socket.send('{"type":"ping"}')  # before it shows a session
            assert json.loads(await socket.recv()) == {"type": "pong"}
        async with await attached(server, session) as socket:
            await socket.send('{"type":"ping"}')
            assert await heard(socket, lambda message: message["type"] == "pong") == {"type": "pong"}
            await socket.send('{"type":"ping","more":1}')
            assert "more" in (await heard(socket, lambda message: "replies" in message))["replies"][0]["error"]

    asyncio.run(talk())


def test_a_session_that_does_not_exist_is_refused(server: Served, session: str) -> None:
    async def talk() -> None:
        socket = await attached(server, session)
        await socket.send(json.dumps({"type": "attach", "session": "none"}))
        assert (await heard(socket, lambda message: message["type"] == "refused"))["error"] == "there is no such session"
        await socket.close()

    asyncio.run(talk())


NONSENSE: list[Any] = [None, True, -1, 0.5, 10**30, "\ud800", "x" * 20_000, "<img src=x>", [], [[]], [None] * 300, {}, {"x": {}}]
LEFT_OUT = (Restart, Stop)
"""What ends the run that is spoken to."""
USUAL = {"name": "width", "memory": "memory", "value": 1, "word": "teleport", "time": 0.01, "view": "free", "shown": True}


def test_nonsense_in_any_field_of_any_command_is_reported_to_its_sender(server: Served, session: str) -> None:
    frames: dict[int, dict[str, Any]] = {}
    for kind in (kind for kind in COMMANDS.values() if kind not in LEFT_OUT):
        known = {"type": kind.model_fields["type"].default}
        known |= {name: USUAL[name] for name, field in kind.model_fields.items() if field.is_required()}
        for name in kind.model_fields:
            for value in NONSENSE:
                frames[len(frames)] = {**known, name: value}
        frames[len(frames)] = {**known, "more": 1}
    assert len(frames) > 500

    async def talk() -> None:
        socket = await attached(server, session)
        waiting = set(frames)
        for number, said in frames.items():
            await socket.send(json.dumps({"id": number, "command": said}))
            if number % 20 == 19 or number == len(frames) - 1:  # no more may wait at once than so many
                while any(earlier in waiting for earlier in range(number + 1)):
                    told = await heard(socket, lambda message: "replies" in message)
                    waiting -= {reply["id"] for reply in told["replies"]}
        await socket.close()

    asyncio.run(talk())
    assert server.get(f"/api/sessions/{session}").json()["session"]["alive"]
    assert server.post(f"/api/sessions/{session}/command", {"command": {"type": "speed", "factor": None}}).status_code == 200


def test_a_message_that_is_too_long_ends_the_connection_with_the_reason(server: Served, session: str) -> None:
    async def talk() -> None:
        socket = await attached(server, session)
        await socket.send("x" * (LONGEST + 1))
        with pytest.raises(websockets.ConnectionClosed, match="at most 100,000 characters, not 100,001"):
            await heard(socket, lambda message: "replies" in message)

    asyncio.run(talk())


@pytest.mark.slow
def test_who_asks_without_end_and_reads_nothing_is_sent_away(server: Served, session: str) -> None:
    async def talk() -> None:
        bearer = {"authorization": f"Bearer {server.token}"}
        address = f"ws://127.0.0.1:{server.port}/ws"
        async with websockets.connect(address, additional_headers=bearer, max_size=None, max_queue=1, close_timeout=1) as socket:
            await socket.send(json.dumps({"type": "attach", "session": session}))
            question = json.dumps({"id": 1, "command": {"type": "events", "most": 20_000}})

            async def ask_on() -> None:
                while True:
                    await socket.send(question)

            with pytest.raises(websockets.ConnectionClosed):
                await asyncio.wait_for(ask_on(), 60)

    asyncio.run(talk())
    assert server.get(f"/api/sessions/{session}").status_code == 200


def test_there_is_a_bound_to_pages(server: Served, session: str) -> None:
    async def talk() -> None:
        sockets = [await attached(server, session) for _ in range(MAX_PAGES)]
        with pytest.raises((websockets.ConnectionClosed, websockets.InvalidStatus)):
            await (await attached(server, session)).recv()
        for socket in sockets:
            await socket.close()
        end = time.monotonic() + 60
        while server.get(f"/api/sessions/{session}").json()["session"]["watching"]:
            assert time.monotonic() < end
            await asyncio.sleep(0.05)
        again = await attached(server, session)
        assert "state" in await heard(again, lambda message: "state" in message)
        await again.close()

    asyncio.run(talk())


def test_showing_one_session_after_the_other_leaves_nothing_behind(server: Served, session: str) -> None:
    async def talk() -> None:
        socket = await attached(server, session)
        for _ in range(200):
            await socket.send(json.dumps({"type": "attach", "session": session}))
        await socket.send(json.dumps({"id": 1, "command": {"type": "events", "most": 1}}))
        await heard(socket, lambda message: "replies" in message)
        assert len(server.get(f"/api/sessions/{session}").json()["session"]["watching"]) == 1
        await socket.close()

    asyncio.run(talk())


def test_a_page_whose_updates_cannot_be_made_is_disconnected() -> None:
    closed: list[int] = []

    class Socket:
        """Takes the place of the browser's websocket."""

        async def close(self, code: int, _: str) -> None:
            closed.append(code)

    class Broken:
        """Takes the place of a feed."""

        async def next(self) -> bytes:
            raise RuntimeError("dictionary changed size during iteration")

    page: Any = _Page(cast("Any", Socket()), cast("Any", None))
    asyncio.run(page._send(Broken()))
    assert closed == [1011]
