"""Errors of the scheduler, and how it continues afterwards."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

from actr3d.actr import Model
from actr3d.errors import ModelWarning, SchedulerError
from tests.helpers.scheduler_models import Part, seen


@pytest.mark.parametrize(
    ("what", "message"),
    [
        (-0.5, r"a delay: must be >= 0 \(got -0\.5 s\)"),
        (float("nan"), r"a delay: must be a finite number of seconds \(got nan\)"),
        (float("inf"), r"a delay: must be a finite number of seconds \(got inf\)"),
        ({"delay": "soon"}, r"a delay: must be a finite number of seconds \(got 'soon'\)"),
        ({"dealy": 1}, r"cannot wait for \{'dealy': 1\}: no 'dealy'; did you mean 'delay'\?"),
        ({"priority": "high"}, r"a priority must be a number \(got 'high'\)"),
        (object, r"cannot wait for <class 'object'>; yield a number of seconds, a trigger or its name, a method"),
        ((1, object), r"cannot wait for <class 'object'>"),
        ((), r"cannot wait for \(\); nothing is in it"),
        (1j, r"cannot wait for 1j"),
    ],
)
def test_an_invalid_wait_names_generator_file_and_line(what: Any, message: str) -> None:
    class World(Model):
        def start(self) -> Iterator[Any]:
            yield 0.1
            yield what

    with pytest.raises(SchedulerError, match=rf"World\.start \(.*test_scheduler_errors\.py:\d+\): {message}"):
        World().run(1)


def test_yield_none_ends_the_generator_with_a_warning() -> None:
    class World(Part):
        def start(self) -> Iterator[Any]:
            yield 0.1
            yield self.note("noted")
            self.note("never")

    world = World()
    with pytest.warns(ModelWarning, match=r"World\.start yields None, which ends it here") as caught:
        world.run(1)
    assert caught[0].filename == __file__
    assert seen(world) == [("noted", 0.1)]


@pytest.mark.parametrize("limit", [-1, float("nan"), float("inf"), "1"])
def test_an_invalid_limit_is_an_error(limit: Any) -> None:
    with pytest.raises(SchedulerError, match=r"the limit of a run: must be (a finite number of seconds|>= 0) \(got"):
        Model().run(limit)


def test_a_livelock_is_an_error_that_names_the_culprit() -> None:
    class World(Model):
        def start(self) -> Iterator[Any]:
            while True:
                yield 0

    with pytest.raises(
        SchedulerError,
        match=r"endless loop at 0 s: 200,000 events without any time passing.*World\.start \(.*test_scheduler_errors\.py:\d+\)",
    ):
        World().run(1)


@pytest.mark.parametrize("traced", [False, True])
def test_run_inside_run_advances_time_and_warns(traced: bool) -> None:
    class World(Part):
        def start(self) -> Iterator[Any]:
            self.sch.add(lambda: self.note("other"), 0.6)
            yield 0.1
            self.run(1)
            self.note("after inner run")
            yield 1
            self.note("end")

    world = World()
    if traced:
        world.traced()
    with pytest.warns(ModelWarning, match=r"run was called while the model is running \(at 0\.1 s\).*yield a number of seconds") as caught:
        world.run(3)
    assert [w.filename for w in caught] == [__file__]
    assert seen(world) == [("other", 0.6), ("after inner run", 1.1), ("end", 2.1)]
    assert world.now() == 3


def test_a_scheduler_can_continue_after_an_error_in_an_event() -> None:
    class World(Part):
        def start(self) -> Iterator[Any]:
            self.sch.add(lambda: self.note("later"), 2)
            yield 1
            raise RuntimeError("once")

    world = World()
    with pytest.raises(RuntimeError, match="once"):
        world.run(5)
    assert world.now() == 1
    world.run(5)
    assert seen(world) == [("later", 2)]
    assert world.now() == 6
