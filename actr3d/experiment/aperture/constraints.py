"""The constraints on a model of people who pass apertures: those without a hand-held bar, by their numbers in docs/human-data.md.

Agents, not trials, are the unit of analysis: means of agents are compared.
"""

from __future__ import annotations

import math
from collections import defaultdict
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from itertools import pairwise
from statistics import mean, stdev, variance
from typing import Any

import numpy as np
from scipy import optimize
from scipy.special import stdtr

from actr3d.experiment.aperture.trials import CONDITIONS, GROUPS, Outcome, Trial

TURNED = 5.0
"""An agent has turned if its angle is above this [degrees]: people sway by a few degrees (docs/human-data.md). No source: our choice."""
CRITICAL = (1.25, 1.35)
"""The bounds of the ratio of aperture to shoulders at which turning begins. Source: Warren & Whang (1987), 1.28 to 1.31; bounds of
docs/human-data.md."""
POINT = 1.30
"""Below this ratio people turn. Source: Warren & Whang (1987)."""
MARGIN = (0.06, 0.08)
"""The margin on each side [m]. Source: Higuchi's review (docs/human-data.md)."""
PASSABLE = (1.11, 1.21)
"""The bounds of the ratio from which people judge that they can pass without turning. Source: Warren & Whang (1987), about 1.16;
the bounds are our choice."""
SAME = 5.0
"""Angles that differ by less than this count as equal [degrees]. No source: our choice."""
STEADY = 1.0
"""The maximum rise of an angle by chance from one aperture to a wider one [degrees]. No source: our choice."""
WIDE = 1.35
"""Apertures from this ratio on are wide."""


@dataclass(frozen=True, kw_only=True)
class Constraint:
    """One constraint, and whether the model meets it."""

    number: int
    """Its number in docs/human-data.md."""
    says: str
    met: bool
    found: str
    """The model's result, with its numbers."""


def angle(outcome: Outcome) -> float:
    """Returns the angle of the shoulders at the wall [degrees]; for an agent that did not get there, its greatest angle."""
    result = outcome.result
    return result.wall_angle_deg if result.wall_angle_deg is not None else result.peak_angle_deg or 0.0


def margin(outcome: Outcome) -> float | None:
    """Returns the margin on each side of an agent that had to turn and did [m]: the mean of both sides, each at the moment when any
    part was nearest to the wall. Returns None for all others: their margin depends on the aperture only, or they never were in it.
    """
    left, right = outcome.result.clearance_left_m, outcome.result.clearance_right_m
    turned = outcome.trial.ratio < POINT and angle(outcome) > TURNED
    return (left + right) / 2 if left is not None and right is not None and turned else None


