"""The scheduler: waiting, waking, order, and repeated runs."""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterator
from fractions import Fraction
from typing import Any

import pytest

from actr3d.actr import Model
from actr3d.actr.kernel.events import Trigger
from actr3d.actr.kernel.scheduler import MAX_REMAINDERS, Scheduler
from tests.helpers.production_cycle import fired, run
from tests.helpers.scheduler_models import Part, seen


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


def test_an_event_waited_for_in_a_tuple_is_over_for_later_waits() -> None:
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


def test_a_hundred_thousand_steps_of_ten_milliseconds_do_not_drift() -> None:
    model = Model()
    model.run(0)
    run = model.run
    for _ in range(100_000):
        run(0.01)
    assert model.now() == 1_000.0


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


def test_stop_ends_the_run_after_the_present_event_and_the_next_run_continues() -> None:
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


STEPS = 6000
"""The number of sixtieths of a second in 100 s; rounded one by one they would be 2 ms more."""


def chain(sch: Scheduler, left: int) -> None:
    if left:
        sch.add(chain, 1 / 60, args=(sch, left - 1))


WAITS: list[Callable[[Any], Any]] = [
    lambda _: 1 / 60,
    lambda _: Fraction(1, 60),
    lambda _: {"delay": 1 / 60},
    lambda _: (1 / 60, Trigger("never")),
    lambda model: model.step(),
    lambda model: model.sch.add(lambda: None, 1 / 60),
]


@pytest.mark.parametrize(
    "wait",
    WAITS,
    ids=["number", "fraction", "dict", "first of several", "called generator", "added call"],
)
def test_delays_that_follow_one_another_do_not_drift(wait: Any) -> None:
    class World(Model):
        def step(self) -> Iterator[Any]:
            yield 1 / 60

        def start(self) -> Iterator[Any]:
            for step in range(STEPS):
                yield wait(self)
                assert self.sch.now_us == round((step + 1) * 1_000_000 / 60)

    world = World()
    world.run()
    assert world.now() == STEPS / 60


def test_many_different_delays_do_not_drift() -> None:
    delays = [1 / number for number in range(61, 161)]

    class World(Model):
        def start(self) -> Iterator[Any]:
            exact = Fraction(0)
            for turn in range(100 * len(delays)):
                delay = delays[turn % len(delays)]
                exact += Fraction(delay) * 1_000_000
                yield delay
                assert abs(self.sch.now_us - exact) < MAX_REMAINDERS

    World().run()


def test_delays_of_less_than_a_microsecond_never_go_back() -> None:
    class World(Model):
        def start(self) -> Iterator[Any]:
            for turn in range(10_000):
                before = self.sch.now_us
                yield (turn % 97 + 1) / 60e6
                assert self.sch.now_us >= before

    World().run()


@pytest.mark.parametrize("first_come", [True, False])
def test_calls_that_schedule_the_next_do_not_drift(first_come: bool) -> None:
    sch = Scheduler(first_come)
    chain(sch, STEPS)
    sch.run()
    assert sch.time == STEPS / 60


def test_a_woken_generator_continues_from_the_exact_time() -> None:
    class World(Model):
        def start(self) -> Iterator[Any]:
            self.bell = Trigger("bell")
            self.ringing()
            for _ in range(STEPS):
                yield self.bell
                yield 1 / 60

        def ringing(self) -> Iterator[Any]:
            for _ in range(STEPS):
                yield 1 / 60
                self.sch.trigger(self.bell)
                yield 1 / 60

    world: Any = World()
    world.run()
    assert world.now() == 2 * STEPS / 60


def test_delays_that_take_turns_do_not_drift() -> None:
    class World(Model):
        def start(self) -> Iterator[Any]:
            for _ in range(STEPS):
                yield 1 / 60
                yield 0.01
                yield 1 / 7

    world = World()
    world.run()
    assert abs(world.now() - STEPS * (1 / 60 + 0.01 + 1 / 7)) <= 1e-6


def test_a_dozen_delays_that_take_turns_do_not_drift() -> None:
    delays = [1 / prime for prime in (3, 7, 11, 13, 17, 19, 23, 29, 31, 37, 41, 43)]

    class World(Model):
        def start(self) -> Iterator[Any]:
            for _ in range(STEPS // 10):
                yield from delays

    world = World()
    world.run()
    assert abs(world.now() - STEPS // 10 * sum(delays)) <= 1e-6


def test_delays_that_differ_are_each_rounded_alone() -> None:
    class World(Part):
        def start(self) -> Iterator[Any]:
            for delay in (0.0000014, 0.0000024, 0.0000034):
                yield delay
                self.note("step")

    world = World()
    world.run()
    assert [time for _, time in seen(world)] == [0.000001, 0.000003, 0.000006]


def test_two_series_of_one_delay_stay_together() -> None:
    class World(Part):
        def series(self, name: str) -> Iterator[Any]:
            for _ in range(100):
                yield 1 / 60
                self.note(name)

        def start(self) -> Iterator[Any]:
            self.series("a")
            self.series("b")
            yield 0

    world = World()
    world.run()
    times = [time for _, time in seen(world)]
    assert times[::2] == times[1::2]


def test_delays_below_a_microsecond_add_up() -> None:
    class World(Model):
        def start(self) -> Iterator[Any]:
            for _ in range(1000):
                yield 1e-7

    world = World()
    world.run()
    assert world.now() == 1e-4


@pytest.mark.parametrize("kind", ["ProductionSystem", "ACTR"])
def test_a_production_time_of_a_sixtieth_of_a_second_does_not_drift(kind: str) -> None:
    module = run(
        f"""
class Agent({kind}):
    production_time = 1 / 60
    goal = Buffer()
    def init():
        goal.set("go")
    def go(goal="go"):
        pass
""",
        STEPS / 60,
    )
    assert len(module.trace.select("fire")) == STEPS
    assert fired(module)[-1][0] == STEPS / 60


def test_a_series_continues_beside_retrievals_that_are_each_rounded() -> None:
    module = run(
        """
class Agent(ACTR):
    production_time = 1 / 60
    goal = Buffer()
    retrieval = Buffer()
    memory = Memory(retrieval, latency=1 / 60)
    def init():
        memory.add("a")
        goal.set("go")
    def again(goal="go"):
        memory.request("a")
""",
        STEPS / 60,
    )
    assert fired(module)[-1][0] == STEPS / 60


def test_whole_milliseconds_stay_whole() -> None:
    module = run("""
class Clock(Model):
    def start(self):
        for _ in range(3):
            yield 1 / 60
            out.append(self.now())
class Agent(ACTR):
    profile = "act-r-7"
    clock = Clock()
""")
    assert module.out == [0.017, 0.034, 0.051]
