"""Recordings in a real browser: listed, opened, run again, compared, taken away, deleted."""

from __future__ import annotations

import re
import shutil
import time
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Locator, Page, expect

from actr3d.actr.kernel.run_limits import RunLimits
from actr3d.recording import Recording
from actr3d.runner.facts import program_facts
from actr3d.simulation import Simulation
from actr3d.trace import Trace
from actr3d.trace_kinds import GROUPS, KINDS
from actr3d.world import Floor, Mannequin, Scene
from tests.helpers.page import answers, open_tab, shows, until
from tests.helpers.recording_forgery import forge
from tests.helpers.workbench_server import Served


def recorded(workbench: Served, model: str, **settings: Any) -> str:
    """Runs a model to its end; returns its recording."""
    session = workbench.post("/api/sessions", {"model": model, "seed": 1, "settings": settings, "run": True}).json()["id"]
    end = time.monotonic() + 60
    told: dict[str, Any] = {"state": None}
    while told["state"] is None or told["state"]["status"] != "ended":
        assert time.monotonic() < end, told
        time.sleep(0.05)
        told = workbench.get(f"/api/sessions/{session}").json()
    workbench.post(f"/api/sessions/{session}/close")
    return told["session"]["recording"]


@pytest.fixture(scope="module")
def recordings(workbench: Served) -> Iterator[Path]:
    """The folder of recordings, empty before and after."""
    folder = workbench.folder / ".workbench" / "recordings"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir(parents=True, exist_ok=True)  # a run of an earlier test may still be written
    yield folder
    shutil.rmtree(folder, ignore_errors=True)


@pytest.fixture(scope="module")
def two(workbench: Served, recordings: Path) -> list[str]:
    return [recorded(workbench, "doorway.py", width=width) for width in (0.5, 0.9)]


def row(page: Page, name: str) -> Locator:
    return page.locator(f"tr[data-run='{name}']")


@pytest.mark.slow
def test_runs_are_listed_sorted_searched_and_listed_again_when_one_ends(page: Page, recordings: Path, two: list[str]) -> None:
    (recordings / "torn-20250101-101010-aaaa.sqlite").write_bytes(b"<img src=x onerror=alert(1)>" * 100)
    with Recording(recordings / "old-20250102-101010-aaaa.sqlite", {"kind": "program", "form": "actr3d recording 1"}):
        pass
    open_tab(page, "Runs")
    narrow, wide = row(page, two[0]), row(page, two[1])
    told = r"doorway\.py.*width 0\.9 · seed 1.*ended.*the model called stop\(\).*6\.85 s.*1\.\d MB"
    expect(wide).to_contain_text(re.compile(told, re.DOTALL))
    expect(narrow).not_to_contain_text("width")  # it is the default
    expect(page.locator("tr.present")).to_have_count(1)
    expect(row(page, "old-20250102-101010-aaaa")).to_contain_text("unreadable")
    row(page, "torn-20250101-101010-aaaa").click()
    expect(page.get_by_text("This recording cannot be opened: not a recording: it is a file of another kind, or damaged")).to_be_visible()
    expect(page.get_by_role("button", name="Open")).to_be_disabled()

    page.get_by_role("button", name="Sort by time").click()
    expect(page.get_by_role("columnheader").filter(has_text="Time")).to_have_attribute("aria-sort", "descending")
    names = page.locator("tr[data-run]").evaluate_all("rows => rows.map(row => row.dataset.run)")
    assert names[:2] == two[::-1]
    page.get_by_role("button", name="Sort by time").click()
    expect(page.locator("tr[data-run]").last).to_have_attribute("data-run", two[1])
    page.get_by_label("Search recordings").fill("Doorway 0.9")
    expect(page.locator("tr[data-run]")).to_have_count(1)
    page.get_by_label("Search recordings").fill("nothing like this")
    page.get_by_role("button", name="Show all").click()
    expect(wide).to_be_visible()

    present = page.locator("tr.present")
    expect(present).to_contain_text("not over")
    page.click("#run")
    expect(present).to_contain_text("6.80 s")
    expect(present).to_contain_text("the model called stop()")


@pytest.mark.slow
@pytest.mark.parametrize("chosen", [False, True])
def test_a_small_window_lists_several_runs(page: Page, recordings: Path, two: list[str], chosen: bool) -> None:
    open_tab(page, "Runs")
    expect(row(page, two[0])).to_be_visible()
    if chosen:
        row(page, two[0]).click()
    rows = page.locator(".runs-list").evaluate("list => (list.clientHeight - list.querySelector('thead').offsetHeight) / 44")
    assert rows >= 4.5
    if chosen:
        page.get_by_role("button", name="Details").click()
        expect(page.get_by_role("table", name="Parameters")).to_contain_text("width0.5")
    else:
        page.set_viewport_size({"width": 900, "height": 600})
        until(page, lambda: page.locator(".runs-chosen").evaluate("box => box.offsetHeight") < 44)  # one line, as nothing is chosen


HALF = """import os, time
from actr3d.actr import *
class Agent(ACTR):
    goal = Buffer()
    def init():
        goal.set("count 0")
    def count(goal="count ?n!10"):
        while int(n) == 5 and os.path.exists(__file__ + ".held"):
            time.sleep(0.01)
        goal.set(f"count {int(n) + 1}")
Agent().run(1)
"""


