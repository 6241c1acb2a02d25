"""How long productions take, and what may compute it."""

from __future__ import annotations

from itertools import pairwise

import pytest

from actr3d.errors import ParameterError
from tests.helpers.production_cycle import fired, run


@pytest.mark.parametrize("given", ["lambda: 0.02", "0.02", "Callable()"])
def test_production_time_as_number_and_callable(given: str) -> None:
    body = f"""
class Callable:
    def __call__(self):
        return 0.02
class Agent(ACTR):
    goal = Buffer()
    production_time = {given}
    def init():
        goal.set('a')
    def p(goal='a'):
        goal.clear()
"""
    assert fired(run(body)) == [(0.02, "p")]


def test_production_time_as_a_method() -> None:
    body = """
class Agent(ACTR):
    goal = Buffer()
    slow = 2
    def production_time(self):
        return 0.05 * self.slow
    def init():
        goal.set('a')
    def p(goal='a'):
        goal.clear()
"""
    assert fired(run(body)) == [(0.1, "p")]


def test_a_threshold_keeps_weak_productions_back_until_something_changes() -> None:
    body = """
class Agent(ACTR):
    goal = Buffer()
    production_threshold = 1
    def init():
        goal.set('a')
        self.lower()
    def p(goal='a', utility=0.5):
        goal.clear()
    def lower(self):
        yield 0.2
        self.production_threshold = 0.5
"""
    assert fired(run(body)) == [(0.25, "p")]


def test_matching_takes_its_part_of_the_production_time() -> None:
    body = """
class Agent(ACTR):
    goal = Buffer()
    production_match_delay = 0.02
    def init():
        goal.set('a')
        self.change()
    def p(goal='b'):
        goal.clear()
    def change(self):
        yield 0.01
        self.goal.set('b')
"""
    assert fired(run(body)) == [(0.05, "p")]


def test_noise_on_the_production_time_is_seeded_and_never_below_0() -> None:
    body = """
class Agent(ACTR):
    goal = Buffer()
    production_time_sd = 0.05
    def init():
        goal.set('a')
    def p(goal='a'):
        out.append(self.now())
"""
    out = run(body, 20).out
    gaps = [b - a for a, b in pairwise(out)]
    assert min(gaps) >= 0
    assert len(set(gaps)) > 50


@pytest.mark.parametrize("name", ["production_time", "production_threshold"])
@pytest.mark.parametrize("value", ["float('nan')", "'0.1'"])
def test_a_function_that_computes_no_number_is_an_error_that_names_it(name: str, value: str) -> None:
    body = f"""
class Agent(ACTR):
    goal = Buffer()
    {name} = lambda: {value}
    def init():
        goal.set('a')
    def p(goal='a'):
        goal.clear()
    def q(goal='a'):
        goal.clear()
"""
    with pytest.raises(ParameterError, match=rf"Agent\.{name}\(\): must be a (finite )?number \(got "):
        run(body)
