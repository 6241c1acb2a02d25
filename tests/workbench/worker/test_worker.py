"""Whatever a model does, the server goes on, tells what happened, and the next run begins."""

from __future__ import annotations

import asyncio
import os
import signal
import socket
import subprocess
import sys
import time
from pathlib import Path
from typing import Any, cast

import pytest

from actr3d.camera.kernel.scan import row_tracer, scan, scene_setter
from actr3d.recording import Recorded
from actr3d.vision.detectors.obstacle import obstacle
from actr3d.vision.detectors.opening import opening
from actr3d.vision.kernel import detect
from tests.helpers.camera_scenes import seen
from tests.helpers.sessions import Desk, RefusedError, Talk
from workbench.jobs import Job, doing
from workbench.page_commands.agents import Explain
from workbench.worker.fork_server import compile_camera, compile_detectors
from workbench.worker.messages import AskPosition, Start

AGENT = """
import os, signal, sys, time
from actr3d.actr import *

class Agent(ACTR):
    goal = Buffer()
    def init():
        goal.set("go")
    def go(goal="go"):
        {does}

agent = Agent()
agent.run(10)
"""

WALKER = """from actr3d.actr import *
from actr3d.simulation import BodyPort, Simulation
from actr3d.world import Floor, Mannequin, Scene

class Walker(ACTR):
    goal = Buffer()
    skin = BodyPort()
    def init():
        goal.set("go")
    def go(goal="go"):
        goal.set("gone")
        skin.set("walk_to", 3, 1.5)

def build() -> Simulation:
    return Simulation(Scene(parts=(Floor(), Mannequin(name="walker"))), {"walker": Walker})
"""


WIRES = "import gc, workbench.worker.channel as l; links = [o for o in gc.get_objects() if type(o) is l.Channel];"
"""Finds what a model has no business with."""


CLOSED = "the model closed the connection of its process to the workbench"


def of(does: str) -> str:
    return AGENT.replace("{does}", does)


def runs_again(talk: Talk, folder: Path) -> None:
    """Mends the model and runs it."""
    run = talk.facts["run"]
    (folder / "model.py").write_text(of("goal.set('done')"), encoding="utf-8")
    talk.say("restart", run=True)
    talk.wait(lambda: talk.facts["run"] > run and talk.session.state is not None and talk.state["status"] == "ended")
    assert talk.state["time"] == 10.0


def gone(pid: int) -> bool:
    """Tells whether there is no such process any more."""
    status = Path(f"/proc/{pid}/status")
    try:
        os.kill(pid, 0)
        return status.is_file() and "zombie" in status.read_text(encoding="utf-8")
    except ProcessLookupError:
        return True


@pytest.mark.daily(1)
@pytest.mark.parametrize(
    "does",
    [
        "while True: pass",
        "time.sleep(10000)",
        "exec('while True:\\n try:\\n  time.sleep(1)\\n except BaseException:\\n  pass')",
        "signal.signal(signal.SIGTERM, signal.SIG_IGN); exec('while True: pass')",
    ],
)
def test_an_endless_loop_is_found_and_stopped(desk: Desk, tmp_path: Path, does: str) -> None:
    talk = desk.begin(tmp_path, of(does), run=True, wait="running")
    worker: Any = talk.session._worker

    def found() -> bool:
        line = (talk.facts["stuck"] or {"line": None})["line"]
        return line == 10 or (line is not None and "exec" in does)

    talk.wait(found)
    begin = time.monotonic()
    talk.say("stop")
    assert gone(worker.pid)
    assert time.monotonic() - begin < 10  # two seconds are promised; this machine may be busy
    state = talk.until("ended")
    assert state["reason"] == "stopped"
    with pytest.raises(RefusedError, match="there is no run"):
        talk.say("step")
    runs_again(talk, tmp_path)


@pytest.mark.slow
def test_code_that_blocks_all_threads_is_shown_as_busy(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, of("sum(range(10**12))"), run=True, wait="running")
    talk.wait(lambda: talk.facts["stuck"] == {"file": None, "line": None, "function": ""})
    talk.say("stop")
    assert talk.until("ended")["reason"] == "stopped"


