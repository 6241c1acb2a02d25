"""A recording in a real browser: all of it is there at once, it is said to be one, and what was shown before stays reachable."""

from __future__ import annotations

import re
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest
from playwright.sync_api import Locator, Page, expect

from tests.browser.test_runs_panel import recorded, row
from tests.helpers.full_disk import full_disk
from tests.helpers.page import Users, drawn, open_tab, say, shows, until
from tests.helpers.workbench_server import MODELS, Served

Pages = Callable[..., Page]

FAILS = "raise ValueError('unlucky')\n"


def sessions(workbench: Served) -> list[str]:
    return [one["id"] for one in workbench.get("/api/sessions").json()["sessions"]]


@pytest.mark.slow
def test_a_recording_has_an_address_of_its_own_and_leads_back(pages: Pages, workbench: Served) -> None:
    name = recorded(workbench, "doorway.py")
    page = pages("counting.py", tab="runs")
    shows(page, "#status", "at its start")
    page.click("#cycle")
    shows(page, "#time", "0.05 s")
    row(page, name).click()
    page.get_by_role("button", name="Open", exact=True).click()
    banner = page.locator(".recording-banner")
    expect(banner).to_contain_text(name)
    expect(banner).to_contain_text("6.80 s recorded")
    expect(banner.locator(".when")).to_have_text(re.compile(r"^made \S+ \d+, \d{4}, \d\d:\d\d:\d\d$"))  # not «3:03:40 PM»
    shows(page, "#time", "t = 0.00 s")
    assert page.url.endswith(f"/?run={name}")
    open_tab(page, "Productions")
    expect(page.locator("#events tbody tr.ahead")).not_to_have_count(0)  # what will happen is there before it does
    page.get_by_role("button", name="Newest moment").click()
    shows(page, "#time", "t = 6.80 s")
    shows(page, "#status", "ended: the model called stop")
    page.get_by_role("button", name="Run again").click()  # from its start, and the recording stays one
    shows(page, "#status", "^running")
    shows(page, "#status", "ended: the model called stop")
    expect(banner).to_contain_text(name)
    before = sessions(workbench)
    page.reload()
    expect(banner).to_contain_text(name)
    shows(page, "#time", "t = 6.80 s")
    assert sessions(workbench) == before
    page.go_back()
    expect(banner).to_have_count(0)
    shows(page, "#time", "t = 0.05 s")  # the run of before, where it was
    assert page.url.endswith("/?model=counting.py")
    page.go_forward()
    expect(banner).to_contain_text(name)
    banner.get_by_role("button", name="Back to the run of counting.py").click()
    shows(page, "#time", "t = 0.05 s")
    assert sessions(workbench) == before
    page.get_by_label("Model", exact=True).select_option("doorway.py")  # which is not a recording
    shows(page, "#status", "at its start")
    expect(banner).to_have_count(0)
    page.goto(f"{workbench.url}/?run={name}")
    expect(banner).to_contain_text(name)
    shows(page, "#time", "t = 6.80 s")
    page.click("#restart")  # a new run of the model is not a recording, and has the address of the model
    expect(banner).to_have_count(0)
    expect(page).to_have_url(re.compile(r"/\?model=doorway\.py$"))


