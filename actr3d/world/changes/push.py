"""The change `push`."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

from annotated_types import Ge, Gt, Le

from actr3d.change import Change, change
from actr3d.errors import ConfigurationError
from actr3d.world.objects import LONGEST, MAX_FORCE
from actr3d.world.world import World


@change
@dataclass(frozen=True)
class PushObject(Change):
    """Pushes a body or a loose object with a horizontal force for a time; the impulse is their product."""

    word = "push"
    of = "object"
    title = "Push"
    text = "{object} with {x}, {y} N for {time} s"

    object: str
    """The name of the body or object in the scene."""
    x: Annotated[float, Ge(-MAX_FORCE), Le(MAX_FORCE)]
    """Force along the x axis of the world [N]; at a heading of 0, a body faces along this axis."""
    y: Annotated[float, Ge(-MAX_FORCE), Le(MAX_FORCE)] = 0.0
    """Force along the y axis of the world [N]: to the left of the x axis, seen from above."""
    time: Annotated[float, Gt(0), Le(LONGEST)] = 0.1
    """Duration [s]."""

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.x == 0 and self.y == 0:
            raise ConfigurationError("PushObject.x: must not be 0 if y is 0 too: that is no push")

    def carry_out(self, on: World) -> None:
        on.push(self.object, self.x, self.y, self.time)
