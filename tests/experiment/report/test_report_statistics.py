"""Statistics of reports: known answers, participants as the unit, and what a design does not allow."""

from __future__ import annotations

import math
import random
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from actr3d.experiment.aperture.critical_ratio import bend, critical_ratio
from actr3d.experiment.aperture.passing import baseline_angle
from actr3d.experiment.report import statistics
from actr3d.experiment.report.general import measure_sections
from actr3d.experiment.report.libraries import pandas
from actr3d.experiment.report.parts import Caution
from actr3d.experiment.report.results import Results, by_number, read_results
from actr3d.experiment.report.statistics import bootstrap_interval, cell_means, participant_means, rmse_and_r, run_tests
from tests.helpers.experiments import write_experiment
from tests.helpers.reports import store_rows

GROUPED = '''
from actr3d.experiment import Design, Group, design


@design
def counting():
    """Counts to several numbers."""
    return Design(
        model="counter.py",
        factors={"n": [1, 2, 5], "mode": ["count", "fail"]},
        groups={"young": Group(participants=4), "old": Group(participants=4)},
        trials=2,
        measures=["rt", "luck"],
    )
'''


def grouped(folder: Path, *, effect: float, design: str = GROUPED, **options: Any) -> Results:
    """Returns the results of two groups, three numbers and two modes; the old are slower by `effect`, and each number costs 1 s."""
    path = write_experiment(folder)
    path.write_text(design, encoding="utf-8")
    draw = random.Random(3)
    person = {f"{group} {n}": draw.gauss(0, 0.3) for group in ("young", "old") for n in range(1, 9)}

    def measures(trial: Any) -> dict[str, Any]:
        slow = effect if trial.participant.group == "old" else 0.0
        rt = trial.values["n"] + slow + person[trial.participant.name] + draw.gauss(0, 0.1)
        return {"rt": rt, "luck": 0.5}

    return read_results(store_rows(folder / "out", str(path), measures, **options))


def test_participants_are_the_unit_of_means() -> None:
    rows = pandas().DataFrame({"participant": ["a", "a", "a", "b"], "group": ["all"] * 4, "rt": [1.0, 1.0, 1.0, 3.0]})
    assert participant_means(rows, "rt", [])["value"].tolist() == [1.0, 3.0]
    cell = cell_means(rows, "rt", ["group"]).iloc[0]
    assert (cell["mean"], cell["n"], cell["trials"]) == (2.0, 2, 4)
    assert cell["sd"] == pytest.approx(math.sqrt(2))
    assert (cell["low"], cell["high"]) == (1.0, 3.0)


def test_bootstrap_intervals_are_the_same_each_time_and_cover_the_mean() -> None:
    draw = np.random.default_rng(5)
    covered = 0
    for _ in range(200):
        values = draw.normal(10, 2, 30).tolist()
        low, high = bootstrap_interval(values)
        assert (low, high) == bootstrap_interval(values)
        covered += low < 10 < high
    assert 176 <= covered <= 200
    assert all(math.isnan(bound) for bound in bootstrap_interval([1.0])), "one participant says nothing about others"


def test_agreement_is_rmse_and_correlation() -> None:
    assert rmse_and_r([1, 2, 3, 4], [1, 2, 3, 4]) == (0.0, pytest.approx(1))
    assert rmse_and_r([3, 4, 5, 6], [1, 2, 3, 4]) == (2.0, pytest.approx(1)), "a correlation alone would hide the difference"
    assert rmse_and_r([3, 2, 1], [1, 2, 3])[1] == pytest.approx(-1), "r² would hide that the model does the opposite"
    assert math.isnan(rmse_and_r([1, 1, 1], [1, 2, 3])[1])


