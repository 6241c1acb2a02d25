"""Helpers for tests of the page, in a Chromium that draws without a graphics card."""

from __future__ import annotations

import os
import re
import shutil
import time
from collections.abc import Callable, Generator
from contextlib import contextmanager
from typing import Any

import pytest
from playwright.sync_api import APIResponse, Browser, ConsoleMessage, Error, Page, Request, Route, expect, sync_playwright

PATIENCE = 60_000
"""Maximum time that a test waits [ms]; machines are slow at times."""
expect.set_options(timeout=PATIENCE)  # the default is five seconds

OPTIONS = ("--no-sandbox", "--disable-gpu", "--enable-unsafe-swiftshader")

NAMES = ("chromium-headless-shell", "chromium", "chromium-browser", "google-chrome", "chrome")
"""Browsers by preference: the headless shell has no windows and menus to draw, and takes two thirds of the time."""


def browser_path() -> str | None:
    """Returns the path of a Chromium, or None if there is none."""
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
    """Starts a Chromium. If there is none, the test is skipped; in CI it fails."""
    path = browser_path()
    if path is None:
        if os.environ.get("CI"):
            pytest.fail("there is no Chromium, and CI is to have one")
        pytest.skip("there is no Chromium on this machine")
    with launched(path) as browser:
        yield browser


PART = "window.part = (path) => import(new URL(path, document.querySelector('script[type=module]').src))"
"""Defines `part("store.js")`, which gives a test a JavaScript module of the page."""

ANSWERS = """{
  const asked = window.fetch;
  window.fetch = (what, options) => {
    const answers = JSON.parse(sessionStorage.getItem("answers") ?? "{}");
    const answer = answers[new URL(what, location).pathname];
    return answer ? Promise.resolve(Response.json(answer.json, { status: answer.status })) : asked(what, options);
  };
}"""
"""Answers requests of the page as `answers` has written to its session storage."""

NO_SCENE = """{
  const kind = HTMLIFrameElement.prototype;
  const { get, set } = Object.getOwnPropertyDescriptor(kind, "src");
  Object.defineProperty(kind, "src", { get, set(address) {
    if (!address.startsWith("/viser/")) return set.call(this, address);
    setTimeout(() => window.dispatchEvent(new MessageEvent("message", { source: this.contentWindow, data: { drawn: true } })));
  } });
}"""
"""Leaves the 3D view empty in tests of other things: without a graphics card, drawing it keeps two processors busy for seconds."""


LASTING = ("once", "add_init_script", "expose_binding", "expose_function")
"""Methods of a page whose effect lasts and is not undone here; listeners of `on` are removed."""


class Users:
    """The users of a workbench in one browser, each with their own page and browser storage.

    A page is reused for the next user: for a new page the browser starts a process, which must read and compile all files of the page
    again, half of the time that a page takes to load. A page that a test has changed lastingly is closed.
    """

    def __init__(self, browser: Browser, url: str) -> None:
        self._browser = browser
        self._url = url
        self._elsewhere = f"{url}/nothing"  # not found, but of the same origin, so that the browser keeps the page's process
        self._free: dict[bool, list[Page]] = {True: [], False: []}
        self._taken: list[tuple[bool, Page]] = []
        self._changed: set[Page] = set()
        self._hear: dict[Page, Callable[[str], object]] = {}
        self._listeners: dict[Page, list[tuple[Any, ...]]] = {}

    def new(self, scene: bool, hear: Callable[[str], object] | None = None) -> Page:
        """Returns the page of a new user, with or without the 3D view.

        `hear` receives each error on the page's console.
        """
        page = self._free[scene].pop() if self._free[scene] else self._opened(scene)
        if hear is not None:
            self._hear[page] = hear
        self._taken.append((scene, page))
        return page

    def leave(self) -> None:
        """Empties all pages, and removes everything that the users stored."""
        taken, self._taken = self._taken, []
        for scene, page in taken:
            for other in page.context.pages:
                if other != page:
                    other.close()
            if page in self._changed or page.is_closed():
                page.context.close()
            else:
                self._forget(page)
                self._free[scene].append(page)

    def _opened(self, scene: bool) -> Page:
        context = self._browser.new_context()
        context.add_init_script(PART)
        context.add_init_script(ANSWERS)
        if not scene:
            context.add_init_script(NO_SCENE)
        page = context.new_page()
        page.set_default_timeout(PATIENCE)

        def hear(complaint: str) -> None:
            if page in self._hear:
                self._hear[page](complaint)

        def hear_console(message: ConsoleMessage) -> None:
            if message.type == "error":
                hear(f"{message.text} ({message.location['url']})" if message.text.startswith("Failed to load resource") else message.text)

        def hear_error(error: Error) -> None:
            hear(str(error))

        page.on("console", hear_console)
        page.on("pageerror", hear_error)
        page.goto(self._elsewhere)
        for name in ("on", *LASTING):
            setattr(page, name, self._noted(page, name, getattr(page, name)))
        for name in LASTING:
            setattr(context, name, self._noted(page, name, getattr(context, name)))
        return page

    def _noted(self, page: Page, name: str, method: Callable[..., Any]) -> Callable[..., Any]:
        def called(*given: Any, **named: Any) -> Any:
            if name == "on":
                self._listeners.setdefault(page, []).append(given)
            else:
                self._changed.add(page)
            return method(*given, **named)

        return called

    def _forget(self, page: Page) -> None:
        for event, listener in self._listeners.pop(page, ()):
            page.remove_listener(event, listener)
        page.unroute_all()
        page.context.unroute_all()
        self._hear.pop(page, None)
        page.goto(self._elsewhere)
        page.evaluate("sessionStorage.clear()")
        page.context.clear_permissions()
        storage = page.context.new_cdp_session(page)
        storage.send("Storage.clearDataForOrigin", {"origin": self._url, "storageTypes": "all"})  # pyright: ignore[reportUnknownMemberType]
        storage.detach()