SEEDS = """async (seeds) => {
  const { sorted } = await part("runs/table.js");
  return sorted(seeds.map((seed, n) => ({ seed, made: n }))).map(({ seed }) => seed);
}"""


def test_seeds_are_sorted_as_numbers_though_the_largest_are_texts(blank: Page) -> None:
    blank.evaluate("localStorage.setItem('actr3d.runs sorted', JSON.stringify({ by: 'seed', down: false }))")
    blank.reload()
    seeds = ["9223372036854775807", 10, "9007199254740993", 9, None, "9007199254740992"]
    assert blank.evaluate(SEEDS, seeds) == [None, 9, 10, "9007199254740992", "9007199254740993", "9223372036854775807"]


TWICE = """async () => {
  const { cancelReplay, replayRun, replays } = await part("runs/actions.js");
  const asked = [];
  window.fetch = (path, { method, signal }) => {
    if (method === "POST") asked.push(path);
    return new Promise((_, reject) => signal.addEventListener("abort", () => reject(signal.reason)));
  };
  const all = [replayRun({ id: "one" }), replayRun({ id: "one" })];
  cancelReplay("one");
  await Promise.all(all);
  return [asked, replays.value.one.text];
}"""


def test_a_replay_that_is_asked_for_twice_runs_once_and_can_be_cancelled(blank: Page) -> None:
    assert blank.evaluate(TWICE) == [["/api/recordings/one/replay"], "cancelled"]


NAME = """async (seed) => (await part("parts/picture.js")).pictureName({ model: "doorway.py", seed }, "timeline")"""


def test_the_name_of_a_picture_has_no_seed_if_the_run_has_none(blank: Page) -> None:
    assert [blank.evaluate(NAME, seed) for seed in (0, None)] == ["doorway seed 0 timeline", "doorway timeline"]


@pytest.mark.slow
def test_a_recording_that_is_run_again_shows_how_far_it_is(page: Page, workbench: Served, recordings: Path) -> None:
    (workbench.folder / "half.py").write_text(HALF, encoding="utf-8")
    name = recorded(workbench, "half.py")
    held = workbench.folder / "half.py.held"
    held.touch()
    open_tab(page, "Runs")
    page.get_by_role("button", name="Read the list again").click()
    row(page, name).click()
    page.get_by_role("button", name="Replay", exact=True).click()
    expect(page.get_by_text(re.compile(r"running again … [56]\d %, \d+ s"))).to_be_visible()
    share = float(page.get_by_role("progressbar", name="Running again").get_attribute("value") or 0)
    assert 0.5 <= share < 0.7
    held.unlink()
    expect(page.get_by_text("Every byte agrees.")).to_be_visible()
    workbench.post(f"/api/recordings/{name}/delete")
    (workbench.folder / "half.py").unlink()


@pytest.mark.slow
def test_a_recording_is_run_again_taken_away_opened_and_deleted(page: Page, workbench: Served, recordings: Path, two: list[str]) -> None:
    spare = [recorded(workbench, "counting.py") for _ in range(2)]
    open_tab(page, "Runs")
    row(page, two[1]).click()
    page.get_by_role("button", name="Replay", exact=True).click()
    expect(page.get_by_text("Every byte agrees. 685 ticks")).to_be_visible()
    expect(page.get_by_role("link", name="HTML replay")).to_have_attribute("href", re.compile("form=replay.html"))
    with page.expect_download() as taken:
        page.get_by_role("link", name="CSV of events").click()
    assert taken.value.suggested_filename == f"{two[1]}.events.csv"
    assert Path(taken.value.path()).read_text().startswith("time [s],source,kind,data")

    page.get_by_role("button", name="Open", exact=True).click()
    expect(page.locator("#status")).to_have_text(re.compile("at its start"))
    expect(page.locator("#width")).to_have_text(re.compile("90 cm"))
    expect(page.get_by_role("button", name="Compare with the present run")).to_be_disabled()  # it is not recorded once more

    page.get_by_label("Search recordings").fill("counting.py ended")
    page.get_by_label("Choose all that are listed").click()
    page.keyboard.press("Delete")
    page.get_by_role("button", name="Cancel").click()
    assert all((recordings / f"{name}.sqlite").exists() for name in spare)
    page.get_by_role("button", name="Delete 2").click()
    page.get_by_role("dialog").get_by_role("button", name="Delete").click()
    expect(page.get_by_text("No recording has all these words.")).to_be_visible()
    assert not any((recordings / f"{name}.sqlite").exists() for name in spare)
    expect(page.locator(".toast")).to_contain_text("2 recordings are in the trash folder.")
    page.locator(".toast").get_by_role("button", name="Restore").click()
    for name in spare:
        expect(row(page, name)).to_be_visible()
    assert all((recordings / f"{name}.sqlite").exists() for name in spare)
    open_tab(page, "Messages")
    expect(page.get_by_text("in the trash folder")).to_have_count(0)  # which would no longer be true


