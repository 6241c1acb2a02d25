"""Experiments in a real browser: chosen, changed, run, watched, read, and each trial opened."""

from __future__ import annotations

import json
import re
import shutil
from collections.abc import Callable, Iterator
from typing import Any

import pytest
from playwright.sync_api import Page, Route, expect

from actr3d.experiment.report.page import page as report_page
from tests.helpers.experiments import SLOW_COUNTER, write_experiment
from tests.helpers.page import answers, holding, open_tab, until
from tests.helpers.workbench_server import Served


@pytest.fixture(scope="module")
def design(workbench: Served) -> Iterator[str]:
    """A small experiment in a folder among the models."""
    folder = workbench.folder / "course"
    folder.mkdir()
    yield f"course/{write_experiment(folder, model=SLOW_COUNTER).name}:counting"
    shutil.rmtree(folder)


def test_an_experiment_is_changed_run_and_looked_into(pages: Callable[..., Page], workbench: Served, design: str) -> None:
    page = pages(design.partition(":")[0], tab=None)
    open_tab(page, "Experiments")
    expect(page.get_by_text("No experiments yet.")).to_be_visible()
    page.get_by_role("button", name="New experiment").click()
    designs = page.get_by_label("Design", exact=True)
    expect(designs).to_have_value(design)  # of the file that is shown
    designs.select_option("fan_effect")
    designs.select_option("critical_ratio")
    expect(page.locator(".description code")).to_have_text("predictive")
    designs.select_option(design)
    foot = page.locator(".foot")
    expect(foot).to_contain_text("24 trials")
    levels = page.get_by_label("Levels of n")
    expect(levels).to_have_value("1, 2, 5")
    levels.fill("1, 2, 2")
    expect(foot).to_contain_text("n: levels, each once, separated by commas; 2 is there twice (got '1, 2, 2')")
    levels.fill("1, ")
    expect(foot).to_contain_text("n: levels, each once, separated by commas; one is empty (got '1, ')")
    levels.fill("1, 2, 5, 9")
    page.get_by_label("trials a combination").fill("3")
    expect(foot).to_contain_text("24 trials")  # 4 numbers, 3 times, 2 participants
    page.get_by_label("processes").fill("1")
    page.get_by_label("Set another parameter").select_option("mode")
    page.get_by_label("Value of mode").fill("count")
    expect(foot).to_contain_text("s a trial")
    curves = page.get_by_role("button", name="Curves")
    curves.focus()  # on the way through the page, before Run
    foot.get_by_role("button", name="Run").press("Enter")

    expect(page.locator(".tools .state")).to_have_text("finished")
    expect(page.get_by_role("button", name="Experiments", exact=True)).to_be_focused()
    expect(page.locator(".progress")).to_contain_text("24 of 24 trials")
    points = page.locator(".point")
    expect(points).to_have_count(4)
    expect(points.nth(2)).to_have_attribute("aria-label", re.compile(r"Trials of n 5: 0\.300 .*\(2 participants, 6 trials\)"))
    points.nth(2).press("Enter")
    rows = page.locator(".trials tbody tr")
    expect(rows).to_have_count(6)
    expect(page.get_by_role("button", name="Trials", exact=True)).to_be_focused()
    page.get_by_role("button", name="Any n").click()
    expect(rows).to_have_count(24)
    page.get_by_role("button", name="Sort by luck").click()
    expect(page.get_by_role("columnheader").filter(has_text="luck")).to_have_attribute("aria-sort", "descending")
    (made,) = workbench.get("/api/experiments").json()["experiments"]
    sorted_rows = workbench.get(f"/api/experiments/{made['id']}/rows", params={"sort": "luck", "down": True}).json()["rows"]
    number = str(sorted_rows[0]["trial"])
    expect(rows.first.locator("td").first).to_have_text(number)
    rows.first.click()
    expect(page).to_have_url(re.compile(rf"run=counting_trial_{number}-"))
    assert page.evaluate("document.readyState") == "complete"
    expect(page.get_by_text("Recording", exact=True)).to_be_visible()

    page.reload()
    expect(page.locator(".tools .name")).to_have_text("counting")  # the experiment is still shown
    page.get_by_role("button", name="Design").click()
    expect(page.locator(".about-design")).to_contain_text("trials 3 · n 1, 2, 5, 9 · mode count")
    expect(page.get_by_role("row", name="model", exact=False).locator("td")).to_have_text("course/counter.py, as it was at the beginning")
    page.get_by_role("button", name="Make report").click()
    report = page.frame_locator("iframe.report")
    expect(report.get_by_role("heading", level=1)).to_have_text("counting", timeout=120_000)
    with page.expect_download() as download:
        report.get_by_role("link", name="CSV").first.click()
    assert download.value.suggested_filename.endswith(".csv")
    assert download.value.path().stat().st_size > 0


def test_the_form_says_that_the_list_of_designs_is_late(pages: Callable[..., Page]) -> None:
    page = pages("counting.py", tab="experiments")
    with holding(page, "**/api/designs", lambda _: True):
        page.get_by_role("button", name="New experiment").click()
        expect(page.get_by_text("Reading the designs …")).to_be_visible()
    expect(page.get_by_label("Design", exact=True)).to_be_visible()
    expect(page.get_by_text("Reading the designs …")).to_have_count(0)


