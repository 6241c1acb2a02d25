"""What is refused after the user has left the place where it was asked for is among the messages."""

from __future__ import annotations

from collections.abc import Callable

from playwright.sync_api import Page, Route, expect

from tests.helpers.experiments import write_experiment
from tests.helpers.page import open_tab, shows, until
from tests.helpers.workbench_server import Served

SLOW = """
import time
from actr3d.actr import *

class Slow(ACTR):
    goal = Buffer()

    def init():
        goal.set("go")

    def go(goal="go"):
        time.sleep(1.5)

Slow().run()
"""


def held(page: Page, where: str) -> list[Route]:
    """Holds back the requests of a page that change something."""
    routes: list[Route] = []
    page.route(where, lambda route: routes.append(route) if route.request.method == "POST" else route.continue_())
    return routes


def test_an_experiment_that_is_refused_late_is_reported_wherever_the_user_is(pages: Callable[..., Page], workbench: Served) -> None:
    design = f"{write_experiment(workbench.folder).name}:counting"
    page = pages("counting.py", tab="experiments", refusals=True)
    page.get_by_role("button", name="New experiment").click()
    page.get_by_label("Design", exact=True).select_option(design)
    expect(page.locator(".foot")).to_contain_text("s a trial")
    routes = held(page, "**/api/experiments")
    page.locator(".foot").get_by_role("button", name="Run").click()
    until(page, lambda: bool(routes))
    page.get_by_role("button", name="Experiments", exact=True).click()
    routes[0].fulfill(status=422, json={"error": "too many experiments run"})
    expect(page.locator(".toast")).to_contain_text("The experiment counting was not started: too many experiments run")
    (workbench.folder / "counting_design.py").unlink()


def test_a_run_until_something_that_is_refused_late_is_reported_though_its_dialog_is_closed(
    pages: Callable[..., Page], workbench: Served
) -> None:
    (workbench.folder / "slow.py").write_text(SLOW, encoding="utf-8")
    page = pages("slow.py")
    shows(page, "#status", "at its start")
    page.click("#cycle")
    page.keyboard.press("u")
    dialog = page.get_by_role("dialog", name="Run until")
    dialog.get_by_label("a buffer matches").check()
    dialog.get_by_label("Buffer", exact=True).fill("goal")
    dialog.get_by_label("Pattern", exact=True).fill("task:")
    dialog.get_by_role("button", name="Run until then").click()
    expect(dialog.get_by_role("button", name="checking …")).to_be_visible()
    page.keyboard.press("Escape")
    expect(page.locator(".toast")).to_contain_text("Run until: pattern: no value for slot 'task'")
    (workbench.folder / "slow.py").unlink()


def test_a_name_that_is_refused_late_is_reported_though_its_dialog_is_closed(pages: Callable[..., Page]) -> None:
    page = pages("counting.py", refusals=True)
    shows(page, "#status", "at its start")
    page.click("#cycle")
    open_tab(page, "Runs")
    page.locator("tr[data-run]").first.click()
    page.get_by_role("button", name="Name …").click()
    dialog = page.get_by_role("dialog", name="Name of the run")
    dialog.get_by_label("Name", exact=True).fill("first")
    routes = held(page, "**/label")
    dialog.get_by_role("button", name="Save").click()
    until(page, lambda: bool(routes))
    page.keyboard.press("Escape")
    routes[0].fulfill(status=422, json={"error": "the disk is full"})
    expect(page.locator(".toast")).to_contain_text("Name of the run: the disk is full")
