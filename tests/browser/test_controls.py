"""The controls of the page: until when it runs, parameters, the eye, keys, themes, sizes."""

from __future__ import annotations

import json
import re
import shutil
from collections.abc import Callable

import pytest
from playwright.sync_api import Page, expect

from tests.helpers.page import becomes_true, choose, drawn, open_tab, say, shows, until
from tests.helpers.workbench_server import MODELS, Served

ENDED = """async () => {
  const { alive, session, state } = await part("store.js");
  return alive.value && state.value.status === "ended" ? session.value.run : null;
}"""
"""Tells which run has ended; null where that is shown goes on."""


def test_it_goes_to_a_time_that_is_typed(pages: Callable[..., Page]) -> None:
    page = pages("counting.py")
    shows(page, "#status", "at its start")
    say(page, type="until", time=0.3)
    shows(page, "#time", "0.30 s")
    page.click("#status")
    page.keyboard.press("g")
    asked = page.get_by_role("dialog", name="Go to a time")
    field = asked.get_by_label("Time, from 0 to 0.30 s")
    expect(field).to_have_value("0.30")
    for text, problem in (("soon", "must be a time, such as 1.5 or 1:15:12.3 (got 'soon')"), ("7", "has only reached 0.30 s")):
        field.fill(text)
        field.press("Enter")
        expect(asked.get_by_role("alert")).to_contain_text(problem)
    field.fill("1:15:12.3")
    field.press("Enter")
    expect(asked.get_by_role("alert")).to_contain_text("goes on to a later time (got 1:15:12.3)")
    field.fill("0.123")
    field.press("Enter")
    expect(asked).to_have_count(0)
    shows(page, "#time", "0.12 s")
    page.click("#time")
    field.fill("0.3")
    asked.get_by_role("button", name="Go there").click()
    shows(page, "#time", "0.30 s")


READ = """async (texts) => {
  const { read } = await part("parameters/values.js");
  const bounds = { above: null, least: null, below: null, most: null };
  return texts.map(([takes, text]) => read({ takes, optional: false, ...bounds }, text));
}"""


def test_a_comma_is_no_decimal_point(blank: Page) -> None:
    hint = "must be a {}; the decimal point is '.', and nothing separates thousands"
    assert blank.evaluate(READ, [["whole number", "1,000"], ["number", "0,5"], ["number", "0.5"], ["number", "x"]]) == [
        {"problem": hint.format("whole number")},
        {"problem": hint.format("number")},
        {"value": 0.5},
        {"problem": "must be a number"},
    ]


def test_a_number_that_is_too_large_is_said_to_be_so(blank: Page) -> None:
    written = [["number", "1e400"], ["whole number", " -1e999"], ["number", "Infinity"], ["number", "1e308"]]
    assert blank.evaluate(READ, written) == [
        {"problem": "the number is too large"},
        {"problem": "the number is too large"},
        {"problem": "must be a number"},
        {"value": 1e308},
    ]


LATE = """async () => {
  const { state } = await part("store.js");
  document.querySelector("#scene iframe").contentWindow.scene = { drawnTime: () => 3601, choose() {} };
  state.value = { ...state.value, status: "running", time: 3700, furthest: 3700, measured: 1 };
}"""


def test_a_3d_view_that_lags_shows_its_time_also_from_an_hour_on(page: Page) -> None:
    shows(page, "#status", "at its start")
    page.evaluate(LATE)
    expect(page.locator(".scene-lag")).to_have_text("3D view of 1:00:01.0")


UNNAMED = """() => [...document.querySelectorAll("dialog [aria-labelledby]")].flatMap((one) =>
  one.getAttribute("aria-labelledby").split(" ").filter((id) => !document.getElementById(id)))"""


def test_each_table_of_keys_in_the_help_is_called_as_its_heading(page: Page) -> None:
    shows(page, "#status", "at its start")
    page.keyboard.press("?")
    expect(page.get_by_role("dialog").get_by_role("table", name="3D view")).to_be_visible()
    assert page.evaluate(UNNAMED) == []