def test_the_form_asks_again_for_a_list_of_designs_that_could_not_be_read(pages: Callable[..., Page], workbench: Served) -> None:
    page = pages("counting.py", tab="experiments")
    answers(page, "/api/designs", {"error": "too much is asked at once"}, status=503)
    page.get_by_role("button", name="New experiment").click()
    problem = page.get_by_text("The designs cannot be listed: too much is asked at once")
    expect(problem).to_be_visible()
    answers(page, "/api/designs", workbench.get("/api/designs").json())
    expect(page.get_by_label("Design", exact=True)).to_be_visible()
    expect(problem).to_have_count(0)


@pytest.mark.slow
def test_two_pages_see_an_experiment_stop_and_go_on(pages: Callable[..., Page], workbench: Served, design: str) -> None:
    wanted = {"design": design, "trials": 1000, "workers": 1}
    name = workbench.post("/api/experiments", wanted).json()["id"]
    first, second = (pages("counting.py", tab="experiments", refusals=True) for _ in range(2))
    for page in (first, second):
        row = page.locator(f"tr[data-experiment='{name}']")
        expect(row.locator(".name")).to_have_text("countingcourse/counter.pytrials 1000")
        row.click()
        expect(page.locator(".point")).not_to_have_count(0)
    first.get_by_role("button", name="Stop", exact=True).click()
    for page in (first, second):
        expect(page.locator(".tools .state")).to_have_text("stopped")
    done = workbench.get(f"/api/experiments/{name}").json()["done"]
    second.get_by_role("button", name="Resume").click()
    for page in (first, second):
        expect(page.locator(".tools .state")).to_have_text("running")
    until(first, lambda: workbench.get(f"/api/experiments/{name}").json()["done"] > done)
    open_tab(first, "Buffers")  # and back: the same experiment
    open_tab(first, "Experiments")
    first.get_by_role("button", name="Stop", exact=True).click()
    expect(second.locator(".tools .state")).to_have_text("stopped")
    second.get_by_role("button", name="Delete", exact=True).click()
    second.get_by_role("dialog").get_by_role("button", name="Delete", exact=True).click()
    for page in (first, second):
        expect(page.locator(f"tr[data-experiment='{name}']")).to_have_count(0)
    second.locator(".toast").get_by_role("button", name="Restore").click()
    expect(second.locator(f"tr[data-experiment='{name}']")).to_have_count(1)
    expect(first.locator(".tools .state")).to_have_text("stopped")  # it had not been left there


def test_numbers_that_cannot_be_run_are_named_before_anything_runs(pages: Callable[..., Page], workbench: Served, design: str) -> None:
    page = pages(design.partition(":")[0], tab="experiments", refusals=True)
    before = workbench.get("/api/experiments").json()
    page.get_by_role("button", name="New experiment").click()
    page.get_by_label("Design", exact=True).select_option(design)
    foot, run = page.locator(".foot"), page.locator(".foot").get_by_role("button", name="Run")
    expect(foot).to_contain_text("24 trials")
    page.get_by_label("processes").fill("257")
    expect(foot).to_contain_text("processes: must be a whole number from 1 to 256 (got '257')")
    expect(run).to_be_disabled()
    page.get_by_label("processes").fill("1")
    page.get_by_label("participants").fill("1000001")
    expect(foot).to_contain_text("participants: must be a whole number from 1 to 1,000,000 (got '1000001')")
    page.get_by_label("participants").fill("1000000")
    expect(foot).to_contain_text("12,000,000 trials")
    expect(page.get_by_role("alert")).to_contain_text("must give at most 10,000,000 trials in all (got 12,000,000)")
    assert workbench.get("/api/experiments").json() == before


@pytest.mark.slow
def test_a_value_that_the_model_does_not_take_is_marked_and_cannot_be_run(pages: Callable[..., Page], design: str) -> None:
    page = pages(design.partition(":")[0], tab="experiments", refusals=True)

    def answer(route: Route) -> None:
        texts = json.loads(route.request.post_data or "").get("texts", {})
        refused = [f"{name}: must be <= 5 (got 9)" for name in ("n", "mode") if "9" in texts.get(name, ())]
        if refused:
            route.fulfill(status=422, json={"error": refused[0]})
        else:
            route.continue_()

    page.route("**/api/designs/check", answer)
    page.get_by_role("button", name="New experiment").click()
    page.get_by_label("Design", exact=True).select_option(design)
    run, problem = page.locator(".foot").get_by_role("button", name="Run"), page.get_by_role("alert")
    expect(run).to_be_enabled()
    levels = page.get_by_label("Levels of n")
    for field, right in ((levels, "1, 2"), (page.get_by_label("Value of mode"), "count")):
        if field is not levels:
            page.get_by_label("Set another parameter").select_option("mode")
        field.fill("9")
        expect(problem).to_have_text(re.compile("^(n|mode): must be <= 5 [(]got 9[)]$"))
        expect(field).to_have_attribute("aria-invalid", "true")
        expect(page.locator(".new [aria-invalid=true]")).to_have_count(1)
        expect(run).to_be_disabled()
        field.fill(right)
        expect(field).to_have_attribute("aria-invalid", "false")
        expect(problem).to_have_count(0)
        expect(run).to_be_enabled()


LEVELS = """async (texts) => {
    const { levelsText, readLevels } = await part("experiments/wording.js");
    const read = (text) => readLevels(text, { levels: Infinity, characters: Infinity });
    return texts.map((text) => [read(text).levels, read(text).texts, levelsText(read(text).levels)]);
}"""


