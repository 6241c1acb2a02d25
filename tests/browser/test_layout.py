"""The parts of the page: maximised, collapsed, on the other side, in windows of their own; and links to moments of runs."""

from __future__ import annotations

import re
import shutil
from collections.abc import Callable, Iterator

import pytest
from playwright.sync_api import Page, expect

from tests.helpers.page import choose, duplicate, open_tab, say, shows, until
from tests.helpers.workbench_server import Served

Pages = Callable[..., Page]


def panels_are_at(page: Page, left: float, width: float) -> None:
    """Waits until the panels are at a place [px]."""

    def are_there() -> bool:
        found = page.get_by_role("region", name="Panels").bounding_box()
        return found is not None and (found["x"], found["width"]) == (left, width)

    until(page, are_there)


def arrange(page: Page, part: str, what: str) -> None:
    page.get_by_role("button", name=f"Arrange: {part}").click()
    page.get_by_role("group", name=f"Arrange: {part}").get_by_role("button", name=what).click()


@pytest.mark.slow
def test_parts_of_the_page_are_maximised_collapsed_and_swapped(page: Page) -> None:
    shows(page, "#status", "at its start")
    scene, timeline = page.get_by_role("region", name="3D view", exact=True), page.get_by_role("region", name="Timeline")
    page.keyboard.press("m")
    for _ in range(2):
        expect(scene).not_to_be_visible()
        expect(timeline).not_to_be_visible()
        panels_are_at(page, 0, 1280)
        page.reload()
        shows(page, "#status", "at its start")
    open_tab(page, "Editor")
    page.locator(".code .cm-content").focus()
    page.keyboard.press("Escape")
    expect(scene).to_be_visible()
    expect(timeline).to_be_visible()
    page.keyboard.press("Shift+m")  # which is written
    panels_are_at(page, 496, 784)
    page.keyboard.press("Control+z")
    arrange(page, "Timeline", "Collapse")
    expect(timeline).not_to_be_visible()
    arrange(page, "3D view", "Collapse")
    expect(scene).not_to_be_visible()
    page.get_by_role("button", name="Arrange: Panels").click()  # nothing would be left
    menu = page.get_by_role("group", name="Arrange: Panels").get_by_role("button")
    expect(menu).to_have_text(["MaximiseM", "Open in a window", "Swap the sides"])
    page.keyboard.press("Escape")
    page.reload()
    shows(page, "#status", "at its start")
    expect(scene).not_to_be_visible()
    choose(page, "counting.py")  # a model without a world is arranged by itself
    expect(timeline).to_be_visible()
    choose(page, "doorway.py")
    expect(timeline).not_to_be_visible()
    page.get_by_role("button", name="3D view", exact=True).click()
    page.get_by_role("button", name="Timeline", exact=True).click()
    expect(timeline).to_be_visible()
    arrange(page, "Panels", "Swap the sides")
    panels_are_at(page, 0, 784)
    page.keyboard.press("Tab")  # from now on, the keyboard is used
    page.get_by_role("separator", name="Width of the panels").press("ArrowRight")
    panels_are_at(page, 0, 808)
    page.get_by_role("button", name="Arrange: Timeline").press("Enter")
    page.keyboard.press("Tab")
    expect(page.get_by_role("group", name="Arrange: Timeline").get_by_role("button", name="Maximise")).to_be_focused()
    page.keyboard.press("Enter")
    expect(page.get_by_role("region", name="Panels")).not_to_be_visible()
    page.keyboard.press("Escape")
    page.get_by_role("separator", name="Height of the timeline").press("ArrowUp")
    height = page.get_by_role("separator", name="Height of the timeline").get_attribute("aria-valuenow")
    page.reload()
    shows(page, "#status", "at its start")
    panels_are_at(page, 0, 808)
    choose(page, "counting.py")
    expect(page.get_by_role("separator", name="Height of the timeline")).not_to_have_attribute("aria-valuenow", height or "")
    panels_are_at(page, 0, 1280)


@pytest.mark.slow
def test_a_world_with_nothing_in_it_has_no_3d_view(page: Page, workbench: Served) -> None:
    text = (workbench.folder / "counting.py").read_text().partition("if __name__")[0]
    text += """
from dataclasses import dataclass
from actr3d.simulation import Simulation
from actr3d.world import Scene


@dataclass(frozen=True)
class Parameters:
    pass


def build(parameters: Parameters) -> Simulation:
    return Simulation(Scene(), bodiless={"counting": Counting})
"""
    (workbench.folder / "nowhere.py").write_text(text)
    page.reload()
    shows(page, "#status", "at its start")
    choose(page, "nowhere.py")
    expect(page.get_by_role("region", name="3D view", exact=True)).not_to_be_visible()
    panels_are_at(page, 0, 1280)


