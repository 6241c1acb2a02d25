"""Models: how trees are built, what a class's attributes become, and how methods can be waited for."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import pytest

from actr3d.actr import ACTR, Buffer, Model
from actr3d.actr.kernel.tree import path_of
from actr3d.actr.loading import load_text
from actr3d.errors import SchedulerError
from tests.helpers.model_trees import Ball, Box, names


def test_class_attributes_become_each_instances_own() -> None:
    first, second = Box(), Box()
    first.run(0)
    second.run(0)
    assert first.ball is not second.ball
    assert first.sizes is not second.sizes
    assert first.sizes == [1, 2]
    first.ball.color = "blue"
    assert second.ball.color == Ball.color == "red"
    assert Box.ball.__dict__.get("parent") is None


def test_two_agents_of_one_class_share_no_buffer() -> None:
    class Agent(ACTR):
        goal = Buffer()

    world: Any = Model()
    world.a, world.b = Agent(), Agent()
    world.a.goal.set("x")
    world.run(0)
    assert world.a.goal.chunk == {0: "x"}
    assert world.b.goal.chunk is None


@pytest.mark.parametrize("way", ["class", "init", "before", "after", "class of a model", "keyword"])
def test_every_way_of_building_a_tree(way: str) -> None:
    class InClass(Model):
        ball = Ball()

    class InInit(Model):
        def __init__(self) -> None:
            self.ball = Ball()

    class OfClass(Model):
        ball = Ball

    model: Any = {"class": InClass, "init": InInit, "class of a model": OfClass}.get(way, Model)()
    if way == "keyword":
        model = Model(ball=Ball())
    if way == "after":
        model.run(1)
    if way in ("before", "after"):
        model.ball = Ball()
    model.run(1)
    assert type(model.ball) is Ball
    assert model.ball.parent is model
    assert model.ball.name == "ball"
    assert model.name == "top"
    assert model.ball.sch is model.sch
    assert model.ball.random is model.random
    assert model.get_children() == [model.ball]
    assert model["ball"] is model.ball
    assert repr(model.ball) == "<Ball ball>"


def test_children_come_in_alphabetical_order_then_as_they_were_added() -> None:
    class World(Model):
        z = Ball()
        a = Ball()

    world: Any = World()
    world.m = Ball()
    world.b = Ball()
    assert names(world) == ["a", "z", "m", "b"]


OLD_WORLD = """
from python_actr import *
class Agent(ACTR):
    goal = Buffer()
    def init():
        goal.set('go')
    def go(goal='go'):
        goal.set('stop')
class World(Model):
    pass
