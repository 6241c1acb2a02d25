"""The library's own order: which part may import which, and that everything public says what it does."""

from __future__ import annotations

import ast
import importlib
import inspect
from collections.abc import Iterable, Iterator
from graphlib import TopologicalSorter
from pathlib import Path
from types import ModuleType
from typing import Any

import pytest

import actr3d
from tests.helpers.syntax_trees import imports_in, imports_of, tree_of

ROOT = Path(actr3d.__file__).parent.parent
FILES = sorted((ROOT / "actr3d").rglob("*.py"))


BASE = {"errors", "clock", "configuration", "warnings", "values", "registry", "forks", "weak_cache", "trace_kinds", "trace", "change"}
BODILY = {"actr", "world", "camera"}
SENSES = {"vision", "motor", "sgoms"}
RUNNING = {"simulation", "recording"}
PARTS: dict[str, set[str]] = {
    "errors": set(),
    "clock": {"errors"},
    "weak_cache": set(),
    "configuration": {"errors", "weak_cache"},
    "parameter_schema": {"errors", "configuration", "values", "actr"},
    "warnings": {"errors"},
    "notebook": {"errors"},
    "values": set(),
    "registry": set(),
    "forks": set(),
    "replacing": set(),
    "processors": set(),
    "trace_kinds": {"registry"},
    "trace": {"errors", "clock", "values", "trace_kinds"},
    "change": {"errors", "configuration", "registry"},
    "actr": BASE,
    "jit": set(),
    "world": BASE | {"jit"},
    "camera": BASE | {"jit", "world"},
    "vision": BASE | {"jit"} | BODILY,
    "motor": BASE | {"jit"} | BODILY,
    "sgoms": BASE | {"actr"},
    "recording": BASE | BODILY | {"notebook", "replacing"},
    "simulation": BASE | BODILY | SENSES | {"recording", "output", "notebook"},
    "runner": BASE | BODILY | SENSES | RUNNING | {"output", "parameter_schema"},
    "benchmark": {"registry"},
    "experiment": BASE
    | {"jit", "replacing", "processors"}
    | BODILY
    | SENSES
    | RUNNING
    | {"parameter_schema", "output", "runner", "benchmark"},
    "bench": BASE | BODILY | SENSES | RUNNING | {"runner", "experiment", "benchmark"},
    "output": {"errors"},
    "cli": BASE | BODILY | SENSES | RUNNING | {"parameter_schema", "runner", "experiment", "bench", "benchmark", "output"},
    "__main__": {"cli"},
}
"""Every part of the library, and the parts that it may import."""
NOT_IN_THE_CORE = {"numpy", "numba", "scipy", "mujoco", "trimesh"}
NOT_IN_THE_LIBRARY = {"workbench", "fastapi", "starlette", "uvicorn", "websockets", "viser", "mjviser"}


def module_name(path: Path) -> str:
    """Returns the dotted name of a file of the library."""
    parts = path.relative_to(ROOT).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


def imported_by(node: ast.AST, package: str) -> Iterator[str]:
    """Yields the dotted names that a statement imports, relative ones made whole."""
    if isinstance(node, ast.Import):
        yield from (alias.name for alias in node.names)
    elif isinstance(node, ast.ImportFrom):
        start = package.split(".")[: len(package.split(".")) - node.level + 1] if node.level else []
        base = ".".join([*start, *([node.module] if node.module else [])])
        yield from (f"{base}.{alias.name}" for alias in node.names)


def wrong_imports(imports: Iterable[ast.stmt], module: str, package: str) -> list[str]:
    """Returns those of the imports that a file of the library must not have, at its top or anywhere in it."""
    part = module.split(".")[1] if "." in module else ""
    wrong: list[str] = []
    for node in imports:
        for name in imported_by(node, package):
            root, _, rest = name.partition(".")
            other = rest.partition(".")[0]
            outward = root in NOT_IN_THE_LIBRARY or (part in BASE | {"actr"} and root in NOT_IN_THE_CORE)
            upward = part != "" and root == "actr3d" and other in PARTS and other != part and other not in PARTS[part]
            if outward or upward:
                wrong.append(name)
    return wrong


def package_of(path: Path) -> str:
    return ".".join(path.relative_to(ROOT).parts[:-1])


def test_every_part_has_its_place() -> None:
    there = {path.relative_to(ROOT / "actr3d").parts[0].removesuffix(".py") for path in FILES} - {"__init__"}
    assert there <= PARTS.keys(), "a new part needs a place in PARTS: what may it import?"


def test_imports_point_one_way() -> None:
    assert len(FILES) > 100
    found = {module_name(path): wrong_imports(imports_of(path), module_name(path), package_of(path)) for path in FILES}
    assert {module: wrong for module, wrong in found.items() if wrong} == {}


