"""Experiments on a cluster: the same rows for any number of workers, whoever is ended meanwhile, at any moment."""

from __future__ import annotations

import csv
import io
import os
import random
import re
import signal
import subprocess
import sys
import threading
import time
from collections.abc import Generator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager, nullcontext
from dataclasses import replace
from itertools import groupby, pairwise
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from distributed import KilledWorker

from actr3d.cli import main
from actr3d.errors import ExperimentError
from actr3d.experiment import cluster
from actr3d.experiment import table as table_of_trials
from actr3d.experiment.cluster import (
    ExperimentProgress,
    cluster_versions,
    end_processes,
    existing_cluster,
    local_cluster,
    run_batch,
    run_experiment,
)
from actr3d.experiment.specification import specify
from actr3d.experiment.store import Store
from actr3d.experiment.table import export
from actr3d.experiment.versions import SOURCES, folder_digest
from actr3d.replacing import replacing
from tests.helpers.experiments import COUNTER, SLOW_COUNTER, trial_processes, write_experiment
from tests.helpers.reports import store_rows

pytestmark = pytest.mark.long

COMMAND = [sys.executable, "-m", "actr3d", "experiment"]
UNREPRODUCIBLE = ("wall_s", "worker")
KILLS = 20 if os.environ.get("EXPLORE") else 1
"""How often a test ends processes at random moments; with EXPLORE=1 as often as has been promised, which takes minutes."""


@pytest.fixture(scope="module")
def client() -> Generator[Any]:
    with local_cluster(2) as found:
        yield found


def table(folder: Path) -> str:
    """Returns the table of an experiment without what is not reproducible."""
    with Store(folder) as store:
        export(store)
    out = io.StringIO()
    rows = list(csv.DictReader(io.StringIO((folder / "trials.csv").read_text(encoding="utf-8"))))
    writer = csv.DictWriter(out, [name for name in rows[0] if name not in UNREPRODUCIBLE], extrasaction="ignore")
    writer.writeheader()
    writer.writerows(rows)
    return out.getvalue()


def run_here(client: Any, path: Path, folder: Path, **options: Any) -> str:
    experiment = specify(str(path))
    with Store.create(folder, experiment.specification) as store:
        run_experiment(experiment, store, client, **options)
    return table(folder)


def reference(path: Path, folder: Path) -> str:
    """Returns the table of an experiment that ran through on one worker."""
    assert main(["experiment", str(path), "--out", str(folder), "--workers", "1"]) == 0
    return table(folder)


def test_rows_are_the_same_for_any_number_of_workers(tmp_path: Path, client: Any) -> None:
    path = write_experiment(tmp_path, participants=4, trials=10)
    seen: list[ExperimentProgress] = []
    assert run_here(client, path, tmp_path / "two", show=seen.append) == reference(path, tmp_path / "one")
    assert (seen[0].done, seen[-1].done, seen[-1].total, seen[-1].failures) == (0, 120, 120, 0)
    batches = [after.done - before.done for before, after in pairwise(seen)]
    assert max(batches) > 4
    assert batches[-1] < max(batches)  # so that no worker waits long for the last one


def test_failures_are_rows_and_the_rest_goes_on(tmp_path: Path, client: Any) -> None:
    factors = '{"mode": ["count", "fail", "hang", "die"]}'
    waiting = COUNTER.replace("        pass", "        __import__('time').sleep(60)")  # to hang by computing is in test_trials.py
    path = write_experiment(tmp_path, factors=factors, participants=1, trials=1, limit=1, model=waiting)
    seen: list[ExperimentProgress] = []
    rows = csv.DictReader(io.StringIO(run_here(client, path, tmp_path / "out", show=seen.append)))
    ends = sorted((row["mode"], row["end"]) for row in rows)
    assert ends == sorted([("count", "end"), ("fail", "error"), ("hang", "time limit"), ("die", "crash")])
    assert seen[-1].failures == 3


