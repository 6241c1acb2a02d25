"""The panels that show the mind: buffers and modules, productions and why, memory; walked through with real models."""

from __future__ import annotations

import re
from collections.abc import Callable
from io import BytesIO

import pytest
from PIL import Image
from playwright.sync_api import Locator, Page, expect

from tests.helpers.page import open_tab, say, shows, until
from tests.helpers.workbench_server import MODELS, Served

Pages = Callable[..., Page]

QUIET = """
from actr3d.actr import *

class Quiet(ACTR):
    goal = Buffer()
    def init():
        goal.set('state:waiting')
    def never(goal='state:ready'):
        pass

Quiet().run()
"""

PLOTTED = """async () => (await part("timeline/curves.js")).plots.value
    .filter(({ series }) => series.some(({ values }) => values.length >= 100))
    .map(({ title, series }) => ({ title, names: series.map(({ name }) => name) }))"""
"""The plots that have a value for each tick of a run of 1 s."""

NOTE_CHANGES = """cell => {
  const lit = [];
  const note = () => {
    for (const { textContent } of cell.querySelectorAll(".changed")) if (!lit.includes(textContent)) lit.push(textContent);
  };
  new MutationObserver(note).observe(cell, { attributes: true, childList: true, characterData: true, subtree: true });
  return lit;
}"""
"""Notes what lights up in a cell: on a busy machine it may be over before anyone looks."""

CHOOSES = """
from actr3d.actr import *

class Chooses(ACTR):
    goal = Buffer()
    retrieval = Buffer()
    memory = Memory(retrieval, threshold=5)
    noise = PMNoise(noise=0.01)
    base = DMBaseLevel(memory)
    def init():
        goal.set('turn:1')
        memory.add('animal:cat')
        memory.add('animal:dog legs:4')
    def left(goal='turn:?n', utility=1):
        goal.clear()
        memory.request('animal:?which legs:?legs')
    def right(goal='turn:1', utility=3):
        goal.set('turn:2')

Chooses().run(1)
"""


LONG = """
from actr3d.actr import *

class Long(ACTR):
    goal = Buffer()
    imaginal = Buffer()
    def init():
        goal.set('state:empty')
    def fill(goal='state:empty'):
        imaginal.set(' '.join(f'a_rather_long_name_of_slot_{n}:a_value_{n}' for n in range(30)))
        goal.set('state:full')
    def empty(goal='state:full'):
        imaginal.clear()
        goal.set('state:done')

Long().run()
"""

ORDERED = """
from actr3d.actr import *

class Ordered(ACTR):
    goal = Buffer()
    memory = Memory(Buffer())
    def init():
        goal.set('go')
        memory.add('word:zebra age:3 kind:animal')
        memory.add('word:ant age:1 kind:animal')
    def stop(goal='go'):
        goal.clear()

Ordered().run()
"""

MANY = """
from actr3d.actr import *

class Many(ACTR):
    goal = Buffer()
    memory = Memory(Buffer())
    def init():
        goal.set('go')
        for n in range(200):
            memory.add('number:?n')
    def again(goal='go'):
        goal.set('go')

Many().run(1000)
"""

LOOPS = """
from actr3d.actr import *

class Loops(ACTR):
    goal = Buffer()
    def init():
        goal.set('go')
    def loop(goal='go'):
        while True:
            pass

Loops().run()
"""


def opened(pages: Pages, workbench: Served, name: str, text: str | None = None, **options: object) -> Page:
    """Opens a page with a model at its start: one that is shipped, or one with this text. What tests before have left is closed."""
    for session in workbench.get("/api/sessions").json()["sessions"]:
        workbench.post(f"/api/sessions/{session['id']}/close")
    source = text or next(MODELS.rglob(name)).read_text(encoding="utf-8")
    (workbench.folder / name).write_text(source, encoding="utf-8")
    page = pages(name, **options)
    shows(page, "#status", "at its start")
    return page


