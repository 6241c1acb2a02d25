"""The first look at a model in a real browser: what it says of itself, how fast it goes, what it prints, and its seed."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import pytest
from playwright.sync_api import Locator, Page, expect

from tests.helpers.page import choose, drawn, open_tab, say, shows, until
from tests.helpers.workbench_server import Served

Pages = Callable[..., Page]

PRINTS = r"""'''Prints <b>bold</b>, [x](javascript:alert(1)).

What to try
-----------
- `last = 9`: more.
'''
from actr3d.actr import *

last = 4
print('  two  spaces\tand a tab  \x1b[31mred\x1b[0m <b>bold</b> \u202eend')
print()

class Prints(ACTR):
    goal = Buffer()
    def init():
        goal.set('number 0')
    def count(goal='number ?n'):
        print('at', n)
        goal.set('number ' + str(int(n) + 1))
        if int(n) == last:
            raise ValueError('too much')

Prints().run()
"""

MANY = """
for n in range(60_000):
    print(f'line {n}')
"""


def lines(page: Page) -> Locator:
    return page.locator(".console .lines > div > div")


def shown_lines(page: Page) -> list[str]:
    """Returns the lines that are drawn."""
    return lines(page).all_text_contents()


def settings(workbench: Served, session: int = -1) -> dict[str, object]:
    """Returns what is known of a session, by default the newest."""
    name = workbench.get("/api/sessions").json()["sessions"][session]["id"]
    return workbench.get(f"/api/sessions/{name}").json()["session"]


def test_a_first_visit_shows_what_the_model_says_of_itself_and_one_click_tries_it(pages: Pages, workbench: Served) -> None:
    page = pages("doorway.py", tab=None, paced=True)
    expect(page.get_by_role("tab").first).to_have_text("About")
    about = page.get_by_role("article")
    expect(about.get_by_role("heading", level=2)).to_have_text(re.compile("^Walks through a doorway"))
    expect(about.get_by_role("heading", level=3)).to_have_text(["What to expect", "What to try"])
    shows(page, "#status", "at its start")
    expect(page.get_by_label("Speed", exact=True)).to_have_value("4")  # 1 x
    hint = page.get_by_role("button", name="Real time: press + to go faster")
    about.get_by_role("button", name="width = 0.5, speed = 2").click()
    shows(page, "#status", "running")
    until(page, lambda: settings(workbench)["settings"] == {"width": 0.5, "speed": 2})
    expect(hint).to_be_visible()
    page.get_by_role("heading", name="ACT-R 3D").click()
    page.keyboard.press("+")
    expect(page.get_by_label("Speed", exact=True)).to_have_value("5")
    expect(hint).to_have_count(0)
    page.reload()
    shows(page, "#time", "t =")
    expect(hint).to_have_count(0)
    about.get_by_role("button", name="Edit").click()
    expect(page.locator(".code .cm-content[aria-label*='doorway.py']")).to_be_visible()


SHORT = """from actr3d.actr import *
from actr3d.simulation import Simulation
from actr3d.world import Floor, Mannequin, Scene

class Walker(ACTR):
    goal = Buffer()
    def init():
        goal.set("go")
    def go(goal="go"):
        self.stop()

def build() -> Simulation:
    return Simulation(Scene(parts=(Floor(), Mannequin(name="walker"))), {"walker": Walker})
