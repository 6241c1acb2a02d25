"""Checks the parameters that a module is made with: their names, and that numbers are numbers."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from functools import wraps
from numbers import Real
from typing import Any, Concatenate, ParamSpec, TypeVar

from actr3d.errors import ParameterError, did_you_mean

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
