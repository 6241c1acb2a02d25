"""Constraints on a model of people: they tell good models from bad ones."""

from __future__ import annotations

import math
import random
from collections.abc import Callable, Mapping
from dataclasses import replace
from statistics import mean
from typing import Any

import pytest

from actr3d.experiment.aperture.constraints import Findings, change, difference, equivalence, margin
from actr3d.experiment.aperture.critical_ratio import critical_ratio, critical_ratio_of_group
from actr3d.experiment.aperture.original import original_means
from actr3d.experiment.aperture.passing import Passing

APERTURES = tuple(n / 100 for n in range(40, 75, 5))
CONDITIONS = ("normal", "fast")
SHOULDERS = {"small": (0.38, 0.39, 0.404, 0.418, 0.428), "large": (0.475, 0.48, 0.484, 0.488, 0.493)}


def test_the_originals_means_are_there() -> None:
    means = original_means()
    assert len(means) == 28
    assert means["small", "normal", 0.40] == 57.69
    assert means["large", "fast", 0.55] == 39.92
    assert set(means) == {(group, condition, wide) for group in SHOULDERS for condition in CONDITIONS for wide in APERTURES}


def test_turning_points_are_found() -> None:
    draw = random.Random(1)
    ratios = [1 + 0.6 * n / 400 for n in range(400)]
    noisy = [(ratio, draw.random() < 1 / (1 + math.exp(40 * (ratio - 1.28)))) for ratio in ratios]
    found = critical_ratio(noisy)
    assert found is not None
    assert found.value == pytest.approx(1.28, abs=0.02)
    assert found.low < 1.28 < found.high
    sharp = critical_ratio((ratio, ratio < 1.3) for ratio in (1.0, 1.1, 1.2, 1.28, 1.32, 1.4, 1.5))
    assert sharp is not None
    assert sharp.value == pytest.approx(1.30, abs=0.005)
    assert critical_ratio([(1.0, True), (1.2, True)]) is None, "nothing is known where nobody walks straight through"


@pytest.mark.daily(1)
@pytest.mark.parametrize(("centre", "slope"), [(1.9, 0.8), (1.5, 1.5), (1.5, 4.0)])
def test_intervals_of_turning_points_have_the_true_one_as_often_as_they_say(centre: float, slope: float) -> None:
    draw, ratios, runs, inside = random.Random(3), [0.9 + 0.1 * n for n in range(13)], 150, 0
    for _ in range(runs):
        trials = [(ratio, draw.random() < 1 / (1 + math.exp(slope * (ratio - centre)))) for ratio in ratios for _ in range(20)]
        found = critical_ratio(trials)
        assert found is not None
        inside += found.low <= centre <= found.high
    assert 0.92 < inside / runs < 0.99  # 0.95; a bound is one of 401 ratios, beyond the last one that is inside


def test_a_turning_point_that_may_lie_beyond_the_trials_has_an_open_interval() -> None:
    flat = critical_ratio((ratio, n < 10) for ratio in (0.9, 1.2, 1.5, 1.8, 2.1) for n in range(20))
    assert flat is not None
    assert (flat.low, flat.high) == (-math.inf, math.inf), "as many turn at each ratio"
    beyond = critical_ratio((ratio, n < most) for ratio, most in ((0.9, 20), (1.2, 19), (1.5, 17), (1.8, 15)) for n in range(20))
    assert beyond is not None
    assert beyond.high == math.inf
    assert 1.5 < beyond.low < beyond.value == 1.8
    assert beyond.beyond
    open_only = critical_ratio((ratio, n < most) for ratio, most in ((0.9, 20), (1.2, 19), (1.5, 12), (1.8, 9)) for n in range(3, 23))
    assert open_only is not None
    assert not open_only.beyond


