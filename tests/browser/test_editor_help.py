"""Help while writing, in a real browser: completions, documentation, definitions, renaming, formatting, and pieces to insert."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Locator, Page, Request, expect

from tests.helpers.page import holding, open_tab, shows, until
from tests.helpers.workbench_server import Served

CODE = ".code .cm-content"
LOOK = (Path(__file__).parent / "access.js").read_text(encoding="utf-8")
SHORT = """from actr3d.actr import *


class Agent(ACTR):
    goal = Buffer()
    facts = Buffer()
    memory = Memory(facts)

    def init():
        memory.add("word:dog meaning:pet")
        goal.set("task:ask word:dog")

    def ask(goal="task:ask word:?word"):
        memory.request("word:?word")
        print(word)
"""


@pytest.fixture
def opened(pages: Callable[..., Page], workbench: Served) -> Callable[[str], Page]:
    """Opens a text in the editor."""

    def open_text(text: str) -> Page:
        (workbench.folder / "written.py").write_text(text, encoding="utf-8")
        page = pages("counting.py")
        shows(page, "#status", "at its start")
        open_tab(page, "Editor")
        page.get_by_label("File", exact=True).select_option("written.py")
        expect(page.locator(f"{CODE}[aria-label*='written.py']")).to_be_visible()
        return page

    return open_text


def at_end_of(page: Page, line: str) -> None:
    """Places the cursor at the end of a line."""
    page.locator(".cm-line", has_text=line).first.click()
    page.keyboard.press("End")


SLOW = """() => {
    const ask = fetch;
    window.fetch = (...request) => new Promise((done) => setTimeout(done, 400)).then(() => ask(...request));
}"""
"""Lets the server's answers come late, when more has been written."""


def has_line(page: Page, text: str) -> Any:
    return expect(page.locator(CODE)).to_have_text(re.compile(re.escape(text)))


def choose(page: Page, label: str) -> None:
    """Chooses a completion, which is there."""
    option = page.locator(".cm-tooltip-autocomplete li", has_text=re.compile(rf"^{re.escape(label)}"))
    expect(option).to_be_visible()
    option.click()


def hover_until_told(page: Page, place: Locator) -> None:
    """Moves the pointer over a place until its documentation is shown, as a user does where the text was still being read."""

    def told() -> bool:
        page.mouse.move(0, 0)
        place.hover()
        page.wait_for_timeout(1500)
        return page.locator(".documentation").count() > 0

    until(page, told)


@pytest.mark.slow
def test_help_while_writing(opened: Callable[[str], Page]) -> None:
    page = opened(SHORT)
    at_end_of(page, "print(word)")
    page.keyboard.type("\n\nde")  # two lines, the second of which is not in the body any more
    page.keyboard.press("Escape")
    page.keyboard.press("Backspace")
    page.keyboard.press("Backspace")
    page.keyboard.press("Shift+Tab")
    page.keyboard.type("def answer(")
    choose(page, "facts")
    page.keyboard.type("m")
    choose(page, "meaning")
    page.keyboard.type("p")  # the values of the slot are offered at once
    choose(page, "pet")
    has_line(page, 'def answer(facts="meaning:pet")')
    hover_until_told(page, page.locator(".cm-line", has_text="memory = Memory").get_by_text("Memory"))
    shows(page, ".documentation", "Declarative memory: stores chunks")
    text = page.locator(".documentation p").inner_text()
    assert "Without a threshold, a failure" in text  # where the docstring breaks a line
    assert "\n    finst_size: " in text
    page.locator("#status").hover()
    expect(page.locator(".documentation")).to_have_count(0)
    at_end_of(page, "memory = Memory(facts)")
    page.keyboard.press("ArrowLeft")
    page.evaluate(SLOW)
    page.keyboard.type(", latency=", delay=50)
    expect(page.locator(".documentation b")).to_have_text("latency: NotNegative | None=None")
    page.keyboard.press("Escape")
    expect(page.locator(".documentation")).to_have_count(0)
    expect(page.locator(CODE)).to_be_focused()
    page.keyboard.press("Control+End")
    page.keyboard.type("scene = Scene(parts=(Fl")
    choose(page, "Floor")
    has_line(page, "Scene(parts=(Floor()")
    has_line(page, "from actr3d.actr import *from actr3d.world import Floor")


