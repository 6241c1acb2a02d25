"""The order of the folders inside the cognitive architecture."""

from __future__ import annotations

import ast
from pathlib import Path

import pytest

import actr3d.actr
from actr3d.actr.kernel import model
from actr3d.actr.procedural import production_system

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


@pytest.mark.parametrize("path", FILES, ids=lambda path: str(path.relative_to(ROOT)))
def test_a_folder_imports_only_what_stands_below_it(path: Path) -> None:
    own = path.relative_to(ROOT).with_suffix("").parts[0]
    prefix = "actr3d.actr."
    nodes = [node for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))) if isinstance(node, ast.ImportFrom)]
    imported = {folder_of((node.module or "").removeprefix(prefix)) for node in nodes if (node.module or "").startswith(prefix)}
    assert imported - LAYERS[own] <= {own}
    assert [node.module for node in nodes if node.module == "actr3d.actr"] == []


def test_the_package_connects_the_checks_and_the_explanations_to_the_core() -> None:
    assert [check.__module__ for check in model.BEFORE_FIRST_RUN] == ["actr3d.actr.lint.checks"]
    assert [check.__module__ for check in production_system.BEFORE_FIRST_CYCLE] == ["actr3d.actr.lint.checks"]
    assert [explain.__module__ for explain in production_system.EXPLAINERS] == ["actr3d.actr.explain.explain"]
