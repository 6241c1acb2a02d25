"""Features: what detectors find in a view, without names and meanings."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, fields
from numbers import Real
from typing import Any, ClassVar, Self, cast

import numpy as np
from numpy.typing import NDArray

from actr3d.actr.kernel.read_attributes import reads
from actr3d.errors import VisionError
from actr3d.vision.units import LABEL, Metres, MetresPerSecond, Radians, units_of
from actr3d.weak_cache import weak_cache
from actr3d.world.frames import wrapped


@reads("bottom", "height", "top", "width", of_itself=True)
@dataclass(frozen=True, kw_only=True)
class Feature:
    """A found feature; its fields become the slots of a chunk.

    A subclass is a frozen dataclass whose fields have their units in their types (`Metres`, `Radians`, `Seconds`, `Label`, …); its
    name, in lower case, is its name in requests. A field that is None, or a label of 0, is left out of the chunk.
    """

    default_comparisons: ClassVar[Mapping[str, str]] = {"distance": "<="}
    """The comparison of a number without a sign in a request, by slot: `distance=2` is `distance='<=2'`. Other slots need a sign."""
    aliases: ClassVar[Mapping[str, str]] = {}
    """Other names of slots in requests."""

    salience: ClassVar[str] = "equal"
    """Its default salience; see `actr3d.vision.salience`."""

    distance: Metres
    """Horizontal distance from the eye; differences of height are ignored."""
    direction: Radians
    """Direction from straight ahead of the body's base, to the left."""
    motion: MetresPerSecond | None = None
    """Mean speed of its position relative to the eye since the last view, in the body's frame; None if it was not visible then."""

    @classmethod
    def called(cls) -> str:
        """Returns its name in requests."""
        return cls.__name__.lower()

    def shown(self, slot: str) -> Any:
        """Returns a slot's value in a chunk, rounded and in readable units; None if the chunk has no such slot."""
        value = getattr(self, slot)
        unit = units_of(type(self))[slot]
        if value is None or (unit is LABEL and value == 0):
            return None
        return unit.shown(value) if type(value) is float else value

    def slots(self) -> dict[str, Any]:
        """Returns the slots of its chunk."""
        shown = {name: self.shown(name) for name in slot_names(type(self))}
        return {"feature": self.called(), **{name: value for name, value in shown.items() if value is not None}}

    @property
    def key(self) -> tuple[Any, ...]:
        """Its labels, by which it is found again in the next view."""
        units = units_of(type(self))
        return tuple(getattr(self, name) for name in slot_names(type(self)) if units[name] is LABEL)

    @property
    def size(self) -> float:
        """Size [m²], for its salience: width times height, if it has them."""
        return float(getattr(self, "width", 0.0)) * float(getattr(self, "height", 0.0))

    @property
    def elevation(self) -> float:
        """Angle above eye level at which the eye looks at it [rad]: 0 if it reaches eye level, otherwise that of its nearest end."""
        top, bottom = getattr(self, "top", 0.0), getattr(self, "bottom", 0.0)
        height = min(max(0.0, bottom), top) if bottom <= top else 0.0
        return math.atan2(height, self.distance)

    def at_most(self, slot: str, value: Any) -> Any:
        """Returns the upper bound of a slot's value, for comparisons with `>`; greater than the value if it is partly hidden."""
        return value

    def since(self, before: Feature, elapsed: float) -> Self:
        """Returns a copy with its change since an earlier view, `elapsed` [s] ago."""
        x = self.distance * math.cos(self.direction) - before.distance * math.cos(before.direction)
        y = self.distance * math.sin(self.direction) - before.distance * math.sin(before.direction)
        return self.with_values(motion=math.hypot(x, y) / elapsed)

    def with_values(self, **values: Any) -> Self:
        """Returns a copy with other values; like `replace`, in a tenth of its time, because every view needs it."""
        copy = object.__new__(type(self))
        vars(copy).update(vars(self), **values)
        return copy


@weak_cache
def slot_names(kind: type[Feature]) -> tuple[str, ...]:
    """Returns the names of a kind's slots besides `feature`."""
    return tuple(field.name for field in fields(kind))


def checked(feature: Any, kind: type[Feature]) -> Feature:
    """Returns a feature of a modeller's detector with plain numbers: no text and no object may enter a chunk this way.

    Raises:
        VisionError: If it is not a feature of the kind, or a field is neither a number nor True or False, or the distance is
            negative.
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
            least = " >= 0" if slot == "distance" else ""
            raise VisionError(f"detector '{name}': {slot}: must be a number{least} (got {value!r})")
        if units_of(kind)[slot].measures:
            changed[slot] = float(cast("Any", value))
        elif isinstance(value, np.generic):
            changed[slot] = value.item()
    return feature.with_values(**changed) if changed else feature


def off_sight(axes: NDArray[np.float64], feature: Feature) -> tuple[float, float, float]:
    """Returns the turn of the eye to a feature (left, up), and its eccentricity [rad].

    Args:
        axes: The axes of the view, see `View.axes`.
        feature: A feature of the same view.
    """
    sight = axes[2]
    left = wrapped(feature.direction - math.atan2(sight[1], sight[0]))
    up = feature.elevation - math.asin(max(-1.0, min(1.0, float(sight[2]))))
    flat = math.cos(feature.elevation)
    way = np.array([flat * math.cos(feature.direction), flat * math.sin(feature.direction), math.sin(feature.elevation)])
    return left, up, math.atan2(float(np.linalg.norm(np.cross(sight, way))), float(sight @ way))
