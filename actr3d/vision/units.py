"""Units: how numbers are inside, and how a person reads and writes them."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from typing import Annotated, Any, get_args, get_origin, get_type_hints


@dataclass(frozen=True)
class Unit:
    """What a number stands for.

    Args:
        name: What a person calls the unit.
        factor: How many of them 1 is inside.
        digits: How many decimals a chunk has.
    """

    name: str
    factor: float = 1.0
    digits: int = 3

    @property
    def measures(self) -> bool:
        """Whether it is of something measured, so that a whole number, too, is meant as one."""
        return self.name not in ("", "label", "True or False")

    def shown(self, value: float) -> float:
        """Returns a number as chunks have it."""
        return round(value * self.factor, self.digits) + 0.0  # no -0.0


METRE, DEGREE, SECOND, SPEED = Unit("m"), Unit("degrees", math.degrees(1.0), 1), Unit("s"), Unit("m/s")
LABEL = Unit("label", digits=0)
PLAIN = Unit("")
FLAG = Unit("True or False")

Metres = Annotated[float, METRE]
"""A length; chunks have it in millimetres' precision."""
Radians = Annotated[float, DEGREE]
"""An angle [rad]; chunks and requests have it in degrees, to a tenth."""
Seconds = Annotated[float, SECOND]
"""A time; chunks have it to the millisecond."""
MetresPerSecond = Annotated[float, SPEED]
"""A speed; chunks have it to the millimetre a second."""
Label = Annotated[int, LABEL]
"""An opaque label of an object, as a view has it; 0 stands for no object, and is left out of chunks."""


@cache
def units_of(thing: type | Callable[..., Any]) -> dict[str, Unit]:
    """Returns the units of a feature's fields, or of a detector's parameters, by name."""
    return {name: _unit_of(hint) for name, hint in get_type_hints(thing, include_extras=True).items()}


@cache
def bounds_of(function: Callable[..., Any]) -> dict[str, tuple[Any, ...]]:
    """Returns what stands beside the units in the types of a detector's parameters, such as `Ge(0)`, by name."""
    hints = get_type_hints(function, include_extras=True)
    return {name: get_args(hint)[1:] if get_origin(hint) is Annotated else () for name, hint in hints.items()}


def _unit_of(hint: Any) -> Unit:
    if hint is bool:
        return FLAG
    if get_origin(hint) is Annotated:
        return next((unit for unit in get_args(hint)[1:] if isinstance(unit, Unit)), PLAIN)
    return next((unit for unit in map(_unit_of, get_args(hint)) if unit is not PLAIN), PLAIN)