@pytest.mark.parametrize(
    ("does", "status", "reason"),
    [
        ("sys.exit()", "ended", "the program is over"),
        ("sys.exit(0)", "ended", "the program is over"),
        ("sys.exit('bye')", "failed", "the model ended its process (SystemExit: bye)"),
        ("raise KeyboardInterrupt", "failed", "KeyboardInterrupt"),
    ],
)
def test_a_program_that_exits_leaves_its_run(desk: Desk, tmp_path: Path, does: str, status: str, reason: str) -> None:
    talk = desk.begin(tmp_path, of(f"print('so far'); {does}"), run=True, wait=status)
    assert talk.state["reason"] == reason
    assert [data["text"] for _, _, kind, data in talk.events if kind == "output"] == ["so far"]
    talk.say("seek", time=0.04)
    assert talk.until("paused")["time"] == 0.04
    runs_again(talk, tmp_path)


@pytest.mark.slow
def test_a_loop_that_prints_until_memory_is_full_is_said_to_have_used_too_much(tmp_path: Path) -> None:
    desk = Desk(memory=300)
    try:
        talk = desk.begin(tmp_path, of("while True: print('x' * 200)"), run=True, record=True, wait=None)
        talk.wait_for_notice("used more memory than it may")
        talk.wait(lambda: talk.facts["run"] == 1 and talk.state["status"] == "failed")
        runs_again(talk, tmp_path)
    finally:
        desk.close_sessions()
        desk.close()


@pytest.mark.slow
def test_what_is_asked_of_a_loop_is_answered_when_it_is_stopped(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, of("while True: pass"), run=True, wait="running")
    talk.wait(lambda: talk.facts["stuck"])

    async def both() -> tuple[Any, Any]:
        import asyncio

        from workbench.page_commands.agents import Explain
        from workbench.page_commands.session import Stop

        asking = asyncio.create_task(Explain().submit(talk.session))
        await asyncio.sleep(0.1)
        return await Stop().submit(talk.session), await asking

    _, explained = desk.do(both())
    assert explained.error == "the run has ended"


@pytest.mark.daily(3)
@pytest.mark.parametrize(
    ("does", "told"),
    [
        ("os._exit(3)", "the model's process ended with exit code 3"),
        ("sys.exit(4)", "the model ended its process (SystemExit: 4)"),
        ("os.kill(os.getpid(), signal.SIGKILL)", "ended by SIGKILL, sent by itself, by another program, or by the system"),
        ("os.kill(os.getpid(), signal.SIGSEGV)", "SIGSEGV: a crash in compiled code"),
        ("import ctypes; ctypes.string_at(0)", "SIGSEGV: a crash in compiled code"),
        ("x = [0] * 10**10", "the model used more memory"),
        ("exec('x = []\\nwhile True: x.append(bytearray(10**7))')", "the model used more memory"),
        (f"{WIRES} [link._wire.sendall(b'junk' * 1000) for link in links]; time.sleep(9)", "malformed message"),
        ("[os.close(n) for n in range(3, 64) if os.path.exists(f'/proc/self/fd/{n}')]", CLOSED),
        ("os.closerange(0, 64)", CLOSED),
        ("os.closerange(3, 64); files = [open('/dev/null') for _ in range(64)]; time.sleep(9)", CLOSED),
        ("os.kill(os.getpid(), signal.SIGTERM)", "ended by SIGTERM"),
        ("os.kill(os.getpid(), signal.SIGALRM)", "ended by SIGALRM"),
        ("os.abort()", "ended by SIGABRT"),
        ("raise KeyboardInterrupt", "KeyboardInterrupt"),
        ("os.kill(os.getpid(), signal.SIGINT)", "KeyboardInterrupt"),
        ("raise BaseException('odd')", "odd"),
        ("input()", "EOFError"),
    ],
)
def test_the_end_of_a_worker_is_reported(desk: Desk, tmp_path: Path, does: str, told: str) -> None:
    talk = desk.begin(tmp_path, of(does), run=True, wait=None)
    talk.wait(lambda: talk.facts["run"] == 1 and talk.state["status"] in ("failed", "ended"))
    if told:
        talk.wait_for_notice(told)
    assert not [notice for notice in talk.notices if "Exception ignored" in notice["text"] or "exit code 0" in notice["text"]]
    runs_again(talk, tmp_path)


