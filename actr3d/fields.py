"""Describes the fields of a configuration for users: the meaning, unit, bounds and default of each, as written once in its class.

Options of the command line, controls of a page and factors of an experiment are all made from these.
"""

from __future__ import annotations

import ast
import inspect
import re
import textwrap
from collections.abc import Mapping
from contextlib import suppress
from dataclasses import MISSING, dataclass, fields
from types import NoneType, UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin, get_type_hints

import annotated_types

_UNIT = re.compile(r"\[([^\]]+)\]")


@dataclass(frozen=True, kw_only=True)
class Field:
    """One field of a configuration."""

    name: str
    takes: str
    """The values it accepts: `number`, `whole number`, `text`, `True or False`, or the name of another type."""
    choices: tuple[Any, ...] | None
    """The possible values; None if they cannot be listed."""
    bounds: tuple[str, ...]
    """The bounds of its value, such as `> 0`."""
    optional: bool
    """Whether it may be None."""
    default: Any
    """Its default; `dataclasses.MISSING` if a value is required."""
    unit: str | None
    """The first text in square brackets in its docstring."""
    meaning: str
    """Its docstring, in one line."""

    @property
    def option(self) -> str:
        """Returns the name of its command-line option."""
        return "--" + self.name.replace("_", "-")

    def value(self, text: str) -> Any:
        """Returns the value of a text; a text that is not a Python literal is itself the value."""
        if text == "None" and self.optional:
            return None
        if self.takes == "text":
            return text
        return literal(text)

    def domain(self) -> str:
        """Returns the accepted values in one line: `> 0, <= 3 [m]`."""
        says = ", ".join([self.takes, *self.bounds]) if self.choices is None else " or ".join(map(str, self.choices))
        if self.optional:
            says += ", or None"
        return f"{says} [{self.unit}]" if self.unit else says


def literal(text: str) -> Any:
    """Returns the value of a Python literal: a number, text, tuple, True, False or None; any other text is returned unchanged."""
    try:
        return ast.literal_eval(text)
    except (ValueError, SyntaxError):
        return text


def fields_of(kind: type[Any]) -> tuple[Field, ...]:
    """Returns the fields of a frozen dataclass, in order.

    Args:
        kind: A `Configuration`, or any other dataclass.
    """
    hints = get_type_hints(kind, include_extras=True)
    words = _docstrings(kind)
    return tuple(_field(field, hints[field.name], words.get(field.name, "")) for field in fields(kind) if field.init)


def _field(field: Any, declared: Any, meaning: str) -> Field:
    bounds: list[str] = []
    optional = False
    while get_origin(declared) in (Annotated, Union, UnionType):
        parts = get_args(declared)
        if get_origin(declared) is Annotated:
            declared, *marks = parts
            bounds += [says for mark in marks if (says := _says(mark))]
        else:
            optional |= NoneType in parts
            declared = next(part for part in parts if part is not NoneType)
    takes = {float: "number", int: "whole number", str: "text", bool: "True or False"}.get(declared)
    choices = get_args(declared) if get_origin(declared) is Literal else (True, False) if declared is bool else None
    if choices is not None and all(isinstance(choice, str) for choice in choices):
        takes = "text"
    unit = _UNIT.search(meaning)
    return Field(
        name=field.name,
        takes=takes or getattr(get_origin(declared) or declared, "__name__", str(declared)),
        choices=choices,
        bounds=tuple(bounds),
        optional=optional,
        default=field.default if field.default_factory is MISSING else field.default_factory(),
        unit=unit and unit[1],
        meaning=meaning,
    )


def _says(mark: object) -> str:
    match mark:
        case annotated_types.Gt(gt=limit):
            return f"> {limit}"
        case annotated_types.Ge(ge=limit):
            return f">= {limit}"
        case annotated_types.Lt(lt=limit):
            return f"< {limit}"
        case annotated_types.Le(le=limit):
            return f"<= {limit}"
        case _:
            return ""


def _docstrings(kind: type[Any]) -> Mapping[str, str]:
    """Returns the docstrings below the fields of a class and of its base classes, if their source is available."""
    words: dict[str, str] = {}
    for one in reversed(kind.__mro__):
        with suppress(OSError, TypeError, SyntaxError):
            (node,) = ast.parse(textwrap.dedent(inspect.getsource(one))).body
            assert isinstance(node, ast.ClassDef)
            for field, below in zip(node.body, node.body[1:], strict=False):
                if isinstance(field, ast.AnnAssign) and isinstance(field.target, ast.Name):
                    match below:
                        case ast.Expr(value=ast.Constant(value=str(text))):
                            words[field.target.id] = " ".join(inspect.cleandoc(text).split())
                        case _:
                            words.pop(field.target.id, None)
    return words
