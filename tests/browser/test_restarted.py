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
            page.goto(first.address)
            expect(connection).to_have_text("connected")
        expect(connection).to_have_text("connection lost; trying again …")
        with served(tmp_path / "models", "--port", str(first.port)) as second:
            expect(connection).to_have_text("the workbench was started again: open the address that it printed", timeout=30_000)
            user.new_page().goto(second.address)
            expect(connection).to_have_text("connected", timeout=30_000)
