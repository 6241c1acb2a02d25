"""The timeline in a real browser: its lanes and plots, going back and forth on it, and the pictures that it keeps."""

from __future__ import annotations

import csv
import re
from collections.abc import Callable, Iterator
from itertools import pairwise
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import pytest
from playwright.sync_api import FloatRect, Page, expect

from tests.helpers.page import becomes_true, drawn, say, shows, until
from tests.helpers.paths import MODELS
from tests.helpers.sessions import SLOW_PROGRAM
from tests.helpers.workbench_server import Served

NAMES = 200
"""How wide the column of names is at first where there is a body [px]."""
MARGIN = 8
"""How far inside the left edge of the axis the earliest moment is [px]."""
LANE = 16
"""How high a row is [px]."""


def box(page: Page) -> FloatRect:
    found = page.locator("#timeline").bounding_box()
    assert found is not None
    return found


def at(page: Page, share: float, y: float = 30) -> tuple[float, float]:
    """Returns a place of the timeline: how far from the left edge of its axis to the right one."""
    area = box(page)
    left = page.evaluate("async () => (await part('timeline/rows.js')).column.value") + MARGIN
    return area["x"] + left + share * (area["width"] - left), area["y"] + y


def told(page: Page, share: float, step: int = LANE) -> Iterator[str]:
    """Gives what is told of each row at a place of the axis, from the top on. For plots, which are high, a larger `step` is enough."""
    before = ""
    for y in range(30, int(box(page)["height"]), step):
        page.mouse.move(*at(page, share, y))
        drawn(page)
        tip = page.get_by_role("tooltip")
        if tip.count() and (text := tip.inner_text().replace("\n\n", "\n")) != before:
            before = text
            yield text


def slider(page: Page, name: str) -> float:
    value = page.locator("#timeline").get_attribute(f"aria-{name}")
    assert value is not None
    return float(value)


def when(page: Page, time: str) -> None:
    """Waits until the run is at a time, and the playhead, too."""
    shows(page, "#time", re.escape(f"t = {time} s"))
    expect(page.locator("#timeline")).to_have_attribute("aria-valuetext", re.compile(re.escape(f"{time} s of ")))


ALL_CURVES = """async () => {
  const { known, plots } = await part("timeline/curves.js");
  const { furthest } = await part("timeline/seek.js");
  return plots.value.some(({ series }) => series.length > 0) && known.whole.some(([from, to]) => from === 0 && to >= furthest.value);
}"""
"""Whether there are plots, of which every value is known."""


@pytest.fixture
def ended(pages: Callable[..., Page]) -> Page:
    """A page that shows a run of models/doorway.py that is over."""
    page = pages(height=1000)
    page.evaluate("localStorage.setItem('actr3d.timeline height', '620')")
    page.reload()
    shows(page, "#time", "t =")
    page.evaluate(
        """async () => {
          const { request } = await part("server.js");
          const { session, state } = await part("store.js");
          const before = session.value.run;
          await request({ type: "restart", seed: 1, run: true });
          while (session.value.run === before || state.value?.status !== "ended") await new Promise((done) => setTimeout(done, 50));
        }"""
    )
    expect(page.locator("#timeline")).to_have_attribute("aria-valuemax", re.compile(r"6\.\d"))
    # Curves come by a request of their own, after the events.
    becomes_true(page, ALL_CURVES)
    return page


def drawing(page: Page) -> dict[str, Any]:
    """Returns what the timeline has drawn: its marks, the labels of its ruler from left to right, and the label of the playhead [px]."""
    drawn(page)
    return page.evaluate(
        """async () => {
          const { drawTimeline } = await part("timeline/draw.js");
          const { drawing } = await part("timeline/canvas.js");
          const { widthOf } = await part("parts/surface.js");
          const [labels, marks] = [[], []];
          const surface = { fill() {}, line() {}, within: (x, y, width, height, draw) => draw() };
          surface.polygon = (points) => marks.push(Math.min(...points.filter((_, n) => n % 2 === 0)));
          surface.text = (text, x, y, name, style = {}) => {
            if (style.anchor === "middle" && y < 20) labels.push([text, x - widthOf(text, style) / 2, x + widthOf(text, style) / 2]);
          };
          drawTimeline(surface, drawing());
          const left = document.querySelector("#timeline").getBoundingClientRect().left;
          const label = document.querySelector(".timeline-now");
          const box = label.getBoundingClientRect();
          return { labels, marks, now: [label.textContent, box.left - left, box.right - left] };
        }"""
    )


@pytest.mark.slow
def test_labels_of_the_ruler_and_the_playhead_never_overlap(ended: Page) -> None:
    page = ended
    for time in ("0.00", "1.96", "2.00", "3.50"):
        page.evaluate("async (time) => (await part('timeline/seek.js')).seek(time)", float(time))
        when(page, time)
        told = drawing(page)
        texts = [text for text, *_ in told["labels"]]
        assert ("2 s" in texts) == (time not in ("1.96", "2.00"))  # it gives way, and only then
        assert len(texts) >= 7
        assert told["now"][0] == f"{time} s"
        for (_, _, end), (_, begin, _) in pairwise(sorted([*told["labels"], told["now"]], key=lambda label: label[1])):
            assert end < begin


@pytest.mark.slow
def test_the_text_at_the_pointer_disappears_once_something_else_is_there(ended: Page) -> None:
    page, tip = ended, ended.get_by_role("tooltip")
    next(told(page, 5.0 / 8))
    expect(tip).to_have_count(1)
    page.locator("#timeline").focus()
    page.keyboard.press("Home")
    when(page, "0.00")
    expect(tip).to_have_count(0)


def test_what_happens_at_the_start_is_seen_whole(page: Page) -> None:
    shows(page, "#status", "at its start")
    page.locator("#aperture").fill("90")
    shows(page, "#width", "90 cm")
    until(page, lambda: len(drawing(page)["marks"]) > 0)
    assert drawing(page)["marks"] == [NAMES + MARGIN - 4]  # a diamond is 8 px wide
    left = drawing(page)["now"]
    assert left[1] >= NAMES


@pytest.mark.slow
def test_lanes_and_plots_show_what_happened_at_a_time(ended: Page) -> None:
    page = ended
    everything = "\n---\n".join(told(page, 5.0 / 8))
    assert re.search(r"^walker\n\w+", everything, re.MULTILINE)  # a production
    assert re.search(r"walker\.goal\n[\w -]+", everything)
    assert re.search(r"speed at [45]\.\d\d s\s+walker speed [01]\.\d+ m/s", everything)
    assert re.search(r"joints at [45]\.\d\d s\s+walker\w*torso\w* -?[\d.]+ deg", everything)
    # A moment later a gap was seen, and printed.
    page.get_by_label("Filter rows").fill("printed")
    assert any("a gap of 0.50 m" in text for text in told(page, 4.7 / 8))


def drag_aperture(page: Page) -> None:
    """Draws the slider of the aperture to 90 cm by many steps, as a hand does."""
    area = page.locator("#aperture").bounding_box()
    assert area is not None
    least, most, now = (float(page.locator("#aperture").evaluate(f"slider => slider.{name}")) for name in ("min", "max", "value"))
    thumb = 16

    def place(value: float) -> float:
        return area["x"] + thumb / 2 + (value - least) / (most - least) * (area["width"] - thumb)

    page.mouse.move(place(now), area["y"] + area["height"] / 2)
    page.mouse.down()
    for value in range(int(now), 91, 5):
        page.mouse.move(place(value), area["y"] + area["height"] / 2)
        drawn(page)
    page.mouse.up()
    page.locator("#aperture").fill("90")  # a pixel is more than a centimetre


