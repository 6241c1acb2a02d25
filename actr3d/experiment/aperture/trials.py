"""Trials of the aperture experiment: runs the walker model many times, in one process per processor."""

from __future__ import annotations

import csv
import io
import os
import statistics
import time
from collections.abc import Iterable, Sequence
from concurrent.futures import ProcessPoolExecutor
from contextlib import redirect_stdout
from dataclasses import dataclass
from functools import cache, partial
from pathlib import Path
from typing import Any

import actr3d
from actr3d.actr.kernel.run_limits import RunLimits
from actr3d.actr.loading.source_text import read_source
from actr3d.experiment.aperture.passage import PassageResult
from actr3d.experiment.aperture.passing import Passing
from actr3d.runner.model_factory import Blueprint

GROUPS = {"small": (0.404, 0.020), "large": (0.484, 0.007)}
"""The mean and standard deviation of shoulder widths [m]. Source: Warren & Whang (1987)."""
ALIKE = 0.007
"""The standard deviation of the replication's shoulder widths, in both groups [m]. Source: the original's small agents differ by 0.5
degrees at 45 cm and 1.2 at 50 (its own trials); agents that differ by 2 cm would turn by either 18 or 46 degrees there."""
CONDITIONS = ("normal", "fast")
APERTURES = tuple(n / 100 for n in range(40, 75, 5))
"""[m]. Source: as in the original model's trials (docs/human-data.md)."""
AGENTS = 5
"""The number of agents in each group. Source: Warren & Whang (1987)."""
LONGEST = 30.0
"""The maximum length of a trial [s of simulated time]."""
_SPREAD = tuple(statistics.NormalDist().inv_cdf((n + 0.5) / AGENTS) for n in range(AGENTS))


@dataclass(frozen=True, kw_only=True)
class WalkerTrial:
    """One run of the model."""

    variant: str
    group: str
    condition: str
    aperture: float
    """[m]"""
    agent: int
    """The number of the agent in its group, from 0."""
    number: int
    """The number of the trial of this agent in its cell, from 0."""

    @property
    def shoulders(self) -> float:
        """The width of the agent's shoulders [m]: the agents of a group have the group's mean and standard deviation."""
        mean, sd = GROUPS[self.group]
        if self.variant == "replication":
            sd = ALIKE
        return round(mean + sd * _SPREAD[self.agent] / statistics.stdev(_SPREAD), 4)

    @property
    def ratio(self) -> float:
        """The aperture divided by the shoulder width."""
        return self.aperture / self.shoulders

    @property
    def seed(self) -> str:
        """The seed of its random choices."""
        return f"{self.variant} {self.group} {self.condition} {self.aperture:g} {self.agent} {self.number}"


@dataclass(frozen=True, kw_only=True)
class Outcome:
    """The result of a trial."""

    trial: WalkerTrial
    result: PassageResult
    said: str
    """The model's output."""
    cost: float
    """Processor time [s]."""

    @property
    def passing(self) -> Passing:
        """The trial in the form that is analysed."""
        trial, result = self.trial, self.result
        return Passing(
            participant=f"{trial.group} {trial.agent}",
            group=trial.group,
            condition=trial.condition,
            aperture=trial.aperture,
            shoulders=trial.shoulders,
            angle=result.wall_angle_deg if result.wall_angle_deg is not None else result.peak_angle_deg,
            left=result.clearance_left_m,
            right=result.clearance_right_m,
            contacts=result.contacts,
            passed=result.outcome == "passed",
        )


def model_file() -> Path:
    """Returns the path of the model: beside the library in a copy of the repository, within it if installed."""
    library = Path(actr3d.__file__).parent
    installed = library / "models" / "aperture_passage.py"
    return installed if installed.exists() else library.parent / "models" / "aperture_passage.py"


@cache
def _blueprint() -> Blueprint:
    path = model_file()
    return Blueprint(read_source(path), str(path), path.parent)


def run_trial(trial: WalkerTrial, *, judging: bool = False) -> Outcome:
    """Runs one trial.

    Args:
        trial: The trial.
        judging: Whether to end it as soon as the model has judged whether it can pass.
    """
    blueprint = _blueprint()
    start = time.process_time()
    settings = {"variant": trial.variant, "group": trial.group, "condition": trial.condition}
    with redirect_stdout(io.StringIO()) as said, RunLimits(seed=trial.seed):
        simulation, _ = blueprint.build({**settings, "aperture": trial.aperture, "shoulder_width": trial.shoulders})
        simulation.run(LONGEST, until=(lambda _: "pass" in said.getvalue()) if judging else None)
    return Outcome(trial=trial, result=simulation.result(), said=said.getvalue(), cost=time.process_time() - start)


def run_trials(trials: Sequence[WalkerTrial], *, judging: bool = False) -> list[Outcome]:
    """Runs trials, one at a time on each processor, and returns their outcomes in the same order.

    Args:
        trials: The trials.
        judging: Whether to end each as soon as the model has judged whether it can pass.
    """
    with ProcessPoolExecutor(os.cpu_count()) as pool:
        return list(pool.map(partial(run_trial, judging=judging), trials, chunksize=4))


def experiment(variant: str, trials: int, apertures: Iterable[float] = APERTURES) -> list[WalkerTrial]:
    """Returns all trials of a variant: for both groups and conditions, `trials` per aperture, divided among the agents."""
    return [
        WalkerTrial(variant=variant, group=group, condition=condition, aperture=aperture, agent=n % AGENTS, number=n // AGENTS)
        for group in GROUPS
        for condition in CONDITIONS
        for aperture in apertures
        for n in range(trials)
    ]


def original_means() -> dict[tuple[str, str, float], float]:
    """Returns the original ACT-R 3D's mean angles [degrees] by group, condition and aperture [m].

    Source: its own trials, 150 per cell (docs/human-data.md).
    """
    with (Path(__file__).parent / "original_means.csv").open(encoding="utf-8") as file:
        rows: list[Any] = list(csv.DictReader(file))
    return {(row["group"], row["speed"], int(row["A"]) / 100): float(row["mean_deg"]) for row in rows}