def delete_by_keys(page: Page, name: str) -> None:
    page.keyboard.press("Shift")  # from now on by keys
    row(page, name).locator("input").focus()
    page.keyboard.press("Space")
    expect(page.get_by_role("button", name="Delete", exact=True)).to_be_visible()
    page.keyboard.press("Delete")
    expect(page.get_by_role("dialog").get_by_role("button", name="Cancel")).to_be_focused()
    page.keyboard.press("Tab")
    page.keyboard.press("Enter")


def test_after_a_row_was_deleted_by_keys_the_next_one_has_the_focus(page: Page, workbench: Served, recordings: Path) -> None:
    shutil.copy(workbench.folder / "counting.py", workbench.folder / "own_counting.py")  # other tests have left recordings of counting.py
    names = [recorded(workbench, "own_counting.py") for _ in range(3)]
    open_tab(page, "Runs")
    page.get_by_label("Search recordings").fill("own_counting.py ended")
    rows = page.locator("tr[data-run]")
    expect(rows).to_have_count(3)
    order = [str(rows.nth(n).get_attribute("data-run")) for n in range(3)]
    assert sorted(names) == sorted(order)
    for gone, focused in (order[1], order[2]), (order[2], order[0]):
        delete_by_keys(page, gone)
        expect(row(page, gone)).to_have_count(0)
        expect(row(page, focused).locator("input")).to_be_focused()
    page.locator(".toast").get_by_role("button", name="Restore").focus()
    page.keyboard.press("Enter")
    expect(row(page, order[2])).to_be_visible()
    expect(row(page, order[0]).locator("input")).to_be_focused()  # where the focus was before
    row(page, order[2]).locator("input").focus()
    page.keyboard.press("Space")
    page.keyboard.press("Delete")
    page.get_by_role("dialog").get_by_role("button", name="Delete").click()
    page.get_by_role("button", name="Read the list again").click()
    expect(rows).to_have_count(1)


@pytest.mark.slow
def test_after_the_only_row_was_deleted_by_keys_the_search_has_the_focus(page: Page, workbench: Served, recordings: Path) -> None:
    name = recorded(workbench, "counting.py")
    open_tab(page, "Runs")
    page.get_by_label("Search recordings").fill(name[-4:])
    expect(page.locator("tr[data-run]")).to_have_count(1)
    delete_by_keys(page, name)
    expect(page.get_by_text("No recording has all these words.")).to_be_visible()
    expect(page.get_by_label("Search recordings")).to_be_focused()
    page.locator(".toast").get_by_role("button", name="Restore").focus()
    page.keyboard.press("Enter")
    expect(row(page, name)).to_be_visible()
    expect(page.get_by_label("Search recordings")).to_be_focused()
    row(page, name).locator("input").focus()
    page.keyboard.press("Space")
    page.keyboard.press("Delete")
    page.get_by_role("dialog").get_by_role("button", name="Delete").click()
    expect(row(page, name)).to_have_count(0)


def show_copies(page: Page, workbench: Served, recordings: Path, called: str) -> list[Path]:
    """Shows 60 recordings in the list, copies of one, and no others; returns them, the oldest first."""
    original = recordings / f"{recorded(workbench, 'counting.py')}.sqlite"
    copies = [recordings / f"{called}-20200101-{n // 60:02}{n % 60:02}00-aaaa.sqlite" for n in range(60)]
    for copy in copies:
        shutil.copy(original, copy)
    original.unlink()
    open_tab(page, "Runs")
    page.get_by_label("Search recordings").fill(called)
    return copies


@pytest.mark.slow
def test_the_focus_stays_with_its_row_when_the_list_is_scrolled(page: Page, workbench: Served, recordings: Path) -> None:
    copies = show_copies(page, workbench, recordings, "long")
    order = [copy.stem for copy in reversed(copies)]
    box = row(page, order[5]).locator("input")
    place = page.locator(".runs-list")
    page.keyboard.press("Shift")  # from now on by keys
    box.focus()
    for share in (0.2, 0.4, 0.6, 0.8, 1.0, 0.5, 0.0, 1.0):
        top = place.evaluate("(list, share) => (list.scrollTop = share * (list.scrollHeight - list.clientHeight))", share)
        expect(row(page, order[round(share * 59)])).to_be_visible()
        expect(box).to_be_focused()
        assert place.evaluate("list => list.scrollTop") == pytest.approx(top, abs=1)
        assert place.evaluate("list => list.scrollHeight") < 62 * 44
    page.keyboard.press("Space")
    expect(page.locator("tr.chosen")).to_have_attribute("data-run", order[5])
    place.evaluate("list => (list.scrollTop = list.scrollHeight)")
    expect(row(page, order[59])).to_be_visible()
    page.keyboard.press("Delete")
    expect(page.get_by_role("dialog")).to_contain_text("Delete the recording")
    page.keyboard.press("Tab")
    page.keyboard.press("Enter")
    expect(row(page, order[5])).to_have_count(0)
    expect(row(page, order[6]).locator("input")).to_be_focused()
    expect(row(page, order[6]).locator("input")).to_be_in_viewport()
    page.get_by_label("Search recordings").focus()
    for copy in copies:
        copy.unlink(missing_ok=True)


