"""Experiments over REST: checked, run, stopped, continued, read, and refused where something is wrong."""

from __future__ import annotations

import asyncio
import io
import json
import os
import re
import shutil
import signal
import sqlite3
import subprocess
import sys
import time
from collections.abc import Coroutine, Iterator
from contextlib import closing
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import httpx
import pytest

from actr3d.parameter_schema import literal
from actr3d.runner.cli_options import read_settings
from tests.helpers.asgi_client import JSON, ORIGIN, OURS
from tests.helpers.experiments import COUNTER, write_experiment
from tests.helpers.sessions import Desk
from tests.helpers.workbench_server import Served, served
from workbench import experiments
from workbench.design_files import CheckRequest, StartRequest
from workbench.experiment_command import ExperimentCommand, ExperimentFacts, ExperimentProgress, ExperimentRunError
from workbench.experiment_folder import ExperimentFolder
from workbench.experiments import Experiments, RunningExperiment
from workbench.readers import ReadingError

pytestmark = pytest.mark.long

PATIENCE = 120.0
SLOW = COUNTER.replace('if mode == "fail"', 'import time\ntime.sleep(0.05)\nif mode == "fail"')
COUNTING = "counting_design.py:counting"


@pytest.fixture(scope="module")
def workbench(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Served]:
    folder = tmp_path_factory.mktemp("experiments") / "models"
    folder.mkdir()
    write_experiment(folder)
    (folder / "slow").mkdir()
    write_experiment(folder / "slow", factors='{"n": [1, 2]}', participants=4, trials=100, model=SLOW)
    with served(folder) as running:
        yield running


def started(workbench: Served, design: str = COUNTING, **more: Any) -> str:
    answer = workbench.post("/api/experiments", {"design": design, "workers": 1, **more})
    assert answer.status_code == 201, answer.text
    return answer.json()["id"]


def state_of(workbench: Served, name: str) -> dict[str, Any]:
    return workbench.get(f"/api/experiments/{name}").json()


def awaited(workbench: Served, name: str, *states: str, done: int = 0) -> dict[str, Any]:
    """Waits until an experiment has one of some states, and so many finished trials."""
    end = time.monotonic() + PATIENCE
    while (now := state_of(workbench, name))["state"] not in states or now["done"] < done:
        assert time.monotonic() < end, now
        time.sleep(0.1)
    return now


@pytest.fixture(scope="module")
def finished(workbench: Served) -> str:
    """A small experiment that has run: 2 participants, 3 numbers, 4 trials each."""
    name = started(workbench)
    now = awaited(workbench, name, "finished")
    assert (now["done"], now["total"], now["failures"], now["problem"]) == (24, 24, 0, None)
    assert now["facts"]["factors"] == {"n": [1, 2, 5]}
    assert {"n", "participant", "rt", "luck", "wall_s"} <= {*now["columns"]}
    return name


def test_designs_of_the_library_and_of_model_files_are_listed_without_running_them(workbench: Served) -> None:
    (workbench.folder / "bad_design.py").write_text("import nothing_like_this\n@design\ndef bad():\n    '''Never runs.'''\n", "utf-8")
    unusable = workbench.folder / "bad:design.py"  # a name that no request can have
    unusable.write_text("@design\ndef bad(): ...\n", "utf-8")
    listed = {one["id"]: one for one in workbench.get("/api/designs").json()["designs"]}
    unusable.unlink()
    assert not [name for name in listed if name.startswith("bad:")]
    assert listed[COUNTING] == {
        "id": COUNTING,
        "name": "counting",
        "file": "counting_design.py",
        "model": "counter.py",
        "description": "Counts to several numbers.",
    }
    assert listed["bad_design.py:bad"]["description"] == "Never runs."
    assert listed["bad_design.py:bad"]["model"] is None
    assert (listed["warren_whang_1987"]["file"], listed["warren_whang_1987"]["model"]) == (None, "aperture_passage.py")
    assert listed["slow/counting_design.py:counting"]["model"] == "slow/counter.py"
    assert workbench.get("/api/designs").json()["processors"] == len(os.sched_getaffinity(0))
    assert workbench.get("/api/designs").json()["most"] == {
        "participants": 1_000_000,
        "trials": 1_000_000,
        "workers": 256,
        "levels": 200,
        "characters": 1_000,
    }
    answer = workbench.post("/api/designs/check", {"design": "bad_design.py:bad"})
    assert answer.status_code == 422
    assert "nothing_like_this" in answer.json()["error"]
    (workbench.folder / "bad_design.py").unlink()


