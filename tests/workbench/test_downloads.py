"""What is given of a recording to be taken away, also while a run goes on writing it."""

from __future__ import annotations

import asyncio
import csv
import io
import json
import math
import re
import sqlite3
import subprocess
import sys
import tempfile
from collections.abc import Iterator
from contextlib import closing
from io import FileIO
from pathlib import Path

import mujoco
import numpy as np
import pytest

from actr3d.recording import Recorded, Recording
from tests.helpers.asgi_client import COOKIE, GATE, HOST, Answer, call
from tests.helpers.full_disk import full_disk
from tests.helpers.sessions import Desk, workers_of
from tests.workbench.test_recorded_runs import APERTURE, HELPED, ended
from tests.workbench.test_runs import firing, written
from workbench.app import make_app
from workbench.csv_files import state_columns
from workbench.curves import INTEGRATION
from workbench.readers import Readers, ReadingError
from workbench.retention import is_complete


@pytest.fixture(autouse=True)
def aside(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """Where copies are made; none is left there."""
    folder = tmp_path / "aside"
    folder.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(folder))
    yield folder
    assert list(folder.iterdir()) == []


def download(desk: Desk, folder: Path, name: str, form: str = "sqlite") -> Answer:
    return desk.ask(folder, f"/api/recordings/{name}/file", query=f"form={form}")


def taken(desk: Desk, folder: Path, name: str) -> Path:
    """Downloads a recording to a folder where nothing else is."""
    answer = download(desk, folder, name)
    assert answer.status == 200, answer.body
    assert answer.headers["content-disposition"] == f'attachment; filename="{name}.sqlite"'
    away = folder / "away"
    away.mkdir()
    (away / "taken.sqlite").write_bytes(answer.body)
    return away / "taken.sqlite"


FLOOD = """from actr3d.actr import *

class Flood(ACTR):
    goal = Buffer()
    def init():
        goal.set("step")
    def step(goal="step"):
        print("x" * 1000)

Flood().run(200)
"""


def test_a_run_whose_recording_can_no_longer_be_written_does_not_blame_a_line_of_the_model(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, FLOOD, record=True)
    with full_disk(lambda: workers_of(talk), 300_000):
        talk.say("run")
        talk.until("failed")
        (notice,) = [one for one in (json.loads(text) for _, text in talk.session.notices) if one["level"] == "error"]
        kept = r"the first [\d,]+ events of the run are kept, nothing of what came after"
        assert re.fullmatch(rf"cannot write the recording '.*': .*; {kept}", notice["text"])
        assert (notice["file"], notice["line"]) == (None, None)
        assert talk.state["reason"] == notice["text"]
        talk.say("seek", time=0.0)
        talk.until("paused", time=0.0)
        assert notice["events"] == 0, "it is shown at every moment"
        assert talk.sessions.writing() == {}


def test_a_run_that_cannot_begin_on_a_full_disk_ends_with_the_reason(desk: Desk, tmp_path: Path) -> None:
    ended(desk.begin(tmp_path, HELPED.replace("from helper import WORD", 'WORD = "go"')))  # the process that starts workers is ready
    with full_disk(lambda: forking(desk), 1):
        talk = desk.begin(tmp_path, FLOOD, name="flood.py", record=True, wait=None)
        for run in talk.session._going:
            desk.do(run.over.wait())
    assert re.fullmatch(r"cannot write the recording '.*': .*; nothing was written", talk.facts["ending"])
    assert talk.facts["kind"] == "program"


def test_a_run_that_cannot_begin_on_a_full_disk_leaves_nothing_of_the_run_before(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, FLOOD.replace("200", "0.2"))
    ended(talk)
    feed = talk.session.join("page")
    assert json.loads(desk.do(feed.next()))["state"]["events"] > 0
    with full_disk(lambda: forking(desk), 1):
        desk.do(talk.session.restart(None, None))
        begun = talk.session._newest
        assert begun is not None
        desk.do(begun.over.wait())
    shown = json.loads(desk.do(feed.next()))
    assert "cannot write the recording" in shown["session"]["ending"]
    assert shown["state"] is None


