"""Changes by hand in a real browser: buffers, memories, productions, the scene; the tree of branches; all browsers see the same."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from dataclasses import asdict
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Page, expect

from actr3d.change import CHANGES
from actr3d.parameter_schema import parameters_of
from actr3d.recording import Recorded, Recording
from actr3d.runner.facts import program_facts
from actr3d.trace import Trace
from tests.helpers.page import becomes_true, open_tab, say, shows, until
from tests.helpers.workbench_server import MODELS, Served
from tests.workbench.html_replay.test_html_replay import inside
from workbench.html_replay.make import write_replay
from workbench.loader import listing_of
from workbench.worker.change_menu import change_menu


def commands(page: Page) -> list[str]:
    """Returns the users' commands as the timeline shows them; those of one moment are in one mark."""
    return page.evaluate("""async () => {
      const { lanes } = await part("timeline/record.js");
      return (lanes.lanes.get("commands")?.bands ?? []).flatMap(({ text }) => text.split("; "));
    }""")


@pytest.mark.slow
def test_the_value_of_a_live_parameter_is_that_of_the_moment_for_all_who_look(pages: Callable[..., Page]) -> None:
    page = pages("doorway.py")
    shows(page, "#status", "at its start")
    say(page, type="until", time=0.5)
    shows(page, "#time", r"0\.50")
    open_tab(page, "Parameters")
    field = page.get_by_label("speed", exact=True)
    expect(field).to_have_value("1.2")
    field.fill("1.5")
    field.press("Enter")
    expect(field).to_have_value("1.5")
    expect(page.get_by_text("not in effect yet")).to_have_count(0)
    until(page, lambda: commands(page) == ["speed 1.2 -> 1.5 m/s"])
    say(page, type="step", ticks=10)
    shows(page, "#time", r"0\.60")
    other = pages("doorway.py")
    open_tab(other, "Parameters")
    seen = [field, other.get_by_label("speed", exact=True)]
    for time, value in ((0.6, "1.5"), (0.3, "1.2"), (0.6, "1.5"), (0.0, "1.2")):
        say(page, type="seek", time=time)
        for one in seen:
            expect(one).to_have_value(value)
    page.reload()
    expect(seen[0]).to_have_value("1.2")
    say(page, type="seek", time=0.55)
    for one in seen:
        expect(one).to_have_value("1.5")
    until(page, lambda: commands(page) == ["speed 1.2 -> 1.5 m/s"])


def test_the_last_change_by_hand_is_undone_by_its_key_and_from_the_palette(pages: Callable[..., Page]) -> None:
    page = pages("counting.py", tab="buffers")
    shows(page, "#status", "at its start")
    search = page.get_by_role("combobox", name="Search commands")
    options = page.get_by_role("dialog", name="Commands").get_by_role("option")
    page.keyboard.press("Control+k")
    search.fill("undo")
    expect(options.first).to_have_text("Undo the last change by handRunCtrl Z")
    page.keyboard.press("Enter")
    expect(page.get_by_role("dialog").get_by_role("status")).to_contain_text("Nothing was changed by hand up to now.")
    page.keyboard.press("Escape")
    say(page, type="step", ticks=10)
    shows(page, "#time", r"0\.10")
    for chunk in ("first", "second"):
        say(page, type="command", word="set_buffer", named={"buffer": "goal", "chunk": chunk})
    shows(page, "tr[data-path=goal]", "second")
    counting = "set buffer goal task:count number:2 last:5 -> first"
    until(page, lambda: commands(page) == [counting, "set buffer goal first -> second"])  # each that one undo takes back
    say(page, type="step", ticks=10)
    shows(page, "#time", r"0\.20")
    page.get_by_label("Filter rows").focus()
    page.keyboard.type("a")
    page.keyboard.press("Control+z")  # a text field undoes its own text
    expect(page.get_by_label("Filter rows")).to_have_value("")
    page.locator("#status").click()
    page.keyboard.press("Control+z")
    shows(page, "#status", r"undone at 0\.10 s$")
    shows(page, ".branched", r"The run up to 0\.20 s is kept as a branch")
    page.get_by_role("button", name="Dismiss").click()
    expect(page.locator(".branched")).to_have_count(0)
    shows(page, "tr[data-path=goal]", "first")
    until(page, lambda: commands(page) == [counting])
    page.keyboard.press("Control+k")
    search.fill("undo")
    expect(options.first).to_contain_text(f"Undo the last change by hand: {counting}")
    page.keyboard.press("Enter")
    shows(page, "tr[data-path=goal]", "count")
    until(page, lambda: commands(page) == [])


