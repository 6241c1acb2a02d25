"""Features: what detectors find in a view, without names and meanings."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, fields
from functools import cache
from numbers import Real
from typing import Any, ClassVar, Self, cast

import numpy as np
from numpy.typing import NDArray

from actr3d.errors import VisionError
from actr3d.vision.units import LABEL, Metres, MetresPerSecond, Radians, units_of


@dataclass(frozen=True, kw_only=True)
class Feature:
    """One thing that was found; its fields become the slots of a chunk.

    A subclass is a frozen dataclass whose fields say their units by their types (`Metres`, `Radians`, `Seconds`, `Label`, …); its
    name, in small letters, is what requests call it. A field that is None, or a label of 0, is left out of the chunk.
    """

    bare: ClassVar[Mapping[str, str]] = {"distance": "<="}
    """What a bare number in a request means, by slot: `distance=2` is `distance='<=2'`. Slots that are not here need a sign."""
    aliases: ClassVar[Mapping[str, str]] = {}
    """Other words that requests may use for slots."""

    salience: ClassVar[str] = "equal"
    """What makes it salient, unless the vision module says otherwise; see `actr3d.vision.salience`."""

    distance: Metres
    """How far away on the ground: heights do not count."""
    direction: Radians
    """From straight ahead of the body's base, to the left."""
    motion: MetresPerSecond | None = None
    """How fast its place, as seen from the body, has changed since the last look; None where it was not seen then."""

    @classmethod
    def called(cls) -> str:
        """Returns what requests call it."""
        return cls.__name__.lower()

    def shown(self, slot: str) -> Any:
        """Returns what a chunk has in a slot, rounded and in the units that a person reads; None where it has no such slot."""
        value = getattr(self, slot)
        unit = units_of(type(self))[slot]
        if value is None or (unit is LABEL and value == 0):
            return None
        return unit.shown(value) if type(value) is float else value

    def slots(self) -> dict[str, Any]:
        """Returns what a chunk has of it."""
        shown = {name: self.shown(name) for name in slot_names(type(self))}
        return {"feature": self.called(), **{name: value for name, value in shown.items() if value is not None}}

    @property
    def key(self) -> tuple[Any, ...]:
        """What tells it apart from others of its kind, from look to look: its labels."""
        units = units_of(type(self))
        return tuple(getattr(self, name) for name in slot_names(type(self)) if units[name] is LABEL)

    @property
    def size(self) -> float:
        """How large it is [m²], for its salience: width times height, where it has them."""
        return float(getattr(self, "width", 0.0)) * float(getattr(self, "height", 0.0))

    @property
    def elevation(self) -> float:
        """How far above the level of the eye it is looked at [rad]: level, where it reaches there, else at its nearest end."""
        top, bottom = getattr(self, "top", 0.0), getattr(self, "bottom", 0.0)
        height = min(max(0.0, bottom), top) if bottom <= top else 0.0
        return math.atan2(height, self.distance)

    def at_most(self, slot: str, value: Any) -> Any:
        """Returns what a slot's value may be at most, for comparisons with `>`; more than the value where not all of it is seen."""
        return value

    def since(self, before: Feature, elapsed: float) -> Self:
        """Returns it with what is known from an earlier look, `elapsed` [s] ago."""
        x = self.distance * math.cos(self.direction) - before.distance * math.cos(before.direction)
        y = self.distance * math.sin(self.direction) - before.distance * math.sin(before.direction)
        return self._changed(motion=math.hypot(x, y) / elapsed)

    def _changed(self, **values: Any) -> Self:
        """Returns a copy with other values; as `replace` does, in a tenth of its time, for this is done at every look."""
        copy = object.__new__(type(self))
        copy.__dict__.update(self.__dict__)
        copy.__dict__.update(values)
        return copy


@cache
def slot_names(kind: type[Feature]) -> tuple[str, ...]:
    """Returns the slots that a chunk of a kind of features may have, besides `feature`."""
    return tuple(field.name for field in fields(kind))


def sound(feature: Any, kind: type[Feature]) -> Feature:
    """Returns what a modeller's detector has found, with plain numbers: no text and no thing may reach a chunk by it.

    Raises:
        VisionError: If it is no feature of a kind, or a field is neither a number nor True or False, or is no distance or direction.
    """
    name = kind.called()
    if not isinstance(feature, kind):
        raise VisionError(f"detector '{name}': must return features of the class {kind.__name__} (got {feature!r})")
    changed: dict[str, Any] = {}
    for slot in slot_names(kind):
        value: Any = getattr(feature, slot)
        if value is None and slot not in ("distance", "direction"):
            continue
        if not isinstance(value, (Real, np.bool_)) or value != value or (slot == "distance" and value < 0):
            least = " from 0 on" if slot == "distance" else ""
            raise VisionError(f"detector '{name}': {slot} must be a number{least} (got {value!r})")
        if units_of(kind)[slot].measures:
            changed[slot] = float(cast("Any", value))
        elif isinstance(value, np.generic):
            changed[slot] = value.item()
    return feature._changed(**changed) if changed else feature


def off_sight(axes: NDArray[np.float64], feature: Feature) -> tuple[float, float, float]:
    """Returns how far the eye would have to turn to look at a feature, to the left and up, and the angle between [rad].

    Args:
        axes: Those of the view, see `View.axes`.
        feature: Of the same view.
    """
    sight = axes[2]
    left = math.remainder(feature.direction - math.atan2(sight[1], sight[0]), 2 * math.pi)
    up = feature.elevation - math.asin(max(-1.0, min(1.0, float(sight[2]))))
    flat = math.cos(feature.elevation)
    way = np.array([flat * math.cos(feature.direction), flat * math.sin(feature.direction), math.sin(feature.elevation)])
    return left, up, math.atan2(float(np.linalg.norm(np.cross(sight, way))), float(sight @ way))
