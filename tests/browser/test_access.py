"""Every panel and dialog can be read in both themes, and used without a mouse: contrast, names, reach by keyboard, all rules of axe."""

from __future__ import annotations

from collections.abc import Callable
from importlib import resources
from pathlib import Path
from typing import Any

import pytest
from playwright.sync_api import Page, expect

from tests.helpers.page import open_tab, say, shows
from tests.helpers.workbench_server import Served

LOOK = (Path(__file__).parent / "access.js").read_text(encoding="utf-8")
AXE = (resources.files("axe_playwright_python") / "axe.min.js").read_text(encoding="utf-8")
RUN_AXE = """async (parts) => {
  const include = parts.filter((part) => document.querySelector(part)).map((part) => [part]);
  if (parts.length && !include.length) throw new Error(`none of these is on the page: ${parts}`);
  const where = parts.length ? { include } : document;
  const rules = { "color-contrast": { enabled: false } }; // access.js computes it
  const { violations } = await axe.run(where, { iframes: false, preload: false, resultTypes: ["violations"], rules });
  return violations.flatMap(({ id, nodes }) => nodes.map(({ html }) => `${id}: ${html.slice(0, 160)}`));
}"""


IN_THEME = """(theme) => (document.documentElement.dataset.theme ?? theme) === theme
  && !document.getAnimations().some((one) => one instanceof CSSTransition)"""


TABS = ("[role=tablist]", "[role=tabpanel]")
DIALOG = ("dialog[open]",)
THEMES: tuple[Any, ...] = ("dark", "light")


def problems_of(page: Page, *parts: str, axe: bool = True) -> list[str]:
    """Returns what of a page cannot be read, named or reached in either theme, once what has just changed lights up no more.

    The themes differ in colours only, whose contrast `access.js` computes in both. Axe, which takes nearly all of the time, looks at one
    theme, and at all but contrast.
    Of a page that was looked at before, `parts` are what is new: axe looks at these only; not at all with `axe=False`.
    """
    expect(page.locator(".changed")).to_have_count(0)
    found: list[str] = []
    for theme in THEMES:
        page.emulate_media(color_scheme=theme)
        page.wait_for_function(IN_THEME, arg=theme)
        found += [f"{theme}: {problem}" for problem in page.evaluate(LOOK)]
    if not axe:
        return found
    if page.evaluate("() => !('axe' in window)"):
        page.evaluate(AXE)
    return [*found, *page.evaluate(RUN_AXE, list(parts))]


TEXTS_AHEAD = """async () => {
  const context = document.createElement("canvas").getContext("2d", { willReadFrequently: true });
  const veil = getComputedStyle(document.querySelector(".timeline-veil"));
  const { seriesColour, COLOUR_COUNT } = await part("parts/curve.js");
  const probe = document.querySelector(".timeline-veil").appendChild(document.createElement("i"));
  function colourNamed(name) {
    probe.style.color = `var(--${name})`;
    return getComputedStyle(probe).color;
  }
  function luminance(layers) {
    context.clearRect(0, 0, 1, 1);
    for (const [colour, alpha] of layers) {
      context.globalAlpha = alpha;
      context.fillStyle = colour;
      context.fillRect(0, 0, 1, 1);
    }
    const linear = (part) => (part <= 0.04045 ? part / 12.92 : ((part + 0.055) / 1.055) ** 2.4);
    const [r, g, b] = [...context.getImageData(0, 0, 1, 1).data].map((part) => linear(part / 255));
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  }
  const over = [veil.backgroundColor, Number(veil.opacity)];
  const panel = [colourNamed("panel"), 1];
  const bands = [[panel], ...Array.from({ length: COLOUR_COUNT }, (_, n) => [panel, [colourNamed(seriesColour(n)), 0.26]])];
  return Math.min(...bands.map((back) => {
    const [dark, light] = [luminance([...back, over]), luminance([[colourNamed("text"), 1], over])].sort((one, other) => one - other);
    return (light + 0.05) / (dark + 0.05);
  }));
}"""
"""Returns the smallest contrast of a text on the timeline or on one of its bands, under what covers the time after the present moment."""


RETURNED = """    return Simulation(scene, {"walker": agent})
"""
MEASURED = """    from actr3d.experiment.aperture import Passage

    simulation = Simulation(scene, {"walker": agent})
    simulation.measure(Passage("walker"))
    return simulation
"""


