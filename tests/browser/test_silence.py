"""A workbench that is connected but does not answer: stopped by a signal, or busy."""

from __future__ import annotations

import os
import signal
from collections.abc import Callable, Generator
from contextlib import contextmanager
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Page, expect

from tests.helpers.page import PART, shows
from tests.helpers.workbench_server import Served, served

pytestmark = pytest.mark.skipif(os.name != "posix", reason="no process can be stopped")


@contextmanager
def stopped(workbench: Served) -> Generator[None]:
    """Stops the server, as a debugger or a busy machine does, and continues it."""
    os.kill(workbench.process.pid, signal.SIGSTOP)
    try:
        yield
    finally:
        os.kill(workbench.process.pid, signal.SIGCONT)


def test_a_click_that_the_workbench_does_not_answer_has_a_sign_until_it_does(browser: Browser, tmp_path: Path) -> None:
    with served(tmp_path / "models") as workbench, browser.new_context() as user:
        user.add_init_script(PART)
        page: Page = user.new_page()
        page.goto(f"{workbench.address}&model=counting.py")
        shows(page, "#status", "at its start")
        note, connection = page.locator(".silence"), page.locator("#connection")
        for button, time_shown in (("#step", "0.01 s"), ("#cycle", "0.05 s"), ("#run", r"\d\.\d\d s")):
            page.wait_for_timeout(1000)  # until what was asked before is answered
            with stopped(workbench):
                page.wait_for_timeout(1500)
                expect(note).to_have_text("")  # nobody waits for anything
                page.click(button)
                expect(note).to_have_text("The workbench does not answer …")
                expect(connection).to_have_text("no answer")
            expect(note).to_have_text("")
            expect(connection).to_have_text("connected")
            shows(page, "#time", time_shown)
        shows(page, "#status", "ended")
        with stopped(workbench):
            page.get_by_label("Model", exact=True).select_option("doorway.py")  # a request of another kind
            expect(note).to_contain_text("does not answer")
        expect(note).to_have_text("")
        shows(page, "#status", "at its start")


def test_a_command_that_takes_long_is_no_silence(page: Page) -> None:
    shows(page, "#status", "at its start")
    page.evaluate(
        """() => {
          window.signs = [];
          window.slow = part("server.js").then(({ request }) => request({ type: "until", time: 1e9 })).catch(() => {});
          part("silence.js").then(({ silent }) => silent.subscribe((now) => window.signs.push(now)));
        }"""
    )
    page.wait_for_timeout(2500)
    page.click("#stop")
    shows(page, "#status", "stopped")
    assert page.evaluate("window.signs") == [False]


PLACES = """async () => {
  const { silent } = await part("silence.js");
  const note = document.querySelector(".silence");
  while (note.offsetHeight === 0) {
    silent.value = true;
    await new Promise((done) => requestAnimationFrame(done));
  }
  return [document.querySelector(".bar").getBoundingClientRect().bottom, note.getBoundingClientRect().top];
}"""
"""Returns where the bar ends and where the note begins [px]."""


def test_the_note_covers_nothing_of_the_bar(pages: Callable[..., Page]) -> None:
    page = pages(width=853, height=533)
    shows(page, "#status", "at its start")
    bar, note = page.evaluate(PLACES)
    assert bar > 60  # it has two rows
    assert bar <= note < bar + 20
