"""Reports of experiments: what the page and its files hold, and which experiments have none."""

from __future__ import annotations

import csv
import html
import math
import re
import shutil
import tempfile
from collections.abc import Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from html.parser import HTMLParser
from multiprocessing import get_context
from pathlib import Path
from typing import Any
from urllib.parse import unquote

import pytest

from actr3d.cli import main
from actr3d.errors import ExperimentError
from actr3d.experiment.aperture.analysis import (
    Rotation,
    at_own_ratios,
    frame_of,
    judging_apertures,
    passing_apertures,
    passings_of,
    with_greatest_angles,
)
from actr3d.experiment.aperture.constraints import Findings
from actr3d.experiment.design import Trial
from actr3d.experiment.plain_values import plain_text
from actr3d.experiment.report import general, statistics
from actr3d.experiment.report.analyses import ANALYSES
from actr3d.experiment.report.command import write_report
from actr3d.experiment.report.figures import LOOKS, Curve, Look, Pane, curves_figure, legend_columns, png, svg
from actr3d.experiment.report.general import comparison_section, measure_sections, what_was_run
from actr3d.experiment.report.libraries import pandas, pingouin
from actr3d.experiment.report.page import page as report_page
from actr3d.experiment.report.parts import Caution, Plot, Section, Table
from actr3d.experiment.report.reference_means import ReferenceMeans, fit_to, human_data_of, means_of_experiment, means_of_people
from actr3d.experiment.report.results import Results, by_number, read_results
from actr3d.experiment.report.statistics import cell_means
from actr3d.experiment.specification import specify
from actr3d.experiment.store import Store
from actr3d.experiment.table import export
from actr3d.experiment.target import load_target
from tests.helpers.experiments import COUNTER, write_experiment
from tests.helpers.folders import not_writable
from tests.helpers.reports import store_rows, walk
from tests.helpers.shared import made_once


def files(folder: Path) -> dict[str, bytes]:
    """Returns all files of a report."""
    report = folder / "report"
    return {str(path.relative_to(report)): path.read_bytes() for path in sorted(report.rglob("*")) if path.is_file()}


def table(folder: Path, name: str) -> list[dict[str, str]]:
    with (folder / "report" / "tables" / f"{name}.csv").open(encoding="utf-8") as file:
        return list(csv.DictReader(file))


def page(folder: Path) -> str:
    return (folder / "report" / "index.html").read_text(encoding="utf-8")


def walk_through(trial: Any) -> dict[str, Any]:
    """Returns those of the measures of a walk from which reports have sections of their own."""
    names = ("outcome", "wall_angle_deg", "onset_distance_m", "contacts", "clearance_left_m", "clearance_right_m")
    return {name: value for name, value in walk(trial).items() if name in names}


def parts_on_apertures(folder: Path, others: Sequence[ReferenceMeans] = ()) -> list[str | Table | Plot | Caution]:
    """Returns the parts of the sections on apertures, without writing a report: that would draw all figures and test each measure."""
    return [part for section in passing_apertures(read_results(folder), list(others)) for part in section.parts]


def frames(parts: Sequence[str | Table | Plot | Caution]) -> dict[str, Any]:
    """Returns the tables of parts by their names."""
    return {part.name: part.frame for part in parts if isinstance(part, Table)}


def cautions(parts: Sequence[str | Table | Plot | Caution]) -> str:
    """Returns what parts say that a reader must not overlook."""
    return "\n".join(part.text for part in parts if isinstance(part, Caution))


def one_cell(folder: Path) -> str:
    """Writes a design whose report has no figures and no tests, and returns its file: for what a report does with its folder."""
    return str(write_experiment(folder, factors='{"n": [2]}', participants=1))


def count(trial: Any) -> dict[str, Any]:
    return {"rt": 0.05 * trial.values["n"] + 0.001 * (trial.number % 5), "luck": (trial.number * 7 % 10) / 10}


