"""Explanations say why a search of the eyes went as it did, now and at any past time."""

from __future__ import annotations

from typing import Any

import pytest

from actr3d.simulation import Simulation
from actr3d.world import Floor, Mannequin, Scene, Wall
from tests.helpers.vision_scenes import agent

KIND = """
from actr3d.actr import *
from actr3d.vision import Vision

class Watching(ProductionSystem):
    production_time = 0.01
    def watch(vision="watching:False"):
        vision.request("feature:obstacle", radius=9, bearing=5, bottom_up=True)

class Agent(ACTR):
    goal = Buffer()
    visual = Buffer()
    vision = Vision(visual)
    below = Watching()
    def init():
        goal.set("look 1")
    def look(goal="look ?least"):
        vision.request("feature:opening height:1.2", width=">?least")
        goal.set("wait")
    def fail(goal="wait", visual="feature:opening"):
        vision.request("feature:opening", width=">3", height=">1.2")
        goal.set("lost")
"""


@pytest.fixture(scope="module")
def walker() -> Any:
    ends = ((4.0, 1.5), (0.3, -1.0), (-1.6, -4.0))
    walls = [Wall(name=f"wall{n}", start=(6.0, left), end=(6.0, right)) for n, (left, right) in enumerate(ends)]
    scene = Scene(parts=(Floor(), *walls, Mannequin(name="walker")))
    simulation = Simulation(scene, {"walker": agent(KIND)}, seed=1, trace="all")
    simulation.run(0.4)
    return simulation.agents["walker"]


def test_it_says_what_was_noticed_refused_and_chosen(walker: Any) -> None:
    (top_down,) = [reason for reason in walker.explain(at=0.12).searches if not reason.bottom_up]
    assert top_down.asked == "feature:opening height:>=1.2 width:>1"
    assert (top_down.outcome, top_down.time) == ("found", 0.05)
    chosen, refused = top_down.features
    assert chosen.verdict == "chosen"
    assert chosen.salience == pytest.approx(1.2 * 2.5, rel=0.1)
    assert refused.salience is None
    assert refused.verdict == "refused: its width is 0.6, not above 1"
    assert "width:1.2" in chosen.feature


def test_it_says_so_of_every_time(walker: Any) -> None:
    assert walker.explain(at=0.0).searches == ()
    pending = walker.explain(at=0.07)
    assert [(reason.bottom_up, reason.outcome) for reason in pending.searches] == [
        (False, "pending"),
        (True, "pending"),
    ]  # which begins anew
    last = walker.explain(at=0.4)
    assert last.searches == walker.explain().searches
    failed, bottom_up = last.searches
    assert failed.outcome == "failed"
    assert {feature.verdict for feature in failed.features} == {
        "refused: its width is 1.2, not above 3",
        "refused: its width is 0.6, not above 3",
    }
    assert bottom_up.outcome == "found"
    assert "walker.vision: search at 0.150 s for 'feature:opening width:>3 height:>1.2': failed" in str(last)


def test_it_says_when_a_buffer_was_kept(walker: Any) -> None:
    outcomes = {reason.outcome for time in range(10, 40) for reason in walker.explain(at=time / 100).searches if reason.bottom_up}
    assert "found, but the buffer was kept" in outcomes
