"""Finds conditions of a production that cannot hold together."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from actr3d.actr.chunks.pattern import Condition
from actr3d.actr.procedural.production import Production
from actr3d.warnings import warn_at

Thing = tuple[str, Any, Any]
"""A slot ("slot", buffer, key) or a variable ("variable", name, None)."""


def check_contradictions(production: Production) -> None:
    """Warns if conditions exclude each other, in one slot or through the variables that they share."""
    tests = [condition for condition in production.conditions if condition.op != "call"]
    empty = {condition.name for condition in tests if condition.op == "empty"}
    filled = {condition.name for condition in tests if condition.op != "empty"}
    reasons = [f"'{name}' must be empty and contain a chunk at the same time" for name in sorted(str(n) for n in empty & filled)]
    slots: dict[tuple[str | None, Any], list[Condition]] = {}
    for condition in tests:
        slots.setdefault((condition.name, condition.key), []).append(condition)
    for (name, key), conditions in slots.items():
        reason = _in_one_slot(conditions)
        if reason:
            reasons.append(f"{name}'s slot '{key}' {reason}")
    if not reasons:
        reasons = _across_slots(tests)
    for reason in reasons:
        warn_at(f"production '{production.name}' can never match: {reason}", production.original_func)


def _in_one_slot(conditions: Iterable[Condition]) -> str:
    """Returns the contradiction in the conditions of one slot, or an empty text."""
    wanted: set[str] = set()
    refused: set[str] = set()
    same: set[str] = set()
    different: set[str] = set()
    sets = {"is": wanted, "not": refused, "bind": same, "same": same, "differs": different}
    for condition in conditions:
        sets.get(condition.op, set()).add(condition.value)
    if len(wanted) > 1:
        return f"must be {' and '.join(repr(v) for v in sorted(wanted))} at the same time"
    if wanted & refused:
        return f"must and must not be {wanted.pop()!r}"
    if same & different:
        return f"must and must not be ?{(same & different).pop()}"
    return ""


class _Equals:
    """The slots and variables that must have the same value, and the value if a condition names it."""

    def __init__(self) -> None:
        self._leads_to: dict[Thing, Thing] = {}
        self._values: dict[Thing, str] = {}

    def first(self, thing: Thing) -> Thing:
        """Returns the representative of all things equal to `thing`."""
        while thing in self._leads_to:
            thing = self._leads_to[thing]
        return thing

    def value(self, thing: Thing) -> str | None:
        """Returns the value that `thing` must have, if it is known."""
        return self._values.get(self.first(thing))

    def join(self, one: Thing, other: Thing) -> set[str]:
        """Records that two things are equal; returns the values that they must have, two if they cannot be equal."""
        one, other = self.first(one), self.first(other)
        known = {self._values[thing] for thing in (one, other) if thing in self._values}
        if one != other:
            self._leads_to[other] = one
        if known:
            self._values[one] = min(known)
        return known

    def give(self, thing: Thing, value: str) -> None:
        """Records a thing's value."""
        self._values.setdefault(self.first(thing), value)


def _across_slots(conditions: Iterable[Condition]) -> list[str]:
    """Returns the contradiction in variables that several slots share, as a list of at most one text."""
    equals = _Equals()
    pairs: list[tuple[Condition, Thing, Thing]] = []
    for condition in conditions:
        slot: Thing = ("slot", condition.name, condition.key)
        if condition.op == "is":
            equals.give(slot, condition.value)
        elif condition.op != "empty":
            pairs.append((condition, slot, ("variable", condition.value, None)))
    for condition, slot, variable in pairs:
        if condition.op in ("bind", "same"):
            values = sorted(equals.join(variable, slot))
            if len(values) > 1:
                return [f"?{condition.value} must be {values[0]!r} and {values[1]!r} at the same time"]
    for condition, slot, variable in pairs:
        where = f"{condition.name}'s slot '{condition.key}'"
        value = equals.value(slot)
        if condition.op == "not" and value == condition.value:
            return [f"{where} must not be {value!r}, but it must equal another slot that is"]
        if condition.op == "differs":
            if equals.first(slot) == equals.first(variable):
                return [f"{where} must and must not be the same as ?{condition.value}"]
            if value is not None and value == equals.value(variable):
                return [f"{where} must not be ?{condition.value}, but both must be {value!r}"]
    return []
