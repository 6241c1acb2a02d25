"""Branches in a real browser: the notice that one was kept, how it is listed, and what is said where none was made."""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import asdict

import pytest
from playwright.sync_api import Locator, Page, expect

from tests.helpers.page import answers, becomes_true, open_tab, say, shows, until
from tests.helpers.workbench_server import Served
from workbench.recording_index import Summary


def change_the_past(page: Page) -> None:
    """Runs the doorway to 1 s, goes back to 0.5 s, and changes the width there."""
    say(page, type="until", time=1.0)
    shows(page, "#status", r"at 1 s")
    say(page, type="seek", time=0.5)
    shows(page, "#time", r"0\.50 s")
    say(page, type="command", word="aperture", values=[0.9])
    shows(page, "#status", r"changed at 0\.50 s")


TREES = """async () => {
  const { treeOf, sameUntil } = await part("runs/tree.js");
  const run = (id, origin = null, branched = null, ancestors = []) => ({ id, origin, branched, ancestors, kept: null, made: 0 });
  const all = [run("a"), run("b", "a", 3), run("c", "b", 5, [["a", 3]]), run("d", "c", 2, [["b", 5], ["a", 3]]), run("other")];
  return ["", "b", "c", "a", "ab"].map((gone) => {
    const left = all.filter(({ id }) => !gone.includes(id));
    return [treeOf(left, "d").map(({ run, depth }) => `${depth}${run.id}`).join(" "), sameUntil(left, "d", gone.includes("b") ? "c" : "b")];
  });
}"""


def test_a_branch_below_a_deleted_recording_follows_the_nearest_one_that_it_comes_from(page: Page) -> None:
    trees = [["0a 1b 2c 3d", 2], ["0a 1c 2d", 2], ["0a 1b 2d", 2], ["0b 1c 2d", 2], ["0c 1d", 2]]
    assert page.evaluate(TREES) == trees
    siblings = """async () => {
      const { treeOf, sameUntil } = await part("runs/tree.js");
      const run = (id, at) => ({ id, origin: "gone", branched: at, ancestors: [], kept: null, made: 0 });
      const both = [run("e", 4), run("f", 2)];
      return [treeOf(both, "e").map(({ run, depth }) => depth + run.id), sameUntil(both, "e", "f")];
    }"""
    assert page.evaluate(siblings) == [["0f", "0e"], 2]
    renamed = """async () => {
      const [{ treeOf }, { runs, total, withPresentNames }, { originText }] = await Promise.all(
        ["runs/tree.js", "runs/list.js", "runs/wording.js"].map((name) => part(name)),
      );
      const same = { ancestors: [], kept: null, made: 0 };
      const run = (id, named, origin = null, branched = null) => ({ ...same, id, named, origin, branched, model: id });
      const all = [run("new", "old"), run("b", "b", "old", 3), run("c", "c", "gone", 2)];
      const known = withPresentNames(all);
      const trees = ["b", "c"].map((id) => treeOf(known, id).map(({ run, depth }) => depth + run.id));
      runs.value = known;
      const said = (of) => {
        total.value = of;
        return all.slice(1).map((run) => originText(run, known).replace(/ of new .*/, " of new"));
      };
      return [...trees, said(4), said(3)];
    }"""
    told = [["at 3.00 s of new", "at 2.00 s"], ["at 3.00 s of new", "at 2.00 s of a recording that was deleted"]]
    assert page.evaluate(renamed) == [["0new", "1b"], ["0c"], *told]  # while the list is read, the others may be in the rest of it
    reused = """async () => {
      const [{ treeOf }, { withPresentNames }] = [await part("runs/tree.js"), await part("runs/list.js")];
      const run = (id, named, origin, branched) => ({ id, named, origin, branched, ancestors: [], kept: null, copied: null, made: 0 });
      const known = withPresentNames([run("a", "b", null, null), run("c", "c", "a", 3)]);
      return treeOf(known, "c").map(({ run, depth }) => depth + run.id);
    }"""
    assert page.evaluate(reused) == ["0c"]  # the recording «a» from which it comes was deleted, and another one is called so now
    copies = """async () => {
      const { treeOf, sameUntil } = await part("runs/tree.js");
      const run = (id, branched, kept, copied) => ({ id, origin: branched && "r", branched, ancestors: [], kept, copied, made: 0 });
      const all = [run("r", null, null, null), run("r1", 8, 1, ["r", 8]), run("b1", 3, null, null), run("c1", 5, 2, ["b1", 3])];
      all[2].origin = "c1";
      return [treeOf(all, "r").map(({ run, depth }) => depth + run.id), sameUntil(all, "r1", "c1")];
    }"""
    assert page.evaluate(copies) == [["0r", "1c1", "2b1", "1r1"], 5]  # r1 is a copy of the run r, c1 one of its branch b1