def test_a_trial_whose_drawn_values_cannot_be_derived_is_a_failure_among_others(tmp_path: Path, client: Any) -> None:
    path = write_experiment(tmp_path, factors='{"mode": ["count"]}', participants=1, trials=12)
    settings = "settings={'a': Uniform(low=0, high=1), 'b': Uniform(low=0, high=1)}"
    more = f"limit=60, {settings}, derive=lambda v: {{'n': math.ceil(math.sqrt(v['a'] - v['b']))}}"
    path.write_text(f"import math\n{path.read_text(encoding='utf-8').replace('limit=60', more)}", encoding="utf-8")
    rows = list(csv.DictReader(io.StringIO(run_here(client, path, tmp_path / "out"))))
    assert [row["trial"] for row in rows] == [str(number) for number in range(12)]
    for row in rows:
        impossible = float(row["a"]) < float(row["b"])
        assert row["end"] == ("error" if impossible else "end")
        assert ("Design.derive: failed with" in row["error"]) == impossible
    assert len({row["end"] for row in rows}) == 2


def test_a_run_that_is_stopped_continues_where_it_was(tmp_path: Path, client: Any) -> None:
    path = write_experiment(tmp_path, participants=2, trials=12, model=SLOW_COUNTER)
    experiment, stop = specify(str(path)), threading.Event()
    counts: list[int] = []

    def show(progress: ExperimentProgress) -> None:
        counts.append(progress.done)
        if progress.done > 5:
            stop.set()

    with Store.create(tmp_path / "out", experiment.specification) as store:
        run_experiment(experiment, store, client, show=show, stop=stop)
        assert 5 < store.count < 72
        before = {row["trial"]: row["wall_s"] for row in store.rows()}
        run_experiment(experiment, store, client)
        after = {row["trial"]: row["wall_s"] for row in store.rows()}
    assert before.items() <= after.items(), "a trial that had finished ran again"
    assert len(after) == 72


@pytest.mark.slow
def test_a_batch_that_takes_long_returns_its_rows_and_the_rest_is_another(
    tmp_path: Path, client: Any, monkeypatch: pytest.MonkeyPatch
) -> None:
    path = write_experiment(tmp_path, participants=1, trials=8)
    expected = run_here(client, path, tmp_path / "usual")
    monkeypatch.setattr(cluster, "LONGEST_BATCH", 0.0)
    try:
        batch = run_batch(specify(str(path)).specification.to_json(), [3, 4, 5], 60, cluster_versions(), str(path))
    finally:
        end_processes(str(path))
    assert [number for number, _, _ in batch.rows] == [3]
    seen: list[ExperimentProgress] = []
    assert run_here(client, path, tmp_path / "short", show=seen.append) == expected
    assert [done for done, _ in groupby(progress.done for progress in seen)] == list(range(25))
    assert all(before != after for before, after in pairwise(seen)), "a worker that comes or goes is news, too"


def test_batches_that_have_finished_are_kept_when_a_run_is_stopped(tmp_path: Path, client: Any) -> None:
    experiment, stop = specify(str(write_experiment(tmp_path, factors='{"n": [1]}', participants=1, trials=4))), threading.Event()

    def stop_once_all_have_finished(progress: ExperimentProgress) -> None:
        while progress.done and not all(future.status == "finished" for future in client.futures.values()):
            time.sleep(0.02)
        if progress.done:
            stop.set()

    with Store.create(tmp_path / "out", experiment.specification) as store:
        run_experiment(experiment, store, client, show=stop_once_all_have_finished, stop=stop)
        assert store.count == 4


def test_an_experiment_that_cannot_be_loaded_on_a_worker_says_why(tmp_path: Path, client: Any) -> None:
    path = write_experiment(tmp_path)
    path.write_text(path.read_text() + "\nimport os\nif os.environ.get('PYTHONHASHSEED') == '0':\n    raise RuntimeError('not here')\n")
    with pytest.raises(ExperimentError, match="RuntimeError: not here"):
        run_here(client, path, tmp_path / "out")


def test_workers_with_other_versions_are_refused(tmp_path: Path) -> None:
    text = specify(str(write_experiment(tmp_path))).specification.to_json()
    with pytest.raises(
        ExperimentError, match=r"worker \d+: has other versions: mujoco \S+ \(the client has 1\.2\.3\); install the same on both"
    ):
        run_batch(text, [0], 60, {**cluster_versions(), "mujoco": "1.2.3"})


def test_a_changed_file_of_the_library_is_another_version(tmp_path: Path) -> None:
    assert {"numba", "scipy", "trimesh", "mujoco", SOURCES} <= specify(str(write_experiment(tmp_path))).specification.versions.keys()
    library = tmp_path / "library"
    (library / "__pycache__").mkdir(parents=True)
    (library / "code.py").write_text("x = 1")
    before = folder_digest(library)
    (library / "__pycache__" / "code.pyc").write_text("compiled")
    assert folder_digest(library) == before
    (library / "code.py").write_text("x = 2")
    assert folder_digest(library) != before