MANY = """async (count) => {
  const { events, known, session, take } = await part("store.js");
  const { commandOf } = await part("commands.js");
  const before = commandOf("Mod+z").ready();
  const { first, list } = events.value;
  const more = Array.from({ length: count }, () => [list.at(-1)[0], "top", "nothing", {}]);
  take([{ of: session.value.id, run: known.run, epoch: known.epoch, events: { first: first + list.length, list: more } }]);
  return [before, events.value.first > 0, commandOf("Mod+z").ready()];
}"""
"""Whether a change can be undone, before and after so many events have come that the page does not keep the first ones."""


def test_a_change_that_the_page_does_not_keep_any_more_can_be_undone(pages: Callable[..., Page]) -> None:
    page = pages("counting.py")
    shows(page, "#status", "at its start")
    say(page, type="step", ticks=10)
    shows(page, "#time", r"0\.10")
    assert page.evaluate(MANY, 200_001) == [False, True, True]


@pytest.mark.slow
def test_an_agent_is_changed_by_hand_and_every_browser_sees_it(pages: Callable[..., Page]) -> None:
    page = pages("counting.py", refusals=True)
    shows(page, "#status", "at its start")
    say(page, type="until", time=0.12)
    shows(page, "#status", r"at 0\.12 s")
    other = pages("counting.py")
    shows(other, "tr[data-path=goal]", "count")

    # a buffer: a wrong text is explained beside the field, which stays open
    page.get_by_role("button", name="Edit goal").focus()
    page.keyboard.press("Enter")
    field = page.get_by_label("Chunk of goal")
    expect(field).to_have_value("task:count number:2 last:5")
    field.fill("task:count number:?x")
    field.press("Enter")
    expect(page.get_by_role("alert")).to_contain_text("'?x' is not bound")
    field.fill("task:count number:7 last:9 <b>")
    field.press("Enter")
    expect(field).to_have_count(0)
    for one in (page, other):
        shows(one, "tr[data-path=goal]", "<b>taskcountnumber7last9")
    page.get_by_role("button", name="Edit goal").click()
    expect(field).to_have_value("task:count number:7 last:9 <b>")
    field.fill("a draft")
    page.locator("#status").click()  # a draft stays where the focus goes elsewhere, or to another tab and back
    open_tab(page, "Memory")
    open_tab(page, "Buffers")
    expect(field).to_have_value("a draft")
    expect(field).not_to_be_focused()
    say(other, type="command", word="set_buffer", named={"buffer": "goal", "chunk": "of another browser"})
    expect(field).to_have_count(0)  # what it was to replace is no longer there
    say(other, type="command", word="set_buffer", named={"buffer": "goal", "chunk": "task:count number:7 last:9 <b>"})
    shows(page, "tr[data-path=goal]", "<b>taskcountnumber7last9")
    expect(field).to_have_count(0)
    page.get_by_role("button", name="Edit goal").click()
    field.fill("x")
    field.press("Escape")
    expect(field).to_have_count(0)
    expect(page.get_by_role("button", name="Edit goal")).to_be_focused()
    page.get_by_role("button", name="Edit goal").click()
    expect(field).to_be_focused()
    page.keyboard.press("Tab")  # nothing was written, so nothing is kept
    expect(field).to_have_count(0)
    typed, foreign = "task:count number:7 last:9 <b>", "of another browser"
    steps = [f"task:count number:2 last:5 -> {typed}", f"<b> task:count number:7 last:9 -> {foreign}", f"{foreign} -> {typed}"]
    assert commands(other) == [f"set buffer goal {step}" for step in steps]

    # a memory
    open_tab(page, "Memory")
    page.get_by_label("Add a chunk").fill("count 7 8 again")
    page.get_by_label("Add a chunk").press("Enter")
    row = page.locator("#chunks tr", has_text="count78again")
    row.click()
    page.get_by_role("button", name="Strengthen").click()
    expect(page.get_by_role("alert")).to_contain_text("'memory' has no base level")
    assert commands(page)[3:] == ["add chunk memory count 7 8 again"]

    # productions: what is forbidden is marked, and the explanation says who did it
    open_tab(page, "Productions")
    page.locator(".production-list").get_by_role("button", name="count_on", exact=False).first.hover()
    page.get_by_role("button", name="Change stop_counting").focus()
    page.keyboard.press("Enter")
    page.get_by_role("group", name="Change stop_counting").get_by_role("button", name="Fire next").click()
    expect(page.get_by_role("group", name="Change stop_counting").get_by_role("alert")).to_contain_text("it does not match")
    page.get_by_role("group", name="Change stop_counting").get_by_role("button", name="Forbid once").click()
    expect(page.locator(".production-list li", has_text="stop_counting")).to_contain_text("forbidden once")
    say(other, type="command", word="set_buffer", named={"buffer": "goal", "chunk": "task:count number:9 last:9"})
    say(other, type="until", time=0.16)  # what was about to fire no longer matches then
    page.locator(".production-list .name", has_text="stop_counting").click()
    shows(page, "#why-text", "left out: the user had forbidden it once")


