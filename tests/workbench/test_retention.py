"""How many recordings are kept, which are named, and what is told of those that cannot be opened."""

from __future__ import annotations

import asyncio
import json
import os
import shutil
import sqlite3
import subprocess
import sys
import time
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing
from pathlib import Path

import pytest

from actr3d.errors import RecordingError
from tests.helpers.asgi_client import JSON, ORIGIN, OURS
from tests.helpers.paths import MODELS
from tests.helpers.sessions import Desk
from workbench import app
from workbench.labels import Label, Labels
from workbench.recordings import Recordings
from workbench.retention import RetentionLimits, is_complete, is_unnamed
from workbench.trash import OWN, NotInTrashError, TrashError, empty_trash, move_to_trash, restore_from_trash

COUNTING = (MODELS / "counting.py").read_text(encoding="utf-8")


@pytest.fixture
def recordings(tmp_path: Path) -> Recordings:
    """Ten recordings of a kilobyte; the higher the number the newer."""
    found = Recordings(tmp_path)
    for number in range(10):
        path = found.new(f"model{number}")
        path.write_bytes(bytes(1000))
        os.utime(path, (1000 + number, 1000 + number))
    return found


def models(tmp_path: Path) -> list[str]:
    return sorted(path.stem.split("-")[0] for path in (tmp_path / OWN / "recordings").glob("*.sqlite"))


def test_a_run_gives_its_recording_a_name_that_is_none(tmp_path: Path) -> None:
    assert is_unnamed(Recordings(tmp_path).new("model-1"))
    assert not is_unnamed(Path("my best run.sqlite"))


def test_a_run_in_a_folder_that_cannot_be_written_is_shown_and_not_kept(desk: Desk, tmp_path: Path) -> None:
    (tmp_path / OWN).touch()  # as in a folder that is read-only, no folder can be made here
    talk = desk.begin(tmp_path, COUNTING, record=True)
    talk.say("run")
    talk.until("ended")
    facts = json.loads(talk.session.facts_json())
    assert facts["recording"] is None
    assert facts["not_kept"].startswith(f"Runs are not kept: the folder '{tmp_path / OWN / 'recordings'}' cannot be written: ")
    assert facts["not_kept"].endswith("To keep runs, copy the models to a folder that can be written, and start the workbench with it.")
    told = [json.loads(notice)["text"] for _, notice in talk.session.notices]
    assert told.count(facts["not_kept"]) == 1
    assert Recordings(tmp_path).all() == []
    assert Recordings(tmp_path).labels.problem is None  # the reason is given once
    (tmp_path / OWN).unlink()
    desk.do(talk.session.begin())
    talk.until("paused")
    assert json.loads(talk.session.facts_json())["not_kept"] is None


def test_the_oldest_go(recordings: Recordings, tmp_path: Path) -> None:
    recordings.tidy(RetentionLimits(number=10, megabytes=0))
    assert len(models(tmp_path)) == 10
    recordings.tidy(RetentionLimits(number=3, megabytes=0))
    assert models(tmp_path) == ["model7", "model8", "model9"]
    recordings.tidy(RetentionLimits(number=0, megabytes=0))
    assert len(models(tmp_path)) == 3


def test_the_largest_part_of_a_folder_goes_too(recordings: Recordings, tmp_path: Path) -> None:
    big = recordings.new("big")
    big.write_bytes(bytes(1_500_000))
    os.utime(big, (1005, 1005))
    recordings.tidy(RetentionLimits(number=0, megabytes=1))
    assert "big" not in models(tmp_path)
    assert len(models(tmp_path)) == 10


def test_what_a_user_has_named_stays(recordings: Recordings, tmp_path: Path) -> None:
    oldest = min((tmp_path / OWN / "recordings").glob("*.sqlite"), key=lambda path: path.stat().st_mtime)
    oldest.rename(oldest.with_name("kept.sqlite"))
    recordings.tidy(RetentionLimits(number=2, megabytes=0))
    assert models(tmp_path) == ["kept", "model9"]


