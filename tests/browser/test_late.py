"""What comes late overrides nothing that the user has chosen meanwhile: answers, pictures and files are held back here until he has."""

from __future__ import annotations

import json
import re
from collections.abc import Callable, Generator
from contextlib import contextmanager
from pathlib import Path

import pytest
from playwright.sync_api import Page, Request, Route, WebSocketRoute, expect

from tests.helpers.page import choose, drawn, duplicate, holding, open_tab, say, shows, until
from tests.helpers.workbench_server import Served

CODE = ".code .cm-content"
SLOW = """
import time

time.sleep(1.5)
"""
"""Added to a model that is to take its time to load."""
LOADING = """async () => (await part("store.js")).session.value?.loading"""


class Wire:
    """The websocket of a page, on which what the server says can be held back."""

    def __init__(self, page: Page) -> None:
        self.held: list[str] | None = None
        self._only_replies = False
        self._is_down = False
        page.route_web_socket(re.compile(r"/ws$"), self._join)
        page.reload()

    def _join(self, socket: WebSocketRoute) -> None:
        if self._is_down:
            socket.close()
            return
        self._page, self._server = socket, socket.connect_to_server()
        self._server.on_message(self._pass_on)

    def _pass_on(self, message: str | bytes) -> None:
        text = str(message)
        if self.held is None:
            self._page.send(text)
        elif self._only_replies:
            told = json.loads(text)
            told.pop("replies", None)
            self._page.send(json.dumps(told))
        else:
            self.held.append(text)

    @contextmanager
    def cut(self) -> Generator[None]:
        """Ends the connection; the page, which asks for another one every second, gets it afterwards."""
        self._is_down = True
        self._server.close()
        self._page.close()
        yield
        self._is_down = False

    @contextmanager
    def holding(self, *, only_replies: bool = False) -> Generator[None]:
        """Holds back all that the server says; or only its replies, which then are lost, as those of a session that is left are."""
        self.held, self._only_replies = [], only_replies
        yield
        held, self.held = self.held, None
        for text in [] if only_replies else held:
            self._page.send(text)


class Requests:
    """Requests of a page, which are held back before the server has them, until they are let go."""

    def __init__(self, page: Page, where: str | re.Pattern[str]) -> None:
        self.held: list[Route] = []
        self._on = True
        page.route(where, self._take)

    def _take(self, route: Route) -> None:
        if self._on:
            self.held.append(route)
        else:
            route.continue_()

    def let_go(self) -> None:
        self._on = False
        for route in self.held:
            route.continue_()


def is_put(request: Request) -> bool:
    return request.method == "PUT"


def write(page: Page, text: str) -> None:
    page.locator(CODE).focus()
    page.keyboard.press("Control+End")
    page.keyboard.insert_text(text)


def edit(page: Page, model: str) -> None:
    open_tab(page, "Editor")
    page.get_by_label("File", exact=True).select_option(model)
    expect(page.locator(f"{CODE}[aria-label*='{model}']")).to_be_visible()


# -- what the run says


@pytest.mark.slow
def test_what_is_set_twice_before_the_run_has_answered_counts_twice(pages: Callable[..., Page]) -> None:
    page = pages("doorway.py")
    wire = Wire(page)
    shows(page, "#status", "at its start")
    open_tab(page, "Productions")
    speed = page.get_by_label("Speed", exact=True)
    dots = page.get_by_role("button", name="Breakpoint on")
    expect(dots.nth(1)).to_be_visible()
    with wire.holding():
        page.locator("body").press("-")
        page.locator("body").press("-")
        dots.nth(0).click()
        dots.nth(1).click()
        expect(speed.locator("option:checked")).to_have_text("10 x")
        expect(dots.nth(1)).to_have_attribute("aria-pressed", "true")
    other = page.context.new_page()
    other.goto(page.url)
    open_tab(other, "Productions")
    speed, dots = other.get_by_label("Speed", exact=True), other.get_by_role("button", name="Breakpoint on")
    expect(speed.locator("option:checked")).to_have_text("10 x")
    for n in range(2):
        expect(dots.nth(n)).to_have_attribute("aria-pressed", "true")


