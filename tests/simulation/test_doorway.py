"""The model of a walk through a doorway: it sees the width of the gap, turns if necessary, and touches nothing."""

from __future__ import annotations

import importlib.util
from typing import Any

import pytest

from tests.helpers.paths import MODELS

FILE = MODELS / "doorway.py"


@pytest.fixture(scope="module")
def doorway() -> Any:
    spec = importlib.util.spec_from_file_location("doorway", FILE)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


@pytest.mark.daily(2)  # the widths next to the critical one
@pytest.mark.parametrize(("width", "turns"), [(0.58, True), (0.4, True), (0.59, False), (0.5, True), (0.8, False)])
def test_it_turns_below_the_critical_ratio_and_passes_untouched(doorway: Any, capsys: Any, width: float, turns: bool) -> None:
    simulation = doorway.build(doorway.Parameters(width=width))
    walker = simulation.world.bodies["walker"]
    touched = walker.get("contacts")  # from now on every physics step is recorded
    while simulation.time < 10 and not touched and walker.get("pose").x < 8:
        simulation.step()
        touched = walker.get("contacts")
    printed = capsys.readouterr().out
    assert touched == ()
    assert walker.get("pose").x > 7.9
    assert f"a gap of {width:.2f} m" in printed
    assert ("turns" in printed) == turns


def test_its_parameters_do_what_they_say(doorway: Any) -> None:
    simulation = doorway.build(doorway.Parameters(speed=2.0))
    simulation.run(1)
    assert simulation.world.bodies["walker"].get("pose").x == pytest.approx(2.0, abs=0.03)


@pytest.mark.parametrize("when", [0.0, 3.0, 5.2])
def test_its_speed_may_change_before_and_on_its_way(doorway: Any, when: float) -> None:
    """At 5.2 s it has turned its shoulders, and no longer looks."""
    simulation = doorway.build(doorway.Parameters(width=0.5))
    simulation.run(when)
    simulation.command("parameter", "walker.speed", 0.8)
    simulation.run(0.6)
    walker = simulation.world.bodies["walker"]
    before = walker.get("pose").x
    simulation.run(0.5)
    assert (walker.get("pose").x - before) / 0.5 == pytest.approx(0.8, abs=0.02)
    simulation.run(12)
    assert walker.get("pose").x > 7.9
    assert walker.get("contacts") == ()