@pytest.mark.daily(4)
@pytest.mark.parametrize(
    "does",
    [
        "os._exit(3)",
        "os.kill(os.getpid(), signal.SIGKILL)",
        "os.killpg(os.getpgrp(), signal.SIGTERM)",
        "signal.raise_signal(signal.SIGALRM)",
        "os.execlp('sleep', 'sleep', '0')",
        "__import__('threading').Thread(target=os._exit, args=[3]).start(); time.sleep(9)",
        "os.kill(os.getpid(), signal.SIGSTOP)",
    ],
)
@pytest.mark.parametrize("record", [False, True])
def test_what_a_model_prints_before_it_ends_or_stops_itself_arrives(desk: Desk, tmp_path: Path, does: str, record: bool) -> None:
    ends = "exec" in does or "_exit" in does
    last = "print('last', end='')" if ends else "print('last')"  # a line without a line break, too
    talk = desk.begin(tmp_path, of(f"print('first'); {last}; {does}"), run=True, wait=None, record=record)
    talk.wait(lambda: talk.facts["stuck"] or talk.state["status"] == "failed")
    assert [data["text"] for _, _, kind, data in talk.events if kind == "output"] == ["first", "last"]
    if record:
        with Recorded(talk.sessions.recordings.path(talk.facts["recording"])) as recorded:
            assert [event.data["text"] for event in recorded.events() if event.kind == "output"] == ["first", "last"]


def test_a_crash_names_where_it_was(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, of("import ctypes; ctypes.string_at(0)"), run=True, wait=None)
    assert talk.wait_for_notice("model.py")
    assert any("line 10" in notice["text"] for notice in talk.notices)


def test_a_wrong_command_to_a_body_names_its_line_and_its_production(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, WALKER, run=True, wait="failed")
    notice = talk.wait_for_notice("no actuator 'walk_to'")
    assert (notice["file"], notice["line"]) == ("model.py", 12)
    assert "in production 'go'" in notice["text"]
    assert "in production 'go'" in talk.state["reason"]
    assert str(tmp_path) not in notice["text"] + talk.state["reason"]


@pytest.mark.parametrize("head", ['goal="task:wait ink?ink:"', 'gaol="go"'])
def test_an_error_in_the_head_of_a_production_names_its_line(desk: Desk, tmp_path: Path, head: str) -> None:
    talk = desk.begin(tmp_path, of("pass").replace('goal="go"', head), run=True, wait="failed")
    notice = talk.wait_for_notice("production 'go'")
    assert (notice["file"], notice["line"]) == ("model.py", 9)


def test_processes_that_a_model_has_left_end_with_it(desk: Desk, tmp_path: Path) -> None:
    mark = tmp_path / "child"
    does = f"import subprocess; open({str(mark)!r}, 'w').write(str(subprocess.Popen(['sleep', '1000']).pid)); time.sleep(1000)"
    talk = desk.begin(tmp_path, of(does), run=True, wait="running")
    talk.wait(lambda: mark.is_file() and mark.read_text(encoding="utf-8"))
    child = int(mark.read_text(encoding="utf-8"))
    assert not gone(child)
    talk.say("stop")
    talk.wait(lambda: gone(child))


def test_output_past_print_is_forwarded_and_bounded(desk: Desk, tmp_path: Path) -> None:
    does = "os.write(1, b'past print\\n'); "
    does += " os.write(2, b'\\xff\\n' + b'x' * 100000 + b'\\n'); [os.write(2, b'more\\n') for _ in range(1000)]; goal.set('done')"
    talk = desk.begin(tmp_path, of(does), run=True, wait=None)
    talk.wait_for_notice("past print")
    talk.wait_for_notice("prints much more")
    assert len(talk.notices) < 300


def test_much_that_is_printed_does_not_hold_up_the_run(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, of("[print('line', n) for n in range(30000)]; goal.set('done')"), run=True, wait=None)
    talk.wait(lambda: talk.facts["run"] == 1 and talk.state["status"] == "ended")
    talk.wait(lambda: talk.session.log.next == talk.state["events"])
    lines = [event[3]["text"] for event in talk.events if event[2] == "output"]
    assert lines == [f"line {n}" for n in range(30000)]


def test_a_worker_that_cannot_be_told_its_job_is_ended(desk: Desk, tmp_path: Path) -> None:
    source = of("goal.set('done')")
    talk = desk.begin(tmp_path, source, settings={"n": 2**64}, wait=None)
    notice = talk.wait_for_notice("the model's process was ended by an error of the workbench itself: OverflowError")
    assert notice["level"] == "error"
    assert not talk.facts["loading"]
    runs_again(talk, tmp_path)


def test_loading_can_be_stopped(desk: Desk, tmp_path: Path) -> None:
    source = "while True: pass\ndef build() -> Simulation: ...\n"
    talk = desk.begin(tmp_path, source, wait=None)
    while not talk.facts["loading"]:
        time.sleep(0.01)
    talk.say("stop")
    while talk.facts["loading"]:
        time.sleep(0.01)
    assert talk.facts["ending"] == "stopped"
    (tmp_path / "model.py").write_text(of("goal.set('done')"), encoding="utf-8")
    talk.say("restart", run=True)
    talk.until("ended")


