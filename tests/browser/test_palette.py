"""The command palette: every command of the page by a few letters, and the manual."""

from __future__ import annotations

import json
import re
from collections.abc import Callable
from typing import Any

import pytest
from playwright.sync_api import Locator, Page, Route, expect

from tests.helpers.page import answers, say, shows
from tests.helpers.workbench_server import Served

INDEX = {
    "docs": [
        {"location": "how-to/profile/", "title": "Profile a model", "text": "<p>It says where <b>time</b> goes.</p>"},
        {"location": "x/#y", "title": "<img src=x onerror=alert(1)>Chunks", "text": "<script>alert(1)</script><p>Time and chunks.</p>"},
        {"location": "x/", "title": "Memory", "text": ""},
        {"location": "z/", "title": "Nothing of that", "text": ""},
    ]
}


def options(page: Page) -> Locator:
    return page.get_by_role("dialog", name="Commands").get_by_role("option")


def search(page: Page, words: str) -> None:
    page.keyboard.press("Control+k")
    expect(page.get_by_role("combobox", name="Search commands")).to_be_focused()
    page.keyboard.insert_text(words)


LISTED = """async () => {
  const { permanent } = await part("commands.js");
  const shown = [...document.querySelectorAll(".palette-text")].map((one) => one.textContent);
  const isShown = ({ text }) => shown.some((one) => one.startsWith(text)); // what it would act on may follow
  return permanent().filter((one) => one.ready() && !isShown(one)).map(({ text }) => text);
}"""


def test_without_a_search_the_commands_of_all_groups_are_listed(pages: Callable[..., Page]) -> None:
    page = pages("counting.py", tab="console")
    page.click("#run")
    shows(page, "#status", "ended")
    page.keyboard.press("Control+k")
    expect(page.get_by_role("combobox", name="Search")).to_be_visible()
    assert page.evaluate(LISTED) == ["All commands, and the manual"]
    expect(page.get_by_role("group", name="Console")).to_be_visible()


def test_a_few_letters_find_a_command_and_the_last_ones_come_first(page: Page) -> None:
    shows(page, "#status", "at its start")
    search(page, "step back")
    expect(options(page).first).to_have_text("Step back by one tickRun←")
    expect(options(page).first).to_have_attribute("aria-disabled", "true")
    colour = "(element) => getComputedStyle(element).color"
    assert options(page).first.locator("b").first.evaluate(colour) == options(page).first.evaluate(
        colour
    )  # nothing of it looks as if it can be run
    page.keyboard.press("Enter")
    refusal = page.get_by_role("dialog").get_by_role("status")
    expect(refusal).to_have_text("«Step back by one tick» is not possible now. The run is at its start.")
    page.keyboard.press("Control+a")
    page.keyboard.insert_text("stp tck")
    expect(refusal).to_be_hidden()
    expect(options(page)).to_have_text(["Step by one tickRun→", "Step back by one tickRun←"])
    page.keyboard.press("Enter")
    shows(page, "#time", "0.01 s")
    search(page, "open mem")
    page.keyboard.press("Enter")
    expect(page.get_by_role("tab", name="Memory")).to_have_attribute("aria-selected", "true")
    page.get_by_label("Filter rows").focus()  # the palette opens while one types, too
    search(page, "")
    last = page.get_by_role("group", name="Used last").get_by_role("option")
    expect(last).to_have_text(["Open MemoryTab4", "Step by one tickRun→"])
    page.keyboard.press("ArrowDown")
    page.keyboard.press("Enter")
    shows(page, "#time", "0.02 s")
    matches = """async (texts) => {
      const { match } = await part("palette/fuzzy.js");
      return texts.map(([search, text]) => match(search, text) !== null);
    }"""
    texts = [
        ("push", "Run or pause, and go on from here"),
        ("compare", "goal a curve of 15 more parts"),
        ("gtl", "Go to a line"),
        ("stp", "Step"),
    ]
    assert page.evaluate(matches, texts) == [False, False, True, True]
    search(page, "xyzzyq")
    expect(page.get_by_role("dialog")).to_contain_text("Nothing is found")
    page.keyboard.press("Escape")
    expect(page.get_by_role("dialog")).to_have_count(0)
    search(page, "model counting")
    page.keyboard.press("Enter")
    expect(page.get_by_label("Model", exact=True)).to_have_value("counting.py")
    shows(page, "#status", "at its start")
    page.get_by_role("tab", name="Editor").click()
    expect(page.locator(".cm-content")).to_contain_text("class")
    page.get_by_role("tab", name="About").click()
    search(page, "editor go to a line")
    page.keyboard.press("Enter")
    expect(page.locator(".cm-gotoLine, .cm-panel")).to_contain_text("Go to line")
    names, keys = page.evaluate(
        """async () => {
          const { permanent, present } = await part("commands.js");
          const names = [...permanent(), ...present()].map(({ group, text }) => `${group}: ${text}`);
          return [names, permanent().flatMap(({ key }) => key ?? [])];
        }"""
    )
    assert len(set(names)) == len(names)
    assert len(set(keys)) == len(keys)
    for name in (
        "Run: Speed: 2 x",
        "Page: Theme: light, dark, or as the system has it",
        "Editor: Save the text",
        "Editor: Format",
        "Editor: Check: load the text, and list what is wrong",
        "Editor: Insert a snippet: a production",
        "Console: Clear the console",
        "Messages: Clear the messages",
        "Change by hand: production: Forbid once …",
        "Change by hand: buffer: Set …",
        "Model: doorway.py",
        "Recording: doorway",
    ):
        assert any(name in one for one in names), name


