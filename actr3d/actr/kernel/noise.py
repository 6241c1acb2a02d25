"""Random draws and sums that give the same numbers on every version of Python."""

from __future__ import annotations

import math
import random
from collections.abc import Iterable
from typing import Any, TypeVar

Option = TypeVar("Option")


def pick(numbers: random.Random, options: list[Option]) -> Option:
    """Draws one of several options; always uses the same random numbers as `random.choice`."""
    if len(options) > 1:
        return numbers.choice(options)
    while numbers.getrandbits(1):
        pass
    return options[0]


def logistic_noise(numbers: Any, scale: float) -> float:
    """Draws from the logistic distribution with mean 0 and variance pi^2 scale^2 / 3.

    Source: ACT-R's activation noise; one random number is used up whatever the scale.
    """
    x = numbers.random()
    while x == 0.0:
        x = numbers.random()
    return scale * math.log(1.0 / x - 1.0)


def duration(model: Any, mean: float, sd: float | None) -> float:
    """Draws a duration from the normal distribution with a model's random numbers, at least 0 [s]; without a standard deviation it is the
    mean."""
    return mean if sd is None else max(0.0, model.random.gauss(mean, sd))


def total(parts: Iterable[float], start: float = 0) -> float:
    """Adds numbers one by one; `sum` rounds differently from Python 3.12 on, and a model must give the same numbers everywhere."""
    for part in parts:
        start += part
    return start