@pytest.mark.slow
def test_the_page_fits_its_window_whatever_a_recording_is_called(pages: Pages, workbench: Served) -> None:
    name = "of-a-walker-" + "x" * 108
    (workbench.folder / "walks").mkdir()
    shutil.copy(workbench.folder / "doorway.py", workbench.folder / "walks")
    recordings = workbench.folder / ".workbench" / "recordings"
    (recordings / f"{recorded(workbench, 'walks/doorway.py')}.sqlite").rename(recordings / f"{name}.sqlite")
    model = workbench.folder / f"{'long_name_' * 6}.py"
    model.write_text((workbench.folder / "counting.py").read_text(encoding="utf-8"), encoding="utf-8")
    for model_shown in ("counting.py", model.name):  # as the way back; then both are open, in a list
        page = pages(model_shown)
        shows(page, "#status", "at its start")
        page.goto(f"{workbench.url}/?run={name}")
        banner = page.locator(".recording-banner")
        expect(banner).to_contain_text("s recorded")
        for width, height in ((1280, 800), (853, 533)):
            page.set_viewport_size({"width": width, "height": height})
            assert page.evaluate("document.documentElement.scrollWidth") == width
            assert page.locator(".bar").evaluate("one => one.scrollHeight <= one.clientHeight"), "the banner covers nothing of the bar"
            for part in (".name", ".path", ".facts > span >> nth=-1"):
                assert banner.locator(part).evaluate("one => one.scrollWidth <= one.clientWidth"), f"{part} is not cut"
            expect(banner.locator(".path")).to_have_text("walks/doorway.py")
            expect(banner.locator("button, select")).to_have_count(1)
            page.wait_for_function(
                "document.querySelector('.recording-banner :is(button, select)').getBoundingClientRect().right <= innerWidth"
            )
        page.close()


@pytest.mark.slow
@pytest.mark.scene
def test_one_press_of_back_leads_from_the_recording_of_a_body_to_what_was_before(pages: Pages, workbench: Served) -> None:
    name = recorded(workbench, "doorway.py")
    page = pages("doorway.py", tab="runs")
    shows(page, "#status", "at its start")
    banner, scene = page.locator(".recording-banner"), page.locator("iframe[title='3D view']")
    expect(scene).to_have_attribute("src", re.compile("/viser/"))
    before = str(scene.get_attribute("src"))
    in_frame(page, before)
    row(page, name).click()
    recording = ""
    for _ in range(2):
        page.get_by_role("button", name="Open", exact=True).click()
        expect(banner).to_contain_text(name)
        expect(scene).not_to_have_attribute("src", before)
        recording = str(scene.get_attribute("src"))
        in_frame(page, recording)
        page.go_back()
        expect(banner).to_have_count(0)
        expect(page).to_have_url(re.compile(r"/\?model=doorway\.py$"))
        expect(scene).to_have_attribute("src", before)
        in_frame(page, before)
    page.go_forward()
    expect(banner).to_contain_text(name)
    in_frame(page, recording)


@pytest.mark.slow
def test_from_a_recording_one_can_go_to_any_run_that_is_open(pages: Pages, workbench: Served) -> None:
    name = recorded(workbench, "counting.py")
    page = pages("counting.py", tab="runs")
    shows(page, "#status", "at its start")
    page.click("#cycle")
    shows(page, "#time", "0.05 s")
    page.get_by_label("Model", exact=True).select_option("doorway.py")
    shows(page, "#time", "t = 0.00 s")
    row(page, name).click()
    page.get_by_role("button", name="Open", exact=True).click()
    runs = page.locator(".recording-banner").get_by_label("Open runs")
    expect(runs.locator("option")).to_have_text(["2 other runs are open", "run of counting.py", "run of doorway.py"])
    runs.select_option("run of counting.py")
    expect(page.locator(".recording-banner")).to_have_count(0)
    shows(page, "#time", "t = 0.05 s")


