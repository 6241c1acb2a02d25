"""Finds the source of a modeller's functions, so that their bodies can be read and run as productions."""

from __future__ import annotations

import ast
import dis
import linecache
import warnings
from collections.abc import Callable
from functools import lru_cache
from typing import Any


@lru_cache(maxsize=64)
def _functions(text: str) -> dict[tuple[str, int], ast.FunctionDef]:
    """Returns every function of a file by its name and first line (that of its first decorator)."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # whatever there is to say was said when the file itself was compiled
        tree = ast.parse(text)
    found: dict[tuple[str, int], ast.FunctionDef] = {}
    for node in ast.walk(tree):
        if isinstance(node, ast.FunctionDef):
            line = min([node.lineno, *(d.lineno for d in node.decorator_list)])
            found[node.name, line] = node
    return found


def function_node(func: Callable[..., Any]) -> ast.FunctionDef | None:
    """Returns the syntax tree of a function's definition, or None where its source is not to be had."""
    code = func.__code__
    lines = linecache.getlines(code.co_filename, func.__globals__)
    try:
        return _functions("".join(lines)).get((code.co_name, code.co_firstlineno))
    except (SyntaxError, ValueError):  # the file has changed since, and is no Python now
        return None


def has_source(func: Callable[..., Any]) -> bool:
    """Tells whether the file of a function can be read at all."""
    return bool(linecache.getlines(func.__code__.co_filename, func.__globals__))


def place(func: Callable[..., Any]) -> str:
    """Returns `file:line` of a function's definition."""
    return f"{func.__code__.co_filename}:{func.__code__.co_firstlineno}"


def assigned_globals(func: Callable[..., Any]) -> set[str]:
    """Returns the names that a function declares global and assigns."""
    code = func.__code__
    if not _STORE_GLOBAL & set(code.co_code[::2]):
        return set()
    return {step.argval for step in dis.get_instructions(code) if step.opname == "STORE_GLOBAL"}


_STORE_GLOBAL = {dis.opmap["STORE_GLOBAL"]}
