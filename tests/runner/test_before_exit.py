"""Models that end their own process: their output and recording are kept, and the command reports what is kept."""

from __future__ import annotations

import os
import signal
import sys
from pathlib import Path

import pytest

from actr3d.recording import Recorded
from actr3d.runner.before_exit import before_the_end, how_it_ended
from tests.helpers.commands import run_command

BUILT = """
import os
from actr3d.actr import *
from actr3d.simulation import Simulation
from actr3d.world import Floor, Scene
class Counter(ACTR):
    goal = Buffer()
    def init():
        goal.set("go")
    def end(goal="go"):
        print("one")
        print("two", end="")
        {end}
def build() -> Simulation:
    return Simulation(Scene(parts=(Floor(),)), bodiless={{"counter": Counter}})
"""
PROGRAM = "import os, sys, threading, time\nprint('one')\nprint('two', end='')\n{end}\n"


@pytest.mark.daily(4)
@pytest.mark.parametrize("text", [PROGRAM, BUILT], ids=["program", "built"])
@pytest.mark.parametrize(
    ("end", "code"),
    [
        ("os._exit(3)", 3),
        ("os.abort()", -6),
        ("os.execv('/bin/true', ['true'])", 0),
        ("os.fork() or os._exit(7); os.wait(); os._exit(4)", 4),
        ("import signal; os.kill(os.getpid(), signal.SIGTERM)", -15),
        ("import signal; signal.raise_signal(signal.SIGKILL)", -9),
        ("import threading; threading.Thread(target=os._exit, args=[5]).start(); threading.Event().wait(9)", 5),
    ],
)
def test_a_model_that_ends_its_process_loses_nothing(text: str, end: str, code: int, tmp_path: Path) -> None:
    file, path = tmp_path / "model.py", tmp_path / "run"
    file.write_text(text.format(end=end), encoding="utf-8")
    done = run_command("run", str(file), "--seed", "1", "--record", str(path))
    assert (done.returncode, done.stdout) == (code, "one\ntwo")
    assert f"the model has ended its own process; '{path}' holds the run until then, without its end" in done.stderr
    with Recorded(path) as recorded:
        recorded.check()
        assert [event.data["text"] for event in recorded.events() if event.kind == "output"] == ["one", "two"]
        assert "ended" not in recorded.facts


def test_the_run_is_also_kept_if_the_arguments_are_named(monkeypatch: pytest.MonkeyPatch) -> None:
    def do_nothing(**_: object) -> None:
        pass

    monkeypatch.setattr(os, "_exit", do_nothing)
    monkeypatch.setattr(os, "execve", do_nothing)
    kept: list[bool] = []
    with before_the_end(kept.append):
        os._exit(status=3)
        os.execve(path=sys.executable, argv=["python"], env={})
    assert kept == [True, True]


def test_what_came_before_a_signal_without_a_name_is_kept(monkeypatch: pytest.MonkeyPatch) -> None:
    def do_nothing(*_: object) -> None:
        pass

    monkeypatch.setattr(os, "kill", do_nothing)
    kept: list[bool] = []
    with before_the_end(kept.append):
        os.kill(os.getpid(), signal.SIGRTMIN + 1)
    assert kept == [True]
    assert how_it_ended(-signal.SIGRTMIN - 1) == f"was ended by signal {signal.SIGRTMIN + 1}"


@pytest.mark.parametrize(
    "tries",
    [
        "os.execv('/nonexistent', ['x'])",
        "os.execvp('no such program', ['x'])",
        "os.kill(os.getpid(), 0); raise OSError",
    ],
)
def test_a_model_that_fails_to_end_its_process_continues(tries: str, tmp_path: Path) -> None:
    file, path = tmp_path / "model.py", tmp_path / "run"
    file.write_text(f"import os\nprint('a', end=' ')\ntry:\n    {tries}\nexcept OSError:\n    print('b')\n", encoding="utf-8")
    done = run_command("run", str(file), "--record", str(path))
    assert (done.returncode, done.stdout, done.stderr) == (0, "a b\n", "")
    with Recorded(path) as recorded:
        assert [event.data["text"] for event in recorded.events() if event.kind == "output"] == ["a b"]
        assert recorded.facts["ended"] == {"by": "end"}
