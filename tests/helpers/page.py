"""How tests look at the page: with patience, in a Chromium that draws without a graphics card."""

from __future__ import annotations

import os
import re
import shutil
import time
from collections.abc import Callable, Generator
from contextlib import contextmanager

import pytest
from playwright.sync_api import Browser, BrowserContext, Page, expect, sync_playwright

PATIENCE = 60_000
"""So long a test waits for what must come [ms]; machines are slow at times."""
expect.set_options(timeout=PATIENCE)  # whatever is expected, and not for five seconds only

OPTIONS = ("--no-sandbox", "--disable-gpu", "--enable-unsafe-swiftshader")

NAMES = ("chromium-headless-shell", "chromium", "chromium-browser", "google-chrome", "chrome")
"""Browsers by preference: the headless shell has no windows and menus to draw, and takes two thirds of the time."""


def browser_path() -> str | None:
    """Returns where a Chromium is; None where there is none."""
    return next((path for name in NAMES if (path := shutil.which(name)) is not None), None)


@contextmanager
def launched(path: str) -> Generator[Browser]:
    """Starts a headless Chromium that draws the 3D view by software."""
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=path, args=list(OPTIONS))
        try:
            yield browser
        finally:
            browser.close()


@contextmanager
def chromium() -> Generator[Browser]:
    """Starts a Chromium; where there is none the test is skipped, or fails in CI, which is to have one."""
    path = browser_path()
    if path is None:
        if os.environ.get("CI"):
            pytest.fail("there is no Chromium, and CI is to have one")
        pytest.skip("there is no Chromium on this machine")
    with launched(path) as browser:
        yield browser


PART = "window.part = (path) => import(new URL(path, document.querySelector('script[type=module]').src))"
"""Defines `part("store.js")`, the module of the page with which a test looks inside."""

NO_SCENE = """{
  const kind = HTMLIFrameElement.prototype;
  const { get, set } = Object.getOwnPropertyDescriptor(kind, "src");
  Object.defineProperty(kind, "src", { get, set(address) {
    if (!address.startsWith("/viser/")) return set.call(this, address);
    setTimeout(() => window.dispatchEvent(new MessageEvent("message", { source: this.contentWindow, data: { drawn: true } })));
  } });
}"""
"""Leaves the 3D view empty where a test is about something else: to draw it without a graphics card takes seconds of two processors."""


class Users:
    """The users of a workbench in one browser: each has a memory of its own, but for the page's files, which a browser loads once."""

    def __init__(self, browser: Browser, url: str) -> None:
        self._browser = browser
        self._url = url
        self._free: dict[bool, list[BrowserContext]] = {True: [], False: []}
        self._taken: list[tuple[bool, BrowserContext]] = []

    def new(self, scene: bool) -> BrowserContext:
        """Returns the context of a user who has not been here before, and who sees the 3D view or not."""
        if self._free[scene]:
            context = self._free[scene].pop()
        else:
            context = self._browser.new_context()
            context.add_init_script(PART)
            if not scene:
                context.add_init_script(NO_SCENE)
        self._taken.append((scene, context))
        return context

    def leave(self) -> None:
        """Closes all pages; what the users did is forgotten."""
        for scene, context in self._taken:
            context.unroute_all()
            context.clear_permissions()
            for page in context.pages:
                page.close()
            blank = context.new_page()
            storage = context.new_cdp_session(blank)
            storage.send("Storage.clearDataForOrigin", {"origin": self._url, "storageTypes": "all"})  # pyright: ignore[reportUnknownMemberType]
            blank.close()
            self._free[scene].append(context)
        self._taken.clear()


def shows(page: Page, where: str, text: str) -> None:
    """Waits until a place of the page has a text that the pattern `text` is found in."""
    expect(page.locator(where)).to_have_text(re.compile(text))


def until(page: Page, condition: Callable[[], bool]) -> None:
    """Waits until something is so that no locator can tell."""
    end = time.monotonic() + PATIENCE / 1000
    while not condition():
        assert time.monotonic() < end
        page.wait_for_timeout(50)


def drawn(page: Page) -> None:
    """Waits until the page has been drawn with what it has taken in."""
    page.evaluate("() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")


def choose(page: Page, model: str) -> None:
    """Shows a model, and waits until it is there."""
    page.get_by_label("Model", exact=True).select_option(model)
    shows(page, "#time", "t =")


def open_tab(page: Page, title: str) -> None:
    """Opens one of the tabs beside the 3D view."""
    page.get_by_role("tab", name=title).click()
