"""Means of the trials of an experiment, and of two, which are compared only over the conditions that both have."""

from __future__ import annotations

import json
import math
import sqlite3
from collections.abc import Callable, Mapping, Sequence
from contextlib import closing
from itertools import product
from pathlib import Path
from random import Random
from statistics import fmean, stdev
from typing import Any

import pytest

from actr3d.experiment.design import Trial
from actr3d.experiment.report.reference_means import fit_to, matched, means_of_experiment
from actr3d.experiment.report.results import by_number, read_results
from tests.helpers.experiments import COUNTER, write_experiment
from tests.helpers.reports import store_rows
from workbench.experiment_means import means
from workbench.experiment_table import TableError

Row = dict[str, Any]


def written(path: Path, rows: Sequence[Row], unit: str | None = None) -> Path:
    """Writes a table of trials: all keys of the rows are columns, with a unit."""
    names = list(dict.fromkeys(name for row in rows for name in row))
    with closing(sqlite3.connect(path)) as file, file:
        file.execute("CREATE TABLE trial (number INTEGER PRIMARY KEY, data TEXT, wall_s REAL, worker TEXT)")
        file.execute("CREATE TABLE column (name TEXT, type TEXT, unit TEXT, meaning TEXT, place INTEGER)")
        file.executemany("INSERT INTO column VALUES (?, 'real', ?, '', ?)", [(name, unit, n) for n, name in enumerate(names)])
        file.executemany("INSERT INTO trial VALUES (?, ?, 1, 'w')", [(n, json.dumps(row)) for n, row in enumerate(rows)])
    return path


def trials(n: Sequence[Any], m: Sequence[Any], people: Sequence[str] = ("all 1", "all 2"), **more: Any) -> list[Row]:
    """Returns a trial of each participant in each condition, which takes n * m."""
    return [{**more, "participant": who, "group": "all", "n": one, "m": two, "time": one * two} for who, one, two in product(people, n, m)]


def compared(folder: Path, mine: Sequence[Row], theirs: Sequence[Row], **options: Any) -> dict[str, Any]:
    tables = (written(folder / f"{name}.sqlite", rows) for name, rows in (("mine", mine), ("theirs", theirs)))
    chosen: dict[str, Any] = {"x": "n", "by": [], "measure": "time", "factors": ["n", "m"], **options}
    return means(*tables, **chosen)


def points(of: Mapping[str, Any]) -> list[list[Any]]:
    return sorted([*point["at"], point["mean"], point["trials"]] for point in of["points"])


ALL = {"conditions": 0, "trials": 0}


def test_conditions_that_are_the_same_are_all_compared(tmp_path: Path) -> None:
    found = compared(tmp_path, trials([1, 2], [1, 3]), trials([2.0, 1.0], [3, 1]))
    assert points(found) == points(found["beside"]) == [[1, 2, 4], [2, 4, 4]]
    assert (found["left_out"], found["beside"]["left_out"], found["apart"]) == (ALL, ALL, [])


def test_a_condition_whose_trials_have_all_failed_in_one_experiment_is_in_no_mean(tmp_path: Path) -> None:
    failed = [row | {"time": None, "error": "no"} if row["m"] == 3 else row for row in trials([1, 2], [1, 3])]
    found = compared(tmp_path, trials([1, 2], [1, 3]), failed)
    assert points(found) == points(found["beside"]) == [[1, 1, 2], [2, 2, 2]]
    assert (found["left_out"], found["beside"]["left_out"], found["apart"]) == (ALL, ALL, [])
    assert found["failed"] == {"conditions": 2, "trials": [4, 0]}


def test_conditions_in_which_a_trial_failed_are_compared_in_neither_experiment(tmp_path: Path) -> None:
    """What is left may be the easier trials. A trial without a value of the measure has not failed."""
    rows = trials([1, 2], [1, 3])
    failed = [row | {"time": None, "error": "no"} if (row["m"], row["participant"]) == (3, "all 1") else row for row in rows]
    empty = [row | {"time": None} if (row["m"], row["participant"]) == (3, "all 1") else row for row in rows]
    for name, (mine, theirs, left) in {"here": (failed, rows, [2, 4]), "there": (rows, failed, [4, 2])}.items():
        (tmp_path / name).mkdir()
        found = compared(tmp_path / name, mine, theirs)
        assert points(found) == points(found["beside"]) == [[1, 1, 2], [2, 2, 2]]
        assert (found["left_out"], found["beside"]["left_out"]) == (ALL, ALL)
        assert found["failed"] == {"conditions": 2, "trials": left}
    (tmp_path / "empty").mkdir()
    found = compared(tmp_path / "empty", empty, rows)
    assert (points(found), points(found["beside"])) == ([[1, 2, 3], [2, 4, 3]], [[1, 2, 4], [2, 4, 4]])
    assert found["failed"] == {"conditions": 0, "trials": [0, 0]}


