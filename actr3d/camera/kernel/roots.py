"""Finds real roots of polynomials of degree up to four, without sampling."""

from __future__ import annotations

import math

from actr3d.camera.kernel.dtypes import Array
from actr3d.jit import inner_compiled


@inner_compiled
def add_roots(a: float, b: float, c: float, roots: Array, count: int) -> int:
    """Appends the real roots of `a x^2 + 2 b x + c`; returns the new number of roots."""
    discriminant = b * b - a * c
    if a == 0.0:
        if b != 0.0:
            roots[count] = -c / (2.0 * b)
            count += 1
        return count
    if discriminant < 0.0:
        return count
    far = -(b + math.copysign(math.sqrt(discriminant), b))
    roots[count] = far / a
    roots[count + 1] = c / far if far != 0.0 else 0.0
    return count + 2


@inner_compiled
def _value(coefficients: Array, degree: int, x: float) -> float:
    value = coefficients[degree]
    for i in range(degree - 1, -1, -1):
        value = value * x + coefficients[i]
    return value


@inner_compiled
def _root_between(coefficients: Array, slopes: Array, degree: int, low: float, high: float, rising: bool) -> float:
    """Returns the single root of a polynomial in an interval with a sign change: Newton steps, and bisection if one leaves it."""
    x = 0.5 * (low + high)
    for _ in range(60):
        value = _value(coefficients, degree, x)
        if (value <= 0.0) == rising:
            low = x
        else:
            high = x
        slope = _value(slopes, degree - 1, x)
        step = x - value / slope
        if abs(step - x) <= 1e-15:
            return step
        x = step if low < step < high else 0.5 * (low + high)
    return x


@inner_compiled
def add_quartic_roots(quartic: Array, work: Array, roots: Array, count: int) -> int:
    """Appends the roots in -1 ... 1 of a polynomial and of its derivative; returns the new number of roots.

    Between two roots of its derivative a polynomial is monotone, so no root is missed; double roots, which rounding
    may hide, are among the derivative's roots.

    Args:
        quartic: The five coefficients, constant first.
        work: A work array (5, 5).
        roots: The output array.
        count: The number of roots already written.
    """
    for i in range(5):
        work[0, i] = quartic[i]
    for level in range(1, 5):  # work[level] is the derivative of that order, of degree 4 - level
        for i in range(5 - level):
            work[level, i] = work[level - 1, i + 1] * (i + 1)
    found = 0
    for level in range(3, -1, -1):
        degree = 4 - level
        start, bound, new = count, -1.0, 0
        positive = _value(work[level], degree, bound) > 0.0
        for i in range(found + 1):
            end = roots[start + i] if i < found else 1.0
            positive_before, positive = positive, _value(work[level], degree, end) > 0.0
            if positive_before != positive:
                roots[start + found + new] = _root_between(work[level], work[level + 1], degree, bound, end, positive)
                new += 1
            bound = end
        if level == 0:
            return count + found + new
        for i in range(new):
            roots[start + i] = roots[start + found + i]
        found = new
    return count
