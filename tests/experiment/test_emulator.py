"""The emulator finds the values that fit best, and the intervals that the model itself would give."""

from __future__ import annotations

import math
from collections.abc import Callable
from importlib import import_module
from typing import Any

import numpy as np
import pytest
from scipy.special import stdtrit

from actr3d.experiment.emulator import Emulator

X = np.arange(1.0, 9.0)
optimize: Any = import_module("scipy.optimize")
Model = Callable[..., Any]


def power(a: Any, d: Any) -> Any:
    return (0.3 + 2.7 * a)[..., None] * X ** -(0.2 + d)[..., None]


def product(a: Any, b: Any) -> Any:
    """Only the product matters: a curved ridge."""
    return ((0.3 + a) * (0.3 + b))[..., None] * X**-0.5


def added(a: Any, b: Any) -> Any:
    """Only the sum matters: a straight ridge."""
    return (a + b)[..., None] * X


def line(slope: Any, offset: Any) -> Any:
    return slope[..., None] * X + offset[..., None]


def growth(rate: Any) -> Any:
    return np.exp(rate[..., None] * X)


def offset_power(a: Any, d: Any, c: Any) -> Any:
    return c[..., None] + (0.3 + 2.7 * a)[..., None] * X ** -(0.2 + 1.3 * d)[..., None]