def test_a_condition_with_a_failed_trial_is_left_out_with_all_its_blocks(tmp_path: Path) -> None:
    rows = [{"participant": "all 1", "group": "all", "n": n, "time_1": 1.0, "time_2": 2.0} for n in (1, 2)]
    failed = {"participant": "all 1", "group": "all", "n": 2, "error": "no"}
    found = compared(tmp_path, rows, [*rows, failed], x="block", factors=["n"], over="block")
    assert points(found) == points(found["beside"]) == [[1, 1, 1], [2, 2, 1]]
    assert found["failed"] == {"conditions": 1, "trials": [2, 2]}


def test_conditions_that_have_not_run_yet_are_in_no_mean(tmp_path: Path) -> None:
    found = compared(tmp_path, trials([1, 2], [1, 3])[:3], trials([1, 2], [1, 3]))
    assert points(found) == [[1, 2, 2], [2, 2, 1]]
    assert points(found["beside"]) == [[1, 2, 4], [2, 2, 2]]
    assert found["beside"]["left_out"] == {"conditions": 1, "trials": 2}


def test_a_factor_of_one_experiment_is_compared_with_the_value_that_the_other_one_has(tmp_path: Path) -> None:
    found = compared(tmp_path, trials([1, 2], [1, 3]), trials([1, 5], [3]))
    assert points(found) == points(found["beside"]) == [[1, 3, 2]]
    assert (found["left_out"], found["beside"]["left_out"]) == ({"conditions": 3, "trials": 6}, {"conditions": 1, "trials": 2})


def test_experiments_without_a_common_condition_have_no_points_and_name_the_factors(tmp_path: Path) -> None:
    found = compared(tmp_path, trials([1, 2], [1, 3]), trials([1, 2], [4]))
    assert (found["points"], found["beside"]["points"], found["apart"]) == ([], [], ["m"])
    (tmp_path / "other").mkdir()
    other = compared(tmp_path / "other", trials([1], [1], ink="blue"), trials([1], [1]), factors=["n", "m", "ink"])
    assert (other["points"], other["apart"]) == ([], ["ink"])


def test_true_is_another_level_than_one_and_none_another_than_no_level(tmp_path: Path) -> None:
    pairs: tuple[tuple[Row, Row], ...] = ({"ink": True}, {"ink": 1}), ({"ink": None}, {}), ({"ink": "1"}, {"ink": 1})
    for name, (mine, theirs) in zip("abc", pairs, strict=True):
        (tmp_path / name).mkdir()
        found = compared(tmp_path / name, trials([1], [1], **mine), trials([1], [1], **theirs), factors=["n", "m", "ink"])
        assert (found["points"], found["apart"]) == ([], ["ink"])


def test_points_that_only_one_experiment_has_are_means_over_conditions_that_both_have(tmp_path: Path) -> None:
    found = compared(tmp_path, trials([1], [1, 3], ["all 1", "all 2"]), trials([1], [1], ["all 1", "all 3"]), x="participant")
    assert points(found) == [["all 1", 1, 1], ["all 2", 1, 1]]
    assert points(found["beside"]) == [["all 1", 1, 1], ["all 3", 1, 1]]
    assert found["left_out"] == {"conditions": 1, "trials": 2}


def test_points_of_the_same_participant_are_means_over_the_same_conditions(tmp_path: Path) -> None:
    both = trials([1], [1, 3])
    found = compared(tmp_path, both, both[:3], x="participant")
    assert points(found) == points(found["beside"]) == [["all 1", 2, 2], ["all 2", 1, 1]]
    assert found["left_out"] == {"conditions": 0, "trials": 1}