world = World()
world.agent = Agent()
world.ball = Model()
"""


def test_the_first_part_is_overlooked_in_models_for_python_actr_but_traced_as_any_other() -> None:
    world: Any = load_text(OLD_WORLD).world
    assert names(world) == ["ball"]
    trace = world.traced()
    world.run(1)
    assert [event.source for event in trace if event.kind == "fire"] == ["agent"]
    agent = world.agent
    agent.parent = None
    world.actor = agent
    assert names(world) == ["ball", "actor"]
    assert names(load_text(OLD_WORLD.replace("python_actr", "actr3d.actr")).world) == ["agent", "ball"]


def test_deep_trees_have_one_clock_and_dotted_names() -> None:
    world: Any = Model()
    part = world
    for i in range(60):
        setattr(part, f"p{i}", Model())
        part = getattr(part, f"p{i}")
    assert path_of(part) == ".".join(f"p{i}" for i in range(60))
    world.run(2)
    assert part.now() == 2


def test_a_wait_for_changes_includes_parts_that_have_moved() -> None:
    world: Any = Model()
    world.left, world.right = Model(), Model()
    ball = world.left.ball = Ball()
    heard: list[str] = []

    def listen(name: str) -> Iterator[Any]:
        while True:
            yield world[name].changes
            heard.append(name)

    for name in ("left", "right"):
        world.sch.add(listen, args=(name,))
    world.run(0)
    ball.size = 1
    world.run(0)
    assert heard == ["left"]
    ball.parent = None
    ball.size = 2
    world.run(0)
    assert heard == ["left"]
    world.right.ball = ball
    world.run(0)
    heard.clear()
    ball.size = 3
    world.run(0)
    assert heard == ["right"]


def test_a_part_can_move_to_another_parent() -> None:
    world: Any = Model()
    world.left, world.right = Model(), Model()
    ball = world.left.ball = Ball()
    world.right.ball = ball  # a part has one parent: this is only a second name
    assert ball.parent is world.left
    assert names(world.right) == []
    ball.parent = None
    assert names(world.left) == []
    world.right.other = ball
    assert ball.parent is world.right
    assert ball.name == "other"
    assert path_of(ball) == "right.other"
    assert names(world.right) == ["other"]


def test_replacing_a_part_leaves_the_new_one_in_its_place() -> None:
    world: Any = Model()
    world.ball = Ball()
    world.ball = second = Ball()
    assert world.get_children() == [second]
    assert second.parent is world


def test_an_ancestor_as_attribute_is_no_child() -> None:
    world: Any = Model()
    world.agent = Model()
    world.agent.world = world
    world.agent.me = world.agent
    assert world.parent is None
    assert names(world.agent) == []
    world.run(1)


def test_a_generator_start_runs_from_time_0_in_every_part() -> None:
    seen: list[tuple[str, float]] = []

    class Part(Model):
        def start(self) -> Iterator[float]:
            seen.append((self.name, self.now()))
            yield 1
            seen.append((self.name, self.now()))

    class World(Part):
        part = Part()

    World().run()
    assert sorted(seen) == [("part", 0), ("part", 1), ("top", 0), ("top", 1)]


def test_a_part_added_while_running_starts_at_that_time() -> None:
    times: list[float] = []

    class Part(Model):
        def start(self) -> Iterator[float]:
            times.append(self.now())
            yield 1
            times.append(self.now())

    class World(Model):
        def start(self) -> Iterator[float]:
            yield 2
            self.part = Part()

    World().run()
    assert times == [2, 3]


def test_a_tree_that_has_run_by_itself_cannot_join() -> None:
    part = Model()
    part.run(1)
    world: Any = Model()
    with pytest.raises(SchedulerError, match=r"'part' ran on its own until 1 s; add it to its environment before it runs"):
        world.part = part


def test_a_started_tree_joins_with_its_events() -> None:
    seen: list[float] = []

    class Part(Model):
        def __init__(self) -> None:
            self.inner = Model()

        def start(self) -> Iterator[float]:
            yield 0.5
            seen.append(self.now())

    part: Any = Part()
    world: Any = Model()
    world.part = part
    world.run(1)
    assert seen == [0.5]
    assert part.sch is part.inner.sch is world.sch
    assert part.inner.random is world.random


def test_a_part_that_waits_for_a_name_still_waits_after_its_tree_has_joined_another() -> None:
    seen: list[float] = []

    class Part(Model):
        def start(self) -> Iterator[Any]:
            yield "alarm"
            seen.append(self.now())

    part = Part()
    part.run(0)
    world: Any = Model()
    world.part = part
    world.sch.add(lambda: world.sch.trigger("alarm"), 2)
    world.run()
    assert seen == [2]


def test_an_unknown_attribute_is_an_attribute_error() -> None:
    with pytest.raises(AttributeError, match="missing"):
        Model()["missing"]


def test_a_change_anywhere_below_is_a_change_of_the_whole() -> None:
    woken: list[float] = []

    class World(Model):
        box = Box()

        def start(self) -> Iterator[Any]:
            while True:
                yield self.changes
                woken.append(self.now())

        def mover(self) -> Iterator[Any]:
            yield 1
            self.box.ball.x = 1
            yield 1
            self.box.ball._private = 1
            yield 1
            self.box.name = "renamed"

    world: Any = World()
    world.run(0)
    woken.clear()
    world.mover()
    world.run(5)
    assert woken == [1]


def test_limits_that_are_no_whole_microseconds_do_not_drift() -> None:
    model: Any = Model()
    for _ in range(3000):
        model.run(1 / 30)
    assert model.now() == 100
