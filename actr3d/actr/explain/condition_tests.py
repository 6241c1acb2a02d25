"""Tests the conditions of a production against a current or past state, and finds the first that fails."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from actr3d.actr.chunks.chunk import as_text
from actr3d.actr.chunks.pattern import Bindings, Condition, Missing, by_variable, slot_named
from actr3d.actr.explain.state import AgentState, Fact, is_unknown
from actr3d.actr.kernel.noise import total
from actr3d.actr.procedural.production import Production
from actr3d.actr.procedural.production_system import system_of
from actr3d.actr.reasons import ConditionReason, ProductionReason
from actr3d.errors import did_you_mean

AT_THE_LAST_MATCH = "as at the latest match"


class ConditionTests:
    """Tests the conditions of one production; `failure` is the first condition that fails, None if all hold.

    The later conditions do not affect the result; `conditions` contains what is known about them.

    Args:
        production: The production.
        state: The state in which it is tested.
    """

    def __init__(self, production: Production, state: AgentState) -> None:
        self._production = production
        self._state = state
        self._bound: Bindings = {}
        self._open: set[str] = set()
        """The variables that are bound to an unknown value."""
        self._fact: str | None = None
        """What the current condition has found, and how that is known."""
        self._source: str | None = None
        self.source: str | None = None
        """How the facts that it depends on are known; None if all are certain."""
        self.bindings: dict[str, str] = {}
        """The variables bound by the conditions before the failing one, as text."""
        self.failure: ConditionReason | None = None
        """The first that does not hold, or for which this is not known."""
        self.conditions = tuple(self._try(number, condition) for number, condition in enumerate(production.conditions))

    @property
    def matches(self) -> bool | None:
        """Whether all conditions hold; None if that is not known."""
        return self.failure is None or self.failure.holds

    def _try(self, number: int, condition: Condition) -> ConditionReason:
        """Tests one condition; the first that fails decides the result."""
        settled = self.failure is not None
        self._fact = self._source = None
        failure = self._failure(number, condition)
        if not settled:
            self.failure = failure
            self.source = self._source or self.source
            self.bindings = {name: as_text(value) for name, value in self._bound.items()}
        if failure is not None:
            return replace(failure, source=self._source)
        return _reason(condition, self._expected(condition), self._fact or "unknown", holds=True, source=self._source)

    def _expected(self, condition: Condition) -> str:
        op, value = condition.op, condition.value
        if op == "empty":
            return "empty"
        if op == "call":
            return "anything but False"
        if op == "bind":
            return f"some value for ?{value}"
        wanted, named = (self._bound.get(value), f" (?{value})") if op in ("same", "differs") else (value, "")
        return f"{'anything but ' if op in ('not', 'differs') else ''}'{wanted}'{named}"

    def _failure(self, number: int, condition: Condition) -> ConditionReason | None:
        op, name, key, value = condition
        name = name or "self"
        if op == "call":
            return self._failure_of_function(number, condition)
        if op == "empty":
            fact = self._known(self._state.empty(self._production, name))
            if is_unknown(fact.value):
                return self._unknown(condition, "empty", fact.source)
            self._fact = "empty" if fact.value else "not empty"
            return None if fact.value else _reason(condition, "empty", self._fact)
        if by_variable(key):
            if key[1:] in self._open:
                return self._unknown(condition, f"a slot that ?{key[1:]} names", f"?{key[1:]} is not known")
            if key[1:] not in self._bound:
                return self._not_bound(condition, f"a slot that ?{key[1:]} names", key[1:])
            key = slot_named(self._bound[key[1:]])
        fact = self._known(self._state.slot(self._production, name, key))
        wanted = self._bound.get(value) if op in ("same", "differs") else value
        unbound = op in ("same", "differs") and value not in self._bound
        expected = f"{'anything but ' if op == 'differs' else ''}?{value}" if unbound else self._expected(condition)
        if is_unknown(fact.value) or (op in ("same", "differs") and value in self._open):
            if op == "bind":
                self._open.add(value)
            return self._unknown(condition, expected, fact.source)
        if isinstance(fact.value, Missing):
            return _reason(condition, expected, self._nothing(name, key))
        if unbound:
            return self._not_bound(condition, expected, value)
        self._fact = f"'{fact.value}'"
        if op == "bind":
            self._bound[value] = fact.value
        elif (fact.value == wanted) != (op in ("is", "same")):
            return _reason(condition, expected, self._fact)
        return None

    def _known(self, fact: Fact) -> Fact:
        if not is_unknown(fact.value):
            self._source = fact.source
        return fact

    def _nothing(self, name: str, key: Any) -> str:
        known = self._state.slots(self._production, name)
        return f"no slot '{key}'{did_you_mean(str(key), known)}" if known else f"{name} is empty"

    def _not_bound(self, condition: Condition, expected: str, variable: str) -> ConditionReason:
        """Returns the failure of an unbound variable; it is not certain if an earlier condition, which may bind it, has failed."""
        return _reason(condition, expected, f"?{variable} is not bound", holds=None if self.failure is not None else False)

    def _failure_of_function(self, number: int, condition: Condition) -> ConditionReason | None:
        result = self._state.function_result(self._production, number)
        expected = self._expected(condition)
        if self.failure is not None:
            return _not_known(condition, expected, "the function is called only if all conditions before it hold")
        if result is None:
            return self._unknown(condition, expected, "the function has not been called")
        self._source = result.source
        if self._open or _texts(result.given) != _texts(self._bound):
            with_what = " ".join(f"?{name}={as_text(value)}" for name, value in result.given.items())
            return _not_known(condition, expected, f"the function was last called with {with_what or 'no variables'}")
        if not result.agrees:
            return _reason(condition, expected, "False, or an error such as a missing slot")
        self._bound.update(result.bound)
        self._fact = "a value other than False"
        return None

    def _unknown(self, condition: Condition, expected: str, why: str | None) -> ConditionReason | None:
        """Returns None, for a condition that holds, if the production matched last; otherwise an unknown failure."""
        if self.failure is None and self._state.matched(self._production):
            self._source = AT_THE_LAST_MATCH
            return None
        return _not_known(condition, expected, why or "it depends on something unknown")


def _reason(condition: Condition, expected: str, found: str, *, holds: bool | None = False, source: str | None = None) -> ConditionReason:
    """Returns what is known about a condition, whose text has the name of the object that it tests."""
    text = f"{condition.name or 'self'}: {'None' if condition.op == 'empty' else condition}"
    return ConditionReason(condition=text, holds=holds, expected=expected, found=found, source=source)


def _not_known(condition: Condition, expected: str, why: str) -> ConditionReason:
    return _reason(condition, expected, f"unknown ({why})", holds=None)


def _texts(bound: Bindings) -> dict[str, str]:
    return {name: as_text(value) for name, value in bound.items()}


def why(production: Production, state: AgentState) -> ProductionReason:
    """Returns the reason of one production in a state."""
    tests = ConditionTests(production, state)
    failed = tests.failure
    choice = state.choice(production)
    none_drawn: dict[str, float] = {}
    drawn = none_drawn if choice is None else choice.parts.get(production.name, none_drawn)
    parts: dict[str, float | None] = {name: drawn.get(name) if value is None else value for name, value in state.parts(production).items()}
    if "get_activation" not in parts:
        parts = {"base": production.base_utility, **parts}
    known = [value for value in parts.values() if value is not None]
    return ProductionReason(
        name=production.name,
        system=state.path(system_of(production)),
        parents=production.parents,
        matches=tests.matches,
        condition=failed.condition if failed is not None else None,
        expected=failed.expected if failed is not None else None,
        found=failed.found if failed is not None else None,
        source=tests.source,
        bindings=tests.bindings,
        conditions=tests.conditions,
        utility=total(known) if len(known) == len(parts) else None,
        parts=parts,
        selected=choice is not None and choice.chosen == production.name,
        verdict=None if choice is None else choice.verdict(production.name),
    )
