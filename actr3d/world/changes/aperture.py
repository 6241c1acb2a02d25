"""The change `aperture`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, Any

from annotated_types import Ge

from actr3d.change import Change, change
from actr3d.world.world import World


@change
@dataclass(frozen=True)
class SetAperture(Change):
    """Sets the free width of an aperture."""

    word = "aperture"
    of = "aperture"
    title = "Set the width"
    text = "{name} {width} m"

    width: Annotated[float, Ge(0)]
    """The free width [m]."""
    name: str = "aperture"
    """The aperture."""

    @classmethod
    def present(cls, on: World, named: Mapping[str, Any]) -> dict[str, Any]:
        return {"width": on.aperture_width(named["name"])}

    def carry_out(self, on: World) -> None:
        on.set_aperture_width(self.width, self.name)
