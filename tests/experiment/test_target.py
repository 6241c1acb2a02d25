"""The means that models are compared with: targets from human data, means of trials, and how well they agree."""

from __future__ import annotations

import math
from pathlib import Path

import pytest

from actr3d.errors import ExperimentError
from actr3d.experiment.design import Measured
from actr3d.experiment.specification import specify
from actr3d.experiment.target import agreement, cells_of_rows, chance_error, load_target, rmse
from tests.helpers.experiments import COUNTER, write_experiment


def test_equal_means_have_no_correlation_and_opposite_ones_a_negative_one() -> None:
    target = {(("x", number),): 0.1 for number in range(3)}
    means = {cell: float(number) for number, cell in enumerate(target)}
    assert agreement(means, target).r2 is None
    assert agreement(means, {cell: 0.1 + 0.2 * (number % 2) for number, cell in enumerate(target)}).r2 == pytest.approx(0)
    assert agreement(dict(zip(target, (0.3, 0.1 + 0.2, 0.3), strict=True)), means).r2 is None, "they differ by rounding"
    falling = agreement({cell: -mean for cell, mean in means.items()}, means)
    assert (falling.r, falling.r2) == (pytest.approx(-1), pytest.approx(1)), "a model that does the opposite"


def test_differences_too_large_for_a_float_are_infinite() -> None:
    assert rmse({(): 1e308, (("x", 1),): 1e308}, {(): -1e308, (("x", 1),): -1e308}) == math.inf
    assert rmse({(): 3e200}, {(): 0.0}) == 3e200


def test_means_of_lists_are_compared_by_number() -> None:
    measure = Measured(name="share", over="block")
    rows = [{"participant": who, "share_1": 0.0, "share_2": high, "share_3": None} for who, high in (("a", 0.5), ("b", 1.0))]
    assert cells_of_rows(rows, measure, ["block"]) == {
        (("block", 1),): {"a": [0.0], "b": [0.0]},
        (("block", 2),): {"a": [0.5], "b": [1.0]},
    }
    with pytest.raises(ExperimentError, match="no trial has a value of 'word'"):
        cells_of_rows(rows, measure, ["word"])
    assert cells_of_rows([{"participant": "a", "y": None}], Measured(name="y"), []) == {}


def test_the_chance_of_a_mean_is_in_differences_that_participants_do_not_have_at_another_candidate_too() -> None:
    apart = {"a": [1.0], "b": [5.0], "c": [9.0]}
    assert chance_error(apart, {"a": [3.0], "b": [7.0], "c": [11.0]}) == 0
    assert chance_error(apart, {"a": [0.0], "b": [5.0], "c": [10.0]}) == pytest.approx(1 / math.sqrt(2 * 3))
    assert chance_error({"a": [7.0, 9.0, 4.0]}, {"a": [5.0, 7.0, 2.0]}) == 0, "of one participant, trials differ"
    assert chance_error({"a": [7.0, 9.0]}, {"a": [7.0, 7.0]}) == pytest.approx(math.sqrt(2) / math.sqrt(4))
    assert chance_error({"a": [7.0]}, {"a": [3.0]}) == 0
    assert chance_error({"a": [7.0, 9.0], "b": [1.0]}, {}) == 0


def test_targets_are_means_of_human_data(tmp_path: Path) -> None:
    design = specify("fan_effect")
    means_of_people = load_target("fan_effect", design, "reaction_time")
    assert len(means_of_people) == 18
    assert means_of_people[0].conditions == {"group": "all", "probe": "target", "location_fan": 1, "person_fan": 1}
    path = tmp_path / "mine.csv"
    path.write_text("participant,probe,reaction_time\np,target,1\np,target,2\nq,target,3\n")
    (one,) = load_target(str(path), design)
    assert (one.conditions, one.measure, one.mean) == ({"group": "all", "probe": "target"}, "reaction_time", 2.25)
    own = specify(
        str(
            write_experiment(
                tmp_path, factors='{"n": [1, 2], "loud": [True, False]}', model=COUNTER.replace("n = 3", "n = 3\nloud = False")
            )
        )
    )
    path.write_text("participant,n_,loud,rt\np,1,True,1\np,2,False,2\n")
    assert [one.conditions for one in load_target(str(path), own)] == [
        {"group": "all", "n": 1, "loud": True},
        {"group": "all", "n": 2, "loud": False},
    ]
    by_block = load_target("paired_associates", specify("paired_associates"), "latency")
    assert [one.conditions["block"] for one in by_block] == list(range(2, 9))
    with pytest.raises(ExperimentError, match=r"human data 'fan_efect': no such file; did you mean 'fan_effect'"):
        load_target("fan_efect", design)
    with pytest.raises(ExperimentError, match="have no means of 'speed'; they have: reaction_time"):
        load_target("fan_effect", design, "speed")


def test_columns_that_only_a_report_reads_are_no_measures_of_a_target(tmp_path: Path) -> None:
    (path := tmp_path / "people.csv").write_text("participant,group,condition,aperture,ratio,wall_angle_deg\np,small,normal,0.4,1.0,50\n")
    design = specify("warren_whang_1987")
    assert [(one.measure, one.mean) for one in load_target(str(path), design)] == [("wall_angle_deg", 50.0)]
    path.write_text("participant,group,condition,aperture,ratio\np,small,normal,0.4,1.0\n")
    with pytest.raises(ExperimentError, match=r"people\.csv:1: no column is a measure; there may be: .*wall_angle_deg"):
        load_target(str(path), design)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("participant,n_,time\np,1,3\n", r":1: unknown column 'time'; there may be: participant, group, n_, rt\n"),
        ("participant,n_,time,luck\np,1,3,4\n", r":1: unknown column 'time'; there may be: participant, group, n_, luck, rt$"),
        ("participant,n_\np,1\n", r":1: no column is a measure; there may be: rt$"),
    ],
)
def test_an_error_in_a_file_without_the_measure_of_the_fit_names_this_measure(tmp_path: Path, text: str, says: str) -> None:
    design = specify(str(write_experiment(tmp_path)))
    (people := tmp_path / "people.csv").write_text(text)
    with pytest.raises(ExperimentError, match=says):
        load_target(str(people), design, "rt")