@pytest.mark.slow
@pytest.mark.parametrize(("key", "step"), [("Tab", 1), ("Shift+Tab", -1)])
def test_a_key_leads_from_a_row_that_is_scrolled_away_to_the_one_beside_it(
    page: Page, workbench: Served, recordings: Path, key: str, step: int
) -> None:
    copies = show_copies(page, workbench, recordings, "tabs")
    order = [copy.stem for copy in reversed(copies)]
    page.keyboard.press("Shift")  # from now on by keys
    row(page, order[5]).locator("input").focus()
    page.locator(".runs-list").evaluate("list => (list.scrollTop = list.scrollHeight)")
    expect(row(page, order[59])).to_be_visible()
    expect(row(page, order[5]).locator("input")).to_be_focused()
    page.keyboard.press(key)
    expect(row(page, order[5 + step]).locator("input")).to_be_focused()
    page.get_by_label("Search recordings").focus()
    for copy in copies:
        copy.unlink(missing_ok=True)


@pytest.mark.slow
def test_files_are_added_by_choosing_or_dropping_them(pages: Callable[..., Page], recordings: Path, two: list[str], tmp_path: Path) -> None:
    page = pages("counting.py", refusals=True)
    file = tmp_path / "of a colleague.sqlite"
    shutil.copy(recordings / f"{two[0]}.sqlite", file)
    open_tab(page, "Runs")
    with page.expect_file_chooser() as chooser:
        page.get_by_role("button", name="Add files …").click()
    chooser.value.set_files(file)
    expect(page.locator(".recording-banner")).to_contain_text("of a colleague")
    expect(row(page, "of_a_colleague")).to_have_class(re.compile("chosen"))
    expect(row(page, "of_a_colleague").locator("b").first).to_have_text("of a colleague")

    transfer = page.evaluate_handle(
        """() => {
          const all = new DataTransfer();
          for (const name of ["one.sqlite", "two.sqlite"]) all.items.add(new File(["no recording"], name));
          return all;
        }"""
    )
    page.locator(".runs").dispatch_event("dragover", {"dataTransfer": transfer})
    expect(page.locator(".runs")).to_have_class(re.compile("dropping"))
    page.locator(".runs").dispatch_event("drop", {"dataTransfer": transfer})
    expect(page.locator(".runs")).not_to_have_class(re.compile("dropping"))
    expect(page.locator(".toast")).to_contain_text("two.sqlite is not added to the recordings: ")
    assert not list(recordings.glob("two*"))


@pytest.mark.slow
def test_several_downloads_at_once_arrive_whole_and_a_failed_one_is_reported(
    pages: Callable[..., Page], workbench: Served, recordings: Path, two: list[str]
) -> None:
    page = pages(refusals=True)
    forms = {"SQLite": "sqlite", "HTML replay": "replay.html", "CSV of events": "events.csv", "CSV of states": "states.csv"}
    open_tab(page, "Runs")
    row(page, two[1]).click()
    taken: dict[str, Path] = {}
    page.on("download", lambda one: taken.update({one.suggested_filename: one.path()}))
    page.evaluate("titles => document.querySelectorAll('.downloads a').forEach(link => (link.click(), link.click()))", list(forms))
    expect(page.get_by_role("list", name="Downloads")).to_have_count(0)
    until(page, lambda: len(taken) == 4)
    for form in forms.values():
        whole = workbench.get(f"/api/recordings/{two[1]}/file", params={"form": form}).content
        assert taken[f"{two[1]}.{form}"].read_bytes() == whole

    path = recordings / "trials.sqlite"
    with (
        Recording(path, program_facts(str(workbench.folder / "trials.py"), "", 1, None)) as recording,
        RunLimits(trace=Trace(), recorder=recording),
    ):
        Simulation(Scene(parts=(Floor(), Mannequin()))).run(0.1)
        recording.fact("reached", 0.1)
    spare = recorded(workbench, "counting.py")
    page.get_by_role("button", name="Read the list again").click()
    page.get_by_label("Search recordings").fill("trials.py")
    row(page, path.stem).click()
    expect(page.locator(".downloads a")).to_have_text(list(forms))  # a program with a simulation has a scene
    page.get_by_label("Search recordings").fill("counting.py")
    row(page, spare).click()
    link = page.get_by_role("link", name="CSV of events")
    expect(page.locator(".downloads a")).to_have_text(["SQLite", "CSV of events"])
    (recordings / f"{spare}.sqlite").unlink()
    link.evaluate("link => link.click()")  # before the list is read again and has it no more
    expect(page.locator(".toast")).to_contain_text(
        re.compile(r"Not downloaded: CSV of events of counting\.py .*: there is no such recording")
    )
    path.unlink()