def waiting_experiment(folder: Path, begun: Path, enough: Path) -> str:
    """Returns, as JSON, an experiment whose trials write the numbers of their processes into a file, and then wait for another file."""
    lines = ["import os, time", f"with open({str(begun)!r}, 'a') as file:", "    print(os.getpid(), file=file)"]
    lines += [f"while not os.path.exists({str(enough)!r}):", "    time.sleep(0.02)"]
    waiting = COUNTER.replace("model.run()", "\n".join([*lines, "model.run()"]))
    return specify(str(write_experiment(folder, model=waiting))).specification.to_json()


def test_a_client_that_leaves_ends_no_process_of_another(tmp_path: Path) -> None:
    begun, enough = tmp_path / "begun", tmp_path / "enough"
    text = waiting_experiment(tmp_path, begun, enough)
    with ThreadPoolExecutor(1) as pool:
        batch = pool.submit(run_batch, text, [0], 60, cluster_versions(), "one")
        while not (begun.exists() and begun.read_text()) and not batch.done():
            time.sleep(0.02)
        end_processes("another")
        enough.touch()
        assert batch.result(60).rows[0][1]["end"] == "end"
    (process,) = map(int, begun.read_text().split())  # the trial began once
    assert process in trial_processes()
    end_processes("one")
    assert process not in trial_processes()


def test_a_trial_whose_client_leaves_does_not_begin_again(tmp_path: Path) -> None:
    begun = tmp_path / "begun"
    text = waiting_experiment(tmp_path, begun, tmp_path / "never")
    with ThreadPoolExecutor(1) as pool:
        batch = pool.submit(run_batch, text, [0], 60, cluster_versions(), "leaving")
        while not (begun.exists() and begun.read_text()) and not batch.done():
            time.sleep(0.02)
        end_processes("leaving")
        with pytest.raises(ExperimentError, match="the experiment was stopped"):
            batch.result(60)
    assert len(begun.read_text().split()) == 1


def test_a_trial_that_ends_its_workers_again_and_again_is_a_failure_and_the_rest_goes_on(tmp_path: Path, client: Any) -> None:
    path = write_experiment(tmp_path, factors='{"n": [1]}', participants=1, trials=6)
    submit, tried = client.submit, list[list[int]]()

    def submit_or_kill(function: Any, specification: str, numbers: list[int], *given: Any, **options: Any) -> Any:
        tried.append(numbers)
        return submit(kill if 3 in numbers else function, specification, numbers, *given, **options)

    def kill(*_: Any) -> None:
        raise KilledWorker("trial", SimpleNamespace(address="tcp://one"), 3)  # pyright: ignore[reportArgumentType]

    client.submit = submit_or_kill
    try:
        rows = list(csv.DictReader(io.StringIO(run_here(client, path, tmp_path / "out"))))
    finally:
        del client.submit
    assert [row["end"] for row in rows] == ["end"] * 3 + ["crash"] + ["end"] * 2
    assert "the workers that ran this trial ended repeatedly" in rows[3]["error"]
    assert tried.count([3]) == 1 + cluster.KILLS  # first beside others, which does not count
    assert tried[-cluster.KILLS :] == [[3]] * cluster.KILLS
    assert rows[3]["seed"] == "1 all 1 n=1 4"


def test_no_trial_is_blamed_for_workers_that_are_ended_from_outside(tmp_path: Path, client: Any) -> None:
    path = write_experiment(tmp_path, factors='{"n": [1]}', participants=1, trials=6)
    submit, submitted = client.submit, list[tuple[list[int], int]]()

    def submit_or_kill(function: Any, specification: str, numbers: list[int], *given: Any, **options: Any) -> Any:
        others = sum(future.status == "pending" for future in client.futures.values())
        submitted.append((numbers, others))
        return submit(kill if len(submitted) <= 6 * cluster.KILLS else function, specification, numbers, *given, **options)

    def kill(*_: Any) -> None:
        raise KilledWorker("trial", SimpleNamespace(address="tcp://one"), 3)  # pyright: ignore[reportArgumentType]

    client.submit = submit_or_kill
    try:
        found = run_here(client, path, tmp_path / "out")
    finally:
        del client.submit
    assert found == run_here(client, path, tmp_path / "whole")
    rounds = [sorted(number for numbers, _ in submitted[n : n + 6] for number in numbers) for n in range(0, len(submitted), 6)]
    assert rounds == [[*range(6)]] * (1 + cluster.KILLS), "a suspect does not go to the end of the queue"
    assert not any(others for _, others in submitted[6:]), "a suspect was not alone"


