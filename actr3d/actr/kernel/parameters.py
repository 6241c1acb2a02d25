"""Checks the parameters of modules when they are made and when they are changed: their names, types and bounds."""

from __future__ import annotations

import inspect
import math
import sys
from collections.abc import Callable, Iterator
from functools import cache, wraps
from itertools import islice
from typing import Annotated, Any, ClassVar, Concatenate, ParamSpec, TypeVar, cast

from annotated_types import Ge, Gt

from actr3d.configuration import Infinite, checked
from actr3d.errors import ConfigurationError, ParameterError, alternatives, did_you_mean
from actr3d.warnings import warn_modeller

P = ParamSpec("P")
Self = TypeVar("Self")
NotNegative = Annotated[float, Ge(0)]
"""A number >= 0, such as a time [s] or the scale of noise."""
Positive = Annotated[float, Gt(0)]
"""A number > 0."""
Count = Annotated[int, Ge(0)]
"""How many there are of something."""
Extended = Annotated[float, Infinite()]
"""A number that may be infinite, such as a threshold."""


def named_parameters(init: Callable[Concatenate[Self, P], None]) -> Callable[Concatenate[Self, P], None]:
    """Makes an `__init__` check its parameters and explain what is wrong: their names, and the types and bounds of their annotations.

    Raises:
        ParameterError: If a parameter is unknown or missing, of another type, or out of bounds.
    """
    signature = inspect.signature(init)
    names = [name for name in signature.parameters if name != "self"]

    @cache
    def declared() -> dict[str, Any]:
        return {name: kind for name in names for kind in _declared_by(init, name)}

    @wraps(init)
    def with_checks(self: Self, *args: P.args, **keys: P.kwargs) -> None:
        kind = type(self).__name__
        unknown = [key for key in keys if key not in names]
        if unknown and not any(p.kind is p.VAR_KEYWORD for p in signature.parameters.values()):
            raise ParameterError(f"{kind} has no parameter '{unknown[0]}'{alternatives(unknown[0], names, 'it has:')}{elsewhere(self)}")
        try:
            given: dict[str, Any] = signature.bind(self, *args, **keys).arguments
        except TypeError as error:
            raise ParameterError(f"{kind}({', '.join(names)}): {error}{elsewhere(self)}") from None
        for name, wanted in declared().items():
            if name in given:
                several = signature.parameters[name].kind is inspect.Parameter.VAR_POSITIONAL
                for value in given[name] if several else (given[name],):
                    _check(value, wanted, f"{kind}.{name}")
        init(self, *args, **keys)

    return with_checks


NEAR = 0.8
"""The similarity to the name of a parameter (0 to 1) from which a name counts as misspelt."""


class WithParameters:
    """A module whose parameters may be set later, and are checked then, too; it warns if one is set under a misspelt name."""

    _unchecked: ClassVar[set[str]]
    """The names of attributes of the class that are neither parameters nor similar to one."""
    _parameters: ClassVar[frozenset[str]]
    """The names of the parameters that the library's own classes declare: those in the bodies of classes hold for a modeller's classes
    derived from them, too; those of `__init__` unless a modeller's class has its own."""

    def __init_subclass__(cls, **options: Any) -> None:
        super().__init_subclass__(**options)
        library = [base for base in cls.__mro__ if issubclass(base, WithParameters) and base.__module__.startswith("actr3d.")]
        names = {name for base in library for name in inspect.get_annotations(base)}
        if getattr(cls.__init__, "__module__", "").startswith("actr3d."):
            several = (inspect.Parameter.VAR_POSITIONAL, inspect.Parameter.VAR_KEYWORD)
            names |= {name for name, one in inspect.signature(cls.__init__).parameters.items() if one.kind not in several}
        cls._unchecked = set()
        cls._parameters = frozenset(name for name in names - {"self"} if name[0] != "_")

    def __setattr__(self, name: str, value: Any) -> None:
        if name not in self._unchecked:
            self._check_assignment(name, value)
        super().__setattr__(name, value)

    def _check_assignment(self, name: str, value: Any) -> None:
        """Checks a value for a parameter; warns about a new attribute whose name is similar to that of a parameter: it has no effect.

        Raises:
            ParameterError: If the parameter cannot have that value.
        """
        kind = type(self)
        if name in self._parameters:
            check_attribute(kind, name, value)
        elif name[0] == "_" or hasattr(kind, name):
            self._unchecked.add(name)
        elif name not in self.__dict__:
            if hint := misspelling_hint(name, self._settable()):
                warn_modeller(f"{kind.__name__} has no parameter '{name}'{hint}")
            else:
                self._unchecked.add(name)

    def _settable(self) -> set[str]:
        """Returns the names that may be meant by a misspelt one: parameters and attributes; nothing for a modeller's own class,
        which may have any attributes.
        """
        kind = type(self)
        if not kind.__module__.startswith("actr3d."):
            return set()
        return {*inspect.signature(kind.__init__).parameters, *(name for name in vars(self) if name[0] != "_")} - {"self"}