@pytest.mark.slow
def test_it_runs_until_what_is_asked(pages: Callable[..., Page]) -> None:
    page = pages("doorway.py")
    shows(page, "#time", "0.00 s")
    asked, problem = page.get_by_role("dialog"), page.get_by_role("alert")
    page.click("#status")
    page.keyboard.press("u")
    page.keyboard.type("soon")
    page.keyboard.press("Enter")
    expect(problem).to_have_text("enter a time, such as 1.5 or 1:15:12.3")
    production = page.get_by_label("Production", exact=True)
    production.fill("trun")
    expect(problem).to_have_count(0)
    production.press("Enter")
    expect(problem).to_have_text("no production 'trun'; did you mean 'turn'?")
    buffer = page.get_by_label("Buffer", exact=True)
    buffer.fill("goal")
    page.get_by_label("Pattern").fill("task:")
    page.get_by_role("button", name="Run until then").click()
    expect(problem).to_have_text("no value for slot 'task' in pattern 'task:'")
    expect(page.get_by_label("Pattern")).to_have_attribute("aria-invalid", "true")
    expect(buffer).to_have_attribute("aria-invalid", "false")
    buffer.fill("gaol")
    page.get_by_role("button", name="Run until then").click()
    expect(problem).to_have_text("no buffer 'gaol'; did you mean 'goal'?")
    expect(page.get_by_label("Pattern")).to_have_attribute("aria-invalid", "false")
    expect(buffer).to_have_attribute("aria-invalid", "true")
    offered = buffer.evaluate("(input) => [...input.list.options].map(({ value }) => value)")
    assert offered == ["felt", "goal", "seen"]
    shows(page, "#time", "0.00 s")  # nothing has run
    production.fill("look")
    production.press("Enter")
    expect(asked).to_have_count(0)
    shows(page, "#status", "look fired")
    page.get_by_role("button", name="Run until").click()
    expect(production).to_be_focused()
    page.get_by_label("Time [s]").fill("0.01")
    page.get_by_role("button", name="Run until then").click()
    expect(problem).to_have_text(re.compile("a click on the timeline goes back"))
    page.get_by_label("Time [s]").fill("0.5")
    page.keyboard.press("Tab")
    page.get_by_role("button", name="Run until then").click()
    shows(page, "#status", "at 0.5 s")
    shows(page, "#time", "0.50 s")
    page.locator("#aperture").fill("100")
    page.get_by_role("button", name="Run until").click()
    page.get_by_label("Body", exact=True).fill("walker")
    page.get_by_label("Body", exact=True).press("Enter")
    shows(page, "#status", re.escape("ended: the model called stop(); walker touched nothing more"))


@pytest.mark.slow
def test_a_breakpoint_that_an_edit_has_lost_is_kept_and_said_to_be(pages: Callable[..., Page], workbench: Served) -> None:
    source = (workbench.folder / "doorway.py").read_text(encoding="utf-8")
    (workbench.folder / "edited.py").write_text(source, encoding="utf-8")
    page = pages("edited.py")
    shows(page, "#status", "at its start")
    session = workbench.get("/api/sessions").json()["sessions"][0]["id"]
    said = workbench.post(f"/api/sessions/{session}/command", {"command": {"type": "breakpoints", "productions": ["turn"]}})
    assert said.json()["error"] is None
    (workbench.folder / "edited.py").write_text(source.replace("def turn(", "def turn_now("), encoding="utf-8")
    page.click("#restart")
    open_tab(page, "Messages")
    expect(page.get_by_text("the breakpoint on turn is kept, but there is no production 'turn'; did you mean 'turn_now'?")).to_be_visible()
    page.get_by_role("button", name="Run until").click()
    expect(page.locator(".stops li")).to_have_text(re.compile("turn.*not in this run"))
    page.get_by_role("button", name="Remove the breakpoint on turn").click()
    expect(page.locator(".stops")).to_have_count(0)


