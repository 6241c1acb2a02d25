"""Salience: which of several features draws attention."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from numbers import Real
from random import Random
from typing import Any, TypeAlias, cast

from actr3d.configuration import is_finite
from actr3d.errors import VisionError, did_you_mean
from actr3d.vision.feature import Feature

NEARER = 0.1
"""Nearer than this nothing gets more salient for it [m]. Ours: an arm's thickness."""

HUGE = 1e290

Function: TypeAlias = Callable[[Any], float]

KINDS: Mapping[str, Function] = {
    "size": lambda feature: feature.size,
    "nearness": lambda feature: 1.0 / max(feature.distance, NEARER),
    "motion": lambda feature: feature.motion or 0.0,
    "equal": lambda _: 1.0,
}
"""What may be said of salience in a word: width times height [m²]; 1 / distance [1/m]; how fast the place changes [m/s]; 1."""

RULES = ("share", "sos")
"""How one is chosen: with probability s_i / sum(s); or each survives with probability s_i (at most 1), then one of those is drawn."""


def salience_of(given: Any, what: str) -> Function:
    """Returns the function that a word stands for, or the modeller's own.

    Raises:
        VisionError: If it is neither.
    """
    if callable(given):
        return cast("Function", given)
    if isinstance(given, str) and given in KINDS:
        return KINDS[given]
    near = did_you_mean(given, KINDS) if isinstance(given, str) else ""
    raise VisionError(f"{what}: must be one of {', '.join(KINDS)}, or a function of a feature (got {given!r}){near}")


def weigh(features: Sequence[Feature], function: Function, what: str) -> list[float]:
    """Returns the salience of each feature.

    Raises:
        VisionError: If the function gives what is no number, or one below 0.
    """
    weights: list[float] = []
    for feature in features:
        value: Any = function(feature)
        if not isinstance(value, Real) or not is_finite(value) or float(value) < 0:
            raise VisionError(f"{what}: must give a number from 0 on for a feature (gave {value!r} for {feature})")
        weights.append(float(value))
    return weights


def survivors(weights: Sequence[float], random: Random) -> list[int]:
    """Returns which of several things survive, each with its salience as probability; above 1 counts as 1."""
    return [i for i, weight in enumerate(weights) if random.random() < weight]


def share(weights: Sequence[float], random: Random) -> int:
    """Returns one of several things, drawn with the share of its salience in all; where none has any, each as likely."""
    if len(weights) == 1:
        return 0
    most = max(weights)
    if most <= 0:
        return random.randrange(len(weights))
    if most > HUGE:  # their sum might be more than there are numbers
        weights = [weight / most for weight in weights]
    total = math.fsum(weights)
    at = random.random() * total
    for i, weight in enumerate(weights):
        at -= weight
        if at < 0:
            return i
    return max(i for i, weight in enumerate(weights) if weight > 0)  # what rounding left over
