"""Which of several features is chosen: by the share of its salience, by the rule of SOS Vision, and by what makes it salient."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Sequence
from functools import cache
from random import Random
from typing import Any

import pytest

from actr3d.trace import Trace
from actr3d.vision import Opening
from actr3d.vision.salience import KINDS, share, survivors
from actr3d.world import Floor, Mannequin, Scene, Wall, World
from tests.helpers.small_agents import near
from tests.helpers.vision_scenes import AgentWithoutPhysics, agent, events

SEEDS = 1000
LEVEL = 0.001
"""A chi-square test that fails by chance once in a thousand; the seeds are fixed, so it fails always or never."""

KIND = """
from actr3d.actr import *
from actr3d.vision import Vision

class Agent(ACTR):
    goal = Buffer()
    visual = Buffer()
    vision = Vision(visual, delay=0, rows=12OPTIONS)
    def look(goal=None, vision="busy:False error:False", visual=None):
        vision.request("feature:opening", height=1, depth=1)
"""


@cache
def two_openings() -> World:
    """Returns three walls in one line, with a gap of 1.2 m and one of 0.6 m between them."""
    ends = ((4.0, 1.5), (0.3, -1.0), (-1.6, -4.0))
    walls = [Wall(name=f"wall{n}", start=(6.0, left), end=(6.0, right)) for n, (left, right) in enumerate(ends)]
    return World(Scene(parts=(Floor(), *walls, Mannequin(name="walker"))))


def chosen(options: str = "", seeds: int = SEEDS) -> Counter[float | None]:
    """Returns how often which width was chosen; None where nothing was found."""
    kind = agent(KIND.replace("OPTIONS", options))
    agents = (AgentWithoutPhysics(two_openings(), kind, seed).tick(6).agent for seed in range(seeds))
    return Counter(None if mind.visual.chunk is None else mind.visual.chunk["width"] for mind in agents)


def saliences() -> dict[float, float]:
    """Returns the saliences that the trace tells, by width."""
    trace = Trace("all")
    AgentWithoutPhysics(two_openings(), agent(KIND.replace("OPTIONS", "")), 1, trace).tick(6)
    ((_, data),) = list(events(trace, "search"))
    return {slots["width"]: weight for slots, weight in data["noticed"]}


def chance_of(observed: Sequence[int], expected: Sequence[float]) -> float:
    """Returns the p value of a chi-square test of two or three numbers."""
    squares = sum((one - other) ** 2 / other for one, other in zip(observed, expected, strict=True))
    return math.erfc(math.sqrt(squares / 2)) if len(observed) == 2 else math.exp(-squares / 2)


@pytest.mark.slow
def test_the_choice_between_two_openings_follows_their_sizes() -> None:
    weights = saliences()
    assert weights.keys() == {1.2, 0.6}
    assert weights[1.2] == near(2 * weights[0.6])
    counts = chosen()
    assert set(counts) == {1.2, 0.6}
    expected = [SEEDS * 2 / 3, SEEDS / 3]
    assert chance_of([counts[1.2], counts[0.6]], expected) > LEVEL
    assert chance_of([counts[1.2], counts[0.6]], [SEEDS / 2, SEEDS / 2]) < LEVEL  # the test can tell


@pytest.mark.slow
def test_by_the_sos_rule_each_survives_by_itself_one_of_those_is_drawn_and_it_may_fail() -> None:
    counts = chosen(", rule='sos', salience=lambda opening: 0.8 if opening.width > 1 else 0.3")
    wide = 0.8 * 0.7 + 0.8 * 0.3 / 2
    narrow = 0.2 * 0.3 + 0.8 * 0.3 / 2
    expected = [SEEDS * part for part in (wide, narrow, 0.2 * 0.7)]
    observed = [counts[1.2], counts[0.6], counts[None]]
    assert chance_of(observed, expected) > LEVEL
    share_of_all = [SEEDS * part for part in (0.86 * 8 / 11, 0.86 * 3 / 11, 0.14)]
    assert chance_of(observed, share_of_all) < LEVEL


def test_a_modellers_function_and_words_by_feature() -> None:
    only_narrow = chosen(", salience={'opening': lambda opening: 1.0 if opening.width < 1 else 0.0}", 50)
    assert only_narrow == {0.6: 50}
    equal = chosen(", salience='equal'", 400)
    assert chance_of([equal[1.2], equal[0.6]], [200, 200]) > LEVEL


def opening(distance: float, width: float = 1.0, motion: float | None = None) -> Any:
    shape: dict[str, Any] = {"height": 2.0, "depth": 1.0, "top": 0.5, "bottom": -1.5, "left": 1, "right": 2}
    return Opening(distance=distance, direction=0.0, width=width, motion=motion, **shape)


def test_what_makes_salient() -> None:
    assert KINDS["size"](opening(3.0, 0.5)) == 1.0
    assert KINDS["nearness"](opening(4.0)) == 0.25
    assert KINDS["nearness"](opening(0.0)) == 10.0
    assert KINDS["motion"](opening(4.0, motion=1.5)) == 1.5
    assert KINDS["motion"](opening(4.0)) == 0.0


@pytest.mark.parametrize("weights", [[3.0, 1.0], [0.0, 0.0], [0.0, 2.0, 0.0], [1e-300, 1e-300], [1e300, 1e300]])
def test_a_share_is_drawn_of_any_weights(weights: list[float]) -> None:
    random = Random(1)
    drawn = Counter(share(weights, random) for _ in range(4000))
    total = sum(weights)
    for i, weight in enumerate(weights):
        expected = weight / total if total else 1 / len(weights)
        assert drawn[i] / 4000 == near(expected, abs=0.03)
        assert weight > 0 or total == 0 or i not in drawn


def test_a_salience_of_one_always_survives_and_none_never() -> None:
    random = Random(1)
    for _ in range(100):
        assert survivors([1.0, 0.0, 2.5], random) == [0, 2]
