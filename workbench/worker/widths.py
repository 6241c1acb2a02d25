"""Computes the widths to which a slider can set doorways."""

from __future__ import annotations

import math
from collections.abc import Iterable

from actr3d.parameter_schema import Parameter

WIDEST = 300
"""Default maximum width of a doorway [cm], if no parameter limits it. Chosen here."""


def widths(apertures: Iterable[str], parameters: Iterable[Parameter]) -> dict[str, tuple[int, int]]:
    """Returns the minimum and maximum width of each doorway [cm], from the bounds of the parameter that sets doorways."""
    setting = [one for one in parameters if one.live is not None and one.live.word == "aperture"]
    least = [math.ceil(100 * one.least) for one in setting if one.least is not None]
    least += [math.floor(100 * one.above) + 1 for one in setting if one.above is not None]
    most = [math.floor(100 * one.most) for one in setting if one.most is not None]
    most += [math.ceil(100 * one.below) - 1 for one in setting if one.below is not None]
    bounds = max(least, default=0), min(most, default=WIDEST)
    return dict.fromkeys(apertures, bounds)