NAMES = """async () => {
  const [{ runs }, wording] = await Promise.all(["runs/list.js", "runs/wording.js"].map((name) => part(name)));
  const run = (id, branched, number = 1, name = "") => ({ id, branched, number, made: 0, model: "walk.py", label: name ? { name } : null });
  runs.value = [run("a", null), run("c", 2, 2), run("b", 2), run("d", 2, 1, "mine"), run("e", 4, 2, "mine")];
  const when = wording.whenText(0);
  const { nameInTree, nameOf, beginningText, openText } = wording;
  const open = ({ id }) => openText({ recorded: id, model: "walk.py" }, runs.value);
  const texts = runs.value.map((one) => [nameInTree(one), nameOf(one), beginningText(one), beginningText(one, true), open(one)]);
  return texts.map((all) => all.map((text) => text.replace(when, "then")));
}"""


def test_a_branch_has_the_same_name_everywhere_with_the_number_that_the_server_has_given_it(blank: Page) -> None:
    assert blank.evaluate(NAMES) == [
        ["then", "walk.py then", "then", "then", "recording walk.py then"],
        [
            "at 2.00 s (2)",
            "walk.py then branch at 2.00 s (2)",
            "then, branch at 2.00 s (2)",
            "then, branch at 2.00 s (2)",
            "recording walk.py then branch at 2.00 s (2)",
        ],
        [
            "at 2.00 s",
            "walk.py then branch at 2.00 s",
            "then, branch at 2.00 s",
            "then, branch at 2.00 s",
            "recording walk.py then branch at 2.00 s",
        ],
        ["mine", "mine", "then, branch at 2.00 s", "mine, branch at 2.00 s", "recording mine"],
        ["mine (2)", "mine (2)", "then, branch at 4.00 s", "mine (2), branch at 4.00 s", "recording mine (2)"],
    ]


SETTINGS = """async () => {
  const { differentText, settingsOf, textOf } = await part("runs/wording.js");
  const parameters = { aperture: 0.25, speed: 1, seen: true };
  const run = { id: "a", parameters, different: ["aperture"], made: 0, result: {}, branched: null };
  const all = [{}, { aperture: 0.27, door: 0.5, seen: null }].map((changed) => ({ ...run, changed }));
  return [all.map(differentText), settingsOf(all[1]).length, all.map((one) => textOf(one).includes("aperture 0.25 → 0.27"))];
}"""


def test_a_list_of_runs_shows_and_finds_values_that_were_changed_by_hand(blank: Page) -> None:
    texts, settings, found = blank.evaluate(SETTINGS)
    assert texts == ["aperture 0.25", "aperture 0.25 → 0.27, seen true → none, door – → 0.5"]
    assert (settings, found) == (4, [False, True])


SIDES = """async (sessions) => {
  const [{ SideBySide }, { html, render }] = await Promise.all(["compare/sides.js", "vendor/preact.js"].map((name) => part(name)));
  const same = { model: "walk.py", seed: 1, label: {}, made: 0, branched: null, time: 1, events: 5 };
  const run = (session, size) => ({ ...same, session, size });
  const runs = [run(sessions[0], 90_000), run(sessions[1], 50_000)];
  const box = document.createElement("div");
  render(html`<${SideBySide} runs=${runs} changed=${[{}, {}]} units=${{}} />`, box);
  return [...box.querySelectorAll("tr.other")].map((row) => row.textContent);
}"""