@pytest.mark.slow
def test_a_changed_recording_loses_nothing_before_something_is_lost_it_is_asked_and_what_two_drag_is_the_same_for_both(
    pages: Pages, workbench: Served
) -> None:
    name = recorded(workbench, "doorway.py")
    page, other = pages("counting.py", tab="buffers", refusals=True), pages("counting.py", tab="buffers")
    for one in (page, other):
        one.goto(f"{workbench.url}/?run={name}")
        expect(one.locator(".recording-banner")).to_contain_text("6.80 s recorded")
        shows(one, "#time", "t = 0.00 s")
    asked = page.get_by_role("dialog")

    def order(kind: str, time: float) -> None:
        page.evaluate("async (said) => (await part('server.js')).sendCommand(said)", {"type": kind, "time": time})
        shows(page, "#time", f"t = {time:.2f} s")

    def drag(key: str) -> None:
        page.locator("#aperture").focus()
        page.keyboard.press(key)

    order("seek", 1)
    file = workbench.folder / ".workbench" / "recordings" / f"{name}.sqlite"
    file.rename(file.with_suffix(".away"))
    drag("End")
    expect(asked).to_contain_text("would be lost: the recording that this run repeats has been deleted or renamed.")
    asked.get_by_role("button", name="Cancel").click()
    expect(asked).to_have_count(0)
    file.with_suffix(".away").rename(file)
    drag("End")
    shows(page, "#status", r"paused: changed at 1\.00 s$")  # without a question
    expect(page.locator(".recording-banner")).to_contain_text("Recorded as a branch")
    width = page.locator("#width").inner_text()
    order("until", 2)
    order("seek", 1.5)
    drag("Home")
    shows(page, "#status", r"paused: changed at 1\.50 s$")  # also without a question
    expect(page.locator("#width")).not_to_have_text(width)
    page.evaluate("async () => (await part('server.js')).sendCommand({ type: 'restart', record: false })")
    shows(page, "#status", "at its start")
    width = page.locator("#width").inner_text()
    order("until", 2)
    order("seek", 1.5)
    drag("Home")
    expect(asked).to_contain_text("What lies ahead, from 1.5 s to 2 s, would be lost: the run is not recorded.")
    asked.get_by_role("button", name="Cancel").click()
    expect(asked).to_have_count(0)
    expect(page.locator("#width")).to_have_text(width)
    drag("Home")
    asked.get_by_role("button", name="Change it anyway").click()
    shows(page, "#status", r"paused: changed at 1\.50 s; the rest was lost")
    expect(page.locator("#width")).not_to_have_text(width)
    for key in ("ArrowRight", "End", "ArrowLeft"):
        for one in (page, other):
            one.locator("#aperture").focus()
            one.keyboard.press(key)
    until(page, lambda: page.locator("#width").inner_text() == other.locator("#width").inner_text() != width)
    for one in (page, other):
        expect(one.get_by_role("dialog")).to_have_count(0)


def asked_before_change(page: Page) -> Locator:
    """Empties the buffer of the goal; returns the question that the page asks before it does."""
    change = {"type": "command", "word": "clear_buffer", "named": {"buffer": "goal"}}
    page.evaluate("async (what) => void (await part('bar/branch.js')).sendChange(what)", change)
    return page.get_by_role("dialog", name="Change the past?")


def test_before_what_cannot_be_kept_is_lost_it_is_asked_also_if_the_run_is_recorded(pages: Pages, workbench: Served) -> None:
    page = pages("counting.py", tab="buffers", refusals=True)
    shows(page, "#status", "at its start")
    say(page, type="until", time=0.2)
    shows(page, "#time", r"t = 0\.20 s")
    say(page, type="seek", time=0.1)
    shows(page, "#time", r"t = 0\.10 s")
    where = workbench.folder / ".workbench" / "recordings"
    aside = where.rename(where.with_name("aside"))  # no file can be made there
    try:
        asked = asked_before_change(page)
        expect(asked).to_contain_text("What lies ahead, from 0.1 s to 0.2 s, would be lost: it cannot be kept (unable to open")
        asked.get_by_role("button", name="Change it anyway").click()
        shows(page, "#status", r"changed at 0\.10 s; the rest was lost")
    finally:
        aside.rename(where)


def workers(process: int) -> list[int]:
    """Returns the processes that another one has started, and those that these have started."""
    children = [int(child) for child in Path(f"/proc/{process}/task/{process}/children").read_text(encoding="ascii").split()]
    return [one for child in children for one in (child, *workers(child))]


