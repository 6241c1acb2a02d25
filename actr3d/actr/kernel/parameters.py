"""Checks the parameters of modules when they are made and when they are changed: their names, and that numbers are numbers."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from functools import wraps
from numbers import Real
from typing import Any, Concatenate, ParamSpec, TypeVar
from weakref import WeakKeyDictionary

from actr3d.errors import ParameterError, did_you_mean
from actr3d.warnings import warn_modeller

P = ParamSpec("P")
Self = TypeVar("Self")


def named_parameters(init: Callable[Concatenate[Self, P], None]) -> Callable[Concatenate[Self, P], None]:
    """Makes an `__init__` check its parameters and explain what is wrong.

    Raises:
        ParameterError: If a parameter is unknown or missing, or is not a number where one is required.
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
"""The similarity to the name of a parameter (0 to 1) from which a name counts as misspelt."""


class WithParameters:
    """A module whose parameters may be set later; it warns if one is set under a misspelt name."""

    def __setattr__(self, name: str, value: Any) -> None:
        if name not in self.__dict__:
            warn_of_slip(self, name)
        super().__setattr__(name, value)

    def _settable(self) -> set[str]:
        """Returns the names that may be meant by a misspelt one: parameters and attributes; nothing for a modeller's own class,
        which may have any attributes.
        """
        kind = type(self)
        if not kind.__module__.startswith("actr3d."):
            return set()
        return {*inspect.signature(kind.__init__).parameters, *(name for name in vars(self) if name[0] != "_")} - {"self"}


def settable_of(part: WithParameters) -> set[str]:
    """Returns the names that may be meant by a misspelt attribute of a part."""
    return part._settable()  # pyright: ignore[reportPrivateUsage] # productions see every public name of a model


def warn_of_slip(part: WithParameters, name: str) -> None:
    """Warns about a new attribute whose name is similar to that of a parameter; it has no effect."""
    if name[0] == "_":
        return
    hints = _HINTS.setdefault(type(part), {})
    if name not in hints:
        hints[name] = "" if hasattr(type(part), name) else slip_hint(name, settable_of(part))
    if hints[name]:
        warn_modeller(f"{type(part).__name__} has no parameter '{name}'{hints[name]}")


_HINTS: WeakKeyDictionary[type, dict[str, str]] = WeakKeyDictionary()


def slip_hint(name: str, known: set[str]) -> str:
    """Returns a hint at the parameter that a name may mean, or an empty text if it is not misspelt: `times` is not, beside `time`."""
    if any(name.startswith(other) or other.startswith(f"{name}_") for other in known):
        return ""
    return did_you_mean(name, known, NEAR)