def test_a_known_effect_of_groups_and_levels_is_found(tmp_path: Path) -> None:
    tests = run_tests(grouped(tmp_path, effect=2.0), "rt")
    rows = {(row["analysis"], row["effect"]): row for row in tests.anova.to_dict("records")}
    group = rows["group × n_", "group"]
    assert (group["df1"], group["df2"]) == (1, 6)
    assert group["p"] < 0.001
    n = rows["group × n_", "n_"]
    assert (n["df1"], n["df2"]) == (2, 12)
    assert n["p_corrected"] < 0.001
    assert n["partial_eta_squared"] > 0.8
    assert rows["group × n_", "group × n_"]["p"] > 0.01
    assert rows["group × mode", "mode"]["p"] > 0.01
    assert ("differences fail − count", "n_ × mode") in rows
    effects = tests.anova["effect"].tolist()
    assert sum("mode" in one and "n_" in one and "group" not in one for one in effects) == 1, effects
    wald = {row["effect"]: row for row in tests.mixed_model.to_dict("records")}
    assert (wald["n_"]["df"], wald["group × n_ × mode"]["df"]) == (2, 2)
    assert wald["n_"]["p"] < 0.001
    assert set(tests.assumptions["test"]) == {"Mauchly", "Shapiro-Wilk", "Levene"}


def test_effect_sizes_are_those_of_the_whole_design_and_each_interaction_is_there_once(tmp_path: Path) -> None:
    """F and sums of squares of a design of two factors within participants are computed here by hand."""
    path = write_experiment(tmp_path, participants=6, trials=1, factors='{"n": [1, 2, 3], "mode": ["count", "fail", "shout"]}')
    draw = random.Random(4)
    values: dict[tuple[str, int, str], float] = {}

    def measures(trial: Any) -> dict[str, Any]:
        where = trial.participant.name, trial.values["n"], trial.values["mode"]
        values[where] = 10 * int(where[0].split()[1]) + where[1] * (where[2] == "fail") + draw.gauss(0, 0.5)
        return {"rt": values[where], "luck": 0.5}

    tests = run_tests(read_results(store_rows(tmp_path / "out", str(path), measures)), "rt")
    (row,) = [row for row in tests.anova.to_dict("records") if "×" in row["effect"]]
    y = np.array([[[values[f"all {p}", n, mode] for mode in ("count", "fail", "shout")] for n in (1, 2, 3)] for p in range(1, 7)])

    def about(*axes: int) -> Any:
        return y.mean(axis=tuple({0, 1, 2} - set(axes)), keepdims=True)

    effect = 6 * np.sum((about(1, 2) - about(1) - about(2) + about()) ** 2)
    error = np.sum((y - about(0, 1) - about(0, 2) - about(1, 2) + about(0) + about(1) + about(2) - about()) ** 2)
    assert (row["effect"], row["df1"], row["df2"]) == ("n_ × mode", 4, 20)
    assert row["partial_eta_squared"] == pytest.approx(effect / (effect + error))
    assert row["F"] == pytest.approx(effect / 4 / (error / 20))


@pytest.mark.parametrize(("participants", "tested"), [(3, False), (4, True)])
def test_sphericity_is_tested_only_with_more_participants_than_levels(tmp_path: Path, participants: int, tested: bool) -> None:
    """The differences of k levels have k - 1 variances; pingouin gives p = 1, or 1.58, where the participants have fewer."""
    path = write_experiment(tmp_path, participants=participants, trials=1, factors='{"n": [1, 2, 3, 4]}')
    draw = random.Random(6)
    folder = store_rows(tmp_path / "out", str(path), lambda _: {"rt": draw.gauss(0, 1), "luck": 0.5})
    row = next(one for one in run_tests(read_results(folder), "rt").assumptions.to_dict("records") if one["test"] == "Mauchly")
    assert math.isfinite(row["p"]) == math.isfinite(row["statistic"]) == tested
    assert row["holds"].startswith("cannot be tested with so few participants") != tested
    if tested:
        assert 0 <= row["p"] <= 1


def test_two_groups_have_fewer_degrees_of_freedom_for_the_test_of_sphericity(tmp_path: Path) -> None:
    design = GROUPED.replace("[1, 2, 5]", "[1, 2, 3, 4, 5, 6, 7, 8]").replace(', "mode": ["count", "fail"]', "")
    row = next(
        one
        for one in run_tests(grouped(tmp_path, effect=1.0, design=design), "rt").assumptions.to_dict("records")
        if one["test"] == "Mauchly"
    )
    assert math.isnan(row["p"])
    assert row["holds"].startswith("cannot be tested with so few participants: use the corrected p (ε = 0.")