@pytest.mark.slow
def test_the_palette_has_the_experiments_and_what_can_be_done_with_the_present_run(pages: Callable[..., Page]) -> None:
    page = pages("counting.py")
    one: dict[str, Any] = {
        "id": "sums-20200101-101010-abcd",
        "name": "sums",
        "made": 0,
        "state": "stopped",
        "done": 3,
        "total": 8,
        "failures": 0,
    }
    one |= {"changed": {}, "model": "", "left": None, "work": []}
    page.route("**/api/experiments", lambda route: route.fulfill(json={"experiments": [one]}))
    shows(page, "#status", "at its start")
    page.click("#cycle")
    shows(page, "#time", "0.05 s")
    search(page, "experiment sums")
    for text in ("Experiment: sums", "Resume the experiment sums", "Make the report of the experiment sums"):
        expect(options(page).filter(has_text=text)).to_have_count(1)
    expect(options(page).filter(has_text="Stop the experiment")).to_have_count(0)
    page.keyboard.press("Escape")
    search(page, "new experiment")
    page.keyboard.press("Enter")
    expect(page.get_by_label("Design", exact=True)).to_be_visible()
    for words in ("download events present run", "replay present run", "delete present run", "compare present run"):
        search(page, words)
        expect(options(page).first).to_contain_text("the present run")
        page.keyboard.press("Escape")
    for words, text in (("share", "Copy a link"), ("export", "Save the timeline"), ("svg", "Save the timeline")):
        search(page, words)
        expect(options(page).filter(has_text=text)).to_have_count(1)
        page.keyboard.press("Escape")
    search(page, "name note tags present run")
    page.keyboard.press("Enter")
    expect(page.get_by_role("dialog", name="Name of the run")).to_be_visible()


def test_a_model_is_found_before_its_many_recordings(pages: Callable[..., Page]) -> None:
    page = pages("counting.py")

    def many(route: Route) -> None:
        answer = route.fetch().json()
        (one, *_) = answer["recordings"]
        copies = [{**one, "id": f"{one['id']}-{number}", "made": one["made"] - 60 * number} for number in range(70)]
        route.fulfill(json={**answer, "recordings": copies, "total": len(copies)})

    page.route("**/api/recordings?*", many)
    shows(page, "#status", "at its start")
    page.click("#cycle")
    shows(page, "#time", "0.05 s")
    search(page, "counting.py")
    expect(options(page).filter(has_text="Recording: counting.py")).not_to_have_count(1)
    expect(options(page).first).to_contain_text("Model: counting.py")
    page.unroute_all(behavior="wait")  # the page asks again, perhaps while it closes


REFUSED_WITHOUT_REASON = """async () => {
  const { permanent } = await part("commands.js");
  return permanent().filter((one) => !one.ready() && !one.why()).map(({ text }) => text);
}"""


def test_each_command_that_is_not_possible_says_why_and_none_is_offered_that_a_run_refuses(pages: Callable[..., Page]) -> None:
    page = pages("doorway.py")
    shows(page, "#status", "at its start")
    assert page.evaluate(REFUSED_WITHOUT_REASON) == []
    expect(page.locator("#aperture")).to_be_enabled()
    page.locator("body").press("+")  # there is none above «fastest»
    say(page, type="until", time=20)
    shows(page, "#status", "ended")
    assert page.evaluate(REFUSED_WITHOUT_REASON) == []
    expect(page.locator("#aperture")).to_be_disabled()
    expect(page.locator(".aperture")).to_have_attribute("title", "The run is over: go back to an earlier time, or restart it.")
    expect(page.get_by_role("button", name="Move, push …")).to_be_disabled()
    page.keyboard.press("Control+k")
    page.get_by_role("combobox", name="Search commands").fill("Set the width")
    option = page.get_by_role("option").filter(has_text="Set the width").first
    expect(option).to_have_attribute("aria-disabled", "true")
    page.get_by_role("combobox", name="Search commands").fill("Faster")
    page.keyboard.press("Enter")
    expect(page.locator(".palette-refusal")).to_have_text("«Faster» is not possible now. The speed is «fastest» already.")
    page.keyboard.press("Escape")
    page.evaluate("async () => void (await (await part('timeline/seek.js')).seek(1))")
    shows(page, "#time", r"t = 1\.00 s")
    expect(page.locator("#aperture")).to_be_enabled()
    page.click("#stop")
    shows(page, "#status", "stopped")
    assert page.evaluate(REFUSED_WITHOUT_REASON) == []
    expect(page.get_by_role("button", name="Make a video of the 3D view")).to_be_disabled()


