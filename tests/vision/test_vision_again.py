"""By the rule of SOS Vision, what was chosen must still be there at the end; otherwise a chunk tells what was seen at the request."""

from __future__ import annotations

from typing import Any

import pytest

from actr3d.camera import view_for_observer
from actr3d.simulation import Simulation
from actr3d.vision import sightings
from actr3d.world import Aperture, Floor, Mannequin, Scene
from tests.helpers.small_agents import near
from tests.helpers.vision_scenes import agent, events
from tests.helpers.walkers import digest

KIND = """
from actr3d.actr import *
from actr3d.vision import Vision

class Agent(ACTR):
    goal = Buffer()
    visual = Buffer()
    vision = Vision(visual, delay=0.2, salience="equal", rows=30 OPTIONS)
    def init():
        goal.set("look")
    def look(goal="look"):
        vision.request("feature:opening", width=">0.5", height=1)
        goal.set("done")
"""


def seen_of(width: float, later: float, options: str, seed: int = 1) -> Simulation:
    """Returns a simulation in which a doorway becomes of another width while somebody is looking."""
    scene = Scene(parts=(Floor(), Aperture(width=width), Mannequin(name="walker")))
    simulation = Simulation(scene, {"walker": agent(KIND.replace(" OPTIONS", options))}, seed=seed, trace="all")
    simulation.run(0.1)
    simulation.command("aperture", later)
    simulation.run(0.2)
    return simulation


def test_the_sos_rule_does_not_return_what_no_longer_matches() -> None:
    simulation = seen_of(0.9, 0.3, ", rule='sos'")
    mind = simulation.agents["walker"]
    assert (mind.visual.chunk, mind.vision.error) == (None, True)
    ((time, data),) = list(events(simulation.trace, "sight"))
    assert (time, data["failed"]) == (0.25, True)
    assert "the chosen feature was no longer visible, or failed a test" in str(mind.explain())
    stale = seen_of(0.9, 0.3, "").agents["walker"]
    assert (stale.visual.chunk["width"], stale.vision.error) == (0.9, False)


def test_what_is_still_there_comes_as_it_is_at_the_end() -> None:
    simulation = seen_of(0.9, 0.7, ", rule='sos'")
    assert simulation.agents["walker"].visual.chunk["width"] == 0.7
    assert [time for time, _ in events(simulation.trace, "answer")] == [0.05, 0.25]
    assert seen_of(0.9, 0.7, "").agents["walker"].visual.chunk["width"] == 0.9


@pytest.mark.parametrize(("period", "delay", "looks"), [(0.02, 0.065, [0.06, 0.1]), (0.005, 0.008, [0.05, 0.055])])
def test_the_second_look_is_at_the_end_of_the_last_whole_tick_of_the_search(period: float, delay: float, looks: list[float]) -> None:
    scene = Scene(parts=(Floor(), Aperture(width=0.9), Mannequin(name="walker")), timestep=0.005)
    kind = agent(KIND.replace("delay=0.2", f"delay={delay}").replace(" OPTIONS", ", rule='sos'"))
    simulation = Simulation(scene, {"walker": kind}, seed=1, trace="all", period=period)
    simulation.run(0.2)
    assert [time for time, _ in events(simulation.trace, "answer")] == looks
    assert [time for time, _ in events(simulation.trace, "sight")] == [near(0.05 + delay)]


def test_both_looks_of_a_search_are_misjudged_alike() -> None:
    """Else a request that has found something just wide enough would fail the oftener."""
    found = [seen_of(0.6, 0.6, ", rule='sos', edge_noise=0.01", seed) for seed in range(6)]
    for simulation in found:
        noticed = [data["noticed"] for _, data in events(simulation.trace, "search")]
        assert len(noticed[0]) == 0 or noticed[0][0][0]["width"] == noticed[-1][0][0]["width"]
    assert any(simulation.agents["walker"].visual.chunk is not None for simulation in found)


@pytest.mark.parametrize("options", [", rule='sos'", ", rule='sos', delay_sd=0.05, edge_noise=0.003"])
def test_it_lives_through_the_same_again(options: str) -> None:
    first, second = seen_of(0.9, 0.7, options), seen_of(0.9, 0.7, options)
    expected = digest(first)
    assert digest(second) == expected
    second.seek(0.02)
    second.run(0.28)
    second.seek(0.3)
    assert second.agents["walker"].visual.chunk == first.agents["walker"].visual.chunk


# -- what onlookers are told


def test_observers_learn_what_was_seen_where() -> None:
    simulation = seen_of(0.9, 0.9, "")
    mind, body = simulation.agents["walker"], simulation.world.bodies["walker"]
    before: Any = digest(simulation)
    (one,) = sightings(mind, body)
    assert (one.module, one.bottom_up, one.time, one.chosen, one.camera.rows) == ("walker.vision", False, 0.05, True, 30)
    assert one.slots == dict(mind.visual.chunk)
    upper_left, upper_right, lower_right, lower_left = one.corners
    assert upper_left[:2] == near((7.0, 0.45), abs=0.1)
    assert lower_right[:2] == near((7.0, -0.45), abs=0.1)
    assert upper_right[1] - upper_left[1] == near(-0.9, abs=1e-3)
    assert upper_left[2] - lower_left[2] == near(one.slots["height"], abs=2e-3)
    assert lower_left[2] == near(0.0, abs=0.3)
    assert digest(simulation) == before


def test_what_was_seen_stays_where_it_was_though_the_eye_has_gone_on_looking() -> None:
    """Two searches are told of, and the older one was seen from elsewhere; so is what an onlooker has glanced at meanwhile."""
    both = KIND.replace("def look(", "def watch(goal='done'):\n        vision.request('feature:opening', bottom_up=True)\n    def look(")
    scene = Scene(parts=(Floor(), Aperture(width=0.9), Mannequin(name="walker")))
    simulation = Simulation(scene, {"walker": agent(both.replace(" OPTIONS", ""))}, seed=1)
    body = simulation.world.bodies["walker"]
    simulation.command("walk", 1.5, 0.0, 0.4)
    simulation.run(1.0)

    def places() -> dict[bool, Any]:
        return {one.bottom_up: one.corners[0] for one in sightings(simulation.agents["walker"], body)}

    before = places()
    assert before[False][:2] == near((7.0, 0.45), abs=0.1)
    assert before[True][:2] == near((7.0, 0.45), abs=0.1)
    view_for_observer(body)
    assert places() == before
    simulation.seek(0.5)
    simulation.run(0.5)
    assert places() == before


def test_an_agent_that_has_not_looked_has_seen_nothing() -> None:
    scene = Scene(parts=(Floor(), Aperture(), Mannequin(name="walker")))
    simulation = Simulation(scene, {"walker": agent(KIND.replace(" OPTIONS", ""))}, seed=1)
    assert sightings(simulation.agents["walker"], simulation.world.bodies["walker"]) == []
