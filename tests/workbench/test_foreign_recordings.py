"""Recordings that somebody made to hurt, or that come from elsewhere: nothing blocks or crashes the server, and nothing runs unasked."""

from __future__ import annotations

import asyncio
import json
import os
import shutil
import sqlite3
from collections.abc import Callable
from contextlib import closing
from pathlib import Path
from typing import Any
from urllib.parse import urlencode

import pytest

from actr3d.recording import Recorded
from actr3d.recording.key import key_file
from actr3d.world.compiled import to_text
from tests.helpers.asgi_client import COOKIE, GATE, HOST, JSON, ORIGIN, OURS, Answer, call
from tests.helpers.recording_forgery import forge
from tests.helpers.sessions import Desk, RefusedError, Talk
from tests.workbench.test_runs import firing, written
from workbench import listing, recording_routes
from workbench.app import make_app
from workbench.readers import Readers, ReadingError
from workbench.retention import RetentionLimits
from workbench.worker.messages import LONGEST

ENDLESS = "WITH RECURSIVE n(x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM n)"
WORLD: dict[str, Any] = {"walls": {}, "bodies": {}}


def altered(script: str) -> Callable[[Path], None]:
    def alter(path: Path) -> None:
        with closing(sqlite3.connect(path)) as file:
            file.executescript(script)

    return alter


def fact(name: str, value: str) -> Callable[[Path], None]:
    """Returns what gives a recording a fact, with checksums and seal as its maker would write them."""

    def give(path: Path) -> None:
        forge(path, lambda file: file.execute("INSERT OR REPLACE INTO facts VALUES (?, ?)", (name, value)))

    return give


def row(data: str) -> Callable[[Path], None]:
    def put(path: Path) -> None:
        forge(path, lambda file: file.execute("UPDATE events SET data = ?", (data,)))

    return put


def linked(path: Path) -> None:
    path.rename(path.with_suffix(".moved"))
    path.symlink_to(path.with_suffix(".moved"))


def torn(path: Path) -> None:
    path.write_bytes(path.read_bytes()[:5000])


HOSTILE: dict[str, Callable[[Path], None]] = {
    "endless": altered(f"DROP TABLE facts; CREATE VIEW facts AS {ENDLESS} SELECT x AS name, x AS value FROM n"),
    "computed": altered("DROP TABLE facts; CREATE TABLE facts (name TEXT, value AS (hex(zeroblob(400000000))))"),
    "trigger": altered("CREATE TRIGGER t AFTER INSERT ON facts BEGIN DELETE FROM facts; END"),
    "nested": fact("parameters", '{"a":' + "[" * 200_000 + "]" * 200_000 + "}"),
    "long": fact("parameters", json.dumps({"a": "x" * 3_000_000})),
    "list": fact("versions", "[1]"),
    "events": row("[" * 200_000 + "]" * 200_000),
    "torn": torn,
}


def test_half_a_character_that_a_model_prints_is_listed(desk: Desk, tmp_path: Path) -> None:
    written(tmp_path, "half", firing(3, data="half a character: \ud800"), failed="ValueError: \ud800")
    _, (found,) = desk.listed(tmp_path)
    assert (found.problem, found.failed) == (None, "ValueError: ?")


@pytest.fixture
def hostile(tmp_path: Path) -> Path:
    """A models folder with all of these, and a good one that is older."""
    written(tmp_path, "good", firing(3))
    for name, change in HOSTILE.items():
        change(written(tmp_path, name, firing(3)))
    linked(written(tmp_path, "linked", firing(3)))
    return tmp_path


def test_whatever_is_among_the_recordings_all_are_listed(desk: Desk, hostile: Path) -> None:
    total, found = desk.listed(hostile)
    assert (total, {summary.id for summary in found}) == (9, {"good", *HOSTILE})  # a link is left out
    problems = {summary.id: summary.problem for summary in found}
    assert problems.pop("good") is None
    assert all(problems.values()), problems
    assert problems["endless"] == problems["computed"] == problems["trigger"] == "not a recording: it has other tables than a recording"
    assert problems["long"] == "the description of its run is too long to be listed"


PARTS = ("file?form=events.csv", "file?form=states.csv", "file?form=replay.html", "curves", "code")


@pytest.mark.daily(1)
@pytest.mark.parametrize("turn", range(len(PARTS)))  # each of them asks for one part of each recording, and for all parts
def test_nothing_can_be_had_of_them_but_the_file_and_a_clear_error(desk: Desk, hostile: Path, turn: int) -> None:
    for number, name in enumerate(HOSTILE):
        place, _, query = PARTS[(number + turn) % len(PARTS)].partition("?")
        answer = desk.ask(hostile, f"/api/recordings/{name}/{place}", query=query)
        told: dict[str, Any] = json.loads(answer.body) if answer.status != 200 else {}
        assert answer.status == 409 or name in ("long", "events"), (name, place, query, answer.body)
        assert "/" not in told.get("error", ""), told
        assert desk.ask(hostile, f"/api/recordings/{name}/file").body == desk.sessions(hostile).recordings.path(name).read_bytes()
    assert desk.ask(hostile, "/api/recordings/linked").status == 404


