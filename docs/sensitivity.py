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
from typing import Any, Literal, get_args

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
COSTS = np.geomspace(5.0, 200.0, 60)
"""The costs of contacts among which a fit of simulated data chooses."""
REPETITIONS = 40
"""Number of simulated sets of data for each cost."""
BELOW = 1.25
"""People turn before doorways below this many shoulder widths."""
Likeness = Literal["room", "room in metres", "ratio", "widths"]
"""What makes two passages alike: the room, seen minus felt width, in shoulder widths, as the model has it; room in metres; the ratio of
seen and felt width; or both widths one by one."""


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
    likeness: Likeness = "room"

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
        by = replace(self, contact_cost=0.0)  # so that all costs share one result
        efforts, impacts = expected(by, shoulders, tuple(ratios), speed=speed, pace=pace or speed, seed=seed)
        return np.array(self.turns)[np.argmin(efforts[:, None] + self.contact_cost * impacts, axis=1)]

    def compared(self, seen: Any, felt: Any, shoulders: Any) -> tuple[Any, ...]:
        """Returns what is compared of passages [m], from their seen and felt widths and the walkers' shoulders [m].

        Shoulder widths are multiplied by that of a body for which rooms are as similar as in metres.
        """
        unit = MODEL.BODY
        compared: dict[Likeness, tuple[Any, ...]] = {
            "room": ((seen - felt) / shoulders * unit,),
            "room in metres": (seen - felt,),
            "ratio": (seen / felt * unit,),
            "widths": (seen, felt),
        }
        return compared[self.likeness]

    def activation(self, far: NDArray[Any], noise: np.random.Generator) -> NDArray[Any]:
        """Returns the activation of memories for each doorway `(m, n)`, from how dissimilar they are `(m, n)`."""
        return noise.logistic(0, self.noise, far.shape) - far if self.noise else -far

    def blended(self, far: NDArray[Any], values: NDArray[Any], noise: np.random.Generator) -> NDArray[Any]:
        """Returns the blend of the values of memories `(n,)` for each doorway `(m,)`, from how dissimilar they are `(m, n)`."""
        activation = self.activation(far, noise)
        weights = np.exp((activation - activation.max(axis=1, keepdims=True)) / self.temperature)
        return (weights @ values) / weights.sum(axis=1)

    def critical_ratio(self, shoulders: float = CELLS[0][1], speed: float = CELLS[0][2]) -> float:
        """Returns the least ratio from which on fewer than half of the walkers turn."""
        turned = (self.turns_before(shoulders, RATIOS, speed=speed) > 0).mean(axis=0)
        return float(RATIOS[np.flatnonzero(turned >= 0.5)[-1] + 1])


@cache
def expected(
    by: Deciding, shoulders: float, ratios: tuple[float, ...], *, speed: float, pace: float, seed: int
) -> tuple[NDArray[Any], NDArray[Any]]:
    """Returns the effort of each turn `(turns,)`, and the impact that walkers expect of it `(WALKERS, turns, doorways)`.

    Neither depends on the cost of contacts.
    """
    known = experiences(walks=by.walks)
    fast, energy = (np.array([one[slot] for one in known]) for slot in ("speed", "energy"))
    passages = [np.array([one[slot] for one in known]) for slot in ("seen", "felt", "shoulders")]
    choice, noise = random.Random(seed), np.random.default_rng(seed)
    time = by.turning / Gait().steps_per_second(speed)
    widths = [shoulders * hypot(cos(radians(turn)), MODEL.CHEST * sin(radians(turn))) for turn in by.turns]
    efforts = [MODEL.work(turn, speed, time, by.inertia) for turn in by.turns]
    impacts: list[list[NDArray[Any]]] = []
    for _ in range(WALKERS):
        some = choice.sample(range(len(known)), min(by.memories, len(known)))
        impacts.append([])
        for width in widths:
            now = by.compared(np.array(ratios)[:, None] * shoulders, width, shoulders)
            apart = sum(np.abs(there[some] - here) for there, here in zip(by.compared(*passages), now, strict=True))
            far = apart / by.room + np.abs(fast[some] - pace) / by.pace
            impacts[-1].append(by.blended(far, energy[some], noise))
    return np.array(efforts), np.array(impacts)


def judged_boundary(by: Deciding, counts: str = "free") -> float:
    """Returns the least ratio from which on half of the walkers judge that they can pass as they are, by the most active passage.

    Args:
        by: The numbers by which they remember passages, at any speed.
        counts: What the passage must have been: `free`, or `passed`, with or without contact.
    """
    known = experiences(walks=by.walks)
    could = np.array([one[counts] for one in known])
    rooms = np.array([(one["seen"] - one["felt"]) / one["shoulders"] for one in known]) * MODEL.BODY
    choice, noise = random.Random(1), np.random.default_rng(1)
    judged: list[NDArray[Any]] = []
    for _ in range(WALKERS):
        some = choice.sample(range(len(known)), min(by.memories, len(known)))
        far = np.abs(rooms[some] - (RATIOS[:, None] - 1) * MODEL.BODY) / by.room
        judged.append(could[some][by.activation(far, noise).argmax(axis=1)])
    return float(RATIOS[np.flatnonzero(np.mean(judged, axis=0) < 0.5)[-1] + 1])


