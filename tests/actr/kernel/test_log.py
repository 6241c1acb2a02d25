"""Logs: lines of text, the HTML table, data files, and the summary."""

from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import pytest

from actr3d.actr.compat.log_files import html_page
from actr3d.actr.kernel.log import LOG
from actr3d.actr.loading import run_text

MODEL = """
import ccm
log = ccm.log({settings})

class Part(ccm.Model):
    mood = 'calm'
    def start(self):
        yield 0.5
        self.mood = 'wild'
        log.score['x'] = 3
        log.place.inner = (1, 2)
        log.place._ = 4

class Whole(ccm.Model):
    part = Part()

whole = Whole()
ccm.log_everything(whole)
whole.run()
"""


def run(settings: str, folder: Path, monkeypatch: pytest.MonkeyPatch, ending: str = "") -> list[Path]:
    """Runs the model in a folder; returns the files it wrote."""
    monkeypatch.chdir(folder)
    run_text(MODEL.replace("{settings}", settings) + ending, "model.py")
    return sorted(path for path in folder.rglob("*") if path.is_file())


def test_lines_of_text(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    assert run("", tmp_path, monkeypatch) == []
    assert capsys.readouterr().out.splitlines() == [
        "   0.000 part.mood calm",
        "   0.500 part.mood wild",
        "   0.500 score[x] 3",
        "   0.500 place.inner (1, 2)",
        "   0.500 place 4",
        "end...",
    ]


def test_the_screen_may_be_turned_off(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    run("screen=False", tmp_path, monkeypatch)
    assert capsys.readouterr().out == "end...\n"


def test_data_go_to_a_folder_named_after_the_model(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    (file,) = run("data=True", tmp_path, monkeypatch)
    assert file.parent == tmp_path / "model"
    assert file.suffix == ".data"
    assert file.read_text(encoding="utf-8") == "part.mood=wild\nplace=4\nplace.inner=(1, 2)\nscore[x]=3\ntime=0.5\n"


def test_another_directory(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    files = run("data=True, html=True, directory='out/deep'", tmp_path, monkeypatch)
    assert {(file.parent, file.suffix) for file in files} == {(tmp_path / "out" / "deep", ending) for ending in (".data", ".html")}


def test_the_summary_comes_last(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]) -> None:
    run("summary=True, screen=False", tmp_path, monkeypatch)
    wanted = ["Total time:    0.500", " part.mood wild", " place 4", " place.inner (1, 2)", " score[x] 3", "end..."]
    assert capsys.readouterr().out.splitlines() == wanted


@pytest.mark.parametrize(("ending", "error"), [("1 / 0", ZeroDivisionError), ("raise SystemExit(3)", SystemExit)])
def test_a_program_that_fails_keeps_what_it_logged(
    ending: str, error: type[BaseException], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    with pytest.raises(error):
        run("data=True", tmp_path, monkeypatch, ending)
    (file,) = tmp_path.rglob("*.data")
    assert "part.mood=wild" in file.read_text(encoding="utf-8")


def test_a_program_begins_with_a_log_of_its_own() -> None:
    before = dict(vars(LOG))
    try:
        LOG.do_html, LOG.do_screen, LOG.time_us = True, False, 9_000_000
        LOG.rows.append((9.0, "outer", 1))
        seen: Any = run_text(
            "import ccm\nfrom actr3d.actr.kernel.log import LOG\nfound = (LOG.do_html, LOG.do_screen, LOG.time, LOG.rows)\n"
        )
        assert seen.found == (False, True, 0.0, [])
        assert (LOG.do_html, LOG.do_screen, LOG.time, LOG.rows) == (True, False, 9.0, [(9.0, "outer", 1)])
    finally:
        vars(LOG).update(before)
        LOG.reset()


# -- the HTML table


class Page(HTMLParser):
    """Collects a page's elements, the texts of its cells, and how many columns each table has."""

    def __init__(self, text: str) -> None:
        super().__init__()
        self.tags: list[str] = []
        self.attributes: list[str] = []
        self.cells: list[str] = []
        self.open = False
        self.feed(text)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append(tag)
        self.attributes += [name for name, _ in attrs]
        if tag in ("td", "th"):
            self.cells.append("")
            self.open = True

    def handle_endtag(self, tag: str) -> None:
        self.open = self.open and tag not in ("td", "th")

    def handle_data(self, data: str) -> None:
        if self.open:
            self.cells[-1] += data


ELEMENTS = {"html", "head", "meta", "title", "style", "body", "h1", "div", "table", "thead", "tbody", "tr", "th", "td", "i"}
HOSTILE = "<img src=x onerror=alert(1)>"


@pytest.mark.parametrize(
    "text", [HOSTILE, f"a:{HOSTILE}", "\"'><script>alert(1)</script>", "</td></table><svg onload=alert(1)>", "&lt;b&gt;"]
)
def test_nothing_that_a_model_says_becomes_markup(text: str) -> None:
    rows: list[tuple[float, str, Any]] = [(0.0, "x", 1), (0.0, text, text), (0.5, text, "b"), (0.5, f"{text}!", text)]
    page = Page(html_page(rows, text))
    assert set(page.tags) <= ELEMENTS
    assert not [name for name in page.attributes if name.startswith("on")]
    assert page.cells.count(text) == 3
    assert f"{text}!" in page.cells


def test_changing_values_have_columns_and_constant_ones_are_below() -> None:
    rows: list[tuple[float, str, Any]] = [
        (0.0, "a", "x"),
        (0.0, "fixed", 7),
        (0.5, "b", True),
        (0.5, "a", "y"),
        (0.5, "a", "z"),
        (1.0, "b", False),
    ]
    page = Page(html_page(rows, "log"))
    assert page.cells == ["time", "a", "b", "0.000", "x", "", "0.500", "y", "True", "z", "1.000", "False", "fixed", "7"]


def test_a_log_in_which_nothing_changes_has_one_table() -> None:
    page = Page(html_page([(0.0, "a", 1), (0.0, "b", None)], "log"))
    assert page.tags.count("table") == 1
    assert page.cells == ["a", "1", "b", ""]


def test_a_page_is_self_contained_and_knows_light_and_dark() -> None:
    text = html_page([(0.0, "a", "x"), (1.0, "a", "y")], "log")
    assert "prefers-color-scheme: dark" in text
    assert "position: sticky" in text
    assert "http" not in text


def test_a_page_is_written_whatever_its_characters(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    run_text("import ccm\nlog = ccm.log(screen=False, html=True, data=True)\nlog.a = '\\ud800 \u2211'\n", "model.py")
    for file in tmp_path.rglob("*.*"):
        assert "\u2211" in file.read_text(encoding="utf-8")
