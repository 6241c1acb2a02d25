"""Takes the pictures of the workbench for README and manual: `uv run python docs/screenshot.py`.

It starts a workbench with the shipped models, and drives a headless Chromium, which must be installed.
"""

from __future__ import annotations

import io
import json
import shutil
import subprocess
import sys
import tempfile
import time
import urllib.request
from collections.abc import Generator, Mapping
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from PIL import Image
from playwright.sync_api import sync_playwright

ROOT = Path(__file__).parents[1]
IMAGES = ROOT / "docs" / "images"
BROWSERS = ("chromium-headless-shell", "chromium", "chromium-browser", "google-chrome", "chrome")
OPTIONS = ("--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader")
PATIENCE = 180_000
"""The longest wait for the page [ms]."""
SETTLED = 12_000
"""How long the page may take to draw the moment [ms]."""
COLOURS = 200
LARGEST = 300_000
"""The largest file of a picture [bytes]."""


@dataclass(frozen=True, kw_only=True)
class Shot:
    """One picture: of which run, at which moment."""

    name: str
    model: str
    settings: Mapping[str, Any]
    time: float
    tab: str


SHOTS = (
    Shot(name="workbench.png", model="aperture_passage.py", settings={"aperture": 0.45}, time=10.2, tab="productions"),
    Shot(name="doorway.png", model="doorway.py", settings={"width": 0.5}, time=5.6, tab="buffers"),
    Shot(
        name="predictive_walker.png", model="predictive_walker.py", settings={"aperture": 0.45, "start_aside": 0.5}, time=6.5, tab="buffers"
    ),
)


@contextmanager
def workbench() -> Generator[str]:
    """Starts a workbench with copies of the models; gives its address."""
    with tempfile.TemporaryDirectory() as folder:
        models = shutil.copytree(ROOT / "models", Path(folder) / "models", ignore=shutil.ignore_patterns(".*", "__pycache__"))
        command = [sys.executable, "-m", "workbench", str(models), "--no-browser"]
        with subprocess.Popen(command, stdout=subprocess.PIPE, text=True) as process:
            assert process.stdout is not None
            try:
                yield next(line.strip() for line in process.stdout if "token=" in line)
            finally:
                process.terminate()


def prepare(address: str, shot: Shot) -> None:
    """Runs a model to the moment of a picture."""
    url, _, token = address.partition("/?token=")

    def ask(path: str, body: Any = None) -> Any:
        headers = {"authorization": f"Bearer {token}", "x-workbench": "1", "content-type": "application/json"}
        request = urllib.request.Request(f"{url}/api{path}", None if body is None else json.dumps(body).encode(), headers)
        with urllib.request.urlopen(request, timeout=PATIENCE / 1000) as answer:
            return json.loads(answer.read())

    session = ask("/sessions", {"model": shot.model, "seed": 1, "settings": dict(shot.settings)})["id"]
    state = None
    while not state:
        time.sleep(0.2)
        state = ask(f"/sessions/{session}")["state"]
    for command in ({"type": "overlay", "name": "features", "shown": True}, {"type": "until", "time": shot.time}):
        ask(f"/sessions/{session}/command", {"command": command})
    while state["time"] < shot.time:
        time.sleep(0.2)
        state = ask(f"/sessions/{session}")["state"]


def small(picture: bytes) -> bytes:
    """Returns a PNG with fewer colours, which takes less room."""
    out = io.BytesIO()
    Image.open(io.BytesIO(picture)).convert("RGB").quantize(COLOURS).save(out, "PNG", optimize=True)
    return out.getvalue()


def main() -> None:
    """Takes all pictures.

    Raises:
        SystemExit: If a picture is too large, or there is no Chromium.
    """
    browser_path = next((path for name in BROWSERS if (path := shutil.which(name))), None)
    if browser_path is None:
        raise SystemExit("there is no Chromium")
    with workbench() as address, sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=browser_path, args=list(OPTIONS))
        for shot in SHOTS:
            context = browser.new_context(viewport={"width": 1440, "height": 860}, color_scheme="light")
            context.add_init_script(f"localStorage.setItem('actr3d.tab', '\"{shot.tab}\"')")
            page = context.new_page()
            page.set_default_timeout(PATIENCE)
            prepare(address, shot)
            page.goto(f"{address}&model={shot.model}")
            page.locator("iframe[src^='/viser/']").wait_for()
            page.locator(".scene-cover").wait_for(state="hidden")
            page.wait_for_timeout(SETTLED)
            picture = small(page.screenshot())
            if len(picture) > LARGEST:
                raise SystemExit(f"{shot.name} has {len(picture):,} bytes; at most {LARGEST:,} are allowed")
            (IMAGES / shot.name).write_bytes(picture)
            context.close()
        browser.close()


if __name__ == "__main__":
    main()