def test_the_palette_opens_again_as_soon_as_it_is_closed(page: Page) -> None:
    shows(page, "#status", "at its start")
    search(page, "step")
    page.evaluate(
        """() => {
          const field = document.activeElement; // which has the focus for a moment after the dialog has closed
          document.querySelector("dialog").close();
          field.dispatchEvent(new KeyboardEvent("keydown", { key: "k", ctrlKey: true, bubbles: true, cancelable: true }));
        }"""
    )
    expect(page.get_by_role("combobox", name="Search commands")).to_have_value("")
    expect(page.get_by_role("combobox", name="Search commands")).to_be_focused()
    page.keyboard.press("Escape")
    expect(page.get_by_role("dialog")).to_have_count(0)


def test_the_palette_finds_pages_of_the_manual_and_shows_them_as_text(pages: Callable[..., Page], workbench: Served) -> None:
    page = pages("counting.py")
    shows(page, "#status", "at its start")
    missing = "The manual has not been built. In a copy of the repository: uv run mkdocs build"
    listing = workbench.get("/api/models").json()
    answers(page, "/api/models", {**listing, "manual": False, "no_manual": missing})
    page.reload()
    shows(page, "#status", "at its start")
    search(page, "time chunk")
    expect(page.get_by_role("dialog")).to_contain_text(f"Nothing is found: try other words.{missing}")
    expect(page.get_by_role("group", name="Manual")).to_have_count(0)
    page.keyboard.press("Escape")
    page.context.route("**/manual/**", lambda route: route.fulfill(body=json.dumps(INDEX), content_type="application/json"))
    answers(page, "/api/models", {**listing, "manual": True, "no_manual": None})  # while the page is open
    search(page, "time chunk")
    found = page.get_by_role("group", name="Manual").get_by_role("option")
    expect(found).to_have_text(["ChunksMemory: alert(1) Time and chunks."])
    expect(page.get_by_role("dialog")).not_to_contain_text(missing)
    page.keyboard.press("Control+a")
    page.keyboard.insert_text("where time goes")
    expect(found).to_have_text(["Profile a modelIt says where time goes."])
    with page.context.expect_page() as opened:
        found.click()
    assert opened.value.url.endswith("/manual/how-to/profile/")


@pytest.mark.slow
def test_the_palette_sets_parameters_clears_messages_and_switches_to_other_open_runs(pages: Callable[..., Page], workbench: Served) -> None:
    page = pages("counting.py")
    shows(page, "#status", "at its start")
    search(page, "model doorway")
    page.keyboard.press("Enter")
    shows(page, "#width", "50 cm")
    search(page, "set speed")
    expect(options(page).first).to_have_text("Set speed: 1.2 m/sParameters")
    page.keyboard.press("Enter")
    expect(page.locator("#parameter-speed")).to_be_focused()
    search(page, "set width 0.8")
    expect(options(page).first).to_have_text("Set width to 0.8Parameters")
    page.keyboard.press("Enter")
    shows(page, "#width", "80 cm")
    expect(page.locator("#parameter-width")).to_be_focused()
    search(page, "set speed 9")  # more than it may be
    expect(options(page).filter(has_text="Set speed to 9")).to_have_count(0)
    page.keyboard.press("Escape")
    page.evaluate("""async () => (await part("store.js")).notify("something")""")
    search(page, "clear messages")
    page.keyboard.press("Enter")
    expect(page.locator(".messages .empty")).to_contain_text("No messages")
    search(page, "switch counting")
    expect(options(page).first).to_have_text("Switch to the open run of counting.py: pausedOpen runs")
    page.keyboard.press("Enter")
    expect(page.get_by_label("Model", exact=True)).to_have_value("counting.py")


@pytest.mark.slow
def test_the_focus_returns_to_where_it_was_when_what_a_command_has_opened_is_closed(pages: Callable[..., Page]) -> None:
    page = pages("counting.py", tab="buffers")
    shows(page, "#status", "at its start")
    page.get_by_role("tab", name="Buffers").focus()
    for words, title in (("run until", "Run until"), ("help keys", "Help"), ("set buffer", "Set")):
        search(page, words)
        page.keyboard.press("Enter")
        expect(page.get_by_role("dialog", name=title)).to_be_visible()
        page.keyboard.press("Escape")
        expect(page.get_by_role("dialog")).to_have_count(0)
        expect(page.get_by_role("tab", name="Buffers")).to_be_focused()
    search(page, "step by one tick")
    page.keyboard.press("Enter")
    shows(page, "#time", "0.01 s")
    expect(page.get_by_role("tab", name="Buffers")).to_be_focused()


