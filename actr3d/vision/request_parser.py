"""Reads requests: the feature to search for, and its required slots."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from operator import ge, gt, le, lt
from typing import Any, NamedTuple

from actr3d.actr.chunks.chunk import as_number, as_text, parse_slots, variable_value
from actr3d.configuration import check_bound
from actr3d.errors import VisionError, alternatives, did_you_mean, followed
from actr3d.vision.detectors.registry import Detector
from actr3d.vision.feature import Feature, slot_names
from actr3d.vision.units import FLAG, LABEL, PLAIN, Unit, units_of

_PIECE = re.compile(r"(>=|<=|>|<|!)?(\?\w+|[\w.+-]+)$")
HOLDS: dict[str, Callable[[Any, Any], bool]] = {">": gt, ">=": ge, "<": lt, "<=": le}
"""The comparisons by their signs."""
SIGN_TEXTS = {">": "above ", ">=": "at least ", "<": "below ", "<=": "at most ", "is": "", "!": "other than "}


class Test(NamedTuple):
    """A required value of a slot."""

    slot: str
    sign: str
    """`>`, `>=`, `<`, `<=`, `is` or `!`."""
    value: float | str
    """A number for comparisons; a text for equality."""

    def __str__(self) -> str:
        sign = "" if self.sign == "is" else self.sign
        return f"{self.slot}:{sign}{as_text(self.value)}"


@dataclass(frozen=True)
class Query:
    """A request that has been read."""

    detector: Detector
    parameters: tuple[tuple[str, float], ...]
    """Parameters of the detector, in its own units."""
    tests: tuple[Test, ...]
    asked: str
    """The request with the values of its variables."""

    def failing(self, feature: Feature) -> Test | None:
        """Returns the first test that a feature fails; None if it passes all."""
        for test in self.tests:
            slot, sign, wanted = test
            value = feature.shown(slot)
            if value is None:
                if sign != "!":
                    return test
            elif isinstance(wanted, str):
                if _equal(value, wanted) != (sign == "is"):
                    return test
            elif not HOLDS[sign](feature.at_most(slot, value) if sign[0] == ">" else value, wanted):
                return test
        return None


def refusal(test: Test, feature: Feature) -> str:
    """Returns in words why a feature fails a test."""
    value = feature.shown(test.slot)
    if value is None:
        return f"its {test.slot} is not known"
    return f"its {test.slot} is {as_text(value)}, not {SIGN_TEXTS[test.sign]}{as_text(test.value)}"


def read_request(
    pattern: str, given: Mapping[str, Any], detectors: Mapping[str, Detector], bound: Mapping[str, Any] | None, what: str
) -> Query:
    """Reads a request: `'feature:opening height:1.5'`, and more slots by keyword.

    Args:
        pattern: The text; it names the feature.
        given: Slots and the detector's parameters by keyword, as texts with signs and variables, or as numbers.
        detectors: The registered detectors.
        bound: The values of variables such as `?name`.
        what: The module, for messages.

    Raises:
        VisionError: If there is no such feature or slot, or a value is invalid.
        ChunkError: If a variable is not bound.
    """
    if not isinstance(pattern, str):  # pyright: ignore[reportUnnecessaryIsInstance] # a model's file
        raise VisionError(f"{what}: a request is a text such as 'feature:opening' (got {pattern!r})")
    pairs = parse_slots(pattern)
    words: dict[Any, str] = dict(pairs)
    name = words.pop("feature", None)
    known = ", ".join(f"feature:{known}" for known in detectors)
    if name is None or any(isinstance(slot, int) for slot in words):
        raise VisionError(f"{what}: the request '{pattern}' must name a feature and slots, all with their names; features: {known}")
    if name[:1] == "?":
        name = as_text(variable_value(name[1:], bound, pattern))
    if name not in detectors:
        raise VisionError(f"{what}: no feature '{name}' to look for{followed(did_you_mean(name, detectors), f'there are: {known}')}")
    twice = next((slot for n, (slot, _) in enumerate(pairs) if slot in [earlier for earlier, _ in pairs[:n]]), None)
    if twice is not None:
        raise VisionError(f"{what}: '{twice}' is given twice, in '{pattern}'; write {twice}='>1 <2' for two comparisons")
    twice = next((slot for slot in words if slot in given), None)
    if twice is not None:
        raise VisionError(f"{what}: '{twice}' is given twice, in '{pattern}' and as {twice}={given[twice]!r}")
    return _RequestReader(detectors[name], bound, what).read({**words, **given})


class _RequestReader:
    """Reads the slots of one request."""

    def __init__(self, detector: Detector, bound: Mapping[str, Any] | None, what: str) -> None:
        self._detector = detector
        self._kind = detector.finds
        units = units_of(detector.finds)
        self._units = {slot: units[slot] for slot in slot_names(detector.finds)}
        self._bound = bound
        self._what = f"{what}: feature:{detector.name}"

    def read(self, words: Mapping[Any, Any]) -> Query:
        parameters: list[tuple[str, float]] = []
        tests: list[Test] = []
        for word, value in words.items():
            slot = self._kind.aliases.get(word, word)
            if slot in self._units:
                tests += self._tests(slot, word, value)
            elif word in self._detector.parameters:
                parameters.append((word, self._parameter(word, value)))
            else:
                known = [*self._units, *self._kind.aliases, *self._detector.parameters]
                raise VisionError(f"{self._what} has no '{word}'{alternatives(str(word), known, 'it has:')}")
        given = [f"{name}:{self._detector.unit(name).shown(value):g}" for name, value in parameters]
        asked = " ".join([f"feature:{self._detector.name}", *map(str, tests), *given])
        return Query(self._detector, tuple(parameters), tuple(tests), asked)

    def _tests(self, slot: str, word: str, value: Any) -> list[Test]:
        """Returns the tests of a slot's value; a text may hold several comparisons, as '>0.5 <2'."""
        unit = self._units[slot]
        tests: list[Test] = []
        for sign, part in self._pieces(word, value):
            if unit in (LABEL, FLAG) or (unit is PLAIN and sign in ("", "!")):
                if sign not in ("", "!"):
                    raise VisionError(f"{self._what}: {word} cannot be compared by size (got {value!r})")
                tests.append(Test(slot, sign or "is", self._same(unit, word, part)))
                continue
            number = math.inf if as_text(part) == "inf" else as_number(part)  # an opening may have no end
            if number is None:
                raise VisionError(f"{self._what}: {word} is compared with a number in {unit.name or 'its unit'} (got {value!r})")
            sign = sign or self._kind.default_comparisons.get(slot, "")
            if sign in ("", "!"):
                choice = f"'>{as_text(part)}' or '<{as_text(part)}'"
                raise VisionError(f"{self._what}: {word} needs a comparison: write {choice} (got {value!r})")
            tests.append(Test(slot, sign, number))
        return tests

    def _same(self, unit: Unit, word: str, part: Any) -> str:
        """Returns the text to compare with a label, or with a value without a unit."""
        number = as_number(part)
        if unit is LABEL:
            if number is not None and number.is_integer():
                return str(int(number))
            raise VisionError(f"{self._what}: {word} takes a label, a whole number (got {part!r})")
        if unit is FLAG and as_text(part) not in ("True", "False"):
            raise VisionError(f"{self._what}: {word} takes True or False (got {part!r})")
        if number is None and not isinstance(part, (str, bool)):
            raise VisionError(f"{self._what}: {word} takes a number or text (got {part!r})")
        return as_text(part)

    def _pieces(self, word: str, value: Any) -> list[tuple[str, Any]]:
        """Splits a value into signs and values, with those of variables."""
        if not isinstance(value, str):
            return [("", value)]
        pieces: list[tuple[str, Any]] = []
        for text in value.split():
            found = _PIECE.match(text)
            if found is None:
                raise VisionError(f"{self._what}: cannot read {word}={value!r}; write a number or ?name, with >, <, >=, <= or ! before it")
            part: Any = found[2]
            if part[0] == "?":
                part = variable_value(part[1:], self._bound, f"{word}={value!r}")
            pieces.append((found[1] or "", part))
        if not pieces:
            raise VisionError(f"{self._what}: {word} has no value (got {value!r})")
        return pieces

    def _parameter(self, word: str, value: Any) -> float:
        ((sign, part), *more) = self._pieces(word, value)
        number = as_number(part)
        if sign or more or number is None:
            raise VisionError(f"{self._what}: {word} takes one number [{self._detector.unit(word).name}] (got {value!r})")
        for bound in self._detector.bounds(word):
            check_bound(bound, number, f"{self._what}: {word}")
        return number / self._detector.unit(word).factor


def _equal(value: Any, wanted: str) -> bool:
    """Returns whether a value is the wanted one: the same number, or the same text."""
    numbers = as_number(value), as_number(wanted)
    return numbers[0] == numbers[1] if None not in numbers else as_text(value) == wanted
