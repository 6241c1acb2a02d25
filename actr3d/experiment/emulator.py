"""What a model's means would be at values of its parameters that were not tried: a Gaussian process through those that were.

From it come the values that fit data best, and the intervals of the parameters. The interval of a parameter is a profile: all its values at
which S / S0 <= 1 + F / (n - p). S is the least sum of squared differences when all other parameters are free, S0 the least when all
parameters are free, and F the 95 % quantile of the F distribution with 1 and n - p degrees of freedom, for n means with normal errors of
one unknown variance and p parameters.
Sources: Bates and Watts (1988), Nonlinear Regression Analysis and Its Applications, section 6.1 (profile t); Raue et al. (2009),
Bioinformatics 25(15), for profile likelihoods; Rasmussen and Williams (2006), Gaussian Processes for Machine Learning, chapter 2.
"""

from __future__ import annotations

import warnings
from collections.abc import Sequence
from importlib import import_module
from typing import Any, cast

import numpy as np
from numpy.typing import NDArray
from scipy.special import stdtrit

Array = NDArray[np.float64]

STEPS = 200
"""The number of equal steps of each range in which values are compared."""
STARTS = 2**12
"""The number of points, drawn evenly, from the best of which the search for a minimum begins."""
DESCENTS = 15
"""The maximum number of steps of this search."""
STILL = 1e-7
"""The search ends when no point would move by more, as a part of the range."""
ZOOM, ZOOMS = 10, 5
"""The number of parts into which the step with the bound of an interval is divided, and how often values are compared."""
ROUNDING = 1e-6
"""The relative difference that a sum of squares may have if it is calculated again, together with other ones."""
SMOOTH = 5e-4
"""How much means without jumps scatter around what is predicted where they bend, at most: as a part of their variance over candidates."""
LEAST = 1e-10
"""The least sum of squares that differs from 0, as a part of the greatest squared difference of any mean of a candidate."""