@pytest.mark.slow
def test_the_speed_and_breakpoints_chosen_without_a_run_are_shown_and_are_those_of_the_next_run(pages: Callable[..., Page]) -> None:
    page = pages("doorway.py", paced=True, tab="productions")
    shows(page, "#status", "at its start")
    speed = page.get_by_label("Speed", exact=True)
    expect(speed.locator("option:checked")).to_have_text("1 x")
    page.click("#stop")
    shows(page, "#status", "stopped")
    speed.select_option("5 x")
    page.keyboard.press("Control+k")
    page.get_by_role("combobox", name="Search").fill("Breakpoint on turn")
    page.keyboard.press("Enter")
    page.click("#run")
    shows(page, "#status", "breakpoint: turn fired")
    expect(speed.locator("option:checked")).to_have_text("5 x")
    expect(page.locator(".toast")).to_have_count(0)


def test_a_parameter_is_in_force_at_once_or_with_the_next_run(pages: Callable[..., Page]) -> None:
    page = pages("doorway.py")
    open_tab(page, "Parameters")
    speed = page.locator("#parameter-speed")
    speed.fill("0")
    expect(page.get_by_role("alert")).to_have_text(re.compile("must be more than 0, at most 3"))
    expect(page.get_by_role("button", name="Restart with these")).to_be_disabled()
    speed.fill("1.1")
    expect(page.locator(".note")).to_have_text(re.compile("One value is not in effect yet"))
    page.get_by_role("button", name="Restart with these").click()
    expect(page.locator(".note")).to_have_count(0)
    expect(speed).to_have_value("1.1")
    width = page.locator("#parameter-width")
    width.fill("0.8")
    width.press("Tab")
    shows(page, "#width", "80 cm")
    expect(page.locator(".note")).to_have_count(0)
    slider = page.locator(".parameter", has=width).locator("input[type=range]")
    expect(slider).to_have_value("0.8")
    slider.fill("0.6")
    shows(page, "#width", "60 cm")
    expect(width).to_have_value("0.6")
    expect(page.locator(".note")).to_have_count(0)
    page.get_by_label("seed", exact=True).fill("7")
    page.get_by_role("button", name="Restart with these").click()
    expect(page.get_by_text("seed 7", exact=True)).to_be_visible()
    shows(page, "#status", "at its start")
    width.fill("0.7")
    width.press("Control+Enter")
    shows(page, "#status", "ended")
    shows(page, "#width", "70 cm")
    width.fill("0.8")
    width.press("Tab")  # the run is over: the value is for the next one
    expect(page.locator(".note")).to_have_text(re.compile("One value is not in effect yet"))
    expect(page.locator(".parameter", has=width).get_by_text("next run")).to_be_visible()
    expect(page.locator(".toast")).to_have_count(0)
    page.get_by_label("seed", exact=True).fill("8")
    page.get_by_role("button", name="Run with these").click()
    expect(page.get_by_text("seed 8", exact=True)).to_be_visible()
    shows(page, "#width", "80 cm")
    shows(page, "#status", "ended")


@pytest.mark.slow
def test_a_parameter_that_is_emptied_during_a_run_stays_empty(pages: Callable[..., Page], workbench: Served) -> None:
    shutil.copy(MODELS / "aperture_passage.py", workbench.folder)
    page = pages("aperture_passage.py", tab="parameters")
    speed = page.get_by_label("speed", exact=True)
    speed.fill("2")
    page.get_by_role("button", name="Restart with these").click()
    becomes_true(page, "async () => (await part('store.js')).session.value.settings.speed === 2")
    shows(page, "#status", "at its start")
    speed.fill("")
    speed.press("Enter")
    becomes_true(page, "async () => (await part('store.js')).state.value?.parameters.speed === null")
    expect(speed).to_have_value("")
    page.get_by_role("button", name="Restart with these").click()
    becomes_true(page, "async () => !('speed' in (await part('store.js')).session.value.settings)")
    (workbench.folder / "aperture_passage.py").unlink()


