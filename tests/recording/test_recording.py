"""Recordings: one file per run, complete after a kill, and an error if it cannot be written."""

from __future__ import annotations

import json
import math
import os
import re
import signal
import sqlite3
import subprocess
import sys
import time
from contextlib import closing, nullcontext
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
import pytest

from actr3d.errors import RecordingError, SimulationError
from actr3d.recording import Recorded, Recording, writer
from actr3d.recording.schema import versions
from actr3d.runner.replay import replay
from actr3d.trace import TraceEvent
from tests.helpers.commands import run_command
from tests.helpers.paths import TESTS
from tests.helpers.walkers import driving

RUN = """
import sys
sys.path.insert(0, {tests!r})
from tests.helpers.walkers import driving
simulation = driving("none")
recording = simulation.record({path!r})
{before}
while True:
    simulation.step()
    if simulation.ticks % 10 == 0:
        print(simulation.ticks, flush=True)
"""


def program(path: Path, before: str = "") -> list[str]:
    return [sys.executable, "-c", RUN.format(tests=str(TESTS), path=str(path), before=before)]


def whole(path: Path) -> bool:
    with closing(sqlite3.connect(path)) as file:
        return file.execute("PRAGMA integrity_check").fetchone() == ("ok",)


def test_a_recording_holds_everything(tmp_path: Path) -> None:
    simulation = driving("all")
    states: list[bytes] = []
    simulation.observe(lambda seen: states.append(seen.state().mj_state.tobytes()))
    with simulation.record(tmp_path / "run", subject=7) as recording:
        simulation.run(0.5)
        simulation.command("aperture", width=0.5)
        simulation.run(0.5)
        recording.fact("place", "here")
    assert [path.name for path in tmp_path.iterdir()] == ["run"]
    assert simulation.trace is not None
    with Recorded(tmp_path / "run") as recorded:
        assert recorded.ticks == 100
        assert recorded.event_count == len(simulation.trace)
        assert [event.to_json() for event in recorded.events()] == [event.to_json() for event in simulation.trace]
        assert [state.data for state in recorded.states()][1:] == states
        counts = [state.events for state in recorded.states()]
        events = list(recorded.events())
        assert counts[100] == len(events)
        for tick in (0, 20, 55):  # some events at exactly the end of a tick are of the next one
            assert all(event.time <= tick / 100 for event in events[: counts[tick]])
            assert all(event.time >= tick / 100 for event in events[counts[tick] :])
        assert list(recorded.commands()) == [
            (1, 50, {"command": "aperture", "data": {"values": [], "named": {"width": 0.5}, "body": None}})
        ]
        expected = [(event.source, event.data["value"]) for event in simulation.trace.select("answer")]
        answers = list(recorded.answers())
        assert [(f"{answer.body}.body", answer.value) for answer in answers][: len(expected)] == expected
        assert len(answers) >= len(expected) > 10
        assert [answer.tick for answer in answers] == sorted(answer.tick for answer in answers)
        facts = recorded.facts
    assert (facts["seed"], facts["period_us"], facts["timestep_us"], facts["subject"], facts["place"]) == (1, 10_000, 2_000, 7, "here")
    assert facts["versions"] == versions()
    assert {"python", "mujoco", "numpy", "actr3d", "machine"} <= versions().keys()
    (source,) = facts["sources"].values()
    assert "class Driver(ACTR):" in source


def test_a_run_is_the_same_with_a_recording_or_without(tmp_path: Path) -> None:
    plain, recorded = driving(), driving()
    with recorded.record(tmp_path / "run"):
        plain.run(1)
        recorded.run(1)
    assert plain.world.state_bytes() == recorded.world.state_bytes()


