"""The change `push`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from annotated_types import Ge, Gt, Le

from actr3d.change import change
from actr3d.world.changes.world_change import WorldChange
from actr3d.world.world import World

MAX_FORCE = 1e5
"""Greatest force along an axis [N]."""


@change
@dataclass(frozen=True)
class PushObject(WorldChange):
    """Pushes a body or a loose object with a horizontal force for a time; the impulse is their product."""

    word = "push"
    of = "object"
    title = "Push"
    text = "{object} with {x}, {y} N for {time} s"

    object: str
    """The name of the body or object in the scene."""
    x: Annotated[float, Ge(-MAX_FORCE), Le(MAX_FORCE)]
    """Force along the world's x axis [N]."""
    y: Annotated[float, Ge(-MAX_FORCE), Le(MAX_FORCE)] = 0.0
    """Force along the world's y axis [N]."""
    time: Annotated[float, Gt(0), Le(60)] = 0.1
    """Duration [s]."""

    def carry_out(self, on: World) -> None:
        on.push(self.object, self.x, self.y, self.time)