def test_the_eye_is_shown_small_and_large(pages: Callable[..., Page]) -> None:
    page = pages("doorway.py")
    inset = page.get_by_role("complementary", name="Retina")
    expect(inset).to_have_text(re.compile(r"\d+ objects? in view"))
    page.get_by_label("Camera", exact=True).select_option("eye")  # the whole view is what the eye sees
    expect(inset).to_have_count(0)
    page.get_by_role("button", name="Eye", exact=True).click()
    expect(inset).to_be_visible()
    page.get_by_label("Camera", exact=True).select_option("follow")
    inset.get_by_role("button", name="Larger").click()
    expect(inset).to_have_count(0)
    labels = page.locator(".eye tbody tr td:first-child")
    expect(labels).to_have_text(["1", "2"])
    page.context.grant_permissions(["clipboard-read", "clipboard-write"])
    page.get_by_role("button", name="Copy as JSON").click()
    expect(page.locator(".copy").get_by_role("status")).to_have_text("Copied")
    until(page, lambda: page.evaluate("navigator.clipboard.readText()").startswith("{"))
    view = json.loads(page.evaluate("navigator.clipboard.readText()"))
    assert {extent[1] for extent in view["extents"]} == {1, 2}
    page.get_by_role("button", name="Edges").click()
    expect(page.locator(".eye tbody tr")).to_have_count(len(view["extents"]))
    head = page.get_by_role("table", name="Edges").get_by_role("columnheader")
    expect(head).to_have_text([f"{field['name']}{' [' + field['unit'] + ']' if field['unit'] else ''}" for field in view["fields"]])
    expect(head.nth(10)).to_have_attribute("title", "nearest distance: the distance from the eye to that nearest point [m]")
    page.get_by_text("What the columns mean").click()
    expect(page.locator(".legend dl")).to_contain_text("a1 [°]left angle: the angle between the line of sight")
    box = page.locator(".eye canvas").bounding_box()
    assert box is not None
    row, _, _, left, right, *_ = view["extents"][0]
    page.mouse.move(box["x"] + (left + right) / 2 * box["width"], box["y"] + (row + 0.5) / view["rows"] * box["height"])
    expect(page.locator(".retina output")).to_have_text(re.compile(rf"label {view['extents'][0][1]} · row {row} · .* m to .* m"))


@pytest.mark.slow
def test_an_eye_with_nothing_in_view_says_so_and_nothing_is_about_to_fire_in_a_run_that_is_over(
    pages: Callable[..., Page], workbench: Served
) -> None:
    source = (workbench.folder / "doorway.py").read_text(encoding="utf-8")
    assert '        goal.set("done")\n' in source  # without which the last production matches once more
    (workbench.folder / "over.py").write_text(source.replace('        goal.set("done")\n', ""), encoding="utf-8")
    page = pages("over.py")
    shows(page, "#status", "at its start")
    assert page.locator("#aperture").get_attribute("max") == "300"  # as its parameter says
    page.locator("#aperture").fill("80")
    page.click("#run")
    shows(page, "#status", "ended")
    open_tab(page, "Eye")
    expect(page.locator(".eye .retina-nothing")).to_have_text("Nothing is in view of this eye now.")
    open_tab(page, "Buffers")
    expect(page.locator(".agent-parts [data-path='walker'] .doing")).to_have_text(re.compile("stop_behind was chosen as the run ended"))
    open_tab(page, "Productions")
    expect(page.locator("#why-text")).to_contain_text("stop_behind: matches, and was chosen as the run ended")


