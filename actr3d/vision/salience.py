"""Salience: the choice of one feature among several."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from numbers import Real
from random import Random
from typing import Any, Literal, TypeAlias, cast

from actr3d.configuration import is_finite
from actr3d.errors import VisionError, did_you_mean
from actr3d.vision.feature import Feature

NEARER = 0.1
"""Distance below which salience no longer grows [m]. Source: chosen, an arm's thickness."""

HUGE = 1e290

Function: TypeAlias = Callable[[Any], float]

KINDS: Mapping[str, Function] = {
    "size": lambda feature: feature.size,
    "nearness": lambda feature: 1.0 / max(feature.distance, NEARER),
    "motion": lambda feature: feature.motion or 0.0,
    "equal": lambda _: 1.0,
}
"""Kinds of salience by word: width times height [m²]; 1 / distance [1/m]; speed of the place [m/s]; 1."""

Rule: TypeAlias = Literal["share", "sos"]
"""Rules of choice: with probability s_i / sum(s); or each survives with probability s_i (at most 1), then one of those is drawn."""


def salience_of(given: Any, what: str) -> Function:
    """Returns the function of a word, or the given function.

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
        VisionError: If the function returns no number, or one below 0.
    """
    weights: list[float] = []
    for feature in features:
        value: Any = function(feature)
        if not isinstance(value, Real) or not is_finite(value) or float(value) < 0:
            raise VisionError(f"{what}: must return a number >= 0 (got {value!r} for {feature})")
        weights.append(float(value))
    return weights


def survivors(weights: Sequence[float], random: Random) -> list[int]:
    """Returns the indices that survive, each with its salience as probability; above 1 counts as 1."""
    return [i for i, weight in enumerate(weights) if random.random() < weight]


def share(weights: Sequence[float], random: Random) -> int:
    """Returns an index, drawn in proportion to its salience; if all are 0, with equal probability."""
    if len(weights) == 1:
        return 0
    most = max(weights)
    if most <= 0:
        return random.randrange(len(weights))
    if most > HUGE:  # their sum might overflow
        weights = [weight / most for weight in weights]
    total = math.fsum(weights)
    at = random.random() * total
    for i, weight in enumerate(weights):
        at -= weight
        if at < 0:
            return i
    return max(i for i, weight in enumerate(weights) if weight > 0)  # after rounding
