"""A page whose workbench is out of reach for a while, or is started again."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from playwright.sync_api import Browser, Page, expect

from tests.helpers.page import open_tab, shows, until
from tests.helpers.workbench_server import served

CUT = """() => {
  const asked = window.fetch;
  window.left = 2;
  window.fetch = (...given) => (window.left-- > 0 ? Promise.reject(new TypeError("cut")) : asked(...given));
}"""
"""Cuts the connection for the next two requests."""


def test_what_a_panel_reads_while_the_workbench_is_out_of_reach_it_shows_afterwards(pages: Callable[..., Page]) -> None:
    page = pages(tab="buffers")
    shows(page, "#status", "at its start")
    for title, where, text in (
        ("Editor", ".code .cm-content", "Walks"),
        ("Parameters", ".parameters", "speed"),
        ("Runs", ".runs-table", "present"),
    ):
        page.evaluate(CUT)
        open_tab(page, title)
        until(page, lambda: page.evaluate("window.left") < 0)
        shows(page, where, text)
    expect(page.locator(".toasts, .runs .problem")).to_have_text([""])


@pytest.mark.slow
def test_a_page_of_a_workbench_that_was_started_again_says_what_to_do(browser: Browser, tmp_path: Path) -> None:
    with browser.new_context() as user:
        page = user.new_page()
        connection = page.locator("#connection")
        with served(tmp_path / "models") as first:
            page.goto(f"{first.address}&model=counting.py")
            expect(connection).to_have_text("connected")
            expect(page.locator("#status")).to_have_text("paused: at its start", timeout=120_000)
            page.get_by_label("Speed", exact=True).select_option("1/20 x")
            page.click("#run")
            expect(page.locator("#status")).to_have_text("running")
            first.process.kill()  # it cannot stop the run
        expect(connection).to_have_text("connection lost; trying again …")
        expect(page.locator("#status")).to_have_text("running when the connection was lost")
        open_tab(page, "Editor")
        with served(tmp_path / "models", "--port", str(first.port)) as second:
            expect(connection).to_have_text("the workbench was started again: open the address that it printed", timeout=30_000)
            expect(page.locator("#status")).to_have_text("stopped with the workbench")
            expect(page.locator("#run")).to_be_disabled()
            text = "The workbench was started again: open the address that it printed. What this run has recorded is among the runs there."
            expect(page.locator(".timeline-nothing")).to_have_text(text)
            user.new_page().goto(second.address)
            expect(connection).to_have_text("connected", timeout=30_000)
            shows(page, ".code .cm-content", "Counts")
