"""Trials in a process of their own, and the rows that they leave, whatever a model does."""

from __future__ import annotations

import gc
import json
import os
import re
import shutil
import signal
import sqlite3
import subprocess
import sys
import tempfile
import threading
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from contextlib import closing, suppress
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest

from actr3d.cli import main
from actr3d.errors import ExperimentError
from actr3d.experiment import trial_measures
from actr3d.experiment.cluster import cluster_versions, end_processes, run_batch
from actr3d.experiment.specification import Experiment, Specification, specify
from actr3d.experiment.store import Finished, Store
from actr3d.experiment.table import export
from actr3d.experiment.trial import run_trial
from actr3d.experiment.trial_measures import variables_set_in
from actr3d.experiment.trial_process import FOLDER, TIME_LIMIT, TrialProcess
from actr3d.recording import Recorded
from tests.helpers.commands import run_without_reader
from tests.helpers.experiments import COUNTER, trial_processes, write_experiment
from tests.helpers.folders import not_writable


def rows_of(path: Path | str, **values: Any) -> list[dict[str, Any]]:
    """Runs all trials of a design in one process, without a cluster."""
    experiment = specify(str(path), values=values)
    process, text = TrialProcess(), experiment.specification.to_json()
    try:
        trials = experiment.design.table()
        return [{**trial.columns, **process.run(text, trial.number, experiment.design.limit)} for trial in trials]
    finally:
        process.end()


def test_a_row_has_the_measures_of_its_trial(tmp_path: Path) -> None:
    rows = rows_of(write_experiment(tmp_path))
    assert len(rows) == 24
    for row in rows:
        assert row["rt"] == pytest.approx(0.05 * (row["n"] + 1))
        assert (row["end"], row["error"]) == ("end", None)
    assert len({row["luck"] for row in rows}) == 24, "each trial has its own seed"


def test_rows_do_not_depend_on_earlier_trials(tmp_path: Path) -> None:
    model = COUNTER.replace("class Counter", "seen = []\n\n\nclass Counter").replace(
        "rt = model", "seen.append(n)\nrt = len(seen) + 0 * model"
    )
    path = write_experiment(tmp_path, model=model)
    assert {row["rt"] for row in rows_of(path)} == {1}


def test_a_failing_trial_is_a_row_with_its_traceback(tmp_path: Path) -> None:
    rows = rows_of(write_experiment(tmp_path, factors='{"mode": ["count", "fail"], "n": [2]}', participants=1, trials=1))
    (good,) = (row for row in rows if row["mode"] == "count")
    (bad,) = (row for row in rows if row["mode"] == "fail")
    assert good["error"] is None
    assert bad["end"] == "error"
    assert "rt" not in bad
    assert bad["error"].endswith("RuntimeError: cannot count to 2")
    assert 'counter.py", line 23' in bad["error"]
    assert "site-packages" not in bad["error"]


def test_a_failing_trial_has_the_same_row_in_every_process(tmp_path: Path) -> None:
    """Addresses of objects and the folder of temporary files are not the same."""
    end = """
import tempfile
if n == 1:
    rt = object()
if n == 2:
    open(tempfile.gettempdir() + "/words.txt")
if n == 3:
    raise ValueError(f"cannot use {(lambda: 1)}, 0x7f")
"""
    path = write_experiment(tmp_path, model=f"{COUNTER}{end}", factors='{"n": [1, 2, 3]}', participants=1, trials=1)
    one, other = rows_of(path), rows_of(path)
    assert one == other
    errors = {row["n"]: row["error"].splitlines()[-1] for row in one}
    assert "True, False or None (got <object object>)" in errors[1]
    assert errors[2] == "FileNotFoundError: [Errno 2] No such file or directory: 'TMPDIR/words.txt'"
    assert errors[3] == "ValueError: cannot use <function <lambda>>, 0x7f"


def test_a_trial_that_hangs_is_ended_at_its_limit_and_the_rest_goes_on(tmp_path: Path) -> None:
    path = write_experiment(tmp_path, factors='{"mode": ["hang", "count"]}', participants=1, trials=1, limit=1)
    rows = rows_of(path)
    assert [row["end"] for row in rows if row["mode"] == "hang"] == ["time limit"]
    assert [row["end"] for row in rows if row["mode"] == "count"] == ["end"]
    assert "longer than its limit of 1 s" in next(row["error"] for row in rows if row["mode"] == "hang")


@pytest.mark.parametrize(("number", "name"), [(11, "SIGSEGV"), (35, "signal 35")])
def test_a_trial_that_ends_its_own_process_is_a_row(tmp_path: Path, number: int, name: str) -> None:
    model = COUNTER.replace("os.getpid(), 11", f"os.getpid(), {number}")
    rows = rows_of(write_experiment(tmp_path, model=model, factors='{"mode": ["die", "count"]}', participants=1, trials=1))
    (dead,) = (row for row in rows if row["mode"] == "die")
    assert (dead["end"], dead["error"]) == ("crash", f"the process of the trial was ended by {name}")
    assert [row["end"] for row in rows if row["mode"] == "count"] == ["end"]


def test_a_program_that_is_cut_off_is_a_failure_unless_results_reads_it(tmp_path: Path) -> None:
    endless = COUNTER.replace("if int(k) < n:", "if True:")
    path = write_experiment(tmp_path, model=endless, factors='{"n": [1]}', participants=1, trials=1)
    (row,) = rows_of(path)
    assert (row["end"], "rt" in row) == ("error", False)
    assert "the program was stopped at its limit of 60 simulated seconds" in row["error"]
    reads = "limit=60,\n        results=lambda module: {'rt': module.model.now(), 'luck': 0.0}"
    path.write_text(path.read_text(encoding="utf-8").replace("limit=60", reads), encoding="utf-8")
    (row,) = rows_of(path)
    assert (row["end"], row["rt"]) == ("limits", 60)


def test_what_a_model_prints_does_not_mix_with_the_rows(tmp_path: Path) -> None:
    rows = rows_of(write_experiment(tmp_path, factors='{"mode": ["shout"], "n": [1]}', participants=1))
    assert [row["end"] for row in rows] == ["end"] * 4


def test_a_trial_process_that_is_killed_is_started_again(tmp_path: Path) -> None:
    experiment = specify(str(write_experiment(tmp_path)))
    before, process, text = trial_processes(), TrialProcess(), experiment.specification.to_json()
    try:
        first = process.run(text, 0, 60)
        (child,) = trial_processes() - before
        os.kill(child, signal.SIGKILL)
        assert process.run(text, 0, 60) == first
    finally:
        process.end()


