"""The page at usual sizes: nothing is cut, and things of one kind have one size and one edge."""

from __future__ import annotations

from collections.abc import Callable
from io import BytesIO
from typing import Any

import pytest
from PIL import Image
from playwright.sync_api import Locator, Page, expect

from tests.browser.test_runs_panel import recorded, row
from tests.helpers.page import drawn, say, shows, until
from tests.helpers.workbench_server import Served

Pages = Callable[..., Page]

TEXT_LEFT = """(element) => {
  const range = document.createRange();
  range.selectNodeContents(element);
  return range.getBoundingClientRect().left;
}"""

MIDDLE = "(element) => { const { top, bottom } = element.getBoundingClientRect(); return (top + bottom) / 2; }"


def edges(elements: Locator, name: str) -> set[float]:
    """Returns the values that an edge or size of some elements has, rounded to half a pixel."""
    found: list[float] = elements.evaluate_all("(all, name) => all.map((one) => one.getBoundingClientRect()[name])", name)
    assert found
    return {round(2 * value) / 2 for value in found}


def opened_menu(page: Page, name: str) -> dict[str, Any]:
    """Returns the size of the letters and of the entries of a menu."""
    page.get_by_role("button", name=name, exact=True).click()
    entries = page.get_by_role("group", name=name, exact=True).get_by_role("button")
    expect(entries.first).to_be_visible()
    looks: dict[str, Any] = entries.last.evaluate("(one) => ({ font: getComputedStyle(one).fontSize, height: one.offsetHeight })")
    page.keyboard.press("Escape")
    return looks


def test_all_rows_of_a_model_with_a_body_are_in_view_at_the_default_height(pages: Pages) -> None:
    page = pages("doorway.py", width=1280, height=800)
    shows(page, "#status", "at its start")
    say(page, type="until", time=0.2)
    shows(page, "#time", r"0\.20 s")
    expect(page.get_by_role("button", name="Productions", exact=True)).to_be_visible()
    drawn(page)
    rows = page.locator(".timeline-rows")
    assert rows.evaluate("(one) => one.scrollHeight - one.clientHeight") == 0


@pytest.mark.parametrize("theme", ["light", "dark"])
def test_the_axis_is_as_wide_as_the_timeline_and_without_a_scroll_bar_if_all_rows_are_in_view(pages: Pages, theme: str) -> None:
    page = pages("doorway.py", width=1280, height=1000, theme=theme)
    shows(page, "#status", "at its start")
    rows = page.locator(".timeline-rows")
    page.evaluate("async () => void ((await part('layout.js')).timelineHeight.value = 500)")
    until(page, lambda: rows.evaluate("(one) => one.clientHeight > 300 && one.scrollHeight === one.clientHeight"))
    drawn(page)
    box = rows.bounding_box()
    assert box is not None
    width = int(rows.evaluate("(one) => one.clientWidth"))
    assert width < box["width"]  # beside the rows is room for a scroll bar
    with Image.open(BytesIO(page.screenshot(clip=box))) as picture:
        within = [picture.getpixel((width - 2, y)) for y in range(20)]
        beside = [picture.getpixel((int(box["width"]) - 6, y)) for y in range(picture.height)]
    assert beside[:20] == within
    assert len(set(within)) == 2  # its colour, and the line below it
    assert len(set(beside[20:])) == 1


def test_the_menus_of_all_parts_of_the_page_have_entries_of_one_size(page: Page) -> None:
    shows(page, "#status", "at its start")
    looks = [opened_menu(page, f"Arrange: {part}") for part in ("3D view", "Panels", "Timeline")]
    assert looks == looks[:1] * 3


def test_the_time_begins_where_the_bar_does_and_stays_there_as_it_becomes_longer(pages: Pages) -> None:
    page = pages("counting.py", width=853, height=533)
    time = page.locator("#time")
    shows(page, "#time", r"t = 0\.00 s")
    begin = time.evaluate(TEXT_LEFT)
    assert begin - page.locator(".bar h1").evaluate(TEXT_LEFT) <= 5  # the padding of a button
    page.evaluate("async () => { const { state } = await part('store.js'); state.value = { ...state.value, time: 12.34 }; }")
    shows(page, "#time", r"t = 12\.34 s")
    assert time.evaluate(TEXT_LEFT) == begin


def test_all_commands_of_the_palette_have_one_height(page: Page) -> None:
    shows(page, "#status", "at its start")
    page.keyboard.press("Control+k")
    options = page.locator("dialog.palette").get_by_role("option")
    expect(options.first).to_be_visible()
    assert options.locator("kbd").count() < options.count()
    assert len(edges(options, "height")) == 1


@pytest.mark.parametrize("width", [1280, 853])
def test_no_name_in_the_choice_of_curves_is_cut(width: int, pages: Pages) -> None:
    page = pages("doorway.py", width=width)
    page.get_by_role("button", name="Curves …").click()
    names = page.locator(".curve-choice label span")
    expect(names.filter(has_text="walker_right_upper_arm_pitch speed")).to_be_visible()
    assert names.evaluate_all("(all) => all.filter((one) => one.scrollWidth > one.clientWidth).map((one) => one.textContent)") == []


@pytest.mark.parametrize("button", ["Help", "Curves …"])
def test_a_dialog_that_scrolls_has_a_shade_where_there_is_more(button: str, pages: Pages) -> None:
    page = pages("doorway.py", width=853, height=533)
    page.get_by_role("button", name=button).click()
    more = page.get_by_role("dialog").locator(":scope > div")
    until(page, lambda: more.evaluate("(one) => one.scrollHeight > one.clientHeight"))
    assert "gradient" in more.evaluate("(one) => getComputedStyle(one).backgroundImage")


def test_fields_and_sliders_of_parameters_are_in_columns_though_their_units_differ(pages: Pages) -> None:
    page = pages("doorway.py", width=853, height=533, tab="parameters")
    fields, sliders = page.locator("input[id^=parameter-]:not(#parameter-seed-of-run)"), page.get_by_role("slider", name="slider of")
    expect(sliders).to_have_count(2)
    assert [len(edges(of, name)) for of in (fields, sliders) for name in ("left", "right")] == [1, 1, 1, 1]


def test_headings_of_a_comparison_are_level_with_what_is_beside_them(pages: Pages, workbench: Served) -> None:
    names = [recorded(workbench, "counting.py") for _ in range(2)]
    page = pages("counting.py", tab="runs")
    for name in names:
        row(page, name).get_by_role("checkbox").check()
    page.get_by_role("button", name="Compare", exact=True).click()
    header = page.locator("dialog.compare section header").first
    expect(header.locator("select")).to_be_visible()
    heading, choice = (header.locator(kind).evaluate(MIDDLE) for kind in ("h3", "select"))
    assert abs(heading - choice) <= 1
