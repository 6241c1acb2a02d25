"""Describes model files from their text alone: listing a file never executes it."""

from __future__ import annotations

import ast
import inspect
import math
import re
import warnings
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, field, replace
from typing import Any, cast

from actr3d.actr.kernel.source_code import parse, syntax_tree
from actr3d.actr.loading.source_text import compile_source
from actr3d.actr.loading.sweep import parameters as first_lines
from actr3d.errors import ConfigurationError, ModelFileError, did_you_mean
from actr3d.runner.build_check import build_of, has_build, problem_of_build

_UNIT = re.compile(r"\[([^\]]+)\]")
_TAKES = {"float": "number", "int": "whole number", "str": "text", "bool": "switch"}
_BOUNDS = {"Gt": "above", "Ge": "least", "Lt": "below", "Le": "most"}


@dataclass(frozen=True, kw_only=True)
class LiveCommand:
    """Describes the command that changes a parameter during a run; see `actr3d.configuration.Live`."""

    word: str
    before: tuple[str, ...] = ()
    body: str | None = None


@dataclass(frozen=True, kw_only=True)
class Parameter:
    """Describes one parameter of a model, as far as its text shows."""

    name: str
    takes: str
    """`number`, `whole number`, `text`, `switch`, `choice`, or the text of any other declared type."""
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
    help: str = ""
    line: int = 0
    live: LiveCommand | None = None
    """How the parameter is changed during a run; None if a change needs a new run."""

    def check(self, value: Any) -> None:
        """Checks a value against the parameter's type and bounds.

        Raises:
            ConfigurationError: If the value is not allowed.
        """
        if value is None and self.optional:
            return
        if self.takes in ("number", "whole number"):
            if isinstance(value, bool) or not isinstance(value, (int, float)) or not math.isfinite(value):
                raise ConfigurationError(f"{self.name}: must be a {self.takes} (got {value!r})")
            bounds = ((self.above, value > (self.above or 0), ">"), (self.least, value >= (self.least or 0), ">="))
            bounds += ((self.below, value < (self.below or 0), "<"), (self.most, value <= (self.most or 0), "<="))
            for limit, holds, sign in bounds:
                if limit is not None and not holds:
                    raise ConfigurationError(f"{self.name}: must be {sign} {limit} (got {value!r})")
        elif self.choices is not None and value not in self.choices:
            raise ConfigurationError(f"{self.name}: must be one of {', '.join(map(repr, self.choices))} (got {value!r})")


@dataclass(frozen=True, kw_only=True)
class Problem:
    """Describes an error in a text, or a possible one."""

    level: str
    """`error` or `warning`."""
    message: str
    line: int | None = None


@dataclass(frozen=True, kw_only=True)
class Listing:
    """Describes a model file, as far as this is possible without executing it."""

    title: str = ""
    """The first line of its docstring."""
    text: str = ""
    """Its docstring."""
    kind: str = "program"
    """`simulation` if the file defines `build`, otherwise `program`."""
    parameters: tuple[Parameter, ...] = ()
    simulates: bool = False
    """Whether it creates simulations itself: its text calls `Simulation`."""
    productions: tuple[str, ...] = ()
    """The names `Agent.production` that were found in the text."""
    problems: tuple[Problem, ...] = field(default=())

    def parameter(self, name: str) -> Parameter:
        """Returns a parameter by name.

        Raises:
            ConfigurationError: If there is no parameter of that name.
        """
        known = {parameter.name: parameter for parameter in self.parameters}
        if name not in known:
            raise ConfigurationError(f"no parameter '{name}'{did_you_mean(name, known)}; there are: {', '.join(known) or 'none'}")
        return known[name]


def listing_of(source: str, filename: str = "model.py") -> Listing:
    """Returns the description of a model's text; errors and warnings are in `problems`."""
    problems = tuple(problems_of(source, filename))
    tree = syntax_tree(source)
    text = sendable(ast.get_docstring(tree) or "")
    builds = has_build(source)
    return Listing(
        title=text.split("\n", 1)[0],
        text=text,
        kind="simulation" if builds else "program",
        parameters=tuple(_of_build(tree) if builds else _of_first_lines(source)),
        simulates=any(isinstance(node, ast.Call) and _last_name(node.func) == "Simulation" for node in ast.walk(tree)),
        productions=tuple(_productions(tree)),
        problems=problems,
    )


def problems_of(source: str, filename: str = "model.py") -> Iterator[Problem]:
    """Yields the errors and warnings of compiling a text; it is not executed."""
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            compile_source(source, filename)
        except ModelFileError as error:
            named = re.match(rf"{re.escape(filename)}:(\d+): (.*)", str(error), re.DOTALL)
            yield Problem(level="error", message=sendable(named[2] if named else str(error)), line=int(named[1]) if named else None)
    found = problem_of_build(source)
    if found is not None:
        yield Problem(level="error", message=sendable(found[1]), line=found[0])
    for warning in caught:
        yield Problem(level="warning", message=sendable(str(warning.message)), line=warning.lineno)


