"""Checks the parameters that a module is made with, and given later: their names, and that numbers are numbers."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from functools import wraps
from numbers import Real
from typing import Any, Concatenate, ParamSpec, TypeVar
from weakref import WeakKeyDictionary

from actr3d.errors import ParameterError, did_you_mean
from actr3d.saying import warn_modeller

P = ParamSpec("P")
Self = TypeVar("Self")


def named_parameters(init: Callable[Concatenate[Self, P], None]) -> Callable[Concatenate[Self, P], None]:
    """Makes an `__init__` say clearly what is wrong with its parameters.

    Raises:
        ParameterError: If a parameter has no such name, is missing, or is no number where it should be one.
    """
    signature = inspect.signature(init)
    names = [name for name in signature.parameters if name != "self"]
    numeric = ("float", "float | None", "int", "int | None")
    numbers = {name: p.annotation for name, p in signature.parameters.items() if str(p.annotation) in numeric}

    @wraps(init)
    def checked(self: Self, *args: P.args, **keys: P.kwargs) -> None:
        kind = type(self).__name__
        unknown = [key for key in keys if key not in names]
        if unknown and not any(p.kind is p.VAR_KEYWORD for p in signature.parameters.values()):
            hint = did_you_mean(unknown[0], names)
            raise ParameterError(f"{kind} has no parameter '{unknown[0]}'{hint}; it has: {', '.join(names) or 'none'}")
        try:
            given: dict[str, Any] = signature.bind(self, *args, **keys).arguments
        except TypeError as error:
            raise ParameterError(f"{kind}({', '.join(names)}): {error}") from None
        for name in numbers.keys() & given.keys():
            value = given[name]
            if not isinstance(value, Real) and not (value is None and "None" in str(numbers[name])):
                raise ParameterError(f"{kind}.{name}: must be a number{' or None' if 'None' in str(numbers[name]) else ''} (got {value!r})")
        init(self, *args, **keys)

    return checked


NEAR = 0.8
"""How near a name must be to that of a parameter (0 to 1) to be taken for a slip."""


class WithParameters:
    """Something made with parameters, which may be set later: says so where one is set under a name that is only similar."""

    def __setattr__(self, name: str, value: Any) -> None:
        if name not in self.__dict__:
            warn_of_slip(self, name)
        super().__setattr__(name, value)

    def _settable(self) -> set[str]:
        """Returns what may be meant by a slip: parameters and attributes; nothing for a modeller's own class, which may
        have whatever attributes it likes.
        """
        kind = type(self)
        if not kind.__module__.startswith("actr3d."):
            return set()
        return {*inspect.signature(kind.__init__).parameters, *(name for name in vars(self) if name[0] != "_")} - {"self"}


def settable_of(part: WithParameters) -> set[str]:
    """Returns the names that may be meant by a misspelt attribute of a part."""
    return part._settable()


def warn_of_slip(part: WithParameters, name: str) -> None:
    """Warns of a new attribute that is named nearly like a parameter; it has no effect under that name."""
    if name[0] == "_":
        return
    hints = _HINTS.setdefault(type(part), {})
    if name not in hints:
        hints[name] = "" if hasattr(type(part), name) else slip_hint(name, settable_of(part))
    if hints[name]:
        warn_modeller(f"{type(part).__name__} has no parameter '{name}'{hints[name]}")


_HINTS: WeakKeyDictionary[type, dict[str, str]] = WeakKeyDictionary()


def slip_hint(name: str, known: set[str]) -> str:
    """Returns which parameter a name may mean, or an empty text where it is no slip: `times` beside `time` is none."""
    if any(name.startswith(other) or other.startswith(f"{name}_") for other in known):
        return ""
    return did_you_mean(name, known, NEAR)
