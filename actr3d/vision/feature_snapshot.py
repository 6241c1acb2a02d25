"""The features that agents have found, with their places in the world: for observers only, not for agents."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

from actr3d.actr.kernel.model import Model
from actr3d.actr.kernel.tree import path_of, subtree
from actr3d.camera import CameraParameters, EyePose, EyeSense, View
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
    """Whether the search was bottom-up."""
    time: float
    """Time of the view [s]."""
    chosen: bool
    """Whether the search chose it. It then enters the buffer, unless the search is bottom-up and the buffer is protected by `hold`."""
    feature: Feature
    """What it has noticed."""
    view: View
    """The view in which it was found, with noise."""
    eye_pose: EyePose
    """The pose of the eye then."""

    @property
    def camera(self) -> CameraParameters:
        """The parameters of the eye."""
        return self.view.parameters

    @property
    def slots(self) -> dict[str, Any]:
        """The slots of its chunk: `feature`, labels, sizes in metres, angles in degrees."""
        return self.feature.slots()

    @property
    def corners(self) -> tuple[Place, Place, Place, Place]:
        """The corners of an upright rectangle of its size, perpendicular to the viewing direction: upper left, upper right, lower right,
        lower left [m, in the world's frame]. A feature with a height but no vertical position is centred at eye level; a size that
        is missing or infinite is 0.
        """
        feature, (x, y, z, heading) = self.feature, self.eye_pose
        way = heading + feature.direction
        width, half = _finite(getattr(feature, "width", 0.0)), _finite(getattr(feature, "height", 0.0)) / 2
        top, bottom = _finite(getattr(feature, "top", half)), _finite(getattr(feature, "bottom", -half))
        aside = -0.5 * width * math.sin(way), 0.5 * width * math.cos(way)
        at = x + feature.distance * math.cos(way), y + feature.distance * math.sin(way)
        left, right = (at[0] + aside[0], at[1] + aside[1]), (at[0] - aside[0], at[1] - aside[1])
        return (*left, z + top), (*right, z + top), (*right, z + bottom), (*left, z + bottom)


def visions(agent: Model) -> list[Vision]:
    """Returns all vision modules of an agent and of the agents in it."""
    return [part for part in subtree(agent) if isinstance(part, Vision)]


def sightings(agent: Model, body: Body) -> list[Sighting]:
    """Returns the features that the last searches of all vision modules of an agent have noticed, chosen or not; it changes nothing.

    Args:
        agent: The agent of the body, or an agent in it.
        body: Its body.
    """
    eyes = [sense for sense in body.senses if isinstance(sense, EyeSense)]
    return [sighting for module in visions(agent) for sighting in _of(module, eyes)]


def _of(module: Vision, eyes: list[EyeSense]) -> Iterator[Sighting]:
    for search in module.searches:
        view, perceived = search.view, search.perceived
        if view is None or perceived is None:
            continue  # it has begun again, and has no view yet
        eye_pose = next((pose for eye in eyes if (pose := eye.pose_of(view)) is not None), None)
        if eye_pose is None:
            continue  # the view of another body
        for number, feature in enumerate(search.noticed):
            yield Sighting(
                module=path_of(module),
                bottom_up=search.bottom_up,
                time=search.seen / 1e6,
                chosen=number == search.chosen,
                feature=feature,
                view=perceived,
                eye_pose=eye_pose,
            )


def _finite(value: Any) -> float:
    return float(value) if isinstance(value, (int, float)) and math.isfinite(value) else 0.0
