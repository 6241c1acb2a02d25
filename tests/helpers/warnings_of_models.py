"""An agent for the tests of what is said of a model that most likely does not mean what it says."""

from __future__ import annotations

import warnings
from typing import Any

from actr3d.actr.loading import load_text
from actr3d.errors import ModelWarning

HEAD = """from actr3d.actr import *
class Colour: depth = 3
class Eye(Model): busy, colour = False, Colour()
class Agent(ACTR):
    goal = Buffer()
    retrieval = Buffer()
    memory = Memory(retrieval)
    imaginal = ImaginalModule(goal)
    eye = Eye()
"""


def warned(body: str, length: float = 0.0) -> list[tuple[str, int]]:
    """Returns what is said of an agent with these methods, with the line (the first line of the body is 10)."""
    text = HEAD + "\n".join("    " + line for line in body.splitlines())
    with warnings.catch_warnings(record=True) as said:
        warnings.simplefilter("always")
        agent: Any = load_text(text, "loud.py").Agent()
        agent.run(length)
    assert all(w.category is ModelWarning and w.filename == "loud.py" for w in said)
    return [(str(w.message), w.lineno) for w in said]
