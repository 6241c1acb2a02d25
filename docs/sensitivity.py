"""Computes how much the chosen numbers of the predictive walker matter: `uv run python docs/sensitivity.py`.

It repeats only the decision: what a walker expects of each turn before a doorway whose width it knows, from the shipped experiences. The
width of the turned body is that of an ellipse. Walking, looking and touching are left out, so that it takes seconds instead of days.
"""

from __future__ import annotations

import random
import sys
from dataclasses import dataclass, replace
from functools import cache
from math import cos, hypot, radians, sin
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from actr3d.actr.loading import load_text
from actr3d.experiment.aperture import experiences
from actr3d.world import Gait

FILE = Path(__file__).parents[1] / "models" / "predictive_walker.py"
MODEL: Any = load_text(FILE.read_text(encoding="utf-8"), str(FILE))
WALKERS = 40
"""Number of walkers, each with memories of its own."""
RATIOS = np.arange(0.9, 1.9, 0.01)
"""Doorways [shoulder widths]."""
CELLS = (("small", 0.404, 1.29, 1.61), ("large", 0.484, 1.28, 1.77))
"""Groups with their shoulder width [m], and their normal and fast speed [m/s]. Source: Warren & Whang (1987)."""
FITTED = 1.30
"""The ratio of the fitted cell [shoulder widths]."""
COSTS = np.geomspace(1.0, 40.0, 60)
"""The costs of contacts among which a fit of simulated data chooses."""
REPETITIONS = 40
"""Number of simulated sets of data for each cost."""
BELOW = 1.25
"""People turn before doorways below this many shoulder widths."""


@dataclass(frozen=True, kw_only=True)
class Deciding:
    """The numbers by which a walker decides."""

    room: float = MODEL.ROOM
    pace: float = MODEL.PACE
    temperature: float = MODEL.TEMPERATURE
    noise: float = MODEL.MEMORY_NOISE
    memories: int = MODEL.MEMORIES
    inertia: float = MODEL.INERTIA
    turning: float = MODEL.TURNING
    contact_cost: float = MODEL.CONTACT_COST
    turns: tuple[int, ...] = MODEL.TURNS
    walks: bool = True

    def turns_before(
        self, shoulders: float, ratios: NDArray[Any], *, speed: float, pace: float | None = None, seed: int = 1
    ) -> NDArray[Any]:
        """Returns the turns that walkers choose [degrees] `(WALKERS, n)`.

        Args:
            shoulders: Their shoulder width [m].
            ratios: The doorways [shoulder widths] `(n,)`.
            speed: The walking speed, which the effort follows from [m/s].
            pace: The speed at which they remember passages [m/s]; None for the same.
            seed: The seed of their memories and of all noise.
        """
        known = experiences(walks=self.walks)
        room, fast, energy = (np.array([one[slot] for one in known]) for slot in ("room", "speed", "energy"))
        choice, noise = random.Random(seed), np.random.default_rng(seed)
        time = self.turning / Gait().steps_per_second(speed)
        widths = [shoulders * hypot(cos(radians(turn)), MODEL.CHEST * sin(radians(turn))) for turn in self.turns]
        efforts = [self.inertia * ((radians(turn) / time) ** 2 + (radians(turn) / MODEL.FEELING) ** 2) for turn in self.turns]
        chosen: list[NDArray[Any]] = []
        for _ in range(WALKERS):
            of = choice.sample(range(len(known)), min(self.memories, len(known)))
            costs: list[NDArray[Any]] = []
            for width, effort in zip(widths, efforts, strict=True):
                far = np.abs(room[of] - (ratios[:, None] * shoulders - width)) / self.room + np.abs(fast[of] - (pace or speed)) / self.pace
                activation = noise.logistic(0, self.noise, far.shape) - far if self.noise else -far
                weights = np.exp((activation - activation.max(axis=1, keepdims=True)) / self.temperature)
                costs.append(effort + self.contact_cost * (weights @ energy[of]) / weights.sum(axis=1))
            chosen.append(np.array(self.turns)[np.argmin(costs, axis=0)])
        return np.array(chosen)

    def critical_ratio(self, shoulders: float = CELLS[0][1], speed: float = CELLS[0][2]) -> float:
        """Returns the least ratio from which on fewer than half of the walkers turn."""
        turned = (self.turns_before(shoulders, RATIOS, speed=speed) > 0).mean(axis=0)
        return float(RATIOS[np.flatnonzero(turned >= 0.5)[-1] + 1])