def tried(model: Model, axes: int, data: Any, number: int = 30) -> Emulator:
    """Returns an emulator after as many candidates as a fit has, half of them where the one before was least or at a bound."""
    points = np.random.default_rng(axes).random((10, axes))
    for turn in range(number - 10):
        emulator = Emulator(points, model(*points.T), data)
        bound = turn // 2 % (2 * axes)
        further = emulator.minimum if turn % 2 == 0 else emulator.bound(bound // 2, upper=bound % 2 == 1)
        points = np.vstack([points, further])
    return Emulator(points, model(*points.T), data)


def works_below_a_third(points: Any, data: Any, number: int) -> Emulator:
    """Returns an emulator of `power` that fails for high a, after as many more candidates, half of them where the one before was least."""

    def emulator_of(points: Any) -> Emulator:
        works = points[:, 0] <= 1 / 3
        return Emulator(points[works], power(*points[works].T), data, points[~works])

    for turn in range(number):
        emulator = emulator_of(points)
        further = emulator.minimum if turn % 2 == 0 else emulator.bound(turn // 2 % 2, upper=turn // 4 % 2 == 1)
        points = np.vstack([points, further])
    return emulator_of(points)


def profile(model: Model, axes: int, data: Any, axis: int) -> tuple[float | None, float | None]:
    """Returns the bounds of the interval from the model itself: at each value, SciPy finds the least squares over the other parameters."""
    grid, starts = np.linspace(0, 1, 21).tolist(), [np.full(axes, part) for part in (0.2, 0.5, 0.8)]

    def least(low: Any, high: Any) -> float:
        def differences(point: Any) -> Any:
            return model(*point) - data

        return 2 * min(optimize.least_squares(differences, np.clip(start, low, high), bounds=(low, high)).cost for start in starts)

    def at(value: float) -> float:
        low, high = np.zeros(axes), np.ones(axes)
        low[axis], high[axis] = max(0, value - 1e-9), min(1, value + 1e-9)
        return least(low, high)

    free = len(data) - axes
    most = least(np.zeros(axes), np.ones(axes)) * (1 + stdtrit(free, 0.975) ** 2 / free)

    def bound(inside: float, outside: float) -> float:
        while abs(outside - inside) > 0.005:
            middle = (inside + outside) / 2
            inside, outside = (middle, outside) if at(middle) <= most else (inside, middle)
        return inside

    inside = [number for number, value in enumerate(grid) if at(value) <= most]
    low, high = inside[0], inside[-1]
    return (
        None if low == 0 else bound(grid[low], grid[low - 1]),
        None if high == len(grid) - 1 else bound(grid[high], grid[high + 1]),
    )


@pytest.mark.daily(1)
@pytest.mark.parametrize(
    ("model", "true", "noise"),
    [(power, (0.3, 0.4), 0.05), (product, (0.4, 0.5), 0.05), (added, (0.5, 0.6), 0.1), (offset_power, (0.25, 0.3, 0.3), 0.02)],
)
def test_intervals_are_those_of_the_model_itself(model: Model, true: tuple[float, ...], noise: float) -> None:
    data = model(*np.array(true)) + np.random.default_rng(7).normal(0, noise, len(X))
    emulator = tried(model, len(true), data)
    assert emulator.is_confirmed
    for axis in range(len(true)):
        exact, found = profile(model, len(true), data, axis), emulator.interval(axis)
        assert [bound is None for bound in found] == [bound is None for bound in exact]
        for bound, expected in zip(found, exact, strict=True):
            assert bound is None or bound == pytest.approx(expected, abs=0.02)


def test_the_minimum_and_the_interval_of_a_straight_line_are_exact() -> None:
    x = np.column_stack([X, np.ones(8)])
    data = x @ [0.5, 0.4] + np.random.default_rng(1).normal(0, 0.1, 8)
    emulator = tried(line, 2, data, 16)
    best = np.linalg.lstsq(x, data, rcond=None)[0]
    assert emulator.minimum == pytest.approx(best, abs=1e-3)
    variance = np.sum((data - x @ best) ** 2) / 6
    half = float(stdtrit(6, 0.975) * math.sqrt(variance * np.linalg.inv(x.T @ x)[0, 0]))
    assert emulator.interval(0) == (pytest.approx(best[0] - half, abs=2e-3), pytest.approx(best[0] + half, abs=2e-3))


def test_a_model_that_is_determined_exactly_has_a_narrow_interval() -> None:
    emulator = tried(growth, 1, growth(np.array(0.2)), 20)
    low, high = emulator.interval(0)
    assert low is not None
    assert high is not None
    assert 0.19 < low <= 0.2 <= high < 0.21


def test_noise_of_the_means_is_smoothed() -> None:
    rng = np.random.default_rng(5)
    points = rng.random((40, 1))
    means = points * X + rng.normal(0, 0.1, (40, 8))
    data = 0.5 * X + rng.normal(0, 0.1, 8)
    slope = float(data @ X / (X @ X))
    assert Emulator(points, means, data).minimum[0] == pytest.approx(slope, abs=0.02)


def test_no_interval_is_given_while_the_minimum_is_a_guess() -> None:
    points = np.array([[0.1], [0.8]])
    emulator = Emulator(points, points * X, 0.5 * X)
    assert not emulator.is_confirmed
    assert emulator.interval(0) == (None, None)


def test_an_interval_that_is_narrower_than_a_step_is_as_exact() -> None:
    data = 0.4567 * X + np.random.default_rng(1).normal(0, 1e-4, 8)
    best = float(data @ X / (X @ X))
    half = float(stdtrit(7, 0.975) * math.sqrt(np.sum((data - best * X) ** 2) / 7 / (X @ X)))
    points = np.append(np.linspace(0, 1, 12), best)[:, None]
    low, high = Emulator(points, points * X, data).interval(0)
    assert (low, high) == (pytest.approx(best - half, abs=half / 5), pytest.approx(best + half, abs=half / 5))


def test_noise_of_the_simulation_does_not_make_the_minimum_a_guess() -> None:
    """With many means, the candidates' own noise is larger than what the interval allows."""
    x, rng = np.linspace(1, 8, 50), np.random.default_rng(2)
    data = 0.5 * x + rng.normal(0, 0.05, 50)
    points = np.append(np.linspace(0, 1, 15), np.full(15, 0.5) + rng.normal(0, 0.01, 15))[:, None]
    emulator = Emulator(points, points * x + rng.normal(0, 0.05, (30, 50)), data)
    assert emulator.is_confirmed
    low, high = emulator.interval(0)
    assert low is not None
    assert high is not None
    assert low < 0.5 < high < low + 0.02


@pytest.mark.parametrize("true", [0.3, 0.6])
def test_values_at_which_the_model_fails_are_not_searched(true: float) -> None:
    """It fails above 0.5."""
    points, data = np.random.default_rng(2).random((10, 1)), true * X + 0.01 * (-1) ** X

    def emulator_of(points: Any) -> Emulator:
        works = points[:, 0] <= 0.5
        return Emulator(points[works], points[works] * X, data, points[~works])

    for _ in range(12):
        points = np.vstack([points, emulator_of(points).minimum])
    emulator = emulator_of(points)
    assert emulator.minimum[0] == pytest.approx(min(true, 0.5), abs=0.01)
    low, high = emulator.interval(0)
    assert low is not None
    assert (high is None) == (true > 0.5)


def test_a_single_candidate_determines_nothing() -> None:
    emulator = Emulator(np.array([[0.3]]), np.ones((1, 4)), np.zeros(4))
    assert not emulator.is_confirmed
    assert emulator.interval(0) == (None, None)


def test_bounds_are_proposed_also_if_data_cannot_be_reached_and_are_no_more_than_parameters() -> None:
    for seed in range(5):
        points = np.random.default_rng(seed).random((14, 3))
        emulator = Emulator(points, points @ [[1.0, 0.3], [0.5, 0.2], [0.1, 0.8]], np.array([30.0, 20.0]))
        for axis in range(3):
            assert emulator.bound(axis, upper=True) == pytest.approx(np.ones(3))
            assert emulator.interval(axis) == (None, None)


@pytest.mark.slow
def test_the_bound_of_a_parameter_is_found_although_the_model_fails_for_much_of_another() -> None:
    """It fails for high a; the interval of d ends where it works."""
    points, data = np.random.default_rng(4).random((10, 2)), power(np.array(0.4), np.array(0.4)) + 0.03 * (-1) ** X
    assert None not in works_below_a_third(points, data, 24).interval(1)


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(4))
def test_where_the_model_fails_is_no_bound_of_the_parameter_that_makes_it_fail(seed: int) -> None:
    """It fails for high a; other values of d, near which it works, do not make that a bound."""
    rng = np.random.default_rng(seed)
    points, data = rng.random((10, 2)), power(np.array(0.31), np.array(0.4)) + rng.normal(0, 0.05, 8)
    high = works_below_a_third(points, data, 26).interval(0)[1]
    assert high is None or high <= 1 / 3


@pytest.mark.parametrize(("jump", "chance", "agrees"), [(0.0, 0.0, True), (2.0, 0.0, False), (0.0, 0.1, True)])
def test_a_model_whose_means_jump_does_not_agree_but_chance_does_no_harm(jump: float, chance: float, agrees: bool) -> None:
    rng = np.random.default_rng(3)

    def means(points: Any) -> Any:
        chances = rng.normal(0, chance, (len(points), 8)) if chance else 0.0
        return np.where(points > 0.45, jump, 0.0) + points * X + chances

    points = np.linspace(0.02, 0.98, 25)[:, None]
    emulator = Emulator(points, means(points), means(np.array([[0.47]]))[0] + rng.normal(0, 0.1, 8))
    assert emulator.agrees(means(emulator.minimum[None])[0], np.full(8, chance), np.full((25, 8), chance)) == agrees
    if jump:
        assert emulator.roughest[0] == pytest.approx(0.45, abs=0.1)


def test_chance_that_grows_along_a_range_is_not_taken_for_a_jump() -> None:
    rng = np.random.default_rng(3)
    points = np.linspace(0, 1, 30)[:, None]
    errors = 0.2 * points * X
    emulator = Emulator(points, points * X + rng.normal(0, errors), 0.1 * X + rng.normal(0, 0.02, 8))
    at_minimum = emulator.minimum * X
    assert emulator.agrees(at_minimum, 0.2 * at_minimum, errors)
    assert not emulator.agrees(at_minimum, 0.2 * at_minimum, np.tile(0.02 * X, (30, 1)))


def test_as_many_parameters_as_data_have_no_interval() -> None:
    points = np.random.default_rng(1).random((20, 1))
    assert Emulator(points, points, np.array([0.4])).interval(0) == (None, None)
    assert None not in Emulator(points, points * [1, 2], np.array([0.4, 0.9])).interval(0)


def test_a_fit_to_as_many_means_as_parameters_is_confirmed_by_what_the_model_does_at_the_minimum() -> None:
    points = np.linspace(0.05, 0.95, 10)[:, None]
    emulator, none = Emulator(points, points, np.array([0.4])), np.zeros(1)
    assert emulator.is_confirmed
    assert emulator.agrees(emulator.minimum, none, np.zeros((10, 1)))
    assert not emulator.agrees(emulator.minimum + 0.1, none, np.zeros((10, 1)))


def test_means_of_any_size_have_the_same_intervals() -> None:
    data = 0.5 * X + np.random.default_rng(1).normal(0, 0.1, 8)
    points = np.append(np.linspace(0, 1, 20), 0.5)[:, None]
    usual = Emulator(points, points * X, data).interval(0)
    assert None not in usual
    for unit in (1e-200, 1e200):
        assert Emulator(points, points * X * unit, data * unit).interval(0) == pytest.approx(usual, rel=1e-6)


@pytest.mark.slow
@pytest.mark.parametrize(("data", "parameters"), [(4, 2), (2, 1), (3, 1), (12, 2)])
def test_intervals_have_the_true_value_as_often_as_they_say(data: int, parameters: int) -> None:
    """A straight line through the origin, or with an offset, with normal errors whose variance the fit does not know."""
    rng, runs, inside = np.random.default_rng(7), 100, 0
    x = np.column_stack([np.linspace(1, 2, data), np.ones(data)])[:, :parameters]
    points = rng.random((12, parameters))
    for _ in range(runs):
        y = x @ np.full(parameters, 0.5) + rng.normal(0, 0.1, data)
        best = np.clip(np.linalg.lstsq(x, y, rcond=None)[0], 0, 1)
        candidates: Any = np.vstack([points, best])  # a fit tries the minimum, too
        low, high = Emulator(candidates, candidates @ x.T, y).interval(0)
        inside += (low is None or low <= 0.5) and (high is None or high >= 0.5)
    assert 0.9 <= inside / runs < 1  # 0.95, and about twice the standard error of 100 runs
