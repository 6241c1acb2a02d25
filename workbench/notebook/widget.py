"""The widget that shows a simulation or a recording in a notebook."""

from __future__ import annotations

import asyncio
import atexit
import json
import os
import socket
import subprocess
import sys
import tempfile
from contextlib import suppress
from pathlib import Path
from typing import Any
from weakref import WeakValueDictionary, ref

import anywidget
import traitlets

from actr3d.errors import NotebookError, reason_of
from actr3d.recording import Recorded, Recording
from actr3d.simulation import Simulation
from workbench.html_replay.make import write_replay
from workbench.notebook.live_run import LiveRun

PATIENCE = 60.0
"""How long the server may take to answer [s]; the first time, it is loaded."""
END = 1.0
"""How long the end of this process waits for that of the server, which ends by itself [s]."""
_runs: WeakValueDictionary[int, LiveRun] = WeakValueDictionary()
"""The runs that are shown, by the `id` of their simulation, which holds them."""


class Server:
    """Holds the process that serves the pages of this one's widgets; it ends with this process, however that ends."""

    _started: Server | None = None

    def __init__(self) -> None:
        self._control, its_end = socket.socketpair()
        self._control.settimeout(PATIENCE)
        command = [sys.executable, "-m", "workbench.notebook.server", str(its_end.fileno())]
        # In a session of its own, it is not interrupted when a user interrupts a cell.
        self._process = subprocess.Popen(command, pass_fds=[its_end.fileno()], stdin=subprocess.DEVNULL, start_new_session=True)
        its_end.close()
        self._of = os.getpid()
        atexit.register(self.end)
        os.register_at_fork(after_in_child=self._control.close)

    @classmethod
    def get(cls) -> Server:
        """Returns the server of this process; starts it if necessary."""
        known = cls._started
        if known is None or not known.is_alive:
            known = cls._started = Server()
        return known

    @property
    def is_alive(self) -> bool:
        """Whether it is of this process, not of one that has forked this one, and runs."""
        return self._of == os.getpid() and self._process.poll() is None

    def ask(self, request: dict[str, Any], wire: socket.socket | None = None) -> dict[str, Any]:
        """Sends a request, with a socket if there is one, and returns the answer.

        Raises:
            NotebookError: If the server refuses it, or does not answer.
        """
        # A connection for this answer alone: an answer that comes after a user has interrupted the cell is not that to another request.
        answering, its_end = socket.socketpair()
        answering.settimeout(PATIENCE)
        try:
            with answering, answering.makefile("rb") as answers:
                with its_end:
                    files = [its_end.fileno(), *([] if wire is None else [wire.fileno()])]
                    socket.send_fds(self._control, [json.dumps(request).encode()], files)
                data = answers.read()
        except OSError as error:
            raise NotebookError(f"the process that serves the widgets does not answer: {error}") from None
        answer = json.loads(data) if data else {"error": "the process that serves the widgets has ended"}
        if "error" in answer:
            raise NotebookError(answer["error"])
        return answer

    def end(self) -> None:
        """Ends the process."""
        self._control.close()
        if self._of == os.getpid():
            with suppress(subprocess.TimeoutExpired):
                self._process.wait(END)


class Widget(anywidget.AnyWidget):
    """Shows the workbench's page, or, where the browser cannot reach it, a replay that needs no server."""

    _esm = Path(__file__).with_name("widget.js")
    page = traitlets.Dict().tag(sync=True)
    """Port and session of the page, and a ticket that admits one browser; empty if there is only a replay."""
    problem = traitlets.Unicode().tag(sync=True)
    """Why there is only a replay."""
    height = traitlets.Int().tag(sync=True)
    """[px]"""

    def __init__(self, shown: Simulation | Path, **traits: Any) -> None:
        super().__init__(**traits)
        self._shown = ref(shown) if isinstance(shown, Simulation) else lambda: shown
        self.on_msg(self._send_replay)  # pyright: ignore[reportUnknownMemberType] # ipywidgets has no types

    def _send_replay(self, *_: object) -> None:
        """Sends the replay of the run up to now; the frontend asks for it."""
        try:
            content = {"replay": replay_of(self._shown())}
        except Exception as error:  # noqa: BLE001 - shown in the widget
            content = {"error": reason_of(error)}
        self.send(content)  # pyright: ignore[reportUnknownMemberType]


def show(what: Simulation | Recorded, *, height: int, trust: bool = False) -> Widget:
    """Returns the widget of a simulation or a recording.

    Raises:
        NotebookError: If this is not a notebook, or the server cannot be started.
        SimulationError: As `Simulation.seek` does, if the run has begun.
    """
    try:
        loop = asyncio.get_running_loop()
    except RuntimeError:
        raise NotebookError("show() is for notebooks: between their cells, an event loop runs that serves the widget") from None
    if isinstance(what, Simulation):
        return Widget(what, page=_page_of(what, loop), height=height)
    try:
        page = Server.get().ask({"recording": str(what.path.absolute()), "trust": trust})
    except NotebookError as error:
        return Widget(what.path, problem=str(error), height=height)
    return Widget(what.path, page=page, height=height)


def _page_of(simulation: Simulation, loop: asyncio.AbstractEventLoop) -> dict[str, Any]:
    """Returns the address of the page of a simulation."""
    server, run = Server.get(), _runs.get(id(simulation))
    if run is not None and not run.left:
        with suppress(NotebookError):  # another server showed it
            return server.ask({"session": run.session})
        run.left = True
    wire, its_end = socket.socketpair()
    with its_end:
        page = server.ask({}, its_end)
    run = LiveRun(simulation, wire, loop)
    run.session = page["session"]
    _runs[id(simulation)] = run
    return page


def replay_of(shown: Simulation | Path | None) -> str:
    """Returns the HTML replay of a recording, or of a simulation that is shown, up to now.

    Raises:
        NotebookError: If the simulation is no more.
        Actr3dError: If the recording cannot be read, or its scene is too large.
    """
    if shown is None:
        raise NotebookError("the notebook no longer has this simulation")
    with tempfile.TemporaryDirectory() as folder:
        path, to = Path(folder) / "run.sqlite", Path(folder) / "replay.html"
        if isinstance(shown, Simulation):
            with Recording(path, shown.facts()) as recording:
                _runs[id(shown)].write_to(recording)
        write_replay(path if isinstance(shown, Simulation) else shown, to)
        return to.read_text(encoding="utf-8")