def test_levels_are_read_as_the_command_reads_them(blank: Page) -> None:
    written = {
        "None, true, False": ([None, True, False], ["None", "true", "False"], "None, true, false"),
        "none, no": (["none", "no"], ["none", "no"], "none, no"),
        '"None", "5", "a, b"': (["None", "5", "a, b"], ['"None"', '"5"', '"a, b"'], '"None", "5", "a, b"'),
        "3.0; 0.50": ([3, 0.5], ["3.0", "0.50"], "3, 0.5"),
        "0x1, don't": ([1, "don't"], ["0x1", "don't"], '1, "don\'t"'),
    }
    assert blank.evaluate(LEVELS, list(written)) == [list(one) for one in written.values()]


def test_levels_that_the_server_would_not_take_are_refused_in_words_of_the_form(pages: Callable[..., Page], design: str) -> None:
    page = pages(design.partition(":")[0], tab="experiments")
    page.get_by_role("button", name="New experiment").click()
    page.get_by_label("Design", exact=True).select_option(design)
    levels, foot = page.get_by_label("Levels of n"), page.locator(".foot")
    start = "n: levels, each once, separated by commas; "
    for text, problem in (
        (", ".join(map(str, range(201))), "there are 201, and at most 200 are possible"),
        ("é" * 1001, "one has 1,001 characters, and at most 1,000 are possible"),
        ("1, 1e400", "the number is too large (got '1, 1e400')"),
        ('"1', "the quotation marks are wrong (got '\"1')"),
    ):
        levels.fill(text)
        expect(foot).to_have_text(f"{start}{problem}Run")
        expect(levels).to_have_attribute("aria-invalid", "true")
    levels.fill(", ".join(map(str, range(200))))
    expect(foot).to_contain_text("1,600 trials")


def test_the_duration_of_a_trial_is_asked_each_time_the_form_is_shown(pages: Callable[..., Page], design: str) -> None:
    page = pages(design.partition(":")[0], tab="experiments")
    answers = [
        {"seconds_a_trial": 2.5, "error": "line 7\nValueError: no"},
        {"seconds_a_trial": 2.5, "error": "line 7\nValueError: no"},
        {"seconds_a_trial": 0.5, "error": ""},
    ]

    def answer(route: Route) -> None:
        if json.loads(route.request.post_data or "")["trial"]:
            route.fulfill(json=answers.pop(0))
        else:
            route.continue_()

    page.route("**/api/designs/check", answer)
    for expected in ("2.50 s a trial", "2.50 s a trial", "0.50 s a trial"):
        page.get_by_role("button", name="New experiment").click()
        page.get_by_label("Design", exact=True).select_option(design)
        expect(page.locator(".foot")).to_contain_text(expected)
        problem = page.get_by_role("alert")
        if answers:
            expect(problem).to_have_text("A trial fails: ValueError: no")
        else:
            expect(problem).to_have_count(0)
        page.get_by_role("button", name="Experiments", exact=True).click()


@pytest.mark.slow
def test_the_duration_of_a_trial_is_measured_for_the_values_that_were_changed(pages: Callable[..., Page], design: str) -> None:
    page = pages(design.partition(":")[0], tab="experiments")
    measured: list[dict[str, Any]] = []

    def answer(route: Route) -> None:
        asked = json.loads(route.request.post_data or "")
        if not asked.pop("trial", False):
            return route.continue_()
        measured.append(asked.get("texts", {}))
        return route.fulfill(
            json={"seconds_a_trial": 4.0 if measured[-1] else 0.5, "error": "ValueError: no" if measured[-1].get("mode") else ""}
        )

    page.route("**/api/designs/check", answer)
    page.get_by_role("button", name="New experiment").click()
    page.get_by_label("Design", exact=True).select_option(design)
    foot = page.locator(".foot")
    expect(foot).to_contain_text("0.50 s a trial")
    page.get_by_label("Levels of n").fill("9")
    expect(foot).to_contain_text("4.00 s a trial")
    page.get_by_label("trials a combination").fill("3")
    expect(foot).to_contain_text("6 trials")
    expect(foot).to_contain_text("4.00 s a trial")  # which other numbers do not change
    page.get_by_label("Set another parameter").select_option("mode")
    page.get_by_label("Value of mode").fill("fail")
    expect(page.get_by_role("alert")).to_have_text("A trial fails: ValueError: no")
    page.get_by_role("button", name="Remove mode").click()
    page.get_by_role("button", name="Reset n").click()
    expect(foot).to_contain_text("0.50 s a trial")
    expect(page.get_by_role("alert")).to_have_count(0)
    asked = [one for one in measured if one.get("mode") != ["count"]]  # its default, if the user pauses there
    assert asked == [{}, {"n": ["9"]}, {"n": ["9"], "mode": ["fail"]}]


def test_a_new_experiment_begins_with_a_design_of_the_model_and_keeps_what_was_typed(
    pages: Callable[..., Page], workbench: Served, design: str
) -> None:
    page = pages("course/counter.py", tab="experiments")
    checked: dict[str, Any] = {"factors": {"n": [1, 2]}, "groups": {"all": 2}, "group_parameters": {}, "settings": {}, "trials_a_cell": 1}
    checked |= {"parameters": [{"name": "mode", "help": "", "default": "count"}], "seed": 1, "model": "", "seconds_a_trial": 1, "error": ""}
    page.route("**/api/designs/check", lambda route: route.fulfill(json=checked))
    new = page.get_by_role("button", name="New experiment")
    new.click()
    expect(page.get_by_label("Design", exact=True)).to_have_value(design)
    page.get_by_label("participants").fill("9")
    page.get_by_label("Set another parameter").select_option("mode")
    value = page.get_by_label("Value of mode")
    expect(value).to_be_focused()
    page.keyboard.type("fail")  # in place of the default
    expect(value).to_have_value("fail")
    page.reload()
    expect(page.get_by_label("participants")).to_have_value("9")
    expect(value).to_have_value("fail")
    expect(value).not_to_be_focused()


