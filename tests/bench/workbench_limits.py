"""Measures whether the workbench meets its limits: `uv run python -m tests.bench.workbench_limits`.

Each figure is measured in one run on one machine, with a page in headless Chromium attached where there is one; the exit code
is 1 if a limit is missed. It takes as long as the eight clients are attached, and two minutes more.
"""

from __future__ import annotations

import argparse
import asyncio
import os
import shutil
import subprocess
import sys
import tempfile
import time
from collections.abc import Coroutine, Generator
from concurrent.futures import ThreadPoolExecutor
from contextlib import AsyncExitStack, contextmanager, nullcontext
from pathlib import Path
from statistics import median
from typing import Any, TypeVar
from unittest.mock import patch

from actr3d.benchmark import Measurement, report
from tests.bench.pages import CLICKS, PANS, Client, attached, await_scene, looking, opened
from tests.helpers.page import PART, browser_path, launched
from tests.helpers.workbench_server import MODELS, Served, served

T = TypeVar("T")
MODEL = "aperture_passage.py"
STARTS = 3
RUNS = 7
CLICKED = 60
EVENTS = 1_000_000
CLIENTS = 8
LOOKING = 2
"""So many of the clients take the 3D view, too."""
LOOP = """
from actr3d.actr import *
class Agent(ACTR):
    goal = Buffer()
    def init():
        goal.set("go")
    def go(goal="go"):
        while True: pass
Agent().run(1)
"""
HEADLESS = """
import sys, time
from pathlib import Path
from actr3d.actr.kernel.run_limits import RunLimits
from actr3d.runner.model_factory import Blueprint
path = Path(sys.argv[1])
print = lambda *_: None
rates = []
for number in range(int(sys.argv[2]) + 1):
    with RunLimits(seed=1):
        simulation, _ = Blueprint(path.read_text(encoding="utf-8"), str(path), path.parent).build({})
        begin = time.perf_counter()
        report = simulation.run()
        rates.append((report.simulated, time.perf_counter() - begin))
sys.stderr.write(str(sum(one for one, _ in rates[1:]) / sum(other for _, other in rates[1:])))
"""
"""Runs a model as `actr3d run` does, one time more than is asked for, as the first has things to load; tells how fast that was."""


def main() -> int:
    """Measures everything; returns 0 if all limits are met, else 1."""
    parser = argparse.ArgumentParser(description="Measures whether the workbench meets its limits.")
    parser.add_argument("--minutes", type=float, default=10.0, help="for how long eight clients are attached (default 10)")
    parser.add_argument("--json", action="store_true", help="print one JSON object")
    options = parser.parse_args()
    path = browser_path()
    os.environ.pop("PYTHONDONTWRITEBYTECODE", None)  # with it, each start would compile all libraries again
    figures: list[Measurement] = []
    with tempfile.TemporaryDirectory() as made, launched(path) if path is not None else nullcontext() as browser:
        folder = Path(made) / "models"
        figures += [_first_start(folder, browser), _starts(folder, browser)]
        with _workbench(folder) as server, _page(server, browser) as page:
            session = opened(server, MODEL)
            await_scene(server, session)
            if page is not None:
                page.locator(".scene-cover").wait_for(state="detached", timeout=60_000)
                figures += [_loads(page), _pans(page)]
            figures.append(_now(_speed(server, session, with_page=page is not None)))
            figures.append(_clicks(page) if page is not None else _now(_steps(server, session)))
            figures.append(_now(_edits(server, session)))
            figures.append(_now(_stops(server)))
        with _workbench(folder) as server:
            figures.append(_now(_soak(server, 60 * options.minutes)))
    return report(figures, json_output=options.json)


def _now(work: Coroutine[Any, Any, T]) -> T:
    """Does something in an event loop of its own; that of this thread is the browser's."""
    with ThreadPoolExecutor(1) as other:
        return other.submit(asyncio.run, work).result()


@contextmanager
def _workbench(folder: Path) -> Generator[Served]:
    folder.mkdir(exist_ok=True)
    shutil.copy(MODELS / MODEL, folder / MODEL)
    with served(folder) as server:
        yield server


@contextmanager
def _page(server: Served, browser: Any) -> Generator[Any]:
    """Gives a page that shows the model ready to run; None where there is no browser."""
    if browser is None:
        yield None
        return
    context = browser.new_context(viewport={"width": 1280, "height": 800})
    context.add_init_script(PART)
    page = context.new_page()
    page.goto(f"{server.address}&model={MODEL}")
    _shows_the_start(page)
    yield page
    context.close()


def _shows_the_start(page: Any) -> None:
    page.locator("#time", has_text="0.00").wait_for(timeout=180_000)


