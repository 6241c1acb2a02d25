"""A page whose workbench is started again."""

from __future__ import annotations

from pathlib import Path

import pytest
from playwright.sync_api import Browser, expect

from tests.helpers.workbench_server import served


@pytest.mark.slow
def test_a_page_of_a_workbench_that_was_started_again_says_what_to_do(browser: Browser, tmp_path: Path) -> None:
    with browser.new_context() as user:
        page = user.new_page()
        connection = page.locator("#connection")
        with served(tmp_path / "models") as first:
            page.goto(f"{first.address}&model=counting.py")
            expect(connection).to_have_text("connected")
            expect(page.locator("#status")).to_have_text("paused: at its start", timeout=120_000)
        expect(connection).to_have_text("connection lost; trying again …")
        with served(tmp_path / "models", "--port", str(first.port)) as second:
            expect(connection).to_have_text("the workbench was started again: open the address that it printed", timeout=30_000)
            expect(page.locator("#status")).to_have_text("stopped with the workbench")
            expect(page.locator("#run")).to_be_disabled()
            text = "The workbench was started again: open the address that it printed. What this run has recorded is among the runs there."
            expect(page.locator(".timeline-nothing")).to_have_text(text)
            user.new_page().goto(second.address)
            expect(connection).to_have_text("connected", timeout=30_000)