@pytest.mark.slow
def test_an_opened_recording_that_is_changed_on_a_full_disk_is_no_longer_said_to_be_recorded(pages: Pages, workbench: Served) -> None:
    name = recorded(workbench, "counting.py")
    page = pages(refusals=True)
    page.goto(f"{workbench.url}/?run={name}")
    banner, link = page.locator(".recording-banner"), page.get_by_role("button", name="Copy a link")
    expect(banner).to_contain_text("3.35 s recorded")
    with full_disk(lambda: workers(workbench.process.pid)):
        say(page, type="until", time=0.3)
        shows(page, "#time", r"t = 0\.30 s")
        at(page, 0.1)
        asked = asked_before_change(page)
        expect(asked).to_contain_text("What follows would not be recorded: ")
        asked.get_by_role("button", name="Change it anyway").click()
        shows(page, "#status", r"changed at 0\.10 s; what follows is not recorded")
    for _ in range(2):
        expect(banner).to_contain_text("No longer recorded")
        expect(link).to_be_disabled()
        page.reload()


def test_a_run_that_cannot_begin_on_a_full_disk_leaves_no_curves_of_the_run_before(pages: Pages, workbench: Served) -> None:
    page = pages("counting.py")
    shows(page, "#status", "at its start")
    say(page, type="until", time=1.0)
    shows(page, "#time", r"t = 1\.00 s")
    timeline, curves = page.locator(".timeline"), page.get_by_role("button", name="Curves", exact=True)
    expect(curves).to_be_visible()
    with full_disk(lambda: workers(workbench.process.pid)):
        page.click("#restart")
        expect(timeline).to_contain_text("There is no run any more: cannot write the recording")
        expect(curves).to_have_count(0)


def at(page: Page, time: float) -> None:
    """Goes to a time of the run."""
    say(page, type="seek", time=time)
    shows(page, "#time", rf"t = {time:.2f} s")


def changed_at(page: Page, time: float, before: str) -> str:
    """Changes a recording at a time of it; returns the recording that it is from then on."""
    at(page, time)
    say(page, type="command", word="clear_buffer", named={"buffer": "goal"})
    expect(page.locator(".recording-banner")).to_contain_text("Recorded as a branch")
    expect(page).not_to_have_url(re.compile(f"run={before}$"))
    return page.url.partition("run=")[2]


@pytest.mark.slow
def test_a_changed_recording_has_the_address_and_the_link_of_the_branch_that_it_is_then(pages: Pages, workbench: Served) -> None:
    name = recorded(workbench, "counting.py")
    page, other = pages("counting.py"), pages("doorway.py")  # a run of the same model is open, too
    page.context.grant_permissions(["clipboard-read", "clipboard-write"])
    shows(page, "#status", "at its start")
    page.goto(f"{workbench.url}/?run={name}")
    banner = page.locator(".recording-banner")
    expect(banner).to_contain_text("3.35 s recorded")
    branch = changed_at(page, 0.2, name)
    expect(banner.locator(".name")).to_have_text("branch at 0.20 s")
    expect(banner.locator(".name")).to_have_attribute("title", branch)
    say(page, type="step", ticks=2)
    shows(page, "#time", r"t = 0\.22 s")
    page.get_by_role("button", name="Copy a link").click()
    expect(page.locator(".status-line")).to_contain_text("The link is copied")
    link = page.evaluate("navigator.clipboard.readText()")
    other.goto(link)
    expect(other.locator(".recording-banner .name")).to_have_attribute("title", branch)
    shows(other, "#time", r"t = 0\.22 s")
    expect(other).to_have_url(f"{workbench.url}/?run={branch}")
    other.goto(f"{workbench.url}/?run={name}&t=0.3")  # the recording, as it was
    expect(other.locator(".recording-banner")).to_contain_text("3.35 s recorded")
    shows(other, "#time", r"t = 0\.30 s")
    shows(page, "#time", r"t = 0\.22 s")
    page.reload()
    expect(banner.locator(".name")).to_have_attribute("title", branch)
    shows(page, "#time", r"t = 0\.22 s")
    page.go_back()
    expect(banner).to_contain_text("3.35 s recorded")
    page.go_forward()
    expect(banner.locator(".name")).to_have_attribute("title", branch)
    shows(page, "#time", r"t = 0\.22 s")