def test_branches_are_a_tree_on_the_timeline_and_are_named_switched_and_deleted(pages: Callable[..., Page], workbench: Served) -> None:
    page = pages("counting.py", tab="runs", refusals=True)
    shows(page, "#status", "at its start")
    say(page, type="until", time=0.3)
    shows(page, "#status", r"at 0\.3 s")
    expect(page.locator(".branches")).to_have_count(0)
    say(page, type="seek", time=0.12)
    say(page, type="command", word="set_buffer", named={"buffer": "goal", "chunk": "task:count number:2 last:3"})
    rows = page.locator(".branches li")
    expect(rows).to_have_count(2)
    expect(rows.nth(1)).to_contain_text("at 0.12 s")
    becomes_true(page, "async () => (await part('timeline/view.js')).span.value.to >= 0.3")  # the branch is shown to its end
    branch = rows.nth(1).get_attribute("data-branch")
    workbench.post(f"/api/recordings/{branch}/label", {"note": "as it was"})  # by another browser, which this page does not know
    rows.nth(1).get_by_role("button", name="Name at 0.12 s").click()
    expect(page.get_by_label("Note")).to_have_value("as it was")
    workbench.post(f"/api/recordings/{branch}/label", {"name": "theirs"})
    expect(rows.nth(1)).to_contain_text("theirs")  # this page hears of it, although it has not listed
    page.get_by_label("Name", exact=True).fill("<i>to five</i>")
    page.get_by_label("Tags").fill("long, kept, long")
    page.get_by_role("button", name="Save", exact=True).click()
    expect(page.get_by_role("dialog").get_by_role("alert")).to_have_text(
        "another browser has changed the name to 'theirs' in the meantime. Save replaces that."
    )
    page.get_by_role("button", name="Save", exact=True).click()
    expect(rows.nth(1)).to_contain_text("<i>to five</i>")
    label = {"name": "<i>to five</i>", "note": "as it was", "tags": ["long", "kept"]}
    assert workbench.get(f"/api/recordings/{branch}").json()["label"] == label
    expect(page.locator("tr[data-run] .tag")).to_have_text(["long", "kept"])

    # beside its run, which began at the same time, it says where it leaves that
    rows.nth(1).get_by_role("button", name="Compare").click()
    compared = page.get_by_role("dialog")
    expect(compared.locator(".compare-run").first).to_have_text(re.compile(r"<i>to five</i> \S+, branch at 0\.12 s$"))
    expect(compared.locator(".compare-run").last).not_to_contain_text("branch")
    expect(compared.get_by_role("row", name="branch", exact=False).first).to_contain_text("at 0.12 s of counting.py")
    compared.get_by_role("button", name="Close").click()
    said = page.locator(f"tr[data-run='{branch}']").get_by_text("branch at 0.12 s")
    expect(said).to_have_attribute("title", re.compile(r"branch at 0\.12 s of counting\.py"))

    # the branch is shown as a recording with its own address; a change there is a branch of it, and the live run is left alone
    rows.nth(1).locator(".branch-name").click()
    shows(page, ".recording-banner", r"0\.30 s recorded")
    expect(page).to_have_url(re.compile(r"/\?run="))
    shows(page, "#time", r"0\.12 s")  # from where it differs
    say(page, type="seek", time=0.2)
    say(page, type="command", word="clear_buffer", named={"buffer": "goal"})
    shows(page, ".recording-banner", "Recorded as a branch")
    expect(rows).to_have_count(3)
    expect(page.locator(".branches li.mine")).to_contain_text("at 0.20 s")
    page.keyboard.press("Control+k")
    page.keyboard.insert_text("compare branch to five")
    found = page.get_by_role("dialog").get_by_role("option").first
    expect(found).to_have_text(f"Compare the shown run with the branch: <i>to five</i>Branch {branch}")
    page.keyboard.press("Escape")
    rows.nth(0).locator(".branch-name").click()
    shows(page, "#status", r"changed at 0\.12 s$")
    expect(rows).to_have_count(3)
    expect(page.locator(".branches li.mine")).to_have_count(1)
    assert commands(page) == ["set buffer goal task:count number:2 last:5 -> task:count number:2 last:3"]


