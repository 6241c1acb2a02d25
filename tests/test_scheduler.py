"""The scheduler: waiting, waking, order, running on and on, and what it says of what it cannot do."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from fractions import Fraction
from typing import Any

import pytest

from actr3d.actr import Model
from actr3d.actr.scheduler import Scheduler, Trigger
from actr3d.errors import ModelWarning, SchedulerError


class Part(Model):
    """A model that notes what happens and when."""

    def __init__(self) -> None:
        self._seen: list[tuple[Any, float]] = []

    def note(self, what: Any) -> None:
        self._seen.append((what, self.now()))


def seen(part: Any) -> list[Any]:
    return part._seen


def test_simultaneous_events_come_by_priority_then_in_order() -> None:
    sch = Scheduler()
    order: list[str] = []
    for name, delay, priority in [("b", 1, 0), ("c", 1, 0), ("z", 1, -5), ("a", 1, 5), ("early", 0.5, -9), ("same", 0.9999999, 0)]:
        sch.add(lambda name=name: order.append(name), delay, priority=priority)
    sch.run()
    assert order == ["early", "a", "b", "c", "same", "z"]
    assert sch.time == 1


def test_generators_wait_for_numbers_triggers_names_methods_and_events() -> None:
    class World(Part):
        def helper(self) -> Iterator[Any]:
            yield 0.25

        def plain(self) -> None: ...

        def start(self) -> Iterator[Any]:
            self.bell = Trigger("bell")
            yield 1
            self.note("number")
            yield self.helper()
            self.note("called generator")
            yield self.helper
            self.note("method")
            yield self.plain
            self.note("plain method")
            yield self.bell
            self.note("trigger")
            yield "alarm"
            self.note("name")
            yield {"delay": 0.5, "priority": 3}
            self.note("dict")
            yield 0.0
            self.note("zero")

        def others(self) -> Iterator[Any]:
            yield 2
            yield self.helper()
            yield 0.5
            self.plain()
            yield 0.5
            self.sch.trigger(self.bell)
            yield 0.5
            self.sch.trigger("alarm")

    world: Any = World()
    world.run(0)
    world.others()
    world.run()
    assert seen(world) == [
        ("number", 1),
        ("called generator", 1.25),
        ("method", 2.25),
        ("plain method", 2.75),
        ("trigger", 3.25),
        ("name", 3.75),
        ("dict", 4.25),
        ("zero", 4.25),
    ]


def test_a_tuple_waits_for_the_first() -> None:
    class World(Part):
        def quick(self) -> Iterator[Any]:
            yield 0.2

        def start(self) -> Iterator[Any]:
            bell = Trigger("bell")
            yield 1, bell
            self.note("number first")
            self.sch.add(lambda: self.sch.trigger(bell), 0.5)
            yield 1, bell, 3
            self.note("trigger first")
            yield [self.quick(), 1]
            self.note("event first")
            yield (bell, "alarm"), 0.1
            self.note("nested")
            yield bell, "alarm", 0.1
            self.note("end")
            yield 5
            self.note("once")

    world = World()
    world.run()
    assert seen(world) == [
        ("number first", 1),
        ("trigger first", 1.5),
        ("event first", 1.7),
        ("nested", 1.8),
        ("end", 1.9),
        ("once", 6.9),
    ]


def test_the_event_of_a_call_can_be_waited_for_by_several_and_after_its_end() -> None:
    class World(Part):
        def job(self) -> Iterator[Any]:
            yield 1

        def waiter(self, name: str, event: Any) -> Iterator[Any]:
            yield event
            self.note(name)

        def start(self) -> Iterator[Any]:
            event: Any = self.job()
            self.waiter("a", event)
            self.waiter("b", event)
            yield event
            self.note("first")
            yield event
            self.note("already over")
            yield self.sch.add(lambda: self.note("plain call"), 0.5)
            self.note("after plain call")

    world = World()
    world.run()
    assert [name for name, _ in seen(world)] == ["first", "a", "b", "already over", "plain call", "after plain call"]
    assert [time for _, time in seen(world)] == [1, 1, 1, 1, 1.5, 1.5]


def test_an_event_waited_for_in_a_tuple_is_over_for_whoever_waits_later() -> None:
    class World(Part):
        def job(self) -> Iterator[Any]:
            yield 1
            yield Trigger("never"), 0.5

        def start(self) -> Iterator[Any]:
            event: Any = self.job()
            yield event, 9
            self.note("job")
            yield event
            self.note("again")

    world = World()
    world.run()
    assert seen(world) == [("job", 1.5), ("again", 1.5)]


def test_the_loser_of_a_tuple_leaves_nothing_behind() -> None:
    class World(Part):
        def start(self) -> Iterator[Any]:
            self._bell = Trigger("bell")
            for _ in range(1000):
                yield 0.001, self._bell

    world: Any = World()
    world.run()
    assert len(world._bell.waiting) <= 8


@pytest.mark.parametrize(
    ("what", "message"),
    [
        (-0.5, r"a delay must not be negative \(got -0\.5 s\)"),
        (float("nan"), r"a delay must be a finite number of seconds \(got nan\)"),
        (float("inf"), r"a delay must be a finite number of seconds \(got inf\)"),
        ({"delay": "soon"}, r"a delay must be a finite number of seconds \(got 'soon'\)"),
        ({"dealy": 1}, r"cannot wait for \{'dealy': 1\}: no 'dealy'; did you mean 'delay'\?"),
        ({"priority": "high"}, r"a priority must be a number \(got 'high'\)"),
        (object, r"cannot wait for <class 'object'>; yield a number of seconds, a trigger or its name, a method"),
        ((1, object), r"cannot wait for <class 'object'>"),
        ((), r"cannot wait for \(\); an empty tuple"),
        (1j, r"cannot wait for 1j"),
    ],
)
def test_what_cannot_be_waited_for_names_generator_file_and_line(what: Any, message: str) -> None:
    class World(Model):
        def start(self) -> Iterator[Any]:
            yield 0.1
            yield what

    with pytest.raises(SchedulerError, match=rf"World\.start \(.*test_scheduler\.py:\d+\): {message}"):
        World().run(1)


def test_yield_none_ends_the_generator_and_says_so() -> None:
    class World(Part):
        def start(self) -> Iterator[Any]:
            yield 0.1
            yield self.note("told")
            self.note("never")

    world = World()
    with pytest.warns(ModelWarning, match=r"World\.start yields None, which ends it here") as caught:
        world.run(1)
    assert caught[0].filename == __file__
    assert seen(world) == [("told", 0.1)]


def test_numbers_of_other_kinds() -> None:
    class World(Part):
        def start(self) -> Iterator[Any]:
            yield Fraction(1, 4)
            self.note("fraction")
            yield 1
            self.note("int")

    world = World()
    world.run()
    assert seen(world) == [("fraction", 0.25), ("int", 1.25)]


def test_a_million_steps_of_ten_milliseconds_do_not_drift() -> None:
    model = Model()
    model.run(0)
    run = model.run
    for _ in range(1_000_000):
        run(0.01)
    assert model.now() == 10_000.0


def test_ticks_share_out_a_run_exactly() -> None:
    class World(Part):
        def start(self) -> Iterator[Any]:
            for _ in range(10):
                yield 0.01
                self.note("tick")

    whole, parts = World(), World()
    whole.run(0.1)
    for step in range(1, 11):
        parts.run(0.01)
        assert len(seen(parts)) == step  # an event at exactly the limit belongs to the run
    assert seen(whole) == seen(parts)
    assert whole.now() == parts.now() == 0.1


def test_a_run_without_events_still_takes_its_time() -> None:
    model = Model()
    model.run(0.5)
    assert model.now() == 0.5
    model.run()
    assert model.now() == 0.5
    model.run(limit=0)
    assert model.now() == 0.5


@pytest.mark.parametrize("limit", [-1, float("nan"), float("inf"), "1"])
def test_a_limit_that_is_no_time(limit: Any) -> None:
    with pytest.raises(SchedulerError, match=r"the limit of a run must (be a finite number of seconds|not be negative) \(got"):
        Model().run(limit)


def test_stop_ends_the_run_after_the_present_event_and_the_next_run_goes_on() -> None:
    class World(Part):
        def start(self) -> Iterator[Any]:
            yield 1
            self.sch.add(lambda: self.note("same time"))
            self.stop()
            self.note("stopped")
            yield 1
            self.note("went on")

    world = World()
    world.run(10)
    assert seen(world) == [("stopped", 1)]
    assert world.now() == 1
    world.run(10)
    assert seen(world) == [("stopped", 1), ("same time", 1), ("went on", 2)]
    assert world.now() == 11


def test_func_is_called_first() -> None:
    world = Part()
    world.run(1, func=lambda: world.note("func"))
    assert seen(world) == [("func", 0)]


def test_another_thread_can_add() -> None:
    class World(Part):
        def start(self) -> Iterator[Any]:
            def work() -> None:
                for i in range(100):
                    self.sch.add(self.note, 0.5, args=[i], thread_safe=True)

            thread = threading.Thread(target=work)
            thread.start()
            thread.join()
            yield 1

    world = World()
    world.run()
    assert seen(world) == [(i, 0.5) for i in range(100)]


def test_a_livelock_is_an_error_that_names_the_culprit() -> None:
    class World(Model):
        def start(self) -> Iterator[Any]:
            while True:
                yield 0

    with pytest.raises(SchedulerError, match=r"time stands still at 0 s: 1,000,000 events.*World\.start \(.*test_scheduler\.py:\d+\)"):
        World().run(1)


def test_run_inside_run_lets_time_pass_and_says_so() -> None:
    class World(Part):
        def start(self) -> Iterator[Any]:
            self.sch.add(lambda: self.note("other"), 0.6)
            yield 0.1
            self.run(1)
            self.note("after inner run")
            yield 1
            self.note("end")

    world = World()
    with pytest.warns(ModelWarning, match=r"run was called while the model is running \(at 0\.1 s\).*yield a number of seconds"):
        world.run(3)
    assert seen(world) == [("other", 0.6), ("after inner run", 1.1), ("end", 2.1)]
    assert world.now() == 3


def test_an_error_in_an_event_leaves_a_scheduler_that_can_go_on() -> None:
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


def test_priorities_of_triggers() -> None:
    sch = Scheduler()
    order: list[str] = []
    bell = Trigger("bell")

    def waits(name: str) -> Iterator[Any]:
        yield bell
        order.append(name)

    def rings() -> Iterator[Any]:
        yield 1
        sch.trigger(bell, priority=-1)
        sch.add(lambda: order.append("added after"))

    sch.add(waits, args=["a"])
    sch.add(waits, args=["b"], priority=7)
    sch.add(rings)
    sch.run()
    assert order == ["added after", "b", "a"]
    sch.trigger("nobody waits")
    assert repr(bell) == "<Trigger 'bell'>"
