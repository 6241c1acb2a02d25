"""Units: conversion of numbers between internal values and chunks."""

from __future__ import annotations

import math
import re
from collections.abc import Callable
from dataclasses import dataclass
from inspect import get_annotations
from typing import Annotated, Any, get_args, get_origin, get_type_hints

from actr3d.errors import VisionError, did_you_mean
from actr3d.weak_cache import weak_cache


@dataclass(frozen=True)
class Unit:
    """The unit of a number.

    Args:
        name: Its name in messages.
        factor: Factor from internal values to values in chunks.
        digits: Number of decimals in a chunk.
    """

    name: str
    factor: float = 1.0
    digits: int = 3

    @property
    def measures(self) -> bool:
        """Whether it is a unit of measurement, so that integers become floats."""
        return self.name not in ("", "label", "True or False")

    def shown(self, value: float) -> float:
        """Returns a number for a chunk."""
        return round(value * self.factor, self.digits) + 0.0  # no -0.0


METRE, DEGREE, SECOND, SPEED = Unit("m"), Unit("degrees", math.degrees(1.0), 1), Unit("s"), Unit("m/s")
LABEL = Unit("label", digits=0)
PLAIN = Unit("")
FLAG = Unit("True or False")

Metres = Annotated[float, METRE]
"""A length; rounded to millimetres in chunks."""
Radians = Annotated[float, DEGREE]
"""An angle [rad]; in degrees, rounded to a tenth, in chunks and requests."""
Seconds = Annotated[float, SECOND]
"""A time; rounded to milliseconds in chunks."""
MetresPerSecond = Annotated[float, SPEED]
"""A speed; rounded to millimetres per second in chunks."""
Label = Annotated[int, LABEL]
"""An opaque label of an object in a view; 0 means no object, and is left out of chunks."""

UNITS = ("Metres", "Radians", "Seconds", "MetresPerSecond", "Label")
"""The names of these types, for hints."""


@weak_cache
def units_of(thing: type | Callable[..., Any]) -> dict[str, Unit]:
    """Returns the units of a feature's fields, or of a detector's parameters, by name."""
    return {name: _unit_of(hint) for name, hint in types_of(thing).items()}


@weak_cache
def bounds_of(function: Callable[..., Any]) -> dict[str, tuple[Any, ...]]:
    """Returns the bounds in the types of a detector's parameters, such as `Ge(0)`, by name."""
    return {name: get_args(hint)[1:] if get_origin(hint) is Annotated else () for name, hint in types_of(function).items()}


def types_of(thing: type | Callable[..., Any]) -> dict[str, Any]:
    """Returns the types of a feature's fields, or of a detector's parameters, by name.

    Raises:
        VisionError: If one of them is an unknown name.
    """
    try:
        return get_type_hints(thing, include_extras=True)
    except NameError as error:
        unknown = error.name or ""
        places = [name for name, hint in get_annotations(thing).items() if unknown in re.findall(r"\w+", str(hint))]
        of = "".join(f".{name}" if isinstance(thing, type) else f"({name})" for name in places[:1])
        raise VisionError(f"detector: {thing.__name__}{of}: {error}{did_you_mean(unknown, UNITS)}") from None


def _unit_of(hint: Any) -> Unit:
    if hint is bool:
        return FLAG
    if get_origin(hint) is Annotated:
        return next((unit for unit in get_args(hint)[1:] if isinstance(unit, Unit)), PLAIN)
    return next((unit for unit in map(_unit_of, get_args(hint)) if unit is not PLAIN), PLAIN)
