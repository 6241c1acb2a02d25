"""Models that do their worst: the server lives, tells what happened, ends them, and runs the next."""

from __future__ import annotations

import json
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import pytest

from actr3d.values import plain, to_json
from tests.helpers.sessions import PATIENCE, Desk
from tests.workbench.worker.test_worker import gone, of, runs_again
from workbench.worker.memory import TOO_MUCH_MEMORY
from workbench.worker.messages import shortened
from workbench.worker.spawn import ForkServer
from workbench.worker.truncation import LARGEST, bounded_json, cut


def number_in(mark: Path) -> int:
    """Waits for a process number that a model has written."""
    end = time.monotonic() + PATIENCE
    while not (mark.is_file() and mark.read_text(encoding="utf-8")):
        assert time.monotonic() < end
        time.sleep(0.01)
    return int(mark.read_text(encoding="utf-8"))


def awaits_end(pid: int) -> None:
    end = time.monotonic() + PATIENCE
    while not gone(pid):
        assert time.monotonic() < end, pid
        time.sleep(0.02)


DAEMON = """
import os, sys, time
pid = os.fork()
if pid == 0:
    os.setsid()
    if os.fork() == 0:
        os.setsid()
        open({mark!r}, "w").write(str(os.getpid()))
        time.sleep(1000)
    os._exit(0)
os.waitpid(pid, 0)
while not (os.path.exists({mark!r}) and os.path.getsize({mark!r})):
    time.sleep(0.01)
"""
"""A model that hides a process as daemons do, and goes on once that is there: when it ends, what it has left is ended with it."""


@pytest.mark.skipif(sys.platform != "linux", reason="only Linux lets a process adopt those whose parents have ended")
@pytest.mark.parametrize("then", ["while True: pass\n", "os._exit(1)\n", "print('over')\n"])
def test_daemons_end_with_their_model(desk: Desk, tmp_path: Path, then: str) -> None:
    mark = tmp_path / "daemon"
    talk = desk.begin(tmp_path, DAEMON.format(mark=str(mark)) + then, run=True, wait=None)
    daemon = number_in(mark)
    if "_exit" not in then:
        talk.say("stop")
    awaits_end(daemon)
    runs_again(talk, tmp_path)


@pytest.mark.parametrize(
    "does",
    [
        "os.fork()",
        "pid = os.fork(); pid or os._exit(0)",
        "pid = os.fork(); pid or sys.exit(3)",
        "import multiprocessing; multiprocessing.get_context('fork').Process(target=print).start()",
    ],
)
def test_a_model_that_forks_goes_on_in_one_process(desk: Desk, tmp_path: Path, does: str) -> None:
    talk = desk.begin(tmp_path, of(f"{does}; goal.set('done'); print('once')"), record=True, run=True, wait=None)
    talk.wait(lambda: talk.facts["run"] == 1 and talk.state["status"] == "ended")
    talk.wait(lambda: talk.session.log.next == talk.state["events"])
    assert [event[3]["text"] for event in talk.events if event[2] == "output"] == ["once"]
    name = talk.facts["recording"]
    talk.say("stop")
    assert talk.summary(name).events == talk.session.log.next


def test_a_child_that_holds_the_wire_does_not_hold_up_the_end(desk: Desk, tmp_path: Path) -> None:
    mark = tmp_path / "child"
    does = f"pid = os.fork(); open({str(mark)!r}, 'w').write(str(pid)) if pid else time.sleep(1000); os._exit(5)"
    talk = desk.begin(tmp_path, of(does), run=True, wait=None)
    talk.wait_for_notice("exit code 5")
    awaits_end(number_in(mark))
    runs_again(talk, tmp_path)