@pytest.mark.daily(1)
@pytest.mark.parametrize(
    "scene",
    [
        lambda: "no scene",
        lambda: to_text(b"no scene"),
        lambda: to_text(b"\0" * LONGEST + b"\0"),  # takes half a second to make
        lambda: to_text(os.urandom(5000)),
    ],
    ids=["text", "bytes", "huge", "random"],
)
def test_a_damaged_scene_has_no_curves(desk: Desk, tmp_path: Path, scene: Callable[[], str]) -> None:
    path = written(tmp_path, "m", firing(3), kind="simulation", period_us=10_000, timestep_us=2000, world=WORLD)
    fact("compiled", json.dumps(scene()))(path)
    for place in ("curves", "file"):
        answer = desk.ask(tmp_path, f"/api/recordings/m/{place}", query="form=replay.html" if place == "file" else "")
        assert answer.status == 409, answer.body
        assert desk.ask(tmp_path, "/api/recordings/m").status == 200


@pytest.mark.slow
def test_a_file_that_takes_too_long_is_left_out_and_holds_up_no_other(desk: Desk, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(listing, "LONGEST", 1.0)
    paths = {name: written(tmp_path, name, firing(3)) for name in ("a", "b", "c")}
    sessions = desk.sessions(tmp_path)

    async def both() -> tuple[Any, Any]:
        whole = asyncio.create_task(sessions.listing.some())
        await asyncio.sleep(0.05)
        written(tmp_path, "late", firing(2))
        return await sessions.listing.one("late"), await whole

    with closing(sqlite3.connect(paths["b"], isolation_level=None)) as holder:
        holder.execute("BEGIN EXCLUSIVE")
        late, (total, found) = desk.do(both())
        holder.execute("COMMIT")
    assert late.events == 2
    assert (total, {summary.id: summary.problem for summary in found}) == (
        3,
        {"a": None, "b": "it takes longer than 1 s to read", "c": None},
    )


@pytest.mark.slow
def test_too_much_memory_is_reported(desk: Desk, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("workbench.readers.READER_MEMORY", 50)
    path = written(tmp_path, "m", firing(3))
    row(json.dumps([[0, "a", "fire", {"x": "y" * 100_000_000}]]))(path)
    with pytest.raises(ReadingError, match=r"reading it needs more memory than allowed|used more memory than it may"):
        desk.do(Readers(desk.workers).make("events.csv", path))


# -- whose code is run

MARKING = """from pathlib import Path
Path({mark!r}).touch()
from actr3d.actr import *
print("begun")
"""


@pytest.fixture
def foreign(desk: Desk, tmp_path: Path) -> Callable[[], bool]:
    """A recording «far» of a program, made by another installation; returns whether its code has been run since."""
    mark = tmp_path / "mark"
    talk = desk.begin(tmp_path, MARKING.format(mark=str(mark)), record=True, run=True, wait="ended")
    desk.do(talk.session.stop())
    recording = talk.sessions.recordings.path(talk.facts["recording"])
    path = recording.rename(recording.with_name("far.sqlite"))
    with Recorded(path) as recorded:
        assert recorded.made_here
    forge(path, key=b"another key")
    mark.unlink()
    return mark.exists


def post(desk: Desk, app: Any, place: str, **body: Any) -> Answer:
    return desk.do(call(app, f"/api{place}", HOST, COOKIE, ORIGIN, JSON, OURS, method="POST", body=json.dumps(body).encode()))


def test_code_from_elsewhere_is_run_only_if_the_user_says_so(desk: Desk, tmp_path: Path, foreign: Callable[[], bool]) -> None:
    app = make_app(tmp_path, GATE)
    app.state.sessions = sessions = desk.sessions(tmp_path)
    code = json.loads(desk.ask(tmp_path, "/api/recordings/far/code").body)
    assert (code["made_here"], code["source"], code["helpers"]) == (False, MARKING.format(mark=str(tmp_path / "mark")), {})
    for word in ("open", "replay"):
        answer = post(desk, app, f"/recordings/far/{word}")
        assert answer.status == 403
        assert "this installation did not make the recording" in json.loads(answer.body)["error"]
    for place in ("", "/file?form=events.csv", "/file?form=replay.html", "/curves", "/code", "/file"):
        path, _, query = f"/api/recordings/far{place}".partition("?")
        assert desk.ask(tmp_path, path, query=query).status == 200
    assert post(desk, app, "/compare", first="far", second="far").status == 200
    assert desk.listed(tmp_path)[0] == 1
    assert sessions.all() == []
    assert not foreign()
    assert json.loads(post(desk, app, "/recordings/far/replay", trust=True).body)["verdict"] == "agrees"
    assert foreign()
    assert post(desk, app, "/recordings/far/open", trust=True).status == 201


def test_a_recording_file_is_added_and_kept_but_none_of_its_code_is_run(
    desk: Desk, tmp_path: Path, foreign: Callable[[], bool], monkeypatch: pytest.MonkeyPatch
) -> None:
    app = make_app(tmp_path, GATE)
    app.state.sessions = sessions = desk.sessions(tmp_path)
    recordings = sessions.recordings
    data = recordings.path("far").read_bytes()

    def add(name: str, parts: list[bytes]) -> Answer:
        kind = ("content-type", "application/vnd.sqlite3")
        sent = call(
            app, "/api/recordings/import", HOST, COOKIE, ORIGIN, kind, OURS, method="POST", query=urlencode({"name": name}), parts=parts
        )
        return desk.do(sent)

    answer = add("walker-20200101-101010-abcd.sqlite", [data[:1000], data[1000:]])
    assert answer.status == 201, answer.body
    added = json.loads(answer.body)
    assert (added["id"], added["problem"], added["label"]["name"]) == ("walker-20200101-101010-abcd", None, "walker-20200101-101010-abcd")
    assert recordings.path(added["id"]).read_bytes() == data
    names = [json.loads(add(name, [data]).body)["id"] for name in ("far.sqlite", "../é b.sqlite", "..")]
    assert names == ["far-2", "___b", "recording"]
    recordings.tidy(RetentionLimits(number=1))
    assert {path.stem for path in recordings.all()} == {"far", added["id"], *names}
    assert post(desk, app, f"/recordings/{added['id']}/open").status == 403
    assert not foreign()

    answer = add("text.sqlite", [b"no recording" * 100])
    assert answer.status == 409
    assert "the file cannot be read: not a recording" in json.loads(answer.body)["error"]
    assert str(tmp_path) not in answer.body.decode()
    monkeypatch.setattr(recording_routes, "LARGEST_UPLOAD", 1000)
    assert add("large.sqlite", [data]).status == 413
    hidden = [path.name for path in recordings.path("far").parent.glob(".*")]
    assert sorted(hidden) == [".labels.json.lock", ".numbers.json.lock"]  # nothing is left of the refused files
    assert len(recordings.all()) == 5


def test_a_recording_of_this_installation_is_run_without_asking(desk: Desk, tmp_path: Path) -> None:
    assert key_file().parent.parent.name  # the data folder of the tests, not the user's
    written(tmp_path, "near", firing(1))
    app = make_app(tmp_path, GATE)
    app.state.sessions = desk.sessions(tmp_path)
    assert json.loads(desk.ask(tmp_path, "/api/recordings/near/code").body)["made_here"] is True
    assert post(desk, app, "/recordings/near/open").status == 201
    shutil.copy(tmp_path / ".workbench/recordings/near.sqlite", tmp_path / ".workbench/recordings/copy.sqlite")
    assert post(desk, app, "/recordings/copy/open").status == 201


HELPED = """from helper import WORD
from actr3d.actr import *
try:
    import other
    WORD = "the folder of the user"
except ImportError:
    pass
print(WORD)
"""


def test_an_opened_recording_runs_nothing_but_what_it_holds(desk: Desk, tmp_path: Path) -> None:
    elsewhere = tmp_path / "elsewhere"
    elsewhere.mkdir()
    (elsewhere / "helper.py").write_text('WORD = "recorded"\n', encoding="utf-8")
    talk = desk.begin(elsewhere, HELPED, record=True, run=True, wait="ended")
    desk.do(talk.session.stop())
    models = tmp_path / "models"
    (models / ".workbench" / "recordings").mkdir(parents=True)
    talk.sessions.recordings.path(talk.facts["recording"]).rename(models / ".workbench" / "recordings" / "far.sqlite")
    for name in ("helper.py", "other.py", "model.py"):
        (elsewhere / name).write_text('raise ValueError("run from the real folder")\n', encoding="utf-8")
    sessions = desk.sessions(models)
    again = Talk(desk, desk.do(sessions.reopen("far")), sessions)
    again.until("paused")
    again.say("run")
    again.until("ended")
    again.wait(lambda: again.session.log.next == again.state["events"])
    assert [data["text"] for _, _, kind, data in again.events if kind == "output"] == ["recorded"]
    with pytest.raises(RefusedError, match=r"model\.py"):  # a new run is of the user's own model of that name, and there is none
        again.say("restart")
