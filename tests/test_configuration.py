"""Configurations check their fields once, and say what is wrong and what would be right."""

from __future__ import annotations

from dataclasses import FrozenInstanceError, dataclass
from typing import Annotated, Any, Literal

import numpy as np
import pytest
from annotated_types import Ge, Gt, Le, Lt, MinLen

from actr3d.configuration import Configuration, Infinite, InRadians
from actr3d.errors import ConfigurationError


@dataclass(frozen=True, kw_only=True)
class Lamp(Configuration):
    power: Annotated[float, Gt(0), Le(100)] = 60.0
    bulbs: Annotated[int, Ge(1), Lt(10)] = 1
    name: Annotated[str, MinLen(1)] = "lamp"
    shade: Literal["paper", "glass"] = "paper"
    position: tuple[float, float] = (0.0, 0.0)
    hours: tuple[Annotated[float, Ge(0)], ...] = ()
    limit: Annotated[float, Gt(0)] | None = None
    lit: bool = False
    life: Annotated[float, Infinite(), Ge(0)] = 1000.0


def test_valid_values_are_accepted_and_converted_to_their_types() -> None:
    lamp = Lamp(power=40, position=[1, 2], hours=[3], limit=5)  # pyright: ignore[reportArgumentType]
    assert lamp == Lamp(power=40.0, position=(1.0, 2.0), hours=(3.0,), limit=5.0)
    assert type(lamp.power) is float
    assert Lamp(limit=None).limit is None
    assert Lamp(life=float("inf")).life == float("inf")


def test_it_is_frozen() -> None:
    with pytest.raises(FrozenInstanceError):
        Lamp().power = 3  # pyright: ignore[reportAttributeAccessIssue]


@pytest.mark.parametrize(
    ("field", "value", "message"),
    [
        ("power", 0, r"Lamp\.power: must be > 0 \(got 0\.0\)"),
        ("power", 101, r"Lamp\.power: must be <= 100"),
        ("power", "60", r"Lamp\.power: must be a number \(got '60'\)"),
        ("power", True, r"Lamp\.power: must be a number \(got True\)"),
        ("power", float("nan"), r"Lamp\.power: must be a finite number"),
        ("power", float("inf"), r"Lamp\.power: must be a finite number"),
        ("power", None, r"Lamp\.power: must be a number \(got None\)"),
        ("bulbs", 1.5, r"Lamp\.bulbs: must be a whole number"),
        ("bulbs", 0, r"Lamp\.bulbs: must be >= 1"),
        ("bulbs", 10, r"Lamp\.bulbs: must be < 10"),
        ("name", "", r"Lamp\.name: must be at least 1 long"),
        ("shade", "papr", r"must be one of 'paper', 'glass' \(got 'papr'\); did you mean 'paper'\?"),
        ("position", (1, 2, 3), r"Lamp\.position: must have 2 values \(got 3"),
        ("position", "ab", r"Lamp\.position: must be a tuple"),
        ("position", (1, "a"), r"Lamp\.position\[1\]: must be a number"),
        ("hours", (1, -1), r"Lamp\.hours\[1\]: must be >= 0"),
        ("limit", -1, r"Lamp\.limit: must be > 0"),
        ("life", float("nan"), r"Lamp\.life: must be a finite number"),
        ("life", -float("inf"), r"Lamp\.life: must be >= 0 \(got -inf\)"),
        ("lit", 1, r"Lamp\.lit: must be True or False"),
    ],
)
def test_wrong_values_are_refused_with_a_reason(field: str, value: Any, message: str) -> None:
    with pytest.raises(ConfigurationError, match=message):
        Lamp(**{field: value})


def test_names_that_are_not_fields_are_refused() -> None:
    assert Lamp.from_mapping({"power": 20}) == Lamp(power=20.0)
    with pytest.raises(ConfigurationError, match="Lamp has no field 'powr'; did you mean 'power'"):
        Lamp.from_mapping({"powr": 20})


def test_numbers_of_numpy_become_those_of_python() -> None:
    lamp = Lamp(power=np.float32(0.5), bulbs=np.int64(2), position=np.arange(2), life=np.float32("inf"))  # pyright: ignore[reportArgumentType]
    assert lamp == Lamp(power=0.5, bulbs=2, position=(0.0, 1.0), life=float("inf"))
    assert [type(value) for value in (lamp.power, lamp.bulbs, *lamp.position, lamp.life)] == [float, int, float, float, float]
    with pytest.raises(ConfigurationError, match=r"Lamp\.bulbs: must be a whole number \(got np\.float64\(2\.0\)\)"):
        Lamp(bulbs=np.float64(2))  # pyright: ignore[reportArgumentType]


def test_an_angle_that_is_too_great_may_be_in_degrees() -> None:
    @dataclass(frozen=True, kw_only=True)
    class Turn(Configuration):
        angle: Annotated[float, Ge(-7), Le(7), InRadians()] = 0.0

    with pytest.raises(
        ConfigurationError, match=r"Turn\.angle: must be <= 7 \(got 90\.0\); did you mean 90 degrees, math\.radians\(90\)\?"
    ):
        Turn(angle=90)
    assert Turn(angle=6).angle == 6.0
