"""The page in a real browser: run, step, the aperture, an error, an endless loop, a second tab."""

from __future__ import annotations

import re
from collections.abc import Callable

import pytest
from playwright.sync_api import Page, Route, expect

from tests.helpers.page import choose, duplicate, open_tab, shows
from tests.helpers.workbench_server import Served

NAME = "async () => (await part('address.js')).page"


def test_run_step_and_the_aperture(page: Page) -> None:
    shows(page, "#time", "0.00 s")
    page.click("#step")
    shows(page, "#time", "0.01 s")
    page.click("#cycle")
    shows(page, "#time", "0.05 s")
    page.click("#back")
    shows(page, "#time", "0.04 s")
    page.locator("#aperture").fill("90")
    shows(page, "#width", "90 cm *A/S 2.00")
    open_tab(page, "Parameters")
    expect(page.get_by_label("width", exact=True)).to_have_value("0.9")
    open_tab(page, "Productions")
    page.get_by_label("Filter the trace").fill("turn")
    page.click("#run")
    shows(page, "#status", "ended")
    expect(page.locator("#events")).not_to_contain_text("turn")  # it is wide enough
    page.click("#restart")
    shows(page, "#time", "0.00 s")
    shows(page, "#width", "50 cm *A/S 1.11")
    page.click("#run")
    shows(page, "#events", "turns")


def test_a_second_tab_and_a_reload_show_the_same(pages: Callable[..., Page], workbench: Served) -> None:
    page = pages("counting.py")
    open_tab(page, "Productions")
    shows(page, "#time", "0.00 s")
    page.click("#cycle")
    shows(page, "#events", "start_counting")
    other = page.context.new_page()
    other.goto(f"{workbench.url}/?model=counting.py")
    open_tab(other, "Productions")
    expect(other.locator("#events")).to_have_text(re.compile("start_counting"))
    other.click("#cycle")
    shows(page, "#events", "count_on")
    page.reload()
    shows(page, "#events", "count_on")
    name = page.evaluate(NAME)
    page.reload()
    assert page.evaluate(NAME) == name
    twin = duplicate(page)
    twin.click("#cycle")
    shows(twin, "#browsers", "^3 pages show this run, you are in control")
    shows(page, "#browsers", "^3 pages show this run, another one is in control")
    assert twin.evaluate(NAME) != page.evaluate(NAME) == name


def test_what_was_chosen_last_is_shown_though_it_is_ready_first(page: Page) -> None:
    shows(page, "#status", "at its start")
    held: list[Route] = []

    def hold(route: Route) -> None:
        if "counting.py" in (route.request.post_data or ""):
            held.append(route)
        else:
            route.continue_()

    page.route("**/api/sessions", hold)
    with page.expect_request(lambda request: request.method == "POST"):
        page.get_by_label("Model", exact=True).select_option("counting.py")
    choose(page, "doorway.py")
    shows(page, "#status", "at its start")
    with page.expect_response(lambda response: response.request.method == "POST"):
        held[0].continue_()
    page.click("#step")
    shows(page, "#time", "0.01 s")
    shows(page, "#width", "50 cm")
    expect(page.get_by_label("Model", exact=True)).to_have_value("doorway.py")


def test_an_error_is_shown_as_text_and_mended(page: Page, workbench: Served) -> None:
    bad = "raise ValueError('<img src=x onerror=alert(1)>')\n"
    (workbench.folder / "bad.py").write_text(bad, encoding="utf-8")
    page.reload()
    choose(page, "bad.py")
    page.on("dialog", lambda dialog: pytest.fail("it was run as HTML"))
    page.click("#run")
    open_tab(page, "Messages")
    shows(page, "#log", re.escape("ValueError: <img src=x onerror=alert(1)>"))
    shows(page, "#log", "bad.py:1")
    (workbench.folder / "bad.py").write_text("print('mended')\n", encoding="utf-8")
    page.click("#restart")
    shows(page, "#status", "at its start")
    page.click("#run")
    open_tab(page, "Productions")
    shows(page, "#events", "mended")


