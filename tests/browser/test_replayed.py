"""The replay of a recording in a real browser, from disk and without a network."""

from __future__ import annotations

import time
from pathlib import Path
from typing import Any

import httpx
import pytest
from playwright.sync_api import Browser, expect

from tests.browser.looking import PATIENCE, drawn, until
from tests.server.serving import served


@pytest.fixture(scope="module")
def replay(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The replay of a run of the doorway, as it is downloaded."""
    folder = tmp_path_factory.mktemp("replay")
    with served(folder / "models") as server:
        name = server.post("/api/sessions", {"model": "doorway.py", "seed": 1, "run": True}).json()["id"]
        end = time.monotonic() + PATIENCE / 1000
        while (told := server.get(f"/api/sessions/{name}").json())["session"]["status"] != "ended":
            assert time.monotonic() < end
            time.sleep(0.1)
        recording = told["session"]["recording"]
        server.post(f"/api/sessions/{name}/close")
        file = folder / "replay.html"
        address = f"{server.url}/api/recordings/{recording}/file"
        file.write_bytes(httpx.get(address, headers=server.headers, params={"form": "replay.html"}, timeout=150).content)
        return file


@pytest.mark.parametrize("scheme", ["light", "dark"])
def test_it_plays_from_disk_with_scene_and_trace_at_one_time(browser: Browser, replay: Path, scheme: Any) -> None:
    complaints: list[str] = []
    asked: list[str] = []
    with browser.new_context(viewport={"width": 900, "height": 600}, color_scheme=scheme, offline=True) as context:
        page = context.new_page()
        page.set_default_timeout(PATIENCE)
        page.on("pageerror", lambda error: complaints.append(str(error)))
        page.on("console", lambda message: complaints.append(message.text) if message.type == "error" else None)
        page.on("request", lambda request: asked.append(request.url))
        page.goto(replay.as_uri())
        expect(page.get_by_role("heading", name="doorway.py · seed 1")).to_be_visible()
        expect(page.locator("#outcome")).to_have_text("Ended: a mind said stop.")
        page.get_by_text("Parameters and result").click()
        expect(page.get_by_role("row", name="width")).to_be_visible()
        page.get_by_text("Parameters and result").click()
        canvas = page.locator("#canvas")
        drawn(page)
        first = canvas.screenshot()
        page.get_by_role("slider", name="Time").fill("3")
        expect(page.locator("#clock")).to_have_text("3.00 s")
        until(page, lambda: canvas.screenshot() != first)  # it has walked on
        page.get_by_role("slider", name="Time").fill("0")
        page.get_by_label("Show").fill("look fires")
        expect(page.locator(".event").first).to_contain_text("look")
        page.locator(".event").first.click()
        expect(page.locator("#clock")).to_have_text("0.05 s")
        expect(page.locator(".event.now")).to_contain_text("look")
        page.get_by_role("button", name="Play").click()
        expect(page.get_by_role("button", name="Pause")).to_be_visible()
        expect(page.locator("#clock")).not_to_have_text("0.05 s")
    assert complaints == []
    assert asked == [replay.as_uri()]