def test_equivalence_takes_small_differences_and_small_spread() -> None:
    near, far, wide = [20.0, 21.0, 22.0, 21.0, 20.5], [28.0, 29.0, 30.0, 29.0, 28.5], [5.0, 40.0, 12.0, 33.0, 16.0]
    assert equivalence(near, [21.0, 20.0, 21.5, 20.5, 22.0], 5).p < 0.01
    assert (equivalence(far, near, 5).difference, equivalence(far, near, 5).p) == (pytest.approx(8.0), pytest.approx(1, abs=0.01))
    assert equivalence(wide, near, 5).p > 0.05
    found = equivalence([20.0, 21.0, 22.0, 21.0, 20.5], [21.0, 23.0, 22.0, 24.0], 5)  # by statsmodels' `ttost_ind`:
    assert (found.difference, found.df, found.p) == (pytest.approx(-1.6), pytest.approx(4.554990), pytest.approx(0.003420054))


def good(group: str, agent: int, condition: str, aperture: float, number: int) -> Passing:
    """Returns what a model of people would do: a margin of 0.15 of the shoulders, and some more when it is fast."""
    shoulders = SHOULDERS[group][agent]
    need = aperture / 1.3 / shoulders
    angle = 0.0 if need >= 1 else math.degrees(math.acos(need)) + (4 if condition == "fast" else 0) + 0.1 * number
    return Passing(
        participant=f"{group} {agent}",
        group=group,
        condition=condition,
        aperture=aperture,
        shoulders=shoulders,
        angle=angle,
        left=0.069,
        right=0.071,
        contacts=0,
        passed=True,
    )


GOOD = [
    good(group, agent, condition, aperture, number)
    for group in SHOULDERS
    for condition in CONDITIONS
    for aperture in APERTURES
    for agent in range(5)
    for number in range(2)
]


def findings(of: Callable[[Passing], Passing]) -> Findings:
    return Findings(map(of, GOOD))


def judgements(*boundaries: float, step: float = 0.02) -> list[list[tuple[float, bool]]]:
    """Returns the judgements of people, each with a boundary: the ratio, and whether it is below that."""
    ratios = [round(0.9 + step * n, 2) for n in range(round(0.5 / step) + 1)]
    return [[(ratio, ratio < boundary) for ratio in ratios] for boundary in boundaries]


def unmet(of: Callable[[Passing], Passing], boundary: float = 1.16) -> list[int]:
    return [constraint.number for constraint in findings(of).all(judged=judgements(*[boundary] * 4)) if constraint.met is False]


def with_angle(one: Passing, angle: float) -> Passing:
    return replace(one, angle=angle)


def with_margin(one: Passing, room: float) -> Passing:
    return replace(one, left=room, right=room)


def as_it_is(one: Passing) -> Passing:
    return one


def test_a_walker_that_does_not_turn_has_no_margin() -> None:
    """At wide apertures, the distances depend on the aperture only, so they are no margins."""
    found = findings(lambda one: with_margin(one, 0.07 if one.angle else 0.14))
    assert {margin(one) for one in found.passings if (one.group, one.condition, one.aperture) == ("large", "fast", 0.45)} == {(0.07, 0.07)}
    assert {margin(one) for one in found.passings if (one.group, one.condition, one.aperture) == ("small", "normal", 0.7)} == {None}
    assert found.untouched().met


def test_a_model_of_people_meets_all_constraints() -> None:
    assert unmet(as_it_is) == []


BAD: dict[str, tuple[list[int], Callable[[Passing], Passing]]] = {
    "turns more before a wider one": ([1], lambda one: with_angle(one, 60.0) if one.aperture == 0.45 else one),
    "never turns": ([1], lambda one: with_angle(one, 0.0)),
    "turns by the same angle everywhere": ([1, 7], lambda one: with_angle(one, 20.0)),
    "turns everywhere": ([7, 4], lambda one: with_angle(one, max(one.angle or 0, 18.0))),
    "turns by width alone": ([2, 3, 4], lambda one: with_angle(one, max(0.0, 300 * (0.6 - one.aperture)))),
    "turns at a smaller ratio": ([4], lambda one: one if one.ratio < 1.2 else with_angle(one, 0.0)),
    "turns less when fast": (
        [5],
        lambda one: with_angle(one, max(0.0, (one.angle or 0) - (8 if one.condition == "fast" else 0))),
    ),
    "touches once": ([6], lambda one: replace(one, contacts=int(one is GOOD[3]))),
    "leaves too little": ([6], lambda one: replace(one, left=0.03)),
    "leaves too little where it is narrowest": ([6], lambda one: with_margin(one, 0.04 if one.aperture == 0.4 else 0.07)),
    "leaves too much where it turns least": ([6], lambda one: with_margin(one, 0.09 if one.aperture == 0.6 else 0.07)),
    "stops": ([6], lambda one: replace(one, passed=False) if one.aperture == 0.4 else one),
}


