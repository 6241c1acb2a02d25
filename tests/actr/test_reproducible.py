"""One model, one seed: the same bytes in every run."""

from __future__ import annotations

from random import Random

import pytest

from actr3d.actr.kernel.run_limits import RunLimits
from actr3d.actr.loading import load_text, run_text
from actr3d.trace import Trace
from tests.helpers.commands import run_command
from tests.helpers.paths import ROOT

NOISY = """
from actr3d.actr import *

class Guesser(ACTR):
    goal = Buffer()
    retrieval = Buffer()
    memory = Memory(retrieval)
    memory_noise = DMNoise(memory, noise=0.5)
    utility_noise = PMNoise(noise=0.5)
    learning = PMNew(alpha=0.3)
    rounds = 0

    def init():
        for word in ("red", "green", "blue"):
            memory.add(f"colour {word}")
        goal.set("guess")

    def hope(goal="guess"):
        memory.request("colour ?")
        goal.set("look")

    def doubt(goal="guess"):
        memory.request("colour !red")
        goal.set("look")

    def find(goal="look", retrieval="colour ?what"):
        self.again(1 if what == "blue" else -1)

    def fail(goal="look", memory="error:True"):
        self.again(-1)

    def again(self, reward):
        self.reward(reward)
        self.rounds += 1
        self.retrieval.clear()
        if self.rounds < 4:
            self.goal.set("guess")
        else:
            self.goal.clear()

Guesser().run()
"""


def trace(seed: int) -> bytes:
    """Runs the noisy model, and returns all its events but the first, which names the seed."""
    record = Trace("all")
    run_text(NOISY, "guesser.py", limits=RunLimits(seed=seed, trace=record))
    first, *rest = [event.to_json() for event in record]
    assert f'"seed": {seed},' in first
    return "\n".join(rest).encode()


@pytest.mark.parametrize("seeds", [range(20), pytest.param(range(20, 250), marks=pytest.mark.slow)], ids=["20", "250"])
def test_a_seed_gives_the_same_bytes_twice_and_each_seed_others(seeds: range) -> None:
    once = [trace(seed) for seed in seeds]
    again = [trace(seed) for seed in seeds]
    assert once == again
    assert len(set(once)) == len(seeds)  # noise leaves no two runs alike


CLOCKED = """
from python_actr import *

class World(Model):
    def start(self):
        while True:
            yield 0.1
            self.tick = self.now()

class Agent(ACTR):
    goal = Buffer()
    retrieval = Buffer()
    memory = Memory(retrieval, latency=0.21, threshold=-2)
    level = DMBaseLevel(memory)
    noise = DMNoise(memory, noise=0.3)

    def init():
        for i in range(6):
            memory.add('fact %d' % i)
        goal.set('ask')

    def ask(goal='ask'):
        memory.request('fact ?', require_new=True)
        goal.set('wait')

    def found(goal='wait', retrieval='fact ?x', memory='busy:False'):
        memory.add('fact ?x')
        retrieval.clear()
        goal.set('ask')

    def lost(goal='wait', memory='error:True'):
        goal.set('ask')
"""


@pytest.mark.parametrize("library", ["python_actr", "actr3d.actr"])
def test_a_run_in_pieces_equals_a_run_in_one_piece(library: str) -> None:
    module = load_text(CLOCKED.replace("python_actr", library))

    def events(pieces: list[float]) -> list[tuple[int, str, str, str]]:
        with RunLimits(seed=7):
            world = module.World()
            world.agent = module.Agent()
            trace = world.traced()
            for piece in pieces:
                world.run(piece)
        assert world.now() == 10.003
        return [(event.time, event.source, event.kind, str(event.data)) for event in trace if event.kind not in ("run", "stop")]

    once = events([10.003])
    assert len(once) > 500
    assert events([0.01] * 1000 + [0.003]) == once
    for seed in range(5):
        numbers = Random(seed)
        pieces: list[int] = []
        while (left := 10_003_000 - sum(pieces)) > 0:
            pieces.append(min(left, numbers.choice([0, 1, 10_000, 333_333, numbers.randrange(1, 200_000)])))
        assert events([piece / 1_000_000 for piece in pieces]) == once


def test_the_command_prints_the_same_bytes_twice() -> None:
    runs = [run_command("run", "models/counting.py", "--seed", "1", "--json", folder=ROOT).stdout for _ in range(2)]
    assert runs[0].count("\n") > 20
    assert runs[0] == runs[1]
