"""The list of runs keeps what was chosen in view, and its head is whole."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict
from io import BytesIO
from typing import Any

import pytest
from PIL import Image
from playwright.sync_api import Page, expect

from tests.helpers.page import answers, drawn, open_tab, shows, until
from workbench.recording_index import Summary

Pages = Callable[..., Page]

WHOLE = """(id) => {
  const list = document.querySelector(".runs-list");
  const parts = [list, list.querySelector("thead"), list.querySelector(`[data-run='${id}']`)];
  const [box, head, row] = parts.map((one) => one?.getBoundingClientRect());
  return row !== undefined && row.top >= head.bottom - 1 && row.bottom <= box.top + list.clientHeight + 1;
}"""
"""Whether a whole row is between the head of the list and its end."""

LOWEST = """() => {
  const { bottom } = document.querySelector(".runs-list").getBoundingClientRect();
  return [...document.querySelectorAll("tr[data-run]")].findLast((row) => row.getBoundingClientRect().top < bottom - 3).dataset.run;
}"""
"""Returns the run whose row is cut by the end of the list, or is its last one."""


def listed(page: Page, number: int) -> list[str]:
    """Lists some runs that do not exist, the newest first, after the one that is shown; returns their ids."""
    made = [Summary(id=f"run-{n:02}", named=f"run-{n:02}", model="doorway.py", size=1000, made=2e9 - n, time=1.0) for n in range(number)]
    name = page.evaluate("async () => (await part('store.js')).shownRecording.value")
    own = Summary(id=name, named=name, model="doorway.py", size=1000, made=1.0, time=1.0)
    recordings: list[dict[str, Any]] = [{**asdict(one), "session": None, "label": None} for one in (*made, own)]
    answers(page, "/api/recordings", {"total": number + 1, "recordings": recordings, "warning": None})
    page.evaluate("async () => (await part('runs/list.js')).listRuns()")
    return [one.id for one in (*made, own)]


def in_view(page: Page, name: str) -> None:
    until(page, lambda: page.evaluate(WHOLE, name))


def reloaded(pages: Pages) -> tuple[Page, list[str]]:
    """Returns a low page with many runs after it was reloaded, and their ids; the run that is shown is the last of the list."""
    page = pages("doorway.py", width=853, height=533, tab="runs")
    shows(page, "#status", "at its start")
    ids = listed(page, 40)
    page.reload()
    shows(page, "#status", "at its start")
    in_view(page, ids[-1])
    return page, ids


def test_the_chosen_run_is_in_view_when_it_is_chosen_after_a_reload_and_when_the_list_is_resized(pages: Pages) -> None:
    page, ids = reloaded(pages)
    page.evaluate("document.querySelector('.runs-list').scrollTop = 0")
    expect(page.locator(f"[data-run='{ids[0]}']")).to_be_visible()
    lowest: str = page.evaluate(LOWEST)
    page.locator(f"[data-run='{lowest}'] .when").click(position={"x": 4, "y": 2})
    expect(page.get_by_role("toolbar", name="The chosen run")).to_be_visible()
    in_view(page, lowest)
    page.get_by_role("button", name="Details").click()
    expect(page.get_by_role("table", name="Parameters")).to_be_visible()
    in_view(page, lowest)
    page.set_viewport_size({"width": 853, "height": 490})
    in_view(page, lowest)
    open_tab(page, "About")
    open_tab(page, "Runs")
    in_view(page, lowest)

    # a user who has scrolled away is not taken back
    page.evaluate("document.querySelector('.runs-list').scrollTop = 30 * 44")
    until(page, lambda: not page.evaluate(WHOLE, lowest))
    drawn(page)
    page.set_viewport_size({"width": 853, "height": 533})
    drawn(page)
    assert page.locator(".runs-list").evaluate("(list) => list.scrollTop") == 30 * 44
    page.evaluate("async (id) => { const { chosen } = await part('runs/table.js'); chosen.value = new Set([id]); }", ids[9])
    in_view(page, ids[9])  # of a file that was added


def test_the_list_follows_the_shown_run_while_none_is_chosen(pages: Pages) -> None:
    page, ids = reloaded(pages)
    show = (
        "async (id) => { const { session } = await part('store.js'); session.value = { ...session.value, recording: id, recorded: null }; }"
    )
    page.evaluate(show, ids[5])
    in_view(page, ids[5])
    page.evaluate("document.querySelector('.runs-list').scrollTop = 30 * 44")
    until(page, lambda: not page.evaluate(WHOLE, ids[5]))
    drawn(page)
    page.evaluate(show, ids[9])  # the user has scrolled away
    drawn(page)
    assert page.locator(".runs-list").evaluate("(list) => list.scrollTop") == 30 * 44


@pytest.mark.parametrize("theme", ["light", "dark"])
def test_the_head_of_the_list_is_as_wide_as_the_list(pages: Pages, theme: str) -> None:
    page = pages("doorway.py", width=1280, height=800, theme=theme, tab="runs")
    shows(page, "#status", "at its start")
    listed(page, 2)
    expect(page.locator("tr[data-run='run-01']")).to_be_visible()
    box = page.locator(".runs-list").bounding_box()
    assert box is not None
    width = page.locator(".runs-list").evaluate("(list) => list.clientWidth")
    assert width < box["width"]  # beside it is room for the scroll bar
    drawn(page)
    with Image.open(BytesIO(page.screenshot(clip={**box, "height": 60}))) as picture:
        table, beside = ([picture.getpixel((x, y)) for y in range(60)] for x in (width - 2, int(box["width"]) - 2))
    head = int(page.locator(".runs-list thead").evaluate("(head) => head.offsetHeight"))
    assert len(set(table[:head])) == 2  # its colour, and the line below it
    assert beside[:head] == table[:head]
    assert beside[head:] == table[head:]
