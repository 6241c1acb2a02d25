"""The editor in a real browser: errors at their lines, the last good run, conflicts, drafts, files, and the messages."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Dialog, Page, expect

from actr3d.actr.loading.helper_modules import HelperTexts
from actr3d.experiment.specification import specify
from actr3d.experiment.trial import run_trial
from tests.helpers.page import choose, drawn, holding, open_tab, shows, until
from tests.helpers.paths import MODELS
from tests.helpers.workbench_server import Served, served

CODE = ".code .cm-content"
MIND = MODELS / "counting.py"
DRAFTS = "Object.keys(localStorage).filter((key) => key.startsWith('actr3d.draft.')).length"
"""Returns how many unsaved texts the browser keeps."""


@pytest.fixture(scope="module")
def workbench(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    """A workbench of its own: there is a bound to the sessions of one."""
    with served(tmp_path_factory.mktemp("editor") / "models") as running:
        yield running


@pytest.fixture
def written(workbench: Served) -> Callable[[str, str], Path]:
    """Writes a model into the folder."""

    def write(name: str, text: str) -> Path:
        path = workbench.folder / name
        path.write_text(text, encoding="utf-8")
        return path

    return write


def another_tab(page: Page) -> Page:
    """Opens a second tab of the same user."""
    other = page.context.new_page()
    other.goto(f"{page.url.partition('?')[0]}?model=counting.py")
    return other


def edit(page: Page, model: str) -> None:
    """Opens a file of the folder in the editor."""
    shows(page, "#status", "paused|ended|failed|running")  # the editor begins with the model that is shown
    open_tab(page, "Editor")
    page.get_by_label("File", exact=True).select_option(model)
    expect(page.locator(f"{CODE}[aria-label*='{model}']")).to_be_visible()


def write(page: Page, text: str, *, where: str = "Control+End") -> None:
    """Writes something at the end, or the start, of the text."""
    page.locator(CODE).focus()
    page.keyboard.press(where)
    page.keyboard.insert_text(text)


def ends(page: Page, text: str) -> None:
    """Waits until the text in the editor ends with another."""
    until(page, lambda: "\n".join(page.locator(f"{CODE} .cm-line").all_text_contents()).endswith(text))


def unsaved(page: Page) -> Any:
    return expect(page.locator(".file-status .state"))


@pytest.mark.slow
def test_the_last_good_run_stays_until_the_text_loads_again(pages: Callable[..., Page], written: Callable[[str, str], Path]) -> None:
    path = written("loads.py", MIND.read_text(encoding="utf-8"))
    page = pages("loads.py")
    shows(page, "#status", "at its start")
    page.click("#cycle")
    shows(page, "#time", "0.05 s")
    edit(page, "loads.py")
    shows(page, ".problems", "No problems")
    write(page, "x = = 1\n", where="Control+Home")
    shows(page, ".problems", r"1 error.*line 1invalid syntax")  # while one types, before anything is saved
    expect(page.locator(".cm-lint-marker-error")).to_be_visible()
    unsaved(page).to_have_text(re.compile("unsaved"))
    assert path.read_text(encoding="utf-8") == MIND.read_text(encoding="utf-8")
    page.keyboard.press("Control+Enter")
    shows(page, ".strip", "an earlier version of the file; the new one cannot be loaded")
    assert path.read_text(encoding="utf-8").startswith("x = = 1\n")
    shows(page, "#time", "0.05 s")
    page.click("#step")
    shows(page, "#time", "0.06 s")  # the former run goes on
    open_tab(page, "Messages")
    shows(page, ".former", "earlier version")
    page.locator("#log .link", has_text="loads.py:1").click()
    expect(page.locator(".cm-activeLine")).to_have_text("x = = 1")
    page.keyboard.press("Control+Shift+k")
    page.keyboard.insert_text("# mended\n")
    shows(page, ".problems", "No problems")
    for _ in range(3):
        page.keyboard.press("Control+s")  # one after the other, although nobody waits
    shows(page, ".file-status", "saved$|savedSave")
    shows(page, ".strip", "This run was made from an earlier version of the file")
    shows(page, "#time", "0.06 s")  # saving runs nothing
    page.get_by_role("button", name="Run the new one").click()
    shows(page, "#status", "ended")
    expect(page.locator(".strip")).to_have_count(0)
    assert path.read_text(encoding="utf-8") == "# mended\n" + MIND.read_text(encoding="utf-8")


@pytest.mark.slow
def test_a_run_beside_unsaved_text_is_said_to_be_of_the_saved_text(pages: Callable[..., Page], written: Callable[[str, str], Path]) -> None:
    path = written("unsaved.py", "print(undefined_name)\n")
    page = pages("unsaved.py")
    edit(page, "unsaved.py")
    page.click("#run")
    shows(page, "#status", "failed")
    expect(page.locator(".strip")).to_have_count(0)
    page.locator(CODE).focus()
    page.keyboard.press("Control+a")
    page.keyboard.insert_text("print('mended')\n")
    shows(page, ".strip", "The text in the editor is not saved: runs are of the saved text.")
    page.click("#run")  # the saved text once more
    until(page, lambda: page.evaluate("async () => (await part('store.js')).session.value.run") > 1)
    shows(page, "#status", "failed")
    open_tab(page, "Messages")
    shows(page, ".former", "The text in the editor is not saved")
    page.get_by_role("button", name="Save and run").click()
    shows(page, "#status", "ended")
    expect(page.locator(".former")).to_have_count(0)
    assert path.read_text(encoding="utf-8") == "print('mended')\n"


@pytest.mark.slow
def test_what_a_run_says_is_marked_at_its_lines(pages: Callable[..., Page], written: Callable[[str, str], Path]) -> None:
    written(
        "helping.py", "import warnings\n\ndef fail():\n    warnings.warn('beware')\n    raise ValueError('<img src=x onerror=alert(1)>')\n"
    )
    written("fails.py", "import os\nimport helping\n\nos.write(1, b'past print\\n')\nhelping.fail()\n")
    page = pages("fails.py")
    page.on("dialog", lambda dialog: pytest.fail("it was run as HTML"))
    edit(page, "fails.py")
    page.get_by_role("button", name="Save and run").click()
    shows(page, ".problems", r"line 5ValueError: <img src=x onerror=alert\(1\)>")
    write(page, "# a line\n", where="Control+Home")
    shows(page, ".problems", "line 6ValueError")  # it moves with its line
    open_tab(page, "Messages")
    shows(page, "#log", "past print")
    page.locator("#log .error summary").click()
    page.locator("#log pre .link", has_text="helping.py").click()
    expect(page.locator(".cm-activeLine")).to_have_text("    raise ValueError('<img src=x onerror=alert(1)>')")
    shows(page, ".problems", "1 error, 1 warning.*line 4beware.*line 5ValueError")
    page.locator(".cm-lint-marker-error").hover()
    shows(page, ".cm-tooltip-lint", r"ValueError: <img src=x[\s\S]*line 5, in fail")
    page.get_by_role("heading", name="ACT-R 3D").hover()
    expect(page.locator(".cm-tooltip-lint")).to_have_count(0)  # it would be in the way
    page.locator(".problems li button", has_text="line 4").click()
    page.keyboard.press("End")
    page.keyboard.type("  # changed")
    shows(page, ".problems", "^1 error")  # what was said of that line holds no more
    open_tab(page, "Messages")
    page.get_by_label("Errors").uncheck()
    expect(page.locator("#log li.error")).to_have_count(0)
    shows(page, "#log", "beware")
    page.get_by_role("button", name="Clear").click()
    shows(page, ".messages", "No messages")
    page.get_by_label("Errors").check()
    edit(page, "fails.py")
    page.keyboard.press("Control+z")
    page.locator(CODE).focus()
    page.keyboard.press("Control+a")
    page.keyboard.insert_text("from actr3d.actr import *\nx = MemoryNoise\n")
    shows(page, ".problems", "^1 warning.*nothing defines 'MemoryNoise'; did you mean 'DMNoise'")
    page.keyboard.press("Control+Enter")
    shows(page, ".problems", r"^1 errorEsc.*line 2NameError: name 'MemoryNoise' is not defined; did you mean 'DMNoise'\?the run")
    page.keyboard.press("Control+a")
    page.keyboard.insert_text("print('well')\n")
    page.keyboard.press("Control+Enter")
    shows(page, "#status", "ended")
    shows(page, ".problems", "No problems")


@pytest.mark.slow
def test_an_error_scrolls_its_line_into_view_and_leaves_the_cursor_where_it_is(
    pages: Callable[..., Page], written: Callable[[str, str], Path]
) -> None:
    written("far.py", "x = 1\n" * 150 + "raise ValueError('here')\n" + "y = 2\n" * 150)
    page = pages("far.py")
    edit(page, "far.py")
    wrong = page.locator(".cm-line", has_text="raise ValueError")
    expect(wrong).to_have_count(0)
    page.locator(CODE).focus()
    page.keyboard.press("Control+Enter")
    expect(wrong).to_be_in_viewport()
    assert page.evaluate("document.activeElement.classList.contains('cm-content')")
    page.keyboard.type("z")  # the cursor is where it was
    expect(page.locator(".cm-activeLine")).to_have_text("zx = 1")
    page.keyboard.press("Control+z")
    open_tab(page, "Buffers")
    page.get_by_role("button", name="Run again").click()
    shows(page, "#status", "failed")
    open_tab(page, "Editor")  # what went wrong meanwhile is in view, too
    expect(wrong).to_be_in_viewport()


@pytest.mark.slow
def test_a_file_that_changes_on_disk_is_never_written_over_unseen(pages: Callable[..., Page], written: Callable[[str, str], Path]) -> None:
    path = written("shared.py", "a = 1\nb = 2\n")
    page = pages("counting.py")
    edit(page, "shared.py")
    written("shared.py", "a = 1\nb = 3\n")
    expect(page.locator(CODE)).to_have_text(re.compile("b = 3"))  # nothing was edited here
    shows(page, ".file-status", "read again: the file had changed")
    write(page, "mine = 1\n")
    written("shared.py", "theirs = 1\n")
    shows(page, ".strip", "has changed on disk")
    page.keyboard.press("Control+s")
    shows(page, ".conflict", "shared.py has changed on disk")
    expect(page.locator(".conflict .cm-deletedChunk")).to_have_text(re.compile("theirs = 1"))
    expect(page.locator(".conflict .cm-content")).to_have_text(re.compile("mine = 1"))
    page.get_by_role("button", name="Keep editing").click()
    expect(page.locator(CODE)).to_be_focused()
    write(page, "more = 1\n")
    assert path.read_text(encoding="utf-8") == "theirs = 1\n"
    page.get_by_role("button", name="Compare and choose").click()
    page.get_by_role("button", name="Keep mine").click()
    shows(page, ".file-status", "saved")
    assert path.read_text(encoding="utf-8") == "a = 1\nb = 3\nmine = 1\nmore = 1\n"
    write(page, "again = 1\n")
    written("shared.py", "theirs = 2\n")
    page.get_by_role("button", name="Compare and choose").click()
    page.get_by_role("button", name="Take theirs").click()
    expect(page.locator(CODE)).to_have_text("theirs = 2")
    page.keyboard.press("Control+z")
    expect(page.locator(CODE)).to_have_text(re.compile("again = 1"))  # it can be undone
    unsaved(page).to_have_text(re.compile("unsaved"))
    path.unlink()
    shows(page, ".strip", "gone from the folder")
    page.locator(".strip").get_by_role("button", name="Close").click()
    expect(page.get_by_role("dialog", name="Close shared.py?")).to_contain_text("this text is the only copy")
    page.get_by_role("dialog").get_by_role("button", name="Cancel").click()
    page.get_by_role("button", name="Save it again").click()
    shows(page, ".file-status", "saved")
    assert "again = 1" in path.read_text(encoding="utf-8")
    path.unlink()
    shows(page, ".strip", "gone from the folder")
    unsaved(page).to_have_text("")
    page.get_by_role("button", name="Save and run").click()
    shows(page, "#status", "ended")
    expect(page.locator(".strip")).to_have_count(0)
    assert "again = 1" in path.read_text(encoding="utf-8")


@pytest.mark.slow
def test_a_file_chosen_before_the_next_picture_stays_chosen(pages: Callable[..., Page], written: Callable[[str, str], Path]) -> None:
    written("soon.py", "a = 1\n")
    page = pages("counting.py")
    shows(page, "#status", "at its start")
    page.evaluate(
        """() => {
            const observer = new MutationObserver(() => {  // is told before anything is drawn
                const file = document.querySelector("select[aria-label='File']");
                if (!file) return;
                observer.disconnect();
                file.value = "soon.py";
                file.dispatchEvent(new Event("change", { bubbles: true }));
            });
            observer.observe(document.body, { childList: true, subtree: true });
            [...document.querySelectorAll("[role=tab]")].find((tab) => tab.textContent.startsWith("Editor")).click();
        }"""
    )
    expect(page.locator(CODE)).to_have_text("a = 1")
    drawn(page)
    expect(page.get_by_label("File", exact=True)).to_have_value("soon.py")


@pytest.mark.slow
def test_unsaved_work_survives_a_reload_and_two_tabs(pages: Callable[..., Page], written: Callable[[str, str], Path]) -> None:
    path = written("draft.py", "a = 1\n")
    page = pages("counting.py")
    edit(page, "draft.py")
    other = another_tab(page)
    edit(other, "draft.py")
    write(page, "b = 2\n")
    write(other, "c = 3\n")
    until(page, lambda: page.evaluate(DRAFTS) == 2)
    asked: list[str] = []

    def leave(dialog: Dialog) -> None:
        asked.append(dialog.type)
        dialog.accept()

    page.on("dialog", leave)
    page.reload()
    assert asked == ["beforeunload"]
    shows(page, "#status", "paused|ended|failed|running")  # the editor begins with the model that is shown
    open_tab(page, "Editor")
    page.get_by_label("File", exact=True).select_option("draft.py")
    expect(page.locator(CODE)).to_have_text("a = 1b = 2")
    unsaved(page).to_have_text(re.compile("unsaved.*brought back"))
    assert path.read_text(encoding="utf-8") == "a = 1\n"
    page.keyboard.press("Control+s")
    shows(page, ".file-status", "saved")
    other.locator(CODE).focus()
    other.keyboard.press("Control+s")
    shows(other, ".conflict", "has changed on disk")
    assert path.read_text(encoding="utf-8") == "a = 1\nb = 2\n"
    other.close()  # with unsaved work, which the next tab takes over
    third = another_tab(page)
    edit(third, "draft.py")
    expect(third.locator(CODE)).to_have_text("a = 1c = 3")
    shows(third, ".strip", "has changed on disk")


@pytest.mark.slow
@pytest.mark.parametrize(
    ("choice", "seen"), [("An agent alone", "the program is over"), ("An agent with a body in a world", r"the model called stop\(\)")]
)
def test_a_new_model_runs(page: Page, workbench: Served, choice: str, seen: str) -> None:
    shows(page, "#status", "at its start")
    page.click("#cycle")
    shows(page, "#time", "0.05 s")
    edit(page, "doorway.py")
    write(page, "# not saved")
    page.get_by_role("button", name="New model", exact=True).click()
    name = page.get_by_label("Name of the file")
    name.fill("counting")
    page.get_by_role("button", name="Create").click()
    shows(page, "dialog", "there is a 'counting.py' already")
    name.fill(f"new {choice[-5:]}")
    page.get_by_label(choice).check()
    page.get_by_role("button", name="Create").click()
    expect(page.locator(CODE)).to_have_text(re.compile("Say in one line"))
    expect(page.locator(CODE)).to_be_focused()
    shows(page, "#status", "at its start")
    shows(page, "#time", "0.00 s")
    model = page.get_by_label("Model", exact=True)
    expect(model).to_have_value(f"new {choice[-5:]}.py")
    page.locator(CODE).focus()
    page.keyboard.press("Control+Enter")
    shows(page, "#status", f"ended: {seen}")
    shows(page, ".problems", "No problems")
    if choice == "An agent alone":
        open_tab(page, "About")
        page.get_by_role("button", name="last = 9").click()
        shows(page, "#time", "0.45 s")
        open_tab(page, "Editor")
    model.select_option("doorway.py")  # nothing of the former model is lost
    shows(page, "#time", "0.05 s")
    ends(page, "# not saved")


@pytest.mark.slow
def test_a_tab_keeps_its_own_unsaved_text_though_that_of_a_closed_tab_is_newer(
    pages: Callable[..., Page], written: Callable[[str, str], Path]
) -> None:
    written("two.py", "a = 1\n")
    page = pages("counting.py")
    edit(page, "two.py")
    other = another_tab(page)
    edit(other, "two.py")
    for tab, text, count in ((page, "b = 2\n", 1), (other, "c = 3\n", 2)):
        write(tab, text)
        until(page, lambda count=count: page.evaluate(DRAFTS) == count)
    other.close()
    page.on("dialog", lambda dialog: dialog.accept())
    page.reload()
    edit(page, "two.py")
    expect(page.locator(CODE)).to_have_text("a = 1b = 2")
    page.keyboard.press("Control+s")
    shows(page, ".file-status", "saved")
    page.reload()
    edit(page, "two.py")
    expect(page.locator(CODE)).to_have_text("a = 1c = 3")  # nor is that of the closed tab lost
    shows(page, ".strip", "has changed on disk")


@pytest.mark.slow
def test_parameters_are_those_of_the_text_however_often_it_is_saved(
    pages: Callable[..., Page], written: Callable[[str, str], Path], workbench: Served
) -> None:
    source = (MIND.parent / "doorway.py").read_text(encoding="utf-8")
    written("knobs.py", source)
    page = pages("knobs.py", tab="parameters")
    expect(page.get_by_label("width", exact=True)).to_be_visible()
    for added in ("first", "second"):
        version = workbench.get("/api/model?path=knobs.py").json()["version"]
        text = source.replace("    speed: Annotated", f"    {added}: float = 1.0\n    speed: Annotated")
        assert workbench.put("/api/model", {"path": "knobs.py", "text": text, "version": version}).status_code == 200
        expect(page.get_by_label(added, exact=True)).to_be_visible()
    expect(page.get_by_label("first", exact=True)).to_have_count(0)
    choose(page, "counting.py")
    written("knobs.py", f'"""Another text."""\n{source}')
    choose(page, "knobs.py")  # whose run waits at its start: it is one of the present text
    open_tab(page, "About")
    expect(page.get_by_role("heading", name="Another text.")).to_be_visible()
    expect(page.locator(".former")).to_have_count(0)


@pytest.mark.slow
def test_a_design_that_is_inserted_fits_the_new_model_and_can_be_run(page: Page, workbench: Served) -> None:
    shows(page, "#status", "at its start")
    open_tab(page, "Editor")
    page.get_by_role("button", name="New model", exact=True).click()
    page.get_by_label("Name of the file").fill("passing")
    page.get_by_label("An agent with a body in a world").check()
    page.get_by_role("button", name="Create").click()
    expect(page.locator(CODE)).to_have_text(re.compile("Say in one line"))
    page.evaluate("""async () => {
        const { INSERTIONS } = await part("editor/menu.js");
        INSERTIONS.find(({ text }) => text === "a design of an experiment").work();
    }""")
    expect(page.locator(CODE)).to_have_text(re.compile(r"model=\"passing\.py\""))
    page.keyboard.press("Control+s")
    file = workbench.folder / "passing.py"
    until(page, lambda: "@design" in file.read_text(encoding="utf-8"))
    experiment = specify(str(file), participants=1, trials=1)
    row = run_trial(experiment, experiment.design.trial(0), HelperTexts())
    assert row["error"] is None
    assert 1 < row["time"] < 60


@pytest.mark.slow
def test_files_are_copied_renamed_and_deleted_while_one_runs(
    pages: Callable[..., Page], workbench: Served, written: Callable[[str, str], Path]
) -> None:
    written("first.py", MIND.read_text(encoding="utf-8"))
    page = pages("first.py")
    shows(page, "#status", "at its start")
    page.click("#cycle")
    edit(page, "first.py")
    page.get_by_role("button", name="Duplicate").click()
    page.get_by_role("dialog").get_by_role("button", name="Duplicate").click()
    expect(page.get_by_label("File", exact=True)).to_have_value("first_copy.py")
    edit(page, "first.py")
    page.get_by_role("button", name="Rename").click()
    page.get_by_label("New name").fill("sub/second.py")
    page.keyboard.press("Enter")
    expect(page.get_by_label("File", exact=True)).to_have_value("sub/second.py")
    expect(page.get_by_label("Model", exact=True)).to_have_value("sub/second.py")
    shows(page, "#time", "0.05 s")  # the run goes on, under the new name
    expect(page.locator(".strip")).to_have_count(0)
    page.get_by_role("button", name="Delete").click()
    page.get_by_role("button", name="Cancel").click()
    assert (workbench.folder / "sub" / "second.py").is_file()
    page.get_by_role("button", name="Delete").click()
    page.get_by_role("dialog").get_by_role("button", name="Delete").click()
    shows(page, ".former", "file of this run is gone")
    shows(page, ".side select.file", "no file")
    expect(page.get_by_label("Model", exact=True)).to_have_text(re.compile(r"sub/second.py \(not in the folder\)"))
    expect(page.locator(".toast")).to_contain_text("The model «sub/second.py» is in the trash folder.")
    (trash,) = workbench.folder.glob(".workbench/trash/*/*-second.py")
    assert trash.read_text(encoding="utf-8") == MIND.read_text(encoding="utf-8")
    assert not (workbench.folder / "sub" / "second.py").exists()
    page.locator(".toast").get_by_role("button", name="Restore").click()
    expect(page.get_by_label("Model", exact=True)).not_to_have_text(re.compile("not in the folder"))
    expect(page.get_by_label("Model", exact=True)).to_have_value("sub/second.py")
    assert (workbench.folder / "sub" / "second.py").read_text(encoding="utf-8") == MIND.read_text(encoding="utf-8")


def long_after_short(pages: Callable[..., Page], written: Callable[[str, str], Path]) -> Page:
    """Opens a short text and then a long one; from now on, the short one is shown at once."""
    written("long.py", "production = 1\n" * 300)
    written("short.py", "y = 2\n")
    page = pages("counting.py")
    edit(page, "short.py")
    edit(page, "long.py")
    return page


@pytest.mark.slow
def test_another_text_is_shown_while_completions_of_a_longer_one_are_open(
    pages: Callable[..., Page], written: Callable[[str, str], Path]
) -> None:
    page = long_after_short(pages, written)
    write(page, "produ")
    page.keyboard.press("Control+Space")
    expect(page.locator(".cm-tooltip-autocomplete")).to_be_visible()
    page.evaluate(
        """() => {  // both before the next picture: the list of completions is not yet placed when its text is replaced
            document.execCommand("insertText", false, "c");
            const file = document.querySelector("select[aria-label='File']");
            file.value = "short.py";
            file.dispatchEvent(new Event("change", { bubbles: true }));
        }"""
    )
    expect(page.locator(CODE)).to_have_text("y = 2")
    expect(page.locator(".cm-tooltip-autocomplete")).to_have_count(0)
    drawn(page)  # CodeMirror would write an error to the console
    page.get_by_label("File", exact=True).select_option("long.py")
    ends(page, "\nproduc")


@pytest.mark.slow
def test_completions_that_come_after_another_text_is_shown_are_not_for_that_one(
    pages: Callable[..., Page], written: Callable[[str, str], Path]
) -> None:
    page = long_after_short(pages, written)
    with holding(page, "**/api/language", lambda request: '"ask":"complete"' in (request.post_data or "")) as held:
        write(page, "produ")
        page.keyboard.press("Control+Space")
        until(page, lambda: bool(held))
        page.get_by_label("File", exact=True).select_option("short.py")
        expect(page.locator(CODE)).to_have_text("y = 2")
    page.wait_for_timeout(200)  # it would be shown now
    expect(page.locator(".cm-tooltip-autocomplete")).to_have_count(0)
    write(page, "\nx = 1\n")
    ends(page, "\nx = 1\n")


@pytest.mark.slow
def test_each_text_keeps_its_history_and_tab_can_leave(page: Page, workbench: Served) -> None:
    choose(page, "doorway.py")
    edit(page, "doorway.py")
    write(page, "# one")
    choose(page, "counting.py")
    expect(page.get_by_label("File", exact=True)).to_have_value("counting.py")  # the chosen model is shown
    write(page, "# two")
    page.get_by_label("File", exact=True).select_option("doorway.py")
    ends(page, "# one")
    page.locator(CODE).focus()
    page.keyboard.press("Control+f")
    expect(page.locator(".cm-search [name=search]")).to_be_focused()
    page.keyboard.press("Escape")
    expect(page.locator(".cm-search")).to_have_count(0)
    ends(page, "# one")
    page.keyboard.press("Control+z")
    ends(page, '{"walker": agent})\n')
    page.keyboard.press("Tab")
    ends(page, "\n    ")
    page.keyboard.press("Escape")
    page.keyboard.press("Tab")
    expect(page.locator(CODE)).not_to_be_focused()
    page.get_by_label("File", exact=True).select_option("counting.py")
    ends(page, "# two")
    page.locator(CODE).focus()
    page.keyboard.press("Control+z")
    unsaved(page).not_to_have_text(re.compile("unsaved"))


@pytest.mark.slow
def test_failed_opening_or_saving_is_reported(pages: Callable[..., Page], workbench: Served, written: Callable[[str, str], Path]) -> None:
    page = pages("counting.py")
    open_tab(page, "Editor")
    mark = workbench.folder / "ran"
    top = f"from __future__ import annotations\n__import__('os').mkdir({str(mark)!r})\nraise ValueError('at its top')\n"
    source = f"{top}\n\ndef build(parameters: None) -> Simulation: ...\n"
    written("loaded.py", source)
    page.reload()
    edit(page, "loaded.py")
    shows(page, ".problems", "No problems")  # which a check without loading cannot know
    assert not mark.exists()
    page.get_by_role("button", name=re.compile("^Check the model")).click()
    shows(page, ".problems", "line 3ValueError: at its top")
    assert mark.is_dir()
    write(page, "#" * 1_000_001)
    page.keyboard.press("Control+s")
    shows(page, ".toast", "the size of a model file must be <= 1,000,000 bytes")
    assert (workbench.folder / "loaded.py").read_text(encoding="utf-8") == source
    page.keyboard.press("Control+z")


def test_a_file_without_a_name_is_asked_for_again(pages: Callable[..., Page]) -> None:
    page = pages("counting.py", tab="editor")
    for action, confirm in (("New model", "Create"), ("Duplicate", "Duplicate"), ("Rename", "Rename")):
        page.get_by_role("button", name=action, exact=True).click()
        dialog = page.get_by_role("dialog")
        field = dialog.get_by_role("textbox")
        field.fill(" ")
        dialog.get_by_role("button", name=confirm, exact=True).click()
        expect(dialog).to_contain_text("enter a name")
        expect(field).not_to_have_value("")
        dialog.get_by_role("button", name="Cancel").click()
        expect(dialog).to_have_count(0)