@pytest.fixture(scope="module")
def walks(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with data of a user's own participants, and an experiment with apertures whose report compares it with them."""

    def make(place: Path) -> None:
        rows = [f"{n},{group},{wide},normal,{30 + n}" for group in ("small", "large") for n in range(3) for wide in (0.4, 0.5, 0.6)]
        people = place / "people.csv"
        people.write_text("\n".join(["participant,group,aperture,condition,wall_angle_deg", *rows]), encoding="utf-8")
        write_report(store_rows(place / "walks", "warren_whang_1987", walk_through, trials=1), human=people)

    return made_once(tmp_path_factory, "report", make)


@pytest.fixture
def people(walks: Path) -> Path:
    """Data of a user's own participants."""
    return walks / "people.csv"


@pytest.fixture
def walked(walks: Path) -> Path:
    """An experiment with apertures, and its report beside people."""
    return walks / "walks"


def test_a_report_needs_nothing_from_elsewhere_and_its_links_lead_somewhere(walked: Path) -> None:
    text = page(walked)
    assert "<script" not in text
    assert "&lt; 0.001" in text
    assert "< 0.001" not in text, "a sign in a text is no tag"
    assert not re.findall(r"(?:src|href)=\"(?:https?:|//)", text)
    for link in re.findall(r"href=\"((?:figures|tables)/[^\"]+)\"", text):
        assert (walked / "report" / link).exists()
    anchors, ids = re.findall(r"href=\"#([^\"]+)\"", text), re.findall(r"\bid=\"([^\"]+)\"", text)
    assert set(anchors) <= set(ids)
    assert len(ids) == len(set(ids))
    named = set(re.findall(r"(?:figures|tables)/[\w.]+", text))
    assert named == {name for name in files(walked) if name != "index.html"}, "each file is named on the page"


def test_links_and_ids_are_right_for_any_name_of_a_measure(tmp_path: Path) -> None:
    names = ['x" onclick="alert(1)', "a#b", "a b", "50%41", "q?", "rt", "RT", "<i>", "'&amp;"]
    path = str(write_experiment(tmp_path, participants=2))
    folder = store_rows(tmp_path / "out", path, lambda trial: {name: count(trial)["rt"] + n for n, name in enumerate(names)}, trials=2)
    write_report(folder)
    found = Links()
    found.feed(page(folder))
    assert not [name for name in found.attributes if name.startswith("on")]
    linked = {unquote(link) for link in found.links if not link.startswith("#")}
    assert linked == {name for name in files(folder) if name != "index.html"}
    assert len({name.casefold() for name in linked}) == len(linked), "some disks do not distinguish capital letters"
    assert len(linked) > 3 * len(names)
    assert {link[1:] for link in found.links if link.startswith("#")} <= set(found.ids)
    assert len(found.ids) == len(set(found.ids))
    assert all(re.fullmatch(r"[^\s\"'<>()%]+", one) for one in found.ids)


class Links(HTMLParser):
    """Collects the attributes, ids and links of a page."""

    def __init__(self) -> None:
        super().__init__()
        self.attributes: set[str] = set()
        self.ids: list[str] = []
        self.links: set[str] = set()

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        given = dict(attrs)
        self.attributes |= set(given)
        if one := given.get("id"):
            self.ids.append(one)
        if tag == "a" and (link := given.get("href")):
            self.links.add(link)


def test_people_are_compared_at_the_levels_that_the_experiment_has(tmp_path: Path) -> None:
    recognised = store_rows(
        tmp_path / "targets",
        "fan_effect",
        lambda _: {"reaction_time": 1.2, "correct": True},
        participants=1,
        trials=1,
        values={"probe": "target"},
    )
    write_report(recognised)
    assert [row["probe"] for row in table(recognised, "means_beside_people")] == ["target"] * 9
    assert "9 rows are left out: the experiment has no probe &#x27;foil&#x27;." in page(recognised)

    path = write_experiment(tmp_path, factors='{"mode": ["count", "shout", None], "n": [1, 2]}')
    text = "participant,mode,n,rt\n1,count,1,0.2\n1,shout,2,0.3\n1,,2,0.4\n"
    (people := tmp_path / "people.csv").write_text(text, encoding="utf-8")
    for mode, left in (("count", 1), ("hang", 0)):
        counted = store_rows(tmp_path / mode, str(path), count, values={"mode": mode})
        write_report(counted, human=people)
        assert f"{3 - left} rows are left out: the experiment has no mode " in page(counted)
        assert (counted / "report" / "tables" / "means_beside_people.csv").exists() == bool(left)
    people.write_text(f"{text}1,cuont,1,0.2\n", encoding="utf-8")
    with pytest.raises(ExperimentError, match=r"people\.csv:5: column 'mode': must be one of: .*count.*\(got 'cuont'\)"):
        write_report(tmp_path / "count", human=people)


def test_an_error_in_a_measure_ends_its_own_section_and_is_named(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    def run_tests(results: Any, measure: str) -> Any:
        return 1 / 0 if measure == "rt" else statistics.run_tests(results, measure)

    monkeypatch.setattr(general, "run_tests", run_tests)
    folder = store_rows(tmp_path / "out", str(write_experiment(tmp_path, participants=3)), count)
    assert main(["report", str(folder)]) == 1
    error = capsys.readouterr().err
    named = r"measure 'rt': ZeroDivisionError: division by zero \(test_report\.py, line \d+\)"
    assert re.fullmatch(rf"error: '.*index\.html' is written, but some of its sections are not complete: {named}\n", error), error
    text = html.unescape(page(folder))
    assert len(re.findall(rf"Not all of this section could be made: {named}\.", text)) == 1
    assert len(table(folder, "means_rt")) == len(table(folder, "means_luck")), "what was made before the error is there"
    assert table(folder, "anova_luck")


def test_the_measures_that_a_design_names_are_open_and_in_the_contents(tmp_path: Path) -> None:
    path = str(write_experiment(tmp_path, participants=1))
    folder = store_rows(tmp_path / "out", path, count, trials=1)
    write_report(folder)
    assert '<section id="rt--s-">' in page(folder)
    assert '<a href="#rt--s-">rt [s]</a>' in page(folder)
    parts = by_number(read_results(folder))
    assert not [one.title for one in measure_sections(parts, [], secondary=True) if one.folded]
    unnamed = [replace(part, design=replace(part.design, measures=())) for part in parts]
    assert [one.title for one in measure_sections(unnamed, [], secondary=True) if one.folded] == ["rt [s]", "luck"]
    assert not [one.title for one in measure_sections(unnamed, []) if one.folded], "no other section has results"


def test_measures_are_folded_below_an_analysis_that_shows_what_matters(walked: Path) -> None:
    folded = re.findall(r'<details class="section" id="([^"]+)"', page(walked))
    assert "contacts" in folded
    assert "wall-angle--degrees-" not in folded, "people have it"


def test_the_same_rows_give_the_same_files(tmp_path: Path) -> None:
    path = str(write_experiment(tmp_path, participants=3))
    folders = [store_rows(tmp_path / name / "out", path, count) for name in ("one", "two")]
    for folder in folders:
        write_report(folder)
    assert files(folders[0]) == files(folders[1])


def test_apertures_have_their_own_sections(walked: Path) -> None:
    assert [(row["number"], row["result"]) for row in table(walked, "constraints")] == [
        ("1", "met"),
        ("2", "not decided"),
        ("3", "met"),
        ("4", "not decided"),
        ("5", "met"),
        ("6", "met"),
        ("7", "met"),
        ("8", "not decided"),
        ("9", "not decided"),
    ]
    agreement = {(row["means_of"], row["compared_with"]): row for row in table(walked, "agreement")}
    assert float(agreement["geometry (baseline)", "this model"]["rmse"]) < 6
    assert int(agreement["this model", "original ACT-R 3D"]["cells"]) == 28
    assert agreement["geometry (baseline)", "original ACT-R 3D"]["r2"]
    (equal,) = table(walked, "equivalence")
    assert equal["result"] == "equivalent"
    same = next(row for row in table(walked, "constraints") if row["number"] == "3")
    assert f"p = {float(equal['p']):.3g}" in same["found"], "pingouin and the constraint agree"
    for row in table(walked, "critical_ratios"):
        assert float(row["low"]) < 1.3 < float(row["high"])
    margins = table(walked, "margins")
    assert {row["narrower_mean"] for row in margins} == {"6.8"}
    for side in ("left", "right"):
        assert any(float(row[f"{side}_mean"]) > 6.8 for row in margins), "no side is the narrower one in each trial"
    assert "Starts aside" not in page(walked)


def test_the_equivalence_of_groups_is_tested_once(walked: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    tested: list[Any] = []
    tost = pingouin().tost

    def counted(*given: Any, **named: Any) -> Any:
        tested.append(given)
        return tost(*given, **named)

    monkeypatch.setattr(pingouin(), "tost", counted)
    passing_apertures(read_results(walked), [])
    assert len(tested) == 1


@pytest.mark.slow
def test_published_speeds_are_shown_with_their_source(tmp_path: Path) -> None:
    folder = store_rows(tmp_path / "walks", "warren_whang_1987", lambda trial: {"speed_m_s": walk(trial)["speed_m_s"]}, trials=1)
    write_report(folder)
    (fit,) = table(folder, "fit_to_people")
    assert (fit["measure"], fit["cells"]) == ("speed_m_s", "4")
    assert "doi 10.1037/0096-1523.13.3.371" in page(folder)


def test_one_row_of_human_data_is_not_called_rows(tmp_path: Path) -> None:
    path = str(write_experiment(tmp_path, participants=1))
    people = tmp_path / "people.csv"
    people.write_text("participant,n,rt\na,1,0.5\n", encoding="utf-8")
    folder = store_rows(tmp_path / "out", path, count, trials=1)
    write_report(folder, human=people)
    assert "people.csv: 1 row of trials of 1 person." in page(folder)


def test_own_human_data_are_drawn_and_compared(walked: Path) -> None:
    fit = next(row for row in table(walked, "fit_to_people") if row["measure"] == "wall_angle_deg")
    assert fit["cells"] == "6"
    assert "people.csv: 18 rows of trials of 6 people" in page(walked)
    assert ">people</text>" in (walked / "report/figures/rotation_by_aperture.svg").read_text(encoding="utf-8")
    assert "Human mean angles for each aperture are not available" not in page(walked)


def beside(folder: Path, people: Path) -> list[ReferenceMeans]:
    parts = by_number(read_results(folder))
    data, _ = human_data_of(parts[0].design, parts, people)
    assert data is not None
    return [means_of_people(data, parts)]


def rotation(folder: Path, people: Path) -> Rotation:
    results = read_results(folder)
    findings = Findings(passings_of(results))
    return Rotation(results, findings, frame_of(results, findings), beside(folder, people))


def test_people_are_drawn_by_their_own_ratios(walked: Path, tmp_path: Path) -> None:
    def given(head: str, *rows: str) -> Path:
        path = tmp_path / "people.csv"
        path.write_text("\n".join([f"participant,group,condition,wall_angle_deg,{head}", *rows]), encoding="utf-8")
        return path

    def drawn(people: Path) -> tuple[list[list[float]], str]:
        """Returns the ratios at which people of each group are drawn in the first pane, and the note of the figure."""
        figure = next(part for part in rotation(walked, people).parts() if isinstance(part, Plot) and part.name == "rotation_by_ratio")
        lines = [line for line in figure.figure.axes[0].lines if line.get_markersize() == LOOKS["human"]["markersize"]]
        return [[round(x, 3) for x in line.get_xdata()] for line in lines], figure.note

    small, large = "1,small,normal,30", "1,large,normal,40"
    known, note = drawn(given("aperture,shoulder_width", f"{small},0.4,0.38", f"{small},0.5,0.38", f"{large},0.4,0.52"))
    assert known == [[1.053, 1.316], [0.769]]
    assert "left out" not in note
    unknown, note = drawn(given("aperture", f"{small},0.4", f"{large},0.4"))
    assert unknown == []
    assert "People are left out: their data have neither `shoulder_width` nor `ratio`." in note

    def ratios(head: str, *rows: str) -> list[float]:
        return [round(x, 3) for x in at_own_ratios(*beside(walked, given(head, *rows))).frame["ratio"]]

    assert ratios("ratio", f"{small},1.05", f"{small},1.3", f"{large},0.77") == [1.05, 1.3, 0.77]
    assert ratios("aperture,shoulder_width,ratio", f"{small},0.4,0.38,1.1", f"{large},0.4,0.52,") == [1.1, 0.769], "a given ratio counts"
    with pytest.raises(ExperimentError, match=r"column 'shoulder_width': the model's parameter shoulder_width: must be <= \S+ \(got 38\)"):
        ratios("aperture,shoulder_width", f"{small},0.4,38")


def test_another_experiment_is_drawn_by_the_ratios_of_its_own_participants(tmp_path: Path) -> None:
    values = {"aperture": [0.4, 0.5], "condition": "normal", "shoulder_width": 0.5}
    folder = store_rows(tmp_path / "walks", "warren_whang_1987", walk_through, participants=1, trials=1, values=values)
    results = read_results(folder)
    parts = by_number(results)
    other = means_of_experiment(parts, parts)
    assert other is not None
    assert sorted(set(at_own_ratios(other).frame["ratio"])) == [0.8, 1.0]


def test_the_baseline_is_compared_with_people_too(walked: Path, people: Path) -> None:
    agreement = {(row["means_of"], row["compared_with"]): row for row in table(walked, "agreement")}
    model, baseline = (agreement[name, "people"] for name in ("this model", "geometry (baseline)"))
    assert (model["cells"], baseline["cells"]) == ("6", "6")
    means = {(row["group"], row["condition"], row["aperture"]): row for row in table(walked, "rotation")}
    there = [means[group, "normal", wide] for group in ("small", "large") for wide in ("0.4", "0.5", "0.6")]
    for row, column in ((model, "mean"), (baseline, "baseline")):
        expected = math.sqrt(sum((float(cell[column]) - 31) ** 2 for cell in there) / 6)
        assert float(row["rmse"]) == pytest.approx(expected, rel=1e-6)
    assert not [name for name in frames(parts_on_apertures(walked))["agreement"]["compared_with"] if name == "people"]


def test_the_entries_of_a_legend_fit_into_the_figure() -> None:
    assert legend_columns([5, 5, 10, 17, 19], 8.6) == 5
    assert legend_columns([21] * 5 + [5, 6], 6.4) == 3
    assert legend_columns([5, 5, 10, 17, 19, 29], 8.6) == 3
    assert legend_columns([200, 3], 6.4) == 1


def test_lists_are_shown_by_number_beside_people(tmp_path: Path) -> None:
    def learn(trial: Any) -> dict[str, Any]:
        luck = 0.01 * (trial.number % 7)
        accuracy = {f"accuracy_{block}": 0.1 * block + luck for block in range(1, 9)}
        return {**accuracy, "latency_1": None, **{f"latency_{block}": 3.0 - (0.2 + luck) * block for block in range(2, 9)}}

    folder = store_rows(tmp_path / "learned", "paired_associates", learn, participants=12)
    write_report(folder)
    assert [row["block"] for row in table(folder, "means_accuracy")] == [f"{block}" for block in range(1, 9)]
    assert [row["block"] for row in table(folder, "means_latency")] == [f"{block}" for block in range(2, 9)]
    assert [row["effect"] for row in table(folder, "anova_latency")] == ["block"]
    fits = {row["measure"]: row for row in table(folder, "fit_to_people")}
    assert {name: fit["cells"] for name, fit in fits.items()} == {"accuracy": "8", "latency": "7"}
    assert float(fits["latency"]["r2"]) > 0.8
    assert ">people</text>" in (folder / "report/figures/measure_accuracy.svg").read_text(encoding="utf-8")
    assert "accuracy_3" not in page(folder)
    again = read_results(store_rows(tmp_path / "again", "paired_associates", learn, participants=3))
    parts = by_number(read_results(folder))
    other = means_of_experiment(by_number(again), parts)
    assert other is not None
    fits = fit_to(parts, other)
    assert dict(zip(fits["measure"], fits["cells"], strict=True)) == {"accuracy": 8, "latency": 7}


def test_failures_and_missing_trials_are_said_plainly(tmp_path: Path) -> None:
    path = write_experiment(tmp_path, participants=3)

    def measures(trial: Any) -> dict[str, Any]:
        return {"error": "Traceback\nValueError: <b>no</b>"} if trial.number % 9 == 1 else count(trial)

    folder = store_rows(tmp_path / "out", str(path), measures, least=4)
    write_report(folder)
    assert sum(int(row["trials"]) for row in table(folder, "failures")) == 3
    text = page(folder)
    assert "Only 32 of 36 trials have finished" in text
    assert "3 of 32 trials failed" in text
    assert "ValueError: &lt;b&gt;no&lt;/b&gt;" in text
    assert "The design names no human data" in text


def test_cells_with_failed_trials_are_named_and_not_compared(tmp_path: Path) -> None:
    """What is left of a cell would be the mean of its easier trials; a fit compares none of it, either."""
    path = str(write_experiment(tmp_path, participants=4, trials=1))

    def measures(trial: Any) -> dict[str, Any]:
        return {"error": "ValueError: no"} if trial.values["n"] == 5 and trial.participant.name == "all 3" else count(trial)

    whole, failing = (read_results(store_rows(tmp_path / name, path, of)) for name, of in (("whole", count), ("failing", measures)))
    said = cautions(what_was_run(failing).parts)
    assert "Cells with failed trials: n 5. What is left may be the easier ones" in said
    for one, other in ((failing, whole), (whole, failing)):
        beside = means_of_experiment([other], [one])
        assert beside is not None
        assert list(fit_to([one], beside)["cells"]) == [2, 2]


def test_means_that_are_not_compared_are_named(tmp_path: Path) -> None:
    def measures(trial: Any) -> dict[str, Any]:
        return {"error": "ValueError: no"} if trial.values["n"] == 5 else {**count(trial), "luck": None if trial.values["n"] == 4 else 0.5}

    one, two = (tmp_path / name for name in ("one", "two"))
    path = str(write_experiment(tmp_path, participants=1, trials=1, factors='{"n": [1, 2, 3, 4, 5]}'))
    failing = read_results(store_rows(one, path, measures))
    more = read_results(store_rows(two, path, count, values={"n": [1, 2, 5, *range(6, 13)]}))
    beside = means_of_experiment([more], [failing])
    assert beside is not None
    parts = comparison_section(failing, more, [failing], beside).parts
    assert "Left out of the means of two for rt, luck: n 5; n 6; n 7; n 8; n 9; n 10; and 2 more." in parts
    assert list(frames(parts)["fit_to_other"]["left_out"]) == [8, 8]
    people = tmp_path / "people.csv"
    means = [
        f"{group},{n},{measure},0.1,2,own" for measure, n, group in [("rt", 1, "all"), ("rt", 5, ""), ("luck", 1, ""), ("luck", 4, "all")]
    ]
    people.write_text("\n".join(["group,n_,measure,mean,n,source", *means]), encoding="utf-8")
    data, _ = human_data_of(failing.design, [failing], people)
    assert data is not None
    said = general.human_section([failing], data, "", means_of_people(data, [failing])).parts
    assert [text for text in said if isinstance(text, str) and text.startswith("Left out")] == [
        "Left out of the means of people for rt: n 5.",
        "Left out of the means of people for luck: n 4.",
    ]


def test_cells_with_failed_walks_agree_with_nothing(people: Path, tmp_path: Path) -> None:
    def measures(trial: Any) -> dict[str, Any]:
        failed = trial.values["aperture"] == 0.5 and trial.participant.name == "small 2"
        return {"error": "ValueError: no"} if failed else walk_through(trial)

    folder = store_rows(tmp_path / "walks", "warren_whang_1987", measures, trials=1, values={"condition": "normal"})
    others = beside(folder, people)
    table = next(part for part in parts_on_apertures(folder, others) if isinstance(part, Table) and part.name == "agreement")
    agreement = {(row["means_of"], row["compared_with"]): row for row in table.frame.to_dict("records")}
    (fit,) = fit_to(by_number(read_results(folder)), *others).query("measure == 'wall_angle_deg'").to_dict("records")
    assert agreement["this model", "people"]["cells"] == fit["cells"] == 5
    assert agreement["this model", "people"]["rmse"] == pytest.approx(fit["rmse"])
    assert agreement["this model", "original ACT-R 3D"]["cells"] == 13
    assert agreement["geometry (baseline)", "this model"]["cells"] == 15
    assert "Cells in which a trial failed are left out" in table.note


def test_the_points_of_figures_on_apertures_are_in_tables(walked: Path) -> None:
    margins = table(walked, "margins_of_participants")
    assert {row["side"] for row in margins} == {"left", "right", "narrower side"}
    assert len(margins) == 3 * 2 * 2 * 8
    assert all(float(row["low"]) <= float(row["mean"]) <= float(row["high"]) for row in margins)
    for row in table(walked, "rotation"):
        width = float(row["aperture"]) / float(row["ratio"])
        assert width == pytest.approx(0.404 if row["group"] == "small" else 0.484, abs=0.03)


def test_few_participants_are_those_with_results(tmp_path: Path) -> None:
    path = str(write_experiment(tmp_path, participants=10))

    def measures(trial: Any) -> dict[str, Any]:
        return count(trial) if trial.participant.name in ("all 3", "all 7") else {"error": "ValueError: no"}

    said = cautions(what_was_run(read_results(store_rows(tmp_path / "out", path, measures, trials=1))).parts)
    assert "A group has 2 participants with results, of 10 in the design. With fewer than 3 nothing can be said" in said
    assert "intervals over two participants are no more than their range" in said


def test_a_report_says_if_the_description_of_the_design_is_of_other_numbers(tmp_path: Path) -> None:
    path = str(write_experiment(tmp_path))
    text = "The description is that of the design as it was written. Changed in this experiment: trials, n."
    changed = read_results(store_rows(tmp_path / "changed", path, count, trials=1, values={"n": [1, 2]}))
    assert text in what_was_run(changed).parts
    same: dict[str, Any] = {"trials": 4, "participants": 2, "values": {"n": [1, 2, 5]}}
    for name, given in {"written": dict[str, Any](), "same": same}.items():
        written = read_results(store_rows(tmp_path / name, path, count, **given))
        assert not [part for part in what_was_run(written).parts if isinstance(part, str) and "Changed in" in part]


@pytest.mark.parametrize(("label", "marker"), [("small", "o"), ("", "D")])
def test_a_legend_has_the_markers_that_are_drawn(label: str, marker: str) -> None:
    sources: dict[str, Look] = {"model": "model", "people": "human"}
    curves = [Curve(label=label, source=who, look=look, x=[1, 2], y=[1, 2]) for who, look in sources.items()]
    figure = curves_figure([Pane(title="", curves=curves)], "x", "y")
    assert [line.get_marker() for line in figure.axes[0].lines] == [marker] * 2
    shown = {handle.get_label(): handle.get_marker() for handle in figure.legends[0].legend_handles}
    assert (shown["model"], shown["people"]) == (marker, marker)


def test_a_marker_is_never_cut_where_y_begins_at_zero() -> None:
    curve = Curve(label="careful", source="model", look="model", x=[50], y=[2.94865], low=[2.94785], high=[2.94945])
    figure = curves_figure([Pane(title="", curves=[curve])], "x", "y", from_zero=True)
    low, high = figure.axes[0].get_ylim()
    assert low == 0
    assert high - 2.94865 > 0.02 * high


def test_points_of_many_curves_stay_nearer_to_their_own_level_than_to_the_next() -> None:
    levels = [n / 7 for n in range(150)]
    curves = [Curve(label=f"g{n}", source="model", look="model", x=levels, y=levels) for n in range(12)]
    figure = curves_figure([Pane(title="", curves=curves)], "x", "y")
    for line in figure.axes[0].lines:
        assert all(abs(at - level) < 0.5 / 7 for at, level in zip(line.get_xdata(), levels, strict=True))


def test_no_two_of_many_curves_look_the_same() -> None:
    curves = [Curve(label=f"g{n}", source="model", look="model", x=[1, 2], y=[n, n]) for n in range(36)]
    figure = curves_figure([Pane(title="", curves=curves)], "x", "y")
    looks = [(line.get_color(), line.get_marker()) for line in figure.axes[0].lines]
    assert len(set(looks)) == 36
    assert [(one.get_color(), one.get_marker()) for one in figure.legends[0].legend_handles] == looks


def test_differences_that_are_rounding_are_not_spread_over_a_figure() -> None:
    values = [0.1 + 0.2, 0.3, 0.3 + 2e-12]
    panes = [Pane(title="", curves=[Curve(label="", source="model", look="model", x=[1, 2, 3], y=y)]) for y in (values, values[::-1])]
    figure = curves_figure(panes, "x", "y")
    low, high = figure.axes[0].get_ylim()
    assert (low, high) == pytest.approx((0.285, 0.315))


def test_a_factor_with_the_name_of_another_column_is_called_a_factor() -> None:
    table = Table(name="means", title="Means", frame=pandas().DataFrame({"n_": [5.0], "mean": [0.3], "n": [3]}))
    text = report_page("counting", "", {}, [Section(title="rt", parts=[table])], {})
    assert re.findall(r"<th [^>]*>([^<]*)", text) == ["factor n", "mean", "n"]


def test_code_in_a_caution_is_shown_as_code(tmp_path: Path) -> None:
    path = str(write_experiment(tmp_path, factors='{"n": [2]}', trials=1))
    results = read_results(store_rows(tmp_path / "out", path, count))
    section = what_was_run(replace(results, rows=results.rows.assign(end="done")))
    text = report_page("counting", "", {}, [section], {})
    assert "(<code>done</code>)" in text
    assert "`" not in text


def test_trials_that_all_ended_with_nothing_left_to_do_are_a_caution(tmp_path: Path) -> None:
    path = write_experiment(tmp_path, participants=10, trials=1)
    results = read_results(store_rows(tmp_path / "out", str(path), count))
    text = "All trials ended because no agent had anything left to do (`done`). A moving body alone does not continue a trial"
    all_done = results.rows.assign(end="done")
    assert text in cautions(what_was_run(replace(results, rows=all_done)).parts)
    one_stopped = results.rows.assign(end=["stop", *all_done["end"][1:]])
    assert cautions(what_was_run(replace(results, rows=one_stopped)).parts) == ""


def test_one_participant_is_described_and_not_tested(tmp_path: Path) -> None:
    folder = store_rows(tmp_path / "out", str(write_experiment(tmp_path, participants=1)), count)
    write_report(folder)
    assert "(1 rows)" not in page(folder)
    assert "1 participants" not in page(folder)
    assert "A group has one participant. With fewer than 3 nothing can be said" in page(folder)
    assert {row["low"] for row in table(folder, "means_rt")} == {""}
    assert not list((folder / "report/tables").glob("anova*"))


def test_one_cell_has_no_figure(tmp_path: Path) -> None:
    folder = store_rows(tmp_path / "out", str(write_experiment(tmp_path, factors='{"n": [2]}', participants=4)), count)
    write_report(folder)
    assert not list((folder / "report/figures").iterdir())
    assert "the design has one group and no factor" in page(folder)


def test_two_experiments_are_compared(tmp_path: Path) -> None:
    path = str(write_experiment(tmp_path, participants=1))
    one = store_rows(tmp_path / "one", path, count)
    store_rows(tmp_path / "two", path, lambda trial: {**count(trial), "rt": count(trial)["rt"] + 0.1}, values={"seed": 2})
    assert main(["report", str(one), "--compare", str(tmp_path / "two")]) == 0
    fit = {row["measure"]: row for row in table(one, "fit_to_other")}
    assert float(fit["rt"]["mean_difference"]) == pytest.approx(-0.1, abs=0.002)
    assert "differs from this experiment (“now”) in: seed: 2 there, 1 now." in page(one)
    assert ">two</text>" in (one / "report/figures/measure_rt.svg").read_text(encoding="utf-8")


def paced(folder: Path, factors: str, default: str = "1.0") -> Results:
    """Returns an experiment whose model has a parameter `pace`; the reaction time is n + 10 times the pace, as far as they are numbers."""
    folder.mkdir()
    path = write_experiment(folder, factors=factors, model=COUNTER.replace("n = 3", f"n = 3\npace = {default}"))

    def measures(trial: Any) -> dict[str, Any]:
        n, pace = trial.values.get("n", 3), trial.values.get("pace", 1.0)
        return {"rt": n + 10 * pace if isinstance(pace, float) else n, "luck": 0.5}

    return read_results(store_rows(folder / "rows", str(path), measures))


@pytest.mark.parametrize(
    ("there", "common", "said"),
    [
        ("", [13.0], "Only this experiment varies pace. The means are compared at the level at which rows ran: 1."),
        (', settings={"pace": 2.0}', [23.0], "Only this experiment varies pace. The means are compared at the level at which rows ran: 2."),
        (', settings={"pace": 7.0}', [], "Only this experiment varies pace, and rows ran at another level, 7. The means are not compared."),
        (
            ', settings={"pace": Uniform(low=1, high=3)}',
            [],
            "Only this experiment varies pace, and rows drew it for each participant or trial. The means are not compared.",
        ),
    ],
)
def test_a_factor_that_one_experiment_varies_is_compared_at_the_level_of_the_other(
    tmp_path: Path, there: str, common: list[float], said: str
) -> None:
    one = paced(tmp_path / "one", '{"pace": [1.0, 2.0, 3.0]}')
    two = paced(tmp_path / "two", f'{{"n": [1, 3]}}{there}')
    for results, other in ((one, two), (two, one)):
        beside = means_of_experiment([other], [results])
        parts = comparison_section(results, other, [results], beside).parts
        means = frames(parts)["means_beside_other"].query("measure == 'rt'") if common else pandas().DataFrame({"model": [], "beside": []})
        assert list(means["model"]) == list(means["beside"]) == common
        levels = [f"pace {level}" for level in (1, 2, 3) if 3.0 + 10 * level not in common] if other is one else ["n 1"]
        assert (f"Left out of the means of {other.label} for rt, luck: {'; '.join(levels)}." in parts) == bool(common)
        agreement = frames(parts)["fit_to_other"] if common else pandas().DataFrame({"left_out": []})
        assert list(agreement["left_out"]) == [2 if other is one else 1] * 2 * len(common)
        assert ("have no cell in common" in cautions(parts)) == (not common)
    parts = comparison_section(one, two, [one], means_of_experiment([two], [one])).parts
    assert said in [part.text if isinstance(part, Caution) else part for part in parts]


@pytest.mark.parametrize(("levels", "default"), [('[None, "red"]', "None"), ("[[0, 1], [0, 5]]", "[0, 1]"), ("[True, False]", "True")])
def test_a_default_that_is_no_number_is_a_level_too(tmp_path: Path, levels: str, default: str) -> None:
    one = paced(tmp_path / "one", f'{{"n": [1, 2], "pace": {levels}}}', default)
    for name, given in (("two", ""), ("three", f', settings={{"pace": {default}}}')):
        two = paced(tmp_path / name, f'{{"n": [1, 2]}}{given}', default)
        beside = means_of_experiment([two], [one])
        assert beside is not None
        assert list(fit_to([one], beside)["cells"]) == [2, 2]


def test_an_experiment_in_a_folder_with_the_name_of_a_column_is_compared(tmp_path: Path) -> None:
    def measures(trial: Any) -> dict[str, Any]:
        return {"rt": count(trial)["rt"]}

    path = write_experiment(tmp_path, participants=1)
    path.write_text(path.read_text(encoding="utf-8").replace('"rt", "luck"', '"rt"'), encoding="utf-8")
    one = store_rows(tmp_path / "one", str(path), measures)
    for name in ("model", "group", "measure"):
        write_report(one, compare=store_rows(tmp_path / name, str(path), measures))
        assert {"group", "model", "beside", "measure"} <= table(one, "means_beside_other")[0].keys()
        assert f'<th scope="col" class=number>{name}</th>' in page(one)


def test_angles_of_walkers_that_do_not_reach_the_wall_are_the_greatest_ones_in_both_experiments(tmp_path: Path) -> None:
    def stopping(trial: Any) -> dict[str, Any]:
        return {**walk(trial), "peak_angle_deg": 60.0, **({"wall_angle_deg": None, "outcome": "stopped"} if trial.number % 2 else {})}

    results = read_results(store_rows(tmp_path / "out", "warren_whang_1987", stopping, trials=2, participants=2))
    beside = means_of_experiment(by_number(results), by_number(results))
    assert beside is not None
    frame = frame_of(results, Findings(passings_of(results)))
    assert (frame["angle"] == 60).sum() >= len(frame) / 2
    model = cell_means(frame, "angle", ["group", "condition", "level"])["mean"].tolist()
    assert with_greatest_angles(beside, "aperture").of("wall_angle_deg")["mean"].tolist() == model


def test_critical_ratios_beyond_the_trials_are_in_no_mean(tmp_path: Path) -> None:
    def turning(trial: Any) -> dict[str, Any]:
        first = trial.participant.name == "small 1"
        upright = trial.values["aperture"] > (0.49 if first else 0.44) and (not first or trial.repetition <= 3)
        return {**walk(trial), "wall_angle_deg": 0.0 if upright else 40.0}

    values = {"aperture": [0.35, 0.4, 0.45, 0.5], "condition": ["normal"]}
    folder = store_rows(tmp_path / "out", "warren_whang_1987", turning, trials=10, participants=3, values=values)
    parts = parts_on_apertures(folder)
    of_groups, of_all = frames(parts)["critical_ratios_of_groups"], frames(parts)["critical_ratios"]
    assert list(zip(of_groups["group"], of_groups["n"], strict=True)) == [("small", 2), ("large", 3)]
    assert list(of_all["participant"][of_all["beyond"] == "yes"]) == ["small 1"]
    assert "1 of 6 values are most likely beyond the ratios of the trials" in cautions(parts)


def test_a_trial_is_turned_by_the_same_angle_in_the_constraints_and_for_each_participant(tmp_path: Path) -> None:
    """A walker that sways by 3 degrees and turns by 7 or more is turned in these trials, whatever its sway is."""

    def swaying(trial: Any) -> dict[str, Any]:
        return {**walk(trial), "wall_angle_deg": 3.0 if trial.values["aperture"] > 0.52 else 7.0 + trial.repetition}

    folder = store_rows(tmp_path / "out", "warren_whang_1987", swaying, trials=6, participants=3, values={"condition": ["normal"]})
    found = frames(parts_on_apertures(folder))
    (critical,) = (one for one in Findings(passings_of(read_results(folder))).all() if one.number == 4)
    for group, mean in zip(found["critical_ratios_of_groups"]["group"], found["critical_ratios_of_groups"]["mean"], strict=True):
        of_cell = float(re.findall(rf"{group} normal ([0-9.]+)", critical.found)[0])
        assert mean == pytest.approx(of_cell, abs=0.01)


def test_experiments_are_compared_in_what_determines_their_rows(tmp_path: Path) -> None:
    (tmp_path / "elsewhere").mkdir()
    path, same = (str(write_experiment(folder, participants=1)) for folder in (tmp_path, tmp_path / "elsewhere"))
    one = store_rows(tmp_path / "one", path, count)

    def compared(name: str, design: str, **options: Any) -> str:
        results, other = read_results(one), read_results(store_rows(tmp_path / name, design, count, **options))
        parts = by_number(results)
        text = comparison_section(results, other, parts, means_of_experiment(by_number(other), parts)).parts[0]
        return re.findall(rf"{name} \(“there”: counting, \d+ trials\) differs from this experiment \(“now”\) in: (.*)\.", str(text))[0]

    assert compared("same", same) == "nothing that was set"
    more = "--participants: {'all': 4} there, {'all': 1} now; --trials: 5 there, 4 now"
    assert compared("more", same, participants=4, trials=5) == more
    write_report(one, compare=tmp_path / "more")
    assert f"differs from this experiment (“now”) in: {html.escape(more)}.</p>" in page(one)
    Path(same).with_name("counter.py").write_text(f"{COUNTER}\n", encoding="utf-8")
    says = r"the model differs from line 37 on \(.*/counter\.py\); n: \[1\] there, \[1, 2, 5\] now"
    assert re.fullmatch(says, compared("other", same, values={"n": 1}))


def test_the_table_of_trials_can_be_the_data_of_people(tmp_path: Path) -> None:
    """With switches, texts, columns of the library's own, and a factor whose name reports change."""
    factors = '{"n": [1, 2, 5], "mode": ["count", None]}'
    path = write_experiment(tmp_path, factors=factors, participants=1)
    path.write_text(path.read_text(encoding="utf-8").replace('"luck"', '"luck", "right", "word"'), encoding="utf-8")
    folder = store_rows(
        tmp_path / "out", str(path), lambda trial: {**count(trial), "right": trial.number % 3 > 0, "word": f"{trial.number % 2}"}
    )
    with Store(folder) as store:
        export(store)
    shutil.copy(folder / "trials.csv", tmp_path / "people.csv")
    assert main(["report", str(folder), "--human", str(tmp_path / "people.csv")]) == 0
    fit = {row["measure"]: row for row in table(folder, "fit_to_people")}
    assert {name: (row["cells"], round(float(row["rmse"]), 9)) for name, row in fit.items()} == dict.fromkeys(
        ("rt", "luck", "right"), ("6", 0.0)
    )
    target = load_target(str(tmp_path / "people.csv"), specify(str(path)), "right")
    assert "Columns that are not used: trial, position, repetition, seed, " in page(folder)
    assert len(target) == 6
    assert {tuple(one.conditions) for one in target} == {("group", "n", "mode")}


@pytest.mark.parametrize("levels", ['[["a", "b"], ["c"]]', '[1.0, "fast"]', "[0.123456789, True, 2]"])
def test_levels_of_several_types_are_the_same_texts_in_both_tables_and_in_data_of_people(tmp_path: Path, levels: str) -> None:
    path = write_experiment(tmp_path, model=f"word = None\n{COUNTER}", factors=f'{{"word": {levels}}}', participants=1)
    folder = store_rows(tmp_path / "out", str(path), lambda trial: {"rt": 0.1 * trial.position, "luck": 0.5})
    with Store(folder) as store:
        export(store)
    with (folder / "trials.csv").open(encoding="utf-8") as file:
        texts = [row["word"] for row in csv.DictReader(file)]
    assert pandas().read_parquet(folder / "trials.parquet")["word"].to_list() == texts
    found = load_target(str(folder / "trials.csv"), specify(str(path)), "rt")
    levels_of_design = specify(str(path)).design.factors["word"]
    assert [plain_text(one.conditions["word"]) for one in found] == [plain_text(level) for level in levels_of_design]


@pytest.mark.parametrize("factors", ['{"sd": ["a", "b"], "n": [1, 2, 5]}', '{"sd": ["a", "b"], "n": [1, 2, 5], "mode": ["x", "y"]}'])
def test_names_that_reports_change_are_shown_in_figures_as_the_design_has_them(tmp_path: Path, factors: str) -> None:
    model = COUNTER.replace("n = 3", "n = 3\nsd = 'a'")
    results = read_results(store_rows(tmp_path / "out", str(write_experiment(tmp_path, factors=factors, model=model)), count))
    figure, _ = general.figure_of(results, "rt", [])
    labels = [line.get_label() for line in figure.legends[0].get_lines()]
    assert labels == ["sd a", "sd b"]
    grouped = replace(results, design=replace(results.design, groups={**results.design.groups, "old": results.design.groups["all"]}))
    titles = [axes.get_title(loc="left") for axes in general.figure_of(grouped, "rt", [])[0].axes]
    assert titles == (["sd a", "sd b"] if "mode" not in factors else [f"sd {sd}, mode {mode}" for sd in "ab" for mode in "xy"])


def test_a_figure_with_one_place_on_x_has_a_tick_there_alone() -> None:
    def ticks(x: list[float]) -> list[str]:
        pane = Pane(title="", curves=[Curve(label=label, source="model", look="model", x=x, y=[1.0 for _ in x]) for label in "ab"])
        figure = curves_figure([pane], "x", "y")
        figure.draw_without_rendering()
        return [tick.get_text() for tick in figure.axes[0].get_xticklabels()]

    assert ticks([0.45]) == ["0.45"]
    assert len(ticks([0.45, 0.5])) > 1
    assert ticks([]) != []


def test_dollar_signs_in_names_are_drawn_as_they_are() -> None:
    curve = Curve(label=r"$\frac{$", source="model", look="model", x=[1, 2], y=[1, 2])
    drawn = svg(curves_figure([Pane(title="costs $5 or $6", curves=[curve])], "x", "y"))
    assert "costs $5 or $6" in drawn
    assert r"$\frac{$" in drawn


def test_trials_are_counted_by_the_texts_of_a_measure(tmp_path: Path) -> None:
    def mixed(trial: Trial) -> dict[str, Any]:
        return {"rt": [1, True, "a"][trial.number % 3], "luck": 0.5}

    results = read_results(store_rows(tmp_path / "out", str(write_experiment(tmp_path, participants=1)), mixed))
    assert results.rows["rt"].value_counts().to_dict() == {"1": 4, "True": 4, "a": 4}


def test_long_texts_are_shortened_in_figures() -> None:
    label, tick, title = ("x" * 4000, "y" * 4000, "z" * 4000)
    curves = [Curve(label=label + end, source="model", look="model", x=[0, 1], y=[0, 1]) for end in "ab"]  # they differ at the end
    figure = curves_figure([Pane(title=title, curves=curves)], "x", "y", ticks=[(0, tick), (1, "short")])
    drawn = svg(figure)
    assert [drawn.count(f">{'x' * 40}...{'x' * 19}{end}<") for end in "ab"] == [1, 1]
    assert [drawn.count(f">{letter * 40}...{letter * 20}<") for letter in "yz"] == [1, 1]
    assert ">short<" in drawn
    assert len(png(figure)) > 1000


def test_shares_of_the_texts_of_a_measure_are_shown_by_the_first_factor(tmp_path: Path) -> None:
    def answer(trial: Trial) -> dict[str, Any]:
        text = None if trial.repetition == 4 else "yes" if trial.repetition <= trial.values["n"] else "no"
        return dict.fromkeys(("rt", "trials", "mean"), text)  # also with the names of columns of tables

    design = write_experiment(tmp_path, factors='{"n": [1, 2, 3]}', participants=3, trials=4)
    results = read_results(store_rows(tmp_path / "out", str(design), answer))
    (everything, *_) = measure_sections(by_number(results), [])
    tables = frames(everything.parts)
    rows = tables["shares_rt"].to_dict("records")
    assert [(row["n_"], row["rt"], row["mean"], row["n"], row["trials"]) for row in rows] == [
        (n, text, share, 3, 12) for n in (1, 2, 3) for text, share in (("no", (3 - n) / 4), ("none", 0.25), ("yes", n / 4))
    ]
    assert tables["counts_trials"].to_dict("records")[0] == {"trials_": "no", "trials": 9}
    assert tables["shares_mean"]["mean_"].to_list() == ["no", "none", "yes"] * 3
    plots = [part for part in everything.parts if isinstance(part, Plot)]
    for plot, name in zip(plots, ("rt", "trials", "mean"), strict=True):
        assert [line.get_label() for line in plot.figure.legends[0].get_lines()] == [f"{name} no", f"{name} none", f"{name} yes"]
    report = write_report(tmp_path / "out").parent
    assert (report / "tables" / "shares_rt.csv").exists()
    assert (report / "figures" / "shares_rt.png").exists()


def test_a_walker_that_has_not_judged_neither_passes_nor_does_not(tmp_path: Path) -> None:
    def judge(trial: Trial) -> dict[str, Any]:
        if trial.repetition == 1 or trial.columns["participant"] == "small 1":
            return {"judged": None, "passable": None, "time_s": 5.0}
        passable = trial.values["ratio"] > 1.2
        return {"judged": "as it is" if passable else "turned", "passable": passable, "time_s": 5.0}

    folder = store_rows(tmp_path / "out", "passability_judgement", judge, trials=2, participants=3)
    sections = judging_apertures(read_results(folder), [])
    tables = frames([part for section in sections for part in section.parts])
    boundaries = tables["boundaries"]["boundary"].to_list()
    assert [math.isnan(one) for one in boundaries] == [True, False, False, False, False, False]
    assert boundaries[1:] == pytest.approx([1.2] * 5, abs=0.02)
    (ninth,) = (row for row in tables["constraints"].to_dict("records") if row["number"] == "9")
    assert "from 1.200 (" in ninth["found"]


def test_a_parameter_that_only_a_later_group_has_is_no_measure(tmp_path: Path) -> None:
    path = write_experiment(tmp_path, factors='{"mode": ["count", "shout"]}')
    text = path.read_text(encoding="utf-8").replace(
        'measures=["rt", "luck"]', "measures=['rt'], derive=lambda v: {'n': v['age']} if v.get('age') else {}"
    )
    groups = '"young": Group(participants=2), "old": Group(participants=2, parameters={"age": Uniform(low=3, high=5)})'
    path.write_text(text.replace('"all": Group(participants=2)', groups), encoding="utf-8")
    folder = store_rows(tmp_path / "out", str(path), lambda trial: {"rt": 0.1 * trial.values.get("n", 3)})
    assert read_results(folder).measures == ["rt"]
    with Store(folder) as store:
        export(store)
    assert {one.measure for one in load_target(str(folder / "trials.csv"), specify(str(path)), "rt")} == {"rt"}


def test_what_has_no_report_says_why(tmp_path: Path, capsys: Any) -> None:
    path = write_experiment(tmp_path, participants=1)
    empty = tmp_path / "empty"
    Store.create(empty, specify(str(path)).specification).close()
    assert main(["report", str(empty)]) == 1
    assert f"error: '{empty}': no trial has finished yet" in capsys.readouterr().err
    failed = store_rows(tmp_path / "failed", str(path), lambda _: {"error": "ValueError: never"})
    assert main(["report", str(failed)]) == 1
    assert "every finished trial failed (12); the first one with: ValueError: never" in capsys.readouterr().err
    error = "Traceback (most recent call last):\nValueError: never\nhint: the model had asked its memory"
    noted = store_rows(tmp_path / "noted", str(path), lambda _: {"error": error})
    assert main(["report", str(noted)]) == 1
    assert "the first one with: ValueError: never\n" in capsys.readouterr().err
    assert main(["report", str(tmp_path)]) == 1
    assert "holds no experiment" in capsys.readouterr().err
    counted = store_rows(tmp_path / "counted", str(path), count)
    for command in (["report", str(counted), "--human"], ["fit", str(path), "--parameter", "n=1..3", "--target"]):
        assert main([*command, str(empty)]) == 1
        assert f"{empty}: cannot be read as human data (it is a folder; name a file)" in capsys.readouterr().err


def test_reports_that_are_written_at_once_do_not_disturb_one_another(tmp_path: Path) -> None:
    folder = store_rows(tmp_path / "out", one_cell(tmp_path), count)
    with ProcessPoolExecutor(3, get_context("fork")) as pool:
        assert set(pool.map(write_report, [folder] * 4)) == {folder / "report" / "index.html"}
    assert {path.name for path in (folder / "report").iterdir()} == {"figures", "index.html", "tables"}
    assert [path.name for path in folder.iterdir() if "report" in path.name] == ["report"]


def test_a_folder_that_is_no_report_is_not_replaced(tmp_path: Path) -> None:
    folder = store_rows(tmp_path / "out", str(write_experiment(tmp_path, participants=1)), count)
    (folder / "report").mkdir()
    (folder / "report" / "thesis.tex").write_text("years of work")
    with pytest.raises(ExperimentError, match=r"holds 'thesis\.tex', which a new report would replace; move it away"):
        write_report(folder)
    assert (folder / "report" / "thesis.tex").exists()
    (folder / "report" / "thesis.tex").unlink()
    (folder / "report" / "index.html").write_text("<title>my own page</title>")
    for place, says in (("report", "is not a report"), (".", "holds '"), ("trials.sqlite", "is a file")):
        with pytest.raises(ExperimentError, match=says):
            write_report(folder, out=folder / place)
    assert (folder / "report" / "index.html").read_text() == "<title>my own page</title>"


def test_a_report_replaces_an_earlier_one_and_no_file_of_a_user(tmp_path: Path) -> None:
    folder = store_rows(tmp_path / "out", one_cell(tmp_path), count)
    (tmp_path / "place").mkdir()
    (tmp_path / "link").symlink_to(tmp_path / "place")
    for _ in range(2):
        assert write_report(folder, out=tmp_path / "link") == tmp_path / "link" / "index.html"
    assert (tmp_path / "link").is_symlink()
    assert (tmp_path / "place" / "index.html").exists()
    mine = tmp_path / "place" / "figures" / "mine" / "notes.svg"
    mine.parent.mkdir()
    mine.touch()
    with pytest.raises(ExperimentError, match=r"'.*/place' holds 'figures/mine', which a new report would replace"):
        write_report(folder, out=tmp_path / "place")
    assert mine.exists()


@pytest.mark.daily(1)
@pytest.mark.parametrize("inner", [".", "figures"])
def test_the_folder_in_which_the_shell_is_is_not_replaced(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, inner: str) -> None:
    folder = store_rows(tmp_path / "out", one_cell(tmp_path), count)
    place = write_report(folder, out=tmp_path / "place").parent
    before = place.stat().st_ino
    monkeypatch.chdir(place / inner)
    with pytest.raises(ExperimentError, match=r"'.*/place': a new report would replace the folder in which you are; leave it, or name"):
        write_report(folder, out=place)
    assert place.stat().st_ino == before
    monkeypatch.chdir(tmp_path)
    write_report(folder, out="place")


def test_the_report_of_an_experiment_that_cannot_be_written_goes_elsewhere(capsys: Any) -> None:
    with tempfile.TemporaryDirectory() as place:  # pytest's own folders are closed to others
        outer = Path(place)
        outer.chmod(0o755)
        folder = store_rows(outer / "out", one_cell(outer), count)
        other = outer / "others"
        other.mkdir()
        other.chmod(0o777)
        main(["experiment", str(folder), "--resume"])  # imports the libraries, which not everybody may be able to read
        write_report(folder, out=outer / "first")
        capsys.readouterr()
        with not_writable(folder):
            assert main(["experiment", str(folder), "--resume"]) == 0  # nothing is left to run
            assert f"in '{folder}', 4 finished\n" in capsys.readouterr().out
            assert main(["report", str(folder)]) == 1
            error = capsys.readouterr().err
            assert f"error: '{folder}/report': cannot write the report (Permission denied); name another folder with --out\n" == error
            assert main(["report", str(folder), "--out", f"{folder}/mine"]) == 1
            assert capsys.readouterr().err == f"error: '{folder}/mine': cannot write the report (Permission denied)\n"
            for _ in range(2):  # the second one replaces the first
                assert main(["report", str(folder), "--out", str(other / "new" / "mine")]) == 0
                assert capsys.readouterr().out == f"{other}/new/mine/index.html\n"
        assert {path.name for path in (other / "new" / "mine").iterdir()} == {"figures", "index.html", "tables"}
        assert [path.name for path in (other / "new").iterdir()] == ["mine"]


def test_a_design_can_add_sections_of_its_own(tmp_path: Path) -> None:
    path = write_experiment(tmp_path, participants=1)
    own = """
from actr3d.experiment.report import Section, analysis


@analysis("rt", "n_")
def speed(results, others):
    return [Section(title="Speed of counting", parts=[f"{len(results.rows)} trials."])]
"""
    path.write_text(path.read_text(encoding="utf-8") + own, encoding="utf-8")
    before = dict(ANALYSES)
    try:
        folder = store_rows(tmp_path / "out", str(path), count)
        write_report(folder)
        assert "Speed of counting" in page(folder)
        assert "12 trials." in page(folder)
    finally:
        ANALYSES.clear()
        ANALYSES.update(before)


def test_an_error_in_the_shares_of_a_measure_ends_nothing_else(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    def cell_means(rows: Any, measure: str, by: Any) -> Any:
        return 1 / 0 if measure == "rt" else statistics.cell_means(rows, measure, by)

    def answer(trial: Trial) -> dict[str, Any]:
        return dict.fromkeys(("rt", "luck"), "yes" if trial.repetition % 2 else "no")

    monkeypatch.setattr(general, "cell_means", cell_means)
    folder = store_rows(tmp_path / "out", str(write_experiment(tmp_path, participants=3)), answer)
    with pytest.raises(
        ExperimentError, match=r"not complete: measure 'rt': ZeroDivisionError: division by zero \(test_report\.py, line \d+\)"
    ):
        write_report(folder)
    assert "Not all of this section could be made: measure 'rt': ZeroDivisionError" in html.unescape(page(folder))
    assert {path.stem for path in (folder / "report" / "tables").iterdir()} >= {"counts_rt", "counts_luck", "shares_luck"}


def test_an_error_in_an_analysis_ends_its_own_sections_and_is_named(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = write_experiment(tmp_path, participants=1)
    own = """
from actr3d.experiment.report import analysis


@analysis("rt")
def speed_of_counting(results, others):
    return results.rows["tr"]
"""
    path.write_text(path.read_text(encoding="utf-8") + own, encoding="utf-8")
    before = dict(ANALYSES)
    try:
        folder = store_rows(tmp_path / "out", str(path), count)
        assert main(["report", str(folder)]) == 1
    finally:
        ANALYSES.clear()
        ANALYSES.update(before)
    line = path.read_text(encoding="utf-8").splitlines().index('    return results.rows["tr"]') + 1
    named = rf"analysis 'speed_of_counting': KeyError: 'tr' \({re.escape(path.name)}, line {line}\)"
    assert re.search(rf"is written, but some of its sections are not complete: {named}", capsys.readouterr().err)
    text = html.unescape(page(folder))
    assert "Speed of counting" in text
    assert re.search(rf"Not all of this section could be made: {named}\.", text)
    assert table(folder, "means_rt")


def test_levels_that_are_texts_switches_or_none_are_kept_apart(tmp_path: Path) -> None:
    path = write_experiment(tmp_path, factors='{"mode": ["count", None, True], "n": [1, 2]}', participants=3)
    parts = by_number(read_results(store_rows(tmp_path / "out", str(path), count)))
    means = frames([part for section in measure_sections(parts, []) for part in section.parts])["means_rt"]
    assert list(dict.fromkeys(means["mode"])) == ["count", "none", "True"]


def test_an_experiment_that_was_run_has_a_report(tmp_path: Path, capsys: Any) -> None:
    path, folder = write_experiment(tmp_path, participants=1, trials=2), tmp_path / "run"
    assert main(["experiment", str(path), "--out", str(folder), "--workers", "1"]) == 0
    assert main(["report", str(folder)]) == 0
    assert capsys.readouterr().out.splitlines()[-1] == str(folder / "report" / "index.html")
    assert [(row["n_"], row["n"]) for row in table(folder, "means_rt")] == [("1", "1"), ("2", "1"), ("5", "1")]


def test_two_participants_are_described_and_not_tested(tmp_path: Path) -> None:
    folder = store_rows(tmp_path / "walks", "warren_whang_1987", walk, trials=1, participants=2)
    said = cautions(what_was_run(read_results(folder)).parts)
    assert "nothing is tested, and intervals over two participants are no more than their range" in said
    found = frames(parts_on_apertures(folder))
    results = dict(zip(found["constraints"]["number"], found["constraints"]["result"], strict=True))
    assert (results["3"], results["5"]) == ("not decided", "not decided")
    assert "equivalence" not in found


def test_the_original_is_named_only_beside_its_means(walked: Path, tmp_path: Path) -> None:
    logged = "The original's angle is the one it logged"
    assert logged in html.unescape(page(walked))
    assert "original" in table(walked, "rotation")[0]
    parts = parts_on_apertures(store_rows(tmp_path / "ratios", "wilmut_ratios", walk, trials=1))
    assert "original" not in frames(parts)["rotation"]
    assert not [part.note for part in parts if isinstance(part, Table) and logged in part.note]


@pytest.mark.slow
def test_each_critical_ratio_is_drawn_above_its_own_participant(tmp_path: Path) -> None:
    """That of the first is not known, as it never turns; one of a single step of apertures is not known either."""

    def first_never(trial: Any) -> dict[str, Any]:
        return {**walk(trial), "wall_angle_deg": 0.0} if trial.participant.name == "small 1" else walk(trial)

    folder = store_rows(tmp_path / "walks", "warren_whang_1987", first_never, trials=1, participants=3)
    parts = parts_on_apertures(folder)
    (figure,) = [part.figure for part in parts if isinstance(part, Plot) and part.name == "critical_ratio"]
    labels = [label for label in re.findall(r"<text [^>]*>([^<]+)</text>", svg(figure)) if label in ("1", "2", "3")]
    assert labels == ["1", "2", "3", "1", "2", "3"] * 2
    assert "2 of 12 curves have no critical ratio" in cautions(parts)
    folder = store_rows(tmp_path / "two", "warren_whang_1987", walk, trials=1, participants=3, values={"aperture": [0.5, 0.7]})
    parts = parts_on_apertures(folder)
    assert frames(parts)["critical_ratios"]["critical_ratio"].isna().all()
    assert "12 of 12 curves have no critical ratio: all of their trials are turned, or none is, or there are too few" in cautions(parts)


@pytest.mark.slow
def test_starts_beside_the_doorway_or_at_an_angle_have_a_figure_and_a_table(tmp_path: Path) -> None:
    def misaligned(trial: Any) -> dict[str, Any]:
        if trial.values["start_aside"] < 0.2:
            return walk_through(trial)
        return {**walk_through(trial), "outcome": "stopped", "clearance_left_m": None, "clearance_right_m": None}

    folder = store_rows(tmp_path / "starts", "misaligned_start", misaligned, trials=2)
    write_report(folder)
    assert (folder / "report" / "figures" / "starts.png").stat().st_size > 10_000
    rows = table(folder, "starts")
    assert len(rows) == 24
    assert {float(row["passed"]) for row in rows if float(row["start_aside"]) < 0.2} == {1.0}
    assert {float(row["passed"]) for row in rows if float(row["start_aside"]) > 0.2} == {0.0}
    assert {row["right"] for row in rows if float(row["start_aside"]) > 0.2} == {""}, "it was not in the doorway"
    assert all(6.7 < float(row["right"]) < 7.1 for row in rows if float(row["start_aside"]) < 0.2)
    assert "Starts beside the doorway or at an angle" in page(folder)
    assert "Human mean angles for each aperture were not found as numbers" in page(folder)
