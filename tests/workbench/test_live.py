"""The workbench as it is started: its command, its REST interface, its websockets and viser behind them."""

from __future__ import annotations

import asyncio
import errno
import json
import os
import re
import signal
import socket
import subprocess
import sys
import time
from collections.abc import Callable, Iterator
from contextlib import suppress
from pathlib import Path
from typing import Any

import httpx
import pytest
import websockets
from hypothesis import HealthCheck, given, settings
from hypothesis.strategies import one_of
from websockets.typing import Subprotocol

from tests.helpers.full_disk import full_disk
from tests.helpers.paths import MODELS
from tests.helpers.workbench_server import Served, served
from tests.workbench.test_bad_input import APP, DESCRIPTION, OPERATIONS
from workbench import cli
from workbench.auth import UPLOAD_TYPE
from workbench.cli import listen, listen_for, main, port_of
from workbench.page_commands import COMMANDS

# -- the command


def test_the_address_is_the_last_line_and_printed_once(server: Served) -> None:
    assert server.lines == [f"models: {server.folder}", server.address]
    assert len(server.token) >= 32


def test_the_token_is_in_no_list_of_processes(server: Served) -> None:
    if sys.platform != "linux":
        pytest.skip("there is no /proc")
    for folder in Path("/proc").glob("[0-9]*"):
        for name in ("cmdline", "environ"):
            try:
                assert server.token.encode() not in (folder / name).read_bytes(), folder
            except OSError:
                continue


def test_a_full_disk_is_said_in_plain_words(server: Served) -> None:
    headers = {"content-type": UPLOAD_TYPE}
    with full_disk(lambda: [server.process.pid]):
        answer = server.client.post(f"{server.url}/api/recordings/import?name=x", content=b"a recording", headers=headers)
    assert (answer.status_code, answer.json()) == (409, {"error": "File too large"})


def test_a_browser_comes_in_with_the_address_only(server: Served) -> None:
    with httpx.Client() as browser:
        assert browser.get(server.url).status_code == 401
        answer = browser.get(server.address)
        assert answer.status_code == 303
        assert browser.get(server.url + answer.headers["location"]).status_code == 200
        assert server.token not in answer.headers["location"]


def test_others_are_let_in_only_with_a_warning(tmp_path: Path) -> None:
    with served(tmp_path / "models", "--host", "0.0.0.0", "--name", "lab.example") as running:
        assert running.lines[0].startswith("warning: others can reach 0.0.0.0")
        local = f"http://127.0.0.1:{running.port}"
        assert httpx.get(local).status_code == 401
        for host, status in (("lab.example", 200), ("127.0.0.1", 200), ("evil.example", 421)):
            answer = running.client.get(f"{local}/api/models", headers={"host": f"{host}:{running.port}"})
            assert answer.status_code == status