def test_the_size_of_a_recording_that_is_still_written_is_no_difference_of_two_runs(blank: Page) -> None:
    assert blank.evaluate(SIDES, [None, None]) == ["≠size90 kB50 kB"]
    assert not [row for row in blank.evaluate(SIDES, ["1", None]) if "size" in row]


SHOWN_SPAN = "async () => { const { from, to } = (await part('timeline/view.js')).span.value; return [from, to]; }"


def test_the_axis_goes_as_far_as_the_longest_branch_unless_branches_are_hidden(page: Page) -> None:
    shows(page, "#status", "at its start")
    name = page.evaluate("async () => (await part('store.js')).shownRecording.value")
    start = {**asdict(Summary(id=name, named=name, model="doorway.py", size=0, made=0.0)), "session": "1", "label": None}
    branch = {**start, "id": "branch", "named": "branch", "session": None, "origin": name, "branched": 2.0, "ended": "left", "time": 7.0}
    answers(page, "/api/recordings", {"total": 2, "recordings": [start, branch], "warning": None})
    page.evaluate("async () => (await part('runs/list.js')).listRuns()")
    head = page.locator(".branches-head")
    expect(head).to_have_text("1 branch")
    until(page, lambda: page.evaluate(SHOWN_SPAN) == [0, 8])
    head.click()
    until(page, lambda: page.evaluate(SHOWN_SPAN) == [0, 1])
    head.click()
    until(page, lambda: page.evaluate(SHOWN_SPAN) == [0, 8])


def test_what_another_server_has_recorded_is_listed_when_the_user_returns_to_the_page(page: Page) -> None:
    shows(page, "#status", "at its start")
    name = page.evaluate("async () => (await part('store.js')).shownRecording.value")
    becomes_true(page, "async () => (await part('runs/list.js')).runs.value?.some(({ id }) => id === name)".replace("name", repr(name)))
    start = {**asdict(Summary(id=name, named=name, model="doorway.py", size=0, made=0.0)), "session": "1", "label": None}
    branch = {**start, "id": "branch", "named": "branch", "session": None, "origin": name, "branched": 2.0, "ended": "left", "time": 7.0}
    answers(page, "/api/recordings", {"total": 2, "recordings": [start, branch], "warning": None})
    page.wait_for_timeout(300)
    expect(page.locator(".branches-head")).to_have_count(0)
    page.evaluate("dispatchEvent(new Event('focus'))")
    expect(page.locator(".branches-head")).to_have_text("1 branch")


@pytest.mark.slow
def test_a_branch_is_deleted_by_its_name_and_its_notice_goes_with_it(page: Page) -> None:
    shows(page, "#status", "at its start")
    change_the_past(page)
    expect(page.locator(".branched")).to_have_count(1)
    expect(page.locator(".branches-head")).to_have_text("1 branch")
    page.get_by_role("button", name="Delete at 0.50 s").click()
    dialog = page.get_by_role("dialog")
    expect(dialog).to_contain_text(re.compile(r"Delete the recording «doorway\.py .* branch at 0\.50 s»[?]"))
    dialog.get_by_role("button", name="Delete").click()
    expect(page.locator(".branched")).to_have_count(0)
    expect(page.locator(".branches")).to_have_count(0)
    assert page.evaluate("async () => (await part('store.js')).session.value.branched.kept") is False  # on other pages, too
    until(page, lambda: page.evaluate("document.activeElement !== document.body"))