@pytest.mark.slow
def test_in_a_call_that_changes_a_chunk_its_slots_are_offered_while_writing(opened: Callable[[str], Page]) -> None:
    page = opened(SHORT)
    options = page.locator(".cm-tooltip-autocomplete li")
    at_end_of(page, "print(word)")
    page.keyboard.type("\ngoal.modify(")
    expect(options).to_have_text(["task=slot, goal", "word=slot, goal", "meaning=slot, memory"])
    page.wait_for_timeout(100)  # CodeMirror ignores a key that comes too soon after its list
    page.keyboard.press("Enter")
    has_line(page, "goal.modify(task=)")
    page.keyboard.type("1, ")
    expect(options.first).to_have_text("word=slot, goal")
    page.keyboard.press("Escape")
    page.keyboard.press("End")
    page.keyboard.type("\nmemory.add(")
    expect(page.locator(".documentation")).to_contain_text("add(")
    expect(options).to_have_count(0)  # nothing but its signature
    page.keyboard.type('"word:x"')


def test_names_are_found_and_renamed_and_the_text_formatted(opened: Callable[[str], Page]) -> None:
    page = opened(SHORT.replace("print(word)", "print( word )"))
    at_end_of(page, "print( word )")
    for _ in range(3):
        page.keyboard.press("ArrowLeft")
    page.keyboard.press("F2")
    dialog = page.get_by_role("dialog")
    expect(dialog).to_have_text(re.compile("Rename the variable word in 3 places"))
    page.keyboard.type("for")
    page.keyboard.press("Enter")
    expect(dialog).to_have_text(re.compile("'for' is not a name"))
    page.keyboard.type("asked")
    page.keyboard.press("Enter")
    for line in ('word:?asked"):', 'memory.request("word:?asked")', "print( asked )"):
        has_line(page, line)
    page.keyboard.press("F12")
    expect(page.locator(".cm-activeLine")).to_have_text(re.compile("def ask"))
    page.keyboard.press("Shift+Alt+F")
    has_line(page, "print(asked)")
    expect(page.locator(".cm-activeLine")).to_have_text(re.compile("def ask"))  # the cursor stays
    note = page.locator(".file-status .state")
    expect(note).to_contain_text("formatted")
    page.keyboard.press("Control+z")
    expect(note).not_to_contain_text("formatted")
    has_line(page, "print( asked )")
    page.keyboard.press("Control+z")
    has_line(page, "print( word )")
    page.get_by_role("button", name="More", exact=True).click()
    assert page.locator(".editor-menu:popover-open").evaluate("menu => menu.scrollWidth <= menu.clientWidth"), "no text is cut"
    assert page.evaluate(LOOK) == []
    page.get_by_role("button", name="a detector for the agent's vision").click()
    page.keyboard.type("Pole")  # in all places at once
    has_line(page, "@detector(Pole)")
    page.keyboard.press("Control+Home")
    has_line(page, "from dataclasses import dataclassfrom actr3d.actr import *from actr3d.vision import DETECTORS")
    shows(page, ".problems", "No problems")
    page.keyboard.press("Control+Alt+g")
    expect(page.locator(".cm-panel input")).to_be_focused()
    page.keyboard.insert_text("4")
    page.keyboard.press("Enter")
    expect(page.locator(".cm-activeLine")).to_have_text(re.compile("^from actr3d.vision import"))


STAYS = "def one(size):\n    return size\n\n" + "".join(f"def other_{number}(size):\n    return 1\n\n" for number in range(10))