class Findings:
    """The results of the human variant, by cell and by agent."""

    def __init__(self, outcomes: Iterable[Outcome]) -> None:
        self.outcomes = list(outcomes)
        self._cells: defaultdict[tuple[str, str, float], list[Outcome]] = defaultdict(list)
        self._agents: defaultdict[tuple[str, str, int], defaultdict[float, list[float]]] = defaultdict(lambda: defaultdict(list))
        for outcome in self.outcomes:
            trial = outcome.trial
            self._cells[trial.group, trial.condition, trial.aperture].append(outcome)
            self._agents[trial.group, trial.condition, trial.agent][trial.aperture].append(angle(outcome))
        self.apertures = sorted({trial.aperture for trial in (outcome.trial for outcome in self.outcomes)})

    def mean(self, group: str, condition: str, aperture: float) -> float:
        """Returns the mean angle of a cell [degrees]."""
        return mean(angle(outcome) for outcome in self._cells[group, condition, aperture])

    def margin(self, group: str, condition: str, aperture: float) -> float | None:
        """Returns the mean margin of the agents in a cell that turned [m]; None if none did."""
        margins = [found for outcome in self._cells[group, condition, aperture] if (found := margin(outcome)) is not None]
        return mean(margins) if margins else None

    def agents(self, group: str) -> list[int]:
        """Returns the agents of a group."""
        return sorted({agent for of, _, agent in self._agents if of == group})

    def curve(self, group: str, condition: str, agent: int) -> tuple[list[float], list[float]]:
        """Returns an agent's ratios of aperture to shoulders, and its mean angles at them [degrees]."""
        angles = self._agents[group, condition, agent]
        shoulders = Trial(variant="", group=group, condition=condition, aperture=0, agent=agent, number=0).shoulders
        return [aperture / shoulders for aperture in sorted(angles)], [mean(angles[aperture]) for aperture in sorted(angles)]

    # -- the constraints

    def all(self, boundary: float) -> list[Constraint]:
        """Returns every constraint that needs no bar.

        Args:
            boundary: The ratio from which the model judges that it can pass without turning.
        """
        made: list[Callable[[], Constraint]] = [self.falls, self.wider_turns_more, self.same_ratio, self.critical, self.faster_turns_more]
        return [*(make() for make in made), self.untouched(), self.upright(), self.judged(boundary)]

    def falls(self) -> Constraint:
        """1: rotation falls with aperture."""
        curves = [[self.mean(group, condition, aperture) for aperture in self.apertures] for group in GROUPS for condition in CONDITIONS]
        rise = max(b - a for curve in curves for a, b in pairwise(curve))
        found = f"largest rise from one aperture to the next {rise:.1f} degrees"
        return Constraint(number=1, says="rotation falls with aperture", met=rise <= STEADY, found=found)

    def wider_turns_more(self) -> Constraint:
        """2: the large group turns more at equal width below about 63 cm."""
        least = min(
            self.mean("large", condition, aperture) - self.mean("small", condition, aperture)
            for condition in CONDITIONS
            for aperture in self.apertures
            if aperture < 0.63
        )
        return Constraint(number=2, says="large > small below 63 cm", met=least > 0, found=f"smallest difference {least:.1f} degrees")

    def same_ratio(self) -> Constraint:
        """3: the groups agree on the ratio: two one-sided t tests of agents."""
        ratios = np.arange(1.0, 1.41, 0.05)
        scores = {
            group: [
                float(np.mean([np.interp(ratios, *self.curve(group, condition, agent)) for condition in CONDITIONS]))
                for agent in self.agents(group)
            ]
            for group in GROUPS
        }
        difference, p = equivalence(scores["large"], scores["small"], SAME)
        found = f"large minus small {difference:.1f} degrees, within {SAME:g}: p = {p:.3g}"
        return Constraint(number=3, says="groups coincide on A/S", met=p < 0.05, found=found)

    def critical(self) -> Constraint:
        """4: the critical ratio of each cell."""
        found = {
            (group, condition): turning_point(
                (outcome.trial.ratio, angle(outcome) > TURNED)
                for outcome in self.outcomes
                if (outcome.trial.group, outcome.trial.condition) == (group, condition)
            )
            for group in GROUPS
            for condition in CONDITIONS
        }
        met = all(CRITICAL[0] <= ratio <= CRITICAL[1] for ratio in found.values())
        says = f"critical ratio {CRITICAL[0]} to {CRITICAL[1]} in each cell"
        return Constraint(number=4, says=says, met=met, found=", ".join(f"{g} {c} {ratio:.3f}" for (g, c), ratio in found.items()))

    def faster_turns_more(self) -> Constraint:
        """5: fast minus normal below the critical point, by agents."""
        found: list[str] = []
        met = True
        for group in GROUPS:
            differences: list[float] = []
            for agent in self.agents(group):
                (ratios, normal), (_, fast) = (self.curve(group, condition, agent) for condition in ("normal", "fast"))
                below = [b - a for ratio, a, b in zip(ratios, normal, fast, strict=True) if ratio < CRITICAL[0]]
                differences.append(mean(below))
            p = above_zero(mean(differences), stdev(differences) / math.sqrt(len(differences)), len(differences) - 1)
            met &= p < 0.05
            found.append(f"{group} {mean(differences):+.1f} degrees (p = {p:.2g})")
        return Constraint(number=5, says="fast > normal below the critical ratio", met=met, found=", ".join(found))

    def untouched(self) -> Constraint:
        """6: no contact, and the margin of agents that turned, at each aperture."""
        touched = sum(outcome.result.contacts > 0 for outcome in self.outcomes)
        passed = sum(outcome.result.outcome == "passed" for outcome in self.outcomes)
        margins: defaultdict[float, list[float]] = defaultdict(list)
        for outcome in self.outcomes:
            room = margin(outcome)
            if room is not None:
                margins[outcome.trial.aperture].append(room)
        means = {aperture: mean(of) for aperture, of in sorted(margins.items())}
        found = f"{touched} of {len(self.outcomes)} touched, {passed} passed; mean margin of agents that turned "
        found += ", ".join(f"{100 * room:.1f} cm at {100 * aperture:.0f}" for aperture, room in means.items())
        met = touched == 0 and passed == len(self.outcomes) and bool(means)
        met &= all(MARGIN[0] <= room <= MARGIN[1] for room in means.values())
        return Constraint(number=6, says="no contact, margin 6 to 8 cm at each aperture", met=met, found=found)

    def upright(self) -> Constraint:
        """7: no constant turn at wide apertures."""
        turns = [angle(outcome) for outcome in self.outcomes if outcome.trial.ratio > WIDE]
        found = f"mean {mean(turns):.2f} degrees above {WIDE}, at most {max(turns):.1f}"
        return Constraint(number=7, says="no fixed turn at wide apertures", met=mean(turns) <= 3, found=found)

    def judged(self, boundary: float) -> Constraint:
        """9: the boundary of what is judged to be passable."""
        met = PASSABLE[0] <= boundary <= PASSABLE[1]
        return Constraint(number=9, says="«can pass» from about 1.16, below 1.30", met=met, found=f"from {boundary:.3f}")


def equivalence(one: Sequence[float], other: Sequence[float], bound: float) -> tuple[float, float]:
    """Returns the difference of two means, and the p value of the two one-sided (Welch) t tests that it is within a bound."""
    difference = mean(one) - mean(other)
    parts = [variance(values) / len(values) for values in (one, other)]
    squares = sum(part**2 / (len(values) - 1) for part, values in zip(parts, (one, other), strict=True))
    freedom = sum(parts) ** 2 / squares if squares else 1.0
    return difference, above_zero(bound - abs(difference), math.sqrt(sum(parts)), freedom)


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


def turning_point(trials: Iterable[tuple[float, bool]]) -> float:
    """Returns the ratio at which half of the trials have a property, by a logistic fit whose slope is at most 200 per unit.

    Args:
        trials: The ratio, and whether the trial has the property, which is more likely at small ratios.
    """
    pairs = sorted(trials)
    ratios, has = np.array([ratio for ratio, _ in pairs]), np.array([yes for _, yes in pairs], dtype=float)

    def unlikely(values: Any) -> float:
        centre, slope = values
        signed = slope * (ratios - centre)
        return float(np.sum(np.logaddexp(0.0, signed) - (1 - has) * signed)) if slope > 0 else math.inf

    low, high = float(ratios[0]), float(ratios[-1])
    starts = [(low + (high - low) * n / 40, slope) for n in range(41) for slope in (20.0, 200.0)]
    best = min(starts, key=unlikely)
    bounds = [(low, high), (1.0, 200.0)]
    return float(optimize.minimize(unlikely, best, bounds=bounds, method="L-BFGS-B").x[0])