@pytest.mark.parametrize("what", BAD)
def test_each_wrong_model_fails_the_constraints_that_it_should_fail(what: str) -> None:
    expected, of = BAD[what]
    assert set(unmet(of)) >= set(expected)
    assert unmet(of) != unmet(as_it_is)


def results(of: Findings) -> dict[int, bool | None]:
    return {constraint.number: constraint.met for constraint in of.all()}


def test_with_two_participants_a_group_nothing_is_tested() -> None:
    """A t test of two would be met or not met by chance, and the report says that nothing is tested."""
    few = Findings(one for one in GOOD if one.participant[-1] in "01")
    assert few.scores() is None
    assert [results(few)[number] for number in (2, 3, 5)] == [None, None, None]
    enough = Findings(one for one in GOOD if one.participant[-1] in "012")
    assert [results(enough)[number] for number in (2, 3, 5)] == [True, True, True]


def test_a_rise_before_a_wider_aperture_is_decided_by_its_interval() -> None:
    """The interval is that of five changes: by scipy's `ttest_1samp(changes, 0).confidence_interval()`, 2.0368 to 5.9632."""
    assert change([2.0, 3.0, 4.0, 5.0, 6.0]) == pytest.approx((4.0, 2.036757, 5.963243), abs=1e-6)

    def rising(*more: float) -> Findings:
        """Returns walkers who all turn less and less before wider apertures, but by so much more at 45 cm than at 40 cm."""
        return findings(
            lambda of: with_angle(of, 100 - 100 * of.aperture + (5 + more[int(of.participant[-1])] if of.aperture == 0.45 else 0))
        )

    sure, open_, slight = rising(3, 4, 4, 4, 5).falls(), rising(-20, -8, 4, 16, 28).falls(), rising(0.2, 0.4, 0.6, 0.8, 1.0).falls()
    assert (sure.met, open_.met, slight.met) == (False, None, True)
    assert "largest rise from one aperture to the next 4.0 degrees (95 % interval" in sure.found
    assert "cannot be decided without more participants: largest rise from one aperture to the next 4.0" in open_.found
    assert "at 45 cm" in open_.found


def test_whether_the_large_turn_more_is_decided_by_the_interval_of_the_difference() -> None:
    """The ends are those of scipy's `ttest_ind(one, other, equal_var=False).confidence_interval()`."""
    one, other = [70.0, 66.0, 74.0, 69.0, 71.0], [69.0, 72.0, 66.0, 68.0, 70.0]
    assert difference(one, other) == pytest.approx((1.0, -2.833945, 4.833945), abs=1e-6)

    def at_40(*angles: float) -> Callable[[Passing], Passing]:
        return lambda of: with_angle(of, angles[int(of.participant[-1])]) if of.aperture == 0.4 and of.group == "large" else of

    small = [mean(of.angle or 0.0 for of in GOOD if of.participant == f"small {n}" and of.aperture == 0.4) for n in range(5)]
    above, near, below = (findings(at_40(*(angle + more + n for n, angle in enumerate(small)))).wider_turns_more() for more in (20, 0, -30))
    assert (above.met, near.met, below.met) == (True, None, False)
    assert "cannot be decided without more participants" in near.found
    assert "at 40 cm" in near.found
    assert "at 40 cm" in below.found


