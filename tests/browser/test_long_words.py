"""Words that are wider than their place are broken: names of files, default values, and what texts of users say."""

from __future__ import annotations

from collections.abc import Callable

import pytest
from playwright.sync_api import Page, expect

from tests.helpers.experiments import write_experiment
from tests.helpers.page import open_tab, shows
from tests.helpers.workbench_server import MODELS, Served

WIDER = """(place) => [place, ...place.querySelectorAll("*")].filter((one) => one.checkVisibility() && one.clientWidth > 0
    && one.scrollWidth > one.clientWidth + 1 && !one.matches("input, select")).map((one) => `${one.tagName} ${one.textContent}`)"""
"""The elements that are narrower than what they contain."""


@pytest.mark.slow
def test_long_words_are_broken_in_dialogs_parameters_and_designs(pages: Callable[..., Page], workbench: Served) -> None:
    name = f"{'n' * 180}.py"
    source = f"text = '{'t' * 300}'\n{(MODELS / 'counting.py').read_text(encoding='utf-8')}"
    (workbench.folder / name).write_text(source, encoding="utf-8")
    path = write_experiment(workbench.folder)
    path.write_text(path.read_text(encoding="utf-8").replace("Counts to", f"Counts {'d' * 300} to"), encoding="utf-8")
    page = pages(name, width=853, height=533, tab="editor")
    shows(page, "#status", "at its start")
    for action in ("Duplicate", "Rename", "Delete"):
        page.get_by_role("button", name=action, exact=True).click()
        dialog = page.get_by_role("dialog")
        expect(dialog).to_contain_text(name)
        assert dialog.evaluate(WIDER) == []
        dialog.get_by_role("button", name="Cancel").click()
    open_tab(page, "Parameters")
    expect(page.locator("#parameter-text-help")).to_contain_text("default ttt")
    assert page.locator("#panel-parameters").evaluate(WIDER) == []
    open_tab(page, "Experiments")
    page.get_by_role("button", name="New experiment").click()
    page.get_by_label("Design", exact=True).select_option("counting_design.py:counting")
    expect(page.locator(".new .description")).to_contain_text("Counts ddd")
    assert page.locator(".new .description").evaluate(WIDER) == []
    for file in (name, path.name, "counter.py"):
        (workbench.folder / file).unlink()


IN_ORDER = """async ([name, model]) => {
  const { nameOf } = await part("runs/wording.js");
  const text = `The recording «${nameOf({ id: "one", model, made: 0, branched: null, number: 1, label: { name } })}» is kept.`;
  const box = document.body.appendChild(Object.assign(document.createElement("p"), { textContent: text, dir: "ltr" }));
  const place = (word) => {
    const range = document.createRange();
    range.setStart(box.firstChild, text.indexOf(word));
    range.setEnd(box.firstChild, text.indexOf(word) + word.length);
    return range.getBoundingClientRect();
  };
  const [before, after, end] = ["recording", "is", "kept"].map(place);
  box.remove();
  return before.right <= after.left && after.right <= end.left;
}"""


def test_a_name_that_changes_the_direction_of_text_does_not_reverse_the_sentence_around_it(blank: Page) -> None:
    for name in ("slow walk", "مشي بطيء", "\u202ewalk", "\u2067walk", "walk \u202d\u202e"):
        assert blank.evaluate(IN_ORDER, [name, "walk.py"]), ascii(name)