@pytest.mark.slow
def test_a_step_is_made_where_the_user_has_gone_to_though_the_run_is_still_on_its_way(pages: Callable[..., Page]) -> None:
    page = pages("counting.py")
    wire = Wire(page)
    shows(page, "#status", "at its start")
    for _ in range(3):
        page.click("#cycle")
    shows(page, "#time", "0.25 s")
    timeline = page.locator("#timeline")
    timeline.focus()
    expect(timeline).to_have_attribute("aria-valuemax", "0.25")
    with wire.holding():
        for _ in range(4):
            timeline.press("ArrowLeft")
        expect(timeline).to_have_attribute("aria-valuenow", "0.21")
        page.click("#step")
    shows(page, "#status", "after a step")
    shows(page, "#time", "0.22 s")


@pytest.mark.slow
def test_a_question_to_a_run_that_is_shown_no_more_does_not_keep_others_waiting(pages: Callable[..., Page]) -> None:
    page = pages("doorway.py")
    wire = Wire(page)
    shows(page, "#status", "at its start")
    with wire.holding(only_replies=True):
        page.click("#step")
        shows(page, "#time", "0.01 s")
        choose(page, "counting.py")
        expect(page.get_by_role("button", name="Curves …")).to_be_disabled()
    choose(page, "doorway.py")
    shows(page, "#time", "0.01 s")
    expect(page.get_by_role("button", name="Curves …")).to_be_enabled()
    page.keyboard.press("ArrowRight")
    shows(page, "#time", "0.02 s")


def test_what_is_asked_of_a_run_is_answered_though_the_run_is_shown_again_meanwhile(page: Page) -> None:
    shows(page, "#status", "at its start")
    answer = page.evaluate(
        """async () => {
          const { request, show } = await part("server.js");
          const { session } = await part("store.js");
          const answers = [];
          for (let n = 0; n < 5; n += 1) {
            answers.push(request({ type: "step" }));
            show(session.value.id);
          }
          const late = new Promise((resolve) => setTimeout(resolve, 10_000, "no answer"));
          return Promise.race([Promise.all(answers).then(() => "answered"), late]);
        }"""
    )
    assert answer == "answered"
    shows(page, "#time", "0.05 s")


@pytest.mark.slow
def test_keys_say_nothing_to_a_run_that_is_not_shown_any_more(pages: Callable[..., Page], workbench: Served) -> None:
    page = pages("counting.py")
    shows(page, "#status", "at its start")
    requests = Requests(page, "**/api/sessions")
    page.get_by_label("Model", exact=True).select_option("doorway.py")
    shows(page, "#status", "loading|no run")
    page.locator("body").press("ArrowRight")
    page.locator("body").press("c")
    requests.let_go()
    shows(page, "#status", "at its start")
    choose(page, "counting.py")
    shows(page, "#status", "at its start")
    shows(page, "#time", "0.00 s")


def test_each_click_on_cycle_is_one(page: Page) -> None:
    shows(page, "#status", "at its start")
    page.evaluate("for (let n = 0; n < 3; n += 1) document.getElementById('cycle').click()")
    open_tab(page, "Productions")
    expect(page.locator("#events tr.fire")).to_have_count(3)
    shows(page, "#status", "fired")
    expect(page.locator("#events tr.fire")).to_have_count(3)


# -- what is written and chosen


@pytest.mark.slow
def test_a_row_chosen_before_the_next_picture_stays_chosen(pages: Callable[..., Page]) -> None:
    page = pages("counting.py")
    shows(page, "#status", "at its start")
    page.click("#run")
    shows(page, "#status", "ended")
    page.evaluate(
        """() => {
            const observer = new MutationObserver(() => {  // is told before anything is drawn
                const row = document.querySelector("#events tr.fire");
                if (!row) return;
                observer.disconnect();
                row.click();
            });
            observer.observe(document.body, { childList: true, subtree: true });
            [...document.querySelectorAll("[role=tab]")].find((tab) => tab.textContent.startsWith("Productions")).click();
        }"""
    )
    expect(page.locator("#events tr.fire").first).to_have_attribute("aria-selected", "true")
    drawn(page)
    expect(page.locator("#events tr.fire").first).to_have_attribute("aria-selected", "true")