def test_a_design_is_checked_with_its_changes(workbench: Served) -> None:
    facts = workbench.post("/api/designs/check", {"design": COUNTING, "values": {"n": [3, 4]}, "participants": 5, "trials": 7}).json()
    assert (facts["trials"], facts["factors"], facts["groups"], facts["trials_a_cell"]) == (70, {"n": [3, 4]}, {"all": 5}, 7)
    assert [parameter["name"] for parameter in facts["parameters"]] == ["n", "mode"]
    large = workbench.post("/api/designs/check", {"design": COUNTING, "texts": {"seed": [str(2**53 + 1)]}}).json()
    assert (large["seed"], large["changed"]["seed"]) == (str(2**53 + 1), str(2**53 + 1)), "a browser would round the numbers"
    tried = workbench.post("/api/designs/check", {"design": "slow/counting_design.py:counting", "trial": True}).json()
    assert 0 < tried["seconds_a_trial"] < 60
    assert tried["model"] == "slow/counter.py"
    wrong = workbench.post("/api/designs/check", {"design": COUNTING, "values": {"nn": 3}})
    assert wrong.status_code == 422
    assert wrong.json()["error"].startswith("nn: the model has no parameter 'nn'; did you mean 'n'?")
    assert workbench.post("/api/experiments", {"design": COUNTING, "values": {"nn": 3}}).json() == wrong.json()
    empty = workbench.post("/api/designs/check", {"design": COUNTING, "values": {"n": []}})
    assert (empty.status_code, empty.json()["error"]) == (422, "n: must have at least one level (got [])")
    huge = workbench.post("/api/designs/check", {"design": COUNTING, "texts": {"n": ["1", "1" + "0" * 30]}}).json()
    assert huge["error"] == "n: must be a whole number of at most 64 bits, or a float (got one of 100 bits)"
    bounds = workbench.post("/api/designs/check", {"design": "warren_whang_1987", "texts": {"aperture": ["0.5", "4"]}})
    assert (bounds.status_code, bounds.json()["error"]) == (422, "aperture: must be <= 3 (got 4)")


@pytest.mark.parametrize("changed", ["model.py", "_helper.py", "parts/legs.py"])
def test_a_design_is_checked_again_after_a_change_of_whatever_file_it_may_use(
    changed: str, tmp_path: Path, desk: Desk, monkeypatch: pytest.MonkeyPatch
) -> None:
    checked: list[object] = []

    async def first(*_: object) -> ExperimentFacts:
        checked.append(_)
        return ExperimentFacts(name="fan_effect", description="", trials=1, trials_a_cell=1, factors={}, groups={})

    (tmp_path / "parts").mkdir()
    for name in ("model.py", "_helper.py", "parts/legs.py"):
        (tmp_path / name).write_text("A = 1\n", "utf-8")

    async def twice() -> None:
        experiments = Experiments(desk.sessions(tmp_path))
        monkeypatch.setattr(experiments, "_first", first)
        for expected in (1, 1, 2):
            if expected == 2:
                (tmp_path / changed).write_text("A = 23\n", "utf-8")
            await experiments.check(CheckRequest(design="fan_effect"))
            assert len(checked) == expected

    desk.do(twice())


@pytest.mark.slow
def test_values_reach_the_design_as_they_are(workbench: Served) -> None:
    texts = ["a, b", "'", '"', "1", "None", "é\n", "--json", "[1]"]
    facts = workbench.post("/api/designs/check", {"design": COUNTING, "values": {"n": [1, 2.5, True, None], "mode": "x"}}).json()
    assert facts["factors"]["n"] == [1, 2.5, True, None]
    facts = workbench.post("/api/designs/check", {"design": COUNTING, "values": {"n": texts}}).json()
    assert facts["factors"]["n"] == texts


def test_texts_give_the_same_experiment_as_in_the_command(workbench: Served) -> None:
    facts = workbench.post("/api/designs/check", {"design": COUNTING, "texts": {"n": ["7", "2.0", "1e1"], "mode": ["none"]}}).json()
    assert repr(facts["factors"]["n"]) == "[7, 2, 10.0]", "2 is a level of the design"
    assert facts["settings"] == {"mode": "none"}
    for text in (
        "none",
        "None",
        "true",
        "False",
        "no",
        "'no'",
        '"a, b"',
        "5",
        "3.0",
        "0x10",
        "1_000",
        "don't",
        "é",
        "[1, 2]",
        " x",
        "--json",
    ):
        options = {
            read: StartRequest(design="d", texts={"mode": texts}).options() for read, texts in (("one", [text]), ("two", [text, "7"]))
        }
        (one,), (two,) = ([option.removeprefix("--set=") for option in given] for given in options.values())
        assert repr(read_settings([one], ())) == repr(read_settings([f"mode={text}"], ()))
        assert repr(read_settings([two], ())) == repr({"mode": [literal(text), 7]})
        assert (one + two).isascii()


def test_rows_are_paged_sorted_and_filtered(workbench: Served, finished: str) -> None:
    path = f"/api/experiments/{finished}/rows"
    page = workbench.get(path, params={"first": 4, "most": 3}).json()
    assert (page["total"], [row["trial"] for row in page["rows"]]) == (24, [4, 5, 6])
    roles = {column["name"]: column["role"] for column in page["columns"]}
    assert (roles["n"], roles["rt"], roles["luck"], roles["trial"], roles["wall_s"]) == ("value", "measure", "measure", "own", "own")
    found = workbench.get(path, params={"where": json.dumps({"n": 5, "participant": "all 2"}), "sort": "luck", "down": True}).json()
    luck = [row["luck"] for row in found["rows"]]
    assert found["total"] == 4
    assert luck == sorted(luck, reverse=True)
    assert {(row["n"], row["participant"]) for row in found["rows"]} == {(5, "all 2")}
    assert workbench.get(path, params={"failed": True}).json()["total"] == 0
    assert workbench.get(path, params={"first": 10**15}).json()["rows"] == []


