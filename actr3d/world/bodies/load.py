"""A load that a mannequin carries in both hands."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

from actr3d.configuration import Configuration
from actr3d.errors import ConfigurationError
from actr3d.world.scene_objects import Colour, Length, Positive

_SIZES = {"bar": (2, "length and thickness"), "box": (3, "depth, width and height")}


@dataclass(frozen=True, kw_only=True)
class Load(Configuration):
    """A bar held crosswise, or a box, in front of the body with both hands; it counts as part of the body in contacts."""

    shape: Literal["bar", "box"] = "bar"
    """A bar has round ends; its length counts them."""

    size: tuple[Length, ...] = (1.0, 0.03)
    """Full sizes [m]: bar (length, thickness), box (depth, width, height) as seen by the holder."""

    mass: Positive = 1.0
    """[kg]; the arms carry its weight."""

    colour: Colour = (0.72, 0.53, 0.33, 1.0)
    """Red, green, blue, alpha in 0 to 1."""

    def __post_init__(self) -> None:
        """Checks the fields.

        Raises:
            ConfigurationError: If a field is wrong, there are too many or too few sizes, or a bar is thicker than long.
        """
        super().__post_init__()
        sizes, meaning = _SIZES[self.shape]
        if len(self.size) != sizes:
            raise ConfigurationError(f"Load.size: a {self.shape} takes {meaning} (got {self.size!r})")
        if self.shape == "bar" and self.size[0] < self.size[1]:
            raise ConfigurationError(f"Load.size: the length of a bar must be >= its thickness (got {self.size!r})")

    @property
    def width(self) -> float:
        """Width across the body [m]."""
        return self.size[0] if self.shape == "bar" else self.size[1]

    @property
    def height(self) -> float:
        """Height [m]."""
        return self.size[1] if self.shape == "bar" else self.size[2]

    @property
    def depth(self) -> float:
        """Depth [m]."""
        return self.size[1] if self.shape == "bar" else self.size[0]
