"""Utilities and their learning, against published numbers and explicit sums."""

from __future__ import annotations

import math
import statistics
from fractions import Fraction
from typing import Any

import numpy as np
import pytest

import actr3d.actr as library
from actr3d.actr import PMPGC, PMTD, PMNew, PMNoise, PMPGCMixedWeighted, PMPGCSuccessWeighted, ProceduralSubModule
from actr3d.actr.loading import load_text
from actr3d.errors import ParameterError, ProductionException
from tests.helpers.python_actr_reference import model_file
from tests.helpers.small_agents import near


def steps(**options: Any) -> Any:
    """Returns an agent that has fired three productions, chosen at 0, 0.05 and 0.1 s; it is 0.15 s."""
    agent = model_file("three_steps").make(library, **options)()
    agent.run(0.15)
    assert agent.goal[0] == "four"
    return agent


def in_order(agent: Any) -> list[float]:
    utilities = agent.get_activation()
    return [utilities[name] for name in ("one", "two", "three")]


@pytest.mark.parametrize("profile", ["python-actr", "act-r-7"])
def test_published_utilities(profile: str) -> None:
    agent = steps(learning=PMNew(alpha=0.2), profile=profile)
    agent.reward(10)
    assert in_order(agent) == near([1.97, 1.98, 1.99])


@pytest.mark.parametrize(("profile", "expected"), [("python-actr", 3.97), ("act-r-7", 3.57)])
def test_a_user_defined_base_utility(profile: str, expected: float) -> None:
    agent = steps(learning=PMNew(alpha=0.2), profile=profile, first=2)
    agent.reward(10)
    assert in_order(agent) == near([expected, 1.98, 1.99])


@pytest.mark.parametrize("profile", ["python-actr", "act-r-7"])
def test_repeated_rewards_converge_to_what_comes_in_time(profile: str) -> None:
    agent = steps(learning=PMNew(alpha=0.3), profile=profile)
    u = [0.0, 0.0, 0.0]
    for _ in range(60):
        agent.reward(4)
        u = [x + 0.3 * (4 - dt - x) for x, dt in zip(u, (0.15, 0.10, 0.05), strict=True)]
    assert in_order(agent) == near(u)
    assert in_order(agent) == near([3.85, 3.9, 3.95], abs=1e-6)


def test_a_reward_reaches_back_to_the_one_before() -> None:
    agent = steps(learning=PMNew(alpha=0.5))
    agent.reward(2)
    agent.goal.set("two")
    agent.run(0.1)  # two and three again, chosen at 0.15 and 0.2
    agent.reward(6)
    first = [0.5 * (2 - dt) for dt in (0.15, 0.10, 0.05)]
    assert in_order(agent) == near([first[0], first[1] + 0.5 * (6 - 0.1 - first[1]), first[2] + 0.5 * (6 - 0.05 - first[2])])


def test_noise_has_the_logistic_distributions_variance() -> None:
    agent = steps(noise=PMNoise(noise=0.6), first=1)
    agent.random.seed(4)
    n = 20_000
    drawn = [agent.get_activation("one") for _ in range(n)]
    variance = math.pi**2 * 0.6**2 / 3
    assert abs(statistics.fmean(drawn) - 1) < 4 * math.sqrt(variance / n)
    assert abs(statistics.variance(drawn) - variance) < 4 * variance * math.sqrt(3.2 / n)


def test_base_noise_is_drawn_once() -> None:
    agent = steps(noise=PMNoise(baseNoise=0.5))
    assert in_order(agent) == in_order(agent)
    assert len(set(in_order(agent))) == 3


def test_pgc() -> None:
    expected = {PMPGC: (3 / 3 * 20, 3), PMPGCSuccessWeighted: (20, 3), PMPGCMixedWeighted: (20, 3)}
    for kind, (gain, tries) in expected.items():
        agent = steps(learning=kind())
        assert in_order(agent) == near([20 - 0.05] * 3)
        agent.reward(2)
        assert in_order(agent) == near([gain - (0.05 + dt) / tries for dt in (0.15, 0.10, 0.05)])


@pytest.mark.parametrize(
    ("kind", "gain", "divisor"), [(PMPGC, 10 * 1 / 4, 4), (PMPGCSuccessWeighted, 10, 1), (PMPGCMixedWeighted, 10 * 1 / 4, 1)]
)
def test_pgc_after_a_failure(kind: Any, gain: float, divisor: float) -> None:
    agent = steps(learning=kind(goal=10))
    agent.reward(-3)
    assert in_order(agent) == near([gain - (0.05 + dt) / divisor for dt in (0.15, 0.10, 0.05)])