def test_unusual_values_are_recorded_as_in_the_trace(tmp_path: Path) -> None:
    odd: dict[Any, Any] = {"inf": float("inf"), 1: "number", "object": object(), "word": "größe \ud800"}
    events = [TraceEvent(5, "top", "state", odd), TraceEvent(6, "top", "state", {"a": [1, (2, 3)]})]
    with Recording(tmp_path / "run", {"kind": "simulation"}) as recording:
        for event in events:
            recording.event(event)
    with Recorded(tmp_path / "run") as recorded:
        first, second = recorded.events()
    assert second.to_json() == events[1].to_json()
    assert first.data["inf"] == "inf"
    assert first.data["1"] == "number"
    assert json.loads(first.to_json())["data"]["word"].startswith("größe ")


@pytest.mark.parametrize("error", [MemoryError(), KeyboardInterrupt()])
def test_any_loss_of_items_stops_the_recording(error: BaseException, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def raising(*_: object) -> str:
        raise error

    recording = Recording(tmp_path / "run", {"kind": "simulation"})
    with monkeypatch.context() as patch:
        patch.setattr(writer, "_lines_of", raising)
        recording.event(TraceEvent(5, "top", "state", {"number": 1}))
        with pytest.raises(type(error)) if isinstance(error, KeyboardInterrupt) else nullcontext():
            recording._writer.flush()
    recording.event(TraceEvent(6, "top", "state", {"number": 2}))
    with pytest.raises(RecordingError, match=f"cannot write the recording '.*run': {type(error).__name__}; nothing was written"):
        recording.check()
    with pytest.raises(RecordingError):
        recording.close()
    assert list(tmp_path.iterdir()) == []


def test_an_answer_that_cannot_be_recorded_keeps_what_came_before(tmp_path: Path) -> None:
    recording = Recording(tmp_path / "run", {"kind": "simulation"})
    recording.event(TraceEvent(5, "top", "state", {"number": 1}))
    recording.flush()
    recording.event(TraceEvent(6, "top", "state", {"number": 2}))
    recording.answer(1, 1, "walker", "sensor", np.array([object()]))
    recording.flush()
    with pytest.raises(RecordingError, match=r"TypeError: .*; the first 1 events of the run are kept, nothing of what came after"):
        recording.close()
    with Recorded(tmp_path / "run") as recorded:
        assert [event.data["number"] for event in recorded.events()] == [1]


def test_a_text_that_cannot_be_encoded_is_kept_after_a_seek(tmp_path: Path) -> None:
    events = [TraceEvent(time, "top", "state", {"word": "größe \ud800", "answer": math.inf}) for time in (5, 6)]
    with Recording(tmp_path / "run", {"kind": "simulation"}) as recording:
        for event in events:
            recording.event(event)
        recording.cut(0, 1, 0, 0)
    with Recorded(tmp_path / "run") as recorded:
        assert [event.to_json() for event in recorded.events()] == [events[0].to_json()]


@pytest.mark.daily(1)
@pytest.mark.parametrize("wait", [0.6, 1.7])
def test_a_killed_run_leaves_all_but_the_last_second(wait: float, tmp_path: Path) -> None:
    path = tmp_path / "run"
    with subprocess.Popen(program(path), stdout=subprocess.PIPE, text=True) as process:
        assert process.stdout is not None
        printed: list[tuple[int, float]] = []
        while not printed or time.monotonic() - printed[0][1] < wait:
            printed.append((int(process.stdout.readline()), time.monotonic()))
        os.kill(process.pid, signal.SIGKILL)
        killed = time.monotonic()
        process.wait()
    due = max([tick for tick, when in printed if when < killed - 1], default=0)
    with Recorded(path) as recorded:
        assert recorded.ticks >= due
        states = list(recorded.states())
        events = list(recorded.events())
    assert whole(path)
    assert [state.tick for state in states] == list(range(len(states)))
    assert len(states) > 10
    assert states[-1].events <= len(events)
    again = driving("all")
    again.step(len(states) - 1)
    assert again.world.state_bytes() == states[-1].data
    assert again.trace is not None
    assert [event.to_json() for event in again.trace] == [event.to_json() for event in events[: states[-1].events]]


FAST = """
import os, signal
from actr3d.actr import *
class Counter(ACTR):
    goal = Buffer()
    def init():
        goal.set("count")
    def count(goal="count"):
        if self.now() >= 40.5:
            os.kill(os.getpid(), signal.SIGKILL)
Counter().run()
"""
FALLING = """
import os, signal
from actr3d.actr import *
from actr3d.simulation import Simulation
from actr3d.world import Floor, SimpleObject, Scene
simulation = Simulation(Scene(parts=(Floor(), SimpleObject(name="box", position=(0, 0, 1)))))
simulation.observe(lambda seen: simulation.ticks == 4_050 and os.kill(os.getpid(), signal.SIGKILL))
simulation.run(60)
"""


@pytest.mark.daily(1)
@pytest.mark.parametrize("source", [FAST, FALLING], ids=["without a body", "without events"])
def test_a_fast_run_that_is_killed_lacks_no_more_than_its_last_second(source: str, tmp_path: Path) -> None:
    (tmp_path / "fast.py").write_text(source, encoding="utf-8")
    assert run_command("run", str(tmp_path / "fast.py"), "--record", str(tmp_path / "run")).returncode == -signal.SIGKILL
    with Recorded(tmp_path / "run") as recorded:
        recorded.check()
        last = max([event.time for event in recorded.events()] + [state.tick / 100 for state in recorded.states()])
    assert 39.5 <= last <= 40.5


def test_a_paused_run_is_written_too(tmp_path: Path) -> None:
    simulation = driving()
    with simulation.record(tmp_path / "run"):
        simulation.step(20)
        deadline = time.monotonic() + 20
        while time.monotonic() < deadline:
            with Recorded(tmp_path / "run") as recorded:
                if recorded.ticks == 20:
                    break
            time.sleep(0.05)
        else:
            pytest.fail("nothing was written")


def test_a_reader_does_not_hold_up_the_end(tmp_path: Path) -> None:
    recording = Recording(tmp_path / "run", {"kind": "program"})
    recording.event(TraceEvent(0, "agent", "output", {"text": "one"}))
    recording._writer.flush()
    with Recorded(tmp_path / "run") as recorded:
        assert recorded.event_count == 1
        recording.event(TraceEvent(1, "agent", "output", {"text": "two"}))
        recording.close()
        assert recorded.event_count == 1  # it is read as it was then
    assert [path.name for path in tmp_path.iterdir()] == ["run"]


@pytest.mark.parametrize("how", ["deleted", "moved", "replaced"])
def test_a_recording_that_is_taken_away_during_the_run_is_reported_as_that(how: str, tmp_path: Path) -> None:
    path, moved = tmp_path / "run", tmp_path / "moved"
    recording = Recording(path, {"kind": "program"})
    recording.event(TraceEvent(0, "agent", "output", {"text": "one"}))
    recording.flush()
    path.rename(moved)
    if how != "moved":
        moved.unlink()
    if how == "replaced":
        path.write_text("precious", encoding="utf-8")
    recording.event(TraceEvent(1, "agent", "output", {"text": "two"}))
    gone = "it was deleted, moved or replaced during the run; if you moved it, its new place holds the run up to now"
    message = f"cannot write the recording '{path}': {gone}"
    with pytest.raises(RecordingError, match=f"^{re.escape(message)}$"):
        recording.close()
    if how == "moved":
        with Recorded(moved) as recorded:
            assert recorded.event_count == 2
    assert [(one.name, one.read_bytes()[:8]) for one in tmp_path.iterdir() if one != moved] == (
        [("run", b"precious")] if how == "replaced" else []
    )


SLOW = "import time; simulation.observe(lambda seen: time.sleep(0.002)); "
LIMIT = SLOW + "import resource, sys; sys.dont_write_bytecode = True; resource.setrlimit(resource.RLIMIT_FSIZE, (1_000_000, 1_000_000))"
FULL = SLOW + "recording._writer._file.execute('PRAGMA max_page_count = 250')"


@pytest.mark.daily(1)
@pytest.mark.parametrize(("before", "reason"), [(LIMIT, r""), (FULL, "the disk is full")])
def test_a_full_disk_stops_the_run_and_spoils_nothing(before: str, reason: str, tmp_path: Path) -> None:
    path = tmp_path / "run"
    done = subprocess.run(program(path, before), capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 1
    last = done.stderr.strip().splitlines()[-1]
    assert last.startswith(f"actr3d.errors.RecordingError: cannot write the recording '{path}': {reason}")
    with Recorded(path) as recorded:
        ticks = recorded.ticks
        kept = f"the first {ticks:,} ticks and {recorded.event_count:,} events of the run are kept, nothing of what came after"
        states = [state.data for state in recorded.states()]
    assert last.endswith(f"; {kept}; make room on the disk, then run it again" if before == FULL else f"; {kept}")
    assert whole(path)
    assert ticks > 10
    again = driving()
    again.step(ticks)
    assert again.world.state_bytes() == states[-1]


def test_a_folder_that_cannot_be_written_is_reported_before_the_run_begins() -> None:
    with TemporaryDirectory() as name:
        folder = Path(name)
        text = f"""
import os, sys
from actr3d.recording import Recording, schema
schema.versions()
if os.geteuid() == 0:
    os.setuid(65534)  # root may write anywhere
try:
    Recording({str(folder / "run")!r}, {{}})
except Exception as error:
    print(type(error).__name__, error)
"""
        folder.chmod(0o555)
        done = subprocess.run([sys.executable, "-c", text], capture_output=True, text=True, timeout=60, check=False)
        assert done.stdout == f"RecordingError cannot write the recording '{folder / 'run'}': Permission denied\n", done.stderr
        assert list(folder.iterdir()) == []
        folder.chmod(0o755)
        with pytest.raises(RecordingError, match="No such file or directory"):
            Recording(folder / "nowhere" / "run", {})


def test_an_existing_file_is_not_replaced(tmp_path: Path) -> None:
    path = tmp_path / "run"
    path.write_text("precious", encoding="utf-8")
    with pytest.raises(RecordingError, match="exists already"):
        driving().record(path)
    assert path.read_text(encoding="utf-8") == "precious"


def test_a_recording_begins_with_its_run(tmp_path: Path) -> None:
    simulation = driving()
    simulation.step()
    with pytest.raises(SimulationError, match=r"record\(\) must be called before the run starts"):
        simulation.record(tmp_path / "run")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (None, "no recording"),
        (b"no database at all", "is not a recording: it is a file of another kind, or damaged"),
        (b"", "is not a recording: it has other tables"),
    ],
)
def test_a_file_that_is_no_recording_is_reported(content: bytes | None, message: str, tmp_path: Path) -> None:
    path = tmp_path / "run"
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(RecordingError, match=message):
        Recorded(path)


