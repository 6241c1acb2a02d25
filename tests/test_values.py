"""Plain values: whatever a model holds, a record of it is JSON, the same in every run, and runs none of the model's code."""

from __future__ import annotations

import json
from collections import OrderedDict, deque
from datetime import date
from decimal import Decimal
from enum import Enum, IntEnum
from typing import Any

import pytest

from actr3d.values import DEEPEST, Opaque, plain, plain_to_json, to_json


class Colour(Enum):
    RED = 1


class Level(IntEnum):
    HIGH = 3


class Text(str):
    def __str__(self) -> str:
        raise AssertionError("a modeller's code was run")

    __repr__ = __str__


class Untouchable:
    """Complains of whatever is done to it."""

    def __getattribute__(self, name: str) -> Any:
        raise AssertionError(f"a modeller's code was run: {name}")

    def __repr__(self) -> str:
        raise AssertionError("a modeller's code was run")

    __str__ = __repr__


class Items(dict[str, int]):
    def items(self) -> Any:
        raise AssertionError("a modeller's code was run")


def strictly(line: str) -> Any:
    """Reads JSON as a strict reader does."""

    def refuse(name: str) -> None:
        raise AssertionError(f"{name} is not JSON")

    return json.loads(line.encode("utf-8"), parse_constant=refuse)


@pytest.mark.parametrize(
    ("value", "kept"),
    [
        (None, None),
        (0.1, 0.1),
        ({3, 1, 2}, [1, 2, 3]),
        (frozenset({"b", "a", (2, 1)}), [[2, 1], "a", "b"]),
        ((1, [2, deque([3])]), [1, [2, [3]]]),
        (OrderedDict({1: "a", (2, 3): {"b": ()}}), {"1": "a", "[2, 3]": {"b": []}}),
        (b"ab", "b'ab'"),
        (1 + 2j, "(1+2j)"),
        (Decimal("1.50"), "Decimal('1.50')"),
        (date(2024, 2, 3), "datetime.date(2024, 2, 3)"),
        (Colour.RED, "Colour.RED"),
        (Level.HIGH, "Level.HIGH"),
        (Items(a=1), {"a": 1}),
        (len, "<len>"),
        (Untouchable, "<Untouchable>"),
        ([object()], ["<object>"]),
    ],
)
def test_what_is_kept_of_a_value(value: Any, kept: Any) -> None:
    found = plain(value)
    assert found == kept
    assert json.loads(json.dumps(found)) == kept  # and of plain types through and through


def test_no_code_of_a_modellers_is_run() -> None:
    assert plain([Untouchable(), Text("word"), {Untouchable: Untouchable()}]) == [
        "<Untouchable>",
        "word",
        {"<Untouchable>": "<Untouchable>"},
    ]
    assert to_json([Text("word")]) == '["word"]'


def test_only_what_has_no_words_of_its_own_is_opaque() -> None:
    assert isinstance(plain(Untouchable()), Opaque)
    assert not isinstance(plain(b"a"), Opaque)
    assert not isinstance(plain("<Untouchable>"), Opaque)


def test_a_caller_may_name_what_it_knows() -> None:
    thing = Untouchable()
    assert plain({"a": [thing]}, lambda value: "known" if value is thing else None) == {"a": ["known"]}


def test_deep_cyclic_and_tangled_values_come_to_an_end() -> None:
    loop: list[Any] = [1]
    loop.append(loop)
    assert plain(loop) == [1, "..."]
    deep: list[Any] = []
    for _ in range(100_000):
        deep = [deep]
    assert to_json(plain(deep)) == "[" * DEEPEST + '"..."' + "]" * DEEPEST
    net: list[list[Any]] = [[] for _ in range(30)]
    for node in net:
        node.extend(net)
    assert len(to_json(plain(net))) < 10_000_000
    many = [[number] for number in range(50_000)]
    assert plain(many) == many
    shared = [1]
    assert plain([shared, shared]) == [[1], [1]]


def test_a_copy_shares_nothing() -> None:
    inner = {"a": [1]}
    kept = plain({"x": inner})
    inner["a"].append(2)
    assert kept == {"x": {"a": [1]}}


def test_json_is_valid_for_numbers_and_characters_that_it_does_not_have() -> None:
    huge = 10**5000
    odd = {"nan": float("-nan"), "inf": float("-inf"), "half": "\ud800", "word": "größe", "huge": huge, 1: {2, 1}}
    read = strictly(to_json(odd))
    assert read == {"nan": "nan", "inf": "-inf", "half": "\ud800", "word": "größe", "huge": hex(huge), "1": [1, 2]}
    assert strictly(to_json(Untouchable())) == "<Untouchable>"


@pytest.mark.parametrize(
    "value",
    [
        [1, "a", None, True, {"b": [1.5]}],
        "half \ud800",
        {"n": float("inf")},
        {"n": [None, float("nan")]},
        [10**6000],
        [-(2**64), 1e22, 5e-324, -0.0],
        "ü",
        ["x" * 1000],
    ],
)
def test_json_of_what_is_plain_already_is_the_same(value: Any) -> None:
    assert plain_to_json(value) == to_json(value)


def test_json_of_what_is_not_plain_after_all_is_that_of_its_plain_form() -> None:
    endless: list[Any] = []
    endless.append(endless)
    for value in ({1, 2}, {"of": object()}, endless):
        assert plain_to_json(value) == to_json(value)
