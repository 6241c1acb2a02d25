"""What a class's attributes and methods become in its models."""

from __future__ import annotations

import io
import math
import threading
from typing import Any

import pytest

from actr3d.actr import ACTR, Model
from actr3d.actr.loading import load_text
from actr3d.errors import ModelWarning, SchedulerError
from tests.helpers.model_trees import Ball


def test_objects_that_cannot_be_copied_are_shared() -> None:
    class World(Model):
        module = math
        lock = threading.Lock()
        file = io.TextIOWrapper(io.BytesIO())
        parts = {"lock": threading.RLock(), "list": [1]}
        generator = (i for i in range(3))

    first, second = World(), World()
    first.run(0)
    second.run(0)
    for name in ("module", "lock", "file", "generator"):
        assert getattr(first, name) is getattr(second, name) is getattr(World, name)
    assert first.module.floor(1.5) == 1


def test_a_value_shared_by_two_class_attributes_stays_shared() -> None:
    class World(Model):
        left = Ball()
        right = left
        values = [1]
        same = values

    world: Any = World()
    world.run(0)
    assert world.left is world.right
    assert world.values is world.same
    assert len(world.get_children()) >= 1


def test_keyword_attributes() -> None:
    model: Any = Model(x=3, log=None, word="w")
    assert (model.x, model.word) == (3, "w")
    model.run(1)
    assert (model.x, model.word) == (3, "w")


def test_a_class_attribute_overrides_an_earlier_value_as_in_python_actr_with_a_warning() -> None:
    ball: Any = Ball(color="green")
    with pytest.warns(ModelWarning, match=r"Ball\.color was set to 'green', but becomes 'red', as its class says"):
        ball.run(1)
    assert ball.color == "red"


def test_methods_can_be_called_waited_for_and_overridden_with_super() -> None:
    class Base(Model):
        def act(self, x: int, *, y: int = 1) -> int:
            return x + y

    class Derived(Base):
        def act(self, x: int, *, y: int = 2) -> int:
            return 10 * super().act(x, y=y)

    model = Derived()
    assert model.act(1) == 30
    model.run(0)
    assert model.act(1) == 30
    assert model.act(1, y=0) == 10
    assert "Derived.act" in repr(model.act)


def test_static_class_and_property_members_stay_what_they_are() -> None:
    class Thing(Model):
        count = 2

        @staticmethod
        def add(a: int, b: int) -> int:
            return a + b

        @classmethod
        def kind(cls) -> str:
            return cls.__name__

        @property
        def double(self) -> int:
            return 2 * self.count

        @double.setter
        def double(self, value: int) -> None:
            self.count = value // 2

    thing: Any = Thing()
    thing.run(0)
    thing.count = 5
    assert (thing.add(1, 2), thing.kind(), thing.double) == (3, "Thing", 10)
    thing.double = 6
    assert (thing.count, thing.double) == (3, 6)
    assert "double" not in vars(thing)


@pytest.mark.parametrize("name", ["run", "now", "get_children", "traced", "explain"])
@pytest.mark.parametrize("value", [3, [], None])
def test_methods_that_a_model_needs_are_not_replaced_by_values(name: str, value: Any) -> None:
    with pytest.raises(SchedulerError, match=rf"Odd\.{name}: the name '{name}' is reserved in every model; use another"):
        type("Odd", (Model,), {name: value})


@pytest.mark.parametrize("name", ["run", "now", "get_children", "traced", "explain"])
@pytest.mark.parametrize("parameters", ["", "goal='explain'"])
def test_a_production_cannot_have_the_name_of_a_method_that_every_model_needs(name: str, parameters: str) -> None:
    text = f"from actr3d.actr import *\nclass Agent(ACTR):\n    goal = Buffer()\n    def {name}({parameters}):\n        goal.clear()\n"
    with pytest.raises(SchedulerError, match=rf"Agent\.{name}: the name '{name}' is reserved in every model; use another"):
        load_text(text, "agent.py")


def test_a_production_of_a_mixin_cannot_have_the_name_of_a_method_either() -> None:
    def explain(goal: Any = "a") -> None: ...

    mixin = type("Mixin", (), {"explain": explain, "__module__": __name__})
    for bases in ((ACTR, mixin), (mixin, ACTR)):
        with pytest.raises(SchedulerError, match=r"Mixin\.explain: the name 'explain' is reserved in every model"):
            type("Agent", bases, {})


def test_a_class_may_override_the_methods_that_every_model_needs() -> None:
    class Clock(Model):
        def now(self) -> float:
            return 7.0

        def run(self, limit: float | None = None, func: Any = None) -> None:
            self.limits = limit, func

        def explain(*given: Any) -> str:
            return "so"

    clock: Any = Clock()
    clock.run(3)
    assert (clock.now(), clock.limits, clock.explain()) == (7.0, (3, None), "so")


def test_a_value_that_a_method_of_its_name_replaces_is_reported() -> None:
    class Heavy(Model):
        def weight(self) -> int:
            return 3

    heavy: Any = Heavy()
    setattr(heavy, "weight", 5)  # noqa: B010 - of a method's name
    with pytest.warns(ModelWarning, match=r"Heavy\.weight was set to 5, but becomes the method 'weight' of its class"):
        heavy.run(0)
    assert heavy.weight() == 3


@pytest.mark.parametrize("name", ["name", "log", "random", "changes", "sch", "parent"])
def test_attributes_named_like_internals_do_not_break_the_tree(name: str) -> None:
    kind = type("Odd", (Model,), {name: "mine"})
    world: Any = Model()
    if name == "name":
        world.odd = kind()
        world.run(1)
        assert world.odd.parent is world
    else:
        with pytest.raises(SchedulerError, match=rf"Odd\.{name}: the name '{name}' is reserved in every model; use another"):
            world.odd = kind()
