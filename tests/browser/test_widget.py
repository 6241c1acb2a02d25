"""The widget of a notebook in a browser: a page with its module stands for the notebook, and a process that runs cells for the kernel."""

from __future__ import annotations

import http.server
import json
import re
import subprocess
import sys
import threading
from collections.abc import Callable, Generator, Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Browser, FrameLocator, Page, expect

from tests.browser.test_access import AXE, LOOK, RUN_AXE
from tests.helpers.page import PART, PATIENCE, shows
from tests.helpers.paths import MODELS
from workbench.notebook import widget

KERNEL = """
import asyncio, gc, json, sys
from aperture_passage import Parameters, build
from workbench.notebook.widget import replay_of

async def cells():
    global simulation, shown
    simulation = build(Parameters())
    shown = simulation.show()
    print(json.dumps(dict(shown.page)), flush=True)
    loop = asyncio.get_running_loop()
    while cell := await loop.run_in_executor(None, sys.stdin.readline):
        print(json.dumps(eval(cell)), flush=True)

asyncio.run(cells())
"""
NOTEBOOK = """<!doctype html><meta charset="utf-8"><title>Notebook</title><body style="background: BACKGROUND">
<script type="module">
  import widget from "/widget.js";
  const heard = {};
  const model = {
    get: (name) => (TRAITS)[name],
    on: (name, call) => (heard[name] = call),
    off: () => null,
    send: async () => heard["msg:custom"]({ replay: await kernel() }),
  };
  widget.render({ model, el: document.body });
</script>"""


class Kernel:
    """A process that runs cells."""

    def __init__(self) -> None:
        models = str(MODELS)
        command = [sys.executable, "-c", f"import sys; sys.path.insert(0, {models!r})\n{KERNEL}"]
        self._process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True)
        self.page = self._answer()

    def _answer(self) -> Any:
        assert self._process.stdout is not None
        return json.loads(self._process.stdout.readline())

    def cell(self, expression: str) -> Any:
        """Runs a cell; returns what it shows."""
        assert self._process.stdin is not None
        self._process.stdin.write(f"{expression}\n")
        self._process.stdin.flush()
        return self._answer()

    def end(self) -> None:
        """Ends the kernel at once, as its restart does."""
        self._process.kill()
        self._process.communicate()


@pytest.fixture
def kernel() -> Iterator[Kernel]:
    started = Kernel()
    yield started
    started.end()


MODULE = Path(widget.__file__).with_name("widget.js").read_text(encoding="utf-8")


@contextmanager
def serving(answer: Callable[[str, int], str]) -> Generator[str]:
    """Serves what a function returns for a path and the port, modules where a path ends so; yields the address."""

    class Handler(http.server.BaseHTTPRequestHandler):
        def do_GET(self) -> None:
            self.send_response(200)
            self.send_header("content-type", "text/javascript" if self.path.endswith(".js") else "text/html")
            self.end_headers()
            self.wfile.write(answer(self.path, server.server_port).encode())

        def log_message(self, format: str, *args: Any) -> None:
            pass

    with http.server.ThreadingHTTPServer(("127.0.0.1", 0), Handler) as server:
        threading.Thread(target=server.serve_forever, daemon=True).start()
        yield f"http://localhost:{server.server_port}"
        server.shutdown()


def notebook_page(path: str, page: dict[str, Any]) -> str:
    """Returns a notebook with the widget of a page, dark or light as its path says."""
    traits = json.dumps({"page": page, "height": 560, "problem": ""})
    return NOTEBOOK.replace("TRAITS", traits).replace("BACKGROUND", "#111" if "dark" in path else "#fff")


@pytest.fixture
def notebook(kernel: Kernel) -> Iterator[str]:
    """Serves pages with the widget, as a notebook's server does; returns their address."""
    with serving(lambda path, _: MODULE if path == "/widget.js" else notebook_page(path, kernel.page)) as address:
        yield address


def opened(browser: Browser, address: str) -> Page:
    """Opens a notebook in a browser that has no cookie."""
    page = browser.new_context(viewport={"width": 1280, "height": 800}).new_page()
    page.set_default_timeout(PATIENCE)
    page.goto(address)
    return page


def time_of(frame: FrameLocator, text: str) -> None:
    expect(frame.locator("#time")).to_have_text(text)


def test_a_page_that_is_late_is_shown_as_soon_as_it_is_there(browser: Browser) -> None:
    hurried = MODULE.replace("PATIENCE = 8000", "PATIENCE = 300")
    late = """<p id="size"></p><script>
      document.querySelector("p").textContent = `${innerHeight} px`;
      setTimeout(() => parent.postMessage("workbench", "*"), 1000);
    </script>"""

    def answer(path: str, port: int) -> str:
        if path == "/widget.js":
            return hurried
        return late if "session=" in path else notebook_page(path, {"port": port, "session": "s1", "ticket": "one"})

    with serving(answer) as address:
        page = opened(browser, address)
        shows(page, ".actr3d-note", "does not answer this browser")
        button = page.get_by_role("button", name="Try again")
        assert button.evaluate("one => getComputedStyle(one).borderTopStyle") == "solid"  # also where the notebook has no style for buttons
        expect(page.locator(".actr3d-note")).to_have_count(0)
        expect(page.frame_locator("iframe").locator("#size")).to_be_visible()
        expect(page.frame_locator("iframe").locator("#size")).to_have_text("560 px")


