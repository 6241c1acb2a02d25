"""Checks the function `build` of a model file from its source text, without running it."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from functools import lru_cache

from actr3d.actr.kernel.source_code import syntax_tree
from actr3d.errors import WITHOUT_BODY, ModelFileError

RIGHT = "`def build(parameters: Parameters) -> Simulation`, where Parameters is a frozen dataclass, or `def build() -> Simulation`"


def build_of(tree: ast.Module) -> ast.FunctionDef | None:
    """Returns the last function `build` of a module; None if there is none."""
    return next((node for node in reversed(_builds(tree)) if isinstance(node, ast.FunctionDef)), None)


def line_of_build(source: str) -> int:
    """Returns the line of the last statement of a source text that binds the name `build`; 1 if there is none."""
    return max((node.lineno for node in _builds(syntax_tree(source))), default=1)


def has_build(source: str) -> bool:
    """Returns whether a model's source has a function `build` that is declared to return a `Simulation`."""
    return any(isinstance(node, ast.FunctionDef) and _returns_simulation(node) for node in _builds(syntax_tree(source)))


def check_build(source: str, filename: str) -> None:
    """Checks what a model's source defines as `build`.

    Raises:
        ModelFileError: If it is meant to build a simulation, and cannot; the message names the line, what was found, and what is right.
    """
    found = problem_of_build(source)
    if found is not None:
        raise ModelFileError(f"{filename}:{found[0]}: {found[1]}")


@lru_cache(maxsize=64)  # an experiment loads the same text for each trial
def problem_of_build(source: str) -> tuple[int, str] | None:
    """Returns the line of what a model's source defines as `build`, and the problem with it; None if there is no problem.

    A program may use a function of that name for its own purposes: one that it calls itself is not checked.
    """
    tree = syntax_tree(source)
    builds = _builds(tree)
    if not builds:
        return None
    node = builds[-1]
    said = isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)) and _returns_simulation(node)
    if not said and any(isinstance(one, ast.Name) and one.id == "build" and isinstance(one.ctx, ast.Load) for one in ast.walk(tree)):
        return None
    wrong = _wrong(node, tree)
    return (
        None
        if wrong is None
        else (node.lineno, f"{wrong}; write {RIGHT}" + ("" if said else f"; rename it if it is not to build the model; {WITHOUT_BODY}"))
    )


def _builds(tree: ast.Module) -> list[ast.stmt]:
    """Returns the statements of a source text that bind the name `build` in its module, also below `if`, `try`, `with` and loops."""
    return [node for node in _statements(tree) if "build" in _names(node)]


def _statements(node: ast.AST) -> Iterator[ast.stmt]:
    """Yields all statements of a module that are not inside functions and classes."""
    for child in ast.iter_child_nodes(node):
        if isinstance(child, ast.stmt):
            yield child
        if not isinstance(child, (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef, ast.expr)):
            yield from _statements(child)


def _names(node: ast.stmt) -> list[str]:
    if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef)):
        return [node.name]
    if isinstance(node, (ast.Import, ast.ImportFrom)):
        return [alias.asname or alias.name for alias in node.names]
    targets = node.targets if isinstance(node, ast.Assign) else [node.target] if isinstance(node, (ast.AnnAssign, ast.For)) else []
    return [one.id for target in targets for one in ast.walk(target) if isinstance(one, ast.Name) and isinstance(one.ctx, ast.Store)]


def _wrong(node: ast.stmt, tree: ast.Module) -> str | None:
    """Returns the problem with a statement that binds `build`; None if there is none."""
    if isinstance(node, ast.AsyncFunctionDef):
        return "build is an async function"
    if not isinstance(node, ast.FunctionDef):
        kind = "a class" if isinstance(node, ast.ClassDef) else "imported" if isinstance(node, (ast.Import, ast.ImportFrom)) else "a value"
        return f"build is {kind}, not a function that is defined in this file"
    head = f"build({ast.unparse(node.args)})"
    if not _returns_simulation(node):
        got = f"`def {head}`, without a return type" if node.returns is None else f"`def {head} -> {ast.unparse(node.returns)}`"
        return f"build must be declared to return a Simulation (got {got})"
    return _wrong_arguments(head, node.args, tree)


def _wrong_arguments(head: str, args: ast.arguments, tree: ast.Module) -> str | None:
    named = [*args.posonlyargs, *args.args]
    if args.vararg or args.kwarg or args.kwonlyargs:
        return f"{head} takes arguments by name only, or any number of them"
    if len(named) > 1:
        return f"{head} takes {len(named)} arguments"
    if named and named[0].annotation is None:
        return f"{head} does not say which dataclass its parameters are of"
    kind = ast.unparse(named[0].annotation).strip("'\"") if named and named[0].annotation is not None else ""
    defined = {one.name: one for one in tree.body if isinstance(one, (ast.ClassDef, ast.FunctionDef))}.get(kind)
    if kind in ("int", "float", "str", "bool", "dict", "list", "tuple", "object", "Any") or (
        defined is not None and not (isinstance(defined, ast.ClassDef) and (defined.decorator_list or defined.bases))
    ):
        return f"{head} takes {kind}, which is not a dataclass"
    return None


def _returns_simulation(node: ast.FunctionDef | ast.AsyncFunctionDef) -> bool:
    return node.returns is not None and ast.unparse(node.returns).strip("'\"").rpartition(".")[2] == "Simulation"