@pytest.mark.slow
def test_a_model_that_ends_the_process_all_come_from_ends_all_runs_and_no_more(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """Also if a user restarts before that process has been replaced."""

    def end_slowly(fork_server: ForkServer) -> None:
        time.sleep(1)
        end(fork_server)

    end = ForkServer.end
    monkeypatch.setattr(ForkServer, "end", end_slowly)
    desk = Desk()
    try:
        (tmp_path / "other").mkdir()
        other = desk.begin(tmp_path / "other", of("goal.set('done')"))
        talk = desk.begin(tmp_path, of("os.kill(os.getppid(), signal.SIGKILL); time.sleep(1000)"), run=True, wait=None)
        for told in (talk, other):
            told.wait_for_notice("the process that starts all models has ended")
            told.until("failed")
        runs_again(talk, tmp_path)
        runs_again(other, tmp_path / "other")
    finally:
        desk.close_sessions()
        desk.close()


@pytest.mark.parametrize(
    "does",
    [
        "os.write(1, bytes(range(256)) * 4000)",
        "[os.write(2, b'x' * 10**6) for _ in range(100)]",
        "[os.write(1, b'x\\n' * 500_000) for _ in range(50)]",
    ],
)
def test_whatever_it_writes_past_print_it_goes_on(desk: Desk, tmp_path: Path, does: str) -> None:
    talk = desk.begin(tmp_path, of(f"{does}; goal.set('done')"), run=True, wait=None)
    talk.wait(lambda: talk.facts["run"] == 1 and talk.state["status"] == "ended" and talk.state["time"] == 10.0)
    assert sum(len(notice) for _, notice in talk.session.notices) < 5_000_000
    runs_again(talk, tmp_path)


def test_a_folder_that_is_gone(desk: Desk, tmp_path: Path) -> None:
    (tmp_path / "there").mkdir()
    does = f"os.chdir({str(tmp_path / 'there')!r}); os.rmdir({str(tmp_path / 'there')!r}); goal.set('done')"
    talk = desk.begin(tmp_path, of(does), run=True, wait=None)
    talk.wait(lambda: talk.facts["run"] == 1 and talk.state["status"] == "ended" and talk.state["time"] == 10.0)
    runs_again(talk, tmp_path)


@pytest.mark.slow
@pytest.mark.parametrize(
    "does",
    [
        "print('x' * 300_000_000)",
        "goal.set('text:' + 'x' * 30_000_000)",
        "raise ValueError('x' * 30_000_000)",
        "raise ValueError('x' * 400_000_000)",
    ],
)
def test_what_is_very_long_is_shown_in_part(desk: Desk, tmp_path: Path, does: str) -> None:
    talk = desk.begin(tmp_path, of(f"{does}; goal.clear()"), run=True, wait=None)
    talk.wait(lambda: talk.facts["run"] == 1 and talk.state["status"] in ("ended", "failed"))
    talk.wait(lambda: talk.session.log.next == talk.state["events"])
    told = json.dumps([talk.events, talk.notices])
    assert "more characters" in told or "not enough memory is left to say more" in told
    assert len(told) < 1_000_000
    assert not any("malformed message" in notice["text"] for notice in talk.notices)
    runs_again(talk, tmp_path)


FLOOD = """
from actr3d.actr import *

class Agent(ACTR):
    goal = Buffer()
    production_time = 0.000001
    def init():
        goal.set("n:0")
    def go(goal="n:?n"):
        {does}

Agent().run(1000)
"""


@pytest.mark.parametrize("does", ["goal.modify(n=int(n) + 1)", "[print(n, each) for each in range(1000)]; goal.modify(n=int(n) + 1)"])
def test_a_flood_of_events_is_shown_with_its_gaps_and_stopped(desk: Desk, tmp_path: Path, does: str) -> None:
    talk = desk.begin(tmp_path, FLOOD.format(does=does), run=True, wait="running")
    talk.wait(lambda: talk.session.log.next > 60_000)
    assert talk.session.log.first + len(talk.session.log._events) == talk.session.log.next
    begin = time.monotonic()
    talk.say("stop")
    assert time.monotonic() - begin < 10  # two seconds are promised; this machine may be busy
    runs_again(talk, tmp_path)


def test_a_flood_of_warnings_is_bounded(desk: Desk, tmp_path: Path) -> None:
    does = "import warnings; [warnings.warn(f'warning {n}') for n in range(50_000)]; goal.set('done')"
    talk = desk.begin(tmp_path, of(does), run=True, wait=None)
    talk.wait(lambda: talk.facts["run"] == 1 and talk.state["status"] == "ended")
    assert len(talk.notices) <= 500
    runs_again(talk, tmp_path)


@pytest.mark.slow
def test_memory_is_watched_where_the_system_does_not_limit_it() -> None:
    text = """
from workbench.worker import memory
import sys, time
memory.sys = type(sys)("sys")  # another system
memory.sys.platform = sys.argv[1]
memory.watch_memory(100)
kept = []
for _ in range(1000):
    kept.append(bytearray(b"x") * 10_000_000)
    time.sleep(0.01)
"""
    for platform, status in (("freebsd", TOO_MUCH_MEMORY), ("linux", 1)):
        done = subprocess.run([sys.executable, "-c", text, platform], capture_output=True, text=True, timeout=PATIENCE)
        assert done.returncode == status, done.stderr
        assert ("MemoryError" in done.stderr) == (platform == "linux")


# -- what bounds what is shown


def test_short_values_are_unchanged() -> None:
    values: list[Any] = [[1, "a", "b", {"text": "x" * 1000}], {}, None, [list(range(1000))]]
    for value in values:
        assert json.loads(bounded_json(value)) == value


@pytest.mark.parametrize(
    "number", [float("nan"), float("inf"), -float("inf"), 10**30, 1e300, -0.0, True, None, pytest.param(10**5000, id="huge")]
)
def test_numbers_that_json_does_not_have_are_written_as_in_recordings(number: Any) -> None:
    value = plain([5, "top.goal", "buffer", {"n": number, "text": "\ud800 ü", "list": (1, number)}])
    assert json.loads(bounded_json(value)) == json.loads(to_json(value))


@pytest.mark.daily(1)
@pytest.mark.parametrize(
    "data",
    [{"text": "x" * 10**6}, {"a": ["y" * 10**6] * 10}, {str(n): "z" * 100 for n in range(10_000)}, {"deep": [["w" * 1000] * 300] * 300}],
)
def test_long_values_are_shortened_to_the_limit(data: dict[str, Any]) -> None:
    told = bounded_json([5, "top.goal", "buffer", data])
    assert len(told) <= LARGEST + 100
    time, source, kind, some = json.loads(told)
    assert (time, source, kind) == (5, "top.goal", "buffer")
    assert "more" in json.dumps(some) or "too long" in json.dumps(some)


def test_what_is_cut_says_so() -> None:
    assert cut("x" * 2001) == "x" * 2000 + " … (1 more characters)"
    assert cut(list(range(202)))[-1] == "… (2 more)"
    assert cut(dict.fromkeys(range(203), 0))["…"] == "3 more"
    assert cut((1, "a", None)) == [1, "a", None]
    assert shortened("a" * 6000 + "b" * 6000).count("b") == 5000
    assert shortened("short") == "short"