def test_blocks_that_only_one_experiment_has_are_in_no_mean(tmp_path: Path) -> None:
    mine = [{"participant": "all 1", "group": "all", "n": 1, "time_1": 1.0, "time_2": 2.0, "time_3": 9.0}]
    theirs = [{"participant": "all 1", "group": "all", "n": 1, "time_1": 1.0, "time_2": 2.0}]
    for x in ("n", "block"):
        folder = tmp_path / x
        folder.mkdir()
        found = compared(folder, mine, theirs, x=x, factors=["n"], over="block")
        assert points(found) == points(found["beside"]) == ([[1, 1.5, 2]] if x == "n" else [[1, 1, 1], [2, 2, 1]])
        assert found["left_out"] == {"conditions": 1, "trials": 1}


def test_each_condition_weighs_the_same_however_many_of_its_trials_have_a_value(tmp_path: Path) -> None:
    mine = trials([1, 2], [1, 3])
    some = [row for row in mine if row["m"] == 1 or row["participant"] == "all 1"] + [row for row in mine if row["m"] == 1] * 3
    found = compared(tmp_path, mine, some)
    assert points(found) == [[1, 2, 4], [2, 4, 4]]
    assert points(found["beside"]) == [[1, 2, 9], [2, 4, 9]]
    people = trials([1], [1])
    groups = [row | {"group": group, "time": times * row["time"]} for row in people for group, times in (("small", 1), ("big", 5))]
    (tmp_path / "groups").mkdir()
    uneven = compared(tmp_path / "groups", groups, groups + [row for row in groups if row["group"] == "big"] * 4)
    assert [point[:2] for point in points(uneven)] == [point[:2] for point in points(uneven["beside"])] == [[1, 3]]


def test_a_factor_that_only_one_experiment_varies_has_the_value_of_the_parameter_in_the_other(tmp_path: Path) -> None:
    plain = [{name: value for name, value in row.items() if name != "m"} for row in trials([1, 2], [3])]
    found = compared(tmp_path, trials([1, 2], [1, 3]), plain, defaults=({}, {"m": 3.0}))
    assert points(found) == points(found["beside"]) == [[1, 3, 2], [2, 6, 2]]
    for name, (level, default) in {"text": ("it's", "it's"), "switch": (True, True)}.items():
        (tmp_path / name).mkdir()
        varied = [row | {"ink": ink} for row in trials([1], [1]) for ink in (level, "red")]
        found = compared(tmp_path / name, varied, trials([1], [1]), factors=["n", "m", "ink"], defaults=({}, {"ink": default}))
        assert points(found) == points(found["beside"]) == [[1, 1, 2]]


def test_none_and_a_list_are_values_of_a_parameter_too(tmp_path: Path) -> None:
    for name, levels in {"none": [None, "red"], "list": [[0, 1], [0, 5]]}.items():
        (tmp_path / name).mkdir()
        varied = [row | {"cue": cue} for row in trials([1], [1]) for cue in levels]
        found = compared(tmp_path / name, varied, trials([1], [1]), factors=["n", "m", "cue"], defaults=({}, {"cue": levels[0]}))
        assert points(found) == points(found["beside"]) == [[1, 1, 2]]
        assert (found["left_out"], found["apart"]) == ({"conditions": 1, "trials": 2}, [])


def test_a_group_without_a_value_of_a_parameter_has_its_default(tmp_path: Path) -> None:
    varied = [{**row, "group": group} for group in ("a", "b") for row in trials([1], [1, 3], [f"{group} 1"])]
    plain = [{**row, "group": "a"} for row in trials([1], [3], ["a 1"])]
    plain += [{"group": "b", "participant": "b 1", "ink": "red", "n": 1, "time": 5}]
    more: dict[str, Any] = {"factors": ["n", "m", "ink"], "defaults": ({"ink": "red"}, {"ink": "red", "m": 1})}
    found = compared(tmp_path, varied, plain, by=["group"], **more)
    assert points(found) == [[1, "a", 3, 1], [1, "b", 1, 1]]
    assert points(found["beside"]) == [[1, "a", 3, 1], [1, "b", 5, 1]]


