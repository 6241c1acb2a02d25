"""What is given of a recording to be taken away, also while a run goes on writing it."""

from __future__ import annotations

import asyncio
import resource
import sqlite3
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import closing
from pathlib import Path

import pytest

from actr3d.errors import RecordingError
from actr3d.recording import Recorded, Recording
from tests.server.asking import COOKIE, GATE, HOST, Answer, ask
from tests.server.desk import Desk
from tests.server.test_recorded_runs import APERTURE, ended
from tests.server.test_runs import firing, written
from workbench.app import make_app
from workbench.copying import copy_of
from workbench.keeping import stands_alone


@pytest.fixture(autouse=True)
def aside(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """Where copies are made; none is left there."""
    folder = tmp_path / "aside"
    folder.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(folder))
    yield folder
    assert list(folder.iterdir()) == []


def download(folder: Path, name: str, form: str = "sqlite") -> Answer:
    return ask(make_app(folder, GATE), f"/api/recordings/{name}/file", HOST, COOKIE, query=f"form={form}")


def taken(folder: Path, name: str) -> Path:
    """Takes a recording away to where it lies alone, and cannot be written."""
    answer = download(folder, name)
    assert answer.status == 200, answer.body
    assert answer.headers["content-disposition"] == f'attachment; filename="{name}.sqlite"'
    away = folder / "away"
    away.mkdir()
    (away / "taken.sqlite").write_bytes(answer.body)
    return away / "taken.sqlite"


def test_what_is_taken_of_a_run_that_has_ended_is_replayed_while_its_session_is_open(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, APERTURE, record=True, settings={"aperture": 0.3})
    events = ended(talk)["events"]
    name = talk.facts["recording"]
    assert not stands_alone(talk.sessions.recordings.path(name))
    talk.wait(lambda: talk.sessions.recordings.summary(name).events == events)
    path = taken(tmp_path, name)
    done = subprocess.run([sys.executable, "-m", "actr3d", "replay", str(path)], capture_output=True, text=True, check=False)
    assert (done.returncode, "every byte agrees" in done.stdout) == (0, True), done.stdout + done.stderr
    assert [each.name for each in path.parent.iterdir()] == [path.name]


def test_what_is_taken_of_a_run_that_goes_on_has_what_was_there(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, APERTURE, record=True, settings={"aperture": 0.8})
    talk.say("speed", factor=0.05)
    talk.say("run")
    name = talk.facts["recording"]
    talk.wait(lambda: talk.sessions.recordings.summary(name).states > 5)
    least = talk.sessions.recordings.summary(name)
    path = taken(tmp_path, name)
    assert talk.state["status"] == "running"
    with Recorded(path) as recorded:
        recorded.check()
        assert "ended" not in recorded.facts
        assert recorded.state_count >= least.states
        assert recorded.event_count >= least.events
        assert recorded.ticks == recorded.state_count - 1
    talk.say("pause")
    talk.until("paused")
    desk.do(talk.session.stop())
    assert talk.notices == []


def test_a_recording_that_is_finished_is_given_as_it_is(tmp_path: Path) -> None:
    path = written(tmp_path, "m", firing(3))
    assert download(tmp_path, "m").body == path.read_bytes()
    path.write_bytes(b"no recording at all")
    assert download(tmp_path, "m").body == b"no recording at all"


def test_a_copy_that_takes_long_does_not_hold_up_the_server(tmp_path: Path) -> None:
    path = written(tmp_path, "m", firing(3))

    async def meanwhile(holder: sqlite3.Connection) -> Path:
        holder.execute("BEGIN EXCLUSIVE")
        copying = asyncio.create_task(copy_of(path))
        await asyncio.sleep(0.2)
        assert not copying.done()
        holder.execute("COMMIT")
        return await copying

    with closing(sqlite3.connect(path, isolation_level=None)) as holder:
        made = asyncio.run(meanwhile(holder))
    with Recorded(made) as recorded:
        assert recorded.event_count == 3
    made.unlink()


def test_a_copy_that_nobody_waits_for_any_more_is_deleted(tmp_path: Path, aside: Path) -> None:
    path = written(tmp_path, "m", firing(3))

    async def given_up(holder: sqlite3.Connection) -> None:
        holder.execute("BEGIN EXCLUSIVE")
        copying = asyncio.create_task(copy_of(path))
        await asyncio.sleep(0.1)
        copying.cancel()
        with pytest.raises(asyncio.CancelledError):
            await copying
        holder.execute("COMMIT")
        while list(aside.iterdir()):
            await asyncio.sleep(0.01)

    with closing(sqlite3.connect(path, isolation_level=None)) as holder:
        asyncio.run(asyncio.wait_for(given_up(holder), 60))


def test_a_copy_that_cannot_be_written_is_told(tmp_path: Path) -> None:
    (tmp_path / ".workbench" / "recordings").mkdir(parents=True)
    with Recording(tmp_path / ".workbench" / "recordings" / "m.sqlite", {"kind": "program", "text": "x" * 200_000}):
        limits = resource.getrlimit(resource.RLIMIT_FSIZE)
        resource.setrlimit(resource.RLIMIT_FSIZE, (50_000, limits[1]))
        try:
            answer = download(tmp_path, "m")
        finally:
            resource.setrlimit(resource.RLIMIT_FSIZE, limits)
    assert (answer.status, b"the recording cannot be copied: " in answer.body) == (409, True), answer.body


def test_what_is_no_recording_is_not_copied(tmp_path: Path) -> None:
    path = tmp_path / "m.sqlite"
    path.write_bytes(b"no recording at all" * 100)
    with pytest.raises(RecordingError, match="cannot be copied: file is not a database"):
        asyncio.run(copy_of(path))


def test_a_program_without_simulations_has_no_states_to_take(tmp_path: Path) -> None:
    written(tmp_path, "m", firing(3))
    answer = download(tmp_path, "m", "states.csv")
    assert (answer.status, answer.body) == (409, b'{"error":"the recording has no states: no simulation has run in it"}')
    assert download(tmp_path, "m", "events.csv").body.count(b"\r\n") == 4
    told = ask(make_app(tmp_path, GATE), "/api/recordings/m", HOST, COOKIE).body
    assert b'"states": 0' in told
