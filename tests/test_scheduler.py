"""The scheduler: waiting, waking, order, running on and on, and what it says of what it cannot do."""

from __future__ import annotations

import threading
from collections.abc import Iterator
from fractions import Fraction
from typing import Any

from noting import Part, seen

from actr3d.actr import Model
from actr3d.actr.scheduler import Scheduler, Trigger


def test_simultaneous_events_come_by_priority_then_in_order() -> None:
    sch = Scheduler()
    order: list[str] = []
    for name, delay, priority in [("b", 1, 0), ("c", 1, 0), ("z", 1, -5), ("a", 1, 5), ("early", 0.5, -9), ("same", 0.9999999, 0)]:
        sch.add(order.append, delay, args=[name], priority=priority)
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