@pytest.mark.slow
def test_going_back_and_forth(ended: Page) -> None:
    page = ended
    end = slider(page, "valuemax")
    again, newest = page.get_by_role("button", name="Continue from here"), page.get_by_role("button", name="Newest moment")
    expect(again).to_be_disabled()
    page.mouse.move(*at(page, 0.8))
    page.mouse.down()
    for share in (0.7, 0.5, 0.3, 0.25):
        page.mouse.move(*at(page, share))
        drawn(page)
        assert abs(slider(page, "valuenow") - 8 * share) < 0.02  # the playhead is there at once
    page.mouse.up()
    when(page, "2.00")
    assert slider(page, "valuemax") == end
    page.keyboard.press("ArrowRight")
    when(page, "2.01")
    page.keyboard.press("Shift+ArrowLeft")
    when(page, "1.96")
    page.keyboard.press("Home")
    when(page, "0.00")
    newest.click()
    when(page, f"{end:.2f}")
    page.locator("#timeline").focus()
    page.keyboard.press("ArrowLeft")
    when(page, f"{end - 0.01:.2f}")
    page.get_by_role("tab", name="Memory").focus()
    page.keyboard.press("Shift+ArrowLeft")
    when(page, f"{end - 0.06:.2f}")
    expect(page.get_by_role("tab", name="Memory")).to_be_focused()
    page.mouse.click(*at(page, 0.5))
    when(page, "4.00")
    again.click()
    shows(page, "#status", "ended")
    assert slider(page, "valuemax") == slider(page, "valuenow") == end  # it went as it had gone
    # Where something is changed in the past, another way begins: what was known after it is kept as a branch.
    page.mouse.click(*at(page, 0.25))
    when(page, "2.00")
    drag_aperture(page)
    shows(page, "#width", "90 cm")
    shows(page, ".branched", rf"The run up to {end:.2f} s is kept as a branch")
    shows(page, "#status", r"paused: changed at 2\.00 s$")
    page.locator("#aperture").focus()
    page.keyboard.press("Home")  # is the slider's own key
    when(page, "2.00")
    expect(page.locator("#aperture")).not_to_have_value("90")
    page.locator("#aperture").fill("90")
    shows(page, "#width", "90 cm")
    page.click("#run")
    shows(page, "#status", "ended")
    page.get_by_label("Filter rows").fill("commands")
    (mark,) = [text for text in told(page, 0.25) if "commands" in text]
    assert re.fullmatch(r"commands\naperture 50 -> .* -> 90 cm\nat 2\.000 s", mark)
    steps: list[tuple[str, str]] = re.findall(r"aperture (\d+) -> (\d+) cm", mark)  # each that one undo takes back
    assert [was for was, _ in steps[1:]] == [now for _, now in steps[:-1]]
    page.get_by_label("Filter rows").fill("joints")
    assert any(re.search(r"torso\w* -?[01]\.\d+ deg", text) for text in told(page, 5.8 / 8))  # it is wide enough not to turn


@pytest.mark.slow
def test_zoom_and_choice_of_rows(ended: Page) -> None:
    page = ended
    fit = page.get_by_role("button", name="Fit")
    expect(fit).to_have_attribute("aria-pressed", "true")
    page.mouse.move(*at(page, 0.5))
    page.mouse.wheel(0, -400)
    expect(fit).to_have_attribute("aria-pressed", "false")
    page.mouse.click(*at(page, 0.5))
    when(page, "4.00")  # what the pointer was at has stayed where it was
    page.mouse.click(*at(page, 0.75))
    until(page, lambda: 4.5 < slider(page, "valuenow") < 5.8)
    near = slider(page, "valuenow")
    when(page, f"{near:.2f}")
    page.mouse.move(*at(page, 0.5, 8))
    page.mouse.down()
    page.mouse.move(*at(page, 0.25, 8))
    page.mouse.up()
    page.mouse.click(*at(page, 0.5))
    drawn(page)
    assert abs(slider(page, "valuenow") - near) < 0.05  # the axis was drawn to the left by a quarter
    fit.click()
    page.mouse.click(*at(page, 0.5, 8))  # of the axis
    when(page, "4.00")
    page.mouse.move(*at(page, 0.5, 8))
    page.mouse.down()  # on the playhead
    page.mouse.move(*at(page, 0.25, 8))
    page.mouse.up()
    when(page, "2.00")
    marks, curves = page.get_by_role("button", name="Marks"), page.get_by_role("button", name="Curves", exact=True)
    until(page, lambda: any("printed" in text for text in told(page, 6.8 / 8)))
    marks.click()
    curves.click()
    assert not any("printed" in text or "speed at" in text for text in told(page, 6.8 / 8))
    curves.click()
    page.get_by_role("button", name="Curves …").click()
    page.get_by_label("walker contact force").check()
    page.get_by_role("button", name="Close").click()
    page.reload()
    shows(page, "#status", "paused|ended")
    expect(page.get_by_role("button", name="Marks")).to_have_attribute("aria-pressed", "false")
    page.get_by_label("Filter rows").fill("contact")
    expect(page.locator("#timeline")).to_have_attribute("aria-valuemax", re.compile(r"6\.\d"))
    until(page, lambda: any("contact force at" in text for text in told(page, 0.5)))  # once the curve has come


@pytest.mark.slow
def test_pictures(ended: Page, tmp_path: Path) -> None:
    page = ended

    def kept(kind: str, what: str | None = None) -> Path:
        page.get_by_role("button", name="Save a picture").click()
        if what is not None:
            page.get_by_label("Of what").select_option(what)
        with page.expect_download() as download:
            page.get_by_role("button", name=kind).click()
        path = tmp_path / download.value.suggested_filename
        download.value.save_as(path)
        return path

    svg = kept("SVG")
    assert svg.name.startswith("doorway_seed_")
    text = svg.read_text(encoding="utf-8")
    words = [node.text for node in ElementTree.fromstring(text).iter("{http://www.w3.org/2000/svg}text")]
    assert any("doorway.py" in str(word) and "seed" in str(word) for word in words)
    assert {"0 s", "printed", "eye", "goal", "speed [m/s]"} <= set(words)
    assert not re.search(r"href|url\((?!#)|var\(|light-dark", text)
    plot = kept("SVG", "the plot of speed [m/s]")
    assert {"walker speed", "0 s"} <= {node.text for node in ElementTree.fromstring(plot.read_text(encoding="utf-8")).iter()}
    rows = list(csv.reader(kept("CSV", "the plot of speed [m/s]").read_text(encoding="utf-8").splitlines()))
    assert rows[0] == ["time [s]", "walker speed [m/s]"]
    assert float(rows[-1][0]) > 6
    assert max(float(speed) for _, speed in rows[1:] if speed) > 1
    png = kept("PNG").read_bytes()
    assert png.startswith(b"\x89PNG\r\n")
    assert len(png) > 20_000
    assert int.from_bytes(png[16:20]) > 2000  # sharp enough to print [pixels across]


@pytest.mark.slow
def test_what_a_model_says_is_text(pages: Callable[..., Page], workbench: Served) -> None:
    """Also of a program whose models run one after another, whose times follow each other on the axis."""
    (workbench.folder / "twice.py").write_text(
        "from actr3d.actr import ACTR, Buffer, Model\n\n\n"
        "class Mind(ACTR):\n    goal = Buffer()\n    goal.set('start')\n\n"
        "    def speak(goal='start'):\n        print('<img src=x onerror=alert(1)>')\n        goal.set('done')\n\n\n"
        "class Place(Model):\n    pass\n\n\n"
        "for _ in range(2):\n    place = Place()\n    place.mind = Mind()\n    place.run(0.4)\n",
        encoding="utf-8",
    )
    page = pages("twice.py")
    page.on("dialog", lambda dialog: pytest.fail("it was run as HTML"))
    shows(page, "#status", "at its start")
    page.click("#run")
    shows(page, "#status", "ended")
    expect(page.locator("#timeline")).to_have_attribute("aria-valuemax", "0.8")
    page.get_by_label("Filter rows").fill("printed")
    first, second = list(told(page, 0.05)), list(told(page, 0.45))
    assert any("<img src=x onerror=alert(1)>\nat 0.050 s" in text for text in first), first
    assert any("<img src=x onerror=alert(1)>\nat 0.450 s" in text for text in second), second
    page.get_by_label("Filter rows").fill("goal")
    assert any("start\n0.000 s to 0.050 s" in text for text in told(page, 0.02))
    page.locator("#timeline").focus()
    page.keyboard.press("Home")
    when(page, "0.00")


def test_a_request_that_fails_at_the_end_of_a_run_looks_like_one(blank: Page) -> None:
    bands: Any = blank.evaluate(
        """async () => {
          const { Lanes } = await part("timeline/lanes.js");
          const lanes = new Lanes();
          const events = [
            [0, "mind.DM", "state", { busy: true }], [0, "mind.DM", "request", { asked: { 0: "colour" } }],
            [50000, "mind.DM", "state", { error: true }], [50000, "mind.DM", "state", { busy: false }],
            [50000, "mind.DM", "retrieval", { failed: true }], [50000, "mind", "stop", { by: "done" }],
          ];
          for (const event of events) lanes.take(event);
          return lanes.lanes.get("module mind.DM").bands.map(({ text, tone, to, end }) => [text, tone, to, end]);
        }"""
    )
    assert bands[0][1:] == ["bad", 0.05, "failed"], "not like one that succeeded"