def test_means_are_those_of_participants(workbench: Served, finished: str) -> None:
    rows = workbench.get(f"/api/experiments/{finished}/rows").json()["rows"]
    answer = workbench.get(f"/api/experiments/{finished}/means", params={"x": "n", "measure": "luck", "by": ["group"]}).json()
    assert [point["at"] for point in answer["points"]] == [[1, "all"], [2, "all"], [5, "all"]]
    for point in answer["points"]:
        of = [[row["luck"] for row in rows if (row["n"], row["participant"]) == (point["at"][0], who)] for who in ("all 1", "all 2")]
        means = [sum(values) / len(values) for values in of]
        assert point["mean"] == pytest.approx(sum(means) / 2)
        assert point["error"] == pytest.approx(abs(means[0] - means[1]) / 2)
        assert (point["participants"], point["trials"]) == (2, 8)
    path = f"/api/experiments/{finished}/means?x=participant&measure=rt"
    alone = workbench.get(path).json()
    assert len(alone["points"]) == 2
    beside, nothing = workbench.get(f"{path}&beside={finished}").json(), {"conditions": 0, "trials": 0}
    assert (beside["left_out"], beside["beside"]["left_out"], beside["apart"]) == (nothing, nothing, [])
    for points in (beside["points"], beside["beside"]["points"]):
        assert [{**point, "mean": pytest.approx(point["mean"])} for point in points] == alone["points"]
    for name in ("none", "..", "..%2Frecordings", "counting_design.py"):
        assert workbench.get(f"{path}&beside={name}").status_code == 404


def test_the_time_of_an_experiment_is_when_it_was_made_also_in_a_folder_of_another_name(tmp_path: Path) -> None:
    folder = tmp_path / "copied"
    folder.mkdir()
    (folder / "experiment.json").touch()
    os.utime(folder / "experiment.json", (1_000_000_000, 1_000_000_000))
    (folder / "report").mkdir()
    assert ExperimentFolder(folder).made == 1_000_000_000


@pytest.mark.slow
def test_a_trial_is_recorded_and_opened(workbench: Served, finished: str) -> None:
    row = workbench.get(f"/api/experiments/{finished}/rows?first=3&most=1").json()["rows"][0]
    name = workbench.post(f"/api/experiments/{finished}/trial", {"number": 3}).json()["recording"]
    assert name.startswith("counting_trial_3-")
    assert workbench.post(f"/api/experiments/{finished}/trial", {"number": 3}).json()["recording"] == name
    summary = workbench.get(f"/api/recordings/{name}").json()
    assert summary["time"] == pytest.approx(row["rt"])
    opened = workbench.post(f"/api/recordings/{name}/open")
    assert opened.status_code == 201, opened.text
    workbench.post(f"/api/sessions/{opened.json()['id']}/close")
    assert workbench.post(f"/api/recordings/{name}/replay").json()["verdict"] == "agrees"
    missing = workbench.post(f"/api/experiments/{finished}/trial", {"number": 24})
    assert (missing.status_code, "from 0 to 23" in missing.text) == (409, True)


@pytest.mark.slow
def test_failed_trials_are_rows_with_their_errors(workbench: Served) -> None:
    name = started(workbench, values={"n": [1], "mode": "fail"}, participants=1, trials=2)
    now = awaited(workbench, name, "finished")
    assert (now["done"], now["failures"], now["changed"]) == (2, 2, {"participants": 1, "trials": 2, "n": [1], "mode": "fail"})
    rows = workbench.get(f"/api/experiments/{name}/rows?failed=true").json()["rows"]
    assert all("cannot count to 1" in row["error"] for row in rows)
    assert len(rows) == 2
    assert workbench.post(f"/api/experiments/{name}/trial", {"number": 0}).status_code == 200  # it shows how far the trial came


def test_the_rate_of_an_experiment_is_that_of_trials_after_each_process_has_loaded_the_model() -> None:
    command: Any = SimpleNamespace(interrupted=False)
    run = RunningExperiment(command, None, 4)
    for done, workers in ((4, 0), (4, 2), (5, 2), (6, 2)):
        run.take(ExperimentProgress(done=done, total=24, failures=0, workers=workers))
        assert (run.summary()["rate"], run.summary()["remaining"]) == (None, None)
    run.take(ExperimentProgress(done=8, total=24, failures=0, workers=2))
    assert run.summary()["rate"] > 0
    assert run.summary()["remaining"] > 0