def _first_start(folder: Path, browser: Any) -> Measurement:
    """Measures a start after which nothing that is compiled was kept: with folders of its own for bytecode and for compiled functions."""
    with tempfile.TemporaryDirectory() as made:
        folders = {name: str(Path(made) / name) for name in ("PYTHONPYCACHEPREFIX", "NUMBA_CACHE_DIR")}
        with patch.dict(os.environ, folders):
            taken = _start(folder, browser)
    what = "[s] from the command to the model ready to run on the page, when nothing is compiled yet"
    return Measurement(name="first start", value=taken, sense="at most", limit=20, what=what)


def _starts(folder: Path, browser: Any) -> Measurement:
    """Measures how long it takes from the command to a page with the model ready to run."""
    taken = [_start(folder, browser) for _ in range(STARTS + 1)][1:]  # the first may not be warm
    what = "[s] from the command to the model ready to run on the page, median of warm starts"
    return Measurement(name="start", value=median(taken), sense="at most", limit=3, what=what)


def _start(folder: Path, browser: Any) -> float:
    begin = time.perf_counter()
    with _workbench(folder) as server:
        printed = time.perf_counter() - begin
        if browser is not None:
            with _page(server, browser):
                ready = time.perf_counter() - begin
        else:
            _now(_ready(server))
            ready = time.perf_counter() - begin
    _say(f"start: address after {printed:.2f} s, ready to run after {ready:.2f} s")
    return ready


async def _ready(server: Served) -> None:
    async with attached(server, opened(server, MODEL)) as client:
        await client.until(lambda state: state["status"] == "paused")


async def _speed(server: Served, session: str, *, with_page: bool) -> Measurement:
    """Measures how fast the model runs with the page attached, or a client that takes as much, beside how fast it runs headless."""
    headless = _headless()
    rates: list[float] = []
    async with attached(server, session) as client, nullcontext() if with_page else looking(server, session):
        await client.say("speed", factor=None)
        for _ in range(RUNS):
            await client.restart(seed=1)
            await client.until(lambda state: state["status"] == "paused")
            await asyncio.sleep(0.3)  # a user does not press run at once, either
            begin = time.perf_counter()
            await client.say("run")
            state = await client.until(lambda state: state["status"] == "ended")
            rates.append(state["time"] / (time.perf_counter() - begin))
    headless = max(headless, _headless())
    _say(f"speed: headless {headless:.1f} times real time, attached {', '.join(f'{rate:.1f}' for rate in rates)}")
    limit = 0.8 * min(headless, 20.0)
    what = f"times real time with everything shown, median; headless {headless:.1f}"
    return Measurement(name="speed", value=median(rates), sense="at least", limit=limit, what=what)


def _headless() -> float:
    command = [sys.executable, "-c", HEADLESS, str(MODELS / MODEL), str(RUNS)]
    return float(subprocess.run(command, capture_output=True, text=True, check=True).stderr.splitlines()[-1])


def _loads(page: Any) -> Measurement:
    """Measures how long the page takes to load again and show the model."""
    taken: list[float] = []
    for _ in range(RUNS):
        begin = time.perf_counter()
        page.reload(wait_until="commit")
        _shows_the_start(page)
        taken.append(time.perf_counter() - begin)
    page.locator(".scene-cover").wait_for(state="detached", timeout=60_000)
    return Measurement(name="page", value=median(taken), sense="at most", limit=1.5, what="[s] to load the page with the model, median")


