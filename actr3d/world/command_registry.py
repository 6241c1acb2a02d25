"""Registries of what bodies can do and sense: the functions of actuators and sensors by name."""

from __future__ import annotations

import inspect
import math
import re
from collections.abc import Callable, Collection, Mapping
from typing import Any, Generic, TypeVar, get_type_hints

from actr3d.errors import WorldError, did_you_mean, followed
from actr3d.registry import Registry
from actr3d.world.frames import FULL_TURN

B = TypeVar("B")
"""The type that the functions are for: `Body`."""

F = TypeVar("F", bound=Callable[..., Any])


class BodyFunction(Generic[B]):
    """One actuator or sensor of a body.

    Args:
        name: Its name.
        function: Carries it out, with the body as its first argument.
        available: Returns whether a body has it.
    """

    def __init__(self, name: str, function: Callable[..., Any], available: Callable[[B], bool]) -> None:
        self.name = name
        self.available = available
        self._function = function
        self.__module__, self.__qualname__ = function.__module__, function.__qualname__
        self._signature = inspect.signature(function)

    def __call__(self, body: Any, *values: Any, **named: Any) -> Any:
        """Carries it out.

        Raises:
            WorldError: If it does not take these values; with the values that it takes.
        """
        try:
            return self._function(body, *values, **named)
        except TypeError:
            try:
                self._signature.bind(body, *values, **named)
            except TypeError as error:
                raise WorldError(f"{body.name}: {self.name} takes ({self.takes}): {error}") from error
            raise

    @property
    def takes(self) -> str:
        """Its parameters, as Python writes them."""
        parameters = list(self._signature.parameters.values())[1:]
        return ", ".join(str(parameter.replace(annotation=inspect.Parameter.empty)) for parameter in parameters)

    @property
    def returns(self) -> Any:
        """The type of what it returns; None if it is not known here."""
        try:
            return get_type_hints(self._function).get("return")
        except NameError:  # a type that is imported only for type checkers
            return None

    @property
    def meaning(self) -> str:
        """Its effect, in one sentence."""
        return re.split(r"(?<=\.)\s", inspect.getdoc(self._function) or "")[0]


class CommandRegistry(Registry[BodyFunction[B]], Generic[B]):
    """All actuators, or all sensors, by name; a decorator that registers a function under its own name, which must be unique.

    Use it as `@sensor`, or as `@sensor.if_body(condition)` for a sensor that only some bodies have.
    """

    def __call__(self, function: F) -> F:
        """Registers a function for all bodies."""
        return self.if_body(lambda _: True)(function)

    def if_body(self, available: Callable[[B], bool]) -> Callable[[F], F]:
        """Returns a decorator that registers a function for the bodies that fulfil a condition."""

        def register(function: F) -> F:
            self.add(function.__name__, BodyFunction(function.__name__, function, available))
            return function

        return register

    def of(self, body: B) -> dict[str, BodyFunction[B]]:
        """Returns those that a body has by name, in the order of their registration."""
        return {name: function for name, function in self.items() if function.available(body)}


# -- checks of values


def checked_name(name: Any, names: Collection[str], whose: str, kind: str) -> str:
    """Returns a name if it is one of those that exist; the agent's code chooses it, so it may be anything.

    Args:
        name: The given name.
        names: Those that exist.
        whose: The owner of what they name, for the message.
        kind: The kind of what they name, for the message.

    Raises:
        WorldError: If it is none of them; with a list of them.
    """
    if isinstance(name, str) and name in names:
        return name
    has = f"it has {', '.join(names)}" if names else f"it has no {kind}s"
    shown, near = (f"'{name}'", did_you_mean(name, names)) if isinstance(name, str) else (repr(name), "")
    raise WorldError(f"{whose} has no {kind} {shown}{followed(near, has)}")


def checked_function(name: Any, functions: Mapping[str, BodyFunction[B]], whose: str, kind: str) -> BodyFunction[B]:
    """Returns the actuator or sensor of a name; the arguments are those of `checked_name`.

    Raises:
        WorldError: If there is none of this name.
    """
    if isinstance(name, str) and name in functions:
        return functions[name]
    first = name.partition(" ")[0] if isinstance(name, str) else ""
    if first in functions:
        takes = functions[first].takes
        how = f"Give its values as arguments of Python after the name: ({takes})" if takes else "It takes no values"
        raise WorldError(f"{whose} has no {kind} '{name}'; did you mean '{first}'? {how}")
    return functions[checked_name(name, functions, whose, kind)]


def checked_number(value: Any, what: str, least: float = -math.inf, most: float = math.inf) -> float:
    """Returns a finite number within bounds; accepts text such as "1.5", because patterns bind text.

    Raises:
        WorldError: If it is none.
    """
    if isinstance(value, bool):
        raise WorldError(f"{what}: must be a number (got {value!r})")
    try:
        given = float(value)
    except OverflowError:  # an integer beyond what floats hold
        given = math.inf
    except (TypeError, ValueError) as error:
        raise WorldError(f"{what}: must be a number (got {value!r})") from error
    if not math.isfinite(given):
        raise WorldError(f"{what}: must be a finite number (got {value!r})")
    if not least <= given <= most:
        bound = f">= {least:g}" if given < least else f"<= {most:g}"
        raise WorldError(f"{what}: must be {bound} (got {value!r})")
    return given


def checked_angle(value: Any, what: str, turns: int = 1) -> float:
    """Returns an angle [rad], at most some full turns to either side: a greater number is most often meant in degrees.

    Raises:
        WorldError: If it is none.
    """
    given = checked_number(value, what)
    if abs(given) > turns * FULL_TURN:
        bound = f"{'<=' if given > 0 else '>='} {math.copysign(turns * FULL_TURN, given):g} rad"
        full = "a full turn" if turns == 1 else f"{turns} full turns"
        degrees, rest = f"{given:g} degrees, math.radians({given:g})", f"math.remainder({given:g}, math.tau)"
        raise WorldError(f"{what}: must be {bound}, {full} (got {value!r}); did you mean {degrees}? Without full turns it is {rest}")
    return given


def checked_whole(value: Any, what: str, least: int, most: int) -> int:
    """Returns an integer within bounds; accepts text such as "3".

    Raises:
        WorldError: If it is none.
    """
    given = checked_number(value, what, least, most)
    if not given.is_integer():
        raise WorldError(f"{what}: must be a whole number (got {value!r})")
    return int(given)
