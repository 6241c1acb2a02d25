"""The modules beside a model that it imports: what they held when a run began, and whether they hold it still."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

from actr3d.actr.reading import read_source
from actr3d.errors import Actr3dError

MOST = 100
"""No more modules are looked at."""


def helper_texts(source: str, folder: Path) -> dict[Path, str]:
    """Returns the texts of the modules in a model's folder that it imports, and of those that these import.

    Args:
        source: The model's text.
        folder: Where it is.
    """
    found: dict[Path, str] = {}
    waiting = [source]
    while waiting and len(found) < MOST:
        for path in _imported(waiting.pop(), folder):
            if path in found or not path.is_file():
                continue
            try:
                found[path] = read_source(path)
            except Actr3dError:
                continue
            waiting.append(found[path])
    return found


def _imported(source: str, folder: Path) -> Iterator[Path]:
    """Yields the files that a text would import from a folder, if they were there."""
    try:
        nodes = list(ast.walk(ast.parse(source)))
    except (SyntaxError, ValueError, RecursionError, MemoryError):
        return
    for node in nodes:
        names: list[str] = []
        if isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
        elif isinstance(node, ast.ImportFrom) and node.module:
            names = [node.module, *(f"{node.module}.{alias.name}" for alias in node.names)]
        for name in names:
            parts = name.split(".")
            for length in range(1, len(parts) + 1):
                stem = folder.joinpath(*parts[:length])
                yield stem.with_suffix(".py")
                yield stem / "__init__.py"
