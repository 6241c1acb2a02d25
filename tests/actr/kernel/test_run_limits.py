"""Limits: when runs end at the latest, and threads that keep to them."""

from __future__ import annotations

import io
import shutil
import threading
import warnings
from concurrent.futures import ThreadPoolExecutor
from contextlib import redirect_stdout
from pathlib import Path
from typing import Any

import pytest

from actr3d.actr import Model
from actr3d.actr.kernel.run_limits import MAX_REFUSALS, EndOfRun, RunLimits
from actr3d.actr.loading import run_text
from actr3d.errors import ParameterError
from actr3d.runner.run import run_model
from actr3d.simulation import Simulation
from actr3d.trace import Trace
from actr3d.world import Floor, Scene
from tests.helpers.paths import MODELS, TESTS


class Clock(Model):
    """Ticks for ever."""

    def start(self) -> Any:
        while True:
            yield 0.25


def test_the_first_run_that_is_cut_short_is_the_last() -> None:
    with RunLimits(until=2) as limits:
        first: Any = Clock()
        first.run(0.75)
        for _ in range(5):  # each run has its own clock, and its own end
            other: Any = Clock()
            other.run(2)
            assert other.now() == 2
        assert not limits.ended
        first.run(3)
        assert first.now() == 2
        assert limits.ended
        for model in (first, Clock()):
            with pytest.raises(EndOfRun):
                model.run(0.01)
    with limits:  # the same limits again
        again: Any = Clock()
        again.run()
        assert again.now() == 2


def test_a_seed_is_not_negative() -> None:
    with pytest.raises(ParameterError, match=r"RunLimits\.seed: must be >= 0 \(got -1\)"):
        RunLimits(seed=-1)
    assert RunLimits(seed="-1").program_seed == "-1"


def test_a_run_that_has_come_to_the_end_by_itself_gets_no_more_time() -> None:
    with RunLimits(until=1) as limits:
        model: Any = Clock()
        for _ in range(4):
            model.run(0.25)
        assert not limits.ended
        with pytest.raises(EndOfRun):
            model.run(0.25)
        assert limits.ended


def test_no_run_that_ends_by_itself_is_cut_however_many_there_are() -> None:
    with RunLimits(until=0.01) as limits:
        for _ in range(5_000):
            model: Any = Model()
            model.run(0.0075)
            model.run(0.0025)
            model.run(0)
        assert not limits.ended


def test_limits_inside_others_end_with_them() -> None:
    with RunLimits(until=1) as outer:
        with RunLimits(until=5):
            model: Any = Clock()
            model.run()
            assert model.now() == 1
        assert outer.ended


def test_a_model_that_swallows_every_end_is_stopped_by_the_last_resort() -> None:
    called: list[int] = []
    with RunLimits(until=1, last_resort=lambda: called.append(1)):
        model: Any = Clock()
        model.run()
        for _ in range(MAX_REFUSALS + 1):
            assert called == []
            with pytest.raises(EndOfRun):
                model.run()
        assert called == [1]


def test_threads_keep_to_the_limits_of_their_starter() -> None:
    trace = Trace("all")
    seen: list[Any] = []

    def make() -> None:
        model: Any = Clock()
        model.run()
        seen.append((model.now(), model.sch.seed, model.sch.trace is trace))
        model.run()  # there is no time left: this ends the thread
        seen.append("too late")

    start = threading.Thread.start
    with RunLimits(seed=7, until=1.5, trace=trace) as limits:
        threading.Thread(target=make).start()
        limits.wait_for_threads()
        with ThreadPoolExecutor(1) as pool:
            assert pool.submit(RunLimits.current).result() is limits
    assert seen == [(1.5, 7, True)]
    assert threading.Thread.start is start


def test_other_threads_have_no_limits() -> None:
    ready, go = threading.Event(), threading.Event()
    seen: list[Any] = []

    def look() -> None:
        ready.set()
        go.wait()
        seen.append(RunLimits.current())

    thread = threading.Thread(target=look)
    thread.start()
    ready.wait()
    with RunLimits(seed=1):
        go.set()
        thread.join()
    assert seen == [None]


class Counter(Model):
    """Counts for a second, and then does nothing."""

    def start(self) -> Any:
        for _ in range(4):
            yield 0.25