@pytest.mark.slow
def test_a_link_to_a_moment_past_the_end_of_a_recording_leads_to_the_branch_that_has_it(pages: Pages, workbench: Served) -> None:
    page, other = pages("counting.py"), pages("counting.py")
    shows(page, "#status", "at its start")
    say(page, type="restart")
    shows(page, "#status", "at its start")
    say(page, type="until", time=0.3)
    shows(page, "#time", r"t = 0\.30 s")
    name = page.evaluate("async () => (await part('store.js')).session.value.recording")
    say(page, type="restart")
    shows(page, "#status", "at its start")
    page.goto(f"{workbench.url}/?run={name}")
    banner = page.locator(".recording-banner")
    expect(banner).to_contain_text("0.30 s recorded")
    say(page, type="until", time=0.5)
    expect(banner).to_contain_text("Recorded as a branch")
    shows(page, "#time", r"t = 0\.50 s")
    expect(page).not_to_have_url(re.compile(f"run={name}$"))
    page.context.grant_permissions(["clipboard-read", "clipboard-write"])
    page.get_by_role("button", name="Copy a link").click()
    expect(page.locator(".status-line")).to_contain_text("The link is copied")
    other.goto(page.evaluate("navigator.clipboard.readText()"))
    shows(other, "#time", r"t = 0\.50 s")
    expect(other.locator(".branch-name", has_text="at 0.30 s")).to_be_visible()


def test_a_recording_stays_shown_while_its_file_is_renamed(pages: Pages, workbench: Served) -> None:
    (workbench.folder / "first.py").write_text((workbench.folder / "counting.py").read_text(encoding="utf-8"), encoding="utf-8")
    name = recorded(workbench, "first.py")
    page = pages("first.py", tab="editor")
    shows(page, "#status", "at its start")
    page.evaluate("async (name) => (await part('bar/models.js')).chooseRecording(name)", name)
    banner = page.locator(".recording-banner")
    expect(banner).to_contain_text(name)
    page.get_by_label("File", exact=True).select_option("first.py")
    page.get_by_role("button", name="Rename").click()
    page.get_by_label("New name").fill("second.py")
    page.keyboard.press("Enter")
    expect(page.get_by_label("File", exact=True)).to_have_value("second.py")
    assert page.url.endswith(f"/?run={name}")
    banner.get_by_role("button", name="Back to the run of second.py").click()
    shows(page, "#status", "at its start")
    assert page.url.endswith("/?model=second.py")


@pytest.mark.slow
def test_a_recording_of_a_model_that_is_gone_shows_the_parameters_of_its_run(pages: Pages, workbench: Served) -> None:
    file = workbench.folder / "gone.py"
    shutil.copy(MODELS / "doorway.py", file)
    page = pages("counting.py", tab="parameters")
    session = workbench.post("/api/sessions", {"model": "gone.py", "settings": {"width": 0.9}}).json()["id"]
    workbench.post(f"/api/sessions/{session}/command", {"command": {"type": "step"}})
    until(page, lambda: workbench.get(f"/api/sessions/{session}").json()["state"]["tick"] == 1)  # of less, nothing is kept
    name = workbench.get(f"/api/sessions/{session}").json()["session"]["recording"]
    workbench.post(f"/api/sessions/{session}/close")
    file.unlink()
    page.goto(f"{workbench.url}/?run={name}")
    expect(page.locator(".note")).to_have_text("The model's file is gone from the folder: this run cannot be restarted with other values.")
    expect(page.get_by_role("table", name="Parameters").get_by_role("row", name="width")).to_have_text("width0.9")
    expect(page.locator("#panel-parameters")).not_to_contain_text("declares no parameters")
    expect(page.locator(".toast")).to_have_count(0)


