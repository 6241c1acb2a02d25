"""What the page says while it cannot show a run yet, and when it is at fault itself."""

from __future__ import annotations

import re
from collections.abc import Callable
from typing import Any

import pytest
from playwright.sync_api import Page, Route, expect

from tests.browser.test_runs_panel import recorded
from tests.helpers.page import answers, open_tab, shows
from tests.helpers.workbench_server import Served


def test_it_says_that_the_workbench_is_starting(pages: Callable[..., Page]) -> None:
    page = pages("doorway.py")
    shows(page, "#status", "paused")
    held: list[Route] = []

    def hold(route: Route) -> None:
        if route.request.method == "POST":
            held.append(route)
        else:
            route.fulfill(json={"sessions": [], "ready": False})

    page.route("**/api/sessions", hold)
    page.get_by_label("Model", exact=True).select_option("counting.py")
    shows(page, "#status", "the workbench is starting")
    expect(page.locator("#scene")).to_contain_text("the camera's code is compiled")
    expect(page.locator("#scene progress")).to_be_visible()
    held[0].continue_()
    shows(page, "#status", "paused")
    expect(page.locator("#scene progress")).to_have_count(0)


NO_MODELS: dict[str, Any] = {"folder": "/empty", "models": [], "manual": False, "no_manual": None}


@pytest.mark.slow
def test_a_recording_is_shown_though_the_folder_has_no_models(pages: Callable[..., Page], workbench: Served) -> None:
    name = recorded(workbench, "counting.py")
    page = pages("doorway.py", refusals=True)
    shows(page, "#status", "paused")
    answers(page, "/api/models", NO_MODELS)
    page.goto(f"{workbench.url}/?run={name}")
    expect(page.locator(".recording-banner")).to_contain_text(name)
    page.goto(f"{workbench.url}/?run=none")
    shows(page, ".toast", "The recording «none» cannot be opened: there is no such recording")
    expect(page.locator("#scene")).to_contain_text("There is no model in the folder yet")


def test_what_the_address_names_is_shown_as_soon_as_the_workbench_answers(pages: Callable[..., Page]) -> None:
    page = pages("doorway.py")
    shows(page, "#status", "paused")
    page.add_init_script(
        """const { fetch } = window;
        window.fetch = (path, ...more) => {
          if (path !== "/api/models" || window.isLost) return fetch(path, ...more);
          window.isLost = true;
          return Promise.reject(new TypeError("there is no network"));
        }"""
    )
    page.reload()
    shows(page, "#status", "paused")
    assert page.evaluate("() => window.isLost")


def test_a_folder_without_models_is_said_to_have_none(pages: Callable[..., Page]) -> None:
    page = pages("doorway.py")
    shows(page, "#status", "paused")
    answers(page, "/api/models", NO_MODELS)
    page.reload()
    expect(page.locator("#connection")).to_have_text("connected")
    expect(page.locator("#scene")).to_contain_text(
        "There is no model in the folder yet: make one in the tab Editor, or put a Python file there."
    )
    answers(page, "/api/models", {"error": "the folder cannot be read"}, status=422)
    page.reload()
    expect(page.locator("#connection")).to_have_text("connected")
    shows(page, ".toast", "the folder cannot be read")
    expect(page.locator("#scene")).to_contain_text("No model is shown.")


OPEN_BY_COMMAND = """async (title) => {
  const { permanent, run } = await part("commands.js");
  run(permanent().find(({ text }) => text === `Open ${title}`));
}"""


def test_each_panel_has_a_title_and_is_opened_and_drawn_without_a_run(pages: Callable[..., Page]) -> None:
    page = pages("doorway.py")
    answers(page, "/api/models", NO_MODELS)
    page.reload()
    expect(page.locator("#scene")).to_contain_text("There is no model in the folder yet")
    panels: list[dict[str, str]] = page.evaluate("async () => (await part('panels.js')).PANELS.map(({ id, title }) => ({ id, title }))")
    assert panels
    for panel in panels:
        tab, drawn = page.locator(f"#tab-{panel['id']}"), page.locator(f"#panel-{panel['id']}")
        expect(tab).to_have_text(re.compile(rf"^{re.escape(panel['title'])}"))
        assert panel["title"].strip()
        page.evaluate(OPEN_BY_COMMAND, panel["title"])
        expect(tab).to_have_attribute("aria-selected", "true")
        expect(drawn).to_have_text(re.compile(r"\S"))
        expect(drawn).not_to_have_text(re.compile("undefined|NaN"))


def test_its_own_faults_do_not_bury_other_messages(page: Page) -> None:
    shows(page, "#status", "paused")
    open_tab(page, "Messages")
    page.evaluate("for (let n = 0; n < 50; n += 1) dispatchEvent(new ErrorEvent('error', { message: 'the same' }))")
    expect(page.get_by_text("The page has a fault: the same")).to_have_count(1)
    page.evaluate("for (let n = 0; n < 50; n += 1) dispatchEvent(new ErrorEvent('error', { message: `another ${n}` }))")
    expect(page.get_by_text(re.compile("The page has a fault"))).to_have_count(10)
    expect(page.get_by_text("There may be more")).to_have_count(1)


def test_all_keys_are_named(page: Page) -> None:
    shows(page, "#status", "paused")
    page.keyboard.press("?")
    for group in ("Run", "Timeline", "Panels", "Editor"):
        expect(page.get_by_role("table", name=group, exact=True)).to_be_visible()
    keys = page.get_by_role("dialog").locator("kbd")
    expect(keys.filter(has_text="+")).to_have_text("+")
    assert all(text.strip() for text in keys.all_inner_texts())


def test_a_run_that_ends_after_a_time_without_events_says_when_the_last_one_was(pages: Callable[..., Page]) -> None:
    page = pages("counting.py")
    shows(page, "#status", "paused")
    page.click("#run")
    shows(page, "#time", r"3\.\d\d s")  # the memory knows for 3 s what was retrieved
    shows(page, "#status", r"^ended: the program is over; the last event was at 0\.\d+ s$")


def test_the_time_of_the_present_run_is_that_of_the_moment(page: Page) -> None:
    shows(page, "#status", "paused")
    open_tab(page, "Runs")
    row = page.locator("tr.present .time")
    expect(row).to_contain_text("0.00 s")
    page.evaluate("document.activeElement.blur()")
    page.click("#step")
    shows(page, "#time", "0.01 s")
    expect(row).to_contain_text("0.01 s")
    page.click("#back")
    shows(page, "#time", "0.00 s")
    expect(row).to_contain_text("0.01 s")


def test_a_file_whose_name_cannot_be_used_is_listed_with_the_reason(pages: Callable[..., Page], workbench: Served) -> None:
    odd = workbench.folder / "at 12:30.py"
    odd.write_text('"""Odd."""\n', encoding="utf-8")
    try:
        page = pages("doorway.py", tab="editor")
        shows(page, "#status", "paused")
        for choice in ("Model", "File"):
            entry = page.get_by_label(choice, exact=True).get_by_role("option", name="at 12:30.py")
            expect(entry).to_have_text("at 12:30.py: must have no colon")
            expect(entry).to_be_disabled()
        page.keyboard.press("Control+k")
        page.keyboard.insert_text("at 12:30")
        expect(page.get_by_role("dialog").get_by_role("option").first).to_contain_text("Model: at 12:30.py")
        page.keyboard.press("Enter")
        shows(page, ".palette-refusal", r"«Model: at 12:30\.py» is not possible now\. The path of a model file: must have no colon\.")
    finally:
        odd.unlink()