TIMERS = """async () => {
  const { followExperiments, shown } = await part("experiments/list.js");
  const later = new Set();
  const [set, clear] = [window.setTimeout, window.clearTimeout];
  window.setTimeout = (work, after) => {
    const number = set(work, after);
    if (after === 5000) later.add(number);
    return number;
  };
  window.clearTimeout = (number) => (later.delete(number), clear(number));
  window.fetch = async () => new Response('{"experiments": []}');
  const read = () => new Promise((resolve) => set(resolve, 100));
  const end = followExperiments();
  for (const id of ["new", "", "new", ""]) shown.value = id;
  await read();
  const going = later.size;
  shown.value = "new";
  end();
  await read();
  return [going, later.size];
}"""


def test_one_request_for_the_list_of_experiments_is_made_at_a_time(page: Page) -> None:
    assert page.evaluate(TIMERS) == [1, 0]
    page.reload()  # with the own functions of the browser


SLOWLY = """() => { const fetched = window.fetch;
window.fetch = (what, how) => !String(what).includes("/means?") ? fetched(what, how) : new Promise((done, failed) => {
    how?.signal?.addEventListener("abort", () => failed(new DOMException("aborted", "AbortError")));
    setTimeout(() => fetched(what, how).then(done, failed), 1500);
}); }"""


@pytest.mark.slow
def test_a_figure_fills_in_although_its_means_take_long_and_stays_while_the_server_does_not_answer(
    pages: Callable[..., Page], workbench: Served, design: str
) -> None:
    """They take longer than new trials."""
    name = workbench.post("/api/experiments", {"design": design, "trials": 1000, "workers": 1}).json()["id"]
    page = pages("counting.py", tab="experiments", refusals=True)
    page.evaluate(SLOWLY)
    page.locator(f"tr[data-experiment='{name}']").click()

    def trials() -> int:
        found = re.search(r"([\d,]+) trials?\)", page.locator(".point").first.get_attribute("aria-label") or "")
        assert found is not None
        return int(found[1].replace(",", ""))

    expect(page.locator(".point")).not_to_have_count(0)
    before = trials()
    until(page, lambda: trials() > before)
    expect(page.locator(".point")).to_have_count(3)
    page.route("**/means?*", lambda route: route.fulfill(status=409, json={"error": "no worker can be started"}))
    expect(page.get_by_text("no worker can be started")).to_be_visible()
    expect(page.locator(".point")).to_have_count(3)
    expect(page.get_by_text("No finished trial has a value")).to_have_count(0)
    page.unroute("**/means?*")
    expect(page.get_by_text("no worker can be started")).to_have_count(0)
    page.route("**/api/experiments", lambda route: route.fulfill(status=403, json={"error": "the token is missing or wrong"}))
    expect(page.get_by_text("The state of the experiment is not known: the token is missing or wrong")).to_be_visible()
    page.unroute("**/api/experiments")
    expect(page.get_by_text("The state of the experiment is not known")).to_have_count(0)
    workbench.post(f"/api/experiments/{name}/stop")
    expect(page.locator(".tools .state")).to_have_text("stopped")


def has_experiments(page: Page, *listed: dict[str, Any]) -> None:
    """Answers the requests for the list of experiments from now on; the page reads it again at once, not only in some seconds."""
    page.route("**/api/experiments", lambda route: route.fulfill(json={"total": len(listed), "experiments": listed}))
    page.get_by_role("button", name="Read the list again").click()


def test_an_experiment_that_cannot_be_read_says_why(pages: Callable[..., Page]) -> None:
    page = pages("counting.py", tab="experiments", refusals=True)
    one: dict[str, Any] = {"id": "sums", "name": "sums", "made": 0, "state": "stopped", "done": 0, "total": 8, "failures": 0}
    one |= {"changed": {}, "model": "", "remaining": None, "work": []}
    has_experiments(page, one)
    page.route("**/api/experiments/sums", lambda route: route.fulfill(status=409, json={"error": "facts.json is damaged"}))
    page.locator("tr[data-experiment=sums]").click()
    expect(page.get_by_role("alert")).to_have_text("The experiment cannot be read: facts.json is damaged")


def test_the_list_says_if_it_has_only_the_newest_experiments(pages: Callable[..., Page]) -> None:
    page = pages("counting.py", tab="experiments")
    one: dict[str, Any] = {"id": "sums", "name": "sums", "made": 0, "state": "stopped", "done": 4, "total": 8, "failures": 0}
    one |= {"changed": {}, "model": "", "remaining": None, "work": []}
    page.route("**/api/experiments", lambda route: route.fulfill(json={"total": 301, "experiments": [one]}))
    page.get_by_role("button", name="Read the list again").click()
    expect(page.locator(".experiments .tools [role=status]")).to_have_text("the newest 1 of 301")