def test_no_scheduler_is_an_error(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(cluster, "PATIENCE", 1.0)
    with (
        pytest.raises(ExperimentError, match=r"--scheduler: no scheduler answers at 'tcp://127\.0\.0\.1:9'"),
        existing_cluster("tcp://127.0.0.1:9"),
    ):
        pass


@pytest.mark.slow
def test_a_scheduler_that_does_not_answer_leaves_no_folder(tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: Any) -> None:
    monkeypatch.setattr(cluster, "PATIENCE", 1.0)
    out = tmp_path / "out"
    assert main(["experiment", str(write_experiment(tmp_path)), "--out", str(out), "--scheduler", "tcp://127.0.0.1:9"]) == 1
    assert "no scheduler answers" in capsys.readouterr().err
    assert not out.exists()


# -- processes that are ended


@pytest.mark.slow
def test_no_row_changes_if_the_command_is_killed_at_any_moment(tmp_path: Path, client: Any) -> None:
    path = write_experiment(tmp_path, participants=2, trials=30 * KILLS, model=SLOW_COUNTER)
    expected = run_here(client, path, tmp_path / "whole")
    dice = random.Random(KILLS)
    kept: dict[int, float] = {}
    killed: list[int] = []
    command = [*COMMAND, str(path), "--out", str(tmp_path / "out"), "--resume"]
    for _ in range(KILLS):
        process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
        try:
            process.wait(dice.uniform(2, 6))
        except subprocess.TimeoutExpired:
            process.kill()
            process.wait()
            killed.append(process.pid)
        if (tmp_path / "out" / "experiment.json").exists():
            with Store(tmp_path / "out") as store:
                now = {row["trial"]: row["wall_s"] for row in store.rows()}
            assert kept.items() <= now.items()
            kept = now
    assert len(killed) == KILLS, "the experiment ended before"
    done = subprocess.run(command, timeout=600, capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    assert table(tmp_path / "out") == expected


@contextmanager
def a_cluster(port: int) -> Generator[Any]:
    """Starts a scheduler and a worker as on any cluster, and ends them; yields the scheduler."""
    quiet: Any = {"stdout": subprocess.DEVNULL, "stderr": subprocess.DEVNULL, "start_new_session": True}
    address = ["--host", "127.0.0.1", "--port", str(port), "--no-dashboard"]
    scheduler = subprocess.Popen([sys.executable, "-m", "distributed.cli.dask_scheduler", *address], **quiet)
    options = ["--nthreads", "1", "--no-dashboard", "--host", "127.0.0.1", "--death-timeout", "30"]
    worker = subprocess.Popen([sys.executable, "-m", "distributed.cli.dask_worker", f"tcp://127.0.0.1:{port}", *options], **quiet)
    try:
        yield scheduler
    finally:
        for process in (worker, scheduler):
            os.killpg(process.pid, signal.SIGKILL)
            process.wait()


@pytest.mark.slow
def test_no_row_changes_if_workers_are_killed_at_any_moment(tmp_path: Path, client: Any, unused_port: int) -> None:
    path = write_experiment(tmp_path, participants=2, trials=20 * KILLS, model=SLOW_COUNTER)
    dice = random.Random(KILLS)
    killed: list[int] = []
    with a_cluster(unused_port), existing_cluster(f"tcp://127.0.0.1:{unused_port}") as own:
        begun, over = threading.Event(), threading.Event()

        def kill() -> None:
            begun.wait(60)
            while len(killed) < KILLS and not over.wait(dice.uniform(0, 1)):
                workers = list(own.run(os.getpid, on_error="ignore").values())
                if workers:
                    killed.append(dice.choice(workers))
                    os.kill(killed[-1], signal.SIGKILL)

        def begin_once_a_trial_is_done(progress: ExperimentProgress) -> None:
            if progress.done:
                begun.set()

        killer = threading.Thread(target=kill)
        killer.start()
        try:
            found = run_here(own, path, tmp_path / "out", show=begin_once_a_trial_is_done)
        finally:
            begun.set()
            over.set()
            killer.join()
    assert len(killed) == KILLS, "the experiment ended before"
    assert found == run_here(client, path, tmp_path / "whole")


def test_a_run_that_is_stopped_does_not_wait_for_a_trial_that_hangs(tmp_path: Path) -> None:
    begun = tmp_path / "begun"
    hanging = COUNTER.replace("    while True:", f"    open({str(begun)!r}, 'w').close()\n    while True:")
    path = write_experiment(tmp_path, factors='{"mode": ["hang"]}', participants=1, trials=3, limit=600, model=hanging)
    before, stop = trial_processes(), threading.Event()

    def stop_once_it_hangs() -> None:
        while not begun.exists():
            time.sleep(0.02)
        stop.set()

    threading.Thread(target=stop_once_it_hangs).start()
    with local_cluster(2) as own, Store.create(tmp_path / "out", specify(str(path)).specification) as store:
        run_experiment(specify(str(path)), store, own, stop=stop)
        assert store.count == 0
    assert trial_processes() == before


@pytest.mark.slow
def test_no_row_changes_if_the_scheduler_is_killed(tmp_path: Path, client: Any, unused_port: int) -> None:
    path = write_experiment(tmp_path, participants=2, trials=10 + 10 * KILLS, model=SLOW_COUNTER)
    dice = random.Random(KILLS)
    command = [*COMMAND, str(path), "--out", str(tmp_path / "out"), "--resume", "--scheduler", f"tcp://127.0.0.1:{unused_port}"]
    for _ in range(KILLS):
        with a_cluster(unused_port) as scheduler:
            process = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
            before = _rows(tmp_path / "out")
            deadline = time.monotonic() + 60
            while _rows(tmp_path / "out") == before and process.poll() is None and time.monotonic() < deadline:
                time.sleep(0.1)
            time.sleep(dice.uniform(0, 1))
            scheduler.kill()
            _, said = process.communicate(timeout=120)
            assert process.returncode == 1
            assert "error: the scheduler is gone" in said
            assert "continue with --resume" in said
            assert "another exception" not in said
            assert "distributed" not in said
    with a_cluster(unused_port):
        assert subprocess.run(command, timeout=120, capture_output=True).returncode == 0
    assert table(tmp_path / "out") == run_here(client, path, tmp_path / "whole")


@pytest.mark.parametrize("reports", [1, 2])
def test_a_client_that_is_closed_at_any_moment_has_lost_the_scheduler(tmp_path: Path, reports: int) -> None:
    path = write_experiment(tmp_path, participants=2, trials=4)
    heard: list[ExperimentProgress] = []
    with local_cluster(1) as here:
        client: Any = here

        def close(progress: ExperimentProgress) -> None:
            heard.append(progress)
            if len(heard) == reports:
                client.close()

        with pytest.raises(ExperimentError, match=r"the scheduler is gone; \d+ of \d+ trials are kept; continue with --resume"):
            run_here(client, path, tmp_path / "out", show=close)
    assert len(heard) == reports


def _rows(folder: Path) -> int:
    if not (folder / "experiment.json").exists():
        return 0
    with Store(folder) as store:
        return store.count


@pytest.fixture
def unused_port() -> int:
    import socket

    with socket.socket() as found:
        found.bind(("127.0.0.1", 0))
        return found.getsockname()[1]


def test_ctrl_c_ends_an_experiment_at_once_and_in_order(tmp_path: Path) -> None:
    path = write_experiment(tmp_path, participants=2, trials=2000, model=SLOW_COUNTER)
    command = [*COMMAND, str(path), "--out", str(tmp_path / "out")]
    (folder := tmp_path / "temporary").mkdir()  # of the processes that run trials, whose arguments name it
    process = subprocess.Popen(
        command,
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
        start_new_session=True,
        env={**os.environ, "TMPDIR": str(folder)},
    )

    def left() -> list[str]:
        return subprocess.run(["pgrep", "-f", str(folder)], capture_output=True, text=True).stdout.split()

    deadline = time.monotonic() + 60
    while _rows(tmp_path / "out") == 0 and time.monotonic() < deadline:
        time.sleep(0.1)
    assert left()
    os.killpg(process.pid, signal.SIGINT)
    out, said = process.communicate(timeout=60)
    assert process.returncode == 130
    assert said == ""
    assert f"stopped after {_rows(tmp_path / 'out'):,} of 12,000 trials; continue with: actr3d experiment" in out
    while left() and time.monotonic() < deadline:
        time.sleep(0.1)
    assert left() == []
    assert not [*folder.glob("actr3d-*")]


# -- the command


def test_the_command_says_what_is_wrong(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = write_experiment(tmp_path)
    out = str(tmp_path / "out")
    Store.create(out, specify(str(path)).specification).close()
    for arguments, code, says in (
        ([str(path), "--out", out], 1, "holds an experiment already; continue it with --resume"),
        (
            [str(path), "--out", out, "--resume", "--trials", "3"],
            1,
            "is another experiment: --trials: 4 there, 3 now; choose another --out, delete the folder, or continue",
        ),
        ([out, "--trials", "3"], 1, "is an experiment, whose design is fixed; name a design to run it with other values"),
        ([out, "--workers", "2"], 1, "is an experiment; continue it with --resume"),
        (["nothing"], 1, "no design, file or folder 'nothing'"),
        ([f"{path.parent}/countin_design.py"], 1, f"countin_design.py'; did you mean '{path}'? The library has: "),
        ([out, "--check"], 1, f"'{out}' is a folder; name a design, or a file with one"),
        ([str(path), "--any-version"], 2, "--any-version: is for an experiment that is continued; add --resume"),
        ([str(path), "--set", "m=3"], 2, "--set m: Design: the model has no parameter 'm'"),
        ([str(path), "--set", "n="], 2, "--set n: Design, all 1: n: must be a value such as 3, not an empty text"),
        ([str(path), "--set", "m"], 2, "a parameter is set by name=value (got 'm')"),
    ):
        assert main(["experiment", *arguments]) == code
        assert says in capsys.readouterr().err
    for command in (["experiment", str(path)], ["fit", str(path), "--parameter", "n=1..3"]):
        with pytest.raises(SystemExit, match="2"):
            main([*command, "--workers", "2", "--scheduler", "tcp://127.0.0.1:1"])
        assert "argument --scheduler: not allowed with argument --workers" in capsys.readouterr().err
    assert main(["experiment", out]) == 0
    assert "counting: 0 of 24 trials have finished\n" in capsys.readouterr().out


def test_an_experiment_is_continued_where_its_files_were_moved_to(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    first, second = tmp_path / "first", tmp_path / "second"
    first.mkdir()
    (first / "more.txt").write_text("1", encoding="utf-8")
    reads = f"{COUNTER}from pathlib import Path\nluck = int(Path(__file__).with_name('more.txt').read_text())\n"
    write_experiment(first, participants=1, trials=1, model=reads)
    monkeypatch.chdir(first)
    Store.create("out", specify("counting_design.py").specification).close()
    first.rename(second)
    monkeypatch.chdir(tmp_path)
    again = ["experiment", "second/counting_design.py", "--out", "second/out", "--resume", "--workers", "1"]
    assert main([*again, "--set", "n=1,2"]) == 1
    says = "'second/out' is another experiment: n: [1, 2, 5] there, [1, 2] now; choose another --out, delete the folder, or continue it"
    assert says in capsys.readouterr().err
    assert main(again) == 0
    with Store("second/out") as store:
        assert [(row["luck"], row["error"]) for row in store.rows()] == [(1, None)] * 3
    capsys.readouterr()
    (second / "counter.py").write_text(reads.replace("Counts to a number", "Counts"), encoding="utf-8")
    assert main(again) == 1
    assert "is another experiment: the model differs from line 1 on (second/counter.py); choose another" in capsys.readouterr().err


def test_an_experiment_is_continued_however_the_same_design_is_asked_for(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = str(write_experiment(tmp_path, participants=2, trials=1))

    def resumed(folder: Path, *options: str) -> str:
        """Returns the error of a command that continues an experiment whose trials have finished; "" for none."""
        code = main(["experiment", path, "--out", str(folder), "--resume", *options])
        error = capsys.readouterr().err
        assert code == bool(error)
        return error

    whole = store_rows(tmp_path / "whole", path, lambda _: {"rt": 0.1, "luck": 0.5})
    for options in ("--participants 2", "--trials 1", "--set n=1,2,5", "--set n=[1,2.0,5]", "--set seed=1 --set until=60"):
        assert resumed(whole, *options.split()) == "", options
    assert "is another experiment: n: [1, 2, 5] there, [1, True, 5] now" in resumed(whole, "--set", "n=1,True,5")
    part = store_rows(tmp_path / "part", path, lambda _: {"rt": 0.1, "luck": 0.5}, participants=1, values={"n": 3, "mode": "count"})
    for options in ("n=3", "n=3.0", "n=3,"):
        assert resumed(part, "--participants", "1", "--set", options, "--set", "mode=count") == "", options
    with Store(part) as store:
        assert store.specification.values == {"n": 3, "mode": "count"}, "it goes on as it was begun"
    assert "is another experiment: --participants: {'all': 1} there, {'all': 2} now" in resumed(part, "--set", "n=3", "--set", "mode=count")
    assert "is another experiment: mode: 'count' there, not set now" in resumed(part, "--participants", "1", "--set", "n=3")


@pytest.mark.parametrize(
    ("name", "other", "says"),
    [
        ("a", "a", []),
        ("a", "b", ["the design is 'a' there, 'b' now"]),
    ],
)
def test_specifications_differ_in_what_determines_the_rows_alone(tmp_path: Path, name: str, other: str, says: list[str]) -> None:
    experiment = specify(str(write_experiment(tmp_path)), values={"n": (1, 2)})
    one = replace(experiment.specification, name=name)
    changed = replace(one, name=other, versions={"python": "2"}, values={"n": [1, 2]}, model=replace(one.model, file="/elsewhere.py"))
    assert changed.differences_from(one) == says
    helped = replace(changed, model=replace(one.model, helpers={"pace": ["pace.py", ""]}))
    assert helped.differences_from(one) == [*says, "the module 'pace' beside the model differs"]
    there = replace(experiment.specification, versions={"python": "2"}, participants=3, values={"mode": "x"})
    more = ["--participants: {'all': 3} there, {'all': 2} now", "n: [1, 2, 5] there, [1, 2] now", "mode: 'x' there, not set now"]
    assert experiment.differences_from(there) == more


def test_texts_of_models_are_printed_as_they_are(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = write_experiment(tmp_path, model=COUNTER.replace("cannot count to", "wrong [/int] list[int]"))
    assert main(["experiment", str(path), "--check", "--set", "mode=fail"]) == 1
    assert "RuntimeError: wrong [/int] list[int] " in capsys.readouterr().out


def test_a_check_shows_texts_that_cannot_be_read_otherwise_in_quotes(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    levels = r'["a\nb", "", " ", "\x1b[31m", "plain text", "x, y"]'
    path = write_experiment(tmp_path, factors=f'{{"mode": {levels}}}')
    assert main(["experiment", str(path), "--check"]) == 0
    assert r"  mode: 'a\nb', '', ' ', '\x1b[31m', plain text, 'x, y'" in capsys.readouterr().out.splitlines()


@pytest.mark.parametrize(
    ("option", "right"),
    [
        ("--workers 100000", "from 1 to 1000 (got 100000)"),
        ("--workers 0", "from 1 to 1000 (got 0)"),
        (f"--trials {'9' * 5000}", "from 1 to 1000000000 (got 9999999999...)"),
    ],
)
def test_a_number_that_no_computer_can_run_is_refused(option: str, right: str, tmp_path: Path, capsys: Any) -> None:
    with pytest.raises(SystemExit, match="2"):
        main(["experiment", str(write_experiment(tmp_path)), *option.split()])
    assert capsys.readouterr().err.endswith(f"argument {option.split()[0]}: must be a whole number {right}\n")


@pytest.mark.parametrize("command", ["experiment FILE", "fit FILE --parameter n=1..3", "report FILE"])
def test_an_empty_name_of_a_folder_is_refused(command: str, tmp_path: Path, capsys: Any) -> None:
    with pytest.raises(SystemExit, match="2"):
        main([*command.replace("FILE", str(write_experiment(tmp_path))).split(), "--out", ""])
    assert capsys.readouterr().err.endswith("argument --out: must be the name of a folder (got '')\n")


def test_an_error_about_levels_that_are_given_twice_says_how_to_give_several(tmp_path: Path, capsys: Any) -> None:
    assert main(["experiment", str(write_experiment(tmp_path)), "--set", "n=1", "--set", "n=2"]) == 2
    assert (
        capsys.readouterr().err
        == "error: --set n: is given twice ('1', '2'); give one value, or several levels with commas between them: n=1,2\n"
    )


def test_one_trial_is_not_called_trials(tmp_path: Path, client: Any, monkeypatch: pytest.MonkeyPatch, capsys: Any) -> None:
    def local(_: int) -> nullcontext[Any]:
        return nullcontext(client)

    monkeypatch.setattr(cluster, "local_cluster", local)
    path = write_experiment(tmp_path, factors='{"mode": ["fail"]}', participants=1, trials=1)
    assert main(["experiment", str(path), "--out", str(tmp_path / "out")]) == 1
    said = capsys.readouterr().out
    assert "counting: 1 trial in " in said
    assert "1 trial failed (" in said
    assert re.search(r"^1 trial in [\d,]+ s ", said, re.MULTILINE)


@pytest.mark.slow
def test_two_commands_may_write_the_table_at_once(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    path = write_experiment(tmp_path)
    folder = store_rows(tmp_path / "out", str(path), lambda trial: {"rt": 0.1, "luck": 0.5})
    write = table_of_trials._write_csv

    def write_after_another(file: Path, *given: Any) -> None:
        assert subprocess.run([*COMMAND, str(folder), "--resume"], timeout=120, capture_output=True).returncode == 0
        write(file, *given)

    monkeypatch.setattr(table_of_trials, "_write_csv", write_after_another)
    with Store(folder) as store:
        assert all(file.exists() for file in export(store))
    assert not [*folder.glob("*.tmp")]


def test_two_who_write_one_file_at_once_do_not_disturb_each_other(tmp_path: Path) -> None:
    file = tmp_path / "facts.json"
    with replacing(file) as first, replacing(file) as second:
        first.write_text("first", encoding="utf-8")
        second.write_text("second", encoding="utf-8")
        assert not file.exists()
    assert file.read_text(encoding="utf-8") == "first"  # which was complete last

    def fail(part: Path) -> None:
        part.write_text("half", encoding="utf-8")
        raise KeyError

    with pytest.raises(KeyError), replacing(file) as part:
        fail(part)
    assert [(path.name, path.read_text(encoding="utf-8")) for path in tmp_path.iterdir()] == [("facts.json", "first")]


def test_other_versions_are_refused_unless_allowed(tmp_path: Path, capsys: pytest.CaptureFixture[str]) -> None:
    path = write_experiment(tmp_path, participants=1, trials=1)
    folder = tmp_path / "out"
    Store.create(folder, specify(str(path)).specification).close()
    text = (folder / "experiment.json").read_text()
    (folder / "experiment.json").write_text(text.replace(f'"mujoco": "{cluster_versions()["mujoco"]}"', '"mujoco": "1.2.3"'))
    assert main(["experiment", str(folder), "--resume"]) == 1
    assert "its trials until now were run with mujoco 1.2.3 (now" in capsys.readouterr().err
    capsys.readouterr()
    assert main(["experiment", str(folder), "--trial", "0", "--record", str(tmp_path / "again.rec")]) == 0
    assert "it may differ from its row: the experiment was begun with mujoco" in capsys.readouterr().out
    assert main(["experiment", str(folder), "--resume", "--any-version", "--workers", "1"]) == 0
    with Store(folder) as store:
        assert all(f"mujoco {cluster_versions()['mujoco']}" in row["versions"] for row in store.rows())


def test_the_designs_are_listed(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["experiment"]) == 0
    assert "warren_whang_1987 9,600 trials Walking through doorways" in " ".join(capsys.readouterr().out.split())


@pytest.mark.parametrize(
    "command", ["experiment NAME", "experiment FILE --out NAME", "experiment FILE --out NAME --resume", "fit NAME", "fit FILE"]
)
def test_a_name_that_is_too_long_for_a_file_is_an_error_that_names_it(command: str, tmp_path: Path, capsys: Any) -> None:
    given = {"NAME": "n" * 300, "FILE": str(write_experiment(tmp_path))}
    words = [given.get(word, word) for word in command.split()]
    if words[0] == "fit":
        words += ["--parameter", "n=1..3", "--target", given["NAME"], "--out", str(tmp_path / "fit")]
    assert main(words) in (1, 2)
    error = capsys.readouterr().err
    assert re.fullmatch(r"error: [^\n]*n{300}[^\n]*(File name too long|no such file|no design, file or folder)[^\n]*\n", error)
