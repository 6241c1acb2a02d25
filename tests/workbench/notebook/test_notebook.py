"""A simulation that cells of a notebook run, and its page: both show the same at every moment."""

from __future__ import annotations

import ast
import asyncio
import gc
import importlib.metadata
import json
import pickle
import re
import socket
import sys
import tempfile
import weakref
from collections.abc import Callable, Coroutine
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing, suppress
from http.client import HTTPConnection
from pathlib import Path
from typing import Any

import pytest
from starlette.types import Receive, Scope, Send

from actr3d.actr import ACTR, Buffer, Model
from actr3d.errors import NotebookError
from actr3d.recording import Recorded
from actr3d.simulation import Simulation
from actr3d.world import Aperture, Floor, Scene, Wall
from tests.helpers.asgi_client import HOST, Answer, ask
from tests.helpers.manual import FENCE, ROOT, compare
from tests.helpers.walkers import driving
from workbench.auth import Gate, Guard, Token
from workbench.notebook import widget
from workbench.notebook.live_run import LiveRun
from workbench.notebook.server import NotebookWorker
from workbench.page_commands.changes import SimulationCommand, Undo
from workbench.page_commands.running import Pause, Run, Seek, Speed, Step
from workbench.worker.messages import (
    FROM_WORKER,
    LENGTH,
    CommandMessage,
    EventsRemoved,
    Facts,
    FromWorker,
    NewEvents,
    Start,
    State,
    WorkerEnded,
    framed,
)


class Counting(Model):
    """Counts tenths of a second in a buffer."""

    def start(self) -> Any:
        agent: Any = self.parent
        for number in range(1000):
            agent.goal.set(f"count {number}")
            yield 0.1


class Counter(ACTR):
    goal = Buffer()
    counting = Counting()


def counter() -> Simulation:
    scene = Scene(parts=(Floor(), Aperture(name="aperture", width=0.6), Wall(name="wall", start=(3, 1), end=(3, 2))))
    return Simulation(scene, bodiless={"counter": Counter}, seed=1)


class Server:
    """The other end of the wire of a run: what the notebook's server is sent."""

    def __init__(self, simulation: Simulation) -> None:
        self._wire, its_end = socket.socketpair()
        weakref.finalize(self, self._wire.close)
        self._wire.settimeout(10)
        self._wire.sendall(framed(Start()))
        self.messages: list[FromWorker] = []
        self.run: Callable[[], LiveRun | None] = weakref.ref(LiveRun(simulation, its_end, asyncio.get_running_loop()))

    def hear(self) -> FromWorker:
        """Returns the next message."""
        size = int.from_bytes(self._exactly(LENGTH), "big")
        self.messages.append(FROM_WORKER.decode(self._exactly(size)))
        return self.messages[-1]

    def _exactly(self, size: int) -> bytes:
        data = b""
        while len(data) < size:
            part = self._wire.recv(size - len(data))
            assert part
            data += part
        return data

    def state(self, time: float) -> State:
        """Returns the first paused state of a time."""
        while True:
            message = self.hear()
            if isinstance(message, State) and message.time == time and message.status == "paused":
                return message

    def say(self, command: Any) -> None:
        self._wire.sendall(framed(CommandMessage(id=1, command=pickle.dumps(command))))

    def events(self) -> list[int]:
        """Returns the number of each event that the server holds now."""
        held: list[int] = []
        for message in self.messages:
            if isinstance(message, NewEvents):
                held += range(message.first, message.first + len(message.events))
            elif isinstance(message, EventsRemoved):
                held = [number for number in held if number < message.events]
        return held


def in_notebook(cells: Callable[[], Coroutine[Any, Any, None]]) -> None:
    """Runs a coroutine as cells run in a notebook: in the thread of an event loop."""
    asyncio.run(cells())


def test_a_page_shows_what_a_cell_has_left_before_the_cell_is_over() -> None:
    async def cells() -> None:
        simulation = counter()
        server = Server(simulation)
        facts = server.hear()
        assert isinstance(facts, Facts)
        assert facts.mj_model is not None
        assert {"move", "aperture", "set_buffer"} <= {change["word"] for change in json.loads(facts.changes)}
        world = json.loads(facts.world)
        assert (world["objects"], world["widths"]) == (["wall"], {"aperture": [0, 300]})  # what these changes are of
        simulation.run(0.5)  # no turn of the event loop from here on
        assert json.loads(server.state(0.5).parts)["counter.goal"]["chunk"] == {"0": "count", "1": "5"}
        simulation.seek(0.2)
        shown = server.state(0.2)
        assert shown.furthest == 0.5
        simulation.command("aperture", 0.9)  # another future
        changed = server.state(0.2)
        assert (changed.furthest, changed.apertures) == (0.2, {"aperture": pytest.approx(0.9)})
        simulation.run(0.5)
        assert server.state(0.7).events == len(server.events()) == len(simulation.trace or ())
        assert server.events() == list(range(len(server.events())))

    in_notebook(cells)