def test_keys_do_what_the_buttons_do_and_a_question_mark_shows_them(pages: Callable[..., Page]) -> None:
    page = pages("counting.py")
    shows(page, "#time", "0.00 s")
    page.keyboard.press("ArrowRight")
    shows(page, "#time", "0.01 s")
    page.keyboard.press("ArrowLeft")
    shows(page, "#time", "0.00 s")
    page.keyboard.press("c")
    shows(page, "#status", "fired")
    page.keyboard.press("?")
    expect(page.get_by_role("dialog")).to_contain_text("Step until the next production fires")
    page.keyboard.press("Space")
    page.keyboard.press("Escape")
    expect(page.get_by_role("dialog")).to_have_count(0)
    page.keyboard.press("Space")
    shows(page, "#status", "ended")
    expect(page.locator("#run")).to_have_text("Run again")
    first = page.evaluate(ENDED)
    page.keyboard.press("Space")
    until(page, lambda: page.evaluate(ENDED) not in (None, first))
    second = page.evaluate(ENDED)
    page.locator("#timeline").press("Space")
    until(page, lambda: page.evaluate(ENDED) not in (None, first, second))
    page.keyboard.press("Home")
    shows(page, "#time", "0.00 s")
    page.keyboard.press("End")
    shows(page, "#status", "ended")
    page.keyboard.press("z")
    expect(page.get_by_role("button", name="Fit")).to_have_attribute("aria-pressed", "false")
    page.keyboard.press("f")
    expect(page.get_by_role("button", name="Fit")).to_have_attribute("aria-pressed", "true")
    page.keyboard.press("4")
    expect(page.get_by_role("tab", name="Memory")).to_have_attribute("aria-selected", "true")
    page.keyboard.press("t")
    expect(page.get_by_role("button", name="Theme: light")).to_be_visible()
    page.get_by_label("Search the memory").focus()
    page.keyboard.press("t")  # which is written
    expect(page.get_by_role("button", name="Theme: light")).to_be_visible()


@pytest.mark.slow
def test_a_zoom_is_kept_for_the_next_run_of_a_model_and_another_model_is_shown_as_a_whole(pages: Callable[..., Page]) -> None:
    page = pages("counting.py")
    shows(page, "#status", "at its start")
    fit = page.get_by_role("button", name="Fit")
    page.keyboard.press("Space")
    shows(page, "#status", "ended")
    page.keyboard.press("z")
    expect(fit).to_have_attribute("aria-pressed", "false")
    page.keyboard.press("r")
    shows(page, "#status", "at its start")
    expect(fit).to_have_attribute("aria-pressed", "false")
    choose(page, "doorway.py")
    expect(fit).to_have_attribute("aria-pressed", "true")


RUN = """async () => {
  const { alive, session } = await part("store.js");
  return alive.value ? session.value.run : null;
}"""
"""Tells which run is shown; null until it has said where it stands."""


@pytest.mark.slow
def test_after_a_click_the_keys_belong_to_the_page_and_after_a_key_to_what_has_the_focus(pages: Callable[..., Page]) -> None:
    page = pages("doorway.py")
    shows(page, "#status", "at its start")
    console, about = (page.get_by_role("tab", name=name) for name in ("Console", "About"))
    console.click()
    page.keyboard.press("Space")
    shows(page, "#status", "ended")
    console.click()
    page.keyboard.press("Home")
    shows(page, "#time", "0.00 s")
    expect(console).to_have_attribute("aria-selected", "true")
    console.press("Home")  # it is focused without the pointer, as by Tab
    expect(about).to_have_attribute("aria-selected", "true")
    before = page.evaluate(RUN)
    page.click("#restart")
    until(page, lambda: page.evaluate(RUN) not in (None, before) and page.locator("#status").inner_text() == "paused: at its start")
    run = page.evaluate(RUN)
    page.keyboard.press("Space")
    shows(page, "#status", "ended")
    assert page.evaluate(RUN) == run  # it has run, and was not started again
    page.get_by_role("button", name="Help").click()
    expect(page.get_by_role("dialog")).to_have_count(1)
    page.keyboard.press("Escape")
    expect(page.get_by_role("dialog")).to_have_count(0)
    page.keyboard.press("Space")  # not Help again, which has the focus back
    until(page, lambda: page.evaluate(ENDED) not in (None, run))
    page.get_by_role("button", name="Help").focus()
    page.keyboard.press("Shift+Tab")
    page.keyboard.press("Tab")
    page.keyboard.press("Space")
    expect(page.get_by_role("dialog")).to_contain_text("Manual of ACT-R 3D")
    page.keyboard.press("Escape")
    before = page.evaluate(RUN)
    page.click("#restart")
    until(page, lambda: page.evaluate(RUN) not in (None, before) and page.locator("#status").inner_text() == "paused: at its start")
    page.locator("#aperture").click()
    page.keyboard.press("Home")  # is the slider's own key
    expect(page.locator("#aperture")).to_have_value(page.locator("#aperture").get_attribute("min") or "")


