"""The classic experiments without a body: what their models must show, and the published means that they are compared with."""

from __future__ import annotations

import csv
import math
from collections import defaultdict
from functools import cache
from pathlib import Path
from statistics import mean
from typing import Any

import pytest

import actr3d.experiment.designs
from actr3d.actr.loading.helper_modules import HelperTexts
from actr3d.experiment.design import OWN_COLUMNS
from actr3d.experiment.specification import library_designs, library_models, specify
from actr3d.experiment.trial import run_trial

HUMAN = Path(next(iter(actr3d.experiment.designs.__path__))).parent / "human"
CLASSICS = ("fan_effect", "paired_associates", "utility_learning")
MEASURED = ("group", "measure", "mean", "sd", "n", "source")
LATENCY_FACTOR, STRENGTH, OTHER_TIME = 0.63, 1.6, 0.845
"""F [s], S and the time of everything but the retrieval [s] in the fan experiment. Source: ACT-R tutorial, unit 5."""


@cache
def rows_of(name: str, participants: int, trials: int = 1, **values: Any) -> list[dict[str, Any]]:
    """Runs a design in this process, and returns its rows."""
    experiment = specify(name, participants=participants, trials=trials, values=values)
    rows = [{**trial.columns, **run_trial(experiment, trial, HelperTexts())} for trial in experiment.design.table()]
    assert [row["error"] for row in rows if row["error"]] == []
    assert {row["end"] for row in rows} == {"end"}
    return rows


def human_rows(name: str) -> list[dict[str, str]]:
    """Returns the published means of a design."""
    with (HUMAN / f"{name}.csv").open(encoding="utf-8", newline="") as file:
        return list(csv.DictReader(file))


# -- the fan effect


def fan_rows() -> list[dict[str, Any]]:
    """Returns two trials of each of two participants in each condition."""
    return rows_of("fan_effect", 2, 2)


def retrieval_time(*fans: int) -> float:
    """Returns F exp(-A) for the words that sentence and fact share, in whole milliseconds [s]."""
    return round(LATENCY_FACTOR * math.exp(-sum(0.5 * (STRENGTH - math.log(fan + 1)) for fan in fans)), 3)


def test_reaction_times_to_targets_are_those_of_the_equation() -> None:
    targets = [row for row in fan_rows() if row["probe"] == "target"]
    assert len(targets) == 36
    for row in targets:
        expected = OTHER_TIME + retrieval_time(row["person_fan"], row["location_fan"])
        assert row["reaction_time"] == pytest.approx(expected, abs=1e-6)


def test_reaction_times_to_foils_are_those_of_one_of_the_two_words() -> None:
    foils = [row for row in fan_rows() if row["probe"] == "foil"]
    by_person = by_location = 0
    for row in foils:
        person, location = (round(OTHER_TIME + retrieval_time(row[f"{word}_fan"]), 3) for word in ("person", "location"))
        assert round(row["reaction_time"], 3) in (person, location)
        if person != location:
            by_person += round(row["reaction_time"], 3) == person
            by_location += round(row["reaction_time"], 3) == location
    assert by_person > 0
    assert by_location > 0


@pytest.mark.parametrize("probe", ["target", "foil"])
def test_reaction_times_rise_with_both_fans(probe: str) -> None:
    rows = [row for row in fan_rows() if row["probe"] == probe]
    for varied in ("person_fan", "location_fan"):
        one, two, three = (mean(row["reaction_time"] for row in rows if row[varied] == fan) for fan in (1, 2, 3))
        assert one + 0.01 < two
        assert two + 0.01 < three


def test_foils_take_longer_than_targets_and_all_answers_are_right() -> None:
    times = {probe: mean(row["reaction_time"] for row in fan_rows() if row["probe"] == probe) for probe in ("target", "foil")}
    assert times["target"] + 0.05 < times["foil"] < times["target"] + 0.2
    assert all(row["correct"] is True for row in fan_rows())


@pytest.mark.filterwarnings("ignore::actr3d.errors.ModelWarning")
def test_without_spreading_activation_there_is_no_fan_effect() -> None:
    rows = rows_of("fan_effect", 1, strength=0.0)
    # Associations are negative then, which counts as 0: every retrieval takes F.
    assert {round(row["reaction_time"], 3) for row in rows} == {round(OTHER_TIME + LATENCY_FACTOR, 3)}


def test_the_facts_of_the_fan_experiment_fill_its_conditions_alike() -> None:
    text = (library_models() / "fan_effect.py").read_text(encoding="utf-8")
    module: dict[str, Any] = {"__name__": "fan_effect"}
    exec(compile(text, "fan_effect.py", "exec"), module)
    cells: dict[tuple[int, int], int] = defaultdict(int)
    for fact in module["FACTS"]:
        person, location = fact.split()
        cells[module["fan"](person), module["fan"](location)] += 1
    assert dict(cells) == {(person, location): person for person in (1, 2, 3) for location in (1, 2, 3)}


# -- paired associates


