"""How tests look at the page: with patience, in a Chromium that draws without a graphics card."""

from __future__ import annotations

import re
import shutil

from playwright.sync_api import Page, expect

PATIENCE = 60_000
"""[ms]"""
OPTIONS = ("--no-sandbox", "--use-angle=swiftshader", "--enable-unsafe-swiftshader")


def browser_path() -> str | None:
    """Returns where a Chromium is; None where there is none."""
    names = ("chromium", "chromium-browser", "google-chrome", "chrome")
    return next((path for name in names if (path := shutil.which(name)) is not None), None)


def shows(page: Page, where: str, text: str) -> None:
    """Waits until a place of the page has a text that the pattern `text` is found in."""
    expect(page.locator(where)).to_have_text(re.compile(text), timeout=PATIENCE)


def choose(page: Page, model: str) -> None:
    """Shows a model, and waits until it is there."""
    page.get_by_label("Model", exact=True).select_option(model)
    shows(page, "#time", "t =")


def open_tab(page: Page, title: str) -> None:
    """Opens one of the tabs beside the 3D view."""
    page.get_by_role("tab", name=title).click()
