"""A trial at an aperture as the analysis reads it, and the baseline model."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

DEPTH = 0.563
"""The depth of the chest as a fraction of the shoulder width. Source: ANSUR II (2012), 0.25 m at 0.444 m."""
ROOM = 0.30
"""The room on both sides together as a fraction of the shoulder width. Source: Warren & Whang (1987), critical ratio 1.30."""
TURNED = 5.0
"""A walker has turned if its angle is above this [degrees]: people sway by a few degrees (docs/human-data.md).
Source: chosen for this library."""


@dataclass(frozen=True, kw_only=True, slots=True)
class Passing:
    """One trial at an aperture."""

    participant: str
    group: str
    condition: str
    """The speed condition, such as `normal` or `fast`; empty if the design has none."""
    aperture: float
    """[m]"""
    shoulders: float
    """The shoulder width [m]."""
    angle: float | None
    """The angle of the shoulders at the wall [degrees]; if the walker did not get there, its greatest one; None if it did not set
    out."""
    left: float | None
    """The smallest distance to the left segment of the wall while in the doorway [m]."""
    right: float | None
    """The same on the right [m]."""
    contacts: int
    passed: bool
    bar: float | None = None
    """The length of a bar in the hands [m]."""
    straight: bool = True
    """Whether the walk begins in line with the doorway."""

    @property
    def turned(self) -> bool:
        """Whether the walker turned."""
        return self.angle is not None and self.angle > TURNED

    @property
    def ratio(self) -> float:
        """The aperture divided by the shoulder width."""
        return self.aperture / self.shoulders

    @property
    def bar_ratio(self) -> float:
        """The length of the bar divided by the shoulder width, but at least 1: a shorter one does not stand out."""
        return max(1.0, (self.bar or 0.0) / self.shoulders)

    @property
    def total_ratio(self) -> float:
        """The aperture divided by the width of body and bar."""
        return self.ratio / self.bar_ratio


def baseline_angle(ratio: Sequence[float] | NDArray[np.float64], bar: float = 1.0) -> NDArray[np.float64]:
    """Returns the angle of one line of geometry [degrees]: that at which an ellipse of the shoulder width and the depth of the chest has
    the width of the aperture without the room that people keep. It is 0 from the ratio 1.30 on, and 90 where it does not fit.

    Args:
        ratio: The ratios of aperture to shoulder width, (n,).
        bar: The length of a thin bar in the hands, in shoulder widths; it turns with the body, and keeps the same room.
    """
    free = np.asarray(ratio, dtype=float) - ROOM
    body = np.degrees(np.arccos(np.sqrt((np.clip(free, DEPTH, 1.0) ** 2 - DEPTH**2) / (1 - DEPTH**2))))
    return np.maximum(body, np.degrees(np.arccos(np.clip(free / max(bar, 1.0), 0.0, 1.0)))) if bar > 1 else body
