"""All detectors by what they find; each file of this package adds its own, and so may a model's file."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, TypeVar

from actr3d.camera import View
from actr3d.errors import VisionError
from actr3d.vision.feature import Feature
from actr3d.vision.units import Unit, units_of

Detect = Callable[..., tuple[Feature, ...]]
"""A function of a view, and of parameters by keyword that have defaults; it reads the view and nothing else."""


D = TypeVar("D", bound=Detect)


@dataclass(frozen=True)
class Detector:
    """A detector as the registry has it."""

    finds: type[Feature]
    """The kind of features."""
    detect: Detect
    parameters: tuple[str, ...]
    """What it takes besides the view."""
    builtin: bool = False

    @property
    def name(self) -> str:
        """What requests call what it finds."""
        return self.finds.called()

    def unit(self, parameter: str) -> Unit:
        """Returns the unit of a parameter."""
        return units_of(self.detect)[parameter]

    def __call__(self, view: View, **parameters: Any) -> tuple[Feature, ...]:
        """Returns what there is in a view, in an order that follows from what is seen where."""
        return self.detect(view, **parameters)


DETECTORS: dict[str, Detector] = {}
"""By name. A vision module knows those that there are when it is made."""


def detector(finds: type[Feature]) -> Callable[[D], D]:
    """Returns a decorator that adds a detector for a kind of features; a later one for the same kind takes its place.

    Args:
        finds: The kind of features.

    Raises:
        VisionError: If it is no kind of features, if the library has a detector of that name, or if the function does not take a
            view and parameters by keyword with defaults.
    """
    if not (isinstance(finds, type) and issubclass(finds, Feature)):  # pyright: ignore[reportUnnecessaryIsInstance] # a model's file
        raise VisionError(f"detector: takes the class of what it finds, a subclass of Feature (got {finds!r})")
    name = finds.called()

    def add(detect: D) -> D:
        builtin = detect.__module__.startswith("actr3d.")
        if name in DETECTORS and DETECTORS[name].builtin and not builtin:
            raise VisionError(f"detector: the library finds '{name}' itself; give the class {finds.__name__} another name")
        _, *others = inspect.signature(detect).parameters.values() or (None,)
        wrong = [p.name for p in others if p.kind is not p.KEYWORD_ONLY or p.default is p.empty]
        if wrong or not inspect.signature(detect).parameters:
            raise VisionError(f"detector '{name}': must take a view, and after a * what has a default: def find(view, *, most=0.1)")
        DETECTORS[name] = Detector(finds, detect, tuple(p.name for p in others), builtin)
        return detect

    return add
