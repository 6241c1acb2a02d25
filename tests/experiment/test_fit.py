"""Fits: parameters that are known are found again, with intervals; what is held out stays apart."""

from __future__ import annotations

import json
import math
import os
import re
from collections.abc import Generator
from contextlib import nullcontext
from pathlib import Path
from typing import Any

import pytest
from scipy.special import stdtrit

from actr3d.cli import main
from actr3d.errors import Actr3dError, DesignError, ExperimentError, SettingError
from actr3d.experiment import cluster
from actr3d.experiment.cluster import local_cluster
from actr3d.experiment.command import check_folder_of_fit
from actr3d.experiment.design import Measured
from actr3d.experiment.fit import STARTING, Fit, HeldOut, Range
from actr3d.experiment.report.results import read_results
from actr3d.experiment.specification import specify
from actr3d.experiment.store import Store, only_process
from actr3d.experiment.target import Agreement, TargetMean, agreement, cells_of_rows, cells_of_target, load_target, mean_of
from actr3d.runner.model_factory import Blueprint
from tests.helpers.experiments import COUNTER, write_experiment
from tests.helpers.reports import store_rows

LINE = """
x = 1
slope = 2.0
offset = 0.5
noise = 0.1

from actr3d.actr import *
from actr3d.experiment import Design, Group, design


class Draw(ACTR):
    goal = Buffer()

    def init():
        goal.set("draw")

    def draw(goal="draw"):
        self.value = slope * x + offset + noise * self.random.gauss(0, 1)
        goal.set("done")


model = Draw()
model.run()
y = model.value


@design
def line():
    '''A line through noise.'''
    return Design(factors={"x": [1, 2, 3, 4, 5]}, groups={"all": Group(participants=4)}, measures=["y"])


@design
def steeper():
    '''The same line, further on.'''
    return Design(factors={"x": [10, 20, 30]}, groups={"all": Group(participants=4)}, trials=3, measures=["y"])
"""
TRUE = {"slope": 1.4, "offset": 1.0}


@pytest.fixture(scope="module")
def client() -> Generator[Any]:
    with local_cluster(2) as found:
        yield found


def means(levels: tuple[int, ...]) -> tuple[TargetMean, ...]:
    return tuple(TargetMean(conditions={"x": x}, measure="y", mean=TRUE["slope"] * x + TRUE["offset"]) for x in levels)


def rmse_of(found: Agreement) -> float:
    assert found.rmse is not None
    return found.rmse


def fit_of(tmp_path: Path, client: Any, *ranges: str, line: str = LINE, **options: Any) -> Fit:
    (tmp_path / "line.py").write_text(line, encoding="utf-8")
    name, parsed = f"{tmp_path / 'line.py'}:line", [Range.from_text(text) for text in ranges or ("slope=0..3", "offset=0..2")]
    return Fit(name, specify(name, **options), parsed, means((1, 2, 3, 4, 5)), tmp_path / "fit", lambda: nullcontext(client))


def test_a_condition_in_which_no_candidate_has_a_value_is_named(tmp_path: Path, client: Any) -> None:
    silent = LINE.replace("y = model.value", "y = model.value if x < 4 else None")
    expected = r"no candidate .* without failed trials; 3 of 3 candidates have no value in: x 4$"
    with pytest.raises(ExperimentError, match=expected):
        fit_of(tmp_path, client, line=silent).run(3)


def held_out(design: str, levels: tuple[int, ...]) -> dict[str, HeldOut]:
    return {design: HeldOut(experiment=specify(design), target=means(levels))}


@pytest.mark.slow
def test_held_out_designs_are_run_with_the_values_of_each_fit(tmp_path: Path, client: Any) -> None:
    fit = fit_of(tmp_path, client, "slope=0..3")
    path = tmp_path / "line.py"
    others = held_out(f"{path}:line", (1, 2, 3)) | held_out(f"{path}:steeper", (10, 20, 30))
    one, other = fit.run(2, held_out=others).held_out.values()
    assert [row["x"] for row in one.rows] == [1, 2, 3]
    assert [row["x"] for row in other.rows] == [10, 20, 30]
    again = fit_of(tmp_path, client, "slope=0..3")
    better = again.run(8, held_out=others)
    assert better.parameters[0].value != fit.run(2).parameters[0].value
    assert [found.rmse for found in better.held_out.values()] != [one.rmse, other.rmse]