@pytest.mark.slow
def test_the_form_for_moving_has_the_place_of_the_chosen_thing(pages: Callable[..., Page], workbench: Served) -> None:
    source = "from actr3d.simulation import Simulation\nfrom actr3d.world import Floor, Mannequin, Scene, Wall\n"
    parts = "Floor(), Mannequin(name='walker'), Wall(name='screen', start=(4, 1), end=(4, 3))"
    source += f"def build() -> Simulation:\n    return Simulation(Scene(parts=({parts})))\n"
    (workbench.folder / "moved.py").write_text(source, encoding="utf-8")
    page = pages("moved.py")
    shows(page, "#status", "at its start")
    say(page, type="command", word="move", values=["walker", 1.25, -0.5, 0.5])
    page.get_by_role("button", name="Move, push …").click()
    page.get_by_role("button", name="Move …", exact=True).click()
    dialog = page.get_by_role("dialog")
    fields = dialog.locator("input")
    for field, text in zip((fields.nth(0), fields.nth(1), fields.nth(2)), ("1.25", "-0.5", "28.6"), strict=True):
        expect(field).to_have_value(text)
    fields.nth(0).fill("9")
    dialog.get_by_label("object").select_option("screen")
    expect(fields.nth(1)).to_have_value("2")
    expect(fields.nth(0)).to_have_value("9")  # what the user has written stays
    dialog.get_by_label("object").select_option("walker")
    expect(fields.nth(1)).to_have_value("-0.5")
    fields.nth(0).fill("1.5")
    dialog.get_by_role("button", name="Move").click()
    expect(dialog).to_have_count(0)
    place = page.evaluate(
        "async () => await (await part('server.js')).request({ type: 'present', word: 'move', named: { object: 'walker' } })"
    )
    assert place == {"x": 1.5, "y": -0.5, "heading": pytest.approx(0.5, abs=1e-12)}  # what was not changed is as exact as it was