def buffer(page: Page, name: str) -> Locator:
    return page.locator(f"tr[data-path='{name}'] .chunk")


def module(page: Page, name: str) -> Locator:
    return page.locator(f"details[data-path='{name}']")


def test_buffers_and_modules_are_shown_and_what_changed_lights_up(pages: Pages, workbench: Served) -> None:
    page = opened(pages, workbench, "counting.py")
    page.click("#cycle")
    expect(buffer(page, "goal")).to_have_text("taskcountnumber2last5")
    expect(module(page, "memory").locator("summary")).to_contain_text("waits for 'count 2 ?next', asked at 0.050 s")
    expect(module(page, "memory").get_by_label("busy", exact=True)).to_be_visible()
    place = module(page, "memory").bounding_box()
    expect(buffer(page, "goal").locator(".changed")).to_have_count(0)  # what the first cycle lit up
    lit = buffer(page, "goal").evaluate_handle(NOTE_CHANGES)
    page.click("#cycle")
    expect(buffer(page, "goal")).to_have_text("taskcountnumber3last5")
    until(page, lambda: lit.json_value() != [])
    assert lit.json_value() == ["number3"]
    expect(buffer(page, "goal").locator(".changed")).to_have_count(0)  # once
    page.click("#run")
    shows(page, "#status", "ended")
    expect(buffer(page, "goal")).to_have_text("empty")
    assert module(page, "memory").bounding_box() == place, "nothing moves when a buffer is emptied"
    expect(module(page, "memory").get_by_role("row", name="threshold")).not_to_be_visible()
    module(page, "memory").locator("summary").press("Enter")
    expect(module(page, "memory").get_by_role("row", name="threshold 0")).to_be_visible()


@pytest.mark.slow
def test_a_long_chunk_takes_few_lines_unless_all_of_it_is_asked_for(pages: Pages, workbench: Served) -> None:
    page = opened(pages, workbench, "long.py", LONG)
    chunk, whole = buffer(page, "imaginal"), page.get_by_role("button", name="All of imaginal")

    def height() -> float:
        box = chunk.bounding_box()
        assert box is not None
        return box["height"]

    page.click("#cycle")
    one_line = buffer(page, "goal").bounding_box()
    assert one_line is not None
    one = one_line["height"]
    expect(chunk).to_contain_text("value_29")
    expect(whole).to_have_attribute("aria-expanded", "false")
    few = height()
    assert few < 3.5 * one
    whole.press("Enter")
    expect(whole).to_have_attribute("aria-expanded", "true")
    assert height() > 9 * one
    whole.press("Enter")
    page.click("#cycle")
    expect(chunk).to_have_text("empty")
    expect(whole).to_have_count(0)
    until(page, lambda: height() == one)  # an emptied buffer takes one line again


def test_two_agents_are_shown_separately(pages: Pages, workbench: Served) -> None:
    page = opened(pages, workbench, "two_agents.py")
    page.click("#run")
    shows(page, "#status", "ended")
    for name in ("ada", "ben"):
        expect(page.get_by_role("table", name=f"Buffers of {name}")).to_contain_text("goal")
    open_tab(page, "Productions")
    expect(page.locator("#events")).to_contain_text("ben")
    page.get_by_label("Agent of the trace").select_option("ada")
    expect(page.locator("#events")).not_to_contain_text("ben")