def test_the_command_compares_a_held_out_design_with_data_of_a_file(tmp_path: Path, capsys: Any) -> None:
    model, people, others = (tmp_path / name for name in ("line.py", "people.csv", "others.csv"))
    model.write_text(LINE, encoding="utf-8")
    people.write_text("x,measure,mean,source\n1,y,2.4,ours\n3,y,5.2,ours\n", encoding="utf-8")
    others.write_text("x,measure,mean,source\n10,y,15,ours\n", encoding="utf-8")
    words = ["fit", f"{model}:line", "--parameter", "slope=0..3", "--target", str(people), "--out", str(tmp_path / "fit"), "--workers", "1"]
    assert main([*words, "--hold-out", f"{model}:steeper"]) == 1
    assert "names no human data; give --hold-out" in capsys.readouterr().err
    assert main([*words, "--candidates", "2", "--recover", "1", "--hold-out", f"{model}:steeper={others}"]) == 0
    told = capsys.readouterr().out
    for what in ("candidate 2 of 2: slope = ", "held out: ", "simulated data 1 of 1: slope = "):
        assert re.search(rf"^{what}.*\n\d+ of \d+ trials", told, re.MULTILINE), what
    assert len(re.findall(r"^RMSE \d[\d.]*$", told, re.MULTILINE)) == 2  # of each candidate, as soon as it has run
    assert "fitted to 2 means of y, from 2 candidates" in told
    assert "steeper: RMSE" in told
    people.write_text("x,measure,mean,source\n1,y,2.4,ours\n", encoding="utf-8")
    assert main([*words, "--candidates", "2"]) == 0
    assert "95 % interval: none: it needs more means than parameters" in capsys.readouterr().out