@pytest.mark.parametrize("end", [TrialProcess.close, TrialProcess.end])
def test_a_process_ends_while_a_trial_runs_which_then_begins_again_or_has_no_row(
    tmp_path: Path, end: Callable[[TrialProcess], None]
) -> None:
    begun = tmp_path / "begun"
    begins = f"with open({str(begun)!r}, 'a+') as file:\n    file.write('x')\n    first = file.tell() == 1\n"
    waiting = f"{begins}if first:\n    import time\n    time.sleep(60)\n"
    text = specify(str(write_experiment(tmp_path, model=COUNTER.replace("model.run()", f"{waiting}model.run()")))).specification.to_json()
    before, process = trial_processes(), TrialProcess()
    with ThreadPoolExecutor(1) as pool:
        trial = pool.submit(process.run, text, 0, 60)
        while not (begun.exists() and begun.read_text()):
            time.sleep(0.02)
        end(process)
        if end is TrialProcess.close:
            with pytest.raises(ExperimentError, match="the experiment was stopped"):
                trial.result(30)
        else:
            assert trial.result(30)["end"] == "end"
    assert begun.read_text() == ("x" if end is TrialProcess.close else "xx")
    process.close()
    assert trial_processes() == before


def test_a_process_that_ends_while_it_loads_an_experiment_loads_it_again(tmp_path: Path) -> None:
    begun = tmp_path / "begun"
    path = write_experiment(tmp_path)
    text = path.read_text(encoding="utf-8")
    path.write_text(f"import os, time\n{text}", encoding="utf-8")
    specification = specify(str(path)).specification
    waiting = f"import os, time\nif not os.path.exists({str(begun)!r}):\n    open({str(begun)!r}, 'w').close()\n    time.sleep(60)\n{text}"
    slow = replace(specification, design=replace(specification.design, text=waiting)).to_json()
    process = TrialProcess()
    with ThreadPoolExecutor(1) as pool:
        trial = pool.submit(process.run, slow, 0, 60)
        while not begun.exists():
            time.sleep(0.02)
        process.end()
        assert trial.result(30)["end"] == "end"
    process.close()


def test_the_process_of_trials_ends_with_its_worker(tmp_path: Path) -> None:
    begun = tmp_path / "begun"
    hanging = COUNTER.replace("    while True:", f"    open({str(begun)!r}, 'w').close()\n    while True:")
    path = write_experiment(tmp_path, factors='{"mode": ["hang"]}', limit=600, model=hanging)
    code = (
        "import sys, threading\n"
        "from actr3d.experiment.specification import specify\n"
        "from actr3d.experiment.trial_process import TrialProcess\n"
        "p = TrialProcess()\n"
        "print('ready', flush=True)\n"
        "p.run(specify(sys.argv[1]).specification.to_json(), 0, 600)\n"
    )
    temporary = tmp_path / "temporary"
    temporary.mkdir()
    environment = {**os.environ, "TMPDIR": str(temporary)}
    worker = subprocess.Popen([sys.executable, "-c", code, str(path)], stdout=subprocess.PIPE, env=environment)
    assert worker.stdout is not None
    assert worker.stdout.readline() == b"ready\n"

    def children() -> list[str]:
        return subprocess.run(["pgrep", "-P", str(worker.pid), "-f", "trial_process"], capture_output=True, text=True).stdout.split()

    deadline = time.monotonic() + 60
    while not begun.exists() and time.monotonic() < deadline:
        time.sleep(0.02)
    found = children()
    assert found
    worker.kill()
    worker.wait()
    worker.stdout.close()
    while time.monotonic() < deadline and any(
        Path(f"/proc/{pid}/cmdline").exists() and Path(f"/proc/{pid}/cmdline").read_bytes() for pid in found
    ):
        time.sleep(0.05)
    assert time.monotonic() < deadline, "it ran on without its worker"
    assert not list(temporary.iterdir())


@pytest.mark.slow
def test_a_process_of_trials_whose_answers_nobody_reads_leaves_no_files(tmp_path: Path) -> None:
    specification = specify(str(write_experiment(tmp_path))).specification.to_json()
    folder = tmp_path / f"{FOLDER}1"
    folder.mkdir()
    command = [sys.executable, "-m", "actr3d.experiment.trial_process", str(folder)]
    process = subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, start_new_session=True)
    assert process.stdin is not None
    assert process.stdout is not None
    process.stdout.close()
    process.stdin.write(json.dumps(specification).encode() + b"\n")
    process.stdin.flush()
    with suppress(subprocess.TimeoutExpired):
        process.wait(3)  # it loads the experiment, and cannot say so
    process.stdin.close()
    process.wait(60)
    assert not folder.exists()


@pytest.mark.parametrize(
    ("name", "files"),
    [("my_work", 0), *[pytest.param(*case, marks=pytest.mark.slow) for case in ((f"{FOLDER}1", 1), (f"{FOLDER}2", None), (None, None))]],
)
def test_a_process_that_is_started_by_hand_deletes_no_folder(name: str | None, files: int | None, tmp_path: Path) -> None:
    folder = tmp_path / (name or "")
    if files is not None:
        folder.mkdir()
        for number in range(files):
            (folder / f"{number}.txt").touch()
    there = sorted(tmp_path.rglob("*"))
    command = [sys.executable, "-m", "actr3d.experiment.trial_process", *([] if name is None else [str(folder)])]
    ended = subprocess.run(command, input="", capture_output=True, text=True, start_new_session=True, timeout=60)
    assert ended.returncode == 1
    assert re.fullmatch(r"TrialProcess starts this program with a new folder for temporary files \(got .*\)\n", ended.stderr)
    assert sorted(tmp_path.rglob("*")) == there


