"""How the workbench ends: in good order, killed, while it starts, while it is busy; no process stays behind."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
import time
from contextlib import suppress
from pathlib import Path

import httpx
import pytest

from tests.helpers.sessions import PATIENCE
from tests.helpers.workbench_server import Served, served
from tests.workbench.worker.test_worker import gone

LOOP = "import os, time\nopen('{mark}', 'w').write(str(os.getpid()))\nwhile True:\n    pass\n"


def descendants(pid: int) -> set[int]:
    """Returns the processes that come from one."""
    found: set[int] = set()
    parents: dict[int, int] = {}
    for line in subprocess.run(["ps", "-eo", "pid=,ppid="], capture_output=True, text=True, check=True).stdout.splitlines():
        child, parent = map(int, line.split())
        parents[child] = parent
    for child in parents:
        above = child
        while above in parents and above != pid:
            above = parents[above]
        if above == pid and child != pid:
            found.add(child)
    return found


def busy(running: Served) -> set[int]:
    """Lets a model loop for ever, and returns all processes of the workbench."""
    mark = running.folder / "mark"
    (running.folder / "loop.py").write_text(LOOP.format(mark=mark), encoding="utf-8")
    running.post("/api/sessions", {"model": "loop.py", "run": True})
    running.post("/api/sessions", {"model": "doorway.py"})
    end = time.monotonic() + PATIENCE
    while not (mark.is_file() and mark.read_text(encoding="utf-8")):
        assert time.monotonic() < end
        time.sleep(0.02)
    return descendants(running.process.pid)


def all_end(processes: set[int]) -> None:
    end = time.monotonic() + PATIENCE
    while not all(map(gone, processes)):
        assert time.monotonic() < end, [pid for pid in processes if not gone(pid)]
        time.sleep(0.02)


@pytest.mark.slow
@pytest.mark.parametrize("sign", [signal.SIGINT, signal.SIGTERM, signal.SIGKILL])
def test_nothing_stays_behind(tmp_path: Path, sign: signal.Signals) -> None:
    with served(tmp_path / "models") as running:
        processes = busy(running)
        assert len(processes) >= 2
        running.process.send_signal(sign)
        assert running.process.wait(PATIENCE) == (0 if sign == signal.SIGINT else -sign)
        all_end(processes)


ONCE = """
import os, time
from pathlib import Path
mark = Path({mark!r})
while mark.exists():
    if not mark.read_text():
        mark.write_text(str(os.getpid()))
    time.sleep(0.01)
"""


@pytest.mark.slow
@pytest.mark.parametrize("sign", [signal.SIGINT, signal.SIGKILL])
def test_a_recording_that_is_run_again_ends_with_the_server(tmp_path: Path, sign: signal.Signals) -> None:
    with served(tmp_path / "models") as running:
        mark = running.folder / "mark"
        (running.folder / "once.py").write_text(ONCE.format(mark=str(mark)), encoding="utf-8")
        name = running.post("/api/sessions", {"model": "once.py", "run": True}).json()["id"]
        end = time.monotonic() + PATIENCE
        while (told := running.get(f"/api/sessions/{name}").json())["state"] is None or told["state"]["status"] != "ended":
            assert time.monotonic() < end
            time.sleep(0.02)
        running.post(f"/api/sessions/{name}/close")
        mark.touch()
        replay = f"/api/recordings/{told['session']['recording']}/replay"

        def ask() -> None:
            with suppress(httpx.HTTPError):
                running.post(replay)

        asking = threading.Thread(target=ask, daemon=True)
        asking.start()
        while not mark.read_text(encoding="utf-8"):
            assert time.monotonic() < end
            time.sleep(0.02)
        assert running.get(replay).json() == {"share": 0.0}
        processes = descendants(running.process.pid)
        assert int(mark.read_text(encoding="utf-8")) in processes
        running.process.send_signal(sign)
        running.process.wait(PATIENCE)
        all_end(processes)
        asking.join(PATIENCE)


@pytest.mark.slow
def test_it_ends_while_a_model_waits_to_begin(tmp_path: Path) -> None:
    with served(tmp_path / "models") as running:

        def ask() -> None:
            with suppress(httpx.HTTPError):
                running.post("/api/sessions", {"model": "counting.py"})

        asking = threading.Thread(target=ask, daemon=True)
        asking.start()
        time.sleep(0.1)
        processes = descendants(running.process.pid)
        running.process.send_signal(signal.SIGINT)
        assert running.process.wait(PATIENCE) == 0
        all_end(processes)
        asking.join(PATIENCE)


def test_it_is_interrupted_while_it_starts(tmp_path: Path) -> None:
    command = [sys.executable, "-m", "workbench", str(tmp_path), "--no-browser"]
    pipe = subprocess.PIPE
    with subprocess.Popen(command, stdout=pipe, stderr=pipe, text=True, start_new_session=True) as process:
        try:
            time.sleep(0.8)
            os.killpg(process.pid, signal.SIGINT)
            _, complaints = process.communicate(timeout=PATIENCE)
        finally:
            process.kill()
    # Python itself may not be there yet, which it says in its own words.
    assert process.returncode in (0, 130, -signal.SIGINT, 1)
    assert "Traceback" not in complaints or "workbench/server.py" not in complaints


INTERRUPTED = """
import builtins, os, signal, sys
import workbench.cli
load = builtins.__import__
def interrupted(name, *rest):
    if name == "workbench.app":
        try:
            os.kill(os.getpid(), signal.SIGINT)
        except {swallowed}:
            pass
    return load(name, *rest)
builtins.__import__ = interrupted
sys.exit(workbench.cli.main([sys.argv[1], "--no-browser"]))
"""


@pytest.mark.slow
@pytest.mark.parametrize("swallowed", ["()", "BaseException"])
def test_an_interruption_while_a_library_is_loaded_ends_it_quietly_even_if_the_library_swallows_it(tmp_path: Path, swallowed: str) -> None:
    command = [sys.executable, "-c", INTERRUPTED.format(swallowed=swallowed), str(tmp_path)]
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True) as process:
        try:
            printed, complaints = process.communicate(timeout=PATIENCE)
        finally:
            process.kill()
    assert (process.returncode, printed, complaints) == (130, "", "")


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="there is no /dev/full")
def test_a_workbench_whose_address_cannot_be_written_ends_with_the_reason(tmp_path: Path) -> None:
    with Path("/dev/full").open("w") as full:
        command = [sys.executable, "-m", "workbench", str(tmp_path), "--no-browser"]
        done = subprocess.run(command, stdout=full, stderr=subprocess.PIPE, text=True, timeout=PATIENCE, check=False)
    assert (done.returncode, done.stderr) == (1, "error: cannot write the output: No space left on device\n")
