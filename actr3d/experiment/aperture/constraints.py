"""The constraints on a model of people who pass apertures, by their numbers in docs/human-data.md.

Participants, not trials, are the unit of analysis: means of participants are compared. There is one exception: the critical ratio of a
cell is fitted to all its trials, because the apertures of one participant are more than 0.1 shoulder widths apart. Its interval is at least
as wide as the spread between participants.
"""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from statistics import mean, stdev, variance
from typing import NamedTuple

import numpy as np
from scipy.special import stdtr

from actr3d.experiment.aperture.critical_ratio import Answer, CriticalRatio, critical_ratio_of_group, t_interval
from actr3d.experiment.aperture.passing import DEPTH, TURNED, Passing
from actr3d.experiment.report.libraries import noting_warnings, pingouin
from actr3d.experiment.report.page import number
from actr3d.experiment.report.statistics import MIN_FOR_TESTS

CRITICAL = (1.25, 1.35)
"""The bounds of the ratio of aperture to shoulders at which turning begins. Source: Warren & Whang (1987), 1.28 to 1.31; the wider bounds
are chosen for this library."""
DIGITS = 3
"""The number of decimals of a critical ratio."""
POINT = 1.30
"""Below this ratio people turn. Source: Warren & Whang (1987)."""
MARGIN = (0.06, 0.08)
"""The margin on each side [m]. Source: Higuchi's review (docs/human-data.md)."""
PASSABLE = (1.11, 1.21)
"""The bounds of the ratio from which people judge that they can pass without turning. Source: Warren & Whang (1987), about 1.16;
the bounds are chosen for this library."""
SAME = 5.0
"""Angles that differ by less than this count as equal [degrees]. Source: chosen for this library."""
STEADY = 1.0
"""The maximum rise of an angle by chance from one aperture to a wider one [degrees]. Source: chosen for this library."""
STRAIGHT = 3.0
"""The maximum mean angle at wide apertures [degrees]: people sway by a few degrees. Source: chosen for this library."""
WIDE = 1.35
"""Apertures above this ratio are wide."""
EQUAL = 0.63
"""Below this aperture the large group turns more [m]. Source: 1.30 times the large group's shoulders (docs/human-data.md)."""
MORE_PARTICIPANTS = "it needs three or more participants in each group"
"""Why a constraint is not tested with fewer than `MIN_FOR_TESTS`."""


class Difference(NamedTuple):
    """How much greater one mean is than another, or than 0."""

    value: float
    low: float
    """The lower end of its 95 % interval."""
    high: float


@dataclass(frozen=True, kw_only=True)
class Equivalence:
    """The test that two groups have the same mean, within a bound."""

    difference: float
    """Of the means."""
    df: float
    """Degrees of freedom of the t tests; NaN without any variance."""
    p: float
    """The greater p of both tests; NaN if they cannot be computed."""
    notes: Sequence[str]
    """What the library warned of."""


@dataclass(frozen=True, kw_only=True)
class Constraint:
    """One constraint, and whether the model meets it."""

    number: int
    """Its number in docs/human-data.md."""
    says: str
    met: bool | None
    """None if the design of the experiment does not test it, or has too few participants or trials to decide it."""
    found: str
    """The model's result, with its numbers; or what the design lacks."""


def margin(passing: Passing) -> tuple[float, float] | None:
    """Returns the smallest distances to the left and right segment of the wall [m], of a walker that turned at a ratio below 1.30.

    Returns None for all other trials, whose distances depend on the aperture only, and for a walker that never was in the doorway.
    """
    if passing.left is None or passing.right is None:
        return None
    return (passing.left, passing.right) if passing.ratio < POINT and passing.turned else None