def test_a_recording_from_elsewhere_shows_its_code_and_asks_before_it_is_run(
    pages: Callable[..., Page], workbench: Served, recordings: Path
) -> None:
    page = pages(refusals=True)
    spare = recorded(workbench, "counting.py")
    far = recordings / "far.sqlite"
    until(page, lambda: not (recordings / f"{spare}.sqlite-wal").exists())  # its writer has closed it
    (recordings / f"{spare}.sqlite").rename(far)
    forge(far, key=b"another key")
    open_tab(page, "Runs")
    page.get_by_role("button", name="Read the list again").click()
    row(page, "far").click()
    page.get_by_role("button", name="Replay", exact=True).click()
    dialog = page.get_by_role("dialog", name="A recording from elsewhere")
    expect(dialog).to_contain_text("This installation did not make the recording far, or it was changed since. Replaying it runs the code")
    expect(dialog.locator("pre")).to_contain_text("class Counting(ACTR)")
    dialog.get_by_role("button", name="Cancel").click()
    expect(page.get_by_text("Not known. cancelled")).to_be_visible()
    page.get_by_role("button", name="Replay", exact=True).click()
    dialog.get_by_role("button", name="Run its code").click()
    expect(page.get_by_text("Every byte agrees.")).to_be_visible()
    page.get_by_role("button", name="Open", exact=True).click()
    dialog.get_by_role("button", name="Cancel").click()
    assert all(one["recorded"] is None for one in workbench.get("/api/sessions").json()["sessions"])
    page.get_by_role("button", name="Open", exact=True).click()
    dialog.get_by_role("button", name="Run its code").click()
    expect(page).to_have_url(re.compile("run=far"))
    far.unlink()


def test_a_recording_that_goes_on_has_no_verdict_of_a_replay_before(pages: Callable[..., Page], recordings: Path) -> None:
    page = pages("counting.py")
    page.click("#cycle")
    shows(page, "#time", "0.05 s")
    open_tab(page, "Runs")
    page.locator("tr.present").first.click()
    page.get_by_role("button", name="Replay", exact=True).click()
    verdict = page.locator(".replayed")
    expect(verdict).to_contain_text("It agrees up to the end of the recording.")
    page.click("#cycle")
    shows(page, "#time", "0.15 s")
    page.get_by_role("button", name="Read the list again").click()
    expect(verdict).to_have_text("The recording has changed since it was replayed.")
    page.get_by_role("button", name="Replay", exact=True).click()
    expect(verdict).to_contain_text("It agrees up to the end of the recording.")


def test_what_the_present_run_writes_is_not_deleted(pages: Callable[..., Page], recordings: Path) -> None:
    page = pages("counting.py")
    open_tab(page, "Runs")
    name = page.locator("tr.present").first.get_attribute("data-run")
    page.locator("tr.present").first.click()
    page.keyboard.press("Delete")
    expect(page.locator(".toast")).to_contain_text("Not deleted: an open run still writes counting.py")
    assert (recordings / f"{name}.sqlite").exists()


IN_ITS_BOX = """row => {
  const [inner, outer] = [row, row.closest(".parting")].map((one) => one.getBoundingClientRect());
  return inner.top >= outer.top && inner.bottom <= outer.bottom;
}"""


@pytest.mark.slow
def test_runs_without_a_body_are_compared_by_what_their_agents_did(pages: Callable[..., Page]) -> None:
    page = pages("counting.py")  # its tab Runs is not open
    expect(page.locator("#status")).to_contain_text("at its start")
    runs = page.evaluate(
        """async () => {
          const { request } = await part("server.js");
          const { alive, session, state } = await part("store.js");
          const made = [];
          for (const seed of [1, 2]) {
            const before = session.value.run;
            await request({ type: "restart", seed, run: true });
            const isOver = () => session.value.run > before && alive.value && state.value.status === "ended";
            while (!isOver()) await new Promise((done) => setTimeout(done, 50));
            made.push(session.value.recording);
          }
          (await part("compare/compare.js")).compareRuns(...made);
          return made;
        }"""
    )
    assert len(set(runs)) == 2
    dialog = page.get_by_role("dialog", name="Two runs")
    expect(page.get_by_role("banner")).to_have_count(1)  # that of the page
    latency = dialog.get_by_role("figure", name="memory latency")
    expect(latency.locator(".plot-of")).to_have_text([re.compile("first"), re.compile("second")])
    dialog.get_by_label("Add a curve").select_option(label="memory busy")
    busy = dialog.get_by_role("figure", name="memory busy")
    canvas = busy.locator("canvas")
    area = canvas.bounding_box()
    assert area is not None
    canvas.hover(position={"x": area["width"] - 10, "y": 20})
    expect(busy.locator("output")).to_have_text([re.compile(r"\d"), re.compile(r"\d")])  # it goes on to the end of both runs


