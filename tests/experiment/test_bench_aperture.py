"""The aperture benchmark: its trials are the model's, and its constraints tell good models from bad ones."""

from __future__ import annotations

import json
import math
import random
from collections.abc import Callable
from dataclasses import replace
from statistics import mean, stdev
from typing import Any

import pytest

from actr3d.cli import main
from actr3d.experiment.aperture import PassageResult, benchmark
from actr3d.experiment.aperture.constraints import Findings, equivalence
from actr3d.experiment.aperture.critical_ratio import critical_ratio
from actr3d.experiment.aperture.trials import APERTURES, CONDITIONS, GROUPS, Outcome, WalkerTrial, experiment, original_means, run_trial


def test_the_originals_means_are_there() -> None:
    means = original_means()
    assert len(means) == 28
    assert means["small", "normal", 0.40] == 57.69
    assert means["large", "fast", 0.55] == 39.92
    assert set(means) == {(group, condition, wide) for group in GROUPS for condition in CONDITIONS for wide in APERTURES}


def test_agents_have_the_mean_and_deviation_of_their_group() -> None:
    for variant, group, sd in (("descriptive", "small", 0.02), ("descriptive", "large", 0.007), ("replication", "small", 0.007)):
        trials = [WalkerTrial(variant=variant, group=group, condition="normal", aperture=0.5, agent=n, number=0) for n in range(5)]
        shoulders = [trial.shoulders for trial in trials]
        assert mean(shoulders) == pytest.approx(GROUPS[group][0], abs=1e-4)
        assert stdev(shoulders) == pytest.approx(sd, abs=1e-4)


def test_an_experiment_shares_its_trials_among_agents() -> None:
    trials = experiment("descriptive", 12)
    assert len(trials) == 28 * 12
    assert len({trial.seed for trial in trials}) == len(trials)
    cell = [trial for trial in trials if (trial.group, trial.condition, trial.aperture) == ("small", "fast", 0.45)]
    assert sorted(trial.agent for trial in cell) == [0, 0, 0, 1, 1, 1, 2, 2, 3, 3, 4, 4]


def test_a_trial_is_a_run_of_the_model() -> None:
    trial = WalkerTrial(variant="descriptive", group="large", condition="fast", aperture=0.5, agent=2, number=0)
    once, again = run_trial(trial), run_trial(trial)
    assert (once.result, once.said) == (again.result, again.said)
    assert once.result.outcome == "passed"
    assert once.result.speed_m_s == pytest.approx(1.77, abs=0.01)
    assert "can pass turned" in once.said
    judged = run_trial(trial, judging=True)
    assert judged.said.strip() == once.said.splitlines()[0]
    assert judged.result.time_s < 6


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


def test_equivalence_takes_small_differences_and_small_spread() -> None:
    near, far, wide = [20.0, 21.0, 22.0, 21.0, 20.5], [28.0, 29.0, 30.0, 29.0, 28.5], [5.0, 40.0, 12.0, 33.0, 16.0]
    assert equivalence(near, [21.0, 20.0, 21.5, 20.5, 22.0], 5)[1] < 0.01
    assert equivalence(far, near, 5) == (pytest.approx(8.0), pytest.approx(1, abs=0.01))
    assert equivalence(wide, near, 5)[1] > 0.05


def good(trial: WalkerTrial) -> PassageResult:
    """Returns what a model of people would do: a margin of 0.15 of the shoulders, and some more when it is fast."""
    need = trial.aperture / 1.3 / trial.shoulders
    angle = 0.0 if need >= 1 else math.degrees(math.acos(need)) + (4 if trial.condition == "fast" else 0) + 0.1 * trial.number
    return PassageResult(
        outcome="passed",
        peak_angle_deg=angle,
        wall_angle_deg=angle,
        logged_angle_deg=angle,
        onset_distance_m=1.4 if angle else None,
        onset_time_s=9.0 if angle else None,
        contacts=0,
        max_force_n=0.0,
        impulse_n_s=0.0,
        clearance_left_m=0.069,
        clearance_right_m=0.071,
        speed_m_s=1.3,
        time_s=11.0,
    )


