"""Sessions with real workers, for tests that use them from outside their event loop."""

from __future__ import annotations

import asyncio
import json
import threading
import time
from collections.abc import Callable, Coroutine
from pathlib import Path
from typing import Any, TypeVar

from tests.helpers.asgi_client import COOKIE, GATE, HOST, Answer, Header, call
from workbench.app import make_app
from workbench.files import ModelFolder
from workbench.protocol import COMMAND
from workbench.recording_index import Summary
from workbench.recordings import Recordings
from workbench.session import Session
from workbench.sessions import Sessions
from workbench.worker.workers import Workers

SLOW_PROGRAM = """from actr3d.actr import *
import time

class Slow(ACTR):
    goal = Buffer()
    def init():
        goal.set("count 0")
    def count(goal="count ?n"):
        time.sleep(0.01)
        goal.set("count %d" % (int(n) + 1))

model = Slow()
model.run(6.02)
"""
"""A program that takes 1.2 s."""


T = TypeVar("T")
PATIENCE = 180.0
"""Maximum time that a test waits [s]; machines are slow at times."""


class Desk:
    """An event loop with workers, and sessions for each test.

    Args:
        memory: Maximum memory of a model [MB].
    """

    def __init__(self, memory: int = 1500) -> None:
        self._loop = asyncio.new_event_loop()
        self._thread = threading.Thread(target=self._loop.run_forever, daemon=True)
        self._thread.start()
        self.workers = Workers(memory)
        self._open: list[Sessions] = []
        self._loop.call_soon_threadsafe(self.workers.begin)

    def do(self, work: Coroutine[Any, Any, T]) -> T:
        """Runs a coroutine in the event loop; returns its result."""
        return asyncio.run_coroutine_threadsafe(work, self._loop).result(PATIENCE)

    def sessions(self, folder: Path) -> Sessions:
        """Returns sessions with the models of a folder."""
        sessions = Sessions(ModelFolder(folder), Recordings(folder), self.workers)
        self._open.append(sessions)
        return sessions

    def ask(self, folder: Path, path: str, *headers: Header, **more: Any) -> Answer:
        """Sends a request to an application with the models of a folder, and returns the answer."""
        app = make_app(folder, GATE)
        app.state.sessions = self.sessions(folder)
        return self.do(call(app, path, HOST, COOKIE, *headers, **more))

    def listed(self, folder: Path, first: int = 0, most: int = 1000) -> tuple[int, list[Summary]]:
        """Returns the number of recordings of a folder, and the summaries of some."""
        return self.do(self.sessions(folder).listing.some(first, most))

    def begin(self, folder: Path, source: str, *, name: str = "model.py", wait: str | None = "paused", **options: Any) -> Talk:
        """Begins a session with a model of this text."""
        (folder / name).write_text(source, encoding="utf-8")
        sessions = self.sessions(folder)
        given: dict[str, Any] = {"seed": 1, "record": False, "run": False, **options}
        settings = given.pop("settings", {})
        talk = Talk(self, self.do(sessions.open(name, settings, **given)), sessions)
        if wait is not None:
            talk.until(wait)
        return talk

    def close_sessions(self) -> None:
        """Ends the sessions of a test."""
        for sessions in self._open:
            self.do(sessions.close_all())
        self._open.clear()

    def close(self) -> None:
        """Ends everything."""
        self.do(self._close())
        self._loop.call_soon_threadsafe(self._loop.stop)
        self._thread.join()
        self._loop.close()

    async def _close(self) -> None:
        await self.workers.close()
        rest = asyncio.all_tasks() - {asyncio.current_task()}  # such as the end of a worker that has read a recording
        for task in rest:
            task.cancel()
        await asyncio.gather(*rest, return_exceptions=True)


class Talk:
    """Sends commands to one session and reads its state."""

    def __init__(self, desk: Desk, session: Session, sessions: Sessions) -> None:
        self.desk = desk
        self.session = session
        self.sessions = sessions

    def say(self, kind: str, **more: Any) -> Any:
        """Sends a command; returns the result, or raises the error."""
        reply = self.desk.do(COMMAND.validate_python({"type": kind, **more}).submit(self.session, "test"))
        if reply.error is not None:
            raise RefusedError(reply.error)
        return json.loads(reply.result)

    def until(self, status: str, **more: float) -> dict[str, Any]:
        """Waits for a status, and for numbers of the state to have these values; returns the state."""
        return self.wait(
            lambda: self.state["status"] == status and all(abs(self.state[name] - value) < 1e-9 for name, value in more.items())
        )

    def wait(self, condition: Callable[[], Any]) -> dict[str, Any]:
        """Waits until a condition holds; returns the state."""
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            if self.session.state is not None and condition():
                return self.state
            time.sleep(0.005)
        raise AssertionError(f"the condition never held: {self.facts}, {self.session.state and self.state}, {self.notices}")

    def summary(self, name: str) -> Summary:
        """Returns the summary of a recording."""
        return self.desk.do(self.sessions.listing.one(name))

    @property
    def state(self) -> dict[str, Any]:
        """The newest state; without a status while a run that was begun again has none yet."""
        return json.loads(self.session.state_json()) or {"status": None}

    @property
    def facts(self) -> dict[str, Any]:
        """The facts of the session."""
        return json.loads(self.session.facts_json())

    @property
    def notices(self) -> list[dict[str, Any]]:
        """The notices that the user received."""
        return [json.loads(notice) for _, notice in list(self.session.notices)]

    @property
    def events(self) -> list[list[Any]]:
        """All events that the server knows."""
        assert self.session.log.first == 0
        return [json.loads(event) for event in list(self.session.log._events)]

    def wait_for_notice(self, text: str) -> dict[str, Any]:
        """Waits for a notice with a text; returns it."""
        end = time.monotonic() + PATIENCE
        while time.monotonic() < end:
            for notice in self.notices:
                if text in notice["text"]:
                    return notice
            time.sleep(0.01)
        raise AssertionError(f"no notice with '{text}': {self.notices}")


class RefusedError(Exception):
    """The session has refused something."""


def workers_of(talk: Talk) -> list[int]:
    """Returns the process that runs a session's model."""
    worker = talk.session._worker
    assert worker is not None
    return [worker.pid]