def _pans(page: Any) -> Measurement:
    """Measures the script time of a picture of the timeline that is moved along."""
    taken = sorted(page.evaluate(PANS, [EVENTS, RUNS * 4]))
    what = f"[ms] of script for a picture of the timeline of an hour with {EVENTS:,} events, of ten nine"
    return Measurement(name="pan", value=taken[9 * len(taken) // 10], sense="at most", limit=16, what=what)


def _clicks(page: Any) -> Measurement:
    """Measures how long it takes from a click on step until the page shows another time."""
    page.locator("#restart").click()
    _shows_the_start(page)
    page.wait_for_timeout(1000)
    taken = sorted(page.evaluate(CLICKS, CLICKED))
    _say(f"click: median {median(taken):.1f} ms, of ten nine within {taken[9 * len(taken) // 10]:.1f} ms, longest {taken[-1]:.1f} ms")
    return Measurement(
        name="click", value=median(taken), sense="at most", limit=50, what="[ms] from a click on step to the updated page, median"
    )


async def _steps(server: Served, session: str) -> Measurement:
    """Measures the same where there is no browser: from a step to the state that it leads to."""
    taken: list[float] = []
    async with attached(server, session) as client, looking(server, session):
        await client.say("seek", time=0)
        await client.until(lambda state: state["status"] == "paused" and state["tick"] == 0)
        for number in range(1, CLICKED + 1):
            begin = time.perf_counter()
            await client.say("step")
            await client.until(lambda state, number=number: state["tick"] == number and state["status"] == "paused")
            taken.append(1000 * (time.perf_counter() - begin))
            await asyncio.sleep(0.06)
    return Measurement(
        name="step", value=median(taken), sense="at most", limit=50, what="[ms] from a step to its state, without a browser, median"
    )


async def _edits(server: Served, session: str) -> Measurement:
    """Measures how long it takes from the command to run a changed file to the first tick of that."""
    taken: list[float] = []
    async with attached(server, session) as client:
        await client.until(lambda _: True)
        for number in range(RUNS):
            known = server.get("/api/model", params={"path": MODEL}).json()
            text = known["text"] + f"# {number}\n"
            begin = time.perf_counter()
            await asyncio.to_thread(_save, server, text, known["version"])
            await client.restart(run=True)
            await client.until(lambda state: state["tick"] > 0)
            taken.append(time.perf_counter() - begin)
    _say(f"edit: {', '.join(f'{one:.2f}' for one in taken)} s")
    return Measurement(
        name="edit", value=median(taken), sense="at most", limit=1, what="[s] from saving a changed file to its first tick, median"
    )


def _save(server: Served, text: str, version: str) -> None:
    server.put("/api/model", {"path": MODEL, "text": text, "version": version}).raise_for_status()


async def _stops(server: Served) -> Measurement:
    """Measures how long it takes to end a model in an endless loop."""
    (server.folder / "loop.py").write_text(LOOP, encoding="utf-8")
    session = opened(server, "loop.py", run=True)
    taken: list[float] = []
    async with attached(server, session) as client:
        for _ in range(3):
            await client.until(lambda state: state["status"] == "running")
            await asyncio.sleep(0.3)
            begin = time.perf_counter()
            await client.say("stop")
            await client.until(lambda state: state["status"] == "ended")
            taken.append(time.perf_counter() - begin)
            await client.restart(run=True)
    _say(f"stop: {', '.join(f'{one:.2f}' for one in taken)} s")
    return Measurement(name="stop", value=max(taken), sense="at most", limit=2, what="[s] until a model in an endless loop is gone")


async def _soak(server: Served, seconds: float) -> Measurement:
    """Measures by how much the memory of the server grows while clients are attached, and runs follow one another."""
    session = opened(server, MODEL)
    await_scene(server, session)
    async with AsyncExitStack() as stack:
        for _ in range(CLIENTS - 1):
            client = await stack.enter_async_context(attached(server, session))
            stack.callback(asyncio.create_task(client.read_on()).cancel)
        for _ in range(LOOKING):
            await stack.enter_async_context(looking(server, session))
        user = await stack.enter_async_context(attached(server, session))
        for _ in range(4):  # what is made once, and up to its bound
            await _one_run(user)
        first = memory_of(server.process.pid)
        end = time.monotonic() + seconds
        runs, said = 0, time.monotonic()
        while time.monotonic() < end:
            await _one_run(user)
            runs += 1
            if time.monotonic() - said > 60:
                said = time.monotonic()
                _say(f"memory: {memory_of(server.process.pid) / 1e6:.1f} MB after {runs} runs")
        last = memory_of(server.process.pid)
    _say(f"memory: {first / 1e6:.1f} MB at first, {last / 1e6:.1f} MB after {runs} runs in {seconds / 60:g} minutes")
    what = f"[%] growth of the server's memory with {CLIENTS} clients in {seconds / 60:g} minutes"
    return Measurement(name="memory", value=100 * (last / first - 1), sense="at most", limit=5, what=what)


async def _one_run(user: Client) -> None:
    await user.say("speed", factor=5)
    await user.restart(run=True, record=False)
    await user.until(lambda state: state["status"] == "ended")


def memory_of(pid: int) -> int:
    """Returns how much memory a process has [bytes]."""
    if sys.platform == "linux":
        for line in Path(f"/proc/{pid}/status").read_text(encoding="ascii").splitlines():
            if line.startswith("VmRSS:"):
                return 1024 * int(line.split()[1])
    told = subprocess.run(["ps", "-o", "rss=", "-p", str(pid)], capture_output=True, text=True, check=True)
    return 1024 * int(told.stdout)


def _say(text: str) -> None:
    print(text, file=sys.stderr, flush=True)


if __name__ == "__main__":
    sys.exit(main())
