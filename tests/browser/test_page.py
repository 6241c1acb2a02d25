"""The page in a real browser: run, step, the aperture, an error, an endless loop, a second tab."""

from __future__ import annotations

import os
import re
import shutil
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Page, expect, sync_playwright

from tests.server.serving import Served, served

PATIENCE = 60_000
"""[ms]"""


def browser_path() -> str | None:
    """Returns where a Chromium is; None where there is none."""
    names = ("chromium", "chromium-browser", "google-chrome", "chrome")
    return next((path for name in names if (path := shutil.which(name)) is not None), None)


@pytest.fixture(scope="session")
def workbench(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    with served(tmp_path_factory.mktemp("browser") / "models") as running:
        yield running


@pytest.fixture
def page(workbench: Served) -> Iterator[Page]:
    """A browser's page that is let in; whatever its console complains of fails the test."""
    path = browser_path()
    if path is None:
        if os.environ.get("CI"):
            pytest.fail("there is no Chromium, and CI is to have one")
        pytest.skip("there is no Chromium on this machine")
    complaints: list[str] = []

    def note(message: Any) -> None:
        if message.type == "error":
            complaints.append(message.text)

    with sync_playwright() as playwright:
        options = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]
        browser = playwright.chromium.launch(executable_path=path, args=options)
        page = browser.new_context(viewport={"width": 1280, "height": 800}).new_page()
        page.set_default_timeout(PATIENCE)
        page.on("console", note)
        page.on("pageerror", lambda error: complaints.append(str(error)))
        page.goto(workbench.address)
        assert "token" not in page.url
        yield page
        browser.close()
    assert complaints == []


def shows(page: Page, where: str, text: str) -> None:
    expect(page.locator(where)).to_have_text(re.compile(text), timeout=PATIENCE)


def choose(page: Page, model: str) -> None:
    page.get_by_label("Model", exact=True).select_option(model)


def test_run_step_and_the_aperture(page: Page, workbench: Served, tmp_path: Path) -> None:
    choose(page, "doorway.py")
    shows(page, "#time", "0.00 s")
    page.click("#step")
    shows(page, "#time", "0.01 s")
    shows(page, "#why-text", "look: matches")
    page.click("#cycle")
    shows(page, "#time", "0.05 s")
    shows(page, "#events", "look")
    page.click("#back")
    shows(page, "#time", "0.04 s")
    page.locator("#aperture").fill("90")
    shows(page, "#width", "90 cm *A/S 2.00")
    scene = page.frame_locator("iframe[title='3D view']")
    expect(scene.get_by_text("t = 0.04 s")).to_be_visible(timeout=PATIENCE)
    expect(scene.locator("canvas").first).to_be_visible(timeout=PATIENCE)
    page.click("#run")
    shows(page, "#status", "ended")
    expect(page.locator("#events")).not_to_contain_text("turn")  # it is wide enough
    page.click("#restart")
    shows(page, "#time", "0.00 s")
    shows(page, "#width", "50 cm *A/S 1.11")
    page.click("#run")
    shows(page, "#events", "turns")
    picture = page.screenshot()
    assert len(set(picture)) > 100  # and a person has looked at it


def test_a_second_tab_and_a_reload_show_the_same(page: Page, workbench: Served) -> None:
    choose(page, "counting.py")
    shows(page, "#time", "0.00 s")
    page.click("#cycle")
    shows(page, "#events", "start_counting")
    other = page.context.new_page()
    other.goto(f"{workbench.url}/?model=counting.py")
    expect(other.locator("#events")).to_have_text(re.compile("start_counting"), timeout=PATIENCE)
    other.click("#cycle")
    shows(page, "#events", "count_on")
    page.reload()
    shows(page, "#events", "count_on")


def test_an_error_is_shown_as_text_and_mended(page: Page, workbench: Served) -> None:
    bad = "raise ValueError('<img src=x onerror=alert(1)>')\n"
    (workbench.folder / "bad.py").write_text(bad, encoding="utf-8")
    page.reload()
    choose(page, "bad.py")
    page.on("dialog", lambda dialog: pytest.fail("it was run as HTML"))
    page.click("#run")
    shows(page, "#log", re.escape("ValueError: <img src=x onerror=alert(1)>"))
    shows(page, "#log", "bad.py:1")
    (workbench.folder / "bad.py").write_text("print('mended')\n", encoding="utf-8")
    page.click("#restart")
    shows(page, "#status", "at its start")
    page.click("#run")
    shows(page, "#events", "mended")


def test_an_endless_loop_is_stopped(page: Page, workbench: Served) -> None:
    (workbench.folder / "loop.py").write_text("x = 1\nwhile True:\n    x += 1\n", encoding="utf-8")
    page.reload()
    choose(page, "loop.py")
    shows(page, "#status", "at its start")
    page.click("#run")
    shows(page, "#status", "busy at line [23]")
    page.click("#stop")
    shows(page, "#status", "stopped")
