"""What the README says of worlds and bodies is so."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

import pytest

import actr3d.camera  # pyright: ignore[reportUnusedImport] # noqa: F401 # it adds `view`
from actr3d.world import Body, Car, ImportedBody, Mannequin, Scene, World
from actr3d.world.body import ACTUATORS, SENSORS
from actr3d.world.command_registry import BodyWord

SECTION = (Path(__file__).parent.parent / "README.md").read_text(encoding="utf-8").split("## Worlds and bodies\n")[1].split("\n## ")[0]
ROBOT = """<mujoco><worldbody><body name="base"><joint name="slide" type="slide"/><geom size="0.1"/><site name="eye"/></body></worldbody>
  <actuator><motor name="pull" joint="slide"/></actuator></mujoco>"""


def rows(words: Mapping[str, BodyWord[Body]]) -> list[str]:
    """Returns the rows of the table of some words: each with what it takes, which bodies have it, and what it does."""
    parts = (Mannequin(), Car(position=(9, 0)), ImportedBody(name="imported", text=ROBOT, eye="eye", position=(0, 9, 0)))
    bodies = World(Scene(parts=parts)).bodies
    table: list[str] = []
    for name, word in words.items():
        has = [kind for kind, body in bodies.items() if word.available(body)]
        table.append(f"| `{name}` | {word.takes} | {'any' if len(has) == len(bodies) else ', '.join(has)} | {word.meaning} |")
    return table


def test_the_example_prints_what_is_shown(capsys: pytest.CaptureFixture[str]) -> None:
    exec(SECTION.split("```python\n")[1].split("```")[0], {})
    assert capsys.readouterr().out == SECTION.split("```\n")[2]


def test_the_tables_have_all_words() -> None:
    shown = [line for line in SECTION.splitlines() if line.startswith("| `")]
    assert shown == rows(ACTUATORS) + rows(SENSORS)
