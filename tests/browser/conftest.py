"""What the tests of the page share: a workbench that runs, and a browser that is let in."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import Any

import pytest
from playwright.sync_api import Browser, Page

from tests.browser.looking import PATIENCE, chromium
from tests.server.serving import Served, served


@pytest.fixture(scope="session")
def workbench(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    with served(tmp_path_factory.mktemp("browser") / "models") as running:
        yield running


@pytest.fixture(scope="module")
def browser() -> Iterator[Browser]:
    """A browser; no longer than for one file of tests, for Playwright's event loop is in the way of others."""
    with chromium() as started:
        yield started


@pytest.fixture
def pages(browser: Browser, workbench: Served) -> Iterator[Callable[..., Page]]:
    """Opens pages of a new user, whose browser remembers nothing; whatever their consoles complain of fails the test.

    The sessions of tests before are closed.
    """
    for session in workbench.get("/api/sessions").json()["sessions"]:
        workbench.post(f"/api/sessions/{session['id']}/close")
    complaints: list[str] = []

    def note(message: Any) -> None:
        if message.type == "error":
            complaints.append(message.text)

    def fault(error: Any) -> None:
        complaints.append(str(error))

    contexts: list[Any] = []

    def opened(model: str = "doorway.py", width: int = 1280, height: int = 800, theme: Any = "light") -> Page:
        contexts.append(browser.new_context(viewport={"width": width, "height": height}, color_scheme=theme))
        page = contexts[-1].new_page()
        page.set_default_timeout(PATIENCE)
        page.on("console", note)
        page.on("pageerror", fault)
        page.goto(f"{workbench.address}&model={model}")
        assert "token" not in page.url
        return page

    yield opened
    for context in contexts:
        context.close()
    assert complaints == []


@pytest.fixture
def page(pages: Callable[..., Page]) -> Page:
    """One such page."""
    return pages()
