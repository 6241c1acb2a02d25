"""What the page says of the state that a run is in: the same in every panel, and what to do."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from playwright.sync_api import Page, expect

from tests.helpers.page import choose, open_tab, shows
from tests.helpers.workbench_server import Served

MIND = """
import os
from actr3d.actr import *

class Mind(ACTR):
    goal = Buffer()
    retrieval = Buffer()
    memory = Memory(retrieval)

    def init():
        memory.add('red apple')
        goal.set('begin')

    def begin(goal='begin'):
        goal.set('end')

    def end(goal='end'):
        {last}

Mind().run()
"""
MODELS = {
    "waits.py": MIND.format(last="self.stop()"),
    "dies.py": "import os\nos._exit(3)\n",
    "fails.py": MIND.format(last="nonsense(1)"),
    "broken.py": "class Mind(:\n    pass\n",
}


def says(page: Page, text: str, panels: tuple[str, ...]) -> None:
    """Panels say the same."""
    for title in panels:
        open_tab(page, title)
        expect(page.locator(f"#panel-{title.lower()} :is(p.empty, p.at-start)").first).to_contain_text(text)


@pytest.mark.slow
def test_all_panels_say_the_same_of_the_state_of_the_run_and_what_to_do(pages: Callable[..., Page], workbench: Served) -> None:
    for name, text in MODELS.items():
        (workbench.folder / name).write_text(text, encoding="utf-8")
    page = pages("waits.py")
    timeline = page.locator(".timeline-nothing")

    shows(page, "#status", "^paused: at its start$")
    says(page, "These are in its text. Press Run: the program creates its agent while it runs.", ("Buffers",))
    says(page, "There is nothing to show yet. Press Run: the program creates its agent while it runs.", ("Memory", "Eye"))
    says(page, "Nothing has happened yet. Press Run", ("Productions",))
    expect(timeline).to_contain_text("Nothing has happened yet. Press Run")

    page.click("#cycle")
    shows(page, "#time", "0.05 s")
    page.click("#stop")
    shows(page, "#status", "^stopped$")
    says(page, "The run was stopped: nothing more can be asked of it. «Run again» starts it from the beginning.", ("Productions", "Memory"))
    expect(page.locator("#panel-memory")).not_to_contain_text("red apple")
    open_tab(page, "Buffers")
    expect(page.locator(".buffers [data-path$='goal']")).to_contain_text("end")  # as it was
    expect(page.locator("#run")).to_have_text("Run again")

    choose(page, "dies.py")
    page.click("#run")
    lost = "There is no run any more: the model's process ended with exit code 3. "
    lost += "What happened just before that may be missing. «Run again» starts it from the beginning."
    shows(page, "#status", "^failed: the model's process ended with exit code 3$")
    says(page, lost, ("Buffers", "Productions", "Memory", "Eye"))
    expect(timeline).to_have_text(lost)
    expect(page.locator(".toast")).to_contain_text("exit code 3")

    page.get_by_label("Model", exact=True).select_option("broken.py")
    unloadable = "This model cannot be loaded: see Messages for the reason and the line. Fix it in the editor, then run it again."
    shows(page, "#status", "^the model cannot be loaded$")
    expect(page.locator("#run")).to_have_text("Run")  # it has not run yet
    says(page, unloadable, ("Buffers", "Productions", "Memory", "Eye"))
    expect(timeline).to_have_text(unloadable)
    expect(page.locator("#scene")).to_contain_text(unloadable)
    expect(page.locator(".toast")).not_to_contain_text("exit code 3")  # which was of another model

    choose(page, "fails.py")
    page.click("#run")
    shows(page, "#status", "^failed: NameError")
    open_tab(page, "Productions")
    expect(page.locator("#why-text")).to_contain_text("end: matches")  # it can still be asked
    expect(page.locator("#panel-productions p.empty")).to_have_count(0)


NOTHING_MATCHES = """
from actr3d.actr import *

class Mind(ACTR):
    goal = Buffer()

    def init():
        goal.set('one')

    def two(goal='two'):
        goal.set('three')

Mind().run()
"""


def test_a_run_that_is_over_at_time_0_is_not_said_to_be_before_its_first_event(pages: Callable[..., Page], workbench: Served) -> None:
    (workbench.folder / "matches_nothing.py").write_text(NOTHING_MATCHES, encoding="utf-8")
    page = pages("doorway.py")
    note = page.get_by_text("This is before the first event")
    expect(note).to_be_visible()
    choose(page, "matches_nothing.py")
    page.click("#run")
    shows(page, "#status", "^ended")
    shows(page, "#time", r"0\.00 s")
    shows(page, "tr[data-path$=goal]", "one")
    expect(note).to_have_count(0)
    (workbench.folder / "matches_nothing.py").unlink()