def test_what_another_server_writes_stays(recordings: Recordings, tmp_path: Path) -> None:
    oldest = min((tmp_path / OWN / "recordings").glob("*.sqlite"), key=lambda path: path.stat().st_mtime)
    oldest.with_name(f"{oldest.name}-wal").touch()
    recordings.tidy(RetentionLimits(number=2, megabytes=0))
    assert models(tmp_path) == ["model0", "model9"]


def test_a_deleted_recording_is_restored_with_its_label_and_its_log(recordings: Recordings, desk: Desk, tmp_path: Path) -> None:
    path = recordings.all()[0]
    path.with_name(f"{path.name}-wal").write_bytes(b"log")
    recordings.labels.change(path.stem, {"name": "mine", "tags": ("x",)})
    trash = recordings.delete(path.stem)
    assert (path.exists(), recordings.labels.all()) == (False, {})
    assert sorted(each.name[5:] for each in (tmp_path / OWN / "trash").glob("*/*")) == sorted(
        (path.name, f"{path.name}-wal", f"{path.name}.origins.json")
    )
    answer = desk.ask(tmp_path, "/api/restore", ORIGIN, JSON, OURS, method="POST", body=json.dumps({"trash": trash}).encode())
    assert (answer.status, json.loads(answer.body)) == (200, {"restored": f".workbench/recordings/{path.name}"})
    assert (path.read_bytes(), path.with_name(f"{path.name}-wal").read_bytes()) == (bytes(1000), b"log")
    assert recordings.labels.all() == {path.stem: Label(name="mine", tags=("x",))}
    assert list((tmp_path / OWN / "trash").glob("*/*")) == []


def test_what_is_not_in_the_trash_or_would_replace_a_file_is_not_restored(recordings: Recordings, tmp_path: Path) -> None:
    path = recordings.all()[0]
    recording = path.relative_to(tmp_path).as_posix()
    for name in (recording, "..", "*", "a/b", ".workbench/trash/20990101-000000/ab12-model.py", f".workbench/trash/../{recording}"):
        with pytest.raises(NotInTrashError):
            restore_from_trash(tmp_path, name)
    trash = recordings.delete(path.stem)
    path.write_bytes(b"another one")
    with pytest.raises(TrashError, match=r"there is a '.*sqlite' already"):
        restore_from_trash(tmp_path, trash)
    assert path.read_bytes() == b"another one"
    path.unlink()
    restore_from_trash(tmp_path, trash)
    with pytest.raises(NotInTrashError):
        restore_from_trash(tmp_path, trash)
    assert path.read_bytes() == bytes(1000)


@pytest.mark.parametrize("origin", ["../outside.py", "/outside.py"])
def test_nothing_is_restored_to_a_place_outside_the_folder(tmp_path: Path, origin: str) -> None:
    (tmp_path / "model.py").touch()
    trash = move_to_trash(tmp_path, tmp_path / "model.py")
    facts = tmp_path / f"{trash}.origins.json"
    facts.write_text(facts.read_text("utf-8").replace('model.py"}', f'{origin}"}}'), "utf-8")
    assert origin in facts.read_text("utf-8")
    with pytest.raises(NotInTrashError):
        restore_from_trash(tmp_path, trash)
    assert (tmp_path / trash).is_file()


def test_a_folder_and_what_belongs_to_it_are_restored_though_they_have_one_name(tmp_path: Path) -> None:
    folder, report = tmp_path / OWN / "experiments" / "mine", tmp_path / OWN / "reports" / "mine"
    for each in (folder, report):
        each.mkdir(parents=True)
        (each / "file").write_text(each.parent.name, "utf-8")
    deleted = restore_from_trash(tmp_path, move_to_trash(tmp_path, folder, report))
    assert deleted.path == ".workbench/experiments/mine"
    assert [(each / "file").read_text("utf-8") for each in (folder, report)] == ["experiments", "reports"]