def test_the_focus_is_where_an_arrow_key_has_taken_it_at_once(page: Page) -> None:
    shows(page, "#status", "at its start")
    open_tab(page, "Productions")
    name = page.locator(".production-list button.name[tabindex='0']")
    expect(name).to_be_visible()
    name.focus()
    moved = page.evaluate(
        """() => {
            const before = document.activeElement;
            before.dispatchEvent(new KeyboardEvent("keydown", { key: "ArrowDown", bubbles: true, cancelable: true }));
            return before.matches(".name") && document.activeElement.matches(".name") && document.activeElement !== before;
        }"""
    )
    assert moved


@pytest.mark.slow
def test_a_recording_chosen_while_another_is_deleted_stays_chosen(pages: Callable[..., Page]) -> None:
    page = pages("counting.py")
    for _ in range(2):
        shows(page, "#status", "at its start")
        page.click("#run")
        shows(page, "#status", "ended")
        page.click("#restart")
    shows(page, "#status", "at its start")
    open_tab(page, "Runs")
    finished = page.locator(".runs-table tbody tr:not(.space):not(.present)")
    names = [finished.nth(n).get_attribute("data-run") for n in range(2)]
    first, second = (page.locator(f"[data-run='{name}']") for name in names)
    first.click()
    with holding(page, "**/api/recordings/*/delete", lambda _: True):
        page.get_by_role("toolbar", name="The chosen run").get_by_role("button", name="Delete").click()
        page.get_by_role("dialog").get_by_role("button", name="Delete").click()
        second.dispatch_event("click")  # not at a place: the row moves up when the other one goes
        expect(second).to_have_attribute("aria-selected", "true")
    expect(first).to_have_count(0)
    drawn(page)
    expect(second).to_have_attribute("aria-selected", "true")


@pytest.mark.slow
def test_an_experiment_or_trial_that_is_ready_late_does_not_replace_what_is_shown_by_then(pages: Callable[..., Page]) -> None:
    page = pages("counting.py", tab="experiments")
    shows(page, "#status", "at its start")
    trial: list[Route] = []
    page.route("**/api/experiments/one/trial", lambda route: trial.append(route))
    page.evaluate("""() => void part("experiments/list.js").then(({ openTrial }) => openTrial("one", 7))""")
    until(page, lambda: bool(trial))
    choose(page, "doorway.py")
    trial[0].fulfill(json={"recording": "late"})
    open_tab(page, "Messages")
    expect(page.get_by_text("Trial 7 was run again and recorded as late: it is among the runs.")).to_be_visible()
    assert page.url.endswith("/?model=doorway.py")

    open_tab(page, "Experiments")
    started: list[Route] = []
    page.route("**/api/experiments", lambda route: started.append(route) if route.request.method == "POST" else route.continue_())
    page.get_by_role("button", name="New experiment").click()
    page.evaluate(
        """() => void part("experiments/list.js")
            .then(({ startExperiment }) => startExperiment({}))
            .then(() => (window.isStarted = true))"""
    )
    until(page, lambda: bool(started))
    page.get_by_role("button", name="Experiments", exact=True).click()
    started[0].fulfill(json={"id": "late"})
    until(page, lambda: bool(page.evaluate("() => window.isStarted")))
    expect(page.get_by_role("button", name="New experiment")).to_be_visible()
    assert page.evaluate("async () => (await part('experiments/list.js')).shown.value") == ""