@pytest.mark.parametrize("conditions", [("fast",), CONDITIONS])
def test_a_participant_without_an_angle_is_left_out_wherever_it_has_none(conditions: tuple[str, ...]) -> None:
    """An experiment that goes on may have no trial of it yet, or none in which it set out."""
    absent = [replace(one, angle=None) if one.participant == "large 4" and one.condition in conditions else one for one in GOOD]
    found, without = Findings(absent), Findings(one for one in absent if one.angle is not None)
    assert found.all()[:5] == without.all()[:5]
    assert results(found)[3] is True
    scores = found.scores()
    assert scores is not None
    assert scores == without.scores()
    assert len(scores[0]) == (5 if conditions == ("fast",) else 4)
    few = Findings(one if one.participant[-1] in "01" else replace(one, angle=None) for one in GOOD)
    assert few.scores() is None


def test_groups_coincide_only_where_they_turn() -> None:
    never, same = findings(lambda one: with_angle(one, 0.0)).same_ratio(), findings(lambda one: with_angle(one, 20.0)).same_ratio()
    assert (never.met, never.found) == (None, "it needs walkers that turn")
    assert (same.met, same.found) == (None, "it needs participants that differ")


@pytest.mark.parametrize(
    ("people", "met", "found"),
    [
        (judgements(1.16, 1.16, 1.16), True, "from 1.150 (95 % interval 1.139 to 1.161)"),
        (judgements(1.13, 1.16, 1.19), None, "cannot be decided without more participants"),
        (judgements(1.16, 1.16, 1.16, step=0.1), None, "(95 % interval 1.100 to 1.200)"),
        (judgements(1.14, 1.16, 1.18, step=0.25), None, "(95 % interval 0.802 to 1.519)"),
        (judgements(1.0, 1.02, 1.04), False, "from 1.010 (95 % interval 0.960 to 1.060)"),
        (judgements(0.5, 0.5, 0.5), None, "it needs judgements of both kinds: all were the same"),
        (judgements(1.16, 1.16), None, "it needs three or more participants"),
        (None, None, "it needs judgements, as in the design passability_judgement"),
    ],
)
def test_the_boundary_of_judgements_is_judged_by_its_whole_interval(people: Any, met: bool | None, found: str) -> None:
    constraint = Findings([]).judged(people)
    assert (constraint.met, found in constraint.found) == (met, True), constraint.found


def test_the_interval_of_a_group_is_as_wide_as_its_participants_differ() -> None:
    """Trials of one person are more alike than those of several: all of them together would look more certain than they are."""
    chance = random.Random(1)

    def walked(turns: float) -> list[tuple[float, bool]]:
        ratios = [0.8 + 0.1 * n for n in range(11) for _ in range(60)]
        return [(ratio, chance.random() < 1 / (1 + math.exp(25 * (ratio - turns)))) for ratio in ratios]

    alike, different = ([walked(1.30 + more * spread) for more in (-1, -0.5, 0, 0.5, 1)] for spread in (0.0, 0.08))
    for people in (alike, different):
        found, pooled = critical_ratio_of_group(people), critical_ratio(trial for one in people for trial in one)
        assert found is not None
        assert pooled is not None
        assert found.value == pooled.value
        assert found.low <= pooled.low < pooled.high <= found.high
    (low, high), (lower, higher) = ((of.low, of.high) for of in map(critical_ratio_of_group, (alike, different)) if of is not None)
    assert higher - lower > 3 * (high - low)
    # That of five means with these differences, by Student's t, is 0.079 to each side.
    assert (higher - lower) / 2 == pytest.approx(0.079, abs=0.02)
    always = [[(ratio, True) for ratio in (1.4, 1.6, 1.8)] * 9 for _ in range(4)]
    nearly = critical_ratio_of_group([*always[:-1], [*always[-1], (1.8, False)]])
    assert nearly is not None
    assert (nearly.low > 1.6, nearly.high) == (True, math.inf), "who turns before all doorways begins to turn beyond them"
    one_never = critical_ratio_of_group([[(1.0, True), (1.2, False)], [(1.0, False), (1.2, False)]])
    assert one_never is not None
    assert (one_never.low, one_never.high) == (-math.inf, math.inf), "without the first, there is none"