def test_nothing_is_left_of_processes_that_were_ended(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    temporary = tmp_path / "temporary"
    temporary.mkdir()
    monkeypatch.setattr(tempfile, "tempdir", str(temporary))
    model = COUNTER.replace("model.run()", "import tempfile\nopen(tempfile.mkstemp()[1], 'w').close()\nmodel.run()")
    path = write_experiment(tmp_path, model=model, factors='{"mode": ["count", "die"]}', participants=1, trials=1)
    assert sorted(row["end"] for row in rows_of(path)) == ["crash", "end"]
    assert not list(temporary.iterdir())


@pytest.mark.parametrize(
    ("end", "says"),
    [
        (
            "rt = [1]",
            r"measure 'rt': must be a number, text, True, False or None \(got \[1\]\); of a list, give Design.measures a Measured",
        ),
        ("del rt", r"Design\.measures: the trial has no measure 'rt'"),
    ],
)
def test_measures_that_cannot_be_kept_are_failures(tmp_path: Path, end: str, says: str) -> None:
    path = write_experiment(tmp_path, model=f"{COUNTER}{end}\n", participants=1, trials=1)
    errors = {row["error"] for row in rows_of(path)}
    with pytest.raises(ExperimentError, match=says):
        raise ExperimentError(errors.pop())
    assert not errors


LISTS = """
from actr3d.experiment import Measured


@design
def with_lists():
    from dataclasses import replace
    measures = ["rt", Measured(name="share", unit="%", meaning="How many.", over="block")]
    return replace(counting(), measures=measures)
"""


def test_a_list_has_a_column_for_each_number(tmp_path: Path) -> None:
    model = f"{COUNTER}import numpy as np\nshare = [0.5, None, n] if n < 5 else np.array([1.0, 2.0])\n"
    path = write_experiment(tmp_path, model=model, factors='{"n": [1, 5]}', participants=1, trials=1)
    path.write_text(path.read_text() + LISTS)
    experiment = specify(f"{path}:with_lists")
    text, process = experiment.specification.to_json(), TrialProcess()
    try:
        rows = [{**trial.columns, **process.run(text, trial.number, 60)} for trial in experiment.design.table()]
    finally:
        process.end()
    shares = {row["n"]: [row.get(f"share_{number}", "none") for number in (1, 2, 3)] for row in rows}
    assert shares == {1: [0.5, None, 1], 5: [1.0, 2.0, "none"]}
    assert process.about["share_2"] == {"unit": "%", "meaning": "How many (block 2)."}
    measure = experiment.design.measure("share")
    assert list(measure.values({"share_1": 3, "share_2": None, "share_4": 1})) == [({"block": 1}, 3), ({"block": 2}, None)]
    assert list(experiment.design.measure("rt").values({"rt": 1})) == [({}, 1)]


def test_what_must_be_a_list_and_is_none_is_a_failure(tmp_path: Path) -> None:
    path = write_experiment(tmp_path, model=f"{COUNTER}share = 1\n", participants=1, trials=1, factors="{}")
    path.write_text(path.read_text() + LISTS)
    (row,) = rows_of(f"{path}:with_lists")
    assert row["error"].endswith("measure 'share': must be a list, with a value for each block (got 1)")


def test_numbers_of_numpy_and_without_value_are_plain_measures(tmp_path: Path) -> None:
    model = f"{COUNTER}import numpy as np\nrt = np.float32(0.5)\nluck = float('nan')\n"
    row = rows_of(write_experiment(tmp_path, model=model, participants=1, trials=1))[0]
    assert (row["rt"], row["luck"]) == (0.5, None)


def test_numbers_of_numpy_in_a_design_become_numbers_of_python(tmp_path: Path) -> None:
    path = write_experiment(tmp_path, factors='{"n": list(np.arange(2)), "mode": np.array(["count"])}', participants=1, trials=1)
    path.write_text("import numpy as np\n" + path.read_text())
    rows = rows_of(path)
    assert {row["error"] for row in rows} == {None}
    assert {(type(row["n"]), type(row["mode"])) for row in rows} == {(int, str)}
    assert sorted(row["rt"] for row in rows) == pytest.approx([0.05, 0.1])


OWN_SENSOR = """

from actr3d.world import Body, Car, Scene, World, sensor


@sensor
def doubled(body: Body) -> int:
    '''Senses twice the number.'''
    return 2 * n


rt = World(Scene(parts=(Car(),))).bodies["car"].get("doubled")
"""


def test_a_model_file_may_register_a_sensor_of_its_own_though_it_is_loaded_for_each_trial(tmp_path: Path) -> None:
    rows = rows_of(write_experiment(tmp_path, model=COUNTER + OWN_SENSOR, factors='{"n": [1, 2]}', participants=1, trials=2))
    assert [(row["rt"], row["error"]) for row in rows] == [(2 * row["n"], None) for row in rows]
    assert {row["n"] for row in rows} == {1, 2}


def test_helper_modules_of_model_and_design_travel_with_the_specification(tmp_path: Path) -> None:
    (tmp_path / "pace.py").write_text("from rates import speed\n")
    (tmp_path / "levels.py").write_text("many = [1, 2, 3]\n")
    (tmp_path / "rates").mkdir()
    (tmp_path / "rates" / "__init__.py").write_text("from .fast import speed\n")
    (tmp_path / "rates" / "fast.py").write_text("speed = 7\n")
    model = f"{COUNTER}import pace\nrt = pace.speed\n"
    path = write_experiment(tmp_path, model=model, factors='{"n": levels.many}', participants=1, trials=1)
    path.write_text("import levels\n" + path.read_text())
    specification = specify(str(path)).specification
    assert set(specification.model.helpers) == {"pace", "rates", "rates.fast"}
    assert set(specification.design.helpers) == {"levels"}
    for file in tmp_path.rglob("*.py"):
        file.unlink()
    process, text = TrialProcess(), specification.to_json()
    try:
        assert [process.run(text, number, 60)["rt"] for number in range(3)] == [7, 7, 7]
    finally:
        process.end()


def test_a_trial_of_a_body_has_the_fields_of_its_result_and_their_units(tmp_path: Path) -> None:
    experiment = specify("warren_whang_1987", participants=1, trials=1, values={"aperture": 0.45, "condition": "fast"})
    process, text = TrialProcess(), experiment.specification.to_json()
    try:
        row = process.run(text, 0, 60)
        assert row["outcome"] == "passed"
        assert 30 < row["wall_angle_deg"] < 60
        assert process.about["clearance_left_m"]["unit"] == "m"
        assert process.about["aperture"]["unit"] == "m"
    finally:
        process.end()


def misspelled(names: str, more: str = "") -> str:
    head = "from actr3d.experiment import Design, design\n\n\n@design\ndef counting():\n"
    return f"{head}    return Design(model='counter.py', {more}measures=[\n        {names}])\n"


IN_BODY = misspelled("'outcome', 'wall_angel_deg'").replace("counter.py", "aperture_passage.py")
RESULTS = "\n\ndef found(program):\n    return {'rt': program.rt, 'half': program.rt / 2}\n"


@pytest.mark.parametrize(
    ("design", "model", "says"),
    [
        pytest.param(IN_BODY, "", "'wall_angel_deg'; did you mean 'wall_angle_deg'? It has: outcome, ", id="of a body"),
        pytest.param(misspelled("'rt', 'lucky'"), "", "'lucky'; did you mean 'luck'? It has: n, mode, model, rt, luck", id="of a program"),
        pytest.param(misspelled("'count'"), "", "'count'; it has: n, mode, model, rt, luck", id="a production"),
        pytest.param(
            misspelled("'half_'", "results=found, ") + RESULTS, "", "'half_'; did you mean 'half'? It has: rt, half", id="of results"
        ),
        pytest.param(
            misspelled("'lucky'"), "globals()['more'] = 1\n", "'lucky'; did you mean 'luck'? It has: n, ", id="of a dynamic program"
        ),
    ],
)
def test_a_misspelled_measure_is_refused_before_anything_is_written(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], design: str, model: str, says: str
) -> None:
    write_experiment(tmp_path, model=COUNTER + model)
    path = tmp_path / "counts.py"
    path.write_text(design)
    for more in (["--check"], ["--out", str(tmp_path / "out")]):
        assert main(["experiment", str(path), *more]) == 2
        assert f"counts.py:7: Design.measures: the trial has no measure {says}" in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


