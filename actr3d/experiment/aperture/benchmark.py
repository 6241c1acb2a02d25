"""`actr3d bench aperture`: compares the walker's replication with the original's means, and its descriptive variant with human data."""

from __future__ import annotations

import json
import math
import time
from collections import Counter, defaultdict
from dataclasses import asdict, replace
from statistics import mean
from typing import Any

from actr3d.benchmark import benchmark
from actr3d.experiment.aperture.constraints import BARS, Constraint, Findings
from actr3d.experiment.aperture.critical_ratio import critical_ratio
from actr3d.experiment.aperture.trials import APERTURES, CONDITIONS, GROUPS, Outcome, WalkerTrial, experiment, original_means, run_trials

TRIALS = 30
"""The default number of trials per cell. Source: as many as each of the original's agents (docs/human-data.md)."""
AIM, BAR = 2.0, 4.0
"""The targeted and the maximum root mean square difference from the original's means [degrees]."""
JUDGED = tuple(n / 100 for n in range(100, 133, 2))
"""The ratios of aperture to shoulders at which the model judges whether it can pass."""


def cells(outcomes: list[Outcome]) -> dict[tuple[str, str, float], float]:
    """Returns the mean logged angle of each cell [degrees], of agents that reached the wall; see `failures` for the others."""
    found: defaultdict[tuple[str, str, float], list[float]] = defaultdict(list)
    for outcome in outcomes:
        if outcome.result.logged_angle_deg is not None:
            found[outcome.trial.group, outcome.trial.condition, outcome.trial.aperture].append(outcome.result.logged_angle_deg)
    return {key: mean(angles) for key, angles in found.items()}


def failures(outcomes: list[Outcome]) -> list[str]:
    """Returns the trials that did not pass, or touched the wall: one text per cell, with their number, the total, and how they ended."""
    endings: defaultdict[tuple[str, str, float], list[str]] = defaultdict(list)
    sizes = Counter((outcome.trial.group, outcome.trial.condition, outcome.trial.aperture) for outcome in outcomes)
    for outcome in outcomes:
        if outcome.result.outcome != "passed" or outcome.result.contacts:
            how = "touched the wall" if outcome.result.contacts else outcome.result.outcome
            endings[outcome.trial.group, outcome.trial.condition, outcome.trial.aperture].append(how)
    return [
        f"{group} {condition} {100 * aperture:.0f} cm: {len(how)} of {sizes[group, condition, aperture]} ({', '.join(sorted(set(how)))})"
        for (group, condition, aperture), how in sorted(endings.items())
    ]


def unfinished(outcomes: list[Outcome]) -> int:
    """Returns the number of trials that never reached the wall, and have no angle there."""
    return sum(outcome.result.logged_angle_deg is None for outcome in outcomes)


def root_mean_square(found: dict[Any, float], original: dict[Any, float]) -> float:
    """Returns the root mean square difference between cells [degrees]; infinite if a cell is missing."""
    return math.sqrt(mean((found.get(key, math.inf) - angle) ** 2 for key, angle in original.items()))


def judgements(trials: int) -> list[WalkerTrial]:
    """Returns trials of the descriptive variant of which only the judgement is used."""
    agents = [replace(trial, aperture=0.0) for trial in experiment("descriptive", min(trials, 10), [0.0])]
    return [replace(trial, aperture=ratio * trial.shoulders) for trial in agents for ratio in JUDGED]


def measure(trials: int) -> dict[str, Any]:
    """Runs all trials and returns the measurements; plain values."""
    start = time.perf_counter()
    replication, descriptive = (run_trials(experiment(variant, trials)) for variant in ("replication", "descriptive"))
    judged = run_trials(judgements(trials), judging=True)
    spent = time.perf_counter() - start
    boundary = critical_ratio((outcome.trial.ratio, "as it is" not in outcome.said) for outcome in judged)
    original, found = original_means(), cells(replication)
    findings = Findings(outcome.passing for outcome in descriptive)
    constraints = findings.all(boundary=math.nan if boundary is None else boundary.value)
    return {
        "trials": trials,
        "cells": [
            {"group": g, "condition": c, "aperture": a, "angle": round(found.get((g, c, a), math.nan), 2), "original": original[g, c, a]}
            for g, c, a in original
        ],
        "unfinished": unfinished(replication) + unfinished(descriptive),
        "failures": {"replication": failures(replication), "descriptive": failures(descriptive)},
        "rmse": round(root_mean_square(found, original), 3),
        "descriptive": [
            {"group": g, "condition": c, "aperture": a, "angle": round(findings.mean(g, c, a), 2), "margin": findings.margin(g, c, a)}
            for g in GROUPS
            for c in CONDITIONS
            for a in APERTURES
        ],
        "constraints": [asdict(constraint) for constraint in constraints if constraint.number != BARS],
        "ms_a_trial": round(1000 * mean(outcome.cost for outcome in (*replication, *descriptive)), 1),
        "simulated_s_a_trial": round(mean(outcome.result.time_s for outcome in (*replication, *descriptive)), 2),
        "took_s": round(spent, 1),
    }


def _table(title: str, rows: list[dict[str, Any]], beside: str, scale: float = 1) -> list[str]:
    """Returns the lines of a table of angles beside other values: a row per group and condition, a column per aperture."""
    lines = [title, " " * 14 + "".join(f"{100 * aperture:>14.0f}" for aperture in APERTURES)]
    for group in GROUPS:
        for condition in CONDITIONS:
            of = sorted((row for row in rows if (row["group"], row["condition"]) == (group, condition)), key=lambda row: row["aperture"])
            texts = [f"{row['angle']:.1f}" + ("" if row[beside] is None else f" ({scale * row[beside]:.1f})") for row in of]
            lines.append(f"  {group:<6}{condition:<6}" + "".join(f"{text:>14}" for text in texts))
    return lines


@benchmark("aperture")
def main(*, json_output: bool, trials: int = TRIALS) -> int:
    """Measures and prints; returns the exit code: 0 if the bar and all constraints are met, and all agents reach the wall."""
    measured = measure(trials)
    constraints = [Constraint(**constraint) for constraint in measured["constraints"]]
    good = measured["rmse"] <= BAR and not measured["unfinished"] and all(constraint.met for constraint in constraints)
    if json_output:
        print(json.dumps(measured))
        return 0 if good else 1
    print("\n".join(_table("replication: angle at the wall [degrees], mean (original's), by aperture [cm]", measured["cells"], "original")))
    holds = "holds" if measured["rmse"] <= BAR else "MISSED"
    print(f"{holds}  root mean square difference {measured['rmse']:.2f} degrees (at most {BAR:g}; we aim at {AIM:g})\n")
    print(
        "\n".join(
            _table(
                "descriptive: angle at the wall [degrees], mean (smaller margin of those that turned [cm])",
                measured["descriptive"],
                "margin",
                100,
            )
        )
    )
    for constraint in constraints:
        print(f"{'met    ' if constraint.met else 'NOT MET'}  {constraint.number}  {constraint.says}: {constraint.found}")
    for variant, texts in measured["failures"].items():
        print("\n".join([f"{variant}: did not pass, or touched the wall:{'' if texts else ' none'}", *(f"  {text}" for text in texts)]))
    if measured["unfinished"]:
        print(f"MISSED  {measured['unfinished']} trials never reached the wall, and count in no mean")
    print(f"\n{measured['trials']} trials a cell; a trial takes {measured['ms_a_trial']:.0f} ms of one processor for", end=" ")
    print(f"{measured['simulated_s_a_trial']:.1f} s simulated; all took {measured['took_s']:.0f} s")
    return 0 if good else 1
