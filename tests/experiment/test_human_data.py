"""Human data from files: both forms, and what is wrong with a row."""

from __future__ import annotations

from pathlib import Path

import pytest

from actr3d.errors import ExperimentError
from actr3d.experiment.human_data import library_data, load_means
from actr3d.experiment.specification import library_designs, specify


def write(tmp_path: Path, text: str) -> Path:
    path = tmp_path / "data.csv"
    path.write_text(text, encoding="utf-8")
    return path


def test_the_library_has_data_for_the_designs_that_name_them() -> None:
    for name in library_designs():
        experiment = specify(name)
        human = experiment.design.human
        if human in library_data():
            means = load_means(human, experiment.design.factors)
            assert means
            assert all(one.source for one in means), "each mean has its source"
            for one in means:
                for factor, level in one.conditions.items():
                    assert factor == "group" or level in experiment.design.factors[factor]


def test_published_means_have_conditions_numbers_and_sources(tmp_path: Path) -> None:
    path = write(tmp_path, 'group,a,flag,measure,mean,sd,n,source\nsmall,0.4,True,angle,57.7,3,5,"A, B"\n,2,x,angle,1,,,\n')
    first, second = load_means(path, ["a", "flag"])
    assert first.conditions == {"group": "small", "a": 0.4, "flag": True}
    assert (first.measure, first.mean, first.sd, first.n, first.source) == ("angle", 57.7, 3, 5, "A, B")
    assert second.conditions == {"a": 2, "flag": "x"}
    assert (second.sd, second.n) == (None, None)


def test_trials_become_means_of_participants(tmp_path: Path) -> None:
    path = write(tmp_path, "\ufeffparticipant,a,y,z\np,1,2,\np,1,4,\nq,1,7,1\nq,2,0,\n")
    means = {(one.measure, one.conditions["a"]): (one.mean, one.sd, one.n) for one in load_means(path, ["a"])}
    assert means["y", 1] == (5.0, pytest.approx(8**0.5), 2)
    assert means["y", 2] == (0.0, None, 1)
    assert means["z", 1] == (1.0, None, 1)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("", r"data\.csv: must have a header and at least one row"),
        ("a,mean\n", r"data\.csv: must have a header and at least one row \(found 2 columns and no rows\)"),
        ("a,a\n1,1\n", r"data\.csv:1: has two columns 'a'"),
        ("a,b\n1,1\n", r"data\.csv:1: must have the column 'mean' \(published means\) or 'participant' \(trials\); found: a, b"),
        ("aa,measure,mean\n1,y,1\n", r"data\.csv:1: column 'aa' is not a condition of the design"),
        ("a,mean\n1,1\n", r"data\.csv:1: the column 'measure' is missing"),
        ("a,measure,mean\n1,y,x\n", r"data\.csv:2: column 'mean': must be a number \(got 'x'\)"),
        ("a,measure,mean\n1,y,\n", r"data\.csv:2: column 'mean': must be a number \(got ''\)"),
        ("a,measure,mean\n1,,1\n", r"data\.csv:2: column 'measure': must be the name of a measure"),
        ("a,measure,mean,sd\n\n1,y,1,-1\n", r"data\.csv:3: column 'sd': must be a number >= 0 \(got '-1'\)"),
        ("a,measure,mean,n\n1,y,1,1.5\n", r"data\.csv:2: column 'n': must be a whole number >= 1 \(got '1\.5'\)"),
        ("a,measure,mean\n1,y\n", r"data\.csv:2: must have 3 values, one for each column \(has 2\)"),
        ("participant,a\np,1\n", r"data\.csv:1: has no measure"),
        ("participant,a,y\n,1,1\n", r"data\.csv:2: column 'participant': must be the name of a participant"),
        ("participant,a,y\np,1,inf\n", r"data\.csv:2: column 'y': must be a number \(got 'inf'\)"),
    ],
)
def test_rows_that_are_not_valid_are_named(tmp_path: Path, text: str, says: str) -> None:
    with pytest.raises(ExperimentError, match=says):
        load_means(write(tmp_path, text), ["a"])


def test_many_errors_are_counted(tmp_path: Path) -> None:
    with pytest.raises(ExperimentError, match=r"(?s)data\.csv:2:.*data\.csv:11:.*and 20 more"):
        load_means(write(tmp_path, "a,measure,mean\n" + "1,y,x\n" * 30), ["a"])


def test_data_that_do_not_exist_are_refused(tmp_path: Path) -> None:
    with pytest.raises(ExperimentError, match=r"human data 'fan_efect': cannot be read .*did you mean 'fan_effect'"):
        load_means("fan_efect", [])
    (tmp_path / "x.csv").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(ExperimentError, match=r"cannot be read \(it is not UTF-8 text\)"):
        load_means(tmp_path / "x.csv", [])