class Findings:
    """The results of an experiment with apertures, by cell and by participant.

    Args:
        passings: All trials.
        by: What the design varies: the aperture, or its ratio to the shoulder width.
    """

    def __init__(self, passings: Iterable[Passing], by: str = "aperture") -> None:
        self.passings = list(passings)
        self.by = by
        """What the design varies: `aperture` or `ratio`."""
        self.plain = [one for one in self.passings if one.bar_ratio == 1 and one.straight]
        """The trials without a bar that is wider than the body, which begin in line with the doorway."""
        self._people: defaultdict[tuple[str, str, str], defaultdict[float, list[float]]] = defaultdict(lambda: defaultdict(list))
        self._trials: defaultdict[tuple[str, str, str], list[Passing]] = defaultdict(list)
        for one in self.plain:
            if one.angle is not None:
                self._people[one.group, one.condition, one.participant][self.level(one)].append(one.angle)
                self._trials[one.group, one.condition, one.participant].append(one)
        self._shoulders = {(one.group, one.participant): one.shoulders for one in self.plain}
        self.groups = list(dict.fromkeys(one.group for one in self.plain))
        self.conditions = list(dict.fromkeys(one.condition for one in self.plain))
        self.levels = sorted({level for angles in self._people.values() for level in angles})
        """The apertures [m], or their ratios."""

    def level(self, passing: Passing) -> float:
        """Returns the level of what the design varies."""
        return round(passing.aperture if self.by == "aperture" else passing.ratio, 3)

    def has(self, group: str, condition: str, level: float) -> bool:
        """Returns whether a cell has an angle."""
        return any(level in self._angles(group, condition, one) for one in self.participants(group))

    def mean(self, group: str, condition: str, level: float) -> float:
        """Returns the mean angle of a cell, of the participants' means [degrees]."""
        return mean(self._means(group, condition, level).values())

    def _means(self, group: str, condition: str, level: float) -> dict[str, float]:
        """Returns the mean angle of each participant of a cell that has one [degrees]."""
        found = {one: self._angles(group, condition, one).get(level) for one in self.participants(group)}
        return {one: mean(angles) for one, angles in found.items() if angles}

    def participants(self, group: str) -> list[str]:
        """Returns the participants of a group."""
        return [one for of, one in self._shoulders if of == group]

    def trials(self, group: str, condition: str, participant: str) -> list[Passing]:
        """Returns a participant's trials with an angle."""
        return self._trials.get((group, condition, participant), [])

    def curve(self, group: str, condition: str, participant: str) -> tuple[list[float], list[float]]:
        """Returns a participant's ratios of aperture to shoulders, and its mean angles at them [degrees]."""
        angles, shoulders = self._angles(group, condition, participant), self._shoulders[group, participant]
        scale = shoulders if self.by == "aperture" else 1.0
        return [level / scale for level in sorted(angles)], [mean(angles[level]) for level in sorted(angles)]

    def _angles(self, group: str, condition: str, participant: str) -> Mapping[float, list[float]]:
        """Returns a participant's angles by level; empty without any."""
        return self._people.get((group, condition, participant), {})

    @property
    def pair(self) -> tuple[str, str] | None:
        """The groups with the narrowest and the widest shoulders; None if there is one group."""
        if len(self.groups) < 2:
            return None
        widths = {group: mean(self._shoulders[group, one] for one in self.participants(group)) for group in self.groups}
        return min(widths, key=widths.__getitem__), max(widths, key=widths.__getitem__)

    # -- the constraints

    def all(self, *, judged: Sequence[Sequence[Answer]] | None = None) -> list[Constraint]:
        """Returns all nine constraints.

        Args:
            judged: The judgements of each participant: the ratio, and whether it judged that it cannot pass without turning; None if it was
                not asked.
        """
        first = [self.falls(), self.wider_turns_more(), self.same_ratio(), self.critical(), self.faster_turns_more()]
        return [*first, self.untouched(), self.upright(), self.longer_bar(), self.judged(judged)]

    def falls(self) -> Constraint:
        """1: rotation falls with aperture: a larger rise than `STEADY` counts with its whole interval."""
        says = "rotation falls with aperture"
        if len(self.levels) < 2:
            return _untested(1, says, "it needs several apertures")
        rises: dict[tuple[str, str, float], Difference] = {}
        fall = math.inf
        for group in self.groups:
            for condition in self.conditions:
                there = [level for level in self.levels if self.has(group, condition, level)]
                for before, level in pairwise(there):
                    narrow, wide = self._means(group, condition, before), self._means(group, condition, level)
                    changes = [wide[one] - narrow[one] for one in narrow if one in wide]
                    if len(changes) < MIN_FOR_TESTS:
                        return _untested(1, says, MORE_PARTICIPANTS)
                    rises[group, condition, level] = change(changes)
                if len(there) > 1:
                    fall = min(fall, self.mean(group, condition, there[0]) - self.mean(group, condition, there[-1]))
        if not rises:
            return _untested(1, says, "it needs several apertures")
        group, condition, level = cell = max(rises, key=lambda of: rises[of].value)
        worst = rises[cell]
        found = "no rise from one aperture to the next"
        if worst.value > 0:
            where = f"{' '.join(filter(None, (group, condition)))} at {self._level_text(level)}"
            found = f"largest rise from one aperture to the next {_interval(worst)}, {where}"
        if fall <= STEADY:  # an angle that stays as it is does not fall
            found += f"; from the narrowest to the widest it falls by no more than {fall:.1f} degrees in a cell"
        if worst.low <= STEADY < min(worst.value, fall):
            return _untested(1, says, f"cannot be decided without more participants: {found}")
        return Constraint(number=1, says=says, met=worst.value <= STEADY < fall, found=found)

    def _level_text(self, level: float) -> str:
        return f"{100 * level:.3g} cm" if self.by == "aperture" else f"A/S {level:.3g}"

    def wider_turns_more(self) -> Constraint:
        """2: the large group turns more at equal width below about 63 cm: the interval of the least difference is above 0."""
        says = "large > small below 63 cm"
        if self.pair is None or self.by != "aperture":
            return _untested(2, says, "it needs two groups of different shoulder width at the same apertures")
        small, large = self.pair
        cells = {
            (condition, aperture): [[*self._means(group, condition, aperture).values()] for group in self.pair]
            for condition in self.conditions
            for aperture in self.levels
            if aperture < EQUAL and self.has(large, condition, aperture) and self.has(small, condition, aperture)
        }
        if not cells:
            return _untested(2, says, "it needs apertures below 63 cm")
        if any(len(angles) < MIN_FOR_TESTS for pair in cells.values() for angles in pair):
            return _untested(2, says, MORE_PARTICIPANTS)
        differences = {cell: difference(wider, narrower) for cell, (narrower, wider) in cells.items()}
        lowest = min(differences, key=lambda cell: differences[cell].low)
        negative = min(differences, key=lambda cell: differences[cell].high)
        met = differences[lowest].low > 0
        unmet = differences[negative].high <= 0
        condition, aperture = cell = negative if unmet else lowest
        found = differences[cell]
        text = f"smallest difference {_interval(found)}, {condition} at {self._level_text(aperture)}"
        if not met and not unmet:
            return _untested(2, says, f"cannot be decided without more participants: {text}")
        return Constraint(number=2, says=says, met=met, found=text)

    def scores(self) -> tuple[list[float], list[float]] | None:
        """Returns the mean angle of each participant over ratios from 1.0 to 1.4 [degrees]: those of the large, and of the small group.

        Angles between tested ratios are interpolated. Returns None if the groups cannot be compared.
        """
        if self.pair is None:
            return None
        curves = {key: self.curve(*key) for key in sorted(self._people) if key[0] in self.pair}
        there = [
            [(group, one) for one in self.participants(group) if any((group, condition, one) in curves for condition in self.conditions)]
            for group in self.pair
        ]
        if min(map(len, there)) < MIN_FOR_TESTS:
            return None
        low = max((min(ratios) for ratios, _ in curves.values()), default=math.inf)
        high = min((max(ratios) for ratios, _ in curves.values()), default=-math.inf)
        # Outside of a participant's own ratios nothing is known: only what all have is compared.
        ratios = [ratio for ratio in np.arange(1.0, 1.41, 0.05).tolist() if low <= ratio <= high]
        if len(ratios) < 3:
            return None

        def score(group: str, one: str) -> float:
            of = [curves[group, condition, one] for condition in self.conditions if (group, condition, one) in curves]
            return float(np.mean([np.interp(ratios, *curve) for curve in of]))

        small, large = ([score(*one) for one in those] for those in there)
        return large, small

    @cached_property
    def ratio_test(self) -> Equivalence | None:
        """The test that the groups agree on the ratio; None if they cannot be compared."""
        scores = self.scores()
        return None if scores is None else equivalence(*scores, SAME)

    def same_ratio(self) -> Constraint:
        """3: the groups agree on the ratio: two one-sided t tests of participants."""
        says, scores, test = "groups coincide on A/S", self.scores(), self.ratio_test
        if scores is None or test is None:
            return _untested(3, says, "it needs two groups of three or more participants, and common ratios between 1.0 and 1.4")
        if max(map(mean, scores)) <= TURNED:  # then they differ by less than the bound anyway
            return _untested(3, says, "it needs walkers that turn")
        if math.isnan(test.df):
            return _untested(3, says, "it needs participants that differ")
        found = f"large minus small {test.difference:.1f} degrees, within {SAME:g}: p = {test.p:.3g}"
        return Constraint(number=3, says=says, met=test.p < 0.05, found=found)

    def critical(self) -> Constraint:
        """4: the critical ratio of each cell: its whole interval is inside the bounds, outside, or neither."""
        says = f"critical ratio {CRITICAL[0]} to {CRITICAL[1]} in each cell"
        cells = {
            (group, condition): [of for who in self.participants(group) if (of := self.trials(group, condition, who))]
            for group in self.groups
            for condition in self.conditions
        }
        if not cells or any(not of or not _spans([one.ratio for who in of for one in who], CRITICAL) for of in cells.values()):
            return _untested(4, says, f"it needs ratios below {CRITICAL[0]} and above {CRITICAL[1]} in each group and condition")
        if any(len(of) < MIN_FOR_TESTS for of in cells.values()):
            return _untested(4, says, MORE_PARTICIPANTS)
        found = {key: critical_ratio_of_group([[(one.ratio, one.turned) for one in who] for who in of]) for key, of in cells.items()}
        met = {_within(ratio, CRITICAL) for ratio in found.values()}
        text = ", ".join(f"{' '.join(filter(None, key))} {_ratio_text(ratio)}" for key, ratio in found.items())
        if met <= {True, None} and None in met:
            return _untested(4, says, f"cannot be decided without more participants, trials or ratios: {text}")
        return Constraint(number=4, says=says, met=met == {True}, found=text)

    def faster_turns_more(self) -> Constraint:
        """5: fast minus normal at ratios below those that are allowed as critical, by participants."""
        says = f"fast > normal at ratios below {CRITICAL[0]}"
        if not {"normal", "fast"} <= set(self.conditions):
            return _untested(5, says, "it needs the conditions normal and fast")
        found: list[str] = []
        met = True
        for group in self.groups:
            differences: list[float] = []
            for one in self.participants(group):
                normal, fast = (dict(zip(*self.curve(group, condition, one), strict=True)) for condition in ("normal", "fast"))
                below = [fast[ratio] - normal[ratio] for ratio in normal if ratio < CRITICAL[0] and ratio in fast]
                if below:
                    differences.append(mean(below))
            if len(differences) < MIN_FOR_TESTS:
                return _untested(5, says, f"{MORE_PARTICIPANTS}, with apertures at ratios below {CRITICAL[0]}")
            p = above_zero(mean(differences), stdev(differences) / math.sqrt(len(differences)), len(differences) - 1)
            met &= p < 0.05
            found.append(f"{group} {mean(differences):+.1f} degrees (p = {p:.2g})")
        return Constraint(number=5, says=says, met=met, found=", ".join(found))

    def untouched(self) -> Constraint:
        """6: no contact, and the margin on each side of walkers that turned, at each aperture."""
        says = "no contact, margin 6 to 8 cm a side at each aperture"
        passable = [one for one in self.plain if one.ratio > DEPTH]
        if not passable:
            return _untested(6, says, "it needs apertures that can be passed, without a bar that is wider than the body")
        touched = sum(one.contacts > 0 for one in passable)
        passed = sum(one.passed for one in passable)
        sides: defaultdict[float, defaultdict[str, list[tuple[float, float]]]] = defaultdict(lambda: defaultdict(list))
        for one in passable:
            if (found := margin(one)) is not None:
                sides[self.level(one)][one.participant].append(found)
        means = {
            level: tuple(mean(mean(pair[side] for pair in pairs) for pairs in of.values()) for side in (0, 1))
            for level, of in sorted(sides.items())
        }
        scale, unit = (100, "cm") if self.by == "aperture" else (1, "A/S")
        which = " that begin in line, without a bar wider than the body," if len(self.plain) < len(self.passings) else ""
        text = f"{touched} of {len(passable)}{which} touched, {passed} passed; mean margin of agents that turned "
        text += ", ".join(f"{_sides(left, right)} at {scale * level:.3g}" for level, (left, right) in means.items())
        text += f" {unit}" if means else "none"
        met = touched == 0 and passed == len(passable) and bool(means)
        met &= all(MARGIN[0] <= side <= MARGIN[1] for of in means.values() for side in of)
        return Constraint(number=6, says=says, met=met, found=text)

    def upright(self) -> Constraint:
        """7: no constant turn at wide apertures."""
        says = "no fixed turn at wide apertures"
        turns: defaultdict[tuple[str, str], list[float]] = defaultdict(list)
        for one in self.plain:
            if one.ratio > WIDE and one.angle is not None:
                turns[one.group, one.participant].append(one.angle)
        if not turns:
            return _untested(7, says, f"it needs apertures above {WIDE} shoulder widths")
        of_all = mean(mean(angles) for angles in turns.values())
        found = f"mean {of_all:.2f} degrees above {WIDE}, at most {max(max(angles) for angles in turns.values()):.1f}"
        return Constraint(number=7, says=says, met=of_all <= STRAIGHT, found=found)

    def bar_angles(self) -> dict[float, dict[float, dict[str, float]]]:
        """Returns the mean angle of each participant [degrees] by ratio of the aperture to the total width, length of the bar in shoulder
        widths, and name of the participant; without names where no walker set out."""
        held: defaultdict[float, defaultdict[float, defaultdict[str, list[float]]]]
        held = defaultdict(lambda: defaultdict(lambda: defaultdict(list)))
        for one in self.passings:
            if one.bar is not None and one.straight:
                of = held[round(one.total_ratio, 2)][round(one.bar_ratio, 2)]
                if one.angle is not None:
                    of[one.participant].append(one.angle)
        return {
            ratio: {bar: {name: mean(angles) for name, angles in sorted(of.items())} for bar, of in sorted(bars.items())}
            for ratio, bars in sorted(held.items())
        }

    def longer_bar(self) -> Constraint:
        """8: at the same ratio of aperture to total width, the angle falls with the length of the bar."""
        says = "angle falls with bar length at equal ratio"
        angles = {ratio: bars for ratio, bars in self.bar_angles().items() if len(bars) > 1}
        if not angles:
            return _untested(8, says, "it needs bars of several lengths in the hands")
        met, found = True, list[str]()
        for ratio, bars in angles.items():
            means = [mean(of.values()) if of else math.nan for of in bars.values()]
            met &= all(a > b for a, b in pairwise(means))
            found.append(f"{', '.join('none' if math.isnan(angle) else f'{angle:.1f}' for angle in means)} at A/S {ratio:g}")
        lengths = ", ".join(f"{value:.3g}" for value in next(iter(angles.values())))
        text = f"degrees with bars of {lengths} body widths: {'; '.join(found)}"
        if any(not of for bars in angles.values() for of in bars.values()):
            text += "; none: no walker set out, although people pass"
        return Constraint(number=8, says=says, met=met, found=text)

    def judged(self, participants: Sequence[Sequence[Answer]] | None) -> Constraint:
        """9: the boundary of what is judged to be passable: its whole interval is inside the bounds, outside, or neither."""
        says = "«can pass» from about 1.16, below 1.30"
        if participants is None:
            return _untested(9, says, "it needs judgements, as in the design passability_judgement")
        if len(participants) < MIN_FOR_TESTS:
            return _untested(9, says, "it needs three or more participants")
        boundary = critical_ratio_of_group(participants)
        if boundary is None:
            return _untested(9, says, "it needs judgements of both kinds: all were the same")
        met, text = _within(boundary, PASSABLE), f"from {_ratio_text(boundary)}"
        if met is None:
            return _untested(9, says, f"cannot be decided without more participants, judgements or ratios: {text}")
        return Constraint(number=9, says=says, met=met, found=text)