@pytest.mark.slow
def test_a_branch_of_a_paused_run_is_not_listed_as_ended_and_its_notice_is_shown_once(page: Page) -> None:
    shows(page, "#status", "at its start")
    change_the_past(page)
    shows(page, ".branched", r"The run up to 1\.00 s is kept as a branch")
    open_tab(page, "Runs")
    row = page.locator("tr[data-run]", has_text="branch at 0.50 s")
    expect(row.locator(".outcome")).to_have_text(re.compile("not finished.*its past was changed"))
    expect(row).to_contain_text("1.00 s")
    page.reload()
    shows(page, "#status", r"changed at 0\.50 s")
    expect(page.locator(".branched")).to_have_count(0)
    say(page, type="step", ticks=10)
    shows(page, "#time", r"0\.60 s")
    say(page, type="seek", time=0.2)
    say(page, type="command", word="aperture", values=[0.8])
    shows(page, ".branched", r"The run up to 0\.60 s is kept as a branch")  # it is another one
    # The first branch leaves the second one: the run has another past since then.
    names = page.locator(".branches .branch-name")
    expect(names).to_have_text([re.compile(r"\d+:\d+:\d+"), "└ at 0.20 s", "└ at 0.50 s"])
    assert names.evaluate_all("all => all.map((one) => one.style.paddingLeft)") == ["8px", "18px", "28px"]
    page.get_by_role("button", name="Dismiss").click()
    expect(page.locator(".branched")).to_have_count(0)
    # All changes of one moment are in one mark, each as one undo takes it back.
    say(page, type="command", word="move", named={"object": "walker", "x": 1.0, "y": 0.5})
    say(page, type="command", word="aperture", values=[0.7])
    marks = "async () => (await part('timeline/record.js')).lanes.lane('commands').bands.map(({ text }) => text)"
    until(page, lambda: page.evaluate(marks) == ["aperture 50 -> 80 cm; move walker to (1, 0.5) m; aperture 80 -> 70 cm"])


@pytest.mark.slow
def test_a_run_that_goes_another_way_after_its_end_is_listed_as_such_at_once(page: Page) -> None:
    shows(page, "#status", "at its start")
    open_tab(page, "Runs")
    say(page, type="run")
    present = page.locator("tr.present")
    expect(present).to_contain_text("the model called stop()")
    say(page, type="seek", time=2.0)
    shows(page, "#time", r"2\.00 s")
    say(page, type="command", word="aperture", values=[0.9])
    expect(present).to_contain_text("not over")
    expect(present).to_contain_text("2.00 s")
    expect(page.locator("tr[data-run]", has_text="branch at 2.00 s")).to_contain_text("the model called stop()")


@pytest.mark.slow
def test_a_recording_that_is_changed_is_not_said_to_have_a_branch(pages: Callable[..., Page], workbench: Served) -> None:
    page = pages()
    shows(page, "#status", "at its start")
    say(page, type="until", time=1.0)
    shows(page, "#status", r"at 1 s")
    name = page.evaluate("async () => (await part('store.js')).session.value.recording")
    for one in workbench.get("/api/sessions").json()["sessions"]:
        workbench.post(f"/api/sessions/{one['id']}/close")
    page.goto(f"{page.url.partition('?')[0]}?run={name}")
    expect(page.locator(".recording-banner")).to_contain_text("1.00 s recorded")
    change_the_past(page)
    shows(page, ".branched", r"The recording keeps the run up to 1\.00 s")
    expect(page.locator(".branched")).not_to_contain_text("branch")


@pytest.mark.slow
def test_the_banner_of_a_branch_has_its_name_with_its_number(pages: Callable[..., Page], workbench: Served) -> None:
    page = pages("counting.py")
    shows(page, "#status", "at its start")
    page.click("#cycle")
    shows(page, "#time", "0.05 s")
    name = page.evaluate("async () => (await part('store.js')).session.value.recording")
    for one in workbench.get("/api/sessions").json()["sessions"]:
        workbench.post(f"/api/sessions/{one['id']}/close")
    run = {**asdict(Summary(id=name, named=name, model="counting.py", size=0, made=0.0)), "session": None, "branched": 0.03, "number": 2}
    for label, shown in ((None, "branch at 0.03 s (2)"), ({"name": "same"}, "same (2)")):
        answers(page, "/api/recordings", {"total": 1, "recordings": [{**run, "label": label}], "warning": None})
        page.goto(f"{page.url.partition('?')[0]}?run={name}")
        expect(page.locator(".recording-banner .name")).to_have_text(shown)
        expect(page.locator(".recording-banner .name")).to_have_attribute("title", name)


