"""The verdict of a replay is reliable, whatever the recorded program does to its process."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

from actr3d.cli import main
from actr3d.errors import RecordingError
from actr3d.recording import Recorded
from actr3d.runner.replay_diff import Comparator
from actr3d.trace import TraceEvent
from tests.helpers.commands import run_command
from tests.helpers.recording_forgery import forge

PROGRAM = """import atexit, os, signal, sys, threading
from pathlib import Path
from actr3d.actr import *
class Counter(ACTR):
    goal = Buffer()
    def init():
        goal.set("count 0")
    def count(goal="count ?n!4"):
        goal.set("count %d" % (int(n) + 1))
    def end(goal="count 4"):
        self.stop()
again = os.environ.get("AGAIN") == "1"
print("begins")
if again:
    {first}
Counter().run()
print("ends")
if again:
    {last}
"""


@pytest.fixture(name="path")
def path_(tmp_path: Path) -> Path:
    return tmp_path / "run"


def run_recorded(path: Path, source: str) -> int:
    """Runs a program and records it; returns the exit code."""
    file = path.with_name("model.py")
    file.write_text(source, encoding="utf-8")
    return main(["run", str(file), "--seed", "1", "--record", str(path)])


def record(path: Path, first: str = "pass", last: str = "pass") -> None:
    assert run_recorded(path, PROGRAM.format(first=first, last=last)) == 0


def test_a_program_that_reads_its_input_finds_none_in_a_replay(path: Path) -> None:
    reading, writing = os.pipe()
    os.write(writing, b"Ann\n")
    command = [sys.executable, "-m", "actr3d", "run", "model.py", "--record", path.name]
    path.with_name("model.py").write_text("print('Hello', input())\n", encoding="utf-8")
    subprocess.run(command, cwd=path.parent, stdin=reading, check=True, timeout=60)
    again = [sys.executable, "-m", "actr3d", "replay", path.name]
    done = subprocess.run(again, cwd=path.parent, stdin=reading, capture_output=True, text=True, timeout=60, check=False)  # nothing comes
    os.close(reading)
    os.close(writing)
    assert done.returncode == 1
    assert done.stdout.startswith("differs: the run ended (EOFError: EOF when reading a line) after 0 events; ")


@pytest.mark.daily(5)
@pytest.mark.parametrize(
    ("does", "how"),
    [
        ("os._exit(0)", "the model's process ended with exit code 0"),
        ("os._exit(7)", "the model's process ended with exit code 7"),
        ("os.kill(os.getpid(), signal.SIGKILL)", "the model's process was ended by SIGKILL"),
        ("os.execv(sys.executable, [sys.executable, '-c', 'print(1)'])", "the model's process ended with exit code 0"),
        ("threading.Timer(0.05, os._exit, [0]).start(); threading.Event().wait()", "exit code 0"),
    ],
)
@pytest.mark.parametrize("where", ["first", "last"])
def test_a_program_that_ends_the_process_leaves_no_verdict(
    does: str, how: str, where: str, path: Path, monkeypatch: pytest.MonkeyPatch, capfd: pytest.CaptureFixture[str]
) -> None:
    record(path, **{where: does})
    monkeypatch.setenv("AGAIN", "1")
    temporary = path.with_name("temporary")
    temporary.mkdir()
    monkeypatch.setattr("tempfile.tempdir", str(temporary))
    monkeypatch.setenv("TMPDIR", str(temporary))
    capfd.readouterr()
    assert main(["replay", str(path)]) == 2
    assert not list(temporary.iterdir())
    captured = capfd.readouterr()
    assert captured.err.startswith("error: no verdict: ")
    assert how in captured.err
    assert "agrees" not in captured.out


def test_a_program_that_exits_from_its_last_handler_keeps_its_verdict(
    path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    record(path, first="atexit.register(os._exit, 0)")
    monkeypatch.setenv("AGAIN", "1")
    assert main(["replay", str(path)]) == 0
    assert "every byte agrees: " in capsys.readouterr().out
    forge(path, "UPDATE events SET data = replace(data, 'ends', 'went')")
    assert main(["replay", str(path)]) == 1
    assert "differs: event " in capsys.readouterr().out


@pytest.mark.daily(1)
@pytest.mark.parametrize(
    "does",
    [
        "os.closerange(3, 200)",
        '[os.write(number, b\'{"code": 0, "text": "every byte agrees"}\') for number in (1, 2)]',
        "os.fork() or os._exit(0)",
        "os.fork() and os._exit(0)",
        "sys.stdout.close()",
    ],
)
def test_a_program_that_meddles_with_its_process_is_still_found_to_differ(does: str, path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    record(path, first=f"{does}; print('another')")
    monkeypatch.setenv("AGAIN", "1")
    assert main(["replay", str(path)]) == (2 if "and os._exit" in does else 1)


@pytest.mark.daily(1)
@pytest.mark.parametrize("sign", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])
def test_a_signal_that_ends_the_command_ends_the_replay(sign: signal.Signals, path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    mark = path.with_name("mark")
    record(path, first=f"Path({str(mark)!r}).write_text(str(os.getpid())); threading.Event().wait()")
    monkeypatch.setenv("AGAIN", "1")
    command = [sys.executable, "-m", "actr3d", "replay", str(path)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as replaying:
        while not (mark.exists() and mark.read_text(encoding="utf-8")):
            assert replaying.poll() is None
            time.sleep(0.01)
        child = int(mark.read_text(encoding="utf-8"))
        assert child != replaying.pid
        replaying.send_signal(sign)
        out, err = replaying.communicate(timeout=30)
    assert replaying.returncode == (130 if sign == signal.SIGINT else 128 + sign)
    assert (out, err) == ("", "stopped\n" if sign == signal.SIGINT else "")
    with pytest.raises(ProcessLookupError):
        os.kill(child, 0)


def test_a_replay_iterates_over_sets_in_the_recorded_order(path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    file = path.with_name("sets.py")
    file.write_text("print(list({'one', 'two', 'three', 'four', 'five', 'six', 'seven'}))\n", encoding="utf-8")
    assert run_command("run", str(file), "--record", str(path)).returncode == 0
    assert main(["replay", str(path)]) == 0
    assert "every byte agrees: 1 events" in capsys.readouterr().out


def test_forged_helpers_are_refused_in_one_line(path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    record(path)
    helpers = """INSERT OR REPLACE INTO facts VALUES ('helpers', '{"os": ["os.py", "x = 1"]}')"""
    forge(path, helpers)
    capsys.readouterr()
    assert main(["replay", str(path)]) == 2
    error = "error: the recording contains helper modules that no program can have loaded: Python uses modules of these names (os)\n"
    assert capsys.readouterr() == ("", error)


THREADS = """import threading
from actr3d.actr import *
class Counter(ACTR):
    goal = Buffer()
    def init():
        goal.set("count 0")
    def count(goal="count ?n!4"):
        print(n)
        goal.set("count %d" % (int(n) + 1))
    def end(goal="count 4"):
        self.stop()
