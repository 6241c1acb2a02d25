"""Random worlds of several agents with many simultaneous events: their order is that of python_actr.

All times are binary fractions, which python_actr's floats add up exactly; other times would differ in their last bit.
"""

from __future__ import annotations

import random
from pathlib import Path

import pytest
from golden.compat import run_peer

from tests.helpers.commands import run_command

HEAD = """import python_actr
from python_actr import *
log = python_actr.log()

class Hand(Model):
    busy = False
    def grasp(self, time):
        if self.busy: return
        self.busy = True
        yield time
        self.busy = False
    def wave(self):
        yield 0.0625
        self.parent.parent.signal = self.now()
        yield self.grasp
        self.waved = True

class Watch(ProductionSystem):
    production_time = 0.03125
    seen = 'no'
    def see(goal='wait', self='seen:no'): self.seen = 'yes'
    def unsee(goal='choose', self='seen:yes'): self.seen = 'no'
"""

AGENT = """
class Agent{i}(ACTR):
    production_time = {time}
    goal = Buffer()
    retrieval = Buffer()
    memory = Memory(retrieval, latency={latency}, finst_time={finst})
    hand = Hand()
    {modules}
    def init():
        for move in ('rock', 'paper', 'scissors'): memory.add('play ' + move)
        goal.set('choose')
    def choose(goal='choose', memory='busy:False'):
        memory.request('play ?'{new})
        goal.set('wait')
    def act(goal='wait', retrieval='play ?x'):
        print('act', {i}, x)
        retrieval.clear()
        goal.set('{then}')
        top.turn = {i}
    def lost(goal='wait', memory='error:True'): goal.set('choose')
    def grasp(goal='grasp', hand='busy:False'):
        hand.grasp({hold})
        goal.set('choose')
    def wave(goal='grasp', hand='busy:False'):
        hand.wave()
        goal.set('choose')
    def turn(goal='choose', top='turn:{other}'):
        self.reward(1)
        goal.set('wait')
        memory.request('play rock')
"""

WORLD = """
class World(Model):
    turn = 0
    signal = 0
    def start(self):
        while True:
            yield {beat}
            self.beat = True

world = World()
for number, kind in enumerate(({agents})):
    setattr(world, 'agent%d' % number, kind())
log_everything(world)
{run}
"""


def world(seed: int) -> str:
    """Returns a program."""
    pick = random.Random(seed).choice
    times = ("0.0625", "0.125", "0.25")
    count = 1 + seed % 5
    agents = [
        AGENT.format(
            i=i,
            time=pick(times),
            latency=pick((*times, "0.03125")),
            finst=pick(("3.0", "0.25", "0.5")),
            modules=pick(("pass", "watch = Watch()", "learning = PMNew(); whim = PMNoise(noise=0.2)")),
            new=pick(("", ", require_new=True")),
            then=pick(("choose", "grasp")),
            hold=pick(times),
            other=pick(range(count)),
        )
        for i in range(count)
    ]
    names = "".join(f"Agent{i}, " for i in range(count))
    beat = pick(("0.0625", "0.125", "self.changes", "(0.375, self.changes)"))
    return (
        HEAD
        + "".join(agents)
        + WORLD.format(beat=beat, agents=names, run=pick(("world.run(1.25)", "for _ in range(3): world.run(limit=0.4)")))
    )


@pytest.mark.parametrize("seed", [0, 1, 2, *(pytest.param(seed, marks=pytest.mark.slow) for seed in range(3, 12))])
def test_simultaneous_events_happen_in_the_same_order(seed: int, tmp_path: Path) -> None:
    file = tmp_path / "world.py"
    file.write_text(world(seed), encoding="utf-8")
    result = run_command("run", str(file), "--seed", str(seed), folder=tmp_path)
    assert result.returncode == 0, result.stderr
    assert result.stdout.splitlines() == run_peer(world(seed), seed)["printed"].splitlines()
    assert "act " in result.stdout