@pytest.mark.slow
def test_a_measure_that_only_a_long_run_shows_ends_the_experiment_with_its_first_trial(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(trial_measures, "PATIENCE", 0.05)
    write_experiment(tmp_path, model=COUNTER.replace("model = Counter()", "import time\ntime.sleep(0.2)\nmodel = Counter()"))
    path = tmp_path / "counts.py"
    path.write_text(misspelled("'rtt'", "results=found, trials=1000, ") + RESULTS)
    assert main(["experiment", str(path), "--out", str(tmp_path / "out"), "--workers", "1"]) == 2
    assert "counts.py:7: Design.measures: the trial has no measure 'rtt'; did you mean 'rt'?" in capsys.readouterr().err
    with Store(tmp_path / "out") as store:
        assert store.count == 0


@pytest.mark.parametrize(
    ("names", "value", "says"),
    [
        pytest.param("'half'", "math", "counts.py:7: measure 'half': must be a number, {} (got <module 'math'", id="a module"),
        pytest.param(
            "", "[1]", "counts.py:11: measure 'half': must be a number, {} (got [1]); of a list, give Design.measures", id="a list"
        ),
        pytest.param("'half', 'rt'", "{'a': 1}", "counts.py:7: measure 'half': must be a number, {} (got {'a': 1})", id="a dict"),
    ],
)
def test_a_measure_of_a_wrong_type_is_refused_before_anything_is_written(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], names: str, value: str, says: str
) -> None:
    write_experiment(tmp_path)
    path = tmp_path / "counts.py"
    path.write_text(f"{misspelled(names, 'results=found, ')}{RESULTS.replace('program.rt / 2', value)}\nimport math\n")
    assert main(["experiment", str(path), "--out", str(tmp_path / "out"), "--workers", "1"]) == 2
    assert says.replace("{}", "text, True, False or None") in capsys.readouterr().err
    assert not (tmp_path / "out").exists()


def test_a_variable_that_is_no_measure_ends_the_experiment_with_its_first_trial(tmp_path: Path, capsys: Any) -> None:
    """Its name is known before, and its type is not."""
    write_experiment(tmp_path, model=f"{COUNTER}answer = model\n")
    path = tmp_path / "counts.py"
    path.write_text(misspelled("'rt', 'answer'", "trials=1000, "))
    assert main(["experiment", str(path), "--out", str(tmp_path / "out"), "--workers", "1"]) == 2
    assert "counts.py:7: measure 'answer': must be a number, text, True, False or None (got <" in capsys.readouterr().err
    with Store(tmp_path / "out") as store:
        assert store.count == 0


@pytest.mark.parametrize(
    ("text", "variables"),
    [
        ("a = 1\nimport b, c as d\nfor e in x: pass\nwith y as f: g: int = 1\n", ("a", "e", "f", "g")),
        ("import a\na = a.a\ndef b(): pass\nb = b()\n", ("a", "b")),
        ("def f(a):\n    global b\n    b = c = 1\n    def g():\n        global d\n        d += 1\nclass A:\n    e = 1\n", ("b", "d")),
        ("if (a := 1): b, *c = x\n[d for d in x]\nmatch x:\n    case [e]: pass\n", ("a", "b", "c", "e")),
        ("from actr3d.actr import *\nfrom ccm import *\nfrom b import a\n", ("a",)),
        ("from b import *\n", None),
        ("def f(**a):\n    globals().update(a)\n", None),
        ("import __main__\n__main__.a = 1\n", None),
        ("import sys\nsys.modules[__name__].a = 1\n", None),
    ],
)
def test_the_variables_of_a_program_are_those_that_its_text_sets(text: str, variables: tuple[str, ...] | None) -> None:
    assert variables_set_in(text) == variables


def test_a_measure_that_only_some_trials_have_fails_only_in_the_others(tmp_path: Path) -> None:
    """The text of the program sets it."""
    path = write_experiment(tmp_path, model=f"{COUNTER}if n == 1:\n    del luck\n", participants=1, trials=1)
    assert main(["experiment", str(path), "--out", str(tmp_path / "out"), "--workers", "1"]) == 1
    with Store(tmp_path / "out") as store:
        ends = {row["n"]: (row["end"], row["error"]) for row in store.rows()}
    assert ends[2] == ends[5] == ("end", None)
    assert ends[1][0] == "no measure"
    assert "counting_design.py:13: Design.measures: the trial has no measure 'luck'" in ends[1][1]


# -- the store


def finished(*numbers: int, **more: Any) -> list[Finished]:
    return [
        Finished(row={"trial": number, "x": number / 2, **more, "end": "end", "error": None}, wall_s=0.1, worker="w") for number in numbers
    ]


def store_of(tmp_path: Path) -> Store:
    return Store.create(tmp_path / "out", specify(str(write_experiment(tmp_path))).specification)


def test_rows_are_the_same_in_any_order_of_arrival(tmp_path: Path) -> None:
    (tmp_path / "a").mkdir()
    (tmp_path / "b").mkdir()
    texts: list[bytes] = []
    rows = [finished(2, y=1), finished(0, y=0.5, z=None), finished(1, z=True)]
    for name, batches in (("a", rows), ("b", rows[::-1])):
        with store_of(tmp_path / name) as store:
            for batch in batches:
                store.add(batch, "v 1")
            export(store)
            texts.append((store.folder / "trials.csv").read_bytes())
            assert {column.name: column.type for column in store.columns}["y"] == "real"
    assert texts[0] == texts[1]
    assert texts[0].decode().splitlines()[0] == "trial,x,y,z,end,error,versions,wall_s,worker"