def _untested(number: int, says: str, why: str) -> Constraint:
    return Constraint(number=number, says=says, met=None, found=why)


def _spans(ratios: Sequence[float], bounds: tuple[float, float]) -> bool:
    return min(ratios) < bounds[0] and max(ratios) > bounds[1]


def _within(ratio: CriticalRatio | None, bounds: tuple[float, float]) -> bool | None:
    """Returns whether a critical ratio is within bounds: None if only a part of its interval is. Ends count as they are shown."""
    if ratio is None:
        return False
    low, high = round(ratio.low, DIGITS), round(ratio.high, DIGITS)
    if bounds[0] <= low and high <= bounds[1]:
        return True
    return None if bounds[0] <= high and low <= bounds[1] else False


def _ratio_text(ratio: CriticalRatio | None) -> str:
    if ratio is None:
        return "none"
    return f"{ratio.value:.{DIGITS}f} (95 % interval {number(ratio.low, DIGITS)} to {number(ratio.high, DIGITS)})"


def _interval(of: Difference) -> str:
    return f"{of.value:.1f} degrees (95 % interval {of.low:.1f} to {of.high:.1f})"


def _sides(left: float, right: float) -> str:
    """Returns the margins on both sides as one number if they are the same."""
    one, other = f"{100 * left:.1f} cm", f"{100 * right:.1f} cm"
    return one if one == other else f"{one} left and {other} right"


