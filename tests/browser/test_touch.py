"""The page on a tablet: fingers do what a mouse does, and nothing is shown only at the pointer."""

from __future__ import annotations

from typing import Any

from playwright.sync_api import Browser, Locator, Page, expect

from tests.helpers.page import NO_SCENE, PART, open_tab, say, shows, until
from tests.helpers.workbench_server import Served


def drag(page: Page, place: Locator, x: float, y: float, by: tuple[float, float]) -> None:
    """Moves a finger, from a position in an element."""
    box = place.bounding_box()
    assert box is not None
    touch: Any = page.context.new_cdp_session(page)
    for step, kind in enumerate(("touchStart", "touchMove", "touchMove")):
        at = {"x": box["x"] + x + by[0] * step / 2, "y": box["y"] + y + by[1] * step / 2}
        touch.send("Input.dispatchTouchEvent", {"type": kind, "touchPoints": [at]})
    touch.send("Input.dispatchTouchEvent", {"type": "touchEnd", "touchPoints": []})
    touch.detach()


def test_a_tablet_shows_what_a_mouse_finds_and_fingers_drag(browser: Browser, workbench: Served) -> None:
    with browser.new_context(viewport={"width": 768, "height": 1024}, has_touch=True, is_mobile=True) as user:
        user.add_init_script(PART)
        user.add_init_script(NO_SCENE)
        page = user.new_page()
        page.goto(f"{workbench.address}&model=doorway.py")
        shows(page, "#time", "t =")
        say(page, type="restart")
        say(page, type="until", time=0.5)
        shows(page, "#time", r"t = 0\.50 s")
        open_tab(page, "Buffers")
        expect(page.get_by_role("button", name="Edit goal")).to_have_css("opacity", "1")
        open_tab(page, "Productions")
        for button in page.locator(".production-names .change-menu-button, #events .ask button").all():
            assert button.is_visible()
            expect(button).to_have_css("opacity", "1")
        dot = "(dot) => getComputedStyle(dot, '::before').boxShadow"
        assert page.get_by_role("button", name="Breakpoint on turn").evaluate(dot) != "none"

        wide = page.locator(".side").bounding_box()
        assert wide is not None
        drag(page, page.locator(".splitter.columns"), 12, 100, (100, 0))  # beside the thin bar
        until(page, lambda: (page.locator(".side").bounding_box() or wide)["width"] < wide["width"] - 50)
        rows, stage = page.locator(".timeline-rows"), page.locator("#timeline")
        drag(page, stage, 60, 200, (0, -16))
        until(page, lambda: rows.evaluate("(rows) => rows.scrollTop") == 16)
        shows(page, "#time", r"t = 0\.50 s")
        column = "async () => (await part('timeline/rows.js')).column.value"
        before = page.evaluate(column)
        drag(page, stage, before + 9, 200, (-60, 0))
        until(page, lambda: page.evaluate(column) == before - 51)
