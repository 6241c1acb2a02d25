"""Human data: what follows the schema is read, and what does not is named by file, line and column."""

from __future__ import annotations

import os
import re
import threading
import time
from dataclasses import replace
from pathlib import Path

import pytest

from actr3d.errors import ExperimentError
from actr3d.experiment import human_data
from actr3d.experiment.design import RESERVED
from actr3d.experiment.human_data import SHOWN, HumanFile, Schema, library_human_data
from actr3d.experiment.specification import library_designs, specify
from actr3d.experiment.target import load_target
from actr3d.parameter_schema import Parameter

SCHEMA = Schema(
    groups=["small", "large"],
    factors={"aperture": [0.4, 0.5], "condition": ["normal", "fast"]},
    measures=["wall_angle_deg", "speed_m_s", "turned"],
    switches=["turned"],
    ignored=["trial", "seed", "error"],
)


def read(folder: Path, text: str, schema: Schema = SCHEMA):
    path = folder / "people.csv"
    path.write_text(text, encoding="utf-8")
    return HumanFile(path).read(schema)


def test_trials_are_read(tmp_path: Path) -> None:
    data = read(tmp_path, "# by hand\nparticipant,group,aperture,condition,wall_angle_deg\n1,small,0.4,fast,50.5\n1,small,0.45,normal,\n")
    assert (data.published, data.measures, data.notes) == (False, ["wall_angle_deg"], ["by hand"])
    assert data.rows[0] == {"participant": "1", "group": "small", "aperture": 0.4, "condition": "fast", "wall_angle_deg": 50.5}
    assert data.rows[1]["wall_angle_deg"] is None, "an empty cell is a missing value"
    assert data.rows[1]["aperture"] == 0.45, "people may have been at other apertures than the model"


def test_tables_of_trials_are_read_as_those_of_people(tmp_path: Path) -> None:
    """The library writes switches as True and False, and None as an empty cell."""
    schema = replace(SCHEMA, factors={"aperture": [0.4, 0.5], "load": ["none", "bag"]})
    head = "trial,participant,group,aperture,load,seed,turned,error\n"
    data = read(tmp_path, head + "0,small 1,small,0.4,,1 small,True,\n1,small 1,small,0.5,bag,1 small,False,\n", schema)
    assert [(row["aperture"], row["load"], row["turned"]) for row in data.rows] == [(0.4, "none", 1.0), (0.5, "bag", 0.0)]
    assert data.measures == ["turned"]
    assert "seed" not in data.rows[0]


def test_a_factor_that_is_empty_everywhere_is_averaged_over(tmp_path: Path) -> None:
    data = read(tmp_path, "participant,group,aperture,wall_angle_deg\n1,small,,50\n2,small,,51\n# by hand\n")
    assert [row["aperture"] for row in data.rows] == [None, None]
    assert data.notes == ["by hand"]


def test_levels_of_people_are_within_the_bounds_of_the_parameter(tmp_path: Path) -> None:
    aperture = Parameter(name="aperture", takes="number", least=0.3, most=2, unit="m")
    schema = replace(SCHEMA, parameters={"aperture": aperture})
    assert len(read(tmp_path, HEAD + "1,small,0.45,fast,50\n", schema).rows) == 1
    says = r"people.csv:2: column 'aperture': the model's parameter aperture: must be <= 2 \(got 45\) \[m\]"
    with pytest.raises(ExperimentError, match=says):
        read(tmp_path, HEAD + "1,small,45,fast,50\n", schema)


def test_published_means_are_read_and_may_be_means_over_all_levels(tmp_path: Path) -> None:
    text = 'group,aperture,measure,mean,sd,n,source\nlarge,,speed_m_s,1.28,,5,"W & W (1987), p. 3"\n,0.4,wall_angle_deg,60,3.5,,X\n'
    data = read(tmp_path, text)
    assert data.published
    assert data.sources == ["W & W (1987), p. 3", "X"]
    assert (data.rows[0]["aperture"], data.rows[0]["condition"], data.rows[0]["sd"], data.rows[0]["n"]) == (None, None, None, 5.0)
    assert (data.rows[1]["group"], data.rows[1]["sd"]) == (None, 3.5)


@pytest.mark.parametrize("name", ["mean", "measure"])
def test_trials_may_have_a_measure_whose_name_published_means_have_too(name: str, tmp_path: Path) -> None:
    schema = replace(SCHEMA, measures=("wall_angle_deg", name))
    data = read(tmp_path, f"participant,group,aperture,{name}\n1,small,0.4,50\n", schema)
    assert not data.published
    assert (data.measures, data.rows[0][name]) == ([name], 50)
    assert read(tmp_path, MEANS + f"small,0.4,{name},5,1,5,X\n", schema).published