def test_ticks_by_hand_are_shown_once_the_cell_is_over() -> None:
    async def cells() -> None:
        simulation = counter()
        server = Server(simulation)
        for _ in range(3):
            simulation.tick()
            simulation.tock()
        await asyncio.sleep(0)
        assert server.state(0.03).reason == "by a cell"

    in_notebook(cells)


def test_a_page_runs_the_simulation_between_cells() -> None:
    async def cells() -> None:
        simulation = counter()
        server = Server(simulation)
        server.say(Step(ticks=2))
        while simulation.time != 0.02:
            await asyncio.sleep(0.01)
        await asyncio.sleep(0.01)
        assert server.state(0.02).reason == "after a step"
        server.say(Run())
        while simulation.time < 0.1:
            await asyncio.sleep(0.01)
        simulation.run(0.1)  # a cell takes over
        left = simulation.time
        await asyncio.sleep(0.05)
        assert simulation.time == left
        server.say(Pause())
        server.state(round(left, 6))

    in_notebook(cells)


def test_a_page_changes_and_undoes_and_no_cell_is_said_to_have_done_it() -> None:
    async def cells() -> None:
        simulation = counter()
        server = Server(simulation)
        simulation.run(0.3)
        server.say(Seek(time=0.1))
        change = SimulationCommand(word="aperture", values=(0.9,), drop=True)
        for speed, (command, reason) in enumerate(
            ((change, "changed at 0.10 s; the rest was lost"), (Undo(), "undone at 0.10 s")), start=2
        ):
            server.say(command)
            await asyncio.sleep(0.05)
            server.say(Speed(factor=speed))  # shows the state once more
            await asyncio.sleep(0.05)
            while (state := server.state(0.1)).wanted != speed:
                pass
            assert state.reason == reason
        assert len(simulation.timeline.commands) == 0

    in_notebook(cells)


def test_a_run_that_has_begun_is_shown_from_its_start() -> None:
    async def cells() -> None:
        simulation = counter()
        simulation.run(0.4)
        simulation.seek(0.3)
        server = Server(simulation)
        assert server.state(0.3).furthest == 0.4
        assert simulation.time == 0.3
        assert server.events() == list(range(len(simulation.trace or ()))) != []

    in_notebook(cells)


@pytest.mark.slow
def test_a_run_that_has_begun_has_the_curves_of_one_that_was_shown_from_its_start() -> None:
    async def cells() -> None:
        told: list[Any] = []
        for begun in (1.2, 0.0):  # states and answers of the first second are stored, so that going back needs no physics
            simulation = driving()
            simulation.run(begun)
            run = Server(simulation).run()
            assert run is not None
            simulation.run(1.3 - begun)
            told.append(run.curves(None, 0.0, None, 5_000))
        assert told[0] == told[1]
        assert len(told[0]["times"]) == 131

    in_notebook(cells)


def test_a_simulation_that_fails_in_a_cell_is_shown_as_failed() -> None:
    class Failing(Model):
        def start(self) -> Any:
            yield 0.1
            raise ValueError("no more")

    class Agent(ACTR):
        failing = Failing()

    async def cells() -> None:
        simulation = Simulation(Scene(), bodiless={"agent": Agent}, seed=1)
        server = Server(simulation)
        with pytest.raises(ValueError, match="no more"):
            simulation.run(1)
        while not (isinstance(message := server.hear(), State) and message.status == "failed"):
            pass

    in_notebook(cells)


def test_a_simulation_without_references_ends_its_run() -> None:
    async def cells() -> None:
        simulation = counter()
        server = Server(simulation)
        simulation.run(0.1)
        await asyncio.sleep(0)
        del simulation
        gc.collect()
        assert server.run() is None
        while not isinstance(server.hear(), WorkerEnded):
            pass

    in_notebook(cells)


def test_a_kernel_that_is_restarted_ends_its_runs_as_one_that_says_so() -> None:
    async def restart() -> list[FromWorker | None]:
        wire, its_end = socket.socketpair()
        worker = await NotebookWorker.at(its_end)
        wire.close()
        return [await worker.receive(), await worker.receive()]

    assert asyncio.run(restart()) == [WorkerEnded(), None]


def test_the_widget_needs_its_package_and_a_notebook(monkeypatch: pytest.MonkeyPatch) -> None:
    with pytest.raises(NotebookError, match="for notebooks"):
        counter().show()

    class Missing:
        def load(self) -> Any:
            raise ModuleNotFoundError(name="anywidget")

    def missing(**_: str) -> list[Missing]:
        return [Missing()]

    monkeypatch.setattr(importlib.metadata, "entry_points", missing)
    with pytest.raises(NotebookError, match=r"'anywidget': pip install 'actr3d\[notebook\]'"):
        counter().show()


