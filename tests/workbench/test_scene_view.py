"""A 3D view that cannot be drawn is reported and drawn again with the next run; one that comes too late is ended."""

from __future__ import annotations

import asyncio
import threading
from pathlib import Path
from typing import Any

import pytest

from tests.helpers.sessions import Desk
from workbench import scene_view
from workbench.page_commands.changes import SimulationCommand
from workbench.viser_panel import Panel
from workbench.worker.messages import State

ROOM = """
from actr3d.simulation import Simulation
from actr3d.world import Aperture, Floor, Scene

def build() -> Simulation:
    return Simulation(Scene(parts=(Floor(), Aperture())))
"""


@pytest.mark.filterwarnings("ignore:The `line_width`:DeprecationWarning")
def test_a_view_that_cannot_be_drawn_is_reported_and_drawn_with_the_next_run(
    desk: Desk, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def refused(*_: object) -> None:
        raise ValueError("no such slider")

    talk = desk.begin(tmp_path, ROOM)
    view = talk.sessions.view(talk.session.name)
    assert view is not None
    with monkeypatch.context() as patch:
        patch.setattr(scene_view, "Panel", refused)
        assert not desk.do(view.wait())
    assert talk.wait_for_notice("the 3D view of this run cannot be drawn: ValueError: no such slider")["level"] == "error"
    talk.say("restart")
    talk.wait(lambda: talk.facts["run"] == 2 and talk.state["status"] == "paused")
    assert desk.do(view.wait())


@pytest.mark.filterwarnings("ignore:The `line_width`:DeprecationWarning")
def test_a_refused_command_of_the_view_is_reported_and_the_view_shows_what_is_true_again(
    desk: Desk, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    shown: list[float] = []

    class Recorder(Panel):
        def show(self, state: State) -> None:
            super().show(state)
            shown.append(state.time)

    monkeypatch.setattr(scene_view, "Panel", Recorder)
    talk = desk.begin(tmp_path, ROOM)
    view: Any = talk.sessions.view(talk.session.name)
    assert desk.do(view.wait())
    monkeypatch.setattr(view._server, "get_clients", lambda: {0: None})
    talk.say("pause")  # the sender is in control from now on
    before = len(shown)
    view._panel._said(SimulationCommand(word="move", values=("door", 1.0, 0.0, 0.0)))
    assert talk.wait_for_notice("no object 'door' to move; there are: none")["level"] == "error"
    talk.wait(lambda: len(shown) > before)
    assert talk.facts["controlled_by"] == "test"


def test_a_server_of_a_view_that_starts_after_its_session_was_closed_is_stopped(
    desk: Desk, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    begun, closed, stopped = (threading.Event() for _ in range(3))

    class Late:
        """Takes the place of viser's server."""

        def stop(self) -> None:
            stopped.set()

    def start(_: str) -> Any:
        begun.set()
        closed.wait(20)
        return Late()

    async def close() -> None:
        view.prepare()
        await asyncio.to_thread(begun.wait, 20)
        await talk.sessions.close(talk.session.name)
        closed.set()

    monkeypatch.setattr(scene_view, "start_viser", start)
    talk = desk.begin(tmp_path, ROOM)
    view: Any = talk.sessions.view(talk.session.name)
    desk.do(close())
    assert stopped.wait(20)