# -- parameters


def _of_build(tree: ast.Module) -> Iterator[Parameter]:
    """Yields the fields of the parameter class of `build`, if it is defined in the same file."""
    build = build_of(tree)
    argument = build.args.args[0] if build is not None and build.args.args else None
    if argument is None or argument.annotation is None:
        return
    classes = {node.name: node for node in tree.body if isinstance(node, ast.ClassDef)}
    kind = classes.get(ast.unparse(argument.annotation).strip("'\""))
    constants = dict(_constants(tree))
    for node, below in zip(kind.body, [*kind.body[1:], ast.Pass()], strict=True) if kind is not None else ():
        if isinstance(node, ast.AnnAssign) and isinstance(node.target, ast.Name):
            words = below.value.value if isinstance(below, ast.Expr) and isinstance(below.value, ast.Constant) else ""
            text = " ".join(sendable(inspect.cleandoc(words)).split()) if isinstance(words, str) else ""
            unit = _UNIT.search(text)
            declared = _declared(Parameter(name=node.target.id, takes=""), node.annotation, constants)
            default = _default(node.value, constants)
            yield replace(declared, **default, help=text, unit=unit and unit[1], line=node.lineno)


def _declared(parameter: Parameter, annotation: ast.expr, constants: Mapping[str, Any]) -> Parameter:
    """Returns a parameter completed with its declared type."""
    if isinstance(annotation, ast.Constant) and isinstance(annotation.value, str):
        try:
            return _declared(parameter, parse(annotation.value, mode="eval").body, constants)
        except (SyntaxError, ValueError):  # for example while it is being typed
            return replace(parameter, takes=sendable(annotation.value))
    if isinstance(annotation, ast.BinOp) and isinstance(annotation.op, ast.BitOr):
        sides = [side for side in (annotation.left, annotation.right) if ast.unparse(side) != "None"]
        inner = _declared(parameter, (sides or [annotation.left])[0], constants)
        return (
            replace(inner, optional=inner.optional or len(sides) == 1) if len(sides) == 1 else replace(inner, takes=ast.unparse(annotation))
        )
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
        return replace(parameter, live=LiveCommand(word=values[0], before=tuple(values[1:]), body=named.get("body")))
    return parameter


def _of_first_lines(source: str) -> Iterator[Parameter]:
    """Yields parameters from the first lines of a program (`name = value`) whose values are literals."""
    try:
        found = first_lines(source)
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return
    for name, node in found.items():
        default = _default(node.value, {})
        if default["known"]:
            value = default["default"]
            kind = type(value).__name__
            takes = {"bool": "switch", "int": "number", "float": "number", "str": "text"}.get(kind, kind)
            yield Parameter(name=name, takes=takes, **default, optional=value is None, line=node.lineno)


def _constants(tree: ast.Module) -> Iterator[tuple[str, Any]]:
    for node in tree.body:
        if isinstance(node, ast.Assign) and len(node.targets) == 1 and isinstance(node.targets[0], ast.Name):
            try:
                yield node.targets[0].id, ast.literal_eval(node.value)
            except (ValueError, TypeError, SyntaxError, MemoryError, RecursionError):
                continue


def _default(node: ast.expr | None, constants: Mapping[str, Any]) -> dict[str, Any]:
    if node is None:
        return {"default": None, "known": False}
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
    except (ValueError, TypeError, SyntaxError, MemoryError, RecursionError):
        raise ValueError(ast.unparse(node)) from None
    if not _can_be_told(value):
        raise ValueError(ast.unparse(node))
    return value


def _can_be_told(value: Any) -> bool:
    """Returns whether JSON can represent a value."""
    if isinstance(value, float):
        return math.isfinite(value)
    if isinstance(value, str):
        return value == sendable(value)
    if isinstance(value, (list, tuple)):
        return all(map(_can_be_told, cast("Sequence[Any]", value)))
    if isinstance(value, dict):
        entries = cast("dict[Any, Any]", value)
        return all(isinstance(key, str) and _can_be_told(key) and _can_be_told(each) for key, each in entries.items())
    return value is None or isinstance(value, int)


def sendable(text: str) -> str:
    """Returns a text that can be sent: unpaired surrogate characters, which no encoding has, become escapes."""
    return text.encode("utf-8", "backslashreplace").decode("utf-8")


def _last_name(node: ast.expr) -> str:
    return node.attr if isinstance(node, ast.Attribute) else node.id if isinstance(node, ast.Name) else ""


def _productions(tree: ast.Module) -> Iterator[str]:
    """Yields the names of methods whose parameters all have defaults, as those of productions do."""
    for kind in (node for node in tree.body if isinstance(node, ast.ClassDef)):
        for node in kind.body:
            if isinstance(node, ast.FunctionDef) and node.args.args and len(node.args.defaults) == len(node.args.args):
                yield f"{kind.name}.{node.name}"
