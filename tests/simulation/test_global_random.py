"""Agents that draw from Python's `random` or numpy's `random` do not share its state with the rest of the program."""

from __future__ import annotations

import pickle
import random
import subprocess
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from actr3d.actr.loading import load_text
from actr3d.simulation import Simulation
from actr3d.world import Scene

NUMPY_RANDOM: Any = np.random

Drawing: Any = load_text(
    """
import random
import numpy as np
from actr3d.actr import *

class Drawing(Model):
    def start(self):
        self.drawn = []
        while True:
            self.drawn += [random.random(), np.random.normal(), *np.random.uniform(size=2)]
            yield 0.01
""",
    "drawing.py",
).Drawing


def drawing(seed: int) -> Simulation:
    return Simulation(Scene(), bodiless={"mind": Drawing}, seed=seed, trace="all")


def drawn(simulation: Simulation) -> list[float]:
    return simulation.agents["mind"].drawn


def alone(seed: int) -> list[float]:
    simulation = drawing(seed)
    simulation.run(0.2)
    return drawn(simulation)


def test_simulations_that_are_stepped_alternately_do_not_disturb_each_other() -> None:
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


def draw() -> list[float]:
    """Draws with Python's generator and numpy's; of normal numbers numpy makes two at a time, and keeps one."""
    return [random.random(), np.random.normal(), np.random.uniform()]


def seed() -> None:
    random.seed(7)
    np.random.seed(7)


def test_one_seed_gives_the_same_numbers_in_one_run_or_in_steps_and_another_seed_others() -> None:
    simulation = drawing(1)
    for _ in range(20):
        draw()
        simulation.step()
    assert drawn(simulation) == alone(1)
    assert not set(alone(1)) & set(alone(2))


def test_a_simulation_leaves_the_programs_own_numbers_as_they_were() -> None:
    seed()
    expected = [draw() for _ in range(3)]
    seed()
    found = [draw()]
    simulation = drawing(1)
    simulation.step(3)
    found.append(draw())
    simulation.seek(0.01)
    assert simulation.agents
    found.append(draw())
    assert found == expected


def test_a_generator_that_the_program_has_chosen_for_numpy_stays() -> None:
    before = NUMPY_RANDOM.get_bit_generator()
    try:
        NUMPY_RANDOM.set_bit_generator(np.random.PCG64(7))
        expected = [np.random.normal() for _ in range(3)]
        NUMPY_RANDOM.set_bit_generator(np.random.PCG64(7))
        found: list[float] = []
        for _ in range(3):
            found.append(np.random.normal())
            assert alone(1) == alone(1)
        assert found == expected
        assert type(NUMPY_RANDOM.get_bit_generator()) is np.random.PCG64
    finally:
        NUMPY_RANDOM.set_bit_generator(before)


def test_numpys_numbers_can_still_be_kept_copied_and_seeded() -> None:
    alone(1)
    np.random.seed(7)
    assert np.random.normal() == np.random.RandomState(7).normal()
    kept = np.random.get_state()
    copied = pickle.loads(pickle.dumps(NUMPY_RANDOM.mtrand._rand))
    expected = draw()[1:]
    np.random.set_state(kept)
    assert draw()[1:] == expected == [copied.normal(), copied.uniform()]


def test_observers_may_draw_their_own_numbers() -> None:
    simulation = drawing(1)
    seed()
    expected = random.Random(7), np.random.RandomState(7)
    seen: list[list[float]] = []

    def until(_: Any) -> bool:
        seen.append(draw())
        return simulation.ticks == 20

    simulation.observe(lambda _: seen.append(draw()))
    simulation.listen(lambda _: seen.append(draw()))
    simulation.run(until=until)
    assert drawn(simulation) == alone(1)
    assert seen == [[expected[0].random(), expected[1].normal(), expected[1].uniform()] for _ in seen]
    assert len(seen) > 40


def test_an_agent_that_fails_gives_the_numbers_back() -> None:
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


NUMPY = """
from python_actr import *
class Noisy(ACTR):
    goal = Buffer()
    def init():
        goal.set("go")
    def go(goal="go"):
        import numpy
        print(numpy.random.normal(), numpy.random.uniform())
        goal.clear()
for _ in range(2):
    Noisy().run()
"""


@pytest.mark.parametrize("first", ["", "import numpy.random; numpy.random.seed(3); numpy.random.normal()"])
def test_numbers_drawn_with_numpy_come_from_the_seed_of_the_program_wherever_it_is_imported(first: str, tmp_path: Path) -> None:
    file = tmp_path / "noisy.py"
    file.write_text(NUMPY, encoding="utf-8")
    text = f"import sys; from actr3d.cli import main; {first}\n"
    text += "for seed in '112':\n    main(['run', sys.argv[1], '--seed', seed])\n    print('over')\n"
    text += "print(numpy.random.normal())" if first else ""
    command = [sys.executable, "-c", text, str(file)]
    printed = subprocess.run(command, check=True, capture_output=True, text=True, timeout=60).stdout
    one, again, other, after = (part.splitlines() for part in printed.split("over\n"))
    assert one == again
    assert len(set(one)) == 3
    assert one[0] != other[0]
    if first:
        assert float(after[0]) == np.random.RandomState(3).normal(size=2)[1]  # its former state is restored