@pytest.mark.slow
def test_an_experiment_is_stopped_and_continued_while_sessions_go_on(workbench: Served) -> None:
    name = started(workbench, "slow/counting_design.py:counting")
    assert workbench.post(f"/api/experiments/{name}/resume").json()["error"] == "this experiment is already running"
    assert workbench.post(f"/api/experiments/{name}/delete").status_code == 409
    now = awaited(workbench, name, "running", done=20)
    assert now["workers"] == 1
    assert now["model"] == now["facts"]["model"] == "slow/counter.py"
    assert now["rate"] is None or now["rate"] > 0
    session = workbench.post("/api/sessions", {"model": "counting.py", "run": True}).json()["id"]
    workbench.post(f"/api/sessions/{session}/close")
    points = workbench.get(f"/api/experiments/{name}/means?x=n&measure=rt").json()["points"]
    assert sum(point["trials"] for point in points) >= 20
    assert workbench.post(f"/api/experiments/{name}/stop").json() == {"stopping": name}
    workbench.post(f"/api/experiments/{name}/stop")  # a second time changes nothing
    stopped = awaited(workbench, name, "stopped")
    assert 20 <= stopped["done"] < 800
    assert stopped["problem"] is None
    assert workbench.post(f"/api/experiments/{name}/stop").json()["error"] == "this experiment is not running"
    resumed = workbench.post(f"/api/experiments/{name}/resume", {"workers": 2}).json()
    assert (resumed["state"], resumed["done"] >= stopped["done"], resumed["processes"]) == ("running", True, 2)
    assert awaited(workbench, name, "running", done=stopped["done"] + 5)["total"] == 800
    workbench.post(f"/api/experiments/{name}/stop")
    before = awaited(workbench, name, "stopped")["done"]
    workbench.post(f"/api/experiments/{name}/resume", {"workers": 1})
    workbench.post(f"/api/experiments/{name}/stop")
    awaited(workbench, name, "stopped")
    assert workbench.post(f"/api/experiments/{name}/resume").json()["processes"] == 1  # of its last run, not all processors
    assert awaited(workbench, name, "running", done=before + 1)["workers"] == 1
    workbench.post(f"/api/experiments/{name}/stop")
    awaited(workbench, name, "stopped")


@pytest.mark.slow
def test_no_more_than_two_run_at_once_and_sessions_answer_meanwhile(workbench: Served) -> None:
    names = [started(workbench, "slow/counting_design.py:counting") for _ in range(2)]
    refused = workbench.post("/api/experiments", {"design": COUNTING})
    assert (refused.status_code, refused.json()["error"]) == (409, "2 experiments are already running: stop one, or wait for its end")
    # A session goes on beside them.
    for name in names:
        awaited(workbench, name, "running", done=1)
    session = workbench.post("/api/sessions", {"model": "counting.py"}).json()["id"]
    for ticks in (3, 6):
        workbench.post(f"/api/sessions/{session}/command", {"command": {"type": "step", "ticks": 3}})
        while ((now := workbench.get(f"/api/sessions/{session}").json())["state"] or {"tick": 0})["tick"] < ticks:
            assert now["session"]["alive"]
    workbench.post(f"/api/sessions/{session}/close")
    assert [state_of(workbench, name)["state"] for name in names] == ["running"] * 2
    for name in names:
        workbench.post(f"/api/experiments/{name}/stop")
    for name in names:
        awaited(workbench, name, "stopped")
        assert workbench.post(f"/api/experiments/{name}/delete").json()["trash"].startswith(".workbench/trash/")
        assert workbench.get(f"/api/experiments/{name}").status_code == 404


def test_none_starts_while_the_workbench_closes(tmp_path: Path, desk: Desk) -> None:
    experiments = Experiments(desk.sessions(tmp_path))
    desk.do(experiments.close())
    with pytest.raises(ExperimentRunError, match="the workbench is closing"):
        desk.do(experiments.start(StartRequest(design="fan_effect")))


def test_of_two_who_continue_an_experiment_at_once_one_is_refused(tmp_path: Path, desk: Desk, monkeypatch: pytest.MonkeyPatch) -> None:
    folder = tmp_path / ".workbench" / "experiments" / "mine"
    folder.mkdir(parents=True)
    (folder / "experiment.json").write_text("{}", "utf-8")
    started: list[object] = []

    async def slow(*arguments: object) -> ExperimentCommand:
        started.append(arguments)
        await asyncio.sleep(0.01)
        raise OSError("no more processes")

    async def both() -> list[BaseException | None]:
        experiments = Experiments(desk.sessions(tmp_path))
        return await asyncio.gather(*(experiments.resume("mine", None, trust=True) for _ in range(2)), return_exceptions=True)

    monkeypatch.setattr(ExperimentCommand, "start", slow)
    assert [str(problem) for problem in desk.do(both())] == ["no more processes", "this experiment is already running"]
    assert len(started) == 1


