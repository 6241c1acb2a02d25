"""The parameters of a model: name, type, bounds, unit, help and default of each, read from a class or from a model's text alone.

Options of the command line, controls of the page, REST and the worker of a run all use this one description.
"""

from __future__ import annotations

import ast
import inspect
import math
import re
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import MISSING, dataclass, fields, replace
from functools import lru_cache
from itertools import zip_longest
from types import NoneType, UnionType
from typing import Annotated, Any, Literal, Union, cast, get_args, get_origin, get_type_hints

import annotated_types

from actr3d.actr.kernel.source_code import parse, source_of_module, syntax_tree
from actr3d.configuration import Live, bound_words, check_bound, is_finite
from actr3d.errors import ConfigurationError
from actr3d.values import escape_surrogates

_UNIT = re.compile(r"\[([^\]]+)\]")
_TAKES = {"float": "number", "int": "whole number", "str": "text", "bool": "switch"}
_BOUNDS = {"Gt": "above", "Ge": "least", "Lt": "below", "Le": "most"}
"""The bounds of `annotated_types`, by class, and the fields of a `Parameter` that hold them."""
_NOT_LITERAL = (ValueError, SyntaxError, TypeError, MemoryError, RecursionError)
"""What `ast.literal_eval` raises for a text that is not a literal."""


@dataclass(frozen=True, kw_only=True)
class Parameter:
    """One parameter of a model."""

    name: str
    takes: str
    """`number`, `whole number`, `text`, `switch`, `choice`, or the text of any other declared type; `value` if none is declared."""
    required: bool = False
    """Whether it has no default."""
    default: Any = None
    known: bool = True
    """Whether the default is known without executing code; otherwise `default` is its source text."""
    optional: bool = False
    """Whether it may be None."""
    choices: tuple[Any, ...] | None = None
    above: float | None = None
    least: float | None = None
    below: float | None = None
    most: float | None = None
    unit: str | None = None
    """The first text in square brackets in its docstring."""
    help: str = ""
    """Its docstring, in one line."""
    line: int = 0
    """Its line in the model's text; 0 if it was read from a class."""
    live: Live | None = None
    """How the parameter is changed during a run; None if a change needs a new run."""

    @property
    def option(self) -> str:
        """Returns the name of its command-line option."""
        return "--" + self.name.replace("_", "-")

    @property
    def _bounds(self) -> list[object]:
        limits = {kind: getattr(self, field) for kind, field in _BOUNDS.items()}
        return [getattr(annotated_types, kind)(limit) for kind, limit in limits.items() if limit is not None]

    def value(self, text: str) -> Any:
        """Returns the value of a text; a text that is not a Python literal is itself the value."""
        if text == "None" and self.optional:
            return None
        if self.takes == "text" or (self.choices is not None and all(isinstance(choice, str) for choice in self.choices)):
            return text
        return literal(text)

    def domain(self) -> str:
        """Returns the accepted values in one line: `number, > 0, <= 3 [m]`."""
        says = "True or False" if self.takes == "switch" else ", ".join([self.takes, *map(bound_words, self._bounds)])
        if self.choices is not None:
            says = " or ".join(map(str, self.choices))
        if self.optional:
            says += ", or None"
        return f"{says} [{self.unit}]" if self.unit else says

    def check(self, value: Any) -> None:
        """Checks a value against the parameter's type and bounds.

        Raises:
            ConfigurationError: If the value is not allowed.
        """
        if value is None and self.optional:
            return
        if self.takes in ("number", "whole number"):
            split = self.takes == "whole number" and isinstance(value, float)
            if split or isinstance(value, bool) or not isinstance(value, (int, float)) or not is_finite(value):
                raise ConfigurationError(f"{self.name}: must be a {self.takes} (got {value!r})")
            for bound in self._bounds:
                check_bound(bound, value, self.name)
        elif self.choices is not None and value not in self.choices:
            raise ConfigurationError(f"{self.name}: must be one of {', '.join(map(repr, self.choices))} (got {value!r})")
        elif (self.takes == "switch" and not isinstance(value, bool)) or (self.takes == "text" and not isinstance(value, str)):
            raise ConfigurationError(f"{self.name}: must be {self.domain()} (got {value!r})")
        elif value == "" and self.takes == "value" and self.known and not isinstance(self.default, (str, NoneType)):
            raise ConfigurationError(f"{self.name}: must be a value such as {self.default!r}, not an empty text")


def literal(text: str) -> Any:
    """Returns the value of a Python literal: a number, text, tuple, True, False or None; any other text is returned unchanged.

    True and False may be written in small letters, too.
    """
    try:
        return ast.literal_eval(text.capitalize() if text in ("true", "false") else text)
    except _NOT_LITERAL:
        return text