def test_with_few_participants_the_tests_of_the_mixed_model_say_that_their_p_is_too_small(tmp_path: Path) -> None:
    """They are asymptotic: with two groups of four, p = 0.05 of an F test with 1 and 6 degrees of freedom is 0.014 there."""
    says = "With fewer than 10 participants in a group, the p values of the mixed model's Wald tests are too small"
    assert [note for note in run_tests(grouped(tmp_path, effect=0.5), "rt").notes if says in note]
    enough = write_experiment(tmp_path, participants=10, factors='{"n": [1, 2, 5], "mode": ["count", "fail"]}')
    draw = random.Random(8)
    folder = store_rows(tmp_path / "enough", str(enough), lambda _: {"rt": draw.gauss(0, 1), "luck": 0.5})
    tests = run_tests(read_results(folder), "rt")
    assert tests.mixed_model is not None
    assert not [note for note in tests.notes if says in note]
    assert not [note for note in tests.notes if "optimization" in note], "of attempts to fit, only the last one counts"


def test_the_mixed_model_tests_an_effect_by_how_much_it_varies_between_participants(tmp_path: Path) -> None:
    """Without random effects of factors, chi square divided by its degrees of freedom would be many times F here."""
    path = write_experiment(tmp_path, participants=10, trials=1, factors='{"n": [1, 2, 3], "mode": ["count", "fail"]}')
    draw = random.Random(2)
    own = {(who, level): draw.gauss(0, 1) for who in range(1, 11) for level in (0, 1, 2, 3, "count", "fail")}

    def measures(trial: Any) -> dict[str, Any]:
        who = int(trial.participant.name.split()[1])
        rt = sum(own[who, level] for level in (0, trial.values["n"], trial.values["mode"])) + draw.gauss(0, 0.1)
        return {"rt": rt, "luck": 0.5}

    tests = run_tests(read_results(store_rows(tmp_path / "out", str(path), measures)), "rt")
    anova = {row["effect"]: row["F"] for row in tests.anova.to_dict("records")}
    wald = {row["effect"]: row["chi2"] / row["df"] for row in tests.mixed_model.to_dict("records")}
    assert wald == {effect: pytest.approx(anova[effect], rel=0.02) for effect in ("n_", "mode", "n_ × mode")}
    assert [note for note in tests.notes if "participant × n_" in note and "(sphericity)" in note]


def test_normality_is_tested_of_participants_and_not_of_their_cells(tmp_path: Path) -> None:
    """The cells of one participant are no independent values: of few participants, they would be far from normal."""
    path = write_experiment(tmp_path, participants=5, trials=1, factors=f'{{"n": {list(range(1, 17))}}}')
    person, draw = [-1.3, 0.9, 1.1, 1.0, -0.4], random.Random(1)

    def measures(trial: Any) -> dict[str, Any]:
        return {"rt": person[int(trial.participant.name.split()[1]) - 1] + draw.gauss(0, 0.1), "luck": 0.5}

    tests = run_tests(read_results(store_rows(tmp_path / "out", str(path), measures)), "rt")
    of_normality = [row for row in tests.assumptions.to_dict("records") if row["test"] == "Shapiro-Wilk"]
    assert [row["assumption"] for row in of_normality] == ["normality of participants' means", "normality of participants' trends over n_"]
    assert all(row["holds"] == "yes" for row in of_normality)


def test_intervals_are_the_same_however_many_samples_are_drawn_at_a_time(monkeypatch: pytest.MonkeyPatch) -> None:
    values = np.random.default_rng(5).normal(10, 2, 33).tolist()
    whole = bootstrap_interval(values)
    monkeypatch.setattr(statistics, "AT_ONCE", 1000)
    assert bootstrap_interval(values) == whole
    samples = np.random.default_rng([1987, 33]).integers(0, 33, (4000, 33))
    low, high = np.quantile(np.array(values)[samples].mean(axis=1), (0.025, 0.975))
    assert whole == (low, high)


def test_the_analysis_of_variance_is_that_of_the_textbook(tmp_path: Path) -> None:
    """The F of groups is the square of the t of the participants' means."""
    results = grouped(tmp_path, effect=0.4)
    row = run_tests(results, "rt").anova.iloc[0]
    means = participant_means(results.rows, "rt", [])
    young, old = (means[means["group"] == group]["value"].to_numpy() for group in ("young", "old"))
    pooled = (young.var(ddof=1) + old.var(ddof=1)) / 2
    assert row["F"] == pytest.approx((young.mean() - old.mean()) ** 2 / (pooled * 2 / 4))


