"""Minds that draw from Python's module `random` do not share it with the rest of the program."""

from __future__ import annotations

import random
from typing import Any

import pytest

from actr3d.actr.loading import load_text
from actr3d.simulation import Simulation
from actr3d.world import Scene

Drawing: Any = load_text(
    """
import random
from actr3d.actr import *

class Drawing(Model):
    def start(self):
        self.drawn = [random.random()]
        while True:
            yield 0.01
            self.drawn.append(random.random())
""",
    "drawing.py",
).Drawing


def drawing(seed: int) -> Simulation:
    return Simulation(Scene(), bodiless={"mind": Drawing}, seed=seed, trace="all")


def drawn(simulation: Simulation) -> list[float]:
    return simulation.minds["mind"].drawn


def alone(seed: int) -> list[float]:
    simulation = drawing(seed)
    simulation.run(0.2)
    return drawn(simulation)


def test_simulations_that_are_stepped_in_turn_do_not_disturb_each_other() -> None:
    one, two = drawing(1), drawing(2)
    for _ in range(20):
        one.step()
        two.tick()
        two.tock()
    assert (drawn(one), drawn(two)) == (alone(1), alone(2))
    one.seek(0.1)
    two.step()
    one.run(0.1)
    assert drawn(one) == alone(1)


def test_a_simulation_leaves_the_programs_own_numbers_as_they_were() -> None:
    random.seed(7)
    expected = [random.random() for _ in range(3)]
    random.seed(7)
    found = [random.random()]
    simulation = drawing(1)
    simulation.step(3)
    found.append(random.random())
    simulation.seek(0.01)
    assert simulation.minds
    found.append(random.random())
    assert found == expected


def test_whoever_looks_on_may_draw_numbers_of_its_own() -> None:
    simulation = drawing(1)
    random.seed(7)
    expected = random.Random(7)
    seen: list[float] = []

    def until(_: Any) -> bool:
        seen.append(random.random())
        return simulation.ticks == 20

    simulation.observe(lambda _: seen.append(random.random()))
    simulation.listen(lambda _: seen.append(random.random()))
    simulation.run(until=until)
    assert drawn(simulation) == alone(1)
    assert seen == [expected.random() for _ in seen]
    assert len(seen) > 40


def test_a_mind_that_fails_gives_the_numbers_back() -> None:
    text = """
import random
from actr3d.actr import *
class Failing(Model):
    def start(self):
        yield 0.01
        random.random()
        raise ValueError("no")
"""
    failing: Any = load_text(text, "failing.py").Failing
    simulation = Simulation(Scene(), bodiless={"mind": failing}, seed=1)
    random.seed(7)
    with pytest.raises(ValueError, match="no"):
        simulation.run(1)
    assert random.random() == random.Random(7).random()