def test_a_recording_that_cannot_be_opened_does_not_leave_the_page_waiting_for_the_model_chosen_before(pages: Callable[..., Page]) -> None:
    page = pages("counting.py", refusals=True)
    shows(page, "#status", "at its start")
    opening = "async () => (await part('store.js')).opening.value?.text"
    with holding(page, "**/api/sessions", lambda request: request.method == "POST") as held:
        page.get_by_label("Model", exact=True).select_option("doorway.py")
        until(page, lambda: bool(held))
        assert page.evaluate(opening) == "doorway.py is being loaded …"
        with holding(page, "**/open", lambda _: True) as asked:
            page.evaluate("() => void part('server.js').then(({ showRecording }) => showRecording('none')).catch(() => {})")
            until(page, lambda: bool(asked))
            assert page.evaluate(opening) == "The recording none is being opened …"
        until(page, lambda: page.evaluate(opening) is None)
    expect(page.locator("#status")).not_to_contain_text("loading")


@pytest.mark.slow
def test_a_model_chosen_while_a_recording_is_opened_stays_chosen(pages: Callable[..., Page], workbench: Served) -> None:
    page = pages("counting.py", refusals=True)
    shows(page, "#status", "at its start")
    page.click("#run")
    shows(page, "#status", "ended")
    page.click("#restart")
    shows(page, "#status", "at its start")
    edit(page, "counting.py")
    open_tab(page, "Runs")
    with holding(page, "**/open", lambda _: True) as held:
        page.locator(".runs-table tbody tr:not(.space):not(.present)").first.dblclick()
        until(page, lambda: bool(held))
        choose(page, "doorway.py")
        shows(page, "#status", "at its start")
    expect(page.get_by_text("Opening …")).to_have_count(0)
    expect(page.locator(".recording-banner")).to_have_count(0)
    assert page.url.endswith("/?model=doorway.py")
    for session in workbench.get("/api/sessions").json()["sessions"]:
        if session["model"] == "counting.py":
            workbench.post(f"/api/sessions/{session['id']}/close")
    page.route(
        "**/api/sessions",
        lambda route: route.fulfill(status=422, json={"error": "no room"}) if route.request.method == "POST" else route.continue_(),
    )
    page.get_by_label("Model", exact=True).select_option("counting.py")  # with a text open, in which messages are marked
    shows(page, ".toast", "no room")
    open_tab(page, "Messages")
    expect(page.get_by_text("no room")).to_have_count(1)
    expect(page.get_by_text("The page has a fault")).to_have_count(0)
    page.unroute("**/api/sessions")


@pytest.mark.slow
def test_a_slow_replay_shows_its_progress_until_it_is_ready(pages: Callable[..., Page]) -> None:
    page = pages("doorway.py")
    shows(page, "#status", "at its start")
    page.click("#run")
    shows(page, "#status", "ended")
    open_tab(page, "Runs")
    page.locator("tr.present").click()
    asked: list[Route] = []
    page.route(re.compile("form=replay.html"), lambda route: asked.append(route))
    link, told = page.get_by_role("link", name="HTML replay"), page.get_by_text("being made")
    link.click()
    expect(told).to_be_visible()
    link.click()  # one is enough
    with page.expect_download() as taken:
        asked[0].fulfill(body="<title>replay</title>")
    assert taken.value.suggested_filename.startswith("doorway-")
    assert taken.value.suggested_filename.endswith(".replay.html")
    expect(told).to_have_count(0)
    assert len(asked) == 1


@pytest.mark.slow
def test_text_in_fields_stays_as_it_was_typed(pages: Callable[..., Page]) -> None:
    page = pages("doorway.py")
    wire = Wire(page)
    shows(page, "#status", "at its start")
    open_tab(page, "Parameters")
    width, speed = page.get_by_label("width", exact=True), page.get_by_label("speed", exact=True)
    speed.fill("")
    speed.press_sequentially("1.205")  # of which «1.20» is what holds already
    expect(speed).to_have_value("1.205")
    speed.fill("1.2")
    expect(page.locator(".note")).to_have_count(0)
    with wire.holding():
        width.fill("0.9")
        width.press("Tab")
        speed.fill("1.3")
    shows(page, "#width", "90 cm")
    expect(page.locator(".note")).to_have_text(re.compile("One value is not in effect yet"))
    expect(speed).to_have_value("1.3")


