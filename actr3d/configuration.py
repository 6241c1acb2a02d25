"""The base class of every configuration: frozen values whose types and bounds are checked once, on creation."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping
from dataclasses import dataclass, fields
from numbers import Integral, Real
from operator import ge, gt, le, lt
from types import NoneType, UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin, get_type_hints

from annotated_types import Ge, Gt, Le, Lt, MinLen

from actr3d.errors import ConfigurationError, did_you_mean
from actr3d.weak_cache import weak_cache


@dataclass(frozen=True, init=False, repr=False)
class Live:
    """Marks a field's type: the value can be changed during a run, by the given command.

    `width: Annotated[float, Gt(0), Live("aperture")]` is changed by `simulation.command("aperture", width)`;
    `Live("parameter", "walker.speed")` by `simulation.command("parameter", "walker.speed", speed)`. The code that builds a run
    decides what the value means at its start.

    Args:
        word: The command.
        before: The arguments of the command before the value.
        body: The body that receives the command, if more than one body accepts it.
    """

    word: str
    before: tuple[str, ...]
    body: str | None

    def __init__(self, word: str, *before: str, body: str | None = None) -> None:
        for name, value in (("word", word), ("before", before), ("body", body)):
            object.__setattr__(self, name, value)  # it is frozen

    def __repr__(self) -> str:
        return f"Live({', '.join(map(repr, (self.word, *self.before)))}{f', body={self.body!r}' if self.body else ''})"


class Infinite:
    """Marks the type of a number that may be infinite: `Annotated[float, Infinite()]`."""


class InRadians:
    """Marks the type of an angle [rad]: the error of one that is too great asks whether it is in degrees."""


class Configuration:
    """Checks the fields of a frozen dataclass against their declared types and bounds.

    A subclass is a `@dataclass(frozen=True, kw_only=True)`. A field's bounds are part of its type, such as
    `Annotated[float, Gt(0)]` (from `annotated_types`: `Gt`, `Ge`, `Lt`, `Le`, `MinLen`); its unit and source are in the
    docstring below it. Whole numbers are accepted for `float`, and the numbers of other libraries, such as numpy, count as Python's;
    NaN is rejected, and infinities are, unless the type is marked `Infinite()`.
    """

    def __post_init__(self) -> None:
        """Checks every field.

        Raises:
            ConfigurationError: Names the class and field, the given value, and what is allowed.
        """
        hints = _hints(type(self))
        for field in fields(self):  # pyright: ignore[reportArgumentType] # subclasses are dataclasses
            value = getattr(self, field.name)
            kept = checked(value, hints[field.name], f"{type(self).__name__}.{field.name}")
            if kept is not value:
                object.__setattr__(self, field.name, kept)

    @classmethod
    def from_mapping(cls, values: Mapping[str, Any]) -> Any:
        """Creates a configuration from names and values, as read from a file or a page.

        Raises:
            ConfigurationError: If a name is not a field, or a value is not valid for its field.
        """
        known = [field.name for field in fields(cls)]  # pyright: ignore[reportArgumentType]
        for name in values:
            if name not in known:
                raise ConfigurationError(f"{cls.__name__} has no field '{name}'{did_you_mean(name, known)}")
        return cls(**values)


@weak_cache
def _hints(of: type) -> dict[str, Any]:
    return get_type_hints(of, include_extras=True)


def checked(value: Any, declared: Any, where: str) -> Any:
    """Returns the value converted to its declared type (an int for a float becomes a float, a list a tuple).

    Args:
        value: The value.
        declared: The type, which may have bounds.
        where: What it is the value of, for the error.

    Raises:
        ConfigurationError: If it has another type, or is out of bounds.
    """
    origin = get_origin(declared)
    if origin is Annotated:
        inner, *bounds = get_args(declared)
        endless = isinstance(value, Real) and abs(value) == math.inf and any(isinstance(bound, Infinite) for bound in bounds)
        found = float(value) if endless else checked(value, inner, where)
        degrees = isinstance(found, float) and abs(found) > math.pi and any(isinstance(bound, InRadians) for bound in bounds)
        for bound in bounds:
            check_bound(bound, found, where, f"; did you mean {found:g} degrees, math.radians({found:g})?" if degrees else "")
        return found
    if origin in (Union, UnionType):
        return _one_of(value, get_args(declared), where)
    if origin is Literal:
        options = get_args(declared)
        if any(isinstance(value, type(option)) and value == option for option in options):
            return value
        near = did_you_mean(value, options) if isinstance(value, str) else ""
        raise ConfigurationError(f"{where}: must be one of {', '.join(map(repr, options))} (got {value!r}){near}")
    if origin is tuple:
        return _tuple(value, get_args(declared), where)
    return _plain(value, origin or declared, where)


def _plain(value: Any, declared: Any, where: str) -> Any:
    if declared is Any or getattr(declared, "_is_protocol", False):  # it says what an object can do, which is not checked
        return value
    if declared is float:
        if not isinstance(value, bool) and isinstance(value, Real):
            if is_finite(value):
                return float(value)
            raise ConfigurationError(f"{where}: must be a finite number (got {value!r})")
    elif declared is int:
        if not isinstance(value, bool) and isinstance(value, Integral):
            return int(value)
    elif isinstance(declared, type) and isinstance(value, declared):
        return value
    names = {float: "a number", int: "a whole number", str: "text", bool: "True or False"}
    name = getattr(declared, "__name__", str(declared))
    wanted = names.get(declared) or f"{'an' if name[0] in 'AEIOU' else 'a'} {name}"
    raise ConfigurationError(f"{where}: must be {wanted} (got {value!r})")


def is_finite(value: Any) -> bool:
    """Checks whether a number is finite, also as a float: some whole numbers are too large for one."""
    try:
        return math.isfinite(value)
    except OverflowError:
        return False


def _one_of(value: Any, options: tuple[Any, ...], where: str) -> Any:
    if value is None and NoneType in options:
        return None
    refused: list[ConfigurationError] = []
    for option in options:
        if option is NoneType:
            continue
        try:
            return checked(value, option, where)
        except ConfigurationError as error:
            refused.append(error)
    raise refused[0]


def _tuple(value: Any, items: tuple[Any, ...], where: str) -> tuple[Any, ...]:
    if isinstance(value, (str, bytes)) or not hasattr(value, "__iter__"):
        raise ConfigurationError(f"{where}: must be a tuple (got {value!r})")
    try:
        values: tuple[Any, ...] = tuple(value)
    except TypeError:  # a zero-dimensional array
        raise ConfigurationError(f"{where}: must be a tuple (got {value!r})") from None
    if len(items) == 2 and items[1] is Ellipsis:
        items = (items[0],) * len(values)
    if len(values) != len(items):
        raise ConfigurationError(f"{where}: must have {len(items)} values (got {len(values)}: {value!r})")
    return tuple(checked(item, declared, f"{where}[{n}]") for n, (item, declared) in enumerate(zip(values, items, strict=True)))


_BOUNDS: dict[type, tuple[str, str, Callable[[Any, Any], bool]]] = {
    Gt: ("gt", "> {}", gt),
    Ge: ("ge", ">= {}", ge),
    Lt: ("lt", "< {}", lt),
    Le: ("le", "<= {}", le),
    MinLen: ("min_length", "at least {} long", lambda value, least: len(value) >= least),
}
"""By class of the bounds: the attribute that holds the limit, the words of an error, and whether a value fits a limit."""


def bound_words(bound: object) -> str:
    """Returns a bound in words: `> 0`."""
    attribute, words, _ = _BOUNDS[type(bound)]
    return words.format(getattr(bound, attribute))


def check_bound(bound: object, value: Any, where: str, hint: str = "") -> None:
    """Checks a value against one bound of a type, such as `Gt(0)`; anything that is not a bound is ignored. The error ends with the hint.

    Raises:
        ConfigurationError: If the value is out of bounds.
    """
    if value is None or type(bound) not in _BOUNDS:
        return
    attribute, _, fits = _BOUNDS[type(bound)]
    if not fits(value, getattr(bound, attribute)):
        raise ConfigurationError(f"{where}: must be {bound_words(bound)} (got {value!r}){hint}")