WHOLE = """() => {
  const box = (one) => one.getBoundingClientRect();
  const facts = document.querySelector(".facts");
  const isWhole = (one) => box(one).left >= box(facts).left && box(one).right <= box(facts).right && one.scrollWidth <= one.clientWidth;
  const seen = [...facts.children].filter((one) => box(one).top < box(facts).bottom);
  const whole = [...document.querySelectorAll("#status, #connection, .former > span")].every((one) => one.scrollWidth <= one.clientWidth);
  return [whole && seen.every(isWhole), seen.length];
}"""
"""Returns whether no text of the status line is cut, and how many facts are seen."""


@pytest.mark.slow
def test_in_the_status_line_facts_are_left_out_before_a_text_is_cut(pages: Callable[..., Page]) -> None:
    page, other = pages(), pages()
    shows(page, "#status", "at its start")
    shows(other, "#status", "at its start")
    change_the_past(page)
    expect(page.locator("#browsers")).to_have_text("2 pages show this run, you are in control")
    for width, seen in ((1920, 4), (1280, 3), (853, 0)):
        page.set_viewport_size({"width": width, "height": 533})
        until(page, lambda seen=seen: page.evaluate(WHOLE) == [True, seen])
    page.get_by_role("button", name="Delete at 0.50 s").click()
    page.get_by_role("dialog").get_by_role("button", name="Delete").click()
    expect(page.locator(".branches")).to_have_count(0)


@pytest.mark.slow
def test_branches_from_one_moment_have_names_of_their_own_and_say_what_was_changed(pages: Callable[..., Page]) -> None:
    page = pages("counting.py")
    shows(page, "#status", "at its start")
    page.click("#run")
    shows(page, "#status", "ended")
    say(page, type="seek", time=0.12)
    shows(page, "#time", r"0\.12 s")
    say(page, type="command", word="set_buffer", named={"buffer": "goal", "chunk": "goal:count"})
    shows(page, "#status", r"changed at 0\.12 s")
    page.click("#run")
    shows(page, "#status", "ended")
    say(page, type="undo")
    shows(page, "#status", "undone")
    names = page.locator(".branches .branch-name")
    expect(names).to_have_text([re.compile(r"\d+:\d+:\d+"), "└ at 0.12 s", "└ at 0.12 s (2)"])
    expect(names.nth(1)).to_have_attribute("title", re.compile("from 0.12 s on: no change by hand"))
    expect(names.nth(2)).to_have_attribute("title", re.compile("from 0.12 s on: set buffer goal goal:count"))
    buttons = page.get_by_role("region", name="Branches").locator(".branch-actions button")
    said = buttons.evaluate_all("all => all.map((one) => one.ariaLabel)")
    assert len(said) == len(set(said)) == 7
    open_tab(page, "Runs")
    expect(page.locator("tr[data-run]", has_text="branch at 0.12 s (2)")).to_have_count(1)
    page.get_by_role("button", name="Compare at 0.12 s (2)").click()
    expect(page.locator(".compare-runs")).to_contain_text("branch at 0.12 s (2)")
    page.get_by_role("button", name="Close").click()
    page.get_by_role("button", name="Delete at 0.12 s (2)").click()
    expect(page.get_by_role("dialog")).to_contain_text(re.compile(r"Delete the recording «counting\.py .* branch at 0\.12 s \(2\)»[?]"))
    page.get_by_role("dialog").get_by_role("button", name="Cancel").click()


NAMED = "document.activeElement.ariaLabel || document.activeElement.textContent.trim()"