@pytest.mark.slow
def test_the_parameters_of_a_recording_are_those_of_its_text(pages: Pages, workbench: Served) -> None:
    file = workbench.folder / "sized.py"
    file.write_text("size = 3\nspeed = 2\nprint(size, speed)\n", encoding="utf-8")
    name = recorded(workbench, "sized.py", size=4, speed=5)
    file.write_text("speed = 1\ncolour = 'red'\nprint(speed, colour)\n", encoding="utf-8")
    page = pages("counting.py", tab="parameters")
    shows(page, "#status", "at its start")
    page.goto(f"{workbench.url}/?run={name}")
    expect(page.locator(".recording-banner")).to_contain_text(name)
    expect(page.get_by_label("size", exact=True)).to_have_value("4")
    expect(page.get_by_label("speed", exact=True)).to_have_value("5")
    expect(page.get_by_label("colour", exact=True)).to_have_count(0)
    expect(page.get_by_text("The text has no parameter size any more")).to_be_visible()
    page.get_by_role("button", name="Restart with these").click()  # with the text of now, which knows one of them
    expect(page.get_by_label("colour", exact=True)).to_have_value("red")
    expect(page.get_by_label("speed", exact=True)).to_have_value("5")
    expect(page.get_by_label("size", exact=True)).to_have_count(0)
    file.unlink()


@pytest.mark.slow
def test_a_recording_and_its_branch_are_switched_in_the_tree_and_one_can_be_deleted_without_the_other(
    pages: Pages, workbench: Served
) -> None:
    page, other = pages("counting.py", tab="runs"), pages("counting.py")
    shows(page, "#status", "at its start")
    say(page, type="restart")
    shows(page, "#status", "at its start")
    say(page, type="until", time=0.3)
    shows(page, "#time", r"t = 0\.30 s")
    at(page, 0.1)
    say(page, type="command", word="clear_buffer", named={"buffer": "goal"})
    first = page.locator(".branch-name", has_text="at 0.10 s")
    first.click()
    banner, time = page.locator(".recording-banner"), page.locator("#time")
    expect(banner).to_contain_text("0.30 s recorded")
    name = page.url.partition("run=")[2]
    branch = changed_at(page, 0.2, name)
    other.goto(page.url)
    expect(other.locator(".recording-banner")).to_contain_text("Recorded as a branch")
    first.click()
    expect(banner).to_contain_text("0.30 s recorded")
    expect(page).to_have_url(f"{workbench.url}/?run={name}")
    expect(time).to_contain_text("t = 0.20 s")  # from where it differs
    at(page, 0.25)
    expect(other.locator(".recording-banner")).to_contain_text("Recorded as a branch")
    shows(other, "#time", r"t = 0\.20 s")
    page.locator(".branch-name", has_text="at 0.20 s").click()
    expect(banner).to_contain_text("Recorded as a branch")
    expect(page).to_have_url(f"{workbench.url}/?run={branch}")
    row(page, name).click()
    page.get_by_role("button", name="Open", exact=True).click()
    expect(banner).to_contain_text("0.30 s recorded")
    row(page, branch).click()
    page.get_by_role("button", name="Open", exact=True).click()
    expect(banner).to_contain_text("Recorded as a branch")
    shows(page, "#time", r"t = 0\.20 s")
    page.get_by_role("button", name="Delete at 0.10 s").click()
    page.get_by_role("dialog").get_by_role("button", name="Delete").click()
    expect(row(page, name)).to_have_count(0)
    page.reload()
    expect(banner.locator(".name")).to_have_attribute("title", branch)
    expect(banner).to_contain_text("Recorded as a branch")
    page.get_by_label("Model", exact=True).select_option("doorway.py")
    expect(banner).to_have_count(0)
    page.go_back()
    expect(banner.locator(".name")).to_have_attribute("title", branch)
    shows(page, "#time", r"t = 0\.20 s")