@pytest.mark.slow
def test_what_is_taken_of_a_run_that_has_ended_is_replayed_while_its_session_is_open(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, HELPED.replace("from helper import WORD", 'WORD = "go"'), record=True)
    events = ended(talk)["events"]
    name = talk.facts["recording"]
    assert not is_complete(talk.sessions.recordings.path(name))
    talk.wait(lambda: talk.summary(name).events == events)
    path = taken(desk, tmp_path, name)
    done = subprocess.run([sys.executable, "-m", "actr3d", "replay", str(path)], capture_output=True, text=True, check=False)
    assert (done.returncode, "every byte agrees" in done.stdout) == (0, True), done.stdout + done.stderr
    assert [each.name for each in path.parent.iterdir()] == [path.name]


def test_what_is_taken_of_a_run_that_is_held_has_all_that_is_shown(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, APERTURE, record=True)
    for tick in range(1, 30):
        talk.say("step", ticks=1)
        shown = talk.until("paused", tick=tick)
        with Recorded(talk.sessions.recordings.path(talk.facts["recording"])) as recorded:
            assert (recorded.ticks, recorded.event_count) == (tick, shown["events"])


def test_what_is_taken_of_a_run_that_goes_on_has_what_was_there(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, APERTURE, record=True, settings={"aperture": 0.8})
    talk.say("speed", factor=0.05)
    talk.say("run")
    name = talk.facts["recording"]
    talk.wait(lambda: talk.summary(name).states > 5)
    least = talk.summary(name)
    path = taken(desk, tmp_path, name)
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


def test_a_finished_recording_is_sent_unchanged(desk: Desk, tmp_path: Path) -> None:
    path = written(tmp_path, "m", firing(3))
    assert download(desk, tmp_path, "m").body == path.read_bytes()
    path.write_bytes(b"no recording at all")
    assert download(desk, tmp_path, "m").body == b"no recording at all"


def test_a_copy_that_takes_long_does_not_hold_up_the_server(desk: Desk, tmp_path: Path) -> None:
    path = written(tmp_path, "m", firing(3))

    async def meanwhile(holder: sqlite3.Connection) -> FileIO:
        holder.execute("BEGIN EXCLUSIVE")
        copying = asyncio.create_task(Readers(desk.workers).make("sqlite", path))
        await asyncio.sleep(0.2)
        assert not copying.done()
        holder.execute("COMMIT")
        return await copying

    with closing(sqlite3.connect(path, isolation_level=None, check_same_thread=False)) as holder:
        made = desk.do(meanwhile(holder))
    with made:
        away = tmp_path / "away.sqlite"
        away.write_bytes(made.read())
    with Recorded(away) as recorded:
        assert recorded.event_count == 3


def test_a_copy_is_cancelled_when_no_client_waits_for_it(desk: Desk, tmp_path: Path) -> None:
    path = written(tmp_path, "m", firing(3))
    app = make_app(tmp_path, GATE)
    app.state.sessions = desk.sessions(tmp_path)

    async def left(holder: sqlite3.Connection) -> Answer:
        holder.execute("BEGIN EXCLUSIVE")
        leaving = asyncio.Event()
        asking = asyncio.create_task(call(app, "/api/recordings/m/file", HOST, COOKIE, query="form=events.csv", leaving=leaving))
        await asyncio.sleep(0.3)
        assert not asking.done()
        leaving.set()
        return await asking  # the recording is still locked

    with closing(sqlite3.connect(path, isolation_level=None, check_same_thread=False)) as holder:
        assert b"nobody waits for it any more" in desk.do(left(holder)).body


def forking(desk: Desk) -> list[int]:
    """Returns the process that starts workers, which have its limits."""
    fork_server = desk.workers._fork_server
    assert fork_server is not None
    return [fork_server.process.pid]


