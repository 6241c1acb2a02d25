"""Returns the texts that stand below the fields of dataclasses, and what docstrings say of parameters."""

from __future__ import annotations

import ast
import inspect
import re
from collections.abc import Iterator
from functools import lru_cache
from pathlib import Path
from typing import Any


def parameter_text(docstring: str, name: str) -> str:
    """Returns what a docstring says of a parameter in its section `Args`; an empty text if it says nothing."""
    found = re.search(rf"^( *){re.escape(name.lstrip('*'))}:[ ](.*(?:\n\1[ ]+.*)*)", docstring, re.MULTILINE)
    return " ".join(found[2].split()) if found else ""


def text_at(path: Path, line: int) -> str:
    """Returns the text below the assignment at a line of a Python file; an empty text if there is none."""
    return next((text for _, number, text in _texts(path) if number == line), "")


def texts_of(kind: type) -> dict[str, str]:
    """Returns the texts of a class's fields by name, those of the classes that it inherits from included."""
    found: dict[str, str] = {}
    for klass in reversed(kind.__mro__):
        if klass.__module__ != "builtins":
            path = inspect.getsourcefile(klass)
            lines, first = inspect.getsourcelines(klass)
            inside = range(first, first + len(lines))
            found |= {name: text for name, line, text in _texts(Path(path or "")) if line in inside}
    return found


def _texts(path: Path) -> tuple[tuple[str, int, str], ...]:
    """Returns the name, the line and the text of each assignment in a file that has a text below it."""
    try:
        return _texts_of(path.read_text(encoding="utf-8"))
    except (OSError, ValueError):
        return ()


@lru_cache(maxsize=64)
def _texts_of(source: str) -> tuple[tuple[str, int, str], ...]:
    """As `_texts`, of the present text of a file."""
    try:
        return tuple(_texts_in(ast.parse(source)))
    except (ValueError, SyntaxError, RecursionError, MemoryError):
        return ()


def _texts_in(tree: ast.Module) -> Iterator[tuple[str, int, str]]:
    for node in ast.walk(tree):
        if not isinstance(node, (ast.Module, ast.ClassDef)):
            continue
        for one, below in zip(node.body, node.body[1:], strict=False):
            target: Any = one.target if isinstance(one, ast.AnnAssign) else one.targets[0] if isinstance(one, ast.Assign) else None
            if isinstance(target, ast.Name) and isinstance(below, ast.Expr) and isinstance(below.value, ast.Constant):
                yield target.id, one.lineno, inspect.cleandoc(str(below.value.value))