def test_the_trace_goes_back_and_says_why(pages: Pages, workbench: Served) -> None:
    page = opened(pages, workbench, "counting.py")
    open_tab(page, "Productions")
    why, rows = page.locator("#why-text"), page.locator("#events tbody tr")
    page.click("#run")
    shows(page, "#status", "ended")
    expect(rows.last).to_contain_text("prints5")
    page.get_by_label("Filter the trace").fill("prints 3")
    expect(rows).to_have_count(1)
    page.get_by_label("Filter the trace").fill("count")
    expect(rows).to_have_count(5)
    rows.nth(1).click()  # to a moment of the past; what comes after it stays, in grey
    shows(page, "#time", "0.15 s")
    expect(page.locator("#events tr.ahead")).to_have_count(3)
    page.get_by_role("button", name="does not match stop_counting").click()
    expect(why).to_contain_text("stop_counting: does not match")
    expect(why.get_by_role("row", name="holds goal task:count")).to_be_visible()
    expect(why.get_by_role("row", name="does not hold goal last:?now")).to_contain_text("expected '3' (?now), found '5'")
    rows.nth(2).hover()
    rows.nth(2).get_by_role("button", name="Why at 0.250 s").click()  # ahead of the present moment
    expect(page.get_by_role("alert")).to_contain_text("lies ahead; it is 0.15 s now")
    page.get_by_role("button", name="Go to 0.2 s").click()
    shows(page, "#time", "0.20 s")
    expect(why).to_contain_text("count_on: matches, and is about to fire")
    page.get_by_role("button", name="Now", exact=True).click()
    rows.nth(0).hover()
    rows.nth(0).get_by_role("button", name="Why at 0.050 s").click()
    expect(why).to_contain_text("start_counting: matches, and is about to fire")
    shows(page, "#time", "0.20 s")  # the run stays where it is
    moment = page.get_by_label("Explain the time [s]")
    moment.fill("0.12")
    moment.press("Enter")
    expect(why).to_contain_text("start_counting: does not match")
    page.get_by_label("Search productions").fill("on")
    expect(page.get_by_role("list", name="Productions of top").get_by_role("listitem")).to_have_count(1)


@pytest.mark.slow
def test_the_keyboard_alone_does_for_the_trace_and_the_productions(pages: Pages, workbench: Served) -> None:
    page = opened(pages, workbench, "counting.py")
    open_tab(page, "Productions")
    page.click("#run")
    shows(page, "#status", "ended")
    page.get_by_role("group", name="Firing trace").focus()
    page.keyboard.press("Home")
    page.keyboard.press("ArrowDown")
    expect(page.locator("#events [aria-selected=true]")).to_contain_text("count_on")
    page.keyboard.press("w")
    expect(page.locator("#why-text")).to_contain_text("count_on: matches, and is about to fire")
    page.keyboard.press("Enter")
    shows(page, "#time", "0.15 s")
    page.locator(".production-names [aria-current=true]").focus()
    page.keyboard.press("ArrowDown")
    expect(page.locator("#why-text")).to_contain_text("start_counting:")
    page.keyboard.press("b")
    expect(page.get_by_role("button", name="Breakpoint on start_counting")).to_have_attribute("aria-pressed", "true")
    page.keyboard.press("b")
    expect(page.get_by_role("button", name="Breakpoint on start_counting")).to_have_attribute("aria-pressed", "false")


@pytest.mark.daily(1)
@pytest.mark.parametrize("theme", ["light", "dark"])
def test_a_breakpoint_is_a_dot_that_can_be_seen(pages: Pages, workbench: Served, theme: str) -> None:
    page = opened(pages, workbench, "counting.py", theme=theme)
    open_tab(page, "Productions")
    page.click("#step")
    dots = [page.get_by_role("button", name=f"Breakpoint on {name}") for name in ("count_on", "start_counting")]
    dots[0].click()
    expect(dots[0]).to_have_attribute("aria-pressed", "true")
    page.mouse.move(0, 0)
    red = "() => { const p = document.createElement('p'); p.className = 'bad'; document.body.append(p); return getComputedStyle(p).color }"
    colour = page.evaluate(red)
    wanted = tuple(int(number) for number in re.findall(r"\d+", colour)[:3])
    counts: list[int] = []
    for dot in dots:
        expect(dot).to_be_visible()
        box = dot.bounding_box()
        assert box is not None
        picture = Image.open(BytesIO(page.screenshot(clip=box))).convert("RGB")  # pyright: ignore[reportArgumentType]
        counts.append(sum(picture.getpixel((x, y)) == wanted for x in range(picture.width) for y in range(picture.height)))
    assert 30 < counts[0] < 81, counts  # a disc 9 pixels wide
    assert counts[1] == 0, counts


