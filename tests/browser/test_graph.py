"""The graph of an agent: what its productions read and write, and what flows at this moment."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

from playwright.sync_api import Locator, Page, expect

from tests.helpers.page import open_tab, shows
from tests.helpers.workbench_server import Served


def edges(page: Page, kind: str, more: str = "") -> Locator:
    return page.locator(f".graph .edge.{kind}{more}")


def places(page: Page) -> dict[str, Any]:
    """Returns where each node is."""
    return page.evaluate(
        "() => Object.fromEntries([...document.querySelectorAll('.graph .node')].map((one) => [one.dataset.node, one.style.cssText]))"
    )


def test_the_graph_shows_what_is_read_written_asked_and_filled(pages: Callable[..., Page]) -> None:
    page = pages("counting.py", tab="graph")
    shows(page, ".graph", "There is nothing to show yet. Press Run")
    # Of a size that changes another one the browser reports that it takes two pictures: no fault of the page.
    page.evaluate("dispatchEvent(new ErrorEvent('error', { message: 'ResizeObserver loop completed with undelivered notifications.' }))")
    expect(page.locator(".toast")).to_have_count(0)
    page.click("#cycle")
    shows(page, "#status", "start_counting fired")
    nodes = page.get_by_role("group", name="Graph of top").get_by_role("button")
    expect(nodes).to_have_count(6)
    before = places(page)
    goal = nodes.filter(has_text="goal")
    expect(goal).to_contain_text("task:count number:2")
    expect(nodes.filter(has_text="start_counting")).to_have_class(re.compile("fired"))
    expect(edges(page, "writes", ".now")).to_have_count(1)
    expect(edges(page, "asks", ".now")).to_have_count(1)
    expect(nodes.filter(has_text="memory")).to_contain_text("busy")
    expect(edges(page, "reads")).to_have_count(4)
    page.click("#step")
    shows(page, "#time", "0.06 s")
    expect(edges(page, "writes", ".now")).to_have_count(0)
    page.click("#cycle")
    shows(page, "#status", "count_on fired")
    expect(edges(page, "fills")).to_have_count(1)
    assert places(page) == before
    goal.click()
    expect(page.locator(".graph-text")).to_have_text(
        "goal is read by count_on, start_counting, stop_counting; is written by count_on, start_counting"
    )
    page.keyboard.press("ArrowRight")
    expect(nodes.filter(has_text="count_on")).to_be_focused()
    expect(page.locator(".graph-text")).to_contain_text("count_on reads goal, retrieval; writes goal; asks memory")
    page.get_by_role("button", name="Why", exact=True).click()
    expect(page.get_by_role("tab", name="Productions")).to_have_attribute("aria-selected", "true")
    expect(page.locator("#why-text")).to_contain_text("count_on")
    page.click("#back")
    shows(page, "#status", "went to this time")
    open_tab(page, "Graph")
    expect(edges(page, "fills")).to_have_count(1)


TWINS = """
from actr3d.actr import *

class Twin(ACTR):
    goal = Buffer()
    retrieval = Buffer()
    memory = Memory(retrieval, latency=0.1)
    def init():
        memory.add("fact 1 2")
        goal.set("step 0")
    def go(goal="step ?n!6"):
        memory.request("fact ?a ?b")
        goal.modify(_1=int(n) + 1)

class Both(Model):
    left = Twin()
    right = Twin()

Both().run(1)
"""
"""Two agents that do the same at the same moments."""


def test_each_of_two_agents_has_its_own_edges(pages: Callable[..., Page], workbench: Served) -> None:
    (workbench.folder / "twins.py").write_text(TWINS, encoding="utf-8")
    page = pages("twins.py", tab="graph")
    page.click("#run")
    shows(page, "#status", "ended")
    for agent in ("left", "right"):
        graph = page.get_by_role("region", name=agent, exact=True)
        for kind, count in {"reads": 1, "writes": 1, "asks": 1, "fills": 1}.items():
            expect(graph.locator(f".edge.{kind}")).to_have_count(count)


def test_the_graph_is_saved_as_a_picture_of_what_it_shows(pages: Callable[..., Page], tmp_path: Path) -> None:
    page = pages("counting.py", tab="graph")
    page.click("#cycle")
    shows(page, "#status", "start_counting fired")
    expect(page.locator(".graph .edge")).to_have_count(6)

    def saved(kind: str) -> Path:
        with page.expect_download() as download:
            page.locator(".graph-head").get_by_role("button", name=kind).click()
        path = tmp_path / download.value.suggested_filename
        download.value.save_as(path)
        return path

    svg = saved("SVG")
    assert re.fullmatch(r"counting_seed_\d+_graph_at_0\.05_s\.svg", svg.name)
    drawing = ElementTree.parse(svg).getroot()
    words = [node.text or "" for node in drawing.iter("{http://www.w3.org/2000/svg}text")]
    assert words[0].startswith("Graph at 0.05 s: counting.py, run ")
    assert {"Modules", "Buffers", "Productions", "goal", "memory", "busy", "start_counting", "a production reads a buffer"} <= set(words)
    lines = list(drawing.iter("{http://www.w3.org/2000/svg}path"))
    assert len([line for line in lines if line.get("d", "").count("L") == 24]) == page.locator(".graph .edge").count()
    png = saved("PNG").read_bytes()
    assert png.startswith(b"\x89PNG\r\n")
    assert int.from_bytes(png[16:20]) > 1000