ELSEWHERE: dict[type, str] = {}
"""By kind of module: which other module of the same name a modeller may have meant."""


def elsewhere(module: object) -> str:
    """Returns a hint at another module of the same name, for the end of an error message; empty if there is none."""
    words = ELSEWHERE.get(type(module), "")
    return words and f"; {words}"


def settable_of(part: WithParameters) -> set[str]:
    """Returns the names that may be meant by a misspelt attribute of a part."""
    return part._settable()  # pyright: ignore[reportPrivateUsage] # productions see every public name of a model


def misspelling_hint(name: str, known: set[str]) -> str:
    """Returns a hint for a name that looks like a misspelt parameter; otherwise an empty text.

    A name that extends a known one (`times`, where there is `time`), or is the first words of one, does not count as misspelt.
    """
    if any(name.startswith(other) or other.startswith(f"{name}_") for other in known):
        return ""
    return did_you_mean(name, known, NEAR)


def check_parameter(part: Any, name: str, value: Any, where: str) -> None:
    """Checks a new value of a part's parameter.

    It must be of the type, and within the bounds, that a class of the part declares in its body or as a parameter of `__init__`. If no
    class declares it: of the type of the present value, or None.

    Args:
        part: The part.
        name: The name of the parameter.
        value: The new value.
        where: The parameter, for the error.

    Raises:
        ParameterError: If it cannot have that value.
    """
    kind = cast("type[Any]", type(part))
    _check(value, next(_declared(kind, name), _kind_of(vars(part)[name])), where)


def check_number(value: Any, where: str, *, infinite: bool = False, nan: bool = False) -> None:
    """Checks a number that a model gives; it may be of another library, and True and False count as 1 and 0.

    Args:
        value: The number.
        where: What it is, for the error.
        infinite: Whether it may be infinite.
        nan: Whether it may be nan.

    Raises:
        ParameterError: If it is not a number, or one that it may not be.
    """
    try:
        number = None if isinstance(value, (str, bytes)) else float(value)
    except (TypeError, ValueError, OverflowError):
        number = None
    if number is None or (not nan and math.isnan(number)) or (not infinite and math.isinf(number)):
        raise ParameterError(f"{where}: must be a {'' if infinite else 'finite '}number (got {value!r})")


def check_attribute(kind: type, name: str, value: Any) -> None:
    """Checks a value that a class sets for a parameter against the type that the class, or one that it inherits from, declares.

    Raises:
        ParameterError: If it cannot have that value.
    """
    for declared in islice(_declared(kind, name), 1):
        _check(value, declared, f"{kind.__name__}.{name}")


def _check(value: Any, declared: Any, where: str) -> None:
    """Checks a value against a type with bounds.

    Raises:
        ParameterError: If it is of another type, or out of bounds.
    """
    try:
        checked(value, declared, where)
    except ConfigurationError as error:
        raise ParameterError(str(error)) from None


def _kind_of(value: Any) -> Any:
    """Returns the type of the values that can follow an undeclared one."""
    if value is None:
        return Any
    kind = cast("type[Any]", type(value))
    return float | None if kind in (int, float) else kind | None


def _declared(kind: type, name: str) -> Iterator[Any]:
    """Yields the types that classes declare for a parameter, those in their bodies first."""
    inits = [inspect.unwrap(vars(base)["__init__"]) for base in kind.__mro__ if "__init__" in vars(base)]
    holders: list[Any] = [*kind.__mro__, *inits]
    for holder in holders:
        yield from _declared_by(holder, name)


def _declared_by(holder: Any, name: str) -> Iterator[Any]:
    """Yields the type that a class's body or a function declares for a name, if it declares one."""
    written = inspect.get_annotations(holder).get(name)
    if isinstance(written, str):
        try:
            written = eval(written, vars(sys.modules[holder.__module__]))
        except Exception:  # noqa: BLE001 - a name that only type checkers know
            return
    if written is not None:
        yield written
