"""Limits: the time of all runs together, and threads that keep to them."""

from __future__ import annotations

import threading
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import pytest

from actr3d.actr import Model
from actr3d.actr.limits import MOST_REFUSALS, EndOfRun, RunLimits
from actr3d.trace import Trace


class Clock(Model):
    """Ticks for ever."""

    def start(self) -> Any:
        while True:
            yield 0.25


def test_all_runs_together_end_in_time() -> None:
    with RunLimits(until=2) as limits:
        first: Any = Clock()
        first.run(0.75)
        second: Any = Clock()
        second.run(0.5)
        second.run()
        assert (first.now(), second.now()) == (0.75, 1.25)
        for model in (first, second, Clock()):
            with pytest.raises(EndOfRun):
                model.run(0.01)
        assert limits.ended
    with limits:  # the same limits again
        again: Any = Clock()
        again.run()
        assert again.now() == 2


def test_runs_inside_runs_count_once() -> None:
    class Outer(Clock):
        def start(self) -> Any:
            yield 0.5
            Clock().run(1)
            yield 9

    with RunLimits(until=2):
        outer: Any = Outer()
        outer.run(0.75)
        last: Any = Clock()
        last.run()
        assert last.now() == 0.25


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