@pytest.mark.slow
def test_two_runs_are_compared(page: Page, two: list[str]) -> None:
    open_tab(page, "Runs")
    row(page, two[0]).locator("input").check()
    row(page, two[1]).locator("input").check()
    page.get_by_role("button", name="Compare", exact=True).click()
    dialog = page.get_by_role("dialog", name="Two runs")
    sides = dialog.get_by_role("table", name="Side by side")
    expect(sides.locator("tr.other").first).to_have_text(re.compile(r"≠width \[m\]0.[59]0.[59]"))
    expect(sides).to_contain_text("seed11")
    page.set_viewport_size({"width": 853, "height": 533})  # 1280 x 800 at 150 %
    fits = "box => box.scrollWidth <= box.clientWidth"
    assert dialog.locator(".compare-facts").evaluate(fits), "the table fits"
    assert dialog.locator(".parting").evaluate(fits), "both runs of the trace"
    expect(dialog.get_by_role("figure").first.locator("canvas")).to_be_in_viewport(ratio=0.7)
    until(page, lambda: dialog.locator(".parting tr.here").evaluate(IN_ITS_BOX))
    page.set_viewport_size({"width": 1280, "height": 800})
    assert dialog.locator(".plot-of").evaluate_all("all => all.every((one) => one.scrollWidth <= one.clientWidth)"), "no name is cut"
    sides.get_by_label("differences only").check()
    expect(sides).not_to_contain_text("seed")

    expect(dialog.get_by_text(re.compile(r"The first \d+ events are the same; the traces first differ at"))).to_be_visible()
    around = dialog.get_by_role("table", name="Events around the first difference")
    expect(around.locator("tr.here")).to_have_count(1)
    choice = dialog.get_by_label("Which events are compared")
    with_kinds = {kind.group for kind in KINDS.values()}
    expect(choice.locator("option")).to_have_text(["all events", *(group.title for name, group in GROUPS.items() if name in with_kinds)])
    choice.select_option("Firings")
    expect(around.locator("tr.here")).to_contain_text(re.compile("walker.*turn"))
    expect(dialog.get_by_role("list", name="What differs")).to_contain_text(re.compile("event.*turn"))

    expect(dialog.get_by_role("figure", name="walker speed")).to_be_visible()
    dialog.get_by_label("Add a curve").select_option("walker_torso_yaw speed")
    plot = dialog.get_by_role("figure", name="walker_torso_yaw speed")
    expect(plot.locator(".plot-of")).to_have_text([re.compile("first"), re.compile("second")])
    with page.expect_download() as taken:
        plot.get_by_role("button", name="SVG").click()
    picture = Path(taken.value.path()).read_text()
    assert picture.count("<path") + picture.count("<polyline") >= 2
    assert "doorway.py" in picture
    with page.expect_download() as taken:
        plot.get_by_role("button", name="CSV").click()
    head, *values = Path(taken.value.path()).read_text().splitlines()
    assert re.fullmatch(r'"time \[s\]","walker_torso_yaw speed first: .*","walker_torso_yaw speed second: .*"', head)
    assert values[0].startswith("0,")
    assert "" in values[-1].split(",")  # the shorter run has no values after its end
    canvas = plot.locator("canvas")
    area = canvas.bounding_box()
    assert area is not None
    canvas.hover(position={"x": area["width"] - 9, "y": 20})
    assert plot.locator("output").all_text_contents().count("–") == 1
    written = "async () => (await part('runs/wording.js')).measureText('x_n_s', 0)"
    assert page.evaluate(written) == "0 N s"
    first = "async () => (await part('runs/wording.js')).resultText({ result: { outcome: 'hit', impulse_n_s: 2, peak_angle_deg: 3 } })"
    assert page.evaluate(first) == "2.0 N s"
    page.keyboard.press("Escape")
    expect(dialog).to_have_count(0)


def test_compared_branches_are_told_apart_and_what_neither_has_is_no_difference(blank: Page) -> None:
    def branch(at: float | None, result: dict[str, Any] | None) -> dict[str, Any]:
        own = {"id": f"run_{at}", "model": "doorway.py", "made": 1.7e9, "label": {"name": ""}, "branched": at, "origin": None}
        end = {"result": result, "ended": "left", "time": 1, "events": 1, "size": 1, "problem": None, "failed": None}
        return own | end | {"ancestors": [], "parameters": {}, "seed": 1}

    runs = [branch(2.0, {"onset_time": None, "peak": 2}), branch(0.5, {"peak": 3})]
    event = [10, "walker", "output", {"text": "long " * 100}]
    difference: dict[str, Any] = {"time": 1e-5, "before": [], "events": [event, None], "after": [[], []]}
    compared: dict[str, Any] = {"runs": runs, "changed": [{}, {}], "units": {}, "text": [], "same_events": 0, "whole": True}
    answers(blank, "/api/compare", compared | {"difference": difference})
    long = {"name": "walker.DM: " + "plan:1 " * 50, "unit": "", "group": "activation", "of": None, "shape": "line"}
    curves = {"names": [{"name": "walker speed", "unit": "m/s", "group": "speed", "of": None, "shape": "line"}, long]}
    for run in runs:
        answers(blank, f"/api/recordings/{run['id']}/curves", curves | {"times": [0, 1], "curves": {"walker speed": [0, 1]}, "events": {}})
    blank.evaluate("async (ids) => (await part('compare/compare.js')).compareRuns(...ids)", [run["id"] for run in runs])
    dialog = blank.get_by_role("dialog", name="Two runs")
    plot = dialog.get_by_role("figure", name="walker speed")
    names = [re.compile(r"^first: .+, branch at 2\.00 s$"), re.compile(r"^second: .+, branch at 0\.50 s$")]
    expect(plot.locator(".plot-of")).to_have_text(names)
    plot.locator("canvas").hover()
    expect(plot.locator("output").first).not_to_be_empty()
    fits = "all => all.every((one) => one.scrollWidth <= one.clientWidth)"
    assert plot.locator(".plot-of").evaluate_all(fits), "no name is cut"
    assert dialog.locator(".compare-course").evaluate_all(fits), "the list of curves is no wider than the dialog"
    expect(dialog.locator("tr.other").filter(has_text=re.compile("onset|peak"))).to_have_text(["≠peak23"])
    expect(dialog.locator(".headline")).to_have_text("Only the first run has such events.")
    blank.keyboard.press("Escape")