def test_the_order_of_sets_is_that_of_the_command(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, "print(hash('a text'))", run=True, wait=None)
    talk.wait(lambda: talk.facts["run"] == 1 and talk.state["status"] == "ended" and talk.session.log.next == talk.state["events"])
    import subprocess
    import sys

    environment = {**os.environ, "PYTHONHASHSEED": "0"}
    said = subprocess.run([sys.executable, "-c", "print(hash('a text'))"], env=environment, capture_output=True, text=True, check=True)
    assert talk.events[-1][3]["text"] == said.stdout.strip()


def test_texts_with_half_characters_are_forwarded(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, of("raise ValueError('half \\ud800 a character')"), run=True, wait=None)
    talk.wait_for_notice("half \\ud800 a character")


@pytest.mark.slow
def test_a_server_that_leaves_before_workers_can_be_started_leaves_nothing_behind() -> None:
    ours, theirs = socket.socketpair()
    ours.close()
    command = [sys.executable, "-m", "workbench.worker.fork_server", str(theirs.fileno())]
    done = subprocess.run(command, pass_fds=[theirs.fileno()], capture_output=True, text=True, timeout=60)
    theirs.close()
    assert (done.returncode, done.stderr) == (0, "")


def test_the_halves_of_the_camera_are_compiled_beforehand_in_the_form_that_a_look_needs() -> None:
    seen('<geom type="box" size=".1 .1 .1" pos="2 0 1"/>')
    halves: list[Any] = [scene_setter(), row_tracer()]
    for function in halves:
        function.overloads.clear()
    compile_camera("scene")
    compile_camera("rows")
    eye, place, turn, optics, geoms, topology, scene, row, labels, extents = cast("Any", scan()).signatures[0]
    assert halves[0].signatures == [(eye, place, turn, optics, geoms, topology, scene)]
    assert halves[1].signatures == [(eye, optics, topology, scene, row, labels, extents)]


def test_detectors_are_compiled_beforehand_in_the_form_that_the_views_of_a_camera_need() -> None:
    detect.gaps.cache_clear()
    detect.surfaces.cache_clear()
    compile_detectors()
    compiled: list[Any] = [detect.gaps(), detect.surfaces()]
    assert [len(function.signatures) for function in compiled] == [1, 1]
    _, view = seen('<geom type="box" size=".1 .1 .1" pos="2 0 1"/>')
    assert len(view.extents) >= 2
    opening(view)
    obstacle(view)
    assert [len(function.signatures) for function in compiled] == [1, 1]


def test_a_run_that_has_ended_or_answered_is_not_busy(desk: Desk, tmp_path: Path) -> None:
    """It may say where it is after it has ended, or while it works on a question."""
    talk = desk.begin(tmp_path, of("goal.set('done')"), run=True, wait="ended")
    worker: Any = talk.session._worker

    async def ask_position() -> None:
        worker.send(AskPosition())
        await asyncio.sleep(0.2)

    desk.do(ask_position())
    assert talk.facts["stuck"] is None

    async def ask_more() -> None:
        worker.send(AskPosition())
        await Explain().submit(talk.session)

    desk.do(ask_more())
    assert talk.facts["stuck"] is None


@pytest.mark.slow
def test_a_run_that_is_busy_while_it_is_built_does_not_make_the_shown_run_busy(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, WALKER)
    go_on = tmp_path / "go on"
    busy = f"    import os\n    while not os.path.exists({str(go_on)!r}):\n        pass\n    os._exit(3)\n"
    (tmp_path / "model.py").write_text(f"{WALKER.partition('    return')[0]}{busy}", encoding="utf-8")
    talk.say("restart")
    talk.wait(lambda: talk.facts["stuck"])
    go_on.touch()
    talk.wait(lambda: not talk.facts["loading"])
    assert talk.facts["alive"]
    assert talk.facts["stuck"] is None
    talk.say("step")
    talk.until("paused", tick=1)


def test_a_process_that_a_signal_has_stopped_is_said_to_stand_still(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, of("os.kill(os.getpid(), signal.SIGSTOP); goal.set('done')"), run=True, wait=None)
    talk.wait_for_notice("was stopped by SIGSTOP: SIGCONT")
    talk.wait(lambda: talk.facts["stuck"])
    assert talk.facts["stuck"] == {"file": None, "line": None, "function": "", "signal": "SIGSTOP"}
    worker: Any = talk.session._worker
    os.kill(worker.pid, signal.SIGCONT)
    talk.until("ended", time=10)
    assert talk.facts["stuck"] is None
    runs_again(talk, tmp_path)