def test_a_trial_has_one_row(tmp_path: Path) -> None:
    with store_of(tmp_path) as store:
        assert store.add(finished(0, 1), "v") == 2
        assert store.add(finished(1, 2, late=True), "v") == 1
        assert store.count == 3
        row = store.row(1)
        assert row is not None
        assert row["late"] is None
        assert list(store.missing(6)) == [3, 4, 5]
        assert store.row(5) is None


def test_tables_have_the_types_and_units_of_their_columns(tmp_path: Path) -> None:
    parquet = pytest.importorskip("pyarrow.parquet")
    with store_of(tmp_path) as store:
        store.add(finished(0, flag=True, name='\u00e9\n,"', none=None), "v", {"x": {"unit": "m", "meaning": "Its width [m]."}})
        given: dict[str, dict[str, str | None]] = {"walk_cm": {"unit": "m", "meaning": "Its unit is not that of its name."}}
        store.add(finished(1, flag=None, name=None, none=None, latency_s_2=1.0, speed_m_s=1.0, walk_cm=1.0, items=1), "v", given)
        export(store)
        table = parquet.read_table(store.folder / "trials.parquet")
        assert table.column("flag").to_pylist() == [True, None]
        assert table.column("name").to_pylist() == ['\u00e9\n,"', None]
        assert table.schema.field("x").metadata[b"unit"] == b"m"
        columns = (store.folder / "columns.csv").read_text()
        assert "x,real,m,Its width [m]." in columns
        assert "latency_s_2,real,s," in columns
        assert "speed_m_s,real,m/s," in columns
        assert "walk_cm,real,m," in columns
        assert "items,integer,," in columns
        assert 'trial,integer,,"The number of the trial, from 0."' in columns


def test_a_table_has_every_value_as_it_is_and_is_written_without_pandas(tmp_path: Path) -> None:
    """Pandas takes half a second to load."""
    parquet = pytest.importorskip("pyarrow.parquet")
    rows = [
        {"flag": n % 3 > 0, "whole": 2**63 - 1 - n, "number": n / 7, "word": f"{n}", "list": [n], "none": None} if n % 4 else {}
        for n in range(11)
    ]
    rows[1] |= {"whole": -(2**63), "number": 1e308, "word": ""}
    with store_of(tmp_path) as store:
        store.add([one for n, row in enumerate(rows) for one in finished(n, **row)], "v")
    code = "import sys; from actr3d.experiment.table import export, Store; export(Store(sys.argv[1])); assert 'pandas' not in sys.modules"
    subprocess.run([sys.executable, "-c", code, str(store.folder)], check=True, timeout=60)
    table = parquet.read_table(store.folder / "trials.parquet")
    for name in ("flag", "whole", "number", "word", "none"):
        assert table.column(name).to_pylist() == [row.get(name) for row in rows]
    assert table.column("list").to_pylist() == [str(row["list"]) if row else None for row in rows]


def test_only_one_process_writes(tmp_path: Path) -> None:
    with store_of(tmp_path) as store, store.only_writer(), Store(store.folder) as other:
        with pytest.raises(ExperimentError, match=rf"another process \({os.getpid()}\) runs this experiment"), other.only_writer():
            pass
        assert other.count == 0


def test_a_folder_that_is_in_use_or_no_experiment_is_refused(tmp_path: Path) -> None:
    specification = specify(str(write_experiment(tmp_path))).specification
    with pytest.raises(ExperimentError, match=r"is not empty; name a new folder$"):
        Store.create(tmp_path, specification)
    with pytest.raises(ExperimentError, match=r"counter\.py' is a file; name a new folder"):
        Store.create(tmp_path / "counter.py", specification)
    Store.create(tmp_path / "out", specification).close()
    with pytest.raises(ExperimentError, match="holds an experiment already; continue it with --resume"):
        Store.create(tmp_path / "out", specification)
    with pytest.raises(ExperimentError, match=r"holds no experiment: cannot read experiment\.json"):
        Store(tmp_path)
    (tmp_path / "out" / "trials.sqlite").write_bytes(b"not a database" * 100)
    with pytest.raises(ExperimentError, match=r"trials\.sqlite: cannot be opened"):
        Store(tmp_path / "out")


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="the system has no named pipes")
@pytest.mark.parametrize("name", ["experiment.json", "trials.sqlite", "lock"])
@pytest.mark.timeout(20)
def test_a_pipe_in_the_folder_of_an_experiment_is_refused_and_not_waited_for(name: str, tmp_path: Path) -> None:
    store = store_of(tmp_path)
    store.close()
    (store.folder / name).unlink(missing_ok=True)
    os.mkfifo(store.folder / name)
    with pytest.raises(ExperimentError, match=rf"holds no experiment: {name} is a pipe, not a file"):
        Store(store.folder)


def test_an_experiment_in_a_folder_that_cannot_be_written_is_read() -> None:
    with tempfile.TemporaryDirectory() as place:  # pytest's own folders are closed to others
        outer = Path(place)
        outer.chmod(0o755)
        folder = outer / "out"
        with Store.create(folder, specify(str(write_experiment(outer))).specification) as store:
            store.add(finished(0, 1), "v")
        with not_writable(folder), Store(folder) as store:
            assert [row["trial"] for row in store.rows()] == [0, 1]
            assert store.count == 2
            with pytest.raises(ExperimentError, match=r"facts\.json': cannot be written \(Permission denied\)"):
                store.write_facts({})
            with pytest.raises(ExperimentError, match=r"out': cannot be written \(Permission denied\)"), store.only_writer():
                pass
            with pytest.raises(ExperimentError, match=r"trials\.sqlite: cannot write \(attempt to write a readonly database\)"):
                store.add(finished(2), "v")


def test_rows_in_the_log_of_a_killed_process_are_read_also_where_nothing_can_be_written() -> None:
    with tempfile.TemporaryDirectory() as place:
        outer = Path(place)
        outer.chmod(0o755)
        folder = outer / "out"
        with Store.create(outer / "first", specify(str(write_experiment(outer))).specification) as store:
            store.add(finished(0, 1), "v")
            shutil.copytree(store.folder, folder)  # as if it was killed now
        assert (folder / "trials.sqlite-wal").stat().st_size > 0
        with not_writable(folder), Store(folder) as store:
            assert store.count == 2