@pytest.mark.slow
def test_an_opened_recording_is_the_present_run_and_keys_in_a_comparison_do_nothing_in_the_list(page: Page, two: list[str]) -> None:
    open_tab(page, "Runs")
    row(page, two[0]).dblclick()
    expect(page.locator(".recording-banner")).to_contain_text(two[0])
    expect(row(page, two[0]).locator(".present-mark")).to_have_text("present")
    row(page, two[1]).click()
    page.get_by_role("button", name="Compare with the present run").click()
    dialog = page.get_by_role("dialog", name="Two runs")
    expect(dialog.locator(".compare-run").last).to_contain_text("present")
    only = dialog.get_by_label("differences only")
    only.press("Delete")
    expect(page.get_by_role("dialog")).to_have_count(1)
    only.press("Enter")
    expect(page.get_by_text("Opening …")).to_have_count(0)
    assert page.url.endswith(f"run={two[0]}")


@pytest.mark.slow
def test_changes_during_a_run_are_shown_beside_its_initial_values(page: Page, two: list[str]) -> None:
    expect(page.locator("#status")).to_have_text(re.compile("at its start"))
    page.click("#step")
    expect(page.locator("#time")).to_have_text("t = 0.01 s")
    page.locator("#aperture").fill("90")
    expect(page.locator("#width")).to_have_text(re.compile("90 cm"))
    page.click("#step")
    expect(page.locator("#time")).to_have_text("t = 0.02 s")
    open_tab(page, "Runs")
    row(page, two[0]).click()
    page.get_by_role("button", name="Compare with the present run").click()
    sides = page.get_by_role("dialog", name="Two runs").get_by_role("table", name="Side by side")
    expect(sides.get_by_role("row", name=re.compile("width"))).to_have_text(re.compile(r"≠width \[m\]0\.5.* → 0\.9 at 0\.01 s$"))


Event = tuple[str, dict[str, Any] | None]
"""A kind and its data."""
CHOICES = [["go", [0.5], 0, 1.5], ["stay", [0.5], 0, 0.5]]
DIFFERENT: list[tuple[Event, Event, list[list[str]]]] = [
    (("buffer", {"chunk": {"0": "count", "1": "2"}}), ("buffer", {"chunk": {"0": "count", "1": "3"}}), [["holds", "count 2", "count 3"]]),
    (("buffer", {"chunk": {"isa": "a", "width": 0.504}}), ("buffer", {"chunk": {"isa": "a", "width": 0.4}}), [["width", "0.504", "0.4"]]),
    (("buffer", {"chunk": {"x": 1e-20}}), ("buffer", {"chunk": {"x": 2e-20}}), [["x", "1e-20", "2e-20"]]),
    (("buffer", {"chunk": None}), ("buffer", {"chunk": {"isa": "a"}}), [["holds", "nothing", "isa:a"]]),
    (("sight", {"failed": True}), ("sight", {"failed": False, "chunk": {"isa": "a"}}), [["sees", "nothing of that kind", "isa:a"]]),
    (("add", {"chunk": {"a": "1"}, "merged": True}), ("add", {"chunk": {"a": "2"}, "merged": True}), [["a", "1", "2"]]),
    (("add", {"chunk": {"a": "1"}, "size": 3}), ("add", {"chunk": {"a": "1"}, "size": 4}), [["size", "3", "4"]]),
    (("fire", {"production": "go", "bound": {"n": "2"}}), ("fire", {"production": "go", "bound": {"n": "3"}}), [["n", "2", "3"]]),
    (("fire", {"production": "go", "bound": {"n": "2"}}), ("fire", {"production": "stay", "bound": None}), [["event", "go n=2", "stay"]]),
    (("conflict", {"utilities": {"go": 1.25}}), ("conflict", {"utilities": {"go": 1}}), [["utility of go", "1.25", "1"]]),
    (("request", {"asked": "0:a 1:?b"}), ("request", {"asked": "0:a 1:?c"}), [["request", "a ?b", "a ?c"]]),
    (
        ("request", {"asked": "a", "candidates": CHOICES}),
        ("request", {"asked": "a", "candidates": CHOICES[:1]}),
        [["activation of stay", "0.5", "–"]],
    ),
    (("request", {"call": "turn", "angle": 1}), ("request", {"call": "turn", "angle": 2}), [["angle", "1", "2"]]),
    (
        ("retrieval", {"failed": False, "chunk": "a"}),
        ("retrieval", {"failed": True}),
        [["event", "retrieved a", "fails nothing is retrieved"]],
    ),
    (
        ("search", {"asked": "isa:a", "noticed": [[{"x": 1}, 0.5]]}),
        ("search", {"asked": "isa:a", "noticed": [[{"x": 2}, 0.5]]}),
        [["noticed 1 x", "1", "2"]],
    ),
    (
        ("move", {"movement": "turn", "group": "torso", "speed": 1}),
        ("move", {"movement": "turn", "group": "torso", "speed": 2}),
        [["speed", "1", "2"]],
    ),
    (
        ("moved", {"movement": "turn", "group": "torso", "end": "done"}),
        ("select", {"production": "go"}),
        [["event", "moved turn (torso): done", "chosen go"]],
    ),
    (
        ("state", {"speed": {"x": 1, "y": 2}}),
        ("state", {"speed": {"x": 1, "y": 3}, "constructor": 1}),
        [["speed y", "2", "3"], ["constructor", "–", "1"]],
    ),
]
"""Pairs of events, and what differs."""