@pytest.mark.slow
def test_a_report_that_another_page_makes_is_shown_and_the_experiment_cannot_be_deleted_meanwhile(pages: Callable[..., Page]) -> None:
    page = pages("counting.py", tab="experiments", refusals=True)
    one: dict[str, Any] = {"id": "sums", "name": "sums", "made": 0, "state": "stopped", "done": 4, "total": 8, "failures": 0}
    one |= {"changed": {}, "model": "", "remaining": None, "work": ["its report is being made"]}
    has_experiments(page, one)
    page.locator("tr[data-experiment=sums]").click()
    expect(page.locator(".progress")).to_contain_text("its report is being made …")
    for name in ("Delete", "Make report"):
        expect(page.get_by_role("button", name=name)).to_be_disabled()
    one["work"].clear()
    expect(page.locator(".progress")).not_to_contain_text("its report is being made")
    for name in ("Delete", "Make report"):
        expect(page.get_by_role("button", name=name)).to_be_enabled()


FACTS: dict[str, Any] = {"facts": {"factors": {}}}


@pytest.fixture
def two_finished(pages: Callable[..., Page]) -> tuple[Page, list[dict[str, Any]], list[Route]]:
    """A page with two finished experiments; their summaries; and the requests for reports and trials, which the test answers."""
    page = pages("counting.py", tab="experiments", refusals=True)
    column = {"type": "integer", "role": "own", "unit": None, "meaning": ""}
    columns = [column | {"name": name} for name in ("trial", "participant")]
    one: dict[str, Any] = {"name": "sums", "made": 0, "state": "finished", "done": 2, "total": 2, "failures": 0}
    one |= {"changed": {}, "model": "", "remaining": None, "columns": [], "work": []}
    both: list[dict[str, Any]] = [{**one, "id": name, "name": name, "work": []} for name in ("first", "second")]
    wanted: list[Route] = []
    has_experiments(page, *both)
    page.route(re.compile("/api/experiments/(first|second)$"), lambda route: route.fulfill(json=one | FACTS))
    rows = {"columns": columns, "first": 0, "total": 2, "rows": [{"trial": number, "participant": 1} for number in (1, 2)]}
    page.route("**/rows?*", lambda route: route.fulfill(json=rows))
    page.route(re.compile("/report$|/trial$"), lambda route: wanted.append(route))
    return page, both, wanted


def test_what_is_made_of_one_experiment_is_said_at_that_one_only(two_finished: tuple[Page, list[dict[str, Any]], list[Route]]) -> None:
    page, (first, _), wanted = two_finished
    page.locator("tr[data-experiment=first]").click()
    page.get_by_role("button", name="Trials", exact=True).click()
    trial = page.locator(".trials tbody tr").first
    expect(trial).to_have_css("cursor", "pointer")
    page.get_by_role("button", name="Make report").click()
    expect(page.locator(".progress")).to_contain_text("Making the report …")
    expect(trial).not_to_have_css("cursor", "pointer")
    trial.click()
    first["work"].append("its report is being made")

    page.get_by_role("button", name="Experiments", exact=True).click()
    expect(page.locator("tr[data-experiment=first] .state")).to_contain_text("its report is being made")
    page.locator("tr[data-experiment=second]").click()
    expect(page.locator(".tools .name")).to_have_text("second")
    expect(page.locator(".progress")).to_have_text("2 of 2 trials")
    expect(page.get_by_role("button", name="Make report")).to_be_enabled()
    assert len(wanted) == 1  # no trial is run again meanwhile
    first["work"].clear()
    wanted[0].fulfill(json={"report": "first"})
    toast = page.locator(".toast")
    expect(toast).to_contain_text(re.compile("^The report of first .* is made"))
    expect(page.locator(".tools .name")).to_have_text("second")
    toast.get_by_role("button", name="Open it").click()
    expect(page.locator(".tools .name")).to_have_text("first")


@pytest.mark.slow
def test_the_keyboard_goes_on_where_the_view_changes(two_finished: tuple[Page, list[dict[str, Any]], list[Route]]) -> None:
    page, _, wanted = two_finished
    page.get_by_role("button", name="second").press("Enter")
    back = page.get_by_role("button", name="Experiments", exact=True)
    expect(back).to_be_focused()
    trials = page.get_by_role("button", name="Trials", exact=True)
    trials.press("Enter")
    link = page.get_by_role("button", name="Open trial 2")
    expect(link).to_be_visible()
    expect(trials).to_be_focused()
    link.press("Enter")
    expect(page.locator(".progress")).to_contain_text("Running trial 2 again …")
    expect(link).to_be_focused()
    wanted[0].fulfill(status=409, json={"error": "no worker can be started"})
    expect(page.locator(".progress")).not_to_contain_text("Running trial 2 again …")
    expect(link).to_be_focused()
    back.press("Enter")
    expect(page.get_by_role("button", name="second")).to_be_focused()
    new = page.get_by_role("button", name="New experiment")
    new.press("Enter")
    expect(back).to_be_focused()


@pytest.mark.daily(1)
@pytest.mark.parametrize(("chosen", "paper"), [("light", "rgb(255, 255, 255)"), ("dark", "rgb(20, 24, 31)")])
def test_a_report_has_the_theme_that_was_chosen_on_the_page(pages: Callable[..., Page], chosen: str, paper: str) -> None:
    other = "dark" if chosen == "light" else "light"
    page = pages("counting.py", tab="experiments", theme=other)
    one: dict[str, Any] = {"id": "sums", "name": "sums", "made": 0, "state": "finished", "done": 2, "total": 2, "failures": 0}
    one |= {"changed": {}, "model": "", "remaining": None, "columns": [], "work": [], "report": 1}
    has_experiments(page, one)
    page.route("**/api/experiments/sums", lambda route: route.fulfill(json=one | FACTS))
    page.route("**/rows?*", lambda route: route.fulfill(json={"columns": [], "first": 0, "total": 0, "rows": []}))
    text = report_page("Sums", "", {}, [], {})
    page.route("**/report/index.html*", lambda route: route.fulfill(body=text, content_type="text/html"))
    page.locator("tr[data-experiment=sums]").click()
    page.get_by_role("button", name="Report", exact=True).click()
    body = page.frame_locator("iframe.report").locator("body")
    expect(body).not_to_have_css("background-color", paper)
    page.evaluate("async (chosen) => (await part('theme.js')).chosen.value = chosen", chosen)
    expect(body).to_have_css("background-color", paper)
    page.get_by_role("button", name="Trials", exact=True).click()
    page.get_by_role("button", name="Report", exact=True).click()
    expect(body).to_have_css("background-color", paper)  # of a page that is loaded again