@pytest.mark.slow
def test_after_renaming_the_page_leads_to_the_lines_in_which_the_word_stays(opened: Callable[[str], Page]) -> None:
    page = opened(STAYS)
    at_end_of(page, "return size")
    page.keyboard.press("F2")
    page.get_by_role("dialog").get_by_role("textbox").fill("width")
    page.keyboard.press("Enter")
    note = page.locator(".strip", has_text="stays")
    expect(note).to_have_text(re.compile(r"Renamed in 2 places\. The word size stays in lines 4, 7, 10, 13, 16, 19, 22, 25 and 2 more\."))
    assert page.evaluate(LOOK) == []
    page.keyboard.press("Control+Home")
    page.keyboard.type("# new\n")
    note.get_by_role("button", name="line 8").focus()
    page.keyboard.press("Enter")
    expect(page.locator(".cm-activeLine")).to_have_text(re.compile("def other_1"))
    expect(page.locator(CODE)).to_be_focused()
    note.get_by_role("button", name="Close").click()
    expect(note).to_have_count(0)
    at_end_of(page, "return width")
    page.keyboard.press("F2")
    page.get_by_role("dialog").get_by_role("textbox").fill("breadth")
    page.keyboard.press("Enter")
    expect(page.locator(".file-status .state")).to_contain_text("renamed in 2 places")
    expect(note).to_have_count(0)


SEEN = "from actr3d.actr import *\n\nclass Spot(Model):\n    x = 1\n\nclass Person(ACTR):\n    vision = Vision(Buffer(), Buffer())\n"


@pytest.mark.daily(1)
@pytest.mark.parametrize(
    ("text", "place", "why", "line", "shown"),
    [
        (
            "class Box:\n    def show(self): pass\n\ndef report(one):\n    one.show()\n",
            "def show(self): pass",
            "whether 'show' in line 5 is the same is not known",
            5,
            "one.show",
        ),
        (SEEN, "x = 1", "'x' is read by Vision, and keeps its name here", 4, "x = 1"),
    ],
)
def test_a_name_that_is_not_renamed_leads_to_the_line_that_is_the_reason(
    opened: Callable[[str], Page], text: str, place: str, why: str, line: int, shown: str
) -> None:
    page = opened(text)
    at_end_of(page, place)
    for _ in range(len(re.sub(r"^(def )?\w+", "", place))):
        page.keyboard.press("ArrowLeft")
    page.keyboard.press("F2")
    expect(page.locator(".toast")).to_contain_text(why)
    page.locator(".toast").get_by_role("button", name=f":{line}").click()
    expect(page.locator(".cm-activeLine")).to_have_text(re.compile(shown))


@pytest.mark.slow
@pytest.mark.parametrize(
    "piece",
    [
        "an agent with a production",
        "a production",
        "a declarative memory and its buffer",
        "vision with",
        "an agent with a body",
        "a design of",
    ],
)
def test_pieces_are_inserted_where_they_may_stand(opened: Callable[[str], Page], workbench: Served, piece: str) -> None:
    page = opened(SHORT)
    at_end_of(page, "memory = Memory(facts)")
    page.get_by_role("button", name="More", exact=True).click()
    page.get_by_role("button", name=re.compile(f"^{piece}")).click()
    unsaved = page.locator(".file-status .state")
    expect(unsaved).to_have_text(re.compile("unsaved"))
    shows(page, ".problems", "No problems")
    page.keyboard.press("Escape")
    page.keyboard.press("Control+s")
    shows(page, ".file-status", "saved")
    written = (workbench.folder / "written.py").read_text(encoding="utf-8")
    compile(written, "written.py", "exec")
    assert len(written) > len(SHORT)
    assert written.count("from actr3d.actr import *") == 1
    assert "from dataclasses" not in written.partition("from actr3d")[2]  # imports are in the order of the templates


def is_completion(request: Request) -> bool:
    return '"ask":"complete"' in (request.post_data or "")