def test_pgc_can_be_set_and_locked() -> None:
    agent = steps(learning=PMPGC(goal=8))
    agent.learning.set("one", successes=3, failures=1, time=2, lock=True)
    agent.success()
    agent.failure()
    assert in_order(agent)[0] == near(3 / 4 * 8 - 2 / 4)
    assert in_order(agent)[2] == near(2 / 3 * 8 - (0.05 + 2 * 0.05) / 3)
    with pytest.raises(KeyError, match="six"):
        agent.learning.set("six", successes=1)


def test_temporal_difference() -> None:
    agent = steps(learning=PMTD(alpha=0.1, discount=2, cost=0.05))
    assert in_order(agent) == near([0.1 * -0.05, 0.1 * -0.05, 0])
    u1 = 0.1 * -0.05
    u2 = 0.1 * -0.05
    agent.reward(1)
    agent.reward(0.5)
    agent.goal.set("one")
    agent.run(0.1)  # one fires at 0.2, two at 0.25
    u3 = 0.1 * (1.5 - 0.05 + u1 / (1 + 2 * 0.05))
    u1 += 0.1 * (0 - 0.05 + u2 / (1 + 2 * 0.05) - u1)
    assert in_order(agent) == near([u1, u2, u3])


def test_user_defined_modules_add_up() -> None:
    class Constant(ProceduralSubModule):
        def __init__(self, worth: float) -> None:
            self.worth = worth
            self.seen: list[str] = []

        def selecting(self, prod: Any) -> None:
            self.seen.append(f"selecting {prod.name}")

        def firing(self, prod: Any) -> None:
            self.seen.append(f"firing {prod.name}")

        def reward(self, value: float) -> None:
            self.worth += value

        def utility(self, prod: Any) -> float:
            return self.worth if prod.name == "two" else 0.0

    agent = steps(a=Constant(0.5), b=Constant(0.25), learning=PMNew(), first=3)
    assert agent.a.seen == [f"{what} {name}" for name in ("one", "two", "three") for what in ("selecting", "firing")]
    assert in_order(agent) == [3, 0.75, 0]
    agent.reward(1)
    assert agent.get_activation("two") == near(2.75 + 0.2 * (1 - 0.1))
    assert agent.get_activation("six") is None


@pytest.mark.parametrize("utility", ["'0.6'", "None", "float('nan')"])
def test_a_utility_that_is_no_number_is_refused_where_the_production_is_made(utility: str) -> None:
    text = f"from actr3d.actr import *\nclass A(ACTR):\n    goal = Buffer()\n    def go(goal='a', utility={utility}): pass\n"
    with pytest.raises(ProductionException, match=r"production 'go' \(u\.py:4\): its utility must be a number \(got ('0\.6'|None|nan)\)"):
        load_text(text, "u.py").A().run()


def test_a_production_whose_learned_utility_is_no_number_is_named() -> None:
    text = """
from actr3d.actr import *
class Odd(ProceduralSubModule):
    def utility(self, prod): return float('nan')
class A(ACTR):
    goal = Buffer()
    odd = Odd()
    def init(): goal.set('a')
    def go(goal='a'): pass
    def stay(goal='a'): pass
"""
    with pytest.raises(ProductionException, match=r"production 'go' \(u\.py:9\): its utility is not a number"):
        load_text(text, "u.py").A().run()


def test_a_history_of_an_unknown_production_is_refused_with_the_names() -> None:
    agent = steps(learn=PMPGC())
    with pytest.raises(KeyError, match=r"PMPGC\.set: no production 'onee'; did you mean 'one'"):
        agent.learn.set("onee", successes=1)


@pytest.mark.parametrize("value", [math.nan, math.inf, "2", None, [1]])
def test_a_reward_is_a_finite_number(value: Any) -> None:
    agent = steps(learning=PMNew(alpha=0.2))
    before = in_order(agent)
    with pytest.raises(ParameterError, match=r"reward\(value\): must be a finite number \(got "):
        agent.reward(value)
    assert in_order(agent) == before
    agent.reward(True)
    assert in_order(agent) != before


@pytest.mark.parametrize("value", [np.True_, np.array(1.0), np.int64(1), Fraction(1)])
def test_a_reward_may_be_a_number_of_another_library(value: Any) -> None:
    agent, plain = (steps(learning=PMNew(alpha=0.2)) for _ in range(2))
    agent.reward(value)
    plain.reward(1)
    assert in_order(agent) == in_order(plain)
