"""The manual and the README: their code runs and prints what they say, and the site is complete and loads nothing from elsewhere."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

import pytest
from manual import PAGES, ROOT, check, compare, has_code

from actr3d.vision import DETECTORS


@pytest.fixture
def own_detectors() -> Iterator[None]:
    """Forgets the detectors that a page defines."""
    before = dict(DETECTORS)
    yield
    DETECTORS.clear()
    DETECTORS.update(before)


@pytest.mark.usefixtures("own_detectors")
@pytest.mark.filterwarnings("default::actr3d.errors.ModelWarning")
@pytest.mark.parametrize("page", filter(has_code, PAGES), ids=lambda page: page.relative_to(ROOT).as_posix())
def test_the_code_of_a_page_prints_what_the_page_shows(page: Path, tmp_path: Path) -> None:
    check(page, tmp_path)


def test_a_page_that_shows_something_else_fails() -> None:
    compare("a\n...\nd\n", "a\nb\nc\nd\n")
    with pytest.raises(AssertionError, match="but this is printed"):
        compare("a\nc\n", "a\nb\n")


def test_the_readme_is_short() -> None:
    assert len((ROOT / "README.md").read_text(encoding="utf-8").splitlines()) <= 200
    assert (ROOT / "docs" / "images" / "workbench.png").stat().st_size < 300_000


@pytest.mark.parametrize("name", ["README.md", "CONTRIBUTING.md", "SECURITY.md"])
def test_the_files_and_links_that_a_text_names_are_there(name: str) -> None:
    text = (ROOT / name).read_text(encoding="utf-8")
    named = re.findall(r"`((?:actr3d|workbench|static|models|tests|docs)/[\w/.-]*)`", text)
    linked = re.findall(r"\]\((?!https?:|#|mailto:)([^)#]+)", text)
    assert [path for path in (*named, *linked) if not (ROOT / path).exists()] == []