@pytest.mark.slow
def test_a_recording_in_a_notebook_says_that_it_was_changed_and_asks_before_more_is_lost(
    browser: Browser, kernel: Kernel, notebook: str, tmp_path: Path
) -> None:
    model, path = MODELS / "counting.py", tmp_path / "run.sqlite"
    subprocess.run([Path(sys.executable).with_name("actr3d"), "run", str(model), "--record", str(path)], check=True, capture_output=True)
    kernel.page = kernel.cell(f"dict(__import__('actr3d.recording').recording.Recorded({str(path)!r}).show(trust=True).page)")
    page = opened(browser, notebook)
    frame = page.frame_locator("iframe").first
    expect(frame.get_by_role("heading", name="Recording of")).to_be_visible()
    inner = next(one for one in page.frames if "session=" in one.url)
    inner.evaluate(f"() => void ({PART})")

    def order(part: str, function: str, **what: Any) -> None:
        inner.evaluate(f"async (what) => void (await part('{part}')).{function}(what)", what)

    def change(time: float) -> None:
        order("server.js", "sendCommand", type="seek", time=time)
        time_of(frame, f"t = {time:.2f} s")
        order("bar/branch.js", "sendChange", type="command", word="clear_buffer", named={"buffer": "goal"})

    change(0.1)
    expect(frame.get_by_role("heading", name="Branch of the recording of")).to_be_visible()
    kept = "A branch, which ends with the kernel; run the cell again to see the recording"
    expect(frame.locator(".branched")).to_contain_text(kept)
    expect(frame.locator(".branched")).to_have_attribute("title", re.compile(f"^{kept}\\."))  # in full where it is cut
    expect(frame.get_by_title("Kept as this recording")).to_have_count(0)
    order("server.js", "sendCommand", type="step")
    time_of(frame, "t = 0.11 s")
    change(0.05)
    asked = frame.get_by_role("dialog", name="Change the past?")
    expect(asked).to_contain_text("What lies ahead, from 0.05 s to 0.11 s, would be lost: the run is not recorded.")
    asked.get_by_role("button", name="Change it anyway").click()
    expect(frame.locator("#status")).to_have_text("paused: changed at 0.05 s; the rest was lost")


@pytest.mark.slow
@pytest.mark.scene
def test_the_widget_follows_the_cells_and_says_what_to_do_where_it_cannot(browser: Browser, kernel: Kernel, notebook: str) -> None:
    page = opened(browser, f"{notebook}/dark")
    said: list[str] = []
    page.on("console", lambda message: said.append(message.text))
    frame = page.frame_locator("iframe").first
    time_of(frame, "t = 0.00 s")
    expect(frame.locator(".scene iframe")).to_be_visible()
    kernel.cell("simulation.run(1.5) and None")
    time_of(frame, "t = 1.50 s")
    kernel.cell("simulation.seek(0.5)")
    time_of(frame, "t = 0.50 s")
    expect(frame.locator("#status")).to_have_text("paused: by a cell")
    frame.locator("#step").click()
    time_of(frame, "t = 0.51 s")
    assert kernel.cell("simulation.time") == 0.51
    expect(frame.get_by_role("tab", name="Buffers")).to_be_visible()
    assert frame.get_by_role("tab", name="Editor").count() == 0
    assert frame.locator("#restart, #stop, select.model").count() == 0
    page.keyboard.press("Control+k")
    expect(frame.get_by_role("combobox", name="Search commands")).to_be_focused()
    page.keyboard.press("Escape")
    page.keyboard.press("g")
    expect(frame.get_by_role("dialog").get_by_role("textbox")).to_be_focused()
    page.keyboard.press("Escape")
    assert [text for text in said if "autofocus" in text] == []
    frame.get_by_role("button", name="Move, push").click()
    frame.get_by_role("dialog").get_by_role("button", name="Move …").click()
    expect(frame.get_by_role("dialog").get_by_role("option", name="walker")).to_have_count(1)
    frame.get_by_role("dialog").get_by_role("button", name="Cancel").click()
    inner = next(one for one in page.frames if "session=" in one.url)
    assert inner.evaluate("() => document.documentElement.dataset.theme") == "dark"
    expect(inner.locator(".changed")).to_have_count(0)
    inner.evaluate(AXE)
    assert [*inner.evaluate(LOOK), *inner.evaluate(RUN_AXE, [])] == []

    page.reload()  # with the cookie, as the ticket is used up
    time_of(page.frame_locator("iframe").first, "t = 0.51 s")

    other = opened(browser, notebook)
    shows(other, ".actr3d-note", f"The live view at port {kernel.page['port']} does not answer this browser")
    other.expose_function("kernel", lambda: kernel.cell("replay_of(simulation)"))  # pyright: ignore[reportUnknownMemberType]
    other.get_by_role("button", name="Play the run up to now").click()
    replay = other.frame_locator("iframe").first
    expect(replay.locator("h1")).to_contain_text("seed")

    kernel.cell("[globals().pop('simulation') and None, gc.collect() and None]")
    lost = page.frame_locator("iframe").first
    expect(lost.locator("#status")).to_contain_text("the notebook no longer has this simulation")
    kernel.end()
    expect(lost.locator("#connection")).to_have_text("the kernel does not answer any more: run the cell again")
    expect(lost.locator("#run")).to_be_disabled()