def test_an_experiment_is_not_deleted_while_its_report_or_a_recording_is_made(
    tmp_path: Path, desk: Desk, monkeypatch: pytest.MonkeyPatch
) -> None:
    folder = tmp_path / ".workbench" / "experiments" / "mine"
    folder.mkdir(parents=True)
    (folder / "experiment.json").write_text("{}", "utf-8")

    async def refused(work: Coroutine[Any, Any, Any]) -> str:
        with pytest.raises(ExperimentRunError) as error:
            await work
        return str(error.value)

    async def all_at_once() -> None:
        experiments, going = Experiments(desk.sessions(tmp_path)), asyncio.Event()

        async def slow(*_: object) -> ExperimentCommand:
            await going.wait()
            raise OSError("no more processes")

        monkeypatch.setattr(ExperimentCommand, "start", slow)
        for make, what in (
            (lambda: experiments.make_report("mine", trust=True), "its report is being made"),
            (lambda: experiments.record("mine", 3, trust=True), "its trial 3 is being recorded"),
        ):
            going.clear()
            made = asyncio.create_task(make())
            await asyncio.sleep(0)
            assert (await experiments.one("mine"))["work"] == [what]  # which other pages show
            assert await refused(experiments.delete("mine")) == f"{what}: wait for its end, then delete the experiment"
            assert await refused(make()) == f"{what} already: wait for its end"
            going.set()
            with pytest.raises(OSError, match="no more processes"):
                await made
            assert (await experiments.one("mine"))["work"] == []
        assert (await experiments.delete("mine")).startswith(".workbench/trash/")

    desk.do(all_at_once())


@pytest.mark.slow
def test_experiments_end_with_the_workbench_and_go_on_with_the_next(tmp_path: Path) -> None:
    folder = tmp_path / "models"
    folder.mkdir()
    write_experiment(folder, participants=4, trials=200, model=SLOW)
    with served(folder) as first:
        name = started(first)
        awaited(first, name, "running", done=5)
    lock = folder / ".workbench" / "experiments" / name / "lock"
    pid = int(lock.read_text("utf-8").split()[0])
    with pytest.raises(ProcessLookupError):
        os.kill(pid, 0)
    assert (lock.parent / "trials.csv").is_file()  # it has ended normally
    with served(folder) as second:
        now = state_of(second, name)
        assert (now["state"], now["total"], now["done"] >= 5) == ("stopped", 2400, True)
        assert second.post(f"/api/experiments/{name}/resume", {"workers": 1}).json()["state"] == "running"
        awaited(second, name, "running", done=now["done"] + 1)


@pytest.mark.slow
def test_an_experiment_whose_process_is_killed_says_so_and_can_be_continued(workbench: Served) -> None:
    name = started(workbench, "slow/counting_design.py:counting")
    awaited(workbench, name, "running", done=1)
    os.kill(int((workbench.folder / ".workbench/experiments" / name / "lock").read_text("utf-8").split()[0]), signal.SIGKILL)
    assert awaited(workbench, name, "failed")["problem"] == "its process was ended by SIGKILL"
    notes = workbench.folder / ".workbench/experiments" / name / "workbench.json"
    notes.write_text(json.dumps({**json.loads(notes.read_text("utf-8")), "problem": None}), "utf-8")
    assert awaited(workbench, name, "failed")["problem"]  # also where that cannot be noted, such as on a full disk
    assert workbench.post(f"/api/experiments/{name}/resume", {"workers": 1}).json()["problem"] is None
    workbench.post(f"/api/experiments/{name}/stop")
    awaited(workbench, name, "stopped")


def test_code_of_an_experiment_from_elsewhere_runs_only_with_permission(workbench: Served, finished: str) -> None:
    folder = workbench.folder / ".workbench/experiments"
    shutil.copytree(folder / finished, folder / "from-elsewhere")
    described = json.loads((folder / "from-elsewhere/experiment.json").read_text("utf-8"))
    described["model"]["text"] += "\n# changed\n"
    (folder / "from-elsewhere/experiment.json").write_text(json.dumps(described), "utf-8")
    for what, body in (("resume", {}), ("trial", {"number": 0}), ("report", {})):
        assert workbench.post(f"/api/experiments/from-elsewhere/{what}", body).status_code == 403
    code = workbench.get("/api/experiments/from-elsewhere/code").json()
    assert code["made_here"] is False
    assert code["file"].endswith("counting_design.py")
    assert any("# changed" in text for text in code["helpers"].values())
    assert workbench.post("/api/experiments/from-elsewhere/trial", {"number": 0, "trust": True}).status_code == 200
    assert workbench.get("/api/experiments/from-elsewhere/code").json()["made_here"] is True