def test_many_events_are_taken_in_one_by_one(blank: Page) -> None:
    """Whatever has happened before, more events cost what they are, and what is drawn is no more than the page is wide."""
    counts: dict[str, Any] = blank.evaluate(
        """async () => {
          const { Lanes } = await part("timeline/lanes.js");
          const { drawTimeline } = await part("timeline/draw.js");
          const lanes = new Lanes();
          for (let n = 0; n < 100000; n += 1) {
            lanes.take([n * 1000, "mind.goal", "buffer", { chunk: n % 2 ? { 0: `chunk ${n}` } : null }]);
          }
          const lane = lanes.lanes.get("buffer mind.goal");
          let calls = 0;
          const count = () => (calls += 1);
          const surface = { fill: count, line() {}, polygon: count, text: count, within: (x, y, w, h, draw) => draw() };
          const layout = { rows: [{ lane, label: "goal", y: 20, height: 18 }] };
          drawTimeline(surface, { width: 900, height: 60, column: 100, scroll: 0, span: { from: 0, to: 100 }, layout, end: 100, begin: 0 });
          return { bands: lane.bands.length, calls, at: lane.at(50.0015, 0)?.chunk[0], open: lane.open?.from };
        }"""
    )
    assert counts == {"bands": 50_000, "calls": counts["calls"], "at": "chunk 50001", "open": 99.999}
    assert counts["calls"] < 3 * 900


MARKED = """async (ends) => {
  const { Lanes } = await part("timeline/lanes.js");
  const { drawTimeline } = await part("timeline/draw.js");
  const lanes = new Lanes();
  lanes.take([5e6, "simulation", "output", { text: "can pass as it is" }]);
  const layout = { rows: [{ lane: lanes.lanes.get("said"), label: "printed", y: 20, height: 16 }] };
  return ends.map((end) => {
    let anchor = null;
    const surface = { fill() {}, line() {}, polygon() {}, within: (x, y, width, height, draw) => draw() };
    surface.text = (text, x, y, name, style = {}) => text === "can pass as it is" && (anchor = style.anchor ?? "start");
    const seen = { begin: 0, known: Infinity };
    drawTimeline(surface, { width: 1000, height: 60, column: 100, scroll: 0, span: { from: 0, to: 10 }, layout, end, ...seen });
    return anchor;
  });
}"""
"""Where the text of a mark at 5 s begins or ends at it, by the newest moments of the run; a second is 89 px long."""


def test_the_text_of_the_last_mark_is_not_crossed_by_the_line_at_the_newest_moment(blank: Page) -> None:
    assert blank.evaluate(MARKED, [5, 5.5, 9]) == ["start", "end", "start"]


EARLIER = """async () => {
  const { events } = await part("store.js");
  const { lanes } = await part("timeline/record.js");
  const { EventFilter } = await part("inspector/event_filter.js");
  const filter = new EventFilter(([, , kind]) => kind === "fire");
  const shown = () => {
    const { first, list } = events.value;
    const counts = [...lanes.lanes].map(([key, { bands }]) => [key, bands.length]).sort();
    return { first, list, counts, fired: [...filter.update(events.value).numbers] };
  };
  const whole = shown();
  const list = whole.list.slice(40);
  events.value = { list, first: 40 };
  const late = shown();
  for (let n = 0; n < 500 && events.value.first > 0; n += 1) await new Promise((done) => setTimeout(done, 10));
  return { whole, late, again: shown() };
}"""
"""What a page shows of a run of which it has all events, only the last ones, and what it has a little later."""


def test_a_page_that_has_only_the_last_events_fetches_the_earlier_ones_while_the_run_is_paused(pages: Callable[..., Page]) -> None:
    page = pages("counting.py")
    page.get_by_role("button", name="Run", exact=True).click()
    shows(page, "#status", "ended")
    found = page.evaluate(EARLIER)
    assert found["whole"]["first"] == 0 < found["late"]["first"]
    assert found["late"]["fired"] != found["whole"]["fired"]
    assert found["again"] == found["whole"]


SEEK = """async (time) => void (await (await part("server.js")).request({ type: "seek", time }))"""
LATEST = """async (count) => {
  const { events } = await part("store.js");
  const { list, first } = events.value;
  events.value = { list: list.slice(-count), first: first + list.length - count };
  return first + list.length;
}"""
AROUND = """async () => {
  const { events, state } = await part("store.js");
  const { drawing } = await part("timeline/canvas.js");
  const { list, first } = events.value;
  return { first, last: first + list.length, now: state.value.events, known: drawing().known };
}"""
"""The numbers of the events that a page has, and of those up to the present moment; until when the timeline shows what is known."""


def test_a_page_has_the_events_around_the_moment_to_which_a_long_run_went_back(pages: Callable[..., Page]) -> None:
    page = pages("counting.py", tab="productions")
    page.get_by_role("button", name="Run", exact=True).click()
    shows(page, "#status", "ended")
    page.evaluate(SEEK, 0.05)
    shows(page, "#time", r"0\.05 s")
    count = page.evaluate(LATEST, 5)
    until(page, lambda: page.evaluate(AROUND)["first"] == 0)
    found = page.evaluate(AROUND)
    assert 0 < found["last"] == found["now"] < count - 5
    assert found["known"] <= 0.05
    expect(page.locator("#events tbody")).to_contain_text("start_counting")
    page.evaluate(SEEK, 0.15)  # later, but not where the page has events
    shows(page, "#time", r"0\.15 s")
    until(page, lambda: page.evaluate(AROUND)["last"] == page.evaluate(AROUND)["now"] > found["last"])
    page.get_by_role("button", name="Newest moment").click()
    until(page, lambda: page.evaluate(AROUND)["last"] == count)
    assert page.evaluate(AROUND)["first"] == 0


AXIS = """async ([end, width]) => {
  const { drawTimes } = await part("parts/curve.js");
  const { widthOf } = await part("parts/surface.js");
  const found = [];
  const text = (text, x, y, name, style) => found.push([x - widthOf(text, style) / 2, x + widthOf(text, style) / 2]);
  drawTimes({ line() {}, text }, { x: 0, y: 0, width, height: 20 }, { from: 0, to: end }, { y: 0 });
  return found;
}"""


SPIKES = """async () => {
  const { drawCurves } = await part("parts/curve.js");
  const count = 300000;
  const times = Array.from({ length: count }, (_, n) => n / 100);
  const values = times.map((_, n) => (n === 123456 ? 9 : n === 234567 ? -9 : Math.sin(n)));
  const found = {};
  for (const shape of ["line", "points", "steps"]) {
    const [tops, ends, calls] = [[], [], []];
    const fill = (x, y, w, h) => (tops.push(y + 1.5), ends.push(y + h - 1.5), calls.push(x));
    const line = (points, colour, style) => {
      if (style?.width === 1.5) points.forEach((y, n) => n % 2 && [tops, ends, calls].forEach((list) => list.push(y)));
    };
    const surface = { fill, line, text() {}, within: (x, y, w, h, draw) => draw() };
    const box = { x: 0, y: 0, width: 800, height: 100 };
    drawCurves(surface, box, { series: [{ name: "many", values, times, shape }], span: { from: 0, to: count / 100 }, range: [-10, 10] });
    found[shape] = [Math.min(...tops), Math.max(...ends), calls.length < 8 * box.width];
  }
  return found;
}"""


def test_a_plot_of_very_many_values_has_their_extremes_and_is_no_more_than_the_page_is_wide(blank: Page) -> None:
    assert blank.evaluate(SPIKES) == {shape: [5, 95, True] for shape in ("line", "points", "steps")}


UNEVEN = """async () => {
  const { drawCurves, valueAt } = await part("parts/curve.js");
  const [times, all, width, height] = [[], [], 800, 100];
  for (let time = 0; time < 86400; time += 40) {
    const dense = Math.floor(time / 4000) % 9 === 1 && time % 4000 < 1000; // stretches of each tick in an overview
    for (let n = 0; n < (dense ? 4000 : 1); n += 1) times.push(time + n / 100);
  }
  times.push(86411.53);
  for (const time of times) all.push(3 * Math.exp(-(time % 30000) / 5000) + 0.01 * Math.sin(time));
  const missing = all.map((value, n) => (Math.floor(times[n] / 2500) % 4 === 2 ? null : value));
  const found = {};
  for (const [name, shape, values] of [["line", "line", all], ["gaps", "line", missing], ["steps", "steps", all]]) {
    for (const [from, to] of [[0, 86411.53], [81200.003, 87000], [4900.003, 5100], [4990.003, 4992]]) {
      const curve = { name, unit: "", times, values, shape };
      const lines = [];
      const line = (points, colour, style) => style?.width === 1.5 && lines.push(points);
      const surface = { line, fill() {}, text() {}, within: (x, y, w, h, draw) => draw() };
      drawCurves(surface, { x: 0, y: 0, width, height }, { series: [curve], span: { from, to }, range: [-1, 4] });
      const yOf = (value) => height - ((value + 1) / 5) * height;
      const empty = () => Array.from({ length: width }, () => [Infinity, -Infinity]);
      const [truth, drawn] = [empty(), empty()];
      const put = (columns, x, y) => {
        for (const at of new Set([Math.floor(x - 1e-6), Math.floor(x + 1e-6)])) {
          if (columns[at] && !Number.isNaN(y)) columns[at] = [Math.min(columns[at][0], y), Math.max(columns[at][1], y)];
        }
      };
      const xOf = (time) => ((time - from) / (to - from)) * width;
      times.forEach((time, n) => values[n] !== null && put(truth, xOf(time), yOf(values[n])));
      for (let x = 0; x <= width; x += 1) {
        const value = valueAt(curve, from + (x / width) * (to - from));
        if (value !== null) put(truth, x, yOf(value));
      }
      const [points] = lines;
      for (let n = 0; n < points.length; n += 2) {
        const [x, y, before, last] = [points[n], points[n + 1], points[n - 2], points[n - 1]];
        put(drawn, x, y);
        if (n > 0 && !Number.isNaN(y + last)) {
          const [first, end] = [Math.max(0, Math.ceil(before)), x > before ? Math.min(x, width) : -1];
          for (let at = first; at <= end; at += 1) put(drawn, at, last + ((y - last) * (at - before)) / (x - before));
        }
      }
      const isNear = ([least, most], [low, high]) => Math.abs(least - low) + Math.abs(most - high) < 0.01;
      const differs = (one, other) => (one[0] <= one[1] || other[0] <= other[1]) && !isNear(one, other);
      const isSame = !truth.some((one, n) => differs(one, drawn[n]));
      const isWhole = points.at(-2) >= Math.min(width, xOf(times.at(-1))) - 1e-6;
      found[`${name} ${from}`] = [isSame, isWhole, points.length < 11 * width];
    }
  }
  return found;
}"""
"""Whether a line of many unevenly spaced values is, in each pixel, as low and as high as the values, whether it goes on up to the last
value or the edge, and whether it has few points."""


