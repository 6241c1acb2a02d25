"""Finds names that nothing defines, where a text is executed first: at the top level and in the bodies of classes.

Bodies of functions are left out: a production sees buffers, modules and bound variables by name; it is checked when its agent begins.
"""

from __future__ import annotations

import ast
import builtins
from collections.abc import Iterator
from importlib import import_module

from actr3d.actr.kernel.source_code import names_defined_in
from actr3d.errors import did_you_mean

LIBRARY = ("actr3d.actr", "actr3d.world", "actr3d.motor", "actr3d.vision", "actr3d.simulation", "actr3d.sgoms", "actr3d.experiment")
"""The modules whose names are known if a text imports all of them with `*`."""


def undefined_names(tree: ast.Module) -> Iterator[tuple[int, str]]:
    """Yields the line and a message for each name that is imported from the library without being there, or that nothing defines."""
    yield from _not_in_library(tree.body)
    defined = names_defined_in(tree)
    if defined is None:
        return
    known = {*dir(builtins), "__file__", "__name__", "__doc__", *defined}
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and node.names[0].name == "*":
            if node.module not in LIBRARY:
                return
            module = import_module(node.module)
            known.update(getattr(module, "__all__", dir(module)))
    for name in sorted(_read_first(tree.body), key=lambda name: (name.lineno, name.col_offset)):
        if name.id not in known:
            yield name.lineno, f"nothing defines '{name.id}'{did_you_mean(name.id, known)}"


def _not_in_library(body: list[ast.stmt]) -> Iterator[tuple[int, str]]:
    """Yields the line and a message for each name that some statements import from a module of the library that does not have it."""
    for node in body:
        if isinstance(node, ast.ImportFrom) and node.module in LIBRARY and not node.level:
            module = import_module(node.module)
            public: list[str] = getattr(module, "__all__", dir(module))
            for one in node.names:
                if one.name != "*" and not hasattr(module, one.name):
                    hint = did_you_mean(one.name, public) or f"; it has: {', '.join(public)}"
                    yield node.lineno, f"{node.module} has no '{one.name}'{hint}"


def _read_first(body: list[ast.stmt]) -> Iterator[ast.Name]:
    """Yields the names that are read when some statements are executed, without the bodies of functions."""
    waiting: list[ast.AST] = list(body)
    while waiting:
        node = waiting.pop()
        if isinstance(node, ast.Name) and isinstance(node.ctx, ast.Load):
            yield node
        if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)):
            arguments = node.args
            waiting += [*node.decorator_list, *arguments.defaults, *(one for one in arguments.kw_defaults if one is not None)]
        elif isinstance(node, ast.AnnAssign):
            waiting += [] if node.value is None else [node.value]
        elif not isinstance(node, ast.Lambda):
            waiting += ast.iter_child_nodes(node)