def effect_of_speed(shoulders: float, normal: float, fast: float) -> tuple[float, float, float]:
    """Returns how much more fast walkers turn than normal ones, below the critical ratio [degrees].

    With what follows from the speed; if only the effort does; and if only the expected impact does.
    """
    below = RATIOS[RATIOS < BELOW]
    speeds = {(normal, normal), (fast, fast), (fast, normal), (normal, fast)}
    mean = {(of, at): Deciding().turns_before(shoulders, below, speed=of, pace=at).mean() for of, at in speeds}
    base = mean[normal, normal]
    return mean[fast, fast] - base, mean[fast, normal] - base, mean[normal, fast] - base


def share_turned(of: Deciding, *, trials: int, seed: int) -> float:
    """Returns the share of passages that are turned in the fitted cell, of `WALKERS` with some trials each."""
    _, shoulders, normal, _ = CELLS[0]
    return float((of.turns_before(shoulders, np.full(trials, FITTED), speed=normal, seed=seed) > 0).mean())


def fitted(**changed: Any) -> Deciding:
    """Returns the decision with other numbers, and with that cost among `COSTS` by which nearest to half of the fitted cell is turned."""
    of = [Deciding(**changed, contact_cost=cost) for cost in COSTS]
    return min(of, key=lambda one: abs(share_turned(one, trials=25, seed=0) - 0.5))


def found_by(of: Deciding) -> str:
    """Returns the fitted cost, the share that is turned in the fitted cell, and the critical ratios of all cells, as a text."""
    ratios = ", ".join(f"{of.critical_ratio(shoulders, speed):.2f}" for _, shoulders, *speeds in CELLS for speed in speeds)
    share = share_turned(of, trials=25, seed=0)
    return f"contact_cost {of.contact_cost:.1f}, {share:.0%} turned: critical ratios {ratios}"


def large_minus_small(of: Deciding) -> float:
    """Returns how much more large walkers turn than small ones at the same ratio, at normal speed, below the critical ratio [degrees]."""
    below = RATIOS[RATIOS < BELOW]
    small, large = (of.turns_before(shoulders, below, speed=normal).mean() for _, shoulders, normal, _ in CELLS)
    return float(large - small)


@cache
def shares_turned() -> NDArray[Any]:
    """Returns the share of turned passages at each of `COSTS`."""
    return np.array([share_turned(Deciding(contact_cost=cost), trials=25, seed=0) for cost in COSTS])


def found_again(cost: float) -> tuple[float, float, float]:
    """Returns what fits to simulated data find if `cost` is put in: the median, and the range of the middle 80 % of `REPETITIONS`.

    Data have as many passages as the fit of the walks: 200. A fit finds the cost whose share of turned passages is nearest.
    """
    data = [share_turned(Deciding(contact_cost=cost), trials=5, seed=seed) for seed in range(1, REPETITIONS + 1)]
    found = [COSTS[np.argmin(np.abs(shares_turned() - share))] for share in data]
    low, middle, high = np.quantile(found, (0.1, 0.5, 0.9))
    return float(middle), float(low), float(high)


def report() -> str:
    """Returns how critical ratios, the judgement, the effect of speed and the fit depend on the numbers."""
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
    lines.append("with contact_cost fitted again")
    for room in (0.005, 0.01, 0.015, 0.02, 0.03, 0.04):
        lines.append(f"  room {room:g}, {found_by(fitted(room=room))}")
    lines.append(f"  gliding, {found_by(fitted(walks=False))}")
    for likeness in get_args(Likeness):
        of = fitted(likeness=likeness)
        lines.append(f"  alike by {likeness}, {found_by(of)}")
        lines.append(f"    large minus small: {large_minus_small(of):+.1f} degrees")
    lines.append(f"judged passable: from {judged_boundary(usual):.2f}")
    lines.append(f"  with a brush, too: from {judged_boundary(usual, counts='passed'):.2f}")
    for name, value in (("room", 0.01), ("room", 0.04), ("noise", 0.5 * usual.noise), ("noise", 2 * usual.noise), ("memories", 75)):
        lines.append(f"  {name} {value:g}: from {judged_boundary(replace(usual, **{name: value})):.2f}")
    for name, shoulders, normal, fast in CELLS:
        both, effort, impact = effect_of_speed(shoulders, normal, fast)
        lines.append(f"{name}, fast minus normal: {both:+.1f} degrees; by effort alone {effort:+.1f}, by impact alone {impact:+.1f}")
    for cost in (15.0, 30.0, 45.0, 70.0):
        lines.append("contact_cost {:g} put in: found {:.1f}, from {:.1f} to {:.1f}".format(cost, *found_again(cost)))
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    sys.stdout.write(report())