def outcomes(of: Callable[[WalkerTrial], PassageResult]) -> list[Outcome]:
    return [Outcome(trial=trial, result=of(trial), said="", cost=0.3) for trial in experiment("descriptive", 10)]


def findings(of: Callable[[WalkerTrial], PassageResult]) -> Findings:
    return Findings(outcome.passing for outcome in outcomes(of))


def unmet(of: Callable[[WalkerTrial], PassageResult], boundary: float = 1.16) -> list[int]:
    return [constraint.number for constraint in findings(of).all(boundary=boundary) if constraint.met is False]


def with_angle(trial: WalkerTrial, angle: float, **other: Any) -> PassageResult:
    return replace(good(trial), wall_angle_deg=angle, peak_angle_deg=angle, **other)


def with_margin(trial: WalkerTrial, room: float) -> PassageResult:
    return replace(good(trial), clearance_left_m=room, clearance_right_m=room)


def test_a_walker_that_does_not_turn_has_no_margin() -> None:
    """At wide apertures there is more room than anyone wants, which is no margin."""
    found = findings(lambda trial: with_margin(trial, 0.07 if good(trial).wall_angle_deg else 0.14))
    assert found.margin("large", "fast", 0.45) == pytest.approx(0.07)
    assert found.margin("small", "normal", 0.7) is None
    assert found.untouched().met


def test_a_model_of_people_meets_all_constraints() -> None:
    assert unmet(good) == []


BAD: dict[str, tuple[list[int], Callable[[WalkerTrial], PassageResult]]] = {
    "turns more before a wider one": ([1], lambda trial: with_angle(trial, 60.0) if trial.aperture == 0.45 else good(trial)),
    "turns everywhere": ([7, 4], lambda trial: with_angle(trial, max(good(trial).wall_angle_deg or 0, 18.0))),
    "turns by width alone": ([2, 3, 4], lambda trial: with_angle(trial, max(0.0, 300 * (0.6 - trial.aperture)))),
    "turns at a smaller ratio": ([4], lambda trial: good(trial) if trial.ratio < 1.2 else with_angle(trial, 0.0)),
    "turns less when fast": (
        [5],
        lambda trial: with_angle(trial, max(0.0, (good(trial).wall_angle_deg or 0) - (8 if trial.condition == "fast" else 0))),
    ),
    "touches once": ([6], lambda trial: replace(good(trial), contacts=int(trial.number == trial.agent == 1 and trial.aperture == 0.4))),
    "leaves too little": ([6], lambda trial: replace(good(trial), clearance_left_m=0.03)),
    "leaves too little where it is narrowest": ([6], lambda trial: with_margin(trial, 0.04 if trial.aperture == 0.4 else 0.07)),
    "leaves too much where it turns least": ([6], lambda trial: with_margin(trial, 0.09 if trial.aperture == 0.6 else 0.07)),
    "stops": ([6], lambda trial: replace(good(trial), outcome="stopped") if trial.aperture == 0.4 else good(trial)),
}


@pytest.mark.parametrize("what", BAD)
def test_each_wrong_model_fails_the_constraints_that_it_should_fail(what: str) -> None:
    expected, of = BAD[what]
    assert set(unmet(of)) >= set(expected)
    assert unmet(of) != unmet(good)


def test_where_it_can_pass_is_one_of_them() -> None:
    assert unmet(good, 1.30) == [9]
    assert unmet(good, 1.0) == [9]


def test_a_cell_without_trials_is_no_agreement() -> None:
    original = original_means()
    found = dict(original)
    assert benchmark.root_mean_square(found, original) == 0
    found["small", "normal", 0.40] += 28**0.5
    assert benchmark.root_mean_square(found, original) == pytest.approx(1)
    del found["small", "normal", 0.40]
    assert benchmark.root_mean_square(found, original) == math.inf