@pytest.mark.slow
def test_the_server_prepares_its_help_when_the_editor_is_opened(pages: Callable[..., Page]) -> None:
    page = pages("counting.py")
    shows(page, "#status", "at its start")
    with page.expect_request("**/api/language", timeout=10_000) as asked:
        open_tab(page, "Editor")
    assert is_completion(asked.value)
    expect(page.locator(CODE)).not_to_be_focused()


@pytest.mark.slow
def test_while_completions_and_documentation_are_waited_for_the_editor_says_so(opened: Callable[[str], Page]) -> None:
    page = opened(SHORT)
    reading = page.locator(".reading")
    at_end_of(page, "memory = Memory(facts)")
    page.keyboard.press("ArrowLeft")
    for keys, shown in (("Control+Space", ".cm-tooltip-autocomplete"), ("Control+Shift+Space", ".documentation")):
        with holding(page, "**/api/language", lambda _: True):
            page.keyboard.press(keys)
            expect(reading).to_have_text("Reading the text …")
            assert page.evaluate(LOOK) == []
        expect(page.locator(shown)).to_be_visible()
        expect(reading).to_have_count(0)
        page.keyboard.press("Escape")
        expect(page.locator(shown)).to_have_count(0)
    with holding(page, "**/api/language", lambda _: True):
        page.keyboard.press("Control+Space")
        expect(reading).to_be_visible()
        page.keyboard.press("Escape")
        expect(reading).to_have_count(0)


ANSWER = '    def answer(facts="meaning:?meaning"):\n        print(meaning)\n'
NEW = '        print(word)\n\n    def name(goal="task:start"):\n        goal.set("task:done")\n'
PARTS = "        print(word)\n\n    retrieval = Buffer()\n    memory = Memory(retrieval)\n"
MOTOR = "    facts = Buffer()\n    motor = Motor()\n    memory = Memory(facts)\n"


@pytest.mark.daily(1)
@pytest.mark.parametrize(
    ("text", "line", "keys", "piece", "expected"),
    [
        (SHORT, "print(word)", "", "a production", NEW),
        (SHORT, "print(word)", "\n", "a production", NEW),
        (SHORT, "def ask", "", "a production", NEW),
        (f"{SHORT}\n{ANSWER}", "print(word)", "", "a production", f"{NEW}\n{ANSWER}"),
        (SHORT, "print(word)", "", "a declarative memory", PARTS),
        (SHORT, "facts = Buffer()", "", "motor control", MOTOR),
    ],
    ids=["end", "below", "head", "between", "parts", "attribute"],
)
def test_a_piece_of_a_class_leaves_the_production_that_the_cursor_is_in(
    opened: Callable[[str], Page], workbench: Served, text: str, line: str, keys: str, piece: str, expected: str
) -> None:
    page = opened(text)
    at_end_of(page, line)
    page.keyboard.type(keys)
    page.get_by_role("button", name="More", exact=True).click()
    page.get_by_role("button", name=re.compile(f"^{piece}")).click()
    page.keyboard.press("Escape")
    page.keyboard.press("Control+s")
    shows(page, ".file-status", "saved")
    assert expected in (workbench.folder / "written.py").read_text(encoding="utf-8")


MISSPELT = """from actr3d.actr import *
from actr3d.simulation import BodyPort


class Walker(ACTR):
    goal = Buffer()
    felt = Buffer()
    skin = BodyPort(felt)

    def look(goal="walk"):
        skin.request("poze")
"""


def test_the_line_of_a_misspelt_word_is_underlined_in_both_themes(opened: Callable[[str], Page]) -> None:
    page = opened(MISSPELT)
    marked = page.locator(".cm-lintRange-warning")
    expect(marked).to_have_text('skin.request("poze")')
    look = "one => { const style = getComputedStyle(one); return [style.textDecorationLine, style.textDecorationColor]; }"
    page.emulate_media(color_scheme="light")
    until(page, lambda: marked.evaluate(look) == ["underline", "rgb(143, 90, 0)"])  # the colour of warnings
    page.emulate_media(color_scheme="dark")
    until(page, lambda: marked.evaluate(look) == ["underline", "rgb(240, 180, 92)"])