def test_a_copy_that_cannot_be_written_is_reported(desk: Desk, tmp_path: Path) -> None:
    (tmp_path / ".workbench" / "recordings").mkdir(parents=True)
    with Recording(tmp_path / ".workbench" / "recordings" / "m.sqlite", {"kind": "program", "text": "x" * 200_000}):
        assert download(desk, tmp_path, "m", "events.csv").status == 200  # all that a worker needs is loaded now
        with full_disk(lambda: forking(desk), 50_000):
            copy = download(desk, tmp_path, "m", "sqlite")
        with full_disk(lambda: forking(desk), 1_000):
            page = download(desk, tmp_path, "m", "replay.html")
    assert (copy.status, page.status) == (409, 409)
    assert b"the recording cannot be copied: " in copy.body
    assert page.body == b'{"error":"it cannot be read or written: File too large"}'


@pytest.mark.slow
def test_a_disk_that_was_full_leaves_no_broken_bytecode(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Python 3.11 leaves half a file of bytecode on a full disk, and fails whenever it reads it again."""
    monkeypatch.setenv("PYTHONPYCACHEPREFIX", str(tmp_path / "bytecode"))
    (tmp_path / ".workbench" / "recordings").mkdir(parents=True)
    written(tmp_path, "m", firing(3))
    desk = Desk()
    try:
        assert download(desk, tmp_path, "m", "events.csv").status == 200
        with full_disk(lambda: forking(desk), 1_000):
            assert download(desk, tmp_path, "m", "replay.html").status == 409
        assert download(desk, tmp_path, "m", "replay.html").status == 200
    finally:
        desk.close()


def test_what_is_no_recording_is_not_copied(desk: Desk, tmp_path: Path) -> None:
    path = tmp_path / "m.sqlite"
    path.write_bytes(b"no recording at all" * 100)
    with pytest.raises(ReadingError, match="cannot be copied: file is not a database"):
        desk.do(Readers(desk.workers).make("sqlite", path))


def test_a_program_without_simulations_has_no_states_to_take(desk: Desk, tmp_path: Path) -> None:
    written(tmp_path, "m", firing(3))
    answer = download(desk, tmp_path, "m", "states.csv")
    assert (answer.status, answer.body) == (409, b'{"error":"the recording has no states: no simulation has run in it"}')
    assert download(desk, tmp_path, "m", "events.csv").body.count(b"\r\n") == 4
    assert b'"states": 0' in desk.ask(tmp_path, "/api/recordings/m").body


@pytest.mark.slow
def test_all_forms_at_once_and_again_and_again_are_whole(desk: Desk, tmp_path: Path) -> None:
    """Eight clients, and others who ask for something else meanwhile."""
    talk = desk.begin(tmp_path, APERTURE, record=True)
    talk.say("step", ticks=30)
    talk.until("paused", tick=30)
    name = talk.facts["recording"]
    desk.do(talk.session.stop())
    app = make_app(tmp_path, GATE)
    app.state.sessions = talk.sessions
    forms = ("events.csv", "states.csv", "replay.html", "sqlite")
    once = {form: download(desk, tmp_path, name, form).body for form in forms}
    assert all(len(body) > 1000 for body in once.values())

    async def many() -> list[Answer]:
        asked = [call(app, f"/api/recordings/{name}/file", HOST, COOKIE, query=f"form={form}") for form in forms * 2]
        others = [call(app, f"/api/recordings/{name}{part}", HOST, COOKIE) for part in ("", "/curves", "/replay")]
        return await asyncio.gather(*asked, *others)

    answers = desk.do(many())
    assert [answer.status for answer in answers] == [200] * 11
    for form, answer in zip(forms * 2, answers, strict=False):
        assert answer.body == once[form], form
        assert int(answer.headers["content-length"]) == len(answer.body)


def test_a_download_goes_on_when_its_recording_is_renamed_or_deleted(desk: Desk, tmp_path: Path) -> None:
    path = written(tmp_path, "m", firing(2000, data="x" * 1000))
    app = make_app(tmp_path, GATE)
    app.state.sessions = desk.sessions(tmp_path)

    async def gone_meanwhile(form: str) -> tuple[Answer, Answer]:
        async def delete() -> None:
            path.unlink(missing_ok=True)

        asked = call(app, "/api/recordings/m/file", HOST, COOKIE, query=f"form={form}", first=delete)
        return await asked, await call(app, "/api/recordings/m/file", HOST, COOKIE, query=f"form={form}")

    whole = path.read_bytes()
    for form in ("sqlite", "events.csv"):
        path.write_bytes(whole)
        answer, after = desk.do(gone_meanwhile(form))
        assert (answer.status, len(answer.body)) == (200, int(answer.headers["content-length"]))
        assert len(answer.body) > 1_000_000
        assert (after.status, after.body) == (404, b'{"error":"there is no such recording"}')


def test_the_columns_of_states_have_the_names_of_joints(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, APERTURE, record=True)
    talk.say("step", ticks=3)
    talk.until("paused", tick=3)
    name = talk.facts["recording"]
    head, *rows = csv.reader(io.StringIO(download(desk, tmp_path, name, "states.csv").body.decode()))
    assert len(rows) == 4
    assert all(len(row) == len(head) == len(set(head)) for row in rows)
    assert head[:2] == ["time [s]", "mujoco time [s]"]
    assert {"qpos walker_torso_yaw [rad]", "qvel walker_torso_yaw [rad/s]"} <= set(head)
    curve = json.loads(desk.ask(tmp_path, f"/api/recordings/{name}/curves").body)["curves"]["walker_torso_yaw"]
    column = head.index("qpos walker_torso_yaw [rad]")
    assert [math.degrees(float(row[column])) for row in rows] == pytest.approx(curve)


JOINTS = """
<mujoco>
  <size nuserdata="2"/>
  <worldbody>
    <body name="held" mocap="true"/>
    <body name="box"><freejoint name="loose"/><geom size="1"/>
      <body name="arm"><joint name="elbow" type="ball"/><geom size="1"/>
        <body><joint name="rail" type="slide"/><joint type="hinge"/><geom name="tip" size="1"/></body>
      </body>
    </body>
  </worldbody>
  <equality><weld name="grip" body1="held" body2="box"/></equality>
  <actuator><motor name="pull" joint="rail"/><intvelocity name="creep" joint="rail" actrange="0 1"/></actuator>
</mujoco>"""


def test_each_number_of_a_state_has_a_name_and_its_own_place() -> None:
    model = mujoco.MjModel.from_xml_string(JOINTS)
    data = mujoco.MjData(model)
    columns = state_columns(model)
    state = np.zeros(mujoco.mj_stateSize(model, INTEGRATION))
    assert len(columns) == len(set(columns)) == len(state)
    for name, field in {
        "qpos loose z [m]": data.qpos[2:3],
        "qpos elbow qw": data.qpos[7:8],
        "qpos rail [m]": data.qpos[11:12],
        "qpos joint 3 [rad]": data.qpos[12:13],
        "qvel loose wz [rad/s]": data.qvel[5:6],
        "qvel elbow wx [rad/s]": data.qvel[6:7],
        "qvel rail [m/s]": data.qvel[9:10],
        "act creep": data.act,
        "ctrl creep": data.ctrl[1:2],
        "qacc_warmstart joint 3 [rad/s^2]": data.qacc_warmstart[10:11],
        "qfrc_applied rail [N]": data.qfrc_applied[9:10],
        "xfrc_applied arm ty [N m]": data.xfrc_applied[3, 4:5],
        "mocap_pos held y [m]": data.mocap_pos[0, 1:2],
        "mocap_quat held qx": data.mocap_quat[0, 1:2],
        "userdata 1": data.userdata[1:2],
    }.items():
        field[:] = 0.123
        mujoco.mj_getState(model, data, state, INTEGRATION)
        assert state[columns.index(name)] == 0.123, name
        field[:] = 0
    assert "eq_active grip" in columns