@pytest.mark.parametrize(("rise", "code"), [(0.0, 0), (9.0, 1)])
def test_it_prints_all_cells_and_constraints(rise: float, code: int, monkeypatch: pytest.MonkeyPatch, capsys: Any) -> None:
    original = original_means()

    def run(trials: list[WalkerTrial], *, judging: bool = False) -> list[Outcome]:
        def result(trial: WalkerTrial) -> PassageResult:
            if trial.variant == "descriptive":
                return good(trial)
            angle = original[trial.group, trial.condition, trial.aperture] + rise
            return replace(good(trial), logged_angle_deg=angle)

        said = ["can pass as it is" if judging and trial.ratio > 1.155 else "can pass turned" for trial in trials]
        return [Outcome(trial=trial, result=result(trial), said=text, cost=0.3) for trial, text in zip(trials, said, strict=True)]

    monkeypatch.setattr(benchmark, "run_trials", run)
    assert main(["bench", "aperture", "--trials", "5"]) == code
    told = capsys.readouterr().out
    assert f"root mean square difference {rise:.2f} degrees" in told
    assert f"{57.69 + rise:.1f} (57.7)" in told
    assert told.count("\nmet ") == 8
    turned = {
        (trial.group, trial.condition, trial.aperture) for trial in experiment("descriptive", 5) if (good(trial).wall_angle_deg or 0) > 5
    }
    assert told.split("descriptive: angle")[1].count(" (6.9)") == len(turned)
    assert "mean margin of agents that turned 6.9 cm left and 7.1 cm right at 40, 6.9 cm left and 7.1 cm right at 45" in told
    assert "5 trials a cell; a trial takes 300 ms of one processor for 11.0 s simulated" in told
    assert main(["bench", "aperture", "--trials", "5", "--json"]) == code
    measured = json.loads(capsys.readouterr().out)
    assert (len(measured["cells"]), len(measured["constraints"]), measured["rmse"]) == (28, 8, rise)


def test_a_number_of_trials_that_is_none_is_refused(capsys: Any) -> None:
    with pytest.raises(SystemExit) as refused:
        main(["bench", "aperture", "--trials", "0"])
    assert refused.value.code == 2
    assert "must be a whole number >= 1 (got 0)" in capsys.readouterr().err


def test_trials_that_fail_are_reported_and_count(monkeypatch: pytest.MonkeyPatch, capsys: Any) -> None:
    """One walker in a cell never reaches the wall, another touches it: no mean of a cell would show the first."""
    original = original_means()

    def run(trials: list[WalkerTrial], *, judging: bool = False) -> list[Outcome]:
        outcomes: list[Outcome] = []
        for trial in trials:
            result = good(trial)
            if trial.variant == "replication":
                result = replace(result, logged_angle_deg=original[trial.group, trial.condition, trial.aperture])
                if (trial.group, trial.condition, trial.aperture, trial.agent) == ("large", "fast", 0.4, 0):
                    result = replace(result, outcome="stopped", logged_angle_deg=None, wall_angle_deg=None)
                if (trial.group, trial.condition, trial.aperture, trial.agent) == ("large", "fast", 0.4, 1):
                    result = replace(result, contacts=1)
            said = "can pass as it is" if judging and trial.ratio > 1.155 else "can pass turned"
            outcomes.append(Outcome(trial=trial, result=result, said=said, cost=0.3))
        return outcomes

    monkeypatch.setattr(benchmark, "run_trials", run)
    assert main(["bench", "aperture", "--trials", "5"]) == 1
    told = capsys.readouterr().out
    assert "replication: did not pass, or touched the wall:\n  large fast 40 cm: 2 of 5 (stopped, touched the wall)\n" in told
    assert "descriptive: did not pass, or touched the wall: none\n" in told
    assert "MISSED  1 trials never reached the wall" in told
    assert "root mean square difference 0.00 degrees" in told
    assert main(["bench", "aperture", "--trials", "5", "--json"]) == 1
    assert json.loads(capsys.readouterr().out)["unfinished"] == 1
