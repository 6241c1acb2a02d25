"""The cycle of production systems: matching, choosing, waiting, matching again, firing."""

from __future__ import annotations

from typing import Any

import pytest

from actr3d.actr.loading import load_text
from actr3d.errors import ProductionException
from tests.helpers.production_cycle import HEAD, fired, run


def test_a_chain_of_productions_takes_50_ms_each() -> None:
    body = """
class Agent(ACTR):
    goal = Buffer()
    def init():
        goal.set('a')
    def one(goal='a'):
        goal.set('b')
    def two(goal='b'):
        goal.set('c')
    def three(goal='c'):
        goal.clear()
"""
    assert fired(run(body)) == [(0.05, "one"), (0.1, "two"), (0.15, "three")]


def test_initializers_run_at_0_in_alphabetical_order() -> None:
    body = """
class Agent(ACTR):
    def b():
        out.append(('b', self.now()))
    def a():
        out.append(('a', self.now()))
    def C():
        out.append(('C', self.now()))
"""
    assert run(body).out == [("C", 0), ("a", 0), ("b", 0)]


def test_the_highest_utility_fires_and_ties_are_broken_at_random() -> None:
    body = """
class Agent(ACTR):
    goal = Buffer()
    def init():
        goal.set('a')
    def low(goal='a', utility=0.5):
        out.append('low')
    def high(goal='a', utility=1):
        out.append('high')
    def also_high(utility=1.0, goal='a'):
        out.append('also')
"""
    out = run(body, 10).out
    assert set(out) == {"high", "also"}
    assert len(out) == 200


def test_a_production_that_no_longer_matches_does_not_fire() -> None:
    body = """
class Agent(ACTR):
    goal = Buffer()
    def init():
        goal.set('a')
    def one(goal='a'):
        out.append('one')
    def two(goal='b'):
        out.append(('two', self.now()))
        goal.clear()
    def change(self):
        yield 0.03
        goal = self.goal
        goal.set('b')
    def go():
        self.change()
"""
    module = run(body)
    assert module.out == [("two", 0.1)]
    assert [(e.time, e.data) for e in module.trace.select("changed")] == [(0.05, {"production": "one"})]


def test_the_bindings_are_those_of_the_second_match() -> None:
    body = """
class Agent(ACTR):
    goal = Buffer()
    def init():
        goal.set('n:1')
        self.change()
    def one(goal='n:?n'):
        out.append(n)
        goal.clear()
    def change(self):
        yield 0.03
        self.goal.modify(n=2)
"""
    assert run(body).out == ["2"]


def test_a_plain_production_system_does_not_match_again_and_chooses_at_random() -> None:
    body = """
class Agent(ProductionSystem):
    goal = Buffer()
    def init():
        goal.set('n:1')
        self.change()
    def one(goal='n:?n', utility=5):
        out.append(n)
    def two(goal='n:1', utility=0):
        out.append('two')
    def change(self):
        yield 0.03
        self.goal.clear()
"""
    found = {run(body).out[0] for _ in range(40)}
    assert found == {"1", "two"}


def test_parallel_systems_have_cycle_times_of_their_own() -> None:
    body = """
class Bottom(ProductionSystem):
    production_time = 0.01
    def count(goal='count:?n'):
        n = int(n) + 1
        goal.modify(count=n)
class Agent(ACTR):
    goal = Buffer()
    bottom = Bottom()
    def init():
        goal.set('count:0 word:a')
    def top_one(goal='word:a'):
        out.append((self.now(), goal['count']))
        goal.modify(word='b')
class World(Model):
    agent = Agent()
"""
    module = run(body, 0.1)
    assert module.out[0][0] == 0.05
    assert len(fired(module, "agent.bottom")) == 10
    assert module.world.agent.goal["count"] == 10
    assert fired(module, "agent") == [(0.05, "top_one")]


def test_everything_else_of_that_moment_happens_before_the_next_match() -> None:
    body = """
class Agent(ACTR):
    goal = Buffer()
    other = Buffer()
    def init():
        goal.set('a')
    def one(goal='a'):
        goal.set('b')
        self.answer()
    def wrong(goal='b', other=None):
        out.append('wrong')
    def right(goal='b', other='c'):
        out.append('right')
        goal.clear()
    def answer(self):
        yield 0
        self.other.set('c')
"""
    assert run(body).out == ["right"]


def test_self_top_and_plain_objects_are_matched() -> None:
    body = """
class Thing:
    def __init__(self):
        self.size = 2.0
        self.part = {'color': 'red'}
class Agent(ACTR):
    thing = Thing()
    mood = 'good'
    done = False
    def p(thing='size:2 part.color:?c', self='mood:good done:False', top='weather:?w'):
        out.append((c, w))
        self.done = True
class World(Model):
    weather = 'sun'
    agent = Agent()
"""
    assert run(body).out == [("red", "sun")]


def test_nothing_matches_until_a_change_anywhere() -> None:
    body = """
class Agent(ACTR):
    lamp = None
    def p(lamp='on:True'):
        out.append(self.now())
        lamp.on = False
class World(Model):
    lamp = Model(on=False)
    def start(self):
        yield 0.3
        self.lamp.on = True
    agent = Agent()
"""
    module: Any = load_text(HEAD + body.replace("    lamp = None\n", ""), "cycle.py")
    module.World().run(1)
    assert module.out == [0.35]


def test_an_unknown_buffer_is_named() -> None:
    body = "class Agent(ACTR):\n    goal = Buffer()\n    def p(gaol='a'):\n        pass\n"
    with pytest.raises(
        ProductionException, match=r"production 'p' \(cycle\.py:5\) matches on 'gaol', which neither.*did you mean 'goal'\?"
    ):
        run(body)


def test_generators_called_from_a_body_run_beside_the_cycle() -> None:
    body = """
class Agent(ACTR):
    goal = Buffer()
    def init():
        goal.set('a')
    def one(goal='a'):
        self.later('x')
        goal.set('b')
    def two(goal='b'):
        out.append(('two', self.now()))
        goal.clear()
    def later(self, word):
        yield 0.02
        out.append((word, self.now()))
        yield self.two_seconds()
        out.append(('end', self.now()))
    def two_seconds(self):
        yield 0.2
"""
    assert run(body).out == [("x", 0.07), ("two", 0.1), ("end", 0.27)]


def test_one_seed_gives_one_course() -> None:
    from actr3d.actr.kernel.run_limits import RunLimits
    from actr3d.actr.loading import run_text

    text = HEAD + (
        "class Agent(ACTR):\n    goal = Buffer()\n    production_time_sd = 0.01\n    def init():\n        goal.set('a')\n"
        "    def p(goal='a'):\n        out.append(('p', self.now()))\n    def q(goal='a'):\n        out.append(('q', self.now()))\n"
        "Agent().run(2)\n"
    )
    first, again, other = (run_text(text, limits=RunLimits(seed=seed)).out for seed in (1, 1, 2))
    assert first == again != other