def test_a_specification_that_cannot_be_written_leaves_no_folder(tmp_path: Path) -> None:
    specification = replace(specify(str(write_experiment(tmp_path))).specification, values={"n": object()})
    with pytest.raises(TypeError):
        Store.create(tmp_path / "out", specification)
    assert not (tmp_path / "out").exists()


def test_a_store_that_cannot_be_written_says_so_and_keeps_its_rows(tmp_path: Path) -> None:
    with store_of(tmp_path) as store:
        store.add(finished(0), "v")
        with closing(sqlite3.connect(store.folder / "trials.sqlite")) as other, other:
            pages = other.execute("PRAGMA page_count").fetchone()[0]
        store._database.execute(f"PRAGMA max_page_count = {pages}")
        with pytest.raises(ExperimentError, match=r"cannot write \(database or disk is full\); the rows before are kept"):
            store.add(finished(*range(1, 500), text="x" * 1000), "v")
        assert store.count == 1
    gc.collect()


@pytest.mark.slow
def test_memory_does_not_grow_with_the_rows(tmp_path: Path) -> None:
    """Of 40,000 rows, no more are in memory at a time than of 10,000."""
    import tracemalloc

    peaks: list[int] = []
    with store_of(tmp_path) as store:
        for total in (10_000, 40_000):
            for begin in range(store.count, total, 500):
                store.add(finished(*range(begin, begin + 500), text="x" * 100), "v")
            tracemalloc.start()
            assert sum(1 for _ in store.rows()) == total
            export(store)
            assert len(list(store.missing(total + 3))) == 3
            peaks.append(tracemalloc.get_traced_memory()[1])
            tracemalloc.stop()
    assert peaks[1] < 1.2 * peaks[0]


# -- the command