def test_a_recording_that_another_program_writes_is_not_deleted(tmp_path: Path) -> None:
    recordings = Recordings(tmp_path)
    path = recordings.new("model")
    program = subprocess.Popen([sys.executable, "-c", WRITING, str(path)], stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
    with program:
        assert program.stdout is not None
        assert program.stdout.readline() == "writes\n"
        with pytest.raises(RecordingError, match="another program still writes this recording"):
            recordings.delete(path.stem)
        answer, _ = program.communicate("\n")
    assert answer == "closed\n"
    recordings.delete(path.stem)
    assert not path.exists()


WRITING = """
import sys
from pathlib import Path
from actr3d.recording.writer import Writer
writer = Writer(Path(sys.argv[1]), [("kind", '"program"')])
print("writes", flush=True)
input()
writer.facts.append(("more", "1"))
writer.close()
print("closed", flush=True)
"""


def test_old_deleted_files_are_removed_while_the_workbench_runs_on(desk: Desk, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    old = tmp_path / OWN / "trash" / "20200101-000000"
    sessions = desk.sessions(tmp_path)

    async def wait() -> None:
        closing = asyncio.Event()
        keeping = asyncio.create_task(app.keep_tidy(sessions, RetentionLimits(), closing))
        for _ in range(3):
            old.mkdir(parents=True)
            while old.exists():
                await asyncio.sleep(0.001)
        closing.set()
        await keeping

    monkeypatch.setattr(app, "DAY", 0.001)
    desk.do(wait())


def test_what_was_deleted_long_ago_is_removed_from_the_trash(tmp_path: Path) -> None:
    trash = tmp_path / OWN / "trash"
    for name in ("20200101-000000", "29990101-000000", "notes"):
        (trash / name).mkdir(parents=True)
        (trash / name / "ab12-model.py").touch()
    empty_trash(tmp_path)
    assert sorted(folder.name for folder in trash.iterdir()) == ["29990101-000000", "notes"]
    empty_trash(tmp_path / "nothing")


def test_unfinished_files_of_killed_processes_are_removed_the_next_day(recordings: Recordings, tmp_path: Path) -> None:
    folder = tmp_path / OWN / "recordings"
    recordings.labels.change("kept", {"note": "x"})
    for name in (".old.sqlite.part", ".old.sqlite.part-journal", ".0123.tmp", ".new.sqlite.part"):
        (folder / name).touch()
        if "new" not in name:
            os.utime(folder / name, (1000, 1000))
    recordings.tidy(RetentionLimits())
    assert sorted(path.name for path in folder.glob(".*")) == [".labels.json.lock", ".new.sqlite.part"]
    assert len(models(tmp_path)) == 10


def test_a_recording_that_a_killed_process_has_left_is_completed_when_the_workbench_starts(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, "print('x')\n", record=True, run=True, wait="ended")
    path = talk.sessions.recordings.path(talk.facts["recording"])
    copy = path.with_name("model-20200101-000000-abcd.sqlite")
    for end in ("", "-wal"):
        shutil.copy(path.with_name(path.name + end), copy.with_name(copy.name + end))
    desk.do(talk.session.stop())
    assert not is_complete(copy)
    desk.do(app.tidy(talk.sessions, RetentionLimits()))
    assert {each.name for each in path.parent.glob("*.sqlite*")} == {path.name, copy.name}


def test_labels_that_two_servers_change_at_once_are_all_kept(tmp_path: Path) -> None:
    def change(number: int) -> None:
        Labels(tmp_path).change(f"recording{number}", {"note": "x"})  # as each server has an object of its own

    with ThreadPoolExecutor(8) as pool:
        list(pool.map(change, range(40)))
    assert len(Labels(tmp_path).all()) == 40


def test_what_cannot_be_opened_is_listed_with_the_reason(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, "print('x')\n", record=True)
    talk.say("stop")
    recordings = talk.sessions.recordings
    folder = tmp_path / OWN / "recordings"
    (folder / "none.sqlite").write_bytes(b"no database at all, but some text that is long enough" * 100)
    (folder / "empty.sqlite").write_bytes(b"")
    with closing(sqlite3.connect(folder / "older.sqlite")) as older, older:
        older.execute("CREATE TABLE runs (x)")
    older.close()
    told = {summary.id: summary for summary in desk.listed(tmp_path)[1]}
    assert len(told) == 4
    assert told[talk.facts["recording"]].problem is None
    for name in ("none", "empty", "older"):
        assert told[name].problem
        assert talk.summary(name) == told[name]
        recordings.delete(name)
    assert desk.listed(tmp_path)[0] == 1


def test_a_run_that_never_began_leaves_no_recording(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, "print('hello')\n", record=True)
    first = talk.session.start
    assert first is not None
    assert first.record is not None
    talk.wait(lambda: Path(first.record or "").is_file())
    talk.say("restart")
    talk.wait(lambda: talk.session.start is not first and talk.state["status"] == "paused" and not Path(first.record or "").exists())
    second = talk.session.start
    talk.say("run")
    talk.until("ended")
    talk.say("restart")
    talk.wait(lambda: talk.session.start is not second and talk.state["status"] == "paused")
    desk.do(talk.session.stop())
    names = {Path(start.record).stem for start in (second, talk.session.start) if start is not None and start.record is not None}
    assert {summary.id for summary in desk.listed(tmp_path)[1]} == names


def test_a_labelled_recording_of_a_run_that_never_began_is_kept(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, "print('hello')\n", record=True)
    name, recordings = talk.facts["recording"], talk.sessions.recordings
    recordings.labels.change(name, {"note": "the first"})
    talk.say("restart")
    talk.wait(lambda: talk.facts["recording"] != name and talk.state["status"] == "paused")
    desk.do(talk.sessions.close(talk.session.name))
    assert recordings.path(name).is_file()
    assert [path.stem for path in recordings.all()] == [name]
    assert recordings.labels.all()[name].note == "the first"


def test_a_run_that_never_began_leaves_no_recording_when_its_session_is_closed(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, "print('hello')\n", record=True)
    desk.do(talk.sessions.close(talk.session.name))
    assert talk.sessions.recordings.all() == []


def test_the_recording_of_a_program_is_being_written_from_its_first_line(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, SLOW, record=True, run=True, wait=None)
    mark = tmp_path / "begun"
    while not mark.is_file():
        time.sleep(0.01)
    assert talk.facts["loading"]
    (path,) = talk.sessions.recordings.all()
    assert talk.sessions.writing() == {path.stem: talk.session.name}
    desk.do(talk.sessions.close(talk.session.name))
    assert talk.sessions.writing() == {}


SLOW = """
import pathlib, time
from actr3d.simulation import Simulation
from actr3d.world import Floor, Scene
pathlib.Path(__file__).with_name("begun").touch()
time.sleep(1000)
Simulation(Scene(parts=(Floor(),)), {}).run(1)
"""


def test_quick_restarts_leave_no_recordings_of_runs_that_never_began(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, "print('hello')\n", record=True)
    for pause in (0.0, 0.02, 0.05, 0.1, 0.0):
        talk.say("restart")
        time.sleep(pause)

    def last_is_there() -> bool:
        session = talk.session
        return not session.is_loading and session.state is not None and session.start is not None and session.start.attempt == 6

    talk.wait(last_is_there)
    last = talk.session.start
    assert last is not None
    assert last.record is not None
    folder = Path(last.record).parent
    talk.wait(
        lambda: [path.name for path in folder.iterdir() if path.suffix == Path(last.record or "").suffix] == [Path(last.record or "").name]
    )


def test_what_was_printed_before_the_first_tick_is_kept(desk: Desk, tmp_path: Path) -> None:
    from workbench.event_log import LatestEvents
    from workbench.session import never_begun

    talk = desk.begin(tmp_path, "x = 1\n", record=True)
    state = talk.session.state
    assert never_begun(state, LatestEvents())
    assert not never_begun(None, LatestEvents())
    log = LatestEvents()
    log.add(0, [b'[0,"top","output",{"text":"hello"}]'])
    assert not never_begun(state, log)