"""


def test_the_hint_to_go_faster_is_not_for_a_run_that_is_over(pages: Pages, workbench: Served) -> None:
    (workbench.folder / "short.py").write_text(SHORT, encoding="utf-8")
    page = pages("short.py", paced=True)
    hint = page.get_by_role("button", name="Real time: press + to go faster")
    shows(page, "#status", "at its start")
    expect(hint).to_be_visible()
    page.click("#run")
    shows(page, "#status", "ended")
    expect(hint).to_have_count(0)


def test_without_a_world_the_panels_have_all_the_room(pages: Pages) -> None:
    page = pages("counting.py", paced=True)
    shows(page, "#status", "at its start")
    expect(page.locator("#scene")).not_to_be_visible()
    box = page.get_by_role("region", name="Panels").bounding_box()
    assert box is not None
    assert (box["x"], box["width"]) == (0, 1280)
    expect(page.get_by_label("Speed", exact=True)).to_have_value("9")  # fastest
    page.get_by_label("Model", exact=True).select_option("doorway.py")
    expect(page.locator("#scene")).to_be_visible()
    shows(page, "#status", "at its start")
    expect(page.get_by_label("Speed", exact=True)).to_have_value("4")


def test_before_its_first_run_a_program_shows_what_its_text_has_and_takes_breakpoints(pages: Pages) -> None:
    page = pages("counting.py")
    shows(page, "#status", "at its start")
    expect(page.get_by_role("table", name="Parts of Counting").get_by_role("rowheader")).to_have_text(["goal", "retrieval", "memory"])
    open_tab(page, "Productions")
    expect(page.locator(".production-list button.name")).to_have_text(["count_on", "start_counting", "stop_counting"])
    page.get_by_role("button", name="Breakpoint on count_on").click()
    page.click("#run")
    shows(page, "#status", "breakpoint: count_on fired")
    page.get_by_role("button", name="Remove it").click()
    open_tab(page, "Buffers")
    expect(page.get_by_role("table", name="Buffers of top")).to_be_visible()


def test_the_console_shows_output_as_it_is_printed_and_goes_back_with_the_run(pages: Pages, workbench: Served) -> None:
    (workbench.folder / "prints.py").write_text(PRINTS, encoding="utf-8")
    page = pages("prints.py", tab="about")
    page.on("dialog", lambda dialog: dialog.dismiss())
    expect(page.get_by_role("article")).to_contain_text("Prints <b>bold</b>, [x](javascript:alert(1)).")
    open_tab(page, "Console")
    shows(page, ".console", "Nothing has been printed yet")
    page.click("#run")
    shows(page, "#status", "failed")
    first = r"  two  spaces{}and a tab  \x1b[31mred\x1b[0m <b>bold</b> \u202eend".format("\t")
    expect(lines(page)).to_have_text(
        [
            re.compile("two"),
            "",
            "at 0",
            "at 1",
            "at 2",
            "at 3",
            "at 4",
            "error prints.py:21 ValueError: too much",
            re.compile("^in production 'count'"),
        ]
    )
    assert shown_lines(page)[0] == first
    assert lines(page).first.evaluate("line => getComputedStyle(line).whiteSpace") == "pre"
    page.context.grant_permissions(["clipboard-read", "clipboard-write"])
    page.locator(".console").get_by_role("button", name="Copy").click()
    said = page.locator(".console .copy").get_by_role("status")
    expect(said).to_have_text("Copied")
    assert said.evaluate("said => said.scrollWidth <= said.clientWidth"), "it fits"
    whole = page.evaluate("navigator.clipboard.readText()")
    printed = "  two  spaces\tand a tab  \x1b[31mred\x1b[0m <b>bold</b> \u202eend\n\nat 0\nat 1\nat 2\nat 3\nat 4\n"
    assert whole.startswith(f"{printed}error: prints.py:21: ValueError: too much\n")
    with page.expect_download() as download:
        page.locator(".console").get_by_role("button", name="Save").click()
    assert download.value.suggested_filename.startswith("prints_seed_")
    assert Path(download.value.path()).read_bytes().decode() == whole
    page.get_by_label("Search the console").fill("AT 3")
    expect(lines(page)).to_have_text(["at 3"])
    shows(page, ".console .tools", "1 of 8 lines")
    page.get_by_label("Search the console").fill("")
    page.locator(".console").get_by_role("button", name="Clear").click()
    expect(lines(page)).to_have_count(0)
    shows(page, ".console", "The lines up to this moment are cleared")
    page.locator(".console").get_by_role("button", name="Show all").click()
    expect(lines(page)).to_have_count(9)
    # Lines that arrive before the state of their moment are not ahead of it.
    page.evaluate("async () => { const { state } = await part('store.js'); state.value = { ...state.value, events: 0 }; }")
    expect(lines(page)).to_have_count(0)
    expect(page.locator(".console")).not_to_contain_text("after this moment")
    page.click("#back")
    shows(page, "#status", "went to this time")
    expect(lines(page)).to_have_count(6)
    shows(page, ".console", "1 line printed after this moment is not shown")
    page.reload()  # and so after a reload
    expect(lines(page)).to_have_count(6)
    page.click("#restart")
    shows(page, "#time", r"0\.00 s")
    shows(page, ".console", "Nothing has been printed yet")
    expect(lines(page)).to_have_count(0)
    page.click("#run")
    shows(page, "#status", "failed")
    page.locator(".console .error .link").click()
    expect(page.locator(".cm-activeLine")).to_have_text("            raise ValueError('too much')")


@pytest.mark.slow
def test_a_long_output_is_whole_though_few_of_its_lines_are_drawn(pages: Pages, workbench: Served) -> None:
    (workbench.folder / "many.py").write_text(MANY, encoding="utf-8")
    page = pages("many.py", tab="console")
    page.click("#run")
    shows(page, "#status", "ended")
    shows(page, ".console .tools", "60,000 lines")  # also those that the server has no longer at hand
    expect(lines(page).last).to_have_text("line 59999")
    assert lines(page).count() < 200
    page.reload()
    shows(page, ".console .tools", "60,000 lines")
    page.locator(".console .lines").evaluate("box => (box.scrollTop = 0)")
    expect(lines(page).first).to_have_text("line 0")
    drawn(page)
    assert lines(page).count() < 200
    page.get_by_label("Search the console").fill("line 4999")
    shows(page, ".console .tools", "11 of 60,000 lines")


def test_a_run_begins_with_the_seed_that_is_written_and_keeps_it(pages: Pages, workbench: Served) -> None:
    page = pages("counting.py")
    shows(page, "#status", "at its start")
    field = page.get_by_label("Seed", exact=True)
    expect(field).to_have_value(str(settings(workbench)["seed"]))
    largest = str(2**63 - 1)
    for wrong, why in (
        ("", "whole number"),
        ("-1", "whole number"),
        ("1.5", "whole number"),
        ("1e3", "whole number"),
        (str(2**63), "at most"),
    ):
        field.fill(wrong)
        field.press("Enter")
        expect(page.get_by_role("alert")).to_contain_text(why)
    assert settings(workbench)["run"] == 1
    field.press("Escape")
    expect(field).to_have_value(str(settings(workbench)["seed"]))
    for run, seed in ((2, "7"), (3, largest)):
        field.fill(seed)
        field.press("Enter")
        until(page, lambda run=run: settings(workbench)["run"] == run)
        expect(field).to_have_value(seed)
        expect(page.get_by_text(f"seed {seed}", exact=True)).to_be_visible()
    page.click("#restart")
    until(page, lambda: settings(workbench)["run"] == 4)
    expect(field).to_have_value(largest)
    page.click("#new-seed")
    until(page, lambda: settings(workbench)["run"] == 5)
    expect(field).to_have_value(str(settings(workbench)["seed"]))
    assert settings(workbench)["seed"] != largest


@pytest.mark.slow
def test_a_search_in_the_console_ends_with_its_run(pages: Pages, workbench: Served) -> None:
    (workbench.folder / "says.py").write_text("print('one')\nprint('two')\n", encoding="utf-8")
    page = pages("says.py", tab="console")
    shows(page, "#status", "at its start")
    page.click("#run")
    expect(lines(page)).to_have_count(2)
    field = page.get_by_label("Search the console")
    field.fill("two")
    expect(lines(page)).to_have_text(["two"])
    open_tab(page, "About")
    open_tab(page, "Console")
    expect(field).to_have_value("two")
    page.click("#restart")
    shows(page, "#status", "at its start")
    expect(field).to_have_value("")
    page.click("#run")
    expect(lines(page)).to_have_count(2)
    field.fill("two")
    choose(page, "counting.py")
    expect(field).to_have_value("")
    field.fill("x 1999")
    page.reload()
    shows(page, "#status", "at its start")
    expect(field).to_have_value("")


def test_the_console_says_that_lines_are_cleared_and_not_that_nothing_was_printed(pages: Callable[..., Page], workbench: Served) -> None:
    page = pages("counting.py", tab="console")
    shows(page, "#status", "at its start")
    say(page, type="until", time=0.3)
    shows(page, "#time", r"0\.30 s")
    expect(lines(page)).not_to_have_count(0)
    page.locator(".console").get_by_role("button", name="Clear").click()
    expect(lines(page)).to_have_count(0)
    cleared = "The lines up to this moment are cleared. Show all"
    expect(page.locator(".console p")).to_have_text([cleared])
    page.evaluate("async () => void (await (await part('timeline/seek.js')).seek(0.2))")
    shows(page, "#time", r"0\.20 s")
    expect(page.locator(".console p")).to_have_text([cleared, re.compile("printed after this moment")])
    page.evaluate("async () => void (await (await part('timeline/seek.js')).seek(0))")
    shows(page, "#time", r"0\.00 s")
    expect(page.locator(".console p")).to_have_text([re.compile("printed after this moment"), "Nothing was printed before this moment."])
