"""The change `move`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any

from annotated_types import Ge, Le

from actr3d.change import Change, change
from actr3d.world.objects import FARTHEST
from actr3d.world.scene_objects import Heading
from actr3d.world.world import World


@change
@dataclass(frozen=True)
class MoveObject(Change):
    """Puts a body, a wall or another object elsewhere at once; what moves keeps its posture, its height and its commands."""

    word = "move"
    of = "object"
    title = "Move"
    text = "{object} to {x}, {y} m"

    object: str
    """The name of the body or object in the scene."""
    x: Annotated[float, Ge(-FARTHEST), Le(FARTHEST)]
    """The place along the x axis of the world [m]; at a heading of 0, a body faces along this axis."""
    y: Annotated[float, Ge(-FARTHEST), Le(FARTHEST)]
    """The place along the y axis of the world [m]: to the left of the x axis, seen from above."""
    heading: Heading | None = None
    """The angle from the x axis of the world to the left [rad]; empty: it keeps its heading."""

    @classmethod
    def present(cls, on: World, named: Mapping[str, Any]) -> dict[str, Any]:
        return dict(zip(("x", "y", "heading"), on.objects.pose(named["object"]), strict=True))

    def carry_out(self, on: World) -> None:
        on.move(self.object, self.x, self.y, self.heading)
