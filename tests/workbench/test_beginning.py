"""What is said between a restart and the moment when the new run is there."""

from __future__ import annotations

import asyncio
from pathlib import Path
from typing import Any

import pytest

from tests.helpers.paths import MODELS
from tests.helpers.sessions import Desk, Talk
from workbench.protocol import COMMAND
from workbench.session import Session

DOORWAY = (MODELS / "doorway.py").read_text(encoding="utf-8")
GATED = (
    DOORWAY.replace("def build(", "def built(")
    + """

def build(parameters: Parameters) -> Simulation:
    import time
    from pathlib import Path
    while not (Path(__file__).parent / "gate").exists():
        time.sleep(0.005)
    return built(parameters)
"""
)


def restarted(desk: Desk, folder: Path, **more: Any) -> Talk:
    """Returns a session that shows one run while another one is being built, until `open_gate`."""
    gate = folder / "gate"
    gate.touch()
    talk = desk.begin(folder, GATED)
    gate.unlink()
    talk.say("restart", **more)
    assert talk.facts["loading"]
    return talk


def begun(desk: Desk, session: Session, *commands: dict[str, Any]) -> list[asyncio.Task[Any]]:
    """Says things one after the other, without waiting for what comes of them."""

    async def begin() -> list[asyncio.Task[Any]]:
        tasks = [asyncio.create_task(COMMAND.validate_python(command).submit(session, "test")) for command in commands]
        await asyncio.sleep(0.05)
        return tasks

    return desk.do(begin())


def open_gate(desk: Desk, talk: Talk, folder: Path, tasks: list[asyncio.Task[Any]]) -> list[str | None]:
    """Lets the new run be built; returns what came of what was said."""
    (folder / "gate").touch()
    talk.wait(lambda: talk.session.run == 2)

    async def await_them() -> list[str | None]:
        return [reply.error for reply in await asyncio.gather(*tasks)]

    return desk.do(await_them())


def test_a_live_value_that_is_set_while_a_new_run_is_built_is_for_that(desk: Desk, tmp_path: Path) -> None:
    talk = restarted(desk, tmp_path)
    tasks = begun(desk, talk.session, {"type": "set", "name": "width", "value": 0.7}, {"type": "speed", "factor": 2.0})
    assert round(talk.state["apertures"]["aperture"], 9) == 0.5
    assert open_gate(desk, talk, tmp_path, tasks) == [None, None]
    talk.wait(lambda: round(talk.state["apertures"]["aperture"], 9) == 0.7)
    assert talk.state["wanted"] == 2.0


def test_what_is_said_before_the_new_run_has_its_worker_is_for_that(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, DOORWAY)
    restart: dict[str, Any] = {"type": "restart", "settings": {"speed": 1.1}}
    begun(desk, talk.session, restart, {"type": "set", "name": "width", "value": 0.7}, {"type": "step", "ticks": 3})
    talk.wait(lambda: talk.session.run == 2 and talk.state["tick"] == 3)
    assert round(talk.state["apertures"]["aperture"], 9) == 0.7
    assert talk.facts["settings"] == {"speed": 1.1}


def test_what_is_shown_can_be_asked_and_gone_back_in_while_a_new_run_is_built(desk: Desk, tmp_path: Path) -> None:
    talk = restarted(desk, tmp_path)
    assert talk.say("explain")[0]["time"] == 0
    talk.say("seek", time=0)
    open_gate(desk, talk, tmp_path, [])


def test_a_pause_holds_what_is_shown_and_what_is_being_built(desk: Desk, tmp_path: Path) -> None:
    (tmp_path / "gate").touch()
    talk = desk.begin(tmp_path, GATED)
    talk.say("speed", factor=0.1)
    talk.say("run")
    talk.until("running")
    (tmp_path / "gate").unlink()
    talk.say("restart", run=True)
    talk.say("pause")
    talk.until("paused")
    open_gate(desk, talk, tmp_path, [])
    talk.wait(lambda: talk.state["reason"] == "by the user")
    assert talk.state["time"] < 0.1


def test_a_restart_after_another_has_what_that_one_was_given(desk: Desk, tmp_path: Path) -> None:
    talk = restarted(desk, tmp_path, settings={"width": 0.7}, seed=5)
    talk.say("restart")
    open_gate(desk, talk, tmp_path, [])
    assert (talk.facts["settings"], talk.facts["seed"], talk.facts["attempt"]) == ({"width": 0.7}, 5, 3)


def test_a_command_for_a_run_that_cannot_be_built_says_so(desk: Desk, tmp_path: Path) -> None:
    talk = restarted(desk, tmp_path, settings={"width": 99.0})
    (task,) = begun(desk, talk.session, {"type": "step"})
    (tmp_path / "gate").touch()
    talk.wait_for_notice("must be <= 3")
    assert desk.do(asyncio.wait_for(task, 30)).error == "the run has ended"
    assert talk.facts["run"] == 1
    talk.say("step")
    talk.until("paused", tick=1)


def test_a_stop_ends_a_run_that_has_no_worker_yet(desk: Desk, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    talk = desk.begin(tmp_path, DOORWAY)
    launch, may_go = talk.session._workers.launch, asyncio.Event()

    async def slow() -> Any:
        await may_go.wait()
        return await launch()

    monkeypatch.setattr(talk.session._workers, "launch", slow)
    (restart,) = begun(desk, talk.session, {"type": "restart", "run": True})
    talk.say("stop")

    async def go() -> None:
        may_go.set()
        await restart
        while talk.session._asked:
            await asyncio.sleep(0.01)

    desk.do(go())
    assert not talk.facts["alive"]
    assert not talk.facts["loading"]
    assert (talk.facts["run"], talk.facts["ending"]) == (1, "stopped")


def test_a_run_is_loading_while_the_workbench_itself_starts(tmp_path: Path) -> None:
    """Pages said that the model cannot be loaded until the first worker was there: after an installation, for a minute."""
    (tmp_path / "model.py").write_text(DOORWAY, encoding="utf-8")
    desk = Desk()
    seen: list[tuple[bool, bool]] = []
    try:
        sessions = desk.sessions(tmp_path)

        async def open_and_look() -> None:
            opening = asyncio.create_task(sessions.open("model.py", {}, seed=1, record=False, run=False))
            while not opening.done():
                seen.extend((session.summary()["loading"], session.alive) for session in sessions.all())
                await asyncio.sleep(0.01)
            await opening
            seen.extend((session.summary()["loading"], session.alive) for session in sessions.all())

        desk.do(open_and_look())
        desk.close_sessions()
    finally:
        desk.close()
    assert seen
    assert all(loading or alive for loading, alive in seen)