def test_a_line_of_many_uneven_values_agrees_with_them_in_each_pixel(blank: Page) -> None:
    found = blank.evaluate(UNEVEN)
    assert len(found) == 12
    assert [name for name, told in found.items() if told != [True, True, True]] == []


REPLACED = """async () => {
  const { leastAndMost, replace } = await part("parts/curve.js");
  const values = [];
  const found = [];
  const put = (first, beyond, news) => {
    replace(values, first, beyond, news);
    const there = values.filter((value) => value !== null);
    found.push([leastAndMost(values), [Math.min(...there), Math.max(...there)]]);
  };
  put(0, 0, Array.from({ length: 1500 }, (_, n) => Math.sin(n)));
  put(700, 701, Array.from({ length: 1000 }, (_, n) => (n === 500 ? 7 : n / 1000))); // more in place of one
  put(1200, 1201, [-7]); // the greatest one is gone
  put(1200, 1300, []);
  put(0, 1, [null, null, 9]);
  put(values.length, values.length, [10, 11]);
  put(0, values.length, [null]);
  put(0, 1, [1]);
  return found;
}"""


def test_the_range_of_a_curve_is_that_of_its_values_after_some_were_replaced(blank: Page) -> None:
    found = blank.evaluate(REPLACED)
    assert [told for told, _ in found] == [truth for _, truth in found]
    assert found[1][0][1] == 7
    assert found[5][0][1] == 11


def test_no_text_of_the_axis_is_cut(blank: Page) -> None:
    for end, width in ((1, 400), (12.5, 1100), (3, 1700), (0.02, 900)):
        drawn = blank.evaluate(AXIS, [end, width])
        assert len(drawn) > 2
        assert drawn[0][0] >= 4
        assert drawn[-1][1] <= width - 4
        assert all(one[1] < other[0] for one, other in pairwise(drawn))


@pytest.mark.slow
def test_the_labels_of_a_saved_plot_stand_under_their_lines(pages: Callable[..., Page]) -> None:
    page = pages("doorway.py")
    page.get_by_role("button", name="Run", exact=True).click()
    shows(page, "#status", "ended")
    page.get_by_role("button", name="Save a picture", exact=True).first.click()
    dialog = page.get_by_role("dialog")
    dialog.get_by_label("Of what").select_option("0")
    with page.expect_download() as download:
        dialog.get_by_role("button", name="SVG").click()
    drawn = ElementTree.parse(download.value.path())
    upright = [re.fullmatch(r"M([\d.]+) [\d.]+L\1 [\d.]+", path.attrib["d"]) for path in drawn.findall(".//{*}path")]
    lines = {float(found[1]) for found in upright if found}
    labels = {float(text.attrib["x"]): text.text for text in drawn.findall(".//{*}text") if text.attrib["text-anchor"] == "middle"}
    assert len(labels) > 4
    assert labels[min(labels)] == "0 s"
    assert set(labels) == lines


EVERY_TICK = """async () => {
  const { known } = await part("timeline/curves.js");
  const { state } = await part("store.js");
  const ticks = known.times.map((time) => Math.round(time * 100));
  const whole = ticks.length === Math.round(state.value.furthest * 100) + 1 && ticks.every((tick, n) => tick === n);
  return whole && [...known.values.values()].every(({ length }) => length === ticks.length);
}"""
"""Whether the curves have a value of each tick, once."""


@pytest.mark.slow
def test_curves_have_every_tick_after_a_restart_and_a_reload(ended: Page) -> None:
    page = ended
    until(page, lambda: page.evaluate(EVERY_TICK))
    for _ in range(3):
        page.evaluate(
            """async () => {
              const { request } = await part("server.js");
              const { session, state } = await part("store.js");
              const before = session.value.run;
              await request({ type: "restart", run: true });
              while (session.value.run === before || state.value?.status !== "ended") await new Promise((done) => setTimeout(done, 50));
            }"""
        )
        until(page, lambda: page.evaluate(EVERY_TICK))
    say(page, type="restart", run=True)
    page.reload()  # while it goes on
    shows(page, "#status", "ended")
    until(page, lambda: page.evaluate(EVERY_TICK))


@pytest.mark.slow
def test_a_short_run_fits_and_the_slider_keeps_its_keys(pages: Callable[..., Page]) -> None:
    page, other = pages("counting.py"), pages("counting.py")
    shows(page, "#status", "at its start")
    page.click("#step")
    when(page, "0.01")
    page.get_by_role("button", name="Fit").click()
    page.mouse.move(*at(page, 0.5))
    assert page.evaluate("async () => (await part('timeline/view.js')).span.value.to") < 0.1
    for one, another in ((page, other), (other, page)):
        shows(one, "#browsers", "2 pages show this run")
        one.click("#step")
        shows(one, "#browsers", "you are in control")
        shows(another, "#browsers", "another one is in control")


RUNS = """async () => {
    const { Lanes } = await part("timeline/lanes.js");
    const lanes = new Lanes();
    const of = (time, source, kind, data = {}) => lanes.take([time * 1e6, source, kind, data]);
    const hold = (time, source, text) => of(time, source, "buffer", { chunk: { 0: text } });
    of(0, "top", "run");
    hold(0, "walker.goal", "go");
    of(4, "top", "stop");
    of(4, "top#2", "run");
    hold(4, "top#2.bob.goal", "go");
    of(6, "top#2", "stop");
    of(6, "top", "run");
    of(7, "walker", "fire", { production: "end" });
    const bands = (key) => lanes.lanes.get(key).bands.map(({ from, to }) => [from, to]);
    return [bands("buffer walker.goal"), bands("buffer top#2.bob.goal")];
}"""


def test_what_a_buffer_holds_is_drawn_while_its_run_goes_on(blank: Page) -> None:
    assert blank.evaluate(RUNS) == [[[0, 4], [6, None]], [[4, 6]]]


TRIALS = """
from actr3d.actr import *

class Trial(ACTR):
    goal = Buffer()
    retrieval = Buffer()
    memory = Memory(retrieval, latency=0.3, threshold=None)
    noise = DMNoise(memory, noise=0.6)
    def init():
        memory.add("word:red")
    def ask(goal="look"):
        memory.request("word:?what")
        goal.set("wait")
    def say(goal="wait", retrieval="word:?what"):
        print("said", what)
        goal.set("done")
        self.stop()

for n in range(6):
    trial = Trial()
    trial.goal.set("look")
    trial.run()
"""
"""Runs of different durations, some of which are longer than the first one."""
ENDS = """async () => {
  const { lanes } = await part("timeline/record.js");
  const { state } = await part("store.js");
  const fired = [1, 2, 3, 4, 5, 6].map((run) => lanes.lanes.get(`productions ${run === 1 ? "top" : `top#${run}`}`)?.bands.at(-1).to);
  const { events } = await (await part("server.js")).request({ type: "curves" });
  const latest = Math.max(...Object.values(events).map(({ times }) => times.at(-1)));
  return { fired, printed: lanes.lanes.get("said").bands.map(({ from }) => from), now: state.value.time, latest };
}"""
"""When the last production of each run has fired, when something was printed, the time of the run, and that of the last number."""