def test_a_breakpoint_pauses_and_is_shared(pages: Pages, workbench: Served) -> None:
    page = opened(pages, workbench, "counting.py")
    open_tab(page, "Productions")
    page.click("#step")
    other = pages("counting.py")
    open_tab(other, "Productions")
    page.get_by_role("button", name="Breakpoint on count_on").click()
    expect(other.get_by_role("button", name="Breakpoint on count_on")).to_have_attribute("aria-pressed", "true")
    page.click("#run")
    for one in (page, other):
        expect(one.locator(".held")).to_contain_text("Paused at the breakpoint on count_on")
    shows(page, "#time", "0.15 s")
    page.get_by_role("button", name="Go on").click()
    shows(page, "#time", "0.25 s")
    other.get_by_role("button", name="Remove it").click()
    expect(page.get_by_role("button", name="Breakpoint on count_on")).to_have_attribute("aria-pressed", "false")
    page.click("#run")
    shows(page, "#status", "ended")


def test_the_conflict_set_and_a_failed_retrieval(pages: Pages, workbench: Served) -> None:
    page = opened(pages, workbench, "chooses.py", CHOOSES)
    open_tab(page, "Productions")
    page.click("#cycle")
    page.get_by_role("tab", name="Conflict set").click()
    conflict = page.get_by_role("region", name="Conflict set of top")
    expect(conflict).to_contain_text("1 matched, left is about to fire")
    moment = page.get_by_label("Explain the time [s]")
    moment.fill("0.01")
    moment.press("Enter")
    expect(conflict).to_contain_text("2 matched, right is about to fire")
    expect(conflict.get_by_role("columnheader", name=re.compile("noise"))).to_be_visible()
    expect(conflict.get_by_role("row", name="left")).to_contain_text("n=1")
    page.get_by_role("button", name="Now", exact=True).click()
    page.click("#run")
    shows(page, "#status", "ended")
    page.get_by_role("tab", name="Retrievals").click()
    retrieval = page.get_by_role("region", name="Retrieval from memory")
    expect(retrieval).to_contain_text("no candidate reaches the threshold of 5")
    expect(retrieval.get_by_role("row", name="animal:dog legs:4")).to_contain_text("below the threshold by")
    expect(retrieval.get_by_role("columnheader", name="base level")).to_be_visible()


@pytest.mark.slow
def test_memory_is_searched_and_sorted(pages: Pages, workbench: Served) -> None:
    page = opened(pages, workbench, "base_level.py")
    open_tab(page, "Memory")
    page.click("#cycle")
    shows(page, "#status", "paused: .* fired")
    page.click("#cycle")
    chunks = page.locator("#chunks tbody tr")
    expect(chunks).to_have_count(4)
    head = page.locator("#chunks").get_by_role("columnheader", name="Activation")
    expect(head).to_have_attribute("aria-sort", "descending")
    page.locator("#chunks").get_by_role("button", name="Chunk").click()
    expect(chunks).to_have_text([re.compile(f"word{word}") for word in ("anchor", "button", "candle", "dragon")])
    page.get_by_label("Search the memory").fill("CAND")
    expect(chunks).to_have_count(1)
    chunks.first.click()
    expect(page.get_by_role("region", name="The chosen chunk")).to_contain_text(re.compile("Activation .* = base level"))
    page.get_by_label("Search the memory").fill("nothing like it")
    expect(page.locator(".memory")).to_contain_text("No chunk has all of these words.")


