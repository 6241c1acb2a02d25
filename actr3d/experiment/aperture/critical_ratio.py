"""The ratio of aperture to shoulder width below which a walker turns: a logistic fit, and a piecewise-linear fit with a baseline."""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from statistics import pvariance

import numpy as np
from scipy.special import stdtrit

STEEPEST = 200.0
"""The greatest slope of the logistic curve per unit of the ratio: steeper ones cannot be distinguished."""
SHALLOWEST = 0.02
"""The least slope per unit of the ratio: with it, the probability of a turn is nearly the same at all ratios."""
STEPS = 401
"""The number of ratios at which the likelihood is computed, between the smallest and the largest of the trials."""
CHI_SQUARED = 3.841
"""The 95 % quantile of the chi-squared distribution with one degree of freedom."""


@dataclass(frozen=True, kw_only=True)
class CriticalRatio:
    """A critical ratio with its 95 % interval."""

    value: float
    """The smallest or the largest ratio of the trials if the critical one is most likely beyond it."""
    low: float
    """Minus infinity if the interval goes beyond the smallest ratio of the trials."""
    high: float
    """Infinity if it goes beyond the largest one."""
    beyond: bool
    """Whether the critical ratio is most likely smaller than the smallest ratio of the trials, or larger than the largest one: then the
    value is only a bound."""


Answer = tuple[float, bool]
"""The ratio of a trial, and whether the walker turned, or judged that it cannot pass without turning."""


def critical_ratio(trials: Iterable[Answer]) -> CriticalRatio | None:
    """Returns the ratio at which half of the trials are turned, by a logistic fit; None if all are, or none is.

    The interval is that of the profile likelihood. If all trials up to one ratio are turned, and none from the next ratio on, the critical
    one may be anywhere between the two: the value is their middle, and the interval includes both.

    Args:
        trials: The ratio of each trial, and whether the walker turned, which is more likely at small ratios.
    """
    counts: defaultdict[float, list[float]] = defaultdict(lambda: [0.0, 0.0])
    for ratio, yes in trials:
        counts[ratio][0] += float(yes)
        counts[ratio][1] += 1.0
    levels = sorted(counts)
    ratios = np.array(levels)
    turned, total = (np.array([counts[level][n] for level in levels]) for n in (0, 1))
    if not 0 < turned.sum() < total.sum():
        return None
    centres = np.linspace(levels[0], levels[-1], STEPS)
    profile = np.full(STEPS, -np.inf)
    for slope in (*np.geomspace(2.0, STEEPEST, 16)[::-1], *np.geomspace(2.0, SHALLOWEST, 64)[1:]):
        signed = slope * (ratios[None, :] - centres[:, None])
        likelihood = -(np.logaddexp(0.0, signed) @ turned) - np.logaddexp(0.0, -signed) @ (total - turned)
        profile = np.maximum(profile, likelihood)
        if likelihood.max() < profile.max() - CHI_SQUARED / 2:
            break  # the likelihood is concave in the slope: on all shallower ones it is smaller still
    best = profile.max()
    likely = profile >= best - 1e-3
    top: list[float] = centres[likely].tolist()
    inside = profile >= best - CHI_SQUARED / 2
    within: list[float] = centres[inside].tolist()
    low, high = -np.inf if inside[0] else within[0], np.inf if inside[-1] else within[-1]
    last, first = float(ratios[turned > 0].max()), float(ratios[turned < total].min())
    if last < first:  # a curve steeper than the steepest may be as near to either as one likes
        low, high = min(low, last), max(high, first)
    return CriticalRatio(value=(top[0] + top[-1]) / 2, low=low, high=high, beyond=bool(likely[0] or likely[-1]))


def critical_ratio_of_group(participants: Sequence[Sequence[Answer]]) -> CriticalRatio | None:
    """Returns the ratio at which half of all trials of some participants are turned, with an interval for other such people.

    Trials of one person are more alike than those of several. So the interval is that of all trials or, where this is wider, that of the
    jackknife: of how much the ratio changes without each of the participants (Student's t).

    Args:
        participants: The trials of each participant, as for `critical_ratio`.
    """
    found = critical_ratio(trial for one in participants for trial in one)
    if found is None or found.beyond or len(participants) < 2:
        return found  # an interval without an end on one side
    without = [
        critical_ratio(trial for one in (*participants[:n], *participants[n + 1 :]) for trial in one) for n in range(len(participants))
    ]
    values = [one.value for one in without if one is not None and not one.beyond]
    if len(values) < len(participants):
        return replace(found, low=-math.inf, high=math.inf)
    error = math.sqrt((len(values) - 1) * pvariance(values))
    low, high = t_interval(found.value, error, len(values) - 1)
    return replace(found, low=min(found.low, low), high=max(found.high, high))


def t_interval(value: float, error: float, freedom: float) -> tuple[float, float]:
    """Returns the ends of the 95 % interval of a value, by Student's t.

    Args:
        value: The value.
        error: Its standard error.
        freedom: The degrees of freedom of the standard error.
    """
    half = float(stdtrit(freedom, 0.975)) * error
    return value - half, value + half


def bend(ratios: Sequence[float], angles: Sequence[float]) -> float | None:
    """Returns the ratio at which angles stop falling to a baseline; None with fewer than four ratios, or if they do not fall.

    It is `x` of the piecewise-linear fit `baseline + slope * max(0, x - ratio)` with a slope > 0 and the least squares.
    A rotation that falls more steeply near its end than before, as that of a body that just fits, makes it too large.

    Args:
        ratios: The ratios of aperture to shoulders.
        angles: The angle at each [degrees].
    """
    x, y = np.asarray(ratios, dtype=float), np.asarray(angles, dtype=float)
    if len(np.unique(x)) < 4:
        return None
    best: tuple[float, float] | None = None
    places: list[float] = np.linspace(min(ratios), max(ratios), STEPS).tolist()
    for at in places[1:]:
        fall = np.maximum(0.0, at - x)
        design = np.column_stack([np.ones_like(x), fall])
        (base, slope), *_ = np.linalg.lstsq(design, y, rcond=None)
        error = float(np.sum((y - base - slope * fall) ** 2))
        if slope > 0 and (best is None or error < best[0] - 1e-9):
            best = error, at
    return None if best is None else best[1]
