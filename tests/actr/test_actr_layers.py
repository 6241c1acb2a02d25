"""The order of the folders inside the cognitive architecture."""

from __future__ import annotations

import ast
from collections.abc import Collection, Mapping
from functools import cache
from pathlib import Path

import actr3d.actr
from actr3d.actr.kernel import model
from actr3d.actr.procedural import production_system
from tests.helpers.syntax_trees import imports_of

ROOT = Path(actr3d.actr.__file__).parent
LAYERS: dict[str, set[str]] = {
    "reasons": set(),
    "chunks": set(),
    "kernel": {"chunks"},
    "procedural": {"reasons", "chunks", "kernel"},
    "declarative": {"chunks", "kernel"},
    "modules": {"chunks", "kernel", "declarative"},
    "explain": {"reasons", "chunks", "kernel", "procedural", "declarative", "modules"},
    "changes": {"chunks", "kernel", "procedural", "declarative", "explain"},
    "lint": {"chunks", "kernel", "procedural", "declarative", "modules"},
    "compat": {"kernel"},
    "loading": {"kernel", "compat"},
}
"""Every folder, and the folders that it may import; `actr3d/actr/__init__.py` may import all."""
FILES = [path for path in sorted(ROOT.rglob("*.py")) if path.parent != ROOT or path.stem != "__init__"]


def folder_of(name: str) -> str:
    """Returns the folder, or the file at the top, of a module's dotted name below `actr3d.actr`."""
    return name.split(".")[0]


def test_a_folder_imports_only_lower_layers() -> None:
    assert len(FILES) > 50
    prefix, wrong = "actr3d.actr.", dict[str, set[str]]()
    for path in FILES:
        own = path.relative_to(ROOT).with_suffix("").parts[0]
        modules = {node.module or "" for node in imports_of(path) if isinstance(node, ast.ImportFrom)}
        imported = {folder_of(module.removeprefix(prefix)) for module in modules if module.startswith(prefix)}
        if above := (imported - LAYERS[own] - {own}) | (modules & {"actr3d.actr"}):
            wrong[str(path.relative_to(ROOT))] = above
    assert wrong == {}


def test_the_package_connects_the_checks_and_the_explanations_to_the_core() -> None:
    assert [check.__module__ for check in model.BEFORE_FIRST_RUN] == ["actr3d.actr.lint.checks"]
    assert [check.__module__ for check in production_system.BEFORE_FIRST_CYCLE] == ["actr3d.actr.lint.checks"]
    assert [explain.__module__ for explain in production_system.EXPLAINERS] == ["actr3d.actr.explain.explain"]


# -- the longest chain of imports between single modules


def module_name(path: Path) -> str:
    """Returns the dotted name of a file of the architecture."""
    return ".".join(["actr3d", "actr", *path.relative_to(ROOT).with_suffix("").parts]).removesuffix(".__init__")


def longest_chain(texts: Mapping[str, str], packages: Collection[str]) -> list[str]:
    """Returns the longest chain of modules each of which imports the next, at its top, in a function or for type checkers only.

    Args:
        texts: The source of each module by its dotted name.
        packages: Those that are the `__init__` of a package; to import one is to import the modules that it imports.
    """

    def known(name: str) -> str:
        while name and name not in texts:
            name = name.rpartition(".")[0]
        return name

    @cache
    def chain(module: str) -> tuple[str, ...]:
        below: tuple[str, ...] = ()
        for node in ast.walk(ast.parse(texts[module])):
            names: list[str] = []
            if isinstance(node, ast.Import):
                names = [alias.name for alias in node.names]
            elif isinstance(node, ast.ImportFrom):
                names = [f"{node.module}.{alias.name}" for alias in node.names]
            for name in map(known, names):
                if name and name != module:
                    below = max(below, chain(name), key=len)
        return below if module in packages else (module, *below)

    return list(max(map(chain, texts), key=len))


def test_the_longest_chain_of_modules_is_at_most_8() -> None:
    paths = {module_name(path): path for path in sorted(ROOT.rglob("*.py"))}
    texts = {name: path.read_text(encoding="utf-8") for name, path in paths.items()}
    found = longest_chain(texts, {name for name, path in paths.items() if path.stem == "__init__"})
    assert len(found) <= 8, "each of these imports the next; merge or move what belongs together:\n" + "\n".join(found)
    assert len(found) > 4


def test_a_chain_contains_imports_in_functions_and_through_packages() -> None:
    texts = {
        "a.top": "def f():\n    from a.box import thing",
        "a.box": "from a.box.inner import thing",
        "a.box.inner": "if TYPE_CHECKING:\n    import a.bottom",
        "a.bottom": "import sys",
    }
    assert longest_chain(texts, {"a.box"}) == ["a.top", "a.box.inner", "a.bottom"]