TRIALS = """async () => {
    const { html, render } = await part("vendor/preact.js");
    const { Trials } = await part("experiments/trials.js");
    const { session } = await part("store.js");
    const { openTrial } = await part("experiments/list.js");
    const place = document.body.appendChild(Object.assign(document.createElement("div"), { id: "drawn", className: "experiments" }));
    const experiment = { id: "sums", done: 2, failures: 0 };
    render(html`<${Trials} experiment=${experiment} facts=${{ factors: {}, groups: { all: 2 } }} />`, place);
    const fetched = window.fetch;
    // A recording is opened for as long as the test lasts.
    window.fetch = (what, how) => (String(what).includes("/api/recordings/") ? new Promise(() => {}) : fetched(what, how));
    window.open_one = () => void openTrial("sums", 1);
    window.show = (recorded) => (session.value = { ...session.value, recorded });
}"""


TEXT_END = """(element) => {
    const text = document.createRange();
    text.selectNode(element.firstChild);
    return text.getBoundingClientRect().right;
}"""


def test_trials_have_units_heads_above_their_numbers_and_a_mark_at_the_one_that_is_open(blank: Page) -> None:
    column = {"type": "real", "role": "measure", "unit": None, "meaning": ""}
    names: list[dict[str, Any]] = [
        {"name": "trial"},
        {"name": "participant", "type": "text"},
        {"name": "rt", "unit": "s"},
        {"name": "turn_deg", "unit": "degrees"},
    ]
    columns = [column | one for one in names]
    rows = [{"trial": number, "participant": f"all {number}", "rt": 1.5, "turn_deg": 20} for number in (1, 2)]
    blank.route("**/rows?*", lambda route: route.fulfill(json={"columns": columns, "first": 0, "total": 2, "rows": rows}))
    blank.route("**/api/experiments", lambda route: route.fulfill(json={"total": 0, "experiments": []}))
    blank.route("**/trial", lambda route: route.fulfill(json={"recording": "sums_trial_1"}))
    blank.evaluate(TRIALS)
    heads, cells = blank.locator("#drawn thead button"), blank.locator("#drawn tbody tr").first.locator("td")
    expect(heads).to_have_text(["trial▴", "participant", "rt [s]", "turn [degrees]"])
    expect(cells).to_have_text(["1", "1", "1.5", "20"])
    assert abs(heads.nth(2).evaluate(TEXT_END) - cells.nth(2).evaluate(TEXT_END)) < 2
    marked = blank.locator("#drawn [aria-current=true]")
    expect(marked).to_have_count(0)
    blank.evaluate("open_one()")

    def is_marked(recording: str | None) -> bool:
        blank.evaluate("(recording) => void show(recording)", recording)  # again: what the page hears of its own session replaces it
        return marked.count() == 1

    until(blank, lambda: is_marked("sums_trial_1"))
    assert marked.get_by_role("button").text_content() == "1"
    until(blank, lambda: not is_marked(None))


def test_of_trials_that_have_all_failed_there_is_no_figure(blank: Page) -> None:
    blank.evaluate("""async () => {
        const { html, render } = await part("vendor/preact.js");
        const { Figure } = await part("experiments/figure.js");
        const column = (name, role, type) => ({ name, role, type, unit: null, meaning: "" });
        const columns = [column("width", "value", "real"), column("wall_s", "own", "real")];
        const experiment = { id: "none", name: "none", done: 4, failures: 4, made: 0, total: 4 };
        const place = document.body.appendChild(Object.assign(document.createElement("div"), { id: "drawn" }));
        render(html`<${Figure} experiment=${experiment} facts=${{ factors: { width: [0.5, 0.8] } }} columns=${columns} />`, place);
    }""")
    expect(blank.locator("#drawn [role=status]")).to_have_text(
        "All 4 finished trials have failed: there is nothing to draw. The table of trials has the errors."
    )
    expect(blank.locator("#drawn canvas")).to_have_count(0)


TWO_EXPERIMENTS = """async () => {
    const { html, render } = await part("vendor/preact.js");
    const { Figure } = await part("experiments/figure.js");
    const { experiments, shown, where } = await part("experiments/list.js");
    const column = (name, role, unit = null) => ({ name, role, type: "real", unit, meaning: "" });
    const columns = [column("n", "value", "m"), column("rt", "measure"), column("wall_s", "own")];
    const one = (id, columns, changed = {}) => ({ id, name: id, done: 5, failures: 0, made: 0, total: 5, columns, changed });
    experiments.value = [one("mine", ["n", "rt"]), one("theirs", ["n", "rt"], { "latency_factor": 0.9 }), one("others", ["n", "luck"])];
    const place = document.body.appendChild(Object.assign(document.createElement("div"), { id: "drawn" }));
    place.style.cssText = "display: flex; flex-direction: column; width: 600px; height: 400px";
    render(html`<${Figure} experiment=${experiments.value[0]} facts=${{ factors: { n: [1, 2] } }} columns=${columns} />`, place);
    window.chosen = () => ({ shown: shown.value, where: where.value });
}"""