@pytest.mark.parametrize("axe", [False, pytest.param(True, marks=pytest.mark.slow)])
def test_all_can_be_read_named_and_reached(pages: Callable[..., Page], workbench: Served, axe: bool) -> None:
    """Without axe, which takes most of the time, all but the first look is at contrast, names and reach by keyboard."""
    text = (workbench.folder / "doorway.py").read_text(encoding="utf-8")
    assert RETURNED in text
    (workbench.folder / "measured.py").write_text(text.replace(RETURNED, MEASURED), encoding="utf-8")
    page = pages("measured.py")
    shows(page, "#status", "at its start")
    problems: list[str] = []

    def look(where: str, *parts: str) -> None:
        problems.extend(f"{where}: {problem}" for problem in problems_of(page, *parts, axe=axe or where == "start"))

    look("start")
    page.click("#run")
    shows(page, "#status", "ended")
    for title in ("Buffers", "Productions", "Memory", "Eye", "Graph", "Parameters", "Editor", "Runs", "Messages"):
        open_tab(page, title)
        if title == "Buffers":
            expect(page.get_by_role("region", name="Result")).to_be_visible()
        if title == "Productions":
            expect(page.locator("#why-text")).to_contain_text("match")
            for view in ("Conflict set", "Retrievals"):
                page.get_by_role("tab", name=view).click()
                look(view, *TABS)
        if title == "Graph":
            page.get_by_role("group", name="Graph of").get_by_role("button").first.click()
            expect(page.locator(".graph-text")).to_be_visible()
        if title == "Eye":
            page.get_by_role("button", name="Edges").click()
        if title == "Editor":
            expect(page.locator(".cm-content")).to_be_visible()
        if title == "Runs":
            page.locator(".runs-table tbody tr:not(.space)").first.click()
            expect(page.get_by_role("toolbar", name="The chosen run")).to_be_visible()
        look(title, *(() if title == "Buffers" else TABS))
    page.keyboard.press("Escape")
    page.get_by_role("button", name="Arrange: Panels").click()
    look("Arrange")
    page.keyboard.press("Escape")
    for button in ("All commands", "Help", "Curves …"):
        page.get_by_role("button", name=button, exact=True).click()
        expect(page.get_by_role("dialog")).to_be_visible()
        look(button, *DIALOG)
        page.keyboard.press("Escape")
        expect(page.get_by_role("dialog")).to_have_count(0)
    assert problems == []


def test_what_comes_after_the_present_moment_can_be_read_in_both_themes(pages: Callable[..., Page]) -> None:
    page = pages("doorway.py", tab="productions")
    shows(page, "#status", "at its start")
    say(page, type="until", time=2)
    shows(page, "#time", r"t = 2\.00 s")
    page.evaluate("async () => void (await (await part('timeline/seek.js')).seek(0.3))")
    shows(page, "#time", r"t = 0\.30 s")
    expect(page.locator("#events .fire.ahead").first).to_be_visible()
    for theme in THEMES:
        page.emulate_media(color_scheme=theme)
        page.wait_for_function(IN_THEME, arg=theme)
        assert page.evaluate(LOOK) == [], theme
        assert page.evaluate(TEXTS_AHEAD) >= 4.5, theme
    colour = "(line) => [getComputedStyle(line).color, getComputedStyle(line).fontStyle]"
    ahead, before = (page.locator(f"#events tr.fire{one} .what b").first for one in (".ahead", ":not(.ahead)"))
    assert ahead.evaluate(colour) != before.evaluate(colour)


@pytest.mark.slow
def test_what_asks_and_compares_can_be_read_named_and_reached(pages: Callable[..., Page], workbench: Served) -> None:
    file = workbench.folder / "asks.py"
    file.write_text("from actr3d.actr import *\n\n\nclass Agent(ACTR):\n    goal = Buffer()\n", encoding="utf-8")
    page = pages("doorway.py")
    problems: list[str] = []

    def look(where: str, *parts: str) -> None:
        problems.extend(f"{where}: {problem}" for problem in problems_of(page, *parts))

    for width in ("60", "80"):
        shows(page, "#status", "at its start")
        page.locator("#aperture").fill(width)
        page.click("#run")
        shows(page, "#status", "ended")
        page.click("#restart")
    shows(page, "#status", "at its start")
    page.click("#until")
    look("Run until", *DIALOG)
    page.keyboard.press("Escape")
    open_tab(page, "Editor")
    page.get_by_label("File", exact=True).select_option(file.name)
    code = page.locator(".code .cm-content")
    expect(code).to_contain_text("Agent")
    code.focus()
    page.keyboard.press("Control+End")
    page.keyboard.insert_text("x = (1\n# said\n@dec\ndef on(goal='a:?b'): return 2.5\n")
    shows(page, ".problems", "1 error")
    look("errors in the text", *TABS)
    page.keyboard.press("Control+f")
    expect(page.locator(".cm-search [name=search]")).to_be_focused()
    page.keyboard.insert_text("goal")
    look("search in the text", *TABS)
    page.keyboard.press("Escape")
    file.write_text("from actr3d.actr import *\n# theirs\n", encoding="utf-8")
    page.keyboard.press("Control+s")
    expect(page.get_by_role("group", name="Conflict")).to_be_visible()
    look("conflict", *TABS)
    page.get_by_role("button", name="Keep editing").click()
    look("strip")
    open_tab(page, "Runs")
    rows = page.locator(".runs-table tbody tr:not(.space)")
    for first, second in ((0, 1), (1, 2)):  # a run that has not begun with one that has ended, and two that have
        rows.nth(first).click()
        rows.nth(second).click(modifiers=["Control"])
        page.get_by_role("button", name="Compare", exact=True).click()
        expect(page.locator("dialog.compare .plot")).to_have_count(3)
        expect(page.locator("dialog.compare tr.here")).to_have_count(1)
        look(f"Compare {first} and {second}", *DIALOG)
        page.keyboard.press("Escape")
    assert problems == []