class Emulator:
    """The sum of squared differences between a model's means and data, at all values of the parameters.

    Each mean is predicted on its own; all share how quickly they change along each parameter, and how noisy they are. Both are estimated.
    Where the nearest candidate is one at which the model failed, it is expected to fail, too: the sum of squares is infinite there.

    Args:
        points: The candidates, (n, p), each parameter from 0 to 1.
        means: Their means, (n, k).
        data: The means to fit, (k,).
        failed: The candidates at which the model failed, (f, p).
    """

    def __init__(self, points: Array, means: Array, data: Array, failed: Array | None = None) -> None:
        library: Any = import_module("sklearn.gaussian_process")  # here, because this takes a second
        kernels = library.kernels
        unit = float(np.abs(means - data).max()) or 1.0  # so that no square is too large for a float
        means, data, self._unit = means / unit, data / unit, unit
        self._middle: Array = means.mean(axis=0)
        deviation: Array = means.std(axis=0)
        deviation[deviation == 0] = 1.0
        self._points, self._data, self._axes = points, data, points.shape[1]
        self._failed = np.empty((0, self._axes)) if failed is None else failed
        lengths = kernels.RBF(np.full(self._axes, 0.5), (0.05, 20.0))
        kernel = kernels.ConstantKernel(1.0, (1e-2, 1e4)) * lengths + kernels.WhiteKernel(1e-6, (1e-10, 1.0))
        with warnings.catch_warnings(), _one_thread():
            warnings.simplefilter("ignore")  # that an estimate is at its bound: that of a straight line is
            process = library.GaussianProcessRegressor(kernel).fit(points, (means - self._middle) / deviation)
        self._lengths: Array = np.atleast_1d(process.kernel_.k1.k2.length_scale)
        pull: Array = process.alpha_.reshape(len(points), -1) * deviation
        self._weights: Array = process.kernel_.k1.k1.constant_value * pull
        around: Array = process.kernel_.k2.noise_level * pull  # how far the candidates' means are from what is predicted
        scatter: Array = np.einsum("nk,nk->n", around, around)
        self._scatter = float(scatter.mean())
        self.roughest: Array = points[int(np.argmax(scatter))]
        """The candidate whose means differ most from what is predicted there, (p,)."""
        self._bends = SMOOTH * float(np.sum(deviation**2))
        self._starts = np.vstack([points, np.random.default_rng(1).random((STARTS, self._axes))])
        self._start_squares = self._squares(self._starts)
        found, squares = self._descend(self._starts[np.argsort(self._start_squares)[: 4 * self._axes]], range(self._axes))
        best = int(np.argmin(squares))
        self.minimum: Array = found[best]
        """Where the sum of squares is least, (p,)."""
        free = len(data) - self._axes
        # The square of t has the F distribution with 1 and n - p degrees of freedom.
        self._factor = (1 + float(stdtrit(free, 0.975)) ** 2 / free if free > 0 else 1.0) * (1 + ROUNDING)
        self._most = self._factor * max(float(squares[best]), LEAST)
        differences = means - data
        tried = np.einsum("nk,nk->n", differences, differences)
        self._least = float(tried.min())
        self._good = points[tried <= self._most]
        near = free <= 0 or bool(np.any(self._squares(points) <= self._most))
        self.is_confirmed = len(points) > self._axes and near
        """Whether a candidate fits about as well as the minimum, but for the noise of its means; otherwise, the minimum is a guess. With no
        more means than parameters, nothing says how well that is: only what the model does at the minimum confirms it, see `agrees`."""

    def agrees(self, means: Array, errors: Array, errors_of_candidates: Array) -> bool:
        """Returns whether the model does as predicted: at the minimum it fits as well, no candidate fits better, and the means of all
        candidates scatter little around what is predicted.

        If not, they jump somewhere, and neither the minimum nor the intervals are to be trusted. What comes from chance in the model is
        left out.

        Args:
            means: The means of the model at the minimum, (k,).
            errors: Their standard errors, (k,).
            errors_of_candidates: Those of the candidates' means, (n, k).
        """
        squares = float(np.sum((means / self._unit - self._data) ** 2))
        chance = float(np.sum((2 * errors / self._unit) ** 2))
        of_candidates = float(np.sum((2 * errors_of_candidates / self._unit) ** 2)) / len(errors_of_candidates)
        allowed = max(self._most * (1 - 1 / self._factor) / 4, self._bends)
        fits = squares <= min(self._most, self._factor * max(self._least, LEAST)) + chance
        return fits and self._scatter <= allowed + of_candidates

    def interval(self, axis: int) -> tuple[float | None, float | None]:
        """Returns the bounds of the 95 % interval of a parameter; None where the range ends first or the model fails, and while the
        minimum is a guess.

        It contains all candidates that fit, also where the means jump and predictions do not follow. If values that fit are apart from
        each other, it contains what is between them.

        With few more means than parameters, an interval is wide, because the residual variance is uncertain. With no more means than
        parameters, this variance cannot be estimated, and both bounds are None.
        """
        if len(self._data) <= self._axes or not self.is_confirmed:
            return None, None
        low, high = self._bound(axis, upper=False)[1], self._bound(axis, upper=True)[1]
        good = self._good[:, axis].tolist()
        return None if low is None else min([low, *good]), None if high is None else max([high, *good])

    def bound(self, axis: int, *, upper: bool) -> Array:
        """Returns the point at a bound of the interval of a parameter, or at the end of its range, (p,): where a candidate says most
        about this bound."""
        return self._bound(axis, upper=upper)[0]

    def _bound(self, axis: int, *, upper: bool) -> tuple[Array, float | None]:
        """Returns the outermost point that fits, and the bound of the interval there; None if the range ends, or the model fails, there."""
        steps: Array = np.unique(np.append(np.linspace(0, 1, STEPS + 1), self.minimum[axis]))
        starts: Array = np.tile(self.minimum, (len(steps), 1))
        outermost = self.minimum
        from_worst = self._starts[np.argsort(self._start_squares)[::-1]]
        starts[np.searchsorted(steps, np.rint(from_worst[:, axis] * STEPS) / STEPS)] = from_worst  # the best near each step comes last
        starts[steps == self.minimum[axis]] = self.minimum
        is_end = False
        for _ in range(ZOOMS):
            values, squares = self._profile(axis, steps, starts)
            fits = (squares <= self._most) | (steps == outermost[axis])
            number = int(np.flatnonzero(fits)[-1 if upper else 0])
            outermost, beyond = values[number], number + (1 if upper else -1)
            if not 0 <= beyond < len(steps):
                is_end = float(outermost[axis]) in (0.0, 1.0)
                break
            is_end = not np.isfinite(squares[beyond])
            parts = np.linspace(0, 1, ZOOM + 1)[:: 1 if upper else -1, None]
            starts = outermost + parts * ((outermost if is_end else values[beyond]) - outermost)
            low, high = sorted([float(steps[number]), float(steps[beyond])])
            steps = np.linspace(low, high, ZOOM + 1)
        return outermost, None if is_end or self._is_beyond(float(outermost[axis]), axis, upper=upper) else float(outermost[axis])

    def _is_beyond(self, value: float, axis: int, *, upper: bool) -> bool:
        """Returns whether a value of a parameter is beyond all with which the model worked, on the way to one with which it failed."""
        way = 1 if upper else -1
        worked, failed, value = np.max(way * self._points[:, axis]), way * self._failed[:, axis], way * value
        return bool(value > worked) and bool(np.any((failed > worked) & (failed - value < 2 * (value - worked))))

    def _profile(self, axis: int, steps: Array, starts: Array) -> tuple[Array, Array]:
        """Returns the least sums of squares over all other parameters at some values of one, (m,), and where they are, (m, p).

        Args:
            axis: The parameter.
            steps: Its values, in order.
            starts: For each value, where the search begins.
        """
        others = [other for other in range(self._axes) if other != axis]
        starts[:, axis] = steps
        with _one_thread():
            values, squares = self._descend(starts, others)
            for shift in (1, -1, 1, -1) if others else ():  # along a valley, what is best at one step is a start for the next
                started = np.roll(values, shift, axis=0)
                started[:, axis] = steps
                found, theirs = self._descend(started, others)
                better = theirs < squares
                values[better], squares[better] = found[better], theirs[better]
        return values, squares

    def _predict(self, points: Array) -> tuple[Array, Array]:
        """Returns how far predicted means are from the data, (m, k), and the correlation of the points with the candidates, (m, n)."""
        here, there = points / self._lengths, self._points / self._lengths
        squares = np.sum(here**2, axis=1)[:, None] + np.sum(there**2, axis=1) - 2 * here @ there.T
        correlation = np.exp(-squares / 2)
        return correlation @ self._weights + self._middle - self._data, correlation

    def _squares(self, points: Array) -> Array:
        differences, _ = self._predict(points)
        squares = np.einsum("mk,mk->m", differences, differences)
        if len(self._failed):
            to_failed, to_others = (_least_distances(points, to) for to in (self._failed, self._points))
            squares[to_failed < to_others] = np.inf
        return squares

    def _descend(self, points: Array, axes: Sequence[int]) -> tuple[Array, Array]:
        """Moves points along some axes towards the least sum of squares near each of them, within 0 and 1: the Levenberg-Marquardt method.

        Returns:
            The points, (m, p), and their sums of squares, (m,).
        """
        points, squares, damping = points.copy(), self._squares(points), np.full(len(points), 1e-3)
        fixed = [axis for axis in range(self._axes) if axis not in axes]
        for _ in range(DESCENTS if len(axes) else 0):
            differences, correlation = self._predict(points)
            ways = (self._points.T - points[:, :, None]) / self._lengths[:, None] ** 2
            slopes = (correlation[:, None, :] * ways) @ self._weights
            slopes[:, fixed] = 0
            gradient = np.einsum("mpk,mk->mp", slopes, differences)
            at_end = ((points <= 0) & (gradient > 0)) | ((points >= 1) & (gradient < 0))
            slopes[at_end], gradient[at_end] = 0, 0
            curve = slopes @ slopes.transpose(0, 2, 1)
            scale = damping * np.trace(curve, axis1=1, axis2=2) + 1e-300
            damped = curve + scale[:, None, None] * np.eye(self._axes)
            step = cast("Array", np.linalg.solve(damped, gradient[:, :, None]))
            tried: Array = np.clip(points - step[:, :, 0], 0, 1)
            found = self._squares(tried)
            better = found < squares
            points[better], squares[better] = tried[better], found[better]
            damping = np.clip(np.where(better, damping / 5, damping * 5), 1e-12, 1e12)
            if np.all(np.abs(step) < STILL):
                break
        return points, squares


def _least_distances(points: Array, to: Array) -> Array:
    """Returns the squared distance of each point from the nearest of others, (m,)."""
    return np.min(np.sum((points[:, None, :] - to) ** 2, axis=2), axis=1)


def _one_thread() -> Any:
    """Returns a context in which linear algebra runs in one thread: several take ten times as long for matrices as small as these."""
    limits: Any = import_module("threadpoolctl").threadpool_limits
    return limits(1)
