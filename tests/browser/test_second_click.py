"""The second click of a double click, where the first one has removed what it was meant for."""

from __future__ import annotations

from collections.abc import Callable

from playwright.sync_api import Page, expect

from tests.helpers.page import drawn, say, shows
from tests.helpers.workbench_server import Served


def test_a_double_click_in_a_dialog_reaches_nothing_behind_it(pages: Callable[..., Page]) -> None:
    page = pages("counting.py")
    shows(page, "#status", "at its start")
    say(page, type="until", time=0.3)
    shows(page, "#time", "0.30 s")
    page.keyboard.press("Control+k")
    page.keyboard.type("maximise the timeline")
    page.keyboard.press("Enter")
    expect(page.locator("[data-maximised=timeline]")).to_be_visible()
    page.keyboard.press("g")
    page.get_by_role("dialog", name="Go to a time").get_by_role("button", name="Cancel").dblclick()  # the timeline lies behind it
    expect(page.get_by_role("dialog")).to_have_count(0)
    drawn(page)
    say(page, type="speed", factor=None)  # is answered after a seek would be
    shows(page, "#time", "0.30 s")


def test_a_double_click_on_a_button_that_shows_something_else_does_not_go_on_there(pages: Callable[..., Page], workbench: Served) -> None:
    page = pages("counting.py", tab="experiments")
    page.get_by_role("button", name="New experiment").dblclick()
    expect(page.get_by_label("Design", exact=True)).to_be_visible()
    page.get_by_role("button", name="Experiments", exact=True).dblclick()
    new = page.get_by_role("button", name="New experiment")
    expect(new).to_be_visible()
    new.press("Enter")  # keys are not meant
    expect(page.get_by_label("Design", exact=True)).to_be_visible()


def test_entries_of_a_list_are_removed_as_fast_as_one_clicks(pages: Callable[..., Page]) -> None:
    page = pages("counting.py", tab="productions")
    shows(page, "#status", "at its start")
    page.click("#cycle")
    for name in ("start_counting", "count_on"):
        page.get_by_role("button", name=f"Breakpoint on {name}").click()
    page.keyboard.press("u")
    stops = page.get_by_role("dialog", name="Run until").locator(".stops li")
    expect(stops).to_have_count(2)
    box = stops.first.get_by_role("button").bounding_box()
    assert box is not None
    for _ in range(2):
        page.mouse.click(box["x"] + box["width"] / 2, box["y"] + box["height"] / 2)
    expect(stops).to_have_count(0)
