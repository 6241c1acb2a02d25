"""The registry of detectors, by the features that they find."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any, ClassVar, TypeVar, get_origin

from actr3d.camera import View
from actr3d.errors import VisionError
from actr3d.registry import Registry
from actr3d.vision.feature import Feature, checked, slot_names
from actr3d.vision.units import PLAIN, Unit, bounds_of, types_of, units_of

Detect = Callable[..., tuple[Feature, ...]]
"""A function of a view, and of parameters by keyword that have defaults; it reads the view and nothing else."""


D = TypeVar("D", bound=Detect)


@dataclass(frozen=True)
class Detector:
    """A registered detector."""

    finds: type[Feature]
    """The kind of features."""
    detect: Detect
    """The function that finds them."""
    parameters: tuple[str, ...]
    """The names of its parameters besides the view."""
    builtin: bool = False
    """Whether the library defines it, and not a model file."""

    @property
    def name(self) -> str:
        """The name of its features in requests."""
        return self.finds.called()

    def unit(self, parameter: str) -> Unit:
        """Returns the unit of a parameter."""
        return units_of(self.detect).get(parameter, PLAIN)

    def bounds(self, parameter: str) -> tuple[Any, ...]:
        """Returns the bounds of a parameter's type, such as `Ge(0)`."""
        return bounds_of(self.detect).get(parameter, ())

    def __call__(self, view: View, **parameters: Any) -> tuple[Feature, ...]:
        """Returns the features in a view, in an order that depends on the view only.

        Raises:
            VisionError: If a modeller's detector returns anything but features of its kind whose fields are numbers.
        """
        found = self.detect(view, **parameters)
        if self.builtin:
            return found
        try:
            features = tuple(found)
        except TypeError:
            raise VisionError(f"detector '{self.name}': must return the features that it has found, in a tuple (got {found!r})") from None
        return tuple(checked(feature, self.finds) for feature in features)


RESERVED = ("feature", "pattern", "bottom_up")
"""Words of a request that no slot or parameter can have."""

DETECTORS = Registry[Detector]("detector")
"""By name. What a vision module finds under a name stays the same if the text of another model defines that name later."""


def detector(finds: type[Feature]) -> Callable[[D], D]:
    """Returns a decorator that registers a detector for a kind of features.

    Args:
        finds: The kind of features.

    Raises:
        VisionError: If it is not a kind of features, has a field that requests cannot name or that has the name of a member of
            `Feature`, if there is another detector of that name, or if the function does not take a view and parameters by keyword with
            defaults.
    """
    if not (isinstance(finds, type) and issubclass(finds, Feature)):  # pyright: ignore[reportUnnecessaryIsInstance] # a model's file
        raise VisionError(f"detector: must be given the class that it finds, a subclass of Feature (got {finds!r})")
    name = finds.called()
    slots = slot_names(finds)
    unknown = [field for field, kind in types_of(finds).items() if field not in slots and get_origin(kind) is not ClassVar]
    if unknown:
        raise VisionError(f"detector '{name}': '{unknown[0]}' is not a field; write @dataclass(frozen=True, kw_only=True) above the class")

    hiding = [slot for slot in slots if slot not in slot_names(Feature) and (hasattr(Feature, slot) or slot == "self")]
    if hiding:
        raise VisionError(f"detector '{name}': '{hiding[0]}' is reserved in features; use another name for that field")

    def add(detect: D) -> D:
        _, *others = inspect.signature(detect).parameters.values() or (None,)
        wrong = [p.name for p in others if p.kind is not p.KEYWORD_ONLY or p.default is p.empty]
        if wrong or not inspect.signature(detect).parameters:
            raise VisionError(f"detector '{name}': must take a view, and after a * parameters with defaults: def find(view, *, most=0.1)")
        taken = [word for word in (*slots, *(p.name for p in others)) if word in RESERVED]
        taken += [p.name for p in others if p.name in slots or p.name in finds.aliases]
        if taken:
            raise VisionError(f"detector '{name}': '{taken[0]}' is reserved in requests; use another name")
        builtin = (detect.__module__ or "").startswith("actr3d.")
        try:
            DETECTORS.add(name, Detector(finds, detect, tuple(p.name for p in others), builtin), detect.__module__)
        except ValueError as error:
            raise VisionError(f"{error}; rename the class {finds.__name__}") from None
        return detect

    return add