@pytest.mark.slow
def test_over_http_from_another_machine_text_is_copied_by_hand_and_drafts_stay_with_their_tabs(
    pages: Callable[..., Page], workbench: Served
) -> None:
    """There, the browser gives a page neither a clipboard nor locks."""
    (workbench.folder / "kept.py").write_text("a = 1\n", encoding="utf-8")
    page = pages("counting.py")
    page.context.add_init_script("delete Navigator.prototype.clipboard; delete Navigator.prototype.locks")
    page.on("dialog", lambda dialog: dialog.accept())  # the browser asks about the unsaved text
    page.reload()
    shows(page, "#status", "at its start")
    page.click("#cycle")
    shows(page, "#time", r"0\.05 s")
    page.get_by_role("button", name="Copy a link").click()
    text = page.get_by_role("dialog", name="Copy the text").get_by_label("Text to copy")
    expect(text).to_have_value(re.compile(r"\?run=counting-[\w-]+&t=0\.05"))
    expect(text).to_be_focused()
    assert text.evaluate("field => field.selectionEnd - field.selectionStart === field.value.length")
    page.keyboard.press("Escape")
    edit(page, "kept.py")
    write(page, "b = 2\n")
    until(page, lambda: page.evaluate("Object.keys(localStorage).some((key) => key.endsWith(' kept.py'))"))
    other = page.context.new_page()
    other.goto(page.url)
    edit(other, "kept.py")
    expect(other.locator(CODE)).to_have_text("a = 1")
    page.reload()
    edit(page, "kept.py")
    expect(page.locator(CODE)).to_have_text("a = 1b = 2")


def test_a_dialog_takes_what_is_pressed_at_once(page: Page) -> None:
    shows(page, "#status", "at its start")
    opened = page.evaluate(
        """async () => {
            dispatchEvent(new KeyboardEvent("keydown", { key: "?", bubbles: true, cancelable: true }));
            for (let n = 0; n < 10; n += 1) await null;  // before anything is drawn
            return document.querySelector("dialog")?.open;
        }"""
    )
    assert opened


# -- files


@pytest.mark.slow
def test_a_file_chosen_while_another_is_made_or_saved_stays_shown(pages: Callable[..., Page], workbench: Served) -> None:
    page = pages("counting.py")
    shows(page, "#status", "at its start")
    edit(page, "counting.py")
    file = page.get_by_label("File", exact=True)
    with holding(page, "**/api/model", is_put):
        page.get_by_role("button", name="New model", exact=True).click()
        page.get_by_label("Name of the file").fill("slowly_made")
        page.get_by_role("button", name="Create").click()
        edit(page, "doorway.py")
    expect(file.locator("option", has_text="slowly_made.py")).to_have_count(1)
    expect(file).to_have_value("doorway.py")
    edit(page, "slowly_made.py")
    write(page, "# more\n")
    with holding(page, "**/api/model", is_put):
        page.keyboard.press("Control+Enter")
        choose(page, "doorway.py")
        shows(page, "#status", "at its start")
    expect(page.locator(".side .tab-title.unsaved")).to_have_count(0)
    expect(page.get_by_label("File", exact=True)).to_have_value("doorway.py")
    until(page, lambda: (workbench.folder / "slowly_made.py").read_text(encoding="utf-8").endswith("# more\n"))
    drawn(page)
    expect(page.get_by_label("Model", exact=True)).to_have_value("doorway.py")
    shows(page, "#status", "at its start")