def reached(page: Page, name: str) -> list[str]:
    """Goes to a button by the Tab key, from the timeline; returns the names of the elements before it, the nearest first."""
    page.locator("#timeline").focus()
    passed: list[str] = []
    for _ in range(20):
        now = page.evaluate(NAMED)
        if now == name:
            return passed
        passed.insert(0, now)
        page.keyboard.press("Tab")
    raise AssertionError(f"the button {name!r} is not reached")


def offer(page: Page) -> Locator:
    """Makes the page show a message with an action; returns it."""
    page.evaluate(
        """async () => (await part("store.js")).notify("It is in the trash folder.", "info", { text: "Restore", work: () => {} })"""
    )
    toast = page.locator(".toast")
    expect(toast).to_be_visible()
    return toast


def test_a_message_stays_while_the_pointer_or_the_focus_is_in_it(page: Page) -> None:
    shows(page, "#status", "at its start")
    page.clock.install()

    def stays(toast: Locator) -> None:
        page.clock.run_for(30_000)
        expect(toast).to_be_visible()

    def goes(toast: Locator) -> None:
        page.clock.run_for(7_000)
        expect(toast).to_be_visible()
        page.clock.run_for(3_000)
        expect(toast).to_have_count(0)

    toast = offer(page)
    toast.hover()
    stays(toast)
    page.mouse.move(0, 0)
    goes(toast)
    toast = offer(page)
    toast.get_by_role("button", name="Restore").focus()
    stays(toast)
    page.locator("#timeline").focus()
    goes(toast)


def test_a_message_does_not_come_back_after_the_messages_were_read(page: Page) -> None:
    shows(page, "#status", "at its start")
    page.clock.install()
    for held in (False, True):
        toast = offer(page)
        if held:
            toast.hover()
        page.get_by_role("tab", name="Messages").press("Enter")
        expect(toast).to_have_count(0)
        page.clock.run_for(10_000)
        page.get_by_role("tab", name="Buffers").press("Enter")
        expect(page.get_by_role("tabpanel", name="Buffers")).to_be_visible()
        expect(toast).to_have_count(0)


def test_a_button_that_its_own_press_removes_gives_the_focus_back(page: Page) -> None:
    shows(page, "#status", "at its start")

    def removes(button: str, notice: str, others: int) -> None:
        """Presses it; the buttons before it in the notice are removed, too."""
        passed = reached(page, button)
        page.keyboard.press("Enter")
        expect(page.locator(notice)).to_have_count(0)
        until(page, lambda: page.evaluate(NAMED) == passed[others])

    for button, others in (("Restore", 0), ("Close", 2)):
        offer(page)
        removes(button, ".toast", others)
    offer(page)
    reached(page, "Show")
    page.keyboard.press("Enter")
    expect(page.get_by_role("tabpanel", name="Messages")).to_be_focused()
    page.get_by_role("tab", name="Buffers").click()
    change_the_past(page)
    removes("Dismiss", ".branched", 1)


def test_before_a_run_is_deleted_the_page_says_that_its_branches_stay(page: Page) -> None:
    shows(page, "#status", "at its start")
    ask = """async (ids) => {
      const { runs } = await part("runs/list.js");
      const { deleteRuns } = await part("runs/actions.js");
      const run = (id, origin = null) => ({
        id, origin, ancestors: [], branched: origin && 1, copied: null, session: null, label: { name: id }, model: "doorway.py", made: 0,
      });
      runs.value = [run("a"), run("b", "a"), run("c", "a"), run("d", "c")];
      deleteRuns(runs.value.filter(({ id }) => ids.includes(id)));
    }"""
    for ids, text in (
        ("a", "trash. Its 2 branches stay."),
        ("c", "trash. Its branch stays."),
        ("ab", "trash. Their branch stays."),
        ("d", "trash."),
    ):
        page.evaluate(ask, ids)
        dialog = page.get_by_role("dialog")
        expect(dialog).to_contain_text("to the trash folder")
        expect(dialog.locator("p")).to_have_text(re.compile(rf"{re.escape(text)}$"))
        dialog.get_by_role("button", name="Cancel").click()
        expect(dialog).to_have_count(0)