def difference(one: Sequence[float], other: Sequence[float]) -> Difference:
    """Compares two means: Welch's t test.

    Args:
        one: One value for each participant of a group; two or more.
        other: The values of the other group.
    """
    value = mean(one) - mean(other)
    errors = [(variance(values) / len(values), len(values) - 1) for values in (one, other)]
    squared = math.fsum(error for error, _ in errors)
    if squared == 0:
        return Difference(value, value, value)
    freedom = squared**2 / math.fsum(error**2 / n for error, n in errors)
    return Difference(value, *t_interval(value, math.sqrt(squared), freedom))


def change(values: Sequence[float]) -> Difference:
    """Compares the mean of participants' changes with none: Student's t test.

    Args:
        values: The change of each participant; two or more.
    """
    value = mean(values)
    return Difference(value, *t_interval(value, stdev(values) / math.sqrt(len(values)), len(values) - 1))


def equivalence(one: Sequence[float], other: Sequence[float], bound: float) -> Equivalence:
    """Tests whether two means differ by less than a bound: two one-sided Welch t tests (TOST).

    Args:
        one: One value for each participant of a group.
        other: The values of the other group.
        bound: The bound, in the unit of the values.
    """
    with noting_warnings() as notes:
        found = pingouin().tost(one, other, bound=bound, correction=True).iloc[0]
    return Equivalence(difference=mean(one) - mean(other), df=float(found["dof"]), p=float(found["pval"]), notes=notes)


def above_zero(value: float, error: float, freedom: float) -> float:
    """Returns the p value of a one-sided t test that a value is above 0.

    Args:
        value: The value.
        error: Its standard error.
        freedom: The degrees of freedom of the standard error.
    """
    if error == 0:
        return float(value <= 0)
    return float(stdtr(freedom, -value / error))
