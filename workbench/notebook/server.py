"""Serves the workbench's page to the widgets of one notebook: a child of its process, which ends with it."""

from __future__ import annotations

import asyncio
import json
import os
import signal
import socket
import sys
from contextlib import suppress
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from fastapi import FastAPI

from actr3d.errors import Actr3dError, reason_of
from actr3d.recording import Recorded
from actr3d.runner.before_exit import end_at_once
from workbench.app import make_app
from workbench.auth import Gate, Token
from workbench.cli import listen
from workbench.server import serve
from workbench.session import Session
from workbench.sessions import Sessions
from workbench.worker.messages import FromWorker, Leave, WorkerEnded
from workbench.worker.workers import LOST, Worker

LONGEST = 65_536
"""Maximum size of a request [bytes]."""
NAME = "notebook"
"""What pages show in place of the name of a model file."""


class NotebookWorker(Worker):
    """Holds the connection to a simulation in the notebook's process, which is never ended from here."""

    @classmethod
    async def at(cls, wire: socket.socket) -> NotebookWorker:
        """Returns the worker at the other end of a socket."""
        wire.setblocking(False)
        reader, writer = await asyncio.open_connection(sock=wire, limit=1 << 20)
        nothing_printed = asyncio.StreamReader()
        nothing_printed.feed_eof()
        return cls(0, reader, writer, (nothing_printed, writer.transport))

    async def receive(self) -> FromWorker | None:
        """Returns the next message; `WorkerEnded` and then None if the simulation or the kernel has ended."""
        message = await super().receive()
        if message is None and not self.exit.done():
            self.kill()
            return WorkerEnded()  # a kernel that is restarted has no time to say so
        return message

    async def stop(self) -> None:
        """Leaves the simulation alone from now on."""
        self.send(Leave())
        self.kill()

    def kill(self) -> None:
        """Closes the connection."""
        self.release()
        if not self.exit.done():
            self.exit.set_result(LOST)


class Requests:
    """Carries out what the notebook asks for: to show a simulation at the other end of a socket, or a recording.

    Args:
        control: The socket of the requests, each with a socket for its answer; the server ends when it is closed.
        app: The application.
        gate: Grants access to it.
    """

    def __init__(self, control: socket.socket, app: FastAPI, gate: Gate) -> None:
        self._control = control
        self._sessions: Sessions = app.state.sessions
        self._gate = gate
        self._tasks: set[asyncio.Task[None]] = set()

    def begin(self) -> None:
        """Waits for requests from now on."""
        asyncio.get_running_loop().add_reader(self._control, self._hear)

    def _hear(self) -> None:
        data, descriptors, _, _ = socket.recv_fds(self._control, LONGEST, 2)
        if data:
            answering, *wires = [socket.socket(fileno=descriptor) for descriptor in descriptors]
            task = asyncio.create_task(self._answer(json.loads(data), answering, wires))
            self._tasks.add(task)
            task.add_done_callback(self._tasks.discard)
        else:
            asyncio.get_running_loop().remove_reader(self._control)
            signal.raise_signal(signal.SIGINT)  # the usual way to end a server

    async def _answer(self, request: dict[str, Any], answering: socket.socket, wires: list[socket.socket]) -> None:
        try:
            session = await self._shown(request, wires)
            answer = {"session": session.name, "port": self._gate.port, "ticket": self._gate.issue_ticket()}
        except (Actr3dError, OSError) as error:
            answer = {"error": reason_of(error)}
        with answering, suppress(ConnectionError):  # the user has interrupted the cell
            answering.sendall(json.dumps(answer).encode())

    async def _shown(self, request: dict[str, Any], wires: list[socket.socket]) -> Session:
        """Returns the session that shows what is asked for."""
        if "session" in request:
            return self._sessions.get(request["session"])
        if wires:
            return await self._sessions.adopt(await NotebookWorker.at(wires[0]), NAME)
        path = Path(request["recording"])
        copy = self._sessions.recordings.new(path.stem)
        await asyncio.to_thread(_copy, path, copy)
        return await self._sessions.reopen(copy.stem, trust=request["trust"], real_time=True, record=False)


def _copy(path: Path, to: Path) -> None:
    with Recorded(path) as recorded:
        recorded.copy_to(to)


def main(descriptor: int) -> None:
    """Serves until the notebook's process closes the socket with this file descriptor."""
    control = socket.socket(fileno=descriptor)
    os.set_inheritable(descriptor, False)
    with TemporaryDirectory(prefix="actr3d-notebook-") as folder:
        listening = listen("127.0.0.1", 0)
        gate = Gate(token=Token(), port=listening.getsockname()[1])
        app = make_app(Path(folder), gate)
        serve(app, listening, Requests(control, app, gate).begin)
    end_at_once(0)  # its threads are of no use any more


if __name__ == "__main__":
    main(int(sys.argv[1]))