def sessions() -> list[dict[str, Any]]:
    """Returns the rows of 10 sessions of paired associates."""
    return rows_of("paired_associates", 10)


def by_block(measure: str) -> list[float]:
    """Returns the mean of a measure in each block but the first."""
    return [mean(row[f"{measure}_{block}"] for row in sessions()) for block in range(2, 9)]


def test_nothing_is_known_before_the_first_study() -> None:
    assert {row["accuracy_1"] for row in sessions()} == {0.0}
    assert {row["latency_1"] for row in sessions()} == {None}


def test_accuracy_rises_with_practice() -> None:
    accuracy = by_block("accuracy")
    assert accuracy[0] < accuracy[1] < mean(accuracy[2:4]) < mean(accuracy[4:])
    assert 0.4 < accuracy[0] < 0.7
    assert accuracy[-1] > 0.9


def test_latency_falls_with_practice() -> None:
    latency = by_block("latency")
    assert mean(latency[:2]) - 0.2 > mean(latency[2:4])
    assert mean(latency[2:4]) - 0.1 > mean(latency[4:])
    assert all(0.6 < time < 5 for time in latency)


def test_paired_associates_are_close_to_the_published_means() -> None:
    human = {(row["measure"], row["block"]): float(row["mean"]) for row in human_rows("paired_associates")}
    for measure, most in (("accuracy", 0.08), ("latency", 0.15)):
        squares = [(found - human[measure, str(block)]) ** 2 for block, found in enumerate(by_block(measure), start=2)]
        assert math.sqrt(mean(squares)) < most, measure


def test_without_decay_nothing_is_forgotten() -> None:
    (row,) = rows_of("paired_associates", 1, decay=0.0, noise=0.01)
    assert [row[f"accuracy_{block}"] for block in range(2, 9)] == [1.0] * 7


def test_longer_intervals_mean_more_forgetting() -> None:
    rows = rows_of("paired_associates", 2, study_time=60.0, blocks=2)
    assert mean(row["accuracy_2"] for row in rows) < by_block("accuracy")[0] - 0.15


# -- utility learning


def test_choices_approach_the_reinforced_side() -> None:
    rows = rows_of("utility_learning", 20, heads_probability=(0.1, 0.5, 0.9))
    late = {p: mean(row["late"] for row in rows if row["heads_probability"] == p) for p in (0.1, 0.5, 0.9)}
    first = {p: mean(row["heads_1"] for row in rows if row["heads_probability"] == p) for p in (0.1, 0.5, 0.9)}
    assert late[0.1] < first[0.1] - 0.05
    assert late[0.9] > first[0.9] + 0.05
    assert 0.1 < late[0.1] < 0.3
    assert 0.4 < late[0.5] < 0.6
    assert 0.7 < late[0.9] < 0.9


def test_utility_learning_is_close_to_the_published_means() -> None:
    rows = rows_of("utility_learning", 30, heads_probability=(0.9,))
    squares = [(mean(row[f"heads_{one['block']}"] for row in rows) - float(one["mean"])) ** 2 for one in human_rows("utility_learning")]
    assert math.sqrt(mean(squares)) < 0.08


def test_without_learning_both_sides_are_chosen_alike() -> None:
    rows = rows_of("utility_learning", 20, heads_probability=(0.9,), alpha=0.0)
    assert mean(row["late"] for row in rows) == pytest.approx(0.5, abs=0.08)


# -- the designs and their human data


@pytest.mark.parametrize("name", CLASSICS)
def test_a_classic_design_has_a_model_and_human_data_of_its_name(name: str) -> None:
    experiment = specify(name)
    assert library_designs()[name].name == f"{name}.py"
    assert experiment.specification.model.file == f"{name}.py"
    assert "from actr3d.actr import *" in experiment.specification.model.text
    assert experiment.design.human == name
    assert len(experiment.description) > 200


@pytest.mark.parametrize("name", CLASSICS)
def test_human_data_name_conditions_and_measures_of_their_design(name: str) -> None:
    design = specify(name).design
    rows = human_rows(name)
    factors = [column for column in rows[0] if column not in MEASURED]
    assert list(rows[0]) == ["group", *factors, *MEASURED[1:]]
    over = {measure.name: measure.over for measure in design.kept}
    assert set(factors) == {*design.factors, *filter(None, over.values())}
    assert not set(factors) & set(OWN_COLUMNS)
    known = set(rows_of(name, 1)[0])
    for row in rows:
        assert row["group"] in design.groups
        numbered = over[row["measure"]] is not None
        assert (f"{row['measure']}_{row['block']}" if numbered else row["measure"]) in known
        assert all(row[factor] in map(str, levels) for factor, levels in design.factors.items())
        assert float(row["mean"]) >= 0
        assert row["sd"] == row["n"] == "", "the tutorial quotes neither"
        assert row["source"].endswith("(S)")
    assert len({tuple(row[column] for column in ("group", *factors, "measure")) for row in rows}) == len(rows)