def test_runs_of_a_program_follow_each_other_as_its_clock_counts_them(pages: Callable[..., Page], workbench: Served) -> None:
    (workbench.folder / "trials.py").write_text(TRIALS, encoding="utf-8")
    page = pages("trials.py")
    shows(page, "#status", "at its start")
    say(page, type="restart", seed=3, run=True)
    shows(page, "#status", "ended")
    until(page, lambda: len(page.evaluate(ENDS)["printed"]) == 6)
    ends = page.evaluate(ENDS)
    assert ends["fired"] == ends["printed"] == sorted(ends["printed"])
    assert ends["latest"] <= ends["printed"][-1] == ends["now"]
    lasted = [end - begin for begin, end in pairwise([0, *ends["printed"]])]
    assert max(lasted[1:]) > lasted[0]
    page.locator("#timeline").focus()
    page.keyboard.press("End")
    when(page, f"{ends['now']:.2f}")
    page.evaluate("async (time) => (await part('timeline/seek.js')).travel(time)", ends["printed"][2])
    when(page, f"{ends['printed'][2]:.2f}")

    page.get_by_role("tab", name="Productions").click()
    rows, at = page.locator("#events tbody tr"), page.get_by_label("Explain the time [s]")
    expect(rows.filter(has_text="prints").nth(2)).to_contain_text(f"{ends['printed'][2]:.3f}")
    expect(rows.filter(has_text="prints").nth(5)).to_contain_text(f"{ends['now']:.3f}")
    expect(at).to_have_attribute("placeholder", f"{ends['printed'][2]:.3f}")
    expect(page.locator("#why-text")).to_contain_text("In top#4")  # which has begun at that moment
    rows.filter(has_text="prints").nth(1).click()
    when(page, f"{ends['printed'][1]:.2f}")
    expect(at).to_have_attribute("placeholder", f"{ends['printed'][1]:.3f}")
    page.get_by_label("Filter the trace").fill("top#2 fire say")
    expect(rows).to_have_count(1)
    rows.hover()
    rows.get_by_role("button", name="why").click()
    expect(page.locator("#why-text")).to_contain_text("say: matches, and is about to fire")
    page.evaluate("async () => (await part('inspector/explanation.js')).shownReasons.value = 'conflict'")
    conflict = page.get_by_role("region", name="Conflict set of top#2")
    expect(conflict).to_contain_text(f"at {ends['printed'][1] - 0.05:.3f} s: 1 matched, say is about to fire")
    expect(conflict).to_contain_text("what=red")


FAILS = """
from actr3d.actr import *
from actr3d.simulation import BodyPort, Simulation
from actr3d.world import Floor, Mannequin, Scene

class Walker(ACTR):
    goal = Buffer()
    skin = BodyPort()
    def init():
        goal.set("one")
    def one(goal="one"):
        goal.set("two")
    def two(goal="two"):
        goal.set("three")
    def three(goal="three"):
        print("goes")
        skin.set("walk_to", 3, 1.5)

def build() -> Simulation:
    return Simulation(Scene(parts=(Floor(), Mannequin(name="walker"))), {"walker": Walker}, seed=1)
"""


def test_a_run_that_fails_in_a_tick_is_at_the_moment_of_the_failure(pages: Callable[..., Page], workbench: Served) -> None:
    (workbench.folder / "fails_in_tick.py").write_text(FAILS, encoding="utf-8")
    page = pages("fails_in_tick.py")
    shows(page, "#status", "at its start")
    page.click("#run")
    shows(page, "#status", "^failed")
    when(page, "0.15")
    assert page.evaluate("async () => (await part('timeline/record.js')).lanes.lanes.get('said').bands[0].from") == 0.15
    page.click("#back")
    shows(page, "#status", "went to this time")
    when(page, "0.14")
    page.locator("#timeline").focus()
    page.keyboard.press("End")
    shows(page, "#status", "^failed")
    when(page, "0.15")


COUNTS = """
from actr3d.actr import *


class Counting(ACTR):
    goal = Buffer()
    b_memory = Buffer()
    memory = Memory(b_memory, latency=0.5, threshold=None)

    def init():
        for number in range(9):
            memory.add(f"from:{number} to:{number + 1}")
        goal.set("count at:0 until:4")

    def ask(goal="count at:?at until:!?at", b_memory=None, memory="busy:False"):
        memory.request(f"from:{at} to:?")

    def step(goal="count at:?at", b_memory="from:?at to:?to"):
        b_memory.clear()
        goal.modify(at=to)


model = Counting()
model.run()
"""


PLOTTED = """async () => (await part("timeline/curves.js")).plots.value.map(({ title, series }) => [title, series])"""


@pytest.mark.slow
def test_numbers_in_buffers_and_of_modules_are_curves(pages: Callable[..., Page], workbench: Served) -> None:
    (workbench.folder / "counts.py").write_text(COUNTS, encoding="utf-8")
    page = pages("counts.py", height=1000)
    page.get_by_role("button", name="Run", exact=True).click()
    becomes_true(page, "async () => (await part('store.js')).state.value?.status === 'ended'")
    page.get_by_role("button", name="Curves …").click()
    choice = page.get_by_role("dialog")
    for name in ("goal.at", "memory latency", "memory busy"):
        choice.get_by_label("Filter curves").fill(name)
        choice.get_by_label(name, exact=True).check()
    page.keyboard.press("Escape")
    found = page.evaluate(
        """async () => {
          const { csvText } = await part("parts/csv.js");
          const { plots } = await part("timeline/curves.js");
          const { lanes } = await part("timeline/record.js");
          const seriesOf = (title) => plots.value.find((plot) => plot.title === title)?.series ?? [];
          const isThere = (title) => seriesOf(title)[0]?.values.length > 0;
          while (!["time busy", "at"].every(isThere)) await new Promise((done) => setTimeout(done, 20));
          const csv = [csvText(seriesOf("at"))];
          return { csv, busy: seriesOf("time busy")[0].values.at(-1), end: lanes.now / 1e6 };
        }"""
    )
    rows = list(csv.reader(found["csv"][0].splitlines()))
    assert rows[0] == ["time [s]", "goal.at"]
    assert [float(value) for _, value in rows[1:]] == [0, 1, 2, 3, 4]
    assert 0 < found["busy"] < found["end"]
    tips = list(told(page, 0.95, 2 * LANE))
    assert any("goal.at 4" in text for text in tips), tips
    assert any("memory latency" in text and " s" in text for text in tips), tips
    becomes_true(page, ALL_CURVES)
    shown = page.evaluate(PLOTTED)
    assert len(shown) == 3
    say(page, type="seek", time=0.2)
    page.reload()
    becomes_true(page, ALL_CURVES)
    assert page.evaluate(PLOTTED) == shown  # also what lies ahead


LINES = """async () => {
  const { csvText } = await part("parts/csv.js");
  const { drawCurves, valueAt } = await part("parts/curve.js");
  const long = { name: "long", unit: "m", times: [0, 1, 2, 4], values: [0, 10, null, 40] };
  const short = { name: "short", unit: "m", times: [0, 1], values: [5, 6] };
  const once = { name: "once", unit: "", times: [1.5], values: [7] };
  const held = { name: "held", unit: "", times: [1, 2], values: [3, 4], shape: "steps", slope: 0 };
  const busy = { name: "busy", unit: "s", times: [0, 1, 2], values: [0, 1, 1], slope: 1 };
  const gone = { name: "gone", unit: "", times: [0, 1], values: [8, null], shape: "steps", slope: 0 };
  const points = { name: "points", unit: "", times: [0, 2], values: [1, 9], shape: "points" };
  const over = { ...held, name: "over", until: 3 };
  const moments = [-0.5, 0, 0.5, 1, 1.5, 2, 3, 5];
  const all = [long, short, once, held, busy, gone, points, over];
  const values = Object.fromEntries(all.map((curve) => [curve.name, moments.map((time) => valueAt(curve, time))]));
  const near = [1.4, 1.6, 2].map((time) => valueAt(once, time, 0.2));
  let clip = [];
  const drawn = [];
  const surface = { line() {}, text() {}, within: (x, y, width, height, draw) => (clip = [y, y + height]) && draw() };
  surface.fill = (x, y, width, height) => drawn.push([y, y + height]);
  drawCurves(surface, { x: 0, y: 10, width: 100, height: 50 }, { series: [points], span: { from: 0, to: 4 }, range: [1, 9] });
  const whole = drawn.map(([top, bottom]) => top >= clip[0] && bottom <= clip[1]);
  const noisy = { name: "noisy", unit: "s", times: [0.1 + 0.2, 1.05], values: [0.10123499999999996, 0.050000000000000044] };
  const same = { name: "same", unit: "m", times: [0.3, 1.05], values: [1 / 3, 1e-20] };
  const rounded = csvText([noisy, same]);
  return { values, near, whole, rounded, compared: csvText([long, short]), csv: csvText([long, once, held, busy, gone], 5) };
}"""
"""Values of curves at -0.5, 0, 0.5, 1, 1.5, 2, 3 and 5 s, and those curves as CSV."""


