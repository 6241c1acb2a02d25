"""Tries a production against a state, present or past, and says which condition fails first."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from actr3d.actr.chunk import as_text
from actr3d.actr.known import Fact, State, is_unknown
from actr3d.actr.pattern import Bindings, Condition, Missing, slot_named
from actr3d.errors import did_you_mean

if TYPE_CHECKING:
    from actr3d.actr.production import Production

AT_THE_LAST_MATCH = "as at the latest match"


@dataclass(frozen=True, kw_only=True)
class Failure:
    """A condition that does not hold, or of which that cannot be told."""

    condition: str
    expected: str
    found: str
    unknown: bool = False


class Trial:
    """Tries one production; `failure` is the first condition that fails, None where all hold.

    Args:
        production: The production.
        state: What it is tried against.
    """

    def __init__(self, production: Production, state: State) -> None:
        self._production = production
        self._state = state
        self._bound: Bindings = {}
        self._open: set[str] = set()
        """The variables that are bound, but nobody knows to what."""
        self.seen: str | None = None
        """How the facts that it rests on are known; None where all are certain."""
        self.failure: Failure | None = None
        for number, condition in enumerate(production.conditions):
            self.failure = self._failure(number, condition)
            if self.failure is not None:
                break

    @property
    def matches(self) -> bool | None:
        """Whether all conditions hold; None where that cannot be told."""
        return self.failure is None or (None if self.failure.unknown else False)

    @property
    def bindings(self) -> dict[str, str]:
        """What the conditions that hold have bound, as text."""
        return {name: as_text(value) for name, value in self._bound.items()}

    def _failure(self, number: int, condition: Condition) -> Failure | None:
        op, name, key, value = condition
        name = name or "self"
        system = self._production.system
        if op == "call":
            return self._failure_of_function(number, condition)
        if op == "empty":
            fact = self._known(self._state.empty(system, name))
            if is_unknown(fact.value):
                return self._unknown(f"{name}: None", "nothing in it", fact.seen)
            return None if fact.value else Failure(condition=f"{name}: None", expected="nothing in it", found="something")
        if isinstance(key, str) and key[:1] == "?":
            if key[1:] in self._open:
                return self._unknown(f"{name}: {condition}", f"a slot that ?{key[1:]} names", f"?{key[1:]} is not known")
            if key[1:] not in self._bound:
                return Failure(condition=f"{name}: {condition}", expected=f"a slot that ?{key[1:]} names", found=f"{key} is not bound")
            key = slot_named(self._bound[key[1:]])
        fact = self._known(self._state.slot(system, name, key))
        wanted = self._bound.get(value) if op in ("same", "differs") else value
        expected = _expected(condition, wanted)
        if is_unknown(fact.value) or (op in ("same", "differs") and value in self._open):
            if op == "bind":
                self._open.add(value)
            return self._unknown(f"{name}: {condition}", expected, fact.seen)
        if isinstance(fact.value, Missing):
            return Failure(condition=f"{name}: {condition}", expected=expected, found=self._nothing(name, key))
        if op in ("same", "differs") and value not in self._bound:
            return Failure(condition=f"{name}: {condition}", expected=expected, found=f"?{value} is not bound")
        if op == "bind":
            self._bound[value] = fact.value
        elif (fact.value == wanted) != (op in ("is", "same")):
            found = f"'{fact.value}'"
            return Failure(condition=f"{name}: {condition}", expected=expected, found=found)
        return None

    def _known(self, fact: Fact) -> Fact:
        if not is_unknown(fact.value):
            self.seen = fact.seen or self.seen
        return fact

    def _nothing(self, name: str, key: Any) -> str:
        known = self._state.slots(self._production.system, name)
        return f"no slot '{key}'{did_you_mean(str(key), known)}" if known else f"{name} is empty"

    def _failure_of_function(self, number: int, condition: Condition) -> Failure | None:
        answer = self._state.answer(self._production, number)
        text, expected = f"{condition.name or 'self'}: {condition}", "anything but False"
        if answer is None:
            return self._unknown(text, expected, "it has not been asked")
        self.seen = answer.seen
        if self._open or _texts(answer.given) != _texts(self._bound):
            with_what = " ".join(f"?{name}={as_text(value)}" for name, value in answer.given.items())
            return _not_known(text, expected, f"it was last asked with {with_what or 'no variables'}")
        if not answer.agrees:
            return Failure(condition=text, expected=expected, found="False, or an error for want of a slot")
        self._bound.update(answer.bound)
        return None

    def _unknown(self, text: str, expected: str, why: str | None) -> Failure | None:
        """Takes what cannot be told for true where the production matched last; else says so."""
        if self._state.matched(self._production):
            self.seen = AT_THE_LAST_MATCH
            return None
        return _not_known(text, expected, why or "it depends on what is not known")


def _not_known(text: str, expected: str, why: str) -> Failure:
    return Failure(condition=text, expected=expected, found=f"what is not known ({why})", unknown=True)


def _texts(bound: Bindings) -> dict[str, str]:
    return {name: as_text(value) for name, value in bound.items()}


def _expected(condition: Condition, wanted: Any) -> str:
    """Says what a condition on a slot expects."""
    op, value = condition.op, condition.value
    if op == "bind":
        return f"some value for ?{value}"
    named = f" (?{value})" if op in ("same", "differs") else ""
    return f"{'anything but ' if op in ('not', 'differs') else ''}'{wanted}'{named}"