def test_a_recording_of_another_format_is_refused(tmp_path: Path) -> None:
    with Recording(tmp_path / "run", {"form": "actr3d recording 9"}):
        pass
    with pytest.raises(RecordingError, match="says 'actr3d recording 9', this version reads"):
        Recorded(tmp_path / "run")


def test_the_run_waits_for_a_slow_disk(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    from actr3d.recording import recording as module

    monkeypatch.setattr(module, "MAX_WAITING", 50)
    simulation = driving()
    with simulation.record(tmp_path / "run") as recording:
        most = 0
        for _ in range(300):
            simulation.step()
            most = max(most, len(recording._writer.states))
    assert 1 < most <= 51
    with Recorded(tmp_path / "run") as recorded:
        assert recorded.ticks == 300


def test_a_run_is_recorded_once_at_a_time(tmp_path: Path) -> None:
    simulation = driving()
    with simulation.record(tmp_path / "run"):
        with pytest.raises(SimulationError, match="this run is being recorded already"):
            simulation.record(tmp_path / "other")
        simulation.step(2)
    assert not (tmp_path / "other").exists()
    with Recorded(tmp_path / "run") as recorded:
        assert recorded.ticks == 2


@pytest.mark.parametrize(
    ("facts", "message"),
    [
        ({"seed": 99}, "a recording sets 'seed' itself; give that fact another name"),
        ({"kind": "program"}, "a recording sets 'kind' itself"),
        ({"form": "mine"}, "a recording sets 'form' itself"),
        ({"failed": "no"}, "a recording sets 'failed' itself"),
        ({"subject": object()}, "the fact 'subject' cannot be recorded, only numbers, texts, and lists and dicts of these"),
        ({"subject": {"a": [{1: 2}]}}, r"the fact 'subject' cannot be recorded, .*: the keys of a dict must be texts \(got 1\)"),
    ],
)
def test_facts_that_a_user_may_not_set_are_refused(facts: dict[str, Any], message: str, tmp_path: Path) -> None:
    with pytest.raises(RecordingError, match=message):
        driving().record(tmp_path / "run", **facts)
    assert not (tmp_path / "run").exists()


def test_facts_are_read_back_as_they_were_given_and_tuples_as_lists(tmp_path: Path) -> None:
    given: dict[str, Any] = {"x": {"a": [1, -2.5, math.inf, None, True, {"b": "c"}]}, "y": (2, (3, "z"))}
    driving().record(tmp_path / "run", **given).close()
    with Recorded(tmp_path / "run") as recorded:
        assert recorded.facts["x"] == given["x"]
        assert recorded.facts["y"] == [2, [3, "z"]]


def test_names_that_sqlite_has_a_meaning_for_are_names_of_files(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    simulation = driving()
    with simulation.record(":memory:"):
        simulation.step(2)
    with Recorded(tmp_path / ":memory:") as recorded:
        assert recorded.ticks == 2
    with pytest.raises(RecordingError, match=r"cannot write the recording 'a.b': embedded null byte"):
        driving().record("a\0b")


def test_facts_without_a_value_are_damage(tmp_path: Path) -> None:
    with closing(sqlite3.connect(tmp_path / "run")) as file, file:
        file.executescript("CREATE TABLE facts (name TEXT, value TEXT); INSERT INTO facts VALUES ('form', NULL)")
    file.close()
    with pytest.raises(RecordingError, match="is not a recording"):
        Recorded(tmp_path / "run")


def test_events_that_a_seek_drops_can_be_copied_before(tmp_path: Path) -> None:
    simulation = driving()
    with simulation.record(tmp_path / "run", subject=7) as recording:
        simulation.run(0.3)
        simulation.command("aperture", width=0.5)
        simulation.run(0.3)
        simulation.seek(0.2)
        recording.copy_to(tmp_path / "before")
        with Recorded(tmp_path / "before") as before:  # it is closed immediately
            assert (before.ticks, before.facts["subject"], before.facts["ended"], before.over) == (60, 7, {"by": "left"}, False)
            assert [command.tick for command in before.commands()] == [30]
            assert [state.tick for state in before.states()] == list(range(61))
            same = replay(before, driving)
            assert (same.difference, same.ticks, same.events) == (None, 60, before.event_count)
        simulation.command("aperture", width=0.7)
        simulation.run(0.2)
    assert sorted(path.name for path in tmp_path.iterdir()) == ["before", "run"]
    with Recorded(tmp_path / "run") as after, Recorded(tmp_path / "before") as before:
        assert (after.ticks, [command.tick for command in after.commands()]) == (40, [20])
        assert "ended" not in after.facts
        one, other = list(after.states()), list(before.states())
        assert one[:21] == other[:21]
        assert one[40].data != other[40].data
        assert replay(after, driving).difference is None


def test_a_copy_of_a_run_that_was_over_says_how_it_ended(tmp_path: Path) -> None:
    simulation = driving()
    with simulation.record(tmp_path / "run") as recording:
        simulation.run(0.1)
        recording.fact("ended", {"by": "stop"})
        recording.copy_to(tmp_path / "over")
        recording.fact("ended", None)
        recording.copy_to(tmp_path / "left")
        recording.fact("failed", "NameError: x")
        recording.copy_to(tmp_path / "failed")
    for name, ended in (("over", {"by": "stop"}), ("left", {"by": "left"}), ("failed", None)):
        with Recorded(tmp_path / name) as recorded:
            assert recorded.facts["ended"] == ended


def test_a_copy_that_cannot_be_written_leaves_nothing_and_the_recording_continues(tmp_path: Path) -> None:
    (tmp_path / "there").write_text("precious", encoding="utf-8")
    simulation = driving()
    with simulation.record(tmp_path / "run") as recording:
        simulation.run(0.1)
        with pytest.raises(RecordingError, match="there': it exists already"):
            recording.copy_to(tmp_path / "there")
        with pytest.raises(RecordingError, match=r"cannot write the recording '.*nowhere/copy'"):
            recording.copy_to(tmp_path / "nowhere" / "copy")
        with pytest.raises(RecordingError, match="embedded null"):
            recording.copy_to("a\0b")
        simulation.run(0.1)
    assert (tmp_path / "there").read_text(encoding="utf-8") == "precious"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["run", "there"]
    with Recorded(tmp_path / "run") as recorded:
        assert recorded.ticks == 20


def test_a_copy_never_replaces_a_file_that_is_made_meanwhile(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    simulation, link = driving(), os.link

    def make_the_file_first(part: Path, target: Path) -> None:
        target.write_text("precious", encoding="utf-8")
        link(part, target)

    with simulation.record(tmp_path / "run") as recording:
        simulation.run(0.1)
        monkeypatch.setattr(os, "link", make_the_file_first)
        with pytest.raises(RecordingError, match="copy': it exists already"):
            recording.copy_to(tmp_path / "copy")
        monkeypatch.undo()
        recording.copy_to(tmp_path / "other")
    assert (tmp_path / "copy").read_text(encoding="utf-8") == "precious"
    assert sorted(path.name for path in tmp_path.iterdir()) == ["copy", "other", "run"]
    with Recorded(tmp_path / "other") as recorded:
        assert recorded.ticks == 10


def test_each_second_of_simulated_time_is_written_however_fast_the_run_is(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(writer, "INTERVAL", 1_000)  # nothing is written for the time on the wall
    simulation = driving()
    recording, events = simulation.record(tmp_path / "run"), Recording(tmp_path / "events", {"kind": "program"})
    simulation.run(2.05)
    for tenth in range(21):
        events.event(TraceEvent(tenth * 100_000, "agent", "output", {"text": "one"}))
    short = Recording(tmp_path / "short", {"kind": "program"})
    for _ in range(10):  # runs of half a second each
        for tenth in range(6):
            short.event(TraceEvent(tenth * 100_000, "agent", "output", {"text": "one"}))
    deadline = time.monotonic() + 20
    for name, ticks, count in (("run", 199, 0), ("events", 0, 20), ("short", 0, 50)):
        while True:
            with Recorded(tmp_path / name) as read:  # as a kill would leave it
                if read.ticks >= ticks and read.event_count >= count:
                    break
            assert time.monotonic() < deadline, name
            time.sleep(0.05)
    for one in (recording, events, short):
        one.close()


FULL_DISK = """
import resource, sys
sys.dont_write_bytecode = True
sys.path.insert(0, {tests!r})
from tests.helpers.walkers import driving
simulation = driving()
resource.setrlimit(resource.RLIMIT_FSIZE, ({size}, {size}))
with simulation.record({path!r}):
    while True:
        simulation.step()
"""


@pytest.mark.daily(1)
@pytest.mark.parametrize("size", [1_000, 20_000, 60_000])
def test_a_run_that_begins_on_a_full_disk_leaves_no_empty_recording(size: int, tmp_path: Path) -> None:
    path = tmp_path / "runs" / "run"
    path.parent.mkdir()
    code = FULL_DISK.format(tests=str(TESTS), path=str(path), size=size)
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == 1
    last = done.stderr.strip().splitlines()[-1]
    assert last.startswith(f"actr3d.errors.RecordingError: cannot write the recording '{path}': ")
    assert last.endswith("; nothing was written")
    assert list(path.parent.iterdir()) == []