@pytest.mark.slow
def test_a_panel_has_a_window_of_its_own_which_follows_the_page(pages: Pages) -> None:
    page = pages("counting.py")
    shows(page, "#status", "at its start")
    with page.context.expect_page() as opened:
        arrange(page, "Panels", "Open in a window")
    window = opened.value
    expect(window.get_by_role("heading", name="Buffers")).to_be_visible()
    expect(window.get_by_role("tab")).to_have_count(0)
    expect(window).to_have_title("Buffers · counting.py")
    page.click("#step")
    shows(window, "#time", "0.01 s")
    window.keyboard.press("ArrowRight")
    shows(page, "#time", "0.02 s")
    choose(page, "doorway.py")
    expect(window).to_have_title("Buffers · doorway.py")
    choose(duplicate(page), "counting.py")
    page.click("#step")
    shows(window, "#time", "0.01 s")
    expect(window).to_have_title("Buffers · doorway.py")
    page.close()
    window.reload()  # without the page that has opened it
    expect(window).to_have_title("Buffers · doorway.py")


@pytest.fixture
def second(workbench: Served) -> Iterator[str]:
    """Another model without a body, whose runs cost little."""
    path = workbench.folder / "second.py"
    shutil.copy(workbench.folder / "counting.py", path)
    yield path.name
    path.unlink()


def test_what_is_chosen_in_a_window_of_its_own_is_shown_by_the_page(second: str, pages: Pages) -> None:
    page = pages("counting.py", tab="editor")
    shows(page, "#status", "at its start")
    page.click("#run")
    shows(page, "#status", "ended")
    with page.context.expect_page() as opened:
        arrange(page, "Panels", "Open in a window")
    window = opened.value
    for theme in ("light", "dark"):
        page.evaluate("async (theme) => { (await part('theme.js')).chosen.value = theme; }", theme)
        expect(window.locator("html")).to_have_attribute("data-theme", theme)
    file = window.get_by_label("File", exact=True)
    expect(file.locator("option", has_text=second)).to_have_count(1)
    window.get_by_role("heading", name="Editor").click()
    window.keyboard.press("1")
    file.select_option(second)
    window.get_by_role("button", name=re.compile("^(Save and )?run$", re.I)).click()
    expect(page.get_by_label("Model", exact=True)).to_have_value(second)
    shows(page, "#status", "ended")
    expect(window).to_have_title(f"Editor · {second}")
    recorded = window.evaluate("async () => (await part('store.js')).session.value.recording")
    window.evaluate("async () => { (await part('open_tab.js')).openTab.value = 'runs'; }")
    window.locator(f"[data-run='{recorded}']").dblclick()
    expect(page.locator(".recording-banner")).to_contain_text(second)
    assert page.url.endswith(f"?run={recorded}")
    expect(window).to_have_title(f"Runs · {second}")
    window.get_by_role("button", name="Editor", exact=True).click()
    expect(window).to_have_title(f"Editor · {second}")
    assert f"run={recorded}" in window.url
    choose(page, "counting.py")
    expect(window).to_have_title("Editor · counting.py")
    expect(window).not_to_have_url(re.compile("run="))


def test_a_link_leads_to_a_moment_of_a_run(pages: Pages, workbench: Served) -> None:
    page = pages("counting.py")
    page.context.grant_permissions(["clipboard-read", "clipboard-write"])
    shows(page, "#status", "at its start")
    page.click("#cycle")
    shows(page, "#status", "fired")
    page.get_by_role("button", name="Copy a link").click()
    expect(page.locator(".status-line")).to_contain_text("The link is copied")
    link = page.evaluate("navigator.clipboard.readText()")
    assert re.fullmatch(rf"{workbench.url}/\?run=counting-[\w-]+&t=0\.05&copied=\d+", link)
    other = page.context.new_page()
    other.goto(link)  # the run is there
    shows(other, "#time", r"0\.05 s")
    other.wait_for_timeout(300)
    expect(other.locator(".toast")).to_have_count(0)
    other.close()
    page.click("#run")
    shows(page, "#status", "ended")
    ended = page.locator("#time").inner_text()
    other = page.context.new_page()
    other.goto(link)  # the run itself, for it is still open; it is not moved under the other page
    toast = other.locator(".toast.info")
    expect(toast).to_contain_text("The link leads to 0.05 s of this run. Another page shows it, too.")
    expect(page.locator("#time")).to_have_text(ended)
    toast.get_by_role("button", name="Go there").click()
    shows(other, "#time", r"0\.05 s")
    shows(page, "#time", r"0\.05 s")
    other.close()
    page.goto(link)
    shows(page, "#time", r"0\.05 s")
    expect(page).to_have_url(re.compile(r"\?model=counting.py$"))
    page.click("#restart")  # which ends it
    shows(page, "#time", r"0\.00 s")
    page.goto(link.replace("0.05", "1.2"))
    expect(page.locator(".recording-banner")).to_be_visible()
    shows(page, "#time", r"1\.20 s")
    expect(page).to_have_url(re.compile(r"\?run=counting-[\w-]+$"))
    page.get_by_role("button", name="Copy a link").click()
    same = link.replace("0.05", "1.2").partition("&copied")[0]
    until(page, lambda: page.evaluate("navigator.clipboard.readText()").partition("&copied")[0] == same)