WALKER = """from actr3d.actr import *
from actr3d.simulation import BodyPort, Simulation
from actr3d.world import Floor, Mannequin, Scene

class Walker(ACTR):
    goal = Buffer()
    skin = BodyPort()
    def init():
        goal.set("go")
    def go(goal="go"):
        skin.set("walk_to", 3, 1.5)

def build() -> Simulation:
    return Simulation(Scene(parts=(Floor(), Mannequin(name="walker"))), {"walker": Walker})
"""


@pytest.mark.slow
def test_an_error_of_a_run_leads_to_its_line_and_is_marked_as_past_in_the_next_run(page: Page, workbench: Served) -> None:
    file = workbench.folder / "wrong.py"
    file.write_text(WALKER, encoding="utf-8")
    page.reload()
    choose(page, "wrong.py")
    page.click("#run")
    shows(page, "#status", r"failed: [\s\S]*in production 'go'")
    shows(page, ".toast", r"wrong\.py:11 walker has no actuator 'walk_to'[\s\S]*in production 'go'")
    badge = page.get_by_role("tab", name="Messages").locator(".badge")
    expect(badge).to_have_text("1")
    page.locator(".toast .link").click()
    expect(page.locator(".cm-activeLine")).to_have_text('        skin.set("walk_to", 3, 1.5)')
    shows(page, ".problems", "1 error.*line 11walker has no actuator")
    open_tab(page, "Console")
    rows = page.locator(".console .error")
    expect(rows.first).to_contain_text("error wrong.py:11 walker has no actuator 'walk_to'")
    expect(rows.last).to_have_text("  requested by 'walker.skin' in production 'go'")  # the file is named once
    assert page.locator(".console .lines").evaluate("box => box.scrollWidth <= box.clientWidth")
    shows(page, ".console .tools", "^1 line")
    file.write_text(WALKER.replace('"walk_to", 3, 1.5', '"walk", 1'), encoding="utf-8")
    page.click("#restart")
    expect(page.locator(".toast")).to_have_count(0)
    expect(badge).to_have_count(0)
    shows(page, "#status", "at its start")
    open_tab(page, "Messages")
    expect(page.locator("#log li").first).to_have_text("Earlier runs")
    expect(page.locator("#log li.earlier")).to_contain_text("walker has no actuator 'walk_to'")


@pytest.mark.slow
def test_an_endless_loop_is_stopped(page: Page, workbench: Served) -> None:
    (workbench.folder / "loop.py").write_text("x = 1\nwhile True:\n    x += 1\n", encoding="utf-8")
    page.reload()
    choose(page, "loop.py")
    shows(page, "#status", "at its start")
    page.click("#run")
    shows(page, "#status", "busy at line [23]")
    page.click("#stop")
    shows(page, "#status", "stopped")
    open_tab(page, "Messages")
    shows(page, "#log", r"stopped while it was busy at loop\.py:[23]")


def test_tabs_stay_where_they_are_whichever_is_open(page: Page) -> None:
    shows(page, "#time", "t =")

    def places() -> list[float]:
        boxes = [tab.bounding_box() for tab in page.get_by_role("tab").all()]
        return [box["x"] for box in boxes if box is not None]

    before = places()
    assert len(before) == 12
    for title in ("Memory", "Parameters", "Messages"):
        open_tab(page, title)
        expect(page.get_by_role("tab", name=title)).to_have_attribute("aria-selected", "true")
        assert places() == before


def test_a_saved_file_keeps_the_letters_of_its_name(blank: Page) -> None:
    with blank.expect_download() as download:
        blank.evaluate("async () => (await part('parts/picture.js')).saveFile('猫/größe <1>.csv', new Blob(['1']))")
    assert download.value.suggested_filename == "猫_größe_1_.csv"
