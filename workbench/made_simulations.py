"""Finds out whether a program makes simulations, from its text and those of the modules of its folder that it imports; none is executed."""

from __future__ import annotations

import ast
from collections.abc import Mapping, Sequence
from pathlib import Path

from actr3d.actr.kernel.source_code import last_name, syntax_tree
from actr3d.actr.loading.program import LIBRARY
from actr3d.actr.loading.source_text import read_source
from actr3d.errors import ModelFileError

CLASS = "Simulation"
LOADING = ""
"""Stands among the names of a module if loading it makes a simulation."""


def makes_simulations(source: str, folder: Path, helpers: Mapping[str, Sequence[str]]) -> bool:
    """Returns whether a program calls `Simulation`, or something of a module of its folder that calls it, directly or not.

    Args:
        source: Its text.
        folder: Its folder.
        helpers: The file and text of each module that is known from an earlier run, by name.
    """
    tree = syntax_tree(source)
    makers = _Modules(folder, helpers).imported(tree, ())
    return LOADING in makers or _calls(tree, makers)


class _Modules:
    """The modules of a program's folder, with the names in them whose call makes a simulation."""

    def __init__(self, folder: Path, helpers: Mapping[str, Sequence[str]]) -> None:
        self._folder = folder
        self._helpers = helpers
        self._known: dict[tuple[str, ...], set[str]] = {}

    def imported(self, tree: ast.Module, package: tuple[str, ...]) -> set[str]:
        """Returns what a text imports that makes a simulation, with `Simulation` itself."""
        found = {CLASS}
        for node in ast.walk(tree):
            if isinstance(node, ast.Import):
                for one in node.names:
                    found |= self._makers(tuple(one.name.split(".")))
            elif isinstance(node, ast.ImportFrom):
                base = package[: len(package) + 1 - node.level] if node.level else ()
                module = (*base, *node.module.split(".")) if node.module else base
                makers = self._makers(module) | {CLASS}
                found |= makers & {LOADING}
                for one in node.names:
                    found |= makers if one.name == "*" else self._makers((*module, one.name))
                    if one.name in makers:
                        found.add(one.asname or one.name)
        return found

    def _makers(self, module: tuple[str, ...]) -> set[str]:
        """Returns the names in a module whose call makes a simulation; none if it is not a module of the folder."""
        if module not in self._known:
            self._known[module] = set()  # for modules that import each other
            self._known[module] = self._found_in(module)
        return self._known[module]

    def _found_in(self, module: tuple[str, ...]) -> set[str]:
        text, package = self._read(module)
        tree = syntax_tree(text)
        makers = self.imported(tree, package)
        defined = [node for node in tree.body if isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef, ast.ClassDef))]
        while new := {node.name for node in defined if node.name not in makers and _calls(node, makers)}:
            makers |= new
        done = [node for node in tree.body if node not in defined and not _is_for_main(node)]
        return makers | {LOADING} if any(_calls(node, makers) for node in done) else makers

    def _read(self, module: tuple[str, ...]) -> tuple[str, tuple[str, ...]]:
        """Returns the text of a module, and the package that it is in, or is; an empty text if it is not in the folder."""
        if not module or module[0] == LIBRARY:
            return "", ()
        if ".".join(module) in self._helpers:
            file, text = self._helpers[".".join(module)]
            return text, module if Path(file).name == "__init__.py" else module[:-1]
        path = self._folder.joinpath(*module)
        for file, package in ((path / "__init__.py", module), (path.with_suffix(".py"), module[:-1])):
            if file.is_file():
                try:
                    return read_source(file), package
                except (ModelFileError, OSError):
                    break
        return "", ()


def _calls(tree: ast.AST, names: set[str]) -> bool:
    """Returns whether a text calls something by one of these names."""
    return any(isinstance(node, ast.Call) and last_name(node.func) in names - {LOADING} for node in ast.walk(tree))


def _is_for_main(node: ast.stmt) -> bool:
    """Returns whether a statement is `if __name__ == "__main__":`."""
    return isinstance(node, ast.If) and any(isinstance(one, ast.Name) and one.id == "__name__" for one in ast.walk(node.test))