@pytest.mark.slow
def test_a_text_that_is_being_saved_is_in_no_conflict_with_itself(pages: Callable[..., Page], workbench: Served) -> None:
    (workbench.folder / "saved.py").write_text("a = 1\n", encoding="utf-8")
    page = pages("counting.py")
    shows(page, "#status", "at its start")
    edit(page, "saved.py")
    write(page, "b = 2\n")
    glances = Requests(page, re.compile("/api/model/version[?]path=saved.py"))
    page.evaluate("dispatchEvent(new Event('focus'))")
    until(page, lambda: bool(glances.held))
    page.route(re.compile("/api/model/version[?]path=saved.py"), lambda route: route.continue_())  # that of the save
    with holding(page, "**/api/model", is_put):
        page.keyboard.press("Control+s")
        until(page, lambda: (workbench.folder / "saved.py").read_text(encoding="utf-8").endswith("b = 2\n"))
        write(page, "c = 3\n")
        with page.expect_response(re.compile("/api/model[?]path=saved.py")):
            glances.let_go()
        drawn(page)
        expect(page.locator(".strip")).to_have_count(0)
    shows(page, ".file-status .state", "unsaved")
    expect(page.locator(".strip")).to_have_count(0)


@pytest.mark.slow
def test_what_a_file_is_called_now_is_nothing_to_be_opened(pages: Callable[..., Page], workbench: Served) -> None:
    (workbench.folder / "before.py").write_text((workbench.folder / "counting.py").read_text(encoding="utf-8"), encoding="utf-8")
    page = pages("before.py")
    wire = Wire(page)
    shows(page, "#status", "at its start")
    edit(page, "before.py")
    with wire.holding():
        page.get_by_role("button", name="Rename").click()
        page.get_by_label("New name").fill("after.py")
        page.keyboard.press("Enter")
        expect(page.get_by_label("File", exact=True)).to_have_value("after.py")
        edit(page, "doorway.py")
    expect(page.get_by_label("Model", exact=True)).to_have_value("after.py")
    drawn(page)
    expect(page.get_by_label("File", exact=True)).to_have_value("doorway.py")


@pytest.mark.slow
def test_what_loading_says_of_a_text_is_not_taken_back_by_a_glance_at_it(pages: Callable[..., Page], workbench: Served) -> None:
    source = "def build(parameters: None) -> Simulation: ...\nraise ValueError('at its top')\n"
    (workbench.folder / "glanced.py").write_text(source, encoding="utf-8")
    page = pages("counting.py")
    shows(page, "#status", "at its start")
    edit(page, "glanced.py")
    shows(page, ".problems", "No problems|error")
    with holding(page, "**/api/check", lambda request: '"load"' not in (request.post_data or "")):
        with page.expect_request("**/api/check"):
            write(page, "# more\n")
        with page.expect_response("**/api/check"):
            page.get_by_role("button", name=re.compile("^Check the model")).click()
        shows(page, ".problems", "ValueError|NameError")
    drawn(page)
    shows(page, ".problems", "ValueError|NameError")


@pytest.mark.slow
def test_a_tab_keeps_its_unsaved_work_however_slowly_the_page_before_goes(pages: Callable[..., Page], workbench: Served) -> None:
    path: Path = workbench.folder / "kept.py"
    path.write_text("a = 1\n", encoding="utf-8")
    page = pages("counting.py")
    shows(page, "#status", "at its start")
    edit(page, "kept.py")
    write(page, "b = 2\n")
    until(page, lambda: page.evaluate("Object.keys(localStorage).some((key) => key.endsWith(' kept.py'))"))
    # Another page of the browser stands for what is left of this one.
    left = page.context.new_page()
    left.goto(f"{workbench.url}/openapi.json")
    name = page.evaluate("async () => (await part('address.js')).ownName")
    left.evaluate("(name) => void navigator.locks.request(name, () => new Promise(() => {}))", f"actr3d.tab.{name}")
    page.on("dialog", lambda dialog: dialog.accept())
    page.reload()
    shows(page, "#status", "at its start")
    edit(page, "kept.py")
    expect(page.locator(CODE)).to_have_text("a = 1b = 2")
    twin = duplicate(page)
    edit(twin, "kept.py")
    expect(twin.locator(CODE)).to_have_text("a = 1")
    expect(page.locator(CODE)).to_have_text("a = 1b = 2")