def test_chunks_whose_activation_is_unknown_are_in_the_order_of_what_is_known_of_it(blank: Page) -> None:
    order = """async ([rows, down]) => {
      const { sorted } = await part("inspector/memory_table.js");
      return sorted(rows, { by: "activation", down }).map(({ chunk }) => chunk);
    }"""
    known: list[tuple[str, float | None, float]] = [("low", None, -1), ("known", -3, -3), ("high", None, 2), ("middle", None, 0.5)]
    rows = [{"chunk": chunk, "activation": whole, "parts": {"base": base, "noise": None}} for chunk, whole, base in known]
    assert blank.evaluate(order, [rows, True]) == ["known", "high", "middle", "low"]
    assert blank.evaluate(order, [rows, False]) == ["known", "low", "middle", "high"]


@pytest.mark.slow
def test_the_activation_of_a_chosen_chunk_is_plotted_over_time_also_after_a_reload(pages: Pages, workbench: Served) -> None:
    page = opened(pages, workbench, "chooses.py", CHOOSES)
    page.click("#run")
    shows(page, "#status", "ended")
    open_tab(page, "Memory")
    page.locator("#chunks tbody tr").filter(has_text="cat").click()
    chosen = page.get_by_role("region", name="The chosen chunk")
    chosen.get_by_role("button", name="Plot", exact=True).click()
    names = ["memory: animal:cat activation over time", "memory: animal:cat base level over time"]
    for _ in range(2):
        until(page, lambda: page.evaluate(PLOTTED) == [{"title": "animal:cat over time", "names": names}])
        page.reload()
    page.locator("#chunks tbody tr").filter(has_text="cat").click()
    button = chosen.get_by_role("button", name="Plot", exact=True)
    expect(button).to_have_attribute("aria-pressed", "true")
    button.click()
    until(page, lambda: page.evaluate(PLOTTED) == [])


@pytest.mark.slow
def test_an_answer_is_shown_for_its_own_question_only(pages: Pages, workbench: Served) -> None:
    page = opened(pages, workbench, "many.py", MANY)
    open_tab(page, "Memory")
    page.click("#cycle")
    expect(page.locator(".memory .tools")).to_contain_text("200 chunks")
    page.get_by_label("Speed", exact=True).select_option(label="1 x")
    page.click("#run")
    page.get_by_label("Search the memory").fill("nothing like it")
    expect(page.locator(".memory")).to_contain_text("No chunk has all of these words.")
    shows(page, "#status", "running")
    expect(page.locator(".memory .tools")).to_contain_text(re.compile(r"as it was at \d\S* s"))
    open_tab(page, "Productions")
    moment, why = page.get_by_label("Explain the time [s]"), page.locator("#why-text")
    moment.fill("0.05")
    moment.press("Enter")
    expect(why).to_contain_text("again: matches")
    page.get_by_role("button", name="Stop the model").click()
    shows(page, "#status", "stopped")
    expect(why).to_contain_text("again: matches")
    moment.fill("0.1")
    moment.press("Enter")
    expect(why).not_to_contain_text("matches")  # nothing can be asked any more


def test_the_chunks_of_a_memory_are_shown_with_their_slots_in_the_order_of_the_model(pages: Pages, workbench: Served) -> None:
    page = opened(pages, workbench, "ordered.py", ORDERED)
    page.click("#cycle")
    open_tab(page, "Memory")
    expect(page.locator("#chunks tbody td:first-child")).to_have_text(["wordzebraage3kindanimal", "wordantage1kindanimal"])
    page.locator("#chunks").get_by_role("button", name="Chunk").click()
    expect(page.locator("#chunks tbody td:first-child").first).to_contain_text("ant")
    page.set_viewport_size({"width": 260, "height": 800})  # where the chunks are longer than a row
    chunks = page.locator("#chunks tbody tr")
    assert chunks.evaluate_all("(rows) => rows.map((row) => row.offsetHeight)") == [23, 23]
    chunks.first.click()
    slots = page.get_by_role("region", name="The chosen chunk").locator(".slot")
    assert slots.evaluate_all("(slots) => slots.map((slot) => slot.getClientRects().length)") == [1, 1, 1]  # no word is broken


