"""Time to encode an attended feature, and time of the eye movement to it."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated

from annotated_types import Gt, Lt

from actr3d.configuration import Configuration
from actr3d.world.actuators.motion import saccade_time

PREPARATION = 0.135
"""Duration of the labile stage of an eye movement: until then it can still be cancelled [s]. Source: EMMA (Salvucci 2001)."""
PROGRAMMING = 0.05
"""Duration of the non-labile stage, from the end of `PREPARATION` to the start of the eye movement [s]. Source: the same."""

LONGEST = 1e6
"""Upper bound of encoding [s]: for large angles the equation gives years, and then overflows."""
LARGEST = 700.0
"""Greatest exponent without an overflow."""


@dataclass(frozen=True, kw_only=True)
class Emma(Configuration):
    """Encoding whose time grows with the angle from the line of sight: K (-ln f) exp(k e).

    Source: EMMA, Salvucci (2001), Cognitive Systems Research 1: 201-220.
    """

    factor: Annotated[float, Gt(0)] = 0.006
    """K [s]. Source: docs/human-data.md."""

    exponent: Annotated[float, Gt(0)] = 0.4
    """k [1/degree]. Source: docs/human-data.md."""

    frequency: Annotated[float, Gt(0), Lt(1)] = 0.5
    """f, the frequency of the encoded objects, between 0 and 1. Source: chosen, the value of ACT-R's EMMA for objects of unknown
    frequency."""

    def encoding(self, eccentricity: float) -> float:
        """Returns the time of encoding at an angle off the line of sight [rad], in seconds."""
        exponent = min(LARGEST, self.exponent * math.degrees(eccentricity))
        return min(LONGEST, -self.factor * math.log(self.frequency) * math.exp(exponent))

    def course(self, eccentricity: float) -> tuple[float, float | None]:
        """Returns the end of encoding, and the start of the eye movement or None [s from the shift of attention].

        Encoding and the preparation of an eye movement begin together. If encoding ends before the preparation, the eye does not move. If
        the eye arrives first, the rest of the encoding continues at the rate for an eccentricity of 0.
        """
        alone = self.encoding(eccentricity)
        if alone <= PREPARATION:
            return alone, None
        start = PREPARATION + PROGRAMMING
        landing = start + saccade_time(eccentricity)
        if alone <= landing:
            return alone, start
        return landing + (1 - landing / alone) * self.encoding(0.0), start