@pytest.mark.slow
def test_a_link_leads_to_its_run_although_another_run_of_the_model_is_newer(pages: Pages, workbench: Served) -> None:
    older, _ = [workbench.post("/api/sessions", {"model": "counting.py", "seed": 1}).json()["id"] for _ in range(2)]
    page = pages("counting.py")
    shows(page, "#status", "at its start")
    page.evaluate("async (id) => (await part('server.js')).show(id)", older)
    page.click("#cycle")
    shows(page, "#time", r"0\.05 s")
    name = workbench.get(f"/api/sessions/{older}").json()["session"]["recording"]
    page.goto(f"{workbench.url}/?run={name}&t=0.03")
    expect(page.locator(".recording-banner")).to_contain_text(name)
    shows(page, "#time", r"0\.03 s")


@pytest.mark.slow
def test_a_link_to_a_moment_leads_to_its_branch_once_the_run_was_changed_before_it(pages: Pages) -> None:
    page = pages("counting.py")
    page.context.grant_permissions(["clipboard-read", "clipboard-write"])
    shows(page, "#status", "at its start")
    page.click("#run")
    shows(page, "#status", "ended")
    page.evaluate("async () => (await part('timeline/seek.js')).travel(1)")
    shows(page, "#time", r"1\.00 s")
    page.get_by_role("button", name="Copy a link").click()
    expect(page.locator(".status-line")).to_contain_text("The link is copied")
    link = page.evaluate("navigator.clipboard.readText()")
    page.evaluate("async () => (await part('timeline/seek.js')).travel(0.1)")
    shows(page, "#time", r"0\.10 s")
    say(page, type="command", word="clear_buffer", named={"buffer": "goal"})
    shows(page, "#status", r"changed at 0\.10 s$")
    page.goto(link)
    shows(page, "#time", r"1\.00 s")
    expect(page).to_have_url(re.compile(r"\?run=counting-[\w-]+-at-0\.100s-"))
    page.goto(link.replace("t=1&", "t=soon&"))
    expect(page.get_by_text("The link's time must be a time, such as 1.5 or 1:15:12.3 (got soon)").first).to_be_visible()
    expect(page).not_to_have_url(re.compile("t=soon"))
    page.goto(f"{link.partition('?')[0]}?model=counting.py&t=1")
    expect(page.get_by_text("Only the address of a recorded run can have a time t").first).to_be_visible()
    expect(page).to_have_url(re.compile(r"\?model=counting\.py$"))


SAY = """async (message) => void (await (await part("server.js")).request(message))"""


@pytest.mark.slow
def test_on_a_low_page_the_timeline_leaves_the_panels_a_usable_height(pages: Pages, workbench: Served) -> None:
    page = pages("doorway.py", width=853, height=533, tab="experiments")
    shows(page, "#status", "at its start")
    panel = page.locator(".tab-panel")
    rows = page.locator(".timeline-rows")
    until(page, lambda: panel.evaluate("one => one.clientHeight") >= 200)
    assert rows.evaluate("one => one.clientHeight") >= 60
    page.click("#step")
    shows(page, "#time", r"0\.01 s")
    for width in (0.5, 0.7, 0.9):  # each leaves a branch
        page.evaluate(SAY, {"type": "command", "word": "aperture", "values": [width]})
        shows(page, "#status", "changed at 0")
        page.click("#step")
        shows(page, "#time", r"0\.02 s")
        page.evaluate(SAY, {"type": "seek", "time": 0.01})
        shows(page, "#time", r"0\.01 s")
    expect(page.locator(".branches li")).to_have_count(3)
    until(page, lambda: rows.evaluate("one => one.clientHeight") >= 60)  # the branches scroll first
    page.evaluate("async () => { (await part('layout.js')).timelineHeight.value = 400; }")  # as from a higher page
    until(page, lambda: panel.evaluate("one => one.clientHeight") >= 150)
    page.evaluate("async () => { localStorage.clear(); }")
    page.click("#step")
    shows(page, "#time", r"0\.02 s")
    recording = page.evaluate("async () => (await part('store.js')).shownRecording.value")
    page.click("#restart")
    shows(page, "#time", r"0\.00 s")
    page.goto(f"{page.url.partition('?')[0]}?run={recording}")
    expect(page.locator(".recording-banner")).to_contain_text("s recorded")
    page.get_by_role("tab", name="Memory").click()
    until(page, lambda: panel.evaluate("one => one.clientHeight") >= 150)
    assert rows.evaluate("one => one.clientHeight") >= 20


def test_at_twice_the_size_the_page_scrolls_and_nothing_is_cut_off(pages: Pages) -> None:
    page = pages("doorway.py", width=640, height=400, tab="parameters")  # as with a zoom of 200 %
    shows(page, "#status", "at its start")
    expect(page.get_by_role("button", name="Defaults")).to_be_visible()
    cut = "(part) => [part.scrollWidth - part.clientWidth, part.scrollHeight - part.clientHeight]"
    assert page.locator(".below").evaluate(cut) == [0, 0]
    assert page.locator(".tab-panel").evaluate(cut)[0] == 0
    page.locator(".status-line").scroll_into_view_if_needed()
    expect(page.locator(".timeline-rows")).to_be_in_viewport(ratio=1)
    assert page.locator(".timeline-rows").evaluate("one => one.clientHeight") >= 60