def test_the_report_compares_the_same_means(tmp_path: Path) -> None:
    """Of two experiments with unequal groups, one of which varies m, with failed trials: over the same conditions."""
    random = Random(4)

    def experiment(name: str, factors: str, people: Sequence[int], fails: Callable[[Mapping[str, Any], str], bool]) -> Path:
        (tmp_path / name).mkdir()
        path = write_experiment(tmp_path / name, factors=factors, trials=3, model=COUNTER.replace("n = 3", "n = 3\nm = 1"))
        groups = ", ".join(f'"{group}": Group(participants={number})' for group, number in zip(("small", "big"), people, strict=True))
        path.write_text(path.read_text("utf-8").replace('"all": Group(participants=2)', groups), "utf-8")

        def measured(trial: Trial) -> dict[str, Any]:
            failed = trial.repetition == 1 and fails(trial.values, trial.participant.group)
            return {"error": "no"} if failed else {"rt": random.random(), "luck": 0.5 if trial.number % 5 else None}

        return store_rows(tmp_path / name / "rows", str(path), measured)

    folders = (
        experiment("one", '{"n": [1, 2], "m": [1, 3]}', (2, 3), lambda values, _: (values["n"], values["m"]) == (2, 3)),
        experiment("two", '{"n": [1, 2, 5]}', (4, 1), lambda values, group: (values["n"], group) == (1, "small")),
    )
    defaults: Sequence[Mapping[str, Any]] = ({}, {"m": 1})
    for (mine, theirs), order in ((folders, 1), (folders[::-1], -1)):
        tables = [folder / "trials.sqlite" for folder in (mine, theirs)]
        parts = by_number(read_results(mine))
        beside = means_of_experiment(by_number(read_results(theirs)), parts)
        assert beside is not None
        for measure in ("rt", "luck"):
            found = means(*tables, x="n", by=["group"], measure=measure, factors=["n", "m"], defaults=defaults[::order])
            cells = matched(parts[0], beside, measure)
            for points, column in ((found["points"], "model"), (found["beside"]["points"], "beside")):
                report = {(n, group): mean for n, group, mean in zip(cells["n_"], cells["group"], cells[column], strict=True)}
                assert {tuple(point["at"]): pytest.approx(point["mean"]) for point in points} == report
                assert report.keys() == {(1, "big"), (2, "small"), (2, "big")}
            assert found["failed"]["conditions"] == 3
            assert found["beside"]["left_out"]["conditions"] == 2
        assert list(fit_to(parts, beside)["cells"]) == [3, 3]
        assert list(fit_to(parts, beside)["left_out"]) == ([3, 3] if order > 0 else [5, 5])


def alone(folder: Path, rows: Sequence[Row], **options: Any) -> list[dict[str, Any]]:
    chosen: dict[str, Any] = {"x": "n", "by": [], "measure": "time", "factors": ["n", "m"], **options}
    return means(written(folder / "table.sqlite", rows), **chosen)["points"]


def test_a_comparison_of_the_same_conditions_moves_no_point(tmp_path: Path) -> None:
    """Each condition weighs the same also in the figure of one experiment, drawn or not, however many trials and participants it has."""
    rows = trials([1, 2], [1, 3]) + trials([1], [3]) * 3 + trials([2], [1], ["all 3", "all 4"])
    rows += [{**row, "group": "big", "time": 5 * row["time"]} for row in trials([1, 2], [1, 3], ["big 1", "big 2", "big 3"])]
    for x, by in (("n", []), ("group", []), ("n", ["group"]), ("m", ["n"])):
        folder = tmp_path / f"{x} {by}"
        folder.mkdir()
        both = compared(folder, rows, rows, x=x, by=by)
        assert alone(folder, rows, x=x, by=by) == both["points"] == both["beside"]["points"]
    assert [point["mean"] for point in alone(tmp_path, rows)] == [(1 + 3 + 5 + 15) / 4, (2 + 6 + 10 + 30) / 4]


def drawn(random: Random, groups: Mapping[str, tuple[int, float]], conditions: Sequence[float], number: int) -> list[Row]:
    """Returns trials of the same experiment with other participants: `conditions` are the shares of participants who have each.

    Args:
        random: Draws what a participant takes, and what more a condition takes.
        groups: The number of participants and their standard deviation by group.
        conditions: The shares.
        number: The number of the experiment.
    """
    rows: list[Row] = []
    for group, (people, sd) in groups.items():
        for person in range(people):
            own = random.gauss(0, sd)
            rows += [
                {"participant": f"{group} {person}", "group": group, "draw": number, "n": n, "time": own + random.gauss(0, sd)}
                for n, share in enumerate(conditions)
                if person < share * people
            ]
    return rows


