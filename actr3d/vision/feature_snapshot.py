"""What minds have found with their eyes, and where in the world that is: for who looks on; no mind gets this."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from actr3d.actr.model import Model
from actr3d.camera import CameraParameters, Sight, Stand, View
from actr3d.vision.feature import Feature
from actr3d.vision.module import Vision
from actr3d.world.body import Body

Place = tuple[float, float, float]


@dataclass(frozen=True, kw_only=True)
class Sighting:
    """A feature that the last search of an eye, top-down or bottom-up, has noticed."""

    module: str
    """The path of the vision module."""
    bottom_up: bool
    time: float
    """When it was seen [s]."""
    chosen: bool
    """Whether it is what the search brings to the buffer."""
    feature: Feature
    view: View
    """What it was found in, as that was misjudged."""
    stood: Stand
    """How the eye stood then."""

    @property
    def camera(self) -> CameraParameters:
        """How the eye sees."""
        return self.view.parameters

    @property
    def slots(self) -> dict[str, Any]:
        """What its chunk has: `feature`, labels, sizes in metres, angles in degrees."""
        return self.feature.slots()

    @property
    def corners(self) -> tuple[Place, Place, Place, Place]:
        """The corners of an upright rectangle as wide and as high as it is, square to the direction in which it is seen: upper left,
        upper right, lower right, lower left [m, in the world's frame]. What tells only its height has its middle as high as the
        eye; what has no size, or no finite one, has none here either.
        """
        feature, (x, y, z, heading) = self.feature, self.stood
        way = heading + feature.direction
        width, half = _finite(getattr(feature, "width", 0.0)), _finite(getattr(feature, "height", 0.0)) / 2
        top, bottom = _finite(getattr(feature, "top", half)), _finite(getattr(feature, "bottom", -half))
        aside = -0.5 * width * math.sin(way), 0.5 * width * math.cos(way)
        at = x + feature.distance * math.cos(way), y + feature.distance * math.sin(way)
        left, right = (at[0] + aside[0], at[1] + aside[1]), (at[0] - aside[0], at[1] - aside[1])
        return (*left, z + top), (*right, z + top), (*right, z + bottom), (*left, z + bottom)


def visions(mind: Model) -> list[Vision]:
    """Returns all vision modules of a mind, or of an agent in it."""
    return [part for part in mind._tree() if isinstance(part, Vision)]


def sightings(mind: Model, body: Body) -> list[Sighting]:
    """Returns what the last searches of all vision modules of a mind have noticed, what is brought or not; nothing of it changes.

    Args:
        mind: The mind, or an agent in it.
        body: Its body.
    """
    eyes = [sense for sense in body.senses if isinstance(sense, Sight)]
    return [sighting for module in visions(mind) for sighting in _of(module, eyes)]


def _of(module: Vision, eyes: list[Sight]) -> Iterator[Sighting]:
    for search in module.searches:
        view, perceived = search.view, search.perceived
        if view is None or perceived is None:
            continue  # it has begun anew, and not looked yet
        stood = next((stand for eye in eyes if (stand := eye.stood(view)) is not None), None)
        if stood is None:
            continue  # it was another body's
        for number, feature in enumerate(search.noticed):
            yield Sighting(
                module=module._path,
                bottom_up=search.bottom_up,
                time=search.seen / 1e6,
                chosen=number == search.chosen,
                feature=feature,
                view=perceived,
                stood=stood,
            )


def _finite(value: Any) -> float:
    return float(value) if isinstance(value, (int, float)) and math.isfinite(value) else 0.0
