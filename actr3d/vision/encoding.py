"""How long it takes to encode what is attended to, and when the eye moves to it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated

from annotated_types import Gt, Lt

from actr3d.configuration import Configuration

PREPARATION = 0.135
"""From a shift of attention until an eye movement can no longer be called off [s]. Source: EMMA (Salvucci 2001)."""
PROGRAMMING = 0.05
"""From then until the eye begins to move [s]. Source: the same."""
SACCADE, PER_DEGREE = 0.02, 0.002
"""How long the eye moves: 20 ms and 2 ms for each degree [s] [s/degree]. Source: the same (human-data)."""

LONGEST = 1e6
"""No encoding takes longer [s]: for what is far aside the equation tells of years, then of more than there are numbers."""
LARGEST = 700.0
"""The greatest exponent of which the exponential is a number."""


def saccade_time(angle: float) -> float:
    """Returns how long the eye moves over an angle [rad], in seconds."""
    return SACCADE + PER_DEGREE * math.degrees(abs(angle))


@dataclass(frozen=True, kw_only=True)
class Emma(Configuration):
    """Encoding that takes the longer the farther from the line of sight something is: K (-ln f) exp(k e).

    Source: EMMA, Salvucci (2001), Cognitive Systems Research 1: 201-220.
    """

    factor: Annotated[float, Gt(0)] = 0.006
    """K [s]. Source: human-data."""

    exponent: Annotated[float, Gt(0)] = 0.4
    """k [1/degree]. Source: human-data."""

    frequency: Annotated[float, Gt(0), Lt(1)] = 0.5
    """f, how frequent such things are. Ours, as ACT-R's EMMA has for things of which it knows none."""

    def encoding(self, eccentricity: float) -> float:
        """Returns how long encoding takes at an angle off the line of sight [rad], in seconds."""
        exponent = min(LARGEST, self.exponent * math.degrees(eccentricity))
        return min(LONGEST, -self.factor * math.log(self.frequency) * math.exp(exponent))

    def course(self, eccentricity: float) -> tuple[float, float | None]:
        """Returns when something is encoded, and when the eye begins to move to it, if it does [s from the shift of attention].

        Encoding and the preparation of an eye movement begin together. What is encoded before the movement is prepared needs none.
        Where the eye arrives first, what is left of the encoding goes on as fast as in the line of sight.
        """
        alone = self.encoding(eccentricity)
        if alone <= PREPARATION:
            return alone, None
        start = PREPARATION + PROGRAMMING
        landing = start + saccade_time(eccentricity)
        if alone <= landing:
            return alone, start
        return landing + (1 - landing / alone) * self.encoding(0.0), start
