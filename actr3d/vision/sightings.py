"""What minds have found with their eyes, and where in the world that is: for who looks on; no mind gets this."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from actr3d.actr.model import Model
from actr3d.camera import CameraParameters, Sight
from actr3d.vision.feature import Feature
from actr3d.vision.module import Vision
from actr3d.world.body import Body

Place = tuple[float, float, float]


@dataclass(frozen=True, kw_only=True)
class Sighting:
    """A feature that the last search of an eye, top-down or bottom-up, has noticed."""

    module: str
    """The path of the vision module."""
    camera: CameraParameters
    """How its eye sees."""
    bottom_up: bool
    time: float
    """When it was seen [s]."""
    chosen: bool
    """Whether it is what the search brings to the buffer."""
    slots: dict[str, Any]
    """What its chunk has: `feature`, labels, sizes in metres, angles in degrees."""
    corners: tuple[Place, Place, Place, Place]
    """The corners of an upright rectangle as wide and as high as it is, square to the direction in which it is seen: upper left,
    upper right, lower right, lower left [m, in the world's frame]. What has no height is as high as the eye."""


def sightings(mind: Model, body: Body) -> list[Sighting]:
    """Returns what the last searches of all vision modules of a mind have noticed, what is brought or not; nothing of it changes.

    Args:
        mind: The mind, or an agent in it.
        body: Its body.
    """
    return [sighting for part in mind._tree() if isinstance(part, Vision) for sighting in _of(part, body)]


def _of(module: Vision, body: Body) -> Iterator[Sighting]:
    parameters = CameraParameters.from_mapping(module._camera)
    sight = next((sense for sense in body.senses if isinstance(sense, Sight) and sense.parameters == parameters), None)
    if sight is None or sight.stood is None:
        return  # it has not looked yet, or not since the run went back
    for bottom_up, search in sorted(module._last.items()):
        for number, feature in enumerate(search.noticed):
            yield Sighting(
                module=module._path,
                camera=parameters,
                bottom_up=bottom_up,
                time=search.seen / 1e6,
                chosen=number == search.chosen,
                slots=feature.slots(),
                corners=_corners(feature, sight.stood),
            )


def _corners(feature: Feature, stood: tuple[float, float, float, float]) -> tuple[Place, Place, Place, Place]:
    x, y, z, heading = stood
    way = heading + feature.direction
    half = 0.5 * float(getattr(feature, "width", 0.0))
    ahead, aside = (math.cos(way), math.sin(way)), (-half * math.sin(way), half * math.cos(way))
    at = x + feature.distance * ahead[0], y + feature.distance * ahead[1]
    top, bottom = z + float(getattr(feature, "top", 0.0)), z + float(getattr(feature, "bottom", 0.0))
    left, right = (at[0] + aside[0], at[1] + aside[1]), (at[0] - aside[0], at[1] - aside[1])
    return (*left, top), (*right, top), (*right, bottom), (*left, bottom)