def test_names_with_spaces_around_them_are_found(tmp_path: Path) -> None:
    schema = replace(SCHEMA, groups=("small", " large"), factors={"condition": ["normal", "fast "]})
    data = read(tmp_path, "participant,group,condition,wall_angle_deg\n1, large,fast ,50\n", schema)
    assert [(row["group"], row["condition"]) for row in data.rows] == [(" large", "fast ")]


HEAD = "participant,group,aperture,condition,wall_angle_deg\n"
MEANS = "group,aperture,measure,mean,sd,n,source\n"
BAD = {
    "empty": ("", r"people.csv: is empty; the first line must name the columns"),
    "no row": (HEAD, r"people.csv:1: no row follows"),
    "unknown column": (
        "participant,group,apperture,wall_angle_deg\n",
        r"people.csv:1: unknown column 'apperture'; did you mean 'aperture'\?",
    ),
    "twice": ("participant,group,group,wall_angle_deg\n", r"people.csv:1: column 'group' is there twice"),
    "no participant": ("group,aperture,wall_angle_deg\n", r"people.csv:1: column 'participant' is missing; trials need"),
    "no measure": (
        "participant,group,aperture\n",
        r"people.csv:1: no column is a measure; there may be: wall_angle_deg, speed_m_s, turned",
    ),
    "no source": ("group,measure,mean\n", r"people.csv:1: column 'source' is missing; published means need"),
    "text for a number": (HEAD + "1,small,0.4,fast,fifty\n", r"people.csv:2: column 'wall_angle_deg': must be a number \(got 'fifty'\)"),
    "comma": (HEAD + '1,small,0.4,fast,"50,5"\n', r"must be a number; write the decimal point as '.' \(got '50,5'\)"),
    "not finite": (HEAD + "1,small,0.4,fast,nan\n", r"people.csv:2: column 'wall_angle_deg': must be a number \(got 'nan'\)"),
    "wrong group": (
        HEAD + "1,smal,0.4,fast,50\n",
        r"people.csv:2: column 'group': must be one of: small, large .*; did you mean 'small'\?",
    ),
    "no group": (HEAD + "1,,0.4,fast,50\n", r"people.csv:2: column 'group': must be one of: small, large \(got ''\)"),
    "wrong level": (HEAD + "1,small,0.4,slow,50\n", r"people.csv:2: column 'condition': must be one of: normal, fast \(got 'slow'\)"),
    "few cells": (HEAD + "1,small,0.4\n", r"people.csv:2: must have 5 cells, as the first line has \(got 3\)"),
    "negative sd": (MEANS + "small,0.4,wall_angle_deg,5,-1,5,X\n", r"people.csv:2: column 'sd': must be a number from 0 on \(got '-1'\)"),
    "part of a person": (MEANS + "small,0.4,wall_angle_deg,5,1,2.5,X\n", r"column 'n': must be a whole number from 1 on \(got '2.5'\)"),
    "no mean": (MEANS + "small,0.4,wall_angle_deg,,1,5,X\n", r"people.csv:2: column 'mean': must be a number \(got ''\)"),
    "unknown measure": (
        MEANS + "small,0.4,angle,5,1,5,X\n",
        r"column 'measure': must be one of: wall_angle_deg, speed_m_s, turned \(got 'angle'\)",
    ),
    "two means": (
        MEANS + "small,0.4,wall_angle_deg,5,1,5,X\nsmall,0.5,wall_angle_deg,5,1,5,X\nsmall,0.4,wall_angle_deg,7,1,5,Y\n",
        r"people.csv:4: is a second mean of 'wall_angle_deg' for the conditions of line 2",
    ),
    "no level": (
        HEAD + "1,small,0.4,fast,50\n2,small,,fast,50\n",
        r"people.csv:3: column 'aperture': must be given, as in other rows; without the column, .* \(got ''\)",
    ),
    "person as a note": (
        HEAD + "#1,small,0.4,fast,50\n2,small,0.4,fast,50\n",
        r"people.csv:2: begins with '#', as a note does: rename '#1', or write notes above the first line",
    ),
    "no value": (HEAD + "1,small,0.4,fast,\n2,small,0.5,fast,\n", r"people.csv: no row has a value of a measure: wall_angle_deg"),
    "huge": (HEAD + "1,small,0.4,fast,1e308\n", r"people.csv:2: .* must be a number from -1e\+100 to 1e\+100 \(got '1e308'\)"),
    "many digits": (
        HEAD + f"1,small,0.4,fast,{'9' * 5000}\n",
        r"people.csv:2: .* must be a number from -1e\+100 to 1e\+100 \(got '9{50,100}\.\.\.'\)$",
    ),
    "quote in the last line": (
        HEAD + '"1,small,0.4,fast,50\n',
        r"people.csv:2: must have 5 cells, .*; a quote that begins in it may not be closed",
    ),
    "proportion": (
        MEANS + "small,0.4,turned,1.7,,,X\n",
        r"people.csv:2: column 'mean': must be a number from 0 to 1 \(got '1.7'\)",
    ),
    "switch": ("participant,group,turned\n1,small,2\n", r"people.csv:2: column 'turned': must be a number from 0 to 1 \(got '2'\)"),
    "tabs": ("participant\tgroup\n", r"people.csv:1: the columns must be separated by commas \(got 'participant\\tgroup'\)"),
    "semicolons": ("participant;group\n", r"people.csv:1: the columns must be separated by commas \(got 'participant;group'\)"),
    "where it is from": (MEANS + "small,0.4,wall_angle_deg,5,1,5,\n", r"people.csv:2: column 'source': must be given \(got ''\)"),
}