SEEN = """() => {
  window.seen = new Set();
  const look = () => seen.add(document.querySelector("#time").textContent).add(document.querySelector("#status").textContent);
  new MutationObserver(look).observe(document.body, { subtree: true, childList: true, characterData: true });
}"""
"""Notes all times and states of the run that the page shows from now on."""


def test_a_branch_that_is_shown_is_at_its_moment_from_the_first_and_said_to_be_opened_before(pages: Pages) -> None:
    page = pages("doorway.py")
    shows(page, "#status", "at its start")
    say(page, type="until", time=0.3)
    shows(page, "#time", r"t = 0\.30 s")
    at(page, 0.1)
    say(page, type="command", word="aperture", values=[0.8])
    say(page, type="until", time=0.15)
    shows(page, "#time", r"t = 0\.15 s")
    page.evaluate(SEEN)
    page.locator(".branch-name", has_text="at 0.10 s").click()
    expect(page.locator(".recording-banner")).to_contain_text("0.30 s recorded")
    shows(page, "#time", r"t = 0\.10 s")
    seen = page.evaluate("[...seen]")
    assert "t = 0.00 s" not in seen
    assert "no run" not in seen


def in_frame(page: Page, address: str) -> None:
    """Waits until the 3D view has a picture of the scene of an address."""
    until(page, lambda: any(frame.url.partition("?")[0].endswith(address.partition("?")[0]) for frame in page.frames[1:]))
    expect(page.locator(".scene-cover")).to_have_count(0)


@pytest.mark.slow
def test_a_recording_that_was_stopped_runs_again_as_it_was_recorded(pages: Pages, workbench: Served) -> None:
    text = next(MODELS.rglob("counting.py")).read_text(encoding="utf-8")
    (workbench.folder / "told.py").write_text(text, encoding="utf-8")
    name = recorded(workbench, "told.py")
    (workbench.folder / "told.py").write_text("print('another text')\n", encoding="utf-8")
    page = pages("counting.py", tab="console")
    page.goto(f"{workbench.url}/?run={name}")
    banner = page.locator(".recording-banner")
    expect(banner).to_contain_text(name)
    shows(page, "#time", "t = 0.00 s")
    page.get_by_role("button", name="Stop the model").click()
    shows(page, "#status", "stopped")
    page.get_by_role("button", name="Run again").click()
    shows(page, "#status", "ended")
    expect(banner).to_contain_text(name)
    shows(page, "#panel-console", "5")
    expect(page.locator("#panel-console")).not_to_contain_text("another text")


def test_an_address_of_a_model_that_is_not_there_says_so(users: Users, workbench: Served) -> None:
    page = users.new(scene=False)
    page.goto(f"{workbench.address}&model=nope.py")
    open_tab(page, "Messages")
    shows(page, "#log", "There is no model «nope.py» in this folder; this is another one.")
    shows(page, "#status", "paused")
    users.leave()


def test_a_test_that_opens_a_page_of_a_model_that_is_not_there_fails(pages: Pages) -> None:
    with pytest.raises(AssertionError, match=r"^pages: the workbench has no model 'nope\.py'; copy it into its folder first \(it has "):
        pages("nope.py")


def test_an_address_of_a_recording_that_is_gone_says_so_and_shows_a_model(pages: Pages, workbench: Served) -> None:
    page = pages("counting.py", refusals=True)
    shows(page, "#status", "paused")
    page.goto(f"{workbench.url}/?run=gone")
    open_tab(page, "Messages")
    shows(page, "#log", "The recording «gone» cannot be opened: there is no such recording")
    shows(page, "#status", "paused")