def test_things_in_the_scene_are_moved_and_pushed_by_numbers(pages: Callable[..., Page]) -> None:
    page = pages(refusals=True)
    shows(page, "#status", "at its start")
    page.get_by_role("button", name="Move, push …").click()
    page.get_by_role("button", name="Move …", exact=True).click()
    dialog = page.get_by_role("dialog")
    expect(dialog.locator("input").nth(0)).not_to_have_value("")  # the present place is there
    for text, why in (("", "must be a number"), ("1e400", "the number is too large"), ("abc", "must be a number")):
        dialog.get_by_label("x", exact=False).first.fill(text)
        dialog.get_by_role("button", name="Move").click()
        expect(dialog.get_by_role("alert")).to_have_text(f"x: {why} (got '{text}')")
    dialog.locator("input").nth(0).fill("7")
    dialog.locator("input").nth(1).fill("1.5")
    dialog.get_by_role("button", name="Move").click()
    expect(dialog.get_by_role("alert")).to_contain_text("'walker' cannot be put at (7, 1.5) m: it would be inside 'aperture_left'")
    dialog.locator("input").nth(0).fill("1")
    expect(dialog.locator("label", has_text="heading")).to_contain_text("[°]")
    dialog.get_by_label("heading", exact=False).fill("90")
    dialog.get_by_role("button", name="Move").click()
    expect(dialog).to_have_count(0)

    # a wrong push, from the palette: the field is named as the form names it
    page.keyboard.press("Control+k")
    page.keyboard.insert_text("push")
    expect(page.get_by_role("dialog").get_by_role("option").first).to_have_text("Push …Change by hand: object")
    page.keyboard.press("Enter")
    for x, time, problem in (("0", "1", "x: must not be 0 if y is 0 too"), ("9", "-1", "time: must be > 0 (got -1.0)")):
        dialog.get_by_label("x", exact=False).first.fill(x)
        dialog.get_by_label("time", exact=False).fill(time)
        dialog.get_by_role("button", name="Push").click()
        expect(dialog.get_by_role("alert")).to_contain_text(problem)
    expect(dialog).to_contain_text("Force along the x axis of the world [N]")
    page.keyboard.press("Escape")
    expect(dialog).to_have_count(0)
    say(page, type="step")
    shows(page, "#time", r"0\.01 s")
    say(page, type="command", word="move", values=["walker", 2.0, 1.0, 0.5])
    say(page, type="command", word="aperture", values=[0.4])
    assert commands(page) == ["move walker to (1, 1.5) m, 90°", "move walker to (2, 1) m, 29°", "aperture 50 -> 40 cm"]


def test_each_doorway_is_changed_in_the_bar_and_in_the_palette(pages: Callable[..., Page], workbench: Served) -> None:
    parts = "Floor(), Aperture(name='near'), Aperture(name='far', position=(5, 0))"
    source = "from actr3d.simulation import Simulation\nfrom actr3d.world import Aperture, Floor, Scene\n"
    source += f"def build() -> Simulation:\n    return Simulation(Scene(parts=({parts})))\n"
    (workbench.folder / "doorways.py").write_text(source, encoding="utf-8")
    page = pages("doorways.py")
    shows(page, "#status", "at its start")
    shown, slider = page.get_by_label("Aperture", exact=True), page.locator("#aperture")
    expect(shown.locator("option")).to_have_text(["near", "far"])
    tops = page.locator(".bar > *").evaluate_all(
        "(parts) => parts.map((part) => part.getBoundingClientRect()).map(({ top, bottom }) => [top, bottom])"
    )
    assert max(top for top, _ in tops) <= min(bottom for _, bottom in tops)  # all of the bar is in one row
    slider.fill("90")
    shows(page, "#width", "90 cm")
    shown.select_option("far")
    expect(slider).to_have_accessible_name("far")
    expect(page.locator("#width")).not_to_contain_text("90 cm")
    slider.fill("70")
    shows(page, "#width", "70 cm")
    page.keyboard.press("Control+k")
    page.get_by_role("combobox", name="Search").fill("Set the width")
    page.keyboard.press("Enter")
    form = page.get_by_role("dialog")
    form.get_by_label("width").fill("0.6")
    form.get_by_label("name").select_option("far")
    form.get_by_role("button", name="Set the width").click()
    shows(page, "#width", "60 cm")
    widths = page.evaluate("async () => (await part('store.js')).state.value.apertures")
    assert widths == {"near": pytest.approx(0.9), "far": pytest.approx(0.6)}
    (workbench.folder / "doorways.py").unlink()


