"""Small experiments: a program without a body, whose trials take a few milliseconds, and a design for it."""

from __future__ import annotations

import os
import subprocess
from pathlib import Path

COUNTER = '''"""Counts to a number, and says so."""
n = 3
mode = "count"

from actr3d.actr import *


class Counter(ACTR):
    goal = Buffer()

    def init():
        goal.set("count 0")

    def count(goal="count ?k"):
        if int(k) < n:
            goal.set(f"count {int(k) + 1}")
        else:
            goal.set("done")


model = Counter()
if mode == "fail":
    raise RuntimeError(f"cannot count to {n}")
if mode == "hang":
    while True:
        pass
if mode == "die":
    import os
    os.kill(os.getpid(), 11)
if mode == "shout":
    import os
    os.write(1, b"{not json}\\n" * 100)
model.run()
rt = model.now()
luck = model.random.random()
'''

SLOW_COUNTER = COUNTER.replace('if mode == "fail"', 'import time\ntime.sleep(0.03)\nif mode == "fail"')
"""A model whose trials last long enough for a test to act meanwhile, and use little of the processor."""

DESIGN = """
from actr3d.experiment import Design, Group, Normal, Uniform, design


@design
def counting():
    '''Counts to several numbers.'''
    return Design(
        model="counter.py",
        factors={factors},
        groups={{"all": Group(participants={participants})}},
        trials={trials},
        measures=["rt", "luck"],
        limit={limit},
    )
"""


def write_experiment(
    folder: Path, *, factors: str = '{"n": [1, 2, 5]}', participants: int = 2, trials: int = 4, limit: float = 60, model: str = COUNTER
) -> Path:
    """Writes the model and a design into a folder, and returns the file of the design."""
    (folder / "counter.py").write_text(model, encoding="utf-8")
    path = folder / "counting_design.py"
    path.write_text(DESIGN.format(factors=factors, participants=participants, trials=trials, limit=limit), encoding="utf-8")
    return path


def trial_processes() -> set[int]:
    """Returns the child processes that run trials."""
    found = subprocess.run(["pgrep", "-P", str(os.getpid()), "-f", "trial_process"], capture_output=True, text=True)
    return {int(one) for one in found.stdout.split()}