@pytest.mark.parametrize("options", [["--port", "70000"], ["--memory", "-1"], ["--port", "x"]])
def test_wrong_options_are_reported(options: list[str], capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as left:
        main(options)
    assert left.value.code == 2
    assert "error" in capsys.readouterr().err


def test_a_port_in_use_is_reported(server: Served) -> None:
    done = subprocess.run([sys.executable, "-m", "workbench", "--port", str(server.port)], capture_output=True, text=True)
    assert (done.returncode, done.stdout) == (1, "")
    assert done.stderr == f"error: cannot listen at 127.0.0.1, port {server.port}: Address already in use\n"


def test_a_models_folder_has_the_same_port_each_time_and_another_one_only_if_that_is_taken(tmp_path: Path) -> None:
    (tmp_path / "same").symlink_to(tmp_path)
    assert port_of(tmp_path) == port_of(tmp_path / "same") != port_of(tmp_path / "other")
    folder = next(folder for n in range(100) if _is_free(port_of(folder := tmp_path / str(n))))
    for _ in range(2):
        with listen_for(folder, "127.0.0.1", None) as first, listen_for(folder, "127.0.0.1", None) as second:
            assert first.getsockname()[1] == port_of(folder) != second.getsockname()[1]


def test_a_workbench_that_does_not_get_the_usual_port_says_why(server: Served, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cli, "PORTS", [server.port])
    said = cli.other_port_warning(server.folder, "127.0.0.1", 1234)
    assert f"port {server.port}, the usual one of this folder, is taken by another workbench, most likely with the same folder" in said
    assert "This workbench has port 1234 instead: its page has settings of its own" in said
    monkeypatch.setattr(cli, "PROBE_TIME", 0.01)
    with listen("127.0.0.1", 0) as other:
        port: int = other.getsockname()[1]
        monkeypatch.setattr(cli, "PORTS", [port])
        assert f"port {port}, the usual one of this folder, is taken by another program." in cli.other_port_warning(
            tmp_path, "127.0.0.1", 1
        )


def _is_free(port: int) -> bool:
    try:
        listen("127.0.0.1", port).close()
    except OSError:
        return False
    return True


def test_a_host_that_cannot_be_listened_at_is_reported(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "workbench", str(tmp_path), "--host", "203.0.113.1"]  # an address for documentation
    done = subprocess.run(command, capture_output=True, text=True)
    assert (done.returncode, done.stdout) == (1, "")
    assert done.stderr == f"error: cannot listen at 203.0.113.1: {os.strerror(errno.EADDRNOTAVAIL)}\n"


@pytest.fixture
def kept_signals() -> Iterator[None]:
    """The handler of SIGINT, which the command replaces for its process."""
    before = signal.getsignal(signal.SIGINT)
    yield
    signal.signal(signal.SIGINT, before)


@pytest.mark.parametrize(
    ("named", "told"), [("file", "'{}' cannot be used: it is a file"), ("file/inside", "'{}' cannot be used: Not a directory")]
)
def test_a_models_folder_that_cannot_be_had_is_named(
    tmp_path: Path, named: str, told: str, kept_signals: None, capsys: pytest.CaptureFixture[str]
) -> None:
    (tmp_path / "file").write_text("x", encoding="utf-8")
    assert main([str(tmp_path / named)]) == 1
    assert capsys.readouterr() == ("", f"error: the models folder {told.format(tmp_path / named)}\n")


def test_the_server_answers_before_it_has_loaded_what_only_runs_and_their_views_need() -> None:
    text = "import sys, workbench.cli, workbench.app, workbench.server; print(*{name.partition('.')[0] for name in sys.modules})"
    loaded = subprocess.run([sys.executable, "-c", text], capture_output=True, text=True, check=True).stdout.split()
    assert not {"numba", "scipy", "viser", "mjviser", "trimesh"} & set(loaded)
    assert "fastapi" in loaded


def test_answers_are_sent_at_once() -> None:
    """Without TCP_NODELAY, each answer on a connection waits until the browser has acknowledged the one before: 40 ms on Linux."""

    async def delays() -> bool:
        def note(reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
            found.set_result(writer.get_extra_info("socket").getsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY) == 0)
            writer.close()

        found: asyncio.Future[bool] = asyncio.get_running_loop().create_future()
        listening = listen("127.0.0.1", 0)
        async with await asyncio.start_server(note, sock=listening):
            _, writer = await asyncio.open_connection(*listening.getsockname())
            result = await found
            writer.close()
            return result

    assert not asyncio.run(delays())


# -- REST


def opened(server: Served, model: str = "doorway.py") -> str:
    """Begins a session and returns its name, when its run waits."""
    name: str = server.post("/api/sessions", {"model": model, "seed": 1}).json()["id"]
    until(server, name, "paused")
    return name


def until(server: Served, name: str, status: str) -> dict[str, Any]:
    end = time.monotonic() + 60
    told: dict[str, Any] = {}
    while time.monotonic() < end:
        told = server.get(f"/api/sessions/{name}").json()
        if told["state"] is not None and told["state"]["status"] == status:
            return told
        time.sleep(0.02)
    raise AssertionError(told)


def test_a_session_by_rest_alone(server: Served) -> None:
    name = opened(server)
    assert server.post(f"/api/sessions/{name}/command", {"command": {"type": "run"}}).json() == {"result": None, "error": None}
    assert until(server, name, "ended")["state"]["time"] == 6.8
    refused = server.post(f"/api/sessions/{name}/command", {"command": {"type": "run"}})
    assert (refused.status_code, "over" in refused.json()["error"]) == (409, True)
    told = server.post(f"/api/sessions/{name}/command", {"command": {"type": "events", "kinds": ["fire"]}}).json()["result"]
    assert told["events"][0][3]["production"] == "look"
    recording = server.get(f"/api/sessions/{name}").json()["session"]["recording"]
    assert server.post(f"/api/sessions/{name}/close").status_code == 200
    assert server.get(f"/api/sessions/{name}").status_code == 404
    listed = {one["id"]: one for one in server.get("/api/recordings").json()["recordings"]}
    assert (listed[recording]["ended"], listed[recording]["model"]) == ("stop", "doorway.py")
    file = f"/api/recordings/{recording}/file"
    assert server.get(file).content.startswith(b"SQLite format 3")
    events = server.get(file, params={"form": "events.csv"}).text.splitlines()
    assert events[0] == "time [s],source,kind,data"
    assert len(events) == listed[recording]["events"] + 1
    states = server.get(file, params={"form": "states.csv"}).text.splitlines()
    assert len(states) == 682
    replay = server.get(file, params={"form": "replay.html"})
    assert replay.text.startswith("<!doctype html>")
    assert replay.headers["content-disposition"] == f'attachment; filename="{recording}.replay.html"'
    assert states[-1].startswith("6.8,")
    told = server.get(f"/api/recordings/{recording}/curves", params={"name": ["walker_torso_yaw", "no"], "most": 100}).json()
    speed = {"name": "walker_torso_yaw speed", "unit": "deg/s", "group": "joint speed", "of": None, "shape": "line"}
    assert speed in told["names"]
    ((name, curve),) = told["curves"].items()
    assert (name, told["times"][0], told["times"][-1]) == ("walker_torso_yaw", 0.0, 6.8)
    assert 90 <= len(curve) == len(told["times"]) <= 100
    assert max(abs(angle) for angle in curve) > 40  # it turns its shoulders
    assert server.post(f"/api/recordings/{recording}/replay").json()["verdict"] == "agrees"


def test_two_recordings_are_compared(server: Served) -> None:
    names: list[str] = []
    for width in (0.5, 0.9):
        session = server.post("/api/sessions", {"model": "doorway.py", "seed": 1, "settings": {"width": width}, "run": True}).json()["id"]
        until(server, session, "ended")
        names.append(server.get(f"/api/sessions/{session}").json()["session"]["recording"])
        server.post(f"/api/sessions/{session}/close")
    told = server.post("/api/compare", {"first": names[0], "second": names[1]}).json()
    assert told["parameters"] == {"width": [0.5, 0.9]}
    first, second = told["difference"]["events"]
    assert first[0] == second[0] == round(told["difference"]["time"] * 1e6)
    assert told["same_events"] > 5
    assert told["changed"] == [{}, {}]
    assert told["units"]["width"] == "m"
    same = server.post("/api/compare", {"first": names[0], "second": names[0]}).json()
    assert (same["difference"], same["parameters"]) == (None, {})
    for name in names:
        assert server.post(f"/api/recordings/{name}/delete").status_code == 200
        assert server.get(f"/api/recordings/{name}").status_code == 404


@pytest.mark.parametrize("name", ["..", "../x", "%2e%2e", "%2e%2e%2fx", "..%2Fx", ".hidden", "x" * 150, "a%20b", "x.sqlite"])
def test_recordings_lie_in_their_folder(server: Served, name: str) -> None:
    """Of recordings that lie elsewhere, or have names that none has, no byte is sent, and they are not deleted."""
    folder = server.folder / ".workbench" / "recordings"
    folder.mkdir(parents=True, exist_ok=True)
    outside = [folder.parent / "x.sqlite", folder / ".hidden.sqlite", folder / "a b.sqlite"]
    for path in outside:
        path.write_text("not for others", encoding="utf-8")
    for method, what, status in (("GET", "file", (404,)), ("POST", "delete", (404, 405))):
        answer = server.client.request(method, httpx.URL(server.url, raw_path=f"/api/recordings/{name}/{what}".encode()))
        assert answer.status_code in status
        assert "not for others" not in answer.text
    assert all(path.exists() for path in outside)
    for path in outside:
        path.unlink()


@pytest.mark.daily(4)
@pytest.mark.parametrize(("method", "path"), OPERATIONS)
def test_no_input_gives_an_error_of_the_server(method: str, path: str, server: Served) -> None:
    import schemathesis  # takes a second to load

    schemathesis.serializer.alias("application/vnd.sqlite3", "application/octet-stream")
    schema: Any = schemathesis.openapi.from_dict(DESCRIPTION)
    asked = schema[path][method]

    @given(one_of([asked.as_strategy(generation_mode=mode) for mode in schemathesis.GenerationMode]))
    @settings(max_examples=6, deadline=None, suppress_health_check=[HealthCheck.too_slow, HealthCheck.filter_too_much])
    def answers(case: Any) -> None:
        answer = case.call(base_url=server.url, headers=server.headers, timeout=60)
        assert answer.status_code < 500, answer.text
        assert answer.status_code != 401

    answers()


def test_a_check_that_loads_a_text_checks_the_productions_of_its_agents(server: Served) -> None:
    doorway = (MODELS / "doorway.py").read_text(encoding="utf-8")
    first, mark, rest = doorway.rpartition("goal.set(")
    text = f"{first}{mark.replace('goal', 'gaol')}{rest}"
    problems = server.post("/api/check", {"path": "checked.py", "text": text, "load": True}).json()["problems"]
    (problem,) = problems
    assert problem["level"] == "warning"
    assert "nothing defines 'gaol'; did you mean 'goal'?" in problem["message"]
    assert "gaol" in text.split("\n")[problem["line"] - 1]


@pytest.mark.parametrize("load", [False, True])
def test_a_check_names_what_nothing_defines_whether_it_loads_the_text_or_not(load: bool, server: Served) -> None:
    text = "from actr3d.actr import *\nclass Agent(ACTR):\n    memory = Mem\n"
    problems = server.post("/api/check", {"path": "checked.py", "text": text, "load": load}).json()["problems"]
    assert {"level": "warning", "message": "nothing defines 'Mem'; did you mean 'Memory'?", "line": 3} in problems


@pytest.mark.parametrize("load", [False, True])
def test_a_check_names_a_misspelt_slot_of_a_feature_once_whether_it_loads_the_text_or_not(load: bool, server: Served) -> None:
    head = "from actr3d.actr import *\nfrom actr3d.vision import Vision\nclass Agent(ACTR):\n"
    head += "    visual = Buffer()\n    vision = Vision(visual)\n"
    text = f"{head}    def p(visual='feature:obstacle leftmos:?left'): self.stop()\nAgent().run(1)\n"
    (problem,) = server.post("/api/check", {"path": "checked.py", "text": text, "load": load}).json()["problems"]
    message = "production 'p': no chunk of the feature 'obstacle' has a slot 'leftmos'; did you mean 'leftmost'?"
    assert problem == {"level": "warning", "message": message, "line": 6}


HOSTILE = [
    "../../etc/passwd",
    "..%2f..%2fetc%2fpasswd",
    "/etc/passwd",
    "a\0b.py",
    "%00",
    "x" * 3900,
    "é\u202e.py",
    "con:1.py",
]
PLACES = ["/api/sessions/{}", "/api/recordings/{}", "/api/recordings/{}/file", "/api/recordings/{}/curves", "/viser/{}/", "/static/now/{}"]


@pytest.mark.daily(3)
@pytest.mark.parametrize("path", HOSTILE, ids=range(len(HOSTILE)))
def test_hostile_paths_are_refused_on_every_route(path: str, server: Served) -> None:
    told = [
        server.get("/api/model", params={"path": path}),
        server.put("/api/model", {"path": path, "text": "", "version": "x"}),
        server.post("/api/model/duplicate", {"path": "doorway.py", "to": path + "/x.py" if "." not in path else path}),
        server.post("/api/model/rename", {"path": path, "to": "y.py"}),
        server.post("/api/model/delete", {"path": path}),
        server.post("/api/check", {"path": path + "/..", "text": "x = 1"}),
        server.post("/api/sessions", {"model": path}),
        server.post("/api/compare", {"first": path, "second": path}),
    ]
    for answer in told[:2] + told[3:]:
        assert 400 <= answer.status_code < 500, (answer.request.url, answer.text)
    assert told[2].status_code < 500
    raw = path.replace("\0", "%00").encode().decode("latin-1").encode("ascii", "ignore").decode()
    for place in PLACES:
        assert server.get(place.format(raw)).status_code < 500
        assert "root:" not in server.get(place.format(raw)).text


def test_every_route_is_in_the_description_or_is_a_page(server: Served) -> None:
    from tests.workbench.test_auth import routes

    described = set(server.get("/api/openapi.json").json()["paths"])
    known = {route.path for route in routes(APP) if "/api" in route.path}
    assert known - described == {"/api/openapi.json"}
    assert set(DESCRIPTION["paths"]) == described


def test_the_description_names_every_command(server: Served) -> None:
    told = server.get("/api/openapi.json").json()
    assert {command.__name__ for command in COMMANDS.values()} <= told["components"]["schemas"].keys()
    assert told["components"]["schemas"]["Speed"]["properties"]["factor"]["anyOf"][0]["minimum"] == 0.05


# -- websockets


async def attached(server: Served, session: str, queue: int | None = None, **known: float | None) -> Any:
    """Returns a websocket that shows a session; where it may queue no more than so many messages, whoever does not read it is frozen."""
    bearer = {"authorization": f"Bearer {server.token}"}
    more: dict[str, Any] = {"max_size": 5_000_000, "max_queue": queue, "close_timeout": 1}
    socket = await websockets.connect(f"ws://127.0.0.1:{server.port}/ws", additional_headers=bearer, **more)
    await socket.send(json.dumps({"type": "attach", "session": session, **known}))
    return socket


async def heard(socket: Any, condition: Callable[[Any], Any]) -> Any:
    """Returns the first message of which something is true."""
    async with asyncio.timeout(60):
        while True:
            message = json.loads(await socket.recv())
            if condition(message):
                return message


def tick_of(message: dict[str, Any]) -> int | None:
    return message["state"]["tick"] if message.get("state") else None


def test_two_pages_see_the_same_and_show_which_one_controls(server: Served) -> None:
    name = opened(server)

    async def talk() -> None:
        one, other = await attached(server, name), await attached(server, name)
        await heard(one, lambda message: len(message.get("session", {}).get("watching", ())) == 2)
        await one.send(json.dumps({"id": 4, "command": {"type": "step", "ticks": 30}}))
        for page in (one, other):
            await heard(page, lambda message: tick_of(message) == 30 and message["state"]["status"] == "paused")
        await other.send(json.dumps({"id": 5, "command": {"type": "explain", "production": "turn"}}))
        told = await heard(other, lambda message: "replies" in message)
        assert told["replies"][0]["id"] == 5
        assert told["replies"][0]["result"][0]["productions"][0]["name"] == "turn"
        told = json.loads(server.get(f"/api/sessions/{name}").text)
        assert told["session"]["controlled_by"].startswith("page ")
        await one.close()
        await heard(other, lambda message: message.get("session", {}).get("controlled_by") == "")  # nobody controls who is not there
        again = await attached(server, name)
        first = json.loads(await again.recv())
        assert first["state"]["tick"] == 30
        assert first["events"]["first"] == 0
        known = len(first["events"]["list"])
        await again.close()
        last = await attached(server, name, run=first["run"], epoch=first["epoch"], events=known)
        assert "events" not in json.loads(await last.recv())
        await last.close()
        await other.close()

    asyncio.run(talk())
    server.post(f"/api/sessions/{name}/close")


@pytest.mark.slow
def test_a_frozen_browser_delays_no_other(server: Served) -> None:
    (server.folder / "busy.py").write_text(
        "from actr3d.actr import *\nclass Busy(ACTR):\n    goal = Buffer()\n    def init():\n        goal.set('n:0')\n"
        "    def go(goal='n:?n'):\n        goal.set('n:' + str(int(n) + 1) + ' text:' + 'x' * 2000)\nBusy().run(2000)\n",
        encoding="utf-8",
    )
    name = opened(server, "busy.py")

    async def talk() -> None:
        frozen = await attached(server, name, queue=1)  # it reads nothing from now on
        await frozen.send(json.dumps({"id": 1, "command": {"type": "run"}}))
        other = await attached(server, name)
        await heard(other, lambda message: "state" in message and message["state"]["status"] == "ended")
        await other.close()
        await frozen.close()

    asyncio.run(talk())
    server.post(f"/api/sessions/{name}/close")


# -- viser


def scene_of(server: Served) -> str:
    name = opened(server)
    end = time.monotonic() + 60
    while not server.get(f"/api/sessions/{name}").json()["session"].get("world"):
        assert time.monotonic() < end
        time.sleep(0.05)
    return name


def viser_ports(server: Served) -> list[int]:
    """Returns the other ports on which the server listens."""
    listening: list[int] = []
    inodes: set[str] = set()
    for link in Path(f"/proc/{server.process.pid}/fd").iterdir():
        with suppress(FileNotFoundError):  # the server closes and opens others meanwhile
            inodes.add(link.readlink().name)
    for line in Path(f"/proc/{server.process.pid}/net/tcp").read_text(encoding="ascii").splitlines()[1:]:
        fields = line.split()
        if fields[3] == "0A" and f"socket:[{fields[9]}]" in inodes:
            assert fields[1].startswith("0100007F")  # loopback, and nothing else
            listening.append(int(fields[1].partition(":")[2], 16))
    return [port for port in listening if port != server.port]


def test_viser_is_behind_the_login_and_nowhere_else(server: Served) -> None:
    import viser

    name = scene_of(server)
    before = viser_ports(server) if sys.platform == "linux" else []
    page = server.get(f"/viser/{name}/")
    assert "connect-src 'self' data: blob:" in page.headers["content-security-policy"]
    assert re.search('src="/static/[0-9a-f]{16}/viser_shim.js"', page.text)
    protocol = [Subprotocol(f"viser-v{viser.__version__}")]

    async def talk() -> None:
        address = f"ws://127.0.0.1:{server.port}/viser/{name}"
        with pytest.raises(websockets.InvalidStatus):
            await websockets.connect(address, subprotocols=protocol)
        bearer = {"authorization": f"Bearer {server.token}"}
        with pytest.raises(websockets.InvalidStatus):
            await websockets.connect(address, subprotocols=protocol, additional_headers=bearer, origin="http://evil.example")  # type: ignore[arg-type] # pyright: ignore[reportArgumentType]
        async with websockets.connect(address, subprotocols=protocol, additional_headers=bearer, max_size=None, open_timeout=60) as socket:
            assert socket.subprotocol == protocol[0]
            assert isinstance(await socket.recv(), bytes)
        if sys.platform == "linux":
            assert len(viser_ports(server)) == len(before) + 1, "viser begins when somebody looks"
            for port in viser_ports(server):  # whoever finds viser's own port is sent away
                with pytest.raises(websockets.ConnectionClosed):
                    async with websockets.connect(f"ws://127.0.0.1:{port}", subprotocols=protocol, max_size=None) as socket:
                        await socket.recv()

    asyncio.run(talk())
    shown = server.get("/viser/?panel=hidden", follow_redirects=True)
    assert (shown.status_code, shown.url.query) == (200, b"panel=hidden")
    server.post(f"/api/sessions/{name}/close")
    assert server.get(f"/viser/{name}/").status_code == 404


def test_viser_does_not_accept_requests_to_share_its_address() -> None:
    from viser import _messages

    from workbench.viser_server import start_viser

    viser_server = start_viser("secret")
    handlers = viser_server._websock_server._incoming_handlers
    assert _messages.ShareUrlRequest not in handlers
    assert _messages.ShareUrlDisconnect not in handlers
    viser_server.stop()
