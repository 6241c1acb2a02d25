"""The reference implementation, python_actr, for live comparison: the same scenario is run on both libraries."""

from __future__ import annotations

import importlib
import importlib.util
import random
import warnings
from pathlib import Path
from types import ModuleType
from typing import Any

from actr3d import actr

MODELS = Path(__file__).parents[1] / "models" / "made"


def reference() -> Any:
    """Returns the python_actr package with all its names; its own source gives warnings on newer Pythons."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        library: Any = importlib.import_module("python_actr")
        parts: Any = importlib.import_module("python_actr.actr")
    merged = ModuleType("reference")
    for module in (library, parts, importlib.import_module("python_actr.actr.compile")):
        merged.__dict__.update({name: value for name, value in vars(module).items() if name[0] != "_"})
    return merged


LIBRARIES: tuple[Any, Any] = (actr, reference())
"""This library, then the reference."""


def model_file(name: str) -> Any:
    """Loads a file of tests/models/made as a new module; its `make(library)` returns a model's class."""
    path = MODELS / f"{name}.py"
    spec = importlib.util.spec_from_file_location(f"tests_models_{name}", path)
    assert spec is not None
    assert spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def recording_buffer(library: Any, events: list[tuple[float, Any]]) -> Any:
    """Returns a buffer that records when it is set and cleared, and its contents then."""

    def set_chunk(self: Any, chunk: Any) -> None:
        library.Buffer.set(self, chunk)
        events.append((self.now(), dict(self.chunk)))

    def clear(self: Any) -> None:
        library.Buffer.clear(self)
        events.append((self.now(), None))

    return type("RecordingBuffer", (library.Buffer,), {"set": set_chunk, "clear": clear})()


def seeded_agent(library: Any, seed: int, **parts: Any) -> Any:
    """Returns a started agent with these parts, at time 0, whose random numbers come from `random.Random(seed)`."""
    agent = type("Agent", (library.ACTR,), parts)()
    agent.run(limit=0)
    agent.random.seed(seed)
    return agent


def text_of(numbers: random.Random, words: str, length: int) -> str:
    """Returns a chunk's text with slots a, b, c... and values drawn from `words`."""
    return " ".join(f"{slot}:{numbers.choice(words)}" for slot in "abcdef"[:length])