@pytest.mark.parametrize(
    ("source", "module", "wrong"),
    [
        ("import numpy", "actr3d.actr.declarative.memory", ["numpy"]),
        ("import numpy", "actr3d.clock", ["numpy"]),
        ("import mujoco", "actr3d.world.world", []),
        ("def f():\n    from mujoco import MjModel", "actr3d.actr.declarative.memory", ["mujoco.MjModel"]),
        ("from actr3d import world", "actr3d.actr.declarative.memory", ["actr3d.world"]),
        ("from ..vision import module", "actr3d.world.scene", ["actr3d.vision.module"]),
        ("from . import mesh", "actr3d.world.scene", []),
        ("from actr3d.actr.kernel.model import Model", "actr3d.trace", ["actr3d.actr.kernel.model.Model"]),
        ("from actr3d.simulation import Simulation", "actr3d.motor.module", ["actr3d.simulation.Simulation"]),
        ("from actr3d.actr import ACTR\nfrom actr3d.trace import Trace", "actr3d.sgoms", []),
        ("import workbench.app", "actr3d.cli", ["workbench.app"]),
        ("from starlette.routing import Route", "actr3d.recording", ["starlette.routing.Route"]),
    ],
)
def test_imports_that_reach_up_or_out_are_found(source: str, module: str, wrong: list[str]) -> None:
    assert wrong_imports(imports_in(ast.parse(source)), module, module.rpartition(".")[0]) == wrong


def at_import(body: list[ast.stmt]) -> Iterator[ast.stmt]:
    """Yields the statements that run when a module is imported; not those for type checkers."""
    for node in body:
        if isinstance(node, ast.If) and ast.unparse(node.test) == "TYPE_CHECKING":
            yield from at_import(node.orelse)
        elif not isinstance(node, (ast.FunctionDef, ast.AsyncFunctionDef)):
            yield node
            for part in ("body", "orelse", "finalbody"):
                yield from at_import(getattr(node, part, []))


def test_no_module_needs_itself_to_be_imported() -> None:
    known = {module_name(path) for path in FILES}
    needs: dict[str, set[str]] = {name: set() for name in known}
    for path in FILES:
        for node in at_import(tree_of(path).body):
            for name in imported_by(node, package_of(path)):
                needs[module_name(path)] |= {name if name in known else name.rpartition(".")[0]} & known
    assert len(list(TopologicalSorter(needs).static_order())) == len(known)


@pytest.mark.parametrize("package", ["actr3d", "workbench"])
def test_no_module_knows_itself_through_others_not_even_for_types(package: str) -> None:
    """Imports for type checkers and inside functions count, too, also those of names that the `__init__.py` of a folder passes on."""
    files = [path for path in sorted((ROOT / package).rglob("*.py")) if path.name != "__init__.py"]
    known = {module_name(path) for path in files}
    passed_on: dict[str, str] = {}

    def imported(path: Path) -> list[str]:
        return [name for node in imports_of(path) for name in imported_by(node, package_of(path))]

    def module_of(name: str) -> str:
        return name if name in known else passed_on.get(name, name.rpartition(".")[0])

    for path in sorted((ROOT / package).rglob("__init__.py"), key=lambda path: -len(path.parts)):  # innermost first
        passed_on |= {f"{module_name(path)}.{name.rpartition('.')[2]}": module_of(name) for name in imported(path)}
    needs = {module_name(path): {module_of(name) for name in imported(path)} & known for path in files}
    assert len(list(TopologicalSorter(needs).static_order())) == len(known) > 50


OF_PYTHON_ACTR = {"Body", "Motor", "Vision", "World"}
"""Names of python_actr, which models import from `actr3d.actr`; embodied agents have other classes of these names."""


@pytest.mark.parametrize("package", ["actr3d", "workbench"])
def test_no_two_classes_have_one_name(package: str) -> None:
    found: dict[str, list[str]] = {}
    for path in sorted((ROOT / package).rglob("*.py")):
        for node in ast.walk(tree_of(path)):
            if isinstance(node, ast.ClassDef):
                found.setdefault(node.name, []).append(f"{path.relative_to(ROOT)}:{node.lineno}")
    assert {name: places for name, places in found.items() if len(places) > 1 and name not in OF_PYTHON_ACTR} == {}


def public_members(module: ModuleType) -> Iterator[tuple[str, Any]]:
    """Yields the public functions and classes that a module defines, and the classes' public methods and properties."""
    for name, thing in vars(module).items():
        if name[0] == "_" or getattr(thing, "__module__", None) != module.__name__:
            continue
        if inspect.isfunction(thing) or isinstance(thing, type):
            yield name, thing
        if isinstance(thing, type):
            fields = inspect.get_annotations(thing)
            for part, member in vars(thing).items():
                if (
                    part[0] != "_"
                    and part not in fields
                    and (inspect.isfunction(member) or isinstance(member, (property, classmethod, staticmethod)))
                ):
                    yield f"{name}.{part}", getattr(thing, part)


def own_words(name: str, thing: Any) -> str:
    """Returns a docstring: a class's own, of a method also that of the one it overrides; nothing for those that are made up."""
    if not isinstance(thing, type):
        return inspect.getdoc(thing) or ""
    own: str = vars(thing).get("__doc__") or ""
    return "" if own.startswith(f"{name}(") else own


def test_everything_public_says_what_it_does() -> None:
    modules = [importlib.import_module(module_name(path)) for path in FILES if path.stem != "__main__"]
    assert [module.__name__ for module in modules if not module.__doc__] == []
    named = [(f"{module.__name__}.", name, thing) for module in modules for name, thing in public_members(module)]
    promised = {method for _, _, thing in named if getattr(thing, "_is_protocol", False) for method in dir(thing)}

    def told_elsewhere(name: str) -> bool:
        method = name.rpartition(".")[2]
        return "." in name and (method in promised or method.startswith("visit_"))

    assert [module + name for module, name, thing in named if not own_words(name, thing) and not told_elsewhere(name)] == []