async def nothing(scope: Scope, receive: Receive, send: Send) -> None:
    """Answers with nothing."""
    await send({"type": "http.response.start", "status": 200, "headers": []})
    await send({"type": "http.response.body", "body": b""})


def test_a_ticket_admits_one_browser_and_one_page_around_the_workbench() -> None:
    gate = Gate(token=Token(), port=8000)
    guarded = Guard(nothing, gate)
    ticket = gate.issue_ticket()
    assert ticket not in repr(gate)

    def get(query: str, *headers: tuple[str, str]) -> Answer:
        return ask(guarded, "/", HOST, *headers, query=query)

    notebook = "http://localhost:8888"
    for embedder in ("http://evil.com", "http://localhost:8888; script-src *", "http://localhost.evil.com", ""):
        assert get(f"ticket={ticket}&embedder={embedder}").status == 401
    assert get(f"ticket=wrong&embedder={notebook}").status == 401
    first = get(f"session=s1&ticket={ticket}&embedder={notebook}")
    assert (first.status, first.headers["location"]) == (303, "/?session=s1")
    assert get(f"ticket={ticket}&embedder={notebook}").status == 401
    cookie = ("cookie", first.headers["set-cookie"].partition(";")[0])
    assert get(f"ticket={ticket}&embedder=http://localhost:6666", cookie).status == 303  # the page is loaded again
    policy = get("session=s1", cookie).headers["content-security-policy"]
    assert re.search(r"frame-ancestors (.*)", policy)[1] == f"'self' {notebook}"  # type: ignore[index]


def run_cells_of_the_manual() -> None:
    """Runs the cells of the manual's page, and compares what they show."""
    names: dict[str, Any] = {}
    shown = ""
    for _, language, _, body in FENCE.findall((ROOT / "docs" / "how-to" / "notebook.md").read_text(encoding="utf-8")):
        if language == "py":
            *before, last = ast.parse(body).body
            assert isinstance(last, ast.Expr)
            exec(compile(ast.Module(before, []), "<cell>", "exec"), names)
            shown = f"{eval(compile(ast.Expression(last.value), '<cell>', 'eval'), names)}\n"
        elif language == "output":
            compare(body, shown)


def test_the_server_of_a_notebook_shows_simulations_and_recordings_and_ends_with_it(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sys, "path", [str(ROOT / "models"), *sys.path])
    monkeypatch.chdir(tmp_path)

    async def cells() -> None:
        simulation, path = counter(), tmp_path / "run.sqlite"
        with simulation.record(path):
            simulation.run(0.3)
        shown = simulation.show()
        again = simulation.show(height=300)
        assert shown.page["session"] == again.page["session"]
        assert shown.page["ticket"] != again.page["ticket"]
        with closing(HTTPConnection("127.0.0.1", shown.page["port"])) as browser:
            browser.request("GET", f"/?ticket={shown.page['ticket']}&embedder=http://localhost:8888")
            assert browser.getresponse().status == 303
        assert "counter.goal" in widget.replay_of(simulation)
        with Recorded(path) as recorded:
            played = recorded.show()
        assert "which model file made it" in played.problem
        assert played.page == {}
        assert "counter.goal" in widget.replay_of(path)
        run_cells_of_the_manual()

    in_notebook(cells)
    server = widget.Server.get()
    server.end()
    assert server._process.wait(20) == 0
    monkeypatch.delitem(sys.modules, "doorway")


def test_a_replay_that_cannot_be_written_says_why_in_plain_words(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    shown, sent = widget.Widget(tmp_path / "run.sqlite", height=300), list[Any]()
    monkeypatch.setattr(shown, "send", sent.append)
    monkeypatch.setattr(tempfile, "tempdir", str(tmp_path / "nowhere"))
    shown._send_replay()
    assert sent == [{"error": "No such file or directory"}]


def test_an_answer_that_comes_late_is_not_that_to_the_next_request(monkeypatch: pytest.MonkeyPatch) -> None:
    server = object.__new__(widget.Server)  # without a process: the test answers in its place
    server._control, its_end = socket.socketpair()
    with server._control, its_end:
        monkeypatch.setattr(widget, "PATIENCE", 0.01)
        with pytest.raises(NotebookError, match="does not answer: timed out"):
            server.ask({"session": "first"})
        monkeypatch.setattr(widget, "PATIENCE", 60)
        with ThreadPoolExecutor() as pool:
            second = pool.submit(server.ask, {"session": "second"})
            for _ in range(2):  # only now, both are answered
                data, (answering,), _, _ = socket.recv_fds(its_end, 1000, 2)
                with socket.socket(fileno=answering) as wire, suppress(BrokenPipeError):
                    wire.sendall(data)
            assert second.result() == {"session": "second"}
