"""An agent for the tests of warnings about probable mistakes in a model."""

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
    """Returns the warnings about an agent with these methods, with the line (the first line of the body is 10)."""
    text = HEAD + "\n".join("    " + line for line in body.splitlines())
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        agent: Any = load_text(text, "loud.py").Agent()
        agent.run(length)
    assert all(w.category is ModelWarning and w.filename == "loud.py" for w in caught)
    return [(str(w.message), w.lineno) for w in caught]