def shows(page: Page, where: str, text: str) -> None:
    """Waits until a place of the page has a text that the pattern `text` is found in."""
    expect(page.locator(where)).to_have_text(re.compile(text))


def say(page: Page, **command: Any) -> None:
    """Sends a command to the run that the page shows, and waits for the reply."""
    page.evaluate("async (command) => void (await (await part('server.js')).request(command))", command)


def until(page: Page, condition: Callable[[], bool]) -> None:
    """Waits for a condition that no locator can express."""
    end = time.monotonic() + PATIENCE / 1000
    while not condition():
        assert time.monotonic() < end
        page.wait_for_timeout(50)


def becomes_true(page: Page, question: str) -> None:
    """Waits until an asynchronous function of JavaScript returns something true: to `wait_for_function`, any promise is true."""
    until(page, lambda: bool(page.evaluate(question)))


def answer_to(route: Route) -> APIResponse:
    """Returns the server's answer to a request of the page.

    The server closes a connection that is idle for some seconds, perhaps while a request is being sent on it. A browser then repeats the
    request on a new connection; Playwright does so only with `max_retries`.
    """
    return route.fetch(max_retries=1)


def answers(page: Page, path: str, json: dict[str, Any], status: int = 200) -> None:
    """Answers requests of the page for a path from now on, after reloads, too, without the server.

    While Playwright has a route, the browser has no cache: a page that is loaded then fetches all of its modules again, for two seconds.
    """
    page.evaluate(
        """([path, answer]) => {
          const answers = JSON.parse(sessionStorage.getItem("answers") ?? "{}");
          sessionStorage.setItem("answers", JSON.stringify({ ...answers, [path]: answer }));
        }""",
        [path, {"json": json, "status": status}],
    )


@contextmanager
def holding(page: Page, where: str, wanted: Callable[[Request], bool]) -> Generator[list[tuple[Route, APIResponse]]]:
    """Holds back the server's answers to such requests, which the server has carried out; yields the ones that are held."""
    held: list[tuple[Route, APIResponse]] = []

    def hold(route: Route) -> None:
        if wanted(route.request):
            held.append((route, answer_to(route)))
        else:
            route.continue_()

    page.route(where, hold)
    yield held
    until(page, lambda: bool(held))
    for route, response in held:
        route.fulfill(response=response)
    page.unroute(where)


def drawn(page: Page) -> None:
    """Waits until the page has been drawn with the data that it has received."""
    page.evaluate("() => new Promise((done) => requestAnimationFrame(() => requestAnimationFrame(done)))")


def duplicate(page: Page) -> Page:
    """Returns a copy of a page with the same address and session storage, as a browser makes it to duplicate a tab."""
    twin = page.context.new_page()
    twin.add_init_script(f"Object.assign(sessionStorage, {page.evaluate('JSON.stringify(sessionStorage)')})")
    twin.goto(page.url)
    return twin


def choose(page: Page, model: str) -> None:
    """Opens a model, and waits until it is shown."""
    page.get_by_label("Model", exact=True).select_option(model)
    shows(page, "#time", "t =")


def open_tab(page: Page, title: str) -> None:
    """Opens one of the tabs beside the 3D view."""
    page.get_by_role("tab", name=title).click()