@pytest.mark.slow
def test_what_differs_is_worded_as_in_trace_and_timeline(page: Page, recordings: Path) -> None:
    worded = "async (pairs) => { const { differing } = await part('compare/difference.js'); return pairs.map(differing); }"
    pairs = [[[10_000, "agent", *one], [10_000, "agent", *other]] for one, other, _ in DIFFERENT]
    assert page.evaluate(worded, pairs) == [expected for *_, expected in DIFFERENT]
    later = [[950_000, "goal", "buffer", {"chunk": None}], [950_001, "visual", "buffer", {"chunk": None}]]
    assert page.evaluate(worded, [later]) == [[["time [s]", "0.95", "0.950001"], ["source", "goal", "visual"]]]

    say = "async (command) => void (await (await part('server.js')).request(command))"
    expect(page.locator("#status")).to_have_text(re.compile("at its start"))
    page.evaluate(say, {"type": "until", "time": 0.2})
    expect(page.locator("#status")).to_have_text(re.compile(r"at 0\.2 s"))
    page.evaluate(say, {"type": "command", "word": "aperture", "values": [0.51]})
    page.evaluate(say, {"type": "step", "ticks": 5})
    expect(page.locator("#time")).to_have_text("t = 0.25 s")
    page.evaluate(say, {"type": "seek", "time": 0.2})
    page.evaluate(say, {"type": "command", "word": "aperture", "values": [0.49]})
    page.get_by_role("region", name="Branches").get_by_role("button", name="Compare").click()
    dialog = page.get_by_role("dialog", name="Two runs")
    dialog.get_by_label("Which events are compared").select_option("all events")
    expect(dialog.get_by_role("list", name="What differs").get_by_role("listitem")).to_have_text("aperture 51 cm 49 cm")
    expect(dialog.locator(".parting tr.here .event")).to_have_text(["user aperture 51 cm", "user aperture 49 cm"])


@pytest.mark.slow
def test_a_recording_is_compared_with_the_present_run_of_another_model(pages: Callable[..., Page], two: list[str]) -> None:
    page = pages("counting.py")
    expect(page.locator("#status")).to_have_text(re.compile("at its start"))
    open_tab(page, "Runs")
    row(page, two[0]).click()
    page.get_by_role("button", name="Compare with the present run").click()
    dialog = page.get_by_role("dialog", name="Two runs")
    expect(dialog.get_by_text("These are two different models")).to_be_visible()
    expect(dialog.locator(".compare-run").nth(1)).to_contain_text("present")
    expect(dialog.get_by_role("figure", name="walker speed").locator(".plot-of")).to_have_count(1)


@pytest.mark.slow
def test_of_a_thousand_recordings_those_are_drawn_that_are_seen(pages: Callable[..., Page], workbench: Served, recordings: Path) -> None:
    name = recorded(workbench, "counting.py")
    copies = [recordings / f"many-20200101-{n // 60:02}{n % 60:02}00-aaaa.sqlite" for n in range(1000)]
    for copy in copies:
        shutil.copy(recordings / f"{name}.sqlite", copy)
    page = pages("counting.py")  # without a 3D view, which takes long to draw without a graphics card
    open_tab(page, "Runs")
    page.get_by_label("Search recordings").fill("many")
    expect(page.get_by_text(re.compile(r"^1000 of \d+$"))).to_be_visible()
    assert page.locator("tr[data-run]").count() < 50
    page.locator(".runs-list").evaluate("list => list.scrollTop = list.scrollHeight")
    expect(row(page, copies[0].stem)).to_be_visible()
    page.get_by_role("button", name="Sort by began").click()
    expect(row(page, copies[-1].stem)).to_be_visible()
    for copy in copies:
        copy.unlink()


@pytest.mark.slow
def test_in_a_narrow_panel_each_button_of_the_head_can_be_pressed(pages: Callable[..., Page], workbench: Served, two: list[str]) -> None:
    page = pages("counting.py", width=500, height=400)
    page.goto(f"{workbench.url}/?model=counting.py&panel=runs")
    for width in (500, 320):
        page.set_viewport_size({"width": width, "height": 400})
        for column in ("model", "outcome", "end", "time", "size"):
            page.get_by_role("button", name=f"Sort by {column}").click()
            expect(page.locator(".runs-table th").filter(has=page.get_by_role("button", name=f"Sort by {column}"))).to_have_attribute(
                "aria-sort", re.compile("ascending|descending")
            )
        expect(row(page, two[0]).locator(".names")).to_be_visible()
        assert row(page, two[0]).locator(".names").evaluate("names => names.offsetWidth") >= 76