def test_a_command_that_opens_a_tab_moves_the_focus_to_its_panel(pages: Callable[..., Page]) -> None:
    page = pages("counting.py", tab="buffers")
    shows(page, "#status", "at its start")
    page.get_by_role("tab", name="Buffers").focus()
    for words, title in (
        ("open memory", "Memory"),
        ("open memory", "Memory"),
        ("open their list", "Runs"),
        ("open experiments", "Experiments"),
    ):
        search(page, words)
        page.keyboard.press("Enter")
        expect(page.get_by_role("tabpanel", name=title)).to_be_focused()
    page.keyboard.press("3")
    expect(page.get_by_role("tabpanel", name="Productions")).to_be_focused()
    page.keyboard.press("Tab")
    assert page.evaluate("document.activeElement.closest('[role=tabpanel]') !== null")
    page.get_by_role("tab", name="Editor").click()
    expect(page.locator(".cm-content")).to_contain_text("class")
    page.get_by_role("tab", name="Buffers").click()
    expect(page.get_by_role("tab", name="Buffers")).to_be_focused()
    search(page, "go to a line")
    page.keyboard.press("Enter")
    expect(page.locator(".cm-panel input")).to_be_focused()


def test_the_palette_finds_what_a_button_of_the_scene_is_called(page: Page) -> None:
    shows(page, "#status", "at its start")
    search(page, "Move, push")
    expect(page.get_by_role("listbox", name="Found").get_by_role("option").first).to_contain_text("Move, push …")
    page.keyboard.press("Enter")
    dialog = page.get_by_role("dialog", name="Change by hand")
    expect(dialog.get_by_role("button", name="Push …")).to_be_visible()
    page.keyboard.press("Escape")


@pytest.mark.slow
def test_in_a_notebook_no_command_or_key_of_a_models_folder_exists(pages: Callable[..., Page], workbench: Served) -> None:
    page = pages("doorway.py")
    shows(page, "#status", "at its start")
    page.click("#step")
    shows(page, "#time", "0.01 s")
    session = page.evaluate("async () => (await part('store.js')).session.value.id")
    page.goto(f"{page.url.partition('?')[0]}?session={session}")
    shows(page, "#time", "0.01 s")
    search(page, "step by one tick")
    expect(options(page).first).to_have_text("Step by one tickRun→")
    page.keyboard.press("Enter")
    shows(page, "#time", "0.02 s")
    for words, wrong in (
        ("new model", "New model"),
        ("model doorway", "Model: "),
        ("recording", "[Rr]ecording"),
        ("open", "Open (run|About|Editor|Experiments|Parameters|Runs)|their list"),
        ("experiment", "xperiment"),
        ("snippet", "snippet"),
        ("save text", "Save the text"),
        ("restart", "Restart|Stop"),
        ("set speed", "Set speed"),
        ("link", "link"),
    ):
        search(page, words)
        page.wait_for_load_state("networkidle")  # what is listed when the palette is opened is there
        # The manual has pages on all of these.
        commands = page.get_by_role("group", name="Commands").get_by_role("option").all_text_contents()
        assert not re.search(wrong, "\n".join(commands)), words
        page.keyboard.press("Escape")
    page.locator("body").press("Shift+R")
    page.locator("body").press("?")
    keys = page.get_by_role("dialog", name="Help")
    expect(keys).to_contain_text("Step by one tick")
    expect(keys).not_to_contain_text(re.compile("Editor|Restart|Stop the model|Parameters|chosen runs"))
    shows(page, "#time", "0.02 s")


def test_the_command_that_opens_the_editor_puts_the_cursor_into_the_text(pages: Callable[..., Page]) -> None:
    page = pages("counting.py", tab="buffers")
    shows(page, "#status", "at its start")
    page.get_by_role("tab", name="Buffers").focus()
    search(page, "open editor")  # before its text was read
    page.keyboard.press("Enter")
    text = page.locator(".cm-content")
    expect(text).to_be_focused()
    page.keyboard.press("Escape")
    page.keyboard.press("Tab")
    expect(text).not_to_be_focused()
    page.get_by_role("tab", name="Buffers").click()
    page.keyboard.press("8")
    expect(text).to_be_focused()
    search(page, "open console")
    page.keyboard.press("Enter")
    expect(page.get_by_role("tabpanel", name="Console")).to_be_focused()
