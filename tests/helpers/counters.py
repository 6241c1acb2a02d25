"""A small agent for tests of changes by hand: two productions compete, and one waits for another goal."""

from __future__ import annotations

_TEXT = """
from actr3d.actr import *

class Counter(ACTR):
    goal = Buffer()
    retrieval = Buffer()
    memory = Memory(retrieval)
    strength = DMBaseLevel(memory)
    utility = UTILITY

    def init():
        goal.set("count 0")
        memory.add("next 0 1")

    def up(goal="count ?n"):
        goal.set(f"count {int(n) + 1}")

    def recall(goal="count ?n"):
        memory.request("next ?n ?")

    def rest(goal="rest ?n"):
        goal.set("count ?n")
"""


def counter_text(utility: str) -> str:
    """Returns the text of a model with the class `Counter`; `utility` is its part that sets utilities, such as `PMNoise(noise=0.3)`."""
    return _TEXT.replace("UTILITY", utility)