@pytest.mark.slow
def test_sizes_theme_and_tab_are_remembered(pages: Callable[..., Page]) -> None:
    page = pages("doorway.py")
    shows(page, "#status", "at its start")
    bar = page.get_by_role("separator", name="Width of the panels")
    before = int(bar.get_attribute("aria-valuenow") or 0)
    bar.focus()
    page.keyboard.press("ArrowRight")
    page.keyboard.press("ArrowRight")
    drawn(page)
    after = int(bar.get_attribute("aria-valuenow") or 0)
    assert after < before
    open_tab(page, "Experiments")
    for key in ("Shift+Tab", "Tab", "ArrowRight"):
        page.keyboard.press(key)
    expect(page.get_by_role("tab", name="Console")).to_have_attribute("aria-selected", "true")
    page.get_by_role("button", name="Theme: system").click()
    page.get_by_role("button", name="Theme: light").click()
    expect(page.locator("html")).to_have_attribute("data-theme", "dark")
    page.reload()
    expect(page.locator("html")).to_have_attribute("data-theme", "dark")
    expect(bar).to_have_attribute("aria-valuenow", str(after))
    expect(page.get_by_role("tab", name="Console")).to_have_attribute("aria-selected", "true")
    choose(page, "counting.py")
    expect(bar).to_have_count(0)  # a model without a body leaves the room of the scene to the panels
    choose(page, "doorway.py")
    expect(bar).to_have_attribute("aria-valuenow", str(after))


@pytest.mark.slow
def test_what_was_not_set_is_not_remembered_and_no_tab_loses_what_another_has_settled(pages: Callable[..., Page]) -> None:
    page = pages("doorway.py", 2560, 1400)
    bar = page.get_by_role("separator", name="Width of the panels")
    expect(bar).to_have_attribute("aria-valuenow", str(round(0.38 * 2560)))
    page.set_viewport_size({"width": 1280, "height": 800})
    page.reload()
    expect(bar).to_have_attribute("aria-valuenow", "784")
    shows(page, "#status", "at its start")
    other = page.context.new_page()
    other.goto(page.url)
    shows(other, "#status", "at its start")
    settle = "async ([kind, number]) => (await part('store.js')).settle(kind, [{ number }])"
    page.evaluate(settle, ["cleared", 3])
    other.evaluate(settle, ["seen", 5])
    page.reload()
    shows(page, "#status", "at its start")
    settled = """async (kind) => {
      const { isSettled } = await part("store.js");
      return [3, 5, 6].filter((number) => isSettled({ number }, kind));
    }"""
    assert page.evaluate(settled, "cleared") == [3]
    assert page.evaluate(settled, "seen") == [3, 5]


@pytest.mark.slow
def test_nothing_overflows_at_any_usual_size(pages: Callable[..., Page]) -> None:
    for width, height in ((1280, 800), (1920, 1080), (1024, 700), (853, 533)):
        page = pages("doorway.py", width, height)
        shows(page, "#time", "0.00 s")
        assert page.evaluate("document.documentElement.scrollWidth <= innerWidth && document.documentElement.scrollHeight <= innerHeight")
        page.close()


