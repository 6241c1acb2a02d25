"""The manual and the README: their code runs and prints what they say, and the site is complete and loads nothing from elsewhere."""

from __future__ import annotations

import re
import sys
from collections.abc import Iterator
from importlib import import_module
from pathlib import Path
from typing import Any

import pytest

from actr3d.experiment.specification import library_designs
from actr3d.vision import DETECTORS
from actr3d.world.body import ACTUATORS, SENSORS
from tests.helpers.manual import FENCE, PAGES, ROOT, check, compare, has_code
from tests.helpers.manual_site import build_strictly
from tests.helpers.motor_bodies import moving, until
from workbench.overlays import OVERLAYS


@pytest.fixture
def own_definitions() -> Iterator[None]:
    """Forgets the detectors, sensors and commands that a page defines."""
    registries: list[dict[str, Any]] = [DETECTORS, SENSORS, ACTUATORS]
    before = [dict(registry) for registry in registries]
    yield
    for registry, known in zip(registries, before, strict=True):
        registry.clear()
        registry.update(known)


@pytest.mark.usefixtures("own_definitions")
@pytest.mark.filterwarnings("default::actr3d.errors.ModelWarning")
@pytest.mark.parametrize("page", [page for page in PAGES if has_code(page)], ids=lambda page: page.relative_to(ROOT).as_posix())
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
    text = FENCE.sub("", (ROOT / name).read_text(encoding="utf-8"))
    named = re.findall(r"`((?:actr3d|workbench|static|models|tests|docs)/[\w/.-]*)`", text)
    linked = re.findall(r"\]\((?!https?:|#|mailto:)([^)#]+)", text)
    assert [path for path in (*named, *linked) if not (ROOT / path).exists()] == []


# -- facts of pages that no code block shows


def page(name: str) -> str:
    """Returns the text of a page of the manual."""
    return (ROOT / "docs" / f"{name}.md").read_text(encoding="utf-8")


def test_productions_can_match_what_the_page_on_motor_control_says() -> None:
    _, motor = moving()
    table = page("concepts/motor").split("## What productions can match")[1].split("\n\n")[1]
    named = {word.replace("<group>", "torso").replace("<joint>", "torso_yaw") for word in re.findall(r"`(\w+|<\w+>_\w+)`", table)}
    values = {"done", "stopped", "limit", "blocked", "none"}
    assert {word for word in named if not hasattr(motor, word)} == values


def test_a_posture_is_stored_as_the_page_on_motor_control_shows() -> None:
    simulation, motor = moving()
    motor.rotate_torso(60)
    motor.extend_shoulder("right")
    until(simulation, lambda: not motor.busy)
    chunk = motor.parent.posture.chunk
    (shown,) = re.findall(r"`(posture:rotate_torso .*?)`", page("concepts/motor"))
    assert {f"{slot}:{value}" for slot, value in chunk.items()} >= set(shown.split()) - {"..."}


# -- tables that docs/generate makes


@pytest.fixture
def tables(monkeypatch: pytest.MonkeyPatch) -> Any:
    """Returns the module that makes the tables."""
    monkeypatch.setattr(sys, "path", [str(ROOT / "docs" / "generate"), *sys.path])
    return import_module("tables")


def test_the_tables_of_commands_and_sensors_say_what_an_imported_body_needs_for_each(tables: Any) -> None:
    rows = [line.split(" | ") for name in ("actuators", "sensors") for line in tables.table(name).splitlines()]
    bodies = {row[0].strip("| `"): row[2] for row in rows}
    assert bodies["pose"] == "any"
    assert bodies["view"] == "mannequin, car, imported with an eye"
    assert bodies["teleport"] == "mannequin, car, imported with a free joint"
    assert bodies["posture"] == "mannequin, car, imported with a velocity servo"


def test_the_table_of_motor_commands_has_commands_only(tables: Any) -> None:
    assert {"start", "joint"}.isdisjoint(re.findall(r"^\| `(\w+)", tables.table("motor commands"), re.MULTILINE))


def test_the_table_of_defaults_has_the_numbers_of_agents_and_memories(tables: Any) -> None:
    found = tables.table("defaults")
    assert all(f"`{default}`" in found for default in ("production_time=0.05", "threshold=0", "finst_time=3.0", "decay=0.5", "strength=1"))


def test_the_tables_of_overlays_and_designs_have_all_of_them(tables: Any) -> None:
    found = tables.table("designs")
    assert all(f"| `{name}` | " in found for name in library_designs())
    assert "(Friedman et al. 1964)." in found
    assert all(f"| {kind.title} | Shows " in tables.table("overlays") for kind in OVERLAYS.values())


def test_a_broken_link_fails_the_build_of_the_manual(tmp_path: Path) -> None:
    (tmp_path / "docs").mkdir()
    (tmp_path / "mkdocs.yml").write_text("site_name: Manual\n", encoding="utf-8")
    page = tmp_path / "docs" / "index.md"
    page.write_text("# Start\n", encoding="utf-8")
    build_strictly(tmp_path)
    page.write_text("# Start\n\nSee [nothing](no-such-page.md).\n", encoding="utf-8")
    with pytest.raises(AssertionError, match=r"no-such-page\.md"):
        build_strictly(tmp_path)