def test_an_empty_agent_says_so(pages: Pages, workbench: Served) -> None:
    page = opened(pages, workbench, "quiet.py", QUIET)
    expect(page.locator("#panel-buffers")).to_contain_text("These are in its text. Press Run: the program creates its agent while it runs.")
    open_tab(page, "Productions")
    expect(page.locator("#panel-productions")).to_contain_text("Nothing has happened yet")
    page.click("#run")
    shows(page, "#status", "ended")
    expect(page.locator("#why-text")).to_contain_text("never: does not match")
    page.get_by_role("tab", name="Conflict set").click()
    expect(page.locator("#reasons-panel")).to_contain_text("No production has matched in this run")
    page.get_by_role("tab", name="Retrievals").click()
    expect(page.locator("#reasons-panel")).to_contain_text("No retrieval and no visual search had been requested")
    open_tab(page, "Memory")
    expect(page.locator("#panel-memory")).to_have_text("This model has no declarative memory.")


@pytest.mark.slow
def test_a_long_trace_stays_in_hand(pages: Pages, workbench: Served) -> None:
    page = opened(pages, workbench, "long.py", "for n in range(190_000):\n    print('line', n)\n")
    open_tab(page, "Productions")
    page.click("#run")
    shows(page, "#status", "ended")
    rows = page.locator("#events tbody tr:not(.gap)")
    expect(rows.last).to_contain_text("line 189999")
    assert rows.count() < 200, "only what is in sight is drawn"
    page.reload()  # the server sends the latest; the page requests as many earlier ones as it has room for
    shows(page, ".gap-note", "^10,000 earlier events are not shown$")
    expect(rows.last).to_contain_text("line 189999")
    page.get_by_role("group", name="Firing trace").focus()
    page.keyboard.press("Home")
    expect(rows.first).to_contain_text("line 10000")
    page.get_by_role("button", name="To the present").click()
    expect(rows.last).to_contain_text("line 189999")
    page.get_by_role("group", name="Firing trace").press("Home")
    expect(rows.first).to_contain_text("line 10000")
    page.click("#restart")
    expect(rows).to_have_count(0)
    page.click("#run")
    expect(rows.last).to_contain_text("line 189999")  # who had scrolled away had done so in another run
    expect(page.get_by_role("button", name="To the present")).to_have_count(0)


SPEAKER = """from actr3d.actr import *

class Speaker(ACTR):
    goal = Buffer()

    def init():
        goal.set("speak")

    def speak(goal="speak"):
        for n in range(5_000):
            print(f"line {n} at {self.now():.2f} s")

Speaker().run(3)
"""


@pytest.mark.slow
def test_a_page_that_has_only_the_end_of_a_long_run_shows_the_moment_to_which_it_goes_back(pages: Pages, workbench: Served) -> None:
    page = opened(pages, workbench, "speaker.py", SPEAKER)
    page.click("#run")
    shows(page, "#status", "ended")
    page.reload()
    open_tab(page, "Console")
    expect(page.locator("#panel-console")).to_contain_text("line 4999 at 3.00 s")
    say(page, type="seek", time=0.12)
    shows(page, "#time", r"0\.12 s")
    expect(page.locator("#panel-console")).to_contain_text("line 4999 at 0.10 s")
    expect(page.locator("#panel-console")).not_to_contain_text("being fetched")
    open_tab(page, "Productions")
    expect(page.locator("#events tbody")).to_contain_text("line 4999 at 0.10 s")
    expect(page.locator(".gap-note")).to_have_count(0)