@pytest.mark.slow
def test_at_150_percent_the_3d_view_s_tools_are_one_row_and_the_hint_is_whole(pages: Callable[..., Page]) -> None:
    page = pages("doorway.py", 853, 533, paced=True)
    shows(page, "#status", "at its start")
    tools = page.get_by_role("toolbar", name="3D view")
    right = "one => one.getBoundingClientRect().right"
    assert tools.get_by_role("button", name="Arrange").evaluate(right) <= page.locator("#scene").evaluate(right)
    assert tools.evaluate("bar => bar.offsetHeight") < 2 * tools.get_by_label("Camera").evaluate("one => one.offsetHeight")
    for name in ("Overlays", "Move, push …", "Make a video of the 3D view"):
        expect(tools.get_by_role("button", name=name)).to_be_visible()
    tools.get_by_role("button", name="Overlays").click()
    expect(page.get_by_role("group", name="Overlays")).to_be_visible()
    assert page.get_by_role("tab", name="Messages").evaluate(right) <= 853
    hint = page.get_by_role("button", name="Real time: press + to go faster")
    assert hint.evaluate("one => one.scrollWidth <= one.clientWidth && one.offsetWidth <= one.parentElement.clientWidth")
    page.keyboard.press("?")
    manual = page.get_by_role("dialog").get_by_role("link", name="Manual of ACT-R 3D")
    assert manual.evaluate("({ parentElement: line }) => line.scrollHeight <= line.clientHeight")
    page.keyboard.press("Escape")
    open_tab(page, "About")
    page.emulate_media(media="print")  # the open panel is printed, without what can be pressed
    expect(page.get_by_role("tabpanel")).to_be_visible()
    expect(page.get_by_role("tablist")).to_be_hidden()
    expect(page.locator(".about h2").first).to_be_visible()
    expect(page.locator(".about button", has_text="Edit")).to_be_hidden()
    page.emulate_media(media="screen")


@pytest.mark.slow
def test_as_narrow_as_in_a_notebook_the_timeline_s_tools_and_what_a_system_does_can_be_read(pages: Callable[..., Page]) -> None:
    page = pages("doorway.py", 690, 560, tab="buffers")
    shows(page, "#time", "0.00 s")
    page.locator("#step").click()
    shows(page, "#time", "0.01 s")
    right = "all => Math.max(...all.map((one) => one.getBoundingClientRect().right))"
    assert page.get_by_role("toolbar", name="Timeline").get_by_role("button").evaluate_all(right) <= 690
    doing = page.locator(".part .doing").first
    expect(doing).to_have_text("look is about to fire")
    assert doing.evaluate("one => one.scrollWidth <= one.clientWidth")


@pytest.mark.slow
def test_models_of_one_name_are_told_apart(pages: Callable[..., Page], workbench: Served) -> None:
    folder = workbench.folder / "tutorial"
    folder.mkdir()
    for name in ("counting.py", "other.py"):
        shutil.copy(MODELS / "counting.py", folder / name)
    page = pages("tutorial/counting.py", tab="editor")
    shows(page, "#status", "at its start")
    model = page.get_by_label("Model", exact=True)
    assert model.evaluate("list => list.selectedOptions[0].text") == "tutorial/counting.py"
    assert model.evaluate("list => [...list.options].map(({ text }) => text)").count("counting.py") == 1
    assert "other.py" in model.evaluate("list => [...list.options].map(({ text }) => text)")
    expect(page.locator(".file-status .path")).to_have_text(re.compile("/models/tutorial/$"))
    shutil.rmtree(folder)


def test_code_in_texts_of_the_page_has_no_backticks(pages: Callable[..., Page]) -> None:
    page = pages("counting.py", tab="parameters")
    shows(page, "#panel-parameters", "A frozen dataclass that build takes")


@pytest.mark.slow
def test_all_tools_of_the_timeline_are_in_reach_at_150_percent(pages: Callable[..., Page], workbench: Served) -> None:
    shutil.copy(MODELS / "aperture_passage.py", workbench.folder)
    page = pages("aperture_passage.py", 853, 533)
    page.click("#run")
    shows(page, "#status", "ended")
    expect(page.get_by_role("button", name="SGOMS")).to_be_visible()
    assert page.evaluate("(({ scrollWidth, clientWidth }) => scrollWidth <= clientWidth)(document.querySelector('.timeline-tools'))")
    (workbench.folder / "aperture_passage.py").unlink()