def means(points: list[dict[str, Any]], by: list[str] | None = None, **more: Any) -> dict[str, Any]:
    return {"x": "n", "by": by or [], "measure": "rt", "unit": "s", "columns": [], "points": points, **more}


NOTHING_LEFT_OUT = {"conditions": 0, "trials": 0}
NO_FAILURES = {"conditions": 0, "trials": [0, 0]}


def test_an_experiment_without_a_common_condition_is_not_drawn_beside(blank: Page) -> None:
    points = [{"at": [n], "mean": 0.1, "error": None, "participants": 1, "trials": 2} for n in (1, 2)]
    left_out = {"conditions": 2, "trials": 4}
    apart = means([], left_out=left_out, beside={"points": [], "left_out": left_out}, failed=NO_FAILURES, apart=["ink", "goal_m"])
    blank.route("**/means?*", lambda route: route.fulfill(json=apart if "beside=theirs" in route.request.url else means(points)))
    blank.evaluate(TWO_EXPERIMENTS)
    blank.get_by_label("Compare with").select_option("theirs")
    warning = blank.locator("#drawn .problem")
    expect(warning).to_have_text(
        re.compile(
            r"^theirs .* is not compared: it has no condition in common with this experiment \(the two share no level of ink or goal\)\.$"
        )
    )
    expect(blank.locator("#drawn .point")).to_have_count(2)
    blank.get_by_label("Compare with").select_option("")
    expect(warning).to_have_count(0)


TWO_FACTORS = SLOW_COUNTER.replace('mode = "count"', 'm = 1\nmode = "count"').replace('if mode == "fail"', 'if mode == "fail" and m == 3')


@pytest.mark.slow
def test_two_experiments_are_compared_over_the_conditions_that_both_have(pages: Callable[..., Page], workbench: Served) -> None:
    folder = workbench.folder / "two_factors"
    folder.mkdir()
    model = TWO_FACTORS.replace("rt = model.now()", "rt = n * m")
    design = f"two_factors/{write_experiment(folder, factors='dict(n=[1, 2], m=[1, 3])', model=model).name}:counting"
    whole, failed = (
        workbench.post("/api/experiments", {"design": design, "trials": 1, "workers": 1, "values": values}).json()["id"]
        for values in ({}, {"mode": "fail"})
    )
    page = pages("two_factors/counter.py", tab="experiments")
    page.locator(f"tr[data-experiment='{failed}']").click()
    expect(page.locator(".tools .state")).to_have_text("finished")
    until(page, lambda: workbench.get(f"/api/experiments/{whole}").json()["state"] == "finished")
    page.get_by_label("Measure", exact=True).select_option("rt")
    page.get_by_label("Lines", exact=True).select_option("")
    points = page.locator(".point")
    expect(points).to_have_count(2)
    page.get_by_label("Compare with").select_option(whole)
    expect(points).to_have_count(4)
    for place, said in enumerate(("n 1: 1", "n 2: 2", "n 1 · the other experiment: 1", "n 2 · the other experiment: 2")):
        expect(points.nth(place)).to_have_attribute(
            "aria-label", re.compile(rf"^Trials of {said}\.00 ± 0\.000 \(2 participants, 2 trials\)$")
        )
    expect(page.locator(".means .pointed")).to_contain_text("4 of 8 trials; of the other experiment, 4 of 8 trials")
    expect(page.locator(".problem")).to_have_text(
        re.compile(
            "^Only conditions that both experiments have, and in which no trial failed, are compared. "
            "Left out: 2 conditions in which a trial failed, with 0 trials of this experiment and 4 trials of counting .*[.]$"
        )
    )
    shutil.rmtree(folder)


def test_another_experiment_is_drawn_beside_the_one_that_is_shown(blank: Page) -> None:
    def points_of(mean: float) -> list[dict[str, Any]]:
        return [{"at": [n], "mean": mean * n, "error": None, "participants": 1, "trials": 2} for n in (1, 2)]

    theirs = {"points": points_of(0.2), "left_out": NOTHING_LEFT_OUT}
    both = means(points_of(0.1), left_out=NOTHING_LEFT_OUT, beside=theirs, failed=NO_FAILURES, apart=[])
    blank.route("**/means?*", lambda route: route.fulfill(json=both if "beside=theirs" in route.request.url else means(points_of(0.1))))
    blank.evaluate(TWO_EXPERIMENTS)
    points, legend = blank.locator("#drawn .point"), blank.locator("#drawn .legend")
    expect(points).to_have_count(2)
    expect(blank.locator("#drawn .pointed")).to_have_text(
        "Means of the conditions, each weighing the same. No bar where a condition has one participant. 4 of 5 trials"
    )
    expect(legend).to_have_text("")
    choice = blank.get_by_label("Compare with")
    expect(choice.locator("option")).to_have_count(2)  # without the experiment that has no such measure
    expect(choice.locator("option").last).to_have_text(re.compile("^theirs .*, latency_factor 0.9$"))
    choice.select_option("theirs")
    expect(points).to_have_count(4)
    expect(blank.locator("#drawn .problem")).to_have_count(0)
    expect(points.nth(0)).to_have_attribute("aria-label", re.compile(r"^Trials of n 1: 0\.1\d* s \(1 participant, 2 trials\)$"))
    expect(points.nth(3)).to_have_attribute("aria-label", re.compile(r"^Trials of n 2 · the other experiment: 0\.4\d* s "))
    expect(legend.locator("canvas")).to_have_count(2)
    expect(legend).to_contain_text(re.compile("mine .*, as designed.*theirs .*, latency_factor 0.9"))
    points.nth(3).press("Enter")
    assert blank.evaluate("chosen()") == {"shown": "theirs", "where": {"n": 2}}
    choice.select_option("")
    expect(points).to_have_count(2)