@pytest.mark.slow
def test_a_busy_model_is_said_to_be_busy(pages: Pages, workbench: Served) -> None:
    page = opened(pages, workbench, "loops.py", LOOPS)
    open_tab(page, "Productions")
    page.click("#step")
    expect(page.locator("#why-text")).to_contain_text("loop: matches, and is about to fire")
    page.click("#run")
    shows(page, "#status", "busy at line")
    expect(page.locator("#reasons-panel")).to_contain_text(re.compile(r"The model is busy at line \d+; it answers after this step"))
    page.click("#stop")
    shows(page, "#status", "stopped")
    expect(page.locator("#reasons-panel")).to_contain_text("The run was stopped")


@pytest.mark.slow
def test_the_walker_has_a_result_a_body_schema_and_has_seen_an_opening(pages: Pages, workbench: Served) -> None:
    page = opened(pages, workbench, "aperture_passage.py")
    page.click("#run")
    shows(page, "#status", "ended")
    result = page.get_by_role("region", name="Result")
    expect(result).to_contain_text("Result: passed")
    expect(result).to_contain_text(re.compile(r"Peak angle\s*\d+\.\d\s*°"))
    open_tab(page, "Memory")
    page.get_by_role("button", name="Body schema").click()
    schema = page.get_by_role("region", name="Body schema")
    expect(schema.get_by_role("row", name=re.compile(r"stance_yaw done maximum 0\.\d{3}"))).to_be_visible()
    page.get_by_role("button", name="Seen").click()
    expect(page.get_by_role("region", name="Search of walker.vision").first).to_contain_text("feature:opening")


@pytest.mark.slow
def test_a_past_moment_is_explained_while_the_run_goes_on(pages: Pages, workbench: Served) -> None:
    page = opened(pages, workbench, "doorway.py")
    open_tab(page, "Productions")
    page.get_by_label("Speed", exact=True).select_option(label="1/4 x")
    page.click("#cycle")
    shows(page, "#status", "paused: look fired")  # while it goes on, the same button is there to pause it
    page.click("#run")
    moment = page.get_by_label("Explain the time [s]")
    moment.fill("0.02")
    moment.press("Enter")
    expect(page.locator("#why-text")).to_contain_text("look: matches, and is about to fire")
    shows(page, "#status", "running")


BUMPS = """
from actr3d.actr import *
from actr3d.motor import Motor
from actr3d.simulation import Simulation
from actr3d.world import Floor, Mannequin, Scene, Wall

class Walker(ACTR):
    goal = Buffer()
    motor = Motor()
    def init():
        goal.set("go")
    def go(goal="go"):
        motor.walk(1.0)
        goal.set("wait")

def build() -> Simulation:
    wall = Wall(name="wall", start=(1.0, -2.0), end=(1.0, 2.0))
    return Simulation(Scene(parts=(Floor(), Mannequin(name="walker"), wall)), {"walker": Walker}, seed=1)
"""


@pytest.mark.slow
def test_the_trace_shows_where_something_is_touched(pages: Pages, workbench: Served) -> None:
    page = opened(pages, workbench, "bumps.py", BUMPS)
    open_tab(page, "Productions")
    page.click("#run")
    shows(page, "#status", "ended")
    touches = page.locator("#events tr.contact")
    expect(touches.first).to_contain_text(re.compile(r"touch.*begins: .* with up to \d+ N"), timeout=60_000)
    rows = page.locator("#events tbody tr")
    expect(rows.filter(has_text="go").first).to_be_visible()
    when = touches.first.locator(".time").inner_text()
    assert 0.5 < float(when) < 1.5
    touches.first.click()
    shows(page, "#time", f"{float(when):.2f} s")
    expect(touches.first).to_have_attribute("aria-selected", "true")
    expect(touches.first).not_to_have_class(re.compile("ahead"))
    page.locator("#back").click()
    expect(touches.first).to_have_class(re.compile("ahead"))
    page.get_by_label("Filter the trace").fill("nothing like this")
    expect(touches).to_have_count(0)