@pytest.mark.daily(1)
@pytest.mark.parametrize(
    ("groups", "conditions"),
    [
        ({"small": (2, 1.0), "big": (12, 1.0)}, [1]),
        ({"small": (20, 1.0), "big": (2, 3.0)}, [1]),
        ({"all": (8, 1.0)}, [1, 0.5]),
        ({"all": (8, 1.0)}, [1, 1]),
        ({"small": (3, 1.0), "big": (6, 2.0)}, [1, 1]),
    ],
)
def test_the_standard_error_is_how_much_means_of_other_participants_differ(
    tmp_path: Path, groups: Mapping[str, tuple[int, float]], conditions: Sequence[float]
) -> None:
    random, draws = Random(1), 2_000
    rows = [row for number in range(draws) for row in drawn(random, groups, conditions, number)]
    found = alone(tmp_path, rows, x="draw", factors=["n"])
    assert len(found) == draws
    errors = math.sqrt(fmean(point["error"] ** 2 for point in found))
    assert errors == pytest.approx(stdev(point["mean"] for point in found), rel=0.06)


def test_the_standard_error_is_that_of_participants_or_that_of_a_mean_of_groups(tmp_path: Path) -> None:
    random = Random(2)
    whole = drawn(random, {"all": (7, 1.0)}, [1, 1, 1], 0)
    (point,) = alone(tmp_path, whole, x="draw", factors=["n"])
    people = [fmean(row["time"] for row in whole if row["participant"] == f"all {n}") for n in range(7)]
    assert (point["mean"], point["error"]) == (pytest.approx(fmean(people)), pytest.approx(stdev(people) / math.sqrt(7)))
    (tmp_path / "groups").mkdir()
    uneven = drawn(random, {"small": (2, 1.0), "big": (12, 4.0)}, [1], 0)
    (point,) = alone(tmp_path / "groups", uneven, x="draw", factors=["n"])
    of_groups = [[row["time"] for row in uneven if row["group"] == name] for name in ("small", "big")]
    errors = [stdev(times) / math.sqrt(len(times)) for times in of_groups]
    assert point["mean"] == pytest.approx(fmean(map(fmean, of_groups)))
    assert point["error"] == pytest.approx(math.hypot(*errors) / 2)


def test_there_is_no_standard_error_if_a_condition_has_one_participant(tmp_path: Path) -> None:
    (point,) = alone(tmp_path, drawn(Random(3), {"small": (1, 1.0), "big": (4, 1.0)}, [1], 0), x="draw", factors=["n"])
    assert (point["error"], point["participants"]) == (None, 5)


def test_a_measure_with_another_unit_is_not_compared(tmp_path: Path) -> None:
    mine, theirs = (written(tmp_path / unit, trials([1], [1]), unit) for unit in ("s", "ms"))
    with pytest.raises(TableError, match=r"'time' must have the same unit in both experiments \(got s and ms\)"):
        means(mine, theirs, x="n", by=[], measure="time", factors=["n", "m"])


def test_in_the_order_of_trials_participants_are_averaged_whatever_conditions_they_have(tmp_path: Path) -> None:
    rng, rows = Random(3), list[Row]()
    for who in range(6):
        conditions = list(product([1, 2], [1, 3]))
        rng.shuffle(conditions)
        rows += [
            {"participant": f"all {who}", "group": "all", "position": place, "n": n, "m": m, "time": n * m + who / 10}
            for place, (n, m) in enumerate(conditions, start=1)
        ]
    for found in (
        means(written(tmp_path / "alone.sqlite", rows), x="position", by=[], measure="time", factors=["n", "m"]),
        compared(tmp_path, rows, rows, x="position"),
    ):
        assert found["by_order"]
        assert [point["at"] for point in found["points"]] == [[1], [2], [3], [4]]
        for point in found["points"]:
            values = [row["time"] for row in rows if row["position"] == point["at"][0]]
            assert point["mean"] == pytest.approx(fmean(values))
            assert point["error"] == pytest.approx(stdev(values) / math.sqrt(6))
            assert (point["participants"], point["trials"]) == (6, 6)
