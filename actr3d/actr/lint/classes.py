"""Checks the modeller's classes: names of methods, attributes that look like misspelt parameters, and names given to modules."""

from __future__ import annotations

import ast
import inspect
import linecache
import sys
import warnings
from collections.abc import Callable, Iterator, Mapping
from functools import lru_cache
from typing import Any

from actr3d.actr.kernel.class_members import is_modellers
from actr3d.actr.kernel.model import Model
from actr3d.actr.kernel.parameters import WithParameters, misspelling_hint, settable_of
from actr3d.actr.kernel.source_code import SOURCE, source_of, syntax_tree
from actr3d.actr.procedural.rebinding import stored_names
from actr3d.actr.procedural.utility import utility_modules
from actr3d.errors import ModelWarning, did_you_mean
from actr3d.warnings import warn_at


def check_names_of_methods(klass: type, func: Callable[..., Any]) -> None:
    """Warns about methods that are replaced by a later one of the same name in the same class."""
    node = _class_node(klass, func)
    if node is None:
        return
    for before, after in _replaced(node.body, {}):
        warn_at(
            f"class {klass.__name__} has two methods '{after.name}', in lines {before.lineno} and {after.lineno}; only the second counts",
            func,
            after.lineno,
        )


def _replaced(body: list[ast.stmt], seen: dict[str, ast.FunctionDef]) -> Iterator[tuple[ast.FunctionDef, ast.FunctionDef]]:
    """Yields pairs of an earlier method and one that certainly replaces it; `seen` are the methods before.

    A branch that may not be taken replaces nothing for certain, but methods in it may be replaced.
    """
    for part in body:
        if isinstance(part, ast.FunctionDef):
            if part.name in seen and not part.decorator_list:
                yield seen[part.name], part
            seen[part.name] = part
        elif isinstance(part, ast.With) or (isinstance(part, ast.If) and isinstance(part.test, ast.Constant) and part.test.value):
            yield from _replaced(part.body, seen)
        elif not isinstance(part, ast.ClassDef):
            branches = [getattr(part, field, []) for field in ("body", "orelse", "finalbody")]
            branches += [handler.body for handler in getattr(part, "handlers", [])]
            inside: dict[str, ast.FunctionDef] = {}
            for branch in branches:
                known: dict[str, ast.FunctionDef] = {}
                yield from _replaced(branch, known)
                inside.update(known)
            seen.update(inside)


def _class_node(klass: type, func: Callable[..., Any]) -> ast.ClassDef | None:
    """Returns the definition of a class that contains a function of it."""
    line = func.__code__.co_firstlineno
    found: ast.ClassDef | None = None
    for node in _classes(source_of(func), klass):
        if node.lineno <= line <= (node.end_lineno or 0):
            found = node
    return found


def _classes(text: str, klass: type) -> list[ast.ClassDef]:
    """Returns the definitions in a file that have a class's name."""
    return [node for node in _definitions(text) if node.name == klass.__name__]


@lru_cache(maxsize=64)
def _definitions(text: str) -> tuple[ast.ClassDef, ...]:
    """Returns the definitions of all classes in a file."""
    return tuple(node for node in ast.walk(syntax_tree(text)) if isinstance(node, ast.ClassDef))


def check_parameters(system: WithParameters) -> None:
    """Warns about attributes of an agent's class whose names are similar to those of parameters of agents."""
    for klass in type(system).__mro__:
        if not is_modellers(klass):
            continue
        for name, value in vars(klass).items():
            hint = "" if inspect.isfunction(value) or isinstance(value, Model) else misspelling_hint(name, settable_of(system))
            if hint:
                filename, line = _place_of_attribute(klass, name)
                message = f"class {klass.__name__} has an attribute '{name}', which is not a parameter{hint}"
                warnings.warn_explicit(message, ModelWarning, filename, line, registry={})


def check_names_in_modules(system: Model, context: Mapping[str, Any]) -> None:
    """Warns about names in the parameters of utility modules that are no attributes of the agent or its ancestors.

    An example is `PMCompile(keep='goall')`.
    """
    for module in utility_modules(system):
        for parameter, name in module.names_in_productions:
            if name not in context:
                klass = next((klass for klass in type(system).__mro__ if module.name in vars(klass)), type(system))
                filename, line = _place_of_attribute(klass, module.name)
                what = f"{type(module).__name__}.{parameter}: class {type(system).__name__} has no '{name}'"
                warnings.warn_explicit(f"{what}{did_you_mean(name, context)}", ModelWarning, filename, line, registry={})


def _place_of_attribute(klass: type, attribute: str) -> tuple[str, int]:
    """Returns the file and the line of an attribute in a class, or otherwise those of the class."""
    module = sys.modules.get(klass.__module__)
    filename = getattr(module, "__file__", None) or "<model>"
    text = getattr(module, SOURCE, None) or "".join(linecache.getlines(filename))
    line = 1
    for node in _classes(text, klass):
        lines = [part.lineno for part in node.body if isinstance(part, (ast.Assign, ast.AnnAssign)) and attribute in stored_names([part])]
        line = lines[-1] if lines else node.lineno
    return filename, line