def test_the_value_of_a_curve_is_where_its_line_is_and_nowhere_else(blank: Page) -> None:
    found = blank.evaluate(LINES)
    assert found["values"] == {
        "long": [None, 0, 5, 10, None, None, None, None],
        "short": [None, 5, 5.5, 6, None, None, None, None],
        "once": [None, None, None, None, 7, None, None, None],
        "held": [None, None, None, 3, 3, 4, 4, 4],
        "busy": [None, 0, 0.5, 1, 1, 1, 2, 4],
        "gone": [None, 8, 8, None, None, None, None, None],
        "points": [None, 1, None, None, None, 9, None, None],
        "over": [None, None, None, 3, 3, 4, 4, None],
    }
    assert found["near"] == [7, 7, None]
    assert found["whole"] == [True, True]  # the least and the greatest value
    assert found["rounded"].splitlines()[1:] == ["0.3,0.101235,0.333333333333", "1.05,0.05,1e-20"]
    assert found["compared"].splitlines() == ['"time [s]","long [m]","short [m]"', "0,0,5", "1,10,6", "2,,", "4,40,"]
    assert found["csv"].splitlines()[1:] == ["0,0,,,0,8", "1,10,,3,1,", "1.5,,7,3,1,", "2,,,4,1,", "4,40,,4,3,", "5,,,4,4,"]


EQUAL = """async () => {
  const { drawCurves } = await part("parts/curve.js");
  const curve = (colour, value, more = {}) => ({ name: colour, unit: "", times: [0, 1, 2], values: [0, value, null], colour, ...more });
  const dots = (colour, value) => curve(colour, value, { shape: "points" });
  const series = [curve("a", 1), curve("b", 1), curve("c", 0.5), curve("d", 1), dots("e", 1), dots("f", 1), dots("g", 0.5)];
  const dashed = [curve("h", 0.2, { dash: [6, 3] }), curve("i", 0.2, { dash: [6, 3] })];
  const [lines, moments] = [{}, {}];
  const surface = { text() {}, within: (x, y, width, height, draw) => draw() };
  surface.line = (points, colour, { width, dash } = {}) => width && (lines[colour] = [width, dash]);
  surface.fill = (x, y, width, height, colour) => (moments[colour] ??= []).push(x);
  const box = { x: 0, y: 0, width: 100, height: 50 };
  drawCurves(surface, box, { series: [...series, ...dashed], span: { from: 0, to: 2 }, range: [0, 1] });
  return [lines, moments];
}"""
"""The width and the dashes of each line, and where the moments of the others are drawn, by colour."""


def test_curves_that_are_equal_do_not_hide_each_other(blank: Page) -> None:
    lines, moments = blank.evaluate(EQUAL)
    assert lines == {
        "a": [1.5, []],
        "b": [3, [6, 6]],
        "c": [1.5, []],  # it differs
        "d": [4.5, [6, 12]],
        "h": [1.5, [6, 3]],
        "i": [3, [6, 12]],  # every second dash
    }
    assert moments == {"e": [-1.5, 48.5], "f": [1.5, 51.5], "g": [-1.5, 48.5]}


DAY = """
from actr3d.actr import *

class Sleeper(Model):
    def start(self):
        while True:
            yield 20_000

class Day(ACTR):
    goal = Buffer()
    retrieval = Buffer()
    memory = Memory(retrieval)
    base = DMBaseLevel(memory)
    sleeper = Sleeper()
    def init():
        for name in ("cat", "dog", "cow", "hen"):
            memory.add(name)

day = Day()
day.run(86_400)
"""
SIZE = "async () => [...(await part('timeline/curves.js')).known.events.values()].reduce((sum, { values }) => sum + values.length, 0)"


@pytest.mark.slow
def test_of_a_very_long_run_the_page_keeps_a_bounded_number_of_values(pages: Callable[..., Page], workbench: Served) -> None:
    (workbench.folder / "day.py").write_text(DAY, encoding="utf-8")
    page = pages("day.py")
    page.click("#run")
    shows(page, "#status", "ended")
    chunks = [f"memory: {name} activation over time" for name in ("cat", "dog", "cow", "hen")]
    page.evaluate("async (chunks) => (await part('timeline/curves.js')).plotAll(chunks, true)", chunks)
    until(page, lambda: page.evaluate(SIZE) >= 1_000_000)
    page.wait_for_timeout(1000)
    before = page.evaluate(SIZE)
    assert before < 1_100_000
    page.wait_for_timeout(1000)
    assert page.evaluate(SIZE) == before
    page.evaluate("""async () => {
        const { span, zoom } = await part('timeline/view.js');
        zoom(100 / (span.value.to - span.value.from), 80_000, 0, 86_400);
    }""")
    until(page, lambda: page.evaluate(SIZE) > before + 4 * 9_900)


def test_parts_of_an_activation_of_one_kind_have_different_dashes(blank: Page) -> None:
    parts = ["activation", "base level", "base level 2", "spreading", "spreading 2"]
    dashes = blank.evaluate(
        """async (names) => {
          const { chosen, plotAll, plots } = await part("timeline/curves.js");
          plotAll([...chosen.value], false); // those of other tests
          plotAll(names, true);
          const shown = plots.value.filter(({ group }) => group === "activation over time");
          return shown.flatMap(({ series }) => series.map(({ dash }) => dash ?? []));
        }""",
        [f"memory: cat {part} over time" for part in parts],
    )
    assert dashes == [[], [6, 3], [12, 6], [2, 2], [4, 4]]


TWINS = """
from actr3d.actr import *

class Twin(ACTR):
    goal = Buffer()
    retrieval = Buffer()
    memory = Memory(retrieval, latency=0.1)
    base = DMBaseLevel(memory)
    learning = PMNew(alpha=0.2)
    gain = 1
    def init():
        memory.add("fact 1 2")
        goal.set("step 0")
    def go(goal="step ?n!6"):
        memory.request("fact ?a ?b")
        goal.modify(_1=int(n) + 1)
        self.reward(self.gain)

class Other(Twin):
    gain = -3

class Both(Model):
    left = Twin()
    right = Other()

Both().run(1)
"""
"""Two agents with productions and chunks of the same names; their last conflict is at 0.25 s."""


PLOT_ROW = """async (asked) => {
  const { title = "joints", ...others } = asked ?? {};
  const { drawTimeline } = await part("timeline/draw.js");
  const { drawing } = await part("timeline/canvas.js");
  const texts = [];
  const surface = { fill() {}, line() {}, polygon() {}, within: (x, y, width, height, draw) => draw() };
  surface.text = (text, x, y) => texts.push([y, x, text]);
  const now = { ...drawing(), ...others };
  drawTimeline(surface, now);
  const { y, height, plot } = now.layout.rows.find(({ label }) => label === title);
  const top = y - now.scroll;
  const inside = texts.filter(([at, x]) => at > top + 15 && at < top + height && x < now.column - 40);
  return { top, height, curves: plot.series.length, texts: inside.map(([, , text]) => text) };
}"""
"""The row of a plot: where it is, how many curves it has, and the texts below its heading. `others` are other values of the scene."""


COLOURS = """async () => {
  const { drawTimeline } = await part("timeline/draw.js");
  const { drawing } = await part("timeline/canvas.js");
  const { plot, plots } = await part("timeline/curves.js");
  const drawn = () => {
    const lines = [];
    const surface = { fill() {}, text() {}, polygon() {}, within: (x, y, width, height, draw) => draw() };
    surface.line = (points, name) => lines.push(name);
    drawTimeline(surface, drawing());
    const shown = plots.value.flatMap(({ series }) => series.map(({ name, colour }) => [name, colour]));
    return [Object.fromEntries(shown), [...new Set(shown.map(([, colour]) => colour))].every((colour) => lines.includes(colour))];
  };
  for (const name of ["right.go learned learning", "left.go utility", "left.go learned learning", "right.go utility"]) plot(name, true);
  const both = drawn();
  for (const name of ["left.go utility", "left.go learned learning"]) plot(name, false);
  return [both, drawn()];
}"""
"""The colours of curves of two productions, and whether they are drawn; and the same after the curves of one production were removed."""


BANDS = """async () => {
  const { drawTimeline } = await part("timeline/draw.js");
  const { drawing } = await part("timeline/canvas.js");
  const { rows } = drawing(true).layout;
  const found = {};
  const surface = { line() {}, text() {}, polygon() {}, within: (x, y, width, height, draw) => draw() };
  surface.fill = (x, y, width, height, name) => {
    const row = rows.find((row) => row.lane?.group === "productions" && y > row.y && y < row.y + row.height);
    if (row) found[row.label] = [...new Set([...(found[row.label] ?? []), name])];
  };
  drawTimeline(surface, drawing(true));
  return found;
}"""
"""The colours of the bands of each agent's productions."""