@pytest.mark.slow
def test_groups_of_unequal_size_are_named_with_the_sums_of_squares_of_each_test(tmp_path: Path) -> None:
    (tmp_path / "equal").mkdir()
    equal = run_tests(grouped(tmp_path / "equal", effect=1.0), "rt")
    assert not [note for note in equal.notes if "type II" in note]
    results = grouped(tmp_path, effect=1.0, design=GROUPED.replace("Group(participants=4)}", "Group(participants=8)}"))
    (note,) = [note for note in run_tests(results, "rt").notes if "type II" in note]
    assert note.startswith("The groups are of unequal size (young 4, old 8). The analysis of variance has sums of squares of type II:")
    assert "The tests of the mixed model are of type III" in note


def test_what_a_design_does_not_allow_is_not_tested_and_says_why(tmp_path: Path) -> None:
    results = grouped(tmp_path, effect=1.0, participants=2)
    few = run_tests(results, "rt")
    assert few.anova is None
    assert few.notes == ["Not tested: a group has fewer than 3 participants with a value in every cell."]
    assert run_tests(results, "luck").notes == ["Not tested: all means are the same."]


def test_reasons_why_nothing_is_tested_are_true_of_tiny_values_single_means_and_a_lost_participant(tmp_path: Path) -> None:
    tiny = stored(tmp_path / "tiny", lambda trial: 1e-13 * (slower(trial) + own(trial)))
    assert run_tests(tiny, "rt").notes == [
        "Not tested: the means differ by less than 1e-12, which counts as rounding; measure in a smaller unit."
    ]
    one = GROUPED.replace(', "old": Group(participants=4)', "").replace("participants=4", "participants=1")
    single = stored(tmp_path / "single", slower, one)
    single = replace(single, rows=single.rows[(single.rows["n_"] == 1) & (single.rows["mode"] == "count")])
    assert run_tests(single, "rt").notes == ["Not tested: a group has fewer than 3 participants with a value in every cell."]
    lost = stored(tmp_path / "lost", lambda trial: slower(trial) + own(trial))
    lost = replace(lost, rows=lost.rows[(lost.rows["participant"] != "old 1") | (lost.rows["n_"] == 1)])
    assert run_tests(lost, "rt").notes[0] == "Not part of the analysis of variance: 1 participant without a value in some cell."


