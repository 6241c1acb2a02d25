"""The manual: it builds without a warning, loads nothing from elsewhere, and works in a browser under the workbench's own policy."""

from __future__ import annotations

import re
import threading
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
import uvicorn
from playwright.sync_api import Browser, Page, expect
from starlette.applications import Starlette
from starlette.routing import Mount
from starlette.staticfiles import StaticFiles

from tests.helpers.manual_site import ROOT, built_manual
from tests.helpers.page import open_tab, until
from workbench.auth import Gate, Guard, Token
from workbench.cli import listen
from workbench.shipped import static

ELSEWHERE = re.compile(r"""<(?:script|link|img|iframe|source)\b[^>]*(?:src|href)=["'](?:https?:)?//""")
INLINE = re.compile(r"<script(?![^>]*\bsrc=)(?![^>]*application/json)|\son\w+=[\"']")


@pytest.fixture(scope="module")
def site() -> Path:
    return built_manual()


@pytest.fixture
def opened(site: Path, browser: Browser) -> Iterator[Callable[..., tuple[Page, str]]]:
    """Serves the manual as the workbench does, behind its guard; opens pages, and gives them with the address of the manual."""
    listening = listen("127.0.0.1", 0)
    port: int = listening.getsockname()[1]
    token = Token()
    gate = Gate(token=token, port=port)
    app: Any = Guard(Starlette(routes=[Mount("/manual", StaticFiles(directory=site, html=True))]), gate)
    server = uvicorn.Server(uvicorn.Config(app, log_level="warning", lifespan="off"))
    thread = threading.Thread(target=server.run, kwargs={"sockets": [listening]})
    thread.start()
    contexts: list[Any] = []

    def open_page(theme: Any) -> tuple[Page, str]:
        contexts.append(browser.new_context(viewport={"width": 1280, "height": 800}, color_scheme=theme))
        contexts[-1].add_cookies([{"name": gate.cookie, "value": token.reveal(), "url": f"http://127.0.0.1:{port}"}])
        return contexts[-1].new_page(), f"http://127.0.0.1:{port}/manual"

    yield open_page
    for context in contexts:
        context.close()
    server.should_exit = True
    thread.join()


@pytest.mark.slow
def test_the_manual_is_complete_and_loads_nothing_from_elsewhere(site: Path) -> None:
    pages = sorted(site.rglob("*.html"))
    texts = {page.relative_to(site).as_posix(): page.read_text(encoding="utf-8") for page in pages}
    assert [name for name, text in texts.items() if ELSEWHERE.search(text)] == []
    assert [name for name, text in texts.items() if INLINE.search(text)] == []
    models = [path.relative_to(ROOT / "models").with_suffix("").as_posix().replace("/", "-") for path in (ROOT / "models").rglob("*.py")]
    assert {f"models/{model}/index.html" for model in models} <= texts.keys()
    panels = [
        *re.findall(r'\bid: "(\w+)",\s*title:', "".join(file.read_text(encoding="utf-8") for file in (static() / "panels").glob("*.js")))
    ]
    assert len(panels) > 8
    assert {f"workbench/{panel}/index.html" for panel in [*panels, "scene", "timeline"]} <= texts.keys()


@pytest.mark.slow
def test_the_manual_can_be_read_and_searched_offline(opened: Callable[..., tuple[Page, str]]) -> None:
    page, manual = opened("dark")
    page.goto(f"{manual}/")
    expect(page.locator("body")).to_have_attribute("data-md-color-scheme", "slate")
    page, manual = opened("light")
    complaints: list[str] = []
    page.on("console", lambda message: complaints.append(message.text) if message.type == "error" else None)
    page.on("request", lambda request: None if request.url.startswith(manual) else complaints.append(request.url))
    page.goto(f"{manual}/")
    expect(page.locator("h1")).to_have_text(re.compile("ACT-R 3D"))
    expect(page.locator("body")).to_have_attribute("data-md-color-scheme", "default")
    found = page.locator(".md-search-result__item")

    def search() -> bool:  # what is typed before the search has loaded is not searched for
        page.get_by_role("textbox", name="Search").fill("")
        page.get_by_role("textbox", name="Search").press_sequentially("base-level")
        page.wait_for_timeout(1000)
        return found.count() > 0

    until(page, search)
    expect(found.first).to_be_visible()
    page.goto(f"{manual}/models/counting/")
    expect(page.locator("svg.run")).to_be_visible()
    assert complaints == []


def test_each_panel_links_to_its_page_of_the_manual(page: Page) -> None:
    for tab in ("About", "Productions", "Messages"):
        open_tab(page, tab)
        link = page.get_by_role("link", name=f"Manual: {tab}")
        expect(link).to_have_attribute("href", f"/manual/workbench/{tab.lower()}/")
    expect(page.get_by_role("link", name="Manual: Timeline")).to_be_visible()
    page.get_by_role("button", name="Help", exact=True).click()
    expect(page.get_by_role("dialog").get_by_role("link", name="Manual of ACT-R 3D")).to_have_attribute("href", "/manual/")