@pytest.mark.parametrize("what", BAD)
def test_what_is_wrong_is_named_with_its_place(what: str, tmp_path: Path) -> None:
    text, says = BAD[what]
    with pytest.raises(ExperimentError, match=says):
        read(tmp_path, text)


def test_all_errors_are_named_at_once_but_not_without_end(tmp_path: Path) -> None:
    with pytest.raises(ExperimentError) as raised:
        read(tmp_path, HEAD + "1,small,x,fast,50\n" * 2 + "1,small,0.4,fast,50\n" + "1,small,y,fast,50\n" * 40)
    lines = str(raised.value).splitlines()
    assert [re.sub(r".*csv:(\d+):.*", r"\1", line) for line in lines[:4]] == ["2", "3", "5", "6"]
    assert len(lines) == SHOWN + 1
    assert lines[-1] == "... and 22 more errors"


def test_a_pipe_is_read_and_one_to_which_nobody_writes_is_refused(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    pipe = tmp_path / "people.csv"
    os.mkfifo(pipe)
    text = HEAD + "1,small,0.4,fast,50\n" * 5000

    def write() -> None:
        with pipe.open("w") as file:  # waits for the reader
            time.sleep(0.3)
            file.write(text)

    writer = threading.Thread(target=write, daemon=True)
    writer.start()
    try:
        assert len(HumanFile(pipe).read(SCHEMA).rows) == 5000
    finally:
        writer.join(10)
    reading, writing = os.pipe()  # as a shell passes one for `<(...)`
    with os.fdopen(reading), os.fdopen(writing, "w") as end:
        end.write(HEAD + "1,small,0.4,fast,50\n")
        end.close()
        assert len(HumanFile(f"/dev/fd/{reading}").read(SCHEMA).rows) == 1
    monkeypatch.setattr(human_data, "PATIENCE", 0.1)
    late = r"people.csv: cannot be read as human data \(it is a pipe, and nothing was written to it within 0\.1 s\)"
    with pytest.raises(ExperimentError, match=late):
        HumanFile(pipe)


def test_a_file_that_is_no_text_is_refused(tmp_path: Path) -> None:
    (tmp_path / "people.csv").write_bytes(b"\xff\xfe\x00")
    with pytest.raises(ExperimentError, match="it is not UTF-8"):
        HumanFile(tmp_path / "people.csv").read(SCHEMA)
    with pytest.raises(ExperimentError, match=r"/dev/zero: cannot be read as human data \(it has more than 268,435,456 bytes\)"):
        HumanFile("/dev/zero").read(SCHEMA)
    (tmp_path / "people.csv").write_text(f'participant\n"{"x" * 200_000}', encoding="utf-8")
    with pytest.raises(ExperimentError, match=r"people\.csv:2: is not CSV \(field larger than field limit"):
        load_target(str(tmp_path / "people.csv"), specify("fan_effect"))
    with pytest.raises(ExperimentError, match=r"csv:3: must have 5 cells, .* \(got 1\); a quote that begins in it may not"):
        read(tmp_path, f'{HEAD}1,small,0.4,fast,50\n"2,small,0.4\n3,small\n')
    with pytest.raises(ExperimentError, match="No such file"):
        HumanFile(tmp_path / "nobody.csv").read(SCHEMA)


def test_the_librarys_designs_name_data_that_follow_the_schema() -> None:
    known = library_human_data()
    assert "warren_whang_1987" in known
    for name in library_designs():
        design = specify(name).design
        if design.human is not None:
            assert design.human in known
    design = specify("warren_whang_1987").design
    factors = {name: [*levels] for name, levels in design.factors.items()}
    data = HumanFile(known["warren_whang_1987"]).read(Schema(groups=[*design.groups], factors=factors, measures=["speed_m_s"]))
    assert [row["mean"] for row in data.rows] == [1.29, 1.61, 1.28, 1.77]
    assert "not found as numbers" in data.notes[0]


def test_the_manual_lists_the_names_that_have_an_underscore_added() -> None:
    assert [name for name in RESERVED if f"`{name}`" not in (human_data.__doc__ or "")] == []