thread = threading.Thread(target=lambda: Counter().run())
thread.start()
thread.join()
print("joined")
"""


def test_a_program_that_runs_its_model_in_a_thread_is_compared(path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    assert run_recorded(path, THREADS) == 0
    with Recorded(path) as recorded:
        count = recorded.event_count
    assert count > 10
    capsys.readouterr()
    assert main(["replay", str(path)]) == 0
    assert capsys.readouterr().out == f"every byte agrees: {count} events\n"
    forge(path, """UPDATE events SET data = replace(data, '"text":"2"', '"text":"7"')""")
    assert main(["replay", str(path)]) == 1
    assert '"text": "7"' in capsys.readouterr().out


def test_what_can_no_longer_be_read_never_agrees(path: Path) -> None:
    record(path)
    with Recorded(path) as recorded:
        comparator = Comparator(recorded)
    event = TraceEvent(0, "model", "output", {"text": "begins"})
    with pytest.raises(RecordingError, match="is closed"):
        comparator.event(event)
    with pytest.raises(RecordingError, match="is closed"):
        comparator.rest()


@pytest.mark.parametrize(("then", "note"), [("pass", ""), ("print('bye')", "; not checked: 1 event after that")])
def test_a_program_that_was_interrupted_in_a_production_agrees_until_then(
    then: str, note: str, path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    source = PROGRAM.format(first="pass", last="pass")
    source = source.replace(
        "    def end(", "    def pressed(goal='count 2'):\n        stop_here()\n        goal.set('count 3')\n    def end("
    )
    source = source.replace("count ?n!4", "count ?n!4!2")
    source = source.replace("again = ", "def stop_here():\n    if not again: raise KeyboardInterrupt\nagain = ")
    source = source.replace("Counter().run()\n", f"try:\n    Counter().run()\nfinally:\n    if not again: {then}\n")
    assert run_recorded(path, source) == 130
    monkeypatch.setenv("AGAIN", "1")
    capsys.readouterr()
    assert main(["replay", str(path)]) == 0
    out = capsys.readouterr().out
    assert out.startswith("agrees up to the end of the recording: ")
    assert out.endswith(f"; the recording says that the run was not over at 0.15 s, which cannot be checked{note}\n")


def test_a_program_that_went_on_after_it_was_interrupted_is_not_said_to_agree(
    path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    source = "import os\nfrom actr3d.actr import *\nclass Agent(ACTR):\n    goal = Buffer()\n    def init():\n        goal.set('a')\n"
    source += "    def stop_here(goal='a'):\n        if 'AGAIN' not in os.environ: raise KeyboardInterrupt\n        goal.clear()\n"
    source += "for number in range(2):\n    try: Agent().run()\n    except KeyboardInterrupt:\n        if number: raise\n"
    assert run_recorded(path, source) == 130
    monkeypatch.setenv("AGAIN", "1")
    capsys.readouterr()
    assert main(["replay", str(path)]) == 2
    assert "cannot be compared: its program went on after the user interrupted it" in capsys.readouterr().err


@pytest.mark.parametrize(("source", "failure"), [("def f(:", "model.py:1: invalid syntax"), ("1 / 0", "ZeroDivisionError")])
def test_a_program_that_failed_before_its_first_event_fails_again(
    source: str, failure: str, path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert run_recorded(path, source) == 1
    assert main(["replay", str(path)]) == 0
    out = capsys.readouterr().out
    assert out.startswith("agrees up to the end of the recording: 0 events; the run failed after 0 s (")
    assert failure in out