def test_a_critical_ratio_that_the_trials_leave_open_is_not_tested() -> None:
    """Walkers turn at the narrower of two apertures: where they begin to turn is not known."""
    two = [one for one in GOOD if one.aperture in (0.5, 0.7) and one.participant[:5] == "small" and one.condition == "normal"][::2]
    found = Findings(two).critical()
    assert found.met is None
    assert "cannot be decided without more participants, trials or ratios: small normal" in found.found
    assert found.found.endswith("small normal 1.299 (95 % interval 0.928 to 1.669)")
    assert (
        Findings(one for one in two if one.participant == "small 2").critical().found == "it needs three or more participants in each group"
    )
    below = Findings(replace(one, angle=20.0 if one.ratio < 1.1 else 0.0) for one in GOOD if one.aperture > 0.4)
    assert below.critical().met is False, "a ratio that is certainly too small is so, wherever it is"


def turning_below(turns: float, *ratios: float) -> Findings:
    """Returns the trials of eight walkers that turn before each doorway below a ratio, and before no other."""
    return Findings(
        (
            replace(GOOD[0], participant=f"small {n}", shoulders=0.45, aperture=ratio * 0.45, angle=30.0 if ratio < turns else 0.0)
            for ratio in ratios
            for n in range(8)
            for _ in range(10)
        ),
        "ratio",
    )


@pytest.mark.parametrize(
    ("ratios", "turns", "met", "interval"),
    [
        ((0.9, 1.1, 1.3, 1.5), 1.30, None, "1.100 to 1.300"),
        ((0.9, 1.1, 1.3, 1.5), 1.32, None, "1.300 to 1.500"),
        ((0.9, 1.0, 1.1, 1.4), 1.12, None, "1.100 to 1.400"),
        ((0.9, 1.24, 1.36, 1.5), 1.30, None, "1.240 to 1.360"),
        ((0.9, 1.25, 1.35, 1.5), 1.30, True, "1.250 to 1.350"),
        ((0.9, 1.28, 1.32, 1.5), 1.30, True, "1.280 to 1.320"),
        ((0.9, 1.1, 1.2, 1.4), 1.15, False, "1.100 to 1.200"),
        ((0.9, 1.1, 1.3, 1.4, 1.6), 1.5, False, "1.400 to 1.600"),
    ],
)
def test_a_critical_ratio_known_as_an_interval_is_judged_by_the_whole_interval(
    ratios: tuple[float, ...], turns: float, met: bool | None, interval: str
) -> None:
    """Walkers that turn abruptly show only between which two ratios they begin to: its middle says nothing about them."""
    found = turning_below(turns, *ratios).critical()
    assert found.met is met
    assert found.found.endswith(f"(95 % interval {interval})")


def held(bars: Mapping[float, float | None]) -> Findings:
    return Findings((replace(GOOD[0], bar=0.8, shoulders=0.8 / bar, aperture=0.9, angle=angle) for bar, angle in bars.items()), "ratio")


def test_bars_with_which_no_walker_sets_out_are_named() -> None:
    assert held({1.5: 50.0, 2.0: 40.0, 2.5: 30.0}).longer_bar().met is True
    assert held({1.5: 50.0, 2.0: 55.0, 2.5: 30.0}).longer_bar().met is False
    declined = held({1.5: None, 2.0: None, 2.5: 30.0}).longer_bar()
    assert declined.met is False
    assert "none, none, 30.0 at A/S 1.12; none: no walker set out, although people pass" in declined.found


def test_where_it_can_pass_is_one_of_them() -> None:
    assert unmet(as_it_is, 1.30) == [9]
    assert unmet(as_it_is, 1.0) == [9]
