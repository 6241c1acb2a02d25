"""The change `move`."""

from __future__ import annotations

from dataclasses import dataclass

from actr3d.change import change
from actr3d.world.changes.world_change import WorldChange
from actr3d.world.world import World


@change
@dataclass(frozen=True)
class MoveObject(WorldChange):
    """Puts a body, a wall or another object elsewhere at once; what moves keeps its posture, its height and its commands."""

    word = "move"
    of = "object"
    title = "Move"
    text = "{object} to {x}, {y} m"

    object: str
    """The name of the body or object in the scene."""
    x: float
    """[m]"""
    y: float
    """[m]"""
    heading: float | None = None
    """[rad]; None for its present heading."""

    def carry_out(self, on: World) -> None:
        on.move(self.object, self.x, self.y, self.heading)