# -- from a class


def parameters_of(kind: type[Any]) -> tuple[Parameter, ...]:
    """Returns the fields of a frozen dataclass as parameters, in order.

    Args:
        kind: A `Configuration`, or any other dataclass.
    """
    hints = get_type_hints(kind, include_extras=True)
    words = _docstrings(kind)
    return tuple(_of_field(field, hints[field.name], words.get(field.name, "")) for field in fields(kind) if field.init)


def _of_field(field: Any, declared: Any, words: str) -> Parameter:
    unit = _UNIT.search(words)
    required = field.default is MISSING and field.default_factory is MISSING
    default = None if required else field.default if field.default_factory is MISSING else field.default_factory()
    found = Parameter(name=field.name, takes="", required=required, default=default, unit=unit and unit[1], help=words)
    while get_origin(declared) in (Annotated, Union, UnionType):
        parts = get_args(declared)
        if get_origin(declared) is Annotated:
            declared, *marks = parts
            for mark in marks:
                found = _with_mark(found, mark)
        else:
            found = replace(found, optional=found.optional or NoneType in parts)
            several = [part for part in parts if part is not NoneType]
            if len(several) > 1:
                return replace(found, takes="number" if set(several) == {int, float} else " | ".join(map(_name_of, several)))
            (declared,) = several
    if get_origin(declared) is Literal:
        return replace(found, takes="choice", choices=get_args(declared))
    name = _name_of(declared)
    return replace(found, takes=_TAKES.get(name, name))


def _name_of(declared: Any) -> str:
    return getattr(get_origin(declared) or declared, "__name__", str(declared))


def _with_mark(found: Parameter, mark: object) -> Parameter:
    if isinstance(mark, Live):
        return replace(found, live=mark)
    name = type(mark).__name__
    is_bound = isinstance(mark, annotated_types.BaseMetadata) and name in _BOUNDS
    return replace(found, **{_BOUNDS[name]: getattr(mark, name.lower())}) if is_bound else found


def _docstrings(kind: type[Any]) -> Mapping[str, str]:
    """Returns the docstrings below the fields of a class and of its base classes, if their source is available."""
    words: dict[str, str] = {}
    for one in reversed(kind.__mro__):
        for name, below in _docstrings_in(source_of_module(one.__module__)).get(one.__qualname__, ()):
            if below is None:
                words.pop(name, None)
            else:
                words[name] = below
    return words


@lru_cache(maxsize=64)
def _docstrings_in(text: str) -> Mapping[str, Sequence[tuple[str, str | None]]]:
    """Returns by qualified name of each class in a file's text its fields, with the docstrings below them; None for none."""
    found: dict[str, Sequence[tuple[str, str | None]]] = {}

    def collect(node: ast.AST, path: str) -> None:
        if isinstance(node, ast.ClassDef):
            found.setdefault(path + node.name, tuple((name, below) for name, _, below in _fields_in(node)))
        if isinstance(node, (ast.ClassDef, ast.FunctionDef, ast.AsyncFunctionDef)):
            path += f"{node.name}." if isinstance(node, ast.ClassDef) else f"{node.name}.<locals>."
        for child in ast.iter_child_nodes(node):
            if not isinstance(child, ast.expr):
                collect(child, path)

    collect(syntax_tree(text), "")
    return found


def _fields_in(node: ast.ClassDef) -> Iterator[tuple[str, ast.AnnAssign, str | None]]:
    """Yields the name and definition of each field of a class, with the docstring below it in one line; None for none."""
    for field, below in zip_longest(node.body, node.body[1:]):
        if isinstance(field, ast.AnnAssign) and isinstance(field.target, ast.Name):
            match below:
                case ast.Expr(value=ast.Constant(value=str(text))):
                    yield field.target.id, field, " ".join(escape_surrogates(inspect.cleandoc(text)).split())
                case _:
                    yield field.target.id, field, None


# -- from a text


def parameters_in(tree: ast.Module, build: ast.FunctionDef | None) -> Iterator[Parameter]:
    """Yields the fields of the parameter class of `build`, if it is defined in the same file; nothing is executed.

    Args:
        tree: The model's text.
        build: Its function `build`; None if there is none.
    """
    argument = build.args.args[0] if build is not None and build.args.args else None
    if argument is None or argument.annotation is None:
        return
    classes = {node.name: node for node in tree.body if isinstance(node, ast.ClassDef)}
    kind = classes.get(ast.unparse(argument.annotation).strip("'\""))
    constants = dict(_constants(tree))
    for name, node, words in _fields_in(kind) if kind is not None else ():
        unit = _UNIT.search(words or "")
        declared = _declared(Parameter(name=name, takes=""), node.annotation, constants)
        default = default_of(node.value, constants)
        yield replace(declared, **default, help=words or "", unit=unit and unit[1], line=node.lineno)