def test_the_interval_of_a_mean_is_drawn_once_for_all_parts_of_a_report(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    results = grouped(tmp_path, effect=1.0)
    means = cell_means(results.rows, "rt", ["group"])
    monkeypatch.delattr(np.random, "default_rng")
    assert cell_means(results.rows, "rt", ["group"]).equals(means)


def test_measures_that_a_design_names_and_no_trial_has_are_named(tmp_path: Path) -> None:
    results = replace(grouped(tmp_path, effect=0.0), measures=["luck"])  # as read from a folder without a value of `rt`
    assert Caution("No trial has a value of: rt.") in measure_sections(by_number(results), [])[0].parts


def stored(folder: Path, rt: Callable[[Any], float], design: str = GROUPED) -> Results:
    """Returns the results of trials whose times a function computes."""
    folder.mkdir(exist_ok=True)
    path = write_experiment(folder)
    path.write_text(design, encoding="utf-8")
    return read_results(store_rows(folder / "out", str(path), lambda trial: {"rt": rt(trial), "luck": 0.5}))


def slower(trial: Any) -> float:
    return 0.1 * trial.values["n"] + 0.07 * (trial.values["mode"] == "fail")


def own(trial: Any) -> float:
    """Returns what is a participant's own, between 0 and 0.1."""
    return 0.1 * math.sin(1 + 7 * int(trial.participant.name.split()[1])) ** 2


@pytest.mark.parametrize("groups", [1, 2])
@pytest.mark.parametrize("noise", [0.0, 1e-9])
def test_participants_without_any_difference_are_not_tested(tmp_path: Path, groups: int, noise: float) -> None:
    """F would be an effect divided by rounding: infinite, or negative, or any number."""
    design = GROUPED if groups == 2 else GROUPED.replace(', "old": Group(participants=4)', "")
    draw, old = random.Random(4), 0.23
    results = stored(tmp_path, lambda trial: slower(trial) + old * (trial.participant.group == "old") + noise * draw.gauss(0, 1), design)
    tests = run_tests(results, "rt")
    assert (tests.anova, tests.mixed_model, len(tests.assumptions)) == (None, None, 0)
    assert all(note.startswith("Not tested: ") for note in tests.notes), tests.notes
    effects = (
        ["n_", "mode", "n_ × mode"] if groups == 1 else ["group", "n_, group × n_", "mode, group × mode", "n_ × mode, group × n_ × mode"]
    )
    assert [note.partition(", because")[0].removeprefix("Not tested: ") for note in tests.notes] == [*effects, "the mixed model"]


def test_an_effect_in_which_participants_do_not_differ_is_not_tested_and_others_are(tmp_path: Path) -> None:
    """Each participant has a time of its own, to which each condition adds the same."""
    tests = run_tests(stored(tmp_path, lambda trial: slower(trial) + own(trial)), "rt")
    assert set(tests.anova["effect"]) == {"group"}
    assert all(0 <= eta <= 1 for eta in tests.anova["partial_eta_squared"])
    assert tests.mixed_model is None
    assert "sphericity of n_" not in set(tests.assumptions["assumption"])
    assert (
        "Not tested: n_, group × n_, because the participants of a group do not differ in the effect of n_ beyond rounding." in tests.notes
    )
    varied = stored(tmp_path / "other", lambda trial: (0.5 - own(trial)) * trial.values["n"], GROUPED)
    tests = run_tests(varied, "rt")
    assert {"group", "n_", "group × n_"} == set(tests.anova["effect"])
    assert not [note for note in tests.notes if note.startswith("Not tested: n_,")]


@pytest.mark.parametrize("trials", [1, 2, 60])
def test_walking_speeds_of_a_group_that_are_all_the_same_are_not_tested(tmp_path: Path, trials: int) -> None:
    speeds = {("small", "normal"): 1.291, ("small", "fast"): 1.61, ("large", "normal"): 1.281, ("large", "fast"): 1.771}
    results = read_results(
        store_rows(
            tmp_path / "walks",
            "warren_whang_1987",
            lambda trial: {"speed_m_s": speeds[trial.participant.group, trial.values["condition"]]},
            trials=1,
        )
    )
    results = replace(results, rows=pandas().concat([results.rows] * trials, ignore_index=True))
    tests = run_tests(results, "speed_m_s")
    assert (tests.anova, tests.mixed_model) == (None, None)
    assert "Not tested: group, because the participants of a group do not differ in their means beyond rounding." in tests.notes


def test_critical_ratios_are_found() -> None:
    found = critical_ratio((ratio / 20, ratio / 20 < 1.3) for ratio in range(14, 36) for _ in range(5))
    assert found is not None
    assert found.value == pytest.approx(1.275, abs=0.003), "midway between the last that turned and the first that did not"
    assert found.low == pytest.approx(1.25, abs=0.01)
    assert found.high == pytest.approx(1.30, abs=0.01), "the interval is that between the two"
    few = critical_ratio((ratio, ratio < 1.3) for ratio in (1.0, 1.1, 1.2, 1.4, 1.5))
    assert few is not None
    assert few.high - few.low > 0.2, "one trial each says less"


def test_a_bend_is_where_the_fall_to_a_baseline_ends() -> None:
    ratios = [0.9 + 0.05 * n for n in range(15)]
    assert bend(ratios, [18 + 150 * max(0.0, 1.2 - ratio) for ratio in ratios]) == pytest.approx(1.2, abs=0.005)
    assert bend([1.0, 1.1, 1.2], [3.0, 2.0, 1.0]) is None


def test_the_baseline_is_an_ellipse_that_leaves_room() -> None:
    angles = baseline_angle([0.5, 0.863, 1.0, 1.3, 1.5])
    assert angles.tolist()[:2] == [90, pytest.approx(90, abs=0.1)]
    assert angles.tolist()[3:] == [0, 0]
    width = math.hypot(math.cos(math.radians(angles[2])), 0.563 * math.sin(math.radians(angles[2])))
    assert width == pytest.approx(0.7)
    assert baseline_angle([2.0], 2.0)[0] == pytest.approx(math.degrees(math.acos(1.7 / 2)))