TEXTS_OF_A_PICTURE = """(svg) => {
    document.body.innerHTML = svg.replace(/^<[?].*[?]>/, "");
    const whole = document.querySelector("svg").getBoundingClientRect();
    const inside = (box) => box.left >= whole.left && box.right <= whole.right && box.top >= whole.top && box.bottom <= whole.bottom;
    return Array.from(document.querySelectorAll("svg text"), (text) => [text.textContent, inside(text.getBoundingClientRect())]);
}"""


def test_a_saved_figure_says_which_experiments_it_shows_and_what_its_bars_are(blank: Page) -> None:
    def answer(route: Route) -> None:
        points = [
            {"at": [n, f"{level} of the conditions of the second factor"], "mean": n, "error": 0.1, "participants": 2, "trials": 4}
            for n in (1, 2)
            for level in ("first", "other", "third")
        ]
        left_out, failed = {"conditions": 2, "trials": 9}, {"conditions": 1, "trials": [3, 4]}
        beside = {"points": points, "left_out": left_out}
        route.fulfill(json=means(points, ["kind"], left_out=left_out, beside=beside, failed=failed, apart=[]))

    blank.route("**/means?*", answer)
    blank.evaluate(TWO_EXPERIMENTS)
    blank.get_by_label("Compare with").select_option("theirs")
    expect(blank.locator("#drawn .legend canvas")).to_have_count(5)
    with blank.expect_download() as download:
        blank.get_by_role("button", name="SVG").click()
    texts: list[tuple[str, bool]] = blank.evaluate(TEXTS_OF_A_PICTURE, download.value.path().read_text(encoding="utf-8"))
    assert [text for text, is_inside in texts if not is_inside] == []
    title, first, other, third, mine, theirs, *rest = (text for text, _ in texts)
    assert re.fullmatch(r"rt \[s\], mine .* and theirs .*", title)
    assert [text.partition(" ")[0] for text in (first, other, third)] == ["first", "other", "third"]
    assert mine.startswith("mine ")
    assert theirs.startswith("theirs ")
    assert "n [m]" in rest, "each axis has its unit"
    notes = " ".join(rest)
    assert "Means of the conditions, each weighing the same, ± 1 standard error over participants. 24 of 5 trials; " in notes
    assert "Left out: 2 conditions with 9 trials of this experiment; " in notes
    assert re.search(r"; 1 condition in which a trial failed, with 3 trials of this experiment and 4 trials of theirs .*[.]$", notes)


def test_an_experiment_that_cannot_be_compared_is_named_as_elsewhere(pages: Callable[..., Page]) -> None:
    page = pages(refusals=True)
    points = [{"at": [n], "mean": 0.1, "error": None, "participants": 1, "trials": 2} for n in (1, 2)]
    refused = {"error": "'rt' must have the same unit in both experiments (got s and ms)"}
    page.route(
        "**/means?*",
        lambda route: route.fulfill(status=409, json=refused) if "beside=" in route.request.url else route.fulfill(json=means(points)),
    )
    page.evaluate(TWO_EXPERIMENTS)
    page.get_by_label("Compare with").select_option("theirs")
    expect(page.locator("#drawn .problem")).to_have_text(re.compile(rf"^theirs [^ ].* is not compared: {re.escape(refused['error'])}\.$"))
    expect(page.locator("#drawn .point")).to_have_count(2)


OUTSIDE = """(panel) => [...panel.querySelectorAll("td, .legend span")].filter((one) => one.checkVisibility()
    && one.getBoundingClientRect().right > panel.getBoundingClientRect().right + 1).map((one) => one.textContent)"""


@pytest.mark.slow
def test_long_names_of_groups_and_levels_leave_the_rest_in_view(pages: Callable[..., Page], workbench: Served) -> None:
    (workbench.folder / "long").mkdir()
    path = write_experiment(workbench.folder / "long", factors=f'{{"n": [1, 2], "mode": ["count", "{"c" * 150}"]}}', trials=1)
    path.write_text(path.read_text(encoding="utf-8").replace('"all"', f'"{"g" * 100}"'), encoding="utf-8")
    name = workbench.post("/api/experiments", {"design": "long/counting_design.py:counting", "workers": 1}).json()["id"]
    page = pages("counting.py", width=853, height=533, tab="experiments")
    page.locator(f"tr[data-experiment='{name}']").click()
    expect(page.locator(".tools .state")).to_have_text("finished")
    panel = page.locator(".experiments")
    page.get_by_label("Lines", exact=True).select_option("mode")
    expect(page.locator(".legend span")).to_have_count(2)
    assert panel.evaluate(OUTSIDE) == []
    page.get_by_role("button", name="Design", exact=True).click()
    expect(page.get_by_role("row", name="group ggg")).to_contain_text("2 participants")
    assert panel.evaluate(OUTSIDE) == []
    shutil.rmtree(workbench.folder / "long")