@pytest.mark.slow
def test_a_form_stays_open_while_the_page_asks_whether_what_lies_ahead_may_be_lost(pages: Callable[..., Page]) -> None:
    page = pages(refusals=True)
    shows(page, "#status", "at its start")
    say(page, type="restart", record=False)
    shows(page, "#status", "at its start")
    say(page, type="until", time=0.05)
    shows(page, "#time", r"0\.05 s")
    say(page, type="seek", time=0.02)
    shows(page, "#time", r"0\.02 s")
    page.get_by_role("button", name="Move, push …").click()
    page.get_by_role("button", name="Move …", exact=True).click()
    form, question = page.get_by_role("dialog", name="Move"), page.get_by_role("dialog", name="Change the past?")
    x = form.locator("input").first
    x.fill("7")
    form.locator("input").nth(1).fill("1.5")
    x.press("Enter")
    question.get_by_role("button", name="Cancel").click()
    expect(x).to_have_value("7")
    expect(x).to_be_focused()
    expect(form.get_by_role("alert")).to_have_count(0)
    x.press("Enter")
    question.get_by_role("button", name="Change it anyway").click()
    expect(form.get_by_role("alert")).to_contain_text("it would be inside 'aperture_left'")
    page.keyboard.press("Escape")
    expect(page.get_by_role("dialog")).to_have_count(0)

    # a parameter may have values of several types
    page.keyboard.press("Control+k")
    expect(page.get_by_role("combobox", name="Search commands")).to_be_focused()
    page.keyboard.insert_text("set parameter")  # also found: «Set width» of the group Parameters
    expect(page.locator("#palette-0")).to_contain_text("Set parameter")
    page.keyboard.press("Enter")
    form = page.get_by_role("dialog", name="Set parameter")
    expect(form.locator("small code")).to_have_text("walker.memory.latency")
    expect(form).not_to_contain_text("`")
    form.locator("input").first.fill("walker.speed")
    value = form.locator("input").last
    value.fill('"1')
    value.press("Enter")
    expect(form.get_by_role("alert")).to_have_text("value: the quotation marks are wrong (got '\"1')")
    value.fill("fast")
    value.press("Enter")
    expect(form.get_by_role("alert")).to_contain_text("must be a number (got 'fast')")  # what cannot be done loses nothing
    value.fill("1.5")
    value.press("Enter")
    question.get_by_role("button", name="Change it anyway").click()
    expect(page.get_by_role("dialog")).to_have_count(0)
    until(page, lambda: commands(page) == ["speed 1.2 -> 1.5 m/s"])


WARNS = """import warnings
from actr3d.actr import *

class Talker(ACTR):
    goal = Buffer()
    def init():
        goal.set("count 0")
    def count(goal="count ?n!50"):
        print(n)
        if int(n) == 3:
            warnings.warn("three is odd")
        goal.modify(_1=int(n) + 1)

Talker().run(0.3)
"""


@pytest.mark.slow
def test_a_warning_is_shown_where_the_run_has_given_it_and_nowhere_else(pages: Callable[..., Page], workbench: Served) -> None:
    (workbench.folder / "warns.py").write_text(WARNS, encoding="utf-8")
    page = pages("warns.py", tab="editor")
    shows(page, "#status", "at its start")
    say(page, type="run")
    shows(page, "#status", "ended")
    shows(page, ".problems", "1 warning.*line 11three is odd")
    open_tab(page, "Messages")
    present, earlier = page.locator("#log li:not(.earlier, .heading)"), page.locator("#log li.earlier")
    expect(present).to_have_text([re.compile("three is odd")])

    def says(there: bool) -> None:
        """Waits until console, messages and editor agree."""
        expect(present).to_have_count(int(there))
        open_tab(page, "Console")
        expect(page.locator(".console .warning")).to_have_count(int(there))
        open_tab(page, "Editor")
        shows(page, ".problems", "1 warning.*line 11three is odd" if there else "No problems")
        open_tab(page, "Messages")

    say(page, type="seek", time=0.15)
    shows(page, "#status", "went to this time")
    says(False)
    shows(page, ".messages", "1 message from after this moment is not shown")
    say(page, type="seek", time=0.25)
    says(True)
    expect(page.locator(".messages")).not_to_contain_text("after this moment")
    say(page, type="seek", time=0.15)
    says(False)
    say(page, type="command", word="set_buffer", named={"buffer": "goal", "chunk": "count 48"})
    say(page, type="run")
    shows(page, "#status", "ended")
    says(False)
    expect(page.locator(".messages")).not_to_contain_text("after this moment")
    expect(earlier).to_have_text([re.compile("three is odd")])
    page.reload()
    says(False)