def test_a_run_that_ends_by_itself_is_not_stretched() -> None:
    with RunLimits(until=100) as limits:
        model: Any = Counter()
        for _ in range(3):
            model.run()
            assert model.now() == 1
        other: Any = Counter()
        other.run()
        model.sch.add(lambda: None, 2.0)
        model.run()
        assert (model.now(), other.now()) == (3, 1)
        assert not limits.ended


def test_a_run_that_needs_no_time_is_never_cut() -> None:
    with RunLimits(until=1) as limits:
        model: Any = Counter()
        model.run()
        assert model.now() == 1
        model.run()  # nothing is left to do
        model.run(0)
        model.sch.add(model.stop)
        model.run(5)  # stopped immediately, although the limit was later
        assert not limits.ended
        with pytest.raises(EndOfRun):
            model.run(0.1)
        assert limits.ended


def test_a_stop_at_the_last_moment_is_no_cut() -> None:
    class Stopping(Model):
        def start(self) -> Any:
            yield 1
            self.stop()
            yield 1

    with RunLimits(until=1) as limits:
        model: Any = Stopping()
        model.run()
        assert model.sch.ended_by == "stop"
        assert not limits.ended


def test_the_trace_says_what_ended_a_run() -> None:
    trace = Trace("all")
    with RunLimits(until=2, trace=trace):
        model: Any = Counter()
        for limit in (2 / 3, 2 / 3, None, None, 5):
            model.run(limit)
    assert [event.data["by"] for event in trace.select("stop")] == ["limit", "limit", "done", "done", "until"]


PROGRAM = """
from actr3d.simulation import Simulation
from actr3d.world import Floor, Mannequin, Scene
for seconds in (0.05, 0.05, 1):
    simulation = Simulation(Scene(parts=(Floor(), Mannequin())), {})
    report = simulation.run(seconds)
    print(report.ended_by, simulation.ticks)
simulation.run(0.01)
print("no more")
"""


@pytest.mark.parametrize(
    ("until", "expected"),
    [
        (1, "seconds 5\nseconds 5\nseconds 100\n"),
        (0.127, "seconds 5\nseconds 5\nlimits 12\n"),
        (100, "seconds 5\nseconds 5\nseconds 100\nno more\n"),
    ],
)
def test_simulations_of_a_program_are_cut_after_a_whole_tick(until: float, expected: str, capsys: pytest.CaptureFixture[str]) -> None:
    run_text(PROGRAM, limits=RunLimits(until=until))
    assert capsys.readouterr().out == expected


def test_a_simulation_without_time_for_a_tick_is_left_at_a_whole_one() -> None:
    with RunLimits(until=0.015):
        simulation = Simulation(Scene(parts=(Floor(),)), {})
        simulation.step()
        for _ in range(2):
            with pytest.raises(EndOfRun):
                simulation.tick()
        assert simulation.ticks == 1
        assert not simulation.timeline.lockstep.broken


TEXTS = sorted((TESTS / "models").glob("*.py")) + sorted(MODELS.rglob("*.py"))
QUICK = {"runs", "memory_basic", "two_typists", "yields_of_all_kinds", "finsts", "nested_models", "counting", "doorway", "compilation"}


def outcome(file: Path, folder: Path, monkeypatch: pytest.MonkeyPatch, until: float | None) -> tuple[str, list[str]]:
    """Returns what a model prints, and every event of its trace."""
    folder.mkdir()
    copied = Path(shutil.copy(file, folder))
    monkeypatch.chdir(folder)
    trace = Trace("all")
    printed = io.StringIO()
    with redirect_stdout(printed), warnings.catch_warnings():
        warnings.simplefilter("ignore")
        run_model(copied, RunLimits(seed=1, until=until, trace=trace))
    return printed.getvalue().replace(str(folder), ""), [event.to_json() for event in trace]


@pytest.mark.parametrize("file", [pytest.param(f, id=f.stem, marks=[] if f.stem in QUICK else pytest.mark.slow) for f in TEXTS])
def test_a_run_that_ends_by_itself_is_the_same_without_a_limit(file: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    free = outcome(file, tmp_path / "free", monkeypatch, None)
    limited = outcome(file, tmp_path / "limited", monkeypatch, 10_000_000)
    assert free[0] == limited[0]
    assert free[1] == limited[1]
    assert free[0] or free[1]


def test_the_end_may_be_changed_before_the_limits_are_used_again() -> None:
    limits = RunLimits(until=1)
    for end in (1, 2):
        limits.until = end
        with limits:
            model: Any = Clock()
            model.run()
            assert model.now() == end
