"""Obstacles: all visible objects up to an angle from straight ahead."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any, ClassVar, Self

import numpy as np
from annotated_types import Ge

from actr3d.camera import View
from actr3d.vision.detectors.registry import detector
from actr3d.vision.feature import Feature
from actr3d.vision.kernel import detect
from actr3d.vision.kernel.surfaces import SURFACE
from actr3d.vision.units import Label, Metres, MetresPerSecond, Radians, Seconds


@dataclass(frozen=True, kw_only=True)
class Obstacle(Feature):
    """The visible part of an object. `distance` and `direction` are those of its nearest point within `bearing`."""

    salience: ClassVar[str] = "nearness"
    default_comparisons: ClassVar[Mapping[str, str]] = {
        "distance": "<=",
        "time_to_contact": "<=",
        "aside": "<=",
        "width": ">=",
        "height": ">=",
    }
    aliases: ClassVar[Mapping[str, str]] = {"radius": "distance"}

    width: Metres
    """Between its leftmost and its rightmost visible points, on the ground."""
    height: Metres
    """Between its uppermost and its lowest visible edges."""
    top: Metres
    """Its uppermost visible edge, above the eye."""
    bottom: Metres
    """Its lowest visible edge, above the eye, mostly below 0."""
    leftmost: Radians
    """The direction of its leftmost visible point."""
    rightmost: Radians
    """The direction of its rightmost visible point."""
    aside: Metres
    """Lateral distance of its nearest point from the line straight ahead. A body whose width is less than twice this distance passes it."""
    object: Label
    """The label of the object."""
    time_to_contact: Seconds | None = None
    """Its distance divided by the closing speed, from the given speed or since the last view; None if unknown, or if it
    does not come nearer."""

    def since(self, before: Feature, elapsed: float) -> Self:
        """Returns a copy with its motion, and the time to contact if no speed was given."""
        moved = super().since(before, elapsed)
        nearer = (before.distance - self.distance) / elapsed
        if self.time_to_contact is None and nearer > 0:
            return moved.with_values(time_to_contact=self.distance / nearer)
        return moved


@detector(Obstacle)
def obstacle(view: View, *, bearing: Annotated[Radians, Ge(0)] = math.pi, speed: MetresPerSecond | None = None) -> tuple[Obstacle, ...]:
    """Finds all objects that are visible within `bearing`, in the order of their labels.

    The nearest point is exact, except between two scan lines. If it is outside `bearing`, the surface between it and an edge on the same
    scan line is assumed to be straight.

    Args:
        view: The view.
        bearing: Greatest angle to the left and right of straight ahead.
        speed: Walking speed of the agent, below 0 backwards; None if unknown.
    """
    extents = view.extents
    points, surfaces, find = np.empty((len(extents), 3, 4)), np.empty(32, SURFACE), detect.surfaces()
    most = find(extents, view.optics, view.axes, bearing, points, surfaces)
    if most >= len(surfaces):
        surfaces = np.empty(most + 1, SURFACE)
        find(extents, view.optics, view.axes, bearing, points, surfaces)
    found: list[Any] = surfaces[: most + 1].tolist()
    return tuple(_obstacle(speed, *numbers) for numbers in found if numbers[1] < math.inf)


def _obstacle(
    speed: float | None,
    label: int,
    distance: float,
    ahead: float,
    aside: float,
    lefts: Any,
    rights: Any,
    top: float,
    bottom: float,
) -> Obstacle:
    direction = math.atan2(aside, ahead)
    nearer = 0.0 if speed is None else speed * math.cos(direction)
    return Obstacle(
        distance=distance,
        direction=direction,
        width=math.hypot(lefts[0] - rights[0], lefts[1] - rights[1]),
        height=top - bottom,
        top=top,
        bottom=bottom,
        leftmost=float(lefts[2]),
        rightmost=float(rights[2]),
        aside=abs(aside),
        object=label,
        time_to_contact=distance / nearer if nearer > 0 else None,
    )