@pytest.mark.slow
def test_what_was_settled_does_not_come_back_with_a_reload(pages: Pages, workbench: Served) -> None:
    (workbench.folder / "unlucky.py").write_text(FAILS, encoding="utf-8")
    page = pages("unlucky.py", tab="buffers")
    page.click("#run")
    expect(page.locator(".toast")).to_contain_text("unlucky")
    page.get_by_role("button", name="Close", exact=True).click()
    badge = page.get_by_role("tab", name="Messages").locator(".badge")
    expect(badge).to_have_text("1")
    page.reload()
    shows(page, "#status", "failed")
    drawn(page)
    expect(page.locator(".toast")).to_have_count(0)
    expect(badge).to_have_text("1")  # it was not read yet
    open_tab(page, "Messages")
    shows(page, "#log", "unlucky")
    open_tab(page, "Buffers")
    page.reload()
    shows(page, "#status", "failed")
    expect(badge).to_have_count(0)
    open_tab(page, "Messages")
    page.get_by_role("button", name="Clear", exact=True).click()
    page.reload()
    shows(page, "#status", "failed")
    shows(page, ".messages", "No messages")
    page.get_by_role("button", name="Run again").click()
    shows(page, "#log", "unlucky")  # but what goes wrong anew is told


@pytest.mark.slow
def test_a_long_recording_shows_at_its_start_what_will_happen_there(pages: Pages, workbench: Served) -> None:
    (workbench.folder / "long.py").write_text("for n in range(70_000):\n    print('line', n)\n", encoding="utf-8")
    page = pages("counting.py")
    shows(page, "#status", "at its start")
    name = recorded(workbench, "long.py")
    page.goto(f"{workbench.url}/?run={name}")
    shows(page, "#status", "at its start")
    open_tab(page, "Productions")
    rows = page.locator("#events tbody tr:not(.gap)")
    until(
        page, lambda: page.evaluate("async () => (await part('store.js')).events.value.first") == 0
    )  # the server has sent the last 50,000
    expect(page.locator(".gap-note")).to_have_count(0)
    page.get_by_role("group", name="Firing trace").press("Home")
    expect(rows.first).to_contain_text("line 0")
    expect(rows.first).to_have_class(re.compile("ahead"))


@pytest.mark.slow
def test_before_a_recording_is_deleted_that_another_page_shows_this_is_said_and_that_page_goes_on_showing_it(
    pages: Pages, workbench: Served
) -> None:
    name = recorded(workbench, "counting.py")
    page, other = pages("counting.py", tab="runs"), pages("counting.py")
    shows(page, "#status", "at its start")
    other.goto(f"{workbench.url}/?run={name}")
    banner = other.locator(".recording-banner")
    expect(banner).to_contain_text("recorded")
    shows(other, "#time", "t = 0.00 s")

    def ask(text: str, answer: str) -> None:
        row(page, name).click()
        page.get_by_role("button", name="Delete", exact=True).click()
        asked = page.get_by_role("dialog")
        expect(asked.locator("p")).to_have_text(text)
        asked.get_by_role("button", name=answer).click()
        expect(asked).to_have_count(0)

    trash = "It goes to the trash folder .workbench/trash."
    ask(f"{trash} Another page shows it, and goes on showing it.", "Delete")
    expect(row(page, name)).to_have_count(0)
    expect(banner.locator(".when")).to_have_text("deleted or renamed since it was opened")
    other.get_by_role("button", name="Newest moment").click()
    shows(other, "#status", "ended")
    page.get_by_role("button", name="Restore").click()
    expect(banner.locator(".when")).to_have_text(re.compile("^made "))
    other.goto("about:blank")
    until(page, lambda: all(not one["watching"] for one in workbench.get("/api/sessions").json()["sessions"] if one["recorded"]))
    ask(trash, "Cancel")