def test_a_model_that_a_signal_stops_while_it_is_checked_is_ended(desk: Desk, tmp_path: Path) -> None:
    source = "import os, signal\nos.kill(os.getpid(), signal.SIGSTOP)\ndef build() -> Simulation: ...\n"

    async def check() -> Job:
        path = str(tmp_path / "model.py")
        async with doing(desk.workers, Start(job="check", path=path, source=source, folder=str(tmp_path))) as job:
            await job.over.wait()
            return job

    assert "was stopped by SIGSTOP" in desk.do(check()).problem


def test_the_process_all_come_from_goes_on_where_a_model_has_stopped_it(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, of("os.kill(os.getppid(), signal.SIGSTOP); goal.set('done')"), run=True, wait=None)
    talk.wait(lambda: talk.facts["run"] == 1 and talk.state["status"] == "ended")
    runs_again(talk, tmp_path)


FORKS = """
import os, sys
for name in ("first", "second"):
    if os.fork() == 0:
        print(name, "child")
        if os.fork() == 0:
            print(name, "grandchild", end="")
            sys.exit(0)
        os.wait()
        {end}
    os.wait()
print("over")
"""


@pytest.mark.parametrize(("end", "told"), [("os._exit(0)", []), ("sys.exit(4)", []), ("1 / 0", ["ZeroDivisionError"] * 2)])
def test_what_copies_of_the_process_print_arrives(desk: Desk, tmp_path: Path, end: str, told: list[str]) -> None:
    talk = desk.begin(tmp_path, FORKS.replace("{end}", end), run=True, wait="ended")
    for line in ("first child", "second child", "first grandchild", "second grandchild"):
        talk.wait_for_notice(line)
    assert [data["text"] for _, _, kind, data in talk.events if kind == "output"] == ["over"]
    texts = [notice["text"] for notice in talk.notices]
    assert not [text for text in texts if "Exception ignored" in text]
    assert [text.partition(":")[0] for text in texts if "Error:" in text] == told


WRITES = """
import sys
from actr3d.actr import *

class Mind(ACTR):
    goal = Buffer()
    def init():
        goal.set('count 1')
    def count(goal='count ?n!6'):
        print('out', n)
        print('err', n, file=sys.stderr)
        goal.set(f'count {int(n) + 1}')
    def end(goal='count 6'):
        sys.stderr.write('unfinished')
        self.stop()

Mind().run()
"""


def test_lines_on_standard_error_are_forwarded_once_when_they_are_written(desk: Desk, tmp_path: Path) -> None:
    talk = desk.begin(tmp_path, WRITES)
    talk.say("run")
    talk.until("ended")
    talk.wait_for_notice("unfinished")

    def told() -> list[tuple[str, int]]:
        return [(notice["text"], notice["events"]) for notice in talk.notices if notice["level"] == "info"]

    printed = {event[3]["text"]: number for number, event in enumerate(talk.events) if event[2] == "output"}
    assert [text for text, _ in told()] == ["err 1", "err 2", "err 3", "err 4", "err 5", "unfinished"]
    for n, (_, events) in enumerate(told()[:5], 1):
        assert printed[f"out {n}"] < events
        assert n == 5 or events <= printed[f"out {n + 1}"]
    first = told()
    talk.say("seek", time=0.12)
    talk.until("paused", time=0.12)
    talk.say("run")
    talk.until("ended")
    assert told() == first


def test_models_in_a_pool_of_forked_processes_run_to_their_end(desk: Desk, tmp_path: Path) -> None:
    source = """from multiprocessing import get_context
from actr3d.actr import *
class M(Model):
    def start(self):
        for _ in range(40):
            yield 0.25
def trial(number):
    m = M()
    m.run()
    return m.now()
with get_context("fork").Pool(2) as pool:
    print(pool.map(trial, range(4)))
M().run()
"""
    talk = desk.begin(tmp_path, source, run=True, wait=None)
    talk.wait(lambda: talk.facts["run"] == 1 and talk.state["status"] in ("ended", "failed"))
    assert (talk.state["status"], talk.state["time"]) == ("ended", 10)
    talk.wait(lambda: talk.session.log.next == talk.state["events"])
    assert [event[3]["text"] for event in talk.events if event[2] == "output"] == ["[10.0, 10.0, 10.0, 10.0]"]
