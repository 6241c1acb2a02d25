"""Limits: when runs end at the latest, and threads that keep to them."""

from __future__ import annotations

import threading
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import pytest

from actr3d.actr import Model
from actr3d.actr.limits import MOST_REFUSALS, RUNS_TOGETHER, EndOfRun, RunLimits
from actr3d.trace import Trace


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


def test_a_run_that_has_come_to_the_end_by_itself_gets_no_more_time() -> None:
    with RunLimits(until=1) as limits:
        model: Any = Clock()
        for _ in range(4):
            model.run(0.25)
        assert not limits.ended
        with pytest.raises(EndOfRun):
            model.run(0.25)
        assert limits.ended


def test_short_runs_without_end_come_to_an_end() -> None:
    with RunLimits(until=1):
        for _ in range(2 * RUNS_TOGETHER):
            Clock().run(0.5)
        with pytest.raises(EndOfRun):
            Clock().run(0.5)


def test_runs_inside_runs_count_once() -> None:
    class Outer(Clock):
        def start(self) -> Any:
            yield 0.5
            Clock().run(1)
            yield 9

    with RunLimits(until=2) as limits:
        outer: Any = Outer()
        outer.run(0.75)
        assert limits._used_us == 1_750_000


def test_limits_inside_others_end_with_them() -> None:
    with RunLimits(until=1) as outer:
        with RunLimits(until=5):
            model: Any = Clock()
            model.run()
            assert model.now() == 1
        assert outer.ended


def test_who_swallows_every_end_meets_the_last_resort() -> None:
    called: list[int] = []
    with RunLimits(until=1, last_resort=lambda: called.append(1)):
        model: Any = Clock()
        model.run()
        for _ in range(MOST_REFUSALS + 1):
            assert called == []
            with pytest.raises(EndOfRun):
                model.run()
        assert called == [1]


def test_threads_keep_to_the_limits_of_who_starts_them() -> None:
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