def effect_of_speed(shoulders: float, normal: float, fast: float) -> tuple[float, float, float]:
    """Returns how much more fast walkers turn than normal ones, below the critical ratio [degrees].

    With what follows from the speed; if only the effort does; and if only the expected impact does.
    """
    below = RATIOS[RATIOS < BELOW]
    speeds = {(normal, normal), (fast, fast), (fast, normal), (normal, fast)}
    mean = {(of, at): Deciding().turns_before(shoulders, below, speed=of, pace=at).mean() for of, at in speeds}
    base = mean[normal, normal]
    return mean[fast, fast] - base, mean[fast, normal] - base, mean[normal, fast] - base


def share_turned(cost: float, *, trials: int, seed: int) -> float:
    """Returns the share of passages that are turned in the fitted cell, at a cost of contacts, of `WALKERS` with some trials each."""
    _, shoulders, normal, _ = CELLS[0]
    return float((Deciding(contact_cost=cost).turns_before(shoulders, np.full(trials, FITTED), speed=normal, seed=seed) > 0).mean())


@cache
def shares_turned() -> NDArray[Any]:
    """Returns the share of turned passages at each of `COSTS`."""
    return np.array([share_turned(cost, trials=25, seed=0) for cost in COSTS])


def found_again(cost: float) -> tuple[float, float, float]:
    """Returns what fits to simulated data find if `cost` is put in: the median, and the range of the middle 80 % of `REPETITIONS`.

    Data have as many passages as the fit of the walks: 200. A fit finds the cost whose share of turned passages is nearest.
    """
    data = [share_turned(cost, trials=5, seed=seed) for seed in range(1, REPETITIONS + 1)]
    found = [COSTS[np.argmin(np.abs(shares_turned() - share))] for share in data]
    low, middle, high = np.quantile(found, (0.1, 0.5, 0.9))
    return float(middle), float(low), float(high)


def report() -> str:
    """Returns the critical ratio with each number halved and doubled, with and without gait, and the effect of speed."""
    usual, lines = Deciding(), list[str]()
    lines.append(f"critical ratio of small walkers at normal speed: {usual.critical_ratio():.2f}")
    for name in ("room", "temperature", "turning", "inertia", "contact_cost", "pace", "noise", "memories"):
        value = getattr(usual, name)
        less, more = (replace(usual, **{name: type(value)(value * factor)}).critical_ratio() for factor in (0.5, 2))
        lines.append(f"  {name} {value:g}: halved {less:.2f}, doubled {more:.2f}")
    lines.append(f"  turns in steps of 5 degrees: {replace(usual, turns=tuple(range(0, 81, 5))).critical_ratio():.2f}")
    for room in (0.005, 0.01, 0.02):
        walks, glides = (replace(usual, room=room, walks=walks).critical_ratio() for walks in (True, False))
        lines.append(f"  room {room:g}: walking {walks:.2f}, gliding {glides:.2f}")
    for name, shoulders, normal, fast in CELLS:
        both, effort, impact = effect_of_speed(shoulders, normal, fast)
        lines.append(f"{name}, fast minus normal: {both:+.1f} degrees; by effort alone {effort:+.1f}, by impact alone {impact:+.1f}")
    for cost in (3.0, 5.0, 8.0, 13.0):
        lines.append("contact_cost {:g} put in: found {:.1f}, from {:.1f} to {:.1f}".format(cost, *found_again(cost)))
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    sys.stdout.write(report())