def test_a_held_out_design_may_have_another_measure_than_the_fit(
    tmp_path: Path, client: Any, capsys: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    def local(_: int) -> nullcontext[Any]:
        return nullcontext(client)

    monkeypatch.setattr(cluster, "local_cluster", local)
    model, people, others = (tmp_path / name for name in ("line.py", "people.csv", "others.csv"))
    two = LINE.replace("y = model.value\n", "y = model.value\nz = y + 1\nv = y + 2\n")
    model.write_text(two.replace('trials=3, measures=["y"]', 'measures=["z", "v"]'), encoding="utf-8")
    people.write_text("x,measure,mean,source\n1,y,2.4,ours\n3,y,5.2,ours\n", encoding="utf-8")
    words = ["fit", f"{model}:line", "--parameter", "slope=0..3", "--target", str(people), "--measure", "y", "--candidates", "1"]
    words += ["--out", str(tmp_path / "fit"), "--hold-out", f"{model}:steeper={others}"]
    for text, says in (
        ("10,z,15,ours\n10,v,15,ours\n", r"--hold-out .*:steeper: must have means of one measure; choose it with --measure \(v, z\)"),
        ("10,zz,15,ours\n", r"--hold-out .*:steeper: .*others.csv:2: column 'measure': must be one of: z, v \(got 'zz'\)"),
    ):
        others.write_text(f"x,measure,mean,source\n{text}", encoding="utf-8")
        assert main(words) == 1
        assert re.search(says, capsys.readouterr().err)
    others.write_text("x,measure,mean,source\n10,z,15,ours\n", encoding="utf-8")
    assert main(words) == 0
    assert re.search(r"held out .*:steeper: RMSE [\d.]+, r none, r2 none, 1 means", capsys.readouterr().out)


def test_held_out_designs_are_run_with_the_model_and_their_own_numbers(tmp_path: Path, client: Any) -> None:
    steeper = f"{tmp_path / 'line.py'}:steeper"
    fit = fit_of(tmp_path, client, "slope=0..3", values={"noise": 0, "offset": 7}, participants=1, trials=1)
    result = fit.run(1, held_out=held_out(steeper, (10, 20, 30)))
    slope = result.parameters[0].value
    assert [row["model"] for row in result.held_out[steeper].rows] == [pytest.approx(slope * x + 7) for x in (10, 20, 30)]
    (folder,) = (tmp_path / "fit").glob("hold-out *")
    with Store(folder) as store:
        assert store.count == 3 * 4 * 3


def test_held_out_designs_that_the_values_do_not_fit_are_refused_before_anything_runs(tmp_path: Path) -> None:
    fit = fit_of(tmp_path, None, "slope=0..3", values={"x": [1, 2, 3, 4, 5]})
    says = r"--hold-out .*:steeper: varies x \(10, 20, 30\), which --set x would replace; leave out one"
    with pytest.raises(DesignError, match=says):
        fit.run(1, held_out=held_out(f"{tmp_path / 'line.py'}:steeper", (10, 20, 30)))
    fit = fit_of(tmp_path, None, "slope=0..3", values={"noise": 0})
    (tmp_path / "other.py").write_text(LINE.replace("noise = 0.1", "").replace("noise *", "0.1 *"), encoding="utf-8")
    with pytest.raises(DesignError, match=r"--hold-out .*other.py:steeper: --set noise: Design: the model has no parameter 'noise'"):
        fit.run(1, held_out=held_out(f"{tmp_path / 'other.py'}:steeper", (10, 20, 30)))


def test_held_out_means_that_are_those_of_the_fit_are_refused_before_anything_runs(tmp_path: Path) -> None:
    line = f"{tmp_path / 'line.py'}:line"
    with pytest.raises(ExperimentError, match=r"--hold-out .*:line: its means are those of the fit; name a design, or data, that are not"):
        fit_of(tmp_path, None).run(1, held_out=held_out(line, (5, 4, 3, 2, 1)))


@pytest.mark.parametrize(
    ("change", "says"),
    [
        ("slope", r"--ablate: must be NAME=VALUE"),
        ("slop=0", r"--ablate slop=0: the model has no"),
        ("x=7", r"--ablate x=7: the target has no mean for x 7; it has: 1, 2, 3, 4, 5"),
    ],
)
def test_ablated_models_that_cannot_be_are_refused_before_anything_runs(tmp_path: Path, change: str, says: str) -> None:
    with pytest.raises(Actr3dError, match=says):
        fit_of(tmp_path, None).run(1, ablate=[change])


def test_held_out_designs_without_any_condition_of_their_target_are_refused_before_anything_runs(tmp_path: Path) -> None:
    says = r"--hold-out .*:steeper: the target has no mean for x 10, 20, 30; it has: 1, 2"
    with pytest.raises(ExperimentError, match=says):
        fit_of(tmp_path, None).run(1, held_out=held_out(f"{tmp_path / 'line.py'}:steeper", (1, 2)))


def test_an_ablation_reads_values_as_other_options_do(tmp_path: Path, client: Any) -> None:
    line = LINE.replace("noise = 0.1", "noise = 0\npart = True").replace("y = model.value", "y = model.value if part else 7.0")
    changes = ["part=False", "part=false", "part=None", "part=()"]
    result = fit_of(tmp_path, client, "slope=0..3", line=line, participants=1).run(1, ablate=[*changes, "part='False'"])
    assert all({row["model"] for row in result.ablated[change].rows} == {7.0} for change in changes)
    assert [row["model"] for row in result.ablated["part='False'"].rows] == [row["model"] for row in result.fit.rows]


def test_a_target_for_conditions_that_the_design_lacks_is_refused_before_anything_runs(tmp_path: Path, client: Any) -> None:
    (tmp_path / "line.py").write_text(LINE, encoding="utf-8")
    ranges = [Range.from_text("slope=0..3")]
    with pytest.raises(ExperimentError, match=r"--target: has a mean for x 7, which the design does not have; it has: 1, 2, 3, 4, 5"):
        Fit("line", specify(f"{tmp_path / 'line.py'}:line"), ranges, means((1, 7)), tmp_path / "fit", nullcontext)


@pytest.mark.slow
def test_known_parameters_are_found_with_intervals(tmp_path: Path, client: Any) -> None:
    fit = fit_of(tmp_path, client)
    others = held_out(f"{tmp_path / 'line.py'}:steeper", (10, 20, 30))
    result = fit.run(STARTING + 6, held_out=others, ablate=["slope=0"], recover=2)
    slope, offset = result.parameters
    assert slope.value == pytest.approx(1.4, abs=0.15)
    assert offset.value == pytest.approx(1.0, abs=0.4)
    assert slope.low is not None
    assert slope.high is not None
    assert slope.low < 1.4 < slope.high
    assert slope.high - slope.low < 0.8
    assert rmse_of(result.fit) < 0.25
    assert result.fit.cells == 5
    (further,) = result.held_out.values()
    assert further.cells == 3
    assert further.rmse == pytest.approx(abs(slope.value - 1.4) * math.sqrt(1400 / 3), abs=1)
    assert rmse_of(result.ablated["slope=0"]) > 10 * rmse_of(result.fit)
    for one in result.recovered:
        assert one["slope"] == pytest.approx(one["true slope"], abs=0.4)


@pytest.mark.slow
def test_a_fit_ends_at_the_least_squares_in_a_wide_range(tmp_path: Path, client: Any) -> None:
    """The range is a thousand times as wide as the interval."""
    line = LINE.replace("noise = 0.1", "noise = 0.0").replace("offset = 0.5", "offset = 0.9")
    result = fit_of(tmp_path, client, "slope=0..100", line=line, participants=1).run(STARTING + 8)
    (slope,) = result.parameters
    best = 1.4 + 0.1 * 15 / 55  # of a line through 0.9, for data of one through 1
    assert result.is_confirmed
    assert slope.value == pytest.approx(best, abs=0.003)
    assert result.fit.rmse == pytest.approx(math.sqrt(0.01 - 0.01 * 15 * 15 / 55 / 5), rel=0.02)
    assert slope.low is not None
    assert slope.high is not None
    half = float(stdtrit(4, 0.975)) * rmse_of(result.fit) * math.sqrt(5 / 4 / 55)
    assert (slope.low, slope.high) == (pytest.approx(best - half, abs=half / 10), pytest.approx(best + half, abs=half / 10))


@pytest.mark.slow
def test_a_fit_of_no_more_means_than_parameters_ends_although_they_cannot_be_reached(tmp_path: Path, client: Any) -> None:
    """Sums of squares at candidates that are crowded at the end of the range are known to few digits."""
    text = LINE.replace("noise = 0.1", "noise = 0.0").replace("offset = 0.5", "offset = 4.0").replace("[1, 2, 3, 4, 5]", "[4]")
    (tmp_path / "line.py").write_text(text.replace("participants=4", "participants=1"), encoding="utf-8")
    target = [TargetMean(conditions={"x": 4}, measure="y", mean=30.0)]
    ranges = [Range.from_text("slope=0..4")]
    line = specify(f"{tmp_path / 'line.py'}:line")
    fit = Fit("line", line, ranges, target, tmp_path / "fit", lambda: nullcontext(client), seed=2)
    (slope,) = fit.run(STARTING + 15).parameters
    assert (slope.value, slope.low, slope.high) == (4, None, None)


JUMP = """
slope = 2.0
own = 0.0
x = 1

from actr3d.experiment import Design, Group, Normal, design

y = slope * x + 0.5 + (2 if slope > 1.37 else 0) + own


@design
def line():
    people = Group(participants=4, parameters={"own": Normal(mean=0, sd=0.5, low=-2, high=2)})
    return Design(factors={"x": [1, 2, 3, 4, 5]}, groups={"all": people}, trials=1, measures=["y"])
"""


def test_a_fit_of_means_that_jump_is_not_confirmed(tmp_path: Path, client: Any) -> None:
    line = JUMP.replace("sd=0.5", "sd=0").replace("participants=4", "participants=1")
    result = fit_of(tmp_path, client, "slope=0..3", line=line).run(STARTING)
    assert not result.is_confirmed
    assert result.predicted_worst is not None
    assert result.predicted_worst["slope"] == pytest.approx(1.37, abs=0.4)
    assert (result.parameters[0].low, result.parameters[0].high) == (None, None)
    assert rmse_of(result.fit) <= min(rmse for one in result.tried if (rmse := one.rmse) is not None)


@pytest.mark.slow
@pytest.mark.parametrize("differ", ["nothing", "participants", "trials"])
def test_a_fit_of_means_that_jump_has_no_interval_and_its_value_is_the_best_that_was_run(differ: str, tmp_path: Path, capsys: Any) -> None:
    """It is so, too, if participants, or the trials of one, differ more than what an interval allows."""
    model, people = tmp_path / "line.py", tmp_path / "people.csv"
    one = JUMP.replace("participants=4, ", "").replace('"x": [1,', '"own": [-0.5, 0, 0.5], "x": [1,')
    one = re.sub(r"Group\(.*\)", "Group(participants=1)", one)
    text = {"nothing": JUMP.replace("sd=0.5", "sd=0").replace("participants=4", "participants=1"), "participants": JUMP, "trials": one}[
        differ
    ]
    model.write_text(text, encoding="utf-8")
    people.write_text("x,measure,mean,source\n" + "".join(f"{x},y,{1.4 * x + 1},ours\n" for x in range(1, 6)), encoding="utf-8")
    words = ["fit", f"{model}:line", "--parameter", "slope=0..3", "--target", str(people), "--out", str(tmp_path / "fit"), "--workers", "1"]
    assert main([*words, "--candidates", "25"]) == 0
    told = capsys.readouterr().out
    assert "interval: none yet" in told
    assert "fit in a range without the jump" in told
    result = json.loads((tmp_path / "fit" / "fit.json").read_text())
    assert not result["is_confirmed"]
    assert result["predicted_worst"]["slope"] == pytest.approx(1.37, abs=0.4)
    assert result["fit"]["rmse"] <= min(one["rmse"] for one in result["tried"])


@pytest.mark.slow
def test_where_the_model_fails_no_further_candidates_are_spent(tmp_path: Path, client: Any) -> None:
    line = LINE.replace("slope = 2.0", "slope = 1.0").replace("self.value = slope", "assert slope <= 1.2\n        self.value = slope")
    result = fit_of(tmp_path, client, "slope=0..3", line=line, participants=1).run(STARTING + 10)
    (slope,) = result.parameters
    assert 1.1 < slope.value <= 1.2
    assert slope.high is None
    assert sum(one.failed > 0 for one in result.tried[STARTING:]) <= 6


def test_a_fit_that_was_stopped_continues_to_the_same_result(tmp_path: Path, client: Any) -> None:
    (tmp_path / "a").mkdir()
    whole = fit_of(tmp_path / "a", client, participants=1).run(8)
    first = fit_of(tmp_path / "a", client, participants=1)
    again = first.run(8)
    assert again == whole
    folders = [path.name for path in (tmp_path / "a" / "fit").iterdir()]
    assert len(folders) == 9  # also the fitted values
    assert all(name.startswith("candidate ") for name in folders)


def test_two_commands_do_not_fit_in_one_folder_and_one_that_cannot_be_made_is_named(tmp_path: Path, capsys: Any) -> None:
    model, people = tmp_path / "line.py", tmp_path / "people.csv"
    model.write_text(LINE, encoding="utf-8")
    people.write_text("x,measure,mean,source\n1,y,2.4,ours\n3,y,5.2,ours\n", encoding="utf-8")
    words = ["fit", f"{model}:line", "--parameter", "slope=0..3", "--target", str(people), "--candidates", "1", "--workers", "1"]
    (tmp_path / "out").mkdir()
    with only_process(tmp_path / "out", "a fit there"):
        assert main([*words, "--out", str(tmp_path / "out")]) == 1
    assert re.fullmatch(rf"error: '.*out': another process \({os.getpid()}\) runs a fit there\n", capsys.readouterr().err)
    assert main([*words, "--out", str(people / "out")]) == 1
    assert re.fullmatch(r"error: --out: cannot make '.*out' \(Not a directory\)\n", capsys.readouterr().err)
    assert main(["fit", f"{model}:line", "--parameter", "slope=3", "--target", str(people), "--out", str(tmp_path / "new")]) == 2
    assert not (tmp_path / "new").exists()


@pytest.mark.parametrize(
    ("holds", "says"),
    [
        (["experiment.json", "lock", "trials.sqlite"], "holds an experiment; name a new folder, or that of an earlier fit"),
        (["notes.txt"], "holds 'notes.txt' and no earlier fit; name a new folder, or that of an earlier fit"),
        (["candidate 0a1b", "fit.json", "lock", "notes.txt"], ""),
        (["lock", ".hidden"], ""),
        ([], ""),
    ],
)
def test_a_fit_is_made_in_a_folder_of_its_own(tmp_path: Path, holds: list[str], says: str) -> None:
    for name in holds:
        (tmp_path / name).touch()
    with pytest.raises(ExperimentError, match=re.escape(f"--out: '{tmp_path}' {says}")) if says else nullcontext():
        check_folder_of_fit(tmp_path)


@pytest.mark.parametrize(
    ("options", "says"),
    [
        (["--parameter", "slop=0..3"], "--parameter slop: the model has no parameter 'slop'; did you mean 'slope'?"),
        (["--parameter", "slope=0..3", "--ablate", "nose=0"], "--ablate nose=0: the model has no parameter 'nose'"),
    ],
)
def test_a_fit_that_cannot_be_makes_no_folder(
    tmp_path: Path, capsys: Any, monkeypatch: pytest.MonkeyPatch, options: list[str], says: str
) -> None:
    monkeypatch.setattr(cluster, "local_cluster", None)  # and starts no cluster
    (model := tmp_path / "line.py").write_text(LINE, encoding="utf-8")
    (people := tmp_path / "people.csv").write_text("x,measure,mean,source\n1,y,2.4,ours\n3,y,5.2,ours\n", encoding="utf-8")
    assert main(["fit", f"{model}:line", "--target", str(people), "--out", str(tmp_path / "fit"), *options]) == 2
    assert says in capsys.readouterr().err
    assert not (tmp_path / "fit").exists()


def test_a_fit_that_is_stopped_says_how_to_continue(tmp_path: Path, capsys: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    def stopped(*_: object) -> None:
        raise KeyboardInterrupt

    monkeypatch.setattr(cluster, "local_cluster", stopped)
    (model := tmp_path / "line.py").write_text(LINE, encoding="utf-8")
    (people := tmp_path / "people.csv").write_text("x,measure,mean,source\n1,y,2.4,ours\n3,y,5.2,ours\n", encoding="utf-8")
    words = ["fit", f"{model}:line", "--parameter", "slope=0..3", "--target", str(people), "--out", str(tmp_path / "fit")]
    assert main(words) == 130
    told = capsys.readouterr()
    assert told.out.endswith("the same command continues the fit\n")
    assert told.err == "stopped\n"


FAILING = LINE.replace("slope = 2.0", "slope = 1.0").replace(
    "        self.value = ", "        if FAILS:\n            raise ValueError(f'no line: {slope}')\n        self.value = "
)


@pytest.mark.slow
def test_candidates_at_which_the_model_fails_are_bad_ones(tmp_path: Path, client: Any) -> None:
    fit = fit_of(tmp_path, client, "slope=0..3", line=FAILING.replace("FAILS", "slope > 1.8"))
    result = fit.run(STARTING + 2, recover=1)
    assert result.candidates == STARTING + 2
    assert result.parameters[0].value == pytest.approx(1.4, abs=0.3)
    assert result.fit.cells == 5
    assert all(one["true slope"] <= 1.8 for one in result.recovered)


def test_a_fit_at_whose_candidates_the_model_always_fails_shows_its_error(tmp_path: Path, client: Any) -> None:
    fit = fit_of(tmp_path, client, "slope=0..3", line=FAILING.replace("FAILS", "slope != 1.0"), participants=1)
    with pytest.raises(
        ExperimentError,
        match=r"no candidate .* without failed trials; trial 0 in '.*candidate \w+' failed: ValueError: no line: [\d.]+$",
    ):
        fit.run(STARTING + 2)


@pytest.mark.slow
def test_a_condition_in_which_a_trial_failed_has_no_mean(tmp_path: Path, client: Any) -> None:
    """Else, a model that fails in hard trials would be compared by the easy ones."""
    line = FAILING.replace("FAILS", "x == 5 and abs(slope - 1.35) < 0.1 and self.random.random() < 0.6")
    steeper = f"{tmp_path / 'line.py'}:steeper"
    fit = fit_of(tmp_path, client, "slope=0..3", line=line, values={"offset": 1})
    result = fit.run(STARTING, held_out=held_out(steeper, (10, 20, 30)), ablate=["slope=1.4"])
    failing = [one for one in result.tried if one.failed]
    assert [(one.values["slope"], one.rmse, one.trials) for one in failing] == [(1.35, None, 20)]
    assert 0 < failing[0].failed < 4
    assert 1.45 <= result.parameters[0].value <= 1.65  # where no trial fails
    assert rmse_of(result.fit) <= min(one.rmse for one in result.tried if one.rmse is not None)
    assert (result.fit.missing, result.fit.failed, result.fit.trials) == (0, 0, 20)
    assert (result.held_out[steeper].missing, result.held_out[steeper].failed, result.held_out[steeper].trials) == (0, 0, 36)
    changed = result.ablated["slope=1.4"]
    assert (changed.cells, changed.missing, changed.trials) == (4, 1, 20)
    assert [row["x"] for row in changed.rows] == [1, 2, 3, 4]
    assert 0 < changed.failed < 4


def test_a_condition_in_which_some_trials_failed_is_missing(tmp_path: Path, client: Any) -> None:
    fit = fit_of(tmp_path, client, "slope=0..3", line=FAILING.replace("FAILS", "offset == 7 and x == 3 and self.random.random() < 0.5"))
    changed = fit.run(1, ablate=["offset=7"]).ablated["offset=7"]
    assert [row["x"] for row in changed.rows] == [1, 2, 4, 5]
    assert (changed.cells, changed.missing, changed.trials) == (4, 1, 20)
    assert 0 < changed.failed < 4


@pytest.mark.parametrize("fails", ["offset == 7", "offset == 7 and x in (1, 3)"])
def test_a_changed_model_that_fails_in_all_conditions_of_the_target_is_shown_beside_the_fit(
    tmp_path: Path, capsys: Any, fails: str
) -> None:
    model, people = tmp_path / "line.py", tmp_path / "people.csv"
    model.write_text(FAILING.replace("FAILS", fails).replace("participants=4", "participants=1"), encoding="utf-8")
    people.write_text("x,measure,mean,source\n1,y,2.4,ours\n3,y,5.2,ours\n", encoding="utf-8")
    words = ["fit", f"{model}:line", "--parameter", "slope=0..3", "--target", str(people), "--out", str(tmp_path / "fit"), "--workers", "1"]
    assert main([*words, "--candidates", "2", "--ablate", "offset=7"]) == 0
    told = capsys.readouterr().out
    assert re.search(
        r"changed offset=7: no condition of the target has a mean without failed trials; trial \d+ in .* failed: ValueError: no line", told
    )
    found = json.loads((tmp_path / "fit" / "fit.json").read_text())
    assert (found["fit"]["cells"], found["fit"]["failure"]) == (2, None)
    changed = found["ablated"]["offset=7"]
    assert (changed["rmse"], changed["cells"], changed["missing"], changed["rows"]) == (None, 0, 2, [])
    assert 0 < changed["failed"] <= changed["trials"]


def test_failed_trials_are_shown(tmp_path: Path, capsys: Any) -> None:
    model, people = tmp_path / "line.py", tmp_path / "people.csv"
    model.write_text(FAILING.replace("FAILS", "x == 5"), encoding="utf-8")
    people.write_text("x,measure,mean,source\n1,y,2.4,ours\n3,y,5.2,ours\n", encoding="utf-8")
    words = ["fit", f"{model}:line", "--parameter", "slope=0..3", "--target", str(people), "--out", str(tmp_path / "fit"), "--workers", "1"]
    assert main([*words, "--candidates", "2", "--ablate", "noise=0"]) == 0
    told = capsys.readouterr().out
    assert "changed noise=0: RMSE" in told
    assert re.search(r"mean by condition: target, fitted, noise=0\n  x 1: 2\.4, \S+, \S+\n  x 3: 5\.2, \S+, \S+\n", told)
    rows = {
        row["x"]: f"{row['model']:.4g}" for row in json.loads((tmp_path / "fit" / "fit.json").read_text())["ablated"]["noise=0"]["rows"]
    }
    assert re.search(rf"  x 1: 2\.4, \S+, {rows[1]}\n  x 3: 5\.2, \S+, {rows[3]}\n", told)
    assert "2 means; 4 of 20 trials failed" in told
    assert "warning: in 2 of 2 candidates, 8 of 40 trials failed" in told


def test_a_fit_says_that_one_value_replaces_those_of_groups(tmp_path: Path, capsys: Any) -> None:
    model, people = tmp_path / "line.py", tmp_path / "people.csv"
    model.write_text(LINE.replace("Group(participants=4)", 'Group(parameters={"slope": 2.0})'), encoding="utf-8")
    people.write_text("x,measure,mean,source\n1,y,2.4,ours\n3,y,5.2,ours\n", encoding="utf-8")
    words = ["fit", f"{model}:line", "--parameter", "slope=0..3", "--target", str(people), "--out", str(tmp_path / "fit"), "--workers", "1"]
    assert main([*words, "--candidates", "1"]) == 0
    says = "slope is fitted as one value for all participants, instead of those of the design (all: 2.0)\n"
    assert says in capsys.readouterr().out


def test_all_candidates_are_of_one_model_whatever_becomes_of_its_file(tmp_path: Path, client: Any) -> None:
    fit = fit_of(tmp_path, client, "slope=0..3", values={"noise": 0})
    (tmp_path / "line.py").write_text("half of a fi", encoding="utf-8")
    result = fit.run(1, ablate=["offset=7"])
    assert [row["model"] for row in result.ablated["offset=7"].rows] == [
        pytest.approx(result.parameters[0].value * x + 7) for x in (1, 2, 3, 4, 5)
    ]


def test_bounds_have_as_many_decimals_as_values() -> None:
    thirds = Range.from_text("x=0.3333333..0.6666667")
    assert (thirds.low, thirds.high) == (0.333334, 0.666666)
    plain = Range.from_text("x=0.57..1.005")
    assert (plain.low, plain.high) == (0.57, 1.005)


def test_a_design_that_is_held_out_twice_is_refused(tmp_path: Path, capsys: Any) -> None:
    model, people = tmp_path / "line.py", tmp_path / "people.csv"
    model.write_text(LINE, encoding="utf-8")
    people.write_text("x,measure,mean,source\n1,y,2.4,ours\n3,y,5.2,ours\n", encoding="utf-8")
    held_out = ["--hold-out", f"{model}:line={people}"] * 2
    assert main(["fit", f"{model}:line", "--parameter", "slope=0..3", "--target", str(people), *held_out]) == 2
    assert re.search(r"error: --hold-out .*line.py:line: is given twice; give one", capsys.readouterr().err)


@pytest.mark.parametrize(
    ("text", "says"),
    [
        ("slope", r"--parameter: must be NAME=LOW\.\.HIGH \(got 'slope'\)"),
        ("slope=1", r"--parameter: must be NAME=LOW\.\.HIGH"),
        ("slope=a..b", r"--parameter: must be NAME=LOW\.\.HIGH"),
        ("slope=2..1", r"--parameter slope: must be a range LOW\.\.HIGH with LOW < HIGH \(got 2\.\.1\)"),
        ("slope=0..1e-5", r"--parameter slope: must be at least 0\.0001 wide: values have 6 decimals"),
        ("limit=1..4", r"--parameter limit: is a number of the design, not a parameter"),
        ("slope=0..inf", r"--parameter slope: must be a finite range \(got 0\.\.inf\)"),
        ("slope=nan..1", r"--parameter slope: must be a finite range \(got nan\.\.1\)"),
    ],
)
def test_wrong_ranges_are_refused(text: str, says: str) -> None:
    with pytest.raises(SettingError, match=says):
        Range.from_text(text)


def test_parameters_that_the_model_does_not_have_are_refused(tmp_path: Path) -> None:
    with pytest.raises(DesignError, match=r"^--parameter slop: the model has no parameter 'slop'; did you mean 'slope'"):
        fit_of(tmp_path, None, "slop=0..1")


def test_a_parameter_that_is_no_number_or_has_a_value_is_refused(tmp_path: Path) -> None:
    line = LINE.replace("noise = 0.1", "noise = 0.1\nshape = 'line'")
    with pytest.raises(
        SettingError, match=r"^--parameter shape: is not a number in the model \(its default is 'line'\); only numbers are fitted"
    ):
        fit_of(tmp_path, None, "shape=0..1", line=line)
    with pytest.raises(SettingError, match=r"^--parameter slope: has a value by --set, too \(2\); leave out one"):
        fit_of(tmp_path, None, "slope=0..1", values={"slope": 2})


def test_a_parameter_that_is_given_twice_is_refused(tmp_path: Path) -> None:
    with pytest.raises(SettingError, match=r"--parameter slope: is given twice \(0\.\.1 and 0\.\.3\); give one range"):
        fit_of(tmp_path, None, "slope=0..1", "offset=0..1", "slope=0..3")


@pytest.mark.parametrize("levels", ["['near', 'far']", "['near']", "[1, 2]", "[1]"])
def test_a_parameter_that_is_a_factor_is_refused(tmp_path: Path, levels: str) -> None:
    shown = levels.strip("[]").replace("'", "")
    line = LINE.replace('{"x": [1, 2, 3, 4, 5]}', f'{{"x": [1, 2, 3, 4, 5], "offset": {levels}}}')
    with pytest.raises(
        SettingError, match=rf"--parameter offset: is a factor of the design \({shown}\); choose a parameter that is not a factor"
    ):
        fit_of(tmp_path, None, "offset=1..3", line=line)


def test_targets_that_do_not_fit_are_refused(tmp_path: Path, client: Any) -> None:
    fit = fit_of(tmp_path, client)
    fit.measure = "z"
    with pytest.raises(ExperimentError, match="no trial has a value of 'z'"):
        fit.run(1)
    two = (*means((1,)), TargetMean(conditions={}, measure="z", mean=1))
    with pytest.raises(ExperimentError, match=r"must have means of one measure; choose it with --measure \(y, z\)"):
        cells_of_target(two)
    with pytest.raises(ExperimentError, match="has two means for"):
        cells_of_target(means((1, 1)))
    with pytest.raises(ExperimentError, match="no conditions in common"):
        agreement({(("x", 1),): 1.0}, {(("x", 2),): 1.0})


@pytest.mark.parametrize(
    ("lines", "says"),
    [
        (["participant,xx,y", "one,1,2.5"], "unknown column 'xx'"),
        (["x,measure,mean,source", "1,y,2.5,ours", ",y,3,ours"], "all means must be of the same conditions"),
    ],
)
def test_targets_whose_conditions_are_not_clear_are_refused(tmp_path: Path, client: Any, lines: list[str], says: str) -> None:
    model, people = tmp_path / "line.py", tmp_path / "people.csv"
    model.write_text(LINE, encoding="utf-8")
    people.write_text("\n".join(lines), encoding="utf-8")
    design = specify(f"{model}:line")
    with pytest.raises(ExperimentError, match=says):
        Fit("line", design, [Range.from_text("slope=0..3")], load_target(str(people), design, "y"), tmp_path / "fit", nullcontext)


@pytest.mark.parametrize(
    ("measures", "column", "options", "says"),
    [
        ('measures=["y"]', "yy", [], "people.csv:2: column 'measure': must be one of: y (got 'yy'); did you mean 'y'?"),
        ('measures=["y"]', "yy", ["--measure", "yy"], "--measure: the trials of the design 'line' have no measure 'yy'; did you mean 'y'?"),
        ('measures=["yy"]', "yy", [], "line.py:30: Design.measures: the trial has no measure 'yy'; did you mean 'y'?"),
        ("results=found", "zzz", [], "--measure: the trials of the design 'line' have no measure 'zzz'; did you mean 'zz'? They have: zz"),
    ],
)
def test_a_misspelled_measure_of_a_fit_is_refused_before_any_candidate_runs(
    tmp_path: Path, capsys: Any, measures: str, column: str, options: list[str], says: str
) -> None:
    model, people = tmp_path / "line.py", tmp_path / "people.csv"
    found = "def found(program):\n    return {'zz': program.y}\n"
    model.write_text(LINE.replace('measures=["y"]', measures, 1) + found, encoding="utf-8")
    people.write_text(f"x,measure,mean,source\n1,{column},2.4,ours\n3,{column},5.2,ours\n", encoding="utf-8")
    command = ["fit", f"{model}:line", "--parameter", "slope=0..3", "--target", str(people), "--out", str(tmp_path / "fit"), *options]
    assert main(command) in (1, 2)
    assert says in capsys.readouterr().err
    assert not (tmp_path / "fit").exists()


def test_the_measures_of_a_fit_are_found_by_building_one_simulation(tmp_path: Path, capsys: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    path, people = tmp_path / "walks.py", tmp_path / "people.csv"
    path.write_text(
        "from actr3d.experiment import Design, design\n\n\n@design\ndef walks():\n    return Design(model='aperture_passage.py')\n"
    )
    people.write_text("measure,mean,source\nspeed_m_s,1.2,ours\n", encoding="utf-8")
    built: list[Any] = []
    build = Blueprint.build

    def counted(self: Blueprint, settings: Any) -> Any:
        built.append(settings)
        return build(self, settings)

    monkeypatch.setattr(Blueprint, "build", counted)
    assert main(["fit", str(path), "--parameter", "speed", "--target", str(people)]) == 2  # the range is read next
    assert "--parameter: must be NAME=LOW..HIGH (got 'speed')" in capsys.readouterr().err
    assert len(built) == 1


def test_levels_may_be_lists_and_dicts(tmp_path: Path) -> None:
    factors = '{"load": [[1, 2], (3,), {"a": [4]}, None]}'
    path = str(write_experiment(tmp_path, factors=factors, model=COUNTER.replace("n = 3", "n = 3\nload = None")))
    design = specify(path)
    (people := tmp_path / "people.csv").write_text('participant,load,rt\np,"[1, 2]",1\np,[3],2\np,"{""a"": [4]}",3\np,,4\n')
    target = load_target(str(people), design)
    Fit("counting", design, [Range(name="n", low=1, high=3)], target, tmp_path / "fit", nullcontext)
    folder = store_rows(tmp_path / "out", path, lambda trial: {"rt": float(trial.position)})
    with Store(folder) as store:
        found = cells_of_rows(store.rows(), Measured(name="rt"), ["group", "load"])
    assert agreement({cell: mean_of(people) for cell, people in found.items()}, cells_of_target(target)).cells == 4
    assert [(level, len(of)) for level, of in read_results(folder).rows.groupby("load")] == [
        ("[1, 2]", 8),
        ("[3]", 8),
        ("none", 8),
        ('{"a": [4]}', 8),
    ]
    assert read_results(folder).factors == {"load": ["[1, 2]", "[3]", '{"a": [4]}', "none"]}