@pytest.mark.slow
def test_means_of_a_measure_with_several_numbers(workbench: Served) -> None:
    folder = workbench.folder / "numbered"
    folder.mkdir(exist_ok=True)
    model = COUNTER.replace("rt = model.now()", "rt = [n, None, 2.0 * n]")
    path = write_experiment(folder, factors='{"n": [1, 2]}', trials=2, model=model)
    text = path.read_text("utf-8").replace('["rt", "luck"]', '[Measured(name="rt", unit="s", over="block"), "luck"]')
    path.write_text(text.replace("import Design,", "import Design, Measured,"), "utf-8")
    name = started(workbench, "numbered/counting_design.py:counting")
    facts = awaited(workbench, name, "finished")["facts"]
    assert facts["measures"][0] == {"name": "rt", "unit": "s", "meaning": "", "over": "block"}
    path = f"/api/experiments/{name}/means"

    def points(**query: str) -> list[list[Any]]:
        answer = workbench.get(path, params={"measure": "rt", "over": "block", **query}).json()
        assert answer["unit"] == "s"
        return sorted([*point["at"], point["mean"], point["trials"]] for point in answer["points"])

    assert points(x="block") == [[1, 1.5, 8], [3, 3.0, 8]]
    assert points(x="block", by="n") == [[1, 1, 1.0, 4], [1, 2, 2.0, 4], [3, 1, 2.0, 4], [3, 2, 4.0, 4]]
    assert points(x="n") == [[1, 1.5, 8], [2, 3.0, 8]]
    for query, problem in (
        ({"measure": "rt", "x": "n"}, "there is no column 'rt'"),
        ({"measure": "luck", "x": "n", "over": "block"}, "there are no columns 'luck_1', 'luck_2', ... with numbers"),
        ({"measure": "rt", "x": "n", "over": "n"}, "over: must not be the name of a column of the trials (got 'n')"),
    ):
        assert workbench.get(path, params=query).json()["error"] == problem


def test_a_report_is_made_and_shown_without_scripts(workbench: Served, finished: str) -> None:
    path = f"/api/experiments/{finished}/report"
    folder = workbench.folder / ".workbench/experiments" / finished / "report"
    assert state_of(workbench, finished)["report"] is None
    assert workbench.get(f"{path}/index.html").status_code == 404
    assert workbench.post(path, {}).status_code == 200
    made = state_of(workbench, finished)["report"]
    assert made == (folder / "index.html").stat().st_mtime
    answer = workbench.get(f"{path}/index.html")
    assert answer.content == (folder / "index.html").read_bytes()
    assert re.search(r"<script|\bon\w+=|javascript:", answer.text) is None
    files = re.findall(r'href="((?:figures|tables)/[^"]+)"', answer.text)
    assert {file.rpartition(".")[2] for file in files} == {"svg", "png", "csv"}
    for file in files:
        download = workbench.get(f"{path}/{file}")
        assert download.content == (folder / file).read_bytes()
        assert download.headers["content-disposition"] == f'attachment; filename="{finished}-{file.rpartition("/")[2]}"'
    for file in ("../experiment.json", "%2e%2e/experiment.json", "tables/..%2f..%2fexperiment.json", "figures", "tables/none.csv"):
        url = httpx.URL(workbench.url, raw_path=f"{path}/{file}".encode())
        assert workbench.client.get(url).status_code in (404, 422)
    assert answer.headers["content-type"] == "text/html; charset=utf-8"
    policy = answer.headers.get_list("content-security-policy")
    assert len(policy) == 1
    assert "sandbox allow-downloads allow-same-origin" in policy[0].split("; ")
    assert "default-src 'none'" in policy[0]
    (folder / "index.html").unlink()
    (folder / "index.html").symlink_to("/etc/passwd")
    assert workbench.get(f"{path}/index.html").status_code == 404
    shutil.rmtree(folder)
    folder.symlink_to(folder.parent)
    assert workbench.get(f"{path}/index.html").status_code == 404
    folder.unlink()


@pytest.mark.slow
def test_an_experiment_that_cannot_be_written_is_shown_with_its_report(workbench: Served, finished: str) -> None:
    own = workbench.folder / ".workbench"
    folder, made = own / "experiments" / "archived", own / "reports" / "archived"
    shutil.copytree(own / "experiments" / finished, folder)
    shutil.rmtree(folder / "report", ignore_errors=True)
    for path in (*folder.iterdir(), folder):
        path.chmod(0o555 if path.is_dir() else 0o444)
    now = state_of(workbench, "archived")
    assert (now["state"], now["done"], now["report"]) == ("finished", 24, None)
    path = "/api/experiments/archived"
    assert workbench.get(f"{path}/rows").json()["total"] == 24
    assert len(workbench.get(f"{path}/means?x=n&measure=rt").json()["points"]) == 3
    answer = workbench.post(f"{path}/report", {"trust": True})
    assert answer.status_code == 200, answer.text
    assert state_of(workbench, "archived")["report"] == (made / "index.html").stat().st_mtime
    assert workbench.get(f"{path}/report/index.html").content == (made / "index.html").read_bytes()
    assert not (folder / "report").exists()
    assert workbench.post(f"{path}/trial", {"number": 1, "trust": True}).status_code == 200
    deleted = workbench.post(f"{path}/delete")
    assert deleted.status_code == 200
    assert (folder.exists(), made.exists()) == (False, False)
    assert workbench.post("/api/restore", deleted.json()).json() == {"restored": ".workbench/experiments/archived"}
    assert (state_of(workbench, "archived")["done"], (made / "index.html").is_file()) == (24, True)
    assert workbench.post(f"{path}/delete").status_code == 200


@pytest.mark.slow
def test_errors_of_a_report_do_not_show_where_the_server_stores_it(workbench: Served, finished: str) -> None:
    report = workbench.folder / ".workbench" / "experiments" / finished / "report"
    kept = report.rename(report.with_name("kept")) if report.exists() else None
    report.mkdir(parents=True)
    (report / "mine.txt").touch()
    answer = workbench.post(f"/api/experiments/{finished}/report", {})
    assert answer.status_code == 409
    says = f"'.workbench/experiments/{finished}/report' holds 'mine.txt', which a new report would replace; move it away"
    assert answer.json() == {"error": says}
    shutil.rmtree(report)
    if kept is not None:
        kept.rename(report)