@pytest.mark.slow
def test_a_value_of_a_parameter_that_has_another_name_now_is_left_out_by_a_restart(pages: Callable[..., Page], workbench: Served) -> None:
    source = (workbench.folder / "doorway.py").read_text(encoding="utf-8")
    file = workbench.folder / "renamed.py"
    file.write_text(source, encoding="utf-8")
    page = pages("renamed.py")
    shows(page, "#status", "at its start")
    open_tab(page, "Parameters")
    page.get_by_label("width", exact=True).fill("0.9")
    page.get_by_role("button", name="Restart with these").click()
    # The doorway is 90 cm wide at once, as the parameter is live; the file may change only when the restart has read it.
    becomes_true(page, "async () => (await part('store.js')).session.value.settings.width === 0.9")
    shows(page, "#status", "at its start")
    version = workbench.get("/api/model?path=renamed.py").json()["version"]
    assert workbench.put("/api/model", {"path": "renamed.py", "text": renamed(source), "version": version}).status_code == 200
    note = page.get_by_text("The text has no parameter width any more")
    expect(note).to_be_visible()
    page.get_by_role("button", name="Restart with these").click()
    expect(note).to_have_count(0)
    expect(page.get_by_label("gap", exact=True)).to_have_value("0.5")
    shows(page, "#width", "50 cm")


def renamed(source: str) -> str:
    return source.replace("    width: Annotated", "    gap: Annotated").replace("parameters.width", "parameters.gap")


AT_ONCE = """async () => {
  const { optimistic } = await part("parts/optimistic_value.js");
  const { sendCommand } = await part("server.js");
  const { state } = await part("store.js");
  const { send } = WebSocket.prototype;
  const sent = [];
  WebSocket.prototype.send = function (text) {
    const { command } = JSON.parse(text);
    if (command) sent.push(command.values?.[0] ?? command.type);
    send.call(this, text);
  };
  const shown = () => Math.round(100 * state.value.apertures.aperture);
  const width = optimistic(shown, (value) => ({ type: "command", word: "aperture", values: [value / 100], named: { name: "aperture" } }));
  for (const value of [60, 70, 80]) width.set(value);
  sendCommand({ type: "step" });
  const before = [...sent];
  for (let n = 0; n < 1000 && !(shown() === 80 && state.value.tick === 1); n += 1) await new Promise((done) => setTimeout(done, 10));
  WebSocket.prototype.send = send;
  return { before, sent: sent.filter((what) => typeof what === "number"), shown: width.value.value };
}"""


def test_what_was_set_last_is_sent_before_the_next_command(page: Page) -> None:
    """Also if an earlier value is not confirmed yet: a run never begins with a value that the page does not show."""
    shows(page, "#status", "at its start")
    found = page.evaluate(AT_ONCE)
    assert found == {"before": [0.6, 0.8, "step"], "sent": [0.6, 0.8], "shown": 80}


@pytest.mark.slow
def test_a_button_that_its_press_makes_unavailable_keeps_the_focus(pages: Callable[..., Page]) -> None:
    page = pages("counting.py")
    shows(page, "#status", "at its start")
    page.locator("#run").press("Enter")
    shows(page, "#status", "ended")
    end = page.locator("#time").inner_text()
    newest, again, stop = (page.get_by_role("button", name=name) for name in ("Newest moment", "Continue from here", "Stop the model"))
    for button in (newest, again):
        page.evaluate("async () => (await part('timeline/seek.js')).travel(0.1)")
        shows(page, "#time", r"0\.10 s")
        button.press("Enter")
        expect(page.locator("#time")).to_have_text(end)
        expect(button).to_be_disabled()
        expect(button).to_be_focused()
        button.evaluate("(button) => button.click()")  # does nothing
        expect(page.locator("#time")).to_have_text(end)
    page.evaluate("async () => (await part('timeline/seek.js')).travel(0.1)")
    expect(again).to_be_enabled()  # again, with the focus
    expect(again).to_be_focused()
    stop.press("Enter")
    shows(page, "#status", "stopped")
    expect(stop).to_be_disabled()
    expect(stop).to_be_focused()
    page.keyboard.press("Shift+Tab")
    until(page, lambda: stop.evaluate("(button) => [button.disabled, button.ariaDisabled]") == [True, None])  # out of reach