def test_a_trial_is_recorded_and_replayed(tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    path = write_experiment(tmp_path)
    experiment = specify(str(path))
    ended = {**experiment.design.trial(8).columns, "end": TIME_LIMIT, "error": "the trial took longer than its limit of 2 s, and was ended"}
    with Store.create("out", experiment.specification) as store:
        store.add([Finished(row=ended, wall_s=2.0, worker="0")], "v")
    path.unlink()
    (tmp_path / "counter.py").unlink()
    assert main(["experiment", "out", "--trial", "7", "--record", "seven.rec"]) == 0
    assert capsys.readouterr().out == "trial 7 is recorded in 'seven.rec'\n"
    assert main(["experiment", "out", "--trial", "8", "--record", "eight.rec"]) == 0
    said = capsys.readouterr().out
    assert "in the experiment this trial failed: the trial took longer than its limit of 2 s, and was ended" in said
    assert "Ctrl-C ends it, and what has happened until then is recorded" in said
    assert main(["replay", "seven.rec"]) == 0
    assert main(["experiment", "out", "--trial", "99", "--record", "x.rec"]) == 2
    assert "trial: must be a number from 0 to 23 (got 99)" in capsys.readouterr().err
    assert main(["experiment", "out", "--trial", "7"]) == 2
    assert "--trial ID and --record RECORDING are given together" in capsys.readouterr().err
    assert main(["experiment", "out", "--trial", "7", "--record", "x.rec", "--set", "n=1", "--participants", "3"]) == 2
    assert "--trial: runs a trial again exactly as it was; leave out --set and --participants" in capsys.readouterr().err
    assert not Path("x.rec").exists()
    assert main(["experiment", "--trial", "3", "--record", str(tmp_path / "b.rec")]) == 2
    assert "name a design, a file or the folder of an experiment, or leave out --" in capsys.readouterr().err
    assert main(["experiment", "--workers", "3"]) == 2
    assert "name a design, a file or the folder of an experiment, or leave out --workers" in capsys.readouterr().err


def test_nothing_of_a_trial_stays_alive() -> None:
    specification = specify("warren_whang_1987", values={"speed": 3.0}).specification  # short walks

    def alive() -> int:
        gc.collect()
        # By the type itself, as other tests leave weak proxies of what is gone.
        return sum(issubclass(type(thing), type) and str(thing.__module__).startswith("actr3d_model_") for thing in gc.get_objects())

    with specification.sealed() as helpers:
        experiment = Experiment(specification, helpers)
        counts: list[int] = []
        for number in range(3):
            assert run_trial(experiment, experiment.design.trial(number), helpers)["end"] == "stop"
            counts.append(alive())
    assert counts[1] > 0
    assert counts[1] == counts[2]


@pytest.mark.parametrize(
    ("end", "says"),
    [
        ("rt = 10**5000", "measure 'rt': must be a whole number of at most 64 bits, or a float"),
        ("rt = 'a\\ud800'", "measure 'rt': must be a text of characters that can be stored"),
    ],
)
def test_measures_that_no_table_can_hold_are_failures(tmp_path: Path, end: str, says: str) -> None:
    path = write_experiment(tmp_path, model=f"{COUNTER}if n == 2:\n    {end}\n", factors='{"n": [1, 2]}', participants=1, trials=1)
    rows = {row["n"]: row for row in rows_of(path)}
    assert rows[1]["error"] is None
    assert says in rows[2]["error"]


def test_an_error_with_characters_that_cannot_be_stored_is_a_row_and_the_table_is_written(tmp_path: Path) -> None:
    path = write_experiment(tmp_path, model=f"{COUNTER}if n == 1:\n    raise ValueError('no file \\udcff')\n", participants=1, trials=1)
    rows = rows_of(path)
    assert [row["end"] for row in rows] == ["error", "end", "end"]
    with Store.create(tmp_path / "out", specify(str(path)).specification) as store:
        store.add([Finished(row={"trial": n, **row}, wall_s=1, worker="0") for n, row in enumerate(rows)], "v")
        export(store)
    assert "ValueError: no file \\udcff" in (tmp_path / "out" / "trials.csv").read_text(encoding="utf-8")


def test_a_measure_that_is_too_large_for_statistics_is_a_failure(tmp_path: Path) -> None:
    path = write_experiment(tmp_path, model=f"{COUNTER}rt = 1e200\n", factors='{"n": [1]}', participants=1, trials=1)
    (row,) = rows_of(path)
    assert row["error"] == "error: measure 'rt': must be from -1e+100 to 1e+100 (got 1e+200)"


def test_a_model_that_forks_answers_once(tmp_path: Path) -> None:
    fork = "import os, time\nif os.fork() == 0:\n    time.sleep(0.05)\n    rt = -1\nelse:\n    rt = n\n"
    path = write_experiment(tmp_path, model=f"{COUNTER}{fork}", participants=1, trials=6)
    assert all(row["rt"] == row["n"] for row in rows_of(path))


def test_a_trial_that_ends_itself_is_noticed_although_a_child_of_it_lives(tmp_path: Path) -> None:
    child = "subprocess.Popen([sys.executable, '-c', 'import time; time.sleep(600)'], close_fds=False)"
    model = f"{COUNTER}import os, subprocess, sys\n{child}\nos._exit(3)\n"
    path = write_experiment(tmp_path, model=model, factors='{"n": [1]}', participants=1, trials=1, limit=30)
    (row,) = rows_of(path)
    assert (row["end"], row["error"]) == ("crash", "the process of the trial ended with exit code 3")


def test_a_trial_whose_values_cannot_be_derived_is_a_failure(tmp_path: Path) -> None:
    path = write_experiment(tmp_path, participants=1, trials=1)
    text, process = specify(str(path)).specification.to_json(), TrialProcess()
    try:
        assert "trial: must be a number from 0 to 2 (got 77)" in process.run(text, 77, 60)["error"]
        assert process.run(text, 1, 60)["error"] is None
    finally:
        process.end()


def test_a_trial_is_recorded_whole_though_nobody_reads_its_output(tmp_path: Path) -> None:
    path = write_experiment(tmp_path, model=f"{COUNTER}\nprint('printed')\n", participants=1, trials=1)
    Store.create(tmp_path / "out", specify(str(path)).specification).close()
    command = [sys.executable, "-m", "actr3d", "experiment", "out", "--trial", "0", "--record", "again.rec"]
    done = run_without_reader(command, tmp_path)
    assert (done.returncode, done.stderr) == (2, "")
    with Recorded(tmp_path / "again.rec") as recorded:
        assert recorded.finished
        assert not recorded.failed


@pytest.mark.slow
def test_a_trial_is_repeated_with_the_same_order_of_sets(tmp_path: Path) -> None:
    model = COUNTER.replace("luck = model.random.random()", 'luck = "".join({"alpha", "beta", "gamma", "delta", "eps"})\nprint(luck)')
    path = write_experiment(tmp_path, model=model, factors='{"n": [1]}', participants=1, trials=1)
    out = tmp_path / "out"
    for words in (
        ("experiment", str(path), "--workers", "1", "--out", str(out)),
        ("experiment", str(out), "--trial", "0", "--record", str(tmp_path / "again.rec")),
        ("replay", str(tmp_path / "again.rec")),
    ):
        environment = {name: value for name, value in os.environ.items() if name != "PYTHONHASHSEED"}
        done = subprocess.run([sys.executable, "-m", "actr3d", *words], env=environment, capture_output=True, text=True, timeout=200)
        assert done.returncode == 0, done.stdout + done.stderr
        if "--trial" in words:
            with Store(out) as store:
                row = store.row(0)
            assert row is not None
            assert row["luck"] in done.stdout


def test_only_one_of_several_commands_makes_the_experiment_of_a_folder(tmp_path: Path) -> None:
    path = write_experiment(tmp_path, participants=1, trials=1)
    specifications = [specify(str(path), trials=number).specification for number in range(1, 9)]
    for round_ in range(10):
        out, made = tmp_path / f"out {round_}", list[int]()
        ready = threading.Barrier(len(specifications))

        def create(number: int, out: Path = out, made: list[int] = made, ready: threading.Barrier = ready) -> None:
            ready.wait()
            with suppress(ExperimentError):
                Store.create(out, specifications[number]).close()
                made.append(number)

        threads = [threading.Thread(target=create, args=(number,)) for number in range(len(specifications))]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        assert len(made) == 1
        with Store(out) as store:
            assert store.specification == specifications[made[0]]


def test_an_experiment_is_made_on_the_disk_also_where_a_command_was_ended_meanwhile(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    specification, folder = specify(str(write_experiment(tmp_path))).specification, tmp_path / "out"
    synced: list[tuple[str, bool]] = []

    def end_before_the_link(*_: Any) -> None:
        raise KeyboardInterrupt

    def keep(*_: Any, **__: Any) -> None:
        pass

    def note(descriptor: int) -> None:
        synced.append((Path(f"/proc/self/fd/{descriptor}").readlink().suffix, (folder / "experiment.json").exists()))

    with monkeypatch.context() as during:
        during.setattr(Path, "unlink", keep)
        during.setattr(os, "link", end_before_the_link)
        with pytest.raises(KeyboardInterrupt):
            Store.create(folder, specification)
    assert [path.suffix for path in folder.iterdir()] == [".tmp"]
    monkeypatch.setattr(os, "fsync", note)
    with Store.create(folder, specification) as store:
        assert store.specification == specification
    assert synced == [(".tmp", False), ("", True)]
    with pytest.raises(ExperimentError, match="holds an experiment already"):
        Store.create(folder, specification)
    (other := tmp_path / "other").mkdir()
    (other / "experiment.json.txt").touch()
    with pytest.raises(ExperimentError, match="is not empty"):
        Store.create(other, specification)


def test_only_trials_with_an_error_count_as_failures(tmp_path: Path) -> None:
    rows = [{"Error": "x", "error": None}, {"level": {"n": 1, "error": "low"}, "error": None}, {"error": "ValueError: no"}]
    with Store.create(tmp_path / "out", specify(str(write_experiment(tmp_path))).specification) as store:
        store.add([Finished(row={"trial": n, **row}, wall_s=1, worker="0") for n, row in enumerate(rows)], "v")
        assert store.failures == 1


@pytest.mark.parametrize(
    "damage",
    ["UPDATE trial SET data = '{bad' WHERE number = 1", "UPDATE trial SET data = '[]'", "ALTER TABLE trial DROP COLUMN versions"],
)
def test_a_damaged_table_is_named(tmp_path: Path, damage: str) -> None:
    experiment = specify(str(write_experiment(tmp_path)))
    with Store.create(tmp_path / "out", experiment.specification) as store:
        store.add([Finished(row={"trial": n, "rt": 1.0, "error": None}, wall_s=1, worker="0") for n in range(3)], "v")
    with closing(sqlite3.connect(tmp_path / "out" / "trials.sqlite")) as file:
        file.execute(damage)
        file.commit()
    with Store(tmp_path / "out") as store:
        assert store.failures == 0
        with pytest.raises(ExperimentError, match=r"trials\.sqlite: is damaged"):
            list(store.rows())


def test_a_trial_finds_no_variable_of_the_design_as_an_earlier_one_left_it(tmp_path: Path) -> None:
    path = write_experiment(tmp_path, factors='{"n": [1]}', participants=1, trials=3)
    text = path.read_text(encoding="utf-8").replace("limit=60", "limit=60, results=results, derive=derive")
    more = [
        "import beside\nSEEN = []\n",
        "def derive(values):",
        "    beside.SEEN.append(1)",
        "    return {'seen': len(beside.SEEN)}\n",
        "def results(program):",
        "    SEEN.append(program.rt)",
        "    return {'rt': len(SEEN), 'luck': 0.5}\n",
    ]
    path.write_text("\n".join(more) + text, encoding="utf-8")
    (tmp_path / "counter.py").write_text(COUNTER.replace("n = 3", "n = 3\nseen = 0"), encoding="utf-8")
    (tmp_path / "beside.py").write_text("SEEN = []\n", encoding="utf-8")
    process, specification = TrialProcess(), specify(str(path)).specification.to_json()
    try:
        for number in (0, 1, 2):
            assert process.run(specification, number, 60)["rt"] == 1
            assert process.columns["seen"] == 1
    finally:
        process.close()


def test_a_list_that_is_set_is_the_same_for_client_and_worker(tmp_path: Path) -> None:
    """The seed names the levels: a tuple there and a list here would be two seeds."""
    path = write_experiment(tmp_path, factors='{"n": [1], "pair": [None]}', model=COUNTER.replace("n = 3", "n = 3\npair = None"))
    experiment = specify(str(path), values={"pair": [(1, 2), (3, 4)]})
    again = Experiment(Specification.from_json(experiment.specification.to_json(), "here"))
    assert [trial.columns for trial in again.design.table()] == [trial.columns for trial in experiment.design.table()]
    assert "pair=[1, 2]" in experiment.design.trial(0).seed or "pair=[3, 4]" in experiment.design.trial(0).seed


def test_a_row_has_the_values_that_ran(tmp_path: Path) -> None:
    """Also where the design draws numbers of its own."""
    path = write_experiment(tmp_path, factors='{"mode": ["count"]}', participants=1, trials=2)
    derive = "limit=60, derive=lambda v: {'n': os.getpid()}, results=lambda program: {'rt': program.n, 'luck': 0}"
    path.write_text("import os\n" + path.read_text(encoding="utf-8").replace("limit=60", derive), encoding="utf-8")
    (tmp_path / "counter.py").write_text(COUNTER.replace("model.run()", "model.run(0)"), encoding="utf-8")
    try:
        batch = run_batch(specify(str(path)).specification.to_json(), [0, 1], 60, cluster_versions(), str(path))
    finally:
        end_processes(str(path))
    assert len(batch.rows) == 2
    for _, row, _ in batch.rows:
        assert row["rt"] == row["n"] != os.getpid()


def test_a_folder_that_another_computer_writes_is_not_opened(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = tmp_path / "out"
    with Store.create(folder, specify(str(write_experiment(tmp_path))).specification) as store, store.only_writer():
        Store(folder).close()
        monkeypatch.setattr("actr3d.experiment.store.gethostname", lambda: "elsewhere")
        with pytest.raises(ExperimentError, match=rf"out': process {os.getpid()} on the computer '.+' writes it now; use it there"):
            Store(folder)
    Store(folder).close()


def test_a_design_of_the_library_runs_beside_a_folder_of_its_name(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Any) -> None:
    monkeypatch.chdir(tmp_path)
    Store.create("utility_learning", specify("utility_learning").specification).close()
    words = ["experiment", "utility_learning", "--participants", "1", "--trials", "1", "--workers", "1"]
    assert main([*words, "--out", "small"]) == 0
    assert "trials in 'small', 0 finished" in capsys.readouterr().out
    assert main(["experiment", "./utility_learning", "--participants", "1"]) == 1
    assert "is an experiment, whose design is fixed" in capsys.readouterr().err


STILL_WALKING = """from actr3d.actr import *
from actr3d.simulation import BodyPort, Simulation
from actr3d.world import Floor, Mannequin, Scene


class Walker(ACTR):
    goal = Buffer()
    body = BodyPort()

    def init():
        goal.set("start")

    def start(goal="start"):
        body.set("walk", 1.2)
        goal.clear()


def build() -> Simulation:
    return Simulation(Scene(parts=(Floor(), Mannequin(name="walker"))), {"walker": Walker})
"""


def test_a_check_says_if_trials_end_while_a_body_still_moves(tmp_path: Path, capsys: Any) -> None:
    (tmp_path / "walk.py").write_text(STILL_WALKING, encoding="utf-8")
    path = tmp_path / "walk_design.py"
    results = "results=lambda simulation: {'x': simulation.world.bodies['walker'].get('pose').x}"
    path.write_text(f"from actr3d.experiment import *\n\n\n@design\ndef walking():\n    return Design(model='walk.py', {results})\n")
    assert main(["experiment", str(path), "--check"]) == 0
    assert "its first trials ended because no agent had anything left to do (`done`)." in capsys.readouterr().out


def test_a_check_shows_factors_parameters_of_groups_and_settings(tmp_path: Path, capsys: Any) -> None:
    path = write_experiment(tmp_path, factors='{"mode": ["count"]}', trials=1)
    text = path.read_text(encoding="utf-8").replace("participants=2", 'participants=2, parameters={"n": 3}')
    path.write_text(text.replace("limit=60", 'limit=60, settings={"pause": Uniform(low=1, high=2)}'), encoding="utf-8")
    (tmp_path / "counter.py").write_text(COUNTER.replace("n = 3", "n = 3\npause = 1.0"), encoding="utf-8")
    assert main(["experiment", str(path), "--check"]) == 0
    assert "participants: 2 all\n  mode: count\n  n of all: 3\n  pause: Uniform(low=1.0, high=2.0)\n" in capsys.readouterr().out


def test_a_check_names_the_trial_that_fails_and_takes_no_options_of_a_run(tmp_path: Path, capsys: Any) -> None:
    model = COUNTER.replace('if mode == "fail"', "if n == 1")
    path = write_experiment(tmp_path, factors='{"n": [1, 2]}', participants=1, trials=1, model=model)
    path.write_text(path.read_text(encoding="utf-8").replace("limit=60", 'limit=60, order="fixed"'), encoding="utf-8")
    assert main(["experiment", str(path), "--check"]) == 1
    assert "trial 0 failed: " in capsys.readouterr().out
    assert main(["experiment", str(path), "--check", "--out", "x", "--workers", "2"]) == 2
    assert "--check: runs two trials on this computer and stores nothing; leave out --workers and --out" in capsys.readouterr().err