OWN = """from actr3d.actr import *
from actr3d.simulation import Simulation
from actr3d.world import Aperture, Floor, Scene, Wall

class Mind(ACTR):
    goal = Buffer()
    retrieval = Buffer()
    memory = Memory(retrieval)

    def init():
        goal.set("on")

    def go(goal="on"):
        goal.set("off")

simulation = Simulation(Scene(parts=(Floor(), Aperture(), Wall(name="wall", start=(1, 1), end=(1, 2)))), bodiless={"mind": Mind})
simulation.run(0.1)
simulation.command("aperture", 0.8)
simulation.run(1)
"""
"""A program that makes its own simulation, and gives it a command."""


def test_a_program_with_its_own_simulation_is_changed_by_hand_in_its_panels_and_its_scene(
    pages: Callable[..., Page], workbench: Served
) -> None:
    (workbench.folder / "own.py").write_text(OWN, encoding="utf-8")
    page = pages("own.py", tab="buffers")
    shows(page, "tr[data-path='mind.goal']", "empty")
    page.get_by_role("button", name="Edit goal").click()
    page.get_by_label("Chunk of goal").fill("other 1")
    page.get_by_label("Chunk of goal").press("Enter")
    shows(page, "tr[data-path='mind.goal']", "other1")
    page.get_by_role("button", name="Move, push").click()
    page.get_by_role("dialog").get_by_role("button", name="Move …").click()
    page.get_by_label("x [m]").fill("2")
    page.get_by_label("y [m]").fill("0")
    page.get_by_role("dialog").get_by_role("button", name="Move", exact=True).click()
    until(page, lambda: len(commands(page)) == 2)
    assert commands(page) == ["set buffer mind.goal empty -> other 1", "move wall to (2, 0) m"]
    say(page, type="until", time=0.05)
    shows(page, "#time", r"0\.05")
    slider = page.get_by_role("slider", name="aperture", exact=True)
    slider.focus()
    slider.press("ArrowRight")
    until(page, lambda: commands(page)[-1] == "aperture 80 -> 81 cm")
    say(page, type="until", time=0.2)
    shows(page, "#time", r"0\.20")
    until(page, lambda: commands(page)[-1].endswith("-> 80 cm"))  # by the program itself
    page.locator("#status").click()
    page.keyboard.press("Control+z")
    shows(page, "#status", r"undone at 0\.05 s$")
    until(page, lambda: len(commands(page)) == 2)


def test_in_the_trace_a_change_by_hand_is_read_before_its_effect(pages: Callable[..., Page]) -> None:
    page = pages("counting.py", tab="productions")
    shows(page, "#status", "at its start")
    say(page, type="step", ticks=12)
    shows(page, "#time", r"0\.12 s")
    page.get_by_label("Filter the trace").fill("goal")
    page.get_by_role("button", name="Events ", exact=False).first.click()
    page.get_by_role("button", name="All", exact=True).evaluate("one => one.click()")
    page.keyboard.press("Escape")
    say(page, type="command", word="set_buffer", named={"buffer": "goal", "chunk": "task:rest"})
    say(page, type="command", word="clear_buffer", named={"buffer": "goal"})
    rows = page.locator("#events tbody tr")
    expect(rows.last).to_contain_text("nothing")
    assert rows.locator(".what span").all_inner_texts()[-4:] == [
        "set buffer goal task:count number:2 last:5 -> task:rest",
        "task:rest",
        "clear buffer goal task:rest -> empty",
        "nothing",
    ]
    numbers = rows.evaluate_all("all => all.slice(-2).map(({ id }) => id)")
    rows.last.click()
    shows(page, "#time", r"0\.12 s")
    expect(rows.last).to_have_attribute("aria-selected", "true")
    assert numbers == rows.evaluate_all("all => all.slice(-2).map(({ id }) => id)")