def test_by_keyboard_alone_one_gets_everywhere_and_sees_where_one_is(page: Page) -> None:
    shows(page, "#status", "at its start")
    page.locator("body").press("Tab")
    reached: list[str] = []
    for _ in range(80):
        told = page.evaluate(
            """() => {
              const at = document.activeElement;
              if (!at || at === document.body) return null;
              if (at.tagName === "IFRAME") return { name: "frame", seen: true };
              const { outlineStyle, backgroundColor } = getComputedStyle(at);
              const name = at.id || at.getAttribute("aria-label") || at.textContent.trim() || at.labels?.[0]?.textContent || at.tagName;
              return { name, seen: outlineStyle !== "none" || at.classList.contains("splitter") };
            }"""
        )
        if told is None:
            break
        assert told["seen"], f"the focus is not seen at {told['name']}"
        reached.append(told["name"])
        if told["name"] == "frame":  # what is in there is viser's
            page.locator("#scene select").focus()
        else:
            page.keyboard.press("Tab")
    for name in ("run", "step", "until", "aperture", "tab-buffers", "Width of the panels", "Height of the timeline", "timeline"):
        assert name in reached, reached


def test_with_forced_colours_one_sees_what_is_chosen_and_where_one_is(pages: Callable[..., Page]) -> None:
    page = pages(tab="productions")
    shows(page, "#status", "at its start")
    say(page, type="until", time=0.5)
    shows(page, "#time", r"t = 0\.50 s")
    page.get_by_role("group", name="Firing trace").press("End")
    page.emulate_media(forced_colors="active")
    back = "(at) => getComputedStyle(at).backgroundColor.match(/\\d+/g).slice(0, 3).join()"  # forced ones keep their opacity
    for kind, state in (
        ("[role=tab]", "[aria-selected=true]"),
        (".timeline button", "[aria-pressed=true]"),
        ("#events tr td", ".chosen td"),
        (".production-names li", ".chosen"),
    ):
        chosen, other = page.locator(f"{kind}:is({state})").first, page.locator(f"{kind}:not({state})").last
        assert chosen.evaluate(back) != other.evaluate(back), kind
    border = page.get_by_role("separator", name="Width of the panels")
    before = border.evaluate(back)
    border.focus()
    assert border.evaluate(back) != before
    page.emulate_media(forced_colors="none")


SPOKEN = """() => {
  window.spoken = {};
  const live = "[role=status], [role=alert], [role=log], [aria-live], output";
  const note = ({ target }) => {
    const region = (target.closest ? target : target.parentElement).closest(live);
    if (!region?.textContent.trim() || region.ariaLive === "off") return;
    (window.spoken[region.id || region.className] ??= new Set()).add(region.textContent);
  };
  new MutationObserver((changes) => changes.forEach(note)).observe(document.body, { subtree: true, childList: true, characterData: true });
}"""
"""Collects what a screen reader speaks of changes."""


def test_a_screen_reader_hears_the_chosen_row_and_of_a_run_that_it_goes_on(pages: Callable[..., Page]) -> None:
    page = pages(tab="productions", paced=True)
    shows(page, "#status", "at its start")
    page.evaluate(SPOKEN)
    page.click("#run")
    shows(page, "#time", r"t = (0\.[5-9]|[1-9])")
    page.click("#run")
    shows(page, "#status", "paused")
    spoken = page.evaluate("Object.entries(window.spoken).map(([where, texts]) => [where, [...texts]])")
    assert [where for where, texts in spoken if len(texts) > 3] == [], spoken
    rows = page.get_by_role("group", name="Firing trace")
    for number, key in enumerate(("Home", "ArrowDown")):
        rows.press(key)
        expect(rows).to_have_attribute("aria-activedescendant", f"events-{number}")
        expect(page.locator(f"#events-{number}[aria-rowindex='{number + 2}']")).to_have_attribute("aria-selected", "true")
    expect(page.locator("#connection[role=status]")).to_have_text("connected")