@pytest.mark.parametrize(
    "name", ["..", "..%2Frecordings", "%2e%2e", "..%2F..%2Fmodels", ".hidden", "a" * 155, "x\0y", "counting_design.py"]
)
def test_names_that_lead_elsewhere_are_not_found(workbench: Served, name: str) -> None:
    outside = workbench.folder / ".workbench" / "experiment.json"
    outside.parent.mkdir(exist_ok=True)
    outside.write_text("{}", "utf-8")
    quoted = name.replace("\0", "%00")
    for what in ("", "/rows", "/means?x=n&measure=rt", "/report/index.html", "/code"):
        url = httpx.URL(workbench.url, raw_path=f"/api/experiments/{quoted}{what}".encode())
        assert workbench.client.get(url).status_code in (404, 422)
    outside.unlink()


def test_a_folder_that_is_a_link_is_no_experiment(workbench: Served, finished: str, tmp_path: Path) -> None:
    folder = workbench.folder / ".workbench/experiments"
    shutil.copytree(folder / finished, tmp_path / "elsewhere")
    (folder / "linked").symlink_to(tmp_path / "elsewhere")
    assert workbench.get("/api/experiments/linked").status_code == 404
    assert "linked" not in [one["id"] for one in workbench.get("/api/experiments").json()["experiments"]]
    (folder / "linked").unlink()


REFUSED: list[tuple[dict[str, Any], int]] = [
    ({}, 422),
    ({"design": "nothing_like_this"}, 404),
    ({"design": "--help"}, 404),
    ({"design": "/etc/passwd:x"}, 400),
    ({"design": "../counting_design.py:counting"}, 400),
    ({"design": "counting_design.py:other"}, 404),
    ({"design": "counting_design.py:__import__"}, 404),
    ({"design": COUNTING, "values": {"n; import os": 1}}, 422),
    ({"design": COUNTING, "values": {"n": []}}, 422),
    ({"design": COUNTING, "values": {"n": [[1]]}}, 422),
    ({"design": COUNTING, "values": {"n": "x" * 1001}}, 422),
    ({"design": COUNTING, "participants": 0}, 422),
    ({"design": COUNTING, "trials": -1}, 422),
    ({"design": COUNTING, "workers": 10_000}, 422),
    ({"design": COUNTING, "scheduler": "tcp://elsewhere:1"}, 422),
]


def test_what_cannot_be_started_is_refused(workbench: Served) -> None:
    before = len(workbench.get("/api/experiments").json()["experiments"])
    for body, status in REFUSED:
        answer = workbench.post("/api/experiments", body)
        assert (answer.status_code, isinstance(answer.json()["error"], str)) == (status, True), body
    assert len(workbench.get("/api/experiments").json()["experiments"]) == before


@pytest.mark.parametrize(
    ("query", "status"),
    [
        ("rows?sort=nothing", 409),
        ("rows?sort=n%27%29%3B%20DROP%20TABLE%20trial%3B%20--", 409),
        ("rows?where=%7B%22n%27%29%20OR%20%281%22%3A1%7D", 409),
        ("rows?where=nothing", 409),
        ("rows?where=%5B1%5D", 409),
        ("rows?where=%7B%22n%22%3A%7B%7D%7D", 409),
        ("rows?where=%7B%22n%22%3A1e999%7D", 409),
        ("rows?where=%7B%22n%22%3A99999999999999999999%7D", 200),
        ("rows?most=100000", 422),
        ("rows?first=-1", 422),
        ("means?x=n", 422),
        ("means?x=n&measure=participant", 409),
        ("means?x=n%22&measure=rt", 409),
        ("means?x=n&measure=rt&by=a&by=b&by=c&by=d&by=e", 422),
    ],
)
def test_odd_questions_get_an_answer_and_change_nothing(workbench: Served, finished: str, query: str, status: int) -> None:
    answer = workbench.get(f"/api/experiments/{finished}/{query}")
    assert answer.status_code == status, answer.text
    assert workbench.get(f"/api/experiments/{finished}/rows?most=1").json()["total"] == 24


@pytest.mark.slow
def test_an_experiment_of_the_command_line_is_shown_with_its_facts(workbench: Served, tmp_path: Path) -> None:
    path = write_experiment(tmp_path, trials=1)
    folder = workbench.folder / ".workbench/experiments" / "by-hand"
    options = ["--set", "n=[2, 3]", "--participants", "1", "--workers", "1", "--out", str(folder)]
    subprocess.run([sys.executable, "-m", "actr3d", "experiment", str(path), *options], check=True, capture_output=True)
    now = state_of(workbench, "by-hand")
    assert (now["state"], now["name"], now["total"], now["done"]) == ("finished", "counting", 2, 2)
    assert now["changed"] == {"participants": 1, "n": [2, 3]}
    assert now["facts"]["factors"] == {"n": [2, 3]}
    shutil.rmtree(folder)


