"""What the tests of the page share: a workbench that runs, and a browser that is let in."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Browser, Page

from tests.helpers.page import Users, chromium
from tests.helpers.workbench_server import Served, served

REFUSED = re.compile("Failed to load resource: the server responded with a status of 4(0[0-9]|22)")
"""What Chromium writes to its console of an answer that says why something is not done."""
WAITING = re.compile(r"Blocked script execution in '[^']*/report/index\.html\b")
"""What it writes when Playwright itself waits for something within a report, where no scripts run; a report has none of its own."""


@pytest.fixture(scope="session")
def workbench(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    with served(tmp_path_factory.mktemp("browser") / "models") as running:
        yield running


class Opened:
    """The browser of this process, and the users in it: while tests of this folder follow one another."""

    def __init__(self) -> None:
        self._ending = ExitStack()
        self._browser: Browser | None = None
        self._users: dict[str, Users] = {}

    def browser(self) -> Browser:
        if self._browser is None:
            self._browser = self._ending.enter_context(chromium())
        return self._browser

    def users(self, url: str) -> Users:
        if url not in self._users:
            self._users[url] = Users(self.browser(), url)
        return self._users[url]

    def close(self) -> None:
        self._browser = None
        self._users.clear()
        self._ending.close()


OPENED = Opened()


@pytest.hookimpl(wrapper=True)
def pytest_runtest_teardown(nextitem: pytest.Item | None) -> Iterator[None]:
    """Ends the browser before tests of other folders, for Playwright's event loop is in their way."""
    yield
    if nextitem is None or nextitem.path.parent != Path(__file__).parent:
        OPENED.close()


@pytest.fixture
def browser() -> Browser:
    return OPENED.browser()


@pytest.fixture
def users(workbench: Served) -> Users:
    return OPENED.users(workbench.url)


@pytest.fixture
def pages(users: Users, workbench: Served, request: pytest.FixtureRequest) -> Iterator[Callable[..., Page]]:
    """Opens pages of a new user, whose browser remembers nothing but which tab is open: `tab`, or None for that of a first visit.

    Runs go as fast as they can, so that nobody waits for them; with `paced` as they do for users, at real time where there is a body.
    Whatever their consoles complain of fails the test; with `refusals` not that the server has refused something. The sessions of
    tests before are closed. Only tests with the marker `scene` load the 3D view.
    """
    for session in workbench.get("/api/sessions").json()["sessions"]:
        workbench.post(f"/api/sessions/{session['id']}/close")
    complaints: list[str] = []

    def note(complaint: str) -> None:
        if not WAITING.match(complaint):
            complaints.append(complaint)

    def note_unless_refused(complaint: str) -> None:
        if not REFUSED.match(complaint):
            note(complaint)

    def opened(
        model: str = "doorway.py",
        width: int = 1280,
        height: int = 800,
        theme: Any = "light",
        tab: str | None = "buffers",
        paced: bool = False,
        refusals: bool = False,
    ) -> Page:
        there = sorted(str(file.relative_to(workbench.folder)) for file in workbench.folder.rglob("*.py"))
        assert model in there, f"pages: the workbench has no model {model!r}; copy it into its folder first (it has {', '.join(there)})"
        page = users.new(request.node.get_closest_marker("scene") is not None, note_unless_refused if refusals else note)
        page.set_viewport_size({"width": width, "height": height})
        page.emulate_media(color_scheme=theme)
        if tab is not None:
            page.evaluate("(tab) => localStorage.setItem('actr3d.tab', JSON.stringify(tab))", tab)
        if not paced and not any(one["model"] == model for one in workbench.get("/api/sessions").json()["sessions"]):
            workbench.post("/api/sessions", {"model": model})
        page.goto(f"{workbench.address}&model={model}")
        assert "token" not in page.url
        return page

    yield opened
    users.leave()
    assert complaints == []


@pytest.fixture
def page(pages: Callable[..., Page]) -> Page:
    """One such page."""
    return pages()


@pytest.fixture
def blank(users: Users, workbench: Served) -> Iterator[Page]:
    """A page that imports the modules, and shows nothing."""
    complaints: list[str] = []
    page = users.new(scene=False, hear=complaints.append)
    page.goto(workbench.address)
    yield page
    users.leave()
    assert complaints == []