def test_nothing_is_asked_of_a_new_run_before_its_own_first_state_is_there(pages: Callable[..., Page]) -> None:
    page = pages()
    shows(page, "#status", "at its start")
    told = page.evaluate(
        """async () => {
          const { alive, moment, session, state, take } = await part("store.js");
          const { runStatus } = await part("run_status.js");
          const [before, run] = [moment.value, session.value.run + 1];
          take([{ run, epoch: 1, session: { ...session.value, run } }]);
          const between = [alive.value, moment.value === before, runStatus.value.line];
          take([{ run, epoch: 1, state: state.value }]);
          return [...between, alive.value, moment.value === before];
        }"""
    )
    assert told == [False, True, "loading …", True, False]


@pytest.mark.slow
def test_the_dialog_of_run_until_stays_open_until_the_server_has_checked(pages: Callable[..., Page]) -> None:
    page = pages("doorway.py")
    wire = Wire(page)
    shows(page, "#status", "at its start")
    page.locator("body").press("u")
    production = page.get_by_label("Production", exact=True)
    with wire.holding():
        production.fill("trun")
        page.get_by_role("button", name="Run until then").click()
        expect(page.get_by_role("dialog").get_by_role("button", name="checking …")).to_be_disabled()
        expect(production).to_be_visible()
    expect(page.get_by_role("alert")).to_have_text("no production 'trun'; did you mean 'turn'?")
    expect(production).to_be_focused()
    production.fill("look")
    with wire.holding():
        production.press("Enter")
        expect(page.get_by_role("dialog").get_by_role("button", name="checking …")).to_be_disabled()
    expect(page.get_by_role("dialog")).to_have_count(0)
    shows(page, "#status", "look fired")


@pytest.mark.slow
def test_a_run_that_was_ended_while_there_was_no_connection_is_opened_again(pages: Callable[..., Page], workbench: Served) -> None:
    page = pages("counting.py")
    wire = Wire(page)
    shows(page, "#status", "at its start")
    page.click("#cycle")
    shows(page, "#time", "0.05 s")
    (session,) = workbench.get("/api/sessions").json()["sessions"]
    with wire.cut():
        workbench.post(f"/api/sessions/{session['id']}/close")
    expect(page.locator(".toast")).to_contain_text("was ended while this page had no connection")
    shows(page, "#time", "t = 0.00 s")
    page.click("#run")
    shows(page, "#status", "ended")


def test_a_page_that_missed_a_change_and_its_undoing_explains_the_run_as_it_is_now(pages: Callable[..., Page]) -> None:
    page = pages("counting.py", tab="productions")
    wire = Wire(page)
    shows(page, "#status", "at its start")
    page.click("#cycle")
    shows(page, "#time", r"0\.05 s")
    page.locator(".production-names").get_by_text("start_counting").click()
    other = page.context.new_page()
    other.goto(page.url)
    shows(other, "#time", r"0\.05 s")
    say(other, type="command", word="set_buffer", named={"buffer": "goal", "chunk": "task:first"})
    expect(page.get_by_role("table", name="Conditions of start_counting")).to_contain_text("found 'first'")
    with wire.cut():
        say(other, type="undo")
        say(other, type="command", word="set_buffer", named={"buffer": "goal", "chunk": "task:second"})
    expect(page.get_by_role("table", name="Conditions of start_counting")).to_contain_text("found 'second'")


@pytest.mark.slow
def test_run_while_a_restart_is_under_way_runs_the_new_run(pages: Callable[..., Page], workbench: Served) -> None:
    source = (workbench.folder / "doorway.py").read_text(encoding="utf-8")
    (workbench.folder / "slow.py").write_text(source + SLOW, encoding="utf-8")
    page = pages("slow.py")
    shows(page, "#status", "at its start")
    page.locator("body").press("r")
    page.wait_for_function(LOADING)
    page.keyboard.press("Space")
    shows(page, "#status", "ended")