@pytest.mark.slow
def test_each_agent_has_its_own_curves_and_the_pointer_shows_them(pages: Callable[..., Page], workbench: Served, tmp_path: Path) -> None:
    (workbench.folder / "twins.py").write_text(TWINS, encoding="utf-8")
    page = pages("twins.py", height=1000)
    page.evaluate("localStorage.setItem('actr3d.timeline height', '620')")
    page.reload()
    page.get_by_role("button", name="Run", exact=True).click()
    becomes_true(page, "async () => (await part('store.js')).state.value?.status === 'ended'")
    curves = page.evaluate(
        """async () => {
          const { events } = await (await part("server.js")).request({ type: "curves" });
          return Object.fromEntries(Object.entries(events).map(([name, { values }]) => [name, values.at(-1)]));
        }"""
    )
    assert (curves["left.go utility"], curves["right.go utility"]) == pytest.approx((0.638704, -2.050576))
    assert (curves["left.go learned learning"], curves["right.go learned learning"]) == pytest.approx((0.7009632, -2.2504608))
    assert {f"{one}.memory: fact 1 2 {part}" for one in ("left", "right") for part in ("activation", "base level")} < set(curves)
    assert not {"go utility", "go learned learning", "fact 1 2 activation"} & set(curves)
    page.evaluate(
        """async () => {
          const { plot } = await part("timeline/curves.js");
          for (const name of ["left.goal full", "left.memory busy", "left.go utility"]) plot(name, true);
          const { plots } = await part("timeline/curves.js");
          const isThere = (title) => plots.value.find((plot) => plot.title === title)?.series.every(({ values }) => values.length > 0);
          while (!["time full", "time busy", "utility"].every(isThere)) await new Promise((done) => setTimeout(done, 20));
        }"""
    )
    tips = {share: "\n".join(told(page, share, 2 * LANE)) for share in (0.14, 0.16, 0.4, 0.7)}  # of 1.25 s
    for text in tips.values():
        full = re.search(r"time full at ([\d.]+) s\s+left\.goal full ([\d.]+) s", text)
        assert full is not None, text
        assert float(full[2]) == pytest.approx(float(full[1]), abs=0.01)
    assert re.search(r"left\.go utility 0\.\d+", tips[0.16])
    assert "left.go utility –\n" in tips[0.14]  # between two conflicts it is not known
    assert "left.go utility –\n" in tips[0.4]
    page.evaluate(
        """async () => {
          const { plotAll } = await part("timeline/curves.js");
          plotAll(["activation", "base level"].map((part) => `left.memory: fact 1 2 ${part} over time`), true);
        }"""
    )
    fact = {"title": "fact 1 2 over time"}
    is_there = "async () => (await part('timeline/curves.js')).plots.value.some(({ title }) => title === 'fact 1 2 over time')"
    becomes_true(page, is_there)
    until(page, lambda: "–" not in page.evaluate(PLOT_ROW, fact)["texts"])
    named = page.evaluate(PLOT_ROW, fact)["texts"]
    assert named[::2] == ["activation", "base level"]
    assert named[1] == named[3]  # with a base level only
    (both, drawn), (one, still_drawn) = page.evaluate(COLOURS)
    left, right = both["left.go utility"], both["right.go utility"]
    assert left != right
    assert (both["left.go learned learning"], both["right.go learned learning"]) == (left, right)
    assert (one["right.go utility"], one["right.go learned learning"]) == (right, right)
    assert drawn
    assert still_drawn
    page.evaluate("async () => (await part('timeline/curves.js')).plot('left.go utility', true)")
    for reloaded in (False, True):
        if reloaded:
            page.reload()
        becomes_true(page, ALL_CURVES)
        shown = {curve["name"]: curve["colour"] for _, series in page.evaluate(PLOTTED) for curve in series}
        assert (shown["left.go utility"], shown["right.go utility"]) == (left, right)
        assert page.evaluate(BANDS) == {"left": [left], "right": [right]}
    page.get_by_role("button", name="Save a picture").click()
    with page.expect_download() as taken:
        page.get_by_role("dialog").get_by_role("button", name="CSV").click()
    rows = list(csv.DictReader(Path(taken.value.path()).read_text().splitlines()))
    for row in rows:
        assert float(row["left.goal full [s]"]) == pytest.approx(float(row["time [s]"]))
    assert float(rows[-1]["time [s]"]) == 1
    assert rows[-1]["left.go utility"] == ""
    assert 0.1 < float(rows[-1]["left.memory busy [s]"]) < 0.5


def test_plots_are_resized_and_name_every_curve_with_its_value_at_the_playhead(pages: Callable[..., Page]) -> None:
    page = pages(height=1000)
    page.evaluate("localStorage.setItem('actr3d.timeline height', '620')")
    page.reload()
    shows(page, "#status", "at its start")
    page.evaluate(
        """async () => {
          await (await part("server.js")).request({ type: "until", time: 0.5 });
          const { names, plot } = await part("timeline/curves.js");
          while (!names.value.some(({ group }) => group === "joint")) await new Promise((done) => setTimeout(done, 20));
          names.value.filter(({ name }) => name.endsWith("_yaw")).slice(0, 5).forEach(({ name }) => plot(name, true));
        }"""
    )
    until(page, lambda: page.evaluate(PLOT_ROW)["texts"][1:] and "–" not in page.evaluate(PLOT_ROW)["texts"])
    row = page.evaluate(PLOT_ROW)
    speeds: list[list[str]] = []
    for time in ("0.50", "0.00"):
        page.evaluate("async (time) => (await part('timeline/seek.js')).seek(time)", float(time))
        when(page, time)
        speeds.append(page.evaluate(PLOT_ROW, {"title": "speed"})["texts"])
    for running in (True, False):  # while the run is active, the newest values are not known yet
        later = {"title": "speed", "present": 0.7, "end": 0.7, "running": running}
        assert page.evaluate(PLOT_ROW, later)["texts"] == ["walker", "1.20" if running else "–"]
    assert speeds == [["walker", "1.20"], ["walker", "0.000"]]
    assert (row["curves"], row["height"], len(row["texts"])) == (5, 20 + 5 * 13, 10)  # each name and its value
    page.locator("#status").click()
    page.keyboard.press("Shift+h")
    lower = page.evaluate(PLOT_ROW)
    assert (lower["height"], len(lower["texts"]), lower["texts"][-1]) == (72, 3 * 2 + 1, "and 2 more")
    area = box(page)
    page.mouse.move(area["x"] + 20, area["y"] + lower["top"] + lower["height"])
    expect(page.locator("#timeline")).to_have_attribute("data-part", "height")
    page.mouse.down()
    page.mouse.move(area["x"] + 20, area["y"] + lower["top"] + lower["height"] + 60)
    page.mouse.up()
    assert page.evaluate(PLOT_ROW)["height"] == 132
    assert "0.00 s" in page.locator("#time").inner_text()  # it did not go elsewhere
    page.reload()
    until(page, lambda: page.evaluate("async () => (await part('timeline/curves.js')).plots.value.length > 0"))
    assert page.evaluate(PLOT_ROW)["height"] == 132


TIMES = """async () => {
  const [{ timeText }, { timeStep, ticks, digitsOf }] = [await part("parts/units.js"), await part("parts/ticks.js")];
  const axis = (span) => {
    const step = timeStep(span, 6);
    return ticks(span.from, span.to, step).map((time) => timeText(time, digitsOf(step), span.to));
  };
  const times = [0, 12.345, 3599.99, 3600, 4512.3, 3659.999, 86_461.5];
  return [times.map((time) => timeText(time)), axis({ from: 0, to: 5000 }), axis({ from: 3590, to: 3602 }), axis({ from: 0, to: 3000 })];
}"""


NAMED_COLUMN = """async () => {
  const { chosenColumn } = await part("timeline/rows.js");
  const { drawTimeline } = await part("timeline/draw.js");
  const { drawing } = await part("timeline/canvas.js");
  const { widthOf } = await part("parts/surface.js");
  chosenColumn.value = 110;
  const texts = [];
  const surface = { fill() {}, line() {}, polygon() {}, within: (x, y, width, height, draw) => draw() };
  surface.text = (text, x, y, name, style = {}) => x < 30 && style.anchor === undefined && texts.push([text, x + widthOf(text, style)]);
  drawTimeline(surface, drawing());
  return texts;
}"""
"""Returns the names of rows and curves in a narrow column, each with the place of its end [px]."""
NAME_AT = """async (name) => {
  const { layout, scroll } = await part("timeline/rows.js");
  return layout("").rows.find(({ label }) => label === name).y - scroll.value + 8;
}"""
"""Returns the height at which the name of a row is [px]."""


