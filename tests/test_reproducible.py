"""One model, one seed: the same bytes, however often it is run."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

from actr3d.actr.limits import RunLimits
from actr3d.actr.loading import run_text
from actr3d.trace import Trace

ROOT = Path(__file__).parent.parent
SEEDS = range(1000)
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


def test_a_thousand_seeds_give_the_same_bytes_twice() -> None:
    once = [trace(seed) for seed in SEEDS]
    again = [trace(seed) for seed in SEEDS]
    assert [seed for seed in SEEDS if once[seed] != again[seed]] == []
    assert len(set(once)) == len(SEEDS)  # noise leaves no two runs alike


def test_the_command_prints_the_same_bytes_twice() -> None:
    command = [sys.executable, "-m", "actr3d.cli", "run", "models/counting.py", "--seed", "1", "--json"]
    runs = [subprocess.run(command, capture_output=True, cwd=ROOT, check=True, timeout=60).stdout for _ in range(2)]
    assert runs[0].count(b"\n") > 20
    assert runs[0] == runs[1]