def test_a_folder_with_damaged_files_is_listed_and_read_with_an_error(workbench: Served) -> None:
    folder = workbench.folder / ".workbench/experiments" / "damaged"
    folder.mkdir(parents=True)
    (folder / "experiment.json").write_bytes(b"\xff not JSON")
    (folder / "workbench.json").write_text('{"seal": 1}', "utf-8")
    (folder / "facts.json").write_text('{"event": "facts", "name": 1}', "utf-8")
    (folder / "trials.sqlite").write_bytes(b"no database" * 100)
    now = state_of(workbench, "damaged")
    assert (now["state"], now["total"], now["name"]) == ("failed", None, "damaged")
    assert now["problem"].startswith("its table cannot be read: ")
    assert workbench.get("/api/experiments/damaged/rows").status_code == 409
    assert workbench.get("/api/experiments/damaged/code").status_code == 409
    assert workbench.post("/api/experiments/damaged/resume", {"trust": True}).status_code == 422
    shutil.rmtree(folder)


@pytest.mark.parametrize("name", ["trial", "column"])
def test_a_table_that_is_an_endless_view_is_not_read(workbench: Served, name: str) -> None:
    folder = workbench.folder / ".workbench/experiments" / "endless"
    folder.mkdir(parents=True)
    (folder / "experiment.json").write_text("{}", "utf-8")
    with closing(sqlite3.connect(folder / "trials.sqlite")) as file:
        for table in {"trial", "column"} - {name}:
            file.execute(f"CREATE TABLE {table} (number, data, name, place, type, unit, meaning)")
        endless = "WITH RECURSIVE n(x) AS (SELECT 1 UNION ALL SELECT x + 1 FROM n) SELECT x AS number, x AS name, x AS place FROM n"
        file.execute(f"CREATE VIEW {name} AS {endless}")
    now = state_of(workbench, "endless")
    assert (now["state"], now["problem"]) == ("failed", "its table cannot be read: it has other tables than an experiment")
    assert workbench.get("/api/experiments/endless/rows").status_code == 409
    shutil.rmtree(folder)


def test_a_table_that_ends_its_worker_does_not_hide_other_experiments(tmp_path: Path, desk: Desk, monkeypatch: pytest.MonkeyPatch) -> None:
    sessions = desk.sessions(tmp_path)
    for name in ("good", "bad", "better"):
        folder = tmp_path / ".workbench/experiments" / name
        folder.mkdir(parents=True)
        (folder / "experiment.json").write_text("{}", "utf-8")
        (folder / "trials.sqlite").write_bytes(b"")

    async def make(kind: str, *tables: Path) -> io.BytesIO:
        if any(table.parent.name == "bad" for table in tables):
            raise ReadingError("no progress for 120 s")
        return io.BytesIO(json.dumps([{"done": 3, "failures": 0, "problem": None, "columns": []} for _ in tables]).encode())

    monkeypatch.setattr(sessions.readers, "make", make)
    found = {one["id"]: (one["done"], one["problem"]) for one in desk.do(Experiments(sessions).listing())[1]}
    assert found == {"good": (3, None), "better": (3, None), "bad": (0, "its table cannot be read: no progress for 120 s")}


def test_of_more_experiments_than_a_list_has_the_newest_are_listed_with_the_number_of_all(
    tmp_path: Path, desk: Desk, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(experiments, "MAX_LISTED", 2)
    for number in range(3):
        (folder := tmp_path / ".workbench" / "experiments" / f"sums-2026010{number + 1}-101010-abcd").mkdir(parents=True)
        (folder / "experiment.json").write_text("{}", "utf-8")
    total, listed = desk.do(Experiments(desk.sessions(tmp_path)).listing())
    assert (total, [one["id"][:13] for one in listed]) == (3, ["sums-20260103", "sums-20260102"])


def test_a_missing_package_is_named(desk: Desk, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    packages = tmp_path / "packages"
    packages.mkdir()
    (packages / "distributed.py").write_text("raise ModuleNotFoundError('no', name='distributed')\n", "utf-8")
    folder = tmp_path / "models"
    folder.mkdir()
    write_experiment(folder)
    monkeypatch.setenv("PYTHONPATH", str(packages))
    body = json.dumps({"design": COUNTING}).encode()
    answer = desk.ask(folder, "/api/experiments", JSON, ORIGIN, OURS, method="POST", body=body)
    assert (answer.status, json.loads(answer.body)["error"].endswith("install: pip install 'actr3d[experiment]'")) == (422, True)
    assert json.loads(desk.ask(folder, "/api/experiments").body) == {"total": 0, "experiments": []}


def test_a_file_beside_the_models_does_not_stand_in_for_a_package(workbench: Served) -> None:
    (workbench.folder / "rich.py").write_text("raise SystemExit('not this one')\n", "utf-8")
    assert workbench.post("/api/designs/check", {"design": COUNTING, "trials": 99}).json()["trials"] == 594
    (workbench.folder / "rich.py").unlink()
