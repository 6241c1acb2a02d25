"""A real headless browser for tests."""

from __future__ import annotations

import os
import shutil
from collections.abc import Generator
from contextlib import contextmanager

import pytest
from playwright.sync_api import Browser, sync_playwright

NAMES = ("chromium", "chromium-browser", "google-chrome", "chrome")
OPTIONS = ["--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader"]


@contextmanager
def chromium() -> Generator[Browser]:
    """Starts a Chromium; where there is none the test is skipped, or fails in CI, which is to have one."""
    path = next((path for name in NAMES if (path := shutil.which(name)) is not None), None)
    if path is None:
        if os.environ.get("CI"):
            pytest.fail("there is no Chromium, and CI is to have one")
        pytest.skip("there is no Chromium on this machine")
    with sync_playwright() as playwright:
        browser = playwright.chromium.launch(executable_path=path, args=OPTIONS)
        try:
            yield browser
        finally:
            browser.close()