TEXTS = """async ([changes, live, events]) => {
  const [{ session }, { ReplacedValues, commandText }, { batch }] = await Promise.all(
    ["store.js", "timeline/commands.js", "vendor/preact.js"].map((name) => part(name)),
  );
  const former = new ReplacedValues();
  const texts = [];
  batch(() => {
    session.value = { changes, live, parameters: {}, openings: [] };
    for (const event of events) {
      if (event[2] === "buffer") former.hold(event[1], event[3].chunk);
      if (event[2] !== "command") continue;
      former.take(event);
      texts.push(commandText(event).join(" ").trim());
    }
    session.value = null; // before the page asks the server about it
  });
  return texts;
}"""


def test_the_timeline_and_the_html_replay_have_the_same_words_for_each_registered_change(blank: Page, tmp_path: Path) -> None:
    source = (MODELS / "doorway.py").read_text(encoding="utf-8")
    trace = Trace("all")
    with Recording(tmp_path / "run.sqlite", program_facts("doorway.py", source, 1, None)) as recorded:
        trace.listen(recorded.event_alone)

        def give(word: str, *values: Any, body: str | None = None, **named: Any) -> None:
            trace.emit(0, "top", "command", {"command": word, "data": {"values": list(values), "named": named, "body": body}})

        for turn in (1, 2):
            for word, kind in CHANGES.items():
                fields = parameters_of(kind)
                samples: dict[str, Any] = {one.name: 0.12345 * turn if one.takes == "number" else f"some_{one.name}" for one in fields}
                trace.emit(0, "some_buffer", "buffer", {"chunk": {"0": "count", "next": 3.123456, "part": None} if turn == 1 else None})
                give(word, **samples)
                give(word, *samples.values())
                give(word, **{one.name: samples[one.name] for one in fields if one.required})
                give(word, *samples.values(), body="walker")
            give("move", "box", 1, 2.5, 0.5)
            for value in (1.5, True, None, "high"):
                give("parameter", "walker.speed", value)  # the parameter «speed» of the model
                give("parameter", path="walker.memory.noise", value=value)
            give("wave", turn, True, None, "high", hand="left", body="walker")
            give("pause")
    write_replay(tmp_path / "run.sqlite", tmp_path / "replay.html")
    written = [
        text for _, _, kind, text in inside((tmp_path / "replay.html").read_text(encoding="utf-8"))["events"]["rows"] if kind == "command"
    ]
    assert "speed 1.5 -> true m/s" in written
    with Recorded(tmp_path / "run.sqlite") as reading:
        events = [[0, one.source, one.kind, dict(one.data)] for one in reading.events()]
    live = [{"name": one.name, "unit": one.unit, **asdict(one.live)} for one in listing_of(source).parameters if one.live is not None]
    assert blank.evaluate(TEXTS, [json.loads(change_menu(agents_only=False)), live, events]) == written


LONG = """from actr3d.actr import *

class Agent(ACTR):
    goal = Buffer()
    other = Buffer()
    def init():
        goal.set("a")
        other.set("x 1")
    def step(goal="a", other="x ?n"):
        goal.set("b")
        other.set("x 2")
    def back(goal="b", other="x ?n"):
        goal.set("a")
        other.set("x 1")

Agent().run(600)
"""
"""A program with 60,000 events, more than the server keeps."""


@pytest.mark.slow
def test_a_long_run_that_was_changed_early_and_undone_is_shown_after_a_reload(pages: Callable[..., Page], workbench: Served) -> None:
    (workbench.folder / "long.py").write_text(LONG, encoding="utf-8")
    page = pages("long.py")
    shows(page, "#status", "at its start")

    say(page, type="run")
    shows(page, "#status", "ended")
    say(page, type="seek", time=5)
    shows(page, "#time", "t = 5.00 s")
    say(page, type="command", word="set_buffer", values=["goal", "a"], drop=True)
    shows(page, "#status", "changed at 5.00 s")
    say(page, type="undo", drop=True)
    shows(page, "#status", "undone at 5.00 s")
    page.reload()
    shows(page, "#time", "t = 5.00 s")
    # The server keeps none of these any more: the run gives them.
    until(page, lambda: page.evaluate("async () => (await part('store.js')).events.value.list.length") > 400)