def _declared(parameter: Parameter, annotation: ast.expr, constants: Mapping[str, Any]) -> Parameter:
    """Returns a parameter completed with its declared type."""
    if isinstance(annotation, ast.Constant) and isinstance(annotation.value, str):
        try:
            return _declared(parameter, parse(annotation.value, mode="eval").body, constants)
        except (SyntaxError, ValueError):  # for example while it is being typed
            return replace(parameter, takes=escape_surrogates(annotation.value))
    if isinstance(annotation, ast.BinOp) and isinstance(annotation.op, ast.BitOr):
        sides = [side for side in (annotation.left, annotation.right) if ast.unparse(side) != "None"]
        inner = _declared(parameter, (sides or [annotation.left])[0], constants)
        return replace(inner, optional=True) if len(sides) == 1 else replace(inner, takes=ast.unparse(annotation))
    if isinstance(annotation, ast.Subscript):
        name = ast.unparse(annotation.value).rpartition(".")[2]
        inside = annotation.slice.elts if isinstance(annotation.slice, ast.Tuple) else [annotation.slice]
        if not inside:
            return replace(parameter, takes=ast.unparse(annotation))
        if name == "Annotated":
            for mark in inside[1:]:
                parameter = _marked(parameter, mark, constants)
            return _declared(parameter, inside[0], constants)
        if name == "Optional":
            return replace(_declared(parameter, inside[0], constants), optional=True)
        if name == "Literal":
            with suppress(ValueError):
                return replace(parameter, takes="choice", choices=tuple(_value(choice, constants) for choice in inside))
    text = ast.unparse(annotation)
    return replace(parameter, takes=_TAKES.get(text, text))


def _marked(parameter: Parameter, mark: ast.expr, constants: Mapping[str, Any]) -> Parameter:
    """Returns a parameter completed with one annotation of its type: a bound, or how it changes live."""
    if not isinstance(mark, ast.Call):
        return parameter
    name = ast.unparse(mark.func).rpartition(".")[2]
    try:
        values = [_value(value, constants) for value in mark.args]
        named = {word.arg: _value(word.value, constants) for word in mark.keywords if word.arg is not None}
    except ValueError:
        return parameter
    if name in _BOUNDS and [*values, *named.values()]:
        return replace(parameter, **{_BOUNDS[name]: [*values, *named.values()][0]})
    if name == "Live" and values:
        return replace(parameter, live=Live(*values, body=named.get("body")))
    return parameter


def _constants(tree: ast.Module) -> Iterator[tuple[str, Any]]:
    for node in tree.body:
        if isinstance(node, ast.Assign) and len(node.targets) == 1 and isinstance(node.targets[0], ast.Name):
            try:
                yield node.targets[0].id, ast.literal_eval(node.value)
            except _NOT_LITERAL:
                continue


def default_of(node: ast.expr | None, constants: Mapping[str, Any]) -> dict[str, Any]:
    """Returns the fields of a `Parameter` that describe a default; None means that there is none."""
    if node is None:
        return {"default": None, "known": False, "required": True}
    try:
        return {"default": _value(node, constants), "known": True}
    except ValueError:
        return {"default": ast.unparse(node), "known": False}


def _value(node: ast.expr, constants: Mapping[str, Any]) -> Any:
    """Returns the value of a literal or of the name of a constant; a JSON form of it must exist.

    Raises:
        ValueError: If the expression is anything else.
    """
    if isinstance(node, ast.Name) and node.id in constants:
        return constants[node.id]
    try:
        value = ast.literal_eval(node)
    except _NOT_LITERAL:
        raise ValueError(ast.unparse(node)) from None
    if not _fits_json(value):
        raise ValueError(ast.unparse(node))
    return value


def _fits_json(value: Any) -> bool:
    """Returns whether JSON can represent a value."""
    if isinstance(value, float):
        return math.isfinite(value)
    if isinstance(value, str):
        return value == escape_surrogates(value)
    if isinstance(value, (list, tuple)):
        return all(map(_fits_json, cast("Sequence[Any]", value)))
    if isinstance(value, dict):
        entries = cast("dict[Any, Any]", value)
        return all(isinstance(key, str) and _fits_json(key) and _fits_json(each) for key, each in entries.items())
    return value is None or isinstance(value, int)