def test_a_name_that_is_too_long_for_its_column_has_its_beginning_and_end_and_is_whole_at_the_pointer(
    pages: Callable[..., Page], workbench: Served
) -> None:
    long = "intention_of_the_walker_at_the_doorway"
    file = workbench.folder / "long_names.py"
    source = (MODELS / "doorway.py").read_text(encoding="utf-8")
    file.write_text(re.sub(r"\bgoal\b", long, source), encoding="utf-8")
    page = pages("long_names.py", width=1280, height=800)
    shows(page, "#status", "at its start")
    say(page, type="until", time=0.2)
    becomes_true(page, ALL_CURVES)
    drawn(page)
    names = page.evaluate(NAMED_COLUMN)
    lane = next(text for text, _ in names if text.startswith("int"))
    assert re.fullmatch(r"intent\w*…\w*doorway", lane)
    assert len(lane) > 12
    assert all(end <= 110 for text, end in names if "…" in text)

    page.evaluate("async () => void ((await part('timeline/rows.js')).chosenColumn.value = 0)")
    drawn(page)
    tip = page.locator(".timeline-tip")
    for label, text in ((long, long), ("clearance", "clearance at 0.20 s")):
        page.mouse.move(box(page)["x"] + 40, box(page)["y"] + page.evaluate(NAME_AT, label))
        expect(tip).to_contain_text(text)
    expect(tip).to_contain_text("clearance left")  # each curve has its whole name, and its value at the playhead
    file.unlink()


def test_times_of_an_hour_or_more_are_in_hours_minutes_and_seconds(blank: Page) -> None:
    texts, long, near, short = blank.evaluate(TIMES)
    assert texts == ["0.00 s", "12.35 s", "3599.99 s", "1:00:00.00", "1:15:12.30", "1:01:00.00", "24:01:01.50"]
    assert long == ["0:00:00", "0:15:00", "0:30:00", "0:45:00", "1:00:00", "1:15:00"]
    assert near == ["0:59:50", "0:59:52", "0:59:54", "0:59:56", "0:59:58", "1:00:00", "1:00:02"]
    assert short == ["0 s", "500 s", "1000 s", "1500 s", "2000 s", "2500 s", "3000 s"]


READ = """async (texts) => {
  const { timeOfText } = await part("parts/units.js");
  return texts.map(timeOfText).map((time) => (Number.isNaN(time) ? null : time));
}"""


def test_a_time_is_read_in_the_forms_in_which_it_is_shown(blank: Page) -> None:
    times = {
        "1.5": 1.5,
        " 12.35 s ": 12.35,
        "1:15:12.3": 4512.3,
        "24:01:01.50": 86_461.5,
        "0:59:59": 3599,
        "5:07": 307,
        "75:00": 4500,
        "1e3": 1000,
        "-1": -1,
    }
    assert blank.evaluate(READ, list(times)) == list(times.values())
    assert blank.evaluate(READ, wrong := ["", "soon", "1:75:00", "1:5:00", "1:2:3:4", ":10", "1:00:60"]) == [None] * len(wrong)


LONG = """from actr3d.actr import *

class Long(ACTR):
    goal = Buffer()
    production_time = 1000
    def init():
        goal.set("step")
    def step(goal="step"):
        pass

Long().run(7200)
"""
AXIS_TIMES = """async () => {
  const [{ drawTimeline }, { drawing }] = [await part("timeline/draw.js"), await part("timeline/canvas.js")];
  const texts = [];
  const known = { text: (text) => texts.push(text), within: (...values) => values.at(-1)() };
  const surface = new Proxy({}, { get: (_, name) => known[name] ?? (() => null) });
  drawTimeline(surface, drawing());
  return texts.filter((text) => /^[0-9]/.test(text));
}"""
LOOK = """async (to) => {
  const { span, mode } = await part("timeline/view.js");
  mode.value = "free";
  span.value = { from: 0, to };
}"""


@pytest.mark.slow
def test_all_times_of_a_run_of_hours_look_alike_at_any_moment_of_it(pages: Callable[..., Page], workbench: Served) -> None:
    (workbench.folder / "long.py").write_text(LONG, encoding="utf-8")
    page = pages("long.py", tab="productions")
    shows(page, "#status", "at its start")
    page.click("#run")
    shows(page, "#status", "ended")
    page.evaluate("async () => (await part('timeline/seek.js')).seek(1500)")
    shows(page, "#time", r"t = 0:25:00\.00$")
    expect(page.locator(".timeline-now")).to_have_text("0:25:00.00")
    expect(page.locator("#timeline")).to_have_attribute("aria-valuetext", "0:25:00.00 of 2:00:00.00")
    expect(page.locator("#events .time").first).to_have_text(re.compile(r"^0:\d\d:\d\d\.000$"))
    expect(page.locator("#events").get_by_text("Time", exact=True)).to_be_visible()
    page.evaluate(LOOK, 3000)
    times = page.evaluate(AXIS_TIMES)
    assert len(times) > 2
    assert [text for text in times if not re.fullmatch(r"0:\d\d:\d\d", text)] == []
    assert any(re.search(r"\b0:\d\d:\d\d\.000", tip) for tip in told(page, 0.25))
    moment = page.get_by_label("Explain the time")
    moment.fill("16:40")
    moment.press("Enter")
    expect(moment).to_have_value("0:16:40")
    page.keyboard.press("Escape")
    page.locator("#time").click()
    page.get_by_label("Time, from 0 to 2:00:00.00").fill("75:00")
    page.get_by_role("button", name="Go there").click()
    shows(page, "#time", r"t = 1:15:00\.00$")


@pytest.mark.slow
def test_a_link_has_a_time_in_each_form_in_which_times_are_read(pages: Callable[..., Page], workbench: Served) -> None:
    (workbench.folder / "long.py").write_text(LONG, encoding="utf-8")
    page = pages("long.py")
    shows(page, "#status", "at its start")
    page.click("#run")
    shows(page, "#status", "ended")
    name = page.evaluate("async () => (await part('store.js')).shownRecording.value")
    page.goto(f"{workbench.url}/?run={name}&t=1:15:00")
    shows(page, "#time", r"t = 1:15:00\.00$")
    page.goto(f"{workbench.url}/?run={name}&t=99999")
    expect(page.get_by_text("The link leads to 27:46:39.00; this run has only reached 2:00:00.00.").first).to_be_visible()
    expect(page.get_by_role("button", name="Go there")).to_have_count(0)
    shows(page, "#time", r"t = 1:15:00\.00$")


def test_fit_shows_what_happened_without_a_quiet_end_and_again_all_of_the_run(pages: Callable[..., Page]) -> None:
    page = pages("counting.py")
    shows(page, "#status", "at its start")
    say(page, type="until", time=30)
    shows(page, "#status", "30|ended")
    shown = "async () => (await part('timeline/view.js')).span.value.to"
    becomes_true(page, "async () => (await part('run_status.js')).lastEvent() > 0.1 && (await part('timeline/seek.js')).furthest.value > 0")
    last = page.evaluate("async () => (await part('run_status.js')).lastEvent()")
    newest = page.evaluate("async () => (await part('timeline/seek.js')).furthest.value")
    assert last < 0.5 * newest
    until(page, lambda: page.evaluate(shown) > newest)
    page.get_by_role("button", name="Fit").click()
    assert last < page.evaluate(shown) < 1.3 * last
    page.get_by_role("button", name="Fit").click()
    assert page.evaluate(shown) > newest
    page.get_by_role("button", name="Fit").click()
    page.evaluate("async () => (await part('timeline/seek.js')).seek(0)")
    shows(page, "#time", r"0\.00 s")
    assert page.evaluate(shown) < 1.3 * last  # a click does not move the axis


@pytest.mark.slow
def test_on_the_way_to_another_time_steps_back_are_counted_from_where_it_goes_and_stop_leaves_it_where_it_is(
    pages: Callable[..., Page], workbench: Served
) -> None:
    (workbench.folder / "slow_way.py").write_text(SLOW_PROGRAM.replace("0.01", "0.02"), encoding="utf-8")
    page = pages("slow_way.py")
    page.click("#run")
    shows(page, "#status", "ended")
    say(page, type="seek", time=5.0)
    shows(page, "#status", "going to 5 s")
    page.locator("#timeline").focus()
    page.keyboard.press("ArrowLeft")
    page.keyboard.press("ArrowLeft")
    shows(page, "#status", "paused")
    shows(page, "#time", "t = 4.98 s")
    say(page, type="seek", time=4.5)
    shows(page, "#status", "going to 4.5 s")
    page.click("#stop")
    shows(page, "#status", "paused: stopped while going to 4.5 s")
    page.keyboard.press("End")
    shows(page, "#time", "t = 6.02 s")
